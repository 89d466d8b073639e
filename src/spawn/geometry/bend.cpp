// A form bent along the texture coordinates of another (CGA's insertAlongUV).
#include "spawn/geometry/internal.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn {

using namespace shader;

namespace {

constexpr double kMostTiles = 1e6;

/// A corner of the asset: its place in the tile, x to the right and y upwards, and its height.
using Corner = glm::dvec3;

double sideOf(glm::dvec2 a, glm::dvec2 b, const Corner& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// What lies left of a line.
std::vector<Corner> clipped(const std::vector<Corner>& polygon, glm::dvec2 a, glm::dvec2 b) {
  std::vector<Corner> result;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Corner &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double hp = sideOf(a, b, p), hq = sideOf(a, b, q);
    if (hp >= 0) result.push_back(p);
    if ((hp > 0 && hq < 0) || (hp < 0 && hq > 0)) result.push_back(p + (q - p) * (hp / (hp - hq)));
  }
  return result;
}

} // namespace

Status insertAlongUv(MeshPool& pool, Form& form, uint32_t set, const Form& asset, float height, BendAlong along,
                     bool keepPosition) {
  if (set >= kMaxUvSets || !std::isfinite(height)) return kGeometryBadArgument;
  Attempt attempt(pool);
  const Bounds bounds = frameBounds(pool, asset);
  const vec3 size = bounds.high - bounds.low;
  if (!(size.x > 0) || !(size.z > 0)) return attempt.end(kGeometryBadArgument);
  Form convex = asset;
  if (const Status status = convexify(pool, convex)) return attempt.end(status);
  // The asset in its tile: x to u, z against v, y to parts of the height.
  std::vector<std::vector<Corner>> polygons;
  for (uint f = 0; f < meshFaces(pool, convex.mesh); ++f) {
    const Loop all = faceCorners(pool, convex.mesh, f);
    std::vector<Corner> polygon;
    for (uint c = all.firstCorner; c < all.firstCorner + all.corners; ++c) {
      const vec3 p = framePosition(pool, convex, c);
      const double y = size.y > 0 ? (p.y - (keepPosition ? 0.0f : bounds.low.y)) / size.y : 0.0;
      polygon.emplace_back((p.x - bounds.low.x) / size.x, (bounds.high.z - p.z) / size.z, y);
    }
    polygons.push_back(std::move(polygon));
  }
  // Normals of places that faces share.
  const std::vector<uint32_t> welded = weldVertices(pool, form);
  std::vector<vec3> normals(welded.size(), vec3(0.0f));
  const std::vector<uint32_t> faceAt = cornerFaces(pool, form.mesh);
  for (uint c = 0; c < faceAt.size(); ++c) {
    vec3& sum = normals[welded[cornerVertex(pool, form.mesh, c)]];
    sum += localNormal(pool, form, faceAt[c]);
  }
  struct Made {
    std::vector<vec3> points;
    uint32_t tags;
  };
  std::vector<Made> made;
  size_t corners = 0;
  for (uint f = 0; f < meshFaces(pool, form.mesh); ++f) {
    const Face face = faceOf(pool, form.mesh, f);
    const Loop all = faceCorners(pool, form.mesh, f);
    if (face.loops != 1 || all.corners > 4) continue;
    for (uint t = 0; t + 2 < all.corners; ++t) {
      const uint at[3] = {all.firstCorner, all.firstCorner + t + 1, all.firstCorner + t + 2};
      glm::dvec2 uv[3];
      glm::dvec3 place[3], up[3];
      for (int i = 0; i < 3; ++i) {
        uv[i] = glm::dvec2(cornerUv(pool, form.mesh, set, at[i]));
        place[i] = glm::dvec3(localPosition(pool, form, at[i]));
        const vec3 n = normals[welded[cornerVertex(pool, form.mesh, at[i])]];
        up[i] = along == BendAlong::ScopeY ? glm::dvec3(0, 1, 0) : glm::dvec3(unit3(n));
      }
      const double area = (uv[1].x - uv[0].x) * (uv[2].y - uv[0].y) - (uv[1].y - uv[0].y) * (uv[2].x - uv[0].x);
      if (area == 0 || !std::isfinite(area)) continue;
      const bool mirrored = area < 0;
      const glm::dvec2 low = glm::floor(glm::min(uv[0], glm::min(uv[1], uv[2])));
      const glm::dvec2 high = glm::ceil(glm::max(uv[0], glm::max(uv[1], uv[2])));
      if ((high.x - low.x) * (high.y - low.y) > kMostTiles) return attempt.end(kGeometryTooLarge);
      for (double v = low.y; v < high.y; v += 1)
        for (double u = low.x; u < high.x; u += 1) {
          if (!countSteps(pool, 4 * polygons.size())) return attempt.end(kGeometryTooLarge);
          for (const std::vector<Corner>& polygon : polygons) {
            std::vector<Corner> left = polygon;
            for (Corner& p : left) p += Corner(u, v, 0);
            for (int i = 0; i < 3 && left.size() >= 3; ++i)
              left = mirrored ? clipped(left, uv[(i + 1) % 3], uv[i]) : clipped(left, uv[i], uv[(i + 1) % 3]);
            if (left.size() < 3) continue;
            Made one{{}, face.tags};
            for (const Corner& p : left) {
              const double b = ((p.x - uv[0].x) * (uv[2].y - uv[0].y) - (p.y - uv[0].y) * (uv[2].x - uv[0].x)) / area;
              const double c = ((uv[1].x - uv[0].x) * (p.y - uv[0].y) - (uv[1].y - uv[0].y) * (p.x - uv[0].x)) / area;
              const double a = 1 - b - c;
              const glm::dvec3 direction = up[0] * a + up[1] * b + up[2] * c;
              const double length = glm::length(direction);
              const glm::dvec3 base = place[0] * a + place[1] * b + place[2] * c;
              one.points.emplace_back(base + direction * (length > 0 ? p.z * height / length : 0.0));
            }
            if (mirrored != (height < 0)) std::reverse(one.points.begin(), one.points.end());
            // Clipping leaves slivers along the edges that faces share.
            vec3 sum(0.0f);
            for (size_t i = 1; i + 1 < one.points.size(); ++i)
              sum += glm::cross(one.points[i] - one.points[0], one.points[i + 1] - one.points[0]);
            if (!(glm::length(sum) > 1e-12f)) continue;
            corners += one.points.size();
            made.push_back(std::move(one));
          }
        }
    }
  }
  if (corners > (1u << 24)) return attempt.end(kGeometryTooLarge);
  Builder b = newBuilder(pool, uint(corners), uint(corners), uint(made.size()), uint(made.size()), 0);
  for (const Made& one : made) {
    beginFace(pool, b, one.tags);
    beginLoop(pool, b);
    for (const vec3& p : one.points) addCorner(pool, b, addVertex(pool, b, p), 0);
  }
  Form bent{form.scope, vec3(1.0f), 0};
  const Status status = finishForm(pool, b, bent, true);
  if (status <= kGeometryEmpty) form = bent;
  return attempt.end(status);
}

} // namespace gpgp::spawn
