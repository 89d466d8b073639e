// How glyphs travel through RmlUi: as quads of a mesh, which it keeps, moves and hands to the renderer.
//
// The four corners of a glyph's quad are its ink box. Texture coordinates of the corners: font and glyph number; size
// and 0; place of its origin; 0. The texture of such a mesh is textTexture(style).
#pragma once
#include "frame.h"

namespace gpgp::rmlui {

struct MeshGlyph {
  uint32_t font = 0, glyph = 0; ///< font: FontEngine's number
  float x = 0, y = 0, size = 0; ///< origin on the baseline, pixels per em
};

/// The texture coordinates of a glyph's corners.
inline std::array<std::array<float, 2>, 4> encode(const MeshGlyph& g) {
  return {{{float(g.font), float(g.glyph)}, {g.size, 0}, {g.x, g.y}, {0, 0}}};
}
/// Of the four corners; a mesh of glyphs has nothing else.
inline MeshGlyph decode(const GpgpListVertex* corners) {
  return {uint32_t(corners[0].u), uint32_t(corners[0].v), corners[2].u, corners[2].v, corners[1].u};
}

/// The name by which the renderer knows the texture of a mesh of glyphs: no file is called so.
std::string textTexture(const TextStyle& style);
std::optional<TextStyle> textStyleOf(const std::string& texture);

} // namespace gpgp::rmlui
