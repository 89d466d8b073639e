// The pictures that operations work on, and the operation at hand.
#include "vector/layers/blend.h"
#include "vector/layers/operation.h"
#include "vector/shared/color.h"
#define SCISSORS 0
#include "vector/shared/canvas.glsl"
layout(set = 0, binding = kBindPictures, std430) buffer Pictures { uvec2 pictures[]; };
layout(set = 0, binding = kBindOperations, std430) readonly buffer Operations { OperationRecord operations[]; };
layout(push_constant) uniform Which { uint operationIndex; };

vec4 texelAt(PictureRecord p, int x, int y) {
  if (x < p.left || x >= p.right || y < p.top || y >= p.bottom) return vec4(0);
  const uvec2 packed = pictures[p.first + uint(y - p.top) * p.stride + uint(x - p.left)];
  return vec4(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y));
}
vec4 tableAt(uint slot, uint entry) { return fetch(slot, entry); }
void storeTexel(PictureRecord p, int x, int y, vec4 color) {
  pictures[p.first + uint(y - p.top) * p.stride + uint(x - p.left)] =
      uvec2(packHalf2x16(color.rg), packHalf2x16(color.ba));
}
