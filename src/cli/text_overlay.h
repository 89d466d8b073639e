// What of a page no glyph set takes: bitmap glyphs, underlines and strikes. A drawing in pixels of the page, to be
// painted over the other glyphs.
#pragma once
#include "cli/text_glyphs.h"
#include "cli/textures.h"

namespace gpgp::cli {

struct TextOverlay {
  Drawing drawing;                 ///< null: nothing is there
  uint32_t patches = 0;            ///< of the drawing
  std::unique_ptr<Textures> atlas; ///< of bitmap glyphs; the drawing's only image
};
TextOverlay makeOverlay(Session& session, const GpgpLayoutInfo& layout, const PageGlyphs& glyphs);

} // namespace gpgp::cli
