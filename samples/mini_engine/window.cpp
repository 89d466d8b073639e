// A window by SDL2 and its swapchain.
#include "target.h"

#include <SDL.h>
#include <SDL_vulkan.h>

#include <algorithm>

namespace mini {
namespace {

struct Sdl { // made before the instance, ended after the device
  Sdl() {
    if (SDL_Init(SDL_INIT_VIDEO) != 0) throw std::runtime_error(std::string("no window system: ") + SDL_GetError());
    window = SDL_CreateWindow("gpgp mini engine", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, 1280, 720,
                              SDL_WINDOW_VULKAN | SDL_WINDOW_RESIZABLE);
    if (!window) throw std::runtime_error(std::string("no window: ") + SDL_GetError());
  }
  ~Sdl() {
    if (window) SDL_DestroyWindow(window);
    SDL_Quit();
  }
  SDL_Window* window = nullptr;
};

Sdl& sdl() {
  static Sdl instance;
  return instance;
}

class Window : public Target {
public:
  Window(Device& device, VkExtent2D extent) : device_(device) {
    SDL_SetWindowSize(sdl().window, static_cast<int>(extent.width), static_cast<int>(extent.height));
    if (!SDL_Vulkan_CreateSurface(sdl().window, device.instance, &surface_))
      throw std::runtime_error(std::string("no Vulkan surface: ") + SDL_GetError());
    VkBool32 canPresent = VK_FALSE;
    check(vkGetPhysicalDeviceSurfaceSupportKHR(device.physical, device.family, surface_, &canPresent),
          "surface support");
    if (!canPresent) throw std::runtime_error("the device cannot present to this window");
    uint32_t count = 0;
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical, surface_, &count, nullptr), "surface formats");
    std::vector<VkSurfaceFormatKHR> formats(count);
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical, surface_, &count, formats.data()), "surface formats");
    const auto wanted = std::find_if(formats.begin(), formats.end(), [](const VkSurfaceFormatKHR& f) {
      return f.format == VK_FORMAT_B8G8R8A8_SRGB || f.format == VK_FORMAT_R8G8B8A8_SRGB;
    });
    if (wanted == formats.end()) throw std::runtime_error("the window offers no sRGB format");
    format_ = *wanted;
    VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    for (VkSemaphore& semaphore : available_)
      check(vkCreateSemaphore(device.device, &info, nullptr, &semaphore), "vkCreateSemaphore");
  }
  ~Window() override {
    destroyImages();
    for (VkSemaphore semaphore : available_) vkDestroySemaphore(device_.device, semaphore, nullptr);
    vkDestroySwapchainKHR(device_.device, swapchain_, nullptr);
    vkDestroySurfaceKHR(device_.instance, surface_, nullptr);
  }
  VkFormat format() const override { return format_.format; }
  VkImageLayout finalLayout() const override { return VK_IMAGE_LAYOUT_PRESENT_SRC_KHR; }
  VkExtent2D extent() const override { return extent_; }

  void attach(Forward& forward) override {
    VkSurfaceCapabilitiesKHR can{};
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical, surface_, &can), "surface capabilities");
    extent_ = can.currentExtent;
    if (extent_.width == UINT32_MAX) { // the surface follows the swapchain
      int width = 0, height = 0;
      SDL_Vulkan_GetDrawableSize(sdl().window, &width, &height);
      extent_ = {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
    }
    extent_ = {std::clamp(extent_.width, 1u, kMaxExtent.width), std::clamp(extent_.height, 1u, kMaxExtent.height)};
    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = surface_;
    info.minImageCount = can.maxImageCount ? std::min(can.minImageCount + 1, can.maxImageCount) : can.minImageCount + 1;
    info.imageFormat = format_.format;
    info.imageColorSpace = format_.colorSpace;
    info.imageExtent = extent_;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.clipped = VK_TRUE;
    info.oldSwapchain = swapchain_;
    VkSwapchainKHR old = swapchain_;
    check(vkCreateSwapchainKHR(device_.device, &info, nullptr, &swapchain_), "vkCreateSwapchainKHR");
    destroyImages();
    vkDestroySwapchainKHR(device_.device, old, nullptr);
    uint32_t count = 0;
    check(vkGetSwapchainImagesKHR(device_.device, swapchain_, &count, nullptr), "vkGetSwapchainImagesKHR");
    std::vector<VkImage> images(count);
    check(vkGetSwapchainImagesKHR(device_.device, swapchain_, &count, images.data()), "vkGetSwapchainImagesKHR");
    forward.resize(extent_);
    for (VkImage image : images) {
      VkImageViewCreateInfo viewInfo{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
      viewInfo.image = image;
      viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
      viewInfo.format = format_.format;
      viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
      Picture& picture = pictures_.emplace_back();
      check(vkCreateImageView(device_.device, &viewInfo, nullptr, &picture.view), "vkCreateImageView");
      picture.framebuffer = forward.makeFramebuffer(picture.view);
      VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
      check(vkCreateSemaphore(device_.device, &semaphore, nullptr, &picture.rendered), "vkCreateSemaphore");
    }
  }

  std::optional<Acquired> acquire(uint32_t slot) override {
    Acquired acquired;
    acquired.available = available_[slot % 2];
    const VkResult result = vkAcquireNextImageKHR(device_.device, swapchain_, UINT64_MAX, acquired.available,
                                                  VK_NULL_HANDLE, &acquired.index);
    if (result == VK_ERROR_OUT_OF_DATE_KHR) return std::nullopt;
    check(result, "vkAcquireNextImageKHR");
    acquired.framebuffer = pictures_[acquired.index].framebuffer;
    acquired.rendered = pictures_[acquired.index].rendered;
    return acquired;
  }

  void present(const Acquired& acquired) override {
    VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &acquired.rendered;
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain_;
    info.pImageIndices = &acquired.index;
    const VkResult result = vkQueuePresentKHR(device_.queue, &info);
    if (result != VK_ERROR_OUT_OF_DATE_KHR) check(result, "vkQueuePresentKHR"); // the next acquire says so again
  }

  bool pollEvents() override {
    SDL_Event event;
    while (SDL_PollEvent(&event)) {
      if (event.type == SDL_QUIT || (event.type == SDL_KEYDOWN && event.key.keysym.sym == SDLK_ESCAPE)) return false;
      if (event.type == SDL_KEYDOWN && event.key.keysym.sym > 0 && event.key.keysym.sym < 128)
        keys_ += static_cast<char>(event.key.keysym.sym);
    }
    return true;
  }
  void setTitle(const std::string& title) override { SDL_SetWindowTitle(sdl().window, title.c_str()); }

private:
  struct Picture {
    VkImageView view = VK_NULL_HANDLE;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    VkSemaphore rendered = VK_NULL_HANDLE;
  };
  void destroyImages() {
    for (const Picture& picture : pictures_) {
      vkDestroySemaphore(device_.device, picture.rendered, nullptr);
      vkDestroyFramebuffer(device_.device, picture.framebuffer, nullptr);
      vkDestroyImageView(device_.device, picture.view, nullptr);
    }
    pictures_.clear();
  }
  Device& device_;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
  VkSurfaceFormatKHR format_{};
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  VkExtent2D extent_{};
  std::vector<Picture> pictures_;
  VkSemaphore available_[2] = {};
};

} // namespace

std::vector<const char*> windowExtensions() {
  unsigned count = 0;
  if (!SDL_Vulkan_GetInstanceExtensions(sdl().window, &count, nullptr))
    throw std::runtime_error(std::string("no Vulkan in this window system: ") + SDL_GetError());
  std::vector<const char*> names(count);
  SDL_Vulkan_GetInstanceExtensions(sdl().window, &count, names.data());
  return names;
}

std::unique_ptr<Target> makeWindow(Device& device, VkExtent2D extent) {
  return std::make_unique<Window>(device, extent);
}

} // namespace mini
