// From verbs to segments.
#include "vector/geometry/contour.h"
#include "vector/geometry/vectors.h"

#include "vector/geometry/offset.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector {
namespace {

class Builder {
public:
  Builder(double tiny, double reach, std::pmr::vector<Contour>& contours)
      : tiny_(tiny), reach_(reach), contours_(contours), current_(contours.get_allocator().resource()) {}

  void begin(Point p) {
    finish(false);
    current_.start = at_ = p;
    open_ = true;
  }
  void line(Point to) {
    any_ = true;
    straight(to, false);
  }
  void cubic(Point a, Point b, Point to) {
    any_ = true;
    const Point p[4] = {at_, a, b, to};
    // Flat: along the line through the two points that are farthest apart.
    Point far = to - at_;
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < i; ++k)
        if (length(p[i] - p[k]) > length(far)) far = p[i] - p[k];
    const double size = length(far);
    if (!(size > tiny_)) return straight(to, false);
    const Point direction{far.x / size, far.y / size};
    if (std::abs(cross(direction, a - at_)) < tiny_ && std::abs(cross(direction, b - at_)) < tiny_ &&
        std::abs(cross(direction, to - at_)) < tiny_)
      return flat(Cubic{{p[0], p[1], p[2], p[3]}}, direction);
    const Cubic curve{{p[0], length(a - at_) < reach_ ? at_ : a, length(b - to) < reach_ ? to : b, to}};
    double turns[4];
    const int count = sharpTurns(curve, reach_, turns);
    double from = 0;
    for (int i = 0; i < count; i += 2) {
      curved(curve.part(from, turns[i]));
      from = turns[i + 1];
    }
    curved(count ? curve.part(from, 1) : curve);
    current_.segments.back().smooth = false;
    at_ = to;
  }
  void finish(bool closed) {
    if (!open_) return;
    open_ = false;
    if (closed) {
      any_ = true;
      straight(current_.start, false);
    }
    current_.closed = closed && !current_.segments.empty();
    if (any_) contours_.push_back(std::move(current_));
    any_ = false;
    const Point start = current_.start;
    current_ = Contour(contours_.get_allocator().resource());
    current_.start = start;
  }

private:
  void curved(const Cubic& curve) { current_.segments.push_back({curve, startTangent(curve), endTangent(curve)}); }
  void straight(Point to, bool smooth) {
    const Point d = to - at_;
    const double l = length(d);
    if (!(l > tiny_)) { // too close to have a direction
      if (!smooth && !current_.segments.empty()) current_.segments.back().smooth = false;
      return;
    }
    const Point direction{d.x / l, d.y / l};
    current_.segments.push_back({Cubic::fromLine(at_, to), direction, direction, smooth});
    at_ = to;
  }
  void flat(const Cubic& curve, Point direction) {
    const double a = dot(direction, curve.p[0]), b = dot(direction, curve.p[1]), c = dot(direction, curve.p[2]),
                 d = dot(direction, curve.p[3]);
    double turns[2];
    const int count = rootsInside(d - 3 * c + 3 * b - a, 2 * (c - 2 * b + a), b - a, turns);
    for (int i = 0; i < count; ++i) straight(curve.at(turns[i]), true);
    straight(curve.p[3], false);
  }

  const double tiny_, reach_;
  std::pmr::vector<Contour>& contours_;
  Contour current_;
  Point at_;
  bool open_ = false, any_ = false;
};

} // namespace

void contoursOf(const Shape& shape, double tiny, double reach, std::pmr::vector<Contour>& contours) {
  Builder b(tiny, reach, contours);
  const Point* next = shape.points.data();
  Point at;
  for (const GpgpPathVerb verb : shape.verbs) {
    switch (verb) {
    case GPGP_PATH_MOVE: b.begin(at = *next++); break;
    case GPGP_PATH_LINE: b.line(at = *next++); break;
    case GPGP_PATH_QUAD: {
      const Cubic c = Cubic::fromQuadratic(at, next[0], next[1]);
      b.cubic(c.p[1], c.p[2], at = next[1]);
      next += 2;
      break;
    }
    case GPGP_PATH_CUBIC:
      b.cubic(next[0], next[1], at = next[2]);
      next += 3;
      break;
    default: b.finish(true); break;
    }
  }
  b.finish(false);
}

} // namespace gpgp::vector
