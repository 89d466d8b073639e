// From bits to lists in ascending order: what is visible, and what has changed since the last recording. A workgroup a
// part, one invocation a word of 32 triangles.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/outputs/list.glsl"
layout(std430, set = 0, binding = kBindList) writeonly buffer ListBuffer { uint list[]; };
layout(std430, set = 0, binding = kBindChanged) writeonly buffer ChangedBuffer { uint changed[]; };

shared uvec3 sums[256];

/// Sums up to each invocation.
void sumUp(uvec3 own) {
  uint lane = gl_LocalInvocationIndex;
  sums[lane] = own;
  barrier();
  for (uint step = 1u; step < 256u; step *= 2u) {
    uvec3 before = lane >= step ? sums[lane - step] : uvec3(0u);
    barrier();
    sums[lane] += before;
    barrier();
  }
}

void change(uint place, uint word, uint which) {
  for (; which != 0u && place < params.changedCapacity; which &= which - 1u)
    changed[kChangedHeader + place++] = word * 32u + uint(findLSB(which));
}

/// What is on the screen now was there before the next recording. Where all was taken over, that has not changed.
void remember(uint word) {
  if (params.reuse != 0u && counters.reuseShare != 0u) viewBits[knownAt(word)] = viewBits[metAt(word)];
  viewBits[metAt(word)] = 0u;
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  uvec3 before = uvec3(0u);
  for (uint i = lane; i < gl_WorkGroupID.x; i += 256u)
    before += uvec3(blocks[i * 3u], blocks[i * 3u + 1u], blocks[i * 3u + 2u]);
  sumUp(before);
  uvec3 first = sums[255];
  barrier();
  first.z += counters.appeared; // those that disappeared come behind all that appeared
  for (uint base = blockBegin(); base < blockEnd(); base += 256u) {
    uint word = base + lane;
    Changes c;
    c.now = 0u;
    c.appeared = 0u;
    c.disappeared = 0u;
    if (word < blockEnd()) c = changesOf(word);
    uvec3 own = uvec3(bitCount(c.now), bitCount(c.appeared), bitCount(c.disappeared));
    sumUp(own);
    uvec3 place = first + sums[lane] - own;
    first += sums[255];
    barrier();
    change(place.y, word, c.appeared);
    change(place.z, word, c.disappeared);
    if ((c.appeared | c.disappeared) != 0u) viewBits[word] = c.now;
    if (params.keepsDecisions != 0u && word < blockEnd() && word < params.viewWords) remember(word);
    for (uint now = c.now; now != 0u && place.x < params.listCapacity; now &= now - 1u)
      list[place.x++] = word * 32u + uint(findLSB(now));
  }
}
