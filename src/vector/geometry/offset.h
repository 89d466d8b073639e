// The curve at a distance from a cubic, as few cubics as a tolerance allows.
//
// The offset of a cubic is no cubic. Each piece gets the true ends and tangents; its two handles are fitted to the
// offset's normals at three places (least squares), and the piece is halved until it is near enough at four others.
// The error falls with about the sixth power of a piece's length (as in Tiller and Hanson 1984, de Boor et al. 1987).
#pragma once
#include "vector/geometry/curve.h"

namespace gpgp::vector {

/// Unit tangents at a cubic's ends; where controls coincide, of what is left of it. Zero for a point.
Point startTangent(const Cubic& curve);
Point endTangent(const Cubic& curve);

/// Where a cubic turns so sharply that it all but stops (a cusp, or nearly): the ends of the parts, shorter than
/// `reach`, in which it does; up to two pairs. Returns the number of parameters, even.
int sharpTurns(const Cubic& curve, double reach, double parameters[4]);

/// Appends cubics from `start` to `end` at `distance` to the left, towards (-y, x) of the tangent; below zero: to the
/// right. Both lie there but for rounding. Where the curve turns within the distance the offset runs backwards; there
/// the chain goes by way of the centres of curvature and round what runs backwards once more the other way, so that a
/// ribbon between the curve and the chain winds around each of its points in one direction only.
/// The curve has no sharpTurns; distance is not 0. Off by less than the tolerance.
void appendOffset(const Cubic& curve, double distance, Point start, Point end, double tolerance,
                  std::pmr::vector<Cubic>& chain);

} // namespace gpgp::vector
