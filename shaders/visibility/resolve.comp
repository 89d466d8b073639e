// Two teams of a workgroup decide a pixel's list each, of at most kBatch. What the order by one depth each may have
// wrong is decided by planes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/layout.h"
layout(local_size_x = 64) in; // kTeams * kBatch

const uint kRanked = kBatch;
const uint kTeams = 2u;
const uint kSuspectsEach = 8u;
#include "visibility/resolve.glsl"
#include "visibility/facet.h"

shared vec4 planes[kTeams][kBatch]; // facets of the sorted entries: plane, nearest
shared float farthest[kTeams][kBatch];
shared uint boxes[kTeams][kBatch];
shared uint sorted[kTeams][kBatch]; // their candidates
shared uint doubtful[kTeams];       // bits: entries that the order may have wrong
shared uint kept[kTeams];           // those of them that are seen
shared uint shown[kTeams];          // those that other pixels showed
shared uint suspects[kTeams][kBatch * kSuspectsEach]; // an entry and one that it may be in the wrong order with
shared uint suspectCount[kTeams];
shared uint moreSuspects;

void putFacet(uint place, Facet f, uint candidate) {
  planes[team()][place] = vec4(f.plane, f.nearest);
  farthest[team()][place] = f.farthest;
  boxes[team()][place] = uint(f.box.x) | uint(f.box.y) << 8u | uint(f.box.z) << 16u | uint(f.box.w) << 24u;
  sorted[team()][place] = candidate;
}

Facet facetAt(uint place) {
  vec4 plane = planes[team()][place];
  uint box = boxes[team()][place];
  Facet f;
  f.plane = plane.xyz;
  f.nearest = plane.w;
  f.farthest = farthest[team()][place];
  f.box = ivec4(box & 255u, box >> 8u & 255u, box >> 16u & 255u, box >> 24u);
  return f;
}

Outline outlineAt(uint place) {
  Outline o;
  o.start = starts[team()][place];
  o.step = steps[team()][place];
  o.rowBegin = rows[team()][place].x;
  o.rowEnd = rows[team()][place].y;
  return o;
}

/// Bits: those that an entry may be in the wrong order with, by their depths alone. Entries that are shown already need
/// no answer.
uint suspectsOf(uint place, uint n) {
  uint bit = 1u << place;
  if ((shown[team()] & bit) != 0u) return 0u;
  bool claimed = (seen[team()] & bit) != 0u;
  float own = claimed ? farthest[team()][place] : planes[team()][place].w;
  uint found = 0u;
  for (uint j = 0u; j < n; ++j)
    if (claimed ? planes[team()][j].w < own : own < farthest[team()][j]) found |= 1u << j;
  return found & (claimed ? ~(bit | bit - 1u) : (1u << min(place, stops[team()])) - 1u);
}

/// Whether two entries are in the wrong order: one that is seen before one that is nearer, or one that is hidden
/// behind one that is farther.
bool isWrong(uint place, uint other) {
  bool claimed = (seen[team()] & (1u << place)) != 0u;
  uint nearer = claimed ? other : place;
  uint farther = claimed ? place : other;
  return isNearerSomewhere(facetAt(nearer), facetAt(farther)) &&
         overlap(readCandidate(sorted[team()][nearer]), readCandidate(sorted[team()][farther]));
}

/// Notes entries that the order may have wrong. Few have suspects: the pairs are shared out.
void findDoubtful(uint n) {
  uint lane = laneOf();
  uint left = lane < n ? suspectsOf(lane, n) : 0u;
  bool again = true;
  while (again) {
    if (lane == 0u) suspectCount[team()] = 0u;
    if (gl_LocalInvocationIndex == 0u) moreSuspects = 0u;
    barrier();
    if (left != 0u) {
      uint count = min(uint(bitCount(left)), kSuspectsEach);
      uint first = atomicAdd(suspectCount[team()], count);
      for (uint i = first; i < first + count; ++i) {
        suspects[team()][i] = lane | uint(findLSB(left)) << 8u;
        left &= left - 1u;
      }
      if (left != 0u) moreSuspects = 1u;
    }
    barrier();
    for (uint i = lane; i < suspectCount[team()]; i += kBatch) {
      uint place = suspects[team()][i] & 255u;
      if (isWrong(place, suspects[team()][i] >> 8u)) atomicOr(doubtful[team()], 1u << place);
    }
    again = moreSuspects != 0u;
    barrier();
  }
}

/// Whether an entry has a sample, in this invocation's rows, at which none of the others is nearer.
bool isAhead(uint place, uint n) {
  int row = int(laneOf());
  Outline o = outlineAt(place);
  Facet own = facetAt(place);
  uint id = ids[team()][place];
  uvec4 rest = uvec4(samplesIn(o, row), samplesIn(o, row + 32));
  for (uint j = 0u; j < n && (rest.x | rest.y | rest.z | rest.w) != 0u; ++j) {
    if (j == place || planes[team()][j].w > own.farthest) continue;
    Crossing crossing = crossingOf(facetAt(j), own, ids[team()][j] < id);
    Outline other = outlineAt(j);
    rest &= ~uvec4(samplesAhead(other, crossing, row), samplesAhead(other, crossing, row + 32));
  }
  return (rest.x | rest.y | rest.z | rest.w) != 0u;
}

/// After the order has proposed which are seen: corrects that, and shows them.
void settle(uint n) {
  uint lane = laneOf();
  findDoubtful(n);
  for (uint left = doubtful[team()]; left != 0u; left &= left - 1u) {
    uint place = uint(findLSB(left));
    if (isAhead(place, n)) atomicOr(kept[team()], 1u << place);
  }
  barrier();
  uint visible = (seen[team()] & ~doubtful[team()] | kept[team()]) & ~shown[team()];
  if ((visible & (1u << lane)) != 0u) show(ids[team()][lane]);
}

/// A list that is one batch.
void resolveShort(uint begin, uint n, ivec2 pixel) {
  uint lane = laneOf();
  Outline o;
  Facet f;
  uint id = 0u;
  uint place = 0u;
  clearRanks();
  if (lane == 0u) {
    doubtful[team()] = 0u;
    kept[team()] = 0u;
    shown[team()] = 0u;
  }
  if (lane < n) {
    items[team()][lane] = entries[begin + lane];
    Candidate c = readCandidate(items[team()][lane]);
    o = outlineOf(c, pixel);
    id = c.id;
    keys[team()][lane >> 2u][lane & 3u] = middleKey(c, o, pixel, params.reversedDepth != 0u);
    f = facetOf(c, pixel, params.reversedDepth != 0u);
  }
  barrier();
  if (lane < n) place = rankOf(lane, n);
  barrier();
  if (ties[team()] != 0u && lane < n) place += rankAmongSame(lane, n);
  if (lane < n) {
    put(place, o, id);
    putFacet(place, f, items[team()][lane]);
    if ((bits[id >> 5u] & (1u << (id & 31u))) != 0u) atomicOr(shown[team()], 1u << place);
  }
  uvec4 covered = uvec4(0u);
  lookAtBatch(n, covered);
  settle(n);
}

void main() {
  uint pixels = counters.openCount;
  for (uint first = gl_WorkGroupID.x * kTeams; first < pixels; first += gl_NumWorkGroups.x * kTeams) {
    uint i = min(first + team(), pixels - 1u); // the last one may be decided twice
    uint slot = open[i];
    uint n = slots[lengthAt(slot)];
    resolveShort(slots[slot] - n, n, pixelOf(slot));
    barrier();
  }
}
