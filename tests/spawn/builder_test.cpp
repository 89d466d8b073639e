// Grammars made in code: bit for bit those of the same text, and every error by the name of its place.
#include "grammars.h"
#include "host/files.h"
#include "random_grammar.h"
#include "rebuild.h"

#include <gpgp/gpgp.hpp>

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <limits>
#include <random>

extern "C" { // samples/grammar_builder.c
void buildSponge(GpgpGrammarBuilder builder);
void buildHouse(GpgpGrammarBuilder builder);
}

namespace {
using namespace gpgp;
using namespace gpgp::test;
using Messages = std::vector<std::string>;

GrammarBuilder empty() {
  auto made = GrammarBuilder::create();
  EXPECT_EQ(made.code(), GPGP_SUCCESS);
  return *std::move(made);
}

/// The messages of compiling; the words, where there are any.
Messages messagesOf(const GrammarBuilder& builder, std::vector<uint32_t>* words = nullptr,
                    const std::vector<GpgpVariable>& variables = {}) {
  Messages messages;
  auto source = init<GpgpGrammarSource>();
  source.name = "code";
  source.variables = variables.data();
  source.variableCount = static_cast<uint32_t>(variables.size());
  source.messageUserData = &messages;
  source.messageFn = [](void* user, const GpgpCompileMessage* m) {
    EXPECT_STREQ(m->file, "code");
    EXPECT_EQ(m->line + m->column, 0u);
    static_cast<Messages*>(user)->push_back((m->severity == GPGP_SEVERITY_ERROR ? "error: " : "warning: ") +
                                            std::string(m->text));
  };
  const auto blob = builder.compile(source);
  if (words && blob) {
    words->resize(blob->size() / 4);
    std::memcpy(words->data(), blob->data(), blob->size());
  }
  return messages;
}

std::vector<uint32_t> bake(const GrammarBuilder& builder, const std::vector<GpgpVariable>& variables = {}) {
  std::vector<uint32_t> words;
  for (const std::string& message : messagesOf(builder, &words, variables))
    EXPECT_NE(message.substr(0, 6), "error:") << message;
  return words;
}

GrammarBuilder rebuilt(const std::string& text) {
  spawn::Diagnostics diagnostics;
  const spawn::SyntaxTree tree = spawn::parse(text, diagnostics);
  EXPECT_FALSE(diagnostics.hasErrors());
  GrammarBuilder builder = empty();
  Rebuild(tree, builder);
  return builder;
}

std::string sample(const std::string& name) { return host::readText(GPGP_SAMPLE_GRAMMARS "/" + name); }

// ---------------------------------------------------------------- the same as text

TEST(GrammarBuilder, MakesEveryGrammarAsItsTextDoes) {
  size_t grammars = 0;
  for (const char* folder : {GPGP_SAMPLE_GRAMMARS, GPGP_TEST_DATA "/grammars", GPGP_SHARED_DATA "/grammars"}) {
    if (!std::filesystem::is_directory(folder)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() != ".pga") continue;
      const std::string text = host::readText(entry.path());
      EXPECT_EQ(bake(rebuilt(text)), test::bake(text)) << entry.path();
      ++grammars;
    }
  }
  EXPECT_GE(grammars, 17u);
}

TEST(GrammarBuilder, MakesRandomGrammarsAsTheirTextDoes) {
  for (uint32_t seed = 0; seed < 500; ++seed) {
    const std::string text = randomGrammar(seed);
    const GrammarBuilder builder = rebuilt(text);
    ASSERT_EQ(bake(builder), test::bake(text)) << text;
    const std::vector<GpgpVariable> set{{"v", 7.5f}}; // the same builder, with a variable set
    ASSERT_EQ(bake(builder, set), test::bake(text, set)) << text;
  }
}

TEST(GrammarBuilder, TheSamplesInCAreTheirText) {
  GrammarBuilder sponge = empty(), house = empty();
  buildSponge(sponge);
  buildHouse(house);
  EXPECT_EQ(bake(sponge), test::bake(sample("menger_sponge_3.pga")));
  EXPECT_EQ(bake(house), test::bake(sample("simple_house.pga")));
  EXPECT_EQ(messagesOf(sponge), Messages{});
  EXPECT_EQ(messagesOf(house), Messages{});
  EXPECT_EQ(bake(house, {{"tile", 2}}), test::bake(sample("simple_house.pga"), {{"tile", 2}}));
}

TEST(GrammarBuilder, EveryOperatorAndValueOfTheWrapperIsThatOfTheLanguage) {
  GrammarBuilder g = empty();
  const auto v = g.variable("v", 3), w = g.variable("w", v * 2);
  g.axiom(GPGP_SHAPE_DYNAMIC_POLYGON, {g.corner(-0.5, -0.5), g.corner(v / 6, -0.5), g.corner(0, 0), g.corner(0, 0.5)},
          "A");
  g.terminal("T U", 1, 3).terminal("V", 0, 16777216);
  g.rule("A", g.extrude(v, g.subDiv(Axis::x, {{-1, "B"}, {w * 0.5f, g.discard()}, {1, g.generate()}})));
  g.rule("B",
         g.translate(g.random(1, v), -g.shapeSize(Axis::y) + 0, g.shapePos(Axis::z),
                     g.rotate(0, 90, g.shapeRotation(Axis::y, Axis::z), g.scale(-1, g.shapeNormal(Axis::x), w, "C"))));
  g.rule("C", g.swapSize(Axis::y, Axis::x, Axis::z, g.compSplit(g.compSplit("T"), "U", "D")));
  g.rule("D", g.ifElse((g.shapeSeed() < 0.5 && v >= 1) || g.shapeCustomAttribute() == 2,
                       g.repeat(Axis::y, 1, "E", GPGP_VALUE_ANCHOR_TO_END), g.ifSizeLess(Axis::z, 0.25, "E", "V")));
  g.rule("E", g.randomRule(g.shapeSeed() + 0, {{1, "F"}, {w, g.replicate({"F", "T", g.discard()})}}));
  g.rule("F", g.setAsDynamic(GPGP_OPERATOR_SET_AS_DYNAMIC_CONVEX_RIGHT_PRISM,
                             {g.corner(-0.5, -0.5), g.corner(0.5, -0.5), g.corner(0, 0.5)},
                             g.repeat(Axis::x, -0.5, g.repeat(Axis::z, 2, "T", GPGP_VALUE_ANCHOR_TO_START))));
  EXPECT_EQ(bake(g),
            test::bake("var v = 3; var w = v * 2;"
                       "axiom DynamicPolygon { (-0.5,-0.5), (v/6,-0.5), (0,0), (0,0.5) } A;"
                       "terminal T U (1,3); terminal V (0,16777216);"
                       "A = Extrude(v) SubDiv(X) { -1: B | w*0.5: Discard() | 1: Generate() };"
                       "B = Translate(Rand(1,v), 0-ShapeSize(Y)+0, ShapePos(Z)) Rotate(0,90,ShapeRotation(Y,Z))"
                       "    Scale(-1,ShapeNormal(X),w) C;"
                       "C = SwapSize(Y,X,Z) CompSplit() { CompSplit() T | U | D };"
                       "D = If((ShapeSeed() < 0.5 && v >= 1) || ShapeCustomAttribute() == 2) {"
                       "    Repeat(Y,1,ANCHOR_TO_END) E | IfSizeLess(Z,0.25) { E | V } };"
                       "E = RandomRule(ShapeSeed()+0) { 1: F | w: Replicate() { F | T | Discard() } };"
                       "F = SetAsDynamicConvexRightPrism((-0.5,-0.5),(0.5,-0.5),(0,0.5))"
                       "    Repeat(X,-0.5,ADJUST_TO_FILL) Repeat(Z,2,ANCHOR_TO_START) T;"));
}

TEST(GrammarBuilder, GivesTheKernelThatTextGives) {
  GrammarBuilder sponge = empty();
  buildSponge(sponge);
  auto source = init<GpgpGrammarSource>();
  source.flags = GPGP_COMPILE_KERNEL;
  const auto code = sponge.compile(source);
  const std::string file = sample("menger_sponge_3.pga");
  source.text = file.data();
  source.size = file.size();
  const auto text = compileGrammar(source);
  ASSERT_TRUE(code && text);
  ASSERT_EQ(code->size(), text->size());
  EXPECT_EQ(std::memcmp(code->data(), text->data(), text->size()), 0);
}

// ---------------------------------------------------------------- errors

TEST(GrammarBuilder, ReportsEveryErrorByTheNameOfItsPlace) {
  GrammarBuilder g = empty();
  g.axiom(GPGP_SHAPE_BOX, "Start").terminal("Wall", 1, 0);
  g.variable("h", g.shapeSize(Axis::x));
  g.rule("Start", g.replicate({"Wall", g.subDiv(Axis::x, {"Wall", {g.random(0, 1), "Nowhere"}})}));
  const GpgpGrammarValue values[] = {{GPGP_VALUE_X, 0}, {GPGP_VALUE_NONE, 0}};
  const GpgpGrammarSuccessor to[] = {{{GPGP_VALUE_NUMBER, 1}, "Wall", 0}, {{GPGP_VALUE_NONE, 0}, nullptr, 0}};
  gpgpAddRule(g, "Short", nullptr, gpgpAddOperator(g, GPGP_OPERATOR_TRANSLATE, values, 2, to, 1));
  gpgpAddRule(g, "Both", nullptr, gpgpAddOperator(g, GPGP_OPERATOR_SCALE, values, 2, to + 1, 1));
  gpgpAddRule(g, "Axis", nullptr, gpgpAddOperator(g, GPGP_OPERATOR_SUB_DIV, values + 1, 1, to, 1));
  gpgpAddRule(g, "Split", nullptr, gpgpAddOperator(g, GPGP_OPERATOR_COMP_SPLIT, nullptr, 0, to, 2));
  g.rule("Wall", "Start");
  g.terminal("Odd", 2, 20000000);
  g.terminal("a-b", 1, 0);
  const GpgpGrammarOperator shared = g.discard().id;
  g.rule("One", g.extrude(std::numeric_limits<float>::infinity(), GrammarOperator{shared}));
  g.rule("Two", g.extrude(1, GrammarOperator{shared}));
  g.rule("Far", GrammarOperator{99});
  gpgpAddRule(g, "None", nullptr, 0);
  gpgpAddRule(g, "2 words", "Wall", 0);
  gpgpAddRule(g, nullptr, "Wall", 0);
  gpgpAddRule(g, "Null", nullptr, gpgpAddOperator(g, GPGP_OPERATOR_ROTATE, nullptr, 3, nullptr, 0));
  gpgpAddRule(g, "Kind", nullptr, gpgpAddOperator(g, 77, nullptr, 0, nullptr, 0));
  g.rule("Foreign", g.extrude(GrammarValue({70000, 0}, g), "Wall"));
  gpgpAddExpression(g, 50, values[0], values[0]);
  g.variable("X", 1);
  g.priority("Nobody", 1).priority("One", 65536).priority("Two", 65535);
  EXPECT_EQ(
      messagesOf(g),
      (Messages{
          "error: gpgpAddTerminal: 'a-b' is not a name; expected letters, digits and _",
          "error: gpgpAddTerminal: names has no name",
          "error: gpgpAddRule: '2 words' is not a name; expected letters, digits and _",
          "error: gpgpAddRule: the name is NULL",
          "error: gpgpAddExpression: there is no kind of expression 50",
          "error: gpgpAddVariable: 'X' has a meaning of its own; expected another name",
          "error: var 'h', its value: a var must not depend on the shape",
          "error: rule 'Start', Replicate, successor 2, SubDiv, successor 1: expected a value before the successor of "
          "SubDiv",
          "error: rule 'Start', Replicate, successor 2, SubDiv, successor 2: there is no rule or terminal 'Nowhere'",
          "error: rule 'Short', Translate: Translate takes 3 arguments, found 2",
          "error: rule 'Short', Translate, value 2: expected a value, found none",
          "error: rule 'Short', Translate, its value: Translate takes successors without a value before them",
          "error: rule 'Both', Scale: Scale takes 3 arguments, found 2",
          "error: rule 'Both', Scale, value 2: expected a value, found none",
          "error: rule 'Both', Scale: expected a name or an operator, found neither",
          "error: rule 'Axis', SubDiv, value 1: expected a value, found none",
          "error: rule 'Axis', SubDiv, value 1: expected an axis: X, Y or Z",
          "error: rule 'Split', CompSplit: CompSplit takes 3 successors (top | bottom | sides), found 2",
          "error: rule 'Split', CompSplit, successor 1, its value: CompSplit takes successors without a value before "
          "them",
          "error: rule 'Split', CompSplit, successor 2: expected a name or an operator, found neither",
          "error: rule 'Wall': 'Wall' is defined twice; the first time in terminal 'Wall'",
          "error: terminal 'Odd', its kind: a terminal's kind is 0 (triangles) or 1 (an instanced mesh)",
          "error: terminal 'Odd', its index: a terminal's index is a whole number from 0",
          "error: rule 'One', Extrude, value 1: this number is not finite",
          "error: rule 'Two', Extrude, Discard: this operator is already used elsewhere; to share it, make it a rule",
          "error: rule 'Far': there is no operator 99 in this builder",
          "error: rule 'None': expected a name or an operator, found neither",
          "error: rule 'Null', Rotate: values is NULL, valueCount is 3",
          "error: rule 'Kind', an operator: there is no kind of operator 77",
          "error: rule 'Foreign', Extrude, value 1: there is no value 70000 in this builder",
          "error: priority of 'Nobody': there is no rule 'Nobody'",
          "error: priority of 'One': a priority is at most 65535, found 65536",
      }));
}

TEST(GrammarBuilder, WarnsOfWhatHasNoUse) {
  GrammarBuilder g = empty();
  g.axiom(GPGP_SHAPE_BOX, "A").terminal("T", 1, 0).rule("A", g.extrude(1, "T")).rule("B", "T");
  g.scale(1, 1, 1, "T");
  EXPECT_EQ(messagesOf(g), (Messages{"warning: operator 2 (Scale) is used nowhere",
                                     "warning: rule 'A', Extrude: Extrude has no effect here: only Box arrives",
                                     "warning: rule 'B': rule 'B' is never used"}));
}

TEST(GrammarBuilder, AnAxiomIsNeededAndItsShapeMustExist) {
  GrammarBuilder g = empty();
  EXPECT_EQ(messagesOf(g), Messages{"error: there is no axiom; expected gpgpAddAxiom"});
  g.terminal("T", 1, 0).axiom(GPGP_SHAPE_BOX, "T").axiom(GPGP_SHAPE_QUAD, "T"); // as many as are wanted
  EXPECT_EQ(messagesOf(g), Messages{});
  Messages errors;
  const auto expectMore = [&](const char* message) {
    errors.push_back(std::string("error: axiom") + message);
    EXPECT_EQ(messagesOf(g), errors);
  };
  g.axiom(40, "T");
  expectMore(": there is no shape 40; expected a GpgpShape");
  g.axiom(GPGP_SHAPE_BOX, "U");
  expectMore(": there is no rule or terminal 'U'");
  g.axiom(GPGP_SHAPE_BOX, {g.corner(0, 0)}, "T");
  expectMore(", corner 1: only Dynamic... shapes have corners of their own");
  const GpgpGrammarValue number = GPGP_GRAMMAR_NUMBER(1);
  gpgpAddAxiom(g, GPGP_SHAPE_DYNAMIC_POLYGON, &number, 1, "T");
  expectMore(", corner 1: expected a corner as (x, y)");
  g.axiom(GPGP_SHAPE_DYNAMIC_POLYGON, {g.corner(0, 0.5), g.corner(-0.5, -0.75), g.corner(0.5, 0)}, "T");
  expectMore(", corner 2: x and y of a corner are from -0.5 to 0.5");
}

TEST(GrammarBuilder, VariablesThatAreSetMustExist) {
  GrammarBuilder g = empty();
  g.terminal("T", 1, 0).axiom(GPGP_SHAPE_BOX, "T");
  EXPECT_EQ(messagesOf(g, nullptr, {{"k", 1}}), Messages{"error: there is no var 'k' that could be set"});
}

TEST(GrammarBuilder, DepthAndSizeAreBounded) {
  GrammarBuilder g = empty();
  g.axiom(GPGP_SHAPE_BOX, "A").terminal("T", 1, 0);
  GrammarSuccessor to = "T";
  for (int i = 0; i < 200; ++i) to = g.translate(1, 0, 0, to);
  g.rule("A", to);
  EXPECT_EQ(messagesOf(g), Messages{});
  GrammarBuilder deep = empty();
  deep.axiom(GPGP_SHAPE_BOX, "A").terminal("T", 1, 0);
  to = "T";
  for (int i = 0; i < 100000; ++i) to = deep.translate(1, 0, 0, to);
  deep.rule("A", to);
  const Messages messages = messagesOf(deep);
  ASSERT_FALSE(messages.empty());
  EXPECT_EQ(
      std::count(messages.begin(), messages.end(), "error: rule 'A', Translate: this is nested more than 200 deep"), 1);
  for (const uint32_t count : {200u, 201u, 50000u}) { // each is added before what it leads to
    GrammarBuilder forward = empty();
    forward.axiom(GPGP_SHAPE_BOX, "A").terminal("T", 1, 0);
    forward.rule("A", GrammarOperator{1});
    for (uint32_t i = 1; i < count; ++i) forward.translate(1, 0, 0, GrammarOperator{i + 1});
    forward.translate(1, 0, 0, "T");
    EXPECT_EQ(messagesOf(forward),
              count > 200 ? Messages{"error: rule 'A', Translate: this is nested more than 200 deep"} : Messages{});
  }
  GrammarBuilder circle = empty();
  circle.axiom(GPGP_SHAPE_BOX, "A").rule("A", circle.translate(1, 0, 0, GrammarOperator{1}));
  EXPECT_EQ(messagesOf(circle), Messages{"error: rule 'A', Translate, Translate: this operator is already used "
                                         "elsewhere; to share it, make it a rule"});
  GrammarBuilder wide = empty();
  wide.axiom(GPGP_SHAPE_BOX, "A").terminal("T", 1, 0);
  GrammarValue sum = wide.shapeSize(Axis::x);
  for (int i = 0; i < 60; ++i) sum = sum + sum; // as text: 2^60 operands
  wide.rule("A", wide.translate(sum, 0, 0, "T"));
  EXPECT_EQ(messagesOf(wide)[0],
            "error: gpgpAddExpression: the expression has more than 1024 values; expected a shorter one");
}

TEST(GrammarBuilder, ValuesAreMadeOfEarlierOnes) {
  GrammarBuilder g = empty();
  const GpgpGrammarValue first = gpgpAddTag(g, "tag");
  const GpgpGrammarValue later = {first.id + 1, 0};
  g.axiom(GPGP_SHAPE_BOX, "A").terminal("T", 1, 0);
  const GpgpGrammarValue itself = gpgpAddExpression(g, GPGP_EXPRESSION_ADD, later, GPGP_GRAMMAR_NUMBER(1));
  g.rule("A", g.extrude(GrammarValue(itself, g), "T"));
  EXPECT_EQ(messagesOf(g),
            Messages{"error: gpgpAddExpression: there is no value " + std::to_string(later.id) + " in this builder"});
}

TEST(GrammarBuilder, NumbersAreNoNamesOfTags) { // as they are none in text
  for (const char* name : {"5", "2e5"}) {
    GrammarBuilder g = empty();
    g.axiom(GPGP_SHAPE_BOX, "A").terminal("T", 1, 0);
    gpgpAddTag(g, name);
    g.rule("A", "T");
    EXPECT_EQ(messagesOf(g), Messages{std::string("error: gpgpAddTag: '") + name +
                                      "' is a number; expected a name, or a number as the tag"});
  }
}

TEST(GrammarBuilder, TakesNullAndNoOtherSource) {
  EXPECT_EQ(gpgpCreateGrammarBuilder(nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  gpgpDestroyGrammarBuilder(nullptr);
  gpgpAddRule(nullptr, "A", "B", 0);
  gpgpAddTerminal(nullptr, "A", 0, 0);
  gpgpAddAxiom(nullptr, GPGP_SHAPE_BOX, nullptr, 0, "A");
  EXPECT_EQ(gpgpAddOperator(nullptr, GPGP_OPERATOR_DISCARD, nullptr, 0, nullptr, 0), 0u);
  EXPECT_EQ(gpgpAddVariable(nullptr, "v", GPGP_GRAMMAR_NUMBER(1)).id, GPGP_VALUE_NONE);
  const GrammarBuilder builder = empty();
  auto source = init<GpgpGrammarSource>();
  source.text = "";
  EXPECT_EQ(builder.compile(source).code(), GPGP_ERROR_INVALID_ARGUMENT);
}

/// Any sequence of calls: an error by name, or a grammar that loads.
TEST(GrammarBuilder, SurvivesRandomCalls) {
  std::mt19937 random(1);
  const auto below = [&](uint32_t n) { return static_cast<uint32_t>(random() % n); };
  const char* names[] = {"A", "B", "C", "T", "U", "Scale", "", "a b", nullptr};
  uint32_t baked = 0, refused = 0;
  for (int run = 0; run < 4000; ++run) {
    const GrammarBuilder builder = empty();
    const uint32_t wild = run % 4 == 0 ? 9u : 5u; // most runs use names that can be
    std::vector<GpgpGrammarValue> values;
    const auto value = [&]() -> GpgpGrammarValue {
      if (below(2)) return GPGP_GRAMMAR_NUMBER(float(below(7)) / 2 - 1);
      if (!values.empty() && below(3)) return values[below(static_cast<uint32_t>(values.size()))];
      return {below(run % 4 ? 19 : 40), 0};
    };
    uint32_t operators = 0;
    gpgpAddAxiom(builder, below(run % 4 ? 12 : 20), nullptr, 0, "A");
    gpgpAddTerminal(builder, "T U", 1, 0);
    const uint32_t calls = 4 + below(12);
    for (uint32_t i = 0; i < calls; ++i) {
      if (below(3) == 0) values.push_back(gpgpAddExpression(builder, below(15), value(), value()));
      if (below(8) == 0) values.push_back(gpgpAddVariable(builder, names[below(wild)], value()));
      const GpgpOperatorKind kind = below(run % 4 ? 14 : 22);
      const auto* const op = std::find_if(std::begin(spawn::kOperators), std::end(spawn::kOperators),
                                          [&](const spawn::Operator& o) { return o.kind == kind; });
      const bool inTable = op != std::end(spawn::kOperators), corners = !inTable && kind >= 16 && kind < 20;
      const std::string letters(inTable ? op->inParentheses() : corners ? "vvv" : "");
      const uint32_t successors = !inTable ? corners : op->successors == spawn::kMany ? 2 : op->successors;
      std::vector<GpgpGrammarValue> arguments;
      for (const char letter : letters) {
        arguments.push_back(value());
        if (below(20) == 0) continue;
        if (letter == 'a') arguments.back() = {GPGP_VALUE_X + below(3), 0};
        if (letter == 'm') arguments.back() = {GPGP_VALUE_ADJUST_TO_FILL + below(3), 0};
      }
      std::vector<GpgpGrammarSuccessor> to;
      for (uint32_t s = 0; s < successors; ++s) {
        GpgpGrammarSuccessor next{};
        if (inTable && op->hasSuccessorValues()) next.value = GPGP_GRAMMAR_NUMBER(1 + below(3));
        if (operators && below(3) == 0)
          next.op = run % 4 ? operators : below(operators + 2);
        else
          next.name = run % 4 ? names[3 + below(2)] : names[below(wild)];
        to.push_back(next);
      }
      operators = gpgpAddOperator(builder, kind, arguments.data(), static_cast<uint32_t>(arguments.size()), to.data(),
                                  static_cast<uint32_t>(to.size()));
    }
    gpgpAddRule(builder, "A", nullptr, operators);
    if (below(2)) gpgpAddRule(builder, "B", "A", 0);
    std::vector<uint32_t> words;
    const Messages messages = messagesOf(builder, &words);
    if (words.empty()) {
      EXPECT_TRUE(std::any_of(messages.begin(), messages.end(), [](const auto& m) { return m[0] == 'e'; }));
      ++refused;
    } else {
      EXPECT_TRUE(spawn::load(std::as_bytes(std::span(words)), std::pmr::new_delete_resource()));
      ++baked;
    }
  }
  EXPECT_GT(baked, 100u);
  EXPECT_GT(refused, 1000u);
}

} // namespace
