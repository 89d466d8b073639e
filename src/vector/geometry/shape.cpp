// Arcs, rectangles and ellipses as cubics. The usual cubic for an arc of angle a is off by r 2.73e-4 (a / 90 deg)^6,
// so the number of pieces follows from the tolerance.
#include "vector/geometry/shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gpgp::vector {

double Affine::scale() const {
  const double p = std::hypot(a - d, b + c), q = std::hypot(a + d, b - c);
  return (p + q) / 2;
}

bool Affine::finite() const {
  return std::isfinite(a) && std::isfinite(b) && std::isfinite(c) && std::isfinite(d) && std::isfinite(e) &&
         std::isfinite(f);
}

Affine operator*(const Affine& o, const Affine& i) {
  return {o.a * i.a + o.c * i.b, o.b * i.a + o.d * i.b,       o.a * i.c + o.c * i.d,
          o.b * i.c + o.d * i.d, o.a * i.e + o.c * i.f + o.e, o.b * i.e + o.d * i.f + o.f};
}

void appendArc(Shape& shape, Point center, Point u, Point v, double angle, double sweep, Point end, double tolerance) {
  const double radius = std::max(std::hypot(u.x, u.y), std::hypot(v.x, v.y));
  const double quarters = std::fabs(sweep) / (std::numbers::pi / 2);
  double finer = std::pow(2.73e-4 * radius / tolerance, 1.0 / 6);
  if (!(finer > 1)) finer = 1; // also where it is not a number
  const int pieces = static_cast<int>(std::clamp(std::ceil(quarters * std::min(finer, 16.0) - 1e-9), 1.0, 64.0));
  const double step = sweep / pieces, k = 4.0 / 3 * std::tan(step / 4);
  const auto at = [&](double t) { return center + std::cos(t) * u + std::sin(t) * v; };
  const auto along = [&](double t) { return (-std::sin(t)) * u + std::cos(t) * v; };
  for (int i = 0; i < pieces; ++i) {
    const double t0 = angle + step * i, t1 = angle + step * (i + 1);
    const Point p1 = i + 1 == pieces ? end : at(t1);
    shape.cubic(at(t0) + k * along(t0), p1 - k * along(t1), p1);
  }
}

Ellipse appendSvgArc(Shape& shape, Point from, double rx, double ry, double degrees, bool large, bool positive,
                     Point to, double tolerance) {
  if (from == to) return {};
  rx = std::fabs(rx);
  ry = std::fabs(ry);
  const auto line = [&] {
    shape.line(to);
    return Ellipse{};
  };
  if (!(rx > 0 && ry > 0)) return line();
  const double phi = degrees * (std::numbers::pi / 180), c = std::cos(phi), s = std::sin(phi);
  const Point half = 0.5 * (from - to);
  // In units of the radii, so that huge and tiny ones neither overflow nor vanish.
  const double x = (c * half.x + s * half.y) / rx, y = (c * half.y - s * half.x) / ry;
  const double length = std::hypot(x, y);
  if (!std::isfinite(length) || length < 1e-12) return line();
  const double grow = std::max(length, 1.0);
  rx *= grow;
  ry *= grow;
  const double ux = x / grow, uy = y / grow, l = length / grow;
  double h = std::sqrt(std::max(0.0, 1 - l * l)) / l;
  if (large == positive) h = -h;
  const double kx = h * uy,
               ky = -h * ux; // center, in the unit circle's space, from the middle of the flattened segment
  const Point axisU{c * rx, s * rx}, axisV{-s * ry, c * ry};
  const Point center = 0.5 * (from + to) + kx * axisU + ky * axisV;
  const double a0 = std::atan2(uy - ky, ux - kx), a1 = std::atan2(-uy - ky, -ux - kx);
  double sweep = a1 - a0;
  if (positive && sweep < 0) sweep += 2 * std::numbers::pi;
  if (!positive && sweep > 0) sweep -= 2 * std::numbers::pi;
  appendArc(shape, center, axisU, axisV, a0, sweep, to, tolerance);
  return {center, axisU, axisV};
}

Shape rectangle(double x, double y, double w, double h, double rx, double ry, double tolerance) {
  Shape s;
  rx = std::min(rx, w / 2);
  ry = std::min(ry, h / 2);
  if (!(rx > 0 && ry > 0)) {
    s.move({x, y});
    s.line({x + w, y});
    s.line({x + w, y + h});
    s.line({x, y + h});
    s.close();
    return s;
  }
  constexpr double quarter = std::numbers::pi / 2;
  const Point u{rx, 0}, v{0, ry};
  s.move({x + rx, y});
  if (w > 2 * rx) s.line({x + w - rx, y});
  appendArc(s, {x + w - rx, y + ry}, u, v, -quarter, quarter, {x + w, y + ry}, tolerance);
  if (h > 2 * ry) s.line({x + w, y + h - ry});
  appendArc(s, {x + w - rx, y + h - ry}, u, v, 0, quarter, {x + w - rx, y + h}, tolerance);
  if (w > 2 * rx) s.line({x + rx, y + h});
  appendArc(s, {x + rx, y + h - ry}, u, v, quarter, quarter, {x, y + h - ry}, tolerance);
  if (h > 2 * ry) s.line({x, y + ry});
  appendArc(s, {x + rx, y + ry}, u, v, 2 * quarter, quarter, {x + rx, y}, tolerance);
  s.close();
  return s;
}

Shape ellipse(double cx, double cy, double rx, double ry, double tolerance) {
  Shape s;
  const Point start{cx + rx, cy};
  s.move(start);
  appendArc(s, {cx, cy}, {rx, 0}, {0, ry}, 0, 2 * std::numbers::pi, start, tolerance);
  s.close();
  return s;
}

} // namespace gpgp::vector
