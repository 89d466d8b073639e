// Cubic Béziers in double precision, cut where they turn in x or y.
//
// A Monotone is what the whole service works with: top to bottom, never turning, end points exactly representable as
// float, so that neighbours share them bit for bit. Lines and quadratics are elevated to cubics (exact in double).
#pragma once
#include <array>
#include <cstdint>
#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

namespace gpgp::vector {

struct Point {
  double x = 0, y = 0;
  friend bool operator==(const Point&, const Point&) = default;
};
inline Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
inline Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
inline Point operator*(double s, Point a) { return {s * a.x, s * a.y}; }

struct Cubic {
  Point p[4];
  bool line = false; ///< controls at the thirds
  uint32_t arc = 0;  ///< 1 + the index of the ellipse of which it is an arc (Shape::ellipses); 0: none

  static Cubic fromLine(Point a, Point b);
  static Cubic fromQuadratic(Point a, Point control, Point b);
  Point at(double t) const;
  /// The part from t0 to t1.
  Cubic part(double t0, double t1) const;
  /// How far it is from the parabola with the same ends and middle, at most.
  double bend() const;
};

/// A cubic that grows in y and never turns in x or y. Horizontal pieces bound nothing and are left out everywhere.
struct Monotone {
  Cubic curve;
  int winding = 1; ///< +1 where the path runs down along it, -1 up; sums where several coincide

  double top() const { return curve.p[0].y; }
  double bottom() const { return curve.p[3].y; }
  /// The curve's x at a height, by safeguarded Newton; heights outside give the ends.
  double xAt(double y) const;
  /// The same from the parameter at a height nearby, which becomes that of `y`; takes less time where that is near.
  double xNear(double y, double& t) const;
  /// The same as xAt with the slope dx / dy there, which may be infinite, and the curve's parameter.
  struct Place {
    double x, slope, t;
  };
  Place placeAt(double y) const;
  /// Heights where it changes from bending left to bending right or back; at most two.
  int inflections(double heights[2]) const;
};

/// The x and the places of two pieces at a height each: the same bits as one by one, with fewer instructions.
std::array<double, 2> xsAt(const Monotone& a, double ya, const Monotone& b, double yb);
std::array<Monotone::Place, 2> placesAt(const Monotone& a, double ya, const Monotone& b, double yb);
/// xNear of two pieces at one height.
std::array<double, 2> xsNear(const Monotone& a, const Monotone& b, double y, std::array<double, 2>& t);

/// The height at which two pieces cross, to within `fine`, by Newton's steps for both parameters at once; nothing where
/// they do not settle from `t`. Where pieces cross more than once it may be any of these.
std::optional<double> crossingNear(const Monotone& a, const Monotone& b, std::array<double, 2> t, double fine);

/// Below zero: all of `a` lies left of `b` in the rows they share, or touches it; above: right. 0: their hulls do not
/// say. Cheap: no curve is evaluated.
int sideByHull(const Monotone& a, const Monotone& b);

/// Real roots of a t^2 + b t + c in (0, 1), ascending; returns their number. Any input, NaN included.
int rootsInside(double a, double b, double c, double roots[2]);

/// Appends the monotone pieces of one cubic. A curve and its reverse give the same pieces with opposite winding.
void cutMonotone(const Cubic& curve, std::pmr::vector<Monotone>& pieces);

/// Adds up the windings of identical pieces and drops those that cancel. Order becomes canonical.
void mergeCoincident(std::pmr::vector<Monotone>& pieces);

} // namespace gpgp::vector
