// Context queries beyond an axiom, against distances of boxes in closed form.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wrestrict" // gcc 12 sees overlaps in sums of strings where there are none
#endif
#include "cga_run.h"

#include <random>
#include <sstream>

namespace gpgp::spawn::cga {
namespace {

struct Box {
  glm::dvec3 low, high;
};
/// Of lots in steps of half a metre, so that many boxes touch.
Box boxOf(const Axiom& axiom, double height) {
  return {glm::dvec3(axiom.origin), glm::dvec3(axiom.origin) + glm::dvec3(axiom.size.x, height, axiom.size.z)};
}
double distanceOf(const Box& a, const Box& b) {
  const glm::dvec3 gap = glm::max(glm::dvec3(0), glm::max(a.low - b.high, b.low - a.high));
  return glm::length(gap);
}
bool doOverlap(const Box& a, const Box& b) {
  return glm::all(glm::greaterThan(glm::min(a.high, b.high), glm::max(a.low, b.low)));
}
bool isIn(const Box& a, const Box& b) {
  return glm::all(glm::greaterThanEqual(a.low, b.low)) && glm::all(glm::lessThanEqual(a.high, b.high));
}

struct Town {
  std::vector<Axiom> lots;
  std::vector<Box> boxes;
};
Town townOf(uint32_t seed, uint32_t count, uint32_t extent) {
  std::mt19937 random(seed);
  const auto below = [&](uint32_t n) { return static_cast<float>(random() % n); };
  Town town;
  for (uint32_t i = 0; i < count; ++i) {
    Axiom axiom = lot(0.5f * (1 + below(12)), 0.5f * (1 + below(12)), i);
    axiom.origin = {0.5f * below(extent), 0.5f * below(3), 0.5f * below(extent)};
    const float height = 0.5f * (1 + below(8));
    axiom.attributes = {{"height", std::to_string(height)}};
    town.boxes.push_back(boxOf(axiom, height));
    town.lots.push_back(std::move(axiom));
  }
  return town;
}

const char* const kOcclusion =
    R"(print("" + overlaps(inter, "mass") + " " + touches(inter, "mass") + " " + inside(inter, "mass")))";

/// overlaps, touches and inside of each box among the others.
std::vector<std::string> occlusionOf(const Town& town) {
  std::vector<std::string> texts;
  const auto text = [](bool value) { return std::string(value ? "true" : "false"); };
  for (size_t i = 0; i < town.boxes.size(); ++i) {
    bool overlaps = false, touches = false, inside = false;
    for (size_t k = 0; k < town.boxes.size(); ++k) {
      if (i == k) continue;
      const Box &a = town.boxes[i], &b = town.boxes[k];
      overlaps |= doOverlap(a, b);
      touches |= distanceOf(a, b) == 0 && !doOverlap(a, b);
      inside |= isIn(a, b);
    }
    texts.push_back(text(overlaps) + " " + text(touches) + " " + text(inside));
  }
  return texts;
}

TEST(CgaContext, BoxesOfOtherAxiomsOverlapTouchAndContain) {
  for (uint32_t seed = 1; seed <= 20; ++seed) {
    const Town town = townOf(seed, 90, 100);
    const std::vector<std::string> expected = occlusionOf(town);
    const std::string labelled =
        std::string("attr height = 1\nLot --> extrude(height) label(\"mass\") ") + kOcclusion + " Mass.";
    const Derived d = run(labelled, town.lots);
    EXPECT_EQ(d.messages, "");
    EXPECT_EQ(d.all.prints, expected) << seed;
    // Without a label: shapes that derivations end in, and those that were taken apart.
    for (const char* end : {" Mass.", " comp(f) { top: Roof. | all: Wall. }"}) {
      const Derived u = run(R"(attr height = 1
          Lot --> extrude(height) print("" + overlaps(inter) + " " + touches(inter) + " " + inside(inter, "")))" +
                                std::string(end),
                            town.lots);
      EXPECT_EQ(u.messages, "");
      EXPECT_EQ(u.all.prints, expected) << seed << end;
    }
  }
}

TEST(CgaContext, DistancesCountsAndRanksAmongOtherAxioms) {
  for (uint32_t seed = 1; seed <= 10; ++seed) {
    const Town town = townOf(100 + seed, 150, 400);
    const Derived d = run(R"(attr height = 1
        Lot --> extrude(height) label("mass")
          print(minimumDistance(inter, "mass") + " " + contextCount(inter, "mass") + " "
            + contextCompare(inter, "mass", world.highest) + " " + contextCount(all, "mass") + " "
            + contextCount(intra, "mass")) Mass.)",
                          town.lots);
    EXPECT_EQ(d.messages, "");
    ASSERT_EQ(d.all.prints.size(), town.lots.size());
    double worst = 0;
    for (size_t i = 0; i < town.boxes.size(); ++i) {
      double least = 1e300;
      int higher = 0;
      for (size_t k = 0; k < town.boxes.size(); ++k) {
        if (i == k) continue;
        least = std::min(least, distanceOf(town.boxes[i], town.boxes[k]));
        higher += town.boxes[k].high.y > town.boxes[i].high.y;
      }
      std::istringstream text(d.all.prints[i]);
      double distance = -1;
      int count = -1, rank = -1, all = -1, own = -1;
      text >> distance >> count >> rank >> all >> own;
      worst = std::max(worst, std::fabs(distance - least) / (1 + least));
      EXPECT_EQ(count, 149);
      EXPECT_EQ(rank, higher) << seed << ": " << i;
      EXPECT_EQ(all, 150);
      EXPECT_EQ(own, 1);
    }
    EXPECT_LT(worst, 1e-5) << seed;
  }
}

TEST(CgaContext, OtherAxiomsAreThoseOfADerivationThatDoesNotLookBeyond) {
  std::vector<Axiom> lots = {lot(4, 4), lot(4, 4), lot(4, 4)};
  lots[1].origin = {3, 0, 0};
  lots[2].origin = {20, 0, 0};
  // Both of the two that overlap see the other, which would be there without them.
  const Derived d = run(R"(Lot --> extrude(2) Ask
      Ask --> case overlaps(inter, "m"): Gone. else: label("m") Mass.)",
                        lots);
  EXPECT_EQ(d.messages, "");
  EXPECT_EQ(d.rules.at("Gone"), 2u);
  EXPECT_EQ(d.rules.at("Mass"), 1u);
  // What a query within the axiom decides is decided there as well: the second label is gone, and 3 m farther.
  const Derived own = run(R"(Lot --> extrude(2) label("a") Next
      Next --> case contextCount(intra, "a") == 1: t(0, 0, 0.5) label("b") Ask else: label("wrong") Ask
      Ask --> print(minimumDistance(inter, "b") + " " + contextCount(inter, "wrong")) Mass.)",
                          {lots[0], lots[2]});
  EXPECT_EQ(own.all.prints, (std::vector<std::string>{"16 0", "16 0"}));
  // Nothing is there: as far as can be, and a target that is none is named.
  const Derived none = run(R"(Lot --> print(minimumDistance(inter, "b") > 1000000) print(overlaps(front, "b")) Mass.)",
                           {lots[0], lots[1]});
  EXPECT_EQ(none.all.prints, (std::vector<std::string>{"true", "false", "true", "false"}));
  EXPECT_NE(none.messages.find("context queries look at intra, inter or all, not at 'front'"), std::string::npos);
}

TEST(CgaContext, IsTheSameForAllThreads) {
  const Town town = townOf(7, 300, 150);
  const std::string text =
      std::string("attr height = 1\nLot --> extrude(height) label(\"mass\") ") + kOcclusion +
      "split(y) { 0.5: print(minimumDistance(all, \"mass\")) case touches(all, \"mass\"): A. else: B. | ~1: C. }";
  DeriveOptions options;
  options.threads = 1;
  const Derived one = run(text, town.lots, options);
  EXPECT_EQ(one.messages, "");
  for (const uint32_t threads : {2u, 5u}) {
    options.threads = threads;
    const Derived several = run(text, town.lots, options);
    EXPECT_EQ(one.all.prints, several.all.prints);
    EXPECT_EQ(one.rules, several.rules);
  }
  // What is found once serves derivations in parts.
  Messages messages;
  const auto program = compiled(text, messages);
  ASSERT_TRUE(program);
  Surroundings surroundings;
  addSurroundings(*program, town.lots, options, surroundings);
  surroundings.build();
  options.surroundings = &surroundings;
  std::vector<std::string> prints;
  for (size_t first = 0; first < town.lots.size(); first += 100) {
    options.firstAxiom = static_cast<uint32_t>(first);
    const auto begin = town.lots.begin() + static_cast<ptrdiff_t>(first);
    const Derivation part = derive(*program, {begin, begin + 100}, options, messages);
    prints.insert(prints.end(), part.prints.begin(), part.prints.end());
  }
  EXPECT_EQ(one.all.prints, prints);
}

} // namespace
} // namespace gpgp::spawn::cga
