// Strokes: with round joins and caps a point is inside exactly where the path is no farther than half a width, which
// needs no other stroker to judge; joins, butt and square caps, and dashes are compared with cairo's.
#include "oracle.h"
#include "vector/geometry/contour.h"
#include "vector/geometry/offset.h"
#include "vector/geometry/stroke.h"

#include <gtest/gtest.h>

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using vector::Cap;
using vector::Join;
using vector::Point;
using vector::Shape;
using vector::StrokeStyle;

/// The shape as floats, as the rest of the service gets it.
struct Flattened {
  std::vector<GpgpPathVerb> verbs;
  std::vector<float> points;
  explicit Flattened(const Shape& shape) : verbs(shape.verbs.begin(), shape.verbs.end()) {
    for (const Point& p : shape.points) {
      points.push_back(static_cast<float>(p.x));
      points.push_back(static_cast<float>(p.y));
    }
  }
  GpgpPath view() const {
    return {verbs.data(),       static_cast<uint32_t>(verbs.size()),
            points.data(),      uint32_t(points.size() / 2),
            GPGP_FILL_NON_ZERO, {0, 0, 0, 1}};
  }
};

/// Points along a path, closer together than `step`, with the arc length before each.
struct Walk {
  std::vector<Point> points;
  std::vector<double> along;
  std::vector<bool> begins; // a contour
};
Walk walk(const Shape& shape, double step) {
  Walk w;
  Point at, start;
  double done = 0;
  size_t next = 0;
  const auto add = [&](Point p, bool begins) {
    if (!begins && !w.points.empty()) done += std::hypot(p.x - w.points.back().x, p.y - w.points.back().y);
    w.points.push_back(p);
    w.along.push_back(begins ? done = 0 : done);
    w.begins.push_back(begins);
  };
  const auto curve = [&](const vector::Cubic& c) {
    double hull = 0;
    for (int i = 0; i < 3; ++i) hull += std::hypot(c.p[i + 1].x - c.p[i].x, c.p[i + 1].y - c.p[i].y);
    const int n = static_cast<int>(std::ceil(3 * hull / step)) + 1;
    for (int i = 1; i <= n; ++i) add(c.at(static_cast<double>(i) / n), false);
    at = c.p[3];
  };
  for (const GpgpPathVerb verb : shape.verbs) {
    const Point* p = shape.points.data() + next;
    switch (verb) {
    case GPGP_PATH_MOVE: add(start = at = p[0], true), next += 1; break;
    case GPGP_PATH_LINE: curve(vector::Cubic::fromLine(at, p[0])), next += 1; break;
    case GPGP_PATH_QUAD: curve(vector::Cubic::fromQuadratic(at, p[0], p[1])), next += 2; break;
    case GPGP_PATH_CUBIC: curve({{at, p[0], p[1], p[2]}}), next += 3; break;
    default: curve(vector::Cubic::fromLine(at, start)); break;
    }
  }
  return w;
}

double distance(Point p, Point a, Point b) {
  const Point d = b - a, q = p - a;
  const double l = d.x * d.x + d.y * d.y, t = l > 0 ? std::clamp((d.x * q.x + d.y * q.y) / l, 0.0, 1.0) : 0;
  return std::hypot(q.x - t * d.x, q.y - t * d.y);
}

struct Verdict {
  size_t tested = 0, wrong = 0, inside = 0;
  Point first;
};

/// Whether a round stroke is the set of points within half a width of the walk's parts that `on` allows.
template <class On>
Verdict judge(const Shape& shape, const StrokeStyle& style, double tolerance, int points, uint32_t seed, On&& on) {
  Shape stroked;
  EXPECT_TRUE(vector::strokeShape(shape, style, tolerance, {}, stroked));
  const Flattened flat(stroked);
  const PathOracle oracle(flat.view());
  const Walk w = walk(shape, tolerance * 4);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Verdict v;
  const double h = style.width / 2;
  for (int i = 0; i < points; ++i) {
    // Near the edge, mostly: where mistakes are.
    const Point near = w.points[random() % w.points.size()];
    const double angle = 2 * std::numbers::pi * unit(random), r = h * (i % 4 ? 0.9 + 0.3 * unit(random) : unit(random));
    const Point p{near.x + r * std::cos(angle), near.y + r * std::sin(angle)};
    double d = 1e30;
    for (size_t k = 0; k < w.points.size(); ++k) {
      const bool joined = k > 0 && !w.begins[k];
      // Farther than any step could reach.
      if (std::abs(w.points[k].x - p.x) + std::abs(w.points[k].y - p.y) > 2 * h + 8 * tolerance) continue;
      if (joined && on(w.along[k - 1]) && on(w.along[k])) d = std::min(d, distance(p, w.points[k - 1], w.points[k]));
      if (!joined && on(0)) d = std::min(d, distance(p, w.points[k], w.points[k]));
    }
    if (std::abs(d - h) < 1.5 * tolerance + h * 1e-6) continue;
    const bool inside = oracle.inside(p.x, p.y);
    ++v.tested;
    v.inside += inside;
    if (inside == (d < h)) continue;
    if (v.wrong++ == 0) v.first = p;
  }
  return v;
}

Shape randomShape(uint32_t seed, int curves, double size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> c(0, size);
  Shape s;
  const auto point = [&] { return Point{c(random), c(random)}; };
  s.move(point());
  for (int i = 0; i < curves; ++i) switch (random() % 5) {
    case 0: s.line(point()); break;
    case 1: {
      const Point a = point(), b = point();
      s.quad(a, b);
      break;
    }
    default: {
      const Point a = point(), b = point(), d = point();
      s.cubic(a, b, d);
    }
    }
  if (seed % 3 == 0) s.close();
  return s;
}

constexpr auto kAll = [](double) { return true; };

TEST(Stroke, RoundOnesAreTheNeighbourhoodOfThePath) {
  size_t tested = 0, inside = 0;
  for (uint32_t seed = 0; seed < 120; ++seed) {
    const double width = seed % 4 == 0 ? 1 : seed % 4 == 1 ? 4 : seed % 4 == 2 ? 15 : 40;
    const Shape shape = randomShape(seed, 1 + static_cast<int>(seed / 20), 100);
    const Verdict v = judge(shape, {width, Cap::Round, Join::Round, 4, {}, 0}, 0.05, 300, seed, kAll);
    EXPECT_EQ(v.wrong, 0u) << "of " << v.tested << ", seed " << seed << ", width " << width << ", first at "
                           << v.first.x << " " << v.first.y;
    tested += v.tested;
    inside += v.inside;
  }
  EXPECT_GT(tested, 20000u);
  EXPECT_GT(inside, tested / 4);
  EXPECT_GT(tested - inside, tested / 30);
}

TEST(Stroke, DegenerateCurves) {
  const auto of = [](auto&&... p) {
    Shape s;
    const Point all[] = {p...};
    s.move(all[0]);
    s.cubic(all[1], all[2], all[3]);
    return s;
  };
  const std::pair<const char*, Shape> shapes[] = {
      {"cusp", of(Point{20, 20}, Point{80, 80}, Point{20, 80}, Point{80, 20})},
      {"near cusp", of(Point{20, 20}, Point{80, 80.1}, Point{20.05, 80}, Point{80, 20})},
      {"loop", of(Point{20, 20}, Point{100, 90}, Point{0, 90}, Point{80, 20})},
      {"tiny loop", of(Point{20, 20}, Point{81, 80}, Point{19, 80}, Point{80, 20})},
      {"there and back", of(Point{20, 50}, Point{120, 50}, Point{-40, 50}, Point{60, 50})},
      {"controls on ends", of(Point{20, 20}, Point{20, 20}, Point{80, 60}, Point{80, 60})},
      {"first control on end", of(Point{20, 20}, Point{20, 20}, Point{80, 20}, Point{60, 80})},
      {"control all but on the end", of(Point{20, 20}, Point{20, 20.001}, Point{80, 20}, Point{60, 80})},
      {"controls a rounding from ends",
       of(Point{20, 20}, Point{20.000001, 20.000001}, Point{80, 60.00001}, Point{80, 60})},
      {"closed on itself", of(Point{50, 20}, Point{120, 90}, Point{-20, 90}, Point{50, 20})},
      {"no flatSegment", of(Point{50, 20}, Point{50, 90}, Point{50, 90}, Point{50, 20})},
      {"hairpin", of(Point{20, 50}, Point{90, 50}, Point{90, 50.5}, Point{20, 50.5})},
      {"collinear", of(Point{20, 20}, Point{40, 40}, Point{60, 60}, Point{80, 80})},
      {"two bends beside the slowest point", of(Point{20, 20}, Point{185, 20}, Point{15, 22}, Point{180, 20})},
      {"two bends, straight between", of(Point{20, 45}, Point{180, 45}, Point{20, 46}, Point{180, 45})},
  };
  for (const auto& [name, shape] : shapes)
    for (const double width : {1.0, 7.0, 40.0}) {
      const Verdict v = judge(shape, {width, Cap::Round, Join::Round, 4, {}, 0}, 0.02, 1500, 21, kAll);
      EXPECT_EQ(v.wrong, 0u) << name << " of " << v.tested << ", width " << width << ", first at " << v.first.x << " "
                             << v.first.y;
      EXPECT_GT(v.tested, 700u);
    }
}

// Handles that overlap on all but one line: the curvature peaks once or twice beside where the curve is slowest.
TEST(Stroke, NearCuspsAreTheNeighbourhoodOfThePath) {
  size_t tested = 0;
  for (uint32_t seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const double angle = 2 * std::numbers::pi * unit(random);
    const Point along{std::cos(angle), std::sin(angle)}, across{-along.y, along.x};
    const auto aside = [&] {
      return (random() % 2 ? 1 : -1) * (random() % 4 ? std::pow(10, 4 * unit(random) - 3) : 0);
    };
    const double ahead = 110 * unit(random) + 30, back = ahead * unit(random) - 20 * unit(random);
    Shape shape;
    shape.move({0, 0});
    shape.cubic(ahead * along + aside() * across, back * along + aside() * across, 100 * along + aside() * across);
    const double width = std::pow(10, 1.8 * unit(random));
    const Verdict v = judge(shape, {width, Cap::Round, Join::Round, 4, {}, 0}, 0.03, 400, seed, kAll);
    EXPECT_EQ(v.wrong, 0u) << "of " << v.tested << ", seed " << seed << ", width " << width << ", first at "
                           << v.first.x << " " << v.first.y;
    tested += v.tested;
  }
  EXPECT_GT(tested, 60000u);
}

// Handles of length zero are what drawing programs leave at points that were never dragged. The curvature is infinite
// there.
TEST(Stroke, ControlsOnEndsTakeNoMoreCurvesThanOthers) {
  size_t tested = 0, points[2] = {0, 0};
  for (uint32_t seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> c(0, 100);
    Point p[4];
    for (Point& at : p) at = {c(random), c(random)};
    if (seed % 3 != 1) p[2] = p[3];
    if (seed % 3 != 0) p[1] = p[0];
    const double width = std::pow(10, 1.6 * c(random) / 100);
    for (const bool reversed : {false, true}) {
      if (reversed) std::reverse(p, p + 4);
      Shape shape, stroked;
      shape.move(p[0]);
      shape.cubic(p[1], p[2], p[3]);
      ASSERT_TRUE(vector::strokeShape(shape, {width, Cap::Butt, Join::Round, 4, {}, 0}, 0.03, {}, stroked));
      points[reversed] += stroked.points.size();
      const Verdict v = judge(shape, {width, Cap::Round, Join::Round, 4, {}, 0}, 0.03, 200, seed, kAll);
      EXPECT_EQ(v.wrong, 0u) << "of " << v.tested << ", seed " << seed << ", width " << width << ", first at "
                             << v.first.x << " " << v.first.y;
      tested += v.tested;
    }
  }
  for (const size_t all : points) EXPECT_LT(all, size_t{300 * 26}); // rounding taken for turns: over 50 each
  EXPECT_GT(tested, 40000u);
}

// Bounds are what users fit drawings by.
TEST(Stroke, ControlsARoundingFromEndsReachNoFartherThanTheStroke) {
  for (int k = 4; k <= 9; ++k)
    for (const double side : {1.0, -1.0}) {
      const double off = std::pow(10, -k);
      Shape shape;
      shape.move({20, 20});
      shape.cubic({20 + off, 20 - off * side}, {80 - off, 60 - off * side}, {80, 60});
      Shape stroked;
      ASSERT_TRUE(vector::strokeShape(shape, {3, Cap::Butt, Join::Miter, 4, {}, 0}, 0.01, {}, stroked));
      for (const Point& p : stroked.points) {
        EXPECT_TRUE(p.x > 15 && p.x < 85) << k << ": " << p.x;
        EXPECT_TRUE(p.y > 15 && p.y < 65) << k << ": " << p.y;
      }
    }
}

TEST(Stroke, DashesFollowTheArcLength) {
  for (uint32_t seed = 0; seed < 60; ++seed) {
    const double pattern[] = {9, 7, 2, 6}, offset = seed * 1.7 - 30;
    const Shape shape = randomShape(seed * 3 + 1, 3, 100); // open
    // Within one part in ten thousand of the length, the walk's and ours.
    const auto on = [&](double along) {
      double at = std::fmod(along + offset, 24.0);
      if (at < 0) at += 24;
      return at <= 9 || (at >= 16 && at <= 18);
    };
    const Verdict v = judge(shape, {6, Cap::Round, Join::Round, 4, pattern, offset}, 0.05, 300, seed, on);
    EXPECT_LE(v.wrong, v.tested / 200) << "seed " << seed << ", first at " << v.first.x << " " << v.first.y;
    EXPECT_GT(v.tested, 200u);
  }
}

TEST(Stroke, TheErrorIsWithinTheTolerance) {
  // Ends of normals of a smooth curve, which are the outline itself: no farther from the chain than stated, whatever
  // the tolerance, and few pieces.
  const vector::Cubic curve{{{10, 10}, {60, -30}, {90, 80}, {140, 40}}};
  size_t before = 0;
  for (const double tolerance : {1.0, 0.1, 0.01, 1e-3, 1e-4}) {
    for (const double s : {-8.0, 8.0}) {
      std::pmr::vector<vector::Cubic> chain;
      const Point t0 = vector::startTangent(curve), t1 = vector::endTangent(curve);
      vector::appendOffset(curve, s, curve.p[0] + s * Point{-t0.y, t0.x}, curve.p[3] + s * Point{-t1.y, t1.x},
                           tolerance, chain);
      Shape shape;
      shape.move(chain[0].p[0]);
      for (const auto& c : chain) shape.cubic(c.p[1], c.p[2], c.p[3]);
      const Walk w = walk(shape, 0.5 * std::sqrt(tolerance));
      double worst = 0;
      for (int i = 0; i <= 1000; ++i) {
        const double t = i / 1000.0, e = 1e-6;
        const Point d = curve.at(std::min(t + e, 1.0)) - curve.at(std::max(t - e, 0.0));
        const double l = std::hypot(d.x, d.y);
        const Point p = curve.at(t) + s / l * Point{-d.y, d.x};
        double nearest = 1e30;
        for (size_t k = 1; k < w.points.size(); ++k)
          nearest = std::min(nearest, distance(p, w.points[k - 1], w.points[k]));
        worst = std::max(worst, nearest);
      }
      EXPECT_LT(worst, tolerance) << s;
      EXPECT_LE(chain.size(), 2 * before + 4) << tolerance; // a tenth of the tolerance: less than twice the pieces
      if (s > 0) before = chain.size();
    }
  }
  EXPECT_LE(before, 40u);
}

/// Grey levels of a fill or stroke by cairo.
class Picture {
public:
  Picture(int size) : size_(size), surface_(cairo_image_surface_create(CAIRO_FORMAT_A8, size, size)) {}
  ~Picture() { cairo_surface_destroy(surface_); }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;
  template <class Draw> void draw(const Shape& shape, Draw&& how) {
    cairo_t* cr = cairo_create(surface_);
    cairo_set_antialias(cr, CAIRO_ANTIALIAS_BEST);
    cairo_set_tolerance(cr, 0.005);
    const Point* p = shape.points.data();
    Point at;
    for (const GpgpPathVerb verb : shape.verbs) switch (verb) {
      case GPGP_PATH_MOVE: cairo_move_to(cr, p->x, p->y), at = *p++; break;
      case GPGP_PATH_LINE: cairo_line_to(cr, p->x, p->y), at = *p++; break;
      case GPGP_PATH_QUAD: {
        const vector::Cubic c = vector::Cubic::fromQuadratic(at, p[0], p[1]);
        cairo_curve_to(cr, c.p[1].x, c.p[1].y, c.p[2].x, c.p[2].y, c.p[3].x, c.p[3].y);
        at = p[1], p += 2;
        break;
      }
      case GPGP_PATH_CUBIC:
        cairo_curve_to(cr, p[0].x, p[0].y, p[1].x, p[1].y, p[2].x, p[2].y);
        at = p[2], p += 3;
        break;
      default: cairo_close_path(cr); break;
      }
    how(cr);
    cairo_destroy(cr);
    cairo_surface_flush(surface_);
  }
  int at(int x, int y) const {
    return cairo_image_surface_get_data(surface_)[y * cairo_image_surface_get_stride(surface_) + x];
  }
  int size() const { return size_; }

private:
  int size_;
  cairo_surface_t* surface_;
};

/// The same rasteriser for both, so that only the geometry differs.
void expectAsCairo(const Shape& shape, const StrokeStyle& style, const std::string& what, bool curved) {
  const double share = 2e-3;
  Shape stroked;
  ASSERT_TRUE(vector::strokeShape(shape, style, 0.01, {}, stroked));
  Picture ours(160), theirs(160);
  ours.draw(stroked, [](cairo_t* cr) { cairo_fill(cr); });
  theirs.draw(shape, [&](cairo_t* cr) {
    cairo_set_line_width(cr, style.width);
    cairo_set_line_cap(cr, style.cap == Cap::Butt    ? CAIRO_LINE_CAP_BUTT
                           : style.cap == Cap::Round ? CAIRO_LINE_CAP_ROUND
                                                     : CAIRO_LINE_CAP_SQUARE);
    cairo_set_line_join(cr, style.join == Join::Miter   ? CAIRO_LINE_JOIN_MITER
                            : style.join == Join::Round ? CAIRO_LINE_JOIN_ROUND
                                                        : CAIRO_LINE_JOIN_BEVEL);
    cairo_set_miter_limit(cr, style.miterLimit);
    cairo_set_dash(cr, style.dashes.data(), static_cast<int>(style.dashes.size()), style.dashOffset);
    cairo_stroke(cr);
  });
  // Where curves turn within half a width, cairo's windings cancel here and there and leave holes. What only we paint
  // must therefore be near the path instead.
  const Walk w = walk(shape, 0.5);
  double sum = 0, ink = 0;
  int worst = 0, x = 0, y = 0, far = 0;
  for (int j = 0; j < ours.size(); ++j)
    for (int i = 0; i < ours.size(); ++i) {
      const int d = std::abs(ours.at(i, j) - theirs.at(i, j));
      ink += theirs.at(i, j);
      if (curved && ours.at(i, j) > theirs.at(i, j)) {
        if (d <= 24) continue;
        double nearest = 1e30;
        for (const Point& p : w.points) nearest = std::min(nearest, std::hypot(p.x - i - 0.5, p.y - j - 0.5));
        EXPECT_LT(nearest, style.width / 2 + 1) << what << " at " << i << " " << j;
        continue;
      }
      sum += d;
      far += d > 24;
      if (d > worst) worst = d, x = i, y = j;
    }
  EXPECT_GT(ink, 255 * 20) << what;
  EXPECT_LE(far, static_cast<int>(share * 160 * 160)) << what << ", worst " << worst << " at " << x << " " << y;
  EXPECT_LE(sum / (255 * 160 * 160), share) << what;
}

TEST(Stroke, JoinsCapsAndDashesAreCairos) {
  const double pattern[] = {11, 5, 3, 7};
  for (uint32_t seed = 0; seed < 120; ++seed) {
    const double width = seed % 3 == 0 ? 1 : seed % 3 == 1 ? 4 : 40;
    Shape shape;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> c(30, 130);
    const auto point = [&] { return Point{c(random), c(random)}; };
    shape.move(point());
    for (uint32_t i = 0; i < 2 + seed % 4; ++i) shape.line(point());
    if (seed % 2) shape.close();
    StrokeStyle style{width, static_cast<Cap>(seed / 3 % 3), static_cast<Join>(seed / 9 % 3), 1.0 + seed % 7, {}, 0};
    if (seed % 5 == 0) style.dashes = pattern, style.dashOffset = seed * 0.9;
    expectAsCairo(shape, style, "seed " + std::to_string(seed) + " width " + std::to_string(width), false);
  }
}

TEST(Stroke, CurvesAreCairos) {
  for (uint32_t seed = 0; seed < 90; ++seed) {
    const double width = seed % 3 == 0 ? 1 : seed % 3 == 1 ? 4 : 40;
    Shape shape;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> c(30, 130);
    const auto point = [&] { return Point{c(random), c(random)}; };
    shape.move(point());
    for (uint32_t i = 0; i < 1 + seed % 4; ++i) {
      const Point a = point(), b = point(), d = point();
      shape.cubic(a, b, d);
    }
    if (seed % 2) shape.close();
    const StrokeStyle style{width, static_cast<Cap>(seed / 3 % 3), static_cast<Join>(seed / 9 % 3), 4, {}, 0};
    expectAsCairo(shape, style, "seed " + std::to_string(seed) + " width " + std::to_string(width), true);
  }
}

TEST(Stroke, ContoursWithoutLengthShowTheirCaps) {
  const auto area = [](const Shape& shape, const StrokeStyle& style) {
    Shape stroked;
    EXPECT_TRUE(vector::strokeShape(shape, style, 0.001, {}, stroked));
    const Flattened flat(stroked);
    const PathOracle oracle(flat.view());
    int inside = 0;
    for (int y = 0; y < 400; ++y)
      for (int x = 0; x < 400; ++x) inside += oracle.inside((x + 0.4989) / 20, (y + 0.5013) / 20);
    return inside / 400.0;
  };
  Shape dot, alone;
  dot.move({10, 10});
  dot.line({10, 10});
  alone.move({10, 10});
  EXPECT_EQ(area(dot, {8, Cap::Butt, Join::Miter, 4, {}, 0}), 0);
  EXPECT_NEAR(area(dot, {8, Cap::Round, Join::Miter, 4, {}, 0}), 16 * std::numbers::pi, 0.3);
  EXPECT_NEAR(area(dot, {8, Cap::Square, Join::Miter, 4, {}, 0}), 64, 0.3);
  EXPECT_EQ(area(alone, {8, Cap::Square, Join::Miter, 4, {}, 0}), 0);
  const double pattern[] = {3, 2}; // at 0 and 7 a dash, at 4 a gap
  for (const double offset : {0.0, 7.0, 4.0})
    EXPECT_NEAR(area(dot, {8, Cap::Square, Join::Miter, 4, pattern, offset}), offset == 4 ? 0 : 64, 0.3) << offset;
  EXPECT_EQ(area(dot, {8, Cap::Butt, Join::Miter, 4, pattern, 0}), 0);
  EXPECT_EQ(area(alone, {8, Cap::Square, Join::Miter, 4, pattern, 0}), 0);
}

TEST(Stroke, LimitsAreKept) {
  const Shape shape = randomShape(7, 40, 100);
  Shape out;
  out.move({1, 2});
  EXPECT_FALSE(vector::strokeShape(shape, {4, Cap::Butt, Join::Round, 4, {}, 0}, 1e-3, {50, 10}, out));
  const double fine[] = {1e-6, 1e-6};
  EXPECT_FALSE(vector::strokeShape(shape, {4, Cap::Butt, Join::Round, 4, fine, 0}, 1e-3, {}, out));
  EXPECT_EQ(out.verbs.size(), 1u);
}

} // namespace
