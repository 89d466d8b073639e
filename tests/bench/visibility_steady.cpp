#include "visibility_steady.h"

#include "visibility/camera_axes.h"

#include <bit>
#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/trigonometric.hpp>

namespace gpgp::test {
namespace {

/// Frame k: walked along the view of the start, turned about the camera's place.
GpgpCamera walked(const GpgpCamera& start, const SteadyWalk& walk, uint32_t k) {
  const visibility::CameraAxes axes(start);
  const auto frames = static_cast<float>(k);
  const glm::dmat4 matrix(glm::make_mat4(start.viewProjection));
  const glm::dvec4 place = glm::inverse(matrix) * glm::dvec4(0, 0, 1, 0); // where clip space's x, y and w are 0
  const glm::dvec3 eye = glm::dvec3(place) / place.w;
  const glm::dvec3 by = glm::dvec3(-axes.back) * static_cast<double>(walk.step * frames);
  const double angle = glm::radians(static_cast<double>(walk.turn * frames));
  const glm::dmat4 world = glm::translate(glm::dmat4(1), eye) * glm::rotate(glm::dmat4(1), angle, glm::dvec3(axes.up)) *
                           glm::translate(glm::dmat4(1), -eye - by);
  GpgpCamera camera = start;
  const glm::mat4 result(matrix * world);
  std::copy_n(glm::value_ptr(result), 16, camera.viewProjection);
  return camera;
}

uint64_t countOf(const std::vector<uint32_t>& bits, const std::vector<uint32_t>& without) {
  uint64_t count = 0;
  for (size_t i = 0; i < bits.size(); ++i) count += static_cast<uint64_t>(std::popcount(bits[i] & ~without[i]));
  return count;
}
} // namespace

void printSteadyWalk(Runner& runner, const std::string& scene, const SteadyWalk& walk) {
  VisibilityRecorder standard = runner.recorder(GPGP_SAMPLING_STANDARD_BIT, 1);
  VisibilityRecorder exact = runner.recorder(GPGP_SAMPLING_EXACT_BIT, 1);
  const CameraHistory history = runner.history(walk.maxLate);
  std::printf("%s: %u triangles, %g units and %g degrees a frame, maxLate %g\n"
              "  frame   standard    exact    reuse  ratio  visible   late %%   kept %%    decided          of     "
              "pixels          of\n",
              scene.c_str(), runner.triangles(), static_cast<double>(walk.step), static_cast<double>(walk.turn),
              static_cast<double>(walk.maxLate));
  constexpr int kColumns = 10;
  double sums[kColumns] = {}, pixels = 0;
  uint32_t counted = 0;
  for (uint32_t frame = 0; frame < walk.frames; ++frame) {
    const GpgpCamera camera = walked(runner.camera(), walk, frame);
    const Runner::Run plain = runner.timed(standard, {}, camera);
    const Runner::Run whole = runner.timed(exact, {.method = GPGP_SAMPLING_EXACT}, camera);
    const std::vector<uint32_t> all = runner.download();
    const Runner::Run part = runner.timed(exact, {.method = GPGP_SAMPLING_EXACT, .history = history.get()}, camera);
    const std::vector<uint32_t> found = runner.download();
    const double visible = std::max(whole.report.visible, 1u);
    const double row[kColumns] = {plain.milliseconds,
                                  whole.milliseconds,
                                  part.milliseconds,
                                  part.milliseconds / plain.milliseconds,
                                  visible,
                                  100 * static_cast<double>(countOf(all, found)) / visible,
                                  100 * static_cast<double>(countOf(found, all)) / visible,
                                  static_cast<double>(part.report.decided),
                                  static_cast<double>(whole.report.decided),
                                  static_cast<double>(part.report.decidedPixels)};
    const auto print = [](const char* name, const double* r, double pixelsOfAll) {
      std::printf("  %-7s %9.3f %8.3f %8.3f %6.2f %8.0f %8.3f %8.3f %10.0f %11.0f %10.0f %11.0f\n", name, r[0], r[1],
                  r[2], r[3], r[4], r[5], r[6], r[7], r[8], r[9], pixelsOfAll);
    };
    print(std::to_string(frame).c_str(), row, whole.report.decidedPixels);
    if (frame < 2) continue; // decides all: the first, and the one that measures how much changes
    for (int i = 0; i < kColumns; ++i) sums[i] += row[i];
    pixels += whole.report.decidedPixels;
    if (++counted && frame + 1 == walk.frames) {
      for (double& sum : sums) sum /= counted;
      sums[3] = sums[2] / sums[0];
      print("mean", sums, pixels / counted);
    }
  }
}

} // namespace gpgp::test
