// A rectangle of the screen.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "piece.glsl"
void main() {
  const vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
  const vec2 pixel = mix(vec2(place.rect.xy), vec2(place.rect.zw), corner);
  gl_Position = vec4(pixel * place.scale - 1.0, 0.0, 1.0);
}
