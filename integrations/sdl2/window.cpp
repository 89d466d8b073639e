// A window by SDL2.
#include "gpgp_sdl2.hpp"

#include <SDL.h>
#include <SDL_vulkan.h>

namespace gpgp::sdl2 {

Window::Window(const WindowInfo& info) {
  if (SDL_InitSubSystem(SDL_INIT_VIDEO) != 0)
    throw std::runtime_error(std::string("no window system: ") + SDL_GetError());
  window_ = SDL_CreateWindow(info.title, SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, static_cast<int>(info.width),
                             static_cast<int>(info.height),
                             SDL_WINDOW_VULKAN | SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI);
  if (window_) return;
  const std::string why = SDL_GetError();
  SDL_QuitSubSystem(SDL_INIT_VIDEO);
  throw std::runtime_error("no window: " + why);
}

Window::~Window() {
  SDL_DestroyWindow(window_);
  SDL_QuitSubSystem(SDL_INIT_VIDEO); // SDL counts who began it
}

std::vector<const char*> Window::instanceExtensions() const {
  unsigned count = 0;
  if (!SDL_Vulkan_GetInstanceExtensions(window_, &count, nullptr))
    throw std::runtime_error(std::string("no Vulkan in this window system: ") + SDL_GetError());
  std::vector<const char*> names(count);
  SDL_Vulkan_GetInstanceExtensions(window_, &count, names.data());
  return names;
}

VkExtent2D Window::drawableSize() const {
  int width = 0, height = 0;
  SDL_Vulkan_GetDrawableSize(window_, &width, &height);
  return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

VkSurfaceKHR Window::createSurface(VkInstance instance) const {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  if (!SDL_Vulkan_CreateSurface(window_, instance, &surface))
    throw std::runtime_error(std::string("no Vulkan surface: ") + SDL_GetError());
  return surface;
}

void Window::limitSize(VkExtent2D pixels) const {
  int width = 0, height = 0; // in the window system's units
  SDL_GetWindowSize(window_, &width, &height);
  const VkExtent2D drawable = drawableSize();
  if (drawable.width == 0 || drawable.height == 0) return;
  SDL_SetWindowMaximumSize(window_,
                           static_cast<int>(uint64_t{pixels.width} * static_cast<uint64_t>(width) / drawable.width),
                           static_cast<int>(uint64_t{pixels.height} * static_cast<uint64_t>(height) / drawable.height));
}

bool Window::pollEvents(const std::function<void(const SDL_Event&)>& onEvent) {
  SDL_Event event;
  bool goOn = true;
  while (SDL_PollEvent(&event)) {
    if (onEvent) onEvent(event);
    if (event.type == SDL_QUIT || (event.type == SDL_KEYDOWN && event.key.keysym.sym == SDLK_ESCAPE)) goOn = false;
  }
  return goOn;
}

} // namespace gpgp::sdl2
