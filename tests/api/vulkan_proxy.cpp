#include "vulkan_proxy.h"

#include "core/vulkan_table.h"
#include "counting_new.h"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <utility>

namespace gpgp::test {
namespace {

VulkanProxy* current = nullptr; // the functions below have no user data
std::mutex mutex;

template <class... A> void describe(LoggedCall&, A...) {}
void describe(LoggedCall& call, VkCommandBuffer, VkPipelineBindPoint point, VkPipeline) { call.bindPoint = point; }
void describe(LoggedCall& call, VkCommandBuffer, VkPipelineBindPoint point, VkPipelineLayout, uint32_t first,
              uint32_t count, const VkDescriptorSet*, uint32_t, const uint32_t*) {
  call.bindPoint = point;
  call.firstSet = first;
  call.setCount = count;
}
void describe(LoggedCall& call, VkCommandBuffer, VkPipelineStageFlags source, VkPipelineStageFlags target,
              VkDependencyFlags, uint32_t memoryCount, const VkMemoryBarrier* memory, uint32_t,
              const VkBufferMemoryBarrier*, uint32_t imageCount, const VkImageMemoryBarrier* images) {
  call.sourceStages = source;
  call.targetStages = target;
  for (uint32_t i = 0; i < memoryCount; ++i) {
    call.sourceAccess |= memory[i].srcAccessMask;
    call.targetAccess |= memory[i].dstAccessMask;
  }
  call.imageCount = std::min(imageCount, static_cast<uint32_t>(call.images.size()));
  std::copy_n(images, call.imageCount, call.images.begin());
}

bool creates(const char* name) {
  return std::strcmp(name, "vkGetPipelineCacheData") == 0 || std::strncmp(name, "vkCreate", 8) == 0 ||
         std::strncmp(name, "vkAllocate", 10) == 0 || std::strncmp(name, "vkBind", 6) == 0 ||
         std::strncmp(name, "vkMap", 5) == 0;
}

template <class Tag, class Function> struct Wrap;
template <class Tag, class R, class... A> struct Wrap<Tag, R(VKAPI_PTR*)(A...)> {
  static inline R(VKAPI_PTR* real)(A...) = nullptr;
  static VKAPI_ATTR R VKAPI_CALL call(A... arguments) {
    {
      const std::lock_guard lock(mutex);
      const UncountedNew log;
      LoggedCall logged;
      logged.name = Tag::name;
      describe(logged, arguments...);
      current->calls.push_back(logged);
      if constexpr (std::is_same_v<R, VkResult>)
        if (creates(Tag::name) && ++current->creations >= current->failAt && current->failAt) return current->failWith;
    }
    if (current->inNextCall) std::exchange(current->inNextCall, nullptr)();
    const UncountedNew driver; // what Vulkan allocates is not the library's
    return real(arguments...);
  }
};

#define X(function)                                                                                                    \
  struct function##Tag {                                                                                               \
    static constexpr const char* name = "vk" #function;                                                                \
  };                                                                                                                   \
  using function##Wrap = Wrap<function##Tag, PFN_vk##function>;
GPGP_INSTANCE_FUNCTIONS(X)
GPGP_DEVICE_FUNCTIONS(X)
GPGP_OPTIONAL_FUNCTIONS(X)
#undef X

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL deviceProc(VkDevice device, const char* name) {
  const PFN_vkVoidFunction found = current->realDevice(device, name);
  if (!found) return nullptr;
#define X(function)                                                                                                    \
  if (std::strcmp(name, "vk" #function) == 0) {                                                                        \
    function##Wrap::real = reinterpret_cast<PFN_vk##function>(found);                                                  \
    return reinterpret_cast<PFN_vkVoidFunction>(&function##Wrap::call);                                                \
  }
  GPGP_DEVICE_FUNCTIONS(X)
  GPGP_OPTIONAL_FUNCTIONS(X)
#undef X
  return found; // not in the library's table: handed out unlogged, and a test looks for that
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instanceProc(VkInstance instance, const char* name) {
  const PFN_vkVoidFunction found = current->real(instance, name);
  if (!found) return nullptr;
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) {
    current->realDevice = reinterpret_cast<PFN_vkGetDeviceProcAddr>(found);
    return reinterpret_cast<PFN_vkVoidFunction>(&deviceProc);
  }
#define X(function)                                                                                                    \
  if (std::strcmp(name, "vk" #function) == 0) {                                                                        \
    function##Wrap::real = reinterpret_cast<PFN_vk##function>(found);                                                  \
    return reinterpret_cast<PFN_vkVoidFunction>(&function##Wrap::call);                                                \
  }
  GPGP_INSTANCE_FUNCTIONS(X)
#undef X
  return found;
}

} // namespace

VulkanProxy::VulkanProxy(const host::HeadlessDevice& device) : real(device.getInstanceProcAddr()) { current = this; }
VulkanProxy::~VulkanProxy() { current = nullptr; }
PFN_vkGetInstanceProcAddr VulkanProxy::getInstanceProcAddr() { return &instanceProc; }

} // namespace gpgp::test
