// Any bytes as grammar text, alone and linked with itself: an error with its place, or a baked grammar that loads
// again.
#include "spawn/graph/blob.h"

#include <gpgp/spawn.h>

#include <cstdlib>

namespace {
uint32_t errors = 0;

void check(GpgpResult result, GpgpBlob blob) {
  if (result == GPGP_SUCCESS) {
    const auto bytes = std::span(static_cast<const std::byte*>(blob.data), blob.size);
    if (!gpgp::spawn::load(bytes, std::pmr::get_default_resource())) std::abort(); // what was baked must load
  } else if (blob.data || (result == GPGP_ERROR_INVALID_DATA && errors == 0)) {
    std::abort(); // a failure must say where, and hand out nothing
  }
  gpgpFreeBlob(&blob);
  errors = 0;
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  source.name = "fuzz.pga";
  source.text = reinterpret_cast<const char*>(data);
  source.size = size;
  source.messageFn = [](void*, const GpgpCompileMessage* message) {
    errors += message->severity == GPGP_SEVERITY_ERROR;
  };
  GpgpBlob blob{};
  const GpgpResult result = gpgpCompileGrammar(&source, &blob);
  check(result, blob);
  GpgpGrammarSource sources[] = {source, source};
  sources[1].name = "again.pga";
  blob = {};
  const GpgpResult linked = gpgpLinkGrammars(sources, 2, &blob);
  check(linked, blob);
  return 0;
}
