#include "spawn/lsystem/scanner.h"

#include <algorithm>

namespace gpgp::spawn::lsystem {
namespace {

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }
bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// The directives of other dialects that begin as comments do.
bool isDirective(std::string_view rest) {
  for (const std::string_view word : {"#define ", "#define\t", "#ignore", "#consider"})
    if (rest.starts_with(word)) return true;
  return false;
}

/// Whether a line begins with a name and ':'.
bool hasName(std::string_view text) {
  size_t i = 0;
  while (i < text.size() && isBlank(text[i])) ++i;
  if (i < text.size() && text[i] == '#') ++i;
  const size_t first = i;
  while (i < text.size() && (isLetter(text[i]) || (text[i] >= '0' && text[i] <= '9'))) ++i;
  if (i == first) return false;
  const std::string_view name = text.substr(first, i - first);
  while (i < text.size() && isBlank(text[i])) ++i;
  return (i < text.size() && text[i] == ':') || name == "define" || name == "ignore" || name == "consider";
}

} // namespace

std::pair<size_t, size_t> arrowIn(std::string_view text) {
  const size_t longArrow = text.find("-->");
  if (longArrow != std::string_view::npos) return {longArrow, 3};
  return {text.find("->"), 2};
}

std::vector<Line> linesOf(std::string_view text) {
  std::vector<Line> lines;
  bool inComment = false;
  uint32_t number = 0;
  for (size_t at = 0; at <= text.size();) {
    const size_t newline = std::min(text.find('\n', at), text.size());
    const std::string_view whole = text.substr(at, newline - at);
    ++number;
    Line line;
    bool atStart = true; // only blanks so far
    for (size_t i = 0; i < whole.size(); ++i) {
      const std::string_view rest = whole.substr(i);
      const bool separate = i == 0 || isBlank(whole[i - 1]);
      if (inComment) {
        if (rest.starts_with("*/")) {
          inComment = false;
          ++i;
        }
        continue;
      }
      if (separate && rest.starts_with("/*")) {
        inComment = true;
        ++i;
        continue;
      }
      if (separate && rest[0] == '#' && !(atStart && isDirective(rest))) break;
      if (rest.starts_with("//") && (atStart || (separate && (rest.size() == 2 || isBlank(rest[2]))))) break;
      line.text += whole[i];
      line.places.push_back({number, static_cast<uint32_t>(i + 1)});
      if (!isBlank(whole[i])) atStart = false;
    }
    while (!line.text.empty() && isBlank(line.text.back())) {
      line.text.pop_back();
      line.places.pop_back();
    }
    at = newline + 1;
    if (atStart || line.text.empty()) continue;
    line.places.push_back({number, static_cast<uint32_t>(line.places.back().column + 1)});
    const bool continues =
        !lines.empty() && isBlank(line.text[0]) && !hasName(line.text) && arrowIn(line.text).first == std::string::npos;
    if (!continues) {
      lines.push_back(std::move(line));
      continue;
    }
    Line& before = lines.back();
    before.text += '\n';
    before.text += line.text;
    before.places.insert(before.places.end(), line.places.begin(), line.places.end());
  }
  return lines;
}

void Reader::blanks() {
  while (at_ < end_ && (isBlank(line_.text[at_]) || line_.text[at_] == '\n')) ++at_;
}

bool Reader::atEnd() {
  blanks();
  return at_ >= end_;
}

char Reader::peek() { return atEnd() ? '\0' : line_.text[at_]; }

std::string Reader::found() {
  if (atEnd()) return "the end of the line";
  size_t length = 1;
  if (isLetter(line_.text[at_]))
    while (at_ + length < end_ && isLetter(line_.text[at_ + length])) ++length;
  else // a character of several bytes
    while (at_ + length < end_ && (static_cast<unsigned char>(line_.text[at_ + length]) & 0xc0) == 0x80) ++length;
  return std::string("'").append(line_.text, at_, length).append("'");
}

bool Reader::take(char c) {
  if (peek() != c) return false;
  ++at_;
  return true;
}

bool Reader::take(std::string_view text) {
  blanks();
  if (line_.text.compare(at_, text.size(), text) != 0 || at_ + text.size() > end_) return false;
  at_ += text.size();
  return true;
}

std::string Reader::identifier() {
  blanks();
  std::string name;
  while (at_ < end_ &&
         (isLetter(line_.text[at_]) || (!name.empty() && line_.text[at_] >= '0' && line_.text[at_] <= '9')))
    name += line_.text[at_++];
  return name;
}

/// ~('leaf', s), the surface by a name in quotes: ends at what is behind the name, a comma where there are values.
std::string Reader::surfaceInQuotes() {
  const std::string name = std::string("~") + line_.text[at_ + 2];
  const size_t close = line_.text.find('\'', at_ + 2);
  at_ = std::min(close == std::string::npos ? end_ : close + 1, end_);
  blanks();
  if (at_ < end_ && line_.text[at_] == ')') ++at_;
  return name;
}

std::string Reader::word() {
  blanks();
  std::string text;
  while (at_ < end_ && !isBlank(line_.text[at_]) && line_.text[at_] != '\n') text += line_.text[at_++];
  return text;
}

std::optional<Module> Reader::module(bool declares) {
  Module module;
  blanks();
  module.place = place();
  constexpr std::string_view kSigns = "+-&^\\/|$[]!{}.'%\";,#";
  const auto longest = std::find_if(names_.rbegin(), names_.rend(), [&](const std::string& name) {
    return line_.text.compare(at_, name.size(), name) == 0 && at_ + name.size() <= end_;
  });
  const char c = peek();
  const auto isName = [](char d) { return isLetter(d) || (d >= '0' && d <= '9'); };
  if (longest != names_.rend()) {
    module.name = *longest;
    at_ += longest->size();
  } else if (c == '?') {
    ++at_;
    module.name.assign(1, '?').append(identifier());
    const bool isNumbered = declared_ && at_ < end_ && line_.text[at_] == '('; // ?(2, 1), of a plant modeller
    if (module.name.size() == 1 && !isNumbered)
      error("'?' is followed by the name of a sub-system or a query; found " + found());
  } else if (c == '@') {
    ++at_;
    module.name = c;
    if (at_ < end_ && (isName(line_.text[at_]) || line_.text[at_] == '#')) module.name += line_.text[at_++];
    if (module.name == "@G" || module.name == "@T" || module.name == "@P" || module.name == "@C")
      if (at_ < end_ && isName(line_.text[at_])) module.name += line_.text[at_++];
    // Others are named by the compiler, and have no effect.
    constexpr std::string_view kCylinders = "sceatr";
    if (module.name.size() == 1 ||
        (module.name[1] == 'G' &&
         (module.name.size() < 3 || kCylinders.find(module.name[2]) == std::string_view::npos)))
      errorAt(module.place,
              "there is no command '" + module.name +
                  "'; after '@', there are Gs, Gc and Ge (a generalised cylinder), o, c and O (circles and "
                  "spheres), and v");
  } else if (c == '~') {
    ++at_;
    if (at_ < end_ && isName(line_.text[at_]))
      module.name = std::string("~") + line_.text[at_++];
    else if (declared_ && line_.text.compare(at_, 2, "('") == 0 && at_ + 2 < end_ && isName(line_.text[at_ + 2]))
      module.name = surfaceInQuotes();
    else
      error("'~' is followed by the letter of a surface; found " + found());
  } else if (c != 0 && (isName(c) || kSigns.find(c) != std::string_view::npos)) {
    module.name = c;
    ++at_;
  } else {
    error("a module is a letter, a digit, a turtle command or a name of 'modules:'; found " + found());
  }
  if (failed_) return std::nullopt;
  const bool isOpen = module.name.size() == 2 && module.name[0] == '~' && at_ < end_ && line_.text[at_] == ',';
  if (isOpen || (at_ < end_ && line_.text[at_] == '(')) {
    ++at_;
    do {
      Expression argument;
      if (declares) {
        argument.kind = Expression::Kind::name;
        blanks();
        argument.place = place();
        argument.name = identifier();
        if (argument.name.empty()) error("a parameter has a name here; found " + found());
      } else {
        argument = expression();
      }
      if (failed_) return std::nullopt;
      module.arguments.push_back(std::move(argument));
    } while (take(','));
    if (!take(')')) error("expected ',' or ')' in the parameters of '" + module.name + "'; found " + found());
    if (failed_) return std::nullopt;
  }
  return module;
}

ModuleString Reader::modules(std::string_view stops, bool declares) {
  ModuleString all;
  while (!atEnd() && stops.find(peek()) == std::string_view::npos) {
    auto next = module(declares);
    if (!next) break;
    all.push_back(std::move(*next));
  }
  return all;
}

} // namespace gpgp::spawn::lsystem
