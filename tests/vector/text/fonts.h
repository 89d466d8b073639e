// What tests of text share: fonts out of tests/data/fetched/fonts, layouts that free themselves, and sentences.
#pragma once
#include <gpgp/text.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

namespace gpgp::test {

inline std::string fontPath(const std::string& name) { return std::string(GPGP_TEST_DATA) + "/fetched/fonts/" + name; }

#define GPGP_NEEDS_FONTS()                                                                                             \
  if (!std::filesystem::exists(gpgp::test::fontPath("Inter-roman.var.ttf")))                                           \
  GTEST_SKIP() << "needs fonts: tests/data/fetch.sh --only fonts"

struct Destroy {
  void operator()(GpgpFont font) const { gpgpDestroyFont(font); }
  void operator()(GpgpShaper shaper) const { gpgpDestroyShaper(shaper); }
  void operator()(GpgpLayout layout) const { gpgpDestroyLayout(layout); }
};
template <class T> using Held = std::unique_ptr<std::remove_pointer_t<T>, Destroy>;
using FontHandle = Held<GpgpFont>;

/// The last message.
struct Log {
  std::string text;
  static void GPGP_CALL take(void* user, const GpgpMessage* message) {
    static_cast<Log*>(user)->text = std::string(message->function) + ": " + message->text;
  }
};

inline Log fontLog; ///< of all that openFont opens: it outlives them

inline FontHandle openFont(const std::string& name, uint32_t face = 0, std::vector<GpgpFontAxisValue> axes = {}) {
  GpgpFontCreateInfo info = GPGP_FONT_CREATE_INFO_INIT;
  const std::string path = fontPath(name);
  info.filePath = path.c_str();
  info.face = face;
  info.axes = axes.data();
  info.axisCount = static_cast<uint32_t>(axes.size());
  info.messageFn = Log::take;
  info.messageUserData = &fontLog;
  GpgpFont font = nullptr;
  EXPECT_EQ(gpgpCreateFont(&info, &font), GPGP_SUCCESS) << name << ": " << fontLog.text;
  return FontHandle(font);
}

inline GpgpFontInfo infoOf(GpgpFont font) {
  GpgpFontInfo info = GPGP_FONT_INFO_INIT;
  EXPECT_EQ(gpgpGetFontInfo(font, &info), GPGP_SUCCESS);
  return info;
}

inline std::vector<char> bytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A shaper and a layout, and the text that was laid out last.
struct Paper {
  Held<GpgpShaper> shaper;
  Held<GpgpLayout> layout;
  GpgpLayoutInfo info = GPGP_LAYOUT_INFO_INIT;
  Log log;

  explicit Paper(size_t cacheBytes = 0) {
    GpgpShaperCreateInfo create = GPGP_SHAPER_CREATE_INFO_INIT;
    create.cacheBytes = cacheBytes;
    create.messageFn = Log::take;
    create.messageUserData = &log;
    GpgpShaper made = nullptr;
    EXPECT_EQ(gpgpCreateShaper(&create, &made), GPGP_SUCCESS);
    shaper.reset(made);
    GpgpLayout page = nullptr;
    EXPECT_EQ(gpgpCreateLayout(made, &page), GPGP_SUCCESS);
    layout.reset(page);
  }
  GpgpResult set(const GpgpTextInfo& text) {
    const GpgpResult result = gpgpSetLayoutText(layout.get(), &text);
    EXPECT_EQ(gpgpGetLayoutInfo(layout.get(), &info), GPGP_SUCCESS);
    return result;
  }
  GpgpCaret caret(uint32_t offset, VkBool32 trailing = 0) const {
    GpgpCaret caret{};
    EXPECT_EQ(gpgpGetCaret(layout.get(), offset, trailing, &caret), GPGP_SUCCESS);
    return caret;
  }
  GpgpTextHit hit(float x, float y) const {
    GpgpTextHit hit{};
    EXPECT_EQ(gpgpHitTestLayout(layout.get(), x, y, &hit), GPGP_SUCCESS);
    return hit;
  }
  uint32_t move(uint32_t offset, GpgpCaretMove move, VkBool32* trailing = nullptr) const {
    uint32_t moved = ~0u;
    EXPECT_EQ(gpgpMoveCaret(layout.get(), offset, move, &moved, trailing), GPGP_SUCCESS);
    return moved;
  }
  std::vector<GpgpTextRect> selection(uint32_t begin, uint32_t end) const {
    uint32_t count = 0;
    EXPECT_EQ(gpgpGetSelection(layout.get(), begin, end, &count, nullptr), GPGP_SUCCESS);
    std::vector<GpgpTextRect> rects(count);
    EXPECT_EQ(gpgpGetSelection(layout.get(), begin, end, &count, rects.data()), GPGP_SUCCESS);
    return rects;
  }
};

/// A text in one style. `fonts` and `text` must live on.
inline GpgpTextInfo textInfo(std::string_view text, const std::vector<GpgpFont>& fonts, float size, float width = 0) {
  GpgpTextInfo info = GPGP_TEXT_INFO_INIT;
  info.text = text.data();
  info.size = text.size();
  info.style.fonts = fonts.data();
  info.style.fontCount = static_cast<uint32_t>(fonts.size());
  info.style.size = size;
  info.style.color[3] = 1;
  info.width = width;
  return info;
}

/// Sentences of our own, with a font that has each.
struct Sample {
  const char *name, *font, *language, *text;
  uint32_t face = 0;
};
inline const std::vector<Sample>& samples() {
  static const std::vector<Sample> all = {
      {"Latin", "DejaVuSans.ttf", "en",
       "The office staff found five fluffy waffles. AVAT To. Vy, and left without another word."},
      {"Arabic", "NotoNaskhArabic-Regular.ttf", "ar", "الأبواب مفتوحة في الصباح، والناس يمشون ببطء على الطريق الطويل."},
      {"Hebrew", "NotoSansHebrew-Regular.ttf", "he", "החלון פתוח בבוקר, ואנשים הולכים לאט בדרך הארוכה."},
      {"Devanagari", "NotoSansDevanagari-Regular.ttf", "hi",
       "सुबह खिड़की खुली है और लोग लंबी सड़क पर धीरे चलते हैं। क्षत्रिय श्रृंखला।"},
      {"Thai", "NotoSansThai-Regular.ttf", "th", "ตอนเช้าหน้าต่างเปิดอยู่และผู้คนเดินช้าๆบนถนนที่ยาวไกลน้ำ"},
      {"Japanese", "NotoSansCJK-Regular.ttc", "ja",
       "朝、窓は開いていて、人々は長い道をゆっくり歩いています。「カタカナ」も少し。"},
      {"Greek", "NotoSans-Regular.ttf", "el", "Το πρωί το παράθυρο είναι ανοιχτό και ο δρόμος μακρύς."}};
  return all;
}

} // namespace gpgp::test
