// Picture files for the sample: PNG and uncompressed TGA.
#pragma once
#include "gpgp_rmlui.hpp"

#include <string>

namespace gpgp::sample {

/// Of bytes; false: neither PNG nor TGA.
bool decode(const std::string& bytes, rmlui::DecodedImage& image);
/// rgba: colours as they are, alpha is left out.
bool writePng(const std::string& file, uint32_t width, uint32_t height, const uint8_t* rgba);

} // namespace gpgp::sample
