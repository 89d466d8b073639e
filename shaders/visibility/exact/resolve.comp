// Decides pixels' lists of at most kBatch, as many together as have kBatch entries. What the order by one depth each
// may have wrong is decided by planes.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef GPGP_SUBGROUPS
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#endif
#include "visibility/shared/layout.h"
#include "visibility/exact/planes.glsl"

#include "visibility/shared/loops_ended.glsl"

/// Decides lists from one on: as many of `count` as fit, which it returns.
uint resolveSome(uint first, uint count) {
  uint lane = laneOf();
  uvec4 list = uvec4(0u); // slot, length, end
  if (lane < count) {
    list.x = open[first + lane];
    list.y = slots[lengthAt(list.x)];
    list.z = slots[list.x];
  }
  uint room = (list.y + 3u) & ~3u;
  uint end = sumUpTo(room);
  uint begins = orAll(lane < count && end <= kBatch ? 1u << (end - room) : 0u);
  uint upTo = begins & (0xffffffffu >> (31u - lane));
  list = fromLane(list, uint(bitCount(upTo)) - 1u);
  uint begin = uint(findMSB(upTo));
  uint n = list.y;
  bool isThere = lane - begin < n;
  ivec2 pixel = pixelOf(list.x);
  bool reversed = params.reversedDepth != 0u;
  Entry own = noEntry();
  own.list = isThere ? bitsFrom(int(begin), int(n)) : 0u;
  Outline o;
  uint key = kFarthest;
  bool isWide = false;
  if (isThere) {
    uint item = entries[list.z - n + (lane - begin)];
    items[lane] = item;
    Candidate c = readCandidate(item);
    isWide = !isCompact(triangleOf(c));
    putCorners(cornersOf(c), pixel * 256);
    Footing footing = footingOf(c, pixel);
    o = outlineIn(c, pixel);
    own.id = c.id;
    key = middleKey(c, o, footing, pixel, reversed);
    setFacet(own, facetOf(c, footing, pixel, reversed));
  }
  setKey(lane, key);
  own.place = placeAmong(isThere, begin, n);
  bool moves = lanesWith(movesIn(pixel)) != 0u;
  uint nearest = kFarthest;
  if (moves)
    for (uint i = begin; i < begin + n; ++i) nearest = min(nearest, keyAt(i));
  bool isKnown = true;
  if (isThere) {
    putOpen(own.place, items[lane], pixel);
    put(own.place, o, moves ? parallaxIn(pixel, nearest, key, own.place - begin) : 0);
    isKnown = isShown(own.id);
  }
  bool asks = false;
  for (uint left = begins; left != 0u; left &= left - 1u) {
    uint at = uint(findLSB(left));
    uvec4 uncovered = uvec4(0xffffffffu);
    Looked looked = lookAtBatch(at, fromLane(uvec2(n), at).x, moves, uncovered);
    bool isOwn = (own.list & (1u << at)) != 0u;
    if (isOwn) own.isSeen = (looked.seen & (1u << own.place)) != 0u;
    uint reach = maxAll(isOwn && own.isSeen ? orderOf(own.farthest) : 0u);
    if (isOwn) asks = !isKnown && isAsked(own, reach);
  }
  if (decide(own, asks, isWide, uvec4(0xffffffffu)) && !isKnown) show(own.id);
  sync();
  return uint(bitCount(begins));
}

void main() {
  makeColumns();
  uint lists = counters.openCount;
  uint first = (gl_WorkGroupID.y * kMaxGroups + gl_WorkGroupID.x) * kListRun;
  for (uint done = 0u; first + done < lists && done < kListRun;)
    done += resolveSome(first + done, min(lists - first, kListRun) - done);
  sayIfEnded();
}
