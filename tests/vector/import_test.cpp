// The SVG importer: elements and attributes against closed forms, messages with their lines, real drawings, hostile
// input.
#include "oracle.h"
#include "svg_import.h"
#include "vector/patch/drawing.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <random>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using vector::svg::Imported;

struct Point2 {
  double x, y;
};

/// The area by counting points of a grid, an independent look at what fills.
double area(const vector::svg::ImportedPath& path, int grid = 500) {
  const GpgpPath view = path.view();
  const PathOracle oracle(view);
  int inside = 0;
  for (int y = 0; y < grid; ++y)
    for (int x = 0; x < grid; ++x) inside += oracle.inside((x + 0.4989) * 100 / grid, (y + 0.5013) * 100 / grid);
  return inside * 1e4 / grid / grid;
}

using Floats = std::vector<float>;
using Texts = std::vector<std::string>;

std::string bytesOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(SvgImport, PathCommands) {
  const struct {
    const char* d;
    Floats points;
  } cases[] = {
      {"M1 2 3 4 5 6", {1, 2, 3, 4, 5, 6}},
      {"m1 2 3 4 5 6z m1 1 1 0 0 1", {1, 2, 4, 6, 9, 12, 2, 3, 3, 3, 3, 4}},
      {"M0 0h10v10H5V5", {0, 0, 10, 0, 10, 10, 5, 10, 5, 5}},
      {"M1.5.5-3e1-1E-1 2 2", {1.5f, 0.5f, -30, -0.1f, 2, 2}},
      {"M0,0C1 2,3 4,5 6s3 4 5 6", {0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 8, 10, 10, 12}},
      {"M0 0Q1 2 4 0T8 0", {0, 0, 1, 2, 4, 0, 7, -2, 8, 0}},
      {"M1 1L2 2L3 1ZL9 9L9 1", {1, 1, 2, 2, 3, 1, 1, 1, 9, 9, 9, 1}},
  };
  for (const auto& c : cases) {
    const Import i = page(std::string("<path d='") + c.d + "'/>");
    ASSERT_EQ(i.drawing.paths.size(), 1u) << c.d;
    EXPECT_EQ(i.drawing.paths[0].points, c.points) << c.d;
    EXPECT_EQ(i.messages, Texts()) << c.d;
  }
}

TEST(SvgImport, ArcsLieOnTheirCircle) {
  const Import i = page("<path d='M10 50a40 40 0 0180 0 40 40 0 01-80 0z'/>");
  ASSERT_EQ(i.drawing.paths.size(), 1u);
  EXPECT_NEAR(area(i.drawing.paths[0]), 1600 * std::numbers::pi, 8);
  for (size_t k = 0; k < i.drawing.paths[0].points.size(); k += 6) // ends of the cubics
    EXPECT_NEAR(std::hypot(i.drawing.paths[0].points[k] - 50, i.drawing.paths[0].points[k + 1] - 50), 40, 1e-4);
}

TEST(SvgImport, ErrorsInPathDataKeepWhatCameBefore) {
  const Import i = page("<g>\n<path d='M0 0 L10 0 10 10\nL 5 x 7'/></g>");
  ASSERT_EQ(i.drawing.paths.size(), 1u);
  EXPECT_EQ(i.drawing.paths[0].points, (Floats{0, 0, 10, 0, 10, 10}));
  EXPECT_EQ(i.messages, (Texts{"E line 4: <path> has an error in its path data at character 22; drawn up to there"}));
}

TEST(SvgImport, ShapesHaveTheirAreas) {
  const double pi = std::numbers::pi;
  const struct {
    const char* element;
    double area;
  } cases[] = {
      {"<rect x='10' y='20' width='50' height='30'/>", 1500},
      {"<rect x='10%' y='20' width='50' height='30' rx='10'/>", 1500 - (4 - pi) * 100},
      {"<rect x='10' y='20' width='50' height='30' rx='20' ry='99'/>", 1500 - (4 - pi) * 300},
      {"<circle cx='50' cy='50' r='30'/>", 900 * pi},
      {"<ellipse cx='50' cy='50' rx='30' ry='20'/>", 600 * pi},
      {"<polygon points='10,10 90,10 90,90'/>", 3200},
      {"<polyline points='10 10,90 10 90 90'/>", 3200},
      {"<rect width='1in' height='10'/>", 960},
      {"<rect width='20' height='10' transform='translate(30,30) rotate(30) scale(2,1) skewX(20)'/>", 400},
      {"<rect width='20' height='10' transform='matrix(0 2 -1 0 60 10)'/>", 400},
      {"<g transform='scale(2)'><svg x='5' y='5' width='20' height='20' viewBox='0 0 10 10'>"
       "<rect width='10' height='5'/></svg></g>",
       800},
      {"<defs><rect id='a' width='10' height='10'/></defs><use href='#a' x='20' y='30'/>", 100},
      {"<symbol id='s' viewBox='0 0 10 10'><rect width='10' height='10'/></symbol>"
       "<use href='#s' width='40' height='20'/>",
       400},
      {"<path fill-rule='evenodd' d='M0 0H50V50H0zM10 10H40V40H10z'/>", 1600},
  };
  for (const auto& c : cases) {
    const Import i = page(c.element);
    ASSERT_EQ(i.drawing.paths.size(), 1u) << c.element;
    EXPECT_NEAR(area(i.drawing.paths[0]), c.area, 0.006 * c.area) << c.element;
    EXPECT_EQ(i.messages, Texts()) << c.element;
  }
}

TEST(SvgImport, StrokesCoverLengthTimesWidth) {
  const double pi = std::numbers::pi;
  const struct {
    const char* element;
    double area;
  } cases[] = {
      {"<path d='M10 50H90' stroke-width='10'/>", 800},
      {"<path d='M20 50H80' stroke-width='10' stroke-linecap='square'/>", 700},
      {"<path d='M20 50H80' stroke-width='10' stroke-linecap='round'/>", 600 + 25 * pi},
      {"<path d='M20 20H80V80' stroke-width='20'/>", 2400},
      {"<path d='M20 20H80V80' stroke-width='20' stroke-linejoin='bevel'/>", 2350},
      {"<path d='M20 20H80V80' stroke-width='20' stroke-linejoin='round'/>", 2300 + 25 * pi},
      {"<path d='M20 20H80V80' stroke-width='20' stroke-miterlimit='1'/>", 2350},
      {"<path d='M20 20H80V80' stroke-width='20' stroke-miterlimit='1' stroke-linejoin='miter-clip'/>",
       2400 - (10 * std::numbers::sqrt2 - 10) * (10 * std::numbers::sqrt2 - 10)},
      {"<path d='M20 20H80V80' stroke-width='20' stroke-miterlimit='2' stroke-linejoin='miter-clip'/>", 2400},
      {"<path d='M20 20H80H40' stroke-width='10' stroke-miterlimit='2' stroke-linejoin='miter-clip'/>", 700},
      {"<rect x='20' y='20' width='60' height='60' stroke-width='10'/>", 2400},
      {"<circle cx='50' cy='50' r='30' stroke-width='10'/>", 600 * pi},
      {"<circle cx='50' cy='50' r='3' stroke-width='20'/>", 169 * pi},
      {"<path d='M10 50H90' stroke-width='10' stroke-dasharray='10'/>", 400},
      {"<path d='M10 50H90' stroke-width='10' stroke-dasharray='10 5 5' stroke-dashoffset='-3'/>", 400},
      {"<path d='M50 50z' stroke-width='20' stroke-linecap='round'/>", 100 * pi},
      {"<g transform='scale(2 1)'><path d='M10 50H40' stroke-width='10'/></g>", 600},
      {"<g transform='scale(2)'><path d='M10 25H40' stroke-width='10' vector-effect='non-scaling-stroke'/></g>", 600},
  };
  for (const auto& c : cases) {
    const Import i = page(std::string("<g fill='none' stroke='red'>") + c.element + "</g>");
    ASSERT_EQ(i.drawing.paths.size(), 1u) << c.element;
    EXPECT_EQ(i.drawing.paths[0].rule, GPGP_FILL_NON_ZERO);
    EXPECT_NEAR(area(i.drawing.paths[0]), c.area, 0.01 * c.area) << c.element;
  }
}

/// How far points of all curves are from the nearest of some circles around (cx, cy), at most.
double offCircles(const vector::svg::ImportedPath& path, Point2 center, std::initializer_list<double> radii) {
  double worst = 0;
  Point2 at{};
  const float* p = path.points.data();
  const auto check = [&](double x, double y) {
    const double r = std::hypot(x - center.x, y - center.y);
    double off = 1e30;
    for (const double radius : radii) off = std::min(off, std::abs(r - radius));
    worst = std::max(worst, off);
  };
  for (const GpgpPathVerb verb : path.verbs) {
    const size_t points = verb == GPGP_PATH_CUBIC ? 3 : verb == GPGP_PATH_CLOSE ? 0 : 1;
    if (verb == GPGP_PATH_CUBIC)
      for (int i = 0; i <= 32; ++i) {
        const double t = i / 32.0, s = 1 - t;
        const auto on = [&](double start, size_t axis) {
          return s * s * s * start + 3 * s * s * t * p[axis] + 3 * s * t * t * p[2 + axis] + t * t * t * p[4 + axis];
        };
        check(on(at.x, 0), on(at.y, 1));
      }
    p += 2 * points;
    if (points) at = {p[-2], p[-1]};
  }
  return worst;
}

TEST(SvgImport, StrokesAndArcsFollowTheScale) {
  const auto drawn = [](const std::string& inside, double scale) {
    const Import icon =
        import("<svg xmlns='http://www.w3.org/2000/svg' width='24' height='24' fill='none' stroke='black'>" + inside +
                   "</svg>",
               {}, scale);
    EXPECT_EQ(icon.messages, Texts{});
    return icon.drawing.paths.at(0);
  };
  // A circle of four cubics, so that only the stroke depends on the scale; it is the other's offset.
  const std::string k = std::to_string(11 * 0.5522847498);
  const std::string ring = "<g transform='translate(12 12)'><path stroke-width='2' d='M11 0C11 " + k + " " + k +
                           " 11 0 11S-11 " + k + " -11 0-" + k + " -11 0-11 11-" + k + " 11 0Z'/></g>";
  const double rough = offCircles(drawn(ring, 1), {12, 12}, {10, 12});
  const double own = 11 * 2.73e-4; // what the four cubics are off themselves
  EXPECT_LT(rough, 0.05 + own);
  EXPECT_LT(offCircles(drawn(ring, 100), {12, 12}, {10, 12}), 0.05 / 100 + own);
  const std::string circle = "<circle cx='12' cy='12' r='11' fill='black' stroke='none'/>";
  for (const double scale : {1.0, 40.0, 1000.0})
    EXPECT_LT(offCircles(drawn(circle, scale), {12, 12}, {11}), 1e-4 / scale + 2e-6) << scale; // and float's own
  const std::string bow = "<path d='M1 12A11 11 0 0 1 23 12' fill='black' stroke='none'/>";
  EXPECT_LT(offCircles(drawn(bow, 40), {12, 12}, {11}), 1e-4 / 40 + 2e-6);
  // More exactness costs little; a page in other units is measured in its own pixels.
  EXPECT_LT(drawn(ring, 100).verbs.size(), 8 * drawn(ring, 1).verbs.size());
  // Lines that do not scale are as wide as they say in the pixels that are seen.
  const auto line = drawn("<path d='M2 12H22' stroke-width='3' vector-effect='non-scaling-stroke'/>", 6);
  float top = 1e9f, bottom = -1e9f;
  for (size_t i = 1; i < line.points.size(); i += 2) {
    top = std::min(top, line.points[i]);
    bottom = std::max(bottom, line.points[i]);
  }
  EXPECT_FLOAT_EQ(bottom - top, 0.5f);
}

TEST(SvgImport, CompilesForAScale) {
  const std::string text = "<svg width='24' height='24'><path d='M1 12c2-6 4-6 5 0s3 6 5 0' stroke='red'/></svg>";
  GpgpSvgSource source = GPGP_SVG_SOURCE_INIT;
  source.data = text.data();
  source.size = text.size();
  GpgpSvgReport report{};
  source.report = &report;
  const auto curves = [&](float scale) {
    source.scale = scale;
    GpgpBlob blob{};
    EXPECT_EQ(gpgpCompileSvg(&source, &blob), GPGP_SUCCESS);
    gpgpFreeBlob(&blob);
    return report.curves;
  };
  EXPECT_EQ(curves(0), curves(1));
  EXPECT_GT(curves(1000), curves(1));
  for (const float scale : {-1.0f, 1e7f, NAN}) {
    source.scale = scale;
    GpgpBlob blob{};
    EXPECT_EQ(gpgpCompileSvg(&source, &blob), GPGP_ERROR_INVALID_ARGUMENT);
  }
}

TEST(SvgImport, ASelectorThatIsNotValidTakesItsRuleWithIt) {
  const auto colour = [](const std::string& sheet) {
    const Import drawn = page("<style>rect { fill: #0f0 } " + sheet + "</style><rect width='9' height='9'/>");
    const auto& c = drawn.drawing.paths.at(0).color;
    return c[0] > 0 ? 'r' : c[1] > 0 ? 'g' : 'b';
  };
  EXPECT_EQ(colour("rect, a { fill: #f00 }"), 'r');
  EXPECT_EQ(colour("rect, a:hover { fill: #f00 }"), 'r');
  EXPECT_EQ(colour("rect, { fill: #f00 }"), 'g');
  EXPECT_EQ(colour("rect, a > { fill: #f00 } rect { fill: #00f }"), 'b');
}

TEST(SvgImport, StyleSheetsMoveAndShape) {
  const auto points = [](const std::string& inside) {
    const Import drawn = page(inside);
    EXPECT_EQ(drawn.messages, Texts{}) << inside;
    return drawn.drawing.paths.empty() ? Floats{} : drawn.drawing.paths[0].points;
  };
  const Floats square{20, 10, 30, 10, 30, 20, 20, 20};
  const struct {
    const char* text;
    Floats points;
  } cases[] = {
      {"<rect width='10' height='10' style='transform:translate(20px,10px)'/>", square},
      {"<style>rect { transform: translateX(20px) translateY(10px) }</style><rect width='10' height='10'/>", square},
      {"<rect width='10' height='10' transform='scale(9)' style='transform:translate(20px,10px)'/>", square},
      {"<rect width='10' height='10' font-size='5' style='transform:translateX(2em) translate(10%, 2em)'/>", square},
      {"<g style='transform: scale(2)'><rect x='10' y='5' width='5' height='5'/></g>", square},
      {"<rect x='20' y='-20' width='10' height='10' style='transform: rotate(90deg)'/>",
       {20, 20, 20, 30, 10, 30, 10, 20}},
      {"<rect x='20' y='-20' width='10' height='10' style='transform: rotate(.25turn)'/>",
       {20, 20, 20, 30, 10, 30, 10, 20}},
      {"<rect x='15' y='5' width='5' height='5' style='transform: scale(2); transform-origin: 10px 0'/>", square},
      {"<rect x='35' y='30' width='5' height='5' transform='scale(2)' transform-origin='center'/>", square},
      {"<rect x='60' y='55' width='5' height='5' transform='scale(2)' transform-origin='bottom right'/>", square},
      {"<rect style='x:20px;y:10px;width:10px;height:10px'/>", square},
      {"<style>rect { x: 20px; width: 10px } .a { width: 10% }</style>"
       "<rect class='a' x='1' y='10' width='3' height='10'/>",
       square},
      {"<path style='d:path(\"M20 10H30V20H20Z\")'/>", square},
      {"<clipPath id='c' style='transform:scale(2)'><path d='M0 0h9v9'/></clipPath>"
       "<rect clip-path='url(#c)' x='20' y='10' width='10' height='10'/>",
       square},
      {"<svg style='x:20px;y:10px' width='50' height='50' viewBox='0 0 50 50'><path d='M0 0H10V10H0'/></svg>", square},
  };
  for (const auto& c : cases) {
    const Floats drawn = points(c.text);
    ASSERT_EQ(drawn.size(), c.points.size()) << c.text;
    for (size_t i = 0; i < drawn.size(); ++i) EXPECT_NEAR(drawn[i], c.points[i], 1e-5) << c.text;
  }
  EXPECT_EQ(import("<svg style='width:60px;height:40px' viewBox='0 0 3 2'/>").drawing.width, 60);
  const Import clipped = page("<clipPath id='c' style='transform:scale(2)'><path d='M0 0h9v9'/></clipPath>"
                              "<rect clip-path='url(#c)' width='10' height='10'/>");
  EXPECT_EQ(clipped.drawing.groups.at(0).clip.at(0).points, (Floats{0, 0, 18, 0, 18, 18}));
}

TEST(SvgImport, DashesByPathLength) {
  const auto dashes = [](const std::string& attributes) {
    const Import drawn = page("<path fill='none' stroke='red' stroke-width='4' " + attributes + "/>");
    EXPECT_EQ(drawn.messages, Texts{});
    const auto& verbs = drawn.drawing.paths.at(0).verbs;
    return std::count(verbs.begin(), verbs.end(), GPGP_PATH_MOVE);
  };
  EXPECT_EQ(dashes("d='M0 15H50' stroke-dasharray='5' pathLength='10'"), 1);   // 25 on, 25 off
  EXPECT_EQ(dashes("d='M0 15H50' stroke-dasharray='5' pathLength='100'"), 10); // 2.5 each
  EXPECT_EQ(dashes("d='M0 15H50' stroke-dasharray='5' pathLength='0'"), 1);    // endless
  EXPECT_EQ(dashes("d='M0 5H10V15H0Z' stroke-dasharray='1 1' pathLength='8'"), 4);
  // A curve: the dash ends in its middle, by symmetry.
  const Import curve = page("<path fill='none' stroke='red' stroke-width='1e-3' d='M10 10C30 60 70 60 90 10' "
                            "stroke-dasharray='1' pathLength='2'/>");
  float right = 0;
  for (size_t i = 0; i < curve.drawing.paths.at(0).points.size(); i += 2)
    right = std::max(right, curve.drawing.paths[0].points[i]);
  EXPECT_NEAR(right, 50, 0.01);
  EXPECT_EQ(page("<path stroke='red' d='M0 5H9' stroke-dasharray='5' pathLength='-1'/>").messages,
            (Texts{"W line 2: <path> has pathLength '-1', which is not valid; ignored"}));
}

TEST(SvgImport, EntitiesOfTheFile) {
  const std::string svg = "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>";
  const auto withEntities = [](const std::string& entities, const std::string& rest) {
    return import("<?xml version='1.0'?>\n<!-- <!DOCTYPE --><!DOCTYPE svg PUBLIC '-//W3C' 'svg.dtd' [\n" + entities +
                  "]>\n" + rest);
  };
  const Import red = withEntities("<!ENTITY ns 'http://www.w3.org/2000/svg'><!-- <!ENTITY st 'fill:lime'> -->"
                                  "<!ENTITY st \"fill:&red;;font-family:'a'\"><!ENTITY red '#FF0000'>"
                                  "<!ENTITY st 'fill:blue'>",
                                  "<svg xmlns='&ns;' width='9' height='9'><path d='M0 0h9v9' style='&st;'/></svg>");
  EXPECT_EQ(red.messages, Texts{});
  EXPECT_EQ(red.error, "");
  const auto& color = red.drawing.paths.at(0).color;
  EXPECT_EQ(std::vector<float>(color, color + 4), (Floats{1, 0, 0, 1}));
  // Elements, and lines behind an entity that holds some.
  const Import elements = withEntities("<!ENTITY one '<path d=\"M0 0h9v9\"/>\n\n'>", svg + "&one;&one;\n<text/></svg>");
  EXPECT_EQ(elements.drawing.paths.size(), 2u);
  EXPECT_EQ(elements.messages, (Texts{"W line 7: <text> is not supported"}));
  // Comments, CDATA and unknown names stay.
  EXPECT_EQ(withEntities("<!ENTITY b '<'>", svg + "<!-- &b; --><style><![CDATA[ .a { &b; } ]]></style>&c;</svg>").error,
            "");
  EXPECT_EQ(withEntities("<!ENTITY a '&b;'>\n<!ENTITY b '&a;'>", "\n" + svg + "&a;</svg>").error,
            "6:62: an entity contains itself");
  std::string bomb = "<!ENTITY e0 'aaaaaaaaaa'>", empty = "<!ENTITY e0 ''>";
  for (int i = 1; i < 20; ++i) {
    std::string ten;
    for (int k = 0; k < 10; ++k) ten += "&e" + std::to_string(i - 1) + ";";
    for (std::string* all : {&bomb, &empty}) *all += "<!ENTITY e" + std::to_string(i) + " '" + ten + "'>";
  }
  EXPECT_NE(withEntities(bomb, svg + "&e19;</svg>").error.find("come to more than"), std::string::npos);
  EXPECT_EQ(withEntities(empty, svg + "&e19;</svg>").error, "");
  EXPECT_EQ(import("<!DOCTYPE svg [<!ENTITY a 'x").error.substr(0, 2), "1:");
}

TEST(SvgImport, APathOfTooManyCrossingsIsLeftOut) {
  // 2200 lines across 2200 others.
  std::string comb = "M0 0";
  for (int i = 0; i < 2200; ++i) comb += i % 2 ? "V0h.04" : "V99h.04";
  comb += "M0 0";
  for (int i = 0; i < 2200; ++i) comb += i % 2 ? "l-99 .04" : "l99 .04";
  const std::string text = "<svg xmlns='http://www.w3.org/2000/svg' width='100' height='100'>\n"
                           "<rect width='9' height='9'/>\n<path d='" +
                           comb + "'/>\n<circle r='9'/></svg>";
  Texts messages;
  GpgpSvgReport report{};
  GpgpSvgSource source = GPGP_SVG_SOURCE_INIT;
  source.data = text.data();
  source.size = text.size();
  source.report = &report;
  source.messageUserData = &messages;
  source.messageFn = [](void* user, const GpgpMessage* m) {
    static_cast<Texts*>(user)->push_back(withLine(placed(*m)));
  };
  GpgpBlob blob{};
  ASSERT_EQ(gpgpCompileSvg(&source, &blob), GPGP_SUCCESS);
  EXPECT_EQ(messages, (Texts{"line 3: <path>: the path crosses itself more than 4194304 times; not drawn"}));
  EXPECT_EQ(report.paths, 3u); // it is empty
  EXPECT_GE(report.patches, 2u);
  EXPECT_LT(report.patches, 100u);
  gpgpFreeBlob(&blob);
}

TEST(SvgImport, AnOutlineThatIsRefusedHasItsPlace) {
  const auto refused = [](const std::string& inside, uint32_t segments) {
    const std::string text = "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>\n" + inside + "</svg>";
    Texts messages;
    GpgpSvgSource source = GPGP_SVG_SOURCE_INIT;
    source.name = "a.svg";
    source.data = text.data();
    source.size = text.size();
    source.maxStorageBufferRange = 64 * segments / 4; // a drawing takes four such buffers
    source.messageUserData = &messages;
    source.messageFn = [](void* user, const GpgpMessage* m) { static_cast<Texts*>(user)->push_back(placed(*m)); };
    GpgpBlob blob{};
    EXPECT_EQ(gpgpCompileSvg(&source, &blob), GPGP_ERROR_UNSUPPORTED);
    EXPECT_EQ(blob.data, nullptr);
    return messages;
  };
  const std::string square = "<rect width='5' height='5'/>\n"; // two segments, besides level ones
  EXPECT_EQ(
      refused(square + square + "<g><circle r='3'/></g>", 5),
      Texts{"a.svg:4:4: error: <circle>: the drawing's outlines need more than 320 bytes, which is what a recording "
            "can bind"});
  const std::string clip = "<clipPath id='c'>\n<circle r='3'/></clipPath><g clip-path='url(#c)'>" + square + "</g>";
  EXPECT_EQ(refused(clip, 3),
            Texts{"a.svg:3:1: error: <circle>: the drawing's outlines need more than 192 bytes, which "
                  "is what a recording can bind"});
}

TEST(SvgImport, Colours) {
  const struct {
    const char* attributes;
    std::array<double, 4> srgb;
  } cases[] = {
      {"", {0, 0, 0, 1}},
      {"fill='#f00'", {1, 0, 0, 1}},
      {"fill='#00ff0080'", {0, 1, 0, 128 / 255.0}},
      {"fill='RebeccaPurple'", {0.4, 0.2, 0.6, 1}},
      {"fill='rgb(51, 102,153)'", {0.2, 0.4, 0.6, 1}},
      {"fill='rgba(20%,40%,60%,.5)' fill-opacity='.5'", {0.2, 0.4, 0.6, 0.25}},
      {"fill='hsl(120 100% 25% / 50%)'", {0, 0.5, 0, 0.5}},
      {"fill='hsla(0.5turn,100%,50%,.25)'", {0, 1, 1, 0.25}},
      {"fill='hsl(200grad,100%,50%)'", {0, 1, 1, 1}},
      {"fill='hsl(120 100 25)'", {0, 0.5, 0, 1}},           // numbers are percentages
      {"color='red' fill='hsl(120,100,25)'", {0, 0, 0, 1}}, // but not with commas
      {"fill='rgb(0,255,0'", {0, 1, 0, 1}},                 // the end closes what is open
      {"fill='hwb(0 20% 40%)'", {0.6, 0.2, 0.2, 1}},
      {"fill='hwb(0 20 40)'", {0.6, 0.2, 0.2, 1}},
      {"fill='hwb(90deg 60% 60%)'", {0.5, 0.5, 0.5, 1}},
      {"color='blue' fill='currentColor'", {0, 0, 1, 1}},
      {"fill='red' style='fill: lime'", {0, 1, 0, 1}},
      {"class='x y' fill='red'", {0, 0, 1, 1}},
      {"class='y' id='i' fill='red'", {1, 1, 0, 1}},
      {"class='z' style='fill:red'", {1, 1, 1, 1}},
      {"fill='inherit' opacity='0.5'", {0, 0, 0, 0.5}},
      {"style='fill:lime;/* note; */opacity:.5'", {0, 1, 0, 0.5}},
      {"style='/* a; */fill:red'", {1, 0, 0, 1}},
      {"style='fill:blue /* why */'", {0, 0, 1, 1}},
      {"style='Fill:RED;OPACITY:.25'", {1, 0, 0, 0.25}},
      {"class='u' style='fill:red'", {0, 0, 1, 1}},
      {"class='\u00e9'", {0, 1, 1, 1}},
      {"style='font-family:\"a;fill:red\";fill:lime'", {0, 1, 0, 1}},
  };
  for (const auto& c : cases) {
    const Import i =
        page(std::string("<style>/* c */ rect.y, .x { fill: blue } #i{fill:yellow} .z{fill:white "
                         "!important}.u{fill:blue !IMPORTANT}.\u00e9{fill:aqua}</style><rect width='9' height='9' ") +
             c.attributes + "/>");
    ASSERT_EQ(i.drawing.paths.size(), 1u) << c.attributes;
    for (size_t k = 0; k < 4; ++k) {
      const double v = c.srgb[k], linear = k == 3 ? v : v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
      EXPECT_NEAR(i.drawing.paths[0].color[k], linear, 1e-6) << c.attributes << " " << k;
    }
  }
}

TEST(SvgImport, StyleSheetsAreReadAsCss) {
  const std::pair<const char*, bool> cases[] = {
      {".a/*x*/.b {fill:red}", true}, // a comment is nothing between selectors' parts
      {".a/*x*/ .b {fill:red}", false},
      {".a/*x*/b {fill:red}", false},
      {"g/**/>/**/rect/**/ {fill:red}", true},
      {"g/**/ rect/*,*/.a {fill:red}", true},
      {"/*{*/ rect[/*]*/width/**/=/**/'9'/**/] {fill:red}", true},
      {"rect {fill/*;*/:/*}*/red}", true},
      {"rect {fill:re/**/d}", false},
      {"rect {stroke-dasharray:1px/**/2px;fill:red}", true},
      {"p {content:\"}\"} rect {fill:red}", true},
      {"p {content:'/*'} rect {fill:red} /* ' */", true},
      {"p {content:'\\'}'} rect {fill:red}", true},
      {"p {content:\\}} rect {fill:red}", true},
      {"p {content:[}]} rect {fill:red}", true},
      {"p {content:(}{})} rect {fill:red}", true},
      {"p {content:\"unclosed\n;x:y} rect {fill:red}", true}, // a string ends with its line
      {"p {mask:url(it's}) none} rect {fill:red}", true},
      {"p {mask:url( \"'}\" )} rect {fill:red}", true},
      {"p {mask:url(//a/*.css)} rect {fill:red} /* */", true},
      {"[title='{'] {fill:blue} rect {fill:red}", true},
      {"@import url(a;b);rect {fill:red}", true},
      {"@media print { rect {fill:blue} p[a='}'] {} } rect {fill:red}", true},
      {"rect {--x:{a;fill:blue};fill:red}", true},
      {"rect {fill:blue;--x:{a;fill:red}}", false},
  };
  for (const auto& [sheet, red] : cases) {
    const Import i =
        page("<style><![CDATA[" + std::string(sheet) + "]]></style><g><rect class='a b' width='9' height='9'/></g>");
    ASSERT_EQ(i.drawing.paths.size(), 1u) << sheet;
    EXPECT_EQ(i.drawing.paths[0].color[0], red ? 1 : 0) << sheet;
  }
  EXPECT_EQ(page("<style>/* a\n */\n/* b */ g::before/* c */ {}</style>").messages,
            (Texts{"W line 4: style selector 'g::before' is not supported"}));
}

TEST(SvgImport, StyleSheetsForOtherMediaAreLeftOut) {
  const struct {
    const char* media;
    bool counts;
    Texts messages;
  } cases[] = {
      {"", true, {}},
      {" ", true, {}},
      {"all", true, {}},
      {"print, Screen", true, {}},
      {"print", false, {}},
      {"print, speech", false, {}},
      {"screen and (color)", true, {}},
      {"screen and (min-width: 9px)",
       false,
       {"W line 2: media 'screen and (min-width: 9px)' is not supported: <style> does not count for it"}},
  };
  for (const auto& c : cases) {
    const Import i =
        page(std::string("<style media='") + c.media + "'>rect {fill:red}</style><rect width='9' height='9'/>");
    EXPECT_EQ(i.drawing.paths.at(0).color[0], c.counts ? 1 : 0) << c.media;
    EXPECT_EQ(i.messages, c.messages) << c.media;
  }
}

TEST(SvgImport, UnitsAndFontSizes) {
  const std::pair<const char*, float> widths[] = {
      {"<rect height='9' width='4PX'/>", 4},
      {"<rect height='9' style='width:1In'/>", 96},
      {"<rect height='9' style='width:101.6q'/>", 96},
      {"<rect height='9' width='2EM' font-size='5'/>", 10},
      {"<rect height='9' width='2em' style='font:20px serif'/>", 40},
      {"<rect height='9' width='2ex' style='font:italic BOLD 10PX/1.5 a, \"b c\"'/>", 10},
      {"<rect height='9' width='1em' style='font: 700 12px / normal serif'/>", 12},
      {"<rect height='9' width='1em' style='font:oblique -10deg bold 11px serif'/>", 11},
      {"<g font-size='30'><rect height='9' width='1em' style='font:50% serif'/></g>", 15},
      {"<g font-size='30'><rect height='9' width='1em' style='font:caption'/></g>", 16},
      {"<g font-size='30'><rect height='9' width='1em' style='font:initial'/></g>", 12},
      {"<rect height='9' width='1em' style='font:20px serif;font-size:30px'/>", 30},
      {"<rect height='9' width='1em' style='font-size:30px;font:20px serif'/>", 20},
      {"<rect height='9' width='1em' font='20px serif'/>", 12}, // is no attribute
      {"<svg font-size='20' width='2em' height='9' overflow='visible'><rect height='9' width='100%'/></svg>", 40},
      {"<rect height='9' width='4' style='transform:SCALEX(2) translateX(0PX) rotate(360DEG)'/>", 8},
  };
  for (const auto& [text, width] : widths) {
    const Import i = page(text);
    ASSERT_EQ(i.drawing.paths.size(), 1u) << text;
    EXPECT_FLOAT_EQ(i.drawing.paths[0].points[2], width) << text;
    EXPECT_EQ(i.messages, Texts{}) << text;
  }
  for (const char* font : {"20px", "serif", "20 serif", "20px/ serif", "fancy 20px serif", "-1px serif", "/20px serif"})
    EXPECT_EQ(page(std::string("<g style='font:") + font + "'/>").messages,
              Texts{std::string("W line 2: <g> has font '") + font + "', which is not valid; ignored"});
  EXPECT_EQ(import("<svg font-size='20' width='2em' height='1em'/>").drawing.width, 40);
  EXPECT_TRUE(page("<linearGradient id='g'><stop/></linearGradient><rect width='9' height='9' fill='URL(#g)'/>")
                  .drawing.paths.at(0)
                  .gradient);
  EXPECT_EQ(page("<clipPath id='c'/><rect width='9' height='9' clip-path='Url(#c)'/>").drawing.groups.size(), 1u);
  EXPECT_EQ(page("<rect x='45' width='10' height='9' transform='scale(2)' style='transform-origin:Center TOP'/>")
                .drawing.paths.at(0)
                .points.at(0),
            40);
}

TEST(SvgImport, NamespacesCountNotPrefixes) {
  const std::string svg = "='http://www.w3.org/2000/svg'", xlink = "='http://www.w3.org/1999/xlink'",
                    r = "rect width='9' height='9'", use = "<defs><rect id='r' width='9' height='9'/></defs><use ";
  const std::pair<std::string, size_t> cases[] = {
      // and how many paths are drawn
      {"<s:" + r + " xmlns:s" + svg + "/>", 1},
      {"<g xmlns:s" + svg + "><s:g><s:" + r + "/></s:g></g>", 1},
      {"<g xmlns:s" + svg + "/><s:" + r + "/>", 0}, // declared elsewhere
      {"<g xmlns:s" + svg + "><g xmlns:s='foo'><s:" + r + "/></g><s:" + r + "/></g>", 1},
      {"<" + r + " xmlns='foo'/>", 0},
      {"<" + r + " xmlns=''/>", 0},
      {"<g xmlns='foo'><" + r + "/><" + r + " xmlns" + svg + "/></g><" + r + "/>", 1}, // nor is what is inside
      {"<svg:" + r + "/>", 0},
      {"<a:" + r + " xmlns:a='foo'/>", 0},
      {use + "xl:href='#r' xmlns:xl" + xlink + "/>", 1},
      {use + "xlink:href='#r' xmlns:xlink" + xlink + "/>", 1},
      {use + "xlink:href='#r'/>", 1}, // as some files have it
  };
  for (const auto& [text, count] : cases) {
    const Import i = page(text);
    EXPECT_EQ(i.drawing.paths.size(), count) << text;
    EXPECT_EQ(i.messages, Texts{}) << text;
  }
  for (const std::string other : {"xlink:href='#r' xmlns:xlink='foo'", "xl:href='#r'"})
    EXPECT_EQ(page(use + other + "/>").messages, (Texts{"E line 2: <use> refers to '', which does not exist"}))
        << other;
  const std::string inside = "<s:style>rect {fill:red}</s:style>\n<s:rect width='a' height='9'/><rect/>";
  const Import prefixed = import("<s:svg xmlns:s" + svg + ">" + inside + "<s:" + r + "/></s:svg>");
  EXPECT_EQ(prefixed.messages, (Texts{"E line 2: <rect> has width 'a', which is not a length"}));
  ASSERT_EQ(prefixed.drawing.paths.size(), 1u);
  EXPECT_EQ(prefixed.drawing.paths[0].color[0], 1);
  EXPECT_EQ(import("<s:svg>" + inside + "<s:" + r + "/></s:svg>").drawing.paths.size(), 1u);
  EXPECT_EQ(import("\n<svg xmlns='foo'/>").error, "2:1: the outermost element is in another namespace than SVG's");
  EXPECT_EQ(import("<svg xmlns=''><" + r + "/></svg>").drawing.paths.size(), 1u);
}

TEST(SvgImport, WordsThatEveryPropertyTakes) {
  const struct {
    const char* attributes;
    std::array<float, 4> linear;
  } cases[] = {
      {"style='fill:initial'", {0, 0, 0, 1}},
      {"style='fill:unset'", {1, 0, 0, 1}},
      {"fill='Revert'", {1, 0, 0, 1}},
      {"style='fill:revert-layer'", {1, 0, 0, 1}},
      {"style='fill:currentColor;color:unset'", {0, 0, 1, 1}},
      {"style='fill:currentColor;color:initial'", {0, 0, 0, 1}},
      {"style='fill-opacity:initial'", {1, 0, 0, 1}},
      {"style='opacity:0.5;opacity:unset'", {1, 0, 0, 1}}, // is not inherited
      {"style='opacity:0.5;opacity:initial'", {1, 0, 0, 1}},
      {"style='opacity:inherit;clip-path:unset;transform:initial'", {1, 0, 0, 0.5f}},
  };
  for (const auto& c : cases) {
    const bool faint = std::string(c.attributes).find("fill-opacity") != std::string::npos;
    const Import i =
        page(std::string("<g fill='red' color='blue' opacity='0.5'") + (faint ? " fill-opacity='.25'" : "") +
             "><rect width='9' height='9' " + c.attributes + "/><rect width='1' height='1'/></g>");
    EXPECT_EQ(i.messages, Texts()) << c.attributes;
    ASSERT_EQ(i.drawing.paths.size(), 2u) << c.attributes;
    for (size_t k = 0; k < 4; ++k) EXPECT_EQ(i.drawing.paths[0].color[k], c.linear[k]) << c.attributes << " " << k;
  }
  const std::string gradient = "<linearGradient id='g'><stop/></linearGradient>",
                    rect = "<rect width='9' height='9' color-interpolation='linearRGB' fill='url(#g)'/>";
  const auto mixesLinear = [&](const std::string& text) {
    return !page(text).drawing.paths.at(0).gradient->gradient.interpolateSrgb;
  };
  EXPECT_FALSE(mixesLinear(gradient + rect)); // what is painted does not say
  EXPECT_TRUE(mixesLinear("<g style='color-interpolation:linearRGB'>" + gradient + "</g>" + rect));
  EXPECT_FALSE(mixesLinear("<g style='color-interpolation:linearRGB'>"
                           "<linearGradient id='g' style='color-interpolation:auto'><stop/></linearGradient></g>" +
                           rect));
  const std::string stop =
      "<linearGradient id='g' style='stop-color:currentColor' color='aqua'><stop style='stop-color:";
  for (const auto& [word, linear] : std::map<std::string, std::array<float, 3>>{
           {"inherit", {0, 1, 1}}, {"initial", {0, 0, 0}}, {"unset", {0, 0, 0}}}) {
    const Import i = page(stop + word + "'/></linearGradient><rect width='9' height='9' fill='url(#g)'/>");
    ASSERT_EQ(i.drawing.paths.size(), 1u);
    for (size_t k = 0; k < 3; ++k) EXPECT_EQ(i.drawing.paths[0].gradient->stops.at(0).color[k], linear[k]) << word;
  }
}

TEST(SvgImport, Selectors) {
  // Of the last <rect>: whether each selector means it.
  const std::string drawing =
      "<g id='a' class='p'><g class='q r'><circle r='1'/><path d='M0 0'/>"
      "<rect id='x' class='s t' data-kind='one two' lang='en-GB' width='9' height='9'/></g></g>";
  const std::pair<const char*, bool> cases[] = {{"g rect", true},
                                                {"g > rect", true},
                                                {"#a rect", true},
                                                {"#a > rect", false},
                                                {"#a>.q>rect", true},
                                                {".p .q .s", true},
                                                {".q .p .s", false},
                                                {"svg g *", true},
                                                {"svg > g > g > *", true},
                                                {"svg > g > *.s", false},
                                                {"path + rect", true},
                                                {"circle + rect", false},
                                                {"circle ~ rect", true},
                                                {"circle ~ path + .t", true},
                                                {"rect ~ rect", false},
                                                {".p path ~ rect", true},
                                                {"g g > circle ~ .s.t", true},
                                                {"[width]", true},
                                                {"[height=\"9\"]", true},
                                                {"rect[height='8']", false},
                                                {"[data-kind~=two]", true},
                                                {"[data-kind~=tw]", false},
                                                {"[lang|=en]", true},
                                                {"[lang|=e]", false},
                                                {"[data-kind^=one]", true},
                                                {"[data-kind^=two]", false},
                                                {"[data-kind$='two']", true},
                                                {"[data-kind$=one]", false},
                                                {"[data-kind*='e t']", true},
                                                {"[data-kind*='']", false},
                                                {"[ lang = 'en-GB' ]", true},
                                                {"[lang][width].s#x", true},
                                                {".p[class] > [class~=r] > rect", true},
                                                {":root rect", true},
                                                {"svg:Root > g/**/ rect", true},
                                                {"rect:root", false},
                                                {"g:root rect", false},
                                                {"g > :root rect", false},
                                                {":root(1) rect", false},
                                                {"::root rect", false},
                                                {":rooted rect", false},
                                                {"g::before", false}};
  for (const auto& [selector, fits] : cases) {
    const Import i = page("<style>" + std::string(selector) + " { fill: red }</style>" + drawing);
    ASSERT_EQ(i.drawing.paths.size(), 2u) << selector;
    EXPECT_EQ(i.drawing.paths[1].color[0], fits ? 1 : 0) << selector;
  }
  // All compounds count together, ids before classes before types, then the order.
  for (const auto& [rules, red] : std::map<std::string, bool>{{"g rect{fill:red} rect{fill:blue}", true},
                                                              {"rect{fill:blue} g rect{fill:red}", true},
                                                              {".s{fill:blue} .q rect{fill:red}", true},
                                                              {"#x{fill:red} .p .q .s.t[lang]{fill:blue}", true},
                                                              {"#a rect{fill:blue} #x{fill:red}", false},
                                                              {"[lang]{fill:blue} .s{fill:red}", true},
                                                              {":root rect{fill:red} svg g rect{fill:blue}", true},
                                                              {".s{fill:blue} :root rect{fill:red}", true},
                                                              {".p rect{fill:red} .q rect{fill:blue}", false},
                                                              {"g g rect{fill:red} g > rect{fill:blue}", true}}) {
    const Import i = page("<style>" + rules + "</style>" + drawing);
    EXPECT_EQ(i.drawing.paths.at(1).color[0], red ? 1 : 0) << rules;
    EXPECT_EQ(i.messages, Texts()) << rules;
  }
}

TEST(SvgImport, ElementsForOtherReadersAreLeftOut) {
  const std::pair<const char*, bool> cases[] = {{"", true},
                                                {"systemLanguage='en'", true},
                                                {"systemLanguage='de, en-US'", true},
                                                {"systemLanguage='EN'", false}, // as browsers and resvg compare it
                                                {"systemLanguage='de,fr'", false},
                                                {"systemLanguage='sven'", false},
                                                {"systemLanguage=''", false},
                                                {"requiredExtensions='http://example.org/more'", false},
                                                {"requiredExtensions=' '", false},
                                                {"requiredFeatures=''", false},
                                                {"requiredFeatures='flying'", false},
                                                {"requiredFeatures='http://www.w3.org/TR/SVG11/feature#Shape'", true}};
  for (const auto& [attributes, shown] : cases) {
    const std::string rect = std::string("<rect width='9' height='9' ") + attributes + "/>";
    const std::string other = "<rect width='5' height='5'/><rect width='6' height='6'/>";
    const Import alone = page(rect), within = page("<switch>" + rect + other + "</switch>");
    EXPECT_EQ(alone.messages, Texts());
    EXPECT_EQ(alone.drawing.paths.size(), shown ? 1u : 0u) << attributes;
    ASSERT_EQ(within.drawing.paths.size(), 1u) << attributes;
    EXPECT_EQ(within.drawing.paths[0].points[2], shown ? 9 : 5) << attributes;
  }
}

TEST(SvgImport, GradientsReachTheDrawing) {
  const auto gradient = [](const std::string& text) {
    const Import i = page("<defs><linearGradient id='stops'><stop offset='-1' stop-color='red'/>"
                          "<stop offset='50%' style='stop-color:#00f;stop-opacity:.5'/>"
                          "<stop offset='.2' class='w'/></linearGradient></defs><style>.w{stop-color:white}</style>" +
                          text + "<rect x='20' y='10' width='40' height='20' fill='url(#g)' fill-opacity='.25'/>");
    EXPECT_EQ(i.messages, Texts()) << text;
    EXPECT_EQ(i.drawing.paths.size(), 1u) << text;
    EXPECT_EQ(i.drawing.paths[0].color[3], 0.25f);
    EXPECT_TRUE(i.drawing.paths[0].gradient) << text;
    return i.drawing.paths[0].gradient;
  };
  // Where the ramp begins and ends in the drawing, and the radius there.
  const auto ends = [](const vector::svg::Gradient& made) {
    const GpgpGradient& g = made.gradient;
    const auto map = [&g](const float* p, Floats& to) {
      to.push_back(g.transform[0] * p[0] + g.transform[2] * p[1] + g.transform[4]);
      to.push_back(g.transform[1] * p[0] + g.transform[3] * p[1] + g.transform[5]);
    };
    Floats f;
    map(g.start, f);
    map(g.end, f);
    if (g.kind == GPGP_GRADIENT_RADIAL) f.insert(f.end(), {g.startRadius, g.endRadius});
    return f;
  };
  // Stops inherit from their gradient, and from where it stands; not from what is painted.
  const auto ofStop = [&](const std::string& text) {
    const Import i = page(text);
    EXPECT_EQ(i.messages, Texts()) << text;
    const float* c = i.drawing.paths.at(0).gradient->stops.at(0).color;
    return std::array<float, 3>{c[0], c[1], c[2]};
  };
  const std::string painted = "<rect width='9' height='9' color='red' fill='url(#g)'/>",
                    stop = "<stop stop-color='currentColor'/></linearGradient>";
  using Rgb = std::array<float, 3>;
  EXPECT_EQ(ofStop("<linearGradient id='g'>" + stop + painted), (Rgb{0, 0, 0}));
  EXPECT_EQ(ofStop("<linearGradient id='g' color='lime'>" + stop + painted), (Rgb{0, 1, 0}));
  EXPECT_EQ(ofStop("<g color='blue'><linearGradient id='g'>" + stop + "</g>" + painted), (Rgb{0, 0, 1}));
  EXPECT_EQ(ofStop("<linearGradient id='f' color='blue'>" + stop + "<linearGradient id='g' href='#f'/>" + painted),
            (Rgb{0, 0, 1}));
  EXPECT_EQ(ofStop("<linearGradient id='g' stop-color='aqua'><stop stop-color='inherit'/></linearGradient>" + painted),
            (Rgb{0, 1, 1}));
  const auto plain = gradient("<linearGradient id='g' href='#stops'/>");
  EXPECT_EQ(ends(*plain), (Floats{20, 10, 60, 10}));
  EXPECT_EQ(plain->gradient.spread, GPGP_SPREAD_PAD);
  EXPECT_TRUE(plain->gradient.interpolateSrgb);
  ASSERT_EQ(plain->gradient.stopCount, 3u);
  const GpgpGradientStop* stops = plain->gradient.stops;
  EXPECT_EQ(stops[0].offset, 0);
  EXPECT_EQ(stops[1].offset, 0.5f);
  EXPECT_EQ(stops[2].offset, 0.5f); // never before the one before
  EXPECT_EQ(stops[0].color[0], 1);
  EXPECT_EQ(stops[1].color[2], 1);
  EXPECT_EQ(stops[1].color[3], 0.5f);
  EXPECT_EQ(stops[2].color[1], 1);
  EXPECT_EQ(ends(*gradient("<linearGradient id='g' xlink:href='#stops' x1='50%' y1='.5' x2='.5' y2='100%'/>")),
            (Floats{40, 20, 40, 30}));
  EXPECT_EQ(ends(*gradient("<linearGradient id='g' href='#stops' gradientUnits='userSpaceOnUse' x1='10%' x2='30' "
                           "y2='5' gradientTransform='translate(1 2)'/>")),
            (Floats{11, 2, 31, 7}));
  // Attributes come along the references, the nearest first.
  const auto far = gradient("<linearGradient id='b' href='#stops' x2='.5' spreadMethod='reflect'/>"
                            "<linearGradient id='g' href='#b' y2='1'/>");
  EXPECT_EQ(ends(*far), (Floats{20, 10, 40, 30}));
  EXPECT_EQ(far->gradient.spread, GPGP_SPREAD_REFLECT);
  const auto radial = gradient("<radialGradient id='g' href='#stops' fx='.25' fr='.1' spreadMethod='repeat' "
                               "color-interpolation='linearRGB'/>");
  EXPECT_EQ(radial->gradient.kind, GPGP_GRADIENT_RADIAL);
  EXPECT_EQ(ends(*radial), (Floats{30, 20, 40, 20, 0.1f, 0.5f}));
  EXPECT_EQ(radial->gradient.spread, GPGP_SPREAD_REPEAT);
  EXPECT_FALSE(radial->gradient.interpolateSrgb);
  // Neither circle needs to hold the other; without an end radius all is in the last colour.
  const auto cone = gradient("<radialGradient id='g' href='#stops' cx='.8' r='.1' fx='.25' fr='.2'/>");
  EXPECT_EQ(ends(*cone), (Floats{30, 20, 52, 20, 0.2f, 0.1f}));
  const auto point = gradient("<radialGradient id='g' href='#stops' r='0' fx='.25' fr='.2'/>");
  EXPECT_EQ(point->gradient.kind, GPGP_GRADIENT_LINEAR);
  EXPECT_EQ(ends(*point), (Floats{40, 20, 40, 20}));
  // A line has no box to be measured by.
  EXPECT_TRUE(
      page("<linearGradient id='g'><stop/></linearGradient><path d='M0 5H9' stroke='url(#g)'/>").drawing.paths.empty());
  // The box is the geometry's, not the stroke's, and as tight as the curves are.
  const Import stroked = page("<linearGradient id='g'><stop/></linearGradient>"
                              "<path d='M10 10C10 50 50 50 50 10' fill='none' stroke='url(#g)' stroke-width='8'/>");
  ASSERT_EQ(stroked.drawing.paths.size(), 1u);
  EXPECT_EQ(stroked.drawing.paths[0].gradient->gradient.transform[3], 30);
}

TEST(SvgImport, WhatIsNotShownIsNoPath) {
  for (const char* a : {"fill='none'", "display='none'", "visibility='hidden'", "opacity='0'", "style='fill:none'"})
    EXPECT_TRUE(page(std::string("<rect width='9' height='9' ") + a + "/>").drawing.paths.empty()) << a;
  EXPECT_EQ(page("<g visibility='hidden'><rect width='9' height='9' visibility='visible'/></g>").drawing.paths.size(),
            1u);
  // A gradient without stops paints nothing, though a fallback is named: that is for what is not there.
  EXPECT_TRUE(page("<linearGradient id='g'/><rect width='9' height='9' fill='url(#g) red'/>").drawing.paths.empty());
  EXPECT_EQ(page("<rect width='9' height='9' fill='url(#g) red'/>").drawing.paths.size(), 1u);
  // One that refers to itself has its own stops.
  EXPECT_EQ(page("<linearGradient id='g' href='#h'><stop/></linearGradient><linearGradient id='h' href='#g'/><rect "
                 "width='9' height='9' fill='url(#h)'/>")
                .drawing.paths.size(),
            1u);
}

TEST(SvgImport, GroupsFadeAndClip) {
  const std::string two = "<path d='M0 0h9v9'/><path d='M0 0h9v9'/>";
  Imported d = page("<g opacity='.5'>" + two + "</g><path d='M0 0h9v9' opacity='.25'/>").drawing;
  ASSERT_EQ(d.paths.size(), 3u);
  ASSERT_EQ(d.groups.size(), 1u);
  EXPECT_EQ(d.groups[0].opacity, 0.5f);
  EXPECT_EQ(d.paths[0].group, 1u);
  EXPECT_EQ(d.paths[1].group, 1u);
  EXPECT_EQ(d.paths[1].color[3], 1);
  EXPECT_EQ(d.paths[2].group, 0u); // one path needs none
  EXPECT_EQ(d.paths[2].color[3], 0.25f);
  d = page("<path d='M0 0h9v9' stroke='red' opacity='.5'/><g opacity='.5'><g opacity='.5'><path d='M0 0h9v9'/></g></g>")
          .drawing;
  ASSERT_EQ(d.groups.size(), 1u); // fill and stroke
  EXPECT_EQ(d.paths[0].group, 1u);
  EXPECT_EQ(d.paths[1].group, 1u);
  EXPECT_EQ(d.paths[2].color[3], 0.25f);
  EXPECT_EQ(d.paths[2].group, 0u);
  EXPECT_TRUE(page("<g opacity='0'>" + two + "</g>").drawing.paths.empty());

  // One path in a clip in a group that fades: the path fades.
  d = page("<clipPath id='c'><path d='M0 0h9v9'/></clipPath>"
           "<g opacity='.5'><path d='M0 0h9v9' clip-path='url(#c)'/></g>")
          .drawing;
  ASSERT_EQ(d.groups.size(), 2u);
  EXPECT_EQ(d.groups[0].opacity, 1);
  EXPECT_TRUE(d.groups[1].clipped);
  EXPECT_EQ(d.paths[0].group, 2u);
  EXPECT_EQ(d.paths[0].color[3], 0.5f);
}

TEST(SvgImport, ClipPaths) {
  const std::string two = "<path d='M0 0h9v9'/><path d='M0 0h9v9'/>";
  Import imported = page("<g clip-rule='evenodd'><clipPath id='c' transform='translate(1 2)'><path d='M0 0h9v9'/>"
                         "<path d='M0 0h9v9' clip-rule='nonzero' opacity='0' fill='none' stroke='red'/><line x2='9'/>"
                         "<path d='M0 0h9v9' display='none'/><path d='M0 0h9v9' visibility='hidden'/></clipPath></g>"
                         "<g transform='scale(2)' clip-path=\"url('#c')\">" +
                         two + "</g>");
  EXPECT_EQ(imported.messages, Texts{});
  Imported d = std::move(imported.drawing);
  ASSERT_EQ(d.groups.size(), 1u);
  EXPECT_TRUE(d.groups[0].clipped);
  EXPECT_EQ(d.groups[0].opacity, 1);
  ASSERT_EQ(d.groups[0].clip.size(), 2u);
  EXPECT_EQ(d.groups[0].clip[0].rule, GPGP_FILL_EVEN_ODD);
  EXPECT_EQ(d.groups[0].clip[0].points, (Floats{2, 4, 20, 4, 20, 22}));
  EXPECT_EQ(d.groups[0].clip[1].rule, GPGP_FILL_NON_ZERO);
  ASSERT_EQ(d.paths.size(), 2u);
  EXPECT_EQ(d.paths[0].group, 1u);
  EXPECT_EQ(d.paths[1].group, 1u);

  // A clipPath that is clipped: both clip, in the coordinates and by the box of what refers to them.
  d = page("<clipPath id='c' clipPathUnits='objectBoundingBox'><rect width='.5' height='.5'/></clipPath>"
           "<clipPath id='d' clipPathUnits='objectBoundingBox' transform='translate(3)' clip-path='url(#c)'>"
           "<rect width='1' height='.25'/></clipPath>"
           "<rect x='10' y='20' width='40' height='8' clip-path='url(#d)' opacity='.5'/>")
          .drawing;
  ASSERT_EQ(d.groups.size(), 2u);
  EXPECT_EQ(d.groups[1].parent, 1u);
  ASSERT_EQ(d.paths.size(), 1u);
  EXPECT_EQ(d.paths[0].group, 2u);
  EXPECT_EQ(d.paths[0].color[3], 0.5f);
  ASSERT_EQ(d.groups[0].clip.size(), 1u);
  EXPECT_EQ(d.groups[0].clip[0].points, (Floats{13, 20, 53, 20, 53, 22, 13, 22}));
  ASSERT_EQ(d.groups[1].clip.size(), 1u);
  EXPECT_EQ(d.groups[1].clip[0].points, (Floats{10, 20, 30, 20, 30, 24, 10, 24}));

  // The box of a group is that of all shapes inside, without strokes, in the group's own coordinates.
  const std::string unit = "<clipPath id='c' clipPathUnits='objectBoundingBox'><rect width='1' height='1'/></clipPath>";
  imported =
      page(unit + "<g transform='translate(5) scale(2)' clip-path='url(#c)'>"
                  "<rect width='4' height='6' stroke='red' opacity='.5'/>"
                  "<g transform='translate(10)'><rect y='-1' width='5' height='2' visibility='hidden'/></g></g>");
  EXPECT_EQ(imported.messages, Texts{});
  ASSERT_GE(imported.drawing.groups.size(), 1u);
  ASSERT_EQ(imported.drawing.groups[0].clip.size(), 1u);
  EXPECT_EQ(imported.drawing.groups[0].clip[0].points, (Floats{5, -2, 35, -2, 35, 12, 5, 12}));

  // The coordinates of <use> begin at its x and y.
  d = page("<defs><rect id='r' x='1' width='4' height='4'/></defs>" + unit +
           "<clipPath id='d'><rect x='1' width='2' height='4'/></clipPath>"
           "<use href='#r' x='20' y='10' clip-path='url(#c)'/><use href='#r' x='20' y='10' clip-path='url(#d)'/>")
          .drawing;
  ASSERT_EQ(d.groups.size(), 2u);
  ASSERT_EQ(d.groups[0].clip.size(), 1u);
  EXPECT_EQ(d.groups[0].clip[0].points, (Floats{21, 10, 25, 10, 25, 14, 21, 14}));
  ASSERT_EQ(d.groups[1].clip.size(), 1u);
  EXPECT_EQ(d.groups[1].clip[0].points, (Floats{21, 10, 23, 10, 23, 14, 21, 14}));

  // Neighbours share a clip while it is the same, and what draws nothing leaves none behind.
  d = page("<clipPath id='c'><path d='M0 0h9v9'/></clipPath><path d='M0 0' clip-path='url(#c)'/>"
           "<path d='M0 0h9v9' clip-path='url(#c)'/><path d='M0 0h9v9' clip-path='url(#c)'/>"
           "<path d='M0 0h9v9' clip-path='url(#c)' transform='scale(2)'/>")
          .drawing;
  ASSERT_EQ(d.paths.size(), 3u);
  ASSERT_EQ(d.groups.size(), 2u);
  EXPECT_EQ(d.paths[0].group, 1u);
  EXPECT_EQ(d.paths[1].group, 1u);
  EXPECT_EQ(d.paths[2].group, 2u);
  EXPECT_EQ(d.groups[1].clip.at(0).points[2], 18);

  // A viewport clips what reaches beyond it, unless it says otherwise.
  const std::string circle = "<circle cx='10' cy='10' r='9'/>";
  d = page("<svg x='5' width='15' height='20'>" + circle + "</svg>").drawing;
  ASSERT_EQ(d.groups.size(), 1u);
  EXPECT_TRUE(d.groups[0].clipped);
  ASSERT_EQ(d.groups[0].clip.size(), 1u);
  EXPECT_EQ(d.groups[0].clip[0].points, (Floats{5, 0, 20, 0, 20, 20, 5, 20}));
  for (const char* open : {"<svg x='5' width='20' height='20'>", "<svg width='15' height='20' overflow='visible'>"})
    for (const auto& group : page(open + circle + "</svg>").drawing.groups) EXPECT_FALSE(group.clipped);

  const vector::svg::Imported empty; // views of nothing
  EXPECT_TRUE(vector::svg::ImportedViews(empty).groups.empty());
  d = page("<clipPath id='c'/><path d='M0 0h9v9' clip-path='url(#c)'/>").drawing; // a clip without shapes shows nothing
  ASSERT_EQ(d.groups.size(), 1u);
  EXPECT_TRUE(d.groups[0].clipped);
  EXPECT_TRUE(d.groups[0].clip.empty());
}

TEST(SvgImport, MessagesNameElementAndLine) {
  const struct {
    const char* text;
    const char* message;
  } cases[] = {
      {"<text x='1'>a</text>", "W line 2: <text> is not supported"},
      {"\n<image href='a.png'/>", "W line 3: <image> is not supported"},
      {"<rect width='9' height='9' clip-path='url(#c)'/>",
       "W line 2: clip-path 'url(#c)' is not a clipPath of this file: <rect> is drawn without it"},
      {"<rect width='9' height='9' filter='url(#c)'/>",
       "W line 2: filter '#c' does not exist: <rect> is drawn without it"},
      {"<linearGradient id='g'/>\n<rect width='9' height='9' fill='url(#g)'/>",
       "W line 3: <rect> fill refers to a gradient without stops; it is not painted"},
      {"<linearGradient id='g'><stop/></linearGradient>\n<path d='M0 0h9' stroke='url(#g) red'/>",
       "W line 3: <path> stroke refers to a gradient without extent; its fallback is used"},
      {"<linearGradient id='g' x1='a'><stop/></linearGradient><rect width='9' height='9' fill='url(#g)'/>",
       "E line 2: <linearGradient> has x1 'a', which is not a length"},
      {"<pattern id='p'/><rect width='9' height='9' fill='url(#p) red'/>",
       "W line 2: <rect> fill refers to a pattern without content; its fallback is used"},
      {"<clipPath id='c' clip-path='url(#c)'/><rect width='9' height='9' clip-path='url(#c)'/>",
       "W line 2: clip-path 'url(#c)' contains itself: <clipPath> is drawn without it"},
      {"<clipPath id='c'>\n<g><path d='M0 0h9v9'/></g></clipPath><rect width='9' height='9' clip-path='url(#c)'/>",
       "W line 3: <g> shows nothing inside a <clipPath>"},
      {"<rect width='9' height='9' clip-path='circle(4)'/>",
       "W line 2: clip-path 'circle(4)' is not a clipPath of this file: <rect> is drawn without it"},
      {"<svg width='2e7' height='9'><rect width='9' height='1e6'/></svg>",
       "W line 2: <svg> is not clipped to its viewport; its content reaches beyond"},
      {"<clipPath id='c'><text>a</text></clipPath><rect width='9' height='9' clip-path='url(#c)'/>",
       "W line 2: <text> is not supported"},
      {"<g id='a'><use href='#a'/></g>", "E line 2: <use> of '#a' contains itself; not drawn"},
      {"<use href='#no'/>", "E line 2: <use> refers to '#no', which does not exist"},
      {"<circle r='-1'/>", "E line 2: <circle> has a negative r"},
      {"<rect width='9' height='nan'/>", "E line 2: <rect> has height 'nan', which is not a length"},
      {"<rect width='1e30' height='9'/>", "E line 2: <rect> reaches beyond 10000000 pixels; not drawn"},
      {"<rect width='9' height='9' transform='turn(3)'/>",
       "E line 2: <rect> has an error in its transform, which is ignored"},
      {"<rect width='9' height='9' style='backdrop-filter:blur(3px)'/>",
       "W line 2: backdrop-filter is not supported: <rect> is drawn without it"},
      {"<style>rect { zoom: 2; scale: none }</style>\n<rect width='9' height='9'/>",
       "W line 3: zoom is not supported: <rect> is drawn without it"},
      {"<rect width='9' height='9' style='transform:scale(1);transform-origin:top top'/>",
       "W line 2: <rect> has transform-origin 'top top', which is not valid; ignored"},
      {"<rect height='9' style='width:wide'/>", "E line 2: <rect> has width 'wide', which is not a length"},
      {"<path style='d:path(\"M0 0 x\")'/>",
       "E line 2: <path> has an error in its path data at character 6; drawn up to there"},
      {"<rect height='9' style='width:calc(sin(1) * 2px)'/>",
       "W line 2: <rect> has width 'calc(sin(1) * 2px)', which is not supported; ignored"},
      {"<rect height='9' width='5CQW'/>", "W line 2: <rect> has width '5CQW', which is not supported; ignored"},
      {"<rect width='9' height='9' fill='ENV(--a, red)'/>",
       "W line 2: <rect> has fill 'ENV(--a, red)', which is not supported; ignored"},
      {"<rect width='9' height='9' fill='color-mix(in lab, red, blue)'/>",
       "W line 2: <rect> has fill 'color-mix(in lab, red, blue)', which is not supported; ignored"},
      {"<rect width='9' height='9' fill='RGB( From red r g b)'/>",
       "W line 2: <rect> has fill 'RGB( From red r g b)', which is not supported; ignored"},
      {"<rect width='9' height='9' fill='lab'/>", "W line 2: <rect> has fill 'lab', which is not valid; ignored"},
      {"<rect width='9' height='9' stroke-width='3zw'/>",
       "W line 2: <rect> has stroke-width '3zw', which is not valid; ignored"},
      {"<rect width='9' height='9' style='transform:translateZ(0)'/>",
       "W line 2: <rect> has transform 'translateZ(0)', which is not supported; ignored"},
      {"<rect width='9' height='9' style='transform:scale(1);transform-origin:1cqw'/>",
       "W line 2: <rect> has transform-origin '1cqw', which is not supported; ignored"},
      {"<radialGradient id='g' r='-1'><stop/></radialGradient><rect width='9' height='9' fill='url(#g)'/>",
       "E line 2: <radialGradient> has a negative r, which counts as none"},
      {"<radialGradient id='g' fr='-1'><stop/></radialGradient><rect width='9' height='9' fill='url(#g)'/>",
       "E line 2: <radialGradient> has a negative fr, which counts as none"},
      {"<linearGradient id='g' gradientTransform='scale(0)'><stop/></linearGradient>\n<rect width='9' height='9' "
       "fill='url(#g)'/>",
       "W line 3: <rect> fill refers to a gradient without extent; it is not painted"},
      {"<linearGradient id='g' href='#h'><stop/></linearGradient><linearGradient id='h' href='#g'/>\n<rect width='9' "
       "height='9' fill='url(#g)'/>",
       "W line 2: <linearGradient> refers to '#g', which is one of its own templates; ignored"},
      {"<linearGradient id='g' x1='env(a)'><stop/></linearGradient><rect width='9' height='9' fill='url(#g)'/>",
       "W line 2: <linearGradient> has x1 'env(a)', which is not supported; ignored"},
      {"<style>\ng rect::before { fill: red }</style>", "W line 3: style selector 'g rect::before' is not supported"},
      {"<style>\ng > {fill:red}</style>", "W line 3: style selector 'g >' is not valid; its rule is ignored"},
      {"<style>\n> g {fill:red}</style>", "W line 3: style selector '> g' is not valid; its rule is ignored"},
      {"<style>\ng,{fill:red}</style>", "W line 3: style selector '' is not valid; its rule is ignored"},
      {"<rect width='9' height='9' style='fill red;'/>",
       "W line 2: <rect> has the declaration 'fill red', which is not valid; ignored"},
      {"<rect width='9' height='9' shape-rendering='crispEdges'/>",
       "W line 2: shape-rendering is not supported: <rect> is drawn without it"},
      {"<g image-rendering='pixelated'/>", "W line 2: image-rendering is not supported: <g> is drawn without it"},
      {"<svg width='9' height='9' style='clip: rect(1px 2px 3px 4px)'/>",
       "W line 2: clip is not supported: <svg> is drawn without it"},
      {"<path id='p' d='M0 0h9v9'/><use href='#p'>\n<animate/></use>", "W line 3: <animate> is not supported"},
      {"<linearGradient id='g'><stop/>\n<animate/></linearGradient><path fill='url(#g)' d='M0 0h9v9'/>",
       "W line 3: <animate> is not supported"},
      {"<linearGradient id='g'><stop>\n<animate/></stop></linearGradient><path fill='url(#g)' d='M0 0h9v9'/>",
       "W line 3: <animate> is not supported"},
      {"<path fill='url(other.svg#g)' d='M0 0h9v9'/>",
       "W line 2: <path> fill refers to another file, 'other.svg#g', which is not supported; it is not painted"},
      {"<linearGradient id='g' href='other.svg#g'><stop/></linearGradient>\n<path fill='url(#g)' d='M0 0h9v9'/>",
       "W line 3: <path> fill refers to a gradient that refers to another file, 'other.svg#g', which is not supported"},
      {"<linearGradient id='g' href='#g'><stop/></linearGradient>\n<path fill='url(#g)' d='M0 0h9v9'/>",
       "W line 2: <linearGradient> refers to '#g', which is one of its own templates; ignored"},
      {"<path fill='CanvasText' d='M0 0h9v9'/>",
       "W line 2: <path> has fill 'CanvasText', which is not supported; ignored"},
      {"<style>\nsvg|g {fill:red}</style>", "W line 3: style selector 'svg|g' is not supported"},
      {"<style>\n[a|b='c'] {fill:red}</style>", "W line 3: style selector '[a|b='c']' is not supported"},
      {"<style>\n[x|a] {fill:red}</style>", "W line 3: style selector '[x|a]' is not supported"},
      {"<style>\n[a=] {fill:red}</style>", "W line 3: style selector '[a=]' is not valid; its rule is ignored"},
      {"<style>\n[a b] {fill:red}</style>", "W line 3: style selector '[a b]' is not valid; its rule is ignored"},
      {"<style>\n. {fill:red}</style>", "W line 3: style selector '.' is not valid; its rule is ignored"},
      {"<style>\n[a {fill:red}</style>", "E line 3: style rule without a block"},
      {"<style>\na[b=\"c] {fill:red}</style>", "E line 3: style rule without a block"},
      {"<linearGradient id='g'><stop/>\n<stop offset='abc'/></linearGradient><rect width='9' height='9' "
       "fill='url(#g)'/>",
       "W line 3: <stop> has offset 'abc', which is not valid; ignored"},
      {"<linearGradient id='g' spreadMethod='mirror'><stop/></linearGradient><rect width='9' height='9' "
       "fill='url(#g)'/>",
       "W line 2: <linearGradient> has spreadMethod 'mirror', which is not valid; ignored"},
      {"<linearGradient id='g' gradientUnits='foo'><stop/></linearGradient><rect width='9' height='9' fill='url(#g)'/>",
       "W line 2: <linearGradient> has gradientUnits 'foo', which is not valid; ignored"},
      {"<svg viewBox='0 0 9 9' preserveAspectRatio='xMidyMax'/>",
       "W line 2: <svg> has preserveAspectRatio 'xMidyMax', which is not valid; ignored"},
      {"<rect width='9' height='9' rx='-5'/>", "W line 2: <rect> has a negative rx; ignored"},
      {"<rect width='9' height='9' fill='blurple'/>",
       "W line 2: <rect> has fill 'blurple', which is not valid; ignored"},
  };
  for (const auto& c : cases) EXPECT_EQ(page(c.text).messages, Texts{c.message});
}

TEST(SvgImport, EmbeddedImagesGoToWhoeverDecodes) {
  struct Seen {
    std::vector<std::string> bytes;
    bool decodes = true;
  } seen;
  const auto decode = [](void* user, uint32_t index, const void* data, size_t size, uint32_t* width,
                         uint32_t* height) -> VkBool32 {
    auto& s = *static_cast<Seen*>(user);
    EXPECT_EQ(index, s.bytes.size());
    if (!s.decodes) return VK_FALSE;
    s.bytes.emplace_back(static_cast<const char*>(data), size);
    *width = 40, *height = 10;
    return VK_TRUE;
  };
  const auto take = [&](const std::string& inside, Texts& messages) {
    const std::string text = "<svg xmlns='http://www.w3.org/2000/svg' width='100' height='100'>\n" + inside + "</svg>";
    vector::svg::Reporter reporter(
        [](void* user, const GpgpMessage* m) { static_cast<Texts*>(user)->push_back(withLine(placed(*m))); }, &messages,
        "");
    auto svg = vector::svg::importSvg(std::as_bytes(std::span(text)), reporter, {}, {decode, &seen});
    EXPECT_TRUE(svg);
    return std::move(*svg);
  };
  Texts messages;
  const std::string data = " href='data:image/png;base64,\n SGVs\nbG8='";
  Imported d = take("<image x='10' y='20' width='20' height='20'" + data + "/><image" + data +
                        " transform='rotate(90)' y='-40' preserveAspectRatio='none' height='40' opacity='.5'/>",
                    messages);
  EXPECT_EQ(messages, Texts{});
  EXPECT_EQ(seen.bytes, Texts{"Hello"}) << "what two elements share comes once";
  ASSERT_EQ(d.paths.size(), 2u);
  ASSERT_TRUE(d.paths[0].image && d.paths[1].image);
  const auto transform = [&d](size_t i) {
    return std::vector<float>(d.paths[i].image->transform, d.paths[i].image->transform + 6);
  };
  EXPECT_EQ(transform(0), (Floats{20, 0, 0, 5, 10, 27.5f}));
  EXPECT_EQ(std::vector<float>(d.paths[0].points.begin(), d.paths[0].points.begin() + 2), (Floats{10, 27.5f}));
  const Floats turned = transform(1), expected = {0, 160, -40, 0, 40, 0}; // 160 x 40 as its height says
  for (size_t i = 0; i < 6; ++i) EXPECT_NEAR(turned[i], expected[i], 1e-4) << i;
  EXPECT_EQ(d.paths[1].color[3], 0.5f);
  seen.bytes.clear();
  const auto refused = [&](const std::string& inside, const std::string& message) {
    messages.clear();
    EXPECT_TRUE(take(inside, messages).paths.empty()) << inside;
    EXPECT_EQ(messages, Texts{message});
  };
  refused("<image href='a.png'/>",
          "line 2: <image> 'a.png' is another file, and no files are read here; it is not drawn");
  refused("<image href='data:image/png'/>", "line 2: <image> holds nothing that can be decoded; not supported");
  refused("<image href='data:image/png;base64,?'/>",
          "line 2: <image> holds nothing that can be decoded; not supported");
  seen.decodes = false;
  refused("<image href='data:image/gif;base64,R0lGODlhAQABAA=='/>",
          "line 2: <image> holds a GIF file that cannot be decoded; not supported");
  refused("<image href='data:;base64,iVBORw0KGgo='/>",
          "line 2: <image> holds a PNG file that cannot be decoded; not supported");
  refused("<image" + data + "/>", "line 2: <image> holds nothing that can be decoded; not supported");
  seen.decodes = true;
  std::string many;
  for (int i = 0; i < GPGP_MAX_IMAGES + 2; ++i) { // the first too many twice
    const int which = std::min(i, int(GPGP_MAX_IMAGES));
    const char digits[] = {'A', char('A' + which / 676), char('A' + which / 26 % 26), char('A' + which % 26), 0};
    many += std::string("<image width='9' height='9' href='data:;base64,") + digits + "'/>\n";
  }
  messages.clear();
  EXPECT_EQ(take(many, messages).paths.size(), size_t(GPGP_MAX_IMAGES));
  EXPECT_EQ(messages, (Texts{"line 1026: <image> is one more than the 1024 that a drawing can have; not supported",
                             "line 1027: <image> is one more than the 1024 that a drawing can have; not supported"}));
}

TEST(SvgImport, ThePageIsWhatTheFileSays) {
  const Import fitted = import("<svg xmlns='http://www.w3.org/2000/svg' width='200' height='100' viewBox='10 10 10 10'>"
                               "<rect x='10' y='10' width='10' height='10'/></svg>");
  EXPECT_EQ(fitted.drawing.width, 200);
  EXPECT_EQ(fitted.drawing.paths.at(0).points, (Floats{50, 0, 150, 0, 150, 100, 50, 100}));
  const Import filled = import("<svg width='200' height='100' viewBox='0 0 10 10' preserveAspectRatio='none'>"
                               "<path d='M0 0H10V10'/></svg>");
  EXPECT_EQ(filled.drawing.paths.at(0).points, (Floats{0, 0, 200, 0, 200, 100}));
  for (const auto& [ratio, left] : std::initializer_list<std::pair<const char*, float>>{{"xMinYMin", 0},
                                                                                        {" defer  xMaxYMin meet ", 100},
                                                                                        {"xMidYMax slice", 0},
                                                                                        {"none slice", 0},
                                                                                        {"", 50},
                                                                                        {"xMinYmid", 50},
                                                                                        {"xMinYMid cover", 50},
                                                                                        {"xMinYMidslice", 50},
                                                                                        {"deferxMinYMid", 50},
                                                                                        {"Min", 50},
                                                                                        {"xMinYMin none", 50},
                                                                                        {"slice", 50}})
    EXPECT_EQ(import(std::string("<svg width='200' height='100' viewBox='0 0 10 10' preserveAspectRatio='") + ratio +
                     "'><path d='M0 0H10V10'/></svg>")
                  .drawing.paths.at(0)
                  .points.at(0),
              left)
        << ratio;
  EXPECT_EQ(import("<svg viewBox='0 0 30 20' width='100%'/>").drawing.width, 30);
  EXPECT_EQ(import("<svg/>").drawing.width, 0);
  const Import none = import("<svg width='0' height='-5'><path d='M0 0H10V10'/></svg>");
  EXPECT_EQ(none.drawing.width, 0);
  EXPECT_EQ(none.messages, (Texts{"E line 1: <svg> has a negative height; ignored",
                                  "W line 1: <svg> has a width, height or viewBox of zero; not drawn"}));
  EXPECT_EQ(page("<rect width='40' height='30' rx='-5' ry='8'/>").drawing.paths.at(0).points,
            page("<rect width='40' height='30' ry='8'/>").drawing.paths.at(0).points);
  const Import wide = import("\n<svg width='1e9' height='9'><rect width='1e9' height='9'/></svg>");
  EXPECT_EQ(wide.error, "2:1: <svg> is wider or taller than 10000000 pixels");
  EXPECT_EQ(wide.messages, Texts{});
}

TEST(SvgImport, ASizeOfZeroDrawsNothing) {
  const std::string line = "<path d='M0 0H9V9'/>", symbol = "<symbol id='s'>" + line + "</symbol><use href='#s' ";
  const struct {
    std::string text;
    const char* element; // in line 1
  } cases[] = {
      {"<svg viewBox='0 0 0 0'>" + line + "</svg>", "<svg>"},
      {"<svg width='10' height='10' viewBox='0 0 9 0'>" + line + "</svg>", "<svg>"},
      {"<svg width='10' height='0'>" + line + "</svg>", "<svg>"},
      {"<svg width='0%' height='10' viewBox='0 0 9 9'>" + line + "</svg>", "<svg>"},
      {"<svg><svg viewBox='0 0 0 0'>" + line + "</svg></svg>", "<svg>"},
      {"<svg><svg width='0'>" + line + "</svg></svg>", "<svg>"},
      {"<svg>" + symbol + "height='0'/></svg>", "<symbol>"},
      {"<svg><symbol id='s' viewBox='1 1 0 1'>" + line + "</symbol><use href='#s'/></svg>", "<symbol>"},
  };
  for (const auto& c : cases) {
    const Import i = import(c.text);
    EXPECT_TRUE(i.drawing.paths.empty()) << c.text;
    EXPECT_EQ(i.messages,
              (Texts{std::string("W line 1: ") + c.element + " has a width, height or viewBox of zero; not drawn"}))
        << c.text;
  }
  const std::pair<std::string, const char*> negative[] = {
      {"<svg width='-1' height='50'>" + line + "</svg>", "E line 1: <svg> has a negative width; ignored"},
      {"<svg height='-5%'>" + line + "</svg>", "E line 1: <svg> has a negative height; ignored"},
      {"<svg viewBox='0 0 -1 0'>" + line + "</svg>",
       "W line 1: <svg> has viewBox '0 0 -1 0', which is not valid; ignored"},
      {"<svg><svg width='-1'>" + line + "</svg></svg>", "E line 1: <svg> has a negative width; ignored"},
      {"<svg>" + symbol + "height='-1'/></svg>", "E line 1: <use> has a negative height; ignored"},
  };
  for (const auto& [text, message] : negative) {
    const Import i = import(text);
    EXPECT_EQ(i.drawing.paths.size(), 1u) << text;
    EXPECT_EQ(i.messages, Texts{message}) << text;
  }
  EXPECT_EQ(import("<svg width='8' height='6' viewBox='0 0 0 0'/>").drawing.width, 8);
}

TEST(SvgImport, CompilesToADrawingWithThePage) {
  const std::string text = bytesOf(GPGP_TEST_DATA "/svg/hud.svg");
  GpgpSvgSource source = GPGP_SVG_SOURCE_INIT;
  source.data = text.data();
  source.size = text.size();
  GpgpBlob blob{};
  ASSERT_EQ(gpgpCompileSvg(&source, &blob), GPGP_SUCCESS);
  const auto drawing =
      vector::loadBaked({static_cast<const std::byte*>(blob.data), blob.size}, std::pmr::get_default_resource());
  std::free(blob.data);
  ASSERT_TRUE(drawing) << drawing.error().text;
  EXPECT_EQ(drawing->paths.size(), 43u);
  EXPECT_EQ(drawing->viewport[2], 1280);
  EXPECT_EQ(drawing->viewport[3], 720);
  // Without a page, the ink is it, to the last bit: what is 20 wide takes 20 pixels.
  const std::string square =
      "<svg xmlns='http://www.w3.org/2000/svg'><rect x='100' y='3' width='20' height='20'/></svg>";
  source.data = square.data();
  source.size = square.size();
  ASSERT_EQ(gpgpCompileSvg(&source, &blob), GPGP_SUCCESS);
  const auto ink =
      vector::loadBaked({static_cast<const std::byte*>(blob.data), blob.size}, std::pmr::get_default_resource());
  std::free(blob.data);
  ASSERT_TRUE(ink) << ink.error().text;
  EXPECT_EQ(Floats(ink->bounds, ink->bounds + 4), (Floats{100, 3, 120, 23}));
  EXPECT_EQ(Floats(ink->viewport, ink->viewport + 4), (Floats{100, 3, 20, 20}));
  source.data = text.data();
  source.size = 20;
  EXPECT_EQ(gpgpCompileSvg(&source, &blob), GPGP_ERROR_INVALID_DATA);
  source.sType = 0;
  EXPECT_EQ(gpgpCompileSvg(&source, &blob), GPGP_ERROR_INVALID_STRUCT);
}

TEST(SvgImport, NoSvgIsAnError) {
  EXPECT_NE(import("this is no drawing").error, "");
  EXPECT_NE(import("").error, "");
  EXPECT_EQ(import("<html/>").error, "1:1: the outermost element is <html>, not <svg>");
  EXPECT_EQ(import("<svg>\n<g>\n</svg>").error.substr(0, 4), "3:3:");
  EXPECT_EQ(import("\x1f\x8b\x08").error, "the gzip data is truncated");
}

std::string gzip(std::string text) {
  z_stream z{};
  EXPECT_EQ(deflateInit2(&z, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(deflateBound(&z, text.size()), '\0');
  z.next_in = reinterpret_cast<Bytef*>(text.data());
  z.avail_in = static_cast<uInt>(text.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&z, Z_FINISH), Z_STREAM_END);
  out.resize(z.total_out);
  deflateEnd(&z);
  return out;
}

TEST(SvgImport, GzipOfSeveralMembers) {
  const std::string all = gzip("<svg><rect width='9'") + gzip("") + gzip(" height='9'/></svg>");
  const Import whole = import(all);
  EXPECT_EQ(whole.error, "");
  EXPECT_EQ(whole.drawing.paths.size(), 1u);
  EXPECT_EQ(import(all + std::string(9, '\0')).error, "");
  for (const std::string& rest :
       {std::string("x"), std::string("\x1f"), std::string("\0\0y", 3), std::string("<svg/>")})
    EXPECT_EQ(import(all + rest).error, "something else follows the gzip data");
  EXPECT_EQ(import(all + "\x1f\x8b").error, "the gzip data is truncated");
  EXPECT_EQ(import(all.substr(0, all.size() - 9)).error, "the gzip data is truncated");
  EXPECT_EQ(import(all + "\x1f\x8b\x01" + all).error, "the gzip data is damaged");
}

TEST(SvgImport, HostileInputIsBounded) {
  std::string deep, copies = "<g id='c0'><rect width='1' height='1'/></g>";
  for (int i = 0; i < 100000; ++i) deep += "<g>";
  for (int i = 0; i < 100000; ++i) deep += "</g>";
  EXPECT_EQ(page(deep).messages, (Texts{"E line 2: elements are nested deeper than 200; its contents are not drawn"}));
  for (int i = 1; i < 40; ++i) {
    const std::string last = "<use href='#c" + std::to_string(i - 1) + "'/>";
    copies += "<g id='c" + std::to_string(i) + "'>" + last + last + last + "</g>";
  }
  vector::svg::ImportLimits limits;
  limits.elements = 10000;
  const Import many = import("<svg>" + copies + "</svg>", limits);
  EXPECT_EQ(many.messages, (Texts{"E line 1: more than 10000 elements; the rest is not drawn"}));
  EXPECT_LE(many.drawing.paths.size(), 10000u);
  // Selectors that compare much: ways through what lies above, all that lies before, long values.
  vector::svg::ImportLimits few;
  few.matches = 20000;
  const auto times = [](size_t count, const std::string& text) {
    std::string all;
    for (size_t i = 0; i < count; ++i) all += text;
    return all;
  };
  for (const std::string& drawing : {"<style>p " + times(8, "g ") + "rect{fill:red}</style>" + times(24, "<g>") +
                                         "<rect/><rect/>" + times(24, "</g>"),
                                     "<style>path ~ rect ~ rect{fill:red}</style>" + times(400, "<rect/>"),
                                     "<style>[d*=zz]{fill:red}</style><path d='" + times(400000, "M") + "'/><rect/>",
                                     "<style>rect{font:" + times(40000, "a") + "}</style>" + times(9, "<rect/>")}) {
    const Import i = import("<svg>" + drawing + "</svg>", few);
    EXPECT_NE(std::find(i.messages.begin(), i.messages.end(),
                        "E line 1: the style sheets ask for too much; from here on they are left out"),
              i.messages.end())
        << drawing.substr(0, 60);
  }
  EXPECT_EQ(page("<path d='M0 0H90' stroke='red' stroke-dasharray='1e-9'/>").messages,
            (Texts{"E line 2: <path> has too many dashes (more than 65536); drawn without"}));
  EXPECT_EQ(import("<!DOCTYPE svg [<!ENTITY a 'aaaa'><!ENTITY b '&a;&a;&a;'>]><svg>&b;</svg>").error, "");
}

TEST(SvgImport, RealDrawings) {
  for (const auto& [name, paths] : {std::pair{"tiger", 250u}, {"car", 400u}, {"gallardo", 300u}}) {
    const std::string file = GPGP_TEST_DATA "/fetched/svg/" + std::string(name) + ".svgz";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is missing: run tests/data/fetch.sh";
    const Import i = import(bytesOf(file));
    EXPECT_EQ(i.error, "");
    EXPECT_GT(i.drawing.paths.size(), paths) << name;
    EXPECT_GT(i.drawing.width, 0) << name;
  }
}

TEST(SvgImport, ManyDrawingsAndDamagedOnes) {
  const std::string folder = GPGP_TEST_DATA "/fetched/openclipart";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is missing: run tests/data/fetch.sh";
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().string().find(".svg") != std::string::npos) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::mt19937 random(7);
  std::shuffle(files.begin(), files.end(), random);
  files.resize(std::min(files.size(), size_t{300}));
  size_t drawn = 0, refused = 0;
  for (const std::string& file : files) {
    std::string bytes = bytesOf(file);
    const Import i = import(bytes);
    drawn += !i.drawing.paths.empty();
    for (const auto& path : i.drawing.paths)
      for (const float v : path.points) ASSERT_LE(std::fabs(v), 1e7f) << file;
    if (bytes.size() > 200000) continue;
    bytes.resize(random() % (bytes.size() + 1));
    refused += !import(bytes).error.empty();
    for (int k = 0; k < 20 && !bytes.empty(); ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
    import(bytes);
  }
  EXPECT_GT(drawn, files.size() * 9 / 10);
  EXPECT_GT(refused, files.size() / 2);
}

} // namespace
