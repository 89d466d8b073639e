// What recording costs the engine: CPU time of each service's record function, and GPU time of what it records.
//
// Baseline in the same process: as many bare vkCmdPipelineBarrier + vkCmdFillBuffer pairs as the service has passes,
// into the same command buffer. Prints medians and ratios; asserts nothing about time, but fails where a record fails.
#include "../api/scenarios.h"
#include "arguments.h"
#include "host/frames.h"
#include "measuring.h"

#include <gpgp/ui.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using namespace gpgp::bench;

double microseconds(Clock::duration d) { return milliseconds(d) * 1000; }

#if defined(GPGP_WITH_VECTOR)
/// What a shape of a list costs the CPU: to add it, one call each, to record it, and to ask for it at a point.
/// Baseline: copying the 112 bytes that recording writes for it.
void measureList(host::HeadlessDevice& device, int records) {
  constexpr uint32_t kShapes = 10000;
  GpgpContextCreateInfo info = scenarioContextInfo(device, nullptr);
  GpgpContext context = nullptr;
  expect(gpgpCreateContext(&info, &context), "gpgpCreateContext");
  GpgpCanvasCreateInfo canvasInfo = GPGP_CANVAS_CREATE_INFO_INIT;
  canvasInfo.base = {"bench", device.graphics().family, 0, VK_FALSE};
  canvasInfo.maxWidth = canvasInfo.maxHeight = 64;
  canvasInfo.maxShapes = canvasInfo.maxPaths = kShapes;
  GpgpRecorder canvas = nullptr;
  expect(gpgpCreateCanvas(context, &canvasInfo, &canvas), "gpgpCreateCanvas");
  expect(gpgpPrewarm(canvas, nullptr), "gpgpPrewarm");
  GpgpCanvasHistoryCreateInfo viewInfo = GPGP_CANVAS_HISTORY_CREATE_INFO_INIT;
  viewInfo.width = viewInfo.height = 64;
  GpgpHistory view = nullptr;
  expect(gpgpCreateCanvasHistory(context, &viewInfo, &view), "gpgpCreateCanvasHistory");
  const GpgpListCreateInfo listInfo = GPGP_LIST_CREATE_INFO_INIT;
  GpgpCanvasItem item{nullptr, {1, 0, 0, 1, 0, 0}, 1};
  expect(gpgpCreateList(context, &listInfo, &item.list), "gpgpCreateList");
  GpgpListShape shape{};
  shape.box[2] = shape.box[3] = 1;
  shape.radii[0] = 0.25f;
  shape.color[3] = 1;
  std::vector<std::array<char, 112>> from(kShapes), to(kShapes);
  std::vector<double> adding, recording, asking, copying;
  for (int i = 0; i < std::min(records, 50); ++i) {
    const GpgpFrame frame{static_cast<uint64_t>(i) + 1, static_cast<uint64_t>(i)};
    expect(gpgpAdvance(context, &frame), "gpgpAdvance");
    const auto start = Clock::now();
    gpgpResetList(item.list);
    for (uint32_t k = 0; k < kShapes; ++k) {
      shape.box[0] = static_cast<float>(k % 100), shape.box[1] = static_cast<float>(k / 100 % 100);
      shape.box[2] = shape.box[0] + 1, shape.box[3] = shape.box[1] + 1;
      expect(gpgpAddShapes(item.list, &shape, 1), "gpgpAddShapes");
    }
    adding.push_back(microseconds(Clock::now() - start));
    device.submitAndWait([&](VkCommandBuffer cmd) {
      expect(gpgpRecordUpload(context, cmd, &frame, 0, nullptr), "gpgpRecordUpload");
      GpgpCanvasInfo canvasRecord = GPGP_CANVAS_INFO_INIT;
      canvasRecord.width = canvasRecord.height = 64;
      canvasRecord.items = &item;
      canvasRecord.itemCount = 1;
      canvasRecord.history = view;
      const auto before = Clock::now();
      expect(gpgpRecordPrepareCanvas(canvas, cmd, &frame, &canvasRecord), "gpgpRecordPrepareCanvas");
      recording.push_back(microseconds(Clock::now() - before));
    });
    GpgpHitTestInfo hitInfo = GPGP_HIT_TEST_INFO_INIT;
    hitInfo.items = &item;
    hitInfo.itemCount = 1;
    hitInfo.x = hitInfo.y = 0.5f; // the one at the bottom
    GpgpHit hit{};
    const auto before = Clock::now();
    expect(gpgpHitTest(context, &hitInfo, &hit), "gpgpHitTest");
    const auto middle = Clock::now();
    for (uint32_t k = 0; k < kShapes; ++k) to[k] = from[k];
    from[0][0] = to[kShapes - 1][1];
    copying.push_back(microseconds(Clock::now() - middle));
    asking.push_back(microseconds(middle - before));
  }
  const auto each = [](const std::vector<double>& times) { return median(times) * 1000 / kShapes; };
  std::printf(
      "list of %u shapes, ns a shape: add %.1f, record %.1f, hit test %.1f, copy 112 bytes %.1f; ratios %.1f, %.1f\n",
      kShapes, each(adding), each(recording), each(asking), each(copying), each(adding) / each(copying),
      each(recording) / each(copying));
  gpgpDestroyContext(context);
}
#endif
} // namespace

const char* const kUsage = "record_bench [RECORDS]     200 records of each service where it does not say\n";

int runBench(Arguments arguments) {
  const int records = arguments.next() ? static_cast<int>(arguments.count(2)) : 200;
  host::HeadlessDevice device;
  const double period = device.properties().limits.timestampPeriod * 1e-3; // microseconds a tick
  std::printf("device %s, %d records, medians\n", device.name().c_str(), records);
  std::printf("%-12s %7s %12s %12s %7s %12s\n", "service", "passes", "record us", "baseline us", "ratio", "GPU us");
  for (const std::string& name : scenarioNames()) {
    GpgpContextCreateInfo info = scenarioContextInfo(device, nullptr);
    GpgpContext context = nullptr;
    expect(gpgpCreateContext(&info, &context), "gpgpCreateContext");
    const auto scenario = makeScenario(name, device);
    expect(scenario->createAsset(context), "asset");
    expect(scenario->createRecorder(context, {"bench", device.graphics().family, 0, VK_FALSE}), "recorder");
    expect(scenario->createView(context), "view");
    expect(scenario->prewarm(), "prewarm");
    uint32_t passes = 0;
    expect(gpgpGetPasses(scenario->recorder, &passes, nullptr), "passes");
    const VolkDeviceTable& vk = device.vk();
    const VkQueryPoolCreateInfo queryInfo{
        VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, nullptr, 0, VK_QUERY_TYPE_TIMESTAMP, passes + 1, 0};
    VkQueryPool queries = VK_NULL_HANDLE;
    host::check(vk.vkCreateQueryPool(device.device(), &queryInfo, nullptr, &queries), "vkCreateQueryPool");
    host::Buffer scratch(device, 256, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    scenario->clearOutputs();

    std::vector<double> cpu, bare, gpu;
    for (int i = 0; i < records; ++i) {
      const GpgpFrame frame{static_cast<uint64_t>(i) + 1, static_cast<uint64_t>(i)};
      expect(gpgpAdvance(context, &frame), "gpgpAdvance");
      const bool timed = i % 2 == 1; // timestamps cost recording time too
      device.submitAndWait([&](VkCommandBuffer cmd) {
        expect(gpgpRecordUpload(context, cmd, &frame, 0, nullptr), "gpgpRecordUpload");
        vk.vkCmdResetQueryPool(cmd, queries, 0, passes + 1);
        GpgpRecordingInfo base{};
        if (timed) base.timestamps = {queries, 0, passes + 1};
        const auto start = Clock::now();
        expect(scenario->record(cmd, frame, base), "record");
        const auto middle = Clock::now();
        for (uint32_t pass = 0; pass < passes; ++pass) {
          const VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_TRANSFER_WRITE_BIT,
                                        VK_ACCESS_TRANSFER_WRITE_BIT};
          vk.vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &barrier,
                                  0, nullptr, 0, nullptr);
          vk.vkCmdFillBuffer(cmd, scratch.handle(), 0, 256, pass);
        }
        const auto end = Clock::now();
        if (!timed) {
          cpu.push_back(microseconds(middle - start));
          bare.push_back(microseconds(end - middle));
        }
      });
      if (timed) {
        std::vector<uint64_t> times(passes + 1);
        host::check(vk.vkGetQueryPoolResults(device.device(), queries, 0, passes + 1, times.size() * 8, times.data(), 8,
                                             VK_QUERY_RESULT_64_BIT),
                    "vkGetQueryPoolResults");
        gpu.push_back(static_cast<double>(times.back() - times.front()) * period);
      }
    }
    std::printf("%-12s %7u %12.2f %12.2f %7.2f %12.2f\n", name.c_str(), passes, median(cpu), median(bare),
                median(cpu) / median(bare), median(gpu));
    vk.vkDestroyQueryPool(device.device(), queries, nullptr);
    gpgpDestroyContext(context);
  }
#if defined(GPGP_WITH_VECTOR)
  measureList(device, records);
#endif
  return 0;
}

int main(int argc, char** argv) { return benchMain(argc, argv, kUsage, runBench); }
