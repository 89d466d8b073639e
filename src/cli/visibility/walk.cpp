#include "cli/visibility/walk.h"

#include "cli/shared/command.h"
#include "cli/shared/progress.h"
#include "visibility/camera_axes.h"

#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <bit>
#include <sstream>

namespace gpgp::cli {
namespace {
constexpr double kFramesPerSecond = 60;
constexpr size_t kFirst = 2; ///< of the frames that count for means: before it all is decided, to have what is compared

uint32_t countOf(const std::vector<uint32_t>& bits, const std::vector<uint32_t>& without) {
  uint32_t count = 0;
  for (size_t i = 0; i < bits.size(); ++i) count += static_cast<uint32_t>(std::popcount(bits[i] & ~without[i]));
  return count;
}

/// Sums over the frames that count, or over all if there are no others.
struct Means {
  double standard = 0, exact = 0, reusing = 0, visible = 0, late = 0, kept = 0;
  double decided = 0, allDecided = 0, pixels = 0, allPixels = 0;

  explicit Means(const std::vector<WalkFrame>& frames) {
    const size_t first = frames.size() > kFirst ? kFirst : 0;
    const double count = static_cast<double>(std::max<size_t>(frames.size() - first, 1));
    for (size_t i = first; i < frames.size(); ++i) {
      const WalkFrame& f = frames[i];
      standard += f.standard / count, exact += f.exact / count, reusing += f.reusing / count;
      visible += f.visible / count, late += f.late / count, kept += f.kept / count;
      decided += f.decided / count, allDecided += f.allDecided / count;
      pixels += f.decidedPixels / count, allPixels += f.allPixels / count;
    }
  }
};

double shareOf(double part, double whole) { return whole > 0 ? part / whole : 0; }
} // namespace

View walkedView(const View& start, const Walk& walk, uint32_t k) {
  const auto eye = eyeOf(start);
  if (!eye) throw Failure("--walk: the camera is not a perspective camera");
  GpgpCamera camera{};
  std::copy_n(glm::value_ptr(start.camera), 16, camera.viewProjection);
  camera.reversedDepth = start.reversed;
  const visibility::CameraAxes axes(camera);
  const double seconds = k / kFramesPerSecond;
  const glm::dvec3 by = glm::dvec3(-axes.back) * (static_cast<double>(walk.speed) * seconds);
  const double angle = glm::radians(static_cast<double>(walk.turn) * seconds);
  // Turned about the eye, then moved: the world moves the other way.
  const glm::dmat4 world = glm::translate(glm::dmat4(1), *eye) *
                           glm::rotate(glm::dmat4(1), angle, glm::dvec3(axes.up)) *
                           glm::translate(glm::dmat4(1), -*eye - by);
  return {glm::mat4(glm::dmat4(start.camera) * world), start.reversed};
}

std::string WalkFigures::text() const {
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(3);
  const Means m(frames);
  text << "walk: " << frames.size() << " frames; with reuse " << m.reusing << " ms, " << shareOf(m.reusing, m.standard)
       << " times standard sampling (" << m.standard << " ms), exact sampling without " << m.exact << " ms\n";
  text.precision(2);
  text << "  decided again: " << 100 * shareOf(m.decided, m.allDecided)
       << " % of the triangles between pixel centres, in " << 100 * shareOf(m.pixels, m.allPixels)
       << " % of the pixels; late " << 100 * shareOf(m.late, m.visible) << " %, kept too long "
       << 100 * shareOf(m.kept, m.visible) << " %\n";
  return text.str();
}

Json WalkFigures::json() const {
  const Means m(frames);
  Json object = {{"standardMilliseconds", m.standard},
                 {"exactMilliseconds", m.exact},
                 {"reuseMilliseconds", m.reusing},
                 {"late", shareOf(m.late, m.visible)},
                 {"kept", shareOf(m.kept, m.visible)},
                 {"decided", shareOf(m.decided, m.allDecided)},
                 {"decidedPixels", shareOf(m.pixels, m.allPixels)},
                 {"frames", Json::array()}};
  for (const WalkFrame& f : frames)
    object["frames"].push_back({{"standardMilliseconds", f.standard},
                                {"exactMilliseconds", f.exact},
                                {"reuseMilliseconds", f.reusing},
                                {"visible", f.visible},
                                {"late", f.late},
                                {"kept", f.kept},
                                {"decided", f.decided},
                                {"decidedPixels", f.decidedPixels},
                                {"allDecided", f.allDecided},
                                {"allPixels", f.allPixels}});
  return object;
}

WalkFigures measureWalk(Session& session, SampledModel& scene, VisibilityRecorder& exact, const Walk& walk,
                        const View& view, uint32_t triangles) {
  VisibilityRecorder standard = scene.recorder(GPGP_SAMPLING_STANDARD, 1);
  GpgpCameraHistoryCreateInfo info = GPGP_CAMERA_HISTORY_CREATE_INFO_INIT;
  info.label = "walk";
  info.maxTriangles = std::max(triangles, 1u);
  info.maxLate = walk.maxLate;
  const CameraHistory history = session.take(CameraHistory::create(session.context(), info), "gpgpCreateCameraHistory");
  session.upload();
  WalkFigures figures;
  Progress progress("walking", walk.frames);
  for (uint32_t k = 0; k < walk.frames; ++k) {
    SampledModel::Step step;
    step.view = walkedView(view, walk, k);
    session.keepBusy();
    WalkFrame frame;
    if (k == 0) scene.sample(standard, step); // not counted: pipelines and memory are used the first time
    frame.standard = scene.sample(standard, step).times.median();
    step.method = GPGP_SAMPLING_EXACT;
    const auto all = scene.sample(exact, step);
    const std::vector<uint32_t> whole = scene.bits();
    step.history = history.get();
    const auto reusing = scene.sample(exact, step);
    const std::vector<uint32_t> found = scene.bits();
    frame.exact = all.times.median();
    frame.reusing = reusing.times.median();
    frame.visible = all.report.visible;
    frame.late = countOf(whole, found);
    frame.kept = countOf(found, whole);
    frame.decided = reusing.report.decided;
    frame.decidedPixels = reusing.report.decidedPixels;
    frame.allDecided = all.report.decided;
    frame.allPixels = all.report.decidedPixels;
    figures.frames.push_back(frame);
    progress.advance();
  }
  return figures;
}

} // namespace gpgp::cli
