// A workgroup a cluster, an invocation a triangle of it: its box, and the directions in which its triangles face. Once
// a mesh, however many draws there are of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/fetch.glsl"
#define CLUSTER_ACCESS writeonly
#include "visibility/shared/clusters.glsl"
layout(local_size_x = 64) in; // kChunk

shared vec3 lows[64];
shared vec3 highs[64];
shared vec3 normals[64];
shared float spreads[64];
shared float heights[64];
shared uint broken;

/// The mesh that a cluster belongs to: the last one that starts at or before it.
uint findMesh(uint cluster) {
  uint low = 0u;
  uint high = params.meshCount - 1u;
  while (low < high) {
    uint middle = low + (high - low + 1u) / 2u;
    if (firstCluster(middle) <= cluster) low = middle;
    else high = middle - 1u;
  }
  return low;
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  for (uint cluster = gl_WorkGroupID.x; cluster < params.clusterCount; cluster += gl_NumWorkGroups.x) {
    if (lane == 0u) broken = 0u;
    barrier();
    uint mesh = findMesh(cluster);
    DrawEntry e;
    e.firstIndex = meshWords[mesh * 3u];
    e.indexCount = meshWords[mesh * 3u + 1u];
    e.vertexOffset = meshWords[mesh * 3u + 2u];
    uint local = (cluster - firstCluster(mesh)) * kChunk + lane;
    lows[lane] = vec3(1e30f);
    highs[lane] = vec3(-1e30f);
    Facing f = facingOf(vec3(0.0f), vec3(0.0f), vec3(0.0f));
    if (local < e.indexCount / 3u) {
      uint index = e.firstIndex + local * 3u;
      vec3 p0;
      vec3 p1;
      vec3 p2;
      if (fetchVertex(e, index, p0) && fetchVertex(e, index + 1u, p1) && fetchVertex(e, index + 2u, p2)) {
        lows[lane] = min(p0, min(p1, p2));
        highs[lane] = max(p0, max(p1, p2));
        f = facingOf(p0, p1, p2);
      } else {
        broken = 1u;
      }
    }
    normals[lane] = f.normal;
    heights[lane] = f.height;
    barrier();
    for (uint step = 32u; step > 0u; step /= 2u) {
      if (lane < step) {
        lows[lane] = min(lows[lane], lows[lane + step]);
        highs[lane] = max(highs[lane], highs[lane + step]);
        normals[lane] += normals[lane + step];
        heights[lane] = min(heights[lane], heights[lane + step]);
      }
      barrier();
    }
    float size = length(normals[0]);
    vec3 axis = size > 1e-3f ? normals[0] / size : vec3(0.0f);
    spreads[lane] = f.height == kNoHeight ? 1.0f : cosineOf(f, axis);
    barrier();
    for (uint step = 32u; step > 0u; step /= 2u) {
      if (lane < step) spreads[lane] = min(spreads[lane], spreads[lane + step]);
      barrier();
    }
    if (lane == 0u) {
      Cluster c;
      for (int k = 0; k < 3; ++k) {
        c.low[k] = lows[0][k];
        c.high[k] = highs[0][k];
        c.axis[k] = axis[k];
      }
      c.spread = spreads[0];
      c.height = heights[0];
      c.whole = 1u - broken;
      clusters[cluster] = c;
    }
    barrier();
  }
}
