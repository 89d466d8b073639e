// `gpgp visibility`: samples which triangles of a model one camera sees.
#include "cli/model.h"
#include "cli/painter.h"
#include "cli/progress.h"
#include "cli/session.h"
#include "host/files.h"

#include <gpgp/visibility.h>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace gpgp::cli {
namespace {

struct VisibilityOptions {
  std::string model, image, overlay, exportIds, camera, method = "standard", cell;
  Size size{1280, 720}, grid{1, 1};
  float yaw = 35, pitch = 20, distance = 2;
  uint32_t repeat = 1, orbit = 0, samples = 1, truth = 0, recheck = 256, refinements = 0;
  uint32_t heuristics = GPGP_HEURISTICS_THESIS;
  float epsilonStatic = 0.05f, epsilonDynamic = 0.05f, resolution = 1;
  bool twoSided = false;
};

/// Copies of a model side by side, their boxes a tenth apart, numbered one after the other.
void repeatInGrid(Model& model, Size grid, const Bounds& bounds) {
  const glm::vec3 step = (bounds.high - bounds.low) * 1.1f;
  const std::vector<GpgpVisibilityDraw> one = std::move(model.draws);
  const uint32_t triangles = model.triangleCount;
  if (uint64_t{triangles} * grid.width * grid.height > 1u << 30) throw Failure("--grid: more than 2^30 triangles");
  model.draws.clear();
  model.triangleCount = 0;
  for (uint32_t z = 0; z < grid.height; ++z)
    for (uint32_t x = 0; x < grid.width; ++x, model.triangleCount += triangles)
      for (GpgpVisibilityDraw draw : one) {
        draw.transform[3] += step.x * static_cast<float>(x);
        draw.transform[11] += step.z * static_cast<float>(z);
        draw.firstTriangle += model.triangleCount;
        model.draws.push_back(draw);
      }
}

struct View {
  glm::mat4 camera{1.0f};
  bool reversed = false;
};

/// Camera k of n on a circle 20 degrees above the horizon, 60 degrees of vertical field of view, `distance` radii of
/// the bounding sphere away.
glm::mat4 orbitCamera(const Bounds& bounds, uint32_t k, uint32_t n, float distance, Size size) {
  const float turn = glm::radians(360.0f) * static_cast<float>(k) / static_cast<float>(n), rise = glm::radians(20.0f);
  const float radius = std::max(glm::length(bounds.high - bounds.low) * 0.5f, 1e-6f);
  const glm::vec3 back(std::cos(rise) * std::sin(turn), std::sin(rise), std::cos(rise) * std::cos(turn));
  const glm::mat4 view = glm::lookAtRH(bounds.centre() + back * (distance * radius), bounds.centre(), {0, 1, 0});
  glm::mat4 projection =
      glm::perspectiveRH_ZO(glm::radians(60.0f), static_cast<float>(size.width) / static_cast<float>(size.height),
                            std::max(distance - 1.2f, 0.01f) * radius, (distance + 1.2f) * radius);
  projection[1][1] *= -1;
  return projection * view;
}

/// "ABS,DYN"
void parseEpsilon(const std::string& text, VisibilityOptions& options) {
  char rest = 0;
  float values[2];
  if (std::sscanf(text.c_str(), "%f,%f%c", &values[0], &values[1], &rest) != 2 || !(values[0] >= 0 && values[1] >= 0) ||
      !(values[0] < 1e30f && values[1] < 1e30f))
    throw CLI::ValidationError("--epsilon", "'" + text + "' is not ABS,DYN, two numbers from 0 on");
  options.epsilonStatic = values[0];
  options.epsilonDynamic = values[1];
}

/// Names of heuristics, or "none".
uint32_t parseHeuristics(const std::string& text) {
  uint32_t heuristics = 0;
  std::istringstream names(text);
  for (std::string name; std::getline(names, name, ',');) {
    if (name == "in-circle")
      heuristics |= GPGP_HEURISTIC_IN_CIRCLE;
    else if (name == "depth")
      heuristics |= GPGP_HEURISTIC_DEPTH;
    else if (name == "front")
      heuristics |= GPGP_HEURISTIC_DEPTH | GPGP_HEURISTIC_KEEP_FRONT;
    else if (name != "none")
      throw CLI::ValidationError("--heuristics", "'" + name + "' is none of in-circle, depth, front, none");
  }
  return heuristics;
}

/// A view cell, but for its camera: COLUMNSxROWS[/SKIP] in pixels, or RADIUS:POINTS in world units.
struct Cell {
  GpgpViewCellInfo info = GPGP_VIEW_CELL_INFO_INIT;
  std::vector<float> points;

  explicit Cell(const std::string& spec) {
    uint32_t columns = 0, rows = 0, skip = 1, count = 0;
    float radius = 0;
    char rest = 0;
    if (std::sscanf(spec.c_str(), "%ux%u/%u%c", &columns, &rows, &skip, &rest) == 3 ||
        (skip = 1, std::sscanf(spec.c_str(), "%ux%u%c", &columns, &rows, &rest) == 2)) {
      if (columns < 1 || rows < 1 || columns > 64 || rows > 64 || skip < 1)
        throw Usage("--cell: 1x1 to 64x64, and a skip of at least 1");
      info.columns = columns;
      info.rows = rows;
      info.skip = skip;
    } else if (std::sscanf(spec.c_str(), "%f:%u%c", &radius, &count, &rest) == 2 && radius > 0 && count > 0 &&
               count <= 4096) {
      // Corners of a square round the middle, then of its inside: a grid as square as the number allows.
      const auto side = static_cast<uint32_t>(std::ceil(std::sqrt(static_cast<float>(count))));
      for (uint32_t i = 0; i < count && side > 1; ++i) {
        const float x = static_cast<float>(i % side) / static_cast<float>(side - 1) * 2 - 1;
        const float y = static_cast<float>(i / side) / static_cast<float>(side - 1) * 2 - 1;
        if (x != 0 || y != 0) points.insert(points.end(), {x * radius, y * radius, 0});
      }
    } else if (!spec.empty()) {
      throw Usage("--cell: '" + spec + "' is neither COLUMNSxROWS[/SKIP] in pixels nor RADIUS:POINTS in world units");
    }
  }
};

/// 16 numbers, column-major, world to clip; a 17th that is not 0: near is 1.
View readCamera(const std::string& file) {
  std::istringstream text(host::readText(file));
  View view;
  for (int i = 0; i < 16; ++i)
    if (!(text >> view.camera[i / 4][i % 4]))
      throw Failure(file + ": number " + std::to_string(i + 1) + " of 16 is missing");
  float reversed = 0;
  if (text >> reversed) view.reversed = reversed != 0;
  return view;
}

/// The views of a cell; one of its pixels is one of the picture's where `centre` lies.
std::vector<View> viewsOf(const Cell& cell, const View& view, const glm::vec3& centre, uint32_t height) {
  GpgpViewCellInfo info = cell.info;
  std::copy_n(glm::value_ptr(view.camera), 16, info.camera.viewProjection);
  info.camera.reversedDepth = view.reversed;
  info.height = height;
  const glm::mat4& m = view.camera;
  info.distance = m[0][3] * centre.x + m[1][3] * centre.y + m[2][3] * centre.z + m[3][3];
  info.points = cell.points.data();
  info.pointCount = static_cast<uint32_t>(cell.points.size() / 3);
  uint32_t count = 0;
  GpgpResult result = gpgpGetViewCellCameras(&info, &count, nullptr);
  std::vector<GpgpCamera> cameras(count);
  if (result == GPGP_SUCCESS) result = gpgpGetViewCellCameras(&info, &count, cameras.data());
  if (result != GPGP_SUCCESS) throw Failure("no view cell can be made of this camera: it looks away from the scene");
  std::vector<View> views;
  for (const GpgpCamera& camera : cameras) views.push_back({glm::make_mat4(camera.viewProjection), view.reversed});
  return views;
}

/// World-space corners of each triangle in its number's order.
std::vector<glm::vec3> worldCorners(const Model& model) {
  std::vector<glm::vec3> corners;
  corners.reserve(size_t{model.triangleCount} * 3);
  for (const GpgpVisibilityDraw& draw : model.draws) {
    const GpgpMesh& mesh = model.meshes[draw.mesh];
    for (uint32_t i = 0; i < mesh.indexCount; ++i) {
      const float* p = &model.positions[(size_t{mesh.vertexOffset} + model.indices[mesh.firstIndex + i]) * 3];
      const float* m = draw.transform;
      corners.emplace_back(m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3],
                           m[4] * p[0] + m[5] * p[1] + m[6] * p[2] + m[7],
                           m[8] * p[0] + m[9] * p[1] + m[10] * p[2] + m[11]);
    }
  }
  return corners;
}

/// What the camera saw, from the camera and from the side: seen triangles orange, all others grey.
void paint(const VisibilityOptions& options, const std::vector<glm::vec3>& corners, const Bounds& bounds,
           const std::vector<uint32_t>& bits) {
  const uint32_t width = options.size.width, height = options.size.height;
  host::Picture both{width * 2, height, std::vector<uint8_t>(size_t{width} * height * 8)};
  for (uint32_t side = 0; side < 2; ++side) {
    const glm::mat4 camera =
        viewAll(bounds, options.yaw + 110.0f * static_cast<float>(side), options.pitch, width, height);
    Painter painter(width, height);
    for (size_t t = 0; t < corners.size() / 3; ++t) {
      const bool seen = bits[t / 32] >> t % 32 & 1u;
      painter.triangle(camera, std::span<const glm::vec3, 3>(&corners[t * 3], 3),
                       seen ? glm::vec3(0.95f, 0.55f, 0.15f) : glm::vec3(0.62f));
    }
    const host::Picture half = painter.picture();
    for (uint32_t y = 0; y < height; ++y)
      std::copy_n(&half.rgba[size_t{y} * width * 4], width * 4, &both.rgba[(size_t{y} * 2 + side) * width * 4]);
  }
  host::writePng(options.image, both);
}

uint32_t countOf(const std::vector<uint32_t>& bits) {
  uint32_t count = 0;
  for (const uint32_t word : bits) count += static_cast<uint32_t>(std::popcount(word));
  return count;
}
bool isSet(const std::vector<uint32_t>& bits, size_t i) { return bits[i / 32] >> i % 32 & 1u; }

/// A model on the device, and what samples it.
class Scene {
public:
  Scene(Session& session, const VisibilityOptions& options, const Model& model)
      : session_(session), options_(options), model_(model), words_((model.triangleCount + 31) / 32) {
    GpgpGeometrySetCreateInfo info = GPGP_GEOMETRY_SET_CREATE_INFO_INIT;
    info.label = options.model.c_str();
    info.meshes = model.meshes.data();
    info.meshCount = static_cast<uint32_t>(model.meshes.size());
    geometry_ = session.take(GeometrySet::create(session.context(), info), "gpgpCreateGeometrySet");
    session.upload();
    host::HeadlessDevice& device = session.device();
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    positions_ = host::makeBuffer(device, model.positions, kStorage, "positions");
    indices_ = host::makeBuffer(device, model.indices, kStorage, "indices");
    draws_ = host::makeBuffer(device, model.draws, kStorage, "draws");
    bits_ = host::Buffer(device, VkDeviceSize{words_} * 4, kStorage, host::Memory::device, "visible bits");
    sizes_ =
        host::Buffer(device, VkDeviceSize{model.triangleCount} * 4, kStorage, host::Memory::device, "pixel counts");
    list_ = host::Buffer(device, VkDeviceSize{model.triangleCount} * 4, kStorage, host::Memory::device, "visible list");
    count_ = host::Buffer(device, 16, kStorage, host::Memory::device, "visible count");
  }

  Sampler sampler(GpgpSamplingMethod method, uint32_t maxSamples) {
    GpgpSamplerCreateInfo info = GPGP_SAMPLER_CREATE_INFO_INIT;
    info.base = session_.workerInfo("sampler");
    info.maxWidth = options_.size.width;
    info.maxHeight = options_.size.height;
    info.maxDraws = static_cast<uint32_t>(model_.draws.size());
    info.maxTriangles = model_.triangleCount;
    info.methods = 1u << method;
    info.maxSamples = maxSamples;
    const uint64_t range = session_.device().properties().limits.maxStorageBufferRange;
    info.maxCandidates =
        static_cast<uint32_t>(std::min<uint64_t>({std::max(model_.triangleCount, 65536u), 1u << 24, range / 80}));
    info.maxPairs = static_cast<uint32_t>(
        std::min<uint64_t>(uint64_t{info.maxWidth} * info.maxHeight * 24 + (1u << 20), range / 20));
    Sampler made = session_.take(Sampler::create(session_.context(), info), "gpgpCreateSampler");
    session_.check(made.prewarm(), "gpgpPrewarm");
    return made;
  }

  struct Step {
    GpgpSamplingMethod method = GPGP_SAMPLING_STANDARD;
    View view;
    uint32_t samples = 0, slice = 0, repeat = 1;
    bool accumulate = false, sizes = false;
    const char* label = "sampling";
  };
  auto sample(Sampler& sampler, const Step& step) {
    const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT,
                           VK_IMAGE_LAYOUT_UNDEFINED};
    return session_.measure(sampler, step.label, step.repeat,
                            [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordInfo& base) {
                              GpgpSampleInfo info = GPGP_SAMPLE_INFO_INIT;
                              info.base = base;
                              info.geometrySet = geometry_;
                              info.method = step.method;
                              std::copy_n(glm::value_ptr(step.view.camera), 16, info.camera.viewProjection);
                              info.camera.reversedDepth = step.view.reversed;
                              info.width = options_.size.width;
                              info.height = options_.size.height;
                              info.samples = step.samples;
                              info.slice = step.slice;
                              info.accumulate = step.accumulate;
                              if (step.method == GPGP_SAMPLING_CONSERVATIVE) {
                                info.resolution = options_.resolution;
                                info.heuristics = options_.heuristics;
                                info.epsilonStatic = options_.epsilonStatic;
                                info.epsilonDynamic = options_.epsilonDynamic;
                                info.refinements = options_.refinements;
                              }
                              info.positions = positions_.range();
                              info.positionStride = 12;
                              info.indices = indices_.range();
                              info.indexType = VK_INDEX_TYPE_UINT32;
                              info.draws = draws_.range();
                              info.drawCount = static_cast<uint32_t>(model_.draws.size());
                              info.triangleCount = model_.triangleCount;
                              info.visibleBits = bits_.range({}, after);
                              if (step.sizes) info.pixelCounts = sizes_.range({}, after);
                              info.visibleList = list_.range({}, after);
                              info.visibleCount = count_.range({}, after);
                              return sampler.recordPrepare(commands, frame, info);
                            });
  }
  std::vector<uint32_t> bits() { return host::download<uint32_t>(session_.device(), bits_, words_); }
  std::vector<uint32_t> sizes() { return host::download<uint32_t>(session_.device(), sizes_, model_.triangleCount); }

  /// How far what was found agrees with a truth; recheck may be empty.
  auto measure(Sampler& sampler, const std::vector<uint32_t>& found, const std::vector<uint32_t>& truth,
               const std::vector<uint32_t>& areas, const std::vector<uint32_t>& recheck) {
    host::HeadlessDevice& device = session_.device();
    const auto copy = [&](const std::vector<uint32_t>& words, const char* name) {
      return words.empty() ? host::Buffer() : host::makeBuffer(device, words, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, name);
    };
    const host::Buffer foundBits = copy(found, "found"), truthBits = copy(truth, "truth");
    const host::Buffer truthCounts = copy(areas, "truth's counts"), recheckBits = copy(recheck, "recheck");
    return session_.measure(sampler, "metrics", 1,
                            [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordInfo& base) {
                              GpgpVisibilityMetricsInfo info = GPGP_VISIBILITY_METRICS_INFO_INIT;
                              info.base = base;
                              info.triangleCount = model_.triangleCount;
                              info.visibleBits = foundBits.range();
                              info.truthBits = truthBits.range();
                              info.truthCounts = truthCounts.range();
                              if (!recheck.empty()) info.recheckBits = recheckBits.range();
                              return sampler.recordPrepareMetrics(commands, frame, info);
                            });
  }

  /// The truth with samples x samples a pixel and the centre, for the union of views; sizes() has its areas afterwards.
  std::vector<uint32_t> truth(const std::vector<View>& views, uint32_t samples) {
    uint32_t perRecord = std::min(samples, 8u); // as many as the device binds
    const uint64_t range = session_.device().properties().limits.maxStorageBufferRange;
    while (perRecord > 1 && uint64_t{options_.size.width} * options_.size.height * perRecord * perRecord * 4 > range)
      perRecord /= 2;
    Sampler worker = sampler(GPGP_SAMPLING_TRUTH, perRecord);
    const uint32_t slices = samples / perRecord * (samples / perRecord) + 1;
    Progress progress("truth", slices * static_cast<uint32_t>(views.size()));
    bool first = true;
    for (const View& view : views)
      for (uint32_t slice = 0; slice < slices; ++slice, progress.advance()) {
        Step step;
        step.method = GPGP_SAMPLING_TRUTH;
        step.view = view;
        step.samples = samples;
        step.slice = slice;
        step.accumulate = !first;
        step.sizes = true;
        step.label = "slice";
        sample(worker, step);
        first = false;
      }
    return bits();
  }

private:
  Session& session_;
  const VisibilityOptions& options_;
  const Model& model_;
  uint32_t words_;
  GeometrySet geometry_;
  host::Buffer positions_, indices_, draws_, bits_, sizes_, list_, count_;
};

/// Figure 6.2: green standard, grey only what the method adds, red false positive, blue false negative.
void paintOverlay(const VisibilityOptions& options, const std::vector<glm::vec3>& corners, const glm::mat4& camera,
                  const std::vector<uint32_t>& found, const std::vector<uint32_t>& standard,
                  const std::vector<uint32_t>& truth) {
  Painter painter(options.size.width, options.size.height);
  for (size_t t = 0; t < corners.size() / 3; ++t) {
    const bool isFound = isSet(found, t), isTrue = truth.empty() ? isFound : isSet(truth, t);
    if (!isFound && !isTrue) continue;
    glm::vec3 colour(0.6f);
    if (isFound && !isTrue)
      colour = {0.9f, 0.1f, 0.1f};
    else if (!isFound)
      colour = {0.1f, 0.2f, 0.95f};
    else if (isSet(standard, t))
      colour = {0.2f, 0.75f, 0.25f};
    painter.triangle(camera, std::span<const glm::vec3, 3>(&corners[t * 3], 3), colour);
  }
  host::writePng(options.overlay, painter.picture());
}

Outcome visibility(const VisibilityOptions& options, const CommonOptions& common) {
  if (options.method == "cell" && options.cell.empty()) throw Usage("--method cell needs --cell SPEC");
  const GpgpSamplingMethod method = options.method == "standard"       ? GPGP_SAMPLING_STANDARD
                                    : options.method == "conservative" ? GPGP_SAMPLING_CONSERVATIVE
                                                                       : GPGP_SAMPLING_EXACT;
  const Cell cell(options.cell);

  Model model = loadModel(options.model);
  if (options.twoSided)
    for (GpgpVisibilityDraw& draw : model.draws) draw.flags |= GPGP_DRAW_TWO_SIDED;
  Bounds bounds;
  for (const glm::vec3& corner : worldCorners(model)) bounds.add(corner);
  if (options.grid.width * options.grid.height > 1) {
    repeatInGrid(model, options.grid, bounds);
    bounds = Bounds();
    for (const glm::vec3& corner : worldCorners(model)) bounds.add(corner);
  }
  const bool paints = !options.image.empty() || !options.overlay.empty();
  const std::vector<glm::vec3> corners = paints ? worldCorners(model) : std::vector<glm::vec3>();

  Session session(common);
  host::HeadlessDevice& device = session.device();
  Scene scene(session, options, model);
  Sampler sampler = scene.sampler(method, method == GPGP_SAMPLING_STANDARD ? options.samples : 1);

  // Averages over the cameras.
  double truthCount = 0, visible = 0, coverage = 0, overestimation = 0, coverageArea = 0, overestimationArea = 0;
  std::vector<double> totals;
  std::vector<std::pair<std::string, double>> passes;
  GpgpSampleReport report{}, metrics{};
  GpuTimes times;
  std::vector<uint32_t> found;
  View view;
  const uint32_t cameras = std::max(options.orbit, 1u);
  for (uint32_t k = 0; k < cameras; ++k) {
    if (!options.camera.empty())
      view = readCamera(options.camera);
    else if (options.orbit)
      view = {orbitCamera(bounds, k, options.orbit, options.distance, options.size), false};
    else
      view = {viewAll(bounds, options.yaw, options.pitch, options.size.width, options.size.height), false};

    const std::vector<View> views = viewsOf(cell, view, bounds.centre(), options.size.height);

    double total = 0;
    for (size_t v = 0; v < views.size(); ++v) {
      Scene::Step step;
      step.method = method;
      step.view = views[v];
      step.samples = options.samples;
      step.repeat = options.repeat;
      step.accumulate = v > 0;
      auto measured = scene.sample(sampler, step);
      times = measured.times;
      report = measured.report;
      total += times.median();
      if (passes.size() < times.passes.size()) passes = {};
      for (size_t p = 0; p < times.passes.size(); ++p) {
        if (passes.size() <= p) passes.emplace_back(times.passes[p].first, 0.0);
        passes[p].second += times.passes[p].second / cameras;
      }
    }
    totals.push_back(total);
    found = scene.bits();
    visible += static_cast<double>(countOf(found)) / cameras;

    std::vector<uint32_t> standard, truth;
    if (!options.overlay.empty() && k == 0) {
      Sampler plain = scene.sampler(GPGP_SAMPLING_STANDARD, 1);
      Scene::Step step;
      step.view = view;
      scene.sample(plain, step);
      standard = scene.bits();
    }
    if (options.truth) {
      truth = scene.truth(views, options.truth);
      const std::vector<uint32_t> areas = scene.sizes();
      metrics = scene.measure(sampler, found, truth, areas, {}).report;
      if (metrics.falsePositives && options.recheck > options.truth)
        metrics = scene.measure(sampler, found, truth, areas, scene.truth(views, options.recheck)).report;
      truthCount += metrics.truth / static_cast<double>(cameras);
      // A camera that could see nothing has missed nothing.
      coverage += (metrics.truth ? static_cast<double>(metrics.coverage) : 1.0) / cameras;
      overestimation += static_cast<double>(metrics.overestimation) / cameras;
      coverageArea += (metrics.truth ? static_cast<double>(metrics.coverageArea) : 1.0) / cameras;
      overestimationArea += static_cast<double>(metrics.overestimationArea) / cameras;
    }
    if (!options.overlay.empty() && k == 0) paintOverlay(options, corners, view.camera, found, standard, truth);
  }
  std::sort(totals.begin(), totals.end());
  const double median = totals[totals.size() / 2];

  if (!options.exportIds.empty()) {
    std::vector<uint32_t> ids;
    for (size_t i = 0; i < model.triangleCount; ++i)
      if (isSet(found, i)) ids.push_back(static_cast<uint32_t>(i));
    std::ofstream file(options.exportIds, std::ios::binary);
    for (const uint32_t id : ids) {
      const std::array<char, 4> bytes{static_cast<char>(id), static_cast<char>(id >> 8), static_cast<char>(id >> 16),
                                      static_cast<char>(id >> 24)};
      file.write(bytes.data(), 4);
    }
    if (!file.flush()) throw Failure(options.exportIds + ": cannot be written");
  }
  if (!options.image.empty()) paint(options, corners, bounds, found);
  session.checkValidation();

  const double share = 100.0 * visible / model.triangleCount;
  Outcome outcome;
  std::ostringstream text;
  text.precision(4);
  text << options.model << ": " << model.triangleCount << " triangles in " << model.draws.size() << " draws\n"
       << visible << " visible (" << share << " %)";
  if (method == GPGP_SAMPLING_STANDARD)
    text << ", " << report.coveredPixels << " of " << uint64_t{options.size.width} * options.size.height
         << " pixels covered";
  text << "; GPU " << milliseconds(median) << " (median of " << times.totals.size() << ") on " << device.name() << '\n';
  if (options.truth)
    text << "truth " << truthCount << ": coverage " << 100 * coverage << " %, overestimation " << 100 * overestimation
         << " %; by area " << 100 * coverageArea << " %, " << 100 * overestimationArea << " %\n";
  if (report.listed < report.visible) text << "budget exceeded: " << report.visible - report.listed << " not listed\n";
  if (report.unresolved) text << "budget exceeded: " << report.unresolved << " without room count as visible\n";
  if (model.leftOut) text << model.leftOut << " primitives are no triangles and were left out\n";
  if (!options.image.empty())
    text << "picture: " << options.image << " (left: from the camera; right: from the side)\n";
  if (!options.overlay.empty())
    text << "overlay: " << options.overlay << " (green standard, grey added, red too much, blue missed)\n";
  outcome.text = text.str();
  const auto measured = [&](double value) { return options.truth ? Json(value) : Json(); };
  Json passTimes = Json::object();
  for (const auto& [name, time] : passes) passTimes[name] = time;
  outcome.json = {{"model", options.model},
                  {"device", device.name()},
                  {"status", statusName(report.base.status)},
                  {"method", options.method},
                  {"width", options.size.width},
                  {"height", options.size.height},
                  {"draws", model.draws.size()},
                  {"triangles", model.triangleCount},
                  {"facing", report.triangles},
                  {"visible", std::llround(visible)},
                  {"listed", report.listed},
                  {"coveredPixels", report.coveredPixels},
                  {"gpuMilliseconds", times.json()},
                  {"image", options.image.empty() ? Json() : Json(options.image)},
                  {"cameras", cameras},
                  {"truth", options.truth ? Json(std::llround(truthCount)) : Json()},
                  {"coverage", measured(coverage)},
                  {"overestimation", measured(overestimation)},
                  {"coverage_area", measured(coverageArea)},
                  {"overestimation_area", measured(overestimationArea)},
                  {"neededCandidates", report.neededCandidates},
                  {"neededPairs", report.neededPairs},
                  {"unresolved", report.unresolved},
                  {"gpu_ms_median", median},
                  {"passes", passTimes}};
  return outcome;
}

} // namespace

Work addVisibility(CLI::App& app) {
  auto options = std::make_shared<VisibilityOptions>();
  CLI::App* command = app.add_subcommand("visibility", "Sample which triangles of a model a camera sees");
  command->add_option("MODEL", options->model, "glTF 2 (.glb, .gltf) or Wavefront (.obj)")
      ->required()
      ->check(CLI::ExistingFile);
  addSize(*command, "--size", options->size, "Viewport in pixels (default 1280x720)");
  command->add_option("--yaw", options->yaw, "Degrees around the model")->capture_default_str();
  command->add_option("--pitch", options->pitch, "Degrees above the horizon")
      ->check(CLI::Range(-89.0f, 89.0f))
      ->capture_default_str();
  command->add_flag("--two-sided", options->twoSided, "Back faces count as well");
  command
      ->add_option_function<std::string>(
          "--grid", [options](const std::string& text) { options->grid = parseSize(text); },
          "NxM copies of the model side by side")
      ->type_name("NxM");
  command
      ->add_option("--orbit", options->orbit,
                   "N cameras on a circle 20 degrees above the horizon; results are averages")
      ->check(CLI::Range(1u, 4096u));
  command->add_option("--distance", options->distance, "Of the orbit's cameras, in radii of the bounding sphere")
      ->check(CLI::Range(0.01f, 1e6f))
      ->capture_default_str();
  command->add_option("--camera", options->camera, "16 numbers, world to clip, column-major; a 17th not 0: near is 1")
      ->check(CLI::ExistingFile);
  command->add_option("--method", options->method, "standard, conservative, exact or cell (exact over a view cell)")
      ->check(CLI::IsMember({"standard", "conservative", "exact", "cell"}))
      ->capture_default_str();
  command
      ->add_option_function<std::string>(
          "--epsilon", [options](const std::string& text) { parseEpsilon(text, *options); },
          "Conservative: static and dynamic epsilon, in units along the view (default 0.05,0.05)")
      ->type_name("ABS,DYN");
  command
      ->add_option_function<std::string>(
          "--heuristics", [options](const std::string& text) { options->heuristics = parseHeuristics(text); },
          "Conservative: of in-circle, depth, front (depth, but what lies in front is kept), none (default "
          "in-circle,depth)")
      ->type_name("LIST");
  command->add_option("--resolution", options->resolution, "Conservative: factor of the viewport's size")
      ->check(CLI::Range(0.25f, 1.0f))
      ->capture_default_str();
  command->add_option("--refinements", options->refinements, "Conservative: at most N passes that close gaps")
      ->check(CLI::Range(0u, 4u))
      ->capture_default_str();
  command->add_option("--samples", options->samples, "Standard: N x N samples a pixel")
      ->check(CLI::IsMember({1u, 2u, 4u, 8u}))
      ->capture_default_str();
  command->add_option("--cell", options->cell,
                      "View cell: COLUMNSxROWS[/SKIP] in pixels, or RADIUS:POINTS in world units");
  command->add_option("--truth", options->truth, "Measure against N x N + 1 samples a pixel")
      ->check(CLI::IsMember({1u, 2u, 4u, 8u, 16u, 32u, 64u, 128u, 256u}));
  command->add_option("--recheck", options->recheck, "Sample claimed false positives again at N x N; 0: do not")
      ->check(CLI::IsMember({0u, 64u, 128u, 256u}))
      ->capture_default_str();
  command
      ->add_option("--overlay", options->overlay, "Green standard, grey added by the method, red too much, blue missed")
      ->type_name("FILE.png");
  command->add_option("--export-ids", options->exportIds, "Visible triangles as little-endian uint32")
      ->type_name("FILE");
  command->add_option("--repeat", options->repeat, "Sample N times and report the median time")
      ->check(CLI::Range(1u, 100000u))
      ->capture_default_str();
  command->add_option("--image", options->image, "Write a picture: the camera's view, and the same from the side")
      ->type_name("FILE.png");
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
