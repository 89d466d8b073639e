// What recording costs the engine: CPU time of each service's record function, and GPU time of what it records.
//
//   record_bench [records]
//
// Baseline in the same process: as many bare vkCmdPipelineBarrier + vkCmdFillBuffer pairs as the service has passes,
// into the same command buffer. Prints medians and ratios; asserts nothing about time, but fails where a record fails.
#include "../api/scenarios.h"
#include "host/frames.h"
#include "measuring.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using namespace gpgp::bench;

double microseconds(Clock::duration d) { return milliseconds(d) * 1000; }
} // namespace

int main(int argc, char** argv) {
  const int records = argc > 1 ? std::max(2, std::atoi(argv[1])) : 200;
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
    expect(scenario->createWorker(context, {"bench", device.graphics().family, 0, VK_FALSE}), "worker");
    expect(scenario->createView(context), "view");
    expect(scenario->prewarm(), "prewarm");
    uint32_t passes = 0;
    expect(gpgpGetPasses(scenario->worker, &passes, nullptr), "passes");
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
        GpgpRecordInfo base{};
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
  return 0;
}
