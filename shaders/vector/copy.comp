#version 460
// A record's constants to the device: the passes would else wait for host memory at every read.
#extension GL_GOOGLE_include_directive : require
#include "layout.h"
layout(local_size_x = 64) in;
layout(set = 0, binding = 11, std430) readonly buffer From { uvec4 from[]; };
layout(set = 0, binding = 17, std430) writeonly buffer To { uvec4 to[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i < to.length() && i < from.length()) to[i] = from[i];
}
