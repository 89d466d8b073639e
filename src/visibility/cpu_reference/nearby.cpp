// Method nearby in plain loops.
#include "visibility/nearby/nearby.h"

#include "visibility/cpu_reference/cpu_reference.h"

#include <algorithm>

namespace gpgp::visibility {
namespace {
using namespace shader;

vec4 scaleOf(const Params& params, uint32_t camera) {
  const float* s = params.depthScales + size_t(camera) * 4;
  return {s[0], s[1], s[2], s[3]};
}

std::vector<Tile> tilesOf(const Params& params, const std::vector<uint32_t>& depth) {
  std::vector<Tile> tiles(size_t(params.cameraCount) * kCameraTiles, {0, 1e38f});
  for (uint32_t camera = 0; camera < params.cameraCount; ++camera)
    for (uint32_t y = 0; y < params.height; ++y)
      for (uint32_t x = 0; x < params.width; ++x) {
        const uint32_t key = depth[(size_t(camera) * params.height + y) * params.width + x];
        const float inverse = inverseOfKey(scaleOf(params, camera), key, params.reversedDepth != 0);
        for (uint32_t level = 0; level < kTileLevels; ++level) {
          const uint32_t side = tileSide(params.width, params.height, level);
          Tile& tile = tiles[tileAt(camera, level, x / side, y / side)];
          tile = {std::max(tile.nearest, inverse), std::min(tile.farthest, inverse)};
        }
      }
  return tiles;
}

bool isNearby(const Params& params, const std::vector<Tile>& tiles, const ScreenTriangle& t, uint32_t camera,
              uint32_t level) {
  const Grid grid = gridOf(params, camera);
  const ivec4 bounds = pixelBounds(t.p0, t.p1, t.p2, grid);
  if (bounds.x >= bounds.z || bounds.y >= bounds.w) return false;
  const uint32_t side = tileSide(params.width, params.height, level);
  const vec4 scale = scaleOf(params, camera);
  const float own = nearestInverse(scale, t, params.reversedDepth != 0);
  const auto visit = [&](int reach, const auto& with) {
    const ivec4 range = tilesAround(bounds, reach, grid, side);
    for (int y = range.y; y <= range.w; ++y)
      for (int x = range.x; x <= range.z; ++x)
        with(tiles[tileAt(camera, level, static_cast<uint32_t>(x), static_cast<uint32_t>(y))]);
  };
  float occluder = 0;
  visit(0, [&](const Tile& tile) { occluder = std::max(occluder, tile.nearest); });
  bool shown = false;
  visit(reachOf(scale, occluder, own), [&](const Tile& tile) { shown = shown || mayShow(own, tile.farthest); });
  return shown;
}
} // namespace

CpuResult sampleNearbyOnCpu(const CpuInput& in) {
  CpuResult out = sampleOnCpu(in);
  const std::vector<Tile> tiles = tilesOf(in.params, out.depth);
  forEachTriangle(in, [&](const DrawEntry& e, uint32_t local, uint32_t) {
    uint32_t id = 0;
    if (!isSampled(in, e) || !numberOf(in, e, local, id)) return;
    const CpuTriangle placed = placeTriangle(in, e, local);
    const bool clipped = placed.fate == kClipped;
    bool shown = clipped || placed.fate == kWhole;
    for (uint32_t level = 0; level < kTileLevels && shown && !clipped; ++level)
      shown = isNearby(in.params, tiles, placed.pieces[0], e.camera, level);
    if (shown) out.bits[id / 32] |= 1u << (id % 32);
  });
  for (auto* list : {&out.list, &out.drawCommands, &out.drawIndices, &out.drawTriangles}) list->clear();
  out.counters.appeared = out.counters.disappeared = 0;
  finish(in, out);
  return out;
}

} // namespace gpgp::visibility
