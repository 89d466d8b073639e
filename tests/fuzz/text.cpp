// Any bytes as a text, with any options: lines that cover it in order, carets and hits that stay within it. The first
// eight bytes are the options, which the text shares.
#include "vector/text/tiny_font.h"

#include <gpgp/text.h>

#include <cmath>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const std::vector<char> bytes = gpgp::test::tinyFont();
  static GpgpFont font = [] {
    GpgpFontCreateInfo info = GPGP_FONT_CREATE_INFO_INIT;
    info.data = bytes.data();
    info.size = bytes.size();
    GpgpFont made = nullptr;
    if (gpgpCreateFont(&info, &made) != GPGP_SUCCESS) std::abort();
    return made;
  }();
  if (size < 8) return 0;
  const auto require = [](bool holds) {
    if (!holds) std::abort();
  };
  GpgpShaperCreateInfo create = GPGP_SHAPER_CREATE_INFO_INIT;
  create.cacheBytes = 4096;
  GpgpShaper shaper = nullptr;
  GpgpLayout layout = nullptr;
  require(gpgpCreateShaper(&create, &shaper) == GPGP_SUCCESS);
  require(gpgpCreateLayout(shaper, &layout) == GPGP_SUCCESS);
  for (size_t begin = 0, run = 0; begin < size && run < 4; begin += 1021, ++run) { // pieces, each cut anywhere
    GpgpTextInfo text = GPGP_TEXT_INFO_INIT;
    text.text = reinterpret_cast<const char*>(data) + begin;
    text.size = size - begin < 1021 ? size - begin : 1021;
    text.style.fonts = &font;
    text.style.fontCount = 1;
    text.style.size = 1 + data[0] % 40;
    text.style.letterSpacing = static_cast<float>(data[1] % 8) - 3;
    text.direction = data[2] % 3;
    text.align = data[3] % 6;
    text.width = data[4] % 2 ? static_cast<float>(data[4]) * 2 : 0;
    text.maxLines = data[5] % 4 ? 0 : data[5] / 16;
    text.height = data[6] % 4 ? 0 : data[6];
    text.tabWidth = data[7] % 30;
    GpgpTextSpan span = {static_cast<uint32_t>(text.size / 3), static_cast<uint32_t>(text.size / 2), text.style};
    span.style.size = 7;
    span.style.underline = span.style.strike = VK_TRUE;
    text.spans = &span;
    text.spanCount = 1;
    require(gpgpSetLayoutText(layout, &text) == GPGP_SUCCESS);
    GpgpLayoutInfo info = GPGP_LAYOUT_INFO_INIT;
    require(gpgpGetLayoutInfo(layout, &info) == GPGP_SUCCESS);
    require(info.lineCount > 0 && std::isfinite(info.width) && std::isfinite(info.height));
    uint32_t at = 0, glyphs = 0;
    for (uint32_t i = 0; i < info.lineCount; ++i) {
      require(info.lines[i].begin == at && info.lines[i].end >= at && info.lines[i].firstGlyph == glyphs);
      at = info.lines[i].end;
      glyphs += info.lines[i].glyphCount;
    }
    require(at == text.size || info.truncated);
    require(glyphs == info.glyphCount);
    for (uint32_t i = 0; i < glyphs; ++i)
      require(std::isfinite(info.glyphs[i].x) && info.glyphs[i].cluster <= text.size);
    for (uint32_t offset = 0; offset <= text.size; offset += 1 + data[1] % 7) {
      GpgpCaret caret{};
      require(gpgpGetCaret(layout, offset, data[1] & 1, &caret) == GPGP_SUCCESS && caret.line < info.lineCount);
      GpgpTextHit hit{};
      require(gpgpHitTestLayout(layout, caret.x, caret.top, &hit) == GPGP_SUCCESS && hit.insertion <= text.size);
      uint32_t moved = 0, count = 0;
      VkBool32 trailing = data[1] & 1;
      for (GpgpCaretMove move = GPGP_CARET_NEXT; move <= GPGP_CARET_LINE_END; ++move)
        require(gpgpMoveCaret(layout, offset, move, &moved, &trailing) == GPGP_SUCCESS && moved <= text.size);
      require(gpgpGetSelection(layout, offset, offset + 20, &count, nullptr) == GPGP_SUCCESS);
    }
  }
  gpgpDestroyLayout(layout);
  gpgpDestroyShaper(shaper);
  return 0;
}
