// Which physical device a person means. lavapipe is the default: it is on every machine and gives the same pictures.
#include "host/select.h"

#include <algorithm>
#include <cctype>

namespace gpgp::host {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

template <class Function> void load(VkInstance instance, const char* name, Function& function, bool required = true) {
  function = reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
  if (!function && required) throw std::runtime_error(std::string("the Vulkan loader has no ") + name);
}

} // namespace

void loadVulkan() {
  static const VkResult result = volkInitialize(); // idempotent, but not safe to run twice at once
  if (result != VK_SUCCESS)
    throw std::runtime_error(
        "no Vulkan loader on this machine (Debian: apt-get install libvulkan1 mesa-vulkan-drivers)");
}

InstanceTable loadInstanceTable(VkInstance instance) {
  InstanceTable t;
  load(instance, "vkDestroyInstance", t.destroyInstance);
  load(instance, "vkEnumeratePhysicalDevices", t.enumeratePhysicalDevices);
  load(instance, "vkGetPhysicalDeviceProperties2", t.getPhysicalDeviceProperties2);
  load(instance, "vkGetPhysicalDeviceFeatures2", t.getPhysicalDeviceFeatures2);
  load(instance, "vkGetPhysicalDeviceMemoryProperties", t.getPhysicalDeviceMemoryProperties);
  load(instance, "vkGetPhysicalDeviceFormatProperties", t.getPhysicalDeviceFormatProperties);
  load(instance, "vkGetPhysicalDeviceQueueFamilyProperties", t.getPhysicalDeviceQueueFamilyProperties);
  load(instance, "vkEnumerateDeviceExtensionProperties", t.enumerateDeviceExtensionProperties);
  load(instance, "vkCreateDevice", t.createDevice);
  load(instance, "vkCreateDebugUtilsMessengerEXT", t.createDebugUtilsMessenger, false);
  load(instance, "vkDestroyDebugUtilsMessengerEXT", t.destroyDebugUtilsMessenger, false);
  load(instance, "vkSetDebugUtilsObjectNameEXT", t.setDebugUtilsObjectName, false);
  return t;
}

std::vector<VkPhysicalDevice> physicalDevices(const InstanceTable& vki, VkInstance instance) {
  uint32_t count = 0;
  check(vki.enumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> handles(count);
  if (count > 0) check(vki.enumeratePhysicalDevices(instance, &count, handles.data()), "vkEnumeratePhysicalDevices");
  handles.resize(count);
  return handles;
}

std::vector<DeviceSummary> summarise(const InstanceTable& vki, const std::vector<VkPhysicalDevice>& handles) {
  std::vector<DeviceSummary> devices;
  for (VkPhysicalDevice handle : handles) {
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver};
    vki.getPhysicalDeviceProperties2(handle, &properties);
    DeviceSummary device;
    device.index = static_cast<uint32_t>(devices.size());
    device.name = properties.properties.deviceName;
    device.driver = std::string(driver.driverName) + (driver.driverInfo[0] ? " " : "") + driver.driverInfo;
    device.type = properties.properties.deviceType;
    device.apiVersion = properties.properties.apiVersion;
    devices.push_back(std::move(device));
  }
  return devices;
}

uint32_t selectDevice(const std::vector<DeviceSummary>& devices, std::string_view wanted) {
  if (devices.empty())
    throw std::runtime_error("the Vulkan loader finds no device (Debian: apt-get install mesa-vulkan-drivers)");
  if (wanted.empty()) {
    for (const DeviceSummary& device : devices)
      if (device.type == VK_PHYSICAL_DEVICE_TYPE_CPU) return device.index;
    return 0;
  }
  const bool isIndex = wanted.size() < 10 &&
                       std::all_of(wanted.begin(), wanted.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  if (isIndex && std::stoul(std::string(wanted)) < devices.size())
    return static_cast<uint32_t>(std::stoul(std::string(wanted)));
  if (!isIndex)
    for (const DeviceSummary& device : devices)
      if (lower(device.name + " " + device.driver).find(lower(wanted)) != std::string::npos) return device.index;
  std::string message = "no device \"" + std::string(wanted) + "\"; there are:";
  for (const DeviceSummary& device : devices)
    message.append(" ").append(std::to_string(device.index)).append(": ").append(device.name).append(";");
  message.back() = '.';
  throw std::runtime_error(message);
}

std::vector<DeviceSummary> listDevices() {
  try {
    loadVulkan();
  } catch (const std::runtime_error&) {
    return {};
  }
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = VK_API_VERSION_1_2;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  VkInstance instance = VK_NULL_HANDLE;
  check(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
  const InstanceTable vki = loadInstanceTable(instance);
  std::vector<DeviceSummary> devices;
  try {
    devices = summarise(vki, physicalDevices(vki, instance));
  } catch (...) {
    vki.destroyInstance(instance, nullptr);
    throw;
  }
  vki.destroyInstance(instance, nullptr);
  return devices;
}

} // namespace gpgp::host
