#include "spawn/cga/lower.h"

#include "core/suggest.h"

#include <algorithm>

namespace gpgp::spawn::cga {

namespace {
constexpr uint32_t kMostSteps = 400'000, kMostRules = 4000, kMostTerminals = 1000, kMostNested = 400;
constexpr size_t kMostText = 4u << 20;
constexpr uint32_t kDeepest = 100; ///< operators nest 200 deep in the language
} // namespace

void Lowering::misfit(const std::string& what, Place place) const {
  throw Misfit{what, at_ ? at_->file() : std::string(), place};
}

GraphText Lowering::run(Entity& start) {
  try {
    const State state;
    const Text begin = ruleOf(start, {}, state, start.definition->place);
    while (!pending_.empty()) {
      const auto next = std::move(pending_.back());
      pending_.pop_back();
      next();
      if (text_.size() > kMostText) misfit("a program of so many different shapes", start.definition->place);
    }
    std::string head = "axiom Box Start;\n";
    for (size_t i = 0; i < result_.terminals.size(); ++i)
      head += "terminal " + terminalName(static_cast<uint32_t>(i)) + " (1, " + std::to_string(i) + ");\n";
    // Whatever the height of an axiom: it is the rectangle on which it stands.
    result_.text = head + "Start = ResizeCorner(ShapeSize(X),0,ShapeSize(Z)) " + begin.text + ";\n" + text_;
  } catch (const Misfit& misfit) {
    result_ = {};
    result_.why = misfit.what;
    result_.file = misfit.file;
    result_.place = misfit.place;
  }
  return std::move(result_);
}

// ---------------------------------------------------------------- text

namespace {
/// A name of PGA-shape, to which a number is added.
std::string asName(const std::string& text) {
  std::string name;
  for (const char c : text)
    name += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '_';
  return name.empty() || (name[0] >= '0' && name[0] <= '9') ? "_" + name : name;
}
} // namespace

std::string Lowering::terminalName(uint32_t number) const {
  return asName(result_.terminals[number].name) + "_t" + std::to_string(number);
}

void Lowering::define(const std::string& name, Text body) {
  text_ += name + " = " + body.text + ";\n";
  aliases_[name] = body.text;
  std::string to = body.text; // where rules that only lead on lead to
  for (auto found = aliases_.find(to); found != aliases_.end() && to != name; found = aliases_.find(to))
    to = found->second;
  if (to == name) misfit("a rule that leads back to itself and does nothing else", {});
}

Lowering::Text Lowering::limited(Text text) {
  if (text.depth < kDeepest) return text;
  const std::string name = "Part__" + std::to_string(names_++);
  define(name, std::move(text));
  return {name, 1};
}

Lowering::Text Lowering::wrapped(const std::string& before, Text inner) {
  if (inner.isNothing()) return inner;
  inner = limited(std::move(inner));
  return {before + " " + inner.text, inner.depth + 1};
}

Lowering::Text Lowering::joined(const std::string& before, std::vector<Text> ways) {
  if (std::all_of(ways.begin(), ways.end(), [](const Text& way) { return way.isNothing(); })) return nothing();
  Text result{before + " {", 0};
  for (size_t i = 0; i < ways.size(); ++i) {
    ways[i] = limited(std::move(ways[i]));
    result.text += (i ? " | " : " ") + ways[i].text;
    result.depth = std::max(result.depth, ways[i].depth);
  }
  result.text += " }";
  ++result.depth;
  return result;
}

uint32_t Lowering::terminalNumber(GraphTerminal terminal) {
  std::string key =
      terminal.name + '\n' + terminal.texture + '\n' + terminal.asset + (terminal.isReport ? "\n1" : "\n0");
  for (int i = 0; i < 4; ++i) key += " " + text(terminal.color[i]);
  const auto [found, isNew] = terminals_.try_emplace(key, static_cast<uint32_t>(result_.terminals.size()));
  if (isNew) result_.terminals.push_back(std::move(terminal));
  return found->second;
}

Lowering::Text Lowering::terminal(const std::string& name, const State& state) {
  if (state.roof && state.roof->overhangs)
    misfit("a roof with overhangs that comp(f) does not take apart", state.roof->place);
  const bool isFace = state.isMesh && (state.form == Form::upright || state.form == Form::trapezoid);
  if (isFace && state.extents[2] != Extent::zero) misfit("a roof's face whose scope has a height, but no solid,", {});
  const uint32_t number = terminalNumber({name, state.color, state.texture, state.asset, false});
  if (result_.terminals.size() > kMostTerminals) misfit("a program of so many different terminals", {});
  return {(state.form == Form::flat ? "ToFace(0) " : "") + terminalName(number), 2};
}

/// An instance without extents, whose attribute is the value.
Lowering::Text Lowering::report(const std::string& name, const FormulaPtr& value) {
  const uint32_t number = terminalNumber({name, glm::vec4(1), {}, {}, true});
  return {"SetAttribute(" + text(value) + ") ResizeCorner(0,0,0) " + terminalName(number), 3};
}

Lowering::Text Lowering::condition(const FormulaPtr& condition, Text yes, Text no) {
  if (condition->isNumber()) return condition->value != 0 ? yes : no;
  if (yes.text == no.text && !condition->draws) return yes;
  return joined("If(" + text(condition) + ")", {std::move(yes), std::move(no)});
}

/// RandomRule, whose chances are those of the machine to the last bit: its sums are the differences there.
Lowering::Text Lowering::chooses(const std::vector<float>& chances, std::vector<Text> ways, Place place) {
  float sum = 0;
  Text result{"RandomRule(Rand(0,1)) {", 0};
  for (size_t i = 0; i < ways.size(); ++i) {
    const bool isLast = i + 1 == ways.size();
    const float chance = isLast ? shader::subtract(100, sum) : chances[i];
    const bool isExact = chance * 1024 == std::floor(chance * 1024);
    if ((!isExact && ways.size() > 2) || chance < 0) misfit("percentages that are not multiples of 1/1024", place);
    sum = shader::add(sum, chance);
    ways[i] = limited(std::move(ways[i]));
    result.text += (i ? " | " : " ") + text(chance) + ": " + ways[i].text;
    result.depth = std::max(result.depth, ways[i].depth);
  }
  if (sum != 100) misfit("percentages that do not sum up to 100", place);
  result.text += " }";
  ++result.depth;
  return result;
}

// ---------------------------------------------------------------- rules

std::string Lowering::keyOf(const Bound& bound) const {
  if (!bound.stale.empty()) return "?" + bound.stale;
  const Value& v = bound.value;
  std::string key =
      std::to_string(static_cast<int>(v.kind)) + (v.formula ? text(v.formula) : std::string()) + '"' + v.string + '"';
  for (const Value& inner : v.values) key += "(" + keyOf(Bound{inner, {}}) + ")";
  return key;
}

std::string Lowering::keyOf(const State& state) const {
  std::string key = std::to_string(static_cast<int>(state.form)) + (state.isMesh ? state.isTilted ? "t" : "m" : "");
  if (const auto& roof = state.roof)
    key += " " + std::to_string(roof->form) + " " + text(roof->overhang) + " " + text(roof->overhangAtGables) + " " +
           text(roof->flattest) + " " + text(roof->steepest) + '\n';
  for (int i = 0; i < 3; ++i)
    key += "," + std::to_string(static_cast<int>(state.extents[i])) + "," + std::to_string(state.axes[i]);
  for (int i = 0; i < 4; ++i) key += "," + text(state.color[i]);
  key += '\n' + state.texture + '\n' + state.asset;
  for (const auto& [slot, bound] : state.attributes) key += '\n' + std::to_string(slot) + "=" + keyOf(bound);
  return key;
}

Lowering::Text Lowering::ruleOf(Entity& entity, const std::vector<Bound>& arguments, const State& state, Place place) {
  State begin = state;
  begin.made = false;
  begin.moved = {number(0), number(0), number(0)};
  begin.locals.clear();
  std::string key = std::to_string(reinterpret_cast<uintptr_t>(&entity)) + "/" + keyOf(begin);
  for (const Bound& argument : arguments) key += '\n' + keyOf(argument);
  const auto [found, isNew] = rules_.try_emplace(key, asName(entity.owner->prefix + entity.definition->name) + "_" +
                                                          std::to_string(rules_.size()));
  if (!isNew) return {found->second, 1};
  if (rules_.size() > kMostRules) misfit("a rule that is called with so many different values", place);
  const std::string name = found->second;
  pending_.push_back([this, &entity, arguments, begin, name] {
    const Definition& d = *entity.definition;
    Scope scope{entity.scope, entity.owner->prefix + d.name, false, {}};
    State own = begin;
    at_ = &scope;
    for (size_t i = 0; i < arguments.size(); ++i) own.locals[d.parameters[i]] = arguments[i];
    for (const Local& local : d.locals) {
      draws_ = 0;
      own.locals[local.name] = kept(value(*local.value, scope, own));
      if (draws_) misfit("a random number that a shape has to remember", local.place);
    }
    define(name, bodyOf(d.body, scope, std::move(own)));
    at_ = nullptr;
  });
  return {name, 1};
}

Lowering::Text Lowering::bodyOf(const Body& body, Scope& scope, State state) {
  return sequence({&body, 0, true, nullptr, false}, scope, std::move(state));
}

/// What becomes of a shape from a statement on.
Lowering::Text Lowering::sequence(Rest rest, Scope scope, State state) {
  struct Nested {
    uint32_t& depth;
    ~Nested() { --depth; }
  } nested{nested_};
  if (++nested_ > kMostNested) misfit("a rule of so many statements", {});
  if (++calls_ > kMostSteps) misfit("a program of so many cases", {});
  while (rest.next < rest.body->size() || rest.outer) {
    if (rest.next >= rest.body->size()) {
      const Rest outer = *rest.outer;
      rest = outer;
      continue;
    }
    const Statement& s = (*rest.body)[rest.next];
    if (s.kind == Statement::Kind::pop) {
      if (rest.isBracket) { // a bracket ends, and with it the way
        isOpenBracket_ = isOpenBracket_ || !state.made;
        return nothing();
      }
      ++rest.next; // the compiler said so
      continue;
    }
    return statement(s, rest, scope, std::move(state));
  }
  return state.made ? nothing() : terminal(scope.name, state);
}

Lowering::Text Lowering::statement(const Statement& s, Rest rest, const Scope& scope, State state) {
  const Rest here = rest;
  ++rest.next;
  const auto goOn = [&](State after) { return sequence(rest, scope, std::move(after)); };
  // Two ways: what makes shapes, and what follows.
  const auto fork = [&](Makes makes, size_t next, Text way, const Rest& behind) {
    if (!forks(makes, *here.body, next, here.isTail)) return way;
    State after = state;
    after.made = state.made || makes == Makes::shapes;
    return joined("Replicate()", {std::move(way), sequence(behind, scope, std::move(after))});
  };
  switch (s.kind) {
  case Statement::Kind::push: {
    const size_t close = bracketEnd(*here.body, here.next);
    const std::span<const Statement> inside = std::span(*here.body).subspan(here.next + 1, close - here.next - 1);
    Rest behind = rest;
    behind.next = close + 1;
    const auto isNil = [](const Statement& inner) {
      return inner.kind == Statement::Kind::call && inner.name == "NIL";
    };
    const Makes makes = whatMake(inside);
    if (makes == Makes::nothing) {
      if (std::any_of(inside.begin(), inside.end(), isNil)) misfit("NIL in [ ]", s.place);
      return sequence(behind, scope, std::move(state));
    }
    const bool outer = std::exchange(isOpenBracket_, false);
    Rest within{here.body, here.next + 1, here.isTail, nullptr, true};
    State begin = state;
    Text way = sequence(within, scope, std::move(begin));
    if (isOpenBracket_ && !state.made && makes == Makes::shapes) misfit("a [ ] of which nothing may come", s.place);
    isOpenBracket_ = outer;
    return fork(makes, close + 1, std::move(way), behind);
  }
  case Statement::Kind::pop: return goOn(std::move(state)); // not reached
  case Statement::Kind::cases:
  case Statement::Kind::stochastic: return branches(s, rest, scope, state);
  case Statement::Kind::leaf: return fork(Makes::shapes, rest.next, terminal(s.name, state), rest);
  case Statement::Kind::call: break;
  }
  if (s.name == "NIL" && !s.hasBlock) {
    state.made = true;
    return goOn(std::move(state));
  }
  std::string last;
  bool isMissing = false;
  Module* module = resolvePath(s.name, scope.module, last, isMissing);
  if (isMissing) misfit("'" + s.name + "' of a file that was not found", s.place);
  const bool isRule = !s.hasBlock && (module->find(last, true, s.arguments.size()) ||
                                      (last == "start" && s.arguments.empty() && module->start));
  if (!isRule && s.name == "set") return setAttribute(s, scope, std::move(state), goOn);
  if (!isRule && isUnsupportedOperation(s.name)) misfit("the operation '" + s.name + "'", s.place);
  const auto operation = isRule ? std::nullopt : findOperation(s.name);
  if (const Makes makes = whatMakes(s); makes != Makes::nothing)
    return fork(makes, rest.next, item(s, scope, state), rest);
  if (!operation) misfit("'" + s.name + "'", s.place);
  bool tookNext = false;
  const Statement* next = rest.next < rest.body->size() ? &(*rest.body)[rest.next] : nullptr;
  return this->operation(
      s, *operation, scope, std::move(state),
      [&](State after) {
        Rest behind = rest;
        if (tookNext) ++behind.next;
        return sequence(behind, scope, std::move(after));
      },
      next, tookNext);
}

/// A statement that makes shapes, and nothing else of the shape.
Lowering::Text Lowering::item(const Statement& s, const Scope& scope, State state) {
  std::string last;
  bool isMissing = false;
  Module* module = resolvePath(s.name, scope.module, last, isMissing);
  Entity* entity = s.hasBlock ? nullptr : module->find(last, true, s.arguments.size());
  if (!entity && last == "start" && s.arguments.empty() && !s.hasBlock) entity = module->start;
  if (entity) {
    std::vector<Bound> arguments;
    for (const ExpressionPtr& a : s.arguments) {
      draws_ = 0;
      arguments.push_back(kept(value(*a, scope, state)));
      if (draws_) misfit("a random number that is given to a rule", a->place);
    }
    return ruleOf(*entity, arguments, state, s.place);
  }
  const auto operation = findOperation(s.name);
  if (!operation) return terminal(s.name, state);
  switch (*operation) {
  case Operation::report_: {
    const Value name = argument(*s.arguments[0], scope, state), v = argument(*s.arguments[1], scope, state);
    if (name.kind != Value::Kind::string) misfit("a report whose name depends on the shape", s.place);
    return report(name.string, numberOf(v, s.place));
  }
  case Operation::split_: return split(s, scope, state);
  case Operation::comp_: return components(s, scope, state);
  case Operation::setback_: return setback(s, scope, state);
  default: misfit("the operation '" + s.name + "'", s.place);
  }
}

Lowering::Text Lowering::branches(const Statement& s, const Rest& rest, const Scope& scope, const State& state) {
  const bool isTail = !isFollowed(*rest.body, rest.next, rest.isTail);
  const auto way = [&](const Branch* branch) {
    if (!branch) return sequence(rest, scope, state);
    return sequence({&branch->body, 0, isTail, &rest, false}, scope, state);
  };
  if (s.kind == Statement::Kind::stochastic) {
    std::vector<float> chances;
    std::vector<Text> ways;
    for (const Branch& branch : s.branches) {
      if (branch.condition && branch.condition->kind != Expression::Kind::number)
        misfit("a percentage that is not a plain number", branch.condition->place);
      chances.push_back(branch.condition ? static_cast<float>(branch.condition->number) : 0.0f);
      ways.push_back(way(&branch));
    }
    if (s.branches.empty() || s.branches.back().condition) ways.push_back(way(nullptr));
    return chooses(chances, std::move(ways), s.place);
  }
  std::vector<std::pair<FormulaPtr, Text>> ways;
  for (const Branch& branch : s.branches) {
    const FormulaPtr condition =
        branch.condition ? fits(asBoolean(argumentNumber(*branch.condition, scope, state)), branch.condition->place)
                         : number(1);
    if (condition->isNumber() && condition->value == 0) continue;
    ways.push_back({condition, way(&branch)});
    if (condition->isNumber()) break;
  }
  const bool hasElse = !ways.empty() && ways.back().first->isNumber();
  Text result = hasElse ? std::move(ways.back().second) : way(nullptr);
  for (size_t i = ways.size() - (hasElse ? 1 : 0); i-- > 0;)
    result = condition(ways[i].first, std::move(ways[i].second), limited(std::move(result)));
  return result;
}

} // namespace gpgp::spawn::cga
