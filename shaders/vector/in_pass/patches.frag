#version 460
// A path's paint, times the part of the pixel that the path covers; or, with several samples, for those samples that
// lie in one of its patches. The quad paints only the pixels and samples that it owns (gpgp/shaders/patch_quads.h).
//
// Pixels within a quad that is inside as a whole read nothing.
#extension GL_GOOGLE_include_directive : require
#include "vector/in_pass/patches.glsl"
layout(constant_id = 0) const uint SAMPLES = 1;
layout(location = 0) flat in uvec4 which; // as in patches.vert
layout(location = 1) flat in uint drawing;
layout(location = 2) flat in vec4 paint;
layout(location = 3) flat in vec4 steps;
layout(location = 4) flat in vec4 middle;
layout(location = 5) flat in vec3 weights;
layout(location = 6) flat in vec4 box;
layout(location = 0) out vec4 color;

void main() {
  const vec2 pixel = gl_FragCoord.xy - header.middle;
  const float w = 1 / (weights.x * pixel.x + weights.y * pixel.y + weights.z);
  precise vec2 at = (steps.xy * pixel.x + steps.zw * pixel.y + middle.xy) * w;
  const vec2 dx = (steps.xy - at * weights.x) * w, dy = (steps.zw - at * weights.y) * w;
  const vec2 reach = gpgpPixelReach(dx, dy), origin = middle.zw;
  const GpgpPatchQuad quad = gpgpUnpackQuad(which);
  const uint slot = (which.w / kPatchQuadFlags) & (kPatchBuffers - 1);
  const bool inside = (which.w & kPatchQuadInside) != 0 && gpgpHoldsPixel(box, at, reach);
  const bool gradient = which.w >= kPatchQuadFlags * kPatchBuffers;
  GpgpPatchPath path;
  if (!inside || gradient) path = gpgpLoadPath(slot, drawing, quad.path);
  float coverage = 1;
  uint mask = (1u << SAMPLES) - 1;
  if (!inside && SAMPLES == 1) {
    if (!gpgpQuadOwns(slot, path, quad, origin, at, reach)) discard;
    coverage = gpgpPathCoverage(slot, path, origin, at, dx, dy);
    if (coverage == 0) discard;
  } else if (!inside) {
    mask = gpgpQuadMask(slot, path, quad, origin, at, dx, dy, SAMPLES);
    if (mask == 0) discard;
  }
  gl_SampleMask[0] = int(mask);
  if (gradient) {
    const vec4 straight =
        gpgpPathColor(slot, drawing, path, at + origin, paint, (header.flags & kPatchEncodeSrgb) != 0);
    color = vec4(straight.rgb * straight.a, straight.a) * coverage;
  } else {
    color = paint * coverage;
  }
}
