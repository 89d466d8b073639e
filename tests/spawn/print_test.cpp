// The printed form: print, parse, and the same graph; every error with its place.
#include "graphs.h"
#include "spawn/graph/heuristics.h"
#include "spawn/language/print.h"

#include <gtest/gtest.h>

namespace {
using namespace gpgp;
using namespace gpgp::spawn;
using namespace gpgp::test;
using Messages = std::vector<std::string>;

PrintedGraph parsed(const std::string& text) {
  Diagnostics diagnostics;
  auto printed = parseGraph(text, diagnostics, std::pmr::new_delete_resource());
  if (!printed) throw std::runtime_error(format(diagnostics.sorted().at(0), "text") + "\n" + text);
  return std::move(*printed);
}
Messages errorsOf(const std::string& text) {
  Diagnostics diagnostics;
  const auto printed = parseGraph(text, diagnostics, std::pmr::new_delete_resource());
  Messages messages;
  for (const Diagnostic& d : diagnostics.sorted()) messages.push_back(messageOf(d));
  EXPECT_EQ(printed.has_value(), messages.empty());
  return messages;
}

/// Names as text: where they lie says nothing.
std::vector<std::string> namesOf(const Graph& graph) {
  std::vector<std::string> names;
  for (const Terminal& t : graph.terminals) names.emplace_back(graph.nameAt(t.name));
  for (const Rule& r : graph.rules) names.emplace_back(graph.nameAt(r.name));
  for (const Axiom& a : graph.axioms) names.emplace_back(graph.nameAt(a.name));
  for (const Node& n : graph.nodes)
    if (isContext(n.op) && n.argument & shader::kTagName)
      names.emplace_back(graph.nameAt(n.argument & ~shader::kTagName));
  return names;
}
std::vector<uint32_t> wordsWithoutNames(Graph graph) {
  for (Terminal& t : graph.terminals) t.name = 0;
  for (Rule& r : graph.rules) r.name = 0;
  for (Axiom& a : graph.axioms) a.name = 0;
  for (Node& n : graph.nodes)
    if (isContext(n.op) && n.argument & shader::kTagName) n.argument = shader::kTagName;
  graph.names.assign({0});
  const auto words = serialize(graph, std::pmr::new_delete_resource());
  return {words.begin(), words.end()};
}
void expectSame(const Graph& a, const Graph& b) {
  EXPECT_EQ(namesOf(a), namesOf(b));
  EXPECT_EQ(wordsWithoutNames(a), wordsWithoutNames(b)); // all else, to the bit
}

TEST(Print, ReadsAsARuleSet) {
  const Graph graph =
      ofRules("A = SubDiv(X) { -1: T | 2: Translate(0,Exp(ShapeSize(Y)*1.5),0.1) A | 1: Discard() }; B = CompSplit() T;"
              "C = SetAsDynamicConvexPolygon((0,0.5),(-0.5,0),(0.5,0)) Repeat(X,Rand(1,2),ANCHOR_TO_END) U;");
  const std::string text = "axiom Box -> 0\n"
                           "terminal T (1, 0) bucket 0\n"
                           "terminal U (1, 1) bucket 1\n"
                           "polygon 12 { (0,0.5) (-0.5,0) (0.5,0) }\n"
                           "rule A -> 0\n"
                           "rule B -> 3\n"
                           "rule C -> 5\n"
                           "0 SubDiv(X) { -1: / -> 1 | 2: / -> 2 | 1: / -> Discard }\n"
                           "1 T in A\n"
                           "2 Translate(0,(ShapeSize(Y) * 1.5),0.1) { 1 -> 0 }\n"
                           "3 CompSplit() { 1 -> 4 | 1 -> 4 | n -> 4 }\n"
                           "4 T in B\n"
                           "5 SetGeometry(DynamicConvexPolygon,12) { 1 -> 6 }\n"
                           "6 Repeat(X,Rand(1,2),ANCHOR_TO_END) { * -> 7 }\n"
                           "7 U in C\n";
  EXPECT_EQ(printGraph(graph), text);
  expectSame(parsed(text).graph, graph);
  EXPECT_FALSE(parsed(text).partition);
  const auto withGroups = parsed(text + "// as a rule set\ngroup { 0 2 }\ngroup { 1 }\n");
  ASSERT_TRUE(withGroups.partition);
  EXPECT_EQ(printGroups(*withGroups.partition), "group { 0 2 }\ngroup { 1 }\n");
}

TEST(Print, ValuesKeepTheirFormAndEveryDigit) {
  const std::string text =
      "axiom DynamicPolygon(13) -> 0\n"
      "polygon 12 { (0,0.5) (-0.5,-0.33333334) (0.5,0) }\n"
      "0 Translate(0.1,Exp(2),Exp(ShapeSeed())) { 1 -> 1 }\n"
      "1 Scale(-1.2676506e+30,((1 + 2) && (ShapeRotation(X,Z) < -3)),Rand(Rand(0,1),2)) { 1 -> 2 }\n"
      "2 Replicate() { 1 -> Discard }\n";
  EXPECT_EQ(printGraph(parsed(text).graph), text);
}

TEST(Print, TagsAreNumbersAndNames) {
  const Graph graph = ofRules("A = Collider(wall) Collider(3) IfCollides(wall) { T | IfCollides(3) { T | U } };");
  const std::string text = "axiom Box -> 0\n"
                           "terminal T (1, 0) bucket 0\n"
                           "terminal U (1, 1) bucket 1\n"
                           "rule A -> 0\n"
                           "0 Collider(wall) { 1 -> 1 }\n"
                           "1 Collider(3) { 1 -> 2 }\n"
                           "2 IfCollides(wall) { / -> 3 | / -> 4 }\n"
                           "3 T in A\n"
                           "4 IfCollides(3) { / -> 3 | / -> 5 }\n"
                           "5 U in A\n";
  EXPECT_EQ(printGraph(graph), text);
  expectSame(parsed(text).graph, graph);
  EXPECT_EQ(parsed(text).graph.phases, 2u);
  EXPECT_EQ(errorsOf("axiom Box -> 0\n0 IfCollides(7) { / -> 1 | / -> Discard }\n1 Collider(7) { 1 -> 0 }\n"),
            Messages{"error: there is no order of phases in which every Collider is before each IfCollides of its "
                     "tag, and higher priorities are before lower ones"});
}

TEST(Print, PrioritiesComeBack) {
  const std::string text = "axiom Box -> 0\n"
                           "terminal T (1, 0) bucket 0\n"
                           "0 Replicate() priority 3 { 1 -> 1 | 1 -> 2 }\n"
                           "1 IfCollides(a) priority 65535 { / -> 3 | / -> 4 }\n"
                           "2 IfCollides(b) priority 1 { / -> 3 | / -> 5 }\n"
                           "3 T\n"
                           "4 Collider(b) priority 65535 { 1 -> 3 }\n"
                           "5 Collider(a) priority 1 { 1 -> 3 }\n";
  const Graph graph = parsed(text).graph;
  EXPECT_EQ(graph.phases, 2u);
  EXPECT_EQ(printGraph(graph), text);
  const auto words = serialize(graph, std::pmr::new_delete_resource());
  const auto back = load(std::as_bytes(std::span(words)), std::pmr::new_delete_resource());
  ASSERT_TRUE(back);
  EXPECT_EQ(printGraph(*back), text);
  EXPECT_EQ(errorsOf(replaced(text, "65535", "65536")), Messages{"4:26: error: a priority is at most 65535"});
}

TEST(Print, MultiplicitiesOfFacesAreThoseOfTheShapesThatArrive) {
  const auto faces = [](const std::string& axioms) {
    const std::string printed = printGraph(compiled(axioms + "terminal T (1,0); A = CompSplit() T;"));
    const Graph back = parsed(printed).graph;
    EXPECT_EQ(printGraph(back), printed);
    return printed.substr(printed.find("CompSplit"));
  };
  EXPECT_EQ(faces("axiom Box A; axiom Prism5 A;"), "CompSplit() { 1 -> 1 | 1 -> 1 | n -> 1 }\n1 T in A\n");
  EXPECT_EQ(faces("axiom Quad A;"), "CompSplit() { 1 -> 1 | 0 -> 1 | 0 -> 1 }\n1 T in A\n");
  EXPECT_EQ(faces("axiom Sphere A;"), "CompSplit() { 0 -> 1 | 0 -> 1 | 0 -> 1 }\n1 T in A\n");
  EXPECT_EQ(faces("axiom Quad A; axiom Box A;"), "CompSplit() { 1 -> 1 | / -> 1 | * -> 1 }\n1 T in A\n");
  EXPECT_EQ(faces("axiom Sphere A; axiom Box A;"), "CompSplit() { / -> 1 | / -> 1 | * -> 1 }\n1 T in A\n");
}

TEST(Print, LinkedGrammarsComeBack) {
  const auto words =
      linked({{"3.pga", "axiom Box A; axiom Quad T; terminal T (1,0); A = Translate(0.5,1.5,1e9) T;"},
              {"2e5.pga", "axiom DynamicPolygon{(0,0.5),(-0.5,0),(0.5,0)} 5; terminal 7 (1,0); 5 = 7;"}});
  const auto graph = load(std::as_bytes(std::span(words)), std::pmr::new_delete_resource());
  ASSERT_TRUE(graph);
  const std::string text = "axiom _3: Box -> 0\n"
                           "axiom _3.T: Quad -> 2\n"
                           "axiom 2e5: DynamicPolygon(12) -> 3\n"
                           "terminal _3.T (1, 0) bucket 0\n"
                           "terminal 2e5.7 (1, 0) bucket 1\n"
                           "polygon 12 { (0,0.5) (-0.5,0) (0.5,0) }\n"
                           "rule _3.A -> 0\n"
                           "rule 2e5.5(2) -> 3\n"
                           "0 Translate(0.5,1.5,1e+09) { 1 -> 1 }\n"
                           "1 _3.T in _3.A\n"
                           "2 _3.T\n"
                           "3 2e5.7 in 2e5.5\n";
  EXPECT_EQ(printGraph(*graph), text);
  expectSame(parsed(text).graph, *graph);
  EXPECT_EQ(printGraph(parsed(text).graph), text);
  EXPECT_EQ(makeFlow(*graph).starts, (std::vector<uint32_t>{0, 2, 3}));
}

TEST(Print, NamesLikeNumbersAndOperatorsComeBack) {
  const Graph graph =
      compiled("axiom Box 1; axiom Quad 2e5; terminal 2, 2e5, SetGeometry, in, 3rd (1,0);"
               "1 = SubDiv(X) { 1: 2 | 1: 2e5 | 1: SetGeometry | 1: in | 1: 3rd | 1: rule | 1: priority };"
               "rule = Collider(priority) SetGeometry; priority = IfCollides(priority) { Extrude(1) 2 | in };");
  const std::string text = printGraph(graph);
  EXPECT_EQ(text.substr(0, text.find("terminal in")), "axiom 1: Box -> 0\n"
                                                      "axiom 2e5: Quad -> 12\n"
                                                      "terminal 2 (1, 0) bucket 0\n"
                                                      "terminal 2e5 (1, 0) bucket 0\n"
                                                      "terminal SetGeometry (1, 0) bucket 0\n");
  EXPECT_NE(text.find("\n1 2 in 1\n2 2e5 in 1\n3 SetGeometry in 1\n4 in in 1\n5 3rd in 1\n"), std::string::npos)
      << text;
  expectSame(parsed(text).graph, graph);
}

TEST(Print, TheOnlyAxiomKeepsItsName) {
  const auto expectPrinted = [](const Graph& graph, const std::string& axiom) {
    const std::string text = printGraph(graph);
    EXPECT_EQ(text.substr(0, text.find('\n')), axiom);
    expectSame(parsed(text).graph, graph);
  };
  expectPrinted(compiled("axiom Box T; terminal T (1,0);"), "axiom T: Box -> 0");
  expectPrinted(compiled("axiom Box A; terminal T (1,0); A = T;"), "axiom Box -> 0"); // of the first rule there
  expectPrinted(compiled("axiom Box B; terminal T (1,0); A = T; B = A;"), "axiom B: Box -> 0");
  expectPrinted(compiled("axiom Box A; A = Discard();"), "axiom Box -> Discard");
  const auto words = linked({{"house.pga", "axiom Box A; terminal T (1,0); A = T;"}});
  expectPrinted(*load(std::as_bytes(std::span(words)), std::pmr::new_delete_resource()), "axiom house: Box -> 0");
  // Names that nobody gave are none.
  EXPECT_EQ(printGraph(parsed("axiom Box -> 0\naxiom Quad -> 0\n0 Extrude(1) { 1 -> Discard }\n").graph),
            "axiom Box -> 0\naxiom Quad -> 0\n0 Extrude(1) { 1 -> Discard }\n");
}

TEST(Print, LongSumsComeBack) { // as long as the language allows
  std::string sum = "ShapeSize(X)", nested = "ShapeSeed()";
  for (int i = 0; i < 60; ++i) sum += " + ShapePos(Y) * 2";
  for (int i = 0; i < 60; ++i) nested = std::string("Rand(").append(nested).append(", 2)");
  const Graph graph = ofRules("A = Translate(Exp(" + sum + "), " + nested + ", 0) T;");
  expectSame(parsed(printGraph(graph)).graph, graph);
  EXPECT_EQ(errorsOf("axiom Box -> 0\n0 Extrude(" + std::string(100000, '(')).size(), 1u);
  std::string calls;
  for (int i = 0; i < 100000; ++i) calls += "Exp(";
  EXPECT_EQ(errorsOf("axiom Box -> 0\n0 Extrude(" + calls).size(), 1u);
}

TEST(Print, AllGrammarsComeBack) {
  std::vector<std::string> texts{kSponge, "axiom Box A; A = Translate(1,0,0) Generate();"};
  for (const std::string& name : ownGrammarNames()) texts.push_back(ownGrammar(name));
  for (const char* name : {"menger_sponge_3.pga", "3d_tree_4_3.pga", "3d_tree_8_3.pga", "balcony.pga", "commercial.pga",
                           "mc_skyscraper.pga"})
    if (const auto text = sharedGrammar(name)) texts.push_back(*text);
  for (uint32_t seed = 0; seed < 10000; ++seed) texts.push_back(randomGrammar(seed));
  uint32_t seed = 0;
  for (const std::string& text : texts) {
    const Graph graph = compiled(text);
    const Flow flow = makeFlow(graph);
    std::mt19937 random(++seed);
    const Partition partition = makePartition(flow, seed % 4 ? randomPartition(flow, random) : coarsestPartition(flow));
    const PrintedGraph back = parsed(printGraph(graph) + printGroups(partition));
    expectSame(back.graph, graph);
    ASSERT_TRUE(back.partition);
    EXPECT_EQ(*back.partition, partition);
    Diagnostics diagnostics;
    EXPECT_EQ(parseGroups(printGroups(partition), graph, diagnostics), partition);
    if (HasFailure()) FAIL() << text;
  }
}

constexpr const char* kHead = "axiom Box -> 0\nterminal T (1, 0) bucket 0\n"; // nodes begin in line 3
constexpr const char* kNodes = "0 Replicate() { 1 -> 1 | 1 -> 2 }\n1 Translate(1,0,0) { 1 -> 2 }\n2 T\n";

struct Case {
  const char* text;
  Messages messages;
};
class PrintError : public testing::TestWithParam<Case> {};
TEST_P(PrintError, HasItsPlace) { EXPECT_EQ(errorsOf(std::string(kHead) + GetParam().text), GetParam().messages); }
INSTANTIATE_TEST_SUITE_P(
    All, PrintError,
    testing::Values(
        Case{"1 T", {"3:1: error: expected node 0, found '1'"}},
        Case{"0 Q", {"3:3: error: there is no operator or terminal 'Q'"}},
        Case{"0 T in B\nrule A -> 0", {"3:8: error: there is no rule 'B'"}},
        Case{"0 T in\n1 T", {"4:1: error: expected a rule's name, found '1'"}},
        Case{"0 Translate(1,0) { 1 -> Discard }", {"3:16: error: expected ',', found ')'"}},
        Case{"0 Translate(1,0,W) { 1 -> Discard }", {"3:18: error: expected '(', found ')'"}},
        Case{"0 Translate(1,0,0) { 1 -> 5 }", {"3:27: error: there is no node 5"}},
        Case{"0 Translate(1,0,0) { 2 -> Discard }",
             {"3:22: error: the multiplicity of this edge of Translate is 1, found '2'"}},
        Case{"0 Translate(1,0,0) { x -> Discard }", {"3:22: error: expected a multiplicity: 1, n, / or *, found 'x'"}},
        Case{"0 If((1 < 2) { / -> Discard | / -> Discard }", {"3:14: error: expected ')', found '{'"}},
        Case{"0 If((1 2)) { / -> Discard | / -> Discard }",
             {"3:9: error: expected an operator as in (1 + 2), found '2'"}},
        Case{"0 IfSizeLess(V,1) { / -> Discard | / -> Discard }",
             {"3:14: error: expected an axis: X, Y or Z, found 'V'"}},
        Case{"0 Extrude(1) { 1 -> 1 }\n1 Extrude(1) }\n2 R\n", // one error a statement, then it goes on
             {"4:14: error: expected a node's number, axiom, terminal, field, polygon, rule or group, found '}'",
              "5:3: error: there is no operator or terminal 'R'"}},
        Case{"0 Extrude(1)\n", {"error: node 0 (Extrude): wrong number of successors"}},
        Case{"0 T\naxiom Box -> 0\n", {}}, Case{"0 T\nrule A(1) -> 0\n", {"4:8: error: there is no axiom '1'"}},
        Case{"0 T\naxiom a: -> 0\n", {"4:10: error: expected a shape, found '->'"}},
        Case{"0 T\nterminal T (1, 1) bucket 1\n", {"4:10: error: terminal 'T' is defined twice"}},
        Case{"0 T\npolygon 14 { (0,0) (0.5,0) (0,0.5) }\n", {"4:9: error: expected polygon 12, found '14'"}},
        Case{"0 T\npolygon 12 { (0,0) (1,0) (0,0.5) }\n", {"4:20: error: x and y of a corner are from -0.5 to 0.5"}},
        Case{"0 T\nrule A = 1.5\n", {"4:10: error: expected a node's number or Discard, found '1.5'"}}));

class GroupError : public testing::TestWithParam<Case> {};
TEST_P(GroupError, HasItsPlace) {
  EXPECT_EQ(errorsOf(std::string(kHead) + kNodes + GetParam().text), GetParam().messages);
}
INSTANTIATE_TEST_SUITE_P(
    All, GroupError,
    testing::Values(Case{"group { 0 1 2 }", {}}, Case{"group { 0 1 }\ngroup { 2 }", {}},
                    Case{"group { 0 1 }", {"6:1: error: node 2 is in no group"}},
                    Case{"group { 0 1 7 }\ngroup { 2 }", {"6:13: error: there is no node 7"}},
                    Case{"group { 0 1 }\ngroup { 2 1 }", {"7:11: error: node 1 is already in the group of line 6"}},
                    Case{"group { 0 }\ngroup { 1 2 }",
                         {"7:11: error: condition 1: shapes enter the group at node 1 and at node 2"}},
                    Case{"group { 0 1 2 }\ngroup { }", {"7:1: error: a group has one node or more"}},
                    Case{"group 0 1 2", {"6:7: error: expected '{', found '0'"}}));

TEST(Print, GroupsOfAnotherGraphAreRefused) {
  const Graph graph = ofRules("A = Translate(1,0,0) T;"), other = ofRules("A = Translate(2,0,0) T;");
  const std::string groups = printGroups(makePartition(makeFlow(graph), coarsestPartition(makeFlow(graph))));
  Diagnostics diagnostics;
  EXPECT_TRUE(parseGroups(printGraph(graph) + groups, graph, diagnostics));
  EXPECT_FALSE(parseGroups(printGraph(other) + groups, graph, diagnostics));
  EXPECT_EQ(diagnostics.errorCount(), 1u);
  Diagnostics empty;
  EXPECT_FALSE(parseGroups("", graph, empty));
  EXPECT_EQ(empty.errorCount(), 1u);
}

TEST(Print, NumbersBeyondFloatsAreErrors) { // as a float such a number is 0
  const std::string digits(40, '9');
  EXPECT_EQ(errorsOf(std::string(kHead) + "0 T\nterminal Q (" + digits + ", 0) bucket 0"),
            (Messages{"4:13: error: the number is too large",
                      "4:13: error: expected a kind, 0 or 1, found '" + digits + "'"}));
}

TEST(Print, CutAndChangedTextNeverCrashes) {
  uint32_t accepted = 0, refused = 0;
  for (uint32_t seed = 0; seed < 300; ++seed) {
    const Graph graph = compiled(randomGrammar(seed));
    const Flow flow = makeFlow(graph);
    std::mt19937 random(seed);
    const std::string text = printGraph(graph) + printGroups(makePartition(flow, randomPartition(flow, random)));
    for (int i = 0; i < 20; ++i) {
      std::string changed = text.substr(0, i < 5 ? random() % text.size() : text.size());
      for (int c = 0; c < i % 4 && !changed.empty(); ++c)
        changed[random() % changed.size()] = "0123456789 {}(),:|->/*nXA\n"[random() % 26];
      Diagnostics diagnostics;
      const auto printed = parseGraph(changed, diagnostics, std::pmr::new_delete_resource());
      EXPECT_NE(printed.has_value(), diagnostics.hasErrors());
      if (printed) {
        EXPECT_TRUE(validate(printed->graph));
        expectSame(parsed(printGraph(printed->graph)).graph, printed->graph);
      }
      ++(printed ? accepted : refused);
    }
  }
  EXPECT_GT(accepted, 200u);
  EXPECT_GT(refused, 2000u);
}

} // namespace
