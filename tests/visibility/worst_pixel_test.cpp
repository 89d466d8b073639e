// The worst that a pixel can hold: every method ends, on every device, and says what it did not decide.
#include "gpu.h"
#include "ray_scene_of.h"

#include <random>

namespace gpgp::test {
namespace {
using namespace visibility;

/// So many leaves, each up to a twentieth of a pixel to each side, all in the middle pixel of 5 x 5. The first one lies
/// before the others and covers the pixel's centre.
Scene leavesInOnePixel(uint32_t leaves) {
  Scene scene;
  std::mt19937 engine(7);
  const auto between = [&](float a, float b) { return a + (b - a) * static_cast<float>(engine() >> 8) * 0x1p-24f; };
  constexpr float kPixel = 0.4f; // at distance 2
  const auto add = [&](const std::array<glm::vec3, 3>& corners) {
    for (const glm::vec3& p : corners) scene.indices.push_back(scene.addVertex(p.x, p.y, p.z));
  };
  const float s = kPixel / 20;
  add({glm::vec3(-s, -s, -1.9f), glm::vec3(s, -s, -1.9f), glm::vec3(0, s, -1.9f)});
  for (uint32_t i = 1; i < leaves; ++i) {
    const glm::vec3 middle(between(-0.4f, 0.4f) * kPixel, between(-0.4f, 0.4f) * kPixel, between(-2.1f, -2.0f));
    std::array<glm::vec3, 3> corners{};
    for (glm::vec3& corner : corners) corner = middle + glm::vec3(between(-s, s), between(-s, s), between(-s, s) / 8);
    add(corners);
  }
  scene.addDraw(scene.addMesh(0), glm::mat4(1.0f), shader::kTwoSided);
  scene.setCamera(perspective(2 * std::atan(0.5f), 1.0f, 0.5f, 100.0f), 5, 5);
  return scene;
}

TEST_F(VisibilityGpuTest, AHundredThousandTrianglesInOnePixelEndInAReport) {
  Scene scene = leavesInOnePixel(100000);
  const RaySceneOf rays(scene);
  const std::vector<uint32_t> areas = rayReference(rays, scene, 64).areas();
  const auto isVisible = [](const GpuResult& result, uint32_t triangle) {
    return (result.bits[triangle / 32] >> (triangle % 32) & 1) != 0;
  };
  ASSERT_GT(areas[0], 0u);
  for (const GpgpSamplingMethod method : {GPGP_SAMPLING_STANDARD, GPGP_SAMPLING_CONSERVATIVE, GPGP_SAMPLING_EXACT}) {
    const GpuResult result = sample(scene, {.method = method});
    uint32_t seen = 0, missed = 0;
    for (uint32_t i = 0; i < areas.size(); ++i) {
      seen += areas[i] > 0;
      missed += areas[i] > 0 && !isVisible(result, i);
    }
    std::printf("method %d: %u visible, %u unresolved, %u of %u missed, status %d\n", method, result.report.visible,
                result.report.unresolved, missed, seen, result.report.base.status);
    EXPECT_TRUE(isVisible(result, 0)) << method;
    if (method == GPGP_SAMPLING_STANDARD) {
      EXPECT_EQ(result.report.visible, 1u); // at the centre
    } else {
      EXPECT_LE(missed, seen * 0.015 + 2) << method;
    }
    // Nobody else is in doubt, and what is not decided is said.
    EXPECT_EQ(result.report.base.status, result.report.unresolved ? GPGP_BUDGET_EXCEEDED : GPGP_SUCCESS) << method;
    if (method == GPGP_SAMPLING_EXACT) {
      EXPECT_LE(result.report.visible, seen * 1.025 + 5 + result.report.unresolved);
    }
  }
}

} // namespace
} // namespace gpgp::test
