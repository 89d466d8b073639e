// Meshes in a pool: where they lie, how they are read, and how new ones are written.
//
// A mesh is an offset into a pool of words. Its header names ranges of faces, loops, corners, positions and texture
// coordinates. Ranges are immutable, so that meshes may share them: a mesh with other texture coordinates is a new
// header and one new range. Room is taken by moving a mark (`takePool`); what does not fit is counted, with the size
// that would have fitted. Each invocation has a workspace beside the pool, which operators use as a stack.
//
// A face has an outer loop, counter-clockwise seen from where its normal points to, and loops of holes, clockwise. A
// corner is a vertex in a loop; it stands for the edge to the next corner of its loop too, and carries that edge's tag.
// Positions are in units of the mesh; a form (below) says where these lie.
//
// In C++ pool and workspace are the MeshPool that each function takes first. In GLSL the shader that includes this file
// defines poolWord, setPoolWord, takePool, workWord, setWorkWord, takeWork, workMark and releaseWork.
#ifndef GPGP_SHADERS_SPAWN_GEOMETRY_POOL_H
#define GPGP_SHADERS_SPAWN_GEOMETRY_POOL_H
#include "core/math.h"

GPGP_SHADER_BEGIN

// How an operator ended.
GPGP_CONST uint kGeometryOk = 0u;
GPGP_CONST uint kGeometryEmpty = 1u;       // nothing is left of the shape, or nothing was selected: mesh 0, no error
GPGP_CONST uint kGeometryNoRoom = 2u;      // the pool's budget; MeshPool::needed says what would have fitted
GPGP_CONST uint kGeometryTooLarge = 3u;    // a face above kMaxFaceCorners, or the workspace; MeshPool::workNeeded
GPGP_CONST uint kGeometryNotSimple = 4u;   // a polygon that touches or crosses itself
GPGP_CONST uint kGeometryNotPlanar = 5u;   // a face that lies in no plane
GPGP_CONST uint kGeometryBadArgument = 6u; // an index, a selector or a number outside what the function states
GPGP_CONST uint kGeometryUnsettled = 7u;   // edges that move at different speeds met so that no outline was left

GPGP_CONST uint kMaxFaceCorners = 1024u; // of all loops of a face
GPGP_CONST uint kMaxUvSets = 10u;        // as CGA's

// The header's words.
GPGP_CONST uint kMeshFaces = 0u; // counts
GPGP_CONST uint kMeshLoops = 1u;
GPGP_CONST uint kMeshCorners = 2u;
GPGP_CONST uint kMeshVertices = 3u;
GPGP_CONST uint kMeshFaceRange = 4u; // offsets
GPGP_CONST uint kMeshLoopRange = 5u;
GPGP_CONST uint kMeshCornerRange = 6u;
GPGP_CONST uint kMeshPositionRange = 7u;
GPGP_CONST uint kMeshUvSets = 8u;  // bit mask of the sets that there are
GPGP_CONST uint kMeshUvRange = 9u; // offset of set 0, and of the other sets behind it
GPGP_CONST uint kMeshHeader = 19u;

GPGP_CONST uint kFaceWords = 3u;   // first loop, loops, tags
GPGP_CONST uint kLoopWords = 2u;   // first corner, corners
GPGP_CONST uint kCornerWords = 2u; // vertex, tags of the edge
// Tags that operators set on faces and edges. Bits from 16 on belong to the grammar.
GPGP_CONST uint kTagRoofTop = 1u;    // a face of the roof
GPGP_CONST uint kTagRoofSide = 2u;   // a gable
GPGP_CONST uint kTagRoofBottom = 4u; // the face that the roof stands on
GPGP_CONST uint kTagExtrudeTop = 8u;
GPGP_CONST uint kTagExtrudeSide = 16u;
GPGP_CONST uint kTagExtrudeBottom = 32u;
GPGP_CONST uint kTagCut = 64u;      // a face that closes what a split opened; an edge along it
GPGP_CONST uint kTagSetback = 128u; // an edge that setback or offset made
GPGP_CONST uint kTagEave = 256u;    // edges of roofs
GPGP_CONST uint kTagRidge = 512u;
GPGP_CONST uint kTagHip = 1024u;
GPGP_CONST uint kTagValley = 2048u;
GPGP_CONST uint kTagBooleanA = 4096u; // faces of the operands
GPGP_CONST uint kTagBooleanB = 8192u;
GPGP_CONST uint kTagUser = 65536u;             // the names of a grammar, up to kTagStreetFront
GPGP_CONST uint kTagStreetFront = 0x10000000u; // edges and what is extruded from them, by the street that they are at
GPGP_CONST uint kTagStreetBack = 0x20000000u;
GPGP_CONST uint kTagStreetLeft = 0x40000000u;
GPGP_CONST uint kTagStreetRight = 0x80000000u;

/// A box in the axiom's frame: its corner, unit axes at right angles to each other, right-handed, and extents in
/// metres, none negative.
struct Scope {
  vec3 origin;
  vec3 axisX;
  vec3 axisY;
  vec3 axisZ;
  vec3 size;
};

/// A mesh in a scope: position p of the mesh is scope.origin + axisX * p.x * scale.x + axisY * ... in the axiom's
/// frame. The scope may be larger than the mesh. mesh 0: no geometry. No scale is negative.
struct Form {
  Scope scope;
  vec3 scale;
  uint mesh;
};

#ifdef __cplusplus
struct MeshPool {
  uint* words = nullptr; // word 0 is not used: mesh 0 is none
  uint capacity = 0;
  uint used = 1;
  uint needed = 1;  // what used would be, had all fitted
  uint dropped = 0; // meshes that did not fit
  uint* work = nullptr;
  uint workCapacity = 0;
  uint workUsed = 0;
  uint workNeeded = 0; // the largest that was asked for
  // Work is counted in steps: words of memory that were taken, corners that were looked at. Behind mostSteps nothing
  // gets workspace, so that operators end.
  unsigned long long steps = 0;
  unsigned long long mostSteps = ~0ull;
};
/// Whether there are steps left.
inline bool countSteps(MeshPool& pool, unsigned long long count) {
  pool.steps += count;
  return pool.steps <= pool.mostSteps;
}
#define GPGP_POOL ::gpgp::shader::MeshPool &pool,
#define GPGP_POOL0 ::gpgp::shader::MeshPool& pool
#define GPGP_P pool,
#define GPGP_P0 pool
inline uint poolWord(const MeshPool& pool, uint at) { return pool.words[at]; }
inline void setPoolWord(MeshPool& pool, uint at, uint v) { pool.words[at] = v; }
/// 0 where there is no room.
inline uint takePool(MeshPool& pool, uint count) {
  countSteps(pool, count);
  const uint sum = pool.needed + count;
  pool.needed = sum < pool.needed ? 0xffffffffu : sum;
  if (count > pool.capacity || pool.used > pool.capacity - count) {
    pool.dropped += 1;
    return 0;
  }
  pool.used += count;
  return pool.used - count;
}
inline uint workWord(const MeshPool& pool, uint at) { return pool.work[at]; }
inline void setWorkWord(MeshPool& pool, uint at, uint v) { pool.work[at] = v; }
GPGP_CONST uint kNoWork = 0xffffffffu;
/// kNoWork where there is no room.
inline uint takeWork(MeshPool& pool, uint count) {
  if (!countSteps(pool, count)) return kNoWork;
  const uint sum = pool.workUsed + count;
  if (sum < count || sum > pool.workCapacity) {
    pool.workNeeded = sum < count ? 0xffffffffu : sum > pool.workNeeded ? sum : pool.workNeeded;
    return kNoWork;
  }
  pool.workUsed = sum;
  if (sum > pool.workNeeded) pool.workNeeded = sum;
  return sum - count;
}
inline uint workMark(const MeshPool& pool) { return pool.workUsed; }
inline void releaseWork(MeshPool& pool, uint mark) { pool.workUsed = mark; }
#else
#define GPGP_POOL
#define GPGP_POOL0
#define GPGP_P
#define GPGP_P0
GPGP_CONST uint kNoWork = 0xffffffffu;
uint poolWord(uint at);
void setPoolWord(uint at, uint v);
uint takePool(uint count);
uint workWord(uint at);
void setWorkWord(uint at, uint v);
uint takeWork(uint count);
uint workMark();
void releaseWork(uint mark);
bool countSteps(uint count) { return true; } // the device bounds its work itself
#endif

GPGP_FN float poolFloat(GPGP_POOL uint at) { return uintBitsToFloat(poolWord(GPGP_P at)); }
GPGP_FN float workFloat(GPGP_POOL uint at) { return uintBitsToFloat(workWord(GPGP_P at)); }
GPGP_FN void setWorkFloat(GPGP_POOL uint at, float v) { setWorkWord(GPGP_P at, floatBitsToUint(v)); }
GPGP_FN vec3 workVector(GPGP_POOL uint at) {
  return vec3(workFloat(GPGP_P at), workFloat(GPGP_P at + 1u), workFloat(GPGP_P at + 2u));
}
GPGP_FN void setWorkVector(GPGP_POOL uint at, vec3 v) {
  setWorkFloat(GPGP_P at, v.x);
  setWorkFloat(GPGP_P at + 1u, v.y);
  setWorkFloat(GPGP_P at + 2u, v.z);
}

// ---------------------------------------------------------------- reading

GPGP_FN uint meshFaces(GPGP_POOL uint mesh) { return mesh == 0u ? 0u : poolWord(GPGP_P mesh + kMeshFaces); }
GPGP_FN uint meshLoops(GPGP_POOL uint mesh) { return mesh == 0u ? 0u : poolWord(GPGP_P mesh + kMeshLoops); }
GPGP_FN uint meshCorners(GPGP_POOL uint mesh) { return mesh == 0u ? 0u : poolWord(GPGP_P mesh + kMeshCorners); }
GPGP_FN uint meshVertices(GPGP_POOL uint mesh) { return mesh == 0u ? 0u : poolWord(GPGP_P mesh + kMeshVertices); }
GPGP_FN uint meshUvSets(GPGP_POOL uint mesh) { return mesh == 0u ? 0u : poolWord(GPGP_P mesh + kMeshUvSets); }

struct Face {
  uint firstLoop;
  uint loops;
  uint tags;
};
struct Loop {
  uint firstCorner;
  uint corners;
};
GPGP_FN Face faceOf(GPGP_POOL uint mesh, uint face) {
  const uint at = poolWord(GPGP_P mesh + kMeshFaceRange) + face * kFaceWords;
  Face f;
  f.firstLoop = poolWord(GPGP_P at);
  f.loops = poolWord(GPGP_P at + 1u);
  f.tags = poolWord(GPGP_P at + 2u);
  return f;
}
GPGP_FN Loop loopOf(GPGP_POOL uint mesh, uint loop) {
  const uint at = poolWord(GPGP_P mesh + kMeshLoopRange) + loop * kLoopWords;
  Loop l;
  l.firstCorner = poolWord(GPGP_P at);
  l.corners = poolWord(GPGP_P at + 1u);
  return l;
}
GPGP_FN uint cornerVertex(GPGP_POOL uint mesh, uint corner) {
  return poolWord(GPGP_P poolWord(GPGP_P mesh + kMeshCornerRange) + corner * kCornerWords);
}
GPGP_FN uint cornerTags(GPGP_POOL uint mesh, uint corner) {
  return poolWord(GPGP_P poolWord(GPGP_P mesh + kMeshCornerRange) + corner * kCornerWords + 1u);
}
GPGP_FN vec3 vertexPosition(GPGP_POOL uint mesh, uint vertex) {
  const uint at = poolWord(GPGP_P mesh + kMeshPositionRange) + vertex * 3u;
  return vec3(poolFloat(GPGP_P at), poolFloat(GPGP_P at + 1u), poolFloat(GPGP_P at + 2u));
}
GPGP_FN vec3 cornerPosition(GPGP_POOL uint mesh, uint corner) {
  return vertexPosition(GPGP_P mesh, cornerVertex(GPGP_P mesh, corner));
}
/// (0, 0) where the mesh has no such set.
GPGP_FN vec2 cornerUv(GPGP_POOL uint mesh, uint set, uint corner) {
  if (((meshUvSets(GPGP_P mesh) >> set) & 1u) == 0u) return vec2(0.0f);
  const uint at = poolWord(GPGP_P mesh + kMeshUvRange + set) + corner * 2u;
  return vec2(poolFloat(GPGP_P at), poolFloat(GPGP_P at + 1u));
}
/// The face's first corner and the number of its corners; loops of a face lie one behind the other.
GPGP_FN Loop faceCorners(GPGP_POOL uint mesh, uint face) {
  const Face f = faceOf(GPGP_P mesh, face);
  const Loop first = loopOf(GPGP_P mesh, f.firstLoop);
  const Loop last = loopOf(GPGP_P mesh, f.firstLoop + f.loops - 1u);
  Loop all;
  all.firstCorner = first.firstCorner;
  all.corners = last.firstCorner + last.corners - first.firstCorner;
  return all;
}
GPGP_FN uint nextCorner(Loop loop, uint corner) {
  return corner + 1u == loop.firstCorner + loop.corners ? loop.firstCorner : corner + 1u;
}
GPGP_FN uint previousCorner(Loop loop, uint corner) {
  return corner == loop.firstCorner ? loop.firstCorner + loop.corners - 1u : corner - 1u;
}

GPGP_SHADER_END
#endif
