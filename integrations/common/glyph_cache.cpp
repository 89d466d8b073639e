#include "gpgp_glyph_cache.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

namespace gpgp::integration {
namespace {

constexpr float kStrokeScale = 256;        // pixels per em up to which strokes are accurate
constexpr float kStrokeUnit = 1 / 4096.0f; // em

/// A glyph's paths, kept beyond the call that hands them over.
struct Outline {
  struct Path {
    std::vector<GpgpPathVerb> verbs;
    std::vector<float> points;
    std::vector<GpgpGradientStop> stops;
    GpgpGradient gradient{};
    GpgpStroke stroke{};
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
      if (path.stroke) {
        kept[i].stroke = *path.stroke; // without dashes
        path.stroke = &kept[i].stroke;
      }
      paths.push_back(path);
      foreground.push_back(outline.foreground[i]);
    }
  }
};

/// gpgpGetGlyphOutline; the callback is any function.
template <class Take> GpgpResult fetch(GpgpFont font, uint32_t glyph, float stroke, Take&& take) {
  GpgpGlyphOutlineInfo info = GPGP_GLYPH_OUTLINE_INFO_INIT;
  info.glyph = glyph;
  GpgpStroke line{};
  line.width = stroke;
  line.join = GPGP_JOIN_ROUND;
  line.scale = kStrokeScale;
  if (stroke > 0) info.stroke = &line;
  return gpgpGetGlyphOutline(
      font, &info, [](void* user, const GpgpGlyphOutline* given) { (*static_cast<Take*>(user))(*given); }, &take);
}

} // namespace

void PlacedText::clear() {
  glyphs.clear();
  pictures.clear();
  lines.clear();
  dropped = 0;
}

void PlacedText::decorate(std::span<const GpgpTextDecoration> decorations, float x, float y, float scale) {
  for (const GpgpTextDecoration& from : decorations) {
    const float left = x + from.rect.x * scale, top = y + from.rect.y * scale;
    PlacedLine& to = lines.emplace_back(
        PlacedLine{{left, top, left + from.rect.width * scale, top + from.rect.height * scale}, {}, from.strike != 0});
    std::copy_n(from.color, 4, to.color);
  }
}

std::array<float, 4> linesBox(const GpgpLayoutInfo& layout) {
  if (layout.lineCount == 0) return {};
  std::array<float, 4> box{layout.lines[0].left, 0, layout.lines[0].left, layout.height};
  for (uint32_t i = 0; i < layout.lineCount; ++i) {
    box[0] = std::min(box[0], layout.lines[i].left);
    box[2] = std::max(box[2], layout.lines[i].left + layout.lines[i].width);
  }
  return box;
}

std::array<float, 4> inkBox(GpgpFont font, uint32_t glyph) {
  std::array<float, 4> box{};
  fetch(font, glyph, 0, [&box](const GpgpGlyphOutline& outline) {
    std::copy_n(outline.image ? outline.image->box : outline.box, 4, box.begin());
  });
  return box;
}

GpgpResult GlyphCache::create(const GlyphCacheInfo& wanted) {
  auto info = init<GpgpGlyphSetCreateInfo>();
  info.label = wanted.label;
  info.maxGlyphs = wanted.maxGlyphs;
  info.maxBytes = wanted.maxBytes;
  Result<GlyphSet> made = GlyphSet::create(wanted.context, info);
  if (!made) return made.code();
  set_ = *std::move(made);
  if (wanted.pictureDevice.device)
    pictures_ = std::make_unique<GlyphPictures>(wanted.pictureDevice, wanted.maxPictures);
  return GPGP_SUCCESS;
}

const GlyphCache::FontEntry& GlyphCache::entryOf(GpgpFont font, float stroke) {
  const auto units = static_cast<uint32_t>(std::lround(std::clamp(stroke, 0.0f, 1000.0f) / kStrokeUnit));
  const auto [at, isNew] = fonts_.try_emplace({font, units});
  if (isNew) {
    GpgpFontInfo info = GPGP_FONT_INFO_INIT;
    const bool known = gpgpGetFontInfo(font, &info) == GPGP_SUCCESS;
    at->second = {nextFont_++, known && units == 0 && (info.colors & GPGP_FONT_COLOR_BITMAPS) != 0,
                  static_cast<float>(units) * kStrokeUnit};
  }
  return at->second;
}

/// keys_ and indices_ of all; those that the set has not are added.
GpgpResult GlyphCache::findGlyphs(std::span<const GpgpTextGlyph> glyphs, float stroke) {
  keys_.clear();
  for (const GpgpTextGlyph& glyph : glyphs)
    keys_.push_back(uint64_t{entryOf(glyph.font, stroke).number} << 32 | glyph.glyph);
  indices_.assign(glyphs.size(), GPGP_GLYPH_NONE);
  const auto count = static_cast<uint32_t>(glyphs.size());
  const GpgpResult found = set_.find(keys_.data(), count, indices_.data());
  if (found != GPGP_INCOMPLETE) return found;
  const GpgpResult added = addGlyphs(glyphs, stroke);
  if (added < 0) return added;
  const GpgpResult again = set_.find(keys_.data(), count, indices_.data());
  return again == GPGP_INCOMPLETE ? added : again;
}

/// Those without an index. Pictures are blanks in the set.
GpgpResult GlyphCache::addGlyphs(std::span<const GpgpTextGlyph> glyphs, float stroke) {
  std::deque<Outline> outlines;
  std::vector<GpgpGlyph> made;
  std::unordered_map<uint64_t, bool> met;
  for (size_t i = 0; i < glyphs.size(); ++i) {
    if (indices_[i] != GPGP_GLYPH_NONE || !met.emplace(keys_[i], true).second) continue;
    Outline& outline = outlines.emplace_back();
    const GpgpResult result = fetch(glyphs[i].font, glyphs[i].glyph, entryOf(glyphs[i].font, stroke).stroke,
                                    [&outline](const GpgpGlyphOutline& given) { outline.take(given); });
    if (result < 0) return result;
    made.push_back(
        {keys_[i], outline.paths.data(), static_cast<uint32_t>(outline.paths.size()), outline.foreground.data()});
  }
  std::vector<uint32_t> added(made.size());
  return set_.add(made.data(), static_cast<uint32_t>(made.size()), added.data());
}

/// Its picture in the texture; null: it is none, or BUDGET_EXCEEDED.
GpgpResult GlyphCache::findPicture(const GpgpTextGlyph& glyph, uint64_t key, const Picture*& found) {
  const auto [at, isNew] = pictureGlyphs_.try_emplace(key);
  Picture& picture = at->second;
  const bool there = picture.place != GlyphPictures::kNone && pictures_->owner(picture.place) == picture.owner;
  GpgpResult result = GPGP_SUCCESS;
  if (isNew || (picture.is && !there)) {
    if (!isNew && pictures_->full()) return GPGP_BUDGET_EXCEEDED; // without decoding it again in every frame
    picture.place = GlyphPictures::kNone;
    const GpgpResult fetched = fetch(glyph.font, glyph.glyph, 0, [&](const GpgpGlyphOutline& outline) {
      picture.is = outline.image != nullptr;
      if (!picture.is) return;
      std::copy_n(outline.image->box, 4, picture.box);
      result = pictures_->add(*outline.image, picture.place);
    });
    if (fetched < 0) {
      pictureGlyphs_.erase(at); // not known yet
      return fetched;
    }
    if (result != GPGP_SUCCESS) return result;
    if (picture.is) picture.owner = pictures_->owner(picture.place);
  }
  if (picture.is) {
    pictures_->use(picture.place);
    found = &picture;
  }
  return GPGP_SUCCESS;
}

GpgpResult GlyphCache::place(std::span<const GpgpTextGlyph> glyphs, float x, float y, float scale, PlacedText& text,
                             float stroke) {
  if (glyphs.empty()) return GPGP_SUCCESS;
  GpgpResult result = findGlyphs(glyphs, stroke);
  if (result < 0) return result;
  for (size_t i = 0; i < glyphs.size(); ++i) {
    const GpgpTextGlyph& from = glyphs[i];
    const float left = x + from.x * scale, top = y + from.y * scale, size = from.size * scale;
    if (pictures_ && entryOf(from.font, stroke).pictures) {
      const Picture* picture = nullptr;
      const GpgpResult found = findPicture(from, keys_[i], picture);
      if (found < 0) return found;
      if (found == GPGP_BUDGET_EXCEEDED) {
        ++text.dropped;
        result = found;
        continue;
      }
      if (picture) {
        PlacedPicture& to = text.pictures.emplace_back();
        for (size_t side = 0; side < 4; ++side) to.box[side] = (side % 2 == 0 ? left : top) + picture->box[side] * size;
        std::copy_n(pictures_->source(picture->place).begin(), 4, to.source);
        to.alpha = from.color[3];
        continue;
      }
    }
    if (indices_[i] == GPGP_GLYPH_NONE) {
      ++text.dropped;
      continue;
    }
    GpgpGlyphInstance& to = text.glyphs.emplace_back(GpgpGlyphInstance{indices_[i], left, top, size, {}});
    std::copy_n(from.color, 4, to.color);
  }
  return result;
}

GpgpResult GlyphCache::addTo(GpgpList list, const PlacedText& text, uint32_t image, uint64_t id) const {
  const auto addLines = [&](bool strikes) -> GpgpResult {
    for (const PlacedLine& line : text.lines) {
      if (line.strike != strikes) continue;
      GpgpListShape shape{};
      shape.kind = GPGP_LIST_RECTANGLE;
      std::copy_n(line.box, 4, shape.box);
      std::copy_n(line.color, 4, shape.color);
      shape.id = id;
      if (const GpgpResult added = gpgpAddShapes(list, &shape, 1); added < 0) return added;
    }
    return GPGP_SUCCESS;
  };
  if (const GpgpResult added = addLines(false); added < 0) return added;
  if (!text.glyphs.empty()) {
    const auto count = static_cast<uint32_t>(text.glyphs.size());
    if (const GpgpResult added = gpgpAddText(list, set_, text.glyphs.data(), count, id); added < 0) return added;
  }
  for (const PlacedPicture& picture : text.pictures) {
    GpgpListImage from{};
    from.image = image;
    std::copy_n(picture.source, 4, from.source);
    GpgpListShape shape{};
    shape.kind = GPGP_LIST_RECTANGLE;
    std::copy_n(picture.box, 4, shape.box);
    std::fill_n(shape.color, 3, 1.0f);
    shape.color[3] = picture.alpha;
    shape.image = &from;
    shape.id = id;
    if (const GpgpResult added = gpgpAddShapes(list, &shape, 1); added < 0) return added;
  }
  return addLines(true);
}

GpgpResult GlyphCache::recordUpload(VkCommandBuffer commands, const GpgpFrame& frame) {
  return pictures_ ? pictures_->recordUpload(commands, frame) : GPGP_SUCCESS;
}

std::optional<GpgpCanvasImage> GlyphCache::image() const { return pictures_ ? pictures_->image() : std::nullopt; }

void GlyphCache::forget(GpgpFont font) {
  const auto first = fonts_.lower_bound({font, 0});
  auto end = first;
  for (; end != fonts_.end() && end->first.first == font; ++end)
    std::erase_if(pictureGlyphs_, [&](const auto& entry) { return entry.first >> 32 == end->second.number; });
  fonts_.erase(first, end);
}

} // namespace gpgp::integration
