// From a work item's number to a triangle in clip space: reads the engine's buffers.
//
// Guarantees: nothing is read outside the ranges that the engine gave. Work items count the triangles of all draws in
// order; `starts` (made by plan.comp) holds each draw's first
// item and first chunk.
#include "visibility/triangle.h"

layout(std430, set = 0, binding = kBindParams) readonly buffer ParamsBuffer { Params params; };
#include "visibility/grid.glsl"

layout(std430, set = 0, binding = kBindPositions) readonly buffer PositionBuffer { uint positions[]; };
layout(std430, set = 0, binding = kBindIndices) readonly buffer IndexBuffer { uint indices[]; };
layout(std430, set = 0, binding = kBindDraws) readonly buffer DrawBuffer { Draw draws[]; };
layout(std430, set = 0, binding = kBindMeshes) readonly buffer MeshBuffer { Mesh meshes[]; };
layout(std430, set = 0, binding = kBindStarts) readonly buffer StartBuffer { uvec2 starts[]; };

struct Fetched {
  vec4 a;
  vec4 b;
  vec4 c;
  uint id;
  bool valid; // false: skipped, for an index or a number out of range
  bool mirrored;
  bool twoSided;
};

/// The draw that an item belongs to: the last one that starts at or before it.
uint findDraw(uint item) {
  uint low = 0u;
  uint high = params.drawCount - 1u;
  while (low < high) {
    uint middle = low + (high - low + 1u) / 2u;
    if (starts[middle].x <= item) low = middle;
    else high = middle - 1u;
  }
  return low;
}

/// False where an index or the vertex that it names lies outside its range, or a coordinate is not a moderate number.
bool fetchVertex(Mesh mesh, uint index, out vec3 position) {
  position = vec3(0.0);
  if (index >= params.indexCount) return false;
  uint vertex;
  if (params.shortIndices != 0u) vertex = (indices[index >> 1u] >> ((index & 1u) * 16u)) & 0xffffu;
  else vertex = indices[index];
  if (vertex > 0xffffffffu - mesh.vertexOffset) return false;
  vertex += mesh.vertexOffset;
  if (vertex >= params.vertexCount) return false;
  uint word = vertex * params.strideWords;
  position = vec3(uintBitsToFloat(positions[word]), uintBitsToFloat(positions[word + 1u]),
                  uintBitsToFloat(positions[word + 2u]));
  return isModerate(position.x) && isModerate(position.y) && isModerate(position.z);
}

Fetched fetchTriangle(uint drawIndex, uint local) {
  Fetched f;
  Draw draw = draws[drawIndex];
  Mesh mesh = meshes[draw.mesh]; // plan.comp gave draws of no mesh no items
  f.id = draw.firstTriangle + local;
  f.valid = draw.firstTriangle < params.triangleCount && local < params.triangleCount - draw.firstTriangle;
  f.mirrored = mirrors(draw);
  f.twoSided = (draw.flags & kTwoSided) != 0u;
  uint index = mesh.firstIndex + local * 3u;
  vec3 p0;
  vec3 p1;
  vec3 p2;
  f.valid = f.valid && fetchVertex(mesh, index, p0);
  f.valid = f.valid && fetchVertex(mesh, index + 1u, p1);
  f.valid = f.valid && fetchVertex(mesh, index + 2u, p2);
  if (!f.valid) return f;
  f.a = transformToClip(draw, params, p0);
  f.b = transformToClip(draw, params, p1);
  f.c = transformToClip(draw, params, p2);
  return f;
}

uint classifyFetched(Fetched f, out ScreenTriangle triangle) {
  if (!f.valid) return kSkipped;
  return classify(f.a, f.b, f.c, grid(), f.mirrored, f.twoSided, triangle);
}

Fetched fetchItem(uint item) {
  uint drawIndex = findDraw(item);
  return fetchTriangle(drawIndex, item - starts[drawIndex].x);
}
