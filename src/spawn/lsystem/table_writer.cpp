// Lays out a table's sections one behind the other, and what names their places.
#include "spawn/lsystem/table_writer.h"

#include <cstring>

namespace gpgp::spawn::lsystem {
using namespace shader;

std::vector<uint32_t> wordsOf(const TableContents& table) {
  std::vector<uint32_t> words = table.head;
  std::string names(1, '\0');
  const auto nameAt = [&](const std::string& name) {
    const uint32_t at = static_cast<uint32_t>(names.size());
    names += name;
    names += '\0';
    return at;
  };
  const uint32_t counts[kLsysSections - 1] = {
      static_cast<uint32_t>(table.symbols.size()),   table.productionCount + 1,
      static_cast<uint32_t>(table.contexts.size()),  static_cast<uint32_t>(table.modules.size()),
      static_cast<uint32_t>(table.terminals.size()), static_cast<uint32_t>(table.code.size())};
  const uint32_t sizes[kLsysSections - 1] = {kSymbolSize, kProductionSize, kContextSize,
                                             kModuleSize, kTerminalWords,  1};
  uint32_t offsets[kLsysSections];
  uint32_t offset = kLsysHeadSize;
  for (uint32_t s = 0; s < kLsysSections - 1; ++s) {
    offsets[s] = offset;
    words[kLsysHeadSections + 2 * s] = counts[s];
    words[kLsysHeadSections + 2 * s + 1] = offset;
    offset += counts[s] * sizes[s];
  }
  offsets[kLsysSectionNames] = offset;
  std::vector<uint32_t> productions;
  const auto program = [&](uint32_t from1) { return from1 ? offsets[kLsysSectionCode] + from1 - 1 : 0; };
  const auto add = [&](std::array<uint32_t, kProductionSize> p) {
    p[kProductionLeft] = offsets[kLsysSectionContexts] + p[kProductionLeft] * kContextSize;
    p[kProductionRight] = offsets[kLsysSectionContexts] + p[kProductionRight] * kContextSize;
    p[kProductionCondition] = program(p[kProductionCondition]);
    p[kProductionProbability] = program(p[kProductionProbability]);
    p[kProductionSuccessor] = offsets[kLsysSectionModules] + p[kProductionSuccessor] * kModuleSize;
    productions.insert(productions.end(), p.begin(), p.end());
  };
  words[kLsysHeadAxiom] = offsets[kLsysSectionProductions];
  add(table.axiom);
  for (const Symbol& s : table.symbols) {
    words.insert(words.end(), {nameAt(s.name), s.arity, s.turtle, s.terminal, s.ignored ? kSymbolIgnored : 0u});
    for (uint32_t phase = 0; phase < kPhases3; ++phase) {
      words.push_back(offsets[kLsysSectionProductions] + static_cast<uint32_t>(productions.size()));
      words.push_back(static_cast<uint32_t>(s.productions[phase].size()));
      for (const auto& p : s.productions[phase]) add(p);
    }
  }
  words.insert(words.end(), productions.begin(), productions.end());
  for (const auto& c : table.contexts) words.insert(words.end(), c.begin(), c.end());
  for (const auto& [symbol, code] : table.modules) words.insert(words.end(), {symbol, program(code)});
  for (const TableContents::Terminal& t : table.terminals) words.insert(words.end(), {nameAt(t.name), t.kind, t.shape});
  words.insert(words.end(), table.code.begin(), table.code.end());
  names.resize((names.size() + 3) / 4 * 4, '\0');
  words[kLsysHeadSections + 2 * kLsysSectionNames] = static_cast<uint32_t>(names.size() / 4);
  words[kLsysHeadSections + 2 * kLsysSectionNames + 1] = offset;
  for (size_t i = 0; i < names.size(); i += 4) {
    uint32_t word;
    std::memcpy(&word, names.data() + i, 4);
    words.push_back(word);
  }
  words[kLsysHeadMagic] = kLsysMagic;
  words[kLsysHeadVersion] = kLsysVersion;
  words[kLsysHeadWords] = static_cast<uint32_t>(words.size());
  words[kLsysHeadChecksum] = checksumOf(std::span<const uint32_t>(words).subspan(kLsysHeadIterations));
  return words;
}

} // namespace gpgp::spawn::lsystem
