// A Vulkan device without a window, for the command, the tests and the benchmarks.
//
// Guarantees: everything made here is destroyed in order; validation messages are kept as text and can be asked for;
// several devices live side by side, in one thread or in many (each has its own function table). Failures throw
// std::runtime_error with a sentence that says what to do.
#pragma once
#include <gpgp/core.h>
#include <volk.h>

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace gpgp::host {

/// Throws std::runtime_error("what: VK_ERROR_...") where result is an error.
void check(VkResult result, const char* what);
/// The name of the usual results, "VkResult <number>" for others.
std::string resultName(VkResult result);

struct DeviceOptions {
  std::string device; ///< part of a name (any case) or an index; empty: $GPGP_DEVICE, else lavapipe, else the first
  bool validation = false; ///< Khronos validation layer with synchronisation validation
  uint32_t apiVersion = VK_API_VERSION_1_2;
  GpgpFeatures features = GPGP_FEATURE_ALL; ///< optional features to enable where the device offers them
};

/// What one can choose from.
struct DeviceSummary {
  uint32_t index = 0;
  std::string name;
  std::string driver;
  VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
  uint32_t apiVersion = 0;
};

/// All devices that the loader finds, in its order. Empty where there is no Vulkan loader.
std::vector<DeviceSummary> listDevices();

struct Queue {
  VkQueue queue = VK_NULL_HANDLE;
  uint32_t family = 0;
  VkQueueFlags flags = 0;
};

/// Instance functions, loaded for one instance: volk's globals belong to whichever instance was made last.
struct InstanceTable {
  PFN_vkDestroyInstance destroyInstance = nullptr;
  PFN_vkEnumeratePhysicalDevices enumeratePhysicalDevices = nullptr;
  PFN_vkGetPhysicalDeviceProperties2 getPhysicalDeviceProperties2 = nullptr;
  PFN_vkGetPhysicalDeviceFeatures2 getPhysicalDeviceFeatures2 = nullptr;
  PFN_vkGetPhysicalDeviceMemoryProperties getPhysicalDeviceMemoryProperties = nullptr;
  PFN_vkGetPhysicalDeviceFormatProperties getPhysicalDeviceFormatProperties = nullptr;
  PFN_vkGetPhysicalDeviceQueueFamilyProperties getPhysicalDeviceQueueFamilyProperties = nullptr;
  PFN_vkEnumerateDeviceExtensionProperties enumerateDeviceExtensionProperties = nullptr;
  PFN_vkCreateDevice createDevice = nullptr;
  PFN_vkCreateDebugUtilsMessengerEXT createDebugUtilsMessenger = nullptr;   // null without VK_EXT_debug_utils
  PFN_vkDestroyDebugUtilsMessengerEXT destroyDebugUtilsMessenger = nullptr; // null without VK_EXT_debug_utils
  PFN_vkSetDebugUtilsObjectNameEXT setDebugUtilsObjectName = nullptr;       // null without VK_EXT_debug_utils
};

class HeadlessDevice {
public:
  explicit HeadlessDevice(const DeviceOptions& options = {});
  ~HeadlessDevice();
  HeadlessDevice(const HeadlessDevice&) = delete;
  HeadlessDevice& operator=(const HeadlessDevice&) = delete;

  VkInstance instance() const { return instance_; }
  VkPhysicalDevice physicalDevice() const { return physicalDevice_; }
  VkDevice device() const { return device_; }
  const VolkDeviceTable& vk() const { return vk_; }
  const InstanceTable& vki() const { return vki_; }
  PFN_vkGetInstanceProcAddr getInstanceProcAddr() const;

  const VkPhysicalDeviceProperties& properties() const { return properties_; }
  const std::string& name() const { return name_; }
  /// In the order of listDevices.
  uint32_t index() const { return index_; }
  bool isSoftware() const { return properties_.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU; }
  /// What was enabled, as gpgpCreateContext wants to be told.
  GpgpFeatures features() const { return features_; }
  uint32_t apiVersion() const { return apiVersion_; }

  const Queue& graphics() const { return graphics_; } ///< graphics and compute
  /// A queue of a family with compute and without graphics, where the device has one.
  const std::optional<Queue>& computeOnly() const { return computeOnly_; }

  /// Filled in as far as the device goes; label, callbacks and budgets are the caller's.
  GpgpContextCreateInfo contextCreateInfo() const;

  /// Records into a fresh primary command buffer, submits it and waits.
  void submitAndWait(const std::function<void(VkCommandBuffer)>& record) { submitAndWait(graphics_, record); }
  void submitAndWait(const Queue& queue, const std::function<void(VkCommandBuffer)>& record);
  void waitIdle();

  /// Validation messages (warnings and errors) so far, oldest first. A clean run has none.
  std::vector<std::string> validationMessages() const;
  /// The same, and forgets them: for tests that provoke one.
  std::vector<std::string> takeValidationMessages();

  /// A name for debuggers and validation messages; without VK_EXT_debug_utils nothing happens.
  void setName(VkObjectType type, uint64_t handle, const std::string& name) const;
  /// The first memory type of typeBits with all of required and, if there is one, preferred too.
  uint32_t memoryType(uint32_t typeBits, VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred = 0) const;
  const VkPhysicalDeviceMemoryProperties& memoryProperties() const { return memoryProperties_; }

private:
  struct MessageLog {
    mutable std::mutex mutex;
    std::vector<std::string> messages;
  };
  static VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                  VkDebugUtilsMessageTypeFlagsEXT types,
                                                  const VkDebugUtilsMessengerCallbackDataEXT* data, void* userData);
  void createInstance(const DeviceOptions& options);
  void createDevice(const DeviceOptions& options);
  void destroy() noexcept;

  MessageLog log_;
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkPhysicalDevice physicalDevice_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  InstanceTable vki_;
  VolkDeviceTable vk_{};
  VkPhysicalDeviceProperties properties_{};
  VkPhysicalDeviceMemoryProperties memoryProperties_{};
  std::string name_;
  uint32_t index_ = 0;
  GpgpFeatures features_ = 0;
  bool debugUtils_ = false;
  uint32_t apiVersion_ = VK_API_VERSION_1_2;
  Queue graphics_;
  std::optional<Queue> computeOnly_;
};

} // namespace gpgp::host
