// Parts of forms between planes, or between texture coordinates.
#include "spawn/geometry/internal.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn {

using namespace shader;

namespace {

float slackOf(const MeshPool& pool, const Form& form) {
  const Bounds b = scopeBounds(pool, form);
  const vec3 e = b.high - b.low;
  return 2e-6f * std::max({e.x, e.y, e.z});
}

} // namespace

Status slice(MeshPool& pool, const Form& form, uint32_t axis, float from, float to, bool adjust, Form& piece) {
  if (axis > 2 || !std::isfinite(from) || !std::isfinite(to)) return kGeometryBadArgument;
  Attempt attempt(pool);
  Form made = form;
  const bool closed = isClosedSurface(pool, form);
  const Bounds bounds = scopeBounds(pool, form);
  const float slack = slackOf(pool, form);
  Status status = form.mesh == 0 || !(to > from) ? kGeometryEmpty : kGeometryOk;
  // A form that is flat along the axis is in the part that it lies in.
  const float thickness = bounds.high[axis] - bounds.low[axis];
  if (status == kGeometryOk && thickness <= slack) {
    const float at = bounds.low[axis];
    const bool last = at <= to + slack && to >= form.scope.size[axis] - slack;
    if (at < from - slack || !(at < to - slack || last)) status = kGeometryEmpty;
  } else {
    Cut cut{glm::vec4(0.0f), 0xffffffffu, 0, 1.0f, slack};
    for (const float side : {1.0f, -1.0f}) {
      if (status != kGeometryOk) break;
      cut.weight = glm::vec4(0.0f);
      cut.weight[int(axis)] = side;
      cut.weight.w = side > 0 ? -from : to;
      // Nothing to cut: the mesh is shared.
      const float reach = side > 0 ? bounds.low[axis] - from : to - bounds.high[axis];
      if (reach < -slack) status = cutForm(pool, made, cut, closed, false);
    }
  }
  if (status > kGeometryEmpty) return attempt.end(status);
  if (status == kGeometryEmpty) made.mesh = 0;
  // The slab as the scope: the mesh moves against it.
  vec3 move(0.0f), size = form.scope.size;
  move[int(axis)] = from;
  size[int(axis)] = subtract(to, from);
  if (made.mesh != 0) {
    const Bounds now = scopeBounds(pool, made);
    if (adjust) {
      for (int other = 0; other < 3; ++other) {
        if (other == int(axis)) continue;
        move[other] = now.low[other];
        size[other] = subtract(now.high[other], now.low[other]);
      }
    }
    if (move != vec3(0.0f)) {
      Builder b = builderFor(pool, made.mesh, 1);
      for (uint v = 0; v < meshVertices(pool, made.mesh); ++v) {
        addVertex(pool, b, minus3(scaled3(vertexPosition(pool, made.mesh, v), made.scale), move));
      }
      for (uint f = 0; f < meshFaces(pool, made.mesh); ++f) {
        copyFace(pool, b, made.mesh, f, 0, false, 0);
      }
      status = finishForm(pool, b, made, false);
      if (status != kGeometryOk) return attempt.end(status);
    }
  }
  made.scope.origin = scopePoint(form.scope, move);
  made.scope.size = size;
  piece = made;
  return attempt.end(status);
}

Status sliceUv(MeshPool& pool, const Form& form, uint32_t set, uint32_t axis, float from, float to, Form& piece) {
  if (axis > 1 || set >= kMaxUvSets || !std::isfinite(from) || !std::isfinite(to)) return kGeometryBadArgument;
  Attempt attempt(pool);
  Form made = form;
  vec2 low, high;
  uvBounds(pool, form, set, low, high);
  const float slack = 2e-6f * std::max(std::fabs(high[int(axis)]), std::fabs(low[int(axis)]));
  Status status = form.mesh == 0 || !(to > from) ? kGeometryEmpty : kGeometryOk;
  for (const float side : {1.0f, -1.0f}) {
    if (status != kGeometryOk) break;
    const Cut cut{glm::vec4(0.0f, 0.0f, 0.0f, side > 0 ? -from : to), axis, set, side, slack};
    status = cutForm(pool, made, cut, false, true);
  }
  if (status == kGeometryEmpty) made.mesh = 0;
  if (status <= kGeometryEmpty) piece = made;
  return attempt.end(status);
}

Status trim(MeshPool& pool, Form& form, vec3 normal, float offset, bool close) {
  const vec3 n = unit3(inScope(form.scope, normal));
  if (n == vec3(0.0f) || !std::isfinite(offset)) return kGeometryBadArgument;
  Attempt attempt(pool);
  Form made = form;
  const float w = subtract(divide(inner3(normal, form.scope.origin), length3(normal)), divide(offset, length3(normal)));
  const Cut cut{glm::vec4(n, w), 0xffffffffu, 0, 1.0f, slackOf(pool, form)};
  Status status = kGeometryEmpty;
  if (form.mesh != 0) status = cutForm(pool, made, cut, close && isClosedSurface(pool, form), false);
  if (status <= kGeometryEmpty) form = made;
  return attempt.end(status);
}

} // namespace gpgp::spawn
