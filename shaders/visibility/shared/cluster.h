// Clusters: 64 triangles that follow one another in a mesh, with a box and the directions in which they face. A cluster
// of which no triangle can be drawn is left out before any of them is read.
//
// Guarantees: conservative. Each triangle of a cluster that is out of sight is kOutside or kBackFacing for classify();
// none would be skipped and counted, clipped or drawn. Bounds on what rounding and snapping do are part of each test.
#ifndef GPGP_SHADERS_VISIBILITY_CLUSTER_H
#define GPGP_SHADERS_VISIBILITY_CLUSTER_H
#include "visibility/shared/triangle.h"

GPGP_SHADER_BEGIN

/// In object space.
struct Cluster {
  float low[3];
  float high[3];
  float axis[3]; ///< the middle of the triangles' normals
  float spread;  ///< least cosine between it and a normal; not above 0: faces are not asked for
  float height;  ///< least height of a triangle over its longest edge
  uint whole;    ///< 1: none has an index out of range, or a coordinate that cannot be computed with
};
GPGP_CONST uint kClusterBytes = 48u;

/// Of one triangle.
struct Facing {
  vec3 normal;  ///< of length 1, or 0
  float height; ///< over the longest edge
  float doubt;  ///< by how much the cosine of an angle with the normal may be wrong
};

GPGP_CONST float kNoHeight = 1e30f; ///< of a triangle that two equal corners make a line: it has no area anywhere

GPGP_FN Facing facingOf(vec3 a, vec3 b, vec3 c) {
  Facing f;
  f.normal = vec3(0.0f, 0.0f, 0.0f);
  f.height = kNoHeight;
  f.doubt = 0.0f;
  if (a == b || b == c || c == a) return f;
  vec3 normal = cross(b - a, c - a);
  float area = length(normal);
  float longest = max(length(b - a), max(length(c - b), length(a - c)));
  f.height = 0.0f;
  if (!(area > 1e-30f && longest < 1e15f)) return f;
  f.doubt = longest * longest / area * 9.5367431640625e-7f; // 2^-20: edges and products are rounded
  if (f.doubt > 0.25f) return f;
  f.normal = normal / area;
  f.height = area / longest * 0.75f; // and so is the area, by less than a quarter
  return f;
}

/// The cosine that a triangle adds to its cluster's spread.
GPGP_FN float cosineOf(Facing f, vec3 axis) { return dot(f.normal, axis) - f.doubt - 4e-6f; }

/// A row of the matrix from object space to clip space, from that of the camera.
GPGP_FN vec4 objectRow(vec4 row, vec4 x, vec4 y, vec4 z) {
  return x * row.x + y * row.y + z * row.z + vec4(0.0f, 0.0f, 0.0f, row.w);
}

/// A box by its middle and half of its size.
struct ClusterBox {
  vec3 middle;
  vec3 half_;
};
GPGP_FN vec3 directionOf(vec4 row) { return vec3(row.x, row.y, row.z); }
GPGP_FN float reachOf(vec4 row, ClusterBox box) { return dot(abs(directionOf(row)), box.half_); }
GPGP_FN float mostOf(vec4 row, ClusterBox box) { return dot(directionOf(row), box.middle) + row.w + reachOf(row, box); }
GPGP_FN float leastOf(vec4 row, ClusterBox box) {
  return dot(directionOf(row), box.middle) + row.w - reachOf(row, box);
}

/// By how much a sum is wrong at most, as a share of the sum of its terms' magnitudes. Of a clip coordinate as
/// triangle.h computes it that is 2^-21; here both ways of computing it count.
GPGP_CONST float kSumDoubt = 1.9073486328125e-6f; // 2^-19
GPGP_CONST float kLeastDoubt = 1e-30f;

/// Whether no triangle of the cluster can be drawn, in a viewport of so many pixels.
GPGP_FN bool isOutOfSight(Cluster c, Draw draw, mat4 viewProjection, ivec2 pixels) {
  if (c.whole == 0u) return false;
  vec3 low = vec3(c.low[0], c.low[1], c.low[2]);
  vec3 high = vec3(c.high[0], c.high[1], c.high[2]);
  vec3 most = max(abs(low), abs(high));
  ClusterBox box;
  box.middle = (low + high) * 0.5f;
  box.half_ = (high - low) * 0.5f;
  vec4 x = vec4(draw.transform[0], draw.transform[1], draw.transform[2], draw.transform[3]);
  vec4 y = vec4(draw.transform[4], draw.transform[5], draw.transform[6], draw.transform[7]);
  vec4 z = vec4(draw.transform[8], draw.transform[9], draw.transform[10], draw.transform[11]);
  vec4 rows[4];
  float sizes[4];   // of the coordinate's terms, at most
  float lengths[4]; // of the row's direction, likewise
  for (int r = 0; r < 4; ++r) {
    vec4 row = vec4(viewProjection[0][r], viewProjection[1][r], viewProjection[2][r], viewProjection[3][r]);
    rows[r] = objectRow(row, x, y, z);
    vec4 size = objectRow(abs(row), abs(x), abs(y), abs(z));
    sizes[r] = dot(directionOf(size), most) + size.w;
    lengths[r] = length(directionOf(size));
    if (!(sizes[r] < 1e28f)) return false; // or not a number
  }
  bool inside = true; // of what needsClip() asks
  vec2 across = vec2(0.0f, 0.0f);
  for (int k = 0; k < 2; ++k) {
    float doubt = (sizes[3] + sizes[k]) * kSumDoubt + kLeastDoubt;
    if (mostOf(rows[3] + rows[k], box) + doubt < 0.0f || mostOf(rows[3] - rows[k], box) + doubt < 0.0f) return true;
    vec4 guard = rows[3] * float(kGuard);
    inside = inside && leastOf(guard + rows[k], box) > doubt * 8.0f && leastOf(guard - rows[k], box) > doubt * 8.0f;
    across[k] = max(abs(leastOf(rows[k], box)), abs(mostOf(rows[k], box))) + doubt;
  }
  float depthDoubt = (sizes[3] + sizes[2]) * kSumDoubt + kLeastDoubt;
  vec4 beyond = rows[3] - rows[2];
  if (mostOf(rows[2], box) + depthDoubt < 0.0f || mostOf(beyond, box) + depthDoubt < 0.0f) return true;
  inside = inside && leastOf(rows[2], box) > depthDoubt && leastOf(beyond, box) > depthDoubt;

  // Faces. A triangle of normal n is turned as the sign of n * away(p) says, for any point p of it: away is linear, for
  // perspective cameras the direction from the eye, times a constant.
  float nearest = leastOf(rows[3], box) - sizes[3] * kSumDoubt;
  float farthest = mostOf(rows[3], box) + sizes[3] * kSumDoubt;
  if (!inside || (draw.flags & kTwoSided) != 0u || !(c.spread > 0.0f) || !(nearest > 1e-20f)) return false;
  vec3 crossX = cross(directionOf(rows[1]), directionOf(rows[3]));
  vec3 crossY = cross(directionOf(rows[3]), directionOf(rows[0]));
  vec3 crossW = cross(directionOf(rows[0]), directionOf(rows[1]));
  float turn = dot(directionOf(rows[0]), crossX);
  vec3 away = box.middle * turn + crossX * rows[0].w + crossY * rows[1].w + crossW * rows[3].w;
  float doubt = (lengths[0] * lengths[1] * lengths[3] * length(most) + sizes[0] * lengths[1] * lengths[3] +
                 sizes[1] * lengths[3] * lengths[0] + sizes[3] * lengths[0] * lengths[1]) *
                (kSumDoubt * 4.0f);
  vec3 axis = vec3(c.axis[0], c.axis[1], c.axis[2]) * (turnsFaces(draw) ? -1.0f : 1.0f);
  float along = dot(axis, away);
  // The least n * away of all normals, and points of the box.
  float least = along * c.spread - length(away - axis * along) * sqrt(max(1.0f - c.spread * c.spread, 0.0f)) -
                abs(turn) * (dot(abs(axis), box.half_) + sqrt(2.0f - 2.0f * c.spread) * length(box.half_)) - doubt;
  if (!(least > 0.0f)) return false;

  // Snapping could turn a triangle over that is not higher than its corners move: twice sqrt(2) times `moved`.
  float side = max(across.x, across.y) / nearest; // in half viewports
  vec2 halves = vec2(float(pixels.x), float(pixels.y)) * 128.0f;
  vec2 stretch =
      halves * (vec2(lengths[0], lengths[1]) + vec2(lengths[3], lengths[3]) * side) / nearest; // of an edge, at most
  float height = halves.x * halves.y * c.height * least / (farthest * farthest * farthest * length(stretch));
  float moved =
      0.5f + max(halves.x, halves.y) * 5.3e-7f * ((max(sizes[0], sizes[1]) + side * sizes[3]) / nearest + side + 1.0f);
  return height > moved * 2.9f;
}

#ifdef __cplusplus
static_assert(sizeof(Cluster) == kClusterBytes);
#endif

GPGP_SHADER_END
#endif
