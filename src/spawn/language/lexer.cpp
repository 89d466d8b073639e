#include "spawn/language/lexer.h"

#include <charconv>
#include <limits>

namespace gpgp::spawn {
namespace {
bool isDigit(char c) { return c >= '0' && c <= '9'; }

struct Symbol {
  std::string_view text;
  TokenKind kind;
};
// Longer ones first where one begins another.
constexpr Symbol kSymbols[] = {
    {"-->", TokenKind::arrow},   {"==>", TokenKind::arrow},    {"->", TokenKind::arrow},
    {"=>", TokenKind::arrow},    {">>", TokenKind::arrow},     {"==", TokenKind::equal},
    {"!=", TokenKind::notEqual}, {"<=", TokenKind::lessEqual}, {">=", TokenKind::greaterEqual},
    {"&&", TokenKind::both},     {"||", TokenKind::either},    {"=", TokenKind::arrow},
    {"<", TokenKind::less},      {">", TokenKind::greater},    {"(", TokenKind::open},
    {")", TokenKind::close},     {"{", TokenKind::openBrace},  {"}", TokenKind::closeBrace},
    {"|", TokenKind::bar},       {",", TokenKind::comma},      {":", TokenKind::colon},
    {";", TokenKind::semicolon}, {"%", TokenKind::percent},    {"+", TokenKind::plus},
    {"-", TokenKind::minus},     {"*", TokenKind::times},      {"/", TokenKind::divided},
};

class Lexer {
public:
  Lexer(std::string_view text, Diagnostics& diagnostics, bool qualified)
      : text_(text), diagnostics_(diagnostics), qualified_(qualified) {}

  std::vector<Token> run() {
    std::vector<Token> tokens;
    if (text_.substr(0, 3) == "\xef\xbb\xbf") at_ = 3; // a byte order mark
    while (skipSpace()) {
      const Place start = place_;
      const size_t from = at_;
      if (qualified_ && lexQualified(tokens, start)) continue;
      if (lexNumber(tokens, start)) continue;
      if (isNameCharacter(text_[at_])) {
        while (at_ < text_.size() && isNameCharacter(text_[at_])) ++at_;
        push(tokens, TokenKind::name, from, start);
        continue;
      }
      const std::string_view rest = text_.substr(at_);
      bool found = false;
      for (const Symbol& symbol : kSymbols)
        if (!found && rest.substr(0, symbol.text.size()) == symbol.text) {
          at_ += symbol.text.size();
          push(tokens, symbol.kind, from, start);
          found = true;
        }
      if (!found) skipUnknown(start);
    }
    tokens.push_back({TokenKind::end, {}, 0, place_});
    return tokens;
  }

private:
  void push(std::vector<Token>& tokens, TokenKind kind, size_t from, Place start, float number = 0) {
    tokens.push_back({kind, text_.substr(from, at_ - from), number, start});
    place_.column += static_cast<uint32_t>(at_ - from);
  }

  void step() {
    if (text_[at_++] == '\n') {
      ++place_.line;
      place_.column = 1;
    } else {
      ++place_.column;
    }
  }

  /// To the next token; false at the end.
  bool skipSpace() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v') {
        step();
      } else if (text_.substr(at_, 2) == "//") {
        while (at_ < text_.size() && text_[at_] != '\n') step();
      } else if (text_.substr(at_, 2) == "/*") {
        const Place start = place_;
        step();
        step();
        while (at_ < text_.size() && text_.substr(at_, 2) != "*/") step();
        if (at_ == text_.size()) {
          diagnostics_.error(start, "this comment has no end; expected '*/'");
          return false;
        }
        step();
        step();
      } else {
        return true;
      }
    }
    return false;
  }

  /// a.b; with digits alone before the point, and one behind it, it is a number.
  bool lexQualified(std::vector<Token>& tokens, Place start) {
    const auto nameEnd = [&](size_t at) {
      while (at < text_.size() && isNameCharacter(text_[at])) ++at;
      return at;
    };
    const size_t from = at_, point = nameEnd(from);
    if (point == from || point + 1 >= text_.size() || text_[point] != '.' || !isNameCharacter(text_[point + 1]))
      return false;
    if (isDigit(text_[point + 1]) &&
        text_.substr(from, point - from).find_first_not_of("0123456789") == std::string_view::npos)
      return false;
    at_ = nameEnd(point + 1);
    push(tokens, TokenKind::name, from, start);
    return true;
  }

  /// Names may begin with digits, so "3" is a number and "3rd" a name.
  bool lexNumber(std::vector<Token>& tokens, Place start) {
    const bool point = text_[at_] == '.' && at_ + 1 < text_.size() && isDigit(text_[at_ + 1]);
    if (!isDigit(text_[at_]) && !point) return false;
    const char* first = text_.data() + at_;
    const char* last = text_.data() + text_.size();
    float value = 0;
    const auto [end, error] = std::from_chars(first, last, value);
    const size_t length = static_cast<size_t>(end - first);
    if (end == first || (end < last && isNameCharacter(*end))) return false;
    const size_t from = at_;
    at_ += length;
    if (error == std::errc::result_out_of_range) {
      // too small becomes 0; too large is an error. The difference is in the exponent's sign.
      const std::string_view digits = text_.substr(from, length);
      const size_t exponent = digits.find_first_of("eE");
      const bool small = exponent != std::string_view::npos
                             ? digits.substr(exponent).find('-') != std::string_view::npos
                             : digits.front() == '0' || digits.front() == '.';
      if (!small) diagnostics_.error(start, "the number is too large");
      value = 0;
    }
    push(tokens, TokenKind::number, from, start, value);
    return true;
  }

  /// Reports a run of characters that no token contains, once.
  void skipUnknown(Place start) {
    const unsigned char c = static_cast<unsigned char>(text_[at_]);
    if (c >= 0x20 && c < 0x7f)
      diagnostics_.error(start, std::string("'") + static_cast<char>(c) + "' has no meaning here");
    else
      diagnostics_.error(start, "this character has no meaning here");
    do {
      step();
    } while (at_ < text_.size() && static_cast<unsigned char>(text_[at_]) >= 0x80);
  }

  std::string_view text_;
  Diagnostics& diagnostics_;
  bool qualified_;
  size_t at_ = 0;
  Place place_{1, 1};
};
} // namespace

bool isNameCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

std::vector<Token> tokenize(std::string_view text, Diagnostics& diagnostics, bool qualified) {
  return Lexer(text, diagnostics, qualified).run();
}

std::string describe(const Token& token) {
  if (token.kind == TokenKind::end) return "the end of the file";
  std::string text(token.text.substr(0, 40));
  if (text.size() < token.text.size()) text += "...";
  return "'" + text + "'";
}

} // namespace gpgp::spawn
