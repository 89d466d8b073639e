// What each of kListBlocks parts of the visible bits holds, so that list.comp knows where each part's triangles go. A
// workgroup a part.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/outputs/list.glsl"

shared uint sums[6];

void main() {
  uint lane = gl_LocalInvocationIndex;
  if (lane < 6u) sums[lane] = 0u;
  barrier();
  uvec3 own = uvec3(0u);
  uvec3 due = uvec3(0u); // of what is decided again: visible, late, kept too long
  for (uint word = blockBegin() + lane; word < blockEnd(); word += 256u) {
    Changes c = changesOf(word);
    own += uvec3(bitCount(c.now), bitCount(c.appeared), bitCount(c.disappeared));
    if (params.reuse != 0u && word < params.viewWords && isDue(word))
      due += uvec3(bitCount(c.now), bitCount(c.appeared & viewBits[knownAt(word)]),
                   bitCount(c.disappeared & viewBits[metAt(word)]));
  }
  for (int i = 0; i < 3; ++i) {
    if (own[i] != 0u) atomicAdd(sums[i], own[i]);
    if (due[i] != 0u) atomicAdd(sums[3 + i], due[i]);
  }
  barrier();
  if (lane < 3u) blocks[gl_WorkGroupID.x * 3u + lane] = sums[lane];
  if (lane == 0u && sums[0] != 0u) atomicAdd(counters.visible, sums[0]);
  if (lane == 1u && sums[1] != 0u) atomicAdd(counters.appeared, sums[1]);
  if (lane == 2u && sums[2] != 0u) atomicAdd(counters.disappeared, sums[2]);
  if (lane == 3u && sums[3] != 0u) atomicAdd(counters.dueVisible, sums[3]);
  if (lane == 4u && sums[4] != 0u) atomicAdd(counters.dueLate, sums[4]);
  if (lane == 5u && sums[5] != 0u) atomicAdd(counters.dueStale, sums[5]);
}
