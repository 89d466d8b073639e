#version 460
// A path's box or some of its cells as a quad, grown to each side by what coverage reaches, under any map.
//
// Affine maps: the box is grown on the drawing, and cut to what the viewport shows. Projective ones: each edge is a
// line of clip space, moved outwards; corners are where two lines meet. That holds for corners behind the eye as well,
// whose w is negative: what is cut off there is cut off by the clipper.
//
// All quads of a path compute the same map from pixels to the drawing, and so agree about which of them owns a pixel.
#extension GL_GOOGLE_include_directive : require
#include "vector/in_pass/patches.glsl"
layout(constant_id = 0) const uint SAMPLES = 1;
layout(location = 0) flat out uvec4 which;  // path; cells; flags and slot
layout(location = 1) flat out uint drawing;
layout(location = 2) flat out vec4 paint;   // premultiplied; of a gradient: what multiplies it
layout(location = 3) flat out vec4 steps;   // how far the point moves to the next pixel, times w'
layout(location = 4) flat out vec4 middle;  // the point that the viewport's middle shows, times w'; the origin
layout(location = 5) flat out vec3 weights; // w': of the steps, and of the middle
layout(location = 6) flat out vec4 box;     // of the quad, from the origin

vec3 clipOf(PatchView view, vec2 p) {
  return view.column0.xyw * p.x + view.column1.xyw * p.y + view.column2.xyw;
}
float volume(vec3 a, vec3 b, vec3 c) { return dot(cross(a, b), c); }

/// How far a pixel spreads on the view's plane, at most, over a box that lies in front of the eye; else very far.
vec2 largestSpread(PatchView view, vec4 over, vec2 half_) {
  vec2 spread = vec2(0);
  float w = 0, nearest = 1;
  for (uint i = 0; i < 4; ++i) {
    const vec2 p = vec2((i & 1) != 0 ? over.z : over.x, (i & 2) != 0 ? over.w : over.y);
    const float own = view.column0.w * p.x + view.column1.w * p.y + view.column2.w;
    w = max(w, own);
    nearest = min(nearest, own);
    spread = max(spread, abs(view.inverse0.xy - p * view.inverse0.z) / half_.x +
                             abs(view.inverse1.xy - p * view.inverse1.z) / half_.y);
  }
  return nearest > 0 ? spread * w : vec2(1e30);
}

void main() {
  gl_Position = vec4(0, 0, 0, 1); // a point, which draws nothing
  // One strip of all quads, six vertices each: the first and the last come twice, which leaves nothing between quads.
  const uint number = gl_VertexIndex / 6, vertex = uint(clamp(int(gl_VertexIndex % 6) - 1, 0, 3));
  uint low = 0, high = header.placements; // the last placement that begins at or before the quad
  while (high - low > 1) {
    const uint half_ = (low + high) / 2;
    if (floatBitsToUint(recording[header.firstPlacement + half_ * 3 + 2].y) <= number) low = half_;
    else high = half_;
  }
  const PatchPlacement placement = placementOf(low);
  const PatchView view = viewOf(placement.view);
  const bool coarse = (placement.slot & kPatchCoarse) != 0;
  const uint slot = placement.slot & (kPatchCoarse - 1), index = number - placement.firstQuad;
  drawing = placement.drawing;
  GpgpPatchQuad quad;
  GpgpPatchPath path;
  if (coarse) {
    path = gpgpLoadPath(slot, drawing, index);
    quad = gpgpWholeQuad(slot, path, index);
  } else {
    quad = gpgpUnpackQuad(GPGP_PATCH_LOAD(slot, drawing + GPGP_PATCH_LOAD(slot, drawing + 1).x + index));
    path = gpgpLoadPath(slot, drawing, quad.path);
  }
  const float size = placement.place.z, scale = 1 / size;
  if (!(path.box.x < path.box.z && path.box.y < path.box.w) || !(size > 0)) return;
  const vec2 origin = (vec2(view.inverse0.w, view.inverse1.w) - placement.place.xy) * scale;
  const vec2 half_ = abs(header.half_);
  const bool affine = view.column0.w == 0 && view.column1.w == 0;
  const vec2 across = view.inverse0.xy / header.half_.x, down = view.inverse1.xy / header.half_.y;
  if (!coarse) {
    const vec4 all = size * (path.box - origin.xyxy);
    const vec2 spread = affine ? abs(across) + abs(down) : largestSpread(view, all, half_);
    const bool whole = (quad.flags & kPatchQuadWhole) != 0;
    if (gpgpShowsCells(path, spread * scale) == whole) return;
  }
  const uvec4 open = uvec4(kPatchQuadLeft, kPatchQuadTop, kPatchQuadRight, kPatchQuadBottom) & quad.flags;
  const vec4 grown = SAMPLES == 1 ? mix(vec4(kPatchOverlap), vec4(kPatchGrown), notEqual(open, uvec4(0)))
                                  : vec4(kPatchOverlap);
  box = gpgpQuadBox(path, quad, origin);
  vec4 shown = box * size;
  if (affine) {
    const vec2 pixel = abs(across) + abs(down), center = view.inverse2.xy;
    const vec2 seen = abs(view.inverse0.xy) + abs(view.inverse1.xy) + 2 * pixel;
    shown += vec4(-grown.xy * pixel, grown.zw * pixel);
    shown = vec4(max(shown.xy, center - seen), min(shown.zw, center + seen));
    if (!(shown.x < shown.z && shown.y < shown.w)) return;
    const vec2 at = vec2((vertex & 1) != 0 ? shown.z : shown.x, (vertex & 2) != 0 ? shown.w : shown.y);
    gl_Position = view.column0 * at.x + view.column1 * at.y + view.column2;
  } else {
    // Corners in a round, then the three around this one. Edges arrive at the corner behind them.
    const vec3 corners[4] = {clipOf(view, shown.xy), clipOf(view, shown.zy), clipOf(view, shown.zw),
                             clipOf(view, shown.xw)};
    const float edges[4] = {grown.y, grown.z, grown.w, grown.x};
    const uint corner = vertex ^ (vertex >> 1); // 0, 1, 3, 2: a strip
    const vec3 before = corners[(corner + 3) & 3], at = corners[corner], after = corners[(corner + 1) & 3];
    const float turn = volume(before, at, after), side = turn < 0 ? -1.0 : 1.0;
    if (turn == 0) return; // seen edge on
    vec3 arriving = side * cross(before, at), leaving = side * cross(at, after);
    arriving.z += edges[(corner + 3) & 3] * dot(abs(arriving.xy), 1 / half_);
    leaving.z += edges[corner] * dot(abs(leaving.xy), 1 / half_);
    const vec3 moved = cross(arriving, leaving) / turn;
    const vec3 point = view.inverse0.xyz * moved.x + view.inverse1.xyz * moved.y + view.inverse2.xyz * moved.z;
    gl_Position = view.column0 * point.x + view.column1 * point.y + view.column2 * point.z;
  }
  const bool gradient = path.paint != 0;
  which = uvec4(quad.path, quad.column0 | quad.row0 << 16, quad.column1 | quad.row1 << 16,
                quad.flags | slot * kPatchQuadFlags | (gradient ? kPatchQuadFlags * kPatchBuffers : 0));
  steps = vec4(across, down) * scale;
  middle = vec4(view.inverse2.xy * scale, origin);
  weights = vec3(view.inverse0.z / header.half_.x, view.inverse1.z / header.half_.y, view.inverse2.z);
  paint = placement.color;
  if (!gradient) {
    const vec4 straight =
        gpgpPathColor(slot, drawing, path, origin, placement.color, (header.flags & kPatchEncodeSrgb) != 0);
    paint = vec4(straight.rgb * straight.a, straight.a);
  }
}
