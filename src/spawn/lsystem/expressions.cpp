// Expressions of .lsys files: precedence from ?: over || && == < + * to unary operators and ^.
#include "core/suggest.h"
#include "spawn/lsystem/format.h"
#include "spawn/lsystem/scanner.h"

#include <charconv>
#include <cmath>

namespace gpgp::spawn::lsystem {
namespace {

using namespace shader;
constexpr uint32_t kMostNesting = 64; ///< of parentheses and operators

struct BinaryOperator {
  std::string_view spelling;
  size_t level;
  uint32_t code;
};
// Longer spellings come first.
constexpr BinaryOperator kBinary[] = {
    {"||", 0, kLsysOr},        {"&&", 1, kLsysAnd},          {"==", 2, kLsysEqual},  {"!=", 2, kLsysNotEqual},
    {"<=", 3, kLsysLessEqual}, {">=", 3, kLsysGreaterEqual}, {"=", 2, kLsysEqual},   {"|", 0, kLsysOr},
    {"&", 1, kLsysAnd},        {"<", 3, kLsysLess},          {">", 3, kLsysGreater}, {"+", 4, kLsysAdd},
    {"-", 4, kLsysSubtract},   {"*", 5, kLsysMultiply},      {"/", 5, kLsysDivide},  {"%", 5, kLsysModulo},
};
constexpr size_t kLevels = 6;

struct Function {
  std::string_view name;
  size_t arguments;
  uint32_t code;
};
constexpr Function kFunctions[] = {
    {"sin", 1, kLsysSin},     {"cos", 1, kLsysCos},     {"tan", 1, kLsysTan},     {"asin", 1, kLsysAsin},
    {"acos", 1, kLsysAcos},   {"atan", 1, kLsysAtan},   {"atan2", 2, kLsysAtan2}, {"sqrt", 1, kLsysSqrt},
    {"exp", 1, kLsysExp},     {"log", 1, kLsysLog},     {"abs", 1, kLsysAbs},     {"floor", 1, kLsysFloor},
    {"ceil", 1, kLsysCeil},   {"round", 1, kLsysRound}, {"sign", 1, kLsysSign},   {"min", 2, kLsysMin},
    {"max", 2, kLsysMax},     {"pow", 2, kLsysPower},   {"mod", 2, kLsysModulo},  {"rand", 0, kLsysRandom},
    {"rand", 2, kLsysRandom}, {"ran", 1, kLsysRandom},  {"nran", 2, kLsysNormal},
};

Expression operation(uint32_t code, Place place, std::vector<Expression> operands) {
  Expression e;
  e.kind = Expression::Kind::operation;
  e.code = code;
  e.operands = std::move(operands);
  e.place = place;
  return e;
}
Expression pair(uint32_t code, Place place, Expression a, Expression b) {
  std::vector<Expression> operands;
  operands.push_back(std::move(a));
  operands.push_back(std::move(b));
  return operation(code, place, std::move(operands));
}

/// What the functions that draw are made of.
Expression drawing(const Function& f, Place place, std::vector<Expression> arguments) {
  Expression draw = operation(f.code, place, {});
  if (arguments.empty()) return draw;
  if (arguments.size() == 1) return pair(kLsysMultiply, place, std::move(draw), std::move(arguments[0]));
  if (f.code == kLsysNormal)
    return pair(kLsysAdd, place, arguments[0], pair(kLsysMultiply, place, std::move(draw), arguments[1]));
  Expression range = pair(kLsysSubtract, place, arguments[1], arguments[0]);
  return pair(kLsysAdd, place, arguments[0], pair(kLsysMultiply, place, std::move(draw), std::move(range)));
}

} // namespace

Expression Reader::expression() { return choice(0); }

Expression Reader::choice(uint32_t depth) {
  Expression condition = binary(0, depth);
  if (failed_ || peek() != '?') return condition;
  const Place at = place();
  take('?');
  Expression yes = choice(depth + 1);
  if (!take(':')) error("expected ':' between the two values of '?'; found " + found());
  Expression no = choice(depth + 1);
  std::vector<Expression> operands;
  operands.push_back(std::move(condition));
  operands.push_back(std::move(yes));
  operands.push_back(std::move(no));
  return operation(kLsysSelect, at, std::move(operands));
}

Expression Reader::binary(size_t level, uint32_t depth) {
  if (level == kLevels) return unary(depth);
  if (depth > kMostNesting) error("the expression nests too deep");
  if (failed_) return {};
  Expression left = binary(level + 1, depth);
  uint32_t length = 0;
  while (!failed_) {
    blanks();
    const Place at = place();
    const BinaryOperator* found = nullptr;
    for (const BinaryOperator& op : kBinary)
      if (!found && line_.text.compare(at_, op.spelling.size(), op.spelling) == 0 && at_ + op.spelling.size() <= end_)
        found = &op;
    if (!found || found->level != level) break;
    at_ += found->spelling.size();
    if (++length > 256) error("the expression is too long");
    Expression right = binary(level + 1, depth);
    left = pair(found->code, at, std::move(left), std::move(right));
  }
  return left;
}

Expression Reader::unary(uint32_t depth) {
  if (depth > kMostNesting) error("the expression nests too deep");
  if (failed_) return {};
  const char c = peek();
  const Place at = place();
  if (c == '-' || c == '!') {
    take(c);
    std::vector<Expression> operands;
    operands.push_back(unary(depth + 1));
    return operation(c == '-' ? kLsysNegate : kLsysNot, at, std::move(operands));
  }
  if (c == '+') {
    take(c);
    return unary(depth + 1);
  }
  Expression base = primary(depth);
  if (failed_ || peek() != '^') return base;
  const Place power = place();
  take('^');
  return pair(kLsysPower, power, std::move(base), unary(depth + 1));
}

Expression Reader::primary(uint32_t depth) {
  const char c = peek();
  Expression e;
  e.place = place();
  if (take('(')) {
    e = choice(depth + 1);
    if (!take(')')) error("expected ')'; found " + found());
    return e;
  }
  if ((c >= '0' && c <= '9') || c == '.') {
    const char* first = line_.text.data() + at_;
    const auto [rest, code] = std::from_chars(first, line_.text.data() + end_, e.number);
    if (code != std::errc() || !(std::abs(e.number) <= 1e30f)) error("a number is not readable, or too large");
    at_ += static_cast<size_t>(rest - first);
    return e;
  }
  e.name = identifier();
  if (e.name.empty()) {
    error("expected a number, a name or '('; found " + found());
    return e;
  }
  e.kind = Expression::Kind::name;
  if (!take('(')) return e;
  std::vector<Expression> arguments;
  if (!take(')')) {
    do arguments.push_back(choice(depth + 1));
    while (!failed_ && take(','));
    if (!take(')')) error("expected ',' or ')' in the arguments of " + e.name + "; found " + found());
  }
  if (failed_) return e;
  const Function* sameName = nullptr;
  std::string counts;
  for (const Function& f : kFunctions) {
    if (f.name != e.name) continue;
    if (f.arguments == arguments.size()) {
      if (f.code == kLsysRandom || f.code == kLsysNormal) return drawing(f, e.place, std::move(arguments));
      return operation(f.code, e.place, std::move(arguments));
    }
    sameName = &f;
    counts += (counts.empty() ? "" : " or ") + std::to_string(f.arguments);
  }
  if (sameName) {
    errorAt(e.place, e.name + " takes " + counts + (counts == "1" ? " argument" : " arguments") + "; found " +
                         std::to_string(arguments.size()));
    return e;
  }
  core::Suggestion suggestion(e.name);
  for (const Function& f : kFunctions) suggestion.offer(f.name);
  errorAt(e.place, "there is no function '" + e.name + "'" + suggestion.text());
  return e;
}

} // namespace gpgp::spawn::lsystem
