// Carets, hit tests, selections and movement: by what must hold between them, and closed cases.
#include "fonts.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <hb-ot.h>
#include <unicode/ubrk.h>
#include <unicode/utext.h>

using namespace gpgp::test;

namespace {

std::vector<uint32_t> boundariesOf(const std::string& text, UBreakIteratorType type) {
  UErrorCode error = U_ZERO_ERROR;
  UText* opened = utext_openUTF8(nullptr, text.data(), static_cast<int64_t>(text.size()), &error);
  UBreakIterator* iterator = ubrk_open(type, "root", nullptr, 0, &error);
  ubrk_setUText(iterator, opened, &error);
  std::vector<uint32_t> found;
  for (int32_t at = ubrk_first(iterator); at != UBRK_DONE; at = ubrk_next(iterator))
    found.push_back(static_cast<uint32_t>(at));
  ubrk_close(iterator);
  utext_close(opened);
  return found;
}

class TextQuery : public testing::Test {
protected:
  void SetUp() override {
    GPGP_NEEDS_FONTS();
    for (const char* name : {"DejaVuSans.ttf", "NotoSansHebrew-Regular.ttf", "NotoNaskhArabic-Regular.ttf",
                             "NotoSansDevanagari-Regular.ttf", "NotoSansThai-Regular.ttf"})
      held_.push_back(openFont(name));
    held_.push_back(openFont("NotoSansCJK-Regular.ttc"));
    for (const FontHandle& font : held_) fonts_.push_back(font.get());
    for (const Sample& sample : samples()) texts_.push_back(sample.text);
    texts_.push_back("office affix שלום abc עולם 123 مرحبا x");
    texts_.push_back("שלום office 12.5% מחר\nabc\n\nالطريق office\n");
    texts_.push_back("a\tb אב\tגד");
  }
  std::vector<FontHandle> held_;
  std::vector<GpgpFont> fonts_;
  std::vector<std::string> texts_;
  Paper paper_;
};

} // namespace

TEST_F(TextQuery, AHitAtACaretFindsItsGrapheme) {
  uint32_t tested = 0, split = 0;
  for (const std::string& text : texts_)
    for (const float width : {0.f, 60.f, 130.f, 333.f})
      for (const GpgpTextAlign align : {GPGP_TEXT_ALIGN_START, GPGP_TEXT_ALIGN_CENTER, GPGP_TEXT_ALIGN_JUSTIFY}) {
        GpgpTextInfo info = textInfo(text, fonts_, 18, width);
        info.align = align;
        ASSERT_EQ(paper_.set(info), GPGP_SUCCESS);
        const std::vector<uint32_t> graphemes = boundariesOf(text, UBRK_CHARACTER);
        for (size_t g = 0; g + 1 < graphemes.size(); ++g) {
          const uint32_t offset = graphemes[g];
          SCOPED_TRACE(text + " in " + std::to_string(width) + " at " + std::to_string(offset));
          const GpgpCaret caret = paper_.caret(offset);
          const GpgpTextLine& line = paper_.info.lines[caret.line];
          ASSERT_TRUE(offset >= line.begin && offset < line.end);
          EXPECT_NEAR(caret.top + line.ascent, line.baseline, 0.01f);
          const auto rects = paper_.selection(offset, graphemes[g + 1]);
          const float middle = line.top + line.height / 2;
          if (rects.empty()) { // a line break: at the end of its line
            const GpgpTextHit hit = paper_.hit(caret.x, middle);
            EXPECT_EQ(hit.insertion, offset);
            continue;
          }
          // The character lies on the side that the caret says, as wide as its selection.
          ASSERT_EQ(rects.size(), 1u);
          EXPECT_NEAR(caret.rightToLeft ? rects[0].x + rects[0].width : rects[0].x, caret.x, 0.01f);
          const float inward = caret.rightToLeft ? -1.f : 1.f;
          const GpgpTextHit begin = paper_.hit(caret.x + inward * rects[0].width * 0.1f, middle);
          EXPECT_EQ(begin.offset, offset);
          EXPECT_EQ(begin.insertion, offset);
          EXPECT_FALSE(begin.trailing);
          EXPECT_TRUE(begin.inside);
          const GpgpTextHit end = paper_.hit(caret.x + inward * rects[0].width * 0.9f, middle);
          EXPECT_EQ(end.offset, offset);
          EXPECT_EQ(end.insertion, graphemes[g + 1]);
          EXPECT_TRUE(end.trailing);
          ++tested;
          split += caret.split;
          // Between graphemes of one direction and line there is one caret.
          if (g > 0 && paper_.caret(graphemes[g - 1]).line == caret.line &&
              paper_.caret(graphemes[g - 1]).rightToLeft == caret.rightToLeft && !caret.split) {
            const auto before = paper_.selection(graphemes[g - 1], offset);
            if (!before.empty()) {
              EXPECT_NEAR(caret.rightToLeft ? before[0].x : before[0].x + before[0].width, caret.x, 0.01f);
            }
          }
        }
        // Behind everything.
        const uint32_t end = static_cast<uint32_t>(text.size());
        const GpgpCaret last = paper_.caret(end);
        EXPECT_EQ(last.line, paper_.info.lineCount - 1);
        EXPECT_EQ(paper_.hit(last.x, paper_.info.height - 1).insertion, end);
      }
  EXPECT_GT(tested, 3000u);
  EXPECT_GT(split, 100u);
}

TEST_F(TextQuery, CaretsOfOneDirectionAreInOrder) {
  for (const size_t index : {0u, 1u, 2u, 3u, 4u, 5u}) {
    const std::string& text = texts_[index];
    ASSERT_EQ(paper_.set(textInfo(text, fonts_, 18)), GPGP_SUCCESS);
    const std::vector<uint32_t> graphemes = boundariesOf(text, UBRK_CHARACTER);
    const bool backwards = index == 1 || index == 2;
    EXPECT_EQ(paper_.info.lines[0].rightToLeft != 0, backwards);
    for (size_t g = 0; g + 1 < graphemes.size(); ++g) {
      const float here = paper_.caret(graphemes[g]).x, next = paper_.caret(graphemes[g + 1]).x;
      if (backwards)
        EXPECT_LT(next, here);
      else
        EXPECT_GT(next, here);
    }
  }
}

TEST_F(TextQuery, ALigatureHasCaretsWithin) {
  ASSERT_EQ(paper_.set(textInfo("xffiy", fonts_, 30)), GPGP_SUCCESS);
  ASSERT_EQ(paper_.info.glyphCount, 3u);
  const float begin = paper_.caret(1).x, end = paper_.caret(4).x;
  EXPECT_NEAR(paper_.caret(2).x, begin + (end - begin) / 3, 0.01f);
  EXPECT_NEAR(paper_.caret(3).x, begin + (end - begin) * 2 / 3, 0.01f);
  EXPECT_EQ(paper_.hit(begin + (end - begin) / 2, 1).offset, 2u);
}

TEST_F(TextQuery, CaretsWithinALigatureAreTheFonts) {
  struct Case {
    const char *font, *text; // one ligature
    bool rightToLeft;
  };
  uint32_t uneven = 0;
  for (const Case& each : {Case{"NotoSans-Regular.ttf", "ffi", false}, Case{"NotoSerif-Regular.ttf", "ffl", false},
                           Case{"NotoSansArabic-Regular.ttf", "لا", true},
                           Case{"NotoSansAvestan-Regular.ttf", "\U00010b31\U00010b00", true},
                           Case{"NotoSansAvestan-Regular.ttf", "\U00010b00\U00010b35", true}}) {
    SCOPED_TRACE(std::string(each.font) + ": " + each.text);
    const FontHandle font = openFont(each.font);
    const std::string text = each.text;
    ASSERT_EQ(paper_.set(textInfo(text, {font.get()}, 100)), GPGP_SUCCESS);
    ASSERT_EQ(paper_.info.glyphCount, 1u);
    hb_blob_t* blob = hb_blob_create_from_file(fontPath(each.font).c_str());
    hb_face_t* face = hb_face_create(blob, 0);
    hb_font_t* theirs = hb_font_create(face);
    hb_position_t places[8];
    unsigned count = 8;
    hb_ot_layout_get_ligature_carets(theirs, HB_DIRECTION_LTR, paper_.info.glyphs[0].glyph, 0, &count, places);
    const float em = 100 / static_cast<float>(hb_face_get_upem(face));
    hb_font_destroy(theirs);
    hb_face_destroy(face);
    hb_blob_destroy(blob);
    const std::vector<uint32_t> graphemes = boundariesOf(text, UBRK_CHARACTER);
    ASSERT_EQ(count + 2, graphemes.size());
    const float width = paper_.info.lines[0].width, middle = paper_.info.height / 2;
    for (unsigned k = 0; k < count; ++k) {
      const uint32_t g = each.rightToLeft ? count - k : k + 1; // carets count from the left
      const float expected = static_cast<float>(places[k]) * em;
      const GpgpCaret caret = paper_.caret(graphemes[g]);
      EXPECT_NEAR(caret.x, expected, 0.02f);
      EXPECT_FALSE(caret.split);
      uneven += std::abs(expected - width * static_cast<float>(k + 1) / static_cast<float>(count + 1)) > 0.5f;
      // Selections end there, and a point on either side is on either grapheme.
      const auto before = paper_.selection(0, graphemes[g]);
      ASSERT_EQ(before.size(), 1u);
      EXPECT_NEAR(each.rightToLeft ? before[0].x : before[0].x + before[0].width, expected, 0.02f);
      const uint32_t left = each.rightToLeft ? graphemes[g] : graphemes[g - 1];
      const uint32_t right = each.rightToLeft ? graphemes[g - 1] : graphemes[g];
      EXPECT_EQ(paper_.hit(expected - 0.1f, middle).offset, left);
      EXPECT_EQ(paper_.hit(expected + 0.1f, middle).offset, right);
    }
  }
  EXPECT_GE(uneven, 2u); // else it might be by even parts as well
}

TEST_F(TextQuery, CaretsSplitWhereDirectionsMeet) {
  // Seen: a b ג ב א
  const std::string text = "abאבג";
  ASSERT_EQ(paper_.set(textInfo(text, fonts_, 18)), GPGP_SUCCESS);
  const GpgpCaret meet = paper_.caret(2);
  const float right = paper_.info.lines[0].left + paper_.info.lines[0].width;
  EXPECT_TRUE(meet.split);
  EXPECT_NEAR(meet.x, right, 0.01f); // before alef, which is at the right end
  EXPECT_TRUE(meet.rightToLeft);
  EXPECT_NEAR(meet.splitX, paper_.selection(0, 2)[0].width, 0.01f); // behind b
  EXPECT_FALSE(meet.splitRightToLeft);
  const GpgpCaret end = paper_.caret(8);
  EXPECT_TRUE(end.split);
  EXPECT_NEAR(end.x, right, 0.01f);
  EXPECT_FALSE(end.rightToLeft);
  EXPECT_NEAR(end.splitX, meet.splitX, 0.01f); // behind gimel, the leftmost
  EXPECT_TRUE(end.splitRightToLeft);
  // A selection across: what is between b and bet is in two places.
  const auto rects = paper_.selection(1, 4);
  ASSERT_EQ(rects.size(), 2u);
  EXPECT_LT(rects[0].x + rects[0].width, rects[1].x);
  EXPECT_NEAR(rects[1].x + rects[1].width, right, 0.01f);
}

TEST_F(TextQuery, SelectionsAddUp) {
  std::mt19937 random(11);
  const auto area = [&](uint32_t begin, uint32_t end) {
    double sum = 0;
    for (const GpgpTextRect& rect : paper_.selection(begin, end)) sum += double(rect.width) * double(rect.height);
    return sum;
  };
  for (const std::string& text : texts_) {
    ASSERT_EQ(paper_.set(textInfo(text, fonts_, 18, 150)), GPGP_SUCCESS);
    const std::vector<uint32_t> graphemes = boundariesOf(text, UBRK_CHARACTER);
    const uint32_t size = static_cast<uint32_t>(text.size());
    const double all = area(0, size);
    EXPECT_GT(all, 100);
    for (int run = 0; run < 30; ++run) {
      const uint32_t cut = graphemes[random() % graphemes.size()];
      EXPECT_NEAR(area(0, cut) + area(cut, size), all, all * 1e-4) << text << " cut at " << cut;
      const auto rects = paper_.selection(cut, size);
      for (size_t i = 1; i < rects.size(); ++i) // from left to right, line by line, none over another
        EXPECT_TRUE(rects[i].y > rects[i - 1].y || rects[i].x >= rects[i - 1].x + rects[i - 1].width - 0.01f);
    }
    EXPECT_TRUE(paper_.selection(3, 3).empty());
    EXPECT_TRUE(paper_.selection(5, 2).empty());
  }
  ASSERT_EQ(paper_.set(textInfo("abאבג", fonts_, 18)), GPGP_SUCCESS);
  uint32_t count = 1;
  GpgpTextRect one{};
  EXPECT_EQ(gpgpGetSelection(paper_.layout.get(), 1, 4, &count, &one), GPGP_INCOMPLETE);
  EXPECT_EQ(count, 2u);
  EXPECT_GT(one.width, 0);
}

TEST_F(TextQuery, PointsBesideALineGoToItsEnds) {
  ASSERT_EQ(paper_.set(textInfo("aaa bbb\nשלום\n\nccc", fonts_, 18)), GPGP_SUCCESS);
  const auto middle = [&](uint32_t line) { return paper_.info.lines[line].top + paper_.info.lines[line].height / 2; };
  EXPECT_EQ(paper_.hit(-50, middle(0)).insertion, 0u);
  EXPECT_EQ(paper_.hit(1000, middle(0)).insertion, 7u);
  EXPECT_FALSE(paper_.hit(1000, middle(0)).inside);
  EXPECT_EQ(paper_.hit(1000, middle(1)).insertion, 8u); // from right to left
  EXPECT_EQ(paper_.hit(-50, middle(1)).insertion, 16u);
  EXPECT_EQ(paper_.hit(3, middle(2)).insertion, 17u); // an empty line
  EXPECT_EQ(paper_.hit(3, middle(2)).line, 2u);
  EXPECT_EQ(paper_.hit(1000, middle(3)).insertion, 21u);
  EXPECT_EQ(paper_.hit(1, -100).line, 0u);
  EXPECT_EQ(paper_.hit(1, 1000).line, 3u);
  EXPECT_FALSE(paper_.hit(1, 1000).inside);
  EXPECT_EQ(gpgpHitTestLayout(paper_.layout.get(), NAN, 0, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
}

TEST_F(TextQuery, CaretsMoveByGraphemesAndWords) {
  for (const std::string& text : texts_) {
    ASSERT_EQ(paper_.set(textInfo(text, fonts_, 18)), GPGP_SUCCESS);
    const std::vector<uint32_t> graphemes = boundariesOf(text, UBRK_CHARACTER);
    for (size_t g = 0; g + 1 < graphemes.size(); ++g) {
      EXPECT_EQ(paper_.move(graphemes[g], GPGP_CARET_NEXT), graphemes[g + 1]);
      EXPECT_EQ(paper_.move(graphemes[g + 1], GPGP_CARET_PREVIOUS), graphemes[g]);
    }
    const std::vector<uint32_t> words = boundariesOf(text, UBRK_WORD);
    for (size_t w = 0; w + 1 < words.size(); ++w) {
      EXPECT_EQ(paper_.move(words[w], GPGP_CARET_WORD_END), words[w + 1]);
      EXPECT_EQ(paper_.move(words[w], GPGP_CARET_WORD_BEGIN), words[w]);
    }
  }
  const std::string text = "one, two  three\nfour";
  ASSERT_EQ(paper_.set(textInfo(text, fonts_, 18)), GPGP_SUCCESS);
  EXPECT_EQ(paper_.move(0, GPGP_CARET_NEXT_WORD), 5u);
  EXPECT_EQ(paper_.move(6, GPGP_CARET_NEXT_WORD), 10u);
  EXPECT_EQ(paper_.move(10, GPGP_CARET_NEXT_WORD), 16u);
  EXPECT_EQ(paper_.move(17, GPGP_CARET_NEXT_WORD), 20u);
  EXPECT_EQ(paper_.move(20, GPGP_CARET_NEXT), 20u);
  EXPECT_EQ(paper_.move(12, GPGP_CARET_PREVIOUS_WORD), 10u);
  EXPECT_EQ(paper_.move(10, GPGP_CARET_PREVIOUS_WORD), 5u);
  EXPECT_EQ(paper_.move(2, GPGP_CARET_PREVIOUS_WORD), 0u);
  EXPECT_EQ(paper_.move(0, GPGP_CARET_PREVIOUS), 0u);
  EXPECT_EQ(paper_.move(7, GPGP_CARET_LINE_BEGIN), 0u);
  EXPECT_EQ(paper_.move(7, GPGP_CARET_LINE_END), 15u);
  EXPECT_EQ(paper_.move(18, GPGP_CARET_LINE_BEGIN), 16u);
  EXPECT_EQ(paper_.move(18, GPGP_CARET_LINE_END), 20u);
  EXPECT_EQ(paper_.move(99, GPGP_CARET_PREVIOUS), 19u);
  uint32_t moved = 0;
  EXPECT_EQ(gpgpMoveCaret(paper_.layout.get(), 0, 77, &moved, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
}

TEST_F(TextQuery, ACaretWhereALineWrapsIsOnEitherLine) {
  // "Hello ", "big ", "world ", "again"
  ASSERT_EQ(paper_.set(textInfo("Hello big world again", fonts_, 16, 60)), GPGP_SUCCESS);
  ASSERT_EQ(paper_.info.lineCount, 4u);
  EXPECT_EQ(paper_.caret(6).line, 1u);
  const GpgpCaret first = paper_.caret(6, 1);
  EXPECT_EQ(first.line, 0u);
  EXPECT_LT(first.top, paper_.caret(6).top);
  EXPECT_NEAR(first.x, paper_.selection(0, 6)[0].width, 0.01f);
  EXPECT_EQ(paper_.move(1, GPGP_CARET_LINE_END), 5u); // before the space
  EXPECT_EQ(paper_.move(5, GPGP_CARET_LINE_END), 5u);
  EXPECT_EQ(paper_.move(6, GPGP_CARET_LINE_END), 9u);
  EXPECT_EQ(paper_.move(16, GPGP_CARET_LINE_END), 21u);
  VkBool32 trailing = 1;
  EXPECT_EQ(paper_.move(6, GPGP_CARET_LINE_BEGIN, &trailing), 0u);
  EXPECT_FALSE(trailing);
  trailing = 1;
  EXPECT_EQ(paper_.move(6, GPGP_CARET_NEXT, &trailing), 7u);
  EXPECT_FALSE(trailing);

  // Behind a line break, at a text's begin and within a line there is one caret only.
  ASSERT_EQ(paper_.set(textInfo("ab\n\ncd\n", fonts_, 16, 60)), GPGP_SUCCESS);
  for (uint32_t offset = 0; offset <= 7; ++offset) {
    EXPECT_EQ(paper_.caret(offset, 1).line, paper_.caret(offset).line);
    EXPECT_EQ(paper_.caret(offset, 1).x, paper_.caret(offset).x);
  }

  // Within a word, with an ellipsis, in every script: a line's end is on the line and stays, a hit's caret is where it
  // was hit.
  uint32_t wraps = 0, spaces = 0;
  for (const std::string& text : texts_)
    for (const float width : {3.f, 30.f, 60.f, 130.f})
      for (const uint32_t lines : {0u, 2u}) {
        GpgpTextInfo info = textInfo(text, fonts_, 16, width);
        info.maxLines = lines;
        ASSERT_EQ(paper_.set(info), GPGP_SUCCESS);
        const auto hasCaret = [&](uint32_t offset, VkBool32 behind, uint32_t line) {
          EXPECT_EQ(paper_.caret(offset, behind).line, line);
          VkBool32 again = behind;
          EXPECT_EQ(paper_.move(offset, GPGP_CARET_LINE_BEGIN, &again), paper_.info.lines[line].begin);
          EXPECT_FALSE(again);
        };
        for (const uint32_t offset : boundariesOf(text, UBRK_CHARACTER)) {
          SCOPED_TRACE(text + " in " + std::to_string(width) + " at " + std::to_string(offset));
          const uint32_t line = paper_.caret(offset).line;
          VkBool32 ends = 0;
          const uint32_t end = paper_.move(offset, GPGP_CARET_LINE_END, &ends);
          hasCaret(end, ends, line);
          VkBool32 again = ends;
          EXPECT_EQ(paper_.move(end, GPGP_CARET_LINE_END, &again), end);
          EXPECT_EQ(again, ends);
          wraps += ends;
          spaces += !ends && !paper_.info.lines[line].hardBreak;
        }
        for (uint32_t line = 0; line < paper_.info.lineCount; ++line) {
          const GpgpTextLine& placed = paper_.info.lines[line];
          for (float x = placed.left - 10; x < placed.left + placed.width + 20; x += 1.7f) {
            SCOPED_TRACE(text + " in " + std::to_string(width) + " hit at " + std::to_string(x));
            const GpgpTextHit hit = paper_.hit(x, placed.top + placed.height / 2);
            ASSERT_EQ(hit.line, line);
            hasCaret(hit.insertion, hit.trailing, line);
          }
        }
      }
  EXPECT_GT(wraps, 100u);
  EXPECT_GT(spaces, 100u);
}
