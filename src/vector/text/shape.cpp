// The shaper: a key for all that a run's glyphs depend on, HarfBuzz where the key is new.
#include "vector/text/itemize.h"

#include <algorithm>

#include <hb-ot.h>

namespace gpgp::text {

Result<std::shared_ptr<Shaper>> Shaper::create(const GpgpShaperCreateInfo& info) {
  auto breaks = Breaks::create();
  if (!breaks) return breaks.error();
  std::shared_ptr<Shaper> shaper(new Shaper(std::move(*breaks)));
  shaper->messages = {info.messageFn, info.messageUserData, info.label ? info.label : ""};
  shaper->buffer_.reset(hb_buffer_create());
  if (!hb_buffer_allocation_successful(shaper->buffer_.get()))
    return makeError(GPGP_ERROR_OUT_OF_HOST_MEMORY, "HarfBuzz cannot get its memory");
  shaper->budget_ = info.cacheBytes ? info.cacheBytes : size_t(1) << 20;
  return shaper;
}

bool ligatureCarets(const Font& font, std::span<const ShapedGlyph> cluster, float size, std::span<float> carets) {
  float pen = 0;
  bool found = false;
  for (const ShapedGlyph& glyph : cluster) {
    hb_position_t places[kMostCarets];
    unsigned count = static_cast<unsigned>(carets.size());
    const unsigned all =
        hb_ot_layout_get_ligature_carets(font.shaping(), HB_DIRECTION_LTR, glyph.glyph, 0, &count, places);
    if (!found && all == carets.size()) { // the ligature; others are its marks
      found = true;
      for (unsigned i = 0; i < all; ++i)
        carets[i] = (pen + glyph.x + static_cast<float>(places[i]) * font.emPerShapingUnit()) * size;
    }
    pen += glyph.advance;
  }
  float last = 0;
  for (const float caret : carets) {
    found = found && caret > last && caret < pen * size;
    last = caret;
  }
  return found;
}

namespace {
template <class T> void append(std::string& key, const T& value) {
  key.append(reinterpret_cast<const char*>(&value), sizeof value);
}
} // namespace

void Shaper::makeKey(const RunRequest& run, uint32_t from, uint32_t to) {
  key_.clear();
  append(key_, reinterpret_cast<uintptr_t>(run.font));
  append(key_, reinterpret_cast<uintptr_t>(run.language));
  append(key_, run.script);
  append(key_, run.begin - from);
  append(key_, to - run.end);
  append(key_, run.rightToLeft);
  append(key_, run.spaced);
  append(key_, run.parted);
  append(key_, run.apart.size());
  for (const uint32_t c : run.apart) append(key_, c - run.begin);
  append(key_, run.features.size());
  for (const GpgpFontFeature& feature : run.features) append(key_, feature);
  key_.append(reinterpret_cast<const char*>(run.text.data() + from), (to - from) * sizeof(char32_t));
}

void Shaper::shapeNow(const RunRequest& run, uint32_t from, uint32_t to, std::vector<ShapedGlyph>& glyphs) {
  features_.clear();
  const auto feature = [&](GpgpTag tag, uint32_t value) {
    features_.push_back({tag, value, HB_FEATURE_GLOBAL_START, HB_FEATURE_GLOBAL_END});
  };
  if (run.spaced)
    for (const GpgpTag tag : {GPGP_TAG('l', 'i', 'g', 'a'), GPGP_TAG('c', 'l', 'i', 'g')}) feature(tag, 0);
  for (const GpgpFontFeature& wanted : run.features) feature(wanted.tag, wanted.value);
  for (const uint32_t c : run.apart)
    for (const GpgpTag tag : {GPGP_TAG('l', 'i', 'g', 'a'), GPGP_TAG('c', 'l', 'i', 'g'), GPGP_TAG('d', 'l', 'i', 'g'),
                              GPGP_TAG('h', 'l', 'i', 'g')})
      features_.push_back({tag, 0, c - from, c - from + 1});

  hb_buffer_t* buffer = buffer_.get();
  hb_buffer_clear_contents(buffer);
  hb_buffer_add_utf32(buffer, reinterpret_cast<const uint32_t*>(run.text.data()) + from, static_cast<int>(to - from),
                      run.begin - from, static_cast<int>(run.end - run.begin));
  hb_buffer_set_direction(buffer, run.rightToLeft ? HB_DIRECTION_RTL : HB_DIRECTION_LTR);
  hb_buffer_set_script(buffer, run.script);
  hb_buffer_set_language(buffer, run.language);
  hb_buffer_set_flags(buffer, run.parted ? HB_BUFFER_FLAG_DO_NOT_INSERT_DOTTED_CIRCLE : HB_BUFFER_FLAG_DEFAULT);
  hb_shape(run.font->shaping(), buffer, features_.data(), static_cast<unsigned>(features_.size()));
  if (!hb_buffer_allocation_successful(buffer)) throw std::bad_alloc();

  unsigned count = 0;
  const hb_glyph_info_t* infos = hb_buffer_get_glyph_infos(buffer, &count);
  const hb_glyph_position_t* places = hb_buffer_get_glyph_positions(buffer, &count);
  const float em = run.font->emPerShapingUnit();
  glyphs.clear();
  glyphs.reserve(count);
  const uint32_t known = run.font->info().glyphCount; // a damaged font's tables name others, too
  for (unsigned i = 0; i < count; ++i)
    glyphs.push_back({infos[i].codepoint < known ? infos[i].codepoint : 0, infos[i].cluster - (run.begin - from),
                      static_cast<float>(places[i].x_advance) * em, static_cast<float>(places[i].x_offset) * em,
                      static_cast<float>(places[i].y_offset) * em,
                      !(hb_glyph_info_get_glyph_flags(&infos[i]) & HB_GLYPH_FLAG_UNSAFE_TO_BREAK)});
}

std::span<const ShapedGlyph> Shaper::shape(const RunRequest& run) {
  constexpr uint32_t kContext = 5; // as many as HarfBuzz looks at
  uint32_t from = run.begin, to = run.end;
  while (from > 0 && run.begin - from < kContext && !isWhite(run.text[from - 1])) --from;
  while (to < run.text.size() && to - run.end < kContext && !isWhite(run.text[to])) ++to;
  makeKey(run, from, to);
  if (const auto found = index_.find(key_); found != index_.end()) {
    ++hits_;
    entries_.splice(entries_.begin(), entries_, found->second);
    return found->second->glyphs;
  }
  ++misses_;
  shapeNow(run, from, to, loose_);
  Entry entry{key_, loose_, refer(run.font)};
  const size_t bytes = entry.bytes();
  if (bytes > budget_) return loose_;
  while (bytes_ + bytes > budget_) {
    const Entry& last = entries_.back();
    bytes_ -= last.bytes();
    index_.erase(last.key);
    entries_.pop_back();
    ++evictions_;
  }
  entries_.push_front(std::move(entry));
  try {
    index_.emplace(entries_.front().key, entries_.begin());
  } catch (...) {
    entries_.pop_front();
    throw;
  }
  bytes_ += bytes;
  return entries_.front().glyphs;
}

void Shaper::report(GpgpShaperReport& report) const {
  report.hits = hits_;
  report.misses = misses_;
  report.evictions = evictions_;
  report.runs = entries_.size();
  report.bytes = bytes_;
  report.cacheBytes = budget_;
}

} // namespace gpgp::text
