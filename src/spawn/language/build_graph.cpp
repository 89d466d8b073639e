#include "spawn/language/build_graph.h"

#include "core/suggest.h"
#include "spawn/graph/export_labels.h"
#include "spawn/language/append_graph.h"
#include "spawn/language/check_context.h"
#include "spawn/language/check_shapes.h"
#include "spawn/language/corners.h"
#include "spawn/language/expressions.h"
#include "spawn/language/resolve_rules.h"
#include "spawn/language/spellings.h"
#include "spawn/shared/expression.h"
#include "spawn/shared/roofs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <deque>

namespace gpgp::spawn {
namespace {
using namespace shader;

std::optional<uint32_t> shapeNamed(const std::string& name) {
  for (uint32_t s = 0; s < kShapeCount; ++s)
    if (name == shapeName(s)) return s;
  return std::nullopt;
}

std::string count(size_t n, const char* noun) { return std::to_string(n) + " " + noun + (n == 1 ? "" : "s"); }

/// Adds one grammar to a graph that others share. All have the same tags.
class Builder {
public:
  Builder(const GrammarPart& part, Graph& graph, std::vector<NodePlace>& places, Tags& tags, uint32_t number)
      : part_(part), tree_(*part.tree), diagnostics_(*part.diagnostics), graph_(graph), places_(places), tags_(tags),
        number_(number), firstRule_(graph.rules.size()), expressions_(variables_, graph_, diagnostics_) {}

  void run() {
    defineVariables(part_.overrides);
    defineTerminals();
    defineRules();
    for (size_t i = 0; i < tree_.rules.size(); ++i) buildRule(i);
    const std::vector<uint32_t> nodes = resolveRules(ruleTargets_, [&](size_t i) {
      const RuleDefinition& rule = tree_.rules[i];
      diagnostics_.error(rule.place, "rule '" + rule.name + "' leads back to itself without any operator");
    });
    for (size_t i = 0; i < nodes.size(); ++i) graph_.rules[firstRule_ + i].node = nodes[i];
    for (const auto& [edge, rule] : ruleEdges_) graph_.edges[edge].target = graph_.rules[firstRule_ + rule].node;
    buildAxioms();
  }

private:
  enum class NameKind { terminal, rule };
  struct Name {
    NameKind kind;
    size_t index;
    Place place;
  };

  uint32_t addOwnName(const std::string& name) {
    return addName(graph_, part_.name.empty() ? name : part_.name + "." + name);
  }

  bool define(const std::string& name, Name what) {
    const auto [it, isNew] = names_.try_emplace(name, what);
    if (!isNew)
      diagnostics_.error(what.place,
                         "'" + name + "' is defined twice; the first time in " + diagnostics_.where(it->second.place));
    else if (isOperatorName(name))
      diagnostics_.error(what.place, "'" + name + "' is the name of an operator; expected another name");
    return isNew;
  }

  void defineVariables(std::span<const GpgpVariable> overrides) {
    std::map<std::string, float> set;
    for (const GpgpVariable& variable : overrides) {
      if (!variable.name) continue;
      const bool known = std::any_of(tree_.variables.begin(), tree_.variables.end(),
                                     [&](const VariableDefinition& v) { return v.name == variable.name; });
      if (!known) {
        core::Suggestion suggestion(variable.name);
        for (const VariableDefinition& v : tree_.variables) suggestion.offer(v.name);
        diagnostics_.error({}, std::string("there is no var '") + variable.name + "' that could be set" +
                                   suggestion.text());
      }
      if (!isUsable(variable.value))
        diagnostics_.error({}, std::string("var '") + variable.name + "' cannot be set to " +
                                   numberText(variable.value) + "; " + kUsableNumbers);
      set[variable.name] = settle(variable.value);
    }
    for (const VariableDefinition& variable : tree_.variables) {
      const float value = expressions_.constant(variable.value, "a var");
      const auto it = set.find(variable.name);
      if (!variables_.try_emplace(variable.name, it == set.end() ? value : it->second).second)
        diagnostics_.error(variable.place, "var '" + variable.name + "' is defined twice");
    }
  }

  void defineTerminals() {
    for (const TerminalDefinition& line : tree_.terminals) {
      const uint32_t bucket = graph_.buckets++;
      if (bucket == kMaxBuckets) // the others are as wrong
        diagnostics_.error(line.place, "more than " + std::to_string(kMaxBuckets) + " terminal lines");
      uint32_t kind = 1, index = 0;
      const bool broken = line.broken || std::any_of(line.arguments.begin(), line.arguments.end(),
                                                     [](const auto& a) { return a.kind == ExpressionKind::broken; });
      if (broken) {
        // was reported
      } else if (line.arguments.size() < 2) {
        diagnostics_.error(line.place,
                           "a terminal needs (kind, index), found " + count(line.arguments.size(), "value"));
      } else {
        kind = integer(line.arguments[0], 1, "a terminal's kind is 0 (triangles) or 1 (an instanced mesh)");
        index = integer(line.arguments[1], 1 << 24, "a terminal's index is a whole number from 0");
        for (size_t i = 2; i < line.arguments.size(); ++i)
          expressions_.constant(line.arguments[i], "a terminal's value");
        if (line.arguments.size() > 2)
          diagnostics_.warning(line.arguments[2].place,
                               "a terminal has (kind, index); values behind them have no effect");
      }
      for (const auto& [place, name] : line.names) {
        const size_t terminal = graph_.terminals.size();
        if (define(name, {NameKind::terminal, terminal, place}))
          graph_.terminals.push_back({addOwnName(name), kind, index, bucket});
      }
    }
  }

  uint32_t integer(const Expression& expression, uint32_t largest, const char* expected) {
    const float value = expressions_.constant(expression, "a terminal's value");
    if (value >= 0 && value <= static_cast<float>(largest) && value == floor(value))
      return static_cast<uint32_t>(value);
    diagnostics_.error(expression.place, expected);
    return 0;
  }

  void defineRules() {
    ruleTargets_.resize(tree_.rules.size());
    for (size_t i = 0; i < tree_.rules.size(); ++i) {
      define(tree_.rules[i].name, {NameKind::rule, i, tree_.rules[i].place});
      graph_.rules.push_back({addOwnName(tree_.rules[i].name)});
    }
  }

  void buildRule(size_t index) {
    const RuleDefinition& rule = tree_.rules[index];
    const size_t first = graph_.nodes.size();
    rule_ = static_cast<uint32_t>(firstRule_ + index);
    buildBody(index, rule);
    rule_ = kNoRule;
    for (size_t n = first; n < graph_.nodes.size(); ++n)
      if (graph_.nodes[n].op != kOpTerminal) graph_.nodes[n].priority = rule.priority;
  }
  void buildBody(size_t index, const RuleDefinition& rule) {
    if (rule.alternatives.empty()) {
      ruleTargets_[index] = buildSuccessor(rule.body);
      return;
    }
    // 20%: A else: B is RandomRule(Rand(0, 1)) with probabilities
    const size_t errors = diagnostics_.errorCount();
    float given = 0;
    std::vector<Parameter> parameters{expressions_.drawnParameter()};
    for (const Branch& branch : rule.alternatives) {
      const bool isGiven = !branch.isElse && branch.label;
      const float p = isGiven ? expressions_.constant(*branch.label, "a probability") : std::max(0.0f, 100.0f - given);
      if (isGiven) given += p;
      parameters.push_back({kParameterConstant, floatBitsToUint(settle(p))});
    }
    if (given > 100.001f) // 3 * 33.34 is a slip as well, but not those of adding floats
      diagnostics_.warning(rule.place, "these probabilities add up to " + numberText(given) +
                                           "%; expected at most 100%: each counts as its share of the sum" +
                                           (rule.alternatives.back().isElse ? ", and nothing is left for 'else'" : ""));
    if (rule.alternatives.size() > kMaxSuccessors)
      diagnostics_.error(rule.place, "a rule takes at most " + std::to_string(kMaxSuccessors) +
                                         " alternatives, found " + std::to_string(rule.alternatives.size()));
    checkChances(rule.place, rule.alternatives, std::span(parameters).subspan(1), errors);
    ruleTargets_[index] = {addNode(rule.place, kOpRandomRule, parameters, rule.alternatives), std::nullopt};
  }

  /// Of numbers that are known. errors: how many there were before anything of this was read; what is not whole may
  /// be 0 for that.
  void checkChances(Place place, const std::vector<Branch>& branches, std::span<const Parameter> chances,
                    size_t errors) {
    bool any = false;
    for (size_t i = 0; i < branches.size(); ++i) {
      const bool known = branches[i].label && chances[i].kind == kParameterConstant;
      const float chance = uintBitsToFloat(chances[i].value);
      if (known && chance < 0) diagnostics_.error(branches[i].label->place, "a probability must not be negative");
      any = any || !known || chance > 0;
    }
    if (!any && diagnostics_.errorCount() == errors)
      diagnostics_.error(place, "these probabilities are all 0; expected one that is more");
  }

  Target buildSuccessor(const Successor& successor) {
    if (successor.call) return buildCall(*successor.call);
    if (successor.name.empty()) return {}; // was reported
    const auto it = names_.find(successor.name);
    if (it == names_.end()) {
      diagnostics_.error(successor.place, isOperatorName(successor.name)
                                              ? "expected '(' after the operator " + successor.name
                                              : "there is no rule or terminal '" + successor.name + "'" +
                                                    suggestionFor(successor.name, true));
      return {};
    }
    if (it->second.kind == NameKind::rule) {
      if (it->second.index >= usedRules_.size()) usedRules_.resize(tree_.rules.size());
      usedRules_[it->second.index] = true;
      return {kNoNode, it->second.index};
    }
    return {terminalNode(static_cast<uint32_t>(it->second.index), successor.place), std::nullopt};
  }

  /// What may be meant instead of an operator's name; ofShapes: instead of a rule's or terminal's, which it may be as
  /// well.
  std::string suggestionFor(const std::string& name, bool ofShapes) const {
    if (!diagnostics_.takesErrors()) return {};
    core::Suggestion suggestion(name);
    if (ofShapes)
      for (const auto& [candidate, what] : names_) suggestion.offer(candidate);
    for (const Spelling& spelling : kSpellings) suggestion.offer(spelling.name);
    return suggestion.text();
  }

  void reportUnknown(const Call& call) {
    diagnostics_.error(call.place, "there is no operator '" + call.name + "'" + suggestionFor(call.name, false));
  }

  /// A rule has one for each of its terminals, which says whose it is.
  uint32_t terminalNode(uint32_t terminal, Place place) {
    const auto [it, isNew] = terminalNodes_.try_emplace({rule_, terminal}, static_cast<uint32_t>(graph_.nodes.size()));
    if (isNew) {
      graph_.nodes.push_back({kOpTerminal, terminal, graph_.terminals[terminal].bucket});
      graph_.nodes.back().rule = rule_;
      places_.push_back({number_, place});
    }
    return it->second;
  }

  // ---------------------------------------------------------------- operators

  Target buildCall(const Call& call) {
    if (const Operator* op = operatorWritten(call.name)) return {buildOperator(call, *op), std::nullopt};
    if (call.name == "Discard" || call.name == "Generate") {
      if (!call.arguments.empty() || !call.branches.empty())
        diagnostics_.error(call.place, call.name + "() takes neither arguments nor successors");
      checkNames(call, false);
      for (const Branch& branch : call.branches) buildSuccessor(branch.successor);
      if (call.name == "Discard") return {};
      if (!generate_) { // a terminal without a name of its own
        if (graph_.buckets == kMaxBuckets)
          diagnostics_.error(call.place, "Generate() is a terminal line more than the " + std::to_string(kMaxBuckets) +
                                             " that a grammar can have");
        generate_ = static_cast<uint32_t>(graph_.terminals.size());
        graph_.terminals.push_back({addOwnName("Generate"), 0, 0, graph_.buckets++});
      }
      return {terminalNode(*generate_, call.place), std::nullopt};
    }
    if (call.name.substr(0, 12) == "SetAsDynamic") return {buildSetGeometry(call), std::nullopt};
    if (names_.count(call.name))
      diagnostics_.error(call.place, "'" + call.name + "' is not an operator; expected no '(' after it");
    else
      reportUnknown(call);
    checkNames(call, true);
    for (const Branch& branch : call.branches) buildSuccessor(branch.successor);
    return {};
  }

  /// Where it is not known what arguments and labels are for: only what can have no meaning is reported. mayBeTags:
  /// a name alone may be one.
  void checkNames(const Call& call, bool mayBeTags) {
    const auto check = [&](const Expression& e) {
      const bool name = e.kind == ExpressionKind::name;
      if (name && (mayBeTags || isAxis(e.name) || modeNamed(e.name))) return;
      if (e.kind == ExpressionKind::pair)
        for (const Expression& part : e.arguments) expressions_.parameter(part);
      else
        expressions_.parameter(e);
    };
    for (const Expression& argument : call.arguments) check(argument);
    for (const Branch& branch : call.branches)
      if (branch.label) expressions_.parameter(*branch.label);
  }

  uint32_t buildOperator(const Call& call, const Operator& op) {
    const std::string_view arguments = op.inParentheses();
    std::vector<Parameter> parameters;
    uint32_t argument = 0, argument2 = 0, axes = 0;
    const size_t errors = diagnostics_.errorCount();
    if (call.arguments.size() != arguments.size()) {
      const bool broken = call.broken || std::any_of(call.arguments.begin(), call.arguments.end(),
                                                     [](const auto& a) { return a.kind == ExpressionKind::broken; });
      if (!broken)
        diagnostics_.error(call.place, call.name + " takes " + count(arguments.size(), "argument") + ", found " +
                                           std::to_string(call.arguments.size()));
      Call alone;
      alone.arguments = call.arguments;
      checkNames(alone, arguments.find('t') != std::string::npos);
    } else {
      for (size_t i = 0; i < arguments.size(); ++i) {
        if (arguments[i] == 'a') {
          argument |= axisOf(call.arguments[i], diagnostics_).value_or(0) << (2 * axes++);
        } else if (arguments[i] == 'm') {
          argument2 = modeOf(call.arguments[i]);
        } else if (arguments[i] == 't') {
          argument = tagOf(call.arguments[i]);
        } else {
          parameters.push_back(expressions_.parameter(call.arguments[i]));
        }
      }
      checkRoof(call, op.op, parameters);
    }
    checkBranches(call, op);
    if (op.hasSuccessorValues())
      for (const Branch& branch : call.branches)
        parameters.push_back(branch.label ? expressions_.parameter(*branch.label) : Parameter{});
    if (op.op == kOpRandomRule && !call.broken)
      checkChances(call.place, call.branches, std::span(parameters).last(call.branches.size()), errors);
    std::vector<Branch> branches = call.branches;
    if (op.op == kOpCompSplit && call.form == SuccessorForm::chain && branches.size() == 1)
      branches.assign(3, branches[0]); // all faces alike
    const uint32_t node = addNode(call.place, op.op, parameters, branches);
    graph_.nodes[node].argument = argument;
    graph_.nodes[node].argument2 = argument2;
    return node;
  }

  /// Constants that name a form, a measure or a face of a roof, and angles of its slopes.
  void checkRoof(const Call& call, uint32_t op, std::span<const Parameter> values) {
    const auto constant = [&](size_t i) { // NaN: it is none
      return values[i].kind == kParameterConstant ? std::bit_cast<float>(values[i].value) : NAN;
    };
    const auto refuse = [&](size_t i, const char* what) {
      diagnostics_.error(call.arguments[i].place, std::string(what) + "; this is " + numberText(constant(i)));
    };
    const auto within = [&](size_t i, uint32_t count, const char* what) {
      if (constant(i) < 0 || constant(i) >= static_cast<float>(count)) refuse(i, what);
    };
    if (op == kOpToRoofFace) within(0, 5, "the face of a roof is 0 to 4");
    if (op != kOpRaiseRoof) return;
    within(0, kRoofForms, "the form of a roof is 0 to 7");
    within(1, 3, "the measure of a roof is 0 (height), 1 (rise by run) or 2 (degrees)");
    if (std::floor(constant(1)) == static_cast<float>(kRoofByAngle) && std::abs(constant(2)) >= 90)
      refuse(2, "the angle of a roof is less than 90 degrees");
  }

  void checkBranches(const Call& call, const Operator& op) {
    const size_t found = call.branches.size();
    const bool comp = op.op == kOpCompSplit;
    if (call.broken) {
      // was reported; how many there are is not known
    } else if (found == 0) {
      diagnostics_.error(call.place, call.name + " needs a successor; shapes end in a terminal or Discard()");
    } else if (call.form == SuccessorForm::chain &&
               (op.hasSuccessorValues() || (op.successors > 1 && !comp && op.successors != kMany))) {
      diagnostics_.error(call.branches[0].successor.place, "expected '{' after " + call.name + "(...)");
    } else if (op.successors != kMany && found != op.successors && !(comp && call.form == SuccessorForm::chain)) {
      diagnostics_.error(call.place, call.name + " takes " + count(op.successors, "successor") +
                                         (comp ? " (top | bottom | sides)" : "") + ", found " + std::to_string(found));
    } else if (found > kMaxSuccessors) {
      diagnostics_.error(call.place, call.name + " takes at most " + std::to_string(kMaxSuccessors) +
                                         " successors, found " + std::to_string(found));
    }
    for (const Branch& branch : call.branches) {
      if (branch.isElse)
        diagnostics_.error(branch.successor.place, "'else' has no meaning in " + call.name);
      else if (branch.successor.name.empty() && !branch.successor.call)
        continue; // was reported
      else if (op.hasSuccessorValues() && !branch.label && call.form == SuccessorForm::braces)
        diagnostics_.error(branch.successor.place, "expected a value before the successor of " + call.name);
      else if (!op.hasSuccessorValues() && branch.label)
        diagnostics_.error(branch.label->place, call.name + " takes successors without a value before them");
    }
  }

  static constexpr float kLargestTag = 16777216;
  /// A name, unless it is a var, or a whole number.
  uint32_t tagOf(const Expression& expression) {
    if (expression.kind == ExpressionKind::name && !variables_.count(expression.name)) {
      const auto [tag, isNew] = tags_.try_emplace(expression.name);
      if (isNew) tag->second = kTagName | addName(graph_, expression.name);
      return tag->second;
    }
    const size_t errors = diagnostics_.errorCount();
    const float value = expressions_.constant(expression, "a tag");
    if (expression.kind != ExpressionKind::broken && value >= 0 && value <= kLargestTag && value == floor(value) &&
        diagnostics_.errorCount() == errors)
      return static_cast<uint32_t>(value);
    if (expression.kind != ExpressionKind::broken && diagnostics_.errorCount() == errors)
      diagnostics_.error(expression.place, "a tag is a name or a whole number from 0");
    return static_cast<uint32_t>(kLargestTag) + ++wrongTags_; // which no other one has
  }

  static bool isAxis(const std::string& name) { return name == "X" || name == "Y" || name == "Z"; }
  static std::optional<uint32_t> modeNamed(const std::string& name) {
    for (uint32_t mode = 0; mode <= kRepeatAnchorToEnd; ++mode)
      if (name == repeatModeText(mode)) return mode;
    return std::nullopt;
  }
  uint32_t modeOf(const Expression& expression) {
    if (expression.kind == ExpressionKind::broken) return 0;
    if (expression.kind == ExpressionKind::name)
      if (const auto mode = modeNamed(expression.name)) return *mode;
    diagnostics_.error(expression.place, "expected ADJUST_TO_FILL, ANCHOR_TO_START or ANCHOR_TO_END");
    return 0;
  }

  uint32_t buildSetGeometry(const Call& call) {
    const bool prism = call.name.find("RightPrism") != std::string::npos;
    const bool convex = call.name.find("Convex") != std::string::npos;
    uint32_t shape = prism ? kShapeDynamicRightPrism : kShapeDynamicPolygon;
    if (convex) shape = prism ? kShapeDynamicConvexRightPrism : kShapeDynamicConvexPolygon;
    if (!isOperatorName(call.name)) reportUnknown(call);
    checkBranches(call, kOperators[kOpSetGeometry]);
    const uint32_t polygon = buildPolygon(call.place, call.arguments, convex);
    const uint32_t node = addNode(call.place, kOpSetGeometry, {}, call.branches);
    graph_.nodes[node].argument = shape;
    graph_.nodes[node].argument2 = polygon;
    return node;
  }

  /// Corners in either order; the graph keeps them counter-clockwise.
  uint32_t buildPolygon(Place place, const std::vector<Expression>& corners, bool convex) {
    std::vector<std::array<float, 2>> points;
    const size_t errors = diagnostics_.errorCount();
    bool isWhole = true;
    for (const Expression& corner : corners) {
      if (corner.kind == ExpressionKind::broken) {
        isWhole = false;
        continue;
      }
      if (corner.kind != ExpressionKind::pair) {
        diagnostics_.error(corner.place, "expected a corner as (x, y)");
        continue;
      }
      const auto& [x, y] = points.emplace_back(std::array{expressions_.constant(corner.arguments[0], "a corner"),
                                                          expressions_.constant(corner.arguments[1], "a corner")});
      if (!isCorner(x, y)) diagnostics_.error(corner.place, kExpectedCorner);
    }
    if (diagnostics_.errorCount() > errors || !isWhole) return 0;
    std::string problem;
    const uint32_t polygon = addCorners(graph_, std::move(points), convex, problem);
    if (!problem.empty()) diagnostics_.error(place, problem);
    return polygon;
  }

  uint32_t addNode(Place place, uint32_t op, const std::vector<Parameter>& parameters,
                   const std::vector<Branch>& branches) {
    const uint32_t index = static_cast<uint32_t>(graph_.nodes.size());
    Node node;
    node.op = op;
    node.firstParameter = static_cast<uint32_t>(graph_.parameters.size());
    node.parameterCount = static_cast<uint32_t>(parameters.size());
    node.firstEdge = static_cast<uint32_t>(graph_.edges.size());
    node.edgeCount = static_cast<uint32_t>(branches.size());
    graph_.parameters.insert(graph_.parameters.end(), parameters.begin(), parameters.end());
    graph_.edges.resize(graph_.edges.size() + branches.size());
    graph_.nodes.push_back(node);
    places_.push_back({number_, place});
    for (size_t i = 0; i < branches.size(); ++i) {
      const Target target = buildSuccessor(branches[i].successor);
      const uint32_t edge = node.firstEdge + static_cast<uint32_t>(i);
      if (target.rule)
        ruleEdges_.emplace_back(edge, *target.rule);
      else
        graph_.edges[edge].target = target.node;
    }
    return index;
  }

  /// Each axiom line is a start; rules start with the shape of the first line that names them, else of the first line.
  void buildAxioms() {
    if (tree_.axioms.empty()) {
      if (!tree_.brokenAxiom) diagnostics_.error({1, 1}, "there is no axiom; expected a line as: axiom Box Start;");
      return;
    }
    const uint32_t first = static_cast<uint32_t>(graph_.axioms.size());
    for (size_t i = 0; i < tree_.rules.size(); ++i) graph_.rules[firstRule_ + i].axiom = first;
    std::vector<bool> named(tree_.rules.size());
    for (const AxiomDefinition& definition : tree_.axioms) {
      const uint32_t number = static_cast<uint32_t>(graph_.axioms.size());
      Axiom axiom;
      Successor start;
      start.place = definition.namePlace;
      start.name = definition.name;
      const Target target = buildSuccessor(start);
      axiom.node = target.node;
      if (target.rule) {
        Rule& rule = graph_.rules[firstRule_ + *target.rule];
        axiom.node = rule.node;
        axiom.name = rule.name;
        if (!named[*target.rule]) rule.axiom = number;
        named[*target.rule] = true;
      } else if (target.node != kNoNode) {
        axiom.name = graph_.terminals[graph_.nodes[target.node].argument].name;
      }
      if (number == first && !part_.name.empty()) axiom.name = addName(graph_, part_.name);
      setShape(axiom, definition);
      graph_.axioms.push_back(axiom);
    }
  }

  void setShape(Axiom& axiom, const AxiomDefinition& definition) {
    const auto shape = shapeNamed(definition.shape);
    if (!shape) {
      core::Suggestion suggestion(definition.shape);
      for (uint32_t s = 0; s < kShapeCount; ++s) suggestion.offer(shapeName(s));
      diagnostics_.error(definition.shapePlace,
                         "there is no shape '" + definition.shape +
                             "'; expected Triangle, Quad, Pentagon, "
                             "Hexagon, Heptagon, Octagon, Prism3, Box, Prism5 to Prism8, Sphere or a Dynamic... shape" +
                             suggestion.text());
      return;
    }
    axiom.shape = *shape;
    const bool dynamic = *shape >= kShapeDynamicConvexPolygon && *shape <= kShapeDynamicRightPrism;
    if (dynamic) {
      axiom.polygon = buildPolygon(definition.shapePlace, definition.corners,
                                   *shape == kShapeDynamicConvexPolygon || *shape == kShapeDynamicConvexRightPrism);
    } else {
      if (!definition.corners.empty())
        diagnostics_.error(definition.corners[0].place, "only Dynamic... shapes have corners of their own");
      axiom.polygon = usualPolygon(*shape);
    }
  }

public:
  /// Once all is built.
  void warnOfUnusedRules() {
    usedRules_.resize(tree_.rules.size());
    for (size_t i = 0; i < tree_.rules.size(); ++i)
      if (!usedRules_[i])
        diagnostics_.warning(tree_.rules[i].place, "rule '" + tree_.rules[i].name + "' is never used");
  }

private:
  const GrammarPart& part_;
  const SyntaxTree& tree_;
  Diagnostics& diagnostics_;
  Graph& graph_;
  std::vector<NodePlace>& places_; // by node
  Tags& tags_;
  const uint32_t number_; // of the part
  const size_t firstRule_;
  std::map<std::string, float> variables_;
  ExpressionCompiler expressions_;
  std::map<std::string, Name> names_;
  std::vector<Target> ruleTargets_;
  std::vector<std::pair<uint32_t, size_t>> ruleEdges_;
  uint32_t rule_ = kNoRule;                                         // whose body is being built
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> terminalNodes_; // by rule and terminal
  std::vector<bool> usedRules_;
  std::optional<uint32_t> generate_;
  uint32_t wrongTags_ = 0;
};
} // namespace

Graph buildGraph(std::span<const GrammarPart> parts, std::pmr::memory_resource* memory) {
  Graph graph(memory);
  addRegularPolygons(graph);
  std::vector<NodePlace> places;
  Tags tags;
  std::deque<Builder> builders; // they stay where they are
  for (const GrammarPart& part : parts) {
    const uint32_t number = static_cast<uint32_t>(&part - parts.data());
    if (part.baked)
      appendGraph(*part.baked, part.name, graph, tags, *part.diagnostics);
    else
      builders.emplace_back(part, graph, places, tags, number).run();
    if (part.places)
      for (const Place place : *part.places) places.push_back({number, place});
    places.resize(graph.nodes.size(), {number, {}});
  }
  const bool failed =
      std::any_of(parts.begin(), parts.end(), [](const GrammarPart& p) { return p.diagnostics->hasErrors(); });
  if (failed && graph.axioms.empty()) return graph; // analyse() needs one
  analyse(graph);
  checkOrder(graph, places, parts);
  if (failed) return graph; // what is missing may be what has an effect
  checkEffect(graph, places, parts);
  checkShapes(graph, places, parts);
  for (Builder& builder : builders) builder.warnOfUnusedRules();
  return graph;
}

Graph buildGraph(const SyntaxTree& tree, std::span<const GpgpVariable> overrides, Diagnostics& diagnostics,
                 std::pmr::memory_resource* memory) {
  const GrammarPart part{&tree, nullptr, overrides, &diagnostics, {}, {}, nullptr};
  return buildGraph({&part, 1}, memory);
}

Graph compile(std::string_view text, std::span<const GpgpVariable> overrides, Diagnostics& diagnostics,
              std::pmr::memory_resource* memory) {
  const SyntaxTree tree = parse(text, diagnostics);
  return buildGraph(tree, overrides, diagnostics, memory);
}

} // namespace gpgp::spawn
