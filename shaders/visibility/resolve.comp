// Decides a pixel's list of at most kBatch. What the order by one depth each may have wrong is decided by planes.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef GPGP_SUBGROUPS
#extension GL_KHR_shader_subgroup_arithmetic : require
#endif
#include "visibility/facet.h"
#include "visibility/layout.h"
#include "visibility/resolve.glsl"

// How many lists are decided at a time is a matter of how little shared memory each takes.
shared float planes[kBatch * 3u]; // facets of the sorted entries
shared vec4 nearest[kBatch / 4u];
shared vec4 farthest[kBatch / 4u];
shared uint boxes[kBatch];
shared uint suspectCount;

void putFacet(uint place, Facet f) {
  planes[place * 3u] = f.plane.x;
  planes[place * 3u + 1u] = f.plane.y;
  planes[place * 3u + 2u] = f.plane.z;
  nearest[place >> 2u][place & 3u] = f.nearest;
  farthest[place >> 2u][place & 3u] = f.farthest;
  boxes[place] = uint(f.box.x) | uint(f.box.y) << 8u | uint(f.box.z) << 16u | uint(f.box.w) << 24u;
}

Facet facetAt(uint place) {
  uint box = boxes[place];
  Facet f;
  f.plane = vec3(planes[place * 3u], planes[place * 3u + 1u], planes[place * 3u + 2u]);
  f.nearest = nearest[place >> 2u][place & 3u];
  f.farthest = farthest[place >> 2u][place & 3u];
  f.box = ivec4(box & 255u, box >> 8u & 255u, box >> 16u & 255u, box >> 24u);
  return f;
}

uint bitsOf(bvec4 v) { return uint(v.x) | uint(v.y) << 1u | uint(v.z) << 2u | uint(v.w) << 3u; }

/// Bits: those that an entry may be in the wrong order with, by their depths alone. Entries that are shown already need
/// no answer. rivals: those that may hide a part of it.
uint suspectsOf(uint place, uint n, Looked looked, uint shown, out uint rivals) {
  uint bit = 1u << place;
  bool claimed = (looked.seen & bit) != 0u;
  vec4 near = vec4(nearest[place >> 2u][place & 3u]);
  vec4 far = vec4(farthest[place >> 2u][place & 3u]);
  uint before = 0u; // all that are not behind it as a whole
  uint after = 0u;  // all that are not before it as a whole
  for (uint j = 0u; j < n; j += 4u) {
    before |= bitsOf(lessThanEqual(nearest[j >> 2u], far)) << j;
    after |= bitsOf(lessThan(near, farthest[j >> 2u])) << j;
  }
  uint all_ = 0xffffffffu >> (kBatch - n); // not what an earlier list left
  rivals = before & all_ & ~bit;
  if ((shown & bit) != 0u) return 0u;
  return claimed ? rivals & ~(bit - 1u) : after & all_ & (1u << min(place, looked.stops)) - 1u;
}

/// Whether two entries are in the wrong order: one that is seen before one that is nearer, or one that is hidden
/// behind one that is farther.
bool isWrong(uint place, uint other, bool claimed) {
  uint nearer = claimed ? other : place;
  uint farther = claimed ? place : other;
  return isNearerSomewhere(facetAt(nearer), facetAt(farther)) &&
         overlap(readCandidate(items[nearer]), readCandidate(items[farther]));
}

/// Entries that the order may have wrong. Few have suspects: the pairs are shared out. rivals: of this invocation's.
uint doubtfulOf(uint n, Looked looked, uint shown, out uint rivals) {
  uint lane = laneOf();
  rivals = 0u;
  uint left = lane < n ? suspectsOf(lane, n, looked, shown, rivals) : 0u;
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

/// Whether an entry has a sample, in this invocation's rows, at which none of its rivals, which are its key now, is
/// nearer.
bool isAhead(uint place) {
  int row = int(laneOf());
  Outline o = outlineAt(place);
  Facet f = facetAt(place);
  uint id = candidateId(items[place]);
  uvec4 rest = uvec4(samplesIn(o, row), samplesIn(o, row + 32));
  for (uint left = keyAt(place); left != 0u && (rest.x | rest.y | rest.z | rest.w) != 0u; left &= left - 1u) {
    uint j = uint(findLSB(left));
    Crossing crossing = crossingOf(facetAt(j), f, candidateId(items[j]) < id);
    Outline other = outlineAt(j);
    rest &= ~uvec4(samplesAhead(other, crossing, row), samplesAhead(other, crossing, row + 32));
  }
  return (rest.x | rest.y | rest.z | rest.w) != 0u;
}

/// After the order has proposed which are seen: corrects that; bits of those that are, and are not shown yet.
uint settle(uint n, Looked looked, uint shown) {
  uint rivals;
  uint doubtful = doubtfulOf(n, looked, shown, rivals);
  uint kept = 0u;
  if (doubtful != 0u) {
    sync();
    setKey(laneOf(), rivals);
    sync();
  }
  for (uint left = doubtful; left != 0u; left &= left - 1u) {
    uint place = uint(findLSB(left));
    if (isAhead(place)) kept |= 1u << place;
  }
  if (doubtful != 0u) kept = orAll(kept);
  return (looked.seen & ~doubtful | kept) & ~shown;
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
  uint key = kFarthest;
  if (lane < n) {
    items[lane] = list.item;
    Candidate c = readCandidate(list.item);
    Footing footing = footingIn(c, pixel);
    o = outlineOf(c, pixel);
    id = c.id;
    key = middleKey(c, o, footing, pixel, reversed);
    setKey(lane, key);
    f = facetOf(c, footing, pixel, reversed);
  }
  uint place = placeAmong(n);
  bool moves = movesIn(pixel);
  uint first = moves ? minAll(key) : 0u;
  bool isKnown = false;
  if (lane < n) {
    items[place] = list.item;
    put(place, o, parallaxIn(pixel, first, key, place));
    putFacet(place, f);
    isKnown = isShown(id);
  }
  uint shown = orAll(isKnown ? 1u << place : 0u);
  uvec4 covered = uvec4(0u);
  Looked looked = lookAtBatch(n, moves, covered);
  uint visible = settle(n, looked, shown);
  if (lane < n && (visible & (1u << place)) != 0u) show(id);
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
