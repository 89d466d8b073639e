// Any bytes as a program in the stack language: an error with its place, or a graph that is valid and comes back from
// its printed form.
#include "spawn/gml/machine.h"
#include "spawn/graph/blob.h"
#include "spawn/language/build_graph.h"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace gpgp::spawn;
  std::pmr::memory_resource* memory = std::pmr::new_delete_resource();
  Diagnostics diagnostics;
  const auto made = gml::compile({reinterpret_cast<const char*>(data), size}, {}, diagnostics, memory);
  if (diagnostics.hasErrors()) return 0;
  const SyntaxTree none;
  const GrammarPart part{&none, &made.graph, {}, &diagnostics, {}, {}, &made.places};
  const Graph graph = buildGraph({&part, 1}, memory);
  if (diagnostics.hasErrors()) return 0; // colliders without an order
  if (graph.phases == kNoPhases || !validate(graph)) std::abort();
  const auto words = serialize(graph, memory);
  if (!load(std::as_bytes(std::span(words)), memory)) std::abort(); // what was baked must load
  return 0;
}
