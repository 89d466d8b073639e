// Pictures as PNG files.
#include "target.h"

#include <png.h>

#include <filesystem>

namespace mini {

void writePng(const std::string& file, VkExtent2D extent, const void* pixels) {
  const std::filesystem::path path(file);
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path());
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = extent.width;
  png.height = extent.height;
  png.format = PNG_FORMAT_RGBA; // sRGB-encoded, as PNG wants it
  if (!png_image_write_to_file(&png, file.c_str(), 0, pixels, 0, nullptr))
    throw std::runtime_error(file + ": " + png.message);
}

} // namespace mini
