#include "cli/shared/textures.h"

#include <algorithm>
#include <cmath>

namespace gpgp::cli {
namespace {

/// The same picture with another number of texels along one side, not more than it has: each takes what it covers.
/// Straight alpha. As the picture is encoded, in which canvases with blendSrgb mix.
host::Picture resized(const host::Picture& from, bool wide, uint32_t length) {
  const uint32_t old = wide ? from.width : from.height;
  if (length == old) return from;
  host::Picture to{wide ? length : from.width, wide ? from.height : length, {}};
  to.rgba.resize(size_t{to.width} * to.height * 4);
  const double step = static_cast<double>(old) / length;
  for (uint32_t i = 0; i < length; ++i) {
    const double begin = i * step, end = i + 1 == length ? old : (i + 1) * step;
    const auto first = static_cast<uint32_t>(begin), last = std::min(static_cast<uint32_t>(std::ceil(end)), old);
    for (uint32_t k = 0; k < (wide ? to.height : to.width); ++k) {
      double sum[4] = {};
      for (uint32_t at = first; at < last; ++at) {
        const size_t texel = wide ? size_t{k} * from.width + at : size_t{at} * from.width + k;
        const uint8_t* source = &from.rgba[texel * 4];
        const double alpha = source[3] * (std::min(end, at + 1.0) - std::max(begin, double(at)));
        for (size_t c = 0; c < 3; ++c) sum[c] += source[c] * alpha;
        sum[3] += alpha;
      }
      uint8_t* out = &to.rgba[(wide ? size_t{k} * to.width + i : size_t{i} * to.width + k) * 4];
      for (size_t c = 0; c < 3; ++c) out[c] = static_cast<uint8_t>(sum[3] > 0 ? sum[c] / sum[3] + 0.5 : 0);
      out[3] = static_cast<uint8_t>(sum[3] / (end - begin) + 0.5);
    }
  }
  return to;
}

/// How many texels are enough along a side of which a share lies along a pixel.
uint32_t enough(uint32_t length, double share) {
  while (share * length >= 1.5 && length > 1) length = (length + 1) / 2;
  return length;
}

/// All levels of a picture, as a texture's are stored.
std::vector<uint8_t> withLevels(const host::Picture& picture, uint32_t levels) {
  std::vector<uint8_t> bytes = picture.rgba;
  for (uint32_t level = 1; level < levels; ++level) {
    const host::Picture smaller = resized(resized(picture, true, std::max(picture.width >> level, 1u)), false,
                                          std::max(picture.height >> level, 1u));
    bytes.insert(bytes.end(), smaller.rgba.begin(), smaller.rgba.end());
  }
  return bytes;
}

} // namespace

TexturePicture shrunk(host::Picture picture, const ShareOfPixel& largest, const ShareOfPixel& smallest) {
  TexturePicture shown{std::move(picture), 1};
  host::Picture& kept = shown.picture;
  kept = resized(kept, true, enough(kept.width, largest.across));
  kept = resized(kept, false, enough(kept.height, largest.down));
  const double most = std::max(smallest.across * kept.width, smallest.down * kept.height);
  for (double texels = most; texels >= 1.5 && (std::max(kept.width, kept.height) >> shown.levels) > 0; texels /= 2)
    ++shown.levels;
  return shown;
}

Textures::Textures(host::HeadlessDevice& device, const std::vector<TexturePicture>& pictures) : device_(device) {
  if (pictures.empty()) return;
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
  info.maxLod = VK_LOD_CLAMP_NONE;
  info.addressModeU = info.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  host::check(device.vk().vkCreateSampler(device.device(), &info, nullptr, &sampler_), "vkCreateSampler");
  for (const auto& [picture, levels] : pictures) {
    textures_.emplace_back(device, host::ImageInfo{.format = VK_FORMAT_R8G8B8A8_UNORM,
                                                   .width = picture.width,
                                                   .height = picture.height,
                                                   .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                                   .levels = levels});
    const host::Image& image = textures_.back();
    host::uploadImage(device, image, withLevels(picture, levels), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    views_.push_back({image.view(), sampler_, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_FALSE, GPGP_IMAGE_SRGB,
                      GPGP_IMAGE_FILTER_LINEAR});
  }
}

Textures::~Textures() {
  if (sampler_) device_.vk().vkDestroySampler(device_.device(), sampler_, nullptr);
}

} // namespace gpgp::cli
