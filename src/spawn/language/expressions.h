// Expressions to parameters: constants are folded, the rest becomes stack code.
#pragma once
#include "spawn/graph/graph.h"
#include "spawn/language/syntax.h"

#include <map>

namespace gpgp::spawn {

class ExpressionCompiler {
public:
  ExpressionCompiler(const std::map<std::string, float>& variables, Graph& graph, Diagnostics& diagnostics)
      : variables_(variables), graph_(graph), diagnostics_(diagnostics) {}

  Parameter parameter(const Expression& expression);
  /// A value that may not depend on the shape; what names it in the message.
  float constant(const Expression& expression, const char* what);

private:
  struct Code {
    std::vector<uint32_t> words;
    uint32_t stack = 0;
    bool isConstant = false;
    float value = 0;
  };
  Code compile(const Expression& expression);
  Code call(const Expression& expression);
  Code number(float value) const;
  Code attribute(const Expression& expression, uint32_t code, uint32_t axes);
  Code join(Place place, uint32_t op, Code left, Code right);

  const std::map<std::string, float>& variables_;
  Graph& graph_;
  Diagnostics& diagnostics_;
  std::map<std::vector<uint32_t>, uint32_t> programs_; // equal programs are kept once
};

/// X, Y, Z as 0, 1, 2; reports anything else.
std::optional<uint32_t> axisOf(const Expression& expression, Diagnostics& diagnostics);

} // namespace gpgp::spawn
