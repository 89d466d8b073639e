// Texture coordinates: of each set and corner, changed by affine maps.
#include "spawn/geometry/internal.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace gpgp::spawn {

using namespace shader;

namespace {

/// A mesh that shares all ranges but those of one set. Without a map the set goes.
Status rewriteUv(MeshPool& pool, Form& form, uint32_t set, const std::function<vec2(uint32_t)>& map) {
  const uint corners = meshCorners(pool, form.mesh);
  const uint to = takePool(pool, kMeshHeader + (map ? 2 * corners : 0));
  if (to == 0) return kGeometryNoRoom;
  for (uint i = 0; i < kMeshHeader; ++i) {
    setPoolWord(pool, to + i, poolWord(pool, form.mesh + i));
  }
  const uint bit = 1u << set, sets = meshUvSets(pool, form.mesh);
  setPoolWord(pool, to + kMeshUvSets, map ? sets | bit : sets & ~bit);
  setPoolWord(pool, to + kMeshUvRange + set, map ? to + kMeshHeader : 0);
  for (uint c = 0; map && c < corners; ++c) {
    const vec2 uv = map(c);
    setPoolWord(pool, to + kMeshHeader + 2 * c, floatBitsToUint(settle(uv.x)));
    setPoolWord(pool, to + kMeshHeader + 2 * c + 1, floatBitsToUint(settle(uv.y)));
  }
  form.mesh = to;
  return kGeometryOk;
}
bool hasSet(MeshPool& pool, const Form& form, uint32_t set) {
  return form.mesh != 0 && ((meshUvSets(pool, form.mesh) >> set) & 1u) != 0;
}

} // namespace

UvProjection setupProjection(const Form& form, UvAxes axes, float textureWidth, float textureHeight, vec2 offset,
                             const Axes& world, vec3 worldOrigin) {
  static constexpr uint32_t kAxes[6][2] = {{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}};
  const bool inWorld = axes >= UvAxes::WorldXY;
  const auto& pair = kAxes[uint32_t(axes) % 6];
  const vec3 directions[3] = {inWorld ? world.x : form.scope.axisX, inWorld ? world.y : form.scope.axisY,
                              inWorld ? world.z : form.scope.axisZ};
  const vec3 origin = inWorld ? worldOrigin : form.scope.origin;
  UvProjection p;
  for (int i = 0; i < 2; ++i) {
    float extent = i == 0 ? textureWidth : textureHeight;
    if (!(extent > 0)) extent = form.scope.size[int(pair[i])];
    if (!(extent > 0)) extent = 1.0f;
    const vec3 d = directions[pair[i]];
    const float inverse = divide(1.0f, extent);
    const vec3 rate = times3(d, inverse);
    const float shift = multiply(subtract(i == 0 ? offset.x : offset.y, inner3(d, origin)), inverse);
    (i == 0 ? p.u : p.v) = glm::vec4(rate, shift);
  }
  return p;
}

Status projectUv(MeshPool& pool, Form& form, uint32_t set, const UvProjection& projection) {
  if (set >= kMaxUvSets) return kGeometryBadArgument;
  if (form.mesh == 0) return kGeometryOk;
  return rewriteUv(pool, form, set, [&](uint32_t c) {
    const vec3 p = framePosition(pool, form, c);
    return vec2(add(inner3(vec3(projection.u), p), projection.u.w), add(inner3(vec3(projection.v), p), projection.v.w));
  });
}

Status mapUv(MeshPool& pool, Form& form, uint32_t set, vec2 x, vec2 y, vec2 move) {
  if (set >= kMaxUvSets) return kGeometryBadArgument;
  if (!hasSet(pool, form, set)) return kGeometryOk;
  return rewriteUv(pool, form, set, [&](uint32_t c) {
    const vec2 uv = cornerUv(pool, form.mesh, set, c);
    return vec2(add(add(multiply(uv.x, x.x), multiply(uv.y, y.x)), move.x),
                add(add(multiply(uv.x, x.y), multiply(uv.y, y.y)), move.y));
  });
}
Status translateUv(MeshPool& pool, Form& form, uint32_t set, float u, float v) {
  return mapUv(pool, form, set, vec2(1, 0), vec2(0, 1), vec2(u, v));
}
Status scaleUv(MeshPool& pool, Form& form, uint32_t set, float u, float v) {
  return mapUv(pool, form, set, vec2(u, 0), vec2(0, v), vec2(0, 0));
}
Status rotateUv(MeshPool& pool, Form& form, uint32_t set, float degrees) {
  const vec2 sc = sineCosineDegrees(degrees);
  return mapUv(pool, form, set, vec2(sc.y, sc.x), vec2(-sc.x, sc.y), vec2(0, 0));
}
Status tileUv(MeshPool& pool, Form& form, uint32_t set, float textureWidth, float textureHeight) {
  const float u = textureWidth > 0 ? divide(form.scope.size.x, textureWidth) : 1.0f;
  const float v = textureHeight > 0 ? divide(form.scope.size.y, textureHeight) : 1.0f;
  return scaleUv(pool, form, set, u, v);
}

Status normalizeUv(MeshPool& pool, Form& form, uint32_t set, bool u, bool v, bool perFace) {
  if (set >= kMaxUvSets) return kGeometryBadArgument;
  if (!hasSet(pool, form, set)) return kGeometryOk;
  const std::vector<uint32_t> faceAt = cornerFaces(pool, form.mesh);
  std::vector<vec2> low(perFace ? meshFaces(pool, form.mesh) : 1), high(low.size());
  std::vector<bool> seen(low.size());
  for (uint c = 0; c < faceAt.size(); ++c) {
    const uint f = perFace ? faceAt[c] : 0;
    const vec2 uv = cornerUv(pool, form.mesh, set, c);
    low[f] = seen[f] ? glm::min(low[f], uv) : uv;
    high[f] = seen[f] ? glm::max(high[f], uv) : uv;
    seen[f] = true;
  }
  return rewriteUv(pool, form, set, [&](uint32_t c) {
    const uint f = perFace ? faceAt[c] : 0;
    vec2 uv = cornerUv(pool, form.mesh, set, c);
    const vec2 extent = high[f] - low[f];
    if (u && extent.x > 0) uv.x = divide(subtract(uv.x, low[f].x), extent.x);
    if (v && extent.y > 0) uv.y = divide(subtract(uv.y, low[f].y), extent.y);
    return uv;
  });
}

Status copyUv(MeshPool& pool, Form& form, uint32_t from, uint32_t to) {
  if (from >= kMaxUvSets || to >= kMaxUvSets) return kGeometryBadArgument;
  if (!hasSet(pool, form, from)) return deleteUv(pool, form, to);
  return rewriteUv(pool, form, to, [&](uint32_t c) { return cornerUv(pool, form.mesh, from, c); });
}
Status deleteUv(MeshPool& pool, Form& form, uint32_t set) {
  if (set >= kMaxUvSets) return kGeometryBadArgument;
  if (!hasSet(pool, form, set)) return kGeometryOk;
  return rewriteUv(pool, form, set, {});
}

} // namespace gpgp::spawn
