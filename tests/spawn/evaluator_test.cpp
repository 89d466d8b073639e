// The CPU evaluator against published counts and against closed forms.
#include "grammars.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/shared/graph_format.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <set>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using spawn::derive;
using spawn::makeAxiom;

uint64_t countOf(const std::string& text, const GpgpAxiom& axiom) {
  const auto words = bake(text);
  const spawn::Derivation d = derive(words, std::span(&axiom, 1));
  EXPECT_EQ(d.unfinishedShapes, 0u);
  EXPECT_TRUE(d.complete);
  return d.terminals;
}

TEST(GivenGrammars, MengerSponge) {
  const auto text = sharedGrammar("menger_sponge_3.pga");
  if (!text) GTEST_SKIP() << "menger_sponge_3.pga is not in the shared data folder";
  EXPECT_EQ(countOf(*text, makeAxiom(1, 1, 1)), 400u);
  EXPECT_EQ(countOf(replaced(*text, "0.333", "0.111"), makeAxiom(1, 1, 1)), 8000u);
  EXPECT_EQ(countOf(replaced(*text, "0.333", "1"), makeAxiom(27, 27, 27)), 160000u);
}

TEST(GivenGrammars, Trees) {
  const auto small = sharedGrammar("3d_tree_4_3.pga");
  if (!small) GTEST_SKIP() << "3d_tree_4_3.pga is not in the shared data folder";
  const auto large = sharedGrammar("3d_tree_8_3.pga");
  if (!large) GTEST_SKIP() << "3d_tree_8_3.pga is not in the shared data folder";
  EXPECT_EQ(countOf(*small, makeAxiom(16, 16, 16)), 283u);
  EXPECT_EQ(countOf(*large, makeAxiom(16, 16, 16)), 22963u);
}

std::vector<GpgpAxiom> axioms(uint32_t count, float x, float y, float z) {
  std::vector<GpgpAxiom> result;
  for (uint32_t i = 0; i < count; ++i) result.push_back(makeAxiom(x, y, z, i * 2654435761u + 1, i));
  return result;
}

TEST(GivenGrammars, Balcony) {
  const auto text = sharedGrammar("balcony.pga");
  if (!text) GTEST_SKIP() << "balcony.pga is not in the shared data folder";
  const auto d = derive(bake(*text), axioms(256, 24, 34, 24));
  EXPECT_EQ(d.terminals, 103424u);
}

TEST(GivenGrammars, CommercialDependsOnSeeds) {
  const auto text = sharedGrammar("commercial.pga");
  if (!text) GTEST_SKIP() << "commercial.pga is not in the shared data folder";
  const auto d = derive(bake(*text), axioms(256, 30, 45, 30));
  EXPECT_GT(d.terminals, 130000u);
  EXPECT_LT(d.terminals, 150000u);
}

TEST(GivenGrammars, SkyscraperDependsOnSeeds) {
  const auto text = sharedGrammar("mc_skyscraper.pga");
  if (!text) GTEST_SKIP() << "mc_skyscraper.pga is not in the shared data folder";
  std::vector<GpgpAxiom> all;
  for (uint32_t i = 0; i < 64; ++i)
    all.push_back(
        makeAxiom(16 + float(i % 4) * 4, 45 + float(i % 8) * 5, 16 + float(i / 8 % 4) * 4, i * 2654435761u + 1, i));
  const auto d = derive(bake(*text), all);
  EXPECT_GT(d.terminals / 64, 1000u);
  EXPECT_LT(d.terminals / 64, 12000u);
  for (const GpgpInstance& instance : d.instances)
    for (const float v : instance.transform) ASSERT_TRUE(std::isfinite(v));
}

// ---------------------------------------------------------------- closed forms

struct Box {
  float position[3], size[3];
};
Box boxOf(const GpgpInstance& i) {
  return {{i.transform[3], i.transform[7], i.transform[11]}, {i.size[0], i.size[1], i.size[2]}};
}
spawn::Derivation derived(const std::string& rules, const GpgpAxiom& axiom, const std::string& shape = "Box") {
  return derive(bake("axiom " + shape + " A; terminal T U V W (1,0); " + rules), std::span(&axiom, 1));
}

TEST(Operators, SubDivSharesTheRemainderByWeight) {
  const auto d = derived("A = SubDiv(X) { 2: T | -1: U | 0: V | -3: W };", makeAxiom(10, 1, 1));
  ASSERT_EQ(d.terminals, 3u);
  const float expected[3][2] = {{-4, 2}, {-2, 2}, {2, 6}};
  for (int i = 0; i < 3; ++i) {
    EXPECT_FLOAT_EQ(boxOf(d.instances[i]).position[0], expected[i][0]);
    EXPECT_FLOAT_EQ(boxOf(d.instances[i]).size[0], expected[i][1]);
    EXPECT_FLOAT_EQ(d.instances[i].transform[0], expected[i][1]);
  }
}

TEST(Operators, SubDivSkipsWeightsWithoutRemainder) {
  EXPECT_EQ(derived("A = SubDiv(X) { 5: T | -1: U | 6: V };", makeAxiom(10, 1, 1)).terminals, 2u);
}

TEST(Operators, RepeatCounts) {
  const auto repeat = [](float size, const char* arguments) {
    std::vector<Box> boxes;
    for (const auto& i : derived("A = Repeat(X," + std::string(arguments) + ") T;", makeAxiom(size, 1, 1)).instances)
      boxes.push_back(boxOf(i));
    return boxes;
  };
  const auto fill = repeat(10, "3,ADJUST_TO_FILL");
  ASSERT_EQ(fill.size(), 3u);
  EXPECT_FLOAT_EQ(fill[0].size[0], 10.0f / 3);
  EXPECT_NEAR(fill[0].position[0], -10.0f / 3, 1e-5);
  const auto start = repeat(10, "3,ANCHOR_TO_START");
  ASSERT_EQ(start.size(), 4u);
  EXPECT_FLOAT_EQ(start[3].size[0], 1);
  EXPECT_FLOAT_EQ(start[3].position[0], 4.5f);
  const auto end = repeat(10, "3,ANCHOR_TO_END");
  ASSERT_EQ(end.size(), 4u);
  EXPECT_FLOAT_EQ(end[0].size[0], 1);
  EXPECT_FLOAT_EQ(end[0].position[0], -4.5f);
  EXPECT_FLOAT_EQ(end[1].position[0], -2.5f);
  EXPECT_EQ(repeat(9, "3,ANCHOR_TO_START").size(), 3u);
  EXPECT_EQ(repeat(2, "3,ADJUST_TO_FILL").size(), 1u);
  EXPECT_EQ(repeat(10, "-0.25,ADJUST_TO_FILL").size(), 4u);
  EXPECT_EQ(repeat(0.7f, "0.1,ADJUST_TO_FILL").size(), 7u); // 0.7 / 0.1 is just below 7
  EXPECT_EQ(repeat(10, "0,ADJUST_TO_FILL").size(), 0u);
}

TEST(Operators, FacesOfABoxLookOutwards) {
  const auto d = derived("A = CompSplit() { T | U | V };", makeAxiom(2, 4, 6));
  ASSERT_EQ(d.terminals, 6u);
  // top, bottom, back, front, left, right
  const float normal[6][3] = {{0, 1, 0}, {0, -1, 0}, {0, 0, -1}, {0, 0, 1}, {-1, 0, 0}, {1, 0, 0}};
  const float size[6][2] = {{2, 6}, {2, 6}, {2, 4}, {2, 4}, {6, 4}, {6, 4}};
  const float extent[3] = {2, 4, 6};
  for (int f = 0; f < 6; ++f) {
    const GpgpInstance& i = d.instances[f];
    for (int r = 0; r < 3; ++r) {
      EXPECT_FLOAT_EQ(i.transform[4 * r + 2], normal[f][r]) << f;
      EXPECT_FLOAT_EQ(i.transform[4 * r + 3], normal[f][r] * extent[r] / 2) << f;
    }
    EXPECT_FLOAT_EQ(i.size[0], size[f][0]);
    EXPECT_FLOAT_EQ(i.size[1], size[f][1]);
    EXPECT_EQ(i.shape, uint32_t(GPGP_SHAPE_QUAD));
    // a right-handed frame: x cross y is z
    const float* t = i.transform;
    const float x[3] = {t[0], t[4], t[8]}, y[3] = {t[1], t[5], t[9]}, z[3] = {t[2], t[6], t[10]};
    for (int r = 0; r < 3; ++r) {
      const int a = (r + 1) % 3, b = (r + 2) % 3;
      EXPECT_FLOAT_EQ(x[a] * y[b] - x[b] * y[a], z[r] * i.size[0] * i.size[1]) << f;
    }
  }
}

TEST(Operators, SidesOfPrismsCloseTheirPolygon) {
  for (const char* shape : {"Prism3", "Prism5", "Prism6", "Prism7", "Prism8"}) {
    const auto d = derived("A = CompSplit() { Discard() | Discard() | T };", makeAxiom(3, 2, 5), shape);
    ASSERT_EQ(d.terminals, uint32_t(shape[5] - '0'));
    double sum[3] = {}, area = 0;
    for (const GpgpInstance& i : d.instances) {
      for (int r = 0; r < 3; ++r) sum[r] += i.transform[4 * r + 2] * i.size[0];
      double outward = 0;
      for (int r = 0; r < 3; ++r) outward += i.transform[4 * r + 2] * i.transform[4 * r + 3];
      EXPECT_GT(outward, 0) << shape;
      area += outward * i.size[0] / 2;
      EXPECT_FLOAT_EQ(i.size[1], 2);
    }
    for (const double s : sum) EXPECT_NEAR(s, 0, 1e-5) << shape; // closed: normals times lengths cancel
    EXPECT_GT(area, 0.5 * 15 - 1e-4) << shape;
    EXPECT_LT(area, 15) << shape;
  }
}

TEST(Operators, ExtrudeRaisesAPolygonAlongItsNormal) {
  const auto d = derived("A = CompSplit() { Discard() | Discard() | Extrude(0.5) CompSplit() { T | U | V } };",
                         makeAxiom(2, 4, 6));
  EXPECT_EQ(d.terminals, 4u * 6);
  // the first face is the back one; the top of what is raised on it lies half a unit further out... by half its height
  EXPECT_FLOAT_EQ(d.instances[0].transform[11], -3.25f);
  EXPECT_FLOAT_EQ(d.instances[0].transform[10], -1);
}

TEST(Operators, RotateTurnsByDegreesExactly) {
  const auto d = derived("A = Rotate(0,90,0) Translate(0,0,1) Rotate(0,-90,0) T;", makeAxiom(1, 1, 1));
  const float expected[12] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0};
  for (int i = 0; i < 12; ++i) EXPECT_EQ(d.instances[0].transform[i], expected[i]) << i;
}

TEST(Operators, RotateIsRzRyRx) {
  const auto d = derived("A = Rotate(10,20,30) T;", makeAxiom(1, 1, 1));
  const double r = M_PI / 180;
  const double cx = cos(10 * r), sx = sin(10 * r), cy = cos(20 * r), sy = sin(20 * r), cz = cos(30 * r),
               sz = sin(30 * r);
  const double m[9] = {cz * cy,
                       cz * sy * sx - sz * cx,
                       cz * sy * cx + sz * sx,
                       sz * cy,
                       sz * sy * sx + cz * cx,
                       sz * sy * cx - cz * sx,
                       -sy,
                       cy * sx,
                       cy * cx};
  for (int row = 0; row < 3; ++row)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(d.instances[0].transform[4 * row + c], m[3 * row + c], 1e-6);
}

TEST(Operators, ScaleAndSwapSize) {
  const auto d = derived("A = Scale(5,-0.5,-1) SwapSize(Z,X,Y) T;", makeAxiom(2, 4, 6));
  EXPECT_FLOAT_EQ(d.instances[0].size[0], 6);
  EXPECT_FLOAT_EQ(d.instances[0].size[1], 5);
  EXPECT_FLOAT_EQ(d.instances[0].size[2], 2);
}

TEST(Operators, ThoseOfCornersKeepThem) {
  // A box from (-1, -2, -3) to (1, 2, 3).
  const auto resized = derived("A = ResizeCorner(5,-4,6) T;", makeAxiom(2, 4, 6)).instances.at(0);
  EXPECT_FLOAT_EQ(resized.size[0], 5);
  EXPECT_FLOAT_EQ(resized.size[1], 4);
  EXPECT_FLOAT_EQ(resized.size[2], 6);
  EXPECT_FLOAT_EQ(resized.transform[3], 1.5f); // -1 to 4
  EXPECT_FLOAT_EQ(resized.transform[7], -4);   // -6 to -2
  EXPECT_FLOAT_EQ(resized.transform[11], 0);
  const auto grown = derived("A = GrowAlong(Y,10) T;", makeAxiom(2, 0, 6)).instances.at(0);
  EXPECT_FLOAT_EQ(grown.size[1], 10);
  EXPECT_FLOAT_EQ(grown.transform[7], 5);
  const auto box = derived("A = ToFace(3) GrowAlong(Z,1) T;", makeAxiom(2, 4, 6)).instances.at(0);
  EXPECT_EQ(box.shape, GPGP_SHAPE_BOX);
  EXPECT_FLOAT_EQ(box.transform[11], 3.5f); // in front of the face at z = 3
  // About z first: x goes to y, then about x: y goes to z.
  const auto turned = derived("A = TurnCorner(90,0,90) T;", makeAxiom(2, 4, 6)).instances.at(0);
  const float expected[12] = {0, -4, 0, -1 - 2, 0, 0, -6, -2 - 3, 2, 0, 0, -3 + 1};
  for (int i = 0; i < 12; ++i) EXPECT_NEAR(turned.transform[i], expected[i], 1e-5) << i;
  const auto attribute = derived("A = SetAttribute(7) T;", makeAxiom(1, 1, 1)).instances.at(0);
  EXPECT_EQ(attribute.attribute, 7);
  for (int face = 0; face < 6; ++face) { // as CompSplit
    const auto all = derived("A = CompSplit() T;", makeAxiom(2, 4, 6)).instances;
    const auto one = derived("A = ToFace(" + std::to_string(face) + ") T;", makeAxiom(2, 4, 6)).instances.at(0);
    for (int i = 0; i < 12; ++i) EXPECT_EQ(one.transform[i], all.at(size_t(face)).transform[i]);
  }
}

TEST(Operators, RoofsAndTheirFaces) {
  // Ten by six, one to one: three high, with a ridge of four.
  const auto hip = derived("A = RaiseRoof(2,1,1) T;", makeAxiom(10, 0, 6)).instances.at(0);
  EXPECT_EQ(hip.shape & 0xff, GPGP_SHAPE_ROOF);
  EXPECT_NEAR((hip.shape >> 8 & 0xfffff) / 1048576.0, 0.2, 1e-6);
  EXPECT_EQ(hip.shape >> 28, 0u);
  EXPECT_FLOAT_EQ(hip.size[1], 3);
  EXPECT_FLOAT_EQ(hip.transform[7], 1.5f);
  for (int face = 0; face < 5; ++face) {
    const auto f = derived("A = RaiseRoof(2,1,1) ToRoofFace(" + std::to_string(face) + ",0,0) T;", makeAxiom(10, 0, 6))
                       .instances.at(0);
    EXPECT_EQ(f.shape & 0xff, face == 4 ? GPGP_SHAPE_QUAD : GPGP_SHAPE_TRAPEZOID);
    EXPECT_FLOAT_EQ(f.size[0], face % 2 ? 6 : 10);
    EXPECT_FLOAT_EQ(f.size[1], face == 4 ? 6 : 3 * std::sqrt(2.0f));
    if (face == 4) continue;
    // Its middle is a quarter in from the edge and half up; it looks out and up.
    const float out[4][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
    const float edge = face % 2 ? 5 : 3;
    EXPECT_NEAR(f.transform[3], out[face][0] * (edge - 1.5f), 1e-5);
    EXPECT_NEAR(f.transform[7], 1.5f, 1e-5);
    EXPECT_NEAR(f.transform[11], out[face][1] * (edge - 1.5f), 1e-5);
    EXPECT_NEAR(f.transform[2], out[face][0] * std::sqrt(0.5f), 1e-5);
    EXPECT_NEAR(f.transform[6], std::sqrt(0.5f), 1e-5);
    EXPECT_NEAR(f.transform[10], out[face][1] * std::sqrt(0.5f), 1e-5);
  }
  // A quad stands up; degrees; overhangs lengthen slopes, and gables' ridges at both ends.
  const auto slope =
      derived("A = ToFace(0) RaiseRoof(0,2,45) ToRoofFace(0,1,0.5) T;", makeAxiom(10, 2, 6)).instances.at(0);
  EXPECT_EQ(slope.shape, GPGP_SHAPE_QUAD);
  EXPECT_NEAR(slope.size[0], 11, 1e-5);
  EXPECT_NEAR(slope.size[1], 3 * std::sqrt(2.0f) + 1, 1e-5);
  EXPECT_NEAR(slope.transform[7], 1 + 1.5f - 0.5f * std::sqrt(0.5f), 1e-5);
  const auto wall = derived("A = RaiseRoof(0,0,3) ToRoofFace(1,1,0.5) T;", makeAxiom(10, 0, 6)).instances.at(0);
  EXPECT_EQ(wall.shape, GPGP_SHAPE_TRAPEZOID);
  EXPECT_FLOAT_EQ(wall.size[0], 6);
  EXPECT_FLOAT_EQ(wall.size[1], 3);
  EXPECT_FLOAT_EQ(wall.transform[3], 5);
  // What is no rectangle, or no roof, stays as it is; nothing cuts a roof.
  EXPECT_EQ(derived("A = ToRoofFace(1,0,0) T;", makeAxiom(1, 1, 1)).instances.at(0).shape, GPGP_SHAPE_BOX);
  const auto cut = derived("A = RaiseRoof(3,0,1) SubDiv(X) { -1: T | -1: T };", makeAxiom(1, 0, 1));
  EXPECT_TRUE(cut.instances.empty());
  EXPECT_EQ(cut.droppedShapes, 1u);
}

TEST(Operators, ConditionsAndExpressions) {
  const auto taken = [](const std::string& condition) {
    const auto d = derived("A = If(" + condition + ") { T | U };", makeAxiom(2, 4, 6));
    return d.instances[0].terminal == 0;
  };
  EXPECT_TRUE(taken("Exp(1 + 2 * 3 == 7)"));
  EXPECT_TRUE(taken("Exp(Exp(1 + 2) * 3 == 9)"));
  EXPECT_FALSE(taken("Exp(ShapeSize(X) > ShapeSize(Y))"));
  EXPECT_TRUE(taken("Exp(ShapeSize(X) < 3 && ShapeSize(Z) >= 6)"));
  EXPECT_TRUE(taken("Exp(0 || ShapeSize(X) != 3)"));
  EXPECT_FALSE(taken("Exp(ShapePos(Y) <= -0.1)"));
  EXPECT_TRUE(taken("Exp(ShapeRotation(Y,Y) == 1)"));
  EXPECT_TRUE(taken("Exp(Rand(4,4) == 4)"));
  EXPECT_TRUE(taken("Exp(ShapeSize(X) / ShapePos(X) > 1000000)")); // which is 0
  EXPECT_TRUE(taken("Exp(ShapePos(X) / ShapePos(X) == 0)"));
  EXPECT_TRUE(taken("Exp(ShapeSize(Z) / ShapeSize(Y) == 1.5)"));
  EXPECT_TRUE(taken("Exp(-ShapeSize(X) == -2)"));
  EXPECT_TRUE(taken("Exp(Floor(ShapeSize(Z),ShapeSize(Y)) == 1 && Floor(ShapeSize(X)/-4,1) == -1)"));
  EXPECT_TRUE(taken("Exp(Min(ShapeSize(X),3) == 2 && Max(ShapeSize(X),3) == 3)"));
  EXPECT_TRUE(taken("Exp(Noise(ShapeSize(X),1) >= 0 && Noise(ShapeSize(X),1) < 1)"));
  EXPECT_TRUE(taken("Exp(Noise(ShapeSize(X),1) != Noise(ShapeSize(X),2))"));
}

TEST(Operators, RandomRuleFollowsItsProbabilities) {
  const auto words = bake("axiom Box A; terminal T (1,0); terminal U (1,1); terminal V (1,2);"
                          "A = RandomRule(ShapeSeed()) { 1: T | 2: U | 1: V };");
  std::vector<GpgpAxiom> all;
  for (uint32_t i = 0; i < 40000; ++i) all.push_back(makeAxiom(1, 1, 1, i, i));
  const auto d = derive(words, all);
  EXPECT_NEAR(d.buckets[0], 10000, 500);
  EXPECT_NEAR(d.buckets[1], 20000, 500);
  EXPECT_NEAR(d.buckets[2], 10000, 500);
}

TEST(Operators, PrefixStochastics) {
  const auto words = bake("axiom Box A; terminal T (1,0); terminal U (1,1); A --> 20%: T else: U;");
  std::vector<GpgpAxiom> all;
  for (uint32_t i = 0; i < 10000; ++i) all.push_back(makeAxiom(1, 1, 1, i, i));
  const auto d = derive(words, all);
  EXPECT_NEAR(d.buckets[0], 2000, 200);
  EXPECT_EQ(d.buckets[0] + d.buckets[1], 10000u);
}

TEST(Operators, ChildrenHaveSeedsOfTheirOwnAndKeysAreUnique) {
  const auto d = derived("A = Repeat(X,1,ADJUST_TO_FILL) Repeat(Y,1,ADJUST_TO_FILL) Replicate() { T | T };",
                         makeAxiom(50, 50, 1, 7));
  std::set<std::pair<uint32_t, uint32_t>> keys;
  std::set<uint32_t> seeds;
  for (const GpgpInstance& i : d.instances) {
    keys.insert({i.key[0], i.key[1]});
    seeds.insert(i.seed);
  }
  EXPECT_EQ(keys.size(), 5000u);
  EXPECT_EQ(seeds.size(), 2500u); // Replicate leaves the seed
}

TEST(Operators, SetGeometryMirrorsBottoms) {
  // an L seen from above; its bottom must be the mirror image
  const auto d = derived("A = SetAsDynamicConcaveRightPrism((-0.5,-0.5),(0.5,-0.5),(0.5,0),(0,0),(0,0.5),(-0.5,0.5)) "
                         "CompSplit() { T | U | V };",
                         makeAxiom(2, 2, 2));
  ASSERT_EQ(d.terminals, 8u);
  EXPECT_EQ(d.instances[0].shape, uint32_t(GPGP_SHAPE_DYNAMIC_POLYGON));
  EXPECT_EQ(d.instances[1].shape, uint32_t(GPGP_SHAPE_DYNAMIC_POLYGON));
}

TEST(Operators, StartRulesAndUnknownRules) {
  const auto words = bake("axiom Box A; terminal T (1,0); A = Replicate() { T | B }; B = Replicate() { T | T | T };");
  GpgpAxiom axiom = makeAxiom(1, 1, 1);
  EXPECT_EQ(derive(words, std::span(&axiom, 1)).terminals, 4u);
  axiom.start = 1;
  EXPECT_EQ(derive(words, std::span(&axiom, 1)).terminals, 3u);
  axiom.start = 2; // the axiom line
  EXPECT_EQ(derive(words, std::span(&axiom, 1)).terminals, 4u);
  axiom.start = 3;
  EXPECT_EQ(derive(words, std::span(&axiom, 1)).terminals, 0u);
  EXPECT_EQ(derive(words, std::span(&axiom, 1)).droppedShapes, 1u);
}

TEST(Operators, InstancesNameTheRuleWhoseBodyEnded) {
  const std::string text = "axiom Box A; axiom Box T; terminal T U (1,0);"
                           "A = Replicate() { T | B | C | D | Generate() | Replicate() { U | T } };" // two T, one rule
                           "B = T; C = B;" // C has no terminal of its own
                           "D --> 50%: Scale(1,1,1) T else: Replicate() { T | Generate() };";
  const auto rulesOf = [](const std::vector<uint32_t>& words, const std::vector<uint32_t>& starts) {
    std::vector<GpgpAxiom> all;
    for (const uint32_t start : starts) {
      all.push_back(makeAxiom(1, 1, 1, start));
      all.back().start = start;
    }
    std::vector<uint32_t> rules;
    for (const GpgpInstance& i : derive(words, all).instances) rules.push_back(i.rule);
    return rules;
  };
  const uint32_t A = 0, B = 1, C = 2, D = 3, line = 5;
  const auto words = bake(text);
  auto found = rulesOf(words, {A});
  ASSERT_GE(found.size(), 7u); // D is one terminal or two
  ASSERT_LE(found.size(), 8u);
  for (size_t i = 3; i + 3 < found.size(); ++i) EXPECT_EQ(found[i], D);
  found.erase(found.begin() + 4, found.end() - 3);
  EXPECT_EQ(found, (std::vector<uint32_t>{A, B, B, D, A, A, A}));
  EXPECT_EQ(rulesOf(words, {B, C, line}), (std::vector<uint32_t>{B, B, GPGP_NO_RULE}));
  // Linked grammars count on.
  const std::string first = "axiom Box X; terminal V (1,0); Y = V; X = Replicate() { V | Y };";
  const auto both = linked({{"first", first}, {"second", text}});
  EXPECT_EQ(rulesOf(both, {1, 2 + B, 2 + C, 2 + 4 + 2}), (std::vector<uint32_t>{1, 0, 2 + B, 2 + B, GPGP_NO_RULE}));
}

TEST(Operators, RepeatsOfTooManyCopiesAreDroppedAndCounted) {
  const GpgpAxiom axiom = makeAxiom(1, 1, 1);
  for (const char* mode : {"ADJUST_TO_FILL", "ANCHOR_TO_START", "ANCHOR_TO_END"}) {
    const auto of = [&](const char* extent, const char* successor) {
      const std::string rule = std::string("A = Repeat(X,") + extent + "," + mode + ") " + successor + ";";
      return derive(bake("axiom Box A; terminal T (1,0); " + rule), std::span(&axiom, 1));
    };
    const spawn::Derivation most = of("-0.00000095367431640625", "T"), more = of("-0.00000095", "T"); // 2^-20
    EXPECT_EQ(most.terminals, 1048576u) << mode;
    EXPECT_EQ(most.droppedShapes, 0u) << mode;
    EXPECT_EQ(more.terminals, 0u) << mode;
    EXPECT_EQ(more.droppedShapes, 1u) << mode;
    EXPECT_EQ(of("-0.00000095", "Discard()").droppedShapes, 0u) << mode;
  }
}

TEST(Operators, EndlessGrammarsStop) {
  const auto chain = derived("A = Translate(1,0,0) A;", makeAxiom(1, 1, 1));
  EXPECT_EQ(chain.terminals, 0u);
  EXPECT_EQ(chain.unfinishedShapes, 1u);
  EXPECT_EQ(chain.depth, 65u);
  const auto words = bake("axiom Box A; terminal T (1,0); A = Replicate() { A | A };");
  const GpgpAxiom axiom = makeAxiom(1, 1, 1);
  spawn::DeriveOptions options;
  options.maxDepth = 10;
  EXPECT_EQ(derive(words, std::span(&axiom, 1), options).unfinishedShapes, 2048u);
  options.maxDepth = 1024;
  options.maxShapes = 100000;
  EXPECT_FALSE(derive(words, std::span(&axiom, 1), options).complete);
}

TEST(Operators, ChainsOfAnyLengthEnd) { // others get their turn after 64 operators, wherever the chain is then
  const GpgpAxiom axiom = makeAxiom(1, 1, 1);
  for (int length = 60; length < 70; ++length) {
    std::string chain;
    for (int i = 1; i < length; ++i) chain += "Translate(1,0,0) ";
    for (const char* condition : {"0", "1"}) {
      const auto words =
          bake("axiom Box A; terminal T (1,0); A = " + chain + "If(" + condition + ") { T | Discard() };");
      EXPECT_EQ(derive(words, std::span(&axiom, 1)).terminals, condition[0] == '1' ? 1u : 0u) << length;
    }
  }
}

TEST(Derivation, IntoMemoryOfAnEarlierOneIsTheSame) {
  const auto words = bake(ownGrammar("building.pga"));
  for (const uint32_t before : {1u, 5u, 9u}) {
    spawn::DeriveOptions options;
    const auto fresh = derive(words, axioms(5, 12, 9, 24), options);
    const auto again = derive(words, axioms(5, 12, 9, 24), options, derive(words, axioms(before, 12, 9, 24)));
    ASSERT_GT(fresh.terminals, 0u);
    ASSERT_EQ(again.instances.size(), fresh.instances.size());
    EXPECT_EQ(
        0, std::memcmp(again.instances.data(), fresh.instances.data(), fresh.instances.size() * sizeof(GpgpInstance)));
    options.keepInstances = false;
    EXPECT_TRUE(
        derive(words, axioms(5, 12, 9, 24), options, derive(words, axioms(before, 12, 9, 24))).instances.empty());
  }
}

TEST(Derivation, DoesNotDependOnPlacementOrOrder) {
  std::vector<std::string> texts = {ownGrammar("building.pga")};
  if (const auto published = sharedGrammar("commercial.pga")) texts.push_back(*published);
  for (const std::string& text : texts) {
    const auto words = bake(text);
    auto all = axioms(20, 30, 45, 30);
    const auto first = derive(words, all);
    std::reverse(all.begin(), all.end());
    for (GpgpAxiom& axiom : all) {
      axiom.transform[3] += 5000;
      std::swap(axiom.transform[0], axiom.transform[2]);
      std::swap(axiom.transform[8], axiom.transform[10]);
    }
    const auto second = derive(words, all);
    EXPECT_GT(first.terminals, all.size());
    EXPECT_EQ(first.terminals, second.terminals);
    EXPECT_EQ(first.keyHash[0], second.keyHash[0]);
    EXPECT_EQ(first.keyHash[1], second.keyHash[1]);
    EXPECT_EQ(first.buckets, second.buckets);
  }
}

TEST(OwnGrammars, AllCompileAndDerive) {
  for (const std::string& name : ownGrammarNames()) {
    const GpgpAxiom axiom = makeAxiom(12, 14, 10, 12345);
    const auto d = derive(bake(ownGrammar(name)), std::span(&axiom, 1));
    EXPECT_GT(d.terminals, 0u) << name;
    EXPECT_TRUE(d.complete) << name;
    EXPECT_EQ(d.unfinishedShapes, 0u) << name;
  }
}

} // namespace
