// The text of an SVG or of an animation, shaped in fonts that were given, or in those of the system.
#pragma once
#include "cli/vector/system_fonts.h"

#include <gpgp/text.hpp>
#include <gpgp/vector.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gpgp::cli {

/// Takes fonts by the family, weight and slant that the text asks for; then, in their order, the others. Of the words
/// for kinds of families, serif, sans-serif and monospace mean fonts whose names say so.
class SvgText {
public:
  /// Throws Failure, which names the file, where one is no font.
  /// `fromSystem`: where no files are given, the system's fonts are looked for as the text asks for them.
  explicit SvgText(const std::vector<std::string>& files, bool fromSystem = false);
  SvgText(const SvgText&) = delete; // the source refers to it
  SvgText& operator=(const SvgText&) = delete;
  /// Without fonts, text stays unsupported.
  template <class Source> void attach(Source& source) {
    if (faces_.empty() && !fromSystem_) return;
    source.textFn = shape;
    source.textUserData = this;
  }

private:
  struct Face {
    Font font;
    GpgpFontInfo info;
    std::string family; ///< in small letters
    float weight = 400, stretch = 100;
    bool italic = false;
    SystemFont source{};     ///< where it comes from, and at which values of its axes
    bool isInstance = false; ///< of another one, which has axes
  };
  /// What stands for some characters, as a line has it from left to right; lengths are at the size of layouts.
  struct Cluster {
    struct Glyph {
      GpgpFont font;
      uint32_t glyph;
      float x, y;            ///< from where the cluster begins on the baseline
      bool vertical = false; ///< for vertical lines
    };
    uint32_t begin = 0, end = 0;         ///< bytes
    float left = 0, width = 0, size = 0; ///< size: what is asked for
    GpgpFont first{};                    ///< the font that is asked for first
    std::vector<Glyph> glyphs;
  };
  static GpgpResult GPGP_CALL shape(void* userData, const GpgpSvgText* text, GpgpSvgGlyphFn glyphFn, void* glyphData);
  void shape(const GpgpSvgText& text, GpgpSvgGlyphFn glyphFn, void* glyphData);
  /// The whole line in the style of one span.
  void shapeAs(const GpgpSvgText& text, const GpgpSvgTextSpan& span, std::vector<Cluster>& clusters);
  /// The same with the fonts' glyphs for vertical lines or without.
  void shapeWith(const GpgpSvgText& text, const GpgpSvgTextSpan& span, bool vertical, std::vector<Cluster>& clusters);
  std::vector<GpgpFont> chosen(const GpgpSvgTextSpan& span, std::string_view text);
  /// The face itself, or one at the values of its axes that the text asks for.
  GpgpFont instance(size_t face, const GpgpSvgTextSpan& span);
  std::vector<GpgpFont> chosenOfSystem(const GpgpSvgTextSpan& span, std::string_view text);

  bool fromSystem_ = false;
  std::optional<SystemFonts> system_; ///< when first asked for
  std::vector<Face> faces_;
  Shaper shaper_;
  Layout layout_;
};

} // namespace gpgp::cli
