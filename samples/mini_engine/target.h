// Where pictures go: images of the engine's own that become PNG files, or a window.
#pragma once
#include "forward.h"

#include <memory>
#include <optional>
#include <utility>

namespace mini {

/// Pictures are no larger: what gpgp is created with is sized for it.
constexpr VkExtent2D kMaxExtent = {2560, 1440};

/// One picture to draw into in this frame.
struct Acquired {
  uint32_t index = 0;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  VkSemaphore available = VK_NULL_HANDLE; // the frame's submit waits for it; null: nothing to wait for
  VkSemaphore rendered = VK_NULL_HANDLE;  // and signals it
};

/// What the person did.
struct Input {
  enum Kind { key, up, down, enter, move, click, release } kind = key;
  char character = 0; // of a key
  float x = 0, y = 0; // where the pointer moved to, pixels of the picture
};

class Target {
public:
  virtual ~Target() = default;
  virtual VkFormat format() const = 0;
  virtual VkImageLayout finalLayout() const = 0;
  virtual VkExtent2D extent() const = 0;
  /// Sizes the forward pass to this target and makes framebuffers for it. The device must be idle.
  virtual void attach(Forward& forward) = 0;
  /// Nothing: the size has changed; call attach and try again.
  virtual std::optional<Acquired> acquire(uint32_t slot) = 0;
  virtual void present(const Acquired& acquired) = 0;
  /// False: the person wants to end.
  virtual bool pollEvents() { return true; }
  virtual void setTitle(const std::string&) {}
  /// As if a person did it now: what pollEvents finds next.
  virtual void play(const std::vector<Input>& inputs) { inputs_.insert(inputs_.end(), inputs.begin(), inputs.end()); }
  /// Once a frame, after its last pass.
  virtual void keep(VkCommandBuffer, const Acquired&) {}
  /// After all frames: the last one's picture, as PNG.
  virtual void writePicture(const std::string& file) = 0;
  /// Since the last call.
  std::vector<Input> takeInputs() { return std::exchange(inputs_, {}); }

protected:
  std::vector<Input> inputs_;
};

/// Pixels as RGBA, sRGB-encoded. Makes missing folders; throws with the file's name.
void writePng(const std::string& file, VkExtent2D extent, const void* pixels);

/// Two images: the picture, and the same scene from the side. After the frame is finished they can be written.
class Offscreen : public Target {
public:
  Offscreen(Device& device, VkExtent2D extent);
  ~Offscreen() override;
  VkFormat format() const override { return VK_FORMAT_R8G8B8A8_SRGB; }
  VkImageLayout finalLayout() const override { return VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL; }
  VkExtent2D extent() const override { return extent_; }
  void attach(Forward& forward) override;
  std::optional<Acquired> acquire(uint32_t slot) override;
  void present(const Acquired&) override {}
  VkFramebuffer sideFramebuffer() const { return framebuffers_[1]; }
  void writePicture(const std::string& file) override { writeImage(0, file); }
  /// The picture, or the scene from the side.
  void writeImage(uint32_t image, const std::string& file);

private:
  void destroyFramebuffers();
  Device& device_;
  VkExtent2D extent_;
  Image images_[2];
  VkFramebuffer framebuffers_[2] = {};
};

#ifdef GPGP_SDL2_WINDOW
/// Pictures go to the window, which outlives the target; they are kept for writePicture where that is wanted.
std::unique_ptr<Target> makeWindow(Device& device, gpgp::sdl2::Window& window, bool keepPictures);
#endif

} // namespace mini
