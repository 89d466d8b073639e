// A window by GLFW.
#include "gpgp_glfw.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <string>

namespace gpgp::glfw {
namespace {

[[noreturn]] void fail(const char* what) {
  const char* why = nullptr;
  glfwGetError(&why);
  throw std::runtime_error(std::string(what) + (why ? why : "GLFW does not say why"));
}

/// Whether GLFW runs: any call says so.
bool isRunning() {
  glfwGetError(nullptr);
  glfwGetTime();
  return glfwGetError(nullptr) != GLFW_NOT_INITIALIZED;
}

} // namespace

Window::Window(const WindowInfo& info) : began_(!isRunning()) {
  if (!glfwInit()) fail("no window system: ");
  try {
    if (!glfwVulkanSupported()) fail("no Vulkan in this window system: ");
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ =
        glfwCreateWindow(static_cast<int>(info.width), static_cast<int>(info.height), info.title, nullptr, nullptr);
    glfwDefaultWindowHints();
    if (!window_) fail("no window: ");
  } catch (...) {
    if (began_) glfwTerminate();
    throw;
  }
}

Window::~Window() {
  glfwDestroyWindow(window_);
  if (began_) glfwTerminate();
}

std::vector<const char*> Window::instanceExtensions() const {
  uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  if (!names) fail("no Vulkan surfaces in this window system: ");
  return {names, names + count};
}

VkExtent2D Window::drawableSize() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

VkSurfaceKHR Window::createSurface(VkInstance instance) const {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  if (glfwCreateWindowSurface(instance, window_, nullptr, &surface) != VK_SUCCESS) fail("no Vulkan surface: ");
  return surface;
}

void Window::limitSize(VkExtent2D pixels) const {
  int width = 0, height = 0; // in screen coordinates
  glfwGetWindowSize(window_, &width, &height);
  const VkExtent2D drawable = drawableSize();
  if (drawable.width == 0 || drawable.height == 0) return;
  glfwSetWindowSizeLimits(window_, GLFW_DONT_CARE, GLFW_DONT_CARE,
                          static_cast<int>(uint64_t{pixels.width} * static_cast<uint64_t>(width) / drawable.width),
                          static_cast<int>(uint64_t{pixels.height} * static_cast<uint64_t>(height) / drawable.height));
}

bool Window::pollEvents() {
  glfwPollEvents();
  return !glfwWindowShouldClose(window_) && glfwGetKey(window_, GLFW_KEY_ESCAPE) != GLFW_PRESS;
}

} // namespace gpgp::glfw
