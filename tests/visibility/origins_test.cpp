// Far from the world's origin: with origins of draws and cameras a scene is sampled there as it is at the origin.
#include "gpu.h"
#include "measured_scenes.h"

#include <bit>
#include <glm/ext/matrix_transform.hpp>

namespace gpgp::test {
namespace {
using namespace visibility;

/// Two rows of columns, seen by two cameras. Draws are relative to places of their own, and so are the cameras; all of
/// these, moved by `by`, are numbers that two floats hold.
Scene columnsAt(glm::dvec3 by) {
  Scene scene = colonnadeWithWires(0.3f);
  setWalkingCamera(scene, {0.25f, 1.75f, 3}, {0, 1.5f, -10}, 64, 36, true);
  const glm::mat4 view = perspective(1.0f, 16.0f / 9, 0.1f, 2000.0f, true) * lookAt({0, 0, 0}, {0.5f, -0.1f, -1});
  scene.addCamera(view); // at its origin
  const glm::dvec3 places[] = {{0, 0, 0}, {16, -2, 8}, {-0.5, 0.25, -32}};
  for (size_t i = 0; i < scene.draws.size(); ++i) {
    shader::Draw& draw = scene.draws[i];
    draw.origin = static_cast<uint32_t>(i % 3);
    for (int row = 0; row < 3; ++row) draw.transform[row * 4 + 3] -= static_cast<float>(places[i % 3][row]);
  }
  for (const glm::dvec3& place : places) scene.origins.push_back(place + by);
  scene.cameraOrigins = {by, by + glm::dvec3(-0.5, 1.75, 2)};
  return scene;
}

/// The same with floats alone.
Scene columnsByFloats(glm::vec3 by) {
  Scene scene = colonnadeWithWires(0.3f);
  const glm::vec3 eye(0.25f, 1.75f, 3), target(0, 1.5f, -10);
  setWalkingCamera(scene, by + eye, by + target, 64, 36, true);
  for (shader::Draw& draw : scene.draws)
    for (int row = 0; row < 3; ++row) draw.transform[row * 4 + 3] += by[row];
  return scene;
}

constexpr glm::dvec3 kFar[] = {{100000, 0, -100000}, {-1000000, 500, 3000000}, {10000000, -10000000, 10000000}};

uint32_t common(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b) {
  uint32_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += static_cast<uint32_t>(std::popcount(a[i] & b[i]));
  return count;
}

TEST(Origins, FarAwayIsAsAtTheOrigin) {
  Scene near = columnsAt(glm::dvec3(0));
  const CpuResult expected = sampleExactOnCpu(near.input());
  EXPECT_GT(expected.counters.visible, 2000u);
  for (const glm::dvec3& by : kFar) {
    Scene far = columnsAt(by);
    const CpuResult found = sampleExactOnCpu(far.input());
    EXPECT_EQ(found.bits, expected.bits) << by.x;
    EXPECT_EQ(found.depth, expected.depth) << by.x;
  }
  // Or the scene would not tell.
  Scene here = columnsByFloats(glm::vec3(0)), there = columnsByFloats(glm::vec3(kFar[1]));
  const CpuResult right = sampleExactOnCpu(here.input()), floats = sampleExactOnCpu(there.input());
  EXPECT_LT(common(floats.bits, right.bits), right.counters.visible * 0.9);
}

// A whole scene that is relative to one place, seen from there: the very same numbers as without origins.
TEST(Origins, OnePlaceForAllChangesNothing) {
  Scene plain = columnsByFloats(glm::vec3(0)), placed = plain;
  placed.origins = placed.cameraOrigins = {glm::dvec3(1234567.891, -7654321.987, 3e12)};
  const CpuResult expected = sampleExactOnCpu(plain.input()), found = sampleExactOnCpu(placed.input());
  EXPECT_EQ(found.bits, expected.bits);
  EXPECT_EQ(found.depth, expected.depth);
}

TEST_F(VisibilityGpuTest, FarAwayEqualsTheCpuReference) {
  for (const bool clusters : {false, true})
    for (const GpgpSamplingMethod method : {GPGP_SAMPLING_STANDARD, GPGP_SAMPLING_EXACT}) {
      Scene scene = columnsAt(kFar[1]);
      const CpuResult cpu =
          method == GPGP_SAMPLING_EXACT ? sampleExactOnCpu(scene.input()) : sampleOnCpu(scene.input());
      const GpuResult gpu = sample(scene, {.method = method, .clusters = clusters});
      expectEqual(gpu, cpu, "method " + std::to_string(method) + (clusters ? ", clusters" : ""));
    }
}

TEST_F(VisibilityGpuTest, DrawsOfAnUnknownOriginAreSkippedAndCounted) {
  for (const bool clusters : {false, true}) {
    Scene scene = columnsAt(kFar[0]);
    scene.draws[1].origin = 3;
    const uint32_t triangles = scene.meshes[scene.draws[1].mesh].indexCount / 3;
    const CpuResult cpu = sampleOnCpu(scene.input());
    EXPECT_EQ(cpu.counters.skippedTriangles, triangles * 2);
    expectEqual(sample(scene, {.clusters = clusters}), cpu, clusters ? "clusters" : "");
  }
}

} // namespace
} // namespace gpgp::test
