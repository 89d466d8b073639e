// Where a triangle's points lie on its texture: for alpha tests.
//
// Texture coordinates divided by w, and 1 / w, are planes over the screen, up to a common factor. They are made from
// the clip coordinates of the whole triangle (M. Olano, T. Greer: Triangle Scan Conversion using 2D Homogeneous
// Coordinates, 1997), so they hold for the pieces of a clipped one, too.
//
// Guarantees: one result on every device. What a device's sampler makes of it is its own.
#ifndef GPGP_SHADERS_VISIBILITY_TEXTURE_H
#define GPGP_SHADERS_VISIBILITY_TEXTURE_H
#include "visibility/shared/raster.h"

GPGP_SHADER_BEGIN

/// At `origin`, and how they change from unit to unit (256 a pixel) along x and y.
struct TexturePlane {
  ivec2 origin;
  vec3 u;
  vec3 v;
  vec3 w;
};

/// A corner in units from the origin, times w; and w.
GPGP_FN vec3 cornerFrom(vec4 c, ivec2 origin, Grid grid) {
  float halfX = float(grid.pixels.x * 128);
  float halfY = float(grid.pixels.y * 128);
  GPGP_PRECISE float x = halfX * c.x - (float(origin.x) - halfX) * c.w;
  GPGP_PRECISE float y = halfY * c.y - (float(origin.y - grid.top * 256) - halfY) * c.w;
  return vec3(x, y, c.w);
}

/// What one corner weighs, opposite the edge from p to q.
GPGP_FN vec3 weightPlane(vec3 p, vec3 q) {
  GPGP_PRECISE float atOrigin = p.x * q.y - q.x * p.y;
  GPGP_PRECISE float alongX = q.z * p.y - p.z * q.y;
  GPGP_PRECISE float alongY = q.x * p.z - p.x * q.z;
  return vec3(atOrigin, alongX, alongY);
}

GPGP_FN vec3 weighted(vec3 a, vec3 b, vec3 c, float ta, float tb, float tc) {
  GPGP_PRECISE float atOrigin = a.x * ta + b.x * tb + c.x * tc;
  GPGP_PRECISE float alongX = a.y * ta + b.y * tb + c.y * tc;
  GPGP_PRECISE float alongY = a.z * ta + b.z * tb + c.z * tc;
  return vec3(atOrigin, alongX, alongY);
}

/// Of corners in clip space with their texture coordinates. origin: a point near the triangle.
GPGP_FN TexturePlane texturePlaneOf(vec4 a, vec4 b, vec4 c, vec2 ta, vec2 tb, vec2 tc, ivec2 origin, Grid grid) {
  vec3 p = cornerFrom(a, origin, grid);
  vec3 q = cornerFrom(b, origin, grid);
  vec3 r = cornerFrom(c, origin, grid);
  vec3 wa = weightPlane(q, r);
  vec3 wb = weightPlane(r, p);
  vec3 wc = weightPlane(p, q);
  TexturePlane plane;
  plane.origin = origin;
  plane.u = weighted(wa, wb, wc, ta.x, tb.x, tc.x);
  plane.v = weighted(wa, wb, wc, ta.y, tb.y, tc.y);
  plane.w = weighted(wa, wb, wc, 1.0f, 1.0f, 1.0f);
  return plane;
}

/// False where the triangle is seen from its side, so that no place is its own.
GPGP_FN bool texturePlace(TexturePlane plane, ivec2 point, GPGP_OUT(vec2) place) {
  float dx = float(point.x - plane.origin.x);
  float dy = float(point.y - plane.origin.y);
  GPGP_PRECISE float u = plane.u.x + plane.u.y * dx + plane.u.z * dy;
  GPGP_PRECISE float v = plane.v.x + plane.v.y * dx + plane.v.z * dy;
  GPGP_PRECISE float w = plane.w.x + plane.w.y * dx + plane.w.z * dy;
  place = vec2(0.0f, 0.0f);
  if (!isDivisor(abs(w))) return false;
  float inverse = w < 0.0f ? -reciprocal(-w) : reciprocal(w);
  GPGP_PRECISE float x = u * inverse;
  GPGP_PRECISE float y = v * inverse;
  place = vec2(x, y);
  return isModerate(x) && isModerate(y);
}

GPGP_SHADER_END
#endif
