// Exact and truth sampling in plain loops.
#include "visibility/facet.h"
#include "visibility/nearby.h"
#include "visibility/turns.h"
#include "visibility/twin/twin.h"

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <span>
#include <tuple>

namespace gpgp::visibility {
namespace {
using namespace shader;

/// A pixel's list: candidates and the keys of their depths there.
struct Entry {
  uint32_t candidate, key;
};
using List = std::vector<Entry>;

/// Takes back what finish() made.
void clearLists(TwinResult& out) {
  for (auto* list : {&out.list, &out.drawCommands, &out.drawIndices, &out.drawTriangles}) list->clear();
  out.counters.appeared = out.counters.disappeared = 0;
}

/// An entry of a list, in its order.
struct Sorted {
  const Candidate& candidate;
  uint32_t key;
  Outline outline;
  Facet facet;
};
/// Entries of a list that are decided together.
using Batch = std::span<const Sorted>;
/// Samples of a pixel, by row.
using Samples = std::array<uvec2, 64>;

/// Whether two entries may have area in common; only compact ones are asked.
bool mayOverlap(const Sorted& a, const Sorted& b) {
  const bool compact = isCompact(triangleOf(a.candidate)) && isCompact(triangleOf(b.candidate));
  return !compact || overlap(cornersOf(a.candidate), cornersOf(b.candidate));
}

/// Whether an entry has one of the samples at which none of the others is nearer.
bool isAhead(Batch batch, size_t place, const Samples& samples, const std::vector<bool>& decides) {
  const Sorted& own = batch[place];
  std::vector<std::pair<const Sorted*, Crossing>> rivals;
  for (size_t j = 0; j < batch.size(); ++j) {
    const Sorted& other = batch[j];
    if (j == place || !decides[j] || other.facet.nearest > own.facet.farthest) continue;
    if (!(leadWithin(other.facet, own.facet) >= 0) || !mayOverlap(other, own)) continue;
    rivals.emplace_back(&other, crossingOf(other.facet, own.facet, other.candidate.id < own.candidate.id));
  }
  for (int row = 0; row < 64; ++row) {
    const uvec2 open = samples[static_cast<size_t>(row)];
    uvec2 rest = samplesIn(own.outline, row);
    rest.x &= open.x, rest.y &= open.y;
    for (const auto& [rival, crossing] : rivals) {
      const uvec2 ahead = samplesAhead(rival->outline, crossing, row);
      rest.x &= ~ahead.x, rest.y &= ~ahead.y;
    }
    if (rest.x | rest.y) return true;
  }
  return false;
}

/// By what a list is divided: the depth, or among entries of one depth the triangle's number.
using KeyOf = uint32_t (*)(const Sorted&);
uint32_t depthOf(const Sorted& s) { return s.key; }
uint32_t idOf(const Sorted& s) { return s.candidate.id; }

/// How many entries of a list have a key up to one.
size_t countUpTo(Batch list, KeyOf keyOf, uint32_t key) {
  const auto isBefore = [keyOf](uint32_t value, const Sorted& s) { return value < keyOf(s); };
  return static_cast<size_t>(std::upper_bound(list.begin(), list.end(), key, isBefore) - list.begin());
}

/// The farthest key up to which entries are decided together, of those that are not nearer than `low`: at most kBatch,
/// or those that have one and the same key. Counts the passes through the list.
uint32_t lastKey(Batch list, KeyOf keyOf, uint32_t low, uint32_t& passes) {
  uint32_t high = keyOf(list.back());
  while (true) {
    ++passes;
    const uint32_t range = high - low, shift = std::max<uint32_t>(std::bit_width(range), 6) - 6;
    const auto endOf = [&](uint32_t bins) { return std::min(low + (uint64_t(bins) << shift) - 1, uint64_t(high)); };
    uint32_t fitting = 0;
    while (fitting < 64 && countUpTo(list, keyOf, static_cast<uint32_t>(endOf(fitting + 1))) <= kBatch) ++fitting;
    if (fitting == 64) return high;
    high = static_cast<uint32_t>(endOf(std::max(fitting, 1u)));
    if (fitting != 0 || shift == 0) return high;
  }
}

/// Decides a part of a list, `before` entries of which come before it: those with a sample that nothing before them
/// covers become visible, and what the order by one depth each may have wrong is decided by planes.
void resolveBatch(Batch batch, uint32_t nearest, size_t before, Samples& open, vec4 depthScale, bool reversed,
                  std::vector<uint32_t>& bits) {
  const Samples atFirst = open;
  uvec2 columns(0, 0), rows(0, 0);
  for (uint32_t row = 0; row < 64; ++row) {
    columns.x |= open[row].x, columns.y |= open[row].y;
    if (open[row].x | open[row].y) (row < 32 ? rows.x : rows.y) |= 1u << (row & 31);
  }
  std::vector<bool> seen(batch.size()), decides(batch.size());
  bool holes = true;
  for (size_t i = 0; i < batch.size(); ++i) {
    decides[i] = reaches(batch[i].facet, columns, rows);
    if (!holes) continue;
    holes = false;
    const int parallax = parallaxOf(depthScale, nearest, batch[i].key, static_cast<uint32_t>(before + i), reversed);
    for (int row = 0; row < 64; ++row) {
      uvec2& rest = open[static_cast<size_t>(row)];
      const uvec2 own = samplesIn(batch[i].outline, row);
      const uvec2 shown = parallax ? samplesAround(batch[i].outline, parallax, row) : own;
      if ((shown.x & rest.x) | (shown.y & rest.y)) seen[i] = true;
      rest.x &= ~own.x, rest.y &= ~own.y;
      holes = holes || (rest.x | rest.y);
    }
  }
  const auto nearer = [](const Sorted& a, const Sorted& b) {
    return isNearerSomewhere(a.facet, b.facet) && mayOverlap(a, b);
  };
  for (size_t i = 0; i < batch.size(); ++i) {
    bool doubtful = false;
    for (size_t j = 0; decides[i] && j < batch.size() && !doubtful; ++j) {
      if (!decides[j] || (seen[i] ? j <= i : j >= i || !seen[j])) continue;
      doubtful = seen[i] ? nearer(batch[j], batch[i]) : nearer(batch[i], batch[j]);
    }
    const uint32_t id = batch[i].candidate.id;
    if (doubtful ? isAhead(batch, i, atFirst, decides) : seen[i]) bits[id / 32] |= 1u << (id % 32);
  }
}

/// Decides a list, front to back until all samples are covered.
void resolve(const std::vector<Candidate>& candidates, List list, ivec2 pixel, bool reversed, vec4 depthScale,
             std::vector<uint32_t>& bits) {
  if (list.empty()) return;
  const auto rank = [&](const Entry& e) {
    const Candidate& c = candidates[e.candidate];
    return std::tuple(e.key, c.id, c.p1.x, c.p1.y);
  };
  std::sort(list.begin(), list.end(), [&](const Entry& a, const Entry& b) { return rank(a) < rank(b); });
  std::vector<Sorted> sorted;
  for (const Entry& entry : list) {
    const Candidate& c = candidates[entry.candidate];
    const ScreenTriangle t = triangleOf(c);
    sorted.push_back(
        {c, entry.key, outlineOf(c, pixel), facetOf(c, footingOf(t, isCompact(t), pixel), pixel, reversed)});
  }
  Samples open;
  open.fill(uvec2(~0u, ~0u));
  const auto isOpen = [&] { return std::any_of(open.begin(), open.end(), [](uvec2 row) { return row.x | row.y; }); };
  const auto take = [&](size_t first, size_t count) {
    if (isOpen())
      resolveBatch(Batch(sorted).subspan(first, count), sorted.front().key, first, open, depthScale, reversed, bits);
  };
  if (sorted.size() <= kBatch) return take(0, sorted.size());
  const auto size = static_cast<uint32_t>(sorted.size());
  uint32_t turns = turnsThrough(size);
  const auto show = [&](size_t first) {
    for (const Sorted& entry : Batch(sorted).subspan(first))
      bits[entry.candidate.id / 32] |= 1u << (entry.candidate.id % 32);
  };
  if (takesTooLong(turns, size)) return show(0);
  // Decides entries from `first` on; false where that takes too long, and what is left is shown.
  const std::function<bool(size_t, Batch, KeyOf)> decide = [&](size_t first, Batch rest, KeyOf keyOf) {
    for (uint32_t low = keyOf(rest.front()); !rest.empty() && isOpen();) {
      uint32_t passes = 1;
      const uint32_t high = lastKey(rest, keyOf, low, passes);
      const auto n = static_cast<uint32_t>(countUpTo(rest, keyOf, high));
      turns += passes * turnsThrough(size);
      if (n > kBatch && keyOf == depthOf) {
        turns += turnsThrough(size);
        if (!decide(first, rest.first(n), idOf)) return false;
      } else {
        turns += turnsOfBatch(std::min(n, kBatch));
        if (n > kBatch || takesTooLong(turns, size)) {
          show(first);
          return false;
        }
        take(first, n);
      }
      first += n;
      rest = rest.subspan(n);
      low = high + 1;
    }
    return true;
  };
  decide(0, sorted, depthOf);
}
} // namespace

TwinResult sampleExactOnCpu(TwinInput in) {
  in.params.method = kExact;
  const Params& params = in.params;
  const bool reversed = params.reversedDepth != 0;
  TwinResult out = sampleOnCpu(in);
  clearLists(out);
  const std::vector<uint32_t> standard = out.bits;
  const int width = static_cast<int>(params.width), height = static_cast<int>(params.height * params.cameraCount);
  const auto at = [&](ivec2 pixel) { return static_cast<size_t>(pixel.y * width + pixel.x); };

  struct Piece {
    ScreenTriangle triangle;
    ivec4 bounds;
    uint32_t id;
    bool shared, seen; // by several invocations
  };
  std::vector<Piece> pieces;
  forEachTriangle(in, [&](const DrawEntry& e, uint32_t local, uint32_t) {
    uint32_t id = 0;
    if (!numberOf(in, e, local, id)) return;
    const TwinTriangle placed = placeTriangle(in, e, local);
    for (const ScreenTriangle& t : placed.pieces) {
      const ivec4 bounds = pixelBounds(t.p0, t.p1, t.p2, gridOf(params, e.camera));
      if (bounds.x < bounds.z && bounds.y < bounds.w)
        pieces.push_back({t, bounds, id, placed.fate == kClipped || bounds.z - bounds.x > 8 || bounds.w - bounds.y > 8,
                          (standard[id / 32] >> (id % 32) & 1) != 0});
    }
  });

  std::vector<uint32_t> limits(out.depth.size(), kFarthest);
  const Grid grid = gridOf(params);
  for (const Piece& piece : pieces)
    for (int y = piece.bounds.y; y < piece.bounds.w; ++y)
      for (int x = piece.bounds.x; x < piece.bounds.z; ++x) {
        const ivec2 pixel(x, y), point = samplePoint(pixel, grid);
        if (fillsPixel(piece.triangle, pixel, grid))
          limits[at(pixel)] =
              std::min(limits[at(pixel)], fillKey(piece.triangle, depthWide(piece.triangle, point), reversed));
      }

  std::vector<Candidate> candidates;
  std::vector<List> lists(out.depth.size());
  std::vector<bool> open;
  for (const bool seen : {false, true}) {
    open.clear();
    for (const List& list : lists) open.push_back(!list.empty());
    for (const Piece& piece : pieces) {
      const ScreenTriangle& t = piece.triangle;
      if (piece.seen != seen) continue;
      const auto index = static_cast<uint32_t>(candidates.size());
      const Candidate candidate = makeCandidate(t, piece.id);
      bool mayShow = false;
      for (int y = piece.bounds.y; y < piece.bounds.w; ++y)
        for (int x = piece.bounds.x; x < piece.bounds.z; ++x) {
          const ivec2 pixel(x, y);
          const uint32_t limit = limits[at(pixel)];
          if (depthKey(reversed ? t.zMax : t.zMin, reversed) > limit) continue;
          mayShow = true;
          if ((seen && !open[at(pixel)]) || !touches(t, isCompact(t), pixel)) continue;
          if (nearestKey(t, isCompact(t), pixel, reversed) > limit) continue;
          const Footing footing = footingOf(t, isCompact(t), pixel);
          lists[at(pixel)].push_back(
              {index, middleKey(candidate, outlineOf(candidate, pixel), footing, pixel, reversed)});
          ++out.counters.pairs;
        }
      if (mayShow || piece.shared || seen) candidates.push_back(candidate);
    }
  }
  out.counters.candidates = static_cast<uint32_t>(candidates.size());

  for (int y = 0; y < height; ++y) {
    const float* s = params.depthScales + static_cast<uint32_t>(y) / params.height * 4;
    for (int x = 0; x < width; ++x)
      resolve(candidates, lists[at(ivec2(x, y))], ivec2(x, y), reversed, vec4(s[0], s[1], s[2], s[3]), out.bits);
  }
  out.ids.clear();
  finish(in, out);
  return out;
}

TwinResult truthOnCpu(TwinInput in, uint32_t samples, std::vector<uint32_t>& sizes) {
  sizes.assign(in.params.triangleCount, 0);
  in.params.method = kTruth;
  const uint32_t part = 256 / samples, perRecord = std::min(samples, 4u), perSide = samples / perRecord;
  TwinResult all;
  for (uint32_t slice = 0; slice <= perSide * perSide; ++slice) {
    const bool centre = slice == perSide * perSide;
    in.params.gridShift = centre ? 8 : static_cast<uint32_t>(std::countr_zero(256 / perRecord));
    in.params.gridX = centre ? 128 : slice % perSide * part + part / 2;
    in.params.gridY = centre ? 128 : slice / perSide * part + part / 2;
    TwinResult one = sampleOnCpu(in);
    for (const uint32_t id : one.ids)
      if (id != kNoTriangle) ++sizes[id];
    if (slice == 0)
      all = one;
    else
      for (size_t word = 0; word < all.bits.size(); ++word) all.bits[word] |= one.bits[word];
  }
  clearLists(all);
  all.sizes = sizes;
  finish(in, all);
  return all;
}

} // namespace gpgp::visibility
