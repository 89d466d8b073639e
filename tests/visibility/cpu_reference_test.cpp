// The CPU reference against the double-precision oracle and against properties that must hold.
#include "oracle.h"
#include "scenes.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <set>

namespace gpgp::test {
namespace {
using namespace visibility;

void expectRight(Scene& scene, uint64_t leastCovered, const std::string& what) {
  const CpuInput input = scene.input();
  const CpuResult result = sampleOnCpu(input);
  const Verdict verdict = judge(input, result.ids);
  EXPECT_EQ(verdict.wrong, 0u) << what << ": " << verdict.firstWrong;
  EXPECT_GE(verdict.covered, leastCovered) << what;
}

TEST(CpuReference, RandomTrianglesThroughAllPlanesMatchRays) {
  for (uint32_t seed = 0; seed < 24; ++seed) {
    Scene scene = randomSoup(seed, 12 + seed * 12, 80 + seed, 64, seed % 2, seed % 3 == 0);
    expectRight(scene, seed > 2 ? 100 : 1, "seed " + std::to_string(seed));
  }
}

TEST(CpuReference, ColonnadeOnAGroundThroughTheNearPlaneMatchesRays) {
  Scene scene = colonnade(160, 90);
  expectRight(scene, 7000, "colonnade");
}

TEST(CpuReference, BunnyMatchesRays) {
  Scene scene = bunny(160, 120);
  expectRight(scene, 2000, "bunny");
}

TEST(CpuReference, BitsAreExactlyTheTrianglesThatOwnAPixel) {
  Scene scene = bunny(200, 200);
  const CpuResult result = sampleOnCpu(scene.input());
  std::set<uint32_t> owners(result.ids.begin(), result.ids.end());
  owners.erase(shader::kNoTriangle);
  EXPECT_EQ(std::vector<uint32_t>(owners.begin(), owners.end()), result.list);
  EXPECT_EQ(result.counters.visible, owners.size());
  for (uint32_t id = 0; id < scene.params.triangleCount; ++id)
    ASSERT_EQ((result.bits[id / 32] >> (id % 32)) & 1, owners.count(id)) << id;
  EXPECT_GT(result.counters.triangles, result.counters.visible);
  EXPECT_EQ(result.counters.items, 69666u);
}

// The sheet fills the screen and all its triangles lie in one plane: each pixel centre is owned by exactly one.
TEST(CpuReference, ATessellatedSheetCoversEachPixelOnce) {
  for (uint32_t seed = 0; seed < 6; ++seed) {
    Scene scene = sheet(seed, 40, 0.3f);
    scene.addDraw(0);
    // seeds 4 and 5: from close by and at an angle, so that triangles cross the near plane and the guard band
    const glm::mat4 view = seed < 4 ? lookAt({0.01f * float(seed), 0.013f, 0.5f}, {0.02f, 0, 0})
                                    : lookAt({0, -0.5f, 0.02f}, {0, 1, -0.2f});
    scene.setCamera(perspective(1.0f, 1.0f, 0.05f, 10.0f) * view, 128, 128);
    const CpuInput input = scene.input();
    std::vector<int> hits(128 * 128, 0);
    for (uint32_t local = 0; local < 3200; ++local) {
      std::set<std::pair<int, int>> own;
      for (const auto& t : placeTriangle(input, input.draws[0], local).pieces)
        for (int y = t.bounds.y; y < t.bounds.w; ++y)
          for (int x = t.bounds.x; x < t.bounds.z; ++x)
            if (coversWide(t, 0, shader::samplePoint(glm::ivec2(x, y), gridOf(input.params)))) own.insert({x, y});
      for (const auto& [x, y] : own) ++hits[size_t(y) * 128 + size_t(x)];
    }
    const CpuResult result = sampleOnCpu(input);
    const Verdict verdict = judge(input, result.ids);
    EXPECT_EQ(verdict.wrong, 0u) << seed << ": " << verdict.firstWrong;
    EXPECT_LE(*std::max_element(hits.begin(), hits.end()), 1) << seed;
    if (seed < 4) {
      EXPECT_EQ(*std::min_element(hits.begin(), hits.end()), 1) << seed;
    } else {
      EXPECT_GT(std::count(hits.begin(), hits.end(), 1), 4000) << seed;
    }
  }
}

/// A square that faces +z at depth z, two triangles.
uint32_t addSquare(Scene& scene, float z, float half = 10.0f) {
  const auto first = static_cast<uint32_t>(scene.indices.size());
  const uint32_t a = scene.addVertex(-half, -half, z), b = scene.addVertex(half, -half, z);
  const uint32_t c = scene.addVertex(half, half, z), d = scene.addVertex(-half, half, z);
  scene.indices.insert(scene.indices.end(), {a, b, c, a, c, d});
  return scene.addMesh(first);
}

void setFront(Scene& scene, bool reversed, uint32_t size = 32) {
  scene.setCamera(perspective(1.0f, 1.0f, 0.1f, 100.0f, reversed) * lookAt({0, 0, 5}, {0, 0, 0}), size, size, reversed);
}

TEST(CpuReference, NearerHidesFartherInBothDepthConventions) {
  for (const bool reversed : {false, true}) {
    Scene scene;
    for (const float z : {-3.0f, 1.0f, 0.9999f, -9.0f}) scene.addDraw(addSquare(scene, z));
    setFront(scene, reversed);
    const CpuResult result = sampleOnCpu(scene.input());
    EXPECT_EQ(result.list, (std::vector<uint32_t>{2, 3}));
    EXPECT_EQ(result.counters.coveredPixels, 32u * 32u);
    EXPECT_EQ(result.counters.triangles, 8u);
  }
}

TEST(CpuReference, EqualDepthGoesToTheLowestNumber) {
  Scene scene;
  const uint32_t square = addSquare(scene, 0);
  scene.addDraw(square, glm::mat4(1.0f), 0, 6);
  scene.addDraw(square, glm::mat4(1.0f), 0, 2);
  scene.addDraw(square, glm::mat4(1.0f), 0, 4);
  setFront(scene, false);
  EXPECT_EQ(sampleOnCpu(scene.input()).list, (std::vector<uint32_t>{2, 3}));
}

TEST(CpuReference, BackFacesCountOnlyWhereTwoSided) {
  Scene scene;
  const uint32_t square = addSquare(scene, 0);
  const glm::mat4 turned = glm::rotate(glm::mat4(1.0f), 3.14159265f, glm::vec3(0, 1, 0));
  scene.addDraw(square, turned);
  setFront(scene, false);
  CpuResult result = sampleOnCpu(scene.input());
  EXPECT_EQ(result.counters.visible, 0u);
  EXPECT_EQ(result.counters.triangles, 0u);
  scene.draws[0].flags = shader::kTwoSided;
  result = sampleOnCpu(scene.input());
  EXPECT_EQ(result.counters.visible, 2u);
  // A mirror image keeps its front faces: the mesh's counter-clockwise side stays the outer one.
  scene.draws.clear();
  scene.addDraw(square, glm::scale(glm::mat4(1.0f), {-1, 1, 1}), 0, 0);
  result = sampleOnCpu(scene.input());
  EXPECT_EQ(result.counters.visible, 2u);
}

TEST(CpuReference, OneHugeTriangleRoundTheCameraIsNotLost) {
  Scene scene;
  const uint32_t a = scene.addVertex(-1e6f, -1, 1e6f), b = scene.addVertex(1e6f, -1, 1e6f),
                 c = scene.addVertex(0, -1, -1e6f);
  scene.indices = {a, b, c};
  scene.addDraw(scene.addMesh(0));
  scene.setCamera(perspective(1.0f, 1.0f, 0.1f, 1e7f, true) * lookAt({0, 0, 0}, {0, 0, -1}), 64, 64, true);
  const CpuResult result = sampleOnCpu(scene.input());
  // Below the horizon everything, above nothing.
  EXPECT_NEAR(result.counters.coveredPixels, 64 * 32, 64);
  for (size_t x = 0; x < 64; ++x) EXPECT_EQ(result.ids[63 * 64 + x], 0u);
}

TEST(CpuReference, BadTrianglesAreSkippedAndCounted) {
  Scene scene;
  addSquare(scene, 0); // good: 0, 1
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e35f, -3e38f};
  for (const float v : bad) { // one bad coordinate each: 2, 3, 4, 5
    const uint32_t a = scene.addVertex(-1, v, 1), b = scene.addVertex(1, -1, 1), c = scene.addVertex(1, 1, 1);
    scene.indices.insert(scene.indices.end(), {a, b, c});
  }
  const auto vertices = static_cast<uint32_t>(scene.positions.size() / 3);
  scene.indices.insert(scene.indices.end(), {0, 1, vertices, 0, UINT32_MAX, 1}); // out of range: 6, 7
  scene.indices.insert(scene.indices.end(), {0, 0, 1, 0, 1, 1, 2, 2, 2});        // degenerate: no error
  scene.meshes[0] = {0, static_cast<uint32_t>(scene.indices.size()), 0};
  scene.meshes.push_back({static_cast<uint32_t>(scene.indices.size()) - 3, 9, 0}); // two triangles past the end
  scene.addDraw(0);
  scene.addDraw(1);
  scene.addDraw(0).mesh = 2; // there is none
  setFront(scene, false);
  const CpuResult result = sampleOnCpu(scene.input());
  EXPECT_EQ(result.list, (std::vector<uint32_t>{0, 1}));
  EXPECT_EQ(result.counters.skippedTriangles, 4u + 2u + 2u);
  EXPECT_EQ(result.counters.skippedDraws, 1u);
}

TEST(CpuReference, TriangleNumbersPastTheCountAreSkipped) {
  Scene scene;
  scene.addDraw(addSquare(scene, 0), glm::mat4(1.0f), 0, 4);
  setFront(scene, false);
  scene.params.triangleCount = 5;
  const CpuResult result = sampleOnCpu(scene.input());
  EXPECT_EQ(result.list, (std::vector<uint32_t>{4}));
  EXPECT_EQ(result.counters.skippedTriangles, 1u);
}

TEST(CpuReference, TheBudgetCutsTheRestAndItemsSaysAll) {
  Scene scene;
  const uint32_t square = addSquare(scene, 0);
  for (int i = 0; i < 4; ++i) scene.addDraw(square);
  setFront(scene, false);
  scene.params.maxItems = 3;
  const CpuResult result = sampleOnCpu(scene.input());
  EXPECT_EQ(result.counters.triangles, 3u);
  EXPECT_EQ(result.counters.items, 8u);
}

TEST(CpuReference, ShortIndicesAndStridesReadTheSame) {
  Scene scene = colonnade(64, 64);
  const CpuResult expected = sampleOnCpu(scene.input());
  scene.useShort = true;
  EXPECT_EQ(sampleOnCpu(scene.input()).ids, expected.ids);
  std::vector<float> wide;
  for (size_t i = 0; i < scene.positions.size(); i += 3)
    wide.insert(wide.end(), {scene.positions[i], scene.positions[i + 1], scene.positions[i + 2], 7e30f, -1});
  scene.positions = wide;
  scene.params.positionStride = 20;
  EXPECT_EQ(sampleOnCpu(scene.input()).ids, expected.ids);
}

TEST(CpuReference, ViewportsOfOnePixelAndOfTheLargestSizeWork) {
  for (const uint32_t size : {1u, 8192u}) {
    Scene scene;
    scene.addDraw(addSquare(scene, 0, size == 1 ? 10.0f : 0.001f));
    setFront(scene, false, size);
    const CpuInput input = scene.input();
    const CpuResult result = sampleOnCpu(input);
    EXPECT_EQ(result.counters.visible, size == 1 ? 1u : 2u); // one pixel on the diagonal has one owner
    // 0.002 units wide at distance 5, 60 degrees or so: size * 0.002 / (2 * 5 * tan(0.5)) pixels
    if (size > 1) {
      EXPECT_NEAR(std::sqrt(double(result.counters.coveredPixels)), 3.0, 0.1);
    }
  }
}

} // namespace
} // namespace gpgp::test
