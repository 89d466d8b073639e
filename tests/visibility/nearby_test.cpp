// Method nearby, and records that sample what another one listed: how a view cell is sampled from many points.
#include "gpu.h"
#include "measured_scenes.h"
#include "visibility/nearby/nearby.h"
#include "visibility/view_cell.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

namespace gpgp::test {
namespace {
using namespace visibility;

/// The scene's cameras as view points `by` metres from the middle one, with what method nearby needs.
void setCell(Scene& scene, const std::vector<glm::vec2>& points, float reach) {
  GpgpCamera middle{};
  std::copy_n(scene.params.viewProjection, 16, middle.viewProjection);
  middle.reversedDepth = scene.params.reversedDepth;
  scene.params.cameraCount = static_cast<uint32_t>(points.size());
  for (uint32_t i = 0; i < points.size(); ++i) {
    const float place[] = {points[i].x, points[i].y, 0};
    GpgpViewCellInfo info = GPGP_VIEW_CELL_INFO_INIT;
    info.camera = middle;
    info.points = place;
    info.pointCount = 1;
    GpgpCamera cameras[2];
    ASSERT_TRUE(viewCellCameras(info, 2, cameras));
    std::copy_n(cameras[1].viewProjection, 16, scene.params.viewProjection + size_t(i) * 16);
    const glm::vec4 scale = depthScale(cameras[1], scene.params.width, scene.params.height, reach);
    ASSERT_NE(scale.y, 0.0f);
    for (int k = 0; k < 4; ++k) scene.params.depthScales[i * 4 + static_cast<uint32_t>(k)] = scale[k];
  }
}

const std::vector<glm::vec2> kCorners{{-0.5f, -0.5f}, {0.5f, -0.5f}, {-0.5f, 0.5f}, {0.5f, 0.5f}};

Scene street(uint32_t width, uint32_t height, bool reversed) {
  Scene scene = city(4);
  setWalkingCamera(scene, {18, 1.7f, -3}, {18, 4, 40}, width, height, reversed);
  return scene;
}

/// The triangles that a record listed by draw, as a scene to sample.
Scene listed(const Scene& scene, const CpuResult& lists) {
  Scene result = scene;
  result.commands = lists.drawCommands;
  result.indices = lists.drawIndices;
  result.numbers = lists.drawTriangles;
  for (shader::Draw& draw : result.draws) draw.firstTriangle = 0xbadu; // is not read
  return result;
}

size_t countOf(const std::vector<uint32_t>& bits) {
  size_t count = 0;
  for (const uint32_t word : bits) count += static_cast<size_t>(std::popcount(word));
  return count;
}

TEST(NearbyCpuReference, InverseDistancesAreThoseAlongTheView) {
  for (const bool reversed : {false, true}) {
    Scene scene;
    scene.setCamera(perspective(1.0f, 2.0f, 0.5f, 80.0f, reversed) * lookAt({3, 1, 2}, {0, 0, 0}), 200, 100, reversed);
    GpgpCamera camera{};
    std::copy_n(scene.params.viewProjection, 16, camera.viewProjection);
    const glm::vec4 scale = depthScale(camera, 200, 100, 2);
    glm::mat4 m;
    std::copy_n(camera.viewProjection, 16, &m[0][0]);
    for (const glm::vec3 p : {glm::vec3(0), glm::vec3(1, 0, 1), glm::vec3(-20, 3, -5)}) {
      const glm::vec4 clip = m * glm::vec4(p, 1);
      EXPECT_NEAR(shader::inverseDistance(scale, clip.z / clip.w) * clip.w, 1, 1e-3);
    }
    // 2 m across at distance 1: half the height is tan(0.5).
    EXPECT_NEAR(scale.z, 2 / std::tan(0.5f) * 50, 1e-2);
  }
  GpgpCamera parallel{};
  parallel.viewProjection[0] = parallel.viewProjection[5] = parallel.viewProjection[10] = parallel.viewProjection[15] =
      1;
  EXPECT_EQ(depthScale(parallel, 8, 8, 1), glm::vec4(0));
}

TEST(NearbyCpuReference, HoldsWhatIsSeenFromTheCellAndLittleElse) {
  Scene scene = street(96, 54, true);
  const Scene middle = scene;
  setCell(scene, kCorners, 1);
  const CpuResult nearby = sampleNearbyOnCpu(scene.input());
  std::vector<uint32_t> seen(nearby.bits.size()), found(seen);
  const auto unite = [](std::vector<uint32_t>& all, const std::vector<uint32_t>& bits) {
    for (size_t i = 0; i < all.size(); ++i) all[i] |= bits[i];
  };
  for (int y = -1; y <= 1; ++y)
    for (int x = -2; x <= 2; ++x) {
      Scene one = middle;
      setCell(one, {{static_cast<float>(x) * 0.25f, static_cast<float>(y) * 0.5f}}, 1);
      unite(seen, sampleExactOnCpu(one.input()).bits);
      unite(found, sampleExactOnCpu(listed(one, nearby).input()).bits);
    }
  size_t missed = 0, extra = 0;
  for (size_t i = 0; i < seen.size(); ++i) {
    missed += static_cast<size_t>(std::popcount(seen[i] & ~nearby.bits[i]));
    extra += static_cast<size_t>(std::popcount(found[i] & ~seen[i]));
  }
  const size_t all = countOf(seen);
  ASSERT_GT(all, 500u);
  EXPECT_LT(missed * 100, all);
  EXPECT_LT(extra * 100, all);
  EXPECT_GT(countOf(found) * 100, all * 99);
  EXPECT_LT(countOf(nearby.bits) * 2, scene.params.triangleCount); // a sixth of them faces the viewer on the screen
}

struct NearbyTest : VisibilityGpuTest {
  GpgpRecorder recorder = nullptr;
  GpuResult run(Scene& scene, const GpuOptions& options) {
    if (!recorder)
      recorder =
          createRecorder(256, 256, 0, true,
                         GPGP_SAMPLING_STANDARD_BIT | GPGP_SAMPLING_EXACT_BIT | GPGP_SAMPLING_NEARBY_BIT, 0, 0, 0, 12);
    scene.input(); // fills in what depends on the scene
    const GpgpAsset set = createGeometrySet(scene);
    GpuResult result = sample(scene, recorder, set, options);
    gpgpDestroyAsset(set);
    return result;
  }
};

TEST_F(NearbyTest, EqualsTheCpuReference) {
  for (const bool reversed : {false, true})
    for (const float reach : {0.0f, 1.0f}) {
      Scene scene = street(130, 71, reversed);
      setCell(scene, kCorners, reach);
      const CpuResult cpu = sampleNearbyOnCpu(scene.input());
      EXPECT_GT(cpu.counters.visible, 1000u);
      expectEqual(run(scene, {.method = GPGP_SAMPLING_NEARBY, .reach = reach}), cpu, "nearby");
    }
  Scene scene = colonnade(128, 72); // ground and columns through the near plane
  setCell(scene, {{0, 0}}, 0.3f);
  expectEqual(run(scene, {.method = GPGP_SAMPLING_NEARBY, .reach = 0.3f}), sampleNearbyOnCpu(scene.input()), "clipped");
}

TEST_F(NearbyTest, ExactWithAReachEqualsTheCpuReferenceAndShowsWhatAMoveUncovers) {
  for (const bool reversed : {false, true}) {
    Scene scene = street(96, 54, reversed);
    const std::vector<uint32_t> one = sampleExactOnCpu(scene.input()).bits;
    setCell(scene, {{0, 0}}, 0.02f);
    const CpuResult cpu = sampleExactOnCpu(scene.input());
    expectEqual(run(scene, {.method = GPGP_SAMPLING_EXACT, .reach = 0.02f}), cpu, "exact with a reach");
    std::vector<uint32_t> moved(one.size());
    for (const auto& by : std::vector<glm::vec2>{{-0.02f, 0}, {0.02f, 0}, {0, -0.02f}, {0, 0.02f}}) {
      Scene other = scene;
      setCell(other, {by}, 0);
      const std::vector<uint32_t> bits = sampleExactOnCpu(other.input()).bits;
      for (size_t i = 0; i < bits.size(); ++i) moved[i] |= bits[i] & ~one[i];
    }
    std::vector<uint32_t> found = moved;
    for (size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(one[i] & ~cpu.bits[i], 0u); // nothing is lost
      found[i] &= cpu.bits[i];
    }
    EXPECT_GT(countOf(moved), 20u);
    EXPECT_GT(countOf(found) * 5, countOf(moved)); // a part of what shows by moving
    EXPECT_LT(countOf(cpu.bits), countOf(one) * 5 / 4);
  }
}

TEST_F(NearbyTest, WhatItListsIsSampledUnderItsOwnNumbers) {
  Scene scene = street(64, 36, true);
  std::vector<glm::vec2> points = kCorners;
  for (int i = 0; i < 8; ++i) points.emplace_back(static_cast<float>(i) / 8 - 0.45f, 0.1f); // more than eight cameras
  setCell(scene, points, 1);
  const CpuResult all = sampleOnCpu(scene.input());
  Scene cell = listed(scene, sampleNearbyOnCpu(scene.input()));
  ASSERT_LT(cell.numbers.size() * 2, scene.params.triangleCount);
  std::fill(std::begin(cell.params.depthScales), std::end(cell.params.depthScales), 0.0f);
  const CpuResult standard = sampleOnCpu(cell.input()), exact = sampleExactOnCpu(cell.input());
  EXPECT_EQ(standard.bits, all.bits); // whatever a centre shows is nearby
  expectEqual(run(cell, {}), standard, "standard");
  expectEqual(run(cell, {.method = GPGP_SAMPLING_EXACT}), exact, "exact");

  for (size_t i = 0; i < cell.numbers.size(); i += 3)
    cell.numbers[i] = scene.params.triangleCount + static_cast<uint32_t>(i);
  cell.numbers.resize(cell.numbers.size() - 7);
  const CpuResult skipped = sampleOnCpu(cell.input());
  EXPECT_GT(skipped.counters.skippedTriangles, all.counters.skippedTriangles);
  expectEqual(run(cell, {}), skipped, "numbers out of range");
}

TEST_F(NearbyTest, ArgumentsAreChecked) {
  Scene scene = randomSoup(1, 10, 16, 16, true, false);
  scene.input();
  recorder = createRecorder(64, 64, 0, false, GPGP_SAMPLING_NEARBY_BIT | GPGP_SAMPLING_EXACT_BIT);
  const GpgpAsset set = createGeometrySet(scene);
  const SceneBuffers buffers(device, scene);
  const host::Buffer any(device, 256, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  upload();
  const GpgpFrame f = advance();
  constexpr GpgpSamplingMethod nearby = GPGP_SAMPLING_NEARBY, exact = GPGP_SAMPLING_EXACT;
  for (const auto& [method, text, reach, parallel] : {std::tuple(nearby, "", 0.5f, false),
                                                      {nearby, "reach is -1", -1.0f, false},
                                                      {nearby, "reach is", NAN, false},
                                                      {nearby, "camera 0 has no perspective", 1.0f, true},
                                                      {exact, "reach is -1", -1.0f, false},
                                                      {exact, "camera 0 has no perspective", 1.0f, true},
                                                      {exact, "", 0.0f, true}}) {
    GpgpVisibilityInfo info = sampleInfo(scene, buffers, set);
    info.visibleBits = any.range();
    info.method = method;
    info.reach = reach;
    if (parallel) std::copy_n(&glm::mat4(1.0f)[0][0], 16, info.camera.viewProjection);
    const GpgpResult expected = *text ? GPGP_ERROR_INVALID_ARGUMENT : GPGP_SUCCESS;
    messages.clear();
    device.submitAndWait(queue(), [&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordPrepareVisibility(recorder, cmd, &f, &info), expected);
    });
    if (!*text) continue;
    ASSERT_EQ(messages.size(), 1u) << text;
    EXPECT_NE(messages[0].find(text), std::string::npos) << messages[0];
  }
}

} // namespace
} // namespace gpgp::test
