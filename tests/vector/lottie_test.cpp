// Lottie without a device: easing, arc lengths and shapes by closed forms, layers by properties, and what is said of
// files that are not supported, not valid or hostile.
#include "lottie_file.h"
#include "vector/import/lottie/evaluate.h"
#include "vector/import/lottie/path.h"

#include <cmath>
#include <cstring>
#include <functional>
#include <random>
#include <zlib.h>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using namespace gpgp::vector;
using namespace gpgp::vector::lottie;
using Curve = std::array<Point, 4>;

constexpr double kPi = 3.14159265358979323846;

std::vector<Point> pointsOf(const GpgpLottieFrame& frame, uint32_t path = 0) {
  std::vector<Point> points;
  if (path >= frame.pathCount) return points;
  for (uint32_t i = 0; i < frame.paths[path].pointCount; ++i)
    points.push_back({static_cast<double>(frame.paths[path].points[2 * i]),
                      static_cast<double>(frame.paths[path].points[2 * i + 1])});
  return points;
}

TEST(Lottie, EasingIsTheCurveOfItsControlPoints) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> at(0, 1), over(-1, 2);
  for (int i = 0; i < 200; ++i) {
    const Easing easing{at(random), over(random), at(random), over(random)};
    for (int k = 1; k < 20; ++k) { // any parameter gives a point of the curve
      const double t = k / 20.0, s = 1 - t;
      const double x = 3 * s * s * t * easing.x1 + 3 * s * t * t * easing.x2 + t * t * t;
      const double y = 3 * s * s * t * easing.y1 + 3 * s * t * t * easing.y2 + t * t * t;
      const double slope = 3 * s * s * easing.x1 + 6 * s * t * (easing.x2 - easing.x1) + 3 * t * t * (1 - easing.x2);
      if (slope > 0.05) {
        EXPECT_NEAR(easing.at(x), y, 1e-9) << i << ' ' << k;
      }
    }
    EXPECT_EQ(easing.at(0), 0);
    EXPECT_EQ(easing.at(1), 1);
  }
  EXPECT_NEAR((Easing{0, 0, 1, 1}.at(0.3)), 0.3, 1e-12);
}

TEST(Lottie, LengthsAreThoseOfTheCurves) {
  const Curve line{{{1, 2}, {2, 4}, {3, 6}, {4, 8}}};
  EXPECT_NEAR(lengthOfCubic(line), std::hypot(3, 6), 1e-12);
  EXPECT_NEAR(parameterAt(line, std::hypot(3, 6) / 4), 0.25, 1e-9);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(0, 100);
  for (int i = 0; i < 50; ++i) {
    Curve c;
    for (Point& p : c) p = {at(random), at(random)};
    double sum = 0; // of a polygon with many corners
    Point before = c[0];
    for (int k = 1; k <= 20'000; ++k) {
      const Point p = pointOfCubic(c, k / 20'000.0);
      sum += std::hypot(p.x - before.x, p.y - before.y);
      before = p;
    }
    EXPECT_NEAR(lengthOfCubic(c), sum, 5e-4 * sum) << i; // a cusp is the worst
    const double half = parameterAt(c, sum / 2);
    EXPECT_NEAR(lengthOfCubic(c, half), sum / 2, 5e-4 * sum) << i;
  }
}

TEST(Lottie, PolystarsHaveTheirVerticesOnTwoCircles) {
  for (const bool polygon : {false, true})
    for (const double n : {3.0, 5.0, 8.0}) {
      const Star star{polygon, false, {10, 20}, n, 30, 8, 25, 0, 0};
      const Contour contour = starOf(star);
      const auto count = static_cast<size_t>(polygon ? n : 2 * n);
      ASSERT_EQ(contour.vertices.size(), count);
      for (size_t i = 0; i < count; ++i) {
        const double angle = (-90 + 30 + 360.0 * static_cast<double>(i) / static_cast<double>(count)) * kPi / 180;
        const double radius = polygon || i % 2 == 0 ? 25 : 8;
        EXPECT_NEAR(contour.vertices[i].at.x, 10 + radius * std::cos(angle), 1e-9);
        EXPECT_NEAR(contour.vertices[i].at.y, 20 + radius * std::sin(angle), 1e-9);
      }
    }
  // A polygon of many round corners is a circle.
  const Contour circle = starOf({true, false, {0, 0}, 64, 0, 0, 50, 0, 100});
  for (size_t i = 0; i < circle.segments(); ++i)
    for (const double t : {0.25, 0.5, 0.75}) {
      const Point p = pointOfCubic(circle.segment(i), t);
      EXPECT_NEAR(std::hypot(p.x, p.y), 50, 0.02);
    }
}

TEST(Lottie, TrimsCutByLength) {
  const Contour ellipse = ellipseOf({0, 0}, {80, 40}, false);
  const double whole = ellipse.length();
  for (const auto& [from, to] : std::vector<std::pair<double, double>>{{0, 0.5}, {0.5, 1}, {0.13, 0.27}, {0.9, 1.4}}) {
    double sum = 0;
    for (const Contour& piece : trimmedAround(ellipse, from, to)) sum += piece.length();
    EXPECT_NEAR(sum, (to - from) * whole, 1e-6 * whole) << from << ' ' << to;
  }
  // Both halves together are the whole: they meet, and lie on it.
  const Contour first = trimmed(ellipse, 0, 0.5), second = trimmed(ellipse, 0.5, 1);
  EXPECT_EQ(first.vertices.front().at, ellipse.vertices.front().at);
  EXPECT_NEAR(first.vertices.back().at.x, second.vertices.front().at.x, 1e-6);
  EXPECT_NEAR(first.vertices.back().at.y, second.vertices.front().at.y, 1e-6);
  for (const Contour* half : {&first, &second})
    for (size_t i = 0; i < half->segments(); ++i)
      for (const double t : {0.0, 0.3, 0.7}) {
        const Point p = pointOfCubic(half->segment(i), t);
        EXPECT_NEAR(std::hypot(p.x / 40, p.y / 20), 1, 1e-3);
      }
  EXPECT_EQ(trimmedAround(ellipse, 0.25, 1.25)[0].vertices.size(), ellipse.vertices.size())
      << "all of it, still closed";
}

TEST(Lottie, RepeatedTransformsAreThemselvesOverAndOver) {
  Transform t;
  t.anchor.value = {3, 4}, t.position.value = {7, -2}, t.scale.value = {100, 100}, t.rotation.value = {20};
  const Affine once = repeatedMatrix(t, 0, 1);
  // With an anchor that the step moves, only the turn adds up: compare what three steps do to the anchor and to turns.
  const Affine thrice = repeatedMatrix(t, 0, 3);
  EXPECT_NEAR(std::atan2(thrice.b, thrice.a), 3 * std::atan2(once.b, once.a), 1e-12);
  const Point anchor = thrice({3, 4});
  EXPECT_NEAR(anchor.x, 3 + 21, 1e-12);
  EXPECT_NEAR(anchor.y, 4 - 6, 1e-12);
  EXPECT_EQ(repeatedMatrix(t, 0, 0)(Point{5, 6}), (Point{5, 6}));
}

TEST(Lottie, ParentsMultiply) {
  // Point by point, without matrices: anchor, scale, turn, position, from the innermost outwards.
  struct Step {
    double px, py, ax, ay, sx, sy, r;
  };
  const Step steps[] = {{50, 40, 0, 0, 120, 80, 33}, {20, 5, 1, 2, 90, 110, -50}, {5, 10, 2, 2, 100, 100, 15}};
  const auto ks = [](const Step& s) {
    const auto pair = [](double a, double b) {
      return "{\"k\":[" + std::to_string(a) + "," + std::to_string(b) + "]}";
    };
    return "{\"p\":" + pair(s.px, s.py) + ",\"a\":" + pair(s.ax, s.ay) + ",\"s\":" + pair(s.sx, s.sy) +
           ",\"r\":{\"k\":" + std::to_string(s.r) + "}}";
  };
  const std::string text = animation(R"({"ty":3,"ind":1,"ip":0,"op":60,"ks":)" + ks(steps[0]) +
                                     R"(},{"ty":3,"ind":2,"parent":1,"ip":50,"op":60,"ks":)" + ks(steps[1]) + "}," +
                                     shapeLayer(kSquare + "," + kRed, ks(steps[2]), R"("ind":3,"parent":2,)"));
  LottieFile file(text);
  const std::vector<Point> got = pointsOf(file.at(0));
  ASSERT_EQ(got.size(), 4u);
  const Point corners[] = {{20, 15}, {20, 25}, {0, 25}, {0, 15}};
  for (size_t i = 0; i < 4; ++i) {
    Point p = corners[i];
    for (size_t k = 3; k-- > 0;) {
      const Step& s = steps[k];
      const double x = (p.x - s.ax) * s.sx / 100, y = (p.y - s.ay) * s.sy / 100, r = s.r * kPi / 180;
      p = {s.px + x * std::cos(r) - y * std::sin(r), s.py + x * std::sin(r) + y * std::cos(r)};
    }
    EXPECT_NEAR(got[i].x, p.x, 1e-4) << i;
    EXPECT_NEAR(got[i].y, p.y, 1e-4) << i;
  }
}

TEST(Lottie, SkewShearsAlongItsAxis) {
  Transform t;
  t.skew.value = {30};
  const double shear = std::tan(30 * kPi / 180);
  const Affine along = matrixOf(t, 0); // horizontal: x moves with y
  EXPECT_NEAR(along({0, 1}).x, -shear, 1e-12);
  EXPECT_NEAR(along({0, 1}).y, 1, 1e-12);
  t.skewAxis.value = {90};
  const Affine across = matrixOf(t, 0); // y moves with x
  EXPECT_NEAR(across({1, 0}).x, 1, 1e-12);
  EXPECT_NEAR(std::fabs(across({1, 0}).y), shear, 1e-12);
}

TEST(Lottie, HoldsAreStillPictures) {
  const std::string held =
      R"({"p":{"a":1,"k":[{"t":0,"s":[10,10],"h":1},{"t":20,"s":[40,30],"h":1}]},"r":{"a":1,"k":[{"t":0,"s":[0],"h":1},{"t":20,"s":[45],"h":1}]}})";
  const std::string text = animation(shapeLayer(kSquare + "," + kRed, held));
  LottieFile moving(text);
  const std::string before = animation(shapeLayer(kSquare + "," + kRed, R"({"p":{"k":[10,10]}})")),
                    behind = animation(shapeLayer(kSquare + "," + kRed, R"({"p":{"k":[40,30]},"r":{"k":45}})"));
  LottieFile first(before), second(behind);
  const uint64_t early = moving.at(3).content;
  EXPECT_EQ(early, first.at(0).content);
  EXPECT_EQ(moving.at(19.9).content, early);
  EXPECT_NE(moving.at(20).content, early);
  EXPECT_EQ(moving.at(20).content, second.at(59).content);
  EXPECT_EQ(moving.at(1e9).content, second.at(59).content) << "the last moment stays";
  EXPECT_EQ(moving.at(-5).content, early);
}

TEST(Lottie, PositionsMoveEvenlyAlongTheirCurve) {
  Property position;
  Keyframe a, b;
  a.start = {0, 0}, a.curved = true, a.by = {Point{0, 60}, Point{-90, 0}};
  b.time = 10, b.start = {100, 0};
  position.keys = {a, b};
  const Curve c{{{0, 0}, {0, 60}, {10, 0}, {100, 0}}};
  const double whole = lengthOfCubic(c);
  for (int k = 1; k < 10; ++k) {
    const Point p = position.point(k), want = pointOfCubic(c, parameterAt(c, whole * k / 10));
    EXPECT_NEAR(p.x, want.x, 1e-6);
    EXPECT_NEAR(p.y, want.y, 1e-6);
  }
  EXPECT_NEAR(position.direction(0.01), kPi / 2, 0.05) << "it starts downwards";
  EXPECT_NEAR(position.direction(9.99), 0, 0.05);
}

TEST(Lottie, TrimmedHalvesCoverTheWhole) {
  const auto text = [](double from, double to) {
    return animation(shapeLayer(
        kSquare + R"(,{"ty":"tm","m":1,"s":{"k":)" + std::to_string(from) + R"(},"e":{"k":)" + std::to_string(to) +
        R"(},"o":{"k":0}},{"ty":"st","c":{"k":[0,0,1]},"o":{"k":100},"w":{"k":2},"lc":1,"lj":1})"));
  };
  const auto area = [](const GpgpLottieFrame& frame) { // of outlines that do not overlap themselves
    double sum = 0;
    for (uint32_t i = 0; i < frame.pathCount; ++i) {
      const std::vector<Point> p = pointsOf(frame, i);
      for (size_t k = 0; k < p.size(); ++k) {
        const Point a = p[k], b = p[(k + 1) % p.size()];
        sum += (a.x * b.y - b.x * a.y) / 2;
      }
    }
    return std::fabs(sum);
  };
  const std::string a = text(0, 50), b = text(50, 100), none = text(30, 30);
  LottieFile first(a), second(b), empty(none);
  EXPECT_GT(area(first.at(0)), 50);
  EXPECT_EQ(empty.at(0).pathCount, 0u);
  // A rectangle's way is 60 long: half of it, 2 wide, turns two corners, whose outlines overlap by little.
  EXPECT_NEAR(area(first.at(0)), 60, 4);
  EXPECT_NEAR(area(second.at(0)), 60, 4);
}

/// Trims one after another take their lengths from all paths in their order.
TEST(Lottie, SequentialTrimsRunFromPathToPath) {
  const auto line = [](double y) {
    return R"({"ty":"sh","ks":{"k":{"v":[[0,)" + std::to_string(y) + "],[30," + std::to_string(y) +
           R"(]],"c":false}}},)";
  };
  const auto text = [&](double from, double to) { // lines of 30, each 2 wide
    return animation(
        shapeLayer(line(10) + line(20) + line(30) + R"({"ty":"tm","m":2,"s":{"k":)" + std::to_string(from) +
                   R"(},"e":{"k":)" + std::to_string(to) +
                   R"(},"o":{"k":0}},{"ty":"st","c":{"k":[0,0,1]},"o":{"k":100},"w":{"k":2},"lc":1,"lj":1})"));
  };
  const auto spans = [&](double from, double to) { // left and right of what is left of each line
    const std::string json = text(from, to);
    LottieFile file(json);
    std::vector<std::array<double, 2>> found(3, {1e9, -1e9});
    for (const Point& p : pointsOf(file.at(0))) {
      std::array<double, 2>& of = found[static_cast<size_t>(std::lround(p.y / 10)) - 1];
      of = {std::min(of[0], p.x), std::max(of[1], p.x)};
    }
    return found;
  };
  const auto middle = spans(50, 90); // 45 to 81 of 90
  EXPECT_GT(middle[0][0], 1e8) << "nothing of the first";
  EXPECT_NEAR(middle[1][0], 15, 0.01);
  EXPECT_NEAR(middle[1][1], 30, 0.01);
  EXPECT_NEAR(middle[2][0], 0, 0.01);
  EXPECT_NEAR(middle[2][1], 21, 0.01);
}

TEST(Lottie, CompositionsHaveTheirOwnTime) {
  const std::string moving =
      shapeLayer(kSquare + "," + kRed,
                 R"({"p":{"a":1,"k":[{"t":0,"s":[0,0],"i":{"x":1,"y":1},"o":{"x":0,"y":0}},{"t":60,"s":[60,0]}]}})");
  const auto text = [&](const std::string& more) {
    return animation(R"({"ty":0,"refId":"a","ip":0,"op":60,"w":100,"h":100,"ks":{},)" + more + R"("nm":""})",
                     R"("assets":[{"id":"a","layers":[)" + moving + "]}],");
  };
  const std::string
      plain = text(""),
      stretched = text(R"("st":6,"sr":2,)"),
      remapped = text(R"("tm":{"a":1,"k":[{"t":0,"s":[0],"i":{"x":1,"y":1},"o":{"x":0,"y":0}},{"t":30,"s":[1.5]}]},)");
  LottieFile own(plain), slow(stretched), fast(remapped);
  const auto left = [](LottieFile& file, double frame) {
    const std::vector<Point> points = pointsOf(file.at(frame));
    return points.empty() ? -1 : points[2].x;
  };
  EXPECT_NEAR(left(own, 20), 20, 1e-4);
  EXPECT_NEAR(left(slow, 46), 20, 1e-4) << "(46 - 6) / 2";
  EXPECT_NEAR(left(slow, 45), 19.5, 1e-4);
  EXPECT_NEAR(left(fast, 20), 30, 1e-4) << "a second at 30 frames a second";
  EXPECT_NEAR(left(fast, 59), 45, 1e-4) << "it stays";
}

TEST(Lottie, RepeatersStackAsTheyAreTold) {
  const auto text = [](const std::string& mode) {
    return animation(shapeLayer(kSquare + "," + kRed + R"(,{"ty":"rp","c":{"k":3},"o":{"k":0},"m":)" + mode +
                                R"(,"tr":{"p":{"k":[5,0]},"so":{"k":100},"eo":{"k":40}}})"));
  };
  for (const bool lastOnTop : {false, true}) {
    const std::string json = text(lastOnTop ? "2" : "1");
    LottieFile file(json);
    const GpgpLottieFrame frame = file.at(0);
    ASSERT_EQ(frame.pathCount, 3u);
    for (uint32_t i = 0; i < 3; ++i) { // from the bottom up
      const double copy = lastOnTop ? i : 2 - i;
      EXPECT_NEAR(pointsOf(frame, i)[2].x, 5 * copy, 1e-4);
      EXPECT_NEAR(frame.paths[i].color[3], 1 - 0.3 * copy, 1e-6);
    }
  }
}

TEST(Lottie, GlyphsAdvanceByWidthAndTracking) {
  const auto text = [](int justify) {
    return animation(
        R"({"ty":5,"ip":0,"op":60,"ks":{},"t":{"d":{"k":[{"t":0,"s":{"s":20,"f":"Own","t":"AA A\rA","j":)" +
            std::to_string(justify) + R"(,"tr":100,"lh":30,"fc":[0,0,0]}}]},"a":[]}})",
        R"("fonts":{"list":[{"fName":"Own","fFamily":"Own","fStyle":"Regular"}]},"chars":[
{"ch":"A","size":100,"style":"Regular","fFamily":"Own","w":60,"data":{"shapes":[{"ty":"sh","ks":{"k":{"v":[[0,0],[50,0],[0,-70]],"c":true}}}]}},
{"ch":" ","size":100,"style":"Regular","fFamily":"Own","w":25,"data":{}}],)");
  };
  // Each A takes 12, the blank 5, and tracking adds 2 behind each: the third begins at 2 * 14 + 7.
  for (int justify = 0; justify < 3; ++justify) {
    const std::string json = text(justify);
    LottieFile file(json);
    EXPECT_TRUE(file.messages.empty()) << file.messages[0];
    const GpgpLottieFrame frame = file.at(0);
    ASSERT_EQ(frame.pathCount, 2u) << "a path for each line";
    const double width = 2 * 14 + 7 + 12, left = justify == 1 ? -width : justify == 2 ? -width / 2 : 0;
    const std::vector<Point> first = pointsOf(frame, 0), second = pointsOf(frame, 1);
    ASSERT_EQ(first.size(), 9u);
    for (size_t i = 0; i < 3; ++i) {
      const double begin = left + (i == 0 ? 0 : i == 1 ? 14 : 35);
      EXPECT_NEAR(first[3 * i].x, begin, 1e-4);
      EXPECT_NEAR(first[3 * i + 2].y, -14, 1e-4) << "a fifth of 70";
    }
    EXPECT_NEAR(second[0].x, justify == 1 ? -12 : justify == 2 ? -6 : 0, 1e-4);
    EXPECT_NEAR(second[0].y, 30, 1e-4);
  }
}

TEST(Lottie, LayersShowBetweenInAndOut) {
  const std::string text = animation(R"({"ty":1,"sw":10,"sh":10,"sc":"#ff0000","ip":10,"op":20,"st":0,"ks":{}})");
  LottieFile file(text);
  EXPECT_EQ(file.at(9.99).pathCount, 0u);
  EXPECT_EQ(file.at(10).pathCount, 1u);
  EXPECT_EQ(file.at(19.99).pathCount, 1u);
  EXPECT_EQ(file.at(20).pathCount, 0u);
  const GpgpLottieFrame shown = file.at(15);
  EXPECT_NEAR(shown.paths[0].color[0], 1, 1e-6);
}

TEST(Lottie, InfoIsWhatTheFileSays) {
  const std::string text = animation(shapeLayer(kSquare));
  LottieFile file(text);
  const auto info = file.lottie.info();
  ASSERT_TRUE(info);
  EXPECT_EQ(info->width, 100);
  EXPECT_EQ(info->frameRate, 30);
  EXPECT_EQ(info->endFrame, 60);
  EXPECT_EQ(info->layers, 1u);
  EXPECT_TRUE(file.messages.empty());
}

TEST(Lottie, WhatIsNotSupportedIsNamedOnceWithItsPlace) {
  const std::string text = animation(
      shapeLayer(kSquare + R"(,{"ty":"fl","c":{"k":[1,0,0]},"o":{"k":100,"x":"wiggle"
}
},{"ty":"op","a":{"k":3}})",
                 R"({"r":{"k":0,"x":"time*3"}})") +
      R"(,{"ty":13,"ks":{}},{"ty":4,"ddd":1,"bm":17,"ks":{},"shapes":[{"ty":"mm","mm":4}],"ef":[{"ty":22,"nm":"Wave"}],"masksProperties":[{"mode":"f"}]})");
  LottieFile file(text);
  ASSERT_EQ(file.result, GPGP_SUCCESS);
  const auto count = [&](std::string_view part) {
    return std::count_if(file.messages.begin(), file.messages.end(),
                         [&](const std::string& m) { return m.find(part) != m.npos; });
  };
  EXPECT_EQ(count("expressions"), 1);
  EXPECT_EQ(count("test.json: layers[0].ks.r: expressions"), 1) << file.messages[0];
  EXPECT_EQ(count("test.json: layers[0].shapes[2]: offset paths"), 1);
  EXPECT_EQ(count("layers[1]: cameras"), 1);
  EXPECT_EQ(count("layers[2]: layers in three dimensions"), 1);
  EXPECT_EQ(count("layers[2]: blend mode 17"), 1);
  EXPECT_EQ(count("layers[2].shapes[0]: merge paths: intersect"), 1);
  EXPECT_EQ(count("layers[2].ef[0]: effect 22 ('Wave')"), 1);
  EXPECT_EQ(count("layers[2].masksProperties[0]: the mask mode 'f'"), 1);
  EXPECT_EQ(file.at(0).pathCount, 1u) << "the rest is drawn";
}

TEST(Lottie, ErrorsHaveTheirPlace) {
  const auto firstMessage = [](const std::string& text) {
    LottieFile file(text);
    EXPECT_EQ(file.result, GPGP_ERROR_INVALID_DATA) << text.substr(0, 60);
    EXPECT_EQ(file.lottie.get(), nullptr);
    return file.messages.empty() ? std::string() : file.messages[0];
  };
  EXPECT_EQ(firstMessage("{\n \"w\": 3,\n x}"), "test.json:3:2: not JSON");
  EXPECT_EQ(firstMessage("[1,2]"), "test.json: no Lottie animation: it has no layers");
  EXPECT_EQ(firstMessage(R"({"layers":[],"w":0})"), "test.json: w: the width must be above 0 and at most 1e6");
  EXPECT_EQ(firstMessage(R"({"layers":[],"w":9,"h":9,"fr":30,"ip":5,"op":5})"),
            "test.json: op: the animation must end after it begins");
  EXPECT_NE(firstMessage("").find("not JSON"), std::string::npos);
}

TEST(Lottie, TheApiChecksItsArguments) {
  GpgpLottie handle = nullptr;
  GpgpLottieSource source = GPGP_LOTTIE_SOURCE_INIT;
  EXPECT_EQ(gpgpCreateLottie(nullptr, &handle), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpCreateLottie(&source, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  source.size = 3;
  EXPECT_EQ(gpgpCreateLottie(&source, &handle), GPGP_ERROR_INVALID_ARGUMENT);
  source.sType = GPGP_STRUCTURE_SVG_SOURCE;
  EXPECT_EQ(gpgpCreateLottie(&source, &handle), GPGP_ERROR_INVALID_STRUCT);
  gpgpDestroyLottie(nullptr);
  GpgpLottieFrame frame = GPGP_LOTTIE_FRAME_INIT;
  EXPECT_EQ(gpgpEvaluateLottie(nullptr, 0, &frame), GPGP_ERROR_INVALID_HANDLE);
  const std::string text = animation(shapeLayer(kSquare + "," + kRed));
  LottieFile file(text);
  EXPECT_EQ(gpgpEvaluateLottie(file.lottie, std::nan(""), &frame), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpEvaluateLottie(file.lottie, 0, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpCompileLottieFrame(file.lottie, 0, nullptr, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  const auto blob = file.lottie.compile(0);
  ASSERT_TRUE(blob);
  EXPECT_GT(blob->size(), 100u);
}

/// A zip archive of one file after another; those that end in "*" are deflated.
std::string zipOf(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string zip, directory;
  const auto put = [](std::string& to, uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) to += static_cast<char>(value >> (8 * i) & 255);
  };
  for (const auto& file : files) {
    std::string name = file.first, data = file.second;
    const bool packed = name.back() == '*';
    if (packed) name.pop_back();
    const auto sum =
        static_cast<uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(data.data()), static_cast<uInt>(data.size())));
    std::string bytes = data;
    if (packed) {
      z_stream stream{};
      deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
      bytes.resize(data.size() + 100);
      stream.next_in = reinterpret_cast<Bytef*>(data.data()), stream.avail_in = static_cast<uInt>(data.size());
      stream.next_out = reinterpret_cast<Bytef*>(bytes.data()), stream.avail_out = static_cast<uInt>(bytes.size());
      deflate(&stream, Z_FINISH);
      bytes.resize(stream.total_out);
      deflateEnd(&stream);
    }
    const auto fields = [&](std::string& to) {
      put(to, 20, 2), put(to, 0, 2), put(to, packed ? 8 : 0, 2), put(to, 0, 4), put(to, sum, 4);
      put(to, static_cast<uint32_t>(bytes.size()), 4), put(to, static_cast<uint32_t>(data.size()), 4);
      put(to, static_cast<uint32_t>(name.size()), 2), put(to, 0, 2);
    };
    const auto offset = static_cast<uint32_t>(zip.size());
    put(directory, 0x02014b50, 4), put(directory, 20, 2), fields(directory);
    put(directory, 0, 2), put(directory, 0, 2), put(directory, 0, 2), put(directory, 0, 4), put(directory, offset, 4);
    directory += name;
    put(zip, 0x04034b50, 4), fields(zip);
    zip += name + bytes;
  }
  const auto begin = static_cast<uint32_t>(zip.size());
  zip += directory;
  put(zip, 0x06054b50, 4), put(zip, 0, 4), put(zip, static_cast<uint32_t>(files.size()), 2),
      put(zip, static_cast<uint32_t>(files.size()), 2), put(zip, static_cast<uint32_t>(directory.size()), 4),
      put(zip, begin, 4), put(zip, 0, 2);
  return zip;
}

TEST(Lottie, ArchivesHoldAnimationsAndImages) {
  const std::string json =
      animation(shapeLayer(kSquare + "," + kRed) + R"(,{"ty":2,"refId":"i","ip":0,"op":60,"ks":{}})",
                R"("assets":[{"id":"i","w":8,"h":4,"u":"/images/","p":"a.png","e":0}],)");
  LottieFile plain(json);
  ASSERT_EQ(plain.result, GPGP_SUCCESS);
  EXPECT_TRUE(plain.said("images are not supported here"));
  for (const bool second : {false, true}) {
    const std::string zip = zipOf({{"manifest.json", R"({"animations":[{"id":"own"}]})"},
                                   {second ? "a/other.json" : "animations/other.json", "{}"},
                                   {second ? "a/own.json*" : "animations/own.json*", json},
                                   {second ? "i/a.png*" : "images/a.png", "picture"}});
    std::string given;
    GpgpLottieSource source = GPGP_LOTTIE_SOURCE_INIT;
    source.imageUserData = &given;
    source.imageFn = [](void* user, uint32_t index, const void* data, size_t size, uint32_t* width,
                        uint32_t* height) -> VkBool32 {
      EXPECT_EQ(index, 0u);
      static_cast<std::string*>(user)->assign(static_cast<const char*>(data), size);
      *width = 2, *height = 2;
      return VK_TRUE;
    };
    LottieFile file(zip, source);
    ASSERT_EQ(file.result, GPGP_SUCCESS) << (file.messages.empty() ? "" : file.messages[0]);
    EXPECT_EQ(given, "picture");
    const GpgpLottieFrame frame = file.at(0);
    ASSERT_EQ(frame.pathCount, 2u);
    ASSERT_NE(frame.paths[0].image, nullptr) << "below the shape";
    EXPECT_EQ(frame.paths[0].image->transform[0], 8) << "as large as the file says";
    for (size_t cut = 1; cut < zip.size(); cut += 7) { // damaged, it is refused
      const std::string part = zip.substr(0, cut);
      LottieFile damaged(part);
      EXPECT_EQ(damaged.result, GPGP_ERROR_INVALID_DATA) << cut;
    }
  }
  const std::string none = zipOf({{"readme.txt", "hello"}});
  EXPECT_TRUE(LottieFile(none).said("the archive holds no animation"));
}

} // namespace
