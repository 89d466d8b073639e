// The syntax tree of a PGA-shape file: what was written, with places, before names mean anything.
#pragma once
#include "spawn/language/diagnostics.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gpgp::spawn {

constexpr int kMaxNesting = 200; ///< of operators written in place: bounds the stack

enum class ExpressionKind { number, name, call, binary, pair, broken };

/// number; name; name(arguments); left op right; (x, y). Broken: what was written has a syntax error, which was
/// reported.
struct Expression {
  ExpressionKind kind = ExpressionKind::number;
  Place place;
  float number = 0;
  std::string name;
  uint32_t op = 0; ///< binary: a code of graph_format.h
  std::vector<Expression> arguments;
};

struct Call;

/// What a shape goes to: a rule or terminal by name, or an operator written in place.
struct Successor {
  Place place;
  std::string name; ///< empty: call; without either there was a syntax error
  std::shared_ptr<Call> call;
};

struct Branch {
  std::optional<Expression> label; ///< before the colon
  bool isElse = false;             ///< label written as else
  Successor successor;
};

enum class SuccessorForm { none, chain, braces };

/// Op(arguments) Successor, or Op(arguments) { label: Successor | ... }
struct Call {
  Place place;
  std::string name;
  std::vector<Expression> arguments;
  SuccessorForm form = SuccessorForm::none;
  std::vector<Branch> branches;
  bool broken = false; ///< a syntax error followed; arguments or successors are missing
};

struct VariableDefinition {
  Place place;
  std::string name;
  Expression value;
};

struct AxiomDefinition {
  Place place;
  Place shapePlace;
  std::string shape;
  std::vector<Expression> corners; ///< pairs
  Place namePlace;
  std::string name;
};

struct TerminalDefinition {
  Place place;
  std::vector<std::pair<Place, std::string>> names;
  std::vector<Expression> arguments;
  bool broken = false;
};

struct RuleDefinition {
  Place place;
  std::string name;
  Successor body;                   ///< where alternatives is empty
  std::vector<Branch> alternatives; ///< 20%: A 30%: B else: C
  uint32_t priority = 0;            ///< of its operators
};

/// Statements with a syntax error are kept as far as they were read, so that what is right or wrong in them is known.
struct SyntaxTree {
  std::vector<VariableDefinition> variables;
  std::vector<AxiomDefinition> axioms;
  std::vector<TerminalDefinition> terminals;
  std::vector<RuleDefinition> rules;
  bool brokenAxiom = false;
};

/// Parses a file. Errors are reported and parsing goes on where what they stand in ends, so that all are found.
SyntaxTree parse(std::string_view text, Diagnostics& diagnostics);

} // namespace gpgp::spawn
