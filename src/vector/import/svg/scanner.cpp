// Numbers, lengths and transform lists (SVG 2, chapters 4 and 8; CSS Values 4 for units).
#include "vector/import/svg/scanner.h"

#include "vector/import/svg/values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

namespace gpgp::vector::svg {
namespace {
bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f'; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isNameCharacter(char c) {
  const bool inAscii = static_cast<unsigned char>(c) < 0x80;
  return !inAscii || isDigit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
}
} // namespace

std::string_view trim(std::string_view text) {
  while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
  return text;
}

std::string lowered(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

bool isWord(std::string_view text, std::string_view word) {
  return std::equal(text.begin(), text.end(), word.begin(), word.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

void Scanner::skipSpace() {
  while (!done() && isSpace(text_[at_])) ++at_;
}

void Scanner::skipCommaSpace() {
  skipSpace();
  if (peek() != ',') return;
  ++at_;
  skipSpace();
}

bool Scanner::number(double& value) {
  size_t i = at_;
  const auto digit = [&](size_t k) { return k < text_.size() && isDigit(text_[k]); };
  if (i < text_.size() && (text_[i] == '+' || text_[i] == '-')) ++i;
  const size_t digits = i;
  while (digit(i)) ++i;
  size_t count = i - digits;
  if (i < text_.size() && text_[i] == '.' && (digit(i + 1) || count)) {
    const size_t fraction = ++i;
    while (digit(i)) ++i;
    count += i - fraction;
  }
  if (!count) return false;
  bool tiny = false;
  if (i < text_.size() && (text_[i] == 'e' || text_[i] == 'E')) { // an exponent, or the unit em or ex
    size_t k = i + 1;
    tiny = k < text_.size() && text_[k] == '-';
    if (k < text_.size() && (text_[k] == '+' || text_[k] == '-')) ++k;
    if (digit(k)) {
      while (digit(k)) ++k;
      i = k;
    }
  }
  const size_t begin = text_[at_] == '+' ? at_ + 1 : at_;
  double parsed = 0;
  const auto result = std::from_chars(text_.data() + begin, text_.data() + i, parsed);
  if (result.ec == std::errc::result_out_of_range) {
    if (!tiny) return false;
    parsed = 0;
  } else if (result.ec != std::errc()) {
    return false;
  }
  value = parsed;
  at_ = i;
  return true;
}

bool Scanner::flag(bool& value) {
  if (peek() != '0' && peek() != '1') return false;
  value = text_[at_++] == '1';
  return true;
}

bool Scanner::take(std::string_view word) {
  if (text_.substr(at_, word.size()) != word) return false;
  at_ += word.size();
  return true;
}

std::string_view Scanner::name() {
  const size_t begin = at_;
  while (!done() && isNameCharacter(text_[at_])) ++at_;
  return text_.substr(begin, at_ - begin);
}

bool parseAngle(std::string_view text, double& radians) {
  constexpr struct {
    std::string_view unit;
    double factor;
  } units[] = {{"", std::numbers::pi / 180},
               {"deg", std::numbers::pi / 180},
               {"grad", std::numbers::pi / 200},
               {"rad", 1},
               {"turn", 2 * std::numbers::pi}};
  Scanner s(text);
  double number = 0;
  if (!s.number(number)) return false;
  const std::string unit = lowered(s.name());
  for (const auto& u : units)
    if (s.done() && u.unit == unit) return radians = number * u.factor, true;
  return false;
}

bool parseLength(std::string_view text, const LengthContext& context, LengthAxis axis, double& value) {
  text = trim(text);
  if (isMath(text)) return evaluate(text, context, axis, value);
  Scanner s(text);
  double v = 0;
  if (!s.number(v)) return false;
  const double diagonal = std::sqrt((context.width * context.width + context.height * context.height) / 2);
  const struct {
    const char* name;
    double factor;
  } units[] = {{"px", 1},
               {"pt", 96.0 / 72},
               {"pc", 16},
               {"mm", 96 / 25.4},
               {"cm", 96 / 2.54},
               {"in", 96},
               {"em", context.fontSize},
               {"rem", context.rootFontSize},
               {"ex", context.fontSize / 2},
               {"ch", context.fontSize / 2},
               {"q", 96 / 101.6},
               {"vw", context.pageWidth / 100},
               {"vi", context.pageWidth / 100},
               {"vh", context.pageHeight / 100},
               {"vb", context.pageHeight / 100},
               {"vmin", std::min(context.pageWidth, context.pageHeight) / 100},
               {"vmax", std::max(context.pageWidth, context.pageHeight) / 100},
               {"%", (axis == LengthAxis::X   ? context.width
                      : axis == LengthAxis::Y ? context.height
                                              : diagonal) /
                         100}};
  if (!s.done()) {
    const auto* unit = std::begin(units);
    while (unit != std::end(units) && !isWord(text.substr(s.offset()), unit->name)) ++unit;
    if (unit == std::end(units)) return false;
    v *= unit->factor;
  }
  if (!std::isfinite(v)) return false;
  value = v;
  return true;
}

bool parseOrigin(std::string_view text, const LengthContext& context, Point& origin) {
  struct Word {
    std::string_view name;
    LengthAxis axis;
    double part;
  };
  constexpr Word words[] = {{"left", LengthAxis::X, 0},
                            {"right", LengthAxis::X, 1},
                            {"top", LengthAxis::Y, 0},
                            {"bottom", LengthAxis::Y, 1},
                            {"center", LengthAxis::Diagonal, 0.5}};
  Point p = 0.5 * Point{context.width, context.height};
  bool swapped = false; // "top left"
  int count = 0;
  for (text = trim(text); !text.empty(); ++count) {
    const size_t end = std::min(text.find_first_of(" \t\r\n\f"), text.size());
    const std::string_view part = text.substr(0, end);
    text = trim(text.substr(end));
    if (count == 2) { // along z
      double z = 0;
      return text.empty() && parseLength(part, context, LengthAxis::X, z) && (origin = p, true);
    }
    bool down = (count == 1) != swapped;
    const Word* word = std::begin(words);
    while (word != std::end(words) && !isWord(part, word->name)) ++word;
    if (word == std::end(words)) {
      if (swapped) return false; // "top 20"
      double& value = down ? p.y : p.x;
      if (!parseLength(part, context, down ? LengthAxis::Y : LengthAxis::X, value)) return false;
      continue;
    }
    if (count == 0 && word->axis == LengthAxis::Y) swapped = down = true;
    if (word->axis != LengthAxis::Diagonal && (word->axis == LengthAxis::Y) != down) return false;
    (down ? p.y : p.x) = word->part * (down ? context.height : context.width);
  }
  return count > 0 && (origin = p, true);
}

bool isPlainTransform(std::string_view text) {
  constexpr std::string_view functions[] = {"matrix", "translate", "scale", "rotate", "skewX", "skewY"};
  for (Scanner s(text); !s.done();) {
    s.skipCommaSpace();
    if (s.done()) break;
    if (!oneOf(s.name(), functions)) return false;
    for (bool inside = false; !s.done() && s.peek() != ')'; s.advance()) {
      if (inside && std::string_view("0123456789+-.eE, \t\r\n\f").find(s.peek()) == std::string_view::npos)
        return false;
      inside |= s.peek() == '(';
    }
    s.take(")");
  }
  return true;
}

bool parseTransform(std::string_view text, const LengthContext& context, Affine& transform) {
  constexpr struct {
    const char* name;
    double factor;
  } units[] = {{"deg", 1}, {"grad", 0.9}, {"rad", 180 / std::numbers::pi}, {"turn", 360}, {"px", 1}}; // as CSS has them
  Affine all;
  const std::string lower = lowered(text);
  Scanner s(lower);
  s.skipSpace();
  if (s.take("none")) return s.skipSpace(), s.done();
  while (!s.done()) {
    const std::string_view name = s.name();
    s.skipSpace();
    if (!s.take("(")) return false;
    double v[6] = {};
    const bool moves = name.starts_with("translate");
    int count = 0;
    bool hasUnit = false, lacksComma = false; // those of CSS have commas, those of SVG need none and have no units
    const auto separator = [&] {
      s.skipSpace();
      lacksComma |= s.peek() != ',' && s.peek() != ')';
      s.skipCommaSpace();
    };
    s.skipSpace();
    while (!s.done() && s.peek() != ')') {
      const size_t start = s.offset();
      if (count == 6) return false;
      if (s.peek() >= 'a' && s.peek() <= 'z') { // calc() and the like
        for (int depth = 0; !s.done(); s.advance()) {
          depth += (s.peek() == '(') - (s.peek() == ')');
          if (depth == 0 && s.peek() == ')') break;
        }
        if (!s.take(")")) return false;
        const LengthAxis axis = count == 1 || name == "translatey" ? LengthAxis::Y : LengthAxis::X;
        const std::string_view math = std::string_view(lower).substr(start, s.offset() - start);
        if (!isMath(math) || !evaluate(math, context, axis, v[count])) return false;
        ++count;
        separator();
        continue;
      }
      if (!s.number(v[count])) return false;
      hasUnit |= s.peek() == '%' || (s.peek() >= 'a' && s.peek() <= 'z');
      if (moves && (s.peek() == '%' || (s.peek() >= 'a' && s.peek() <= 'z'))) {
        if (!s.take("%")) s.name();
        const LengthAxis axis = count == 1 || name == "translatey" ? LengthAxis::Y : LengthAxis::X;
        if (!parseLength(lower.substr(start, s.offset() - start), context, axis, v[count])) return false;
      }
      for (const auto& unit : units)
        if (s.take(unit.name)) {
          v[count] *= unit.factor;
          break;
        }
      ++count;
      separator();
    }
    if (!s.take(")") || (hasUnit && lacksComma)) return false;
    Affine m;
    const double radians = v[0] * (std::numbers::pi / 180);
    if (name == "matrix" && count == 6) {
      m = {v[0], v[1], v[2], v[3], v[4], v[5]};
    } else if (name == "translate" && (count == 1 || count == 2)) {
      m.e = v[0];
      m.f = v[1];
    } else if (name == "scale" && (count == 1 || count == 2)) {
      m.a = v[0];
      m.d = count == 2 ? v[1] : v[0];
    } else if (name == "rotate" && (count == 1 || count == 3)) {
      const double c = std::cos(radians), n = std::sin(radians);
      m = {c, n, -n, c, v[1] - c * v[1] + n * v[2], v[2] - n * v[1] - c * v[2]};
    } else if ((name == "translatex" || name == "translatey") && count == 1) {
      (name == "translatex" ? m.e : m.f) = v[0];
    } else if ((name == "scalex" || name == "scaley") && count == 1) {
      (name == "scalex" ? m.a : m.d) = v[0];
    } else if (name == "skew" && (count == 1 || count == 2)) {
      m.c = std::tan(radians);
      m.b = std::tan(v[1] * (std::numbers::pi / 180));
    } else if (name == "skewx" && count == 1) {
      m.c = std::tan(radians);
    } else if (name == "skewy" && count == 1) {
      m.b = std::tan(radians);
    } else {
      return false;
    }
    all = all * m;
    s.skipCommaSpace();
  }
  transform = all;
  return true;
}

} // namespace gpgp::vector::svg
