// Lines: as many graphemes as fit, up to the last place where UAX #14 lets a line end, or within a word where there is
// none. Where a run is cut at a place that changes its glyphs, its part is shaped again; if that made the line too
// wide, an earlier place is taken.
#include "vector/text/layout.h"

#include <algorithm>
#include <cmath>

namespace gpgp::text {

namespace {
constexpr double kSlack = 0.01; // pixels: sums of floats may be off by less
}

uint32_t Layout::graphemeAt(uint32_t character) const {
  character = std::min(character, text_.size());
  while (character > 0 && !(flags_[character] & kGrapheme)) --character;
  return character;
}
uint32_t Layout::nextGrapheme(uint32_t character) const {
  const uint32_t size = text_.size();
  if (character >= size) return size;
  do ++character;
  while (character < size && !(flags_[character] & kGrapheme));
  return character;
}

float Layout::tabAdvance(const Run& run, double x) const {
  double stop = static_cast<double>(info_->tabWidth);
  if (!(stop > 0)) {
    hb_codepoint_t space = 0;
    hb_position_t advance = 0;
    if (hb_font_get_nominal_glyph(run.font->shaping(), ' ', &space))
      advance = hb_font_get_glyph_h_advance(run.font->shaping(), space);
    const float size = styles_[run.style].source->size;
    stop =
        static_cast<double>(size) * 8 * static_cast<double>(static_cast<float>(advance) * run.font->emPerShapingUnit());
    if (!(stop > 0)) stop = static_cast<double>(size) * 2;
  }
  return static_cast<float>((std::floor((x + kSlack) / stop) + 1) * stop - x);
}

uint32_t Layout::inkEndOf(uint32_t begin, uint32_t end) const {
  while (end > begin && isWhite(text_.characters[end - 1])) --end;
  return end;
}

/// Of characters from the beginning of a line on; gives tabs their width.
double Layout::inkWidth(uint32_t begin, uint32_t end) {
  double x = 0;
  for (uint32_t c = begin; c < end; ++c) {
    if (text_.characters[c] == '\t') width_[c] = tabAdvance(runs_[runAt(c)], x);
    x += static_cast<double>(width_[c]);
  }
  return x;
}

Layout::Piece Layout::slice(uint32_t index, uint32_t begin, uint32_t end) {
  const Run run = runs_[index]; // a copy
  Piece piece{begin, end, run.level, index, 0, 0, 0, 0};
  if (run.kind != Run::Kind::text) return piece;
  piece.firstGlyph = run.firstGlyph;
  piece.glyphCount = run.glyphCount;
  if (begin == run.begin && end == run.end) return piece;
  const bool whole = (begin == run.begin || (flags_[begin] & kSafe)) && (end == run.end || (flags_[end] & kSafe));
  if (!whole) {
    piece.firstGlyph = static_cast<uint32_t>(shaped_.size());
    piece.glyphCount = addGlyphs(text_, run, begin, end);
    measure(run, begin, end, piece.firstGlyph, piece.glyphCount);
    return piece;
  }
  // Clusters grow along the run, or shrink where it goes from right to left.
  const auto from = shaped_.begin() + run.firstGlyph, to = from + run.glyphCount;
  const auto below = [](const ShapedGlyph& glyph, uint32_t c) { return glyph.cluster < c; };
  const auto atLeast = [](const ShapedGlyph& glyph, uint32_t c) { return glyph.cluster >= c; };
  const bool backwards = run.level & 1;
  const auto first = backwards ? std::lower_bound(from, to, end, atLeast) : std::lower_bound(from, to, begin, below);
  const auto last = backwards ? std::lower_bound(from, to, begin, atLeast) : std::lower_bound(from, to, end, below);
  piece.firstGlyph = static_cast<uint32_t>(first - shaped_.begin());
  piece.glyphCount = static_cast<uint32_t>(last - first);
  return piece;
}

/// Appends the runs of an ellipsis or a hyphen at a character, in a paragraph or among characters of a level, and
/// returns the first; `otherwise`: where no font of the style has the first of it.
uint32_t Layout::insert(const char* text, const char* otherwise, uint32_t style, uint8_t level, uint32_t at) {
  inserted_.text.assign(text);
  auto& characters = inserted_.text.characters;
  if (otherwise && !Itemizer::fontOf(std::span(characters).first(1), styles_[style])->has(characters[0]))
    inserted_.text.assign(otherwise);
  std::replace_if(
      characters.begin(), characters.end(), [](char32_t c) { return isNewline(c) || c == '\t'; }, U' ');
  const uint32_t size = inserted_.text.size();
  inserted_.styleOf.assign(size, style);
  inserted_.levels.assign(size, level);
  inserted_.flags.assign(size_t(size) + 1, 0);
  shaping_->breaks.graphemes(inserted_.text, inserted_.flags);
  if (level < 2) // of a paragraph; a lack of memory leaves all in its direction
    if (!shaping_->bidi.levels(characters, level ? 1 : -1, inserted_.levels.data()))
      inserted_.levels.assign(size, level);
  const uint32_t first = static_cast<uint32_t>(runs_.size());
  Itemizer{inserted_.text, styles_, inserted_.styleOf, inserted_.flags, inserted_.levels, scripts_}.paragraph(0, size,
                                                                                                              runs_);
  for (Run& run : std::span(runs_).subspan(first)) {
    run.firstGlyph = static_cast<uint32_t>(shaped_.size());
    run.glyphCount = addGlyphs(inserted_.text, run, run.begin, run.end);
    for (ShapedGlyph& glyph : std::span(shaped_).subspan(run.firstGlyph)) glyph.cluster = at;
    run.begin = run.end = at;
    run.kind = Run::Kind::inserted;
  }
  return first;
}

float Layout::insertedWidth(const Run& run) const {
  float width = 0;
  for (uint32_t i = 0; i < run.glyphCount; ++i)
    width += shaped_[run.firstGlyph + i].advance * styles_[run.style].source->size;
  return width;
}

/// A line's pieces in the order in which they are seen, and its widths. `inserted`: the first run of an ellipsis, to
/// which all behind it belong.
void Layout::build(Line& line, uint32_t inserted) {
  line.inkEnd = inkEndOf(line.begin, line.end);
  ordered_.clear();
  for (uint32_t at = line.begin, index = at < line.end ? runAt(at) : 0; at < line.end; ++index) {
    const uint32_t end = std::min(runs_[index].end, line.end);
    // White space at a line's end has the paragraph's level (UAX #9, rule L1).
    const bool parts = at < line.inkEnd && line.inkEnd < end && runs_[index].level != line.level;
    ordered_.push_back(slice(index, at, parts ? line.inkEnd : end));
    if (parts) ordered_.push_back(slice(index, line.inkEnd, end));
    if (ordered_.back().begin >= line.inkEnd) ordered_.back().level = line.level;
    at = end;
  }
  line.ink = inkWidth(line.begin, line.inkEnd);
  line.hang = inkWidth(line.begin, line.end) - line.ink;
  for (Piece& piece : ordered_)
    for (uint32_t c = piece.begin; c < piece.end; ++c) piece.width += width_[c];
  constexpr char32_t kSoftHyphen = 0xad;
  if (inserted == ~0u && !line.hard && line.end > line.begin && text_.characters[line.end - 1] == kSoftHyphen)
    inserted = insert("\xe2\x80\x90", "-", styleOf_[line.end - 1], ordered_.back().level, line.end - 1);
  for (; inserted < runs_.size(); ++inserted) {
    const Run& run = runs_[inserted];
    ordered_.push_back(
        {line.end, line.end, run.level, inserted, run.firstGlyph, run.glyphCount, 0, insertedWidth(run)});
    line.ink += static_cast<double>(ordered_.back().width);
  }
  pieceLevels_.clear();
  for (const Piece& piece : ordered_) pieceLevels_.push_back(piece.level);
  visualOrder(pieceLevels_, order_);
  line.firstPiece = static_cast<uint32_t>(pieces_.size());
  line.pieceCount = static_cast<uint32_t>(ordered_.size());
  for (const uint32_t each : order_) pieces_.push_back(ordered_[each]);
}

Layout::Line Layout::breakLine(uint32_t begin, uint8_t level) {
  const uint32_t size = text_.size();
  const double limit = info_->width > 0 ? static_cast<double>(info_->width) + kSlack : HUGE_VAL;
  Line line{begin, size, size, true, level};
  double x = 0;
  uint32_t soft = begin;
  for (uint32_t c = begin; c < size; ++c) {
    if (c > begin && (flags_[c] & kHardBreak)) {
      line.end = c;
      break;
    }
    if (flags_[c] & kSoftBreak) soft = c;
    if (text_.characters[c] == '\t') width_[c] = tabAdvance(runs_[runAt(c)], x);
    x += static_cast<double>(width_[c]);
    if (x <= limit || isWhite(text_.characters[c])) continue;
    line.hard = false;
    line.end = soft > begin ? soft : std::max(graphemeAt(c), begin);
    if (line.end == begin) { // one grapheme, too wide; with what takes no room behind it
      constexpr uint8_t kBreak = kSoftBreak | kHardBreak;
      line.end = nextGrapheme(begin);
      while (line.end < size && !(flags_[line.end] & kBreak) &&
             (isWhite(text_.characters[line.end]) || isIgnorable(text_.characters[line.end])))
        line.end = nextGrapheme(line.end);
      line.hard = line.end < size && (flags_[line.end] & kHardBreak);
    }
    break;
  }
  const uint32_t pieces = static_cast<uint32_t>(pieces_.size());
  for (;;) {
    pieces_.resize(pieces);
    build(line);
    if (line.ink <= limit) break;
    uint32_t last = line.inkEnd > begin ? line.inkEnd - 1 : begin;
    while (last > begin && isIgnorable(text_.characters[last])) --last; // a soft hyphen goes with what is before it
    uint32_t earlier = last;
    while (earlier > begin && !(flags_[earlier] & kSoftBreak)) --earlier;
    if (earlier == begin) earlier = graphemeAt(last);
    if (earlier <= begin) break; // a single grapheme that is too wide
    line.end = earlier;
    line.hard = false;
  }
  if (line.end == size) line.hard = true;
  return line;
}

void Layout::Metrics::use(const Run& run, const Style& style) {
  const GpgpFontInfo& info = run.font->info();
  const float size = style.source->size;
  ascent = any ? std::max(ascent, info.ascent * size) : info.ascent * size;
  descent = any ? std::max(descent, info.descent * size) : info.descent * size;
  gap = std::max(gap, info.lineGap * size);
  any = true;
}

float Layout::Metrics::height(const GpgpTextInfo& info) const {
  const float natural = ascent + descent + gap;
  return info.lineHeight > 0 ? info.lineHeight : info.lineSpacing > 0 ? natural * info.lineSpacing : natural;
}

/// Of its characters: an ellipsis or a hyphen makes no line higher, and alone it takes the place of the first.
Layout::Metrics Layout::metricsOf(const Line& line) const {
  Metrics metrics;
  const auto use = [&](const Run& run) { metrics.use(run, styles_[run.style]); };
  for (uint32_t i = 0; i < line.pieceCount; ++i) {
    const Run& run = runs_[pieces_[line.firstPiece + i].run];
    if (run.kind != Run::Kind::inserted) use(run);
  }
  if (metrics.any) return metrics;
  if (line.begin < text_.size()) {
    use(runs_[runAt(line.begin)]);
  } else {
    Run none{};
    none.style = text_.size() ? styleOf_[text_.size() - 1] : 0;
    none.font = styles_[none.style].font(0);
    use(none);
  }
  return metrics;
}

void Layout::setHeight(Line& line) const {
  const Metrics metrics = metricsOf(line);
  line.ascent = metrics.ascent;
  line.descent = metrics.descent;
  line.height = metrics.height(*info_);
  line.above = (line.height - line.ascent - line.descent) / 2 + line.ascent;
}

/// Fills the last line with what follows as long as the line grows no higher than `room`, and takes as much away again
/// as the ellipsis needs, of a word that does not fit whole, too. The ellipsis has the style of what is before it.
void Layout::cutOff(Line& line, double room) {
  const double limit = info_->width > 0 ? static_cast<double>(info_->width) + kSlack : HUGE_VAL;
  const uint32_t begin = line.begin, size = text_.size();
  const bool marked = !info_->ellipsis || info_->ellipsis[0];
  Metrics metrics = metricsOf(line);
  uint32_t end = line.end;
  for (double x = inkWidth(begin, end); end < size && !(flags_[end] & kHardBreak) && x <= limit; ++end) {
    const Run& run = runs_[runAt(end)];
    metrics.use(run, styles_[run.style]);
    if (static_cast<double>(metrics.height(*info_)) > room) break;
    x += static_cast<double>(width_[end]);
  }
  if (end == size) { // what was too much for the line may take room away: letters that are brought together
    pieces_.resize(line.firstPiece);
    line.end = end;
    line.hard = true;
    build(line);
    if (line.ink <= limit) return setHeight(line);
  }
  truncated_ = true;
  end = inkEndOf(begin, graphemeAt(end));
  const auto shorter = [&] { return inkEndOf(begin, std::max(begin, graphemeAt(end - 1))); };
  uint32_t index = ~0u;
  for (;; end = shorter()) {
    const uint32_t style = styleOf_[end > begin ? end - 1 : begin];
    if (marked && (index == ~0u || runs_[index].style != style))
      index = insert(info_->ellipsis ? info_->ellipsis : "\xe2\x80\xa6", info_->ellipsis ? nullptr : "...", style,
                     line.level, end);
    double ellipsis = 0;
    for (size_t i = index; i < runs_.size(); ++i) ellipsis += static_cast<double>(insertedWidth(runs_[i]));
    if (end > begin && inkWidth(begin, end) + ellipsis > limit) continue;
    pieces_.resize(line.firstPiece);
    line.end = end;
    build(line, index);
    if (line.ink <= limit || end == begin) break;
  }
  line.hard = true;
  if (index != ~0u) {
    for (const Run& run : std::span(runs_).subspan(index))
      for (ShapedGlyph& glyph : std::span(shaped_).subspan(run.firstGlyph, run.glyphCount)) glyph.cluster = end;
    for (uint32_t c = 0; c < inserted_.text.size(); ++c) {
      const char32_t character = inserted_.text.characters[c];
      const auto has = [&](const Run& run) { return run.font->has(character); };
      if (!isIgnorable(character) && std::none_of(runs_.begin() + index, runs_.end(), has))
        missing_.push_back({text_.byteOf[end], character});
    }
  }
  setHeight(line);
}

void Layout::breakLines() {
  const uint32_t size = text_.size();
  const double highest = info_->height > 0 ? static_cast<double>(info_->height) + kSlack : HUGE_VAL;
  double top = 0;
  size_t paragraph = 0;
  uint32_t at = 0;
  do {
    while (paragraph + 1 < paragraphs_.size() && paragraphs_[paragraph].end <= at) ++paragraph;
    if (info_->maxLines && cut_.size() == info_->maxLines) break;
    Line line = breakLine(at, paragraphs_[paragraph].level);
    setHeight(line);
    if (!cut_.empty() && top + static_cast<double>(line.height) > highest) {
      pieces_.resize(line.firstPiece);
      break;
    }
    top += static_cast<double>(line.height);
    cut_.push_back(line);
    at = line.end;
    if (at == size && (line.begin == size || !isNewline(text_.characters[size - 1]))) return;
  } while (true);
  if (at == size) return;
  Line& last = cut_.back();
  const double own = static_cast<double>(last.height);
  cutOff(last, std::max(highest - (top - own), own));
}

} // namespace gpgp::text
