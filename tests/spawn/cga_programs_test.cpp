// .cga programs as they are found: pivots, systems of axes, values that wait for each other, and what is not there.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wrestrict" // gcc 12 sees overlaps in sums of strings where there are none
#endif
#include "cga_run.h"

#include <cmath>
#include <fstream>
#include <regex>
#include <sstream>

namespace gpgp::spawn::cga {
namespace {

using Texts = std::vector<std::string>;

void isNear(const Derived& d, const char* report, double value) {
  EXPECT_NEAR(d.sum(report), value, 1e-3 * (1 + std::fabs(value))) << report << d.messages;
}

TEST(CgaPivot, PointsIntoTheScopeFromACorner) {
  // Each order and corner: the scope keeps its place and its size, seen from elsewhere.
  for (const char* order : {"xyz", "yzx", "zxy"})
    for (int corner = 0; corner < 8; ++corner) {
      const std::string at = std::string(order) + ", " + std::to_string(corner);
      const Derived d =
          run("Lot --> extrude(5) setPivot(" + at + ")\n" + R"(report("sizes", scope.sx * scope.sy * scope.sz)
              report("sum", scope.sx + scope.sy + scope.sz) report("middle", scope.elevation)
              report("x", convert(x, scope, world, pos, scope.sx / 2, scope.sy / 2, scope.sz / 2))
              report("y", convert(y, scope, world, pos, scope.sx / 2, scope.sy / 2, scope.sz / 2))
              report("z", convert(z, scope, world, pos, scope.sx / 2, scope.sy / 2, scope.sz / 2))
              report("pivot", convert(y, pivot, world, pos, 0, 0, 0)) X.)");
      EXPECT_EQ(d.messages, "") << at;
      EXPECT_NEAR(d.sum("sizes"), 10 * 5 * 20, 1e-2) << at;
      EXPECT_NEAR(d.sum("sum"), 35, 1e-3) << at;
      EXPECT_NEAR(d.sum("x"), 5, 1e-3) << at;
      EXPECT_NEAR(d.sum("y"), 2.5, 1e-3) << at;
      EXPECT_NEAR(d.sum("z"), 10, 1e-3) << at;
      EXPECT_NEAR(d.sum("pivot"), corner < 4 ? 0 : 5, 1e-3) << at;
    }
  EXPECT_NE(run("Lot --> setPivot(front, 0) X.").messages.find("takes the orders xyz, yzx and zxy"), std::string::npos);
}

TEST(CgaConvert, TurnsPlacesAndOrientations) {
  const Derived d = run(R"(Lot --> t(2, 3, 4) r(0, 90, 0)
      print(convert(scope, world, pos, [1, 0, 0])) print(convert(x, scope, world, pos, 1, 0, 0))
      report("own", convert(y, scope, scope, orient, 10, 20, 30)) report("turned", convert(y, scope, world, orient, 0, 0, 0))
      report("back", convert(y, world, scope, orient, 0, 90, 0)) X.)");
  EXPECT_EQ(d.messages, "");
  ASSERT_EQ(d.all.prints.size(), 2u);
  EXPECT_NEAR(d.sum("own"), 20, 1e-3);
  EXPECT_NEAR(std::abs(d.sum("turned")), 90, 1e-3);
  EXPECT_NEAR(d.sum("back"), 0, 1e-3);
}

TEST(CgaPrograms, AttributesMayNeedEachOtherInCases) {
  const char* text = "const chosen = case isOld: \"brick\" else: wall\nattr isOld = true\n"
                     "attr wall = case isOld: \"plaster\" else: chosen\nLot --> print(chosen + wall) X.";
  const Derived d = run(text);
  EXPECT_EQ(d.messages, "main.cga:1:7: warning: the value of 'chosen' may need itself, which is then 0\n");
  EXPECT_EQ(d.all.prints, Texts{"brickplaster"});
  Messages wrong;
  EXPECT_FALSE(compiled("attr a = b + 1\nattr b = a\nLot --> print(a) X.", wrong));
  EXPECT_NE(allOf(wrong).find("error"), std::string::npos);
}

TEST(CgaPrograms, RestDerivesWhereSomethingIsNotThere) {
  const std::map<std::string, std::string> files = {{"other.cga", "attr known = 2\nOther --> X."}};
  const Derived d = run("import o : \"other.cga\"\nLot --> extrude(2 + o.unknown + o.known) Split(1) Whole\n"
                        "Split --> A.\nWhole --> report(\"h\", scope.sy) W.",
                        {lot(10, 20)}, {}, files);
  EXPECT_NEAR(d.sum("h"), 4, 1e-4);
  EXPECT_EQ(d.rules.at("W"), 1u);
  EXPECT_EQ(d.rules.at("Split"), 1u);
  EXPECT_NE(d.messages.find("the rule 'Split' takes 0 values, not 1; shapes end there"), std::string::npos)
      << d.messages;
  EXPECT_NE(d.messages.find("'o.unknown'"), std::string::npos) << d.messages;
}

TEST(CgaPrograms, FacesOfBoxesHaveTheTagsOfWhatMadeThem) {
  const Derived d = run(R"(Lot --> extrude(3) split(x) { 4: Part | ~1: Part }
      Part --> comp(f) { isTagged("split.cut"): report("cut", geometry.area) C. | isTagged("extrude.top"): report("top", geometry.area) T.
                       | isTagged("extrude.side"): report("side", geometry.area) S. | all: B. })");
  EXPECT_EQ(d.messages, "");
  EXPECT_EQ(d.rules, (std::map<std::string, size_t>{{"B", 2}, {"C", 2}, {"S", 6}, {"T", 2}}));
  isNear(d, "cut", 2 * 20 * 3);
  isNear(d, "top", 10 * 20);
  isNear(d, "side", 60 * 3);
  // A question that is not known before it is asked.
  const Derived asked = run(R"(Lot --> extrude(3) comp(f) { isTagged("extrude" + ".top"): T. | all: B. })");
  EXPECT_EQ(asked.rules.at("T"), 1u);
}

/// What the pictures of the reference are made from: every rule that makes one derives without a word.
TEST(CgaSamples, EveryRuleOfTheOperatorsDerives) {
  std::ifstream in(std::string(GPGP_CGA_SAMPLES) + "/operators.cga");
  std::stringstream whole;
  whole << in.rdbuf();
  const std::string text = whole.str();
  const std::regex pictured("(^|\n)([A-Z][A-Za-z]+) --> Ground");
  size_t count = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), pictured), end; it != end; ++it, ++count) {
    CompileOptions options;
    options.path = "operators.cga";
    options.start = (*it)[2];
    Messages messages;
    const auto program = compile(text, options, messages);
    ASSERT_TRUE(program) << options.start << ": " << allOf(messages);
    DeriveOptions derivation;
    derivation.assetsAreFiles = false;
    derivation.loadAsset = [](const std::string&, Asset& asset, std::string&) {
      asset.positions = {{0, 0, 0}, {1, 0, 0}, {0.5f, 1, 0.5f}};
      asset.indices = {0, 1, 2};
      return true;
    };
    const Derivation all = derive(*program, {lot(24, 18, 4)}, derivation, messages);
    EXPECT_EQ(allOf(messages), "") << options.start;
    EXPECT_GE(all.leaves.size(), 2u) << options.start;
  }
  EXPECT_GE(count, 30u);
}

} // namespace
} // namespace gpgp::spawn::cga
