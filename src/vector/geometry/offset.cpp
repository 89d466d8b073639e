#include "vector/geometry/offset.h"
#include "vector/geometry/vectors.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector {
namespace {

Point unit(Point p) {
  const double l = length(p);
  return l > 0 ? Point{p.x / l, p.y / l} : Point{};
}

/// Points nearer to each other coincide but for rounding.
double coincidentIn(const Cubic& curve) {
  double size = 0;
  for (int i = 1; i < 4; ++i) size = std::max(size, length(curve.p[i] - curve.p[0]));
  return 1e-6 * size;
}

/// A cubic by its coefficients.
struct Polynomial {
  Point a, b, c, d; // ((a t + b) t + c) t + d
  explicit Polynomial(const Cubic& curve) {
    const Point* p = curve.p;
    d = p[0];
    c = 3 * (p[1] - p[0]);
    b = 3 * (p[2] - 2 * p[1] + p[0]);
    a = p[3] - 3 * p[2] + 3 * p[1] - p[0];
  }
  Point at(double t) const { return t * (t * (t * a + b) + c) + d; }
  Point first(double t) const { return t * (3 * t * a + 2 * b) + c; }
  Point second(double t) const { return 6 * t * a + 2 * b; }
};

/// Over a range [from, to] of a cubic, in Bernstein form: its derivative, and what of it the curvature is made of. The
/// coefficients bound the values.
struct Hodograph {
  Point c1[3];
  double turn[5]; // c' x c'', a quadratic polynomial, with as many coefficients as the other
  double speed2[5];
  /// From the controls, so that the derivative is zero where a control lies on its end.
  Hodograph(const Cubic& curve, double from, double to) {
    const Point* p = curve.p;
    const Point d0 = 3 * (p[1] - p[0]), d1 = 3 * (p[2] - p[1]), d2 = 3 * (p[3] - p[2]);
    const auto blossom = [&](double s, double t) {
      return (1 - s) * (1 - t) * d0 + ((1 - s) * t + s * (1 - t)) * d1 + s * t * d2;
    };
    c1[0] = blossom(from, from);
    c1[1] = blossom(from, to);
    c1[2] = blossom(to, to);
    const double range = to - from;
    turn[0] = 2 * cross(c1[0], c1[1]) / range;
    turn[4] = 2 * cross(c1[1], c1[2]) / range;
    const double middle = cross(c1[0], c1[2]) / range;
    turn[1] = (turn[0] + middle) / 2;
    turn[2] = (turn[0] + 4 * middle + turn[4]) / 6;
    turn[3] = (middle + turn[4]) / 2;
    speed2[0] = dot(c1[0], c1[0]);
    speed2[1] = dot(c1[0], c1[1]);
    speed2[2] = (dot(c1[0], c1[2]) + 2 * dot(c1[1], c1[1])) / 3;
    speed2[3] = dot(c1[1], c1[2]);
    speed2[4] = dot(c1[2], c1[2]);
  }
  double slowest() const { return std::sqrt(std::max(*std::min_element(speed2, speed2 + 5), 0.0)); }
  double fastest() const { return std::sqrt(*std::max_element(speed2, speed2 + 5)); }
};

/// Parameters inside (0, 1) where the speed is least, at most two: sign changes of c' . c'' from below, found among
/// eight steps, which a cubic polynomial in t that matters here does not outrun.
int slowest(const Polynomial& c, double parameters[2]) {
  const double k3 = 18 * dot(c.a, c.a), k2 = 18 * dot(c.a, c.b), k1 = 4 * dot(c.b, c.b) + 6 * dot(c.a, c.c),
               k0 = 2 * dot(c.b, c.c);
  const auto slope = [=](double t) { return ((k3 * t + k2) * t + k1) * t + k0; };
  int count = 0;
  double before = k0;
  for (int i = 1; i <= 8 && count < 2; ++i) {
    const double after = slope(i / 8.0);
    if (before < 0 && after >= 0) {
      double low = (i - 1) / 8.0, high = i / 8.0, t = low - 0.125 * before / (after - before);
      for (int k = 0; k < 40; ++k) { // Newton's steps, halving where they leave the range
        const double value = slope(t);
        (value < 0 ? low : high) = t;
        double next = t - value / ((3 * k3 * t + 2 * k2) * t + k1);
        if (!(next >= low && next <= high)) next = 0.5 * (low + high);
        const double step = std::abs(next - t);
        t = next;
        if (step < 1e-12) break;
      }
      parameters[count++] = t;
    }
    before = after;
  }
  return count;
}

class Offset {
public:
  Offset(const Cubic& curve, double distance, double tolerance, std::pmr::vector<Cubic>& chain)
      : curve_(curve), c_(curve), s_(distance), tolerance_(tolerance), chain_(chain), before_(chain.size()) {}

  void run() {
    const Frame last = frame(1);
    from_ = fold_ = frame(0);
    const Point* p = curve_.p;
    const double end = 1 - straightStart(Polynomial({{p[3], p[2], p[1], p[0]}, false}));
    begin_ = straightStart(c_);
    if (begin_ < end) findFolds(begin_, end, 0);
    if (folded_) finish(last);
    if (from_.t < 1) part(from_, last, false, 0);
  }

private:
  static constexpr int kMaxDepth = 24;
  static constexpr int kFoldDepth = 14;
  static constexpr size_t kMaxPieces = 512; // however wild the curve
  struct Frame {
    double t;
    Point p, tangent;
    double speed, growth; // of the curve; of the offset against the curve: 1 - distance * curvature
    Point offset;
  };

  Frame frame(double t) const {
    Frame f{t, c_.at(t), c_.first(t), 0, 1, {}};
    f.speed = length(f.tangent);
    const Point bend = c_.second(t);
    if (f.speed > 1e-9 * (length(bend) + length(c_.c))) {
      f.growth = 1 - s_ * cross(f.tangent, bend) / (f.speed * f.speed * f.speed);
      f.tangent = {f.tangent.x / f.speed, f.tangent.y / f.speed};
    } else { // a control on its end
      f.tangent = t < 0.5 ? startTangent(curve_) : endTangent(curve_);
      const double near = t < 0.5 ? t + 1e-3 : t - 1e-3;
      const Point d = c_.first(near);
      const double speed = length(d);
      f.growth = speed > 0 ? 1 - s_ * cross(d, c_.second(near)) / (speed * speed * speed) : 1;
    }
    f.offset = f.p + s_ * left(f.tangent);
    return f;
  }

  /// Up to which parameter a curve whose first control lies on its start turns too little to be seen. As it starts with
  /// an infinite curvature, it turns within the distance there, and no coefficients say how far.
  double straightStart(const Polynomial& c) const {
    if (!(c.c == Point{})) return 0;
    const Point direction = 2 * c.b, change = 3 * c.a; // c' is t (direction + t change)
    const double most = 0.1 * tolerance_ / std::abs(s_);
    const double side = std::abs(cross(direction, change)) - most * dot(direction, change);
    const double ahead = most * dot(direction, direction);
    return ahead < side ? ahead / side : 1;
  }

  /// Finds where the curve turns within the distance, from left to right: halves until the coefficients say that it
  /// does or does not, or until the offset moves by less than the tolerance, whichever way it runs.
  void findFolds(double from, double to, int depth) {
    const Hodograph h(curve_, from, to);
    const double slow = h.slowest(), fast = h.fastest();
    double low = 1e300, high = -1e300; // bound distance * c' x c'' - |c'|^3, a factor of which by its own bounds
    bool turnsAway = true;
    for (int i = 0; i < 5; ++i) {
      const double turn = s_ * h.turn[i];
      low = std::min(low, turn - fast * h.speed2[i]);
      high = std::max(high, turn - slow * h.speed2[i]);
      turnsAway = turnsAway && turn <= 0;
    }
    bool folds = low > 0;
    const bool decided = folds || high < 0 || turnsAway;
    if (!decided) {
      const double most = std::max(-low, high) * (to - from); // movement times least speed^2
      if (depth < kFoldDepth && !(most < 0.1 * tolerance_ * slow * slow)) {
        const double middle = 0.5 * (from + to);
        findFolds(from, middle, depth + 1);
        return findFolds(middle, to, depth + 1);
      }
      folds = frame(to).growth < 0;
    }
    if (folds == folded_) return;
    const Frame at = decided ? frame(from > begin_ ? from : 0) : root(from, to, folded_);
    if (folded_)
      finish(at);
    else
      fold_ = at;
    folded_ = folds;
  }
  /// Of what runs backwards.
  void finish(const Frame& end) {
    if (turning(fold_.t, end.t) * std::abs(s_) < 0.5 * tolerance_) return; // too small to be seen
    if (fold_.t > from_.t) part(from_, fold_, false, 0);
    part(fold_, end, true, 0);
    from_ = end;
  }

  /// Where the growth changes its sign.
  Frame root(double low, double high, bool negative) const {
    for (int k = 0; k < 40; ++k) {
      const double middle = 0.5 * (low + high);
      ((frame(middle).growth < 0) == negative ? low : high) = middle;
    }
    return frame(0.5 * (low + high));
  }

  double turning(double from, double to) const {
    double sum = 0;
    Point before = frame(from).tangent;
    for (int i = 1; i <= 4; ++i) {
      const Point after = frame(from + 0.25 * i * (to - from)).tangent;
      sum += std::abs(std::atan2(cross(before, after), dot(before, after)));
      before = after;
    }
    return sum;
  }

  /// One stretch in which the offset runs forwards or, past the centres of curvature, backwards.
  void part(const Frame& from, const Frame& to, bool backwards, int depth) {
    if (chain_.size() - before_ > kMaxPieces) depth = kMaxDepth;
    const double step = (to.t - from.t) / 4;
    Frame inner[3];
    for (int i = 0; i < 3; ++i) inner[i] = frame(from.t + (i + 1) * step);
    // What runs backwards is hidden by the ribbon before and after it but for the ends of short curves.
    Cubic fitted;
    bool good = !hides(from, to) && fit(from, inner, to, backwards, fitted);
    Point centre;
    if (backwards) good = centreOf(from, to, centre) && good;
    if (!good && depth < kMaxDepth) {
      part(from, inner[1], backwards, depth + 1);
      return part(inner[1], to, backwards, depth + 1);
    }
    if (!good) fitted = Cubic::fromLine(from.offset, to.offset);
    if (backwards) {
      line(from.offset, centre);
      line(centre, to.offset);
      std::swap(fitted.p[0], fitted.p[3]);
      std::swap(fitted.p[1], fitted.p[2]);
      chain_.push_back(fitted);
      line(from.offset, centre);
      line(centre, to.offset);
    } else {
      chain_.push_back(fitted);
    }
  }

  /// Whether the curve may turn to and fro, or far, where it is so slow that samples pass over it.
  bool hides(const Frame& from, const Frame& to) const {
    const Hodograph h(curve_, from.t, to.t);
    if (h.slowest() * 8 > h.fastest()) return false;
    const Point* q = h.c1;
    const double bends[2] = {cross(q[0], q[1]), cross(q[1], q[2])};
    if (bends[0] * bends[1] >= 0 && dot(q[0], q[1]) > 0 && dot(q[1], q[2]) > 0) return false; // one way, and not far
    const auto angle = [](Point a, Point b) {
      return a == Point{} || b == Point{} ? 0.0 : std::atan2(cross(a, b), dot(a, b)); // a control on an end
    };
    // No direction varies more than the polygon's.
    const double first = angle(q[0], q[1]), second = angle(q[1], q[2]), net = angle(from.tangent, to.tangent);
    const double sum = std::abs(first) + std::abs(second), excess = sum - std::abs(net);
    return sum > 3.2 || excess * excess * std::abs(s_) > 8 * tolerance_;
  }

  void line(Point a, Point b) {
    if (!(a == b)) chain_.push_back(Cubic::fromLine(a, b));
  }

  /// Where the normals meet, and whether the centres of curvature between lie near enough.
  bool centreOf(const Frame& from, const Frame& to, Point& centre) const {
    const Point n0 = left(from.tangent), n1 = left(to.tangent);
    const double turning = cross(n0, n1), limit = std::abs(s_);
    double along = 0;
    if (std::abs(turning) > 1e-9) along = cross(to.p - from.p, n1) / turning;
    along = s_ > 0 ? std::clamp(along, 0.0, limit) : std::clamp(along, -limit, 0.0);
    centre = from.p + along * n0;
    // 1 / curvature is distance / (1 - growth)
    const double off = std::max(std::abs(s_ / (1 - from.growth) - along), std::abs(s_ / (1 - to.growth) - along));
    return dot(n0, n1) > 0.5 && off * std::abs(turning) < std::max(16 * tolerance_, 0.5 * limit);
  }

  /// As the curve runs, which suits offsets that are small against it, or else by length, whatever the curve's speed.
  bool fit(const Frame& from, const Frame (&inner)[3], const Frame& to, bool backwards, Cubic& out) const {
    const Frame* row[5] = {&from, &inner[0], &inner[1], &inner[2], &to};
    double along[5] = {};
    for (int i = 1; i < 5; ++i) along[i] = along[i - 1] + length(row[i]->offset - row[i - 1]->offset);
    const double total = along[4], sign = backwards ? -1 : 1, third = (to.t - from.t) / 3;
    if (total < 0.25 * tolerance_) { // a point
      out = Cubic::fromLine(from.offset, to.offset);
      return true;
    }
    const double even[5] = {0, 0.25, 0.5, 0.75, 1};
    const auto speed = [&](const Frame& f) { return sign * f.speed * std::max(sign * f.growth, 0.0); };
    if (fit(row, even, third * speed(from), third * speed(to), total, backwards, out)) return true;
    for (double& l : along) l /= total;
    return fit(row, along, sign * total / 3, sign * total / 3, total, backwards, out);
  }

  /// Handles as near to a0 and b0 as the residuals along the normals let them be.
  bool fit(const Frame* const (&row)[5], const double (&along)[5], double a0, double b0, double total, bool backwards,
           Cubic& out) const {
    const double tolerance = backwards ? 4 * tolerance_ : tolerance_, sign = backwards ? -1 : 1;
    const Frame &from = *row[0], &to = *row[4];
    const Point p0 = from.offset, p3 = to.offset, t0 = from.tangent, t1 = to.tangent;
    double aa = 0, ab = 0, bb = 0, ra = 0, rb = 0;
    for (int i = 0; i < 3; ++i) {
      const double u = along[i + 1], v = 1 - u;
      const Point n = left(row[i + 1]->tangent);
      const double ka = 3 * u * v * v * dot(t0, n), kb = -3 * u * u * v * dot(t1, n);
      const Point base = v * v * (1 + 2 * u) * p0 + u * u * (3 - 2 * u) * p3;
      const double r = dot(row[i + 1]->offset - base, n) - ka * a0 - kb * b0;
      aa += ka * ka;
      ab += ka * kb;
      bb += kb * kb;
      ra += ka * r;
      rb += kb * r;
    }
    constexpr double kKeep = 1e-7;
    aa += kKeep;
    bb += kKeep;
    const double determinant = aa * bb - ab * ab;
    const double a = a0 + (bb * ra - ab * rb) / determinant, b = b0 + (aa * rb - ab * ra) / determinant;
    const bool sane = sign * a >= 0 && sign * b >= 0 && std::abs(a) + std::abs(b) < 2 * total;
    out = {{p0, p0 + (sane ? a : a0) * t0, p3 - (sane ? b : b0) * t1, p3}, false};
    if (!sane) return false;
    // The error is about u^2 (1 - u)^2 times a quadratic polynomial.
    const Polynomial f(out);
    const double range = to.t - from.t;
    for (const double u : {0.5, 0.15, 0.85, 0.33, 0.67}) {
      const Point p = f.at(u);
      int i = 0;
      while (i < 3 && along[i + 1] < u) ++i;
      double t = row[i]->t + (row[i + 1]->t - row[i]->t) * (u - along[i]) / (along[i + 1] - along[i]);
      Point r;
      for (int k = 0; k < 3; ++k) { // to the foot of the perpendicular
        r = p - c_.at(t);
        if (k == 2) break;
        const Point d = c_.first(t);
        const double speed2 = dot(d, d), slope = std::max(speed2 - dot(r, c_.second(t)), 0.1 * speed2);
        const double ahead = dot(r, d);
        // A step makes r shorter by about half of ahead^2 / (slope |r|).
        if (!(ahead * ahead > 0.002 * slope * tolerance * std::abs(s_))) break;
        t = std::clamp(t + ahead / slope, std::max(0.0, from.t - 0.2 * range), std::min(1.0, to.t + 0.2 * range));
      }
      if (!(std::abs(length(r) - std::abs(s_)) < tolerance)) return false;
    }
    return true;
  }

  const Cubic& curve_;
  const Polynomial c_;
  const double s_, tolerance_;
  std::pmr::vector<Cubic>& chain_;
  const size_t before_;
  Frame from_{}, fold_{}; // what lies before these is done; where a fold began
  double begin_ = 0;      // where it is looked at first
  bool folded_ = false;
};

} // namespace

Point startTangent(const Cubic& curve) {
  const Point* p = curve.p;
  const double coincident = coincidentIn(curve);
  for (int i = 1; i < 4; ++i)
    if (const Point d = p[i] - p[0]; length(d) > coincident) return unit(d);
  return {};
}
Point endTangent(const Cubic& curve) {
  const Point* p = curve.p;
  return -1.0 * startTangent({{p[3], p[2], p[1], p[0]}, curve.line});
}

int sharpTurns(const Cubic& curve, double reach, double parameters[4]) {
  const Polynomial c(curve);
  double slow[2];
  int count = 0;
  for (int i = 0, n = slowest(c, slow); i < n; ++i) {
    const double t = slow[i], bend = length(c.second(t));
    if (!(bend > 0)) continue;
    const double half = std::sqrt(reach / bend), from = std::max(t - half, 0.0), to = std::min(t + half, 1.0);
    if (!(length(c.first(t)) * half < reach) || (count && from <= parameters[count - 1])) continue;
    if (from <= 0 || to >= 1 || dot(unit(c.first(from)), unit(c.first(to))) > 0.85) continue;
    parameters[count++] = from;
    parameters[count++] = to;
  }
  return count;
}

void appendOffset(const Cubic& curve, double distance, Point start, Point end, double tolerance,
                  std::pmr::vector<Cubic>& chain) {
  const size_t first = chain.size();
  Cubic exact = curve;
  const double coincident = coincidentIn(curve);
  if (length(exact.p[1] - exact.p[0]) <= coincident) exact.p[1] = exact.p[0];
  if (length(exact.p[2] - exact.p[3]) <= coincident) exact.p[2] = exact.p[3];
  Offset(exact, distance, tolerance, chain).run();
  if (chain.size() == first) {
    if (!(start == end)) chain.push_back(Cubic::fromLine(start, end));
    return;
  }
  const auto move = [&chain](size_t i, int point, Point to) {
    chain[i].p[point] = to;
    if (chain[i].line) chain[i] = Cubic::fromLine(chain[i].p[0], chain[i].p[3]);
  };
  move(first, 0, start);
  move(chain.size() - 1, 3, end);
}

} // namespace gpgp::vector
