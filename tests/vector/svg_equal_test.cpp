// A drawing with a feature of SVG is the same drawing written without it: markers placed by hand, style sheets as
// attributes, patterns as copies, text as outlines.
#include "svg_import.h"
#include "svg_squares.h"

#include <gtest/gtest.h>

namespace {
using namespace gpgp;
using namespace gpgp::test;

using Texts = std::vector<std::string>;

constexpr double kSame = 0.51; ///< of 255: what rounding of points to floats may come to on an edge

struct Pair {
  const char* name;
  std::string with, without;
};

void expectSame(const Pair& pair) {
  SCOPED_TRACE(pair.name);
  const Import given = page(pair.with), reference = page(pair.without);
  EXPECT_EQ(given.placed, Texts());
  EXPECT_EQ(reference.placed, Texts());
  EXPECT_LE(worst(picture(given), picture(reference)), kSame);
}

std::string marker(const std::string& attributes, const std::string& inside) {
  return "<marker id='m' " + attributes + ">" + inside + "</marker>";
}
const std::string kArrow = "<path d='M0 0L12 6L0 12Z' fill='#a00'/>";
const std::string kBox = "markerUnits='userSpaceOnUse' markerWidth='12' markerHeight='12' refX='6' refY='6' ";
/// The arrow with its middle at a point, turned.
std::string arrowAt(int x, int y, double degrees) {
  return "<g transform='translate(" + std::to_string(x) + " " + std::to_string(y) + ") rotate(" +
         std::to_string(degrees) + ") translate(-6 -6)'>" + kArrow + "</g>";
}
const std::string kAngle = "<path d='M20 20H80V80' fill='none' stroke='#00a' stroke-width='4' ";

TEST(SvgEqual, MarkersArePlacedAtVertices) {
  const std::string line = kAngle + "/>";
  const Pair pairs[] = {
      {"all", marker(kBox, kArrow) + kAngle + "style='marker:url(#m)'/>",
       line + arrowAt(20, 20, 0) + arrowAt(80, 20, 0) + arrowAt(80, 80, 0)},
      {"auto: halfway between the directions",
       marker(kBox + "orient='auto'", kArrow) + kAngle + "marker-mid='url(#m)'/>", line + arrowAt(80, 20, 45)},
      {"auto at the ends",
       marker(kBox + "orient='auto'", kArrow) + kAngle + "marker-start='url(#m)' marker-end='url(\"#m\")'/>",
       line + arrowAt(20, 20, 0) + arrowAt(80, 80, 90)},
      {"auto-start-reverse turns the first alone",
       marker(kBox + "orient='auto-start-reverse'", kArrow) + kAngle + "style='marker:url(#m)'/>",
       line + arrowAt(20, 20, 180) + arrowAt(80, 20, 45) + arrowAt(80, 80, 90)},
      {"an angle with its unit", marker(kBox + "orient='0.25turn'", kArrow) + kAngle + "marker-start='url(#m)'/>",
       line + arrowAt(20, 20, 90)},
      {"in units of the stroke's width, from its box",
       marker("viewBox='0 0 24 24' refX='12' refY='12' markerWidth='3' markerHeight='3'",
              "<path d='M0 0L24 12L0 24Z' fill='#a00'/>") +
           kAngle + "marker-end='url(#m)'/>",
       line + arrowAt(80, 80, 0)},
      {"clipped to its size",
       marker(kBox, "<rect x='-9' y='-9' width='40' height='40' fill='#a00'/>") + kAngle + "marker-end='url(#m)'/>",
       line + "<rect x='74' y='74' width='12' height='12' fill='#a00'/>"},
      {"not clipped where its overflow is visible",
       marker(kBox + "overflow='visible'", "<rect x='-4' y='-4' width='20' height='20' fill='#a00'/>") + kAngle +
           "marker-end='url(#m)'/>",
       line + "<rect x='70' y='70' width='20' height='20' fill='#a00'/>"},
      {"in the colour of the stroke",
       marker(kBox, "<path d='M0 0L12 6L0 12Z' fill='context-stroke' stroke='context-fill'/>") + kAngle +
           "marker-mid='url(#m)'/>",
       line + "<g transform='translate(74 14)'><path d='M0 0L12 6L0 12Z' fill='#00a'/></g>"},
      {"below the stroke", marker(kBox, kArrow) + kAngle + "style='marker-start:url(#m);paint-order:markers'/>",
       arrowAt(20, 20, 0) + line},
      {"a contour that closes has its direction at both ends",
       marker(kBox + "orient='auto'", kArrow) + "<path fill='none' marker-start='url(#m)' d='M20 20H80V80H20Z'/>",
       arrowAt(20, 20, -45)},
      {"arcs have no vertices inside",
       marker(kBox, kArrow) + "<path fill='none' marker-mid='url(#m)' d='M20 50A30 30 0 1 1 50 80L20 80'/>",
       arrowAt(50, 80, 0)},
      {"segments without length go on as the one before",
       marker(kBox + "orient='auto'", kArrow) + "<path fill='none' marker-end='url(#m)' d='M20 20V80V80'/>",
       arrowAt(20, 80, 90)},
      {"polygons and lines",
       marker(kBox, kArrow) + "<g fill='none' marker-start='url(#m)'><polygon points='20 20 80 20 80 80'/>"
                              "<line x1='50' y1='60' x2='9' y2='9'/></g>",
       arrowAt(20, 20, 0) + arrowAt(50, 60, 0)},
      {"its own opacity and clip path",
       "<clipPath id='c'><rect width='12' height='6'/></clipPath>" +
           marker(kBox + "opacity='0.5' clip-path='url(#c)'", "<rect width='12' height='12' fill='#a00'/>") + kAngle +
           "marker-end='url(#m)'/>",
       line + "<rect x='74' y='74' width='12' height='6' fill='#a00' opacity='.5'/>"},
      {"other shapes have none",
       marker(kBox, kArrow) + "<rect x='9' y='9' width='50' height='50' marker-mid='url(#m)'/>",
       "<rect x='9' y='9' width='50' height='50'/>"},
      {"none without a stroke's width",
       marker("", kArrow) + "<path d='M9 9h50v50' stroke-width='0' marker-mid='url(#m)'/>", "<path d='M9 9h50v50'/>"},
  };
  for (const Pair& pair : pairs) expectSame(pair);
}

TEST(SvgEqual, WrongMarkersAreNamed) {
  const auto said = [](const std::string& text) { return page(text).placed; };
  EXPECT_EQ(said("<path d='M0 0h9v9' marker-end='url(#m)'/>"),
            Texts{"test.svg:2:1: warning: <path> has the marker 'url(#m)', which does not exist; it is not drawn"});
  EXPECT_EQ(said("<g id='m'/><path d='M0 0h9v9' marker-end='url(#m)'/>"),
            Texts{"test.svg:2:12: warning: <path> has the marker 'url(#m)', which is a <g>; it is not drawn"});
  EXPECT_EQ(
      said("<path d='M0 0h9v9' marker-end='url(a.svg#m)'/>"),
      Texts{"test.svg:2:1: warning: <path> has the marker 'url(a.svg#m)', which is not a <marker> of this file; it is "
            "not drawn"});
  EXPECT_EQ(said("<marker id='m'><path d='M0 0h2v2' marker-mid='url(#m)'/></marker><path d='M0 0h9v9' "
                 "marker-end='url(#m)'/>"),
            Texts{"test.svg:2:16: warning: <path> has the marker 'url(#m)', which contains itself; it is not drawn"});
  EXPECT_EQ(said("<marker id='m' orient='up'/><path d='M0 0h9v9' marker-end='url(#m)'/>").size(), 1u);
  // Each multiplies the next; the elements that may be visited bound them.
  std::string bomb;
  for (int i = 0; i < 12; ++i)
    bomb += "<marker id='m" + std::to_string(i) + "' overflow='visible'><path d='M0 0h1h1h1h1h1h1h1h1h1' " +
            "style='marker:url(#m" + std::to_string(i + 1) + ")'/></marker>";
  vector::svg::ImportLimits limits;
  limits.elements = 10'000;
  const Import many = import("<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>" + bomb +
                                 "<path d='M0 0h1h1' marker-mid='url(#m0)'/></svg>",
                             limits);
  ASSERT_FALSE(many.messages.empty());
  EXPECT_EQ(many.messages.back(), "E line 1: more than 10000 elements; the rest is not drawn");
}

TEST(SvgEqual, PatternsAreCopies) {
  const auto rects = [](int left, int top, int step, int count, const std::string& rest) {
    std::string all;
    for (int y = 0; y < count; ++y)
      for (int x = 0; x < count; ++x)
        all += "<rect x='" + std::to_string(left + x * step) + "' y='" + std::to_string(top + y * step) + "' " + rest +
               "/>";
    return all;
  };
  const std::string inUser = "<pattern id='p' patternUnits='userSpaceOnUse' width='20' height='20' ",
                    dot = "><rect width='10' height='10' fill='#a00'/></pattern>",
                    square = "<rect width='80' height='80' fill='url(#p)'/>";
  const std::string dots = rects(0, 0, 20, 4, "width='10' height='10' fill='#a00'");
  const Pair pairs[] = {
      {"in user space", inUser + dot + square, dots},
      {"from its corner", inUser + "x='5' y='-15'" + dot + "<rect x='5' y='5' width='80' height='80' fill='url(#p)'/>",
       "<g transform='translate(5 5)'>" + dots + "</g>"},
      {"by the box of what is painted", "<pattern id='p' width='25%' height='.25'" + dot + square, dots},
      {"content by the box",
       "<pattern id='p' width='.25' height='.25' patternContentUnits='objectBoundingBox'><rect "
       "width='.125' height='.125' fill='#a00'/></pattern>" +
           square,
       dots},
      {"with a viewBox", inUser + "viewBox='0 0 2 2'><rect width='1' height='1' fill='#a00'/></pattern>" + square,
       dots},
      {"with a transform",
       "<pattern id='p' patternUnits='userSpaceOnUse' width='10' height='10' "
       "patternTransform='scale(2)'><rect width='5' height='5' fill='#a00'/></pattern>" +
           square,
       dots},
      {"by reference",
       "<pattern id='q' width='20' height='20'" + dot + "<pattern id='p' href='#q' patternUnits='userSpaceOnUse'/>" +
           square,
       dots},
      {"what reaches beyond a tile is clipped",
       inUser + "><rect x='-5' y='-5' width='15' height='15' fill='#a00'/></pattern>" + square, dots},
      {"fades as one", inUser + dot + "<rect width='80' height='80' fill='url(#p)' fill-opacity='.5'/>",
       "<g opacity='.5'>" + dots + "</g>"},
      {"groups of its own",
       inUser +
           "><g opacity='.5'><rect width='10' height='10' fill='#a00'/><rect width='5' "
           "height='10' fill='#00a'/></g></pattern>" +
           square,
       "<g opacity='.5'>" + dots + rects(0, 0, 20, 4, "width='5' height='10' fill='#00a'") + "</g>"},
      {"gradients move with it",
       "<linearGradient id='g'><stop stop-color='red'/><stop offset='1' stop-color='blue'/>"
       "</linearGradient>" +
           inUser + "><rect width='10' height='10' fill='url(#g)'/></pattern>" + square,
       "<linearGradient id='g'><stop stop-color='red'/><stop offset='1' stop-color='blue'/></linearGradient>" +
           rects(0, 0, 20, 4, "width='10' height='10' fill='url(#g)'")},
      {"strokes", inUser + dot + "<path d='M0 10H80' stroke='url(#p)' stroke-width='20'/>",
       "<rect width='10' height='10' fill='#a00'/><rect x='20' width='10' height='10' fill='#a00'/><rect x='40' "
       "width='10' height='10' fill='#a00'/><rect x='60' width='10' height='10' fill='#a00'/>"},
      {"inherits where it stands, not where it is used",
       "<g fill='#a00'>" + inUser + "><rect width='10' height='10'/></pattern></g><g fill='#00f'>" + square + "</g>",
       dots},
  };
  for (const Pair& pair : pairs) expectSame(pair);
  const auto said = [](const std::string& text) { return page(text).messages; };
  EXPECT_EQ(said("<pattern id='p' width='1' height='1'><rect width='9' height='9' fill='url(#p) red'/></pattern>"
                 "<rect width='9' height='9' fill='url(#p)'/>"),
            Texts{"W line 2: <rect> fill refers to a pattern that contains itself; its fallback is used"});
  EXPECT_EQ(said(inUser + "patternTransform='scale(.001)'" + dot + square),
            Texts{"W line 2: <rect> is painted with a pattern of more than 65536 tiles, which is not supported; it is "
                  "not painted"});
  EXPECT_EQ(said(inUser + "overflow='visible'" + dot + square),
            Texts{"W line 2: overflow 'visible' is not supported: <pattern> is clipped to its tiles"});
  EXPECT_EQ(said("<pattern id='p'><rect/></pattern>" + square),
            Texts{"W line 2: <rect> fill refers to a pattern without extent; it is not painted"});
}

TEST(SvgEqual, TextIsOutlines) {
  const auto at = [](double x, double y, const std::string& rest = "", double side = 8) {
    return "<rect x='" + std::to_string(x) + "' y='" + std::to_string(y - side) + "' width='" + std::to_string(side) +
           "' height='" + std::to_string(side) + "' " + rest + "/>";
  };
  const Pair pairs[] = {
      {"in a row", "<text x='10' y='40'>ab d</text>", at(10, 40) + at(20, 40) + at(40, 40)},
      {"white space collapses", "<text x='10' y='40'>\n a \n b\n</text>", at(10, 40) + at(30, 40)},
      {"or is kept", "<text x='10' y='40' xml:space='preserve'> a  b</text>", at(20, 40) + at(50, 40)},
      {"between elements too", "<text x='10' y='40'><tspan>a</tspan> <tspan>b</tspan></text>", at(10, 40) + at(30, 40)},
      {"in the middle", "<text x='50' y='40' text-anchor='middle'>abcd</text>",
       at(30, 40) + at(40, 40) + at(50, 40) + at(60, 40)},
      {"at the end", "<text x='50' y='40' text-anchor='end'>ab</text>", at(30, 40) + at(40, 40)},
      {"each at its place", "<text x='10 40' y='40 60'>abc</text>", at(10, 40) + at(40, 60) + at(50, 60)},
      {"moved", "<text x='10' y='40' dx='5 5' dy='0 10'>abc</text>", at(15, 40) + at(30, 50) + at(40, 50)},
      {"what is further in counts", "<text x='10 20 30' y='40'>a<tspan x='70'>b</tspan>c</text>",
       at(10, 40) + at(70, 40) + at(30, 40)},
      {"turned", "<text x='50' y='50' rotate='90'>a</text>", at(0, 0, "transform='translate(50 50) rotate(90)'")},
      {"styled in parts",
       "<text x='10' y='40' fill='#a00'>a<tspan fill='#0a0' font-size='40'>b</tspan><tspan "
       "style='display:none'>c</tspan>"
       "d</text>",
       at(10, 40, "fill='#a00'") + at(20, 40, "fill='#0a0'", 16) + at(40, 40, "fill='#a00'")},
      {"spacing", "<text x='10' y='40' letter-spacing='5' word-spacing='10'>a b</text>", at(10, 40) + at(50, 40)},
      {"as long as it says", "<text x='10' y='40' textLength='60'>abc</text>", at(10, 40) + at(35, 40) + at(60, 40)},
      {"and stretched", "<text x='10' y='40' textLength='40' lengthAdjust='spacingAndGlyphs'>ab</text>",
       "<path d='M10 32h16v8h-16zM30 32h16v8h-16z'/>"},
      {"baselines",
       "<text y='40'><tspan x='10' dominant-baseline='middle'>a</tspan><tspan x='30' "
       "alignment-baseline='text-before-edge'>b</tspan><tspan x='60' baseline-shift='10'>c</tspan></text>",
       at(10, 44) + at(30, 56) + at(60, 30)},
      {"lines",
       "<text x='10' y='40' text-decoration='underline' fill='#a00'>ab<tspan text-decoration='line-through' "
       "fill='#00a'>c</tspan></text>",
       at(10, 40, "fill='#a00'") + at(20, 40, "fill='#a00'") +
           "<rect x='10' y='40' width='30' height='2' fill='#a00'/>" + at(30, 40, "fill='#00a'") +
           "<rect x='30' y='34' width='10' height='2' fill='#00a'/>"},
      {"lines of what is around, in the text's paint, without gaps",
       "<g text-decoration='underline' fill='#00a'><text x='10' y='40' letter-spacing='5' fill='#a00'>ab</text></g>",
       at(10, 40, "fill='#a00'") + at(25, 40, "fill='#a00'") +
           "<rect x='10' y='40' width='25' height='2' fill='#a00'/>"},
      {"a part as long as it says", "<text x='10' y='40'>a<tspan textLength='30'>bc</tspan>d</text>",
       at(10, 40) + at(20, 40) + at(40, 40) + at(60, 40)},
      {"a part stretched",
       "<text x='10' y='40'>a<tspan textLength='40' lengthAdjust='spacingAndGlyphs'>bc</tspan>d</text>",
       at(10, 40) + "<path d='M20 32h16v8h-16zM40 32h16v8h-16z'/>" + at(60, 40)},
      {"text of another element",
       "<text x='10' y='40'>a<tref href='#o'/>b</text><defs><text id='o'>x<tspan>y</tspan>"
       "</text></defs>",
       at(10, 40) + at(20, 40) + at(30, 40) + at(40, 40)},
      {"kerned", "<text x='10' y='40'>VV</text>", at(10, 40) + at(18, 40)},
      {"not kerned", "<text x='10' y='40' style='font-kerning:none'>VV</text>", at(10, 40) + at(20, 40)},
      {"not kerned as SVG 1.1 says it", "<text x='10' y='40' kerning='0'>VV</text>", at(10, 40) + at(20, 40)},
      {"no attribute", "<text x='10' y='40' font-kerning='none'>VV</text>", at(10, 40) + at(18, 40)},
      {"what deletes is not seen", "<text x='10' y='40'>a&#x7f;b</text>", at(10, 40) + at(20, 40)},
      {"nothing of no size", "<text x='10' y='40'>a<tspan font-size='0'>b</tspan>c</text>", at(10, 40) + at(20, 40)},
      {"from above", // half of the height of an x, 4 units, to the left of the line is the baseline
       "<text x='40' y='10' writing-mode='tb'>a<tspan dy='5' dx='2'>b</tspan></text>",
       at(0, 0, "transform='translate(36 10) rotate(90)'") + at(0, 0, "transform='translate(38 25) rotate(90)'")},
      {"from above in the middle", "<text x='40' y='50' writing-mode='vertical-rl' text-anchor='middle'>ab</text>",
       at(0, 0, "transform='translate(36 40) rotate(90)'") + at(0, 0, "transform='translate(36 50) rotate(90)'")},
      {"from x on along a path",
       "<path id='p' d='M20 10V90' fill='none'/><text x='10'><textPath href='#p'>ab</textPath></text>",
       at(0, 0, "transform='translate(20 20) rotate(90)'") + at(0, 0, "transform='translate(20 30) rotate(90)'")},
      {"along a path",
       "<path id='p' d='M20 10V90' fill='none'/><text><textPath href='#p' startOffset='10'>ab</textPath>"
       "</text>",
       at(0, 0, "transform='translate(20 20) rotate(90)'") + at(0, 0, "transform='translate(20 30) rotate(90)'")},
      {"gradients of the whole text's box",
       "<linearGradient id='g'><stop stop-color='red'/><stop offset='1' stop-color='blue'/></linearGradient><text "
       "x='10' "
       "y='40' fill='url(#g)'>abcd</text>",
       "<linearGradient id='g' gradientUnits='userSpaceOnUse' x1='10' x2='50'><stop stop-color='red'/><stop offset='1' "
       "stop-color='blue'/></linearGradient><g fill='url(#g)'>" +
           at(10, 40) + at(20, 40) + at(30, 40) + at(40, 40) + "</g>"},
      {"as a clip",
       "<clipPath id='c'><text x='10' y='40'>ab</text></clipPath><rect width='100' height='100' "
       "clip-path='url(#c)'/>",
       at(10, 40) + at(20, 40)},
  };
  for (const Pair& pair : pairs) {
    SCOPED_TRACE(pair.name);
    const Import given = written(pair.with), reference = page(pair.without);
    EXPECT_EQ(given.placed, Texts());
    EXPECT_LE(worst(picture(given), picture(reference)), kSame);
  }
  const auto said = [](const std::string& text) { return written(text).placed; };
  EXPECT_EQ(
      said("<text><textPath href='#p'>a</textPath></text>"),
      Texts{"test.svg:2:7: warning: <textPath> refers to '#p', which is not a shape of this file; it is not drawn"});
  EXPECT_EQ(said("<text>a<tref href='#a'/></text>"),
            Texts{"test.svg:2:8: warning: <tref> refers to an element that does not exist"});
  EXPECT_EQ(said("<text><tspan><textPath href='#p'>a</textPath></tspan></text>").size(), 1u);
  EXPECT_EQ(said("<text x='1 a'>ab</text>"), Texts{"test.svg:2:10: error: <text> has x '1 a', which is not a length"});
}

TEST(SvgEqual, UnicodeBidiIsMarksOfDirection) {
  const auto shaped = [](const std::string& text) {
    const std::string file = "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>" + text + "</svg>";
    std::string lines;
    const auto shape = [](void* user, const GpgpSvgText* line, GpgpSvgGlyphFn glyphFn, void* data) {
      auto& all = *static_cast<std::string*>(user);
      all.append(line->text, line->size);
      all += '|';
      for (uint32_t i = 0; i < line->spanCount; ++i) { // spans hold every byte once
        EXPECT_EQ(line->spans[i].begin, i ? line->spans[i - 1].end : 0u);
        EXPECT_EQ(line->spans[i].end, i + 1 < line->spanCount ? line->spans[i + 1].begin : line->size);
      }
      return shapeSquares(nullptr, line, glyphFn, data);
    };
    vector::svg::Reporter reporter(nullptr, nullptr, "test.svg");
    EXPECT_TRUE(vector::svg::importSvg(std::as_bytes(std::span(file.data(), file.size())), reporter, {}, {}, {},
                                       nullptr, {shape, &lines}));
    return lines;
  };
  EXPECT_EQ(shaped("<text>a<tspan unicode-bidi='bidi-override' direction='rtl'>bc</tspan>d</text>"),
            "a\u202ebc\u202cd|");
  EXPECT_EQ(shaped("<text unicode-bidi='isolate'>a<tspan>b</tspan></text>"), "\u2066ab|"); // the line's end closes
  EXPECT_EQ(shaped("<text><tspan unicode-bidi='isolate-override' direction='rtl'>a</tspan>b</text>"),
            "\u2068\u202ea\u202c\u2069b|");
  EXPECT_EQ(shaped("<text><tspan unicode-bidi='embed'>a</tspan><tspan x='5'>b</tspan></text>"), "\u202aa|\u202cb|");
  EXPECT_EQ(shaped("<text unicode-bidi='plaintext'>a</text>"), "\u2068a|");
  EXPECT_EQ(shaped("<text unicode-bidi='normal'>a</text>"), "a|");
}

TEST(SvgEqual, DrawingsAreImages) {
  const std::string inside =
      "data:image/svg+xml,%3Csvg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 20 10'%3E"
      "%3Cstyle%3Erect%7Bfill:%23a00%7D%3C/style%3E%3Crect id='r' width='10' height='30'/%3E%3C/svg%3E";
  const std::string image = "<image href=\"" + inside + "\" ", below = "<rect width='5' height='5'/>";
  const Pair pairs[] = {
      {"at their own size", image + "x='10' y='20'/>" + below,
       "<rect x='10' y='20' width='10' height='10' fill='#a00'/>" + below},
      {"fitted", image + "width='40' height='40'/>" + below,
       "<rect y='10' width='20' height='30' fill='#a00'/>" + below}, // what reaches beyond its page is seen
      {"stretched", image + "width='40' height='40' preserveAspectRatio='none'/>" + below,
       "<rect width='20' height='40' fill='#a00'/>" + below},
      {"faded", "<g opacity='.5'>" + image + "width='40' opacity='.5'/></g>",
       "<rect width='20' height='20' fill='#a00' opacity='.25'/>"},
      {"found by no one outside", image + "/><use href='#r' x='50'/>" + below,
       "<rect width='10' height='10' fill='#a00'/>" + below},
  };
  for (const Pair& pair : pairs) {
    SCOPED_TRACE(pair.name);
    EXPECT_LE(worst(picture(page(pair.with)), picture(page(pair.without))), kSame);
  }
  // What refers to a file finds none, and places say that they are inside.
  EXPECT_EQ(page("<image href='data:image/svg+xml,%3Csvg xmlns=\"http://www.w3.org/2000/svg\"%3E%3Cimage "
                 "href=\"a.png\"/%3E%3C/svg%3E'/>")
                .placed,
            Texts{"test.svg:2:1: image:1:41: warning: <image> is not supported"});
}

TEST(SvgEqual, ErrorsCountAsOtherRenderersTakeThem) {
  const std::string stops = "<stop stop-color='red'/><stop offset='1' stop-color='blue'/>";
  const std::string symbol =
      "<symbol id='s' viewBox='0 0 10 10'><path d='M0 0h10v10z'/></symbol><use href='#s' width='20' "
      "height='20' ";
  const Pair pairs[] = {
      {"a negative width of strokes", "<g stroke-width='9' stroke='red'><path d='M0 9h20' stroke-width='-1'/></g>", ""},
      {"a radius below zero is zero",
       "<radialGradient id='g' r='-1'>" + stops + "</radialGradient><rect width='9' height='9' fill='url(#g)'/>",
       "<rect width='9' height='9' fill='blue'/>"},
      {"templates that refer back",
       "<linearGradient id='g' href='#h'/><linearGradient id='h' href='#g'>" + stops +
           "</linearGradient><rect width='9' height='9' fill='url(#g)'/>",
       "<linearGradient id='g'>" + stops + "</linearGradient><rect width='9' height='9' fill='url(#g)'/>"},
      {"a pattern measured by nothing has its fallback",
       "<pattern id='p' width='.5' height='.5'><rect width='9' height='9'/></pattern><path d='M0 9h20' "
       "stroke-width='4' "
       "stroke='url(#p) red'/>",
       "<rect y='7' width='20' height='4' fill='red'/>"},
      {"a pattern of nothing has its fallback",
       "<pattern id='p' width='5' height='5'/><rect width='20' height='4' fill='url(#p) red'/>",
       "<rect width='20' height='4' fill='red'/>"},
      {"a comma before a command", "<path d='M5 5H20,V20'/>", "<path d='M5 5H20V20'/>"},
      {"an <svg> is clipped in its own coordinates",
       "<clipPath id='c'><path d='M1 1h5v5z'/></clipPath><clipPath id='b' clipPathUnits='objectBoundingBox'>"
       "<path d='M0 0h.5v1z'/></clipPath><svg x='20' y='30' width='40' height='40' viewBox='0 0 10 10' "
       "clip-path='url(#c)'><rect width='9' height='9'/></svg><svg x='50' y='50' width='20' height='20' "
       "clip-path='url(#b)'><rect x='5' width='10' height='10'/></svg>",
       "<path d='M24 34h20v20zM55 50h5v10z'/>"},
      {"markers of less than no size",
       "<marker id='m' markerHeight='-1'><rect width='9' height='9'/></marker><path d='M0 9h20' marker-end='url(#m)'/>",
       ""},
      {"style sheets give a use no size", symbol + "style='width:50px;height:5px'/>", symbol + "/>"},
      {"escapes in base 64",
       "<image "
       "href='data:image/"
       "svg+xml;base64,PHN2ZyB4bWxucz0iaHR0cDovL3d3dy53My5vcmcvMjAwMC9zdmciIHdpZHRoPSI5IiBoZWlnaHQ9Ijki"
       "PjxyZWN0IHdpZHRoPSI5IiBoZWlnaHQ9IjkiLz48L3N2Zz4%3D'/>",
       "<rect width='9' height='9'/>"},
  };
  for (const Pair& pair : pairs) {
    SCOPED_TRACE(pair.name);
    EXPECT_LE(worst(picture(page(pair.with)), picture(page(pair.without))), kSame);
  }
  const auto steps = [](const std::string& filter, const std::string& element = "<rect width='9' height='9' ") {
    const Import i = page("<filter id='f'><feOffset dx='5'/></filter>" + element + "filter='" + filter + "'/>");
    size_t count = 0;
    for (const auto& group : i.drawing.groups) count += group.layer ? group.layer->steps.size() : 0;
    return count;
  };
  EXPECT_EQ(steps("url(#f)"), 1u);
  EXPECT_EQ(steps("url(#f) url(#none) blur(2px)"), 2u) << "only the one that is not there is left out";
  EXPECT_EQ(steps("hue-rotate(45deg)"), 1u);
  EXPECT_EQ(steps("hue-rotate(0)"), 1u);
  EXPECT_EQ(steps("hue-rotate(45)"), 0u) << "an angle without a unit";
  EXPECT_EQ(steps("url(#f)", "<rect width='0' height='9' "), 0u) << "what has no size is not rendered";
}

TEST(SvgEqual, TransformsOfAttributesHaveNoUnits) {
  const std::string start = "<rect width='20' height='20' ";
  for (const char* wrong : {"translate(20px)", "translate(5%)", "rotate(20deg)", "skew(20)", "translateX(20)",
                            "TRANSLATE(9)", "inherit", "translate(9) foo(3)"}) {
    const Import i = page(start + "transform='" + wrong + "'/>");
    EXPECT_EQ(i.messages.size(), 1u) << wrong;
    EXPECT_LE(worst(picture(i), picture(page(start + "/>"))), kSame) << wrong;
  }
  expectSame({"lists", start + "transform=' translate(20,-1e0),\nscale(2 .5)'/>",
              "<rect x='20' y='-1' width='40' height='10'/>"});
  expectSame(
      {"style sheets may", start + "style='transform:translateX(20px)'/>", "<rect x='20' width='20' height='20'/>"});
}

TEST(SvgEqual, SelectorsChooseElements) {
  const std::string four = "<g id='g'><rect width='20' height='20'/><rect x='20' width='20' height='20' class='a b'/>"
                           "<circle cx='50' cy='10' r='10' data-x='Up down'/><rect x='60' width='20' height='20' "
                           "id='1:a'/></g>";
  const auto filled = [](int which) { // by bits
    const char* shapes[] = {"<rect width='20' height='20'", "<rect x='20' width='20' height='20'",
                            "<circle cx='50' cy='10' r='10'", "<rect x='60' width='20' height='20'"};
    std::string all;
    for (int i = 0; i < 4; ++i) all += std::string(shapes[i]) + (which >> i & 1 ? " fill='#a00'/>" : "/>");
    return all;
  };
  const struct {
    const char* selector;
    int which;
  } rows[] = {{"g > :first-child", 1},
              {"g > :last-child", 8},
              {"rect:nth-child(2)", 2},
              {"g > :nth-child(odd)", 5},
              {"g > :nth-child( 2n )", 10},
              {"g > :nth-child(-n + 2)", 3},
              {"g > :nth-last-child(2)", 4},
              {"rect:nth-of-type(3)", 8},
              {"g > :first-of-type", 5},
              {"circle:only-of-type", 4},
              {"rect:only-child", 0},
              {"rect:not(.a)", 9},
              {"g > *:not(rect, :nth-child(1))", 4},
              {":is(circle, .b)", 6},
              {"g :where(circle)", 4},
              {"[data-x='up DOWN' i]", 4},
              {"[data-x~=down]", 4},
              {"[data-x|=Up]", 0},
              {"#\\31 \\:a", 8},
              {"rect + rect", 2},
              {"rect ~ circle", 4},
              {"*|circle", 4},
              {"rect:hover, circle:focus", 0},
              {"g:root > rect", 0},
              {"rect:empty", 11},
              {"a:link rect", 0}};
  for (const auto& row : rows)
    expectSame(
        {row.selector, "<style>" + std::string(row.selector) + " {fill:#a00}</style>" + four, filled(row.which)});
  // Which of two counts.
  expectSame(
      {"not counts as what is in it", "<style>rect:not(#z) {fill:#a00} .a.b {fill:#0f0}</style>" + four, filled(11)});
  expectSame({"where counts nothing",
              "<style>:where(#g) rect {fill:#a00} rect {fill:#a00} rect.a {fill:#000}</style>" + four, filled(9)});
}

TEST(SvgEqual, ValuesAreCalculated) {
  const std::string square = "<rect x='10' y='10' width='40' height='40' fill='#a00'/>";
  const Pair pairs[] = {
      {"a variable", "<g style='--c: #a00'><rect x='10' y='10' width='40' height='40' fill='var(--c)'/></g>", square},
      {"the fallback", "<rect x='10' y='10' width='40' height='40' style='fill:var(--c, var(--d, #a00))'/>", square},
      {"a variable of variables",
       "<style>:root {--r: 170; --c: rgb(var(--r), 0, 0)} g {--r: 0}</style><g><rect x='10' y='10' width='40' "
       "height='40' style='fill:var(--c)'/></g>",
       square},
      {"names have their case",
       "<g style='--c:#00f;--C:#a00'><rect x='10' y='10' width='40' height='40' "
       "style='fill:var(--C)'/></g>",
       square},
      {"in a length",
       "<g style='--w:40px'><rect x='10' y='10' width='var(--w)' style='height:var(--w)' fill='#a00'/></g>", square},
      {"calc", "<rect x='calc(5px * 2)' y='10' width='calc(100% - 60px)' height='calc((1em + 8px) * 2)' fill='#a00'/>",
       square},
      {"min, max and clamp",
       "<rect x='min(10px, 90%)' y='max(10px, 1%)' width='clamp(40px, 1em, 90px)' height='40' fill='#a00'/>", square},
      {"parts of the page",
       "<svg viewBox='0 0 100 100'><rect x='10vw' y='10vh' width='40vmin' height='40vmax' "
       "fill='#a00'/></svg>",
       square},
      {"in transforms",
       "<rect width='40' height='40' fill='#a00' style='transform:translate(calc(4px + 6%), "
       "min(10px, 20px))'/>",
       square},
      {"in opacity", "<rect x='10' y='10' width='40' height='40' fill='#a00' opacity='calc(1 / 2)'/>",
       "<rect x='10' y='10' width='40' height='40' fill='#a00' opacity='.5'/>"},
      {"percentages of a gradient's box",
       "<linearGradient id='g' style='transform:translate(50%)'><stop stop-color='red'/><stop offset='1' "
       "stop-color='blue'/></linearGradient><rect x='10' y='10' width='40' height='40' fill='url(#g)'/>",
       "<linearGradient id='g' x1='.5' x2='1.5'><stop stop-color='red'/><stop offset='1' "
       "stop-color='blue'/></linearGradient><rect x='10' y='10' width='40' height='40' fill='url(#g)'/>"},
  };
  for (const Pair& pair : pairs) expectSame(pair);
  const auto said = [](const std::string& text) { return page(text).messages; };
  EXPECT_EQ(said("<rect width='9' height='9' fill='var(--none)'/>"),
            Texts{"W line 2: <rect> has fill 'var(--none)', which is a variable without a value; it is as if it were "
                  "unset"});
  EXPECT_EQ(said("<g style='--a:var(--b);--b:var(--a)'><rect width='9' height='9' fill='var(--a)'/></g>").size(), 1u);
  EXPECT_EQ(said("<rect width='calc(1px + 2)' height='9'/>").size(), 1u);
  EXPECT_EQ(said("<rect width='calc(1px+2px)' height='9'/>").size(), 1u);
  // Each doubles the one before.
  std::string bomb = "--a0:xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx;";
  for (int i = 1; i < 60; ++i) {
    const std::string before = "var(--a" + std::to_string(i - 1) + ")";
    bomb += "--a" + std::to_string(i) + ":" + before + before + ";";
  }
  EXPECT_EQ(said("<g style='" + bomb + "'><rect width='9' height='9' fill='var(--a59)'/></g>").size(), 1u);
}

} // namespace
