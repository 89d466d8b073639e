// Where letters of SVG's text stand, and the lines along them, beside the same squares written as shapes.
#include "svg_squares.h"

#include "host/picture.h"

#include <gtest/gtest.h>

namespace {
using namespace gpgp::test;

struct Pair {
  const char* name;
  std::string with, without;
};

void expectSame(const Pair& pair) {
  SCOPED_TRACE(pair.name);
  const Import given = written(pair.with), reference = page(pair.without);
  EXPECT_EQ(given.placed, std::vector<std::string>());
  EXPECT_LE(worst(picture(given), picture(reference)), 0.51); // of 255: rounding of points to floats on an edge
}

std::string box(double x, double y, double w, double h) {
  return "<rect x='" + std::to_string(x) + "' y='" + std::to_string(y) + "' width='" + std::to_string(w) +
         "' height='" + std::to_string(h) + "'/>";
}
/// A letter of 20 units.
std::string at(double x, double y) { return box(x, y - 8, 8, 8); }
/// One that stands on a baseline which goes down.
std::string onSide(double x, double y) { return box(x, y, 8, 8); }

TEST(SvgText, LettersAreSpacedButTheLast) {
  const Pair pairs[] = {
      {"at the end", "<text x='50' y='40' text-anchor='end' letter-spacing='5'>ab</text>", at(25, 40) + at(40, 40)},
      {"in the middle", "<text x='50' y='40' text-anchor='middle' letter-spacing='10'>ab</text>",
       at(35, 40) + at(55, 40)},
      {"before what has none", "<text x='10' y='40'><tspan letter-spacing='5'>ab</tspan>c</text>",
       at(10, 40) + at(25, 40) + at(40, 40)},
      {"not where letters join", // two bytes, which are two squares of this font
       "<text x='10' y='40' letter-spacing='5'>\u0645</text>", at(10, 40) + at(20, 40)},
      {"where others do", "<text x='10' y='40' letter-spacing='5'>a\u0645</text>",
       at(10, 40) + at(25, 40) + at(35, 40)},
      {"no room is no letter", "<text x='10' y='40' letter-spacing='-15'>abc</text>", at(10, 40)},
      {"as long as nothing", "<text x='10' y='40' textLength='0'>ab</text>", at(10, 40) + at(0, 40)},
  };
  for (const Pair& pair : pairs) expectSame(pair);
}

TEST(SvgText, IndicesLieWhereTheFontHasThem) {
  const Pair pairs[] = {
      {"above and below", // by 10 and by 5
       "<text x='10' y='40'>a<tspan baseline-shift='super'>b</tspan><tspan baseline-shift='sub'>c</tspan></text>",
       at(10, 40) + at(20, 30) + at(30, 45)},
      {"inside of others",
       "<text x='10' y='40'><tspan baseline-shift='sub'>a<tspan baseline-shift='super'>b<tspan "
       "baseline-shift='super'>c</tspan></tspan></tspan></text>",
       at(10, 45) + at(20, 35) + at(30, 25)},
      {"with lengths",
       "<text x='10' y='40'><tspan baseline-shift='5'><tspan baseline-shift='super'>a</tspan></tspan></text>",
       at(10, 25)},
      {"by the letters' size",
       "<text x='10' y='60'><tspan baseline-shift='super'>a<tspan font-size='40'>b</tspan></tspan></text>",
       at(10, 50) + box(20, 24, 16, 16)},
      {"a baseline that does not change",
       "<text x='10' y='40' dominant-baseline='hanging'>a<tspan dominant-baseline='no-change'>b</tspan></text>",
       at(10, 52.8) + at(20, 52.8)},
      {"a negative size shows nothing", "<text x='10' y='40'>a<tspan font-size='-5'>b</tspan>c</text>",
       at(10, 40) + at(20, 40)},
      {"words of a tref are those of another element",
       "<text x='10' y='40'><tref href='#o'>no</tref>b</text><defs><text id='o'>x</text></defs>",
       at(10, 40) + at(20, 40)},
  };
  for (const Pair& pair : pairs) expectSame(pair);
}

TEST(SvgText, LinesBeginAnewWhereALetterIsPlaced) {
  const Pair pairs[] = {
      {"in a row", "<text x='10' y='40' text-decoration='underline'>ab</text>",
       at(10, 40) + at(20, 40) + box(10, 40, 20, 2)},
      {"at places", "<text x='10 40' y='40' text-decoration='underline'>ab</text>",
       at(10, 40) + at(40, 40) + box(10, 40, 10, 2) + box(40, 40, 10, 2)},
      {"moved", "<text x='10' y='40' dx='0 5' text-decoration='underline'>abc</text>",
       at(10, 40) + at(25, 40) + at(35, 40) + box(10, 40, 10, 2) + box(25, 40, 20, 2)},
      {"from above: along both edges and through the middle",
       "<text x='40' y='10' writing-mode='tb' text-decoration='underline overline line-through'>ab</text>",
       onSide(34, 10) + onSide(34, 20) + box(29, 10, 2, 20) + box(49, 10, 2, 20) + box(39, 10, 2, 20)},
  };
  for (const Pair& pair : pairs) expectSame(pair);
}

/// Two letters that are pictures, each of one pixel of its own, and one that is a gradient from its left to its right.
GpgpResult GPGP_CALL shapePictures(void*, const GpgpSvgText* text, GpgpSvgGlyphFn glyphFn, void* glyphData) {
  static const uint8_t pixels[2][8] = {{255, 0, 0, 255, 0, 0, 255, 128}, {0, 255, 0, 255, 0, 0, 0, 0}};
  static const GpgpPathVerb verbs[] = {GPGP_PATH_MOVE, GPGP_PATH_LINE, GPGP_PATH_LINE, GPGP_PATH_CLOSE};
  static const float points[] = {0, 0, 1, 0, 1, -1};
  static const GpgpGradientStop stops[] = {{0, {1, 0, 0, 1}}, {1, {0, 0, 1, 1}}};
  static const VkBool32 isForeground = VK_FALSE;
  GpgpGradient gradient{};
  gradient.kind = GPGP_GRADIENT_LINEAR;
  gradient.end[0] = 1;
  gradient.transform[0] = gradient.transform[3] = 1;
  gradient.stops = stops, gradient.stopCount = 2;
  GpgpPath triangle{};
  triangle.verbs = verbs, triangle.verbCount = 4;
  triangle.points = points, triangle.pointCount = 3;
  triangle.gradient = &gradient;
  for (uint32_t i = 0; i < text->size; ++i) {
    GpgpSvgGlyph glyph{};
    glyph.cluster = i;
    glyph.size = glyph.advance = text->spans[0].size;
    glyph.x = static_cast<float>(i) * glyph.size;
    if (text->text[i] == 'g') {
      glyph.paths = &triangle, glyph.pathCount = 1, glyph.foreground = &isForeground;
    } else {
      glyph.image = pixels[text->text[i] - 'a'];
      glyph.imageWidth = 2, glyph.imageHeight = 1;
      const float box[4] = {0.25f, -0.5f, 1.25f, 0};
      std::copy_n(box, 4, glyph.imageBox);
    }
    glyphFn(glyphData, &glyph);
  }
  return GPGP_SUCCESS;
}

TEST(SvgText, GlyphsMayBePicturesAndHaveGradients) {
  using namespace gpgp;
  std::vector<host::Picture> pictures;
  const auto decode = [](void* user, uint32_t index, const void* data, size_t size, uint32_t* width,
                         uint32_t* height) -> VkBool32 {
    auto& all = *static_cast<std::vector<host::Picture>*>(user);
    EXPECT_EQ(index, all.size());
    all.push_back(host::decodePicture({static_cast<const uint8_t*>(data), size}));
    *width = all.back().width, *height = all.back().height;
    return VK_TRUE;
  };
  const auto drawn = [&](const std::string& inside, bool hasDecoder, std::vector<std::string>& said) {
    const std::string text = "<svg xmlns='http://www.w3.org/2000/svg' width='100' height='100'>" + inside + "</svg>";
    const auto listen = [](void* user, const GpgpMessage* m) {
      static_cast<std::vector<std::string>*>(user)->push_back(placed(*m));
    };
    vector::svg::Reporter reporter(listen, &said, "test.svg");
    vector::svg::ImageDecoder images;
    if (hasDecoder) images = {decode, &pictures};
    auto made = vector::svg::importSvg(std::as_bytes(std::span(text.data(), text.size())), reporter, {}, images, {},
                                       nullptr, {shapePictures, nullptr});
    EXPECT_TRUE(made);
    return std::move(made->paths);
  };
  std::vector<std::string> said;
  const std::string text = "<text x='10' y='40' font-size='20' opacity='.5' fill='red'>abag</text>";
  const auto paths = drawn(text, true, said);
  EXPECT_EQ(said, std::vector<std::string>());
  ASSERT_EQ(paths.size(), 4u);
  ASSERT_EQ(pictures.size(), 2u); // what is the same is passed once
  EXPECT_EQ(pictures[0].rgba, (std::vector<uint8_t>{255, 0, 0, 255, 0, 0, 255, 128}));
  EXPECT_EQ(pictures[1].rgba[1], 255);
  for (size_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(paths[i].image);
    EXPECT_EQ(paths[i].image->image, i == 1 ? 1u : 0u);
    const float left = 15 + 20 * static_cast<float>(i);
    const float expected[6] = {20, 0, 0, 10, left, 30};
    for (size_t k = 0; k < 6; ++k) EXPECT_NEAR(paths[i].image->transform[k], expected[k], 1e-4f) << i << ' ' << k;
    EXPECT_EQ(paths[i].points, (std::vector<float>{left, 30, left + 20, 30, left + 20, 40, left, 40}));
  }
  ASSERT_TRUE(paths[3].gradient);
  const float expected[6] = {20, 0, 0, 20, 70, 40};
  for (size_t k = 0; k < 6; ++k) EXPECT_NEAR(paths[3].gradient->gradient.transform[k], expected[k], 1e-4f) << k;
  ASSERT_EQ(paths[3].gradient->gradient.stopCount, 2u);
  EXPECT_EQ(paths[3].gradient->gradient.stops[1].color[2], 1);
  // Without anyone who decodes them they are named.
  EXPECT_EQ(drawn("<text font-size='20'>a</text>", false, said).size(), 0u);
  EXPECT_EQ(said,
            std::vector<std::string>{"test.svg:1:66: warning: <text> has glyphs with parts that are not supported"});
}

} // namespace
