// A workgroup a tile of a camera's picture: the nearest and the farthest that its pixels' centres show, and its parts'.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/nearby.h"
layout(local_size_x = 64) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindDepth) readonly buffer DepthBuffer { uint depths[]; };
layout(std430, set = 0, binding = kBindTiles) writeonly buffer TileBuffer { Tile tiles[]; };

const uint kParts = kTileParts * kTileParts;
shared uint nearest[kParts + 1u]; // keys: of the parts, and of the tile
shared uint farthest[kParts + 1u];

void main() {
  uvec2 tile = gl_WorkGroupID.xy % kMaxTiles;
  uint camera = gl_WorkGroupID.y / kMaxTiles;
  uint side = tileSide(params.width, params.height);
  uvec2 first = tile * side;
  if (first.x >= params.width || first.y >= params.height) return;
  uint lane = gl_LocalInvocationIndex;
  if (lane <= kParts) {
    nearest[lane] = kFarthest;
    farthest[lane] = 0u;
  }
  barrier();
  uint partSide = side / kTileParts;
  for (uint i = lane; i < side * side; i += 64u) {
    uvec2 at = uvec2(i % side, i / side);
    uvec2 pixel = first + at;
    if (pixel.x >= params.width || pixel.y >= params.height) continue;
    uint key = depths[(camera * params.height + pixel.y) * params.width + pixel.x];
    uint part = at.y / partSide * kTileParts + at.x / partSide;
    atomicMin(nearest[part], key);
    atomicMax(farthest[part], key);
  }
  barrier();
  if (lane < kParts) {
    atomicMin(nearest[kParts], nearest[lane]);
    atomicMax(farthest[kParts], farthest[lane]);
  }
  barrier();
  if (lane > kParts) return;
  bool reversed = params.reversedDepth != 0u;
  vec4 scale = params.depthScales[camera];
  Tile t;
  t.nearest = inverseOfKey(scale, nearest[lane], reversed);
  t.farthest = inverseOfKey(scale, farthest[lane], reversed);
  if (lane == kParts) tiles[tileAt(camera, false, tile.x, tile.y)] = t;
  uvec2 part = tile * kTileParts + uvec2(lane % kTileParts, lane / kTileParts);
  if (lane != kParts) tiles[tileAt(camera, true, part.x, part.y)] = t;
}
