#include "vector/import/lottie/property.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector::lottie {
namespace {
/// One coordinate of the easing's curve.
double cubic(double a, double b, double t) {
  const double s = 1 - t;
  return 3 * s * s * t * a + 3 * s * t * t * b + t * t * t;
}
double lerp(double a, double b, double t) { return a + (b - a) * t; }
Point pointOf(const std::vector<double>& v) { return {v.size() > 0 ? v[0] : 0, v.size() > 1 ? v[1] : 0}; }
Point derivative(const std::array<Point, 4>& c, double t) {
  const double s = 1 - t, a = 3 * s * s, b = 6 * s * t, d = 3 * t * t;
  return {a * (c[1].x - c[0].x) + b * (c[2].x - c[1].x) + d * (c[3].x - c[2].x),
          a * (c[1].y - c[0].y) + b * (c[2].y - c[1].y) + d * (c[3].y - c[2].y)};
}
std::array<Point, 4> curveOf(const Keyframe& key, const std::vector<double>& from, const std::vector<double>& to) {
  const Point a = pointOf(from), b = pointOf(to);
  return {a, {a.x + key.by[0].x, a.y + key.by[0].y}, {b.x + key.by[1].x, b.y + key.by[1].y}, b};
}
} // namespace

double Easing::at(double time) const {
  if (!(time > 0)) return 0;
  if (time >= 1) return 1;
  double low = 0, high = 1; // x grows with the parameter, as both control points lie in 0 to 1
  for (int i = 0; i < 52; ++i) {
    const double middle = 0.5 * (low + high);
    (cubic(x1, x2, middle) < time ? low : high) = middle;
  }
  return cubic(y1, y2, 0.5 * (low + high));
}

Point pointOfCubic(const std::array<Point, 4>& c, double t) {
  const double s = 1 - t, a = s * s * s, b = 3 * s * s * t, d = 3 * s * t * t, e = t * t * t;
  return {a * c[0].x + b * c[1].x + d * c[2].x + e * c[3].x, a * c[0].y + b * c[1].y + d * c[2].y + e * c[3].y};
}

double lengthOfCubic(const std::array<Point, 4>& c, double t) {
  // Gauss-Legendre with 8 nodes on each of 8 parts.
  static constexpr double kNodes[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
  static constexpr double kWeights[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                         0.1012285362903763};
  double sum = 0;
  for (int part = 0; part < 8; ++part) {
    const double middle = t * (part + 0.5) / 8, half = t / 16;
    for (size_t k = 0; k < 4; ++k)
      for (const double side : {-1.0, 1.0}) {
        const Point d = derivative(c, middle + side * half * kNodes[k]);
        sum += kWeights[k] * half * std::hypot(d.x, d.y);
      }
  }
  return sum;
}

double parameterAt(const std::array<Point, 4>& c, double length) {
  if (!(length > 0)) return 0;
  if (length >= lengthOfCubic(c)) return 1;
  double low = 0, high = 1;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (lengthOfCubic(c, middle) < length ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Property::Segment Property::segmentAt(double frame) const {
  const auto next = std::upper_bound(keys.begin(), keys.end(), frame,
                                     [](double time, const Keyframe& key) { return time < key.time; });
  if (next == keys.begin()) return {nullptr, &keys.front().start, &keys.front().start, 0};
  const Keyframe& key = *(next - 1);
  const auto valueOf = [&](auto at) { // old files leave the last keyframe empty: it ends where the one before does
    return at->start.empty() && at != keys.begin() ? &(at - 1)->end : &at->start;
  };
  const std::vector<double>* from = valueOf(next - 1);
  if (next == keys.end() || key.hold) return {nullptr, from, from, 0};
  const std::vector<double>* to = key.end.empty() ? valueOf(next) : &key.end;
  const double span = next->time - key.time;
  return {&key, from, to, span > 0 ? (frame - key.time) / span : 1};
}

std::vector<double> Property::at(double frame) const {
  if (keys.empty()) return value;
  const Segment s = segmentAt(frame);
  if (!s.key || s.from->size() != s.to->size()) return *s.from;
  std::vector<double> result(*s.from);
  const auto eased = [&](size_t dimension) {
    const std::vector<Easing>& e = s.key->easing;
    return e.empty() ? s.part : e[std::min(dimension, e.size() - 1)].at(s.part);
  };
  if (s.key->curved && result.size() >= 2) {
    const std::array<Point, 4> c = curveOf(*s.key, *s.from, *s.to);
    const double way = eased(0), whole = lengthOfCubic(c);
    Point p;
    if (way < 0 || way > 1) { // beyond an end it goes straight on
      const Point end = way < 0 ? c[0] : c[3], d = derivative(c, way < 0 ? 1e-6 : 1 - 1e-6);
      const double l = std::hypot(d.x, d.y), over = (way < 0 ? way : way - 1) * whole;
      p = l > 0 ? Point{end.x + d.x / l * over, end.y + d.y / l * over} : end;
    } else {
      p = pointOfCubic(c, parameterAt(c, way * whole));
    }
    result[0] = p.x, result[1] = p.y;
    for (size_t i = 2; i < result.size(); ++i) result[i] = lerp(result[i], (*s.to)[i], way);
    return result;
  }
  const bool each = s.key->easing.size() > 1;
  const double all = eased(0);
  for (size_t i = 0; i < result.size(); ++i) result[i] = lerp(result[i], (*s.to)[i], each && i ? eased(i) : all);
  return result;
}

double Property::number(double frame, double otherwise) const {
  const std::vector<double> v = at(frame);
  return v.empty() ? otherwise : v[0];
}

Point Property::point(double frame, Point otherwise) const {
  const std::vector<double> v = at(frame);
  return v.size() < 2 ? otherwise : Point{v[0], v[1]};
}

double Property::direction(double frame) const {
  if (keys.empty()) return 0;
  Segment s = segmentAt(std::clamp(frame, keys.front().time, keys.back().time - 1e-9));
  if (!s.key || s.from->size() < 2 || s.from->size() != s.to->size()) return 0;
  const std::array<Point, 4> c = curveOf(*s.key, *s.from, *s.to);
  const double way = s.key->easing.empty() ? s.part : s.key->easing[0].at(s.part);
  const double t = s.key->curved ? parameterAt(c, std::clamp(way, 0.0, 1.0) * lengthOfCubic(c)) : 0.5;
  const Point d = derivative(c, std::clamp(t, 1e-4, 1 - 1e-4)); // not where a control point lies on its end
  return d.x == 0 && d.y == 0 ? 0 : std::atan2(d.y, d.x);
}

} // namespace gpgp::vector::lottie
