// Operations of a .cga file to operators of a graph.
#include "spawn/cga/lower.h"

#include "spawn/cga/deriver.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn::cga {

namespace {
constexpr const char* kAxes[3] = {"X", "Y", "Z"};
constexpr const char* kOtherSize = "which was worked out from a size that the shape no longer has";

uint32_t axisNamed(const std::string& name) { return name == "y" ? 1u : name == "z" ? 2u : 0u; }
} // namespace

/// Values that were read from the old size are no longer what the formula says.
void Lowering::changeSize(State& state, uint32_t axis, const char* why) const {
  const auto reads = [&](const auto& self, const Value& v) -> bool {
    return (v.formula && (v.formula->sizes >> axis & 1u)) ||
           std::any_of(v.values.begin(), v.values.end(), [&](const Value& inner) { return self(self, inner); });
  };
  for (auto& [name, bound] : state.locals)
    if (bound.stale.empty() && reads(reads, bound.value)) bound.stale = why;
  for (auto& [slot, bound] : state.attributes)
    if (bound.stale.empty() && reads(reads, bound.value)) bound.stale = why;
  for (FormulaPtr& moved : state.moved)
    if (moved && (moved->sizes >> axis & 1u)) moved = nullptr;
}

// ---------------------------------------------------------------- one shape to one shape

Lowering::Text Lowering::operation(const Statement& s, Operation operation, const Scope& scope, State state,
                                   const Continue& goOn, const Statement* next, bool& tookNext) {
  using shader::kCodeAdd, shader::kCodeMultiply, shader::kCodeSubtract;
  const auto& a = s.arguments;
  const auto vector = [&](size_t first) {
    std::array<FormulaPtr, 3> v;
    for (uint32_t i = 0; i < 3; ++i)
      v[i] = length(argument(*a[first + i], scope, state), sizeOf(i), a[first + i]->place);
    return v;
  };
  const auto values = [](const std::array<FormulaPtr, 3>& v) {
    return "(" + text(v[0]) + "," + text(v[1]) + "," + text(v[2]) + ")";
  };
  const auto extentOf = [&](const FormulaPtr& v) {
    return v->low > 0 || v->high < 0 ? Extent::positive : v->isNumber() ? Extent::zero : Extent::unknown;
  };
  const auto needsBox = [&] {
    if (state.form == Form::asset) misfit("'" + s.name + "' of an asset or a round primitive", s.place);
    if (state.form == Form::roof) misfit("'" + s.name + "' of a roof", s.place);
    if (state.form == Form::trapezoid) misfit("'" + s.name + "' of a roof face that is not a rectangle", s.place);
  };
  const auto isPositive = [&] {
    return std::all_of(state.extents.begin(), state.extents.end(), [](Extent e) { return e == Extent::positive; });
  };
  const bool isOfMaterial =
      operation == Operation::color_ || operation == Operation::texture_ || operation == Operation::label_;
  if (state.roof && state.roof->overhangs && !isOfMaterial)
    misfit("'" + s.name + "' of a roof with overhangs", s.place);
  switch (operation) {
  case Operation::roofGable_:
  case Operation::roofHip_:
  case Operation::roofPyramid_:
  case Operation::roofShed_:
  case Operation::taper_: return roof(s, operation, scope, std::move(state), goOn);
  case Operation::t_: {
    const auto v = vector(0);
    for (uint32_t i = 0; i < 3; ++i)
      state.moved[i] =
          state.moved[i] && !v[i]->draws && !v[i]->isOfPlace ? combined(kCodeAdd, state.moved[i], v[i]) : nullptr;
    const bool isStill =
        std::all_of(v.begin(), v.end(), [](const FormulaPtr& f) { return f->isNumber() && f->value == 0; });
    Text rest = goOn(std::move(state));
    return isStill ? rest : wrapped("Translate" + values(v), std::move(rest));
  }
  case Operation::s_: {
    const auto v = vector(0);
    if (state.form == Form::roof) needsBox();
    // Where center() follows, sizes along its axes grow from the centre.
    std::array<bool, 3> centred{};
    if (next && next->kind == Statement::Kind::call && next->name == "center" && next->arguments.size() == 1) {
      const std::string axes = word(*next->arguments[0]);
      bool isStill = true;
      for (uint32_t i = 0; i < 3; ++i) {
        centred[i] = axes.find("xyz"[i]) != std::string::npos;
        isStill =
            isStill && (!centred[i] || (state.moved[i] && state.moved[i]->isNumber() && state.moved[i]->value == 0));
      }
      tookNext = isStill;
    }
    std::array<FormulaPtr, 3> corner, centre;
    bool isCorner = false, isCentre = false, cornerDraws = false, centreDraws = false;
    std::array<bool, 3> changes{};
    for (uint32_t i = 0; i < 3; ++i) {
      const bool isSame = v[i]->kind == Formula::Kind::size && v[i]->index == i;
      const bool byCentre = tookNext && centred[i];
      changes[i] = !isSame;
      corner[i] = byCentre ? sizeOf(i) : v[i];
      centre[i] = number(-1); // as it is
      if (byCentre && !isSame) {
        // What is no plain positive number is no size for Scale.
        centre[i] = v[i]->low >= 0 ? v[i] : nullptr;
        if (!centre[i]) misfit("'s' by a value that may be negative, before center", s.place);
        isCentre = true;
        centreDraws = centreDraws || v[i]->draws;
      } else if (!isSame) {
        isCorner = true;
        cornerDraws = cornerDraws || v[i]->draws;
      }
    }
    if (cornerDraws && isCentre && (centreDraws || cornerDraws)) misfit("random sizes before center", s.place);
    for (uint32_t i = 0; i < 3; ++i) {
      if (!changes[i]) continue;
      FormulaPtr moved = number(0);
      if (!(tookNext && centred[i])) {
        // In terms of the new size, where that is a known part of the old one.
        const FormulaPtr& f = v[i];
        const bool isPart = f->kind == Formula::Kind::binary && f->index == kCodeMultiply &&
                            f->b->kind == Formula::Kind::size && f->a->isNumber() && f->a->value > 0;
        moved = isPart && state.moved[i] && state.moved[i]->isNumber()
                    ? combined(kCodeAdd, state.moved[i],
                               combined(kCodeMultiply, sizeOf(i), number((1 - 1 / f->a->value) * 0.5f)))
                    : nullptr;
      }
      state.extents[i] = v[i]->kind == Formula::Kind::binary && v[i]->index == kCodeMultiply && v[i]->a->low > 0 &&
                                 v[i]->b->kind == Formula::Kind::size
                             ? state.extents[i]
                             : extentOf(v[i]);
      changeSize(state, i, kOtherSize);
      state.moved[i] = moved;
    }
    Text rest = goOn(std::move(state));
    if (isCentre) rest = wrapped("Scale" + values(centre), std::move(rest));
    return isCorner ? wrapped("ResizeCorner" + values(corner), std::move(rest)) : rest;
  }
  case Operation::r_: {
    if (a.size() == 4 && word(*a[0]) != "scopeCenter" && word(*a[0]) != "scopeOrigin")
      misfit("'r' about '" + word(*a[0]) + "'", s.place);
    const auto v = vector(a.size() == 4 ? 1 : 0);
    const bool isStill =
        std::all_of(v.begin(), v.end(), [](const FormulaPtr& f) { return f->isNumber() && f->value == 0; });
    if (isStill) return goOn(std::move(state));
    const auto isZero = [](const FormulaPtr& f) { return f->isNumber() && f->value == 0; };
    state.axes = {0, isZero(v[0]) && isZero(v[2]) ? state.axes[1] : int8_t{0}, 0};
    state.moved = {nullptr, nullptr, nullptr};
    Text rest = wrapped("TurnCorner" + values(v), goOn(state));
    if (a.size() != 4 || word(*a[0]) != "scopeCenter") return rest;
    // The corner goes to where the centre is, and back.
    const auto half = [&](float part) {
      std::array<FormulaPtr, 3> h;
      for (uint32_t i = 0; i < 3; ++i) h[i] = combined(kCodeMultiply, sizeOf(i), number(part));
      return values(h);
    };
    rest = wrapped("TurnCorner" + values(v), wrapped("Translate" + half(-0.5f), goOn(std::move(state))));
    return wrapped("Translate" + half(0.5f), std::move(rest));
  }
  case Operation::center_: {
    const std::string axes = word(*a[0]);
    std::array<FormulaPtr, 3> v{number(0), number(0), number(0)};
    for (uint32_t i = 0; i < 3; ++i) {
      if (axes.find("xyz"[i]) == std::string::npos) continue;
      if (!state.moved[i]) misfit("center behind operations whose moves are not known,", s.place);
      v[i] = fits(combined(kCodeSubtract, number(0), state.moved[i]), s.place);
      state.moved[i] = number(0);
    }
    const bool isStill =
        std::all_of(v.begin(), v.end(), [](const FormulaPtr& f) { return f->isNumber() && f->value == 0; });
    Text rest = goOn(std::move(state));
    return isStill ? rest : wrapped("Translate" + values(v), std::move(rest));
  }
  case Operation::extrude_: {
    needsBox();
    if (a.size() > 2) misfit("extrude with so many values", s.place);
    const std::string how = a.size() > 1 ? word(*a[0]) : "face.normal";
    const FormulaPtr distance = argumentNumber(*a.back(), scope, state);
    if (distance->isNumber() && distance->value == 0) return goOn(std::move(state));
    if (state.form == Form::box) misfit("extrude of a box", s.place);
    if (!(distance->low > 0) && !(distance->isNumber() && distance->value > 0))
      misfit("extrude by a height that may be 0 or less", s.place);
    const uint32_t axis = state.form == Form::flat ? 1 : 2;
    if (how != "face.normal" && how != "vertex.normal") {
      const bool isUp = how.starts_with("world.y") || how.starts_with("world.up") || how == "y";
      if (!isUp || state.form != Form::flat || state.axes[1] != 2) misfit("extrude along '" + how + "'", s.place);
      result_.needsUpright = true;
    }
    if (state.extents[axis] != Extent::zero) misfit("extrude of a rectangle whose scope has a height", s.place);
    state.isTilted = state.isMesh && state.form == Form::upright;
    state.form = Form::box;
    state.extents[axis] = Extent::positive;
    changeSize(state, axis, kOtherSize);
    state.moved[axis] = nullptr;
    return wrapped(std::string("GrowAlong(") + kAxes[axis] + "," + text(distance) + ")", goOn(std::move(state)));
  }
  case Operation::primitiveCube_:
  case Operation::i_:
  case Operation::primitiveCylinder_:
  case Operation::primitiveCone_:
  case Operation::primitiveSphere_: {
    if (state.form == Form::trapezoid) misfit("'" + s.name + "' in a roof face that is not a rectangle", s.place);
    std::string what = s.name;
    if (operation == Operation::i_) {
      if (a.size() > 1) misfit("i with more than the file", s.place);
      const Value file = argument(*a[0], scope, state);
      if (file.kind != Value::Kind::string) misfit("i of a file whose name depends on the shape", s.place);
      what = file.string;
    } else if (a.size() > (operation == Operation::primitiveCube_ ? 0u : 1u)) {
      misfit("'" + s.name + "' with sizes", s.place);
    } else if (a.size() == 1) {
      const FormulaPtr sides = argumentNumber(*a[0], scope, state);
      if (!sides->isNumber()) misfit("'" + s.name + "' of a number of sides that is not known", s.place);
      what += "(" + text(sides) + ")";
    }
    if (!isPositive()) misfit("'" + s.name + "' in a scope that may have no extent along an axis", s.place);
    const bool isCube = operation == Operation::primitiveCube_ || what.starts_with("builtin:cube");
    state.form = isCube ? Form::box : Form::asset;
    state.roof.reset();
    state.isMesh = false;
    state.asset = isCube ? std::string() : what;
    return wrapped("GrowAlong(Y,ShapeSize(Y))", goOn(std::move(state)));
  }
  case Operation::primitiveQuad_:
    if (!a.empty()) misfit("'" + s.name + "' with sizes", s.place);
    if (state.extents[0] != Extent::positive || state.extents[2] != Extent::positive)
      misfit("'" + s.name + "' in a scope that may have no extent along an axis", s.place);
    state.form = Form::flat;
    state.roof.reset();
    state.isMesh = false;
    state.asset.clear();
    state.extents[1] = Extent::zero;
    changeSize(state, 1, kOtherSize);
    state.moved[1] = nullptr;
    return wrapped("GrowAlong(Y,0)", goOn(std::move(state)));
  case Operation::color_: {
    if (a.size() == 1) return colored(argument(*a[0], scope, state), state, goOn, s.place);
    std::array<float, 4> c{state.color.x, state.color.y, state.color.z, state.color.w};
    for (size_t i = 0; i < a.size(); ++i) {
      const Value v = argument(*a[i], scope, state);
      if (v.kind != Value::Kind::number || !v.formula->isNumber()) misfit("a colour that is not known", a[i]->place);
      c[i] = std::clamp(v.formula->value, 0.0f, 1.0f);
    }
    if (a.size() == 2) misfit("a colour of two values", s.place);
    state.color = {c[0], c[1], c[2], c[3]};
    return goOn(std::move(state));
  }
  case Operation::texture_: {
    const Value v = argument(*a[0], scope, state);
    if (v.kind != Value::Kind::string) misfit("a texture that depends on the shape", s.place);
    state.texture = v.string;
    return goOn(std::move(state));
  }
  case Operation::alignScopeToAxes_:
    if (state.form == Form::asset || state.form == Form::upright || a.size() != 1 || word(*a[0]) != "y" ||
        state.axes[1] != 2)
      misfit("alignScopeToAxes of a scope that it may turn", s.place);
    result_.needsUpright = true;
    return goOn(std::move(state));                       // it is aligned
  case Operation::label_: return goOn(std::move(state)); // for context queries alone, which no graph has
  default: misfit("the operation '" + s.name + "'", s.place);
  }
}

Lowering::Text Lowering::colored(const Value& value, const State& state, const Continue& goOn, Place place) {
  if (value.kind == Value::Kind::choice)
    return condition(fits(asBoolean(value.formula), place), colored(value.values[0], state, goOn, place),
                     colored(value.values[1], state, goOn, place));
  if (value.kind == Value::Kind::drawn) {
    std::vector<Text> ways;
    for (const Value& v : value.values) ways.push_back(colored(v, state, goOn, place));
    return chooses(value.chances, std::move(ways), place);
  }
  if (value.kind != Value::Kind::string) misfit("a colour that is not known", place);
  State after = state;
  glm::vec4 color;
  bool hasOpacity = false;
  if (!parseColor(value.string, color, hasOpacity)) misfit("\"" + value.string + "\", which is not a colour,", place);
  after.color = hasOpacity ? color : glm::vec4(glm::vec3(color), state.color.w);
  return goOn(std::move(after));
}

Lowering::Text Lowering::setAttribute(const Statement& s, const Scope& scope, State state, const Continue& goOn) {
  const std::string name = word(*s.arguments.at(0));
  std::string last;
  bool isMissing = false;
  Module* module = resolvePath(name, scope.module, last, isMissing);
  Entity* entity = isMissing ? nullptr : module->find(last, false, 0);
  if (!entity || entity->kind != Definition::Kind::attribute) misfit("set of '" + name + "'", s.place);
  draws_ = 0;
  state.attributes[entity->slot] = kept(value(*s.arguments.at(1), scope, state));
  if (draws_) misfit("a random number that a shape has to remember", s.place);
  return goOn(std::move(state));
}

// ---------------------------------------------------------------- split

Lowering::Text Lowering::split(const Statement& s, const Scope& scope, const State& state) {
  using shader::kCodeAdd;
  const std::string axisName = word(*s.arguments[0]);
  if (axisName != "x" && axisName != "y" && axisName != "z") misfit("split along '" + axisName + "'", s.place);
  if (state.form == Form::asset) misfit("split of an asset or a round primitive", s.place);
  if (state.form == Form::roof) misfit("split of a roof", s.place);
  if (state.form == Form::trapezoid) misfit("split of a roof face that is not a rectangle", s.place);
  const uint32_t axis = axisNamed(axisName);
  if (state.extents[axis] == Extent::zero) return nothing();
  size_t place = 0;
  const auto read = [&](const std::vector<cga::Part>& parts, bool isGroup) {
    std::vector<Part> result;
    for (const cga::Part& part : parts) {
      if (part.isGroup)
        misfit(isGroup ? "a group in a group of a split" : "a group of a split that does not repeat", part.place);
      if (!part.selector) misfit("a part without a size", part.place);
      Value size = argument(*part.selector, scope, state);
      const bool isSize =
          size.kind == Value::Kind::number || size.kind == Value::Kind::relative || size.kind == Value::Kind::floating;
      if (!isSize) misfit("a size that is a choice", part.place);
      if (isGroup &&
          (size.kind == Value::Kind::relative || size.formula->isOfPlace || (size.formula->sizes >> axis & 1u)))
        misfit("a size in a repeated group that depends on the whole shape", part.place);
      if (size.formula->draws && (isGroup || place != result.size()))
        misfit("a random size in a repeated group", part.place);
      if (size.kind == Value::Kind::relative) {
        size.formula = length(size, sizeOf(axis), part.place);
        size.kind = Value::Kind::number;
      }
      result.push_back({&part, std::move(size)});
      ++place;
    }
    if (result.empty()) misfit("a split without parts", s.place);
    if (result.size() > shader::kMaxSuccessors) misfit("a split into so many parts", s.place);
    return result;
  };
  State child = state;
  child.made = false;
  child.moved = {number(0), number(0), number(0)};
  changeSize(child, axis, kOtherSize);
  child.moved = {number(0), number(0), number(0)};
  child.extents[axis] = Extent::positive;
  if (s.repeats) return repeat(read(s.parts, true), axis, scope, child);
  const auto isGroup = [](const cga::Part& part) { return part.isGroup; };
  const auto groups = std::count_if(s.parts.begin(), s.parts.end(), isGroup);
  if (groups == 0) return divide(read(s.parts, false), axis, scope, child, nullptr);
  if (groups > 1) misfit("several groups of a split", s.place);
  const auto group = std::find_if(s.parts.begin(), s.parts.end(), isGroup);
  if (!group->repeats) misfit("a group of a split that does not repeat", group->place);
  if (s.parts.size() == 1) return repeat(read(group->group, true), axis, scope, child);
  // Beside parts of fixed length, which leave the rest to the group.
  std::vector<Part> parts;
  for (const cga::Part& part : s.parts) {
    if (part.isGroup) {
      Value rest;
      rest.kind = Value::Kind::floating;
      rest.formula = number(1);
      parts.push_back({&part, rest});
      continue;
    }
    if (!part.selector) misfit("a part without a size", part.place);
    Value size = argument(*part.selector, scope, state);
    if (size.kind != Value::Kind::number && size.kind != Value::Kind::relative)
      misfit("a floating size beside a repeated group", part.place);
    if (size.formula->draws) misfit("a random size beside a repeated group", part.place);
    size.formula = length(size, sizeOf(axis), part.place);
    size.kind = Value::Kind::number;
    parts.push_back({&part, std::move(size)});
  }
  if (parts.size() > shader::kMaxSuccessors) misfit("a split into so many parts", s.place);
  const std::vector<Part> inner = read(group->group, true);
  return divide(parts, axis, scope, child, &inner);
}

/// SubDiv. state: of the parts.
Lowering::Text Lowering::divide(const std::vector<Part>& parts, uint32_t axis, const Scope& scope, const State& state,
                                const std::vector<Part>* group) {
  std::vector<Text> ways;
  for (const Part& part : parts) {
    const bool isFloating = part.size.kind == Value::Kind::floating;
    const FormulaPtr size = fits(clamped(part.size.formula), part.part->place);
    const FormulaPtr v = isFloating ? fits(combined(shader::kCodeSubtract, number(0), size), part.part->place) : size;
    Scope inner = scope;
    Text body =
        limited(part.part->isGroup ? repeat(*group, axis, scope, state) : bodyOf(part.part->body, inner, state));
    ways.push_back({text(v) + ": " + body.text, body.depth});
  }
  const bool isNothing =
      std::all_of(ways.begin(), ways.end(), [](const Text& way) { return way.text.ends_with(": Discard()"); });
  if (isNothing) return nothing();
  return joined(std::string("SubDiv(") + kAxes[axis] + ")", std::move(ways));
}

/// Repeat of a group, and SubDiv in its copies. As layOutPlain() does it.
Lowering::Text Lowering::repeat(const std::vector<Part>& parts, uint32_t axis, const Scope& scope, const State& state) {
  using namespace shader;
  const Place place = parts[0].part->place;
  FormulaPtr fixed = number(0), floating = number(0);
  for (const Part& part : parts) {
    FormulaPtr& sum = part.size.kind == Value::Kind::floating ? floating : fixed;
    sum = fits(combined(kCodeAdd, sum, clamped(part.size.formula)), place);
  }
  Scope inner = scope;
  const Text body = limited(parts.size() == 1 ? bodyOf(parts[0].part->body, inner, state)
                                              : divide(parts, axis, scope, state, nullptr));
  if (body.isNothing()) return body;
  const FormulaPtr length = sizeOf(axis);
  const std::string begin = std::string("Repeat(") + kAxes[axis] + ",";
  const auto fixedOnly = [&]() -> Text {
    if (fixed->isNumber() && fixed->value == 0) return nothing();
    const FormulaPtr some =
        combined(kCodeFloor, combined(kCodeAdd, length, combined(kCodeMultiply, fixed, number(1e-4f))), fixed);
    const FormulaPtr all = fits(combined(kCodeMultiply, combined(kCodeMost, number(1), some), fixed), place);
    Text copies = wrapped(begin + text(fixed) + ",ADJUST_TO_FILL)", body);
    return joined(std::string("SubDiv(") + kAxes[axis] + ")", {{text(all) + ": " + copies.text, copies.depth}});
  };
  if (floating->isNumber() && floating->value == 0) return fixedOnly();
  const FormulaPtr fits_ = combined(kCodeFloor, length, combined(kCodeAdd, fixed, floating));
  const auto stretched = [&](const FormulaPtr& n) {
    return combined(kCodeSubtract, combined(kCodeDivide, length, n), fixed);
  };
  const FormulaPtr isMore =
      combined(kCodeGreater, combined(kCodeMultiply, stretched(fits_), stretched(combined(kCodeAdd, fits_, number(1)))),
               combined(kCodeMultiply, floating, floating));
  const FormulaPtr count = combined(kCodeMost, number(1), combined(kCodeAdd, fits_, isMore));
  const FormulaPtr extent = fits(combined(kCodeDivide, length, count), place);
  Text copies = wrapped(begin + text(extent) + ",ADJUST_TO_FILL)", body);
  if (floating->low > 0) return copies;
  return condition(fits(combined(kCodeGreater, floating, number(0)), place), std::move(copies), fixedOnly());
}

// ---------------------------------------------------------------- comp

Lowering::State Lowering::faceOf(const State& state, uint32_t face) const {
  // The face's axes, and the frame's axes along which they are: BoxForms::face().
  struct Turned {
    int8_t axes[3]; // axis + 1, negative: the other way
  };
  constexpr Turned kFaces[6] = {{{1, -3, 2}}, {{1, 3, -2}}, {{-1, 2, -3}}, {{1, 2, 3}}, {{3, 2, -1}}, {{-3, 2, 1}}};
  State child = state;
  child.made = false;
  child.form = Form::upright;
  std::array<uint32_t, 3> renames{3, 3, 3};
  for (uint32_t i = 0; i < 3; ++i) {
    const int8_t turned = kFaces[face].axes[i];
    const uint32_t from = static_cast<uint32_t>(std::abs(turned)) - 1;
    const int8_t own = state.axes[from];
    child.axes[i] = turned < 0 ? static_cast<int8_t>(-own) : own;
    child.extents[i] = i < 2 ? state.extents[from] : Extent::zero;
    if (i < 2) renames[from] = i;
  }
  const auto rename = [&](Bound& bound) {
    const auto apply = [&](const auto& self, Value& v) -> bool {
      if (v.formula && !(v.formula = renamed(v.formula, renames))) return false;
      return std::all_of(v.values.begin(), v.values.end(), [&](Value& inner) { return self(self, inner); });
    };
    if (bound.stale.empty() && !apply(apply, bound.value)) {
      bound.value = {};
      bound.stale = kOtherSize;
    }
  };
  for (auto& [name, bound] : child.locals) rename(bound);
  for (auto& [slot, bound] : child.attributes) rename(bound);
  child.moved = {number(0), number(0), number(0)};
  return child;
}

/// As Deriver::selects() of a box. face: by operator graphs' number; index: by CGA's.
bool Lowering::selects(const cga::Part& part, const Scope& scope, const State& state, uint32_t face, uint32_t index,
                       uint32_t count) {
  const Expression& e = *part.selector;
  const std::string name = word(e);
  if (name.empty() || !isSelector(name)) {
    const Value v = argument(e, scope, state);
    if (v.kind != Value::Kind::number || !v.formula->isNumber()) misfit("a selector that is not known", e.place);
    if (v.formula->isBoolean) return v.formula->value != 0;
    const float wanted = v.formula->value;
    return static_cast<float>(index) == (wanted < 0 ? wanted + static_cast<float>(count) : wanted);
  }
  const size_t dot = name.find('.');
  const std::string system = dot == std::string::npos ? "scope" : name.substr(0, dot);
  const std::string last = dot == std::string::npos ? name : name.substr(dot + 1);
  if (last == "all") return true;
  if (last == "border") return count == 1;
  if (last == "inside") return count != 1;
  // The normal, in the scope's frame.
  constexpr int8_t kNormals[6] = {2, -2, -3, 3, -1, 1};
  int8_t normal = state.form == Form::flat ? int8_t{2} : state.form == Form::upright ? int8_t{3} : kNormals[face];
  if (system != "scope") {
    const int8_t axis = state.axes[static_cast<size_t>(std::abs(normal)) - 1];
    normal = normal < 0 ? static_cast<int8_t>(-axis) : axis;
    if (normal == 0 || (system != "object" && system != "world")) misfit("the selector '" + name + "'", e.place);
    const bool isVertical = last == "top" || last == "up" || last == "bottom" || last == "down" || last == "side" ||
                            last == "vertical" || last == "horizontal" || last == "aslant" || last == "nutant";
    if (system == "world" && !isVertical) misfit("the selector '" + name + "'", e.place);
    if (system == "world") result_.needsUpright = true;
  }
  constexpr std::pair<const char*, int8_t> kSides[] = {{"top", 2},   {"up", 2},    {"bottom", -2}, {"down", -2},
                                                       {"front", 3}, {"south", 3}, {"back", -3},   {"north", -3},
                                                       {"left", -1}, {"west", -1}, {"right", 1},   {"east", 1}};
  for (const auto& [side, direction] : kSides)
    if (last == side) return normal == direction;
  const bool isUpright = std::abs(normal) != 2;
  if (last == "side" || last == "vertical") return isUpright;
  if (last == "horizontal") return !isUpright;
  if (last == "aslant" || last == "nutant") return false;
  misfit("the selector '" + name + "'", e.place);
}

Lowering::Text Lowering::components(const Statement& s, const Scope& scope, const State& state) {
  if (word(*s.arguments[0]) != "f") misfit("comp(" + word(*s.arguments[0]) + ")", s.place);
  if (state.form == Form::asset) misfit("comp of an asset or a round primitive", s.place);
  for (const cga::Part& part : s.parts)
    if (part.isOneShape || !part.selector) misfit("comp with =, of several faces as one shape,", part.place);
  if (state.roof) return roofFaces(s, scope, state);
  if (state.form == Form::trapezoid || (state.isTilted && state.form == Form::box))
    misfit("comp of a roof face that is not a rectangle, or was extruded,", s.place);
  const bool isBox = state.form == Form::box;
  constexpr uint32_t kFaces[6] = {1, 3, 5, 2, 4, 0}; // by CGA's index
  const bool isMesh = isBox && state.isMesh;         // children by parts then, as the CPU counts them
  if (isMesh && state.axes[1] != 2) misfit("comp of a shape that may not be upright", s.place);
  if (isMesh) result_.needsUpright = true;
  std::vector<Text> ways(6, nothing());
  std::vector<std::pair<size_t, uint32_t>> order; // of faces: their parts
  for (uint32_t index = 0; index < (isBox ? 6u : 1u); ++index) {
    const uint32_t face = isBox ? kFaces[index] : 0;
    for (const cga::Part& part : s.parts) {
      if (!selects(part, scope, state, face, index, isBox ? 6 : 1)) continue;
      State child = isBox || state.form == Form::flat ? faceOf(state, face) : state;
      child.made = false;
      child.moved = {number(0), number(0), number(0)};
      Scope inner = scope;
      ways[face] = limited(bodyOf(part.body, inner, std::move(child)));
      order.emplace_back(&part - s.parts.data(), face);
      break;
    }
  }
  if (state.form == Form::upright) return joined("Replicate()", {ways[0]}); // the rectangle itself
  if (isMesh) {
    std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Text> children;
    for (const auto& [part, face] : order)
      children.push_back(wrapped("ToFace(" + std::to_string(face) + ")", std::move(ways[face])));
    return joined("Replicate()", std::move(children));
  }
  const bool areSidesAlike =
      std::all_of(ways.begin() + 2, ways.end(), [&](const Text& way) { return way.text == ways[2].text; });
  if (areSidesAlike) return joined("CompSplit()", {ways[0], ways[1], ways[2]});
  for (uint32_t face = 0; face < 6; ++face)
    ways[face] = wrapped("ToFace(" + std::to_string(face) + ")", std::move(ways[face]));
  return joined("Replicate()", std::move(ways));
}

} // namespace gpgp::spawn::cga
