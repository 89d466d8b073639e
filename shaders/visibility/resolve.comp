// Decides a pixel's list of at most kBatch. What the order by one depth each may have wrong is decided by planes.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef GPGP_SUBGROUPS
#extension GL_KHR_shader_subgroup_arithmetic : require
#endif
#include "visibility/facet.h"
#include "visibility/layout.h"
#include "visibility/resolve.glsl"

shared uint ids[kBatch];
shared vec4 planes[kBatch]; // facets of the sorted entries: plane, nearest
shared float farthest[kBatch];
shared uint boxes[kBatch];
shared uint rivals[kBatch]; // for each entry: those that may hide a part of it
shared uint suspectCount;

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
uint suspectsOf(uint place, uint n, Looked looked, uint shown) {
  uint bit = 1u << place;
  bool claimed = (looked.seen & bit) != 0u;
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
  return claimed ? before & ~(bit | bit - 1u) : after & (1u << min(place, looked.stops)) - 1u;
}

/// Whether two entries are in the wrong order: one that is seen before one that is nearer, or one that is hidden
/// behind one that is farther.
bool isWrong(uint place, uint other, bool claimed) {
  uint nearer = claimed ? other : place;
  uint farther = claimed ? place : other;
  return isNearerSomewhere(facetAt(nearer), facetAt(farther)) &&
         overlap(readCandidate(items[nearer]), readCandidate(items[farther]));
}

/// Entries that the order may have wrong. Few have suspects: the pairs are shared out.
uint doubtfulOf(uint n, Looked looked, uint shown) {
  uint lane = laneOf();
  uint left = lane < n ? suspectsOf(lane, n, looked, shown) : 0u;
  uint doubtful = 0u;
  while (orAll(left) != 0u) {
    if (lane == 0u) suspectCount = 0u;
    sync();
    while (left != 0u) {
      uint at = atomicAdd(suspectCount, 1u);
      if (at >= kBatch) break;
      setKey(at, lane | uint(findLSB(left)) << 8u); // the order is there, so that nobody needs the keys
      left &= left - 1u;
    }
    sync();
    uint wrong = 0u;
    if (lane < suspectCount) {
      uint pair = keyAt(lane);
      uint bit = 1u << (pair & 255u);
      if (isWrong(pair & 255u, pair >> 8u, (looked.seen & bit) != 0u)) wrong = bit;
    }
    doubtful |= orAll(wrong);
    if ((doubtful & (1u << lane)) != 0u) left = 0u;
  }
  return doubtful;
}

/// Whether an entry has a sample, in this invocation's rows, at which none of the others is nearer.
bool isAhead(uint place) {
  int row = int(laneOf());
  Outline o = outlineAt(place);
  Facet f = facetAt(place);
  uint id = ids[place];
  uvec4 rest = uvec4(samplesIn(o, row), samplesIn(o, row + 32));
  for (uint left = rivals[place]; left != 0u && (rest.x | rest.y | rest.z | rest.w) != 0u; left &= left - 1u) {
    uint j = uint(findLSB(left));
    Crossing crossing = crossingOf(facetAt(j), f, ids[j] < id);
    Outline other = outlineAt(j);
    rest &= ~uvec4(samplesAhead(other, crossing, row), samplesAhead(other, crossing, row + 32));
  }
  return (rest.x | rest.y | rest.z | rest.w) != 0u;
}

/// After the order has proposed which are seen: corrects that, and shows them.
void settle(uint n, Looked looked, uint shown) {
  uint doubtful = doubtfulOf(n, looked, shown);
  uint kept = 0u;
  for (uint left = doubtful; left != 0u; left &= left - 1u) {
    uint place = uint(findLSB(left));
    if (isAhead(place)) kept |= 1u << place;
  }
  if (doubtful != 0u) kept = orAll(kept);
  uint visible = (looked.seen & ~doubtful | kept) & ~shown;
  if ((visible & (1u << laneOf())) != 0u) show(ids[laneOf()]);
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
  bool isKnown = false;
  if (lane < n) {
    items[place] = list.item;
    ids[place] = id;
    put(place, o);
    putFacet(place, f);
    isKnown = isShown(id);
  }
  uint shown = orAll(isKnown ? 1u << place : 0u);
  uvec4 covered = uvec4(0u);
  Looked looked = lookAtBatch(n, covered);
  settle(n, looked, shown);
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
    sync();
  }
}
