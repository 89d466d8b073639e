// Recursive descent over the tokens of a PGA-shape file.
//
// A syntax error ends what it stands in: an argument up to its ',' or ')', a successor up to its '|' or '}', or the
// statement up to its ';' or to where another one begins. What was read before stays in the tree, where it is checked
// as the rest is, and what was not is marked, so that nobody reports that it is missing.
#include "spawn/language/lexer.h"
#include "spawn/language/spellings.h"
#include "spawn/language/syntax.h"

namespace gpgp::spawn {
namespace {
constexpr int kMaxExpression = 64; // of expressions, and of operands in a row

struct SyntaxError {}; // was reported

class Parser {
public:
  Parser(std::string_view text, Diagnostics& diagnostics)
      : diagnostics_(diagnostics), tokens_(tokenize(text, diagnostics)) {}

  SyntaxTree run() {
    SyntaxTree tree;
    while (peek().kind != TokenKind::end) {
      try {
        statement(tree);
      } catch (const SyntaxError&) {
        while (peek().kind != TokenKind::end && !atStatement() && next().kind != TokenKind::semicolon) {
        }
      }
      parens_ = braces_ = 0;
    }
    return tree;
  }

private:
  const Token& peek(size_t ahead = 0) const { return tokens_[std::min(at_ + ahead, tokens_.size() - 1)]; }
  const Token& next() {
    const Token& token = peek();
    if (at_ + 1 < tokens_.size()) ++at_;
    if (token.kind == TokenKind::open) ++parens_;
    if (token.kind == TokenKind::close) --parens_;
    if (token.kind == TokenKind::openBrace) ++braces_;
    if (token.kind == TokenKind::closeBrace) --braces_;
    return token;
  }
  bool accept(TokenKind kind) {
    if (peek().kind != kind) return false;
    next();
    return true;
  }
  [[noreturn]] void fail(const std::string& expected) {
    diagnostics_.error(peek().place, "expected " + expected + ", found " + describe(peek()));
    throw SyntaxError{};
  }
  const Token& expect(TokenKind kind, const std::string& expected) {
    if (peek().kind != kind) fail(expected);
    return next();
  }
  std::string expectName(const std::string& expected) {
    // "12" can be a name where a name is wanted; where a number can stand, it is a number
    const Token& token = peek();
    const bool digits = token.kind == TokenKind::number && token.text.find('.') == std::string_view::npos;
    if (token.kind != TokenKind::name && !digits) fail(expected);
    return std::string(next().text);
  }
  bool isName(const char* text, size_t ahead = 0) const {
    return peek(ahead).kind == TokenKind::name && peek(ahead).text == text;
  }
  bool isNameOrNumber(size_t ahead = 0) const {
    return peek(ahead).kind == TokenKind::name || peek(ahead).kind == TokenKind::number;
  }

  /// Whether a statement begins here, although no ';' may stand before it.
  bool atStatement() const {
    const TokenKind third = peek(2).kind;
    if (isNameOrNumber() && peek(1).kind == TokenKind::arrow) return true;
    if (!isNameOrNumber(1)) return false;
    if (isName("var")) return third == TokenKind::arrow;
    if (isName("axiom")) return third == TokenKind::openBrace || isNameOrNumber(2);
    return isName("terminal") && (third == TokenKind::open || third == TokenKind::comma || isNameOrNumber(2));
  }
  /// And on a line of its own: within parentheses and braces '=' may be a wrong '=='.
  bool atStatementLine() const { return at_ > 0 && peek().place.line > tokens_[at_ - 1].place.line && atStatement(); }

  /// 30%: or else: , behind the alternative before it.
  bool atAlternative() const {
    return (isName("else") && peek(1).kind == TokenKind::colon) ||
           (peek().kind == TokenKind::number && peek(1).kind == TokenKind::percent);
  }

  /// From an error in a list on to the separator or end that belongs to the list. False where the statement ends first.
  bool skipTo(TokenKind separator, TokenKind end, int parens, int braces) {
    for (;; next()) {
      const TokenKind kind = peek().kind;
      const bool brace = kind == TokenKind::bar || kind == TokenKind::openBrace || kind == TokenKind::closeBrace;
      if (kind == TokenKind::end || kind == TokenKind::semicolon || atStatementLine()) return false;
      if (end == TokenKind::close && brace) return false;
      const bool inside = end == TokenKind::close ? parens_ > parens : braces_ > braces;
      if (!inside && (kind == separator || kind == end)) break;
    }
    parens_ = parens;
    return true;
  }

  struct Nested {
    Nested(Parser& parser, int& level, int limit) : depth(level) {
      if (depth >= limit) {
        parser.diagnostics_.error(parser.peek().place, "this is nested more than " + std::to_string(limit) + " deep");
        throw SyntaxError{};
      }
      ++depth;
    }
    ~Nested() { --depth; }
    int& depth;
  };

  void statement(SyntaxTree& tree) {
    const bool definition = peek(1).kind == TokenKind::arrow; // rules may be called var, axiom or terminal
    if (isName("var") && !definition) return variable(tree);
    if (isName("axiom") && !definition) return axiom(tree);
    if (isName("terminal") && !definition) return terminal(tree);
    const Place place = peek().place;
    std::string name = expectName("'var', 'axiom', 'terminal' or the name of a rule");
    expect(TokenKind::arrow, "'-->' or '=' after the name of a rule");
    RuleDefinition& rule = tree.rules.emplace_back();
    rule.place = place;
    rule.name = std::move(name);
    if (peek().kind == TokenKind::number && peek(1).kind == TokenKind::percent)
      alternatives(rule.alternatives);
    else
      successor(rule.body);
    expect(TokenKind::semicolon, "';' at the end of the rule");
  }

  void variable(SyntaxTree& tree) {
    next();
    const Place place = peek().place;
    std::string name = expectName("the name of the variable");
    if (peek().kind != TokenKind::arrow) fail("'=' after the name of the variable");
    next();
    VariableDefinition& variable = tree.variables.emplace_back();
    variable.place = place;
    variable.name = std::move(name);
    variable.value.kind = ExpressionKind::broken;
    variable.value = expression();
    expect(TokenKind::semicolon, "';' after the variable");
  }

  void axiom(SyntaxTree& tree) {
    AxiomDefinition axiom;
    axiom.place = next().place;
    tree.brokenAxiom = true;
    axiom.shapePlace = peek().place;
    axiom.shape = expectName("the shape of the axiom, as Box or Quad");
    if (accept(TokenKind::openBrace)) {
      do axiom.corners.push_back(corner());
      while (accept(TokenKind::comma));
      expect(TokenKind::closeBrace, "',' or '}' after a corner");
    }
    axiom.namePlace = peek().place;
    axiom.name = expectName("the name of the rule that the axiom starts with");
    tree.axioms.push_back(std::move(axiom));
    expect(TokenKind::semicolon, "';' after the axiom");
  }

  void terminal(SyntaxTree& tree) {
    const Place line = next().place;
    TerminalDefinition& terminal = tree.terminals.emplace_back();
    terminal.place = line;
    terminal.broken = true;
    do {
      const Place place = peek().place;
      terminal.names.emplace_back(place, expectName("the name of a terminal"));
      accept(TokenKind::comma);
    } while (isNameOrNumber() && !atStatementLine());
    expect(TokenKind::open, "'(' with kind and index after the names of terminals");
    arguments(terminal.arguments);
    terminal.broken = false;
    expect(TokenKind::semicolon, "';' after the terminal");
  }

  /// Up to ')' ; '(' was taken.
  void arguments(std::vector<Expression>& result) {
    if (accept(TokenKind::close)) return;
    const int parens = parens_, braces = braces_;
    do {
      Expression& argument = result.emplace_back();
      argument.kind = ExpressionKind::broken;
      try {
        Expression value = expression();
        if (peek().kind != TokenKind::comma && peek().kind != TokenKind::close) fail("',' or ')' after an argument");
        argument = std::move(value);
      } catch (const SyntaxError&) {
        if (!skipTo(TokenKind::comma, TokenKind::close, parens, braces)) throw;
      }
    } while (next().kind == TokenKind::comma);
  }

  Expression corner() {
    if (peek().kind != TokenKind::open) fail("a corner as (x, y)");
    Expression pair = primary();
    if (pair.kind != ExpressionKind::pair) {
      diagnostics_.error(pair.place, "expected a corner as (x, y)");
      throw SyntaxError{};
    }
    return pair;
  }

  void successor(Successor& result) {
    const Nested nested(*this, depth_, kMaxNesting);
    result.place = peek().place;
    if (atStatement()) fail("an operator, a rule or a terminal");
    std::string name = expectName("an operator, a rule or a terminal");
    if (!accept(TokenKind::open)) {
      result.name = std::move(name);
      return;
    }
    result.call = std::make_shared<Call>();
    Call& call = *result.call;
    call.place = result.place;
    call.name = std::move(name);
    call.broken = true;
    arguments(call.arguments);
    if (accept(TokenKind::openBrace)) {
      call.form = SuccessorForm::braces;
      branches(call.branches);
    } else if (isNameOrNumber() && !atStatement() && !atAlternative()) {
      call.form = SuccessorForm::chain;
      successor(call.branches.emplace_back().successor);
    }
    call.broken = false;
  }

  /// Up to '}' ; '{' was taken.
  void branches(std::vector<Branch>& result) {
    const int parens = parens_, braces = braces_;
    do {
      try {
        branch(result.emplace_back());
        if (peek().kind != TokenKind::bar && peek().kind != TokenKind::closeBrace) fail("'|' or '}' after a successor");
      } catch (const SyntaxError&) {
        if (!skipTo(TokenKind::bar, TokenKind::closeBrace, parens, braces)) throw;
      }
    } while (next().kind == TokenKind::bar);
  }

  void branch(Branch& result) {
    // A label is an expression before a colon. A name alone may be a successor.
    const bool name = peek().kind == TokenKind::name;
    bool labelCall = peek().text.substr(0, 5) == "Shape";
    forFunctionNames([&](const char* function) { labelCall = labelCall || isName(function); });
    if (isName("else") && peek(1).kind == TokenKind::colon) {
      next();
      next();
      result.isElse = true;
    } else if (!name || peek(1).kind == TokenKind::colon || isOperator(peek(1).kind) ||
               (labelCall && peek(1).kind == TokenKind::open)) {
      if (peek().kind != TokenKind::bar && peek().kind != TokenKind::closeBrace) {
        result.label = expression();
        expect(TokenKind::colon, "':' between a value and its successor");
      }
    }
    successor(result.successor);
  }

  /// 20%: A 30%: B else: C
  void alternatives(std::vector<Branch>& result) {
    for (;;) {
      Branch& branch = result.emplace_back();
      if (isName("else")) {
        next();
        branch.isElse = true;
      } else {
        branch.label = primary();
        expect(TokenKind::percent, "'%' after a probability");
      }
      expect(TokenKind::colon, "':' after a probability");
      successor(branch.successor);
      accept(TokenKind::bar);
      if (branch.isElse || (!isName("else") && peek().kind != TokenKind::number) || atStatement()) return;
    }
  }

  static bool isOperator(TokenKind kind) { return kind >= TokenKind::plus; }

  // ---------------------------------------------------------------- expressions

  static const Binary* binaryAt(const Token& token) {
    for (const Binary& binary : kBinaries)
      if (binary.precedence && token.text == binary.spelling) return &binary;
    return nullptr;
  }

  Expression expression(uint32_t precedence = 1) {
    Expression left = primary();
    for (int length = 0;;) {
      const Binary* op = binaryAt(peek());
      if (!op || op->precedence < precedence) return left;
      if (++length > kMaxExpression) fail("a shorter expression");
      Expression binary;
      binary.kind = ExpressionKind::binary;
      binary.place = next().place;
      binary.op = op->code;
      binary.arguments.push_back(std::move(left));
      binary.arguments.push_back(expression(op->precedence + 1));
      left = std::move(binary);
    }
  }

  Expression primary() {
    const Nested nested(*this, expressionDepth_, kMaxExpression);
    const Token token = peek();
    Expression result;
    result.place = token.place;
    if (accept(TokenKind::minus)) {
      Expression value = primary();
      if (value.kind == ExpressionKind::number) {
        value.number = -value.number;
        value.place = token.place;
        return value;
      }
      result.kind = ExpressionKind::binary;
      result.op = shader::kCodeSubtract;
      result.arguments.resize(1);
      result.arguments[0].place = token.place;
      result.arguments.push_back(std::move(value));
      return result;
    }
    if (accept(TokenKind::plus)) return primary();
    if (accept(TokenKind::number)) {
      result.number = token.number;
      return result;
    }
    if (accept(TokenKind::open)) {
      Expression first = expression();
      if (accept(TokenKind::close)) return first;
      expect(TokenKind::comma, "')' or ','");
      result.kind = ExpressionKind::pair;
      result.arguments.push_back(std::move(first));
      result.arguments.push_back(expression());
      expect(TokenKind::close, "')'");
      return result;
    }
    if (token.kind != TokenKind::name) fail("a value");
    next();
    result.name = std::string(token.text);
    result.kind = ExpressionKind::name;
    if (accept(TokenKind::open)) {
      result.kind = ExpressionKind::call;
      arguments(result.arguments);
    }
    return result;
  }

  Diagnostics& diagnostics_;
  std::vector<Token> tokens_;
  size_t at_ = 0;
  int parens_ = 0, braces_ = 0; // open ones of the statement
  int depth_ = 0, expressionDepth_ = 0;
};
} // namespace

SyntaxTree parse(std::string_view text, Diagnostics& diagnostics) { return Parser(text, diagnostics).run(); }

} // namespace gpgp::spawn
