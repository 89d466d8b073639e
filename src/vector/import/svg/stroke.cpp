// Offsetting a polyline by ribbons.
//
// Where the two offset edges at a point can share their corners (a miter within its limit, or a bend so slight that any
// join looks the same, and no shorter edge is eaten up), the segments before and after are one ribbon. Elsewhere the
// ribbon ends square, and a wedge on the outer side makes the join. All parts turn the same way, so that under the
// non-zero rule their overlaps cannot show or cancel; ribbons and wedges meet in edges that are equal bit for bit.
#include "vector/import/svg/stroke.h"

#include "vector/import/svg/polyline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gpgp::vector::svg {
namespace {

double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
Point left(Point d) { return {-d.y, d.x}; }

class Stroker {
public:
  Stroker(const StrokeStyle& style, double tolerance, Shape& out)
      : style_(style), h_(style.width / 2), tolerance_(tolerance), out_(out) {}

  void stroke(const Polyline& line) {
    const size_t n = line.points.size();
    if (n == 0) return;
    if (n == 1) return spot(line.points[0]);
    const size_t segments = line.closed ? n : n - 1;
    directions_.resize(segments);
    lengths_.resize(segments);
    for (size_t i = 0; i < segments; ++i) {
      const Point d = line.points[(i + 1) % n] - line.points[i];
      lengths_[i] = std::hypot(d.x, d.y);
      directions_[i] = {d.x / lengths_[i], d.y / lengths_[i]};
    }
    // For each point: whether its ribbon runs through, and then half the ribbon's cross edge.
    std::vector<Point> edge(n);
    std::vector<bool> through(n);
    for (size_t i = 0; i < n; ++i) {
      if (!line.closed && (i == 0 || i + 1 == n)) continue;
      through[i] = shareable((i + segments - 1) % segments, i, line.smooth[i], edge[i]);
    }
    size_t first = 0;
    while (first < n && through[first]) ++first;
    if (first == n) return ring(line, edge);
    const auto at = [first, n](size_t i) { return (first + i) % n; };
    for (size_t begin = 0; begin < segments;) {
      size_t end = begin + 1;
      while (end < segments && through[at(end)]) ++end;
      ribbon(line, edge, at(begin), end - begin);
      const size_t last = at(end);
      if (line.closed || end < segments)
        join(line.points[last], directions_[at(end - 1)], directions_[last], line.smooth[last]);
      begin = end;
    }
    if (line.closed) return;
    cap(line.points[0], -1.0 * directions_[0]);
    cap(line.points[n - 1], directions_[segments - 1]);
  }

private:
  bool shareable(size_t before, size_t after, bool smooth, Point& edge) const {
    const Point a = directions_[before], b = directions_[after];
    const double c = dot(a, b);
    if (!(c > -0.999)) return false;
    const double cosHalf = std::sqrt((1 + c) / 2), tanHalf = std::sqrt(std::max(0.0, 1 - c) / (1 + c));
    if (h_ * tanHalf > 0.45 * std::min(lengths_[before], lengths_[after])) return false;
    const bool miter = !smooth && style_.join == Join::Miter && 1 / cosHalf <= style_.miterLimit;
    if (!miter && h_ * (1 / cosHalf - 1) > tolerance_) return false;
    const Point sum = a + b;
    edge = h_ / (cosHalf * std::hypot(sum.x, sum.y)) * left(sum);
    return true;
  }

  /// `count` segments from point `begin` on, whose inner points run through.
  void ribbon(const Polyline& line, const std::vector<Point>& edge, size_t begin, size_t count) {
    const size_t n = line.points.size(), segments = directions_.size();
    const auto point = [&](size_t i) { return line.points[(begin + i) % n]; };
    const auto half = [&](size_t i) {
      if (i == 0) return h_ * left(directions_[begin]);
      if (i == count) return h_ * left(directions_[(begin + count - 1) % segments]);
      return edge[(begin + i) % n];
    };
    out_.move(point(0));
    for (size_t i = 0; i <= count; ++i) out_.line(point(i) - half(i));
    out_.line(point(count));
    for (size_t i = count + 1; i-- > 0;) out_.line(point(i) + half(i));
    out_.close();
  }

  /// A closed line all of whose points run through: outer and inner contour.
  void ring(const Polyline& line, const std::vector<Point>& edge) {
    const size_t n = line.points.size();
    out_.move(line.points[0] - edge[0]);
    for (size_t i = 1; i < n; ++i) out_.line(line.points[i] - edge[i]);
    out_.close();
    out_.move(line.points[n - 1] + edge[n - 1]);
    for (size_t i = n - 1; i-- > 0;) out_.line(line.points[i] + edge[i]);
    out_.close();
  }

  /// The wedge on the outer side of a corner.
  void join(Point p, Point a, Point b, bool smooth) {
    const double turning = cross(a, b), c = dot(a, b);
    if (turning == 0 && c > 0) return;
    const double side = turning > 0 ? -1 : 1; // of `left` that is outside
    const Point from = side * h_ * left(a), to = side * h_ * left(b);
    // Ribbons run forwards on the side of minus `left`; the wedge turns as they do.
    const Point first = side < 0 ? from : to, second = side < 0 ? to : from;
    out_.move(p);
    out_.line(p + first);
    if (smooth || style_.join == Join::Round) {
      double sweep = std::atan2(cross(first, second), dot(first, second));
      if (sweep < 0) sweep += 2 * std::numbers::pi; // half turns, whatever their rounding
      appendArc(out_, p, {h_, 0}, {0, h_}, std::atan2(first.y, first.x), sweep, p + second, tolerance_ / 4);
    } else {
      const double cosHalf = std::sqrt(std::max(0.0, 1 + c) / 2);
      if (style_.join == Join::Miter && cosHalf > 1e-6 && 1 / cosHalf <= style_.miterLimit) {
        const Point sum = first + second;
        out_.line(p + h_ / (cosHalf * std::hypot(sum.x, sum.y)) * sum);
      }
      out_.line(p + second);
    }
    out_.close();
  }

  /// At an end, `d` pointing outwards.
  void cap(Point p, Point d) {
    if (style_.cap == Cap::Butt) return;
    const Point side = h_ * left(d);
    out_.move(p);
    out_.line(p - side);
    if (style_.cap == Cap::Square) {
      out_.line(p - side + h_ * d);
      out_.line(p + side + h_ * d);
      out_.line(p + side);
    } else {
      appendArc(out_, p, {h_, 0}, {0, h_}, std::atan2(-side.y, -side.x), std::numbers::pi, p + side, tolerance_ / 4);
    }
    out_.close();
  }

  /// A contour without length: only caps can be seen.
  void spot(Point p) {
    if (style_.cap == Cap::Butt) return;
    const Shape s = style_.cap == Cap::Round ? ellipse(p.x, p.y, h_, h_, tolerance_ / 4)
                                             : rectangle(p.x - h_, p.y - h_, 2 * h_, 2 * h_, 0, 0, tolerance_);
    out_.verbs.insert(out_.verbs.end(), s.verbs.begin(), s.verbs.end());
    out_.points.insert(out_.points.end(), s.points.begin(), s.points.end());
  }

  const StrokeStyle& style_;
  double h_, tolerance_;
  Shape& out_;
  std::vector<Point> directions_;
  std::vector<double> lengths_;
};

} // namespace

bool strokeShape(const Shape& shape, const StrokeStyle& style, double tolerance, const StrokeLimits& limits,
                 Shape& result) {
  if (!(style.width > 0)) return true;
  std::vector<Polyline> lines;
  if (!flatten(shape, style.width / 2, tolerance, limits.points, lines)) return false;
  if (!style.dashes.empty()) {
    std::vector<Polyline> dashes;
    for (const Polyline& line : lines) {
      if (line.points.size() < 2) continue;
      if (dashes.size() >= limits.dashes ||
          !dash(line, style.dashes, style.dashOffset, limits.dashes - dashes.size(), dashes))
        return false;
    }
    lines = std::move(dashes);
  }
  Stroker stroker(style, tolerance, result);
  for (const Polyline& line : lines) stroker.stroke(line);
  return true;
}

} // namespace gpgp::vector::svg
