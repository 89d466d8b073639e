// Triangles of alpha-tested and see-through draws in plain loops.
#include "visibility/cpu_reference/cpu_reference.h"
#include "visibility/shared/position.h"

namespace gpgp::visibility {
using namespace shader;
namespace {

vec2 coordinatesOf(const CpuInput& in, const DrawEntry& e, uint32_t index) {
  const Params& params = in.params;
  uint32_t vertex = 0;
  if (!fetchPlace(in, e, index, vertex) || vertex >= params.textureCount) return vec2(0);
  const uint32_t bytes = params.textureFormat == kFloats ? 4 : 2;
  vec2 place;
  for (uint32_t i = 0; i < 2; ++i) {
    const size_t byte = size_t(vertex) * params.textureStride + params.textureOffset + size_t(i) * bytes;
    const uint32_t word = in.coordinates[byte / 4], half = byte % 4 ? word >> 16 : word & 0xffffu;
    const float v = params.textureFormat == kFloats   ? uintBitsToFloat(word)
                    : params.textureFormat == kHalves ? halfToFloat(half)
                                                      : unormToFloat(half);
    if (!isModerate(v)) return vec2(0);
    place[static_cast<int>(i)] = v;
  }
  return place;
}
} // namespace

CpuNonOpaque nonOpaqueOf(const CpuInput& in, const DrawEntry& e, uint32_t local, const CpuTriangle& placed) {
  CpuNonOpaque open;
  open.flags = in.draws[e.draw].flags;
  if (!alphaTestOf(open.flags) || placed.pieces.empty()) return open;
  const Grid grid = gridOf(in.params, e.camera);
  const ivec2 origin =
      placed.fate == kWhole ? placed.pieces[0].p0 : ivec2(grid.pixels.x * 128, grid.pixels.y * 128 + grid.top * 256);
  vec2 at[3];
  for (uint32_t i = 0; i < 3; ++i) at[i] = coordinatesOf(in, e, e.firstIndex + local * 3 + i);
  open.plane = texturePlaneOf(placed.clip[0], placed.clip[1], placed.clip[2], at[0], at[1], at[2], origin, grid);
  return open;
}

bool passesAlpha(const CpuInput& in, const CpuNonOpaque& open, ivec2 point) {
  const uint32_t test = alphaTestOf(open.flags);
  vec2 place;
  if (test == 0 || !texturePlace(open.plane, point, place)) return true;
  return in.alphaAt(test - 1, place) >= in.params.alphaTests[(test - 1) * 2];
}

void showThrough(const CpuInput& in, CpuResult& out) {
  const Params& params = in.params;
  if (!params.maxNonOpaque) return;
  const Grid grid = gridOf(params);
  const auto width = static_cast<size_t>(samplesOf(grid).x);
  forEachTriangle(in, [&](const DrawEntry& e, uint32_t local, uint32_t) {
    uint32_t id = 0;
    if (!isSeeThrough(in.draws[e.draw].flags) || !isSampled(in, e) || !numberOf(in, e, local, id)) return;
    const CpuTriangle placed = placeTriangle(in, e, local);
    const CpuNonOpaque open = nonOpaqueOf(in, e, local, placed);
    for (const ScreenTriangle& t : placed.pieces) {
      const int margin = marginOf(t, grid.margin);
      for (int y = t.bounds.y; y < t.bounds.w; ++y)
        for (int x = t.bounds.x; x < t.bounds.z; ++x) {
          const ivec2 point = samplePoint(ivec2(x, y), grid);
          if (!coversWide(t, margin, point)) continue;
          const uint32_t key = depthKey(depthWide(t, point), params.reversedDepth != 0);
          if (key > out.depth[size_t(y) * width + static_cast<size_t>(x)] || !passesAlpha(in, open, point)) continue;
          out.bits[id / 32] |= 1u << (id % 32);
          if (!out.sizes.empty()) ++out.sizes[id];
        }
    }
  });
}

} // namespace gpgp::visibility
