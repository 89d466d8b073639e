#include "spawn/cga/lexer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace gpgp::spawn::cga {
namespace {

// Longer ones before their beginnings.
constexpr std::array<std::string_view, 46> kSymbols = {
    "-->", ".==", ".!=", ".<=", ".>=", ".&&", ".||", "==", "!=", "<=", ">=", "&&", "||", ":=", ".<", ".>",
    ".+",  ".-",  ".*",  "./",  ".%",  ".!",  "(",   ")",  "[",  "]",  "{",  "}",  "|",  ":",  ",",  "=",
    "+",   "-",   "*",   "/",   "%",   "<",   ">",   "!",  "'",  "~",  "@",  ".",  ";",  "^"};

bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$'; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }

class Lexer {
public:
  Lexer(std::string_view text, Diagnostics& errors) : text_(text), errors_(errors) {
    if (text_.starts_with("\xef\xbb\xbf")) at_ = 3; // some editors write it
  }

  std::vector<Token> tokens() {
    while (skipSpace()) {
      const char c = peek();
      if (isLetter(c))
        identifier();
      else if (isDigit(c) || (c == '.' && isDigit(peek(1))))
        number();
      else if (c == '"')
        string();
      else
        symbol();
    }
    tokens_.push_back({TokenKind::end, here(), "the end of the file", 0});
    return std::move(tokens_);
  }

private:
  char peek(size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
  Place here() const { return {line_, static_cast<uint32_t>(at_ - lineBegin_ + 1)}; }
  void take(size_t count) {
    for (size_t i = 0; i < count && at_ < text_.size(); ++i)
      if (text_[at_++] == '\n') {
        ++line_;
        lineBegin_ = at_;
      }
  }

  /// False at the end of the text.
  bool skipSpace() {
    while (at_ < text_.size()) {
      const char c = peek();
      if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v') {
        take(1);
      } else if (c == '\xc2' && peek(1) == '\xa0') { // a space that does not break, from web pages
        take(2);
      } else if (c == '#' || (c == '/' && peek(1) == '/')) {
        while (at_ < text_.size() && peek() != '\n') take(1);
      } else if (c == '/' && peek(1) == '*') {
        const Place begin = here();
        const size_t end = text_.find("*/", at_ + 2);
        if (end == std::string_view::npos) errors_.error(begin, "this comment has no end, */");
        take(end == std::string_view::npos ? text_.size() : end + 2 - at_);
      } else {
        return true;
      }
    }
    return false;
  }

  void identifier() {
    const Place place = here();
    const size_t begin = at_;
    const auto isPart = [](char c) { return isLetter(c) || isDigit(c); };
    while (isPart(peek()) || (peek() == '.' && isLetter(peek(1)))) take(1);
    tokens_.push_back({TokenKind::identifier, place, std::string(text_.substr(begin, at_ - begin)), 0});
  }

  void number() {
    const Place place = here();
    const size_t begin = at_;
    while (isDigit(peek())) take(1);
    if (peek() == '.' && isDigit(peek(1))) {
      take(1);
      while (isDigit(peek())) take(1);
    } else if (peek() == '.' && !isLetter(peek(1)) && peek(1) != '=' && peek(1) != '<' && peek(1) != '>' &&
               peek(1) != '!') {
      take(1);
    }
    const size_t sign = peek(1) == '-' || peek(1) == '+' ? 2 : 1;
    if ((peek() == 'e' || peek() == 'E') && isDigit(peek(sign))) {
      take(sign);
      while (isDigit(peek())) take(1);
    }
    Token token{TokenKind::number, place, std::string(text_.substr(begin, at_ - begin)), 0};
    std::from_chars(token.text.data(), token.text.data() + token.text.size(), token.number);
    if (!std::isfinite(static_cast<float>(token.number)))
      errors_.error(place, "the number " + token.text + " is beyond what 32 bits hold");
    tokens_.push_back(std::move(token));
  }

  void string() {
    const Place place = here();
    take(1);
    std::string value;
    // A string may go on in the next lines; one that has no end for some lines lacks its quotation mark.
    const size_t close = closeOf(at_);
    while (at_ < close) {
      if (peek() == '\\' && at_ + 1 < text_.size()) {
        take(1);
        const char c = peek();
        if (c == 'n' || c == 't') {
          value += c == 'n' ? '\n' : '\t';
        } else {
          if (c != '"' && c != '\\') value += '\\'; // as in regular expressions
          value += c;
        }
      } else {
        value += peek();
      }
      take(1);
    }
    if (peek() == '"')
      take(1);
    else
      errors_.error(place, "this string has no end, \"");
    tokens_.push_back({TokenKind::string, place, std::move(value), 0});
  }

  /// Where the string that is read ends: at its quotation mark, or where there is none, at the end of the line.
  size_t closeOf(size_t begin) const {
    constexpr int kMostLines = 40;
    int lines = 0;
    for (size_t i = begin; i < text_.size() && lines < kMostLines; ++i) {
      if (text_[i] == '"') return i;
      if (text_[i] == '\\') ++i;
      if (i < text_.size() && text_[i] == '\n') ++lines;
    }
    return std::min(text_.find('\n', begin), text_.size());
  }

  void symbol() {
    for (const std::string_view symbol : kSymbols)
      if (text_.substr(at_).starts_with(symbol)) {
        // Name.// begins a comment.
        if (symbol == "./" && (peek(2) == '/' || peek(2) == '*')) continue;
        tokens_.push_back({TokenKind::symbol, here(), std::string(symbol), 0});
        take(symbol.size());
        return;
      }
    const unsigned char c = static_cast<unsigned char>(peek());
    char name[16];
    std::snprintf(name, sizeof name, c > 32 && c < 127 ? "'%c'" : "byte 0x%02x", c);
    const Place place = here();
    if (place.line != badLine_) errors_.error(place, std::string(name) + " begins nothing that CGA has");
    badLine_ = place.line; // one message a line is enough
    take(1);
  }

  std::string_view text_;
  Diagnostics& errors_;
  std::vector<Token> tokens_;
  size_t at_ = 0, lineBegin_ = 0;
  uint32_t line_ = 1, badLine_ = 0;
};

} // namespace

std::vector<Token> tokenize(std::string_view text, Diagnostics& errors) { return Lexer(text, errors).tokens(); }

} // namespace gpgp::spawn::cga
