// Text in a font that is known to the last number, so that where each letter stands is a closed form.
#pragma once
#include "svg_import.h"

namespace gpgp::test {

/// A font whose letters are half an em wide and a square of four tenths each, which stands on the baseline. Two
/// V are a tenth closer.
inline GpgpResult GPGP_CALL shapeSquares(void*, const GpgpSvgText* text, GpgpSvgGlyphFn glyphFn, void* glyphData) {
  static const GpgpPathVerb verbs[] = {GPGP_PATH_MOVE, GPGP_PATH_LINE, GPGP_PATH_LINE, GPGP_PATH_LINE, GPGP_PATH_CLOSE};
  static const float points[] = {0, 0, 0.4f, 0, 0.4f, -0.4f, 0, -0.4f};
  GpgpPath square{};
  square.verbs = verbs, square.verbCount = 5;
  square.points = points, square.pointCount = 4;
  float x = 0;
  for (uint32_t s = 0; s < text->spanCount; ++s)
    for (uint32_t i = text->spans[s].begin; i < text->spans[s].end; ++i) {
      GpgpSvgGlyph glyph{};
      const bool isPair = i > 0 && text->text[i] == 'V' && text->text[i - 1] == 'V';
      if (isPair && !text->spans[s].unkerned) x -= text->spans[s].size / 10;
      glyph.cluster = i;
      glyph.x = x;
      glyph.size = text->spans[s].size;
      glyph.advance = glyph.size / 2 + text->spans[s].letterSpacing;
      glyph.paths = &square;
      glyph.pathCount = text->text[i] != ' ';
      glyph.ascent = 0.8f, glyph.descent = 0.2f, glyph.xHeight = 0.4f;
      glyph.underlinePosition = 0.1f, glyph.strikePosition = -0.2f;
      glyph.underlineThickness = glyph.strikeThickness = 0.1f;
      glyph.subscript = 0.25f, glyph.superscript = 0.5f;
      x += glyph.advance;
      glyphFn(glyphData, &glyph);
    }
  return GPGP_SUCCESS;
}

/// The same with a mark on each letter, a square of a tenth that stands half an em above the middle of the letter's
/// square; in lines that go down, brackets have glyphs of their own.
inline GpgpResult GPGP_CALL shapeMarked(void*, const GpgpSvgText* text, GpgpSvgGlyphFn glyphFn, void* glyphData) {
  struct Marked {
    GpgpSvgGlyphFn fn;
    void* data;
    const GpgpSvgText* text;
  } marked{glyphFn, glyphData, text};
  return shapeSquares(
      nullptr, text,
      [](void* user, const GpgpSvgGlyph* letter) {
        static const GpgpPathVerb verbs[] = {GPGP_PATH_MOVE, GPGP_PATH_LINE, GPGP_PATH_LINE, GPGP_PATH_LINE,
                                             GPGP_PATH_CLOSE};
        static const float points[] = {0, 0, 0.1f, 0, 0.1f, -0.1f, 0, -0.1f};
        const auto& m = *static_cast<const Marked*>(user);
        GpgpSvgGlyph glyph = *letter;
        const char c = m.text->text[letter->cluster];
        glyph.vertical = m.text->spans[0].vertical && (c == '(' || c == ')');
        m.fn(m.data, &glyph);
        GpgpPath square{};
        square.verbs = verbs, square.verbCount = 5;
        square.points = points, square.pointCount = 4;
        glyph.advance = 0;
        glyph.x += 0.2f * glyph.size, glyph.y -= 0.5f * glyph.size;
        glyph.paths = &square;
        m.fn(m.data, &glyph);
      },
      &marked);
}

/// A page whose text is in that font, or another.
inline Import written(const std::string& inside, GpgpSvgTextFn shape = shapeSquares) {
  const std::string text =
      "<svg xmlns='http://www.w3.org/2000/svg' width='100' height='100' font-size='20'>\n" + inside + "</svg>";
  Import result;
  const auto listen = [](void* user, const GpgpMessage* m) {
    static_cast<Import*>(user)->placed.push_back(test::placed(*m));
  };
  vector::svg::Reporter reporter(listen, &result, "test.svg");
  auto drawing = vector::svg::importSvg(std::as_bytes(std::span(text.data(), text.size())), reporter, {}, {}, {},
                                        nullptr, {shape, nullptr});
  if (drawing) result.drawing = std::move(*drawing);
  return result;
}

} // namespace gpgp::test
