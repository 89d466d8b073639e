// `gpgp info`: the devices, what gpgp needs and could use of one, and which optional paths that means.
#include "cli/info/pipelines.h"
#include "cli/shared/command.h"
#include "cli/shared/session.h"
#include "host/device.h"

#include <array>
#include <sstream>

namespace gpgp::cli {
namespace {

struct Feature {
  GpgpFeatures bit;
  const char* key;
  const char* with;
  const char* without;
};

// What each optional feature changes. Every `without` is a tested fallback, not a refusal.
constexpr std::array kFeatures = {
    Feature{GPGP_FEATURE_DYNAMIC_RENDERING, "dynamicRendering",
            "canvases draw in dynamic rendering and in render passes", "canvases draw in render passes only"},
    Feature{GPGP_FEATURE_BUFFER_INT64_ATOMICS, "bufferInt64Atomics",
            "visibility draws triangles' depths and numbers at once",
            "visibility draws triangles' depths first and then their numbers"},
    Feature{GPGP_FEATURE_MULTIVIEW, "multiview", "one canvas draw serves both eyes of a multiview target",
            "canvases draw once for each eye"},
    Feature{GPGP_FEATURE_DEBUG_UTILS, "debugUtils", "objects and passes have names in debuggers",
            "objects and passes have no names in debuggers"},
};

const char* typeName(VkPhysicalDeviceType type) {
  switch (type) {
  case VK_PHYSICAL_DEVICE_TYPE_CPU: return "software";
  case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return "discrete";
  case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return "integrated";
  case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return "virtual";
  default: return "other";
  }
}

std::string versionText(uint32_t version) {
  std::ostringstream text;
  text << VK_API_VERSION_MAJOR(version) << '.' << VK_API_VERSION_MINOR(version) << '.' << VK_API_VERSION_PATCH(version);
  return text.str();
}

std::string libraryVersion() {
  const uint32_t version = gpgpGetVersion();
  std::ostringstream text;
  text << (version >> 22) << '.' << (version >> 12 & 0x3ffu) << '.' << (version & 0xfffu);
  return text.str();
}

Json deviceJson(const host::DeviceSummary& device) {
  return {{"index", device.index},
          {"name", device.name},
          {"driver", device.driver},
          {"type", typeName(device.type)},
          {"apiVersion", versionText(device.apiVersion)}};
}

Outcome info(host::HeadlessDevice& device) {
  const std::vector<host::DeviceSummary> devices = host::listDevices();
  GpgpRequirementsInfo query = GPGP_REQUIREMENTS_INFO_INIT;
  query.instance = device.instance();
  query.physicalDevice = device.physicalDevice();
  query.getInstanceProcAddr = device.getInstanceProcAddr();
  GpgpRequirements requirements = GPGP_REQUIREMENTS_INIT;
  const GpgpResult result = gpgpGetRequirements(&query, &requirements);
  if (result < 0 && result != GPGP_ERROR_MISSING_FEATURE)
    throw Failure(std::string("gpgpGetRequirements: ") + gpgpResultString(result));
  const GpgpFeatures used =
      (requirements.optionalFeatures & device.features()) | (device.features() & GPGP_FEATURE_DEBUG_UTILS);

  Outcome outcome;
  std::ostringstream text;
  Json list = Json::array();
  Json chosen;
  text << "gpgp " << libraryVersion() << "\n\ndevices:\n";
  for (const host::DeviceSummary& summary : devices) {
    list.push_back(deviceJson(summary));
    const bool isChosen = summary.index == device.index();
    if (isChosen) chosen = deviceJson(summary);
    text << (isChosen ? "* " : "  ") << summary.index << "  " << summary.name << "  (" << typeName(summary.type) << ", "
         << summary.driver << ", Vulkan " << versionText(summary.apiVersion) << ")\n";
  }
  Json features = Json::object(), paths = Json::object(), missing = Json::array();
  text << "\noptional features of " << device.name() << ", and what follows:\n";
  for (const Feature& feature : kFeatures) {
    const bool on = (used & feature.bit) != 0;
    features[feature.key] = on;
    paths[feature.key] = on ? feature.with : feature.without;
    text << (on ? "  yes  " : "  no   ") << feature.key << ": " << (on ? feature.with : feature.without) << '\n';
  }
  for (uint32_t i = 0; i < requirements.missingCount; ++i) missing.push_back(requirements.missing[i]);
  if (missing.empty())
    text << "\nThis device can run gpgp.\n";
  else
    text << "\nThis device cannot run gpgp; it lacks:\n";
  for (const Json& item : missing) text << "  " << item.get<std::string>() << '\n';
  const VkPhysicalDeviceLimits& limits = device.properties().limits;
  text << (device.computeOnly() ? "It has a compute-only queue family.\n" : "It has no compute-only queue family.\n");

  Json services = Json::array();
#ifdef GPGP_WITH_SPAWN
  services.push_back("spawn");
#endif
#ifdef GPGP_WITH_VECTOR
  services.push_back("vector");
#endif
#ifdef GPGP_WITH_VISIBILITY
  services.push_back("visibility");
#endif
  outcome.json = {{"version", libraryVersion()},
                  {"services", services},
                  {"device", chosen},
                  {"devices", list},
                  {"usable", missing.empty()},
                  {"missing", missing},
                  {"features", features},
                  {"paths", paths},
                  {"computeOnlyQueue", device.computeOnly().has_value()},
                  {"limits",
                   {{"maxComputeSharedMemorySize", limits.maxComputeSharedMemorySize},
                    {"maxComputeWorkGroupInvocations", limits.maxComputeWorkGroupInvocations},
                    {"maxStorageBufferRange", limits.maxStorageBufferRange},
                    {"maxPushConstantsSize", limits.maxPushConstantsSize}}}};
  outcome.text = text.str();
  return outcome;
}

} // namespace

Work addInfo(CLI::App& app) {
  CLI::App* command = app.add_subcommand("info", "What this machine offers, and what gpgp would use");
  auto pipelines = std::make_shared<bool>(false);
  command->add_flag(
      "--pipelines", *pipelines,
      "Instead: the pipelines of every kind of recorder, their SPIR-V and how long each takes to make, one "
      "after another. What the driver finds in its own cache on disk costs little: empty that first");
  command->footer("\nExamples:\n  gpgp info\n  gpgp info --device 1\n  gpgp info --json | jq .features\n"
                  "  gpgp info --pipelines");
  return [pipelines](const CommonOptions& options) {
    host::HeadlessDevice device(host::DeviceOptions{.device = options.device, .validation = options.validate});
    Outcome outcome = *pipelines ? listPipelines(device) : info(device);
    checkValidation(device);
    return outcome;
  };
}

} // namespace gpgp::cli
