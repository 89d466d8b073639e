// gpgp::sdl2: a window by SDL2, and gpgp::device under names of this toolkit's (gpgp_device.hpp), for samples and small
// tools.
//
// What fails throws std::runtime_error with a sentence. There is no global state but SDL's own. Not thread-safe: use
// all of it in the thread that made it.
#pragma once
#include "gpgp_device.hpp"

struct SDL_Window;
union SDL_Event;

namespace gpgp::sdl2 {

using integration::check;
using integration::ColorPass;
using integration::Device;
using integration::DeviceInfo;
using integration::Frames;
using integration::Screenshot;
using integration::Swapchain;
using integration::SwapchainInfo;

#ifdef GPGP_SDL2_WINDOW // where SDL2 was found

struct WindowInfo {
  const char* title = "gpgp";
  uint32_t width = 1280, height = 720; ///< pixels, as far as the window system agrees
};

/// SDL's video and one window; made before the device, for it knows what the instance needs.
class Window final : public integration::Window {
public:
  explicit Window(const WindowInfo& info);
  ~Window() override;

  SDL_Window* handle() const { return window_; }
  std::vector<const char*> instanceExtensions() const override;
  VkExtent2D drawableSize() const override;
  VkSurfaceKHR createSurface(VkInstance instance) const override;
  void limitSize(VkExtent2D pixels) const override;
  /// Hands each event over. False: the window was closed, or Escape pressed.
  bool pollEvents(const std::function<void(const SDL_Event&)>& onEvent = {});

private:
  SDL_Window* window_ = nullptr;
};

#endif

} // namespace gpgp::sdl2
