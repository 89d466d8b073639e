// The rasteriser on one triangle: coverage against a direct evaluation, the fast forms against the exact one, and edges
// shared by triangles.
#include "visibility/shared/candidate.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace gpgp::shader {
namespace {

struct Random {
  std::mt19937 engine;
  explicit Random(uint32_t seed) : engine(seed) {}
  int operator()(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine); }
};

std::int64_t area(ivec2 a, ivec2 b, ivec2 c) {
  return std::int64_t(b.x - a.x) * (c.y - a.y) - std::int64_t(b.y - a.y) * (c.x - a.x);
}

/// The rule as the specification words it, with plain 64-bit integers.
bool ownsPoint(ivec2 a, ivec2 b, ivec2 c, ivec2 p) {
  const ivec2 v[3] = {a, b, c};
  for (int i = 0; i < 3; ++i) {
    const ivec2 from = v[i], to = v[(i + 1) % 3];
    const std::int64_t side = area(from, to, p);
    const bool top = from.y == to.y && to.x > from.x, left = to.y < from.y;
    if (side < 0 || (side == 0 && !top && !left)) return false;
  }
  return true;
}

bool orient(ivec2& a, ivec2& b, ivec2& c) {
  if (area(a, b, c) < 0) std::swap(b, c);
  return area(a, b, c) > 0;
}

TEST(Raster, CoverageIsTheFillRuleExactly) {
  Random random(1);
  const Grid viewport = middleGrid(ivec2(64, 48), 8);
  int covered = 0;
  for (int n = 0; n < 3000; ++n) {
    const int reach = n % 3 == 0 ? 256 : n % 3 == 1 ? 16384 : 64 * 128 * 6;
    const int grid = n % 2 ? 1 : 128; // on half pixels many centres lie on edges
    ivec2 a(random(-reach, reach) / grid * grid, random(-reach, reach) / grid * grid);
    ivec2 b(random(-reach, reach) / grid * grid, random(-reach, reach) / grid * grid);
    ivec2 c(random(-reach, reach) / grid * grid, random(-reach, reach) / grid * grid);
    a += ivec2(4096, 4096), b += ivec2(4096, 4096), c += ivec2(4096, 4096);
    if (!orient(a, b, c)) continue;
    const ScreenTriangle t = makeTriangle(a, b, c, 0.25f, 0.5f, 0.75f, viewport);
    for (int y = 0; y < viewport.pixels.y; ++y)
      for (int x = 0; x < viewport.pixels.x; ++x) {
        const bool inBounds = x >= t.bounds.x && y >= t.bounds.y && x < t.bounds.z && y < t.bounds.w;
        const bool expected = ownsPoint(a, b, c, ivec2(x * 256 + 128, y * 256 + 128));
        ASSERT_EQ(coversWide(t, 0, samplePoint(ivec2(x, y), viewport)), expected) << n << ": " << x << ", " << y;
        ASSERT_TRUE(inBounds || !expected) << n;
        covered += expected;
      }
  }
  EXPECT_GT(covered, 100000);
}

TEST(Raster, CompactAndBlockFormsEqualTheExactOne) {
  Random random(2);
  const Grid viewport = middleGrid(ivec2(8192, 8192), 8);
  for (int n = 0; n < 20000; ++n) {
    const bool compact = n % 2 == 0;
    const int reach = compact ? 8192 : 3 * 8192 * 256;
    const ivec2 centre(random(0, 8192 * 256), random(0, 8192 * 256));
    ivec2 a = centre + ivec2(random(-reach, reach), random(-reach, reach));
    ivec2 b = centre + ivec2(random(-reach, reach), random(-reach, reach));
    ivec2 c = centre + ivec2(random(-reach, reach), random(-reach, reach));
    if (!orient(a, b, c)) continue;
    const ScreenTriangle t = makeTriangle(a, b, c, 0.1f, 0.9f, 0.3f, viewport);
    if (isEmpty(t)) continue;
    const ivec2 corner(random(t.bounds.x, t.bounds.z - 1), random(t.bounds.y, t.bounds.w - 1));
    const ivec2 s0 = edgeSlope(b, c), s1 = edgeSlope(c, a), s2 = edgeSlope(a, b);
    const int margin = marginOf(t, n % 3 == 0 ? 0 : kMargin);
    const int e0 = edgeBlock(b, s0, corner, viewport, margin), e1 = edgeBlock(c, s1, corner, viewport, margin),
              e2 = edgeBlock(a, s2, corner, viewport, margin);
    bool any = false;
    for (int j = 0; j < 8; ++j)
      for (int i = 0; i < 8; ++i) {
        const ivec2 pixel = corner + ivec2(i, j);
        const bool expected = coversWide(t, margin, samplePoint(pixel, viewport));
        const bool block =
            e0 + s0.x * i + s0.y * j >= 0 && e1 + s1.x * i + s1.y * j >= 0 && e2 + s2.x * i + s2.y * j >= 0;
        ASSERT_EQ(block, expected);
        any |= expected;
        if (!isCompact(t) || pixel.x >= t.bounds.z || pixel.y >= t.bounds.w) continue;
        float z = -1;
        ASSERT_EQ(coversCompact(t, margin, samplePoint(pixel, viewport), z), expected);
        if (expected) {
          ASSERT_EQ(floatBitsToUint(z), floatBitsToUint(depthWide(t, samplePoint(pixel, viewport))));
        }
      }
    if (blockOutside(e0, s0, 8) || blockOutside(e1, s1, 8) || blockOutside(e2, s2, 8)) {
      ASSERT_FALSE(any);
    }
  }
}

/// Which samples of a pixel's row a triangle covers.
std::uint64_t samplesOfRow(const ScreenTriangle& t, ivec2 pixel, int row) {
  const uvec2 half = samplesIn(outlineOf(makeCandidate(t, unitCorners(t), 0), pixel, 64), row);
  return std::uint64_t(half.y) << 32 | half.x;
}

/// Where a triangle's margin may reach: the triangle scaled by 1 + sqrt(2) / 16 about the middle of its in-circle.
bool isWithinMargin(const ivec2 (&corners)[3], int y) {
  double side[3], around = 0, middle = 0, low = 1e30, high = -1e30;
  for (int i = 0; i < 3; ++i) {
    const ivec2 edge = corners[(i + 2) % 3] - corners[(i + 1) % 3];
    side[i] = std::hypot(edge.x, edge.y);
    around += side[i];
    middle += side[i] * corners[i].y;
  }
  middle /= around;
  for (const ivec2& c : corners) {
    const double scaled = middle + (c.y - middle) * 1.0884;
    low = std::min(low, scaled), high = std::max(high, scaled);
  }
  return y >= low - 0.02 && y <= high + 0.02; // a line is rounded once
}

// Floats decide them: each end of a row may be a sample off. Rows that the triangle and its margin do not reach have
// none, and two triangles without margins share none. Corners often lie on samples, and edges are often horizontal.
TEST(Raster, RowsOfSamplesAreTheTriangleButForTheirEnds) {
  Random random(7);
  const Grid viewport = middleGrid(ivec2(64, 64), 8);
  const ivec2 pixel(31, 33);
  int covered = 0, wrong = 0, apart = 0;
  for (int n = 0; n < 6000; ++n) {
    const int reach = n % 3 == 0 ? 200 : n % 3 == 1 ? 2000 : 200000, step = n % 2 ? 1 : 4;
    const auto corner = [&] {
      const ivec2 from(random(-reach, reach) / step, random(-reach, reach) / step);
      return pixel * 256 + ivec2(2, 2) + from * step + ivec2(128, 128) / step * step;
    };
    ivec2 a = corner(), b = corner(), c = corner();
    const ivec2 d = corner();
    if (n % 5 == 0) b.y = a.y;
    if (!orient(a, b, c) || area(b, a, d) <= 0) continue;
    const ScreenTriangle t = makeTriangle(a, b, c, 0, 0, 0, viewport);
    const ScreenTriangle beside = makeTriangle(b, a, d, 0, 0, 0, viewport);
    const int margin = marginOf(t, kMargin), margins = margin + marginOf(beside, kMargin);
    for (int row = 0; row < 64; ++row) {
      std::uint64_t exact = 0;
      for (int column = 0; column < 64; ++column)
        if (coversWide(t, margin, pixel * 256 + ivec2(column, row) * 4 + ivec2(2, 2)))
          exact |= std::uint64_t(1) << column;
      const std::uint64_t samples = samplesOfRow(t, pixel, row);
      ASSERT_LE(std::popcount(samples ^ exact), 2) << n << ": " << row;
      if (margins == 0) {
        ASSERT_EQ(samples & samplesOfRow(beside, pixel, row), 0u) << n << ": " << row;
        ++apart;
      }
      const int y = pixel.y * 256 + row * 4 + 2;
      if (!isWithinMargin({a, b, c}, y)) {
        ASSERT_EQ(samples, 0u) << n << ": " << row;
      }
      covered += std::popcount(exact);
      wrong += std::popcount(samples ^ exact);
    }
  }
  EXPECT_GT(covered, 1000000);
  EXPECT_LT(wrong, covered / 1000);
  EXPECT_GT(apart, 500);
}

// A vertex on an edge: snapping moves all three, and what lies between them belongs to none without margins.
TEST(Raster, VerticesOnEdgesLeaveNoCrack) {
  Random random(11);
  const Grid viewport = middleGrid(ivec2(64, 64), 8);
  const ivec2 pixel(31, 33);
  int cracks = 0;
  for (int n = 0; n < 4000; ++n) {
    // A line through the pixel: its ends, two vertices on it and two corners beside it, before they snap.
    const double angle = random(0, 1 << 20) * 6e-6, x = random(0, 1 << 20) * 0x1p-12, y = random(0, 1 << 20) * 0x1p-12;
    const auto at = [&](double along, double beside) {
      const double u = along * std::cos(angle) - beside * std::sin(angle) + x;
      const double v = along * std::sin(angle) + beside * std::cos(angle) + y;
      return pixel * 256 + ivec2(static_cast<int>(std::floor(u + 0.5)), static_cast<int>(std::floor(v + 0.5)));
    };
    const double from = -random(400, 4000), to = random(400, 4000);
    const double first = from + random(1, 99) * 0.01 * (to - from),
                 second = first + random(1, 99) * 0.01 * (to - first);
    const ivec2 a = at(from, 0), b = at(to, 0), m = at(first, 0), k = at(second, 0), up = at(0, -9000),
                down = at(0, 9000), left = at(-9000, 0), right = at(9000, 0);
    std::vector<ScreenTriangle> all;
    const auto add = [&](ivec2 p, ivec2 q, ivec2 r) {
      if (wideSign(twiceArea(p, q, r)) > 0) all.push_back(makeTriangle(p, q, r, 0, 0, 0, viewport));
    };
    add(a, b, down), add(a, down, left), add(b, right, down); // one side in one piece
    add(a, up, m), add(m, up, k), add(k, up, b), add(a, left, up), add(b, up, right);
    for (int row = 0; row < 64; ++row) {
      std::uint64_t samples = 0, exact = 0, plain = 0;
      for (const ScreenTriangle& t : all) {
        samples |= samplesOfRow(t, pixel, row);
        for (int column = 0; column < 64; ++column) {
          const ivec2 point = pixel * 256 + ivec2(column, row) * 4 + ivec2(2, 2);
          exact |= std::uint64_t(coversWide(t, marginOf(t, kMargin), point)) << column;
          plain |= std::uint64_t(coversWide(t, 0, point)) << column;
        }
      }
      ASSERT_EQ(samples, ~std::uint64_t(0)) << n << ": " << row;
      ASSERT_EQ(exact, ~std::uint64_t(0)) << n << ": " << row;
      cracks += plain != ~std::uint64_t(0);
    }
  }
  EXPECT_GT(cracks, 1000);
}

// The same three corners, and their depths, are the same triangle whichever comes first.
TEST(Raster, DepthDoesNotDependOnTheFirstCorner) {
  Random random(12);
  const Grid viewport = middleGrid(ivec2(64, 64), 8);
  for (int n = 0; n < 2000; ++n) {
    ivec2 a(random(0, 16384), random(0, 16384)), b(random(0, 16384), random(0, 16384)),
        c(random(0, 16384), random(0, 16384));
    if (n % 4 == 0) b.y = a.y;
    if (n % 4 == 1) c.x = a.x;
    if (!orient(a, b, c)) continue;
    const float x = float(random(0, 1000)) / 1001, y = float(random(0, 1000)) / 1001, z = float(random(0, 1000)) / 1001;
    const ScreenTriangle t = makeTriangle(a, b, c, x, y, z, viewport);
    for (const ScreenTriangle& other :
         {makeTriangle(b, c, a, y, z, x, viewport), makeTriangle(c, a, b, z, x, y, viewport)})
      for (int i = 0; i < 64; ++i) {
        const ivec2 point(random(0, 16384), random(0, 16384));
        ASSERT_EQ(floatBitsToUint(depthWide(t, point)), floatBitsToUint(depthWide(other, point))) << n;
      }
  }
}

TEST(Raster, DepthIsTheMixOfTheCornersDepths) {
  Random random(3);
  const Grid viewport = middleGrid(ivec2(2048, 2048), 8);
  double worst = 0;
  for (int n = 0; n < 2000; ++n) {
    const int reach = n % 4 == 0 ? 300000 : 3000;
    const ivec2 centre(random(0, 2048 * 256), random(0, 2048 * 256));
    ivec2 a = centre + ivec2(random(-reach, reach), random(-reach, reach));
    ivec2 b = centre + ivec2(random(-reach, reach), random(-reach, reach));
    ivec2 c = centre + ivec2(random(-reach, reach), random(-reach, reach));
    if (!orient(a, b, c)) continue;
    const float z[3] = {float(random(0, 1000)) / 1000, float(random(0, 1000)) / 1000, float(random(0, 1000)) / 1000};
    const ScreenTriangle t = makeTriangle(a, b, c, z[0], z[1], z[2], viewport);
    for (int k = 0; k < 50 && !isEmpty(t); ++k) {
      const ivec2 pixel(random(t.bounds.x, t.bounds.z - 1), random(t.bounds.y, t.bounds.w - 1));
      if (!coversWide(t, 0, samplePoint(pixel, viewport))) continue;
      const ivec2 p(pixel.x * 256 + 128, pixel.y * 256 + 128);
      const double total = double(area(a, b, c));
      const double exact =
          (double(area(b, c, p)) * z[0] + double(area(c, a, p)) * z[1] + double(area(a, b, p)) * z[2]) / total;
      worst = std::max(worst, std::abs(exact - double(depthWide(t, samplePoint(pixel, viewport)))));
    }
  }
  EXPECT_LT(worst, 4e-7);
}

TEST(Raster, SnappingRoundsToTheNearestAndStaysInTheGuard) {
  for (const int pixels : {1, 17, 1080, 8192}) {
    EXPECT_EQ(snap(-1.0f, pixels), 0);
    EXPECT_EQ(snap(0.0f, pixels), pixels * 128);
    EXPECT_EQ(snap(1.0f, pixels), pixels * 256);
    EXPECT_EQ(snap(7.5f, pixels), pixels * 128 * 8);
    EXPECT_EQ(snap(-7.5f, pixels), -pixels * 128 * 6);
    const float unit = 1.0f / float(pixels * 128); // of the grid
    EXPECT_EQ(snap(-1.0f + 1.4f * unit, pixels), 1);
    EXPECT_EQ(snap(-1.0f + 1.6f * unit, pixels), 2);
    EXPECT_EQ(snap(-1.0f - 1.4f * unit, pixels), -1);
    EXPECT_EQ(snap(-1.0f - 1.6f * unit, pixels), -2);
  }
}

TEST(Raster, FinePlacesLieInTheirUnit) {
  Random random(3);
  for (const int pixels : {1, 17, 960, 8192})
    for (int n = 0; n < 20000; ++n) {
      const float at = float(random(-3 << 20, 3 << 20)) / float(1 << 20);
      const int fine = snapFinely(at, pixels), unit = snap(at, pixels);
      ASSERT_EQ(nearestUnit({fine, fine}).x, unit) << at << ", " << pixels;
      const double exact = (double(at) + 1) * pixels * 128 * kFine;
      ASSERT_LE(std::abs(exact - fine), 1 + pixels / 256.0) << at << ", " << pixels;
    }
}

TEST(Raster, DepthKeysAreOrderedNearestFirst) {
  const float depths[] = {0.0f, 1e-30f, 0.25f, 0.5f, 0.999999f, 1.0f};
  for (size_t i = 1; i < std::size(depths); ++i) {
    EXPECT_LT(depthKey(depths[i - 1], false), depthKey(depths[i], false));
    EXPECT_GT(depthKey(depths[i - 1], true), depthKey(depths[i], true));
  }
}

// A star of triangles round a point on the grid covers each pixel centre of its polygon exactly once, wherever the
// spokes run; half the cases have spokes that go exactly through centres.
TEST(Raster, SharedEdgesAreHitExactlyOnce) {
  Random random(4);
  const Grid viewport = middleGrid(ivec2(48, 48), 8);
  for (int n = 0; n < 400; ++n) {
    const int grid = n % 2 ? 1 : 128;
    const ivec2 hub(random(5000, 7000) / grid * grid, random(5000, 7000) / grid * grid);
    std::vector<ivec2> rim;
    const int spokes = random(3, 12);
    for (int i = 0; i < spokes; ++i) { // clockwise with y down
      const double angle = 2 * 3.14159265 * i / spokes + 0.01 * n;
      const double radius = random(1000, 5000);
      rim.push_back(hub +
                    ivec2(int(radius * std::cos(angle)) / grid * grid, int(radius * std::sin(angle)) / grid * grid));
    }
    std::vector<int> hits(48 * 48, 0);
    bool proper = true;
    for (int i = 0; i < spokes; ++i) {
      const ivec2 a = rim[static_cast<size_t>(i)], b = rim[static_cast<size_t>((i + 1) % spokes)];
      if (area(hub, a, b) <= 0) proper = false;
      if (!proper) break;
      const ScreenTriangle t = makeTriangle(hub, a, b, 0.5f, 0.5f, 0.5f, viewport);
      for (int y = t.bounds.y; y < t.bounds.w; ++y)
        for (int x = t.bounds.x; x < t.bounds.z; ++x)
          hits[static_cast<size_t>(y * 48 + x)] += coversWide(t, 0, samplePoint(ivec2(x, y), viewport));
    }
    if (!proper) continue;
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 48; ++x) {
        // Winding number of the rim with half-open crossings, which is what the top-left rule amounts to.
        const ivec2 p(x * 256 + 128, y * 256 + 128);
        int winding = 0;
        bool onRim = false;
        for (int i = 0; i < spokes; ++i) {
          const ivec2 a = rim[static_cast<size_t>(i)], b = rim[static_cast<size_t>((i + 1) % spokes)];
          const std::int64_t side = area(a, b, p);
          onRim |= side == 0;
          if (a.y <= p.y && b.y > p.y && side > 0) ++winding;
          if (a.y > p.y && b.y <= p.y && side < 0) --winding;
        }
        if (!onRim) {
          ASSERT_EQ(hits[static_cast<size_t>(y * 48 + x)], winding) << n << ": " << x << ", " << y;
        } else {
          ASSERT_LE(hits[static_cast<size_t>(y * 48 + x)], 1);
        }
      }
  }
}

} // namespace
} // namespace gpgp::shader
