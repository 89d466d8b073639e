// A page of text as a picture: drawn on the GPU, in bands where it is too much for one recording.
#pragma once
#include "cli/text/glyphs.h"

namespace gpgp::cli {

/// Where the page lies in its picture.
struct PageFrame {
  Size size;
  float left = 0, top = 0;             ///< of the layout's 0, 0
  std::array<float, 4> background{};   ///< sRGB, premultiplied
  std::array<float, 4> outlineColor{}; ///< linear, straight alpha
};

struct DrawnPage {
  host::Picture picture;
  uint32_t recordings = 0; ///< bands, from top to bottom
  double milliseconds = 0; ///< median of the repeats, summed over recordings
  GpgpResult status = GPGP_SUCCESS;
};

/// Each recording runs once more than `repeat`; the first time does not count.
DrawnPage drawPage(Session& session, const GpgpLayoutInfo& layout, const PageGlyphs& glyphs, const PageFrame& frame,
                   uint32_t repeat);

} // namespace gpgp::cli
