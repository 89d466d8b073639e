// Any bytes as a compiled L-system: as they came, and a good one with bytes exchanged and its sum made right, so that
// the checks behind it are reached. What loads derives and draws without harm.
#include "spawn/lsystem/compile.h"
#include "spawn/lsystem/reference.h"

#include <cstdlib>
#include <cstring>

namespace {
using namespace gpgp;
using namespace gpgp::spawn;

void check(const std::vector<uint32_t>& words) {
  const auto table = lsystem::Table::load(std::as_bytes(std::span(words)), std::pmr::get_default_resource());
  if (!table) return;
  GpgpAxiom axiom{};
  const auto derived = lsystem::derive(*table, {&axiom, 1}, 2, {2048, 8192});
  lsystem::draw(*table, derived.string, {&axiom, 1});
  lsystem::print(*table, derived.string);
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  (void)lsystem::Table::load(std::as_bytes(std::span(data, size)), std::pmr::get_default_resource());
  static constexpr char kText[] = "axiom: A(1)\niterations: 2\nangle: 25\nignore: + -\n"
                                  "A(s) : s > 0.2 --> F(s)[+A(s*0.7)][-A(s*0.7)]\nF(s) < A(t) --> A(s+t)\n";
  Diagnostics diagnostics;
  static const auto good = lsystem::compile(kText, {}, diagnostics);
  if (!good) std::abort();
  std::vector<uint32_t> words = *good;
  constexpr size_t kFrom = shader::kLsysHeadIterations; // what the sum is taken of
  for (size_t i = 0; i + 4 <= size; i += 4) {           // place, place, how, value
    const size_t at = kFrom * 4 + (data[i] | size_t(data[i + 1]) << 8) % ((words.size() - kFrom) * 4);
    uint8_t bytes[4];
    std::memcpy(bytes, &words[at / 4], 4);
    bytes[at % 4] = static_cast<uint8_t>(data[i + 2] % 2 ? data[i + 3] : bytes[at % 4] ^ 1u << data[i + 3] % 8);
    std::memcpy(&words[at / 4], bytes, 4);
    if (i % 16) continue;
    words[shader::kLsysHeadChecksum] = lsystem::checksumOf(std::span<const uint32_t>(words).subspan(kFrom));
    check(words);
  }
  return 0;
}
