#include "spawn/language/expressions.h"

#include "core/suggest.h"
#include "spawn/language/spellings.h"
#include "spawn/shared/expression.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gpgp::spawn {
namespace {
using namespace shader;

std::string plural(size_t count, const char* noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// Whether all arguments could be read.
bool isWhole(const Expression& e) {
  return std::none_of(e.arguments.begin(), e.arguments.end(),
                      [](const Expression& a) { return a.kind == ExpressionKind::broken; });
}
} // namespace

bool isUsable(float value) { return std::abs(value) <= kLargest; } // no NaN is
bool staysUsable(uint32_t op, double a, double b) {
  const double exact = op == kCodeAdd        ? a + b
                       : op == kCodeSubtract ? a - b
                       : op == kCodeMultiply ? a * b
                       : op == kCodeDivide   ? a / b
                                             : 0;
  return !(std::abs(exact) > double(kLargest));
}

std::optional<uint32_t> axisOf(const Expression& expression, Diagnostics& diagnostics) {
  if (expression.kind == ExpressionKind::name) {
    if (expression.name == "X") return 0;
    if (expression.name == "Y") return 1;
    if (expression.name == "Z") return 2;
  }
  if (expression.kind != ExpressionKind::broken) diagnostics.error(expression.place, "expected an axis: X, Y or Z");
  return std::nullopt;
}

ExpressionCompiler::Code ExpressionCompiler::number(float value) const {
  Code code;
  code.isConstant = true;
  code.value = settle(value);
  code.stack = 1;
  code.words = {kCodeNumber, floatBitsToUint(code.value)};
  return code;
}

ExpressionCompiler::Code ExpressionCompiler::attribute(const Expression& expression, uint32_t code, uint32_t axes) {
  if (expression.arguments.size() != axes) {
    if (!isWhole(expression)) return number(0);
    const char* wanted = axes == 0 ? "no argument" : axes == 1 ? "an axis" : "an axis and a component";
    diagnostics_.error(expression.place, expression.name + " takes " + wanted + ", found " +
                                             plural(expression.arguments.size(), "argument"));
    return number(0);
  }
  bool known = true;
  for (uint32_t i = 0; i < axes; ++i) {
    const auto axis = axisOf(expression.arguments[i], diagnostics_);
    known = known && axis;
    code += (axes == 2 && i == 0 ? 3 : 1) * axis.value_or(0);
  }
  if (!known) return number(0);
  Code result;
  result.words = {code};
  result.seesView = code >= kCodeView;
  result.stack = 1;
  return result;
}

float ExpressionCompiler::fold(Place place, uint32_t op, float left, float right) {
  if (!staysUsable(op, left, right)) {
    diagnostics_.error(place, std::string("this becomes too large; ") + kUsableNumbers);
    return 0;
  }
  return combine(op, left, right, 0);
}

ExpressionCompiler::Code ExpressionCompiler::join(Place place, uint32_t op, Code left, Code right) {
  if ((op == kCodeDivide || op == kCodeFloor) && right.isConstant && right.value == 0) { // whatever the shape is
    diagnostics_.error(place, "this divides by 0");
    return number(0);
  }
  if (left.isConstant && right.isConstant && op != kCodeRandom) return number(fold(place, op, left.value, right.value));
  return append(place, op, std::move(left), right);
}

ExpressionCompiler::Code ExpressionCompiler::append(Place place, uint32_t op, Code left, const Code& right) {
  Code result;
  result.words = std::move(left.words);
  result.words.insert(result.words.end(), right.words.begin(), right.words.end());
  result.words.push_back(op);
  result.seesView = left.seesView || right.seesView;
  result.stack = std::max(left.stack, right.stack + 1);
  if (result.stack > kMaxStack) {
    diagnostics_.error(place, "this expression needs more than " + std::to_string(kMaxStack) +
                                  " values at once; write its inner parts first");
    return number(0);
  }
  return result;
}

/// Field(name) or Field(name, x, z)
ExpressionCompiler::Code ExpressionCompiler::field(const Expression& e) {
  const size_t count = e.arguments.size();
  if ((count != 1 && count != 3) || e.arguments[0].kind != ExpressionKind::name) {
    const bool isNamed = count && e.arguments[0].kind == ExpressionKind::name;
    if (isWhole(e))
      diagnostics_.error(e.place, e.name + " takes the name of a field, or that, x and z; found " +
                                      (count && !isNamed ? "no name" : plural(count, "argument")));
    for (size_t i = isNamed ? 1 : 0; i < count; ++i) compile(e.arguments[i]);
    return number(0);
  }
  Code x = count == 3 ? compile(e.arguments[1]) : number(0);
  const Code z = count == 3 ? compile(e.arguments[2]) : number(0);
  const uint32_t field = fieldNamed(graph_, e.arguments[0].name);
  if (field != kNoField) return append(e.place, kCodeField + field, std::move(x), z);
  diagnostics_.error(e.place, kTooManyFields);
  return number(0);
}

ExpressionCompiler::Code ExpressionCompiler::call(const Expression& e) {
  const auto wants = [&](size_t count) {
    if (e.arguments.size() == count) return true;
    if (isWhole(e))
      diagnostics_.error(e.place, e.name + " takes " + plural(count, "argument") + ", found " +
                                      std::to_string(e.arguments.size()));
    for (const Expression& argument : e.arguments) compile(argument);
    return false;
  };
  if (e.name == "Exp") return wants(1) ? compile(e.arguments[0]) : number(0);
  if (e.name == GPGP_FIELD_SPELLING) return field(e);
  for (const Binary& binary : kBinaries) {
    if (binary.precedence || e.name != binary.spelling) continue;
    if (!wants(2)) return number(0);
    Code left = compile(e.arguments[0]);
    return join(e.place, binary.code, std::move(left), compile(e.arguments[1]));
  }
  for (const Attribute& a : kAttributes)
    if (e.name == a.name) return attribute(e, a.code, a.axes);
  std::string expected;
  forFunctionNames([&](const char* name) {
    const bool isLast = name == std::end(kAttributes)[-1].name;
    expected.append(expected.empty() ? "" : isLast ? " or " : ", ").append(name);
  });
  diagnostics_.error(e.place, "'" + e.name + "' is not a function; expected " + expected + suggestionFor(e.name, true));
  for (const Expression& argument : e.arguments)
    if (argument.kind != ExpressionKind::name) compile(argument); // a name may be an axis
  return number(0);
}

/// What may be meant instead of a var's or function's name.
std::string ExpressionCompiler::suggestionFor(const std::string& name, bool isCall) const {
  if (!diagnostics_.takesErrors()) return {};
  core::Suggestion suggestion(name);
  if (!isCall)
    for (const auto& [candidate, value] : variables_) suggestion.offer(candidate);
  forFunctionNames([&](const char* candidate) { suggestion.offer(candidate); });
  return suggestion.text();
}

ExpressionCompiler::Code ExpressionCompiler::compile(const Expression& e) {
  switch (e.kind) {
  case ExpressionKind::number:
    if (!isUsable(e.number)) {
      diagnostics_.error(e.place, std::string("this is too large; ") + kUsableNumbers);
      return number(0);
    }
    return number(e.number);
  case ExpressionKind::name: {
    const auto variable = variables_.find(e.name);
    if (variable != variables_.end()) return number(variable->second);
    diagnostics_.error(e.place, "there is no var '" + e.name + "'; expected a value" + suggestionFor(e.name, false));
    return number(0);
  }
  case ExpressionKind::pair: diagnostics_.error(e.place, "expected one value, found a pair (x, y)"); return number(0);
  case ExpressionKind::call: return call(e);
  case ExpressionKind::broken: return number(0);
  case ExpressionKind::binary: break;
  }
  Code left = compile(e.arguments[0]);
  return join(e.place, e.op, std::move(left), compile(e.arguments[1]));
}

Parameter ExpressionCompiler::parameter(const Expression& expression) { return parameter(compile(expression)); }
Parameter ExpressionCompiler::drawnParameter() { return parameter(join({}, kCodeRandom, number(0), number(1))); }

Parameter ExpressionCompiler::parameter(Code code) {
  if (code.isConstant) return {kParameterConstant, floatBitsToUint(code.value)};
  const bool sees = code.seesView;
  if (code.words.size() == 1 && !sees) return {kParameterAttribute, code.words[0]};
  code.words.push_back(kCodeEnd);
  const auto [program, isNew] = programs_.try_emplace(code.words, static_cast<uint32_t>(graph_.code.size()));
  if (isNew) graph_.code.insert(graph_.code.end(), code.words.begin(), code.words.end());
  return {sees ? kParameterView : kParameterProgram, program->second};
}

float ExpressionCompiler::constant(const Expression& expression, const char* what) {
  const Code code = compile(expression);
  if (!code.isConstant) diagnostics_.error(expression.place, std::string(what) + " must not depend on the shape");
  return code.value;
}

} // namespace gpgp::spawn
