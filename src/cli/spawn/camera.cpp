#include "cli/spawn/camera.h"

#include "cli/shared/painter.h"
#include "cli/spawn/reference.h"
#include "spawn/schedule/camera.h"

#include <gpgp/detail.h>

#include <algorithm>
#include <array>

namespace gpgp::cli {

glm::mat4 cameraMatrix(const SpawnOptions& options) {
  const std::array<float, 6>& c = options.camera;
  return viewFrom({c[0], c[1], c[2]}, {c[3], c[4], c[5]}, options.fov, options.imageSize.width,
                  options.imageSize.height);
}

GpgpSpawnCamera cameraOf(const SpawnOptions& options) {
  GpgpSpawnCamera camera{};
  const glm::mat4 matrix = cameraMatrix(options);
  for (int i = 0; i < 16; ++i) camera.viewProjection[i] = matrix[i / 4][i % 4];
  std::copy_n(options.camera.begin(), 3, camera.position);
  camera.height = options.imageSize.height;
  camera.detail = options.detail;
  return camera;
}

shader::View viewOf(const std::optional<GpgpSpawnCamera>& camera) {
  const auto view = spawn::viewOf(camera ? &*camera : nullptr);
  if (!view) throw Usage(std::string("--camera: ") + view.error().text);
  return *view;
}

float detailWithin(uint32_t budget, GpgpSpawnCamera camera, std::span<const uint32_t> words,
                   const std::vector<GpgpAxiom>& axioms, uint32_t maxDepth, const std::string& grammar,
                   const spawn::BoundFields& fields) {
  constexpr int kMostSteps = 64; // the search takes a quarter of them
  GpgpDetailBudget allowed = GPGP_DETAIL_BUDGET_INIT;
  allowed.instances = budget;
  allowed.minDetail = 1.0f / 4096;
  GpgpDetail state{};
  state.detail = 1; // where that is within the budget, it is all there is
  uint64_t finest = 0;
  for (int step = 0; step < kMostSteps; ++step) {
    GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
    report.detail = camera.detail = state.detail;
    const shader::View view = viewOf(camera);
    const spawn::Derivation all = checkThatItEnds(words, axioms, maxDepth, grammar, {&view, &fields});
    const uint64_t terminals = all.complete ? all.terminals : UINT32_MAX;
    report.terminals = static_cast<uint32_t>(std::min<uint64_t>(terminals, UINT32_MAX));
    if (!step) finest = terminals;
    const GpgpResult result = gpgpAdaptDetail(&allowed, &report, 0, &state);
    if (result == GPGP_BUDGET_EXCEEDED)
      throw Failure(
          "--budget " + std::to_string(budget) + ": " + grammar + " becomes " + std::to_string(terminals) +
          " terminals with the least detail, " + std::to_string(camera.detail) +
          (terminals == finest ? ", as many as with all of it: no rule that matters here reads ScreenSize()" : ""));
    if (result != GPGP_SUCCESS) throw Failure(std::string("--budget: ") + gpgpResultString(result));
    if (state.detail == report.detail) break;
  }
  return state.safe;
}

} // namespace gpgp::cli
