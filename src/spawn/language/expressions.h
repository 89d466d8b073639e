// Expressions to parameters: constants are folded, the rest becomes stack code.
#pragma once
#include "spawn/graph/graph.h"
#include "spawn/language/syntax.h"

#include <map>

namespace gpgp::spawn {

/// Of the numbers that a grammar can have.
bool isUsable(float value);
/// Whether a sum, difference, product or quotient is of those, before it is rounded.
bool staysUsable(uint32_t op, double a, double b);
constexpr const char* kUsableNumbers = "numbers go up to 2^100, which is 1.2676506e30";

class ExpressionCompiler {
public:
  ExpressionCompiler(const std::map<std::string, float>& variables, Graph& graph, Diagnostics& diagnostics)
      : variables_(variables), graph_(graph), diagnostics_(diagnostics) {}

  Parameter parameter(const Expression& expression);
  /// Rand(0, 1)
  Parameter drawnParameter();
  /// A value that may not depend on the shape; what names it in the message.
  float constant(const Expression& expression, const char* what);

private:
  struct Code {
    std::vector<uint32_t> words;
    uint32_t stack = 0;
    bool isConstant = false;
    bool seesView = false; ///< it has codes from kCodeView on
    float value = 0;
  };
  Parameter parameter(Code code);
  Code compile(const Expression& expression);
  Code call(const Expression& expression);
  Code number(float value) const;
  Code attribute(const Expression& expression, uint32_t code, uint32_t axes);
  Code field(const Expression& expression);
  Code join(Place place, uint32_t op, Code left, Code right);
  /// left right op, which takes both.
  Code append(Place place, uint32_t op, Code left, const Code& right);
  /// left op right, of numbers. Reports what is none.
  float fold(Place place, uint32_t op, float left, float right);
  std::string suggestionFor(const std::string& name, bool isCall) const;

  const std::map<std::string, float>& variables_;
  Graph& graph_;
  Diagnostics& diagnostics_;
  std::map<std::vector<uint32_t>, uint32_t> programs_; // equal programs are kept once
};

/// X, Y, Z as 0, 1, 2; reports anything else.
std::optional<uint32_t> axisOf(const Expression& expression, Diagnostics& diagnostics);

} // namespace gpgp::spawn
