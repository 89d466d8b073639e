// ImGui's font builder: the atlas's fonts opened by gpgp.
#pragma once
#include "pieces.h"

#include <gpgp/gpgp.hpp>
#include <imgui_internal.h>

#include <functional>

namespace gpgp::imgui {

/// What ImGui calls when an atlas is to be built. Hangs in the atlas, which knows it by its base class.
struct FontBuilder : ImFontBuilderIO {
  FontBuilder();
  FontBuilder(const FontBuilder&) = delete;
  FontBuilder& operator=(const FontBuilder&) = delete;

  std::vector<AtlasGlyph> glyphs; ///< by their number in texture coordinates
  std::function<void(GpgpFont)> onClose; ///< fonts of an atlas that is built anew

private:
  static bool build(ImFontAtlas* atlas);
  bool buildFonts(ImFontAtlas& atlas);
  bool addGlyphs(ImFontConfig& config, const Font& font, float em, const ImWchar* ranges, ImFontAtlas& atlas);
  std::vector<Font> fonts_;
  Shaper shaper_;
  Layout layout_;
};

} // namespace gpgp::imgui
