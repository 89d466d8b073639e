#include "cli/visibility/reference.h"

#include "cli/shared/processors.h"
#include "cli/shared/progress.h"
#include "cli/visibility/forecast.h"
#include "visibility/reference/ray_reference.h"

#include <mutex>
#include <optional>

namespace gpgp::cli {
namespace {

/// Shows how far a reference is, and once the speed is known says how long all will take.
class Watch {
public:
  Watch(const VisibilityOptions& options, uint32_t samples)
      : options_(options), samples_(samples), again_(samples > options.reference) {}

  void told(uint64_t done, uint64_t total) { // on any thread
    const std::lock_guard lock(mutex_);
    if (!progress_)
      progress_.emplace((again_ ? "sampling again at " : "reference of ") + std::to_string(samples_) + " x " +
                            std::to_string(samples_),
                        total);
    progress_->advance();
    const auto now = std::chrono::steady_clock::now();
    if (!begin_) begin_ = now, first_ = done; // what came before that prepared
    const double seconds = std::chrono::duration<double>(now - *begin_).count();
    if (said_ || done <= first_ || (seconds < 0.5 && done < total)) return;
    said_ = true;
    const double all = seconds / static_cast<double>(done - first_) * static_cast<double>(total);
    std::fputs(forecast(all * options_.cameras(), samples_, again_).c_str(), stderr);
  }

private:
  const VisibilityOptions& options_;
  const uint32_t samples_;
  const bool again_;
  std::mutex mutex_;
  std::optional<Progress> progress_;
  std::optional<std::chrono::steady_clock::time_point> begin_;
  uint64_t first_ = 0;
  bool said_ = false;
};

} // namespace

Reference referenceOf(SampledModel& scene, const VisibilityOptions& options, const Model& model,
                      const std::vector<View>& views, uint32_t samples) {
  Watch watch(options, samples);
  Reference reference;
  if (options.referenceDevice == "gpu") {
    reference.bits = scene.reference(views, samples, [&](uint64_t done, uint64_t total) { watch.told(done, total); });
    reference.areas = scene.sizes();
    return reference;
  }
  const auto passesAlpha = [&model](uint32_t test, glm::dvec2 place) {
    const AlphaTexture& texture = model.alphaTests[test];
    return texture.at(place.x, place.y) >= static_cast<double>(texture.cutoff);
  };
  visibility::RayReference rays(
      {model.positions, model.indices, model.meshes, model.draws, model.triangleCount, model.coordinates, passesAlpha},
      [](size_t count, const auto& work) { onAllProcessors(count, work); });
  for (size_t view = 0; view < views.size(); ++view) {
    GpgpCamera camera{};
    std::copy_n(&views[view].camera[0][0], 16, camera.viewProjection);
    camera.reversedDepth = views[view].reversed;
    rays.add(camera, options.size.width, options.size.height, samples,
             [&](size_t done, size_t parts) { watch.told(view * parts + done, views.size() * parts); });
  }
  reference.bits = rays.bits();
  reference.areas = rays.areas();
  return reference;
}

} // namespace gpgp::cli
