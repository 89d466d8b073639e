// gpgp::device: a Vulkan device that gpgp can use, frames in flight and a window's images, for samples and small tools.
//
//   Device     instance, GPU, device and one queue, with what gpgpGetRequirements asks for
//   Frames     frames in flight: a command buffer and a fence each, and the numbers that gpgp wants to be told
//   Window     what the rest needs of a window: gpgp::sdl2 and gpgp::glfw open one
//   Swapchain  the window's images, acquired and presented
//   ColorPass  a render pass over them, with their framebuffers
//   Screenshot a picture of a frame
//
// It links the Vulkan loader and nothing else of gpgp's than libgpgp. What fails throws std::runtime_error with a
// sentence. There is no global state. Not thread-safe: use all of it in the thread that made it.
#pragma once
#include <gpgp/core.h>
#include <vulkan/vulkan.h>

#include <atomic>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace gpgp::integration {

/// Throws std::runtime_error with the call's name where result is an error.
void check(VkResult result, const char* what);

// ---------------------------------------------------------------- device

struct DeviceInfo {
  const char* application = "gpgp";
  std::string device;    ///< part of a name or an index; empty: $GPGP_DEVICE, else software, else 0
  bool validate = false; ///< Khronos validation layer, synchronisation validation included
  std::vector<const char*> instanceExtensions; ///< Window::instanceExtensions
  std::vector<const char*> deviceExtensions;   ///< VK_KHR_swapchain for a window
  /// Switches on what the program itself needs, beside what gpgp could use. Throws where it is not offered.
  std::function<void(const VkPhysicalDeviceFeatures& offered, VkPhysicalDeviceFeatures& enabled)> chooseFeatures;
};

class Device {
public:
  explicit Device(const DeviceInfo& info);
  ~Device(); ///< waits until the device is idle
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE; ///< graphics and compute
  uint32_t family = 0;
  VkQueueFlags queueFlags = 0;
  VkPhysicalDeviceProperties properties{};
  VkPhysicalDeviceMemoryProperties memory{};
  GpgpFeatures gpgpFeatures = 0; ///< what was enabled, to be declared to gpgp

  /// All but label, callbacks and budgets.
  GpgpContextCreateInfo contextCreateInfo() const;
  uint32_t validationMessages() const { return validationMessages_; }
  /// The first type of typeBits with all of required and, if there is one, preferred too.
  uint32_t memoryType(uint32_t typeBits, VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred = 0) const;

private:
  void createInstance(const DeviceInfo& info);
  void choosePhysical(std::string name);
  void createDevice(const DeviceInfo& info);
  void destroy() noexcept;
  static VKAPI_ATTR VkBool32 VKAPI_CALL onValidation(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                     VkDebugUtilsMessageTypeFlagsEXT types,
                                                     const VkDebugUtilsMessengerCallbackDataEXT* data, void* user);
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::atomic<uint32_t> validationMessages_{0};
};

/// begin() ... record ... submit(), over and over. Frame numbers start at 1.
class Frames {
public:
  explicit Frames(Device& device, uint32_t inFlight = 2);
  ~Frames(); ///< waits for all frames
  Frames(const Frames&) = delete;
  Frames& operator=(const Frames&) = delete;

  /// Waits until a slot is free and begins its command buffer; number() is this frame's from here on.
  VkCommandBuffer begin();
  /// For gpgpAdvance and every gpgpRecord... of this frame.
  const GpgpFrame& number() const { return number_; }
  uint32_t slot() const { return static_cast<uint32_t>(number_.current % slots_.size()); }
  uint32_t inFlight() const { return static_cast<uint32_t>(slots_.size()); }
  /// Ends the command buffer and submits it: after `wait`, if given, before colours are written; signals `signal`.
  void submit(VkSemaphore wait = VK_NULL_HANDLE, VkSemaphore signal = VK_NULL_HANDLE);
  /// Waits for all of them; number() is then a new frame's, with everything before it safe.
  void finish();

private:
  struct Slot {
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence finished = VK_NULL_HANDLE;
  };
  Device& device_;
  std::vector<Slot> slots_;
  GpgpFrame number_{};
};

// ---------------------------------------------------------------- window

/// What a swapchain needs of a window, whoever opened it.
class Window {
public:
  Window() = default;
  virtual ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  virtual std::vector<const char*> instanceExtensions() const = 0;
  virtual VkExtent2D drawableSize() const = 0; ///< pixels
  virtual VkSurfaceKHR createSurface(VkInstance instance) const = 0;
  /// Tells the window system that the window becomes no larger than this many pixels.
  virtual void limitSize(VkExtent2D pixels) const = 0;
};

struct SwapchainInfo {
  VkExtent2D maxExtent{4096, 4096}; ///< of images: the window is told to become no larger
  bool srgb = true;                 ///< the format encodes what shaders write as sRGB; false: it stores it as it is
};

/// 8-bit images, shown at the display's pace. The device must be there before and until after it.
class Swapchain {
public:
  Swapchain(Device& device, const Window& window, const SwapchainInfo& info = {});
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  struct Image {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkSemaphore rendered = VK_NULL_HANDLE; ///< to be signalled by the frame that draws it
  };
  struct Acquired {
    uint32_t index = 0;
    VkSemaphore available = VK_NULL_HANDLE; ///< to be waited for by the frame that draws it
  };
  VkFormat format() const { return format_.format; }
  VkExtent2D extent() const { return extent_; }
  VkExtent2D maxExtent() const { return info_.maxExtent; } ///< what a canvas of the window's size has to hold
  bool canBeRead() const { return canBeRead_; }            ///< by Screenshot
  const std::vector<Image>& images() const { return images_; }

  /// Waits for the device and makes images of the window's size anew.
  void resize();
  /// The next image, for the frame of this slot (Frames::slot). Nothing: the size has changed; resize() and try again.
  std::optional<Acquired> acquire(uint32_t slot);
  void present(const Acquired& acquired);

private:
  void destroyImages() noexcept;
  Device& device_;
  const Window& window_;
  SwapchainInfo info_;
  VkSurfaceKHR surface_;
  VkSurfaceFormatKHR format_{};
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  VkExtent2D extent_{};
  bool canBeRead_ = false;
  std::vector<Image> images_;
  std::vector<VkSemaphore> available_; // of each slot
};

/// One colour attachment, cleared, left to be presented.
class ColorPass {
public:
  ColorPass(Device& device, const Swapchain& swapchain);
  ~ColorPass();
  ColorPass(const ColorPass&) = delete;
  ColorPass& operator=(const ColorPass&) = delete;

  VkRenderPass handle() const { return renderPass_; }
  /// Framebuffers for the swapchain's images; again after each of its resize().
  void attach();
  /// Begins the pass on an image, with viewport and scissor over all of it.
  void begin(VkCommandBuffer commands, uint32_t image, const float (&clear)[4]) const;

private:
  void destroyFramebuffers() noexcept;
  Device& device_;
  const Swapchain& swapchain_;
  VkRenderPass renderPass_ = VK_NULL_HANDLE;
  std::vector<VkFramebuffer> framebuffers_;
};

class Screenshot {
public:
  Screenshot(Device& device, const Swapchain& swapchain);
  ~Screenshot();
  Screenshot(const Screenshot&) = delete;
  Screenshot& operator=(const Screenshot&) = delete;

  /// Copies an image, which is ready to be presented and stays so.
  void record(VkCommandBuffer commands, uint32_t image);
  /// After the frame has finished: what the window showed, 4 bytes a pixel, rows from the top.
  std::vector<uint8_t> rgba() const;
  /// The same as a BMP file.
  void save(const std::string& file) const;

private:
  Device& device_;
  const Swapchain& swapchain_;
  VkExtent2D extent_{};
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  void* mapped_ = nullptr;
};

} // namespace gpgp::integration
