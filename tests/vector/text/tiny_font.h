// Fonts made here, byte by byte: three shapes, colour layers of COLR versions 0 and 1, two palettes; and a shape that
// varies. For what no font of Debian has, and for fuzzing.
#pragma once
#include <cstdint>
#include <vector>

namespace gpgp::test {

namespace tiny {
constexpr uint32_t kSquare = 1; // 'A': (0, 0) to (500, 500)
constexpr uint32_t kCorner = 2; // 'B': a triangle (0, 0), (400, 0), (0, 800)
constexpr uint32_t kLayers = 3; // 'C', version 0: square in entry 0, corner in the text's colour
constexpr uint32_t kPaints = 4; // 'D', version 1: see paints() in tiny_font.cpp
constexpr uint32_t kSweep = 5;  // 'E', version 1: a sweep gradient
constexpr uint32_t kCircle = 6; // 'F', version 1: paints itself
constexpr uint32_t kGlyphs = 7;
constexpr float kUnits = 1000;
} // namespace tiny

std::vector<char> tinyFont();
/// The same, whose glyph kSweep is the corner in entry 0 at an alpha of 3/4, composited over the square in entry 1 by a
/// mode of PaintComposite.
std::vector<char> tinyCompositeFont(uint32_t mode);
/// The same, whose glyph kSweep is the square within the corner, in entry 0.
std::vector<char> tinyNestedFont();

/// CFF2, with an axis of weight from 100 over 400 to 900. Glyph 1, 'A', is a pillar from (100, 0), 100 wide and 700
/// high under an arch; at the ends of the axis it is 40 and 300 wide, and 300 - 60 and 300 + 200 are what it takes.
std::vector<char> tinyVariableFont();

} // namespace gpgp::test
