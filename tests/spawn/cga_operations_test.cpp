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

TEST(CgaOperations, AnAttributeMayTakeItsValueFromAnImport) {
  // The import's attribute of that name stays its own, or the value would need itself.
  const Derived d = run("import zone : \"zone.cga\"\nattr height = zone.height\nattr width = 2\n"
                        "Lot --> report(\"h\", height) report(\"z\", zone.height) report(\"w\", zone.width) X.",
                        {lot(10, 20)}, {}, {{"zone.cga", "attr height = 7\nattr width = 1\nA --> X."}});
  EXPECT_EQ(d.messages, "");
  isSum(d, "h", 7);
  isSum(d, "z", 7);
  isSum(d, "w", 2); // the importer's
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

TEST(CgaOperations, WhatIsInsertedIntoARoofsFaceEndsAtItsHips) {
  const Derived d = run(R"(Lot --> roofHip(45) comp(f) { isTagged("roof.top"): Face | all: NIL }
      Face --> case geometry.nVertices == 3: s('1, '1, 1) primitiveCube report("v", geometry.volume) A.
               else: NIL)");
  EXPECT_EQ(d.messages, "");
  EXPECT_EQ(d.rules.at("A"), 2u);
  // Along the slope u and outwards w the face is 10 - 2 max(0, (u - w) / sqrt(2)) wide between the hips' planes.
  const double l = 5 * std::sqrt(2.0);
  isSum(d, "v", 2 * (10 * l - std::sqrt(0.5) * (l * l * l - (l - 1) * (l - 1) * (l - 1)) / 3));
  const Derived off =
      run(R"(Lot --> roofHip(45) set(trim.vertical, false) comp(f) { isTagged("roof.top"): Face | all: NIL }
      Face --> case geometry.nVertices == 3: s('1, '1, 1) primitiveCube report("v", geometry.volume) A.
               else: NIL)");
  isSum(off, "v", 2 * 10 * l);
}

TEST(CgaOperations, TrimCutsWhatWasWidened) {
  const char* text = R"(Lot --> roofHip(45) comp(f) { isTagged("roof.top"): Face | all: NIL }
      Face --> case geometry.nVertices == 3: extrude(1) s('3, '1, '1) center(x) %TRIM% report("v", geometry.volume) A.
               else: NIL)";
  const auto volume = [&](const std::string& trim) {
    std::string t = text;
    t.replace(t.find("%TRIM%"), 6, trim);
    return run(t).sum("v");
  };
  const double l = 5 * std::sqrt(2.0);
  EXPECT_NEAR(volume(""), 2 * 3 * 5 * l, 1e-3);
  EXPECT_LT(volume("trim()"), 0.5 * volume(""));
  EXPECT_GT(volume("trim()"), 2 * 5 * l * 0.99);
}

TEST(CgaOperations, NormalsAreSoftBelowAnAngle) {
  DeriveOptions options;
  options.keepTriangles = true;
  const auto normals = [&](const std::string& operation) {
    return run("Lot --> primitiveCube() " + operation + " A.", {lot(4, 4)}, options).all.vertices;
  };
  for (const Vertex& v : normals("setNormals(soft)"))
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(std::fabs(v.normal[axis]), std::sqrt(1.0 / 3), 1e-5);
  for (const Vertex& v : normals("softenNormals(89)"))
    EXPECT_NEAR(std::fabs(v.normal.x) + std::fabs(v.normal.y) + std::fabs(v.normal.z), 1, 1e-5);
}

TEST(CgaOperations, FootprintsAreUnionsOfShadows) {
  const std::vector<glm::vec3> l{{0, 0, 0}, {0, 0, 10}, {10, 0, 10}, {10, 0, 6}, {4, 0, 6}, {4, 0, 0}};
  const char* text = R"(Lot --> extrude(3) HIP footprint() report("a", geometry.area) extrude(1)
      report("v", geometry.volume) A.)";
  std::string plain = text;
  plain.erase(plain.find("HIP"), 3);
  const Derived d = run(plain, {polygon(l, {6})});
  EXPECT_EQ(d.messages, "");
  isSum(d, "a", 64);
  isSum(d, "v", 64);
  const Derived ball = run("Lot --> primitiveSphere(32, 16) s(4, 7, 4) footprint() report(\"a\", geometry.area) A.");
  isSum(ball, "a", 16 * 2 * 2 * std::sin(2 * 3.14159265358979 / 32));
  const Derived box = run("Lot --> extrude(4) footprint() report(\"a\", geometry.area) A.");
  isSum(box, "a", 200);
}

TEST(CgaOperations, ARidgeIsOverTheMiddle) {
  const char* text =
      R"(Lot --> %ROOF% report("v", geometry.volume) report("closed", case geometry.isClosedSurface: 1 else: 0)
      comp(f) { isTagged("roof.top"): T. | isTagged("roof.side"): S. | isTagged("roof.bottom"): B. })";
  const auto with = [&](const std::string& roof) {
    std::string t = text;
    return t.replace(t.find("%ROOF%"), 6, roof);
  };
  const Derived d = run(with("roofRidge(byHeight, 4)"));
  EXPECT_EQ(d.messages, "");
  isSum(d, "v", 10 * 20 * 4 / 2);
  isSum(d, "closed", 1);
  EXPECT_EQ(d.rules.at("T"), 2u);
  EXPECT_EQ(d.rules.at("S"), 2u);
  EXPECT_EQ(d.rules.at("B"), 1u);
  // Of an L whose first edge, which is the ridge's direction, is along z: the integral of min(x, 10 - x) times the
  // extent along z, 10 below x = 4 and 4 above.
  const Derived l = run(with("roofRidge(byAngle, 45)"),
                        {polygon({{0, 0, 0}, {0, 0, 10}, {10, 0, 10}, {10, 0, 6}, {4, 0, 6}, {4, 0, 0}}, {6})});
  isSum(l, "v", 80 + 18 + 50);
  isSum(l, "closed", 1);
}

TEST(CgaOperations, FacesAreModifiedInPlace) {
  const Derived d = run(R"(Lot --> extrude(2) modify(f) { top: s('0.5, '0.5, '1) A. } report("n", geometry.nFaces)
      report("a", geometry.area) B.)");
  EXPECT_EQ(d.messages, "");
  EXPECT_EQ(d.rules.at("B"), 1u);
  EXPECT_EQ(d.rules.count("A"), 0u);
  isSum(d, "n", 6);
  isSum(d, "a", 200 + 2 * 2 * 30 + 50);
}

TEST(CgaOperations, ConnectedComponentsAreShapes) {
  const Derived d = run("Lot --> extrude(3) comp(f) { horizontal =: A. | side =: B. }");
  EXPECT_EQ(d.rules.at("A"), 2u);
  EXPECT_EQ(d.rules.at("B"), 1u);
}

TEST(CgaOperations, MaterialsAreSetAsAWhole) {
  const Derived d =
      run(R"(Lot --> setMaterial(["color.r", "0.5"; "color.g", "0"; "colormap", "a.png"; "roughness", "1"])
      print(material.color.r) print(material.color.g) print(material.colormap) print(material.roughness)
      print(getMaterial(used, changed)) resetMaterial() print(size(getMaterial(used, changed))) A.)");
  EXPECT_EQ(d.messages, "");
  EXPECT_EQ(d.all.prints, (std::vector<std::string>{"0.5", "0", "a.png", "1",
                                                    "[color.b,1;color.g,0;color.r,0.5;colormap,a.png]", "0"}));
}

} // namespace
} // namespace gpgp::spawn::cga
