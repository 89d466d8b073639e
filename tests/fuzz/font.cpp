// Any bytes as a font, as they come; and a good font, made here, with bytes of its tables exchanged: an error, or a
// font whose every glyph has an outline or an error, and which lays out a text without harm.
#include "vector/text/tiny_font.h"

#include <gpgp/text.h>

#include <cmath>
#include <cstdlib>

namespace {

GpgpShaper shaper() {
  static GpgpShaper made = [] {
    GpgpShaperCreateInfo info = GPGP_SHAPER_CREATE_INFO_INIT;
    info.cacheBytes = 65536;
    GpgpShaper created = nullptr;
    if (gpgpCreateShaper(&info, &created) != GPGP_SUCCESS) std::abort();
    return created;
  }();
  return made;
}

/// Whether it opened.
bool check(const void* data, size_t size) {
  GpgpFontCreateInfo info = GPGP_FONT_CREATE_INFO_INIT;
  info.data = data;
  info.size = size;
  info.keepData = VK_TRUE;
  GpgpFont font = nullptr;
  if (gpgpCreateFont(&info, &font) != GPGP_SUCCESS) return false;
  GpgpFontInfo about = GPGP_FONT_INFO_INIT;
  if (gpgpGetFontInfo(font, &about) != GPGP_SUCCESS || about.unitsPerEm == 0) std::abort();
  GpgpGlyphOutlineInfo outline = GPGP_GLYPH_OUTLINE_INFO_INIT;
  for (outline.glyph = 0; outline.glyph < about.glyphCount && outline.glyph < 64; ++outline.glyph) {
    const auto look = [](void*, const GpgpGlyphOutline* glyph) {
      for (uint32_t i = 0; i < glyph->pathCount; ++i)
        for (uint32_t p = 0; p < glyph->paths[i].pointCount * 2; ++p)
          if (!(std::abs(glyph->paths[i].points[p]) <= 1e7f)) std::abort();
    };
    (void)gpgpGetGlyphOutline(font, &outline, look, nullptr);
  }
  const GpgpCharacterRange range = {'A', 'F'};
  uint32_t glyphs[64] = {}, count = 64;
  if (gpgpGetGlyphClosure(font, &range, 1, &count, glyphs) < 0) std::abort();
  for (uint32_t i = 0; i < count && i < 64; ++i)
    if (glyphs[i] >= about.glyphCount) std::abort();
  GpgpLayout layout = nullptr;
  if (gpgpCreateLayout(shaper(), &layout) != GPGP_SUCCESS) std::abort();
  GpgpTextInfo text = GPGP_TEXT_INFO_INIT;
  text.text = "ABC DEF AB\tFED";
  text.size = 14;
  text.style.fonts = &font;
  text.style.fontCount = 1;
  text.style.size = 10;
  text.width = 30;
  if (gpgpSetLayoutText(layout, &text) != GPGP_SUCCESS) std::abort();
  gpgpDestroyLayout(layout);
  gpgpDestroyFont(font);
  return true;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  (void)check(data, size);
  static const std::vector<char> good = gpgp::test::tinyFont();
  std::vector<char> bytes = good;
  if (!check(bytes.data(), bytes.size())) std::abort();
  constexpr size_t kTables = 12 + 9 * 16;     // behind the directory
  for (size_t i = 0; i + 4 <= size; i += 4) { // place, place, how, value
    const size_t at = kTables + (data[i] | size_t(data[i + 1]) << 8) % (bytes.size() - kTables);
    bytes[at] = static_cast<char>(data[i + 2] % 2 ? data[i + 3] : bytes[at] ^ (1 << data[i + 3] % 8));
    if (i % 64 == 0) (void)check(bytes.data(), bytes.size());
    if (i % 1024 == 0) bytes = good; // too many changes only make it no font
  }
  return 0;
}
