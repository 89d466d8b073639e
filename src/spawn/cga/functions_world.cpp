// Functions that ask the world around the current shape: fields, its place on the globe, attributes of the edges of the
// axiom, and where it stands among labelled shapes.
#include "spawn/cga/deriver.h"
#include "spawn/geometry/internal.h"
#include "spawn/shared/field.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

namespace gpgp::spawn::cga {

// ---------------------------------------------------------------- fields

float Deriver::fieldAt(const WorldField& field, const vec3& place) const {
  const FieldPlace at = placeInField(field.grid, place.x, place.z);
  const float* values = field.values + at.near;
  return fieldBetween(at, values[0], values[at.right], values[at.far], values[at.far + at.right]);
}

const WorldField* Deriver::fieldNamed(std::string_view name) const {
  for (const WorldField& field : options_.fields)
    if (field.name == name) return &field;
  return nullptr;
}

/// At the middle of the scope, or x and z metres from there along its axes.
CgaValue Deriver::Field_(const Arguments& a) {
  const WorldField* field = fieldNamed(text(a[0]));
  if (!field) {
    warn("field " + text(a[0]), "there is no field \"" + text(a[0]) + "\", and it is 0");
    return floatValue(0);
  }
  const Scope& s = shape_.form.scope;
  vec3 at(s.size.x * 0.5f, s.size.y * 0.5f, s.size.z * 0.5f);
  if (a.count > 2) at += vec3(number(a[1]), 0, number(a[2]));
  return floatValue(fieldAt(*field, s.origin + s.axisX * at.x + s.axisY * at.y + s.axisZ * at.z));
}

/// x is east and y north, as in map coordinates. Of the origin of the scope.
CgaValue Deriver::getGeoCoord_(const Arguments& a) {
  const std::string_view which = word(a[0]);
  const vec3& p = shape_.form.scope.origin;
  if (which == "x") return floatValue(p.x);
  if (which == "y") return floatValue(-p.z);
  if (which != "lon" && which != "lat") {
    warn("getGeoCoord", "getGeoCoord knows x, y, lon and lat; '" + std::string(which) + "' is 0");
    return floatValue(0);
  }
  if (!options_.origin) {
    warn("getGeoCoord origin", "nothing is known of where the world's origin lies; getGeoCoord of lon and lat is 0");
    return floatValue(0);
  }
  const double latitude = options_.origin->latitude - static_cast<double>(p.z) / kMetresOfADegree;
  if (which == "lat") return floatValue(static_cast<float>(latitude));
  const double metres = kMetresOfADegree * std::cos(glm::radians(options_.origin->latitude));
  return floatValue(static_cast<float>(options_.origin->longitude + static_cast<double>(p.x) / metres));
}

// ---------------------------------------------------------------- edges of the axiom

namespace {

/// Edges and shapes seen from above the axiom: places along its first axis and, to the left of that, the second one.
struct Ground {
  glm::dvec3 origin, x, y;
  glm::dvec2 at(const vec3& p) const {
    const glm::dvec3 arm = glm::dvec3(p) - origin;
    return {glm::dot(arm, x), glm::dot(arm, y)};
  }
  glm::dvec2 direction(const vec3& v) const { return {glm::dot(glm::dvec3(v), x), glm::dot(glm::dvec3(v), y)}; }
};

struct Span {
  double low = 1e300, high = -1e300;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

} // namespace

/// The edge of the axiom that a shape, seen along its direction, covers with most of itself; of several the nearest.
uint32_t Deriver::edgeBehind(const std::vector<vec3>& points, const vec3& facing) {
  const uint32_t mesh = start_.mesh;
  const glm::dvec3 up(faceNormal(pool_, start_, 0)),
      x(glm::normalize(glm::dvec3(framePosition(pool_, start_, 1)) - glm::dvec3(framePosition(pool_, start_, 0))));
  const Ground ground{glm::dvec3(framePosition(pool_, start_, 0)), x, glm::cross(up, x)};
  glm::dvec2 out = ground.direction(facing);
  const bool isLevel = glm::length(out) < 1e-3;
  if (!isLevel) out = glm::normalize(out);
  const glm::dvec2 across(-out.y, out.x);
  glm::dvec2 middle(0);
  Span own;
  for (const vec3& p : points) {
    middle += ground.at(p) / static_cast<double>(points.size());
    own.add(glm::dot(ground.at(p), across));
  }
  constexpr double kSame = 1e-3; // of the shape's width
  double best = -1, nearest = 1e300;
  uint32_t found = 0;
  works(meshCorners(pool_, mesh));
  for (uint32_t f = 0; f < meshFaces(pool_, mesh); ++f) {
    const Face face = faceOf(pool_, mesh, f);
    for (uint32_t l = 0; l < face.loops; ++l) {
      const Loop loop = loopOf(pool_, mesh, face.firstLoop + l);
      for (uint32_t c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
        const glm::dvec2 p = ground.at(framePosition(pool_, start_, c));
        const glm::dvec2 q = ground.at(framePosition(pool_, start_, nextCorner(loop, c)));
        const glm::dvec2 along = q - p;
        const double length = glm::length(along);
        if (!(length > 0)) continue;
        double covered = 0;
        if (!isLevel) {
          if (glm::dot(out, glm::dvec2(along.y, -along.x)) <= 1e-3 * length) continue; // it faces the other way
          Span edge;
          edge.add(glm::dot(p, across));
          edge.add(glm::dot(q, across));
          const double width = std::max(own.high - own.low, 1e-6);
          covered = std::clamp((std::min(own.high, edge.high) - std::max(own.low, edge.low)) / width, -1.0, 1.0);
          // A shape without width lies before an edge or does not.
          if (own.high - own.low <= 1e-6)
            covered = own.low >= edge.low - 1e-4 && own.low <= edge.high + 1e-4 ? 1.0 : -1.0;
        }
        const double t = std::clamp(glm::dot(middle - p, along) / (length * length), 0.0, 1.0);
        const double distance = glm::length(p + along * t - middle);
        if (covered < best - kSame || (covered <= best + kSame && distance >= nearest)) continue;
        best = std::max(best, covered);
        nearest = distance;
        found = c;
      }
    }
  }
  return found;
}

/// The text of an attribute at the edge that the current shape is at; none: there is no such attribute.
const std::string* Deriver::edgeText(const CgaValue& name) {
  const std::string& wanted = text(name);
  const auto found = std::find_if(axiom_->edgeAttributes.begin(), axiom_->edgeAttributes.end(),
                                  [&](const EdgeAttribute& e) { return e.name == wanted; });
  if (found == axiom_->edgeAttributes.end() || start_.mesh == 0) return nullptr;
  const Form& form = shape_.form;
  std::vector<vec3> points;
  vec3 facing(0);
  for (uint32_t f = 0; f < meshFaces(pool_, form.mesh); ++f) {
    facing += faceNormal(pool_, form, f) * faceArea(pool_, form, f);
    const Loop all = faceCorners(pool_, form.mesh, f);
    for (uint32_t c = all.firstCorner; c < all.firstCorner + all.corners; ++c)
      points.push_back(framePosition(pool_, form, c));
  }
  const Scope& s = form.scope;
  if (points.empty()) { // an edge or a vertex
    points = {s.origin, s.origin + s.axisX * s.size.x};
    facing = s.axisZ;
  }
  works(points.size());
  if (glm::length(facing) > 0) facing = glm::normalize(facing);
  const uint32_t edge = edgeBehind(points, facing);
  static const std::string kNone;
  return edge < found->values.size() ? &found->values[edge] : &kNone;
}

CgaValue Deriver::edgeAttr_getFloat_(const Arguments& a) {
  const std::string* value = edgeText(a[0]);
  return floatValue(value ? numberIn(*value).value_or(0.0f) : 0.0f);
}
CgaValue Deriver::edgeAttr_getBool_(const Arguments& a) {
  const std::string* value = edgeText(a[0]);
  return cgaBoolValue(value && *value == "true");
}
CgaValue Deriver::edgeAttr_getString_(const Arguments& a) {
  const std::string* value = edgeText(a[0]);
  return stringValue(value ? std::string_view(*value) : std::string_view());
}

/// Each edge of a face gets the tag edgeattr.NAME.VALUE, of all attributes that are strings.
bool Deriver::setTagsFromEdgeAttrs_(const Arguments&) {
  if (shape_.form.mesh == 0 || start_.mesh == 0) return true;
  if (boxes_.isShared(shape_.form)) {
    Form own = shape_.form; // a mesh of its own, which can be tagged
    if (!check(tagAll(pool_, own, false, false, 0, 0), "setTagsFromEdgeAttrs")) return false;
    shape_.form = own;
  }
  const Form whole = shape_.form;
  const Components edges(pool_, whole, Component::FaceEdges);
  for (uint32_t i = 0; i < edges.count(); ++i) {
    Form edge;
    if (!check(edges.take(i, edge), "setTagsFromEdgeAttrs")) return false;
    const Scope& s = edge.scope;
    const uint32_t at = edgeBehind({s.origin, s.origin + s.axisX * s.size.x}, s.axisZ);
    uint32_t tags = 0;
    for (const EdgeAttribute& attribute : axiom_->edgeAttributes)
      if (attribute.isString && at < attribute.values.size() && !attribute.values[at].empty())
        tags |= tagBit("edgeattr." + attribute.name + "." + attribute.values[at]);
    if (!tags) continue;
    if (!works(meshCorners(pool_, whole.mesh)) ||
        !check(tagComponent(pool_, shape_.form, Component::FaceEdges, i, tags), "setTagsFromEdgeAttrs"))
      return false;
  }
  return true;
}

// ---------------------------------------------------------------- ranks

/// How many labelled shapes come before the current one.
CgaValue Deriver::contextCompare_(const Arguments& a) {
  const ContextQuery asked = contextQuery(a, 1);
  const std::string_view by = word(a[2]);
  if (shape_.form.mesh == 0) return floatValue(0);
  // What is less comes first.
  const auto key = [&](const Bounds& b, float area) {
    return by == "world.northernmost"   ? b.low.z
           : by == "world.southernmost" ? -b.high.z
           : by == "world.easternmost"  ? -b.high.x
           : by == "world.westernmost"  ? b.low.x
           : by == "world.highest"      ? -b.high.y
           : by == "world.lowest"       ? b.low.y
           : by == "area.largest"       ? -area
                                        : area;
  };
  constexpr std::string_view kKnown[] = {"world.northernmost", "world.southernmost", "world.easternmost",
                                         "world.westernmost",  "world.highest",      "world.lowest",
                                         "area.largest",       "area.smallest"};
  if (std::find(std::begin(kKnown), std::end(kKnown), by) == std::end(kKnown)) {
    warn("contextCompare", "contextCompare ranks by world.highest and its like, area.largest and area.smallest, not '" +
                               std::string(by) + "'");
    return floatValue(0);
  }
  const float own = key(frameBounds(pool_, shape_.form), ownArea());
  const float slack = 1e-5f * std::max(1.0f, std::fabs(own));
  uint32_t before = 0;
  works(labels_.size());
  for (const Labelled& other : labels_)
    if (sees(asked, other) && key(other.hull.bounds, other.area) < own - slack) ++before;
  if (around_ && asked.isInter && !asked.label.empty())
    works(around_->visit(asked.label, axiomNumber_, ownHull().bounds, kLargest, [&](const Occluder& other) {
      before += key(other.hull.bounds, other.area) < own - slack;
      return kLargest;
    }));
  return floatValue(static_cast<float>(before));
}

float Deriver::ownArea() const {
  const Form& form = shape_.form;
  return form.mesh == 0 ? 0.0f : boxes_.is(form) ? boxes_.area(form) : area(pool_, form);
}

} // namespace gpgp::spawn::cga
