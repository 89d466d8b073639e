// Text of the stack language to tokens, and to the procedures that its braces enclose.
#pragma once
#include "spawn/language/diagnostics.h"

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace gpgp::spawn::gml {

/// Names by number, so that comparing them is comparing numbers.
class NameTable {
public:
  uint32_t add(std::string_view text);
  const std::string& text(uint32_t name) const { return *texts_[name]; }
  size_t size() const { return texts_.size(); }

private:
  std::unordered_map<std::string, uint32_t> numbers_;
  std::vector<const std::string*> texts_; // keys of numbers_, which stay where they are
};

enum class TokenKind : uint8_t {
  number,
  vector,    ///< (x, y) or (x, y, z)
  string,    ///< "text"
  literal,   ///< /name, which pushes the name
  name,      ///< what the name stands for is executed
  store,     ///< !name: the top of the stack goes to a register
  load,      ///< :name: the register is pushed
  procedure, ///< { ... }
  broken     ///< was reported
};

struct Token {
  TokenKind kind = TokenKind::broken;
  uint8_t size = 0;   ///< components of a vector
  uint32_t index = 0; ///< of a name, a text or a procedure
  float values[3] = {};
  Place place;
};

/// Procedures are numbered; the last one is the program itself.
struct Program {
  std::vector<std::vector<Token>> procedures;
  std::vector<std::string> texts;
  NameTable names;

  const std::vector<Token>& main() const { return procedures.back(); }
};

/// Errors are reported, and scanning goes on behind them. Comments begin with % and end with their line.
Program scan(std::string_view text, Diagnostics& diagnostics);

} // namespace gpgp::spawn::gml
