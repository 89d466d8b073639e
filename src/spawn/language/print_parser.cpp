// The printed form back to a graph. One pass over the tokens; what it names by number is checked once all is read.
#include "spawn/graph/export_labels.h"
#include "spawn/language/lexer.h"
#include "spawn/language/print.h"
#include "spawn/shared/expression.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <map>

namespace gpgp::spawn {
namespace {
using namespace shader;

struct Stop {}; // an error that leaves no way to go on in the statement

class Parser {
public:
  Parser(std::string_view text, Diagnostics& diagnostics, std::pmr::memory_resource* memory)
      : diagnostics_(diagnostics), tokens_(tokenize(text, diagnostics, true)), graph_(memory) {
    addRegularPolygons(graph_);
    while (!is(TokenKind::end)) {
      const size_t before = at_;
      try {
        statement();
      } catch (const Stop&) {
        if (at_ == before) ++at_;
        while (!is(TokenKind::end) && !atStatement()) ++at_;
      }
    }
  }

  bool hasGraph() const { return !axiomPlaces_.empty() || !graph_.nodes.empty(); }

  std::optional<Graph> takeGraph() {
    if (axiomPlaces_.empty()) diagnostics_.error({1, 1}, "there is no axiom; expected a line as: axiom Box -> 0");
    finish();
    if (diagnostics_.hasErrors()) return std::nullopt;
    analyse(graph_);
    checkMultiplicities();
    if (graph_.phases == kNoPhases)
      diagnostics_.error({},
                         "there is no order of phases in which every Collider is before each IfCollides of its tag, "
                         "and higher priorities are before lower ones");
    if (auto ok = validate(graph_); !ok) diagnostics_.error({}, ok.error().text);
    if (diagnostics_.hasErrors()) return std::nullopt;
    return std::move(graph_);
  }

  std::optional<Partition> partitionOf(const Graph& graph) {
    if (groups_.empty() || diagnostics_.hasErrors()) return std::nullopt;
    const Flow flow = makeFlow(graph);
    std::vector<uint32_t> groupOf(graph.nodes.size(), kNoGroup);
    std::map<uint32_t, Place> placeOf;
    for (uint32_t g = 0; g < groups_.size(); ++g)
      for (const auto& [place, node] : groups_[g].nodes) {
        if (node >= graph.nodes.size())
          diagnostics_.error(place, std::string("there is no node ") + std::to_string(node));
        else if (!placeOf.try_emplace(node, place).second)
          diagnostics_.error(place, std::string("node ") + std::to_string(node) + " is already in the group of line " +
                                        std::to_string(groups_[groupOf[node]].place.line));
        else
          groupOf[node] = g;
      }
    if (diagnostics_.hasErrors()) return std::nullopt;
    if (const auto found = violation(flow, groupOf)) {
      const auto place = placeOf.find(found->node);
      diagnostics_.error(place == placeOf.end() ? groups_[0].place : place->second,
                         (found->condition ? std::string("condition ") + std::to_string(found->condition) + ": " : "") +
                             found->text);
      return std::nullopt;
    }
    return partitionOfGroups(flow, groupOf);
  }

private:
  struct GroupLine {
    Place place;
    std::vector<std::pair<Place, uint32_t>> nodes;
  };
  struct TerminalNode {
    Token terminal;
    uint32_t node;
    std::optional<Token> rule; ///< in whose body it stands
  };
  /// A value as code; what kind of parameter it makes depends on how it is written.
  struct Value {
    std::vector<uint32_t> words;
    uint32_t kind = kParameterProgram;
  };

  // ---------------------------------------------------------------- tokens

  const Token& now() const { return tokens_[at_]; }
  bool is(TokenKind kind) const { return now().kind == kind; }
  bool isName(std::string_view name) const { return is(TokenKind::name) && now().text == name; }
  [[noreturn]] void fail(const Token& token, const std::string& text) {
    diagnostics_.error(token.place, text);
    throw Stop{};
  }
  const Token& expect(TokenKind kind, const char* what) {
    if (!is(kind)) fail(now(), std::string("expected ") + what + ", found " + describe(now()));
    return tokens_[at_++];
  }
  bool accept(TokenKind kind) {
    if (!is(kind)) return false;
    ++at_;
    return true;
  }
  uint32_t whole(const char* what) {
    const Token& token = expect(TokenKind::number, what);
    uint32_t value = 0;
    const char* last = token.text.data() + token.text.size();
    const auto [end, error] = std::from_chars(token.text.data(), last, value);
    if (error != std::errc() || end != last || value >= 1000000000)
      fail(token, std::string("expected ") + what + ", found " + describe(token));
    return value;
  }
  /// Names may be digits alone, or 2e5; but a number that begins a line is a node's.
  const Token& name(const char* what) {
    const bool number = is(TokenKind::number) && at_ && now().place.line == tokens_[at_ - 1].place.line &&
                        std::all_of(now().text.begin(), now().text.end(), isNameCharacter);
    return expect(number ? TokenKind::number : TokenKind::name, what);
  }
  float number() {
    const bool negative = accept(TokenKind::minus);
    const Token& token = expect(TokenKind::number, "a number");
    const float value = negative ? -token.number : token.number;
    if (settle(value) != value) fail(token, "this number is too small or too large");
    return value;
  }
  uint32_t oneOf(uint32_t count, const char* (*text)(uint32_t), const char* what) {
    const Token& token = expect(TokenKind::name, what);
    for (uint32_t i = 0; i < count; ++i)
      if (token.text == text(i)) return i;
    fail(token, std::string("expected ") + what + ", found " + describe(token));
  }
  uint32_t axis() { return oneOf(3, axisText, "an axis: X, Y or Z"); }

  // ---------------------------------------------------------------- statements

  bool atStatement() const {
    const bool keyword = isName("axiom") || isName("terminal") || isName("field") || isName("polygon") ||
                         isName("rule") || isName("group");
    return keyword || (is(TokenKind::number) && tokens_[at_ + 1].kind == TokenKind::name &&
                       tokens_[at_].place.line != (at_ ? tokens_[at_ - 1].place.line : 0));
  }

  void statement() {
    if (is(TokenKind::number)) return node();
    const Token& keyword = now();
    if (isName("axiom")) return ++at_, axiom(keyword.place);
    if (isName("terminal")) return ++at_, terminal();
    if (isName("field")) return ++at_, field();
    if (isName("polygon")) return ++at_, polygon();
    if (isName("rule")) return ++at_, rule();
    if (isName("group")) return ++at_, group(keyword.place);
    fail(keyword, std::string("expected a node's number, axiom, terminal, field, polygon, rule or group, found ") +
                      describe(keyword));
  }

  uint32_t target() {
    if (isName("Discard")) return ++at_, kNoNode;
    const Place place = now().place;
    const uint32_t node = whole("a node's number or Discard");
    targets_.emplace_back(place, node);
    return node;
  }

  void axiom(Place place) {
    axiomPlaces_.push_back(place);
    Axiom axiom;
    const bool named = !is(TokenKind::end) && tokens_[at_ + 1].kind == TokenKind::colon; // as a file: also 2e5
    axiom.name = addName(named ? std::string(now().text) : std::string());
    if (named) at_ += 2;
    axiom.shape = oneOf(kShapeCount, shapeName, "a shape");
    axiom.polygon = usualPolygon(axiom.shape);
    if (accept(TokenKind::open)) {
      axiom.polygon = whole("a polygon's number");
      expect(TokenKind::close, "')'");
    }
    expect(TokenKind::arrow, "'->'");
    axiom.node = target();
    graph_.axioms.push_back(axiom);
  }

  uint32_t addName(const std::string& text) {
    const uint32_t at = static_cast<uint32_t>(graph_.names.size());
    graph_.names.insert(graph_.names.end(), text.begin(), text.end());
    graph_.names.push_back(0);
    return at;
  }

  void terminal() {
    const Token& token = name("a terminal's name");
    Terminal terminal;
    if (!terminals_.try_emplace(std::string(token.text), static_cast<uint32_t>(graph_.terminals.size())).second)
      fail(token, std::string("terminal ") + describe(token) + " is defined twice");
    terminal.name = addName(std::string(token.text));
    graph_.terminals.push_back(terminal); // also where the rest is wrong, so that uses of the name are no errors
    expect(TokenKind::open, "'('");
    terminal.kind = whole("a kind, 0 or 1");
    expect(TokenKind::comma, "','");
    terminal.index = whole("an index");
    expect(TokenKind::close, "')'");
    if (!isName("bucket")) fail(now(), std::string("expected 'bucket', found ") + describe(now()));
    ++at_;
    terminal.bucket = whole("a bucket's number");
    graph_.terminals.back() = terminal;
    graph_.buckets = std::max(graph_.buckets, terminal.bucket + 1);
  }

  void field() {
    const Token& token = name("a field's name");
    const size_t before = graph_.fields.size();
    if (fieldNamed(graph_, token.text) != before)
      fail(token, before == kMaxFields ? std::string(kTooManyFields)
                                       : std::string("field ") + describe(token) + " is defined twice");
  }

  void polygon() {
    const Token& token = now();
    const uint32_t index = whole("a polygon's number");
    expect(TokenKind::openBrace, "'{'");
    std::vector<float> corners;
    while (!is(TokenKind::closeBrace)) {
      const Place place = expect(TokenKind::open, "a corner as (x,y)").place;
      corners.push_back(number());
      expect(TokenKind::comma, "','");
      corners.push_back(number());
      expect(TokenKind::close, "')'");
      if (!isCorner(corners[corners.size() - 2], corners.back())) diagnostics_.error(place, kExpectedCorner);
    }
    ++at_;
    if (index != graph_.polygons.size())
      fail(token,
           std::string("expected polygon ") + std::to_string(graph_.polygons.size()) + ", found " + describe(token));
    if (corners.size() < 6 || corners.size() / 2 > kMaxCorners)
      fail(token, std::string("expected 3 to ") + std::to_string(kMaxCorners) + " corners, found " +
                      std::to_string(corners.size() / 2));
    if (addPolygon(graph_, corners.data(), static_cast<uint32_t>(corners.size() / 2)) == kNoPolygon)
      fail(token, "the polygon crosses itself");
  }

  void rule() {
    Rule rule;
    const std::string text(name("a rule's name").text);
    rules_.try_emplace(text, static_cast<uint32_t>(graph_.rules.size()));
    rule.name = addName(text);
    if (accept(TokenKind::open)) {
      axioms_.push_back(now());
      rule.axiom = whole("an axiom's number");
      expect(TokenKind::close, "')'");
    }
    expect(TokenKind::arrow, "'->'");
    rule.node = target();
    graph_.rules.push_back(rule);
  }

  void group(Place place) {
    GroupLine line{place, {}};
    expect(TokenKind::openBrace, "'{'");
    while (!accept(TokenKind::closeBrace)) {
      const Place nodePlace = now().place;
      line.nodes.emplace_back(nodePlace, whole("a node's number or '}'"));
    }
    if (line.nodes.empty()) diagnostics_.error(place, "a group has one node or more");
    groups_.push_back(std::move(line));
  }

  // ---------------------------------------------------------------- nodes

  void node() {
    const Token& token = now();
    if (whole("a node's number") != graph_.nodes.size())
      diagnostics_.error(token.place, std::string("expected node ") + std::to_string(graph_.nodes.size()) + ", found " +
                                          describe(token));
    // The node is kept as far as it was read: the numbers of those that follow stay right.
    Node& node = graph_.nodes.emplace_back();
    const Token& word = name("an operator or a terminal");
    node.op = kOpTerminal + 1;
    while (node.op < kOpCount && word.text != operatorName(node.op)) ++node.op;
    const bool terminal =
        !is(TokenKind::open) && terminals_.count(std::string(word.text)) != 0; // of an operator's name
    if (node.op == kOpCount || terminal) {
      node.op = kOpTerminal;
      terminalNodes_.push_back({word, static_cast<uint32_t>(graph_.nodes.size() - 1), {}});
      if (!isName("in")) return;
      ++at_;
      terminalNodes_.back().rule = name("a rule's name");
      return;
    }
    node.firstParameter = static_cast<uint32_t>(graph_.parameters.size());
    node.firstEdge = static_cast<uint32_t>(graph_.edges.size());
    arguments(node);
    if (isName("priority")) {
      ++at_;
      const Token& number = now();
      node.priority = whole("a priority");
      if (node.priority > kMaxPriority)
        diagnostics_.error(number.place, std::string("a priority is at most ") + std::to_string(kMaxPriority));
    }
    if (is(TokenKind::openBrace)) edges(node);
    node.parameterCount = static_cast<uint32_t>(graph_.parameters.size()) - node.firstParameter;
    node.edgeCount = static_cast<uint32_t>(graph_.edges.size()) - node.firstEdge;
  }

  void arguments(Node& node) {
    expect(TokenKind::open, "'('");
    bool first = true;
    const auto next = [&] {
      if (!first) expect(TokenKind::comma, "','");
      first = false;
    };
    uint32_t axes = 0;
    for (const char letter : kOperators[node.op].inParentheses()) {
      next();
      switch (letter) {
      case 'a': node.argument |= axis() << (2 * axes++); break;
      case 'm': node.argument2 = oneOf(3, repeatModeText, "ADJUST_TO_FILL, ANCHOR_TO_START or ANCHOR_TO_END"); break;
      case 't': node.argument = tag(); break;
      case 's': node.argument = oneOf(kShapeCount, shapeName, "a shape"); break;
      case 'p': node.argument2 = whole("a polygon's number"); break;
      default: parameter();
      }
    }
    expect(TokenKind::close, "')'");
  }

  uint32_t tag() {
    if (!is(TokenKind::name)) return whole("a tag: a name or a number");
    const auto [tag, isNew] = tags_.try_emplace(std::string(name("a tag").text));
    if (isNew) tag->second = kTagName | addName(tag->first);
    return tag->second;
  }

  void edges(const Node& node) {
    expect(TokenKind::openBrace, "'{'");
    do {
      if (kOperators[node.op].hasSuccessorValues()) {
        parameter();
        expect(TokenKind::colon, "':'");
      }
      const Token& token = now();
      const bool fits = is(TokenKind::number) || is(TokenKind::divided) || is(TokenKind::times) || isName("n");
      if (!fits) fail(token, std::string("expected a multiplicity: 1, n, / or *, found ") + describe(token));
      ++at_;
      multiplicities_.push_back(token);
      expect(TokenKind::arrow, "'->'");
      Edge edge;
      edge.target = target();
      graph_.edges.push_back(edge);
    } while (accept(TokenKind::bar));
    expect(TokenKind::closeBrace, "'|' or '}'");
  }

  // ---------------------------------------------------------------- values

  void parameter() {
    Value v = value();
    Parameter p{v.kind, v.words.back()};
    if (hasProgram(v.kind)) {
      v.words.push_back(kCodeEnd);
      const auto [program, isNew] = programs_.try_emplace(v.words, static_cast<uint32_t>(graph_.code.size()));
      if (isNew) graph_.code.insert(graph_.code.end(), v.words.begin(), v.words.end());
      p.value = program->second;
    }
    graph_.parameters.push_back(p);
  }

  /// Long sums are deep on their left, which is a loop here; depth is that of right sides and of calls.
  Value value(uint32_t depth = 0) {
    if (depth > 1000) fail(now(), "these parentheses are too deep");
    uint32_t opened = 0;
    while (accept(TokenKind::open)) ++opened;
    Value left = leaf(depth);
    for (; opened; --opened) {
      const uint32_t op = binary();
      left = close(std::move(left), op, value(depth + 1));
    }
    return left;
  }

  Value leaf(uint32_t depth) {
    if (is(TokenKind::minus) || is(TokenKind::number))
      return {{kCodeNumber, std::bit_cast<uint32_t>(number())}, kParameterConstant};
    const Token& word = expect(TokenKind::name, "a value");
    expect(TokenKind::open, "'('");
    if (word.text == "Exp") {
      Value inner = value(depth + 1);
      expect(TokenKind::close, "')'");
      return {std::move(inner.words), std::max(inner.kind, kParameterProgram)};
    }
    if (word.text == GPGP_FIELD_SPELLING) {
      const Token& field = name("a field's name");
      const auto known = std::find_if(graph_.fields.begin(), graph_.fields.end(),
                                      [&](uint32_t offset) { return graph_.nameAt(offset) == field.text; });
      if (known == graph_.fields.end()) fail(field, std::string("there is no field ") + describe(field));
      expect(TokenKind::comma, "','");
      Value x = value(depth + 1);
      expect(TokenKind::comma, "','");
      return close(std::move(x), kCodeField + static_cast<uint32_t>(known - graph_.fields.begin()), value(depth + 1));
    }
    for (const Binary& binary : kBinaries) {
      if (binary.precedence || word.text != binary.spelling) continue;
      Value left = value(depth + 1);
      expect(TokenKind::comma, "','");
      return close(std::move(left), binary.code, value(depth + 1));
    }
    const auto attribute = std::find_if(std::begin(kAttributes), std::end(kAttributes),
                                        [&](const Attribute& a) { return word.text == a.name; });
    if (attribute == std::end(kAttributes)) fail(word, std::string("expected a value, found ") + describe(word));
    uint32_t code = attribute->code;
    if (attribute->axes == 2) {
      code += 3 * axis();
      expect(TokenKind::comma, "','");
    }
    if (attribute->axes) code += axis();
    expect(TokenKind::close, "')'");
    return {{code}, code >= kCodeView ? kParameterView : kParameterAttribute};
  }

  Value close(Value left, uint32_t op, const Value& right) {
    expect(TokenKind::close, "')'");
    left.words.insert(left.words.end(), right.words.begin(), right.words.end());
    left.words.push_back(op);
    return {std::move(left.words), std::max({left.kind, right.kind, kParameterProgram})};
  }

  uint32_t binary() {
    const Token& token = now();
    for (const Binary& binary : kBinaries)
      if (binary.precedence && token.text == binary.spelling) return ++at_, binary.code;
    fail(token, std::string("expected an operator as in (1 + 2), found ") + describe(token));
  }

  // ---------------------------------------------------------------- once all is read

  void finish() {
    for (const auto& [place, node] : targets_)
      if (node >= graph_.nodes.size())
        diagnostics_.error(place, std::string("there is no node ") + std::to_string(node));
    for (const Token& axiom : axioms_)
      if (axiom.number >= static_cast<float>(axiomPlaces_.size()))
        diagnostics_.error(axiom.place, std::string("there is no axiom ") + describe(axiom));
    for (Axiom& axiom : graph_.axioms)
      if (!*graph_.nameAt(axiom.name)) axiom.name = addName(usualName(graph_, axiom));
    for (const auto& [word, n, ruleWord] : terminalNodes_) {
      const auto found = terminals_.find(std::string(word.text));
      if (found == terminals_.end()) {
        diagnostics_.error(word.place, std::string("there is no operator or terminal ") + describe(word));
        continue;
      }
      graph_.nodes[n].argument = found->second;
      graph_.nodes[n].argument2 = graph_.terminals[found->second].bucket;
      if (!ruleWord) continue;
      const auto rule = rules_.find(std::string(ruleWord->text));
      if (rule == rules_.end())
        diagnostics_.error(ruleWord->place, std::string("there is no rule ") + describe(*ruleWord));
      else
        graph_.nodes[n].rule = rule->second;
    }
  }

  void checkMultiplicities() {
    size_t next = 0;
    for (const Node& node : graph_.nodes)
      for (uint32_t e = 0; e < node.edgeCount; ++e, ++next)
        if (multiplicities_[next].text != multiplicityText(graph_, node, e))
          diagnostics_.error(multiplicities_[next].place,
                             std::string("the multiplicity of this edge of ") + operatorName(node.op) + " is " +
                                 multiplicityText(graph_, node, e) + ", found " + describe(multiplicities_[next]));
  }

  Diagnostics& diagnostics_;
  std::vector<Token> tokens_;
  size_t at_ = 0;
  Graph graph_;
  std::vector<Place> axiomPlaces_;
  std::vector<Token> axioms_; // named by rules
  std::vector<TerminalNode> terminalNodes_;
  std::vector<std::pair<Place, uint32_t>> targets_;
  std::vector<Token> multiplicities_; // by edge
  std::map<std::string, uint32_t> terminals_, rules_, tags_;
  std::map<std::vector<uint32_t>, uint32_t> programs_;
  std::vector<GroupLine> groups_;
};
} // namespace

bool isPrinted(std::string_view text) {
  Diagnostics ignored;
  const std::vector<Token> tokens = tokenize(text, ignored, true);
  const auto is = [&](size_t at, TokenKind kind) { return at < tokens.size() && tokens[at].kind == kind; };
  const size_t shape = is(2, TokenKind::colon) ? 3 : 1; // behind a name
  const bool polygon = is(shape + 1, TokenKind::open) && is(shape + 2, TokenKind::number);
  const size_t arrow = polygon ? shape + 4 : shape + 1;
  const bool target =
      is(arrow + 1, TokenKind::number) || (is(arrow + 1, TokenKind::name) && tokens[arrow + 1].text == "Discard");
  return tokens[0].text == "axiom" && is(shape, TokenKind::name) && is(arrow, TokenKind::arrow) && target &&
         !is(arrow + 2, TokenKind::semicolon);
}

std::optional<PrintedGraph> parseGraph(std::string_view text, Diagnostics& diagnostics,
                                       std::pmr::memory_resource* memory) {
  Parser parser(text, diagnostics, memory);
  auto graph = parser.takeGraph();
  if (!graph) return std::nullopt;
  auto partition = parser.partitionOf(*graph);
  if (diagnostics.hasErrors()) return std::nullopt;
  return PrintedGraph{std::move(*graph), std::move(partition)};
}

std::optional<Partition> parseGroups(std::string_view text, const Graph& graph, Diagnostics& diagnostics) {
  Parser parser(text, diagnostics, graph.nodes.get_allocator().resource());
  if (parser.hasGraph()) {
    const auto printed = parser.takeGraph();
    if (printed && printGraph(*printed) != printGraph(graph))
      diagnostics.error({},
                        "these groups are of another graph; expected those of this grammar, with the same variables");
  }
  auto partition = parser.partitionOf(graph);
  if (!partition && !diagnostics.hasErrors())
    diagnostics.error({1, 1}, "there are no groups; expected lines as: group { 0 1 2 }");
  return partition;
}

} // namespace gpgp::spawn
