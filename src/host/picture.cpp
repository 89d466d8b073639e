// PNG in and out, the sRGB transfer function, and a plain comparison.
#include "host/picture.h"

#include "host/files.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <new>
#include <stdexcept>

namespace gpgp::host {

void writePng(const std::filesystem::path& file, const Picture& picture) {
  if (picture.rgba.size() != size_t{picture.width} * picture.height * 4 || picture.rgba.empty())
    throw std::runtime_error(file.string() + ": a picture's size and its pixels do not agree");
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = picture.width;
  image.height = picture.height;
  image.format = PNG_FORMAT_RGBA;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.rgba.data(), 0, nullptr))
    throw std::runtime_error(file.string() + ": " + image.message);
  writeFile(file, {bytes.data(), size});
}

Picture readPng(const std::filesystem::path& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const std::vector<uint8_t> bytes = readFile(file);
  if (!png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()))
    throw std::runtime_error(file.string() + ": " + image.message);
  image.format = PNG_FORMAT_RGBA;
  Picture picture;
  picture.width = image.width;
  picture.height = image.height;
  picture.rgba.resize(PNG_IMAGE_SIZE(image));
  if (!png_image_finish_read(&image, nullptr, picture.rgba.data(), 0, nullptr)) {
    png_image_free(&image);
    throw std::runtime_error(file.string() + ": " + image.message);
  }
  return picture;
}

namespace {
struct PngReader {
  std::vector<uint8_t> bytes;
  size_t at = 0;
  std::string message;
  png_structp png = nullptr;
  png_infop info = nullptr;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }

  static void fail(png_structp png, png_const_charp text) {
    static_cast<PngReader*>(png_get_error_ptr(png))->message = text;
    png_longjmp(png, 1);
  }
  static void read(png_structp png, png_bytep to, size_t size) {
    PngReader& from = *static_cast<PngReader*>(png_get_io_ptr(png));
    if (size > from.bytes.size() - from.at) png_error(png, "the file is cut");
    std::copy_n(from.bytes.begin() + std::ptrdiff_t(from.at), size, to);
    from.at += size;
  }
  /// False: libpng has jumped back, past nothing that has a destructor.
  bool run() {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_read_fn(png, this, read);
    png_read_png(png, info, PNG_TRANSFORM_EXPAND, nullptr);
    return true;
  }
};
} // namespace

Heights readHeights(const std::filesystem::path& file) {
  PngReader reader;
  reader.bytes = readFile(file);
  reader.png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, PngReader::fail, [](png_structp, png_const_charp) {});
  reader.info = reader.png ? png_create_info_struct(reader.png) : nullptr;
  if (!reader.info) throw std::bad_alloc();
  if (!reader.run()) throw std::runtime_error(file.string() + ": " + reader.message);
  Heights heights{png_get_image_width(reader.png, reader.info), png_get_image_height(reader.png, reader.info), {}};
  const bool wide = png_get_bit_depth(reader.png, reader.info) == 16;
  const size_t stride = png_get_channels(reader.png, reader.info) * (wide ? 2u : 1u);
  png_bytepp rows = png_get_rows(reader.png, reader.info);
  for (uint32_t y = 0; y < heights.height; ++y)
    for (size_t x = 0; x < heights.width; ++x) {
      const png_bytep texel = rows[y] + x * stride;
      heights.values.push_back(static_cast<uint16_t>(wide ? texel[0] << 8 | texel[1] : texel[0] * 257));
    }
  return heights;
}

float linearFromSrgb(float value) {
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

float srgbFromLinear(float value) {
  return value <= 0.0031308f ? value * 12.92f : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
}

namespace {
uint8_t toByte(float value) { return static_cast<uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f)); }
} // namespace

Picture fromLinearPremultiplied(uint32_t width, uint32_t height, std::span<const float> pixels) {
  Picture picture{width, height, std::vector<uint8_t>(size_t{width} * height * 4)};
  if (pixels.size() != picture.rgba.size()) throw std::runtime_error("wrong number of pixel values");
  for (size_t i = 0; i < pixels.size(); i += 4) {
    const float alpha = pixels[i + 3];
    for (size_t c = 0; c < 3; ++c)
      picture.rgba[i + c] =
          alpha > 0 ? toByte(srgbFromLinear(std::clamp(pixels[i + c] / alpha, 0.0f, 1.0f))) : uint8_t{0};
    picture.rgba[i + 3] = toByte(alpha);
  }
  return picture;
}

Picture fromPremultiplied(uint32_t width, uint32_t height, std::span<const uint8_t> pixels) {
  Picture picture{width, height, std::vector<uint8_t>(pixels.begin(), pixels.end())};
  if (pixels.size() != size_t{width} * height * 4) throw std::runtime_error("wrong number of pixel values");
  for (size_t i = 0; i < pixels.size(); i += 4) {
    if (pixels[i + 3] == 0 || pixels[i + 3] == 255) continue;
    for (size_t c = 0; c < 3; ++c)
      picture.rgba[i + c] = toByte(static_cast<float>(pixels[i + c]) / static_cast<float>(pixels[i + 3]));
  }
  return picture;
}

PictureDifference compare(const Picture& a, const Picture& b) {
  if (a.width != b.width || a.height != b.height) throw std::runtime_error("pictures of different sizes");
  PictureDifference difference;
  uint64_t sum = 0;
  for (size_t i = 0; i < a.rgba.size(); i += 4) {
    bool differs = false;
    for (size_t c = 0; c < 4; ++c) {
      const uint32_t d = static_cast<uint32_t>(std::abs(a.rgba[i + c] - b.rgba[i + c]));
      difference.largest = std::max(difference.largest, d);
      sum += d;
      differs |= d != 0;
    }
    difference.pixelsDifferent += differs ? 1 : 0;
  }
  difference.mean = a.rgba.empty() ? 0.0 : static_cast<double>(sum) / static_cast<double>(a.rgba.size());
  return difference;
}

} // namespace gpgp::host
