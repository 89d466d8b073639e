// Expressions of .lsys files: precedence from ?: over || && == < + * to unary operators and ^.
#include "core/suggest.h"
#include "spawn/lsystem/format.h"
#include "spawn/lsystem/scanner.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string>

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
    {"or", 0, kLsysOr},     {"and", 1, kLsysAnd},     {"||", 0, kLsysOr},        {"&&", 1, kLsysAnd},
    {"==", 2, kLsysEqual},  {"!=", 2, kLsysNotEqual}, {"<=", 3, kLsysLessEqual}, {">=", 3, kLsysGreaterEqual},
    {"=", 2, kLsysEqual},   {"|", 0, kLsysOr},        {"&", 1, kLsysAnd},        {"<", 3, kLsysLess},
    {">", 3, kLsysGreater}, {"+", 4, kLsysAdd},       {"-", 4, kLsysSubtract},   {"*", 5, kLsysMultiply},
    {"/", 5, kLsysDivide},  {"%", 5, kLsysModulo},
};
constexpr size_t kLevels = 6;

struct Function {
  std::string_view name;
  size_t arguments;
  uint32_t code;
};
constexpr Function kFunctions[] = {
    {"sin", 1, kLsysSin},       {"cos", 1, kLsysCos},       {"tan", 1, kLsysTan},      {"asin", 1, kLsysAsin},
    {"acos", 1, kLsysAcos},     {"atan", 1, kLsysAtan},     {"atan2", 2, kLsysAtan2},  {"sqrt", 1, kLsysSqrt},
    {"exp", 1, kLsysExp},       {"log", 1, kLsysLog},       {"abs", 1, kLsysAbs},      {"floor", 1, kLsysFloor},
    {"ceil", 1, kLsysCeil},     {"round", 1, kLsysRound},   {"sign", 1, kLsysSign},    {"min", 2, kLsysMin},
    {"not", 1, kLsysNot},       {"ln", 1, kLsysLog},        {"fabs", 1, kLsysAbs},     {"random", 0, kLsysRandom},
    {"max", 2, kLsysMax},       {"pow", 2, kLsysPower},     {"mod", 2, kLsysModulo},   {"rand", 0, kLsysRandom},
    {"rand", 2, kLsysRandom},   {"ran", 1, kLsysRandom},    {"nran", 2, kLsysNormal},  {"trunc", 1, kLsysTruncate},
    {"random", 2, kLsysRandom}, {"random", 1, kLsysRandom}, {"fix", 1, kLsysTruncate}, {"fmod", 2, kLsysModulo},
    {"fmin", 2, kLsysMin},      {"fmax", 2, kLsysMax},      {"int", 1, kLsysTruncate},
};

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

Expression numberOf(float value, Place place) {
  Expression e;
  e.number = value;
  e.place = place;
  return e;
}

/// An integer of C.
Expression truncated(Expression e) {
  const Place place = e.place;
  std::vector<Expression> operands;
  operands.push_back(std::move(e));
  Expression result = operation(kLsysTruncate, place, std::move(operands));
  result.isWhole = true;
  return result;
}

/// Names of C's functions with 'f' behind them lose it, and angles become degrees.
void inDegrees(Expression& e, std::vector<Expression>& arguments) {
  for (const std::string_view name : {"sinf", "cosf", "tanf", "asinf", "acosf", "atanf", "atan2f", "sqrtf", "expf",
                                      "logf", "fabsf", "floorf", "ceilf", "powf", "fmodf", "fminf", "fmaxf"})
    if (e.name == name) e.name.pop_back();
  if (arguments.size() == 1 && (e.name == "sin" || e.name == "cos" || e.name == "tan"))
    arguments[0] = pair(kLsysMultiply, e.place, std::move(arguments[0]), numberOf(57.2957795f, e.place));
}

} // namespace

void substitute(Expression& e, const std::map<std::string, Expression>& values) {
  if (e.kind == Expression::Kind::name) {
    if (const auto found = values.find(e.name); found != values.end()) e = Expression(found->second);
    return;
  }
  for (Expression& operand : e.operands) substitute(operand, values);
}

Expression Reader::expression() { return choice(0); }

Expression Reader::choice(uint32_t depth) {
  Expression condition = binary(0, depth);
  if (failed_ || peek() != '?') return condition;
  const Place at = place();
  take('?');
  Expression yes = choice(depth + 1);
  if (!take(':')) error("expected ':' between the two values of '?'; found " + found());
  Expression no = choice(depth + 1);
  const bool isWhole = yes.isWhole && no.isWhole;
  std::vector<Expression> operands;
  operands.push_back(std::move(condition));
  operands.push_back(std::move(yes));
  operands.push_back(std::move(no));
  Expression result = operation(kLsysSelect, at, std::move(operands));
  result.isWhole = isWhole;
  return result;
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
    for (const BinaryOperator& op : kBinary) {
      const size_t behind = at_ + op.spelling.size();
      if (found || line_.text.compare(at_, op.spelling.size(), op.spelling) != 0 || behind > end_) continue;
      const bool isWord = op.spelling[0] == 'a' || op.spelling[0] == 'o';
      if (!isWord || behind == end_ || line_.text[behind] == ' ' || line_.text[behind] == '(') found = &op;
    }
    if (!found || found->level != level) break;
    at_ += found->spelling.size();
    if (++length > 256) error("the expression is too long");
    Expression right = binary(level + 1, depth);
    const bool areWhole = left.isWhole && right.isWhole;
    left = pair(found->code, at, std::move(left), std::move(right));
    if (!isC()) continue;
    left.isWhole = areWhole || (found->code >= kLsysEqual && found->code <= kLsysOr);
    if (found->code == kLsysDivide && areWhole) left = truncated(std::move(left));
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
    const bool isWhole = operands[0].isWhole || c == '!';
    Expression result = operation(c == '-' ? kLsysNegate : kLsysNot, at, std::move(operands));
    result.isWhole = isWhole;
    return result;
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
    if (isC()) { // (int)x
      const size_t before = at_;
      std::string type = identifier();
      while (!type.empty() && isTypeName(type) && peek() != ')') type = identifier();
      if (isTypeName(type) && take(')')) {
        Expression value = unary(depth + 1);
        if (isWholeType(type)) return value.isWhole ? value : truncated(std::move(value));
        value.isWhole = false;
        return value;
      }
      at_ = before;
    }
    e = choice(depth + 1);
    if (!take(')')) error("expected ')'; found " + found());
    return e;
  }
  if ((c >= '0' && c <= '9') || c == '.') {
    const char* first = line_.text.data() + at_;
    const auto [rest, code] = std::from_chars(first, line_.text.data() + end_, e.number);
    if (code != std::errc() || !(std::abs(e.number) <= 1e30f)) error("a number is not readable, or too large");
    e.isWhole = std::string_view(first, static_cast<size_t>(rest - first)).find_first_of(".eE") == std::string::npos;
    at_ += static_cast<size_t>(rest - first);
    constexpr std::string_view kSuffixes = "fFlLuU";
    for (; isC() && at_ < end_ && kSuffixes.find(line_.text[at_]) != std::string_view::npos; ++at_)
      if (line_.text[at_] == 'f' || line_.text[at_] == 'F') e.isWhole = false;
    return e;
  }
  if ((c == '"' || c == '\'') && isC()) { // a character counts as its number
    const bool isCharacter = c == '\'' && at_ + 2 < end_ && line_.text[at_ + 2] == '\'';
    if (isCharacter) {
      e.number = static_cast<float>(static_cast<unsigned char>(line_.text[at_ + 1]));
      at_ += 3;
      return e;
    }
  }
  if (c == '\'' || c == '"') { // the name of a curve or a surface
    const size_t close = line_.text.find(c, at_ + 1);
    if (close != std::string::npos && close < end_) {
      diagnostics_.warning(e.place, "a string as a parameter is 0");
      at_ = close + 1;
      return e;
    }
  }
  e.name = identifier();
  if (e.name.empty()) {
    error("expected a number, a name or '('; found " + found());
    return e;
  }
  e.kind = Expression::Kind::name;
  if (peek() == '[' && declared_ && declared_->arrays.contains(e.name)) {
    const bool isWhole = declared_->whole.contains(e.name);
    Expression value = element(e.name, elementAt(e.name));
    value.isWhole = isWhole;
    return value;
  }
  if (peek() == '(') return call(std::move(e), depth);
  if (isC() && (e.name == "true" || e.name == "false" || e.name == "M_PI")) {
    e.kind = Expression::Kind::number;
    e.number = e.name == "M_PI" ? 3.14159265f : e.name == "true" ? 1.0f : 0.0f;
    e.isWhole = e.name != "M_PI";
  } else if (isC()) {
    e.isWhole = declared_->whole.contains(e.name);
  }
  return e;
}

/// A function and its values; e is its name.
Expression Reader::call(Expression e, uint32_t depth) {
  take('(');
  std::vector<Expression> arguments;
  if (!take(')')) {
    do arguments.push_back(choice(depth + 1));
    while (!failed_ && take(','));
    if (!take(')')) error("expected ',' or ')' in the arguments of " + e.name + "; found " + found());
  }
  if (failed_) return e;
  if (declared_) {
    const auto own = declared_->functions.find(e.name);
    if (own != declared_->functions.end() && own->second.parameters.size() == arguments.size()) {
      std::map<std::string, Expression> values;
      for (size_t i = 0; i < arguments.size(); ++i) values[own->second.parameters[i]] = std::move(arguments[i]);
      Expression value = own->second.value;
      substitute(value, values);
      return value;
    }
  }
  if ((e.name == "func" || e.name == "curve") && arguments.size() == 2) {
    diagnostics_.warning(e.place, "functions that are drawn are not supported; '" + e.name + "(n, x)' is x");
    return std::move(arguments[1]);
  }
  if ((e.name == "float" || e.name == "double") && arguments.size() == 1) {
    arguments[0].isWhole = false;
    return std::move(arguments[0]);
  }
  if (isC() && e.name == "rand" && arguments.empty()) // of the integers below 32768
    return truncated(pair(kLsysMultiply, e.place, operation(kLsysRandom, e.place, {}), numberOf(32768, e.place)));
  if (isC()) inDegrees(e, arguments);
  const Function* sameName = nullptr;
  std::string counts;
  for (const Function& f : kFunctions) {
    if (f.name != e.name) continue;
    if (f.arguments == arguments.size()) {
      if (f.code == kLsysRandom || f.code == kLsysNormal) return drawing(f, e.place, std::move(arguments));
      const bool keepsWhole = f.code == kLsysAbs || f.code == kLsysMin || f.code == kLsysMax;
      const bool areWhole =
          std::all_of(arguments.begin(), arguments.end(), [](const Expression& a) { return a.isWhole; });
      Expression value = operation(f.code, e.place, std::move(arguments));
      value.isWhole = (keepsWhole && areWhole) || e.name == "int";
      const bool isInverse = f.code == kLsysAsin || f.code == kLsysAcos || f.code == kLsysAtan || f.code == kLsysAtan2;
      if (isC() && isInverse) return pair(kLsysMultiply, e.place, std::move(value), numberOf(0.0174532925f, e.place));
      return value;
    }
    sameName = &f;
    counts += (counts.empty() ? "" : " or ") + std::to_string(f.arguments);
  }
  if (sameName) {
    errorAt(e.place, e.name + " takes " + counts + (counts == "1" ? " argument" : " arguments") + "; found " +
                         std::to_string(arguments.size()));
    return e;
  }
  if (isC()) {
    diagnostics_.warning(e.place, "the function '" + e.name + "' is not supported, and is 0");
    return numberOf(0, e.place);
  }
  core::Suggestion suggestion(e.name);
  for (const Function& f : kFunctions) suggestion.offer(f.name);
  errorAt(e.place, "there is no function '" + e.name + "'" + suggestion.text());
  return e;
}

} // namespace gpgp::spawn::lsystem
