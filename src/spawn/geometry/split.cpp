// Parts of forms between planes, or between texture coordinates.
#include "spawn/geometry/internal.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn {

using namespace shader;

namespace {

float slackOf(const MeshPool& pool, const Form& form) {
  const Bounds b = scopeBounds(pool, form);
  const vec3 e = b.high - b.low;
  return 2e-6f * std::max({e.x, e.y, e.z});
}

} // namespace

Status slice(MeshPool& pool, const Form& form, uint32_t axis, float from, float to, bool adjust, Form& piece) {
  if (axis > 2 || !std::isfinite(from) || !std::isfinite(to)) return kGeometryBadArgument;
  Attempt attempt(pool);
  Form made = form;
  const bool closed = isClosedSurface(pool, form);
  const Bounds bounds = scopeBounds(pool, form);
  const float slack = slackOf(pool, form);
  Status status = form.mesh == 0 || !(to > from) ? kGeometryEmpty : kGeometryOk;
  // A form that is flat along the axis is in the part that it lies in.
  const float thickness = bounds.high[axis] - bounds.low[axis];
  if (status == kGeometryOk && thickness <= slack) {
    const float at = bounds.low[axis];
    const bool last = at <= to + slack && to >= form.scope.size[axis] - slack;
    if (at < from - slack || !(at < to - slack || last)) status = kGeometryEmpty;
  } else {
    Cut cut{glm::vec4(0.0f), 0xffffffffu, 0, 1.0f, slack};
    for (const float side : {1.0f, -1.0f}) {
      if (status != kGeometryOk) break;
      cut.weight = glm::vec4(0.0f);
      cut.weight[int(axis)] = side;
      cut.weight.w = side > 0 ? -from : to;
      // Nothing to cut: the mesh is shared.
      const float reach = side > 0 ? bounds.low[axis] - from : to - bounds.high[axis];
      if (reach < -slack) status = cutForm(pool, made, cut, closed, false);
    }
  }
  if (status > kGeometryEmpty) return attempt.end(status);
  if (status == kGeometryEmpty) made.mesh = 0;
  // The slab as the scope: the mesh moves against it.
  vec3 move(0.0f), size = form.scope.size;
  move[int(axis)] = from;
  size[int(axis)] = subtract(to, from);
  if (made.mesh != 0) {
    const Bounds now = scopeBounds(pool, made);
    if (adjust) {
      for (int other = 0; other < 3; ++other) {
        if (other == int(axis)) continue;
        move[other] = now.low[other];
        size[other] = subtract(now.high[other], now.low[other]);
      }
    }
    if (move != vec3(0.0f)) {
      Builder b = builderFor(pool, made.mesh, 1);
      for (uint v = 0; v < meshVertices(pool, made.mesh); ++v) {
        addVertex(pool, b, minus3(scaled3(vertexPosition(pool, made.mesh, v), made.scale), move));
      }
      for (uint f = 0; f < meshFaces(pool, made.mesh); ++f) {
        copyFace(pool, b, made.mesh, f, 0, false, 0);
      }
      status = finishForm(pool, b, made, false);
      if (status != kGeometryOk) return attempt.end(status);
    }
  }
  made.scope.origin = scopePoint(form.scope, move);
  made.scope.size = size;
  piece = made;
  return attempt.end(status);
}

std::vector<float> placesOfAreas(MeshPool& pool, const Form& form, uint32_t axis, std::span<const double> areas) {
  // The area below a height c is the sum over edges of the integral of min(height, c) along the horizontal in the
  // face's plane, by the steepness (Green).
  struct Edge {
    double low, high, across; // heights and, signed, how far it goes across
  };
  struct Step {
    double at, area;
  };
  std::vector<Edge> edges;
  std::vector<Step> steps;
  double low = 1e300, high = -1e300, all = 0;
  for (uint f = 0; f < meshFaces(pool, form.mesh); ++f) {
    const glm::dvec3 n(localNormal(pool, form, f));
    const double steep = std::sqrt(std::max(0.0, 1.0 - n[int(axis)] * n[int(axis)]));
    const Face face = faceOf(pool, form.mesh, f);
    glm::dvec3 up(0);
    up[int(axis)] = 1;
    const glm::dvec3 across = steep > 1e-6 ? glm::cross(n, up) / steep : glm::dvec3(0);
    if (steep <= 1e-6)
      steps.push_back({double(localPosition(pool, form, faceCorners(pool, form.mesh, f).firstCorner)[int(axis)]),
                       double(faceArea(pool, form, f))});
    for (uint l = 0; l < face.loops; ++l) {
      const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
      for (uint c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
        const glm::dvec3 p(localPosition(pool, form, c)), q(localPosition(pool, form, nextCorner(loop, c)));
        const double hp = p[int(axis)], hq = q[int(axis)];
        low = std::min(low, hp);
        high = std::max(high, hp);
        // (up in the face, across) is left-handed about the normal.
        if (steep > 1e-6) edges.push_back({std::min(hp, hq), std::max(hp, hq), glm::dot(q - p, across) / steep});
      }
    }
  }
  const auto below = [&](double c) {
    double sum = 0;
    for (const Edge& e : edges) {
      const double a = e.low - low, b = e.high - low, x = c - low;
      // The mean of min(height, x) along the edge.
      const double mean = b <= x || b <= a ? std::min((a + b) / 2, x)
                          : a >= x         ? x
                                           : x - (x - a) * (x - a) / (2 * (b - a));
      sum += mean * e.across;
    }
    for (const Step& s : steps) sum += s.at <= c ? s.area : 0.0;
    return sum;
  };
  std::vector<float> places;
  all = meshFaces(pool, form.mesh) ? below(high) : 0.0;
  for (const double area : areas) {
    if (!countSteps(pool, 48ull * edges.size())) return std::vector<float>(areas.size(), 0.0f);
    if (area <= 0 || area >= all) {
      places.push_back(area <= 0 ? 0.0f : std::max(float(high), form.scope.size[int(axis)]));
      continue;
    }
    double from = low, to = high;
    for (int i = 0; i < 48; ++i) {
      const double middle = (from + to) / 2;
      (below(middle) < area ? from : to) = middle;
    }
    places.push_back(float((from + to) / 2));
  }
  return places;
}

Status sliceUv(MeshPool& pool, const Form& form, uint32_t set, uint32_t axis, float from, float to, Form& piece) {
  if (axis > 1 || set >= kMaxUvSets || !std::isfinite(from) || !std::isfinite(to)) return kGeometryBadArgument;
  Attempt attempt(pool);
  Form made = form;
  vec2 low, high;
  uvBounds(pool, form, set, low, high);
  const float slack = 2e-6f * std::max(std::fabs(high[int(axis)]), std::fabs(low[int(axis)]));
  Status status = form.mesh == 0 || !(to > from) ? kGeometryEmpty : kGeometryOk;
  for (const float side : {1.0f, -1.0f}) {
    if (status != kGeometryOk) break;
    const Cut cut{glm::vec4(0.0f, 0.0f, 0.0f, side > 0 ? -from : to), axis, set, side, slack};
    status = cutForm(pool, made, cut, false, true);
  }
  if (status == kGeometryEmpty) made.mesh = 0;
  if (status <= kGeometryEmpty) piece = made;
  return attempt.end(status);
}

Status trim(MeshPool& pool, Form& form, vec3 normal, float offset, bool close) {
  const vec3 n = unit3(inScope(form.scope, normal));
  if (n == vec3(0.0f) || !std::isfinite(offset)) return kGeometryBadArgument;
  Attempt attempt(pool);
  Form made = form;
  const float w = subtract(divide(inner3(normal, form.scope.origin), length3(normal)), divide(offset, length3(normal)));
  const Cut cut{glm::vec4(n, w), 0xffffffffu, 0, 1.0f, slackOf(pool, form)};
  Status status = kGeometryEmpty;
  if (form.mesh != 0) status = cutForm(pool, made, cut, close && isClosedSurface(pool, form), false);
  if (status <= kGeometryEmpty) form = made;
  return attempt.end(status);
}

} // namespace gpgp::spawn
