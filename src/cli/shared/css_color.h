// Colours of the command line, as CSS writes them.
#pragma once
#include <array>
#include <string>

namespace gpgp::cli {

/// As sRGB encodes it, 0 to 1, straight alpha; nothing for an empty text. Throws Usage, which names the option, where
/// the text is no CSS colour.
std::array<float, 4> parseCssColor(const std::string& option, const std::string& text);
/// The same with colours times alpha, as canvases take backgrounds.
std::array<float, 4> parseBackground(const std::string& text);

} // namespace gpgp::cli
