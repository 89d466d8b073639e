#version 460
// A rectangle of canvas pixels, placed by a matrix.
layout(push_constant) uniform Draw {
  mat4 clip;
  uvec4 size; // width, height, row stride
};
layout(location = 0) out vec2 at;

void main() {
  at = vec2((gl_VertexIndex & 1) != 0 ? size.x : 0, (gl_VertexIndex & 2) != 0 ? size.y : 0);
  gl_Position = clip * vec4(at, 0, 1);
}
