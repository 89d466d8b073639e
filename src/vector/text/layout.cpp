// The first half of a layout: a text to runs, their glyphs and a width for each character.
#include "vector/text/layout.h"

#include <algorithm>
#include <array>

namespace gpgp::text {

void Layout::clear() {
  text_.assign({});
  for (auto* words : {&styleOf_, &order_}) words->clear();
  for (auto* bytes : {&flags_, &levels_, &pieceLevels_}) bytes->clear();
  for (auto* numbers : {&width_, &extra_}) numbers->clear();
  styles_.clear();
  paragraphs_.clear();
  runs_.clear();
  shaped_.clear();
  cut_.clear();
  pieces_.clear();
  ordered_.clear();
  glyphs_.clear();
  lines_.clear();
  decorations_.clear();
  missing_.clear();
  layoutWidth_ = layoutHeight_ = 0;
  textRuns_ = 0;
  truncated_ = wordsKnown_ = false;
}

Result<void> Layout::set(const GpgpTextInfo& info) {
  const auto shaper = shaper_.lock();
  if (!shaper) return makeError(GPGP_ERROR_INVALID_HANDLE, "the layout's shaper is destroyed");
  clear();
  shaping_ = shaper.get();
  info_ = &info;
  try {
    if (auto ok = analyse(); !ok) {
      clear();
      return ok;
    }
    shapeRuns();
    breakLines();
    place();
  } catch (...) {
    clear();
    throw;
  }
  return {};
}

Result<void> Layout::analyse() {
  text_.assign({info_->text ? info_->text : "", info_->size});
  const uint32_t size = text_.size();
  const auto addStyle = [&](const GpgpTextStyle& style) {
    styles_.push_back({&style, style.language ? hb_language_from_string(style.language, -1) : nullptr});
  };
  addStyle(info_->style);
  styleOf_.assign(size_t(size) + 1, 0);
  for (uint32_t i = 0; i < info_->spanCount; ++i) {
    const GpgpTextSpan& span = info_->spans[i];
    addStyle(span.style);
    const uint32_t begin = text_.characterAt(span.begin), end = text_.characterAt(span.end);
    std::fill(styleOf_.begin() + begin, styleOf_.begin() + end, i + 1);
  }
  flags_.assign(size_t(size) + 1, 0);
  levels_.assign(size, 0);
  width_.assign(size, 0);
  extra_.assign(size, 0);
  shaping_->breaks.graphemes(text_, flags_);
  flags_[size] = kGrapheme;

  const int given = info_->direction == GPGP_TEXT_LEFT_TO_RIGHT   ? -1
                    : info_->direction == GPGP_TEXT_RIGHT_TO_LEFT ? 1
                                                                  : 0;
  const auto& characters = text_.characters;
  for (uint32_t begin = 0, end = 0; begin < size; begin = end) {
    const auto ends = [&](uint32_t at) {
      const char32_t c = characters[at];
      return c == '\n' || c == 0x85 || c == 0x2029 || (c == '\r' && !(at + 1 < size && characters[at + 1] == '\n'));
    };
    end = begin;
    while (end < size && !ends(end)) ++end;
    if (end < size) ++end;
    const auto paragraph = std::span(characters).subspan(begin, end - begin);
    const auto level = shaping_->bidi.levels(paragraph, given, levels_.data() + begin);
    if (!level) return level.error();
    paragraphs_.push_back({begin, end, *level});
    const char* language = styles_[styleOf_[begin]].source->language;
    shaping_->breaks.lines(text_, begin, end, language ? language : "", flags_);
    if (begin > 0) flags_[begin] |= kHardBreak;
    const Itemizer itemizer{text_, styles_, styleOf_, flags_, levels_, scripts_};
    itemizer.paragraph(begin, end, runs_);
  }
  if (size == 0 || isNewline(characters[size - 1])) { // an empty line at the end
    const uint8_t level = given > 0 || (given == 0 && !paragraphs_.empty() && paragraphs_.back().level) ? 1 : 0;
    paragraphs_.push_back({size, size, level});
  }
  textRuns_ = runs_.size();
  return {};
}

/// Whether a grapheme begins there that is painted otherwise than the one before it: a glyph can have but one colour.
bool Layout::paintedApart(uint32_t character) const {
  if (!(flags_[character] & kGrapheme) || styleOf_[character] == styleOf_[character - 1]) return false;
  const GpgpTextStyle &a = *styles_[styleOf_[character - 1]].source, &b = *styles_[styleOf_[character]].source;
  return !std::equal(a.color, a.color + 4, b.color) || a.outlineWidth != b.outlineWidth ||
         !std::equal(a.outlineColor, a.outlineColor + 4, b.outlineColor);
}

uint32_t Layout::addGlyphs(const Text& text, const Run& run, uint32_t begin, uint32_t end) {
  const Style& style = styles_[run.style];
  RunRequest request{run.font,
                     run.script,
                     style.language,
                     (run.level & 1) != 0,
                     style.source->letterSpacing != 0,
                     {style.source->features, style.source->featureCount},
                     text.characters,
                     begin,
                     end,
                     run.parted && begin == run.begin};
  auto glyphs = shaping_->shape(request);
  if (&text == &text_ && styles_.size() > 1) { // letters of a ligature that are painted otherwise leave it
    apart_.clear();
    const auto hasGlyph = [&](uint32_t cluster) { // clusters grow along the run, or shrink from right to left
      const auto found = std::partition_point(glyphs.begin(), glyphs.end(), [&](const ShapedGlyph& glyph) {
        return request.rightToLeft ? glyph.cluster > cluster : glyph.cluster < cluster;
      });
      return found != glyphs.end() && found->cluster == cluster;
    };
    for (uint32_t c = begin + 1; c < end; ++c)
      if (paintedApart(c) && !hasGlyph(c - begin)) apart_.push_back(c);
    if (!apart_.empty()) {
      request.apart = apart_;
      glyphs = shaping_->shape(request);
    }
  }
  for (ShapedGlyph glyph : glyphs) {
    glyph.cluster += begin;
    shaped_.push_back(glyph);
  }
  return static_cast<uint32_t>(glyphs.size());
}

/// Gives each grapheme of a cluster its part of the cluster's width: up to the font's carets, or evenly.
void Layout::share(const Run& run, std::span<const ShapedGlyph> glyphs, uint32_t begin, uint32_t end) {
  uint32_t graphemes = 0;
  for (uint32_t c = begin; c < end; ++c) graphemes += flags_[c] & kGrapheme;
  if (graphemes < 2) return;
  const float whole = width_[begin], part = whole / static_cast<float>(graphemes);
  std::array<float, kMostCarets> carets;
  const bool told = graphemes <= kMostCarets + 1 && ligatureCarets(*run.font, glyphs, styles_[run.style].source->size,
                                                                   std::span(carets).first(graphemes - 1));
  const auto edge = [&](uint32_t i) { return i == 0 ? 0 : i == graphemes ? whole : carets[i - 1]; }; // from the left
  uint32_t i = 0;
  for (uint32_t c = begin; c < end; ++c) {
    if (!(flags_[c] & kGrapheme)) continue;
    const uint32_t left = run.level & 1 ? graphemes - 1 - i : i;
    width_[c] = told ? edge(left + 1) - edge(left) : part;
    ++i;
  }
}

void Layout::measure(const Run& run, uint32_t begin, uint32_t end, uint32_t firstGlyph, uint32_t glyphCount) {
  const auto glyphs = std::span(shaped_).subspan(firstGlyph, glyphCount);
  const float size = styles_[run.style].source->size;
  std::fill(width_.begin() + begin, width_.begin() + end, 0.f);
  std::fill(extra_.begin() + begin, extra_.begin() + end, 0.f);
  for (const ShapedGlyph& glyph : glyphs) width_[glyph.cluster] += glyph.advance * size;
  // Clusters from the text's end on: where the next begins, this one ends.
  const bool backwards = run.level & 1;
  uint32_t clusterEnd = end;
  for (size_t done = 0; done < glyphs.size();) {
    const auto at = [&](size_t i) { return backwards ? i : glyphs.size() - 1 - i; };
    const uint32_t cluster = glyphs[at(done)].cluster;
    const size_t before = done;
    while (done < glyphs.size() && glyphs[at(done)].cluster == cluster) ++done;
    share(run, glyphs.subspan(std::min(at(before), at(done - 1)), done - before), cluster, clusterEnd);
    clusterEnd = cluster;
  }
  if (isCursive(run.script)) return;
  for (uint32_t c = begin; c < end; ++c) {
    if (!(flags_[c] & kGrapheme) || isIgnorable(text_.characters[c])) continue;
    extra_[c] = styles_[styleOf_[c]].source->letterSpacing;
    width_[c] += extra_[c];
  }
}

void Layout::shapeRuns() {
  for (Run& run : runs_) {
    if (run.kind != Run::Kind::text) continue;
    run.firstGlyph = static_cast<uint32_t>(shaped_.size());
    run.glyphCount = addGlyphs(text_, run, run.begin, run.end);
    measure(run, run.begin, run.end, run.firstGlyph, run.glyphCount);
    uint32_t reported = ~0u;
    for (uint32_t i = 0; i < run.glyphCount; ++i) {
      const ShapedGlyph& glyph = shaped_[run.firstGlyph + i];
      if (glyph.safe) flags_[glyph.cluster] |= kSafe;
      if (glyph.glyph != 0 || glyph.cluster == reported) continue;
      reported = glyph.cluster;
      // The rest of the grapheme, as far as the run goes: another run of it tells its own.
      for (uint32_t c = glyph.cluster; c < run.end && (c == glyph.cluster || !(flags_[c] & kGrapheme)); ++c)
        if (!run.font->has(text_.characters[c]) && !isIgnorable(text_.characters[c]))
          missing_.push_back({text_.byteOf[c], text_.characters[c]});
    }
  }
  std::sort(missing_.begin(), missing_.end(), [](auto& a, auto& b) { return a.offset < b.offset; });
  const auto same = [](auto& a, auto& b) { return a.offset == b.offset; };
  missing_.erase(std::unique(missing_.begin(), missing_.end(), same), missing_.end());
}

uint32_t Layout::runAt(uint32_t character) const {
  const auto after = std::upper_bound(runs_.begin(), runs_.begin() + static_cast<std::ptrdiff_t>(textRuns_), character,
                                      [](uint32_t c, const Run& run) { return c < run.begin; });
  return static_cast<uint32_t>(after - runs_.begin()) - 1;
}

void Layout::info(GpgpLayoutInfo& info) const {
  info.width = layoutWidth_;
  info.height = layoutHeight_;
  info.glyphs = glyphs_.data();
  info.glyphCount = static_cast<uint32_t>(glyphs_.size());
  info.lines = lines_.data();
  info.lineCount = static_cast<uint32_t>(lines_.size());
  info.decorations = decorations_.data();
  info.decorationCount = static_cast<uint32_t>(decorations_.size());
  info.missing = missing_.data();
  info.missingCount = static_cast<uint32_t>(missing_.size());
  info.invalid = text_.invalid.data();
  info.invalidCount = static_cast<uint32_t>(text_.invalid.size());
  info.truncated = truncated_;
}

} // namespace gpgp::text
