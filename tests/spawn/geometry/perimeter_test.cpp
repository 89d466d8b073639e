// Parts of perimeters that are set back: areas of rectangles in closed form, which points of random convex polygons
// each part has, by distances from the lines of edges, and concave polygons with holes against their mitred offsets.
#include "planar.h"

#include <gtest/gtest.h>

#include <numeric>

namespace gpgp::spawn::test {
namespace {

using namespace shader;

std::vector<uint32_t> wholeChain(MeshPool& pool, const Form& form) {
  std::vector<uint32_t> chain(meshCorners(pool, form.mesh));
  std::iota(chain.begin(), chain.end(), 0u);
  return chain;
}

struct Sides {
  std::vector<Form> pieces;
  Form remainder{};
  Status status = kGeometryOk;
  double areaOf(MeshPool& pool, size_t i) const { return pieces[i].mesh ? area(pool, pieces[i]) : 0.0; }
};
Sides setBack(MeshPool& pool, const Form& form, const std::vector<PerimeterPart>& parts,
              std::vector<uint32_t> chain = {}) {
  Sides sides;
  if (chain.empty()) chain = wholeChain(pool, form);
  sides.status = setbackPerimeter(pool, form, 0, chain, parts, sides.pieces, sides.remainder);
  return sides;
}

/// 10 by 20; edges 0 and 2 are 10 long.
Form rectangle(MeshPool& pool) {
  Form form{};
  EXPECT_EQ(makeForm(pool, Polygon{{{{0, 0}, {10, 0}, {10, 20}, {0, 20}}}}, form), kGeometryOk);
  return form;
}

TEST(Perimeter, PartsOfARectangle) {
  GeometryPool pool;
  const Form form = rectangle(pool);
  // Within the first edge, beside a corner of depth 0, around a corner, and all the rest.
  const Sides s = setBack(pool, form, {{2, 5, 4}, {8, 14, 3}, {14, 58, 1}});
  ASSERT_EQ(s.status, kGeometryOk);
  EXPECT_NEAR(s.areaOf(pool, 0), 12, 1e-4);
  EXPECT_NEAR(s.areaOf(pool, 1), 2 * 3 + 4 * 3 - 2 * 3, 1e-4); // the corner is within both strips
  // A metre along the right side from y = 4 on, the top, the left side down to y = 2.
  EXPECT_NEAR(s.areaOf(pool, 2), 16 + 10 + 18 - 2, 1e-4);
  EXPECT_NEAR(double(area(pool, s.remainder)) + s.areaOf(pool, 0) + s.areaOf(pool, 1) + s.areaOf(pool, 2), 200, 1e-3);
  EXPECT_EQ(faceCount(pool, s.pieces[1]), 1u);
  EXPECT_EQ(meshCorners(pool, s.pieces[1].mesh), 4u); // 2 by 3 at the corner lie within 3 by 4
}

TEST(Perimeter, TheDeeperHasTheOverlapAndOfEqualOnesTheEarlier) {
  GeometryPool pool;
  const Form form = rectangle(pool);
  const auto areas = [&](float first, float second) {
    const Sides s = setBack(pool, form, {{0, 10, first}, {10, 30, second}});
    EXPECT_EQ(s.status, kGeometryOk);
    return std::pair(s.areaOf(pool, 0), s.areaOf(pool, 1));
  };
  EXPECT_NEAR(areas(6, 4).first, 60, 1e-3);
  EXPECT_NEAR(areas(6, 4).second, 4 * 14, 1e-3);
  EXPECT_NEAR(areas(4, 6).first, 4 * 4, 1e-3);
  EXPECT_NEAR(areas(4, 6).second, 120, 1e-3);
  EXPECT_NEAR(areas(5, 5).first, 50, 1e-3);
  EXPECT_NEAR(areas(5, 5).second, 75, 1e-3);
  EXPECT_NEAR(areas(0, 5).second, 100, 1e-3);
  // Deeper than the face: nothing is left.
  const Sides all = setBack(pool, form, {{0, 60, 30}});
  ASSERT_EQ(all.status, kGeometryOk);
  EXPECT_EQ(all.remainder.mesh, 0u);
  EXPECT_NEAR(all.areaOf(pool, 0), 200, 1e-3);
}

TEST(Perimeter, ChainsOfSomeEdgesBeginAgainAtTheirEnd) {
  GeometryPool pool;
  const Form form = rectangle(pool);
  // The long sides alone, the second first: 40 metres.
  const Sides s = setBack(pool, form, {{0, 20, 2}, {35, 45, 3}}, {3, 1});
  ASSERT_EQ(s.status, kGeometryOk);
  EXPECT_NEAR(s.areaOf(pool, 1), 5 * 3 + 5 * 3, 1e-3); // the last 5 metres, and the first 5 again
  EXPECT_NEAR(s.areaOf(pool, 0), 15 * 2, 1e-3);
  EXPECT_EQ(faceCount(pool, s.pieces[1]), 2u);
}

TEST(Perimeter, EdgesKeepTheirTagsAndNewOnesAreTagged) {
  GeometryPool pool;
  Form form = rectangle(pool);
  ASSERT_EQ(tagComponent(pool, form, Component::FaceEdges, 0, kTagStreetFront), kGeometryOk);
  const Sides s = setBack(pool, form, {{0, 10, 4}});
  ASSERT_EQ(s.status, kGeometryOk);
  uint32_t street = 0, made = 0;
  for (uint c = 0; c < meshCorners(pool, s.pieces[0].mesh); ++c) {
    street += (cornerTags(pool, s.pieces[0].mesh, c) & kTagStreetFront) != 0;
    made += (cornerTags(pool, s.pieces[0].mesh, c) & kTagSetback) != 0;
  }
  EXPECT_EQ(street, 1u);
  EXPECT_EQ(made, 1u);
}

TEST(Perimeter, BadArgumentsAreRefused) {
  GeometryPool pool;
  const Form form = rectangle(pool);
  EXPECT_EQ(setBack(pool, form, {{0, 1, NAN}}).status, kGeometryBadArgument);
  EXPECT_EQ(setBack(pool, form, {{0, 1, 1}}, {4}).status, kGeometryBadArgument);
  std::vector<Form> pieces;
  Form rest{};
  EXPECT_EQ(setbackPerimeter(pool, form, 1, {}, {}, pieces, rest), kGeometryBadArgument);
  const Sides none = setBack(pool, form, {});
  ASSERT_EQ(none.status, kGeometryOk);
  EXPECT_NEAR(area(pool, none.remainder), 200, 1e-3);
}

/// Parts one behind the other, of random lengths and depths up to most.
std::vector<PerimeterPart> randomParts(Random& random, float perimeter, float most) {
  std::vector<PerimeterPart> parts;
  float at = random.between(0, perimeter);
  const float end = at + perimeter;
  while (at < end && parts.size() < 12) {
    const float to = std::min(end, at + random.between(0.05f, 0.5f) * perimeter);
    parts.push_back({at, to, random.below(4) ? random.between(0.2f, 1) * most : 0.0f});
    at = to;
  }
  return parts;
}

TEST(Perimeter, PointsOfConvexPolygonsAreInThePartThatTheirDistancesSay) {
  Random random(61);
  GeometryPool pool;
  size_t points = 0, polygons = 0;
  for (int i = 0; i < 400; ++i) {
    pool.clear();
    const Polygon p = random.convex();
    const auto& loop = p.loops[0];
    const size_t n = loop.size();
    // Depths for which a strip never reaches past a whole neighbour, so that distances from lines decide.
    double most = 1e300;
    for (size_t k = 0; k < n; ++k) {
      const vec2 u = glm::normalize(loop[(k + 1) % n] - loop[k]), v = loop[(k + 2) % n] - loop[(k + 1) % n];
      most = std::min({most, double(std::fabs(u.x * v.y - u.y * v.x)), double(std::fabs(u.x * v.y - u.y * v.x))});
      const vec2 w = glm::normalize(v), back = loop[(k + 1) % n] - loop[k];
      most = std::min(most, double(std::fabs(w.x * back.y - w.y * back.x)));
    }
    if (most < 0.05) continue;
    ++polygons;
    Form form{};
    ASSERT_EQ(makeForm(pool, p, form), kGeometryOk);
    const float perimeter = float(p.perimeter());
    const std::vector<PerimeterPart> parts = randomParts(random, perimeter, 0.95f * float(most));
    const Sides s = setBack(pool, form, parts);
    ASSERT_EQ(s.status, kGeometryOk) << i;
    double sum = s.remainder.mesh ? area(pool, s.remainder) : 0;
    for (size_t k = 0; k < parts.size(); ++k) sum += s.areaOf(pool, k);
    EXPECT_NEAR(sum, p.area(), 1e-4 * p.area()) << i;
    // By definition: the strip of a stretch is as wide as the depth; at a corner it reaches to the next edge's line.
    const auto isWithin = [&](const PerimeterPart& part, vec2 q, double& border) {
      bool isIn = false;
      for (const float turn : {-2.0f, -1.0f, 0.0f, 1.0f}) {
        double at = double(turn) * perimeter;
        for (size_t k = 0; k < n; ++k) {
          const glm::dvec2 a(loop[k]), b(loop[(k + 1) % n]), u = glm::normalize(b - a);
          const double length = glm::length(b - a), from = std::max(0.0, part.from - at),
                       to = std::min(length, part.to - at);
          at += length;
          if (to - from < 1e-3) continue;
          const double along = glm::dot(glm::dvec2(q) - a, u), away = u.x * (q.y - a.y) - u.y * (q.x - a.x);
          const bool isLong =
              (from < 1e-5 * perimeter || along > from) && (to > length - 1e-5 * perimeter || along < to);
          border = std::min({border, std::fabs(away - part.depth), std::fabs(along - from), std::fabs(along - to)});
          isIn = isIn || (isLong && away < part.depth);
        }
      }
      return isIn && part.depth > 0;
    };
    std::vector<std::vector<std::vector<vec2>>> loops;
    for (const Form& piece : s.pieces)
      loops.push_back(piece.mesh ? loopsOf(pool, piece) : std::vector<std::vector<vec2>>{});
    for (int k = 0; k < 200; ++k) {
      const vec2 q(random.between(-9, 9), random.between(-9, 9));
      if (!holds(p.loops, q) || nearest(p.loops, q) < 1e-3) continue;
      double border = 1e300;
      size_t best = parts.size();
      for (size_t j = 0; j < parts.size(); ++j)
        if (isWithin(parts[j], q, border) && (best == parts.size() || parts[j].depth > parts[best].depth)) best = j;
      if (border < 2e-3) continue; // at an edge of a strip, where rounding decides
      ++points;
      for (size_t j = 0; j < parts.size(); ++j)
        ASSERT_EQ(holds(loops[j], q), j == best) << i << " " << j << " " << best << " at " << q.x << " " << q.y;
    }
  }
  EXPECT_GT(polygons, 150u);
  EXPECT_GT(points, 10000u);
}

TEST(Perimeter, OneDepthForAllIsAMitredOffset) {
  Random random(62);
  GeometryPool pool;
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    pool.clear();
    const Polygon p = i % 3 ? random.concave() : random.towers(i % 2 == 0);
    Form form{};
    ASSERT_EQ(makeForm(pool, p, form), kGeometryOk);
    const float depth = random.between(0.01f, 0.06f);
    const Sides s = setBack(pool, form, {{0, 1e6f, depth}});
    ASSERT_EQ(s.status, kGeometryOk) << i;
    Form inside = form;
    const Status status = offset(pool, inside, -depth, OffsetPart::Inside);
    ASSERT_LE(status, kGeometryEmpty);
    EXPECT_NEAR(s.areaOf(pool, 0) + area(pool, s.remainder), p.area(), 1e-4 * p.area()) << i;
    // Sharp reflex corners have no mitre here.
    bool isSharp = false;
    for (const auto& loop : p.loops)
      for (size_t k = 0; k < loop.size(); ++k) {
        const vec2 u = glm::normalize(loop[(k + 1) % loop.size()] - loop[k]);
        const vec2 v = glm::normalize(loop[(k + 2) % loop.size()] - loop[(k + 1) % loop.size()]);
        isSharp = isSharp || glm::dot(u, v) < -0.85f;
      }
    if (isSharp) continue;
    ++compared;
    EXPECT_NEAR(area(pool, s.remainder), area(pool, inside), 1e-3 * p.area()) << i;
  }
  EXPECT_GT(compared, 100);
}

TEST(Perimeter, RandomPartsOfConcavePolygonsWithHolesTileThem) {
  Random random(63);
  GeometryPool pool;
  for (int i = 0; i < 400; ++i) {
    pool.clear();
    const Polygon p = i % 3 ? random.concave() : random.towers(true);
    Form form{};
    ASSERT_EQ(makeForm(pool, p, form), kGeometryOk);
    const std::vector<PerimeterPart> parts = randomParts(random, float(p.perimeter()), 3);
    const Sides s = setBack(pool, form, parts);
    ASSERT_EQ(s.status, kGeometryOk) << i;
    double sum = s.remainder.mesh ? area(pool, s.remainder) : 0;
    for (size_t k = 0; k < parts.size(); ++k) {
      sum += s.areaOf(pool, k);
      EXPECT_TRUE(parts[k].depth > 0 || s.pieces[k].mesh == 0);
    }
    EXPECT_NEAR(sum, p.area(), 2e-4 * p.area()) << i;
  }
}

} // namespace
} // namespace gpgp::spawn::test
