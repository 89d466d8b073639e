#include "spawn/cga/graph_values.h"

#include "spawn/graph/operator_info.h"

#include <algorithm>
#include <cstdio>

namespace gpgp::spawn::cga {

using namespace shader;

namespace {
constexpr uint32_t kMostCodes = 600;

std::shared_ptr<Formula> leaf(Formula::Kind kind, float low, float high) {
  auto formula = std::make_shared<Formula>();
  formula->kind = kind;
  formula->low = low;
  formula->high = high;
  return formula;
}

/// Bounds of a code's result.
void bound(Formula& f) {
  const Formula &a = *f.a, &b = *f.b;
  f.low = -kLargest;
  f.high = kLargest;
  const auto among = [&](std::initializer_list<float> values) {
    f.low = std::min(values);
    f.high = std::max(values);
  };
  switch (f.index) {
  case kCodeAdd: among({add(a.low, b.low), add(a.high, b.high)}); break;
  case kCodeSubtract: among({subtract(a.low, b.high), subtract(a.high, b.low)}); break;
  case kCodeMultiply:
    among({multiply(a.low, b.low), multiply(a.low, b.high), multiply(a.high, b.low), multiply(a.high, b.high)});
    break;
  case kCodeDivide:
  case kCodeFloor:
    if (b.low > 0)
      among({shader::divide(a.low, b.low), shader::divide(a.low, b.high), shader::divide(a.high, b.low),
             shader::divide(a.high, b.high)});
    if (f.index == kCodeFloor && b.low > 0) among({settle(floor(f.low)), settle(floor(f.high))});
    break;
  case kCodeLeast: among({min(a.low, b.low), min(a.high, b.high)}); break;
  case kCodeMost: among({max(a.low, b.low), max(a.high, b.high)}); break;
  case kCodeNoise: among({0, 1}); break;
  default: among({0, 1}); // comparisons
  }
}
bool isBoolean(uint32_t code) { return code >= kCodeEqual && code <= kCodeOr; }
} // namespace

FormulaPtr number(float value, bool isBoolean) {
  auto formula = leaf(Formula::Kind::number, settle(value), settle(value));
  formula->value = settle(value);
  formula->isBoolean = isBoolean;
  return formula;
}

FormulaPtr sizeOf(uint32_t axis) {
  auto formula = leaf(Formula::Kind::size, 0, kLargest);
  formula->index = axis;
  formula->sizes = 1u << axis;
  return formula;
}

FormulaPtr axiomNumber(uint32_t index) {
  auto formula = leaf(Formula::Kind::axiom, 0, 1);
  formula->index = index;
  formula->stack = 2;
  formula->length = 3;
  return formula;
}

FormulaPtr drawn(uint32_t index) {
  auto formula = leaf(Formula::Kind::draw, 0, 1);
  formula->index = index;
  formula->draws = true;
  formula->stack = 2;
  formula->length = 3;
  return formula;
}

FormulaPtr fieldOf(const std::string& name, const FormulaPtr& x, const FormulaPtr& z) {
  auto formula = leaf(Formula::Kind::field, -kLargest, kLargest);
  formula->name = name;
  formula->isOfPlace = true;
  formula->a = x;
  formula->b = z;
  formula->stack = 2;
  formula->length = 3;
  if (!x) return formula;
  formula->sizes = x->sizes | z->sizes;
  formula->draws = x->draws || z->draws;
  formula->stack = std::max(x->stack, z->stack + 1);
  formula->length = x->length + z->length + 1;
  return formula->stack > kMaxStack || formula->length > kMostCodes ? nullptr : formula;
}

FormulaPtr combined(uint32_t code, const FormulaPtr& a, const FormulaPtr& b) {
  if (!a || !b) return nullptr;
  const bool isSymmetric = code == kCodeAdd || code == kCodeMultiply || code == kCodeLeast || code == kCodeMost ||
                           code == kCodeAnd || code == kCodeOr;
  const bool isDeeper = b->stack > a->stack && b->stack + 1 > 4 && !a->draws && !b->draws;
  if (isDeeper && code == kCodeSubtract) return combined(kCodeMultiply, combined(code, b, a), number(-1));
  constexpr std::pair<uint32_t, uint32_t> kMirrored[] = {{kCodeLess, kCodeGreater},
                                                         {kCodeGreater, kCodeLess},
                                                         {kCodeLessEqual, kCodeGreaterEqual},
                                                         {kCodeGreaterEqual, kCodeLessEqual}};
  for (const auto& [one, other] : kMirrored)
    if (isDeeper && code == one) return combined(other, b, a);
  if (isSymmetric && b->stack > a->stack && !a->draws && !b->draws) return combined(code, b, a); // takes less at once
  if (a->isNumber() && b->isNumber()) return number(combine(code, a->value, b->value, 0), isBoolean(code));
  if (b->isNumber() && b->value == 0 && (code == kCodeAdd || code == kCodeSubtract)) return a;
  if (a->isNumber() && a->value == 0 && code == kCodeAdd) return b;
  if (b->isNumber() && b->value == 1 && (code == kCodeMultiply || code == kCodeDivide)) return a;
  if (a->isNumber() && a->value == 1 && code == kCodeMultiply) return b;
  if ((code == kCodeDivide || code == kCodeFloor) && b->isNumber() && b->value == 0)
    return nullptr; // is an error there
  auto f = leaf(Formula::Kind::binary, 0, 0);
  f->index = code;
  f->a = a;
  f->b = b;
  f->sizes = a->sizes | b->sizes;
  f->draws = a->draws || b->draws;
  f->isOfPlace = a->isOfPlace || b->isOfPlace;
  f->isBoolean = isBoolean(code);
  f->stack = std::max(a->stack, b->stack + 1);
  f->length = a->length + b->length + 1;
  if (f->stack > kMaxStack || f->length > kMostCodes) return nullptr;
  bound(*f);
  return f;
}

FormulaPtr notOf(const FormulaPtr& condition) {
  if (!condition || condition->isNumber()) return condition ? number(1 - condition->value, true) : nullptr;
  const FormulaPtr result = combined(kCodeAdd, combined(kCodeMultiply, condition, number(-1)), number(1));
  if (!result) return nullptr;
  auto copy = std::make_shared<Formula>(*result);
  copy->isBoolean = true;
  return copy;
}

FormulaPtr asBoolean(const FormulaPtr& a) {
  if (!a || a->isBoolean) return a;
  if (a->isNumber()) return number(a->value != 0 ? 1.0f : 0.0f, true);
  if (a->draws) return nullptr;
  // Equality of graphs tolerates rounding.
  return combined(kCodeOr, combined(kCodeLess, a, number(0)), combined(kCodeGreater, a, number(0)));
}

FormulaPtr selected(const FormulaPtr& condition, const FormulaPtr& yes, const FormulaPtr& no) {
  if (!condition || !yes || !no) return nullptr;
  if (condition->isNumber()) return condition->value != 0 ? yes : no;
  if (yes->isNumber() && no->isNumber() && yes->value == no->value) return yes;
  if (condition->draws || yes->draws || no->draws) return nullptr;
  const FormulaPtr chosen = asBoolean(condition);
  const bool areBooleans = yes->isBoolean && no->isBoolean;
  FormulaPtr result;
  if (areBooleans && yes->isNumber() && no->isNumber())
    result = yes->value != 0 ? chosen : notOf(chosen);
  else
    result = combined(kCodeAdd, combined(kCodeMultiply, chosen, yes), combined(kCodeMultiply, notOf(chosen), no));
  if (!result || result->isNumber()) return result;
  auto copy = std::make_shared<Formula>(*result);
  copy->low = std::min(yes->low, no->low);
  copy->high = std::max(yes->high, no->high);
  copy->isBoolean = areBooleans;
  return copy;
}

FormulaPtr clamped(const FormulaPtr& a) { return !a || a->low >= 0 ? a : combined(kCodeMost, a, number(0)); }

FormulaPtr renamed(const FormulaPtr& a, const std::array<uint32_t, 3>& axes) {
  if (a && a->isOfPlace) return nullptr; // a component is at another place
  if (!a || !a->sizes) return a;
  if (a->kind == Formula::Kind::size) return axes[a->index] < 3 ? sizeOf(axes[a->index]) : nullptr;
  const FormulaPtr left = renamed(a->a, axes), right = renamed(a->b, axes);
  if (!left || !right) return nullptr;
  auto copy = std::make_shared<Formula>(*a);
  copy->a = left;
  copy->b = right;
  copy->sizes = left->sizes | right->sizes;
  return copy;
}

std::string text(float value) {
  char buffer[48];
  std::snprintf(buffer, sizeof buffer, "%.9g", static_cast<double>(value));
  return buffer;
}

std::string text(const FormulaPtr& a) {
  switch (a->kind) {
  case Formula::Kind::number: return text(a->value);
  case Formula::Kind::size: return std::string("ShapeSize(") + "XYZ"[a->index] + ")";
  case Formula::Kind::axiom: return "Noise(ShapeCustomAttribute()," + std::to_string(a->index) + ")";
  case Formula::Kind::draw: return "Rand(0,1)";
  case Formula::Kind::field:
    return "Field(" + a->name + (a->a ? "," + text(a->a) + "," + text(a->b) : std::string()) + ")";
  case Formula::Kind::binary: break;
  }
  const Binary& binary = binaryOf(a->index);
  if (!binary.precedence) return std::string(binary.spelling) + "(" + text(a->a) + "," + text(a->b) + ")";
  return "Exp(" + text(a->a) + " " + binary.spelling + " " + text(a->b) + ")";
}

namespace {
bool inOrder(const FormulaPtr& a, uint32_t& next) {
  if (!a->draws) return true;
  if (a->kind == Formula::Kind::draw) return a->index == next++;
  return inOrder(a->a, next) && inOrder(a->b, next); // a field that draws has both
}
} // namespace

bool drawsInOrder(const FormulaPtr& a, uint32_t count) {
  uint32_t next = 0;
  return inOrder(a, next) && next == count;
}

} // namespace gpgp::spawn::cga
