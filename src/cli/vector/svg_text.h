// The text of an SVG or of an animation, shaped in fonts that were given.
#pragma once
#include <gpgp/text.hpp>
#include <gpgp/vector.h>

#include <string>
#include <string_view>
#include <vector>

namespace gpgp::cli {

/// Takes fonts by the family, weight and slant that the text asks for; then, in their order, the others.
class SvgText {
public:
  /// Throws Failure, which names the file, where one is no font.
  explicit SvgText(const std::vector<std::string>& files);
  SvgText(const SvgText&) = delete; // the source refers to it
  SvgText& operator=(const SvgText&) = delete;
  /// Without fonts, text stays unsupported.
  template <class Source> void attach(Source& source) {
    if (faces_.empty()) return;
    source.textFn = shape;
    source.textUserData = this;
  }

private:
  struct Face {
    Font font;
    GpgpFontInfo info;
    std::string family; ///< in small letters
    bool bold = false, italic = false;
  };
  static GpgpResult GPGP_CALL shape(void* userData, const GpgpSvgText* text, GpgpSvgGlyphFn glyphFn, void* glyphData);
  void shape(const GpgpSvgText& text, GpgpSvgGlyphFn glyphFn, void* glyphData);
  std::vector<GpgpFont> chosen(const GpgpSvgTextSpan& span) const;

  std::vector<Face> faces_;
  Shaper shaper_;
  Layout layout_;
};

} // namespace gpgp::cli
