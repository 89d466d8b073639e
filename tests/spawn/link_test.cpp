// Several grammars in one: each derives what it derives alone, whatever stands beside it.
#include "grammars.h"
#include "random_grammar.h"
#include "spawn/evaluator/evaluator.h"

#include <gpgp/gpgp.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <random>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using Messages = std::vector<std::string>;

spawn::Graph graphOf(const std::vector<uint32_t>& words) {
  auto graph = spawn::load(std::as_bytes(std::span(words)), std::pmr::new_delete_resource());
  if (!graph) throw std::runtime_error(graph.error().text);
  return std::move(*graph);
}
uint32_t startNamed(const spawn::Graph& graph, const std::string& name) {
  for (uint32_t i = 0; i < spawn::startCount(graph); ++i)
    if (spawn::startAt(graph, i).name == name) return i;
  throw std::runtime_error("no start " + name);
}

/// Everything in an order of its own. Buckets and terminals are counted from a grammar's first.
void normalise(std::vector<GpgpInstance>& instances, uint32_t firstBucket = 0, uint32_t firstTerminal = 0,
               uint32_t firstRule = 0) {
  for (GpgpInstance& i : instances) {
    i.bucket -= firstBucket;
    i.terminal -= firstTerminal;
    if (i.rule != GPGP_NO_RULE) i.rule -= firstRule;
  }
  std::sort(instances.begin(), instances.end(),
            [](const GpgpInstance& a, const GpgpInstance& b) { return std::memcmp(&a, &b, sizeof a) < 0; });
}
bool sameBytes(const std::vector<GpgpInstance>& a, const std::vector<GpgpInstance>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}

/// An axiom for a grammar's default and for each of its first starts.
std::vector<GpgpAxiom> axiomsOf(const spawn::Graph& graph, uint32_t seed, uint32_t firstId, float scale) {
  std::vector<GpgpAxiom> all;
  for (uint32_t i = 0; i < std::min(spawn::startCount(graph), 8u) + 1; ++i) {
    GpgpAxiom axiom = spawn::makeAxiom(scale * (7 + float(i)), scale * 9, scale * 6, seed * 31 + i, firstId + i);
    axiom.start = i ? i - 1 : GPGP_AXIOM_DEFAULT_START;
    if (i % 3 == 2) axiom.attribute = float(i) / 7;
    all.push_back(axiom);
  }
  return all;
}

/// Derives mixed axioms of all files with the linked grammar, and those of each with it alone. Returns terminals.
uint64_t expectEqualsAlone(const std::vector<GrammarFile>& files, uint32_t seed) {
  const auto words = linked(files);
  std::vector<GrammarFile> baked;
  for (const GrammarFile& file : files) baked.push_back(bakedFile(file));
  EXPECT_EQ(linked(baked), words);
  baked[0] = files[0]; // some of each
  EXPECT_EQ(linked(baked), words);
  const spawn::Graph graph = graphOf(words);
  spawn::DeriveOptions options;
  options.maxShapes = 200000;
  std::vector<GpgpAxiom> mixed;
  std::vector<spawn::Derivation> alone;
  std::vector<uint32_t> buckets{0}, terminals{0};
  uint64_t unfinished = 0, dropped = 0, colliders = 0, total = 0;
  std::vector<uint32_t> rules{0};
  uint32_t lines = 0, depth = 0;
  for (const GrammarFile& file : files) {
    const auto own = bake(file.text);
    const spawn::Graph ownGraph = graphOf(own);
    std::vector<GpgpAxiom> axioms;
    spawn::Derivation derivation;
    for (float scale = 1; scale > 0.001f; scale /= 2) { // as large as can be derived soon
      axioms = axiomsOf(ownGraph, seed, static_cast<uint32_t>(1000 * alone.size()), scale);
      derivation = spawn::derive(own, axioms, options);
      if (derivation.complete) break;
    }
    if (!derivation.complete) return 0;
    alone.push_back(std::move(derivation));
    const uint32_t ownRules = static_cast<uint32_t>(ownGraph.rules.size());
    for (GpgpAxiom& axiom : axioms) {
      const uint32_t start = axiom.start == GPGP_AXIOM_DEFAULT_START ? ownRules : axiom.start;
      axiom.start = start < ownRules ? rules.back() + start
                                     : static_cast<uint32_t>(graph.rules.size()) + lines + start - ownRules;
      EXPECT_EQ(spawn::startAt(graph, axiom.start).axiom->shape, spawn::startAt(ownGraph, start).axiom->shape);
    }
    mixed.insert(mixed.end(), axioms.begin(), axioms.end());
    rules.push_back(rules.back() + ownRules);
    lines += static_cast<uint32_t>(ownGraph.axioms.size());
    buckets.push_back(buckets.back() + ownGraph.buckets);
    terminals.push_back(terminals.back() + static_cast<uint32_t>(ownGraph.terminals.size()));
    unfinished += alone.back().unfinishedShapes;
    dropped += alone.back().droppedShapes;
    colliders += alone.back().colliders;
    total += alone.back().terminals;
    depth = std::max(depth, alone.back().depth);
  }
  EXPECT_EQ(graph.buckets, buckets.back());
  EXPECT_EQ(graph.terminals.size(), terminals.back());
  std::mt19937 random(seed);
  std::shuffle(mixed.begin(), mixed.end(), random);
  options.maxShapes = spawn::DeriveOptions{}.maxShapes;
  const spawn::Derivation together = spawn::derive(words, mixed, options);
  EXPECT_TRUE(together.complete);
  EXPECT_EQ(together.terminals, total);
  EXPECT_EQ(together.unfinishedShapes, unfinished);
  EXPECT_EQ(together.colliders, colliders);
  EXPECT_EQ(together.droppedShapes, dropped);
  EXPECT_EQ(together.depth, depth);
  for (size_t f = 0; f < files.size(); ++f) {
    std::vector<GpgpInstance> part;
    for (const GpgpInstance& i : together.instances)
      if (i.axiomId / 1000 == f) part.push_back(i);
    normalise(part, buckets[f], terminals[f], rules[f]);
    normalise(alone[f].instances);
    EXPECT_TRUE(sameBytes(part, alone[f].instances)) << files[f].name;
    for (uint32_t b = buckets[f]; b < buckets[f + 1]; ++b)
      EXPECT_EQ(together.buckets[b], alone[f].buckets[b - buckets[f]]);
  }
  return total;
}

TEST(Link, SampleGrammarsEqualEachAlone) {
  std::vector<GrammarFile> files;
  for (const std::string& name : ownGrammarNames()) files.push_back({"folder/" + name, ownGrammar(name)});
  for (const auto& entry : std::filesystem::directory_iterator(GPGP_SAMPLE_GRAMMARS))
    if (entry.path().extension() == ".pga") files.push_back({entry.path().string(), textOf(entry.path())});
  ASSERT_GT(files.size(), 10u);
  std::sort(files.begin(), files.end(), [](const GrammarFile& a, const GrammarFile& b) { return a.name < b.name; });
  EXPECT_GT(expectEqualsAlone(files, 1), 10000u);
  for (size_t i = 0; i + 1 < files.size(); ++i) expectEqualsAlone({files[i + 1], files[i]}, 2);
}

TEST(Link, RandomGrammarsEqualEachAlone) {
  uint32_t checked = 0, withColliders = 0;
  for (uint32_t seed = 0; seed < 3000; seed += 3) {
    std::vector<GrammarFile> files;
    uint32_t colliding = 0; // tags are common: grammars that have some are not as if they were alone
    for (uint32_t i = 0; i < 3; ++i) {
      const std::string text = randomGrammar(seed + i);
      const bool collides = graphOf(bake(text)).phases > 0;
      if (collides && colliding++) continue;
      files.push_back({std::string("g").append(std::to_string(i)), text});
    }
    if (expectEqualsAlone(files, seed) == 0) continue;
    withColliders += colliding > 0;
    ++checked;
    if (HasFailure()) FAIL() << seed;
  }
  EXPECT_GT(checked, 300u);
  EXPECT_GT(withColliders, 30u);
}

constexpr const char* kHouse = "axiom Box House; terminal Wall (1,3); terminal Roof (1,4);\n"
                               "House = SubDiv(Y) { -2: Wall | -1: Roof };";
constexpr const char* kTree = "var n = 2; axiom Sphere Crown; terminal Leaf Wall (1,3);\n"
                              "Crown = Repeat(X, n, ADJUST_TO_FILL) Leaf; Bole = Wall;";

TEST(Link, NamesSayWhoseTheyAre) {
  const spawn::Graph graph = graphOf(linked({{"../a b/simple-house.v2.pga", kHouse}, {"42", kTree}}));
  Messages starts, terminals;
  for (uint32_t i = 0; i < spawn::startCount(graph); ++i) {
    const spawn::Start start = spawn::startAt(graph, i);
    starts.push_back(std::string(start.name) + " " + spawn::shapeName(start.axiom->shape));
  }
  for (const spawn::Terminal& t : graph.terminals)
    terminals.push_back(std::string(graph.nameAt(t.name)) + " " + std::to_string(t.bucket));
  EXPECT_EQ(starts, (Messages{"simple_house.House Box", "_42.Crown Sphere", "_42.Bole Sphere", "simple_house Box",
                              "_42 Sphere"}));
  EXPECT_EQ(terminals, (Messages{"simple_house.Wall 0", "simple_house.Roof 1", "_42.Leaf 2", "_42.Wall 2"}));
  const spawn::Graph one = graphOf(linked({{"tree.pga", kTree}})); // names depend on no other grammar
  EXPECT_EQ(startNamed(one, "tree.Bole"), 1u);
  EXPECT_EQ(startNamed(one, "tree"), 2u);
}

TEST(Link, VariablesAreEachGrammarsOwn) {
  const GpgpVariable four{"n", 4};
  const auto words = linked({{"a.pga", kTree, {}}, {"b.pga", kTree, {four}}});
  EXPECT_EQ(words, linked({{"a.pga", kTree}, {"b.pga", replaced(kTree, "n = 2", "n = 4")}}));
  EXPECT_EQ(linkMessages({{"a.pga", kHouse, {four}}, {"b.pga", kTree, {four}}}),
            Messages{"a.pga: error: there is no var 'n' that could be set"});
}

TEST(Link, ErrorsHaveThePlaceInTheirFile) {
  EXPECT_EQ(linkMessages({{"x/a.pga", "axiom Box A;\nA = B;"}, {"b.pga", kTree}, {"x/c.pga", "axiom Box A;\n\nA = ;"}}),
            (Messages{"x/a.pga:2:5: error: there is no rule or terminal 'B'",
                      "x/c.pga:3:5: error: expected an operator, a rule or a terminal, found ';'"}));
  EXPECT_EQ(linkMessages({{"a.pga", "terminal T (1,0);"}, {"b.pga", kTree}}),
            Messages{"a.pga:1:1: error: there is no axiom; expected a line as: axiom Box Start;"});
  EXPECT_EQ(linkMessages({{"a.pga", kHouse}, {"b/a.other", kTree}}),
            Messages{"b/a.other: error: 'a' is also the name of a.pga; expected another file name, or an alias: "
                     "linked grammars are told apart by them"});
  EXPECT_EQ(
      linkMessages({{"folder/", kHouse}}),
      Messages{
          "folder/: error: this grammar has no name; expected one, such as a file name: linked grammars refer to it"});
  std::string many = "axiom Box A; A = T0;";
  for (int i = 0; i < 600; ++i) many.append("\nterminal T").append(std::to_string(i)).append(" (1,0);");
  EXPECT_EQ(linkMessages({{"a.pga", many}, {"b.pga", many}}),
            Messages{"b.pga:426:1: error: more than 1024 terminal lines"});
  // Warnings as well, and only of what has no effect anywhere.
  EXPECT_EQ(linkMessages({{"a.pga", kHouse}, {"b.pga", std::string(kHouse) + "\nB = Extrude(1) B2;\nB2 = Wall;"}}),
            (Messages{"b.pga:3:1: warning: rule 'B' is never used",
                      "b.pga:3:5: warning: Extrude has no effect here: only Box arrives"}));
}

TEST(Link, AliasesTellFilesOfOneNameApart) {
  const auto words = linked({{"a/x.pga", kHouse}, {"b/x.pga", kTree, {}, "tree"}});
  EXPECT_EQ(words, linked({{"x.pga", kHouse}, {"tree.pga", kTree}}));
  EXPECT_EQ(linkMessages({{"a/x.pga", kHouse}, {"b/y.pga", kTree, {}, "x"}}),
            Messages{"b/y.pga: error: 'x' is also the name of a/x.pga; expected another file name, or an alias: "
                     "linked grammars are told apart by them"});
  for (const char* wrong : {"two words", "42", "a.b", "é"})
    EXPECT_EQ(linkMessages({{"a/x.pga", kHouse}, {"b/x.pga", kTree, {}, wrong}}),
              Messages{std::string("b/x.pga: error: the alias '") + wrong +
                       "' is not a name; expected letters, digits and _, not only digits"});
}

TEST(Link, BakedGrammarsLinkAsTheirTextDoes) { // and in all tests of linked text above
  const GrammarFile house{"house.pga", kHouse}, tree{"tree.pga", kTree, {{"n", 4}}};
  const auto words = linked({house, tree});
  GrammarFile files[] = {bakedFile(house, GPGP_COMPILE_KERNEL), bakedFile(tree)};
  files[0].name = "out/house.pga.gpgp"; // as `gpgp bake` names it
  EXPECT_EQ(linked({files[0], files[1]}), words);
  // What is linked already is one grammar.
  std::string bytes(words.size() * 4, 0);
  std::memcpy(bytes.data(), words.data(), bytes.size());
  const spawn::Graph street = graphOf(linked({{"street.gpgp", bytes}, {"lamp.pga", kHouse}}));
  EXPECT_EQ(startNamed(street, "street.house.House"), 0u);
  EXPECT_EQ(startNamed(street, "street"), 4u);
  EXPECT_EQ(startNamed(street, "street.tree"), 5u);
  EXPECT_EQ(startNamed(street, "lamp"), 6u);
  // Alone, it is compiled again: the same bytes.
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  source.baked = bytes.data();
  source.size = bytes.size();
  const auto again = compileGrammar(source);
  ASSERT_TRUE(again);
  ASSERT_EQ(again->size(), bytes.size());
  EXPECT_EQ(std::memcmp(again->data(), bytes.data(), bytes.size()), 0);
  source.text = kHouse;
  GpgpBlob none{};
  EXPECT_EQ(gpgpCompileGrammar(&source, &none), GPGP_ERROR_INVALID_ARGUMENT);

  GrammarFile set = files[1], cut = files[1];
  set.variables = {{"n", 5}};
  cut.text.pop_back();
  EXPECT_EQ(linkMessages({files[0], set}),
            Messages{"tree.pga: error: a baked grammar has no var 'n' that could be set; they were set when it "
                     "was baked"});
  EXPECT_EQ(linkMessages({files[0], cut}),
            Messages{"tree.pga: error: not a baked grammar: its size is not one that grammars have"});
  // Kernels behind the graph are left out, but not unchecked.
  const std::string whole = files[0].text;
  const auto housed = [&](const std::string& baked) {
    files[0].text = baked;
    return linkMessages({files[0], files[1]});
  };
  std::string flipped = whole;
  flipped[flipped.size() - 9] ^= 1;
  EXPECT_EQ(housed(whole), Messages{});
  EXPECT_EQ(housed(whole.substr(0, whole.size() - 4)).size(), 1u);
  EXPECT_NE(housed(whole.substr(0, whole.size() - 4)).at(0).find("of the baked grammar: it was cut"),
            std::string::npos);
  EXPECT_NE(housed(flipped).at(0).find("its checksum is wrong"), std::string::npos);
  EXPECT_NE(housed(whole + "tail").at(0).find("the data that follows is not a kernel"), std::string::npos);
}

TEST(Link, NeedsSources) {
  GpgpBlob blob{};
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  EXPECT_EQ(gpgpLinkGrammars(&source, 0, &blob), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpLinkGrammars(nullptr, 1, &blob), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpLinkGrammars(&source, 1, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpLinkGrammars(&source, 1, &blob), GPGP_ERROR_INVALID_DATA); // no text, no name
  GpgpGrammarSource two[] = {GPGP_GRAMMAR_SOURCE_INIT, GPGP_GRAMMAR_SOURCE_INIT};
  two[1].sType = 0;
  EXPECT_EQ(gpgpLinkGrammars(two, 2, &blob), GPGP_ERROR_INVALID_STRUCT);
  EXPECT_EQ(blob.data, nullptr);
}

TEST(Link, BuildersLinkAsTextDoes) {
  GrammarBuilder tree = *GrammarBuilder::create();
  const auto n = tree.variable("n", 2);
  tree.axiom(GPGP_SHAPE_SPHERE, "Crown").axiom(GPGP_SHAPE_BOX, "Bole").terminal("Leaf Wall", 1, 3);
  tree.rule("Crown", tree.repeat(Axis::x, n, "Leaf")).rule("Bole", "Wall");
  GpgpGrammarSource sources[] = {GPGP_GRAMMAR_SOURCE_INIT, GPGP_GRAMMAR_SOURCE_INIT};
  sources[0].name = "house.pga";
  sources[0].text = kHouse;
  sources[0].size = std::strlen(kHouse);
  sources[1].name = "tree";
  sources[1].builder = tree;
  const auto blob = linkGrammars(sources, 2);
  ASSERT_TRUE(blob);
  const auto text = linked({{"house.pga", kHouse}, {"tree.pga", replaced(kTree, "Crown;", "Crown; axiom Box Bole;")}});
  ASSERT_EQ(blob->size(), text.size() * 4);
  EXPECT_EQ(std::memcmp(blob->data(), text.data(), blob->size()), 0);
}

TEST(Link, TagsAreCommon) {
  const std::string wall = "axiom Box W; terminal T (1,0); W = Collider(wall) T;";
  const std::string plant = "axiom Box P; terminal T (1,0); P = IfCollides(wall) { Discard() | T };";
  EXPECT_EQ(linkMessages({{"wall.pga", wall}, {"plant.pga", plant}}), Messages{}); // alone, both would be warned of
  EXPECT_EQ(linkMessages({{"wall.pga", wall}}),
            Messages{"wall.pga:1:36: warning: Collider(wall) has no effect: there is no IfCollides(wall)"});
  const auto words = linked({{"wall.pga", wall}, {"plant.pga", plant}});
  std::vector<GpgpAxiom> axioms(3, spawn::makeAxiom(1, 1, 1));
  axioms[0].start = axioms[2].start = startNamed(graphOf(words), "plant");
  axioms[2].transform[3] = 5;
  const auto derived = spawn::derive(words, axioms);
  EXPECT_EQ(derived.terminals, 2u); // the wall, and the plant that stands apart
  EXPECT_EQ(derived.colliders, 1u);
  const std::string circle = "axiom Box A; terminal T (1,0);\nA = IfCollides(one) { T | Scale(1,1,1) B };\n"
                             "B = Collider(two) T;";
  EXPECT_EQ(
      linkMessages({{"a.pga", circle},
                    {"b.pga", replaced(replaced(circle, "(one)", "(two)"), "Collider(two)", "Collider(one)")}}),
      (Messages{"a.pga:2:5: error: IfCollides(one) waits for all of Collider(one) in line 3 of b.pga, which comes "
                "after it",
                "b.pga:2:5: error: IfCollides(two) waits for all of Collider(two) in line 3 of a.pga, which comes "
                "after it"}));
  EXPECT_EQ(linked({bakedFile({"wall.pga", wall}), bakedFile({"plant.pga", plant})}), words);
  EXPECT_EQ(linkMessages({bakedFile({"a.pga", circle}),
                          {"b.pga", replaced(replaced(circle, "(one)", "(two)"), "Collider(two)", "Collider(one)")}}),
            (Messages{"a.pga: error: IfCollides(one) waits for all of Collider(one) in line 3 of b.pga, which comes "
                      "after it",
                      "b.pga:2:5: error: IfCollides(two) waits for all of Collider(two) in the baked grammar of a.pga, "
                      "which comes after it"}));
}

/// A start derives what the same file does with its shape and rule in the only axiom line.
TEST(Starts, EachHasItsShape) {
  const std::string lines =
      "axiom Hexagon Faces;\naxiom Box Faces;\naxiom DynamicRightPrism{(0,0.5),(-0.5,-0.5),(0.5,0)} "
      "Part;\naxiom Quad T;\n";
  const std::string rules = "terminal T (1,0); terminal U (1,1);\n"
                            "Faces = CompSplit() { T | U | Part };\nPart = SubDiv(X) { 1: Tall | -1: U };\n"
                            "Tall = Extrude(3) CompSplit() { T | Discard() | U };\n";
  const auto words = bake(lines + rules);
  const spawn::Graph graph = graphOf(words);
  const std::vector<std::string> wanted{
      "Hexagon Faces", "DynamicRightPrism{(0,0.5),(-0.5,-0.5),(0.5,0)} Part", "Hexagon Tall", "Hexagon Faces",
      "Box Faces",     "DynamicRightPrism{(0,0.5),(-0.5,-0.5),(0.5,0)} Part", "Quad T"};
  ASSERT_EQ(spawn::startCount(graph), wanted.size());
  std::vector<uint64_t> counts;
  for (uint32_t i = 0; i < wanted.size(); ++i) {
    GpgpAxiom axiom = spawn::makeAxiom(4, 3, 5, 7, 9);
    axiom.start = i;
    auto chosen = spawn::derive(words, std::span(&axiom, 1));
    axiom.start = GPGP_AXIOM_DEFAULT_START;
    auto alone =
        spawn::derive(bake(std::string("axiom ").append(wanted[i]).append(";\n").append(rules)), std::span(&axiom, 1));
    counts.push_back(chosen.terminals);
    normalise(chosen.instances);
    normalise(alone.instances);
    EXPECT_TRUE(sameBytes(chosen.instances, alone.instances)) << wanted[i];
    EXPECT_EQ(std::string(spawn::startAt(graph, i).name), wanted[i].substr(wanted[i].rfind(' ') + 1));
  }
  EXPECT_GT(counts[4], counts[3]); // a box has sides
}

} // namespace
