// The visible bits and the history's, in kListBlocks parts that lie one behind the other.
#include "visibility/shared/layout.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer {
  Counters counters;
  uint blocks[]; // of each part: visible, appeared, disappeared
};
#include "visibility/reuse/reuse.glsl"
layout(std430, set = 0, binding = kBindBits) readonly buffer BitBuffer { uint bits[]; };

uint bitWords() { return (params.triangleCount + 31u) / 32u; }
uint allWords() { return max(bitWords(), params.viewWords); }
uint blockWords() { return (allWords() + kListBlocks - 1u) / kListBlocks; }
uint blockBegin() { return min(gl_WorkGroupID.x * blockWords(), allWords()); }
uint blockEnd() { return min(blockBegin() + blockWords(), allWords()); }

struct Changes {
  uint now;
  uint appeared;
  uint disappeared;
};

Changes changesOf(uint word) {
  Changes c;
  c.now = word < bitWords() ? bits[word] : 0u;
  // What was there may have more.
  if (word + 1u == bitWords()) c.now &= 0xffffffffu >> (bitWords() * 32u - params.triangleCount);
  uint before = word < params.viewWords ? viewBits[word] : c.now;
  c.appeared = c.now & ~before;
  c.disappeared = before & ~c.now;
  return c;
}
