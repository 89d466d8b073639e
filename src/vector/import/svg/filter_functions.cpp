// The property filter: functions of CSS and references in a row (Filter Effects 1, chapters 5 and 6); modes of mixing
// by their names (Compositing and Blending 1, chapter 9).
#include "vector/import/svg/style.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gpgp::vector::svg {
namespace {
using Kind = FilterFunction::Kind;

constexpr struct {
  std::string_view name;
  Kind kind;
  double otherwise; ///< of its argument where it has none
  bool isPart;      ///< more than 1 counts as 1
} kFunctions[] = {{"blur", Kind::Blur, 0, false},
                  {"drop-shadow", Kind::DropShadow, 0, false},
                  {"brightness", Kind::Brightness, 1, false},
                  {"contrast", Kind::Contrast, 1, false},
                  {"grayscale", Kind::Grayscale, 1, true},
                  {"hue-rotate", Kind::HueRotate, 0, false},
                  {"invert", Kind::Invert, 1, true},
                  {"opacity", Kind::Opacity, 1, true},
                  {"saturate", Kind::Saturate, 1, false},
                  {"sepia", Kind::Sepia, 1, true}};

/// Behind the bracket that closes the first one; npos where there is none. Strings are skipped.
size_t pastBrackets(std::string_view text) {
  int depth = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"' || text[i] == '\'') {
      i = text.find(text[i], i + 1);
      if (i == text.npos) return i;
      continue;
    }
    depth += text[i] == '(';
    if (text[i] == ')' && --depth == 0) return i + 1;
  }
  return text.npos;
}

/// A word, with its brackets where it has some.
std::string_view takeWord(std::string_view& text) {
  text = trim(text);
  size_t end = std::min(text.find_first_of(" \t\r\n\f("), text.size());
  if (end < text.size() && text[end] == '(') end = std::min(pastBrackets(text), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(end);
  return word;
}

bool isPlainLength(std::string_view text, const LengthContext& lengths, double& value) {
  return text.find('%') == text.npos && parseLength(text, lengths, LengthAxis::X, value);
}

/// A colour, and two or three lengths in a row, in either order.
bool parseShadow(std::string_view text, const LengthContext& lengths, FilterFunction& shadow) {
  double values[3] = {};
  int count = 0, lastLength = 0, words = 0, colors = 0;
  while (!trim(text).empty()) {
    const std::string_view word = takeWord(text);
    if (word.empty() || ++words > 4) return false;
    double value = 0;
    Color color;
    if (count < 3 && isPlainLength(word, lengths, value)) {
      if (count && lastLength != words - 1) return false;
      values[count++] = value;
      lastLength = words;
    } else if (isWord(word, "currentcolor") && colors++ == 0) {
      shadow.color.reset();
    } else if (parseColor(word, color) && colors++ == 0) {
      shadow.color = color;
    } else {
      return false;
    }
  }
  shadow.x = values[0], shadow.y = values[1], shadow.amount = values[2];
  return count >= 2 && values[2] >= 0;
}

/// One of CSS has a unit unless it is zero.
bool isAngle(std::string_view text) {
  Scanner s(text);
  double value = 0;
  return isMath(text) || (s.number(value) && (value == 0 || !s.done()));
}

bool parseFactor(std::string_view text, double& value) {
  if (isMath(text)) return evaluate(text, {1, 1}, LengthAxis::X, value);
  Scanner s(text);
  if (!s.number(value)) return false;
  if (s.take("%")) value /= 100;
  return s.done();
}
} // namespace

bool parseFilter(std::string_view text, const LengthContext& lengths, std::vector<FilterFunction>& functions) {
  constexpr size_t kMost = 256;
  std::vector<FilterFunction> read;
  if (isWord(text, "none")) return functions.clear(), true;
  while (!(text = trim(text)).empty()) {
    FilterFunction function;
    const std::string_view word = takeWord(text);
    const size_t bracket = word.find('(');
    if (bracket == word.npos || word.back() != ')' || read.size() >= kMost) return false;
    const std::string name = lowered(word.substr(0, bracket));
    const std::string_view inside = trim(word.substr(bracket + 1, word.size() - bracket - 2));
    if (name == "url") {
      std::string_view target = inside;
      if (target.size() > 1 && (target[0] == '"' || target[0] == '\'') && target.back() == target[0])
        target = trim(target.substr(1, target.size() - 2));
      function.reference = target;
      read.push_back(std::move(function));
      continue;
    }
    const auto* known =
        std::find_if(std::begin(kFunctions), std::end(kFunctions), [&name](const auto& f) { return f.name == name; });
    if (known == std::end(kFunctions)) return false;
    function.kind = known->kind;
    function.amount = known->otherwise;
    const bool good = known->kind == Kind::DropShadow  ? parseShadow(inside, lengths, function)
                      : inside.empty()                 ? true
                      : known->kind == Kind::Blur      ? isPlainLength(inside, lengths, function.amount)
                      : known->kind == Kind::HueRotate ? isAngle(inside) && parseAngle(inside, function.amount)
                                                       : parseFactor(inside, function.amount);
    if (!good || !std::isfinite(function.amount) || (function.amount < 0 && known->kind != Kind::HueRotate))
      return false;
    if (known->isPart) function.amount = std::min(function.amount, 1.0);
    read.push_back(std::move(function));
  }
  if (read.empty()) return false;
  functions = std::move(read);
  return true;
}

bool parseBlendMode(std::string_view text, GpgpBlendMode& mode) {
  constexpr std::string_view names[] = {"normal",     "multiply",    "screen",     "overlay",    "darken",
                                        "lighten",    "color-dodge", "color-burn", "hard-light", "soft-light",
                                        "difference", "exclusion",   "hue",        "saturation", "color",
                                        "luminosity", "plus-lighter"};
  const auto* found = std::find(std::begin(names), std::end(names), lowered(text));
  return found != std::end(names) && (mode = static_cast<GpgpBlendMode>(found - names), true);
}

} // namespace gpgp::vector::svg
