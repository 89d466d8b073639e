// The page docs/guide/svg_support.md, written from what comes of each element, attribute and property: a drawing that
// differs from the one without it, a message that names it, or neither. tests/vector/svg_support.sh writes it anew.
#include "svg_support.h"

#include "host/files.h"

#include <cstdlib>
#include <filesystem>

namespace {
using namespace gpgp;
using namespace gpgp::test::support;

/// Something with a place for one attribute, which is "@".
struct Subject {
  const char* name;
  std::string text;
  std::vector<std::pair<const char*, const char*>> attributes; ///< with values that are not the initial ones
};

const std::vector<std::pair<const char*, const char*>> kRegion = {
    {"x", "1"}, {"y", "2"}, {"width", "50"}, {"height", "40"}};

const std::vector<Subject>& subjects() {
  static const std::vector<Subject> all = {
      {"any",
       "<style>.c{opacity:.5}</style><use href='#a' x='9'/><g @><path d='M0 0h90v90' fill='#0a0'/></g>",
       {{"id", "a"},
        {"class", "c"},
        {"style", "opacity:.5"},
        {"transform", "scale(.5)"},
        {"requiredExtensions", "x"},
        {"requiredFeatures", "x"},
        {"systemLanguage", "xx"},
        {"tabindex", "1"},
        {"onclick", "f()"}}},
      {"svg, inside",
       "<svg @><path d='M0 0h190v190'/></svg>",
       {{"x", "5"},
        {"y", "5"},
        {"viewBox", "0 0 9 4"},
        {"overflow", "visible"},
        {"width", "5"},
        {"height", "5"},
        {"zoomAndPan", "disable"},
        {"version", "1.1"},
        {"baseProfile", "full"}}},
      {"svg with a viewBox",
       "<svg viewBox='0 0 9 4' @><path d='M0 0h90v90'/></svg>",
       {{"preserveAspectRatio", "none"}}},
      {"use",
       "<path id='a' d='M0 0h9v9'/><symbol id='s' viewBox='0 0 4 4'><path d='M0 0h9v9'/></symbol><use xlink:href='#s' "
       "@/>",
       {{"x", "5"}, {"y", "5"}, {"width", "50"}, {"height", "50"}, {"href", "#a"}}},
      {"symbol",
       "<symbol id='s' viewBox='0 0 8 4' @><path d='M0 0h9v9'/></symbol><use href='#s' width='50' height='50'/>",
       {{"x", "5"},
        {"y", "5"},
        {"refX", "2"},
        {"refY", "2"},
        {"overflow", "visible"},
        {"preserveAspectRatio", "none"},
        {"transform", "scale(.5)"}}},
      {"symbol without a size",
       "<symbol id='s' @><path d='M0 0h90v90'/></symbol><use href='#s'/>",
       {{"width", "5"}, {"height", "5"}, {"viewBox", "0 0 9 9"}}},
      {"image",
       "<image " + kImage + "@/>",
       {{"x", "5"},
        {"y", "5"},
        {"width", "50"},
        {"height", "50"},
        {"href", "data:image/png;base64,BBBB"},
        {"crossorigin", "anonymous"}}},
      {"image with a size", "<image width='50' height='50' " + kImage + "@/>", {{"preserveAspectRatio", "none"}}},
      {"path", "<path fill='#0a0' stroke='#00a' stroke-dasharray='1' @/>", {{"d", "M0 0h9v9"}}},
      {"path with data",
       "<path fill='#0a0' stroke='#00a' stroke-dasharray='1' d='M0 0h90' @/>",
       {{"pathLength", "10"}}},
      {"rect",
       "<rect " + kFill + "width='50' height='40' @/>",
       {{"x", "5"}, {"y", "5"}, {"rx", "5"}, {"ry", "5"}, {"pathLength", "10"}}},
      {"rect without a width", "<rect height='9' @/>", {{"width", "9"}}},
      {"rect without a height", "<rect width='9' @/>", {{"height", "9"}}},
      {"circle without a radius", "<circle @/>", {{"r", "9"}}},
      {"circle", "<circle " + kFill + "r='40' @/>", {{"cx", "5"}, {"cy", "5"}, {"pathLength", "10"}}},
      {"ellipse", "<ellipse " + kFill + "rx='40' ry='20' @/>", {{"cx", "5"}, {"cy", "5"}, {"pathLength", "10"}}},
      {"ellipse without radii", "<ellipse @/>", {{"rx", "9"}, {"ry", "9"}}},
      {"line", "<line x2='50' " + kFill + "@/>", {{"x1", "5"}, {"y1", "5"}, {"y2", "5"}, {"pathLength", "10"}}},
      {"line without an end", "<line y2='9' stroke='red' @/>", {{"x2", "9"}}},
      {"polyline", "<polyline " + kFill + "@/>", {{"points", "0 0 5 0 5 5"}}},
      {"polyline with points", "<polyline " + kFill + "points='0 0 90 0 90 9' @/>", {{"pathLength", "10"}}},
      {"polygon with points", "<polygon " + kFill + "points='0 0 90 0 90 9' @/>", {{"pathLength", "10"}}},
      {"polygon", "<polygon " + kFill + "@/>", {{"points", "0 0 5 0 5 5"}}},
      {"linearGradient",
       painted("<radialGradient id='q'><stop stop-color='lime'/></radialGradient><linearGradient id='p' @>" + kStops +
               "</linearGradient>"),
       {{"x1", ".2"},
        {"y1", ".2"},
        {"x2", ".5"},
        {"y2", ".5"},
        {"gradientUnits", "userSpaceOnUse"},
        {"gradientTransform", "rotate(30)"},
        {"spreadMethod", "repeat"}}},
      {"linearGradient without stops",
       painted("<radialGradient id='q'>" + kStops + "</radialGradient><linearGradient id='p' @/>"),
       {{"href", "#q"}}},
      {"radialGradient",
       painted("<radialGradient id='p' @>" + kStops + "</radialGradient>"),
       {{"cx", ".2"},
        {"cy", ".2"},
        {"r", ".2"},
        {"fx", ".2"},
        {"fy", ".2"},
        {"fr", ".2"},
        {"gradientUnits", "userSpaceOnUse"},
        {"gradientTransform", "rotate(30)"},
        {"spreadMethod", "repeat"}}},
      {"stop",
       painted("<linearGradient id='p'><stop stop-color='red'/><stop stop-color='blue' @/></linearGradient>"),
       {{"offset", ".5"}}},
      {"pattern",
       painted("<pattern id='p' width='.2' height='.2' @><path d='M0 0h5v5'/></pattern>"),
       {{"x", ".1"},
        {"y", ".1"},
        {"patternContentUnits", "objectBoundingBox"},
        {"patternTransform", "rotate(30)"},
        {"viewBox", "0 0 9 4"},
        {"overflow", "visible"}}},
      {"pattern without a width",
       painted("<pattern id='p' height='.2' @><path d='M0 0h5v5'/></pattern>"),
       {{"width", ".2"}}},
      {"pattern without a height",
       painted("<pattern id='p' width='.2' @><path d='M0 0h5v5'/></pattern>"),
       {{"height", ".2"}}},
      {"pattern with a viewBox",
       painted("<pattern id='p' width='.2' height='.2' viewBox='0 0 9 4' @><path d='M0 0h5v5'/></pattern>"),
       {{"preserveAspectRatio", "none"}}},
      {"pattern with large tiles",
       painted("<pattern id='p' width='5' height='5' @><path d='M0 0h5v5'/></pattern>"),
       {{"patternUnits", "userSpaceOnUse"}}},
      {"pattern without content",
       painted("<pattern id='q' width='.1' height='.1'><path d='M0 0h5v5'/></pattern><pattern id='p' @/>"),
       {{"href", "#q"}}},
      {"clipPath",
       "<clipPath id='c' @><rect x='.1' y='.1' width='30' height='30'/></clipPath>" + kBlock + "clip-path='url(#c)'/>",
       {{"clipPathUnits", "objectBoundingBox"}, {"transform", "scale(2)"}}},
      {"mask",
       "<mask id='m' @><rect width='50' height='50' fill='#fff'/></mask>" + kBlock + "mask='url(#m)'/>",
       {{"x", ".1"},
        {"y", ".1"},
        {"width", ".5"},
        {"height", ".5"},
        {"maskUnits", "userSpaceOnUse"},
        {"maskContentUnits", "objectBoundingBox"},
        {"mask-type", "alpha"}}},
      {"marker",
       marked("markerWidth='10' markerHeight='10' @>"),
       {{"refX", "2"},
        {"refY", "2"},
        {"markerUnits", "userSpaceOnUse"},
        {"orient", "auto"},
        {"viewBox", "0 0 5 5"},
        {"overflow", "visible"}}},
      {"marker with a viewBox",
       marked("viewBox='0 0 9 4' @>"),
       {{"markerWidth", "5"}, {"markerHeight", "5"}, {"preserveAspectRatio", "none"}}},
      {"style",
       "<style @>*{opacity:.5}</style>" + kBlock + "/>",
       {{"media", "print"}, {"type", "text/other"}, {"title", "a"}}},
      {"tref",
       "<text id='a' y='20'>a</text><text id='b' y='20'>bcd</text><text y='50'><tref xlink:href='#a' @/></text>",
       {{"href", "#b"}}},
      {"text",
       "<text y='50' @>abc</text>",
       {{"x", "5 20"}, {"dx", "5 9"}, {"dy", "5 9"}, {"rotate", "5 9"}, {"textLength", "90"}, {"xml:lang", "de"}}},
      {"text with a length", "<text y='50' textLength='90' @>abc</text>", {{"lengthAdjust", "spacingAndGlyphs"}}},
      {"text without a place", "<text @>abc</text>", {{"y", "40"}}},
      {"text with spaces", "<text y='50' @> a  b</text>", {{"xml:space", "preserve"}}},
      {"tspan",
       "<text y='50'>a<tspan @>bc</tspan></text>",
       {{"x", "5 20"},
        {"y", "5 20"},
        {"dx", "5 9"},
        {"dy", "5 9"},
        {"rotate", "5 9"},
        {"textLength", "90"},
        {"xml:lang", "de"}}},
      {"textPath",
       alongPath("<textPath xlink:href='#t' @>abc</textPath>"),
       {{"href", "#u"},
        {"startOffset", "20%"},
        {"textLength", "60"},
        {"side", "right"},
        {"method", "stretch"},
        {"spacing", "auto"},
        {"path", "M0 0H90"}}},
      {"filter",
       "<filter id='f' @><feFlood x='.1' y='.1' width='.4' height='.4'/></filter>" + kBlock + "filter='url(#f)'/>",
       {{"x", ".1"},
        {"y", ".1"},
        {"width", ".5"},
        {"height", ".5"},
        {"filterUnits", "userSpaceOnUse"},
        {"primitiveUnits", "objectBoundingBox"},
        {"filterRes", "10"}}},
      {"all primitives", filtered("<feFlood @/><feOffset dx='3'/>"), kRegion},
      {"all primitives with an input", filtered("<feOffset dx='3' @/>"), {{"in", "SourceAlpha"}}},
      {"all primitives with one behind",
       filtered("<feFlood flood-color='red' @/><feOffset in='SourceGraphic' dx='3' result='o'/><feComposite in='r' "
                "in2='o'/>"),
       {{"result", "r"}}},
      {"feBlend", filtered("<feFlood result='a' flood-color='red'/><feBlend in2='a' @/>"), {{"mode", "screen"}}},
      {"feBlend without a second input",
       filtered("<feFlood result='a'/><feBlend in='SourceGraphic' @/>"),
       {{"in2", "SourceAlpha"}}},
      {"feColorMatrix", filtered("<feColorMatrix type='saturate' @/>"), {{"values", ".5"}}},
      {"feColorMatrix without a type", filtered("<feColorMatrix @/>"), {{"type", "luminanceToAlpha"}}},
      {"feComposite",
       filtered("<feFlood result='a'/><feComposite in='SourceGraphic' in2='a' @/>"),
       {{"operator", "in"}}},
      {"feComposite without a second input",
       filtered("<feFlood result='a'/><feComposite in='SourceGraphic' @/>"),
       {{"in2", "SourceAlpha"}}},
      {"feComposite, arithmetic",
       filtered("<feFlood result='a'/><feComposite in='SourceGraphic' in2='a' operator='arithmetic' @/>"),
       {{"k1", ".5"}, {"k2", ".5"}, {"k3", ".5"}, {"k4", ".5"}}},
      {"feComponentTransfer's functions",
       filtered("<feComponentTransfer><feFuncR type='linear' @/></feComponentTransfer>"),
       {{"slope", ".5"}, {"intercept", ".5"}}},
      {"these, typed",
       filtered("<feComponentTransfer><feFuncR slope='2' @/></feComponentTransfer>"),
       {{"type", "linear"}}},
      {"these, gamma",
       filtered("<feComponentTransfer><feFuncR type='gamma' @/></feComponentTransfer>"),
       {{"amplitude", ".5"}, {"exponent", ".5"}, {"offset", ".5"}}},
      {"these, table",
       filtered("<feComponentTransfer><feFuncR type='table' @/></feComponentTransfer>"),
       {{"tableValues", "0 1 0"}}},
      {"feConvolveMatrix",
       filtered("<feConvolveMatrix kernelMatrix='0 1 0 1 2 1 0 1 0' @/>"),
       {{"divisor", "3"},
        {"bias", ".5"},
        {"targetX", "0"},
        {"targetY", "0"},
        {"edgeMode", "wrap"},
        {"preserveAlpha", "true"},
        {"kernelUnitLength", "2"}}},
      {"feConvolveMatrix without a kernel", filtered("<feConvolveMatrix @/>"), {{"kernelMatrix", "0 1 0 1 2 1 0 1 0"}}},
      {"feConvolveMatrix without an order", filtered("<feConvolveMatrix kernelMatrix='0 1 0 1' @/>"), {{"order", "2"}}},
      {"feDiffuseLighting",
       filtered("<feDiffuseLighting @><feDistantLight elevation='40'/></feDiffuseLighting>"),
       {{"surfaceScale", "3"}, {"diffuseConstant", "3"}, {"kernelUnitLength", "2"}}},
      {"feSpecularLighting",
       filtered("<feSpecularLighting @><feDistantLight elevation='40'/></feSpecularLighting>"),
       {{"surfaceScale", "3"}, {"specularConstant", "3"}, {"specularExponent", "3"}, {"kernelUnitLength", "2"}}},
      {"feDistantLight", lit("feDistantLight"), {{"azimuth", "30"}, {"elevation", "30"}}},
      {"fePointLight", lit("fePointLight"), {{"x", "30"}, {"y", "30"}, {"z", "30"}}},
      {"feSpotLight",
       lit("feSpotLight"),
       {{"x", "30"},
        {"y", "30"},
        {"z", "30"},
        {"pointsAtX", "30"},
        {"pointsAtY", "30"},
        {"pointsAtZ", "30"},
        {"specularExponent", "30"},
        {"limitingConeAngle", "30"}}},
      {"feDisplacementMap",
       filtered("<feDisplacementMap in2='SourceAlpha' scale='5' @/>"),
       {{"xChannelSelector", "R"}, {"yChannelSelector", "G"}}},
      {"feDisplacementMap without a map",
       filtered("<feFlood result='a'/><feDisplacementMap scale='5' in='SourceGraphic' @/>"),
       {{"in2", "SourceAlpha"}}},
      {"feDisplacementMap without a scale", filtered("<feDisplacementMap in2='SourceAlpha' @/>"), {{"scale", "5"}}},
      {"feDropShadow", filtered("<feDropShadow @/>"), {{"dx", "5"}, {"dy", "5"}, {"stdDeviation", "5"}}},
      {"feGaussianBlur", filtered("<feGaussianBlur @/>"), {{"stdDeviation", "5"}, {"edgeMode", "wrap"}}},
      {"feImage",
       filtered("<feImage xlink:href='#e' @/>"),
       {{"href", "data:image/png;base64,BBBB"}, {"crossorigin", "anonymous"}}},
      {"feImage of a file", filtered("<feImage " + kImage + "@/>"), {{"preserveAspectRatio", "none"}}},
      {"feMorphology", filtered("<feMorphology radius='2' @/>"), {{"operator", "dilate"}}},
      {"feMorphology without a radius", filtered("<feMorphology @/>"), {{"radius", "2"}}},
      {"feOffset", filtered("<feOffset @/>"), {{"dx", "5"}, {"dy", "5"}}},
      {"feMergeNode", filtered("<feFlood/><feMerge><feMergeNode @/></feMerge>"), {{"in", "SourceAlpha"}}},
      {"feTurbulence without a frequency", filtered("<feTurbulence @/>"), {{"baseFrequency", ".1"}}},
      {"feTurbulence",
       filtered("<feTurbulence baseFrequency='.1' @/>"),
       {{"numOctaves", "3"}, {"seed", "3"}, {"type", "fractalNoise"}, {"stitchTiles", "stitch"}}},
  };
  return all;
}

std::string attributes() {
  std::string out = "| of | drawn | named | without effect |\n|---|---|---|---|\n";
  std::vector<std::pair<std::string, Row>> rows;
  for (const Subject& subject : subjects()) {
    std::string name = subject.name; // what follows its element says how it was looked at
    if (const size_t end = name.find(" with"); end != name.npos) name.resize(end);
    if (const size_t end = name.find(" of a file"); end != name.npos) name.resize(end);
    if (const size_t end = name.find(", "); end != name.npos) name.resize(end);
    if (name == "these") name = "feComponentTransfer's functions";
    if (rows.empty() || rows.back().first != name) rows.push_back({name, {}});
    const Drawn without = drawn(replaced(subject.text, ""));
    for (const auto& [attribute, value] : subject.attributes) {
      const std::string written = std::string(attribute) + "='" + value + "'";
      const Drawn with = drawn(replaced(subject.text, written));
      SCOPED_TRACE(std::string(subject.name) + " " + written);
      rows.back().second.of[static_cast<size_t>(outcomeOf(attribute, with, without))].insert(attribute);
    }
  }
  for (const auto& [name, row] : rows) {
    const bool isWord = name.find(' ') != name.npos || name == "any";
    out += "| " + (isWord ? name : "`" + name + "`") + " | " + row.cells();
  }
  return out;
}

std::string elements() {
  const std::string text = "<text y='50'>a@</text>";
  const struct {
    const char* name;
    std::string with;
  } all[] = {
      {"a", "<a>@</a>"},
      {"altGlyph", "<text><altGlyph>a</altGlyph></text>"},
      {"animate", "<animate/>"},
      {"animateMotion", "<animateMotion/>"},
      {"animateTransform", "<animateTransform/>"},
      {"audio", "<audio/>"},
      {"canvas", "<canvas/>"},
      {"circle", "<circle r='9'/>"},
      {"clipPath", "<clipPath id='c'/>" + kBlock + "clip-path='url(#c)'/>"},
      {"defs", "<defs>@</defs>"},
      {"desc", "<desc>a</desc>"},
      {"ellipse", "<ellipse rx='9' ry='5'/>"},
      {"filter", filtered("<feFlood/>")},
      {"font", "<font/>"},
      {"foreignObject", "<foreignObject width='9' height='9'/>"},
      {"g", "<g>@</g>"},
      {"hatch", painted("<hatch id='p'/>")},
      {"iframe", "<iframe/>"},
      {"image", "<image " + kImage + "/>"},
      {"line", "<line x2='9' stroke='red'/>"},
      {"linearGradient", painted("<linearGradient id='p'>" + kStops + "</linearGradient>")},
      {"marker", marked(">")},
      {"mask", "<mask id='m'><path d='M0 0h9v9' fill='red'/></mask>" + kBlock + "mask='url(#m)'/>"},
      {"mesh", "<mesh/>"},
      {"metadata", "<metadata/>"},
      {"path", "<path d='M0 0h9v9'/>"},
      {"pattern", painted("<pattern id='p' width='1' height='1'><path d='M0 0h9v9'/></pattern>")},
      {"polygon", "<polygon points='0 0 9 0 9 9'/>"},
      {"polyline", "<polyline points='0 0 9 0 9 9'/>"},
      {"radialGradient", painted("<radialGradient id='p'>" + kStops + "</radialGradient>")},
      {"rect", kBlock + "/>"},
      {"script", "<script/>"},
      {"set", "<set/>"},
      {"style", "<style>*{opacity:.5}</style>" + kBlock + "/>"},
      {"svg", "<svg><path d='M0 0h9v9'/></svg>"},
      {"switch", "<switch>@</switch>"},
      {"symbol", "<symbol id='s'><path d='M0 0h9v9'/></symbol><use href='#s'/>"},
      {"text", text},
      {"title", "<title/>"},
      {"textPath", alongPath("<textPath href='#t'>a</textPath>")},
      {"tref", "<text id='t' y='20'>a</text><text y='50'><tref href='#t'/></text>"},
      {"tspan", "<text y='50'><tspan>a</tspan></text>"},
      {"use", "<path id='s' d='M0 0h9v9'/><use href='#s'/>"},
      {"video", "<video/>"},
      {"view", "<view/>"},
  };
  Row row;
  for (const auto& e : all) {
    std::string inside = e.with;
    if (inside.find('@') != inside.npos) inside = replaced(inside, inside == text ? "" : "<path d='M0 0h9v9'/>");
    row.of[static_cast<size_t>(outcomeOf(std::string("<") + e.name, drawn(inside), drawn("")))].insert(e.name);
  }
  for (const char* primitive :
       {"feBlend", "feColorMatrix type='saturate' values='0'", "feComponentTransfer", "feComposite",
        "feConvolveMatrix kernelMatrix='0 0 0 0 1 0 0 0 0'", "feDiffuseLighting", "feDisplacementMap", "feDropShadow",
        "feFlood", "feGaussianBlur stdDeviation='2'", "feImage href='#e'", "feMerge", "feMorphology radius='2'",
        "feOffset", "feSpecularLighting", "feTile", "feTurbulence"}) {
    const std::string name(primitive, std::strcspn(primitive, " "));
    const std::string inside = "<feMergeNode/><feDistantLight/>";
    row.of[static_cast<size_t>(
               outcomeOf("<" + name, drawn(filtered(std::string("<") + primitive + ">" + inside + "</" + name + ">")),
                         drawn(filtered(""))))]
        .insert(name);
  }
  return wrapped("- Drawn, or counted where others refer to them: " + listed(row.of[0]) + ".") +
         wrapped("- Named: " + listed(row.of[1]) + ".") +
         wrapped("- Show nothing by themselves: " + listed(row.of[2]) + ".");
}

TEST(SvgSupport, ThePageSaysWhatIsDrawn) {
  const std::string page =
      "# SVG: each element, attribute and property\n\n<!-- Written by tests/vector/svg_support.sh. Do not edit. -->\n"
      "What is drawn, what is named in a message, and what has no effect on a still picture, as the test "
      "`svg_support_test`\n"
      "finds it. It gives each one a value that is not its initial one, and looks whether the drawing changes. How "
      "they\n"
      "are drawn is in [SVG support](svg.md).\n\n## Elements\n\n" +
      elements() + "\n## Attributes\n\n" + attributes() + "\n## Properties\n\n" + properties();
  const std::filesystem::path file = std::filesystem::path(GPGP_TEST_DATA) / "../../docs/guide/svg_support.md";
  if (std::getenv("GPGP_WRITE_SVG_SUPPORT")) host::writeFile(file, page);
  const std::vector<uint8_t> bytes = host::readFile(file);
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), page)
      << "docs/guide/svg_support.md is out of date: run tests/vector/svg_support.sh and read what changed";
  EXPECT_LE(page.size(), 12'288u);
}

} // namespace
