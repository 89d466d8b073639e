// Functions that ask the current shape: its geometry, scope, places in splits and components, and what is around it.
#include "spawn/cga/deriver.h"
#include "spawn/cga/rotation.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace gpgp::spawn::cga {

CgaValue Deriver::cgaFunction(uint32_t function, uint32_t first, uint32_t count) {
  static constexpr ValueFunction kFunctions[] = {
#define GPGP_CGA_ROW(name, least, most) &Deriver::name##_,
      GPGP_CGA_FUNCTIONS(GPGP_CGA_ROW)
#undef GPGP_CGA_ROW
  };
  // Those that ask the shape look at all of it.
  if (function >= static_cast<uint32_t>(Function::geometry_area_) &&
      function <= static_cast<uint32_t>(Function::contextCompare_))
    works(meshCorners(pool_, shape_.form.mesh));
  if (stopped_) return floatValue(0);
  return (this->*kFunctions[function])({&stack_[first], count});
}

// ---------------------------------------------------------------- geometry

CgaValue Deriver::geometry_area_(const Arguments& a) {
  const Form& form = shape_.form;
  if (form.mesh == 0) return floatValue(0);
  if (a.count) { // of the faces that a selector names
    const bool isBox = boxes_.is(form);
    std::optional<Components> components;
    if (!isBox) components.emplace(pool_, form, Component::Faces);
    const uint32_t faces = isBox ? boxes_.faces(form) : components->count();
    float sum = 0;
    for (uint32_t i = 0; i < faces; ++i)
      if (selects(word(a[0]), components ? &*components : nullptr, i, faces, a[0])) sum += faceArea(pool_, form, i);
    return floatValue(sum);
  }
  return floatValue(ownArea());
}

CgaValue Deriver::geometry_volume_(const Arguments&) {
  const Form& form = shape_.form;
  if (form.mesh == 0) return floatValue(0);
  return floatValue(boxes_.is(form) ? boxes_.volume(form) : volume(pool_, form));
}

/// Of the bounding box along world y, or an axis that is named.
CgaValue Deriver::geometry_height_(const Arguments& a) {
  if (shape_.form.mesh == 0) return floatValue(0);
  const Bounds bounds = frameBounds(pool_, shape_.form);
  const std::string_view which = a.count ? word(a[0]) : std::string_view("world.y");
  const int axis = which.ends_with('x') ? 0 : which.ends_with('z') ? 2 : 1;
  return floatValue(bounds.high[axis] - bounds.low[axis]);
}

CgaValue Deriver::geometry_nVertices_(const Arguments&) {
  return floatValue(static_cast<float>(vertexCount(pool_, shape_.form)));
}
CgaValue Deriver::geometry_nEdges_(const Arguments&) {
  return floatValue(static_cast<float>(edgeCount(pool_, shape_.form)));
}
CgaValue Deriver::geometry_nFaces_(const Arguments&) {
  return floatValue(static_cast<float>(faceCount(pool_, shape_.form)));
}
CgaValue Deriver::geometry_nHoles_(const Arguments&) {
  const uint32_t mesh = shape_.form.mesh;
  return floatValue(static_cast<float>(meshLoops(pool_, mesh) - meshFaces(pool_, mesh)));
}
CgaValue Deriver::geometry_isConcave_(const Arguments&) {
  return cgaBoolValue(!boxes_.is(shape_.form) && isConcave(pool_, shape_.form));
}
CgaValue Deriver::geometry_isPlanar_(const Arguments&) {
  return cgaBoolValue(boxes_.is(shape_.form) ? shape_.form.mesh != boxes_.box : isPlanar(pool_, shape_.form));
}
CgaValue Deriver::geometry_isRectangular_(const Arguments& a) {
  const Form& form = shape_.form;
  if (boxes_.is(form)) return cgaBoolValue(form.mesh != boxes_.box);
  if (a.count == 0) return cgaBoolValue(isRectangular(pool_, form));
  if (faceCount(pool_, form) != 1 || meshCorners(pool_, form.mesh) != 4 || meshLoops(pool_, form.mesh) != 1)
    return cgaBoolValue(false);
  for (uint32_t i = 0; i < 4; ++i)
    if (std::fabs(cornerAngle(pool_, form, 0, i) - 90.0f) > number(a[0])) return cgaBoolValue(false);
  return cgaBoolValue(true);
}
CgaValue Deriver::geometry_isClosedSurface_(const Arguments&) {
  return cgaBoolValue(isClosedSurface(pool_, shape_.form));
}
CgaValue Deriver::geometry_isOriented_(const Arguments&) { return cgaBoolValue(true); }
CgaValue Deriver::geometry_isInstanced_(const Arguments&) { return cgaBoolValue(false); }

CgaValue Deriver::geometry_boundaryLength_(const Arguments&) {
  const Components edges(pool_, shape_.form, Component::Edges);
  float sum = 0;
  for (uint32_t i = 0; i < edges.count(); ++i) {
    if (!edges.matches(i, Selector::Border, {})) continue;
    Form edge;
    if (edges.take(i, edge) == kGeometryOk) sum += edge.scope.size.x;
  }
  return floatValue(sum);
}

/// maxSlope, minSlope: between faces and the ground; azimuth: of the first face's normal.
CgaValue Deriver::geometry_angle_(const Arguments& a) {
  const std::string_view which = word(a[0]);
  const Form& form = shape_.form;
  const uint32_t faces = faceCount(pool_, form);
  float least = 180, most = 0;
  for (uint32_t i = 0; i < faces; ++i) {
    const vec3 n = faceNormal(pool_, form, i);
    const float slope = cgaMath(kCgaAcosMath, std::clamp(n.y, -1.0f, 1.0f), 0);
    least = std::min(least, slope);
    most = std::max(most, slope);
    if (which == "azimuth") return floatValue(cgaAtan2(n.x, n.z));
  }
  if (!faces) return floatValue(0);
  return floatValue(which == "minSlope" ? least : most);
}

// Extents of texture coordinates: in their own units, or in metres on the shape.
CgaValue Deriver::geometry_uMin_(const Arguments& a) {
  vec2 low(0), high(0);
  uvBounds(pool_, shape_.form, a.count ? uvSet(a[0]) : 0, low, high);
  return floatValue(low.x);
}
CgaValue Deriver::geometry_uMax_(const Arguments& a) {
  vec2 low(0), high(0);
  uvBounds(pool_, shape_.form, a.count ? uvSet(a[0]) : 0, low, high);
  return floatValue(high.x);
}
CgaValue Deriver::geometry_vMin_(const Arguments& a) {
  vec2 low(0), high(0);
  uvBounds(pool_, shape_.form, a.count ? uvSet(a[0]) : 0, low, high);
  return floatValue(low.y);
}
CgaValue Deriver::geometry_vMax_(const Arguments& a) {
  vec2 low(0), high(0);
  uvBounds(pool_, shape_.form, a.count ? uvSet(a[0]) : 0, low, high);
  return floatValue(high.y);
}

CgaValue Deriver::geometry_du_(const Arguments& a) {
  const uint32_t set = uvSet(a[0]);
  vec2 low(0), high(0);
  uvBounds(pool_, shape_.form, set, low, high);
  if (a.count > 1 && word(a[1]) == "uvSpace") return floatValue(high.x - low.x);
  const vec3 e = shape_.form.scope.size;
  return floatValue(e.x);
}
CgaValue Deriver::geometry_dv_(const Arguments& a) {
  const uint32_t set = uvSet(a[0]);
  vec2 low(0), high(0);
  uvBounds(pool_, shape_.form, set, low, high);
  if (a.count > 1 && word(a[1]) == "uvSpace") return floatValue(high.y - low.y);
  const vec3 e = shape_.form.scope.size;
  return floatValue(e.y > e.z ? e.y : e.z);
}

CgaValue Deriver::geometry_hasUVs_(const Arguments& a) {
  const uint32_t set = a.count ? uvSet(a[0]) : 0;
  return cgaBoolValue(((meshUvSets(pool_, shape_.form.mesh) >> set) & 1u) != 0);
}
// ---------------------------------------------------------------- scope, pivot, places

vec3 Deriver::euler(const vec3& x, const vec3& y, const vec3& z) const {
  // Of Rx Ry Rz, whose columns these are.
  const float sy = std::clamp(z.x, -1.0f, 1.0f);
  const float ry = cgaMath(kCgaAsinMath, sy, 0);
  if (std::fabs(sy) > 0.99999f) return {cgaAtan2(x.y, y.y), ry, 0};
  return {cgaAtan2(-z.y, z.z), ry, cgaAtan2(-y.x, x.x)};
}

#define GPGP_CGA_GETTER(name, value)                                                                                   \
  CgaValue Deriver::name##_(const Arguments&) { return floatValue(value); }
namespace {
vec3 pivotZ(const Shape& s) { return glm::cross(s.pivotX, s.pivotY); }
vec3 inPivot(const Shape& s, const vec3& v) {
  return {glm::dot(v, s.pivotX), glm::dot(v, s.pivotY), glm::dot(v, pivotZ(s))};
}
} // namespace
GPGP_CGA_GETTER(scope_tx, inPivot(shape_, shape_.form.scope.origin - shape_.pivot).x)
GPGP_CGA_GETTER(scope_ty, inPivot(shape_, shape_.form.scope.origin - shape_.pivot).y)
GPGP_CGA_GETTER(scope_tz, inPivot(shape_, shape_.form.scope.origin - shape_.pivot).z)
#define GPGP_CGA_SCOPE_EULER                                                                                           \
  euler(inPivot(shape_, shape_.form.scope.axisX), inPivot(shape_, shape_.form.scope.axisY),                            \
        inPivot(shape_, shape_.form.scope.axisZ))
GPGP_CGA_GETTER(scope_rx, (GPGP_CGA_SCOPE_EULER).x)
GPGP_CGA_GETTER(scope_ry, (GPGP_CGA_SCOPE_EULER).y)
GPGP_CGA_GETTER(scope_rz, (GPGP_CGA_SCOPE_EULER).z)
#undef GPGP_CGA_SCOPE_EULER
GPGP_CGA_GETTER(scope_sx, shape_.form.scope.size.x)
GPGP_CGA_GETTER(scope_sy, shape_.form.scope.size.y)
GPGP_CGA_GETTER(scope_sz, shape_.form.scope.size.z)
GPGP_CGA_GETTER(scope_elevation, shape_.form.scope.origin.y)
GPGP_CGA_GETTER(pivot_px, shape_.pivot.x)
GPGP_CGA_GETTER(pivot_py, shape_.pivot.y)
GPGP_CGA_GETTER(pivot_pz, shape_.pivot.z)
GPGP_CGA_GETTER(pivot_ox, euler(shape_.pivotX, shape_.pivotY, pivotZ(shape_)).x)
GPGP_CGA_GETTER(pivot_oy, euler(shape_.pivotX, shape_.pivotY, pivotZ(shape_)).y)
GPGP_CGA_GETTER(pivot_oz, euler(shape_.pivotX, shape_.pivotY, pivotZ(shape_)).z)
GPGP_CGA_GETTER(split_index, static_cast<float>(shape_.splitIndex))
GPGP_CGA_GETTER(split_total, static_cast<float>(shape_.splitTotal))
GPGP_CGA_GETTER(comp_index, static_cast<float>(shape_.compIndex))
GPGP_CGA_GETTER(comp_total, static_cast<float>(shape_.compTotal))
GPGP_CGA_GETTER(initialShape_origin_px, start_.scope.origin.x)
GPGP_CGA_GETTER(initialShape_origin_py, start_.scope.origin.y)
GPGP_CGA_GETTER(initialShape_origin_pz, start_.scope.origin.z)
GPGP_CGA_GETTER(initialShape_origin_ox, euler(start_.scope.axisX, start_.scope.axisY, start_.scope.axisZ).x)
GPGP_CGA_GETTER(initialShape_origin_oy, euler(start_.scope.axisX, start_.scope.axisY, start_.scope.axisZ).y)
GPGP_CGA_GETTER(initialShape_origin_oz, euler(start_.scope.axisX, start_.scope.axisY, start_.scope.axisZ).z)
GPGP_CGA_GETTER(material_color_r, shape_.color.x)
GPGP_CGA_GETTER(material_color_g, shape_.color.y)
GPGP_CGA_GETTER(material_color_b, shape_.color.z)
GPGP_CGA_GETTER(material_opacity, shape_.color.w)
GPGP_CGA_GETTER(seedian, static_cast<float>(shape_.key.x >> 8))
#undef GPGP_CGA_GETTER

CgaValue Deriver::comp_sel_(const Arguments&) { return cgaMake(kCgaString, shape_.compSelector); }
CgaValue Deriver::initialShape_name_(const Arguments&) { return stringValue(axiom_->name); }
CgaValue Deriver::initialShape_startRule_(const Arguments&) { return stringValue(program_.rules[program_.start].name); }
CgaValue Deriver::material_colormap_(const Arguments&) { return cgaMake(kCgaString, shape_.texture); }
CgaValue Deriver::trim_horizontal_(const Arguments&) { return cgaBoolValue(shape_.trimsHorizontal); }
CgaValue Deriver::trim_vertical_(const Arguments&) { return cgaBoolValue(shape_.trimsVertical); }
CgaValue Deriver::material_color_rgb_(const Arguments& a) { return material_rgb_(a); }
CgaValue Deriver::material_rgb_(const Arguments&) {
  char text[16];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", static_cast<int>(shape_.color.x * 255.0f + 0.5f),
                static_cast<int>(shape_.color.y * 255.0f + 0.5f), static_cast<int>(shape_.color.z * 255.0f + 0.5f));
  return stringValue(text);
}
CgaValue Deriver::getTreeKey_(const Arguments&) {
  return stringValue(std::to_string(shape_.key.x) + "." + std::to_string(shape_.key.y));
}

/// A place, or an orientation by three angles, in another system: one of its numbers, or all in an array.
CgaValue Deriver::convert_(const Arguments& a) {
  const bool isArray = a.count == 4;
  const std::string_view which = isArray ? std::string_view() : word(a[0]);
  const uint32_t systems = isArray ? 0 : 1;
  const std::string_view from = word(a[systems]), to = word(a[systems + 1]);
  vec3 p(0);
  if (isArray) {
    const std::vector<CgaValue> values = arrayOf(a[3]).values;
    for (uint32_t i = 0; i < 3 && i < values.size(); ++i) p[static_cast<int>(i)] = number(values[i]);
  } else {
    const uint32_t first = a.count == 7 ? 4 : a.count - 3;
    p = {number(a[first]), number(a[first + 1]), number(a[first + 2])};
  }
  const Axes x = axes(from), y = axes(to);
  const auto world = [&](const vec3& v) { return x.x * v.x + x.y * v.y + x.z * v.z; };
  const auto local = [&](const vec3& v) { return vec3(glm::dot(v, y.x), glm::dot(v, y.y), glm::dot(v, y.z)); };
  vec3 result;
  if (word(a[isArray ? 2 : a.count == 7 ? 3 : 0]) == "orient") {
    const Rotation r(p);
    result = euler(local(world(r.x)), local(world(r.y)), local(world(r.z)));
  } else {
    const auto originOf = [&](std::string_view system) {
      return system == "world"    ? vec3(0)
             : system == "object" ? start_.scope.origin
             : system == "pivot"  ? shape_.pivot
                                  : shape_.form.scope.origin;
    };
    result = local(originOf(from) + world(p) - originOf(to));
  }
  if (!isArray) return floatValue(which == "y" ? result.y : which == "z" ? result.z : result.x);
  return array({{floatValue(result.x), floatValue(result.y), floatValue(result.z)}, ArrayValue::kOneRow});
}

// ---------------------------------------------------------------- what is around

const Hull& Deriver::ownHull() {
  if (!hasHull_) hull_ = makeHull(pool_, shape_.form);
  hasHull_ = true;
  return hull_;
}

namespace {
bool mayMeet(const Bounds& a, const Bounds& b, float slack) {
  for (int axis = 0; axis < 3; ++axis)
    if (a.low[axis] > b.high[axis] + slack || b.low[axis] > a.high[axis] + slack) return false;
  return true;
}
} // namespace

Deriver::ContextQuery Deriver::contextQuery(const Arguments& a, uint32_t labelAt) {
  ContextQuery query;
  uint32_t label = labelAt;
  if (a.count && labelAt) {
    const std::string_view target = word(a[0]);
    query.isIntra = target != "inter";
    query.isInter = target != "intra";
    if (target != "intra" && target != "inter" && target != "all") {
      if (a.count == 1 && a[0].type == kCgaString)
        label = 0; // of a query that has nothing but a label
      else
        warn("context target", "context queries look at intra, inter or all, not at '" + std::string(target) + "'");
    }
  }
  if (label < a.count) query.label = text(a[label]);
  return query;
}

/// Of shapes of this axiom that were there when this generation of shapes began or came earlier in it.
bool Deriver::sees(const ContextQuery& query, const Labelled& other) const {
  return query.isIntra && other.key != shape_.key && (query.label.empty() || strings_.text(other.label) == query.label);
}

bool Deriver::comparesWith(const Hull& other) {
  const Hull& own = ownHull();
  return works(own.sizes.size() * other.points.size() + own.points.size() * other.sizes.size());
}

/// A closed shape that queries without a label see.
void Deriver::noteUnlabelled(const Form& form) {
  if (!unlabelled_ || form.mesh == 0 || !works(meshCorners(pool_, form.mesh)) || !isClosedSurface(pool_, form)) return;
  unlabelled_->push_back({{}, makeHull(pool_, form), 0.0f});
}

CgaValue Deriver::context(const Arguments& a, bool (*query)(const Hull&, const Hull&)) {
  if (shape_.form.mesh == 0) return cgaBoolValue(false);
  const ContextQuery asked = contextQuery(a, 1);
  if (asked.label.empty() && asked.isIntra)
    warn("context", "of their own axiom, context queries without a label see the shapes that label() named alone");
  constexpr float kReach = 1e-3f;
  works(labels_.size());
  for (const Labelled& other : labels_) {
    if (!sees(asked, other) || !mayMeet(other.hull.bounds, ownHull().bounds, kReach)) continue;
    if (!comparesWith(other.hull)) break;
    if (query(ownHull(), other.hull)) return cgaBoolValue(true);
  }
  if (!around_ || !asked.isInter) return cgaBoolValue(false);
  bool isFound = false;
  works(around_->visit(asked.label, axiomNumber_, ownHull().bounds, kReach, [&](const Occluder& other) {
    isFound = comparesWith(other.hull) && query(ownHull(), other.hull);
    return isFound || stopped_ ? -1.0f : kReach;
  }));
  return cgaBoolValue(isFound);
}

CgaValue Deriver::inside_(const Arguments& a) { return context(a, &spawn::inside); }
CgaValue Deriver::overlaps_(const Arguments& a) { return context(a, &spawn::overlaps); }
CgaValue Deriver::touches_(const Arguments& a) { return context(a, &spawn::touches); }

CgaValue Deriver::minimumDistance_(const Arguments& a) {
  const ContextQuery asked = contextQuery(a, a.count - 1);
  float least = kLargest;
  for (const Labelled& other : labels_)
    if (sees(asked, other)) {
      if (!comparesWith(other.hull)) break;
      least = std::min(least, minimumDistance(ownHull(), other.hull));
    }
  if (!around_ || !asked.isInter || asked.label.empty()) return floatValue(least);
  works(around_->visit(asked.label, axiomNumber_, ownHull().bounds, least, [&](const Occluder& other) {
    if (!comparesWith(other.hull)) return -1.0f;
    least = std::min(least, minimumDistance(ownHull(), other.hull));
    return least > 0 ? least : -1.0f;
  }));
  return floatValue(least);
}

CgaValue Deriver::contextCount_(const Arguments& a) {
  const ContextQuery asked = contextQuery(a, 1);
  uint32_t count = 0;
  if (asked.isIntra)
    for (const Labelled& other : labels_) count += strings_.text(other.label) == asked.label;
  if (around_ && asked.isInter && !asked.label.empty()) count += around_->count(asked.label, axiomNumber_);
  return floatValue(static_cast<float>(count));
}

} // namespace gpgp::spawn::cga
