// Exact and truth sampling in plain loops.
#include "visibility/facet.h"
#include "visibility/nearby.h"
#include "visibility/twin/twin.h"

#include <algorithm>
#include <array>
#include <bit>
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

/// One of a short list's, in its order.
struct Sorted {
  const Candidate& candidate;
  Outline outline;
  Facet facet;
};

/// Whether an entry has a sample at which none of the others is nearer.
bool isAhead(const std::vector<Sorted>& list, size_t place) {
  const Sorted& own = list[place];
  for (int row = 0; row < 64; ++row) {
    uvec2 rest = samplesIn(own.outline, row);
    for (size_t j = 0; j < list.size(); ++j) {
      if (j == place || list[j].facet.nearest > own.facet.farthest) continue;
      const bool wins = list[j].candidate.id < own.candidate.id;
      const uvec2 ahead = samplesAhead(list[j].outline, crossingOf(list[j].facet, own.facet, wins), row);
      rest.x &= ~ahead.x, rest.y &= ~ahead.y;
    }
    if (rest.x | rest.y) return true;
  }
  return false;
}

/// Front to back: those with a sample that nothing before them covers become visible. In a short list, what the order
/// by one depth each may have wrong is decided by planes.
void resolve(const std::vector<Candidate>& candidates, List list, ivec2 pixel, bool reversed, vec4 depthScale,
             std::vector<uint32_t>& bits) {
  const auto rank = [&](const Entry& e) {
    const Candidate& c = candidates[e.candidate];
    return std::tuple(e.key, c.id, c.p1.x, c.p1.y);
  };
  std::sort(list.begin(), list.end(), [&](const Entry& a, const Entry& b) { return rank(a) < rank(b); });
  std::vector<Sorted> sorted;
  for (const Entry& entry : list) {
    const Candidate& c = candidates[entry.candidate];
    const ScreenTriangle t = triangleOf(c);
    sorted.push_back({c, outlineOf(c, pixel), facetOf(c, footingOf(t, isCompact(t), pixel), pixel, reversed)});
  }
  std::array<uvec2, 64> covered{};
  std::vector<bool> seen(sorted.size());
  size_t stop = 0;
  for (bool holes = true; holes && stop < sorted.size(); ++stop) {
    holes = false;
    const int parallax = parallaxOf(depthScale, list[0].key, list[stop].key, static_cast<uint32_t>(stop), reversed);
    for (int row = 0; row < 64; ++row) {
      uvec2& mask = covered[static_cast<size_t>(row)];
      const uvec2 own = samplesIn(sorted[stop].outline, row);
      const uvec2 shown = parallax ? samplesAround(sorted[stop].outline, parallax, row) : own;
      if ((shown.x & ~mask.x) | (shown.y & ~mask.y)) seen[stop] = true;
      mask |= own;
      holes = holes || (mask.x & mask.y) != ~0u;
    }
  }
  for (size_t i = 0; i < sorted.size(); ++i) {
    const auto nearer = [&](const Sorted& a, const Sorted& b) {
      const bool compact = isCompact(triangleOf(a.candidate)) && isCompact(triangleOf(b.candidate));
      return isNearerSomewhere(a.facet, b.facet) && overlap(cornersOf(a.candidate), cornersOf(b.candidate), compact);
    };
    bool doubtful = false;
    if (sorted.size() <= kBatch && seen[i])
      for (size_t j = i + 1; j < sorted.size() && !doubtful; ++j) doubtful = nearer(sorted[j], sorted[i]);
    else if (sorted.size() <= kBatch)
      for (size_t j = 0; j < i && !doubtful; ++j) doubtful = seen[j] && nearer(sorted[i], sorted[j]);
    const uint32_t id = sorted[i].candidate.id;
    if (doubtful ? isAhead(sorted, i) : seen[i]) bits[id / 32] |= 1u << (id % 32);
  }
}
} // namespace

TwinResult sampleExactOnCpu(const TwinInput& in) {
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
        if (!coversWide(piece.triangle, point) || !fillsPixel(piece.triangle, pixel, grid)) continue;
        const float z = depthWide(piece.triangle, point);
        if (depthKey(z, reversed) == out.depth[at(pixel)])
          limits[at(pixel)] = std::min(limits[at(pixel)], fillKey(piece.triangle, z, reversed));
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
