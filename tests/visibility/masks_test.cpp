// Draws that cameras do not sample: disabled ones, and layers.
#include "exact_oracle.h"
#include "gpu.h"

#include <glm/ext/matrix_transform.hpp>

namespace gpgp::test {
namespace {
using namespace visibility;

/// Sheets one behind the other, each smaller than the one behind it; the last one lies in front.
Scene sheets(const std::vector<uint32_t>& flags) {
  Scene scene = sheet(5, 6, 0.3f);
  for (size_t i = 0; i < flags.size(); ++i)
    scene.addDraw(0,
                  glm::scale(glm::translate(glm::mat4(1), {0, 0, 0.3f * static_cast<float>(i)}),
                             glm::vec3(1 - 0.2f * static_cast<float>(i))),
                  flags[i]);
  scene.setCamera(perspective(1, 1.5f, 0.1f, 10) * lookAt({0, 0, 3}, {0, 0, 0}), 96, 64);
  return scene;
}

struct MasksTest : VisibilityGpuTest {
  static CpuResult onCpu(Scene& scene, GpgpSamplingMethod method) {
    CpuInput input = scene.input();
    input.params.method = static_cast<uint32_t>(method);
    return method == GPGP_SAMPLING_EXACT ? sampleExactOnCpu(input) : sampleOnCpu(input);
  }
  void expectAll(Scene& scene, const std::string& what) {
    for (const GpgpSamplingMethod method : {GPGP_SAMPLING_STANDARD, GPGP_SAMPLING_EXACT})
      for (const bool clusters : {false, true}) {
        if (clusters && !scene.commands.empty()) continue;
        GpuOptions options;
        options.method = method, options.clusters = clusters;
        const GpuResult result = sample(scene, options);
        expectEqual(result, onCpu(scene, method), what + ", method " + std::to_string(method));
        if (method == GPGP_SAMPLING_EXACT) {
          EXPECT_EQ(compareWithRays(scene, result.bits, 4, 1), "") << what;
        }
      }
  }
};

TEST_F(MasksTest, DisabledDrawsAreNotThere) {
  Scene all = sheets({0, 0, 0}), some = sheets({0, GPGP_DRAW_DISABLED, 0});
  expectAll(some, "disabled");
  EXPECT_NE(onCpu(all, GPGP_SAMPLING_STANDARD).bits, onCpu(some, GPGP_SAMPLING_STANDARD).bits);
  for (uint32_t id = 72; id < 144; ++id) EXPECT_EQ(sampleOnCpu(some.input()).bits[id / 32] >> (id % 32) & 1, 0u) << id;
}

TEST_F(MasksTest, CamerasSampleTheirLayers) {
  Scene scene = sheets({0, GPGP_DRAW_LAYERS(1), GPGP_DRAW_LAYERS(6)});
  scene.addCamera(perspective(1, 1.5f, 0.1f, 10) * lookAt({1, 0.5f, 3}, {0, 0, 0}));
  const uint32_t masks[][2] = {{0, 0}, {1, 1}, {8, 8}, {1, 2}, {4, 0}, {8, 1}};
  for (const auto& [first, second] : masks) {
    scene.params.cameraLayers[0] = first, scene.params.cameraLayers[1] = second;
    expectAll(scene, "layers " + std::to_string(first) + ", " + std::to_string(second));
  }
  // What one camera alone sees is what it sees beside another of no layers in common.
  scene.params.cameraLayers[0] = 8, scene.params.cameraLayers[1] = 8;
  const CpuResult none = sampleOnCpu(scene.input());
  for (uint32_t id = 72; id < 216; ++id) EXPECT_EQ(none.bits[id / 32] >> (id % 32) & 1, 0u) << id;
}

// Lists by draw hold a draw's triangles if any camera samples it, although another draw has the same numbers.
TEST_F(MasksTest, DrawsOfTheSameNumbersAreListedAlone) {
  Scene scene = sheet(5, 6, 0.3f);
  scene.addDraw(0, glm::mat4(1), 0, 0);
  scene.addDraw(0, glm::translate(glm::mat4(1), {3, 0, 0}), GPGP_DRAW_DISABLED, 0);
  scene.setCamera(perspective(1, 1.5f, 0.1f, 10) * lookAt({0, 0, 3}, {0, 0, 0}), 96, 64);
  const GpuResult result = sample(scene);
  EXPECT_EQ(result.drawCommands[0], result.report.visible * 3);
  EXPECT_EQ(result.drawCommands[5], 0u);
  expectEqual(result, sampleOnCpu(scene.input()), "one number twice");
}

TEST_F(MasksTest, CommandsHaveTheFlagsOfTheirDraws) {
  Scene scene = sheets({0, GPGP_DRAW_DISABLED, GPGP_DRAW_LAYERS(2), 0});
  scene.commands = {static_cast<uint32_t>(scene.indices.size()), 4, 0, 0, 0};
  scene.params.cameraLayers[0] = 1;
  expectAll(scene, "commands");
}

} // namespace
} // namespace gpgp::test
