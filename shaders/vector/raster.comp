#version 460
// The fine level: a tile's entries, bottom to top, over the samples of its pixels.
//
// A thread owns up to four samples of a pixel; four threads share a pixel at 16 samples, two at 8. The masks of a
// path's patches are joined before its colour is applied, and every sample keeps its own colour, so neither cuts inside
// a path nor edges shared by two paths let the background through.
// TARGET: 0 the view alone, 1 an rgba8 image, 2 an rgba16f image (and the view, if one is given).
#extension GL_GOOGLE_include_directive : require
#include "canvas.glsl"
layout(local_size_x = 256) in;
layout(set = 0, binding = 8, std430) writeonly buffer View { uvec2 view[]; };
#if TARGET == 1
layout(set = 0, binding = 9, rgba8) uniform writeonly image2D image;
#elif TARGET == 2
layout(set = 0, binding = 10, rgba16f) uniform writeonly image2D image;
#endif
shared vec4 partial[256];

vec4 encode(vec4 color) { // straight colour to sRGB, premultiplied again
  if (color.a <= 0) return color;
  const vec3 straight = clamp(color.rgb / color.a, 0.0, 1.0);
  const vec3 low = straight * 12.92, high = 1.055 * pow(straight, vec3(1.0 / 2.4)) - 0.055;
  return vec4(mix(high, low, lessThanEqual(straight, vec3(0.0031308))) * color.a, color.a);
}

void main() {
  const uint lane = gl_LocalInvocationIndex;
  const uint n = header.samples;
  const uint sharing = max(n / 4, 1), count = min(n, 4);
  const uint pixelIndex = lane / sharing, first = (lane % sharing) * 4;
  uvec2 pixel = gl_WorkGroupID.xy * kTileSize;
  if (sharing == 4)
    pixel += uvec2(pixelIndex % 8 + 8 * (gl_WorkGroupID.z % 2), pixelIndex / 8 + 8 * (gl_WorkGroupID.z / 2));
  else
    pixel += uvec2(pixelIndex % 16, pixelIndex / 16 + 8 * gl_WorkGroupID.z);
  const uvec4 tile = tiles[gl_WorkGroupID.y * header.tilesX + gl_WorkGroupID.x];
  vec4 color[4] = vec4[4](header.background, header.background, header.background, header.background);
  uint path = ~0u, mask = 0;
  for (uint e = 0; e <= tile.y; ++e) {
    const bool end = e == tile.y;
    const uint entry = end ? 0 : entries[tile.x + e];
    const uint index = entry & kEntryPatch;
    const uint nextPath = end ? ~0u : patches[index].path;
    if (nextPath != path) {
      if (mask != 0) {
        const vec4 source = paths[path].color;
        const float keep = 1.0 - source.a;
        if ((mask & 1) != 0) color[0] = source + color[0] * keep;
        if ((mask & 2) != 0) color[1] = source + color[1] * keep;
        if ((mask & 4) != 0) color[2] = source + color[2] * keep;
        if ((mask & 8) != 0) color[3] = source + color[3] * keep;
      }
      path = nextPath;
      mask = 0;
    }
    if (end || mask == (1u << count) - 1) continue;
    const uint flags = entry & ~kEntryPatch;
    if (flags == 0)
      mask = (1u << count) - 1;
    else {
      const PatchRecord p = patches[index];
      const ItemRecord item = items[p.item];
      if (!mayTouch(item, p, pixel.x, pixel.y)) continue;
      const CurveRecord l = curves[p.left], r = curves[p.right];
      // Written out for the same reason as the halvings of curve.h.
      mask |= uint(sampleInside(item, p, l, r, pixel.x, pixel.y, first, n, flags));
      if (count == 4) {
        mask |= uint(sampleInside(item, p, l, r, pixel.x, pixel.y, first + 1, n, flags)) << 1;
        mask |= uint(sampleInside(item, p, l, r, pixel.x, pixel.y, first + 2, n, flags)) << 2;
        mask |= uint(sampleInside(item, p, l, r, pixel.x, pixel.y, first + 3, n, flags)) << 3;
      }
    }
  }
  vec4 sum = color[0];
  for (uint i = 1; i < count; ++i) sum += color[i];
  partial[lane] = sum;
  barrier();
  if (first != 0 || pixel.x >= header.width || pixel.y >= header.height) return;
  for (uint i = 1; i < sharing; ++i) sum += partial[lane + i];
  sum /= float(n);
  if ((header.flags & kWriteView) != 0)
    view[pixel.y * header.width + pixel.x] = uvec2(packHalf2x16(sum.rg), packHalf2x16(sum.ba));
#if TARGET
  imageStore(image, ivec2(pixel), (header.flags & kEncodeSrgb) != 0 ? encode(sum) : sum);
#endif
}
