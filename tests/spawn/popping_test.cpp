// Walks through a wood and a town that are derived anew in each frame: levels of detail that fade do not pop, and their
// picture is within a few pixels of the finest level's; also where a budget chooses the detail.
#include "walk_scene.h"

#include <gtest/gtest.h>

namespace {
using namespace gpgp::test;

TEST(Popping, LevelsFadeWhereHardOnesPop) {
  constexpr float kBegin = 140, kEnd = 40, kStep = 0.25f; // metres from the first row of trees
  const char* const file = GPGP_WORLD "/wood.pga";
  WalkScene finest(file, {{"pixels", 0}}, woodAxioms()), fading(file, {}, woodAxioms()),
      hard(file, {{"band", 1.0001f}}, woodAxioms());
  Walk withFading, withHard;
  int distance = 0, frames = 0;
  Picture finestBefore;
  for (float at = kBegin; at > kEnd; at -= kStep, ++frames) {
    const Eye eye{{1.3f, 2, at}, {0, 3, 0}};
    Picture finestNow = finest.from(eye);
    const std::vector<int> base = frames ? changed(finestBefore, finestNow) : std::vector<int>();
    withFading.add(fading.from(eye), base);
    withHard.add(hard.from(eye), base);
    if (frames % 20 == 0)
      distance = std::max(
          {distance, farthest(withFading.before, finestNow, true), farthest(finestNow, withFading.before, true)});
    finestBefore = std::move(finestNow);
  }
  // Hard levels pop, so popping would be seen; fading ones do not, and are as near as their details are small.
  EXPECT_GT(withHard.tilesThatPop, 5u);
  EXPECT_EQ(withFading.tilesThatPop, 0u) << withFading.worstTile << " pixels of a tile";
  EXPECT_LT(withFading.worstTile, withHard.worstTile / 2);
  EXPECT_LE(distance, 8); // half of `pixels`
  EXPECT_LT(fading.instances, finest.instances / 8);
  RecordProperty("frames", frames);
  RecordProperty("hard", withHard.worstTile);
  RecordProperty("fading", withFading.worstTile);
  RecordProperty("from_finest", distance);
}

TEST(Popping, ATownFades) {
  const char* const file = GPGP_WORLD "/town.pga";
  WalkScene finest(file, {{"pixels", 0}}, townAxioms()), fading(file, {}, townAxioms()),
      hard(file, {{"band", 1.0001f}}, townAxioms());
  Walk withFading, withHard;
  Picture finestBefore;
  int frames = 0;
  for (float at = 150; at > -20; at -= 0.5f, ++frames) { // from the fields into its first street
    const Eye eye{{0, 1.7f, at}, {2, 4, at - 60}};
    Picture finestNow = finest.from(eye);
    const std::vector<int> base = frames ? changed(finestBefore, finestNow) : std::vector<int>();
    withFading.add(fading.from(eye), base);
    withHard.add(hard.from(eye), base);
    finestBefore = std::move(finestNow);
  }
  EXPECT_GT(withHard.tilesThatPop, 5u);
  EXPECT_EQ(withFading.tilesThatPop, 0u) << withFading.worstTile << " pixels of a tile";
  EXPECT_LT(withFading.worstTile, withHard.worstTile);
  EXPECT_LT(fading.instances, finest.instances / 3);
  RecordProperty("frames", frames);
  RecordProperty("hard", withHard.worstTile);
  RecordProperty("fading", withFading.worstTile);
}

} // namespace
