// Operations that change the current shape: where it is, how large, what colour; and primitives, assets, reports.
#include "spawn/cga/deriver.h"
#include "spawn/cga/rotation.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn::cga {

namespace {

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

} // namespace

bool parseColor(std::string_view text, glm::vec4& color, bool& hasOpacity) {
  if (text.starts_with('#')) text.remove_prefix(1);
  if (text.size() != 6 && text.size() != 8) return false;
  glm::vec4 value(1);
  for (size_t i = 0; i < text.size() / 2; ++i) {
    const int high = hexDigit(text[2 * i]), low = hexDigit(text[2 * i + 1]);
    if (high < 0 || low < 0) return false;
    value[static_cast<int>(i)] = static_cast<float>(16 * high + low) / 255.0f;
  }
  hasOpacity = text.size() == 8;
  color = value;
  return true;
}

// ---------------------------------------------------------------- what operations share

float Deriver::length(const CgaValue& v, float whole) const {
  const float x = number(v);
  return v.type == kCgaRelative ? multiply(x, whole) : x;
}

vec3 Deriver::lengths(const Arguments& a, const vec3& whole) const {
  return {length(a[0], whole.x), length(a[1], whole.y), length(a[2], whole.z)};
}

std::string_view Deriver::word(const CgaValue& v) const {
  return v.type == kCgaWord || v.type == kCgaString ? std::string_view(strings_.text(v.bits)) : std::string_view();
}

const std::string& Deriver::text(const CgaValue& v) {
  switch (v.type) {
  case kCgaString:
  case kCgaWord: return strings_.text(v.bits);
  case kCgaBool: scratch_ = v.bits ? "true" : "false"; return scratch_;
  case kCgaArray: {
    const ArrayValue& all = arrayOf(v);
    std::string result = "[";
    for (size_t i = 0; i < all.values.size() && i < 1000; ++i) {
      if (i) result += i % std::max(1u, all.columns()) ? "," : ";";
      result += text(all.values[i]);
    }
    scratch_ = result + "]";
    return scratch_;
  }
  case kCgaNothing: scratch_ = "NaN"; return scratch_;
  default: scratch_ = textOf(number(v)); return scratch_;
  }
}

bool Deriver::check(Status status, const char* what) {
  if (status == kGeometryOk) return true;
  if (status == kGeometryEmpty) {
    shape_.form.mesh = 0;
    return true;
  }
  if (!works()) return false;
  if (status == kGeometryNoRoom ||
      (status == kGeometryTooLarge && pool_.workNeeded > pool_.workCapacity && poolWords_ < (1u << 26))) {
    noRoom_ = true; // again, with more
    return false;
  }
  warn(std::string(what) + describeStatus(status).data(),
       std::string(what) + ": " + std::string(describeStatus(status)) + "; shapes stay as they were");
  return true;
}

/// Of the same handedness; extents may differ.
void Deriver::setScope(const Scope& scope) {
  const vec3 before = shape_.form.scope.size;
  const bool isBox = boxes_.is(shape_.form);
  for (int axis = 0; axis < 3; ++axis)
    if (before[axis] != scope.size[axis] && before[axis] > 0)
      shape_.form.scale[axis] = multiply(shape_.form.scale[axis], divide(scope.size[axis], before[axis]));
  if (isBox) shape_.form.scale = scope.size;
  shape_.form.scope = scope;
}

void Deriver::resetPivot(Shape& shape) const {
  shape.pivot = shape.form.scope.origin;
  shape.pivotX = shape.form.scope.axisX;
  shape.pivotY = shape.form.scope.axisY;
}

Axes Deriver::axes(std::string_view system) const {
  if (system.starts_with("world")) return {};
  if (system.starts_with("object")) return {start_.scope.axisX, start_.scope.axisY, start_.scope.axisZ};
  if (system.starts_with("pivot")) return {shape_.pivotX, shape_.pivotY, glm::cross(shape_.pivotX, shape_.pivotY)};
  return axesOf(shape_.form.scope);
}

bool Deriver::cgaOperation(uint32_t operation, uint32_t first, uint32_t count) {
  static constexpr OperationFunction kFunctions[] = {
#define GPGP_CGA_none(name) &Deriver::name##_,
#define GPGP_CGA_parts(name) nullptr,
#define GPGP_CGA_body(name) nullptr,
#define GPGP_CGA_ROW(name, least, most, block) GPGP_CGA_##block(name)
      GPGP_CGA_OPERATIONS(GPGP_CGA_ROW)
#undef GPGP_CGA_ROW
#undef GPGP_CGA_none
#undef GPGP_CGA_parts
#undef GPGP_CGA_body
  };
  const Arguments arguments{&stack_[first], count};
  if (stopped_) return false;
  hasHull_ = false;
  if (operation >= static_cast<uint32_t>(Operation::path_fork))
    return path(static_cast<Operation>(operation), arguments);
  if (operation >= std::size(kFunctions)) {
    settleDraws(); // before seedian sets the key
    return setAttributeOfShape(static_cast<Operation>(operation), arguments[0]);
  }
  operation_ = operationInfo(static_cast<Operation>(operation)).name;
  const uint32_t mesh = shape_.form.mesh;
  const bool goesOn =
      (this->*kFunctions[operation])(arguments) && (shape_.form.mesh == mesh || (isWithin(shape_.form) && works()));
  settleDraws();
  return goesOn;
}

bool Deriver::cgaBlock(uint32_t operation, uint32_t first, uint32_t count, uint32_t table, uint32_t base) {
  static constexpr BlockFunction kFunctions[] = {
#define GPGP_CGA_none(name) nullptr,
#define GPGP_CGA_parts(name) &Deriver::name##_,
#define GPGP_CGA_body(name) &Deriver::name##_,
#define GPGP_CGA_ROW(name, least, most, block) GPGP_CGA_##block(name)
      GPGP_CGA_OPERATIONS(GPGP_CGA_ROW)
#undef GPGP_CGA_ROW
#undef GPGP_CGA_none
#undef GPGP_CGA_parts
#undef GPGP_CGA_body
  };
  if (stopped_) return false;
  const bool goesOn = operation >= static_cast<uint32_t>(Operation::inline_) &&
                      operation <= static_cast<uint32_t>(Operation::componentValues_);
  made_ = made_ || !goesOn; // though it may make nothing
  operation_ = operationInfo(static_cast<Operation>(operation)).name;
  const bool isDone = (this->*kFunctions[operation])({&stack_[first], count}, table, base);
  if (operation != static_cast<uint32_t>(Operation::componentValues_)) settleDraws(); // which is within a value
  return isDone;
}

// ---------------------------------------------------------------- transformations

bool Deriver::t_(const Arguments& a) {
  Scope& s = shape_.form.scope;
  s.origin += turned(lengths(a, s.size), s.axisX, s.axisY, s.axisZ);
  return true;
}

bool Deriver::s_(const Arguments& a) {
  Scope scope = shape_.form.scope;
  const vec3 size = lengths(a, scope.size);
  for (int axis = 0; axis < 3; ++axis) {
    if (size[axis] < 0) { // to the other side, as the geometry is then mirrored
      const vec3 direction = axis == 0 ? scope.axisX : axis == 1 ? scope.axisY : scope.axisZ;
      scope.origin += direction * size[axis];
    }
    scope.size[axis] = std::fabs(size[axis]);
  }
  setScope(scope);
  return true;
}

bool Deriver::rotateScopeBy(const vec3& degrees, const vec3& fixed) {
  const Rotation r(degrees);
  Scope& s = shape_.form.scope;
  const vec3 x = s.axisX, y = s.axisY, z = s.axisZ;
  const auto rotated = [&](const vec3& v) { // v in scope axes
    const vec3 w = turned(v, r.x, r.y, r.z);
    return turned(w, x, y, z);
  };
  const vec3 arm = s.origin - fixed;
  const vec3 local(glm::dot(arm, x), glm::dot(arm, y), glm::dot(arm, z));
  s.origin = fixed + rotated(local);
  s.axisX = glm::normalize(rotated({1, 0, 0}));
  s.axisY = rotated({0, 1, 0});
  s.axisY = glm::normalize(s.axisY - s.axisX * glm::dot(s.axisX, s.axisY));
  s.axisZ = glm::cross(s.axisX, s.axisY);
  return true;
}

bool Deriver::r_(const Arguments& a) {
  const Scope& s = shape_.form.scope;
  if (a.count == 3) return rotateScopeBy({number(a[0]), number(a[1]), number(a[2])}, s.origin);
  const vec3 middle = s.origin + turned(s.size * 0.5f, s.axisX, s.axisY, s.axisZ);
  return rotateScopeBy({number(a[1]), number(a[2]), number(a[3])}, word(a[0]) == "scopeCenter" ? middle : s.origin);
}

bool Deriver::translate_(const Arguments& a) {
  Scope& s = shape_.form.scope;
  const Axes axis = axes(word(a[1]));
  const vec3 by(length(a[2], s.size.x), length(a[3], s.size.y), length(a[4], s.size.z));
  const vec3 move = turned(by, axis.x, axis.y, axis.z);
  if (word(a[0]) != "abs") {
    s.origin += move;
  } else {
    const std::string_view system = word(a[1]);
    s.origin = (system == "world" ? vec3(0) : system == "object" ? start_.scope.origin : shape_.pivot) + move;
  }
  return true;
}

bool Deriver::rotate_(const Arguments& a) {
  Scope& s = shape_.form.scope;
  const Axes axis = axes(word(a[1]));
  const Rotation r({number(a[2]), number(a[3]), number(a[4])});
  const vec3 fixed = shape_.pivot;
  const auto rotated = [&](const vec3& v) { // v in the frame
    const vec3 local(glm::dot(v, axis.x), glm::dot(v, axis.y), glm::dot(v, axis.z));
    return turned(turned(local, r.x, r.y, r.z), axis.x, axis.y, axis.z);
  };
  const vec3 x = s.axisX, y = s.axisY, arm = s.origin - fixed;
  const bool absolute = word(a[0]) == "abs";
  const vec3 fromX = absolute ? axis.x : x, fromY = absolute ? axis.y : y;
  s.axisX = glm::normalize(rotated(fromX));
  s.axisY = rotated(fromY);
  s.axisY = glm::normalize(s.axisY - s.axisX * glm::dot(s.axisX, s.axisY));
  s.axisZ = glm::cross(s.axisX, s.axisY);
  if (absolute) { // the scope's corner stays where it was as seen from the pivot, in the new axes
    const vec3 local(glm::dot(arm, x), glm::dot(arm, y), glm::dot(arm, glm::cross(x, y)));
    s.origin = fixed + turned(local, s.axisX, s.axisY, s.axisZ);
  } else {
    s.origin = fixed + rotated(arm);
  }
  return true;
}

bool Deriver::center_(const Arguments& a) {
  uint32_t bits = 0;
  for (const char c : word(a[0])) bits |= c == 'x' ? AxisX : c == 'y' ? AxisY : c == 'z' ? AxisZ : 0u;
  Scope& s = shape_.form.scope;
  const vec3 target =
      ruleScope_.origin + turned(ruleScope_.size * 0.5f, ruleScope_.axisX, ruleScope_.axisY, ruleScope_.axisZ);
  const vec3 now = s.origin + turned(s.size * 0.5f, s.axisX, s.axisY, s.axisZ);
  const vec3 move = target - now;
  if (bits & AxisX) s.origin += s.axisX * glm::dot(s.axisX, move);
  if (bits & AxisY) s.origin += s.axisY * glm::dot(s.axisY, move);
  if (bits & AxisZ) s.origin += s.axisZ * glm::dot(s.axisZ, move);
  return true;
}

bool Deriver::rotateScope_(const Arguments& a) {
  // The geometry stays: what is aligned is the scope alone.
  Scope s = shape_.form.scope;
  const Rotation r({number(a[0]), number(a[1]), number(a[2])});
  Axes to{turned(r.x, s.axisX, s.axisY, s.axisZ), turned(r.y, s.axisX, s.axisY, s.axisZ),
          turned(r.z, s.axisX, s.axisY, s.axisZ)};
  if (!shape_.form.mesh) {
    rotateScopeBy({number(a[0]), number(a[1]), number(a[2])}, s.origin);
    return true;
  }
  return check(alignScope(pool_, shape_.form, to), "rotateScope");
}

bool Deriver::mirror_(const Arguments& a) {
  const uint32_t bits =
      (cgaIsTrue(a[0]) ? AxisX : 0u) | (cgaIsTrue(a[1]) ? AxisY : 0u) | (cgaIsTrue(a[2]) ? AxisZ : 0u);
  return boxes_.is(shape_.form) || check(mirror(pool_, shape_.form, bits), "mirror");
}

/// The geometry stays where it is. Scopes are right-handed, so that two axes turn round together.
bool Deriver::mirrorScope_(const Arguments& a) {
  const bool x = cgaIsTrue(a[0]), y = cgaIsTrue(a[1]), z = cgaIsTrue(a[2]);
  if (!x && !y && !z) return true;
  if (x + y + z != 2) {
    warn("mirrorScope", "mirrorScope of one axis or three makes a left-handed scope, which is not supported; the scope "
                        "stays as it was");
    return true;
  }
  const Scope& s = shape_.form.scope;
  const auto back = [](const vec3& axis, bool turns) { return turns ? axis * -1.0f : axis; };
  const Axes to{back(s.axisX, x), back(s.axisY, y), back(s.axisZ, z)};
  return shape_.form.mesh == 0 || check(alignScope(pool_, shape_.form, to), "mirrorScope");
}

bool Deriver::alignScopeToAxes_(const Arguments& a) {
  const std::string_view which = a.count ? word(a[0]) : std::string_view();
  const uint32_t axis = which.ends_with('x') ? 0u : which.ends_with('y') ? 1u : which.ends_with('z') ? 2u : 3u;
  if (boxes_.is(shape_.form) && shape_.form.mesh != boxes_.upright) {
    const Scope& s = shape_.form.scope;
    const bool aligned = s.axisY.y == 1.0f;
    if ((axis == 1 && aligned) || (aligned && s.axisX.x == 1.0f)) return true;
  }
  if (!check(alignScopeToAxes(pool_, shape_.form, Axes{}, axis), "alignScopeToAxes")) return false;
  resetPivot(shape_);
  return true;
}

bool Deriver::alignScopeToGeometry_(const Arguments& a) {
  const bool zUp = word(a[0]) == "zUp";
  const auto pick = [&](const CgaValue& v, int32_t& index) {
    index = 0;
    const std::string_view w = word(v);
    if (w == "world.lowest") return Pick::WorldLowest;
    if (w == "largest") return Pick::Largest;
    if (w == "longest" || w == "auto") return Pick::Longest;
    if (w == "any") return Pick::Any;
    index = static_cast<int32_t>(std::clamp(number(v), -1e6f, 1e6f));
    return Pick::Index;
  };
  int32_t faceIndex = 0, edgeIndex = 0;
  // Two values: the edge's only.
  Pick face = a.count == 3 ? pick(a[1], faceIndex) : Pick::Index;
  const Pick edge = pick(a[a.count - 1], edgeIndex);
  if (a.count == 2 && edge != Pick::Index) face = Pick::Any;
  if (face == Pick::Any && edge == Pick::Index) face = Pick::Index;
  if (!check(alignScopeToGeometry(pool_, shape_.form, zUp, face, faceIndex, edge, edgeIndex), "alignScopeToGeometry"))
    return false;
  resetPivot(shape_);
  return true;
}

bool Deriver::alignScopeToGeometryBBox_(const Arguments& a) {
  const std::string_view which = a.count ? word(a[0]) : std::string_view();
  const uint32_t axis = which.ends_with('x') ? 0u : which.ends_with('z') ? 2u : 1u;
  if (!check(alignScopeToGeometryBox(pool_, shape_.form, axis), "alignScopeToGeometryBBox")) return false;
  resetPivot(shape_);
  return true;
}

// ---------------------------------------------------------------- appearance

bool Deriver::color_(const Arguments& a) {
  glm::vec4& c = shape_.color;
  if (a[0].type == kCgaString) {
    bool hasOpacity = false;
    glm::vec4 value;
    if (!parseColor(text(a[0]), value, hasOpacity)) {
      warn("color", "\"" + text(a[0]) + "\" is not a colour; expected \"#rrggbb\" or \"#rrggbbaa\"");
      return true;
    }
    c = hasOpacity ? value : glm::vec4(glm::vec3(value), c.w);
    if (a.count == 2) c.w = std::clamp(number(a[1]), 0.0f, 1.0f);
    return true;
  }
  if (a.count < 3) {
    warn("color", "color takes a string, or three or four numbers");
    return true;
  }
  for (uint32_t i = 0; i < a.count; ++i) c[static_cast<int>(i)] = std::clamp(number(a[i]), 0.0f, 1.0f);
  return true;
}

bool Deriver::texture_(const Arguments& a) {
  shape_.texture = strings_.number(text(a[0]));
  return true;
}

bool Deriver::setAttributeOfShape(Operation operation, const CgaValue& v) {
  Scope scope = shape_.form.scope;
  const vec3 pz = glm::cross(shape_.pivotX, shape_.pivotY);
  const auto move = [&](const vec3& axis) {
    scope.origin += axis * (number(v) - glm::dot(axis, scope.origin - shape_.pivot));
    shape_.form.scope = scope;
  };
  const auto turn = [&](int which) {
    vec3 angles =
        euler({glm::dot(scope.axisX, shape_.pivotX), glm::dot(scope.axisX, shape_.pivotY), glm::dot(scope.axisX, pz)},
              {glm::dot(scope.axisY, shape_.pivotX), glm::dot(scope.axisY, shape_.pivotY), glm::dot(scope.axisY, pz)},
              {glm::dot(scope.axisZ, shape_.pivotX), glm::dot(scope.axisZ, shape_.pivotY), glm::dot(scope.axisZ, pz)});
    angles[which] = number(v);
    const Rotation r(angles);
    scope.axisX = turned(r.x, shape_.pivotX, shape_.pivotY, pz);
    scope.axisY = turned(r.y, shape_.pivotX, shape_.pivotY, pz);
    scope.axisZ = glm::cross(scope.axisX, scope.axisY);
    shape_.form.scope = scope;
  };
  const auto resize = [&](int which) {
    scope.size[which] = std::fabs(length(v, scope.size[which]));
    setScope(scope);
  };
  switch (operation) {
  case Operation::set_scope_tx: move(shape_.pivotX); break;
  case Operation::set_scope_ty: move(shape_.pivotY); break;
  case Operation::set_scope_tz: move(pz); break;
  case Operation::set_scope_rx: turn(0); break;
  case Operation::set_scope_ry: turn(1); break;
  case Operation::set_scope_rz: turn(2); break;
  case Operation::set_scope_sx: resize(0); break;
  case Operation::set_scope_sy: resize(1); break;
  case Operation::set_scope_sz: resize(2); break;
  case Operation::set_trim_horizontal: shape_.trimsHorizontal = cgaIsTrue(v); break;
  case Operation::set_trim_vertical: shape_.trimsVertical = cgaIsTrue(v); break;
  case Operation::set_material_color_r: shape_.color.x = std::clamp(number(v), 0.0f, 1.0f); break;
  case Operation::set_material_color_g: shape_.color.y = std::clamp(number(v), 0.0f, 1.0f); break;
  case Operation::set_material_color_b: shape_.color.z = std::clamp(number(v), 0.0f, 1.0f); break;
  case Operation::set_material_opacity: shape_.color.w = std::clamp(number(v), 0.0f, 1.0f); break;
  case Operation::set_material_colormap: shape_.texture = strings_.number(text(v)); break;
  case Operation::set_material_rgb:
  case Operation::set_material_color_rgb: {
    const CgaValue color = v;
    return color_({&color, 1});
  }
  case Operation::set_seedian: {
    const uint32_t seed = static_cast<uint32_t>(static_cast<int64_t>(std::clamp(number(v), -2e9f, 2e9f)));
    shape_.key = uvec2(mixBits(seed), mixBits(seed ^ 0x9e3779b9u));
    shape_.draws = 0;
    break;
  }
  default: break;
  }
  return true;
}

// ---------------------------------------------------------------- reports

bool Deriver::report_(const Arguments& a) {
  Report& report = reports_[strings_.number(text(a[0]))];
  // Of what is no number, how often it was said counts.
  const bool isNumber = a[1].type == kCgaFloat || a[1].type == kCgaBool;
  const double value = isNumber ? static_cast<double>(number(a[1])) : 0.0;
  report.least = report.count ? std::min(report.least, value) : value;
  report.most = report.count ? std::max(report.most, value) : value;
  report.sum += value;
  ++report.count;
  return true;
}

bool Deriver::print_(const Arguments& a) {
  ++printCount_;
  if (prints_.size() < Derivation::kMostPrints) prints_.push_back(strings_.number(text(a[0])));
  return true;
}

// ---------------------------------------------------------------- primitives and assets

bool Deriver::primitive(Primitive kind, uint32_t sides, uint32_t rings, const vec3& size) {
  Scope& s = shape_.form.scope;
  const bool isFlat = kind == Primitive::Quad || kind == Primitive::Disk;
  for (int axis = 0; axis < 3; ++axis) {
    if (size[axis] > 0) s.size[axis] = size[axis];
    if (isFlat && axis == 1)
      s.size.y = 0;
    else if (!(s.size[axis] > 0))
      s.size[axis] = 1;
  }
  if (kind == Primitive::Cube || kind == Primitive::Quad) {
    shape_.form = boxes_.make(s, kind == Primitive::Cube ? boxes_.box : boxes_.flat);
    return applyTrims();
  }
  return check(insertPrimitive(pool_, shape_.form, kind, sides, rings), "primitive") && applyTrims();
}

bool Deriver::primitiveQuad_(const Arguments& a) {
  const vec3 e = shape_.form.scope.size;
  return primitive(Primitive::Quad, 4, 2,
                   {a.count > 0 ? length(a[0], e.x) : 0, 0, a.count > 1 ? length(a[1], e.z) : 0});
}

bool Deriver::primitiveCube_(const Arguments& a) {
  const vec3 e = shape_.form.scope.size;
  return primitive(
      Primitive::Cube, 4, 1,
      {a.count > 0 ? length(a[0], e.x) : 0, a.count > 1 ? length(a[1], e.y) : 0, a.count > 2 ? length(a[2], e.z) : 0});
}

namespace {
uint32_t sidesOf(float value, uint32_t otherwise) {
  return value >= 1.0f ? static_cast<uint32_t>(std::clamp(value, 3.0f, 256.0f)) : otherwise;
}
} // namespace

bool Deriver::primitiveDisk_(const Arguments& a) {
  const float width = a.count > 1 ? 2 * length(a[1], shape_.form.scope.size.x) : 0;
  return primitive(Primitive::Disk, sidesOf(a.count ? number(a[0]) : 0, 32), 2, {width, 0, width});
}

bool Deriver::primitiveCylinder_(const Arguments& a) {
  const float width = a.count > 1 ? 2 * length(a[1], shape_.form.scope.size.x) : 0;
  return primitive(Primitive::Cylinder, sidesOf(a.count ? number(a[0]) : 0, 32), 2,
                   {width, a.count > 2 ? length(a[2], shape_.form.scope.size.y) : 0, width});
}

bool Deriver::primitiveCone_(const Arguments& a) {
  const float width = a.count > 1 ? 2 * length(a[1], shape_.form.scope.size.x) : 0;
  return primitive(Primitive::Cone, sidesOf(a.count ? number(a[0]) : 0, 32), 2,
                   {width, a.count > 2 ? length(a[2], shape_.form.scope.size.y) : 0, width});
}

bool Deriver::primitiveSphere_(const Arguments& a) {
  const float width = a.count > 2 ? 2 * length(a[2], shape_.form.scope.size.x) : 0;
  return primitive(Primitive::Sphere, sidesOf(a.count ? number(a[0]) : 0, 16),
                   sidesOf(a.count > 1 ? number(a[1]) : 0, 16), {width, width, width});
}

bool Deriver::i_(const Arguments& a) {
  const std::string path = text(a[0]);
  if (path.starts_with("builtin:")) {
    const std::string name = path.substr(8);
    if (name.starts_with("cube")) return primitive(Primitive::Cube, 4, 2, vec3(0));
    if (name.starts_with("quad")) return primitive(Primitive::Quad, 4, 2, vec3(0));
    if (name.starts_with("disk")) return primitive(Primitive::Disk, 32, 2, vec3(0));
    if (name.starts_with("sphere")) return primitive(Primitive::Sphere, 16, 16, vec3(0));
    if (name.starts_with("cone")) return primitive(Primitive::Cone, 32, 2, vec3(0));
    if (name.starts_with("cyl")) return primitive(Primitive::Cylinder, 32, 2, vec3(0));
  }
  std::string why;
  Form* asset = assetForm(path, why);
  if (asset) return check(insertForm(pool_, shape_.form, *asset), "i") && applyTrims();
  if (noRoom_ || stopped_) return false;
  warn("asset " + path, "the asset \"" + path + "\" is drawn as a box: " + why);
  return primitive(Primitive::Cube, 4, 2, vec3(0));
}

bool Deriver::insertAlongUV_(const Arguments& a) {
  if (shape_.form.mesh == 0) return true;
  const std::string path = text(a[1]);
  std::string why;
  Form cube;
  const Form* asset = nullptr;
  if (path.starts_with("builtin:cube")) {
    cube = boxes_.make({vec3(0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(1)}, boxes_.box);
    asset = &cube;
  } else {
    asset = assetForm(path, why);
  }
  if (!asset) {
    if (noRoom_ || stopped_) return false;
    warn("asset " + path, "the asset \"" + path + "\" is not inserted: " + why);
    return true;
  }
  const uint32_t set = uvSet(a[0]);
  if (((meshUvSets(pool_, shape_.form.mesh) >> set) & 1u) == 0) {
    warn("insertAlongUV", "insertAlongUV: the shape has no texture coordinates of set " + std::to_string(set));
    return true;
  }
  const BendAlong along = a.count > 3 && word(a[3]) == "vertex.normal" ? BendAlong::VertexNormal : BendAlong::ScopeY;
  const bool keep = a.count > 4 && word(a[4]) == "keepPosition";
  return check(insertAlongUv(pool_, shape_.form, set, *asset, number(a[2]), along, keep), "insertAlongUV");
}

} // namespace gpgp::spawn::cga
