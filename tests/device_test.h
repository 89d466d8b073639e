// A device with validation and a context, which the tests of a suite share: on software devices it is making pipelines
// that takes time, so a recorder is made once for each create info. Any validation message fails the test.
#pragma once
#include "host/device.h"

#include <gpgp/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace gpgp::test {

/// Vulkan as the library sees it by the environment.
/// GPGP_TEST_HARDWARE: all devices say that they are GPUs, so that software devices run the passes that they have
/// others for. GPGP_TEST_HARDWARE=subgroups: whose subgroups are of 32, for those shaders that count on having some, of
/// whatever size. GPGP_TEST_STORAGE_BUFFERS: as many storage buffers a stage, if the device has more.
struct AsAnother {
  static inline PFN_vkGetInstanceProcAddr real = nullptr;
  static inline PFN_vkGetPhysicalDeviceProperties2 realProperties = nullptr;

  static VKAPI_ATTR void VKAPI_CALL properties(VkPhysicalDevice device, VkPhysicalDeviceProperties2* found) {
    realProperties(device, found);
    if (const char* count = std::getenv("GPGP_TEST_STORAGE_BUFFERS")) {
      uint32_t& limit = found->properties.limits.maxPerStageDescriptorStorageBuffers;
      limit = std::min(limit, static_cast<uint32_t>(std::strtoul(count, nullptr, 10)));
    }
    const char* hardware = std::getenv("GPGP_TEST_HARDWARE");
    if (!hardware) return;
    found->properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    if (std::string_view(hardware) != "subgroups") return;
    for (auto* next = static_cast<VkBaseOutStructure*>(found->pNext); next; next = next->pNext)
      if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_PROPERTIES) {
        auto* sizes = reinterpret_cast<VkPhysicalDeviceSubgroupSizeControlProperties*>(next);
        sizes->minSubgroupSize = sizes->maxSubgroupSize = 32;
      }
  }
  static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL lookUp(VkInstance instance, const char* name) {
    const PFN_vkVoidFunction found = real(instance, name);
    if (std::string_view(name) != "vkGetPhysicalDeviceProperties2") return found;
    realProperties = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties2>(found);
    return reinterpret_cast<PFN_vkVoidFunction>(&properties);
  }
};

struct SharedDevice {
  host::HeadlessDevice device{host::DeviceOptions{.validation = true}};
  GpgpContext context = nullptr;
  GpgpFeatures features = 0;
  std::vector<std::string> messages; ///< of the context: "function: text"
  std::map<std::string, GpgpRecorder> recorders;
  uint64_t frame = 0;

  explicit SharedDevice(const char* label) {
    GpgpContextCreateInfo info = device.contextCreateInfo();
    info.label = label;
    if (std::getenv("GPGP_TEST_HARDWARE") || std::getenv("GPGP_TEST_STORAGE_BUFFERS")) {
      AsAnother::real = info.getInstanceProcAddr;
      info.getInstanceProcAddr = &AsAnother::lookUp;
    }
    if (std::getenv("GPGP_TEST_PLAIN")) info.features = 0; // as on devices that offer nothing optional
    features = info.features;
    info.messageUserData = &messages;
    info.messageFn = [](void* user, const GpgpMessage* m) {
      static_cast<std::vector<std::string>*>(user)->push_back(std::string(m->function) + ": " + m->text);
    };
    EXPECT_EQ(gpgpCreateContext(&info, &context), GPGP_SUCCESS);
  }
  ~SharedDevice() {
    device.waitIdle();
    gpgpDestroyContext(context);
    for (const std::string& message : device.validationMessages()) ADD_FAILURE() << message;
  }
};

struct DeviceTest : testing::Test {
  static void SetUpTestSuite() { suiteDevice = std::make_unique<SharedDevice>("test"); }
  static void TearDownTestSuite() { suiteDevice.reset(); }

  host::HeadlessDevice& device = suiteDevice->device;
  const GpgpContext context = suiteDevice->context;
  const GpgpFeatures contextFeatures = suiteDevice->features; ///< of the context
  std::vector<std::string>& messages = suiteDevice->messages;

  void SetUp() override { messages.clear(); }
  void TearDown() override {
    device.waitIdle();
    for (const std::string& message : device.takeValidationMessages()) ADD_FAILURE() << message;
  }
  std::string lastMessage() const { return messages.empty() ? "" : messages.back(); }

  GpgpFrame advance(uint64_t inFlight = 1) {
    const uint64_t frame = ++suiteDevice->frame;
    const GpgpFrame f{frame, frame > inFlight ? frame - inFlight : 0};
    EXPECT_EQ(gpgpAdvance(context, &f), GPGP_SUCCESS);
    return f;
  }

  /// The recorder that `create` makes of such an info, prewarmed for the target; belongs to the suite.
  template <class Info>
  GpgpRecorder recorder(GpgpResult(GPGP_CALL* create)(GpgpContext, const Info*, GpgpRecorder*), const Info& info,
                        const GpgpTargetInfo* target = nullptr) {
    std::string key(reinterpret_cast<const char*>(&info), sizeof info);
    if (target) key.append(reinterpret_cast<const char*>(target), sizeof *target);
    GpgpRecorder& made = suiteDevice->recorders[key];
    if (made) return made;
    EXPECT_EQ(create(context, &info, &made), GPGP_SUCCESS) << lastMessage();
    GpgpPrewarmInfo prewarm = GPGP_PREWARM_INFO_INIT;
    prewarm.targets = target;
    prewarm.targetCount = target ? 1 : 0;
    EXPECT_EQ(gpgpPrewarm(made, &prewarm), GPGP_SUCCESS) << lastMessage();
    return made;
  }

private:
  inline static std::unique_ptr<SharedDevice> suiteDevice;
};

} // namespace gpgp::test
