// `gpgp visibility`: samples which triangles of a model one camera sees.
#include "cli/shared/command.h"
#include "cli/shared/progress.h"
#include "cli/visibility/atlas.h"
#include "cli/visibility/camera_times.h"
#include "cli/visibility/cell_walls.h"
#include "cli/visibility/motion.h"
#include "cli/visibility/pictures.h"
#include "cli/visibility/reference.h"
#include "cli/visibility/walk.h"
#include "host/files.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
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
  std::string bytes;
  for (const uint32_t id : ids)
    bytes.append(
        {static_cast<char>(id), static_cast<char>(id >> 8), static_cast<char>(id >> 16), static_cast<char>(id >> 24)});
  host::writeFile(path, bytes);
}

/// Of the triangles that can be sampled: those with finite corners below 2^100.
Bounds boundsOf(const Model& model) {
  Bounds bounds;
  const auto isModerate = [](const glm::vec3& p) {
    return std::abs(p.x) < 0x1p100f && std::abs(p.y) < 0x1p100f && std::abs(p.z) < 0x1p100f;
  };
  for (const GpgpVisibilityDraw& draw : model.draws)
    for (uint32_t t = 0; t < model.meshes[draw.mesh].indexCount / 3; ++t) {
      const std::array<glm::vec3, 3> corners = worldCorners(model, draw, t);
      if (std::all_of(corners.begin(), corners.end(), isModerate))
        for (const glm::vec3& corner : corners) bounds.add(corner);
    }
  return bounds;
}

/// Where positions are to count from: floats have few digits left of the form of what lies far from their origin.
glm::dvec3 originFor(const Bounds& bounds) {
  constexpr float kFar = 64;                                                // radii
  const bool isFar = glm::length(bounds.centre()) > kFar * bounds.radius(); // false where there are no bounds
  return isFar && bounds.radius() > 0 ? glm::dvec3(bounds.centre()) : glm::dvec3(0);
}

/// Camera k: the file's, the orbit's, or one that sees everything.
View viewOf(const VisibilityOptions& options, const Model& model, const Bounds& bounds, uint32_t k) {
  if (!options.camera.empty()) return readView(options.camera, model.origin);
  if (!(bounds.low.x <= bounds.high.x)) throw Failure(options.model + ": no triangle has finite corners below 2^100");
  const glm::vec3 most = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
  if (const float reach = std::max({most.x, most.y, most.z}); reach > kMostReach) {
    std::ostringstream text;
    text << options.model << ": positions reach " << reach << ", which is too far for a camera that sees them all ("
         << kMostReach << "); give --camera";
    throw Failure(text.str());
  }
  if (options.orbit) return orbitView(bounds, k, options.orbit, options.distance, options.size);
  return {viewAll(bounds, options.yaw, options.pitch, options.size.width, options.size.height)};
}

std::string fixed(double value, int digits) {
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(digits);
  text << value;
  return text.str();
}

/// Means over cameras need not be whole.
std::string countText(double value) { return fixed(value, std::abs(value - std::round(value)) < 0.05 ? 0 : 1); }

std::string percent(double share) { return fixed(100 * share, 2) + " %"; }

/// A share's average over the cameras that have one: of nothing there is none.
struct Share {
  double sum = 0;
  uint32_t cameras = 0;

  void add(double value) {
    sum += value;
    ++cameras;
  }
  Json json() const { return cameras ? Json(sum / cameras) : Json(); }
  std::string text() const { return cameras ? percent(sum / cameras) : "-"; }
};

/// Errors are worse than anything else.
GpgpResult worse(GpgpResult a, GpgpResult b) {
  const auto badness = [](GpgpResult result) { return result < 0 ? 1000 - int{result} : int{result}; };
  return badness(a) < badness(b) ? b : a;
}

/// Averages over the cameras, but for what says otherwise.
struct Figures {
  double reference = 0, visible = 0;
  Share coverage, overestimation, coverageArea, overestimationArea;
  double facing = 0, listed = 0, coveredPixels = 0; ///< of a cell's last view
  CameraTimes times;
  GpgpResult status = GPGP_SUCCESS; ///< of all recordings the worst
  /// Of all recordings the largest; the unresolved ones of all.
  uint32_t neededCandidates = 0, neededPairs = 0, skippedTriangles = 0, skippedDraws = 0;
  uint64_t unresolved = 0;
  uint32_t maxCandidates = 0, maxPairs = 0; ///< given
  uint32_t viewPoints = 0, behindWalls = 0; ///< of all cameras' cells; these were left out
  std::vector<uint32_t> found, first;       ///< of all cameras together; of the first one
  std::optional<AtlasFigures> atlas;        ///< of the first one
  std::optional<MotionFigures> motion;      ///< of the first one
  std::optional<WalkFigures> walk;          ///< from the first one's place

  /// Metrics of one camera of `cameras`; areas of the reference's triangles, in samples.
  void addMetrics(const GpgpVisibilityReport& metrics, const std::vector<uint32_t>& areas, uint32_t cameras) {
    reference += metrics.reference / static_cast<double>(cameras);
    if (metrics.reference) {
      coverage.add(metrics.coverage);
      overestimation.add(metrics.overestimation);
    }
    if (std::any_of(areas.begin(), areas.end(), [](uint32_t area) { return area > 0; })) {
      coverageArea.add(metrics.coverageArea);
      overestimationArea.add(metrics.overestimationArea);
    }
  }
  /// A recording of a view.
  void add(const GpgpVisibilityReport& report) {
    status = worse(status, report.base.status);
    neededCandidates = std::max(neededCandidates, report.neededCandidates);
    neededPairs = std::max(neededPairs, report.neededPairs);
    skippedTriangles = std::max(skippedTriangles, report.skippedTriangles);
    skippedDraws = std::max(skippedDraws, report.skippedDraws);
    unresolved += report.unresolved;
  }
  /// What a camera's last recording of `cameras` found.
  void add(const GpgpVisibilityReport& last, std::vector<uint32_t> bits, uint32_t cameras) {
    facing += last.triangles / static_cast<double>(cameras);
    listed += last.listed / static_cast<double>(cameras);
    coveredPixels += last.coveredPixels / static_cast<double>(cameras);
    visible += countOf(bits) / static_cast<double>(cameras);
    if (found.empty())
      found = first = std::move(bits);
    else
      for (size_t i = 0; i < found.size(); ++i) found[i] |= bits[i];
  }
};

/// Samples from each camera, with the reference and the overlay where asked for.
Figures measure(Session& session, const VisibilityOptions& options, const Cell& cell, const Model& model,
                const Bounds& bounds, const std::vector<glm::vec3>& corners) {
  const GpgpSamplingMethod method = options.sampling();
  SampledModel scene(session, options, model);
  const uint32_t cameras = options.cameras();
  std::vector<std::optional<MotionCell>> motions(cameras);
  Size largest = options.size;
  for (uint32_t k = 0; k < cameras && options.motion; ++k) {
    motions[k].emplace(*options.motion, options.eyes, viewOf(options, model, bounds, k), options.size);
    const Size wide = motions[k]->sizeOf(0);
    largest = {std::max(largest.width, wide.width), std::max(largest.height, wide.height)};
  }
  VisibilityRecorder recorder = scene.recorder(method, method == GPGP_SAMPLING_STANDARD ? options.samples : 1, largest);
  Figures figures;
  figures.maxCandidates = scene.maxCandidates();
  figures.maxPairs = scene.maxPairs(largest);
  std::vector<CameraTimes> times;
  for (uint32_t k = 0; k < cameras; ++k) {
    const std::string label =
        "sampling" +
        (cameras > 1 ? " from camera " + std::to_string(k + 1) + " of " + std::to_string(cameras) : std::string());
    const View view = viewOf(options, model, bounds, k);
    const auto& motion = motions[k];
    std::vector<View> views = motion ? motion->views : viewsOf(cell, view, bounds.centre(), options.size.height);
    figures.viewPoints += static_cast<uint32_t>(views.size());
    if (!options.throughWalls) figures.behindWalls += leaveOutBehindWalls(views, model);
    GpgpVisibilityReport last{};
    times.emplace_back();
    std::optional<Progress> progress;
    if (options.repeat == 1) progress.emplace(label, views.size());
    for (size_t v = 0; v < views.size(); ++v) {
      SampledModel::Step step;
      step.method = method;
      step.view = views[v];
      if (motion) step.size = motion->sizeOf(v);
      step.samples = options.samples;
      if (k == 0 && v == 0) scene.sample(recorder, step); // not counted: pipelines and memory are used the first time
      step.repeat = options.repeat;
      step.accumulate = v > 0;
      const auto measured = scene.sample(recorder, step);
      times.back().add(measured.times);
      figures.add(measured.report);
      last = measured.report;
      if (progress) progress->advance();
    }
    progress.reset();
    const std::vector<uint32_t> found = scene.bits();
    figures.add(last, found, cameras);
    if (k == 0 && motion) figures.motion = measureMotion(scene, recorder, options, model, *motion, view, found);
    if (k == 0 && options.walk)
      figures.walk = measureWalk(session, scene, recorder, *options.walk, view, model.triangleCount);
    if (k == 0 && options.atlas.width) figures.atlas = allocateAtlas(session, options, scene, model, corners, view);

    const bool overlay = !options.overlay.empty() && k == 0;
    std::vector<uint32_t> standard, reference;
    if (overlay) {
      VisibilityRecorder plain = scene.recorder(GPGP_SAMPLING_STANDARD, 1);
      SampledModel::Step step;
      step.view = view;
      scene.sample(plain, step);
      standard = scene.bits();
    }
    if (options.reference && !motion) {
      const bool again = options.recheck > options.reference;
      auto [bits, areas] = referenceOf(scene, options, model, views, options.reference);
      reference = std::move(bits);
      GpgpVisibilityReport metrics = scene.compare(recorder, found, reference, areas, {});
      if (metrics.falsePositives && again) {
        const std::vector<uint32_t> finer = referenceOf(scene, options, model, views, options.recheck).bits;
        metrics = scene.compare(recorder, found, reference, areas, finer);
        for (size_t i = 0; i < reference.size(); ++i) reference[i] |= found[i] & finer[i]; // as the metrics count them
      }
      figures.addMetrics(metrics, areas, cameras);
    }
    const Progress painting("painting");
    if (overlay) paintOverlay(options, corners, view, views.size() > 1, found, standard, reference);
  }
  figures.times = medianOf(times);
  return figures;
}

/// What went wrong without failing, for people.
std::string remarks(const Model& model, const Figures& figures) {
  std::ostringstream text;
  if (figures.neededCandidates > figures.maxCandidates || figures.neededPairs > figures.maxPairs)
    text << "budget exceeded: " << figures.neededCandidates << " candidates and " << figures.neededPairs
         << " pairs or more need room, which " << figures.maxCandidates << " and " << figures.maxPairs << " have; "
         << figures.unresolved << " found none, and their triangles count as visible\n";
  else if (figures.unresolved)
    text << "not decided: " << figures.unresolved
         << " triangles count as visible, because too many meet in a pixel, or have one depth there; no budget changes "
            "that\n";
  if (figures.skippedTriangles)
    text << figures.skippedTriangles << " triangles skipped: a coordinate is not finite or reaches 2^100\n";
  if (figures.behindWalls)
    text << figures.behindWalls << " of " << figures.viewPoints
         << " view points left out: a triangle lies between them and the middle (--through-walls keeps them)\n";
  if (figures.skippedDraws) text << figures.skippedDraws << " draws skipped: they have no mesh\n";
  if (model.omitted) text << model.omitted << " primitives are not triangles and were left out\n";
  for (const std::string& note : model.notes) text << note << '\n';
  return text.str();
}

Outcome outcomeOf(const VisibilityOptions& options, const Model& model, const Figures& figures,
                  const std::string& device) {
  Outcome outcome;
  std::ostringstream text;
  const char* first = options.cameras() > 1 ? "first " : "";
  text << options.model << ": " << model.triangleCount << " triangles in " << model.draws.size() << " draws\n"
       << countText(figures.visible) << " visible (" << percent(figures.visible / model.triangleCount) << ')';
  if (options.sampling() == GPGP_SAMPLING_STANDARD)
    text << ", " << std::llround(figures.coveredPixels) << " of "
         << uint64_t{options.size.width} * options.size.height * options.samples * options.samples
         << (options.samples > 1 ? " samples covered" : " pixels covered");
  text << "; GPU " << milliseconds(figures.times.median) << " (median of " << figures.times.repeats << ") on " << device
       << '\n';
  if (figures.motion) text << figures.motion->text(figures.times.median);
  if (figures.walk) text << figures.walk->text();
  if (options.reference && !figures.motion)
    text << (options.referenceDevice == "cpu" ? "reference by rays " : "reference ") << countText(figures.reference)
         << ": coverage " << figures.coverage.text() << ", overestimation " << figures.overestimation.text()
         << "; by area " << figures.coverageArea.text() << ", " << figures.overestimationArea.text() << '\n';
  if (figures.atlas) text << textOf(options, *figures.atlas);
  text << remarks(model, figures);
  if (!options.image.empty())
    text << "picture: " << options.image << " (left: from the " << first << "camera; right: from the side)\n";
  if (!options.overlay.empty())
    text << "overlay: " << options.overlay << " (from the " << first
         << "camera: green standard, grey added, red too much, blue missed)\n";
  outcome.text = text.str();
  outcome.json = {{"model", options.model},
                  {"device", device},
                  {"status", statusName(figures.status)},
                  {"method", options.method},
                  {"width", options.size.width},
                  {"height", options.size.height},
                  {"draws", model.draws.size()},
                  {"triangles", model.triangleCount},
                  {"facing", std::llround(figures.facing)},
                  {"visible", std::llround(figures.visible)},
                  {"listed", std::llround(figures.listed)},
                  {"coveredPixels", std::llround(figures.coveredPixels)},
                  {"gpuMilliseconds", figures.times.json()},
                  {"image", options.image.empty() ? Json() : Json(options.image)},
                  {"cameras", options.cameras()},
                  {"viewPoints", figures.viewPoints},
                  {"behindWalls", figures.behindWalls},
                  {"referenceDevice", options.reference ? Json(options.referenceDevice) : Json()},
                  {"reference", options.reference ? Json(std::llround(figures.reference)) : Json()},
                  {"coverage", figures.coverage.json()},
                  {"overestimation", figures.overestimation.json()},
                  {"coverage_area", figures.coverageArea.json()},
                  {"overestimation_area", figures.overestimationArea.json()},
                  {"neededCandidates", figures.neededCandidates},
                  {"neededPairs", figures.neededPairs},
                  {"unresolved", figures.unresolved},
                  {"skippedTriangles", figures.skippedTriangles},
                  {"skippedDraws", figures.skippedDraws},
                  {"omitted", model.omitted},
                  {"notes", model.notes},
                  {"gpu_ms_median", figures.times.median},
                  {"passes", figures.times.passesByName()}};
  if (figures.motion) outcome.json["motion"] = figures.motion->json();
  if (figures.walk) outcome.json["walk"] = figures.walk->json();
  if (figures.atlas) outcome.json["atlas"] = jsonOf(options, *figures.atlas);
  return outcome;
}

Outcome visibility(const VisibilityOptions& options, const CommonOptions& common) {
  const Cell cell(options.cell);
  if (options.needlessSamples)
    std::fprintf(stderr, "gpgp visibility: note: --samples changes nothing here; the exact method decides at points of "
                         "each triangle's own\n");
  Model model;
  Bounds bounds;
  const auto read = [&](const glm::dvec3& origin) {
    const Progress progress("reading " + options.model);
    model = loadModel(options.model, origin);
    bounds = boundsOf(model);
  };
  read(glm::dvec3(0));
  if (const glm::dvec3 origin = originFor(bounds); origin != glm::dvec3(0)) read(origin);
  if (options.twoSided)
    for (GpgpVisibilityDraw& draw : model.draws) draw.flags |= GPGP_DRAW_TWO_SIDED;
  Session session(common);
  if (options.grid.width * options.grid.height > 1) {
    repeatInGrid(model, options.grid.width, options.grid.height, bounds.high - bounds.low,
                 session.device().properties().limits.maxStorageBufferRange);
    bounds = boundsOf(model);
  }
  const bool paints =
      !options.image.empty() || !options.overlay.empty() || !options.out.empty() || !options.display.empty();
  const std::vector<glm::vec3> corners = paints ? worldCorners(model) : std::vector<glm::vec3>();
  const Figures figures = measure(session, options, cell, model, bounds, corners);
  if (!options.exportIds.empty()) writeIds(options.exportIds, figures.found, model.triangleCount);
  const Progress painting("painting");
  if (!options.image.empty()) paintSeen(options, corners, viewOf(options, model, bounds, 0), bounds, figures.first);
  session.checkValidation();
  return outcomeOf(options, model, figures, session.device().name());
}
} // namespace

Work addVisibility(CLI::App& app) {
  auto options = std::make_shared<VisibilityOptions>();
  CLI::App* command = app.add_subcommand("visibility", "Sample which triangles of a model a camera sees");
  addVisibilityOptions(*command, *options);
  return [options](const CommonOptions& common) { return visibility(*options, common); };
}

} // namespace gpgp::cli
