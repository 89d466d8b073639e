// Glyphs that are pictures (bitmap emoji: CBDT, sbix) in one texture, which a record takes as one of its images.
//
// The texture has places of one size, each with mip levels of its own and a clear margin, so that a picture is sharp
// and keeps to itself at every size and in perspective. A picture that has not been asked for since the last upload
// makes room for a new one. Colours are multiplied by alpha before sRGB encodes them: filtering darkens no edge.
#pragma once
#include <gpgp/gpgp.hpp>

#include <array>
#include <optional>
#include <vector>

namespace gpgp::integration {

/// The device that textures are made on. Without one, pictures are not shown.
struct PictureDevice {
  VkDevice device = VK_NULL_HANDLE;
  PFN_vkGetDeviceProcAddr getDeviceProcAddr = nullptr;
  VkPhysicalDeviceMemoryProperties memory{}; ///< vkGetPhysicalDeviceMemoryProperties
  uint32_t maxSide = 4096;                   ///< VkPhysicalDeviceLimits::maxImageDimension2D, or less
  /// The canvases that show the pictures have GpgpCanvasInfo::blendSrgb, so pictures are kept and made smaller as sRGB
  /// encodes them. Others show them as well, more slowly and somewhat softer.
  bool blendSrgb = false;
};

class GlyphPictures {
public:
  /// maxPictures: at a time, as far as maxSide allows (4096: 625); 136 KB each, allocated together when the first one
  /// comes.
  GlyphPictures(const PictureDevice& device, uint32_t maxPictures);
  ~GlyphPictures(); ///< frames that show pictures have finished
  GlyphPictures(const GlyphPictures&) = delete;
  GlyphPictures& operator=(const GlyphPictures&) = delete;

  static constexpr uint32_t kNone = UINT32_MAX;
  /// A place for a picture, which goes with the next recordUpload; one with more than 144 texels a side is shrunk.
  /// OUT_OF_DEVICE_MEMORY: there is no texture. BUDGET_EXCEEDED: all others are in use.
  GpgpResult add(const GpgpGlyphImage& image, uint32_t& place);
  uint32_t capacity() const { return static_cast<uint32_t>(places_.size()); }
  bool full() const; ///< add would exceed the budget
  /// It is in use: it stays until the next recordUpload, and what that frame shows of it stays as it is.
  void use(uint32_t place) { places_[place].used = upload_; }
  /// Where in the texture its ink lies: left, top, right, bottom in texture coordinates.
  const std::array<float, 4>& source(uint32_t place) const { return places_[place].source; }
  /// Counts up whenever a place was given away: what was noted of it is no longer true.
  uint64_t owner(uint32_t place) const { return places_[place].owner; }

  /// New pictures into the texture: before the records that show them, outside render passes, every frame.
  GpgpResult recordUpload(VkCommandBuffer commands, const GpgpFrame& frame);
  /// For GpgpCanvasInfo::images; nothing as long as no picture was met.
  std::optional<GpgpCanvasImage> image() const;

private:
  struct Place {
    std::array<float, 4> source{};
    uint64_t owner = 0, used = 0; ///< used: the upload that it waits for or came with
  };
  struct Pending {
    uint32_t place = 0;
    std::vector<uint8_t> levels; ///< one after the other
  };
  struct Staging {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    uint64_t frame = 0;
  };
  VkFormat format() const { return device_.blendSrgb ? VK_FORMAT_R8G8B8A8_UNORM : VK_FORMAT_R8G8B8A8_SRGB; }
  uint32_t findPlace() const;
  VkResult makeTexture();
  VkResult allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags, VkDeviceMemory& memory) const;
  VkResult makeStaging(VkDeviceSize bytes, Staging& staging, void*& mapped) const;
  void destroy(const Staging& staging) const;
  template <class Function> Function load(const char* name) const {
    return reinterpret_cast<Function>(device_.getDeviceProcAddr(device_.device, name));
  }

  PictureDevice device_;
  uint32_t columns_ = 1, rows_ = 1;
  std::vector<Place> places_;
  std::vector<Pending> pending_;
  std::vector<Staging> staging_;
  uint64_t upload_ = 1;
  bool written_ = false; ///< an upload was recorded: the texture is readable between uploads
  VkImage texture_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  VkSampler sampler_ = VK_NULL_HANDLE;
};

} // namespace gpgp::integration
