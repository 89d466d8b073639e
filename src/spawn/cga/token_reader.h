// Reads the tokens of a .cga file one by one. Such a file has no separators between the items of a rule, nor between
// definitions: a body ends where a name with --> or = behind it begins the next definition.
#pragma once
#include "spawn/cga/parser.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace gpgp::spawn::cga {

/// Of the definition that does not parse: what follows it is looked at again.
struct Unexpected {};

class TokenReader {
public:
  TokenReader(std::vector<Token> tokens, Diagnostics& errors) : tokens_(std::move(tokens)), errors_(errors) {}

protected:
  const Token& token(size_t ahead = 0) const { return tokens_[std::min(at_ + ahead, tokens_.size() - 1)]; }
  bool atEnd() const { return token().kind == TokenKind::end; }
  bool isName(size_t ahead = 0) const { return token(ahead).kind == TokenKind::identifier; }
  bool accept(std::string_view symbol) {
    if (!token().is(symbol)) return false;
    ++at_;
    return true;
  }
  bool acceptWord(std::string_view word) {
    if (!token().isWord(word)) return false;
    ++at_;
    return true;
  }
  static std::string describe(const Token& t) {
    if (t.kind == TokenKind::end) return t.text;
    if (t.kind == TokenKind::string) return "the string \"" + t.text.substr(0, 40) + '"';
    return '\'' + t.text.substr(0, 60) + '\'';
  }
  [[noreturn]] void unexpected(const std::string& expected) {
    errors_.error(token().place, "expected " + expected + ", not " + describe(token()));
    throw Unexpected();
  }
  void expect(std::string_view symbol, const char* where) {
    if (!accept(symbol)) unexpected(std::string("'").append(symbol) + "' " + where);
  }
  std::string name(const char* what) {
    if (!isName()) unexpected(what);
    return tokens_[at_++].text;
  }
  /// Counts how deep the recursion is.
  class Nested {
  public:
    explicit Nested(TokenReader& reader) : reader_(reader) {
      if (++reader_.depth_ <= kMostNested) return;
      reader_.errors_.error(reader_.token().place, "this is nested more than " + std::to_string(kMostNested) + " deep");
      throw Unexpected(); // recover() sets the depth to 0
    }
    ~Nested() {
      if (reader_.depth_) --reader_.depth_;
    }

  private:
    TokenReader& reader_;
  };

  // --- where definitions begin ---
  size_t behindParentheses(size_t ahead) const {
    if (!token(ahead).is("(")) return ahead;
    size_t depth = 0;
    for (size_t i = ahead; token(i).kind != TokenKind::end && i < ahead + 4096; ++i) {
      if (token(i).is("(")) ++depth;
      if (token(i).is(")") && --depth == 0) return i + 1;
      if (token(i).is("-->")) break;
    }
    return ahead;
  }
  /// The place of --> or = behind a name at ahead, its parameters and locals; 0: none.
  size_t arrowBehind(size_t ahead) const {
    if (!isName(ahead)) return 0;
    size_t at = behindParentheses(ahead + 1);
    if (token(at).isWord("with") && token(at + 1).is("(")) at = behindParentheses(at + 1);
    return token(at).is("-->") || token(at).is("=") ? at : 0;
  }
  static bool isModifier(const Token& t) { return t.isWord("start") || t.isWord("extension") || t.isWord("export"); }
  bool startsDefinition() const {
    if (token().is("@")) return true;
    if (!isName()) return false;
    if ((token().isWord("attr") || token().isWord("const")) && isName(1)) return true;
    if (token().isWord("import") && (isName(1) || token(1).kind == TokenKind::string)) return true;
    if (token().isWord("style") && isName(1) && !arrowBehind(0)) return true;
    if (token().isWord("version") && token(1).kind == TokenKind::string) return true;
    if (isModifier(token()) && arrowBehind(1) && token(arrowBehind(1)).is("-->")) return true;
    const size_t arrow = arrowBehind(0);
    return arrow && (braces_ == 0 || token(arrow).is("-->"));
  }
  /// What is derived at once: of a block, or of the one statement behind it.
  static bool isInlined(std::string_view name) {
    return name == "inline" || name == "union" || name == "subtract" || name == "intersect";
  }
  bool endsBody() const {
    const Token& t = token();
    return t.kind == TokenKind::end || t.is("|") || t.is("}") || t.is(")") || t.is(",") || startsDefinition();
  }
  /// A number or an expression in parentheses, with % and : behind it.
  bool startsPercentage() const {
    if (token().kind == TokenKind::number) return token(1).is("%") && token(2).is(":");
    if (token().is("(")) {
      const size_t behind = behindParentheses(0);
      return token(behind).is("%") && token(behind + 1).is(":");
    }
    return isName() &&
           ((token(1).is("%") && token(2).is(":")) ||
            (token(1).is("(") && token(behindParentheses(1)).is("%") && token(behindParentheses(1) + 1).is(":")));
  }

  /// Goes on to the next definition.
  void recover() {
    braces_ = depth_ = 0;
    while (!atEnd() && !startsDefinition()) ++at_;
  }

  std::vector<Token> tokens_;
  Diagnostics& errors_;
  size_t at_ = 0;
  uint32_t depth_ = 0, braces_ = 0;
};

} // namespace gpgp::spawn::cga
