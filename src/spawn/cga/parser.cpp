// Recursive descent.
#include "spawn/cga/parser.h"
#include "spawn/cga/operator_levels.h"
#include "spawn/cga/token_reader.h"

#include <algorithm>
#include <utility>

namespace gpgp::spawn::cga {
namespace {

class Parser : TokenReader {
public:
  using TokenReader::TokenReader;

  void file(File& file) {
    while (!atEnd()) {
      const size_t before = at_;
      try {
        definition(file);
      } catch (const Unexpected&) {
        if (at_ == before) ++at_;
        recover();
      }
    }
  }

private:
  void definition(File& file) {
    hasDepths_ = false; // whatever an error left
    std::vector<Annotation> annotations;
    while (token().is("@")) {
      Annotation a = annotation();
      if (a.name == "Group")
        group_ = std::make_shared<const Annotation>(std::move(a)); // of what comes from here on
      else
        annotations.push_back(std::move(a));
    }
    Definition d;
    d.place = token().place;
    if (token().isWord("version") && token(1).kind == TokenKind::string) {
      file.version = token(1).text;
      at_ += 2;
      return;
    }
    if (token().isWord("import") && (isName(1) || token(1).kind == TokenKind::string)) {
      ++at_;
      import(file, annotations);
      return;
    }
    if (token().isWord("style") && isName(1) && !arrowBehind(0)) {
      ++at_;
      Style style{token().text, {}, token().place};
      ++at_;
      if (acceptWord("extends")) style.base = name("the name of the style that this one extends");
      style_ = style.name;
      file.styles.push_back(std::move(style));
      return;
    }
    if (token().isWord("attr") && isName(1)) {
      d.kind = Definition::Kind::attribute;
      ++at_;
    } else if (token().isWord("const") && isName(1)) {
      d.kind = Definition::Kind::constant;
      ++at_;
    }
    while (isModifier(token()) && isName(1) && arrowBehind(1)) {
      if (token().isWord("start")) d.isStart = true;
      ++at_;
    }
    if (!isName()) unexpected("a definition: attr, const, import, a function or a rule");
    d.annotations = std::move(annotations);
    d.group = group_;
    d.style = style_;
    try {
      named(d);
    } catch (const Unexpected&) {
      // It is there, whatever it is: others may name it.
      if (d.kind == Definition::Kind::rule && d.hasBody) file.definitions.push_back(std::move(d));
      throw;
    }
    if (d.isStart && d.kind != Definition::Kind::rule) d.isStart = false;
    file.definitions.push_back(std::move(d));
  }

  /// From its name on; it is a rule or a function where d does not say.
  void named(Definition& d) {
    d.place = token().place;
    d.name = name("a name");
    if (token().is("(")) parameters(d);
    if (acceptWord("with")) locals(d);
    if (accept("-->")) {
      if (d.kind != Definition::Kind::rule) errors_.error(d.place, "attr and const are not rules; write = for -->");
      d.kind = Definition::Kind::rule;
      d.hasBody = true;
      for (const Annotation& a : d.annotations)
        if (a.name == "StartRule" || a.name == "Startrule" || a.name == "startrule") d.isStart = true;
      d.body = body();
      return;
    }
    if (!accept("=")) unexpected("'-->' or '=' behind the name " + d.name);
    if (d.kind == Definition::Kind::rule) d.kind = Definition::Kind::function;
    d.value = choices();
  }

  void parameters(Definition& d) {
    expect("(", "before parameters");
    while (!token().is(")")) {
      const Place place = token().place;
      std::string parameter = name("the name of a parameter");
      if (std::find(d.parameters.begin(), d.parameters.end(), parameter) != d.parameters.end())
        errors_.error(place, "two parameters are named '" + parameter + "'");
      d.parameters.push_back(std::move(parameter));
      if (!accept(",")) break;
    }
    expect(")", "behind parameters");
  }

  void locals(Definition& d) {
    expect("(", "behind with");
    while (!token().is(")")) {
      Local local{{}, token().place, nullptr};
      local.name = name("the name of a local variable");
      expect(":=", "behind the name of a local variable");
      local.value = choices();
      d.locals.push_back(std::move(local));
      if (!accept(";")) accept(",");
    }
    expect(")", "behind local variables");
  }

  Annotation annotation() {
    Annotation result{{}, token().place, {}};
    expect("@", "before an annotation");
    result.name = name("the name of an annotation");
    if (!accept("(")) return result;
    while (!token().is(")")) {
      AnnotationArgument argument;
      if (isName() && token(1).is("=")) {
        argument.name = token().text;
        at_ += 2;
      }
      argument.value = annotationValue();
      result.arguments.push_back(std::move(argument));
      if (!accept(",")) break;
    }
    expect(")", "behind an annotation's values");
    return result;
  }

  /// A value; what handles and the like hold besides is passed over.
  ExpressionPtr annotationValue() {
    const Place place = token().place;
    const auto ends = [&] { return token().is(",") || token().is(")"); };
    if (token().kind == TokenKind::number || token().kind == TokenKind::string || isName() || token().is("-")) {
      ExpressionPtr value = unary();
      if (ends()) return value;
    }
    for (uint32_t depth = 0; !atEnd() && !startsDefinition() && (depth || !ends()); ++at_) {
      if (token().is("(") || token().is("{") || token().is("[")) ++depth;
      if (token().is(")") || token().is("}") || token().is("]")) --depth;
    }
    return make(Expression::Kind::string, place);
  }

  void import(File& file, const std::vector<Annotation>& annotations) {
    Import import;
    import.place = token().place;
    for (const Annotation& a : annotations) {
      if (a.name != "Hidden") continue;
      import.hidesAll |= a.arguments.empty();
      for (const AnnotationArgument& hidden : a.arguments)
        if (hidden.value) import.hides.push_back(hidden.value->text);
    }
    if (isName()) {
      import.prefix = tokens_[at_++].text;
      if (accept("(")) { // the styles that it offers, of which the first is taken
        import.style = name("the name of a style");
        while (accept(",")) name("the name of a style");
        expect(")", "behind the styles of an import");
      }
      expect(":", "behind the prefix of an import");
    }
    if (token().kind != TokenKind::string) unexpected("the path of a .cga file in quotes");
    import.path = tokens_[at_++].text;
    if (isName() && token().isWord("style") && isName(1)) {
      ++at_;
      import.style = tokens_[at_++].text;
    } else if (accept(":")) {
      import.style = name("the name of a style");
    }
    if (accept("(")) {
      import.protectsAll = token().is(")");
      while (!token().is(")")) {
        if (isName() && (token(1).is(",") || token(1).is(")"))) {
          import.isProtected.push_back(name("the name of an attribute"));
        } else {
          Definition d;
          named(d);
          import.overrides.push_back(std::move(d));
        }
        if (!accept(",")) break;
      }
      expect(")", "behind what an import passes");
    }
    file.imports.push_back(std::move(import));
  }

  // --- bodies ---
  template <class F> auto inBraces(const F& inside) {
    ++braces_;
    const uint32_t branches = std::exchange(branches_, 0); // conditions in braces end there
    auto result = inside();
    branches_ = branches;
    --braces_;
    expect("}", "at the end of a block");
    return result;
  }

  Body body() {
    Nested nested(*this);
    Body result;
    uint32_t brackets = 0;
    while (!endsBody()) {
      const bool isInner = branches_ && brackets == 0; // what ends the body belongs to the conditions around
      if (token().isWord("case") || startsPercentage()) {
        if (isInner && !result.empty()) break;
        result.push_back(conditions());
        continue;
      }
      if (token().isWord("else")) {
        if (isInner) break;
        unexpected("an operation or a rule; there is no case before this else");
      }
      if (token().is("]") && isInner) break;
      if (token().is("[")) ++brackets;
      if (token().is("]") && brackets) --brackets;
      result.push_back(statement());
    }
    return result;
  }

  Statement conditions() {
    Nested nested(*this);
    Statement result;
    result.place = token().place;
    const bool isCase = token().isWord("case");
    result.kind = isCase ? Statement::Kind::cases : Statement::Kind::stochastic;
    ++branches_;
    while (isCase ? token().isWord("case") : startsPercentage()) {
      Branch branch;
      if (isCase) ++at_;
      branch.condition = expression();
      if (!isCase) expect("%", "behind a percentage");
      expect(":", isCase ? "behind a condition" : "behind a percentage");
      branch.body = body();
      result.branches.push_back(std::move(branch));
    }
    if (acceptWord("else")) {
      expect(":", "behind else");
      result.branches.push_back({nullptr, body()});
    }
    --branches_;
    return result;
  }

  Statement statement() {
    Statement s;
    s.place = token().place;
    if (accept("[")) {
      s.kind = Statement::Kind::push;
      return s;
    }
    if (accept("]")) {
      s.kind = Statement::Kind::pop;
      return s;
    }
    if (!isName()) unexpected("an operation, a rule, [ or ]");
    s.name = tokens_[at_++].text;
    if (token().is("(")) {
      s.isCall = true;
      s.arguments = arguments();
    }
    if (accept(".")) s.kind = Statement::Kind::leaf;
    if (token().is("{")) {
      block(s);
    } else if (isInlined(s.name) && s.kind == Statement::Kind::call &&
               isName()) { // inline Rule, inline split(x) { ... }
      Nested nested(*this);
      Part part;
      part.place = token().place;
      part.body.push_back(statement());
      s.hasBlock = true;
      s.parts.push_back(std::move(part));
    }
    return s;
  }

  std::vector<ExpressionPtr> arguments() {
    std::vector<ExpressionPtr> result;
    expect("(", "before arguments");
    while (!token().is(")")) {
      result.push_back(choices());
      if (!accept(",") && !token().is(")")) {
        // An older form separates arguments by spaces; what cannot begin one is an error.
        if (atEnd() || token().is("}") || token().is("|") || token().is("-->") || token().is("=")) break;
      }
    }
    expect(")", "behind arguments");
    return result;
  }

  void block(Statement& s) {
    s.hasBlock = true;
    if (s.name == "splitAndSetbackPerimeter") return perimeter(s);
    if (s.name == "scatter" || isInlined(s.name)) {
      expect("{", "");
      const bool hasTwo = isInlined(s.name) && s.name != "inline";
      s.parts = inBraces([&] {
        std::vector<Part> parts;
        do {
          Part part;
          part.place = token().place;
          part.body = body();
          parts.push_back(std::move(part));
        } while (hasTwo && parts.size() < 2 && accept("|"));
        return parts;
      });
    } else {
      s.parts = group();
    }
    s.repeats = accept("*");
  }

  /// { length : depth : operations | ... }* { remainder : operations }: the first is a group beside the remainder.
  void perimeter(Statement& s) {
    const bool outer = std::exchange(hasDepths_, true);
    Part sections = part();
    hasDepths_ = outer;
    if (!token().is("{")) unexpected("{ remainder : ... } behind the parts of the perimeter");
    s.parts = group();
    s.parts.insert(s.parts.begin(), std::move(sections));
  }

  std::vector<Part> group() {
    Nested nested(*this);
    expect("{", "");
    return inBraces([&] {
      std::vector<Part> parts;
      while (!token().is("}")) {
        parts.push_back(part());
        if (!accept("|")) break;
      }
      return parts;
    });
  }

  Part part() {
    Part result;
    result.place = token().place;
    if (token().is("{")) {
      result.isGroup = true;
      result.group = group();
      result.repeats = accept("*");
      return result;
    }
    result.selector = expression();
    if (accept("=")) {
      result.isOneShape = true;
      result.isConnected = accept(":");
    } else if (!accept(":"))
      unexpected("':' behind a size or a selector");
    if (hasDepths_) {
      result.depth = expression();
      expect(":", "behind a depth");
    }
    const bool outer = std::exchange(hasDepths_, false);
    result.body = body();
    hasDepths_ = outer;
    return result;
  }

  // --- expressions ---
  ExpressionPtr make(Expression::Kind kind, Place place, std::string text = {}) {
    auto result = std::make_unique<Expression>();
    result->kind = kind;
    result->place = place;
    result->text = std::move(text);
    return result;
  }
  void settleDepth(Expression& e) {
    for (const ExpressionPtr& a : e.arguments)
      if (a) e.depth = std::max(e.depth, a->depth + 1);
    for (const Choice& c : e.choices) {
      if (c.condition) e.depth = std::max(e.depth, c.condition->depth + 1);
      if (c.value) e.depth = std::max(e.depth, c.value->depth + 1);
    }
    if (e.depth <= kDeepestExpression) return;
    errors_.error(e.place,
                  "this expression has more than " + std::to_string(kDeepestExpression) + " operators in a row");
    throw Unexpected();
  }

  /// An expression, or cases or percentages of such.
  ExpressionPtr choices() {
    Nested nested(*this);
    const bool isCase = token().isWord("case");
    if (!isCase && !startsPercentage()) return expression();
    ExpressionPtr result = make(isCase ? Expression::Kind::cases : Expression::Kind::stochastic, token().place);
    while (isCase ? token().isWord("case") : startsPercentage()) {
      if (isCase) ++at_;
      Choice choice;
      choice.condition = expression();
      if (!isCase) expect("%", "behind a percentage");
      expect(":", isCase ? "behind a condition" : "behind a percentage");
      choice.value = choices();
      result->choices.push_back(std::move(choice));
    }
    if (acceptWord("else")) {
      expect(":", "behind else");
      result->choices.push_back({nullptr, choices()});
    }
    settleDepth(*result);
    return result;
  }

  ExpressionPtr expression(int level = 1) {
    Nested nested(*this);
    ExpressionPtr left = unary();
    for (;;) {
      const Token& t = token();
      const auto found = t.kind == TokenKind::symbol
                             ? std::find_if(std::begin(kOperators), std::end(kOperators),
                                            [&](const OperatorLevel& o) { return o.text == t.text; })
                             : std::end(kOperators);
      if (found == std::end(kOperators) || found->level < level) return left;
      if (t.is("%") && token(1).is(":")) return left; // a percentage
      ExpressionPtr result = make(Expression::Kind::binary, t.place, t.text);
      ++at_;
      result->arguments.push_back(std::move(left));
      result->arguments.push_back(expression(found->level + 1));
      settleDepth(*result);
      left = std::move(result);
    }
  }

  ExpressionPtr unary() {
    Nested nested(*this);
    const Token& t = token();
    const auto kind = t.is("'")   ? Expression::Kind::relative
                      : t.is("~") ? Expression::Kind::floating
                                  : Expression::Kind::unary;
    if (!t.is("-") && !t.is("!") && !t.is("+") && !t.is("'") && !t.is("~") && !t.is(".-") && !t.is(".+") && !t.is(".!"))
      return postfix();
    ExpressionPtr result = make(kind, t.place, t.text);
    ++at_;
    // ~a * b is a floating size of a * b; -a * b is (-a) * b.
    result->arguments.push_back(kind == Expression::Kind::unary ? unary() : expression(5));
    settleDepth(*result);
    if (result->text == "+" || result->text == ".+") return std::move(result->arguments[0]);
    return result;
  }

  ExpressionPtr postfix() {
    ExpressionPtr result = primary();
    while (token().is("[") && token().place.line == tokens_[at_ - 1].place.line && canBeIndexed(*result)) {
      ExpressionPtr index = make(Expression::Kind::index, token().place);
      ++at_;
      index->arguments.push_back(std::move(result));
      while (!token().is("]")) {
        index->arguments.push_back(indexRange());
        if (!accept(",")) break;
      }
      expect("]", "behind an index");
      settleDepth(*index);
      result = std::move(index);
    }
    return result;
  }
  static bool canBeIndexed(const Expression& e) {
    return e.kind == Expression::Kind::name || e.kind == Expression::Kind::array || e.kind == Expression::Kind::rows ||
           e.kind == Expression::Kind::index || e.kind == Expression::Kind::binary ||
           e.kind == Expression::Kind::components;
  }

  /// A value of an array or an index, or first:last, or first:step:last; of an index either end may be missing.
  ExpressionPtr indexRange() {
    const Place place = token().place;
    ExpressionPtr first = token().is(":") ? nullptr : choices();
    if (!accept(":")) return first;
    ExpressionPtr range = make(Expression::Kind::range, place);
    range->arguments.push_back(std::move(first));
    range->arguments.push_back(token().is("]") || token().is(",") ? nullptr : choices());
    if (accept(":")) range->arguments.push_back(choices());
    settleDepth(*range);
    return range;
  }

  /// Behind its [: values, and rows of them by semicolons.
  ExpressionPtr arrayLiteral(Place place) {
    std::vector<ExpressionPtr> rows;
    do {
      ExpressionPtr row = make(Expression::Kind::array, place);
      while (!token().is("]") && !token().is(";")) {
        row->arguments.push_back(indexRange());
        if (!accept(",")) break;
      }
      settleDepth(*row);
      rows.push_back(std::move(row));
    } while (accept(";"));
    expect("]", "at the end of an array");
    if (rows.size() == 1) return std::move(rows[0]);
    ExpressionPtr result = make(Expression::Kind::rows, place);
    result->arguments = std::move(rows);
    settleDepth(*result);
    return result;
  }

  /// comp(f) { selector: value | ... } as a value.
  ExpressionPtr componentValues(ExpressionPtr call) {
    call->kind = Expression::Kind::components;
    expect("{", "");
    call->parts = inBraces([&] {
      std::vector<Part> parts;
      while (!token().is("}")) {
        Part part;
        part.place = token().place;
        part.selector = expression();
        if (accept("="))
          part.isOneShape = true;
        else if (!accept(":"))
          unexpected("':' behind a selector");
        part.value = choices();
        settleDepth(*part.value);
        call->depth = std::max(call->depth, part.value->depth + 1);
        parts.push_back(std::move(part));
        if (!accept("|")) break;
      }
      return parts;
    });
    settleDepth(*call);
    return call;
  }

  ExpressionPtr primary() {
    const Token& t = token();
    const Place place = t.place;
    if (t.kind == TokenKind::number) {
      ExpressionPtr result = make(Expression::Kind::number, place);
      result->number = t.number;
      ++at_;
      return result;
    }
    if (t.kind == TokenKind::string) {
      ++at_;
      return make(Expression::Kind::string, place, tokens_[at_ - 1].text);
    }
    if (t.isWord("case")) return choices();
    if (t.isWord("true") || t.isWord("false")) {
      ExpressionPtr result = make(Expression::Kind::boolean, place);
      result->number = t.isWord("true") ? 1 : 0;
      ++at_;
      return result;
    }
    if (t.kind == TokenKind::identifier && !t.isWord("else")) {
      ExpressionPtr result = make(Expression::Kind::name, place, t.text);
      ++at_;
      if (token().is("(") && !startsPercentage()) {
        result->isCall = true;
        result->arguments = arguments();
        settleDepth(*result);
        if (result->text == "comp" && token().is("{")) return componentValues(std::move(result));
      }
      return result;
    }
    if (accept("(")) {
      ExpressionPtr result = choices();
      expect(")", "behind an expression");
      return result;
    }
    if (accept("[")) return arrayLiteral(place);
    unexpected("a value");
  }

  std::string style_;
  std::shared_ptr<const Annotation> group_;
  uint32_t branches_ = 0;
  bool hasDepths_ = false; ///< the parts of a perimeter are read
};

} // namespace

File parse(std::string_view text, std::string path, Diagnostics& errors) {
  File file;
  file.path = std::move(path);
  Parser(tokenize(text, errors), errors).file(file);
  return file;
}

} // namespace gpgp::spawn::cga
