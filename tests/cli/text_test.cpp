// `gpgp text`: counts that the fonts fix, seven scripts with what falls back, a picture beside the same outlines drawn
// as paths by cairo, pixels of emoji and lines, and what is said about bad input.
#include "files.h"
#include "host/picture.h"
#include "run.h"

#include <algorithm>
#include <cmath>

#ifdef GPGP_TEST_CAIRO
#include <cairo.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H
#endif

namespace gpgp::test {
namespace {

std::string font(const std::string& name) { return std::string(GPGP_TEST_DATA) + "/fetched/fonts/" + name; }

struct CliText : testing::Test {
  void SetUp() override {
    if (!std::filesystem::exists(font("NotoColorEmoji.ttf")))
      GTEST_SKIP() << "needs fonts: tests/data/fetch.sh --only fonts";
  }
  const std::string sans = font("DejaVuSans.ttf");
  const TemporaryFile picture{std::string("text.png")};
  json draw(const std::string& text, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"text", sans, text, picture.path()});
    return gpgpJson(more);
  }
  host::Picture seen() const { return host::readPng(picture.path()); }
};

/// Pixels with some ink, on a clear background.
size_t inked(const host::Picture& picture) {
  size_t count = 0;
  for (size_t i = 3; i < picture.rgba.size(); i += 4) count += picture.rgba[i] > 0;
  return count;
}

TEST_F(CliText, OneObjectAndAPicture) {
  const json drawn = draw("Hello", {"--size", "20", "--repeat", "3", "--validate"});
  EXPECT_EQ(keys(drawn), (std::set<std::string>{"command", "ok", "device", "status", "glyphs", "lines", "width",
                                                "height", "shape_ms", "gpu_ms_median", "missing", "image"}));
  EXPECT_EQ(drawn["status"], "GPGP_SUCCESS");
  EXPECT_EQ(drawn["glyphs"], 5);
  EXPECT_EQ(drawn["lines"], 1);
  EXPECT_EQ(drawn["missing"], json::array());
  EXPECT_GT(drawn["shape_ms"], 0);
  EXPECT_GT(drawn["gpu_ms_median"], 0);
  const host::Picture shown = seen();
  EXPECT_EQ(drawn["width"], shown.width);
  EXPECT_EQ(drawn["height"], shown.height);
  // Advances of the font, in 2048 an em: H 1540, e 1260, l 569 twice, o 1253; a margin of 3 pixels on each side.
  EXPECT_NEAR(drawn["width"].get<double>(), 6 + 20 * 5191 / 2048., 1.001);
  const size_t ink = inked(shown);
  EXPECT_GT(ink, shown.rgba.size() / 4 / 20);
  EXPECT_LT(ink, shown.rgba.size() / 4 / 2);
  for (uint32_t x = 0; x < shown.width; ++x) EXPECT_EQ(shown.rgba[x * 4 + 3], 0) << "the margin is clear";
}

TEST_F(CliText, FeaturesChooseGlyphs) {
  EXPECT_EQ(draw("fi")["glyphs"], 1);
  EXPECT_EQ(draw("fi", {"--features", "liga=0"})["glyphs"], 2);
  EXPECT_EQ(draw("fi", {"--features", "kern,liga=0"})["glyphs"], 2);
}

TEST_F(CliText, LinesBreakToFit) {
  EXPECT_EQ(draw("one two three", {"--size", "20"})["lines"], 1);
  EXPECT_EQ(draw("one\ntwo\nthree", {"--size", "20"})["lines"], 3);
  const json narrow = draw("one two three", {"--size", "20", "--width", "60"});
  EXPECT_EQ(narrow["lines"], 3);
  EXPECT_EQ(narrow["width"], 66);
  const auto firstInk = [this] {
    const host::Picture shown = seen();
    uint32_t first = shown.width;
    for (uint32_t i = 0; i < shown.width * shown.height; ++i)
      if (shown.rgba[size_t{i} * 4 + 3]) first = std::min(first, i % shown.width);
    return first;
  };
  draw("i", {"--width", "200"});
  EXPECT_LT(firstInk(), 12u);
  draw("i", {"--width", "200", "--align", "right"});
  EXPECT_GT(firstInk(), 190u);
  draw("i", {"--width", "200", "--direction", "rtl"});
  EXPECT_GT(firstInk(), 190u);
  draw("i", {"--width", "200", "--align", "center"});
  EXPECT_NEAR(firstInk(), 103, 4);
}

TEST_F(CliText, WhatNoFontHasIsNamedOnce) {
  const ProcessResult result = gpgp({"text", sans, "a\u0915b\u0915\U0001F98A", picture.path(), "--json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(json::parse(result.out, nullptr, false)["missing"], json({"U+0915", "U+1F98A"}));
  EXPECT_NE(result.err.find("U+0915, U+1F98A"), std::string::npos) << result.err;
  EXPECT_EQ(draw("a\u0915b", {"--fallback", font("NotoSansDevanagari-Regular.ttf")})["missing"], json::array());
}

TEST_F(CliText, SevenScriptsWithFontsThatFallBack) {
  const struct {
    const char *text, *fallback;
    uint32_t glyphs; ///< at least; 0: none of what is special
  } scripts[] = {{"The office, ffi", nullptr, 12},
                 {"الأبواب مفتوحة في الصباح", "NotoNaskhArabic-Regular.ttf", 18},
                 {"החלון פתוח בבוקר", "NotoSansHebrew-Regular.ttf", 16},
                 {"सुबह खिड़की क्षत्रिय श्रृंखला", "NotoSansDevanagari-Regular.ttf", 16},
                 {"ตอนเช้าหน้าต่างเปิดอยู่น้ำ", "NotoSansThai-Regular.ttf", 20},
                 {"朝、窓は「カタカナ」も少し。", "NotoSansCJK-Regular.ttc", 14},
                 {"Το πρωί το παράθυρο", nullptr, 19}};
  for (const auto& script : scripts) {
    std::vector<std::string> more = {"--size", "24"};
    if (script.fallback) more.insert(more.end(), {"--fallback", font(script.fallback)});
    const json drawn = draw(script.text, more);
    EXPECT_EQ(drawn["missing"], json::array()) << script.text;
    EXPECT_GE(drawn["glyphs"], script.glyphs) << script.text;
    EXPECT_GT(inked(seen()), drawn["glyphs"].get<size_t>() * 20) << script.text;
  }
  const json all = draw("office الأبواب हिन्दी", {"--fallback", font("NotoNaskhArabic-Regular.ttf"), "--fallback",
                                                 font("NotoSansDevanagari-Regular.ttf")});
  EXPECT_EQ(all["missing"], json::array());
}

TEST_F(CliText, BitmapGlyphsArePainted) {
  // A red heart, a green one and a blue one, 40 pixels an em: colours come from the font's pictures.
  const json drawn = gpgpJson({"text", font("NotoColorEmoji.ttf"), "\u2764\uFE0F\U0001F49A\U0001F499", picture.path(),
                               "--size", "40", "--background", "white", "--validate"});
  EXPECT_EQ(drawn["glyphs"], 3);
  const host::Picture shown = seen();
  for (uint32_t k = 0; k < 3; ++k) {
    const uint32_t x = static_cast<uint32_t>((2.0 * k + 1) / 6 * shown.width);
    const uint8_t* p = &shown.rgba[(size_t{shown.height / 2} * shown.width + x) * 4];
    const uint32_t strongest = static_cast<uint32_t>(std::max_element(p, p + 3) - p);
    EXPECT_EQ(strongest, k) << int(p[0]) << ' ' << int(p[1]) << ' ' << int(p[2]);
    EXPECT_LT(*std::min_element(p, p + 3), 100);
  }
}

TEST_F(CliText, ColoursAndLines) {
  // An underlined space: a rectangle in the text's colour, on a background.
  draw("\u00A0\u00A0", {"--size", "64", "--underline", "--color", "#ff8000", "--background", "#0000ff"});
  const host::Picture shown = seen();
  size_t line = 0, behind = 0;
  for (size_t i = 0; i < shown.rgba.size(); i += 4) {
    const uint8_t* p = &shown.rgba[i];
    line += p[0] == 255 && p[1] == 128 && p[2] == 0 && p[3] == 255;
    behind += p[0] == 0 && p[1] == 0 && p[2] == 255 && p[3] == 255;
  }
  // Two spaces of 651 / 2048 em; 90 / 2048 em thick, whole rows of it.
  EXPECT_NEAR(double(line), 2 * 64 * 651 / 2048. * (64 * 90 / 2048. - 1), 50);
  EXPECT_GT(behind, shown.rgba.size() / 4 * 9 / 10);
  draw("\u00A0\u00A0", {"--size", "64"});
  EXPECT_EQ(inked(seen()), 0u);
}

TEST_F(CliText, AnEmptyTextIsAPictureToo) {
  const json drawn = draw("", {"--validate"});
  EXPECT_EQ(drawn["glyphs"], 0);
  EXPECT_EQ(drawn["lines"], 1);
  EXPECT_EQ(inked(seen()), 0u);
}

#ifdef GPGP_TEST_CAIRO
/// Letters side by side by the font's own advances, their outlines filled by cairo, black on white.
host::Picture byCairo(const std::string& file, const std::string& text, double size, double x, double y, uint32_t width,
                      uint32_t height) {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  EXPECT_EQ(FT_Init_FreeType(&library), 0);
  EXPECT_EQ(FT_New_Face(library, file.c_str(), 0, &face), 0);
  cairo_surface_t* surface =
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width), static_cast<int>(height));
  cairo_t* cairo = cairo_create(surface);
  cairo_set_source_rgb(cairo, 1, 1, 1);
  cairo_paint(cairo);
  cairo_set_source_rgb(cairo, 0, 0, 0);
  cairo_set_tolerance(cairo, 0.01);
  cairo_set_antialias(cairo, CAIRO_ANTIALIAS_BEST);
  for (const char c : text) {
    EXPECT_EQ(FT_Load_Char(face, static_cast<FT_ULong>(c), FT_LOAD_NO_SCALE | FT_LOAD_NO_HINTING), 0);
    struct Pen {
      cairo_t* cairo;
      double x, y, scale;
      void point(const FT_Vector* v, double& px, double& py) const {
        px = x + static_cast<double>(v->x) * scale;
        py = y - static_cast<double>(v->y) * scale;
      }
    } pen{cairo, x, y, size / face->units_per_EM};
    FT_Outline_Funcs functions{};
    functions.move_to = [](const FT_Vector* to, void* user) {
      double px = 0, py = 0;
      static_cast<Pen*>(user)->point(to, px, py);
      cairo_move_to(static_cast<Pen*>(user)->cairo, px, py);
      return 0;
    };
    functions.line_to = [](const FT_Vector* to, void* user) {
      double px = 0, py = 0;
      static_cast<Pen*>(user)->point(to, px, py);
      cairo_line_to(static_cast<Pen*>(user)->cairo, px, py);
      return 0;
    };
    functions.conic_to = [](const FT_Vector* control, const FT_Vector* to, void* user) {
      const Pen& p = *static_cast<Pen*>(user);
      double x0 = 0, y0 = 0, x1 = 0, y1 = 0, x2 = 0, y2 = 0;
      cairo_get_current_point(p.cairo, &x0, &y0);
      p.point(control, x1, y1);
      p.point(to, x2, y2);
      cairo_curve_to(p.cairo, x0 + (x1 - x0) * 2 / 3, y0 + (y1 - y0) * 2 / 3, x2 + (x1 - x2) * 2 / 3,
                     y2 + (y1 - y2) * 2 / 3, x2, y2);
      return 0;
    };
    EXPECT_EQ(FT_Outline_Decompose(&face->glyph->outline, &functions, &pen), 0);
    cairo_fill(cairo);
    x += static_cast<double>(face->glyph->advance.x) * pen.scale;
  }
  cairo_surface_flush(surface);
  host::Picture picture{width, height, std::vector<uint8_t>(size_t{width} * height * 4, 255)};
  const int stride = cairo_image_surface_get_stride(surface);
  for (uint32_t row = 0; row < height; ++row)
    for (uint32_t column = 0; column < width; ++column)
      for (size_t k = 0; k < 3; ++k)
        picture.rgba[(size_t{row} * width + column) * 4 + k] =
            cairo_image_surface_get_data(surface)[row * static_cast<uint32_t>(stride) + column * 4];
  cairo_destroy(cairo);
  cairo_surface_destroy(surface);
  FT_Done_Face(face);
  FT_Done_FreeType(library);
  return picture;
}

TEST_F(CliText, IsThePictureThatCairoMakesOfFreeTypesOutlines) {
  const std::string text = "Quick brown waffles, 0123 & more (jumpy)";
  for (const double size : {12.0, 37.5}) {
    draw(text, {"--size", std::to_string(size), "--features", "kern=0,liga=0,clig=0", "--background", "white"});
    const host::Picture ours = seen();
    // The margin, and the font's ascent of 1901 / 2048 em above the baseline.
    const double margin = std::ceil(std::max(2.0, size / 8));
    const host::Picture theirs =
        byCairo(sans, text, size, margin, margin + size * 1901 / 2048, ours.width, ours.height);
    const host::PictureDifference off = host::compare(ours, theirs);
    double ink = 0;
    for (const uint8_t value : theirs.rgba) ink += 255 - value;
    // Of 255: 16 samples where several edges meet are off by up to a quarter; all in all a few parts in a thousand.
    EXPECT_GT(ink / static_cast<double>(theirs.rgba.size()), 10);
    EXPECT_LE(off.mean, 1.0) << size;
    EXPECT_LE(off.largest, 64u) << size;
    std::printf("%g pixels an em: mean %.3f of 255, at most %u\n", size, off.mean, off.largest);
  }
}
#endif

TEST_F(CliText, WhatIsNoFontIsNamed) {
  const TemporaryFile file("no.ttf", "this is no font");
  EXPECT_NE(gpgpFailure({"text", file.path(), "a", picture.path()}).find("no.ttf"), std::string::npos);
  EXPECT_NE(gpgpFailure({"text", sans, "a", picture.path(), "--fallback", file.path()}).find("no.ttf"),
            std::string::npos);
}

TEST_F(CliText, WhatDoesNotFitAPictureIsAnError) {
  const std::string error = gpgpFailure({"text", sans, std::string(500, 'm'), picture.path(), "--size", "100"});
  EXPECT_NE(error.find("16384"), std::string::npos) << error;
  EXPECT_FALSE(std::filesystem::exists(picture.path()));
}

TEST_F(CliText, BytesThatAreNotUtf8AreSaid) {
  const ProcessResult result = gpgp({"text", sans,
                                     "a\xff"
                                     "b",
                                     picture.path(), "--json"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_NE(result.err.find("the first at byte 1"), std::string::npos) << result.err;
}

TEST_F(CliText, WrongUsage) {
  const std::string out = picture.path();
  expectWrongUsage({{"text"},
                    {"text", sans},
                    {"text", sans, "a"},
                    {"text", "no_such_font.ttf", "a", out},
                    {"text", sans, "a", out, "--fallback", "no_such_font.ttf"},
                    {"text", sans, "a", out, "--size", "0"},
                    {"text", sans, "a", out, "--size", "big"},
                    {"text", sans, "a", out, "--width", "-5"},
                    {"text", sans, "a", out, "--align", "middle"},
                    {"text", sans, "a", out, "--direction", "up"},
                    {"text", sans, "a", out, "--color", "reddish"},
                    {"text", sans, "a", out, "--background", "ffffff"},
                    {"text", sans, "a", out, "--features", "lig"},
                    {"text", sans, "a", out, "--features", "liga=on"},
                    {"text", sans, "a", out, "--features", "liga="},
                    {"text", sans, "a", out, "--repeat", "0"}});
}

} // namespace
} // namespace gpgp::test
