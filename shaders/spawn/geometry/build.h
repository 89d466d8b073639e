// Writing a mesh: it is made in the workspace, within counts that its maker knows, and copied to the pool when whole.
#ifndef GPGP_SHADERS_SPAWN_GEOMETRY_BUILD_H
#define GPGP_SHADERS_SPAWN_GEOMETRY_BUILD_H
#include "spawn/geometry/vectors.h"

GPGP_SHADER_BEGIN

struct Builder {
  uint mark; // of the workspace, before
  uint vertices;
  uint loops;
  uint corners;
  uint faces;
  uint maxVertices;
  uint maxLoops;
  uint maxCorners;
  uint maxFaces;
  uint vertexAt; // offsets in the workspace
  uint loopAt;
  uint cornerAt;
  uint faceAt;
  uint uvAt;
  uint uvSets;
  uint status;
};

GPGP_FN Builder newBuilder(GPGP_POOL uint maxVertices, uint maxCorners, uint maxLoops, uint maxFaces, uint uvSets) {
  Builder b;
  b.mark = workMark(GPGP_P0);
  b.vertices = 0u;
  b.loops = 0u;
  b.corners = 0u;
  b.faces = 0u;
  b.maxVertices = maxVertices;
  b.maxLoops = maxLoops;
  b.maxCorners = maxCorners;
  b.maxFaces = maxFaces;
  b.uvSets = uvSets;
  const uint uvWords = maxCorners * 2u * uint(bitCount(uvSets));
  const uint words =
      3u * maxVertices + kLoopWords * maxLoops + kCornerWords * maxCorners + kFaceWords * maxFaces + uvWords;
  b.vertexAt = takeWork(GPGP_P words);
  b.status = b.vertexAt == kNoWork ? kGeometryTooLarge : kGeometryOk;
  b.loopAt = b.vertexAt + 3u * maxVertices;
  b.cornerAt = b.loopAt + kLoopWords * maxLoops;
  b.faceAt = b.cornerAt + kCornerWords * maxCorners;
  b.uvAt = b.faceAt + kFaceWords * maxFaces;
  return b;
}
GPGP_FN uint addVertex(GPGP_POOL GPGP_INOUT(Builder) b, vec3 p) {
  if (b.vertices >= b.maxVertices) b.status = kGeometryTooLarge;
  if (b.status != kGeometryOk) return 0u;
  setWorkVector(GPGP_P b.vertexAt + 3u * b.vertices, settle3(p));
  b.vertices += 1u;
  return b.vertices - 1u;
}
GPGP_FN vec3 builderPosition(GPGP_POOL Builder b, uint vertex) { return workVector(GPGP_P b.vertexAt + 3u * vertex); }
GPGP_FN void beginFace(GPGP_POOL GPGP_INOUT(Builder) b, uint tags) {
  if (b.faces >= b.maxFaces) b.status = kGeometryTooLarge;
  if (b.status != kGeometryOk) return;
  const uint at = b.faceAt + kFaceWords * b.faces;
  setWorkWord(GPGP_P at, b.loops);
  setWorkWord(GPGP_P at + 1u, 0u);
  setWorkWord(GPGP_P at + 2u, tags);
  b.faces += 1u;
}
GPGP_FN void beginLoop(GPGP_POOL GPGP_INOUT(Builder) b) {
  if (b.loops >= b.maxLoops || b.faces == 0u) b.status = kGeometryTooLarge;
  if (b.status != kGeometryOk) return;
  setWorkWord(GPGP_P b.loopAt + kLoopWords * b.loops, b.corners);
  setWorkWord(GPGP_P b.loopAt + kLoopWords * b.loops + 1u, 0u);
  b.loops += 1u;
  const uint at = b.faceAt + kFaceWords * (b.faces - 1u) + 1u;
  setWorkWord(GPGP_P at, workWord(GPGP_P at) + 1u);
}
/// Its number.
GPGP_FN uint addCorner(GPGP_POOL GPGP_INOUT(Builder) b, uint vertex, uint tags) {
  if (b.corners >= b.maxCorners || b.loops == 0u) b.status = kGeometryTooLarge;
  if (b.status != kGeometryOk) return 0u;
  setWorkWord(GPGP_P b.cornerAt + kCornerWords * b.corners, vertex);
  setWorkWord(GPGP_P b.cornerAt + kCornerWords * b.corners + 1u, tags);
  const uint uvWords = 2u * uint(bitCount(b.uvSets));
  for (uint i = 0u; i < uvWords; ++i) {
    setWorkWord(GPGP_P b.uvAt + uvWords * b.corners + i, 0u);
  }
  const uint at = b.loopAt + kLoopWords * (b.loops - 1u) + 1u;
  setWorkWord(GPGP_P at, workWord(GPGP_P at) + 1u);
  b.corners += 1u;
  return b.corners - 1u;
}
GPGP_FN uint uvSlot(uint sets, uint set) { return uint(bitCount(sets & ((1u << set) - 1u))); }
GPGP_FN void setCornerUv(GPGP_POOL Builder b, uint set, uint corner, vec2 uv) {
  if (b.status != kGeometryOk || ((b.uvSets >> set) & 1u) == 0u) return;
  const uint at = b.uvAt + 2u * (uint(bitCount(b.uvSets)) * corner + uvSlot(b.uvSets, set));
  setWorkFloat(GPGP_P at, settle(uv.x));
  setWorkFloat(GPGP_P at + 1u, settle(uv.y));
}
/// A corner's coordinates of all sets, from those of two corners of a mesh: those of `from` at 0, of `to` at 1.
GPGP_FN void copyCornerUv(GPGP_POOL Builder b, uint corner, uint mesh, uint from, uint to, float t) {
  for (uint set = 0u; set < kMaxUvSets; ++set) {
    if (((b.uvSets >> set) & 1u) == 0u) continue;
    vec2 uv = cornerUv(GPGP_P mesh, set, from);
    if (t != 0.0f) {
      const vec2 other = cornerUv(GPGP_P mesh, set, to);
      GPGP_PRECISE vec2 mixed = uv + (other - uv) * t;
      uv = mixed;
    }
    setCornerUv(GPGP_P b, set, corner, uv);
  }
}
/// Takes back the loop that was begun last.
GPGP_FN void dropLoop(GPGP_POOL GPGP_INOUT(Builder) b) {
  if (b.status != kGeometryOk) return;
  b.loops -= 1u;
  b.corners = workWord(GPGP_P b.loopAt + kLoopWords * b.loops);
  const uint at = b.faceAt + kFaceWords * (b.faces - 1u) + 1u;
  setWorkWord(GPGP_P at, workWord(GPGP_P at) - 1u);
}
/// Takes back the face that was begun last.
GPGP_FN void dropFace(GPGP_POOL GPGP_INOUT(Builder) b) {
  if (b.status != kGeometryOk) return;
  b.faces -= 1u;
  const uint first = workWord(GPGP_P b.faceAt + kFaceWords * b.faces);
  if (first < b.loops) {
    b.corners = workWord(GPGP_P b.loopAt + kLoopWords * first);
    b.loops = first;
  }
}
/// Takes back the loop begun last if it is no polygon, and its face if nothing is left of that.
GPGP_FN void endLoop(GPGP_POOL GPGP_INOUT(Builder) b) {
  if (b.status != kGeometryOk) return;
  if (workWord(GPGP_P b.loopAt + kLoopWords * (b.loops - 1u) + 1u) < 3u) dropLoop(GPGP_P b);
}
GPGP_FN void endFace(GPGP_POOL GPGP_INOUT(Builder) b) {
  if (b.status != kGeometryOk) return;
  if (workWord(GPGP_P b.faceAt + kFaceWords * (b.faces - 1u) + 1u) == 0u) dropFace(GPGP_P b);
}

/// Copies the mesh to the pool and frees the workspace from the builder's mark on. kGeometryEmpty: it has no face.
GPGP_FN uint finishMesh(GPGP_POOL GPGP_INOUT(Builder) b, GPGP_OUT(uint) mesh) {
  mesh = 0u;
  uint status = b.status;
  for (uint f = 0u; status == kGeometryOk && f < b.faces; ++f) {
    const uint first = workWord(GPGP_P b.faceAt + kFaceWords * f);
    const uint last = first + workWord(GPGP_P b.faceAt + kFaceWords * f + 1u) - 1u;
    const uint corners = workWord(GPGP_P b.loopAt + kLoopWords * last) +
                         workWord(GPGP_P b.loopAt + kLoopWords * last + 1u) -
                         workWord(GPGP_P b.loopAt + kLoopWords * first);
    if (corners > kMaxFaceCorners) status = kGeometryTooLarge;
  }
  if (status == kGeometryOk && b.faces == 0u) status = kGeometryEmpty;
  if (status == kGeometryOk) {
    const uint sets = uint(bitCount(b.uvSets));
    const uint words = kMeshHeader + kFaceWords * b.faces + kLoopWords * b.loops + kCornerWords * b.corners +
                       3u * b.vertices + 2u * sets * b.corners;
    const uint to = takePool(GPGP_P words);
    if (to == 0u) {
      status = kGeometryNoRoom;
    } else {
      const uint faceAt = to + kMeshHeader;
      const uint loopAt = faceAt + kFaceWords * b.faces;
      const uint cornerAt = loopAt + kLoopWords * b.loops;
      const uint vertexAt = cornerAt + kCornerWords * b.corners;
      const uint uvAt = vertexAt + 3u * b.vertices;
      setPoolWord(GPGP_P to + kMeshFaces, b.faces);
      setPoolWord(GPGP_P to + kMeshLoops, b.loops);
      setPoolWord(GPGP_P to + kMeshCorners, b.corners);
      setPoolWord(GPGP_P to + kMeshVertices, b.vertices);
      setPoolWord(GPGP_P to + kMeshFaceRange, faceAt);
      setPoolWord(GPGP_P to + kMeshLoopRange, loopAt);
      setPoolWord(GPGP_P to + kMeshCornerRange, cornerAt);
      setPoolWord(GPGP_P to + kMeshPositionRange, vertexAt);
      setPoolWord(GPGP_P to + kMeshUvSets, b.uvSets);
      for (uint i = 0u; i < kFaceWords * b.faces; ++i) {
        setPoolWord(GPGP_P faceAt + i, workWord(GPGP_P b.faceAt + i));
      }
      for (uint i = 0u; i < kLoopWords * b.loops; ++i) {
        setPoolWord(GPGP_P loopAt + i, workWord(GPGP_P b.loopAt + i));
      }
      for (uint i = 0u; i < kCornerWords * b.corners; ++i) {
        setPoolWord(GPGP_P cornerAt + i, workWord(GPGP_P b.cornerAt + i));
      }
      for (uint i = 0u; i < 3u * b.vertices; ++i) {
        setPoolWord(GPGP_P vertexAt + i, workWord(GPGP_P b.vertexAt + i));
      }
      uint slot = 0u;
      for (uint set = 0u; set < kMaxUvSets; ++set) {
        const bool has = ((b.uvSets >> set) & 1u) != 0u;
        const uint range = uvAt + 2u * slot * b.corners;
        setPoolWord(GPGP_P to + kMeshUvRange + set, has ? range : 0u);
        if (!has) continue;
        for (uint c = 0u; c < b.corners; ++c) {
          const uint from = b.uvAt + 2u * (sets * c + slot);
          setPoolWord(GPGP_P range + 2u * c, workWord(GPGP_P from));
          setPoolWord(GPGP_P range + 2u * c + 1u, workWord(GPGP_P from + 1u));
        }
        slot += 1u;
      }
      mesh = to;
    }
  }
  releaseWork(GPGP_P b.mark);
  return status;
}

/// The mesh as a form: the builder's positions are metres along the scope's axes from its origin. tight: the scope
/// becomes the box around them, extents that are only rounding become 0; else it stays.
GPGP_FN uint finishForm(GPGP_POOL GPGP_INOUT(Builder) b, GPGP_INOUT(Form) form, bool tight) {
  vec3 low = vec3(0.0f);
  vec3 extent = form.scope.size;
  if (tight && b.status == kGeometryOk && b.vertices > 0u) {
    vec3 high = builderPosition(GPGP_P b, 0u);
    low = high;
    for (uint i = 1u; i < b.vertices; ++i) {
      const vec3 p = builderPosition(GPGP_P b, i);
      low = vec3(min(low.x, p.x), min(low.y, p.y), min(low.z, p.z));
      high = vec3(max(high.x, p.x), max(high.y, p.y), max(high.z, p.z));
    }
    extent = minus3(high, low);
    const float least = multiply(max(extent.x, max(extent.y, extent.z)), 2.0e-6f);
    extent = vec3(extent.x > least ? extent.x : 0.0f, extent.y > least ? extent.y : 0.0f,
                  extent.z > least ? extent.z : 0.0f);
    for (uint i = 0u; i < b.vertices; ++i) {
      const vec3 p = minus3(builderPosition(GPGP_P b, i), low);
      setWorkVector(GPGP_P b.vertexAt + 3u * i,
                    vec3(extent.x > 0.0f ? p.x : 0.0f, extent.y > 0.0f ? p.y : 0.0f, extent.z > 0.0f ? p.z : 0.0f));
    }
  }
  uint mesh = 0u;
  const uint status = finishMesh(GPGP_P b, mesh);
  if (status > kGeometryEmpty) return status;
  form.mesh = mesh;
  form.scale = vec3(1.0f);
  if (tight) {
    form.scope.origin = scopePoint(form.scope, low);
    form.scope.size = extent;
  }
  return status;
}

GPGP_FN Builder builderFor(GPGP_POOL uint mesh, uint factor) {
  return newBuilder(GPGP_P factor * meshVertices(GPGP_P mesh), factor * meshCorners(GPGP_P mesh),
                    factor * meshLoops(GPGP_P mesh), factor * meshFaces(GPGP_P mesh), meshUvSets(GPGP_P mesh));
}
/// All vertices of a form, in metres, in their order.
GPGP_FN void copyVertices(GPGP_POOL GPGP_INOUT(Builder) b, Form form) {
  for (uint v = 0u; v < meshVertices(GPGP_P form.mesh); ++v) {
    addVertex(GPGP_P b, scaled3(vertexPosition(GPGP_P form.mesh, v), form.scale));
  }
}
/// A face with its corners, tags and coordinates; its vertices are those of the mesh and `firstVertex`. reversed: it
/// faces the other way.
GPGP_FN void copyFace(GPGP_POOL GPGP_INOUT(Builder) b, uint mesh, uint face, uint firstVertex, bool reversed,
                      uint tags) {
  const Face found = faceOf(GPGP_P mesh, face);
  beginFace(GPGP_P b, found.tags | tags);
  for (uint l = 0u; l < found.loops; ++l) {
    const Loop loop = loopOf(GPGP_P mesh, found.firstLoop + l);
    beginLoop(GPGP_P b);
    for (uint i = 0u; i < loop.corners; ++i) {
      const uint corner = loop.firstCorner + (reversed ? loop.corners - 1u - i : i);
      const uint ofEdge = reversed ? previousCorner(loop, corner) : corner;
      const uint made =
          addCorner(GPGP_P b, firstVertex + cornerVertex(GPGP_P mesh, corner), cornerTags(GPGP_P mesh, ofEdge));
      copyCornerUv(GPGP_P b, made, mesh, corner, corner, 0.0f);
    }
  }
}

GPGP_SHADER_END
#endif
