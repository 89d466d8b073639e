#include "core/shader_code.h"

// For the state of the decoder in our own memory: host memory comes from the engine's callbacks, all of it.
#define ZSTD_STATIC_LINKING_ONLY
#include <zstd.h>

#include <algorithm>
#include <array>

namespace gpgp::core {

Result<ShaderWords> ShaderWords::of(const ShaderCode& code, std::pmr::memory_resource* memory) {
  ShaderWords result(memory);
  result.words_ = {code.words, code.count};
  if (!code.pack) return result;
  std::pmr::vector<uint64_t> state((ZSTD_estimateDCtxSize() + 7) / 8, memory);
  result.unpacked_.resize(code.pack->words);
  const size_t bytes = result.unpacked_.size() * sizeof(uint32_t);
  const size_t written = ZSTD_decompressDCtx(ZSTD_initStaticDCtx(state.data(), state.size() * sizeof(uint64_t)),
                                             result.unpacked_.data(), bytes, code.pack->bytes, code.pack->size);
  if (written != bytes)
    return makeError(GPGP_ERROR_UNSUPPORTED, "a shader of the library cannot be unpacked: %s",
                     ZSTD_isError(written) ? ZSTD_getErrorName(written) : "it is incomplete");
  result.words_ = std::span<const uint32_t>(result.unpacked_).subspan(code.first, code.count);
  return result;
}

uint64_t bindingsOf(std::span<const uint32_t> words) {
  constexpr uint32_t kHeaderWords = 5, kDecorate = 71, kBinding = 33, kDescriptorSet = 34, kFunctionCall = 57;
  // What reaches a variable: OpImageTexelPointer, OpLoad, OpAccessChain and its kin, OpArrayLength. It is operand 3.
  constexpr auto reaches = [](uint32_t operation) {
    return operation == 60 || operation == 61 || (operation >= 65 && operation <= 68);
  };
  struct Variable {
    uint32_t id = 0, binding = UINT32_MAX, set = 0;
  };
  std::array<Variable, 64> variables;
  size_t count = 0;
  const auto find = [&](uint32_t id) {
    return std::find_if(variables.begin(), variables.begin() + count, [&](const Variable& v) { return v.id == id; });
  };
  uint64_t bindings = 0;
  const auto use = [&](uint32_t id) {
    const auto variable = find(id);
    if (variable != variables.begin() + count && variable->set == 0 && variable->binding < 64)
      bindings |= uint64_t(1) << variable->binding;
  };
  for (size_t at = kHeaderWords; at < words.size();) {
    const uint32_t operation = words[at] & 0xffff, length = words[at] >> 16;
    if (length == 0 || length > words.size() - at) break; // no SPIR-V
    if (operation == kDecorate && length == 4 && (words[at + 2] == kBinding || words[at + 2] == kDescriptorSet)) {
      auto variable = find(words[at + 1]);
      if (variable == variables.begin() + count && count < variables.size()) variables[count++].id = words[at + 1];
      if (variable != variables.end()) (words[at + 2] == kBinding ? variable->binding : variable->set) = words[at + 3];
    } else if (reaches(operation)) {
      use(words[at + 3]);
    } else if (operation == kFunctionCall) {
      for (uint32_t i = 4; i < length; ++i) use(words[at + i]);
    }
    at += length;
  }
  return bindings;
}

} // namespace gpgp::core
