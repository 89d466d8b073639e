// Exact and reference sampling: the GPU against the CPU reference bit for bit. What they find by rays is in
// dense_pixels_test.cpp.
#include "gpu.h"
#include "measured_scenes.h"
#include "visibility/sampling/recorder.h"

#include <algorithm>
#include <glm/ext/matrix_transform.hpp>

namespace gpgp::test {
namespace {
using namespace visibility;

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

/// Rows of tiles whose joints are staggered, a closed wall of `rows` rows of the first triangles, and a sheet of small
/// triangles behind it. No vertex of one row is one of the next, so that edges meet in T-junctions alone.
Scene staggeredWall(int rows, uint32_t width, uint32_t height, float turn) {
  Scene scene;
  const auto quad = [&](float x0, float x1, float y0, float y1, float z) {
    const uint32_t a = scene.addVertex(x0, y0, z), b = scene.addVertex(x1, y0, z), c = scene.addVertex(x1, y1, z),
                   d = scene.addVertex(x0, y1, z);
    scene.indices.insert(scene.indices.end(), {a, b, c, a, c, d});
  };
  for (int row = 0; row < rows; ++row)
    for (int i = 0, tiles = row == 0 ? 1 : 2 + row * 7 % 5; i < tiles; ++i) {
      const auto n = static_cast<float>(tiles), x = static_cast<float>(i), y = static_cast<float>(row);
      const auto m = static_cast<float>(rows);
      quad(-2 + 4 * x / n, -2 + 4 * (x + 1) / n, -2 + 4 * y / m, -2 + 4 * (y + 1) / m, 0);
    }
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x) {
      const float left = -1.9f + 3.8f * static_cast<float>(x) / 60, low = -1.9f + 3.8f * static_cast<float>(y) / 60;
      quad(left, left + 3.8f / 60, low, low + 3.8f / 60, -1);
    }
  scene.addDraw(scene.addMesh(0));
  const glm::mat4 turned = glm::rotate(glm::mat4(1.0f), turn, glm::vec3(0, 0, 1));
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  scene.setCamera(perspective(1.0f, aspect, 0.1f, 100.0f) * turned * lookAt({0.7f, 0.4f, 3.8f}, {0.1f, 0, 0}), width,
                  height);
  return scene;
}

/// How many triangles from a number on are seen.
uint32_t seenFrom(const CpuResult& result, uint32_t first) {
  return static_cast<uint32_t>(
      std::count_if(result.list.begin(), result.list.end(), [&](uint32_t id) { return id >= first; }));
}

// Snapping opens cracks where a vertex of one tile lies on another one's edge. Nothing is seen through them, neither by
// exact sampling nor by the reference.
TEST(ExactCpuReference, NothingIsSeenThroughAWall) {
  for (const int rows : {2, 8, 16})
    for (int turn = 0; turn < 6; ++turn) {
      Scene scene = staggeredWall(rows, 160, 90, 0.13f * static_cast<float>(turn));
      const uint32_t wall = scene.params.triangleCount - 7200;
      const CpuResult exact = sampleExactOnCpu(scene.input());
      EXPECT_EQ(seenFrom(exact, wall), 0u) << rows << ", " << turn;
      EXPECT_GT(exact.counters.visible, wall * 0.9) << rows << ", " << turn;
      if (turn != 1) continue;
      std::vector<uint32_t> sizes;
      EXPECT_EQ(referenceOnCpu(scene.input(), 16, sizes).list, exact.list) << rows;
    }
}

// The same triangles again, their corners in another order: they lie in exactly the same place, clipped ones too, and
// the lower number is nearer.
TEST(ExactCpuReference, TrianglesInTheSamePlaceAreTheFirstOnesWhateverTheirCornersOrder) {
  uint32_t seen = 0;
  for (uint32_t seed = 0; seed < 8; ++seed) {
    Scene scene = randomSoup(seed, 200, 96, 54, true, seed % 2);
    const uint32_t n = scene.params.triangleCount;
    for (uint32_t i = 0; i < n * 3; i += 3) {
      const uint32_t a = scene.indices[i], b = scene.indices[i + 1], c = scene.indices[i + 2];
      switch ((i / 3 + seed) % 5) {
      case 0: scene.indices.insert(scene.indices.end(), {b, c, a}); break;
      case 1: scene.indices.insert(scene.indices.end(), {c, a, b}); break;
      case 2: scene.indices.insert(scene.indices.end(), {b, a, c}); break;
      case 3: scene.indices.insert(scene.indices.end(), {a, c, b}); break;
      default: scene.indices.insert(scene.indices.end(), {c, b, a});
      }
    }
    scene.addDraw(scene.addMesh(n * 3), glm::mat4(1.0f), shader::kTwoSided);
    EXPECT_EQ(seenFrom(sampleOnCpu(scene.input()), n), 0u) << seed;
    const CpuResult exact = sampleExactOnCpu(scene.input());
    EXPECT_EQ(seenFrom(exact, n), 0u) << seed;
    seen += exact.counters.visible;
  }
  EXPECT_GT(seen, 100u); // near ones hide most
}

/// Hundreds of leaves in each pixel.
Scene denseHedge() {
  Scene scene = foliage(20000);
  setWalkingCamera(scene, {1, 1.7f, 7}, {0, 1.5f, 0}, 12, 7, true);
  return scene;
}

TEST_F(VisibilityGpuTest, ExactOfHundredsOfTrianglesInAPixelEqualsTheCpuReference) {
  Scene hedge = denseHedge(), wall = staggeredWall(16, 96, 54, 0.2f);
  for (Scene* scene : {&hedge, &wall}) {
    const GpuResult gpu = sample(*scene, {.method = GPGP_SAMPLING_EXACT});
    expectEqual(gpu, sampleExactOnCpu(scene->input()), scene == &hedge ? "hedge" : "wall");
    EXPECT_EQ(gpu.report.unresolved > 0, scene == &hedge);
  }
}

TEST_F(VisibilityGpuTest, ExactEqualsTheCpuReference) {
  for (auto& [name, scene] : smallScenes()) {
    const CpuResult cpu = sampleExactOnCpu(scene.input());
    expectEqual(sample(scene, {.method = GPGP_SAMPLING_EXACT}), cpu, name);
    EXPECT_GT(cpu.counters.pairs, 1000u) << name;
  }
}

TEST_F(VisibilityGpuTest, ExactOfTrianglesThroughAllPlanesEqualsTheCpuReference) {
  for (uint32_t seed = 0; seed < 6; ++seed) {
    Scene scene = randomSoup(seed, 20 + 60 * seed, 150 + 7 * seed, 90, seed % 2, seed % 3 == 0);
    const CpuResult cpu = sampleExactOnCpu(scene.input());
    expectEqual(sample(scene, {.method = GPGP_SAMPLING_EXACT}), cpu, "seed " + std::to_string(seed));
    EXPECT_GE(cpu.counters.visible, sampleOnCpu(scene.input()).counters.visible);
  }
}

// Scenes in so few pixels that most have lists of several batches, and some more than are decided.
TEST_F(VisibilityGpuTest, ExactOfManyTrianglesInAPixelEqualsTheCpuReference) {
  std::vector<Scene> scenes = {foliage(4000), colonnadeWithWires(0.4f), houseFronts()};
  setWalkingCamera(scenes[0], {1, 1.7f, 7}, {0, 1.5f, 0}, 12, 7, true);
  setWalkingCamera(scenes[1], {0.3f, 1.7f, 3}, {0, 1.5f, -10}, 16, 9, false);
  setWalkingCamera(scenes[2], {12, 26, 60}, {0, 8, -20}, 12, 7, true);
  for (size_t i = 0; i < scenes.size(); ++i) {
    Scene& scene = scenes[i];
    const CpuResult cpu = sampleExactOnCpu(scene.input());
    EXPECT_GT(cpu.counters.pairs, shader::kBatch * scene.params.width * scene.params.height);
    const GpuResult gpu = sample(scene, {.method = GPGP_SAMPLING_EXACT});
    expectEqual(gpu, cpu, std::to_string(i));
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
    const CpuResult cpu = sampleExactOnCpu(scene.input());
    EXPECT_EQ(cpu.counters.visible, scene.params.triangleCount);
    const GpuResult gpu = sample(scene, {.method = GPGP_SAMPLING_EXACT});
    expectEqual(gpu, cpu, std::to_string(bands));
    EXPECT_EQ(gpu.report.unresolved > 0, bands == 63);
  }
}

// A sheet that faces the camera: some seventy, four hundred and more than a thousand triangles in each pixel, all of
// exactly one depth, and a smaller one behind it, of which nothing can be seen.
TEST_F(VisibilityGpuTest, ExactOfManyTrianglesOfOneDepthEqualsTheCpuReference) {
  for (const auto& [cells, size] : {std::pair(48u, 8u), {128u, 8u}, {128u, 4u}}) {
    Scene scene = sheet(5, cells, 0.3f);
    scene.addDraw(0);
    const uint32_t hidden = scene.params.triangleCount;
    scene.addDraw(0, glm::translate(glm::mat4(1.0f), {0, 0, -0.1f}) * glm::scale(glm::mat4(1.0f), glm::vec3(0.5f)));
    scene.setCamera(perspective(1.0f, 1.0f, 0.05f, 10.0f) * lookAt({0, 0, 1.8f}, {0, 0, 0}), size, size);
    const CpuResult cpu = sampleExactOnCpu(scene.input());
    EXPECT_GT(cpu.counters.pairs, cells * cells * 3 / 2);
    const auto isSeen = [&](uint32_t id) { return (cpu.bits[id / 32] >> (id % 32) & 1) != 0; };
    uint32_t behind = 0;
    for (uint32_t id = hidden; id < scene.params.triangleCount; ++id) behind += isSeen(id);
    EXPECT_EQ(behind > 0, size == 4) << cells; // that takes too long
    EXPECT_GT(cpu.counters.visible, sampleOnCpu(scene.input()).counters.visible * 8);
    const GpuResult gpu = sample(scene, {.method = GPGP_SAMPLING_EXACT});
    expectEqual(gpu, cpu, "sheet of " + std::to_string(cells) + " in " + std::to_string(size));
    EXPECT_EQ(gpu.report.unresolved > 0, size == 4);
  }
}

TEST_F(VisibilityGpuTest, ReferenceEqualsTheCpuReferenceSliceBySlice) {
  Scene scene = colonnadeWithWires(0.3f);
  setWalkingCamera(scene, {0.3f, 1.7f, 3}, {0, 1.5f, -10}, 48, 27, true);
  for (const uint32_t slice : {0u, 5u, 255u, 256u}) {
    const CpuInput in = [&] {
      CpuInput input = scene.input();
      const bool centre = slice == 256;
      input.params.method = shader::kReference;
      input.params.gridShift = centre ? 8 : 6;
      input.params.gridX = centre ? 128 : slice % 16 * 4 + 2;
      input.params.gridY = centre ? 128 : slice / 16 * 4 + 2;
      return input;
    }();
    const CpuResult cpu = sampleOnCpu(in);
    GpuResult gpu = sample(scene, {.method = GPGP_SAMPLING_REFERENCE, .samples = 64, .slice = slice});
    gpu.ids.resize(cpu.ids.size());
    gpu.depth.resize(cpu.depth.size());
    expectEqual(gpu, cpu, "slice " + std::to_string(slice));
    std::vector<uint32_t> sizes(scene.params.triangleCount, 0);
    for (const uint32_t id : cpu.ids)
      if (id != shader::kNoTriangle) ++sizes[id];
    EXPECT_EQ(gpu.sizes, sizes);
  }
}

// What finds no room counts as visible and is reported; the reference is still covered.
TEST_F(VisibilityGpuTest, ExactWithoutRoomShowsTooMuchAndSaysSo) {
  auto scenes = smallScenes();
  Scene& scene = scenes[3].second;
  const CpuResult cpu = sampleExactOnCpu(scene.input());
  const GpgpAsset set = createGeometrySet(scene);
  for (const bool candidates : {true, false}) {
    const GpgpRecorder recorder =
        createRecorder(scene.params.width, scene.params.height, 0, true, GPGP_SAMPLING_EXACT_BIT, 0,
                       candidates ? 500 : 0, candidates ? 0 : 3000);
    const GpuResult gpu = sample(scene, recorder, set, {.method = GPGP_SAMPLING_EXACT});
    EXPECT_EQ(gpu.report.base.status, GPGP_BUDGET_EXCEEDED);
    EXPECT_GT(gpu.report.unresolved, 0u);
    EXPECT_GT(candidates ? gpu.report.neededCandidates : gpu.report.neededPairs, candidates ? 500u : 3000u);
    EXPECT_EQ(candidates ? gpu.report.maxCandidates : gpu.report.maxPairs, candidates ? 500u : 3000u);
    for (size_t word = 0; word < cpu.bits.size(); ++word) EXPECT_EQ(cpu.bits[word] & ~gpu.bits[word], 0u) << word;
    EXPECT_GT(gpu.report.visible, cpu.counters.visible);
  }
}

} // namespace
} // namespace gpgp::test
