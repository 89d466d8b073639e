// The atlas as ImGui wants it, but for its glyphs: they have boxes and advances, and texture coordinates beyond the
// texture, by which they are known again in draw lists. Metrics follow ImGui's own builder (the size is ascent and
// descent together, the baseline lies on a pixel), so that windows keep their layout.
#include "fonts.h"

#include "gpgp_glyph_cache.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_set>

namespace gpgp::imgui {

FontBuilder::FontBuilder() : ImFontBuilderIO{build} {}

bool FontBuilder::build(ImFontAtlas* atlas) {
  auto* self = const_cast<FontBuilder*>(static_cast<const FontBuilder*>(atlas->FontBuilderIO));
  return self->buildFonts(*atlas);
}

namespace {

/// Rectangles that ImGui or the program asked for (lines, mouse cursors, pictures), in rows.
void packCustomRects(ImFontAtlas& atlas) {
  int width = 512;
  for (const ImFontAtlasCustomRect& rect : atlas.CustomRects)
    while (width < rect.Width + atlas.TexGlyphPadding) width *= 2;
  int x = 0, y = 0, row = 0;
  for (ImFontAtlasCustomRect& rect : atlas.CustomRects) {
    if (x + rect.Width > width) {
      x = 0;
      y += row;
      row = 0;
    }
    rect.X = static_cast<unsigned short>(x);
    rect.Y = static_cast<unsigned short>(y);
    x += rect.Width + atlas.TexGlyphPadding;
    row = std::max(row, rect.Height + atlas.TexGlyphPadding);
  }
  int height = 1;
  while (height < y + row) height *= 2;
  atlas.TexWidth = width;
  atlas.TexHeight = height;
  atlas.TexUvScale = {1.0f / static_cast<float>(width), 1.0f / static_cast<float>(height)};
  const size_t bytes = static_cast<size_t>(width) * static_cast<size_t>(height);
  atlas.TexPixelsAlpha8 = static_cast<unsigned char*>(IM_ALLOC(bytes));
  std::fill_n(atlas.TexPixelsAlpha8, bytes, static_cast<unsigned char>(0));
}

/// A character as UTF-8.
std::string utf8(ImWchar character) {
  char bytes[5];
  ImTextCharToUtf8(bytes, character);
  return bytes;
}

} // namespace

bool FontBuilder::buildFonts(ImFontAtlas& atlas) {
  ImFontAtlasBuildInit(&atlas);
  atlas.ClearTexData();
  atlas.TexID = nullptr;
  for (const Font& font : fonts_)
    if (onClose) onClose(font);
  fonts_.clear();
  glyphs.clear();
  if (!shaper_) {
    Result<Shaper> shaper = Shaper::create();
    if (!shaper) return false;
    shaper_ = *std::move(shaper);
    Result<Layout> layout = shaper_.layout();
    if (!layout) return false;
    layout_ = *std::move(layout);
  }
  packCustomRects(atlas);
  for (ImFontConfig& config : atlas.ConfigData) {
    auto info = init<GpgpFontCreateInfo>();
    info.label = config.Name;
    info.data = config.FontData;
    info.size = static_cast<size_t>(config.FontDataSize);
    info.face = static_cast<uint32_t>(config.FontNo);
    Result<Font> font = Font::create(info);
    if (!font) return false; // ImGui asserts that fonts are valid
    const Result<GpgpFontInfo> metrics = font->info();
    if (!metrics || metrics->ascent + metrics->descent <= 0) return false;
    const float em = config.SizePixels / (metrics->ascent + metrics->descent);
    // The signs are as ImGui has them: descent is negative.
    ImFontAtlasBuildSetupFont(&atlas, config.DstFont, &config, std::floor(metrics->ascent * em + 1),
                              std::floor(-metrics->descent * em - 1));
    const ImWchar* ranges = config.GlyphRanges ? config.GlyphRanges : atlas.GetGlyphRangesDefault();
    fonts_.push_back(*std::move(font));
    if (!addGlyphs(config, fonts_.back(), em, ranges, atlas)) return false;
  }
  ImFontAtlasBuildFinish(&atlas);
  return true;
}

bool FontBuilder::addGlyphs(ImFontConfig& config, const Font& font, float em, const ImWchar* ranges,
                            ImFontAtlas& atlas) {
  ImFont& to = *config.DstFont;
  std::unordered_set<unsigned> known; // of fonts merged before
  for (const ImFontGlyph& glyph : to.Glyphs) known.insert(glyph.Codepoint);
  const GpgpFont fonts[] = {font};
  auto text = init<GpgpTextInfo>();
  text.style.fonts = fonts;
  text.style.fontCount = 1;
  text.style.size = em;
  for (; ranges[0] && ranges[1]; ranges += 2)
    for (unsigned character = ranges[0]; character <= ranges[1]; ++character) {
      const Result<uint32_t> glyph = font.glyph(character);
      if (!glyph || *glyph == 0 || !known.insert(character).second) continue;
      const std::string bytes = utf8(static_cast<ImWchar>(character));
      text.text = bytes.data();
      text.size = bytes.size();
      if (layout_.set(text) < 0) return false;
      const Result<GpgpCaret> end = layout_.caret(static_cast<uint32_t>(bytes.size()));
      AtlasGlyph entry{font, *glyph};
      const std::array<float, 4> box = integration::inkBox(font, *glyph);
      std::copy(box.begin(), box.end(), entry.box);
      const bool ink = box[0] < box[2] && box[1] < box[3];
      const ImVec2 offset{config.GlyphOffset.x, config.GlyphOffset.y + std::round(to.Ascent)};
      const float advance = end ? end->x : 0.0f;
      if (!ink) {
        to.AddGlyph(&config, static_cast<ImWchar>(character), 0, 0, 0, 0, 0, 0, 0, 0, advance);
        continue;
      }
      const ImVec2 corner = glyphCorner(static_cast<uint32_t>(glyphs.size()));
      to.AddGlyph(&config, static_cast<ImWchar>(character), entry.box[0] * em + offset.x, entry.box[1] * em + offset.y,
                  entry.box[2] * em + offset.x, entry.box[3] * em + offset.y, corner.x, corner.y, corner.x + 1,
                  corner.y + 1, advance);
      glyphs.push_back(entry);
    }
  to.MetricsTotalSurface = atlas.TexWidth * atlas.TexHeight; // AddGlyph has added what is not in the texture
  return true;
}

} // namespace gpgp::imgui
