// One property at a time (SVG 2, chapters 6, 11 and 13).
#include "vector/import/svg/property.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector::svg {
namespace {

using Context = PropertyContext;

/// A list of lengths, an odd one doubled; "none" and all zero mean no dashes.
bool parseDashes(std::string_view text, const LengthContext& lengths, std::vector<double>& dashes) {
  std::vector<double> read;
  if (!isWord(text, "none")) {
    while (!(text = trim(text)).empty()) {
      const size_t end = std::min(text.find_first_of(", \t\r\n\f"), text.size());
      double v = 0;
      if (!parseLength(text.substr(0, end), lengths, LengthAxis::Diagonal, v) || v < 0 || read.size() >= 1024)
        return false;
      read.push_back(v);
      text = trim(text.substr(end));
      if (!text.empty() && text[0] == ',') text.remove_prefix(1);
    }
  }
  double sum = 0;
  for (const double v : read) sum += v;
  if (!(sum > 0) || !std::isfinite(sum)) read.clear();
  const size_t n = read.size();
  if (n % 2)
    for (size_t i = 0; i < n; ++i) read.push_back(double{read[i]});
  dashes = std::move(read);
  return true;
}

bool isCurrentColor(std::string_view text) { return isWord(text, "currentcolor"); }

bool parsePaint(std::string_view text, Paint& paint) {
  Paint p;
  const auto isUrl = [](std::string_view value) { return isWord(value.substr(0, 4), "url("); };
  if (isUrl(text)) {
    const size_t end = std::min(text.find(')'), text.size()); // the end of the value closes what is open
    std::string_view target = trim(text.substr(4, end - 4));
    if (target.size() >= 2 && (target[0] == '"' || target[0] == '\'')) target = target.substr(1, target.size() - 2);
    p.kind = Paint::Kind::Reference;
    p.reference = target;
    text = trim(text.substr(std::min(end + 1, text.size())));
    if (!text.empty()) {
      Paint rest;
      if (isUrl(text) || !parsePaint(text, rest) || rest.kind == Paint::Kind::ContextFill ||
          rest.kind == Paint::Kind::ContextStroke)
        return false;
      p.hasFallback = true;
      p.fallback = rest.kind;
      p.color = rest.color;
    }
  } else if (isWord(text, "none")) {
    p.kind = Paint::Kind::None;
  } else if (isWord(text, "context-fill") || isWord(text, "context-stroke")) {
    p.kind = isWord(text, "context-fill") ? Paint::Kind::ContextFill : Paint::Kind::ContextStroke;
  } else if (isCurrentColor(text)) {
    p.kind = Paint::Kind::Current;
  } else {
    // An ICC colour after the sRGB one is for printers.
    if (const size_t icc = text.find("icc-color("); icc != text.npos && icc > 0) text = text.substr(0, icc);
    if (!parseColor(text, p.color)) return false;
    p.kind = Paint::Kind::Solid;
  }
  paint = std::move(p);
  return true;
}

bool parseOpacity(std::string_view text, double& value) {
  Scanner s(text);
  double v = 0;
  if (isMath(text)) return evaluate(text, {1, 1}, LengthAxis::X, v) && (value = std::clamp(v, 0.0, 1.0), true);
  if (!s.number(v)) return false;
  if (s.take("%")) v /= 100;
  if (!s.done()) return false;
  value = std::clamp(v, 0.0, 1.0);
  return true;
}

constexpr Word<GpgpFillRule> kRules[] = {{"nonzero", GPGP_FILL_NON_ZERO}, {"evenodd", GPGP_FILL_EVEN_ODD}};
constexpr Word<Cap> kCaps[] = {{"butt", Cap::Butt}, {"round", Cap::Round}, {"square", Cap::Square}};
constexpr Word<Join> kJoins[] = {{"miter", Join::Miter},
                                 {"round", Join::Round},
                                 {"bevel", Join::Bevel},
                                 {"miter-clip", Join::MiterClip},
                                 {"arcs", Join::Arcs}};
constexpr Word<bool> kInterpolations[] = {{"auto", false}, {"srgb", false}, {"linearrgb", true}};
constexpr Word<bool> kOverflows[] = {
    {"visible", true}, {"auto", true}, {"hidden", false}, {"scroll", false}, {"clip", false}};
constexpr Word<bool> kVisibilities[] = {{"visible", true}, {"hidden", false}, {"collapse", false}};

bool setStrokeWidth(const Context& c) {
  double v = 0;
  if (!parseLength(c.value, c.lengths, LengthAxis::Diagonal, v)) return false;
  c.style.strokeWidth = std::max(v, 0.0); // an error of SVG 1.1, for which librsvg and resvg draw none
  return true;
}
bool setMiterLimit(const Context& c) {
  double v = 0;
  Scanner s(c.value);
  const bool isNumber = isMath(c.value) ? evaluate(c.value, {}, LengthAxis::X, v) : s.number(v) && s.done();
  return isNumber && v >= 0 && (c.style.miterLimit = std::max(v, 1.0), true); // below 1 no miter is within it
}
bool setColor(const Context& c) {
  if (isCurrentColor(c.value)) return c.style.color = c.parent.color, true;
  return parseColor(c.value, c.style.color);
}
bool setColorOr(const Context& c, Style::StopColor& color) {
  const bool isCurrent = isCurrentColor(c.value);
  return (isCurrent || parseColor(c.value, color.color)) && (color.isCurrent = isCurrent, true);
}
/// normal, or some of fill, stroke and markers, each once; what is left out comes last, in this order.
bool setPaintOrder(const Context& c) {
  constexpr std::string_view parts[] = {"fill", "stroke", "markers"};
  const std::string lower = lowered(c.value);
  std::vector<std::string_view> order;
  for (std::string_view rest = lower; !(rest = trim(rest)).empty();) {
    const std::string_view part = rest.substr(0, rest.find_first_of(" \t\r\n\f"));
    rest.remove_prefix(part.size());
    const bool isNormal = part == "normal" && order.empty() && trim(rest).empty();
    if (!isNormal && (!oneOf(part, parts) || std::find(order.begin(), order.end(), part) != order.end())) return false;
    if (!isNormal) order.push_back(part);
  }
  if (lower.empty()) return false;
  for (const std::string_view part : parts)
    if (std::find(order.begin(), order.end(), part) == order.end()) order.push_back(part);
  for (size_t i = 0; i < order.size(); ++i)
    c.style.paintOrder[i] = static_cast<Style::Part>(std::find(parts, std::end(parts), order[i]) - parts);
  return true;
}
/// Words of CSS Display and those of CSS 2 for text and tables.
bool setDisplay(const Context& c) {
  constexpr std::string_view words[] = {"none",
                                        "inline",
                                        "block",
                                        "contents",
                                        "flow",
                                        "flow-root",
                                        "inline-block",
                                        "list-item",
                                        "table",
                                        "inline-table",
                                        "table-row-group",
                                        "table-header-group",
                                        "table-footer-group",
                                        "table-row",
                                        "table-cell",
                                        "table-column-group",
                                        "table-column",
                                        "table-caption",
                                        "flex",
                                        "inline-flex",
                                        "grid",
                                        "inline-grid",
                                        "ruby",
                                        "run-in",
                                        "compact",
                                        "marker"};
  const std::string lower = lowered(c.value);
  for (std::string_view rest = lower; !(rest = trim(rest)).empty();) { // one, or two such as "inline flow"
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r\n\f"));
    if (!oneOf(word, words)) return false;
    rest.remove_prefix(word.size());
  }
  return !lower.empty() && (c.style.displayed = lower != "none", true);
}
/// Of the two of overflow-x and overflow-y the first counts.
bool setOverflow(const Context& c) {
  return choose(c.value.substr(0, c.value.find_first_of(" \t\r\n\f")), kOverflows, c.style.overflowVisible);
}
bool setVectorEffect(const Context& c) {
  constexpr std::string_view others[] = {"non-scaling-size", "non-rotation", "fixed-position", "viewport", "screen"};
  bool scales = true, unknown = false;
  const std::string lower = lowered(c.value);
  if (lower == "none") return c.style.nonScalingStroke = c.style.unsupportedEffect = false, true;
  for (std::string_view rest = lower; !(rest = trim(rest)).empty();) {
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r\n\f"));
    rest.remove_prefix(word.size());
    if (word == "non-scaling-stroke")
      scales = false;
    else if (oneOf(word, others))
      unknown = true;
    else
      return false;
  }
  if (lower.empty()) return false;
  c.style.nonScalingStroke = !scales;
  c.style.unsupportedEffect = unknown;
  return true;
}
/// The shorthand (CSS Backgrounds 3, 2.10): its colour, and whether it has an image.
bool setBackground(const Context& c) {
  constexpr std::string_view words[] = {"none",  "repeat", "no-repeat", "repeat-x",   "repeat-y",    "space",
                                        "round", "scroll", "fixed",     "local",      "left",        "right",
                                        "top",   "bottom", "center",    "border-box", "padding-box", "content-box",
                                        "text",  "auto",   "cover",     "contain",    "/",           ","};
  Style::Background background;
  Style::StopColor& color = background.color;
  for (std::string_view rest = c.value; !(rest = trim(rest)).empty();) {
    size_t end = 0;
    for (int depth = 0; end < rest.size(); ++end) { // a word with its brackets
      depth += (rest[end] == '(') - (rest[end] == ')');
      if (depth == 0 && std::string_view(" \t\r\n\f/,").find(rest[end]) != std::string_view::npos) break;
    }
    const std::string_view part = rest.substr(0, std::max<size_t>(end, 1));
    rest.remove_prefix(part.size());
    const std::string lower = lowered(part);
    double length = 0;
    if (isCurrentColor(part))
      color.isCurrent = true;
    else if (lower.starts_with("url(") || lower.find("gradient(") != lower.npos || lower.find("image") != lower.npos)
      background.hasImage = true;
    else if (!oneOf(lower, words) && !parseLength(part, c.lengths, LengthAxis::X, length) &&
             !parseColor(part, color.color))
      return false;
  }
  return !c.value.empty() && (c.style.background = background, true);
}
bool setMarker(const Context& c, std::string& marker) {
  const bool isNone = isWord(c.value, "none");
  if (!isNone && !isWord(c.value.substr(0, 4), "url(")) return false;
  return marker = isNone ? std::string_view() : c.value, true;
}
bool setMarkers(const Context& c) {
  std::string all;
  return setMarker(c, all) && (c.style.markers.fill(all), true);
}
bool setReference(const Context& c, std::string& reference) {
  return reference = isWord(c.value, "none") ? std::string_view() : c.value, true;
}
constexpr Word<bool> kTransformBoxes[] = {{"view-box", false}, {"fill-box", true}, {"content-box", true}};
constexpr Word<bool> kIsolations[] = {{"auto", false}, {"isolate", true}};
constexpr Word<bool> kMaskTypes[] = {{"luminance", false}, {"alpha", true}};
constexpr Word<bool> kFilterInterpolations[] = {{"auto", true}, {"srgb", false}, {"linearrgb", true}};

const Property kProperties[] = {
    GPGP_PROPERTY("fill", fill, parsePaint(c.value, c.style.fill)),
    GPGP_PROPERTY("stroke", stroke, parsePaint(c.value, c.style.stroke)),
    GPGP_PROPERTY("fill-rule", fillRule, choose(c.value, kRules, c.style.fillRule)),
    GPGP_PROPERTY("fill-opacity", fillOpacity, parseOpacity(c.value, c.style.fillOpacity)),
    GPGP_PROPERTY("stroke-opacity", strokeOpacity, parseOpacity(c.value, c.style.strokeOpacity)),
    GPGP_PROPERTY("opacity", opacity, parseOpacity(c.value, c.style.opacity)),
    GPGP_PROPERTY("stroke-width", strokeWidth, setStrokeWidth(c)),
    GPGP_PROPERTY("stroke-linecap", cap, choose(c.value, kCaps, c.style.cap)),
    GPGP_PROPERTY("stroke-linejoin", join, choose(c.value, kJoins, c.style.join)),
    GPGP_PROPERTY("stroke-miterlimit", miterLimit, setMiterLimit(c)),
    GPGP_PROPERTY("stroke-dasharray", dashes, parseDashes(c.value, c.lengths, c.style.dashes)),
    GPGP_PROPERTY("stroke-dashoffset", dashOffset,
                  parseLength(c.value, c.lengths, LengthAxis::Diagonal, c.style.dashOffset)),
    GPGP_PROPERTY("color", color, setColor(c)),
    GPGP_PROPERTY("visibility", visible, choose(c.value, kVisibilities, c.style.visible)),
    GPGP_PROPERTY("color-interpolation", mixesLinear, choose(c.value, kInterpolations, c.style.mixesLinear)),
    GPGP_PROPERTY("display", displayed, setDisplay(c)),
    GPGP_PROPERTY("overflow", overflowVisible, setOverflow(c)),
    GPGP_PROPERTY("paint-order", paintOrder, setPaintOrder(c)),
    GPGP_PROPERTY("vector-effect", nonScalingStroke, setVectorEffect(c)),
    GPGP_PROPERTY("background", background, setBackground(c)),
    GPGP_PROPERTY("background-color", background.color, setColorOr(c, c.style.background.color)),
    GPGP_PROPERTY("stop-color", stopColor, setColorOr(c, c.style.stopColor)),
    GPGP_PROPERTY("stop-opacity", stopOpacity, parseOpacity(c.value, c.style.stopOpacity)),
    GPGP_PROPERTY("clip-path", clipPath, setReference(c, c.style.clipPath)),
    GPGP_PROPERTY("clip-rule", clipRule, choose(c.value, kRules, c.style.clipRule)),
    GPGP_PROPERTY("transform", transform, (c.style.transform = c.value, true)),
    GPGP_PROPERTY("transform-origin", transformOrigin, (c.style.transformOrigin = c.value, true)),
    GPGP_PROPERTY("translate", translate, setReference(c, c.style.translate)),
    GPGP_PROPERTY("rotate", rotate, setReference(c, c.style.rotate)),
    GPGP_PROPERTY("scale", scale, setReference(c, c.style.scale)),
    GPGP_PROPERTY("transform-box", byOwnBox, choose(c.value, kTransformBoxes, c.style.byOwnBox)),
    GPGP_PROPERTY("mask", mask, setReference(c, c.style.mask)),
    GPGP_PROPERTY("mask-type", masksByAlpha, choose(c.value, kMaskTypes, c.style.masksByAlpha)),
    GPGP_PROPERTY("filter", filter, parseFilter(c.value, c.lengths, c.style.filter)),
    GPGP_PROPERTY("flood-color", floodColor, setColorOr(c, c.style.floodColor)),
    GPGP_PROPERTY("flood-opacity", floodOpacity, parseOpacity(c.value, c.style.floodOpacity)),
    GPGP_PROPERTY("lighting-color", lightingColor, setColorOr(c, c.style.lightingColor)),
    GPGP_PROPERTY("color-interpolation-filters", filtersLinear,
                  choose(c.value, kFilterInterpolations, c.style.filtersLinear)),
    GPGP_PROPERTY("mix-blend-mode", blend, parseBlendMode(c.value, c.style.blend)),
    GPGP_PROPERTY("isolation", isolated, choose(c.value, kIsolations, c.style.isolated)),
    GPGP_PROPERTY("marker", markers, setMarkers(c)),
    GPGP_PROPERTY("marker-start", markers[0], setMarker(c, c.style.markers[0])),
    GPGP_PROPERTY("marker-mid", markers[1], setMarker(c, c.style.markers[1])),
    GPGP_PROPERTY("marker-end", markers[2], setMarker(c, c.style.markers[2])),
};

const Property* findProperty(std::string_view name) {
  for (const std::span<const Property> table : {std::span<const Property>(kProperties), textProperties()})
    for (const Property& p : table)
      if (p.name == name) return &p;
  return nullptr;
}

} // namespace

Style Style::inherited() const {
  Style s = *this;
  const Style fresh;
  s.opacity = fresh.opacity;
  s.displayed = fresh.displayed;
  s.nonScalingStroke = fresh.nonScalingStroke;
  s.overflowVisible = fresh.overflowVisible;
  s.background = fresh.background;
  s.unsupportedEffect = false;
  s.text.baselineShift.clear(), s.text.alignmentBaseline.clear(), s.text.decoration.clear();
  s.text.bidi = fresh.text.bidi;
  for (size_t i = 0; i < TextStyle::kUndrawn; ++i)
    if (!textPropertiesUndrawn()[i].isInherited) s.text.undrawn[i] = false;
  s.stopColor = fresh.stopColor;
  s.stopOpacity = fresh.stopOpacity;
  s.clipPath.clear();
  s.mask.clear();
  s.filter.clear();
  s.blend = fresh.blend;
  s.isolated = s.masksByAlpha = false;
  s.floodColor = fresh.floodColor;
  s.floodOpacity = fresh.floodOpacity;
  s.lightingColor = fresh.lightingColor;
  s.transform.clear();
  s.transformOrigin.clear();
  s.translate.clear(), s.rotate.clear(), s.scale.clear();
  s.byOwnBox = false;
  s.geometry.clear();
  return s;
}

const std::string* Style::geometryOf(std::string_view name) const {
  const auto found =
      std::find_if(geometry.rbegin(), geometry.rend(), [name](const auto& set) { return set.first == name; });
  return found == geometry.rend() ? nullptr : &found->second;
}

bool isGeometry(std::string_view name) {
  constexpr std::string_view names[] = {"x", "y", "cx", "cy", "r", "rx", "ry", "width", "height", "d"};
  return oneOf(name, names);
}

bool isPresentationAttribute(std::string_view name) {
  constexpr std::string_view unsupported[] = {"shape-rendering", "image-rendering", "clip"},
                             no[] = {"font",
                                     "background",
                                     "background-color",
                                     "mix-blend-mode",
                                     "isolation",
                                     "translate",
                                     "rotate",
                                     "scale",
                                     "transform-box",
                                     "marker",
                                     "font-kerning",
                                     "white-space",
                                     "white-space-collapse"};
  constexpr std::string_view undrawn[] = {"font-size-adjust", "glyph-orientation-vertical"}; // others are of CSS alone
  for (const UndrawnProperty& p : textPropertiesUndrawn())
    if (p.name == name) return oneOf(name, undrawn);
  return (findProperty(name) && !oneOf(name, no)) || oneOf(name, unsupported);
}

bool isUnsupported(std::string_view name, std::string_view value) {
  constexpr std::string_view names[] = {"offset-path",
                                        "offset",
                                        "backdrop-filter",
                                        "mask-image",
                                        "mask-border",
                                        "mask-border-source",
                                        "perspective",
                                        "clip",
                                        "shape-rendering",
                                        "image-rendering",
                                        "zoom",
                                        "animation",
                                        "animation-name",
                                        "content-visibility",
                                        "color-scheme",
                                        "fill-image",
                                        "stroke-image",
                                        "stroke-align",
                                        "stroke-alignment",
                                        "stroke-dash-corner",
                                        "stroke-dash-justify",
                                        "-webkit-mask",
                                        "-webkit-mask-image",
                                        "-webkit-filter",
                                        "-webkit-transform",
                                        "-webkit-clip-path"};
  constexpr std::string_view without[] = {
      "none",       "view-box",        "inherit",      "initial",    "unset", "revert", "auto",    "geometricprecision",
      "smooth",     "optimizequality", "high-quality", "normal",     "1",     "100%",   "visible", "light",
      "light dark", "dark light",      "only light",   "light only", "center"};
  return oneOf(name, names) && !oneOf(lowered(trim(value)), without);
}

bool isUnsupportedOnRoot(std::string_view name, std::string_view value) {
  constexpr std::string_view names[] = {"background-image", "border",      "border-top",     "border-right",
                                        "border-bottom",    "border-left", "border-style",   "border-image",
                                        "border-radius",    "outline",     "outline-style",  "box-shadow",
                                        "padding",          "padding-top", "padding-right",  "padding-bottom",
                                        "padding-left",     "object-fit",  "object-position"};
  constexpr std::string_view without[] = {"none", "inherit", "initial", "unset", "revert", "0", "0px", "hidden"};
  return oneOf(name, names) && !oneOf(lowered(trim(value)), without);
}

bool hasUnsupported(std::string_view value) {
  constexpr std::string_view functions[] = {
      "var",      "env",     "attr",      "calc",       "min",         "max",         "clamp",      "round",   "mod",
      "rem",      "sin",     "cos",       "tan",        "asin",        "acos",        "atan",       "atan2",   "pow",
      "sqrt",     "hypot",   "log",       "exp",        "abs",         "sign",        "lab",        "lch",     "oklab",
      "oklch",    "color",   "color-mix", "light-dark", "device-cmyk", "translate3d", "translatez", "scale3d", "scalez",
      "rotate3d", "rotatex", "rotatey",   "rotatez",    "matrix3d",    "perspective"};
  constexpr std::string_view units[] = {
      "vw",  "vh",  "vi",    "vb",    "vmin",  "vmax", "svw", "svh",  "svi", "svb",   "svmin", "svmax", "lvw",
      "lvh", "lvi", "lvb",   "lvmin", "lvmax", "dvw",  "dvh", "dvi",  "dvb", "dvmin", "dvmax", "cqw",   "cqh",
      "cqi", "cqb", "cqmin", "cqmax", "lh",    "rlh",  "cap", "rcap", "ic",  "ric",   "rex",   "rch"};
  const std::string lower = lowered(value.substr(0, 1024)); // enough for what people write
  constexpr std::string_view systemColors[] = {
      "accentcolor", "accentcolortext", "activetext",   "buttonborder",     "buttonface", "buttontext",    "canvas",
      "canvastext",  "field",           "fieldtext",    "graytext",         "highlight",  "highlighttext", "linktext",
      "mark",        "marktext",        "selecteditem", "selecteditemtext", "visitedtext"};
  constexpr std::string_view boxes[] = {"stroke-box", "border-box"};
  if (oneOf(trim(lower), systemColors) || oneOf(trim(lower), boxes)) return true;
  if (lower.find('{') != lower.npos) return true;                                             // rules inside of others
  if (lower.find("(from ") != lower.npos || lower.find("( from ") != lower.npos) return true; // a colour of another one
  for (Scanner s(lower); !s.done();) {
    double number = 0;
    const bool isNumber = s.number(number);
    const std::string_view name = s.name();
    if (isNumber ? oneOf(name, units) : s.peek() == '(' && oneOf(name, functions)) return true;
    if (!isNumber && name.empty()) s.advance();
  }
  return false;
}

Applied applyProperty(Style& style, const Style& parent, std::string_view name, std::string_view value,
                      const LengthContext& lengths) {
  const Property* property = findProperty(name);
  const Context context{style, parent, trim(value), lengths};
  if (name == "all") { // CSS Cascade 4, 3.2
    constexpr std::string_view words[] = {"inherit", "initial", "unset", "revert", "revert-layer"};
    const std::string word = lowered(context.value);
    if (!oneOf(word, words)) return Applied::Invalid;
    const Style from = word == "inherit" ? parent : word == "initial" ? Style() : parent.inherited();
    for (const std::span<const Property> table : {std::span<const Property>(kProperties), textProperties()})
      for (const Property& p : table)
        if (p.name != "direction" && p.name != "unicode-bidi") p.take(style, from);
    return Applied::Yes;
  }
  if (!property) return Applied::Unknown;
  const auto takeFrom = [&](const Style& other) {
    property->take(style, other);
    return Applied::Yes;
  };
  if (isWord(context.value, "inherit")) return takeFrom(parent);
  if (isWord(context.value, "initial")) return takeFrom({});
  for (const std::string_view word : {"unset", "revert", "revert-layer"}) // there are no other style sheets
    if (isWord(context.value, word)) return takeFrom(parent.inherited());
  return property->set(context) ? Applied::Yes : Applied::Invalid;
}

} // namespace gpgp::vector::svg
