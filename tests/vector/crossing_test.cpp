// Paths that cross themselves often: what their patches are, that their cost grows with their crossings, and that those
// with too many are refused before these are looked for.
#include "oracle.h"
#include "vector/geometry/order.h"
#include "vector/patch/drawing.h"
#include "vector/patch/inversions.h"
#include "vector/patch/status.h"
#include "vector/raster/segments.h"
#include "vector/shared/curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <random>
#include <tuple>

namespace {
using namespace gpgp;
using namespace gpgp::test;

std::pmr::memory_resource* heap() { return std::pmr::get_default_resource(); }

constexpr float kSide = 1000; // of the page

/// Curves or lines from one random point of the page to the next.
TestPath random(int count, bool curves, uint32_t seed = 1, float origin = 0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(0, kSide);
  const auto c = [&] { return origin + coordinate(random); };
  TestPath path;
  path.add(GPGP_PATH_MOVE, {c(), c()});
  for (int i = 0; i < count; ++i) {
    const std::array<float, 6> v{c(), c(), c(), c(), c(), c()};
    if (curves)
      path.cubic(v[0], v[1], v[2], v[3], v[4], v[5]);
    else
      path.line(v[0], v[1]);
  }
  return path;
}

/// As many bars across the page as down it: level edges pass all upright ones.
TestPath bars(int count) {
  TestPath path;
  const float wide = kSide / static_cast<float>(count) * 0.25f;
  for (int i = 0; i < count; ++i) {
    const float at = kSide * static_cast<float>(i) / static_cast<float>(count);
    path.move(at, 0).line(at + wide, 0).line(at + wide, kSide).line(at, kSide).close();
    path.move(0, at).line(kSide, at).line(kSide, at + wide).line(0, at + wide).close();
  }
  return path;
}

/// Triangles that share a corner, all corners on a grid: dozens of edges meet in one point, others in several.
TestPath fan(int count) {
  std::mt19937 random(9);
  const auto c = [&random] { return static_cast<float>(random() % 41) * 25; };
  TestPath path;
  for (int i = 0; i < count; ++i) {
    const std::array<float, 4> v{c(), c(), c(), c()};
    path.move(500, 500).line(v[0], v[1]).line(v[2], v[3]).close();
    path.move(500 + v[0] / 2, 500 + v[1] / 2)
        .line(500 - v[0] / 2, 500 - v[1] / 2)
        .line(v[3], v[2])
        .close(); // through it
  }
  return path;
}

/// The same curve again and again, each time a few roundings away.
TestPath nearlyTheSame(int count) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> little(0, 1e-4f);
  TestPath path;
  for (int i = 0; i < count; ++i) {
    path.move(100 + little(random), 0).cubic(700, 100 + little(random), -100, 600, 500, 1000 + little(random));
    path.line(900 + little(random), 1000).line(900, 0).close();
  }
  return path;
}

/// Boxes between the same two upright lines: their sides coincide in part, and cross nothing.
TestPath sharedSides(int count) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> height(0, kSide);
  TestPath path;
  for (int i = 0; i < count; ++i) {
    const float top = height(random), bottom = height(random);
    path.move(0, top).line(kSide, top).line(kSide, bottom).line(0, bottom).close();
  }
  return path;
}

/// Of this process, whoever else is running.
double seconds(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double convert(const TestPath& path, const GpgpStroke* stroke = nullptr) {
  GpgpPath view = path.view();
  view.stroke = stroke;
  return seconds([&] { EXPECT_TRUE(vector::makeDrawing(std::span(&view, 1), heap())); });
}

/// How a path is refused, and how long that takes: the best of two.
double refuse(const TestPath& path, const char* text, const GpgpStroke* stroke = nullptr) {
  GpgpPath view = path.view();
  view.stroke = stroke;
  const auto once = [&] {
    const auto drawing = vector::makeDrawing(std::span(&view, 1), heap());
    ASSERT_FALSE(drawing);
    EXPECT_EQ(drawing.error().code, GPGP_ERROR_UNSUPPORTED);
    EXPECT_NE(std::string(drawing.error().text).find(text), std::string::npos) << drawing.error().text;
  };
  const double first = seconds(once);
  return std::min(first, seconds(once));
}

/// Whether what patches cover at random points is what winding numbers say.
void expectInside(const TestPath& path, GpgpFillRule rule, size_t rows) {
  GpgpPath view = path.view();
  view.fillRule = rule;
  const auto made = vector::makeDrawing(std::span(&view, 1), heap());
  ASSERT_TRUE(made) << made.error().text;
  const vector::Drawing& d = *made;
  const PathOracle oracle(view);
  const double slack = oracle.magnitude() * 1.5e-6;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> xs(static_cast<float>(oracle.left), static_cast<float>(oracle.right)),
      ys(static_cast<float>(oracle.top), static_cast<float>(oracle.bottom));
  size_t tested = 0, wrong = 0, doubled = 0, inside = 0;
  for (size_t row = 0; row < rows; ++row) {
    const float y = ys(random);
    std::vector<const vector::PatchRecord*> here;
    for (const auto& p : d.patches)
      if (y >= p.top && y < p.bottom) here.push_back(&p);
    for (int i = 0; i < 20; ++i) {
      const float x = xs(random);
      if (!oracle.certain(x, y, slack)) continue;
      int count = 0;
      for (const auto* p : here)
        count += shader::rightOfCurve(d.curves[p->left], x, y, 0) && !shader::rightOfCurve(d.curves[p->right], x, y, 0);
      const bool in = oracle.inside(x, y);
      if (count != static_cast<int>(in) && oracle.distance(x, y) <= slack) continue; // in a sliver
      ++tested;
      inside += in;
      wrong += (count > 0) != in;
      doubled += count > 1;
    }
  }
  EXPECT_EQ(wrong, 0u) << "of " << tested << ", rule " << rule;
  EXPECT_EQ(doubled, 0u) << "of " << tested << ", rule " << rule;
  EXPECT_GT(tested, rows * 10);
  EXPECT_GT(inside, tested / 10);
  EXPECT_LT(inside, tested) << "rule " << rule;
}

TEST(Crossings, PatchesAreTheInsideOfPathsThatCrossOften) {
  for (const GpgpFillRule rule : {GPGP_FILL_NON_ZERO, GPGP_FILL_EVEN_ODD}) {
    expectInside(random(500, true), rule, 100);         // 100 000 crossings
    expectInside(random(500, false), rule, 100);        //
    expectInside(random(300, true, 4, 1e5f), rule, 50); // where many lie at the same height
    expectInside(bars(200), rule, 100);
    expectInside(fan(60), rule, 200);
  }
}

TEST(Crossings, HolesAreFoundWhereverTheyBegin) {
  // Boxes in each other, wound alike, and holes in their middle that undo them all: what bounds a hole's slabs lies
  // beyond all boxes' edges.
  TestPath path;
  constexpr int kBoxes = 60, kHoles = 40;
  for (int i = 0; i < kBoxes; ++i) {
    const float a = static_cast<float>(i) * 5, b = kSide - a;
    path.move(a, a).line(b, a).line(b, b).line(a, b).close();
  }
  for (int i = 0; i < kHoles; ++i) {
    const float x = 310 + 9 * static_cast<float>(i), y = 320 + static_cast<float>(i * 7 % kHoles) * 8;
    for (int k = 0; k < kBoxes; ++k) path.move(x, y).line(x - 4, y + 17).line(x, y + 30).line(x + 4, y + 17).close();
  }
  expectInside(path, GPGP_FILL_NON_ZERO, 300);
  GpgpPath view = path.view();
  const auto drawing = vector::makeDrawing(std::span(&view, 1), heap());
  ASSERT_TRUE(drawing);
  double area = 0; // all of them are of lines
  for (const auto& p : drawing->patches) {
    const auto xAt = [&](uint32_t curve, float y) {
      const auto& c = drawing->curves[curve];
      const double share = (static_cast<double>(y) - static_cast<double>(c.ends.y)) / static_cast<double>(c.ends.w);
      return static_cast<double>(c.ends.x) + static_cast<double>(c.ends.z) * share;
    };
    area += (static_cast<double>(p.bottom) - static_cast<double>(p.top)) * 0.5 *
            (xAt(p.right, p.top) - xAt(p.left, p.top) + xAt(p.right, p.bottom) - xAt(p.left, p.bottom));
  }
  EXPECT_NEAR(area, kSide * kSide - kHoles * 8 * 30 * 0.5, 1e-3 * kHoles);
}

TEST(Crossings, CostGrowsAsTheirNumber) {
  // Twice the curves cross four times as often. Where each crossing costs as much as there are curves around it, it is
  // twelve times the time and more.
  GpgpStroke stroke{};
  stroke.width = 50;
  stroke.join = GPGP_JOIN_ROUND;
  const auto growth = [](const std::function<double(int)>& measure, int count) {
    double small = 1e30, large = 1e30; // the best of a few
    for (int i = 0; i < 3; ++i) {
      small = std::min(small, measure(count));
      large = std::min(large, measure(2 * count));
    }
    return large / small;
  };
  EXPECT_LT(growth([](int n) { return convert(random(n, true)); }, 500), 7) << "curves";
  EXPECT_LT(growth([](int n) { return convert(random(n, false)); }, 800), 7) << "lines";
  EXPECT_LT(growth([&](int n) { return convert(random(n, false), &stroke); }, 400), 7) << "a wide stroke";
}

TEST(Crossings, RefusingTakesNoLongerThanConvertingWhatIsAllowed) {
  // What it is measured by has 400 000 crossings of curves, a tenth of what is allowed. However far beyond a limit a
  // path is, refusing it takes little more.
  GpgpStroke stroke{};
  stroke.width = 50;
  const double first = convert(random(1000, true));
  const double allowed = std::min(first, convert(random(1000, true)));
  EXPECT_LT(refuse(random(4000, true), "crosses itself more than 4194304 times"), allowed);
  EXPECT_LT(refuse(random(20000, false), "crosses itself more than 4194304 times"), allowed);
  EXPECT_LT(refuse(random(8000, false), "crosses itself more than 4194304 times", &stroke), allowed);
  for (const int bar : {1100, 4000, 8000})
    EXPECT_LT(refuse(bars(bar), "level lines of the path cross its others more than 4194304 times"), 1.5 * allowed)
        << bar;
  EXPECT_LT(refuse(sharedSides(8000), "run close together"), 3 * allowed);
  for (const int curves : {1000, 4000})
    EXPECT_LT(refuse(nearlyTheSame(curves), "run close together"), 3 * allowed) << curves;
}

TEST(Crossings, ClipsEditsAndWhatIsLeftEmptyKnowTheLimit) {
  const TestPath many = random(6000, false), square = bars(1);
  const GpgpPath views[] = {square.view(), many.view(), square.view()};
  std::pmr::vector<vector::LeftEmpty> leftEmpty(heap());
  const auto drawing = vector::makeDrawing(views, heap(), nullptr, &leftEmpty);
  ASSERT_TRUE(drawing);
  ASSERT_EQ(leftEmpty.size(), 1u);
  EXPECT_EQ(leftEmpty[0].index, 1u);
  ASSERT_EQ(drawing->paths.size(), 3u);
  for (const auto& patch : drawing->patches) EXPECT_NE(patch.path, 1u);
  const auto base = vector::makeDrawing(std::span(views, 1), heap());
  ASSERT_TRUE(base);
  const GpgpPathEdit edit{0, views[1]};
  const auto edited = vector::replacePaths(*base, std::span(&edit, 1), heap());
  ASSERT_FALSE(edited);
  EXPECT_EQ(edited.error().code, GPGP_ERROR_UNSUPPORTED);
  const TestPath crossed = bars(1100); // which the sweep finds
  GpgpPath level = crossed.view();
  const auto none = vector::makeDrawing(std::span(&level, 1), heap(), nullptr, &leftEmpty);
  ASSERT_TRUE(none);
  EXPECT_EQ(leftEmpty.size(), 2u);
  EXPECT_TRUE(none->patches.empty());
}

/// How many segments a path's outline has, level ones not counted.
size_t segmentsOf(const GpgpPath& path) {
  const auto drawing = vector::makeDrawing(std::span(&path, 1), heap());
  EXPECT_TRUE(drawing) << drawing.error().text;
  if (!drawing) return 0;
  const auto outlines = vector::makeOutlines(*drawing, heap());
  return static_cast<size_t>(std::count_if(outlines.segments.begin(), outlines.segments.end(),
                                           [](const auto& s) { return s.ends.y != s.ends.w; }));
}

TEST(OutlineRoom, WhatIsTakenIsWhatOutlinesHave) {
  constexpr uint64_t kBytes = sizeof(shader::SegmentRecord);
  const TestPath paths[] = {random(200, true), random(800, false), bars(30), fan(60), sharedSides(40)};
  for (const TestPath& path : paths)
    for (const GpgpFillRule rule : {GPGP_FILL_NON_ZERO, GPGP_FILL_EVEN_ODD}) {
      GpgpPath view = path.view();
      view.fillRule = rule;
      const size_t segments = segmentsOf(view);
      ASSERT_GT(segments, 0u);
      const GpgpPath both[] = {view, view};
      EXPECT_TRUE(vector::makeDrawing(std::span(both), {}, heap(), nullptr, nullptr, 2 * segments * kBytes));
      const auto refused =
          vector::makeDrawing(std::span(both), {}, heap(), nullptr, nullptr, (2 * segments - 1) * kBytes);
      ASSERT_FALSE(refused);
      EXPECT_EQ(refused.error().code, GPGP_ERROR_UNSUPPORTED);
      EXPECT_NE(std::string(refused.error().text).find("paths[1]: the drawing's outlines need more than "),
                std::string::npos)
          << refused.error().text;
      // Clips take of it as well, and so do edits.
      GpgpPath inside = view;
      inside.group = 1;
      const GpgpPathGroup group{0, 1, &view, 1};
      EXPECT_TRUE(vector::makeDrawing({&inside, 1}, {&group, 1}, heap(), nullptr, nullptr, 2 * segments * kBytes));
      EXPECT_FALSE(
          vector::makeDrawing({&inside, 1}, {&group, 1}, heap(), nullptr, nullptr, (2 * segments - 1) * kBytes));
      const auto base = vector::makeDrawing(std::span(both), heap());
      ASSERT_TRUE(base);
      const GpgpPathEdit edit{1, view};
      EXPECT_TRUE(vector::replacePaths(*base, {&edit, 1}, heap(), segments * kBytes));
      EXPECT_FALSE(vector::replacePaths(*base, {&edit, 1}, heap(), (segments - 1) * kBytes));
    }
}

TEST(OutlineRoom, LeastSegmentsAreNeverMoreThanThereAre) {
  const TestPath paths[] = {random(300, true), random(300, false), random(300, true, 4, 1e5f), bars(60),
                            fan(60),           fan(150),           nearlyTheSame(10),          sharedSides(100)};
  for (const TestPath& path : paths)
    for (const GpgpFillRule rule : {GPGP_FILL_NON_ZERO, GPGP_FILL_EVEN_ODD}) {
      GpgpPath view = path.view();
      view.fillRule = rule;
      std::pmr::vector<vector::Monotone> pieces(heap());
      ASSERT_TRUE(vector::outline(view, pieces));
      vector::mergeCoincident(pieces);
      EXPECT_LE(vector::leastSegments(pieces, rule, SIZE_MAX, heap()), segmentsOf(view)) << &path - paths;
    }
  GpgpPath tangle = paths[0].view();
  tangle.fillRule = GPGP_FILL_EVEN_ODD;
  std::pmr::vector<vector::Monotone> pieces(heap());
  ASSERT_TRUE(vector::outline(tangle, pieces));
  vector::mergeCoincident(pieces);
  EXPECT_GT(vector::leastSegments(pieces, tangle.fillRule, SIZE_MAX, heap()), segmentsOf(tangle) / 2);
}

TEST(OutlineRoom, WhatDoesNotFitIsRefusedSoon) {
  constexpr uint64_t kBound = 1 << 27; // what a software device binds
  const TestPath path = random(2500, true);
  GpgpPath view = path.view();
  view.fillRule = GPGP_FILL_EVEN_ODD; // each crossing is a corner: 300 MB
  const auto refused = [&](std::span<const GpgpPath> paths) {
    return seconds([&] { EXPECT_FALSE(vector::makeDrawing(paths, {}, heap(), nullptr, nullptr, kBound)); });
  };
  const double converted = seconds([&] { EXPECT_TRUE(vector::makeDrawing(std::span(&view, 1), heap())); });
  EXPECT_LT(refused({&view, 1}), 0.6 * converted);
  // Many that would fit one by one: not all of them are converted.
  const TestPath small = random(400, true, 7);
  std::vector<GpgpPath> many(300, small.view());
  for (GpgpPath& one : many) one.fillRule = GPGP_FILL_EVEN_ODD;
  const double each = seconds([&] { EXPECT_TRUE(vector::makeDrawing(std::span(many).first(5), heap())); }) / 5;
  EXPECT_LT(refused(many), 0.25 * 300 * each);
  // Tangles of which a dozen fit: none of them is converted, neither by the rule that makes many corners of each nor by
  // the one that makes few.
  const TestPath lines = random(3000, false);
  for (const GpgpFillRule rule : {GPGP_FILL_NON_ZERO, GPGP_FILL_EVEN_ODD}) {
    many.assign(30, lines.view());
    for (GpgpPath& one : many) one.fillRule = rule;
    const double one = seconds([&] { EXPECT_TRUE(vector::makeDrawing(std::span(many).first(1), heap())); });
    EXPECT_LT(refused(many), 5 * one) << rule;
  }
}

TEST(OutlineRoom, PathsOfADrawingCrossThemselvesSoOftenAndNoMore) {
  const auto makes = [](std::span<const GpgpPath> paths, uint64_t most) -> std::string {
    vector::OutlineRoom room(vector::outlineBytes(0), most);
    const auto drawing = vector::makeDrawing(paths, heap(), nullptr, nullptr, 0, &room);
    return drawing ? "" : drawing.error().text;
  };
  // Paths of which none is tangled by itself, so that each is converted before its crossings are known.
  const TestPath scribble = random(100, false);
  std::vector<GpgpPath> many(20, scribble.view());
  uint64_t crossings = 0;
  const auto line = [&](int i) { // by brute force
    return std::array{many[0].points[2 * i], many[0].points[2 * i + 1], many[0].points[2 * ((i + 1) % 101)],
                      many[0].points[2 * ((i + 1) % 101) + 1]};
  };
  const auto side = [](const auto& l, float x, float y) {
    return (static_cast<double>(l[2]) - static_cast<double>(l[0])) *
               (static_cast<double>(y) - static_cast<double>(l[1])) >
           (static_cast<double>(l[3]) - static_cast<double>(l[1])) *
               (static_cast<double>(x) - static_cast<double>(l[0]));
  };
  const int lines = static_cast<int>(many[0].pointCount);
  ASSERT_EQ(lines, 101);
  for (int i = 0; i < lines; ++i)
    for (int j = i + 2; j < lines; ++j) {
      const auto a = line(i), b = line(j);
      if (i == 0 && j == lines - 1) continue; // neighbours
      crossings += side(a, b[0], b[1]) != side(a, b[2], b[3]) && side(b, a[0], a[1]) != side(b, a[2], a[3]);
    }
  ASSERT_GT(crossings, 500u);
  EXPECT_EQ(makes(many, 21 * crossings), "");
  const std::string refused = makes(many, 10 * crossings);
  EXPECT_NE(refused.find("the drawing's paths cross themselves more than "), std::string::npos) << refused;
  EXPECT_TRUE(refused.starts_with("paths[1")) << refused << ": about the eleventh";
  // Thirty tangles, each far from what one path may have, are refused before any of them is converted.
  const TestPath tangle = random(2000, true);
  std::vector<GpgpPath> tangles(30, tangle.view());
  const double one = seconds([&] { EXPECT_EQ(makes(std::span(tangles).first(1), vector::kMaxDrawingCrossings), ""); });
  EXPECT_LT(seconds([&] {
              EXPECT_NE(makes(tangles, vector::kMaxDrawingCrossings).find("more than 8388608 times in all"),
                        std::string::npos);
            }),
            2 * one);
}

TEST(OutlineRoom, LargeTablesAreUsedAgain) {
  struct Counting : std::pmr::memory_resource {
    size_t held = 0, most = 0;
    void* do_allocate(size_t bytes, size_t alignment) override {
      most = std::max(most, held += bytes);
      return heap()->allocate(bytes, alignment);
    }
    void do_deallocate(void* data, size_t bytes, size_t alignment) override {
      held -= bytes;
      heap()->deallocate(data, bytes, alignment);
    }
    bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }
  } counting;
  const TestPath path = random(1000, true);
  GpgpPath view = path.view();
  view.fillRule = GPGP_FILL_EVEN_ODD; // the drawing is large as well
  {
    const auto drawing = vector::makeDrawing(std::span(&view, 1), &counting);
    ASSERT_TRUE(drawing);
    const size_t made = drawing->patches.size() * sizeof drawing->patches[0];
    EXPECT_GT(made, size_t(1) << 24);
    EXPECT_LT(counting.most, 4 * made); // 4.5 where each stage takes tables of its own
  }
  EXPECT_EQ(counting.held, 0u);
}

TEST(Crossings, InversionsAreCounted) {
  std::mt19937 random(5);
  std::pmr::vector<double> values(heap()), room(heap());
  for (size_t count : {0u, 1u, 2u, 3u, 31u, 32u, 33u, 200u}) {
    values.clear();
    for (size_t i = 0; i < count; ++i) values.push_back(static_cast<double>(random() % 50));
    size_t expected = 0;
    for (size_t i = 0; i < count; ++i)
      for (size_t k = i + 1; k < count; ++k) expected += values[i] > values[k];
    EXPECT_EQ(vector::countInversions(values, room), expected) << count;
    EXPECT_TRUE(std::is_sorted(values.begin(), values.end()));
  }
}

TEST(Crossings, AreNeverFewerThanWhatStripsSay) {
  for (const bool curves : {false, true}) {
    const TestPath path = random(150, curves, 6);
    std::pmr::vector<vector::Monotone> pieces(heap());
    ASSERT_TRUE(vector::outline(path.view(), pieces));
    vector::mergeCoincident(pieces);
    std::pmr::vector<vector::Cut> cuts(heap());
    ASSERT_TRUE(vector::findCrossings(pieces, cuts));
    const size_t found = cuts.size() / 2; // two pieces cross at each, but for those at an end of one
    size_t before = 0;
    for (const uint32_t strips : {8u, 64u, 512u}) {
      const size_t least = vector::leastCrossings(pieces, 0, kSide, strips, SIZE_MAX, heap());
      EXPECT_GT(least, before) << "finer strips see more";
      EXPECT_LE(least, found + 2);
      before = least;
    }
    EXPECT_GT(before, found * 8 / 10);
  }
}

/// The pieces of a path.
std::pmr::vector<vector::Monotone> piecesOf(const TestPath& path) {
  std::pmr::vector<vector::Monotone> pieces(heap());
  EXPECT_TRUE(vector::outline(path.view(), pieces));
  vector::mergeCoincident(pieces);
  return pieces;
}

TEST(Crossings, CutsAreWherePiecesMeetInOrderAndOnce) {
  for (const TestPath& path : {random(150, true, 6), random(300, false, 7), random(100, true, 8, 1e5f), fan(40)}) {
    const auto pieces = piecesOf(path);
    std::pmr::vector<vector::Cut> cuts(heap());
    ASSERT_TRUE(vector::findCrossings(pieces, cuts));
    ASSERT_GT(cuts.size(), 1000u);
    size_t alone = 0;
    for (size_t first = 0, end; first < cuts.size(); first = end) {
      for (end = first + 1; end < cuts.size() && cuts[end] >> 32 == cuts[first] >> 32;) ++end;
      ASSERT_TRUE(end == cuts.size() || cuts[first] < cuts[end]);
      const double y = vector::heightOfKey(cuts[first]), step = (std::abs(y) + kSide) * 1.5e-7;
      for (size_t i = first; i < end; ++i) {
        ASSERT_TRUE(i == first || cuts[i - 1] < cuts[i]) << "each once";
        const vector::Monotone& piece = pieces[vector::numberOfKey(cuts[i])];
        ASSERT_TRUE(y > piece.top() && y < piece.bottom());
        // Another piece is where this one is, within the rows that a float's rounding may be off.
        const double low = std::min(piece.xAt(y - step), piece.xAt(y + step)) - step,
                     high = std::max(piece.xAt(y - step), piece.xAt(y + step)) + step;
        const bool met = std::any_of(pieces.begin(), pieces.end(), [&](const vector::Monotone& other) {
          if (&other == &piece || y + step < other.top() || y - step > other.bottom()) return false;
          const double a = other.xAt(y - step), b = other.xAt(y + step);
          return std::max(a, b) >= low && std::min(a, b) <= high;
        });
        alone += !met;
      }
    }
    EXPECT_EQ(alone, 0u);
  }
}

TEST(Crossings, SlabsAreInTheOrderOfTheirTops) {
  for (const GpgpFillRule rule : {GPGP_FILL_NON_ZERO, GPGP_FILL_EVEN_ODD})
    for (const TestPath& path : {random(150, true, 6), bars(40), fan(60), sharedSides(60)}) {
      const auto pieces = piecesOf(path);
      std::pmr::vector<vector::Cut> cuts(heap());
      std::pmr::vector<vector::Slab> slabs(heap());
      ASSERT_TRUE(vector::findCrossings(pieces, cuts));
      ASSERT_TRUE(vector::sweep(pieces, cuts, rule, slabs));
      ASSERT_FALSE(slabs.empty());
      for (size_t i = 0; i < slabs.size(); ++i) {
        ASSERT_LT(slabs[i].top, slabs[i].bottom);
        ASSERT_TRUE(i == 0 ||
                    std::tuple(slabs[i - 1].top, slabs[i - 1].left) < std::tuple(slabs[i].top, slabs[i].left));
      }
    }
}

TEST(Crossings, PlacesFoundFromNearbyAreThoseFoundFromNowhere) {
  const auto pieces = piecesOf(random(300, true, 12));
  std::mt19937 random(4);
  std::uniform_real_distribution<double> part(0, 1);
  double worst = 0;
  for (size_t i = 0; i + 1 < pieces.size(); ++i) {
    const vector::Monotone &a = pieces[i], &b = pieces[i + 1];
    std::array<double, 2> t{part(random), part(random)};
    for (int k = 0; k < 40; ++k) {
      const double y = std::min(a.top(), b.top()) + (std::max(a.bottom(), b.bottom()) - std::min(a.top(), b.top())) *
                                                        (k % 2 ? part(random) : k / 40.0);
      const auto near = vector::xsNear(a, b, y, t);
      worst = std::max({worst, std::abs(near[0] - a.xAt(y)), std::abs(near[1] - b.xAt(y))});
      double alone = part(random);
      worst = std::max(worst, std::abs(a.xNear(y, alone) - a.xAt(y)));
    }
  }
  EXPECT_LT(worst, 1e-8 * static_cast<double>(kSide));
}

TEST(Crossings, TheStatusIsAList) {
  constexpr uint32_t kSlots = 200;
  vector::Status status(kSlots, heap());
  std::vector<std::pair<double, uint32_t>> list; // by value
  std::vector<double> valueOf(kSlots + 1);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(0, 1);
  for (int turn = 0; turn < 20000; ++turn) {
    const size_t at = list.empty() ? 0 : random() % list.size();
    const bool grow = (turn / 2000) % 2 == 0;
    if (list.size() < kSlots && (list.empty() || random() % 8 < (grow ? 4 : 2))) {
      const double value = any(random);
      const uint32_t slot = status.insert([&](uint32_t other) { return value < valueOf[other]; });
      ASSERT_LT(slot, kSlots);
      valueOf[slot] = value;
      list.insert(std::upper_bound(list.begin(), list.end(), std::pair(value, slot)), {value, slot});
    } else if (random() % 2) {
      status.mark(list[at].second, random() % 3 == 0);
    } else {
      status.erase(list[at].second);
      list.erase(list.begin() + static_cast<ptrdiff_t>(at));
    }
    if (turn % 16) continue;
    for (size_t i = 0; i < list.size(); ++i) {
      const uint32_t slot = list[i].second;
      ASSERT_EQ(status.before(slot), i ? list[i - 1].second : status.end());
      ASSERT_EQ(status.after(slot), i + 1 < list.size() ? list[i + 1].second : status.end());
      uint32_t left = status.end(), right = status.end();
      for (size_t k = i; k-- > 0 && left == status.end();)
        if (status.marked(list[k].second)) left = list[k].second;
      for (size_t k = i + 1; k < list.size() && right == status.end(); ++k)
        if (status.marked(list[k].second)) right = list[k].second;
      ASSERT_EQ(status.markedBefore(slot), left);
      ASSERT_EQ(status.markedAfter(slot), right);
    }
  }
}

} // namespace
