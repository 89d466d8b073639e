// Any bytes as calls to a grammar builder: an error that says where, or a baked grammar that loads again.
#include "spawn/graph/blob.h"

#include <gpgp/spawn_builder.h>

#include <cstdlib>
#include <cstring>

namespace {
/// Reads the input; zeros once it is used up.
struct Bytes {
  const uint8_t* data;
  size_t size, at = 0;
  uint32_t byte() { return at < size ? data[at++] : 0u; }
  uint32_t below(uint32_t n) { return byte() % n; }
  const char* name() {
    static const char* const kNames[] = {"A", "B", "C", "T", "U", "A", "If", "", "a b", nullptr};
    const uint32_t i = byte();
    return kNames[i < 200 ? i % 5 : i % 10];
  }
  GpgpGrammarValue value() {
    const uint32_t kind = byte();
    if (kind < 100) return GPGP_GRAMMAR_NUMBER(static_cast<float>(byte()) / 32 - 2);
    if (kind == 100) {
      GpgpGrammarValue any = {GPGP_VALUE_NUMBER, 0};
      const uint32_t bits = byte() | byte() << 8 | byte() << 16 | byte() << 24;
      std::memcpy(&any.number, &bits, 4);
      return any;
    }
    if (kind < 200) return {kind - 100, 0};
    return {0x10000u + byte(), 0}; // where variables and expressions are counted from
  }
};
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  Bytes in{data, size};
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  uint32_t errors = 0;
  source.messageUserData = &errors;
  source.messageFn = [](void* user, const GpgpCompileMessage* message) {
    if (message->severity == GPGP_SEVERITY_ERROR) ++*static_cast<uint32_t*>(user);
  };
  if (gpgpCreateGrammarBuilder(&source.builder) != GPGP_SUCCESS) return 0;
  GpgpGrammarBuilder builder = source.builder;
  uint32_t operators = 0;
  gpgpAddAxiom(builder, GPGP_SHAPE_BOX, nullptr, 0, "A");
  gpgpAddTerminal(builder, "T U", 1, 0);
  while (in.at < size) {
    GpgpGrammarValue values[4] = {};
    GpgpGrammarSuccessor to[4] = {};
    switch (in.below(6)) {
    case 0: gpgpAddVariable(builder, in.name(), in.value()); break;
    case 1: {
      const uint32_t kind = in.below(15);
      const GpgpGrammarValue left = in.value();
      gpgpAddExpression(builder, kind, left, in.value());
      break;
    }
    case 2: gpgpAddTerminal(builder, in.name(), in.below(3), in.byte()); break;
    case 3: {
      const char* name = in.name();
      if (in.below(2))
        gpgpAddRule(builder, name, in.name(), 0);
      else
        gpgpAddRule(builder, name, nullptr, operators - in.below(2));
      break;
    }
    case 4: {
      const uint32_t count = in.below(5);
      for (uint32_t i = 0; i < count; ++i) values[i] = in.value();
      gpgpAddAxiom(builder, in.below(18), values, count, in.name());
      break;
    }
    default: {
      const GpgpOperatorKind kind = in.below(19);
      const uint32_t valueCount = in.below(5), count = in.below(5);
      for (uint32_t i = 0; i < valueCount; ++i) values[i] = in.value();
      for (uint32_t i = 0; i < count; ++i) {
        if (in.below(2)) to[i].value = in.value();
        if (in.below(2))
          to[i].name = in.name();
        else
          to[i].op = operators - in.below(4);
      }
      operators = gpgpAddOperator(builder, kind, values, valueCount, to, count);
    }
    }
  }
  GpgpBlob blob{};
  const GpgpResult result = gpgpCompileGrammar(&source, &blob);
  if (result == GPGP_SUCCESS) {
    const auto bytes = std::span(static_cast<const std::byte*>(blob.data), blob.size);
    if (!gpgp::spawn::load(bytes, std::pmr::get_default_resource())) std::abort(); // what was baked must load
  } else if (blob.data || errors == 0) {
    std::abort(); // a failure must say why, and hand out nothing
  }
  gpgpFreeBlob(&blob);
  gpgpDestroyGrammarBuilder(builder);
  return 0;
}
