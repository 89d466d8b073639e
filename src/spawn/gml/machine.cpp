// The stack, names and calls. Operators are in the operators_... files, branches and rules in branches.cpp.
#include "spawn/gml/machine.h"

#include "core/math.h"
#include "core/suggest.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn::gml {
namespace {
const char* nounOf(char letter) {
  switch (letter) {
  case 'n': return "a number";
  case 'k': return "a known number";
  case 'i': return "a whole number";
  case 'v': return "a vector";
  case 't': return "a name";
  case 'r': return "a name or a whole number";
  case 'a': return "an array";
  case 'p': return "a procedure";
  case 'd': return "a dictionary";
  case 'S': return "a shape";
  default: return "a value";
  }
}

bool fits(char letter, const Value& value) {
  const Number* number = std::get_if<Number>(&value);
  switch (letter) {
  case 'n': return number;
  case 'k': return number && !number->formula;
  case 'i': return number && !number->formula && number->known == std::floor(number->known);
  case 'v': return std::holds_alternative<std::shared_ptr<const Vector>>(value);
  case 't': return std::holds_alternative<Name>(value);
  case 'r':
    return std::holds_alternative<Name>(value) ||
           (number && !number->formula && number->known >= 0 && number->known == std::floor(number->known));
  case 'a': return std::holds_alternative<Items>(value);
  case 'p':
    return std::holds_alternative<Procedure>(value) || std::holds_alternative<RuleName>(value) ||
           std::holds_alternative<TerminalName>(value);
  case 'd': return std::holds_alternative<Dictionary>(value);
  case 'S': return std::holds_alternative<Shape>(value);
  default: return true;
  }
}

std::string list(std::string_view letters) {
  std::string text;
  for (size_t i = 0; i < letters.size(); ++i)
    text += (i == 0 ? "" : i + 1 == letters.size() ? " and " : ", ") + std::string(nounOf(letters[i]));
  return text;
}
} // namespace

const char* kindOf(const Value& value) {
  constexpr const char* kKinds[] = {
      "the result of an error", "a number", "a vector",   "a string", "a name",     "an array",     "a procedure",
      "a dictionary",           "a shape",  "a mark '['", "a rule",   "a terminal", "nothing known"};
  const Number* number = std::get_if<Number>(&value);
  if (number && number->formula) return "a number that depends on the shape";
  return kKinds[value.index()];
}

Machine::Machine(const Program& program, std::span<const GpgpVariable> overrides, Diagnostics& diagnostics,
                 std::pmr::memory_resource* memory)
    : program_(program), overrides_(overrides), diagnostics_(diagnostics), graph_(diagnostics, memory) {
  for (uint32_t n = 0; n < program.names.size(); ++n) names_.add(program.names.text(n));
  for (const auto operators :
       {stackOperators(), numberOperators(), arrayOperators(), controlOperators(), shapeOperators()})
    for (const Builtin& builtin : operators) builtins_[names_.add(builtin.name)].push_back(&builtin);
  for (const char* word : {"X", "Y", "Z", "ADJUST_TO_FILL", "ANCHOR_TO_START", "ANCHOR_TO_END"})
    words_.insert(names_.add(word));
  dictionaries_.emplace_back();
}

void forWords(const std::function<void(std::string_view)>& call) {
  for (const auto operators :
       {stackOperators(), numberOperators(), arrayOperators(), controlOperators(), shapeOperators()})
    for (const Builtin& builtin : operators) call(builtin.name);
  for (const char* word : {"X", "Y", "Z", "ADJUST_TO_FILL", "ANCHOR_TO_START", "ANCHOR_TO_END"}) call(word);
}

/// Names that nothing in the text could define.
void Machine::checkNames() {
  std::vector<bool> known(names_.size());
  for (const auto& [name, overloads] : builtins_) known[name] = true;
  for (const uint32_t word : words_) known[word] = true;
  std::vector<uint32_t> literals;
  for (const auto& procedure : program_.procedures)
    for (const Token& token : procedure)
      if (token.kind == TokenKind::literal && !known[token.index]) {
        known[token.index] = true;
        literals.push_back(token.index);
      }
  for (const auto& procedure : program_.procedures)
    for (const Token& token : procedure) {
      if (token.kind != TokenKind::name || known[token.index]) continue;
      const std::string text = nameText(token.index).substr(0, 64);
      std::string suggestion;
      if (diagnostics_.takesErrors()) {
        core::Suggestion best(text);
        for (const uint32_t literal : literals) best.offer(nameText(literal));
        forWords([&](std::string_view word) { best.offer(word); });
        suggestion = best.text();
      }
      failAt(token.place, "there is no operator or definition '" + text + "'" + suggestion);
    }
}

// ---------------------------------------------------------------- errors and bounds

void Machine::report(Place place, const std::string& text) {
  if (!reported_.insert({place.line, place.column}).second) return;
  diagnostics_.error(place, text);
}
bool Machine::failAt(Place place, const std::string& text) {
  report(place, text);
  return false;
}
bool Machine::fail(const std::string& text) {
  const bool isCalled = calledFrom_.line && (calledFrom_.line != place_.line);
  report(place_, isCalled ? text + " (called in line " + std::to_string(calledFrom_.line) + ")" : text);
  return false;
}

bool Machine::spend(uint64_t steps) {
  if (stopped_) return false;
  steps_ += steps;
  if (steps_ > kMaxSteps) {
    fail("the program does not end within " + std::to_string(kMaxSteps) + " steps");
    stopped_ = true;
  } else if (graph_.nodeCount() > kMaxNodes) {
    fail("the program makes more than " + std::to_string(kMaxNodes) +
         " operators; a 'rule' is made once, however often shapes go to it");
    stopped_ = true;
  }
  return !stopped_;
}

// ---------------------------------------------------------------- the stack

void Machine::push(Value value) {
  if (stack_.size() < kMaxStack) {
    stack_.push_back(std::move(value));
    return;
  }
  if (!stopped_) fail("the stack holds more than " + std::to_string(kMaxStack) + " values");
  stopped_ = true;
}

void Machine::pushArray(std::vector<Value> items) {
  auto array = std::make_shared<Array>();
  uint64_t total = items.size();
  for (const Value& item : items) {
    if (const Items* inner = std::get_if<Items>(&item)) {
      total += (*inner)->total;
      array->depth = std::max(array->depth, (*inner)->depth + 1);
      array->hasShapes = array->hasShapes || (*inner)->hasShapes;
    }
    array->hasShapes = array->hasShapes || std::holds_alternative<Shape>(item);
  }
  if (total > kMaxItems || array->depth > kMaxArrayDepth) {
    fail(total > kMaxItems ? "an array holds more than " + std::to_string(kMaxItems) + " values"
                           : "arrays nest more than " + std::to_string(kMaxArrayDepth) + " deep");
    push(Broken{});
    return;
  }
  array->total = static_cast<uint32_t>(total);
  array->items = std::move(items);
  if (spend(array->items.size())) push(Items(std::move(array)));
}

Value Machine::pop() {
  if (stack_.empty()) {
    if (!lost_) fail(std::string(operator_) + " takes a value, but the stack is empty");
    lost_ = true;
    return Broken{};
  }
  Value value = std::move(stack_.back());
  stack_.pop_back();
  return value;
}

/// Takes all of them; false after an error, or where one is the result of an error.
bool Machine::takeArguments(const Builtin& builtin, Arguments& arguments) {
  const std::string_view takes(builtin.takes);
  const size_t found = std::min(takes.size(), stack_.size());
  arguments.assign(std::make_move_iterator(stack_.end() - static_cast<std::ptrdiff_t>(found)),
                   std::make_move_iterator(stack_.end()));
  stack_.resize(stack_.size() - found);
  bool isWhole = found == takes.size();
  if (!isWhole) {
    if (!lost_)
      fail(std::string(builtin.name) + " takes " + list(takes) + ", but the stack holds " +
           (found ? std::to_string(found) + (found == 1 ? " value" : " values") : std::string("nothing")) +
           (takes.find('S') != std::string_view::npos && !graph_.hasAxiom()
                ? "; '/Box axiom' pushes the shape that a program starts with"
                : ""));
    lost_ = true;
  }
  std::string_view rest = takes.substr(takes.size() - found);
  bool known = true;
  for (size_t i = 0; isWhole && i < found; ++i) {
    if (std::holds_alternative<Broken>(arguments[i]))
      isWhole = false;
    else
      known = known && fits(rest[i], arguments[i]);
  }
  if (isWhole && !known) {
    std::string kinds;
    for (size_t i = 0; i < found; ++i)
      kinds += (i == 0 ? "" : i + 1 == found ? " and " : ", ") + std::string(kindOf(arguments[i]));
    fail(std::string(builtin.name) + " takes " + list(takes) + ", found " + kinds);
    isWhole = false;
  }
  if (isWhole)
    for (const Value& value : arguments)
      if (const Shape* shape = std::get_if<Shape>(&value))
        if (takes.find('S') != std::string_view::npos && !mayTake(*shape)) isWhole = false;
  return isWhole;
}

void Machine::runBuiltin(std::span<const Builtin* const> overloads) {
  const auto takesThis = [&](const Builtin* builtin) {
    const std::string_view takes(builtin->takes);
    if (takes.size() > stack_.size()) return false;
    for (size_t i = 0; i < takes.size(); ++i)
      if (!fits(takes[i], stack_[stack_.size() - takes.size() + i])) return false;
    return true;
  };
  const auto fitting = std::find_if(overloads.begin(), overloads.end(), takesThis);
  if (fitting == overloads.end() && overloads.size() > 1 && !stack_.empty() &&
      std::holds_alternative<Broken>(stack_.back()))
    lost_ = true; // how many values this would have taken is not known
  const Builtin& builtin = **(fitting == overloads.end() ? overloads.begin() : fitting);
  operator_ = builtin.name;
  code_ = builtin.code;
  Arguments arguments;
  if (!takeArguments(builtin, arguments)) {
    for (const Value& value : arguments) drop(value);
    for (uint32_t i = 0; i < builtin.leaves; ++i) push(Broken{});
    return;
  }
  builtin.run(*this, arguments);
}

// ---------------------------------------------------------------- values with shapes in them

bool Machine::mayTake(const Shape& shape) {
  if (shape->branch == branch_) return true;
  fail("this shape comes from outside the branch: what one shape is cannot decide about another");
  lost_ = true;
  return false;
}

Value Machine::copyOf(Value& stored) {
  if (Shape* shape = std::get_if<Shape>(&stored)) {
    if (!mayTake(*shape)) return Broken{};
    return graph_.copy(*shape, place_);
  }
  Items* items = std::get_if<Items>(&stored);
  if (!items || !(*items)->hasShapes || !spend((*items)->items.size())) return stored;
  auto kept = std::make_shared<Array>(**items), made = std::make_shared<Array>(**items);
  for (size_t i = 0; i < kept->items.size(); ++i) made->items[i] = copyOf(kept->items[i]);
  *items = kept;
  return Items(made);
}

void Machine::drop(const Value& value) {
  if (const Shape* shape = std::get_if<Shape>(&value)) graph_.discard(*shape);
  if (const Items* items = std::get_if<Items>(&value); items && (*items)->hasShapes)
    for (const Value& item : (*items)->items) drop(item);
}

// ---------------------------------------------------------------- names

Value* Machine::find(uint32_t name) {
  for (size_t s = scopes_.size(); s-- > 0;) {
    auto& dictionary = dictionaries_[scopes_[s].dictionary].values;
    if (const auto it = dictionary.find(name); it != dictionary.end()) return &it->second;
  }
  return nullptr;
}

bool Machine::isReserved(uint32_t name, const char* what) {
  if (!builtins_.count(name) && !words_.count(name)) return false;
  fail("'" + nameText(name) + "' is an operator; expected another name " + what);
  return true;
}

void Machine::define(uint32_t name, Value value) {
  if (!isReserved(name, "to define")) dictionaries_[scopes_.back().dictionary].values[name] = std::move(value);
}

Value* Machine::findRegister(uint32_t name) {
  for (size_t f = frames_.size(); f-- > 0;) {
    if (const auto it = frames_[f].registers.find(name); it != frames_[f].registers.end()) return &it->second;
    if (frames_[f].isCall) break;
  }
  return nullptr;
}

void Machine::store(uint32_t name) {
  operator_ = "'!'";
  Value value = pop();
  frames_.back().registers[name] = std::move(value);
}

bool Machine::isKnown(const Value& value, uint32_t name) {
  if (!std::holds_alternative<Forgotten>(value)) return true;
  return fail("a branch that depends on a shape stored something else in '" + nameText(name) +
              "': its value after the branch is not known");
}

/// What the names of a branch stood for outside.
void Machine::forget() {
  for (const auto& [name, value] : frames_.back().registers)
    for (size_t f = frames_.size() - 1; f-- > 0;) {
      const auto outer = frames_[f].registers.find(name);
      if (outer != frames_[f].registers.end()) outer->second = Forgotten{};
      if (outer != frames_[f].registers.end() || frames_[f].isCall) break;
    }
  for (const auto& [name, value] : dictionaries_[scopes_.back().dictionary].values)
    for (size_t s = scopes_.size() - 1; s-- > 0;) {
      auto& values = dictionaries_[scopes_[s].dictionary].values;
      const auto outer = values.find(name);
      if (outer == values.end()) continue;
      outer->second = Forgotten{};
      break;
    }
}

void Machine::load(uint32_t name) {
  if (Value* stored = findRegister(name)) {
    push(isKnown(*stored, name) ? copyOf(*stored) : Value(Broken{}));
    return;
  }
  if (!lost_) {
    core::Suggestion suggestion(nameText(name));
    for (size_t f = frames_.size(); f-- > 0;) {
      for (const auto& [other, value] : frames_[f].registers) suggestion.offer(nameText(other));
      if (frames_[f].isCall) break;
    }
    fail("nothing was stored in '" + nameText(name) + "' by '!" + nameText(name) + "'" + suggestion.text());
  }
  push(Broken{});
}

void Machine::runName(uint32_t name, Place place) {
  if (Value* value = find(name)) {
    if (const Procedure* procedure = std::get_if<Procedure>(value)) {
      const uint32_t number = procedure->procedure; // the definition may change while it runs
      const Place before = calledFrom_;
      calledFrom_ = place;
      frames_.push_back({{}, branch_, true});
      runProcedure(number);
      frames_.pop_back();
      calledFrom_ = before;
    } else if (std::holds_alternative<RuleName>(*value) || std::holds_alternative<TerminalName>(*value)) {
      execute(*value, place);
    } else {
      push(isKnown(*value, name) ? copyOf(*value) : Value(Broken{}));
    }
    return;
  }
  if (const auto it = builtins_.find(name); it != builtins_.end()) {
    runBuiltin(it->second);
  } else if (words_.count(name)) {
    push(Name{name});
  } else {
    fail("'" + nameText(name) + "' is not defined when this runs");
    lost_ = true;
    push(Broken{});
  }
}

// ---------------------------------------------------------------- running

void Machine::runToken(const Token& token) {
  place_ = token.place;
  switch (token.kind) {
  case TokenKind::number: pushNumber(shader::settle(token.values[0])); break;
  case TokenKind::vector: {
    auto vector = std::make_shared<Vector>();
    vector->size = token.size;
    for (uint32_t i = 0; i < token.size; ++i) vector->components[i].known = shader::settle(token.values[i]);
    push(std::shared_ptr<const Vector>(std::move(vector)));
    break;
  }
  case TokenKind::string: push(Text{std::make_shared<const std::string>(program_.texts[token.index])}); break;
  case TokenKind::literal: push(Name{token.index}); break;
  case TokenKind::procedure: push(Procedure{token.index}); break;
  case TokenKind::store: store(token.index); break;
  case TokenKind::load: load(token.index); break;
  case TokenKind::name: runName(token.index, token.place); break;
  case TokenKind::broken: push(Broken{}); break;
  }
}

void Machine::runProcedure(uint32_t procedure) {
  if (!spend(1)) return;
  if (calls_ == kMaxCalls) {
    fail("procedures run each other more than " + std::to_string(kMaxCalls) +
         " deep; one that ends by what its shape is must be a rule, as /name 0 { ... } rule");
    stopped_ = true;
    return;
  }
  ++calls_;
  for (const Token& token : program_.procedures[procedure]) {
    if (stopped_ || leaves_ || !spend(1)) break;
    runToken(token);
  }
  --calls_;
}

void Machine::execute(const Value& value, Place place) {
  if (const Procedure* procedure = std::get_if<Procedure>(&value)) {
    runProcedure(procedure->procedure);
  } else if (const RuleName* rule = std::get_if<RuleName>(&value)) {
    call(rule->rule, place);
  } else if (const TerminalName* terminal = std::get_if<TerminalName>(&value)) {
    operator_ = "a terminal";
    const Value top = pop();
    const Shape* shape = std::get_if<Shape>(&top);
    if (shape && mayTake(*shape)) graph_.toTerminal(*shape, terminal->terminal, place_);
    if (!shape && !std::holds_alternative<Broken>(top))
      fail(std::string("a terminal takes a shape, found ") + kindOf(top));
  }
}

void Machine::endDictionary() {
  if (scopes_.back().isOpened)
    scopes_.pop_back();
  else
    fail("'end' without 'begin'");
}

std::unordered_map<uint32_t, Value>* Machine::changed(uint32_t dictionary) {
  if (dictionaries_[dictionary].branch == branch_) return &dictionaries_[dictionary].values;
  fail("a branch that depends on a shape cannot change a dictionary from outside");
  return nullptr;
}

void Machine::beginDictionary(uint32_t number) {
  if (changed(number)) scopes_.push_back({number, branch_, true});
}

uint32_t Machine::newDictionary() {
  dictionaries_.push_back({{}, branch_});
  spend(4);
  return static_cast<uint32_t>(dictionaries_.size() - 1);
}

} // namespace gpgp::spawn::gml
