// The paths of one glyph while they are gathered, in em, y down.
#pragma once
#include "vector/text/font.h"

#include <array>
#include <deque>

#include FT_OUTLINE_H

namespace gpgp::text {

/// x' = m0 x + m2 y + m4, y' = m1 x + m3 y + m5, as in vector.h.
using Affine = std::array<float, 6>;
constexpr Affine kIdentity = {1, 0, 0, 1, 0, 0};
/// First inner, then outer.
Affine concat(const Affine& outer, const Affine& inner);

class GlyphPaths {
public:
  /// Adds a glyph's plain outline, mapped by `transform` (em, y up). INVALID_DATA where the font is broken there or a
  /// point leaves what a path may hold. Under the font's lock.
  Result<void> addGlyph(Font& font, uint32_t glyph, const Affine& transform);
  /// Paints what was added since the last call. Nothing where nothing was.
  void paint(const float (&color)[4], bool foreground, const GpgpStroke* stroke = nullptr);
  /// The same with a gradient, of which copies are kept; the color's alpha counts.
  void paint(const GpgpGradient& gradient, const float (&color)[4]);
  /// Points into this object.
  GpgpGlyphOutline outline(uint32_t glyph);

private:
  struct Part {
    uint32_t verbs, points; // where it ends
    float color[4];
    const GpgpGradient* gradient;
    const GpgpStroke* stroke;
  };
  void begin(float x, float y);
  void point(float x, float y);
  bool decompose(FT_Outline& outline);
  void draw(const Font& font, uint32_t glyph);
  Part* close();

  std::vector<GpgpPathVerb> verbs_;
  std::vector<float> points_;
  std::vector<Part> parts_;
  std::vector<VkBool32> foreground_;
  std::deque<GpgpGradient> gradients_;
  std::deque<std::vector<GpgpGradientStop>> stops_;
  std::vector<GpgpPath> paths_;
  float scale_ = 0;
  Affine transform_ = kIdentity;
  bool open_ = false;
};

struct ColorPicture;
/// The colour layers of a glyph, where the font has some: false if not. What paths cannot show becomes a picture, which
/// counts instead of them. color.cpp
Result<bool> addColors(Font& font, const GpgpGlyphOutlineInfo& info, GlyphPaths& paths, ColorPicture& picture,
                       bool& incomplete);

} // namespace gpgp::text
