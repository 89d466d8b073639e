// Dashes: arc length by four-point Gauss-Legendre quadrature over sixteen parts of a curve, inverted by bisection.
#include "vector/geometry/contour.h"
#include "vector/geometry/offset.h"
#include "vector/geometry/stroke.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gpgp::vector {
namespace {

class ArcLength {
public:
  explicit ArcLength(const Segment& segment) : segment_(segment) {
    const Point* p = segment.curve.p;
    c_ = 3 * (p[1] - p[0]);
    b_ = 6 * (p[2] - 2 * p[1] + p[0]);
    a_ = 3 * (p[3] - 3 * p[2] + 3 * p[1] - p[0]);
    if (segment.curve.line) {
      total_ = std::hypot(p[3].x - p[0].x, p[3].y - p[0].y);
      return;
    }
    for (int i = 0; i < kParts; ++i) {
      before_[static_cast<size_t>(i)] = total_;
      total_ += between(static_cast<double>(i) / kParts, static_cast<double>(i + 1) / kParts);
    }
  }
  double total() const { return total_; }
  double parameterAt(double length) const {
    if (segment_.curve.line) return std::clamp(length / total_, 0.0, 1.0);
    const auto after = std::upper_bound(before_.begin(), before_.end(), length);
    const size_t i = static_cast<size_t>(std::max<std::ptrdiff_t>(after - before_.begin() - 1, 0));
    const double start = static_cast<double>(i) / kParts, wanted = length - before_[i];
    double low = start, high = start + 1.0 / kParts;
    for (int k = 0; k < 40; ++k) {
      const double middle = 0.5 * (low + high);
      (between(start, middle) < wanted ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

private:
  static constexpr int kParts = 16;
  double speed(double t) const {
    const Point d = t * (t * a_ + b_) + c_;
    return std::sqrt(d.x * d.x + d.y * d.y);
  }
  double between(double from, double to) const {
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    return half * (0.6521451548625461 *
                       (speed(middle - 0.3399810435848563 * half) + speed(middle + 0.3399810435848563 * half)) +
                   0.3478548451374538 *
                       (speed(middle - 0.8611363115940526 * half) + speed(middle + 0.8611363115940526 * half)));
  }
  const Segment& segment_;
  Point a_, b_, c_;
  std::array<double, kParts> before_{};
  double total_ = 0;
};

} // namespace

double lengthOf(const Shape& shape) {
  double sum = 0;
  Point start, at;
  const auto add = [&](const Cubic& curve) {
    sum += ArcLength(Segment{curve, {}, {}}).total();
    at = curve.p[3];
  };
  const Point* p = shape.points.data();
  for (const GpgpPathVerb verb : shape.verbs) {
    if (verb == GPGP_PATH_MOVE) {
      start = at = *p++;
    } else if (verb == GPGP_PATH_LINE) {
      add(Cubic::fromLine(at, *p++));
    } else if (verb == GPGP_PATH_QUAD) {
      add(Cubic::fromQuadratic(at, p[0], p[1]));
      p += 2;
    } else if (verb == GPGP_PATH_CUBIC) {
      add({{at, p[0], p[1], p[2]}});
      p += 3;
    } else {
      add(Cubic::fromLine(at, start));
    }
  }
  return sum;
}

bool dash(const Contour& contour, std::span<const double> pattern, double offset, size_t maxDashes,
          std::pmr::vector<Contour>& dashes) {
  std::pmr::memory_resource* memory = dashes.get_allocator().resource();
  const size_t begin = dashes.size();
  double period = 0, total = 0;
  for (const double d : pattern) period += d;
  std::pmr::vector<ArcLength> lengths(memory);
  lengths.reserve(contour.segments.size());
  for (const Segment& s : contour.segments) total += lengths.emplace_back(s).total();
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
  if (contour.segments.empty()) { // no length: a dash that has none either
    if (startsOn) dashes.push_back(contour);
    return true;
  }

  Contour current(memory);
  bool on = false;
  const auto start = [&](Point p, Point direction) {
    current = Contour(memory);
    current.start = p;
    current.direction = direction;
    on = true;
  };
  if (startsOn) start(contour.segments[0].curve.p[0], contour.segments[0].in);
  for (size_t i = 0; i < contour.segments.size(); ++i) {
    const Segment& s = contour.segments[i];
    const double l = lengths[i].total();
    double done = 0, from = 0;
    const auto add = [&](double to) {
      if (!(to > from)) return;
      Segment part = s;
      if (from > 0 || to < 1) {
        part.curve = s.curve.part(from, to);
        if (part.curve.p[0] == part.curve.p[3] && s.curve.line) return;
        if (!s.curve.line) {
          part.in = startTangent(part.curve);
          part.out = endTangent(part.curve);
        }
      }
      current.segments.push_back(part);
    };
    while (l - done > left) {
      done += left;
      const double t = lengths[i].parameterAt(done);
      if (slot % 2 == 0) {
        add(t);
        dashes.push_back(std::move(current));
        on = false;
      }
      slot = (slot + 1) % pattern.size();
      left = pattern[slot];
      from = t;
      if (slot % 2 == 0) {
        const Cubic rest = s.curve.part(t, 1);
        start(rest.p[0], s.curve.line ? s.in : startTangent(rest));
      }
      if (dashes.size() - begin > maxDashes) return false;
    }
    left -= l - done;
    if (slot % 2 == 0) add(1);
  }
  if (!on) return true;
  // A dash that runs over the start of a closed contour is one dash, or the whole contour.
  if (contour.closed && startsOn && dashes.size() == begin) {
    current = contour;
    dashes.push_back(std::move(current));
  } else if (contour.closed && startsOn) {
    Contour& first = dashes[begin];
    current.segments.insert(current.segments.end(), first.segments.begin(), first.segments.end());
    first = std::move(current);
  } else {
    dashes.push_back(std::move(current));
  }
  return true;
}

} // namespace gpgp::vector
