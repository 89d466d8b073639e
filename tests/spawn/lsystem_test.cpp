// The language of L-systems and its CPU reference: published derivations, closed forms, errors, and a rewriter that
// shares nothing with it.
#include "lsystem_random.h"
#include "spawn/lsystem/compile.h"
#include "spawn/lsystem/reference.h"
#include "spawn/lsystem/rewrite.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gpgp {
namespace {

using namespace spawn::lsystem;
using spawn::Diagnostics;

std::vector<GpgpAxiom> axiomsOf(uint32_t count) {
  std::vector<GpgpAxiom> axioms(count);
  for (uint32_t i = 0; i < count; ++i) {
    axioms[i].transform[0] = axioms[i].transform[5] = axioms[i].transform[10] = 1;
    axioms[i].seed = 1 + i;
    axioms[i].id = i;
  }
  return axioms;
}

Table tableOf(const std::string& text) {
  Diagnostics diagnostics;
  const auto words = compile(text, {}, diagnostics);
  for (const auto& d : diagnostics.sorted())
    if (d.severity == GPGP_SEVERITY_ERROR) ADD_FAILURE() << format(d, "test") << "\n" << text;
  auto table = Table::load(std::as_bytes(std::span(words.value())), std::pmr::new_delete_resource());
  if (!table) throw std::runtime_error(table.error().text);
  return *table;
}
std::string stringOf(const Table& table, uint32_t iterations) {
  const auto axioms = axiomsOf(1);
  return print(table, derive(table, axioms, iterations).string);
}
Drawn drawnOf(const std::string& text, uint32_t iterations) {
  const Table table = tableOf(text);
  const auto axioms = axiomsOf(1);
  return draw(table, derive(table, axioms, iterations).string, axioms);
}
/// Where a segment ends.
std::array<double, 3> endOf(const GpgpInstance& i) {
  const float* m = i.transform;
  return {m[3] + 0.5 * m[1], m[7] + 0.5 * m[5], m[11] + 0.5 * m[9]};
}

// ------------------------------------------------------------ published derivations

TEST(Lsystem, AnabaenaGrowsAsInTheBook) { // ABOP 1.2, equation 1.1
  const Table t =
      tableOf("modules: ar al br bl\naxiom: ar\niterations: 9\nar --> al br\nal --> bl ar\nbr --> ar\nbl --> al\n");
  EXPECT_EQ(stringOf(t, 1), "albr");
  EXPECT_EQ(stringOf(t, 2), "blarar");
  EXPECT_EQ(stringOf(t, 3), "alalbralbr");
  EXPECT_EQ(stringOf(t, 4), "blarblararblarar");
  const auto axioms = axiomsOf(1);
  uint64_t a = 1, b = 2; // Fibonacci
  for (uint32_t n = 1; n < 20; ++n) {
    EXPECT_EQ(derive(t, axioms, n).string.modules.size() - 3, b);
    std::swap(a, b);
    b += a;
  }
}

TEST(Lsystem, ParametricExampleOfTheBook) { // ABOP 1.10, equation 1.7
  const Table t =
      tableOf("axiom: B(2)A(4,4)\niterations: 4\nA(x,y) : y <= 3 --> A(x*2,x+y)\nA(x,y) : y > 3 --> B(x)A(x/y,0)\n"
              "B(x) : x < 1 --> C\nB(x) : x >= 1 --> B(x-1)\n");
  EXPECT_EQ(stringOf(t, 1), "B(1)B(4)A(1,0)");
  EXPECT_EQ(stringOf(t, 2), "B(0)B(3)A(2,1)");
  EXPECT_EQ(stringOf(t, 3), "CB(2)A(4,3)");
  EXPECT_EQ(stringOf(t, 4), "CB(1)A(8,7)");
}

TEST(Lsystem, ContextsOfTheBook) {
  // ABOP 1.8: a signal that goes up the axis of a string
  const Table up = tableOf("axiom: baaaaaaaa\niterations: 4\nb < a --> b\nb --> a\n");
  EXPECT_EQ(stringOf(up, 1), "abaaaaaaa");
  EXPECT_EQ(stringOf(up, 4), "aaaabaaaa");
  // the branching structure that S has its context in: BC < S > G[H]M
  const Table tree = tableOf("axiom: ABC[DE][SG[HI[JK]L]MNO]\niterations: 1\nBC < S > G[H]M --> X\n");
  EXPECT_EQ(stringOf(tree, 1), "ABC[DE][XG[HI[JK]L]MNO]");
  const Table other = tableOf("axiom: ABC[DE][SG[IH[JK]L]MNO]\niterations: 1\nBC < S > G[H]M --> X\n");
  EXPECT_EQ(stringOf(other, 1), "ABC[DE][SG[IH[JK]L]MNO]");
}

TEST(Lsystem, CutRemovesTheRestOfItsBranch) {
  const Table t = tableOf("axiom: A[B%C[D]E]F[G]\niterations: 1\n");
  EXPECT_EQ(stringOf(t, 0), "A[B]F[G]"); // a last cut follows
  EXPECT_EQ(stringOf(tableOf("axiom: A[XC[D]E]F\niterations: 1\nX --> B%\n"), 1), "A[B]F");
}

TEST(Lsystem, DecompositionAndHomomorphism) {
  const Table t =
      tableOf("axiom: A\niterations: 2\nA --> AB\ndecomposition: 2\nB --> CC\nC --> D\nhomomorphism:\nD --> [F]\n");
  EXPECT_EQ(stringOf(t, 1), "A[F][F]");
  EXPECT_EQ(stringOf(t, 2), "A[F][F][F][F]");
}

TEST(Lsystem, SubSystemsHaveTheirOwnLetters) {
  const Table t = tableOf(
      "axiom: A ?leaf(3) A\niterations: 2\nA --> B\nsystem: leaf(n)\naxiom: A(n)\nA(x) : x > 0 --> F A(x-1)\nend:\n");
  EXPECT_EQ(stringOf(t, 0), "Aleaf.A(3)A");
  EXPECT_EQ(stringOf(t, 2), "BFFleaf.A(1)B");
}

TEST(Lsystem, ProbabilitiesAreKept) {
  const Table t = tableOf("axiom: A\niterations: 2\nA : * --> B : 0.25\nA --> C : 0.75\n");
  const auto axioms = axiomsOf(20000);
  const String string = derive(t, axioms, 1).string;
  double b = 0;
  for (const auto& m : string.modules) b += std::string(t.name(t.symbol(m.x)[0])) == "B";
  EXPECT_NEAR(b / 20000, 0.25, 0.015); // five deviations
  EXPECT_EQ(print(t, derive(t, axioms, 1).string), print(t, string));
}

TEST(Lsystem, AChangeStaysWhereItIs) {
  // Two strings that differ in one place draw the same numbers everywhere else.
  const std::string rules = "iterations: 3\nA(x) --> A(x + rand()) [ A(rand(2, 3)) ]\nB --> C\n";
  const Table a = tableOf("axiom: A(0) A(5) A(7)\n" + rules), b = tableOf("axiom: A(0) B A(7)\n" + rules);
  const std::string one = stringOf(a, 3), two = stringOf(b, 3);
  const size_t c = two.find('C');
  ASSERT_NE(c, std::string::npos);
  EXPECT_EQ(one.substr(0, c), two.substr(0, c));
  const std::string tail = two.substr(c + 1);
  EXPECT_EQ(one.substr(one.size() - tail.size()), tail);
}

// ------------------------------------------------------------ curves

struct Curve {
  const char* name;
  const char* text;
  uint32_t iterations;
  size_t segments;
  std::array<double, 2> end; ///< in steps
};
void PrintTo(const Curve& c, std::ostream* o) { *o << c.name; }

class Curves : public testing::TestWithParam<Curve> {};
TEST_P(Curves, HaveTheirLengthAndEnd) {
  const Curve& c = GetParam();
  const Drawn drawn = drawnOf(c.text, c.iterations);
  ASSERT_EQ(drawn.instances.size(), c.segments);
  const auto end = endOf(drawn.instances.back());
  EXPECT_NEAR(end[0], c.end[0], 1e-3);
  EXPECT_NEAR(end[1], c.end[1], 1e-3);
  // Segments hang together.
  std::array<double, 3> at{};
  for (const GpgpInstance& i : drawn.instances) {
    const float* m = i.transform;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(m[4 * k + 3] - 0.5 * m[4 * k + 1], at[static_cast<size_t>(k)], 1e-3);
    at = endOf(i);
  }
}
INSTANTIATE_TEST_SUITE_P(
    Lsystem, Curves,
    testing::Values(
        Curve{"Koch", "axiom: F\nangle: 90\niterations: 4\nF --> F+F-F-F+F\n", 4, 625, {0, 81}},
        Curve{"Snowflake", "axiom: F--F--F\nangle: 60\niterations: 4\nF --> F+F--F+F\n", 4, 768, {0, 0}},
        Curve{"QuadraticIsland", "axiom: F-F-F-F\nangle: 90\niterations: 2\nF --> F-F+F+FF-F-F+F\n", 2, 256, {0, 0}},
        // (1 + i)^n in the book's orientation: after eight foldings 16 steps ahead
        Curve{"Dragon",
              "axiom: L\nangle: 90\niterations: 8\nL --> L+R+\nR --> -L-R\n"
              "homomorphism:\nL --> F\nR --> F\n",
              8,
              256,
              {0, 16}},
        Curve{
            "Hilbert", "axiom: L\nangle: 90\niterations: 5\nL --> +RF-LFL-FR+\nR --> -LF+RFR+FL-\n", 5, 1023, {0, 31}},
        Curve{"Sierpinski",
              "axiom: L\nangle: 60\niterations: 6\nL --> R+L+R\nR --> L-R-L\n"
              "homomorphism:\nL --> F\nR --> F\n",
              6,
              729,
              {0, 64}}),
    [](const auto& tested) { return tested.param.name; });

TEST(Lsystem, HilbertsCurveInSpaceVisitsEveryCell) {
  const Drawn drawn = drawnOf("axiom: A\nangle: 90\niterations: 3\nA --> B-F+CFC+F-D&F^D-F+&&CFC+F+B//\n"
                              "B --> A&F^CFB^F^D^^-F-D^|F^B|FC^F^A//\nC --> |D^|F^B-F+C^F^A&&FA&F^C+F+B^F^D//\n"
                              "D --> |CFB-F+B|FA&F^A&&FB-F+B|FC//\n",
                              3);
  ASSERT_EQ(drawn.instances.size(), 511u);
  std::vector<std::array<long, 3>> places{{0, 0, 0}};
  for (const GpgpInstance& i : drawn.instances) {
    const auto e = endOf(i);
    places.push_back({std::lround(e[0]), std::lround(e[1]), std::lround(e[2])});
  }
  std::sort(places.begin(), places.end());
  EXPECT_EQ(std::unique(places.begin(), places.end()), places.end());
  for (int k = 0; k < 3; ++k) {
    long low = 0, high = 0;
    for (const auto& p : places) {
      low = std::min(low, p[static_cast<size_t>(k)]);
      high = std::max(high, p[static_cast<size_t>(k)]);
    }
    EXPECT_EQ(high - low, 7);
  }
}

// ------------------------------------------------------------ the turtle

TEST(Lsystem, CommandsTurnAsTheySay) {
  const auto end = [](const char* commands) {
    return endOf(drawnOf(std::string("axiom: ") + commands + "F(2)\nangle: 90\niterations: 0\n", 0).instances[0]);
  };
  const auto expect = [&](const char* commands, std::array<double, 3> place) {
    const auto found = end(commands);
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], place[i], 1e-6) << commands;
  };
  expect("", {0, 2, 0}); // H is +Y, L is -X, U is +Z
  expect("+", {-2, 0, 0});
  expect("-", {2, 0, 0});
  expect("&", {0, 0, -2});
  expect("^", {0, 0, 2});
  expect("|", {0, -2, 0});
  expect("\\ +", {0, 0, -2}); // rolled to the left, L points down
  expect("/ +", {0, 0, 2});
  expect("+(45)+(45)", {-2, 0, 0});
  expect("f(3)[+f(9)]", {0, 5, 0});
  expect("&(45)/(30)$+", {-2, 0, 0}); // L is level again
}

TEST(Lsystem, WidthColourAndAssets) {
  const Drawn d =
      drawnOf("axiom: F !F !(0.3)F ' F '(7) F ~l(2) J\nwidth: 0.5 0.5\nasset: J berry sphere\niterations: 0\n", 0);
  ASSERT_EQ(d.instances.size(), 7u);
  EXPECT_FLOAT_EQ(d.instances[0].size[0], 0.5f);
  EXPECT_FLOAT_EQ(d.instances[1].size[0], 0.25f);
  EXPECT_FLOAT_EQ(d.instances[2].size[0], 0.3f);
  EXPECT_FLOAT_EQ(d.instances[3].attribute, 1);
  EXPECT_FLOAT_EQ(d.instances[4].attribute, 7);
  EXPECT_FLOAT_EQ(d.instances[5].size[1], 2);
  EXPECT_EQ(d.instances[6].shape, uint32_t{GPGP_SHAPE_SPHERE});
}

TEST(Lsystem, PolygonsAndCylindersGatherTheirCorners) {
  const Drawn square = drawnOf("axiom: {F+F+F+F} [+A{.]f.G.}\nangle: 90\niterations: 0\n", 0);
  ASSERT_EQ(square.instances.size(), 3u); // two polygons, and the segment of G
  ASSERT_EQ(square.corners.size(), 8u);   // f is a corner as well
  EXPECT_NEAR(square.corners[1][0], -1, 1e-6);
  EXPECT_NEAR(square.corners[1][1], 1, 1e-6);
  const Drawn stem = drawnOf("axiom: @Gs f @Gc [+ @Gs f @Ge] !(2) f @Ge\nangle: 90\nwidth: 1\niterations: 0\n", 0);
  ASSERT_EQ(stem.instances.size(), 2u);
  EXPECT_EQ(stem.instances[0].size[0], 3);
  EXPECT_EQ(stem.instances[1].size[0], 2);
  EXPECT_EQ(stem.instances[0].rule, 0u);
  EXPECT_EQ(stem.corners[2][3], 2);
  EXPECT_NEAR(stem.corners[4][0], -1, 1e-6);
}

TEST(Lsystem, TropismBendsBySineOfTheAngle) {
  // One segment ahead along +X, then bent by elasticity * |H x T| = 0.25 radians towards -Y
  const Drawn d = drawnOf("axiom: -F F\nangle: 90\ntropism: 0 -1 0 0.25\niterations: 0\n", 0);
  const auto e = endOf(d.instances[1]);
  EXPECT_NEAR(e[0], 1 + std::cos(0.25), 1e-5);
  EXPECT_NEAR(e[1], -std::sin(0.25), 1e-5);
}

TEST(Lsystem, FunctionsAreThoseOfTheCpu) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(-20, 20), positive(0.001f, 50);
  for (int i = 0; i < 20000; ++i) {
    const float x = any(random), y = any(random), p = positive(random);
    EXPECT_NEAR(shader::logarithm2(p), std::log2(p), 2e-6);
    EXPECT_NEAR(shader::exponential2(x) / std::exp2(x), 1, 2e-6);
    EXPECT_NEAR(shader::arcTangentDegrees(y, x), std::atan2(y, x) * 57.29577951, 4e-5);
    EXPECT_NEAR(shader::power(p, x * 0.2f) / std::pow(p, x * 0.2f), 1, 2e-5);
  }
  EXPECT_EQ(shader::power(2, 10), 1024);
  EXPECT_EQ(shader::power(-2, 3), -8);
  EXPECT_EQ(shader::arcTangentDegrees(1, 0), 90);
}

// ------------------------------------------------------------ files of plant modellers

TEST(LsystemOfPlantModellers, HeadingsMacrosAndCommentsAreTheirs) {
  const Table t = tableOf(R"(/* a bush */
#define STEPS 2   /* as many */
#define ANGLE 25.7
#define Apex X
#define grown(n, most) \
  ((n) >= (most))
Lsystem: 1
derivation length: STEPS
Consider: XF[]
Axiom: Apex(0)/* the beginning */

p1: Apex(n) : !grown(n, 1)
      --> F[+(ANGLE)Apex(n+1)]//
          F Apex(n+1)
p2: Apex(n) : grown(n, 1) --> *
endlsystem
)");
  EXPECT_EQ(stringOf(t, 1), "F[+(25.7)X(1)]//FX(1)");
  EXPECT_EQ(stringOf(t, 2), "F[+(25.7)]//F");
}

TEST(LsystemOfPlantModellers, OneTextMeansWhatOursMeans) { // ABOP figure 1.24 b
  const Table own = tableOf("axiom: F\nangle: 20\niterations: 4\nF --> F[+F]F[-F][F]\n");
  for (const char* text : {"lsystem: 1\nderivation length: 4\nangle: 20\naxiom: F\nF --> F[+F]F[-F][F]\nendlsystem\n",
                           "n=4; delta=20; stemsize=0.1\naxiom: F\np1: F -> F[+F]F[-F][F]\nview = {auto: 'z'}\n"})
    EXPECT_EQ(stringOf(tableOf(text), 4), stringOf(own, 4));
}

TEST(LsystemOfPlantModellers, CodeStandsBeforeAndBehindConditions) {
  const Table t = tableOf(R"(lsystem: 1
derivation length: 4
start: { limit = 3; }
axiom: A(0)
A(t) : {u = t + 1;} u <= limit { x = t * t; if (x > 2) { y = x; x += 10; } else y = -1; } --> B(x, y) A(u)
A(t) : * {u = t; z = u + 1; u = 7;} --> C(t, u, z)
endlsystem
)");
  EXPECT_EQ(stringOf(t, 3), "B(0,-1)B(1,-1)B(14,4)A(3)");
  EXPECT_EQ(stringOf(t, 4), "B(0,-1)B(1,-1)B(14,4)C(3,7,4)");
}

TEST(LsystemOfPlantModellers, RandomNumbersWithANameAreDrawnOnce) {
  const std::string s = stringOf(tableOf("lsystem: 1\nderivation length: 1\naxiom: A\n"
                                         "A : * { x = ran(1); y = x; } --> B(x, y, ran(1))\nendlsystem\n"),
                                 1);
  float x = 0, y = 0, z = 0;
  ASSERT_EQ(std::sscanf(s.c_str(), "B(%f,%f,%f)", &x, &y, &z), 3) << s;
  EXPECT_EQ(x, y);
  EXPECT_NE(x, z);
}

TEST(LsystemOfPlantModellers, SectionsHaveDepths) {
  const Table t = tableOf(R"(Lsystem: 1
derivation length: 1
Axiom: A(3)
A(n) --> B(n)
decomposition
maximum depth: 5
B(n) : n > 0 --> C B(n - 1)
homomorphism
maximum depth: 2
C --> D
D --> F
endlsystem
)");
  EXPECT_EQ(stringOf(t, 1), "FFFB(0)"); // as it is drawn
  const auto axioms = axiomsOf(1);
  EXPECT_EQ(draw(t, derive(t, axioms, 1).string, axioms).instances.size(), 3u);
}

TEST(LsystemOfPlantModellers, CirclesSpheresAndColoursAreDrawn) {
  const Drawn d =
      drawnOf("lsystem: 1\nderivation length: 0\naxiom: ;(5)F(1)@O(0.5)[+@c(0.2)]#(0.3)F(2)@v\nendlsystem\n", 0);
  EXPECT_EQ(d.instances.size(), 4u);
}

TEST(LsystemOfPlantModellers, WhatIsNotSupportedIsNamedWithItsPlaceAllAtOnce) {
  Diagnostics diagnostics;
  EXPECT_FALSE(compile(R"(#include "functions.h"
lsystem: 1
derivation length: 2
define: { array g[2] = {1, 2}; }
StartEach: { t = t + 1; }
axiom: A(1) ?P(0,0) @M(1,2,3)
A(n) : * { while (n > 1) n = n - 1; } --> A(n)
endlsystem
lsystem: 2
axiom: B
endlsystem
)",
                       {}, diagnostics));
  std::string all;
  for (const auto& d : diagnostics.sorted()) all += format(d, "x").substr(2) + "\n";
  for (const char* expected :
       {"1:1: warning: 'functions.h' of an #include cannot be read", "6:13: warning: there are no queries",
        "6:21: warning: the turtle command '@M' is not supported", "7:12: error: the number of turns of a loop has to"})
    EXPECT_NE(all.find(expected), std::string::npos) << expected << "\n" << all;
}

// ------------------------------------------------------------ errors

TEST(Lsystem, ErrorsSayWhereAndWhat) {
  const std::pair<const char*, const char*> cases[] = {
      {"axim: F\n", "1:1: error: there is no setting 'axim'; did you mean 'axiom'?"},
      {"axiom: F(x)\n", "1:10: error: there is no parameter or constant 'x'"},
      {"axiom: F]\n", "1:9: error: ']' without a '[' before it in this string"},
      {"axiom: [F\n", "1:9: error: a '[' of this string has no ']'"},
      {"axiom: F\niterations: 1.5\n", "2:13: error: iterations is a whole number from 0 to 1000"},
      {"axiom: F\nF --> sinn\nF(a) --> F(sinus(a))\n", "3:12: error: there is no function 'sinus'"},
      {"axiom: F\nF G --> F\n", "2:3: error: a production rewrites one module; found 2"},
      {"axiom: F\nF < F < F --> F\n", "error: a production is 'left < predecessor > right"},
      {"axiom: ?leav\nsystem: leaf\naxiom: F\nend:\n",
       "1:8: error: there is no sub-system 'leav'; did you mean 'leaf'?"},
      {"axiom: F\n[ --> F\n", "2:1: error: '[' cannot be rewritten"},
      {"axiom: F\nF(x,x) --> F\n", "2:5: error: the parameter 'x' stands twice"},
      {"axiom: {F{F}}\n", "1:10: error: a polygon within a polygon is not supported"},
      {"axiom: @Gx\n", "error: there is no command '@Gx'; after '@', there are Gs"},
      {"axiom: F\nignore: +\nF > + --> G\n", "3:5: error: contexts do not see '+', so this one never holds"},
      {"axiom: F\niterations: 1\nA --> F\n", "3:1: warning: the production never applies"},
      {"axiom: F\niterations: 1\nF --> FF : 0.3\nF --> F : 0.3\n",
       "3:1: warning: the probabilities of 'F' have the sum 0.6"},
      {"axiom: F\niterations: 1\nF --> F\nF --> FF\n", "4:1: warning: the production never applies: the one in line 3"},
      {"angle: 3\n", "error: there is no axiom"},
      {"axiom: \xc3\xa4\n", "1:8: error: a module is a letter"},
      {"system: a\naxiom: ?a\nend:\naxiom: ?a\n", "too deep, or without end"},
  };
  for (const auto& [text, expected] : cases) {
    Diagnostics diagnostics;
    compile(text, {}, diagnostics);
    std::string all;
    for (const auto& d : diagnostics.sorted()) all += format(d, "x").substr(2) + "\n";
    EXPECT_NE(all.find(expected), std::string::npos) << text << "gives\n" << all;
  }
}

TEST(Lsystem, ManyErrorsAreReportedAtOnce) {
  Diagnostics diagnostics;
  EXPECT_FALSE(compile("axiom: F(q)\nangle: x\nF --> [F\nG --> F]\nfoo: 1\n", {}, diagnostics));
  EXPECT_EQ(diagnostics.errorCount(), 5u);
}

TEST(Lsystem, TablesThatWereChangedNeverLeadOutside) {
  const Table table =
      tableOf("axiom: A(1)\niterations: 3\nignore: +\nA(x) < A(y) > B[A(z)] : x > 0 --> A(x+y*z)%[B] : 0.5\n"
              "A(x) --> A(x+rand())B[A(2)+{F.}]~l(3)\nhomomorphism:\nB --> F\n");
  const auto axioms = axiomsOf(2);
  std::mt19937 random(3);
  size_t loaded = 0;
  for (size_t i = 0; i < 6000; ++i) {
    std::vector<uint32_t> words(table.words().begin(), table.words().end());
    const size_t at = random() % words.size();
    words[at] = static_cast<uint32_t>(random() % 4 == 0 ? random() : words[at] + random() % 9 - 4);
    words[shader::kLsysHeadChecksum] =
        checksumOf(std::span<const uint32_t>(words).subspan(shader::kLsysHeadIterations));
    const auto changed = Table::load(std::as_bytes(std::span(words)), std::pmr::new_delete_resource());
    if (!changed) continue;
    ++loaded;
    const auto derived = derive(*changed, axioms, 3, {2000, 4000});
    draw(*changed, derived.string, axioms);
    print(*changed, derived.string);
  }
  EXPECT_GT(loaded, 300u);
}

// ------------------------------------------------------------ another rewriter

TEST(Lsystem, RandomSystemsEqualTheOtherRewriter) {
  std::mt19937 random(11);
  size_t compared = 0, modules = 0;
  for (int i = 0; i < 10000; ++i) {
    const test::PlainSystem system = test::randomSystem(random);
    Diagnostics diagnostics;
    const auto words = compile(system.text(), {}, diagnostics);
    if (!words) {
      for (const auto& d : diagnostics.sorted()) ADD_FAILURE() << format(d, "x");
      FAIL() << system.text();
    }
    const auto table = Table::load(std::as_bytes(std::span(*words)), std::pmr::new_delete_resource());
    ASSERT_TRUE(table) << table.error().text << system.text();
    auto plain = system.derive(system.iterations, 3000);
    if (!plain) continue;
    // What is cut in the last step goes as well.
    if (table->has(shader::kLsysCuts)) {
      test::PlainSystem last = system;
      last.productions.clear();
      last.axiom.clear();
      for (const auto& m : *plain) {
        test::PlainMade made{m.name, {}};
        for (const int v : m.values) made.values.push_back({-1, 0, v});
        last.axiom.push_back(made);
      }
      plain = last.derive(1, 3000);
    }
    ++compared;
    modules += plain->size();
    ASSERT_EQ(stringOf(*table, static_cast<uint32_t>(system.iterations)), test::print(*plain)) << system.text();
  }
  EXPECT_GT(compared, 7000u);
  EXPECT_GT(modules, 50000u);
}

} // namespace
} // namespace gpgp
