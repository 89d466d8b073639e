// Decides a part of a pixel's list, front to back: a team of 32 invocations holds two of the pixel's 64 rows of 64
// samples each. A triangle with a sample that nothing before it covers is visible. Needs kRanked: how many entries are
// sorted together; kTeams: how many a workgroup has.
layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
#include "visibility/lists.glsl"
layout(std430, set = 0, binding = kBindBits) buffer BitBuffer { uint bits[]; };
layout(std430, set = 0, binding = kBindOpen) readonly buffer OpenBuffer { uint open[]; };
#include "visibility/candidates.glsl"
layout(std430, set = 0, binding = kBindEntries) buffer EntryBuffer { uint entries[]; };

shared uint items[kTeams][kRanked]; // candidates of entries that are sorted
shared uvec4 keys[kTeams][kRanked / 4u];
shared vec4 starts[kTeams][kBatch]; // outlines of a batch
shared vec4 steps[kTeams][kBatch];
shared ivec2 rows[kTeams][kBatch];
shared uint ids[kTeams][kBatch];
shared uint taken[kTeams][kRanked / 32u]; // bits: ranks that entries have
shared uint ties[kTeams];                 // 1: two have the same
shared uint seen[kTeams];  // a bit for each of a batch's
shared uint holes[kTeams]; // 1: samples that nothing covers yet
shared uint stops[kTeams]; // how many of a batch come before all samples are covered

uint team() { return gl_LocalInvocationIndex / kBatch; }
uint laneOf() { return gl_LocalInvocationIndex % kBatch; }

void show(uint id) {
  uint bit = 1u << (id & 31u);
  if ((bits[id >> 5u] & bit) == 0u) atomicOr(bits[id >> 5u], bit);
}

/// Where entries have the same depth: by number, then place; the last only tells twins apart.
bool precedes(uint i, uint j) {
  Candidate a = readCandidate(items[team()][i]);
  Candidate b = readCandidate(items[team()][j]);
  if (a.id != b.id) return a.id < b.id;
  if (a.p1.x != b.p1.x) return a.p1.x < b.p1.x;
  if (a.p1.y != b.p1.y) return a.p1.y < b.p1.y;
  return i < j;
}

/// Before entries are ranked. A barrier must follow.
void clearRanks() {
  if (laneOf() < kRanked / 32u) taken[team()][laneOf()] = 0u;
  if (laneOf() == 0u) ties[team()] = 0u;
}

/// How many of `n` entries, whose keys are there, are nearer than one of them.
uint rankOf(uint i, uint n) {
  uint key = keys[team()][i >> 2u][i & 3u];
  uint before = 0u;
  uint quads = n / 4u;
  for (uint j = 0u; j < quads; ++j) {
    uvec4 other = keys[team()][j];
    before += uint(other.x < key) + uint(other.y < key) + uint(other.z < key) + uint(other.w < key);
  }
  for (uint j = quads * 4u; j < n; ++j) before += uint(keys[team()][quads][j & 3u] < key);
  uint bit = 1u << (before & 31u);
  if ((atomicOr(taken[team()][before >> 5u], bit) & bit) != 0u) ties[team()] = 1u;
  return before;
}

/// How many of those of the same depth come before it.
uint rankAmongSame(uint i, uint n) {
  uint key = keys[team()][i >> 2u][i & 3u];
  uint before = 0u;
  for (uint j = 0u; j < n; ++j)
    if (keys[team()][j >> 2u][j & 3u] == key && j != i && precedes(j, i)) ++before;
  return before;
}

void put(uint place, Outline o, uint id) {
  starts[team()][place] = o.start;
  steps[team()][place] = o.step;
  rows[team()][place] = ivec2(o.rowBegin, o.rowEnd);
  ids[team()][place] = id;
}

/// Goes through a batch, whose outlines and ids are there, and notes which are seen.
void lookAtBatch(uint batch, inout uvec4 covered) {
  int row = int(laneOf());
  if (row == 0) {
    seen[team()] = 0u;
    holes[team()] = 0u;
    stops[team()] = 0u;
  }
  barrier();
  uint found = 0u;
  uint k = 0u;
  for (; k < batch && (covered.x & covered.y & covered.z & covered.w) != 0xffffffffu; ++k) {
    Outline o;
    o.start = starts[team()][k];
    o.step = steps[team()][k];
    o.rowBegin = rows[team()][k].x;
    o.rowEnd = rows[team()][k].y;
    uvec4 own = uvec4(samplesIn(o, row), samplesIn(o, row + 32)) & ~covered;
    if ((own.x | own.y | own.z | own.w) != 0u) found |= 1u << k;
    covered |= own;
  }
  if (found != 0u) atomicOr(seen[team()], found);
  atomicMax(stops[team()], k);
  if ((covered.x & covered.y & covered.z & covered.w) != 0xffffffffu) holes[team()] = 1u;
  barrier();
}

/// The same, and shows them; false once all samples are covered.
bool resolveBatch(uint batch, inout uvec4 covered) {
  lookAtBatch(batch, covered);
  if ((seen[team()] & (1u << laneOf())) != 0u) show(ids[team()][laneOf()]);
  bool more = holes[team()] != 0u;
  barrier();
  return more;
}
