// Convex pieces of forms, and distances between them (Gilbert, Johnson, Keerthi 1988).
#include "spawn/geometry/internal.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gpgp::spawn {

using namespace shader;

namespace {

void addPiece(Hull& hull, const std::vector<vec3>& points) {
  for (const vec3& p : points) {
    hull.bounds.low = hull.points.empty() ? p : glm::min(hull.bounds.low, p);
    hull.bounds.high = hull.points.empty() ? p : glm::max(hull.bounds.high, p);
    hull.points.push_back(p);
  }
  hull.sizes.push_back(uint32_t(points.size()));
}

/// Whether all of a closed mesh is behind each of its faces.
bool isConvexSolid(MeshPool& pool, const Form& form, float slack) {
  for (uint f = 0; f < meshFaces(pool, form.mesh); ++f) {
    if (!countSteps(pool, meshVertices(pool, form.mesh))) return false;
    const vec3 n = localNormal(pool, form, f);
    const float at = inner3(n, localPosition(pool, form, faceCorners(pool, form.mesh, f).firstCorner));
    for (uint v = 0; v < meshVertices(pool, form.mesh); ++v) {
      if (inner3(n, scaled3(vertexPosition(pool, form.mesh, v), form.scale)) > at + slack) return false;
    }
  }
  return true;
}

using Points = std::span<const vec3>;

glm::dvec3 support(Points points, glm::dvec3 direction) {
  double best = -1e300;
  glm::dvec3 found{};
  for (const vec3& p : points) {
    const double d = glm::dot(glm::dvec3(p), direction);
    if (d > best) {
      best = d;
      found = p;
    }
  }
  return found;
}

/// The point nearest to the origin of the simplex; leaves in it the corners that hold it.
glm::dvec3 nearest(std::vector<glm::dvec3>& simplex) {
  // All faces of the simplex: the one whose nearest point lies within it and is nearest.
  glm::dvec3 best{};
  double bestLength = 1e300;
  std::vector<glm::dvec3> kept;
  const size_t n = simplex.size();
  for (uint32_t mask = 1; mask < (1u << n); ++mask) {
    std::vector<glm::dvec3> s;
    for (size_t i = 0; i < n; ++i) {
      if (mask >> i & 1) s.push_back(simplex[i]);
    }
    glm::dvec3 p = s[0];
    bool within = true;
    if (s.size() == 2) {
      const glm::dvec3 d = s[1] - s[0];
      const double l = glm::dot(d, d), t = l > 0 ? -glm::dot(s[0], d) / l : -1;
      within = t >= 0 && t <= 1;
      p = s[0] + d * t;
    } else if (s.size() == 3) {
      const glm::dvec3 u = s[1] - s[0], v = s[2] - s[0], nrm = glm::cross(u, v);
      const double l = glm::dot(nrm, nrm);
      if (!(l > 0)) continue;
      const glm::dvec3 w = -s[0];
      const double b = glm::dot(glm::cross(w, v), nrm) / l, c = glm::dot(glm::cross(u, w), nrm) / l;
      within = b >= 0 && c >= 0 && b + c <= 1;
      p = s[0] + u * b + v * c;
    } else if (s.size() == 4) {
      const glm::dvec3 u = s[1] - s[0], v = s[2] - s[0], w = s[3] - s[0], o = -s[0];
      const double det = glm::dot(u, glm::cross(v, w));
      if (det == 0) continue;
      const double a = glm::dot(o, glm::cross(v, w)) / det, b = glm::dot(u, glm::cross(o, w)) / det,
                   c = glm::dot(u, glm::cross(v, o)) / det;
      within = a >= 0 && b >= 0 && c >= 0 && a + b + c <= 1;
      p = {};
    }
    const double length = glm::dot(p, p);
    if (!within || length >= bestLength) continue;
    best = p;
    bestLength = length;
    kept = s;
  }
  simplex = kept;
  return best;
}

double distanceOf(Points a, Points b) {
  std::vector<glm::dvec3> simplex{glm::dvec3(a[0]) - glm::dvec3(b[0])};
  glm::dvec3 p = simplex[0];
  for (int turn = 0; turn < 64; ++turn) {
    const double length = glm::dot(p, p);
    if (length < 1e-18) return 0;
    const glm::dvec3 s = support(a, -p) - support(b, p);
    // No point is nearer by more than rounding.
    if (length - glm::dot(p, s) <= 1e-10 * length || simplex.size() == 4) break;
    if (std::find(simplex.begin(), simplex.end(), s) != simplex.end()) break;
    simplex.push_back(s);
    p = nearest(simplex);
    if (simplex.empty()) break;
  }
  return std::sqrt(glm::dot(p, p));
}

/// The piece drawn to its middle, so that what only touches is apart.
std::vector<vec3> shrunk(Points points) {
  glm::dvec3 middle{};
  for (const vec3& p : points) {
    middle += glm::dvec3(p) / double(points.size());
  }
  std::vector<vec3> smaller;
  for (const vec3& p : points) {
    smaller.push_back(vec3(middle + (glm::dvec3(p) - middle) * (1 - 1e-4)));
  }
  return smaller;
}

template <class Visit> void forPieces(const Hull& hull, const Visit& visit) {
  size_t at = 0;
  for (const uint32_t size : hull.sizes) {
    visit(Points(hull.points).subspan(at, size));
    at += size;
  }
}
float slackOf(const Hull& a, const Hull& b) {
  float largest = 0;
  for (const Hull* h : {&a, &b}) {
    const vec3 e = glm::max(glm::abs(h->bounds.low), glm::abs(h->bounds.high));
    largest = std::max({largest, e.x, e.y, e.z});
  }
  return 1e-5f * largest;
}

} // namespace

Hull makeHull(MeshPool& pool, const Form& form, const Axes& toWorld, vec3 origin) {
  Hull hull;
  const Scope world{origin, toWorld.x, toWorld.y, toWorld.z, vec3(0.0f)};
  const auto placed = [&](vec3 local) { return scopePoint(world, scopePoint(form.scope, local)); };
  const auto addBox = [&](vec3 low, vec3 high) {
    std::vector<vec3> points;
    for (int i = 0; i < 8; ++i) {
      points.push_back(placed(vec3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z)));
    }
    addPiece(hull, points);
  };
  if (form.mesh == 0) {
    addBox(vec3(0.0f), form.scope.size);
    return hull;
  }
  const Bounds b = scopeBounds(pool, form);
  const vec3 extent = b.high - b.low;
  const float slack = 1e-5f * std::max({extent.x, extent.y, extent.z});
  const bool closed = isClosedSurface(pool, form);
  if (closed && isConvexSolid(pool, form, slack)) {
    std::vector<vec3> points;
    for (uint v = 0; v < meshVertices(pool, form.mesh); ++v) {
      points.push_back(placed(scaled3(vertexPosition(pool, form.mesh, v), form.scale)));
    }
    addPiece(hull, points);
    return hull;
  }
  // An extrusion along an axis of the scope: all vertices at its ends.
  int along = -1;
  for (int axis = 0; axis < 3 && closed; ++axis) {
    bool ends = extent[axis] > 0;
    for (uint v = 0; v < meshVertices(pool, form.mesh); ++v) {
      const float p = scaled3(vertexPosition(pool, form.mesh, v), form.scale)[axis];
      ends = ends && (p < b.low[axis] + slack || p > b.high[axis] - slack);
    }
    if (ends) along = axis;
  }
  if (closed && along < 0) {
    addBox(b.low, b.high);
    return hull;
  }
  // Convex pieces of faces: of an open mesh all, of an extrusion those at its lower end, with the height.
  Form pieces = form;
  const uint32_t used = pool.used;
  if (convexify(pool, pieces) != kGeometryOk) {
    addBox(b.low, b.high);
    return hull;
  }
  for (uint f = 0; f < meshFaces(pool, pieces.mesh); ++f) {
    if (closed && localNormal(pool, pieces, f)[along] > -0.9f) continue;
    const Loop all = faceCorners(pool, pieces.mesh, f);
    std::vector<vec3> points;
    for (uint c = all.firstCorner; c < all.firstCorner + all.corners; ++c) {
      vec3 p = localPosition(pool, pieces, c);
      points.push_back(placed(p));
      if (!closed) continue;
      p[along] = b.high[along];
      points.push_back(placed(p));
    }
    addPiece(hull, points);
  }
  pool.used = used;
  return hull;
}

float minimumDistance(const Hull& a, const Hull& b) {
  double least = 1e300;
  forPieces(a, [&](Points p) { forPieces(b, [&](Points q) { least = std::min(least, distanceOf(p, q)); }); });
  return float(least);
}
bool overlaps(const Hull& a, const Hull& b) {
  const float slack = slackOf(a, b);
  if (glm::any(glm::greaterThan(a.bounds.low, b.bounds.high + slack)) ||
      glm::any(glm::greaterThan(b.bounds.low, a.bounds.high + slack)))
    return false;
  bool found = false;
  forPieces(a, [&](Points p) {
    const std::vector<vec3> small = shrunk(p);
    forPieces(b, [&](Points q) { found = found || distanceOf(small, shrunk(q)) <= 0.01 * double(slack); });
  });
  return found;
}
bool touches(const Hull& a, const Hull& b) { return minimumDistance(a, b) <= slackOf(a, b) && !overlaps(a, b); }
bool inside(const Hull& a, const Hull& b) {
  const float slack = slackOf(a, b);
  return std::all_of(a.points.begin(), a.points.end(), [&](const vec3& p) {
    bool found = false;
    forPieces(b, [&](Points q) { found = found || distanceOf(Points(&p, 1), q) <= double(slack); });
    return found;
  });
}

} // namespace gpgp::spawn
