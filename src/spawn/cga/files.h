// Files that programs name, which were written on systems that do not tell capital letters from small ones.
#pragma once
#include <cstdint>
#include <string>

namespace gpgp::spawn::cga {

/// The path of a regular file as it is on the disk: as it stands, or else with names that differ in capital letters
/// alone. Empty: there is none.
std::string existingFile(const std::string& path);

/// Extents of a picture in pixels, from the header of a PNG, JPEG, GIF or BMP file.
struct PictureSize {
  uint32_t width = 0, height = 0; ///< 0: it is none of these
};
PictureSize pictureSize(const std::string& file);

} // namespace gpgp::spawn::cga
