// Text of a .cga file to tokens.
#pragma once
#include "spawn/language/diagnostics.h"

#include <string>
#include <string_view>
#include <vector>

namespace gpgp::spawn::cga {

enum class TokenKind : uint8_t { end, identifier, number, string, symbol };

/// An identifier holds its dots ("geometry.area"); a symbol is one of the operators or brackets, such as "-->".
struct Token {
  TokenKind kind = TokenKind::end;
  Place place;
  std::string text; ///< of strings what they mean, without quotes and escapes
  double number = 0;

  bool is(std::string_view symbol) const { return kind == TokenKind::symbol && text == symbol; }
  bool isWord(std::string_view word) const { return kind == TokenKind::identifier && text == word; }
};

/// The last token is of kind end. What is no token is reported and left out.
std::vector<Token> tokenize(std::string_view text, Diagnostics& errors);

} // namespace gpgp::spawn::cga
