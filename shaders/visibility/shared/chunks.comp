// One invocation a chunk: finds the draw that it belongs to, once for all passes; with clusters, whether it may be in
// sight. Chunks of a draw are its mesh's clusters.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/layout.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindDraws) readonly buffer DrawBuffer { Draw draws[]; };
#define TABLE_ACCESS
#include "visibility/shared/table.glsl"
#include "visibility/shared/cameras.glsl"
#include "visibility/shared/chunks.glsl"
#define CLUSTER_ACCESS readonly
#include "visibility/shared/clusters.glsl"

shared uint groupKept;
shared uint firstKept;

uint findEntry(uint chunk) {
  uint low = 0u;
  uint high = params.entryCount - 1u;
  while (low < high) {
    uint middle = low + (high - low + 1u) / 2u;
    if (chunkStart(middle) <= chunk) low = middle;
    else high = middle - 1u;
  }
  return low;
}

bool mayBeInSight(uint chunk, uint entry) {
  DrawEntry e = entryOf(entry);
  Draw draw = draws[e.draw];
  if (!isSampledBy(draw.flags, layersOf(e.camera))) return false;
  uint place = chunk - chunkStart(entry);
  // Triangles whose numbers are out of range are counted.
  uint end = min((place + 1u) * kChunk, e.indexCount / 3u);
  if (draw.firstTriangle > params.triangleCount || end > params.triangleCount - draw.firstTriangle) return true;
  Cluster c = clusters[firstCluster(draw.mesh) + place];
  if (alphaTestOf(draw.flags) > params.alphaTestCount || !seeFrom(draw, e.camera)) return true; // they are counted, too
  return !isOutOfSight(c, draw, viewProjection(e.camera), ivec2(int(params.width), int(params.height)));
}

void main() {
  uint chunks = chunkCount();
  for (uint first = gl_WorkGroupID.x * 256u; first < chunks; first += gl_NumWorkGroups.x * 256u) {
    uint chunk = first + gl_LocalInvocationIndex;
    uint entry = 0u;
    if (chunk < chunks) {
      entry = findEntry(chunk);
      table[chunkAt(chunk)] = entry;
    }
    if (params.clusterCount == 0u) continue;
    if (gl_LocalInvocationIndex == 0u) groupKept = 0u;
    barrier();
    bool kept = chunk < chunks && mayBeInSight(chunk, entry);
    uint place = 0u;
    if (kept) place = atomicAdd(groupKept, 1u);
    barrier();
    if (gl_LocalInvocationIndex == 0u && groupKept != 0u) {
      firstKept = atomicAdd(counters.keptCount, groupKept);
      atomicMax(counters.keptArgs[0], min(firstKept + groupKept, kMaxGroups));
    }
    barrier();
    if (kept) table[keptAt(firstKept + place)] = chunk;
    barrier();
  }
}
