// The properties of fonts and text (SVG 2, chapter 11; CSS Fonts 4).
#include "vector/import/svg/property.h"

#include <algorithm>

namespace gpgp::vector::svg {
namespace {

using Context = PropertyContext;

constexpr Word<double> kStretches[] = {
    {"ultra-condensed", 50},  {"extra-condensed", 62.5}, {"condensed", 75},
    {"semi-condensed", 87.5}, {"normal", 100},           {"semi-expanded", 112.5},
    {"expanded", 125},        {"extra-expanded", 150},   {"ultra-expanded", 200},
};
/// CSS Fonts 4, 2.2.1.
double bolder(double weight) { return weight < 350 ? 400 : weight < 550 ? 700 : 900; }
double lighter(double weight) { return weight < 550 ? 100 : weight < 750 ? 400 : 700; }

bool parseFontSize(std::string_view v, const Style& parent, LengthContext lengths, double& size) {
  const struct {
    std::string_view name;
    double size;
  } names[] = {{"xx-small", 9},
               {"x-small", 10},
               {"small", 13},
               {"medium", 16},
               {"large", 18},
               {"x-large", 24},
               {"xx-large", 32},
               {"xxx-large", 48},
               {"larger", parent.fontSize * 1.2},
               {"smaller", parent.fontSize / 1.2}};
  for (const auto& n : names)
    if (isWord(v, n.name)) return size = n.size, true;
  lengths.width = lengths.height = lengths.fontSize = parent.fontSize;
  double read = 0;
  return parseLength(v, lengths, LengthAxis::X, read) && read >= 0 && (size = read, true);
}

/// Names between commas: in quotes, or words that begin with no digit (CSS Fonts 4, 2.1).
bool areFamilies(std::string_view list) {
  while (true) {
    list = trim(list);
    if (list.empty()) return false;
    const char quote = list[0] == '"' || list[0] == '\'' ? list[0] : '\0';
    const size_t end = quote ? list.find(quote, 1) : std::min(list.find(','), list.size());
    if (end == list.npos) return true; // the end of the value closes what is open
    for (std::string_view rest = trim(list.substr(0, quote ? 0 : end)); !rest.empty();) {
      const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r\n\f"));
      const size_t first = word.find_first_not_of('-');
      const bool isName = first != word.npos && !(word[first] >= '0' && word[first] <= '9') &&
                          word.find_first_of("\"'()[]{};:!@#$%^&*+=|<>?/.~`") == word.npos;
      if (!isName) return false;
      rest = trim(rest.substr(word.size()));
    }
    if (!quote && end == 0) return false;
    list = trim(list.substr(quote ? end + 1 : end));
    if (list.empty()) return true;
    if (list[0] != ',') return false;
    list.remove_prefix(1);
  }
}

/// What is before the size, the size, what may be a line's height, and families.
bool parseFont(std::string_view text, const Style& parent, const LengthContext& lengths, double& size,
               TextStyle& style) {
  TextStyle own = style;
  own.weight = 400, own.stretch = 100, own.italic = own.smallCaps = false, own.families.clear();
  constexpr std::string_view systems[] = {"caption", "icon", "menu", "message-box", "small-caption", "status-bar"};
  constexpr std::string_view before[] = {
      "normal",         "italic",        "oblique",         "small-caps",      "bold",
      "bolder",         "lighter",       "ultra-condensed", "extra-condensed", "condensed",
      "semi-condensed", "semi-expanded", "expanded",        "extra-expanded",  "ultra-expanded"};
  const std::string lower = lowered(text);
  if (oneOf(lower, systems)) return style = own, size = 16, true;
  std::string_view rest = lower;
  const auto word = [&rest] { return rest.substr(0, rest.find_first_of(" \t\r\n\f/")); };
  double weight = 0;
  const auto isWeight = [&](std::string_view number) {
    return parseLength(number, lengths, LengthAxis::X, weight) && weight >= 1 && weight <= 1000 &&
           number.find_first_not_of("+.0123456789") == number.npos;
  };
  const auto isAngle = [](std::string_view angle) {
    constexpr std::string_view units[] = {"deg", "grad", "rad", "turn"};
    Scanner s(angle);
    double number = 0;
    return s.number(number) && oneOf(s.name(), units) && s.done();
  };
  for (int i = 0; i < 4 && (oneOf(word(), before) || isWeight(word())); ++i) {
    const bool slanted = word() == "oblique";
    own.italic |= slanted || word() == "italic";
    own.smallCaps |= word() == "small-caps";
    if (word() == "bold") own.weight = 700;
    if (word() == "bolder") own.weight = bolder(parent.text.weight);
    if (word() == "lighter") own.weight = lighter(parent.text.weight);
    choose(word(), kStretches, own.stretch);
    if (isWeight(word())) own.weight = weight;
    rest = trim(rest.substr(word().size()));
    if (slanted && isAngle(word())) rest = trim(rest.substr(word().size()));
  }
  double read = 0;
  if (!parseFontSize(word(), parent, lengths, read)) return false;
  rest = trim(rest.substr(word().size()));
  if (rest.substr(0, 1) == "/") {
    rest = trim(rest.substr(1));
    double height = 0;
    if (word() != "normal" && !parseLength(word(), lengths, LengthAxis::X, height)) return false;
    rest = trim(rest.substr(word().size()));
  }
  own.families = text.substr(text.size() - rest.size());
  return areFamilies(own.families) && (size = read, style = own, true);
}

bool setFontSize(const Context& c) {
  double read = 0; // negative: an error of SVG 1.1, for which resvg shows nothing
  return parseFontSize(c.value, c.parent, c.lengths, c.style.fontSize) ||
         (parseLength(c.value, c.lengths, LengthAxis::X, read) && (c.style.fontSize = 0, true));
}
bool setWeight(const Context& c) {
  constexpr Word<double> names[] = {{"normal", 400}, {"bold", 700}};
  double& weight = c.style.text.weight;
  const double above = c.parent.text.weight;
  if (isWord(c.value, "bolder")) return weight = bolder(above), true;
  if (isWord(c.value, "lighter")) return weight = lighter(above), true;
  if (choose(c.value, names, weight)) return true;
  Scanner s(c.value);
  double v = 0;
  return s.number(v) && s.done() && v >= 1 && v <= 1000 && (weight = v, true);
}
bool setSpacing(const Context& c, double& spacing) {
  if (isWord(c.value, "normal")) return spacing = 0, true;
  return parseLength(c.value, c.lengths, LengthAxis::X, spacing);
}
bool setSlant(const Context& c) {
  const std::string_view word = c.value.substr(0, c.value.find_first_of(" \t\r\n\f"));
  const bool slants = isWord(word, "italic") || isWord(word, "oblique"); // an angle may be behind
  return (slants || isWord(word, "normal")) && (c.style.text.italic = slants, true);
}
/// A word of CSS Text 3, or the longhands of CSS Text 4; without line breaks, what wraps has no effect.
bool setSpace(const Context& c, bool isLonghand) {
  using Space = TextStyle::Space;
  constexpr Word<Space> words[] = {{"normal", Space::Collapse},   {"nowrap", Space::Collapse},
                                   {"pre-line", Space::Collapse}, {"pre", Space::Preserve},
                                   {"pre-wrap", Space::Preserve}, {"break-spaces", Space::Preserve},
                                   {"collapse", Space::Collapse}, {"preserve-breaks", Space::Collapse},
                                   {"preserve", Space::Preserve}, {"preserve-spaces", Space::Preserve},
                                   {"wrap", Space::Collapse}};
  constexpr std::string_view wraps[] = {"wrap", "nowrap"},
                             oldOnes[] = {"normal", "nowrap", "pre", "pre-wrap", "pre-line"};
  const std::string value = lowered(c.value);
  const size_t end = std::min(value.find_first_of(" \t\r\n\f"), value.size());
  const std::string first = value.substr(0, end), second(trim(std::string_view(value).substr(end)));
  if (isLonghand ? !second.empty() || oneOf(first, oldOnes) || first == "wrap"
                 : !second.empty() && !oneOf(second, wraps))
    return false;
  return choose(first, words, c.style.text.space);
}
/// A word, a percentage, or a step from what the parent has (SVG 1.1, 10.10).
bool setStretch(const Context& c) {
  double& stretch = c.style.text.stretch;
  if (choose(c.value, kStretches, stretch)) return true;
  const bool isWider = isWord(c.value, "wider");
  if (isWider || isWord(c.value, "narrower")) {
    const double from = c.parent.text.stretch;
    stretch = from;
    for (const auto& step : kStretches) { // the nearest one on the side
      const bool isBeyond = isWider ? step.value > from : step.value < from;
      const bool isFirst = stretch == from || !isWider;
      if (isBeyond && isFirst) stretch = step.value;
    }
    return true;
  }
  Scanner s(c.value);
  double percent = 0;
  return s.number(percent) && s.take("%") && s.done() && percent >= 0 && (stretch = percent, true);
}
constexpr Word<double> kAnchors[] = {{"start", 0}, {"middle", 0.5}, {"end", 1}};
constexpr Word<bool> kKernings[] = {{"auto", false}, {"normal", false}, {"none", true}};
bool setKerning(const Context& c) { // of SVG 1.1; other lengths than 0 are not in use
  double length = 0;
  return c.style.text.unkerned = parseLength(c.value, c.lengths, LengthAxis::X, length) && length == 0, true;
}
constexpr Word<bool> kDirections[] = {{"ltr", false}, {"rtl", true}};
using Bidi = TextStyle::Bidi;
constexpr Word<Bidi> kBidis[] = {{"normal", Bidi::Normal},          {"embed", Bidi::Embed},
                                 {"bidi-override", Bidi::Override}, {"isolate", Bidi::Isolate},
                                 {"plaintext", Bidi::Plaintext},    {"isolate-override", Bidi::IsolateOverride}};
/// Of SVG 1.1 and of CSS, without sideways-rl and sideways-lr.
constexpr Word<bool> kWritingModes[] = {
    {"horizontal-tb", false}, {"lr", false}, {"lr-tb", false}, {"rl", false},
    {"rl-tb", false},         {"tb", true},  {"tb-rl", true},  {"vertical-rl", true},
    {"vertical-lr", true}};
constexpr UndrawnProperty kUndrawn[TextStyle::kUndrawn] = {
    {"font-size-adjust", true, false},
    {"font-feature-settings", true, false},
    {"font-variation-settings", true, false},
    {"font-variant-alternates", true, false},
    {"font-variant-caps", true, false},
    {"font-variant-east-asian", true, false},
    {"font-variant-ligatures", true, false},
    {"font-variant-numeric", true, false},
    {"font-variant-position", true, false},
    {"font-palette", true, false},
    {"glyph-orientation-vertical", true, true},
    {"inline-size", false, false},
    {"shape-inside", false, false},
    {"text-combine-upright", true, true},
    {"text-indent", true, false},
    {"text-orientation", true, true},
    {"text-shadow", true, false},
    {"text-transform", true, false},
};
/// Without effect are the initial value, and for glyph-orientation-vertical and text-indent others of the same meaning.
template <size_t I> bool setUndrawn(const Context& c) {
  constexpr std::string_view name = kUndrawn[I].name, orientations[] = {"auto"}, orders[] = {"mixed"},
                             lengths[] = {"0", "0px"}, ligatures[] = {"normal"}, others[] = {"none", "normal", "auto"};
  const std::string value = lowered(c.value);
  c.style.text.undrawn[I] = name == "glyph-orientation-vertical" ? !oneOf(value, orientations)
                            : name == "text-orientation"         ? !oneOf(value, orders)
                            : name == "text-indent"              ? !oneOf(value, lengths)
                            : name == "font-variant-ligatures"   ? !oneOf(value, ligatures)
                                                                 : !oneOf(value, others);
  return !value.empty();
}
#define GPGP_UNDRAWN(index) GPGP_PROPERTY(kUndrawn[index].name, text.undrawn[index], setUndrawn<index>(c))

const Property kTextProperties[] = {
    GPGP_PROPERTY("font-size", fontSize, setFontSize(c)),
    GPGP_PROPERTY("font", fontSize, parseFont(c.value, c.parent, c.lengths, c.style.fontSize, c.style.text)),
    GPGP_PROPERTY("font-family", text.families, areFamilies(c.value) && (c.style.text.families = c.value, true)),
    GPGP_PROPERTY("font-weight", text.weight, setWeight(c)),
    GPGP_PROPERTY("font-style", text.italic, setSlant(c)),
    GPGP_PROPERTY("font-stretch", text.stretch, setStretch(c)),
    GPGP_PROPERTY("font-variant", text.smallCaps,
                  (c.style.text.smallCaps = lowered(c.value).find("small-caps") != std::string::npos, true)),
    GPGP_PROPERTY("font-kerning", text.unkerned, choose(c.value, kKernings, c.style.text.unkerned)),
    GPGP_PROPERTY("kerning", text.unkerned, setKerning(c)),
    GPGP_PROPERTY("letter-spacing", text.letterSpacing, setSpacing(c, c.style.text.letterSpacing)),
    GPGP_PROPERTY("word-spacing", text.wordSpacing, setSpacing(c, c.style.text.wordSpacing)),
    GPGP_PROPERTY("text-anchor", text.anchor, choose(c.value, kAnchors, c.style.text.anchor)),
    GPGP_PROPERTY("direction", text.rightToLeft, choose(c.value, kDirections, c.style.text.rightToLeft)),
    GPGP_PROPERTY("writing-mode", text.vertical, choose(c.value, kWritingModes, c.style.text.vertical)),
    GPGP_PROPERTY("white-space", text.space, setSpace(c, false)),
    GPGP_PROPERTY("white-space-collapse", text.space, setSpace(c, true)),
    GPGP_PROPERTY("dominant-baseline", text.dominantBaseline,
                  (c.style.text.dominantBaseline =
                       isWord(c.value, "no-change") ? c.parent.text.dominantBaseline : lowered(c.value),
                   true)),
    GPGP_PROPERTY("alignment-baseline", text.alignmentBaseline,
                  (c.style.text.alignmentBaseline = lowered(c.value), true)),
    GPGP_PROPERTY("unicode-bidi", text.bidi, choose(c.value, kBidis, c.style.text.bidi)),
    GPGP_PROPERTY("baseline-shift", text.baselineShift, (c.style.text.baselineShift = lowered(c.value), true)),
    GPGP_PROPERTY("text-decoration", text.decoration,
                  c.value.find(',') == c.value.npos && (c.style.text.decoration = lowered(c.value), true)),
    GPGP_UNDRAWN(0),
    GPGP_UNDRAWN(1),
    GPGP_UNDRAWN(2),
    GPGP_UNDRAWN(3),
    GPGP_UNDRAWN(4),
    GPGP_UNDRAWN(5),
    GPGP_UNDRAWN(6),
    GPGP_UNDRAWN(7),
    GPGP_UNDRAWN(8),
    GPGP_UNDRAWN(9),
    GPGP_UNDRAWN(10),
    GPGP_UNDRAWN(11),
    GPGP_UNDRAWN(12),
    GPGP_UNDRAWN(13),
    GPGP_UNDRAWN(14),
    GPGP_UNDRAWN(15),
    GPGP_UNDRAWN(16),
    GPGP_UNDRAWN(17),
};

} // namespace

std::span<const Property> textProperties() { return kTextProperties; }

std::span<const UndrawnProperty, TextStyle::kUndrawn> textPropertiesUndrawn() { return kUndrawn; }

} // namespace gpgp::vector::svg
