// What each sampling method finds and costs, on the measured scenes: coverage and overestimation against the reference
// made in the same run, GPU time by timestamps, and the ratio to standard sampling (the baseline).
//
// As a test it runs on small ones. Asserts nothing about time, but fails where exact
// sampling shows over 1.5 % that the reference does not hold, or a budget is exceeded.
#include "../visibility/ray_scene_of.h"
#include "arguments.h"
#include "spawned_scenes.h"
#include "visibility_figures.h"
#include "visibility_steady.h"

#include "cli/model/model.h"
#include "cli/shared/processors.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <tuple>

namespace {
using namespace gpgp;
using namespace gpgp::test;

struct Options {
  uint32_t width = 160, height = 90, reference = 64, recheck = 0;
  bool rays = false; ///< the reference is theirs
  bool clusters = false, newClusters = false, order = false;
  bool passes = false, exactOnly = false, figures = false, tables = false, views = false, walk = false;
  FigureOptions figure;
  SteadyWalk steady;
  uint32_t crop[4] = {}; ///< width, height, left, top
  std::string out = ".";
  std::vector<std::string> scenes, plots;
};

/// A model from a file, as `gpgp visibility --orbit 8 --distance 2` sees it first.
Scene loadScene(const std::string& file, uint32_t width, uint32_t height) {
  const cli::Model model = cli::loadModel(file);
  Scene scene;
  scene.positions = model.positions;
  scene.indices = model.indices;
  scene.params.triangleCount = model.triangleCount;
  scene.params.positionStride = 12;
  for (const GpgpMesh& mesh : model.meshes)
    scene.meshes.push_back({mesh.firstIndex, mesh.indexCount, mesh.vertexOffset});
  for (const GpgpVisibilityDraw& draw : model.draws) {
    shader::Draw& copy = scene.draws.emplace_back();
    std::copy_n(draw.transform, 12, copy.transform);
    copy.mesh = draw.mesh;
    copy.firstTriangle = draw.firstTriangle;
    copy.flags = draw.flags;
  }
  setOrbitCamera(scene, 1, 8, 2.0f, width, height);
  return scene;
}

/// A scene with a camera that makes it hard.
Scene makeScene(const std::string& name, uint32_t width, uint32_t height) {
  Scene scene;
  if (name == "bunnies") {
    scene = bunnyGrid(6, 6);
    setOrbitCamera(scene, 1, 8, 2.5f, width, height);
  } else if (name == "colonnade") {
    scene = colonnadeWithWires(1.5f);
    setWalkingCamera(scene, {0.3f, 1.7f, 3}, {0, 1.5f, -10}, width, height, true);
  } else if (name == "foliage") {
    scene = foliage(60000);
    setWalkingCamera(scene, {1, 1.7f, 7}, {0, 1.5f, 0}, width, height, true);
  } else if (name == "city" || name == "bigcity") {
    scene = city(name == "city" ? 20 : 80);
    setOrbitCamera(scene, 1, 8, 1.0f, width, height, true);
  } else if (name == "street" || name == "bigstreet") {
    scene = city(name == "street" ? 20 : 80);
    setWalkingCamera(scene, {30, 1.7f, 30}, {100, 5, 100}, width, height, true);
  } else if (name == "small-colonnade") {
    scene = colonnadeWithWires(0.4f);
    setWalkingCamera(scene, {0.3f, 1.7f, 3}, {0, 1.5f, -10}, width, height, true);
  } else if (name == "small-foliage") {
    scene = foliage(4000);
    setWalkingCamera(scene, {1, 1.7f, 7}, {0, 1.5f, 0}, width, height, true);
  } else if (name == "small-city") {
    scene = city(6);
    setWalkingCamera(scene, {30, 1.7f, 30}, {60, 5, 60}, width, height, true);
#ifdef GPGP_BENCH_SPAWNED
  } else if (name == "spawned-city" || name.rfind("spawned-city:", 0) == 0) {
    const int lots = name.size() > 13 ? std::atoi(&name[13]) : 200;
    scene = bench::spawnedCity(static_cast<uint32_t>(std::max(1, lots)));
    setOrbitCamera(scene, 1, 8, 1.0f, width, height, true);
  } else if (name == "mini-engine") {
    scene = bench::miniEngineLevel(width, height);
#endif
  } else if (std::filesystem::is_regular_file(name)) {
    return loadScene(name, width, height);
  } else {
    std::fprintf(stderr, "there is no scene '%s'\n", name.c_str());
    std::exit(2);
  }
  return scene;
}

/// The scene's meshes as an engine may build them (gpgpOrderTriangles).
void orderTriangles(Scene& scene) {
  for (const shader::Mesh& mesh : scene.meshes) {
    const std::vector<uint32_t> indices(scene.indices.begin() + mesh.firstIndex,
                                        scene.indices.begin() + mesh.firstIndex + mesh.indexCount);
    std::vector<uint32_t> order(indices.size() / 3);
    const uint32_t floats = scene.params.positionStride ? scene.params.positionStride / 4 : 3;
    const float* positions = scene.positions.data() + size_t(mesh.vertexOffset) * floats;
    const size_t vertices = scene.positions.size() / floats - mesh.vertexOffset;
    expect(gpgpOrderTriangles(positions, floats * 4, static_cast<uint32_t>(vertices), indices.data(), mesh.indexCount,
                              order.data()),
           "order");
    for (size_t i = 0; i < order.size(); ++i)
      std::copy_n(&indices[size_t(order[i]) * 3], 3, &scene.indices[mesh.firstIndex + i * 3]);
  }
}

bool benchScene(Runner& runner, const Scene& scene, const std::string& name, const Options& options) {
  const std::span<const GpgpCamera> camera(&runner.camera(), 1);
  host::Buffer reference = runner.makeBits(), recheck = runner.makeBits(), counts = runner.makeCounts();
  if (options.rays && options.reference) {
    const RaySceneOf asRays(scene);
    const auto cast = [&](uint32_t samples) {
      return rayReference(asRays, scene, samples,
                          [](size_t count, const auto& work) { cli::onAllProcessors(count, work); });
    };
    const visibility::RayReference rays = cast(options.reference);
    reference = runner.copy(rays.bits());
    counts = runner.copy(rays.areas());
    if (options.recheck) recheck = runner.copy(cast(options.recheck).bits());
  } else if (options.reference) {
    runner.reference(options.reference, camera, reference, &counts);
    if (options.recheck) runner.reference(options.recheck, camera, recheck);
  }
  VisibilityRecorder standard = runner.recorder(GPGP_SAMPLING_STANDARD_BIT, 1);
  std::printf("%s: %u triangles", name.c_str(), runner.triangles());
  if (options.reference)
    std::printf(", %u visible at %u x %u + 1 %s",
                runner.metrics(standard, reference, reference, nullptr, nullptr).reference, options.reference,
                options.reference, options.rays ? "rays" : "samples");
  std::printf("\n  %-16s %9s %9s %9s %9s %9s %7s %10s %10s %10s\n", "method", "visible", "cov %", "cov area", "over %",
              "ms", "ratio", "candidates", "pairs", "unresolved");
  double baseline = 0;
  bool good = true;
  const auto bench = [&](const std::string& method, VisibilityRecorder& recorder, const Sampling& sampling) {
    const Runner::Run run = runner.measure(recorder, sampling, options.figure.repeat);
    GpgpVisibilityReport m{};
    if (options.reference)
      m = runner.metrics(recorder, runner.bits(), reference, &counts, options.recheck ? &recheck : nullptr);
    if (baseline == 0) baseline = run.milliseconds;
    const auto percent = [](float share) { return 100 * static_cast<double>(share); };
    std::printf("  %-16s %9u %9.3f %9.4f %9.3f %9.4f %7.2f %10u %10u %10u%s\n", method.c_str(), run.report.visible,
                percent(m.coverage), percent(m.coverageArea), percent(m.overestimation), run.milliseconds,
                run.milliseconds / baseline, run.report.neededCandidates, run.report.neededPairs, run.report.unresolved,
                run.report.base.status == GPGP_SUCCESS ? "" : " BUDGET");
    if (options.passes)
      for (const auto& [pass, time] : run.passes)
        if (time > 0.002) std::printf("      %-16s %9.4f\n", pass.c_str(), time);
    good =
        good && run.report.base.status == GPGP_SUCCESS &&
        (options.reference < 64 || sampling.heuristics || m.overestimation <= 0.015f); // coarser references miss more
  };
  bench("standard", standard, {});
  VisibilityRecorder exact = runner.recorder(GPGP_SAMPLING_EXACT_BIT, 1);
  bench("exact", exact, {.method = GPGP_SAMPLING_EXACT});
  if (options.exactOnly) return good;
  // The thesis's method, with the epsilons that others were measured with.
  VisibilityRecorder recorder = runner.recorder(GPGP_SAMPLING_CONSERVATIVE_BIT, 1);
  constexpr uint32_t kFront = GPGP_HEURISTICS_DEFAULT | GPGP_HEURISTIC_KEEP_FRONT;
  for (const auto& [what, heuristics, epsilon, refinements] :
       {std::tuple("thesis 0.05", GPGP_HEURISTICS_DEFAULT, 0.05f, 0u),
        {"thesis 2", GPGP_HEURISTICS_DEFAULT, 2.0f, 0u},
        {"front 0.05", kFront, 0.05f, 0u},
        {"thesis 0.05, 2", GPGP_HEURISTICS_DEFAULT, 0.05f, 2u},
        {"thesis 0.05, 4", GPGP_HEURISTICS_DEFAULT, 0.05f, 4u}})
    bench(what, recorder,
          {.method = GPGP_SAMPLING_CONSERVATIVE,
           .heuristics = heuristics,
           .refinements = refinements,
           .epsilonStatic = epsilon,
           .epsilonDynamic = epsilon});
  return good;
}

/// 1, 2, 4 and 8 view points up to half a metre from the camera, in one record and in one each.
void benchViews(Runner& runner, const std::string& name, uint32_t repeat) {
  constexpr uint32_t kViews = 8;
  std::vector<float> points;
  for (uint32_t i = 1; i < kViews; ++i)
    points.insert(points.end(), {i & 1 ? 0.5f : 0.0f, i & 2 ? 0.5f : 0.0f, i & 4 ? 0.5f : 0.0f});
  GpgpViewCellInfo info = GPGP_VIEW_CELL_INFO_INIT;
  info.camera = runner.camera();
  info.points = points.data();
  info.pointCount = kViews - 1;
  std::vector<GpgpCamera> cameras(kViews);
  uint32_t count = kViews;
  expect(gpgpGetViewCellCameras(&info, &count, cameras.data()), "view cell");
  std::printf("%s: %u triangles\n  %-10s %5s %10s %12s %7s\n", name.c_str(), runner.triangles(), "method", "views",
              "one record", "a record each", "ratio");
  for (const auto& [method, what] : {std::pair(GPGP_SAMPLING_STANDARD, "standard"), {GPGP_SAMPLING_EXACT, "exact"}}) {
    VisibilityRecorder united = runner.recorder(1u << method, 1, kViews), single = runner.recorder(1u << method, 1);
    double each = 0;
    for (uint32_t n = 1, views = 0; n <= kViews; n *= 2) {
      for (; views < n; ++views)
        each += runner.measure(single, {.method = method}, repeat, {&cameras[views], 1}).milliseconds;
      const double one = runner.measure(united, {.method = method}, repeat, std::span(cameras).first(n)).milliseconds;
      std::printf("  %-10s %5u %10.3f %12.3f %7.2f\n", what, n, one, each, one / each);
    }
  }
}
} // namespace

const char* const kUsage =
    "visibility_bench [--size WxH] [--crop WxH+X+Y] [--repeat N] [--reference N] [--recheck N] [--rays] "
    "[--passes] [--exact] [--order] [--clusters] [SCENE]...\n"
    "  --rays   the reference is of rays in double precision on the processor, which snap nothing\n"
    "  --crop   a window of that picture, whose pixels are as small as the picture's\n"
    "  --exact  without the thesis's method\n"
    "  --order, --clusters, --new-clusters\n"
    "           triangles in an order for clusters; clusters that are out of sight are left out;\n"
    "           and clusters are made by each record\n"
    "visibility_bench --figures [--grid N] [--cell N] [--tables] [...]\n"
    "  the thesis's figures 6.9 to 6.14 and table 6.1 as numbers (and the above)\n"
    "visibility_bench --walk [--cell N] [--passes] [--small DIVISOR/VIEWS/REACH/MOST]... [...]\n"
    "  the cell of a walking viewer alone; a --cell of 32 or more: 17 x 17 view points\n"
    "  --small  views of a part of the width and height; metres; triangles of all views together, or 0\n"
    "visibility_bench --steady FRAMES/UNITS/DEGREES/MAXLATE [...]\n"
    "  a walk of so many frames with so many units and degrees in each: exact sampling that takes over decisions of\n"
    "  the previous frame, as 60/0.025/0/0.005 does, beside exact and standard sampling of the same frames\n"
    "visibility_bench --views [...]\n"
    "  what a record of several view points of a cell costs against a record for each\n"
    "visibility_bench --plot FILE... --out FOLDER\n"
    "  what runs with --figures printed, as SVG pictures\n"
    "SCENE: bunnies colonnade foliage city street bigcity bigstreet, small-colonnade "
    "small-foliage small-city, what gpgp\n"
    "spawn derives where it is built in: spawned-city[:LOTS] (200 lots; 50 000 are 10 million "
    "triangles) and mini-engine;\n"
    "or a .glb, .gltf or .obj file.\n";

int runBench(bench::Arguments arguments) {
  Options options;
  bool plots = false;
  while (arguments.next()) {
    const std::string& arg = arguments.word();
    const auto scan = [&](const char* format, const char* sample, auto*... numbers) {
      const std::string value = arguments.value();
      char rest = 0;
      if (std::sscanf(value.c_str(), format, numbers..., &rest) != int{sizeof...(numbers)})
        throw bench::Usage(arg + ": '" + value + "' is not like " + sample);
    };
    if (arg == "--size") {
      scan("%ux%u%c", "640x360", &options.width, &options.height);
    } else if (arg == "--crop") {
      uint32_t* c = options.crop;
      scan("%ux%u+%u+%u%c", "64x48+100+80", &c[0], &c[1], &c[2], &c[3]);
    } else if (arg == "--repeat") {
      options.figure.repeat = arguments.number();
    } else if (arg == "--reference") {
      options.reference = arguments.number(0);
    } else if (arg == "--rays") {
      options.rays = true;
    } else if (arg == "--recheck") {
      options.recheck = arguments.number(0);
    } else if (arg == "--grid") {
      options.figure.largestGrid = arguments.number(0);
    } else if (arg == "--cell") {
      options.figure.largestCell = arguments.number(0);
    } else if (arg == "--out") {
      options.out = arguments.value();
    } else if (arg == "--passes") {
      options.passes = true;
    } else if (arg == "--exact") {
      options.exactOnly = true;
    } else if (arg == "--clusters") {
      options.clusters = true;
    } else if (arg == "--new-clusters") {
      options.clusters = options.newClusters = true;
    } else if (arg == "--order") {
      options.order = true;
    } else if (arg == "--figures") {
      options.figures = true;
    } else if (arg == "--views") {
      options.views = true;
    } else if (arg == "--walk") {
      options.walk = true;
    } else if (arg == "--steady") {
      SteadyWalk& walk = options.steady;
      scan("%u/%f/%f/%f%c", "60/0.025/0/0.005", &walk.frames, &walk.step, &walk.turn, &walk.maxLate);
      if (walk.frames < 3) throw bench::Usage(arg + ": at least 3 frames");
    } else if (arg == "--small") {
      SmallViews& views = options.figure.views.emplace_back();
      scan("%u/%u/%f/%u%c", "8/80/0.06/4194304", &views.divisor, &views.count, &views.reach, &views.most);
      if (!views.divisor || !views.count) throw bench::Usage(arg + ": a divisor and a number of views above 0");
    } else if (arg == "--tables") {
      options.tables = true;
    } else if (arg == "--plot") {
      plots = true;
    } else {
      (plots ? options.plots : options.scenes).push_back(arguments.name());
    }
  }
  if (plots) return plotFigures(options.plots, options.out) ? 0 : 1;
  options.figure.passes = options.passes;
  if (options.scenes.empty()) options.scenes = {"bunnies", "colonnade", "foliage", "city", "street"};
  host::HeadlessDevice device;
  std::printf("device %s, %u x %u, medians of %u\n", device.name().c_str(), options.width, options.height,
              options.figure.repeat);
  bool good = true;
  VkPipelineCacheCreateInfo cacheInfo{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  VkPipelineCache cache = VK_NULL_HANDLE; // each scene has a context of its own; kernels are compiled once
  host::check(device.vk().vkCreatePipelineCache(device.device(), &cacheInfo, nullptr, &cache), "vkCreatePipelineCache");
  for (const std::string& name : options.scenes) {
    GpgpContextCreateInfo info = device.contextCreateInfo();
    info.pipelineCache = cache;
    info.messageFn = [](void*, const GpgpMessage* m) { std::fprintf(stderr, "%s: %s\n", m->function, m->text); };
    auto context = Context::create(info);
    expect(context.code(), "context");
    Scene scene = makeScene(name, options.width, options.height);
    if (const uint32_t* c = options.crop; c[0]) scene = cropped(scene, c[2], c[3], c[0], c[1], 1.0f);
    if (options.order) orderTriangles(scene);
    Runner runner(device, *context, scene);
    if (options.clusters) runner.useClusters(options.newClusters);
    const std::string title = std::filesystem::path(name).stem().string();
    if (options.views) {
      benchViews(runner, title, options.figure.repeat);
      continue;
    }
    if (options.steady.frames) {
      printSteadyWalk(runner, title, options.steady);
      continue;
    }
    if (options.walk) {
      printWalkingCell(runner, title, scene.params.height, options.figure);
      continue;
    }
    if (!options.figures || options.tables) good = benchScene(runner, scene, title, options) && good;
    if (options.figures) printFigures(runner, title, scene.params.height, options.figure);
    std::fflush(stdout);
  }
  device.vk().vkDestroyPipelineCache(device.device(), cache, nullptr);
  return good ? 0 : 1;
}

int main(int argc, char** argv) { return bench::benchMain(argc, argv, kUsage, runBench); }
