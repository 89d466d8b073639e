// Strings that a derivation makes: numbers for equal ones are equal.
//
// This is the one part of a derivation that has no form for the GPU; programs that only compare and pass on the strings
// of their text never add one.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace gpgp::spawn::cga {

class StringTable {
public:
  /// The strings of a program keep their numbers.
  explicit StringTable(const std::vector<std::string>& constants);
  uint32_t number(std::string_view text);
  const std::string& text(uint32_t number) const;
  /// Forgets all but the program's.
  void clear();
  /// Of what was made.
  size_t bytes() const { return bytes_; }

private:
  const std::vector<std::string>& constants_;
  std::unordered_map<std::string_view, uint32_t> constantNumbers_;
  std::unordered_map<std::string, uint32_t> numbers_;
  size_t bytes_ = 0;
  std::vector<const std::string*> texts_; // of numbers behind the constants
};

/// As CGA writes numbers: 3, 0.5, 1e+20; at most 6 digits.
std::string textOf(float number);
/// 0 where the text is none.
float numberOf(std::string_view text);

} // namespace gpgp::spawn::cga
