#version 460
// A path's box as a quad, grown by half a pixel to each side, under any map.
//
// Affine maps: the box is grown on the drawing, and cut to what the viewport shows. Projective ones: each edge is a
// line of clip space, moved outwards by half a pixel; corners are where two lines meet. That holds for corners behind
// the eye as well, whose w is negative: what is cut off there is cut off by the clipper.
#extension GL_GOOGLE_include_directive : require
#include "vector/in_pass/patches.glsl"
layout(location = 0) flat out uvec2 which; // placement, path

vec3 clipOf(PatchView view, vec2 p) {
  return view.column0.xyw * p.x + view.column1.xyw * p.y + view.column2.xyw;
}
float volume(vec3 a, vec3 b, vec3 c) { return dot(cross(a, b), c); }

void main() {
  const uint quad = gl_InstanceIndex;
  uint low = 0, high = header.placements; // the last placement that begins at or before the quad
  while (high - low > 1) {
    const uint middle = (low + high) / 2;
    if (floatBitsToUint(recording[header.firstPlacement + middle * 3 + 2].y) <= quad) low = middle;
    else high = middle;
  }
  const PatchPlacement placement = placementOf(low);
  which = uvec2(low, quad - placement.firstQuad);
  const PatchView view = viewOf(placement.view);
  const uint path = placement.drawing + kPatchHeader + which.y * kPatchPathSize;
  const vec4 own = GPGP_PATCH_FLOAT(placement.slot, path + 1);
  const vec2 origin = vec2(view.inverse0.w, view.inverse1.w), shift = placement.place.xy - origin;
  vec4 box = own * placement.place.z + vec4(shift, shift);
  gl_Position = vec4(0, 0, 0, 1); // a point, which draws nothing
  if (!(own.x < own.z && own.y < own.w) || !(placement.place.z > 0)) return;
  const vec2 half_ = abs(header.half_);
  // 0, 1, 3, 2: a strip
  const uint corner = gl_VertexIndex ^ (gl_VertexIndex >> 1);
  if (view.column0.w == 0 && view.column1.w == 0) {
    const vec2 x = view.inverse0.xy, y = view.inverse1.xy, middle = view.inverse2.xy;
    const vec2 pixel = 0.75 * (abs(x) / half_.x + abs(y) / half_.y), seen = abs(x) + abs(y) + 2 * pixel;
    box += vec4(-pixel, pixel);
    box = vec4(max(box.xy, middle - seen), min(box.zw, middle + seen));
    if (!(box.x < box.z && box.y < box.w)) return;
    const vec2 at = vec2((gl_VertexIndex & 1) != 0 ? box.z : box.x, (gl_VertexIndex & 2) != 0 ? box.w : box.y);
    gl_Position = view.column0 * at.x + view.column1 * at.y + view.column2;
    return;
  }
  // Corners in a round, then the three around this one.
  vec3 corners[4];
  corners[0] = clipOf(view, box.xy);
  corners[1] = clipOf(view, box.zy);
  corners[2] = clipOf(view, box.zw);
  corners[3] = clipOf(view, box.xw);
  const vec3 before = corners[(corner + 3) & 3], at = corners[corner], after = corners[(corner + 1) & 3];
  const float turn = volume(before, at, after), side = turn < 0 ? -1.0 : 1.0;
  vec3 arriving = side * cross(before, at), leaving = side * cross(at, after);
  arriving.z += 0.75 * dot(abs(arriving.xy), 1 / half_);
  leaving.z += 0.75 * dot(abs(leaving.xy), 1 / half_);
  if (turn == 0) return; // seen edge on
  const vec3 grown = cross(arriving, leaving) / turn;
  const vec3 point = view.inverse0.xyz * grown.x + view.inverse1.xyz * grown.y + view.inverse2.xyz * grown.z;
  gl_Position = view.column0 * point.x + view.column1 * point.y + view.column2 * point.z;
}
