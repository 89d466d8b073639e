// A QVulkanInstance that gpgp can work with, and, where it is asked for, the validation layer with its messages
// counted.
#pragma once
#include <QtGui/QVulkanFunctions>
#include <QtGui/QVulkanInstance>
#include <QtQuick/QQuickGraphicsConfiguration>

#include <atomic>
#include <cstdio>
#include <stdexcept>

namespace gpgp::sample {

class SampleInstance {
public:
  explicit SampleInstance(bool validate) {
    QByteArrayList extensions = QQuickGraphicsConfiguration::preferredInstanceExtensions();
    if (validate) {
      qputenv("VK_LAYER_ENABLES", "VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT");
      instance_.setLayers({"VK_LAYER_KHRONOS_validation"});
      instance_.setFlags(QVulkanInstance::NoDebugOutputRedirect);
      extensions << VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    }
    instance_.setApiVersion(QVersionNumber(1, 2)); // gpgp's; Qt's own default is 1.0
    instance_.setExtensions(extensions);
    if (!instance_.create()) throw std::runtime_error("no Vulkan 1.2: error " + std::to_string(instance_.errorCode()));
    if (!validate) return;
    if (!instance_.layers().contains("VK_LAYER_KHRONOS_validation"))
      throw std::runtime_error("no validation layer (Debian: vulkan-validationlayers)");
    VkDebugUtilsMessengerCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    info.pfnUserCallback = onMessage;
    info.pUserData = this;
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        instance_.getInstanceProcAddr("vkCreateDebugUtilsMessengerEXT"));
    if (create(instance_.vkInstance(), &info, nullptr, &messenger_) != VK_SUCCESS)
      throw std::runtime_error("no messages of the validation layer");
  }
  ~SampleInstance() {
    if (!messenger_) return;
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        instance_.getInstanceProcAddr("vkDestroyDebugUtilsMessengerEXT"));
    destroy(instance_.vkInstance(), messenger_, nullptr);
  }
  SampleInstance(const SampleInstance&) = delete;
  SampleInstance& operator=(const SampleInstance&) = delete;

  QVulkanInstance& get() { return instance_; }
  uint32_t validationMessages() const { return messages_; }

private:
  static VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                  VkDebugUtilsMessageTypeFlagsEXT,
                                                  const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    std::fprintf(stderr, "validation: %s\n", data->pMessage);
    ++static_cast<SampleInstance*>(user)->messages_;
    return VK_FALSE;
  }
  QVulkanInstance instance_;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::atomic<uint32_t> messages_{0};
};

} // namespace gpgp::sample
