// Operations of .cga files in closed form: areas, volumes and counts.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wrestrict" // gcc 12 sees overlaps in sums of strings where there are none
#endif
#include "cga_run.h"

namespace gpgp::spawn::cga {
namespace {

void isSum(const Derived& d, const char* report, double value) {
  EXPECT_NEAR(d.sum(report), value, 1e-4 * (1 + std::fabs(value))) << report << d.messages;
}

Axiom polygon(std::vector<glm::vec3> points, std::vector<uint32_t> sizes) {
  Axiom axiom;
  axiom.points = std::move(points);
  axiom.loopSizes = std::move(sizes);
  return axiom;
}
/// 10 by 10 with a hole of 4 by 4 in it.
Axiom ring() {
  return polygon({{0, 0, 10}, {10, 0, 10}, {10, 0, 0}, {0, 0, 0}, {3, 0, 3}, {7, 0, 3}, {7, 0, 7}, {3, 0, 7}}, {4, 4});
}

TEST(CgaOperations, SplitAreaGivesPartsOfTheAreasAsked) {
  const char* text = R"(Lot --> splitArea(x) { 15: A | '0.25: B | ~1: C | ~2: D }
      A --> report("a", geometry.area) A.
      B --> report("b", geometry.area) B.
      C --> report("c", geometry.area) C.
      D --> report("d", geometry.area) D.)";
  const Axiom triangle = polygon({{0, 0, 0}, {0, 0, 10}, {12, 0, 3}}, {3});
  for (const auto& [axiom, area] : {std::pair{lot(8, 10), 80.0}, {ring(), 84.0}, {triangle, 60.0}}) {
    const Derived d = run(text, {axiom});
    EXPECT_EQ(d.messages, "");
    const double rest = area - 15 - area / 4;
    isSum(d, "a", 15);
    isSum(d, "b", area / 4);
    isSum(d, "c", rest / 3);
    isSum(d, "d", rest * 2 / 3);
  }
  const Derived repeated = run("Lot --> splitArea(z) { { ~20: A }* } A --> report(\"a\", geometry.area) A.");
  EXPECT_EQ(repeated.rules.at("A"), 10u);
  isSum(repeated, "a", 200);
}

TEST(CgaOperations, InnerRectangleHasARemainder) {
  const char* text =
      R"(Lot --> innerRectangle(edge) { shape: report("in", geometry.area) A. | remainder: report("out", geometry.area) B. })";
  const Derived l = run(text, {polygon({{0, 0, 0}, {0, 0, 10}, {10, 0, 10}, {10, 0, 6}, {4, 0, 6}, {4, 0, 0}}, {6})});
  EXPECT_EQ(l.messages, "");
  isSum(l, "in", 40);
  isSum(l, "out", 24);
  const Derived r = run(text, {ring()});
  EXPECT_EQ(r.messages, "");
  EXPECT_NEAR(r.sum("in") + r.sum("out"), 84, 1e-3);
}

TEST(CgaOperations, TagsAreNamesOfFacesAndEdges) {
  const Derived d = run(
      R"(Lot --> tag("plot.ground") extrude(3) comp(f) { isTagged("extrude.top"): A. | isTagged("?.side"): B. | isTagged("plot"): C. | all: D. })");
  EXPECT_EQ(d.messages, "");
  EXPECT_EQ(d.rules.at("A"), 1u);
  EXPECT_EQ(d.rules.at("B"), 4u);
  EXPECT_EQ(d.rules.at("C"), 1u);
  EXPECT_EQ(d.rules.count("D"), 0u);
  EXPECT_EQ(printed(R"(Lot --> print(geometry.isTagged("a")) tag("a") tag("b.c", edges) print(geometry.isTagged("a"))
      print(geometry.hasTags("b", faces)) print(geometry.hasTags("b")) print(geometry.tags("*")) deleteTags("a")
      print(geometry.tags()) deleteTags() print(size(geometry.tags())) NIL)"),
            (std::vector<std::string>{"false", "true", "false", "true", "[a,b.c]", "[b.c]", "0"}));
}

TEST(CgaOperations, RoofsAndComponentsKeepTheirTags) {
  const Derived d = run(
      R"(Lot --> roofGable(45) comp(f) { isTagged("roof.top"): A. | isTagged("roof.side"): B. | isTagged("roof.bottom"): C. })");
  EXPECT_EQ(d.rules.at("A"), 2u);
  EXPECT_EQ(d.rules.at("B"), 2u);
  EXPECT_EQ(d.rules.at("C"), 1u);
}

TEST(CgaOperations, BooleansOfBoxesAndPlots) {
  const char* boxes =
      R"(Lot --> OPERATION { A | B } report("v", geometry.volume) report("closed", geometry.isClosedSurface) X.
      A --> s(4, 0, 4) extrude(4)
      B --> t(2, 1, 1) s(6, 0, 2) extrude(2))";
  const auto with = [](std::string text, const std::string& operation) {
    return text.replace(text.find("OPERATION"), 9, operation);
  };
  for (const auto& [operation, volume] : {std::pair{"union", 64 + 24 - 8.0}, {"subtract", 56.0}, {"intersect", 8.0}}) {
    const Derived d = run(with(boxes, operation));
    EXPECT_EQ(d.messages, "") << operation;
    isSum(d, "v", volume);
    isSum(d, "closed", 1);
    EXPECT_EQ(d.all.leaves.size(), 1u);
  }
  const char* plots =
      R"(Lot --> OPERATION { A | B } report("a", geometry.area) report("faces", geometry.nFaces) extrude(2) report("v", geometry.volume) X.
      A --> s(6, 0, 6)
      B --> t(2, 0, 2) s(8, 0, 2))";
  for (const auto& [operation, area] : {std::pair{"union", 36 + 16 - 8.0}, {"subtract", 28.0}, {"intersect", 8.0}}) {
    const Derived d = run(with(plots, operation));
    EXPECT_EQ(d.messages, "") << operation;
    isSum(d, "a", area);
    isSum(d, "v", 2 * area);
    isSum(d, "faces", 1);
  }
  // The older form: the current shape, and a block.
  const Derived old = run("Lot --> subtract { s('0.5, '1, '1) } report(\"a\", geometry.area) X.");
  isSum(old, "a", 100);
  const Derived rule = run("Lot --> subtract Half report(\"a\", geometry.area) X.\nHalf --> s('0.5, '1, '1)");
  isSum(rule, "a", 100);
  const Derived open = run("Lot --> union { extrude(1) | t(0, 5, 0) X. } Y.");
  EXPECT_NE(open.messages.find("'union: operands") == std::string::npos ? open.messages.find("union: operands")
                                                                        : size_t{0},
            std::string::npos)
      << open.messages;
}

TEST(CgaOperations, InlinePutsShapesTogether) {
  const Derived d = run(
      R"(Lot --> inline split(x) { { 2: A | 3: NIL }* } report("a", geometry.area) report("faces", geometry.nFaces) extrude(2) report("v", geometry.volume) X.
      A --> color(1, 0, 0) A.)");
  EXPECT_EQ(d.messages, "");
  isSum(d, "a", 80);
  isSum(d, "faces", 2);
  isSum(d, "v", 160);
  EXPECT_EQ(d.all.leaves.size(), 1u);
  EXPECT_FLOAT_EQ(d.all.leaves[0].color.y, 0); // of both
  const Derived u = run(
      "Lot --> inline(unify) { A B } report(\"a\", geometry.area) X.\nA --> s(6, 0, 10)\nB --> t(4, 0, 0) s(6, 0, 10)");
  EXPECT_EQ(u.messages, "");
  isSum(u, "a", 100);
  const Derived none = run("Lot --> inline { NIL } report(\"faces\", geometry.nFaces) X.");
  isSum(none, "faces", 0);
  const Derived deep = run("Lot --> inline Lot");
  EXPECT_NE(deep.messages.find("nested more than 32 deep"), std::string::npos) << deep.messages;
}

TEST(CgaOperations, SetbackByDistancesOfEachEdge) {
  // Edges of a rectangle in their order; lot(10, 20).
  const Derived d = run(
      R"(Lot --> setback([1, 0, 2, 0]) { remainder: report("r", geometry.area) A. | all: report("s", geometry.area) B. })");
  EXPECT_EQ(d.messages, "");
  const double width = 10;
  isSum(d, "r", width * 17);
  isSum(d, "s", width * 3);
  const Derived each = run(
      R"(Lot --> setbackPerEdge(case scope.sx > 15: 1 else: 2 + comp.index * 0) { all: report("s", geometry.area) B. | remainder: report("r", geometry.area) A. })");
  EXPECT_EQ(each.messages, "");
  isSum(each, "r", 8 * 16);
  isSum(each, "s", 200 - 8 * 16);
  EXPECT_EQ(each.rules.at("B"), 4u);
}

TEST(CgaOperations, InsertAlongUvFillsUnits) {
  const char* text = R"(Lot --> setupProjection(0, scope.xz, 5, 5) projectUV(0) insertAlongUV(0, "builtin:cube", 3)
      report("area", geometry.area) report("height", scope.sy) report("x", scope.sx) X.)";
  const Derived d = run(text); // 2 by 4 cubes
  EXPECT_EQ(d.messages, "");
  isSum(d, "area", 8 * (2 * 25 + 4 * 15));
  isSum(d, "height", 3);
  isSum(d, "x", 10);
  const Derived cut = run(text, {lot(7.5f, 20)}); // half a cube in each row
  isSum(cut, "area", 2 * 150 + 4 * (4 * 15 + 2 * 7.5 + 15));
}

TEST(CgaOperations, StreetsAreWhereTheAxiomSaysSo) {
  Axiom axiom = lot(10, 20);
  axiom.streetWidths = {8, 0, 0, 0};
  const Derived d =
      run(R"(Lot --> comp(fe) { street.front: A. | street.back: B. | street.left: C. | street.right: D. } extrude(3)
      comp(f) { street.front: E. | street.side: F. | street.back: G. | all: H. })",
          {axiom});
  EXPECT_EQ(d.messages, "");
  for (const char* rule : {"A", "B", "C", "D", "E", "G"}) EXPECT_EQ(d.rules.at(rule), 1u) << rule;
  EXPECT_EQ(d.rules.at("F"), 2u);
  EXPECT_EQ(d.rules.at("H"), 2u);
  const Derived none = run("Lot --> extrude(3) comp(f) { street.front: A. }");
  EXPECT_EQ(none.rules.at("A"), 1u);
  EXPECT_NE(none.messages.find("nothing is known of streets"), std::string::npos) << none.messages;
}

TEST(CgaOperations, MirroredScopesLeaveTheGeometry) {
  EXPECT_EQ(printed(R"(Lot --> mirrorScope(true, false, true) print(scope.tx) print(scope.tz) print(scope.sx)
      t(1, 0, 2) print(scope.tx) print(scope.tz) NIL)"),
            (std::vector<std::string>{"10", "20", "10", "9", "18"}));
  const Derived one = run("Lot --> mirrorScope(true, false, false) X.");
  EXPECT_NE(one.messages.find("left-handed"), std::string::npos) << one.messages;
}

TEST(CgaOperations, OneMaterialIsOneComponent) {
  const Derived d = run("Lot --> extrude(3) comp(m) { all: report(\"v\", geometry.volume) A. }");
  EXPECT_EQ(d.messages, "");
  isSum(d, "v", 600);
  EXPECT_EQ(d.rules.at("A"), 1u);
}

} // namespace
} // namespace gpgp::spawn::cga
