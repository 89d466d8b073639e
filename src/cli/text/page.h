// A string laid out in fonts: what `gpgp text` draws.
#pragma once
#include <gpgp/gpgp.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace gpgp::cli {

/// "wght=650,wdth=80"; throws Usage, which names --axes, otherwise.
std::vector<GpgpFontAxisValue> parseAxes(const std::string& list);

struct PageOptions {
  std::vector<std::string> fonts;      ///< files; the first is the font, the others what falls back
  uint32_t face = 0;                   ///< of the first, where it is a collection
  std::vector<GpgpFontAxisValue> axes; ///< of the first
  std::string text, language;
  float size = 32, width = 0; ///< pixels; width 0: lines end only where the text says
  float height = 0, letterSpacing = 0, lineSpacing = 0, lineHeight = 0, tabWidth = 0; ///< as GpgpTextInfo's
  uint32_t maxLines = 0;
  std::optional<std::string> ellipsis; ///< none: the API's own
  GpgpTextAlign align = GPGP_TEXT_ALIGN_START;
  GpgpTextDirection direction = GPGP_TEXT_AUTO;
  std::vector<GpgpFontFeature> features;
  float color[4] = {0, 0, 0, 1}; ///< linear, straight alpha
  bool underline = false, strike = false;
  float outlineWidth = 0;               ///< pixels; 0: none
  float outlineColor[4] = {1, 1, 1, 1}; ///< as color
};

class TextPage {
public:
  /// Throws Failure, which names the file, where one is no font. Says on standard error which characters no font has,
  /// and which bytes are not UTF-8.
  explicit TextPage(const PageOptions& options);
  TextPage(const TextPage&) = delete; // fonts and shaper refer to its messages
  TextPage& operator=(const TextPage&) = delete;

  const GpgpLayoutInfo& layout() const { return layoutInfo_; }
  double shapeMilliseconds() const { return shapeMilliseconds_; } ///< of the layout, with an empty cache
  /// Characters that no font has, each once, as "U+0041".
  const std::vector<std::string>& missing() const { return missing_; }
  uint32_t fontNumber(GpgpFont font) const;
  /// The line along glyphs' edges; NULL: the text has none.
  const GpgpStroke* stroke() const { return stroke_.width > 0 ? &stroke_ : nullptr; }
  /// gpgpGetGlyphOutline in the text's colour, opaque: alpha is that of each place. What it hands over points to
  /// `stroke`.
  template <class Take> void outline(const GpgpTextGlyph& glyph, const GpgpStroke* stroke, Take&& take) {
    GpgpGlyphOutlineInfo info = init<GpgpGlyphOutlineInfo>();
    info.glyph = glyph.glyph;
    info.stroke = stroke;
    std::copy_n(glyph.color, 3, info.color);
    info.color[3] = 1;
    check(fonts_[fontNumber(glyph.font)].outline(info, take), "gpgpGetGlyphOutline");
  }

private:
  static void GPGP_CALL onMessage(void* userData, const GpgpMessage* message);
  void check(GpgpResult result, const char* what);
  std::string error_;
  std::vector<Font> fonts_;
  Shaper shaper_;
  Layout layout_;
  GpgpLayoutInfo layoutInfo_ = GPGP_LAYOUT_INFO_INIT;
  double shapeMilliseconds_ = 0;
  GpgpStroke stroke_{};
  std::vector<std::string> missing_;
};

} // namespace gpgp::cli
