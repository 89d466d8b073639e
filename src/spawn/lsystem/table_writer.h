// What the compiler found in a file, and the table that holds it.
#pragma once
#include "spawn/lsystem/syntax.h"
#include "spawn/lsystem/table.h"

#include <array>
#include <string>
#include <vector>

namespace gpgp::spawn::lsystem {

struct Symbol {
  std::string name;
  uint32_t arity, turtle = shader::kTurtleNone, terminal = shader::kNoTerminal;
  bool ignored = false;
  bool made = false; ///< by an axiom or a successor
  std::array<std::vector<std::array<uint32_t, shader::kProductionSize>>, shader::kPhases3> productions;
  std::array<std::vector<const Production*>, shader::kPhases3> sources;
};

/// Productions name contexts, modules and programs by their place here; wordsOf makes words of the table of that.
struct TableContents {
  struct Terminal {
    std::string name;
    uint32_t kind, shape;
  };
  std::vector<uint32_t> head; ///< kLsysHeadSize words, settings among them
  std::array<uint32_t, shader::kProductionSize> axiom{};
  std::vector<Symbol> symbols;
  std::vector<Terminal> terminals;
  std::vector<std::array<uint32_t, 2>> contexts, modules;
  std::vector<uint32_t> code;
  uint32_t productionCount = 0; ///< of all symbols
};

/// The words of the table.
std::vector<uint32_t> wordsOf(const TableContents& table);

} // namespace gpgp::spawn::lsystem
