#version 460
// The canvas with its layers, over the background, into what the recording writes. TARGET: as in composite.glsl.
#extension GL_GOOGLE_include_directive : require
#include "vector/layers/layers.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = kBindLayeredHistory, std430) writeonly buffer View { uvec2 view[]; };
#if TARGET == 1
layout(set = 0, binding = kBindImage8, rgba8) uniform writeonly image2D image;
#elif TARGET == 2
layout(set = 0, binding = kBindImage16, rgba16f) uniform writeonly image2D image;
#endif

void main() {
  const OperationRecord o = operations[0];
  const uvec2 pixel = gl_GlobalInvocationID.xy;
  if (pixel.x >= uint(o.result.right) || pixel.y >= uint(o.result.bottom)) return;
  const vec4 own = texelAt(o.result, int(pixel.x), int(pixel.y));
  const vec4 color = own + o.values[0] * (1.0 - own.a); // the background
  if (o.mode != 0) {
    const vec4 linear = (header.flags & kBlendSrgb) != 0 ? convert(color, false) : color;
    view[pixel.y * uint(o.result.right) + pixel.x] = uvec2(packHalf2x16(linear.rg), packHalf2x16(linear.ba));
  }
#if TARGET
  imageStore(image, ivec2(pixel), targetColor(color, header.flags));
#endif
}
