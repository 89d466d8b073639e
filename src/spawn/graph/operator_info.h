// The tables of spawn/shared/operator_table.h for the host, which looks up there whatever is true of an operator, of a
// code of expressions or of an attribute. What an operator does is elsewhere (shaders/spawn/shared/operators.h).
#pragma once
#include "spawn/shared/graph_format.h"

#include <gpgp/spawn_builder.h>

#include <algorithm>
#include <string_view>

namespace gpgp::spawn {

using shader::kPolygonShapes;
using shader::kRectangleShapes;
using shader::kShapeRoof;
constexpr uint32_t kMany = UINT32_MAX;       ///< successors: 1 to kMaxSuccessors
constexpr uint32_t kNotWritten = UINT32_MAX; ///< kind: not one that the language writes by the operator's name
constexpr uint32_t kAnyShape = UINT32_MAX;   ///< bits of shape types

enum class Relation { Ending, Passing, Choosing, Context, Multiplying };

struct Operator {
  const char* name;
  uint32_t op; ///< kOp...
  Relation relation;
  std::string_view arguments; ///< a letter each, and : where each successor has a value
  uint32_t successors;
  uint32_t multiplicity;
  uint32_t shapes; ///< on which it has an effect
  GpgpOperatorKind kind;
  const char* call; ///< code of a Passing operator

  /// Parameters that are no successor's; those of successors follow them.
  constexpr uint32_t values() const { return count('v'); }
  constexpr uint32_t axes() const { return count('a'); }
  constexpr bool hasSuccessorValues() const { return arguments.ends_with(':'); }
  /// The letters of what is in parentheses.
  constexpr std::string_view inParentheses() const { return arguments.substr(0, arguments.find(':')); }

private:
  constexpr uint32_t count(char letter) const {
    return static_cast<uint32_t>(std::count(arguments.begin(), arguments.end(), letter));
  }
};

/// By number.
inline constexpr Operator kOperators[] = {
#define GPGP_OPERATOR(name, number, relation, arguments, successors, multiplicity, shapes, kind, call)                 \
  {#name, number, Relation::relation, arguments, successors, shader::kMultiplicity##multiplicity, shapes, kind, #call},
    GPGP_OPERATOR_TABLE(GPGP_OPERATOR, GPGP_OPERATOR)
#undef GPGP_OPERATOR
};
constexpr bool areInOrder() {
  for (uint32_t op = 0; op < std::size(kOperators); ++op)
    if (kOperators[op].op != op || (op && kOperators[op].relation < kOperators[op - 1].relation)) return false;
  return std::size(kOperators) == shader::kOpCount;
}
static_assert(areInOrder(), "rows are in the order of their numbers, and relations are together");
static_assert(shader::kOpCount <= 28, "GPGP_OPERATORS has other bits from 28 on (shaders/spawn/shared/operators.h)");

constexpr bool chooses(uint32_t op) { return kOperators[op].relation == Relation::Choosing; }
constexpr bool isContext(uint32_t op) { return kOperators[op].relation == Relation::Context; }
/// Whether an operator could multiply shapes; see multiplies().
constexpr bool couldMultiply(uint32_t op) { return kOperators[op].relation == Relation::Multiplying; }

/// A code that takes two values.
struct Binary {
  uint32_t code;
  const char* spelling; ///< between the values; of kCodeRandom a function's name
  uint32_t precedence;  ///< 0: a function
  GpgpExpressionKind kind;
  const char* text; ///< code, of a, b and drawn
};
/// By number, from kCodeAdd on.
inline constexpr Binary kBinaries[] = {
#define GPGP_BINARY(name, number, spelling, precedence, kind, code) {number, spelling, precedence, kind, #code},
    GPGP_BINARY_TABLE(GPGP_BINARY, GPGP_BINARY)
#undef GPGP_BINARY
};
constexpr const Binary& binaryOf(uint32_t code) { return kBinaries[code - shader::kCodeAdd]; }
static_assert(binaryOf(shader::kCodeRandom).code == shader::kCodeRandom);

/// Codes of a function of no, one or two axes: attributes of the shape, then what the camera sees of it.
struct Attribute {
  const char* name;
  uint32_t code; ///< the first one
  uint32_t axes;
  GpgpGrammarValueId value; ///< the first one
  const char* member;       ///< of Shape, or from kCodeView on of Seen

  constexpr uint32_t count() const { return axes == 0 ? 1 : axes == 1 ? 3 : 9; }
};
inline constexpr Attribute kAttributes[] = {
#define GPGP_ATTRIBUTE(name, number, spelling, axes, value, member) {spelling, number, axes, value, #member},
    GPGP_ATTRIBUTE_TABLE(GPGP_ATTRIBUTE)
#undef GPGP_ATTRIBUTE
#define GPGP_SEEN(name, number, spelling, value, member) {spelling, number, 0, value, #member},
        GPGP_VIEW_TABLE(GPGP_SEEN)
#undef GPGP_SEEN
};
constexpr const Attribute& attributeAt(uint32_t code) {
  for (const Attribute& a : kAttributes)
    if (code >= a.code && code < a.code + a.count()) return a;
  return kAttributes[0];
}

} // namespace gpgp::spawn
