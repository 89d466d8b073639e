// The glyphs that characters may become.
#pragma once
#include "vector/text/font.h"

#include <span>
#include <vector>

namespace gpgp::text {

/// Appends each glyph that a text of these characters may need in this font, whatever its order, direction and
/// features, by number: gpgpGetGlyphClosure.
void glyphClosure(const Font& font, std::span<const GpgpCharacterRange> ranges, std::vector<uint32_t>& glyphs);

} // namespace gpgp::text
