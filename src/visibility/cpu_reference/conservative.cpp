// Conservative sampling in plain loops.
#include "visibility/conservative/conservative.h"

#include "visibility/cpu_reference/cpu_reference.h"

#include <algorithm>

namespace gpgp::visibility {
namespace {
using namespace shader;

/// A triangle that may be seen, whole or in pieces.
struct Placed {
  CpuTriangle made;
  uint32_t id, item;
  vec3 normal;
  Grid grid;
  bool perspective;
};

struct Sampling {
  const CpuInput& in;
  const Params& params;
  std::vector<Placed> triangles;

  explicit Sampling(const CpuInput& input) : in(input), params(input.params) {
    forEachTriangle(in, [&](const DrawEntry& e, uint32_t local, uint32_t item) {
      uint32_t id = 0;
      if (!isSampled(in, e) || !numberOf(in, e, local, id)) return;
      Placed p{placeTriangle(in, e, local), id, item, {}, gridOf(params, e.camera), false};
      if (p.made.pieces.empty()) return;
      p.normal = normalOf(p.made.world[0], p.made.world[1], p.made.world[2]);
      const float* m = params.viewProjection + size_t(e.camera) * 16;
      p.perspective = m[3] != 0 || m[7] != 0 || m[11] != 0;
      triangles.push_back(std::move(p));
    });
  }

  size_t at(ivec2 pixel) const { return static_cast<size_t>(pixel.y) * params.width + static_cast<size_t>(pixel.x); }
  bool depths(const Placed& p, size_t piece, ivec2 pixel, float& nearest, float& farthest) const {
    return depthsInPixel(p.made.pieces[piece], p.made.depths[piece], pixel, p.perspective, params.reversedDepth != 0,
                         nearest, farthest);
  }
  /// All pixels that the boxes of a triangle's pieces touch.
  template <class Visit> void forEachPixel(const Placed& p, const Visit& visit) const {
    for (size_t i = 0; i < p.made.pieces.size(); ++i) {
      const ScreenTriangle& t = p.made.pieces[i];
      const ivec4 bounds = pixelBounds(t.p0, t.p1, t.p2, p.grid);
      for (int y = bounds.y; y < bounds.w; ++y)
        for (int x = bounds.x; x < bounds.z; ++x) visit(i, ivec2(x, y));
    }
  }

  std::vector<Surface> surfaces(CpuResult& out) const {
    std::vector<Surface> all(out.ids.size());
    for (const Placed& p : triangles) {
      std::vector<std::pair<size_t, bool>> known; // pixels of this triangle
      forEachPixel(p, [&](size_t piece, ivec2 pixel) {
        const size_t place = at(pixel);
        float nearest = 0, farthest = 0;
        if (out.ids[place] != p.item || !touches(p.made.pieces[piece], false, pixel) ||
            !depths(p, piece, pixel, nearest, farthest))
          return;
        Surface& s = all[place];
        const bool first = std::none_of(known.begin(), known.end(), [&](const auto& k) { return k.first == place; });
        if (p.made.fate == kClipped) known.emplace_back(place, true);
        s = {first ? nearest : std::min(s.nearest, nearest), first ? farthest : std::max(s.farthest, farthest),
             p.normal.x, p.normal.y, p.normal.z};
      });
    }
    std::vector<uint32_t> idOf;
    for (const Placed& p : triangles) {
      if (idOf.size() <= p.item) idOf.resize(p.item + 1);
      idOf[p.item] = p.id;
    }
    for (uint32_t& id : out.ids)
      if (id != kNoTriangle) id = idOf[id];
    return all;
  }

  bool isLargeWhole(const Placed& p) const {
    return std::any_of(p.made.pieces.begin(), p.made.pieces.end(), [](const ScreenTriangle& t) { return isLarge(t); });
  }

  void accept(CpuResult& out, const std::vector<Surface>& found) const {
    const std::vector<uint32_t> before = out.bits;
    for (const Placed& p : triangles) {
      if (before[p.id / 32] >> (p.id % 32) & 1) continue;
      if ((params.heuristics & kInCircle) && isLargeWhole(p)) continue;
      forEachPixel(p, [&](size_t piece, ivec2 pixel) {
        if (!touches(p.made.pieces[piece], isCompact(p.made.pieces[piece]), pixel)) return;
        if (params.heuristics & kDepths) {
          float nearest = 0, farthest = 0;
          if (out.ids[at(pixel)] == kNoTriangle) {
            if (!(params.heuristics & kKeepFront)) return;
          } else if (!depths(p, piece, pixel, nearest, farthest) ||
                     !acceptsDepths(found[at(pixel)], nearest, farthest, p.normal, params.heuristics,
                                    params.epsilonStatic, params.epsilonDynamic)) {
            return;
          }
        }
        out.bits[p.id / 32] |= 1u << (p.id % 32);
      });
    }
  }

  void refine(CpuResult& out, std::vector<uvec2>& covered) const {
    const std::vector<uint32_t> before = out.bits;
    const auto isSeen = [&](const Placed& p) { return (before[p.id / 32] >> (p.id % 32) & 1) != 0; };
    for (const Placed& p : triangles)
      if (isSeen(p))
        forEachPixel(p, [&](size_t piece, ivec2 pixel) {
          uvec2& mask = covered[at(pixel)];
          const uvec2 own = coverageOf(p.made.pieces[piece], pixel);
          mask = uvec2(mask.x | own.x, mask.y | own.y);
        });
    std::vector<uint32_t> nearestOf(covered.size() * kQuarters, kFarthest);
    for (const bool take : {false, true})
      for (const Placed& p : triangles) {
        if (isSeen(p)) continue;
        forEachPixel(p, [&](size_t piece, ivec2 pixel) {
          const uvec2 mask = covered[at(pixel)], all = coverageOf(p.made.pieces[piece], pixel);
          const uvec2 own(all.x & ~mask.x, all.y & ~mask.y);
          float nearest = 0, farthest = 0;
          if (!(own.x | own.y) || !depths(p, piece, pixel, nearest, farthest)) return;
          for (uint32_t quarter = 0; quarter < kQuarters; ++quarter) {
            if (!inQuarter(own, quarter)) continue;
            uint32_t& least = nearestOf[at(pixel) * kQuarters + quarter];
            if (!take)
              least = std::min(least, floatBitsToUint(nearest));
            else if (least == floatBitsToUint(nearest))
              out.bits[p.id / 32] |= 1u << (p.id % 32);
          }
        });
      }
  }
};
} // namespace

CpuResult sampleConservativelyOnCpu(const CpuInput& input, uint32_t refinements) {
  CpuInput in = input;
  in.params.method = kConservative;
  CpuResult out = sampleOnCpu(in); // ids: work items
  const Sampling sampling(in);
  const std::vector<Surface> found = sampling.surfaces(out);
  gather(in, out);
  showThrough(in, out);
  sampling.accept(out, found);
  std::vector<uvec2> covered(out.ids.size(), uvec2(0, 0));
  for (uint32_t i = 0; i < refinements; ++i) sampling.refine(out, covered);
  finish(in, out);
  return out;
}

} // namespace gpgp::visibility
