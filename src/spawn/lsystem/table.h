// A compiled L-system as checked words, with the questions that the host asks of it.
#pragma once
#include "core/result.h"
#include "spawn/lsystem/format.h"

#include <cstddef>
#include <memory_resource>
#include <span>
#include <vector>

namespace gpgp::spawn::lsystem {

/// One step of rewriting: what it applies.
struct Step {
  uint32_t phase = 0;
};

class Table {
public:
  /// Checks magic, version, checksum, every index, program and bracket.
  static core::Result<Table> load(std::span<const std::byte> bytes, std::pmr::memory_resource* memory);

  std::span<const uint32_t> words() const { return words_; }
  uint32_t head(uint32_t word) const { return words_[word]; }
  float value(uint32_t word) const;
  uint32_t count(uint32_t section) const { return words_[shader::kLsysHeadSections + 2 * section]; }
  uint32_t offset(uint32_t section) const { return words_[shader::kLsysHeadSections + 2 * section + 1]; }
  bool has(uint32_t flag) const { return words_[shader::kLsysHeadFlags] & flag; }
  const uint32_t* symbol(uint32_t index) const {
    return words_.data() + offset(shader::kLsysSectionSymbols) + index * shader::kSymbolSize;
  }
  const uint32_t* terminal(uint32_t index) const {
    return words_.data() + offset(shader::kLsysSectionTerminals) + index * shader::kTerminalWords;
  }
  const char* name(uint32_t at) const {
    return reinterpret_cast<const char*>(words_.data() + offset(shader::kLsysSectionNames)) + at;
  }
  /// The word of the axiom's production.
  uint32_t axiom() const { return words_[shader::kLsysHeadAxiom]; }
  /// The phase of each step of a derivation: decompositions, then each iteration with its decompositions, then
  /// homomorphisms, and a last cut where there are any.
  uint32_t stepCount(uint32_t iterations) const;
  uint32_t phaseOf(uint32_t step, uint32_t iterations) const;

private:
  explicit Table(std::pmr::vector<uint32_t> words) : words_(std::move(words)) {}
  core::Result<void> check() const;
  std::pmr::vector<uint32_t> words_;
};

uint32_t checksumOf(std::span<const uint32_t> words);

constexpr uint32_t kMostIterations = 1000, kMostRepeats = 16;

} // namespace gpgp::spawn::lsystem
