#version 460
// For software devices: clears the words of paths' tiles (WORDS), or the entries that tiles have.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
layout(local_size_x = 64) in;
#if !WORDS
layout(set = 0, binding = kBindEntries, std430) writeonly buffer Entries { uvec4 entries[]; };
#endif

void main() {
  const uint lanes = gl_NumWorkGroups.x * gl_NumWorkGroups.y * gl_NumWorkGroups.z * 64;
  const uint group = gl_WorkGroupID.z * gl_NumWorkGroups.x * gl_NumWorkGroups.y + groupIndex();
  const uint i = group * 64 + gl_LocalInvocationIndex;
#if WORDS
  const uint end = min(counters.words, header.wordLimit);
  for (uint k = i; k < end; k += lanes) wordVectors[k] = uvec4(0);
#else
  const uint end = min(counters.entries, header.entryLimit) * (kEntryWords / 4);
  for (uint k = i * 4; k < end; k += lanes * 4)
    entries[k] = entries[k + 1] = entries[k + 2] = entries[k + 3] = uvec4(0);
#endif
}
