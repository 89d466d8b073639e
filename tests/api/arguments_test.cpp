// Bad arguments: each returns its documented error with one message that names the culprit, and changes nothing.
#include "host/frames.h"
#include "scenarios.h"
#include "vulkan_proxy.h"

#include <gpgp/gpgp.h>
#include <gtest/gtest.h>

namespace {
using namespace gpgp;
using namespace gpgp::test;

struct ArgumentsTest : testing::Test {
  host::HeadlessDevice& device = sharedDevice();
  VulkanProxy proxy{device};
  std::vector<std::string> messages;
  GpgpContext context = nullptr;

  void SetUp() override {
    GpgpContextCreateInfo info = goodInfo();
    ASSERT_EQ(gpgpCreateContext(&info, &context), GPGP_SUCCESS);
  }
  void TearDown() override {
    gpgpDestroyContext(context);
    for (const std::string& message : device.takeValidationMessages()) ADD_FAILURE() << message;
  }
  GpgpContextCreateInfo goodInfo() {
    GpgpContextCreateInfo info = scenarioContextInfo(device, &messages);
    info.getInstanceProcAddr = VulkanProxy::getInstanceProcAddr();
    return info;
  }
  /// The call failed as documented and said so once, naming `culprit`.
  void expectError(GpgpResult result, GpgpResult expected, const std::string& culprit) {
    EXPECT_EQ(result, expected) << gpgpResultString(result);
    ASSERT_EQ(messages.size(), 1u) << culprit;
    EXPECT_NE(messages[0].find(culprit), std::string::npos) << messages[0] << " does not name " << culprit;
    messages.clear();
  }
};

TEST_F(ArgumentsTest, CreateContext) {
  GpgpContext made = nullptr;
  const auto bad = [&](auto&& change, GpgpResult expected, const std::string& culprit) {
    GpgpContextCreateInfo info = goodInfo();
    change(info);
    expectError(gpgpCreateContext(&info, &made), expected, culprit);
    EXPECT_EQ(made, nullptr) << culprit;
  };
  EXPECT_EQ(gpgpCreateContext(nullptr, &made), GPGP_ERROR_INVALID_ARGUMENT);
  GpgpContextCreateInfo wrongType = goodInfo();
  wrongType.sType = 12345;
  EXPECT_EQ(gpgpCreateContext(&wrongType, &made), GPGP_ERROR_INVALID_STRUCT);
  EXPECT_TRUE(messages.empty()) << "the callback of a struct of unknown type must not be trusted";
  GpgpContextCreateInfo good = goodInfo();
  expectError(gpgpCreateContext(&good, nullptr), GPGP_ERROR_INVALID_ARGUMENT, "context");
  bad([&](auto& i) { i.pNext = &i; }, GPGP_ERROR_INVALID_STRUCT, "pNext");
  bad([](auto& i) { i.device = VK_NULL_HANDLE; }, GPGP_ERROR_INVALID_ARGUMENT, "device");
  bad([](auto& i) { i.getInstanceProcAddr = nullptr; }, GPGP_ERROR_INVALID_ARGUMENT, "getInstanceProcAddr");
  bad([](auto& i) { i.features = ~GpgpFeatures(0); }, GPGP_ERROR_INVALID_ARGUMENT, "features");
  bad([](auto& i) { i.apiVersion = VK_API_VERSION_1_1; }, GPGP_ERROR_MISSING_FEATURE, "1.2");
  bad([](auto& i) { i.maxFramesInFlight = 9; }, GPGP_ERROR_INVALID_ARGUMENT, "maxFramesInFlight");
  bad([](auto& i) { i.maxRecordingsPerFrame = 1u << 20; }, GPGP_ERROR_INVALID_ARGUMENT, "maxRecordingsPerFrame");
  bad([](auto& i) { i.pipelineCacheSize = 4; }, GPGP_ERROR_INVALID_ARGUMENT, "pipelineCacheData");
  const GpgpHostAllocator half{};
  bad([&](auto& i) { i.hostAllocator = &half; }, GPGP_ERROR_INVALID_ARGUMENT, "hostAllocator");
  const GpgpGpuAllocator halfGpu{};
  bad([&](auto& i) { i.gpuAllocator = &halfGpu; }, GPGP_ERROR_INVALID_ARGUMENT, "gpuAllocator");
}

TEST_F(ArgumentsTest, Requirements) {
  GpgpRequirementsInfo info = GPGP_REQUIREMENTS_INFO_INIT;
  GpgpRequirements requirements = GPGP_REQUIREMENTS_INIT;
  EXPECT_EQ(gpgpGetRequirements(&info, &requirements), GPGP_ERROR_INVALID_ARGUMENT);
  info.instance = device.instance();
  info.physicalDevice = device.physicalDevice();
  info.getInstanceProcAddr = device.getInstanceProcAddr();
  EXPECT_EQ(gpgpGetRequirements(&info, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  requirements.sType = 0;
  EXPECT_EQ(gpgpGetRequirements(&info, &requirements), GPGP_ERROR_INVALID_STRUCT);
  requirements = GPGP_REQUIREMENTS_INIT;
  ASSERT_EQ(gpgpGetRequirements(&info, &requirements), GPGP_SUCCESS);
  EXPECT_EQ(requirements.missingCount, 0u);
  EXPECT_EQ(requirements.requiredFeatures, 0u);
  EXPECT_GE(requirements.apiVersion, VK_API_VERSION_1_2);
}

TEST_F(ArgumentsTest, ADeviceThatLacksLimitsIsRefusedByName) {
  // A device whose limits were made smaller on the way.
  static PFN_vkGetInstanceProcAddr real;
  real = device.getInstanceProcAddr();
  const PFN_vkGetInstanceProcAddr lookUp = [](VkInstance instance, const char* name) -> PFN_vkVoidFunction {
    if (std::string_view(name) != "vkGetPhysicalDeviceProperties2") return real(instance, name);
    const PFN_vkGetPhysicalDeviceProperties2 poor = [](VkPhysicalDevice, VkPhysicalDeviceProperties2* properties) {
      properties->properties.apiVersion = VK_API_VERSION_1_1;
      properties->properties.limits = {};
    };
    return reinterpret_cast<PFN_vkVoidFunction>(poor);
  };
  GpgpRequirementsInfo info = GPGP_REQUIREMENTS_INFO_INIT;
  info.instance = device.instance();
  info.physicalDevice = device.physicalDevice();
  info.getInstanceProcAddr = lookUp;
  GpgpRequirements requirements = GPGP_REQUIREMENTS_INIT;
  EXPECT_EQ(gpgpGetRequirements(&info, &requirements), GPGP_ERROR_MISSING_FEATURE);
  ASSERT_GE(requirements.missingCount, 7u);
  EXPECT_STREQ(requirements.missing[0], "Vulkan >= 1.2");
  EXPECT_STREQ(requirements.missing[1], "maxPushConstantsSize >= 128");
  GpgpContextCreateInfo create = goodInfo();
  create.getInstanceProcAddr = lookUp;
  GpgpContext made = nullptr;
  expectError(gpgpCreateContext(&create, &made), GPGP_ERROR_MISSING_FEATURE, "Vulkan >= 1.2");
}

TEST_F(ArgumentsTest, Frames) {
  GpgpFrame frame{5, 4};
  ASSERT_EQ(gpgpAdvance(context, &frame), GPGP_SUCCESS);
  expectError(gpgpAdvance(context, nullptr), GPGP_ERROR_INVALID_ARGUMENT, "frame");
  frame = {6, 6};
  expectError(gpgpAdvance(context, &frame), GPGP_ERROR_INVALID_ARGUMENT, "safe");
  frame = {4, 3};
  expectError(gpgpAdvance(context, &frame), GPGP_ERROR_INVALID_ARGUMENT, "grow");
  frame = {9, 4};
  expectError(gpgpAdvance(context, &frame), GPGP_ERROR_INVALID_ARGUMENT, "frames in flight");
  EXPECT_EQ(gpgpAdvance(nullptr, &frame), GPGP_ERROR_INVALID_HANDLE);
  frame = {5, 4}; // the bad ones changed nothing
  EXPECT_EQ(gpgpAdvance(context, &frame), GPGP_SUCCESS);
  expectError(gpgpRecordUpload(context, VK_NULL_HANDLE, &frame, 0, nullptr), GPGP_ERROR_INVALID_ARGUMENT,
              "commandBuffer");
}

TEST_F(ArgumentsTest, HandlesOfNothing) {
  GpgpFrame frame{1, 0};
  VkBool32 resident = VK_FALSE;
  VkDeviceSize size = 0;
  uint32_t count = 0;
  EXPECT_EQ(gpgpGetResidency(nullptr, &resident), GPGP_ERROR_INVALID_HANDLE);
  EXPECT_EQ(gpgpPrewarm(nullptr, nullptr), GPGP_ERROR_INVALID_HANDLE);
  EXPECT_EQ(gpgpGetScratchSize(nullptr, &size, nullptr, nullptr), GPGP_ERROR_INVALID_HANDLE);
  EXPECT_EQ(gpgpGetPasses(nullptr, &count, nullptr), GPGP_ERROR_INVALID_HANDLE);
  EXPECT_EQ(gpgpGetPipelines(nullptr, &count, nullptr), GPGP_ERROR_INVALID_HANDLE);
  EXPECT_EQ(gpgpRecordUpload(nullptr, VK_NULL_HANDLE, &frame, 0, nullptr), GPGP_ERROR_INVALID_HANDLE);
  gpgpDestroyAsset(nullptr);
  gpgpDestroyRecorder(nullptr);
  gpgpDestroyHistory(nullptr);
  gpgpDestroyContext(nullptr);
  EXPECT_TRUE(messages.empty());
}

// ---------------------------------------------------------------- on every service

struct ServiceArgumentsTest : ArgumentsTest, testing::WithParamInterface<std::string> {
  std::unique_ptr<Scenario> scenario;
  GpgpFrame frame{1, 0};

  void SetUp() override {
    ArgumentsTest::SetUp();
    scenario = makeScenario(GetParam(), device);
    ASSERT_EQ(scenario->createAsset(context), GPGP_SUCCESS);
    ASSERT_EQ(scenario->createRecorder(context, {"recorder", device.graphics().family, 0, VK_FALSE}), GPGP_SUCCESS);
    ASSERT_EQ(scenario->createView(context), GPGP_SUCCESS);
    ASSERT_EQ(scenario->prewarm(), GPGP_SUCCESS);
    ASSERT_EQ(gpgpAdvance(context, &frame), GPGP_SUCCESS);
    device.submitAndWait(
        [&](VkCommandBuffer cmd) { ASSERT_EQ(gpgpRecordUpload(context, cmd, &frame, 0, nullptr), GPGP_SUCCESS); });
  }
  /// Recording with what `change` did fails as documented, says so once, and records nothing.
  void expectRefused(GpgpResult expected, const std::string& culprit, const GpgpRecordingInfo& base = {}) {
    host::FrameRing ring(device, 1);
    const VkCommandBuffer cmd = ring.begin();
    proxy.clear();
    expectError(scenario->record(cmd, frame, base), expected, culprit);
    EXPECT_TRUE(proxy.calls.empty()) << "recorded " << proxy.calls.front().name;
    ring.drop();
  }
};

TEST_P(ServiceArgumentsTest, DestroyedAndExchangedHandles) {
  const GpgpAsset asset = scenario->asset;
  const GpgpRecorder recorder = scenario->recorder;
  scenario->asset = nullptr;
  expectRefused(GPGP_ERROR_INVALID_HANDLE, "NULL");
  scenario->asset = reinterpret_cast<GpgpAsset>(recorder); // a recorder where an asset belongs
  expectRefused(GPGP_ERROR_INVALID_HANDLE, "expected a");
  scenario->asset = asset;
  scenario->recorder = reinterpret_cast<GpgpRecorder>(asset);
  expectRefused(GPGP_ERROR_INVALID_HANDLE, "expected a");
  scenario->recorder = recorder;
  gpgpDestroyAsset(asset);
  expectRefused(GPGP_ERROR_INVALID_HANDLE, "destroyed");
  messages.clear();
  EXPECT_EQ(gpgpPrewarm(reinterpret_cast<GpgpRecorder>(scenario->view ? scenario->view : nullptr), nullptr),
            GPGP_ERROR_INVALID_HANDLE);
}

TEST_P(ServiceArgumentsTest, HandlesOfAnotherContext) {
  GpgpContextCreateInfo info = goodInfo();
  GpgpContext other = nullptr;
  ASSERT_EQ(gpgpCreateContext(&info, &other), GPGP_SUCCESS);
  const GpgpAsset mine = scenario->asset;
  ASSERT_EQ(scenario->createAsset(other), GPGP_SUCCESS);
  expectRefused(GPGP_ERROR_INVALID_HANDLE, "another context");
  scenario->asset = mine;
  gpgpDestroyContext(other);
}

TEST_P(ServiceArgumentsTest, FramesScratchAndTimestamps) {
  frame.current = 2;
  expectRefused(GPGP_ERROR_INVALID_ARGUMENT, "gpgpAdvance");
  frame.current = 1;
  GpgpRecordingInfo base{};
  base.accessMode = 1ull << 63;
  expectRefused(GPGP_ERROR_INVALID_ARGUMENT, "accessMode", base);
  base = {};
  base.timestamps.queryPool = reinterpret_cast<VkQueryPool>(uintptr_t(1));
  base.timestamps.queryCount = 1;
  expectRefused(GPGP_ERROR_INVALID_ARGUMENT, "queryCount", base);
  messages.clear();
  EXPECT_EQ(scenario->record(VK_NULL_HANDLE, frame, {}), GPGP_ERROR_INVALID_ARGUMENT);
  messages.clear();

  const GpgpRecorder mine = scenario->recorder;
  ASSERT_EQ(scenario->createRecorder(context, {"scratchless", device.graphics().family, 0, VK_TRUE}), GPGP_SUCCESS);
  ASSERT_EQ(scenario->prewarm(), GPGP_SUCCESS);
  expectRefused(GPGP_ERROR_INVALID_ARGUMENT, "scratch.buffer");
  VkDeviceSize size = 0, alignment = 0;
  VkBufferUsageFlags usage = 0;
  ASSERT_EQ(gpgpGetScratchSize(scenario->recorder, &size, &alignment, &usage), GPGP_SUCCESS);
  host::Buffer scratch(device, size + alignment, usage);
  base = {};
  base.scratch = scratch.range({}, {}, 0, size - 4);
  expectRefused(GPGP_ERROR_INVALID_ARGUMENT, "scratch.size", base);
  base.scratch = scratch.range({}, {}, 4, size);
  expectRefused(GPGP_ERROR_INVALID_ARGUMENT, "scratch.offset", base);
  gpgpDestroyRecorder(scenario->recorder);
  scenario->recorder = mine;
}

TEST_P(ServiceArgumentsTest, RecordersOnFamiliesThatDoNotExist) {
  const GpgpRecorder mine = scenario->recorder;
  expectError(scenario->createRecorder(context, {"nowhere", 1000, 0, VK_FALSE}), GPGP_ERROR_INVALID_ARGUMENT,
              "queueFamily");
  EXPECT_EQ(scenario->recorder, mine) << "a failed creation must not touch the handle";
}

INSTANTIATE_TEST_SUITE_P(Services, ServiceArgumentsTest, testing::ValuesIn(scenarioNames()),
                         [](const auto& service) { return service.param; });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ServiceArgumentsTest);

} // namespace
