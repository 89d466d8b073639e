// The conversion against winding numbers at scale: 10^7 points in each of four drawings, fewer in many others, random
// paths and degenerate ones. GPGP_ORACLE_POINTS says how many points a drawing gets instead, GPGP_ORACLE_DRAWINGS how
// many openclipart drawings are tried (300).
//
// Points are taken by rows: the oracle's crossings of a row and of the rows a float's distance above and below answer
// for all points in it.
#include "host/files.h"
#include "oracle.h"
#include "vector/import/svg/import.h"
#include "vector/patch/drawing.h"
#include "vector/shared/curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using vector::Drawing;

size_t setting(const char* name, size_t otherwise) {
  const char* text = std::getenv(name);
  return text ? static_cast<size_t>(std::strtod(text, nullptr)) : otherwise;
}

struct Row {
  std::vector<PathOracle::Crossing> crossings;
  bool evenOdd;
  struct Answer {
    bool near = false, inside = false; // near: within the slack of an edge
    size_t before = 0;                 // edges to the left
  };
  Answer at(double x, double slack) const {
    Answer a;
    int winding = 0;
    for (const auto& c : crossings) {
      if (std::abs(c.x - x) <= slack) a.near = true;
      if (c.x > x) break;
      winding += c.direction;
      ++a.before;
    }
    a.inside = evenOdd ? (winding & 1) != 0 : winding != 0;
    return a;
  }
};

struct Tally {
  size_t tested = 0, wrong = 0, doubled = 0, inside = 0;
  std::string first, firstDoubled;
};

/// `points` points of one path's box, in rows of up to 500, half of the rows exactly at the top of a patch.
void judge(const GpgpPath& path, size_t points, uint32_t seed, Tally& tally, const std::string& name) {
  const auto drawing = vector::makeDrawing(std::span(&path, 1), std::pmr::get_default_resource());
  ASSERT_TRUE(drawing) << name << ": " << drawing.error().text;
  const PathOracle oracle(path);
  if (!(oracle.right > oracle.left) || !(oracle.bottom > oracle.top)) return;
  const double slack = oracle.magnitude() * 1.5e-6;
  const size_t columns = std::min<size_t>(500, points), rows = (points + columns - 1) / columns;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> xs(oracle.left - slack, oracle.right + slack), ys(oracle.top, oracle.bottom);
  const bool evenOdd = path.fillRule == GPGP_FILL_EVEN_ODD;
  std::vector<const vector::PatchRecord*> here;
  for (size_t r = 0; r < rows; ++r) {
    float y = static_cast<float>(ys(random));
    if (r % 2 && !drawing->patches.empty()) y = drawing->patches[random() % drawing->patches.size()].top;
    const Row above{oracle.crossings(y - slack), evenOdd}, row{oracle.crossings(y), evenOdd},
        below{oracle.crossings(y + slack), evenOdd};
    here.clear();
    for (const auto& p : drawing->patches)
      if (y >= p.top && y < p.bottom) here.push_back(&p);
    for (size_t i = 0; i < columns; ++i) {
      const float x = static_cast<float>(xs(random));
      // An edge that passes between the rows is as near as one beside the point.
      const Row::Answer answer = row.at(x, slack), up = above.at(x, slack), down = below.at(x, slack);
      if (answer.near || up.near || down.near || up.before != answer.before || down.before != answer.before) continue;
      int count = 0;
      for (const auto* p : here)
        count += x >= p->x0 && x <= p->x1 && shader::rightOfCurve(drawing->curves[p->left], x, y, 0) &&
                 !shader::rightOfCurve(drawing->curves[p->right], x, y, 0);
      const bool in = answer.inside;
      // Between the rows one edge may have taken another's place.
      if (count != static_cast<int>(in) && oracle.distance(x, y) <= slack) continue;
      ++tally.tested;
      tally.inside += in;
      if (count > 1 && tally.doubled++ == 0)
        tally.firstDoubled = name + " at " + std::to_string(x) + " " + std::to_string(y);
      if ((count > 0) != in && tally.wrong++ == 0)
        tally.first = name + " at " + std::to_string(x) + " " + std::to_string(y) + (in ? " inside" : " outside");
    }
  }
}

void expectGood(const Tally& t) {
  EXPECT_EQ(t.wrong, 0u) << "of " << t.tested << ", first " << t.first;
  EXPECT_EQ(t.doubled, 0u) << "of " << t.tested << ", first " << t.firstDoubled;
}

void judgeFile(const std::string& file, size_t points, Tally& tally) {
  const auto bytes = host::readFile(file);
  vector::svg::Reporter reporter(nullptr, nullptr, "");
  const auto svg = vector::svg::importSvg(std::as_bytes(std::span(bytes)), reporter);
  if (!svg) return; // damaged files are the importer's tests
  for (size_t i = 0; i < svg->paths.size(); ++i)
    judge(svg->paths[i].view(), points / svg->paths.size() + 1, static_cast<uint32_t>(i), tally,
          file + " path " + std::to_string(i) + " line " + std::to_string(svg->paths[i].place.line));
}

struct Drawings : testing::TestWithParam<const char*> {};
TEST_P(Drawings, ArePatchesOfTheirInside) {
  const std::string file = std::string(GPGP_TEST_DATA) + "/" + GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there: run tests/data/fetch.sh --only svg";
  Tally tally;
  constexpr size_t kPoints = 10'000'000; // and half as many for those that lie too near to an edge
  judgeFile(file, setting("GPGP_ORACLE_POINTS", kPoints + kPoints / 2), tally);
  std::printf("%s: %zu points, %zu wrong, %zu doubled\n", GetParam(), tally.tested, tally.wrong, tally.doubled);
  expectGood(tally);
  EXPECT_GT(tally.inside, tally.tested / 100);
  if (!std::getenv("GPGP_ORACLE_POINTS")) {
    EXPECT_GE(tally.tested, kPoints);
  }
}
INSTANTIATE_TEST_SUITE_P(Svg, Drawings,
                         testing::Values("svg/hud.svg", "fetched/svg/tiger.svgz", "fetched/svg/car.svgz",
                                         "fetched/svg/gallardo.svgz"));

TEST(Oracle, ManyDrawings) {
  const std::string folder = GPGP_TEST_DATA "/fetched/openclipart";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is missing: run tests/data/fetch.sh";
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().string().find(".svg") != std::string::npos) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::mt19937 random(11);
  std::shuffle(files.begin(), files.end(), random);
  files.resize(std::min(files.size(), setting("GPGP_ORACLE_DRAWINGS", 300)));
  size_t tested = 0;
  for (const std::string& file : files) {
    Tally tally;
    judgeFile(file, setting("GPGP_ORACLE_POINTS", 20'000), tally);
    expectGood(tally);
    tested += tally.tested;
  }
  std::printf("%zu drawings, %zu points\n", files.size(), tested);
}

TestPath randomPath(uint32_t seed, int verbs, float snap) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(-100, 100);
  const auto c = [&] {
    const float v = coordinate(random);
    return snap > 0 ? std::round(v / snap) * snap : v;
  };
  TestPath path;
  path.rule = seed & 1 ? GPGP_FILL_EVEN_ODD : GPGP_FILL_NON_ZERO;
  path.move(c(), c());
  for (int i = 0; i < verbs; ++i) {
    const float a = c(), b = c(), d = c(), e = c(), f = c(), g = c();
    switch (random() % 8) {
    case 0: path.close().move(a, b); break;
    case 1:
    case 2: path.line(a, b); break;
    case 3:
    case 4: path.quad(a, b, d, e); break;
    default: path.cubic(a, b, d, e, f, g); break;
    }
  }
  return path;
}

TEST(Oracle, RandomPaths) {
  const size_t points = setting("GPGP_ORACLE_POINTS", 100'000), paths = 200;
  Tally tally;
  for (uint32_t seed = 0; seed < paths; ++seed) {
    const TestPath path = randomPath(1000 + seed, 3 + static_cast<int>(seed) / 3, seed % 4 > 1 ? 20.0f : 0.0f);
    judge(path.view(), points / paths + 500, seed, tally, "seed " + std::to_string(seed));
  }
  expectGood(tally);
}

TEST(Oracle, DegeneratePaths) {
  const auto judged = [](const TestPath& path, const char* name) {
    Tally tally;
    for (const GpgpFillRule rule : {GPGP_FILL_NON_ZERO, GPGP_FILL_EVEN_ODD}) {
      GpgpPath view = path.view();
      view.fillRule = rule;
      judge(view, 20'000, 1, tally, name);
    }
    expectGood(tally);
  };
  std::mt19937 random(3);
  TestPath cusps, collinear, twice, needles, star, huge, level;
  for (int i = 0; i < 20; ++i) {
    const float x = static_cast<float>(i % 5) * 30, y = static_cast<float>(i / 5) * 30;
    cusps.move(x, y).cubic(x + 20, y + 20, x, y + 20, x + 20, y + static_cast<float>(i) * 0.01f).close();
    collinear.move(x, y).cubic(x + 40, y + 20, x - 20, y - 10, x + 20, y + 10).line(x + 3, y + 20).close();
    twice.move(x, y).cubic(x + 9, y, x + 9, y + 30, x, y + 30).close();
    twice.move(x, y + 30).cubic(x + 9, y + 30, x + 9, y, x, y).close();
    twice.move(x + 1, y + 5).cubic(x + 9, y, x + 9, y + 30, x, y + 30).close();
    needles.move(x, y).line(x + 100, y + 1e-3f).line(x, y + 2e-3f).close();
    level.move(x, y)
        .cubic(x + 10, y, x + 20, y, x + 30, y)
        .line(x + 30, y + 10)
        .cubic(x + 20, y + 10, x + 10, y + 10, x, y + 10);
  }
  // All through one point.
  for (int i = 0; i < 60; ++i) {
    const float a = static_cast<float>(i) * 0.1047f;
    star.move(50, 50).line(50 + 60 * std::cos(a), 50 + 60 * std::sin(a));
    star.line(50 + 60 * std::cos(a + 0.05f), 50 + 60 * std::sin(a + 0.05f)).close();
    star.move(50 - 60 * std::cos(a), 50 - 60 * std::sin(a)).line(50 + 60 * std::cos(a), 50 + 60 * std::sin(a));
    star.line(60, 90).close();
  }
  huge = randomPath(77, 30, 0);
  for (float& v : huge.points) v *= 1e5f; // to 1e7
  judged(cusps, "cusps");
  judged(collinear, "collinear");
  judged(twice, "twice");
  judged(needles, "needles");
  judged(level, "level");
  judged(star, "star");
  judged(huge, "huge");
  TestPath far = randomPath(78, 30, 0); // small and far away
  for (float& v : far.points) v = 9e6f + std::round(v);
  judged(far, "far");
}

TEST(Oracle, EdgesThatChangePlacesAtOneHeight) {
  // Far from the origin, triangles on two or three lines through one point, each up to a float's step beside the
  // line: bundles of edges cross within a step, and keep their order inside.
  constexpr float kMiddle = 1e5f, kStep = 1.0f / 128;
  Tally tally;
  std::mt19937 random(21);
  std::uniform_real_distribution<float> any(-1, 1);
  const auto upTo = [&](float most) { return most * any(random); };
  for (uint32_t seed = 0; seed < 4000; ++seed) {
    float ends[3][2];
    for (auto& [x, y] : ends) x = upTo(60), y = 40 + upTo(15);
    TestPath path;
    for (uint32_t i = 0; i < 4 + seed % 5; ++i) {
      const auto& [x, y] = ends[random() % (2 + seed % 2)];
      float points[] = {-x, -y, x, y, upTo(80), upTo(60)};
      for (float& v : points) v += kMiddle + static_cast<float>(random() % 2) * kStep;
      path.move(points[0], points[1]).line(points[2], points[3]).line(points[4], points[5]).close();
    }
    path.rule = seed % 4 > 1 ? GPGP_FILL_EVEN_ODD : GPGP_FILL_NON_ZERO;
    judge(path.view(), 1000, seed, tally, "seed " + std::to_string(seed));
  }
  expectGood(tally);
  EXPECT_GT(tally.inside, tally.tested / 50);
}

TEST(Oracle, CurvesThatLeaveACommonEndAlike) {
  // Level at their end, with nearly the same curvature there, and further away they cross: nearly all of the search
  // goes into rows where they run close beside each other.
  Tally tally;
  std::mt19937 random(23);
  std::uniform_real_distribution<float> reach(20, 60), curvature(0.004f, 0.006f), nearly(-3e-4f, 3e-4f), ends(-20, 40);
  for (uint32_t seed = 0; seed < 1000; ++seed) {
    const float bend = curvature(random);
    TestPath path;
    for (int i = 0; i < 3; ++i) {
      const float x = reach(random), y = bend * (1 + nearly(random)) * x * x;
      const float endX = x + 10, endY = y + 20 + ends(random) / 2;
      path.move(0, 0).cubic(x, 0, endX, y, endX, endY).line(-20 + ends(random), 90).close();
    }
    path.rule = seed & 1 ? GPGP_FILL_EVEN_ODD : GPGP_FILL_NON_ZERO;
    judge(path.view(), 2000, seed, tally, "seed " + std::to_string(seed));
  }
  expectGood(tally);
  EXPECT_GT(tally.inside, tally.tested / 10);
}

TEST(Oracle, ManyCurvesInOnePath) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> step(-3, 3);
  TestPath scribble;
  float x = 500, y = 500;
  scribble.move(x, y);
  const auto next = [&](float v) { return std::clamp(v + step(random), 0.0f, 1000.0f); };
  for (int i = 0; i < 100'000; ++i) {
    const float ax = next(x), ay = next(y), bx = next(ax), by = next(ay);
    x = next(bx), y = next(by);
    scribble.cubic(ax, ay, bx, by, x, y);
  }
  Tally tally;
  judge(scribble.view(), 20'000, 1, tally, "scribble");
  expectGood(tally);
  EXPECT_GT(tally.inside, 100u);
}

TEST(Oracle, DistancesAreThoseOfClosedForms) {
  TestPath square;
  square.move(1, 1).line(3, 1).line(3, 3).line(1, 3).close();
  const PathOracle of(square.view());
  EXPECT_NEAR(of.distance(2, 2), 1, 1e-12);
  EXPECT_NEAR(of.distance(2.75, 1.5), 0.25, 1e-12);
  EXPECT_NEAR(of.distance(0, 0), std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(of.distance(2, 7), 4, 1e-12);
  TestPath arch; // 6 t (1 - t) high
  arch.move(0, 0).cubic(1, 2, 2, 2, 3, 0).close();
  EXPECT_NEAR(PathOracle(arch.view()).distance(1.5, 2), 0.5, 1e-6);
  // In a sliver thinner than the distance all four neighbours lie outside, like the point: they do not see the edge.
  TestPath sliver;
  sliver.move(1e5f, 1e5f - 1).cubic(1e5f + 7, 1e5f + 8, 1e5f - 1, 1e5f + 10, 1e5f + 8, 1e5f);
  const PathOracle thin(sliver.view());
  const double x = 100003.25, y = 100006.53125, slack = thin.magnitude() * 1.5e-6;
  EXPECT_TRUE(thin.certain(x, y, slack));
  EXPECT_LT(thin.distance(x, y), slack / 20);
}

} // namespace
