#include "visibility/cpu_reference/atlas.h"

#include "visibility/atlas/atlas.h"

#include <algorithm>

namespace gpgp::visibility {
using namespace shader;
namespace {

struct Allocation {
  const CpuAtlasInput& input;
  const AtlasParams& params = input.params;
  CpuAtlas& atlas;
  CpuAtlasResult result;
  std::vector<uint32_t> plans;

  uint32_t& state(uint32_t triangle) { return atlas[kHeadWords + triangle]; }
  uint32_t code(uint32_t triangle) const {
    return codeIn(atlas[kHeadWords + params.maxTriangles + triangle / 16], triangle);
  }
  static bool has(std::span<const uint32_t> bits, uint32_t i) { return bits[i / 32] >> i % 32 & 1; }
  bool isVisible(uint32_t triangle) const { return triangle < params.triangleCount && has(input.bits, triangle); }
  uint32_t bucketOf(uint32_t triangle) const {
    if (!params.hasBuckets) return 0;
    return std::min(input.buckets[triangle / 4] >> triangle % 4 * 8 & 255, params.bucketCount - 1);
  }

  void findPairs();
  void measure(std::vector<uint32_t>& histogram);
  void resolve(const std::vector<uint32_t>& histogram);
  void place();
  void shade();
};

/// Which triangles share a block; those whose pair is another one lose theirs.
void Allocation::findPairs() {
  if (!params.findsPairs) return;
  std::vector<uint32_t> codes((params.maxTriangles + 15) / 16);
  const auto indexAt = [&](uint32_t i) {
    return params.shortIndices ? input.indices[i / 2] >> i % 2 * 16 & 0xffff : input.indices[i];
  };
  const auto cornersAt = [&](uint32_t i) { return uvec3(indexAt(i), indexAt(i + 1), indexAt(i + 2)); };
  for (const Draw& draw : input.draws) {
    if (draw.mesh >= input.meshes.size() || draw.firstTriangle >= params.triangleCount) continue;
    const Mesh& mesh = input.meshes[draw.mesh];
    if (mesh.firstIndex > params.indexCount) continue;
    const uint32_t count = std::min(std::min(mesh.indexCount, params.indexCount - mesh.firstIndex) / 3,
                                    params.triangleCount - draw.firstTriangle);
    for (uint32_t local = draw.firstTriangle & 1; local + 1 < count; local += 2) {
      const uint32_t index = mesh.firstIndex + local * 3, triangle = draw.firstTriangle + local;
      codes[triangle / 16] |= pairCode(cornersAt(index), cornersAt(index + 3)) << triangle / 2 % 8 * 4;
    }
  }
  for (uint32_t t = 0; t < params.maxTriangles; ++t)
    if (codeIn(codes[t / 16], t) != code(t)) state(t) = 0;
  std::copy(codes.begin(), codes.end(), atlas.begin() + kHeadWords + params.maxTriangles);
}

void Allocation::measure(std::vector<uint32_t>& histogram) {
  const auto texelsOf = [&](uint32_t t) {
    return texelsFor(input.sizes[t * 3], input.sizes[t * 3 + 1], input.sizes[t * 3 + 2], params.scale);
  };
  for (uint32_t t = 0; t < params.maxTriangles; ++t) {
    const bool paired = code(t) != 0;
    if (paired && t % 2) continue;
    const bool one = isVisible(t), other = paired && isVisible(t + 1);
    plans[t] = paired ? kPlanPaired : 0;
    if (!one && !other) continue;
    const float texels = std::max(one ? texelsOf(t) : 0.0f, other ? texelsOf(t + 1) : 0.0f);
    const uint32_t desired = classWithHysteresis(desiredOf(state(t)), texels), key = keyFor(texels, t);
    plans[t] |= desired | key << kPlanKeyShift | kPlanVisible | (one && other ? kPlanBoth : 0);
    ++histogram[key * kVariants + variantOf(desired, key)];
  }
}

void Allocation::resolve(const std::vector<uint32_t>& histogram) {
  const auto fits = [&](uint32_t pressure, uint32_t supers) {
    uint32_t counts[kClasses] = {}, needed = 0;
    for (uint32_t i = 0; i < histogram.size(); ++i) {
      if (!histogram[i]) continue;
      const uint32_t key = i / kVariants, c = classUnder(classOfKey(key) + i % kVariants - 1, key, pressure);
      if (c) counts[c - kMinClass] += histogram[i];
    }
    for (uint32_t i = 0; i < kClasses; ++i) needed += supersFor(counts[i], kMinClass + i);
    return needed <= supers;
  };
  const auto search = [&](uint32_t low, uint32_t high, uint32_t supers) {
    while (low < high) {
      const uint32_t middle = low + (high - low) / 2;
      if (fits(middle, supers))
        high = middle;
      else
        low = middle + 1;
    }
    return high;
  };
  uint32_t pressure = std::min(atlas[kHeadPressure], kMostPressure);
  const uint32_t all = params.superCount;
  if (!fits(pressure, all))
    pressure = search(pressure, kMostPressure, all - all / 16);
  else if (pressure && fits(pressure, all - all / 8))
    pressure = search(0, pressure, all - all / 8);
  atlas[kHeadPressure] = result.counters.pressure = pressure;
}

/// Keeps, vacates and gives places, and fills the lists.
void Allocation::place() {
  struct Super {
    uint32_t blocks = 0, blockClass = 0;
    std::vector<bool> used;
  };
  AtlasCounters& counters = result.counters;
  std::vector<Super> supers(params.superCount);
  uint32_t requests[kClasses] = {};
  for (uint32_t t = 0; t < params.maxTriangles; ++t) {
    uint32_t& plan = plans[t];
    if (!state(t) && !(plan & kPlanVisible)) continue;
    plan = planUnder(plan, state(t), atlas[kHeadPressure]);
    const uint32_t c = planClass(plan), triangles = plan & kPlanBoth ? 2 : 1;
    if (plan & kPlanVisible) counters.visible += triangles;
    if (c) {
      ++counters.byClass[c - kMinClass];
      counters.lowered += c < (plan & kPlanDesired);
      if (keepsPlace(plan, state(t), atlas[kHeadVacated + c - kMinClass])) {
        plan |= kPlanKeeps;
        Super& super = supers[superOf(state(t))];
        super.used.resize(placesIn(c));
        super.used[placeOf(state(t))] = true;
        super.blockClass = c;
        ++super.blocks;
      } else {
        ++requests[c - kMinClass];
        counters.vacated += c == classOf(state(t));
      }
    } else if (plan & kPlanVisible) {
      ++counters.dropped;
      counters.droppedTriangles += triangles;
    }
  }
  // Free places of each class, in order, and free superblocks.
  std::vector<uint32_t> freePlaces[kClasses], unused;
  uint32_t emptiest[kClasses], used = 0;
  std::fill_n(emptiest, kClasses, UINT32_MAX);
  for (uint32_t s = 0; s < supers.size(); ++s) {
    if (!supers[s].blockClass) {
      unused.push_back(s);
      continue;
    }
    const uint32_t i = supers[s].blockClass - kMinClass;
    for (uint32_t p = 0; p < supers[s].used.size(); ++p)
      if (!supers[s].used[p]) freePlaces[i].push_back(s << 10 | p);
    emptiest[i] = std::min(emptiest[i], supers[s].blocks << 12 | (4095 - s));
    ++used;
  }
  uint32_t needed = 0;
  std::vector<uint32_t> given[kClasses]; // places that requests take, in order
  for (uint32_t i = kClasses; i-- > 0;) {
    const uint32_t c = kMinClass + i;
    given[i] = freePlaces[i];
    counters.leastSupers += supersFor(counters.byClass[i], c);
    counters.blocks += counters.byClass[i];
    counters.texels += counters.byClass[i] << c;
    const auto free = static_cast<uint32_t>(freePlaces[i].size());
    const uint32_t more = requests[i] > free ? supersFor(requests[i] - free, c) : 0;
    for (uint32_t n = 0; n < more; ++n, ++needed)
      if (needed < unused.size())
        for (uint32_t p = 0; p < placesIn(c); ++p) given[i].push_back(unused[needed] << 10 | p);
  }
  const bool repacked = needed > unused.size();
  counters.repacked = repacked;
  counters.supers = repacked ? counters.leastSupers : used + needed;
  for (uint32_t i = kClasses, next = 0; i-- > 0;) {
    const uint32_t c = kMinClass + i, kept = emptiest[i] == UINT32_MAX ? 0 : emptiest[i] >> 12;
    const bool vacates = !repacked && isVacated(c, kept, static_cast<uint32_t>(freePlaces[i].size()), requests[i]);
    atlas[kHeadVacated + i] = vacates ? 4096 - (emptiest[i] & 4095) : 0;
    if (!repacked) continue;
    given[i].clear();
    for (uint32_t n = supersFor(counters.byClass[i], c); n; --n, ++next)
      for (uint32_t p = 0; p < placesIn(c); ++p) given[i].push_back(next << 10 | p);
  }
  uint32_t taken[kClasses] = {};
  for (uint32_t t = 0; t < params.maxTriangles; ++t) {
    uint32_t& plan = plans[t];
    const uint32_t c = planClass(plan), before = state(t), desired = plan & kPlanDesired;
    if (c && (repacked || !(plan & kPlanKeeps))) {
      const uint32_t at = given[c - kMinClass][taken[c - kMinClass]++];
      state(t) = makeState(at >> 10, at & 1023, c, desired);
    } else if (c) {
      state(t) = makeState(superOf(before), placeOf(before), c, desired);
    } else {
      state(t) = plan & kPlanVisible ? makeState(0, 0, 0, desired) : 0;
    }
    uint32_t list = listOf(plan);
    if (repacked && list == kRowKept) list = kRowChanged;
    if (list == kRowNew) result.added.push_back(t);
    if (list == kRowChanged) result.changed.push_back(t);
    if (list == kRowGone) result.gone.push_back(t);
    counters.kept += list == kRowKept;
    const auto isWanted = [&](uint32_t i) { return i < params.triangleCount && has(input.shadeBits, i); };
    const bool wanted = !params.hasShade || isWanted(t) || (plan & kPlanPaired && isWanted(t + 1));
    if (c && (list != kRowKept || wanted)) plan |= kPlanShade;
    if (t >= params.triangleCount || (code(t) && t % 2)) continue;
    result.blocks[t] = blockWord(state(t), params.superColumns, firstCorner(code(t)), 0);
    if (code(t) && t + 1 < params.triangleCount)
      result.blocks[t + 1] = blockWord(state(t), params.superColumns, secondCorner(code(t)), 1);
  }
  counters.added = static_cast<uint32_t>(result.added.size());
  counters.changed = static_cast<uint32_t>(result.changed.size());
  counters.gone = static_cast<uint32_t>(result.gone.size());
}

void Allocation::shade() {
  for (uint32_t bucket = 0; bucket < params.bucketCount; ++bucket) {
    const auto first = static_cast<uint32_t>(result.tiles.size());
    for (uint32_t c = kMinClass; c <= kMaxClass; ++c)
      for (uint32_t t = 0; t < params.maxTriangles; ++t)
        if (plans[t] & kPlanShade && planClass(plans[t]) == c && bucketOf(t) == bucket)
          for (uint32_t tile = 0; tile < 1u << tilesLog(c); ++tile) result.tiles.push_back({t, tile});
    const auto end = static_cast<uint32_t>(result.tiles.size());
    const uint32_t start = std::min(first, params.tileCapacity), count = std::min(end, params.tileCapacity) - start;
    const uint32_t groups = (count + kTilesPerGroup - 1) / kTilesPerGroup;
    for (const uint32_t word : {std::min(groups, 65535u), (groups + 65534) / 65535, 1u, start, count})
      result.dispatches.push_back(word);
  }
  AtlasCounters& counters = result.counters;
  counters.tiles = static_cast<uint32_t>(result.tiles.size());
  counters.maxSupers = params.superCount;
  const auto exceeds = [](uint32_t count, uint32_t capacity) { return capacity && count > capacity; };
  counters.listsExceeded =
      exceeds(counters.tiles, params.tileCapacity) || exceeds(counters.added, params.newCapacity) ||
      exceeds(counters.changed, params.changedCapacity) || exceeds(counters.gone, params.goneCapacity);
}
} // namespace

CpuAtlasResult allocate(const CpuAtlasInput& input, CpuAtlas& atlas) {
  atlas.resize(kHeadWords + input.params.maxTriangles + (input.params.maxTriangles + 15) / 16);
  Allocation allocation{.input = input, .atlas = atlas, .result = {}, .plans = {}};
  allocation.plans.resize(input.params.maxTriangles);
  allocation.result.blocks.resize(input.params.triangleCount);
  std::vector<uint32_t> histogram(kKeys * kVariants);
  allocation.findPairs();
  allocation.measure(histogram);
  allocation.resolve(histogram);
  allocation.place();
  allocation.shade();
  return std::move(allocation.result);
}

} // namespace gpgp::visibility
