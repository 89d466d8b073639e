// Each service on devices of other classes (tests/device_profile.h): it does its job with the same results, or the
// context's creation says by name what the device lacks.
#include "../device_profile.h"
#include "scenarios.h"

#include <gpgp/gpgp.h>
#include <gtest/gtest.h>

namespace {
using namespace gpgp;
using namespace gpgp::test;

constexpr uint32_t kMany = UINT32_MAX, kRange = 1u << 27;
constexpr DeviceProfile kProfiles[] = {
    {"as_it_is", VK_PHYSICAL_DEVICE_TYPE_CPU, kMany, kMany, kMany, true, true, true},
    {"nothing_optional", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, 18, 4, kRange, false, false, false},
    {"moltenvk", VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU, 31, 8, kRange, true, false, true},
    {"mobile_16", VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU, 16, 4, kRange, false, false, true},
    {"least_of_vulkan", VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU, 4, 4, kRange, false, false, false},
};

struct ProfilesTest : testing::TestWithParam<std::string> {
  host::HeadlessDevice& device = sharedDevice();

  struct Outcome {
    std::string missing; ///< not empty: what creation said
    std::vector<uint32_t> results;
  };
  Outcome run(const DeviceProfile& profile) {
    std::vector<std::string> messages;
    const ProfiledVulkan vulkan(profile, device.getInstanceProcAddr());
    GpgpContextCreateInfo info = scenarioContextInfo(device, &messages);
    info.getInstanceProcAddr = ProfiledVulkan::getInstanceProcAddr();
    info.features = ProfiledVulkan::featuresOf(profile, info.features);
    GpgpContext context = nullptr;
    Outcome outcome;
    if (const GpgpResult made = gpgpCreateContext(&info, &context); made != GPGP_SUCCESS) {
      EXPECT_EQ(made, GPGP_ERROR_MISSING_FEATURE);
      outcome.missing = messages.empty() ? "nothing was said" : messages.back();
      return outcome;
    }
    const auto scenario = makeScenario(GetParam(), device);
    EXPECT_EQ(scenario->createAsset(context), GPGP_SUCCESS);
    const GpgpResult made = scenario->createRecorder(context, {"recorder", device.graphics().family, 0, VK_FALSE});
    if (made == GPGP_ERROR_UNSUPPORTED) {
      outcome.missing = messages.empty() ? "nothing was said" : messages.back();
      scenario->destroy();
      gpgpDestroyContext(context);
      return outcome;
    }
    EXPECT_EQ(made, GPGP_SUCCESS);
    EXPECT_EQ(scenario->createView(context), GPGP_SUCCESS);
    EXPECT_EQ(scenario->prewarm(), GPGP_SUCCESS);
    const GpgpFrame frame{1, 0};
    EXPECT_EQ(gpgpAdvance(context, &frame), GPGP_SUCCESS);
    scenario->clearOutputs();
    device.submitAndWait([&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordUpload(context, cmd, &frame, 0, nullptr), GPGP_SUCCESS);
      EXPECT_EQ(scenario->record(cmd, frame, {}), GPGP_SUCCESS);
    });
    outcome.results = scenario->results();
    scenario->destroy();
    gpgpDestroyContext(context);
    for (const std::string& message : device.takeValidationMessages()) ADD_FAILURE() << message;
    return outcome;
  }
};

TEST_P(ProfilesTest, ServicesRunOrSayWhatIsMissing) {
  const Outcome wanted = run(kProfiles[0]);
  ASSERT_EQ(wanted.missing, "");
  for (const DeviceProfile& profile : std::span(kProfiles).subspan(1)) {
    SCOPED_TRACE(profile.name);
    const Outcome found = run(profile);
    std::printf("%s, %s: %s\n", profile.name, GetParam().c_str(),
                found.missing.empty() ? "runs" : found.missing.c_str());
    if (found.missing.empty()) {
      EXPECT_EQ(found.results, wanted.results);
    } else {
      EXPECT_NE(found.missing.find("maxPerStageDescriptorStorageBuffers"), std::string::npos) << found.missing;
    }
    if (profile.storageBuffers >= (GetParam() == "vector" ? 18 : 16)) {
      EXPECT_EQ(found.missing, "") << "the contract promises this device";
    }
  }
}

// What an engine learns before it creates a device.
TEST(Profiles, RequirementsNameEachLimit) {
  host::HeadlessDevice& device = sharedDevice();
  const ProfiledVulkan vulkan(kProfiles[4], device.getInstanceProcAddr());
  GpgpRequirementsInfo info = GPGP_REQUIREMENTS_INFO_INIT;
  info.instance = device.instance();
  info.physicalDevice = device.physicalDevice();
  info.getInstanceProcAddr = ProfiledVulkan::getInstanceProcAddr();
  GpgpRequirements requirements = GPGP_REQUIREMENTS_INIT;
  ASSERT_EQ(gpgpGetRequirements(&info, &requirements), GPGP_ERROR_MISSING_FEATURE);
  ASSERT_EQ(requirements.missingCount, 1u);
  EXPECT_STREQ(requirements.missing[0], "maxPerStageDescriptorStorageBuffers >= 16");
  EXPECT_EQ(requirements.optionalFeatures, 0u);
}

INSTANTIATE_TEST_SUITE_P(Services, ProfilesTest, testing::ValuesIn(scenarioNames()),
                         [](const auto& service) { return service.param; });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ProfilesTest);
} // namespace
