// A row of workgroups a draw: which of its triangles share an edge with their neighbour by number.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/atlas/buffers.glsl"
#include "visibility/shared/layout.h"
layout(local_size_x = 256) in;

layout(std430, set = 0, binding = kAtlasDraws) readonly buffer DrawBuffer { Draw draws[]; };
layout(std430, set = 0, binding = kAtlasMeshes) readonly buffer MeshBuffer { Mesh meshes[]; };
layout(std430, set = 0, binding = kAtlasIndices) readonly buffer IndexBuffer { uint indices[]; };

uint indexAt(uint i) {
  if (params.shortIndices != 0u) return (indices[i >> 1u] >> ((i & 1u) * 16u)) & 0xffffu;
  return indices[i];
}
uvec3 cornersAt(uint i) { return uvec3(indexAt(i), indexAt(i + 1u), indexAt(i + 2u)); }

void main() {
  Draw draw = draws[gl_WorkGroupID.x];
  if (draw.mesh >= params.meshCount || draw.firstTriangle >= params.triangleCount) return;
  Mesh mesh = meshes[draw.mesh];
  if (mesh.firstIndex > params.indexCount) return;
  uint count = min(min(mesh.indexCount, params.indexCount - mesh.firstIndex) / 3u,
                   params.triangleCount - draw.firstTriangle);
  uint skipped = draw.firstTriangle & 1u; // whose neighbour belongs to another draw
  for (uint i = gl_WorkGroupID.y * 256u + gl_LocalInvocationIndex; i < count / 2u; i += gl_NumWorkGroups.y * 256u) {
    uint local = i * 2u + skipped;
    if (local + 1u >= count) break;
    uint index = mesh.firstIndex + local * 3u;
    uint code = pairCode(cornersAt(index), cornersAt(index + 3u));
    uint triangle = draw.firstTriangle + local;
    if (code != 0u) atomicOr(codes[triangle / 16u], code << ((triangle >> 1u) % 8u * 4u));
  }
}
