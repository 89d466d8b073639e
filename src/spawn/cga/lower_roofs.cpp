// Roofs of rectangles to operators of a graph, and comp(f) of them. Faces are counted as src/spawn/geometry/roofs.cpp
// makes them: the bottom, then the sides in the order of the rectangle's edges; of shed roofs what slopes comes first.
#include "spawn/cga/lower.h"
#include "spawn/shared/roofs.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn::cga {

namespace {
using namespace shader;

constexpr uint32_t kBottom = 4;
constexpr const char* kOfRoof = "which was worked out from a size that the shape no longer has";

/// The frame's axis that a side faces: axis + 1, negative: the other way.
constexpr int8_t kOutwards[4] = {3, 1, -3, -1};
/// The axis along which it runs.
constexpr int8_t kAlong[4] = {1, -3, -1, 3};

enum class Kind { slope, wall, bottom };
Kind kindOf(uint32_t form, uint32_t side) {
  if (side == kBottom) return Kind::bottom;
  if (form == kRoofGableAlongX || form == kRoofGableAlongZ)
    return (side & 1) == form - kRoofGableAlongX ? Kind::slope : Kind::wall;
  return form < kRoofShed || side == form - kRoofShed ? Kind::slope : Kind::wall;
}
/// Whether a face is a rectangle; others are trapezoids or triangles.
bool isRectangle(uint32_t form, uint32_t side) {
  if (side == kBottom) return true;
  if (form >= kRoofShed) return (side & 1) == (form & 1);
  return form != kRoofHip && form != kRoofPyramid && kindOf(form, side) == Kind::slope;
}
/// In order.
std::vector<uint32_t> facesOfForm(uint32_t form) {
  if (form < kRoofShed) return {kBottom, 0, 1, 2, 3};
  std::vector<uint32_t> faces{kBottom, form - kRoofShed};
  for (uint32_t side = 0; side < 4; ++side)
    if (side != form - kRoofShed) faces.push_back(side);
  return faces;
}

/// Between which of the angles that selectors tell apart a slope is (Components::matches()).
constexpr float kAngles[] = {11.25f, 44.999f, 78.749f};
uint32_t classOf(float degrees) {
  return static_cast<uint32_t>(
      std::count_if(std::begin(kAngles), std::end(kAngles), [&](float a) { return degrees >= a; }));
}
bool isOneOf(const std::string& word, std::initializer_list<const char*> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}
} // namespace

Lowering::Text Lowering::roof(const Statement& s, Operation operation, const Scope& scope, State state,
                              const Continue& goOn) {
  const auto& a = s.arguments;
  const std::string how = word(*a.at(0));
  const bool byHeight = operation == Operation::taper_ || how == "byHeight";
  const size_t first = how == "byHeight" || how == "byAngle" ? 1 : 0;
  const uint32_t up = state.form == Form::flat ? 1 : 2, across = 3 - up; // of the rectangle's axes
  const auto given = [&](size_t i) { return first + i < a.size(); };
  const auto known = [&](size_t i, const char* what) {
    const FormulaPtr f = argumentNumber(*a[first + i], scope, state);
    if (!f->isNumber()) misfit(std::string(what) + " of a roof that is not known", a[first + i]->place);
    return f->value;
  };
  const auto overhang = [&](size_t i) {
    if (!given(i)) return number(0);
    const FormulaPtr f = argumentNumber(*a[first + i], scope, state);
    if (f->draws || f->sizes || f->isOfPlace || f->low < 0)
      misfit("an overhang that is random, depends on the shape or may be negative", a[first + i]->place);
    return f;
  };
  if (!given(0)) misfit("'" + s.name + "' without a value", s.place);
  if (state.form != Form::flat && (state.form != Form::upright || operation == Operation::taper_))
    misfit("'" + s.name + "' of anything but a rectangle" +
               (operation == Operation::taper_ ? " in the ground plane" : ""),
           s.place);
  if (state.extents[up] != Extent::zero) misfit("'" + s.name + "' of a rectangle whose scope has a height", s.place);
  if (state.axes[up] != 2) misfit("'" + s.name + "' of a rectangle that may not be level", s.place);
  if (state.extents[0] != Extent::positive || state.extents[across] != Extent::positive)
    misfit("'" + s.name + "' of a rectangle that may have no extent along an axis", s.place);
  const FormulaPtr value = argumentNumber(*a[first], scope, state);
  if (!(value->low > 0) || (!byHeight && !(value->high < 90)))
    misfit(byHeight ? "a roof whose height may be 0 or less" : "a roof whose angle may not be between 0 and 90 degrees",
           a[first]->place);
  Roof roof;
  roof.place = s.place;
  roof.overhang = roof.overhangAtGables = number(0);
  if (!byHeight) roof.steepest = value->high, roof.flattest = value->low;
  std::vector<uint32_t> forms;
  switch (operation) {
  case Operation::roofGable_: {
    roof.overhang = overhang(1);
    roof.overhangAtGables = overhang(2);
    const float index = given(4) ? known(4, "an edge") : -1;
    if (index >= 0)
      forms = {std::fmod(std::floor(index), 2.0f) == 0 ? kRoofGableAlongX : kRoofGableAlongZ};
    else
      forms = {kRoofGableAlongX, kRoofGableAlongZ}; // the shorter edges get the gables
    break;
  }
  case Operation::roofHip_:
    roof.overhang = overhang(1);
    forms = {kRoofHip};
    break;
  case Operation::roofShed_:
    forms = {kRoofShed + static_cast<uint32_t>(std::fmod(std::max(given(1) ? known(1, "an edge") : 0.0f, 0.0f), 4.0f))};
    break;
  default:
    if (!byHeight) roof.flattest = 0; // the further edges have flatter slopes
    forms = {kRoofPyramid};
  }
  const auto isNothing = [](const FormulaPtr& f) { return f->isNumber() && f->value == 0; };
  roof.overhangs = !isNothing(roof.overhang) || !isNothing(roof.overhangAtGables);
  result_.needsUpright = true;
  if (up == 2) state.axes = {state.axes[0], state.axes[2], static_cast<int8_t>(-state.axes[1])};
  for (uint32_t axis = 1; axis < 3; ++axis)
    if (axis == up || up == 2) changeSize(state, axis, kOfRoof);
  if (up == 2) state.moved = {nullptr, nullptr, nullptr};
  state.moved[1] = nullptr;
  state.extents = {Extent::positive, Extent::positive, Extent::positive};
  state.form = Form::roof;
  state.isMesh = true;
  const bool isSlope = !byHeight && value->isNumber();
  const std::string measure = std::to_string(byHeight ? kRoofByHeight : isSlope ? kRoofBySlope : kRoofByAngle);
  const std::string steepness = isSlope ? cga::text(slopeOfDegrees(value->value)) : cga::text(value);
  std::vector<Text> ways;
  for (const uint32_t form : forms) {
    roof.form = form;
    state.roof = roof;
    ways.push_back(wrapped("RaiseRoof(" + std::to_string(form) + "," + measure + "," + steepness + ")", goOn(state)));
  }
  if (ways.size() == 1) return std::move(ways[0]);
  // Nearly square ones as square ones, whose front has a gable.
  const FormulaPtr isLong =
      fits(combined(kCodeGreater, sizeOf(0), combined(kCodeMultiply, sizeOf(across), number(1.00001f))), s.place);
  return condition(isLong, std::move(ways[0]), std::move(ways[1]));
}

/// As Components::matches(), where the roof's slope says enough.
bool Lowering::selectsOfRoof(const cga::Part& part, const Scope& scope, const State& state, uint32_t side,
                             uint32_t index) {
  const Expression& e = *part.selector;
  const std::string name = word(e);
  if (name.empty() || !isSelector(name)) return selects(part, scope, state, 0, index, 5);
  const size_t dot = name.find('.');
  const std::string system = dot == std::string::npos ? "scope" : name.substr(0, dot);
  const std::string last = dot == std::string::npos ? name : name.substr(dot + 1);
  if (last == "all") return true;
  const Roof& roof = *state.roof;
  if (last == "border" || last == "inside") {
    if (roof.overhangs) misfit("the selector '" + name + "' of a roof with overhangs", e.place);
    return last == "inside";
  }
  if (isOneOf(last, {"eave", "hip", "valley", "ridge"})) return false; // of edges, which faces are not
  const Kind kind = kindOf(roof.form, side);
  if (kind == Kind::bottom) return isOneOf(last, {"bottom", "down", "horizontal"});
  const auto holds = [&](uint32_t angles) { // of the four ranges
    const bool isLevel = angles >= 2;
    if (last == "top" || last == "up") return !isLevel;
    if (last == "side") return angles >= 1;
    if (last == "vertical") return angles == 3;
    if (last == "horizontal") return angles == 0;
    if (last == "aslant") return angles == 1 || angles == 2;
    if (isOneOf(last, {"bottom", "down", "nutant"})) return false;
    if (!isLevel) return false;
    int8_t normal = kOutwards[side];
    if (system == "object") {
      const int8_t axis = state.axes[static_cast<size_t>(std::abs(normal)) - 1];
      normal = normal < 0 ? static_cast<int8_t>(-axis) : axis;
    }
    if (normal == 0 || (system != "scope" && system != "object")) misfit("the selector '" + name + "'", e.place);
    constexpr std::pair<const char*, int8_t> kSides[] = {{"front", 3}, {"south", 3}, {"back", -3}, {"north", -3},
                                                         {"left", -1}, {"west", -1}, {"right", 1}, {"east", 1}};
    for (const auto& [text, direction] : kSides)
      if (last == text) return normal == direction;
    misfit("the selector '" + name + "'", e.place);
  };
  if (kind == Kind::wall) return holds(3);
  const uint32_t from = classOf(roof.flattest), to = classOf(roof.steepest);
  for (uint32_t i = from; i < to; ++i)
    if (holds(i) != holds(i + 1)) misfit("the selector '" + name + "' of a roof that may be steep or not", e.place);
  return holds(from);
}

Lowering::State Lowering::roofFaceOf(const State& state, uint32_t side) const {
  State child = state;
  child.made = false;
  child.roof.reset();
  child.form = isRectangle(state.roof->form, side) ? Form::upright : Form::trapezoid;
  child.extents = {Extent::positive, Extent::positive, Extent::zero};
  const auto turned = [&](int8_t axis) {
    const int8_t own = state.axes[static_cast<size_t>(std::abs(axis)) - 1];
    return axis < 0 ? static_cast<int8_t>(-own) : own;
  };
  switch (kindOf(state.roof->form, side)) {
  case Kind::bottom: child.axes = {turned(1), turned(3), turned(-2)}; break;
  case Kind::wall: child.axes = {turned(kAlong[side]), turned(2), turned(kOutwards[side])}; break;
  case Kind::slope: child.axes = {turned(kAlong[side]), 0, 0}; break;
  }
  for (uint32_t axis = 0; axis < 3; ++axis) changeSize(child, axis, kOfRoof);
  child.moved = {number(0), number(0), number(0)};
  return child;
}

Lowering::Text Lowering::roofFaces(const Statement& s, const Scope& scope, const State& state) {
  const Roof& roof = *state.roof;
  const std::vector<uint32_t> faces = facesOfForm(roof.form);
  std::vector<const cga::Part*> owner(faces.size());
  for (uint32_t i = 0; i < faces.size(); ++i)
    for (const cga::Part& part : s.parts)
      if (!owner[i] && selectsOfRoof(part, scope, state, faces[i], i)) owner[i] = &part;
  std::vector<Text> ways;
  for (const cga::Part& part : s.parts)
    for (uint32_t i = 0; i < faces.size(); ++i) {
      if (owner[i] != &part) continue;
      Scope inner = scope;
      ways.push_back(wrapped("ToRoofFace(" + std::to_string(faces[i]) + "," + cga::text(roof.overhang) + "," +
                                 cga::text(roof.overhangAtGables) + ")",
                             limited(bodyOf(part.body, inner, roofFaceOf(state, faces[i])))));
    }
  return joined("Replicate()", std::move(ways));
}

// ---------------------------------------------------------------- setbacks

/// Of rectangles: what remains, and of edges beside which none moves what was cut off. Mitred pieces have to be NIL.
Lowering::Text Lowering::setback(const Statement& s, const Scope& scope, const State& state) {
  if (state.form != Form::flat && state.form != Form::upright)
    misfit("'" + s.name + "' of anything but a rectangle", s.place);
  const uint32_t up = state.form == Form::flat ? 1 : 2, across = 3 - up; // of the rectangle's axes
  if (state.extents[up] != Extent::zero) misfit("'" + s.name + "' of a rectangle whose scope has a height", s.place);
  if (state.extents[0] != Extent::positive || state.extents[across] != Extent::positive)
    misfit("'" + s.name + "' of a rectangle that may have no extent along an axis", s.place);
  const Value value = argument(*s.arguments.at(0), scope, state);
  if (value.kind != Value::Kind::number) misfit("a setback that is not a plain number", s.place);
  const FormulaPtr distance = value.formula;
  if (distance->draws || !(distance->low > 0)) misfit("a setback that is random or may be 0 or less", s.place);
  // Edges as the CPU counts them: at the highest z or the lowest y, then on.
  const uint32_t faces[4] = {state.form == Form::flat ? 3u : 1u, 5, state.form == Form::flat ? 2u : 0u, 4};
  State edges = state;
  edges.form = Form::box; // whose faces look where the edges do
  std::array<const cga::Part*, 4> owner{};
  const cga::Part* rest = nullptr;
  bool isAny = false;
  for (const cga::Part& part : s.parts) {
    if (part.isOneShape || !part.selector) misfit("setback with =, of several pieces as one shape,", part.place);
    const std::string name = word(*part.selector);
    if (name == "remainder") {
      rest = rest ? rest : &part;
      continue;
    }
    isAny = true;
    for (uint32_t e = 0; e < 4; ++e) {
      const bool isHere = name == "border"   ? true
                          : name == "inside" ? false
                                             : selects(part, scope, edges, faces[e], e, 4);
      if (!owner[e] && isHere) owner[e] = &part;
    }
  }
  const auto moves = [&](uint32_t e) { return owner[e] || !isAny; };
  const auto along = [&](uint32_t e) { return e % 2 ? 0u : across; }; // the axis along which it moves
  const auto inset = [&](uint32_t e) { return moves(e) ? distance : number(0); };
  const auto sum = [&](const FormulaPtr& a, const FormulaPtr& b) { return fits(combined(kCodeAdd, a, b), s.place); };
  const auto less = [&](const FormulaPtr& a, const FormulaPtr& b) {
    return fits(combined(kCodeSubtract, a, b), s.place);
  };
  // The edge at the low end of each axis.
  const uint32_t low[2] = {3, state.form == Form::flat ? 2u : 0u};
  const FormulaPtr both[2] = {sum(inset(1), inset(3)), sum(inset(0), inset(2))};
  const auto part = [&](const std::array<FormulaPtr, 3>& move, const std::array<FormulaPtr, 3>& size,
                        const Body& body) {
    State child = state;
    child.made = false;
    child.isMesh = true;
    for (const uint32_t axis : {0u, across}) changeSize(child, axis, kOfRoof);
    child.moved = {number(0), number(0), number(0)};
    Scope inner = scope;
    const auto values = [](const char* name, const std::array<FormulaPtr, 3>& v) {
      return std::string(name) + "(" + cga::text(v[0]) + "," + cga::text(v[1]) + "," + cga::text(v[2]) + ")";
    };
    return wrapped(values("Translate", move),
                   wrapped(values("ResizeCorner", size), limited(bodyOf(body, inner, child))));
  };
  const auto children = [&](bool remains) {
    std::vector<Text> ways;
    for (const cga::Part& p : s.parts) {
      std::array<FormulaPtr, 3> move{number(0), number(0), number(0)}, size{sizeOf(0), sizeOf(1), sizeOf(2)};
      if (&p == rest && remains) {
        for (uint32_t i = 0; i < 2; ++i) {
          const uint32_t axis = i ? across : 0;
          move[axis] = inset(low[i]);
          size[axis] = less(sizeOf(axis), both[i]);
        }
        ways.push_back(part(move, size, p.body));
      }
      for (uint32_t e = 0; e < 4; ++e) {
        if (owner[e] != &p) continue;
        if (moves((e + 1) % 4) || moves((e + 3) % 4)) {
          ways.push_back(nothing());
          Scope inner = scope;
          if (!bodyOf(p.body, inner, state).isNothing()) misfit("a setback whose mitred pieces are used", p.place);
          continue;
        }
        const uint32_t axis = along(e), i = axis ? 1 : 0;
        const FormulaPtr room =
            moves((e + 2) % 4) ? fits(combined(kCodeMultiply, sizeOf(axis), number(0.5f)), s.place) : sizeOf(axis);
        size[axis] = remains ? distance : room;
        if (e != low[i]) move[axis] = less(sizeOf(axis), size[axis]);
        ways.push_back(part(move, size, p.body));
      }
    }
    return joined("Replicate()", std::move(ways));
  };
  FormulaPtr remains;
  for (uint32_t i = 0; i < 2; ++i) {
    if (both[i]->isNumber() && both[i]->value == 0) continue;
    const FormulaPtr hasRoom = combined(kCodeLess, both[i], sizeOf(i ? across : 0));
    remains = fits(remains ? combined(kCodeAnd, remains, hasRoom) : hasRoom, s.place);
  }
  return remains ? condition(remains, children(true), children(false)) : children(true);
}

} // namespace gpgp::spawn::cga
