// What lies between libgpgp_text and a canvas: glyphs of fonts, converted when they are first met, into a glyph set,
// or into a texture where they are pictures.
//
//   cache.place(layoutInfo, x, y, 1, text);     each frame, before the uploads
//   cache.addTo(list, text);                    for GpgpCanvasItem::list
//   cache.recordUpload(commands, frame);        beside gpgpRecordUpload
//   cache.image()                               for GpgpCanvasInfo::images
//
// One context's; @threads context. Fonts that were given stay open until the cache goes, or are forgotten.
#pragma once
#include "gpgp_glyph_pictures.hpp"

#include <map>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

namespace gpgp::integration {

struct GlyphCacheInfo {
  GpgpContext context = nullptr;
  const char* label = "glyphs";
  uint32_t maxGlyphs = 0; ///< budgets of the glyph set (GpgpGlyphSetCreateInfo; 0: that struct's defaults)
  VkDeviceSize maxBytes = 0;
  PictureDevice pictureDevice; ///< the context's device; none: glyphs that are pictures are not shown
  uint32_t maxPictures = 64;   ///< at a time (gpgp_glyph_pictures.hpp)
};

/// A glyph that is a picture, in the units of the text.
struct PlacedPicture {
  float box[4] = {};    ///< left, top, right, bottom
  float source[4] = {}; ///< of the texture
  float alpha = 1;
};

/// An underline or a strike, in the units of the text.
struct PlacedLine {
  float box[4] = {}; ///< left, top, right, bottom
  float color[4] = {};
  bool strike = false; ///< painted over the glyphs; else below them
};

/// Glyphs at their places. Valid in the frame in which they were placed; as long as all that is shown fits the
/// budgets, in all later ones, too.
struct PlacedText {
  std::vector<GpgpGlyphInstance> glyphs;
  std::vector<PlacedPicture> pictures;
  std::vector<PlacedLine> lines;
  uint32_t dropped = 0; ///< found no room in the set or the texture
  /// Appends underlines and strikes, moved by (x, y) after they were scaled.
  void decorate(std::span<const GpgpTextDecoration> decorations, float x, float y, float scale);
  void clear();
};

/// Where a layout's lines lie: left, top, right, bottom. Lines at the right or in the middle of a width do not begin
/// at 0.
std::array<float, 4> linesBox(const GpgpLayoutInfo& layout);

/// Where a glyph's paths or its picture lie, in em: left, top, right, bottom; all 0: a blank.
std::array<float, 4> inkBox(GpgpFont font, uint32_t glyph);

class GlyphCache {
public:
  GpgpResult create(const GlyphCacheInfo& info);
  GpgpAsset set() const { return set_; }
  /// Appends glyphs, moved by (x, y) after they were scaled: of each font, glyph, x, y, size and color count.
  /// stroke: 0, or width in em of a line along the glyphs' outlines, with round joins, which is placed in their stead.
  /// BUDGET_EXCEEDED: some are not there, and counted.
  GpgpResult place(std::span<const GpgpTextGlyph> glyphs, float x, float y, float scale, PlacedText& text,
                   float stroke = 0);
  /// With underlines and strikes.
  GpgpResult place(const GpgpLayoutInfo& layout, float x, float y, float scale, PlacedText& text) {
    text.decorate({layout.decorations, layout.decorationCount}, x, y, scale);
    return place({layout.glyphs, layout.glyphCount}, x, y, scale, text);
  }
  /// Adds them to a list, underlines first, strikes last: image() is the image of this number (GpgpListImage::image).
  GpgpResult addTo(GpgpList list, const PlacedText& text, uint32_t image = 0, uint64_t id = 0) const;
  /// New pictures, before the records that show them. Glyphs go with gpgpRecordUpload. @pass outside
  GpgpResult recordUpload(VkCommandBuffer commands, const GpgpFrame& frame);
  /// Nothing as long as no picture was uploaded.
  std::optional<GpgpCanvasImage> image() const;
  /// Before a font is destroyed that was given: another at the same address is another font.
  void forget(GpgpFont font);

private:
  struct FontEntry {
    uint32_t number = 0;
    bool pictures = false; ///< may have some
    float stroke = 0;      ///< em
  };
  struct Picture { ///< of a glyph of such a font
    bool is = false;
    float box[4] = {}; ///< em
    uint32_t place = GlyphPictures::kNone;
    uint64_t owner = 0; ///< of the place, when it was this picture's
  };
  const FontEntry& entryOf(GpgpFont font, float stroke);
  GpgpResult findGlyphs(std::span<const GpgpTextGlyph> glyphs, float stroke);
  GpgpResult addGlyphs(std::span<const GpgpTextGlyph> glyphs, float stroke);
  GpgpResult findPicture(const GpgpTextGlyph& glyph, uint64_t key, const Picture*& found);
  GlyphSet set_;
  std::unique_ptr<GlyphPictures> pictures_;
  std::map<std::pair<GpgpFont, uint32_t>, FontEntry> fonts_; ///< and stroke, in 1/4096 em
  std::unordered_map<uint64_t, Picture> pictureGlyphs_;
  uint32_t nextFont_ = 0;
  std::vector<uint64_t> keys_;
  std::vector<uint32_t> indices_;
};

} // namespace gpgp::integration
