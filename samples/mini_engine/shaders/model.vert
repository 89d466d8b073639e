#version 450
// The glTF model, pulled from the same buffers that gpgp reads. Each triangle knows its number, and so whether gpgp
// found it visible: gl_PrimitiveID would need a feature, the vertex number does not.
struct Draw { // GpgpVisibilityDraw
  vec4 row0, row1, row2;
  uint mesh, firstTriangle, flags, reserved;
};
layout(set = 0, binding = 0, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 1, std430) readonly buffer Normals { float normals[]; };
layout(set = 0, binding = 2, std430) readonly buffer Indices { uint indices[]; };
layout(set = 0, binding = 3, std430) readonly buffer Draws { Draw draws[]; };
layout(set = 0, binding = 4, std430) readonly buffer Visible { uint visibleBits[]; };

layout(push_constant) uniform Push {
  mat4 viewProjection;
  vec4 eye;
  uint draw, firstIndex, vertexOffset, unused;
} push;

layout(location = 0) out vec3 world;
layout(location = 1) out vec3 normal;
layout(location = 2) flat out vec3 colour;

void main() {
  Draw draw = draws[push.draw];
  uint vertex = (push.vertexOffset + indices[push.firstIndex + uint(gl_VertexIndex)]) * 3u;
  vec4 local = vec4(positions[vertex], positions[vertex + 1u], positions[vertex + 2u], 1.0);
  vec3 n = vec3(normals[vertex], normals[vertex + 1u], normals[vertex + 2u]);
  world = vec3(dot(draw.row0, local), dot(draw.row1, local), dot(draw.row2, local));
  normal = vec3(dot(draw.row0.xyz, n), dot(draw.row1.xyz, n), dot(draw.row2.xyz, n));
  uint triangle = draw.firstTriangle + uint(gl_VertexIndex) / 3u;
  bool visible = (visibleBits[triangle >> 5] >> (triangle & 31u) & 1u) != 0u;
  colour = visible ? vec3(0.90, 0.30, 0.02) : vec3(0.10, 0.11, 0.14);
  gl_Position = push.viewProjection * vec4(world, 1.0);
}
