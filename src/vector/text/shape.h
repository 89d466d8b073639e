// Runs of characters to glyphs by HarfBuzz, kept within a budget, the least recently used leaving first.
#pragma once
#include "vector/text/font.h"
#include "vector/text/unicode.h"

#include <list>
#include <unordered_map>

namespace gpgp::text {

/// In em, y up, in the order in which they are seen, left to right.
struct ShapedGlyph {
  uint32_t glyph;
  uint32_t cluster; // the first character that it stands for, counted from the run's
  float advance;
  float x, y;
  bool safe; // shaping may be cut before its cluster without changing what is on either side
};

/// Where the font (GDEF) says that carets stand within a cluster of glyphs, as many as there is room for, from the left
/// in the units of `size`. False where it says nothing, another number, or what is not in order and within the advance.
constexpr uint32_t kMostCarets = 15;
bool ligatureCarets(const Font& font, std::span<const ShapedGlyph> cluster, float size, std::span<float> carets);

/// Characters [begin, end) of a text that are shaped together. Characters around them count as far as the next white
/// space, at most five on each side: they may join.
struct RunRequest {
  Font* font;
  hb_script_t script;
  hb_language_t language; // null: none
  bool rightToLeft;
  bool spaced; // no optional ligatures
  std::span<const GpgpFontFeature> features;
  std::span<const char32_t> text;
  uint32_t begin, end;
  bool parted;                          // begins with marks of what is shaped in another font
  std::span<const uint32_t> apart = {}; // characters that join no optional ligature with what is before them
};

class Shaper {
public:
  static Result<std::shared_ptr<Shaper>> create(const GpgpShaperCreateInfo& info);
  /// Valid until the next call. A run that is there already costs no memory.
  std::span<const ShapedGlyph> shape(const RunRequest& run);
  void report(GpgpShaperReport& report) const;

  Breaks breaks;
  Bidi bidi;
  Messages messages;

private:
  explicit Shaper(Breaks opened) : breaks(std::move(opened)) {}
  struct Entry {
    std::string key;
    std::vector<ShapedGlyph> glyphs;
    FontReference font; // keeps its address, which is part of the key, from becoming another's
    size_t bytes() const { return sizeof(Entry) + 64 + key.capacity() + glyphs.capacity() * sizeof(ShapedGlyph); }
  };
  void makeKey(const RunRequest& run, uint32_t from, uint32_t to);
  void shapeNow(const RunRequest& run, uint32_t from, uint32_t to, std::vector<ShapedGlyph>& glyphs);

  Owned<hb_buffer_t> buffer_;
  std::list<Entry> entries_; // the one used last comes first
  std::unordered_map<std::string_view, std::list<Entry>::iterator> index_;
  std::string key_;
  std::vector<hb_feature_t> features_;
  std::vector<ShapedGlyph> loose_; // of a run that is larger than the budget
  size_t budget_ = 0, bytes_ = 0;
  uint64_t hits_ = 0, misses_ = 0, evictions_ = 0;
};

} // namespace gpgp::text
