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
  if (baseline == "middle") return (g.xHeight > 0 ? em(g.xHeight) : 0.5) / 2;
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

bool isUpright(uint32_t c) {
  constexpr CharacterRange ranges[] = {
      {0x1100, 0x11ff}, {0x2e80, 0x3007}, {0x3012, 0x3013},   {0x3020, 0x302f},   {0x3031, 0xa4cf},  {0xa960, 0xa97f},
      {0xac00, 0xd7ff}, {0xe000, 0xfaff}, {0xfe10, 0xfe1f},   {0xff01, 0xff07},   {0xff0a, 0xff19},  {0xff1f, 0xff3a},
      {0xff3c, 0xff5a}, {0xffe0, 0xffe7}, {0x1f000, 0x1f7ff}, {0x1f900, 0x1faff}, {0x20000, 0x3fffd}};
  return isIn(c, ranges);
}

} // namespace gpgp::vector::svg
