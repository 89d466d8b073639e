// Texts of the screen: fonts, texts laid out once, and the set of glyphs that they are drawn from. In a build without
// libgpgp_text (no_text.cpp), and where no font is found, all texts are empty.
#pragma once
#include "gpgp_glue.h"

#include <deque>
#include <optional>
#include <string_view>

namespace mini {

struct TextStyle {
  float size = 16; // pixels an em, as are all lengths
  bool bold = false;
  float color[4] = {1, 1, 1, 1};
  GpgpTextAlign align = GPGP_TEXT_ALIGN_START;
  float width = 0, height = 0; // lines break to fit; what does not fit ends with an ellipsis
  uint32_t maxLines = 0;       // 0: any
  bool operator==(const TextStyle&) const = default;
};

/// A laid out text, its upper left corner at 0, 0.
struct TextBlock {
  size_t placed = 0;   // where Text keeps its glyphs
  float width = 0;     // of the widest line
  float baseline = 0;  // of the first line
  float capHeight = 0; // of the style's first font
};

class Text {
public:
  /// Says on standard error which fonts are missing in the folder.
  Text(Device& device, Gpgp& gpgp, const std::string& fontFolder);
  ~Text();
  Text(const Text&) = delete;
  Text& operator=(const Text&) = delete;

  /// Lays out a text the first time it is asked for, which may convert glyphs; later it is found, without allocation.
  const TextBlock& layOut(std::string_view text, const TextStyle& style);
  /// Forgets the texts, as another picture size has others. Glyphs stay: they are there once for all sizes.
  void forget();
  /// Adds a text to a list, whose image of this number is image().
  void add(gpgp::List& list, const TextBlock& block, uint32_t image, uint64_t id);
  /// New glyphs that are pictures; outside render passes, beside gpgpRecordUpload, before what shows them.
  void upload(VkCommandBuffer commands, const GpgpFrame& frame);
  /// The texture of glyphs that are pictures; nothing as long as there is none.
  std::optional<GpgpCanvasImage> image() const;
  /// Glyphs that were converted and are in the set.
  uint32_t glyphCount() const {
    auto info = gpgp::init<GpgpGlyphSetInfo>();
    return glyphs_ && gpgpGetGlyphSetInfo(glyphs_, &info) == GPGP_SUCCESS ? info.glyphs : 0;
  }

private:
  struct Fonts;
  struct Entry {
    std::string text;
    TextStyle style;
    TextBlock block;
  };
  void set(const Entry& entry, TextBlock& block);
  Gpgp& gpgp_;
  GpgpAsset glyphs_ = nullptr; // the set; null: there is no font
  std::unique_ptr<Fonts> fonts_;
  std::deque<Entry> entries_; // as many as the screen has texts
};

} // namespace mini
