// Paths in double precision and the maps between spaces: what strokes, importers and the path builder share.
#pragma once
#include "vector/geometry/curve.h"

#include <gpgp/vector.h>

#include <memory_resource>
#include <vector>

namespace gpgp::vector {

/// x' = a x + c y + e, y' = b x + d y + f: the order of SVG's matrix().
struct Affine {
  double a = 1, b = 0, c = 0, d = 1, e = 0, f = 0;

  bool operator==(const Affine&) const = default;
  Point operator()(Point p) const { return {a * p.x + c * p.y + e, b * p.x + d * p.y + f}; }
  /// How much longer a vector can become, at most (the larger singular value).
  double scale() const;
  bool finite() const;
};
/// First `inner`, then `outer`.
Affine operator*(const Affine& outer, const Affine& inner);

/// A point of it is center + cos(t) u + sin(t) v.
struct Ellipse {
  Point center, u, v;
};

/// Contours as verbs and points. Every contour begins with a MOVE, also those that follow a CLOSE.
struct Shape {
  explicit Shape(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : verbs(memory), points(memory) {}
  std::pmr::vector<GpgpPathVerb> verbs;
  std::pmr::vector<Point> points;

  bool empty() const { return verbs.empty(); }
  void move(Point p) { add(GPGP_PATH_MOVE, p); }
  void line(Point p) { add(GPGP_PATH_LINE, p); }
  void quad(Point c, Point p) {
    points.push_back(c);
    add(GPGP_PATH_QUAD, p);
  }
  void cubic(Point c1, Point c2, Point p) {
    points.push_back(c1);
    points.push_back(c2);
    add(GPGP_PATH_CUBIC, p);
  }
  void close() { verbs.push_back(GPGP_PATH_CLOSE); }

private:
  void add(GpgpPathVerb verb, Point p) {
    verbs.push_back(verb);
    points.push_back(p);
  }
};

/// Appends cubics for the part of an ellipse from `angle` over `sweep` (radians): axes u and v from `center`, so that
/// a point is center + cos u + sin v. Off by less than `tolerance`; the last point is `end`, bit for bit.
void appendArc(Shape& shape, Point center, Point u, Point v, double angle, double sweep, Point end, double tolerance);

/// Appends SVG's elliptical arc from the current point `from` (SVG 2, appendix B.2: radii too small are scaled up).
/// Returns its ellipse; one without axes where the arc is a line or nothing.
Ellipse appendSvgArc(Shape& shape, Point from, double rx, double ry, double degrees, bool large, bool positive,
                     Point to, double tolerance);

Shape rectangle(double x, double y, double width, double height, double rx, double ry, double tolerance);
Shape ellipse(double cx, double cy, double rx, double ry, double tolerance);

} // namespace gpgp::vector
