// Polygons, primitives, extrusions and splits against closed forms.
#include "shapes.h"

#include <gtest/gtest.h>

namespace gpgp::spawn::test {
namespace {

using namespace shader;

/// |a - b| within a part of b.
void expectNear(double a, double b, double part, const char* what) {
  EXPECT_NEAR(a, b, part * std::max(1e-3, std::fabs(b))) << what;
}

double areaOfTriangles(MeshPool& pool, const Form& form, uint32_t* count = nullptr, double* lowest = nullptr) {
  std::vector<OutputVertex> vertices;
  std::vector<uint32_t> indices;
  EXPECT_EQ(triangulate(pool, form, vertices, indices), kGeometryOk);
  double sum = 0;
  for (size_t i = 0; i + 2 < indices.size(); i += 3) {
    const OutputVertex &a = vertices[indices[i]], &b = vertices[indices[i + 1]], &c = vertices[indices[i + 2]];
    const glm::dvec3 n = glm::cross(glm::dvec3(b.position - a.position), glm::dvec3(c.position - a.position));
    const double area = 0.5 * glm::dot(n, glm::dvec3(a.normal));
    sum += area;
    if (lowest) *lowest = std::min(*lowest, area);
  }
  if (count) *count = uint32_t(indices.size() / 3);
  return sum;
}

TEST(Geometry, PolygonHasItsAreaAndScope) {
  GeometryPool pool;
  Form form{};
  ASSERT_EQ(makeForm(pool, rectangle(10, 4), form), kGeometryOk);
  EXPECT_EQ(form.scope.size, vec3(10, 0, 4));
  EXPECT_EQ(form.scope.origin, vec3(0, 0, -4));
  EXPECT_EQ(form.scope.axisX, vec3(1, 0, 0));
  EXPECT_EQ(form.scope.axisY, vec3(0, 1, 0));
  EXPECT_EQ(area(pool, form), 40.0f);
  EXPECT_TRUE(isRectangular(pool, form));
  EXPECT_TRUE(isPlanar(pool, form));
  EXPECT_FALSE(isConcave(pool, form));
  EXPECT_FALSE(isClosedSurface(pool, form));
  EXPECT_EQ(centroid(pool, form), vec3(5, 0, -2));
  ASSERT_EQ(makeForm(pool, shapeOfL(), form), kGeometryOk);
  EXPECT_TRUE(isConcave(pool, form));
  EXPECT_EQ(cornerAngle(pool, form, 0, 3), 270.0f);
  EXPECT_EQ(cornerAngle(pool, form, 0, 1), 90.0f);
}

TEST(Geometry, BadPolygonsAreErrors) {
  GeometryPool pool;
  Form form{};
  const uint32_t before = pool.used;
  EXPECT_EQ(makeForm(pool, {{{{0, 0}, {4, 4}, {4, 0}, {0, 4}}}}, form), kGeometryNotSimple);
  EXPECT_EQ(makeForm(pool, {{{{0, 0}, {4, 0}}}}, form), kGeometryBadArgument);
  EXPECT_EQ(makeForm(pool, {{{{0, 0}, {4, 0}, {2, 0}}}}, form), kGeometryNotSimple);
  EXPECT_EQ(makeForm(pool, {{{{0, 0}, {9, 0}, {9, 9}, {0, 9}}, {{8, 1}, {8, 3}, {12, 2}}}}, form), kGeometryNotSimple);
  EXPECT_EQ(makeForm(pool, {{{{0, 0}, {9, 0}, {9, 9}, {0, 9}}, {{18, 1}, {18, 3}, {22, 2}}}}, form),
            kGeometryNotSimple);
  EXPECT_EQ(makeForm(pool, {{{{0, 0}, {NAN, 0}, {9, 9}, {0, 9}}}}, form), kGeometryBadArgument);
  const vec3 bent[] = {{0, 0, 0}, {4, 0, 0}, {4, 0, 4}, {0, 3, 4}};
  const uint32_t four[] = {4};
  EXPECT_EQ(makePolygon(pool, bent, four, form), kGeometryNotPlanar);
  Polygon large{{{}}};
  for (int i = 0; i < 2000; ++i) {
    large.loops[0].emplace_back(std::cos(float(i) * 3.14159265e-3f), std::sin(float(i) * 3.14159265e-3f));
  }
  EXPECT_EQ(makeForm(pool, large, form), kGeometryTooLarge);
  EXPECT_EQ(pool.used, before);
  for (Status s = kGeometryEmpty; s <= kGeometryBadArgument; ++s) {
    EXPECT_FALSE(describeStatus(s).empty());
  }
}

TEST(Geometry, AFullPoolSaysWhatWouldHaveFitted) {
  GeometryPool small(64);
  Form form{};
  EXPECT_EQ(makeForm(small, shapeOfPlus(), form), kGeometryNoRoom);
  EXPECT_EQ(small.dropped, 1u);
  GeometryPool fits(small.needed);
  EXPECT_EQ(makeForm(fits, shapeOfPlus(), form), kGeometryOk);
  EXPECT_EQ(fits.used, small.needed);
  GeometryPool narrow(4096, 16);
  EXPECT_EQ(makeForm(narrow, shapeOfPlus(), form), kGeometryTooLarge);
  EXPECT_GT(narrow.workNeeded, 16u);
}

TEST(Geometry, PrimitivesHaveTheirAreaAndVolume) {
  GeometryPool pool;
  Form form{};
  form.scope = {vec3(0.0f), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(2, 3, 4)};
  ASSERT_EQ(insertPrimitive(pool, form, Primitive::Cube), kGeometryOk);
  EXPECT_TRUE(isClosedSurface(pool, form));
  EXPECT_FLOAT_EQ(volume(pool, form), 24.0f);
  EXPECT_FLOAT_EQ(area(pool, form), 52.0f);
  EXPECT_EQ(faceCount(pool, form), 6u);
  EXPECT_EQ(edgeCount(pool, form), 12u);
  EXPECT_EQ(vertexCount(pool, form), 8u);
  EXPECT_EQ(centroid(pool, form), vec3(1, 1.5f, 2));
  for (const uint32_t n : {3u, 4u, 5u, 16u, 64u}) {
    const double base = 0.5 * n * std::sin(2 * M_PI / n) * 1.0 * 2.0; // of an ellipse's corners, half axes 1 and 2
    form.scope.size = vec3(2, 3, 4);
    ASSERT_EQ(insertPrimitive(pool, form, Primitive::Cylinder, n), kGeometryOk);
    EXPECT_TRUE(isClosedSurface(pool, form));
    expectNear(volume(pool, form), 3 * base, 1e-6, "cylinder");
    ASSERT_EQ(insertPrimitive(pool, form, Primitive::Cone, n), kGeometryOk);
    EXPECT_TRUE(isClosedSurface(pool, form));
    expectNear(volume(pool, form), base, 1e-6, "cone");
    ASSERT_EQ(insertPrimitive(pool, form, Primitive::Sphere, n, n), kGeometryOk);
    EXPECT_TRUE(isClosedSurface(pool, form)) << n;
    if (n == 64) {
      expectNear(volume(pool, form), 4.0 / 3.0 * M_PI * 1.0 * 1.5 * 2.0, 4e-3, "sphere");
    }
    ASSERT_EQ(insertPrimitive(pool, form, Primitive::Disk, n), kGeometryOk);
    expectNear(area(pool, form), base, 1e-6, "disk");
    EXPECT_GT(faceNormal(pool, form, 0).y, 0.99f);
  }
  ASSERT_EQ(insertPrimitive(pool, form, Primitive::Quad), kGeometryOk);
  EXPECT_EQ(area(pool, form), 8.0f);
  EXPECT_GT(faceNormal(pool, form, 0).y, 0.99f);
  EXPECT_EQ(insertPrimitive(pool, form, Primitive::Disk, 2), kGeometryBadArgument);
}

TEST(Geometry, TrianglesCoverRandomPolygons) {
  Random random(11);
  GeometryPool pool;
  for (int i = 0; i < 3000; ++i) {
    pool.clear();
    const Polygon p = i % 4 == 0 ? random.grid() : i % 4 == 1 ? random.towers(i % 8 == 1) : random.concave();
    Form form{};
    ASSERT_EQ(makeForm(pool, p, form), kGeometryOk) << i;
    uint32_t count = 0;
    double lowest = 0;
    expectNear(areaOfTriangles(pool, form, &count, &lowest), p.area(), 2e-6, "triangles");
    EXPECT_GT(lowest, -1e-5) << i;
    EXPECT_LE(count, p.corners() + 2 * (uint32_t(p.loops.size()) - 1) - 2);
    expectNear(area(pool, form), p.area(), 2e-6, "area");
  }
}

TEST(Geometry, ExtrusionsHaveTheirVolume) {
  Random random(12);
  GeometryPool pool;
  for (int i = 0; i < 600; ++i) {
    pool.clear();
    const Polygon p = random.concave();
    const float height = random.between(-5, 5);
    Form form{};
    ASSERT_EQ(makeForm(pool, p, form), kGeometryOk);
    ASSERT_EQ(extrude(pool, form, Extrusion::FaceNormal, height), kGeometryOk);
    EXPECT_TRUE(isClosedSurface(pool, form)) << i;
    expectNear(volume(pool, form), p.area() * std::fabs(height), 1e-5, "prism");
    expectNear(area(pool, form), 2 * p.area() + p.perimeter() * std::fabs(height), 1e-5, "prism's faces");
    EXPECT_EQ(faceCount(pool, form), 2 + p.corners());
    EXPECT_NEAR(form.scope.size.y, std::fabs(height), 1e-5);
    // outwards: the sum of volumes has a sign only within, so check a face
    EXPECT_GT(faceNormal(pool, form, height > 0 ? faceCount(pool, form) - 1 : 0).y, 0.99f);
    ASSERT_EQ(makeForm(pool, p, form), kGeometryOk);
    ASSERT_EQ(taper(pool, form, 3), kGeometryOk);
    EXPECT_TRUE(isClosedSurface(pool, form));
    expectNear(volume(pool, form), p.area(), 2e-5, "pyramid");
    ASSERT_EQ(makeForm(pool, p, form), kGeometryOk);
    ASSERT_EQ(extrude(pool, form, Extrusion::Direction, 2, glm::normalize(vec3(1, 1, 0))), kGeometryOk);
    expectNear(volume(pool, form), p.area() * std::sqrt(2.0), 1e-5, "oblique");
    ASSERT_EQ(makeForm(pool, p, form), kGeometryOk);
    ASSERT_EQ(extrude(pool, form, Extrusion::VertexNormal, 2), kGeometryOk);
    EXPECT_TRUE(isClosedSurface(pool, form)) << i;
    expectNear(volume(pool, form), p.area() * 2, 1e-5, "along vertices");
  }
}

TEST(Geometry, SlicesAddUp) {
  Random random(13);
  GeometryPool pool;
  for (int i = 0; i < 1500; ++i) {
    pool.clear();
    const Polygon p = i % 3 == 0 ? random.towers(i % 6 == 0) : i % 3 == 1 ? random.grid() : random.concave();
    Form form{};
    ASSERT_EQ(makeForm(pool, p, form), kGeometryOk);
    const bool solid = i % 2 == 0;
    if (solid) {
      ASSERT_EQ(extrude(pool, form, Extrusion::FaceNormal, 3), kGeometryOk);
    }
    const double whole = solid ? volume(pool, form) : area(pool, form);
    for (const uint32_t axis : {0u, 2u, 1u}) {
      if (axis == 1 && !solid) continue;
      // whole numbers cut along edges and through corners
      const float extent = form.scope.size[int(axis)];
      const uint32_t parts = 1 + random.below(5);
      std::vector<float> at{0.0f};
      for (uint32_t k = 1; k < parts; ++k) {
        at.push_back(i % 2 ? std::floor(extent * float(k) / float(parts)) : extent * float(k) / float(parts));
      }
      at.push_back(extent);
      double sum = 0;
      for (size_t k = 0; k + 1 < at.size(); ++k) {
        Form piece{};
        const Status status = slice(pool, form, axis, at[k], at[k + 1], false, piece);
        ASSERT_LE(status, kGeometryEmpty);
        if (status == kGeometryEmpty) continue;
        EXPECT_NEAR(piece.scope.size[int(axis)], at[k + 1] - at[k], 1e-6);
        if (solid) {
          EXPECT_TRUE(isClosedSurface(pool, piece)) << i << " axis " << axis << " piece " << k;
        }
        sum += solid ? volume(pool, piece) : area(pool, piece);
        expectNear(areaOfTriangles(pool, piece), area(pool, piece), 1e-5, "triangles of a piece");
        const Bounds b = scopeBounds(pool, piece);
        EXPECT_GE(b.low[int(axis)], -1e-5);
        EXPECT_LE(b.high[int(axis)], piece.scope.size[int(axis)] + 1e-5);
      }
      expectNear(sum, whole, 2e-5, "slices");
    }
  }
}

} // namespace
} // namespace gpgp::spawn::test
