#version 460
// The lower level: one workgroup walks the patches of one tile in painting order.
//
// Push constant 0: counts entries, beginning with the last opaque patch that covers the whole tile. 1: counts all
// entries by path, to find which paths fit the budget (only when they did not). 2: counts again without the paths that
// do not fit. 3: writes the entries. Order comes from the patches' numbers alone, so the lists need no sorting.
#extension GL_GOOGLE_include_directive : require
#include "canvas.glsl"
layout(local_size_x = 64) in;
layout(push_constant) uniform Pass { uint mode; };
shared uint hits[2];
shared uint solid; // 1 + lane of the last covering one

void main() {
  const uint lane = gl_LocalInvocationID.x;
  const uvec2 at = gl_WorkGroupID.xy;
  const uint tile = at.y * header.tilesX + at.x;
  const uint perCoarse = kCoarseSize / kTileSize;
  const uint coarse = (at.y / perCoarse) * header.coarseX + at.x / perCoarse;
  const vec2 low = vec2(at) * float(kTileSize), high = low + float(kTileSize);
  const uvec4 known = mode == 3 ? tiles[tile] : uvec4(0);
  uint count = 0, start = 0;
  for (uint word = 0; word < header.groupWords; ++word) {
    uint groups = coarseMasks[coarse * header.groupWords + word];
    while (groups != 0) {
      const uint bit = findLSB(groups);
      groups &= groups - 1;
      const uint first = (word * 32 + bit) * kPatchGroup;
      if (mode == 3 && first + kPatchGroup <= known.z) continue;
      barrier(); // the last round's shared values have been read
      if (lane < 2) hits[lane] = 0;
      if (lane == 2) solid = 0;
      barrier();
      const uint i = first + lane;
      uint flags = 0;
      if (i < header.patchCount && i >= known.z) {
        const PatchRecord p = patches[i];
        if (mode < 2 || p.path < counters.cutPath) {
          flags = classifyPixels(items[p.item], p, curves[p.left], curves[p.right], low.x, low.y, high.x, high.y);
          if (flags != 0) {
            if (mode == 1) atomicAdd(pathCounts[p.path], 1);
            atomicOr(hits[lane / 32], 1u << (lane % 32));
            if (flags == 1 && paths[p.path].color.a == 1.0) atomicMax(solid, lane + 1);
          }
        }
      }
      barrier();
      uvec2 mask = uvec2(hits[0], hits[1]);
      if (mode == 3) {
        if (flags != 0) {
          const uvec2 before = lane < 32 ? uvec2((1u << lane) - 1, 0) : uvec2(~0u, (1u << (lane - 32)) - 1);
          const uint place = count + bitCount(mask.x & before.x) + bitCount(mask.y & before.y);
          if (place < known.y) entries[known.x + place] = i | (flags & ~1u);
        }
      } else if (mode != 1 && solid != 0) {
        const uint l = solid - 1;
        mask &= l < 32 ? uvec2(~0u << l, ~0u) : uvec2(0, ~0u << (l - 32));
        count = 0;
        start = first + l;
      }
      count += bitCount(mask.x) + bitCount(mask.y);
    }
  }
  if (lane == 0 && (mode == 0 || mode == 2)) tiles[tile] = uvec4(0, count, start, 0);
}
