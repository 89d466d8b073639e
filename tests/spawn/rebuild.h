// A syntax tree handed to a grammar builder call by call, so that what text gives can be compared with what code gives.
#pragma once
#include "spawn/language/spellings.h"
#include "spawn/language/syntax.h"

#include <gpgp/spawn_builder.h>

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace gpgp::test {

class Rebuild {
public:
  Rebuild(const spawn::SyntaxTree& tree, GpgpGrammarBuilder builder) : builder_(builder) {
    for (const auto& variable : tree.variables)
      variables_[variable.name] = gpgpAddVariable(builder, variable.name.c_str(), value(variable.value));
    for (const auto& axiom : tree.axioms) {
      std::vector<GpgpGrammarValue> corners;
      for (const auto& corner : axiom.corners) corners.push_back(value(corner));
      gpgpAddAxiom(builder, shape(axiom.shape), corners.data(), static_cast<uint32_t>(corners.size()),
                   axiom.name.c_str());
    }
    for (const auto& terminal : tree.terminals) {
      std::string names;
      for (const auto& name : terminal.names) names += name.second + " ";
      gpgpAddTerminal(builder, names.c_str(), static_cast<uint32_t>(terminal.arguments.at(0).number),
                      static_cast<uint32_t>(terminal.arguments.at(1).number));
    }
    for (const auto& rule : tree.rules) {
      if (!rule.alternatives.empty())
        gpgpAddRule(builder, rule.name.c_str(), nullptr, alternatives(rule.alternatives));
      else if (rule.body.call)
        gpgpAddRule(builder, rule.name.c_str(), nullptr, call(*rule.body.call));
      else
        gpgpAddRule(builder, rule.name.c_str(), rule.body.name.c_str(), 0);
    }
  }

private:
  static GpgpShape shape(const std::string& name) {
    for (GpgpShape s = 0; s < shader::kShapeCount; ++s)
      if (name == spawn::shapeName(s)) return s;
    throw std::runtime_error("no shape " + name);
  }

  GpgpGrammarValue value(const spawn::Expression& e) {
    using spawn::ExpressionKind;
    const auto axis = [](const spawn::Expression& a) { return static_cast<uint32_t>(a.name.at(0) - 'X'); };
    if (e.kind == ExpressionKind::number) return GpgpGrammarValue GPGP_GRAMMAR_NUMBER(e.number);
    if (e.kind == ExpressionKind::pair)
      return gpgpAddExpression(builder_, GPGP_EXPRESSION_CORNER, value(e.arguments.at(0)), value(e.arguments.at(1)));
    if (e.kind == ExpressionKind::name) {
      if (const auto variable = variables_.find(e.name); variable != variables_.end()) return variable->second;
      if (e.name == "ADJUST_TO_FILL") return {GPGP_VALUE_ADJUST_TO_FILL, 0};
      if (e.name == "ANCHOR_TO_START") return {GPGP_VALUE_ANCHOR_TO_START, 0};
      if (e.name == "ANCHOR_TO_END") return {GPGP_VALUE_ANCHOR_TO_END, 0};
      if (e.name == "X" || e.name == "Y" || e.name == "Z") return {GPGP_VALUE_X + axis(e), 0};
      return gpgpAddTag(builder_, e.name.c_str());
    }
    if (e.kind == ExpressionKind::binary) {
      const GpgpGrammarValue left = value(e.arguments.at(0));
      return gpgpAddExpression(builder_, spawn::binaryOf(e.op).kind, left, value(e.arguments.at(1)));
    }
    if (e.name == "Exp") return value(e.arguments.at(0));
    if (e.name == GPGP_FIELD_SPELLING) {
      const bool atCentre = e.arguments.size() == 1;
      const GpgpGrammarValue x = atCentre ? GpgpGrammarValue GPGP_GRAMMAR_NUMBER(0) : value(e.arguments.at(1));
      const GpgpGrammarValue z = atCentre ? x : value(e.arguments.at(2));
      return gpgpAddField(builder_, e.arguments.at(0).name.c_str(), x, z);
    }
    for (const spawn::Binary& binary : spawn::kBinaries)
      if (!binary.precedence && e.name == binary.spelling) {
        const GpgpGrammarValue left = value(e.arguments.at(0));
        return gpgpAddExpression(builder_, binary.kind, left, value(e.arguments.at(1)));
      }
    for (const spawn::Attribute& attribute : spawn::kAttributes) {
      if (e.name != attribute.name) continue;
      uint32_t place = 0;
      for (const auto& argument : e.arguments) place = 3 * place + axis(argument);
      return {attribute.value + place, 0};
    }
    throw std::runtime_error("no value " + e.name);
  }

  GpgpGrammarOperator call(const spawn::Call& c) {
    std::vector<GpgpGrammarValue> values;
    for (const auto& argument : c.arguments) values.push_back(value(argument));
    for (const spawn::Spelling& spelling : spawn::kSpellings)
      if (c.name == spelling.name) return add(spelling.kind, values, c.branches);
    throw std::runtime_error("no operator " + c.name);
  }

  GpgpGrammarOperator add(GpgpOperatorKind kind, const std::vector<GpgpGrammarValue>& values,
                          const std::vector<spawn::Branch>& branches) {
    std::vector<GpgpGrammarSuccessor> to;
    float given = 0;
    for (const auto& branch : branches) {
      GpgpGrammarSuccessor& successor = to.emplace_back();
      if (branch.isElse)
        successor.value = GPGP_GRAMMAR_NUMBER(100 - given);
      else if (branch.label)
        successor.value = value(*branch.label);
      if (branch.label) given += branch.label->number;
      if (branch.successor.call)
        successor.op = call(*branch.successor.call);
      else
        successor.name = branch.successor.name.c_str();
    }
    return gpgpAddOperator(builder_, kind, values.data(), static_cast<uint32_t>(values.size()), to.data(),
                           static_cast<uint32_t>(to.size()));
  }
  GpgpGrammarOperator alternatives(const std::vector<spawn::Branch>& branches) {
    const GpgpGrammarValue drawn =
        gpgpAddExpression(builder_, GPGP_EXPRESSION_RANDOM, GPGP_GRAMMAR_NUMBER(0), GPGP_GRAMMAR_NUMBER(1));
    return add(GPGP_OPERATOR_RANDOM_RULE, {drawn}, branches);
  }

  GpgpGrammarBuilder builder_;
  std::map<std::string, GpgpGrammarValue> variables_;
};

} // namespace gpgp::test
