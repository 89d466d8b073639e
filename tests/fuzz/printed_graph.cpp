// Any bytes as a printed operator graph with its groups: an error, or a graph and a partition that print, parse and
// bake to the same again. The groups alone are read for that graph, too.
#include "spawn/graph/blob.h"
#include "spawn/language/print.h"

#include <cstdlib>

namespace {
void need(bool good) {
  if (!good) std::abort();
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace gpgp::spawn;
  const auto memory = std::pmr::get_default_resource();
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Diagnostics diagnostics;
  const auto printed = parseGraph(text, diagnostics, memory);
  need(printed.has_value() != diagnostics.hasErrors());
  if (!printed) return 0;
  need(bool(validate(printed->graph)));
  const auto words = serialize(printed->graph, memory);
  const auto loaded = load(std::as_bytes(std::span(words)), memory);
  need(bool(loaded));
  std::string again = printGraph(printed->graph);
  need(printGraph(*loaded) == again);
  if (printed->partition) again += printGroups(*printed->partition);
  Diagnostics none;
  const auto second = parseGraph(again, none, memory);
  need(second && serialize(second->graph, memory) == words);
  need(printed->partition.has_value() == second->partition.has_value());
  if (printed->partition) {
    need(printGroups(*second->partition) == printGroups(*printed->partition));
    const auto groups = parseGroups(printGroups(*printed->partition), printed->graph, none);
    need(groups && printGroups(*groups) == printGroups(*printed->partition));
  }
  return 0;
}
