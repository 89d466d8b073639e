// The part of a mesh on one side of a plane, or between two values of a texture coordinate.
//
// Each face is cut by the sign of a height at its corners; corners on the plane count as below it. The points where a
// face's outline crosses the plane lie on one line. From where the outline leaves, a bridge leads along that line to
// the next place where it enters, so concave faces fall into several loops and holes open into the outline (Weiler,
// Atherton 1977). Of points at one place, the order is that at a height a little above. Where a closed mesh is cut,
// the bridges, reversed, are the outlines of the faces that close it.
#ifndef GPGP_SHADERS_SPAWN_GEOMETRY_CLIP_H
#define GPGP_SHADERS_SPAWN_GEOMETRY_CLIP_H
#include "spawn/geometry/build.h"

GPGP_SHADER_BEGIN

/// What is kept: where weight.xyz * p + weight.w >= 0, of positions in metres along the scope's axes; or, with a
/// coordinate (0 u, 1 v, of a set), where sign * value + weight.w >= 0.
struct Cut {
  vec4 weight;
  uint coordinate; // kNone: by position
  uint set;
  float sign;
  float slack; // heights below it count as on the plane
};

GPGP_FN float cutHeight(GPGP_POOL Cut cut, Form form, uint corner) {
  float h;
  if (cut.coordinate == 0xffffffffu) {
    const vec3 p = localPosition(GPGP_P form, corner);
    GPGP_PRECISE float sum = cut.weight.x * p.x + cut.weight.y * p.y + cut.weight.z * p.z + cut.weight.w;
    h = sum;
  } else {
    const vec2 uv = cornerUv(GPGP_P form.mesh, cut.set, corner);
    GPGP_PRECISE float sum = cut.sign * (cut.coordinate == 0u ? uv.x : uv.y) + cut.weight.w;
    h = sum;
  }
  return abs(h) <= cut.slack ? 0.0f : h;
}

// Pieces of outlines: runs of corners that are kept, from where the outline enters to where it leaves. Words: the first
// kept corner, their number, the place on the line where it enters, the slope there, those where it leaves, the next
// run, state.
GPGP_CONST uint kRunWords = 8u;
GPGP_CONST uint kRunNext = 6u;
GPGP_CONST uint kRunState = 7u;
GPGP_CONST uint kRunClosed = 1u;  // a whole loop
GPGP_CONST uint kRunEntered = 2u; // a bridge leads to it
GPGP_CONST uint kRunDone = 4u;

/// The new vertex on an edge, from both its vertices in a fixed order, so that faces that share it agree.
GPGP_FN vec3 cutPosition(GPGP_POOL Form form, uint from, uint to, float heightFrom, float heightTo, GPGP_OUT(float) t) {
  const bool swapped = cornerVertex(GPGP_P form.mesh, to) < cornerVertex(GPGP_P form.mesh, from);
  const vec3 a = localPosition(GPGP_P form, swapped ? to : from);
  const vec3 b = localPosition(GPGP_P form, swapped ? from : to);
  const float ha = swapped ? heightTo : heightFrom;
  const float hb = swapped ? heightFrom : heightTo;
  const float along = divide(ha, subtract(ha, hb));
  t = swapped ? subtract(1.0f, along) : along;
  return along3(a, minus3(b, a), along);
}

/// A corner in the list of a face's corners that are kept: its position, a corner of the mesh and another with the
/// weight of the other's coordinates, tags. Words: position 3, from, to, t, tags, vertex.
GPGP_CONST uint kKeptWords = 8u;

GPGP_FN void keepCorner(GPGP_POOL uint at, vec3 p, uint from, uint to, float t, uint tags) {
  setWorkVector(GPGP_P at, p);
  setWorkWord(GPGP_P at + 3u, from);
  setWorkWord(GPGP_P at + 4u, to);
  setWorkFloat(GPGP_P at + 5u, t);
  setWorkWord(GPGP_P at + 6u, tags);
}

/// The direction in a face's plane along which a cut runs, the kept side to its left.
GPGP_FN vec3 cutLine(GPGP_POOL Cut cut, Form form, uint face) {
  const vec3 normal = localNormal(GPGP_P form, face);
  if (cut.coordinate == 0xffffffffu) return outer3(unit3(vec3(cut.weight.x, cut.weight.y, cut.weight.z)), normal);
  // An affine coordinate does not change along the line. The largest triangle at the first corner tells.
  const Loop all = faceCorners(GPGP_P form.mesh, face);
  const vec3 p0 = localPosition(GPGP_P form, all.firstCorner);
  const float h0 = cutHeight(GPGP_P cut, form, all.firstCorner);
  vec3 gradient = vec3(0.0f);
  float best = 0.0f;
  for (uint i = 1u; i + 1u < all.corners; ++i) {
    const vec3 e1 = minus3(localPosition(GPGP_P form, all.firstCorner + i), p0);
    const vec3 e2 = minus3(localPosition(GPGP_P form, all.firstCorner + i + 1u), p0);
    const vec3 n = outer3(e1, e2);
    const float size = inner3(n, n);
    if (!(size > best)) continue;
    best = size;
    const float h1 = subtract(cutHeight(GPGP_P cut, form, all.firstCorner + i), h0);
    const float h2 = subtract(cutHeight(GPGP_P cut, form, all.firstCorner + i + 1u), h0);
    gradient = outer3(minus3(times3(e2, h1), times3(e1, h2)), n);
  }
  return outer3(unit3(gradient), normal);
}

/// What is left of a face's loops, as runs.
struct Runs {
  uint keptAt;
  uint kept;
  uint runAt;
  uint runs;
};

GPGP_FN void setRunPlace(GPGP_POOL uint at, vec3 p, vec3 beyond, float rise, vec3 line) {
  setWorkFloat(GPGP_P at, inner3(p, line));
  setWorkFloat(GPGP_P at + 1u, divide(inner3(minus3(beyond, p), line), rise));
}

GPGP_FN void cutLoop(GPGP_POOL GPGP_INOUT(Runs) r, Cut cut, Form form, Loop loop, vec3 line) {
  // Begin where the outline enters; a loop that never does is kept or dropped as a whole.
  uint start = 0xffffffffu;
  bool any = false;
  for (uint i = 0u; i < loop.corners; ++i) {
    const uint corner = loop.firstCorner + i;
    const float h = cutHeight(GPGP_P cut, form, corner);
    const float hn = cutHeight(GPGP_P cut, form, nextCorner(loop, corner));
    any = any || h > 0.0f;
    if (start == 0xffffffffu && h <= 0.0f && hn > 0.0f) start = i;
  }
  if (!any) return;
  const bool whole = start == 0xffffffffu;
  if (whole) {
    const uint run = r.runAt + kRunWords * r.runs;
    setWorkWord(GPGP_P run, r.kept);
    setWorkWord(GPGP_P run + 1u, loop.corners);
    setWorkWord(GPGP_P run + kRunNext, r.runs);
    setWorkWord(GPGP_P run + kRunState, kRunClosed);
    r.runs += 1u;
    start = 0u;
  }
  for (uint i = 0u; i < loop.corners; ++i) {
    const uint place = start + i < loop.corners ? start + i : start + i - loop.corners;
    const uint corner = loop.firstCorner + place;
    const uint next = nextCorner(loop, corner);
    const float h = cutHeight(GPGP_P cut, form, corner);
    const float hn = cutHeight(GPGP_P cut, form, next);
    const uint tags = cornerTags(GPGP_P form.mesh, corner);
    const vec3 here = localPosition(GPGP_P form, corner);
    const vec3 there = localPosition(GPGP_P form, next);
    const uint run = r.runAt + kRunWords * r.runs;
    float t = 0.0f;
    if (whole || h > 0.0f) {
      keepCorner(GPGP_P r.keptAt + kKeptWords * r.kept, here, corner, corner, 0.0f, tags);
      r.kept += 1u;
    }
    if (whole) continue;
    if (h <= 0.0f && hn > 0.0f) { // enters
      vec3 p = here;
      if (h < 0.0f) p = cutPosition(GPGP_P form, corner, next, h, hn, t);
      setWorkWord(GPGP_P run, r.kept);
      setRunPlace(GPGP_P run + 2u, p, there, hn, line);
      setWorkWord(GPGP_P run + kRunNext, 0xffffffffu);
      setWorkWord(GPGP_P run + kRunState, 0u);
      keepCorner(GPGP_P r.keptAt + kKeptWords * r.kept, p, corner, next, t, tags);
      r.kept += 1u;
    }
    if (h > 0.0f && hn <= 0.0f) { // leaves
      vec3 p = there;
      t = 1.0f;
      if (hn < 0.0f) p = cutPosition(GPGP_P form, corner, next, h, hn, t);
      setRunPlace(GPGP_P run + 4u, p, here, h, line);
      keepCorner(GPGP_P r.keptAt + kKeptWords * r.kept, p, corner, next, t, kTagCut);
      r.kept += 1u;
      setWorkWord(GPGP_P run + 1u, r.kept - workWord(GPGP_P run));
      r.runs += 1u;
    }
  }
}

GPGP_FN bool isAhead(float place, float slope, float ofPlace, float ofSlope) {
  return place > ofPlace || (place == ofPlace && slope >= ofSlope);
}
/// The run that a bridge from the end of `run` leads to: the next one that begins ahead on the line; behind, where
/// rounding left none ahead.
GPGP_FN uint bridgeFrom(GPGP_POOL Runs r, uint run) {
  const uint at = r.runAt + kRunWords * run;
  const float place = workFloat(GPGP_P at + 4u);
  const float slope = workFloat(GPGP_P at + 5u);
  countSteps(GPGP_P r.runs);
  uint best = 0xffffffffu;
  float bestPlace = 0.0f;
  float bestSlope = 0.0f;
  bool bestAhead = false;
  for (uint j = 0u; j < r.runs; ++j) {
    const uint other = r.runAt + kRunWords * j;
    if (workWord(GPGP_P other + kRunState) != 0u) continue;
    const float enters = workFloat(GPGP_P other + 2u);
    const float slopeIn = workFloat(GPGP_P other + 3u);
    const bool ahead = isAhead(enters, slopeIn, place, slope);
    bool better = best == 0xffffffffu || (ahead && !bestAhead);
    if (!better && ahead == bestAhead) {
      const bool nearer = isAhead(bestPlace, bestSlope, enters, slopeIn);
      better = ahead == nearer;
    }
    if (!better) continue;
    best = j;
    bestPlace = enters;
    bestSlope = slopeIn;
    bestAhead = ahead;
  }
  return best;
}

/// Whether a point of the workspace's kept corners lies within a loop of the builder; both lie in one plane.
GPGP_FN bool isInLoop(GPGP_POOL Builder b, uint loop, vec3 p, vec3 normal) {
  const PlaneBasis basis = planeBasis(p, normal, vec3(0.36f, 0.48f, 0.8f));
  const uint first = workWord(GPGP_P b.loopAt + kLoopWords * loop);
  const uint corners = workWord(GPGP_P b.loopAt + kLoopWords * loop + 1u);
  bool isInside = false;
  countSteps(GPGP_P corners);
  for (uint c = 0u; c < corners; ++c) {
    const uint next = c + 1u == corners ? 0u : c + 1u;
    const vec2 q0 = inPlane(basis, builderPosition(GPGP_P b, workWord(GPGP_P b.cornerAt + kCornerWords * (first + c))));
    const vec2 q1 =
        inPlane(basis, builderPosition(GPGP_P b, workWord(GPGP_P b.cornerAt + kCornerWords * (first + next))));
    if ((q0.y > 0.0f) == (q1.y > 0.0f)) continue;
    const float side = cross2(q0, q1);
    if (q1.y > q0.y ? side > 0.0f : side < 0.0f) isInside = !isInside;
  }
  return isInside;
}

/// A run's corners into the loop that was begun last. A bridge without length leaves out the corner before it.
GPGP_FN void addRun(GPGP_POOL GPGP_INOUT(Builder) b, uint mesh, Runs r, uint run) {
  const uint at = r.runAt + kRunWords * run;
  const uint first = workWord(GPGP_P at);
  uint count = workWord(GPGP_P at + 1u);
  const uint next = workWord(GPGP_P at + kRunNext);
  if (workWord(GPGP_P at + kRunState) != kRunClosed && next != 0xffffffffu) {
    const vec3 last = workVector(GPGP_P r.keptAt + kKeptWords * (first + count - 1u));
    const vec3 begin = workVector(GPGP_P r.keptAt + kKeptWords * workWord(GPGP_P r.runAt + kRunWords * next));
    if (last.x == begin.x && last.y == begin.y && last.z == begin.z) count -= 1u;
  }
  for (uint k = first; k < first + count; ++k) {
    const uint corner = r.keptAt + kKeptWords * k;
    const uint made = addCorner(GPGP_P b, workWord(GPGP_P corner + 7u), workWord(GPGP_P corner + 6u));
    copyCornerUv(GPGP_P b, made, mesh, workWord(GPGP_P corner + 3u), workWord(GPGP_P corner + 4u),
                 workFloat(GPGP_P corner + 5u));
  }
}

/// caps: where the bridges go, two vertices of the builder each; kNone: nowhere.
GPGP_FN void cutFace(GPGP_POOL GPGP_INOUT(Builder) b, Cut cut, Form form, uint face, uint caps,
                     GPGP_INOUT(uint) capCount) {
  const Face found = faceOf(GPGP_P form.mesh, face);
  const Loop all = faceCorners(GPGP_P form.mesh, face);
  const uint mark = workMark(GPGP_P0);
  Runs r;
  r.kept = 0u;
  r.runs = 0u;
  r.keptAt = takeWork(GPGP_P kKeptWords * 2u * all.corners + kRunWords * (all.corners + found.loops));
  r.runAt = r.keptAt + kKeptWords * 2u * all.corners;
  if (r.keptAt == kNoWork) {
    b.status = kGeometryTooLarge;
    return;
  }
  const vec3 line = cutLine(GPGP_P cut, form, face);
  for (uint l = 0u; l < found.loops; ++l) {
    cutLoop(GPGP_P r, cut, form, loopOf(GPGP_P form.mesh, found.firstLoop + l), line);
  }
  for (uint i = 0u; i < r.kept; ++i) {
    const uint at = r.keptAt + kKeptWords * i;
    setWorkWord(GPGP_P at + 7u, addVertex(GPGP_P b, workVector(GPGP_P at)));
  }
  for (uint i = 0u; i < r.runs; ++i) {
    const uint run = r.runAt + kRunWords * i;
    if (workWord(GPGP_P run + kRunNext) != 0xffffffffu) continue;
    const uint to = bridgeFrom(GPGP_P r, i);
    if (to == 0xffffffffu) continue;
    const uint next = r.runAt + kRunWords * to;
    setWorkWord(GPGP_P run + kRunNext, to);
    setWorkWord(GPGP_P next + kRunState, kRunEntered);
    if (caps == 0xffffffffu) continue;
    const uint last = workWord(GPGP_P run) + workWord(GPGP_P run + 1u) - 1u;
    setWorkWord(GPGP_P caps + 2u * capCount, workWord(GPGP_P r.keptAt + kKeptWords * workWord(GPGP_P next) + 7u));
    setWorkWord(GPGP_P caps + 2u * capCount + 1u, workWord(GPGP_P r.keptAt + kKeptWords * last + 7u));
    capCount += 1u;
  }
  // What is joined by bridges is the outline of a face. Whole holes belong to the one that they lie in.
  const vec3 normal = localNormal(GPGP_P form, face);
  for (uint i = 0u; i < r.runs && b.status == kGeometryOk; ++i) {
    const uint state = workWord(GPGP_P r.runAt + kRunWords * i + kRunState);
    if (state == kRunDone || (state == kRunClosed && i > 0u)) continue;
    beginFace(GPGP_P b, found.tags);
    beginLoop(GPGP_P b);
    uint run = i;
    for (uint turn = 0u; turn < r.runs; ++turn) {
      addRun(GPGP_P b, form.mesh, r, run);
      setWorkWord(GPGP_P r.runAt + kRunWords * run + kRunState, kRunDone);
      run = workWord(GPGP_P r.runAt + kRunWords * run + kRunNext);
      if (run == 0xffffffffu) break;
      if (workWord(GPGP_P r.runAt + kRunWords * run + kRunState) == kRunDone) break;
    }
    const uint outer = b.loops - 1u;
    endLoop(GPGP_P b);
    if (b.loops == outer) {
      dropFace(GPGP_P b);
      continue;
    }
    for (uint h = 1u; h < r.runs; ++h) {
      const uint hole = r.runAt + kRunWords * h;
      if (workWord(GPGP_P hole + kRunState) != kRunClosed) continue;
      if (!isInLoop(GPGP_P b, outer, workVector(GPGP_P r.keptAt + kKeptWords * workWord(GPGP_P hole)), normal))
        continue;
      beginLoop(GPGP_P b);
      addRun(GPGP_P b, form.mesh, r, h);
      setWorkWord(GPGP_P hole + kRunState, kRunDone);
    }
  }
  releaseWork(GPGP_P mark);
}

/// Where a bridge begins, along one direction in the plane of the cut.
GPGP_FN float bridgePlace(GPGP_POOL Builder b, PlaneBasis basis, uint caps, uint bridge) {
  return inPlane(basis, builderPosition(GPGP_P b, workWord(GPGP_P caps + 2u * bridge))).x;
}
/// The bridges in the order of their places, by a heap: pairs of a place and a bridge.
GPGP_FN void sortBridges(GPGP_POOL Builder b, PlaneBasis basis, uint caps, uint capCount, uint sortedAt) {
  for (uint i = 0u; i < capCount; ++i) {
    setWorkFloat(GPGP_P sortedAt + 2u * i, bridgePlace(GPGP_P b, basis, caps, i));
    setWorkWord(GPGP_P sortedAt + 2u * i + 1u, i);
  }
  for (uint step = 0u; step < capCount + capCount / 2u;
       ++step) { // the first half of a heap is made, then it is emptied
    const bool making = step < capCount / 2u;
    const uint end = making ? capCount : capCount + capCount / 2u - 1u - step;
    uint at = making ? capCount / 2u - 1u - step : 0u;
    const uint from = making ? at : end;
    const float place = workFloat(GPGP_P sortedAt + 2u * from);
    const uint bridge = workWord(GPGP_P sortedAt + 2u * from + 1u);
    if (!making) {
      setWorkFloat(GPGP_P sortedAt + 2u * end, workFloat(GPGP_P sortedAt));
      setWorkWord(GPGP_P sortedAt + 2u * end + 1u, workWord(GPGP_P sortedAt + 1u));
    }
    for (uint depth = 0u; depth < 32u && 2u * at + 1u < end; ++depth) {
      uint child = 2u * at + 1u;
      const bool second =
          child + 1u < end && workFloat(GPGP_P sortedAt + 2u * child + 2u) > workFloat(GPGP_P sortedAt + 2u * child);
      if (second) child += 1u;
      if (!(workFloat(GPGP_P sortedAt + 2u * child) > place)) break;
      setWorkFloat(GPGP_P sortedAt + 2u * at, workFloat(GPGP_P sortedAt + 2u * child));
      setWorkWord(GPGP_P sortedAt + 2u * at + 1u, workWord(GPGP_P sortedAt + 2u * child + 1u));
      at = child;
    }
    setWorkFloat(GPGP_P sortedAt + 2u * at, place);
    setWorkWord(GPGP_P sortedAt + 2u * at + 1u, bridge);
  }
}
/// The first of the sorted bridges whose place is not below that.
GPGP_FN uint firstBridgeFrom(GPGP_POOL uint sortedAt, uint capCount, float place) {
  uint low = 0u;
  uint high = capCount;
  for (uint turn = 0u; turn < 32u && low < high; ++turn) {
    const uint middle = (low + high) / 2u;
    if (workFloat(GPGP_P sortedAt + 2u * middle) < place) {
      low = middle + 1u;
    } else {
      high = middle;
    }
  }
  return low;
}

/// Faces that close the cut: bridges joined end to end. normal: out of the piece, in the scope's axes.
GPGP_FN void addCaps(GPGP_POOL GPGP_INOUT(Builder) b, uint caps, uint capCount, vec3 normal, float apart) {
  const uint mark = workMark(GPGP_P0);
  // Words of a loop: its first place in the order, its bridges, whether it is a hole. Order: bridges as they follow.
  // Sorted: bridges by the places where they begin, for what is near an end. A place is off by a few roundings of the
  // largest coordinate, which `slack` covers.
  const uint orderAt = takeWork(GPGP_P 6u * capCount);
  if (orderAt == kNoWork) {
    b.status = kGeometryTooLarge;
    return;
  }
  const uint loopAt = orderAt + capCount;
  const uint sortedAt = loopAt + 3u * capCount;
  uint ordered = 0u;
  uint loops = 0u;
  const PlaneBasis basis = planeBasis(vec3(0.0f), normal, vec3(0.36f, 0.48f, 0.8f));
  sortBridges(GPGP_P b, basis, caps, capCount, sortedAt);
  float largest = 0.0f;
  for (uint i = 0u; i < capCount; ++i) {
    const vec3 p = builderPosition(GPGP_P b, workWord(GPGP_P caps + 2u * i));
    largest = max(largest, max(abs(p.x), max(abs(p.y), abs(p.z))));
  }
  const float slack = 2.0f * apart + 4e-6f * largest;
  for (uint i = 0u; i < capCount; ++i) {
    const uint at = caps + 2u * i;
    if (workWord(GPGP_P at) == 0xffffffffu) continue;
    if (!countSteps(GPGP_P 1u)) b.status = kGeometryTooLarge;
    if (b.status != kGeometryOk) break;
    const uint first = ordered;
    const vec3 begin = builderPosition(GPGP_P b, workWord(GPGP_P at));
    uint bridge = i;
    bool closed = false;
    float twice = 0.0f;
    for (uint turn = 0u; turn < capCount; ++turn) {
      const uint from = workWord(GPGP_P caps + 2u * bridge);
      const uint to = workWord(GPGP_P caps + 2u * bridge + 1u);
      const vec3 p = builderPosition(GPGP_P b, from);
      const vec3 q = builderPosition(GPGP_P b, to);
      setWorkWord(GPGP_P orderAt + ordered, from);
      ordered += 1u;
      setWorkWord(GPGP_P caps + 2u * bridge, 0xffffffffu);
      GPGP_PRECISE float sum = twice + cross2(inPlane(basis, minus3(p, begin)), inPlane(basis, minus3(q, begin)));
      twice = sum;
      // The one that begins here; of several the one that turns most to the left, so that loops that touch stay two.
      const vec2 along = inPlane(basis, minus3(q, p));
      uint best = 0xffffffffu;
      float bestTurn = 0.0f;
      const vec3 toBegin = minus3(begin, q);
      const bool home = max(abs(toBegin.x), max(abs(toBegin.y), abs(toBegin.z))) <= apart;
      const float place = inPlane(basis, q).x;
      for (uint k = firstBridgeFrom(GPGP_P sortedAt, capCount, place - slack); k < capCount; ++k) {
        if (workFloat(GPGP_P sortedAt + 2u * k) > place + slack) break;
        countSteps(GPGP_P 1u);
        const uint j = workWord(GPGP_P sortedAt + 2u * k + 1u);
        const uint start = workWord(GPGP_P caps + 2u * j);
        if (start == 0xffffffffu) continue;
        const vec3 r = builderPosition(GPGP_P b, start);
        const vec3 gap = minus3(r, q);
        if (max(abs(gap.x), max(abs(gap.y), abs(gap.z))) > apart) continue;
        const vec2 d = inPlane(basis, minus3(builderPosition(GPGP_P b, workWord(GPGP_P caps + 2u * j + 1u)), r));
        // 2: back to the left, 0: straight on, -2: back to the right
        const float bend = subtract(inner3(unit3(vec3(along.x, along.y, 0.0f)), unit3(vec3(d.x, d.y, 0.0f))), 1.0f);
        const float turned = cross2(along, d) >= 0.0f ? -bend : bend;
        const bool better = turned > bestTurn || (turned == bestTurn && j < best);
        if (best != 0xffffffffu && !better) continue;
        best = j;
        bestTurn = turned;
      }
      if (home) {
        closed = true;
        break;
      }
      if (best == 0xffffffffu) break;
      bridge = best;
    }
    if (!closed || ordered - first < 3u) {
      ordered = first;
      continue;
    }
    setWorkWord(GPGP_P loopAt + 3u * loops, first);
    setWorkWord(GPGP_P loopAt + 3u * loops + 1u, ordered - first);
    setWorkWord(GPGP_P loopAt + 3u * loops + 2u, twice > 0.0f ? 0u : 1u);
    loops += 1u;
  }
  for (uint l = 0u; l < loops && b.status == kGeometryOk; ++l) {
    if (workWord(GPGP_P loopAt + 3u * l + 2u) != 0u) continue;
    if (!countSteps(GPGP_P loops)) b.status = kGeometryTooLarge;
    beginFace(GPGP_P b, kTagCut);
    const uint outer = b.loops;
    for (uint m = 0u; m < loops; ++m) {
      // First the outline itself, then all holes within it.
      const uint at = loopAt + 3u * (m == 0u ? l : (m <= l ? m - 1u : m));
      const uint first = workWord(GPGP_P at);
      if (m > 0u && workWord(GPGP_P at + 2u) != 1u) continue;
      const vec3 p = builderPosition(GPGP_P b, workWord(GPGP_P orderAt + first));
      if (m > 0u && !isInLoop(GPGP_P b, outer, p, normal)) continue;
      if (m > 0u) setWorkWord(GPGP_P at + 2u, 2u); // a hole has one outline
      beginLoop(GPGP_P b);
      for (uint k = 0u; k < workWord(GPGP_P at + 1u); ++k) {
        addCorner(GPGP_P b, workWord(GPGP_P orderAt + first + k), kTagCut);
      }
    }
  }
  releaseWork(GPGP_P mark);
}

/// What is in front of a cut. close: with faces that close it. tight: whether the scope follows.
GPGP_FN uint cutForm(GPGP_POOL GPGP_INOUT(Form) form, Cut cut, bool close, bool tight) {
  const uint faces = meshFaces(GPGP_P form.mesh);
  const uint corners = meshCorners(GPGP_P form.mesh);
  bool above = false;
  bool below = false;
  for (uint c = 0u; c < corners; ++c) {
    const float h = cutHeight(GPGP_P cut, form, c);
    above = above || h > 0.0f;
    below = below || h < 0.0f;
  }
  if (!above) {
    form.mesh = 0u;
    return kGeometryEmpty;
  }
  const uint mark = workMark(GPGP_P0);
  const uint caps = close && below ? takeWork(GPGP_P 2u * corners) : 0xffffffffu;
  if (close && below && caps == kNoWork) return kGeometryTooLarge;
  uint capCount = 0u;
  Builder b = newBuilder(GPGP_P 2u * corners, 4u * corners, corners + meshLoops(GPGP_P form.mesh), corners + faces,
                         meshUvSets(GPGP_P form.mesh));
  if (!below) copyVertices(GPGP_P b, form);
  for (uint f = 0u; f < faces && b.status == kGeometryOk; ++f) {
    const Loop all = faceCorners(GPGP_P form.mesh, f);
    bool faceAbove = false;
    bool faceBelow = false;
    for (uint c = 0u; c < all.corners; ++c) {
      const float h = cutHeight(GPGP_P cut, form, all.firstCorner + c);
      faceAbove = faceAbove || h > 0.0f;
      faceBelow = faceBelow || h < 0.0f;
    }
    // A face within the plane goes: one that closes the piece takes its place, or another piece has it.
    if (!below) {
      copyFace(GPGP_P b, form.mesh, f, 0u, false, 0u);
    } else if (faceAbove) {
      cutFace(GPGP_P b, cut, form, f, caps, capCount);
    }
  }
  if (capCount > 0u)
    addCaps(GPGP_P b, caps, capCount, unit3(vec3(-cut.weight.x, -cut.weight.y, -cut.weight.z)),
            multiply(cut.slack, 4.0f));
  const uint status = finishForm(GPGP_P b, form, tight);
  releaseWork(GPGP_P mark);
  return status;
}

GPGP_SHADER_END
#endif
