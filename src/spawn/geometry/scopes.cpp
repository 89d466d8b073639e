// Scopes of forms: their axes, extents and places, and what mirrors or turns geometry within.
#include "spawn/geometry/internal.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn {

using namespace shader;

namespace {

/// All positions through a function of metres in the scope; faces reversed or not.
template <class Move> Status rewrite(MeshPool& pool, Form& form, bool reversed, bool tight, const Move& move) {
  Builder b = builderFor(pool, form.mesh, 1);
  for (uint v = 0; v < meshVertices(pool, form.mesh); ++v) {
    addVertex(pool, b, move(scaled3(vertexPosition(pool, form.mesh, v), form.scale)));
  }
  for (uint f = 0; f < meshFaces(pool, form.mesh); ++f) {
    copyFace(pool, b, form.mesh, f, 0, reversed, 0);
  }
  return finishForm(pool, b, form, tight);
}

vec3 extentsOf(const Bounds& b) {
  const vec3 e = b.high - b.low;
  const float least = 2e-6f * std::max({e.x, e.y, e.z});
  return vec3(e.x > least ? e.x : 0.0f, e.y > least ? e.y : 0.0f, e.z > least ? e.z : 0.0f);
}

} // namespace

Status mirror(MeshPool& pool, Form& form, uint32_t axes) {
  if (axes > 7) return kGeometryBadArgument;
  if (form.mesh == 0 || axes == 0) return kGeometryOk;
  Attempt attempt(pool);
  const bool reversed = axes == 1 || axes == 2 || axes == 4 || axes == 7;
  const vec3 size = form.scope.size;
  return attempt.end(rewrite(pool, form, reversed, false, [&](vec3 p) {
    return vec3(axes & AxisX ? subtract(size.x, p.x) : p.x, axes & AxisY ? subtract(size.y, p.y) : p.y,
                axes & AxisZ ? subtract(size.z, p.z) : p.z);
  }));
}

Status reverseNormals(MeshPool& pool, Form& form) {
  if (form.mesh == 0) return kGeometryOk;
  Attempt attempt(pool);
  return attempt.end(rewrite(pool, form, true, false, [](vec3 p) { return p; }));
}

Status conformNormals(MeshPool& pool, Form& form) {
  const uint count = form.mesh ? meshFaces(pool, form.mesh) : 0;
  const std::vector<MeshEdge> edges = count ? meshEdges(pool, form) : std::vector<MeshEdge>();
  struct Neighbour {
    uint32_t face;
    bool opposed; // as the two are turned
  };
  std::vector<std::vector<Neighbour>> neighbours(count);
  std::vector<bool> isOpen(count, false), isReversed(count, false), isFound(count, false);
  for (const MeshEdge& edge : edges) {
    if (edge.faces == 2) {
      neighbours[edge.face].push_back({edge.otherFace, edge.opposed});
      neighbours[edge.otherFace].push_back({edge.face, edge.opposed});
    } else {
      isOpen[edge.face] = true; // of edges of several faces each part is open, too
    }
  }
  // Twice the area of each face, along its normal, and where it lies.
  std::vector<glm::dvec3> areas(count, glm::dvec3(0)), places(count);
  const glm::dvec3 middle = count ? glm::dvec3(framePosition(pool, form, 0)) : glm::dvec3(0);
  for (uint f = 0; f < count; ++f) {
    const Face face = faceOf(pool, form.mesh, f);
    for (uint l = 0; l < face.loops; ++l) {
      const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
      const glm::dvec3 first = glm::dvec3(framePosition(pool, form, loop.firstCorner)) - middle;
      if (l == 0) places[f] = first;
      for (uint c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
        const glm::dvec3 a = glm::dvec3(framePosition(pool, form, c)) - middle;
        const glm::dvec3 b = glm::dvec3(framePosition(pool, form, nextCorner(loop, c))) - middle;
        areas[f] += glm::cross(a - first, b - first);
      }
    }
  }
  bool isAnyReversed = false;
  for (uint first = 0; first < count; ++first) {
    if (isFound[first]) continue;
    std::vector<uint32_t> group{first};
    isFound[first] = true;
    bool isClosed = true;
    double volume = 0, up = 0, kept = 0, all = 0;
    for (size_t i = 0; i < group.size(); ++i) {
      const uint32_t f = group[i];
      const double sign = isReversed[f] ? -1 : 1, area = glm::length(areas[f]);
      isClosed = isClosed && !isOpen[f];
      volume += sign * glm::dot(places[f], areas[f]);
      up += sign * areas[f].y;
      kept += isReversed[f] ? 0 : area;
      all += area;
      for (const Neighbour& n : neighbours[f]) {
        if (isFound[n.face]) continue;
        isFound[n.face] = true;
        isReversed[n.face] = isReversed[f] == n.opposed;
        group.push_back(n.face);
      }
    }
    const bool isVertical = std::fabs(up) < 1e-6 * all;
    const bool turns = isClosed ? volume < 0 : isVertical ? kept < 0.5 * all : up < 0;
    for (const uint32_t f : group) {
      isReversed[f] = isReversed[f] != turns;
      isAnyReversed = isAnyReversed || isReversed[f];
    }
  }
  if (!isAnyReversed) return kGeometryOk;
  Attempt attempt(pool);
  Builder b = builderFor(pool, form.mesh, 1);
  for (uint v = 0; v < meshVertices(pool, form.mesh); ++v)
    addVertex(pool, b, scaled3(vertexPosition(pool, form.mesh, v), form.scale));
  for (uint f = 0; f < count; ++f) copyFace(pool, b, form.mesh, f, 0, isReversed[f], 0);
  return attempt.end(finishForm(pool, b, form, false));
}

Status alignScope(MeshPool& pool, Form& form, const Axes& axes) {
  const vec3 x = unit3(axes.x), y = unit3(along3(axes.y, x, -inner3(axes.y, x)));
  if (x == vec3(0.0f) || y == vec3(0.0f)) return kGeometryBadArgument;
  Scope to{form.scope.origin, x, y, outer3(x, y), vec3(0.0f)};
  if (form.mesh == 0) {
    // A scope without geometry keeps its middle and its extents.
    const vec3 middle = scopePoint(form.scope, times3(form.scope.size, 0.5f));
    to.size = form.scope.size;
    to.origin = minus3(middle, scopeDirection(to, times3(to.size, 0.5f)));
    form.scope = to;
    return kGeometryOk;
  }
  Attempt attempt(pool);
  const Scope from = form.scope;
  Form made = form;
  made.scope = to;
  Form source = form;
  Builder b = builderFor(pool, form.mesh, 1);
  for (uint v = 0; v < meshVertices(pool, form.mesh); ++v) {
    const vec3 p = scaled3(vertexPosition(pool, form.mesh, v), form.scale);
    addVertex(pool, b, inScope(to, scopeDirection(from, p)));
  }
  for (uint f = 0; f < meshFaces(pool, form.mesh); ++f) {
    copyFace(pool, b, source.mesh, f, 0, false, 0);
  }
  const Status status = finishForm(pool, b, made, true);
  if (status <= kGeometryEmpty) form = made;
  return attempt.end(status);
}

Status alignScopeToAxes(MeshPool& pool, Form& form, const Axes& axes, uint32_t axis) {
  if (axis > 3) return kGeometryBadArgument;
  if (axis == 3) return alignScope(pool, form, axes);
  const vec3 fixed = axis == 0 ? axes.x : axis == 1 ? axes.y : axes.z;
  // The second axis is the old one, projected: z for x, x for y and z.
  const vec3 old = axis == 0 ? form.scope.axisZ : form.scope.axisX;
  vec3 second = unit3(along3(old, fixed, -inner3(old, fixed)));
  if (second == vec3(0.0f)) second = axis == 0 ? axes.z : axes.x;
  Axes to;
  if (axis == 0) to = {fixed, outer3(second, fixed), second};
  if (axis == 1) to = {second, fixed, outer3(second, fixed)};
  if (axis == 2) to = {second, outer3(fixed, second), fixed};
  return alignScope(pool, form, to);
}

Status alignScopeToGeometry(MeshPool& pool, Form& form, bool zUp, Pick face, int32_t faceIndex, Pick edge,
                            int32_t edgeIndex, vec3 up) {
  const uint faces = meshFaces(pool, form.mesh);
  if (faces == 0) return kGeometryEmpty;
  if (edge == Pick::Any || edge == Pick::Largest || face == Pick::Longest || (face == Pick::Any && edge == Pick::Index))
    return kGeometryBadArgument;
  const auto modulo = [](int32_t i, uint32_t n) { return uint32_t(((i % int32_t(n)) + int32_t(n)) % int32_t(n)); };
  const auto heightOfEdge = [&](Loop loop, uint corner) {
    return inner3(up, framePosition(pool, form, corner)) +
           inner3(up, framePosition(pool, form, nextCorner(loop, corner)));
  };
  // Less is better.
  const auto scoreOfEdge = [&](Loop loop, uint corner) {
    if (edge == Pick::WorldLowest) return heightOfEdge(loop, corner);
    return -length3(minus3(localPosition(pool, form, nextCorner(loop, corner)), localPosition(pool, form, corner)));
  };
  const auto bestEdge = [&](uint f, float& score) {
    const Loop loop = loopOf(pool, form.mesh, faceOf(pool, form.mesh, f).firstLoop);
    if (edge == Pick::Index) return loop.firstCorner + modulo(edgeIndex, loop.corners);
    uint best = loop.firstCorner;
    for (uint c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
      if (c == loop.firstCorner || scoreOfEdge(loop, c) < scoreOfEdge(loop, best) - 1e-6f) best = c;
    }
    score = scoreOfEdge(loop, best);
    return best;
  };
  uint chosen = face == Pick::Index ? modulo(faceIndex, faces) : 0;
  if (face != Pick::Index) {
    float best = 0;
    for (uint f = 0; f < faces; ++f) {
      float score = 0;
      if (face == Pick::Any) bestEdge(f, score);
      if (face == Pick::Largest) score = -faceArea(pool, form, f);
      if (face == Pick::WorldLowest) {
        const Loop all = faceCorners(pool, form.mesh, f);
        for (uint c = all.firstCorner; c < all.firstCorner + all.corners; ++c) {
          const float h = inner3(up, framePosition(pool, form, c));
          score = c == all.firstCorner ? h : std::min(score, h);
        }
      }
      if (f > 0 && !(score < best - 1e-6f)) continue;
      best = score;
      chosen = f;
    }
  }
  float unused = 0;
  const uint corner = bestEdge(chosen, unused);
  const Loop loop = loopOf(pool, form.mesh, faceOf(pool, form.mesh, chosen).firstLoop);
  const vec3 x = unit3(minus3(framePosition(pool, form, nextCorner(loop, corner)), framePosition(pool, form, corner)));
  const vec3 n = faceNormal(pool, form, chosen);
  if (x == vec3(0.0f) || n == vec3(0.0f)) return kGeometryBadArgument;
  return alignScope(pool, form, zUp ? Axes{x, outer3(n, x), n} : Axes{x, n, outer3(x, n)});
}

Status alignScopeToGeometryBox(MeshPool& pool, Form& form, uint32_t fixedAxis) {
  if (fixedAxis > 2) return kGeometryBadArgument;
  if (form.mesh == 0) return kGeometryEmpty;
  const vec3 axes[3] = {form.scope.axisX, form.scope.axisY, form.scope.axisZ};
  const vec3 fixed = axes[fixedAxis], first = axes[fixedAxis == 0 ? 1 : 0];
  const vec3 second = outer3(fixed, first);
  // The least rectangle has a side along an edge of the convex hull; trying all pairs of hull points that are
  // neighbours is enough.
  std::vector<glm::dvec2> points;
  for (uint v = 0; v < meshVertices(pool, form.mesh); ++v) {
    const vec3 p = scopeDirection(form.scope, scaled3(vertexPosition(pool, form.mesh, v), form.scale));
    points.emplace_back(inner3(first, p), inner3(second, p));
  }
  std::sort(points.begin(), points.end(), [](auto a, auto b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<glm::dvec2> hull;
  const auto turn = [](glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  };
  for (int pass = 0; pass < 2; ++pass) {
    const size_t base = hull.size();
    for (const glm::dvec2 p : points) {
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  double bestArea = -1;
  glm::dvec2 best(1, 0);
  for (size_t i = 0; i < hull.size(); ++i) {
    const glm::dvec2 d = hull[(i + 1) % hull.size()] - hull[i];
    const double l = std::hypot(d.x, d.y);
    if (!(l > 0)) continue;
    const glm::dvec2 u(d.x / l, d.y / l);
    double lowU = 1e300, highU = -1e300, lowV = 1e300, highV = -1e300;
    for (const glm::dvec2 p : hull) {
      const double a = p.x * u.x + p.y * u.y, b = p.y * u.x - p.x * u.y;
      lowU = std::min(lowU, a), highU = std::max(highU, a), lowV = std::min(lowV, b), highV = std::max(highV, b);
    }
    const double boxArea = (highU - lowU) * (highV - lowV);
    if (bestArea >= 0 && boxArea >= bestArea * (1 - 1e-9)) continue;
    bestArea = boxArea;
    best = highU - lowU >= highV - lowV ? u : glm::dvec2(-u.y, u.x);
  }
  vec3 longer = unit3(plus3(times3(first, float(best.x)), times3(second, float(best.y))));
  // Of the two directions the one nearer to the old axis.
  if (inner3(longer, first) < 0) longer = -longer;
  Axes to;
  if (fixedAxis == 0) to = {fixed, longer, outer3(fixed, longer)};
  if (fixedAxis == 1) to = {longer, fixed, outer3(longer, fixed)};
  if (fixedAxis == 2) to = {longer, outer3(fixed, longer), fixed};
  return alignScope(pool, form, to);
}

Status fitScope(MeshPool& pool, Form& form) {
  if (form.mesh == 0) return kGeometryOk;
  const Bounds b = scopeBounds(pool, form);
  if (b.low == vec3(0.0f)) {
    form.scope.size = extentsOf(b);
    return kGeometryOk;
  }
  Attempt attempt(pool);
  return attempt.end(rewrite(pool, form, false, true, [](vec3 p) { return p; }));
}

void resizeScope(Form& form, vec3 size) {
  for (int axis = 0; axis < 3; ++axis) {
    const float to = std::isfinite(size[axis]) ? std::max(size[axis], 0.0f) : 0.0f;
    // What is flat stays flat.
    if (form.scope.size[axis] > 0) form.scale[axis] = multiply(form.scale[axis], divide(to, form.scope.size[axis]));
    form.scope.size[axis] = to;
  }
}

void center(Form& form, const Scope& to, uint32_t axes) {
  const vec3 target = scopePoint(to, times3(to.size, 0.5f));
  const vec3 own = scopePoint(form.scope, times3(form.scope.size, 0.5f));
  vec3 move = inScope(form.scope, minus3(target, own));
  move = vec3(axes & AxisX ? move.x : 0.0f, axes & AxisY ? move.y : 0.0f, axes & AxisZ ? move.z : 0.0f);
  form.scope.origin = scopePoint(form.scope, move);
}

} // namespace gpgp::spawn
