// Faults: for every n, the n-th host allocation, or the device allocations or Vulkan objects from the n-th on fail, as
// gpgp may ask again for less. Creation then fails with the right error, nothing leaks, and the context goes on
// working.
#include "aligned.h"
#include "scenarios.h"
#include "vulkan_proxy.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <map>

namespace {
using namespace gpgp;
using namespace gpgp::test;

/// The engine's allocators, with every live allocation known and a countdown to failure.
struct Faults {
  std::map<void*, std::pair<size_t, size_t>> host;
  uint64_t hostCalls = 0, hostFailAt = 0;
  std::map<VkDeviceMemory, void*> gpu;
  uint64_t gpuCalls = 0, gpuFailAt = 0;
  host::HeadlessDevice* device = nullptr;

  GpgpHostAllocator hostCallbacks() {
    return {this,
            [](void* user, size_t size, size_t alignment) -> void* {
              Faults& self = *static_cast<Faults*>(user);
              if (++self.hostCalls == self.hostFailAt) return nullptr;
              void* memory = allocateAligned(size, alignment);
              self.host[memory] = {size, alignment};
              return memory;
            },
            [](void* user, void* memory, size_t size, size_t alignment) {
              Faults& self = *static_cast<Faults*>(user);
              const auto at = self.host.find(memory);
              ASSERT_NE(at, self.host.end()) << "freed what was never allocated";
              EXPECT_EQ(at->second, std::pair(size, alignment)) << "freed with another size than allocated";
              self.host.erase(at);
              freeAligned(memory);
            }};
  }
  GpgpGpuAllocator gpuCallbacks() {
    return {this,
            [](void* user, const GpgpGpuAllocationRequest* request, GpgpGpuAllocation* allocation) -> VkResult {
              Faults& self = *static_cast<Faults*>(user);
              if (++self.gpuCalls >= self.gpuFailAt && self.gpuFailAt) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
              const VolkDeviceTable& vk = self.device->vk();
              const uint32_t type =
                  self.device->memoryType(request->requirements.memoryTypeBits, request->required, request->preferred);
              const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr,
                                              request->requirements.size, type};
              const VkResult result = vk.vkAllocateMemory(self.device->device(), &info, nullptr, &allocation->memory);
              if (result != VK_SUCCESS) return result;
              allocation->mapped = nullptr;
              if (request->required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT)
                vk.vkMapMemory(self.device->device(), allocation->memory, 0, VK_WHOLE_SIZE, 0, &allocation->mapped);
              self.gpu[allocation->memory] = allocation->mapped;
              return VK_SUCCESS;
            },
            [](void* user, const GpgpGpuAllocation* allocation) {
              Faults& self = *static_cast<Faults*>(user);
              EXPECT_EQ(self.gpu.erase(allocation->memory), 1u) << "freed what was never allocated";
              self.device->vk().vkFreeMemory(self.device->device(), allocation->memory, nullptr);
            }};
  }
};

struct FaultTest : testing::TestWithParam<std::string> {
  host::HeadlessDevice& device = sharedDevice();
  VulkanProxy proxy{device};
  std::vector<std::string> messages;
  Faults faults;
  std::unique_ptr<Scenario> scenario;

  void SetUp() override {
    faults.device = &device;
    scenario = makeScenario(GetParam(), device);
  }
  void TearDown() override {
    scenario.reset();
    for (const std::string& message : device.takeValidationMessages()) ADD_FAILURE() << message;
  }
  GpgpResult createContext(GpgpContext& context, bool engineGpu) {
    GpgpContextCreateInfo info = scenarioContextInfo(device, &messages);
    info.getInstanceProcAddr = VulkanProxy::getInstanceProcAddr();
    const GpgpHostAllocator host = faults.hostCallbacks();
    const GpgpGpuAllocator gpu = faults.gpuCallbacks();
    info.hostAllocator = &host;
    info.gpuAllocator = engineGpu ? &gpu : nullptr;
    return gpgpCreateContext(&info, &context);
  }
  /// Asset, recorder and view; the first error, if any. Pipelines come apart, they take long to compile.
  GpgpResult createAll(GpgpContext context) {
    if (const GpgpResult r = scenario->createAsset(context); r != GPGP_SUCCESS) return r;
    if (const GpgpResult r = scenario->createRecorder(context, {"recorder", device.graphics().family, 0, VK_FALSE});
        r != GPGP_SUCCESS)
      return r;
    return scenario->createView(context);
  }
  /// Device bytes in use, of all services.
  static VkDeviceSize deviceBytes(GpgpContext context) {
    GpgpMemoryReport report = GPGP_MEMORY_REPORT_INIT;
    EXPECT_EQ(gpgpGetMemoryReport(context, &report), GPGP_SUCCESS);
    VkDeviceSize sum = 0;
    for (const GpgpServiceMemory& service : report.services) sum += service.deviceBytes + service.hostVisibleBytes;
    return sum;
  }
  void expectOneMessage(GpgpResult result, GpgpResult expected, uint32_t n) {
    EXPECT_EQ(result, expected) << "n = " << n << ": " << (messages.empty() ? "" : messages.back());
    EXPECT_EQ(messages.size(), 1u) << "n = " << n << ": one message for one error";
    messages.clear();
  }
  /// Runs the job once and checks that it does what it should.
  void expectUsable(GpgpContext context, GpgpFrame frame) {
    ASSERT_EQ(gpgpAdvance(context, &frame), GPGP_SUCCESS);
    scenario->clearOutputs();
    device.submitAndWait([&](VkCommandBuffer cmd) {
      ASSERT_EQ(gpgpRecordUpload(context, cmd, &frame, 0, nullptr), GPGP_SUCCESS);
      ASSERT_EQ(scenario->record(cmd, frame, {}), GPGP_SUCCESS);
    });
    ++frame.current, ++frame.safe;
    ASSERT_EQ(gpgpAdvance(context, &frame), GPGP_SUCCESS);
    GpgpReportHeader header{};
    bool meaningful = false;
    ASSERT_EQ(scenario->takeReport(header, meaningful), GPGP_SUCCESS);
    EXPECT_TRUE(meaningful);
  }
  /// Makes everything with the n-th failure for n = 1, 2, ... until nothing fails any more; then the same for the
  /// pipelines of the recorder that was made.
  void sweep(GpgpResult expected, bool engineGpu, const std::function<void(uint32_t)>& arm,
             const std::function<void()>& disarm) {
    uint32_t failures = 0;
    VkDeviceSize emptyBytes = 0; // of a context in which nothing was made
    GpgpContext context = nullptr;
    for (uint32_t n = 1;; ++n) {
      ASSERT_LT(n, 5000u) << "creation never succeeds";
      arm(n);
      const GpgpResult made = createContext(context, engineGpu);
      if (made == GPGP_SUCCESS) emptyBytes = deviceBytes(context);
      const GpgpResult result = made == GPGP_SUCCESS ? createAll(context) : made;
      disarm();
      if (result == GPGP_SUCCESS) break;
      ++failures;
      expectOneMessage(result, expected, n);
      if (made == GPGP_SUCCESS) { // the context stays usable
        scenario->destroy();
        const GpgpFrame frames[] = {{1, 0}, {2, 1}};
        for (const GpgpFrame& frame : frames) ASSERT_EQ(gpgpAdvance(context, &frame), GPGP_SUCCESS);
        EXPECT_EQ(deviceBytes(context), emptyBytes) << "n = " << n << ": device memory leaked";
        ASSERT_EQ(createAll(context), GPGP_SUCCESS) << "n = " << n;
        gpgpDestroyContext(context);
        scenario->asset = nullptr, scenario->recorder = nullptr, scenario->view = nullptr;
      }
      context = nullptr;
      ASSERT_TRUE(faults.host.empty()) << faults.host.size() << " host allocations leaked, n = " << n;
      ASSERT_TRUE(faults.gpu.empty()) << faults.gpu.size() << " device allocations leaked, n = " << n;
    }
    EXPECT_GT(failures, 3u) << "the sweep provoked nothing";

    for (uint32_t n = 1;; ++n) { // what was compiled before a failure is kept, so each pipeline is made once
      ASSERT_LT(n, 500u) << "prewarming never succeeds";
      arm(n);
      const GpgpResult result = scenario->prewarm();
      disarm();
      if (result == GPGP_SUCCESS) break;
      expectOneMessage(result, expected, n);
    }
    expectUsable(context, {3, 2});
    gpgpDestroyContext(context);
    scenario->asset = nullptr, scenario->recorder = nullptr, scenario->view = nullptr;
    EXPECT_TRUE(faults.host.empty());
    EXPECT_TRUE(faults.gpu.empty());
  }
};

TEST_P(FaultTest, EveryHostAllocation) {
  sweep(
      GPGP_ERROR_OUT_OF_HOST_MEMORY, false, [&](uint32_t n) { faults.hostCalls = 0, faults.hostFailAt = n; },
      [&] { faults.hostFailAt = 0; });
}

TEST_P(FaultTest, EveryDeviceAllocationOfTheEngine) {
  sweep(
      GPGP_ERROR_OUT_OF_DEVICE_MEMORY, true, [&](uint32_t n) { faults.gpuCalls = 0, faults.gpuFailAt = n; },
      [&] { faults.gpuFailAt = 0; });
}

TEST_P(FaultTest, EveryVulkanObject) {
  sweep(
      GPGP_ERROR_OUT_OF_DEVICE_MEMORY, false, [&](uint32_t n) { proxy.failCreation(n, VK_ERROR_OUT_OF_DEVICE_MEMORY); },
      [&] { proxy.failCreation(0, VK_SUCCESS); });
}

TEST_P(FaultTest, EveryCallThatLosesTheDevice) {
  sweep(
      GPGP_ERROR_DEVICE_LOST, false, [&](uint32_t n) { proxy.failCreation(n, VK_ERROR_DEVICE_LOST); },
      [&] { proxy.failCreation(0, VK_SUCCESS); });
}

INSTANTIATE_TEST_SUITE_P(Services, FaultTest, testing::ValuesIn(scenarioNames()),
                         [](const auto& service) { return service.param; });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(FaultTest);

} // namespace
