// Operations on texture coordinates.
#include "spawn/cga/deriver.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn::cga {

uint32_t Deriver::uvSet(const CgaValue& v) {
  const float set = number(v);
  if (set >= 0 && set < static_cast<float>(kMaxUvSets)) return static_cast<uint32_t>(set);
  warn("uv set", "texture sets are numbered 0 to 9");
  return 0;
}

namespace {
UvAxes axesOfProjection(std::string_view word) {
  constexpr std::pair<std::string_view, UvAxes> kNames[] = {
      {"scope.xy", UvAxes::ScopeXY}, {"scope.xz", UvAxes::ScopeXZ}, {"scope.yx", UvAxes::ScopeYX},
      {"scope.yz", UvAxes::ScopeYZ}, {"scope.zx", UvAxes::ScopeZX}, {"scope.zy", UvAxes::ScopeZY},
      {"world.xy", UvAxes::WorldXY}, {"world.xz", UvAxes::WorldXZ}, {"world.yx", UvAxes::WorldYX},
      {"world.yz", UvAxes::WorldYZ}, {"world.zx", UvAxes::WorldZX}, {"world.zy", UvAxes::WorldZY}};
  for (const auto& [name, axes] : kNames)
    if (name == word) return axes;
  return UvAxes::ScopeXY;
}
} // namespace

bool Deriver::setupProjection_(const Arguments& a) {
  const UvAxes axes = axesOfProjection(word(a[1]));
  const vec3 e = shape_.form.scope.size;
  const std::string_view name = word(a[1]);
  const auto extent = [&](char axis) { return axis == 'x' ? e.x : axis == 'y' ? e.y : e.z; };
  const float wholeU = name.size() > 6 ? extent(name[6]) : e.x, wholeV = name.size() > 7 ? extent(name[7]) : e.y;
  // ~x: as often as it fits whole.
  const auto size = [&](uint32_t i, float whole) {
    if (a.count <= i) return 0.0f;
    if (a[i].type != kCgaFloating) return length(a[i], whole);
    const float wanted = std::fabs(number(a[i]));
    return wanted > 0 && whole > 0 ? divide(whole, std::max(1.0f, cgaRound(divide(whole, wanted)))) : 0.0f;
  };
  const vec2 offset(a.count > 4 ? length(a[4], wholeU) : 0.0f, a.count > 5 ? length(a[5], wholeV) : 0.0f);
  projections_.push_back(
      {uvSet(a[0]), shape_.projections, setupProjection(shape_.form, axes, size(2, wholeU), size(3, wholeV), offset)});
  shape_.projections = static_cast<uint32_t>(projections_.size() - 1);
  return true;
}

bool Deriver::projectUV_(const Arguments& a) {
  if (shape_.form.mesh == 0) return true;
  const uint32_t set = uvSet(a[0]);
  for (uint32_t at = shape_.projections; at; at = projections_[at].next)
    if (projections_[at].set == set)
      return check(projectUv(pool_, shape_.form, set, projections_[at].map), "projectUV");
  return check(projectUv(pool_, shape_.form, set, setupProjection(shape_.form, UvAxes::ScopeXY, 1, 1)), "projectUV");
}

bool Deriver::translateUV_(const Arguments& a) {
  return shape_.form.mesh == 0 ||
         check(translateUv(pool_, shape_.form, uvSet(a[0]), number(a[1]), number(a[2])), "translateUV");
}
bool Deriver::offsetUV_(const Arguments& a) { return translateUV_(a); }

bool Deriver::scaleUV_(const Arguments& a) {
  return shape_.form.mesh == 0 ||
         check(scaleUv(pool_, shape_.form, uvSet(a[0]), number(a[1]), number(a[2])), "scaleUV");
}

bool Deriver::rotateUV_(const Arguments& a) {
  if (shape_.form.mesh == 0) return true;
  const uint32_t set = uvSet(a[0]);
  const bool hasCentre = a.count == 4;
  if (hasCentre && !check(translateUv(pool_, shape_.form, set, -number(a[2]), -number(a[3])), "rotateUV")) return false;
  if (!check(rotateUv(pool_, shape_.form, set, number(a[1])), "rotateUV")) return false;
  return !hasCentre || check(translateUv(pool_, shape_.form, set, number(a[2]), number(a[3])), "rotateUV");
}

bool Deriver::tileUV_(const Arguments& a) {
  if (shape_.form.mesh == 0) return true;
  const vec3 e = shape_.form.scope.size;
  const float whole[2] = {e.x, e.y > 0 ? e.y : e.z};
  float size[2];
  for (uint32_t i = 0; i < 2; ++i) {
    const CgaValue& v = a[1 + i];
    size[i] = length(v, whole[i]);
    if (v.type == kCgaFloating && size[i] != 0)
      size[i] = divide(whole[i], std::max(1.0f, cgaRound(divide(whole[i], std::fabs(size[i])))));
  }
  return check(tileUv(pool_, shape_.form, uvSet(a[0]), size[0], size[1]), "tileUV");
}

bool Deriver::normalizeUV_(const Arguments& a) {
  if (shape_.form.mesh == 0) return true;
  const std::string_view which = word(a[1]);
  return check(
      normalizeUv(pool_, shape_.form, uvSet(a[0]), which != "v", which != "u", word(a[2]) == "separatePerFace"),
      "normalizeUV");
}

bool Deriver::copyUV_(const Arguments& a) {
  return shape_.form.mesh == 0 || check(copyUv(pool_, shape_.form, uvSet(a[0]), uvSet(a[1])), "copyUV");
}

bool Deriver::deleteUV_(const Arguments& a) {
  return shape_.form.mesh == 0 || boxes_.is(shape_.form) ||
         check(deleteUv(pool_, shape_.form, uvSet(a[0])), "deleteUV");
}

} // namespace gpgp::spawn::cga
