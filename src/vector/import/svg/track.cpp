#include "vector/import/svg/track.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector::svg {

bool Track::at(double along, Point& place, double& angle) const {
  if (lengths.size() < 2 || !(along >= 0 && along <= length())) return false;
  size_t i = static_cast<size_t>(std::lower_bound(lengths.begin(), lengths.end(), along) - lengths.begin());
  i = std::clamp<size_t>(i, 1, lengths.size() - 1);
  const Point d = points[i] - points[i - 1];
  const double step = lengths[i] - lengths[i - 1];
  place = points[i - 1] + (step > 0 ? (along - lengths[i - 1]) / step : 0) * d;
  angle = std::atan2(d.y, d.x);
  return true;
}

Track trackOf(const Shape& shape) {
  constexpr int kSteps = 64; // of a curve
  Track track;
  Point at, start;
  const auto to = [&track](Point p, bool jumps = false) {
    if (!track.points.empty()) {
      const Point d = p - track.points.back();
      const double step = std::hypot(d.x, d.y);
      if (step == 0) return;
      track.lengths.push_back(track.lengths.back() + (jumps ? 0 : step));
    } else {
      track.lengths.push_back(0);
    }
    track.points.push_back(p);
  };
  const auto curve = [&](const Cubic& c) {
    for (int i = 1; i < kSteps; ++i) to(c.at(static_cast<double>(i) / kSteps));
    to(c.p[3]);
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
