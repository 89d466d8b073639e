// gpgp::glfw: a window by GLFW, and gpgp::device under names of this toolkit's (gpgp_device.hpp), for samples and small
// tools.
//
// What fails throws std::runtime_error with a sentence. There is no global state but GLFW's own. Use all of it in the
// main thread, as GLFW wants it.
#pragma once
#include "gpgp_device.hpp"

struct GLFWwindow;

namespace gpgp::glfw {

using integration::check;
using integration::ColorPass;
using integration::Device;
using integration::DeviceInfo;
using integration::Frames;
using integration::Screenshot;
using integration::Swapchain;
using integration::SwapchainInfo;

struct WindowInfo {
  const char* title = "gpgp";
  uint32_t width = 1280, height = 720; ///< screen coordinates, which are pixels where the display is not scaled
};

/// GLFW and one window; made before the device, for it knows what the instance needs. Whoever called glfwInit before
/// keeps GLFW: it is ended with the last window only if a window began it.
class Window final : public integration::Window {
public:
  explicit Window(const WindowInfo& info);
  ~Window() override;

  GLFWwindow* handle() const { return window_; } ///< for callbacks and the state of keys
  std::vector<const char*> instanceExtensions() const override;
  VkExtent2D drawableSize() const override;
  VkSurfaceKHR createSurface(VkInstance instance) const override;
  void limitSize(VkExtent2D pixels) const override;
  /// Runs GLFW's callbacks. False: the window was closed, or Escape is pressed.
  bool pollEvents();

private:
  bool began_ = false; // GLFW was not running before
  GLFWwindow* window_ = nullptr;
};

} // namespace gpgp::glfw
