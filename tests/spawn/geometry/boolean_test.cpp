// Boolean operations on random polygons and prisms: areas, volumes, and which points are in the result. Areas of
// slices, and assets along texture coordinates.
#include "planar.h"

#include <gtest/gtest.h>

namespace gpgp::spawn::test {
namespace {

Polygon moved(Polygon p, vec2 by) {
  for (auto& loop : p.loops)
    for (vec2& v : loop) v += by;
  return p;
}
bool is(Boolean what, bool a, bool b) {
  return what == Boolean::Union ? a || b : what == Boolean::Difference ? a && !b : a && b;
}
constexpr Boolean kAll[] = {Boolean::Union, Boolean::Difference, Boolean::Intersection};

TEST(Boolean, RandomPolygonsHoldTheRightPoints) {
  Random random(5);
  GeometryPool pool;
  size_t points = 0;
  for (int i = 0; i < 400; ++i) {
    pool.clear();
    const Polygon p = i % 4 ? random.concave(20) : random.grid();
    const Polygon q =
        moved(i % 3 ? random.concave(20) : random.convex(), {random.between(-6, 6), random.between(-6, 6)});
    Form a{}, b{};
    if (makeForm(pool, p, a) || makeForm(pool, q, b)) continue;
    double areas[3] = {};
    for (int k = 0; k < 3; ++k) {
      Form result{};
      const Status status = boolean(pool, a, b, kAll[k], result);
      ASSERT_LE(status, shader::kGeometryEmpty) << i << " " << k;
      if (status == shader::kGeometryEmpty) result.mesh = 0;
      areas[k] = area(pool, result);
      const auto loops = loopsOf(pool, result);
      for (int n = 0; n < 60; ++n) {
        const vec2 at(random.between(-14, 14), random.between(-14, 14));
        if (nearest(p.loops, at) < 1e-3 || nearest(q.loops, at) < 1e-3) continue;
        ++points;
        ASSERT_EQ(holds(loops, at), is(kAll[k], holds(p.loops, at), holds(q.loops, at))) << i << " " << k;
      }
    }
    EXPECT_NEAR(areas[0], p.area() + q.area() - areas[2], 2e-3) << i;
    EXPECT_NEAR(areas[1], p.area() - areas[2], 2e-3) << i;
  }
  EXPECT_GT(points, 50'000u);
}

TEST(Boolean, PrismsHaveTheVolumesOfTheirPlans) {
  Random random(6);
  GeometryPool pool;
  double worst = 0;
  int closed = 0, all = 0;
  for (int i = 0; i < 200; ++i) {
    pool.clear();
    const Polygon p = random.concave(12), q = moved(random.concave(10), {random.between(-5, 5), random.between(-5, 5)});
    Form a{}, b{}, plan{};
    if (makeForm(pool, p, a) || makeForm(pool, q, b)) continue;
    const Status flat = boolean(pool, a, b, Boolean::Intersection, plan);
    ASSERT_LE(flat, shader::kGeometryEmpty);
    const double shared = flat ? 0.0 : double(area(pool, plan)) * 2.5;
    ASSERT_EQ(extrude(pool, a, Extrusion::FaceNormal, 4), shader::kGeometryOk);
    ASSERT_EQ(extrude(pool, b, Extrusion::FaceNormal, 3), shader::kGeometryOk);
    b.scope.origin.y += 1.5f;
    const double expected[3] = {4 * p.area() + 3 * q.area() - shared, 4 * p.area() - shared, shared};
    for (int k = 0; k < 3; ++k) {
      Form result{};
      const Status status = boolean(pool, a, b, kAll[k], result);
      ASSERT_LE(status, shader::kGeometryEmpty) << i << " " << k;
      const double got = status ? 0.0 : double(volume(pool, result));
      ++all;
      if (status || isClosedSurface(pool, result)) {
        ++closed;
        worst = std::max(worst, std::fabs(got - expected[k]));
      }
    }
  }
  EXPECT_LT(worst, 0.02);
  EXPECT_GE(closed, all * 99 / 100) << "of " << all;
}

TEST(Boolean, WhatIsNotSolidOrInOnePlaneIsRefused) {
  GeometryPool pool;
  Form a{}, b{}, result{};
  ASSERT_EQ(makeForm(pool, rectangle(4, 4), a), shader::kGeometryOk);
  b = a;
  b.scope.origin.y = 1;
  EXPECT_EQ(boolean(pool, a, b, Boolean::Union, result), shader::kGeometryNotPlanar);
  ASSERT_EQ(extrude(pool, b, Extrusion::FaceNormal, 2), shader::kGeometryOk);
  EXPECT_EQ(boolean(pool, a, b, Boolean::Union, result), shader::kGeometryBadArgument);
  Form far = a;
  far.scope.origin.x += 10;
  EXPECT_EQ(boolean(pool, a, far, Boolean::Intersection, result), shader::kGeometryEmpty);
  EXPECT_EQ(boolean(pool, a, a, Boolean::Difference, result), shader::kGeometryEmpty);
}

TEST(SplitArea, SlicesHaveTheAreas) {
  Random random(7);
  GeometryPool pool;
  double worst = 0;
  for (int i = 0; i < 300; ++i) {
    pool.clear();
    const Polygon p = i % 2 ? random.concave(20) : random.grid();
    Form form{};
    if (makeForm(pool, p, form)) continue;
    const uint32_t axis = i % 3 ? 0 : 2;
    double at[4] = {0, random.between(0.1f, 0.4f) * p.area(), random.between(0.5f, 0.9f) * p.area(), 2 * p.area()};
    const std::vector<float> places = placesOfAreas(pool, form, axis, at);
    at[3] = p.area();
    for (int k = 0; k < 3; ++k) {
      Form piece{};
      ASSERT_EQ(slice(pool, form, axis, places[k], places[k + 1], true, piece), shader::kGeometryOk) << i;
      worst = std::max(worst, std::fabs(area(pool, piece) - (at[k + 1] - at[k])));
    }
  }
  EXPECT_LT(worst, 2e-3);
}

TEST(InsertAlongUv, CoversWhatTheCoordinatesSay) {
  Random random(8);
  GeometryPool pool;
  const vec3 corners[4] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}};
  const uint32_t order[4] = {0, 1, 2, 3}, sizes[1] = {4};
  Form quad{};
  ASSERT_EQ(makeMesh(pool, corners, order, sizes, {}, quad), shader::kGeometryOk);
  // A flat asset of one square covers the faces whole, wherever the units of the coordinates lie.
  for (int i = 0; i < 50; ++i) {
    Form form{};
    ASSERT_EQ(makeForm(pool, rectangle(random.between(1, 9), random.between(1, 9)), form), shader::kGeometryOk);
    const double whole = area(pool, form);
    const UvProjection map = setupProjection(form, UvAxes::ScopeXZ, random.between(0.4f, 3), random.between(0.4f, 3),
                                             {random.between(-2, 2), random.between(-2, 2)});
    ASSERT_EQ(projectUv(pool, form, 0, map), shader::kGeometryOk);
    ASSERT_EQ(rotateUv(pool, form, 0, random.between(0, 360)), shader::kGeometryOk);
    ASSERT_EQ(insertAlongUv(pool, form, 0, quad, 1, BendAlong::ScopeY, false), shader::kGeometryOk);
    EXPECT_NEAR(area(pool, form), whole, 1e-3 * whole);
    for (uint32_t f = 0; f < faceCount(pool, form); ++f) ASSERT_GT(faceNormal(pool, form, f).y, 0.9f);
  }
  // Around a cylinder along its normals: a shell, whose outside is larger by the angle's tangent.
  Form round{};
  round.scope = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 3, 2}};
  round.scale = vec3(1);
  ASSERT_EQ(insertPrimitive(pool, round, Primitive::Cylinder, 24), shader::kGeometryOk);
  std::vector<uint32_t> sides;
  for (uint32_t f = 0; f < 24; ++f) sides.push_back(f);
  Form wall{};
  ASSERT_EQ(toComponents(pool, round, Component::Faces, sides, wall), shader::kGeometryOk);
  const double before = area(pool, wall);
  ASSERT_EQ(insertAlongUv(pool, wall, 0, quad, 1, BendAlong::VertexNormal, false), shader::kGeometryOk);
  EXPECT_NEAR(area(pool, wall), before, 1e-3 * before);
}

} // namespace
} // namespace gpgp::spawn::test
