// Operations that change the geometry of the current shape.
#include "spawn/cga/deriver.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn::cga {

bool Deriver::extrude_(const Arguments& a) {
  if (shape_.form.mesh == 0) return true;
  const float distance = number(a[a.count - 1]);
  const std::string_view how = a.count > 1 ? word(a[0]) : std::string_view("face.normal");
  if (distance == 0) return true;
  Extrusion kind = Extrusion::FaceNormal;
  vec3 direction(0, 1, 0);
  if (how == "vertex.normal") kind = Extrusion::VertexNormal;
  if (how.ends_with(".flatTop")) kind = Extrusion::DirectionFlatTop;
  const auto along = [&](vec3 v) {
    kind = Extrusion::Direction;
    direction = v;
  };
  const Scope& s = shape_.form.scope;
  if (how == "world.x") along({1, 0, 0});
  if (how == "world.y" || how == "world.up" || how == "y") along({0, 1, 0});
  if (how == "world.z") along({0, 0, 1});
  if (how == "scope.x") along(s.axisX);
  if (how == "scope.y") along(s.axisY);
  if (how == "scope.z") along(s.axisZ);
  if (boxes_.is(shape_.form) && shape_.form.mesh != boxes_.box) {
    const vec3 normal = boxes_.normal(shape_.form, 0);
    const bool straight = kind == Extrusion::FaceNormal || kind == Extrusion::VertexNormal || normal == direction;
    if (straight && boxes_.extrude(shape_.form, distance)) return true;
  }
  return check(extrude(pool_, shape_.form, kind, distance, direction), "extrude");
}

bool Deriver::taper_(const Arguments& a) {
  return shape_.form.mesh == 0 || check(taper(pool_, shape_.form, number(a[0])), "taper");
}

bool Deriver::offset_(const Arguments& a) {
  if (shape_.form.mesh == 0) return true;
  noteUnlabelled(shape_.form);
  const std::string_view part = a.count > 1 ? word(a[1]) : std::string_view("all");
  if (!check(offset(pool_, shape_.form, number(a[0]),
                    part == "inside"   ? OffsetPart::Inside
                    : part == "border" ? OffsetPart::Border
                                       : OffsetPart::All),
             "offset"))
    return false;
  return true;
}

bool Deriver::innerRect_(const Arguments&) {
  if (shape_.form.mesh == 0 || (boxes_.is(shape_.form) && shape_.form.mesh != boxes_.box)) return true;
  Form inner;
  const Status status = innerRectangle(pool_, shape_.form, false, inner);
  if (status == kGeometryOk) {
    shape_.form = inner;
    resetPivot(shape_);
    return true;
  }
  return check(status, "innerRect");
}

// ---------------------------------------------------------------- roofs

bool Deriver::roofBy(const Arguments& a, RoofOptions& options, const char* what) {
  if (shape_.form.mesh == 0) return true;
  if (!options.byHeight && !(options.value > 0 && options.value < 90)) {
    warn(what, std::string(what) + ": angles lie between 0 and 90 degrees; the shape stays as it was");
    return true;
  }
  if (options.byHeight && !(options.value > 0)) return true;
  (void)a;
  return check(roof(pool_, shape_.form, options), what);
}

namespace {
/// Skips byAngle and byHeight, the words that may stand first.
struct RoofValues {
  uint32_t first = 0;
  bool byHeight = false;
};
} // namespace

bool Deriver::roofGable_(const Arguments& a) {
  RoofOptions options;
  options.kind = Roof::Gable;
  RoofValues v;
  if (a[0].type == kCgaWord) v = {1, word(a[0]) == "byHeight"};
  const auto get = [&](uint32_t i) { return v.first + i < a.count ? number(a[v.first + i]) : 0.0f; };
  options.byHeight = v.byHeight;
  options.value = get(0);
  options.overhangX = get(1);
  options.overhangY = get(2);
  options.even = get(3) != 0;
  options.index = v.first + 4 < a.count ? static_cast<int32_t>(std::clamp(get(4), -1e6f, 1e6f)) : -1;
  return roofBy(a, options, "roofGable");
}

bool Deriver::roofHip_(const Arguments& a) {
  RoofOptions options;
  options.kind = Roof::Hip;
  RoofValues v;
  if (a[0].type == kCgaWord) v = {1, word(a[0]) == "byHeight"};
  const auto get = [&](uint32_t i) { return v.first + i < a.count ? number(a[v.first + i]) : 0.0f; };
  options.byHeight = v.byHeight;
  options.value = get(0);
  options.overhangX = get(1);
  options.even = get(2) != 0;
  return roofBy(a, options, "roofHip");
}

bool Deriver::roofPyramid_(const Arguments& a) {
  RoofOptions options;
  options.kind = Roof::Pyramid;
  const uint32_t first = a[0].type == kCgaWord ? 1u : 0u;
  options.byHeight = first && word(a[0]) == "byHeight";
  options.value = first < a.count ? number(a[first]) : 0.0f;
  return roofBy(a, options, "roofPyramid");
}

bool Deriver::roofShed_(const Arguments& a) {
  RoofOptions options;
  options.kind = Roof::Shed;
  const uint32_t first = a[0].type == kCgaWord ? 1u : 0u;
  options.byHeight = first && word(a[0]) == "byHeight";
  options.value = first < a.count ? number(a[first]) : 0.0f;
  options.index = first + 1 < a.count ? static_cast<int32_t>(std::clamp(number(a[first + 1]), -1e6f, 1e6f)) : 0;
  return roofBy(a, options, "roofShed");
}

/// envelope(normal or world.up, height, front base, front angle, right ..., back ..., left ...).
bool Deriver::envelope_(const Arguments& a) {
  if (shape_.form.mesh == 0) return true;
  const uint32_t first = a[0].type == kCgaWord ? 1u : 0u;
  Envelope shape;
  shape.maxHeight = number(a[first]);
  for (uint32_t i = 0; i < 4; ++i) {
    if (first + 1 + 2 * i < a.count) shape.baseHeight[i] = number(a[first + 1 + 2 * i]);
    if (first + 2 + 2 * i < a.count) shape.angle[i] = number(a[first + 2 + 2 * i]);
  }
  return check(envelope(pool_, shape_.form, shape), "envelope");
}

// ---------------------------------------------------------------- cleaning up

bool Deriver::cleanupGeometry_(const Arguments& a) {
  if (shape_.form.mesh == 0 || boxes_.is(shape_.form)) return true;
  Cleanup what;
  const std::string_view which = word(a[0]);
  what.vertices = which != "faces";
  what.faces = which == "all" || which == "faces";
  // CGA's tolerance is in degrees; files write 0.001 to 15.
  what.degrees = a.count > 1 ? std::clamp(number(a[1]), 0.0f, 45.0f) : 1.0f;
  return check(cleanup(pool_, shape_.form, what), "cleanupGeometry");
}

bool Deriver::convexify_(const Arguments&) {
  return shape_.form.mesh == 0 || boxes_.is(shape_.form) || check(convexify(pool_, shape_.form), "convexify");
}

bool Deriver::deleteHoles_(const Arguments&) {
  return shape_.form.mesh == 0 || boxes_.is(shape_.form) || check(deleteHoles(pool_, shape_.form), "deleteHoles");
}

bool Deriver::reverseNormals_(const Arguments&) {
  return shape_.form.mesh == 0 || check(reverseNormals(pool_, shape_.form), "reverseNormals");
}

bool Deriver::rectify_(const Arguments& a) {
  return shape_.form.mesh == 0 || boxes_.is(shape_.form) || check(rectify(pool_, shape_.form, number(a[0])), "rectify");
}

bool Deriver::reduceGeometry_(const Arguments& a) {
  if (shape_.form.mesh == 0 || boxes_.is(shape_.form)) return true;
  return check(reduce(pool_, shape_.form, std::clamp(number(a[0]), 0.0f, 1.0f)), "reduceGeometry");
}

bool Deriver::resetGeometry_(const Arguments&) {
  shape_.form = start_;
  resetPivot(shape_);
  return true;
}

// ---------------------------------------------------------------- the pivot

/// The scope's axes are exchanged and turned so that all of them point into the scope from one of its corners, which
/// becomes its origin and the pivot. The geometry stays. Corners 0 to 3 go around the bottom, 4 to 7 around the top.
bool Deriver::setPivot_(const Arguments& a) {
  const std::string_view order = word(a[0]);
  if (order != "xyz" && order != "yzx" && order != "zxy") {
    warn("setPivot", "setPivot takes the orders xyz, yzx and zxy, not '" + std::string(order) + "'");
    return true;
  }
  const Scope& s = shape_.form.scope;
  const int corner = static_cast<int>(std::clamp(number(a[1]), 0.0f, 7.0f));
  const bool atEnd[3] = {corner % 4 == 1 || corner % 4 == 2, corner >= 4, corner % 4 >= 2};
  const vec3 axes[3] = {s.axisX, s.axisY, s.axisZ};
  vec3 inwards[3];
  for (int i = 0; i < 3; ++i) inwards[i] = atEnd[i] ? axes[i] * -1.0f : axes[i];
  const int first = order == "xyz" ? 0 : order == "yzx" ? 2 : 1; // the old axis that becomes x
  vec3 x = inwards[first], z = inwards[(first + 2) % 3];
  const vec3 y = inwards[(first + 1) % 3];
  if (glm::dot(glm::cross(x, y), z) < 0) std::swap(x, z);
  if (first || corner) {
    const vec3 origin = s.origin + s.axisX * (atEnd[0] ? s.size.x : 0.0f) + s.axisY * (atEnd[1] ? s.size.y : 0.0f) +
                        s.axisZ * (atEnd[2] ? s.size.z : 0.0f);
    if (shape_.form.mesh) {
      if (!check(alignScope(pool_, shape_.form, {x, y, z}), "setPivot")) return false;
    } else {
      const auto extent = [&](const vec3& axis) {
        return std::fabs(glm::dot(axis, s.axisX)) * s.size.x + std::fabs(glm::dot(axis, s.axisY)) * s.size.y +
               std::fabs(glm::dot(axis, s.axisZ)) * s.size.z;
      };
      shape_.form.scope = {origin, x, y, z, {extent(x), extent(y), extent(z)}};
    }
  }
  resetPivot(shape_);
  return true;
}

// ---------------------------------------------------------------- labels

bool Deriver::label_(const Arguments& a) {
  labels_.push_back({strings_.number(text(a[0])), makeHull(pool_, shape_.form), shape_.key, ownArea()});
  return true;
}

} // namespace gpgp::spawn::cga
