// One scene on a device: records of any method, view cells, references in slices, metrics; GPU times by timestamps.
#pragma once
#include "../visibility/measured_scenes.h"
#include "host/busy_work.h"
#include "host/frames.h"
#include "host/memory.h"
#include "measuring.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <gpgp/gpgp.hpp>

namespace gpgp::test {

using bench::expect;
using bench::median;

/// What a record lists by draw, for others to sample: of method nearby, what may be seen from a view cell.
struct DrawLists {
  host::Buffer commands, indices, numbers;
};

/// What a record asks for, the scene apart.
struct Sampling {
  GpgpSamplingMethod method = GPGP_SAMPLING_STANDARD;
  uint32_t samples = 0, slice = 0;
  bool accumulate = false;
  float resolution = 0;
  uint32_t heuristics = 0, refinements = 0; ///< of the conservative method
  float epsilonStatic = 0, epsilonDynamic = 0;
  uint32_t divisor = 1;              ///< of the scene's width and height
  float reach = 0;                   ///< of method nearby, metres
  const DrawLists* lists = nullptr;  ///< what is sampled, instead of the scene
  const DrawLists* listed = nullptr; ///< out
  GpgpHistory history = nullptr;
};

class Runner {
public:
  Runner(host::HeadlessDevice& device, Context& context, Scene& scene)
      : device_(device), context_(context), scene_(scene), frames_(device, 2), busy_(device) {
    const auto input = scene.input();
    const auto copy = [&](const auto& span, const char* what) {
      return host::makeBuffer(device, std::vector(span.begin(), span.end()), kStorage, what);
    };
    positions_ = copy(input.positions, "positions");
    indices_ = copy(input.indices, "indices");
    draws_ = copy(input.draws, "draws");
    bits_ = makeBits();
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
    std::copy_n(scene.params.viewProjection, 16, camera_.viewProjection);
    camera_.reversedDepth = scene.params.reversedDepth;
  }

  /// Records of draws leave out clusters that are out of sight; each makes them again, or only the first.
  void useClusters(bool again) {
    VkDeviceSize clusters = 1;
    for (const shader::Mesh& mesh : scene_.meshes) clusters += (mesh.indexCount / 3 + 63) / 64;
    clusters_ = {device_, clusters * 48, kStorage};
    VisibilityRecorder standard = recorder(GPGP_SAMPLING_STANDARD_BIT, 1);
    keepClusters_ = false;
    record(standard, {}, {}, bits_);
    keepClusters_ = !again;
  }

  uint32_t triangles() const { return scene_.params.triangleCount; }
  const GpgpCamera& camera() const { return camera_; }
  host::Buffer makeBits() { return {device_, VkDeviceSize(std::max((triangles() + 31) / 32, 1u)) * 4, kStorage}; }
  host::Buffer makeCounts() { return {device_, VkDeviceSize(triangles()) * 4, kStorage}; }
  host::Buffer copy(const std::vector<uint32_t>& words) { return host::makeBuffer(device_, words, kStorage, "copy"); }
  const host::Buffer& bits() const { return bits_; }

  /// Room for `triangles`.
  DrawLists makeLists(uint32_t listed) {
    return {{device_, scene_.draws.size() * 20, kStorage},
            {device_, VkDeviceSize(listed) * 12, kStorage},
            {device_, VkDeviceSize(listed) * 4, kStorage}};
  }

  /// listed: triangles of lists that it samples; 0: it samples the scene.
  VisibilityRecorder recorder(uint32_t methods, uint32_t maxSamples, uint32_t maxCameras = 1, uint32_t divisor = 1,
                              uint32_t listed = 0) {
    GpgpVisibilityRecorderCreateInfo info = GPGP_VISIBILITY_RECORDER_CREATE_INFO_INIT;
    info.base.label = "bench";
    info.base.queueFamily = device_.graphics().family;
    info.base.queueFlags = device_.graphics().flags;
    info.maxWidth = reduced(scene_.params.width, divisor);
    info.maxHeight = reduced(scene_.params.height, divisor);
    info.maxCameras = maxCameras;
    info.maxDraws = static_cast<uint32_t>(scene_.draws.size()) * maxCameras;
    info.maxTriangles = std::max((listed ? listed : triangles()) * maxCameras, 1u);
    info.methods = methods;
    info.maxSamples = maxSamples;
    const uint64_t range = device_.properties().limits.maxStorageBufferRange;
    const uint64_t pixels = uint64_t(info.maxWidth) * info.maxHeight * maxCameras;
    info.maxCandidates =
        static_cast<uint32_t>(std::min<uint64_t>({std::max(info.maxTriangles, 65536u), 1u << 24, range / 80}));
    info.maxPairs = static_cast<uint32_t>(std::min<uint64_t>(pixels * 24 + (1u << 20), range / 20));
    auto made = VisibilityRecorder::create(context_.get(), info);
    expect(made.code(), "recorder");
    expect(made->prewarm(), "prewarm");
    return std::move(*made);
  }

  struct Run {
    double milliseconds = 0;
    std::vector<std::pair<std::string, double>> passes;
    GpgpVisibilityReport report{};
  };

  /// Repeats one record into bits(), each timed as a whole; then as often again, with times of its passes, which wait
  /// for each other where they are timed.
  Run measure(VisibilityRecorder& recorder, const Sampling& sampling, uint32_t repeat,
              std::span<const GpgpCamera> cameras = {}) {
    uint32_t passes = 0;
    expect(gpgpGetPasses(recorder.get(), &passes, nullptr), "passes");
    std::vector<const char*> names(passes);
    expect(gpgpGetPasses(recorder.get(), &passes, names.data()), "passes");
    const VolkDeviceTable& vk = device_.vk();
    const VkQueryPoolCreateInfo queryInfo{
        VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, nullptr, 0, VK_QUERY_TYPE_TIMESTAMP, passes + 1, 0};
    VkQueryPool queries = VK_NULL_HANDLE;
    host::check(vk.vkCreateQueryPool(device_.device(), &queryInfo, nullptr, &queries), "vkCreateQueryPool");
    const double period = double(device_.properties().limits.timestampPeriod) * 1e-6;
    Run result;
    const auto once = [&](bool byPass) {
      const uint32_t count = byPass ? passes + 1 : 2;
      submit([&](VkCommandBuffer cmd) {
        vk.vkCmdResetQueryPool(cmd, queries, 0, count);
        busy_.record(cmd);
        host::fullBarrier(device_, cmd);
        GpgpVisibilityInfo info = infoOf(sampling, cameras, bits_, nullptr);
        if (byPass)
          info.base.timestamps = {queries, 0, count};
        else
          vk.vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries, 0);
        expect(recorder.recordPrepare(cmd, frames_.frame(), info), "record");
        if (!byPass) vk.vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries, 1);
      });
      std::vector<uint64_t> timestamps(count);
      host::check(vk.vkGetQueryPoolResults(device_.device(), queries, 0, count, timestamps.size() * 8,
                                           timestamps.data(), 8, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                  "vkGetQueryPoolResults");
      collect(recorder, result.report);
      std::vector<double> times;
      for (uint32_t i = 1; i < count; ++i)
        times.push_back(static_cast<double>(timestamps[i] - timestamps[i - 1]) * period);
      return times;
    };
    std::vector<double> totals;
    std::vector<std::vector<double>> each(passes);
    busy_.warmUp();
    for (uint32_t i = 0; i < repeat; ++i) totals.push_back(once(false)[0]);
    for (uint32_t i = 0; i < repeat; ++i) {
      const std::vector<double> times = once(true);
      for (uint32_t p = 0; p < passes; ++p) each[p].push_back(times[p]);
    }
    submit([](VkCommandBuffer) {});
    collect(recorder, result.report);
    vk.vkDestroyQueryPool(device_.device(), queries, nullptr);
    result.milliseconds = median(totals);
    for (uint32_t p = 0; p < passes; ++p) result.passes.emplace_back(names[p], median(each[p]));
    return result;
  }

  /// Of the scene's triangles; maxLate: of the next recordings with it.
  CameraHistory history(float maxLate) {
    GpgpCameraHistoryCreateInfo info = GPGP_CAMERA_HISTORY_CREATE_INFO_INIT;
    info.maxTriangles = std::max(triangles(), 1u);
    info.maxLate = maxLate;
    auto made = CameraHistory::create(context_.get(), info);
    expect(made.code(), "history");
    VkDeviceSize pending = 1;
    while (pending)
      submit([&](VkCommandBuffer cmd) {
        expect(gpgpRecordUpload(context_.get(), cmd, &frames_.frame(), 0, &pending), "upload");
      });
    return std::move(*made);
  }
  std::vector<uint32_t> download() { return host::download<uint32_t>(device_, bits_, (triangles() + 31) / 32); }

  /// One record into bits(), timed as a whole.
  Run timed(VisibilityRecorder& recorder, const Sampling& sampling, const GpgpCamera& camera) {
    const VolkDeviceTable& vk = device_.vk();
    const VkQueryPoolCreateInfo queryInfo{
        VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, nullptr, 0, VK_QUERY_TYPE_TIMESTAMP, 2, 0};
    VkQueryPool queries = VK_NULL_HANDLE;
    host::check(vk.vkCreateQueryPool(device_.device(), &queryInfo, nullptr, &queries), "vkCreateQueryPool");
    submit([&](VkCommandBuffer cmd) {
      vk.vkCmdResetQueryPool(cmd, queries, 0, 2);
      busy_.record(cmd);
      host::fullBarrier(device_, cmd);
      vk.vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries, 0);
      expect(recorder.recordPrepare(cmd, frames_.frame(), infoOf(sampling, {&camera, 1}, bits_, nullptr)), "record");
      vk.vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries, 1);
    });
    uint64_t timestamps[2];
    host::check(vk.vkGetQueryPoolResults(device_.device(), queries, 0, 2, sizeof timestamps, timestamps, 8,
                                         VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                "vkGetQueryPoolResults");
    vk.vkDestroyQueryPool(device_.device(), queries, nullptr);
    Run result;
    result.milliseconds =
        static_cast<double>(timestamps[1] - timestamps[0]) * double(device_.properties().limits.timestampPeriod) * 1e-6;
    submit([](VkCommandBuffer) {});
    collect(recorder, result.report);
    return result;
  }

  /// Records that unite cameras into bits(), each with `perRecord` of them: their milliseconds and pairs together. A
  /// later record asks a little less, as what is visible already needs no answer.
  Run measureUnion(VisibilityRecorder& recorder, Sampling sampling, std::span<const GpgpCamera> cameras,
                   uint32_t perRecord, uint32_t repeat) {
    Run all;
    std::vector<double> totals;
    for (uint32_t i = 0; i < repeat; ++i) {
      double& total = totals.emplace_back(0);
      all.report = {};
      sampling.accumulate = false;
      for (size_t first = 0; first < cameras.size(); first += perRecord) {
        const size_t n = std::min<size_t>(perRecord, cameras.size() - first);
        const Run one = measure(recorder, sampling, 1, cameras.subspan(first, n));
        total += one.milliseconds;
        if (all.passes.empty())
          all.passes = one.passes;
        else if (i == 0)
          for (size_t p = 0; p < one.passes.size(); ++p) all.passes[p].second += one.passes[p].second;
        all.report.neededPairs += one.report.neededPairs;
        all.report.unresolved += one.report.unresolved;
        sampling.accumulate = true;
      }
    }
    all.milliseconds = median(totals);
    return all;
  }

  /// Cameras of a record, so that its lists fit what the device binds.
  uint32_t camerasPerRecord(uint32_t divisor) const {
    const uint64_t pixels = uint64_t(reduced(scene_.params.width, divisor)) * reduced(scene_.params.height, divisor);
    const uint64_t most = device_.properties().limits.maxStorageBufferRange / 8 / (pixels * 8);
    return static_cast<uint32_t>(std::clamp<uint64_t>(most, 1, shader::kMaxCameras));
  }

  /// One record, not timed.
  GpgpVisibilityReport record(VisibilityRecorder& recorder, const Sampling& sampling,
                              std::span<const GpgpCamera> cameras, const host::Buffer& bits,
                              const host::Buffer* counts = nullptr) {
    GpgpVisibilityReport report{};
    submit([&](VkCommandBuffer cmd) {
      const GpgpVisibilityInfo info = infoOf(sampling, cameras, bits, counts);
      expect(recorder.recordPrepare(cmd, frames_.frame(), info), "record");
    });
    submit([](VkCommandBuffer) {});
    collect(recorder, report);
    return report;
  }

  /// The reference of all the cameras with samples x samples a pixel and the centre, each told when it is there; counts
  /// may be null.
  void reference(
      uint32_t samples, std::span<const GpgpCamera> cameras, const host::Buffer& bits,
      const host::Buffer* counts = nullptr, const std::function<void(size_t)>& told = [](size_t) {}) {
    uint32_t perRecord = std::min(samples, 8u); // as many as the device binds
    while (perRecord > 1 && uint64_t(scene_.params.width) * scene_.params.height * perRecord * perRecord * 8 >
                                device_.properties().limits.maxStorageBufferRange)
      perRecord /= 2;
    VisibilityRecorder reference = recorder(GPGP_SAMPLING_REFERENCE_BIT, perRecord);
    const uint32_t slices = samples / perRecord * (samples / perRecord) + 1;
    Sampling step;
    step.method = GPGP_SAMPLING_REFERENCE;
    step.samples = samples;
    constexpr uint32_t kTogether = 12; // records of one submission: a GPU that waits for each lowers its clocks
    for (const GpgpCamera& camera : cameras) {
      for (uint32_t slice = 0; slice < slices;) {
        const uint32_t end = std::min(slice + kTogether, slices);
        submit([&](VkCommandBuffer cmd) {
          for (; slice < end; ++slice) {
            step.slice = slice;
            expect(reference.recordPrepare(cmd, frames_.frame(), infoOf(step, {&camera, 1}, bits, counts)), "record");
            step.accumulate = true;
          }
        });
        GpgpVisibilityReport report{};
        collect(reference, report);
      }
      told(static_cast<size_t>(&camera - cameras.data()) + 1);
    }
  }

  /// counts and recheck may be null.
  GpgpVisibilityReport metrics(VisibilityRecorder& recorder, const host::Buffer& bits, const host::Buffer& reference,
                               const host::Buffer* counts, const host::Buffer* recheck) {
    GpgpVisibilityReport report{};
    submit([&](VkCommandBuffer cmd) {
      GpgpVisibilityMetricsInfo info = GPGP_VISIBILITY_METRICS_INFO_INIT;
      info.triangleCount = triangles();
      info.visibleBits = bits.range({}, kRead);
      info.referenceBits = reference.range({}, kRead);
      if (counts) info.referenceCounts = counts->range({}, kRead);
      if (recheck) info.recheckBits = recheck->range({}, kRead);
      expect(recorder.recordPrepareMetrics(cmd, frames_.frame(), info), "metrics");
    });
    submit([](VkCommandBuffer) {});
    collect(recorder, report);
    return report;
  }

private:
  static constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  static constexpr GpgpAccess kRead{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, {}};

  static uint32_t reduced(uint32_t pixels, uint32_t divisor) { return (pixels + divisor - 1) / divisor; }
  GpgpVisibilityInfo infoOf(const Sampling& sampling, std::span<const GpgpCamera> cameras, const host::Buffer& bits,
                            const host::Buffer* counts) const {
    GpgpVisibilityInfo info = GPGP_VISIBILITY_INFO_INIT;
    info.geometrySet = geometry_.get();
    info.history = sampling.history;
    info.method = sampling.method;
    info.camera = cameras.empty() ? camera_ : cameras[0];
    if (cameras.size() > 1) {
      info.moreCameras = cameras.data() + 1;
      info.moreCameraCount = static_cast<uint32_t>(cameras.size() - 1);
    }
    info.width = reduced(scene_.params.width, sampling.divisor);
    info.height = reduced(scene_.params.height, sampling.divisor);
    info.reach = sampling.reach;
    info.samples = sampling.samples;
    info.slice = sampling.slice;
    info.accumulate = sampling.accumulate;
    if (sampling.method == GPGP_SAMPLING_CONSERVATIVE) {
      info.resolution = sampling.resolution;
      info.heuristics = sampling.heuristics;
      info.epsilonStatic = sampling.epsilonStatic;
      info.epsilonDynamic = sampling.epsilonDynamic;
      info.refinements = sampling.refinements;
    }
    info.positions = positions_.range();
    info.indices = indices_.range();
    info.indexType = VK_INDEX_TYPE_UINT32;
    if (clusters_.handle() && !sampling.lists) {
      info.clusters = clusters_.range();
      info.keepClusters = keepClusters_;
    }
    info.draws = draws_.range();
    info.drawCount = static_cast<uint32_t>(scene_.draws.size());
    info.triangleCount = triangles();
    if (sampling.listed) {
      info.drawCommands = sampling.listed->commands.range({}, kRead);
      info.drawIndices = sampling.listed->indices.range({}, kRead);
      info.drawTriangles = sampling.listed->numbers.range({}, kRead);
    }
    if (sampling.lists) {
      info.commands = sampling.lists->commands.range();
      info.commandCount = info.drawCount;
      info.indices = sampling.lists->indices.range();
      info.triangleNumbers = sampling.lists->numbers.range();
    }
    info.visibleBits = bits.range({}, kRead);
    if (counts) info.pixelCounts = counts->range({}, kRead);
    return info;
  }
  static void collect(VisibilityRecorder& recorder, GpgpVisibilityReport& report) {
    for (auto next = recorder.report(); next; next = recorder.report()) report = *next;
  }
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
  GpgpCamera camera_{};
  host::FrameRing frames_;
  host::BusyWork busy_;
  host::Buffer positions_, indices_, draws_, bits_;
  host::Buffer clusters_;
  bool keepClusters_ = false;
  GeometrySet geometry_;
};

} // namespace gpgp::test
