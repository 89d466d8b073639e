#include "vector/geometry/offset.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector {
namespace {

double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
Point left(Point d) { return {-d.y, d.x}; }
double length(Point p) { return std::sqrt(dot(p, p)); }
Point unit(Point p) {
  const double l = length(p);
  return l > 0 ? Point{p.x / l, p.y / l} : Point{};
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
    Frame from = frame(0);
    const Frame last = frame(1);
    if (mayFold()) {
      // Between these the curve bends one way and its curvature does not peak.
      double cuts[6] = {0, 1};
      int count = 2;
      double more[2];
      for (int i = slowest(c_, more); i-- > 0;) cuts[count++] = more[i];
      for (int i = rootsInside(3 * cross(c_.b, c_.a), 3 * cross(c_.c, c_.a), cross(c_.c, c_.b), more); i-- > 0;)
        cuts[count++] = more[i];
      std::sort(cuts, cuts + count);
      Frame fold = from, before = from;
      const auto finish = [&](const Frame& end) {
        if (turning(fold.t, end.t) * std::abs(s_) < 0.5 * tolerance_) return; // too small to be seen
        if (fold.t > from.t) part(from, fold, false, 0);
        part(fold, end, true, 0);
        from = end;
      };
      for (int i = 1; i < count; ++i)
        for (int k = 1; k <= 4; ++k) {
          const Frame next = frame(cuts[i - 1] + 0.25 * k * (cuts[i] - cuts[i - 1]));
          const bool folded = before.growth < 0;
          if (folded != (next.growth < 0)) {
            const Frame at = root(before.t, next.t, folded);
            if (folded)
              finish(at);
            else
              fold = at;
          }
          before = next;
        }
      if (before.growth < 0) finish(last);
    }
    if (from.t < 1) part(from, last, false, 0);
  }

private:
  static constexpr int kMaxDepth = 24;
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

  /// Whether the curve turns within the distance somewhere, or nearly.
  bool mayFold() const {
    // Cheap first: on a curve that turns little, and whose speed changes little, the curvature is bounded by the
    // control polygon's.
    const auto near = [this](double t) {
      const Point d = c_.first(t), dd = c_.second(t);
      const double speed2 = dot(d, d);
      return s_ * cross(d, dd) > 0.8 * speed2 * std::sqrt(speed2);
    };
    for (int i = 0; i <= 4; ++i)
      if (near(i / 4.0)) return true;
    double slow[2];
    for (int i = slowest(c_, slow); i-- > 0;)
      if (near(slow[i])) return true;
    return false;
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
    bool good = fit(from, inner, to, backwards, fitted);
    Point centre;
    if (backwards) good = centreOf(from, to, centre) && good;
    if (!good && depth < kMaxDepth) {
      part(from, inner[1], backwards, depth + 1);
      return part(inner[1], to, backwards, depth + 1);
    }
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
};

} // namespace

Point startTangent(const Cubic& curve) {
  const Point* p = curve.p;
  double size = 0;
  for (int i = 1; i < 4; ++i) size = std::max(size, length(p[i] - p[0]));
  for (int i = 1; i < 4; ++i)
    if (const Point d = p[i] - p[0]; length(d) > 1e-6 * size) return unit(d);
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
  Offset(curve, distance, tolerance, chain).run();
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
