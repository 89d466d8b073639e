// Textures that toolkits hand over as pixels: on the device, uploaded from pixels, or copied from a canvas that
// something was drawn on. Their device memory goes when no frame uses it any more.
#pragma once
#include <gpgp/gpgp.hpp>
#include <vulkan/vulkan.h>

#include <memory>
#include <vector>

namespace gpgp::integration {

struct Texture {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> pixels; ///< to be uploaded; premultiplied as they are encoded
  bool filled = false;         ///< what fills it was recorded
  bool broken = false;         ///< there was no memory
  VkImage image = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
};
using TexturePointer = std::shared_ptr<Texture>;

class Textures {
public:
  Textures(VkPhysicalDevice physical, VkDevice device);
  /// All textures are gone by now, and the frames that showed them have finished.
  ~Textures();
  Textures(const Textures&) = delete;
  Textures& operator=(const Textures&) = delete;

  /// pixels: empty, or width x height x 4. Its device memory goes when no frame uses it any more.
  TexturePointer make(uint32_t width, uint32_t height, std::vector<uint8_t> pixels);
  /// At the beginning of a frame's recording.
  void advance(const GpgpFrame& frame);
  /// Records those that wait. False: some could not be made. `count` receives how many could.
  bool recordUpload(VkCommandBuffer commands, uint32_t& count);
  /// Records the copy of a part of `from`, which lies in TRANSFER_SRC_OPTIMAL and is visible to transfers.
  bool recordCopy(VkCommandBuffer commands, VkImage from, uint32_t x, uint32_t y, Texture& texture);
  /// For GpgpCanvasInfo::images; repeated beyond its edges. encoding: that of its pixels.
  GpgpCanvasImage image(const Texture& texture, GpgpImageEncoding encoding = GPGP_IMAGE_SRGB) const;

  /// An image that canvases are drawn on, to be copied. Throws std::runtime_error.
  struct Target {
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
  };
  bool makeTarget(uint32_t width, uint32_t height, Target& target) const;
  void destroy(const Target& target) const;

private:
  struct Staging {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
  };
  template <class T> struct Dead {
    T what;
    uint64_t frame = 0;
  };
  bool makeImage(uint32_t width, uint32_t height, VkImageUsageFlags usage, Target& target) const;
  bool allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags, VkDeviceMemory& memory) const;
  void destroy(const Staging& staging) const;

  VkDevice device_;
  VkPhysicalDeviceMemoryProperties memory_{};
  uint32_t maxSide_ = 0;
  VkSampler sampler_ = VK_NULL_HANDLE;
  uint64_t frame_ = 0;
  std::vector<std::weak_ptr<Texture>> waiting_;
  std::vector<Dead<Target>> images_;
  std::vector<Dead<Staging>> stagings_;
};

} // namespace gpgp::integration
