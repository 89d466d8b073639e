#include "cli/text/glyphs.h"

#include <algorithm>
#include <unordered_map>

namespace gpgp::cli {

KeptPath::KeptPath(const GpgpPath& path)
    : verbs_(path.verbs, path.verbs + path.verbCount), points_(path.points, path.points + size_t{path.pointCount} * 2),
      path_(path) {
  if (!path.gradient) return;
  gradient_ = *path.gradient;
  stops_.assign(gradient_->stops, gradient_->stops + gradient_->stopCount);
  gradient_->stops = stops_.data();
}

GpgpPath KeptPath::view() const {
  GpgpPath path = path_;
  path.verbs = verbs_.data();
  path.points = points_.data();
  path.gradient = gradient_ ? &*gradient_ : nullptr;
  return path;
}

PageGlyphs collectGlyphs(TextPage& page) {
  PageGlyphs all;
  std::unordered_map<uint64_t, uint32_t> known;
  const GpgpLayoutInfo& layout = page.layout();
  const auto find = [&](const GpgpTextGlyph& placed, const GpgpStroke* stroke) {
    const uint32_t font = page.fontNumber(placed.font);
    const uint64_t key = uint64_t{stroke != nullptr} << 63 | uint64_t{font} << 32 | placed.glyph;
    const auto [at, isNew] = known.emplace(key, static_cast<uint32_t>(all.glyphs.size()));
    if (!isNew) return at->second;
    PageGlyph& glyph = all.glyphs.emplace_back();
    glyph.key = key;
    page.outline(placed, stroke, [&](const GpgpGlyphOutline& outline) {
      for (uint32_t p = 0; p < outline.pathCount; ++p) {
        glyph.paths.emplace_back(outline.paths[p]);
        glyph.foreground.push_back(outline.foreground[p]);
      }
      const float reach = stroke ? stroke->width / 2 : 0;
      for (size_t side = 0; side < 4 && outline.pathCount; ++side)
        glyph.box[side] = outline.box[side] + (side < 2 ? -reach : reach);
      if (const GpgpGlyphImage* image = outline.image) {
        glyph.picture = {
            image->width, image->height, {image->pixels, image->pixels + size_t{image->width} * image->height * 4}};
        std::copy(std::begin(image->box), std::end(image->box), glyph.box);
      }
      if (outline.broken && !stroke) all.broken.push_back({font, placed.glyph});
    });
    return at->second;
  };
  for (uint32_t i = 0; i < layout.glyphCount; ++i) {
    all.which.push_back(find(layout.glyphs[i], nullptr));
    if (page.stroke()) all.outlines.push_back(find(layout.glyphs[i], page.stroke()));
  }
  return all;
}

std::pair<GlyphSet, std::vector<uint32_t>> makeGlyphSet(Session& session, const PageGlyphs& all) {
  std::vector<std::vector<GpgpPath>> paths(all.glyphs.size());
  std::vector<GpgpGlyph> glyphs(all.glyphs.size());
  for (size_t i = 0; i < glyphs.size(); ++i) {
    const PageGlyph& glyph = all.glyphs[i];
    glyphs[i].key = glyph.key;
    if (glyph.isPicture()) continue; // a blank
    for (const KeptPath& path : glyph.paths) paths[i].push_back(path.view());
    glyphs[i].paths = paths[i].data();
    glyphs[i].pathCount = static_cast<uint32_t>(paths[i].size());
    glyphs[i].foreground = glyph.foreground.data();
  }
  const auto count = static_cast<uint32_t>(glyphs.size());
  std::vector<uint32_t> indices(count);
  GpgpGlyphSetCreateInfo info = GPGP_GLYPH_SET_CREATE_INFO_INIT;
  info.label = "glyphs";
  info.maxGlyphs = std::max(count, 1u);
  for (;;) {
    GlyphSet set = session.take(GlyphSet::create(session.context(), info), "gpgpCreateGlyphSet");
    if (count == 0) return {std::move(set), indices};
    const GpgpResult added = session.check(set.add(glyphs.data(), count, indices.data()), "gpgpAddGlyphs");
    if (added != GPGP_BUDGET_EXCEEDED) return {std::move(set), indices};
    const GpgpGlyphSetInfo needs = session.take(set.info(), "gpgpGetGlyphSetInfo");
    info.maxBytes = std::max(needs.bytesNeeded, needs.maxBytes) * 5 / 4; // each glyph lies in a row
  }
}

} // namespace gpgp::cli
