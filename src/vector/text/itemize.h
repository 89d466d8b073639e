// A text cut into runs that are shaped together: one direction, script, font, size, language, and the same features.
#pragma once
#include "vector/text/shape.h"

#include <unicode/uscript.h>

namespace gpgp::text {

/// A style of the text with what is asked of it often.
struct Style {
  const GpgpTextStyle* source;
  hb_language_t language;
  Font* font(uint32_t index) const { return reinterpret_cast<Font*>(source->fonts[index]); }
};

struct Run {
  enum class Kind : uint8_t { text, tab, newline, inserted };
  uint32_t begin, end; // characters
  Kind kind;
  uint8_t level;
  hb_script_t script;
  Font* font;
  uint32_t style;                          // of its first character
  bool parted = false;                     // marks of a grapheme that begins in another font
  uint32_t firstGlyph = 0, glyphCount = 0; // in the layout's glyphs
};

struct Itemizer {
  const Text& text;
  std::span<const Style> styles;
  std::span<const uint32_t> styleOf; // each character's
  std::span<const uint8_t> flags;    // Boundary
  std::span<const uint8_t> levels;
  std::vector<UScriptCode>& scripts; // scratch

  /// Appends the runs of a paragraph.
  void paragraph(uint32_t begin, uint32_t end, std::vector<Run>& runs) const;
  /// The font of a grapheme in a style: the first that has all its characters, for emoji the first such in colour,
  /// where U+FE0E wants text the first such without, and for spaces and where text is the character's default a
  /// font of emoji last; else the one that has most of its first characters; else the first.
  static Font* fontOf(std::span<const char32_t> grapheme, const Style& style);

private:
  /// How much of a grapheme is shaped in a font: what it has, and what no font of the style has behind that.
  static size_t lengthIn(const Font& font, std::span<const char32_t> grapheme, const Style& style);
  /// The font of the first text of the same style behind the spaces that begin at a character; none where an
  /// emoji is there, or nothing before the line's end or a tab. `behind` is where that is; it only grows.
  Font* fontBehind(uint32_t at, uint32_t end, uint32_t& behind) const;
};

/// A character that leaves no mark where it is missing.
bool isIgnorable(char32_t c);
/// White space that may hang beyond the end of a line, line breaks included.
bool isWhite(char32_t c);
/// A script whose letters join, so that they are not spaced.
bool isCursive(hb_script_t script);

} // namespace gpgp::text
