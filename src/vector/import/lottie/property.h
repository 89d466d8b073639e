// Values that change over time: keyframes with easing, and positions that move along curves.
#pragma once
#include "vector/geometry/shape.h"

#include <array>
#include <span>
#include <vector>

namespace gpgp::vector::lottie {

/// A curve from (0, 0) to (1, 1) with two control points: how a value goes from one keyframe to the next.
struct Easing {
  double x1 = 0, y1 = 0, x2 = 1, y2 = 1;
  /// Where the value is at a part of the time, 0 to 1. The result may lie outside of 0 to 1.
  double at(double time) const;
};

struct Keyframe {
  double time = 0;                ///< frames
  std::vector<double> start, end; ///< `end` is empty where the next keyframe's start is meant
  std::vector<Easing> easing;     ///< one for all dimensions, or one each; empty: linear
  bool hold = false;
  bool curved = false;     ///< a position that moves along a cubic, at a speed that the easing gives
  std::array<Point, 2> by; ///< of such: from the start to its control point, and from the end to its own
};

/// Numbers, or a path as numbers: of each vertex its point and both tangents (6).
struct Property {
  std::vector<double> value;  ///< where there are no keyframes
  std::vector<Keyframe> keys; ///< by time
  bool closed = false;        ///< of a path

  bool animated() const { return !keys.empty(); }
  std::vector<double> at(double frame) const;
  double number(double frame, double otherwise = 0) const;
  Point point(double frame, Point otherwise = {0, 0}) const;
  /// The way that a position goes, as an angle in radians; 0 where it rests.
  double direction(double frame) const;

private:
  struct Segment {
    const Keyframe* key = nullptr;
    const std::vector<double>*from = nullptr, *to = nullptr;
    double part = 0; ///< of the time between them
  };
  Segment segmentAt(double frame) const;
};

/// Arc length of a cubic from its start to the parameter `t`.
double lengthOfCubic(const std::array<Point, 4>& c, double t = 1);
/// The parameter at which a cubic has this arc length.
double parameterAt(const std::array<Point, 4>& c, double length);
Point pointOfCubic(const std::array<Point, 4>& c, double t);

} // namespace gpgp::vector::lottie
