#include "spawn/gml/scanner.h"

#include "spawn/language/expressions.h"

#include <charconv>
#include <cmath>

namespace gpgp::spawn::gml {
namespace {
constexpr size_t kMaxBraces = 200; // one in another
constexpr size_t kMaxString = 4096;

bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v'; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isDelimiter(char c) {
  return isSpace(c) || c == '{' || c == '}' || c == '[' || c == ']' || c == '(' || c == ')' || c == '"' || c == '%' ||
         c == '/' || c == ',' || c == 0;
}
/// Whether a word is meant as a number.
bool looksLikeNumber(std::string_view word) {
  size_t at = word[0] == '-' || word[0] == '+';
  if (at < word.size() && word[at] == '.') ++at;
  return at < word.size() && isDigit(word[at]);
}

class Scanner {
public:
  Scanner(std::string_view text, Diagnostics& diagnostics) : text_(text), diagnostics_(diagnostics) {}

  Program run() {
    std::vector<Token> tokens;
    while (skip()) take(tokens);
    while (!open_.empty()) {
      diagnostics_.error(open_.back().place, "this '{' has no '}'");
      close(tokens);
    }
    program_.procedures.push_back(std::move(tokens));
    return std::move(program_);
  }

private:
  struct Open {
    Place place;
    std::vector<Token> outside; // what was read before the brace, in its procedure
  };

  char at(size_t ahead = 0) const { return next_ + ahead < text_.size() ? text_[next_ + ahead] : char(0); }
  void advance() {
    if (text_[next_++] == '\n') {
      ++place_.line;
      place_.column = 1;
    } else {
      ++place_.column;
    }
  }
  /// White space and comments. False at the end.
  bool skip() {
    while (next_ < text_.size()) {
      if (at() == '%') {
        while (next_ < text_.size() && at() != '\n') advance();
      } else if (isSpace(at())) {
        advance();
      } else {
        return true;
      }
    }
    return false;
  }
  std::string_view word() {
    const size_t start = next_;
    while (next_ < text_.size() && !isDelimiter(at())) advance();
    return text_.substr(start, next_ - start);
  }

  void take(std::vector<Token>& tokens) {
    Token token;
    token.place = place_;
    const char c = at();
    if (c == '{') {
      advance();
      if (open_.size() == kMaxBraces)
        diagnostics_.error(token.place, "braces nest more than " + std::to_string(kMaxBraces) + " deep");
      if (open_.size() > kMaxBraces)
        ++ignored_;
      else
        open_.push_back({token.place, std::move(tokens)}), tokens = {};
      return;
    }
    if (c == '}') {
      advance();
      if (ignored_)
        --ignored_;
      else if (open_.empty())
        diagnostics_.error(token.place, "this '}' has no '{'");
      else
        close(tokens);
      return;
    }
    if (c == '[' || c == ']') {
      advance();
      token.kind = TokenKind::name;
      token.index = program_.names.add(std::string_view(&c, 1));
    } else if (c == '(') {
      vector(token);
    } else if (c == '"') {
      string(token);
    } else if (c == '/') {
      advance();
      named(token, TokenKind::literal, "a name after '/', as /height");
    } else if (c == '!' || c == ':') {
      advance();
      named(token, c == '!' ? TokenKind::store : TokenKind::load, "the name of a register, as !h and :h");
    } else if (isDelimiter(c)) {
      advance();
      diagnostics_.error(token.place,
                         std::string("'") + (c ? std::string(1, c) : std::string("\\0")) + "' has no meaning here");
    } else {
      const std::string_view text = word();
      if (looksLikeNumber(text)) {
        token.kind = TokenKind::number;
        token.values[0] = number(text, token.place);
      } else {
        token.kind = TokenKind::name;
        token.index = program_.names.add(text);
      }
    }
    tokens.push_back(token);
  }

  void named(Token& token, TokenKind kind, const char* expected) {
    const std::string_view name = word();
    if (name.empty()) {
      diagnostics_.error(token.place, std::string("expected ") + expected);
      return;
    }
    token.kind = kind;
    token.index = program_.names.add(name);
  }

  float number(std::string_view text, Place place) {
    const std::string_view digits = text[0] == '+' ? text.substr(1) : text;
    float value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool whole = end == digits.data() + digits.size();
    if (error == std::errc::result_out_of_range && whole)
      value = digits.find("e-") != std::string_view::npos || digits.find("E-") != std::string_view::npos ? 0 : INFINITY;
    else if (error != std::errc() || !whole)
      diagnostics_.error(place, "'" + std::string(text.substr(0, 40)) + "' is not a number");
    if (isUsable(value)) return value;
    diagnostics_.error(place, std::string("this is too large; ") + kUsableNumbers);
    return 0;
  }

  void vector(Token& token) {
    const char* expected = "expected (x, y) or (x, y, z) with numbers";
    advance();
    for (;;) {
      skip();
      const Place place = place_;
      const std::string_view text = word();
      if (text.empty() || !looksLikeNumber(text) || token.size == 3) {
        diagnostics_.error(place, text.empty() || token.size == 3
                                      ? std::string(expected)
                                      : "'" + std::string(text.substr(0, 40)) + "' is not a number; " + expected +
                                            "; 'vector2' and 'vector3' make vectors from the stack");
        while (next_ < text_.size() && at() != ')' && at() != '\n' && at() != '}' && at() != '{') advance();
        if (at() == ')') advance();
        return;
      }
      token.values[token.size++] = number(text, place);
      skip();
      if (at() == ',') {
        advance();
      } else if (at() == ')') {
        advance();
        if (token.size >= 2)
          token.kind = TokenKind::vector;
        else
          diagnostics_.error(token.place, expected);
        return;
      }
    }
  }

  void string(Token& token) {
    advance();
    const size_t start = next_;
    while (next_ < text_.size() && at() != '"' && at() != '\n') advance();
    const std::string_view text = text_.substr(start, next_ - start);
    if (at() != '"') {
      diagnostics_.error(token.place, "this string has no '\"' at its end; expected one in the same line");
      return;
    }
    advance();
    if (text.size() > kMaxString) {
      diagnostics_.error(token.place, "a string holds at most " + std::to_string(kMaxString) + " bytes");
      return;
    }
    token.kind = TokenKind::string;
    token.index = static_cast<uint32_t>(program_.texts.size());
    program_.texts.emplace_back(text);
  }

  void close(std::vector<Token>& tokens) {
    Token token;
    token.kind = TokenKind::procedure;
    token.place = open_.back().place;
    token.index = static_cast<uint32_t>(program_.procedures.size());
    program_.procedures.push_back(std::move(tokens));
    tokens = std::move(open_.back().outside);
    open_.pop_back();
    tokens.push_back(token);
  }

  std::string_view text_;
  Diagnostics& diagnostics_;
  size_t next_ = 0;
  Place place_{1, 1};
  std::vector<Open> open_;
  size_t ignored_ = 0; // braces that nest too deep
  Program program_;
};
} // namespace

uint32_t NameTable::add(std::string_view text) {
  const auto [it, isNew] = numbers_.try_emplace(std::string(text), static_cast<uint32_t>(texts_.size()));
  if (isNew) texts_.push_back(&it->first);
  return it->second;
}

Program scan(std::string_view text, Diagnostics& diagnostics) { return Scanner(text, diagnostics).run(); }

} // namespace gpgp::spawn::gml
