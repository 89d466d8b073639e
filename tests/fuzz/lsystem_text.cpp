// Any bytes as the text of an L-system: an error with its place, or a table that loads and derives.
#include "spawn/lsystem/compile.h"
#include "spawn/lsystem/reference.h"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace gpgp::spawn;
  Diagnostics diagnostics;
  const auto words = lsystem::compile({reinterpret_cast<const char*>(data), size}, {}, diagnostics);
  if (!words) {
    if (!diagnostics.hasErrors()) std::abort(); // a failure must say why
    return 0;
  }
  const auto table = lsystem::Table::load(std::as_bytes(std::span(*words)), std::pmr::get_default_resource());
  if (!table) std::abort(); // what was compiled must load
  GpgpAxiom axiom{};
  const auto derived = lsystem::derive(*table, {&axiom, 1}, 3, {4096, 16384});
  lsystem::draw(*table, derived.string, {&axiom, 1});
  lsystem::print(*table, derived.string);
  return 0;
}
