// Makes a call that the validation layer must object to. tests/windows.sh looks whether it does: where the layer works
// outside (GPGP_VALIDATION=outside), nothing else would show that it does not.
#include "host/device.h"

#include <cstdio>
#include <exception>

int main() {
  try {
    const gpgp::host::HeadlessDevice device{gpgp::host::DeviceOptions{.validation = true}};
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO}; // of size 0, for no usage
    VkBuffer buffer = VK_NULL_HANDLE;
    if (device.vk().vkCreateBuffer(device.device(), &info, nullptr, &buffer) == VK_SUCCESS)
      device.vk().vkDestroyBuffer(device.device(), buffer, nullptr);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "wrong_call: %s\n", error.what());
    return 1;
  }
}
