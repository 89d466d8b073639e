#include "vector/import/svg/track.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector::svg {

bool Track::at(double along, Point& place, double& angle) const {
  if (lengths.size() < 2 || !(along >= 0 && along <= length())) return false;
  size_t i = static_cast<size_t>(std::lower_bound(lengths.begin(), lengths.end(), along) - lengths.begin());
  i = std::clamp<size_t>(i, 1, lengths.size() - 1);
  const double step = lengths[i] - lengths[i - 1], part = step > 0 ? (along - lengths[i - 1]) / step : 0;
  place = points[i - 1] + part * (points[i] - points[i - 1]);
  const Point d = (1 - part) * directions[i].from + part * directions[i].to;
  angle = std::atan2(d.y, d.x);
  return true;
}

Track trackOf(const Shape& shape) {
  constexpr int kSteps = 64; // of a curve
  Track track;
  Point at, start;
  const auto unit = [](Point d, Point otherwise) {
    const double length = std::hypot(d.x, d.y);
    return length > 0 ? 1 / length * d : otherwise;
  };
  const auto to = [&](Point p, bool jumps = false, Point from = {}, Point towards = {}) {
    Track::Directions directions;
    double step = 0;
    if (!track.points.empty()) {
      const Point d = p - track.points.back();
      step = std::hypot(d.x, d.y);
      if (step == 0) return;
      const Point chord = 1 / step * d;
      directions = {unit(from, chord), unit(towards, chord)};
    }
    track.lengths.push_back(track.points.empty() ? 0 : track.lengths.back() + (jumps ? 0 : step));
    track.points.push_back(p);
    track.directions.push_back(directions);
  };
  const auto curve = [&](const Cubic& c) {
    const auto direction = [&c](double t) {
      return (1 - t) * (1 - t) * (c.p[1] - c.p[0]) + 2 * t * (1 - t) * (c.p[2] - c.p[1]) + t * t * (c.p[3] - c.p[2]);
    };
    for (int i = 1; i <= kSteps; ++i) {
      const double before = static_cast<double>(i - 1) / kSteps, t = static_cast<double>(i) / kSteps;
      to(i < kSteps ? c.at(t) : c.p[3], false, direction(before), direction(t));
    }
  };
  const Point* p = shape.points.data();
  for (const GpgpPathVerb verb : shape.verbs) switch (verb) {
    case GPGP_PATH_MOVE: to(start = at = *p++, true); break;
    case GPGP_PATH_LINE: to(at = *p++); break;
    case GPGP_PATH_QUAD: curve(Cubic::fromQuadratic(at, p[0], p[1])), at = p[1], p += 2; break;
    case GPGP_PATH_CUBIC: curve({{at, p[0], p[1], p[2]}}), at = p[2], p += 3; break;
    default: to(at = start); break;
    }
  return track;
}

} // namespace gpgp::vector::svg
