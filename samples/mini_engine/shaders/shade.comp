#version 450
#extension GL_GOOGLE_include_directive : require
// Object-space shading: the triangles that gpgp listed as visible, and no others, are lit into a record each.
// Dispatched with gpgp's own arguments: a workgroup per 64 triangles, in rows of 65535.
#include "common.glsl"
#include "shaded.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 4, std430) readonly buffer Meshes { uint meshes[]; }; // GpgpMesh
layout(set = 0, binding = 5, std430) buffer Records { Record records[]; };
layout(set = 0, binding = 6, std430) readonly buffer List { uint visibleList[]; };
layout(set = 0, binding = 7, std430) readonly buffer Count { uint visibleCount[]; };

layout(push_constant) uniform Push {
  vec4 eye; // the shading's, not the display's
  uint drawCount, shading;
} push;

void main() {
  uint i = (gl_WorkGroupID.y * 65535u + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
  if (i >= min(visibleCount[0], uint(visibleList.length()))) return;
  uint triangle = visibleList[i];
  uint first = 0u, last = push.drawCount - 1u; // draws lie in the order of their triangles' numbers
  while (first < last) {
    uint middle = (first + last + 1u) / 2u;
    if (draws[middle].firstTriangle <= triangle) first = middle;
    else last = middle - 1u;
  }
  Draw draw = draws[first];
  for (uint c = 0u; c < 3u; ++c) {
    uint index = meshes[draw.mesh * 3u] + (triangle - draw.firstTriangle) * 3u + c;
    Vertex v = vertexOf(draw, meshes[draw.mesh * 3u + 2u] + indices[index]);
    vec3 colour = haze(lit(vec3(0.90, 0.30, 0.02), v.world, v.normal, push.eye.xyz, 0.35), push.eye.xyz, v.world);
    records[triangle].corners[c] = uvec2(packHalf2x16(colour.rg), packHalf2x16(vec2(colour.b, 1.0)));
  }
  records[triangle].shading = push.shading;
}
