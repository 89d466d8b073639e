// From a work item's number to a triangle in clip space: reads the engine's buffers.
//
// Guarantees: nothing is read outside the ranges that the engine gave. Work items count the triangles of all cameras'
// draws in order; the draw table (made by plan.comp and expand_commands.comp) holds each draw's first item and first
// chunk.
#include "visibility/shared/position.h"
#include "visibility/shared/triangle.h"

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
#include "visibility/shared/grid.glsl"
#include "visibility/shared/cameras.glsl"

layout(std430, set = 0, binding = kBindPositions) readonly buffer PositionBuffer { uint positions[]; };
layout(std430, set = 0, binding = kBindIndices) readonly buffer IndexBuffer { uint indices[]; };
layout(std430, set = 0, binding = kBindDraws) readonly buffer DrawBuffer { Draw draws[]; };
layout(std430, set = 0, binding = kBindNumbers) readonly buffer NumberBuffer { uint numbers[]; };
#ifndef TABLE_ACCESS
#define TABLE_ACCESS readonly
#endif
#include "visibility/shared/table.glsl"

struct Fetched {
  vec4 a;
  vec4 b;
  vec4 c;
  vec3 worldA;
  vec3 worldB;
  vec3 worldC;
  uint id;
  uint camera;
  uint flags;  // of its draw
  bool valid;  // false: skipped, for an index or a number out of range
  bool masked; // the camera does not sample its draw
  bool mirrored;
  bool twoSided;
};

/// The entry of the draw table that an item belongs to: the last one that starts at or before it.
uint findEntry(uint item) {
  uint low = 0u;
  uint high = params.entryCount - 1u;
  while (low < high) {
    uint middle = low + (high - low + 1u) / 2u;
    if (startOf(middle).x <= item) low = middle;
    else high = middle - 1u;
  }
  return low;
}

uint fetchIndex(uint index) {
  if (params.shortIndices != 0u) return (indices[index >> 1u] >> ((index & 1u) * 16u)) & 0xffffu;
  return indices[index];
}

/// Where a vertex lies; false where its index or itself lies outside the ranges.
bool fetchPlace(DrawEntry e, uint index, out uint vertex) {
  vertex = 0u;
  if (index >= params.indexCount) return false;
  vertex = fetchIndex(index);
  if (params.hasCommands != 0u && int(e.vertexOffset) < 0) {
    uint back = 0u - e.vertexOffset;
    if (vertex < back) return false;
    vertex -= back;
  } else {
    if (vertex > 0xffffffffu - e.vertexOffset) return false;
    vertex += e.vertexOffset;
  }
  return vertex < params.vertexCount;
}

uint shortAt(uint byte_) { return (positions[byte_ >> 2u] >> ((byte_ & 2u) * 8u)) & 0xffffu; }

/// False as above, or where a coordinate is not a moderate number.
bool fetchVertex(DrawEntry e, uint index, out vec3 position) {
  position = vec3(0.0);
  uint vertex;
  if (!fetchPlace(e, index, vertex)) return false;
  uint at = vertex * params.positionStride + params.positionOffset;
  if (params.positionFormat == kFloats) {
    uint word = at >> 2u;
    position = vec3(uintBitsToFloat(positions[word]), uintBitsToFloat(positions[word + 1u]),
                    uintBitsToFloat(positions[word + 2u]));
  } else {
    uvec3 v = uvec3(shortAt(at), shortAt(at + 2u), shortAt(at + 4u));
    if (params.positionFormat == kHalves) position = vec3(halfToFloat(v.x), halfToFloat(v.y), halfToFloat(v.z));
    else position = vec3(snormToFloat(v.x), snormToFloat(v.y), snormToFloat(v.z));
  }
  return isModerate(position.x) && isModerate(position.y) && isModerate(position.z);
}

/// The number of a draw's triangle; false where there is none, or none below triangleCount.
bool fetchId(DrawEntry e, uint firstTriangle, uint local, out uint id) {
  id = firstTriangle + local;
  if (params.hasNumbers == 0u)
    return firstTriangle < params.triangleCount && local < params.triangleCount - firstTriangle;
  uint place = e.firstIndex / 3u + local; // both below 2^32 / 3
  if (place >= params.numberCount) return false;
  id = numbers[place];
  return id < params.triangleCount;
}

Fetched fetchTriangle(uint entry, uint local) {
  Fetched f;
  DrawEntry e = entryOf(entry);
  Draw draw = draws[e.draw];
  f.camera = e.camera;
  f.flags = draw.flags;
  f.masked = !isSampledBy(draw.flags, layersOf(e.camera));
  f.valid = !f.masked && alphaTestOf(draw.flags) <= params.alphaTestCount;
  if (!f.valid) return f;
  f.valid = fetchId(e, draw.firstTriangle, local, f.id) && seeFrom(draw, e.camera);
  f.mirrored = turnsFaces(draw);
  f.twoSided = (draw.flags & kTwoSided) != 0u;
  uint index = e.firstIndex + local * 3u;
  vec3 p0;
  vec3 p1;
  vec3 p2;
  f.valid = f.valid && index >= e.firstIndex && index <= 0xfffffffdu; // commands may name what is beyond 32 bits
  f.valid = f.valid && fetchVertex(e, index, p0);
  f.valid = f.valid && fetchVertex(e, index + 1u, p1);
  f.valid = f.valid && fetchVertex(e, index + 2u, p2);
  if (!f.valid) return f;
  mat4 toClip = viewProjection(e.camera);
  f.worldA = transformToWorld(draw, p0);
  f.worldB = transformToWorld(draw, p1);
  f.worldC = transformToWorld(draw, p2);
  f.a = transformToClip(toClip, f.worldA);
  f.b = transformToClip(toClip, f.worldB);
  f.c = transformToClip(toClip, f.worldC);
  return f;
}

uint classifyFetched(Fetched f, out ScreenTriangle triangle) {
  if (f.masked) return kOutside;
  if (!f.valid) return kSkipped;
  return classify(f.a, f.b, f.c, gridOf(f.camera), f.mirrored, f.twoSided, triangle);
}

/// The same for one that exact sampling has listed: kClipped, or else it and its corners, in parts of kFine to a unit.
uint classifyCandidate(Fetched f, out ScreenTriangle triangle, out Corners fine) {
  uint fate = classifyFetched(f, triangle);
  fine = unitCorners(triangle);
  if (fate == kWhole) fine = fineCorners(triangle, f.a, f.b, f.c, gridOf(f.camera));
  if (fate == kBackFacing) {
    bool swaps;
    facesFinely(f.a, f.b, f.c, gridOf(f.camera), f.mirrored, f.twoSided, fine, swaps);
    triangle = makeSliver(f.a, f.b, f.c, swaps, fine);
  }
  return fate;
}

/// The entry of a triangle's number among all chunks, of which each has room for kChunk, and the triangle's place in
/// its draw.
uvec2 placeOfNumber(uint number) {
  uint chunk = number / kChunk;
  uint entry = table[chunkAt(chunk)];
  return uvec2(entry, (chunk - chunkStart(entry)) * kChunk + number % kChunk);
}

Fetched fetchNumber(uint number, out uint item) {
  uvec2 place = placeOfNumber(number);
  uint entry = place.x;
  uvec2 start = startOf(entry);
  uint local = place.y;
  item = start.x + local;
  return fetchTriangle(entry, local);
}

Fetched fetchItem(uint item) {
  uint entry = findEntry(item);
  return fetchTriangle(entry, item - startOf(entry).x);
}
