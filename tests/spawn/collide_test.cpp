// Collider and IfCollides: boxes against closed forms and an independent way to find a common point, the grid against
// all pairs, what a shape's own colliders are, phases; the GPU against the evaluator, budgets, the order of axioms.
#include "grammars.h"
#include "random_grammar.h"
#include "spawn/colliders/collide.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn_device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <random>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using spawn::makeAxiom;

/// A box turned about an axis through its centre.
GpgpAxiom boxAt(glm::dvec3 centre, glm::dvec3 size, glm::dquat turn = {1, 0, 0, 0}) {
  GpgpAxiom axiom = makeAxiom(float(size.x), float(size.y), float(size.z));
  const glm::dmat3 m = glm::mat3_cast(turn);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) axiom.transform[4 * row + column] = float(m[column][row]);
    axiom.transform[4 * row + 3] = float(centre[row]);
  }
  return axiom;
}
glm::dquat turned(double degrees, glm::dvec3 axis) {
  return glm::angleAxis(glm::radians(degrees), glm::normalize(axis));
}

shader::ColliderBox boxOf(const GpgpAxiom& axiom) {
  shader::Shape shape{};
  shape.axisX = {1, 0, 0};
  shape.axisY = {0, 1, 0};
  shape.axisZ = {0, 0, 1};
  shape.size = {axiom.size[0], axiom.size[1], axiom.size[2]};
  const float* t = axiom.transform;
  return shader::boxOf(shape, {t[0], t[1], t[2], t[3]}, {t[4], t[5], t[6], t[7]}, {t[8], t[9], t[10], t[11]});
}
bool intersect(const GpgpAxiom& a, const GpgpAxiom& b) {
  const bool result = shader::boxesIntersect(boxOf(a), boxOf(b));
  EXPECT_EQ(result, shader::boxesIntersect(boxOf(b), boxOf(a)));
  return result;
}

TEST(Boxes, ApartTouchingOverlapping) {
  const GpgpAxiom box = boxAt({0, 0, 0}, {2, 4, 6});
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const auto other = [&](double gap) {
        glm::dvec3 at(0);
        at[axis] = side * (1.0 + axis + 0.5 + gap); // half of the box, half of the other
        return boxAt(at, {1, 1, 1});
      };
      EXPECT_FALSE(intersect(box, other(1)));
      EXPECT_FALSE(intersect(box, other(0.001)));
      EXPECT_FALSE(intersect(box, other(0)));
      EXPECT_FALSE(intersect(box, other(-0.00002))); // less than a part in 65 536
      EXPECT_TRUE(intersect(box, other(-0.001)));
      EXPECT_TRUE(intersect(box, other(-1)));
    }
  EXPECT_TRUE(intersect(box, box));
  EXPECT_TRUE(intersect(box, boxAt({0.1, 0.2, 0}, {0.1, 0.1, 0.1}))); // inside
  EXPECT_FALSE(intersect(box, boxAt({1.5, 2.5, 3.5}, {1, 1, 1})));    // corner to corner
  EXPECT_TRUE(intersect(box, boxAt({1.499, 2.499, 3.499}, {1, 1, 1})));
}

TEST(Boxes, Turned) {
  const GpgpAxiom box = boxAt({0, 0, 0}, {2, 2, 2});
  const double edge = std::sqrt(2.0); // half the diagonal of a face
  EXPECT_FALSE(intersect(box, boxAt({1 + edge + 0.001, 0, 0}, {2, 2, 2}, turned(45, {0, 1, 0}))));
  EXPECT_FALSE(intersect(box, boxAt({1 + edge, 0, 0}, {2, 2, 2}, turned(45, {0, 1, 0}))));
  EXPECT_TRUE(intersect(box, boxAt({1 + edge - 0.001, 0, 0}, {2, 2, 2}, turned(45, {0, 1, 0}))));
  // Their extents along the world's axes overlap, they do not.
  EXPECT_FALSE(intersect(box, boxAt({1.8, 1.8, 0}, {2, 2, 2}, turned(45, {0, 0, 1}))));
  // Edge against edge: only a product of edges separates.
  const glm::dquat a = turned(45, {0, 0, 1}), b = turned(45, {1, 0, 0});
  EXPECT_FALSE(intersect(boxAt({0, 0, 0}, {2, 2, 2}, a), boxAt({0, 2 * edge + 0.001, 0}, {2, 2, 2}, b)));
  EXPECT_TRUE(intersect(boxAt({0, 0, 0}, {2, 2, 2}, a), boxAt({0, 2 * edge - 0.001, 0}, {2, 2, 2}, b)));
  // Side by side in a frame that is turned, also far from the origin.
  for (const double far : {0.0, 1000.0, 1.0e5})
    for (int i = 0; i < 200; ++i) {
      const glm::dquat turn = turned(7.3 * i, {1, 0.3 * i, 2 - 0.1 * i});
      const glm::dvec3 at(far, -far, far);
      const auto other = [&](double gap) { return boxAt(at + turn * glm::dvec3(10 + gap, 0, 0), {10, 10, 10}, turn); };
      ASSERT_FALSE(intersect(boxAt(at, {10, 10, 10}, turn), other(0))) << far << ' ' << i;
      ASSERT_TRUE(intersect(boxAt(at, {10, 10, 10}, turn), other(-0.06))) << far << ' ' << i;
    }
}

TEST(Boxes, StretchedAndSheared) {
  GpgpAxiom box = boxAt({0, 0, 0}, {1, 1, 1});
  box.transform[0] = 3;
  EXPECT_TRUE(intersect(box, boxAt({1.99, 0, 0}, {1, 1, 1})));
  EXPECT_FALSE(intersect(box, boxAt({2, 0, 0}, {1, 1, 1})));
  box.transform[0] = 1;
  box.transform[1] = 1; // x grows with y
  EXPECT_TRUE(intersect(box, boxAt({0.9, 0.45, 0}, {0.02, 0.02, 0.02})));
  EXPECT_FALSE(intersect(box, boxAt({-0.3, 0.45, 0}, {0.02, 0.02, 0.02})));
  EXPECT_TRUE(intersect(box, boxAt({-0.3, -0.45, 0}, {0.02, 0.02, 0.02})));
  box.transform[10] = -1; // mirrored
  EXPECT_TRUE(intersect(box, boxAt({0.9, 0.45, 0}, {0.02, 0.02, 0.02})));
}

TEST(Boxes, FlatOnes) {
  const GpgpAxiom wall = boxAt({0, 0, 0}, {10, 3, 1});
  EXPECT_TRUE(intersect(wall, boxAt({0, 0, 0}, {1, 1, 0})));     // inside
  EXPECT_FALSE(intersect(wall, boxAt({0, 0, 0.5}, {1, 1, 0})));  // in its face
  EXPECT_FALSE(intersect(wall, boxAt({5.5, 0, 0}, {1, 1, 0})));  // beside it
  EXPECT_TRUE(intersect(wall, boxAt({5.499, 0, 0}, {1, 1, 0}))); // with an edge inside
  const GpgpAxiom quad = boxAt({0, 0, 0}, {2, 2, 0});
  EXPECT_FALSE(intersect(quad, quad)); // in one plane
  EXPECT_TRUE(intersect(quad, boxAt({0, 0, 0}, {2, 2, 0}, turned(30, {0, 1, 0}))));
  EXPECT_FALSE(intersect(quad, boxAt({0, 0, 1}, {2, 2, 0}, turned(90, {1, 0, 0})))); // one ends at the other
  EXPECT_TRUE(intersect(wall, boxAt({0, 0, 0}, {0, 0, 0})));                         // a point inside
  EXPECT_FALSE(intersect(boxAt({0, 0, 0}, {0, 0, 0}), boxAt({0, 0, 0}, {0, 0, 0})));
  EXPECT_FALSE(intersect(boxAt({0, 0, 0}, {5, 0, 0}), boxAt({1, 0, 0}, {5, 0, 0})));
}

TEST(Boxes, NumbersBeyondReason) {
  const float huge = std::pow(2.0f, 99.0f), nan = std::nanf("");
  GpgpAxiom broken = boxAt({0, 0, 0}, {1, 1, 1});
  broken.transform[0] = nan;
  broken.transform[5] = huge;
  broken.transform[3] = INFINITY;
  EXPECT_FALSE(intersect(broken, boxAt({0, 0, 0}, {1, 1, 1})));
  EXPECT_TRUE(intersect(boxAt({0, 0, 0}, {huge, huge, huge}), boxAt({1e6, 0, 0}, {1, 1, 1})));
  EXPECT_FALSE(intersect(boxAt({0, 0, 0}, {1e-30, 1e-30, 1e-30}), boxAt({1, 0, 0}, {1e-9, 1, 1})));
}

/// The least distance of two boxes, by projecting to one and the other in turn; negative: not yet found.
double distanceOf(const GpgpAxiom& a, const GpgpAxiom& b) {
  const auto project = [](const GpgpAxiom& box, glm::dvec3 p) {
    glm::dvec3 result;
    const float* t = box.transform;
    const glm::dvec3 at(t[3], t[7], t[11]);
    result = at;
    for (int axis = 0; axis < 3; ++axis) {
      const glm::dvec3 direction(t[axis], t[4 + axis], t[8 + axis]);
      const double half = 0.5 * double(box.size[axis]);
      result += direction * std::clamp(glm::dot(p - at, direction), -half, half);
    }
    return result;
  };
  glm::dvec3 p = project(a, {b.transform[3], b.transform[7], b.transform[11]}), q = project(b, p);
  for (int i = 0; i < 200000; ++i) {
    const glm::dvec3 before = p;
    p = project(a, q);
    q = project(b, p);
    const double distance = glm::length(p - q);
    if (distance < 1e-9 || glm::length(p - before) < 1e-9 * distance) return distance;
  }
  return -1;
}

std::vector<GpgpAxiom> randomBoxes(uint32_t count, uint32_t seed, double spread, double smallest, double largest) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) { return low + (high - low) * double(random()) / 4294967296.0; };
  std::vector<GpgpAxiom> result;
  for (uint32_t i = 0; i < count; ++i) {
    const auto size = [&] { return smallest * std::pow(largest / smallest, uniform(0, 1)); };
    const glm::dvec3 at(uniform(-spread, spread), uniform(-spread, spread), uniform(-spread, spread));
    result.push_back(boxAt(at, {size(), size(), size()},
                           turned(uniform(0, 360), {uniform(-1, 1), uniform(-1, 1), uniform(0.1, 1)})));
    result.back().seed = i;
    result.back().id = i;
  }
  return result;
}

TEST(Boxes, AgreeWithACommonPoint) {
  const auto boxes = randomBoxes(3000, 5, 0.6, 0.1, 10);
  int apart = 0, together = 0;
  for (size_t i = 0; i + 1 < boxes.size(); i += 2) {
    const double distance = distanceOf(boxes[i], boxes[i + 1]);
    if (distance < 0 || (distance > 1e-9 && distance < 1e-4)) continue; // on its way, or too close to tell
    (distance > 1e-6 ? apart : together) += 1;
    ASSERT_EQ(intersect(boxes[i], boxes[i + 1]), distance < 1e-6) << i << ": " << distance;
  }
  EXPECT_GT(apart, 300);
  EXPECT_GT(together, 300);
}

// ---------------------------------------------------------------- grammars

const std::string kHead = "axiom Box Query; terminal Hit (1,0); terminal Free (1,1);";
/// Rule 0 asks, rule 1 registers.
const std::string kPair = kHead + "Query = IfCollides(1) { Hit | Free }; Register = Collider(1) Discard();";

GpgpAxiom asRule(GpgpAxiom axiom, uint32_t rule) {
  axiom.start = rule;
  return axiom;
}
uint64_t hits(const std::string& grammar, const std::vector<GpgpAxiom>& axioms) {
  return spawn::derive(bake(grammar), axioms).buckets[0];
}

TEST(Collide, TheGridFindsWhatAllPairsFind) {
  for (const double spread : {5.0, 60.0, 400.0}) {
    const auto queries = randomBoxes(700, 1, spread, 0.001, 50), colliders = randomBoxes(900, 2, spread, 0.001, 200);
    uint64_t expected = 0;
    for (const GpgpAxiom& query : queries)
      expected += std::any_of(colliders.begin(), colliders.end(),
                              [&](const GpgpAxiom& collider) { return intersect(query, collider); });
    std::vector<GpgpAxiom> all;
    for (size_t i = 0; i < 900; ++i) { // one after the other, so that queries come before some of the colliders
      if (i < 700) all.push_back(asRule(queries[i], 0));
      all.push_back(asRule(colliders[i], 1));
    }
    const auto derived = spawn::derive(bake(kPair), all);
    EXPECT_EQ(derived.buckets[0], expected) << spread;
    EXPECT_EQ(derived.terminals, 700u);
    EXPECT_EQ(derived.colliders, 900u);
    EXPECT_GT(expected, 3u);
    EXPECT_LE(expected, 700u);
  }
}

TEST(Collide, NotWithItselfAndWhatItDescendsFrom) {
  const std::vector<GpgpAxiom> one{makeAxiom(4, 4, 4)};
  EXPECT_EQ(hits(kHead + "Query = Collider(1) IfCollides(1) { Hit | Free };", one), 0u);
  EXPECT_EQ(hits(kHead + "Query = Collider(1) SubDiv(X) { -1: Q | -1: Q }; Q = IfCollides(1) { Hit | Free };", one),
            0u);
  EXPECT_EQ(hits(kHead + "Query = Collider(1) Collider(1) Translate(1,0,0) IfCollides(1) { Hit | Free };", one), 0u);
  // A sibling's collider is another one's; what only touches it does not hit.
  EXPECT_EQ(hits(kHead + "Query = Replicate() { Collider(1) Discard() | IfCollides(1) { Hit | Free } };", one), 1u);
  EXPECT_EQ(hits(kHead + "Query = SubDiv(X) { -1: Collider(1) Discard() | -1: IfCollides(1) { Hit | Free } };", one),
            0u);
  EXPECT_EQ(hits(kHead + "Query = Collider(1) SubDiv(X) { -1: Collider(1) Q | -1: Q };"
                         "Q = Scale(-1.01,-1,-1) IfCollides(1) { Hit | Free };",
                 one),
            1u); // the right half reaches into the left one, whose collider is not its own
}

TEST(Collide, TagsAreNumbersAndNames) {
  const std::vector<GpgpAxiom> one{makeAxiom(4, 4, 4)};
  const auto asked = [&](const char* registered, const char* tag) {
    return hits(kHead + "var seven = 7; Query = Replicate() { Collider(" + registered + ") Discard() | IfCollides(" +
                    tag + ") { Hit | Free } };",
                one);
  };
  EXPECT_EQ(asked("1", "1"), 1u);
  EXPECT_EQ(asked("1", "2"), 0u);
  EXPECT_EQ(asked("wall", "wall"), 1u);
  EXPECT_EQ(asked("wall", "tree"), 0u);
  EXPECT_EQ(asked("seven", "7"), 1u);
  EXPECT_EQ(asked("2 * seven", "14"), 1u);
}

/// First walls, then trees that keep away from walls, then flowers that keep away from both.
const std::string kThreePhases =
    kHead + "Query = Replicate() { Flower | Tree | Wall };"
            "Wall = Translate(Exp(Rand(-8,8)),0,0) Scale(1,4,8) Collider(wall) Hit;"
            "Tree = Translate(0,0,Exp(Rand(-8,8))) Repeat(X,2,ADJUST_TO_FILL) Scale(-0.5,4,1) IfCollides(wall) {"
            "  Discard() | Collider(tree) Free };"
            "Flower = Repeat(X,1,ADJUST_TO_FILL) Repeat(Z,1,ADJUST_TO_FILL) Scale(-0.3,-0.3,-0.3)"
            "  IfCollides(wall) { Discard() | IfCollides(tree) { Hit | Free } };";

TEST(Collide, PhasesAreAsFewAsPossible) {
  const auto phases = [](const std::string& rules) { return bake(kHead + rules)[shader::kHeaderPhases]; };
  EXPECT_EQ(phases("Query = Hit;"), 0u);
  EXPECT_EQ(phases("Query = Collider(1) Hit;"), 1u);
  EXPECT_EQ(phases("Query = IfCollides(1) { Hit | Free };"), 1u);
  EXPECT_EQ(phases("Query = Collider(1) IfCollides(1) { Hit | Free };"), 2u);
  EXPECT_EQ(phases("Query = Collider(1) Collider(2) IfCollides(1) { IfCollides(2) { Hit | Free } | Free };"), 2u);
  EXPECT_EQ(phases("Query = Collider(1) IfCollides(1) { Collider(2) IfCollides(2) { Hit | Free } | Free };"), 3u);
  EXPECT_EQ(bake(kThreePhases)[shader::kHeaderPhases], 3u);
}

TEST(Collide, LaterPhasesSeeEarlierOnes) {
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < 25; ++i) {
    axioms.push_back(boxAt({double(i % 5) * 12, 0, double(i / 5) * 12}, {16, 2, 16}, turned(20 * i, {0, 1, 0})));
    axioms.back().seed = i;
  }
  const auto all = spawn::derive(bake(kThreePhases), axioms);
  std::vector<spawn::Derivation> alone;
  uint64_t terminals = 0;
  for (const GpgpAxiom& axiom : axioms) terminals += spawn::derive(bake(kThreePhases), {&axiom, 1}).terminals;
  EXPECT_LT(all.terminals, terminals); // each other's walls and trees
  // No tree that is there stands in any wall: their instances are boxes.
  std::vector<GpgpAxiom> walls, trees;
  for (const GpgpInstance& i : all.instances) {
    GpgpAxiom box = makeAxiom(1, 1, 1);
    std::copy_n(i.transform, 12, box.transform);
    if (i.bucket == 0 && i.size[2] == 8) walls.push_back(box);
    if (i.bucket == 1 && i.size[1] == 4) trees.push_back(box);
  }
  EXPECT_EQ(walls.size(), 25u);
  EXPECT_GT(trees.size(), 20u);
  EXPECT_EQ(all.colliders, walls.size() + trees.size());
  for (const GpgpAxiom& tree : trees)
    for (const GpgpAxiom& wall : walls) ASSERT_FALSE(intersect(tree, wall));
}

/// A plant that grows by steps until it comes to a wall or has had enough.
const std::string kPlant = kHead + "Query = Scale(0.5,0.5,0.5) Grow; Register = Collider(wall) Discard();"
                                   "Grow = IfCollides(wall) { Discard() | Replicate() { Free | Next } };"
                                   "Next = Scale(-0.97,-1,-1) IfSizeLess(X,0.2) { Hit |"
                                   "  Rotate(0,Exp(Rand(-40,40)),Exp(Rand(-30,30))) Translate(0,0.5,0) Repeat(Y,1,"
                                   "ANCHOR_TO_START) Grow };";

TEST(Collide, ShapesStopAtWalls) {
  std::vector<GpgpAxiom> plant{boxAt({0, 0, 0}, {1, 1, 1})};
  plant[0].seed = 3;
  const uint64_t free = spawn::derive(bake(kPlant), plant).terminals;
  EXPECT_GT(free, 25u);
  plant.push_back(asRule(boxAt({0, 5, 0}, {50, 1, 50}), 1));
  const auto stopped = spawn::derive(bake(kPlant), plant);
  EXPECT_LT(stopped.terminals, free);
  EXPECT_GT(stopped.terminals, 3u);
  for (const GpgpInstance& i : stopped.instances) EXPECT_LT(i.transform[7], 4.75f);
}

/// Walls and plants that make way for each other: who comes first stays where it is. Axiom lines: walls, plants.
std::vector<uint32_t> rivals(uint32_t walls, uint32_t plants, bool kernel = false) {
  GrammarBuilder g = *GrammarBuilder::create();
  g.axiom(GPGP_SHAPE_BOX, "Wall").axiom(GPGP_SHAPE_BOX, "Plant");
  g.terminal("WallStays", 1, 0).terminal("WallGoes", 1, 1).terminal("PlantStays", 1, 2).terminal("PlantGoes", 1, 3);
  g.rule("Wall", g.ifCollides(g.tag("plant"), "WallGoes", g.collider(g.tag("wall"), "WallStays")));
  g.rule("Plant", g.ifCollides(g.tag("wall"), "PlantGoes", g.collider(g.tag("plant"), "PlantStays")));
  g.priority("Wall", walls).priority("Plant", plants);
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  source.flags = kernel ? GPGP_COMPILE_KERNEL : 0;
  const auto blob = g.compile(source);
  if (!blob) return {};
  std::vector<uint32_t> words(blob->size() / 4);
  std::memcpy(words.data(), blob->data(), blob->size());
  return words;
}
/// A row of walls, in each second of which a plant stands.
std::vector<GpgpAxiom> rivalAxioms(uint32_t count) {
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < count; ++i) {
    axioms.push_back(asRule(boxAt({10.0 * i, 0, 0}, {4, 4, 4}), 0));
    axioms.push_back(asRule(boxAt({10.0 * i + (i % 2 ? 1 : 5), 0, 0}, {2, 2, 2}), 1));
    axioms[2 * i].id = 2 * i;
    axioms[2 * i + 1].id = 2 * i + 1;
  }
  return axioms;
}

TEST(Collide, PrioritiesSayWhoComesFirst) {
  const auto axioms = rivalAxioms(50);
  EXPECT_TRUE(rivals(0, 0).empty()); // each would wait for the other
  EXPECT_TRUE(rivals(7, 7).empty());
  using Counts = std::vector<uint32_t>;
  const auto wallsFirst = spawn::derive(rivals(2, 1), axioms), plantsFirst = spawn::derive(rivals(0, 65535), axioms);
  EXPECT_EQ(Counts(wallsFirst.buckets.begin(), wallsFirst.buckets.end()), (Counts{50, 0, 25, 25}));
  EXPECT_EQ(Counts(plantsFirst.buckets.begin(), plantsFirst.buckets.end()), (Counts{25, 25, 50, 0}));
  EXPECT_EQ(wallsFirst.colliders, 75u);
  EXPECT_EQ(rivals(2, 1)[shader::kHeaderPhases], 2u);
}

/// Of one tag: who asks does not see colliders of lower priorities, though it waits for others, and they for it.
std::vector<uint32_t> lateColliders(uint32_t priority) {
  GrammarBuilder g = *GrammarBuilder::create();
  g.axiom(GPGP_SHAPE_BOX, "Start").terminal("Hit", 1, 0).terminal("Free", 1, 1);
  g.rule("Start", g.replicate({"Late", "Asks", g.collider(1, "Free")}));
  g.rule("Late", g.collider(2, "Free")).rule("Asks", g.ifCollides(1, g.ifCollides(2, "Hit", "Free"), "Hit"));
  g.priority("Start", 1).priority("Asks", 1).priority("Late", priority);
  std::vector<uint32_t> words;
  if (const auto blob = g.compile()) {
    words.resize(blob->size() / 4);
    std::memcpy(words.data(), blob->data(), blob->size());
  }
  return words;
}

TEST(Collide, LowerPrioritiesAreNotSeen) {
  const std::vector<GpgpAxiom> one{makeAxiom(4, 4, 4)};
  EXPECT_EQ(spawn::derive(lateColliders(2), one).buckets[0], 1u);
  EXPECT_EQ(spawn::derive(lateColliders(1), one).buckets[0], 1u);
  EXPECT_EQ(spawn::derive(lateColliders(0), one).buckets[0], 0u);
}

// ---------------------------------------------------------------- the GPU

std::vector<uint32_t> bakeKernel(const std::string& text) {
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  source.text = text.data();
  source.size = text.size();
  source.flags = GPGP_COMPILE_KERNEL;
  GpgpBlob blob{};
  EXPECT_EQ(gpgpCompileGrammar(&source, &blob), GPGP_SUCCESS);
  std::vector<uint32_t> words(blob.size / 4);
  std::memcpy(words.data(), blob.data, blob.size);
  gpgpFreeBlob(&blob);
  return words;
}

void expectSame(SpawnDevice& device, const std::vector<uint32_t>& words, const std::vector<GpgpAxiom>& axioms,
                const std::string& what) {
  const auto cpu = spawn::derive(words, axioms);
  ASSERT_TRUE(cpu.complete) << what;
  const GpgpSpawnReport gpu = device.derive(words, axioms, uint32_t(cpu.terminals) + 1);
  EXPECT_EQ(gpu.base.status, cpu.unfinishedShapes || cpu.droppedShapes ? GPGP_BUDGET_EXCEEDED : GPGP_SUCCESS) << what;
  EXPECT_EQ(gpu.colliders, cpu.colliders) << what;
  EXPECT_EQ(gpu.collidersKept, cpu.colliders) << what;
  EXPECT_EQ(gpu.terminals, cpu.terminals) << what;
  EXPECT_EQ(gpu.instancesWritten, cpu.terminals) << what;
  EXPECT_EQ(gpu.keyHash[0], cpu.keyHash[0]) << what;
  EXPECT_EQ(gpu.keyHash[1], cpu.keyHash[1]) << what;
  EXPECT_EQ(gpu.depth, cpu.depth) << what;
}

std::vector<GpgpAxiom> mixed(double spread, uint32_t seed, uint32_t count) {
  auto all = randomBoxes(count, seed, spread, 0.01, 60);
  for (size_t i = 0; i < all.size(); ++i) all[i].start = i % 2;
  return all;
}

TEST(CollideOnGpu, EqualsTheEvaluator) {
  SpawnDevice device({.maxColliders = 4096});
  for (const bool kernel : {false, true}) {
    const std::string by = kernel ? " by a kernel" : " by the interpreter";
    const auto made = [&](const std::string& text) { return kernel ? bakeKernel(text) : bake(text); };
    for (const double spread : {10.0, 100.0, 1.0e5})
      expectSame(device, made(kPair), mixed(spread, 9, 3000), "pairs" + by);
    auto clustered = mixed(20, 4, 2000); // far from the origin
    for (GpgpAxiom& axiom : clustered) axiom.transform[3] += 1.0e5f, axiom.transform[11] -= 1.0e5f;
    expectSame(device, made(kPair), clustered, "far" + by);
    std::vector<GpgpAxiom> gardens;
    for (uint32_t i = 0; i < 60; ++i) {
      gardens.push_back(boxAt({double(i % 8) * 12, 0, double(i / 8) * 12}, {16, 2, 16}, turned(20 * i, {0, 1, 0})));
      gardens.back().seed = i;
    }
    expectSame(device, made(kThreePhases), gardens, "phases" + by);
    std::vector<GpgpAxiom> plants;
    for (uint32_t i = 0; i < 100; ++i) {
      plants.push_back(boxAt({double(i % 10) * 2, 0, double(i / 10) * 2}, {1, 1, 1}));
      plants.back().seed = i;
    }
    for (uint32_t i = 0; i < 10; ++i)
      plants.push_back(asRule(boxAt({i * 2.0, 5.0 + i, 9}, {1.5, 1, 30}, turned(5 * i, {1, 2, 3})), 1));
    expectSame(device, made(kPlant), plants, "plants" + by);
    expectSame(device, made(kHead + "Query = Collider(1) Hit;"), randomBoxes(10, 3, 10, 1, 2), "one phase" + by);
    if (HasFailure()) return;
  }
}

TEST(CollideOnGpu, ShapesWaitThroughPhases) { // of which each must see them, and none but theirs may take them
  SpawnDevice device({.maxColliders = 100});
  const std::string text =
      kHead + "Query = Replicate() { Collider(1) Hit | IfCollides(1) { Third | Discard() } | Third | Fourth };"
              "Third = Collider(2) Replicate() { IfCollides(2) { Collider(3) Hit | Collider(3) Free } | Fourth };"
              "Fourth = IfCollides(3) { Hit | Free };";
  EXPECT_EQ(bake(text)[shader::kHeaderPhases], 4u);
  const auto axioms = randomBoxes(20, 3, 10, 1, 4);
  for (const bool kernel : {false, true})
    expectSame(device, kernel ? bakeKernel(text) : bake(text), axioms, kernel ? "kernel" : "interpreter");
}

TEST(CollideOnGpu, PrioritiesSayWhoComesFirst) {
  SpawnDevice device({.maxColliders = 4096});
  const auto axioms = rivalAxioms(500);
  for (const bool kernel : {false, true}) {
    expectSame(device, rivals(2, 1, kernel), axioms, "walls first");
    expectSame(device, rivals(1, 2, kernel), axioms, "plants first");
  }
  EXPECT_NE(device.derive(rivals(2, 1), axioms, 2000).keyHash[0], device.derive(rivals(1, 2), axioms, 2000).keyHash[0]);
  for (const uint32_t priority : {0u, 1u, 2u})
    expectSame(device, lateColliders(priority), randomBoxes(50, 3, 100, 1, 2), "late colliders");
}

TEST(CollideOnGpu, OrderOfAxiomsDoesNotMatter) {
  SpawnDevice device({.maxColliders = 4096});
  const auto words = bake(kThreePhases);
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < 40; ++i) {
    axioms.push_back(boxAt({double(i % 8) * 11, 0, double(i / 8) * 9}, {16, 2, 16}, turned(20 * i, {0, 1, 0})));
    axioms.back().seed = i;
  }
  const GpgpSpawnReport first = device.derive(words, axioms, 100000);
  std::mt19937 random(1);
  for (int i = 0; i < 4; ++i) {
    std::shuffle(axioms.begin(), axioms.end(), random);
    const GpgpSpawnReport other = device.derive(words, axioms, 100000);
    EXPECT_EQ(other.terminals, first.terminals);
    EXPECT_EQ(other.keyHash[0], first.keyHash[0]);
    EXPECT_EQ(other.keyHash[1], first.keyHash[1]);
    const auto cpu = spawn::derive(words, axioms);
    EXPECT_EQ(cpu.keyHash[0], first.keyHash[0]);
    EXPECT_EQ(cpu.keyHash[1], first.keyHash[1]);
  }
}

TEST(CollideOnGpu, ManyCollidersInOnePlace) { // queries look at all of them, which takes more than one step
  SpawnDevice device({.maxColliders = 8192});
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < 8192; ++i) axioms.push_back(asRule(boxAt({i * 1.0e-5, 0, 0}, {1, 1, 0.01}), 1));
  for (uint32_t i = 0; i < 600; ++i) {
    axioms.push_back(boxAt({0, 0, i % 20 == 0 ? 0 : 0.02}, {1, 1, 0.01}));
    axioms.back().seed = i;
  }
  expectSame(device, bake(kPair), axioms, "one place");
  const auto again = kHead + "Query = Replicate() { Q | Translate(0,0,0.001) Q | Translate(0,0.2,0.002) Q };"
                             "Register = Collider(1) Discard(); Q = IfCollides(1) { Hit | Translate(0,0,0.0001) P };"
                             "P = IfCollides(1) { Hit | Translate(0,0,0.0001) IfCollides(1) { Hit | Free } };";
  expectSame(device, bake(again), axioms, "one after the other");
}

TEST(CollideOnGpu, BudgetsAreReported) {
  auto axioms = mixed(30, 6, 1000);
  {
    SpawnDevice device({.maxColliders = 100});
    const GpgpSpawnReport report = device.derive(bake(kPair), axioms, 2000);
    EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED);
    EXPECT_EQ(report.colliders, 500u);
    EXPECT_EQ(report.collidersKept, 100u);
    EXPECT_EQ(report.terminals, 500u);
    EXPECT_EQ(report.droppedShapes, 0u);
    axioms.resize(200); // exactly as many as fit
    expectSame(device, bake(kPair), axioms, "exactly");
  }
  SpawnDevice device({.maxShapes = 64, .maxColliders = 1000});
  const GpgpSpawnReport report = device.derive(bake(kPair), axioms, 2000);
  EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(report.peakShapes, 100u); // that wait for the second phase
  EXPECT_EQ(report.droppedShapes, 36u);
  EXPECT_EQ(report.terminals, 64u);
}

TEST(CollideOnGpu, RandomGrammarsEqualTheEvaluator) {
  SpawnDevice device({.maxColliders = 8192});
  spawn::DeriveOptions options;
  options.maxShapes = 6000;
  uint64_t colliders = 0;
  for (uint32_t seed = 0, checked = 0, kernels = 0; checked < 30 || colliders < 500; ++seed) {
    ASSERT_LT(checked, 60u) << colliders << " colliders";
    const std::string text = randomGrammar(seed);
    if (text.find("IfCollides") == std::string::npos) continue;
    std::vector<GpgpAxiom> axioms;
    for (uint32_t i = 0; i < 2 + seed % 5; ++i) {
      axioms.push_back(boxAt({5.0 * i, 0, 0}, {6, 9, 7}, turned(25 * i, {0, 1, 0.2})));
      axioms.back().seed = seed + i;
    }
    const auto cpu = spawn::derive(bake(text), axioms, options);
    if (!cpu.complete || cpu.terminals < 5 || cpu.colliders == 0 || cpu.colliders > 1000) continue;
    expectSame(device, bake(text), axioms, "seed " + std::to_string(seed) + "\n" + text);
    if (kernels++ < 2) expectSame(device, bakeKernel(text), axioms, "kernel, seed " + std::to_string(seed));
    if (HasFailure()) return;
    colliders += cpu.colliders;
    ++checked;
  }
}

TEST(CollideOnGpu, SpawnersWithoutCollidersRefuse) {
  host::HeadlessDevice device{host::DeviceOptions{.validation = true}};
  GpgpContextCreateInfo info = device.contextCreateInfo();
  std::vector<std::string> messages;
  info.messageUserData = &messages;
  info.messageFn = [](void* user, const GpgpMessage* m) {
    static_cast<std::vector<std::string>*>(user)->push_back(m->text);
  };
  GpgpContext context = nullptr;
  ASSERT_EQ(gpgpCreateContext(&info, &context), GPGP_SUCCESS);
  GpgpSpawnerCreateInfo spawnerInfo = GPGP_SPAWNER_CREATE_INFO_INIT;
  spawnerInfo.base.queueFamily = device.graphics().family;
  GpgpRecorder spawner = nullptr;
  spawnerInfo.maxColliders = (1u << 24) + 1;
  EXPECT_EQ(gpgpCreateSpawner(context, &spawnerInfo, &spawner), GPGP_ERROR_UNSUPPORTED);
  spawnerInfo.maxColliders = 0;
  ASSERT_EQ(gpgpCreateSpawner(context, &spawnerInfo, &spawner), GPGP_SUCCESS);
  ASSERT_EQ(gpgpPrewarm(spawner, nullptr), GPGP_SUCCESS);
  const auto words = bake(kPair);
  GpgpGrammarCreateInfo grammarInfo = GPGP_GRAMMAR_CREATE_INFO_INIT;
  grammarInfo.data = words.data();
  grammarInfo.size = words.size() * 4;
  GpgpAsset grammar = nullptr;
  ASSERT_EQ(gpgpCreateGrammar(context, &grammarInfo, &grammar), GPGP_SUCCESS);
  const std::vector<GpgpAxiom> axioms{makeAxiom(1, 1, 1)};
  const auto start = host::makeBuffer(device, axioms, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const host::Buffer instances(device, 960, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  GpgpSpawnInfo spawn = GPGP_SPAWN_INFO_INIT;
  spawn.grammar = grammar;
  spawn.axioms = start.range();
  spawn.axiomCount = 1;
  spawn.instances = instances.range();
  const GpgpFrame frame{1, 0};
  EXPECT_EQ(gpgpAdvance(context, &frame), GPGP_SUCCESS);
  messages.clear();
  device.submitAndWait([&](VkCommandBuffer commands) {
    EXPECT_EQ(gpgpRecordUpload(context, commands, &frame, 0, nullptr), GPGP_SUCCESS);
    EXPECT_EQ(gpgpRecordPrepareSpawn(spawner, commands, &frame, &spawn), GPGP_ERROR_INVALID_ARGUMENT);
  });
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0], "grammar has Collider or IfCollides, and maxColliders of the spawner is 0");
  device.waitIdle();
  gpgpDestroyContext(context);
}

} // namespace
