#version 460
// A rectangle of canvas pixels, placed by a matrix.
#extension GL_GOOGLE_include_directive : require
#include "vector/raster/draw.glsl"
layout(location = 0) out vec2 at;

void main() {
  at = vec2((gl_VertexIndex & 1) != 0 ? size.x : 0, (gl_VertexIndex & 2) != 0 ? size.y : 0);
  const uint first = DRAWN_VIEW * 3;
  gl_Position = columns[first] * at.x + columns[first + 1] * at.y + columns[first + 2];
}
