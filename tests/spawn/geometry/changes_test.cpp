// Components, scopes, clean-up, texture coordinates, scattering and hulls by what must hold for them.
#include "shapes.h"
#include "spawn/geometry/vectors.h"

#include <gtest/gtest.h>

namespace gpgp::spawn::test {
namespace {

using namespace shader;

struct Changes : testing::Test {
  GeometryPool pool;
  Form form{};

  void box(float x, float y, float z, vec3 at = vec3(0.0f)) {
    form = {};
    form.scope = {at, vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(x, y, z)};
    ASSERT_EQ(insertPrimitive(pool, form, Primitive::Cube), kGeometryOk);
  }
  uint32_t count(Component kind, Selector selector, const Axes& axes = {}) {
    uint32_t found = 0;
    for (uint32_t i = 0; i < componentCount(pool, form, kind); ++i) {
      found += matches(pool, form, kind, i, selector, axes);
    }
    return found;
  }
};

TEST_F(Changes, FacesOfABoxHaveTheirSelectorsAndScopes) {
  box(2, 3, 4);
  for (const Selector s :
       {Selector::Front, Selector::Back, Selector::Left, Selector::Right, Selector::Top, Selector::Bottom}) {
    EXPECT_EQ(count(Component::Faces, s), 1u);
  }
  EXPECT_EQ(count(Component::Faces, Selector::Side), 4u);
  EXPECT_EQ(count(Component::Faces, Selector::Horizontal), 2u);
  EXPECT_EQ(count(Component::Faces, Selector::Vertical), 4u);
  EXPECT_EQ(count(Component::Faces, Selector::Border), 0u);
  EXPECT_EQ(count(Component::Faces, Selector::Inside), 6u);
  EXPECT_EQ(componentCount(pool, form, Component::Edges), 12u);
  EXPECT_EQ(componentCount(pool, form, Component::Vertices), 8u);
  EXPECT_EQ(componentCount(pool, form, Component::FaceEdges), 24u);
  EXPECT_EQ(componentCount(pool, form, Component::Groups), 1u);
  for (uint32_t f = 0; f < 6; ++f) {
    Form face{};
    ASSERT_EQ(toComponent(pool, form, Component::Faces, f, face), kGeometryOk);
    EXPECT_EQ(face.scope.size.z, 0.0f);
    EXPECT_NEAR(inner3(face.scope.axisZ, faceNormal(pool, form, f)), 1, 1e-6);
    EXPECT_NEAR(face.scope.size.x * face.scope.size.y, faceArea(pool, form, f), 1e-5);
    if (std::fabs(face.scope.axisZ.y) < 0.5f) {
      EXPECT_EQ(face.scope.axisY, vec3(0, 1, 0));
      EXPECT_EQ(face.scope.size.y, 3.0f);
    }
    // Where it was.
    EXPECT_NEAR(length3(centroid(pool, face) - vec3(1, 1.5f, 2)),
                face.scope.axisZ.x != 0   ? 1
                : face.scope.axisZ.y != 0 ? 1.5
                                          : 2,
                1e-5);
  }
  Form edge{};
  ASSERT_EQ(toComponent(pool, form, Component::Edges, 0, edge), kGeometryOk);
  EXPECT_EQ(edge.scope.size.y, 0.0f);
  EXPECT_GT(edge.scope.size.x, 1.9f);
  EXPECT_EQ(toComponent(pool, form, Component::Faces, 6, edge), kGeometryBadArgument);
  const uint32_t two[] = {0, 2};
  ASSERT_EQ(toComponents(pool, form, Component::Faces, two, edge), kGeometryOk);
  EXPECT_EQ(faceCount(pool, edge), 2u);
}

TEST_F(Changes, GroupsAndHoles) {
  box(1, 1, 1);
  const Form first = form;
  box(1, 1, 1, vec3(5, 0, 0));
  const Form both[] = {first, form};
  ASSERT_EQ(combine(pool, both, form), kGeometryOk);
  EXPECT_EQ(componentCount(pool, form, Component::Groups), 2u);
  EXPECT_FLOAT_EQ(volume(pool, form), 2.0f);
  Form group{};
  ASSERT_EQ(toComponent(pool, form, Component::Groups, 1, group), kGeometryOk);
  EXPECT_FLOAT_EQ(volume(pool, group), 1.0f);
  EXPECT_EQ(group.scope.origin, vec3(5, 0, 0));
  ASSERT_EQ(makeForm(pool, ring(), form), kGeometryOk);
  EXPECT_EQ(componentCount(pool, form, Component::Holes), 1u);
  Form hole{};
  ASSERT_EQ(toComponent(pool, form, Component::Holes, 0, hole), kGeometryOk);
  EXPECT_FLOAT_EQ(area(pool, hole), 4.0f);
  EXPECT_NEAR(faceNormal(pool, hole, 0).y, 1, 1e-6);
  ASSERT_EQ(deleteHoles(pool, form), kGeometryOk);
  EXPECT_FLOAT_EQ(area(pool, form), 100.0f);
}

TEST_F(Changes, ScopesTurnAndTheGeometryStays) {
  Random random(31);
  for (int i = 0; i < 200; ++i) {
    pool.clear();
    ASSERT_EQ(makeForm(pool, random.concave(), form), kGeometryOk);
    ASSERT_EQ(extrude(pool, form, Extrusion::FaceNormal, 2), kGeometryOk);
    const vec3 middle = centroid(pool, form);
    const float before = volume(pool, form);
    const Axes axes{vec3(random.between(-1, 1), random.between(-1, 1), 1.5f), vec3(0.3f, 2, 0.1f), vec3(0.0f)};
    ASSERT_EQ(alignScope(pool, form, axes), kGeometryOk);
    EXPECT_NEAR(length3(centroid(pool, form) - middle), 0, 1e-4);
    EXPECT_NEAR(volume(pool, form), before, 1e-4 * before);
    ASSERT_EQ(alignScopeToAxes(pool, form, {}, 1), kGeometryOk);
    EXPECT_NEAR(form.scope.axisY.y, 1, 1e-6);
    EXPECT_NEAR(form.scope.size.y, 2, 1e-4);
    ASSERT_EQ(alignScopeToAxes(pool, form, {}), kGeometryOk);
    ASSERT_EQ(mirror(pool, form, AxisX), kGeometryOk);
    EXPECT_NEAR(volume(pool, form), before, 1e-4 * before);
    ASSERT_EQ(alignScopeToGeometryBox(pool, form, 1), kGeometryOk);
    EXPECT_GE(form.scope.size.x, form.scope.size.z * 0.9999f);
    EXPECT_NEAR(volume(pool, form), before, 1e-4 * before);
    ASSERT_EQ(alignScopeToGeometry(pool, form, true, Pick::Largest, 0, Pick::Longest, 0), kGeometryOk);
    EXPECT_NEAR(length3(centroid(pool, form) - centroid(pool, form)), 0, 1e-4);
  }
  box(2, 4, 6);
  resizeScope(form, vec3(4, 4, 3));
  EXPECT_FLOAT_EQ(volume(pool, form), 48.0f);
  const Scope target{vec3(10, 10, 10), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(2, 2, 2)};
  center(form, target, AxisX | AxisZ);
  EXPECT_EQ(centroid(pool, form), vec3(11, 2, 11));
}

TEST_F(Changes, CleanUpJoinsWhatSlicesParted) {
  Random random(32);
  for (int i = 0; i < 300; ++i) {
    pool.clear();
    const Polygon p = random.concave(16);
    ASSERT_EQ(makeForm(pool, p, form), kGeometryOk);
    std::vector<Form> parts;
    for (int k = 0; k < 3; ++k) {
      Form part{};
      if (slice(pool, form, 0, form.scope.size.x * float(k) / 3, form.scope.size.x * float(k + 1) / 3, false, part) ==
          kGeometryOk)
        parts.push_back(part);
    }
    Form joined{};
    ASSERT_EQ(combine(pool, parts, joined), kGeometryOk);
    ASSERT_EQ(cleanup(pool, joined, {true, true, 0.01f}), kGeometryOk);
    EXPECT_NEAR(area(pool, joined), p.area(), 2e-4 * p.area()) << i;
    EXPECT_LE(faceCount(pool, joined), 3u) << i;
    ASSERT_EQ(convexify(pool, form), kGeometryOk);
    EXPECT_NEAR(area(pool, form), p.area(), 1e-4 * p.area()) << i;
    EXPECT_FALSE(isConcave(pool, form)) << i;
  }
  ASSERT_EQ(makeForm(pool, {{{{0, 0}, {5, 0}, {10, 0}, {10, 4}, {0, 4}}}}, form), kGeometryOk);
  ASSERT_EQ(cleanup(pool, form), kGeometryOk);
  EXPECT_EQ(vertexCount(pool, form), 4u);
  ASSERT_EQ(makeForm(pool, {{{{0, 0}, {10, 0.3f}, {9.8f, 4}, {0, 4.2f}}}}, form), kGeometryOk);
  ASSERT_EQ(rectify(pool, form, 10), kGeometryOk);
  EXPECT_TRUE(isRectangular(pool, form));
  ASSERT_EQ(makeForm(pool, shapeOfPlus(), form), kGeometryOk);
  ASSERT_EQ(reduce(pool, form, 0.5f), kGeometryOk);
  EXPECT_EQ(vertexCount(pool, form), 6u);
}

/// A form's faces as loops of one corner list, some of them the other way around.
void rebuild(GeometryPool& pool, const Form& from, Random& random, bool all, Form& form) {
  std::vector<vec3> positions;
  std::vector<uint32_t> corners, sizes;
  for (uint32_t f = 0; f < faceCount(pool, from); ++f) {
    const Loop loop = faceCorners(pool, from.mesh, f);
    const bool isReversed = all || random.below(2);
    for (uint32_t i = 0; i < loop.corners; ++i) {
      corners.push_back(uint32_t(positions.size()));
      positions.push_back(framePosition(pool, from, loop.firstCorner + (isReversed ? loop.corners - 1 - i : i)));
    }
    sizes.push_back(loop.corners);
  }
  ASSERT_EQ(makeMesh(pool, positions, corners, sizes, {}, form), kGeometryOk);
}

TEST_F(Changes, FacesAreTurnedAlike) {
  Random random(5);
  for (int i = 0; i < 300; ++i) {
    pool.clear();
    // Solids: outwards again, however their faces were turned.
    Form solid{}, turned{};
    ASSERT_EQ(makeForm(pool, random.concave(20, false), solid), kGeometryOk);
    ASSERT_EQ(extrude(pool, solid, Extrusion::FaceNormal, 3), kGeometryOk);
    rebuild(pool, solid, random, i % 3 == 0, turned);
    ASSERT_EQ(conformNormals(pool, turned), kGeometryOk);
    EXPECT_TRUE(isClosedSurface(pool, turned)) << i;
    EXPECT_NEAR(volume(pool, turned), volume(pool, solid), 1e-4 * volume(pool, solid)) << i;
    // Without its bottom, and with it alone: the rest is open, and faces up where that is told.
    Form open{}, up{};
    ASSERT_EQ(makeForm(pool, random.concave(20, false), open), kGeometryOk);
    RoofOptions roofs;
    roofs.value = 30;
    ASSERT_EQ(roof(pool, open, roofs), kGeometryOk);
    std::vector<uint32_t> slopes;
    for (uint32_t f = 0; f < faceCount(pool, open); ++f)
      if (faceOf(pool, open.mesh, f).tags & kTagRoofTop) slopes.push_back(f);
    ASSERT_EQ(toComponents(pool, open, Component::Faces, slopes, up), kGeometryOk);
    rebuild(pool, up, random, i % 3 == 0, turned);
    ASSERT_EQ(conformNormals(pool, turned), kGeometryOk);
    for (uint32_t f = 0; f < faceCount(pool, turned); ++f)
      EXPECT_NEAR(faceNormal(pool, turned, f).y, faceNormal(pool, up, f).y, 1e-3) << i << ": " << f;
  }
  // Turned alike, they keep the mesh that they have.
  box(2, 3, 4);
  const uint32_t mesh = form.mesh;
  ASSERT_EQ(conformNormals(pool, form), kGeometryOk);
  EXPECT_EQ(form.mesh, mesh);
}

TEST_F(Changes, WingsInnerRectanglesAndEnvelopes) {
  Form shape{}, rest{};
  ASSERT_EQ(makeForm(pool, rectangle(10, 8), form), kGeometryOk);
  const Form lot = form;
  ASSERT_EQ(shapeWings(pool, lot, 2, 0, 0, 3, shape, rest), kGeometryOk);
  EXPECT_FLOAT_EQ(area(pool, shape) + area(pool, rest), 80.0f);
  EXPECT_FLOAT_EQ(area(pool, rest), 7 * 6);
  EXPECT_EQ(faceCount(pool, shape), 1u);
  ASSERT_EQ(shapeWings(pool, lot, 2, 2, 2, 2, shape, rest), kGeometryOk);
  EXPECT_FLOAT_EQ(area(pool, rest), 6 * 4);
  ASSERT_EQ(makeForm(pool, shapeOfL(), form), kGeometryOk);
  ASSERT_EQ(innerRectangle(pool, form, false, shape), kGeometryOk);
  EXPECT_NEAR(area(pool, shape), 40, 0.01);
  Envelope e;
  e.maxHeight = 10;
  e.baseHeight[0] = 4;
  e.angle[0] = 45;
  form = lot;
  ASSERT_EQ(envelope(pool, form, e), kGeometryOk);
  EXPECT_TRUE(isClosedSurface(pool, form));
  EXPECT_NEAR(volume(pool, form), 10 * (8 * 10 - 0.5 * 6 * 6), 1e-2);
}

TEST_F(Changes, TextureCoordinates) {
  ASSERT_EQ(makeForm(pool, rectangle(10, 4), form), kGeometryOk);
  ASSERT_EQ(projectUv(pool, form, 0, setupProjection(form, UvAxes::ScopeXZ, 0, 0)), kGeometryOk);
  vec2 low, high;
  uvBounds(pool, form, 0, low, high);
  EXPECT_EQ(low, vec2(0, 0));
  EXPECT_NEAR(high.x, 1, 1e-6);
  EXPECT_NEAR(high.y, 1, 1e-6);
  ASSERT_EQ(scaleUv(pool, form, 0, 10, 4), kGeometryOk);
  Form piece{};
  double sum = 0;
  for (int k = 0; k < 5; ++k) {
    ASSERT_EQ(sliceUv(pool, form, 0, 0, float(2 * k), float(2 * k + 2), piece), kGeometryOk);
    EXPECT_NEAR(area(pool, piece), 8, 1e-4);
    sum += area(pool, piece);
    uvBounds(pool, piece, 0, low, high);
    EXPECT_NEAR(low.x, 2 * k, 1e-5);
    EXPECT_NEAR(high.x, 2 * k + 2, 1e-5);
  }
  EXPECT_NEAR(sum, 40, 1e-3);
  ASSERT_EQ(rotateUv(pool, form, 0, 90), kGeometryOk);
  ASSERT_EQ(translateUv(pool, form, 0, 4, 0), kGeometryOk);
  ASSERT_EQ(normalizeUv(pool, form, 0, true, true, false), kGeometryOk);
  uvBounds(pool, form, 0, low, high);
  EXPECT_EQ(low, vec2(0, 0));
  EXPECT_EQ(high, vec2(1, 1));
  ASSERT_EQ(copyUv(pool, form, 0, 3), kGeometryOk);
  EXPECT_EQ(meshUvSets(pool, form.mesh), 9u);
  ASSERT_EQ(deleteUv(pool, form, 0), kGeometryOk);
  EXPECT_EQ(meshUvSets(pool, form.mesh), 8u);
  EXPECT_EQ(projectUv(pool, form, 10, {}), kGeometryBadArgument);
}

TEST_F(Changes, PointsAreUniformByArea) {
  ASSERT_EQ(makeForm(pool, shapeOfL(), form), kGeometryOk);
  uint32_t within = 0;
  for (uint32_t i = 0; i < 4000; ++i) {
    Scope point{}, again{};
    ASSERT_EQ(scatterPoint(pool, form, {}, uvec2(7, 9), i, point), kGeometryOk);
    ASSERT_EQ(scatterPoint(pool, form, {}, uvec2(7, 9), i, again), kGeometryOk);
    EXPECT_EQ(point.origin, again.origin);
    EXPECT_NEAR(point.axisY.y, 1, 1e-6);
    within += point.origin.x < 4;
  }
  EXPECT_NEAR(within / 4000.0, 36 / 60.0, 0.03);
  box(2, 2, 2);
  Scatter how;
  how.domain = ScatterDomain::Volume;
  vec3 sum(0.0f);
  for (uint32_t i = 0; i < 1000; ++i) {
    Scope point{};
    ASSERT_EQ(scatterPoint(pool, form, how, uvec2(1, 2), i, point), kGeometryOk);
    sum = sum + point.origin;
  }
  EXPECT_NEAR(length3(sum * 0.001f - vec3(1.0f)), 0, 0.1);
}

TEST_F(Changes, HullsOfBoxes) {
  box(2, 2, 2);
  const Hull a = makeHull(pool, form);
  box(2, 2, 2, vec3(5, 0, 0));
  const Hull b = makeHull(pool, form);
  EXPECT_NEAR(minimumDistance(a, b), 3, 1e-5);
  EXPECT_FALSE(overlaps(a, b));
  EXPECT_FALSE(touches(a, b));
  box(2, 2, 2, vec3(2, 1, 0));
  const Hull c = makeHull(pool, form);
  EXPECT_TRUE(touches(a, c));
  EXPECT_FALSE(overlaps(a, c));
  box(1, 1, 1, vec3(0.5f, 0.5f, 0.5f));
  const Hull d = makeHull(pool, form);
  EXPECT_TRUE(inside(d, a));
  EXPECT_FALSE(inside(a, d));
  EXPECT_TRUE(overlaps(a, d));
  // An L is not its box.
  ASSERT_EQ(makeForm(pool, shapeOfL(), form), kGeometryOk);
  ASSERT_EQ(extrude(pool, form, Extrusion::FaceNormal, 3), kGeometryOk);
  const Hull l = makeHull(pool, form);
  box(2, 2, 2, vec3(7, 0, -8));
  const Hull notch = makeHull(pool, form);
  EXPECT_FALSE(overlaps(l, notch));
  EXPECT_NEAR(minimumDistance(l, notch), 2, 1e-4);
}

} // namespace
} // namespace gpgp::spawn::test
