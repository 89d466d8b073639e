#include "vector/geometry/curve.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gpgp::vector {
namespace {
double mix(double a, double b, double t) { return (1 - t) * a + t * b; }
Point mix(Point a, Point b, double t) { return {mix(a.x, b.x, t), mix(a.y, b.y, t)}; }

double round32(double v) {
  // g++ 12 at -O3 drops the rounding when it vectorises the pair of conversions; volatile keeps it.
  const volatile float rounded = static_cast<float>(v);
  return static_cast<double>(rounded);
}
Point round32(Point p) { return {round32(p.x), round32(p.y)}; }

std::array<double, 8> key(const Cubic& c) {
  return {c.p[0].y, c.p[0].x, c.p[3].y, c.p[3].x, c.p[1].y, c.p[1].x, c.p[2].y, c.p[2].x};
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
  return {{blossom(t0, t0, t0), blossom(t0, t0, t1), blossom(t0, t1, t1), blossom(t1, t1, t1)}, line};
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

double Monotone::xAt(double y) const {
  const Point* p = curve.p;
  if (!(y > p[0].y)) return p[0].x;
  if (!(y < p[3].y)) return p[3].x;
  const double height = p[3].y - p[0].y;
  double t = (y - p[0].y) / height;
  if (curve.line) return mix(p[0].x, p[3].x, t);
  const double c1 = 3 * (p[1].y - p[0].y), c2 = 3 * (p[2].y - 2 * p[1].y + p[0].y),
               c3 = p[3].y - 3 * p[2].y + 3 * p[1].y - p[0].y;
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double f = ((c3 * t + c2) * t + c1) * t + p[0].y - y;
    if (f == 0) break;
    (f < 0 ? low : high) = t;
    const double slope = (3 * c3 * t + 2 * c2) * t + c1;
    double next = t - f / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - t) < 1e-16) break;
    t = next;
  }
  const double x = curve.at(t).x;
  return std::clamp(x, std::min(p[0].x, p[3].x), std::max(p[0].x, p[3].x));
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
  std::sort(pieces.begin(), pieces.end(),
            [](const Monotone& a, const Monotone& b) { return key(a.curve) < key(b.curve); });
  size_t kept = 0;
  for (size_t i = 0; i < pieces.size();) {
    Monotone sum = pieces[i++];
    while (i < pieces.size() && key(pieces[i].curve) == key(sum.curve)) sum.winding += pieces[i++].winding;
    if (sum.winding != 0) pieces[kept++] = sum;
  }
  pieces.resize(kept);
}

} // namespace gpgp::vector
