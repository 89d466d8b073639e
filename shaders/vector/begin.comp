#version 460
// A record's constants to the device, as the passes would else wait for host memory at every read, and what they begin
// with: no path in any bin, nothing counted, no tile marked. Software devices clear the latter two faster by transfers.
#extension GL_GOOGLE_include_directive : require
#include "layout.h"
// In vec4: slots[] take 2 each, items[] 7.
layout(local_size_x = 64) in;
layout(set = 0, binding = 11, std430) readonly buffer From { CanvasHeader header; uvec4 from[]; };
layout(set = 0, binding = 17, std430) writeonly buffer To { CanvasHeader copied; uvec4 to[]; };
layout(set = 0, binding = 14, std430) writeonly buffer Bins { uint bins[]; };
#if !SOFTWARE
layout(set = 0, binding = 13, std430) writeonly buffer Words { uvec4 words[]; };
layout(set = 0, binding = 16, std430) writeonly buffer Counters { uvec4 counters[]; };
#endif

void main() {
  const uint lane = gl_GlobalInvocationID.x, lanes = gl_NumWorkGroups.x * 64;
#if !SOFTWARE
  for (uint i = lane; i < words.length(); i += lanes) words[i] = uvec4(0);
  if (lane < counters.length()) counters[lane] = uvec4(0);
#endif
  if (lane == 0) copied = header;
  const uint constants = kMaxSlots * 2 + header.itemCount * 7;
  for (uint i = lane; i < constants; i += lanes) to[i] = from[i];
  const uint binWords = kFirstBin + header.binCount * header.pathWords;
  for (uint i = lane; i < binWords; i += lanes) bins[i] = i < kFirstBin && i % 4 == 2 ? 1 : 0;
}
