// CPatches as shaders evaluate them: their union is what winding numbers call inside, no point lies in two of them, and
// coverage is the area. The oracle knows nothing of patches; what shaders run is run here on the CPU.
#include "oracle.h"
#include "vector/patch/patch_reader.h"
#include "vector/patch/patches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using shader::PatchReader;
using shader::vec2;
using vector::Drawing;

std::pmr::memory_resource* heap() { return std::pmr::get_default_resource(); }
double exact(float v) { return static_cast<double>(v); }
float rounded(double v) {
  const volatile float f = static_cast<float>(v); // g++ 12 may drop the rounding of a pair that becomes double again
  return f;
}

vector::Patches patchesOf(const GpgpPath& path, uint32_t maxCurves = vector::kPatchCurves) {
  const auto drawing = vector::makeDrawing(std::span(&path, 1), heap());
  EXPECT_TRUE(drawing) << drawing.error().text;
  auto patches = vector::makePatches(*drawing, heap(), maxCurves);
  EXPECT_TRUE(patches) << patches.error().text;
  return std::move(*patches);
}

TestPath randomPath(uint32_t seed, int verbs, float snap) {
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
    switch (random() % 6) {
    case 0: path.close(), path.move(a, b); break;
    case 1: path.line(a, b); break;
    case 2: path.quad(a, b, d, e); break;
    default: path.cubic(a, b, d, e, f, g); break;
    }
  }
  return path;
}

struct Verdict {
  size_t tested = 0, wrong = 0, doubled = 0;
  double x = 0, y = 0;
};

/// A point, as far from an origin as a screen would be at the zoom.
void judge(const PathOracle& oracle, PatchReader& reader, double x, double y, double zoom, double slack, Verdict& v) {
  const PatchReader::GpgpPatchPath path = reader.gpgpLoadPath(0, 0, 0);
  const vec2 origin{rounded(x + 300 / zoom), rounded(y - 500 / zoom)};
  const vec2 at{rounded(x - exact(origin.x)), rounded(y - exact(origin.y))};
  const uint32_t count = reader.gpgpPatchesAt(0, path, origin, at);
  v.doubled += count > 1;
  slack += 1.5e-7 * 800 / zoom; // of floats as far away as the origin
  const double px = exact(origin.x) + exact(at.x), py = exact(origin.y) + exact(at.y);
  if (!oracle.certain(px, py, slack)) return;
  ++v.tested;
  if ((count > 0) == oracle.inside(px, py) || oracle.distance(px, py) < slack) return;
  if (v.wrong++ == 0) v.x = px, v.y = py;
}

void expectInside(const GpgpPath& view, uint32_t seed, size_t points = 400) {
  for (const uint32_t maxCurves : {4u, 8u}) {
    const vector::Patches patches = patchesOf(view, maxCurves);
    PatchReader reader(patches.words);
    const PathOracle oracle(view);
    std::mt19937 random(seed);
    const double w = oracle.right - oracle.left, h = oracle.bottom - oracle.top;
    std::uniform_real_distribution<double> xs(oracle.left - 0.05 * w, oracle.right + 0.05 * w),
        ys(oracle.top - 0.05 * h, oracle.bottom + 0.05 * h), unit(-1, 1);
    const double slack = oracle.magnitude() * 1.5e-6;
    Verdict v;
    for (size_t i = 0; i < points; ++i) judge(oracle, reader, xs(random), ys(random), 1, slack, v);
    // Beside edges, at half a pixel of each zoom.
    for (const double zoom : {1.0 / 64, 1.0, 16.0, 256.0, 4096.0})
      for (size_t i = 0; i < points / 8; ++i) {
        const double y = ys(random);
        for (const auto& crossing : oracle.crossings(y)) {
          judge(oracle, reader, crossing.x + 0.5 * unit(random) / zoom, y + 0.5 * unit(random) / zoom, zoom, slack, v);
          judge(oracle, reader, crossing.x, y, zoom, slack, v); // on it
        }
      }
    EXPECT_EQ(v.wrong, 0u) << "of " << v.tested << ", " << maxCurves << " curves, seed " << seed << ", first at " << v.x
                           << " " << v.y;
    EXPECT_EQ(v.doubled, 0u) << "of " << v.tested << ", " << maxCurves << " curves, seed " << seed;
    EXPECT_GT(v.tested, points / 2);
  }
}

/// The oracle's area in a box, by rows of exact spans.
double areaIn(const PathOracle& oracle, bool evenOdd, double x0, double y0, double x1, double y1, int rows = 64) {
  double area = 0;
  for (int r = 0; r < rows; ++r) {
    int winding = 0;
    double from = 0;
    for (const auto& c : oracle.crossings(y0 + (r + 0.5) * (y1 - y0) / rows)) {
      const bool before = evenOdd ? winding & 1 : winding != 0;
      winding += c.direction;
      const bool after = evenOdd ? winding & 1 : winding != 0;
      if (!before && after) from = c.x;
      if (before && !after) area += std::max(0.0, std::min(c.x, x1) - std::max(from, x0));
    }
  }
  return area / rows / (x1 - x0);
}

struct Error {
  double worst = 0, sum = 0;
  size_t count = 0;
  double rms() const { return count ? std::sqrt(sum / double(count)) : 0; }
};

Error coverageError(const GpgpPath& view, double zoom, size_t points, uint32_t seed) {
  const vector::Patches patches = patchesOf(view);
  PatchReader reader(patches.words);
  const PatchReader::GpgpPatchPath path = reader.gpgpLoadPath(0, 0, 0);
  const PathOracle oracle(view);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> ys(oracle.top, oracle.bottom), unit(-1, 1);
  Error error;
  const float half = rounded(0.5 / zoom);
  for (size_t i = 0; i < points; ++i) {
    const double y = ys(random);
    for (const auto& crossing : oracle.crossings(y)) {
      const vec2 origin{rounded(crossing.x), rounded(y)};
      const vec2 at{rounded(0.6 * unit(random) / zoom), rounded(0.6 * unit(random) / zoom)};
      const double x = exact(origin.x) + exact(at.x), v = exact(origin.y) + exact(at.y), h = exact(half);
      const double wanted =
          areaIn(oracle, view.fillRule == GPGP_FILL_EVEN_ODD, x - h, v - h, x + h, v + h, zoom < 1 ? 512 : 64);
      const double off =
          std::abs(exact(reader.gpgpPathCoverage(0, path, origin, at, {2 * half, 0}, {0, 2 * half})) - wanted);
      error.worst = std::max(error.worst, off);
      error.sum += off * off;
      ++error.count;
    }
  }
  return error;
}

TEST(CPatches, RandomPathsAreWhatWindingNumbersSay) {
  for (uint32_t seed = 1; seed <= 40; ++seed)
    for (const GpgpFillRule rule : {GPGP_FILL_NON_ZERO, GPGP_FILL_EVEN_ODD}) {
      TestPath path = randomPath(seed, 8, seed % 3 == 0 ? 10.0f : 0);
      path.rule = rule;
      expectInside(path.view(), seed, 200);
    }
}

/// Every type of cubic, whole and where its continuation comes near.
TEST(CPatches, CubicsOfEveryType) {
  const float cubics[][8] = {
      {0, 0, 40, 60, 80, -50, 100, 30},           // serpentine
      {0, 0, 100, 50, 0, 50, 100, 0},             // cusp
      {0, 0, 130, 90, -40, 90, 90, 5},            // loop
      {0, 0, 10, 80, 20, 90, 100, 100},           // an arch
      {0, 0, 0, 50, 50, 100, 100, 100},           // that ends along both axes
      {0, 0, 33.3333f, 20, 66.6667f, 20, 100, 0}, // a quadratic, as far as floats say
      {0, 0, 50, 0.001f, 50, 99.999f, 100, 100},  // almost two corners
      {0, 0, 90, 0, 100, 10, 100, 100},
  };
  for (const auto& c : cubics) {
    TestPath path;
    path.move(c[0], c[1]).cubic(c[2], c[3], c[4], c[5], c[6], c[7]).line(-20, 140).close();
    expectInside(path.view(), 7);
  }
  std::pmr::vector<vector::FormCurve> forms;
  std::pmr::vector<vector::CubicType> types;
  for (const auto& c : cubics) {
    TestPath path;
    path.move(c[0], c[1]).cubic(c[2], c[3], c[4], c[5], c[6], c[7]).close();
    const GpgpPath view = path.view();
    const auto drawing = vector::makeDrawing(std::span(&view, 1), heap());
    for (const auto& curve : drawing->curves) vector::appendForms(curve, forms, &types);
  }
  for (const vector::CubicType type : {vector::CubicType::serpentine, vector::CubicType::loop})
    EXPECT_GT(std::count(types.begin(), types.end(), type), 0) << static_cast<int>(type);
  EXPECT_LT(forms.size(), 60u); // few are halved
}

TestPath disc(float x, float y, float r) {
  TestPath path;
  path.move(x + r, y);
  path.add(GPGP_PATH_ARC, {r, r, 0, GPGP_ARC_SWEEP, x - r, y});
  path.add(GPGP_PATH_ARC, {r, r, 0, GPGP_ARC_SWEEP, x + r, y});
  return path.close();
}

/// A circle is one patch, and as exact as floats are, at any magnification.
TEST(CPatches, CirclesAreCircles) {
  const TestPath path = disc(50, 40, 30);
  const vector::Patches patches = patchesOf(path.view());
  EXPECT_EQ(patches.curves, 4u); // that do not turn
  EXPECT_EQ(patches.patches, 1u);
  PatchReader reader(patches.words);
  const PatchReader::GpgpPatchPath record = reader.gpgpLoadPath(0, 0, 0);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angles(0, 2 * std::numbers::pi);
  for (int i = 0; i < 4000; ++i) {
    const double a = angles(random);
    for (const double r : {30 * (1 - 4e-7), 30 * (1 + 4e-7)}) {
      const double x = 50 + r * std::cos(a), y = 40 + r * std::sin(a);
      const vec2 origin{rounded(x), rounded(y)}, at{rounded(x - exact(origin.x)), rounded(y - exact(origin.y))};
      EXPECT_EQ(reader.gpgpPatchesAt(0, record, origin, at), r < 30 ? 1u : 0u) << a << " " << r;
    }
  }
  for (const float r : {0.3f, 2.0f, 5.0f, 100.0f}) { // area: a circle of radius 2 flattened is short by 0.39 %
    const vector::Patches small = patchesOf(disc(7.3f, 9.1f, r).view());
    PatchReader of(small.words);
    const PatchReader::GpgpPatchPath p = of.gpgpLoadPath(0, 0, 0);
    double area = 0;
    for (float y = std::floor(9.1f - r); y < 9.1f + r; ++y)
      for (float x = std::floor(7.3f - r); x < 7.3f + r; ++x)
        area += exact(of.gpgpPathCoverage(0, p, {0, 0}, {x + 0.5f, y + 0.5f}, {1, 0}, {0, 1}));
    EXPECT_NEAR(area / (std::numbers::pi * exact(r) * exact(r)), 1, r < 1 ? 0.02 : 0.002) << r;
  }
}

TEST(CPatches, TurnedEllipses) {
  TestPath path;
  path.move(10, 10);
  path.add(GPGP_PATH_ARC, {60, 20, 33, GPGP_ARC_SWEEP | GPGP_ARC_LARGE, 40, 30});
  path.close();
  const GpgpPath view = path.view();
  const auto drawing = vector::makeDrawing(std::span(&view, 1), heap());
  size_t arcs = 0;
  for (const auto& curve : drawing->curves) arcs += curve.weight > 0;
  EXPECT_GE(arcs, 3u);
}

TEST(CPatches, CoverageIsTheArea) {
  double worst = 0, sum = 0;
  for (const double zoom : {1.0 / 64, 1.0 / 8, 0.5, 1.0, 16.0, 256.0, 4096.0})
    for (uint32_t seed = 1; seed <= 6; ++seed) {
      const Error error = coverageError(randomPath(seed, 7, 0).view(), zoom, 40, seed);
      worst = std::max(worst, error.worst);
      sum = std::max(sum, error.rms());
      EXPECT_LT(error.rms(), zoom < 0.03 ? 0.01 : zoom > 1000 ? 0.015 : 0.004) << "zoom " << zoom << ", seed " << seed;
      EXPECT_LT(error.worst, zoom > 1000 ? 0.1 : 0.04) << "zoom " << zoom << ", seed " << seed;
    }
  RecordProperty("worst", std::to_string(worst));
}

/// Boxes side by side cover what lies in them once: no seam at cells or patches.
TEST(CPatches, InsideIsWhole) {
  for (uint32_t seed = 1; seed <= 10; ++seed) {
    const TestPath kept = randomPath(seed, 9, 0);
    const GpgpPath path = kept.view();
    const vector::Patches patches = patchesOf(path);
    PatchReader reader(patches.words);
    const PatchReader::GpgpPatchPath record = reader.gpgpLoadPath(0, 0, 0);
    const PathOracle oracle(path);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> xs(oracle.left, oracle.right), ys(oracle.top, oracle.bottom);
    for (const double zoom : {0.3, 1.0, 3.0, 64.0, 2048.0})
      for (int i = 0; i < 400; ++i) {
        const double x = xs(random), y = ys(random), half = 0.5 / zoom;
        if (!oracle.inside(x, y) || oracle.distance(x, y) < 1.5 * half + 1e-3) continue;
        const vec2 origin{rounded(x), rounded(y)};
        EXPECT_EQ(reader.gpgpPathCoverage(0, record, origin, {0, 0}, {2 * rounded(half), 0}, {0, 2 * rounded(half)}),
                  1.0f)
            << "zoom " << zoom << ", seed " << seed << ", at " << x << " " << y;
      }
  }
}

/// Baked with the drawing, for those who ask: a file for one way of drawing does not hold the other's tables.
TEST(CPatches, BakedFilesHoldWhatIsAskedFor) {
  const TestPath path = randomPath(4, 8, 0);
  const GpgpPath view = path.view();
  auto drawing = vector::makeDrawing(std::span(&view, 1), heap());
  ASSERT_TRUE(drawing);
  const auto flattened = vector::bake(*drawing, heap());
  auto patches = vector::makePatches(*drawing, heap());
  ASSERT_TRUE(patches);
  drawing->words = patches->words;
  const auto both = vector::bake(*drawing, heap());
  drawing->curves.clear(), drawing->patches.clear();
  const auto alone = vector::bake(*drawing, heap());
  EXPECT_EQ(both.size() - flattened.size(), patches->words.size() * 16);
  EXPECT_LT(alone.size(), both.size());
  const auto loaded = vector::loadBaked(alone, heap());
  ASSERT_TRUE(loaded) << loaded.error().text;
  EXPECT_EQ(vector::methodsOf(*loaded), GPGP_DRAWING_IN_PASS);
  EXPECT_EQ(vector::methodsOf(*vector::loadBaked(both, heap())), GPGP_DRAWING_IN_PASS | GPGP_DRAWING_FLATTENED);
  EXPECT_EQ(vector::methodsOf(*vector::loadBaked(flattened, heap())), GPGP_DRAWING_FLATTENED);
  // Whatever a word becomes, it is refused or can be read within bounds.
  std::mt19937 random(1);
  size_t refused = 0;
  for (int i = 0; i < 400; ++i) {
    auto words = patches->words;
    shader::uvec4& changed = words[random() % words.size()];
    (i % 4 == 0   ? changed.x
     : i % 4 == 1 ? changed.y
     : i % 4 == 2 ? changed.z
                  : changed.w) = static_cast<uint32_t>(random());
    if (!vector::checkPatches(words, 1)) {
      ++refused;
      continue;
    }
    PatchReader reader(words);
    const PatchReader::GpgpPatchPath record = reader.gpgpLoadPath(0, 0, 0);
    for (float y = -90; y < 90; y += 30)
      for (float x = -90; x < 90; x += 30) {
        reader.gpgpPatchesAt(0, record, {0, 0}, {x, y});
        reader.gpgpPathCoverage(0, record, {0, 0}, {x, y}, {20, 0}, {0, 20});
      }
  }
  EXPECT_GT(refused, 100u);
}

} // namespace
