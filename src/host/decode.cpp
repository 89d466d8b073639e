// stb_image, for PNG and JPEG in memory.
#include "host/picture.h"

#include <cstring>
#include <memory>

#if defined __GNUC__
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#include <stb/stb_image.h>
#if defined __GNUC__
#pragma GCC diagnostic pop
#endif

namespace gpgp::host {

Picture decodePicture(std::span<const uint8_t> bytes) {
  constexpr int kLargest = 16384;
  int width = 0, height = 0, channels = 0;
  const int size = static_cast<int>(bytes.size());
  if (bytes.size() > size_t(1) << 30 || !stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) ||
      width > kLargest || height > kLargest)
    return {};
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4), stbi_image_free);
  if (!pixels) return {};
  Picture picture{static_cast<uint32_t>(width), static_cast<uint32_t>(height), {}};
  picture.rgba.assign(pixels.get(), pixels.get() + size_t(picture.width) * picture.height * 4);
  return picture;
}

} // namespace gpgp::host
