// Edges are circles or lines, given by where they leave the corner, their directions there and their signed
// curvatures. The one behind is followed backwards, so that both run away from the corner.
#include "vector/geometry/arcs_join.h"

#include "vector/geometry/offset.h"
#include "vector/geometry/vectors.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace gpgp::vector {
namespace {

constexpr double kStraight = 1e-7; ///< curvature times size of what counts as a line

/// From `start` along `direction`, turning by `curvature` a unit of length.
struct Edge {
  Point start, direction;
  double curvature;

  bool isLine() const { return curvature == 0; }
  double radius() const { return std::abs(1 / curvature); }
  Point centre() const { return start + (1 / curvature) * left(direction); }
  Point at(double along) const {
    if (isLine()) return start + along * direction;
    const double angle = along * curvature;
    return start + (std::sin(angle) / curvature) * direction + ((1 - std::cos(angle)) / curvature) * left(direction);
  }
  /// How far along a point of it lies, ahead of the start; below zero behind the start of a line.
  double lengthTo(Point p) const {
    if (isLine()) return dot(p - start, direction);
    const Point from = start - centre(), to = p - centre();
    double angle = std::atan2(cross(from, to), dot(from, to)) * (curvature > 0 ? 1 : -1);
    if (angle < 0) angle += 2 * std::numbers::pi;
    return angle * radius();
  }
};

/// Where two edges meet: 0, 1 or 2 points.
int meetings(const Edge& a, const Edge& b, Point points[2]) {
  if (a.isLine() && b.isLine()) {
    const double turning = cross(a.direction, b.direction);
    if (!(std::abs(turning) > 1e-9)) return 0;
    points[0] = a.at(cross(b.start - a.start, b.direction) / turning);
    return 1;
  }
  if (a.isLine() || b.isLine()) {
    const Edge &line = a.isLine() ? a : b, &circle = a.isLine() ? b : a;
    const double middle = dot(circle.centre() - line.start, line.direction);
    const Point foot = line.at(middle);
    const double square = circle.radius() * circle.radius() - dot(foot - circle.centre(), foot - circle.centre());
    if (!(square >= 0)) return 0;
    const double half = std::sqrt(square);
    points[0] = foot - half * line.direction, points[1] = foot + half * line.direction;
    return 2;
  }
  const Point between = b.centre() - a.centre();
  const double d = length(between), ra = a.radius(), rb = b.radius();
  if (!(d > 0) || d > ra + rb || d < std::abs(ra - rb)) return 0;
  const double along = (d * d + ra * ra - rb * rb) / (2 * d);
  const double side = std::sqrt(std::max(0.0, ra * ra - along * along));
  const Point x = 1 / d * between, foot = a.centre() + along * x;
  points[0] = foot + side * left(x), points[1] = foot - side * left(x);
  return 2;
}

/// The same edge with a radius that differs by `change`.
Edge resized(Edge edge, double change) {
  const double radius = edge.radius() + change;
  edge.curvature = (edge.curvature > 0 ? 1 : -1) / radius;
  return edge;
}

/// Changes the radii until the edges touch. False where no change makes them.
bool touch(Edge& a, Edge& b) {
  if (a.isLine() && b.isLine()) return false;
  const bool areCircles = !a.isLine() && !b.isLine();
  const bool isInside = areCircles && length(b.centre() - a.centre()) < std::abs(a.radius() - b.radius());
  const double signA = a.isLine()                            ? 0
                       : isInside && a.radius() > b.radius() ? -1
                                                             : 1,
               signB = b.isLine()                            ? 0
                       : isInside && b.radius() > a.radius() ? -1
                                                             : 1;
  const auto changed = [&](double change) {
    return std::pair(a.isLine() ? a : resized(a, signA * change), b.isLine() ? b : resized(b, signB * change));
  };
  const auto meet = [&](double change) {
    const auto [first, second] = changed(change);
    Point points[2];
    return meetings(first, second, points) > 0;
  };
  double low = 0, high = isInside ? std::abs(a.radius() - b.radius()) / 2 : 0;
  if (!isInside) {
    high = std::max(a.isLine() ? 0 : a.radius(), b.isLine() ? 0 : b.radius());
    for (int i = 0; !meet(high); ++i, low = high, high *= 2)
      if (i == 60) return false;
  } else if (!meet(high)) {
    return false;
  }
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (meet(middle) ? high : low) = middle;
  }
  std::tie(a, b) = changed(high);
  return true;
}

/// The part of an edge up to a length, or back from there to its start.
EdgePart part(const Edge& edge, double to, bool isBack) {
  EdgePart made;
  made.end = isBack ? edge.start : edge.at(to);
  if (edge.isLine()) return made;
  made.centre = edge.centre();
  made.radius = edge.radius();
  made.sweep = (isBack ? -to : to) * edge.curvature;
  return made;
}

} // namespace

double startCurvature(const Cubic& curve) {
  if (curve.line) return 0;
  const Point first = curve.p[1] - curve.p[0], second = curve.p[2] - 2 * curve.p[1] + curve.p[0];
  const double speed = length(first);
  double size = 0;
  for (int i = 1; i < 4; ++i) size = std::max(size, length(curve.p[i] - curve.p[0]));
  if (!(speed > 1e-6 * size)) return 0;
  return 2.0 / 3 * cross(first, second) / (speed * speed * speed);
}
double endCurvature(const Cubic& curve) {
  return -startCurvature({{curve.p[3], curve.p[2], curve.p[1], curve.p[0]}, curve.line});
}

std::optional<ArcsJoin> arcsJoin(const OuterCorner& corner) {
  const double h = std::abs(corner.offset);
  // Curvatures of the outer edges: none where these are folded.
  const double foldBefore = 1 - corner.offset * corner.before, foldBehind = 1 - corner.offset * corner.behind;
  if (!(foldBefore > 1e-3 && foldBehind > 1e-3)) return std::nullopt;
  Edge a{corner.vertex + corner.offset * left(corner.from), corner.from, corner.before / foldBefore};
  Edge b{corner.vertex + corner.offset * left(corner.to), -1.0 * corner.to, -corner.behind / foldBehind};
  for (Edge* edge : {&a, &b})
    if (std::abs(edge->curvature) * h < kStraight) edge->curvature = 0;
  if (a.isLine() && b.isLine()) return std::nullopt; // a miter
  Point points[2];
  int count = meetings(a, b, points);
  if (count == 0) {
    if (!touch(a, b)) return std::nullopt;
    count = meetings(a, b, points);
  }
  // The nearest in the directions in which the edges go on.
  double alongA = 0, alongB = 0, least = 1e300;
  Point tip;
  for (int i = 0; i < count; ++i) {
    const double toA = a.lengthTo(points[i]), toB = b.lengthTo(points[i]);
    if (toA < 0 || toB < 0 || toA + toB >= least) continue;
    least = toA + toB, alongA = toA, alongB = toB, tip = points[i];
  }
  if (!(least < 1e300)) return std::nullopt;
  // From the vertex to the tip: an arc that begins along the bisector.
  const Point bisector = corner.from - corner.to;
  const Point ahead = 1 / length(bisector) * bisector, chord = tip - corner.vertex;
  const double across = cross(ahead, chord), square = dot(chord, chord);
  Edge way{corner.vertex, ahead, square > 0 ? 2 * across / square : 0};
  if (std::abs(way.curvature) * h < kStraight) way.curvature = 0;
  const double most = corner.limit * h;
  if (way.lengthTo(tip) <= most) return ArcsJoin{part(a, alongA, false), {tip, {}, 0, 0}, part(b, alongB, true)};
  const Point at = way.at(most);
  const double angle = most * way.curvature;
  const Point normal = std::cos(angle) * ahead + std::sin(angle) * left(ahead);
  const auto isBeyond = [&](Point p) { return dot(p - at, normal) > 0; };
  if (isBeyond(a.start) || isBeyond(b.start) || !isBeyond(tip)) return std::nullopt;
  const auto cutOf = [&](const Edge& edge, double whole) { // the first crossing of the line
    constexpr int kSteps = 32;
    double low = 0, high = whole;
    for (int i = 1; i <= kSteps; ++i)
      if (isBeyond(edge.at(whole * i / kSteps))) {
        low = whole * (i - 1) / kSteps, high = whole * i / kSteps;
        break;
      }
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (isBeyond(edge.at(middle)) ? high : low) = middle;
    }
    return low;
  };
  const double cutA = cutOf(a, alongA), cutB = cutOf(b, alongB);
  return ArcsJoin{part(a, cutA, false), {b.at(cutB), {}, 0, 0}, part(b, cutB, true)};
}

} // namespace gpgp::vector
