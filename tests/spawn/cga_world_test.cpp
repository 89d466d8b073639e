// What .cga files read of the world around a shape: fields, edges of the axiom, places on the globe, labelled shapes.
// And parts of perimeters, names of assets, defaults of materials, annotations that reach further.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wrestrict" // gcc 12 sees overlaps in sums of strings where there are none
#endif
#include "cga_run.h"
#include "spawn/cga/attributes.h"

#include <cmath>
#include <functional>
#include <random>

namespace gpgp::spawn::cga {
namespace {

using Texts = std::vector<std::string>;

void isSum(const Derived& d, const char* report, double value) {
  EXPECT_NEAR(d.sum(report), value, 1e-4 * (1 + std::fabs(value))) << report << d.messages;
}

/// Values on a grid over x and z from -100 to 100.
struct Grid {
  static constexpr uint32_t kSize = 41;
  std::vector<float> values;
  WorldField field;
  Grid(const std::string& name, const std::function<float(float x, float z)>& value) {
    for (uint32_t row = 0; row < kSize; ++row)
      for (uint32_t column = 0; column < kSize; ++column)
        values.push_back(value(-100 + 5.0f * static_cast<float>(column), -100 + 5.0f * static_cast<float>(row)));
    field = {name, {-100, -100, 0.2f, 0.2f, kSize, kSize, 0, 0}, values.data()};
  }
};

TEST(CgaFields, AreReadAtTheMiddleOfAShapeOrBesideIt) {
  // Planes are themselves between the values of a grid.
  const Grid slope("slope", [](float x, float z) { return 3 + 0.5f * x - 0.25f * z; });
  DeriveOptions options;
  options.fields = {slope.field};
  const char* text = R"(Lot --> report("middle", Field("slope")) report("beside", Field("slope", 2, -4))
      t(10, 0, 0) report("moved", Field("slope")) split(x) { 4: Part("left") | ~1: Part("right") }
      Part(name) --> report(name, Field("slope")) X.)";
  Axiom axiom = lot(10, 20);
  axiom.origin = {6, 0, -8}; // its middle is (11, 2)
  const Derived d = run(text, {axiom}, options);
  EXPECT_EQ(d.messages, "");
  const auto plane = [](double x, double z) { return 3 + 0.5 * x - 0.25 * z; };
  isSum(d, "middle", plane(11, 2));
  isSum(d, "beside", plane(13, -2));
  isSum(d, "moved", plane(21, 2));
  isSum(d, "left", plane(18, 2));
  isSum(d, "right", plane(23, 2));
  // A turned axiom: its x axis is the world's -z.
  Axiom turned = lot(10, 20);
  turned.axisX = {0, 0, -1};
  turned.axisZ = {1, 0, 0};
  const Derived t = run(text, {turned}, options);
  isSum(t, "middle", plane(10, -5));
  isSum(t, "beside", plane(10 - 4, -5 - 2));
}

TEST(CgaFields, GiveAttributesTheirValuesUnlessSomethingElseDoes) {
  const Grid height("height", [](float x, float) { return 10 + 0.1f * x; });
  DeriveOptions options;
  options.fields = {height.field};
  const char* text = "attr height = 3\nattr twice = 2 * height\nconst fixed = 7\n"
                     "Lot --> report(\"h\", height) report(\"t\", twice) X.";
  Axiom far = lot(10, 10);
  far.origin = {35, 0, 0};
  isSum(run(text, {far}, options), "h", 14);
  isSum(run(text, {far}, options), "t", 28);
  Axiom own = far;
  own.attributes = {{"height", "5"}};
  isSum(run(text, {own}, options), "h", 5);
  options.attributes = {{"height", "6"}};
  isSum(run(text, {own}, options), "h", 6);
  isSum(run(text, {far}), "h", 3);
}

TEST(CgaFields, WhatIsMissingIsNamed) {
  Messages messages;
  const auto program =
      compiled("Lot -->\n  case Field(\"watr\") > 0: NIL else: extrude(Field(\"x\" + \"y\"))", messages);
  ASSERT_TRUE(program) << allOf(messages);
  ASSERT_EQ(program->fields.size(), 1u); // the other has no name before it runs
  const Grid water("water", [](float, float) { return 1.0f; });
  EXPECT_EQ(missingField(*program, {water.field}),
            "main.cga:2:8: field \"watr\" is read, and is not among the fields; did you mean 'water'?");
  const Derived d = run("Lot --> extrude(2 + Field(\"a\" + \"b\")) report(\"y\", scope.sy) X.");
  isSum(d, "y", 2);
  EXPECT_NE(d.messages.find("1:21: warning: there is no field \"ab\", and it is 0"), std::string::npos) << d.messages;
  Messages wrong;
  EXPECT_FALSE(compiled("Lot --> extrude(Field(\"a\", 1))", wrong));
  EXPECT_NE(allOf(wrong).find("takes the name of a field, or that, x and z"), std::string::npos) << allOf(wrong);
}

// ---------------------------------------------------------------- perimeters

TEST(CgaPerimeter, PartsHaveDepthsOfTheirOwn) {
  const Derived d = run(R"(Lot --> splitAndSetbackPerimeter(0) {
        10: 2: A | '0.5: split.index + 2: B | ~1: 0: NIL | 4: 1: report("last", split.index) C }
      { remainder: report("r", geometry.area) R. }
      A --> report("a", geometry.area) A.
      B --> report("b", geometry.area) report("total", split.total) B.
      C --> report("c", geometry.area) C.)");
  EXPECT_EQ(d.messages, "");
  // Of 60 metres: 10, 30, 16, 4. The corner between the first two is the deeper one's.
  isSum(d, "a", 10 * 2 - 3 * 2);
  isSum(d, "b", 20 * 3 + 10 * 3 - 3 * 3);
  isSum(d, "c", 4 - 2); // the first 2 metres of the last side lie within A's strip
  isSum(d, "last", 3);
  isSum(d, "total", 4);
  isSum(d, "r", 200 - 14 - 81 - 2);
  EXPECT_EQ(d.rules.at("R"), 1u);
}

TEST(CgaPerimeter, PatternsRepeatAndBeginAnywhere) {
  const Derived d =
      run(R"(Lot --> splitAndSetbackPerimeter('0.05) { ~7: 1.5: A }* { remainder: report("r", geometry.area) R. }
      A --> report("a", geometry.area) A.)");
  EXPECT_EQ(d.messages, "");
  EXPECT_EQ(d.rules.at("A"), 9u); // 60 / 7 is nearest to 9 parts... of 6.67 metres
  isSum(d, "r", 7 * 17);
  isSum(d, "a", 200 - 7 * 17);
  // The two long sides alone, the second first.
  const Derived some = run(R"(sides = comp(fe) { all: scope.sx > 15 }
      Lot --> splitAndSetbackPerimeter(0, 3, sides) { 5: 4: A | ~1: 0: NIL } { remainder: report("r", geometry.area) R. }
      A --> report("a", geometry.area) report("x", scope.sx) report("z", scope.sz) A.)");
  EXPECT_EQ(some.messages, "");
  isSum(some, "a", 20);
  isSum(some, "r", 180);
  const Derived bare = run("Lot --> splitAndSetbackPerimeter(3) { 2: 6: A. | 2: 0: NIL | 2: 4: A. } { remainder: R. }");
  EXPECT_EQ(bare.messages, "");
  EXPECT_EQ(bare.rules.at("A"), 2u);
  Messages wrong;
  EXPECT_FALSE(compiled("Lot --> splitAndSetbackPerimeter(3) { 2: 6: A }", wrong));
  EXPECT_NE(allOf(wrong).find("{ remainder : ... } behind the parts"), std::string::npos) << allOf(wrong);
  EXPECT_FALSE(compiled("Lot --> splitAndSetbackPerimeter(3) { 2: 6: A } { all: B }", wrong));
  EXPECT_NE(allOf(wrong).find("the second block of splitAndSetbackPerimeter"), std::string::npos) << allOf(wrong);
}

TEST(CgaPerimeter, DepthsAreDrawnForEachPart) {
  const char* text = R"(Lot --> splitAndSetbackPerimeter(0) { ~5: rand(1, 3): A }* { remainder: R. }
      A --> print(scope.sx * scope.sz) A.)";
  const Derived one = run(text), again = run(text);
  ASSERT_GE(one.all.prints.size(), 8u);
  EXPECT_EQ(one.all.prints, again.all.prints);
  EXPECT_NE(one.all.prints[0], one.all.prints[1]);
}

// ---------------------------------------------------------------- edges of the axiom

Axiom rectangleWithEdges() {
  Axiom axiom;
  axiom.points = {{0, 0, 10}, {20, 0, 10}, {20, 0, 0}, {0, 0, 0}}; // front, right, back, left
  axiom.loopSizes = {4};
  axiom.edgeAttributes = {{"side", {"front", "right", "back", "left"}, true},
                          {"width", {"8", "4", "2", "1"}, false},
                          {"open", {"true", "false", "false", "true"}, false}};
  return axiom;
}

TEST(CgaEdgeAttributes, AreThoseOfTheEdgeThatAShapeFaces) {
  const Axiom axiom = rectangleWithEdges();
  const Derived d = run(R"(Lot --> comp(fe) { all: Edge } extrude(5) comp(f) { side: Face }
      Edge --> print(edgeAttr.getString("side") + " " + edgeAttr.getFloat("width")) NIL
      Face --> report(edgeAttr.getString("side"), geometry.area)
               report("open", case edgeAttr.getBool("open"): scope.sx else: 0) NIL)",
                        {axiom});
  EXPECT_EQ(d.messages, "");
  EXPECT_EQ(d.all.prints, (Texts{"front 8", "right 4", "back 2", "left 1"}));
  isSum(d, "front", 100);
  isSum(d, "back", 100);
  isSum(d, "left", 50);
  isSum(d, "right", 50);
  isSum(d, "open", 30);
  // Parts of a face, and a volume inside: the edge that is before them.
  const Derived parts =
      run(R"(Lot --> s(8, 0, 4) center(xz) extrude(3) comp(f) { front: split(x) { ~1: P }* | right: P | back: P }
      P --> print(edgeAttr.getString("side")) NIL)",
          {axiom});
  EXPECT_EQ(parts.all.prints,
            (Texts{"right", "back", "front", "front", "front", "front", "front", "front", "front", "front"}));
  // What is not there, or has another type, is nothing.
  EXPECT_EQ(
      run(R"(Lot --> comp(fe) { 0: print(edgeAttr.getString("none") + edgeAttr.getFloat("side") + edgeAttr.getBool("width")) NIL })",
          {axiom})
          .all.prints,
      Texts{"0false"});
}

TEST(CgaEdgeAttributes, SetDistancesAndTags) {
  const Axiom axiom = rectangleWithEdges();
  const Derived d =
      run(R"(Lot --> setbackPerEdge(edgeAttr.getFloat("width") / 4) { remainder: report("r", geometry.area) R. })",
          {axiom});
  EXPECT_EQ(d.messages, "");
  isSum(d, "r", (20 - 1 - 0.25) * (10 - 2 - 0.5));
  const Derived tagged = run(
      R"(Lot --> setTagsFromEdgeAttrs() comp(fe) { isTagged("edgeattr.side.front"): A. | isTagged("edgeattr.side"): B. }
      extrude(2) comp(f) { isTagged("edgeattr.side.left"): report("left", geometry.area) C. | isTagged("edgeattr.width"): D. })",
      {axiom});
  EXPECT_EQ(tagged.messages, "");
  EXPECT_EQ(tagged.rules.at("A"), 1u);
  EXPECT_EQ(tagged.rules.at("B"), 3u);
  EXPECT_EQ(tagged.rules.at("C"), 1u);
  isSum(tagged, "left", 20);
  EXPECT_EQ(tagged.rules.count("D"), 0u); // numbers make no tags
}

/// Random convex polygons: the side faces of the prism over one, in whatever order comp gives them, have the values of
/// the edges whose lengths they have.
TEST(CgaEdgeAttributes, FacesOfRandomPrismsHaveTheirEdges) {
  std::mt19937 random(3);
  for (int i = 0; i < 60; ++i) {
    Axiom axiom;
    const uint32_t n = 3 + static_cast<uint32_t>(random() % 8);
    EdgeAttribute length{"length", {}, false};
    for (uint32_t k = 0; k < n; ++k) {
      const float a = (static_cast<float>(k) + 0.6f * static_cast<float>(random() % 1000) / 1000.0f) * 6.2831853f /
                      static_cast<float>(n);
      axiom.points.push_back({12 * std::cos(a), 0, -9 * std::sin(a)});
    }
    axiom.loopSizes = {n};
    for (uint32_t k = 0; k < n; ++k)
      length.values.push_back(std::to_string(glm::length(axiom.points[(k + 1) % n] - axiom.points[k])));
    axiom.edgeAttributes = {length};
    const Derived d = run(
        R"(Lot --> extrude(2) comp(f) { side: report("wrong", case abs(edgeAttr.getFloat("length") - scope.sx) < 0.001: 0 else: 1)
                             report("n", 1) NIL })",
        {axiom});
    EXPECT_EQ(d.messages, "") << i;
    isSum(d, "wrong", 0);
    isSum(d, "n", n);
  }
}

// ---------------------------------------------------------------- places and ranks

TEST(CgaWorld, GeographicPlacesAreThoseOfTheScopesOrigin) {
  DeriveOptions options;
  options.origin = GeographicPlace{8.5, 47.25};
  Axiom axiom = lot(1, 1);
  axiom.origin = {1000, 5, -2000};
  const char* text = R"(Lot --> report("x", getGeoCoord(x)) report("y", getGeoCoord(y)) report("lon", getGeoCoord(lon))
      report("lat", getGeoCoord(lat)) X.)";
  const Derived d = run(text, {axiom}, options);
  EXPECT_EQ(d.messages, "");
  isSum(d, "x", 1000);
  isSum(d, "y", 2000);
  EXPECT_NEAR(d.sum("lat"), 47.25 + 2000 / 111319.490793, 1e-5);
  EXPECT_NEAR(d.sum("lon"), 8.5 + 1000 / (111319.490793 * std::cos(47.25 * 3.14159265358979 / 180)), 1e-5);
  const Derived unknown = run(text, {axiom});
  isSum(unknown, "y", 2000);
  isSum(unknown, "lat", 0);
  EXPECT_NE(unknown.messages.find("nothing is known of where the world's origin lies"), std::string::npos);
}

TEST(CgaWorld, RanksAmongLabelledShapes) {
  const Derived d = run(R"(Lot --> split(x) { 1: Tower(4) | 2: Tower(9) | 3: Tower(2) | 4: Tower(7) }
      Tower(h) --> extrude(h) label("tower") Rank(h)
      Rank(h) --> print(h + ": " + contextCompare(intra, "tower", world.highest) + contextCompare(intra, "tower", world.westernmost)
          + contextCompare(intra, "tower", world.easternmost) + contextCompare(intra, "tower", area.largest)
          + contextCompare(intra, "tower", world.lowest) + contextCompare(intra, "none", area.largest)) NIL)");
  EXPECT_EQ(d.messages, "");
  // Areas: 208, 476, 212, 496.
  EXPECT_EQ(d.all.prints, (Texts{"4: 203300", "9: 012100", "2: 321200", "7: 130000"}));
}

// ---------------------------------------------------------------- assets, materials, lists, annotations

TEST(CgaAssets, NamesAreThoseOfTheFile) {
  DeriveOptions options;
  options.assetsAreFiles = false;
  options.loadAsset = [](const std::string& path, Asset& asset, std::string& why) {
    why = "no such asset";
    if (!path.ends_with("tree.obj")) return false;
    asset.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    asset.indices = {0, 1, 2};
    asset.groups = {"crown", "trunk"};
    asset.materials = {"bark"};
    return true;
  };
  const Derived d = run(R"(Lot --> print(assetNamingInfo("tree.obj", g)) print(assetNamingInfos("tree.obj", m))
      print(size(assetNamingInfos("tree.obj", g))) print(findFirst(assetNamingInfos("tree.obj", g), "trunk"))
      print(assetMetadata("tree.obj", "height", 5)) print(assetNamingInfo("other.obj", g) + "|") NIL)",
                        {lot(1, 1)}, options);
  EXPECT_EQ(d.all.prints, (Texts{"crown;trunk;", "[bark]", "2", "1", "5", "|"}));
  EXPECT_NE(d.messages.find("nothing is known of the asset \"other.obj\""), std::string::npos) << d.messages;
}

TEST(CgaMaterials, HaveDefaultsAndAColourInOneText) {
  EXPECT_EQ(
      printed(R"(Lot --> print(material.shader + " " + material.roughness + " " + material.opacitymap.cutoff + " " +
          material.colormap.su + " " + material.dirtmap + "|" + material.opacitymap.mode)
      set(material.roughness, 0.25) print(material.roughness) set(material.color.rgb, "#ff0080") print(material.color.r)
      print(material.color.rgb) setMaterial(["color.rgb", "#00ff00"; "shader", "mine"]) print(material.color.rgb + material.shader) NIL)"),
      (Texts{"CityEngineShader 1 0.5 1 |blend", "0.25", "1", "#ff0080", "#00ff00mine"}));
}

TEST(CgaLists, BecomeArraysAndBack) {
  EXPECT_EQ(printed(R"(front = "top"
      Lot --> print(listToArray("a;b;;c")) print(listFromArray(["x", "y"])) print(listCount("a;b;a;", "a"))
      print(listTerminate("a;b")) print(listTerminate("a;")) extrude(2) comp(f) { sel(front): print(scope.sy) NIL } NIL)"),
            (Texts{"[a,b,c]", "x;y;", "2", "a;b;", "a;", "20"}));
}

TEST(CgaAnnotations, HoldForWhatTheyAreSaidOf) {
  const std::map<std::string, std::string> files = {{"a.cga", "attr x = 1\nattr y = 2\nA --> X."},
                                                    {"b.cga", "attr z = 3\nB --> X."}};
  Messages messages;
  const auto program = compiled(R"(@Group("Size", 2) @DisplayName("Building height") @Distance
attr height = 9
attr width = 4
@Group
@Enum(valuesAttr = styles, restricted = false)
attr style = styles[1]
attr styles = ["old", "new"]
@File("obj", "glb") attr asset = "a.obj"
@Angle attr angle = 30
@Percent @Range(min=0.2, max=0.5) attr part = 0.3
@MaterialFile attr wall = "brick.cgamat"
@Hidden(x)
import a : "a.cga"
@Hidden
import b : "b.cga"
Lot --> extrude(height) X.)",
                                messages, files);
  ASSERT_TRUE(program) << allOf(messages);
  std::map<std::string, ListedAttribute> all;
  for (const ListedAttribute& a : listAttributes(*program)) all.insert({a.info->name, a});
  ASSERT_EQ(all.size(), 11u);
  EXPECT_EQ(all.at("height").display.groups, Texts{"Size"});
  EXPECT_EQ(all.at("height").display.name, "Building height");
  EXPECT_EQ(all.at("width").display.groups, Texts{"Size"});
  EXPECT_EQ(all.at("width").display.groupOrder, 2);
  EXPECT_TRUE(all.at("style").display.groups.empty());
  EXPECT_EQ(all.at("style").display.choices, (Texts{"old", "new"}));
  EXPECT_EQ(all.at("style").value.text, "new");
  EXPECT_EQ(all.at("asset").display.extensions, (Texts{"obj", "glb"}));
  EXPECT_EQ(all.at("angle").display.max, 360);
  EXPECT_TRUE(all.at("angle").display.flags & GPGP_CGA_ATTRIBUTE_UNRESTRICTED);
  EXPECT_EQ(all.at("part").display.min, 0.2);
  EXPECT_FALSE(all.at("part").display.flags & GPGP_CGA_ATTRIBUTE_UNRESTRICTED);
  EXPECT_TRUE(all.at("wall").display.flags & GPGP_CGA_ATTRIBUTE_MATERIAL_FILE);
  const auto isHidden = [&](const char* name) { return (all.at(name).display.flags & GPGP_CGA_ATTRIBUTE_HIDDEN) != 0; };
  EXPECT_TRUE(isHidden("a.x"));
  EXPECT_FALSE(isHidden("a.y"));
  EXPECT_TRUE(isHidden("b.z"));
}

} // namespace
} // namespace gpgp::spawn::cga
