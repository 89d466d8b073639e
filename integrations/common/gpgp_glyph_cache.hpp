// What lies between libgpgp_text and a canvas: glyphs of fonts in a glyph set, converted when they are first met.
//
//   cache.place(layoutInfo, x, y, 1, instances);    each frame, before gpgpRecordUpload
//   cache.item(instances)                           for GpgpCanvasInfo::items
//
// A glyph in colour is shown with its layers and gradients, but not at all where it is a picture. One context's;
// @threads context. Fonts that were given stay open until the cache goes, or are forgotten.
#pragma once
#include <gpgp/gpgp.hpp>

#include <span>
#include <unordered_map>
#include <vector>

namespace gpgp::integration {

struct FontGlyph {
  GpgpFont font = nullptr;
  uint32_t glyph = 0;
};

class GlyphCache {
public:
  /// The glyph set, with its budgets (GpgpGlyphSetCreateInfo; 0: that struct's defaults).
  GpgpResult create(GpgpContext context, const char* label, uint32_t maxGlyphs = 0, VkDeviceSize maxBytes = 0);
  GpgpAsset set() const { return set_; }
  /// Indices in the set, valid until the next call that adds. BUDGET_EXCEEDED: some are GPGP_GLYPH_NONE.
  GpgpResult find(std::span<const FontGlyph> glyphs, uint32_t* indices);
  /// Appends the glyphs of a layout, its origin at (x, y), times scale. Errors and statuses as find.
  GpgpResult place(const GpgpLayoutInfo& layout, float x, float y, float scale, std::vector<GpgpGlyphInstance>& out);
  /// Instances as an item, in pixels.
  GpgpCanvasItem item(std::span<const GpgpGlyphInstance> instances) const;
  /// Before a font is destroyed that was given: another at the same address is another font.
  void forget(GpgpFont font) { fonts_.erase(font); }

private:
  GpgpResult add(std::span<const FontGlyph> glyphs, std::span<const uint64_t> keys);
  uint64_t key(const FontGlyph& glyph);
  GlyphSet set_;
  std::unordered_map<GpgpFont, uint32_t> fonts_;
  uint32_t nextFont_ = 0;
  std::vector<uint64_t> keys_;
  std::vector<FontGlyph> wanted_;
  std::vector<uint32_t> indices_;
};

} // namespace gpgp::integration
