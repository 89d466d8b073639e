// Exact and truth sampling: the GPU against the twin bit for bit, and exact against truth.
#include "gpu.h"
#include "measured_scenes.h"
#include "visibility/sampling/sampler.h"

#include <bit>
#include <glm/ext/matrix_transform.hpp>

namespace gpgp::test {
namespace {
using namespace visibility;

struct Compared {
  uint32_t truth = 0, found = 0, extra = 0;
};
Compared compare(const std::vector<uint32_t>& bits, const std::vector<uint32_t>& truth) {
  Compared c;
  for (size_t i = 0; i < truth.size(); ++i) {
    c.truth += static_cast<uint32_t>(std::popcount(truth[i]));
    c.found += static_cast<uint32_t>(std::popcount(truth[i] & bits[i]));
    c.extra += static_cast<uint32_t>(std::popcount(bits[i] & ~truth[i]));
  }
  return c;
}

/// Small pictures of the measured scenes.
std::vector<std::pair<std::string, Scene>> smallScenes() {
  std::vector<std::pair<std::string, Scene>> scenes;
  Scene bunnies = bunnyGrid(1, 2);
  setOrbitCamera(bunnies, 1, 8, 3.0f, 96, 72);
  scenes.emplace_back("bunnies", std::move(bunnies));
  Scene columns = colonnadeWithWires(0.4f);
  setWalkingCamera(columns, {0.3f, 1.7f, 3}, {0, 1.5f, -10}, 96, 54, true);
  scenes.emplace_back("colonnade", std::move(columns));
  Scene hedge = foliage(4000);
  setWalkingCamera(hedge, {1, 1.7f, 7}, {0, 1.5f, 0}, 80, 45, true);
  scenes.emplace_back("foliage", std::move(hedge));
  Scene houses = city(6);
  setOrbitCamera(houses, 1, 8, 1.2f, 96, 54, false);
  scenes.emplace_back("city", std::move(houses));
  Scene fronts = houseFronts();
  setWalkingCamera(fronts, {12, 26, 60}, {0, 8, -20}, 1920, 1080, true);
  scenes.emplace_back("fronts", cropped(fronts, 900, 480, 96, 64));
  setWalkingCamera(fronts, {12, 26, 60}, {0, 8, -20}, 240, 135, true); // lists of more than a batch
  scenes.emplace_back("far fronts", cropped(fronts, 104, 56, 24, 16));
  return scenes;
}

TEST(ExactTwin, FindsTheTruthAndHardlyMore) {
  for (auto& [name, scene] : smallScenes()) {
    std::vector<uint32_t> sizes;
    const TwinResult truth = truthOnCpu(scene.input(), 64, sizes);
    const TwinResult exact = sampleExactOnCpu(scene.input());
    const Compared c = compare(exact.bits, truth.bits);
    EXPECT_GT(c.truth, 500u) << name;
    // With the order by one depth each alone the fronts have 99.46 % and 0.68 %, the far ones 96.59 % and 0.73 %.
    // What the far ones miss, 12 of 3 311, are in their pixels' lists, and lost between one batch and the next.
    EXPECT_GE(c.found, c.truth * (name == "fronts" ? 0.998 : name == "far fronts" ? 0.996 : 0.99)) << name;
    // The colonnade's far columns are tens of slivers a pixel that interleave in depth.
    EXPECT_LE(c.extra, c.truth * (name == "colonnade" ? 0.01
                                  : name == "city"    ? 0.001
                                  : name == "fronts"  ? 0.004
                                                      : 0.005))
        << name;
    const TwinResult standard = sampleOnCpu(scene.input());
    EXPECT_LT(compare(standard.bits, truth.bits).found, c.truth * 0.8) << name; // or the scene tests nothing
    uint32_t counted = 0;
    for (const uint32_t size : sizes) counted += size > 0;
    EXPECT_EQ(counted, c.truth);
  }
}

TEST_F(VisibilityGpuTest, ExactEqualsTheTwin) {
  for (auto& [name, scene] : smallScenes()) {
    const TwinResult twin = sampleExactOnCpu(scene.input());
    expectEqual(sample(scene, {.method = GPGP_SAMPLING_EXACT}), twin, name);
    EXPECT_GT(twin.counters.pairs, 1000u) << name;
  }
}

TEST_F(VisibilityGpuTest, ExactOfTrianglesThroughAllPlanesEqualsTheTwin) {
  for (uint32_t seed = 0; seed < 6; ++seed) {
    Scene scene = randomSoup(seed, 20 + 60 * seed, 150 + 7 * seed, 90, seed % 2, seed % 3 == 0);
    const TwinResult twin = sampleExactOnCpu(scene.input());
    expectEqual(sample(scene, {.method = GPGP_SAMPLING_EXACT}), twin, "seed " + std::to_string(seed));
    EXPECT_GE(twin.counters.visible, sampleOnCpu(scene.input()).counters.visible);
  }
}

// Scenes in so few pixels that most have lists of several batches, and some more than are decided.
TEST_F(VisibilityGpuTest, ExactOfManyTrianglesInAPixelEqualsTheTwin) {
  std::vector<Scene> scenes = {foliage(4000), colonnadeWithWires(0.4f), houseFronts()};
  setWalkingCamera(scenes[0], {1, 1.7f, 7}, {0, 1.5f, 0}, 12, 7, true);
  setWalkingCamera(scenes[1], {0.3f, 1.7f, 3}, {0, 1.5f, -10}, 16, 9, false);
  setWalkingCamera(scenes[2], {12, 26, 60}, {0, 8, -20}, 12, 7, true);
  for (size_t i = 0; i < scenes.size(); ++i) {
    Scene& scene = scenes[i];
    const TwinResult twin = sampleExactOnCpu(scene.input());
    EXPECT_GT(twin.counters.pairs, shader::kBatch * scene.params.width * scene.params.height);
    const GpuResult gpu = sample(scene, {.method = GPGP_SAMPLING_EXACT});
    expectEqual(gpu, twin, std::to_string(i));
    if (i == 1) {
      EXPECT_GT(gpu.report.unresolved, 0u); // a pixel's list of 4 305, most of the columns
    }
  }
}

/// One pixel in `bands` of four units, from near to far. In each 32 triangles whose planes are tangent to one arch, so
/// that each is nearest somewhere, and all are doubtful.
Scene fan(int bands) {
  Scene scene;
  constexpr double kStep = 6, kBend = 0.003 / 65536;
  for (int band = 0; band < bands; ++band)
    for (int i = 0; i < 32; ++i) {
      const double touch = kStep * (i + 0.5), from = touch - 100;
      for (const auto& [x, y] : {std::pair(0, 1), {256, 1}, {0, 5}}) {
        const double z = 0.5 + 0.49 * (band + 0.5) / 63 - kBend * from * (from + 2 * (x - touch));
        scene.indices.push_back(scene.addVertex(static_cast<float>(x) / 128 - 1,
                                                static_cast<float>(4 * band + y) / 128 - 1, static_cast<float>(z)));
      }
    }
  scene.addDraw(scene.addMesh(0), glm::mat4(1.0f), shader::kTwoSided);
  scene.setCamera(glm::mat4(1.0f), 1, 1);
  return scene;
}

// Every batch takes as many turns as it may, so that lists end where a device's limit on loops would have ended them.
TEST_F(VisibilityGpuTest, ExactOfManyDoubtfulTrianglesShowsAllOfThem) {
  for (const int bands : {40, 63}) {
    Scene scene = fan(bands);
    const TwinResult twin = sampleExactOnCpu(scene.input());
    EXPECT_EQ(twin.counters.visible, scene.params.triangleCount);
    const GpuResult gpu = sample(scene, {.method = GPGP_SAMPLING_EXACT});
    expectEqual(gpu, twin, std::to_string(bands));
    EXPECT_EQ(gpu.report.unresolved > 0, bands == 63);
  }
}

// A sheet that faces the camera: some seventy, four hundred and more than a thousand triangles in each pixel, all of
// exactly one depth, and a smaller one behind it, of which nothing can be seen.
TEST_F(VisibilityGpuTest, ExactOfManyTrianglesOfOneDepthEqualsTheTwin) {
  for (const auto& [cells, size] : {std::pair(48u, 8u), {128u, 8u}, {128u, 4u}}) {
    Scene scene = sheet(5, cells, 0.3f);
    scene.addDraw(0);
    const uint32_t hidden = scene.params.triangleCount;
    scene.addDraw(0, glm::translate(glm::mat4(1.0f), {0, 0, -0.1f}) * glm::scale(glm::mat4(1.0f), glm::vec3(0.5f)));
    scene.setCamera(perspective(1.0f, 1.0f, 0.05f, 10.0f) * lookAt({0, 0, 1.8f}, {0, 0, 0}), size, size);
    const TwinResult twin = sampleExactOnCpu(scene.input());
    EXPECT_GT(twin.counters.pairs, cells * cells * 3 / 2);
    const auto isSeen = [&](uint32_t id) { return (twin.bits[id / 32] >> (id % 32) & 1) != 0; };
    uint32_t behind = 0;
    for (uint32_t id = hidden; id < scene.params.triangleCount; ++id) behind += isSeen(id);
    EXPECT_EQ(behind > 0, size == 4) << cells; // that takes too long
    EXPECT_GT(twin.counters.visible, sampleOnCpu(scene.input()).counters.visible * 8);
    const GpuResult gpu = sample(scene, {.method = GPGP_SAMPLING_EXACT});
    expectEqual(gpu, twin, "sheet of " + std::to_string(cells) + " in " + std::to_string(size));
    EXPECT_EQ(gpu.report.unresolved > 0, size == 4);
  }
}

TEST_F(VisibilityGpuTest, TruthEqualsTheTwinSliceBySlice) {
  Scene scene = colonnadeWithWires(0.3f);
  setWalkingCamera(scene, {0.3f, 1.7f, 3}, {0, 1.5f, -10}, 48, 27, true);
  for (const uint32_t slice : {0u, 5u, 255u, 256u}) {
    const TwinInput in = [&] {
      TwinInput input = scene.input();
      const bool centre = slice == 256;
      input.params.method = shader::kTruth;
      input.params.gridShift = centre ? 8 : 6;
      input.params.gridX = centre ? 128 : slice % 16 * 4 + 2;
      input.params.gridY = centre ? 128 : slice / 16 * 4 + 2;
      return input;
    }();
    const TwinResult twin = sampleOnCpu(in);
    GpuResult gpu = sample(scene, {.method = GPGP_SAMPLING_TRUTH, .samples = 64, .slice = slice});
    gpu.ids.resize(twin.ids.size());
    gpu.depth.resize(twin.depth.size());
    expectEqual(gpu, twin, "slice " + std::to_string(slice));
    std::vector<uint32_t> sizes(scene.params.triangleCount, 0);
    for (const uint32_t id : twin.ids)
      if (id != shader::kNoTriangle) ++sizes[id];
    EXPECT_EQ(gpu.sizes, sizes);
  }
}

// What finds no room counts as visible and is reported; the truth is still covered.
TEST_F(VisibilityGpuTest, ExactWithoutRoomShowsTooMuchAndSaysSo) {
  auto scenes = smallScenes();
  Scene& scene = scenes[3].second;
  const TwinResult twin = sampleExactOnCpu(scene.input());
  const GpgpAsset set = createGeometrySet(scene);
  for (const bool candidates : {true, false}) {
    const GpgpWorker sampler = createSampler(scene.params.width, scene.params.height, 0, true, GPGP_SAMPLING_EXACT_BIT,
                                             0, candidates ? 500 : 0, candidates ? 0 : 3000);
    const GpuResult gpu = sample(scene, sampler, set, {.method = GPGP_SAMPLING_EXACT});
    EXPECT_EQ(gpu.report.base.status, GPGP_BUDGET_EXCEEDED);
    EXPECT_GT(gpu.report.unresolved, 0u);
    EXPECT_GT(candidates ? gpu.report.neededCandidates : gpu.report.neededPairs, candidates ? 500u : 3000u);
    EXPECT_EQ(candidates ? gpu.report.maxCandidates : gpu.report.maxPairs, candidates ? 500u : 3000u);
    EXPECT_EQ(compare(gpu.bits, twin.bits).found, compare(twin.bits, twin.bits).found);
    EXPECT_GT(gpu.report.visible, twin.counters.visible);
  }
}

} // namespace
} // namespace gpgp::test
