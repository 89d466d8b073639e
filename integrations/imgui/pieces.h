// What is taken out of ImGui's draw lists: pieces of text and widgets with their places, and the layers they lie in.
// Pure CPU work.
#pragma once
#include <gpgp/text.h>
#include <imgui.h>

#include <deque>
#include <vector>

namespace gpgp::imgui {

/// Framebuffer pixels, half open. Empty where no pixel is in it.
struct Rect {
  int left = 0, top = 0, right = 0, bottom = 0;
  bool empty() const { return left >= right || top >= bottom; }
};
Rect intersect(const Rect& a, const Rect& b);
Rect unite(const Rect& a, const Rect& b); ///< the smallest around both; neither is empty
inline bool overlap(const Rect& a, const Rect& b) { return !intersect(a, b).empty(); }
/// All pixels that the box touches.
Rect pixels(float left, float top, float right, float bottom);

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

/// What is drawn in one go.
struct Piece {
  void* owner = nullptr;
  struct Part {
    Rect ink;   ///< where the canvas is painted
    Rect shown; ///< what of it is drawn
  };
  std::vector<Part> parts; ///< no two are shown in the same pixel
  Rect clip;
  int layer = -1; ///< none: not drawn
  // What is painted: glyphs [first, first + count) and lines of the frame, or a drawing.
  size_t firstGlyph = 0, glyphCount = 0, firstLine = 0, lineCount = 0;
  GpgpAsset drawing = nullptr;
  float transform[6] = {};
  // A widget, before the draw data are there: ImGui's units.
  ImVec2 position, size; ///< size: of a drawing's box
  float ink[4] = {};     ///< of glyphs and lines, from the position: left, top, right, bottom
};

struct Pieces {
  std::deque<Piece> all;                 ///< stay where they are: draw lists point to them
  std::vector<GpgpTextGlyph> glyphs;     ///< font, glyph and color; x, y and size in framebuffer pixels
  std::vector<GpgpTextDecoration> lines; ///< rect in framebuffer pixels
  uint32_t layers = 0;
  uint32_t dropped = 0; ///< glyphs and widgets without room or layer

  void clear();
};

struct PiecesInfo {
  ImDrawCallback callback = nullptr; ///< of widgets in the lists, and of what takes their place
  void* owner = nullptr;
  const std::vector<AtlasGlyph>* atlas = nullptr;
  ImTextureID atlasTexture = nullptr;
  bool srgbTarget = false;
  uint32_t maxLayers = 4, maxGlyphs = 8192, maxDrawings = 64;
};

/// Takes glyphs and widgets out of the draw data, leaves callbacks in their place, and gives each a layer.
void collect(ImDrawData& data, const PiecesInfo& info, Pieces& pieces);

} // namespace gpgp::imgui
