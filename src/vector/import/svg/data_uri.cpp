#include "vector/import/svg/data_uri.h"

#include "vector/import/svg/scanner.h"

namespace gpgp::vector::svg {
namespace {

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

std::vector<uint8_t> fromBase64(std::string_view text) {
  std::vector<uint8_t> bytes;
  bytes.reserve(text.size() / 4 * 3);
  uint32_t bits = 0, count = 0;
  for (const char c : text) {
    const int digit = c >= 'A' && c <= 'Z'   ? c - 'A'
                      : c >= 'a' && c <= 'z' ? c - 'a' + 26
                      : c >= '0' && c <= '9' ? c - '0' + 52
                      : c == '+'             ? 62
                      : c == '/'             ? 63
                                             : -1;
    if (digit < 0) {
      if (c == '=') break;
      if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
      return {};
    }
    bits = bits << 6 | static_cast<uint32_t>(digit);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<uint8_t>(bits >> count));
    }
  }
  return bytes;
}

} // namespace

std::string percentDecoded(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hexDigit(text[i + 1]) : -1;
    const int low = high >= 0 ? hexDigit(text[i + 2]) : -1;
    if (low < 0) {
      out += text[i];
      continue;
    }
    out += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return out;
}

std::vector<uint8_t> decodeDataUri(std::string_view uri) {
  const size_t comma = uri.find(',');
  if (!isWord(uri.substr(0, 5), "data:") || comma == uri.npos) return {};
  const std::string_view head = uri.substr(0, comma), data = uri.substr(comma + 1);
  constexpr std::string_view base64 = ";base64";
  if (head.size() >= base64.size() && isWord(head.substr(head.size() - base64.size()), base64))
    return fromBase64(percentDecoded(data));
  const std::string text = percentDecoded(data);
  return {text.begin(), text.end()};
}

} // namespace gpgp::vector::svg
