#include "vector/import/svg/text_characters.h"

#include <algorithm>
#include <iterator>

namespace gpgp::vector::svg {
namespace {

using CharacterRange = uint32_t[2];
template <size_t N> bool isIn(uint32_t c, const CharacterRange (&ranges)[N]) {
  return std::any_of(std::begin(ranges), std::end(ranges), [c](const auto& r) { return c >= r[0] && c <= r[1]; });
}

} // namespace

double baselineOffset(std::string_view baseline, const GpgpSvgGlyph& g) {
  const auto em = [](float v) { return static_cast<double>(v); };
  if (baseline == "middle") // fonts that do not state it: as resvg estimates it
    return (g.xHeight > 0 ? em(g.xHeight) : 0.45 * (em(g.ascent) + em(g.descent))) / 2;
  if (baseline == "central") return (em(g.ascent) - em(g.descent)) / 2;
  if (baseline == "hanging") return em(g.ascent) * 0.8;
  if (baseline == "mathematical") return em(g.ascent) * 0.5;
  if (baseline == "text-before-edge" || baseline == "before-edge") return em(g.ascent);
  if (baseline == "text-after-edge" || baseline == "after-edge" || baseline == "ideographic") return -em(g.descent);
  return 0;
}

BidiMarks bidiMarksOf(const TextStyle& style) {
  constexpr const char *popsEmbedding = "\u202c", *popsIsolate = "\u2069", *firstStrong = "\u2068";
  const std::string embedding = style.rightToLeft ? "\u202b" : "\u202a",
                    override = style.rightToLeft ? "\u202e" : "\u202d",
                    isolate = style.rightToLeft ? "\u2067" : "\u2066";
  switch (style.bidi) {
  case TextStyle::Bidi::Normal: return {};
  case TextStyle::Bidi::Embed: return {embedding, popsEmbedding};
  case TextStyle::Bidi::Override: return {override, popsEmbedding};
  case TextStyle::Bidi::Isolate: return {isolate, popsIsolate};
  case TextStyle::Bidi::IsolateOverride: return {firstStrong + override, std::string(popsEmbedding) + popsIsolate};
  case TextStyle::Bidi::Plaintext: return {firstStrong, popsIsolate};
  }
  return {};
}

std::string withoutBreaks(std::string_view text) {
  constexpr std::string_view breaks[] = {"\u2028", "\u2029", "\u0085"};
  std::string out;
  while (!text.empty()) {
    const auto found = std::ranges::find_if(breaks, [&](std::string_view b) { return text.starts_with(b); });
    const bool isBreak = found != std::end(breaks);
    out += isBreak ? ' ' : text[0];
    text.remove_prefix(isBreak ? found->size() : 1);
  }
  return out;
}

uint32_t characterAt(std::string_view text, size_t offset) {
  const auto byte = [&](size_t i) {
    return offset + i < text.size() ? static_cast<uint32_t>(text[offset + i]) & 0x3f : 0;
  };
  const auto first = static_cast<uint8_t>(text[offset]);
  return first >= 0xf0   ? (first & 7u) << 18 | byte(1) << 12 | byte(2) << 6 | byte(3)
         : first >= 0xe0 ? (first & 15u) << 12 | byte(1) << 6 | byte(2)
         : first >= 0xc0 ? (first & 31u) << 6 | byte(1)
                         : first;
}
bool isJoined(uint32_t c) {
  constexpr CharacterRange ranges[] = {
      {0x600, 0x74f},     // Arabic, Syriac
      {0x750, 0x77f},     // Arabic
      {0x7c0, 0x7ff},     // N'Ko
      {0x840, 0xa7f},     // Mandaic, Syriac, Arabic, Devanagari, Bengali, Gurmukhi
      {0x1680, 0x169f},   // Ogham
      {0x1800, 0x18af},   // Mongolian
      {0xa800, 0xa82f},   // Syloti Nagri
      {0xa840, 0xa87f},   // Phags-pa
      {0xa8e0, 0xa8ff},   // Devanagari
      {0xfb50, 0xfdff},   // Arabic
      {0xfe70, 0xfefe},   // Arabic
      {0x10ac0, 0x10aff}, // Manichaean
      {0x10b80, 0x10baf}, // Psalter Pahlavi
      {0x11180, 0x111df}, // Sharada
      {0x11480, 0x114df}, // Tirhuta
      {0x11600, 0x1165f}, // Modi
  };
  return isIn(c, ranges);
}

bool isWordSpace(uint32_t c) {
  constexpr uint32_t spaces[] = {0x20, 0xa0, 0x1361, 0x10100, 0x10101, 0x1039f, 0x1091f};
  return std::find(std::begin(spaces), std::end(spaces), c) != std::end(spaces);
}

// The character property Vertical_Orientation of Unicode 15 (Unicode Standard Annex 50): U and Tu.
bool isUpright(uint32_t c) {
  constexpr CharacterRange ranges[] = {
      {0xa7, 0xa7},       {0xa9, 0xa9},       {0xae, 0xae},       {0xb1, 0xb1},       {0xbc, 0xbe},
      {0xd7, 0xd7},       {0xf7, 0xf7},       {0x2ea, 0x2eb},     {0x1100, 0x11ff},   {0x1401, 0x167f},
      {0x18b0, 0x18ff},   {0x2016, 0x2016},   {0x2020, 0x2021},   {0x2030, 0x2031},   {0x203b, 0x203c},
      {0x2042, 0x2042},   {0x2047, 0x2049},   {0x2051, 0x2051},   {0x2065, 0x2065},   {0x20dd, 0x20e0},
      {0x20e2, 0x20e4},   {0x2100, 0x2101},   {0x2103, 0x2109},   {0x210f, 0x210f},   {0x2113, 0x2114},
      {0x2116, 0x2117},   {0x211e, 0x2123},   {0x2125, 0x2125},   {0x2127, 0x2127},   {0x2129, 0x2129},
      {0x212e, 0x212e},   {0x2135, 0x213f},   {0x2145, 0x214a},   {0x214c, 0x214d},   {0x214f, 0x2189},
      {0x218c, 0x218f},   {0x221e, 0x221e},   {0x2234, 0x2235},   {0x2300, 0x2307},   {0x230c, 0x231f},
      {0x2324, 0x2328},   {0x232b, 0x232b},   {0x237d, 0x239a},   {0x23be, 0x23cd},   {0x23cf, 0x23cf},
      {0x23d1, 0x23db},   {0x23e2, 0x2422},   {0x2424, 0x24ff},   {0x25a0, 0x2619},   {0x2620, 0x2767},
      {0x2776, 0x2793},   {0x2b12, 0x2b2f},   {0x2b50, 0x2b59},   {0x2b97, 0x2b97},   {0x2bb8, 0x2bd1},
      {0x2bd3, 0x2beb},   {0x2bf0, 0x2bff},   {0x2e50, 0x2e51},   {0x2e80, 0x3007},   {0x3012, 0x3013},
      {0x3020, 0x302f},   {0x3031, 0x309f},   {0x30a1, 0x30fb},   {0x30fd, 0xa4cf},   {0xa960, 0xa97f},
      {0xac00, 0xd7ff},   {0xe000, 0xfaff},   {0xfe10, 0xfe1f},   {0xfe30, 0xfe48},   {0xfe50, 0xfe57},
      {0xfe5f, 0xfe62},   {0xfe67, 0xfe6f},   {0xff01, 0xff07},   {0xff0a, 0xff0c},   {0xff0e, 0xff19},
      {0xff1f, 0xff3a},   {0xff3c, 0xff3c},   {0xff3e, 0xff3e},   {0xff40, 0xff5a},   {0xffe0, 0xffe2},
      {0xffe4, 0xffe7},   {0xfff0, 0xfff8},   {0xfffc, 0xfffd},   {0x10980, 0x1099f}, {0x11580, 0x115ff},
      {0x11a00, 0x11abf}, {0x13000, 0x1345f}, {0x14400, 0x1467f}, {0x16fe0, 0x18d7f}, {0x1aff0, 0x1b2ff},
      {0x1cf00, 0x1cfcf}, {0x1d000, 0x1d1ff}, {0x1d2e0, 0x1d37f}, {0x1d800, 0x1daaf}, {0x1f000, 0x1f7ff},
      {0x1f900, 0x1faff}, {0x20000, 0x2fffd}, {0x30000, 0x3fffd}, {0xf0000, 0xffffd}, {0x100000, 0x10fffd}};
  return isIn(c, ranges);
}

bool hasVerticalForm(uint32_t c) { // Tr as well
  constexpr CharacterRange ranges[] = {{0x2329, 0x232a}, {0x3008, 0x3011}, {0x3014, 0x301f}, {0x3030, 0x3030},
                                       {0x30a0, 0x30a0}, {0x30fc, 0x30fc}, {0xfe59, 0xfe5e}, {0xff08, 0xff09},
                                       {0xff1a, 0xff1b}, {0xff3b, 0xff3b}, {0xff3d, 0xff3d}, {0xff3f, 0xff3f},
                                       {0xff5b, 0xff60}, {0xffe3, 0xffe3}};
  return isUpright(c) || isIn(c, ranges);
}

} // namespace gpgp::vector::svg
