#include "cli/shared/textures.h"

#include <algorithm>

namespace gpgp::cli {
namespace {

/// Half as wide, or half as tall; straight alpha. As the picture is encoded, in which canvases with blendSrgb mix.
host::Picture halved(const host::Picture& from, bool wide) {
  host::Picture to{wide ? (from.width + 1) / 2 : from.width, wide ? from.height : (from.height + 1) / 2, {}};
  to.rgba.resize(size_t{to.width} * to.height * 4);
  for (uint32_t y = 0; y < to.height; ++y)
    for (uint32_t x = 0; x < to.width; ++x) {
      const uint32_t x0 = wide ? 2 * x : x, y0 = wide ? y : 2 * y;
      const uint32_t x1 = wide ? std::min(x0 + 1, from.width - 1) : x0,
                     y1 = wide ? y0 : std::min(y0 + 1, from.height - 1);
      const uint8_t* a = &from.rgba[(size_t{y0} * from.width + x0) * 4];
      const uint8_t* b = &from.rgba[(size_t{y1} * from.width + x1) * 4];
      uint8_t* out = &to.rgba[(size_t{y} * to.width + x) * 4];
      const int alpha = a[3] + b[3];
      for (size_t c = 0; c < 3; ++c)
        out[c] = static_cast<uint8_t>(alpha ? (a[c] * a[3] + b[c] * b[3] + alpha / 2) / alpha : 0);
      out[3] = static_cast<uint8_t>((alpha + 1) / 2);
    }
  return to;
}

} // namespace

host::Picture shrunk(host::Picture picture, double texelsAcross, double texelsDown) {
  for (; texelsAcross >= 1.5 && picture.width > 1; texelsAcross /= 2) picture = halved(picture, true);
  for (; texelsDown >= 1.5 && picture.height > 1; texelsDown /= 2) picture = halved(picture, false);
  return picture;
}

Textures::Textures(host::HeadlessDevice& device, const std::vector<host::Picture>& pictures) : device_(device) {
  if (pictures.empty()) return;
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.addressModeU = info.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  host::check(device.vk().vkCreateSampler(device.device(), &info, nullptr, &sampler_), "vkCreateSampler");
  for (const host::Picture& picture : pictures) {
    textures_.emplace_back(device, host::ImageInfo{.format = VK_FORMAT_R8G8B8A8_UNORM,
                                                   .width = picture.width,
                                                   .height = picture.height,
                                                   .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
    const host::Image& image = textures_.back();
    host::uploadImage(device, image, picture.rgba, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    views_.push_back({image.view(), sampler_, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_FALSE, GPGP_IMAGE_SRGB,
                      GPGP_IMAGE_FILTER_LINEAR});
  }
}

Textures::~Textures() {
  if (sampler_) device_.vk().vkDestroySampler(device_.device(), sampler_, nullptr);
}

} // namespace gpgp::cli
