#version 460
// For software devices: clears the entries that tiles have.
#extension GL_GOOGLE_include_directive : require
#include "canvas.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 15, std430) writeonly buffer Entries { uvec4 entries[]; };

void main() {
  const uint end = min(counters.entries, header.entryLimit) * (kEntryWords / 4);
  const uint lanes = gl_NumWorkGroups.x * gl_NumWorkGroups.y * gl_NumWorkGroups.z * 64;
  const uint group = gl_WorkGroupID.z * gl_NumWorkGroups.x * gl_NumWorkGroups.y + groupIndex();
  for (uint i = (group * 64 + gl_LocalInvocationIndex) * 4; i < end; i += lanes * 4)
    entries[i] = entries[i + 1] = entries[i + 2] = entries[i + 3] = uvec4(0);
}
