#version 450
#extension GL_GOOGLE_include_directive : require
// Which triangle is at a pixel: of the viewer's picture, or of the sun's for shadows.
#include "surface.glsl"
layout(push_constant) uniform Push {
  mat4 viewProjection;
  uint draw, firstIndex, vertexOffset;
} push;
layout(location = 0) flat out uint triangle;
layout(location = 1) out vec2 weights;

void main() {
  Draw draw = draws[push.draw];
  uint corner = uint(gl_VertexIndex) % 3u;
  vec3 p = vectorOf(push.vertexOffset + indices[push.firstIndex + uint(gl_VertexIndex)], false);
  gl_Position = push.viewProjection * vec4(placed(draw, p), 1.0);
  triangle = draw.firstTriangle + uint(gl_VertexIndex) / 3u;
  weights = vec2(corner == 0u ? 1.0 : 0.0, corner == 1u ? 1.0 : 0.0);
}
