// Colour glyphs of COLR version 1 as pictures: what paths cannot show.
#pragma once
#include "vector/text/font.h"

namespace gpgp::text {

/// RGBA of 8 bits, sRGB, straight alpha, rows from the top.
struct ColorPicture {
  static constexpr float kTexels = 256; ///< an em; fewer where the glyph would have more than kMost on a side
  static constexpr uint32_t kMost = 1024;
  std::vector<uint8_t> pixels;
  uint32_t width = 0, height = 0;
  float box[4] = {}; ///< left, top, right, bottom in em, +Y down
};

/// Paints a glyph's graph: solid colours, linear, radial and sweep gradients, shapes in shapes, all composite modes.
/// Errors: INVALID_DATA (the table is broken, the graph goes round in circles), UNSUPPORTED (it takes too much work).
/// Under the font's lock.
Result<ColorPicture> paintColorPicture(Font& font, const GpgpGlyphOutlineInfo& info);

} // namespace gpgp::text
