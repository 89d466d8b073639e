// Any bytes as a .cga file: errors with their places, or a program that is valid and derives within its limits.
#include "spawn/cga/compile.h"
#include "spawn/cga/derive.h"

#include <cstdlib>

using namespace gpgp::spawn;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  cga::CompileOptions options;
  options.path = "fuzz.cga";
  options.graph = true;
  options.read = [](const std::string&, std::string&) { return false; };
  cga::Messages messages;
  const auto program = cga::compile(std::string(reinterpret_cast<const char*>(data), size), options, messages);
  if (!program != messages.hasErrors()) std::abort(); // a failure must say where
  if (!program) return 0;
  if (!cga::validate(*program).empty()) std::abort();
  cga::DeriveOptions derive;
  derive.threads = 1;
  derive.maxDepth = 40;
  derive.maxShapes = 500;
  derive.maxFunctionDepth = 32;
  derive.maxInstructions = 20000;
  derive.maxFaces = 2000;
  derive.maxVertices = 8000;
  derive.maxGeometryMiB = 16;
  derive.maxWork = 1'000'000;
  cga::Axiom axiom;
  axiom.size = {8, 0, 6};
  const cga::Derivation all = cga::derive(*program, {axiom}, derive, messages);
  if (all.work > 4 * derive.maxWork) std::abort(); // an operation that nothing bounds
  return 0;
}
