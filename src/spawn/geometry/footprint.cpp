// What lies below a form: its faces' shadows along y of the scope, united; and the roof of two planes over a face.
#include "spawn/geometry/internal.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

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

namespace {

using Loops = std::vector<std::vector<vec3>>;
/// Loops of a face of its own, in the order of the outline and its holes.
Loops loopsOf(MeshPool& pool, const Form& form, uint32_t f) {
  std::vector<uint32_t> sizes;
  const std::vector<vec3> points = pointsOf(pool, form, f, sizes);
  Loops loops;
  size_t at = 0;
  for (const uint32_t size : sizes) {
    loops.emplace_back(points.begin() + static_cast<ptrdiff_t>(at), points.begin() + static_cast<ptrdiff_t>(at + size));
    at += size;
  }
  return loops;
}

struct TaggedFace {
  Loops loops;
  uint32_t tags;
};
Status meshOf(MeshPool& pool, const std::vector<TaggedFace>& faces, Form& form) {
  uint corners = 0, loops = 0;
  for (const TaggedFace& face : faces) {
    loops += uint(face.loops.size());
    for (const auto& loop : face.loops) corners += uint(loop.size());
  }
  Builder b = newBuilder(pool, corners, corners, loops, uint(faces.size()), 0);
  for (const TaggedFace& face : faces) {
    beginFace(pool, b, face.tags);
    for (const auto& loop : face.loops) {
      beginLoop(pool, b);
      for (const vec3& p : loop) addCorner(pool, b, addVertex(pool, b, p), 0);
    }
  }
  form = {{vec3(0), {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, vec3(0)}, vec3(1.0f), 0};
  return finishForm(pool, b, form, true);
}

/// Of the edges of pieces, which run counter-clockwise around them, those that no two pieces share, as loops.
class Seams {
public:
  Seams(const Scope& scope, const Axes& axes, float cell) : scope_(scope), axes_(axes), cell_(cell) {}
  void add(const Loops& loops) {
    for (const auto& points : loops)
      for (size_t i = 0; i < points.size(); ++i) {
        const vec3 &a = points[i], &b = points[(i + 1) % points.size()];
        const Key from = keyOf(a), to = keyOf(b);
        if (from != to && edges_.erase({to, from}) == 0) edges_[{from, to}] = a;
      }
  }
  /// The outline first, then holes. False: loops touch each other.
  bool loops(Loops& found) const {
    std::map<Key, std::pair<Key, vec3>> next;
    for (const auto& [keys, place] : edges_)
      if (!next.try_emplace(keys.first, keys.second, place).second) return false;
    size_t outlines = 0;
    while (!next.empty()) {
      std::vector<vec3> loop;
      double area = 0;
      const Key first = next.begin()->first;
      Key at = first;
      do {
        const auto edge = next.find(at);
        if (edge == next.end()) return false;
        const Key to = edge->second.first;
        loop.push_back(edge->second.second);
        // x and z of a right-handed system whose y points up: seen from above, z points down the page.
        area += static_cast<double>(to.first) * static_cast<double>(at.second) -
                static_cast<double>(at.first) * static_cast<double>(to.second);
        next.erase(edge);
        at = to;
      } while (at != first);
      outlines += area > 0;
      found.insert(area > 0 ? found.begin() : found.end(), std::move(loop));
    }
    return outlines == 1;
  }

private:
  using Key = std::pair<long long, long long>;
  /// Of a place, or of one within two cells that was there before.
  Key keyOf(const vec3& p) {
    const Key own{std::llround(inner3(axes_.x, p - scope_.origin) / cell_),
                  std::llround(inner3(axes_.z, p - scope_.origin) / cell_)};
    for (const long long x : {0, -1, 1})
      for (const long long z : {0, -1, 1})
        if (const Key near{own.first + x, own.second + z}; places_.count(near)) return near;
    places_.insert(own);
    return own;
  }
  Scope scope_;
  Axes axes_;
  float cell_;
  std::set<Key> places_;
  std::map<std::pair<Key, Key>, vec3> edges_;
};

/// A vertical side above each straight part of a loop, which begin at corners; the solid lies to the loop's left.
template <class Height>
void addSides(const std::vector<vec3>& loop, vec3 normal, const Height& height, std::vector<TaggedFace>& faces) {
  const size_t count = loop.size();
  const auto isCorner = [&](size_t i) {
    const vec3 before = unit3(loop[i % count] - loop[(i + count - 1) % count]);
    const vec3 behind = unit3(loop[(i + 1) % count] - loop[i % count]);
    return inner3(before, behind) < 0.999999f;
  };
  for (size_t i = 0; i < count; ++i) {
    if (!isCorner(i)) continue;
    std::vector<vec3> side{loop[i]};
    size_t end = i + 1;
    for (; end < i + count; ++end) {
      side.push_back(loop[end % count]);
      if (isCorner(end)) break;
    }
    for (size_t k = end + 1; k-- > i;) {
      const vec3 p = loop[k % count];
      if (height(p) > 0) side.push_back(p + normal * height(p));
    }
    if (side.size() > end - i + 1) faces.push_back({{std::move(side)}, kTagRoofSide});
  }
}

} // namespace

Status ridgeRoof(MeshPool& pool, Form& form, bool byHeight, float value) {
  Attempt attempt(pool);
  std::vector<TaggedFace> faces;
  Axes first;
  for (uint32_t f = 0; f < meshFaces(pool, form.mesh); ++f) {
    const vec3 n = faceNormal(pool, form, f);
    vec3 x = form.scope.axisX - n * inner3(n, form.scope.axisX);
    if (inner3(x, x) < 1e-6f) x = form.scope.axisZ - n * inner3(n, form.scope.axisZ);
    const Axes axes{unit3(x), n, outer3(unit3(x), n)};
    if (f == 0) first = axes;
    std::vector<uint32_t> sizes;
    const std::vector<vec3> points = pointsOf(pool, form, f, sizes);
    Form flat;
    Status status = makePolygon(pool, points, sizes, flat);
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
    // The two halves; edges that no other half has are the outline's and the holes', and get sides.
    Seams seams(flat.scope, axes, 1e-5f * std::max(depth, flat.scope.size.x));
    for (const bool back : {true, false}) {
      Form piece;
      status = slice(pool, flat, 2, back ? 0.0f : half, back ? half : depth, true, piece);
      if (status == kGeometryEmpty) continue;
      if (status != kGeometryOk) return attempt.end(status);
      for (uint32_t p = 0; p < meshFaces(pool, piece.mesh); ++p) {
        Loops loops = loopsOf(pool, piece, p);
        seams.add(loops);
        for (auto& loop : loops)
          for (vec3& at : loop) at = at + n * height(at);
        faces.push_back({std::move(loops), kTagRoofTop});
      }
    }
    Loops bottom; // the outline again, with the points where the ridge ends
    if (!seams.loops(bottom)) return attempt.end(kGeometryBadArgument);
    for (auto& loop : bottom) {
      addSides(loop, n, height, faces);
      std::reverse(loop.begin(), loop.end());
    }
    faces.push_back({std::move(bottom), kTagRoofBottom});
  }
  if (faces.empty()) return attempt.end(kGeometryEmpty);
  Form made;
  Status status = meshOf(pool, faces, made);
  if (status == kGeometryOk) status = alignScope(pool, made, first);
  if (status == kGeometryOk) form = made;
  return attempt.end(status);
}

} // namespace gpgp::spawn
