// Flattening by even steps of t: as many as the second difference asks for (Wang's bound), and as many as an offset
// curve needs that turns with the control polygon. Dashing by walking along the lines.
#include "vector/import/svg/polyline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gpgp::vector::svg {
namespace {

double length(Point p) { return std::hypot(p.x, p.y); }

double turn(Point a, Point b) { return std::fabs(std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y)); }

constexpr double kMaxSteps = 4096;

class Flattener {
public:
  Flattener(double halfWidth, double tolerance, size_t maxPoints, std::vector<Polyline>& lines)
      : tolerance_(tolerance), left_(maxPoints), lines_(lines) {
    const double chord = std::clamp(0.5 * tolerance / std::max(halfWidth, tolerance), 1e-8, 0.5);
    angle_ = 2 * std::acos(1 - chord);
  }

  void begin(Point p) {
    finish(false);
    any_ = false;
    add(p, false);
  }
  void line(Point p) {
    any_ = true;
    add(p, false);
  }
  void curve(Point p0, Point p1, Point p2, Point p3) {
    any_ = true;
    const double second = std::max(length(p0 - 2.0 * p1 + p2), length(p1 - 2.0 * p2 + p3));
    const double turning = p1 == p2 ? turn(p1 - p0, p3 - p2) : turn(p1 - p0, p2 - p1) + turn(p2 - p1, p3 - p2);
    const double steps = std::max(std::sqrt(0.75 * second / tolerance_), turning / angle_);
    const int n = static_cast<int>(std::clamp(std::ceil(std::isfinite(steps) ? steps : 1), 1.0, kMaxSteps));
    const Cubic cubic{{p0, p1, p2, p3}};
    for (int i = 1; i < n; ++i) add(cubic.at(static_cast<double>(i) / n), true);
    add(p3, false);
  }
  void finish(bool closed) {
    if (current_.points.empty()) return;
    if (closed) any_ = true;
    if (closed && current_.points.size() > 1 && near(current_.points.back(), current_.points.front())) {
      current_.points.pop_back();
      current_.smooth.pop_back();
    }
    current_.closed = closed && current_.points.size() > 1;
    if (any_) lines_.push_back(std::move(current_));
    current_ = {};
  }
  bool overflow() const { return overflow_; }

private:
  /// Too close to have a direction.
  bool near(Point a, Point b) const { return length(a - b) <= 1e-4 * tolerance_; }
  void add(Point p, bool smooth) {
    if (!current_.points.empty() && near(current_.points.back(), p)) {
      if (!smooth) current_.smooth.back() = false;
      return;
    }
    if (left_ == 0) {
      overflow_ = true;
      return;
    }
    --left_;
    current_.points.push_back(p);
    current_.smooth.push_back(smooth);
  }

  double tolerance_, angle_ = 0;
  size_t left_;
  std::vector<Polyline>& lines_;
  Polyline current_;
  bool any_ = false, overflow_ = false;
};

} // namespace

bool flatten(const Shape& shape, double halfWidth, double tolerance, size_t maxPoints, std::vector<Polyline>& lines) {
  Flattener f(halfWidth, tolerance, maxPoints, lines);
  const Point* next = shape.points.data();
  Point at;
  for (const GpgpPathVerb verb : shape.verbs) {
    switch (verb) {
    case GPGP_PATH_MOVE: f.begin(at = *next++); break;
    case GPGP_PATH_LINE: f.line(at = *next++); break;
    case GPGP_PATH_QUAD: {
      const double third = 1.0 / 3;
      f.curve(at, third * at + 2 * third * next[0], 2 * third * next[0] + third * next[1], next[1]);
      at = next[1];
      next += 2;
      break;
    }
    case GPGP_PATH_CUBIC:
      f.curve(at, next[0], next[1], next[2]);
      at = next[2];
      next += 3;
      break;
    default: f.finish(true); break;
    }
    if (f.overflow()) return false;
  }
  f.finish(false);
  return true;
}

bool dash(const Polyline& line, const std::vector<double>& pattern, double offset, size_t maxDashes,
          std::vector<Polyline>& dashes) {
  const size_t n = line.points.size(), begin = dashes.size();
  double period = 0, total = 0;
  for (const double d : pattern) period += d;
  const size_t segments = line.closed ? n : n - 1;
  for (size_t i = 0; i < segments; ++i) total += length(line.points[(i + 1) % n] - line.points[i]);
  if (!(period > 0) || !std::isfinite(total) ||
      total / period * static_cast<double>(pattern.size()) > static_cast<double>(maxDashes))
    return false;

  size_t slot = 0;
  double left = std::fmod(offset, period); // of the slot
  if (left < 0) left += period;
  while (left > 0 && left >= pattern[slot]) {
    left -= pattern[slot];
    slot = (slot + 1) % pattern.size();
  }
  left = pattern[slot] - left;
  const bool startsOn = slot % 2 == 0;

  Polyline current;
  const auto add = [&current](Point p, bool smooth) {
    if (!current.points.empty() && current.points.back() == p) return;
    current.points.push_back(p);
    current.smooth.push_back(smooth);
  };
  if (startsOn) add(line.points[0], false);
  for (size_t i = 0; i < segments; ++i) {
    const Point a = line.points[i], b = line.points[(i + 1) % n];
    const double l = length(b - a);
    double done = 0;
    while (l - done > left) {
      done += left;
      const Point p = a + done / l * (b - a);
      if (slot % 2 == 0) {
        add(p, false);
        dashes.push_back(std::move(current));
        current = {};
      }
      slot = (slot + 1) % pattern.size();
      left = pattern[slot];
      if (slot % 2 == 0) add(p, false);
      if (dashes.size() - begin > maxDashes) return false;
    }
    left -= l - done;
    if (slot % 2 == 0) add(b, i + 1 < n && line.smooth[i + 1]);
  }
  if (current.points.empty()) return true;
  // A dash that runs over the start of a closed contour is one dash, or the whole contour.
  if (line.closed && startsOn && dashes.size() == begin) {
    dashes.push_back(line);
  } else if (line.closed && startsOn) {
    Polyline& first = dashes[begin];
    current.smooth.back() = line.smooth[0];
    current.points.insert(current.points.end(), first.points.begin() + 1, first.points.end());
    current.smooth.insert(current.smooth.end(), first.smooth.begin() + 1, first.smooth.end());
    first = std::move(current);
  } else {
    dashes.push_back(std::move(current));
  }
  return true;
}

} // namespace gpgp::vector::svg
