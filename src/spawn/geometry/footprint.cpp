// What lies below a form: its faces' shadows along y of the scope, united; and the roof of two planes over a face.
#include "spawn/geometry/internal.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace gpgp::spawn {

using namespace shader;

namespace {

/// Loops of a face as points in the frame, moved to a plane along its normal.
std::vector<vec3> pointsOf(MeshPool& pool, const Form& form, uint32_t f, std::vector<uint32_t>& sizes) {
  std::vector<vec3> points;
  const Face face = faceOf(pool, form.mesh, f);
  for (uint32_t l = 0; l < face.loops; ++l) {
    const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
    for (uint32_t c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c)
      points.push_back(framePosition(pool, form, c));
    sizes.push_back(loop.corners);
  }
  return points;
}

} // namespace

Status footprint(MeshPool& pool, Form& form) {
  Attempt attempt(pool);
  const Scope scope = form.scope;
  const bool isClosed = isClosedSurface(pool, form);
  std::vector<Form> shadows;
  for (uint32_t f = 0; f < meshFaces(pool, form.mesh); ++f) {
    const float up = inner3(faceNormal(pool, form, f), scope.axisY);
    if (std::fabs(up) < 1e-4f || (isClosed && up < 0)) continue;
    std::vector<uint32_t> sizes;
    std::vector<vec3> points = pointsOf(pool, form, f, sizes);
    for (vec3& p : points) p = p - scope.axisY * inner3(scope.axisY, p - scope.origin);
    if (up < 0) std::reverse(points.begin(), points.begin() + sizes[0]);
    Form shadow;
    const Status status = makePolygon(pool, points, sizes, shadow);
    if (status == kGeometryNoRoom || status == kGeometryTooLarge) return attempt.end(status);
    if (status == kGeometryOk) shadows.push_back(shadow); // else it has no area
  }
  if (shadows.empty()) {
    form.mesh = 0;
    return attempt.end(kGeometryEmpty);
  }
  while (shadows.size() > 1) { // by pairs, so that each is united a few times only
    std::vector<Form> pairs;
    for (size_t i = 0; i < shadows.size(); i += 2) {
      Form both = shadows[i];
      if (i + 1 < shadows.size()) {
        const Status status = boolean(pool, shadows[i], shadows[i + 1], Boolean::Union, both);
        if (status != kGeometryOk) return attempt.end(status);
      }
      pairs.push_back(both);
    }
    shadows.swap(pairs);
  }
  Form result = shadows[0];
  const Status status = alignScope(pool, result, axesOf(scope));
  if (status == kGeometryOk) form = result;
  return attempt.end(status);
}

Status ridgeRoof(MeshPool& pool, Form& form, bool byHeight, float value) {
  Attempt attempt(pool);
  std::vector<vec3> positions;
  std::vector<uint32_t> corners, sizes, tags;
  const auto addFace = [&](const std::vector<vec3>& points, uint32_t tag) {
    for (const vec3& p : points) {
      corners.push_back(static_cast<uint32_t>(positions.size()));
      positions.push_back(p);
    }
    sizes.push_back(static_cast<uint32_t>(points.size()));
    tags.push_back(tag);
  };
  Axes first;
  for (uint32_t f = 0; f < meshFaces(pool, form.mesh); ++f) {
    const vec3 n = faceNormal(pool, form, f);
    vec3 x = form.scope.axisX - n * inner3(n, form.scope.axisX);
    if (inner3(x, x) < 1e-6f) x = form.scope.axisZ - n * inner3(n, form.scope.axisZ);
    const Axes axes{unit3(x), n, outer3(unit3(x), n)};
    if (f == 0) first = axes;
    std::vector<uint32_t> loops;
    const std::vector<vec3> outline = pointsOf(pool, form, f, loops);
    if (loops.size() > 1) return attempt.end(kGeometryBadArgument);
    Form flat;
    Status status = makePolygon(pool, outline, loops, flat);
    if (status == kGeometryOk) status = alignScope(pool, flat, axes);
    if (status != kGeometryOk) return attempt.end(status);
    const float depth = flat.scope.size.z, half = 0.5f * depth;
    const vec2 sc = sineCosineDegrees(byHeight ? 45.0f : value);
    const float slope = byHeight ? divide(value, half) : divide(sc.x, sc.y);
    const auto height = [&](const vec3& p) {
      const float z = inner3(axes.z, p - flat.scope.origin);
      const float h = slope * (half - std::fabs(z - half));
      return h > 1e-5f * depth ? h : 0.0f;
    };
    // The two halves; edges that no other half has are the outline's, and get sides.
    using Key = std::tuple<long long, long long>;
    const float cell = 1e-5f * std::max(depth, flat.scope.size.x);
    const auto keyOf = [&](const vec3& p) {
      return Key(std::llround(inner3(axes.x, p - flat.scope.origin) / cell),
                 std::llround(inner3(axes.z, p - flat.scope.origin) / cell));
    };
    std::map<std::pair<Key, Key>, std::pair<vec3, vec3>> edges;
    for (const bool back : {true, false}) {
      Form piece;
      status = slice(pool, flat, 2, back ? 0.0f : half, back ? half : depth, true, piece);
      if (status == kGeometryEmpty) continue;
      if (status != kGeometryOk) return attempt.end(status);
      for (uint32_t p = 0; p < meshFaces(pool, piece.mesh); ++p) {
        std::vector<uint32_t> one;
        std::vector<vec3> points = pointsOf(pool, piece, p, one);
        if (one.size() > 1) return attempt.end(kGeometryBadArgument);
        for (size_t i = 0; i < points.size(); ++i) {
          const vec3 &a = points[i], &b = points[(i + 1) % points.size()];
          if (edges.erase({keyOf(b), keyOf(a)}) == 0) edges[{keyOf(a), keyOf(b)}] = {a, b};
        }
        for (vec3& at : points) at = at + n * height(at);
        addFace(points, kTagRoofTop);
      }
    }
    std::map<Key, std::pair<Key, vec3>> next;
    for (const auto& [keys, ends] : edges) next[keys.first] = {keys.second, ends.first};
    // The outline again, with the points where the ridge ends.
    std::vector<vec3> bottom;
    if (next.empty()) continue;
    Key at = next.begin()->first;
    for (size_t i = 0; i <= next.size(); ++i) {
      const auto found = next.find(at);
      if (found == next.end()) break;
      bottom.push_back(found->second.second);
      at = found->second.first;
      if (at == next.begin()->first) break;
    }
    // A side for each of its straight parts, which begin at corners.
    const size_t count = bottom.size();
    const auto isCorner = [&](size_t i) {
      const vec3 before = unit3(bottom[i % count] - bottom[(i + count - 1) % count]);
      const vec3 behind = unit3(bottom[(i + 1) % count] - bottom[i % count]);
      return inner3(before, behind) < 0.999999f;
    };
    for (size_t i = 0; i < count; ++i) {
      if (!isCorner(i)) continue;
      std::vector<vec3> side{bottom[i]};
      size_t end = i + 1;
      for (; end < i + count; ++end) {
        side.push_back(bottom[end % count]);
        if (isCorner(end)) break;
      }
      for (size_t k = end + 1; k-- > i;) {
        const vec3 p = bottom[k % count];
        if (height(p) > 0) side.push_back(p + n * height(p));
      }
      if (side.size() > end - i + 1) addFace(side, kTagRoofSide);
    }
    std::reverse(bottom.begin(), bottom.end());
    addFace(bottom, kTagRoofBottom);
  }
  if (sizes.empty()) return attempt.end(kGeometryEmpty);
  Form made;
  Status status = makeMesh(pool, positions, corners, sizes, {}, made);
  for (uint32_t f = 0; f < sizes.size() && status == kGeometryOk; ++f)
    status = tagComponent(pool, made, Component::Faces, f, tags[f]);
  if (status == kGeometryOk) status = alignScope(pool, made, first);
  if (status == kGeometryOk) form = made;
  return attempt.end(status);
}

} // namespace gpgp::spawn
