// Stage 1: a path's verbs and points, or its stroke's, to monotone pieces.
#include "vector/geometry/check_stroke.h"
#include "vector/geometry/stroke.h"
#include "vector/patch/drawing.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace gpgp::vector {
namespace {
using core::makeError;

constexpr uint32_t kPointsOfVerb[] = {1, 1, 2, 3, 0, 3};

core::Result<void> checkPath(const GpgpPath& path) {
  if (path.verbCount && !path.verbs) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "verbs is NULL");
  if (path.pointCount && !path.points) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "points is NULL");
  if (path.fillRule != GPGP_FILL_NON_ZERO && path.fillRule != GPGP_FILL_EVEN_ODD)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "fillRule is %d; it must be a GpgpFillRule", path.fillRule);
  uint64_t needed = 0;
  for (uint32_t i = 0; i < path.verbCount; ++i) {
    if (path.verbs[i] > GPGP_PATH_ARC)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "verbs[%u] is %u; it must be a GpgpPathVerb", i, path.verbs[i]);
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
  if (!(path.scale >= 0 && std::isfinite(path.scale)))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "scale is %g; it must be finite and not negative",
                     static_cast<double>(path.scale));
  for (int i = 0; i < 4; ++i) {
    const float most = i < 3 ? kMaxColor : 1;
    if (!(path.color[i] >= 0 && path.color[i] <= most))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "color[%d] is %g; it must be 0 to %g", i,
                       static_cast<double>(path.color[i]), static_cast<double>(most));
  }
  return {};
}

bool hasArcs(const GpgpPath& path) {
  return std::find(path.verbs, path.verbs + path.verbCount, GpgpPathVerb(GPGP_PATH_ARC)) != path.verbs + path.verbCount;
}

/// Which verbs of a shape are parts of arcs.
struct Arcs {
  std::pmr::vector<uint32_t> ofVerb; ///< 1 + the index of its ellipse; 0: none. May end before the verbs do
  std::pmr::vector<Ellipse>* ellipses;
};

/// The path as a shape, arcs as cubics.
core::Result<void> shapeOf(const GpgpPath& path, Shape& shape, Arcs* arcs = nullptr) {
  constexpr double kArcTolerance = 1e-4; // pixels
  const double scale = path.scale > 0 ? static_cast<double>(path.scale) : 1;
  const float* next = path.points;
  Point at, start;
  bool closed = false;
  const auto take = [&next] {
    const Point p{next[0], next[1]};
    next += 2;
    return p;
  };
  for (uint32_t i = 0; i < path.verbCount; ++i) {
    const GpgpPathVerb verb = path.verbs[i];
    if (closed && verb != GPGP_PATH_MOVE) shape.move(start);
    closed = verb == GPGP_PATH_CLOSE;
    if (verb == GPGP_PATH_ARC) {
      const Point radii = take(), form = take(), end = take();
      if (!(form.y == 0 || form.y == 1 || form.y == 2 || form.y == 3))
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "verbs[%u]: the flags of an arc are %g; they must be 0 to 3", i,
                         form.y);
      const uint32_t flags = static_cast<uint32_t>(form.y);
      const size_t first = shape.points.size(), firstVerb = shape.verbs.size();
      const Ellipse ellipse =
          appendSvgArc(shape, at, std::abs(radii.x), std::abs(radii.y), form.x, (flags & GPGP_ARC_LARGE) != 0,
                       (flags & GPGP_ARC_SWEEP) != 0, end, kArcTolerance / scale);
      if (arcs && !(ellipse.u == Point{})) {
        arcs->ellipses->push_back(ellipse);
        arcs->ofVerb.resize(firstVerb, 0);
        arcs->ofVerb.resize(shape.verbs.size(), static_cast<uint32_t>(arcs->ellipses->size()));
      }
      at = end;
      for (size_t k = first; k < shape.points.size(); ++k)
        if (!(std::abs(shape.points[k].x) <= kMaxCoordinate && std::abs(shape.points[k].y) <= kMaxCoordinate))
          return makeError(GPGP_ERROR_INVALID_ARGUMENT, "verbs[%u]: the arc reaches beyond +-1e7", i);
      continue;
    }
    shape.verbs.push_back(verb);
    for (uint32_t k = 0; k < kPointsOfVerb[verb]; ++k) shape.points.push_back(at = take());
    if (verb == GPGP_PATH_MOVE) start = at;
    if (verb == GPGP_PATH_CLOSE) at = start;
  }
  return {};
}

/// The stroke's outline as cubics, closed contour by contour.
core::Result<void> strokeOutline(const GpgpPath& path, std::pmr::vector<Monotone>& pieces) {
  const GpgpStroke& s = *path.stroke;
  if (auto ok = checkStroke(s); !ok) return ok;
  std::pmr::memory_resource* memory = pieces.get_allocator().resource();
  const double scale = s.scale > 0 ? static_cast<double>(s.scale) : 1;
  std::pmr::vector<double> dashes(memory);
  double sum = 0;
  for (uint32_t k = 0; k < (s.dashCount % 2 ? 2 * s.dashCount : s.dashCount); ++k)
    sum += dashes.emplace_back(s.dashes[k % s.dashCount]);
  if (!(sum > 0)) dashes.clear();
  Shape shape(memory), area(memory);
  if (auto ok = shapeOf(path, shape); !ok) return ok;
  const StrokeStyle style{s.width > 0 ? static_cast<double>(s.width) : 1 / scale,
                          static_cast<Cap>(s.cap),
                          static_cast<Join>(s.join),
                          s.miterLimit > 0 ? static_cast<double>(s.miterLimit) : 4,
                          dashes,
                          s.dashOffset};
  constexpr double kTolerance = 0.05; // pixels
  if (!strokeShape(shape, style, kTolerance / scale, {}, area))
    return makeError(GPGP_ERROR_UNSUPPORTED, "the stroke has too many points or dashes");
  const Point* next = area.points.data();
  Point start, at;
  for (const GpgpPathVerb verb : area.verbs) {
    Cubic curve;
    if (verb == GPGP_PATH_MOVE) {
      start = at = *next++;
      continue;
    }
    if (verb == GPGP_PATH_CUBIC) {
      curve = {{at, next[0], next[1], next[2]}};
      next += 3;
    } else {
      curve = Cubic::fromLine(at, verb == GPGP_PATH_LINE ? *next++ : start);
    }
    at = curve.p[3];
    if (!(std::abs(at.x) <= kMaxCoordinate && std::abs(at.y) <= kMaxCoordinate))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "the stroke reaches beyond +-1e7");
    cutMonotone(curve, pieces);
  }
  return {};
}

Point next(const float*& points) {
  points += 2;
  return {points[-2], points[-1]};
}
Point next(const Point*& points) { return *points++; }

/// Monotone pieces of contours without arcs.
template <class Points>
core::Result<void> outlineOf(std::span<const GpgpPathVerb> verbs, const Points* points,
                             std::pmr::vector<Monotone>& pieces, std::span<const uint32_t> arcs = {}) {
  const auto take = [&points] { return next(points); };
  Point start, current;
  const auto lineTo = [&](Point to) {
    if (!(to == current)) cutMonotone(Cubic::fromLine(current, to), pieces);
    current = to;
  };
  for (size_t i = 0; i < verbs.size(); ++i) {
    switch (verbs[i]) {
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
      cutMonotone(Cubic{{current, a, b, end}, false, i < arcs.size() ? arcs[i] : 0}, pieces);
      current = end;
      break;
    }
    default: lineTo(start); break;
    }
  }
  lineTo(start);
  return {};
}
} // namespace

core::Result<void> outline(const GpgpPath& path, std::pmr::vector<Monotone>& pieces,
                           std::pmr::vector<Ellipse>* ellipses) {
  if (auto ok = checkPath(path); !ok) return ok;
  if (path.stroke) return strokeOutline(path, pieces);
  if (hasArcs(path)) {
    Shape shape(pieces.get_allocator().resource());
    Arcs arcs{std::pmr::vector<uint32_t>(pieces.get_allocator()), ellipses};
    if (auto ok = shapeOf(path, shape, ellipses ? &arcs : nullptr); !ok) return ok;
    return outlineOf(shape.verbs, shape.points.data(), pieces, arcs.ofVerb);
  }
  return outlineOf(std::span(path.verbs, path.verbCount), path.points, pieces);
}

} // namespace gpgp::vector
