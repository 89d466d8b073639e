// A workgroup a large tile of a camera's picture: the nearest and the farthest that its pixels' centres show, and its
// parts' and theirs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/nearby/nearby.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindSamples) readonly buffer SampleBuffer { uint samples[]; };
layout(std430, set = 0, binding = kBindTiles) writeonly buffer TileBuffer { Tile tiles[]; };

// Keys, the largest tile's first.
shared uint nearest[1 + 16 + 256];
shared uint farthest[1 + 16 + 256];

void write(uint level, uint camera, uvec2 tile, uint place) {
  bool reversed = params.reversedDepth != 0u;
  vec4 scale = params.depthScales[camera];
  Tile t;
  t.nearest = inverseOfKey(scale, nearest[place], reversed);
  t.farthest = inverseOfKey(scale, farthest[place], reversed);
  tiles[tileAt(camera, level, tile.x, tile.y)] = t;
}

void main() {
  uvec2 tile = gl_WorkGroupID.xy % kMaxTiles;
  uint camera = gl_WorkGroupID.y / kMaxTiles;
  uint side = tileSide(params.width, params.height, 0u);
  uvec2 first = tile * side;
  if (first.x >= params.width || first.y >= params.height) return;
  uint lane = gl_LocalInvocationIndex;
  for (uint i = lane; i < 273u; i += 256u) {
    nearest[i] = kFarthest;
    farthest[i] = 0u;
  }
  barrier();
  uint smallest = tileSide(params.width, params.height, 2u);
  for (uint i = lane; i < side * side; i += 256u) {
    uvec2 at = uvec2(i % side, i / side);
    uvec2 pixel = first + at;
    if (pixel.x >= params.width || pixel.y >= params.height) continue;
    uint key = samples[depthAt((camera * params.height + pixel.y) * params.width + pixel.x)];
    uint place = 17u + at.y / smallest * 16u + at.x / smallest;
    atomicMin(nearest[place], key);
    atomicMax(farthest[place], key);
  }
  barrier();
  uvec2 part = uvec2(lane % 16u, lane / 16u);
  uint middle = 1u + part.y / 4u * 4u + part.x / 4u;
  atomicMin(nearest[middle], nearest[17u + lane]);
  atomicMax(farthest[middle], farthest[17u + lane]);
  barrier();
  if (lane < 16u) {
    atomicMin(nearest[0], nearest[1u + lane]);
    atomicMax(farthest[0], farthest[1u + lane]);
  }
  barrier();
  write(2u, camera, tile * 16u + part, 17u + lane);
  if (lane < 16u) write(1u, camera, tile * 4u + uvec2(lane % 4u, lane / 4u), 1u + lane);
  if (lane == 0u) write(0u, camera, tile, 0u);
}
