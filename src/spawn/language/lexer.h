// PGA-shape text to tokens. Comments // and /* */ are skipped; what is no token is reported and skipped.
#pragma once
#include "spawn/language/diagnostics.h"

#include <string_view>

namespace gpgp::spawn {

enum class TokenKind {
  end,
  name,
  number,
  arrow, // any of --> -> ==> => = >>
  open,
  close,
  openBrace,
  closeBrace,
  bar,
  comma,
  colon,
  semicolon,
  percent,
  plus,
  minus,
  times,
  divided,
  equal,
  notEqual,
  less,
  greater,
  lessEqual,
  greaterEqual,
  both,
  either
};

struct Token {
  TokenKind kind = TokenKind::end;
  std::string_view text;
  float number = 0;
  Place place;
};

/// Letters, digits and _ make names.
bool isNameCharacter(char c);

/// The tokens of a file; the last is end. Views point into text. qualified: a.b is one name, as in linked grammars.
std::vector<Token> tokenize(std::string_view text, Diagnostics& diagnostics, bool qualified = false);

/// As in "found '}'" or "found the end of the file".
std::string describe(const Token& token);

} // namespace gpgp::spawn
