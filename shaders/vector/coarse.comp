#version 460
// The upper level: which groups of patches may touch each coarse tile, as bits.
#extension GL_GOOGLE_include_directive : require
#include "canvas.glsl"
layout(local_size_x = 64) in;

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= header.coarseCount * header.groupWords) return;
  const uint tile = i / header.groupWords, word = i % header.groupWords;
  const vec2 low = vec2(tile % header.coarseX, tile / header.coarseX) * float(kCoarseSize);
  const vec2 high = low + float(kCoarseSize);
  uint mask = 0;
  for (uint bit = 0; bit < 32 && word * 32 + bit < header.groupCount; ++bit) {
    const vec4 box = groupBoxes[word * 32 + bit];
    if (box.x < high.x && box.z > low.x && box.y < high.y && box.w > low.y) mask |= 1u << bit;
  }
  coarseMasks[i] = mask;
}
