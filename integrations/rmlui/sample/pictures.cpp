#include "pictures.h"

#include <png.h>

#include <cstring>

namespace gpgp::sample {
namespace {

void premultiply(std::vector<uint8_t>& pixels) {
  for (size_t i = 0; i + 3 < pixels.size(); i += 4)
    for (size_t c = 0; c < 3; ++c) pixels[i + c] = static_cast<uint8_t>(pixels[i + c] * pixels[i + 3] / 255);
}

bool decodePng(const std::string& bytes, rmlui::DecodedImage& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size())) return false;
  png.format = PNG_FORMAT_RGBA;
  image.width = png.width;
  image.height = png.height;
  image.pixels.resize(PNG_IMAGE_SIZE(png));
  return png_image_finish_read(&png, nullptr, image.pixels.data(), 0, nullptr) != 0;
}

/// Type 2, 24 or 32 bits.
bool decodeTga(const std::string& bytes, rmlui::DecodedImage& image) {
  constexpr size_t kHeader = 18;
  if (bytes.size() < kHeader) return false;
  const auto at = [&](size_t i) { return static_cast<uint32_t>(static_cast<uint8_t>(bytes[i])); };
  const uint32_t channels = at(16) / 8;
  if (at(1) != 0 || at(2) != 2 || (channels != 3 && channels != 4)) return false;
  image.width = at(12) | at(13) << 8;
  image.height = at(14) | at(15) << 8;
  const size_t start = kHeader + at(0);
  if (bytes.size() < start + size_t{image.width} * image.height * channels) return false;
  const bool fromTop = (at(17) & 32u) != 0;
  image.pixels.resize(size_t{image.width} * image.height * 4);
  for (uint32_t y = 0; y < image.height; ++y)
    for (uint32_t x = 0; x < image.width; ++x) {
      const size_t from = start + (size_t{fromTop ? y : image.height - 1 - y} * image.width + x) * channels;
      uint8_t* to = &image.pixels[(size_t{y} * image.width + x) * 4];
      for (size_t c = 0; c < 3; ++c) to[c] = static_cast<uint8_t>(bytes[from + 2 - c]);
      to[3] = channels == 4 ? static_cast<uint8_t>(bytes[from + 3]) : uint8_t{255};
    }
  return true;
}

} // namespace

bool decode(const std::string& bytes, rmlui::DecodedImage& image) {
  if (!decodePng(bytes, image) && !decodeTga(bytes, image)) return false;
  premultiply(image.pixels);
  return true;
}

bool writePng(const std::string& file, uint32_t width, uint32_t height, const uint8_t* rgba) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = width;
  png.height = height;
  png.format = PNG_FORMAT_RGB;
  std::vector<uint8_t> rgb;
  rgb.reserve(size_t{width} * height * 3);
  for (size_t i = 0; i < size_t{width} * height; ++i) rgb.insert(rgb.end(), rgba + i * 4, rgba + i * 4 + 3);
  return png_image_write_to_file(&png, file.c_str(), 0, rgb.data(), 0, nullptr) != 0;
}

} // namespace gpgp::sample
