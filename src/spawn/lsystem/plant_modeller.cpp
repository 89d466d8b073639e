// Files for the plant modellers cpfg and lpfg, line by line, in the language of .lsys files.
//
// First what the C preprocessor does: comments, macros, lines that go on. Then lines that belong together are joined,
// and headings get the names that they have here. Characters keep the places that they have in the file.
#include "spawn/lsystem/scanner.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

namespace gpgp::spawn::lsystem {
namespace {

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }
bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

std::string lowered(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return result;
}
bool isNamePart(char c) { return isLetter(c) || (c >= '0' && c <= '9'); }
size_t firstOf(std::string_view text) {
  size_t i = 0;
  while (i < text.size() && isBlank(text[i])) ++i;
  return i;
}

/// What a line begins with: words of letters, in small ones, with single blanks between them.
std::string headingOf(std::string_view text) {
  std::string heading;
  for (size_t i = firstOf(text); i < text.size() && (isLetter(text[i]) || isBlank(text[i])); ++i) {
    if (isLetter(text[i])) heading += lowered(text.substr(i, 1));
    if (isBlank(text[i]) && !heading.empty() && heading.back() != ' ') heading += ' ';
  }
  while (!heading.empty() && heading.back() == ' ') heading.pop_back();
  return heading;
}

/// A heading, what it is called here, and whether a ':' has to stand behind it. No name: it says nothing here.
struct Heading {
  std::string_view theirs, ours;
  bool needsColon = true;
};
constexpr Heading kHeadings[] = {{"axiom", "axiom"},
                                 {"derivation length", "iterations"},
                                 {"dlength", "iterations"},
                                 {"stemsize", "width"},
                                 {"ignore", "ignore"},
                                 {"consider", "consider"},
                                 {"homomorphism", "homomorphism", false},
                                 {"interpretation", "homomorphism", false},
                                 {"decomposition", "decomposition", false},
                                 {"production", "productions", false},
                                 {"productions", "productions", false},
                                 {"maximum depth", "depth"},
                                 {"seed", "seed"},
                                 {"start", "start"},
                                 {"starteach", "starteach"},
                                 {"end", "endcode"},
                                 {"endeach", "endeach"},
                                 {"define", "arrays"},
                                 {"lsystem", "lsystem"},
                                 {"endlsystem", "", false},
                                 // what our own files say
                                 {"iterations", "iterations"},
                                 {"angle", "angle"},
                                 {"step", "step"},
                                 {"width", "width"},
                                 {"tropism", "tropism"},
                                 {"modules", "modules"},
                                 {"asset", "asset"},
                                 {"surface", "surface"},
                                 {"segment", "segment"},
                                 {"draw", "draw"},
                                 {"move", "move"}};
const Heading* headingIn(std::string_view text) {
  const std::string name = headingOf(text);
  for (const Heading& h : kHeadings) {
    if (h.theirs != name) continue;
    size_t i = firstOf(text) + h.theirs.size(); // single blanks at least
    while (i < text.size() && (isBlank(text[i]) || isLetter(text[i]))) ++i;
    if ((i < text.size() && text[i] == ':') || (!h.needsColon && i >= text.size())) return &h;
  }
  return nullptr;
}

/// A character with its place, and a text of these.
void append(Line& to, const Line& from, size_t begin, size_t end) {
  to.text.append(from.text, begin, end - begin);
  to.places.insert(to.places.end(), from.places.begin() + static_cast<ptrdiff_t>(begin),
                   from.places.begin() + static_cast<ptrdiff_t>(end));
}
void append(Line& to, std::string_view text, Place place) {
  to.text += text;
  to.places.insert(to.places.end(), text.size(), place);
}

struct Macro {
  bool isFunction = false;
  std::vector<std::string> parameters;
  std::string text;
};

class Preprocessor {
public:
  Preprocessor(Diagnostics& diagnostics, const ReadFile& read, bool isC)
      : diagnostics_(diagnostics), read_(read), isC_(isC) {}

  std::vector<Line> run(std::string_view text) {
    std::vector<Line> lines;
    preprocess(text, nullptr, lines);
    if (!conditions_.empty()) diagnostics_.error({}, "an #ifdef has no #endif");
    return isC_ ? std::move(lines) : logical(lines);
  }

private:
  /// at: the place of the #include that named the text, which its characters then have.
  void preprocess(std::string_view text, const Place* at, std::vector<Line>& lines) {
    std::vector<Line> raw = withoutComments(text);
    for (Line& line : raw) {
      if (at) std::fill(line.places.begin(), line.places.end(), *at);
      const size_t first = firstOf(line.text);
      if (first < line.text.size() && line.text[first] == '#' && first + 1 < line.text.size() &&
          (isLetter(line.text[first + 1]) || isBlank(line.text[first + 1])) && directive(line, first + 1, lines))
        continue;
      if (isSkipping()) continue;
      Line expanded;
      std::set<std::string> open;
      expand(line, expanded, open, 0);
      lines.push_back(std::move(expanded));
    }
  }

  std::vector<Line> withoutComments(std::string_view text) const {
    std::vector<Line> lines(1);
    Place place{1, 1};
    bool inComment = false, toEnd = false, inQuotes = false;
    for (size_t i = 0; i < text.size(); ++i) {
      const char c = text[i];
      const char next = i + 1 < text.size() ? text[i + 1] : '\0';
      const Place at = place;
      if (c == '\n')
        place = {place.line + 1, 1};
      else
        ++place.column;
      if (isC_ && !inComment && !toEnd && c == '"' && (i == 0 || text[i - 1] != '\\')) inQuotes = !inQuotes;
      if (c == '\n') inQuotes = false;
      if (isC_ && !inComment && !inQuotes && c == '/' && next == '/') toEnd = true;
      if (toEnd && c != '\n') continue;
      toEnd = false;
      if (inComment ? c == '*' && next == '/' : c == '/' && next == '*') {
        if (!inComment) append(lines.back(), " ", at);
        inComment = !inComment;
        ++i;
        ++place.column;
      } else if (inComment || c == '\r') {
        continue;
      } else if (c == '\\' && (next == '\n' || (next == '\r' && i + 2 < text.size() && text[i + 2] == '\n'))) {
        i += next == '\r' ? 2 : 1; // a line that goes on
        place = {place.line + 1, 1};
      } else if (c == '\n') {
        lines.emplace_back();
      } else {
        append(lines.back(), text.substr(i, 1), at);
      }
    }
    return lines;
  }

  bool isSkipping() const { return std::find(conditions_.begin(), conditions_.end(), false) != conditions_.end(); }

  /// False: it is none, but text.
  bool directive(const Line& line, size_t at, std::vector<Line>& lines) {
    const Place place = line.places[at - 1];
    const auto word = [&] {
      while (at < line.text.size() && isBlank(line.text[at])) ++at;
      const size_t begin = at;
      while (at < line.text.size() && isNamePart(line.text[at])) ++at;
      return line.text.substr(begin, at - begin);
    };
    const std::string name = word();
    if (name == "ifdef" || name == "ifndef") {
      conditions_.push_back(macros_.contains(word()) == (name == "ifdef"));
    } else if (name == "if") {
      conditions_.push_back(word() != "0");
    } else if (name == "else" || name == "endif") {
      if (conditions_.empty())
        diagnostics_.error(place, "this #" + name + " has no #ifdef before it");
      else if (name == "else")
        conditions_.back() = !conditions_.back();
      else
        conditions_.pop_back();
    } else if (isSkipping()) {
      return true;
    } else if (name == "undef") {
      macros_.erase(word());
    } else if (name == "include") {
      include(line, at, place, lines);
    } else if (name == "define") {
      define(line, at, word, place, lines);
    } else if (name == "ignore" || name == "consider") {
      return false;
    } else {
      diagnostics_.warning(place, "the line '#" + name + " ...' is no directive, and is left out");
    }
    return true;
  }

  void include(const Line& line, size_t at, Place place, std::vector<Line>& lines) {
    const size_t open = line.text.find_first_of("\"<", at);
    if (open != std::string::npos && line.text[open] == '<') return; // of the system, or of the modeller
    const size_t close = open == std::string::npos ? open : line.text.find('"', open + 1);
    if (close == std::string::npos) return diagnostics_.error(place, "#include is followed by a path in quotes");
    const std::string path = line.text.substr(open + 1, close - open - 1);
    std::string text;
    if (depth_ == 16) return diagnostics_.error(place, "#include is nested too deep");
    if (!read_ || !read_(path, text))
      return diagnostics_.warning(place, "'" + path + "' of an #include cannot be read; what it defines is missing");
    ++depth_;
    preprocess(text, &place, lines);
    --depth_;
  }

  template <class Word>
  void define(const Line& line, size_t& at, const Word& word, Place place, std::vector<Line>& lines) {
    const std::string name = word();
    if (name.empty()) return diagnostics_.error(place, "#define is followed by a name");
    Macro macro;
    if (at < line.text.size() && line.text[at] == '(') {
      macro.isFunction = true;
      ++at;
      for (std::string parameter = word(); !parameter.empty(); parameter = word()) {
        macro.parameters.push_back(parameter);
        while (at < line.text.size() && isBlank(line.text[at])) ++at;
        if (at >= line.text.size() || line.text[at] != ',') break;
        ++at;
      }
      if (at >= line.text.size() || line.text[at] != ')')
        return diagnostics_.error(place, "the parameters of '" + name + "' are names in parentheses");
      ++at;
    }
    while (at < line.text.size() && isBlank(line.text[at])) ++at;
    macro.text = line.text.substr(at);
    while (!macro.text.empty() && isBlank(macro.text.back())) macro.text.pop_back();
    // A number is a constant as well, which --set changes; one that names a module has to be replaced.
    const bool isNumber = !macro.isFunction && !macro.text.empty() &&
                          macro.text.find_first_not_of("0123456789.eE+-*/() \t") == std::string::npos &&
                          macro.text.find_first_of("0123456789") != std::string::npos && name.size() > 1;
    if (isNumber && !macros_.contains(name)) {
      Line constant;
      const bool isWhole = macro.text.find_first_of(".eE") == std::string::npos;
      append(constant,
             isC_ ? std::string(isWhole ? "const int " : "const float ") + name + " = " : "define: " + name + " ",
             place);
      append(constant, line, at, at + macro.text.size());
      append(constant, isC_ ? ";" : "", place);
      lines.push_back(std::move(constant));
      macros_.erase(name);
      constants_.insert(name);
      return;
    }
    macros_[name] = std::move(macro);
  }

  void expand(const Line& from, Line& to, std::set<std::string>& open, uint32_t depth) {
    for (size_t i = 0; i < from.text.size();) {
      if (to.text.size() > kLongest) return;
      if (!isLetter(from.text[i])) {
        append(to, from, i, i + 1);
        ++i;
        continue;
      }
      size_t end = i;
      while (end < from.text.size() && isNamePart(from.text[end])) ++end;
      const std::string name = from.text.substr(i, end - i);
      const auto found = macros_.find(name);
      size_t behind = end;
      std::vector<Line> arguments;
      const bool isUsed = found != macros_.end() && !open.contains(name) && depth < 32 &&
                          (!found->second.isFunction || takeArguments(from, behind, arguments));
      if (!isUsed) {
        append(to, from, i, end);
        i = end;
        continue;
      }
      const Macro& macro = found->second;
      if (macro.parameters.empty() && arguments.size() == 1 && firstOf(arguments[0].text) >= arguments[0].text.size())
        arguments.clear(); // name()
      if (macro.isFunction && arguments.size() != macro.parameters.size()) {
        diagnostics_.error(from.places[i], "'" + name + "' takes " + std::to_string(macro.parameters.size()) +
                                               " values, not " + std::to_string(arguments.size()));
        return;
      }
      Line body;
      for (size_t k = 0; k < macro.text.size();) {
        size_t stop = k + 1;
        if (isLetter(macro.text[k]))
          while (stop < macro.text.size() && isNamePart(macro.text[stop])) ++stop;
        const std::string_view piece = std::string_view(macro.text).substr(k, stop - k);
        const auto parameter = std::find(macro.parameters.begin(), macro.parameters.end(), piece);
        if (parameter != macro.parameters.end()) {
          const Line& given = arguments[static_cast<size_t>(parameter - macro.parameters.begin())];
          append(body, given, 0, given.text.size());
        } else {
          append(body, piece, from.places[i]);
        }
        k = stop;
      }
      open.insert(name);
      expand(body, to, open, depth + 1);
      open.erase(name);
      i = behind;
    }
  }

  static bool takeArguments(const Line& from, size_t& at, std::vector<Line>& arguments) {
    size_t i = at;
    while (i < from.text.size() && isBlank(from.text[i])) ++i;
    if (i >= from.text.size() || from.text[i] != '(') return false;
    arguments.emplace_back();
    uint32_t depth = 0;
    for (++i; i < from.text.size(); ++i) {
      const char c = from.text[i];
      if (c == ')' && depth == 0) {
        at = i + 1;
        return true;
      }
      if (c == '(') ++depth;
      if (c == ')') --depth;
      if (c == ',' && depth == 0)
        arguments.emplace_back();
      else
        append(arguments.back(), from, i, i + 1);
    }
    return false;
  }

  /// Joins what belongs together, and gives headings their names here.
  std::vector<Line> logical(std::vector<Line>& lines) {
    std::vector<Line> result;
    const auto isText = [](const Line& line) { return firstOf(line.text) < line.text.size(); };
    const auto beginsWithArrow = [](const Line& line) {
      const std::string_view rest = std::string_view(line.text).substr(firstOf(line.text));
      return rest.starts_with("-->") || rest.starts_with("->");
    };
    const auto endsWithColon = [](const Line& line) {
      const size_t last = line.text.find_last_not_of(" \t");
      return last != std::string::npos && line.text[last] == ':';
    };
    uint32_t systems = 0;
    bool isOfOther = false; // a sub-L-system by number
    for (size_t i = 0; i < lines.size(); ++i) {
      Line& line = lines[i];
      if (!isText(line)) continue;
      int braces = 0;
      const auto count = [&](const Line& l) {
        for (const char c : l.text) braces += c == '{' ? 1 : c == '}' ? -1 : 0;
      };
      const Heading* heading = headingIn(line.text);
      const bool isAlready =
          line.text.starts_with("define: ") && line.text.find('{') == std::string::npos; // of #define
      if (heading && !isAlready) {
        const Place place = line.places[firstOf(line.text)];
        if (heading->ours == "lsystem" && ++systems > 1) { // a sub-system by number
          if (isOfOther) result.push_back(lineOf("end:", place));
          isOfOther = true;
          const float number = std::strtof(line.text.c_str() + line.text.find(':') + 1, nullptr);
          result.push_back(
              lineOf("system: " + numberedSystem(static_cast<uint32_t>(std::clamp(number, 0.0f, 1e6f))), place));
        }
        if (heading->theirs == "endlsystem" && isOfOther) {
          result.push_back(lineOf("end:", place));
          isOfOther = false;
        }
        // Of a sub-system, there are an axiom, sections and productions.
        const bool isOurs = heading->ours == "axiom" || heading->ours == "homomorphism" ||
                            heading->ours == "decomposition" || heading->ours == "productions";
        if (heading->ours.empty() || heading->ours == "lsystem" || (isOfOther && !isOurs)) continue;
        Line made;
        append(made, std::string(heading->ours) + ":", place);
        const size_t colon = line.text.find(':');
        const bool isSection = heading->ours == "homomorphism" || heading->ours == "decomposition";
        // "homomorphism: no warnings" is of what the modeller says.
        const bool isOfWarnings = isSection && line.text.find("warnings", colon) != std::string::npos;
        if (colon != std::string::npos && !isOfWarnings) append(made, line, colon + 1, line.text.size());
        if (heading->ours == "start" || heading->ours == "starteach" || heading->ours == "endcode" ||
            heading->ours == "endeach" || heading->ours == "arrays") {
          // All up to the brace that closes.
          for (count(made); (made.text.find('{') == std::string::npos || braces > 0) && i + 1 < lines.size();) {
            ++i;
            append(made, " ", place);
            append(made, lines[i], 0, lines[i].text.size());
            count(lines[i]);
          }
        } else if (heading->ours == "ignore" || heading->ours == "consider") {
          for (char& c : made.text)
            if (c == '[' || c == ']') c = ' '; // which contexts always see
        }
        result.push_back(std::move(made));
        continue;
      }
      const bool hasArrow = arrowIn(line.text).first != std::string::npos;
      bool begins = isAlready || hasArrow;
      if (hasArrow && beginsWithArrow(line)) begins = result.empty();
      if (!hasArrow && !isAlready && !isBlank(line.text[0])) {
        // What stands before an arrow that begins the next line.
        size_t k = i + 1;
        while (k < lines.size() && (!isText(lines[k]) || arrowIn(lines[k].text).first == std::string::npos) &&
               !headingIn(lines[k].text))
          ++k;
        begins = k < lines.size() && !headingIn(lines[k].text) && (beginsWithArrow(lines[k]) || endsWithColon(line));
      }
      if (begins || result.empty()) {
        if (!assignment(line, result)) result.push_back(std::move(line));
      } else if (!assignment(line, result)) {
        append(result.back(), " ", line.places[0]);
        append(result.back(), line, 0, line.text.size());
      }
    }
    for (Line& line : result) {
      while (!line.text.empty() && isBlank(line.text.back())) {
        line.text.pop_back();
        line.places.pop_back();
      }
      if (!line.text.empty() && line.text.back() == ';' && arrowIn(line.text).first == std::string::npos) {
        line.text.pop_back(); // "derivation length: 5;"
        line.places.pop_back();
      }
      line.places.push_back(line.places.empty() ? Place{1, 1} : line.places.back());
    }
    if (isOfOther) result.push_back(lineOf("end:", {}));
    std::erase_if(result, [](const Line& line) { return firstOf(line.text) >= line.text.size(); });
    return result;
  }
  static Line lineOf(const std::string& text, Place place) {
    Line line;
    append(line, text, place);
    line.places.push_back(place);
    return line;
  }

  /// "n=5; delta = 25.7": settings as some write them. Others are values of names.
  static bool assignment(const Line& line, std::vector<Line>& result) {
    const std::string& t = line.text;
    if (arrowIn(t).first != std::string::npos) return false;
    std::vector<Line> made;
    for (size_t at = 0; at < t.size();) {
      size_t end = std::min(t.find_first_of(t.find_first_of("([{") == std::string::npos ? ";," : ";", at), t.size());
      size_t i = at;
      while (i < end && isBlank(t[i])) ++i;
      const size_t begin = i;
      while (i < end && isNamePart(t[i])) ++i;
      const std::string name = t.substr(begin, i - begin);
      while (i < end && isBlank(t[i])) ++i;
      if (name.empty() && i == end) {
        at = end + 1;
        continue;
      }
      if (name.empty() || i >= end || t[i] != '=') return false;
      Line setting;
      const std::string ours = name == "n"                           ? "iterations: "
                               : name == "delta"                     ? "angle: "
                               : name == "stemsize"                  ? "width: "
                               : name == "view" || name == "display" ? std::string()
                                                                     : "define: " + name + " ";
      if (!ours.empty()) {
        append(setting, ours, line.places[begin]);
        append(setting, line, i + 1, end);
        made.push_back(std::move(setting));
      }
      if (name == "n" || name == "delta" || name == "stemsize") { // it is a name in expressions as well
        Line constant;
        append(constant, "define: " + name + " ", line.places[begin]);
        append(constant, line, i + 1, end);
        made.push_back(std::move(constant));
      }
      at = end + 1;
    }
    for (Line& setting : made) result.push_back(std::move(setting));
    return true;
  }

  static constexpr size_t kLongest = 1u << 20; // characters of a line that macros make
  Diagnostics& diagnostics_;
  const ReadFile& read_;
  bool isC_;
  uint32_t depth_ = 0; ///< of files in each other
  std::map<std::string, Macro> macros_;
  std::set<std::string> constants_;
  std::vector<bool> conditions_;
};

} // namespace

bool isOfPlantModeller(std::string_view text) {
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    const std::string heading = headingOf(line);
    if (heading == "endlsystem") return true;
    if ((heading == "lsystem" || heading == "derivation length" || heading == "dlength" ||
         heading == "maximum depth") &&
        line.find(':') != std::string_view::npos)
      return true;
    if ((heading == "n" || heading == "delta" || heading == "view" || heading == "stemsize") &&
        line.find('=') != std::string_view::npos)
      return true;
    at = end + 1;
  }
  return false;
}

std::vector<Line> plantModellerLines(std::string_view text, Diagnostics& diagnostics, const ReadFile& read) {
  return Preprocessor(diagnostics, read, false).run(text);
}

Line preprocessedC(std::string_view text, Diagnostics& diagnostics, const ReadFile& read) {
  Line whole;
  for (const Line& line : Preprocessor(diagnostics, read, true).run(text)) {
    append(whole, line, 0, line.text.size());
    append(whole, "\n", line.places.empty() ? Place{1, 1} : line.places.back());
  }
  whole.places.push_back(whole.places.empty() ? Place{1, 1} : whole.places.back());
  return whole;
}

} // namespace gpgp::spawn::lsystem
