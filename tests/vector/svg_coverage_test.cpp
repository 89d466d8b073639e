// Nothing of SVG goes by in silence: each property and each element of SVG 1.1 and SVG 2 is drawn as plain features
// draw it, or named with its place, or has no effect on a still picture.
#include "svg_import.h"

#include <gtest/gtest.h>

#include <cstring>
#include <set>

namespace {
using namespace gpgp;
using namespace gpgp::test;

using Texts = std::vector<std::string>;

constexpr double kSame = 0.51; ///< of 255: what rounding of points to floats may come to on an edge

/// What a thing comes to: a drawing by plain features, a message, or the plain subject.
struct Outcome {
  const char* reference = nullptr;
  const char* message = nullptr; ///< a part of it
};
Outcome as(const char* reference) { return {reference, nullptr}; }
Outcome named(const char* message) { return {nullptr, message}; }
constexpr Outcome kNothing; ///< for text, filters or people with a mouse, which are named where they are, or not drawn

void expectOutcome(const std::string& what, const Import& given, const Outcome& outcome, const Import& plain) {
  SCOPED_TRACE(what);
  EXPECT_EQ(given.error, "");
  if (outcome.message) {
    ASSERT_EQ(given.placed.size(), 1u);
    EXPECT_NE(given.placed[0].find(outcome.message), std::string::npos) << given.placed[0];
    EXPECT_EQ(given.placed[0].rfind("test.svg:2:", 0), 0u) << given.placed[0]; // with its place
    return;
  }
  EXPECT_EQ(given.placed, Texts());
  EXPECT_LE(worst(picture(given), picture(outcome.reference ? page(outcome.reference) : plain)), kSame);
}

struct Property {
  const char* name;
  const char* value;
  const char* before; ///< a tag that takes the property, and what stands before it
  const char* after;
  Outcome outcome;
  bool isAttribute = true; ///< of SVG; otherwise style sheets alone have it
};

const char* const kRect = "<rect x='20' y='20' width='60' height='60' fill='#0a0' stroke='#00a' stroke-width='8' ";
const char* const kBare = "<path d='M10 10H70V60H30V30H90V90H10Z' ";
const char* const kLine = "<path fill='none' stroke='red' stroke-width='20' d='M20 20H80L20 80' ";
const char* const kClip = "<clipPath id='c'><path d='M0 0H50V100H0Z'/></clipPath><rect x='20' y='20' width='60' "
                          "height='60' fill='#0a0' ";
const char* const kMarked =
    "<marker id='m' markerUnits='userSpaceOnUse' markerWidth='20' markerHeight='20' refX='10' refY='10'><rect "
    "width='20' height='20' fill='#a00'/></marker><path fill='none' d='M20 20H80V80' ";
const char* const kStops = "<linearGradient id='g'><stop stop-color='red'/><stop offset='1' ";
const char* const kPainted = "/></linearGradient><rect width='100' height='100' fill='url(#g)'/>";

const Property kProperties[] = {
    // Drawn.
    {"fill", "#a00", "<rect x='20' y='20' width='60' height='60' ", "/>",
     as("<rect x='20' y='20' width='60' height='60' fill='#a00'/>")},
    {"fill-opacity", "0.5", "<rect x='20' y='20' width='60' height='60' fill='#00f' ", "/>",
     as("<rect x='20' y='20' width='60' height='60' fill='#7f7fff'/>")},
    {"fill-rule", "evenodd", kBare, "/>",
     as("<path d='M10 10H70V30H90V90H10Z M30 30H70V60H30Z' fill-rule='evenodd'/>")},
    {"opacity", "50%", "<rect x='20' y='20' width='60' height='60' fill='#00f' ", "/>",
     as("<rect x='20' y='20' width='60' height='60' fill='#7f7fff'/>")},
    {"stroke", "#a00", "<path fill='none' stroke-width='20' d='M0 50H100' ", "/>",
     as("<rect y='40' width='100' height='20' fill='#a00'/>")},
    {"stroke-width", "30", "<path fill='none' stroke='#a00' d='M0 50H100' ", "/>",
     as("<rect y='35' width='100' height='30' fill='#a00'/>")},
    {"stroke-opacity", "0.5", "<path fill='none' stroke='#00f' stroke-width='20' d='M0 50H100' ", "/>",
     as("<rect y='40' width='100' height='20' fill='#7f7fff'/>")},
    {"stroke-linecap", "square", "<path fill='none' stroke='#a00' stroke-width='20' d='M40 50H60' ", "/>",
     as("<rect x='30' y='40' width='40' height='20' fill='#a00'/>")},
    {"stroke-linejoin", "bevel", "<path fill='none' stroke='red' stroke-width='20' d='M20 80V20H80' ", "/>",
     as("<path fill='red' d='M10 80V20L20 10H80V30H30V80Z'/>")},
    {"stroke-linejoin", "arcs", kLine, "/>",
     as("<path fill='none' stroke='red' stroke-width='20' stroke-linejoin='miter-clip' d='M20 20H80L20 80'/>")},
    {"stroke-miterlimit", "1", "<path fill='none' stroke='red' stroke-width='20' d='M20 80V20H80' ", "/>",
     as("<path fill='red' d='M10 80V20L20 10H80V30H30V80Z'/>")},
    {"stroke-dasharray", "20 10", "<path fill='none' stroke='#a00' stroke-width='20' d='M0 50H50' ", "/>",
     as("<path fill='#a00' d='M0 40H20V60H0ZM30 40H50V60H30Z'/>")},
    {"stroke-dashoffset", "10",
     "<path fill='none' stroke='#a00' stroke-width='20' stroke-dasharray='20 10' d='M0 50H50' ", "/>",
     as("<path fill='#a00' d='M0 40H10V60H0ZM20 40H40V60H20Z'/>")},
    {"color", "#a00", "<rect x='20' y='20' width='60' height='60' fill='currentColor' ", "/>",
     as("<rect x='20' y='20' width='60' height='60' fill='#a00'/>")},
    {"visibility", "hidden", kRect, "/>", as("")},
    {"display", "none", kRect, "/>", as("")},
    {"overflow", "visible", "<svg x='10' y='10' width='20' height='20' ", "><rect width='60' height='60'/></svg>",
     as("<rect x='10' y='10' width='60' height='60'/>")},
    {"paint-order", "stroke", kRect, "/>",
     as("<path fill='#00a' d='M16 16H84V84H16Z'/><path fill='#0a0' d='M20 20H80V80H20Z'/>")},
    {"vector-effect", "non-scaling-stroke",
     "<path transform='scale(10)' fill='none' stroke='#a00' stroke-width='20' d='M0 5H10' ", "/>",
     as("<rect y='40' width='100' height='20' fill='#a00'/>")},
    {"vector-effect", "non-rotation", kRect, "/>", named("vector-effect other than non-scaling-stroke")},
    {"stop-color", "#00f", kStops, kPainted,
     as("<linearGradient id='g'><stop stop-color='#f00'/><stop offset='1' stop-color='#00f'/></linearGradient>"
        "<rect width='100' height='100' fill='url(#g)'/>")},
    {"stop-opacity", "0", kStops, kPainted,
     as("<linearGradient id='g'><stop stop-color='#f00'/><stop offset='1' stop-color='rgba(0,0,0,0)'/>"
        "</linearGradient><rect width='100' height='100' fill='url(#g)'/>")},
    {"color-interpolation", "linearRGB", "<linearGradient id='g' ",
     "><stop stop-color='#fff'/><stop offset='1'/></linearGradient><path d='M49 0H51V100H49Z' fill='url(#g)'/>",
     as("<linearGradient id='g' style='color-interpolation:linearRGB'><stop stop-color='#fff'/><stop offset='1'/>"
        "</linearGradient><path d='M49 0H51V100H49Z' fill='url(#g)'/>")},
    {"color-interpolation", "linearRGB", "<path d='M0 0h9v9' fill-opacity='.5' ", "/>",
     named("color-interpolation linearRGB of a painted element is not supported")},
    {"clip-path", "url(#c)", kClip, "/>", as("<rect x='20' y='20' width='30' height='60' fill='#0a0'/>")},
    {"clip-path", "circle(20px)", kRect, "/>", named("is not a clipPath of this file")},
    {"clip-rule", "evenodd", "<clipPath id='c'><path d='M0 0H100V100H0ZM30 30H70V70H30Z' ",
     "/></clipPath><rect width='100' height='100' clip-path='url(#c)'/>",
     as("<path d='M0 0H100V100H0ZM30 30V70H70V30Z'/>")},
    {"transform", "rotate(90, 50, 50)", "<rect x='10' y='40' width='30' height='20' ", "/>",
     as("<rect x='40' y='10' width='20' height='30'/>")},
    {"transform-origin", "50px 50px", "<rect x='10' y='40' width='30' height='20' transform='rotate(90)' ", "/>",
     as("<rect x='40' y='10' width='20' height='30'/>")},
    {"transform-box", "fill-box", "<rect x='20' y='20' width='20' height='20' transform='scale(2)' ", "/>",
     as("<rect x='20' y='20' width='40' height='40'/>"), false},
    {"transform-box", "stroke-box", kRect, "/>", named("transform-box 'stroke-box'"), false},
    {"translate", "5px 10%", "<rect width='20' height='20' ", "/>", as("<rect x='5' y='10' width='20' height='20'/>"),
     false},
    {"rotate", "90deg", "<rect x='10' y='40' width='30' height='20' transform-origin='50 50' ", "/>",
     as("<rect x='40' y='10' width='20' height='30'/>"), false},
    {"scale", "2 1", "<rect width='20' height='20' ", "/>", as("<rect width='40' height='20'/>"), false},
    {"font-size", "5px", "<rect width='4em' height='4em' ", "/>", as("<rect width='20' height='20'/>")},
    {"font", "5px serif", "<rect width='4em' height='4em' ", "/>", as("<rect width='20' height='20'/>"), false},
    {"x", "30px", "<rect y='20' width='20' height='20' ", "/>", as("<rect x='30' y='20' width='20' height='20'/>")},
    {"y", "30px", "<rect x='20' width='20' height='20' ", "/>", as("<rect x='20' y='30' width='20' height='20'/>")},
    {"width", "30px", "<rect height='20' ", "/>", as("<rect width='30' height='20'/>")},
    {"height", "30px", "<rect width='20' ", "/>", as("<rect width='20' height='30'/>")},
    {"rx", "10px", "<rect width='40' height='40' ", "/>", as("<rect width='40' height='40' rx='10' ry='10'/>")},
    {"ry", "10px", "<rect width='40' height='40' ", "/>", as("<rect width='40' height='40' rx='10' ry='10'/>")},
    {"cx", "50px", "<circle cy='40' r='30' ", "/>", as("<ellipse cx='50' cy='40' rx='30' ry='30'/>")},
    {"cy", "40px", "<circle cx='50' r='30' ", "/>", as("<ellipse cx='50' cy='40' rx='30' ry='30'/>")},
    {"r", "30px", "<circle cx='50' cy='40' ", "/>", as("<ellipse cx='50' cy='40' rx='30' ry='30'/>")},
    {"d", "path(\"M0 0H50V50Z\")", "<path ", "/>", as("<polygon points='0 0 50 0 50 50'/>"), false},
    {"marker", "url(#m)", kMarked, "/>", as("<path d='M10 10H30V30H10ZM70 10H90V30H70ZM70 70H90V90H70Z' fill='#a00'/>"),
     false},
    {"marker-start", "url(#m)", kMarked, "/>", as("<path d='M10 10H30V30H10Z' fill='#a00'/>")},
    {"marker-mid", "url(#m)", kMarked, "/>", as("<path d='M70 10H90V30H70Z' fill='#a00'/>")},
    {"marker-end", "url(#m)", kMarked, "/>", as("<path d='M70 70H90V90H70Z' fill='#a00'/>")},
    // Named.
    {"clip", "rect(0 1px 1px 0)", "<svg width='50' height='50' ", "/>", named("clip is not supported")},
    {"filter", "url(#f)", kRect, "/>", named("filter '#f' does not exist")},
    {"filter", "url(a.svg#f)", kRect, "/>", named("filter 'a.svg#f' of another file is not supported")},
    {"mask", "url(#m)", kRect, "/>", named("mask 'url(#m)' does not exist")},
    {"mask", "url(a.png)", kRect, "/>", named("mask 'url(a.png)' is not supported")},
    {"mask-image", "url(#m)", kRect, "/>", named("mask-image is not supported"), false},
    {"mask-border", "url(a.png) 30", kRect, "/>", named("mask-border is not supported"), false},
    {"shape-rendering", "crispEdges", kRect, "/>", named("shape-rendering is not supported")},
    {"image-rendering", "pixelated", "<g ", "/>", named("image-rendering is not supported")},
    {"perspective", "9px", kRect, "/>", named("perspective is not supported"), false},
    {"offset-path", "path('M0 0H9')", kRect, "/>", named("offset-path is not supported"), false},
    {"offset", "path('M0 0H9') 50%", kRect, "/>", named("offset is not supported"), false},
    {"backdrop-filter", "blur(3px)", kRect, "/>", named("backdrop-filter is not supported"), false},
    {"zoom", "2", kRect, "/>", named("zoom is not supported"), false},
    {"all", "unset", "<g ", "/>", kNothing, false},
    {"animation", "spin 3s", kRect, "/>", named("animation is not supported"), false},
    {"animation-name", "spin", kRect, "/>", named("animation-name is not supported"), false},
    {"content-visibility", "hidden", kRect, "/>", named("content-visibility is not supported"), false},
    {"color-scheme", "dark", kRect, "/>", named("color-scheme is not supported"), false},
    {"-webkit-mask", "url(#m)", kRect, "/>", named("-webkit-mask is not supported"), false},
    {"-webkit-filter", "blur(3px)", kRect, "/>", named("-webkit-filter is not supported"), false},
    {"-webkit-transform", "scale(2)", kRect, "/>", named("-webkit-transform is not supported"), false},
    {"-webkit-clip-path", "circle(9px)", kRect, "/>", named("-webkit-clip-path is not supported"), false},
    {"stroke-alignment", "inner", kRect, "/>", named("stroke-alignment is not supported"), false},
    {"fill-image", "linear-gradient(red, blue)", kRect, "/>", named("fill-image is not supported"), false},
    {"stroke-image", "linear-gradient(red, blue)", kRect, "/>", named("stroke-image is not supported"), false},
    // For text, whose element is named.
    {"alignment-baseline", "middle", kRect, "/>", kNothing},
    {"baseline-shift", "super", kRect, "/>", kNothing},
    {"direction", "rtl", kRect, "/>", kNothing},
    {"dominant-baseline", "middle", kRect, "/>", kNothing},
    {"font-family", "serif", kRect, "/>", kNothing},
    {"font-feature-settings", "normal", kRect, "/>", kNothing, false},
    {"font-kerning", "none", kRect, "/>", kNothing, false},
    {"font-size-adjust", "1", kRect, "/>", kNothing},
    {"font-stretch", "condensed", kRect, "/>", kNothing},
    {"font-style", "italic", kRect, "/>", kNothing},
    {"font-variant", "small-caps", kRect, "/>", kNothing},
    {"font-weight", "bold", kRect, "/>", kNothing},
    {"glyph-orientation-horizontal", "90", kRect, "/>", kNothing},
    {"glyph-orientation-vertical", "90", kRect, "/>", kNothing},
    {"inline-size", "50px", kRect, "/>", kNothing, false},
    {"kerning", "2", kRect, "/>", kNothing},
    {"letter-spacing", "2", kRect, "/>", kNothing},
    {"line-height", "2", kRect, "/>", kNothing, false},
    {"shape-inside", "url(#r)", kRect, "/>", kNothing, false},
    {"shape-margin", "2px", kRect, "/>", kNothing, false},
    {"shape-padding", "2px", kRect, "/>", kNothing, false},
    {"shape-subtract", "url(#r)", kRect, "/>", kNothing, false},
    {"tab-size", "2", kRect, "/>", kNothing, false},
    {"text-anchor", "middle", kRect, "/>", kNothing},
    {"text-decoration", "underline", kRect, "/>", kNothing},
    {"text-decoration-line", "underline", kRect, "/>", kNothing, false},
    {"text-indent", "9px", kRect, "/>", kNothing, false},
    {"text-overflow", "ellipsis", kRect, "/>", kNothing},
    {"text-orientation", "upright", kRect, "/>", kNothing, false},
    {"text-rendering", "optimizeSpeed", kRect, "/>", kNothing},
    {"text-shadow", "1px 1px red", kRect, "/>", kNothing, false},
    {"unicode-bidi", "embed", kRect, "/>", kNothing},
    {"white-space", "pre", kRect, "/>", kNothing, false},
    {"word-spacing", "2", kRect, "/>", kNothing},
    {"writing-mode", "tb", kRect, "/>", kNothing},
    // For filters, masks and blending, which svg_layers_test looks at.
    {"color-interpolation-filters", "linearRGB", kRect, "/>", kNothing},
    {"enable-background", "new", kRect, "/>", kNothing},
    {"flood-color", "red", kRect, "/>", kNothing},
    {"flood-opacity", "0.5", kRect, "/>", kNothing},
    {"isolation", "isolate", kRect, "/>", kNothing, false},
    {"lighting-color", "red", kRect, "/>", kNothing},
    {"mask-type", "alpha", kRect, "/>", kNothing},
    // Hints, and for people with a mouse.
    {"color-profile", "auto", kRect, "/>", kNothing},
    {"color-rendering", "optimizeSpeed", kRect, "/>", kNothing},
    {"cursor", "pointer", kRect, "/>", kNothing},
    {"pointer-events", "none", kRect, "/>", kNothing},
    {"solid-color", "red", kRect, "/>", kNothing},
    {"solid-opacity", "0.5", kRect, "/>", kNothing},
    {"transition", "fill 3s", kRect, "/>", kNothing, false},
    {"will-change", "transform", kRect, "/>", kNothing, false},
    {"shape-rendering", "geometricPrecision", kRect, "/>", kNothing},
    {"image-rendering", "optimizeQuality", kRect, "/>", kNothing},
    // Of boxes, which the outermost element alone has.
    {"background", "red", kRect, "/>", kNothing, false},
    {"background-color", "red", kRect, "/>", kNothing, false},
    {"border", "1px solid red", kRect, "/>", kNothing, false},
    {"box-shadow", "1px 1px red", kRect, "/>", kNothing, false},
};

/// Whether a tag is that of the plain subject.
Import plainOf(const Property& p) { return page(std::string(p.before) + p.after); }

TEST(SvgCoverage, EachPropertyIsDrawnOrNamedOrHasNoEffect) {
  for (const Property& p : kProperties) {
    const Import plain = plainOf(p);
    const std::string name = p.name, value = p.value;
    std::string quoted; // for an attribute
    for (const char c : value) quoted += c == '\'' ? std::string("&apos;") : std::string(1, c);
    const std::string style = std::string(p.before) + "style='" + name + ":" + quoted + "'" + p.after;
    expectOutcome("style='" + name + ":" + value + "'", page(style), p.outcome, plain);
    if (p.isAttribute && name != "mix-blend-mode") {
      const std::string unit =
          value.ends_with("px") && value.find(' ') == value.npos ? value.substr(0, value.size() - 2) : quoted;
      expectOutcome(name + "='" + unit + "'", page(std::string(p.before) + name + "='" + unit + "'" + p.after),
                    p.outcome, plain);
    }
    // In a style sheet whose rule follows what it is for, so that places stay.
    std::string classed = std::string(p.before) + "class='k'" + p.after;
    expectOutcome(".k {" + name + ":" + value + "}", page(classed + "<style>.k {" + name + ":" + quoted + "}</style>"),
                  p.outcome, plain);
    // What is not valid is said for all that count.
    if (p.outcome.reference && name != "d") {
      const Import bad = page(std::string(p.before) + "style='" + name + ":foo-bar(1)'" + p.after);
      EXPECT_EQ(bad.placed.size(), 1u) << name;
    }
  }
}

struct Element {
  const char* name;
  const char* text;
  Outcome outcome;
};

const char* const kReference = "<rect x='20' y='20' width='60' height='60' fill='#0a0'/>";
const char* const kEmpty = "";

const Element kElements[] = {
    // Drawn.
    {"svg", "<svg x='20' y='20' width='60' height='60'><rect width='90' height='60' fill='#0a0'/></svg>",
     as(kReference)},
    {"g", "<g fill='#0a0'><rect x='20' y='20' width='60' height='60'/></g>", as(kReference)},
    {"a", "<a href='x' fill='#0a0'><rect x='20' y='20' width='60' height='60'/></a>", as(kReference)},
    {"switch", "<switch fill='#0a0'><g systemLanguage='xx'/><rect x='20' y='20' width='60' height='60'/><g/></switch>",
     as(kReference)},
    {"defs", "<defs><rect width='60' height='60'/></defs>", as(kEmpty)},
    {"use", "<defs><rect id='r' width='60' height='60'/></defs><use href='#r' x='20' y='20' fill='#0a0'/>",
     as(kReference)},
    {"symbol",
     "<symbol id='s' viewBox='0 0 2 2'><rect width='2' height='2'/></symbol><use href='#s' x='20' y='20' "
     "width='60' height='60' fill='#0a0'/>",
     as(kReference)},
    {"rect", "<rect x='20%' y='20%' width='60%' height='60%' fill='#0a0'/>", as(kReference)},
    {"path", "<path d='M20 20h60v60h-60z' fill='#0a0'/>", as(kReference)},
    {"polygon", "<polygon points='20 20 80 20 80 80 20 80' fill='#0a0'/>", as(kReference)},
    {"polyline", "<polyline points='20 20 80 20 80 80 20 80' fill='#0a0'/>", as(kReference)},
    {"line", "<line x1='20' x2='80' y1='50' y2='50' stroke-width='60' stroke='#0a0'/>", as(kReference)},
    {"circle", "<circle cx='50' cy='50' r='30'/>", as("<rect x='20' y='20' width='60' height='60' rx='30'/>")},
    {"ellipse", "<ellipse cx='50' cy='50' rx='30' ry='30'/>",
     as("<rect x='20' y='20' width='60' height='60' rx='30'/>")},
    {"linearGradient",
     "<linearGradient id='g'><stop stop-color='#0a0'/></linearGradient><rect x='20' y='20' width='60' height='60' "
     "fill='url(#g)'/>",
     as(kReference)},
    {"radialGradient",
     "<radialGradient id='g'><stop stop-color='#0a0'/></radialGradient><rect x='20' y='20' width='60' height='60' "
     "fill='url(#g)'/>",
     as(kReference)},
    {"stop", "<stop/>", as(kEmpty)},
    {"clipPath",
     "<clipPath id='c'><rect x='20' y='20' width='60' height='60'/></clipPath><rect width='100' height='100' "
     "fill='#0a0' clip-path='url(#c)'/>",
     as(kReference)},
    {"style", "<style>rect {fill:#0a0}</style><rect x='20' y='20' width='60' height='60'/>", as(kReference)},
    {"marker",
     "<marker id='m' markerWidth='60' markerHeight='60'><rect width='60' height='60' fill='#0a0'/></marker><path "
     "fill='none' d='M20 20H90' marker-start='url(#m)'/>",
     as(kReference)},
    {"pattern",
     "<pattern id='p' width='1' height='1'><rect width='60' height='60' fill='#0a0'/></pattern><rect x='20' y='20' "
     "width='60' height='60' fill='url(#p)'/>",
     as(kReference)},
    {"title", "<title>a</title>", as(kEmpty)},
    {"desc", "<desc>a</desc>", as(kEmpty)},
    {"metadata", "<metadata><rect width='9' height='9'/></metadata>", as(kEmpty)},
    {"view", "<view id='v' viewBox='0 0 9 9'/>", as(kEmpty)},
    // Named where they would be seen.
    {"text", "<text>a</text>", named("<text> is not supported")},
    {"tspan", "<text><tspan>a</tspan></text>", named("<text> is not supported")},
    {"tref", "<text><tref href='#a'/></text>", named("<text> is not supported")},
    {"textPath", "<text><textPath href='#a'>a</textPath></text>", named("<text> is not supported")},
    {"altGlyph", "<text><altGlyph href='#a'>a</altGlyph></text>", named("<text> is not supported")},
    {"glyphRef", "<text><altGlyph><glyphRef/></altGlyph></text>", named("<text> is not supported")},
    {"image", "<image href='a.png' width='9' height='9'/>", named("<image> is not supported")},
    {"foreignObject", "<foreignObject width='9' height='9'/>", named("<foreignObject> is not supported")},
    {"foreignObject", "<switch><foreignObject width='9' height='9'/><g/></switch>",
     named("<foreignObject> is not supported: <switch> shows what follows it")},
    {"hatch", "<hatch id='p'><hatchpath/></hatch><rect width='9' height='9' fill='url(#p)'/>",
     named("a <hatch>, which")},
    {"hatchpath", "<hatchpath/>", named("<hatchpath> is not supported")},
    {"meshgradient", "<meshgradient id='p'/><rect width='9' height='9' fill='url(#p)'/>",
     named("a <meshgradient>, which")},
    {"solidColor", "<solidColor id='p'/><rect width='9' height='9' fill='url(#p)'/>", named("a <solidColor>, which")},
    {"solidcolor", "<solidcolor id='p'/>", named("<solidcolor> is not supported")},
    {"mesh", "<mesh/>", named("<mesh> is not supported")},
    {"meshpatch", "<meshpatch/>", named("<meshpatch> is not supported")},
    {"meshrow", "<meshrow/>", named("<meshrow> is not supported")},
    {"mask", "<mask id='m'/><rect width='9' height='9' mask='url(#m)'/>", as(kEmpty)},
    {"filter", "<filter id='m'/><path d='M0 0h9v9' filter='url(#m)'/>", as(kEmpty)},
    {"animate", "<defs><animate href='#r'/></defs>", named("<animate> is not supported")},
    {"animateColor", "<rect width='9' height='9'><animateColor/></rect>", named("<animateColor> is not supported")},
    {"animateMotion", "<animateMotion><mpath/></animateMotion>", named("<animateMotion> is not supported")},
    {"mpath", "<mpath/>", named("<mpath> is not supported")},
    {"animateTransform", "<symbol><animateTransform/></symbol>", named("<animateTransform> is not supported")},
    {"set", "<set/>", named("<set> is not supported")},
    {"discard", "<defs><discard/></defs>", named("<discard> is not supported")},
    {"script", "<defs><script>1</script></defs>", named("<script> is not supported")},
    {"handler", "<rect width='9' height='9'><handler/></rect>", named("<handler> is not supported")},
    {"listener", "<defs><listener/></defs>", named("<listener> is not supported")},
    {"link", "<defs><link rel='stylesheet' href='a.css'/></defs>", named("<link> is not supported")},
    {"video", "<video/>", named("<video> is not supported")},
    {"audio", "<audio/>", named("<audio> is not supported")},
    {"canvas", "<canvas/>", named("<canvas> is not supported")},
    {"iframe", "<iframe/>", named("<iframe> is not supported")},
    {"video of HTML", "<h:video xmlns:h='http://www.w3.org/1999/xhtml'/>", named("HTML's <video> is not supported")},
    {"canvas of HTML", "<h:canvas xmlns:h='http://www.w3.org/1999/xhtml'/>", named("HTML's <canvas> is not supported")},
    {"iframe of HTML", "<h:iframe xmlns:h='http://www.w3.org/1999/xhtml'/>", named("HTML's <iframe> is not supported")},
    {"flowRoot", "<flowRoot/>", named("<flowRoot> is not supported")},
    {"unknown", "<unknown/>", named("<unknown> is not supported")},
    // Of fonts in SVG, which text alone shows, and for people with a mouse.
    {"font",
     "<font><font-face><font-face-src><font-face-uri/><font-face-name/><font-face-format/></font-face-src>"
     "</font-face><missing-glyph/><glyph/><hkern/><vkern/></font>",
     as(kEmpty)},
    {"font-face", "<font-face/>", as(kEmpty)},
    {"glyph", "<glyph/>", as(kEmpty)},
    {"missing-glyph", "<missing-glyph/>", as(kEmpty)},
    {"altGlyphDef", "<defs><altGlyphDef><altGlyphItem/></altGlyphDef></defs>", as(kEmpty)},
    {"color-profile", "<color-profile/>", as(kEmpty)},
    {"cursor", "<cursor/>", as(kEmpty)},
    // References to what shows nothing.
    {"use of a gradient", "<linearGradient id='g'/><use href='#g'/>", named("a <linearGradient>, which shows nothing")},
    {"use of a clipPath", "<clipPath id='g'/><use href='#g'/>", named("a <clipPath>, which shows nothing")},
    {"undefined entity", "<g>&chapter;</g>", named("'&chapter;' is not defined in this file")},
    {"style of another language", "<style type='text/less'>a {}</style>", named("<style> of type 'text/less'")},
};

TEST(SvgCoverage, EachElementIsDrawnOrNamedOrShowsNothing) {
  for (const Element& e : kElements) expectOutcome(e.name, page(e.text), e.outcome, page(""));
  // All primitives of filters are steps.
  for (const char* primitive :
       {"feBlend", "feColorMatrix", "feComponentTransfer", "feComposite",
        "feConvolveMatrix kernelMatrix='0 0 0 0 1 0 0 0 0'", "feDiffuseLighting", "feDisplacementMap", "feDropShadow",
        "feFlood", "feGaussianBlur", "feImage href='#r'", "feMerge", "feMorphology", "feOffset", "feSpecularLighting",
        "feTile", "feTurbulence"}) {
    const Import i = page(std::string("<defs><path id='r' d='M0 0h9v9'/></defs><filter id='f'><") + primitive +
                          "><feMergeNode/><feFuncR/><feFuncG/><feFuncB/><feFuncA/><feDistantLight/><fePointLight/>"
                          "<feSpotLight/></" +
                          std::string(primitive, std::strcspn(primitive, " ")) +
                          "></filter><rect width='9' height='9' filter='url(#f)'/>");
    EXPECT_EQ(i.placed, Texts()) << primitive;
    ASSERT_TRUE(!i.drawing.groups.empty() && i.drawing.groups[0].layer) << primitive;
    EXPECT_EQ(i.drawing.groups[0].layer->steps.size(), 1u) << primitive;
  }
}

TEST(SvgCoverage, TheOutermostElementHasABox) {
  const std::string box = "<rect x='20' y='20' width='60' height='60' fill='#0a0'/>";
  const auto rooted = [&](const std::string& style) { return page(box, " style='" + style + "'"); };
  const Import blue = page("<rect width='100' height='100' fill='#00f'/>" + box);
  for (const char* style :
       {"background:#00f", "background-color:blue", "background:red;background-color:#00f",
        "color:blue;background:"
        "currentColor",
        "background:none no-repeat 0 0 / auto scroll blue", "background-color:light-dark(#00f, #000)",
        "background:light-dark(#00f, var(--dark, #121212))", "color-scheme:light dark;background:#00f"}) {
    EXPECT_EQ(rooted(style).placed, Texts()) << style;
    EXPECT_LE(worst(picture(rooted(style)), picture(blue)), kSame) << style;
  }
  for (const char* rule :
       {":root{background:#00f}", "svg:root{background-color:blue}", "*:ROOT { color:blue; background:currentColor }",
        "svg{background:red} :root{background:#00f}", ":root{background:#00f} svg{background:red}",
        "*{background:#00f}", ":root:root{background:#00f} :root{background:red}"}) {
    const Import styled = page(std::string("<style>") + rule + "</style>" + box);
    EXPECT_EQ(styled.placed, Texts()) << rule;
    EXPECT_LE(worst(picture(styled), picture(blue)), kSame) << rule;
  }
  for (const char* style : {"background:none", "background:transparent", "background-color:initial", "border:0",
                            "background:#00f;background:none", "visibility:visible;padding:0", "background:repeat"}) {
    EXPECT_EQ(rooted(style).placed, Texts()) << style;
    EXPECT_LE(worst(picture(rooted(style)), picture(page(box))), kSame) << style;
  }
  for (const char* style :
       {"background:url(a.png)", "background-image:url(a.png)", "background:linear-gradient(red, blue)"}) {
    ASSERT_EQ(rooted(style).placed.size(), 1u) << style;
    EXPECT_EQ(rooted(style).placed[0],
              "test.svg:1:1: warning: background-image is not supported: <svg> is drawn without it");
  }
  for (const std::string name : {"border", "outline", "box-shadow", "padding", "border-radius"})
    EXPECT_EQ(rooted(name + ":3px").placed,
              Texts{"test.svg:1:1: warning: " + name + " is not supported: <svg> is drawn without it"});
  EXPECT_EQ(rooted("background:foo").placed,
            Texts{"test.svg:1:1: warning: <svg> has background 'foo', which is not valid; ignored"});
  // It fades and is clipped with the element, covers the page whatever the viewBox, and is no attribute.
  const Import faint = import("<svg width='100' height='50' viewBox='5 5 1 1' style='background:#00f;opacity:.5'/>");
  ASSERT_EQ(faint.drawing.paths.size(), 1u);
  EXPECT_EQ(faint.drawing.paths[0].points, (std::vector<float>{0, 0, 100, 0, 100, 50, 0, 50}));
  EXPECT_EQ(faint.drawing.paths[0].color[3], 0.5f);
  EXPECT_TRUE(page("", " background='red'").drawing.paths.empty());
  EXPECT_TRUE(page("", " style='background:red;visibility:hidden'").drawing.paths.empty());
  EXPECT_EQ(import("<svg style='background:red'><rect width='9' height='9'/></svg>").placed,
            Texts{"test.svg:1:1: warning: background is not supported where <svg> has neither a size nor a viewBox: "
                  "<svg> is drawn without it"});
}

} // namespace
