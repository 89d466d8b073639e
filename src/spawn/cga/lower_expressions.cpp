// Expressions of a .cga file to formulas of an operator graph.
#include "spawn/cga/lower.h"

#include "spawn/cga/deriver.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn::cga {

namespace {
constexpr uint32_t kMostCalls = 64, kMostEvaluations = 400'000;

Value valueOf(FormulaPtr formula) {
  Value value;
  value.formula = std::move(formula);
  return value;
}
Value valueOf(std::string text) {
  Value value;
  value.kind = Value::Kind::string;
  value.string = std::move(text);
  return value;
}
bool isNumeric(const Value& v) { return v.kind == Value::Kind::number; }
} // namespace

FormulaPtr Lowering::fits(FormulaPtr formula, Place place) const {
  if (!formula) misfit("a value that operator graphs have no formula for, or that is too long for them", place);
  return formula;
}

FormulaPtr Lowering::numberOf(const Value& value, Place place) const {
  if (value.kind == Value::Kind::string) return number(0); // as the machine takes what is no number
  if (value.kind == Value::Kind::relative || value.kind == Value::Kind::floating) return value.formula;
  if (!isNumeric(value)) misfit("a choice between values, where one number is expected", place);
  return value.formula;
}

std::string Lowering::word(const Expression& e) const {
  return e.kind == Expression::Kind::name && !e.isCall ? e.text
         : e.kind == Expression::Kind::string          ? e.text
                                                       : std::string();
}

const Value& Lowering::use(const Bound& bound, const std::string& name, Place place) const {
  if (!bound.stale.empty()) misfit("'" + name + "', " + bound.stale + ",", place);
  return bound.value;
}

Lowering::Bound Lowering::kept(const Value& value) const {
  Bound bound{value, {}};
  const auto draws = [](const auto& self, const Value& v) -> bool {
    return v.kind == Value::Kind::drawn || (v.formula && v.formula->draws) ||
           std::any_of(v.values.begin(), v.values.end(), [&](const Value& inner) { return self(self, inner); });
  };
  if (draws(draws, value)) bound.stale = "a random number that a shape has to remember";
  const auto isOfPlace = [](const auto& self, const Value& v) -> bool {
    return (v.formula && v.formula->isOfPlace) ||
           std::any_of(v.values.begin(), v.values.end(), [&](const Value& inner) { return self(self, inner); });
  };
  if (isOfPlace(isOfPlace, value)) bound.stale = "a field's value that a shape has to remember";
  return bound;
}

/// Of the operation that is lowered, or of the attribute.
FormulaPtr Lowering::draw(Place place) {
  if (attributeSlot_ == UINT32_MAX) return drawn(draws_++);
  const uint32_t index = 1024 * attributeSlot_ + draws_++;
  if (index >= (1u << 24) || draws_ > 1024) misfit("an attribute that draws so many random numbers", place);
  return axiomNumber(index);
}

Value Lowering::argument(const Expression& e, const Scope& scope, const State& state) {
  draws_ = 0;
  const Value result = value(e, scope, state);
  if (!result.formula) {
    if (draws_ && result.kind != Value::Kind::drawn)
      misfit("a random number that is not used where it is drawn", e.place);
    return result;
  }
  if (!drawsInOrder(result.formula, draws_))
    misfit("random numbers that are used twice, or not in the order in which they are drawn,", e.place);
  return result;
}

FormulaPtr Lowering::argumentNumber(const Expression& e, const Scope& scope, const State& state) {
  return numberOf(argument(e, scope, state), e.place);
}

FormulaPtr Lowering::length(const Value& v, const FormulaPtr& whole, Place place) const {
  if (v.kind == Value::Kind::relative) return fits(combined(shader::kCodeMultiply, v.formula, whole), place);
  if (v.kind == Value::Kind::floating) return v.formula;
  return numberOf(v, place);
}

Value Lowering::value(const Expression& e, const Scope& scope, const State& state) {
  using Kind = Expression::Kind;
  if (++calls_ > kMostEvaluations) misfit("a value that takes so long to work out", e.place);
  switch (e.kind) {
  case Kind::number: return valueOf(number(static_cast<float>(e.number)));
  case Kind::string: return valueOf(e.text);
  case Kind::boolean: return valueOf(number(e.number != 0 ? 1.0f : 0.0f, true));
  case Kind::name: return named(e, scope, state);
  case Kind::relative:
  case Kind::floating: {
    Value inner = value(*e.arguments[0], scope, state);
    inner.formula = numberOf(inner, e.place);
    inner.kind = e.kind == Kind::relative ? Value::Kind::relative : Value::Kind::floating;
    return inner;
  }
  case Kind::unary: {
    const FormulaPtr inner = numberOf(value(*e.arguments[0], scope, state), e.place);
    if (e.text[0] == '.') misfit("an array", e.place);
    if (e.text != "!") return valueOf(fits(combined(shader::kCodeSubtract, number(0), inner), e.place));
    return valueOf(fits(notOf(asBoolean(inner)), e.place));
  }
  case Kind::binary: {
    const Value left = value(*e.arguments[0], scope, state);
    if (e.text == "&&" || e.text == "||") {
      const FormulaPtr a = fits(asBoolean(numberOf(left, e.place)), e.place);
      if (a->isNumber() && (a->value != 0) == (e.text == "||")) return valueOf(a);
      const uint32_t before = draws_;
      const FormulaPtr b = fits(asBoolean(numberOf(value(*e.arguments[1], scope, state), e.place)), e.place);
      if (draws_ != before && !a->isNumber() && attributeSlot_ == UINT32_MAX)
        misfit("a random number in a part of a condition that is not always needed", e.place);
      if (a->isNumber()) return valueOf(b);
      return valueOf(fits(combined(e.text == "&&" ? shader::kCodeAnd : shader::kCodeOr, a, b), e.place));
    }
    return binaryOf(e.text, left, value(*e.arguments[1], scope, state), e.place);
  }
  case Kind::cases:
  case Kind::stochastic: return choices(e, scope, state);
  case Kind::components:
  case Kind::rows:
  case Kind::index:
  case Kind::range:
  case Kind::array: misfit("an array", e.place);
  }
  return valueOf(number(0));
}

Value Lowering::binaryOf(const std::string& op, const Value& a, const Value& b, Place place) {
  using namespace shader;
  for (const bool first : {true, false}) { // of choices, whatever comes of each value
    const Value& v = first ? a : b;
    if (v.kind != Value::Kind::choice) continue;
    const auto of = [&](size_t i) {
      return first ? binaryOf(op, v.values[i], b, place) : binaryOf(op, a, v.values[i], place);
    };
    return select(v.formula, of(0), of(1), place);
  }
  if (a.kind == Value::Kind::drawn || b.kind == Value::Kind::drawn)
    misfit("a random choice that is computed with", place);
  if (a.kind == Value::Kind::string || b.kind == Value::Kind::string) {
    if (a.kind == b.kind && (op == "==" || op == "!="))
      return valueOf(number((a.string == b.string) == (op == "==") ? 1.0f : 0.0f, true));
    if (op == "+" && a.kind == b.kind) return valueOf(a.string + b.string);
    misfit("'" + op + "' of strings", place);
  }
  const FormulaPtr x = numberOf(a, place), y = numberOf(b, place);
  constexpr std::pair<const char*, uint32_t> kCodes[] = {
      {"+", kCodeAdd},  {"-", kCodeSubtract},   {"*", kCodeMultiply}, {"/", kCodeDivide},
      {"<", kCodeLess}, {"<=", kCodeLessEqual}, {">", kCodeGreater},  {">=", kCodeGreaterEqual}};
  for (const auto& [text, code] : kCodes)
    if (op == text) return valueOf(fits(combined(code, x, y), place));
  if (op == "==" || op == "!=") { // exactly: that of graphs tolerates rounding
    if (x->draws || y->draws) misfit("'" + op + "' of random numbers", place);
    const FormulaPtr equal = combined(kCodeAnd, combined(kCodeLessEqual, x, y), combined(kCodeGreaterEqual, x, y));
    return valueOf(fits(op == "==" ? equal : notOf(equal ? equal : nullptr), place));
  }
  if (op == "%" && x->isNumber() && y->isNumber()) return valueOf(number(cgaModulo(x->value, y->value)));
  misfit("the operator '" + op + "'", place);
}

Value Lowering::select(const FormulaPtr& condition, const Value& yes, const Value& no, Place place) {
  if (condition->isNumber()) return condition->value != 0 ? yes : no;
  if (isNumeric(yes) && isNumeric(no)) return valueOf(fits(selected(condition, yes.formula, no.formula), place));
  if (yes.kind == Value::Kind::string && no.kind == Value::Kind::string && yes.string == no.string) return yes;
  if (condition->draws) misfit("a choice between strings by a random number", place);
  Value choice;
  choice.kind = Value::Kind::choice;
  choice.formula = condition;
  choice.values = {yes, no};
  return choice;
}

Value Lowering::choices(const Expression& e, const Scope& scope, const State& state) {
  using namespace shader;
  const bool isAttribute = attributeSlot_ != UINT32_MAX;
  struct Way {
    FormulaPtr condition; // none: else
    const Expression* value;
  };
  std::vector<Way> ways;
  if (e.kind == Expression::Kind::stochastic && !isAttribute) {
    // One operation draws for all: RandomRule, where the choice is used.
    if (draws_) misfit("several random numbers for one value", e.place);
    Value result;
    result.kind = Value::Kind::drawn;
    float rest = 100;
    for (const Choice& c : e.choices) {
      if (c.condition && c.condition->kind != Expression::Kind::number)
        misfit("a percentage that is not a plain number", c.condition->place);
      const float chance = c.condition ? static_cast<float>(c.condition->number) : rest;
      rest = subtract(rest, chance);
      result.chances.push_back(chance);
      result.values.push_back(value(*c.value, scope, state));
    }
    if (draws_) misfit("several random numbers for one value", e.place);
    draws_ = 1;
    return result;
  }
  FormulaPtr number;
  if (e.kind == Expression::Kind::stochastic)
    number = fits(combined(kCodeMultiply, draw(e.place), cga::number(100)), e.place);
  for (const Choice& c : e.choices) {
    if (!c.condition) {
      ways.push_back({nullptr, c.value.get()});
      break;
    }
    FormulaPtr condition = numberOf(value(*c.condition, scope, state), c.condition->place);
    if (number) {
      const FormulaPtr part = condition;
      condition = fits(combined(kCodeLess, number, part), e.place);
      number = fits(combined(kCodeSubtract, number, part), e.place);
    }
    condition = fits(asBoolean(condition), c.condition->place);
    if (condition->isNumber() && condition->value == 0) continue;
    const bool isSure = condition->isNumber();
    ways.push_back({isSure ? nullptr : condition, c.value.get()});
    if (isSure) break;
  }
  if (ways.empty() || ways.back().condition) ways.push_back({nullptr, nullptr});
  // A draw in one of several ways: which number it is does not depend on the others.
  const uint32_t before = draws_;
  uint32_t most = before;
  std::vector<Value> values;
  for (const Way& way : ways) {
    draws_ = before;
    values.push_back(way.value ? value(*way.value, scope, state) : valueOf(cga::number(0)));
    if (draws_ != before && ways.size() > 1 && !isAttribute)
      misfit("a random number in one of several cases of a value", e.place);
    most = std::max(most, draws_);
  }
  draws_ = most;
  Value result = values.back();
  for (size_t i = ways.size() - 1; i-- > 0;) result = select(ways[i].condition, values[i], result, e.place);
  return result;
}

Value Lowering::attribute(Entity& entity, Place place) {
  const uint32_t slot = entity.slot;
  const auto found = attributes_.find(slot);
  if (found != attributes_.end()) return use(found->second, entity.definition->name, place);
  const Definition& d = *entity.definition;
  if (std::find(open_.begin(), open_.end(), slot) != open_.end())
    misfit("'" + d.name + "', which may need itself,", place);
  Bound bound;
  const std::string name = entity.owner->prefix + d.name;
  const bool isString = d.value && d.value->kind == Expression::Kind::string;
  const AttributeValue* given = nullptr;
  for (const AttributeValue& value : given_)
    if (value.name == name && entity.kind == Definition::Kind::attribute) given = &value;
  if (given) { // as Deriver::attributes() takes it
    const std::optional<float> parsed = numberIn(given->text);
    if (!isString && (given->text == "true" || given->text == "false"))
      bound.value = valueOf(number(given->text == "true" ? 1.0f : 0.0f, true));
    else if (!isString && parsed)
      bound.value = valueOf(number(*parsed));
    else
      bound.value = valueOf(given->text);
  } else {
    const uint32_t outerSlot = std::exchange(attributeSlot_, slot), outerDraws = std::exchange(draws_, 0);
    open_.push_back(slot);
    const Scope scope{entity.scope, name, true, {}};
    const Scope* outer = std::exchange(at_, &scope);
    const State state;
    bound = kept(d.value ? value(*d.value, scope, state) : valueOf(number(0)));
    const auto reads = [](const auto& self, const Value& v) -> bool {
      return (v.formula && v.formula->sizes) ||
             std::any_of(v.values.begin(), v.values.end(), [&](const Value& inner) { return self(self, inner); });
    };
    if (reads(reads, bound.value)) bound.stale = "which is worked out from the size of the axiom";
    at_ = outer;
    open_.pop_back();
    attributeSlot_ = outerSlot;
    draws_ = outerDraws;
  }
  attributes_[slot] = bound;
  return use(attributes_[slot], d.name, place);
}

Value Lowering::call(Entity& entity, const Expression& e, const Scope& scope, const State& state) {
  const Definition& d = *entity.definition;
  if (nested_ >= kMostCalls) misfit("functions that call each other so deep", e.place);
  Scope inner{entity.scope, scope.name, true, {}};
  for (size_t i = 0; i < e.arguments.size(); ++i) {
    const Value v = value(*e.arguments[i], scope, state);
    // Whoever uses it in another place than the one where it is drawn is found by argument().
    inner.locals[d.parameters[i]] = {v, {}};
  }
  ++nested_;
  const Scope* outer = std::exchange(at_, &inner);
  for (const Local& local : d.locals) inner.locals[local.name] = {value(*local.value, inner, state), {}};
  const Value result = d.value ? value(*d.value, inner, state) : valueOf(number(0));
  at_ = outer;
  --nested_;
  return result;
}

Value Lowering::named(const Expression& e, const Scope& scope, const State& state) {
  const auto& locals = scope.isFunction ? scope.locals : state.locals;
  if (!e.isCall)
    if (const auto local = locals.find(e.text); local != locals.end()) return use(local->second, e.text, e.place);
  std::string last;
  bool isMissing = false;
  Module* module = resolvePath(e.text, scope.module, last, isMissing);
  if (isMissing) misfit("'" + e.text + "' of a file that was not found", e.place);
  if (Entity* entity = module->find(last, false, e.arguments.size())) {
    if (entity->kind == Definition::Kind::function) return call(*entity, e, scope, state);
    const auto set = state.attributes.find(entity->slot);
    if (set != state.attributes.end()) return use(set->second, e.text, e.place);
    return attribute(*entity, e.place);
  }
  // Of the geometry, whether it fills the scope.
  const bool known = state.form != Form::asset && state.form != Form::roof && state.form != Form::trapezoid;
  if (state.roof && state.roof->overhangs && e.text.starts_with("scope."))
    misfit("'" + e.text + "' of a roof with overhangs", e.place);
  if (e.text == "scope.sx") return valueOf(sizeOf(0));
  if (e.text == "scope.sy") return valueOf(sizeOf(1));
  if (e.text == "scope.sz") return valueOf(sizeOf(2));
  const auto product = [&](uint32_t a, uint32_t b) { return combined(shader::kCodeMultiply, sizeOf(a), sizeOf(b)); };
  if (e.text == "geometry.area" && known && e.arguments.empty()) {
    if (state.form == Form::flat) return valueOf(product(0, 2));
    if (state.form == Form::upright) return valueOf(product(0, 1));
    const FormulaPtr sum =
        combined(shader::kCodeAdd, combined(shader::kCodeAdd, product(0, 1), product(1, 2)), product(2, 0));
    return valueOf(fits(combined(shader::kCodeMultiply, number(2), sum), e.place));
  }
  if (e.text == "geometry.volume" && known && e.arguments.empty()) {
    if (state.form != Form::box) return valueOf(number(0));
    return valueOf(fits(combined(shader::kCodeMultiply, product(0, 1), sizeOf(2)), e.place));
  }
  if (e.text == "Field" && e.isCall) return field(e, scope, state);
  if (const auto function = findFunction(e.text)) {
    if (function->isMath) return math(e, scope, state);
    misfit("the function or attribute '" + e.text + "'", e.place);
  }
  misfit("'" + e.text + "'", e.place);
}

/// At the middle of what fills its scope, as a graph's shapes do.
Value Lowering::field(const Expression& e, const Scope& scope, const State& state) {
  const Value name = value(*e.arguments.at(0), scope, state);
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const bool isName = name.kind == Value::Kind::string && !name.string.empty() && isLetter(name.string[0]) &&
                      std::all_of(name.string.begin(), name.string.end(),
                                  [&](char c) { return isLetter(c) || (c >= '0' && c <= '9'); });
  if (!isName) misfit("a field whose name is not known, or is no identifier,", e.place);
  if (state.form != Form::flat && state.form != Form::upright && state.form != Form::box)
    misfit("a field that is read on anything but a rectangle or a box", e.place);
  FormulaPtr x, z;
  if (e.arguments.size() > 2) {
    x = numberOf(value(*e.arguments[1], scope, state), e.place);
    z = numberOf(value(*e.arguments[2], scope, state), e.place);
  }
  return valueOf(fits(fieldOf(name.string, x, z), e.place));
}

Value Lowering::math(const Expression& e, const Scope& scope, const State& state) {
  using namespace shader;
  const uint32_t function = findFunction(e.text)->number;
  std::vector<FormulaPtr> a;
  for (const ExpressionPtr& argument : e.arguments) a.push_back(numberOf(value(*argument, scope, state), e.place));
  const auto done = [&](FormulaPtr f) { return valueOf(fits(std::move(f), e.place)); };
  if (function == kCgaPMath) return done(combined(kCodeLess, draw(e.place), a.at(0)));
  if (function == kCgaRandMath) {
    const FormulaPtr r = draw(e.place);
    if (a.empty()) return valueOf(r);
    const FormulaPtr low = a.size() == 1 ? number(0) : a[0], high = a.size() == 1 ? a[0] : a[1];
    return done(combined(kCodeAdd, low, combined(kCodeMultiply, r, combined(kCodeSubtract, high, low))));
  }
  if (std::all_of(a.begin(), a.end(), [](const FormulaPtr& f) { return f->isNumber(); })) {
    const float x = a.empty() ? 0.0f : a[0]->value, y = a.size() > 1 ? a[1]->value : 0.0f;
    if (cgaHasNoValue(function, x)) misfit("'" + e.text + "' of a negative number", e.place);
    const bool isBoolean = function == kCgaIsinfMath || function == kCgaIsnanMath;
    return valueOf(number(cgaMath(function, x, y), isBoolean));
  }
  const auto floorOf = [](const FormulaPtr& f) { return combined(kCodeFloor, f, number(1)); };
  const auto opposite = [](const FormulaPtr& f) { return combined(kCodeSubtract, number(0), f); };
  const bool isOnce = function == kCgaFloorMath || function == kCgaCeilMath || function == kCgaMaxMath ||
                      function == kCgaMinMath || a[0]->low >= 0;
  if (!isOnce && a[0]->draws) misfit("'" + e.text + "' of a random number that may be negative", e.place);
  switch (function) {
  case kCgaFloorMath: return done(floorOf(a[0]));
  case kCgaCeilMath: return done(opposite(floorOf(opposite(a[0]))));
  case kCgaMinMath: return done(combined(kCodeLeast, a[0], a[1]));
  case kCgaMaxMath: return done(combined(kCodeMost, a[0], a[1]));
  case kCgaAbsMath: return done(a[0]->low >= 0 ? a[0] : combined(kCodeMost, a[0], opposite(a[0])));
  case kCgaRintMath: {
    const auto round = [&](const FormulaPtr& f) { return floorOf(combined(kCodeAdd, f, number(0.5f))); };
    if (a[0]->low >= 0) return done(round(a[0]));
    return done(combined(kCodeSubtract, round(clamped(a[0])), round(clamped(opposite(a[0])))));
  }
  default: misfit("'" + e.text + "' of a value that is not known", e.place);
  }
}

} // namespace gpgp::spawn::cga
