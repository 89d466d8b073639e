// Names on faces and edges: tag(), deleteTags(), isTagged(), and the streets that an axiom's edges are at.
//
// Each name that a derivation of an axiom uses has a bit of the words of faces and corners; there are twelve.
#include "spawn/cga/deriver.h"

#include <cmath>

namespace gpgp::spawn::cga {

namespace {

constexpr uint32_t kMostNames = 12; // bits between kTagUser and kTagStreetFront
constexpr uint32_t kNames = kTagStreetFront - kTagUser;

struct OwnTag {
  std::string_view name;
  uint32_t bit;
};
/// What operations say of the parts that they make.
constexpr OwnTag kOwnTags[] = {{"roof.top", kTagRoofTop},
                               {"roof.side", kTagRoofSide},
                               {"roof.bottom", kTagRoofBottom},
                               {"extrude.top", kTagExtrudeTop},
                               {"extrude.side", kTagExtrudeSide},
                               {"extrude.bottom", kTagExtrudeBottom},
                               {"split.cut", kTagCut},
                               {"setback.front", kTagSetback},
                               {"roof.eave", kTagEave},
                               {"roof.ridge", kTagRidge},
                               {"roof.hip", kTagHip},
                               {"roof.valley", kTagValley},
                               {"bool.A", kTagBooleanA},
                               {"bool.B", kTagBooleanB}};

/// Whether a query, names between points of which ? is any one and * any row, begins a name.
bool answers(std::string_view query, std::string_view name) {
  if (query.empty()) return true;
  if (name.empty()) return false;
  const size_t queryEnd = std::min(query.find('.'), query.size()), nameEnd = std::min(name.find('.'), name.size());
  const std::string_view first = query.substr(0, queryEnd);
  const auto behind = [](std::string_view text, size_t end) {
    return end < text.size() ? text.substr(end + 1) : std::string_view();
  };
  const std::string_view restOfQuery = behind(query, queryEnd), restOfName = behind(name, nameEnd);
  if (first == "*") return answers(restOfQuery, restOfName) || answers(query, restOfName);
  return (first == "?" || first == name.substr(0, nameEnd)) && answers(restOfQuery, restOfName);
}

} // namespace

uint32_t Deriver::tagBits(std::string_view query) const {
  uint32_t bits = 0;
  for (const OwnTag& tag : kOwnTags)
    if (answers(query, tag.name)) bits |= tag.bit;
  for (uint32_t i = 0; i < tagNames_.size(); ++i)
    if (answers(query, strings_.text(tagNames_[i]))) bits |= kTagUser << i;
  return bits;
}

/// a: a name or query, and which components.
bool Deriver::tagNames(const Arguments& a, uint32_t set, uint32_t clear) {
  if (shape_.form.mesh == 0) return true;
  const std::string_view which = a.count > 1 ? word(a[1]) : std::string_view();
  if (which == "vertices") {
    warn("tags of vertices", "vertices have no tags; faces and edges have");
    return true;
  }
  const bool all = clear != 0 && (which.empty() || which == "all");
  return check(tagAll(pool_, shape_.form, which != "edges", which == "edges" || all, set, clear),
               set ? "tag" : "deleteTags");
}

uint32_t Deriver::tagBit(const std::string& name) {
  const uint32_t number = strings_.number(name);
  size_t bit = 0;
  while (bit < tagNames_.size() && tagNames_[bit] != number) ++bit;
  if (bit == tagNames_.size()) {
    if (bit == kMostNames) {
      warn("tags", "'" + name + "' is left out: the shapes of an axiom have at most " + std::to_string(kMostNames) +
                       " tags of different names");
      return 0;
    }
    tagNames_.push_back(number);
  }
  return kTagUser << bit;
}

bool Deriver::tag_(const Arguments& a) {
  const std::string name = text(a[0]);
  const uint32_t bit = tagBit(name);
  return bit == 0 || tagNames(a, bit, 0);
}

bool Deriver::deleteTags_(const Arguments& a) {
  const uint32_t bits = a.count && !text(a[0]).empty() ? tagBits(text(a[0])) : ~0u;
  return bits == 0 || tagNames(a, 0, bits & ~(kNames << 4 << 12));
}

bool Deriver::hasTags(const Arguments& a) {
  const std::string_view which = a.count > 1 ? word(a[1]) : std::string_view();
  const uint32_t bits = a.count ? tagBits(text(a[0])) : tagBits({});
  return (tagsOf(pool_, shape_.form, which != "edges" && which != "e", which != "faces" && which != "f") & bits) != 0;
}

CgaValue Deriver::isTagged_(const Arguments& a) {
  if (a[a.count - 1].type != kCgaBool) return cgaBoolValue(hasTags(a)); // else the compiler asks for a selector
  const bool ofEdges = a.count > 2 && word(a[1]) == "e";
  return cgaMake(kCgaWord, strings_.number((ofEdges ? "tag:e" : "tag:f") + text(a[0])));
}
CgaValue Deriver::geometry_isTagged_(const Arguments& a) { return cgaBoolValue(hasTags(a)); }
CgaValue Deriver::geometry_hasTags_(const Arguments& a) { return cgaBoolValue(hasTags(a)); }

CgaValue Deriver::geometry_tags_(const Arguments& a) {
  const std::string_view which = a.count > 1 ? word(a[1]) : std::string_view();
  const uint32_t query = a.count ? tagBits(text(a[0])) : tagBits({});
  const uint32_t found =
      query & tagsOf(pool_, shape_.form, which != "edges" && which != "e", which != "faces" && which != "f");
  ArrayValue names;
  for (uint32_t i = 0; i < tagNames_.size(); ++i)
    if (found & (kTagUser << i)) names.values.push_back(cgaMake(kCgaString, tagNames_[i]));
  for (const OwnTag& tag : kOwnTags)
    if (found & tag.bit) names.values.push_back(stringValue(tag.name));
  return array(std::move(names));
}

/// Edges beside streets are the front; of the others those that face away from it are the back, and the rest lie to its
/// left or right, seen from the street.
void Deriver::tagStreets(const Axiom& axiom) {
  if (boxes_.isShared(shape_.form)) {
    Form own = shape_.form; // a mesh of its own, which can be tagged
    if (tagAll(pool_, own, false, false, 0, 0) == kGeometryOk) shape_.form = own;
  }
  Form& form = shape_.form;
  if (faceCount(pool_, form) != 1) return;
  const Components edges(pool_, form, Component::FaceEdges);
  const auto normalOf = [&](uint32_t i) {
    Form edge;
    if (edges.take(i, edge) != kGeometryOk) return vec3(0);
    return glm::cross(edge.scope.axisX, faceNormal(pool_, form, 0)); // out of the face
  };
  vec3 front(0);
  for (uint32_t i = 0; i < edges.count() && i < axiom.streetWidths.size(); ++i)
    if (axiom.streetWidths[i] > 0) front += normalOf(i);
  if (glm::length(front) < 1e-6f) front = normalOf(0);
  front = glm::normalize(front);
  const vec3 right = glm::cross(faceNormal(pool_, form, 0), front);
  for (uint32_t i = 0; i < edges.count(); ++i) {
    const vec3 n = normalOf(i);
    const float ahead = glm::dot(n, front);
    const bool isFront = i < axiom.streetWidths.size() && axiom.streetWidths[i] > 0;
    const uint32_t tag = isFront                  ? kTagStreetFront
                         : ahead < -0.7072f       ? kTagStreetBack
                         : glm::dot(n, right) > 0 ? kTagStreetRight
                                                  : kTagStreetLeft;
    if (tagComponent(pool_, form, Component::FaceEdges, i, tag) != kGeometryOk) return;
  }
}

} // namespace gpgp::spawn::cga
