#include "gpgp_glyph_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gpgp::integration {
namespace {

constexpr uint32_t kPitch = 160; // texels from place to place
constexpr uint32_t kMargin = 8;  // around a picture; with its neighbour's, a texel in the smallest level
constexpr uint32_t kLevels = 5;  // down to a sixteenth
static_assert(kPitch % (1u << (kLevels - 1)) == 0 && 2 * kMargin >= 1u << (kLevels - 1));

/// Premultiplied colour, linear or as sRGB encodes it, 4 numbers a texel.
struct Texels {
  uint32_t width = 0, height = 0;
  std::vector<float> rgba;
  float* at(uint32_t x, uint32_t y) { return &rgba[(size_t{y} * width + x) * 4]; }
  const float* at(uint32_t x, uint32_t y) const { return &rgba[(size_t{y} * width + x) * 4]; }
};

float linearFromSrgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }
float srgbFromLinear(float v) { return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f; }

Texels texelsOf(const GpgpGlyphImage& image, bool encoded) {
  float values[256];
  for (int i = 0; i < 256; ++i) {
    values[i] = static_cast<float>(i) / 255;
    if (!encoded) values[i] = linearFromSrgb(values[i]);
  }
  Texels texels{image.width, image.height, std::vector<float>(size_t{image.width} * image.height * 4)};
  for (size_t i = 0; i < texels.rgba.size(); i += 4) {
    const uint8_t* in = image.pixels + i;
    const float alpha = static_cast<float>(in[3]) / 255;
    for (size_t c = 0; c < 3; ++c) texels.rgba[i + c] = values[in[c]] * alpha;
    texels.rgba[i + 3] = alpha;
  }
  return texels;
}

/// Each texel the mean of four; an odd last row or column counts twice.
Texels halved(const Texels& from) {
  Texels to{(from.width + 1) / 2, (from.height + 1) / 2, {}};
  to.rgba.resize(size_t{to.width} * to.height * 4);
  for (uint32_t y = 0; y < to.height; ++y)
    for (uint32_t x = 0; x < to.width; ++x) {
      const uint32_t x1 = std::min(2 * x + 1, from.width - 1), y1 = std::min(2 * y + 1, from.height - 1);
      const float *a = from.at(2 * x, 2 * y), *b = from.at(x1, 2 * y), *c = from.at(2 * x, y1), *d = from.at(x1, y1);
      for (size_t i = 0; i < 4; ++i) to.at(x, y)[i] = (a[i] + b[i] + c[i] + d[i]) / 4;
    }
  return to;
}

/// Fewer texels, each the mean of what it covers.
Texels shrunk(const Texels& from, uint32_t width, uint32_t height) {
  Texels to{width, height, std::vector<float>(size_t{width} * height * 4)};
  const float across = static_cast<float>(from.width) / static_cast<float>(width),
              down = static_cast<float>(from.height) / static_cast<float>(height);
  const auto shared = [](uint32_t i, float step, uint32_t texel) { // of a texel with the step
    const auto low = static_cast<float>(texel), begin = static_cast<float>(i) * step;
    return std::max(std::min(low + 1, begin + step) - std::max(low, begin), 0.0f) / step;
  };
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x)
      for (auto v = static_cast<uint32_t>(static_cast<float>(y) * down); v < from.height; ++v) {
        const float tall = shared(y, down, v);
        if (tall == 0) break;
        for (auto u = static_cast<uint32_t>(static_cast<float>(x) * across); u < from.width; ++u) {
          const float part = shared(x, across, u) * tall;
          if (part == 0) break;
          for (size_t i = 0; i < 4; ++i) to.at(x, y)[i] += from.at(u, v)[i] * part;
        }
      }
  return to;
}

/// As the texture's format has them: an sRGB format encodes what is linear.
void append(const Texels& texels, bool encoded, std::vector<uint8_t>& bytes) {
  for (size_t i = 0; i < texels.rgba.size(); ++i) {
    const float value = encoded || i % 4 == 3 ? texels.rgba[i] : srgbFromLinear(texels.rgba[i]);
    bytes.push_back(static_cast<uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255)));
  }
}

GpgpResult codeOf(VkResult result) {
  return result == VK_SUCCESS                      ? GPGP_SUCCESS
         : result == VK_ERROR_OUT_OF_HOST_MEMORY   ? GPGP_ERROR_OUT_OF_HOST_MEMORY
         : result == VK_ERROR_OUT_OF_DEVICE_MEMORY ? GPGP_ERROR_OUT_OF_DEVICE_MEMORY
                                                   : GPGP_ERROR_VULKAN;
}

} // namespace

GlyphPictures::GlyphPictures(const PictureDevice& device, uint32_t maxPictures) : device_(device) {
  const uint32_t across = std::max(device.maxSide / kPitch, 1u);
  places_.resize(std::clamp(maxPictures, 1u, across * across));
  columns_ = static_cast<uint32_t>(std::ceil(std::sqrt(static_cast<float>(places_.size()))));
  rows_ = (static_cast<uint32_t>(places_.size()) + columns_ - 1) / columns_;
}

GlyphPictures::~GlyphPictures() {
  for (const Staging& staging : staging_) destroy(staging);
  if (sampler_) load<PFN_vkDestroySampler>("vkDestroySampler")(device_.device, sampler_, nullptr);
  if (view_) load<PFN_vkDestroyImageView>("vkDestroyImageView")(device_.device, view_, nullptr);
  if (texture_) load<PFN_vkDestroyImage>("vkDestroyImage")(device_.device, texture_, nullptr);
  if (memory_) load<PFN_vkFreeMemory>("vkFreeMemory")(device_.device, memory_, nullptr);
}

VkResult GlyphPictures::allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags,
                                 VkDeviceMemory& memory) const {
  VkMemoryAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  info.allocationSize = needs.size;
  for (uint32_t type = 0; type < device_.memory.memoryTypeCount; ++type)
    if ((needs.memoryTypeBits >> type & 1u) && (device_.memory.memoryTypes[type].propertyFlags & flags) == flags) {
      info.memoryTypeIndex = type;
      return load<PFN_vkAllocateMemory>("vkAllocateMemory")(device_.device, &info, nullptr, &memory);
    }
  return VK_ERROR_OUT_OF_DEVICE_MEMORY;
}

/// Whatever of it is made is destroyed with this, or made use of by the next try.
VkResult GlyphPictures::makeTexture() {
  if (sampler_) return VK_SUCCESS;
  VkResult result = VK_SUCCESS;
  if (!texture_) {
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format();
    info.extent = {columns_ * kPitch, rows_ * kPitch, 1};
    info.mipLevels = kLevels;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    result = load<PFN_vkCreateImage>("vkCreateImage")(device_.device, &info, nullptr, &texture_);
    if (result != VK_SUCCESS) return result;
  }
  if (!memory_) {
    VkMemoryRequirements needs{};
    load<PFN_vkGetImageMemoryRequirements>("vkGetImageMemoryRequirements")(device_.device, texture_, &needs);
    result = allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, memory_);
    if (result != VK_SUCCESS) return result;
    result = load<PFN_vkBindImageMemory>("vkBindImageMemory")(device_.device, texture_, memory_, 0);
    if (result != VK_SUCCESS) return result;
  }
  if (!view_) {
    VkImageViewCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    info.image = texture_;
    info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    info.format = format();
    info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, kLevels, 0, 1};
    result = load<PFN_vkCreateImageView>("vkCreateImageView")(device_.device, &info, nullptr, &view_);
    if (result != VK_SUCCESS) return result;
  }
  VkSamplerCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
  info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  info.mipLodBias = -0.5f; // nearest to the mean over each pixel at 13 to 96 pixels; without, pictures are soft
  info.maxLod = static_cast<float>(kLevels - 1);
  return load<PFN_vkCreateSampler>("vkCreateSampler")(device_.device, &info, nullptr, &sampler_);
}

/// The one that was used longest ago, but none that waits for an upload.
uint32_t GlyphPictures::findPlace() const {
  uint32_t found = kNone;
  for (uint32_t i = 0; i < places_.size(); ++i)
    if (places_[i].used < upload_ && (found == kNone || places_[i].used < places_[found].used)) found = i;
  return found;
}

bool GlyphPictures::full() const { return findPlace() == kNone; }

GpgpResult GlyphPictures::add(const GpgpGlyphImage& image, uint32_t& place) {
  const uint32_t found = findPlace();
  if (found == kNone) return GPGP_BUDGET_EXCEEDED;
  if (const VkResult made = makeTexture(); made != VK_SUCCESS) return codeOf(made);
  constexpr uint32_t kLargest = kPitch - 2 * kMargin;
  Texels ink = texelsOf(image, device_.blendSrgb);
  if (const uint32_t larger = std::max(ink.width, ink.height); larger > kLargest) {
    const auto fitted = [larger](uint32_t side) {
      return std::max(static_cast<uint32_t>(uint64_t{side} * kLargest / larger), 1u);
    };
    ink = shrunk(ink, fitted(ink.width), fitted(ink.height));
  }
  Texels padded{kPitch, kPitch, std::vector<float>(size_t{kPitch} * kPitch * 4)};
  for (uint32_t y = 0; y < ink.height; ++y)
    std::copy_n(ink.at(0, y), size_t{ink.width} * 4, padded.at(kMargin, kMargin + y));
  Pending& pending = pending_.emplace_back();
  pending.place = found;
  for (uint32_t level = 0;; ++level) {
    append(padded, device_.blendSrgb, pending.levels);
    if (level + 1 == kLevels) break;
    padded = halved(padded);
  }
  const uint32_t left = found % columns_ * kPitch + kMargin, top = found / columns_ * kPitch + kMargin;
  const float width = static_cast<float>(columns_ * kPitch), height = static_cast<float>(rows_ * kPitch);
  Place& to = places_[found];
  to.source = {static_cast<float>(left) / width, static_cast<float>(top) / height,
               static_cast<float>(left + ink.width) / width, static_cast<float>(top + ink.height) / height};
  ++to.owner;
  to.used = upload_;
  place = found;
  return GPGP_SUCCESS;
}

// ---------------------------------------------------------------- upload

VkResult GlyphPictures::makeStaging(VkDeviceSize bytes, Staging& staging, void*& mapped) const {
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = bytes;
  info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
  VkResult result = load<PFN_vkCreateBuffer>("vkCreateBuffer")(device_.device, &info, nullptr, &staging.buffer);
  if (result != VK_SUCCESS) return result;
  VkMemoryRequirements needs{};
  load<PFN_vkGetBufferMemoryRequirements>("vkGetBufferMemoryRequirements")(device_.device, staging.buffer, &needs);
  result = allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT, staging.memory);
  if (result != VK_SUCCESS) return result;
  result = load<PFN_vkBindBufferMemory>("vkBindBufferMemory")(device_.device, staging.buffer, staging.memory, 0);
  if (result != VK_SUCCESS) return result;
  return load<PFN_vkMapMemory>("vkMapMemory")(device_.device, staging.memory, 0, VK_WHOLE_SIZE, 0, &mapped);
}

void GlyphPictures::destroy(const Staging& staging) const {
  load<PFN_vkDestroyBuffer>("vkDestroyBuffer")(device_.device, staging.buffer, nullptr);
  load<PFN_vkFreeMemory>("vkFreeMemory")(device_.device, staging.memory, nullptr);
}

GpgpResult GlyphPictures::recordUpload(VkCommandBuffer commands, const GpgpFrame& frame) {
  std::erase_if(staging_, [&](const Staging& staging) {
    if (staging.frame > frame.safe) return false;
    destroy(staging);
    return true;
  });
  ++upload_;
  if (pending_.empty()) return GPGP_SUCCESS;
  const size_t each = pending_.front().levels.size();
  Staging staging;
  staging.frame = frame.current;
  void* mapped = nullptr;
  if (const VkResult made = makeStaging(each * pending_.size(), staging, mapped); made != VK_SUCCESS) {
    destroy(staging);
    for (const Pending& pending : pending_) places_[pending.place].used = upload_; // they go on waiting
    return codeOf(made);
  }
  staging_.push_back(staging);
  std::vector<VkBufferImageCopy> copies;
  for (size_t i = 0; i < pending_.size(); ++i) {
    std::memcpy(static_cast<uint8_t*>(mapped) + i * each, pending_[i].levels.data(), each);
    VkDeviceSize offset = i * each;
    for (uint32_t level = 0; level < kLevels; ++level) {
      const uint32_t side = kPitch >> level;
      VkBufferImageCopy& copy = copies.emplace_back();
      copy.bufferOffset = offset;
      copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1};
      copy.imageOffset = {static_cast<int32_t>(pending_[i].place % columns_ * side),
                          static_cast<int32_t>(pending_[i].place / columns_ * side), 0};
      copy.imageExtent = {side, side, 1};
      offset += VkDeviceSize{side} * side * 4;
    }
  }
  pending_.clear();
  const auto barrier = load<PFN_vkCmdPipelineBarrier>("vkCmdPipelineBarrier");
  VkImageMemoryBarrier change{};
  change.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  change.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
  change.oldLayout = written_ ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_UNDEFINED;
  change.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  change.srcQueueFamilyIndex = change.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  change.image = texture_;
  change.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, kLevels, 0, 1};
  barrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
          VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1, &change);
  load<PFN_vkCmdCopyBufferToImage>("vkCmdCopyBufferToImage")(commands, staging.buffer, texture_,
                                                             VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                                             static_cast<uint32_t>(copies.size()), copies.data());
  change.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
  change.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
  change.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  change.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 0, nullptr, 0, nullptr, 1,
          &change);
  written_ = true;
  return GPGP_SUCCESS;
}

std::optional<GpgpCanvasImage> GlyphPictures::image() const {
  if (!written_) return std::nullopt;
  return GpgpCanvasImage{view_,
                         sampler_,
                         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                         VK_TRUE,
                         device_.blendSrgb ? GPGP_IMAGE_SRGB : GPGP_IMAGE_LINEAR,
                         GPGP_IMAGE_FILTER_LINEAR};
}

} // namespace gpgp::integration
