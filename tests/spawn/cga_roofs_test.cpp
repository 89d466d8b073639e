// Roofs of .cga files on the GPU: operator graphs against the CPU evaluator of .cga files, whose roofs are meshes on a
// straight skeleton. Terminals are compared by path keys, and what they look like corner by corner.
#include "cga_graphs.h"
#include "spawn_device.h"

namespace gpgp::spawn::cga {
namespace {

Derivation silentlyOnTheCpu(const Program& program, const std::vector<Axiom>& lots) {
  std::string said;
  Derivation result = onTheCpu(program, lots, &said);
  EXPECT_EQ(said, "");
  return result;
}

/// Wider than deep, deeper than wide, a square, and nearly one.
Lots someLots(uint32_t seed) {
  Lots lots;
  lots.add(10, 20, seed);
  lots.add(7.5f, 6.25f, seed + 1);
  lots.add(3, 14.2f, seed + 77);
  lots.add(8, 8, seed + 5);
  lots.add(8, 7.999f, seed + 6);
  return lots;
}

void expectSame(const std::string& text, const Lots& lots, const std::vector<GpgpInstance>& instances,
                const WithGraph& made, double& worst) {
  const Derivation cpu = silentlyOnTheCpu(*made.program, lots.lots);
  EXPECT_EQ(difference(cpu, instances, made.program->graph, worst, 1e-6), "") << text;
  EXPECT_EQ(differenceOfShapes(cpu, instances, made.words, made.program->graph), "") << text;
}
/// The graph's terminals by the CPU evaluator of graphs, which the GPU equals.
void expectSame(const std::string& text, double& worst) {
  SCOPED_TRACE(text);
  const WithGraph made = withGraph(text);
  ASSERT_TRUE(made.program) << made.messages;
  ASSERT_FALSE(made.words.empty()) << made.program->graph.why << " " << made.program->graph.place.line << ":"
                                   << made.program->graph.place.column;
  SCOPED_TRACE(made.program->graph.text);
  const Lots lots = someLots(5);
  const spawn::Derivation graph = spawn::derive(made.words, lots.axioms);
  EXPECT_EQ(graph.droppedShapes, 0u);
  expectSame(text, lots, graph.instances, made, worst);
}

constexpr const char* kRoofs[] = {"roofGable(30)",
                                  "roofGable(60)",
                                  "roofGable(byHeight, 2.5)",
                                  "roofGable(byAngle, 35, 0, 0, false, 0)",
                                  "roofGable(35, 0, 0, true, 1)",
                                  "roofGable(35, 0, 0, true, 6)",
                                  "roofHip(40)",
                                  "roofHip(byHeight, 1.5)",
                                  "roofPyramid(33)",
                                  "roofPyramid(byHeight, 4)",
                                  "roofShed(15)",
                                  "roofShed(20, 1)",
                                  "roofShed(byHeight, 1, 2)",
                                  "roofShed(20, 7)",
                                  "roofGable(rand(20, 40))",
                                  "roofHip(byHeight, rand(1, 2))"};

TEST(CgaRoofs, WholeRoofsAreTheSame) {
  double worst = 0;
  for (const std::string roof : kRoofs) {
    expectSame("Lot --> " + roof, worst);
    expectSame("Lot --> extrude(4) comp(f) { top: " + roof + " Roof. | side: Wall. }", worst);
    expectSame("Lot --> t(1, 2, 3) r(0, 30, 0) [ " + roof + " color(\"#ff0000\") t(0, 0.5, 0) A ] B", worst);
    expectSame("Lot --> " + roof + " primitiveCube() report(\"h\", scope.sy)", worst);
  }
  expectSame("Lot --> taper(3) A", worst);
  expectSame("Lot --> split(x) { ~2: taper(rand(2, 4)) comp(f) { bottom: NIL | all: A } }*", worst);
  std::printf("largest error %g\n", worst);
}

TEST(CgaRoofs, TheirFacesAreTheSame) {
  double worst = 0;
  for (const std::string roof : kRoofs) {
    expectSame("Lot --> " + roof + " comp(f) { all: A }", worst);
    expectSame("Lot --> extrude(3) comp(f) { top: " + roof + " comp(f) { bottom: NIL | 2: A | all: B } }", worst);
    expectSame("Lot --> r(0, 25, 0) " + roof + " Roof\nRoof --> comp(f) { 0: A | -1: B | 1: r(0, 10, 0) C | all: D }",
               worst);
    expectSame("Lot --> " + roof + " comp(f) { all: case scope.sx > 7: t(0.5, 0, 0.2) A else: s('0.5, '0.5, '1) B }",
               worst);
    expectSame("Lot --> " + roof + " comp(f) { world.down: A | border: B | inside: report(\"x\", 1) C }", worst);
  }
  for (const char* overhangs : {"0.5", "0.5, 0.75", "0, 0.3", "k, k / 2"})
    for (const std::string roof : {"Gable", "Hip"})
      expectSame("attr k = rand(0.2, 0.6)\nLot --> roof" + roof + "(35, " + overhangs +
                     ") color(\"#303030\") comp(f) { all: A }",
                 worst);
  std::printf("largest error %g\n", worst);
}

TEST(CgaRoofs, SelectorsAreTheSame) {
  double worst = 0;
  for (const char* selector : {"top", "bottom", "side", "vertical", "horizontal", "aslant", "nutant", "front", "back",
                               "left", "right", "object.left", "world.up", "eave", "all"}) {
    for (const char* roof : {"roofGable(10)", "roofGable(20)", "roofGable(45)", "roofGable(50)", "roofGable(80)",
                             "roofHip(11)", "roofHip(30)", "roofHip(60)", "roofShed(30, 1)"})
      expectSame("Lot --> " + std::string(roof) + " comp(f) { " + selector + ": A | all: B }", worst);
  }
}

TEST(CgaRoofs, FacesThatAreRectanglesGoOn) {
  double worst = 0;
  for (const char* body :
       {"split(x) { ~1: A }*", "split(y) { { ~0.4: Row }* | 0.2: Ridge }", "extrude(0.2) A",
        "split(x) { 0.3: A | ~1: split(y) { '0.5: B | ~1: NIL } }", "s('1, '0.5, 0.1) primitiveCube() A",
        "comp(f) { all: A }", "t(0, 0, 0.1) r(0, 0, 5) color(\"#aa0000\") A", "split(z) { 1: A }"})
    expectSame("Lot --> roofGable(33, 0.4, 0.3) comp(f) { top: " + std::string(body) + " | vertical: Gable. }", worst);
  std::printf("largest error %g\n", worst);
}

TEST(CgaRoofs, SetbacksAreTheSame) {
  double worst = 0;
  for (const char* parts :
       {"all: NIL | remainder: A", "remainder: A", "front: A | remainder: B", "back: A | remainder: B",
        "left: A | right: B | remainder: C", "remainder: C | front: A | back: B",
        "front: NIL | left: NIL | remainder: A", "side: NIL | remainder: extrude(3) A", "0: A | 2: B",
        "object.front: A", "border: NIL | remainder: split(x) { ~2: A }*",
        "all: NIL | remainder: extrude(3) comp(f) { side: W | top: T | bottom: NIL }",
        "front: NIL | right: NIL | remainder: extrude(2) comp(f) { front: F | all: A }",
        "left: A | remainder: comp(f) { all: B }", "all: NIL | remainder: roofHip(30) comp(f) { all: A }",
        "all: NIL | remainder: roofGable(30, 0.4, 0.2, true, 1) comp(f) { 1: A | all: B }",
        "all: NIL | remainder: roofShed(20) A",
        "front: color(\"#ff0000\") A | remainder: setback(0.5) { back: B | remainder: C }",
        "all: NIL | remainder: t(0, 0, 1) s('0.5, '1, '1) center(xz) extrude(2) comp(f) { top: roofGable(40) R | side: "
        "S }"})
    for (const char* distance : {"1", "4.5", "a", "max(0.5, scope.sx / 5)"}) {
      expectSame("attr a = rand(0.5, 4)\nLot --> setback(" + std::string(distance) + ") { " + parts + " }", worst);
    }
  expectSame("Lot --> extrude(4) comp(f) { top: setback(0.7) { all: NIL | remainder: extrude(2) A } | side: W }",
             worst);
  expectSame("Lot --> extrude(4) comp(f) { front: setback(0.7) { bottom: A | top: B | remainder: C } | top: T }",
             worst);
  std::printf("largest error %g\n", worst);
}

TEST(CgaRoofs, WhatDoesNotFitIsNamed) {
  const auto why = [](const std::string& text) {
    const WithGraph made = withGraph(text);
    EXPECT_TRUE(made.program) << made.messages;
    if (!made.program) return std::string();
    EXPECT_TRUE(made.program->graph.text.empty()) << text;
    return std::to_string(made.program->graph.place.column) + " " + made.program->graph.why;
  };
  EXPECT_EQ(why("Lot --> roofGable(30, 0.5) A"), "9 a roof with overhangs that comp(f) does not take apart");
  EXPECT_EQ(why("Lot --> extrude(3) roofHip(30)"), "20 'roofHip' of anything but a rectangle");
  EXPECT_EQ(why("Lot --> extrude(3) comp(f) { front: roofHip(30) }"),
            "37 'roofHip' of a rectangle that may not be level");
  EXPECT_EQ(why("Lot --> roofHip(rand(80, 100))"), "17 a roof whose angle may not be between 0 and 90 degrees");
  EXPECT_EQ(why("Lot --> roofHip(byHeight, 2) comp(f) { top: A }"),
            "40 the selector 'top' of a roof that may be steep or not");
  EXPECT_EQ(why("Lot --> roofHip(30) comp(f) { all: extrude(0.2) }"),
            "36 'extrude' of a roof face that is not a rectangle");
  EXPECT_EQ(why("Lot --> roofGable(30) comp(f) { all: s('1, '1, 0.2) A }"),
            "0 a roof's face whose scope has a height, but no solid,");
  EXPECT_EQ(why("Lot --> roofHip(30) split(y) { 1: A }"), "21 split of a roof");
  EXPECT_EQ(why("Lot --> roofGable(30, 1) report(\"h\", scope.sy)"), "38 'scope.sy' of a roof with overhangs");
}

/// A random program of masses, roofs, their faces and what goes on with those.
std::string randomProgram(uint32_t seed) {
  std::mt19937 random(seed);
  const auto below = [&](uint32_t n) { return static_cast<uint32_t>(random() % n); };
  const auto decimal = [&](float low, float high) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f",
                  static_cast<double>(low + (high - low) * static_cast<float>(below(41)) / 40));
    return std::string(text);
  };
  const auto overhang = [&] { return below(2) ? decimal(0, 1) : std::string("over"); };
  bool overhangs = false, isSteep = false;
  const auto roof = [&] {
    const uint32_t kind = below(4);
    const char* names[] = {"roofGable", "roofHip", "roofPyramid", "roofShed"};
    std::string text = std::string(names[kind]) + "(";
    isSteep = below(4) == 0; // its slope is not known
    if (isSteep)
      text += "byHeight, " + (below(2) ? decimal(0.5f, 4) : "rand(1, " + decimal(1.5f, 3) + ")");
    else
      text += below(2)   ? decimal(12, 44)
              : below(2) ? "rand(" + decimal(15, 25) + ", " + decimal(30, 44) + ")"
                         : "angle";
    overhangs = kind < 2 && below(2);
    if (overhangs) text += ", " + overhang();
    if (overhangs && kind == 0)
      text += ", " + overhang() + ", true" + (below(2) ? ", " + std::to_string(below(4)) : "");
    if (kind == 3 && below(2)) text += ", " + std::to_string(below(5));
    return text + ") ";
  };
  const auto faces = [&] {
    std::string text = "comp(f) { ";
    if (below(2)) text += below(2) ? "bottom: NIL | " : "0: Floor. | ";
    if (!isSteep && below(2)) text += "vertical: color(\"#aabbcc\") Gable. | ";
    if (!isSteep && below(3) == 0) text += "top: r(0, 0, " + decimal(-9, 9) + ") Tiles. | ";
    const char* rest[] = {"Tiles.",
                          "t(0, 0.1, 0.2) Tiles.",
                          "s('0.8, '0.5, '1) Tiles.",
                          "case scope.sx > 5.03: Long. else: Short.",
                          "report(\"n\", 1) color(pick) Tiles.",
                          "50%: NIL else: Tiles."};
    text += "all: " + std::string(rest[below(6)]) + " }";
    return text;
  };
  std::string text =
      "attr angle = rand(20, 40)\nattr over = rand(0.1, 0.7)\npick = 25%: \"#ff0000\" 50%: \"#00ff00\" else: "
      "\"#0000ff\"\nLot --> ";
  if (below(2)) text += "r(0, " + decimal(-60, 60) + ", 0) ";
  if (below(2)) text += "s('" + decimal(0.3f, 1) + ", '1, '" + decimal(0.3f, 1) + ") ";
  if (below(2))
    text += "split(x) { ~" + decimal(2, 5) + ": Mass }*\n";
  else
    text += "Mass\n";
  text += "Mass --> extrude(" + decimal(2, 9) + ") comp(f) { side: Wall. | top: Roof }\nRoof --> ";
  if (below(2)) text += "split(y) { " + decimal(0.5f, 2) + ": Slab. | ~1: Top }\nTop --> ";
  const std::string first = roof();
  if (below(3) == 0)
    text += "[ t(0, 0, 3) " + first + (overhangs ? faces() : "Whole.") + " ] ";
  else if (below(2))
    text += "60%: Flat. else: ";
  text += roof();
  if (!overhangs && below(3) == 0) return text + "color(pick) Whole.";
  if (below(2)) return text + "Faces(" + decimal(1, 3) + ")\nFaces(n) --> " + faces();
  return text + faces();
}

TEST(CgaRoofs, RandomProgramsDeriveTheSameSetsOnTheGpu) {
  test::SpawnDevice device;
  double worst = 0;
  uint32_t fits = 0;
  uint64_t terminals = 0;
  for (uint32_t seed = 1; fits < 120 && seed <= 600 && !testing::Test::HasFailure(); ++seed) {
    const std::string text = randomProgram(seed);
    const WithGraph made = withGraph(text);
    ASSERT_TRUE(made.program) << text << made.messages;
    ASSERT_FALSE(made.words.empty()) << text << "\n" << made.program->graph.why;
    const Lots lots = someLots(seed);
    const spawn::Derivation reference = spawn::derive(made.words, lots.axioms);
    if (reference.instances.size() > 3000) continue;
    std::vector<GpgpInstance> written;
    const GpgpSpawnReport report =
        device.derive(made.words, lots.axioms, static_cast<uint32_t>(reference.instances.size()) + 1, &written);
    EXPECT_EQ(report.droppedShapes, 0u);
    EXPECT_EQ(report.terminals, reference.instances.size());
    expectSame(text, lots, written, made, worst);
    // Bit for bit what the CPU evaluator of graphs makes.
    auto expected = reference.instances;
    const auto before = [](const GpgpInstance& x, const GpgpInstance& y) {
      return std::tie(x.axiomId, x.key[0], x.key[1]) < std::tie(y.axiomId, y.key[0], y.key[1]);
    };
    std::sort(expected.begin(), expected.end(), before);
    std::sort(written.begin(), written.end(), before);
    for (size_t i = 0; i < written.size(); ++i) {
      ASSERT_EQ(written[i].shape, expected[i].shape) << text;
      for (int t = 0; t < 3; ++t) ASSERT_EQ(written[i].size[t], expected[i].size[t]) << text;
      for (int t = 0; t < 12; ++t)
        ASSERT_NEAR(written[i].transform[t], expected[i].transform[t],
                    1e-4f * (1 + std::fabs(expected[i].transform[t])))
            << text;
    }
    ++fits;
    terminals += report.terminals;
  }
  EXPECT_GE(fits, 120u);
  EXPECT_GE(terminals, 4'000u);
  std::printf("%u programs, %llu terminals, largest error %g\n", fits, static_cast<unsigned long long>(terminals),
              worst);
}

} // namespace
} // namespace gpgp::spawn::cga
