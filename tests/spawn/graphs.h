// Operator graphs for tests of partitions.
#pragma once
#include "grammars.h"
#include "random_grammar.h"

#include <stdexcept>

namespace gpgp::test {

inline spawn::Graph compiled(const std::string& text) {
  spawn::Diagnostics diagnostics;
  spawn::Graph graph = spawn::compile(text, {}, diagnostics, std::pmr::new_delete_resource());
  if (diagnostics.hasErrors()) throw std::runtime_error(spawn::format(diagnostics.sorted()[0], "grammar"));
  return graph;
}
inline spawn::Graph ofRules(const std::string& rules) {
  return compiled("axiom Box A; terminal T (1,0); terminal U (1,1); " + rules);
}

/// The first node with an operator.
inline uint32_t nodeOf(const spawn::Graph& graph, uint32_t op) {
  for (uint32_t n = 0; n < graph.nodes.size(); ++n)
    if (graph.nodes[n].op == op) return n;
  return spawn::kNoNode;
}

/// The Menger sponge: a recursion, rules that lead to the same rule several times, 40 valid partitions.
inline constexpr const char* kSponge = "axiom Box A; terminal B (1,0);"
                                       "A = IfSizeLess(X, 0.333) { B | SubX };"
                                       "ZDiscard = SubDiv(Z) { -1: A | -1: Discard() | -1: A };"
                                       "YDiscard = SubDiv(Y) { -1: ZDiscard | -1: Discard() | -1: ZDiscard };"
                                       "SubZ = SubDiv(Z) { -1: A | -1: A | -1: A };"
                                       "SubY = SubDiv(Y) { -1: SubZ | -1: ZDiscard | -1: SubZ };"
                                       "SubX = SubDiv(X) { -1: SubY | -1: YDiscard | -1: SubY };";

} // namespace gpgp::test
