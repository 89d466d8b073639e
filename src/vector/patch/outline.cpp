// Stage 1: a path's verbs and points to monotone pieces.
#include "vector/patch/drawing.h"

#include <cmath>

namespace gpgp::vector {
namespace {
using core::makeError;

constexpr uint32_t kPointsOfVerb[] = {1, 1, 2, 3, 0};

core::Result<void> checkPath(const GpgpPath& path) {
  if (path.verbCount && !path.verbs) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "verbs is NULL");
  if (path.pointCount && !path.points) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "points is NULL");
  if (path.fillRule != GPGP_FILL_NON_ZERO && path.fillRule != GPGP_FILL_EVEN_ODD)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "fillRule is %d", path.fillRule);
  uint64_t needed = 0;
  for (uint32_t i = 0; i < path.verbCount; ++i) {
    if (path.verbs[i] > GPGP_PATH_CLOSE)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "verbs[%u] is %u", i, path.verbs[i]);
    needed += kPointsOfVerb[path.verbs[i]];
  }
  if (path.verbCount && path.verbs[0] != GPGP_PATH_MOVE)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "verbs[0] must be GPGP_PATH_MOVE");
  if (needed != path.pointCount)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "pointCount is %u, the verbs need %llu", path.pointCount,
                     static_cast<unsigned long long>(needed));
  for (uint64_t i = 0; i < uint64_t(path.pointCount) * 2; ++i)
    if (!(std::abs(path.points[i]) <= kMaxCoordinate))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "points[%llu].%c is %g; it must be finite and within +-1e7",
                       static_cast<unsigned long long>(i / 2), i % 2 ? 'y' : 'x', static_cast<double>(path.points[i]));
  for (int i = 0; i < 4; ++i)
    if (!(path.color[i] >= 0 && path.color[i] <= 1))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "color[%d] is %g; it must be 0 to 1", i,
                       static_cast<double>(path.color[i]));
  return {};
}
} // namespace

core::Result<void> outline(const GpgpPath& path, std::pmr::vector<Monotone>& pieces) {
  if (auto ok = checkPath(path); !ok) return ok;
  const float* next = path.points;
  const auto take = [&next] {
    const Point p{next[0], next[1]};
    next += 2;
    return p;
  };
  Point start, current;
  const auto lineTo = [&](Point to) {
    if (!(to == current)) cutMonotone(Cubic::fromLine(current, to), pieces);
    current = to;
  };
  for (uint32_t i = 0; i < path.verbCount; ++i) {
    switch (path.verbs[i]) {
    case GPGP_PATH_MOVE:
      lineTo(start);
      start = current = take();
      break;
    case GPGP_PATH_LINE: lineTo(take()); break;
    case GPGP_PATH_QUAD: {
      const Point control = take(), end = take();
      cutMonotone(Cubic::fromQuadratic(current, control, end), pieces);
      current = end;
      break;
    }
    case GPGP_PATH_CUBIC: {
      const Point a = take(), b = take(), end = take();
      cutMonotone(Cubic{{current, a, b, end}}, pieces);
      current = end;
      break;
    }
    default: lineTo(start); break;
    }
  }
  lineTo(start);
  return {};
}

} // namespace gpgp::vector
