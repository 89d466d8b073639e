// Exact and reference sampling in plain loops.
#include "visibility/cpu_reference/cpu_reference.h"
#include "visibility/exact/facet.h"
#include "visibility/nearby/nearby.h"
#include "visibility/shared/turns.h"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <span>
#include <tuple>

namespace gpgp::visibility {
namespace {
using namespace shader;

/// A pixel's list: of candidates.
using List = std::vector<uint32_t>;

/// Takes back what finish() made.
void clearLists(CpuResult& out) {
  for (auto* list : {&out.list, &out.drawCommands, &out.drawIndices, &out.drawTriangles}) list->clear();
  out.counters.appeared = out.counters.disappeared = 0;
}

/// What lies behind a candidate that is not opaque.
struct Open {
  const CpuInput* in = nullptr;
  CpuNonOpaque triangle;
};

/// An entry of a list within its pixel.
struct Placed {
  const Candidate* candidate;
  uint32_t key;        ///< of its depth, by which a batch is ordered
  uint32_t begin, end; ///< of the nearest and the farthest that it may come
  Outline outline;
  Facet facet;
  const Open* open = nullptr; ///< null: it is opaque
  ivec2 pixel = ivec2(0, 0);
};
/// Of a row's samples, those at which the texture lets an entry be.
uvec2 tested(const Placed& p, uvec2 asked, int row) {
  if (!p.open || !alphaTestOf(p.open->triangle.flags)) return asked;
  uvec2 passed(0, 0);
  for (int column = 0; column < 64; ++column) {
    const uint32_t bit = 1u << (column & 31);
    uint32_t& word = column < 32 ? passed.x : passed.y;
    if ((column < 32 ? asked.x : asked.y) & bit &&
        passesAlpha(*p.open->in, p.open->triangle, p.pixel * 256 + ivec2(column * 4 + 2, row * 4 + 2)))
      word |= bit;
  }
  return passed;
}
bool hidesNothing(const Placed& p) { return p.open && isSeeThrough(p.open->triangle.flags); }
uvec2 ownAmong(const Placed& p, uvec2 asked, int row) {
  uvec2 own = samplesIn(p.outline, row);
  own.x &= asked.x, own.y &= asked.y;
  return tested(p, own, row);
}
/// Entries of a list that are decided together.
using Batch = std::span<const Placed>;
/// Samples of a pixel, by row.
using Samples = std::array<uvec2, 64>;

bool isAny(const Samples& samples) {
  return std::any_of(samples.begin(), samples.end(), [](uvec2 row) { return row.x | row.y; });
}

/// Whether two entries may have area in common; only compact ones are asked.
bool mayOverlap(const Placed& a, const Placed& b) {
  const bool compact = isCompact(triangleOf(*a.candidate)) && isCompact(triangleOf(*b.candidate));
  return !compact || overlap(cornersOf(*a.candidate), cornersOf(*b.candidate));
}

/// Whether an entry has one of the samples at which none of the others is nearer.
bool isAhead(Batch batch, size_t place, const Samples& samples, const std::vector<bool>& decides) {
  const Placed& own = batch[place];
  std::vector<std::pair<const Placed*, Crossing>> rivals;
  for (size_t j = 0; j < batch.size(); ++j) {
    const Placed& other = batch[j];
    if (j == place || !decides[j] || hidesNothing(other) || other.facet.nearest > own.facet.farthest) continue;
    if (!(leadWithin(other.facet, own.facet) >= 0) || !mayOverlap(other, own)) continue;
    rivals.emplace_back(&other, crossingOf(other.facet, own.facet, other.candidate->id < own.candidate->id));
  }
  for (int row = 0; row < 64; ++row) {
    const uvec2 open = samples[static_cast<size_t>(row)];
    uvec2 rest = ownAmong(own, open, row);
    for (const auto& [rival, crossing] : rivals) {
      uvec2 ahead = samplesAhead(rival->outline, crossing, row);
      ahead.x &= rest.x, ahead.y &= rest.y;
      ahead = tested(*rival, ahead, row);
      rest.x &= ~ahead.x, rest.y &= ~ahead.y;
    }
    if (rest.x | rest.y) return true;
  }
  return false;
}

/// By what a list is divided: where an entry begins, or among those that begin at one depth the triangle's number.
using KeyOf = uint32_t (*)(const Placed&);
uint32_t beginOf(const Placed& p) { return p.begin; }
uint32_t idOf(const Placed& p) { return p.candidate->id; }

/// How many entries of a list have a key up to one.
size_t countUpTo(Batch list, KeyOf keyOf, uint32_t key) {
  const auto isBefore = [keyOf](uint32_t value, const Placed& p) { return value < keyOf(p); };
  return static_cast<size_t>(std::upper_bound(list.begin(), list.end(), key, isBefore) - list.begin());
}

/// The farthest key up to which entries are decided together, of those from `low` to `last`: at most `most`, or those
/// that have one and the same key. Counts the passes through the list.
uint32_t lastKey(Batch list, KeyOf keyOf, uint32_t low, uint32_t last, size_t most, uint32_t& passes) {
  uint32_t high = last;
  while (true) {
    ++passes;
    const uint32_t range = high - low, shift = std::max<uint32_t>(std::bit_width(range), 6) - 6;
    const auto endOf = [&](uint32_t bins) { return std::min(low + (uint64_t(bins) << shift) - 1, uint64_t(high)); };
    uint32_t fitting = 0;
    while (fitting < 64 && countUpTo(list, keyOf, static_cast<uint32_t>(endOf(fitting + 1))) <= most) ++fitting;
    if (fitting == 64) return high;
    high = static_cast<uint32_t>(endOf(std::max(fitting, 1u)));
    if (fitting != 0 || shift == 0) return high;
  }
}

/// What a batch shows: by its order, and as planes correct that.
struct Looked {
  std::vector<bool> seen, visible;
};

/// Decides a batch, in its order, `before` entries of whose list come before it: those with a sample that nothing
/// before them covers are visible, and what the order by one depth each may have wrong is decided by planes.
Looked resolveBatch(Batch batch, uint32_t nearest, size_t before, Samples& open, vec4 depthScale, bool reversed) {
  const Samples atFirst = open;
  uvec2 columns(0, 0), rows(0, 0);
  for (uint32_t row = 0; row < 64; ++row) {
    columns.x |= open[row].x, columns.y |= open[row].y;
    if (open[row].x | open[row].y) (row < 32 ? rows.x : rows.y) |= 1u << (row & 31);
  }
  std::vector<bool> seen(batch.size()), decides(batch.size()), visible(batch.size());
  bool holes = true;
  for (size_t i = 0; i < batch.size(); ++i) {
    decides[i] = reaches(batch[i].facet, columns, rows);
    if (!holes) continue;
    holes = false;
    const int parallax = parallaxOf(depthScale, nearest, batch[i].key, static_cast<uint32_t>(before + i), reversed);
    for (int row = 0; row < 64; ++row) {
      uvec2& rest = open[static_cast<size_t>(row)];
      const uvec2 own = ownAmong(batch[i], rest, row);
      uvec2 shown = own;
      if (parallax) {
        shown = samplesAround(batch[i].outline, parallax, row);
        shown.x &= rest.x, shown.y &= rest.y;
        shown = tested(batch[i], shown, row);
      }
      if (shown.x | shown.y) seen[i] = true;
      if (!hidesNothing(batch[i])) rest.x &= ~own.x, rest.y &= ~own.y;
      holes = holes || (rest.x | rest.y);
    }
  }
  const auto nearer = [](const Placed& a, const Placed& b) {
    return isNearerSomewhere(a.facet, b.facet) && mayOverlap(a, b);
  };
  for (size_t i = 0; i < batch.size(); ++i) {
    bool doubtful = false;
    for (size_t j = 0; decides[i] && j < batch.size() && !doubtful; ++j) {
      if (!decides[j] || (seen[i] ? j <= i : j >= i || !seen[j])) continue;
      doubtful = seen[i] ? nearer(batch[j], batch[i]) : nearer(batch[i], batch[j]);
    }
    visible[i] = doubtful ? isAhead(batch, i, atFirst, decides) : seen[i];
  }
  return {seen, visible};
}

/// The order in which a batch is decided.
void sortBatch(std::vector<Placed>& batch) {
  const auto rank = [](const Placed& p) {
    return std::tuple(p.key, p.candidate->id, p.candidate->p1.x, p.candidate->p1.y);
  };
  std::sort(batch.begin(), batch.end(), [&](const Placed& a, const Placed& b) { return rank(a) < rank(b); });
}

void close(Samples& open, const Placed& p) {
  for (int row = 0; row < 64 && !hidesNothing(p); ++row) {
    uvec2& rest = open[static_cast<size_t>(row)];
    const uvec2 own = ownAmong(p, rest, row);
    rest.x &= ~own.x, rest.y &= ~own.y;
  }
}

bool hasAny(const Placed& p, const Samples& samples) {
  for (int row = 0; row < 64; ++row) {
    const uvec2 own = ownAmong(p, samples[static_cast<size_t>(row)], row);
    if (own.x | own.y) return true;
  }
  return false;
}

/// Takes from those that would be carried over to the next batch the ones that reach least far, if there are too many.
std::vector<Placed> takeForced(std::vector<Placed>& going) {
  if (going.size() <= kMostCarried) return {};
  std::vector<Placed> carried, forced;
  for (const Placed& p : going) {
    const auto isNearer = [&](const Placed& other) { return other.end < p.end; };
    const auto rank = static_cast<size_t>(std::count_if(going.begin(), going.end(), isNearer));
    (rank < going.size() - kKeptCarried ? forced : carried).push_back(p);
  }
  going = std::move(carried);
  return forced;
}

/// Decides a list of more than kBatch, as resolve_long.comp does; returns how many of it are not decided.
uint32_t resolveLong(std::vector<Placed> list, vec4 depthScale, bool reversed, std::vector<uint32_t>& bits) {
  const auto rank = [](const Placed& p) { return std::tuple(p.begin, p.candidate->id); };
  std::sort(list.begin(), list.end(), [&](const Placed& a, const Placed& b) { return rank(a) < rank(b); });
  const auto show = [&](const Placed& p) { bits[p.candidate->id / 32] |= 1u << (p.candidate->id % 32); };
  const auto size = static_cast<uint32_t>(list.size());
  uint32_t turns = turnsThrough(size), doubt = 0, unresolved = 0;
  size_t first = 0, before = 0; // entries that were taken; and without those that are carried
  const auto showRest = [&] {
    for (const Placed& p : Batch(list).subspan(first)) show(p), ++unresolved;
    return unresolved;
  };
  if (takesTooLong(turns, size)) return showRest();
  const uint32_t nearest = list.front().begin;
  uint32_t low = nearest, farthest = list.back().begin, last = farthest, depth = 0;
  size_t end = list.size(); // of those by whose numbers the list is divided
  KeyOf keyOf = beginOf;
  Samples open, doubted; // the samples that only such cover as were taken before they ended, at depths up to `doubt`
  open.fill(uvec2(~0u, ~0u)), doubted.fill(uvec2(0u, 0u));
  std::vector<Placed> carried;
  for (bool more = true; more;) {
    const Batch rest = Batch(list).subspan(first, end - first);
    const size_t room = kBatch - carried.size();
    uint32_t passes = 1;
    const uint32_t high = lastKey(rest, keyOf, low, last, room, passes);
    const size_t n = countUpTo(rest, keyOf, high);
    turns += passes * turnsThrough(size);
    if (n > room && keyOf == beginOf) {
      turns += turnsThrough(size);
      depth = low;
      end = first + n;
      keyOf = idOf;
      low = idOf(list[first]), last = idOf(list[end - 1]);
      continue;
    }
    turns += turnsOfBatch(static_cast<uint32_t>(std::min<size_t>(n + carried.size(), kBatch)));
    if (n > room || takesTooLong(turns, size)) return showRest();
    const bool isLast = high == last;
    low = high + 1;
    first += n;

    if (isLast) keyOf = beginOf, end = list.size();
    const uint32_t begin = first < list.size() ? list[first].begin : kFarthest;
    const uint32_t next = keyOf == idOf ? depth + 1 : begin; // where those that are left begin
    if (keyOf == beginOf) low = next;
    std::vector<Placed> batch = std::move(carried);
    batch.insert(batch.end(), rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(n));
    sortBatch(batch);
    Samples left = open;
    const Looked looked = resolveBatch(batch, nearest, before, left, depthScale, reversed);
    std::vector<Placed> going;
    for (size_t i = 0; i < batch.size(); ++i) {
      if (looked.seen[i] && batch[i].end >= next && !hidesNothing(batch[i])) going.push_back(batch[i]);
      if (looked.visible[i]) show(batch[i]);
      if (looked.seen[i] || batch[i].begin > doubt || !hasAny(batch[i], doubted)) continue;
      show(batch[i]), ++unresolved;
    }
    for (const Placed& p : batch)
      if (p.end < next) close(open, p), close(doubted, p);
    for (const Placed& p : takeForced(going)) {
      doubt = std::max(doubt, p.end - 1);
      for (size_t row = 0; row < 64; ++row) {
        const uvec2 own = ownAmong(p, open[row], static_cast<int>(row));
        doubted[row].x |= own.x, doubted[row].y |= own.y;
      }
      close(open, p);
    }
    carried = std::move(going);
    if (carried.empty()) open = left;
    before += batch.size() - carried.size();
    if (!isAny(left)) {
      uint32_t reach = isAny(doubted) ? doubt : 0;
      for (const Placed& p : carried) reach = std::max(reach, p.end);
      farthest = std::min(farthest, reach);
      more = (!carried.empty() || isAny(doubted)) && (keyOf == idOf || next <= farthest);
    }
    if (keyOf == idOf) continue;
    more = more && next <= farthest && next != kFarthest;
    last = farthest;
  }
  return unresolved;
}

/// Decides a list, front to back until all samples are covered; returns how many of it are not decided.
uint32_t resolve(const std::vector<Candidate>& candidates, const std::vector<const Open*>& opens, const List& list,
                 ivec2 pixel, bool reversed, vec4 depthScale, float extent, std::vector<uint32_t>& bits) {
  if (list.empty()) return 0;
  std::vector<Placed> placed;
  for (const uint32_t index : list) {
    const Candidate& c = candidates[index];
    const ScreenTriangle t = triangleOf(c);
    const Footing footing = footingOf(c, pixel);
    const Outline outline = outlineOf(c, pixel, extent);
    placed.push_back({&c, middleKey(c, outline, footing, pixel, reversed), nearestKey(t, footing, reversed),
                      farthestKey(t, footing, reversed), outline, facetOf(c, footing, pixel, reversed), opens[index],
                      pixel});
  }
  if (placed.size() > kBatch) return resolveLong(std::move(placed), depthScale, reversed, bits);
  sortBatch(placed);
  Samples open;
  open.fill(uvec2(~0u, ~0u));
  const Looked looked = resolveBatch(placed, placed.front().key, 0, open, depthScale, reversed);
  for (size_t i = 0; i < placed.size(); ++i) {
    const uint32_t id = placed[i].candidate->id;
    if (looked.visible[i]) bits[id / 32] |= 1u << (id % 32);
  }
  return 0;
}
} // namespace

CpuResult sampleExactOnCpu(CpuInput in) {
  in.params.method = kExact;
  const Params& params = in.params;
  const bool reversed = params.reversedDepth != 0;
  CpuResult out = sampleOnCpu(in);
  clearLists(out);
  const std::vector<uint32_t> standard = out.bits;
  const int width = static_cast<int>(params.width), height = static_cast<int>(params.height * params.cameraCount);
  const auto at = [&](ivec2 pixel) { return static_cast<size_t>(pixel.y * width + pixel.x); };

  struct Piece {
    ScreenTriangle triangle;
    Corners fine;
    ivec4 bounds;
    uint32_t id;
    bool shared, seen; // by several invocations
    std::shared_ptr<const Open> open;
    bool isSliver = false; // without area on the grid
  };
  std::vector<Piece> pieces;
  forEachTriangle(in, [&](const DrawEntry& e, uint32_t local, uint32_t) {
    uint32_t id = 0;
    if (!isSampled(in, e) || !numberOf(in, e, local, id)) return;
    const CpuTriangle placed = placeTriangle(in, e, local);
    if (placed.fate == kBackFacing && !placed.wasClipped && !isNonOpaque(in.draws[e.draw].flags)) {
      const Draw& draw = in.draws[e.draw];
      Corners fine;
      bool swaps = false;
      const auto& [a, b, c] = placed.clip;
      if (!facesFinely(a, b, c, gridOf(params, e.camera), turnsFaces(draw), (draw.flags & kTwoSided) != 0, fine, swaps))
        return;
      const ScreenTriangle t = makeSliver(a, b, c, swaps, fine);
      const ivec4 bounds = pixelBounds(t.p0, t.p1, t.p2, gridOf(params, e.camera));
      if (bounds.x < bounds.z && bounds.y < bounds.w)
        pieces.push_back({t, fine, bounds, id, bounds.z - bounds.x > 8 || bounds.w - bounds.y > 8,
                          (standard[id / 32] >> (id % 32) & 1) != 0, nullptr, true});
      return;
    }
    std::shared_ptr<const Open> open;
    if (isNonOpaque(in.draws[e.draw].flags)) {
      if (!params.maxNonOpaque) return;
      open = std::make_shared<Open>(Open{&in, nonOpaqueOf(in, e, local, placed)});
    }
    for (const ScreenTriangle& t : placed.pieces) {
      const ivec4 bounds = pixelBounds(t.p0, t.p1, t.p2, gridOf(params, e.camera));
      if (bounds.x < bounds.z && bounds.y < bounds.w)
        pieces.push_back({t,
                          placed.fate == kWhole
                              ? fineCorners(t, placed.clip[0], placed.clip[1], placed.clip[2], gridOf(params, e.camera))
                              : unitCorners(t),
                          bounds, id, placed.fate == kClipped || bounds.z - bounds.x > 8 || bounds.w - bounds.y > 8,
                          (standard[id / 32] >> (id % 32) & 1) != 0, open});
    }
  });

  std::vector<uint32_t> limits(out.depth.size(), kFarthest);
  const Grid grid = gridOf(params);
  for (const Piece& piece : pieces)
    for (int y = piece.bounds.y; y < piece.bounds.w && !piece.open && !piece.isSliver; ++y)
      for (int x = piece.bounds.x; x < piece.bounds.z; ++x) {
        const ivec2 pixel(x, y), point = samplePoint(pixel, grid);
        if (fillsPixel(piece.triangle, pixel, grid))
          limits[at(pixel)] =
              std::min(limits[at(pixel)], fillKey(piece.triangle, depthWide(piece.triangle, point), reversed));
      }

  std::vector<Candidate> candidates;
  std::vector<const Open*> opens; // by candidate
  std::vector<List> lists(out.depth.size());
  std::vector<bool> open;
  for (const bool seen : {false, true}) {
    open.clear();
    for (const List& list : lists) open.push_back(!list.empty());
    for (const Piece& piece : pieces) {
      const ScreenTriangle& t = piece.triangle;
      if (piece.seen != seen) continue;
      if (seen && !piece.shared && piece.open && isSeeThrough(piece.open->triangle.flags)) continue;
      const auto index = static_cast<uint32_t>(candidates.size());
      const Candidate candidate = makeCandidate(t, piece.fine, piece.id);
      bool mayShow = false;
      for (int y = piece.bounds.y; y < piece.bounds.w; ++y)
        for (int x = piece.bounds.x; x < piece.bounds.z; ++x) {
          const ivec2 pixel(x, y);
          const uint32_t limit = limits[at(pixel)];
          if (depthKey(reversed ? t.zMax : t.zMin, reversed) > limit) continue;
          mayShow = true;
          if ((seen && !open[at(pixel)]) || !touches(t, isCompact(t), pixel)) continue;
          if (nearestKey(candidate, pixel, reversed) > limit) continue;
          lists[at(pixel)].push_back(index);
          ++out.counters.pairs;
        }
      if (!mayShow && !piece.shared && !seen) continue;
      for (int room = piece.open ? 2 : 1; room > 0; --room) {
        candidates.push_back(candidate);
        opens.push_back(piece.open.get());
      }
    }
  }
  out.counters.candidates = static_cast<uint32_t>(candidates.size());
  const auto extent = static_cast<float>(std::max(params.width, params.height));

  for (int y = 0; y < height; ++y) {
    const float* s = params.depthScales + static_cast<uint32_t>(y) / params.height * 4;
    for (int x = 0; x < width; ++x)
      out.counters.unresolved += resolve(candidates, opens, lists[at(ivec2(x, y))], ivec2(x, y), reversed,
                                         vec4(s[0], s[1], s[2], s[3]), extent, out.bits);
  }
  out.ids.clear();
  finish(in, out);
  return out;
}

CpuResult referenceOnCpu(CpuInput in, uint32_t samples, std::vector<uint32_t>& sizes) {
  sizes.assign(in.params.triangleCount, 0);
  in.params.method = kReference;
  const uint32_t part = 256 / samples, perRecord = std::min(samples, 4u), perSide = samples / perRecord;
  CpuResult all;
  for (uint32_t slice = 0; slice <= perSide * perSide; ++slice) {
    const bool centre = slice == perSide * perSide;
    in.params.gridShift = centre ? 8 : static_cast<uint32_t>(std::countr_zero(256 / perRecord));
    in.params.gridX = centre ? 128 : slice % perSide * part + part / 2;
    in.params.gridY = centre ? 128 : slice / perSide * part + part / 2;
    CpuResult one = sampleOnCpu(in);
    for (size_t id = 0; id < sizes.size(); ++id) sizes[id] += one.sizes[id];
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
