// The C functions of text.h, in libgpgp_text, which has no context: messages go to those who made the object.
#include "api/check_struct.h"
#include "api/standalone.h"
#include "vector/geometry/check_stroke.h"
#include "vector/text/closure.h"
#include "vector/text/layout.h"

#include <algorithm>
#include <cmath>

using namespace gpgp;
using namespace gpgp::text;
using namespace gpgp::api::standalone;
using api::checkStruct;

namespace {

/// A shaper behind its handle; layouts know it weakly.
struct ShaperHandle {
  static constexpr uint32_t kMagic = 0x73686170; // "shap"
  uint32_t magic = kMagic;
  std::shared_ptr<Shaper> shaper;
};

Receiver receiverOf(const Messages* messages) {
  if (!messages) return {};
  return {messages->function, messages->userData, messages->label.c_str()};
}

Font* toFont(GpgpFont handle) {
  Font* font = reinterpret_cast<Font*>(handle);
  return font && font->magic == Font::kMagic && !font->closed() ? font : nullptr;
}
ShaperHandle* toShaper(GpgpShaper handle) {
  auto* shaper = reinterpret_cast<ShaperHandle*>(handle);
  return shaper && shaper->magic == ShaperHandle::kMagic ? shaper : nullptr;
}
Layout* toLayout(GpgpLayout handle) {
  auto* layout = reinterpret_cast<Layout*>(handle);
  return layout && layout->magic == Layout::kMagic ? layout : nullptr;
}

/// As many as there is room for; *count becomes how many there are.
template <class T> Result<void> deliver(const std::vector<T>& found, uint32_t* count, T* to, const char* what) {
  const uint32_t room = *count;
  *count = static_cast<uint32_t>(found.size());
  if (!to) return {};
  std::copy_n(found.begin(), std::min<size_t>(room, found.size()), to);
  if (room < found.size()) return makeError(GPGP_INCOMPLETE, "%zu %s", found.size(), what);
  return {};
}

Result<void> checkColor(const float (&color)[4], const char* owner, const char* name) {
  for (int i = 0; i < 4; ++i)
    if (!(color[i] >= 0 && color[i] <= 1))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s%s[%d] is %g; expected 0 to 1", owner, name, i,
                       static_cast<double>(color[i]));
  return {};
}

/// `name`: "style", or "spans[3].style".
Result<void> checkStyle(const GpgpTextStyle& style, const char* name) {
  if (style.fontCount == 0 || !style.fonts) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s has no fonts", name);
  for (uint32_t i = 0; i < style.fontCount; ++i)
    if (!toFont(style.fonts[i]))
      return makeError(GPGP_ERROR_INVALID_HANDLE, "%s.fonts[%u] is NULL or destroyed; expected a font", name, i);
  if (!(style.size > 0 && style.size <= 1e5f))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.size is %g; expected above 0, at most 100000", name,
                     static_cast<double>(style.size));
  if (!(std::abs(style.letterSpacing) <= 1e5f))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.letterSpacing is %g; expected -100000 to 100000", name,
                     static_cast<double>(style.letterSpacing));
  if (!(style.outlineWidth >= 0 && style.outlineWidth <= 1e5f))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.outlineWidth is %g; expected 0 to 100000", name,
                     static_cast<double>(style.outlineWidth));
  if (auto ok = checkColor(style.color, name, ".color"); !ok) return ok;
  if (auto ok = checkColor(style.outlineColor, name, ".outlineColor"); !ok) return ok;
  if (style.featureCount && !style.features)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.featureCount is %u without features", name, style.featureCount);
  return {};
}

} // namespace

GpgpResult GPGP_CALL gpgpCreateFont(const GpgpFontCreateInfo* info, GpgpFont* font) {
  Receiver receiver;
  if (info && info->sType == GPGP_STRUCTURE_FONT_CREATE_INFO) {
    receiver.messageFn = info->messageFn;
    receiver.userData = info->messageUserData;
    receiver.label = info->label ? info->label : info->filePath ? info->filePath : "";
  }
  return guarded("gpgpCreateFont", receiver, [&]() -> Result<void> {
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_FONT_CREATE_INFO, "info"); !ok) return ok;
    if (!font) return invalid("font is NULL");
    if ((info->data != nullptr) + (info->filePath != nullptr) != 1)
      return invalid("exactly one of data and filePath must be given");
    if (info->axisCount && !info->axes) return invalid("axes is NULL, but axisCount is not 0");
    const auto made = Font::create(*info);
    if (!made) return made.error();
    *font = reinterpret_cast<GpgpFont>(*made);
    return {};
  });
}

void GPGP_CALL gpgpDestroyFont(GpgpFont handle) {
  Font* font = toFont(handle);
  if (!font) return;
  font->close();
  font->release();
}

GpgpResult GPGP_CALL gpgpGetFontInfo(GpgpFont handle, GpgpFontInfo* info) {
  const Font* font = toFont(handle);
  return guarded("gpgpGetFontInfo", receiverOf(font ? &font->messages : nullptr), [&]() -> Result<void> {
    if (!font) return notA("font", "a font");
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_FONT_INFO, "info"); !ok) return ok;
    *info = font->info();
    return {};
  });
}

GpgpResult GPGP_CALL gpgpGetNominalGlyph(GpgpFont handle, uint32_t character, uint32_t* glyph) {
  const Font* font = toFont(handle);
  return guarded("gpgpGetNominalGlyph", receiverOf(font ? &font->messages : nullptr), [&]() -> Result<void> {
    if (!font) return notA("font", "a font");
    if (!glyph) return invalid("glyph is NULL");
    hb_codepoint_t found = 0;
    *glyph = hb_font_get_nominal_glyph(font->shaping(), character, &found) ? found : 0;
    return {};
  });
}

GpgpResult GPGP_CALL gpgpGetGlyphOutline(GpgpFont handle, const GpgpGlyphOutlineInfo* info, GpgpGlyphFn glyphFn,
                                         void* userData) {
  Font* font = toFont(handle);
  return guarded("gpgpGetGlyphOutline", receiverOf(font ? &font->messages : nullptr), [&]() -> Result<void> {
    if (!font) return notA("font", "a font");
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_GLYPH_OUTLINE_INFO, "info"); !ok) return ok;
    if (!glyphFn) return invalid("glyphFn is NULL");
    if (info->colorCount && !info->colors) return invalid("colors is NULL, but colorCount is not 0");
    if (auto ok = checkColor(info->color, "", "color"); !ok) return ok;
    for (uint32_t i = 0; i < info->colorCount; ++i) {
      char name[32];
      std::snprintf(name, sizeof name, "colors[%u]", i);
      if (auto ok = checkColor(info->colors[i].color, name, ".color"); !ok) return ok;
    }
    if (info->stroke)
      if (auto ok = vector::checkStroke(*info->stroke); !ok) return ok;
    if (info->glyph >= font->info().glyphCount)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "glyph is %u; the font has %u", info->glyph,
                       font->info().glyphCount);
    return deliverGlyph(*font, *info, glyphFn, userData);
  });
}

GpgpResult GPGP_CALL gpgpGetGlyphClosure(GpgpFont handle, const GpgpCharacterRange* ranges, uint32_t rangeCount,
                                         uint32_t* count, uint32_t* glyphs) {
  const Font* font = toFont(handle);
  return guarded("gpgpGetGlyphClosure", receiverOf(font ? &font->messages : nullptr), [&]() -> Result<void> {
    if (!font) return notA("font", "a font");
    if (!count) return invalid("count is NULL");
    if (rangeCount && !ranges) return invalid("ranges is NULL, but rangeCount is not 0");
    for (uint32_t i = 0; i < rangeCount; ++i)
      if (ranges[i].first > ranges[i].last || ranges[i].last > 0x10ffff)
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "ranges[%u] is %x to %x; expected up to 10ffff, in this order", i,
                         ranges[i].first, ranges[i].last);
    std::vector<uint32_t> found;
    glyphClosure(*font, {ranges, rangeCount}, found);
    return deliver(found, count, glyphs, "glyphs");
  });
}

GpgpResult GPGP_CALL gpgpCreateShaper(const GpgpShaperCreateInfo* info, GpgpShaper* shaper) {
  Receiver receiver;
  if (info && info->sType == GPGP_STRUCTURE_SHAPER_CREATE_INFO) {
    receiver.messageFn = info->messageFn;
    receiver.userData = info->messageUserData;
    receiver.label = info->label ? info->label : "";
  }
  return guarded("gpgpCreateShaper", receiver, [&]() -> Result<void> {
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_SHAPER_CREATE_INFO, "info"); !ok) return ok;
    if (!shaper) return invalid("shaper is NULL");
    auto made = Shaper::create(*info);
    if (!made) return made.error();
    auto behind = std::make_unique<ShaperHandle>();
    behind->shaper = std::move(*made);
    *shaper = reinterpret_cast<GpgpShaper>(behind.release());
    return {};
  });
}

void GPGP_CALL gpgpDestroyShaper(GpgpShaper handle) {
  ShaperHandle* shaper = toShaper(handle);
  if (!shaper) return;
  shaper->magic = 0;
  delete shaper;
}

GpgpResult GPGP_CALL gpgpGetShaperReport(GpgpShaper handle, GpgpShaperReport* report) {
  const ShaperHandle* shaper = toShaper(handle);
  return guarded("gpgpGetShaperReport", receiverOf(shaper ? &shaper->shaper->messages : nullptr),
                 [&]() -> Result<void> {
                   if (!shaper) return notA("shaper", "a shaper");
                   if (auto ok = checkStruct(report, GPGP_STRUCTURE_SHAPER_REPORT, "report"); !ok) return ok;
                   shaper->shaper->report(*report);
                   return {};
                 });
}

GpgpResult GPGP_CALL gpgpCreateLayout(GpgpShaper handle, GpgpLayout* layout) {
  const ShaperHandle* shaper = toShaper(handle);
  return guarded("gpgpCreateLayout", receiverOf(shaper ? &shaper->shaper->messages : nullptr), [&]() -> Result<void> {
    if (!shaper) return notA("shaper", "a shaper");
    if (!layout) return invalid("layout is NULL");
    *layout = reinterpret_cast<GpgpLayout>(new Layout(shaper->shaper, shaper->shaper->messages));
    return {};
  });
}

void GPGP_CALL gpgpDestroyLayout(GpgpLayout handle) {
  Layout* layout = toLayout(handle);
  if (!layout) return;
  layout->magic = 0;
  delete layout;
}

GpgpResult GPGP_CALL gpgpSetLayoutText(GpgpLayout handle, const GpgpTextInfo* info) {
  Layout* layout = toLayout(handle);
  return guarded("gpgpSetLayoutText", receiverOf(layout ? &layout->messages : nullptr), [&]() -> Result<void> {
    if (!layout) return notA("layout", "a layout");
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_TEXT_INFO, "info"); !ok) return ok;
    if (info->size && !info->text) return invalid("text is NULL, but size is not 0");
    if (info->size >= size_t(1) << 31)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "size is %zu; expected below 2^31", info->size);
    if (info->spanCount && !info->spans) return invalid("spans is NULL, but spanCount is not 0");
    if (info->direction < GPGP_TEXT_AUTO || info->direction > GPGP_TEXT_RIGHT_TO_LEFT)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "direction is %d, which is not a GpgpTextDirection",
                       info->direction);
    if (info->align < GPGP_TEXT_ALIGN_START || info->align > GPGP_TEXT_ALIGN_JUSTIFY)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "align is %d, which is not a GpgpTextAlign", info->align);
    const struct {
      const char* name;
      float value;
    } lengths[] = {{"width", info->width},
                   {"height", info->height},
                   {"lineSpacing", info->lineSpacing},
                   {"lineHeight", info->lineHeight},
                   {"tabWidth", info->tabWidth}};
    for (const auto& [name, value] : lengths)
      if (!(value >= 0 && value <= 1e9f))
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s is %g; expected 0 to 1e9", name, static_cast<double>(value));
    if (auto ok = checkStyle(info->style, "style"); !ok) return ok;
    for (uint32_t i = 0; i < info->spanCount; ++i) {
      char name[32];
      const GpgpTextSpan& span = info->spans[i];
      if (span.begin > span.end || span.end > info->size)
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "spans[%u] is bytes %u to %u of %zu", i, span.begin, span.end,
                         info->size);
      std::snprintf(name, sizeof name, "spans[%u].style", i);
      if (auto ok = checkStyle(span.style, name); !ok) return ok;
    }
    return layout->set(*info);
  });
}

GpgpResult GPGP_CALL gpgpGetLayoutInfo(GpgpLayout handle, GpgpLayoutInfo* info) {
  const Layout* layout = toLayout(handle);
  return guarded("gpgpGetLayoutInfo", receiverOf(layout ? &layout->messages : nullptr), [&]() -> Result<void> {
    if (!layout) return notA("layout", "a layout");
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_LAYOUT_INFO, "info"); !ok) return ok;
    layout->info(*info);
    return {};
  });
}

GpgpResult GPGP_CALL gpgpGetSelection(GpgpLayout handle, uint32_t begin, uint32_t end, uint32_t* count,
                                      GpgpTextRect* rects) {
  const Layout* layout = toLayout(handle);
  return guarded("gpgpGetSelection", receiverOf(layout ? &layout->messages : nullptr), [&]() -> Result<void> {
    if (!layout) return notA("layout", "a layout");
    if (!count) return invalid("count is NULL");
    std::vector<GpgpTextRect> found;
    layout->selection(begin, end, found);
    return deliver(found, count, rects, "rectangles");
  });
}

GpgpResult GPGP_CALL gpgpGetCaret(GpgpLayout handle, uint32_t offset, VkBool32 trailing, GpgpCaret* caret) {
  const Layout* layout = toLayout(handle);
  return guarded("gpgpGetCaret", receiverOf(layout ? &layout->messages : nullptr), [&]() -> Result<void> {
    if (!layout) return notA("layout", "a layout");
    if (!caret) return invalid("caret is NULL");
    *caret = layout->caret(offset, trailing != 0);
    return {};
  });
}

GpgpResult GPGP_CALL gpgpHitTestLayout(GpgpLayout handle, float x, float y, GpgpTextHit* hit) {
  const Layout* layout = toLayout(handle);
  return guarded("gpgpHitTestLayout", receiverOf(layout ? &layout->messages : nullptr), [&]() -> Result<void> {
    if (!layout) return notA("layout", "a layout");
    if (!hit) return invalid("hit is NULL");
    if (!std::isfinite(x) || !std::isfinite(y)) return invalid("x or y is not finite");
    *hit = layout->hit(x, y);
    return {};
  });
}

GpgpResult GPGP_CALL gpgpMoveCaret(GpgpLayout handle, uint32_t offset, GpgpCaretMove move, uint32_t* moved,
                                   VkBool32* trailing) {
  Layout* layout = toLayout(handle);
  return guarded("gpgpMoveCaret", receiverOf(layout ? &layout->messages : nullptr), [&]() -> Result<void> {
    if (!layout) return notA("layout", "a layout");
    if (!moved) return invalid("moved is NULL");
    const auto at = layout->move(offset, trailing && *trailing, move);
    if (!at) return at.error();
    *moved = at->offset;
    if (trailing) *trailing = at->trailing;
    return {};
  });
}
