// Skeletons, offsets and roofs by what must hold for them.
#include "shapes.h"
#include "spawn/geometry/vectors.h"

#include <gtest/gtest.h>

namespace gpgp::spawn::test {
namespace {

using namespace shader;

Polygon anyPolygon(Random& random, int i) {
  switch (i % 5) {
  case 0: return random.convex();
  case 1: return random.towers(false);
  case 2: return random.towers(true);
  case 3: return random.grid();
  default: return random.concave();
  }
}

/// Roof faces (of a tag): the sum of their areas seen from above, and the worst departures of what must hold.
struct RoofFaces {
  double plan = 0, slanted = 0, worstAngle = 0, worstPlane = 0, lowestPlan = 0;
  uint32_t count = 0;
};
RoofFaces measureRoof(MeshPool& pool, const Form& form, uint32_t tag, double degrees) {
  RoofFaces r;
  for (uint32_t f = 0; f < faceCount(pool, form); ++f) {
    if (!(faceOf(pool, form.mesh, f).tags & tag)) continue;
    const vec3 n = faceNormal(pool, form, f);
    const double area = faceArea(pool, form, f);
    r.count += 1;
    r.plan += area * n.y;
    r.slanted += area;
    r.lowestPlan = std::min(r.lowestPlan, area * n.y);
    // Slivers have no direction to speak of; their corners must still lie in one plane.
    const Loop all = faceCorners(pool, form.mesh, f);
    double extent = 0, apart = 0;
    for (uint32_t c = 0; c < all.corners; ++c) {
      const glm::dvec3 d(framePosition(pool, form, all.firstCorner + c) - framePosition(pool, form, all.firstCorner));
      extent = std::max(extent, glm::length(d));
      apart = std::max(apart, std::fabs(glm::dot(d, glm::dvec3(n))));
    }
    if (area < 1e-3 * extent * extent) continue;
    r.worstAngle = std::max(r.worstAngle, std::fabs(std::acos(std::min(1.0, double(n.y))) * 57.29577951 - degrees));
    r.worstPlane = std::max(r.worstPlane, apart / extent);
  }
  return r;
}

/// The integral over a polygon of the distance to the nearer end of its extent along z, by Green's theorem.
double tentVolume(const std::vector<std::vector<glm::dvec2>>& loops, double depth) {
  const double half = depth / 2;
  // The integral of min(z, depth - z) from 0 to z.
  const auto whole = [&](double z) { return z < half ? z * z / 2 : half * half - (depth - z) * (depth - z) / 2; };
  double sum = 0;
  for (const auto& loop : loops)
    for (size_t i = 0; i < loop.size(); ++i) {
      const glm::dvec2 a = loop[i], b = loop[(i + 1) % loop.size()];
      const double split = (a.y < half) == (b.y < half) ? 1.0 : (half - a.y) / (b.y - a.y);
      const auto part = [&](double from, double to) { // Simpson's rule: of parabolas exact
        const auto at = [&](double t) { return whole(a.y + (b.y - a.y) * t); };
        return (to - from) / 6 * (at(from) + 4 * at((from + to) / 2) + at(to));
      };
      sum += (part(0, split) + part(split, 1)) * (b.x - a.x);
    }
  return std::fabs(sum);
}

TEST(Roofs, RidgesAlongTheScopeOverOutlinesWithHoles) {
  Random random(77);
  GeometryPool pool;
  double worstVolume = 0, worstArea = 0;
  uint32_t withHoles = 0;
  for (int i = 0; i < 3000; ++i) {
    pool.clear();
    const Polygon p = i % 4 ? random.concave() : random.convex();
    withHoles += p.loops.size() > 1;
    Form form{};
    ASSERT_EQ(makeForm(pool, p, form), kGeometryOk) << i;
    const Scope scope = form.scope;
    std::vector<std::vector<glm::dvec2>> loops;
    for (const auto& loop : p.loops) {
      loops.emplace_back();
      for (const vec2& at : loop) {
        const glm::dvec3 arm = glm::dvec3(at.x, 0, -at.y) - glm::dvec3(scope.origin);
        loops.back().push_back({glm::dot(arm, glm::dvec3(scope.axisX)), glm::dot(arm, glm::dvec3(scope.axisZ))});
      }
    }
    const double degrees = random.between(10, 70), slope = std::tan(degrees / 57.29577951308232);
    ASSERT_EQ(ridgeRoof(pool, form, false, float(degrees)), kGeometryOk) << i;
    EXPECT_TRUE(isClosedSurface(pool, form)) << i;
    const double expected = slope * tentVolume(loops, scope.size.z);
    // Parts of the box under the ridge.
    const double box = p.area() * slope * 0.5 * scope.size.z;
    worstVolume = std::max(worstVolume, std::fabs(volume(pool, form) - expected) / box);
    const RoofFaces top = measureRoof(pool, form, kTagRoofTop, degrees);
    worstArea = std::max(worstArea, std::fabs(top.plan - p.area()) / p.area());
    EXPECT_LT(top.worstAngle, 0.05) << i;
    EXPECT_GE(top.lowestPlan, 0) << i;
  }
  EXPECT_GT(withHoles, 200u);
  EXPECT_LT(worstVolume, 1e-4);
  EXPECT_LT(worstArea, 1e-4);
}

TEST(Roofs, HipsProjectOntoTheOutlineOnce) {
  Random random(21);
  GeometryPool pool;
  for (int i = 0; i < 1500; ++i) {
    pool.clear();
    const Polygon p = anyPolygon(random, i);
    const float angle = random.between(10, 70);
    Form form{};
    ASSERT_EQ(makeForm(pool, p, form), kGeometryOk) << i;
    RoofOptions options;
    options.value = angle;
    ASSERT_EQ(roof(pool, form, options), kGeometryOk) << i;
    const RoofFaces r = measureRoof(pool, form, kTagRoofTop, angle);
    EXPECT_NEAR(r.plan, p.area(), 1e-5 * p.area()) << i;
    EXPECT_NEAR(r.slanted * std::cos(angle / 57.29577951), p.area(), 1e-4 * p.area()) << i;
    EXPECT_LT(r.worstAngle, 0.05) << i;
    EXPECT_LT(r.worstPlane, 1e-4) << i;
    EXPECT_GT(r.lowestPlan, -1e-5) << i;
    EXPECT_LE(r.count, p.corners());
    EXPECT_TRUE(isClosedSurface(pool, form)) << i;
  }
}

TEST(Roofs, KnownRoofs) {
  GeometryPool pool;
  Form form{};
  RoofOptions o;
  o.value = 45;
  ASSERT_EQ(makeForm(pool, rectangle(10, 4), form), kGeometryOk);
  ASSERT_EQ(roof(pool, form, o), kGeometryOk);
  EXPECT_NEAR(form.scope.size.y, 2, 1e-5);
  EXPECT_EQ(faceCount(pool, form), 5u);
  EXPECT_NEAR(volume(pool, form), 4 * 2 / 2 * 6 + 4 * 4 * 2 / 3.0, 1e-4);
  uint32_t counts[4] = {};
  for (uint32_t e = 0; e < componentCount(pool, form, Component::Edges); ++e) {
    const Selector selectors[4] = {Selector::Eave, Selector::Hip, Selector::Valley, Selector::Ridge};
    for (int k = 0; k < 4; ++k) {
      counts[k] += matches(pool, form, Component::Edges, e, selectors[k], {});
    }
  }
  EXPECT_EQ(counts[0], 4u);
  EXPECT_EQ(counts[1], 4u);
  EXPECT_EQ(counts[2], 0u);
  EXPECT_EQ(counts[3], 1u);

  // A gable on each short side: a prism.
  o.kind = Roof::Gable;
  ASSERT_EQ(makeForm(pool, rectangle(10, 4), form), kGeometryOk);
  ASSERT_EQ(roof(pool, form, o), kGeometryOk);
  EXPECT_NEAR(volume(pool, form), 0.5 * 4 * 2 * 10, 1e-3);
  EXPECT_TRUE(isClosedSurface(pool, form));
  EXPECT_EQ(measureRoof(pool, form, kTagRoofSide, 90).count, 2u);
  // Ridge along the edge that is named, in a square too.
  for (const int index : {0, 1}) {
    o.index = index;
    ASSERT_EQ(makeForm(pool, rectangle(4, 4), form), kGeometryOk);
    ASSERT_EQ(roof(pool, form, o), kGeometryOk);
    EXPECT_NEAR(volume(pool, form), 16, 1e-3);
    for (uint32_t f = 0; f < faceCount(pool, form); ++f) {
      if (!(faceOf(pool, form.mesh, f).tags & kTagRoofSide)) continue;
      EXPECT_NEAR(std::fabs(index == 0 ? faceNormal(pool, form, f).x : faceNormal(pool, form, f).z), 1, 1e-5);
    }
  }
  o.index = -1;
  o.byHeight = true;
  o.value = 3;
  ASSERT_EQ(makeForm(pool, shapeOfL(), form), kGeometryOk);
  ASSERT_EQ(roof(pool, form, o), kGeometryOk);
  EXPECT_NEAR(form.scope.size.y, 3, 1e-5);
  EXPECT_TRUE(isClosedSurface(pool, form));
  EXPECT_EQ(measureRoof(pool, form, kTagRoofSide, 90).count, 2u);
  EXPECT_NEAR(measureRoof(pool, form, kTagRoofTop, 0).plan, shapeOfL().area(), 1e-3);

  o = {};
  o.kind = Roof::Shed;
  o.value = 45;
  ASSERT_EQ(makeForm(pool, rectangle(10, 4), form), kGeometryOk);
  ASSERT_EQ(roof(pool, form, o), kGeometryOk);
  EXPECT_NEAR(volume(pool, form), 0.5 * 4 * 4 * 10, 1e-3);
  EXPECT_TRUE(isClosedSurface(pool, form));
  o.kind = Roof::Pyramid;
  ASSERT_EQ(makeForm(pool, rectangle(4, 4), form), kGeometryOk);
  ASSERT_EQ(roof(pool, form, o), kGeometryOk);
  EXPECT_NEAR(volume(pool, form), 16 * 2 / 3.0, 1e-4);
  EXPECT_TRUE(isClosedSurface(pool, form));
  o.kind = Roof::Mansard;
  o.value = 60;
  o.upperAngle = 20;
  o.breakDistance = 0.5f;
  ASSERT_EQ(makeForm(pool, rectangle(10, 4), form), kGeometryOk);
  ASSERT_EQ(roof(pool, form, o), kGeometryOk);
  EXPECT_TRUE(isClosedSurface(pool, form));
  EXPECT_NEAR(form.scope.size.y, 0.5 * std::tan(M_PI / 3) + 1.5 * std::tan(M_PI / 9), 1e-5);
  EXPECT_EQ(measureRoof(pool, form, kTagRoofTop, 0).count, 8u);
  o.value = 90;
  EXPECT_EQ(roof(pool, form, o), kGeometryBadArgument);
}

TEST(Roofs, GablesShedsAndMansardsCoverRandomOutlines) {
  Random random(22);
  GeometryPool pool;
  for (int i = 0; i < 500; ++i) {
    pool.clear();
    const Polygon p = anyPolygon(random, i);
    for (const Roof kind : {Roof::Gable, Roof::Shed, Roof::Mansard}) {
      Form form{};
      ASSERT_EQ(makeForm(pool, p, form), kGeometryOk) << i;
      RoofOptions options;
      options.kind = kind;
      options.value = random.between(20, 60);
      options.index = kind == Roof::Shed ? int(random.below(p.corners())) : -1;
      ASSERT_EQ(roof(pool, form, options), kGeometryOk) << i << " kind " << int(kind);
      const RoofFaces r = measureRoof(pool, form, kTagRoofTop, options.value);
      EXPECT_NEAR(r.plan, p.area(), 2e-5 * p.area()) << i << " kind " << int(kind);
      EXPECT_TRUE(isClosedSurface(pool, form)) << i << " kind " << int(kind);
      if (kind != Roof::Mansard) {
        EXPECT_LT(r.worstAngle, 0.05) << i << " kind " << int(kind);
      }
      const RoofFaces sides = measureRoof(pool, form, kTagRoofSide, 90);
      EXPECT_LT(sides.worstAngle, 0.05) << i;
      // Overhangs only add.
      options.overhangX = options.overhangY = 0.3f;
      ASSERT_EQ(makeForm(pool, p, form), kGeometryOk);
      ASSERT_EQ(roof(pool, form, options), kGeometryOk);
      EXPECT_GT(measureRoof(pool, form, kTagRoofTop, 0).plan, r.plan);
    }
  }
}

TEST(Roofs, OverhangsAreMeasuredOnTheRoof) {
  GeometryPool pool;
  Form form{};
  RoofOptions o;
  o.kind = Roof::Gable;
  o.value = 30;
  o.overhangX = 1;
  o.overhangY = 0.5f;
  ASSERT_EQ(makeForm(pool, rectangle(10, 4), form), kGeometryOk);
  ASSERT_EQ(roof(pool, form, o), kGeometryOk);
  const double slant = 2 / std::cos(M_PI / 6) + 1;
  EXPECT_NEAR(measureRoof(pool, form, kTagRoofTop, 30).slanted, 2 * 11 * slant, 1e-3);
  EXPECT_LT(measureRoof(pool, form, kTagRoofTop, 30).worstAngle, 1e-2);
  EXPECT_LT(measureRoof(pool, form, kTagRoofTop, 30).worstPlane, 1e-5);
}

TEST(Offsets, ConvexOnesHaveTheirClosedForm) {
  Random random(23);
  GeometryPool pool;
  for (int i = 0; i < 500; ++i) {
    pool.clear();
    const Polygon p = random.convex();
    // Outwards, mitred: area + perimeter d + d^2 sum of tan(half of each turn).
    const auto& loop = p.loops[0];
    double tangents = 0;
    for (size_t k = 0; k < loop.size(); ++k) {
      const vec2 a = loop[k], b = loop[(k + 1) % loop.size()], c = loop[(k + 2) % loop.size()];
      const double turn = std::atan2(double(b.x - a.x) * (c.y - b.y) - double(b.y - a.y) * (c.x - b.x),
                                     double(b.x - a.x) * (c.x - b.x) + double(b.y - a.y) * (c.y - b.y));
      tangents += std::tan(turn / 2);
    }
    for (const float d : {0.2f, 1.5f, -0.05f}) {
      Form form{}, border{};
      ASSERT_EQ(makeForm(pool, p, form), kGeometryOk);
      border = form;
      const Status status = offset(pool, form, d, OffsetPart::Inside);
      ASSERT_LE(status, kGeometryEmpty);
      const double expected = p.area() + p.perimeter() * d + d * d * tangents;
      if (d > 0) {
        EXPECT_NEAR(area(pool, form), expected, 1e-4 * expected) << i;
      } else if (status == kGeometryOk && faceCount(pool, form) == 1 && meshCorners(pool, form.mesh) == p.corners()) {
        EXPECT_NEAR(area(pool, form), expected, 1e-4 * p.area()) << i;
      }
      ASSERT_EQ(offset(pool, border, d, OffsetPart::Border), kGeometryOk);
      EXPECT_NEAR(area(pool, border), std::fabs(area(pool, form) - p.area()), 1e-4 * p.area()) << i << " " << d;
    }
  }
}

TEST(Offsets, SetbacksTileTheFace) {
  Random random(24);
  uint32_t unsettled = 0;
  GeometryPool pool;
  for (int i = 0; i < 1500; ++i) {
    pool.clear();
    const Polygon p = anyPolygon(random, i);
    Form form{}, rest{};
    ASSERT_EQ(makeForm(pool, p, form), kGeometryOk);
    std::vector<float> distances(meshCorners(pool, form.mesh));
    for (float& d : distances) {
      d = random.below(3) ? 0.0f : random.below(2) ? 0.5f : random.between(0.1f, 3);
    }
    std::vector<Form> pieces;
    const Status status = setback(pool, form, distances, pieces, rest);
    unsettled += status == kGeometryUnsettled;
    if (status == kGeometryUnsettled) continue; // said, not drawn wrong
    ASSERT_EQ(status, kGeometryOk) << i;
    double sum = area(pool, rest);
    for (size_t k = 0; k < pieces.size(); ++k) {
      sum += area(pool, pieces[k]);
      EXPECT_TRUE(distances[k] > 0 || pieces[k].mesh == 0);
    }
    EXPECT_NEAR(sum, p.area(), 4e-5 * p.area()) << i;
  }
  EXPECT_LE(unsettled, 20u);
}

TEST(Offsets, TaperedExtrusionsAreClosed) {
  Random random(25);
  GeometryPool pool;
  for (int i = 0; i < 500; ++i) {
    pool.clear();
    const Polygon p = anyPolygon(random, i);
    Form form{};
    ASSERT_EQ(makeForm(pool, p, form), kGeometryOk);
    ASSERT_EQ(extrudeTapered(pool, form, 2, random.between(0.1f, 1.5f)), kGeometryOk);
    EXPECT_TRUE(isClosedSurface(pool, form)) << i;
    EXPECT_LT(volume(pool, form), 2 * p.area());
    EXPECT_GT(volume(pool, form), 0);
  }
}

} // namespace
} // namespace gpgp::spawn::test
