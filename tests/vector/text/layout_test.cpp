// Lines against ICU used directly and closed cases; alignment, metrics, spans and decorations by what must hold.
#include "fonts.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <unicode/ubrk.h>
#include <unicode/utext.h>

using namespace gpgp::test;

namespace {

/// Byte offsets where ICU lets a line begin.
std::set<uint32_t> breaksOf(const std::string& text, const char* locale, UBreakIteratorType type = UBRK_LINE) {
  UErrorCode error = U_ZERO_ERROR;
  UText* opened = utext_openUTF8(nullptr, text.data(), static_cast<int64_t>(text.size()), &error);
  UBreakIterator* iterator = ubrk_open(type, locale, nullptr, 0, &error);
  ubrk_setUText(iterator, opened, &error);
  EXPECT_TRUE(U_SUCCESS(error));
  std::set<uint32_t> found;
  for (int32_t at = ubrk_first(iterator); at != UBRK_DONE; at = ubrk_next(iterator))
    found.insert(static_cast<uint32_t>(at));
  ubrk_close(iterator);
  utext_close(opened);
  return found;
}

std::string withoutSpaces(std::string text) {
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

class TextMono : public testing::Test {
protected:
  void SetUp() override {
    GPGP_NEEDS_FONTS();
    font_ = openFont("DejaVuSansMono.ttf");
    fonts_ = {font_.get()};
    ASSERT_EQ(paper_.set(textInfo("x", fonts_, 10)), GPGP_SUCCESS);
    cell_ = paper_.info.width;
  }
  /// The lines of a text, in cells.
  std::vector<std::string> lines(const std::string& text, float cells, GpgpTextInfo info = GPGP_TEXT_INFO_INIT) {
    GpgpTextInfo own = textInfo(text, fonts_, 10, cells * cell_);
    own.maxLines = info.maxLines;
    own.height = info.height;
    own.ellipsis = info.ellipsis;
    own.align = info.align;
    own.tabWidth = info.tabWidth;
    EXPECT_EQ(paper_.set(own), GPGP_SUCCESS);
    std::vector<std::string> found;
    for (uint32_t i = 0; i < paper_.info.lineCount; ++i)
      found.push_back(text.substr(paper_.info.lines[i].begin, paper_.info.lines[i].end - paper_.info.lines[i].begin));
    return found;
  }
  using Lines = std::vector<std::string>;
  FontHandle font_;
  std::vector<GpgpFont> fonts_;
  Paper paper_;
  float cell_ = 0;
};

} // namespace

TEST_F(TextMono, ClosedCasesOfLines) {
  EXPECT_EQ(lines("aaa bbb ccc", 7), (Lines{"aaa bbb ", "ccc"}));
  EXPECT_EQ(lines("aaa bbb ccc", 6), (Lines{"aaa ", "bbb ", "ccc"}));
  EXPECT_EQ(lines("aaa bbb ccc", 11), (Lines{"aaa bbb ccc"}));
  EXPECT_EQ(lines("aaa bbb ccc", 0), (Lines{"aaa bbb ccc"}));
  EXPECT_EQ(lines("aaa    bbb", 4), (Lines{"aaa    ", "bbb"})); // spaces hang
  EXPECT_EQ(lines("abcdefghij", 4), (Lines{"abcd", "efgh", "ij"}));
  EXPECT_EQ(lines("ab cdefghij", 4), (Lines{"ab ", "cdef", "ghij"}));
  EXPECT_EQ(lines("abc", 0.5f), (Lines{"a", "b", "c"}));
  EXPECT_EQ(lines("ae\u0301i", 0.5f), (Lines{"a", "e\u0301", "i"}));
  // What takes no room goes with the letter that is too wide.
  EXPECT_EQ(lines("ab cd", 0.5f), (Lines{"a", "b ", "c", "d"}));
  EXPECT_EQ(lines("a\nb\n\nc\n", 0.5f), (Lines{"a\n", "b\n", "\n", "c\n", ""}));
  EXPECT_EQ(lines("a\u200bb\u200f", 0.5f), (Lines{"a\u200b", "b\u200f"}));
  EXPECT_EQ(lines("ab\u00adcd\u00ad", 0.5f), (Lines{"a", "b\u00ad", "c", "d\u00ad"}));
  EXPECT_EQ(lines("ab\u00adcdefgh", 2), (Lines{"a", "b\u00ad", "cd", "ef", "gh"})); // no hyphen alone
  EXPECT_EQ(lines("well-known words", 7), (Lines{"well-", "known ", "words"}));
  EXPECT_EQ(lines("a\nb\r\nc\n", 9), (Lines{"a\n", "b\r\n", "c\n", ""}));
  EXPECT_EQ(lines("a\n\nb", 9), (Lines{"a\n", "\n", "b"}));
  EXPECT_EQ(lines("a\u2028b\u2029c\x0b"
                  "d",
                  9),
            (Lines{"a\u2028", "b\u2029", "c\x0b", "d"}));
  EXPECT_EQ(lines("", 9), (Lines{""}));
  EXPECT_GT(paper_.info.height, 9);
  EXPECT_EQ(lines("\n", 9), (Lines{"\n", ""}));
  EXPECT_EQ(lines("   ", 2), (Lines{"   "}));
  EXPECT_EQ(lines("aa\u00a0bb cc", 5), (Lines{"aa\u00a0bb ", "cc"})); // held together
  EXPECT_EQ(lines("abc\u00addef", 4), (Lines{"abc\u00ad", "def"}));   // with a hyphen
  EXPECT_NEAR(paper_.info.lines[0].width, 4 * cell_, 0.01f);
  EXPECT_EQ(paper_.info.lines[0].glyphCount, 5u); // one of them the soft hyphen's, without ink
  uint32_t hyphen = 0;
  ASSERT_EQ(gpgpGetNominalGlyph(font_.get(), 0x2010, &hyphen), GPGP_SUCCESS);
  EXPECT_EQ(paper_.info.glyphs[4].glyph, hyphen);
  GpgpTextInfo justified = GPGP_TEXT_INFO_INIT;
  justified.align = GPGP_TEXT_ALIGN_JUSTIFY;
  EXPECT_EQ(lines("a bc\u00addef", 6, justified), (Lines{"a bc\u00ad", "def"}));
  EXPECT_NEAR(paper_.info.lines[0].width, 6 * cell_, 0.01f);
  EXPECT_EQ(paper_.hit(5.5f * cell_, 1).insertion, 6u);         // on the hyphen: the end of the line
  EXPECT_EQ(lines("abc\u00addef", 6), (Lines{"abc\u00addef"})); // without one
  EXPECT_NEAR(paper_.info.width, 6 * cell_, 0.01f);
  EXPECT_EQ(lines("ab\u00adc\u00addef", 3.5f), (Lines{"ab\u00ad", "c\u00ad", "def"})); // "abc-" would not fit
  lines("aaa bbb", 5);
  EXPECT_FALSE(paper_.info.lines[0].hardBreak);
  EXPECT_TRUE(paper_.info.lines[1].hardBreak);
  EXPECT_NEAR(paper_.info.lines[0].width, 3 * cell_, 0.01f);
}

TEST_F(TextMono, ClosedCasesOfCutting) {
  GpgpTextInfo info = GPGP_TEXT_INFO_INIT;
  info.maxLines = 1;
  EXPECT_EQ(lines("aaa bbb ccc", 7, info), (Lines{"aaa bb"}));
  EXPECT_TRUE(paper_.info.truncated);
  EXPECT_NEAR(paper_.info.width, 7 * cell_, 0.01f);
  EXPECT_EQ(paper_.info.glyphCount, 7u);
  EXPECT_EQ(lines("aaa bbb ccc", 5, info), (Lines{"aaa"})); // no space before the ellipsis
  EXPECT_EQ(lines("aaa bbb ccc", 11, info), (Lines{"aaa bbb ccc"}));
  EXPECT_FALSE(paper_.info.truncated);
  EXPECT_EQ(lines("a bbbbbbbbbbbb", 7, info), (Lines{"a bbbb"})); // a part of the word that does not fit
  EXPECT_EQ(paper_.info.glyphCount, 7u);
  EXPECT_EQ(lines("a bbbbbbb\u0301bb", 7, info), (Lines{"a bbbb"}));
  EXPECT_EQ(lines("a b\u0301\u0301\u0301\u0301cccccc", 4, info), (Lines{"a b\u0301\u0301\u0301\u0301"}));
  EXPECT_EQ(lines("a bbbb\ncc", 7, info), (Lines{"a bbbb"}));
  EXPECT_EQ(lines("aaa\nbbb", 20, info), (Lines{"aaa"}));
  EXPECT_TRUE(paper_.info.truncated);
  EXPECT_EQ(paper_.info.glyphCount, 4u);
  EXPECT_EQ(lines("aaa\nbbb", 0, info), (Lines{"aaa"}));
  EXPECT_EQ(lines("abc def", 0.5f, info), (Lines{""})); // only the ellipsis
  EXPECT_EQ(paper_.info.glyphCount, 1u);
  info.ellipsis = "";
  EXPECT_EQ(lines("aaa bbb ccc", 7, info), (Lines{"aaa bbb"}));
  info.ellipsis = " >";
  EXPECT_EQ(lines("aaa bbb ccc", 7, info), (Lines{"aaa b"}));
  info.ellipsis = nullptr;
  info.maxLines = 2;
  EXPECT_EQ(lines("aaa bbb ccc ddd", 4, info), (Lines{"aaa ", "bbb"}));
  EXPECT_TRUE(paper_.info.truncated);
  EXPECT_EQ(lines("aaa b ccccccc", 4, info), (Lines{"aaa ", "b c"}));
  // By height: two lines and a half.
  lines("a", 9);
  info.maxLines = 0;
  info.height = 2.5f * paper_.info.height;
  EXPECT_EQ(lines("a b c d", 2, info), (Lines{"a ", "b"}));
  EXPECT_LE(paper_.info.height, info.height);
  info.height = 1; // the first stays
  EXPECT_EQ(lines("aa bb", 2, info), (Lines{"a"}));
  // Characters that are cut off have their caret at the ellipsis.
  const GpgpCaret hidden = paper_.caret(4);
  EXPECT_NEAR(hidden.x, paper_.info.lines[0].left + paper_.info.lines[0].width, 0.01f);
}

TEST_F(TextMono, TabsGoToStops) {
  GpgpTextInfo info = GPGP_TEXT_INFO_INIT;
  info.tabWidth = 50;
  lines("a\tb\t\tc\t", 0, info);
  std::vector<float> places;
  for (uint32_t i = 0; i < paper_.info.glyphCount; ++i) places.push_back(paper_.info.glyphs[i].x);
  ASSERT_EQ(places.size(), 3u);
  EXPECT_NEAR(places[1], 50, 0.01f);
  EXPECT_NEAR(places[2], 150, 0.01f);
  info.tabWidth = 0;
  lines("ab\tc", 0, info);
  EXPECT_NEAR(paper_.info.glyphs[2].x, 8 * cell_, 0.02f);
  EXPECT_EQ(lines("ab\tcd ef", 9, info), (Lines{"ab\t", "cd ef"}));
}

TEST_F(TextMono, AlignmentAndSpacing) {
  const struct {
    GpgpTextAlign align;
    float first; // left of "bb" in ten cells
  } cases[] = {{GPGP_TEXT_ALIGN_START, 0},
               {GPGP_TEXT_ALIGN_LEFT, 0},
               {GPGP_TEXT_ALIGN_CENTER, 4},
               {GPGP_TEXT_ALIGN_RIGHT, 8},
               {GPGP_TEXT_ALIGN_END, 8}};
  for (const auto& each : cases) {
    GpgpTextInfo info = GPGP_TEXT_INFO_INIT;
    info.align = each.align;
    lines("aaa aaa aa bb", 10, info);
    ASSERT_EQ(paper_.info.lineCount, 2u);
    EXPECT_NEAR(paper_.info.lines[1].left, each.first * cell_, 0.01f) << each.align;
    EXPECT_NEAR(paper_.info.lines[0].left, 0, 0.01f) << each.align;
    const uint32_t last = paper_.info.lines[1].firstGlyph;
    EXPECT_NEAR(paper_.info.glyphs[last].x, each.first * cell_, 0.01f);
  }
  GpgpTextInfo info = textInfo("a\nb\nc", fonts_, 10);
  ASSERT_EQ(paper_.set(info), GPGP_SUCCESS);
  const GpgpFontInfo font = infoOf(font_.get());
  const float natural = 10 * (font.ascent + font.descent + font.lineGap);
  EXPECT_NEAR(paper_.info.height, 3 * natural, 0.01f);
  info.lineSpacing = 1.5f;
  ASSERT_EQ(paper_.set(info), GPGP_SUCCESS);
  EXPECT_NEAR(paper_.info.lines[1].baseline - paper_.info.lines[0].baseline, 1.5f * natural, 0.01f);
  info.lineHeight = 40;
  ASSERT_EQ(paper_.set(info), GPGP_SUCCESS);
  EXPECT_NEAR(paper_.info.height, 120, 0.01f);
  const GpgpTextLine& line = paper_.info.lines[1];
  EXPECT_NEAR(line.baseline - line.ascent - line.top, line.top + line.height - line.baseline - line.descent, 0.01f);
}

TEST(TextLayout, LinesEndWhereIcuLetsThem) {
  GPGP_NEEDS_FONTS();
  std::mt19937 random(3);
  for (const Sample& sample : samples()) {
    const FontHandle font = openFont(sample.font, sample.face), other = openFont("DejaVuSans.ttf");
    const std::vector<GpgpFont> fonts = {font.get(), other.get()};
    const std::string text = std::string(sample.text) + " " + sample.text;
    const std::set<uint32_t> allowed = breaksOf(text, sample.language);
    const std::set<uint32_t> graphemes = breaksOf(text, "root", UBRK_CHARACTER);
    Paper paper, probe;
    const auto widthOf = [&](uint32_t begin, uint32_t end) {
      const std::string part = withoutSpaces(text.substr(begin, end - begin));
      GpgpTextInfo info = textInfo(part, fonts, 16);
      info.style.language = sample.language;
      EXPECT_EQ(probe.set(info), GPGP_SUCCESS);
      return probe.info.width;
    };
    for (int run = 0; run < 25; ++run) {
      const float width = run == 0 ? 5 : static_cast<float>(20 + random() % 400);
      SCOPED_TRACE(std::string(sample.name) + " in " + std::to_string(width));
      GpgpTextInfo info = textInfo(text, fonts, 16, width);
      info.style.language = sample.language;
      ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
      uint32_t at = 0;
      for (uint32_t i = 0; i < paper.info.lineCount; ++i) {
        const GpgpTextLine& line = paper.info.lines[i];
        ASSERT_EQ(line.begin, at);
        ASSERT_GT(line.end, line.begin);
        at = line.end;
        // The line is as wide as its text alone, but for letters that join across its ends.
        const auto next = allowed.upper_bound(line.begin);
        const bool fits = line.width <= width + 0.02f;
        const auto inkEnd = static_cast<uint32_t>(
            line.begin + withoutSpaces(text.substr(line.begin, line.end - line.begin)).size()); // spaces hang
        if (allowed.count(line.end)) {
          // It fits, unless there is nowhere to break: and the next piece would not have.
          const auto further = allowed.upper_bound(line.end);
          if (further != allowed.end()) {
            EXPECT_GT(widthOf(line.begin, *further), width - 0.02f) << "line " << i;
          }
          EXPECT_TRUE(fits || *graphemes.upper_bound(line.begin) >= inkEnd) << "line " << i;
        } else { // within a word: because its first piece is too wide, and as much as fits
          ASSERT_TRUE(graphemes.count(line.end)) << "line " << i;
          EXPECT_GT(widthOf(line.begin, *next), width - 0.02f) << "line " << i;
          EXPECT_TRUE(fits || *graphemes.upper_bound(line.begin) >= inkEnd) << "line " << i;
        }
      }
      EXPECT_EQ(at, text.size());
    }
  }
}

TEST(TextLayout, WidthsAreSumsOfAdvances) {
  GPGP_NEEDS_FONTS();
  const FontHandle latin = openFont("DejaVuSans.ttf"), arabic = openFont("NotoNaskhArabic-Regular.ttf"),
                   hebrew = openFont("NotoSansHebrew-Regular.ttf");
  const std::vector<GpgpFont> fonts = {latin.get(), hebrew.get(), arabic.get()};
  const std::string text = std::string(samples()[0].text) + " " + samples()[1].text + " " + samples()[2].text +
                           " 123 office (" + samples()[1].text + ")";
  Paper paper;
  uint32_t justified = 0;
  for (const GpgpTextAlign align : {GPGP_TEXT_ALIGN_START, GPGP_TEXT_ALIGN_END, GPGP_TEXT_ALIGN_JUSTIFY})
    for (const float width : {90.f, 150.f, 222.f, 600.f}) {
      GpgpTextInfo info = textInfo(text, fonts, 14, width);
      info.align = align;
      ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
      for (uint32_t i = 0; i < paper.info.lineCount; ++i) {
        const GpgpTextLine& line = paper.info.lines[i];
        // All that is in the line: what a selection of it covers.
        const auto rects = paper.selection(line.begin, line.end);
        ASSERT_EQ(rects.size(), 1u);
        const float edge = line.left + line.width;
        EXPECT_LE(rects[0].x, line.left + 0.02f);
        EXPECT_GE(rects[0].x + rects[0].width, edge - 0.02f);
        if (line.rightToLeft)
          EXPECT_NEAR(rects[0].x + rects[0].width, edge, 0.02f);
        else
          EXPECT_NEAR(rects[0].x, line.left, 0.02f);
        const bool hasGap = withoutSpaces(text.substr(line.begin, line.end - line.begin)).find(' ') != text.npos;
        if (align == GPGP_TEXT_ALIGN_JUSTIFY && !line.hardBreak && hasGap) {
          EXPECT_NEAR(line.width, width, 0.05f) << "line " << i;
          ++justified;
        }
        // Glyphs are within the line, from left to right but for marks.
        for (uint32_t g = 0; g < line.glyphCount; ++g) {
          const GpgpTextGlyph& glyph = paper.info.glyphs[line.firstGlyph + g];
          EXPECT_EQ(glyph.line, i);
          EXPECT_GE(glyph.cluster, line.begin);
          EXPECT_LT(glyph.cluster, line.end);
          EXPECT_GT(glyph.x, rects[0].x - 14);
          EXPECT_LT(glyph.x, rects[0].x + rects[0].width + 1);
        }
      }
    }
  EXPECT_GT(justified, 10u);
}

TEST(TextLayout, IdeographsAreStretchedToo) {
  GPGP_NEEDS_FONTS();
  const Sample& japanese = samples()[5];
  const FontHandle font = openFont(japanese.font);
  const std::vector<GpgpFont> fonts = {font.get()};
  GpgpTextInfo info = textInfo(japanese.text, fonts, 20, 215);
  info.style.language = japanese.language;
  info.align = GPGP_TEXT_ALIGN_JUSTIFY;
  Paper paper;
  ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
  ASSERT_GE(paper.info.lineCount, 3u);
  for (uint32_t i = 0; i + 1 < paper.info.lineCount; ++i) EXPECT_NEAR(paper.info.lines[i].width, 215, 0.05f);
  EXPECT_LT(paper.info.lines[paper.info.lineCount - 1].width, 214);
}

TEST(TextLayout, CuttingARunShapesItsParts) {
  GPGP_NEEDS_FONTS();
  const FontHandle arabic = openFont("NotoNaskhArabic-Regular.ttf");
  const std::vector<GpgpFont> fonts = {arabic.get()};
  // A long word that must be cut: its parts keep the forms that join across the cut.
  const std::string word = "مستشفياتهممستشفياتهم";
  Paper paper;
  ASSERT_EQ(paper.set(textInfo(word, fonts, 20)), GPGP_SUCCESS);
  const uint32_t whole = paper.info.glyphCount;
  ASSERT_EQ(paper.set(textInfo(word, fonts, 20, paper.info.width * 0.4f)), GPGP_SUCCESS);
  EXPECT_GE(paper.info.lineCount, 3u);
  EXPECT_GE(paper.info.glyphCount, whole);
  // Latin: a ligature is taken apart where a line ends in it.
  const FontHandle latin = openFont("DejaVuSans.ttf");
  const std::vector<GpgpFont> others = {latin.get()};
  ASSERT_EQ(paper.set(textInfo("ffi", others, 20)), GPGP_SUCCESS);
  EXPECT_EQ(paper.info.glyphCount, 1u);
  ASSERT_EQ(paper.set(textInfo("ffi", others, 20, 1)), GPGP_SUCCESS);
  EXPECT_EQ(paper.info.glyphCount, 3u);
  EXPECT_EQ(paper.info.lineCount, 3u);
}

TEST(TextLayout, SpansHaveTheirStyle) {
  GPGP_NEEDS_FONTS();
  const FontHandle sans = openFont("DejaVuSans.ttf"), serif = openFont("DejaVuSerif.ttf");
  const std::vector<GpgpFont> first = {sans.get()}, second = {serif.get()};
  const std::string text = "plain large serif plain";
  GpgpTextInfo info = textInfo(text, first, 10);
  GpgpTextSpan spans[2] = {{6, 17, info.style}, {12, 17, info.style}};
  spans[0].style.size = 30;
  spans[0].style.underline = VK_TRUE;
  spans[0].style.color[0] = 1;
  spans[1].style.fonts = second.data();
  spans[1].style.strike = VK_TRUE;
  info.spans = spans;
  info.spanCount = 2;
  Paper paper;
  ASSERT_EQ(paper.set(info), GPGP_SUCCESS) << paper.log.text;
  for (uint32_t i = 0; i < paper.info.glyphCount; ++i) {
    const GpgpTextGlyph& glyph = paper.info.glyphs[i];
    const uint32_t span = glyph.cluster < 6 || glyph.cluster >= 17 ? 0 : glyph.cluster < 12 ? 1 : 2;
    EXPECT_EQ(glyph.span, span);
    EXPECT_EQ(glyph.size, span == 1 ? 30 : 10);
    EXPECT_EQ(glyph.color[0], span == 1 ? 1 : 0);
    EXPECT_EQ(glyph.font, span == 2 ? serif.get() : sans.get());
    EXPECT_EQ(glyph.y, paper.info.lines[0].baseline);
  }
  const GpgpFontInfo sansInfo = infoOf(sans.get()), serifInfo = infoOf(serif.get());
  EXPECT_NEAR(paper.info.lines[0].ascent, 30 * sansInfo.ascent, 0.01f);
  ASSERT_EQ(paper.info.decorationCount, 2u);
  const GpgpTextDecoration &under = paper.info.decorations[0], &strike = paper.info.decorations[1];
  EXPECT_FALSE(under.strike);
  EXPECT_EQ(under.span, 1u);
  EXPECT_EQ(under.color[0], 1);
  EXPECT_TRUE(strike.strike);
  EXPECT_EQ(strike.span, 2u);
  const auto large = paper.selection(6, 12), struck = paper.selection(12, 17);
  ASSERT_EQ(large.size(), 1u);
  EXPECT_NEAR(under.rect.x, large[0].x, 0.01f);
  EXPECT_NEAR(under.rect.width, large[0].width, 0.01f);
  EXPECT_NEAR(under.rect.y + under.rect.height / 2 - paper.info.lines[0].baseline, 30 * sansInfo.underlinePosition,
              0.01f);
  EXPECT_NEAR(under.rect.height, 30 * sansInfo.underlineThickness, 0.01f);
  EXPECT_NEAR(strike.rect.x, struck[0].x, 0.01f);
  EXPECT_NEAR(strike.rect.width, struck[0].width, 0.01f);
  EXPECT_NEAR(strike.rect.y + strike.rect.height / 2 - paper.info.lines[0].baseline, 10 * serifInfo.strikePosition,
              0.01f);

  // A span that changes only colours parts no run, but a ligature, whose one glyph could have but one of them.
  GpgpTextInfo ligature = textInfo("office", first, 10);
  GpgpTextSpan color = {2, 6, ligature.style};
  color.style.color[1] = 1;
  ligature.spans = &color;
  ligature.spanCount = 1;
  ASSERT_EQ(paper.set(ligature), GPGP_SUCCESS);
  ASSERT_EQ(paper.info.glyphCount, 6u);
  for (uint32_t i = 0; i < 6; ++i) EXPECT_EQ(paper.info.glyphs[i].color[1], i < 2 ? 0 : 1);
  color.style.color[1] = 0;
  ASSERT_EQ(paper.set(ligature), GPGP_SUCCESS);
  EXPECT_EQ(paper.info.glyphCount, 4u); // o ffi c e

  // An underline in text from right to left lies where the text is, without the space that hangs out.
  const FontHandle hebrew = openFont("NotoSansHebrew-Regular.ttf");
  const std::vector<GpgpFont> chain = {hebrew.get()};
  GpgpTextInfo right = textInfo(samples()[2].text, chain, 12, 100);
  right.style.underline = VK_TRUE;
  ASSERT_EQ(paper.set(right), GPGP_SUCCESS);
  ASSERT_EQ(paper.info.decorationCount, paper.info.lineCount);
  for (uint32_t i = 0; i < paper.info.lineCount; ++i) {
    EXPECT_NEAR(paper.info.decorations[i].rect.x, paper.info.lines[i].left, 0.01f);
    EXPECT_NEAR(paper.info.decorations[i].rect.width, paper.info.lines[i].width, 0.01f);
    EXPECT_NEAR(paper.info.lines[i].left + paper.info.lines[i].width, 100, 0.01f); // aligned at its start
  }
}

TEST(TextLayout, AnEllipsisHasTheStyleBeforeIt) {
  GPGP_NEEDS_FONTS();
  const FontHandle font = openFont("DejaVuSans.ttf");
  const std::vector<GpgpFont> fonts = {font.get()};
  const std::string text = "small text here BIGWORD and more";
  GpgpTextInfo info = textInfo(text, fonts, 20);
  GpgpTextSpan span = {16, 23, info.style};
  span.style.size = 60;
  span.style.color[0] = 1;
  span.style.underline = VK_TRUE;
  info.spans = &span;
  info.spanCount = 1;
  info.maxLines = 1;
  Paper paper;
  std::set<uint32_t> seen;
  for (float width = 5; width < 560; width += 7) {
    SCOPED_TRACE(width);
    info.width = width;
    ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
    ASSERT_TRUE(paper.info.truncated);
    const GpgpTextLine& line = paper.info.lines[0];
    const GpgpTextGlyph& ellipsis = paper.info.glyphs[paper.info.glyphCount - 1];
    const uint32_t last = line.end > 0 ? line.end - 1 : 0, style = last >= 16 && last < 23;
    EXPECT_EQ(ellipsis.span, style);
    EXPECT_EQ(ellipsis.size, style ? 60 : 20);
    EXPECT_EQ(ellipsis.color[0], style ? 1 : 0);
    EXPECT_EQ(paper.info.decorationCount, line.end > 16 ? 1u : 0u);
    EXPECT_NEAR(line.ascent, (line.end > 16 ? 60 : 20) * infoOf(font.get()).ascent, 0.01f);
    if (line.end > 0) { // but for the ellipsis alone, which is whole
      EXPECT_LE(line.width, width + 0.02f);
    }
    seen.insert(line.end <= 16 ? 0 : line.end <= 23 ? 1 : 2);
  }
  EXPECT_EQ(seen.size(), 3u); // cut before, within and behind the word
  // Nothing of the line is kept: the style of its first.
  span.begin = 0;
  info.width = 5;
  ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
  ASSERT_EQ(paper.info.glyphCount, 1u);
  EXPECT_EQ(paper.info.glyphs[0].size, 60);
}

TEST(TextLayout, AnEllipsisIsOrderedAndFindsItsFonts) {
  GPGP_NEEDS_FONTS();
  const FontHandle mono = openFont("DejaVuSansMono.ttf"), sans = openFont("DejaVuSans.ttf");
  const std::string latin = "some words that do not fit",
                    hebrew = "\u05e9\u05dc\u05d5\u05dd \u05e2\u05d5\u05dc\u05dd \u05e9\u05dc\u05d5\u05dd";
  Paper paper;
  const auto xOf = [&](char32_t character, GpgpFont font) { // of its last glyph
    uint32_t id = 0;
    EXPECT_EQ(gpgpGetNominalGlyph(font, character, &id), GPGP_SUCCESS);
    float x = -1;
    for (uint32_t i = 0; i < paper.info.glyphCount; ++i)
      if (paper.info.glyphs[i].font == font && paper.info.glyphs[i].glyph == id) x = paper.info.glyphs[i].x;
    EXPECT_GE(x, 0) << uint32_t(character);
    return x;
  };
  const auto set = [&](const std::string& text, const std::vector<GpgpFont>& fonts, const char* ellipsis) {
    GpgpTextInfo info = textInfo(text, fonts, 20, 110);
    info.maxLines = 1;
    info.ellipsis = ellipsis;
    ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
    ASSERT_TRUE(paper.info.truncated);
    EXPECT_LE(paper.info.width, 110.02f);
  };
  // Numbers and Latin letters stay as they are in a line from right to left, left of it.
  set(hebrew, {sans.get()}, " [m12]");
  EXPECT_LT(xOf('m', sans.get()), xOf('1', sans.get()));
  EXPECT_LT(xOf('1', sans.get()), xOf('2', sans.get()));
  EXPECT_LT(xOf('2', sans.get()), xOf(0x5e9, sans.get()));
  EXPECT_EQ(paper.info.missingCount, 0u);
  // And Hebrew runs from right to left in a line from left to right.
  set(latin, {sans.get()}, " \u05d0\u05d1");
  EXPECT_LT(xOf(0x5d1, sans.get()), xOf(0x5d0, sans.get()));
  EXPECT_LT(xOf('s', sans.get()), xOf(0x5d1, sans.get()));
  // Each of its characters has the font that has it.
  set(latin, {mono.get(), sans.get()}, "+\u05d0");
  EXPECT_LT(xOf('+', mono.get()), xOf(0x5d0, sans.get()));
  EXPECT_EQ(paper.info.missingCount, 0u);
  set(latin, {mono.get()}, "\n+\u65e5");
  ASSERT_EQ(paper.info.missingCount, 1u);
  EXPECT_EQ(paper.info.missing[0].character, 0x65e5u);
  EXPECT_EQ(paper.info.missing[0].offset, paper.info.lines[0].end);
}

TEST(TextLayout, TheLastLineStaysWithinTheHeight) {
  GPGP_NEEDS_FONTS();
  const FontHandle font = openFont("DejaVuSans.ttf"), arabic = openFont("NotoNaskhArabic-Regular.ttf");
  const std::vector<GpgpFont> fonts = {font.get(), arabic.get()};
  Paper paper;
  // Words that would fit the width, but are too high for what is left.
  const std::string text = "one two three four BIGWORD and more";
  GpgpTextInfo info = textInfo(text, fonts, 20);
  GpgpTextSpan span = {19, 26, info.style};
  span.style.size = 60;
  info.spans = &span;
  info.spanCount = 1;
  uint32_t refused = 0;
  for (float width = 60; width < 500; width += 9)
    for (float height = 25; height < 130; height += 5) {
      info.width = width;
      info.height = height;
      ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
      const GpgpTextLine& last = paper.info.lines[paper.info.lineCount - 1];
      if (paper.info.lineCount > 1 || last.end <= 19) {
        EXPECT_LE(paper.info.height, height + 0.02f) << "width " << width << ", height " << height;
      }
      refused += last.end <= 19;
    }
  EXPECT_GT(refused, 100u);
  // The first line stays, however high, and is as high as it was.
  info.width = 0;
  info.height = 10;
  ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
  EXPECT_FALSE(paper.info.truncated);
  // A font of the chain that is higher: its letters do not come into a line that has no room for them.
  const std::string mixed = "one two three four five six سلام سلام سلام سلام";
  const float latin = 20 * (infoOf(font.get()).ascent + infoOf(font.get()).descent),
              higher = 20 * (infoOf(arabic.get()).ascent + infoOf(arabic.get()).descent);
  ASSERT_GT(higher, latin + 1);
  info = textInfo(mixed, fonts, 20, 150);
  uint32_t cut = 0;
  for (float height = latin; height < 6 * latin; height += 1) {
    info.height = height;
    ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
    EXPECT_LE(paper.info.height, height + 0.02f);
    cut += paper.info.truncated;
  }
  EXPECT_GT(cut, 50u);
}

TEST(TextLayout, TruncatedOnlyWhereSomethingIsCut) {
  GPGP_NEEDS_FONTS();
  const FontHandle latin = openFont("NotoSans-Regular.ttf"), arabic = openFont("NotoNaskhArabic-Regular.ttf"),
                   hebrew = openFont("NotoSansHebrew-Regular.ttf"),
                   devanagari = openFont("NotoSansDevanagari-Regular.ttf");
  const std::vector<GpgpFont> fonts = {latin.get(), arabic.get(), hebrew.get(), devanagari.get()},
                              last = {devanagari.get()};
  // Marks without a letter, a random search's find: as one run they are too wide, in parts they are not.
  const std::string text = "\u0e3a\u0e39\u202c\u0e35\ufe0e\u2069\u2069\u0e3a\u2069\u0e3a\u0e39\u0e35\u0e39\u0e39\u0e38";
  GpgpTextInfo info = textInfo(text, fonts, 16);
  GpgpTextSpan span = {9, 45, textInfo(text, last, 37).style};
  info.spans = &span;
  info.spanCount = 1;
  info.direction = GPGP_TEXT_RIGHT_TO_LEFT;
  info.maxLines = 1;
  info.ellipsis = "";
  uint32_t whole = 0, cut = 0;
  Paper paper;
  for (float width = 60; width < 200; width += 1) {
    info.width = width;
    ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
    EXPECT_EQ(paper.info.truncated != 0, paper.info.lines[0].end < text.size()) << width;
    (paper.info.truncated ? cut : whole) += 1;
  }
  EXPECT_GT(whole, 10u);
  EXPECT_GT(cut, 10u);
}

TEST(TextLayout, WithoutATextThereIsNothingToAskFor) {
  Paper paper;
  EXPECT_EQ(paper.move(3, GPGP_CARET_NEXT), 0u);
  EXPECT_TRUE(paper.selection(0, 9).empty());
  EXPECT_EQ(paper.hit(1, 1).offset, 0u);
  EXPECT_EQ(paper.caret(5).line, 0u);
}

TEST(TextLayout, LinesDoNotCutGraphemes) { // though UAX #14 allows breaks before skin tones, and marks behind spaces
  GPGP_NEEDS_FONTS();
  const FontHandle latin = openFont("DejaVuSans.ttf"), emoji = openFont("NotoColorEmoji.ttf");
  const std::vector<GpgpFont> fonts = {latin.get(), emoji.get()};
  const std::string tones = "\xf0\x9f\x98\x80\xf0\x9f\x8f\xbb";
  for (const std::string& text : {tones + tones + tones, std::string("ab \xcc\x81"
                                                                     "cd ef \xe2\x80\x8d"
                                                                     "gh")})
    for (const float width : {1.0f, 15.0f, 25.0f})
      for (const uint32_t lines : {0u, 1u, 2u}) {
        Paper paper;
        GpgpTextInfo info = textInfo(text, fonts, 16, width);
        info.maxLines = lines;
        ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
        for (uint32_t i = 0; i < paper.info.lineCount; ++i) {
          const uint32_t begin = paper.info.lines[i].begin;
          EXPECT_EQ(begin % (text.size() == 24 ? 8 : 1), 0u);
          EXPECT_EQ(paper.caret(begin).line, i) << begin;
        }
      }
}

TEST(TextLayout, ALetterWithMarksWithoutEndIsLaidOut) { // by the square of their number it takes most of an hour
  GPGP_NEEDS_FONTS();
  const FontHandle font = openFont("DejaVuSans.ttf");
  constexpr uint32_t kMarks = 500000;
  std::string text = "a";
  for (uint32_t i = 0; i < kMarks; ++i) text += "\xcc\x81";
  text += "b";
  Paper paper;
  ASSERT_EQ(paper.set(textInfo(text, {font.get()}, 20, 50)), GPGP_SUCCESS);
  EXPECT_EQ(paper.info.missingCount, 0u);
  EXPECT_GE(paper.info.glyphCount, kMarks);
  EXPECT_EQ(paper.move(0, GPGP_CARET_NEXT), 1 + 2 * kMarks); // still one grapheme
  EXPECT_EQ(paper.caret(1001).x, paper.caret(0).x);
  EXPECT_GT(paper.caret(1 + 2 * kMarks).x, 0);
}

TEST(TextLayout, EachMissingCharacterIsToldOnce) { // also of a grapheme that is shaped in parts
  GPGP_NEEDS_FONTS();
  const FontHandle font = openFont("DejaVuSansMono.ttf");
  for (const uint32_t marks : {3u, 300u, 30000u}) {
    std::string text = "a";
    for (uint32_t i = 0; i < marks; ++i) text += "\u0e31";
    Paper paper;
    ASSERT_EQ(paper.set(textInfo(text, {font.get()}, 20)), GPGP_SUCCESS);
    ASSERT_EQ(paper.info.missingCount, marks);
    for (uint32_t i = 0; i < marks; ++i) ASSERT_EQ(paper.info.missing[i].offset, 1 + 3 * i);
  }
}

TEST(TextLayout, ColoursAndInvisibleCharacters) {
  GPGP_NEEDS_FONTS();
  const FontHandle font = openFont("DejaVuSans.ttf");
  const std::vector<GpgpFont> fonts = {font.get()};
  Paper paper;
  GpgpTextInfo info = textInfo("ab", fonts, 16);
  std::fill_n(info.style.color, 4, 0.0f);
  info.style.letterSpacing = 5;
  ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
  EXPECT_EQ(paper.info.glyphs[0].color[3], 1.0f); // as where nothing is said
  const float second = paper.info.glyphs[1].x;
  const std::string joined = "a\xe2\x81\xa0"
                             "b"; // U+2060
  info.text = joined.data();
  info.size = joined.size();
  ASSERT_EQ(paper.set(info), GPGP_SUCCESS);
  EXPECT_FLOAT_EQ(paper.info.glyphs[paper.info.glyphCount - 1].x, second);
  info.style.color[1] = 2;
  EXPECT_EQ(paper.set(info), GPGP_ERROR_INVALID_ARGUMENT);
}

TEST(TextLayout, RefusesWhatMakesNoSense) {
  GPGP_NEEDS_FONTS();
  FontHandle font = openFont("DejaVuSans.ttf");
  const std::vector<GpgpFont> fonts = {font.get()};
  Paper paper;
  const std::string text = "añb";
  const GpgpTextInfo good = textInfo(text, fonts, 10);
  ASSERT_EQ(paper.set(good), GPGP_SUCCESS);
  GpgpTextInfo info = good;
  const auto refused = [&](GpgpResult expected, const char* words) {
    paper.log.text.clear();
    EXPECT_EQ(paper.set(info), expected);
    EXPECT_NE(paper.log.text.find(words), std::string::npos) << paper.log.text;
    info = good;
  };
  info.style.size = 0;
  refused(GPGP_ERROR_INVALID_ARGUMENT, "style.size is 0");
  info.style.size = NAN;
  refused(GPGP_ERROR_INVALID_ARGUMENT, "style.size");
  info.style.fontCount = 0;
  refused(GPGP_ERROR_INVALID_ARGUMENT, "style has no fonts");
  info.width = -1;
  refused(GPGP_ERROR_INVALID_ARGUMENT, "width is -1");
  info.align = 9;
  refused(GPGP_ERROR_INVALID_ARGUMENT, "align is 9");
  info.sType = 0;
  refused(GPGP_ERROR_INVALID_STRUCT, "sType");
  GpgpTextSpan span = {0, 9, good.style};
  info.spans = &span;
  info.spanCount = 1;
  refused(GPGP_ERROR_INVALID_ARGUMENT, "spans[0] is bytes 0 to 9");
  span = {0, 1, good.style};
  span.style.size = -3;
  info.spans = &span;
  info.spanCount = 1;
  refused(GPGP_ERROR_INVALID_ARGUMENT, "spans[0].style.size is -3");
  // A font that is gone; the layout keeps what it had.
  EXPECT_EQ(paper.info.glyphCount, 3u);
  font.reset();
  refused(GPGP_ERROR_INVALID_HANDLE, "style.fonts[0]");
  EXPECT_EQ(paper.info.glyphCount, 3u);
  paper.shaper.reset();
  EXPECT_EQ(paper.caret(0).line, 0u);
  EXPECT_EQ(gpgpSetLayoutText(nullptr, &good), GPGP_ERROR_INVALID_HANDLE);
}
