#include "cli/visibility/motion.h"

#include "cli/shared/command.h"
#include "cli/visibility/camera_times.h"
#include "core/random.h"
#include "visibility/camera_axes.h"

#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace gpgp::cli {
namespace {
constexpr uint32_t kMostCameras = 3;
} // namespace

MotionCell::MotionCell(const Motion& motion, float eyes, const View& view, Size viewport) {
  std::copy_n(glm::value_ptr(view.camera), 16, info.camera.viewProjection);
  info.camera.reversedDepth = view.reversed;
  info.width = viewport.width;
  info.height = viewport.height;
  const glm::vec3 velocity = -visibility::CameraAxes(info.camera).back * motion.speed;
  std::copy_n(glm::value_ptr(velocity), 3, info.velocity);
  info.acceleration = 2 * std::abs(motion.speed); // stops within half a second
  info.turnRate = glm::radians(motion.turn);
  info.latest = motion.latency / 1000;
  info.eyeDistance = eyes;
  uint32_t count = kMostCameras;
  GpgpCamera cameras[kMostCameras];
  const GpgpResult result = gpgpGetViewMotionCameras(&info, &count, cameras, &coverage);
  if (result != GPGP_SUCCESS)
    throw Failure(std::string("--motion: ") + gpgpResultString(result) +
                  ": the camera is not a perspective camera, or the viewer turns by more than 90 degrees");
  for (uint32_t i = 0; i < count; ++i) views.push_back({glm::make_mat4(cameras[i].viewProjection), view.reversed});
}

View MotionCell::viewer(uint32_t k) const {
  const View middle{glm::make_mat4(info.camera.viewProjection), info.camera.reversedDepth != 0};
  const visibility::CameraAxes axes(info.camera);
  const auto draw = [&](uint32_t number) { return shader::unitFloat(shader::childSeed(k + 1, number)); };
  const auto either = [&](uint32_t number) { return draw(number) < 0.5f ? -1.0f : 1.0f; };
  const bool extreme = k < 4;
  const float time = extreme ? info.latest : info.latest * draw(0);
  const float angle = info.turnRate * time * (extreme ? (k & 1 ? -1.0f : 1.0f) : 2 * draw(1) - 1);
  glm::vec3 drift(2 * draw(2) - 1, 2 * draw(3) - 1, 2 * draw(4) - 1);
  drift *= 0.5f * info.acceleration * time * time / std::max(glm::length(drift), 1.0f);
  const glm::mat4 turn = glm::rotate(glm::mat4(1), angle, axes.up);
  const glm::vec3 eye = glm::vec3(turn * glm::vec4(axes.right, 0)) * (0.5f * info.eyeDistance * either(5));
  const glm::vec3 at = glm::make_vec3(info.velocity) * time + drift + eye;
  // Turned about the eye of the pose, then moved: the world moves the other way.
  const glm::dvec3 pose = eyeOf(middle).value();
  const glm::dmat4 world = glm::translate(glm::dmat4(1), pose) * glm::inverse(glm::dmat4(turn)) *
                           glm::translate(glm::dmat4(1), -pose - glm::dvec3(at));
  return {glm::mat4(glm::dmat4(middle.camera) * world), middle.reversed};
}

std::string MotionFigures::text(double cellMilliseconds) const {
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(2);
  text << "motion: " << cameras << " view points of " << size.width << "x" << size.height;
  if (oneViewMilliseconds > 0)
    text << ", " << cellMilliseconds / oneViewMilliseconds << " times one exact view (" << oneViewMilliseconds
         << " ms)";
  if (viewers)
    text << "; of what " << viewers << " viewers see it has " << 100 * mean << " % (the worst " << 100 * worst
         << " %), by area " << 100 * meanArea << " %";
  return text.str() + "\n";
}

Json MotionFigures::json() const {
  Json object = {{"viewPoints", cameras},
                 {"width", size.width},
                 {"height", size.height},
                 {"oneViewMilliseconds", oneViewMilliseconds},
                 {"viewers", viewers}};
  object["coverage"] = viewers ? Json(mean) : Json();
  object["worst"] = viewers ? Json(worst) : Json();
  object["coverage_area"] = viewers ? Json(meanArea) : Json();
  return object;
}

MotionFigures measureMotion(SampledModel& scene, VisibilityRecorder& recorder, const VisibilityOptions& options,
                            const Model& model, const MotionCell& cell, const View& view,
                            const std::vector<uint32_t>& found) {
  MotionFigures figures;
  figures.cameras = static_cast<uint32_t>(cell.views.size());
  figures.size = cell.sizeOf(0);
  SampledModel::Step step;
  step.method = options.sampling();
  step.view = view;
  step.repeat = options.repeat;
  const auto one = scene.sample(recorder, step);
  CameraTimes times;
  times.add(one.times);
  figures.oneViewMilliseconds = times.median;
  if (!options.reference) return figures;
  double sum = 0, areas = 0;
  for (uint32_t k = 0; k < options.viewers; ++k) {
    const Reference seen = referenceOf(scene, options, model, {cell.viewer(k)}, options.reference);
    const GpgpVisibilityReport metrics = scene.compare(recorder, found, seen.bits, seen.areas, {});
    if (!metrics.reference) continue;
    ++figures.viewers;
    const auto share = static_cast<double>(metrics.coverage);
    sum += share;
    areas += static_cast<double>(metrics.coverageArea);
    figures.worst = std::min(figures.worst, share);
  }
  figures.mean = figures.viewers ? sum / figures.viewers : 0;
  figures.meanArea = figures.viewers ? areas / figures.viewers : 0;
  return figures;
}

} // namespace gpgp::cli
