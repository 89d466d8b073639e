// Paths to patches: the union of a path's patches is what the fill rule calls inside, and patches do not overlap.
#include "oracle.h"
#include "vector/patch/drawing.h"
#include "vector/raster/segments.h"
#include "vector/shared/curve.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <cmath>
#include <cstring>
#include <ctime>
#include <random>
#include <thread>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using vector::Drawing;

std::pmr::memory_resource* heap() { return std::pmr::get_default_resource(); }

bool contains(const Drawing& d, const vector::PatchRecord& p, float x, float y) {
  return y >= p.top && y < p.bottom && shader::rightOfCurve(d.curves[p.left], x, y, 0) &&
         !shader::rightOfCurve(d.curves[p.right], x, y, 0);
}

struct Verdict {
  size_t tested = 0, wrong = 0, doubled = 0, insideCount = 0;
  double x = 0, y = 0; // of the first wrong one
};

/// Random points, most of them near the path's box, against the oracle; points within float distance of an edge are
/// left out.
Verdict judge(const GpgpPath& path, size_t points, uint32_t seed) {
  auto made = vector::makeDrawing(std::span(&path, 1), heap());
  EXPECT_TRUE(made) << made.error().text;
  if (!made) return {};
  const Drawing& d = *made;
  const PathOracle oracle(path);
  const double slack = oracle.magnitude() * 1.5e-6;
  std::mt19937 random(seed);
  const double w = std::max(oracle.right - oracle.left, slack), h = std::max(oracle.bottom - oracle.top, slack);
  std::uniform_real_distribution<double> xs(oracle.left - 0.05 * w, oracle.right + 0.05 * w),
      ys(oracle.top - 0.05 * h, oracle.bottom + 0.05 * h);
  Verdict v;
  for (size_t i = 0; i < points; ++i) {
    const float x = static_cast<float>(xs(random)), y = static_cast<float>(ys(random));
    if (!oracle.certain(x, y, slack)) continue;
    int count = 0;
    for (const auto& patch : d.patches) count += contains(d, patch, x, y);
    const bool inside = oracle.inside(x, y);
    ++v.tested;
    v.insideCount += inside;
    if ((count > 0) != inside && v.wrong++ == 0) v.x = x, v.y = y;
    v.doubled += count > 1;
  }
  return v;
}

void expectRight(const TestPath& path, size_t points, uint32_t seed = 1) {
  for (const GpgpFillRule rule : {GPGP_FILL_NON_ZERO, GPGP_FILL_EVEN_ODD}) {
    GpgpPath view = path.view();
    view.fillRule = rule;
    const Verdict v = judge(view, points, seed);
    EXPECT_EQ(v.wrong, 0u) << "of " << v.tested << ", rule " << rule << ", seed " << seed << ", first at " << v.x << " "
                           << v.y;
    EXPECT_EQ(v.doubled, 0u) << "of " << v.tested << ", rule " << rule << ", seed " << seed;
    EXPECT_GT(v.tested, points / 4);
  }
}

TestPath randomPath(uint32_t seed, int verbs, int kinds, float snap) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(-100, 100);
  const auto c = [&] {
    const float v = coordinate(random);
    return snap > 0 ? std::round(v / snap) * snap : v;
  };
  TestPath path;
  path.move(c(), c());
  for (int i = 0; i < verbs; ++i) {
    const float a = c(), b = c(), d = c(), e = c(), f = c(), g = c();
    switch (random() % 8) {
    case 0: path.close(), path.move(a, b); break;
    case 1:
    case 2: path.line(a, b); break;
    case 3:
    case 4:
      if (kinds > 1)
        path.quad(a, b, d, e);
      else
        path.line(d, e);
      break;
    default:
      if (kinds > 2)
        path.cubic(a, b, d, e, f, g);
      else
        path.line(f, g);
      break;
    }
  }
  return path;
}

TEST(Patches, SquareIsOnePatch) {
  TestPath path;
  path.move(0, 0).line(10, 0).line(10, 10).line(0, 10).close();
  const GpgpPath view = path.view();
  auto d = vector::makeDrawing(std::span(&view, 1), heap());
  ASSERT_TRUE(d);
  ASSERT_EQ(d->patches.size(), 1u);
  EXPECT_EQ(d->curves.size(), 2u);
  EXPECT_TRUE(contains(*d, d->patches[0], 0, 0)); // half-open: left and top belong to it
  EXPECT_FALSE(contains(*d, d->patches[0], 10, 5));
  EXPECT_FALSE(contains(*d, d->patches[0], 5, 10));
}

TEST(Patches, CircleNeedsFewPatches) {
  TestPath path;
  const float k = 0.5522847f;
  path.move(1, 0)
      .cubic(1, k, k, 1, 0, 1)
      .cubic(-k, 1, -1, k, -1, 0)
      .cubic(-1, -k, -k, -1, 0, -1)
      .cubic(k, -1, 1, -k, 1, 0);
  const GpgpPath view = path.view();
  auto d = vector::makeDrawing(std::span(&view, 1), heap());
  ASSERT_TRUE(d);
  EXPECT_EQ(d->patches.size(), 2u);
  expectRight(path, 20000);
}

TEST(Patches, StarsFollowTheFillRule) {
  TestPath star;
  for (int i = 0; i < 5; ++i) {
    const float a = static_cast<float>(i) * 2 * 2.5132741f;
    i ? star.line(std::sin(a), std::cos(a)) : star.move(std::sin(a), std::cos(a));
  }
  star.close();
  expectRight(star, 20000);
}

TEST(Patches, LoopsCuspsAndInflections) {
  TestPath loop;
  loop.move(0, 0).cubic(100, 80, -80, 80, 20, 0).close();
  expectRight(loop, 20000);
  TestPath cusp;
  cusp.move(0, 0).cubic(50, 50, 0, 50, 50, 0).close();
  expectRight(cusp, 20000);
  TestPath wave;
  wave.move(0, 0).cubic(30, 60, 60, -60, 90, 0).line(90, 50).cubic(60, -10, 30, 110, 0, 50).close();
  expectRight(wave, 20000);
}

TEST(Patches, ControlsOnEndsKeepTheirTangents) {
  // The last curve ends level: its part below the turn has its controls beside the end, as far as rounding goes.
  TestPath path;
  path.move(122, 122).cubic(9, 52, 35, 105, 13, 52).line(64, 13).cubic(0, 122, 122, 122, 122, 122);
  expectRight(path, 20000);
  std::mt19937 random(11);
  std::uniform_int_distribution<int> coordinate(-99, 99);
  const auto c = [&] { return static_cast<float>(coordinate(random)) * 1.37f; };
  for (int i = 0; i < 60; ++i) { // curves of which a control lies on its end, level or upright towards the other one
    TestPath some;
    float x = c(), y = c();
    some.move(x, y);
    for (int k = 0; k < 6; ++k) {
      const float a = c(), b = c(), d = c(), e = c();
      if (k % 3 == 0) some.cubic(d, b, a, b, a, b);
      if (k % 3 == 1) some.cubic(x, y, x, e, a, b);
      if (k % 3 == 2) some.cubic(d, e, a, b, a, b);
      x = a, y = b;
    }
    some.close();
    expectRight(some, 2000, static_cast<uint32_t>(i));
  }
}

TEST(Patches, CoincidentEdges) {
  TestPath twice; // two rectangles that share an edge, one in each direction; a third on top of the first
  twice.move(0, 0).line(10, 0).line(10, 10).line(0, 10).close();
  twice.move(10, 2).line(20, 2).line(20, 8).line(10, 8).close();
  twice.move(0, 0).line(0, 10).line(10, 10).line(10, 0).close();
  twice.move(3, 10).cubic(4, 20, 6, 20, 7, 10).close();
  twice.move(7, 10).cubic(6, 20, 4, 20, 3, 10).close();
  expectRight(twice, 20000);
}

TEST(Patches, DegenerateInputGivesNothing) {
  TestPath path;
  path.move(3, 3).line(3, 3).quad(3, 3, 3, 3).cubic(3, 3, 3, 3, 3, 3).close().move(1, 1).line(5, 1).close();
  path.move(0, 0).cubic(0, 0, 5, 5, 5, 5).close();
  const GpgpPath view = path.view();
  auto d = vector::makeDrawing(std::span(&view, 1), heap());
  ASSERT_TRUE(d);
  // a line there and back: at most slivers without area
  for (const auto& p : d->patches) EXPECT_FALSE(contains(*d, p, 2.5f, 1.5f));
}

TEST(Patches, RandomLines) {
  for (uint32_t seed = 0; seed < 60; ++seed)
    expectRight(randomPath(seed, 3 + seed, 1, seed % 2 ? 10.0f : 0.0f), 2000, seed);
}
TEST(Patches, RandomQuadratics) {
  for (uint32_t seed = 0; seed < 60; ++seed)
    expectRight(randomPath(seed, 3 + seed / 2, 2, seed % 2 ? 10.0f : 0.0f), 2000, seed);
}
TEST(Patches, RandomCubics) {
  for (uint32_t seed = 0; seed < 120; ++seed)
    expectRight(randomPath(seed, 3 + seed / 3, 3, seed % 2 ? 10.0f : 0.0f), 2000, seed);
}

TEST(Patches, FarFromTheOriginAndHuge) {
  TestPath path = randomPath(5, 12, 3, 0);
  for (float& v : path.points) v = v * 50000;
  expectRight(path, 5000);
  path = randomPath(6, 12, 3, 0);
  for (size_t i = 0; i < path.points.size(); ++i) path.points[i] += i % 2 ? 30000.0f : -20000.0f;
  expectRight(path, 5000);
}

TEST(Patches, BadPathsAreRefusedByIndex) {
  TestPath good, bad;
  good.move(0, 0).line(1, 0).line(1, 1);
  for (int kind = 0; kind < 7; ++kind) {
    bad = good;
    GpgpPath view = bad.view();
    std::vector<float> points = bad.points;
    std::vector<GpgpPathVerb> verbs = bad.verbs;
    view.points = points.data();
    view.verbs = verbs.data();
    const char* words = "";
    if (kind == 0) points[3] = NAN, words = "points[1].y";
    if (kind == 1) points[2] = INFINITY, words = "points[1].x";
    if (kind == 2) points[0] = -2e7f, words = "points[0].x";
    if (kind == 3) verbs[2] = 9, words = "verbs[2]";
    if (kind == 4) view.pointCount = 2, words = "pointCount";
    if (kind == 5) verbs[0] = GPGP_PATH_LINE, words = "GPGP_PATH_MOVE";
    if (kind == 6) view.color[1] = 20000, words = "color[1]";
    const GpgpPath both[] = {good.view(), view};
    const auto d = vector::makeDrawing(both, heap());
    ASSERT_FALSE(d) << kind;
    EXPECT_EQ(d.error().code, GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(d.error().text).find("paths[1]"), std::string::npos) << d.error().text;
    EXPECT_NE(std::string(d.error().text).find(words), std::string::npos) << d.error().text;
  }
}

TEST(Patches, HeightsAreFoundAloneAndInPairs) {
  // Monotone cubics of any slope at their ends against 100 halvings of long doubles; off by x or, where steep, by y.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  const double ends[][2] = {{0, 0}, {0, 1}, {1, 0}, {1, 1}, {1e-9, 1}};
  vector::Monotone other;
  double otherY = 0;
  for (int i = 0; i < 20000; ++i) {
    const double w = std::pow(10, 8 * unit(random) - 4), h = std::pow(10, 8 * unit(random) - 4);
    double a = unit(random), b = unit(random), c = unit(random), d = unit(random);
    if (i % 3 == 1) a = ends[i % 5][0], b = ends[i % 5][1];
    if (i % 4 == 1) c = ends[i % 5][0], d = ends[i % 5][1];
    vector::Monotone piece;
    piece.curve = {{{0, 0}, {c * w, a * h}, {d * w, b * h}, {w, h}}};
    const double near = std::pow(10, -12 * unit(random));
    const double y = h * (i % 7 == 0 ? near : i % 7 == 1 ? 1 - near : unit(random));
    long double low = 0, high = 1;
    const auto at = [](long double t, double p1, double p2, double p3) {
      const long double s = 1 - t;
      return 3 * s * s * t * p1 + 3 * s * t * t * p2 + t * t * t * p3;
    };
    for (int k = 0; k < 100; ++k) (at((low + high) / 2, a * h, b * h, h) < y ? low : high) = (low + high) / 2;
    const auto place = piece.placeAt(y);
    const double off = std::abs(static_cast<double>(place.x - at(low, c * w, d * w, w))) / w;
    ASSERT_LT(off / std::max(1.0, std::abs(place.slope) * h / w), 1e-12) << i;
    // In pairs with whatever: bit for bit the same.
    const auto places = vector::placesAt(piece, y, other, otherY);
    const auto xs = vector::xsAt(other, otherY, piece, y);
    ASSERT_EQ(piece.xAt(y), place.x);
    ASSERT_EQ(places[0].x, place.x);
    ASSERT_EQ(places[0].slope, place.slope);
    ASSERT_EQ(xs[1], place.x);
    ASSERT_EQ(xs[0], other.xAt(otherY));
    ASSERT_EQ(places[1].x, xs[0]);
    other = piece, otherY = y;
  }
}

TEST(Patches, CostGrowsAboutLinearly) {
  // The same shape n times beside and below itself in one path: 15 times the curves may take 32 times the time at most,
  // where comparing all pairs would take 235 times. Both sides leave 3 when divided by 7, so that neighbours below
  // each other overlap as often in both.
  const auto make = [](int side) {
    TestPath path;
    for (int i = 0; i < side * side; ++i) {
      const float x = static_cast<float>(i % side) * 10,
                  y = static_cast<float>(i / side) * 10 + static_cast<float>(i % 7);
      path.move(x, y).cubic(x + 9, y, x + 9, y + 9, x, y + 9).cubic(x - 3, y + 6, x + 6, y + 3, x, y).close();
    }
    return path;
  };
  const auto measure = [&](int side) {
    const TestPath path = make(side);
    const GpgpPath view = path.view();
    const std::clock_t start = std::clock(); // of this process, whoever else is running
    const auto d = vector::makeDrawing(std::span(&view, 1), heap());
    EXPECT_TRUE(d);
    EXPECT_GE(d->patches.size(), static_cast<size_t>(side) * side);
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  };
  // Fresh pages cost some machines more than converting does: memory that is given back is used again.
#ifdef M_MMAP_THRESHOLD
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
  measure(24);
  double small = 1e30, large = 1e30; // the best of a few
  for (int i = 0; i < 5; ++i) {
    small = std::min(small, measure(24));
    large = std::min(large, measure(94));
  }
  RecordProperty("microseconds_per_curve", static_cast<int>(large * 1e6 / (94 * 94 * 2)));
  EXPECT_LT(large / small, 32) << small << " s, then " << large << " s";
}

/// n strips that lie aslant beside each other.
TestPath hatching(int n) {
  TestPath path;
  for (int i = 0; i < n; ++i) {
    const float x = static_cast<float>(100.0 * i / n), wide = static_cast<float>(50.0 / n);
    path.move(x, 0).line(x + 100, 200).line(x + 100 + wide, 200).line(x + wide, 0).close();
  }
  return path;
}

TEST(Patches, ManyCurvesBesideEachOtherAreToldApart) {
  TestPath path = hatching(100);
  expectRight(path, 4000);
  for (int i = 0; i < 100; ++i) { // waves, which turn, and rings across both
    const float y = static_cast<float>(i) * 0.5f, r = static_cast<float>(i + 1) * 0.7f;
    path.move(0, y).cubic(60, y + 120, 140, y - 40, 200, y + 100).line(200, y + 100.25f);
    path.cubic(140, y - 39.75f, 60, y + 120.25f, 0, y + 0.25f).close();
    path.move(100 - r, 80).cubic(100 - r, 80 - r, 100 + r, 80 - r, 100 + r, 80);
    path.cubic(100 + r, 80 + r, 100 - r, 80 + r, 100 - r, 80).close();
  }
  expectRight(path, 3000);
}

TEST(Patches, HatchingCostsAboutAsMuchAsItHasLines) {
  // Boxes of slanted lines overlap all over: comparing all that do takes 256 times the time for 16 times the lines.
  const auto measure = [](int n) {
    const TestPath path = hatching(n);
    const GpgpPath view = path.view();
    const std::clock_t start = std::clock();
    const auto d = vector::makeDrawing(std::span(&view, 1), heap());
    EXPECT_TRUE(d);
    EXPECT_EQ(d->patches.size(), static_cast<size_t>(n));
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  };
  double small = 1e30, large = 1e30; // the best of a few
  for (int i = 0; i < 5; ++i) {
    small = std::min(small, measure(500));
    large = std::min(large, measure(8000));
  }
  EXPECT_LT(large / small, 48) << small << " s, then " << large << " s";
}

/// The largest distance of a drawing's curved edges from the circle around 0, after the map that makes it one.
double offCircle(const vector::Drawing& d, double radius, double turn, double ratio) {
  double off = 0;
  for (const auto& c : d.curves) {
    if (c.bend < 0) continue;
    for (int i = 0; i <= 16; ++i) {
      const double t = i / 16.0, u = 1 - t;
      const auto at = [&](double start, double a, double b, double end) {
        return start + 3 * u * u * t * a + 3 * u * t * t * b + t * t * t * end;
      };
      const double x = at(c.ends.x, c.controls.x, c.controls.z, c.ends.z);
      const double y = at(c.ends.y, c.controls.y, c.controls.w, c.ends.w);
      const double p = std::cos(turn) * x + std::sin(turn) * y, q = (std::cos(turn) * y - std::sin(turn) * x) * ratio;
      off = std::max(off, std::abs(std::hypot(p, q) - radius));
    }
  }
  return off;
}

TEST(Patches, ArcsAreWithinATenThousandthOfAPixel) {
  for (const float radius : {3.0f, 70.0f, 300.0f})
    for (const float scale : {0.0f, 0.01f, 8.0f}) {
      TestPath path;
      path.move(radius, 0).add(GPGP_PATH_ARC, {radius, radius, 0, GPGP_ARC_SWEEP, -radius, 0});
      path.add(GPGP_PATH_ARC, {radius, radius, 0, GPGP_ARC_SWEEP, radius, 0}).close();
      GpgpPath view = path.view();
      view.scale = scale;
      const auto d = vector::makeDrawing(std::span(&view, 1), heap());
      ASSERT_TRUE(d) << d.error().text;
      const double bound = 1e-4 / (scale > 0 ? static_cast<double>(scale) : 1.0);
      EXPECT_LE(offCircle(*d, radius, 0, 1), bound + 2e-7 * radius) << radius << " " << scale; // floats
      EXPECT_NEAR(d->bounds[1], -radius, bound + 1e-6 * radius);
      EXPECT_NEAR(d->bounds[3], radius, bound + 1e-6 * radius);
    }
  // An ellipse turned by 30 degrees, the long way and the short way: together they are whole.
  const float x = 40 * std::cos(0.5235988f), y = 40 * std::sin(0.5235988f); // the end of the longer axis
  const float u = -20 * std::sin(0.5235988f), v = 20 * std::cos(0.5235988f);
  const auto area = [&](float flags) {
    TestPath path;
    path.move(x, y).add(GPGP_PATH_ARC, {40, 20, 30, flags, u, v}).close();
    const GpgpPath view = path.view();
    const auto d = vector::makeDrawing(std::span(&view, 1), heap());
    EXPECT_TRUE(d);
    EXPECT_LE(offCircle(*d, 40, 0.5235988, 2), 3e-4) << flags; // the map doubles some of it
    double sum = 0;
    for (float py = -59.75f; py < 60; py += 0.5f)
      for (float px = -59.75f; px < 60; px += 0.5f)
        for (const auto& p : d->patches) sum += contains(*d, p, px, py) ? 0.25 : 0;
    return sum;
  };
  const double whole = 3.14159265 * 40 * 20, quarter = whole / 4 - 40 * 20 / 2;
  EXPECT_NEAR(area(GPGP_ARC_SWEEP), quarter, 3);
  EXPECT_NEAR(area(GPGP_ARC_LARGE), whole - quarter, 10);
  // A radius of 0 makes a line; radii that do not reach grow to half a circle; strokes take arcs as well.
  const auto boundsOf = [&](std::initializer_list<float> arc, const GpgpStroke* stroke) {
    TestPath path;
    path.move(0, 0).add(GPGP_PATH_ARC, arc).line(5, -9).close();
    GpgpPath view = path.view();
    view.stroke = stroke;
    const auto d = vector::makeDrawing(std::span(&view, 1), heap());
    EXPECT_TRUE(d);
    return std::array<float, 4>{d->bounds[0], d->bounds[1], d->bounds[2], d->bounds[3]};
  };
  EXPECT_NEAR(boundsOf({0, 3, 0, 0, 10, 0}, nullptr)[3], 0, 1e-6);
  EXPECT_NEAR(boundsOf({1, 1, 0, 0, 10, 0}, nullptr)[3], 5, 2e-4);
  GpgpStroke stroke{};
  stroke.width = 2;
  EXPECT_NEAR(boundsOf({1, 1, 0, 0, 10, 0}, &stroke)[3], 6, 0.05);
  const auto refused = [](std::initializer_list<float> arc, const char* words) {
    TestPath path;
    path.move(0, 0).add(GPGP_PATH_ARC, arc).close();
    const GpgpPath view = path.view();
    const auto d = vector::makeDrawing(std::span(&view, 1), heap());
    ASSERT_FALSE(d);
    EXPECT_NE(std::string(d.error().text).find(words), std::string::npos) << d.error().text;
  };
  refused({1, 1, 0, 4, 9, 9}, "flags of an arc are 4");
  refused({1, 1, 0, 0.5f, 9, 9}, "flags of an arc are 0.5");
  refused({1e7f, 1, 0, 0, 0, 1e6f}, "reaches beyond");
}

TEST(Patches, StrokesAreFilled) {
  TestPath line;
  line.move(10, 10).line(50, 10).line(50, 40);
  const float dashes[] = {10};
  const auto area = [&](const GpgpStroke& stroke) {
    GpgpPath view = line.view();
    view.fillRule = GPGP_FILL_EVEN_ODD; // does not matter
    view.stroke = &stroke;
    const auto d = vector::makeDrawing(std::span(&view, 1), heap());
    EXPECT_TRUE(d);
    size_t inside = 0;
    for (int y = 0; y < 240; ++y)
      for (int x = 0; x < 280; ++x) {
        int count = 0;
        for (const auto& p : d->patches)
          count += contains(*d, p, static_cast<float>(x) / 4 + 0.13f, static_cast<float>(y) / 4 + 0.13f);
        EXPECT_LE(count, 1);
        inside += count > 0;
      }
    return static_cast<double>(inside) / 16;
  };
  EXPECT_NEAR(area({4, GPGP_CAP_BUTT, GPGP_JOIN_MITER, 0, nullptr, 0, 0, 0}), 4 * 70, 3);
  EXPECT_NEAR(area({4, GPGP_CAP_SQUARE, GPGP_JOIN_BEVEL, 0, nullptr, 0, 0, 0}), 4 * 74 - 2, 3);
  EXPECT_NEAR(area({4, GPGP_CAP_BUTT, GPGP_JOIN_MITER, 0, dashes, 1, 0, 0}), 4 * 40, 3);
  EXPECT_NEAR(area({0, GPGP_CAP_BUTT, GPGP_JOIN_MITER, 0, nullptr, 0, 0, 0.5f}), 2 * 70, 3);
  const GpgpStroke bad{-1, 0, 0, 0, nullptr, 0, 0, 0};
  GpgpPath view = line.view();
  view.stroke = &bad;
  const auto refused = vector::makeDrawing(std::span(&view, 1), heap());
  ASSERT_FALSE(refused);
  EXPECT_EQ(std::string(refused.error().text), "paths[0]: stroke.width is -1; it must be 0 to 1e7");
}

TEST(Patches, AContourGoesOnAtItsStartAfterAClose) {
  const float arc[] = {5, 5, 0, 1, 60, 60};
  const auto drawing = [&](bool moves, bool strokes) {
    TestPath path;
    const auto goOn = [&] {
      if (moves) path.move(10, 10);
    };
    path.move(10, 10).line(50, 10).line(50, 40).close();
    goOn();
    path.line(10, 80).line(30, 80).close();
    goOn();
    path.verbs.push_back(GPGP_PATH_ARC);
    path.points.insert(path.points.end(), std::begin(arc), std::end(arc));
    path.move(100, 10).line(120, 30);
    GpgpPath view = path.view();
    const GpgpStroke stroke{4, GPGP_CAP_BUTT, GPGP_JOIN_MITER, 0, nullptr, 0, 0, 0};
    if (strokes) view.stroke = &stroke;
    return vector::makeDrawing(std::span(&view, 1), heap());
  };
  for (const bool strokes : {false, true}) {
    const auto said = drawing(true, strokes), left = drawing(false, strokes);
    ASSERT_TRUE(said && left);
    ASSERT_GT(said->patches.size(), 4u);
    ASSERT_EQ(left->patches.size(), said->patches.size()) << strokes;
    ASSERT_EQ(left->curves.size(), said->curves.size()) << strokes;
    EXPECT_EQ(std::memcmp(left->curves.data(), said->curves.data(), said->curves.size() * sizeof said->curves[0]), 0);
  }
}

TEST(Patches, JobsChangeNothing) {
  std::vector<TestPath> shapes;
  for (uint32_t seed = 0; seed < 60; ++seed) shapes.push_back(randomPath(seed, 60, 3, 0));
  std::vector<GpgpPath> paths;
  const GpgpGradientStop stops[] = {{0, {1, 0, 0, 1}}, {1, {0, 0, 1, 1}}};
  GpgpGradient gradient{};
  gradient.transform[0] = gradient.transform[3] = 1;
  gradient.end[0] = 100;
  gradient.stops = stops;
  gradient.stopCount = 2;
  for (const TestPath& shape : shapes) {
    paths.push_back(shape.view());
    if (paths.size() % 3 == 0) paths.back().gradient = &gradient;
  }
  struct Pool {
    uint32_t jobs = 0;
  } pool;
  const GpgpJobSystem system{&pool, [](void* user, uint32_t count, GpgpJobFn job, void* argument) {
                               static_cast<Pool*>(user)->jobs += count;
                               std::vector<std::thread> threads;
                               for (uint32_t t = 0; t < 3; ++t)
                                 threads.emplace_back([=] {
                                   for (uint32_t i = t; i < count; i += 3) job(argument, i);
                                 });
                               for (auto& thread : threads) thread.join();
                             }};
  const auto alone = vector::makeDrawing(paths, heap()), together = vector::makeDrawing(paths, heap(), &system);
  ASSERT_TRUE(alone);
  ASSERT_TRUE(together);
  EXPECT_GT(pool.jobs, 2u);
  EXPECT_EQ(vector::bake(*alone, heap()), vector::bake(*together, heap()));
  paths[41].points = nullptr;
  const auto failed = vector::makeDrawing(paths, heap(), &system);
  ASSERT_FALSE(failed);
  EXPECT_EQ(std::string(failed.error().text), "paths[41]: points is NULL");
}

TEST(Patches, EditedPathsGiveTheDrawingOfAllPaths) {
  // With clips in front, a group that fades, gradients and an image: every table has indices into others.
  std::vector<TestPath> shapes;
  for (uint32_t seed = 0; seed < 9; ++seed) shapes.push_back(randomPath(seed, 20, 3, 0));
  const GpgpGradientStop stops[] = {{0, {1, 0, 0, 1}}, {0.5f, {0, 1, 0, 1}}, {1, {0, 0, 1, 0.5f}}};
  GpgpGradient gradient{};
  gradient.transform[0] = gradient.transform[3] = 1;
  gradient.end[0] = 10;
  gradient.stops = stops;
  gradient.stopCount = 3;
  GpgpImagePaint image{2, {10, 0, 0, 10, 0, 0}};
  std::vector<GpgpPath> paths;
  for (size_t i = 1; i < shapes.size(); ++i) {
    paths.push_back(shapes[i].view());
    if (i % 2) paths.back().gradient = &gradient;
    if (i == 4) paths.back().image = &image;
  }
  for (size_t i = 3; i < 6; ++i) paths[i].group = 1;
  const GpgpPath clip = shapes[0].view();
  const std::vector<GpgpPathGroup> groups = {{0, 0.5f, &clip, 1}};
  auto drawing = vector::makeDrawing(paths, groups, heap());
  ASSERT_TRUE(drawing);
  const auto edit = [&](const std::vector<uint32_t>& indices) {
    std::vector<GpgpPathEdit> edits;
    for (const uint32_t i : indices) edits.push_back({i, paths[i]});
    drawing = vector::replacePaths(*drawing, edits, heap());
    ASSERT_TRUE(drawing) << drawing.error().text;
    EXPECT_EQ(vector::bake(*vector::makeDrawing(paths, groups, heap()), heap()), vector::bake(*drawing, heap()));
  };
  const TestPath other = randomPath(99, 40, 3, 0), nothing;
  paths[4] = other.view();
  paths[4].group = 1;
  paths[4].gradient = &gradient; // in place of a plain colour
  edit({4});
  paths[0] = shapes[3].view(); // without the gradient that the other had
  paths[7] = nothing.view();
  edit({0, 7, 0});
  paths[7] = other.view();
  edit({7});
  for (size_t i = 0; i < paths.size(); ++i) paths[i].points = shapes[8].view().points;
  for (size_t i = 0; i < paths.size(); ++i) {
    const GpgpPath all = shapes[8].view();
    paths[i].verbs = all.verbs;
    paths[i].verbCount = all.verbCount;
    paths[i].pointCount = all.pointCount;
  }
  edit({0, 1, 2, 3, 4, 5, 6, 7});
  const GpgpPathEdit beyond{8, paths[0]};
  auto failed = vector::replacePaths(*drawing, std::span(&beyond, 1), heap());
  ASSERT_FALSE(failed);
  EXPECT_STREQ(failed.error().text, "edits[0].index is 8; the drawing has 8 paths");
  GpgpPathEdit bad{5, paths[0]};
  bad.path.fillRule = 7;
  failed = vector::replacePaths(*drawing, std::span(&bad, 1), heap());
  ASSERT_FALSE(failed);
  EXPECT_EQ(std::string(failed.error().text).substr(0, 14), "edits, path 5:") << failed.error().text;
}

TEST(Patches, PrintAsSvg) {
  TestPath path;
  path.move(0, 0).cubic(9, 0, 9, 9, 0, 9).close();
  const GpgpPath view = path.view();
  const auto d = vector::makeDrawing(std::span(&view, 1), heap());
  ASSERT_TRUE(d);
  const std::pmr::string svg = vector::patchesToSvg(std::span(&view, 1), *d, heap());
  size_t count = 0;
  for (size_t at = 0; (at = svg.find("<path", at)) != std::string::npos; ++at) ++count;
  EXPECT_EQ(count, d->patches.size());
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  const auto box = [](const std::pmr::string& stage) { return stage.substr(0, stage.find('\n')); };
  EXPECT_EQ(box(svg), box(vector::pathsToSvg(std::span(&view, 1), heap())));
  EXPECT_EQ(box(svg), box(vector::crossingsToSvg(std::span(&view, 1), heap())));
}

TEST(Patches, BoundsOfZeroAreZero) {
  TestPath path;
  path.move(0, 0).line(3, 0).line(0, 3).close().move(-5, 0).line(0, 0).line(-5, -4).close();
  const GpgpPath view = path.view();
  for (const uint32_t verbs : {4u, 8u}) {
    GpgpPath part = view;
    part.verbCount = verbs;
    part.pointCount = verbs / 4 * 3;
    const auto d = vector::makeDrawing(std::span(&part, 1), heap());
    ASSERT_TRUE(d);
    for (const auto& p : d->patches)
      for (const float v : {p.x0, p.x1}) EXPECT_TRUE(v == 0 || std::isnormal(v)) << v;
    if (verbs == 4) {
      EXPECT_EQ(d->bounds[0], 0.0f);
    }
  }
}

TEST(Baked, ComesBackTheSame) {
  const TestPath a = randomPath(3, 20, 3, 0), b = randomPath(4, 20, 3, 0);
  const GpgpPath views[] = {a.view(), b.view()};
  const auto d = vector::makeDrawing(views, heap());
  ASSERT_TRUE(d);
  const auto bytes = vector::bake(*d, heap());
  const auto back = vector::loadBaked(bytes, heap());
  ASSERT_TRUE(back) << back.error().text;
  EXPECT_EQ(vector::bake(*back, heap()), bytes);
  EXPECT_EQ(back->patches.size(), d->patches.size());
}

TEST(Baked, CurvesFarApartMakeTheSameOutlines) {
  const TestPath path = randomPath(5, 20, 3, 0);
  const GpgpPath view = path.view();
  const auto d = vector::makeDrawing(std::span(&view, 1), heap());
  ASSERT_TRUE(d);
  const auto outlines = vector::makeOutlines(*d, heap());
  ASSERT_GT(outlines.segments.size(), 20u);
  // What a file may say that conversion never does: curves that no patch has, between those of a path.
  Drawing apart = *d;
  const auto half = static_cast<uint32_t>(d->curves.size() / 2);
  constexpr uint32_t kBetween = 1u << 18;
  apart.curves.insert(apart.curves.begin() + half, kBetween, d->curves[0]);
  const auto moved = [&](uint32_t curve) { return curve < half ? curve : curve + kBetween; };
  for (auto& patch : apart.patches) patch.left = moved(patch.left), patch.right = moved(patch.right);
  const auto same = vector::makeOutlines(apart, heap());
  ASSERT_EQ(same.segments.size(), outlines.segments.size());
  EXPECT_EQ(std::memcmp(same.segments.data(), outlines.segments.data(),
                        outlines.segments.size() * sizeof(outlines.segments[0])),
            0);
  // And in many paths: each takes time for its own patches only.
  apart.paths.resize(1u << 16, apart.paths[0]);
  const vector::PatchRecord whole = apart.patches[0];
  for (uint32_t i = 1; i < apart.paths.size(); ++i) {
    apart.patches.push_back(whole);
    apart.patches.back().left = 0;
    apart.patches.back().right = static_cast<uint32_t>(apart.curves.size() - 1);
    apart.patches.back().path = i;
  }
  EXPECT_EQ(vector::makeOutlines(apart, heap()).ends.size(), apart.paths.size());
}

TEST(Baked, GroupsAndImagesComeBackAndAreChecked) {
  const TestPath a = randomPath(3, 20, 3, 0), b = randomPath(4, 20, 3, 0);
  GpgpPath painted = a.view();
  const GpgpImagePaint image{2, {9, 0, 0, 9, 1, 1}};
  painted.image = &image;
  painted.group = 2;
  const GpgpPath clip = b.view();
  const GpgpPathGroup groups[] = {{0, 0.5f, &clip, 1}, {1, 0.25f, &clip, 1}};
  const auto made = vector::makeDrawing(std::span(&painted, 1), groups, heap());
  ASSERT_TRUE(made) << made.error().text;
  ASSERT_EQ(made->paths.size(), 3u);
  EXPECT_EQ(made->paths[2].clip, 2u);
  EXPECT_EQ(made->paths[2].layer, 2u);
  EXPECT_EQ(made->clips[1].parent, 1u);
  const auto alone = vector::makeDrawing(std::span(&painted, 0), groups, heap());
  ASSERT_TRUE(alone);
  EXPECT_EQ(alone->bounds[2], 0); // clips have no ink
  const auto bytes = vector::bake(*made, heap());
  const auto back = vector::loadBaked(bytes, heap());
  ASSERT_TRUE(back) << back.error().text;
  EXPECT_EQ(vector::bake(*back, heap()), bytes);
  const auto refused = [&](auto&& damage) {
    Drawing d = *made;
    damage(d);
    const auto loaded = vector::loadBaked(vector::bake(d, heap()), heap());
    return !loaded && loaded.error().code == GPGP_ERROR_INVALID_DATA;
  };
  EXPECT_TRUE(refused([](Drawing& d) { d.paths[2].clip = 3; }));
  EXPECT_TRUE(refused([](Drawing& d) { d.paths[2].layer = 3; }));
  EXPECT_TRUE(refused([](Drawing& d) { d.paths[0].clip = 1; })); // clipped paths lie behind all clips
  EXPECT_TRUE(refused([](Drawing& d) { d.clips[0].pathCount = 4; }));
  EXPECT_TRUE(refused([](Drawing& d) { d.clips[0].firstPath = UINT32_MAX; }));
  EXPECT_TRUE(refused([](Drawing& d) { d.clips[0].parent = 1; }));
  EXPECT_TRUE(refused([](Drawing& d) { d.clips[1].depth = 1; }));
  EXPECT_TRUE(refused([](Drawing& d) { d.layers[0].opacity = 1; }));
  EXPECT_TRUE(refused([](Drawing& d) { d.layers[1].parent = 2; }));
  EXPECT_TRUE(refused([](Drawing& d) { d.layers[1].depth = 9; }));
  EXPECT_TRUE(refused([](Drawing& d) { d.paints[0].firstStop = GPGP_MAX_IMAGES; }));
  EXPECT_TRUE(refused([](Drawing& d) { d.paints[0].stopCount = 1; }));
}

TEST(Baked, DamagedBytesAreRefused) {
  const TestPath a = randomPath(3, 20, 3, 0);
  const GpgpPath view = a.view();
  const auto d = vector::makeDrawing(std::span(&view, 1), heap());
  ASSERT_TRUE(d);
  const auto bytes = vector::bake(*d, heap());
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    auto damaged = bytes;
    if (i % 3 == 0)
      damaged.resize(random() % bytes.size());
    else
      damaged[random() % bytes.size()] ^= std::byte(1 + random() % 255);
    const auto back = vector::loadBaked(damaged, heap());
    ASSERT_FALSE(back) << i;
    ASSERT_EQ(back.error().code, GPGP_ERROR_INVALID_DATA);
  }
}

TEST(Baked, ContentsAreCheckedBehindARightChecksum) {
  const TestPath a = randomPath(3, 20, 3, 0);
  const GpgpPath view = a.view();
  const auto made = vector::makeDrawing(std::span(&view, 1), heap());
  ASSERT_TRUE(made);
  const auto refused = [&](auto&& damage) {
    Drawing d = *made;
    damage(d);
    const auto back = vector::loadBaked(vector::bake(d, heap()), heap());
    return !back && back.error().code == GPGP_ERROR_INVALID_DATA;
  };
  EXPECT_FALSE(refused([](Drawing&) {}));
  EXPECT_TRUE(refused([](Drawing& d) { d.patches[2].left = static_cast<uint32_t>(d.curves.size()); }));
  EXPECT_TRUE(refused([](Drawing& d) { d.patches[0].right = UINT32_MAX; }));
  // in the table, but beyond what the patches before it account for
  EXPECT_TRUE(refused([](Drawing& d) { d.patches[0].right = static_cast<uint32_t>(d.curves.size() - 1); }));
  EXPECT_TRUE(refused([](Drawing& d) { d.patches[0].path = 1; }));
  EXPECT_TRUE(refused([](Drawing& d) { d.patches[1].top = d.patches[1].bottom; }));
  EXPECT_TRUE(refused([](Drawing& d) { d.patches[1].x0 = NAN; }));
  EXPECT_TRUE(refused([](Drawing& d) { d.curves[1].ends.w = -1; }));
  EXPECT_TRUE(refused([](Drawing& d) { d.curves[1].controls.x = INFINITY; }));
  EXPECT_TRUE(refused([](Drawing& d) { d.paths[0].color.x = 20000; }));
}

} // namespace
