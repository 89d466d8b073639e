// `gpgp text`: counts that the fonts fix, seven scripts with what falls back, a picture beside the same outlines drawn
// as paths by cairo, pixels of emoji and lines, and what is said about bad input.
#include "files.h"
#include "host/picture.h"
#include "run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

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

/// The first column with some.
uint32_t firstInk(const host::Picture& picture) {
  uint32_t first = picture.width;
  for (uint32_t i = 0; i < picture.width * picture.height; ++i)
    if (picture.rgba[size_t{i} * 4 + 3]) first = std::min(first, i % picture.width);
  return first;
}

// A run takes more than a second on lavapipe, most of it for shaders; so each looks at several things.

TEST_F(CliText, OneObjectAndAPicture) {
  const json drawn = draw("Hello fi", {"--size", "20", "--repeat", "3", "--validate"});
  EXPECT_EQ(keys(drawn), (std::set<std::string>{"command", "ok", "device", "status", "glyphs", "lines", "width",
                                                "height", "truncated", "shape_ms", "gpu_ms_median", "recordings",
                                                "missing", "broken", "image"}));
  EXPECT_EQ(drawn["status"], "GPGP_SUCCESS");
  EXPECT_EQ(drawn["glyphs"], 7) << "fi is a ligature";
  EXPECT_EQ(drawn["lines"], 1);
  EXPECT_EQ(drawn["truncated"], false);
  EXPECT_EQ(drawn["missing"], json::array());
  EXPECT_EQ(drawn["broken"], json::array());
  EXPECT_EQ(drawn["recordings"], 1);
  EXPECT_GT(drawn["shape_ms"], 0);
  EXPECT_GT(drawn["gpu_ms_median"], 0);
  const host::Picture shown = seen();
  EXPECT_EQ(drawn["width"], shown.width);
  EXPECT_EQ(drawn["height"], shown.height);
  // Advances of the font, in 2048 an em: H 1540, e 1260, l 569 twice, o 1253, space 651, fi 1290; margins of 3 pixels.
  EXPECT_NEAR(drawn["width"].get<double>(), 6 + 20 * 7132 / 2048., 1.001);
  const size_t ink = inked(shown);
  EXPECT_GT(ink, shown.rgba.size() / 4 / 20);
  EXPECT_LT(ink, shown.rgba.size() / 4 / 2);
  for (uint32_t x = 0; x < shown.width; ++x) EXPECT_EQ(shown.rgba[x * 4 + 3], 0) << "the margin is clear";
}

TEST_F(CliText, FeaturesWidthAndAlignment) {
  const json drawn =
      draw("fi fi fi\nfi", {"--size", "20", "--width", "36", "--align", "right", "--features", "kern,liga=0"});
  EXPECT_EQ(drawn["glyphs"], 10) << "no ligatures";
  EXPECT_EQ(drawn["lines"], 3) << "two by two, and where the text says";
  EXPECT_EQ(drawn["width"], 42) << "as wide as lines may be";
  // The last line ends where the first ends, of twice its width.
  const host::Picture shown = seen();
  const auto ends = [&shown](uint32_t from, uint32_t to) {
    uint32_t last = 0;
    for (uint32_t y = from; y < to; ++y)
      for (uint32_t x = 0; x < shown.width; ++x)
        if (shown.rgba[(size_t{y} * shown.width + x) * 4 + 3]) last = std::max(last, x);
    return last;
  };
  EXPECT_NEAR(ends(0, shown.height / 3), ends(shown.height * 2 / 3, shown.height), 1);
  EXPECT_GT(ends(shown.height * 2 / 3, shown.height), 35u);
}

TEST_F(CliText, SpacingsLinesAndEllipsis) {
  const std::string words = "one two three four five six";
  const auto size = [](const json& drawn) {
    return std::pair(drawn["width"].get<double>(), drawn["height"].get<double>());
  };
  const std::vector<std::string> wrapped = {"--size", "20", "--width", "100"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), wrapped.begin(), wrapped.end());
    return draw(words, more);
  };
  const json all = with({});
  ASSERT_EQ(all["lines"], 3);
  EXPECT_EQ(all["truncated"], false);
  const json cut = with({"--max-lines", "2"});
  EXPECT_EQ(cut["lines"], 2);
  EXPECT_EQ(cut["truncated"], true);
  EXPECT_EQ(with({"--max-lines", "2", "--ellipsis", "||||||||||||||||"})["glyphs"], 8 + 16) << "one two, and this";
  const double line = 20 * 2384 / 2048.; // of the font
  EXPECT_EQ(with({"--height", std::to_string(line * 2 + 1)})["lines"], 2);
  // Heights: lines by their spacing, and margins of 3 pixels.
  EXPECT_NEAR(size(all).second, 6 + 3 * line, 1.001);
  EXPECT_NEAR(size(with({"--line-spacing", "1.5"})).second, 6 + 4.5 * line, 1.001);
  EXPECT_NEAR(size(with({"--line-height", "40"})).second, 6 + 120, 1.001);
  // Widths of one line: 16 letters and spaces.
  const double plain = size(draw("sixteen letters.", {"--size", "20"})).first;
  EXPECT_NEAR(size(draw("sixteen letters.", {"--size", "20", "--letter-spacing", "3"})).first, plain + 48, 1.001);
  EXPECT_NEAR(size(draw("sixteen letters.", {"--size", "20", "--letter-spacing", "-.5"})).first, plain - 8, 1.001);
  EXPECT_NEAR(size(draw("a\tb", {"--size", "20", "--tab-width", "200"})).first, 6 + 200 + 20 * 1300 / 2048., 1.001);
}

TEST_F(CliText, UnderlinesLieBelowPicturesAndStrikesOver) {
  // A green heart reaches below the underline, in orange; beside it both lines are seen.
  draw(std::string("x\U0001F49A   x"), {"--size", "96", "--color", "#ff8000", "--underline", "--strike", "--fallback",
                                        font("NotoColorEmoji.ttf"), "--background", "white"});
  const host::Picture shown = seen();
  const auto isOrange = [&shown](uint32_t x, uint32_t y) {
    const uint8_t* p = &shown.rgba[(size_t{y} * shown.width + x) * 4];
    return p[0] == 255 && p[1] == 128 && p[2] == 0;
  };
  const auto heart = [&shown] { // its lowest row and that row's middle: green is
    for (uint32_t y = shown.height; y-- > 0;) {
      uint32_t sum = 0, count = 0;
      for (uint32_t x = 0; x < shown.width; ++x) {
        const uint8_t* p = &shown.rgba[(size_t{y} * shown.width + x) * 4];
        if (p[1] < p[0] + 40 || p[1] < p[2] + 40) continue;
        sum += x;
        ++count;
      }
      if (count > 2) return std::pair(sum / count, y);
    }
    return std::pair(0u, 0u);
  }();
  ASSERT_GT(heart.second, 0u);
  uint32_t gap = 0; // a column between the letters, where nothing but lines is
  for (uint32_t x = heart.first + 60; x < shown.width && gap == 0; ++x) gap = isOrange(x, shown.height / 2) ? 0 : x;
  std::vector<uint32_t> lines; // where they begin
  for (uint32_t y = 1; y < shown.height; ++y)
    if (isOrange(gap, y) && !isOrange(gap, y - 1)) lines.push_back(y);
  ASSERT_EQ(lines.size(), 2u);
  ASSERT_LT(lines[1], heart.second) << "the heart reaches below the underline";
  EXPECT_TRUE(isOrange(heart.first, lines[0])) << "the strike";
  EXPECT_FALSE(isOrange(heart.first, lines[1])) << "the underline";
}

TEST_F(CliText, WhatNoFontHasIsNamedOnce) {
  const ProcessResult result = gpgp(
      {"text", sans, "a\u0915\xff\u0915\U0001F98A", picture.path(), "--direction", "rtl", "--width", "500", "--json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(json::parse(result.out, nullptr, false)["missing"], json({"U+0915", "U+1F98A"}));
  EXPECT_NE(result.err.find("U+0915, U+1F98A"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("the first at byte 4"), std::string::npos) << result.err;
  EXPECT_GT(firstInk(seen()), 250u) << "a line from right to left begins at the right";
}

TEST_F(CliText, SevenScriptsWithFontsThatFallBack) {
  const json drawn =
      draw("The office\n"
           "الأبواب مفتوحة في الصباح\n"
           "החלון פתוח בבוקר\n"
           "सुबह खिड़की क्षत्रिय श्रृंखला\n"
           "ตอนเช้าหน้าต่างเปิดอยู่น้ำ\n"
           "朝、窓は「カタカナ」も少し。\n"
           "Το πρωί το παράθυρο",
           {"--size", "24", "--language", "ja", "--fallback", font("NotoNaskhArabic-Regular.ttf"), "--fallback",
            font("NotoSansHebrew-Regular.ttf"), "--fallback", font("NotoSansDevanagari-Regular.ttf"), "--fallback",
            font("NotoSansThai-Regular.ttf"), "--fallback", font("NotoSansCJK-Regular.ttc")});
  EXPECT_EQ(drawn["missing"], json::array());
  EXPECT_EQ(drawn["lines"], 7);
  EXPECT_GT(drawn["glyphs"], 100);
  const host::Picture shown = seen(); // each line has ink
  for (uint32_t line = 0; line < 7; ++line) {
    size_t ink = 0;
    for (uint32_t y = shown.height * line / 7; y < shown.height * (line + 1) / 7; ++y)
      for (uint32_t x = 0; x < shown.width; ++x) ink += shown.rgba[(size_t{y} * shown.width + x) * 4 + 3] > 127;
    EXPECT_GT(ink, 200u) << "line " << line;
  }
}

TEST_F(CliText, BitmapGlyphsColoursAndLines) {
  // A red heart, a green one and a blue one, whose colours come from the font's pictures; an underline in the text's.
  const json drawn = gpgpJson({"text", font("NotoColorEmoji.ttf"), "\u2764\uFE0F\U0001F49A\U0001F499", picture.path(),
                               "--size", "64", "--color", "#ff8000", "--background", "#ff00ff", "--strike"});
  EXPECT_EQ(drawn["glyphs"], 3);
  const host::Picture shown = seen();
  const auto pixel = [&shown](uint32_t x, uint32_t y) { return &shown.rgba[(size_t{y} * shown.width + x) * 4]; };
  for (uint32_t k = 0; k < 3; ++k) {
    const uint8_t* p = pixel((2 * k + 1) * shown.width / 6, shown.height * 2 / 3); // below the strike
    const auto strongest = static_cast<uint32_t>(std::max_element(p, p + 3) - p);
    EXPECT_EQ(strongest, k) << int{p[0]} << ' ' << int{p[1]} << ' ' << int{p[2]};
    EXPECT_LT(*std::min_element(p, p + 3), 100);
  }
  size_t line = 0;
  for (size_t i = 0; i < shown.rgba.size(); i += 4) {
    const uint8_t* p = &shown.rgba[i];
    line += p[0] == 255 && p[1] == 128 && p[2] == 0 && p[3] == 255;
  }
  EXPECT_GT(line, shown.width - 20) << "a row at least, over the hearts";
  EXPECT_LT(line, shown.width * 8);
  EXPECT_EQ((std::vector<int>{pixel(0, 0)[0], pixel(0, 0)[1], pixel(0, 0)[2]}), (std::vector<int>{255, 0, 255}));
}

TEST_F(CliText, AlphaOfTheColourCountsOnceAndIsNotTheOutlines) {
  const std::string half = "rgb(0 0 0 / 50%)";
  const auto row = [this] { // the middle one's changes of colour, from left to right
    const host::Picture shown = seen();
    std::vector<std::array<int, 3>> colors;
    for (uint32_t x = 0; x < shown.width; ++x) {
      const uint8_t* p = &shown.rgba[(size_t{shown.height / 2} * shown.width + x) * 4];
      const uint8_t *before = p - (x ? 4 : 0), *behind = p + (x + 1 < shown.width ? 4 : 0);
      const std::array<int, 3> color = {p[0], p[1], p[2]};
      const bool inside = std::equal(p, p + 4, before) && std::equal(p, p + 4, behind); // no edge runs through it
      if (inside && (colors.empty() || colors.back() != color)) colors.push_back(color);
    }
    return colors;
  };
  using Colors = std::vector<std::array<int, 3>>;
  const std::array<int, 3> white = {255, 255, 255}, gray = {128, 128, 128}, red = {255, 0, 0}, dark = {127, 0, 0};
  draw("\u2588", {"--size", "40", "--color", half, "--background", "white"}); // a full block
  EXPECT_EQ(row(), (Colors{white, gray, white}));
  draw("\u2588",
       {"--size", "40", "--color", half, "--background", "white", "--outline", "12", "--outline-color", "red"});
  EXPECT_EQ(row(), (Colors{white, red, dark, gray, dark, red, white})) << "an opaque line, seen through the letter";
  // Pictures fade as well.
  std::array<std::array<int, 3>, 2> heart{};
  for (size_t k = 0; k < 2; ++k) {
    gpgpJson({"text", font("NotoColorEmoji.ttf"), "\U0001F49A", picture.path(), "--size", "64", "--color",
              k ? half : "black", "--background", "white"});
    const host::Picture shown = seen();
    std::copy_n(&shown.rgba[(size_t{shown.height / 2} * shown.width + shown.width / 2) * 4], 3, heart[k].begin());
  }
  EXPECT_LT(heart[0][0], 200);
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(heart[1][i], (heart[0][i] + 255) / 2, 1);
}

TEST_F(CliText, FacesAndAxesOfTheFont) {
  const auto ink = [&](std::vector<std::string> more) {
    const json drawn = gpgpJson(more);
    EXPECT_EQ(drawn["missing"], json::array());
    return inked(seen());
  };
  const std::string inter = font("Inter-roman.var.ttf"), cjk = font("NotoSansCJK-Regular.ttc"), out = picture.path();
  EXPECT_GT(ink({"text", inter, "Bold", out, "--axes", "wght=900"}), ink({"text", inter, "Bold", out}) * 11 / 10);
  EXPECT_NE(gpgpFailure({"text", inter, "a", out, "--axes", "wght=2000"}).find("'wght' is 2000"), std::string::npos);
  EXPECT_NE(gpgpFailure({"text", cjk, "a", out, "--face", "99"}).find("face is 99"), std::string::npos);
}

TEST_F(CliText, AnEmptyTextIsAPictureToo) {
  const json drawn = draw("");
  EXPECT_EQ(drawn["glyphs"], 0);
  EXPECT_EQ(drawn["lines"], 1);
  EXPECT_EQ(inked(seen()), 0u);
}

#ifdef GPGP_TEST_CAIRO
/// A line along the letters' edges, below all of them; red.
struct Outline {
  double width, alpha;
};

/// Letters side by side by the font's own advances, their outlines filled by cairo, black on white.
host::Picture byCairo(const std::string& file, const std::string& text, double size, const double from, double y,
                      uint32_t width, uint32_t height, const Outline* line = nullptr) {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  EXPECT_EQ(FT_Init_FreeType(&library), 0);
  EXPECT_EQ(FT_New_Face(library, file.c_str(), 0, &face), 0);
  constexpr uint32_t kFine = 4; // as cairo counts in 15 rows a pixel, and shows what is behind two edges that meet
  cairo_surface_t* surface =
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width * kFine), static_cast<int>(height * kFine));
  cairo_t* cairo = cairo_create(surface);
  cairo_scale(cairo, kFine, kFine);
  cairo_set_source_rgb(cairo, 1, 1, 1);
  cairo_paint(cairo);
  cairo_set_source_rgb(cairo, 0, 0, 0);
  cairo_set_tolerance(cairo, 0.01);
  cairo_set_antialias(cairo, CAIRO_ANTIALIAS_BEST);
  double x = from;
  const auto letter = [&](char c) {
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
      cairo_close_path(static_cast<Pen*>(user)->cairo);
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
    cairo_close_path(cairo);
    x += static_cast<double>(face->glyph->advance.x) * pen.scale;
  };
  if (line) {
    cairo_set_source_rgba(cairo, 1, 0, 0, line->alpha);
    cairo_set_line_width(cairo, line->width);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    for (const char c : text) {
      letter(c);
      cairo_stroke(cairo);
    }
    cairo_set_source_rgb(cairo, 0, 0, 0);
    x = from;
  }
  for (const char c : text) {
    letter(c);
    cairo_fill(cairo);
  }
  cairo_surface_flush(surface);
  host::Picture picture{width, height, std::vector<uint8_t>(size_t{width} * height * 4, 255)};
  const auto stride = static_cast<size_t>(cairo_image_surface_get_stride(surface));
  const uint8_t* data = cairo_image_surface_get_data(surface);
  for (uint32_t row = 0; row < height; ++row)
    for (uint32_t column = 0; column < width; ++column)
      for (size_t k = 0; k < 3; ++k) {
        uint32_t sum = 0;
        for (uint32_t at = 0; at < kFine * kFine; ++at)
          sum += data[(row * kFine + at / kFine) * stride + (column * kFine + at % kFine) * 4 + 2 - k];
        picture.rgba[(size_t{row} * width + column) * 4 + k] =
            static_cast<uint8_t>((sum + kFine * kFine / 2) / (kFine * kFine));
      }
  cairo_destroy(cairo);
  cairo_surface_destroy(surface);
  FT_Done_Face(face);
  FT_Done_FreeType(library);
  return picture;
}

TEST_F(CliText, IsThePictureThatCairoMakesOfFreeTypesOutlines) {
  const std::string text = "Quick brown waffles, 0123 & more (jumpy)";
  const double size = 14.5;
  draw(text, {"--size", "14.5", "--features", "kern=0,liga=0,clig=0", "--background", "white"});
  const host::Picture ours = seen();
  // A margin of 2 pixels, and the font's ascent of 1901 / 2048 em above the baseline.
  const host::Picture theirs = byCairo(sans, text, size, 2, 2 + size * 1901 / 2048, ours.width, ours.height);
  const host::PictureDifference off = host::compare(ours, theirs);
  double ink = 0;
  for (const uint8_t value : theirs.rgba) ink += 255 - value;
  // Of 255: where several edges meet in a pixel 16 samples are off by up to an eighth; nearly all else is exact.
  EXPECT_GT(ink / static_cast<double>(theirs.rgba.size()), 10);
  EXPECT_LE(off.mean, 0.6);
  EXPECT_LE(off.largest, 32u);
}
TEST_F(CliText, OutlinesAreCairosStrokesBelowAllLetters) {
  // Wide enough for each line to reach the letter beside it; without a translucent one, where letters' lines overlap.
  const std::string text = "Wide gjQ8";
  for (const bool translucent : {false, true}) {
    const double size = 40, wide = translucent ? 2 : 7;
    draw(text, {"--size", "40", "--features", "kern=0,liga=0,clig=0", "--background", "white", "--outline",
                translucent ? "2" : "7", "--outline-color", translucent ? "#ff000080" : "red"});
    const host::Picture ours = seen();
    const double margin = 5, beyond = translucent ? 0 : 3; // of 3.5 pixels, W's own place takes 1.3
    const host::Picture theirs = byCairo(sans, text, size, margin + beyond, margin + size * 1901 / 2048, ours.width,
                                         ours.height, std::array{Outline{wide, translucent ? 128 / 255. : 1}}.data());
    if (const char* folder = std::getenv("GPGP_TEXT_PICTURES")) {
      host::writePng(std::string(folder) + "/outline_gpgp" + (translucent ? "_2.png" : "_7.png"), ours);
      host::writePng(std::string(folder) + "/outline_cairo" + (translucent ? "_2.png" : "_7.png"), theirs);
    }
    const host::PictureDifference off = host::compare(ours, theirs);
    size_t red = 0;
    for (size_t i = 0; i < theirs.rgba.size(); i += 4) red += ours.rgba[i] > 200 && ours.rgba[i + 1] < 160;
    EXPECT_GT(red, translucent ? 300u : 2000u);
    std::printf("outline %g: mean %.3f, largest %u\n", wide, off.mean, off.largest);
    EXPECT_LE(off.mean, 0.6);
    EXPECT_LE(off.largest, 32u);
  }
}
#endif

TEST_F(CliText, ABrokenGlyphIsDrawnAsMissingAndNamed) {
  std::string bytes = host::readText(sans);
  const auto at = [&bytes](size_t i) { return size_t{static_cast<unsigned char>(bytes[i])}; };
  const auto number = [&](size_t i) { return at(i) << 24 | at(i + 1) << 16 | at(i + 2) << 8 | at(i + 3); };
  const auto table = [&](std::string_view tag) {
    for (size_t entry = 12;; entry += 16)
      if (bytes.compare(entry, 4, tag) == 0) return number(entry + 8);
  };
  constexpr uint32_t kA = 68; // the font's number of a
  const size_t loca = table("loca") + kA * 4;
  bytes[table("glyf") + number(loca)] = 0x7f; // contours by the thousand
  const TemporaryFile file("broken.ttf", bytes);
  const ProcessResult result = gpgp({"text", file.path(), "banana", picture.path(), "--size", "40", "--json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const json drawn = json::parse(result.out, nullptr, false);
  EXPECT_EQ(drawn["broken"], json::array({{{"font", file.path()}, {"glyph", kA}}}));
  EXPECT_EQ(drawn["missing"], json::array());
  EXPECT_NE(result.err.find("glyph 68"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("named a "), std::string::npos) << result.err;
  const size_t ink = inked(seen());
  draw("bnn", {"--size", "40"});
  EXPECT_GT(ink, inked(seen()) + 300) << "the sign for a missing character, three times";
}

TEST_F(CliText, AVeryLongTextTakesSeveralRecords) {
  const std::vector<std::string> as = {"--size", "26", "--width", "3250", "--background", "white"};
  const json drawn = draw(std::string(25000, 'm'), as);
  EXPECT_EQ(drawn["glyphs"], 25000);
  EXPECT_GT(drawn["recordings"], 1);
  const host::Picture whole = seen();
  const json few = draw(std::string(1280, 'm'), as); // ten lines of 128, in one record
  EXPECT_EQ(few["recordings"], 1);
  const host::Picture part = seen();
  ASSERT_EQ(part.width, whole.width);
  const auto lines = drawn["lines"].get<uint32_t>();
  EXPECT_EQ(lines, (25000 + 127) / 128);
  // Each line looks as the first does, as far as parts of pixels agree: as much ink, also where recordings meet.
  const auto ink = [](const host::Picture& page, double first, double end) {
    double sum = 0;
    for (auto y = static_cast<uint32_t>(first); y < static_cast<uint32_t>(end); ++y)
      for (uint32_t x = 0; x < page.width; ++x) sum += 255 - page.rgba[(size_t{y} * page.width + x) * 4];
    return sum;
  };
  const double height = (whole.height - 4) / static_cast<double>(lines), wanted = ink(part, 0, 2 + height);
  EXPECT_GT(wanted, 100000);
  for (uint32_t line = 0; line + 1 < lines; ++line)
    ASSERT_NEAR(ink(whole, 2 + line * height, 2 + (line + 1) * height), wanted, wanted / 50) << "line " << line;
  for (uint32_t y = 0; y < part.height / 2; ++y)
    ASSERT_TRUE(std::equal(part.rgba.begin() + y * part.width * 4, part.rgba.begin() + (y + 1) * part.width * 4,
                           whole.rgba.begin() + y * part.width * 4))
        << "row " << y;
}

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

TEST_F(CliText, NumbersThatAreNoneAreNamed) {
  for (const char* option : {"--size", "--outline", "--width", "--height", "--letter-spacing", "--line-spacing",
                             "--line-height", "--tab-width"}) {
    const ProcessResult result = gpgp({"text", sans, "a", picture.path(), option, "nan"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_NE(result.err.find(std::string(option) + ": nan is not within "), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(picture.path()));
  }
}

TEST_F(CliText, WrongUsage) {
  const std::string out = picture.path();
  expectWrongUsage({{"text"},
                    {"text", sans},
                    {"text", sans, "a"},
                    {"text", "no_such_font.ttf", "a", out},
                    {"text", sans, "a", "out.jpg"},
                    {"text", sans, "a", "out"},
                    {"text", sans, "a", ".png"},
                    {"text", sans, "a", out, "--fallback", "no_such_font.ttf"},
                    {"text", sans, "a", out, "--size", "0"},
                    {"text", sans, "a", out, "--size", "big"},
                    {"text", sans, "a", out, "--width", "-5"},
                    {"text", sans, "a", out, "--align", "middle"},
                    {"text", sans, "a", out, "--max-lines", "0"},
                    {"text", sans, "a", out, "--max-lines", "-1"},
                    {"text", sans, "a", out, "--max-lines", "2.5"},
                    {"text", sans, "a", out, "--height", "0"},
                    {"text", sans, "a", out, "--line-spacing", "0"},
                    {"text", sans, "a", out, "--line-height", "-3"},
                    {"text", sans, "a", out, "--line-height", "20", "--line-spacing", "2"},
                    {"text", sans, "a", out, "--tab-width", "0"},
                    {"text", sans, "a", out, "--letter-spacing", "5000"},
                    {"text", sans, "a", out, "--direction", "up"},
                    {"text", sans, "a", out, "--color", "reddish"},
                    {"text", sans, "a", out, "--background", "ffffff"},
                    {"text", sans, "a", out, "--features", "lig"},
                    {"text", sans, "a", out, "--features", "liga=on"},
                    {"text", sans, "a", out, "--features", "liga="},
                    {"text", sans, "a", out, "--outline", "-1"},
                    {"text", sans, "a", out, "--axes", "wght"},
                    {"text", sans, "a", out, "--face", "-1"},
                    {"text", sans, "a", out, "--outline-color", "reddish"},
                    {"text", sans, "a", out, "--repeat", "0"}});
}

} // namespace
} // namespace gpgp::test
