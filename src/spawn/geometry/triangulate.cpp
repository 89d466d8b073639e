// Faces to triangles, by cutting off ears. Holes are joined to the outline by bridges first (Eberly 2002).
//
// Signs of areas are exact: products of differences of floats, in double precision. A face whose outline crosses itself
// still gives as many triangles as its corners ask for.
#include "spawn/geometry/internal.h"

#include <algorithm>
#include <utility>

namespace gpgp::spawn {

using namespace shader;

namespace {

struct Point {
  double x, y;
  uint32_t corner;
};

double areaOf(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}
bool same(const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; }
/// Within the triangle or on it, but none of its corners.
bool blocks(const Point& a, const Point& b, const Point& c, const Point& p) {
  if (same(p, a) || same(p, b) || same(p, c)) return false;
  return areaOf(a, b, p) >= 0 && areaOf(b, c, p) >= 0 && areaOf(c, a, p) >= 0;
}

/// Where the outline takes in a hole whose rightmost point is p: a corner that p sees.
size_t bridgeTo(const std::vector<Point>& outline, const Point& p) {
  size_t best = outline.size();
  double bestX = 0;
  for (size_t i = 0; i < outline.size(); ++i) {
    const Point& a = outline[i];
    const Point& b = outline[(i + 1) % outline.size()];
    // Edges that run upwards, to the right of p, have the inside to their left.
    if (!(a.y <= p.y && p.y <= b.y) || a.y == b.y) continue;
    const double x = a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
    if (x < p.x || (best != outline.size() && x >= bestX)) continue;
    bestX = x;
    best = a.x > b.x ? i : (i + 1) % outline.size();
    if (p.y == a.y) best = i;
    if (p.y == b.y) best = (i + 1) % outline.size();
  }
  if (best == outline.size()) return 0;
  // Corners within the triangle of p, the edge's point and its end hide that; the one at the least angle sees p.
  const Point hit{bestX, p.y, 0};
  const Point end = outline[best];
  const bool above = end.y > p.y;
  double bestSlope = -1;
  size_t seen = best;
  for (size_t i = 0; i < outline.size() && end.y != p.y; ++i) {
    const Point& q = outline[i];
    if (i == best || same(q, end) || q.x < p.x) continue;
    const bool isWithin = above ? areaOf(p, hit, q) >= 0 && areaOf(hit, end, q) >= 0 && areaOf(end, p, q) >= 0
                                : areaOf(p, end, q) >= 0 && areaOf(end, hit, q) >= 0 && areaOf(hit, p, q) >= 0;
    if (!isWithin) continue;
    const Point& before = outline[(i + outline.size() - 1) % outline.size()];
    const Point& behind = outline[(i + 1) % outline.size()];
    if (areaOf(before, q, behind) > 0) continue; // convex
    const double dx = q.x - p.x, dy = q.y - p.y;
    const double slope = dx * dx / std::max(dx * dx + dy * dy, 1e-300);
    if (slope > bestSlope || (slope == bestSlope && q.x < outline[seen].x)) {
      bestSlope = slope;
      seen = i;
    }
  }
  // Of corners at one place, where bridges are, the one whose inside p lies in.
  const Point at = outline[seen];
  for (size_t i = 0; i < outline.size(); ++i) {
    if (!same(outline[i], at)) continue;
    const Point& before = outline[(i + outline.size() - 1) % outline.size()];
    const Point& behind = outline[(i + 1) % outline.size()];
    const bool convex = areaOf(before, outline[i], behind) > 0;
    const bool leftOfIn = areaOf(before, outline[i], p) > 0, leftOfOut = areaOf(outline[i], behind, p) > 0;
    if (convex ? leftOfIn && leftOfOut : leftOfIn || leftOfOut) return i;
  }
  return seen;
}

} // namespace

Status triangulateFace(MeshPool& pool, const Form& form, uint32_t f, std::vector<uint32_t>& corners) {
  const Face face = faceOf(pool, form.mesh, f);
  const vec3 normal = localNormal(pool, form, f);
  const Loop outer = loopOf(pool, form.mesh, face.firstLoop);
  if (face.loops == 1 && outer.corners == 3) {
    for (uint32_t i = 0; i < 3; ++i) {
      corners.push_back(outer.firstCorner + i);
    }
    return kGeometryOk;
  }
  const vec3 origin = localPosition(pool, form, outer.firstCorner);
  const PlaneBasis basis = planeBasis(origin, normal, localPosition(pool, form, outer.firstCorner + 1) - origin);
  std::vector<std::vector<Point>> loops;
  for (uint32_t l = 0; l < face.loops; ++l) {
    const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
    std::vector<Point> points;
    for (uint32_t c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
      const vec2 p = inPlane(basis, localPosition(pool, form, c));
      points.push_back({p.x, p.y, c});
    }
    loops.push_back(std::move(points));
  }
  const auto rightmost = [](const std::vector<Point>& loop) {
    return std::max_element(loop.begin(), loop.end(),
                            [](const Point& a, const Point& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  };
  std::sort(loops.begin() + 1, loops.end(), [&](const auto& a, const auto& b) {
    const Point p = *rightmost(a), q = *rightmost(b);
    return p.x > q.x || (p.x == q.x && p.y > q.y);
  });
  std::vector<Point> outline = loops[0];
  for (size_t l = 1; l < loops.size(); ++l) {
    std::vector<Point>& hole = loops[l];
    std::rotate(hole.begin(), hole.begin() + (rightmost(hole) - hole.begin()), hole.end());
    const size_t at = bridgeTo(outline, hole[0]);
    std::vector<Point> bridge = hole;
    bridge.push_back(hole[0]);
    bridge.push_back(outline[at]);
    outline.insert(outline.begin() + ptrdiff_t(at) + 1, bridge.begin(), bridge.end());
  }
  // Ears, from where the last one was; one without area where no other is left.
  std::vector<uint32_t> next(outline.size()), previous(outline.size());
  for (uint32_t i = 0; i < outline.size(); ++i) {
    next[i] = uint32_t((i + 1) % outline.size());
    previous[i] = uint32_t((i + outline.size() - 1) % outline.size());
  }
  size_t left = outline.size();
  uint32_t at = 0;
  uint64_t looked = 0;
  const auto isEar = [&](uint32_t i, bool flat) {
    const Point &a = outline[previous[i]], &b = outline[i], &c = outline[next[i]];
    const double area = areaOf(a, b, c);
    if (flat) return area == 0;
    if (!(area > 0)) return false;
    for (uint32_t j = next[next[i]]; j != previous[i]; j = next[j]) {
      ++looked;
      const Point& q = outline[j];
      if (areaOf(outline[previous[j]], q, outline[next[j]]) > 0) continue; // only reflex corners can be within
      if (blocks(a, b, c, q)) return false;
    }
    return true;
  };
  while (left > 2) {
    if (!countSteps(pool, left + std::exchange(looked, 0))) return kGeometryTooLarge;
    uint32_t found = at;
    bool any = false;
    for (const bool flat : {false, true}) {
      uint32_t i = at;
      for (size_t turn = 0; turn < left && !any; ++turn, i = next[i]) {
        if (isEar(i, flat)) {
          found = i;
          any = true;
        }
      }
      if (any) break;
    }
    const Point &a = outline[previous[found]], &b = outline[found], &c = outline[next[found]];
    if (areaOf(a, b, c) != 0) corners.insert(corners.end(), {a.corner, b.corner, c.corner});
    next[previous[found]] = next[found];
    previous[next[found]] = previous[found];
    at = next[next[found]]; // not a fan about one corner
    left -= 1;
  }
  return kGeometryOk;
}

Status triangulate(MeshPool& pool, const Form& form, std::vector<OutputVertex>& vertices,
                   std::vector<uint32_t>& indices) {
  std::vector<uint32_t> corners;
  for (uint32_t f = 0; f < meshFaces(pool, form.mesh); ++f) {
    corners.clear();
    if (const Status status = triangulateFace(pool, form, f, corners)) return status;
    const vec3 normal = faceNormal(pool, form, f);
    const Loop all = faceCorners(pool, form.mesh, f);
    const uint32_t first = uint32_t(vertices.size());
    for (uint32_t c = all.firstCorner; c < all.firstCorner + all.corners; ++c) {
      vertices.push_back({framePosition(pool, form, c), normal, cornerUv(pool, form.mesh, 0, c)});
    }
    for (const uint32_t c : corners) {
      indices.push_back(first + c - all.firstCorner);
    }
  }
  return kGeometryOk;
}

} // namespace gpgp::spawn
