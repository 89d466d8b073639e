// Areas of what is drawn with curves, against their closed forms.
#include "canvas_fixture.h"
#include "vector/shared/shape.h"

#include <numbers>

namespace {
using namespace gpgp;
using namespace gpgp::test;

constexpr double kPi = std::numbers::pi;

struct Ellipse {
  double x, y, a, b, angle;
  double area() const { return kPi * a * b; }
  float px(double u, double v) const {
    return static_cast<float>(x + a * u * std::cos(angle) - b * v * std::sin(angle));
  }
  float py(double u, double v) const {
    return static_cast<float>(y + a * u * std::sin(angle) + b * v * std::cos(angle));
  }
};

/// Eight cubics, off by less than 5e-6 of the radius; `turns`: 1, or -1 for the other way round.
TestPath pathOf(const Ellipse& e, double turns = 1) {
  TestPath path;
  constexpr int kArcs = 8;
  const double step = turns * 2 * kPi / kArcs, handle = 4.0 / 3 * std::tan(step / 4);
  path.move(e.px(1, 0), e.py(1, 0));
  for (int i = 0; i < kArcs; ++i) {
    const double c0 = std::cos(step * i), s0 = std::sin(step * i);
    const double c1 = std::cos(step * (i + 1)), s1 = std::sin(step * (i + 1));
    path.cubic(e.px(c0 - handle * s0, s0 + handle * c0), e.py(c0 - handle * s0, s0 + handle * c0),
               e.px(c1 + handle * s1, s1 - handle * c1), e.py(c1 + handle * s1, s1 - handle * c1), e.px(c1, s1),
               e.py(c1, s1));
  }
  return path.close();
}

constexpr shader::Grid kGrid{16, 16 * 256, 256};

shader::ItemRecord placedAsIs() {
  shader::ItemRecord item{};
  const GpgpCanvasItem here{nullptr, {1, 0, 0, 1, 0, 0}, 1};
  EXPECT_TRUE(vector::placeItem(here, 256, 256, item));
  return item;
}

/// What lies left of a segment's flattened segments, with the side as sign: a path's sum is its area.
double areaLeft(const shader::ItemRecord& item, const shader::SegmentRecord& s, uint32_t n) {
  double sum = 0;
  for (uint32_t i = 0; i < n; ++i) {
    shader::FlatSegment c;
    if (!shader::flatSegmentOf(kGrid, item, s, i, n, shader::flatSegmentStep(n), c)) continue;
    sum -= static_cast<double>(c.side) * (static_cast<double>(c.bottom.y) - static_cast<double>(c.top.y)) *
           (static_cast<double>(c.bottom.x) + static_cast<double>(c.top.x)) / 2;
  }
  return sum;
}
double flattenedArea(std::span<const shader::SegmentRecord> segments) {
  const shader::ItemRecord item = placedAsIs();
  double sum = 0;
  for (const shader::SegmentRecord& s : segments) sum += areaLeft(item, s, shader::flatSegmentCount(kGrid, item, s));
  return sum;
}

struct Areas : testing::Test {
  std::mt19937 random{5};
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
};

TEST_F(Areas, OfFlattenedEllipsesAreRightFromRadiusOneOn) {
  for (int i = 0; i < 4000; ++i) {
    const double a = i % 4 == 0 ? 1 : std::exp(between(0, std::log(50))),
                 b = i % 2 ? a : std::exp(between(0, std::log(50)));
    const Ellipse e{between(100, 101), between(100, 101), a, b, i % 3 == 0 ? 0 : between(0, 2 * kPi)};
    const TestPath path = pathOf(e, i % 5 ? 1 : -1);
    const GpgpPath view = path.view();
    const auto drawing = vector::makeDrawing(std::span(&view, 1), std::pmr::get_default_resource());
    ASSERT_TRUE(drawing);
    const auto outlines = vector::makeOutlines(*drawing, std::pmr::get_default_resource());
    const double error = std::abs(flattenedArea(outlines.segments) / e.area() - 1);
    EXPECT_LT(error, 2e-4) << "radii " << e.a << " and " << e.b << ", turned by " << e.angle;
  }
}

TEST_F(Areas, OfRoundShapesOfListsAreRight) {
  for (int i = 0; i < 4000; ++i) {
    const double a = i % 4 == 0 ? 1 : std::exp(between(0, std::log(50))), b = std::exp(between(0, std::log(50)));
    const double angle = i % 3 == 0 ? 0 : between(0, 2 * kPi);
    shader::ShapeRecord shape{};
    shape.box = shader::vec4(-a, -b, a, b);
    shape.radii = shader::vec4(static_cast<float>(a));
    shape.frame = shader::vec4(between(100, 101), between(100, 101), std::cos(angle), std::sin(angle));
    shape.ratio = static_cast<float>(b / a);
    shape.kind = shader::kShapeRound;
    std::vector<shader::SegmentRecord> segments;
    for (uint32_t k = 0; k < shader::shapeSegments(shape); ++k) segments.push_back(shader::shapeSegment(shape, k));
    const double error = std::abs(std::abs(flattenedArea(segments)) / (kPi * a * b) - 1);
    EXPECT_LT(error, 2e-4) << "radii " << a << " and " << b << ", turned by " << angle;
  }
}

/// The flattened segments of any convex curve leave it its area, whatever their number, but for one alone: within 1.25
/// n^-2 of what n flattened segments between points of the curve would cut off.
TEST_F(Areas, BesideConvexCurvesAreTheCurves) {
  const shader::ItemRecord item = placedAsIs();
  int tried = 0;
  while (tried < 20000) {
    // Control points that turn one way and run down.
    const double x[4] = {between(20, 60), between(20, 60), between(20, 60), between(20, 60)};
    double y[4] = {between(20, 60), between(20, 60), between(20, 60), between(20, 60)};
    std::sort(y, y + 4);
    const auto cross = [&](int i, int j) {
      return (x[i + 1] - x[i]) * (y[j + 1] - y[j]) - (y[i + 1] - y[i]) * (x[j + 1] - x[j]);
    };
    const double ab = cross(0, 1), bc = cross(1, 2), ac = cross(0, 2);
    if (!(std::min({ab, bc, ac}) > 40) && !(std::max({ab, bc, ac}) < -40)) continue;
    shader::SegmentRecord s{};
    s.first = shader::vec4(x[0], y[0], x[1], y[1]);
    s.second = shader::vec4(x[2], y[2], x[3], y[3]);
    s.ends = shader::vec4(x[0], y[0], x[3], y[3]);
    s.side = 1;
    // Left of the flattened segment from end to end, and between that and the curve.
    const double whole = -(y[3] - y[0]) * (x[0] + x[3]) / 2 - 0.5 * (0.6 * (ab + bc) + 0.9 * ac);
    for (const uint32_t n : {2u, 3u, 4u, 6u, 8u, 16u}) {
      const double cut = std::abs(0.5 * (0.6 * (ab + bc) + 0.9 * ac)) / (n * n);
      const double error = std::abs(areaLeft(item, s, n) - whole) / cut;
      EXPECT_LT(error, n == 2 ? 0.02 : 1.25 / (n * n)) << "in " << n << " flatSegments";
    }
    ++tried;
  }
}

/// As the picture has it: many at places spread over the pixel, so that rows of samples err evenly.
TEST_F(CanvasTest, DiscsCoverTheirArea) {
  makeCanvas(512);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const bool area : {true, false})
    for (const double radius : {1.0, 1.5, 2.0, 3.0, 5.0, 12.0})
      for (const double angle : {0.0, 0.4}) {
        exactArea = area;
        const uint32_t across = radius > 8 ? 16 : 32, cell = 512 / across, count = across * across;
        std::vector<TestPath> discs;
        std::vector<GpgpPath> views;
        double expected = 0;
        for (uint32_t i = 0; i < count; ++i) {
          const double step = static_cast<double>((i * 7919) % count) / count; // each part of a row as often
          const Ellipse e{(i % across) * cell + cell / 2 + unit(random), (i / across) * cell + cell / 2 + step, radius,
                          radius * 0.9, angle};
          discs.push_back(pathOf(e));
          expected += e.area();
        }
        for (const TestPath& disc : discs) views.push_back(disc.view());
        const GpgpAsset drawing = makeDrawing(views);
        double sum = 0;
        for (const Rgba& pixel : raster({place(drawing)}, 512, 512, 16)) sum += static_cast<double>(pixel.a);
        EXPECT_NEAR(sum / expected, 1, area ? 4e-4 : 3e-3) << "radius " << radius << ", turned by " << angle;
        gpgpDestroyAsset(drawing);
      }
}

} // namespace
