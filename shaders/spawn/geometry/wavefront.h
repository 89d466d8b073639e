// What a straight skeleton (skeleton.h) is made of, in words of the workspace: edges, the wavefront's vertices, which
// move and are linked in loops, the nodes where they are born and end, and the sides of the faces that edges have
// swept.
#ifndef GPGP_SHADERS_SPAWN_GEOMETRY_WAVEFRONT_H
#define GPGP_SHADERS_SPAWN_GEOMETRY_WAVEFRONT_H
#include "spawn/geometry/pool.h"
#include "spawn/geometry/wide.h"

GPGP_SHADER_BEGIN

GPGP_CONST uint kNone = 0xffffffffu;
GPGP_CONST float kSkeletonLength = 1.0e-9f; // what is no length, of an extent of 2
GPGP_CONST float kSkeletonTime = 1.0e-13f;
GPGP_CONST float kSkeletonParallel = 1.0e-12f; // sine
GPGP_CONST float kSkeletonNever = 1.0e30f;

struct Skeleton {
  uint mark; // of the workspace, before
  uint edgeAt;
  uint edges;
  uint maxEdges;
  uint vertexAt;
  uint vertices;
  uint maxVertices;
  uint nodeAt;
  uint nodes;
  uint maxNodes;
  uint sideAt;
  uint sides;
  uint maxSides;
  uint activeAt; // vertices of the wavefront
  uint running;
  uint originals; // edges that were given; those behind are perpendicular ones where speeds differ
  float centreX;  // of the given coordinates
  float centreY;
  float scale; // a power of two: (given - centre) * scale is within -1 to 1
  float unscale;
  Wide now;
  uint status;
};

// Words of an edge.
GPGP_CONST uint kEdgeNormal = 0u; // 2 Wide; unit length, to the left
GPGP_CONST uint kEdgeSpeed = 4u;
GPGP_CONST uint kEdgeStart = 5u; // nodes
GPGP_CONST uint kEdgeEnd = 6u;
GPGP_CONST uint kEdgeSides = 7u; // the first side of its face, kNone where there is none
GPGP_CONST uint kEdgeWords = 8u;
// Words of a vertex of the wavefront.
GPGP_CONST uint kVertexPlace = 0u;    // 2 Wide, at its birth
GPGP_CONST uint kVertexVelocity = 4u; // 2 Wide
GPGP_CONST uint kVertexBirth = 8u;    // Wide
GPGP_CONST uint kVertexVanish = 10u;  // Wide: when the edge to the next vertex does
GPGP_CONST uint kVertexSplit = 12u;   // Wide: when it meets an edge
GPGP_CONST uint kVertexPrevious = 14u;
GPGP_CONST uint kVertexNext = 15u;
GPGP_CONST uint kVertexLeft = 16u;  // the edge that ends here
GPGP_CONST uint kVertexRight = 17u; // the edge that begins here
GPGP_CONST uint kVertexNode = 18u;  // of its birth
GPGP_CONST uint kVertexState = 19u;
GPGP_CONST uint kVertexTarget = 20u; // the vertex that the edge it meets begins at
GPGP_CONST uint kVertexTargetEnd = 21u;
GPGP_CONST uint kVertexSlot = 22u; // among the active ones
GPGP_CONST uint kVertexWords = 23u;
GPGP_CONST uint kStateAlive = 1u;
GPGP_CONST uint kStateReflex = 2u;
GPGP_CONST uint kStateSpike = 4u; // between edges that lie on each other
// A node: x, y, time as Wide. A side: from, to, next side of the same face, the face at the other side or kNone.
GPGP_CONST uint kNodeWords = 6u;
GPGP_CONST uint kSideWords = 4u;

GPGP_FN Wide workWide(GPGP_POOL uint at) {
  Wide r;
  r.hi = workFloat(GPGP_P at);
  r.lo = workFloat(GPGP_P at + 1u);
  return r;
}
GPGP_FN void setWorkWide(GPGP_POOL uint at, Wide v) {
  setWorkFloat(GPGP_P at, v.hi);
  setWorkFloat(GPGP_P at + 1u, v.lo);
}
GPGP_FN Wide2 workWide2(GPGP_POOL uint at) { return wide2(workWide(GPGP_P at), workWide(GPGP_P at + 2u)); }
GPGP_FN void setWorkWide2(GPGP_POOL uint at, Wide2 v) {
  setWorkWide(GPGP_P at, v.x);
  setWorkWide(GPGP_P at + 2u, v.y);
}

GPGP_FN uint edgeWord(GPGP_POOL Skeleton s, uint edge, uint word) {
  return workWord(GPGP_P s.edgeAt + kEdgeWords * edge + word);
}
GPGP_FN Wide2 edgeNormal(GPGP_POOL Skeleton s, uint edge) {
  return workWide2(GPGP_P s.edgeAt + kEdgeWords * edge + kEdgeNormal);
}
GPGP_FN float edgeSpeed(GPGP_POOL Skeleton s, uint edge) {
  return workFloat(GPGP_P s.edgeAt + kEdgeWords * edge + kEdgeSpeed);
}
GPGP_FN uint waveWord(GPGP_POOL Skeleton s, uint v, uint word) {
  return workWord(GPGP_P s.vertexAt + kVertexWords * v + word);
}
GPGP_FN void setWaveWord(GPGP_POOL Skeleton s, uint v, uint word, uint value) {
  setWorkWord(GPGP_P s.vertexAt + kVertexWords * v + word, value);
}
GPGP_FN uint waveNext(GPGP_POOL Skeleton s, uint v) { return waveWord(GPGP_P s, v, kVertexNext); }
GPGP_FN uint wavePrevious(GPGP_POOL Skeleton s, uint v) { return waveWord(GPGP_P s, v, kVertexPrevious); }
GPGP_FN bool waveAlive(GPGP_POOL Skeleton s, uint v) {
  return (waveWord(GPGP_P s, v, kVertexState) & kStateAlive) != 0u;
}
GPGP_FN Wide waveTime(GPGP_POOL Skeleton s, uint v, uint word) {
  return workWide(GPGP_P s.vertexAt + kVertexWords * v + word);
}
GPGP_FN Wide2 waveVelocity(GPGP_POOL Skeleton s, uint v) {
  return workWide2(GPGP_P s.vertexAt + kVertexWords * v + kVertexVelocity);
}
GPGP_FN Wide2 wavePlace(GPGP_POOL Skeleton s, uint v, Wide time) {
  const Wide2 place = workWide2(GPGP_P s.vertexAt + kVertexWords * v + kVertexPlace);
  const Wide since = wideSubtract(time, waveTime(GPGP_P s, v, kVertexBirth));
  if (since.hi == 0.0f) return place;
  return wideAdd2(place, wideScale2(waveVelocity(GPGP_P s, v), since));
}

GPGP_FN float waveSpeed(GPGP_POOL Skeleton s, uint v) {
  const Wide2 velocity = waveVelocity(GPGP_P s, v);
  return max(abs(velocity.x.hi), abs(velocity.y.hi));
}

GPGP_FN uint addNode(GPGP_POOL GPGP_INOUT(Skeleton) s, Wide2 place, Wide time) {
  if (s.nodes >= s.maxNodes) {
    s.status = kGeometryNotSimple;
    return 0u;
  }
  const uint at = s.nodeAt + kNodeWords * s.nodes;
  setWorkWide2(GPGP_P at, place);
  setWorkWide(GPGP_P at + 4u, time);
  s.nodes += 1u;
  return s.nodes - 1u;
}
/// A node in the coordinates that were given: x, y and time.
GPGP_FN vec3 nodePosition(GPGP_POOL Skeleton s, uint node) {
  const uint at = s.nodeAt + kNodeWords * node;
  const Wide x = wideAdd(wideMultiply(workWide(GPGP_P at), wide(s.unscale)), wide(s.centreX));
  const Wide y = wideAdd(wideMultiply(workWide(GPGP_P at + 2u), wide(s.unscale)), wide(s.centreY));
  const Wide t = wideMultiply(workWide(GPGP_P at + 4u), wide(s.unscale));
  return vec3(x.hi, y.hi, t.hi);
}
GPGP_FN void addSide(GPGP_POOL GPGP_INOUT(Skeleton) s, uint edge, uint from, uint to, uint beside) {
  if (from == to) return;
  if (s.sides >= s.maxSides) {
    s.status = kGeometryNotSimple;
    return;
  }
  const uint at = s.sideAt + kSideWords * s.sides;
  const uint head = s.edgeAt + kEdgeWords * edge + kEdgeSides;
  setWorkWord(GPGP_P at, from);
  setWorkWord(GPGP_P at + 1u, to);
  setWorkWord(GPGP_P at + 2u, workWord(GPGP_P head));
  setWorkWord(GPGP_P at + 3u, beside);
  setWorkWord(GPGP_P head, s.sides);
  s.sides += 1u;
}
/// Where the wavefront's edge from a to b ended as a whole: `left` is the edge a to b, `right` the one that met it.
GPGP_FN void addRidge(GPGP_POOL GPGP_INOUT(Skeleton) s, uint left, uint right, uint a, uint b) {
  addSide(GPGP_P s, left, b, a, right);
  addSide(GPGP_P s, right, a, b, left);
}

GPGP_FN void linkWave(GPGP_POOL Skeleton s, uint a, uint b) {
  setWaveWord(GPGP_P s, a, kVertexNext, b);
  setWaveWord(GPGP_P s, b, kVertexPrevious, a);
}

/// A vertex of the wavefront between two edges, born now at a node. Neighbours are for the caller.
GPGP_FN uint addWave(GPGP_POOL GPGP_INOUT(Skeleton) s, uint left, uint right, uint node) {
  if (s.vertices >= s.maxVertices) {
    s.status = kGeometryNotSimple;
    return 0u;
  }
  const uint v = s.vertices;
  s.vertices += 1u;
  const uint at = s.vertexAt + kVertexWords * v;
  const Wide2 a = edgeNormal(GPGP_P s, left);
  const Wide2 b = edgeNormal(GPGP_P s, right);
  const Wide speedA = wide(edgeSpeed(GPGP_P s, left));
  const Wide speedB = wide(edgeSpeed(GPGP_P s, right));
  const Wide sine = wideCross(a, b);
  const Wide cosine = wideDot(a, b);
  uint state = kStateAlive;
  Wide2 velocity = wide2(wide(0.0f), wide(0.0f));
  const bool parallel = abs(sine.hi) < kSkeletonParallel;
  if (parallel && cosine.hi < 0.0f) {
    state |= kStateSpike;
  } else if (cosine.hi > 0.0f && speedA.hi == speedB.hi) {
    velocity = wideScale2(wideAdd2(a, b), wideDivide(speedA, wideAdd(wide(1.0f), cosine)));
  } else if (parallel) {
    velocity = wideScale2(wideAdd2(wideScale2(a, speedA), wideScale2(b, speedB)), wide(0.5f));
  } else {
    velocity.x = wideDivide(wideSubtract(wideMultiply(speedA, b.y), wideMultiply(speedB, a.y)), sine);
    velocity.y = wideDivide(wideSubtract(wideMultiply(speedB, a.x), wideMultiply(speedA, b.x)), sine);
  }
  if (sine.hi < -1.0e-10f && (state & kStateSpike) == 0u) state |= kStateReflex;
  setWorkWide2(GPGP_P at + kVertexPlace, workWide2(GPGP_P s.nodeAt + kNodeWords * node));
  setWorkWide2(GPGP_P at + kVertexVelocity, velocity);
  setWorkWide(GPGP_P at + kVertexBirth, s.now);
  setWorkWide(GPGP_P at + kVertexVanish, wide(kSkeletonNever));
  setWorkWide(GPGP_P at + kVertexSplit, wide(kSkeletonNever));
  setWorkWord(GPGP_P at + kVertexPrevious, v);
  setWorkWord(GPGP_P at + kVertexNext, v);
  setWorkWord(GPGP_P at + kVertexLeft, left);
  setWorkWord(GPGP_P at + kVertexRight, right);
  setWorkWord(GPGP_P at + kVertexNode, node);
  setWorkWord(GPGP_P at + kVertexState, state);
  setWorkWord(GPGP_P at + kVertexTarget, kNone);
  setWorkWord(GPGP_P at + kVertexTargetEnd, kNone);
  setWorkWord(GPGP_P at + kVertexSlot, s.running);
  setWorkWord(GPGP_P s.activeAt + s.running, v);
  s.running += 1u;
  return v;
}
/// The vertex ends at a node: its way is a side of two faces.
GPGP_FN void endWave(GPGP_POOL GPGP_INOUT(Skeleton) s, uint v, uint node) {
  const uint left = waveWord(GPGP_P s, v, kVertexLeft);
  const uint right = waveWord(GPGP_P s, v, kVertexRight);
  const uint birth = waveWord(GPGP_P s, v, kVertexNode);
  addSide(GPGP_P s, left, birth, node, right);
  addSide(GPGP_P s, right, node, birth, left);
  setWaveWord(GPGP_P s, v, kVertexState, 0u);
  const uint slot = waveWord(GPGP_P s, v, kVertexSlot);
  s.running -= 1u;
  const uint last = workWord(GPGP_P s.activeAt + s.running);
  setWorkWord(GPGP_P s.activeAt + slot, last);
  setWaveWord(GPGP_P s, last, kVertexSlot, slot);
}
/// A node where the vertex is now.
GPGP_FN uint nodeOfWave(GPGP_POOL GPGP_INOUT(Skeleton) s, uint v) {
  const Wide since = wideSubtract(s.now, waveTime(GPGP_P s, v, kVertexBirth));
  if (since.hi == 0.0f) return waveWord(GPGP_P s, v, kVertexNode);
  return addNode(GPGP_P s, wavePlace(GPGP_P s, v, s.now), s.now);
}

GPGP_FN Wide2 edgeDirection(GPGP_POOL Skeleton s, uint edge) {
  const Wide2 n = edgeNormal(GPGP_P s, edge);
  return wide2(n.y, wideNegate(n.x));
}

GPGP_SHADER_END
#endif
