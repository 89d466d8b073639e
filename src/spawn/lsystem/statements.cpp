// Reads blocks of statements: see statements.h.
#include "spawn/lsystem/statements.h"

#include "spawn/lsystem/format.h"
#include "spawn/lsystem/scanner.h"

#include <algorithm>

namespace gpgp::spawn::lsystem {
namespace {

using namespace shader;
constexpr uint32_t kMostDepth = 32; // of statements in each other

constexpr std::string_view kTypes[] = {"int",      "float", "double", "bool",   "char", "long",   "short",
                                       "unsigned", "const", "static", "signed", "auto", "struct", "volatile"};
constexpr std::string_view kWholeTypes[] = {"int", "bool", "char", "long", "short", "unsigned"};
template <size_t N> bool contains(const std::string_view (&list)[N], std::string_view name) {
  return std::find(std::begin(list), std::end(list), name) != std::end(list);
}
Expression numberOf(float value, Place place) {
  Expression e;
  e.number = value;
  e.place = place;
  e.isWhole = true;
  return e;
}

} // namespace

bool isTypeName(std::string_view name) { return contains(kTypes, name); }
bool isWholeType(std::string_view name) { return contains(kWholeTypes, name); }

std::vector<Statement> Reader::block() {
  std::vector<Statement> all;
  if (!take('{')) {
    error("expected '{'; found " + found());
    return all;
  }
  while (!failed_ && !take('}')) {
    if (atEnd()) {
      error("this code has no '}'");
      break;
    }
    statement(all, 0);
  }
  return all;
}

std::vector<Statement> Reader::branch(uint32_t depth) {
  std::vector<Statement> all;
  statement(all, depth + 1);
  return all;
}

/// Parentheses and what is in them.
void Reader::passOverArguments() {
  if (!take('(')) return;
  uint32_t open = 1;
  bool quoted = false;
  while (open && at_ < end_) {
    const char c = line_.text[at_++];
    if (c == '"' && line_.text[at_ - 2] != '\\') quoted = !quoted;
    if (quoted) continue;
    if (c == '(') ++open;
    if (c == ')') --open;
  }
}

void Reader::statement(std::vector<Statement>& into, uint32_t depth) {
  if (failed_) return;
  if (depth > kMostDepth) return error("the code nests too deep");
  if (take(';')) return;
  Statement s;
  s.place = place();
  if (peek() == '{') {
    take('{');
    s.kind = Statement::Kind::block;
    while (!failed_ && !take('}')) {
      if (atEnd()) return error("this code has no '}'");
      statement(s.first, depth + 1);
    }
    into.push_back(std::move(s));
    return;
  }
  if (peek() == '+' || peek() == '-') { // ++i
    const char sign = peek();
    take(sign);
    if (!take(sign)) return error("expected a statement; found " + found());
    const std::string name = identifier();
    change(into, s, name, sign == '+' ? kLsysAdd : kLsysSubtract, numberOf(1, s.place));
    return endOfStatement();
  }
  const size_t before = at_;
  std::string name = identifier();
  if (name.empty() && isC() && peek() == '(') { // an expression that is not used
    passOverArguments();
    return endOfStatement();
  }
  if (name.empty()) return error("expected a statement, such as 'name = value;'; found " + found());
  if (name == "if") {
    s.kind = Statement::Kind::choose;
    s.value = condition();
    s.first = branch(depth);
    blanks();
    const size_t at = at_;
    if (identifier() == "else")
      s.second = branch(depth);
    else
      at_ = at;
    into.push_back(std::move(s));
  } else if (name == "while") {
    s.kind = Statement::Kind::loop;
    s.value = condition();
    s.first = branch(depth);
    into.push_back(std::move(s));
  } else if (name == "do") {
    s.kind = Statement::Kind::loop;
    s.testsLast = true;
    s.first = branch(depth);
    if (identifier() != "while") return error("expected 'while' behind the block of 'do'");
    s.value = condition();
    endOfStatement();
    into.push_back(std::move(s));
  } else if (name == "for") {
    s.kind = Statement::Kind::loop;
    if (!take('(')) return error("expected '(' behind 'for'; found " + found());
    if (!take(';')) statement(into, depth + 1); // with its ';'
    s.value = peek() == ';' ? numberOf(1, s.place) : expression();
    if (!take(';')) return error("expected ';' behind the condition of a loop; found " + found());
    inHeader_ = true;
    while (!failed_ && peek() != ')') {
      statement(s.second, depth + 1);
      if (!take(',')) break;
    }
    inHeader_ = false;
    if (!take(')')) return error("expected ')' behind the head of a loop; found " + found());
    s.first = branch(depth);
    into.push_back(std::move(s));
  } else if (name == "break" || name == "continue" || name == "return") {
    s.kind = Statement::Kind::stop;
    s.stop = name == "break"      ? Statement::Stop::loop
             : name == "continue" ? Statement::Stop::next
                                  : Statement::Stop::all;
    if (name == "return" && peek() != ';') {
      s.value = expression();
      s.hasValue = true;
    }
    endOfStatement();
    into.push_back(std::move(s));
  } else if (declared_ && declared_->isC && (name == "produce" || name == "nproduce")) {
    s.kind = Statement::Kind::produce;
    s.isLast = name == "produce";
    s.modules = calls();
    endOfStatement();
    into.push_back(std::move(s));
  } else if (isTypeName(name)) {
    bool isWhole = isWholeType(name);
    for (;;) { // const unsigned int
      const size_t at = at_;
      const std::string next = identifier();
      if (!isTypeName(next)) {
        at_ = at;
        break;
      }
      isWhole = isWhole || isWholeType(next);
      if (next == "float" || next == "double") isWhole = false;
    }
    do declaration(into, isWhole);
    while (!failed_ && take(','));
    endOfStatement();
  } else if (peek() == '(') {
    passOverArguments();
    constexpr std::string_view kSilent[] = {"printf", "fprintf", "Printf", "fclose", "fflush", "srand", "sran", "seed"};
    if (!contains(kSilent, name)) diagnostics_.warning(s.place, "the call of '" + name + "' in code has no effect");
    endOfStatement();
  } else {
    at_ = before;
    assignment(into, s);
    endOfStatement();
  }
}

void Reader::endOfStatement() {
  if (failed_ || inHeader_ || take(';')) return;
  if (peek() != '}') error("expected ';' behind a statement; found " + found());
}

Expression Reader::condition() {
  if (!take('(')) error("expected '(' before a condition; found " + found());
  Expression value = expression();
  if (!take(')')) error("expected ')' behind a condition; found " + found());
  return value;
}

/// name = value, of a declaration, with an array's extents and values where it has them.
void Reader::declaration(std::vector<Statement>& into, bool isWhole) {
  Statement s;
  take('*');
  s.place = place();
  s.name = identifier();
  if (s.name.empty()) return error("expected the name of a variable; found " + found());
  s.kind = Statement::Kind::assign;
  s.declares = true;
  s.isWhole = isWhole && declared_ && declared_->isC;
  if (peek() == '[') return arrayValues(into, s);
  if (declared_) {
    if (s.isWhole)
      declared_->whole.insert(s.name);
    else
      declared_->whole.erase(s.name);
  }
  s.value = take('=') ? expression() : numberOf(0, s.place);
  into.push_back(std::move(s));
}

/// [2][3] = {1, 2, 3}, behind the name of an array.
void Reader::arrayValues(std::vector<Statement>& into, const Statement& s) {
  std::vector<uint32_t> extents;
  constexpr uint32_t kMostElements = 4096;
  bool isOpen = false;
  while (!failed_ && take('[')) {
    if (take(']')) {
      isOpen = true;
      extents.push_back(0);
      continue;
    }
    const Expression extent = expression();
    const auto value = fixed_ ? fixed_(extent) : std::nullopt;
    if (!value || !(*value >= 1 && *value <= static_cast<float>(kMostElements)))
      errorAt(extent.place, "an array has a known number of elements, at most " + std::to_string(kMostElements));
    extents.push_back(value ? static_cast<uint32_t>(*value) : 1);
    if (!take(']')) error("expected ']' behind the number of elements; found " + found());
  }
  std::vector<Expression> values;
  if (take('=')) {
    uint32_t open = 0;
    do {
      while (take('{')) ++open;
      if (peek() != '}') values.push_back(expression());
      while (take('}') && open) --open;
      if (!open) break;
      take(',');
    } while (!failed_ && !atEnd());
  }
  uint32_t inner = 1, count = 1;
  for (size_t i = 1; i < extents.size(); ++i) inner *= std::max(extents[i], 1u);
  if (isOpen) extents[0] = static_cast<uint32_t>((values.size() + inner - 1) / inner);
  for (const uint32_t extent : extents) count *= std::max(extent, 1u);
  if (count > kMostElements)
    return errorAt(s.place, "an array has at most " + std::to_string(kMostElements) + " elements");
  if (!declared_) return;
  declared_->arrays[s.name] = extents;
  for (uint32_t i = 0; i < count; ++i) {
    Statement element = s;
    element.name = elementName(s.name, i);
    element.value = i < values.size() ? values[i] : numberOf(0, s.place);
    into.push_back(std::move(element));
  }
}

/// name += value, as name = name + value.
void Reader::change(std::vector<Statement>& into, Statement& s, const std::string& name, uint32_t code,
                    Expression value) {
  if (name.empty()) return error("expected the name of a variable; found " + found());
  s.kind = Statement::Kind::assign;
  s.name = name;
  s.isWhole = declared_ && declared_->isC && declared_->whole.contains(name);
  Expression itself;
  if (s.index) {
    itself = element(name, *s.index);
  } else {
    itself.kind = Expression::Kind::name;
    itself.name = name;
    itself.isWhole = s.isWhole;
    itself.place = s.place;
  }
  Expression sum;
  sum.kind = Expression::Kind::operation;
  sum.code = code;
  sum.place = s.place;
  sum.isWhole = itself.isWhole && value.isWhole && code != kLsysDivide;
  sum.operands.push_back(std::move(itself));
  sum.operands.push_back(std::move(value));
  s.value = std::move(sum);
  into.push_back(std::move(s));
}

void Reader::assignment(std::vector<Statement>& into, Statement& s) {
  const std::string name = identifier();
  if (declared_ && declared_->arrays.contains(name) && peek() == '[') s.index = elementAt(name);
  if (failed_) return;
  for (const auto& [sign, code] :
       {std::pair{"+=", kLsysAdd}, std::pair{"-=", kLsysSubtract}, std::pair{"*=", kLsysMultiply},
        std::pair{"/=", kLsysDivide}, std::pair{"%=", kLsysModulo}})
    if (take(std::string_view(sign))) return change(into, s, name, code, expression());
  if (take(std::string_view("++"))) return change(into, s, name, kLsysAdd, numberOf(1, s.place));
  if (take(std::string_view("--"))) return change(into, s, name, kLsysSubtract, numberOf(1, s.place));
  if (!take('=')) return error("expected '=' behind '" + name + "'; found " + found());
  s.kind = Statement::Kind::assign;
  s.name = name;
  s.isWhole = declared_ && declared_->isC && declared_->whole.contains(name);
  s.value = expression();
  into.push_back(std::move(s));
}

/// [i][j] behind the name of an array: the number of the element.
Expression Reader::elementAt(const std::string& array) {
  const std::vector<uint32_t>& extents = declared_->arrays.at(array);
  Expression index = numberOf(0, place());
  for (size_t i = 0; i < extents.size(); ++i) {
    if (!take('[')) {
      error("'" + array + "' has " + std::to_string(extents.size()) + " indices; found " + found());
      return index;
    }
    Expression next = expression();
    if (!take(']')) error("expected ']' behind an index; found " + found());
    if (i == 0) {
      index = std::move(next);
      continue;
    }
    const Place at = next.place;
    Expression row;
    row.kind = Expression::Kind::operation;
    row.code = kLsysMultiply;
    row.place = at;
    row.operands.push_back(std::move(index));
    row.operands.push_back(numberOf(static_cast<float>(extents[i]), at));
    index = Expression();
    index.kind = Expression::Kind::operation;
    index.code = kLsysAdd;
    index.place = at;
    index.operands.push_back(std::move(row));
    index.operands.push_back(std::move(next));
  }
  return index;
}

/// The element of an array by a value: a tree of choices among its elements. Beyond its ends are the first and last.
Expression Reader::element(const std::string& array, const Expression& index) {
  uint32_t count = 1;
  for (const uint32_t extent : declared_->arrays.at(array)) count *= std::max(extent, 1u);
  const auto known = fixed_ ? fixed_(index) : std::nullopt;
  const std::function<Expression(uint32_t, uint32_t)> among = [&](uint32_t first, uint32_t last) {
    Expression e;
    e.place = index.place;
    if (first + 1 >= last) {
      e.kind = Expression::Kind::name;
      e.name = elementName(array, first);
      return e;
    }
    const uint32_t middle = (first + last) / 2;
    Expression below;
    below.kind = Expression::Kind::operation;
    below.code = kLsysLess;
    below.place = index.place;
    below.operands.push_back(index);
    below.operands.push_back(numberOf(static_cast<float>(middle), index.place));
    e.kind = Expression::Kind::operation;
    e.code = kLsysSelect;
    e.operands.push_back(std::move(below));
    e.operands.push_back(among(first, middle));
    e.operands.push_back(among(middle, last));
    return e;
  };
  if (!known) return among(0, count);
  const uint32_t at = static_cast<uint32_t>(std::max(*known, 0.0f));
  return among(std::min(at, count - 1), std::min(at, count - 1) + 1);
}

/// Name(value, ...) Name ..., as L+C writes modules.
ModuleString Reader::calls() {
  ModuleString all;
  while (!failed_ && peek() != ';' && peek() != '}' && !atEnd()) {
    Module module;
    module.place = place();
    module.name = identifier();
    if (module.name.empty()) {
      error("expected a module, such as 'F(1)'; found " + found());
      break;
    }
    if (take('(') && !take(')')) {
      do module.arguments.push_back(expression());
      while (!failed_ && take(','));
      if (!take(')')) error("expected ',' or ')' in the parameters of '" + module.name + "'; found " + found());
    }
    if (!failed_) all.push_back(std::move(module));
  }
  return all;
}

} // namespace gpgp::spawn::lsystem
