// Pictures in memory and as PNG (libpng's simplified interface): 8-bit RGBA, sRGB, straight alpha.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace gpgp::host {

struct Picture {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgba; ///< rows from the top, 4 bytes a pixel
};

/// Makes missing folders. Throws with the file's name and libpng's words.
void writePng(const std::filesystem::path& file, const Picture& picture);
Picture readPng(const std::filesystem::path& file);

/// Of a PNG's first channel what the file says: no gamma, no colour space. 8 bits become 16.
struct Heights {
  uint32_t width = 0, height = 0;
  std::vector<uint16_t> values; ///< rows from the top
};
Heights readHeights(const std::filesystem::path& file);

/// From PNG, JPEG, GIF or, with libwebp, WebP in memory; empty where it is none, or damaged, or larger than 16384
/// pixels a side.
Picture decodePicture(std::span<const uint8_t> bytes);

/// From premultiplied linear floats (4 a pixel), as a canvas gives them, to straight sRGB bytes.
Picture fromLinearPremultiplied(uint32_t width, uint32_t height, std::span<const float> pixels);
/// The same from bytes that hold sRGB-encoded colour times alpha, as a canvas writes with encodeSrgb.
Picture fromPremultiplied(uint32_t width, uint32_t height, std::span<const uint8_t> pixels);

float linearFromSrgb(float value); ///< 0 to 1, IEC 61966-2-1
float srgbFromLinear(float value);

/// How two pictures of one size differ. Throws where the sizes differ.
struct PictureDifference {
  uint32_t largest = 0;         ///< largest difference of one channel, 0 to 255
  double mean = 0;              ///< over all channels
  uint64_t pixelsDifferent = 0; ///< with any channel different
};
PictureDifference compare(const Picture& a, const Picture& b);

} // namespace gpgp::host
