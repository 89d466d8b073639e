// Recursive descent over the tokens of a PGA-shape file.
#include "spawn/graph_format.h"
#include "spawn/language/lexer.h"
#include "spawn/language/syntax.h"

namespace gpgp::spawn {
namespace {
constexpr int kMaxExpression = 64; // of expressions, and of operands in a row

struct SyntaxError {}; // was reported; the statement is given up

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
        // On to the next statement: after a ';', or where a rule begins because a ';' is missing.
        while (peek().kind != TokenKind::end && !(peek().kind == TokenKind::name && peek(1).kind == TokenKind::arrow) &&
               next().kind != TokenKind::semicolon) {
        }
      }
    }
    return tree;
  }

private:
  const Token& peek(size_t ahead = 0) const { return tokens_[std::min(at_ + ahead, tokens_.size() - 1)]; }
  const Token& next() {
    const Token& token = peek();
    if (at_ + 1 < tokens_.size()) ++at_;
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
    rule.broken = true;
    if (peek().kind == TokenKind::number && peek(1).kind == TokenKind::percent)
      rule.alternatives = alternatives();
    else
      rule.body = successor();
    rule.broken = false;
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
    } while (peek().kind == TokenKind::name || peek().kind == TokenKind::number);
    expect(TokenKind::open, "'(' with kind and index after the names of terminals");
    terminal.arguments = arguments();
    terminal.broken = false;
    expect(TokenKind::semicolon, "';' after the terminal");
  }

  /// Up to ')' ; '(' was taken.
  std::vector<Expression> arguments() {
    std::vector<Expression> result;
    if (accept(TokenKind::close)) return result;
    do result.push_back(expression());
    while (accept(TokenKind::comma));
    expect(TokenKind::close, "',' or ')' after an argument");
    return result;
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

  Successor successor() {
    const Nested nested(*this, depth_, kMaxNesting);
    Successor result;
    result.place = peek().place;
    std::string name = expectName("an operator, a rule or a terminal");
    if (!accept(TokenKind::open)) {
      result.name = std::move(name);
      return result;
    }
    auto call = std::make_shared<Call>();
    call->place = result.place;
    call->name = std::move(name);
    call->arguments = arguments();
    if (accept(TokenKind::openBrace)) {
      call->form = SuccessorForm::braces;
      do call->branches.push_back(branch());
      while (accept(TokenKind::bar));
      expect(TokenKind::closeBrace, "'|' or '}' after a successor");
    } else if (peek().kind == TokenKind::name || peek().kind == TokenKind::number) {
      call->form = SuccessorForm::chain;
      call->branches.push_back({std::nullopt, false, successor()});
    }
    result.call = std::move(call);
    return result;
  }

  Branch branch() {
    Branch result;
    // A label is an expression before a colon. A name alone may be a successor.
    const bool name = peek().kind == TokenKind::name;
    const bool labelCall = isName("Rand") || isName("Exp") || peek().text.substr(0, 5) == "Shape";
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
    result.successor = successor();
    return result;
  }

  /// 20%: A 30%: B else: C
  std::vector<Branch> alternatives() {
    std::vector<Branch> result;
    for (;;) {
      Branch branch;
      if (isName("else")) {
        next();
        branch.isElse = true;
      } else {
        branch.label = primary();
        expect(TokenKind::percent, "'%' after a probability");
      }
      expect(TokenKind::colon, "':' after a probability");
      branch.successor = successor();
      const bool last = branch.isElse;
      result.push_back(std::move(branch));
      accept(TokenKind::bar);
      if (last || (!isName("else") && peek().kind != TokenKind::number)) return result;
    }
  }

  static bool isOperator(TokenKind kind) { return kind >= TokenKind::plus; }

  // ---------------------------------------------------------------- expressions

  struct Level {
    TokenKind kind;
    int precedence;
    uint32_t op;
  };
  static const Level* levelOf(TokenKind kind) {
    static constexpr Level kLevels[] = {
        {TokenKind::either, 1, shader::kCodeOr},
        {TokenKind::both, 2, shader::kCodeAnd},
        {TokenKind::equal, 3, shader::kCodeEqual},
        {TokenKind::notEqual, 3, shader::kCodeNotEqual},
        {TokenKind::less, 4, shader::kCodeLess},
        {TokenKind::greater, 4, shader::kCodeGreater},
        {TokenKind::lessEqual, 4, shader::kCodeLessEqual},
        {TokenKind::greaterEqual, 4, shader::kCodeGreaterEqual},
        {TokenKind::plus, 5, shader::kCodeAdd},
        {TokenKind::minus, 5, shader::kCodeSubtract},
        {TokenKind::times, 6, shader::kCodeMultiply},
        {TokenKind::divided, 6, shader::kCodeDivide},
    };
    for (const Level& level : kLevels)
      if (level.kind == kind) return &level;
    return nullptr;
  }

  Expression expression(int precedence = 1) {
    Expression left = primary();
    for (int length = 0;;) {
      const Level* level = levelOf(peek().kind);
      if (!level || level->precedence < precedence) return left;
      if (++length > kMaxExpression) fail("a shorter expression");
      Expression binary;
      binary.kind = ExpressionKind::binary;
      binary.place = next().place;
      binary.op = level->op;
      binary.arguments.push_back(std::move(left));
      binary.arguments.push_back(expression(level->precedence + 1));
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
      result.arguments = arguments();
    }
    return result;
  }

  Diagnostics& diagnostics_;
  std::vector<Token> tokens_;
  size_t at_ = 0;
  int depth_ = 0, expressionDepth_ = 0;
};
} // namespace

SyntaxTree parse(std::string_view text, Diagnostics& diagnostics) { return Parser(text, diagnostics).run(); }

} // namespace gpgp::spawn
