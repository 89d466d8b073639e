// Branches that depend on a shape, rules, and the order in which a program and its rules run.
#include "spawn/gml/machine.h"

#include "core/math.h"
#include "core/suggest.h"
#include "spawn/language/corners.h"
#include "spawn/language/lexer.h"

#include <algorithm>
#include <cstring>

namespace gpgp::spawn::gml {
using namespace shader;

namespace {
bool isGraphName(const std::string& name) {
  return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), isNameCharacter);
}
constexpr const char* kGraphName = "is not a name of a rule or terminal; expected letters, digits and _";
} // namespace

// ---------------------------------------------------------------- branches

size_t Machine::topShape() const {
  for (size_t i = stack_.size(); i-- > 0;)
    if (std::holds_alternative<Shape>(stack_[i])) return i;
  return stack_.size();
}

void Machine::branchOn(size_t shapeAt, uint32_t node, std::span<const Value> procedures, const Number* condition) {
  const Shape shape = std::get<Shape>(stack_[shapeAt]);
  const std::vector<Value> before = stack_;
  const Place place = place_;
  const uint32_t outside = branch_;
  const size_t scopes = scopes_.size(), frames = frames_.size();
  std::vector<Value> joined;
  uint32_t joinedBranch = 0;
  for (uint32_t i = 0; i < procedures.size(); ++i) {
    if (!spend(before.size() + 1)) return;
    stack_ = before;
    const uint32_t branch = branch_ = ++branches_;
    auto taken = std::make_shared<ShapeState>(*graph_.edgeOf(node, i, shape));
    taken->branch = branch_;
    stack_[shapeAt] = Shape(std::move(taken));
    scopes_.push_back({newDictionary(), branch_, false});
    frames_.push_back({{}, branch_, false});
    execute(procedures[i], place);
    place_ = place;
    if (scopes_.size() > scopes + 1) fail("'begin' without 'end'");
    scopes_.resize(scopes + 1);
    frames_.resize(frames + 1);
    forget();
    scopes_.pop_back();
    frames_.pop_back();
    branch_ = outside;
    std::vector<Value> left = std::move(stack_);
    stack_.clear();
    if (i == 0) {
      joined = std::move(left);
      joinedBranch = branch;
      continue;
    }
    if (joined.size() != left.size()) {
      if (!lost_)
        fail("one branch leaves " + std::to_string(joined.size()) + " values on the stack, the other " +
             std::to_string(left.size()) + "; 'nothing' stands for a shape that a branch does not have");
      lost_ = true;
      joined.resize(std::min(joined.size(), left.size()));
    }
    const bool isLast = i + 1 == procedures.size();
    const Joining how{condition, joinedBranch, branch, isLast ? outside : ++branches_};
    for (size_t v = 0; v < joined.size(); ++v) joined[v] = join(joined[v], left[v], how);
    joinedBranch = how.branch;
  }
  stack_ = std::move(joined);
}

Value Machine::join(const Value& a, const Value& b, const Joining& how) {
  if (std::holds_alternative<Broken>(a) || std::holds_alternative<Broken>(b)) return Broken{};
  const auto differ = [&]() -> Value {
    if (!lost_)
      fail(std::string("behind the branches the stack holds different values: ") + kindOf(a) + " and " + kindOf(b) +
           (std::holds_alternative<Number>(a) ? ", which depends on chance" : ""));
    return Broken{};
  };
  if (a.index() != b.index()) return differ();
  if (const Number* x = std::get_if<Number>(&a)) {
    const Number& y = std::get<Number>(b);
    if (x->formula == y.formula && x->known == y.known) return a;
    const Number* condition = how.condition;
    if (!condition || !condition->formula || !condition->formula->draws.empty()) return differ();
    // What it is depends on the shape: t * x + (1 - t) * y, with t 1 or 0.
    const auto t = combined(*this, kCodeOr, *condition, {});
    const auto f = t ? combined(*this, kCodeSubtract, {1, nullptr}, *t) : std::nullopt;
    const auto first = f ? combined(*this, kCodeMultiply, *t, *x) : std::nullopt;
    const auto second = first ? combined(*this, kCodeMultiply, *f, y) : std::nullopt;
    const auto sum = second ? combined(*this, kCodeAdd, *first, *second) : std::nullopt;
    return sum ? Value(*sum) : Value(Broken{});
  }
  if (const Shape* x = std::get_if<Shape>(&a)) {
    const Shape& y = std::get<Shape>(b);
    if (*x == y) return a;
    if ((*x)->branch != how.branchA || y->branch != how.branchB) return differ();
    auto both = std::make_shared<ShapeState>(**x);
    both->branch = how.branch;
    both->ends.insert(both->ends.end(), y->ends.begin(), y->ends.end());
    spend(both->ends.size());
    const bool oneIsNone = (*x)->ends.empty() || y->ends.empty();
    if ((*x)->ends.empty()) both->versions = y->versions;
    for (uint32_t q = 0; q < kQualityCount && !oneIsNone; ++q)
      if ((*x)->versions[q] != y->versions[q]) both->versions[q] = graph_.newVersion();
    return Shape(std::move(both));
  }
  if (const Items* x = std::get_if<Items>(&a)) {
    const Items& y = std::get<Items>(b);
    if (*x == y) return a;
    if ((*x)->items.size() != y->items.size()) return differ();
    auto both = std::make_shared<Array>(**x);
    for (size_t i = 0; i < both->items.size() && spend(1); ++i) both->items[i] = join((*x)->items[i], y->items[i], how);
    return Items(std::move(both));
  }
  if (const auto* x = std::get_if<std::shared_ptr<const Vector>>(&a)) {
    const auto& y = std::get<std::shared_ptr<const Vector>>(b);
    if (*x == y) return a;
    if ((*x)->size != y->size) return differ();
    auto both = std::make_shared<Vector>(**x);
    for (uint32_t i = 0; i < both->size; ++i) {
      const Value part = join((*x)->components[i], y->components[i], how);
      if (!std::holds_alternative<Number>(part)) return Broken{};
      both->components[i] = std::get<Number>(part);
    }
    return std::shared_ptr<const Vector>(std::move(both));
  }
  const bool same = std::visit(
      [&](const auto& x) {
        using T = std::decay_t<decltype(x)>;
        const T& y = std::get<T>(b);
        if constexpr (std::is_same_v<T, Text>)
          return *x.text == *y.text;
        else if constexpr (std::is_same_v<T, Name>)
          return x.name == y.name;
        else if constexpr (std::is_same_v<T, Procedure>)
          return x.procedure == y.procedure;
        else if constexpr (std::is_same_v<T, Dictionary>)
          return x.dictionary == y.dictionary;
        else if constexpr (std::is_same_v<T, RuleName>)
          return x.rule == y.rule;
        else if constexpr (std::is_same_v<T, TerminalName>)
          return x.terminal == y.terminal;
        else
          return std::is_same_v<T, Mark>;
      },
      a);
  return same ? a : differ();
}

// ---------------------------------------------------------------- loops

bool Machine::goesOn() { return !stopped_ && !leaves_ && spend(1); }
void Machine::beginLoop() { loopBranches_.push_back(branch_); }
void Machine::endLoop() {
  loopBranches_.pop_back();
  leaves_ = false;
}
void Machine::exitLoop() {
  if (loopBranches_.empty()) {
    fail("'exit' outside of a loop");
  } else if (loopBranches_.back() != branch_) {
    fail("'exit' depends on a shape; to repeat until a shape has some size, write a rule that calls itself");
    stopped_ = true; // nothing else may end the loop
  } else {
    leaves_ = true;
  }
}

// ---------------------------------------------------------------- parameters of operators

Parameter Machine::parameter(const Number& number, const Shape& shape) {
  if (!number.formula) return {kParameterConstant, floatBitsToUint(settle(number.known))};
  for (const Read& read : number.formula->reads)
    if (read.quality != kNeverChanges && shape->versions[read.quality] != read.version) {
      fail("this takes a number that was read in line " + std::to_string(read.place.line) +
           " from another shape, or before the shape was changed; numbers are read from the shape that takes them");
      return {};
    }
  for (const Draw& draw : number.formula->draws)
    if (!drawn_.insert(draw.number).second) {
      fail("the random number of line " + std::to_string(draw.place.line) +
           " is taken by a second operator, for which it would be another number; a size or the seed keeps one");
      return {};
    }
  return graph_.parameter(number.formula->expression);
}

std::optional<uint32_t> Machine::polygonOf(const std::vector<std::array<float, 2>>& corners, bool convex) {
  const auto known = polygons_.find({convex, corners});
  if (known != polygons_.end()) return known->second;
  if (!spend(16 + corners.size() * corners.size() / 16)) return std::nullopt;
  std::string problem;
  const uint32_t polygon = addCorners(graph_.graph(), corners, convex, problem);
  if (!problem.empty()) {
    fail(problem);
    return std::nullopt;
  }
  polygons_[{convex, corners}] = polygon;
  return polygon;
}

// ---------------------------------------------------------------- rules, terminals, starts

std::string Machine::uniqueName(const std::string& wanted) {
  std::string name = wanted;
  for (uint32_t i = 2; !graphNames_.insert(name).second; ++i) name = wanted + "_" + std::to_string(i);
  return name;
}

void Machine::defineRule(uint32_t name, uint32_t parameters, uint32_t procedure) {
  if (!isMain_ || branch_ != 0) {
    fail("rules are defined by the program itself, not by rules and branches");
    return;
  }
  if (!isGraphName(nameText(name))) {
    fail("'" + nameText(name).substr(0, 64) + "' " + kGraphName);
    return;
  }
  define(name, RuleName{static_cast<uint32_t>(rules_.size())});
  rules_.push_back({name, parameters, procedure, place_, 0});
}

void Machine::defineTerminals(std::span<const uint32_t> names, uint32_t kind, uint32_t index) {
  if (!isMain_ || branch_ != 0) {
    fail("terminals are defined by the program itself, not by rules and branches");
    return;
  }
  if (graph_.graph().buckets == kMaxBuckets) {
    fail("more than " + std::to_string(kMaxBuckets) + " terminal lines");
    return;
  }
  const uint32_t bucket = graph_.addTerminalLine();
  for (const uint32_t name : names) {
    if (!isGraphName(nameText(name)))
      fail("'" + nameText(name).substr(0, 64) + "' " + kGraphName);
    else if (!graphNames_.insert(nameText(name)).second)
      fail("'" + nameText(name) + "' is the name of two terminals");
    else
      define(name, TerminalName{graph_.addTerminal(nameText(name), kind, index, bucket)});
  }
}

void Machine::emitDefault(const Shape& shape) {
  if (shape->ends.empty()) return;
  if (!generate_) {
    if (graph_.graph().buckets == kMaxBuckets) {
      fail("shapes that are left on the stack need a terminal line more than the " + std::to_string(kMaxBuckets) +
           " that a program can have");
      return;
    }
    generate_ = graph_.addTerminal(uniqueName("Generate"), 0, 0, graph_.addTerminalLine());
  }
  graph_.toTerminal(shape, *generate_, place_);
}

std::optional<uint32_t> Machine::instanceOf(uint32_t rule, std::vector<Value> arguments) {
  std::string key = std::to_string(rule), name = nameText(rules_[rule].name);
  for (const Value& value : arguments) {
    std::string text;
    if (const Number* number = std::get_if<Number>(&value); number && !number->formula) {
      text = numberText(number->known);
      key += "n" + std::to_string(floatBitsToUint(number->known));
    } else if (const Name* word = std::get_if<Name>(&value)) {
      text = nameText(word->name);
      key += "/" + std::to_string(word->name);
    } else if (const Text* string = std::get_if<Text>(&value)) {
      text = *string->text;
      key += "\"" + text + "\"";
    } else {
      fail("a rule takes known numbers, names and strings, found " + std::string(kindOf(value)) +
           "; what its shape is, it reads from the shape");
      return std::nullopt;
    }
    for (char& c : text)
      if (!isNameCharacter(c)) c = '_';
    name += "_" + text.substr(0, 16);
  }
  const auto [it, isNew] = instanceKeys_.try_emplace(key, static_cast<uint32_t>(instances_.size()));
  if (!isNew) return it->second;
  if (instances_.size() == kMaxRuleInstances) {
    fail("rules have more than " + std::to_string(kMaxRuleInstances) +
         " different arguments; one that counts must end, as: n 0 gt { ... } { ... } ifelse");
    stopped_ = true;
    return std::nullopt;
  }
  ++rules_[rule].instances;
  instances_.push_back(
      {rule, std::move(arguments), graph_.addRule(uniqueName(name.substr(0, 64)), rules_[rule].place), place_});
  return it->second;
}

void Machine::call(uint32_t rule, Place) {
  const RuleDefinition& definition = rules_[rule];
  operator_ = "a rule";
  if (stack_.size() < size_t(definition.parameters) + 1) {
    if (!lost_)
      fail("rule '" + nameText(definition.name) + "' takes a shape" +
           (definition.parameters ? " and " + std::to_string(definition.parameters) + " values" : std::string()) +
           ", but the stack holds " + std::to_string(stack_.size()));
    lost_ = true;
    stack_.clear();
    return;
  }
  std::vector<Value> arguments(stack_.end() - definition.parameters, stack_.end());
  stack_.resize(stack_.size() - definition.parameters);
  const Value top = pop();
  const Shape* shape = std::get_if<Shape>(&top);
  const auto isBroken = [](const Value& v) { return std::holds_alternative<Broken>(v); };
  if (isBroken(top) || std::any_of(arguments.begin(), arguments.end(), isBroken)) {
    drop(top);
  } else if (!shape) {
    fail("rule '" + nameText(definition.name) + "' takes a shape, found " + kindOf(top));
  } else if (mayTake(*shape)) {
    const auto instance = instanceOf(rule, std::move(arguments));
    if (instance && !(*shape)->ends.empty())
      graph_.toRule(*shape, instances_[*instance].number);
    else
      graph_.discard(*shape);
  }
}

void Machine::startShape(uint32_t shape, uint32_t polygon, std::optional<uint32_t> rule) {
  if (!isMain_ || branch_ != 0) {
    fail("the shapes that a program starts with come from the program itself, not from rules and branches");
    push(Broken{});
    return;
  }
  if (!rule) {
    const uint32_t number = graph_.addRule(uniqueName("Start"), place_);
    graph_.addAxiom(number, shape, polygon);
    push(graph_.beginRule(number));
    return;
  }
  const Value* value = find(*rule);
  const RuleName* called = value ? std::get_if<RuleName>(value) : nullptr;
  if (!called) {
    fail("there is no rule '" + nameText(*rule) + "' yet, which could start");
  } else if (rules_[called->rule].parameters != 0) {
    fail("rule '" + nameText(*rule) + "' takes values, and cannot start a program");
  } else if (const auto instance = instanceOf(called->rule, {})) {
    graph_.addAxiom(instances_[*instance].number, shape, polygon);
  }
}

void Machine::defineVariable(uint32_t name, float value) {
  if (!isMain_ || branch_ != 0) {
    fail("a var is defined by the program itself, not by rules and branches");
    return;
  }
  if (!variables_.try_emplace(name, false).second) {
    fail("var '" + nameText(name) + "' is defined twice");
    return;
  }
  for (const GpgpVariable& variable : overrides_) {
    if (!variable.name || nameText(name) != variable.name) continue;
    variables_[name] = true;
    if (isUsable(variable.value))
      value = settle(variable.value);
    else
      failAt({}, "var '" + nameText(name) + "' cannot be set to " + numberText(variable.value) + "; " + kUsableNumbers);
  }
  define(name, Number{value, nullptr});
}

// ---------------------------------------------------------------- the whole

void Machine::runBody(uint32_t procedure, std::vector<Value> stack, std::vector<Scope> scopes) {
  stack_ = std::move(stack);
  scopes_ = std::move(scopes);
  frames_.clear();
  frames_.push_back({{}, 0, true});
  loopBranches_.clear();
  lost_ = leaves_ = false;
  branch_ = calls_ = 0;
  calledFrom_ = {};
  runProcedure(procedure);
  finishRun();
}

/// Shapes on the stack at the end are drawn.
void Machine::finishRun() {
  if (stopped_) return;
  if (scopes_.back().isOpened) fail("'begin' without 'end'");
  size_t others = 0;
  const std::vector<Value> left = std::move(stack_);
  stack_.clear();
  const std::function<void(const Value&)> draw = [&](const Value& value) {
    if (const Shape* shape = std::get_if<Shape>(&value)) {
      emitDefault(*shape);
    } else if (const Items* items = std::get_if<Items>(&value); items && (*items)->hasShapes) {
      for (const Value& item : (*items)->items) draw(item);
    } else if (std::holds_alternative<Mark>(value)) {
      if (!lost_) fail("'[' without ']'");
    } else if (!std::holds_alternative<Broken>(value)) {
      ++others;
    }
  };
  for (const Value& value : left) draw(value);
  if (others && !diagnostics_.hasErrors())
    diagnostics_.warning(place_, std::to_string(others) + (others == 1 ? " value is" : " values are") +
                                     " left on the stack and have no effect; only shapes are drawn");
}

PlacedGraph Machine::run() {
  checkNames();
  runBody(static_cast<uint32_t>(program_.procedures.size() - 1), {}, {{0, 0, false}});
  isMain_ = false;
  for (uint32_t r = 0; r < rules_.size() && !stopped_; ++r)
    if (rules_[r].parameters == 0) instanceOf(r, {});           // they can start, whether or not they are called
  for (size_t i = 0; i < instances_.size() && !stopped_; ++i) { // which call for more of them
    const Instance instance = instances_[i];
    std::vector<Value> stack{graph_.beginRule(instance.number)};
    stack.insert(stack.end(), instance.arguments.begin(), instance.arguments.end());
    const uint32_t own = newDictionary();
    runBody(rules_[instance.rule].procedure, std::move(stack), {{0, 0, false}, {own, 0, false}});
  }
  for (const RuleDefinition& rule : rules_)
    if (rule.instances == 0 && !diagnostics_.hasErrors())
      diagnostics_.warning(rule.place, "rule '" + nameText(rule.name) + "' is never used");
  for (const GpgpVariable& variable : overrides_) {
    if (!variable.name) continue;
    const auto known = std::any_of(variables_.begin(), variables_.end(),
                                   [&](const auto& v) { return nameText(v.first) == variable.name; });
    if (known) continue;
    core::Suggestion suggestion(variable.name);
    for (const auto& [name, set] : variables_) suggestion.offer(nameText(name));
    diagnostics_.error({},
                       std::string("there is no var '") + variable.name + "' that could be set" + suggestion.text());
  }
  if (!graph_.hasAxiom() && !diagnostics_.hasErrors())
    diagnostics_.error({1, 1}, "there is no axiom; expected one as: /Box axiom");
  return graph_.finish();
}

PlacedGraph compile(std::string_view text, std::span<const GpgpVariable> overrides, Diagnostics& diagnostics,
                    std::pmr::memory_resource* memory) {
  const Program program = scan(text, diagnostics);
  return Machine(program, overrides, diagnostics, memory).run();
}

} // namespace gpgp::spawn::gml
