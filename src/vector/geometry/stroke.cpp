// Stroking by offset curves.
//
// To the left and to the right of a contour runs a chain of offset curves. Where the contour bends, the outer chain
// makes the join and the inner one goes back to the contour's own point and out again, so that the outline is the sum
// of ribbons and joins that all turn the same way: under the non-zero rule their overlaps cannot show or cancel. Where
// two lines are long enough, their offsets meet in one point instead, inside as outside.
#include "vector/geometry/stroke.h"

#include "vector/geometry/arcs_join.h"
#include "vector/geometry/contour.h"
#include "vector/geometry/offset.h"
#include "vector/geometry/vectors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gpgp::vector {
namespace {

class Stroker {
public:
  Stroker(const StrokeStyle& style, double tolerance, Shape& out)
      : style_(style), h_(style.width / 2), tolerance_(tolerance), out_(out),
        joints_(out.points.get_allocator().resource()), chain_(out.points.get_allocator().resource()) {}

  void stroke(const Contour& contour) {
    const std::span<const Segment> segments = contour.segments;
    const size_t n = segments.size();
    if (n == 0) return spot(contour.start, contour.direction);
    joints_.assign(n, Joint{}); // joint i follows segment i
    for (size_t i = 0; i < n; ++i)
      if (contour.closed || i + 1 < n) joints_[i] = joint(segments[i], segments[(i + 1) % n]);
    const Segment &first = segments[0], &last = segments[n - 1];
    // To the right forwards, to the left back.
    chain_.clear();
    side(segments, contour.closed, 1);
    if (contour.closed) {
      write();
      chain_.clear();
    } else {
      cap(last.curve.p[3], last.out);
    }
    const size_t right = chain_.size();
    side(segments, contour.closed, 0);
    std::reverse(chain_.begin() + static_cast<std::ptrdiff_t>(right), chain_.end());
    for (size_t i = right; i < chain_.size(); ++i) {
      std::swap(chain_[i].p[0], chain_[i].p[3]);
      std::swap(chain_[i].p[1], chain_[i].p[2]);
    }
    if (!contour.closed) cap(first.curve.p[0], -1.0 * first.in);
    write();
  }

private:
  struct Joint {
    Point from, to; // tangents before and after
    double turning = 0, cosine = 1;
    bool smooth = false;
    bool shared[2] = {}; // by side: both offsets end in `corner`
    Point corner[2];
  };

  double offset(int side) const { return side ? -h_ : h_; }

  Joint joint(const Segment& before, const Segment& after) const {
    Joint j{before.out, after.in, cross(before.out, after.in), dot(before.out, after.in), before.smooth, {}, {}};
    const Point p = after.curve.p[0];
    const double gap = length(before.curve.p[3] - p);
    if (h_ * std::abs(j.turning) + gap < 0.2 * tolerance_ && j.cosine > 0) {
      for (int side : {0, 1}) {
        j.shared[side] = true;
        j.corner[side] = p + offset(side) * left(j.to);
      }
      return j;
    }
    if (!before.curve.line || !after.curve.line || !(j.cosine > -0.999) || gap > 0) return j;
    const double cosHalf = std::sqrt((1 + j.cosine) / 2), reach = h_ * std::sqrt((1 - j.cosine) / (1 + j.cosine));
    const Point bisector = left(j.from + j.to);
    const double scale = 1 / (cosHalf * length(bisector));
    const int inner = j.turning > 0 ? 0 : 1;
    if (reach <=
        0.5 * std::min(length(before.curve.p[3] - before.curve.p[0]), length(after.curve.p[3] - after.curve.p[0]))) {
      j.shared[inner] = true;
      j.corner[inner] = p + offset(inner) * scale * bisector;
    }
    const bool miter = !j.smooth && hasMiters() && 1 / cosHalf <= style_.miterLimit;
    if (miter || h_ * (1 / cosHalf - 1) < 0.2 * tolerance_) {
      j.shared[1 - inner] = true;
      j.corner[1 - inner] = p + offset(1 - inner) * scale * bisector;
    }
    return j;
  }

  bool hasMiters() const { return style_.join != Join::Round && style_.join != Join::Bevel; }

  void side(std::span<const Segment> segments, bool closed, int side) {
    const size_t n = segments.size();
    const double s = offset(side);
    for (size_t i = 0; i < n; ++i) {
      const Segment& segment = segments[i];
      const Joint& before = joints_[(i + n - 1) % n];
      Point start = segment.curve.p[0] + s * left(segment.in), end = segment.curve.p[3] + s * left(segment.out);
      if (before.shared[side]) start = before.corner[side];
      if (joints_[i].shared[side]) end = joints_[i].corner[side];
      if (segment.curve.line)
        line(start, end);
      else
        appendOffset(segment.curve, s, start, end, tolerance_ * 0.8, chain_);
      if (!joints_[i].shared[side] && (closed || i + 1 < n))
        join(joints_[i], segment.curve, segments[(i + 1) % n].curve, end, side);
    }
  }

  void join(const Joint& j, const Cubic& before, const Cubic& after, Point start, int side) {
    const double s = offset(side);
    const Point p = after.p[0], end = p + s * left(j.to);
    if ((side == 0) == (j.turning > 0)) { // inside
      line(start, p);
      line(p, end);
      return;
    }
    if (j.smooth || style_.join == Join::Round) {
      const double turn = std::abs(std::atan2(j.turning, j.cosine));
      arc(p, h_, start, end, j.turning > 0 ? turn : -turn);
      return;
    }
    if (style_.join == Join::Arcs)
      if (const auto arcs = arcsJoin(
              {p, j.from, j.to, s, endCurvature(before), startCurvature(after), std::max(style_.miterLimit, 1.0)})) {
        edge(start, arcs->before);
        line(arcs->before.end, arcs->cut.end);
        edge(arcs->cut.end, {end, arcs->behind.centre, arcs->behind.radius, arcs->behind.sweep});
        return;
      }
    const double cosHalf = std::sqrt(std::max(0.0, 1 + j.cosine) / 2);
    if (hasMiters() && cosHalf > 1e-6 && 1 / cosHalf <= style_.miterLimit) {
      const Point bisector = left(j.from + j.to);
      const Point tip = p + s / (cosHalf * length(bisector)) * bisector;
      line(start, tip);
      line(tip, end);
    } else if (style_.join != Join::Miter && hasMiters() &&
               style_.miterLimit > cosHalf) { // across, at the limit (SVG 2, 13.5.5)
      const double sinHalf = std::sqrt(std::max(0.0, 1 - j.cosine) / 2);
      const double reach = h_ * (style_.miterLimit - cosHalf) / sinHalf;
      const Point first = start + reach * j.from, last = end - reach * j.to;
      line(start, first);
      line(first, last);
      line(last, end);
    } else {
      line(start, end);
    }
  }

  /// From one side to the other around an end, `d` pointing outwards.
  void cap(Point p, Point d) {
    const Point n = h_ * left(d);
    if (style_.cap == Cap::Round) {
      arc(p, h_, p - n, p + n, std::numbers::pi);
    } else if (style_.cap == Cap::Square) {
      line(p - n, p - n + h_ * d);
      line(p - n + h_ * d, p + n + h_ * d);
      line(p + n + h_ * d, p + n);
    } else {
      line(p - n, p + n);
    }
  }

  /// A contour without length: only caps can be seen.
  void spot(Point p, Point d) {
    if (style_.cap == Cap::Butt) return;
    chain_.clear();
    cap(p, d);
    cap(p, -1.0 * d);
    write();
  }

  void line(Point a, Point b) {
    if (!(a == b)) chain_.push_back(Cubic::fromLine(a, b));
  }

  void edge(Point start, const EdgePart& part) {
    if (part.radius > 0)
      arc(part.centre, part.radius, start, part.end, part.sweep);
    else
      line(start, part.end);
  }

  void arc(Point p, double radius, Point start, Point end, double sweep) {
    Shape cubics(out_.points.get_allocator().resource());
    const Point d = start - p;
    appendArc(cubics, p, {radius, 0}, {0, radius}, std::atan2(d.y, d.x), sweep, end, tolerance_ / 4);
    Point at = start;
    for (size_t i = 0; i + 2 < cubics.points.size(); i += 3) {
      chain_.push_back({{at, cubics.points[i], cubics.points[i + 1], cubics.points[i + 2]}, false});
      at = cubics.points[i + 2];
    }
  }

  void write() {
    if (chain_.empty()) return;
    out_.move(chain_.front().p[0]);
    for (const Cubic& c : chain_) {
      if (c.line)
        out_.line(c.p[3]);
      else
        out_.cubic(c.p[1], c.p[2], c.p[3]);
    }
    out_.close();
  }

  const StrokeStyle& style_;
  const double h_, tolerance_;
  Shape& out_;
  std::pmr::vector<Joint> joints_;
  std::pmr::vector<Cubic> chain_;
};

} // namespace

bool strokeShape(const Shape& shape, const StrokeStyle& style, double tolerance, const StrokeLimits& limits,
                 Shape& result) {
  if (!(style.width > 0)) return true;
  std::pmr::memory_resource* memory = result.points.get_allocator().resource();
  std::pmr::vector<Contour> contours(memory), dashes(memory);
  const double tiny = std::min(1e-3 * tolerance, 1e-4 * style.width);
  contoursOf(shape, tiny, std::max(std::min(0.1 * tolerance, 0.05 * style.width), tiny), contours);
  if (!style.dashes.empty()) {
    for (const Contour& contour : contours) {
      if (dashes.size() >= limits.dashes ||
          !dash(contour, style.dashes, style.dashOffset, limits.dashes - dashes.size(), dashes))
        return false;
    }
    contours.swap(dashes);
  }
  const size_t verbs = result.verbs.size(), points = result.points.size();
  Stroker stroker(style, tolerance, result);
  for (const Contour& contour : contours) {
    stroker.stroke(contour);
    if (result.points.size() - points <= limits.points) continue;
    result.verbs.resize(verbs);
    result.points.resize(points);
    return false;
  }
  return true;
}

} // namespace gpgp::vector
