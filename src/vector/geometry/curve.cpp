#include "vector/geometry/curve.h"
#include "vector/geometry/order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace gpgp::vector {
namespace {
/// Equal ones stay as they are: a control on its end, rounded away from it, would give the end a tangent of noise.
double mix(double a, double b, double t) { return a == b ? a : (1 - t) * a + t * b; }
Point mix(Point a, Point b, double t) { return {mix(a.x, b.x, t), mix(a.y, b.y, t)}; }

double round32(double v) {
  // g++ 12 at -O3 drops the rounding when it vectorises the pair of conversions; volatile keeps it.
  const volatile float rounded = static_cast<float>(v);
  return static_cast<double>(rounded);
}
Point round32(Point p) { return {round32(p.x), round32(p.y)}; }

/// By start, end and controls; below zero, zero, above.
int compare(const Cubic& a, const Cubic& b) {
  for (const int i : {0, 3, 1, 2}) {
    if (a.p[i].y != b.p[i].y) return a.p[i].y < b.p[i].y ? -1 : 1;
    if (a.p[i].x != b.p[i].x) return a.p[i].x < b.p[i].x ? -1 : 1;
  }
  return 0;
}

/// Whether a curve should be walked from its other end, so that it and its reverse are cut alike.
bool runsBackwards(const Cubic& c) {
  const std::array<double, 4> forward{c.p[0].y, c.p[0].x, c.p[1].y, c.p[1].x};
  const std::array<double, 4> backward{c.p[3].y, c.p[3].x, c.p[2].y, c.p[2].x};
  return backward < forward;
}
} // namespace

Cubic Cubic::fromLine(Point a, Point b) { return {{a, mix(a, b, 1.0 / 3), mix(a, b, 2.0 / 3), b}, true}; }

Cubic Cubic::fromQuadratic(Point a, Point control, Point b) {
  return {{a, mix(a, control, 2.0 / 3), mix(b, control, 2.0 / 3), b}, false};
}

Point Cubic::at(double t) const {
  const Point a = mix(p[0], p[1], t), b = mix(p[1], p[2], t), c = mix(p[2], p[3], t);
  return mix(mix(a, b, t), mix(b, c, t), t);
}

Cubic Cubic::part(double t0, double t1) const {
  // Blossoming: control i is the blossom at t0 (3 - i times) and t1 (i times).
  const auto blossom = [this](double u, double v, double w) {
    const Point a = mix(p[0], p[1], u), b = mix(p[1], p[2], u), c = mix(p[2], p[3], u);
    return mix(mix(a, b, v), mix(b, c, v), w);
  };
  return {{blossom(t0, t0, t0), blossom(t0, t0, t1), blossom(t0, t1, t1), blossom(t1, t1, t1)}, line, arc};
}

double Cubic::bend() const {
  const Point d = p[3] - 3 * p[2] + 3 * p[1] - p[0];
  return std::sqrt(d.x * d.x + d.y * d.y) * 0.0481125224; // sqrt(3) / 36, the maximum of |t (t - 1/2) (t - 1)|
}

int rootsInside(double a, double b, double c, double roots[2]) {
  int count = 0;
  const auto add = [&](double t) {
    if (t > 0 && t < 1) roots[count++] = t;
  };
  const double discriminant = b * b - 4 * a * c;
  if (a == 0) {
    if (b != 0) add(-c / b);
  } else if (discriminant >= 0) {
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    add(q / a);
    if (q != 0) add(c / q);
  }
  if (count == 2 && roots[1] < roots[0]) std::swap(roots[0], roots[1]);
  if (count == 2 && roots[0] == roots[1]) count = 1;
  return count;
}

namespace {
/// Two numbers that are worked on together (a vector of GCC and Clang). Each gets the bits that it would get alone.
using Two = double __attribute__((vector_size(2 * sizeof(double))));

double root(double v) { return std::sqrt(v); }
Two root(Two v) { return Two{std::sqrt(v[0]), std::sqrt(v[1])}; }

/// Halley's steps that stay between where the cubic is above and below the height, halving where they leave.
double searchedParameter(double c0, double c1, double c2, double c3) {
  double low = 0, high = 1, t = 0.5;
  for (int i = 0; i < 60; ++i) {
    const double f = ((c3 * t + c2) * t + c1) * t + c0;
    if (f == 0) break;
    (f < 0 ? low : high) = t;
    const double slope = (3 * c3 * t + 2 * c2) * t + c1;
    double next = t - f * slope / (slope * slope - f * (3 * c3 * t + c2));
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double step = std::abs(next - t);
    t = next;
    if (step < 1e-4 * t * (1 - t)) break;
  }
  return t;
}
/// `t` where that is good, else the search.
double whereGood(bool good, double t, double c0, double c1, double c2, double c3) {
  return good ? t : searchedParameter(c0, c1, c2, c3);
}
Two whereGood(decltype(Two{} < Two{}) good, Two t, Two c0, Two c1, Two c2, Two c3) {
  if ((good[0] & good[1]) != 0) return t;
  return Two{whereGood(good[0] != 0, t[0], c0[0], c1[0], c2[0], c3[0]),
             whereGood(good[1] != 0, t[1], c0[1], c1[1], c2[1], c3[1])};
}

/// One coordinate of a cubic's points, or of two cubics'. Number: double or Two.
template <class Number> struct Controls { Number p0, p1, p2, p3; };
Controls<double> axisOf(const Point* p, double Point::*axis) {
  return {p[0].*axis, p[1].*axis, p[2].*axis, p[3].*axis};
}
Controls<Two> axisOf(const Point* p, const Point* q, double Point::*axis) {
  const auto both = [=](int i) { return Two{p[i].*axis, q[i].*axis}; };
  return {both(0), both(1), both(2), both(3)};
}

/// Where a monotone cubic, not a line, reaches a height strictly between its ends.
template <class Number> Number parameterAt(const Controls<Number>& of, Number y) {
  const auto [p0, p1, p2, p3] = of;
  const Number zero{}, c0 = p0 - y, c1 = 3 * (p1 - p0), c2 = 3 * (p2 - 2 * p1 + p0), c3 = p3 - 3 * p2 + 3 * p1 - p0;
  // From where a quotient of two parabolas reaches it that has the same ends and the same slopes there.
  const Number all = p3 - p0, square = c1 * all + c0 * (c1 + 3 * (p3 - p2) - 2 * all), twice = -2 * c0 * all;
  const Number under = square * square + 2 * twice * (all * all - square);
  Number t = twice / (square + root(under < 0 ? zero : under)), step = zero;
  for (int i = 0; i < 3; ++i) { // Halley's steps
    const Number f = ((c3 * t + c2) * t + c1) * t + c0, slope = (3 * c3 * t + 2 * c2) * t + c1;
    step = f * slope / (slope * slope - f * (3 * c3 * t + c2));
    t = t - step;
  }
  // What is left is about the cube of the last step, measured by how far the end is (where it may be level).
  const Number small = 1e-4 * t * (1 - t);
  return whereGood((step < small) & (step > -small), t, c0, c1, c2, c3);
}

bool all(bool good) { return good; }
bool all(decltype(Two{} < Two{}) good) { return (good[0] & good[1]) != 0; }

/// The same from the parameter at a height nearby.
template <class Number> Number parameterNear(const Controls<Number>& of, Number y, Number t) {
  const auto [p0, p1, p2, p3] = of;
  const Number c0 = p0 - y, c1 = 3 * (p1 - p0), c2 = 3 * (p2 - 2 * p1 + p0), c3 = p3 - 3 * p2 + 3 * p1 - p0;
  for (int i = 0; i < 3; ++i) {
    const Number f = ((c3 * t + c2) * t + c1) * t + c0, slope = (3 * c3 * t + 2 * c2) * t + c1;
    const Number step = f * slope / (slope * slope - f * (3 * c3 * t + c2));
    t = t - step;
    const Number small = 1e-4 * t * (1 - t);
    if (all((step < small) & (step > -small))) return t;
  }
  return parameterAt(of, y);
}

/// A coordinate of a cubic at a parameter.
template <class Number> Number coordinateAt(const Controls<Number>& of, Number t) {
  const auto [p0, p1, p2, p3] = of;
  const Number s = 1 - t;
  return s * s * (s * p0 + 3 * t * p1) + t * t * (3 * s * p2 + t * p3);
}
/// A third of its derivative.
template <class Number> Number tangentAt(const Controls<Number>& of, Number t) {
  const auto [p0, p1, p2, p3] = of;
  const Number s = 1 - t;
  return s * s * (p1 - p0) + 2 * s * t * (p2 - p1) + t * t * (p3 - p2);
}

/// Whether it takes a search to find where a piece reaches a height.
bool searched(const Monotone& piece, double y) { return !piece.curve.line && y > piece.top() && y < piece.bottom(); }

double clampX(const Point* p, double x) { return std::clamp(x, std::min(p[0].x, p[3].x), std::max(p[0].x, p[3].x)); }

/// From the tangent, down and not turning. Rounded ends may turn a level tangent by a little; which way the piece leans
/// is certain.
double slopeOf(const Point* p, double alongX, double alongY) {
  const bool right = p[3].x >= p[0].x;
  const double along = right ? std::max(alongX, 0.0) : std::min(alongX, 0.0);
  const double infinite = std::numeric_limits<double>::infinity();
  return alongY > 0 ? along / alongY : right ? infinite : -infinite;
}
} // namespace

double Monotone::xAt(double y) const {
  const Point* p = curve.p;
  if (!(y > p[0].y)) return p[0].x;
  if (!(y < p[3].y)) return p[3].x;
  if (curve.line) return mix(p[0].x, p[3].x, (y - p[0].y) / (p[3].y - p[0].y));
  return clampX(p, coordinateAt(axisOf(p, &Point::x), parameterAt(axisOf(p, &Point::y), y)));
}

double Monotone::xNear(double y, double& t) const {
  if (!searched(*this, y)) return xAt(y);
  t = parameterNear(axisOf(curve.p, &Point::y), y, t);
  return clampX(curve.p, coordinateAt(axisOf(curve.p, &Point::x), t));
}

Monotone::Place Monotone::placeAt(double y) const {
  const Point* p = curve.p;
  if (curve.line)
    return {xAt(y), (p[3].x - p[0].x) / (p[3].y - p[0].y), std::clamp((y - p[0].y) / (p[3].y - p[0].y), 0.0, 1.0)};
  if (y > p[0].y && y < p[3].y) {
    const double t = parameterAt(axisOf(p, &Point::y), y);
    return {clampX(p, coordinateAt(axisOf(p, &Point::x), t)),
            slopeOf(p, tangentAt(axisOf(p, &Point::x), t), tangentAt(axisOf(p, &Point::y), t)), t};
  }
  const bool end = y > p[0].y;
  Point d = end ? p[3] - p[2] : p[1] - p[0];
  if (d == Point{}) // a control on its end: the tangent is towards the next
    d = p[end ? 1 : 2] == p[end ? 3 : 0] ? p[3] - p[0] : end ? p[3] - p[1] : p[2] - p[0];
  return {p[end ? 3 : 0].x, slopeOf(p, d.x, d.y), end ? 1.0 : 0.0};
}

std::array<double, 2> xsAt(const Monotone& a, double ya, const Monotone& b, double yb) {
  if (!searched(a, ya) || !searched(b, yb)) return {a.xAt(ya), b.xAt(yb)};
  const Point *p = a.curve.p, *q = b.curve.p;
  const Two t = parameterAt(axisOf(p, q, &Point::y), Two{ya, yb});
  const Two x = coordinateAt(axisOf(p, q, &Point::x), t);
  return {clampX(p, x[0]), clampX(q, x[1])};
}

std::array<Monotone::Place, 2> placesAt(const Monotone& a, double ya, const Monotone& b, double yb) {
  if (!searched(a, ya) || !searched(b, yb)) return {a.placeAt(ya), b.placeAt(yb)};
  const Point *p = a.curve.p, *q = b.curve.p;
  const Two t = parameterAt(axisOf(p, q, &Point::y), Two{ya, yb});
  const Two x = coordinateAt(axisOf(p, q, &Point::x), t);
  const Two dx = tangentAt(axisOf(p, q, &Point::x), t), dy = tangentAt(axisOf(p, q, &Point::y), t);
  return {Monotone::Place{clampX(p, x[0]), slopeOf(p, dx[0], dy[0]), t[0]},
          {clampX(q, x[1]), slopeOf(q, dx[1], dy[1]), t[1]}};
}

std::array<double, 2> xsNear(const Monotone& a, const Monotone& b, double y, std::array<double, 2>& near) {
  if (!searched(a, y) || !searched(b, y)) return {a.xNear(y, near[0]), b.xNear(y, near[1])};
  const Point *p = a.curve.p, *q = b.curve.p;
  const Two t = parameterNear(axisOf(p, q, &Point::y), Two{y, y}, Two{near[0], near[1]});
  near = {t[0], t[1]};
  const Two x = coordinateAt(axisOf(p, q, &Point::x), t);
  return {clampX(p, x[0]), clampX(q, x[1])};
}

std::optional<double> crossingNear(const Monotone& a, const Monotone& b, std::array<double, 2> near, double fine) {
  const Point *p = a.curve.p, *q = b.curve.p;
  const auto powers = [=](double Point::*axis) { // of the parameter
    const auto [p0, p1, p2, p3] = axisOf(p, q, axis);
    return std::array{p0, 3 * (p1 - p0), 3 * (p2 - 2 * p1 + p0), p3 - 3 * p2 + 3 * p1 - p0};
  };
  const auto xs = powers(&Point::x), ys = powers(&Point::y);
  Two t{near[0], near[1]};
  for (int i = 0; i < 8; ++i) {
    const auto value = [t](const std::array<Two, 4>& c) { return ((c[3] * t + c[2]) * t + c[1]) * t + c[0]; };
    const auto slope = [t](const std::array<Two, 4>& c) { return (3 * c[3] * t + 2 * c[2]) * t + c[1]; };
    const Two x = value(xs), y = value(ys), dx = slope(xs), dy = slope(ys);
    const double gapX = x[1] - x[0], gapY = y[1] - y[0], factor = 1 / (dx[1] * dy[0] - dx[0] * dy[1]);
    const Two step = factor * Two{dx[1] * gapY - dy[1] * gapX, dx[0] * gapY - dy[0] * gapX}, down = step * dy;
    t = t + step;
    if (!(std::min(t[0], t[1]) >= 0 && std::max(t[0], t[1]) <= 1)) return std::nullopt;
    // Steps grow small as the square of those before. Both curves have the height then.
    if (std::abs(down[0]) < fine && std::abs(down[1]) < fine) return y[0] + down[0];
  }
  return std::nullopt;
}

int Monotone::inflections(double heights[2]) const {
  if (curve.line) return 0;
  const Point* p = curve.p;
  const Point c = p[1] - p[0], b = p[2] - 2 * p[1] + p[0], a = p[3] - 3 * p[2] + 3 * p[1] - p[0];
  const auto cross = [](Point u, Point v) { return u.x * v.y - u.y * v.x; };
  const int count = rootsInside(cross(b, a), cross(c, a), cross(c, b), heights);
  for (int i = 0; i < count; ++i) heights[i] = curve.at(heights[i]).y;
  return count;
}

namespace {
/// How far a piece's control points lie to the left of another's flatSegment.
struct Spread {
  double low, high;
};
Two leftOfFlatSegment(const Point* flatSegment, const Point* of, int i, int k) {
  const Point d = flatSegment[3] - flatSegment[0];
  return d.x * (Two{of[i].y, of[k].y} - flatSegment[0].y) - d.y * (Two{of[i].x, of[k].x} - flatSegment[0].x);
}
Spread leftOfFlatSegment(const Monotone& flatSegment, const Monotone& of) {
  const Two ends = leftOfFlatSegment(flatSegment.curve.p, of.curve.p, 0, 3),
            inner = leftOfFlatSegment(flatSegment.curve.p, of.curve.p, 1, 2);
  const Two low = ends < inner ? ends : inner, high = ends < inner ? inner : ends;
  return {std::min(low[0], low[1]), std::max(high[0], high[1])};
}
Spread leftOfOwnFlatSegment(const Monotone& piece) {
  if (piece.curve.line) return {0, 0};
  const Two inner = leftOfFlatSegment(piece.curve.p, piece.curve.p, 1, 2);
  return {std::min({0.0, inner[0], inner[1]}), std::max({0.0, inner[0], inner[1]})};
}
} // namespace

int sideByHull(const Monotone& a, const Monotone& b) {
  const Point *p = a.curve.p, *q = b.curve.p;
  if (std::max(p[0].x, p[3].x) < std::min(q[0].x, q[3].x)) return -1;
  if (std::max(q[0].x, q[3].x) < std::min(p[0].x, p[3].x)) return 1;
  const Spread ofA = leftOfFlatSegment(b, a), ofB = leftOfOwnFlatSegment(b);
  if (ofA.low >= ofB.high && ofA.high > ofB.low) return -1;
  if (ofA.high <= ofB.low && ofA.low < ofB.high) return 1;
  const Spread mineB = leftOfFlatSegment(a, b), mineA = leftOfOwnFlatSegment(a);
  if (mineB.low >= mineA.high && mineB.high > mineA.low) return 1;
  if (mineB.high <= mineA.low && mineB.low < mineA.high) return -1;
  return 0;
}

void cutMonotone(const Cubic& source, std::pmr::vector<Monotone>& pieces) {
  Cubic curve = source;
  int winding = 1;
  if (runsBackwards(curve)) {
    std::swap(curve.p[0], curve.p[3]);
    std::swap(curve.p[1], curve.p[2]);
    winding = -1;
  }
  const Point* p = curve.p;
  std::array<double, 6> cuts{};
  int count = 0;
  cuts[count++] = 0;
  if (!curve.line) {
    const auto turn = [&](double a, double b, double c, double d) {
      double roots[2];
      const int n = rootsInside(d - 3 * c + 3 * b - a, 2 * (c - 2 * b + a), b - a, roots);
      for (int i = 0; i < n; ++i) { // insertion: at most four
        int at = count++;
        for (; cuts[at - 1] > roots[i]; --at) cuts[at] = cuts[at - 1];
        cuts[at] = roots[i];
      }
    };
    turn(p[0].x, p[1].x, p[2].x, p[3].x);
    turn(p[0].y, p[1].y, p[2].y, p[3].y);
  }
  Point start = round32(p[0]);
  for (int i = 0; i < count; ++i) {
    const bool last = i + 1 == count;
    const double t1 = last ? 1 : cuts[i + 1];
    const Point end = round32(last ? p[3] : curve.at(t1));
    if (start.y != end.y) {
      Monotone piece{count == 1 ? curve : curve.part(cuts[i], t1), winding};
      piece.curve.p[0] = start;
      piece.curve.p[3] = end;
      if (curve.line) piece.curve = Cubic::fromLine(start, end);
      if (start.y > end.y) {
        std::swap(piece.curve.p[0], piece.curve.p[3]);
        std::swap(piece.curve.p[1], piece.curve.p[2]);
        piece.winding = -winding;
      }
      pieces.push_back(piece);
    }
    start = end;
  }
}

void mergeCoincident(std::pmr::vector<Monotone>& pieces) {
  const auto order = orderBy(
      static_cast<uint32_t>(pieces.size()), pieces.get_allocator().resource(),
      [&pieces](uint32_t i) { return static_cast<float>(pieces[i].top()); },
      [&pieces](uint32_t a, uint32_t b) {
        const int side = compare(pieces[a].curve, pieces[b].curve);
        return side != 0 ? side < 0 : a < b;
      });
  std::pmr::vector<Monotone> kept(pieces.get_allocator());
  kept.reserve(pieces.size());
  for (size_t i = 0; i < order.size();) {
    Monotone sum = pieces[order[i++]];
    while (i < order.size() && compare(pieces[order[i]].curve, sum.curve) == 0)
      sum.winding += pieces[order[i++]].winding;
    if (sum.winding != 0) kept.push_back(sum);
  }
  pieces.swap(kept);
}

} // namespace gpgp::vector
