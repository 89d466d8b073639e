// Recordings that take over decisions of the previous one, against recordings of the same frames that decide all.
#include "gpu.h"
#include "measured_scenes.h"
#include "visibility/reuse/reuse.h"

#include <glm/ext/matrix_transform.hpp>

#include <bit>
#include <random>

namespace gpgp::test {
namespace {
using namespace visibility;

constexpr uint32_t kWidth = 40, kHeight = 24;
constexpr float kMaxLate = 0.02f; // in pictures as small as these much changes from frame to frame
using Bits = std::vector<uint32_t>;

bool has(const Bits& bits, uint32_t id) { return id / 32 < bits.size() && (bits[id / 32] >> (id % 32) & 1); }
uint32_t countOf(const Bits& bits) {
  uint32_t count = 0;
  for (const uint32_t word : bits) count += static_cast<uint32_t>(std::popcount(word));
  return count;
}
uint32_t countOf(const Bits& bits, const Bits& without) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < bits.size() * 32; ++i) count += has(bits, i) && !has(without, i);
  return count;
}

/// What the list of changes says of two sets.
Bits changesOf(const Bits& before, const Bits& now) {
  Bits list(4);
  const auto size = static_cast<uint32_t>(std::max(before.size(), now.size()) * 32);
  for (uint32_t i = 0; i < size; ++i)
    if (has(now, i) && !has(before, i)) list.push_back(i);
  list[0] = static_cast<uint32_t>(list.size() - 4);
  for (uint32_t i = 0; i < size; ++i)
    if (has(before, i) && !has(now, i)) list.push_back(i);
  list[1] = static_cast<uint32_t>(list.size() - 4) - list[0];
  return list;
}

// Whatever their lengths, arcs that follow each other come to every group within a turn, and to none twice.
TEST(Reuse, ArcsDecideEachGroupOnceInATurn) {
  std::mt19937 engine(3);
  for (int round = 0; round < 50; ++round) {
    auto first = static_cast<uint32_t>(engine());
    uint64_t turned = 0;
    std::vector<int> decided(2000);
    while (true) {
      const auto share = static_cast<uint32_t>(0x20000000u + engine() % 0x60000000u);
      if (turned + share > uint64_t{1} << 32) break;
      for (uint32_t g = 0; g < decided.size(); ++g)
        decided[g] += shader::isDue(
            g * shader::kReuseGroupWords + static_cast<uint32_t>(engine()) % shader::kReuseGroupWords, first, share);
      first = shader::endOfArc(first, share);
      turned += share;
    }
    const auto rest = static_cast<uint32_t>((uint64_t{1} << 32) - turned);
    for (uint32_t g = 0; g < decided.size(); ++g)
      EXPECT_EQ(decided[g] + shader::isDue(g * shader::kReuseGroupWords, first, rest), 1) << g;
  }
}

// Simulated: of each group a share changes in each recording. Arcs of the length that is chosen for it leave as many
// late as were allowed, if that length is within its limits, and fewer if it is held at the largest.
TEST(Reuse, ArcsAreAsLongAsLatenessAllows) {
  constexpr uint32_t kGroups = 1000, kFrames = 200;
  for (const float maxLate : {0.0005f, 0.005f, 0.02f})
    for (const float rate : {0.0001f, 0.001f, 0.004f, 0.02f, 0.1f}) {
      const uint32_t share = shader::shareFor(rate, maxLate);
      std::vector<uint32_t> waits(kGroups);
      uint32_t first = 12345;
      double late = 0;
      for (uint32_t frame = 0; frame < kFrames; ++frame) {
        for (uint32_t g = 0; g < kGroups; ++g) {
          waits[g] = shader::isDue(g * shader::kReuseGroupWords, first, share) ? 0 : waits[g] + 1;
          if (frame >= 16) late += static_cast<double>(rate) * waits[g] / kGroups / (kFrames - 16);
        }
        first = shader::endOfArc(first, share);
      }
      EXPECT_LE(late, static_cast<double>(maxLate) * 1.05) << rate;
      if (share == shader::kReuseAll) {
        EXPECT_EQ(late, 0) << rate;
      } else if (share > 0x20000000u) {
        EXPECT_GE(late, static_cast<double>(maxLate) * 0.7) << rate;
      }
    }
  EXPECT_EQ(shader::shareFor(shader::kNotMeasured, 0.01f), shader::kReuseAll);
}

TEST(Reuse, ChecksumsTellTrianglesApart) {
  const glm::vec4 a(1, 2, 3, 4), b(5, 6, 7, 8), c(9, 10, 11, 12);
  const auto sum = shader::checksumOf(7, 1, false, a, b, c);
  EXPECT_NE(sum, shader::checksumOf(8, 1, false, a, b, c));
  EXPECT_NE(sum, shader::checksumOf(7, 2, false, a, b, c));
  EXPECT_NE(sum, shader::checksumOf(7, 1, true, a, b, c));
  EXPECT_NE(sum, shader::checksumOf(7, 1, false, b, a, c));
  for (int k = 0; k < 12; ++k) {
    glm::vec4 moved[3] = {a, b, c};
    float& number = moved[k / 4][k % 4];
    number = std::nextafter(number, 100.0f);
    const auto other = shader::checksumOf(7, 1, false, moved[0], moved[1], moved[2]);
    EXPECT_NE(sum.x, other.x) << k;
    EXPECT_NE(sum.y, other.y) << k;
  }
}

struct ReuseTest : VisibilityGpuTest {
  struct Frame {
    Bits standard, whole;
    GpuResult reused;
    GpuResult all;
  };
  GpgpRecorder exact = nullptr, standard = nullptr;
  GpgpHistory view = nullptr;
  bool comparesCentres = false;

  void begin(const Scene& scene, float maxLate) {
    exact = createRecorder(kWidth, kHeight, 0, true, GPGP_SAMPLING_EXACT_BIT, 0, 0, 0, 0, 0, scene.params.maxNonOpaque);
    standard =
        createRecorder(kWidth, kHeight, 0, true, GPGP_SAMPLING_STANDARD_BIT, 0, 0, 0, 0, 0, scene.params.maxNonOpaque);
    view = createView(1u << 17, maxLate);
  }
  /// One frame, sampled in three ways.
  Frame record(Scene& scene) {
    Frame frame;
    const GpgpAsset set = createGeometrySet(scene);
    if (comparesCentres) frame.standard = sample(scene, standard, set, {.byDraw = false}).bits;
    frame.all = sample(scene, exact, set, {.method = GPGP_SAMPLING_EXACT, .byDraw = false});
    frame.whole = frame.all.bits;
    frame.reused = sample(scene, exact, set, {.view = view, .method = GPGP_SAMPLING_EXACT, .byDraw = false});
    gpgpDestroyAsset(set);
    return frame;
  }
  void end() { gpgpDestroyHistory(view); }
  void standStill(bool tested);
};

/// A viewer's place and where it looks, by random steps that it keeps up for some frames.
struct Walker {
  std::mt19937 engine;
  glm::vec3 eye;
  float heading, step = 0, turn = 0;

  void move(uint32_t frame) {
    const auto between = [&](float low, float high) {
      return std::uniform_real_distribution<float>(low, high)(engine);
    };
    if (frame % 6 == 0) step = between(0.0f, 0.004f), turn = between(-0.0005f, 0.0005f);
    heading += turn;
    eye += glm::vec3(std::cos(heading), 0, std::sin(heading)) * step;
  }
  void look(Scene& scene) const {
    setWalkingCamera(scene, eye, eye + glm::vec3(std::cos(heading), 0.05f, std::sin(heading)) * 10.0f, kWidth, kHeight,
                     true);
  }
};

// Random walks through scenes of small triangles, in which a draw moves, one comes and goes, and draws are added, so
// that the number of triangles grows. What is decided is what a recording without reuse decides; what is not decided is
// what it was before or has been seen since; and few are late.
TEST_F(ReuseTest, WalksFindWhatWholeRecordingsFind) {
  double late = 0, kept = 0, visible = 0;
  uint64_t pixels = 0, allPixels = 0;
  uint32_t shared = 0;
  for (uint32_t seed = 0; seed < 2; ++seed) {
    Scene scene = seed == 0 ? city(3) : foliage(1000);
    Walker walker{std::mt19937(seed), seed == 0 ? glm::vec3(-5, 1.7f, 5.5f) : glm::vec3(-3, 1.7f, 5),
                  seed == 0 ? 0.1f : -1.4f};
    const auto mover = static_cast<uint32_t>(scene.draws.size() - 1);
    scene.addDraw(scene.draws[mover].mesh, glm::translate(glm::mat4(1), walker.eye + glm::vec3(2, -1, -4)));
    const auto blinker = static_cast<uint32_t>(scene.draws.size() - 1);
    const shader::Draw added = scene.draws[blinker];
    begin(scene, kMaxLate);
    comparesCentres = true;
    Bits before;
    for (uint32_t i = 0; i < 14; ++i) {
      walker.move(i);
      walker.look(scene);
      scene.draws[mover].transform[3] += i % 2 ? 0.01f : -0.005f;
      scene.draws[blinker].flags = i % 6 < 4 ? 0 : shader::kDisabled;
      if (i == 9) scene.addDraw(added.mesh, glm::translate(glm::mat4(1), walker.eye + glm::vec3(-2, 0, -6)));
      const Frame frame = record(scene);
      const Bits& now = frame.reused.bits;
      const std::string where = "scene " + std::to_string(seed) + ", frame " + std::to_string(i);
      const uint32_t first = frame.reused.reuseFirst, share = frame.reused.reuseShare;
      ASSERT_NE(share, 0u) << where; // something moves
      uint32_t wrong = 0, lost = 0, stale = 0, unseen = 0, blinks = 0;
      for (uint32_t id = 0; id < now.size() * 32; ++id) {
        if (shader::isDue(id / 32, first, share)) wrong += has(now, id) != has(frame.whole, id);
        lost += has(frame.whole, id) && has(before, id) && !has(now, id);
        stale += has(now, id) && !has(frame.whole, id) && !has(before, id);
        unseen += has(frame.standard, id) && has(frame.whole, id) && !has(now, id);
      }
      const shader::Draw& draw = scene.draws[blinker];
      if (i % 6 == 0 && i) // it was not there before: nothing of it may be late
        for (uint32_t k = 0; k < scene.meshes[draw.mesh].indexCount / 3; ++k)
          blinks += has(now, draw.firstTriangle + k) != has(frame.whole, draw.firstTriangle + k);
      EXPECT_EQ(wrong, 0u) << where << ": of those that are decided";
      EXPECT_EQ(lost, 0u) << where << ": visible before and now";
      EXPECT_EQ(stale, 0u) << where << ": neither visible now nor before";
      EXPECT_EQ(unseen, 0u) << where << ": at pixel centres";
      EXPECT_EQ(blinks, 0u) << where << ": of a draw that has come";
      const Bits changes = changesOf(before, now);
      EXPECT_TRUE(std::equal(changes.begin(), changes.end(), frame.reused.changed.begin() + 0,
                             frame.reused.changed.begin() + static_cast<std::ptrdiff_t>(changes.size())))
          << where;
      EXPECT_LE(frame.reused.report.decidedPixels, frame.all.report.decidedPixels) << where;
      EXPECT_EQ(frame.reused.report.decided + frame.reused.report.reused, frame.all.report.decided) << where;
      const double all = countOf(frame.whole), missing = countOf(frame.whole, now), extra = countOf(now, frame.whole);
      EXPECT_LE(missing / all, 3 * static_cast<double>(kMaxLate)) << where;
      EXPECT_LE(extra / all, 3 * static_cast<double>(kMaxLate)) << where;
      late += missing, kept += extra, visible += all;
      shared += share != shader::kReuseAll;
      pixels += frame.reused.report.decidedPixels, allPixels += frame.all.report.decidedPixels;
      before = now;
    }
    end();
  }
  std::printf("late %.3f %%, kept %.3f %%; %.1f %% of the pixels decided, in %u frames not all\n", 100 * late / visible,
              100 * kept / visible, 100.0 * static_cast<double>(pixels) / static_cast<double>(allPixels), shared);
  EXPECT_LE(late / visible, static_cast<double>(kMaxLate));
  EXPECT_LE(kept / visible, static_cast<double>(kMaxLate));
  EXPECT_GT(shared, 4u);
  EXPECT_LT(pixels, allPixels);
}

void ReuseTest::standStill(bool tested) {
  Scene scene = foliage(tested ? 60 : 1000);
  if (tested) {
    scene.coordinates.resize(scene.positions.size() / 3 * 2, 0.25f);
    scene.textures = {{.width = 2, .height = 2, .alpha = {255, 255, 255, 255}}};
    scene.draws[0].flags |= 1u << 8;
    scene.params.maxNonOpaque = 8192;
  }
  Walker walker{std::mt19937(9), {-3, 1.7f, 5}, -1.4f};
  begin(scene, kMaxLate);
  const auto expectExact = [&](const Frame& frame, const char* what) {
    EXPECT_EQ(frame.reused.bits, frame.whole) << what << tested;
    EXPECT_EQ(frame.reused.list, frame.all.list) << what << tested;
    EXPECT_EQ(frame.reused.sizes, frame.all.sizes) << what << tested;
    const uint32_t share = frame.reused.reuseShare; // of what is decided
    if (share == 0 || share == shader::kReuseAll) {
      EXPECT_EQ(frame.reused.report.unresolved, frame.all.report.unresolved) << what << tested;
    } else {
      EXPECT_LE(frame.reused.report.unresolved, frame.all.report.unresolved) << what << tested;
    }
  };
  uint32_t shared = 0;
  for (uint32_t i = 0; i < (tested ? 3 : 5); ++i) {
    walker.step = 0.002f, walker.turn = 0;
    walker.move(1);
    walker.look(scene);
    const Frame frame = record(scene);
    if (i == 0) expectExact(frame, "first");
    shared += frame.reused.reuseShare != shader::kReuseAll;
  }
  if (!tested) {
    EXPECT_GT(shared, 0u);
  }
  const Frame stopped = record(scene);
  expectExact(stopped, "stopped");
  EXPECT_GT(stopped.reused.report.decidedPixels, 0u);
  for (int i = 0; i < 2; ++i) {
    const Frame still = record(scene);
    expectExact(still, "still");
    if (tested) {
      EXPECT_NE(still.reused.reuseShare, 0u);
      continue;
    }
    EXPECT_EQ(still.reused.report.decidedPixels, 0u);
    EXPECT_EQ(still.reused.report.decided, 0u);
    EXPECT_EQ(still.reused.report.reused, still.all.report.decided);
    EXPECT_EQ(still.reused.report.appeared + still.reused.report.disappeared, 0u);
  }
  if (!tested) {
    scene.draws[1].transform[3] += 1e-3f;
    expectExact(record(scene), "a draw has moved");
    expectExact(record(scene), "and rests");
    scene.draws[1].flags |= shader::kDisabled;
    expectExact(record(scene), "a draw is left out");
  }
  end();
}

// After a walk, the first frame in which nothing moves has exactly what a recording without reuse finds. From then on
// nothing is decided, until one draw moves a little, is left out, or the camera does.
TEST_F(ReuseTest, WhatStandsStillIsExactAndDecidedOnce) { standStill(false); }
// Textures may change in secret, so that nothing proves that all is the same.
TEST_F(ReuseTest, WhatIsAlphaTestedIsDecidedAgain) { standStill(true); }

// A jump of the camera, recordings of another method, another viewport: nothing of before is taken over.
TEST_F(ReuseTest, JumpsAndOtherRecordingsDecideAll) {
  Scene scene = city(3);
  begin(scene, 0.05f);
  Walker walker{std::mt19937(9), {-5, 1.7f, 5.5f}, 0.1f};
  const auto walk = [&](int frames) {
    Frame frame;
    for (int i = 0; i < frames; ++i) {
      walker.step = 0.001f, walker.turn = 0;
      walker.move(1);
      walker.look(scene);
      frame = record(scene);
    }
    return frame;
  };
  EXPECT_NE(walk(4).reused.reuseShare, shader::kReuseAll);
  walker.eye = {17, 1.7f, 30}, walker.heading = -1.5f;
  Frame frame = walk(1);
  EXPECT_EQ(frame.reused.reuseShare, shader::kReuseAll);
  EXPECT_EQ(frame.reused.bits, frame.whole);
  EXPECT_NE(walk(4).reused.reuseShare, shader::kReuseAll);
  const GpgpAsset set = createGeometrySet(scene);
  sample(scene, standard, set, {.view = view});
  frame = walk(1);
  EXPECT_EQ(frame.reused.reuseShare, shader::kReuseAll);
  EXPECT_EQ(frame.reused.bits, frame.whole);
  walk(2);
  sample(scene, exact, set, {.view = view, .method = GPGP_SAMPLING_EXACT, .width = 32, .height = 20});
  const GpuResult wide = sample(scene, exact, set, {.view = view, .method = GPGP_SAMPLING_EXACT});
  EXPECT_EQ(wide.reuseShare, shader::kReuseAll);
  EXPECT_EQ(wide.bits, sample(scene, exact, set, {.method = GPGP_SAMPLING_EXACT}).bits);
  // With a reach the result is another one, and nothing of it may be left.
  const GpuResult reaching = sample(scene, exact, set, {.view = view, .method = GPGP_SAMPLING_EXACT, .reach = 0.1f});
  EXPECT_EQ(reaching.bits, sample(scene, exact, set, {.method = GPGP_SAMPLING_EXACT, .reach = 0.1f}).bits);
  EXPECT_EQ(sample(scene, exact, set, {.view = view, .method = GPGP_SAMPLING_EXACT}).bits, wide.bits);
  gpgpDestroyAsset(set);
  end();
}

} // namespace
} // namespace gpgp::test
