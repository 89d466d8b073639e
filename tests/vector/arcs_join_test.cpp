// Joins by arcs: corners of circles, whose outer edges are circles again, so that what a stroke covers is a closed
// form.
#include "oracle.h"
#include "vector/geometry/stroke.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using vector::Cap;
using vector::Join;
using vector::Point;
using vector::Shape;

constexpr double kRadius = 20;

/// A stroke that can be asked for points.
class Stroke {
public:
  Stroke(const Shape& shape, double width, double limit, Join join = Join::Arcs) {
    Shape area;
    EXPECT_TRUE(vector::strokeShape(shape, {width, Cap::Butt, join, limit, {}, 0}, 1e-3, {}, area));
    verbs_.assign(area.verbs.begin(), area.verbs.end());
    for (const Point& p : area.points) {
      points_.push_back(static_cast<float>(p.x));
      points_.push_back(static_cast<float>(p.y));
    }
  }
  bool covers(double x, double y) const {
    const GpgpPath path{verbs_.data(),      static_cast<uint32_t>(verbs_.size()),
                        points_.data(),     static_cast<uint32_t>(points_.size() / 2),
                        GPGP_FILL_NON_ZERO, {0, 0, 0, 1}};
    return PathOracle(path).inside(x, y);
  }

private:
  std::vector<GpgpPathVerb> verbs_;
  std::vector<float> points_;
};

/// Half of a circle's chord at a distance from the centre.
double half(double radius, double distance) { return std::sqrt(radius * radius - distance * distance); }

/// The leaf in which two circles around (0, distance) and (0, -distance) overlap: corners on the axis of x.
Shape leaf(double distance) {
  const double end = half(kRadius, distance), angle = std::atan2(distance, end);
  const double sweep = std::numbers::pi - 2 * angle;
  Shape shape;
  shape.move({end, 0});
  appendArc(shape, {0, -distance}, {kRadius, 0}, {0, kRadius}, angle, sweep, {-end, 0}, 1e-5);
  appendArc(shape, {0, distance}, {kRadius, 0}, {0, kRadius}, angle + std::numbers::pi, sweep, {end, 0}, 1e-5);
  shape.close();
  return shape;
}

TEST(ArcsJoin, EdgesThatBendInwardsGoOnAlongTheirCircles) {
  for (const double distance : {4.0, 10.0, 15.0})
    for (const double h : {1.0, 3.0}) {
      const Stroke stroke(leaf(distance), 2 * h, 100);
      for (double x = 0; x < 40; x += 0.37)
        for (double y = -8; y < 8; y += 0.31) {
          const double far = std::max(std::hypot(x, y - distance), std::hypot(x, y + distance));
          if (std::abs(far - kRadius - h) < 0.01 || far < kRadius + 0.01) continue; // on the edge; inside of the leaf
          EXPECT_EQ(stroke.covers(x, y), far < kRadius + h) << distance << ' ' << h << " at " << x << ' ' << y;
        }
    }
}

/// Down along a circle around (-distance, 0) to where it meets one around (distance, 0), and up along that.
Shape dip(double distance) {
  const double end = half(kRadius, distance), angle = std::atan2(end, distance), sweep = 0.3;
  Shape shape;
  const double first = angle + sweep;
  shape.move({-distance + kRadius * std::cos(first), kRadius * std::sin(first)});
  appendArc(shape, {-distance, 0}, {kRadius, 0}, {0, kRadius}, first, -sweep, {0, end}, 1e-5);
  const double other = std::numbers::pi - angle;
  appendArc(shape, {distance, 0}, {kRadius, 0}, {0, kRadius}, other, -sweep,
            {distance + kRadius * std::cos(other - sweep), kRadius * std::sin(other - sweep)}, 1e-5);
  return shape;
}

TEST(ArcsJoin, EdgesThatBendOutwardsGoOnAlongTheirCircles) {
  for (const double distance : {5.0, 12.0}) {
    const double h = 3, vertex = half(kRadius, distance), tip = half(kRadius - h, distance);
    const Stroke stroke(dip(distance), 2 * h, 100);
    for (double x = -2; x < 2; x += 0.07)
      for (double y = tip - 2; y < vertex; y += 0.09) {
        const double near = std::min(std::hypot(x - distance, y), std::hypot(x + distance, y));
        if (std::abs(near - kRadius + h) < 0.01) continue;
        EXPECT_EQ(stroke.covers(x, y), near > kRadius - h) << distance << " at " << x << ' ' << y;
      }
  }
}

TEST(ArcsJoin, CirclesThatDoNotMeetGrowUntilTheyTouch) {
  constexpr double distance = 16, h = 6; // radii of 14 around centres that are 32 apart
  const double vertex = half(kRadius, distance), grown = (distance - (kRadius - h)) / (1 - distance / kRadius);
  const double tip = -grown * vertex / kRadius;
  ASSERT_LT(tip, vertex - 10);
  const Stroke stroke(dip(distance), 2 * h, 100);
  for (double y = tip + 0.4; y < vertex; y += 0.5) EXPECT_TRUE(stroke.covers(1e-3, y)) << y;
  for (double y = tip - 10; y < tip - 0.02; y += 0.5) EXPECT_FALSE(stroke.covers(1e-3, y)) << y;
}

TEST(ArcsJoin, ALineAndACircle) {
  // Along the axis of x to the origin, then along a circle that begins straight down the page and bends back left.
  Shape shape;
  shape.move({-30, 0});
  shape.line({0, 0});
  appendArc(shape, {-kRadius, 0}, {kRadius, 0}, {0, kRadius}, 0, 1,
            {kRadius * (std::cos(1) - 1), kRadius * std::sin(1)}, 1e-5);
  constexpr double h = 3;
  const Stroke stroke(shape, 2 * h, 100);
  const double tip = -kRadius + half(kRadius + h, h); // where the edge above meets the outer circle
  for (double x = 0.01; x < 6; x += 0.07)
    for (double y = -6; y < -0.01; y += 0.07) {
      const double far = std::hypot(x + kRadius, y);
      if (std::abs(far - kRadius - h) < 0.01 || std::abs(y + h) < 0.01) continue;
      EXPECT_EQ(stroke.covers(x, y), far < kRadius + h && y > -h) << x << ' ' << y;
    }
  EXPECT_TRUE(stroke.covers(tip - 0.05, -h + 0.02));
}

TEST(ArcsJoin, ATipBeyondTheLimitIsCutAcross) {
  constexpr double distance = 16, h = 3, limit = 1.2;
  const double vertex = half(kRadius, distance), tip = half(kRadius + h, distance), cut = vertex + limit * h;
  ASSERT_GT(tip, cut + 0.5);
  const Stroke stroke(leaf(distance), 2 * h, limit);
  for (double y = -1; y <= 1; y += 0.1) { // a straight edge at right angles to the axis
    const double far = std::hypot(cut, std::abs(y) + distance);
    if (std::abs(far - kRadius - h) > 0.1) { // beside where the arcs are cut
      EXPECT_EQ(stroke.covers(cut - 0.02, y), far < kRadius + h) << y;
    }
    EXPECT_FALSE(stroke.covers(cut + 0.02, y)) << y;
  }
  // Within the limit nothing is cut.
  EXPECT_TRUE(Stroke(leaf(distance), 2 * h, (tip - vertex) / h + 0.01).covers(tip - 0.05, 0));
}

TEST(ArcsJoin, LinesHaveMitersThatAreCut) {
  Shape corner;
  corner.move({0, 0});
  corner.line({20, 0});
  corner.line({0, 8});
  for (const double limit : {1.0, 2.0, 3.0, 8.0}) {
    const Stroke arcs(corner, 6, limit), clipped(corner, 6, limit, Join::MiterClip);
    for (double x = -5; x < 60; x += 0.73)
      for (double y = -20; y < 20; y += 0.71) EXPECT_EQ(arcs.covers(x, y), clipped.covers(x, y)) << limit;
  }
}

TEST(ArcsJoin, RandomCornersStayWithinTheLimit) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-50, 50);
  const auto point = [&] { return Point{place(random), place(random)}; };
  for (int i = 0; i < 3000; ++i) {
    Shape shape;
    const Point vertex = point();
    shape.move(point());
    const Point before = i % 7 == 0 ? vertex : point(),
                behind = i % 11 == 0 ? vertex : point(); // controls on the vertex
    if (i % 3 == 1)
      shape.line(vertex);
    else
      shape.cubic(point(), before, vertex);
    if (i % 3 == 2)
      shape.line(point());
    else
      shape.cubic(behind, point(), point());
    if (i % 2) shape.close();
    const double width = i % 5 == 0 ? 40 : 5, limit = 1 + i % 9;
    Shape area, round;
    ASSERT_TRUE(vector::strokeShape(shape, {width, Cap::Butt, Join::Arcs, limit, {}, 0}, 0.01, {}, area));
    ASSERT_TRUE(vector::strokeShape(shape, {width, Cap::Butt, Join::Round, limit, {}, 0}, 0.01, {}, round));
    Point low{1e300, 1e300}, high{-1e300, -1e300};
    for (const Point& p : round.points) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    const double reach = 2 * limit * width; // of tips and of arcs on their way there
    for (const Point& p : area.points) {
      ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y)) << i;
      ASSERT_TRUE(p.x > low.x - reach && p.x < high.x + reach && p.y > low.y - reach && p.y < high.y + reach) << i;
    }
  }
}

} // namespace
