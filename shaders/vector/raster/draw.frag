#version 460
// The canvas pixel under the fragment, premultiplied.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/color.h"
layout(set = 0, binding = kBindHistory, std430) readonly buffer View { uvec2 view[]; };
#include "vector/raster/draw.glsl"
layout(location = 0) in vec2 at;
layout(location = 0) out vec4 color;

void main() {
  const uvec2 pixel = min(uvec2(max(at, vec2(0))), size.xy - 1);
  const uvec2 packed = view[pixel.y * size.z + pixel.x + begins[DRAWN_VIEW]];
  const vec4 linear = vec4(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y));
  color = encode != 0 ? convert(linear, true) : linear;
}
