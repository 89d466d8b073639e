// ImGui's font builder: the atlas's fonts opened by gpgp.
#pragma once
#include <gpgp/gpgp.hpp>
#include <imgui_internal.h>

#include <functional>
#include <vector>

namespace gpgp::imgui {

/// A glyph of an ImGui font. Its quads are known by their texture coordinates, which lie outside of the texture.
struct AtlasGlyph {
  GpgpFont font = nullptr;
  uint32_t glyph = 0;
  float box[4] = {}; ///< em: left, top, right, bottom
};
/// Texture coordinates of glyph number i: one unit wide and high, its corner at an even place beyond 1.
inline ImVec2 glyphCorner(uint32_t i) {
  return {2.0f + 2.0f * static_cast<float>(i & 1023u), 2.0f + 2.0f * static_cast<float>(i >> 10)};
}

/// What ImGui calls when an atlas is to be built. Hangs in the atlas, which knows it by its base class.
struct FontBuilder : ImFontBuilderIO {
  FontBuilder();
  FontBuilder(const FontBuilder&) = delete;
  FontBuilder& operator=(const FontBuilder&) = delete;

  std::vector<AtlasGlyph> glyphs;        ///< by their number in texture coordinates
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
