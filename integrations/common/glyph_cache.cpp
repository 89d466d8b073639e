#include "gpgp_glyph_cache.hpp"

#include <deque>

namespace gpgp::integration {
namespace {

/// A glyph's paths, kept beyond the call that hands them over.
struct Outline {
  struct Path {
    std::vector<GpgpPathVerb> verbs;
    std::vector<float> points;
    std::vector<GpgpGradientStop> stops;
    GpgpGradient gradient{};
  };
  std::vector<Path> kept;
  std::vector<GpgpPath> paths;
  std::vector<VkBool32> foreground;

  void take(const GpgpGlyphOutline& outline) {
    kept.resize(outline.pathCount); // not moved from here on: paths point into it
    for (uint32_t i = 0; i < outline.pathCount; ++i) {
      GpgpPath path = outline.paths[i];
      kept[i].verbs.assign(path.verbs, path.verbs + path.verbCount);
      kept[i].points.assign(path.points, path.points + size_t{path.pointCount} * 2);
      path.verbs = kept[i].verbs.data();
      path.points = kept[i].points.data();
      if (path.gradient) {
        kept[i].gradient = *path.gradient;
        kept[i].stops.assign(path.gradient->stops, path.gradient->stops + path.gradient->stopCount);
        kept[i].gradient.stops = kept[i].stops.data();
        path.gradient = &kept[i].gradient;
      }
      paths.push_back(path);
      foreground.push_back(outline.foreground[i]);
    }
  }
};

GpgpResult fetch(const FontGlyph& glyph, Outline& outline) {
  GpgpGlyphOutlineInfo info = GPGP_GLYPH_OUTLINE_INFO_INIT;
  info.glyph = glyph.glyph;
  return gpgpGetGlyphOutline(
      glyph.font, &info, [](void* user, const GpgpGlyphOutline* given) { static_cast<Outline*>(user)->take(*given); },
      &outline);
}

} // namespace

GpgpResult GlyphCache::create(GpgpContext context, const char* label, uint32_t maxGlyphs, VkDeviceSize maxBytes) {
  auto info = init<GpgpGlyphSetCreateInfo>();
  info.label = label;
  info.maxGlyphs = maxGlyphs;
  info.maxBytes = maxBytes;
  Result<GlyphSet> made = GlyphSet::create(context, info);
  const GpgpResult code = made.code();
  if (made) set_ = *std::move(made);
  return code;
}

uint64_t GlyphCache::key(const FontGlyph& glyph) {
  const auto [at, isNew] = fonts_.try_emplace(glyph.font, nextFont_);
  if (isNew) ++nextFont_;
  return uint64_t{at->second} << 32 | glyph.glyph;
}

GpgpResult GlyphCache::find(std::span<const FontGlyph> glyphs, uint32_t* indices) {
  if (glyphs.empty()) return GPGP_SUCCESS;
  keys_.clear();
  for (const FontGlyph& glyph : glyphs) keys_.push_back(key(glyph));
  const auto count = static_cast<uint32_t>(glyphs.size());
  const GpgpResult found = set_.find(keys_.data(), count, indices);
  if (found != GPGP_INCOMPLETE) return found;
  std::vector<FontGlyph> missing;
  std::vector<uint64_t> missingKeys;
  std::unordered_map<uint64_t, bool> met;
  for (uint32_t i = 0; i < count; ++i)
    if (indices[i] == GPGP_GLYPH_NONE && met.emplace(keys_[i], true).second) {
      missing.push_back(glyphs[i]);
      missingKeys.push_back(keys_[i]);
    }
  const GpgpResult added = add(missing, missingKeys);
  if (added < 0) return added;
  const GpgpResult again = set_.find(keys_.data(), count, indices);
  return again == GPGP_INCOMPLETE ? added : again;
}

GpgpResult GlyphCache::add(std::span<const FontGlyph> glyphs, std::span<const uint64_t> keys) {
  std::deque<Outline> outlines;
  std::vector<GpgpGlyph> made;
  for (size_t i = 0; i < glyphs.size(); ++i) {
    Outline& outline = outlines.emplace_back();
    const GpgpResult result = fetch(glyphs[i], outline);
    if (result < 0) return result;
    made.push_back(
        {keys[i], outline.paths.data(), static_cast<uint32_t>(outline.paths.size()), outline.foreground.data()});
  }
  std::vector<uint32_t> indices(made.size());
  return set_.add(made.data(), static_cast<uint32_t>(made.size()), indices.data());
}

GpgpResult GlyphCache::place(const GpgpLayoutInfo& layout, float x, float y, float scale,
                             std::vector<GpgpGlyphInstance>& out) {
  wanted_.clear();
  for (uint32_t i = 0; i < layout.glyphCount; ++i) wanted_.push_back({layout.glyphs[i].font, layout.glyphs[i].glyph});
  indices_.assign(layout.glyphCount, GPGP_GLYPH_NONE);
  const GpgpResult result = find(wanted_, indices_.data());
  if (result < 0) return result;
  for (uint32_t i = 0; i < layout.glyphCount; ++i) {
    const GpgpTextGlyph& from = layout.glyphs[i];
    GpgpGlyphInstance to{indices_[i], x + from.x * scale, y + from.y * scale, from.size * scale, {}};
    for (int c = 0; c < 4; ++c) to.color[c] = from.color[c];
    out.push_back(to);
  }
  return result;
}

GpgpCanvasItem GlyphCache::item(std::span<const GpgpGlyphInstance> instances) const {
  GpgpCanvasItem item{};
  item.transform[0] = item.transform[3] = 1;
  item.opacity = 1;
  item.glyphSet = set_;
  item.glyphs = instances.data();
  item.glyphCount = static_cast<uint32_t>(instances.size());
  return item;
}

} // namespace gpgp::integration
