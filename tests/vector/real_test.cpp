// Real drawings through the importer and the conversion: each path's patches against winding numbers.
#include "fetched_svg.h"
#include "oracle.h"
#include "vector/patch/drawing.h"
#include "vector/shared/curve.h"

#include <gtest/gtest.h>

#include <chrono>
#include <random>

namespace {
using namespace gpgp;
using namespace gpgp::test;

struct RealPaths : testing::TestWithParam<const char*> {};

TEST_P(RealPaths, PatchesAreTheInside) {
  const auto svg = fetchedSvg(GetParam());
  if (!svg) GTEST_SKIP() << GetParam() << " is not there";
  std::mt19937 random(7);
  size_t tested = 0, wrong = 0, doubled = 0, inside = 0, patches = 0, curves = 0;
  double seconds = 0;
  const size_t points = 120000 / svg->paths.size() + 1;
  for (size_t i = 0; i < svg->paths.size(); ++i) {
    const GpgpPath path = svg->paths[i].view();
    const auto start = std::chrono::steady_clock::now();
    const auto d = vector::makeDrawing(std::span(&path, 1), std::pmr::get_default_resource());
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ASSERT_TRUE(d) << d.error().text;
    patches += d->patches.size();
    curves += d->curves.size();
    const PathOracle oracle(path);
    const double slack = oracle.magnitude() * 1.5e-6;
    std::uniform_real_distribution<double> xs(oracle.left, oracle.right + slack), ys(oracle.top, oracle.bottom + slack);
    size_t wrongHere = 0;
    for (size_t k = 0; k < points; ++k) {
      const float x = static_cast<float>(xs(random)), y = static_cast<float>(ys(random));
      if (!oracle.certain(x, y, slack)) continue;
      int count = 0;
      for (const auto& p : d->patches)
        count += y >= p.top && y < p.bottom && shader::rightOfCurve(d->curves[p.left], x, y, 0) &&
                 !shader::rightOfCurve(d->curves[p.right], x, y, 0);
      const bool in = oracle.inside(x, y);
      ++tested;
      inside += in;
      doubled += count > 1;
      if ((count > 0) != in && wrongHere++ == 0)
        ADD_FAILURE() << "path " << i << ", line " << svg->paths[i].place.line << ", at " << x << " " << y
                      << ", inside " << in << ", patches " << d->patches.size();
    }
    wrong += wrongHere;
  }
  std::printf("%s: %zu paths, %zu curves, %zu patches, converted in %.1f ms; %zu points\n", GetParam(),
              svg->paths.size(), curves, patches, seconds * 1e3, tested);
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(doubled, 0u);
  EXPECT_GT(inside, tested / 100);
}
INSTANTIATE_TEST_SUITE_P(Svg, RealPaths,
                         testing::Values("svg/hud.svg", "fetched/svg/tiger.svgz", "fetched/svg/car.svgz",
                                         "fetched/svg/gallardo.svgz"));

} // namespace
