// What each sampling method finds and costs, on the measured scenes: coverage and overestimation against the truth made
// in the same run, GPU time by timestamps, and the ratio to standard sampling (the baseline).
//
//   visibility_bench [--size WxH] [--repeat N] [--truth N] [--passes] [SCENE...]
//
// Scenes: bunnies colonnade foliage city street bigcity bigstreet. As a test it runs on small ones. Asserts nothing
// about time, but fails where exact sampling shows over 1.5 % that the truth does not hold, or a budget is exceeded.
#include "../visibility/measured_scenes.h"
#include "host/busy_work.h"
#include "host/frames.h"
#include "host/memory.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <gpgp/gpgp.hpp>
#include <tuple>

namespace {
using namespace gpgp;
using namespace gpgp::test;

struct Options {
  uint32_t width = 160, height = 90, repeat = 3, truth = 64;
  bool passes = false;
  std::vector<std::string> scenes;
};

void expect(GpgpResult result, const char* what) {
  if (result == GPGP_SUCCESS) return;
  std::fprintf(stderr, "%s: %s\n", what, gpgpResultString(result));
  std::exit(1);
}
double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
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
  } else {
    std::fprintf(stderr, "there is no scene '%s'\n", name.c_str());
    std::exit(2);
  }
  return scene;
}

class Bench {
public:
  Bench(host::HeadlessDevice& device, Context& context, Scene& scene, const Options& options)
      : device_(device), context_(context), scene_(scene), options_(options), frames_(device, 2), busy_(device) {
    const auto input = scene.input();
    const auto copy = [&](const auto& span, const char* what) {
      return host::makeBuffer(device, std::vector(span.begin(), span.end()), kStorage, what);
    };
    positions_ = copy(input.positions, "positions");
    indices_ = copy(input.indices, "indices");
    draws_ = copy(input.draws, "draws");
    bits_ = host::Buffer(device, words() * 4, kStorage);
    sizes_ = host::Buffer(device, VkDeviceSize(scene.params.triangleCount) * 4, kStorage);
    GpgpGeometrySetCreateInfo info = GPGP_GEOMETRY_SET_CREATE_INFO_INIT;
    info.meshes = reinterpret_cast<const GpgpMesh*>(scene.meshes.data());
    info.meshCount = static_cast<uint32_t>(scene.meshes.size());
    auto set = GeometrySet::create(context.get(), info);
    expect(set.code(), "geometry set");
    geometry_ = std::move(*set);
    VkDeviceSize pending = 1;
    while (pending)
      submit([&](VkCommandBuffer cmd) {
        expect(gpgpRecordUpload(context_.get(), cmd, &frames_.frame(), 0, &pending), "upload");
      });
  }

  Sampler sampler(uint32_t methods, uint32_t maxSamples) {
    GpgpSamplerCreateInfo info = GPGP_SAMPLER_CREATE_INFO_INIT;
    info.base.label = "bench";
    info.base.queueFamily = device_.graphics().family;
    info.base.queueFlags = device_.graphics().flags;
    info.maxWidth = options_.width;
    info.maxHeight = options_.height;
    info.maxDraws = static_cast<uint32_t>(scene_.draws.size());
    info.maxTriangles = std::max(scene_.params.triangleCount, 1u);
    info.methods = methods;
    info.maxSamples = maxSamples;
    const uint64_t range = device_.properties().limits.maxStorageBufferRange;
    const uint64_t pixels = uint64_t(info.maxWidth) * info.maxHeight;
    info.maxCandidates =
        static_cast<uint32_t>(std::min<uint64_t>({std::max(info.maxTriangles, 65536u), 1u << 24, range / 80}));
    info.maxPairs = static_cast<uint32_t>(std::min<uint64_t>(pixels * 24 + (1u << 20), range / 20));
    auto made = Sampler::create(context_.get(), info);
    expect(made.code(), "sampler");
    expect(made->prewarm(), "prewarm");
    return std::move(*made);
  }

  struct Run {
    double milliseconds = 0;
    std::vector<std::pair<std::string, double>> passes;
    GpgpSampleReport report{};
    std::vector<uint32_t> bits;
  };

  uint32_t heuristics = 0, refinements = 0; ///< of the conservative method
  float epsilon = 0;

  /// records: of one measured run, one after the other (slices).
  Run run(Sampler& sampler, GpgpSamplingMethod method, uint32_t repeat, uint32_t slices = 1, bool sizes = false) {
    uint32_t passes = 0;
    expect(gpgpGetPasses(sampler.get(), &passes, nullptr), "passes");
    std::vector<const char*> names(passes);
    expect(gpgpGetPasses(sampler.get(), &passes, names.data()), "passes");
    const VolkDeviceTable& vk = device_.vk();
    const VkQueryPoolCreateInfo queryInfo{
        VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, nullptr, 0, VK_QUERY_TYPE_TIMESTAMP, passes + 1, 0};
    VkQueryPool queries = VK_NULL_HANDLE;
    host::check(vk.vkCreateQueryPool(device_.device(), &queryInfo, nullptr, &queries), "vkCreateQueryPool");
    const double period = double(device_.properties().limits.timestampPeriod) * 1e-6;
    Run result;
    std::vector<double> totals;
    std::vector<std::vector<double>> each(passes);
    if (slices == 1) busy_.warmUp();
    for (uint32_t i = 0; i < repeat; ++i) {
      double total = 0;
      for (uint32_t slice = 0; slice < slices; ++slice) {
        submit([&](VkCommandBuffer cmd) {
          vk.vkCmdResetQueryPool(cmd, queries, 0, passes + 1);
          if (slices == 1) busy_.record(cmd);
          host::fullBarrier(device_, cmd);
          GpgpSampleInfo info = GPGP_SAMPLE_INFO_INIT;
          info.base.timestamps = {queries, 0, passes + 1};
          info.geometrySet = geometry_.get();
          info.method = method;
          std::copy_n(scene_.params.viewProjection, 16, info.camera.viewProjection);
          info.camera.reversedDepth = scene_.params.reversedDepth;
          info.heuristics = heuristics;
          info.epsilonStatic = info.epsilonDynamic = epsilon;
          info.refinements = method == GPGP_SAMPLING_CONSERVATIVE ? refinements : 0;
          info.width = options_.width;
          info.height = options_.height;
          info.samples = method == GPGP_SAMPLING_TRUTH ? options_.truth : 0;
          info.slice = slice;
          info.accumulate = slice > 0;
          info.positions = positions_.range();
          info.indices = indices_.range();
          info.indexType = VK_INDEX_TYPE_UINT32;
          info.draws = draws_.range();
          info.drawCount = static_cast<uint32_t>(scene_.draws.size());
          info.triangleCount = scene_.params.triangleCount;
          info.visibleBits = bits_.range({}, kRead);
          if (sizes) info.pixelCounts = sizes_.range({}, kRead);
          expect(sampler.recordPrepare(cmd, frames_.frame(), info), "record");
        });
        std::vector<uint64_t> stamps(passes + 1);
        host::check(vk.vkGetQueryPoolResults(device_.device(), queries, 0, passes + 1, stamps.size() * 8, stamps.data(),
                                             8, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                    "vkGetQueryPoolResults");
        total += static_cast<double>(stamps.back() - stamps.front()) * period;
        for (uint32_t p = 0; p < passes; ++p)
          each[p].push_back(static_cast<double>(stamps[p + 1] - stamps[p]) * period);
        for (auto report = sampler.report(); report; report = sampler.report()) result.report = *report;
      }
      totals.push_back(total);
    }
    submit([](VkCommandBuffer) {});
    for (auto report = sampler.report(); report; report = sampler.report()) result.report = *report;
    vk.vkDestroyQueryPool(device_.device(), queries, nullptr);
    result.milliseconds = median(totals);
    for (uint32_t p = 0; p < passes; ++p) result.passes.emplace_back(names[p], median(each[p]));
    result.bits = host::download<uint32_t>(device_, bits_, words());
    return result;
  }

  std::vector<uint32_t> sizes() { return host::download<uint32_t>(device_, sizes_, scene_.params.triangleCount); }

private:
  static constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  static constexpr GpgpAccess kRead{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, {}};
  uint32_t words() const { return (scene_.params.triangleCount + 31) / 32; }
  template <class Record> void submit(const Record& record) {
    VkCommandBuffer cmd = frames_.begin();
    expect(gpgpAdvance(context_.get(), &frames_.frame()), "advance");
    record(cmd);
    frames_.submit();
    frames_.waitAll();
  }
  host::HeadlessDevice& device_;
  Context& context_;
  Scene& scene_;
  const Options& options_;
  host::FrameRing frames_;
  host::BusyWork busy_;
  host::Buffer positions_, indices_, draws_, bits_, sizes_;
  GeometrySet geometry_;
};

bool benchScene(host::HeadlessDevice& device, const std::string& name, const Options& options) {
  GpgpContextCreateInfo info = device.contextCreateInfo();
  info.messageFn = [](void*, const GpgpMessage* m) { std::fprintf(stderr, "%s: %s\n", m->function, m->text); };
  auto context = Context::create(info);
  expect(context.code(), "context");
  Scene scene = makeScene(name, options.width, options.height);
  Bench bench(device, *context, scene, options);
  std::vector<uint32_t> truth, sizes;
  double truthArea = 0;
  uint32_t truthCount = 0;
  if (options.truth) {
    // As many samples a record as the device binds.
    uint32_t samples = std::min(options.truth, 8u);
    while (samples > 1 && uint64_t(options.width) * options.height * samples * samples * 4 >
                              device.properties().limits.maxStorageBufferRange)
      samples /= 2;
    const uint32_t side = options.truth / samples;
    Sampler sampler = bench.sampler(GPGP_SAMPLING_TRUTH_BIT, samples);
    const auto run = bench.run(sampler, GPGP_SAMPLING_TRUTH, 1, side * side + 1, true);
    truth = run.bits;
    sizes = bench.sizes();
    for (const uint32_t word : truth) truthCount += static_cast<uint32_t>(std::popcount(word));
    for (const uint32_t size : sizes) truthArea += size;
    std::printf("%s: %u triangles, %u visible at %u x %u + 1 samples (%.2f a pixel), %.1f ms in %u slices\n",
                name.c_str(), scene.params.triangleCount, truthCount, options.truth, options.truth,
                double(truthCount) / options.width / options.height, run.milliseconds, side * side + 1);
  } else {
    std::printf("%s: %u triangles\n", name.c_str(), scene.params.triangleCount);
  }
  std::printf("  %-16s %9s %9s %9s %9s %9s %7s %10s %10s\n", "method", "visible", "cov %", "cov area", "over %", "ms",
              "ratio", "candidates", "pairs");
  double baseline = 0;
  bool good = true;
  const auto print = [&](const std::string& method, const Bench::Run& run) {
    uint32_t found = 0, extra = 0;
    double area = 0;
    for (size_t i = 0; i < truth.size(); ++i) {
      found += static_cast<uint32_t>(std::popcount(run.bits[i] & truth[i]));
      extra += static_cast<uint32_t>(std::popcount(run.bits[i] & ~truth[i]));
      for (uint32_t rest = run.bits[i]; rest; rest &= rest - 1)
        area += sizes[i * 32 + static_cast<size_t>(std::countr_zero(rest))];
    }
    if (baseline == 0) baseline = run.milliseconds;
    std::printf("  %-16s %9u %9.3f %9.4f %9.3f %9.4f %7.2f %10u %10u%s\n", method.c_str(), run.report.visible,
                100.0 * found / std::max(truthCount, 1u), 100.0 * area / std::max(truthArea, 1.0),
                100.0 * extra / std::max(truthCount, 1u), run.milliseconds, run.milliseconds / baseline,
                run.report.neededCandidates, run.report.neededPairs,
                run.report.base.status == GPGP_SUCCESS ? "" : " BUDGET");
    if (options.passes)
      for (const auto& [pass, time] : run.passes)
        if (time > 0.002) std::printf("      %-16s %9.4f\n", pass.c_str(), time);
    good = good && run.report.base.status == GPGP_SUCCESS &&
           (options.truth < 64 || bench.heuristics || extra <= 0.015 * truthCount); // coarser truths miss more
  };
  {
    Sampler sampler = bench.sampler(GPGP_SAMPLING_STANDARD_BIT, 1);
    print("standard", bench.run(sampler, GPGP_SAMPLING_STANDARD, options.repeat));
  }
  {
    Sampler sampler = bench.sampler(GPGP_SAMPLING_EXACT_BIT, 1);
    print("exact", bench.run(sampler, GPGP_SAMPLING_EXACT, options.repeat));
  }
  // The thesis's method, with the epsilons that others were measured with.
  Sampler sampler = bench.sampler(GPGP_SAMPLING_CONSERVATIVE_BIT, 1);
  constexpr uint32_t kFront = GPGP_HEURISTICS_THESIS | GPGP_HEURISTIC_KEEP_FRONT;
  for (const auto& [what, heuristics, epsilon, refinements] :
       {std::tuple("thesis 0.05", GPGP_HEURISTICS_THESIS, 0.05f, 0u),
        {"thesis 2", GPGP_HEURISTICS_THESIS, 2.0f, 0u},
        {"front 0.05", kFront, 0.05f, 0u},
        {"thesis 0.05, 2", GPGP_HEURISTICS_THESIS, 0.05f, 2u}}) {
    bench.heuristics = heuristics;
    bench.epsilon = epsilon;
    bench.refinements = refinements;
    print(what, bench.run(sampler, GPGP_SAMPLING_CONSERVATIVE, options.repeat));
  }
  std::fflush(stdout);
  return good;
}
} // namespace

int main(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    const auto next = [&] { return i + 1 < argc ? argv[++i] : ""; };
    if (arg == "--size") {
      if (std::sscanf(next(), "%ux%u", &options.width, &options.height) != 2) return 2;
    } else if (arg == "--repeat") {
      options.repeat = static_cast<uint32_t>(std::max(1, std::atoi(next())));
    } else if (arg == "--truth") {
      options.truth = static_cast<uint32_t>(std::atoi(next()));
    } else if (arg == "--passes") {
      options.passes = true;
    } else {
      options.scenes.push_back(arg);
    }
  }
  if (options.scenes.empty()) options.scenes = {"bunnies", "colonnade", "foliage", "city", "street"};
  host::HeadlessDevice device;
  std::printf("device %s, %u x %u, medians of %u\n", device.name().c_str(), options.width, options.height,
              options.repeat);
  bool good = true;
  for (const std::string& scene : options.scenes) good = benchScene(device, scene, options) && good;
  return good ? 0 : 1;
}
