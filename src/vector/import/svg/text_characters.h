// What text knows of characters and of fonts' lines, apart from where it stands.
#pragma once
#include "vector/import/svg/style.h"

#include <gpgp/svg.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace gpgp::vector::svg {

/// How far glyphs of a font go down for the baseline that is asked for, in em.
double baselineOffset(std::string_view baseline, const GpgpSvgGlyph& g);

/// The marks of direction that `unicode-bidi` stands for, before and behind an element's characters.
struct BidiMarks {
  std::string before, behind;
};
BidiMarks bidiMarksOf(const TextStyle& style);

/// UTF-8 whose line and paragraph separators are spaces: SVG 1.1's text has one line.
std::string withoutBreaks(std::string_view text);
/// The code point that begins at a byte of UTF-8.
uint32_t characterAt(std::string_view text, size_t offset);
/// Of a script whose letters join, which are not spaced (CSS Text 3, 8.2.1).
bool isJoined(uint32_t c);
/// Between words (CSS Text 3, 8.1).
bool isWordSpace(uint32_t c);
/// Whether a character stands upright in vertical lines (Unicode Standard Annex 50): those of East Asia, and pictures.
bool isUpright(uint32_t c);
/// The same, and those that stand upright where the font has a glyph of its own for it, else on their side: brackets.
bool hasVerticalForm(uint32_t c);

} // namespace gpgp::vector::svg
