// Components of the current shape that are worked with where they are: values of them, changes of them, and the planes
// that cut off what is inserted into them.
#include "spawn/cga/deriver.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace gpgp::spawn::cga {

namespace {
Component componentKind(std::string_view name) {
  constexpr std::pair<std::string_view, Component> kNames[] = {{"e", Component::Edges},
                                                               {"fe", Component::FaceEdges},
                                                               {"v", Component::Vertices},
                                                               {"g", Component::Groups},
                                                               {"h", Component::Holes}};
  for (const auto& [known, kind] : kNames)
    if (known == name) return kind;
  return Component::Faces;
}
} // namespace

std::vector<std::vector<uint32_t>> Deriver::selectedBy(const Components* components, uint32_t count, const Arguments& a,
                                                       uint32_t table) {
  std::vector<std::vector<uint32_t>> selected(words_[table]);
  for (uint32_t i = 0; i < count; ++i)
    for (uint32_t p = 0; p < words_[table]; ++p) {
      const uint32_t record = words_[table + 1 + p];
      const CgaValue& value = a.values[words_[record + kCgaPartSelector]];
      if (!selects(word(value), components, i, count, value)) continue;
      selected[p].push_back(i);
      break;
    }
  return selected;
}

bool Deriver::valueOn(uint32_t chunk, uint32_t base, uint32_t top, const Form& form, uint32_t index, uint32_t total,
                      CgaValue& value) {
  const uint32_t count = words_[chunk + kCgaChunkParameters];
  if (!works(count + 1)) return false;
  if (top + count >= kStackSize) {
    fail("values of rule '" + program_.strings[words_[chunk_]] + "' need more than " + std::to_string(kStackSize) +
         " places");
    return false;
  }
  const Shape whole = shape_;
  const bool drawn = drawn_;
  // Functions may call this: their frames are kept.
  const std::vector<uint32_t> frames = frames_;
  shape_.form = form;
  shape_.compIndex = index;
  shape_.compTotal = total;
  shape_.key = childKey(whole.key, 0x30000000u + index);
  shape_.draws = 0;
  resetPivot(shape_);
  hasHull_ = false;
  for (uint32_t v = 0; v < count; ++v) stack_[top + v] = stack_[base + v];
  const uint32_t how = cgaRun(chunk, top);
  shape_ = whole;
  drawn_ = drawn;
  frames_ = frames;
  hasHull_ = false;
  value = stack_[top];
  if (how == kCgaDone) return true;
  if (!stopped_ && !noRoom_)
    fail("a value of a component needs too many steps, or functions that call each other too deep");
  return false;
}

/// comp(f) { selector: value | ... } as an array, a value for each component; those that none selects have a 0.
bool Deriver::componentValues_(const Arguments& a, uint32_t table, uint32_t base) {
  ArrayValue result;
  componentValue_ = floatValue(0);
  const Component kind = componentKind(word(a[0]));
  if (nested_ == kMostNested) {
    fail("comp as a value is nested more than " + std::to_string(kMostNested) + " deep");
    return false;
  }
  if (shape_.form.mesh) {
    const Components components(pool_, shape_.form, kind);
    const uint32_t count = components.count(), top = topOf(a);
    const std::vector<std::vector<uint32_t>> selected = selectedBy(&components, count, a, table);
    result.values.assign(count, cgaMake(kCgaNothing, 0));
    uint32_t type = kCgaFloat;
    ++nested_;
    bool goesOn = true;
    for (uint32_t p = 0; p < words_[table] && goesOn; ++p) {
      const uint32_t record = words_[table + 1 + p];
      const bool together = words_[record + kCgaPartKind] != kCgaPartEach;
      for (uint32_t i = 0; i < selected[p].size() && goesOn; i += together ? count : 1) {
        Form form;
        const Status status = together ? toComponents(pool_, shape_.form, kind, selected[p], form)
                                       : components.take(selected[p][i], form);
        if (status != kGeometryOk && status != kGeometryEmpty) {
          goesOn = check(status, "comp");
          continue;
        }
        CgaValue value;
        const uint32_t total = together ? 1u : static_cast<uint32_t>(selected[p].size());
        goesOn = valueOn(words_[record + kCgaPartBody], base, top, form, i, total, value);
        type = value.type;
        for (const uint32_t to : together ? selected[p] : std::vector<uint32_t>{selected[p][i]})
          result.values[to] = value;
      }
    }
    --nested_;
    for (CgaValue& v : result.values)
      if (v.type == kCgaNothing) v = cgaMake(type == kCgaBool || type == kCgaString ? type : kCgaFloat, 0);
    if (!goesOn) return false;
  }
  componentValue_ = array(std::move(result));
  return !stopped_;
}
CgaValue Deriver::componentResult_(const Arguments&) { return componentValue_; }

/// Faces that a part selects become what its operations make of them; the others stay as they are.
bool Deriver::modify_(const Arguments& a, uint32_t table, uint32_t base) {
  if (shape_.form.mesh == 0) return true;
  if (word(a[0]) != "f") {
    warn("modify", "modify takes faces, f, alone; the shape stays as it was");
    return true;
  }
  const Components components(pool_, shape_.form, Component::Faces);
  const std::vector<std::vector<uint32_t>> selected = selectedBy(&components, components.count(), a, table);
  std::vector<bool> stays(components.count(), true);
  std::vector<Shape> leaves;
  const Shape whole = shape_;
  for (uint32_t p = 0; p < words_[table]; ++p)
    for (uint32_t i = 0; i < selected[p].size(); ++i) {
      stays[selected[p][i]] = false;
      Form face;
      if (!check(components.take(selected[p][i], face), "modify")) return false;
      shape_ = whole;
      shape_.form = face;
      shape_.compIndex = i;
      shape_.compTotal = static_cast<uint32_t>(selected[p].size());
      shape_.key = childKey(whole.key, 0x28000000u + selected[p][i]);
      resetPivot(shape_);
      std::vector<Shape> made;
      const bool goesOn = deriveNow(words_[words_[table + 1 + p] + kCgaPartBody], base, topOf(a), made);
      shape_ = whole;
      if (!goesOn) return false;
      leaves.insert(leaves.end(), made.begin(), made.end());
    }
  std::vector<uint32_t> rest;
  for (uint32_t i = 0; i < stays.size(); ++i)
    if (stays[i]) rest.push_back(i);
  if (rest.size() == stays.size()) return true;
  if (!rest.empty()) {
    Shape others = whole;
    if (!check(toComponents(pool_, whole.form, Component::Faces, rest, others.form), "modify")) return false;
    leaves.insert(leaves.begin(), others);
  }
  return gather(leaves, false, "modify");
}

// ---------------------------------------------------------------- planes that trim

/// Of a face that fills its scope, as rectangles do, nothing inserted sticks out: it needs none.
void Deriver::setTrims(Shape& part, const std::vector<TrimPlane>& planes) {
  part.trims = 0;
  if (isRectangular(pool_, part.form)) return;
  for (const TrimPlane& plane : planes) {
    constexpr float kSineOf40 = 0.64278764f;
    trims_.push_back({part.trims, plane, std::abs(glm::dot(plane.along, part.form.scope.axisY)) < kSineOf40});
    part.trims = static_cast<uint32_t>(trims_.size() - 1);
  }
}

bool Deriver::applyTrims() {
  for (uint32_t at = shape_.trims; at && shape_.form.mesh; at = trims_[at].next) {
    const TrimPlane plane = trims_[at].plane;
    if (!(trims_[at].isHorizontal ? shape_.trimsHorizontal : shape_.trimsVertical)) continue;
    const Scope& s = shape_.form.scope;
    const float slack = 1e-5f * std::max({s.size.x, s.size.y, s.size.z, 1e-3f});
    bool isCut = false;
    for (int corner = 0; corner < 8; ++corner) {
      const vec3 p = s.origin + s.axisX * (corner & 1 ? s.size.x : 0.0f) + s.axisY * (corner & 2 ? s.size.y : 0.0f) +
                     s.axisZ * (corner & 4 ? s.size.z : 0.0f);
      isCut = isCut || glm::dot(plane.normal, p) < plane.offset - slack;
    }
    if (!isCut) continue;
    const bool isClosed = boxes_.is(shape_.form) ? shape_.form.mesh == boxes_.box : isClosedSurface(pool_, shape_.form);
    const Status status = spawn::trim(pool_, shape_.form, plane.normal, plane.offset, isClosed);
    if (!check(status, "trim")) return false;
  }
  return true;
}

bool Deriver::trim_(const Arguments&) { return applyTrims(); }

// ---------------------------------------------------------------- normals and shadows

bool Deriver::setNormals_(const Arguments& a) {
  const std::string_view mode = word(a[0]);
  if (mode == "hard" || mode == "conform") shape_.softAngle = 0;
  if (mode == "soft") shape_.softAngle = 180;
  if (mode == "auto") shape_.softAngle = 30;
  if (mode != "conform" || shape_.form.mesh == 0 || boxes_.is(shape_.form)) return true;
  return check(conformNormals(pool_, shape_.form), "setNormals");
}

bool Deriver::softenNormals_(const Arguments& a) {
  shape_.softAngle = std::clamp(number(a[0]), 0.0f, 180.0f);
  return true;
}

bool Deriver::footprint_(const Arguments&) {
  if (shape_.form.mesh == 0) return true;
  if (boxes_.is(shape_.form) && shape_.form.mesh != boxes_.upright) {
    Scope scope = shape_.form.scope;
    scope.size.y = 0;
    shape_.form = boxes_.make(scope, boxes_.flat);
    return true;
  }
  const Status status = spawn::footprint(pool_, shape_.form);
  if (status == kGeometryNotPlanar || status == kGeometryBadArgument) {
    warn("footprint", "footprint: the projected faces do not unite; the shape stays as it was");
    return true;
  }
  return check(status, "footprint");
}

bool Deriver::roofRidge_(const Arguments& a) {
  if (shape_.form.mesh == 0) return true;
  const bool byHeight = a.count > 1 && word(a[0]) == "byHeight";
  const float value = number(a[a.count - 1]);
  if (!(value > 0) || (!byHeight && value >= 90)) {
    warn("roofRidge", "roofRidge: angles lie between 0 and 90 degrees, and heights above 0; the shape stays as it was");
    return true;
  }
  const Status status = ridgeRoof(pool_, shape_.form, byHeight, value);
  if (status == kGeometryBadArgument) {
    warn("roofRidge",
         "roofRidge of a face whose outline touches itself or a hole is not supported; the shape stays as it "
         "was");
    return true;
  }
  return check(status, "roofRidge");
}

} // namespace gpgp::spawn::cga
