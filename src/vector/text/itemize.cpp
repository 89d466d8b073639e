// Scripts, fonts and runs. Characters of no script of their own take the script before them, closing brackets that of
// their opening ones (UAX #24, section 5.1 and 5.2).
#include "vector/text/itemize.h"

#include <algorithm>

#include <unicode/uchar.h>
#include <unicode/unorm2.h>

namespace gpgp::text {

bool isIgnorable(char32_t c) {
  return u_hasBinaryProperty(static_cast<UChar32>(c), UCHAR_DEFAULT_IGNORABLE_CODE_POINT) != 0;
}
bool isWhite(char32_t c) {
  return c == ' ' || c == '\t' || isNewline(c) ||
         (c >= 0x1680 && c != 0x202f && u_isUWhiteSpace(static_cast<UChar32>(c)) != 0);
}
bool isCursive(hb_script_t script) {
  switch (script) {
  case HB_SCRIPT_ARABIC:
  case HB_SCRIPT_SYRIAC:
  case HB_SCRIPT_NKO:
  case HB_SCRIPT_MONGOLIAN:
  case HB_SCRIPT_MANDAIC:
  case HB_SCRIPT_PHAGS_PA:
  case HB_SCRIPT_ADLAM:
  case HB_SCRIPT_MANICHAEAN:
  case HB_SCRIPT_PSALTER_PAHLAVI:
  case HB_SCRIPT_HANIFI_ROHINGYA:
  case HB_SCRIPT_SOGDIAN: return true;
  default: return false;
  }
}

namespace {

hb_script_t toHarfBuzz(UScriptCode script) {
  const char* name = uscript_getShortName(script);
  return name ? hb_script_from_string(name, 4) : HB_SCRIPT_COMMON;
}

/// A script for each character of a paragraph.
void resolveScripts(std::span<const char32_t> text, std::vector<UScriptCode>& scripts) {
  struct Bracket {
    UChar32 closing;
    UScriptCode script;
  };
  Bracket open[32]; // deeper ones take the script before them
  size_t depth = 0, unresolved = 0;
  UScriptCode last = USCRIPT_COMMON;
  scripts.resize(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<UChar32>(text[i]);
    UErrorCode error = U_ZERO_ERROR;
    UScriptCode script = uscript_getScript(c, &error);
    if (U_FAILURE(error) || script == USCRIPT_COMMON || script == USCRIPT_INHERITED || script == USCRIPT_UNKNOWN) {
      script = last;
      const int bracket = c < 0x28 ? U_BPT_NONE : u_getIntPropertyValue(c, UCHAR_BIDI_PAIRED_BRACKET_TYPE);
      if (bracket == U_BPT_OPEN && depth < std::size(open)) {
        open[depth++] = {u_getBidiPairedBracket(c), last};
      } else if (bracket == U_BPT_CLOSE) {
        size_t match = depth;
        while (match > 0 && open[match - 1].closing != c) --match;
        if (match > 0) {
          depth = match - 1;
          if (open[depth].script != USCRIPT_COMMON) script = open[depth].script;
        }
      }
    } else if (last == USCRIPT_COMMON) {
      std::fill(scripts.begin() + static_cast<std::ptrdiff_t>(unresolved),
                scripts.begin() + static_cast<std::ptrdiff_t>(i), script);
      for (size_t b = 0; b < depth; ++b) open[b].script = script;
    }
    if (last == USCRIPT_COMMON && script != USCRIPT_COMMON) unresolved = i;
    scripts[i] = script;
    last = script;
  }
}

bool hasAll(const Font& font, std::span<const char32_t> characters) {
  return std::all_of(characters.begin(), characters.end(), [&](char32_t c) { return font.has(c) || isIgnorable(c); });
}

/// As HarfBuzz can put characters together and take them apart: in another normal form.
bool hasOtherForm(const Font& font, std::span<const char32_t> characters) {
  char16_t text[64], other[128];
  int32_t size = 0;
  for (const char32_t c : characters) {
    if (size + 2 > static_cast<int32_t>(std::size(text))) return false;
    if (c > 0xffff) text[size++] = static_cast<char16_t>(0xd7c0 + (c >> 10));
    text[size++] = static_cast<char16_t>(c > 0xffff ? 0xdc00 + (c & 0x3ff) : c);
  }
  UErrorCode error = U_ZERO_ERROR;
  for (const UNormalizer2* form : {unorm2_getNFCInstance(&error), unorm2_getNFDInstance(&error)}) {
    if (U_FAILURE(error)) return false;
    const int32_t count = unorm2_normalize(form, text, size, other, static_cast<int32_t>(std::size(other)), &error);
    if (U_FAILURE(error)) return false;
    bool all = true;
    for (int32_t i = 0; i < count && all;) {
      char32_t c = other[i++];
      if (c >= 0xd800 && c < 0xdc00 && i < count) c = ((c - 0xd7c0) << 10) + (other[i++] & 0x3ffu);
      all = font.has(c) || isIgnorable(c);
    }
    if (all) return true;
  }
  return false;
}

/// To be shown as text: by U+FE0E.
bool wantsNoColor(std::span<const char32_t> grapheme) {
  return std::find(grapheme.begin(), grapheme.end(), U'\ufe0e') != grapheme.end();
}

/// To be shown as an emoji (UTS #51): by itself, by U+FE0F, and a digit, # or * by the mark of a keycap behind that
/// only.
bool wantsColor(std::span<const char32_t> grapheme) {
  if (grapheme.size() == 1 && grapheme[0] < 0x2000) return false;
  const auto is = [&](UProperty property) {
    return u_hasBinaryProperty(static_cast<UChar32>(grapheme[0]), property) != 0;
  };
  const auto has = [&](char32_t c) { return std::find(grapheme.begin(), grapheme.end(), c) != grapheme.end(); };
  if (wantsNoColor(grapheme)) return false;
  if (is(UCHAR_EMOJI_PRESENTATION)) return true;
  return has(0xfe0f) && is(UCHAR_EMOJI) && (grapheme[0] >= 0x80 || has(0x20e3));
}

/// White space, also where no line may break.
bool isSpace(char32_t c) { return isWhite(c) || c == 0xa0 || c == 0x202f; }

/// Spaces, and of what may be an emoji: to be shown as text, by its own default or by U+FE0E (UTS #51).
bool wantsText(std::span<const char32_t> grapheme) {
  return isSpace(grapheme[0]) ||
         (!wantsColor(grapheme) && u_hasBinaryProperty(static_cast<UChar32>(grapheme[0]), UCHAR_EMOJI) != 0);
}

/// An emoji, as text too; digits, # and * are not.
bool isEmoji(std::span<const char32_t> grapheme) {
  return wantsColor(grapheme) ||
         (grapheme[0] >= 0x80 && u_hasBinaryProperty(static_cast<UChar32>(grapheme[0]), UCHAR_EMOJI) != 0);
}

bool isColored(const Font& font) { return (font.info().colors & ~uint32_t(GPGP_FONT_COLOR_SVG)) != 0; }

bool sameShaping(const Style& a, const Style& b) {
  if (&a == &b) return true;
  const GpgpTextStyle &x = *a.source, &y = *b.source;
  return x.size == y.size && a.language == b.language && (x.letterSpacing != 0) == (y.letterSpacing != 0) &&
         x.featureCount == y.featureCount &&
         std::equal(x.features, x.features + x.featureCount, y.features,
                    [](auto& f, auto& g) { return f.tag == g.tag && f.value == g.value; });
}

} // namespace

namespace {

// A letter with thousands of marks is shaped in parts: HarfBuzz takes time by the square of their number.
constexpr uint32_t kMostTogether = 256;

bool hasForm(const Font& font, std::span<const char32_t> characters) {
  return hasAll(font, characters) ||
         ((characters.size() > 1 || characters[0] >= 0x80) && hasOtherForm(font, characters));
}

/// How many of the first characters a font has.
size_t hasFirst(const Font& font, std::span<const char32_t> characters) {
  if (hasForm(font, characters)) return characters.size();
  size_t count = 0;
  while (count < characters.size() && (font.has(characters[count]) || (count && isIgnorable(characters[count]))))
    ++count;
  constexpr size_t kMostComposed = 4; // marks that the font has only with what they stand on
  for (size_t more = std::min(characters.size() - 1, count + kMostComposed); more > count; --more)
    if (hasForm(font, characters.first(more))) return more;
  return count;
}

} // namespace

Font* Itemizer::fontOf(std::span<const char32_t> grapheme, const Style& style) {
  const uint32_t count = style.source->fontCount;
  const bool inColor = wantsColor(grapheme);
  if (inColor || wantsNoColor(grapheme))
    for (uint32_t i = 0; i < count; ++i)
      if (isColored(*style.font(i)) == inColor && hasAll(*style.font(i), grapheme)) return style.font(i);
  const bool asText = wantsText(grapheme);
  for (const bool emojiToo : {false, true})
    for (uint32_t i = 0; i < count; ++i)
      if ((emojiToo || !asText || !style.font(i)->isEmojiFont()) && hasForm(*style.font(i), grapheme))
        return style.font(i);
  Font* best = style.font(0);
  size_t most = 0;
  for (const bool emojiToo : {false, true})
    for (uint32_t i = 0; i < count; ++i) {
      if (!emojiToo && asText && style.font(i)->isEmojiFont()) continue;
      const size_t has = hasFirst(*style.font(i), grapheme);
      if (has <= most) continue;
      most = has;
      best = style.font(i);
    }
  return best;
}

size_t Itemizer::lengthIn(const Font& font, std::span<const char32_t> grapheme, const Style& style) {
  size_t length = std::max(hasFirst(font, grapheme), size_t(1));
  const auto somewhere = [&](char32_t c) {
    for (uint32_t i = 0; i < style.source->fontCount; ++i)
      if (style.font(i)->has(c)) return true;
    return false;
  };
  while (length < grapheme.size() && (isIgnorable(grapheme[length]) || !somewhere(grapheme[length]))) ++length;
  return length;
}

Font* Itemizer::fontBehind(uint32_t at, uint32_t end, uint32_t& behind) const {
  const auto ends = [&](uint32_t i) {
    return i == end || isNewline(text.characters[i]) || text.characters[i] == '\t' || styleOf[i] != styleOf[at];
  };
  behind = std::max(behind, at);
  while (!ends(behind) && (isSpace(text.characters[behind]) || isIgnorable(text.characters[behind]))) ++behind;
  if (ends(behind)) return nullptr;
  uint32_t next = behind + 1;
  while (next < end && !(flags[next] & kGrapheme) && next - behind < kMostTogether) ++next;
  const auto grapheme = std::span(text.characters).subspan(behind, next - behind);
  Font* font = fontOf(grapheme, styles[styleOf[at]]);
  return isColored(*font) && isEmoji(grapheme) ? nullptr : font;
}

void Itemizer::paragraph(uint32_t begin, uint32_t end, std::vector<Run>& runs) const {
  resolveScripts(std::span(text.characters).subspan(begin, end - begin), scripts);
  const size_t first = runs.size();
  UScriptCode lastScript = USCRIPT_COMMON;
  bool lent = false; // the last run's font is no text's: taken for an emoji, or for a space that the text's font lacks
  uint32_t behind = begin; // the spaces
  for (uint32_t at = begin, next = 0; at < end; at = next) {
    next = at + 1;
    while (next < end && !(flags[next] & kGrapheme) && next - at < kMostTogether) ++next;
    const bool whole = at == begin || (flags[at] & kGrapheme);
    const char32_t c = text.characters[at];
    const uint32_t style = styleOf[at];
    Run run{at, next, Run::Kind::text, levels[at], HB_SCRIPT_COMMON, nullptr, style};
    run.kind = isNewline(c) ? Run::Kind::newline : c == '\t' ? Run::Kind::tab : Run::Kind::text;
    Run* last = runs.size() > first ? &runs.back() : nullptr;
    if (run.kind == Run::Kind::text) {
      const auto grapheme = std::span(text.characters).subspan(at, next - at);
      const bool stays = last && last->kind == Run::Kind::text && (isIgnorable(c) || (isSpace(c) && !lent)) &&
                         styleOf[at - 1] == style && hasAll(*last->font, grapheme);
      // Spaces before a text, or between an emoji and a text, are that text's.
      Font* const ofText = !stays && isSpace(c) ? fontBehind(at, end, behind) : nullptr;
      run.font = stays ? last->font : ofText && hasAll(*ofText, grapheme) ? ofText : fontOf(grapheme, styles[style]);
      if (!stays) {
        next = run.end = at + static_cast<uint32_t>(lengthIn(*run.font, grapheme, styles[style]));
        run.parted = !whole && last && last->font != run.font;
      }
      if (!stays) lent = (isColored(*run.font) && isEmoji(grapheme)) || (ofText && run.font != ofText);
      const UScriptCode script = scripts[at - begin];
      if (whole && last && last->kind == Run::Kind::text && last->level == run.level && last->font == run.font &&
          lastScript == script && sameShaping(styles[last->style], styles[style])) {
        last->end = next;
        continue;
      }
      run.script = toHarfBuzz(script);
      lastScript = script;
    } else {
      run.font = styles[style].font(0);
    }
    runs.push_back(run);
  }
}

} // namespace gpgp::text
