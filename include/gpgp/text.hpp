/* gpgp text.hpp: C++17 wrapper of text.h. The rules of the wrapper are in core.hpp.
 * The functions are in libgpgp_text; only programs that call them link that library.
 */
#ifndef GPGP_TEXT_HPP
#define GPGP_TEXT_HPP

#include <gpgp/core.hpp>
#include <gpgp/text.h>

#include <cstdint>
#include <memory>

namespace gpgp {

GPGP_STRUCTURE_OF(GpgpFontCreateInfo, GPGP_STRUCTURE_FONT_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpFontInfo, GPGP_STRUCTURE_FONT_INFO);
GPGP_STRUCTURE_OF(GpgpGlyphOutlineInfo, GPGP_STRUCTURE_GLYPH_OUTLINE_INFO);
GPGP_STRUCTURE_OF(GpgpShaperCreateInfo, GPGP_STRUCTURE_SHAPER_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpShaperReport, GPGP_STRUCTURE_SHAPER_REPORT);
GPGP_STRUCTURE_OF(GpgpTextInfo, GPGP_STRUCTURE_TEXT_INFO);
GPGP_STRUCTURE_OF(GpgpLayoutInfo, GPGP_STRUCTURE_LAYOUT_INFO);

namespace detail {
template <> struct Destroy<GpgpFont> {
  void operator()(GpgpFont handle) const noexcept { gpgpDestroyFont(handle); }
};
template <> struct Destroy<GpgpShaper> {
  void operator()(GpgpShaper handle) const noexcept { gpgpDestroyShaper(handle); }
};
template <> struct Destroy<GpgpLayout> {
  void operator()(GpgpLayout handle) const noexcept { gpgpDestroyLayout(handle); }
};
} // namespace detail

/// A face of a font file at chosen variation axes (gpgpCreateFont).
class Font : public Handle<GpgpFont> {
public:
  using Handle::Handle;
  static Result<Font> create(const GpgpFontCreateInfo& info) noexcept {
    GpgpFont raw = nullptr;
    const GpgpResult code = gpgpCreateFont(&info, &raw);
    return Result<Font>(code, Font(raw));
  }
  /// gpgpGetFontInfo
  Result<GpgpFontInfo> info() const noexcept {
    GpgpFontInfo value = init<GpgpFontInfo>();
    const GpgpResult code = gpgpGetFontInfo(get(), &value);
    return Result<GpgpFontInfo>(code, value);
  }
  /// gpgpGetNominalGlyph: the glyph of a character, before shaping.
  Result<uint32_t> glyph(uint32_t character) const noexcept {
    uint32_t value = 0;
    const GpgpResult code = gpgpGetNominalGlyph(get(), character, &value);
    return Result<uint32_t>(code, value);
  }
  /// gpgpGetGlyphClosure
  GpgpResult closure(const GpgpCharacterRange* ranges, uint32_t rangeCount, uint32_t& count,
                     uint32_t* glyphs) const noexcept {
    return gpgpGetGlyphClosure(get(), ranges, rangeCount, &count, glyphs);
  }
  /// gpgpGetGlyphOutline. take is called once, with a const GpgpGlyphOutline&.
  template <class Take> GpgpResult outline(const GpgpGlyphOutlineInfo& info, Take&& take) const noexcept {
    auto* taker = std::addressof(take); // works for const callables and for functions, too
    return gpgpGetGlyphOutline(
        get(), &info,
        [](void* user, const GpgpGlyphOutline* glyph) { (**static_cast<decltype(taker)*>(user))(*glyph); }, &taker);
  }
};

/// A text that has been laid out. A Shaper makes it and must exist whenever a new text is set.
class Layout : public Handle<GpgpLayout> {
public:
  using Handle::Handle;
  /// gpgpSetLayoutText
  GpgpResult set(const GpgpTextInfo& info) noexcept { return gpgpSetLayoutText(get(), &info); }
  /// gpgpGetLayoutInfo
  Result<GpgpLayoutInfo> info() const noexcept {
    GpgpLayoutInfo value = init<GpgpLayoutInfo>();
    const GpgpResult code = gpgpGetLayoutInfo(get(), &value);
    return Result<GpgpLayoutInfo>(code, value);
  }
  /// gpgpGetSelection
  GpgpResult selection(uint32_t begin, uint32_t end, uint32_t& count, GpgpTextRect* rects) const noexcept {
    return gpgpGetSelection(get(), begin, end, &count, rects);
  }
  /// gpgpGetCaret
  Result<GpgpCaret> caret(uint32_t offset, bool trailing = false) const noexcept {
    GpgpCaret value = GpgpCaret();
    const GpgpResult code = gpgpGetCaret(get(), offset, trailing, &value);
    return Result<GpgpCaret>(code, value);
  }
  /// gpgpHitTestLayout
  Result<GpgpTextHit> hitTest(float x, float y) const noexcept {
    GpgpTextHit value = GpgpTextHit();
    const GpgpResult code = gpgpHitTestLayout(get(), x, y, &value);
    return Result<GpgpTextHit>(code, value);
  }
  /// gpgpMoveCaret
  Result<uint32_t> moveCaret(uint32_t offset, GpgpCaretMove move, VkBool32* trailing = nullptr) const noexcept {
    uint32_t value = 0;
    const GpgpResult code = gpgpMoveCaret(get(), offset, move, &value, trailing);
    return Result<uint32_t>(code, value);
  }
};

/// Shapes text and caches what it shaped (gpgpCreateShaper).
class Shaper : public Handle<GpgpShaper> {
public:
  using Handle::Handle;
  static Result<Shaper> create(const GpgpShaperCreateInfo& info = init<GpgpShaperCreateInfo>()) noexcept {
    GpgpShaper raw = nullptr;
    const GpgpResult code = gpgpCreateShaper(&info, &raw);
    return Result<Shaper>(code, Shaper(raw));
  }
  /// gpgpCreateLayout
  Result<Layout> layout() const noexcept {
    GpgpLayout raw = nullptr;
    const GpgpResult code = gpgpCreateLayout(get(), &raw);
    return Result<Layout>(code, Layout(raw));
  }
  /// gpgpGetShaperReport
  Result<GpgpShaperReport> report() const noexcept {
    GpgpShaperReport value = init<GpgpShaperReport>();
    const GpgpResult code = gpgpGetShaperReport(get(), &value);
    return Result<GpgpShaperReport>(code, value);
  }
};

} // namespace gpgp

#endif
