// Volumes above faces, rectangles within them, and random points on and in forms.
#include "core/random.h"
#include "spawn/geometry/waves.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn {

using namespace shader;

Status envelope(MeshPool& pool, Form& form, const Envelope& shape) {
  if (!(shape.maxHeight > 0) || !std::isfinite(shape.maxHeight)) return kGeometryBadArgument;
  for (int i = 0; i < 4; ++i) {
    if (!(shape.baseHeight[i] >= 0) || !(shape.angle[i] > 0) || shape.angle[i] > 90) return kGeometryBadArgument;
  }
  Attempt attempt(pool);
  if (form.mesh == 0) return attempt.end(kGeometryEmpty);
  const Axes axes = axesOf(form.scope);
  std::vector<Form> volumes;
  for (uint f = 0; f < meshFaces(pool, form.mesh); ++f) {
    Form volume{};
    Status status = toComponents(pool, form, Component::Faces, {{f}}, volume);
    if (status) return attempt.end(status);
    const Form base = volume;
    const vec3 normal = localNormal(pool, base, 0);
    status = extrude(pool, volume, Extrusion::FaceNormal, shape.maxHeight);
    const Loop outer = loopOf(pool, base.mesh, faceOf(pool, base.mesh, 0).firstLoop);
    const Components edges(pool, base, Component::FaceEdges);
    for (uint c = outer.firstCorner; c < outer.firstCorner + outer.corners && !status; ++c) {
      int side = -1;
      const Selector sides[4] = {Selector::Front, Selector::Right, Selector::Back, Selector::Left};
      for (int i = 0; i < 4; ++i) {
        if (side < 0 && edges.matches(c, sides[i], axes)) side = i;
      }
      if (side < 0 || shape.angle[side] >= 90) continue;
      const vec3 from = localPosition(pool, base, c);
      const vec3 in = unit3(outer3(normal, localPosition(pool, base, nextCorner(outer, c)) - from));
      const vec2 sc = sineCosineDegrees(shape.angle[side]);
      // sine * distance - cosine * (height - base) >= 0
      const vec3 plane = minus3(times3(in, sc.x), times3(normal, sc.y));
      const vec3 start = along3(from, normal, shape.baseHeight[side]);
      const vec3 frameNormal = scopeDirection(base.scope, plane);
      status = trim(pool, volume, frameNormal, inner3(frameNormal, scopePoint(base.scope, start)), true);
    }
    if (status > kGeometryEmpty) return attempt.end(status);
    if (volume.mesh != 0) volumes.push_back(volume);
  }
  if (volumes.empty()) return attempt.end(kGeometryEmpty);
  Form made{};
  Status status = combine(pool, volumes, made);
  if (status <= kGeometryEmpty) form = made;
  return attempt.end(status);
}

namespace {

struct Rectangle {
  double x0, y0, x1, y1;
  double area() const { return std::max(x1 - x0, 0.0) * std::max(y1 - y0, 0.0); }
};

/// A polygon of loops turned so that the rectangle's sides are along x and y.
struct Region {
  std::vector<std::vector<glm::dvec2>> loops;

  bool contains(glm::dvec2 p) const {
    bool isInside = false;
    for (const auto& loop : loops) {
      for (size_t i = 0; i < loop.size(); ++i) {
        const glm::dvec2 a = loop[i], b = loop[(i + 1) % loop.size()];
        if ((a.y > p.y) == (b.y > p.y)) continue;
        if (a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x) isInside = !isInside;
      }
    }
    return isInside;
  }
  /// No edge within, but for a slack, and the middle inside.
  bool holds(const Rectangle& r, double slack) const {
    for (const auto& loop : loops) {
      for (size_t i = 0; i < loop.size(); ++i) {
        const glm::dvec2 a = loop[i], d = loop[(i + 1) % loop.size()] - a;
        // Liang, Barsky 1984
        double from = 0, to = 1;
        const double p[4] = {-d.x, d.x, -d.y, d.y};
        const double q[4] = {a.x - r.x0 - slack, r.x1 - slack - a.x, a.y - r.y0 - slack, r.y1 - slack - a.y};
        bool outside = false;
        for (int k = 0; k < 4; ++k) {
          if (p[k] == 0) {
            outside = outside || q[k] <= 0;
          } else if (p[k] < 0) {
            from = std::max(from, q[k] / p[k]);
          } else {
            to = std::min(to, q[k] / p[k]);
          }
        }
        if (!outside && from < to) return false;
      }
    }
    return contains({(r.x0 + r.x1) / 2, (r.y0 + r.y1) / 2});
  }
};

/// From cells of a grid that are inside, the largest rectangle of those; then each side as far out as it goes.
Rectangle largestRectangle(const Region& region, double extent) {
  std::vector<double> xs, ys;
  glm::dvec2 low(1e300), high(-1e300);
  for (const auto& loop : region.loops) {
    for (const glm::dvec2 p : loop) {
      xs.push_back(p.x);
      ys.push_back(p.y);
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  }
  constexpr int kSteps = 24;
  for (int i = 1; i < kSteps; ++i) {
    xs.push_back(low.x + (high.x - low.x) * i / kSteps);
    ys.push_back(low.y + (high.y - low.y) * i / kSteps);
  }
  const auto tidy = [&](std::vector<double>& v) {
    std::sort(v.begin(), v.end());
    v.erase(std::unique(v.begin(), v.end(), [&](double a, double b) { return b - a < 1e-6 * extent; }), v.end());
    // Outlines of many corners: enough of them.
    while (v.size() > 160) {
      std::vector<double> half;
      for (size_t i = 0; i < v.size(); i += 2) {
        half.push_back(v[i]);
      }
      if (half.back() != v.back()) half.push_back(v.back());
      v = half;
    }
  };
  tidy(xs);
  tidy(ys);
  const double slack = 1e-7 * extent;
  Rectangle best{};
  std::vector<size_t> below(xs.size() - 1, 0); // how many rows of cells down to here are inside
  for (size_t y = 0; y + 1 < ys.size(); ++y) {
    for (size_t x = 0; x + 1 < xs.size(); ++x) {
      below[x] = region.holds({xs[x], ys[y], xs[x + 1], ys[y + 1]}, slack) ? below[x] + 1 : 0;
    }
    for (size_t x = 0; x < below.size(); ++x) {
      size_t height = below[x];
      for (size_t to = x; to < below.size() && below[to] > 0; ++to) {
        height = std::min(height, below[to]);
        const Rectangle r{xs[x], ys[y + 1 - height], xs[to + 1], ys[y + 1]};
        if (r.area() > best.area()) best = r;
      }
    }
  }
  if (best.area() > 0)
    for (int side = 0; side < 4; ++side) {
      double step = extent / kSteps;
      for (int i = 0; i < 24; ++i, step *= 0.5) {
        Rectangle r = best;
        (side == 0 ? r.x0 : side == 1 ? r.y0 : side == 2 ? r.x1 : r.y1) += side < 2 ? -step : step;
        if (region.holds(r, slack)) best = r;
      }
    }
  return best;
}

} // namespace

Status innerRectangle(MeshPool& pool, const Form& form, bool alongScope, Form& rectangle) {
  Attempt attempt(pool);
  const uint faces = meshFaces(pool, form.mesh);
  if (faces == 0) return attempt.end(kGeometryEmpty);
  Form made = form;
  Builder b = newBuilder(pool, 4 * faces, 4 * faces, faces, faces, 0);
  for (uint f = 0; f < faces; ++f) {
    const Face face = faceOf(pool, form.mesh, f);
    const Loop outer = loopOf(pool, form.mesh, face.firstLoop);
    const vec3 normal = localNormal(pool, form, f);
    vec3 along(1, 0, 0);
    float longest = -1;
    for (uint c = outer.firstCorner; c < outer.firstCorner + outer.corners && !alongScope; ++c) {
      const vec3 d = localPosition(pool, form, nextCorner(outer, c)) - localPosition(pool, form, c);
      const float length = length3(d);
      if (length <= longest * 1.00001f) continue;
      longest = length;
      along = d;
    }
    const PlaneBasis basis = planeBasis(localPosition(pool, form, outer.firstCorner), normal, along);
    Region region;
    double extent = 0;
    for (uint l = 0; l < face.loops; ++l) {
      const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
      std::vector<glm::dvec2> points;
      for (uint c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
        points.emplace_back(inPlane(basis, localPosition(pool, form, c)));
        extent = std::max({extent, std::fabs(points.back().x), std::fabs(points.back().y)});
      }
      region.loops.push_back(std::move(points));
    }
    // At most 160 by 160 cells, each against all edges.
    const uint64_t edges = faceCorners(pool, form.mesh, f).corners, cells = std::min<uint64_t>(edges + 24, 160);
    if (!countSteps(pool, cells * cells * edges)) return attempt.end(kGeometryTooLarge);
    const Rectangle r = largestRectangle(region, extent);
    if (!(r.area() > 0)) continue;
    beginFace(pool, b, face.tags);
    beginLoop(pool, b);
    for (const glm::dvec2 p :
         {glm::dvec2(r.x0, r.y0), glm::dvec2(r.x1, r.y0), glm::dvec2(r.x1, r.y1), glm::dvec2(r.x0, r.y1)}) {
      addCorner(pool, b, addVertex(pool, b, fromPlane(basis, vec2(float(p.x), float(p.y)), 0.0f)), 0);
    }
  }
  const Status status = finishForm(pool, b, made, true);
  if (status == kGeometryEmpty) made.mesh = 0;
  if (status <= kGeometryEmpty) rectangle = made;
  return attempt.end(status);
}

namespace {

/// Numbers of a stream that a key and an index name.
struct Draws {
  uvec2 key;
  uint next = 0;
  float unit() { return drawnNumber(key, next++); }
  /// Of mean 0 and deviation 1, within 6: sums of twelve (no logarithm, which devices disagree about).
  float normal() {
    float sum = -6.0f;
    for (int i = 0; i < 12; ++i) {
      sum = add(sum, unit());
    }
    return sum;
  }
};

struct SurfacePoint {
  vec3 position, normal;
};

/// Triangles of a form with the sums of their areas, in the scope's metres.
struct Surface {
  std::vector<vec3> corners;
  std::vector<vec3> normals;
  std::vector<double> sums;

  Status make(MeshPool& pool, const Form& form) {
    std::vector<uint32_t> triangles;
    for (uint f = 0; f < meshFaces(pool, form.mesh); ++f) {
      triangles.clear();
      if (const Status status = triangulateFace(pool, form, f, triangles)) return status;
      const vec3 normal = localNormal(pool, form, f);
      for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
        for (int k = 0; k < 3; ++k) {
          corners.push_back(localPosition(pool, form, triangles[i + size_t(k)]));
        }
        const size_t n = corners.size();
        const double area =
            0.5 * double(length3(outer3(corners[n - 2] - corners[n - 3], corners[n - 1] - corners[n - 3])));
        normals.push_back(normal);
        sums.push_back((sums.empty() ? 0.0 : sums.back()) + area);
      }
    }
    return sums.empty() || !(sums.back() > 0) ? kGeometryEmpty : kGeometryOk;
  }
  SurfacePoint draw(Draws& draws) const {
    const double at = double(draws.unit()) * sums.back();
    const size_t t = std::min(size_t(std::upper_bound(sums.begin(), sums.end(), at) - sums.begin()), sums.size() - 1);
    float a = draws.unit(), b = draws.unit();
    if (add(a, b) > 1.0f) {
      a = subtract(1.0f, a);
      b = subtract(1.0f, b);
    }
    const vec3 origin = corners[3 * t];
    return {along3(along3(origin, corners[3 * t + 1] - origin, a), corners[3 * t + 2] - origin, b), normals[t]};
  }
  /// By the crossings of a ray in a direction that no wall of a building has.
  bool contains(vec3 p) const {
    const glm::dvec3 ray(0.267261, 0.534522, 0.801784);
    bool isInside = false;
    for (size_t t = 0; t < sums.size(); ++t) {
      const glm::dvec3 a(corners[3 * t] - p), b(corners[3 * t + 1] - p), c(corners[3 * t + 2] - p);
      const double u = glm::dot(ray, glm::cross(a, b)), v = glm::dot(ray, glm::cross(b, c)),
                   w = glm::dot(ray, glm::cross(c, a));
      if (!((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0))) continue;
      const glm::dvec3 n = glm::cross(b - a, c - a);
      if (glm::dot(n, a) / glm::dot(n, ray) > 0) isInside = !isInside;
    }
    return isInside;
  }
};

} // namespace

Status scatterPoint(MeshPool& pool, const Form& form, const Scatter& how, uvec2 key, uint32_t index, Scope& point) {
  Draws draws{childKey(key, index)};
  const vec3 size = form.scope.size;
  const auto inBox = [&] {
    vec3 p(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
      const float part =
          how.gaussian ? add(how.mean[axis], multiply(draws.normal(), how.deviation[axis])) : draws.unit();
      p[axis] = multiply(std::clamp(part, 0.0f, 1.0f), size[axis]);
    }
    return p;
  };
  Scope made = form.scope;
  made.size = vec3(0.0f);
  ScatterDomain domain = how.domain;
  if (domain == ScatterDomain::Volume && !isClosedSurface(pool, form)) domain = ScatterDomain::Surface;
  if (domain == ScatterDomain::Scope) {
    made.origin = scopePoint(form.scope, inBox());
    point = made;
    return kGeometryOk;
  }
  Surface surface;
  if (const Status status = surface.make(pool, form)) return status;
  if (domain == ScatterDomain::Volume) {
    vec3 p = inBox();
    for (int turn = 0; turn < 256 && !surface.contains(p); ++turn) {
      p = inBox();
    }
    made.origin = scopePoint(form.scope, p);
    point = made;
    return kGeometryOk;
  }
  SurfacePoint found = surface.draw(draws);
  if (how.gaussian) {
    // Of some points that are uniform the one nearest to one that is not.
    const vec3 target = inBox();
    for (int turn = 0; turn < 15; ++turn) {
      const SurfacePoint other = surface.draw(draws);
      if (length3(other.position - target) < length3(found.position - target)) found = other;
    }
  }
  const vec3 normal = unit3(scopeDirection(form.scope, found.normal));
  const PlaneBasis basis = planeBasis(scopePoint(form.scope, found.position), normal, form.scope.axisX);
  made.origin = basis.origin;
  made.axisX = basis.right;
  made.axisY = normal;
  made.axisZ = outer3(basis.right, normal);
  point = made;
  return kGeometryOk;
}

} // namespace gpgp::spawn
