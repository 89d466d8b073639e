// Any bytes as grammar text: an error with its place, or a baked grammar that loads again.
#include "spawn/graph/blob.h"

#include <gpgp/spawn.h>

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  source.name = "fuzz.pga";
  source.text = reinterpret_cast<const char*>(data);
  source.size = size;
  uint32_t errors = 0;
  source.messageUserData = &errors;
  source.messageFn = [](void* user, const GpgpCompileMessage* message) {
    if (message->severity == GPGP_SEVERITY_ERROR) ++*static_cast<uint32_t*>(user);
  };
  GpgpBlob blob{};
  const GpgpResult result = gpgpCompileGrammar(&source, &blob);
  if (result == GPGP_SUCCESS) {
    const auto bytes = std::span(static_cast<const std::byte*>(blob.data), blob.size);
    if (!gpgp::spawn::load(bytes, std::pmr::get_default_resource())) std::abort(); // what was baked must load
  } else if (blob.data || (result == GPGP_ERROR_INVALID_DATA && errors == 0)) {
    std::abort(); // a failure must say where, and hand out nothing
  }
  gpgpFreeBlob(&blob);
  return 0;
}
