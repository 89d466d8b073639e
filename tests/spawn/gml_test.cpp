// The stack language: what programs become, their errors, and random ones against a machine without a graph.
#include "gml_plain.h"
#include "gml_random.h"
#include "grammars.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/gml/machine.h"
#include "spawn/graph/blob.h"
#include "spawn/language/print.h"
#include "spawn/shared/graph_format.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using spawn::derive;
using spawn::makeAxiom;

struct Compiled {
  spawn::Graph graph{std::pmr::new_delete_resource()};
  std::vector<std::string> messages;
};
Compiled compileOnly(const std::string& text, const std::vector<GpgpVariable>& variables = {}) {
  spawn::Diagnostics diagnostics;
  auto made = spawn::gml::compile(text, variables, diagnostics, std::pmr::new_delete_resource());
  Compiled result;
  if (!diagnostics.hasErrors()) {
    const spawn::SyntaxTree none;
    spawn::GrammarPart part{&none, &made.graph, {}, &diagnostics, {}, {}, &made.places};
    result.graph = spawn::buildGraph({&part, 1}, std::pmr::new_delete_resource());
  }
  for (const spawn::Diagnostic& d : diagnostics.sorted()) result.messages.push_back(messageOf(d));
  return result;
}
std::vector<std::string> errorsOf(const std::string& text) { return compileOnly(text).messages; }
spawn::Graph graphOf(const std::string& text) {
  Compiled made = compileOnly(text);
  std::string all;
  for (const std::string& m : made.messages) all += m + "\n";
  if (made.graph.axioms.empty()) throw std::runtime_error(all + text);
  if (auto ok = spawn::validate(made.graph); !ok) throw std::runtime_error(ok.error().text + ("\n" + text));
  return std::move(made.graph);
}
std::vector<uint32_t> bakeProgram(const std::string& text) {
  const auto words = spawn::serialize(graphOf(text), std::pmr::new_delete_resource());
  return {words.begin(), words.end()};
}
std::string sample(const std::string& name) { return textOf(GPGP_SAMPLE_PROGRAMS "/" + name); }

/// The node behind an edge.
const spawn::Node& behind(const spawn::Graph& g, const spawn::Node& node, uint32_t edge = 0) {
  return g.nodes.at(g.edges.at(node.firstEdge + edge).target);
}
// ---------------------------------------------------------------- thesis 4.3.3

using Corner = std::array<float, 2>;
/// The right side of figure 4.8: one polygon, of which an operator takes one vertex, by its selector.
struct Serialized {
  std::vector<Corner> polygon;
  void translate(size_t vertex, float x, float y) {
    polygon[vertex] = {polygon[vertex][0] + x, polygon[vertex][1] + y};
  }
  void scale(size_t vertex, float x, float y) { polygon[vertex] = {polygon[vertex][0] * x, polygon[vertex][1] * y}; }
};

TEST(StackLanguage, FigureFourEightIsAChainOfOperatorsOfOneShape) {
  const spawn::Graph g = graphOf("/Triangle axiom [ (-0.5, -0.5) (0.25, 0) translate (0.5, -0.5) (0, 0.125) translate "
                                 "(1, 0.5) scale (0, 0.5) (0.125, 0) translate ] polygon 2 extrude");
  // No operator takes several shapes: each node has one edge in, and they are one chain.
  ASSERT_EQ(g.nodes.size(), 3u);
  std::vector<int> in(g.nodes.size());
  for (const spawn::Edge& e : g.edges) ++in[e.target];
  ++in[g.axioms[0].node];
  EXPECT_EQ(in, std::vector<int>({1, 1, 1}));
  const spawn::Node& polygon = g.nodes[g.axioms[0].node];
  ASSERT_EQ(polygon.op, shader::kOpSetGeometry);
  EXPECT_EQ(behind(g, polygon).op, shader::kOpExtrude);
  EXPECT_EQ(behind(g, behind(g, polygon)).op, shader::kOpTerminal);
  // Its corners are those of the serialized program, which alters one vertex after the other.
  Serialized right{{{-0.5f, -0.5f}, {0.5f, -0.5f}, {0, 0.5f}}};
  right.translate(0, 0.25f, 0);
  right.translate(1, 0, 0.125f);
  right.scale(1, 1, 0.5f);
  right.translate(2, 0.125f, 0);
  const spawn::Polygon& made = g.polygons[polygon.argument2];
  ASSERT_EQ(made.vertexCount, 3u);
  for (uint32_t i = 0; i < 3; ++i)
    for (uint32_t c = 0; c < 2; ++c)
      EXPECT_EQ(g.vertices[2 * size_t(made.firstVertex + i) + c], right.polygon[i][c]) << i << ' ' << c;
}

TEST(StackLanguage, WhatIsLeftOnTheStackIsDrawn) {
  const spawn::Graph g = graphOf("/Box axiom dup 0 1 0 translate");
  const spawn::Node& copies = g.nodes[g.axioms[0].node];
  ASSERT_EQ(copies.op, shader::kOpReplicate);
  EXPECT_EQ(behind(g, copies, 0).op, shader::kOpTerminal);
  EXPECT_EQ(behind(g, copies, 1).op, shader::kOpTranslate);
}

TEST(StackLanguage, CopiesAreOneOperatorAndUnusedOnesAreNone) {
  const spawn::Graph g = graphOf("/T 1 0 terminal /Box axiom !s 0 1 4 { !i :s :i 0 0 translate T } for");
  const spawn::Node& copies = g.nodes[g.axioms[0].node];
  EXPECT_EQ(copies.op, shader::kOpReplicate);
  EXPECT_EQ(copies.edgeCount, 5u);
  const spawn::Graph one = graphOf("/T 1 0 terminal /Box axiom /s exch def s T");
  EXPECT_EQ(one.nodes[one.axioms[0].node].op, shader::kOpTerminal);
}

// ---------------------------------------------------------------- the same in .pga

constexpr const char* kBuildingPga = R"(
var floor = 3; axiom Box Start;
terminal Wall (1, 0); terminal Window (1, 1); terminal Roof (0, 2);
Start = Tower;
Tower = CompSplit() { Extrude(0.5) Roof | Discard() | Facade };
Facade = Repeat(Y, floor, ADJUST_TO_FILL) Repeat(X, 2, ADJUST_TO_FILL) Tile;
Tile = If(ShapeSize(X) * 2 < 4.5) { SubDiv(X) { -1: Wall | Rand(0.5, 1): Opening | -1: Wall } | Wall };
Opening = SubDiv(Y) { 1: Wall | 1.2: Pane | -1: Wall };
Pane = 20%: Wall else: Window;
)";
constexpr const char* kBuildingGml = R"(
/storeyHeight 3 var
/Wall 1 0 terminal /Window 1 1 terminal /Roof 0 2 terminal
/tower 0 { [ { 0.5 extrude Roof } { pop } { facade } ] compsplit } rule
/facade 0 { Y storeyHeight tile X 2 tile bay } rule
/bay 0 { X size 2 mul 4.5 lt { X [ -1 { Wall } 0.5 1 random { opening } -1 { Wall } ] subdiv } { Wall } ifelse } rule
/opening 0 { Y [ 1 { Wall } 1.2 { pane } -1 { Wall } ] subdiv } rule
/pane 0 { [ 20 { Wall } 80 { Window } ] choose } rule
/Box axiom tower
)";

TEST(StackLanguage, DerivesTheSameAsPgaShape) {
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < 32; ++i)
    axioms.push_back(makeAxiom(8 + static_cast<float>(i) * 0.37f, 9 + static_cast<float>(i), 12, i * 77u + 1, i));
  const auto pga = derive(bake(kBuildingPga), axioms), gml = derive(bakeProgram(kBuildingGml), axioms);
  EXPECT_GT(pga.terminals, 5000u);
  EXPECT_EQ(pga.buckets, gml.buckets);
  EXPECT_EQ(pga.keyHash[0], gml.keyHash[0]);
  EXPECT_EQ(pga.keyHash[1], gml.keyHash[1]);
  ASSERT_EQ(pga.instances.size(), gml.instances.size());
  for (size_t i = 0; i < pga.instances.size(); ++i)
    ASSERT_EQ(std::memcmp(&pga.instances[i], &gml.instances[i], sizeof(GpgpInstance)), 0) << i;
}

TEST(StackLanguage, SpongesCount) {
  EXPECT_EQ(derive(bakeProgram(sample("sponge.gml")), std::vector{makeAxiom(1, 1, 1)}).terminals, 8000u);
}

// ---------------------------------------------------------------- random programs

/// Sums of the transforms with weights, sorted: equal sets have equal lists, up to rounding.
std::vector<double> measured(std::vector<std::array<double, 12>> transforms, uint32_t seed) {
  std::mt19937 random(seed);
  std::array<double, 12> weights;
  for (double& w : weights) w = 0.5 + static_cast<double>(random()) / 4294967296.0;
  std::vector<double> result;
  for (const auto& t : transforms) {
    double sum = 0;
    for (size_t i = 0; i < 12; ++i) sum += weights[i] * t[i];
    result.push_back(sum);
  }
  std::sort(result.begin(), result.end());
  return result;
}

TEST(StackLanguage, TenThousandRandomProgramsEqualThePlainMachine) {
  uint32_t compared = 0;
  uint64_t terminals = 0;
  for (uint32_t seed = 0; seed < 10000; ++seed) {
    const std::string text = RandomProgram(seed).text();
    std::vector<PlainTerminal> plain;
    try {
      plain = PlainMachine(text, 3.17, 4.41, 2.73).run();
    } catch (const std::length_error&) {
      continue; // too large for this test
    }
    std::vector<uint32_t> words;
    ASSERT_NO_THROW(words = bakeProgram(text)) << seed << ": " << text;
    const auto derived = derive(words, std::vector{makeAxiom(3.17f, 4.41f, 2.73f)});
    ASSERT_EQ(derived.terminals, plain.size()) << seed << ": " << text;
    for (uint32_t bucket = 0; bucket < 3; ++bucket) {
      std::vector<std::array<double, 12>> a, b;
      for (const PlainTerminal& t : plain)
        if (t.name[1] == static_cast<char>('0' + bucket)) a.push_back(t.transform);
      for (const GpgpInstance& i : derived.instances)
        if (i.bucket == bucket) {
          auto& to = b.emplace_back();
          std::copy(i.transform, i.transform + 12, to.begin());
        }
      ASSERT_EQ(a.size(), b.size()) << seed << ": " << text;
      for (uint32_t projection = 0; projection < 2; ++projection) {
        const auto x = measured(a, projection), y = measured(b, projection);
        for (size_t i = 0; i < x.size(); ++i)
          ASSERT_NEAR(x[i], y[i], 2e-3 + 1e-5 * std::abs(x[i])) << seed << ": " << text;
      }
    }
    ++compared;
    terminals += plain.size();
  }
  EXPECT_GT(compared, 9000u);
  EXPECT_GT(terminals, 50000u);
}

// ---------------------------------------------------------------- errors

TEST(StackLanguage, AllErrorsHaveTheirPlaceAndSuggestions) {
  const auto errors = errorsOf("/Wall 1 0 terminal\n/Box axiom 1 2 translte\n/hight 3 def heigth\n{ 1 (2,a) } pop\n"
                               "1 [ 2 ] add pop\n\"open\n5 }\n");
  const std::vector<std::string> expected = {
      "2:16: error: there is no operator or definition 'translte'; did you mean 'translate'?",
      "3:14: error: there is no operator or definition 'heigth'; did you mean 'hight'?",
      "4:8: error: 'a' is not a number; expected (x, y) or (x, y, z) with numbers; 'vector2' and 'vector3' make "
      "vectors from the stack",
      "5:9: error: add takes two numbers or two vectors of the same size, found a number and an array",
      "6:1: error: this string has no '\"' at its end; expected one in the same line",
      "7:3: error: this '}' has no '{'"};
  EXPECT_EQ(errors, expected);
}

struct Refusal {
  const char* text;
  const char* message;
};
TEST(StackLanguage, RefusalsNameWhatAndWhere) {
  constexpr Refusal kRefusals[] = {
      {"1 2 add", "1:1: error: there is no axiom; expected one as: /Box axiom"},
      {"/Box axiom 1 2 translate",
       "1:16: error: translate takes a shape, a number, a number and a number, but the stack holds 3 values"},
      {"translate",
       "1:1: error: translate takes a shape, a number, a number and a number, but the stack holds nothing; "
       "'/Box axiom' pushes the shape that a program starts with"},
      {"/Bx axiom", "1:5: error: there is no shape 'Bx'; expected /Triangle"},
      {"/Box axiom 1 0 div pop", "1:16: error: this divides by 0"},
      {"/Box axiom Y size !h 1 2 3 scale 0 :h 0 translate",
       "1:41: error: this takes a number that was read in line 1 from another shape"},
      {"/Box axiom 0 1 random !r :r 0 0 translate :r 0 0 translate",
       "1:50: error: the random number of line 1 is taken by a second operator"},
      {"/Box axiom dup Y size 3 lt { exch pop } { } ifelse", "1:35: error: this shape comes from outside the branch"},
      {"/Box axiom Y size 3 lt { pop } { } ifelse",
       "1:36: error: one branch leaves 0 values on the stack, the other 1"},
      {"/Box axiom { Y size 3 lt { exit } if } loop", "1:28: error: 'exit' depends on a shape"},
      {"/Box axiom /h 1 def Y size 3 lt { /h 2 def } if h pop",
       "1:49: error: a branch that depends on a shape stored something else in 'h'"},
      {"/Box axiom 1 !h Y size 3 lt { 2 !h } if :h pop",
       "1:41: error: a branch that depends on a shape stored something else in 'h'"},
      {"exit /Box axiom", "1:1: error: 'exit' outside of a loop"},
      {"/Box axiom 1 2 ]", "1:16: error: this ']' has no '['"},
      {"/Box axiom [ 1", "1:14: error: '[' without ']'"},
      {"/Box axiom 5 index", "1:14: error: index takes 6 values, but the stack holds 1"},
      {"/Box axiom /add 3 def", "1:19: error: 'add' is an operator; expected another name to define"},
      {"/Box axiom :x pop", "1:12: error: nothing was stored in 'x' by '!x'"},
      {"/Box axiom [ (0,0) (0.6,0) (0,0.5) ] polygon", "1:38: error: x and y of a corner are from -0.5 to 0.5"},
      {"/Box axiom [ (0,0) (0.5,0.5) (0.5,0) (0,0.5) ] polygon", "1:48: error: the polygon has no area"},
      {"/Box axiom [ (0,0) (0.5,0.4) (0.5,0) (0,0.3) ] polygon", "1:48: error: the polygon crosses itself"},
      {"/r 0 { r } rule /Box axiom r", "1:12: error: rule 'r' leads back to itself without any operator"},
      {"/r 1 { pop pop } rule /Box axiom X size r", "1:41: error: a rule takes known numbers, names and strings"},
      {"{ /Box axiom", "1:1: error: this '{' has no '}'"},
      {"/Box axiom 1e39 pop", "1:12: error: this is too large"},
      {"/f { 1 add } def /Box axiom\nf", "1:8: error: add takes two numbers or two vectors of the same size, found a "
                                         "shape and a number (called in line 2)"},
  };
  for (const Refusal& refusal : kRefusals) {
    const auto errors = errorsOf(refusal.text);
    ASSERT_FALSE(errors.empty()) << refusal.text;
    EXPECT_EQ(errors[0].substr(0, std::string(refusal.message).size()), refusal.message) << refusal.text;
    EXPECT_EQ(std::count_if(errors.begin(), errors.end(),
                            [](const std::string& e) { return e.find(": error: ") != std::string::npos; }),
              1)
        << refusal.text << errors.back();
  }
}

TEST(StackLanguage, HostileProgramsEnd) {
  constexpr Refusal kRefusals[] = {
      {"/Box axiom { } loop", "does not end within 2000000 steps"},
      {"/Box axiom { dup } loop", "the stack holds more than 16384 values"},
      {"/f { f } def /Box axiom f", "procedures run each other more than 200 deep"},
      {"/Box axiom { 1 } 1e30 exch repeat", "the stack holds more than 16384 values"},
      {"/Box axiom 1e30 { } repeat", "does not end within"},
      {"/Box axiom 0 1e-9 1 { pop } for", "does not end within"},
      {"/r 1 { 1 add r } rule /Box axiom 0 r", "different arguments"},
      {"/Box axiom [ 1 ] { dup concat } loop", "an array holds more than 65536 values"},
      {"/Box axiom [ ] { [ exch ] } loop", "arrays nest more than 32 deep"},
      {"/Box axiom 1 { dup pop 1 0 0 translate } loop", "translate takes a shape"},
      {"/Box axiom { 1 0 0 translate } loop", "makes more than 65536 operators"},
      {"/Box axiom X size { dup mul } loop", "is made of more than 256 others"},
      {"/Box axiom { Y size 3 lt { 0 1 0 translate } { 1 0 0 translate } ifelse } loop", "more than 65536 operators"},
      {"/f { Y size 3 lt { f } { f } ifelse } def /Box axiom f", "deep"},
  };
  for (const Refusal& refusal : kRefusals) {
    const auto errors = errorsOf(refusal.text);
    const bool found = std::any_of(errors.begin(), errors.end(),
                                   [&](const std::string& e) { return e.find(refusal.message) != std::string::npos; });
    EXPECT_TRUE(found) << refusal.text << ": " << (errors.empty() ? "nothing" : errors[0]);
  }
  EXPECT_FALSE(errorsOf(std::string(100000, '{')).empty());
  EXPECT_FALSE(errorsOf(std::string(100000, '[')).empty());
  EXPECT_FALSE(errorsOf(std::string(1000, '(')).empty());
}

// ---------------------------------------------------------------- the whole, through the C functions

TEST(StackLanguage, VariablesAndLinking) {
  const auto linkedWords = linked({{"a.gml", sample("stair.gml")}, {"b.gml", sample("stair.gml"), {{"steps", 7}}}},
                                  GPGP_COMPILE_STACK_LANGUAGE);
  std::vector<GpgpAxiom> axioms{makeAxiom(4, 6, 4)};
  EXPECT_EQ(derive(linkedWords, axioms).terminals, 1u + 3 * 30);
  EXPECT_EQ(derive(bakeProgram(sample("stair.gml")), axioms).terminals, 1u + 3 * 30);
  const auto wrong = compileOnly(sample("stair.gml"), {{"step", 7}}).messages;
  ASSERT_FALSE(wrong.empty());
  EXPECT_EQ(wrong[0], "error: there is no var 'step' that could be set; did you mean 'steps'?");
}

TEST(StackLanguage, SamplesCompileWithoutMessages) {
  for (const auto& entry : std::filesystem::directory_iterator(GPGP_SAMPLE_PROGRAMS)) {
    const Compiled made = compileOnly(textOf(entry.path().string()));
    EXPECT_EQ(made.messages, std::vector<std::string>()) << entry.path();
    EXPECT_FALSE(made.graph.nodes.empty()) << entry.path();
  }
}

TEST(StackLanguage, PrintedGraphsComeBack) {
  for (const auto& entry : std::filesystem::directory_iterator(GPGP_SAMPLE_PROGRAMS)) {
    const spawn::Graph graph = graphOf(textOf(entry.path().string()));
    const std::string text = spawn::printGraph(graph);
    spawn::Diagnostics diagnostics;
    ASSERT_TRUE(spawn::isPrinted(text));
    const auto again = spawn::parseGraph(text, diagnostics, std::pmr::new_delete_resource());
    ASSERT_TRUE(again) << entry.path();
    EXPECT_EQ(spawn::printGraph(again->graph), text) << entry.path();
  }
}
} // namespace
