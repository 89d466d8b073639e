// Skeletons against CGAL's, on random polygons with holes: the worst distance.
#include "shapes.h"
#include "spawn/geometry/waves.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_with_holes_2.h>
#include <CGAL/create_straight_skeleton_from_polygon_with_holes_2.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

namespace gpgp::spawn::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

CGAL::Polygon_with_holes_2<Kernel> asCgal(const Polygon& polygon) {
  std::vector<CGAL::Polygon_2<Kernel>> loops;
  for (const auto& loop : polygon.loops) {
    CGAL::Polygon_2<Kernel> l;
    for (const vec2& p : loop) {
      l.push_back({p.x, p.y});
    }
    loops.push_back(l);
  }
  return {loops[0], loops.begin() + 1, loops.end()};
}

using Point = glm::dvec3; // x, y, time
using Segment = std::pair<Point, Point>;

double distance(const Point& p, const Segment& s) {
  const Point d = s.second - s.first;
  const double l = glm::dot(d, d), t = l > 0 ? std::clamp(glm::dot(p - s.first, d) / l, 0.0, 1.0) : 0.0;
  return glm::length(s.first + d * t - p);
}
/// How far the farthest end of segments is from the other segments.
double farthest(const std::vector<Segment>& from, const std::vector<Segment>& to) {
  double most = 0;
  for (const auto& [a, b] : from) {
    for (const Point& p : {a, b}) {
      double least = 1e300;
      for (const Segment& s : to) {
        least = std::min(least, distance(p, s));
      }
      most = std::max(most, least);
    }
  }
  return most;
}

// Where many events coincide, a ridge may be one segment of one and two of the other. Towers that are not along the
// axes are left out: skeletons are not continuous, and rounding decides which of such events comes first.
TEST(Cgal, SkeletonsAreTheSame) {
  Random random(41);
  GeometryPool pool;
  double worst = 0;
  size_t segments = 0;
  for (int i = 0; i < 240; ++i) {
    pool.clear();
    const Polygon p = i % 4 == 0 ? random.convex() : i % 4 == 1 ? random.towers(false) : random.concave();
    Form form{};
    ASSERT_EQ(makeForm(pool, p, form), shader::kGeometryOk);
    Waves w;
    ASSERT_EQ(makeWaves(pool, form, 0, {}, -1.0f, false, w), shader::kGeometryOk) << i;
    // The outline's plane has its origin at the first point and x along the first edge.
    const glm::dvec2 origin(p.loops[0][0]), d = glm::normalize(glm::dvec2(p.loops[0][1]) - origin);
    double extent = 0;
    const auto placed = [&](uint32_t node) {
      const vec3 n = w.nodes[node];
      extent = std::max({extent, std::fabs(double(n.x)), std::fabs(double(n.y))});
      return Point(origin.x + d.x * n.x - d.y * n.y, origin.y + d.y * n.x + d.x * n.y, n.z);
    };
    std::vector<Segment> ours, theirs;
    for (const WaveFace& f : w.faces) {
      for (size_t k = 1; k < f.nodes.size(); ++k) {
        ours.emplace_back(placed(f.nodes[k]), placed(f.nodes[(k + 1) % f.nodes.size()]));
      }
    }
    const auto skeleton = CGAL::create_interior_straight_skeleton_2(asCgal(p));
    ASSERT_TRUE(skeleton);
    for (auto e = skeleton->halfedges_begin(); e != skeleton->halfedges_end(); ++e) {
      if (!e->is_bisector()) continue;
      const auto a = e->vertex(), b = e->opposite()->vertex();
      theirs.emplace_back(Point(a->point().x(), a->point().y(), a->time()),
                          Point(b->point().x(), b->point().y(), b->time()));
    }
    const double apart = std::max(farthest(ours, theirs), farthest(theirs, ours)) / extent;
    EXPECT_LT(apart, 2e-5) << i;
    worst = std::max(worst, apart);
    segments += theirs.size();
  }
  std::printf("worst distance of %zu segments: %g of the extent\n", segments, worst);
}

} // namespace
} // namespace gpgp::spawn::test
