#version 460
// A path's paint, times the part of the pixel that the path covers; or, with several samples, for those samples that
// lie in one of its patches.
#extension GL_GOOGLE_include_directive : require
#include "vector/in_pass/patches.glsl"
layout(constant_id = 0) const uint SAMPLES = 1;
layout(location = 0) flat in uvec2 which;
layout(location = 0) out vec4 color;

// Vulkan's standard sample locations, in 1/16 of a pixel from its upper left.
const ivec2 kTwo[2] = {{12, 12}, {4, 4}};
const ivec2 kFour[4] = {{6, 2}, {14, 6}, {2, 10}, {10, 14}};
const ivec2 kEight[8] = {{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}};
const ivec2 kSixteen[16] = {{9, 9}, {7, 5},  {5, 10}, {12, 7}, {3, 6}, {10, 13}, {13, 11}, {11, 3},
                            {6, 14}, {8, 1}, {4, 2},  {2, 12}, {0, 8}, {15, 4},  {14, 15}, {1, 0}};
vec2 sampleAt(uint i) {
  const ivec2 at = SAMPLES == 2   ? kTwo[i & 1]
                   : SAMPLES == 4 ? kFour[i & 3]
                   : SAMPLES == 8 ? kEight[i & 7]
                                  : kSixteen[i];
  return vec2(at) / 16 - 0.5;
}

void main() {
  const PatchPlacement placement = placementOf(which.x);
  const PatchView view = viewOf(placement.view);
  const vec3 stepX = view.inverse0.xyz / header.half_.x, stepY = view.inverse1.xyz / header.half_.y;
  const vec2 pixel = gl_FragCoord.xy - header.middle;
  const vec3 point = stepX * pixel.x + stepY * pixel.y + view.inverse2.xyz;
  // Of the view's space, then of the drawing's: counted from the origin.
  const float scale = 1 / placement.place.z;
  const vec2 at = point.xy / point.z;
  const vec2 dx = (stepX.xy - at * stepX.z) * (scale / point.z), dy = (stepY.xy - at * stepY.z) * (scale / point.z);
  const vec2 origin = (vec2(view.inverse0.w, view.inverse1.w) - placement.place.xy) * scale;
  const GpgpPatchPath path = gpgpLoadPath(placement.slot, placement.drawing, which.y);
  float coverage = 1;
  if (SAMPLES == 1) {
    coverage = gpgpPathCoverage(placement.slot, path, origin, at * scale, dx, dy);
    if (coverage == 0) discard;
    gl_SampleMask[0] = 1;
  } else {
    int mask = 0;
    for (uint i = 0; i < SAMPLES; ++i) {
      const vec2 moved = sampleAt(i);
      const vec3 there = point + stepX * moved.x + stepY * moved.y;
      if (gpgpPatchesAt(placement.slot, path, origin, there.xy / there.z * scale) != 0) mask |= 1 << i;
    }
    if (mask == 0) discard;
    gl_SampleMask[0] = mask;
  }
  const vec4 straight = gpgpPathColor(placement.slot, placement.drawing, path, at * scale + origin, placement.color,
                                      (header.flags & kPatchEncodeSrgb) != 0);
  const float alpha = straight.a * coverage;
  color = vec4(straight.rgb * alpha, alpha);
}
