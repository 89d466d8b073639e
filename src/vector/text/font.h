// A face of a font file at chosen axes, opened twice: by HarfBuzz for shaping and metrics, whose functions are safe
// from any thread on what does not change, and by FreeType for outlines, colours and bitmaps, behind a lock.
//
// A font is counted: layouts and cached runs name it, so its address stays its own until the last of them is gone, but
// what it has open is closed when its handle is destroyed.
#pragma once
#include "core/result.h"

#include <gpgp/text.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <ft2build.h>
#include FT_FREETYPE_H
#include <hb.h>

namespace gpgp::text {

using core::makeError;
using core::Result;

struct Deleter {
  void operator()(hb_blob_t* blob) const { hb_blob_destroy(blob); }
  void operator()(hb_face_t* face) const { hb_face_destroy(face); }
  void operator()(hb_font_t* font) const { hb_font_destroy(font); }
  void operator()(hb_buffer_t* buffer) const { hb_buffer_destroy(buffer); }
  void operator()(hb_draw_funcs_t* functions) const { hb_draw_funcs_destroy(functions); }
  void operator()(FT_Library library) const { FT_Done_FreeType(library); }
  void operator()(FT_Face face) const { FT_Done_Face(face); }
};
template <class T> using Owned = std::unique_ptr<T, Deleter>;

/// Where messages of a font, a shaper or a layout go.
struct Messages {
  GpgpMessageFn function = nullptr;
  void* userData = nullptr;
  std::string label;
  void send(GpgpSeverity severity, GpgpResult code, const char* caller, const char* text) const {
    if (!function) return;
    const GpgpMessage message{severity, code, caller, label.c_str(), text};
    function(userData, &message);
  }
};

/// Where a font's messages go, also before there is one.
inline Messages messagesOf(const GpgpFontCreateInfo& info) {
  return {info.messageFn, info.messageUserData, info.label ? info.label : info.filePath ? info.filePath : ""};
}

/// What a font has open.
struct OpenFont {
  std::vector<char> bytes; // empty where the engine keeps them
  Owned<hb_face_t> face;
  Owned<hb_font_t> shaping; // at a scale of kUnits a font unit; never changed after it was opened
  std::mutex lock;          // of all below
  Owned<std::remove_pointer_t<FT_Library>> library;
  Owned<std::remove_pointer_t<FT_Face>> outlines;
  float emPerUnit = 0;        // of FreeType's 26.6 outlines, at the size that was set; 0: the font has bitmaps only
  bool variesCompact = false; // CFF2 at axes, whose points FreeType cuts down to whole font units
};

/// HarfBuzz works in integers: parts of a font unit, so that variable fonts are not rounded.
constexpr int kUnits = 64;

class Font {
public:
  static constexpr uint32_t kMagic = 0x666f6e74; // "font"
  static Result<Font*> create(const GpgpFontCreateInfo& info);

  void acquire() { references_.fetch_add(1, std::memory_order_relaxed); }
  void release() {
    if (references_.fetch_sub(1, std::memory_order_acq_rel) == 1) delete this;
  }
  /// Closes what is open. The object lives on while it is referred to.
  void close() { open_.reset(); }
  bool closed() const { return !open_; }

  hb_font_t* shaping() const { return open_->shaping.get(); }
  OpenFont& opened() { return *open_; }
  const GpgpFontInfo& info() const { return info_; }
  float emPerShapingUnit() const { return 1.f / (kUnits * static_cast<float>(info_.unitsPerEm)); }
  bool has(char32_t character) const {
    hb_codepoint_t glyph = 0;
    return hb_font_get_nominal_glyph(shaping(), character, &glyph) != 0 && glyph < info_.glyphCount;
  }

  /// In colour and without letters: text takes what such a font has only where no other has it.
  bool isEmojiFont() const { return emojiFont_; }

  uint32_t magic = kMagic;
  Messages messages;

private:
  Font() = default;
  ~Font() { magic = 0; }
  Result<void> openBoth(const GpgpFontCreateInfo& info);
  void readNames();
  void readMetrics();

  std::atomic<uint32_t> references_{1};
  std::unique_ptr<OpenFont> open_;
  GpgpFontInfo info_ = GPGP_FONT_INFO_INIT;
  bool emojiFont_ = false;
  std::vector<GpgpFontAxis> axes_;
  std::vector<std::string> names_;
};

/// A counted reference.
struct FontRelease {
  void operator()(Font* font) const { font->release(); }
};
using FontReference = std::unique_ptr<Font, FontRelease>;
inline FontReference refer(Font* font) {
  font->acquire();
  return FontReference(font);
}

/// Hands a glyph to `glyphFn`: outline.cpp. Takes the font's lock.
Result<void> deliverGlyph(Font& font, const GpgpGlyphOutlineInfo& info, GpgpGlyphFn glyphFn, void* userData);

} // namespace gpgp::text
