// Numbers and vectors. What depends on the shape becomes a formula, with the operators that the graph has for them.
#include "spawn/gml/machine.h"

#include "core/math.h"
#include "spawn/shared/expression.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn::gml {
using namespace shader;

namespace {
Expression expressionOf(const Number& number, Place place) {
  if (number.formula) return number.formula->expression;
  Expression e;
  e.place = place;
  e.number = number.known;
  return e;
}

void pushOr(Machine& m, const std::optional<Number>& number) {
  if (number)
    m.push(*number);
  else
    m.push(Broken{});
}

const Vector* vectorOf(const Value& value) {
  const auto* v = std::get_if<std::shared_ptr<const Vector>>(&value);
  return v ? v->get() : nullptr;
}
void pushVector(Machine& m, const Vector& vector) { m.push(std::make_shared<const Vector>(vector)); }

/// Of numbers, of vectors of the same size; of a vector and a number where isScaling.
template <uint32_t op, bool isScaling> void arithmetic(Machine& m, Arguments& a) {
  const Number *x = std::get_if<Number>(&a[0]), *y = std::get_if<Number>(&a[1]);
  if (x && y) return pushOr(m, combined(m, op, *x, *y));
  const Vector *v = vectorOf(a[0]), *w = vectorOf(a[1]);
  const bool fits = isScaling ? (v && y) || (op == kCodeMultiply && x && w) : v && w && v->size == w->size;
  if (!fits) {
    m.fail(std::string(m.operatorName()) + " takes two numbers or " +
           (isScaling ? "a vector and a number" : "two vectors of the same size") + ", found " + kindOf(a[0]) +
           " and " + kindOf(a[1]));
    return m.push(Broken{});
  }
  Vector result = v ? *v : *w;
  for (uint32_t i = 0; i < result.size; ++i) {
    const auto part = combined(m, op, v ? v->components[i] : *x, w ? w->components[i] : *y);
    if (!part) return m.push(Broken{});
    result.components[i] = *part;
  }
  pushVector(m, result);
}

template <uint32_t op> void compare(Machine& m, Arguments& a) {
  const Number *x = std::get_if<Number>(&a[0]), *y = std::get_if<Number>(&a[1]);
  if (x && y) return pushOr(m, combined(m, op, *x, *y));
  bool same = false, known = (op == kCodeEqual || op == kCodeNotEqual) && a[0].index() == a[1].index();
  const Text* text = std::get_if<Text>(&a[0]);
  const Name* name = std::get_if<Name>(&a[0]);
  if (known && text)
    same = *text->text == *std::get<Text>(a[1]).text;
  else if (known && name)
    same = name->name == std::get<Name>(a[1]).name;
  else
    known = false;
  if (!known) {
    m.fail(std::string(m.operatorName()) + " cannot compare " + kindOf(a[0]) + " and " + kindOf(a[1]));
    return m.push(Broken{});
  }
  m.pushNumber(same == (op == kCodeEqual) ? 1.0f : 0.0f);
}

template <uint32_t op> void both(Machine& m, Arguments& a) {
  pushOr(m, combined(m, op, std::get<Number>(a[0]), std::get<Number>(a[1])));
}

/// Of numbers that are known: the graph has no such function.
template <class Function> void known(Machine& m, Arguments& a, Function function) {
  const float x = std::get<Number>(a[0]).known, y = a.size() > 1 ? std::get<Number>(a[1]).known : 0;
  const double result = function(double(x), double(y));
  if (std::abs(result) <= double(kLargest)) return m.pushNumber(settle(static_cast<float>(result)));
  m.fail(std::string("this is not a number, or becomes too large; ") + kUsableNumbers);
  m.push(Broken{});
}

void divideWhole(Machine& m, Arguments& a, bool rest) {
  if (std::get<Number>(a[1]).known == 0) {
    m.fail("this divides by 0");
    return m.push(Broken{});
  }
  known(m, a, [&](double x, double y) { return rest ? std::fmod(x, y) : std::trunc(x / y); });
}

void drawn(Machine& m, Arguments& a) {
  const auto number = combined(m, kCodeRandom, std::get<Number>(a[0]), std::get<Number>(a[1]));
  if (!number) return m.push(Broken{});
  auto formula = std::make_shared<Formula>(*number->formula);
  formula->draws.push_back({m.newDraw(), m.place()});
  m.push(Number{0, formula});
}

template <uint32_t size> void makeVector(Machine& m, Arguments& a) {
  Vector vector;
  vector.size = size;
  for (uint32_t i = 0; i < size; ++i) vector.components[i] = std::get<Number>(a[i]);
  pushVector(m, vector);
}

template <uint32_t component> void componentOf(Machine& m, Arguments& a) {
  const Vector* v = vectorOf(a[0]);
  if (v && component < v->size) return m.push(v->components[component]);
  m.fail(std::string(m.operatorName()) + " takes a vector with this component, found " + kindOf(a[0]));
  m.push(Broken{});
}

void dot(Machine& m, Arguments& a) {
  const Vector *v = vectorOf(a[0]), *w = vectorOf(a[1]);
  if (!v || !w || v->size != w->size) {
    m.fail(std::string("dot takes two vectors of the same size, found ") + kindOf(a[0]) + " and " + kindOf(a[1]));
    return m.push(Broken{});
  }
  Number sum;
  for (uint32_t i = 0; i < v->size; ++i) {
    const auto product = combined(m, kCodeMultiply, v->components[i], w->components[i]);
    const auto next = product ? combined(m, kCodeAdd, sum, *product) : std::nullopt;
    if (!next) return m.push(Broken{});
    sum = *next;
  }
  m.push(sum);
}
} // namespace

std::optional<Number> combined(Machine& m, uint32_t op, const Number& a, const Number& b) {
  if (op == kCodeDivide && !b.formula && b.known == 0) {
    m.fail("this divides by 0");
    return std::nullopt;
  }
  if (!a.formula && !b.formula && op != kCodeRandom) {
    if (!staysUsable(op, a.known, b.known)) {
      m.fail(std::string("this becomes too large; ") + kUsableNumbers);
      return std::nullopt;
    }
    return Number{combine(op, a.known, b.known, 0), nullptr};
  }
  auto formula = std::make_shared<Formula>();
  formula->size = (a.formula ? a.formula->size : 1) + (b.formula ? b.formula->size : 1);
  if (formula->size > Machine::kMaxFormula) {
    m.fail("this number is made of more than " + std::to_string(Machine::kMaxFormula) + " others");
    return std::nullopt;
  }
  if (!m.spend(formula->size)) return std::nullopt;
  formula->expression.kind = ExpressionKind::binary;
  formula->expression.op = op;
  if (op == kCodeRandom) {
    formula->expression.kind = ExpressionKind::call;
    formula->expression.name = binaryOf(kCodeRandom).spelling;
  }
  formula->expression.place = m.place();
  formula->expression.arguments = {expressionOf(a, m.place()), expressionOf(b, m.place())};
  for (const Number* number : {&a, &b}) {
    if (!number->formula) continue;
    formula->reads.insert(formula->reads.end(), number->formula->reads.begin(), number->formula->reads.end());
    formula->draws.insert(formula->draws.end(), number->formula->draws.begin(), number->formula->draws.end());
  }
  return Number{0, formula};
}

std::span<const Builtin> numberOperators() {
  static constexpr Builtin kOperators[] = {
      {"add", "**", 1, arithmetic<kCodeAdd, false>},
      {"sub", "**", 1, arithmetic<kCodeSubtract, false>},
      {"mul", "**", 1, arithmetic<kCodeMultiply, true>},
      {"div", "**", 1, arithmetic<kCodeDivide, true>},
      {"idiv", "kk", 1, [](Machine& m, Arguments& a) { divideWhole(m, a, false); }},
      {"mod", "kk", 1, [](Machine& m, Arguments& a) { divideWhole(m, a, true); }},
      {"neg", "n", 1,
       [](Machine& m, Arguments& a) { pushOr(m, combined(m, kCodeSubtract, {}, std::get<Number>(a[0]))); }},
      {"abs", "k", 1, [](Machine& m, Arguments& a) { known(m, a, [](double x, double) { return std::abs(x); }); }},
      {"floor", "k", 1, [](Machine& m, Arguments& a) { known(m, a, [](double x, double) { return std::floor(x); }); }},
      {"ceiling", "k", 1, [](Machine& m, Arguments& a) { known(m, a, [](double x, double) { return std::ceil(x); }); }},
      {"round", "k", 1,
       [](Machine& m, Arguments& a) { known(m, a, [](double x, double) { return std::floor(x + 0.5); }); }},
      {"sqrt", "k", 1, [](Machine& m, Arguments& a) { known(m, a, [](double x, double) { return std::sqrt(x); }); }},
      {"sin", "k", 1,
       [](Machine& m, Arguments& a) { m.pushNumber(sineCosineDegrees(std::get<Number>(a[0]).known).x); }},
      {"cos", "k", 1,
       [](Machine& m, Arguments& a) { m.pushNumber(sineCosineDegrees(std::get<Number>(a[0]).known).y); }},
      {"min", "kk", 1,
       [](Machine& m, Arguments& a) { known(m, a, [](double x, double y) { return std::min(x, y); }); }},
      {"max", "kk", 1,
       [](Machine& m, Arguments& a) { known(m, a, [](double x, double y) { return std::max(x, y); }); }},
      {"eq", "**", 1, compare<kCodeEqual>},
      {"ne", "**", 1, compare<kCodeNotEqual>},
      {"lt", "nn", 1, both<kCodeLess>},
      {"gt", "nn", 1, both<kCodeGreater>},
      {"le", "nn", 1, both<kCodeLessEqual>},
      {"ge", "nn", 1, both<kCodeGreaterEqual>},
      {"and", "nn", 1, both<kCodeAnd>},
      {"or", "nn", 1, both<kCodeOr>},
      {"not", "n", 1, [](Machine& m, Arguments& a) { pushOr(m, combined(m, kCodeEqual, std::get<Number>(a[0]), {})); }},
      {"true", "", 1, [](Machine& m, Arguments&) { m.pushNumber(1); }},
      {"false", "", 1, [](Machine& m, Arguments&) { m.pushNumber(0); }},
      {"random", "nn", 1, drawn},
      {"vector2", "nn", 1, makeVector<2>},
      {"vector3", "nnn", 1, makeVector<3>},
      {"getx", "*", 1, componentOf<0>},
      {"gety", "*", 1, componentOf<1>},
      {"getz", "*", 1, componentOf<2>},
      {"dot", "**", 1, dot},
  };
  return kOperators;
}

} // namespace gpgp::spawn::gml
