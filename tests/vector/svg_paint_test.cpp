// What paints refer to: the paints of a <use> around, templates of gradients, and transforms of these. And units that
// refer to the outermost element.
#include "svg_import.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace {
using namespace gpgp;
using namespace gpgp::test;

using Texts = std::vector<std::string>;
constexpr double kSame = 0.51; ///< of 255

void expectSame(const std::string& given, const std::string& reference) {
  const Import a = page(given), b = page(reference);
  EXPECT_EQ(a.placed, Texts()) << given;
  EXPECT_EQ(b.placed, Texts()) << reference;
  EXPECT_LE(worst(picture(a), picture(b)), kSame) << given;
}

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Each drawing of the folder that has a reference beside it is drawn as that, and says nothing.
TEST(SvgPaint, CasesAreWhatTheirReferencesAre) {
  const std::filesystem::path folder = GPGP_TEST_DATA "/cases/vector";
  TextFiles files;
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    files[name] = bytesOf(entry.path());
    if (name.ends_with(".ref.svg")) names.push_back(name.substr(0, name.size() - 8));
  }
  ASSERT_GE(names.size(), 6u);
  const GpgpFileSystem system = files.fileSystem();
  for (const std::string& name : names) {
    const Import given = import(files.at(name + ".svg"), {}, 1, &system), right = import(files.at(name + ".ref.svg"));
    EXPECT_EQ(given.placed, Texts()) << name;
    EXPECT_LE(worst(picture(given), picture(right)), kSame) << name;
  }
}

TEST(SvgPaint, ContextPaintsAreTheUses) {
  const std::string rect = "<defs><rect id='r' x='20' y='20' width='60' height='60' ",
                    plain = "<rect x='20' y='20' width='60' height='60' ";
  expectSame(rect + "fill='context-fill'/></defs><use href='#r' fill='#0a0'/>", plain + "fill='#0a0'/>");
  expectSame(rect + "fill='context-stroke'/></defs><use href='#r' stroke='#0a0'/>",
             plain + "fill='#0a0' stroke='#0a0'/>");
  expectSame(rect + "fill='none' stroke='context-fill' stroke-width='8'/></defs><use href='#r' fill='#0a0'/>",
             plain + "fill='none' stroke='#0a0' stroke-width='8'/>");
  // Of the innermost <use>; its own may refer to the one around.
  expectSame(rect + "fill='context-fill'/><g id='g'><use href='#r' fill='#00f'/></g></defs><use href='#g' "
                    "fill='#0a0'/>",
             plain + "fill='#00f'/>");
  expectSame(rect + "fill='context-fill'/><g id='g'><use href='#r' fill='context-stroke'/></g></defs><use href='#g' "
                    "fill='red' stroke='#0a0'/>",
             plain + "fill='#0a0' stroke='#0a0'/>");
  // Where colours are those of the <use>, and opacities the shape's.
  expectSame(rect + "fill='context-fill' color='red'/></defs><use href='#r' color='#0a0' fill='currentColor'/>",
             plain + "fill='#0a0'/>");
  expectSame(rect + "fill='context-fill' fill-opacity='.5'/></defs><use href='#r' fill='#0a0'/>",
             plain + "fill='#0a0' fill-opacity='.5'/>");
  // Gradients run over all that the <use> shows, in its coordinates.
  const std::string ramp = "<linearGradient id='g'><stop stop-color='red'/><stop offset='1' stop-color='blue'/>"
                           "</linearGradient>";
  expectSame(
      ramp + "<defs><g id='two'><rect width='20' height='50' fill='context-fill'/><rect x='60' width='20' "
             "height='50' fill='context-fill'/></g></defs><use href='#two' x='10' fill='url(#g)'/>",
      "<linearGradient id='g' gradientUnits='userSpaceOnUse' x1='10' x2='90'><stop stop-color='red'/><stop "
      "offset='1' stop-color='blue'/></linearGradient><path fill='url(#g)' d='M10 0H30V50H10ZM70 0H90V50H70Z'/>");
  expectSame("<linearGradient id='g' gradientUnits='userSpaceOnUse' x1='10' x2='50'><stop stop-color='red'/><stop "
             "offset='1' stop-color='blue'/></linearGradient><defs><g id='two'><rect width='20' height='20' "
             "transform='scale(2)' fill='context-fill'/></g></defs><use href='#two' x='10' fill='url(#g)'/>",
             "<linearGradient id='g' gradientUnits='userSpaceOnUse' x1='20' x2='60'><stop stop-color='red'/><stop "
             "offset='1' stop-color='blue'/></linearGradient><path fill='url(#g)' d='M10 0H50V40H10Z'/>");
  // Outside of one there is none (SVG 2, 13.2.1), which is said.
  for (const std::string text : {"<rect width='9' height='9' fill='context-fill'/>",
                                 "<g fill='context-fill'><rect id='q' width='9' height='9'/></g>"}) {
    const Import i = page(text);
    EXPECT_TRUE(i.drawing.paths.empty());
    ASSERT_EQ(i.messages.size(), 1u);
    EXPECT_EQ(i.messages[0],
              "W line 2: <rect> fill is context-fill outside of what a <use> or a marker shows; it is not painted");
  }
  EXPECT_EQ(page("<rect width='9' height='9' fill='url(#g) context-fill'/>").messages,
            Texts{"W line 2: <rect> has fill 'url(#g) context-fill', which is not valid; ignored"});
  // Many that refer to the box of all of them are measured once a <use>.
  std::string many = ramp + "<defs><g id='many'>";
  for (int i = 0; i < 3000; ++i) many += "<path d='M0 0h9v9' fill='context-fill'/>";
  EXPECT_EQ(page(many + "</g></defs><use href='#many' fill='url(#g)'/>").drawing.paths.size(), 3000u);
}

TEST(SvgPaint, CirclesOfARadialGradientThatAreOneAreAnEdge) {
  const auto gradient = [](const std::string& attributes) {
    const Import i = page("<radialGradient id='g' gradientUnits='userSpaceOnUse' cx='50' cy='50' r='30' " + attributes +
                          "><stop stop-color='red'/><stop offset='1' stop-color='blue'/></radialGradient><rect "
                          "width='100' height='100' fill='url(#g)'/>");
    EXPECT_EQ(i.drawing.paths.size(), 1u);
    return i.drawing.paths[0].gradient->gradient;
  };
  const GpgpGradient edge = gradient("fr='30'");
  EXPECT_EQ(edge.startRadius, 30);
  EXPECT_GT(edge.endRadius, 30); // the first colour inside, the last outside
  EXPECT_LT(edge.endRadius, 30.01f);
  EXPECT_EQ(gradient("fr='30' fx='40'").endRadius, 30);
  EXPECT_EQ(gradient("fr='20'").endRadius, 30);
  EXPECT_EQ(gradient("fr='30' spreadMethod='repeat'").endRadius, 30); // there is nothing between to repeat
}

TEST(SvgPaint, GradientsTakeWhatTheirTemplatesHave) {
  const std::string stops = "<stop stop-color='red'/><stop offset='1' stop-color='blue'/>",
                    rect = "<rect width='100' height='100' fill='url(#g)'/>";
  const auto linear = [&](const std::string& attributes) {
    return "<linearGradient id='g' " + attributes + ">" + stops + "</linearGradient>" + rect;
  };
  const auto with = [&](const std::string& other, const std::string& own) {
    return other + linear("href='#t' " + own);
  };
  // What both kinds have comes from either, what one kind has from that.
  expectSame(with("<linearGradient id='t' x2='0' y2='1'/>", ""), linear("x2='0' y2='1'"));
  expectSame(with("<radialGradient id='t' x2='0' y2='1'/>", ""), linear(""));
  expectSame(with("<radialGradient id='t' gradientTransform='rotate(90)' spreadMethod='reflect'/>", "x2='.5'"),
             linear("gradientTransform='rotate(90)' spreadMethod='reflect' x2='.5'"));
  expectSame(with("<linearGradient id='u' y2='1'/><radialGradient id='t' y2='.3' href='#u'/>", "x2='0'"),
             linear("x2='0' y2='1'"));
  expectSame("<linearGradient id='t' r='.2' cx='0'>" + stops + "</linearGradient><radialGradient id='g' href='#t'/>" +
                 rect,
             "<radialGradient id='g'>" + stops + "</radialGradient>" + rect);
  // Nothing comes from what is no gradient, and that is said at the reference.
  const Import none =
      page("<rect id='t' x1='1' gradientTransform='rotate(90)'>" + stops + "</rect>\n" + linear("href='#t'"));
  EXPECT_EQ(none.placed,
            (Texts{"test.svg:3:30: warning: <linearGradient> refers to '#t', which is not a gradient but a "
                   "<rect>; ignored"}));
  EXPECT_LE(worst(picture(none), picture(page(linear("")))), kSame);
  EXPECT_EQ(page("\n" + linear("href='#no'")).placed,
            Texts{"test.svg:3:30: warning: <linearGradient> refers to '#no', which does not exist; ignored"});
  EXPECT_EQ(page("\n" + linear("href=''")).messages.size(), 1u);
  std::string chain;
  for (int i = 0; i < 40; ++i)
    chain += std::string("<linearGradient id='") + std::string(i ? "c" + std::to_string(i) : "g") + "' href='#c" +
             std::to_string(i + 1) + "'/>";
  chain += "<linearGradient id='c40'>" + stops + "</linearGradient>" + rect;
  ASSERT_EQ(page(chain).messages.size(), 2u);
  EXPECT_NE(page(chain).messages[0].find("one more than 32"), std::string::npos);
}

TEST(SvgPaint, TransformsOfGradientsAreAProperty) {
  const std::string stops = "<stop stop-color='red'/><stop offset='1' stop-color='blue'/>",
                    rect = "<rect width='100' height='50' fill='url(#g)'/>";
  const auto linear = [&](const std::string& attributes) {
    return "<linearGradient id='g' " + attributes + ">" + stops + "</linearGradient>" + rect;
  };
  const std::string turned = linear("gradientTransform='rotate(90)'");
  expectSame(linear("style='transform:rotate(90deg)'"), turned);
  expectSame("<style>linearGradient {transform:rotate(90deg)}</style>" + linear("gradientTransform='scale(3)'"),
             turned);
  expectSame(linear("transform='rotate(45)' gradientTransform='rotate(90)'"), turned); // is no attribute of theirs
  expectSame(linear("style='transform:none' gradientTransform='rotate(90)'"), linear(""));
  expectSame("<radialGradient id='t' style='transform:rotate(90deg)'/>" + linear("href='#t'"), turned);
  expectSame("<radialGradient id='t' style='transform:rotate(90deg)'/>" + linear("href='#t' gradientTransform=''"),
             linear(""));
  expectSame(linear("style='transform:rotate(90deg);transform-origin:.5px .5px'"),
             linear("gradientTransform='rotate(90, .5, .5)'"));
  EXPECT_EQ(page("\n" + linear("gradientTransform='turn(90)'")).placed,
            Texts{"test.svg:3:43: error: <linearGradient> has an error in its gradientTransform, which is ignored"});
  EXPECT_EQ(page("\n" + linear("style='transform:turn(90)'")).placed,
            Texts{"test.svg:3:1: error: <linearGradient> has an error in its transform, which is ignored"});
}

TEST(SvgPaint, RemIsTheOutermostFontSize) {
  const auto width = [](const std::string& root, const std::string& inside) {
    const Import i = page(inside, root);
    EXPECT_EQ(i.placed, Texts()) << root << inside;
    return i.drawing.paths.at(0).points.at(2);
  };
  const std::string rect = "<rect width='2rem' height='9'/>";
  EXPECT_EQ(width("", rect), 24);
  EXPECT_EQ(width(" font-size='10'", rect), 20);
  EXPECT_EQ(width(" style='font:10px serif'", rect), 20);
  EXPECT_EQ(width(" style='font-size:2rem'", rect), 48); // of the initial one, 12
  EXPECT_EQ(width(" style='font-size:200%'", rect), 48);
  EXPECT_EQ(width(" font-size='10'", "<g font-size='99'>" + rect + "</g>"), 20);
  EXPECT_EQ(width(" font-size='10'", "<svg font-size='99' overflow='visible'>" + rect + "</svg>"), 20);
  EXPECT_EQ(width(" font-size='10'", "<g style='font-size:3rem'><rect width='2em' height='9'/></g>"), 60);
  EXPECT_EQ(width(" font-size='10'", "<g id='g'><rect width='2em' height='9'/></g><style>#g {font:3rem/1 a}</style>"),
            60);
  EXPECT_EQ(
      width(" style='font-size:10px'", "<rect width='1' height='9' style='transform:translateX(2rem) scaleX(2)'/>"),
      22);
  EXPECT_EQ(import("<svg style='font-size:10px;width:9rem;height:2rem'/>").drawing.width, 90);
  expectSame("<svg width='100' height='100' style='font-size:99px' viewBox='0 0 100 100'><linearGradient id='g' "
             "gradientUnits='userSpaceOnUse' x2='5rem'><stop/><stop offset='1' stop-color='red'/></linearGradient>"
             "<rect width='100' height='100' fill='url(#g)'/></svg>",
             "<linearGradient id='g' gradientUnits='userSpaceOnUse' x2='60'><stop/><stop offset='1' "
             "stop-color='red'/></linearGradient><rect width='100' height='100' fill='url(#g)'/>");
}

TEST(SvgPaint, ValuesThatAreNotValidLeaveTheOnesBefore) {
  for (const auto& [property, good, bad] :
       std::initializer_list<std::array<const char*, 3>>{{"display", "none", "nothing"},
                                                         {"overflow", "visible", "shown"},
                                                         {"paint-order", "stroke", "stroke stroke"},
                                                         {"paint-order", "stroke", "fill-first"},
                                                         {"vector-effect", "non-scaling-stroke", "scaling"}}) {
    const std::string name = property;
    const std::string svg =
                          "<svg width='50' height='50' stroke='red' stroke-width='9' style='" + name + ":" + good + ";",
                      rest = "'><g style='vector-effect:inherit'><rect width='80' height='80'/></g></svg>";
    const Import once = page(svg + rest), twice = page(svg + name + ":" + bad + rest);
    EXPECT_EQ(twice.placed, Texts{std::string("test.svg:2:1: warning: <svg> has ") + name + " '" + bad +
                                  "', which is not valid; ignored"});
    EXPECT_LE(worst(picture(once), picture(twice)), 0) << name;
  }
  EXPECT_EQ(page("<path d='M0 0h9v9' style='display:inline flow-root;overflow:clip;paint-order:normal;"
                 "vector-effect:none;font-size:xxx-large'/>")
                .placed,
            Texts());
}

TEST(SvgPaint, ErrorsOfValuesAreThoseOfCss) {
  const std::string whole = "<rect width='100' height='100'/>", green = "<rect width='100' height='100' fill='green'/>";
  const auto styled = [&](const std::string& css) { return "<style>" + css + "</style>" + whole; };
  expectSame(styled("rect{fill:gr\\65 en}"), green);
  expectSame(styled("rect{f\\69ll:\\000067reen}"), green);
  // Without quotes the value of an attribute is a name.
  EXPECT_EQ(page(styled("rect[width=100]{fill:green}")).placed,
            Texts{"test.svg:2:8: warning: style selector 'rect[width=100]' is not valid; its rule is ignored"});
  expectSame(styled("rect[width='100']{fill:green}"), green);
  // What is written with commas is of one kind, and what has units is written with commas.
  const struct {
    const char *name, *value;
    bool isValid;
  } values[] = {{"fill", "rgb(0,50%,0)", false},    {"fill", "rgb(0,50,0,50%)", true},
                {"fill", "rgb(0 50% 0)", true},     {"fill", "rgb(0%,50%,0%)", true},
                {"stroke-miterlimit", "-1", false}, {"stroke-miterlimit", "0.5", true}};
  for (const auto& v : values) {
    const Import made = page(std::string("<rect width='9' height='9' ") + v.name + "='" + v.value + "'/>");
    ASSERT_EQ(made.placed.size(), v.isValid ? 0u : 1u) << v.value;
    if (v.isValid) continue;
    EXPECT_NE(made.placed[0].find("is not valid; ignored"), std::string::npos) << made.placed[0];
  }
  const Import spaced = page(styled("rect{transform:translate(10px 10px)}"));
  ASSERT_EQ(spaced.placed.size(), 1u);
  EXPECT_NE(spaced.placed[0].find("error in its transform"), std::string::npos) << spaced.placed[0];
  EXPECT_LE(worst(picture(spaced), picture(page(whole))), kSame);
  expectSame(styled("rect{transform:translate(10px, 10px)}"), "<rect x='10' y='10' width='100' height='100'/>");
  expectSame("<rect width='100' height='100' transform='translate(10 10)'/>",
             "<rect x='10' y='10' width='100' height='100'/>");
  // A limit below 1 bevels all corners.
  const std::string angle = "<path fill='none' stroke='red' stroke-width='20' d='M20 80V20H80' ";
  expectSame(angle + "stroke-miterlimit='.5'/>", angle + "stroke-linejoin='bevel'/>");
}

} // namespace
