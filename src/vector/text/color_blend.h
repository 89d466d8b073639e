// How PaintComposite of COLR version 1 puts a source over a backdrop (OpenType 1.9.1; Compositing and Blending 1).
#pragma once
#include <array>
#include <cstdint>

namespace gpgp::text {

/// sRGB as it is encoded, premultiplied, from 0 to 1.
using Pixel = std::array<float, 4>;

constexpr uint32_t kCompositeModes = 28;

/// A mode by its number in the table: CLEAR is 0, SRC_OVER 3, HSL_LUMINOSITY 27. A number beyond is SRC_OVER.
Pixel composite(uint32_t mode, const Pixel& source, const Pixel& backdrop);

} // namespace gpgp::text
