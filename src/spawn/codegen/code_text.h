// Pieces of generated GLSL: numbers, attributes of shapes and operations on values.
#pragma once
#include <algorithm>
#include <cctype>
#include <cstdint>
#include <string>
#include <string_view>

namespace gpgp::spawn {

/// A float whose bits survive.
std::string literal(float value);
std::string number(uint32_t value);
std::string component(uint32_t axis); ///< of the size of shape s
/// What a code from kCodeAttributes on, or kCodeSeed, means for shape s.
std::string attribute(uint32_t code);
/// What a code that takes two values makes of a and b. draw: the number of what kCodeRandom draws.
std::string operation(uint32_t code, const std::string& a, const std::string& b, uint32_t draw);

/// A table's code with other words in it: textOf(word) for each, in their order.
template <class Text> std::string replaced(std::string_view code, const Text& textOf) {
  const auto isWord = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  std::string text;
  for (size_t at = 0; at < code.size();) {
    size_t end = at;
    while (end < code.size() && isWord(code[end])) ++end;
    text += end > at ? textOf(code.substr(at, end - at)) : std::string(1, code[at]);
    at = std::max(end, at + 1);
  }
  return text;
}

} // namespace gpgp::spawn
