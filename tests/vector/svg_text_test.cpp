// Where letters of SVG's text stand, and the lines along them, beside the same squares written as shapes.
#include "svg_squares.h"

#include "host/picture.h"
#include "vector/import/svg/text_characters.h"

#include <gtest/gtest.h>

namespace {
using namespace gpgp::test;

struct Pair {
  const char* name;
  std::string with, without;
};

void expectSame(const Pair& pair, GpgpSvgTextFn shape = shapeSquares) {
  SCOPED_TRACE(pair.name);
  const Import given = written(pair.with, shape), reference = page(pair.without);
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
      {"words moved onto each other", "<text x='50' y='40' text-anchor='end' word-spacing='-20'>a b</text>",
       at(40, 40) + at(40, 40)},
      {"a vertical line runs through small letters on a path, too",
       "<path id='p' d='M10 50H90' fill='none'/><text writing-mode='tb'><textPath href='#p'>ab</textPath></text>",
       at(10, 54) + at(20, 54)},
  };
  for (const Pair& pair : pairs) expectSame(pair);
}

TEST(SvgText, LettersOnCurvesStandAlongThem) {
  // Two letters of 60 units, whose middles are at lengths of 15 and 45 of a circle's quarter around the origin.
  constexpr double radius = 80, degrees = 57.29577951308232;
  const Import given = written(
      "<path id='p' d='M80 0A80 80 0 0 1 0 80' fill='none'/><text font-size='60'><textPath href='#p'>ab</textPath>"
      "</text>");
  std::string turned;
  for (const double middle : {15.0, 45.0})
    turned += "<rect x='-15' y='-24' width='24' height='24' transform='rotate(" +
              std::to_string(middle / radius * degrees) + ") translate(80 0) rotate(90)'/>";
  // The quarter as a cubic, and its lines, are two thousandths off; lines' own directions would be a fifth.
  EXPECT_LE(worst(picture(given), picture(page(turned))), 8);
}

TEST(SvgText, MarksStandOnTheirLettersHoweverTheseAreTurned) {
  const std::string letter = "<rect y='-8' width='8' height='8'/><rect x='4' y='-12' width='2' height='2'/>";
  const auto placed = [&](const std::string& transform) {
    return "<g transform='" + transform + "'>" + letter + "</g>";
  };
  const Pair pairs[] = {
      {"as they are", "<text x='10' y='40'>a</text>", placed("translate(10 40)")},
      {"rotated", "<text x='50' y='50' rotate='30 -90'>ab</text>",
       placed("translate(50 50) rotate(30)") + placed("translate(60 50) rotate(-90)")},
      {"on a path",
       "<path id='p' d='M50 10V90' fill='none'/><text><textPath href='#p'>a<tspan "
       "rotate='90'>b</tspan></textPath></text>",
       placed("translate(50 10) rotate(90)") + placed("translate(50 20) rotate(180)")},
      {"on their side in lines that go down", "<text x='40' y='10' writing-mode='tb'>a</text>",
       placed("translate(36 10) rotate(90)")},
      {"upright in lines that go down, where the font has a glyph for it",
       "<text x='40' y='10' writing-mode='tb'>a(</text>",
       placed("translate(36 10) rotate(90)") + placed("translate(35 31)")},
      {"else on their side", "<text x='10' y='40'>(</text>", placed("translate(10 40)")},
      {"stretched", "<text x='10' y='40' textLength='20' lengthAdjust='spacingAndGlyphs'>a</text>",
       placed("translate(10 40) scale(2 1)")},
  };
  for (const Pair& pair : pairs) expectSame(pair, shapeMarked);
  // Unicode Standard Annex 50, an example of each of its values.
  using namespace gpgp::vector::svg;
  for (const uint32_t upright : {0xa7u, 0x3001u, 0x3042u, 0x4e00u, 0xff01u, 0x1f600u}) EXPECT_TRUE(isUpright(upright));
  for (const uint32_t turned : {0x41u, 0x5d0u, 0x2014u, 0x300cu, 0x30fcu}) EXPECT_FALSE(isUpright(turned));
  for (const uint32_t replaced : {0x3001u, 0x300cu, 0x30fcu, 0xff08u}) EXPECT_TRUE(hasVerticalForm(replaced));
  EXPECT_FALSE(hasVerticalForm(0x41));
}

TEST(SvgText, WhatIsHiddenHasNoLines) {
  const Pair pairs[] = {
      {"inside", "<text x='10' y='40' text-decoration='underline'>a<tspan visibility='hidden'>b</tspan>c</text>",
       at(10, 40) + at(30, 40) + box(10, 40, 10, 2) + box(30, 40, 10, 2)},
      {"around",
       "<text x='10' y='40' visibility='hidden' text-decoration='underline'>a<tspan "
       "visibility='visible'>b</tspan></text>",
       at(20, 40) + box(20, 40, 10, 2)},
  };
  for (const Pair& pair : pairs) expectSame(pair);
}

TEST(SvgText, OneLineWithoutWhatIsNoText) {
  const Pair pairs[] = {
      {"separators are spaces", "<text x='10' y='40'>a\u2028b\u0085c</text>", at(10, 40) + at(30, 40) + at(50, 40)},
      {"white-space is no attribute", "<text x='10' y='40' white-space='pre'> a</text>", at(10, 40)},
      {"in a style it counts", "<text x='10' y='40' style='white-space:pre'> a</text>", at(20, 40)},
      {"spaces that could break a line", "<text x='10' y='40' style='white-space:break-spaces'> a</text>", at(20, 40)},
      {"what wraps has no effect", "<text x='10' y='40' style='white-space:preserve nowrap'> a</text>", at(20, 40)},
      {"lines that would be kept", "<text x='10' y='40' style='white-space:pre-line'> a</text>", at(10, 40)},
      {"against xml:space", "<text x='10' y='40' xml:space='preserve' style='white-space:normal'> a</text>",
       at(10, 40)},
      {"the longhand", "<text x='10' y='40' style='white-space-collapse:preserve'> a</text>", at(20, 40)},
      {"a tref has no words of its own",
       "<text x='10' y='40'><tref href='#o'>no<tspan>no</tspan></tref>b</text><defs><text id='o'>x</text></defs>",
       at(10, 40) + at(20, 40)},
  };
  for (const Pair& pair : pairs) expectSame(pair);
  for (const char* value : {"white-space:keep", "white-space:pre wide", "white-space-collapse:pre"})
    EXPECT_EQ(written(std::string("<text style='") + value + "'> a</text>").placed.size(), 1u) << value;
  const Import bad = written("<g writing-mode='tb'><text x='40' y='10' writing-mode='up'>a</text></g>");
  EXPECT_EQ(bad.placed, std::vector<std::string>{
                            "test.svg:2:22: warning: <text> has writing-mode 'up', which is not valid; ignored"});
  EXPECT_LE(worst(picture(bad), picture(page(onSide(36, 10)))), 0.51);
}

TEST(SvgText, FontSetsAllOfTheFont) {
  struct Asked {
    std::vector<std::string> spans;
  };
  const GpgpSvgTextFn ask = [](void* user, const GpgpSvgText* text, GpgpSvgGlyphFn, void*) -> GpgpResult {
    const GpgpSvgTextSpan& s = text->spans[0];
    static_cast<Asked*>(user)->spans.push_back(std::string(s.families) + " " + std::to_string(std::lround(s.size)) +
                                               " " + std::to_string(std::lround(s.weight)) + (s.italic ? " i" : "") +
                                               (s.smallCaps ? " c" : "") +
                                               (s.stretch != 100 ? " " + std::to_string(s.stretch).substr(0, 4) : ""));
    return GPGP_SUCCESS;
  };
  const auto asked = [&](const std::string& outer, const std::string& own) {
    const std::string text = "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'><g " + outer + "><text " +
                             own + ">a</text></g></svg>";
    Asked found;
    gpgp::vector::svg::Reporter reporter(nullptr, nullptr, "test.svg");
    (void)gpgp::vector::svg::importSvg(std::as_bytes(std::span(text.data(), text.size())), reporter, {}, {}, {},
                                       nullptr, gpgp::vector::svg::TextShaper{ask, &found});
    return found.spans.empty() ? std::string() : found.spans[0];
  };
  EXPECT_EQ(asked("", "style='font-weight:bold;font-style:italic;font:20px F'"), "F 20 400");
  EXPECT_EQ(asked("", "style='font:20px F;font-weight:bold'"), "F 20 700");
  EXPECT_EQ(asked("", "style='font:italic small-caps 300 20px F;font-family:G;font-size:30px'"), "G 30 300 i c");
  EXPECT_EQ(asked("style='font:italic 20px F'", "style='font-weight:bold;font:inherit'"), "F 20 400 i");
  EXPECT_EQ(asked("style='font:bold 20px F'", "font-style='italic'"), "F 20 700 i");
  EXPECT_EQ(asked("font-weight='700'", "style='font:bolder 20px F'"), "F 20 900");
  EXPECT_EQ(asked("font-weight='700'", "style='font:lighter 20px F'"), "F 20 400");
  EXPECT_EQ(asked("", "style='font:condensed 20px F'"), "F 20 400 75.0");
  EXPECT_EQ(asked("font-stretch='condensed'", "style='font:20px F'"), "F 20 400");
  EXPECT_EQ(asked("style='font:20px F;font-stretch:75%'", "font-stretch='wider'"), "F 20 400 87.5");
  EXPECT_EQ(asked("style='font:20px F'", "font-stretch='narrower'"), "F 20 400 87.5");
  // Names without quotes are words that begin with no digit.
  EXPECT_EQ(asked("style='font:20px F'", "font-family='G 2'"), "F 20 400");
  EXPECT_EQ(asked("style='font:20px F'", "font-family='G, 2'"), "F 20 400");
  EXPECT_EQ(asked("style='font:20px F'", "font-family='G,'"), "F 20 400");
  EXPECT_EQ(asked("style='font:20px F'", "style='font:30px G 2'"), "F 20 400");
  EXPECT_EQ(asked("style='font:20px F'", "font-family=\"'G 2', H-2 _i\""), "'G 2', H-2 _i 20 400");
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
       onSide(36, 10) + onSide(36, 20) + box(29, 10, 2, 20) + box(49, 10, 2, 20) + box(39, 10, 2, 20)},
  };
  for (const Pair& pair : pairs) expectSame(pair);
}

TEST(SvgText, WhatIsNotDrawnIsNamed) {
  const struct {
    const char *inside, *message;
  } cases[] = {
      {"<text y='20'>a<tspan opacity='.5'>b</tspan></text>",
       "2:15: warning: opacity of a part of text is not supported: <tspan> is drawn without it"},
      {"<text y='20'><a mask='url(#m)'>b</a></text>",
       "2:14: warning: mask of a part of text is not supported: <a> is drawn without it"},
      {"<g style='text-transform:uppercase'><text y='20'>a<tspan>b</tspan></text></g>",
       "2:37: warning: text-transform is not supported: <text> is drawn without it"},
      {"<text y='20'>a<tspan font-size-adjust='.6'>b<tspan>c</tspan></tspan></text>",
       "2:15: warning: font-size-adjust is not supported: <tspan> is drawn without it"},
      {"<text y='20' style='inline-size:90px'>a<tspan>b</tspan></text>",
       "2:1: warning: inline-size is not supported: <text> is drawn without it"},
      {"<text x='10 50' y='20' textLength='90'>ab</text>",
       "2:36: warning: textLength of several lines is not supported: <text> is drawn without it"},
      {"<text x='50' writing-mode='tb' glyph-orientation-vertical='0'>a</text>",
       "2:1: warning: glyph-orientation-vertical is not supported: <text> is drawn without it"},
      {"<text x='50' style='writing-mode:vertical-rl;text-orientation:upright'>a</text>",
       "2:1: warning: text-orientation is not supported: <text> is drawn without it"},
  };
  for (const auto& c : cases)
    EXPECT_EQ(written(c.inside).placed, std::vector<std::string>{std::string("test.svg:") + c.message}) << c.inside;
  for (const char* silent : {"<text y='20' glyph-orientation-vertical='0'>a</text>", // of vertical lines alone
                             "<text writing-mode='tb' glyph-orientation-vertical='auto'>a</text>",
                             "<text y='20' style='text-transform:none;font-feature-settings:normal'>a</text>",
                             "<g style='text-transform:uppercase'><text style='text-transform:initial'>a</text></g>",
                             "<g style='inline-size:90px'><text>a</text></g>",    // is not inherited
                             "<text y='20' text-transform='uppercase'>a</text>"}) // no attribute of SVG
    EXPECT_EQ(written(silent).placed, std::vector<std::string>()) << silent;
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
