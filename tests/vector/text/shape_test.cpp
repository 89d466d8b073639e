// Shaping against HarfBuzz used directly, the order of mixed directions against FriBidi, the choice of fonts, the
// cache.
#include "fonts.h"

#include <algorithm>
#include <cstdlib>
#include <random>
#include <set>

#include <fribidi.h>
#include <hb.h>

using namespace gpgp::test;

// Counts what anything in the process allocates, the libraries behind the layout too.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
#define GPGP_COUNTS_MALLOC 1
static size_t allocations = 0, allocatedBytes = 0;
extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* memory, size_t size);
void* malloc(size_t size) {
  ++allocations, allocatedBytes += size;
  return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
  ++allocations, allocatedBytes += count * size;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, size_t size) {
  ++allocations, allocatedBytes += size;
  return __libc_realloc(memory, size);
}
}
#endif

namespace {

struct Placed {
  uint32_t glyph, cluster;
  float x, y;
};

/// A text as one buffer, at a size in pixels.
std::vector<Placed> shapeDirectly(const Sample& sample, float size, const std::vector<hb_feature_t>& features = {},
                                  float* width = nullptr) {
  hb_blob_t* blob = hb_blob_create_from_file(fontPath(sample.font).c_str());
  hb_face_t* face = hb_face_create(blob, sample.face);
  hb_font_t* font = hb_font_create(face);
  const int scale = static_cast<int>(hb_face_get_upem(face)) * 64;
  hb_font_set_scale(font, scale, scale);
  hb_buffer_t* buffer = hb_buffer_create();
  hb_buffer_add_utf8(buffer, sample.text, -1, 0, -1);
  hb_buffer_guess_segment_properties(buffer);
  hb_buffer_set_language(buffer, hb_language_from_string(sample.language, -1));
  hb_shape(font, buffer, features.data(), static_cast<unsigned>(features.size()));
  unsigned count = 0;
  const hb_glyph_info_t* infos = hb_buffer_get_glyph_infos(buffer, &count);
  const hb_glyph_position_t* places = hb_buffer_get_glyph_positions(buffer, &count);
  std::vector<Placed> placed;
  double pen = 0;
  const double em = static_cast<double>(size) / scale;
  for (unsigned i = 0; i < count; ++i) {
    placed.push_back({infos[i].codepoint, infos[i].cluster, static_cast<float>((pen + places[i].x_offset) * em),
                      static_cast<float>(-places[i].y_offset * em)});
    pen += places[i].x_advance;
  }
  if (width) *width = static_cast<float>(pen * em);
  hb_buffer_destroy(buffer);
  hb_font_destroy(font);
  hb_face_destroy(face);
  hb_blob_destroy(blob);
  return placed;
}

void expectSame(const Paper& paper, const std::vector<Placed>& expected) {
  ASSERT_EQ(paper.info.glyphCount, expected.size());
  const float baseline = paper.info.lines[0].baseline;
  for (size_t i = 0; i < expected.size(); ++i) {
    const GpgpTextGlyph& glyph = paper.info.glyphs[i];
    ASSERT_EQ(glyph.glyph, expected[i].glyph) << "glyph " << i;
    EXPECT_EQ(glyph.cluster, expected[i].cluster) << "glyph " << i;
    EXPECT_NEAR(glyph.x, expected[i].x, 0.002f) << "glyph " << i;
    EXPECT_NEAR(glyph.y - baseline, expected[i].y, 0.002f) << "glyph " << i;
  }
}

std::string utf8(std::u32string_view text) {
  std::string bytes;
  for (const char32_t c : text) {
    if (c < 0x80) {
      bytes += static_cast<char>(c);
    } else if (c < 0x800) {
      bytes += static_cast<char>(0xc0 | c >> 6);
      bytes += static_cast<char>(0x80 | (c & 63));
    } else {
      bytes += static_cast<char>(0xe0 | c >> 12);
      bytes += static_cast<char>(0x80 | (c >> 6 & 63));
      bytes += static_cast<char>(0x80 | (c & 63));
    }
  }
  return bytes;
}

} // namespace

TEST(TextShape, IsHarfBuzzsInEveryScript) {
  GPGP_NEEDS_FONTS();
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    const FontHandle font = openFont(sample.font, sample.face);
    const std::vector<GpgpFont> fonts = {font.get()};
    const std::string text = sample.text;
    Paper paper;
    for (const float size : {9.f, 16.f, 37.5f}) {
      GpgpTextInfo info = textInfo(text, fonts, size);
      info.style.language = sample.language;
      ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
      float width = 0;
      const auto expected = shapeDirectly(sample, size, {}, &width);
      expectSame(paper, expected);
      EXPECT_NEAR(paper.info.width, width, 0.01f);
      const auto lost = std::count_if(expected.begin(), expected.end(), [](auto& glyph) { return glyph.glyph == 0; });
      EXPECT_EQ(paper.info.missingCount, static_cast<uint32_t>(lost)); // the Hebrew font has no comma and no full stop
      EXPECT_EQ(lost, sample.name == std::string("Hebrew") ? 2 : 0);
      EXPECT_EQ(paper.info.lineCount, 1u);
    }
  }
}

TEST(TextShape, FeaturesAndLetterSpacing) {
  GPGP_NEEDS_FONTS();
  const Sample& latin = samples()[0];
  const FontHandle font = openFont(latin.font);
  const std::vector<GpgpFont> fonts = {font.get()};
  const std::string text = latin.text;
  Paper paper;
  GpgpTextInfo info = textInfo(text, fonts, 20);
  info.style.language = "en";
  ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
  const uint32_t joined = paper.info.glyphCount;
  EXPECT_LT(joined, text.size()); // ligatures
  const GpgpFontFeature off[] = {{GPGP_TAG('l', 'i', 'g', 'a'), 0}, {GPGP_TAG('k', 'e', 'r', 'n'), 0}};
  info.style.features = off;
  info.style.featureCount = 2;
  ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
  EXPECT_EQ(paper.info.glyphCount, text.size());
  const hb_feature_t same[] = {{HB_TAG('l', 'i', 'g', 'a'), 0, 0, ~0u}, {HB_TAG('k', 'e', 'r', 'n'), 0, 0, ~0u}};
  expectSame(paper, shapeDirectly(latin, 20, {same[0], same[1]}));
  const float narrow = paper.info.width;
  info.style.features = off + 1; // kerning off; ligatures are off because of the spacing
  info.style.featureCount = 1;
  info.style.letterSpacing = 1.5f;
  ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
  EXPECT_EQ(paper.info.glyphCount, text.size());
  EXPECT_NEAR(paper.info.width, narrow + 1.5f * float(text.size()), 0.02f);
  for (uint32_t i = 0; i + 1 < paper.info.glyphCount; ++i)
    EXPECT_LT(paper.info.glyphs[i].x, paper.info.glyphs[i + 1].x);

  // Scripts that join are not spaced; others from right to left are, to the left of each.
  const Sample &arabic = samples()[1], &hebrew = samples()[2];
  for (const Sample* sample : {&arabic, &hebrew}) {
    const FontHandle other = openFont(sample->font);
    const std::vector<GpgpFont> chain = {other.get()};
    const std::string words = sample->text;
    GpgpTextInfo plain = textInfo(words, chain, 20);
    ASSERT_EQ(paper.set(plain), GPGP_SUCCESS);
    const float width = paper.info.width, first = paper.info.glyphs[paper.info.glyphCount - 1].x;
    plain.style.letterSpacing = 2;
    ASSERT_EQ(paper.set(plain), GPGP_SUCCESS);
    if (sample == &arabic)
      EXPECT_NEAR(paper.info.width, width, 0.01f);
    else {
      EXPECT_GT(paper.info.width, width + 60);
      EXPECT_NEAR(paper.info.glyphs[paper.info.glyphCount - 1].x, first + paper.info.width - width, 0.01f);
    }
  }
}

TEST(TextShape, OrderIsFriBidis) {
  GPGP_NEEDS_FONTS();
  const FontHandle latin = openFont("NotoSans-Regular.ttf"), hebrew = openFont("NotoSansHebrew-Regular.ttf");
  const std::vector<GpgpFont> fonts = {latin.get(), hebrew.get()};
  // One glyph a character, no pairs that would be moved or mirrored into another order.
  const std::u32string letters = U"abcxyzאבגדהו0123456789  .,-+()[]/%:!";
  std::mt19937 random(7);
  Paper paper;
  for (int run = 0; run < 400; ++run) {
    std::u32string text;
    const size_t length = 1 + random() % 30;
    for (size_t i = 0; i < length; ++i) {
      text += letters[random() % letters.size()];
      if (random() % 12 == 0) text += U"\u202b\u202a\u202c\u2067\u2066\u2069"[random() % 6];
    }
    const std::string bytes = utf8(text);
    for (const GpgpTextDirection direction : {GPGP_TEXT_AUTO, GPGP_TEXT_LEFT_TO_RIGHT, GPGP_TEXT_RIGHT_TO_LEFT}) {
      GpgpTextInfo info = textInfo(bytes, fonts, 10);
      info.direction = direction;
      ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
      FriBidiParType base = direction == GPGP_TEXT_AUTO            ? FRIBIDI_PAR_ON
                            : direction == GPGP_TEXT_LEFT_TO_RIGHT ? FRIBIDI_PAR_LTR
                                                                   : FRIBIDI_PAR_RTL;
      std::vector<FriBidiStrIndex> logical(text.size());
      ASSERT_TRUE(fribidi_log2vis(reinterpret_cast<const FriBidiChar*>(text.data()), int(text.size()), &base, nullptr,
                                  nullptr, logical.data(), nullptr));
      EXPECT_EQ(paper.info.lines[0].rightToLeft != 0, FRIBIDI_IS_RTL(base) != 0);
      std::vector<uint32_t> expected, order, offsets;
      for (uint32_t i = 0, at = 0; i < text.size(); at += text[i] < 0x80 ? 1 : text[i] < 0x800 ? 2 : 3, ++i)
        offsets.push_back(at);
      const auto shown = [&](uint32_t c) { return text[c] < 0x2000; }; // not the marks of direction
      for (const FriBidiStrIndex i : logical)
        if (shown(uint32_t(i))) expected.push_back(offsets[size_t(i)]);
      for (uint32_t i = 0; i < paper.info.glyphCount; ++i) {
        const uint32_t cluster = paper.info.glyphs[i].cluster;
        const size_t c = size_t(std::find(offsets.begin(), offsets.end(), cluster) - offsets.begin());
        ASSERT_LT(c, offsets.size());
        if (shown(uint32_t(c))) order.push_back(cluster);
      }
      // Spaces at the end lie at the paragraph's level side by side; which is which cannot be seen.
      ASSERT_EQ(order.size(), expected.size());
      for (size_t i = 0; i < order.size(); ++i) {
        const bool blank = bytes[order[i]] == ' ' && bytes[expected[i]] == ' ';
        ASSERT_TRUE(blank || order[i] == expected[i]) << bytes << " at " << i << ", direction " << direction;
      }
    }
  }
}

TEST(TextShape, EachGraphemeTakesTheFirstFontThatHasIt) {
  GPGP_NEEDS_FONTS();
  const FontHandle latin = openFont("NotoSans-Regular.ttf"), hebrew = openFont("NotoSansHebrew-Regular.ttf"),
                   dejavu = openFont("DejaVuSans.ttf"), emoji = openFont("NotoColorEmoji.ttf");
  const std::vector<GpgpFont> fonts = {latin.get(), hebrew.get(), dejavu.get(), emoji.get()};
  // Latin, Hebrew, an arrow that DejaVu has, a heart as text and as emoji, a face, a family, and what none has.
  const std::string text = "aא→♥♥️😀👨‍👩‍👧e\u0301\U00012345";
  Paper paper;
  ASSERT_EQ(paper.set(textInfo(text, fonts, 10)), GPGP_SUCCESS);
  const auto fontAt = [&](size_t offset) -> GpgpFont {
    for (uint32_t i = 0; i < paper.info.glyphCount; ++i)
      if (paper.info.glyphs[i].cluster == offset) return paper.info.glyphs[i].font;
    return nullptr;
  };
  size_t at = 0;
  EXPECT_EQ(fontAt(at), latin.get());
  EXPECT_EQ(fontAt(at += 1), hebrew.get());
  EXPECT_EQ(fontAt(at += 2), dejavu.get());
  EXPECT_EQ(fontAt(at += 3), dejavu.get());
  EXPECT_EQ(fontAt(at += 3), emoji.get());
  EXPECT_EQ(fontAt(at += 6), emoji.get());
  EXPECT_EQ(fontAt(at += 4), emoji.get());
  EXPECT_EQ(fontAt(at += std::string("👨‍👩‍👧").size()), latin.get());
  ASSERT_EQ(paper.info.missingCount, 1u);
  EXPECT_EQ(paper.info.missing[0].character, 0x12345u);
  EXPECT_EQ(paper.info.missing[0].offset, text.size() - 4);
  EXPECT_EQ(paper.info.glyphs[paper.info.glyphCount - 1].glyph, 0u);
  // The family is one glyph.
  uint32_t family = 0;
  for (uint32_t i = 0; i < paper.info.glyphCount; ++i) family += paper.info.glyphs[i].cluster == at - 18;
  EXPECT_EQ(family, 1u);

  // A character that the first font has only put together, and one that it has only taken apart.
  const std::string forms = "e\u0301 \u1eaf";
  const std::vector<GpgpFont> one = {latin.get()};
  ASSERT_EQ(paper.set(textInfo(forms, one, 10)), GPGP_SUCCESS);
  EXPECT_EQ(paper.info.missingCount, 0u);
}

TEST(TextShape, MarksThatOnlyALaterFontHasAreThere) {
  GPGP_NEEDS_FONTS();
  const FontHandle latin = openFont("DejaVuSansMono.ttf"), thai = openFont("NotoSansThai-Regular.ttf"),
                   devanagari = openFont("NotoSansDevanagari-Regular.ttf");
  const std::vector<GpgpFont> fonts = {latin.get(), thai.get(), devanagari.get()};
  struct Shaped {
    GpgpFont font;
    uint32_t cluster;
    bool operator==(const Shaped&) const = default;
  };
  Paper paper;
  const auto shaped = [&](const std::string& text, const std::vector<GpgpFont>& chain) {
    EXPECT_EQ(paper.set(textInfo(text, chain, 20)), GPGP_SUCCESS);
    std::vector<Shaped> glyphs;
    for (uint32_t i = 0; i < paper.info.glyphCount; ++i)
      glyphs.push_back({paper.info.glyphs[i].font, paper.info.glyphs[i].cluster});
    return glyphs;
  };
  const auto isWhole = [&] {
    for (uint32_t i = 0; i < paper.info.glyphCount; ++i)
      if (paper.info.glyphs[i].glyph == 0) return false;
    return paper.info.missingCount == 0;
  };
  // No font has both: the letter out of the first that has it, the mark out of the first that has that.
  EXPECT_EQ(shaped("Ж\u0e39\u0e49", fonts), (std::vector<Shaped>{{latin.get(), 0}, {thai.get(), 2}, {thai.get(), 2}}));
  EXPECT_TRUE(isWhole());
  EXPECT_EQ(shaped("Ж\u0e49", fonts), (std::vector<Shaped>{{latin.get(), 0}, {thai.get(), 2}}));
  EXPECT_TRUE(isWhole());
  EXPECT_EQ(paper.caret(2).x, paper.caret(0).x); // one grapheme, whatever its fonts
  // No circle of dots for what stands on another font's letter.
  EXPECT_EQ(shaped("Ж\u0941", fonts), (std::vector<Shaped>{{latin.get(), 0}, {devanagari.get(), 2}}));
  EXPECT_TRUE(isWhole());
  // A later font has all of it: that one alone.
  const auto inOne = shaped("ก\u0e49", fonts);
  for (const Shaped& glyph : inOne) EXPECT_EQ(glyph.font, thai.get());
  EXPECT_TRUE(isWhole());
  // What no font has stays with what is before it, and is reported.
  const auto none = shaped("Ж\u0e49\U0001e8d0Ж", fonts);
  EXPECT_EQ(none.front().font, latin.get());
  EXPECT_EQ(paper.info.missingCount, 1u);
}

/// No grapheme of random letters and marks has a missing glyph where fonts of the chain have its characters.
TEST(TextShape, RandomGraphemesLackNothingThatAFontHas) {
  GPGP_NEEDS_FONTS();
  const FontHandle held[] = {openFont("DejaVuSans.ttf"),
                             openFont("NotoSansThai-Regular.ttf"),
                             openFont("NotoSansDevanagari-Regular.ttf"),
                             openFont("NotoSansHebrew-Regular.ttf"),
                             openFont("NotoNaskhArabic-Regular.ttf"),
                             openFont("NotoColorEmoji.ttf")};
  const char* letters[] = {"x", "Ж", "ก", "क", "א", "ب", "5", "©", "☂"};
  const char* marks[] = {"\u0e49", "\u0e39", "\u0941", "\u0301", "\u05b8", "\u064e", "\u093c", "\u0331", "\ufe0e"};
  std::mt19937 random(3);
  Paper paper;
  for (int round = 0; round < 3000; ++round) {
    std::vector<GpgpFont> chain;
    for (const FontHandle& font : held) chain.push_back(font.get());
    std::shuffle(chain.begin(), chain.end(), random);
    std::string text = letters[random() % std::size(letters)];
    for (uint32_t i = random() % 4; i > 0; --i) text += marks[random() % std::size(marks)];
    ASSERT_EQ(paper.set(textInfo(text, chain, 20)), GPGP_SUCCESS);
    EXPECT_EQ(paper.info.missingCount, 0u) << text;
    for (uint32_t i = 0; i < paper.info.glyphCount; ++i) EXPECT_NE(paper.info.glyphs[i].glyph, 0u) << text;
  }
}

TEST(TextShape, TextTakesNothingFromFontsOfEmojiThatOthersHave) {
  GPGP_NEEDS_FONTS();
  const FontHandle dejavu = openFont("DejaVuSans.ttf"), emoji = openFont("NotoColorEmoji.ttf"),
                   amiri = openFont("AmiriQuranColored.ttf"), naskh = openFont("NotoNaskhArabic-Regular.ttf");
  Paper paper;
  for (const std::vector<GpgpFont>& chain :
       {std::vector<GpgpFont>{emoji.get(), dejavu.get()}, {dejavu.get(), emoji.get()}}) {
    for (const char* each : {"5 ©", "0123456789#*®™", "☂", "❤", "5\ufe0e"}) {
      SCOPED_TRACE(each);
      const std::string text = each;
      ASSERT_EQ(paper.set(textInfo(text, chain, 20)), GPGP_SUCCESS);
      EXPECT_EQ(paper.info.missingCount, 0u);
      for (uint32_t i = 0; i < paper.info.glyphCount; ++i) EXPECT_EQ(paper.info.glyphs[i].font, dejavu.get());
    }
    for (const char* each : {"☂\ufe0f", "©\ufe0f", "5\ufe0f\u20e3", "😀", "☕"}) {
      SCOPED_TRACE(each);
      const std::string text = each;
      ASSERT_EQ(paper.set(textInfo(text, chain, 20)), GPGP_SUCCESS);
      for (uint32_t i = 0; i < paper.info.glyphCount; ++i) EXPECT_EQ(paper.info.glyphs[i].font, emoji.get());
    }
  }
  // Alone it has to do; and a font of letters in colour is no font of emoji.
  const std::string digits = "5";
  ASSERT_EQ(paper.set(textInfo(digits, {emoji.get()}, 20)), GPGP_SUCCESS);
  EXPECT_EQ(paper.info.missingCount, 0u);
  const std::string letters = "بِسْمِ";
  const std::vector<GpgpFont> colored = {amiri.get(), naskh.get()};
  ASSERT_EQ(paper.set(textInfo(letters, colored, 20)), GPGP_SUCCESS);
  for (uint32_t i = 0; i < paper.info.glyphCount; ++i) EXPECT_EQ(paper.info.glyphs[i].font, amiri.get());
}

/// Each letter keeps its colour: none is lost in a ligature with letters of another.
TEST(TextShape, LettersInColourLeaveLigatures) {
  GPGP_NEEDS_FONTS();
  const FontHandle font = openFont("DejaVuSans.ttf");
  const std::vector<GpgpFont> fonts = {font.get()};
  const std::string text = "office waffles fluffy";
  Paper paper;
  const auto glyphsOf = [&](const std::vector<GpgpTextSpan>& spans, float width = 0) {
    GpgpTextInfo info = textInfo(text, fonts, 20, width);
    info.spans = spans.data();
    info.spanCount = static_cast<uint32_t>(spans.size());
    EXPECT_EQ(paper.set(info), GPGP_SUCCESS);
    return paper.info.glyphCount;
  };
  const auto span = [&](uint32_t begin, uint32_t end, float red, float outline = 0) {
    GpgpTextSpan made{begin, end, textInfo(text, fonts, 20).style};
    made.style.color[0] = red;
    made.style.outlineWidth = outline;
    return made;
  };
  const uint32_t joined = glyphsOf({});
  ASSERT_LT(joined, text.size());               // DejaVu joins f and i, f and l, f and f
  EXPECT_EQ(glyphsOf({span(1, 9, 0)}), joined); // no change of what is seen
  for (uint32_t begin = 0; begin < text.size(); ++begin)
    for (uint32_t end = begin + 1; end <= text.size(); ++end)
      for (const float width : {0.f, 60.f}) {
        for (const bool outlined : {false, true}) {
          glyphsOf({span(begin, end, outlined ? 0.f : 1.f, outlined ? 1.f : 0.f)}, width);
          for (uint32_t i = 0; i < paper.info.glyphCount; ++i) {
            const GpgpTextGlyph& glyph = paper.info.glyphs[i];
            // up to where the next glyph's letters begin
            const uint32_t next =
                i + 1 < paper.info.glyphCount ? paper.info.glyphs[i + 1].cluster : static_cast<uint32_t>(text.size());
            for (uint32_t c = glyph.cluster; c < next; ++c) {
              if (text[c] == ' ') continue;
              EXPECT_EQ(glyph.span, c >= begin && c < end ? 1u : 0u) << begin << " to " << end << ", letter " << c;
            }
          }
        }
      }
}

TEST(TextShape, EmojiOfLatinCharactersAreInColour) {
  GPGP_NEEDS_FONTS();
  // The first two have all of these in black, keycaps in the second.
  const FontHandle latin = openFont("NotoSans-Regular.ttf"), symbols = openFont("NotoSansSymbols-Regular.ttf"),
                   emoji = openFont("NotoColorEmoji.ttf");
  const std::vector<GpgpFont> fonts = {latin.get(), symbols.get(), emoji.get()};
  Paper paper;
  for (const char* text : {"©\uFE0F", "®\uFE0F", "1\uFE0F\u20E3", "9\uFE0F\u20E3", "#\uFE0F\u20E3", "*\uFE0F\u20E3"}) {
    SCOPED_TRACE(text);
    const std::string line = std::string("a") + text + "b";
    ASSERT_EQ(paper.set(textInfo(line, fonts, 10)), GPGP_SUCCESS);
    ASSERT_EQ(paper.info.glyphCount, 3u);
    EXPECT_EQ(paper.info.glyphs[0].font, latin.get());
    EXPECT_EQ(paper.info.glyphs[1].font, emoji.get());
    EXPECT_NE(paper.info.glyphs[1].glyph, 0u);
    EXPECT_EQ(paper.info.glyphs[2].font, latin.get());
  }
  // What is text: alone, with the sign for text, keycaps without the sign for emoji, that sign behind what is none.
  for (const char* text : {"0", "9", "#", "*", "©", "®", "©\uFE0E", "1\uFE0E\u20E3", "1\u20E3", "1\uFE0F", "a\uFE0F"}) {
    SCOPED_TRACE(text);
    const std::string line = text;
    ASSERT_EQ(paper.set(textInfo(line, fonts, 10)), GPGP_SUCCESS);
    for (uint32_t i = 0; i < paper.info.glyphCount; ++i) EXPECT_NE(paper.info.glyphs[i].font, emoji.get());
  }
}

TEST(TextShape, PresentationIsTextOrEmojiInEitherOrderOfFonts) {
  GPGP_NEEDS_FONTS();
  const FontHandle latin = openFont("NotoSans-Regular.ttf"), dejavu = openFont("DejaVuSans.ttf"),
                   emoji = openFont("NotoColorEmoji.ttf");
  Paper paper;
  const auto fontOf = [&](const std::string& text, const std::vector<GpgpFont>& fonts) {
    EXPECT_EQ(paper.set(textInfo(text, fonts, 10)), GPGP_SUCCESS);
    EXPECT_EQ(paper.info.missingCount, 0u);
    return paper.info.glyphs[0].font;
  };
  for (const std::vector<GpgpFont>& fonts : {std::vector<GpgpFont>{latin.get(), emoji.get(), dejavu.get()},
                                             {latin.get(), dejavu.get(), emoji.get()},
                                             {emoji.get(), dejavu.get()}})
    for (const std::string each : {"❤", "☕", "☀", "♥", "⚡"}) {
      SCOPED_TRACE(each);
      EXPECT_EQ(fontOf(each + "\uFE0E", fonts), dejavu.get());
      EXPECT_EQ(fontOf(each + "\uFE0F", fonts), emoji.get());
    }
  // Without a sign the character's own default counts, and what only a font in colour has is in colour.
  const std::vector<GpgpFont> fonts = {latin.get(), emoji.get(), dejavu.get()};
  EXPECT_EQ(fontOf("☕", fonts), emoji.get());
  EXPECT_EQ(fontOf("☕\uFE0E", {latin.get(), emoji.get()}), emoji.get());
}

TEST(TextShape, SpacesBehindEmojiAreThoseOfText) {
  GPGP_NEEDS_FONTS();
  const FontHandle dejavu = openFont("DejaVuSans.ttf"), arabic = openFont("NotoNaskhArabic-Regular.ttf"),
                   emoji = openFont("NotoColorEmoji.ttf");
  const std::vector<GpgpFont> fonts = {dejavu.get(), emoji.get()};
  Paper paper;
  ASSERT_EQ(paper.set(textInfo("a b", fonts, 100)), GPGP_SUCCESS);
  const float space = paper.caret(2).x - paper.caret(1).x;
  for (const char* text : {"a👍 b", "a👍  b", "👍 👍", "1\uFE0F\u20E3 ", "a👍\u200b b", "a👍🏽 b"}) {
    SCOPED_TRACE(text);
    const std::string line = text;
    ASSERT_EQ(paper.set(textInfo(line, fonts, 100)), GPGP_SUCCESS);
    for (size_t at = line.find(' '); at != std::string::npos; at = line.find(' ', at + 1)) {
      const uint32_t offset = static_cast<uint32_t>(at);
      EXPECT_NEAR(paper.caret(offset + 1).x - paper.caret(offset).x, space, 0.01f);
      for (uint32_t i = 0; i < paper.info.glyphCount; ++i)
        EXPECT_TRUE(paper.info.glyphs[i].cluster != offset || paper.info.glyphs[i].font == dejavu.get());
    }
  }
  // Where the font of emoji comes first, other fonts' spaces count; where it is alone, its own. Letters of a later font
  // keep its spaces.
  for (const std::vector<GpgpFont>& chain : {std::vector<GpgpFont>{emoji.get(), dejavu.get()}, {emoji.get()}}) {
    ASSERT_EQ(paper.set(textInfo("👍 👍", chain, 100)), GPGP_SUCCESS);
    ASSERT_EQ(paper.info.glyphCount, 3u);
    EXPECT_EQ(paper.info.glyphs[1].font, chain.back());
  }
  const FontHandle latin = openFont("NotoSans-Regular.ttf");
  const std::string words = "صباح الخير";
  ASSERT_EQ(paper.set(textInfo(words, {latin.get(), arabic.get(), emoji.get()}, 100)), GPGP_SUCCESS);
  for (uint32_t i = 0; i < paper.info.glyphCount; ++i) EXPECT_EQ(paper.info.glyphs[i].font, arabic.get());
}

/// A space belongs to the text beside it, wherever the fonts with other spaces stand in the chain.
TEST(TextShape, SpacesBeforeATextAreItsOwn) {
  GPGP_NEEDS_FONTS();
  const FontHandle dejavu = openFont("DejaVuSans.ttf"), arabic = openFont("NotoNaskhArabic-Regular.ttf"),
                   colored = openFont("AmiriQuranColored.ttf"), emoji = openFont("NotoColorEmoji.ttf");
  Paper paper;
  std::vector<GpgpFont> chain = {arabic.get(), colored.get(), dejavu.get(), emoji.get()};
  std::sort(chain.begin(), chain.end());
  do {
    for (const char* each : {" x", "   x ", "\u00a0 x", " \u200bx", " 5 ©", "x\n x", "x\t x", "👍 x", " 👍 x", " x👍 x",
                             " 👍  👍", " ", "  \t", " \n", "👍 "}) {
      SCOPED_TRACE(each);
      const std::string text = each;
      ASSERT_EQ(paper.set(textInfo(text, chain, 20)), GPGP_SUCCESS);
      // The font of the text before a glyph, or behind it, in its line and up to a tab; none where an emoji is there.
      const auto beside = [&](uint32_t at, uint32_t step) -> GpgpFont {
        for (uint32_t i = at + step; i < paper.info.glyphCount; i += step) {
          const uint32_t cluster = paper.info.glyphs[i].cluster,
                         from = std::min(cluster, paper.info.glyphs[at].cluster),
                         to = std::max(cluster, paper.info.glyphs[at].cluster);
          if (text.substr(from, to - from + 1).find_first_of("\t\n") != text.npos) return nullptr;
          const unsigned char c = static_cast<unsigned char>(text[cluster]);
          if (c == ' ' || c == 0xc2 || c == 0xe2) continue; // white, or nothing at all
          return paper.info.glyphs[i].font == emoji.get() ? nullptr : paper.info.glyphs[i].font;
        }
        return nullptr;
      };
      for (uint32_t i = 0; i < paper.info.glyphCount; ++i) {
        if (text[paper.info.glyphs[i].cluster] != ' ') continue;
        const GpgpFont before = beside(i, UINT32_MAX), behind = beside(i, 1);
        EXPECT_NE(paper.info.glyphs[i].font, emoji.get()) << i;
        if (before || behind) {
          EXPECT_EQ(paper.info.glyphs[i].font, before ? before : behind) << i;
        }
      }
    }
  } while (std::next_permutation(chain.begin(), chain.end()));
}

/// The letters of a required ligature cannot be parted: it has its first letter's colour, and no other letter loses
/// its.
TEST(TextShape, RequiredLigaturesHaveTheirFirstLettersColour) {
  GPGP_NEEDS_FONTS();
  const FontHandle font = openFont("DejaVuSans.ttf");
  const std::vector<GpgpFont> fonts = {font.get()};
  const std::string text = "سلام"; // its second and third letters are one glyph
  Paper paper;
  for (uint32_t letter = 0; letter < 4; ++letter) {
    GpgpTextInfo info = textInfo(text, fonts, 20);
    GpgpTextSpan span{letter * 2, letter * 2 + 2, info.style};
    span.style.color[0] = 1;
    info.spans = &span;
    info.spanCount = 1;
    ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
    ASSERT_EQ(paper.info.glyphCount, 3u);
    for (uint32_t i = 0; i < paper.info.glyphCount; ++i)
      EXPECT_EQ(paper.info.glyphs[i].color[0], paper.info.glyphs[i].cluster == letter * 2 ? 1 : 0) << letter;
  }
}

TEST(TextShape, BytesThatAreNoTextAreReplacedAndReported) {
  GPGP_NEEDS_FONTS();
  const FontHandle font = openFont("DejaVuSans.ttf");
  const std::vector<GpgpFont> fonts = {font.get()};
  // A byte alone, a character cut short, one too long, a surrogate, and the end within a character.
  const std::string text = "a\xff"
                           "b\xe2\x82"
                           "c\xc0\xaf"
                           "d\xed\xa0\x80"
                           "e\xf0\x9f";
  Paper paper;
  ASSERT_EQ(paper.set(textInfo(text, fonts, 10)), GPGP_SUCCESS);
  const std::vector<uint32_t> invalid(paper.info.invalid, paper.info.invalid + paper.info.invalidCount);
  EXPECT_EQ(invalid, (std::vector<uint32_t>{1, 3, 6, 7, 9, 10, 11, 13}));
  uint32_t replacement = 0;
  ASSERT_EQ(gpgpGetNominalGlyph(font.get(), 0xfffd, &replacement), GPGP_SUCCESS);
  ASSERT_EQ(paper.info.glyphCount, 5u + 8u);
  for (uint32_t i = 0; i < paper.info.glyphCount; ++i) {
    const GpgpTextGlyph& glyph = paper.info.glyphs[i];
    const bool bad = std::find(invalid.begin(), invalid.end(), glyph.cluster) != invalid.end();
    EXPECT_EQ(glyph.glyph == replacement, bad) << "byte " << glyph.cluster;
  }
}

TEST(TextShape, RunsAreKeptWithinTheBudget) {
  GPGP_NEEDS_FONTS();
  const FontHandle font = openFont("DejaVuSans.ttf");
  const std::vector<GpgpFont> fonts = {font.get()};
  const size_t budget = 32768;
  Paper paper(budget);
  GpgpShaperReport report = GPGP_SHAPER_REPORT_INIT;
  const auto look = [&] { EXPECT_EQ(gpgpGetShaperReport(paper.shaper.get(), &report), GPGP_SUCCESS); };
  const std::string text = "one line of the score: 12345";
  ASSERT_EQ(paper.set(textInfo(text, fonts, 12)), GPGP_SUCCESS);
  look();
  EXPECT_EQ(report.misses, 1u);
  EXPECT_EQ(report.runs, 1u);
  const std::vector<GpgpTextGlyph> first(paper.info.glyphs, paper.info.glyphs + paper.info.glyphCount);
  ASSERT_EQ(paper.set(textInfo(text, fonts, 24)), GPGP_SUCCESS); // a run serves every size
  look();
  EXPECT_EQ(report.misses, 1u);
  EXPECT_EQ(report.hits, 1u);
  for (size_t i = 0; i < first.size(); ++i) EXPECT_NEAR(paper.info.glyphs[i].x, 2 * first[i].x, 0.01f);
  for (int i = 0; i < 200; ++i) {
    const std::string next = text + std::to_string(i);
    ASSERT_EQ(paper.set(textInfo(next, fonts, 12)), GPGP_SUCCESS);
    ASSERT_EQ(paper.set(textInfo(text, fonts, 12)), GPGP_SUCCESS); // used all the time: stays
    look();
    EXPECT_LE(report.bytes, budget);
  }
  EXPECT_EQ(report.misses, 201u);
  EXPECT_EQ(report.evictions + report.runs, 201u);
  EXPECT_GT(report.evictions, 100u);
  EXPECT_EQ(report.cacheBytes, budget);

  // A run larger than the budget is shaped each time, and evicts nothing.
  const std::string large(5000, 'x');
  const size_t runs = report.runs;
  ASSERT_EQ(paper.set(textInfo(large, fonts, 12)), GPGP_SUCCESS);
  EXPECT_EQ(paper.info.glyphCount, large.size());
  look();
  EXPECT_EQ(report.runs, runs);
}

std::vector<uint32_t> closureOf(GpgpFont font, const std::vector<GpgpCharacterRange>& ranges) {
  uint32_t count = 0;
  const auto rangeCount = static_cast<uint32_t>(ranges.size());
  EXPECT_EQ(gpgpGetGlyphClosure(font, ranges.data(), rangeCount, &count, nullptr), GPGP_SUCCESS);
  std::vector<uint32_t> glyphs(count, ~0u);
  EXPECT_EQ(gpgpGetGlyphClosure(font, ranges.data(), rangeCount, &count, glyphs.data()), GPGP_SUCCESS);
  EXPECT_TRUE(std::is_sorted(glyphs.begin(), glyphs.end()));
  return glyphs;
}

TEST(TextShape, TheClosureOfCharactersHasAllThatTheirTextsNeed) {
  GPGP_NEEDS_FONTS();
  struct Case {
    const char* font;
    std::vector<GpgpCharacterRange> ranges;
    uint32_t face = 0;
  };
  const std::vector<Case> cases = {{"DejaVuSans.ttf", {{0x20, 0x7e}, {0x300, 0x310}}},
                                   {"DejaVuSans.ttf", {{'a', 'f'}, {0x621, 0x64a}, {0x5d0, 0x5ea}, {0x5b0, 0x5bc}}},
                                   {"NotoSans-Regular.ttf", {{0x20, 0x7e}, {0x300, 0x33f}, {0x391, 0x3c9}}},
                                   {"NotoNaskhArabic-Regular.ttf", {{0x600, 0x652}, {0x20, 0x20}}},
                                   {"NotoSansHebrew-Regular.ttf", {{0x590, 0x5f4}, {'(', ')'}}},
                                   {"NotoSansDevanagari-Regular.ttf", {{0x900, 0x97f}, {0x200c, 0x200d}}},
                                   {"NotoSansThai-Regular.ttf", {{0xe01, 0xe5b}}},
                                   {"NotoSansCJK-Regular.ttc", {{0x3041, 0x30ff}, {0x4e00, 0x4e20}, {0xfe00, 0xfe01}}},
                                   {"Cantarell-Regular.otf", {{0x20, 0x17f}}},
                                   {"Inter-roman.var.ttf", {{0x20, 0x7e}}}};
  const GpgpTag features[] = {GPGP_TAG('s', 'm', 'c', 'p'), GPGP_TAG('d', 'l', 'i', 'g'), GPGP_TAG('f', 'r', 'a', 'c'),
                              GPGP_TAG('s', 's', '0', '1'), GPGP_TAG('o', 'n', 'u', 'm'), GPGP_TAG('s', 'a', 'l', 't'),
                              GPGP_TAG('z', 'e', 'r', 'o'), GPGP_TAG('c', 'a', 'l', 't'), GPGP_TAG('v', 'e', 'r', 't')};
  std::mt19937 random(7);
  size_t beyond = 0;
  for (const Case& one : cases) {
    SCOPED_TRACE(one.font);
    const FontHandle font = openFont(one.font, one.face);
    const std::vector<GpgpFont> fonts = {font.get()};
    const std::vector<uint32_t> glyphs = closureOf(font.get(), one.ranges);
    EXPECT_EQ(glyphs.front(), 0u);
    std::vector<char32_t> characters;
    std::set<uint32_t> own; // glyphs of the characters before shaping
    for (const GpgpCharacterRange& range : one.ranges)
      for (uint32_t c = range.first; c <= range.last; ++c) {
        characters.push_back(c);
        uint32_t glyph = 0;
        ASSERT_EQ(gpgpGetNominalGlyph(font.get(), c, &glyph), GPGP_SUCCESS);
        own.insert(glyph);
      }
    Paper paper;
    for (int round = 0; round < 300; ++round) {
      std::string text;
      for (int i = 0; i < 40; ++i) {
        const char32_t c = characters[random() % characters.size()];
        if (c < 0x80)
          text += static_cast<char>(c);
        else if (c < 0x800)
          text += {static_cast<char>(0xc0 | c >> 6), static_cast<char>(0x80 | (c & 63))};
        else
          text += {static_cast<char>(0xe0 | c >> 12), static_cast<char>(0x80 | (c >> 6 & 63)),
                   static_cast<char>(0x80 | (c & 63))};
      }
      const GpgpFontFeature feature{features[random() % std::size(features)], 1 + static_cast<uint32_t>(random() % 2)};
      GpgpTextInfo info = textInfo(text, fonts, 20, round % 2 ? 0.f : 120.f);
      info.style.features = &feature;
      info.style.featureCount = round % 3 != 0;
      info.direction = static_cast<GpgpTextDirection>(round % 3);
      info.maxLines = round % 5 == 0 ? 1 : 0; // an ellipsis
      ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
      for (uint32_t i = 0; i < paper.info.glyphCount; ++i) {
        const uint32_t glyph = paper.info.glyphs[i].glyph;
        ASSERT_TRUE(std::binary_search(glyphs.begin(), glyphs.end(), glyph)) << "glyph " << glyph << " in " << text;
        beyond += glyph != 0 && !own.count(glyph);
      }
    }
  }
  EXPECT_GT(beyond, 1000u) << "the test has no shaped glyphs";

  const FontHandle font = openFont("DejaVuSans.ttf");
  const auto glyphOf = [&](uint32_t character) {
    uint32_t glyph = 0;
    gpgpGetNominalGlyph(font.get(), character, &glyph);
    return glyph;
  };
  const auto has = [](const std::vector<uint32_t>& glyphs, uint32_t glyph) {
    return std::binary_search(glyphs.begin(), glyphs.end(), glyph);
  };
  const std::vector<uint32_t> few = closureOf(font.get(), {{'e', 'i'}, {0x301, 0x301}});
  EXPECT_TRUE(has(few, glyphOf(0xe9))) << "e with an acute is composed";
  EXPECT_TRUE(has(few, glyphOf(0xfb03))) << "ffi";
  EXPECT_TRUE(has(few, glyphOf(' ')) && has(few, glyphOf(0x2026)));
  EXPECT_FALSE(has(few, glyphOf('a')));
  EXPECT_FALSE(has(few, glyphOf(0xfb02))) << "fl needs an l";
  EXPECT_LT(few.size(), 100u);
  EXPECT_EQ(closureOf(font.get(), {}).front(), 0u);
  uint32_t count = 2, two[3] = {7, 7, 7};
  const GpgpCharacterRange letters = {'a', 'z'}, turned = {'z', 'a'}, high = {0, 0x110000};
  EXPECT_EQ(gpgpGetGlyphClosure(font.get(), &letters, 1, &count, two), GPGP_INCOMPLETE);
  EXPECT_GT(count, 26u);
  EXPECT_EQ(two[0], 0u);
  EXPECT_EQ(two[2], 7u) << "no more than there is room for";
  EXPECT_EQ(gpgpGetGlyphClosure(font.get(), &turned, 1, &count, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpGetGlyphClosure(font.get(), &high, 1, &count, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpGetGlyphClosure(font.get(), nullptr, 1, &count, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpGetGlyphClosure(nullptr, &letters, 1, &count, nullptr), GPGP_ERROR_INVALID_HANDLE);
}

TEST(TextShape, ATextThatIsKnownCostsNoMemory) {
#ifndef GPGP_COUNTS_MALLOC
  GTEST_SKIP() << "no malloc that counts";
#else
  GPGP_NEEDS_FONTS();
  const FontHandle font = openFont("DejaVuSans.ttf"), arabic = openFont("NotoNaskhArabic-Regular.ttf"),
                   devanagari = openFont("NotoSansDevanagari-Regular.ttf"), thai = openFont("NotoSansThai-Regular.ttf"),
                   japanese = openFont("NotoSansCJK-Regular.ttc"), emoji = openFont("NotoColorEmoji.ttf");
  const std::vector<GpgpFont> fonts = {font.get(), arabic.get(),   devanagari.get(),
                                       thai.get(), japanese.get(), emoji.get()};
  Paper paper;
  const auto costs = [&](const std::string& bytes) {
    GpgpTextInfo info = textInfo(bytes, fonts, 12, 300);
    size_t before = 0;
    for (int i = 0; i < 3; ++i) { // the first is shaped
      before = allocations;
      EXPECT_EQ(gpgpSetLayoutText(paper.layout.get(), &info), GPGP_SUCCESS);
    }
    return allocations - before;
  };
  for (const char* part :
       {"The office staff found five fluffy waffles. ", "Don’t wait… 5 € – “never” — or → ", "Grüße. ", "Το πρωί. ",
        "Привет. ", "सुबह खिड़की खुली है। ", "朝、窓は開いていて、「カタカナ」も。", "ตอนเช้าหน้าต่างเปิดอยู่ ",
        "👍🏽 👨‍👩‍👧 ", "a ﬁ\u00ad\u200bb "}) {
    SCOPED_TRACE(part);
    std::string text;
    for (int i = 0; i < 40; ++i) text += std::string(part) + (i % 5 == 4 ? "\n" : "");
    const size_t bytes = allocatedBytes;
    EXPECT_EQ(costs(text), 0u);
    EXPECT_GT(allocatedBytes, bytes); // the counter counts
  }
#endif
}
