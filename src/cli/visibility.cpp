// `gpgp visibility`: samples which triangles of a model one camera sees.
#include "cli/sampled_model.h"
#include "cli/visibility_pictures.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <sstream>

namespace gpgp::cli {
namespace {

uint32_t countOf(const std::vector<uint32_t>& bits) {
  uint32_t count = 0;
  for (const uint32_t word : bits) count += static_cast<uint32_t>(std::popcount(word));
  return count;
}

/// As --export-ids promises.
void writeIds(const std::string& path, const std::vector<uint32_t>& found, uint32_t triangles) {
  std::vector<uint32_t> ids;
  for (size_t i = 0; i < triangles; ++i)
    if (isSet(found, i)) ids.push_back(static_cast<uint32_t>(i));
  std::ofstream file(path, std::ios::binary);
  for (const uint32_t id : ids) {
    const std::array<char, 4> bytes{static_cast<char>(id), static_cast<char>(id >> 8), static_cast<char>(id >> 16),
                                    static_cast<char>(id >> 24)};
    file.write(bytes.data(), 4);
  }
  if (!file.flush()) throw Failure(path + ": cannot be written");
}

Bounds boundsOf(const Model& model) {
  Bounds bounds;
  for (const glm::vec3& corner : worldCorners(model)) bounds.add(corner);
  return bounds;
}

/// Averages over the cameras, but for what says otherwise.
struct Figures {
  double truth = 0, visible = 0, coverage = 0, overestimation = 0, coverageArea = 0, overestimationArea = 0;
  std::vector<std::pair<std::string, double>> passes; ///< milliseconds of all views of a cell
  double milliseconds = 0;                            ///< the same of whole records, median over the cameras
  GpuTimes times;                                     ///< the last view's
  GpgpSampleReport report{};                          ///< the last view's
  std::vector<uint32_t> found;                        ///< the last camera's

  /// Of one camera of `cameras`.
  void add(const GpgpSampleReport& metrics, uint32_t cameras) {
    truth += metrics.truth / static_cast<double>(cameras);
    // A camera that could see nothing has missed nothing.
    coverage += (metrics.truth ? static_cast<double>(metrics.coverage) : 1.0) / cameras;
    overestimation += static_cast<double>(metrics.overestimation) / cameras;
    coverageArea += (metrics.truth ? static_cast<double>(metrics.coverageArea) : 1.0) / cameras;
    overestimationArea += static_cast<double>(metrics.overestimationArea) / cameras;
  }
  void add(const std::vector<std::pair<std::string, double>>& each, uint32_t cameras) {
    if (passes.size() < each.size()) passes.clear();
    for (size_t p = 0; p < each.size(); ++p) {
      if (passes.size() <= p) passes.emplace_back(each[p].first, 0.0);
      passes[p].second += each[p].second / cameras;
    }
  }
};

/// Samples from each camera, with the truth and the overlay where asked for.
Figures measure(Session& session, const VisibilityOptions& options, const Cell& cell, const Model& model,
                const Bounds& bounds, const std::vector<glm::vec3>& corners) {
  const GpgpSamplingMethod method = options.sampling();
  SampledModel scene(session, options, model);
  Sampler sampler = scene.sampler(method, method == GPGP_SAMPLING_STANDARD ? options.samples : 1);
  Figures figures;
  std::vector<double> totals;
  const uint32_t cameras = options.cameras();
  for (uint32_t k = 0; k < cameras; ++k) {
    const View view = !options.camera.empty() ? readView(options.camera)
                      : options.orbit
                          ? orbitView(bounds, k, options.orbit, options.distance, options.size)
                          : View{viewAll(bounds, options.yaw, options.pitch, options.size.width, options.size.height)};
    const std::vector<View> views = viewsOf(cell, view, bounds.centre(), options.size.height);
    double total = 0;
    for (size_t v = 0; v < views.size(); ++v) {
      SampledModel::Step step;
      step.method = method;
      step.view = views[v];
      step.samples = options.samples;
      step.repeat = options.repeat;
      step.accumulate = v > 0;
      const auto measured = scene.sample(sampler, step);
      figures.times = measured.times;
      figures.report = measured.report;
      figures.add(measured.times.passes, cameras);
      total += measured.times.median();
    }
    totals.push_back(total);
    figures.found = scene.bits();
    figures.visible += static_cast<double>(countOf(figures.found)) / cameras;

    const bool overlay = !options.overlay.empty() && k == 0;
    std::vector<uint32_t> standard, truth;
    if (overlay) {
      Sampler plain = scene.sampler(GPGP_SAMPLING_STANDARD, 1);
      SampledModel::Step step;
      step.view = view;
      scene.sample(plain, step);
      standard = scene.bits();
    }
    if (options.truth) {
      truth = scene.truth(views, options.truth);
      const std::vector<uint32_t> areas = scene.sizes();
      GpgpSampleReport metrics = scene.compare(sampler, figures.found, truth, areas, {});
      if (metrics.falsePositives && options.recheck > options.truth)
        metrics = scene.compare(sampler, figures.found, truth, areas, scene.truth(views, options.recheck));
      figures.add(metrics, cameras);
    }
    if (overlay) paintOverlay(options, corners, view.camera, figures.found, standard, truth);
  }
  std::sort(totals.begin(), totals.end());
  figures.milliseconds = totals[totals.size() / 2];
  return figures;
}

Outcome outcomeOf(const VisibilityOptions& options, const Model& model, const Figures& figures,
                  const std::string& device) {
  const double share = 100.0 * figures.visible / model.triangleCount;
  Outcome outcome;
  std::ostringstream text;
  text.precision(4);
  text << options.model << ": " << model.triangleCount << " triangles in " << model.draws.size() << " draws\n"
       << figures.visible << " visible (" << share << " %)";
  if (options.sampling() == GPGP_SAMPLING_STANDARD)
    text << ", " << figures.report.coveredPixels << " of " << uint64_t{options.size.width} * options.size.height
         << " pixels covered";
  text << "; GPU " << milliseconds(figures.milliseconds) << " (median of " << figures.times.totals.size() << ") on "
       << device << '\n';
  if (options.truth)
    text << "truth " << figures.truth << ": coverage " << 100 * figures.coverage << " %, overestimation "
         << 100 * figures.overestimation << " %; by area " << 100 * figures.coverageArea << " %, "
         << 100 * figures.overestimationArea << " %\n";
  if (figures.report.listed < figures.report.visible)
    text << "budget exceeded: " << figures.report.visible - figures.report.listed << " not listed\n";
  if (figures.report.unresolved)
    text << "budget exceeded: " << figures.report.unresolved << " without room count as visible\n";
  if (model.leftOut) text << model.leftOut << " primitives are no triangles and were left out\n";
  if (!options.image.empty())
    text << "picture: " << options.image << " (left: from the camera; right: from the side)\n";
  if (!options.overlay.empty())
    text << "overlay: " << options.overlay << " (green standard, grey added, red too much, blue missed)\n";
  outcome.text = text.str();
  const auto measured = [&](double value) { return options.truth ? Json(value) : Json(); };
  Json passTimes = Json::object();
  for (const auto& [name, time] : figures.passes) passTimes[name] = time;
  outcome.json = {{"model", options.model},
                  {"device", device},
                  {"status", statusName(figures.report.base.status)},
                  {"method", options.method},
                  {"width", options.size.width},
                  {"height", options.size.height},
                  {"draws", model.draws.size()},
                  {"triangles", model.triangleCount},
                  {"facing", figures.report.triangles},
                  {"visible", std::llround(figures.visible)},
                  {"listed", figures.report.listed},
                  {"coveredPixels", figures.report.coveredPixels},
                  {"gpuMilliseconds", figures.times.json()},
                  {"image", options.image.empty() ? Json() : Json(options.image)},
                  {"cameras", options.cameras()},
                  {"truth", options.truth ? Json(std::llround(figures.truth)) : Json()},
                  {"coverage", measured(figures.coverage)},
                  {"overestimation", measured(figures.overestimation)},
                  {"coverage_area", measured(figures.coverageArea)},
                  {"overestimation_area", measured(figures.overestimationArea)},
                  {"neededCandidates", figures.report.neededCandidates},
                  {"neededPairs", figures.report.neededPairs},
                  {"unresolved", figures.report.unresolved},
                  {"gpu_ms_median", figures.milliseconds},
                  {"passes", passTimes}};
  return outcome;
}

Outcome visibility(const VisibilityOptions& options, const CommonOptions& common) {
  if (options.method == "cell" && options.cell.empty()) throw Usage("--method cell needs --cell SPEC");
  const Cell cell(options.cell);
  Model model = loadModel(options.model);
  if (options.twoSided)
    for (GpgpVisibilityDraw& draw : model.draws) draw.flags |= GPGP_DRAW_TWO_SIDED;
  Bounds bounds = boundsOf(model);
  if (options.grid.width * options.grid.height > 1) {
    repeatInGrid(model, options.grid.width, options.grid.height, bounds.high - bounds.low);
    bounds = boundsOf(model);
  }
  const bool paints = !options.image.empty() || !options.overlay.empty();
  const std::vector<glm::vec3> corners = paints ? worldCorners(model) : std::vector<glm::vec3>();

  Session session(common);
  const Figures figures = measure(session, options, cell, model, bounds, corners);
  if (!options.exportIds.empty()) writeIds(options.exportIds, figures.found, model.triangleCount);
  if (!options.image.empty()) paintSeen(options, corners, bounds, figures.found);
  session.checkValidation();
  return outcomeOf(options, model, figures, session.device().name());
}
} // namespace

Work addVisibility(CLI::App& app) {
  auto options = std::make_shared<VisibilityOptions>();
  CLI::App* command = app.add_subcommand("visibility", "Sample which triangles of a model a camera sees");
  addVisibilityOptions(*command, *options);
  command->footer(R"(
Examples:
  gpgp visibility engine.glb
  gpgp visibility bunny.obj --yaw 90 --image seen.png
  gpgp visibility engine.glb --size 1920x1080 --repeat 100 --json | jq .visible
  gpgp visibility engine.glb --method exact --orbit 8 --truth 64 --overlay seen.png

The camera looks at the middle of the model from far enough to see all of it.)");
  return [options](const CommonOptions& common) { return visibility(*options, common); };
}

} // namespace gpgp::cli
