#include "cli/shared/messages.h"

#include <cstdint>
#include <cstdio>

namespace gpgp::cli {
namespace {

/// Bytes of the character that text begins with; 0 where it begins with none (RFC 3629).
size_t characterSize(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? static_cast<uint8_t>(text[i]) : 0u; };
  const uint32_t first = byte(0);
  if (first < 0x80) return 1;
  const size_t size = first >= 0xc2 && first < 0xe0   ? 2
                      : (first & 0xf0) == 0xe0        ? 3
                      : first >= 0xf0 && first < 0xf5 ? 4
                                                      : 0;
  for (size_t i = 1; i < size; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  if ((first == 0xe0 && byte(1) < 0xa0) || (first == 0xed && byte(1) >= 0xa0)) return 0; // too long, surrogates
  if ((first == 0xf0 && byte(1) < 0x90) || (first == 0xf4 && byte(1) >= 0x90)) return 0;
  return size;
}

} // namespace

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const auto first = static_cast<uint8_t>(text[0]);
    const size_t size = characterSize(text);
    const bool control = (first < 0x20 && first != '\n' && first != '\t') || first == 0x7f ||
                         (first == 0xc2 && size == 2 && static_cast<uint8_t>(text[1]) < 0xa0);
    if (size && !control) {
      result += text.substr(0, size);
      text.remove_prefix(size);
      continue;
    }
    char escaped[8];
    std::snprintf(escaped, sizeof escaped, "\\x%02x", first);
    result += escaped;
    text.remove_prefix(1);
  }
  return result;
}

} // namespace gpgp::cli
