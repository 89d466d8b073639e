// Decides a part of a pixel's list, front to back: a workgroup of 32 invocations, each of which holds two of the
// pixel's 64 rows of 64 samples. A triangle with a sample that nothing before it covers is visible. Needs kRanked: how
// many entries are sorted together.
layout(local_size_x = 32) in; // kBatch

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
#include "visibility/lists.glsl"
layout(std430, set = 0, binding = kBindBits) buffer BitBuffer { uint bits[]; };
layout(std430, set = 0, binding = kBindOpen) readonly buffer OpenBuffer { uint open[]; };
#include "visibility/candidates.glsl"
layout(std430, set = 0, binding = kBindEntries) buffer EntryBuffer { uint entries[]; };

shared uint items[kRanked]; // candidates of entries that are sorted
shared uvec4 keys[kRanked / 4u];
shared vec4 starts[kBatch]; // outlines of a batch
shared vec4 steps[kBatch];
shared uint rows[kBatch];
shared uint ids[kBatch];
shared uint taken[kRanked / 32u]; // bits: ranks that entries have
shared uint ties;                 // 1: two have the same
shared uint seen;                 // a bit for each of a batch's
shared uint holes;                // 1: samples that nothing covers yet
shared uint stops;                // how many of a batch come before all samples are covered

uint laneOf() { return gl_LocalInvocationIndex; }

bool isShown(uint id) { return (bits[id >> 5u] & (1u << (id & 31u))) != 0u; }
void show(uint id) {
  if (!isShown(id)) atomicOr(bits[id >> 5u], 1u << (id & 31u));
}

/// Where entries have the same depth: by number, then place; the last only tells twins apart.
bool precedes(uint i, uint j) {
  Candidate a = readCandidate(items[i]);
  Candidate b = readCandidate(items[j]);
  if (a.id != b.id) return a.id < b.id;
  if (a.p1.x != b.p1.x) return a.p1.x < b.p1.x;
  if (a.p1.y != b.p1.y) return a.p1.y < b.p1.y;
  return i < j;
}

/// Before entries are ranked. A barrier must follow.
void clearRanks() {
  if (laneOf() < kRanked / 32u) taken[laneOf()] = 0u;
  if (laneOf() == 0u) ties = 0u;
}

/// How many of `n` entries, whose keys are there, are nearer than one of them.
uint rankOf(uint i, uint n) {
  uint key = keys[i >> 2u][i & 3u];
  uint before = 0u;
  uint quads = n / 4u;
  for (uint j = 0u; j < quads; ++j) {
    uvec4 other = keys[j];
    before += uint(other.x < key) + uint(other.y < key) + uint(other.z < key) + uint(other.w < key);
  }
  for (uint j = quads * 4u; j < n; ++j) before += uint(keys[quads][j & 3u] < key);
  return before;
}

/// Notes a rank, and that two have the same.
void takeRank(uint rank) {
  uint bit = 1u << (rank & 31u);
  if ((atomicOr(taken[rank >> 5u], bit) & bit) != 0u) ties = 1u;
}

/// How many of those of the same depth come before it.
uint rankAmongSame(uint i, uint n) {
  uint key = keys[i >> 2u][i & 3u];
  uint before = 0u;
  for (uint j = 0u; j < n; ++j)
    if (keys[j >> 2u][j & 3u] == key && j != i && precedes(j, i)) ++before;
  return before;
}

void put(uint place, Outline o, uint id) {
  starts[place] = o.start;
  steps[place] = o.step;
  rows[place] = uint(o.rowBegin) | uint(o.rowEnd) << 8u;
  ids[place] = id;
}

Outline outlineAt(uint place) {
  Outline o;
  o.start = starts[place];
  o.step = steps[place];
  o.rowBegin = int(rows[place] & 255u);
  o.rowEnd = int(rows[place] >> 8u);
  return o;
}

/// Goes through a batch, whose outlines and ids are there, and notes which are seen.
void lookAtBatch(uint batch, inout uvec4 covered) {
  int row = int(laneOf());
  if (row == 0) {
    seen = 0u;
    holes = 0u;
    stops = 0u;
  }
  barrier();
  uint found = 0u;
  uint k = 0u;
  for (; k < batch && (covered.x & covered.y & covered.z & covered.w) != 0xffffffffu; ++k) {
    Outline o = outlineAt(k);
    uvec4 own = uvec4(samplesIn(o, row), samplesIn(o, row + 32)) & ~covered;
    if ((own.x | own.y | own.z | own.w) != 0u) found |= 1u << k;
    covered |= own;
  }
  if (found != 0u) atomicOr(seen, found);
  atomicMax(stops, k);
  if ((covered.x & covered.y & covered.z & covered.w) != 0xffffffffu) holes = 1u;
  barrier();
}
