// stb_image, for PNG, JPEG and the first picture of a GIF in memory, and libwebp, where it is there.
#include "host/picture.h"

#include <cstring>
#include <memory>
#ifdef GPGP_HOST_WEBP
#include <webp/decode.h>
#endif

#if defined __GNUC__
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_GIF
#define STBI_NO_STDIO
#include <stb/stb_image.h>
#if defined __GNUC__
#pragma GCC diagnostic pop
#endif

namespace gpgp::host {
namespace {

/// Whether a JPEG file has four components and no Adobe segment that says which: stb_image takes them for YCbCr.
bool isUnmarkedCmyk(std::span<const uint8_t> bytes) {
  if (bytes.size() < 4 || bytes[0] != 0xff || bytes[1] != 0xd8) return false;
  for (size_t at = 2; at + 10 <= bytes.size() && bytes[at] == 0xff;) {
    const uint8_t marker = bytes[at + 1];
    if (marker == 0xff) { // padding
      ++at;
      continue;
    }
    if (marker == 0xee && at + 9 <= bytes.size() && std::memcmp(&bytes[at + 4], "Adobe", 5) == 0) return false;
    if (marker == 0xda) return false;
    const bool isFrame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (isFrame) return bytes[at + 9] == 4;
    at += 2 + (size_t{bytes[at + 2]} << 8 | bytes[at + 3]);
  }
  return false;
}

constexpr int kLargest = 16384;
/// Pixels that are decoded over and over: a progressive JPEG file has some ten scans, one made to take time thousands.
constexpr uint64_t kMostScanned = uint64_t(1) << 32;

/// At most: what looks like the beginning of one within compressed data counts, too.
uint64_t scansOf(std::span<const uint8_t> bytes) {
  uint64_t scans = 0;
  for (size_t i = 0; i + 1 < bytes.size(); ++i) scans += bytes[i] == 0xff && bytes[i + 1] == 0xda;
  return scans;
}

#ifdef GPGP_HOST_WEBP
Picture decodeWebp(std::span<const uint8_t> bytes) {
  int width = 0, height = 0;
  if (!WebPGetInfo(bytes.data(), bytes.size(), &width, &height) || width > kLargest || height > kLargest) return {};
  Picture picture{static_cast<uint32_t>(width), static_cast<uint32_t>(height), {}};
  picture.rgba.resize(size_t(picture.width) * picture.height * 4);
  if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), picture.rgba.data(), picture.rgba.size(), width * 4)) return {};
  return picture;
}
#endif

} // namespace

Picture decodePicture(std::span<const uint8_t> bytes) {
#ifdef GPGP_HOST_WEBP
  if (bytes.size() >= 12 && std::memcmp(bytes.data(), "RIFF", 4) == 0 && std::memcmp(&bytes[8], "WEBP", 4) == 0)
    return decodeWebp(bytes);
#endif
  int width = 0, height = 0, channels = 0;
  const int size = static_cast<int>(bytes.size());
  if (bytes.size() > size_t(1) << 30 || !stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) ||
      width > kLargest || height > kLargest || isUnmarkedCmyk(bytes) ||
      (bytes[0] == 0xff && scansOf(bytes) * uint64_t(width) * uint64_t(height) > kMostScanned))
    return {};
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4), stbi_image_free);
  if (!pixels) return {};
  Picture picture{static_cast<uint32_t>(width), static_cast<uint32_t>(height), {}};
  picture.rgba.assign(pixels.get(), pixels.get() + size_t(picture.width) * picture.height * 4);
  return picture;
}

} // namespace gpgp::host
