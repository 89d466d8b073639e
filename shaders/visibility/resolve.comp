// Decides a pixel's list of at most kBatch. What the order by one depth each may have wrong is decided by planes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/facet.h"
#include "visibility/layout.h"
#include "visibility/resolve.glsl"

shared uint ids[kBatch];
shared vec4 planes[kBatch]; // facets of the sorted entries: plane, nearest
shared float farthest[kBatch];
shared uint boxes[kBatch];
shared uint shown;          // bits: entries that other pixels showed
shared uint doubtful;       // those that the order may have wrong
shared uint kept;           // those of them that are seen
shared uint rivals[kBatch];   // for each entry: those that may hide a part of it
shared uint suspects[kBatch]; // an entry and one that it may be in the wrong order with
shared uint suspectCount;
shared uint more;

void putFacet(uint place, Facet f) {
  planes[place] = vec4(f.plane, f.nearest);
  farthest[place] = f.farthest;
  boxes[place] = uint(f.box.x) | uint(f.box.y) << 8u | uint(f.box.z) << 16u | uint(f.box.w) << 24u;
}

Facet facetAt(uint place) {
  vec4 plane = planes[place];
  uint box = boxes[place];
  Facet f;
  f.plane = plane.xyz;
  f.nearest = plane.w;
  f.farthest = farthest[place];
  f.box = ivec4(box & 255u, box >> 8u & 255u, box >> 16u & 255u, box >> 24u);
  return f;
}

/// Bits: those that an entry may be in the wrong order with, by their depths alone. Entries that are shown already need
/// no answer.
uint suspectsOf(uint place, uint n) {
  uint bit = 1u << place;
  bool claimed = (seen & bit) != 0u;
  float near = planes[place].w;
  float far = farthest[place];
  uint before = 0u; // all that are not behind it as a whole
  uint after = 0u;  // all that are not before it as a whole
  for (uint j = 0u; j < n; ++j) {
    if (planes[j].w <= far) before |= 1u << j;
    if (near < farthest[j]) after |= 1u << j;
  }
  rivals[place] = before & ~bit;
  if ((shown & bit) != 0u) return 0u;
  return claimed ? before & ~(bit | bit - 1u) : after & (1u << min(place, stops)) - 1u;
}

/// Whether two entries are in the wrong order: one that is seen before one that is nearer, or one that is hidden
/// behind one that is farther.
bool isWrong(uint place, uint other) {
  bool claimed = (seen & (1u << place)) != 0u;
  uint nearer = claimed ? other : place;
  uint farther = claimed ? place : other;
  return isNearerSomewhere(facetAt(nearer), facetAt(farther)) &&
         overlap(readCandidate(items[nearer]), readCandidate(items[farther]));
}

/// Notes entries that the order may have wrong. Few have suspects: the pairs are shared out.
void findDoubtful(uint n) {
  uint lane = laneOf();
  uint left = lane < n ? suspectsOf(lane, n) : 0u;
  bool again = true;
  while (again) {
    if (lane == 0u) {
      suspectCount = 0u;
      more = 0u;
    }
    barrier();
    while (left != 0u) {
      uint at = atomicAdd(suspectCount, 1u);
      if (at >= kBatch) break;
      suspects[at] = lane | uint(findLSB(left)) << 8u;
      left &= left - 1u;
    }
    if (left != 0u) more = 1u;
    barrier();
    if (lane < suspectCount) {
      uint place = suspects[lane] & 255u;
      if (isWrong(place, suspects[lane] >> 8u)) atomicOr(doubtful, 1u << place);
    }
    again = more != 0u;
    barrier();
    if ((doubtful & (1u << lane)) != 0u) left = 0u;
  }
}

/// Whether an entry has a sample, in this invocation's rows, at which none of the others is nearer.
bool isAhead(uint place) {
  int row = int(laneOf());
  Outline o = outlineAt(place);
  Facet own = facetAt(place);
  uint id = ids[place];
  uvec4 rest = uvec4(samplesIn(o, row), samplesIn(o, row + 32));
  for (uint left = rivals[place]; left != 0u && (rest.x | rest.y | rest.z | rest.w) != 0u; left &= left - 1u) {
    uint j = uint(findLSB(left));
    Crossing crossing = crossingOf(facetAt(j), own, ids[j] < id);
    Outline other = outlineAt(j);
    rest &= ~uvec4(samplesAhead(other, crossing, row), samplesAhead(other, crossing, row + 32));
  }
  return (rest.x | rest.y | rest.z | rest.w) != 0u;
}

/// After the order has proposed which are seen: corrects that, and shows them.
void settle(uint n) {
  uint lane = laneOf();
  findDoubtful(n);
  for (uint left = doubtful; left != 0u; left &= left - 1u) {
    uint place = uint(findLSB(left));
    if (isAhead(place)) atomicOr(kept, 1u << place);
  }
  barrier();
  uint visible = (seen & ~doubtful | kept) & ~shown;
  if ((visible & (1u << lane)) != 0u) show(ids[lane]);
}

/// A pixel's list, and the entry of it that this invocation reads.
struct List {
  uint slot;
  uint n;
  uint item;
};

List listAt(uint i) {
  List list;
  list.slot = open[i];
  list.n = slots[lengthAt(list.slot)];
  uint end = slots[list.slot];
  list.item = laneOf() < list.n ? entries[end - list.n + laneOf()] : 0u;
  return list;
}

void resolveShort(List list) {
  uint lane = laneOf();
  uint n = list.n;
  ivec2 pixel = pixelOf(list.slot);
  bool reversed = params.reversedDepth != 0u;
  Outline o;
  Facet f;
  uint id = 0u;
  if (lane == 0u) {
    doubtful = 0u;
    kept = 0u;
    shown = 0u;
  }
  if (lane < n) {
    items[lane] = list.item;
    Candidate c = readCandidate(list.item);
    Footing footing = footingIn(c, pixel);
    o = outlineOf(c, pixel);
    id = c.id;
    setKey(lane, middleKey(c, o, footing, pixel, reversed));
    f = facetOf(c, footing, pixel, reversed);
  }
  uint place = placeAmong(n);
  if (lane < n) {
    items[place] = list.item;
    ids[place] = id;
    put(place, o);
    putFacet(place, f);
    if (isShown(id)) atomicOr(shown, 1u << place);
  }
  uvec4 covered = uvec4(0u);
  lookAtBatch(n, covered);
  settle(n);
}

void main() {
  uint pixels = counters.openCount;
  uint i = gl_WorkGroupID.x;
  if (i >= pixels) return;
  List next = listAt(i);
  while (i < pixels) {
    List list = next;
    i += gl_NumWorkGroups.x;
    if (i < pixels) next = listAt(i); // reads that depend on each other: they arrive while this list is decided
    resolveShort(list);
    barrier();
  }
}
