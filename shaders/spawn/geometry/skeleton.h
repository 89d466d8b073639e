// The straight skeleton of a polygon with holes, or its wavefront at a time, by propagation.
//
// Edges move to their left with a speed each, all others than -1. Vertices of the wavefront move between two edges
// until an edge vanishes, or until a reflex vertex meets an edge or another vertex, which parts or joins loops
// (Aichholzer et al. 1995; Felkel, Obdrzalek 1998). Events are taken one by one in the order of their times, in
// arithmetic of 46 bits on coordinates brought to -1 to 1; those within 1e-10 of the polygon's extent are taken for
// simultaneous. What each moment leaves is a valid wavefront again: vertices between edges that lie on each other
// vanish at once, an edge without length vanishes unless it grows, and a loop of two vertices is a ridge.
//
// Results are nodes (x, y, time) and, for each edge, directed sides of the face that it swept: from the edge's end to
// its start, counter-clockwise. Turns are bounded by the edges' number; a polygon that is not simple ends in an error.
#ifndef GPGP_SHADERS_SPAWN_GEOMETRY_SKELETON_H
#define GPGP_SHADERS_SPAWN_GEOMETRY_SKELETON_H
#include "spawn/geometry/wavefront.h"

GPGP_SHADER_BEGIN

/// When the edge between v and the next vertex vanishes.
GPGP_FN void timeVanishing(GPGP_POOL Skeleton s, uint v) {
  const uint next = waveNext(GPGP_P s, v);
  const Wide2 direction = edgeDirection(GPGP_P s, waveWord(GPGP_P s, v, kVertexRight));
  const Wide2 between = wideSubtract2(wavePlace(GPGP_P s, next, s.now), wavePlace(GPGP_P s, v, s.now));
  const Wide extent = wideDot(between, direction);
  const Wide growth = wideDot(wideSubtract2(waveVelocity(GPGP_P s, next), waveVelocity(GPGP_P s, v)), direction);
  Wide time = wide(kSkeletonNever);
  if (extent.hi <= kSkeletonLength && growth.hi <= kSkeletonLength) {
    time = s.now;
  } else if (growth.hi < -1.0e-12f) {
    time = extent.hi <= 0.0f ? s.now : wideAdd(s.now, wideDivide(extent, wideNegate(growth)));
  }
  setWorkWide(GPGP_P s.vertexAt + kVertexWords * v + kVertexVanish, time);
}

/// Whether both edges of v lie where the wavefront has not been yet, seen from w, which is at the same place. Not so
/// for two vertices that just parted there.
GPGP_FN bool isInSector(GPGP_POOL Skeleton s, uint w, uint v) {
  const Wide2 first = edgeDirection(GPGP_P s, waveWord(GPGP_P s, w, kVertexRight));
  const Wide2 last = edgeDirection(GPGP_P s, waveWord(GPGP_P s, w, kVertexLeft)); // towards w
  const bool convex = !(wideCross(last, first).hi < 0.0f);
  bool holds = true;
  for (uint i = 0u; i < 2u; ++i) {
    const Wide2 towards = edgeDirection(GPGP_P s, waveWord(GPGP_P s, v, i == 0u ? kVertexRight : kVertexLeft));
    const Wide2 ray = i == 0u ? towards : wide2(wideNegate(towards.x), wideNegate(towards.y));
    const bool behindFirst = wideCross(first, ray).hi > -kSkeletonLength;
    const bool beforeLast = wideCross(last, ray).hi > -kSkeletonLength;
    if (convex ? !(behindFirst && beforeLast) : !(behindFirst || beforeLast)) holds = false;
  }
  return holds;
}

/// When the reflex vertex v meets the edge that begins at vertex a; takes it if it is earlier than what v has.
GPGP_FN void timeSplit(GPGP_POOL Skeleton s, uint v, uint a) {
  const uint b = waveNext(GPGP_P s, a);
  if (a == v || b == v || a == b) return;
  const uint edge = waveWord(GPGP_P s, a, kVertexRight);
  const Wide2 normal = edgeNormal(GPGP_P s, edge);
  const Wide2 velocity = waveVelocity(GPGP_P s, v);
  const Wide closing = wideSubtract(wide(edgeSpeed(GPGP_P s, edge)), wideDot(normal, velocity));
  if (!(closing.hi > 1.0e-10f)) return;
  const Wide2 placeA = wavePlace(GPGP_P s, a, s.now);
  const Wide2 place = wavePlace(GPGP_P s, v, s.now);
  const Wide distance = wideDot(normal, wideSubtract2(place, placeA));
  if (distance.hi < -kSkeletonLength) return;
  const Wide after = distance.hi <= 0.0f ? wide(0.0f) : wideDivide(distance, closing);
  const Wide time = wideAdd(s.now, after);
  if (!wideLess(time, waveTime(GPGP_P s, v, kVertexSplit))) return;
  const Wide2 direction = wide2(normal.y, wideNegate(normal.x));
  const Wide2 meeting = wideAdd2(place, wideScale2(velocity, after));
  const Wide2 from = wideAdd2(placeA, wideScale2(waveVelocity(GPGP_P s, a), after));
  const float toA = wideDot(wideSubtract2(meeting, from), direction).hi;
  if (toA < -kSkeletonLength) return;
  const Wide2 to = wideAdd2(wavePlace(GPGP_P s, b, s.now), wideScale2(waveVelocity(GPGP_P s, b), after));
  const float toB = wideDot(wideSubtract2(to, meeting), direction).hi;
  if (toB < -kSkeletonLength) return;
  if (min(toA, toB) <= kSkeletonLength && !isInSector(GPGP_P s, toA < toB ? a : b, v)) return;
  setWorkWide(GPGP_P s.vertexAt + kVertexWords * v + kVertexSplit, time);
  setWaveWord(GPGP_P s, v, kVertexTarget, a);
  setWaveWord(GPGP_P s, v, kVertexTargetEnd, b);
}
GPGP_FN bool isReflexWave(GPGP_POOL Skeleton s, uint v) {
  return waveWord(GPGP_P s, v, kVertexState) == (kStateAlive | kStateReflex);
}
/// What v meets first, of all edges.
GPGP_FN void timeSplits(GPGP_POOL Skeleton s, uint v) {
  countSteps(GPGP_P 32u * s.running); // wide arithmetic, some 100 ns each
  setWorkWide(GPGP_P s.vertexAt + kVertexWords * v + kVertexSplit, wide(kSkeletonNever));
  setWaveWord(GPGP_P s, v, kVertexTarget, kNone);
  for (uint i = 0u; i < s.running; ++i) {
    timeSplit(GPGP_P s, v, workWord(GPGP_P s.activeAt + i));
  }
}
/// Times of a vertex that is new, or whose next one is.
GPGP_FN void timeWave(GPGP_POOL Skeleton s, uint v) {
  if (!waveAlive(GPGP_P s, v)) return;
  timeVanishing(GPGP_P s, v);
  countSteps(GPGP_P 32u * s.running);
  for (uint i = 0u; i < s.running; ++i) {
    const uint other = workWord(GPGP_P s.activeAt + i);
    if (isReflexWave(GPGP_P s, other)) timeSplit(GPGP_P s, other, v);
  }
}

/// Whether edges that follow each other in one line part, because their speeds differ. Nearly collinear ones would meet
/// far away.
GPGP_FN bool needsStep(GPGP_POOL Skeleton s, uint left, uint right) {
  if (edgeSpeed(GPGP_P s, left) == edgeSpeed(GPGP_P s, right)) return false;
  const Wide2 a = edgeNormal(GPGP_P s, left);
  const Wide2 b = edgeNormal(GPGP_P s, right);
  return wideDot(a, b).hi > 0.0f && abs(wideCross(a, b).hi) < 1.0e-3f;
}
/// An edge at right angles that stays, from the front of `left` to that of `right`.
GPGP_FN uint addStep(GPGP_POOL GPGP_INOUT(Skeleton) s, uint left, uint right, uint node) {
  if (s.edges >= s.maxEdges) {
    s.status = kGeometryNotSimple;
    return 0u;
  }
  const uint step = s.edges;
  s.edges += 1u;
  const bool back = edgeSpeed(GPGP_P s, left) > edgeSpeed(GPGP_P s, right); // from the edge that is ahead
  const Wide2 along = edgeDirection(GPGP_P s, back ? left : right);
  const uint at = s.edgeAt + kEdgeWords * step;
  setWorkWide2(GPGP_P at, back ? along : wide2(wideNegate(along.x), wideNegate(along.y)));
  setWorkFloat(GPGP_P at + kEdgeSpeed, 0.0f);
  setWorkWord(GPGP_P at + kEdgeStart, node);
  setWorkWord(GPGP_P at + kEdgeEnd, node);
  setWorkWord(GPGP_P at + kEdgeSides, kNone);
  return step;
}

/// Ends loops that have no area, and vertices between edges that lie on each other, from v on; then times what is new.
GPGP_FN void settleWave(GPGP_POOL GPGP_INOUT(Skeleton) s, uint v) {
  for (uint turn = 0u; turn < s.maxVertices && s.status == kGeometryOk; ++turn) {
    if (!waveAlive(GPGP_P s, v)) return;
    const uint next = waveNext(GPGP_P s, v);
    const uint previous = wavePrevious(GPGP_P s, v);
    if (next == v) {
      endWave(GPGP_P s, v, nodeOfWave(GPGP_P s, v));
      return;
    }
    if (next == previous) {
      const uint left = waveWord(GPGP_P s, v, kVertexRight);
      const uint right = waveWord(GPGP_P s, v, kVertexLeft);
      const uint a = nodeOfWave(GPGP_P s, v);
      const uint b = nodeOfWave(GPGP_P s, next);
      endWave(GPGP_P s, v, a);
      endWave(GPGP_P s, next, b);
      addRidge(GPGP_P s, left, right, a, b);
      return;
    }
    if ((waveWord(GPGP_P s, v, kVertexState) & kStateSpike) == 0u) break;
    // The nearer neighbour is where the edges begin to differ.
    const uint left = waveWord(GPGP_P s, v, kVertexLeft);
    const uint right = waveWord(GPGP_P s, v, kVertexRight);
    const Wide2 place = wavePlace(GPGP_P s, v, s.now);
    const Wide2 toPrevious = wideSubtract2(wavePlace(GPGP_P s, previous, s.now), place);
    const Wide2 toNext = wideSubtract2(wavePlace(GPGP_P s, next, s.now), place);
    const Wide2 direction = edgeDirection(GPGP_P s, right);
    const Wide gap = wideSubtract(wideDot(toNext, direction), wideDot(toPrevious, direction));
    const uint tip = nodeOfWave(GPGP_P s, v);
    uint node = tip;
    uint made = 0u;
    if (abs(gap.hi) <= kSkeletonLength) {
      node = nodeOfWave(GPGP_P s, next);
      made = addWave(GPGP_P s, waveWord(GPGP_P s, previous, kVertexLeft), waveWord(GPGP_P s, next, kVertexRight), node);
      const uint before = wavePrevious(GPGP_P s, previous);
      const uint behind = waveNext(GPGP_P s, next);
      if (before != next) { // else nothing but the new vertex is left
        linkWave(GPGP_P s, before, made);
        linkWave(GPGP_P s, made, behind);
      }
      endWave(GPGP_P s, previous, node);
      endWave(GPGP_P s, next, node);
    } else if (gap.hi < 0.0f) {
      node = nodeOfWave(GPGP_P s, next);
      made = addWave(GPGP_P s, left, waveWord(GPGP_P s, next, kVertexRight), node);
      linkWave(GPGP_P s, previous, made);
      linkWave(GPGP_P s, made, waveNext(GPGP_P s, next));
      endWave(GPGP_P s, next, node);
    } else {
      node = nodeOfWave(GPGP_P s, previous);
      made = addWave(GPGP_P s, waveWord(GPGP_P s, previous, kVertexLeft), right, node);
      linkWave(GPGP_P s, wavePrevious(GPGP_P s, previous), made);
      linkWave(GPGP_P s, made, next);
      endWave(GPGP_P s, previous, node);
    }
    addRidge(GPGP_P s, right, left, tip, node);
    endWave(GPGP_P s, v, tip);
    v = made;
  }
  if (s.status != kGeometryOk) return;
  const uint left = waveWord(GPGP_P s, v, kVertexLeft);
  const uint right = waveWord(GPGP_P s, v, kVertexRight);
  if (needsStep(GPGP_P s, left, right)) {
    const uint node = nodeOfWave(GPGP_P s, v);
    const uint step = addStep(GPGP_P s, left, right, node);
    const uint first = addWave(GPGP_P s, left, step, node);
    const uint second = addWave(GPGP_P s, step, right, node);
    linkWave(GPGP_P s, wavePrevious(GPGP_P s, v), first);
    linkWave(GPGP_P s, second, waveNext(GPGP_P s, v));
    linkWave(GPGP_P s, first, second);
    endWave(GPGP_P s, v, node);
    if (s.status != kGeometryOk) return;
    timeWave(GPGP_P s, second);
    if (isReflexWave(GPGP_P s, second)) timeSplits(GPGP_P s, second);
    v = first;
  }
  timeWave(GPGP_P s, v);
  timeWave(GPGP_P s, wavePrevious(GPGP_P s, v));
  if (isReflexWave(GPGP_P s, v)) timeSplits(GPGP_P s, v);
}

/// The edge between v and the next vertex has vanished.
GPGP_FN void vanishEdge(GPGP_POOL GPGP_INOUT(Skeleton) s, uint v) {
  const uint next = waveNext(GPGP_P s, v);
  const uint before = wavePrevious(GPGP_P s, v);
  const uint behind = waveNext(GPGP_P s, next);
  // Of the slower vertex: that of one between nearly parallel edges is uncertain.
  const bool slower = !(waveSpeed(GPGP_P s, next) < waveSpeed(GPGP_P s, v));
  const uint node = nodeOfWave(GPGP_P s, slower ? v : next);
  const uint made = addWave(GPGP_P s, waveWord(GPGP_P s, v, kVertexLeft), waveWord(GPGP_P s, next, kVertexRight), node);
  if (before != next) {
    linkWave(GPGP_P s, before, made);
    linkWave(GPGP_P s, made, behind);
  }
  endWave(GPGP_P s, v, node);
  endWave(GPGP_P s, next, node);
  settleWave(GPGP_P s, made);
}

/// Parts two vertices that are at one place, or joins their loops: each of the two new ones has an edge of each.
GPGP_FN void crossWaves(GPGP_POOL GPGP_INOUT(Skeleton) s, uint v, uint w) {
  const uint node = nodeOfWave(GPGP_P s, v);
  const uint one = addWave(GPGP_P s, waveWord(GPGP_P s, v, kVertexLeft), waveWord(GPGP_P s, w, kVertexRight), node);
  const uint two = addWave(GPGP_P s, waveWord(GPGP_P s, w, kVertexLeft), waveWord(GPGP_P s, v, kVertexRight), node);
  const uint beforeV = wavePrevious(GPGP_P s, v);
  const uint behindV = waveNext(GPGP_P s, v);
  const uint beforeW = wavePrevious(GPGP_P s, w);
  const uint behindW = waveNext(GPGP_P s, w);
  if (beforeV != w) {
    linkWave(GPGP_P s, beforeV, one);
    linkWave(GPGP_P s, one, behindW);
  }
  if (beforeW != v) {
    linkWave(GPGP_P s, beforeW, two);
    linkWave(GPGP_P s, two, behindV);
  }
  endWave(GPGP_P s, v, node);
  endWave(GPGP_P s, w, node);
  settleWave(GPGP_P s, one);
  settleWave(GPGP_P s, two);
}

/// v has met the edge that begins at a.
GPGP_FN void splitEdge(GPGP_POOL GPGP_INOUT(Skeleton) s, uint v, uint a) {
  const uint b = waveNext(GPGP_P s, a);
  const uint edge = waveWord(GPGP_P s, a, kVertexRight);
  const Wide2 direction = edgeDirection(GPGP_P s, edge);
  const Wide2 place = wavePlace(GPGP_P s, v, s.now);
  const Wide toA = wideDot(wideSubtract2(place, wavePlace(GPGP_P s, a, s.now)), direction);
  const Wide toB = wideDot(wideSubtract2(wavePlace(GPGP_P s, b, s.now), place), direction);
  const uint near = toA.hi < toB.hi ? a : b;
  if (min(toA.hi, toB.hi) <= kSkeletonLength) {
    if (near == waveNext(GPGP_P s, v)) {
      vanishEdge(GPGP_P s, v);
    } else if (near == wavePrevious(GPGP_P s, v)) {
      vanishEdge(GPGP_P s, near);
    } else {
      crossWaves(GPGP_P s, v, near);
    }
    return;
  }
  const uint node = nodeOfWave(GPGP_P s, v);
  const uint one = addWave(GPGP_P s, waveWord(GPGP_P s, v, kVertexLeft), edge, node);
  const uint two = addWave(GPGP_P s, edge, waveWord(GPGP_P s, v, kVertexRight), node);
  linkWave(GPGP_P s, wavePrevious(GPGP_P s, v), one);
  linkWave(GPGP_P s, two, waveNext(GPGP_P s, v));
  linkWave(GPGP_P s, one, b);
  linkWave(GPGP_P s, a, two);
  endWave(GPGP_P s, v, node);
  settleWave(GPGP_P s, one);
  settleWave(GPGP_P s, two);
}

/// Moves the wavefront to the end, or to a time, in the given coordinates' units; negative: to the end.
GPGP_FN void propagate(GPGP_POOL GPGP_INOUT(Skeleton) s, float until) {
  Wide end = wide(kSkeletonNever);
  if (until >= 0.0f) end = productOf(until, s.scale);
  const uint most = 16u * s.originals + 16u;
  for (uint turn = 0u; s.status == kGeometryOk && s.running > 0u; ++turn) {
    if (turn == most) {
      s.status = kGeometryNotSimple;
      return;
    }
    if (!countSteps(GPGP_P 4u * s.running)) {
      s.status = kGeometryTooLarge;
      return;
    }
    uint vanishing = kNone;
    uint splitting = kNone;
    Wide vanishTime = wide(kSkeletonNever);
    Wide splitTime = wide(kSkeletonNever);
    for (uint i = 0u; i < s.running; ++i) {
      const uint v = workWord(GPGP_P s.activeAt + i);
      const Wide vanish = waveTime(GPGP_P s, v, kVertexVanish);
      if (wideLess(vanish, vanishTime)) {
        vanishTime = vanish;
        vanishing = v;
      }
      if ((waveWord(GPGP_P s, v, kVertexState) & kStateReflex) == 0u) continue;
      const uint target = waveWord(GPGP_P s, v, kVertexTarget);
      if (target != kNone) {
        const bool stands =
            waveAlive(GPGP_P s, target) && waveNext(GPGP_P s, target) == waveWord(GPGP_P s, v, kVertexTargetEnd);
        if (!stands) timeSplits(GPGP_P s, v);
      }
      const Wide split = waveTime(GPGP_P s, v, kVertexSplit);
      if (wideLess(split, splitTime)) {
        splitTime = split;
        splitting = v;
      }
    }
    const bool vanishes = !wideLess(wideAdd(splitTime, wide(kSkeletonTime)), vanishTime);
    const Wide time = vanishes ? vanishTime : splitTime;
    if (wideLess(end, time) || time.hi >= kSkeletonNever) break;
    if (wideLess(s.now, time)) s.now = time;
    if (vanishes) {
      vanishEdge(GPGP_P s, vanishing);
    } else {
      splitEdge(GPGP_P s, splitting, waveWord(GPGP_P s, splitting, kVertexTarget));
    }
  }
  if (s.status != kGeometryOk || s.running == 0u) return;
  if (until < 0.0f) {
    s.status = kGeometryNotSimple;
    return;
  }
  s.now = end;
  // The wavefront's edges end faces; its vertices stay, at the nodes that their words now name.
  for (uint i = 0u; i < s.running; ++i) {
    const uint v = workWord(GPGP_P s.activeAt + i);
    const uint node = nodeOfWave(GPGP_P s, v);
    const uint birth = waveWord(GPGP_P s, v, kVertexNode);
    addSide(GPGP_P s, waveWord(GPGP_P s, v, kVertexLeft), birth, node, waveWord(GPGP_P s, v, kVertexRight));
    addSide(GPGP_P s, waveWord(GPGP_P s, v, kVertexRight), node, birth, waveWord(GPGP_P s, v, kVertexLeft));
    setWaveWord(GPGP_P s, v, kVertexNode, node);
  }
  for (uint i = 0u; i < s.running; ++i) {
    const uint v = workWord(GPGP_P s.activeAt + i);
    addSide(GPGP_P s, waveWord(GPGP_P s, v, kVertexRight), waveWord(GPGP_P s, waveNext(GPGP_P s, v), kVertexNode),
            waveWord(GPGP_P s, v, kVertexNode), kNone);
  }
}

// ---------------------------------------------------------------- the polygon

/// Points of a polygon in the workspace: words x, y and the speed of the edge that begins there, loop by loop.
GPGP_CONST uint kPointWords = 3u;

GPGP_FN Wide2 scaledPoint(GPGP_POOL Skeleton s, uint point) {
  const Wide x = wideSubtract(wide(workFloat(GPGP_P point)), wide(s.centreX));
  const Wide y = wideSubtract(wide(workFloat(GPGP_P point + 1u)), wide(s.centreY));
  return wide2(wideMultiply(x, wide(s.scale)), wideMultiply(y, wide(s.scale)));
}

/// loops: words in the workspace, the number of points of each. Points of a loop that are one place must be one.
GPGP_FN Skeleton newSkeleton(GPGP_POOL uint points, uint pointCount, uint loops, uint loopCount) {
  Skeleton s;
  s.mark = workMark(GPGP_P0);
  s.originals = pointCount;
  s.edges = pointCount;
  s.maxEdges = 4u * pointCount + 8u;
  s.maxVertices = 9u * pointCount + 16u;
  s.maxNodes = 6u * pointCount + 16u;
  s.maxSides = 22u * pointCount + 32u;
  s.vertices = 0u;
  s.nodes = 0u;
  s.sides = 0u;
  s.running = 0u;
  s.now = wide(0.0f);
  s.status = kGeometryOk;
  s.edgeAt = takeWork(GPGP_P kEdgeWords * s.maxEdges + kVertexWords * s.maxVertices + kNodeWords * s.maxNodes +
                      kSideWords * s.maxSides + s.maxVertices);
  s.vertexAt = s.edgeAt + kEdgeWords * s.maxEdges;
  s.nodeAt = s.vertexAt + kVertexWords * s.maxVertices;
  s.sideAt = s.nodeAt + kNodeWords * s.maxNodes;
  s.activeAt = s.sideAt + kSideWords * s.maxSides;
  s.centreX = 0.0f;
  s.centreY = 0.0f;
  s.scale = 1.0f;
  s.unscale = 1.0f;
  if (s.edgeAt == kNoWork || pointCount > kMaxFaceCorners) {
    s.status = kGeometryTooLarge;
    return s;
  }
  vec2 low = vec2(1.0e30f);
  vec2 high = vec2(-1.0e30f);
  for (uint i = 0u; i < pointCount; ++i) {
    const vec2 p = vec2(workFloat(GPGP_P points + kPointWords * i), workFloat(GPGP_P points + kPointWords * i + 1u));
    low = vec2(min(low.x, p.x), min(low.y, p.y));
    high = vec2(max(high.x, p.x), max(high.y, p.y));
  }
  GPGP_PRECISE vec2 centre = (low + high) * 0.5f;
  s.centreX = centre.x;
  s.centreY = centre.y;
  const float extent = max(subtract(high.x, low.x), subtract(high.y, low.y));
  if (!(extent > 1.0e-18f) || extent > 1.0e18f) {
    s.status = kGeometryNotSimple;
    return s;
  }
  const uint exponent = (floatBitsToUint(extent) >> 23) & 0xffu; // extent < 2^(exponent - 126)
  s.scale = uintBitsToFloat((253u - exponent) << 23);
  s.unscale = uintBitsToFloat((exponent + 1u) << 23);

  uint first = 0u;
  for (uint l = 0u; l < loopCount; ++l) {
    const uint count = workWord(GPGP_P loops + l);
    for (uint i = 0u; i < count; ++i) {
      const uint from = points + kPointWords * (first + i);
      const uint to = points + kPointWords * (first + (i + 1u == count ? 0u : i + 1u));
      const Wide2 a = scaledPoint(GPGP_P s, from);
      const Wide2 d = wideSubtract2(scaledPoint(GPGP_P s, to), a);
      const Wide extentOf = wideSquareRoot(wideDot(d, d));
      if (!(extentOf.hi > kSkeletonLength)) s.status = kGeometryNotSimple;
      const Wide inverse = wideDivide(wide(1.0f), extentOf);
      const uint at = s.edgeAt + kEdgeWords * (first + i);
      setWorkWide2(GPGP_P at, wide2(wideNegate(wideMultiply(d.y, inverse)), wideMultiply(d.x, inverse)));
      setWorkWord(GPGP_P at + kEdgeSpeed, workWord(GPGP_P from + 2u));
      setWorkWord(GPGP_P at + kEdgeStart, first + i);
      setWorkWord(GPGP_P at + kEdgeEnd, first + (i + 1u == count ? 0u : i + 1u));
      setWorkWord(GPGP_P at + kEdgeSides, kNone);
      addNode(GPGP_P s, a, s.now);
    }
    first += count;
  }
  return s;
}

/// The first wavefront.
GPGP_FN void beginWaves(GPGP_POOL GPGP_INOUT(Skeleton) s, uint loops, uint loopCount) {
  uint first = 0u;
  for (uint l = 0u; l < loopCount && s.status == kGeometryOk; ++l) {
    const uint count = workWord(GPGP_P loops + l);
    uint head = kNone;
    uint last = kNone;
    for (uint i = 0u; i < count; ++i) {
      const uint right = first + i;
      const uint left = first + (i == 0u ? count - 1u : i - 1u);
      uint made = 0u;
      if (needsStep(GPGP_P s, left, right)) {
        const uint step = addStep(GPGP_P s, left, right, right);
        made = addWave(GPGP_P s, left, step, right);
        if (last != kNone) linkWave(GPGP_P s, last, made);
        if (head == kNone) head = made;
        last = made;
        made = addWave(GPGP_P s, step, right, right);
      } else {
        made = addWave(GPGP_P s, left, right, right);
        if ((waveWord(GPGP_P s, made, kVertexState) & kStateSpike) != 0u) s.status = kGeometryNotSimple;
      }
      if (last != kNone) linkWave(GPGP_P s, last, made);
      if (head == kNone) head = made;
      last = made;
    }
    if (last != kNone) linkWave(GPGP_P s, last, head);
    first += count;
  }
  for (uint i = 0u; i < s.running && s.status == kGeometryOk; ++i) {
    const uint v = workWord(GPGP_P s.activeAt + i);
    timeVanishing(GPGP_P s, v);
    if (isReflexWave(GPGP_P s, v)) timeSplits(GPGP_P s, v);
  }
}

/// The skeleton, or the wavefront at time `until` (negative: none). It lies in the workspace until the caller releases
/// `mark`. Distances are the edges' speeds times the time.
GPGP_FN Skeleton skeletonOf(GPGP_POOL uint points, uint pointCount, uint loops, uint loopCount, float until) {
  Skeleton s = newSkeleton(GPGP_P points, pointCount, loops, loopCount);
  if (s.status == kGeometryOk) beginWaves(GPGP_P s, loops, loopCount);
  if (s.status == kGeometryOk) propagate(GPGP_P s, until);
  return s;
}

/// The next side of an edge's face from a node on; kNone where there is none. Sides that were taken have no start.
GPGP_FN uint takeSide(GPGP_POOL Skeleton s, uint edge, uint node) {
  uint side = edgeWord(GPGP_P s, edge, kEdgeSides);
  for (uint turn = 0u; turn < s.sides && side != kNone; ++turn) {
    const uint at = s.sideAt + kSideWords * side;
    if (workWord(GPGP_P at) == node) {
      setWorkWord(GPGP_P at, kNone);
      return side;
    }
    side = workWord(GPGP_P at + 2u);
  }
  return kNone;
}
GPGP_FN uint sideEnd(GPGP_POOL Skeleton s, uint side) { return workWord(GPGP_P s.sideAt + kSideWords * side + 1u); }
GPGP_FN uint sideBeside(GPGP_POOL Skeleton s, uint side) { return workWord(GPGP_P s.sideAt + kSideWords * side + 3u); }

GPGP_SHADER_END
#endif
