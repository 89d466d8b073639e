// What the canvas has for this pixel, in the piece's layer; blended as premultiplied colour.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "piece.glsl"
layout(set = 0, binding = 0) uniform sampler2D canvas;
layout(location = 0) out vec4 color;
void main() { color = texelFetch(canvas, ivec2(gl_FragCoord.xy) + ivec2(0, place.down), 0); }
