// .cga files that derive on the GPU: their operator graphs against the CPU evaluator of .cga files, another
// implementation of the same language over general meshes. Sets are compared by path keys: each terminal with its own.
#include "cga_graphs.h"
#include "spawn/schedule/fields.h"
#include "spawn_device.h"

namespace gpgp::spawn::cga {
namespace {

Lots someLots(uint32_t seed) {
  Lots lots;
  lots.add(10, 20, seed);
  lots.add(7.5f, 6.25f, seed + 1);
  lots.add(3, 14.2f, seed + 77);
  return lots;
}

/// The graph's terminals by the CPU evaluator of graphs, which the GPU equals.
void expectSame(const std::string& text, const Lots& lots, double& worst,
                const std::map<std::string, std::string>& files = {}) {
  SCOPED_TRACE(text);
  const WithGraph made = withGraph(text, files);
  ASSERT_TRUE(made.program) << made.messages;
  ASSERT_FALSE(made.words.empty()) << made.program->graph.why << " " << made.program->graph.place.line;
  SCOPED_TRACE(made.program->graph.text);
  const Derivation cpu = onTheCpu(*made.program, lots.lots);
  const spawn::Derivation graph = spawn::derive(made.words, lots.axioms);
  EXPECT_EQ(graph.droppedShapes, 0u);
  EXPECT_EQ(difference(cpu, graph.instances, made.program->graph, worst), "");
}
void expectSame(const std::string& text) {
  double worst = 0;
  expectSame(text, someLots(5), worst);
}

TEST(CgaGraphs, OperationsAreTheSame) {
  for (const char* text : {
           "Lot --> A",
           "Lot --> color(\"#ff0000\") t(1, 2, '0.5) s('0.5, '1, 3) r(0, 30, 0)",
           "Lot --> s(4, 0, '0.3) center(xz) A",
           "Lot --> t(2, 0, 1) center(xz) s('0.5, '1, '0.25) center(xz) A",
           "Lot --> extrude(5) comp(f) { top: A | side: B | bottom: C }",
           "Lot --> extrude(world.y, rand(3, 9)) comp(f) { front: A | left: B | 5: C | all: NIL }",
           "Lot --> extrude(3) comp(f) { object.left: r(0, 10, 0) extrude(rand(1, 2)) comp(f) { all: Q } | world.up: T "
           "}",
           "Lot --> split(x) { 1: A | ~1: B | '0.2: C | ~2: D }",
           "Lot --> split(x) { ~2.1: A }*",
           "Lot --> split(z) { 1: A | { ~1.3: B | 0.2: C }* | 1: A }",
           "Lot --> split(x) { 2: A }*",
           "Lot --> split(x) { 0.5: A | { 2: B | 0.25: C }* }",
           "Lot --> split(x) { rand(1, 3): A | ~rand(1, 2): B | 'rand(0.1, 0.2): C }",
           "Lot --> [ t(0, rand(5), 0) A ] B C. color(\"#00ff00\") D",
           "Lot --> case rand(1) < 0.5: A else: 50%: B 25%: C else: r(0, rand(90), 0) D",
           "attr h = rand(2, 9)\nattr c = 20%: \"#ff0000\" 30%: \"#00ff00\" else: \"#0000ff\"\nLot --> extrude(h) "
           "color(c) split(y) { ~(h / 3): A(h * 2) }*\n"
           "A(x) --> case x > 10: B else: C",
           "attr n = case p(0.5): floor(rand(1, 5)) else: 3\nLot --> extrude(n * 3) split(y) { ~3: Floor(n) "
           "}*\nFloor(k) --> report(\"k\", k) report(\"area\", geometry.area)",
           "Lot --> F(4)\nF(n) --> case n > 0: [ t(0, n, 0) A(n) ] F(n - 1) else: End\nA(n) --> extrude(n) X",
           "Lot --> split(x) { 3: A | ~1: Lot }",
           "Lot --> extrude(4) s('1, '1, '0.5) primitiveCube() A",
           "Lot --> extrude(4) split(y) { 1: primitiveCylinder(8) Drum | ~1: t(1, 1, 1) i(\"builtin:sphere\") s(1, 1, "
           "1) Ball }",
           "attr w = 2\nLot --> set(w, 3) A\nA --> split(x) { w: B | ~1: C }\nB --> extrude(w)",
           "Lot --> split(x) { ~1: 30%: color(pick) A else: B }*\npick = 20%: \"#b03030\" 20%: \"#2f5f9f\" else: "
           "\"#7a8a6a\"",
           "Lot --> extrude(2) comp(f) { side: W(scope.sx) | top: W(scope.sy) }\nW(x) --> case x > 12: P else: "
           "split(x) { '0.3: Q(x) | ~1: R }",
       })
    expectSame(text);
}

/// Heights of hills over x and z from -60 to 300.
struct Hills {
  std::vector<float> values;
  GpgpSpawnField field{};
  Hills() {
    for (int z = 0; z < 73; ++z)
      for (int x = 0; x < 73; ++x)
        values.push_back(4 + 3 * std::sin(0.31f * static_cast<float>(x)) * std::cos(0.23f * static_cast<float>(z)));
    field.name = "hills";
    field.grid = {values.data(), 73, 73, {-60, -60}, {300, 300}};
  }
};

TEST(CgaGraphs, FieldsAreTheSame) {
  const Hills hills;
  const auto grid = fieldGrid(hills.field, {&hills.field, 1});
  ASSERT_TRUE(grid);
  DeriveOptions options;
  options.keepScopes = true;
  options.threads = 1;
  options.fields = {{"hills", *grid, hills.values.data()}};
  double worst = 0;
  size_t terminals = 0;
  for (const char* text : {
           "Lot --> extrude(max(1, Field(\"hills\"))) comp(f) { side: A | top: B }",
           "Lot --> split(x) { ~2: split(z) { ~2: Cell }* }*\nCell --> case Field(\"hills\") > 4: extrude(3) High "
           "else: Low",
           "Lot --> t(3, 0, 1) case Field(\"hills\", 1, -2) < Field(\"hills\", -1, 2): color(\"#ff0000\") A else: r(0, "
           "30, 0) B",
           "Lot --> split(z) { max(1, Field(\"hills\")): A | ~1: extrude(2) comp(f) { front: Face | all: NIL } }\n"
           "Face --> split(x) { ~1: case Field(\"hills\") > 3.5: Tile else: NIL }*",
           "high = Field(\"hills\") > 4.5\nLot --> split(x) { ~1: P }*\nP --> case high && scope.sx < 5: A else: B",
       }) {
    SCOPED_TRACE(text);
    const WithGraph made = withGraph(text);
    ASSERT_TRUE(made.program) << made.messages;
    ASSERT_FALSE(made.words.empty()) << made.program->graph.why;
    const auto graph = load(std::as_bytes(std::span(made.words)), std::pmr::new_delete_resource());
    ASSERT_TRUE(graph);
    const auto bound = bindFields(*graph, {&hills.field, 1});
    ASSERT_TRUE(bound) << bound.error().text;
    for (const uint32_t seed : {5u, 6u, 7u}) {
      const Lots lots = someLots(seed);
      Messages messages;
      const Derivation cpu = derive(*made.program, lots.lots, options, messages);
      EXPECT_EQ(allOf(messages), "");
      spawn::DeriveOptions world;
      world.fields = &*bound;
      EXPECT_EQ(difference(cpu, spawn::derive(made.words, lots.axioms, world).instances, made.program->graph, worst),
                "");
      terminals += cpu.leaves.size();
    }
  }
  EXPECT_GT(terminals, 200u);
}

TEST(CgaGraphs, TheFirstMisfitIsNamedWithItsPlace) {
  const auto why = [](const std::string& text) {
    const WithGraph made = withGraph(text);
    EXPECT_TRUE(made.program) << made.messages;
    if (!made.program) return std::string();
    const GraphText& graph = made.program->graph;
    EXPECT_TRUE(graph.text.empty()) << text;
    return graph.file + ":" + std::to_string(graph.place.line) + ":" + std::to_string(graph.place.column) + " " +
           graph.why;
  };
  EXPECT_EQ(why("Lot --> extrude(3)\n  roofHip(30)"), "main.cga:2:3 'roofHip' of anything but a rectangle");
  EXPECT_EQ(why("Lot --> Other\nOther --> split(u, uvSpace, 0) { 1: A }"), "main.cga:2:11 split along 'u'");
  EXPECT_EQ(why("Lot --> A(rand(3))\nA(x) --> extrude(x)"), "main.cga:1:11 a random number that is given to a rule");
  EXPECT_EQ(why("Lot --> A(scope.sx)\nA(x) --> s('0.5, '1, '1) B(x)\nB(x) --> case x > 3: C else: D"),
            "main.cga:2:28 'x', which was worked out from a size that the shape no longer has,");
  EXPECT_EQ(why("Lot --> extrude(scope.sx - 3)"), "main.cga:1:9 extrude by a height that may be 0 or less");
  EXPECT_EQ(why("Lot --> split(x) { ~1: case split.index == 0: A else: B }*"),
            "main.cga:1:29 the function or attribute 'split.index'");
  EXPECT_EQ(why("Lot --> setback(1) { all: A | remainder: B }"),
            "main.cga:1:22 a setback whose mitred pieces are used");
  EXPECT_EQ(why("attr h = Field(\"a\")\nLot --> extrude(max(1, h))"),
            "main.cga:2:24 'h', a field's value that a shape has to remember,");
  EXPECT_EQ(why("Lot --> A(Field(\"a\"))\nA(x) --> t(1, 0, 0) case x > 1: B else: C"),
            "main.cga:2:26 'x', a field's value that a shape has to remember,");
  EXPECT_EQ(why("Lot --> extrude(max(1, Field(\"my field\")))"),
            "main.cga:1:24 a field whose name is not known, or is no identifier,");
  EXPECT_EQ(why("Lot --> A(1)\nA(n) --> t(1, 0, 0) A(n + 1)"),
            "main.cga:2:21 a rule that is called with so many different values");
}

TEST(CgaGraphs, TheSampleTownIsTheSame) {
  double worst = 0;
  Lots lots;
  for (uint32_t i = 0; i < 30; ++i) lots.add(13 + 0.1f * static_cast<float>(i), 19 + 0.07f * static_cast<float>(i), i);
  expectSame(test::textOf(GPGP_CGA_SAMPLES "/town.cga"), lots, worst);
}

TEST(CgaGraphs, TheSameBuildingInBothLanguagesIsTheSameSet) {
  const WithGraph made =
      withGraph("Lot --> extrude(12) comp(f) { side: Facade | top: Roof. }\n"
                "Facade --> split(y) { ~3: Floor }*\n"
                "Floor --> split(x) { 1: Wall. | { ~2: Tile }* | 1: Wall. }\n"
                "Tile --> split(x) { ~1: Wall. | 0.8: split(y) { ~1: Wall. | 1.2: Window. } | ~1: Wall. }\n");
  const std::vector<uint32_t> words = test::bake(
      "axiom Box Lot; terminal Wall (1,0); terminal Window (1,1); terminal Roof (1,2);\n"
      "Lot = GrowAlong(Y, 12) CompSplit() { Roof | Discard() | Facade };\n"
      "Facade = Repeat(Y, 3, ADJUST_TO_FILL) SubDiv(X) { 1: Wall | -1: Repeat(X, 2, ADJUST_TO_FILL) Tile | 1: Wall };\n"
      "Tile = SubDiv(X) { -1: Wall | 0.8: SubDiv(Y) { -1: Wall | 1.2: Window } | -1: Wall };\n");
  Lots lots;
  lots.add(20, 10, 3);
  auto a = spawn::derive(made.words, lots.axioms).instances, b = spawn::derive(words, lots.axioms).instances;
  const auto before = [](const GpgpInstance& x, const GpgpInstance& y) {
    return std::tie(x.key[0], x.key[1]) < std::tie(y.key[0], y.key[1]);
  };
  std::sort(a.begin(), a.end(), before);
  std::sort(b.begin(), b.end(), before);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a.size(), 1u + 4u * (2 * (2 + 9 * 4) + 2 * (2 + 4 * 4)));
  const char* names[] = {"Wall", "Window", "Roof"};
  for (size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(made.program->graph.terminals.at(a[i].terminal).name, names[b[i].terminal]);
    for (int t = 0; t < 12; ++t) ASSERT_EQ(a[i].transform[t], b[i].transform[t]);
    for (int t = 0; t < 3; ++t) ASSERT_EQ(a[i].size[t], b[i].size[t]);
    ASSERT_EQ(a[i].key[0], b[i].key[0]);
    ASSERT_EQ(a[i].key[1], b[i].key[1]);
  }
}

TEST(CgaGraphs, RandomProgramsDeriveTheSameSetsOnTheGpu) {
  test::SpawnDevice device;
  double worst = 0;
  uint32_t fits = 0, most = 0;
  uint64_t terminals = 0;
  std::map<std::string, uint32_t> misfits;
  for (uint32_t seed = 1; fits < 1000 && seed <= 4000 && !testing::Test::HasFailure(); ++seed) {
    const std::string text = RandomProgram(seed).text();
    const WithGraph made = withGraph(text);
    ASSERT_TRUE(made.program) << text << made.messages;
    if (made.words.empty()) {
      ++misfits[made.program->graph.why];
      continue;
    }
    const Lots lots = someLots(seed);
    const Derivation cpu = onTheCpu(*made.program, lots.lots);
    const uint32_t count = static_cast<uint32_t>(cpu.leaves.size());
    if (count > 1200) continue; // of which lavapipe makes no more than of others
    uint64_t reports = 0;
    for (const auto& [name, report] : cpu.reports) reports += report.count;
    std::vector<GpgpInstance> written;
    const GpgpSpawnReport report =
        device.derive(made.words, lots.axioms, count + static_cast<uint32_t>(reports) + 1, &written);
    EXPECT_EQ(report.droppedShapes, 0u);
    EXPECT_EQ(report.unfinishedShapes, 0u);
    EXPECT_EQ(report.terminals, count + reports);
    EXPECT_EQ(difference(cpu, written, made.program->graph, worst), "") << text << "\n" << made.program->graph.text;
    ++fits;
    most = std::max(most, count);
    terminals += report.terminals;
  }
  EXPECT_GE(fits, 1000u);
  EXPECT_GE(terminals, 50'000u);
  std::printf("%u programs, %llu terminals, at most %u of one, largest error %g\n", fits,
              static_cast<unsigned long long>(terminals), most, worst);
  for (const auto& [why, count] : misfits) std::printf("  %u  %s\n", count, why.c_str());
}

} // namespace
} // namespace gpgp::spawn::cga
