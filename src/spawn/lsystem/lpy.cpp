// Files of L-Py (.lpy) as L+C, which lpfg.cpp reads: strings become calls of modules, indented Python becomes blocks.
//
// Read is what describes plants: numbers at the head of the file, productions, and in their bodies assignments, if,
// while, for over range(), produce and nproduce, and functions of numbers. Other Python is named with its place.
#include "spawn/lsystem/python.h"

#include "spawn/lsystem/format.h"

#include <algorithm>
#include <set>

namespace gpgp::spawn::lsystem {
namespace {

/// What a command of one or two characters is called in L+C; none: it has no effect here, and is named.
struct Command {
  std::string_view theirs, ours;
};
constexpr Command kCommands[] = {{"+", "Left"},      {"-", "Right"},    {"^", "Up"},          {"&", "Down"},
                                 {"\\", "RollL"},    {"/", "RollR"},    {"|", "TurnAround"},  {"[", "SB"},
                                 {"]", "EB"},        {"{", "SP"},       {".", "PP"},          {"}", "EP"},
                                 {"_", "SetWidth"},  {"!", "SetWidth"}, {",", "SetColor"},    {";", "SetColor"},
                                 {"@O", "Sphere"},   {"@o", "CircleF"}, {"@v", "RollToVert"}, {"%", "Cut"},
                                 {"@Gc", "PointGC"}, {"@Ge", "EndGC"},  {"@Gs", "StartGC"}};
/// Commands by their long names, which are those of L+C or have none there.
constexpr Command kNames[] = {{"Left", "Left"},
                              {"Right", "Right"},
                              {"Up", "Up"},
                              {"Down", "Down"},
                              {"RollL", "RollL"},
                              {"RollR", "RollR"},
                              {"TurnAround", "TurnAround"},
                              {"Sphere", "Sphere"},
                              {"Circle", "CircleF"},
                              {"SetWidth", "SetWidth"},
                              {"SetColor", "SetColor"},
                              {"StartGC", "StartGC"},
                              {"EndGC", "EndGC"},
                              {"SB", "SB"},
                              {"EB", "EB"},
                              {"BP", "SP"},
                              {"EP", "EP"},
                              {"PP", "PP"},
                              {"RollToVert", "RollToVert"}};
constexpr std::string_view kInert[] = {"Frame",
                                       "Box",
                                       "Quad",
                                       "Label",
                                       "Sweep",
                                       "PositionOnGuide",
                                       "SetGuide",
                                       "EndGuide",
                                       "SetContour",
                                       "Elasticity",
                                       "Tropism",
                                       "MoveTo",
                                       "MoveRel",
                                       "LineTo",
                                       "LineRel",
                                       "Pinpoint",
                                       "PinpointRel",
                                       "BRGB",
                                       "Curve",
                                       "BezierPatch",
                                       "Text",
                                       "IncColor",
                                       "DecColor",
                                       "IncWidth",
                                       "DecWidth",
                                       "DivScale",
                                       "MultScale",
                                       "SetScale",
                                       "StartScreenProjection",
                                       "EndScreenProjection",
                                       "EulerAngles",
                                       "TextureUScale",
                                       "TextureVScale"};

class Translator : PyReader {
public:
  Translator(std::string_view text, Diagnostics& diagnostics) : PyReader(diagnostics), lines_(pythonLines(text)) {}

  LpyText run() {
    findNames();
    while (at_ < lines_.size() && !ended_) topLevel();
    result_.code.places.push_back({lines_.empty() ? 1u : lines_.back().places[0].line, 1});
    return std::move(result_);
  }

private:
  /// Names that modules are declared with: `module A, Leaf(x)`.
  void findNames() {
    for (const Command& c : kNames) names_.insert(std::string(c.theirs));
    for (const std::string_view name : kInert) names_.insert(std::string(name));
    for (const PyLine& line : lines_) {
      if (!line.text.starts_with("module ")) continue;
      int open = 0;
      std::string name;
      for (size_t i = 7; i <= line.text.size(); ++i) {
        const char c = i < line.text.size() ? line.text[i] : ',';
        if (open == 0 && (isPyLetter(c) || isPyDigit(c))) {
          name += c;
        } else if (!name.empty()) {
          names_.insert(name);
          declared_.insert(name);
          name.clear();
        }
        if (c == ':') break; // of a scale
        open += c == '(' ? 1 : c == ')' ? -1 : 0;
      }
    }
  }

  // ------------------------------------------------------------ what comes out

  void emit(std::string_view text, Place place) {
    result_.code.text += text;
    result_.code.places.insert(result_.code.places.end(), text.size(), place);
  }
  void passOver(Place place, const std::string& what) {
    if (told_.insert(what).second) diagnostics_.warning(place, what + " is not supported, and is passed over");
  }

  // ------------------------------------------------------------ the file

  void topLevel() {
    const PyLine& line = lines_[at_];
    const std::string& text = line.text;
    const Place place = line.places[0];
    const auto heading = [&](std::string_view name) {
      size_t i = 0, k = 0;
      for (; k < name.size(); ++k) {
        if (name[k] == ' ') {
          if (i >= text.size() || !isPyBlank(text[i])) return false;
          while (i < text.size() && isPyBlank(text[i])) ++i;
        } else if (i >= text.size() || text[i++] != name[k]) {
          return false;
        }
      }
      while (i < text.size() && isPyBlank(text[i])) ++i;
      if (i >= text.size() || text[i] != ':') return false;
      cursor_ = i + 1;
      return true;
    };
    cursor_ = 0;
    if (text.starts_with("endlsystem")) {
      ended_ = true;
    } else if (heading("Axiom") || heading("axiom")) {
      ++at_;
      emit("axiom: ", place);
      string(line);
      emit(";\n", line.places.back());
      return;
    } else if (heading("derivation length")) {
      emit("derivation length: ", place);
      expression(line);
      emit(";\n", line.places.back());
      result_.hasLength = true;
    } else if (heading("maximum depth")) {
      emit("maximum depth: ", place);
      expression(line);
      emit(";\n", line.places.back());
    } else if (heading("production") || heading("productions")) {
      emit("production:\n", place);
      inRules_ = true;
    } else if (heading("homomorphism") || heading("interpretation")) {
      emit("interpretation:\n", place);
      inRules_ = true;
    } else if (heading("decomposition")) {
      emit("decomposition:\n", place);
      inRules_ = true;
    } else if (heading("consider") || heading("ignore")) {
      emit(text.starts_with("c") ? "consider: " : "ignore: ", place);
      string(line);
      emit(";\n", line.places.back());
    } else if (text.starts_with("module ")) {
    } else if (text.starts_with("import ") || text.starts_with("from ") || text == "\"") {
    } else if (text.starts_with("group ") || text.starts_with("endgroup") || text.starts_with("lpyimport")) {
      refuse(place, "L-Py's '" + text.substr(0, text.find_first_of(" :")) + "'");
    } else if (text.starts_with("def ")) {
      return function();
    } else if (inRules_ && isProduction(line)) {
      return production();
    } else {
      statementOfHead(line);
    }
    ++at_;
  }

  /// Numbers, and the angle that a turn has without another one.
  void statementOfHead(const PyLine& line) {
    const std::string& text = line.text;
    constexpr std::string_view kAngle = "setAngleIncrement(";
    if (const size_t call = text.find(kAngle); call != std::string::npos) {
      cursor_ = call + kAngle.size();
      result_.angle = std::strtof(text.c_str() + cursor_, nullptr);
      return;
    }
    const std::string name = word(line);
    if (!name.empty() && assignment(line, name, true)) return;
    passOverBlock(name.empty() ? text.substr(0, 20) : name);
  }

  /// A line, and what is indented behind it.
  void passOverBlock(const std::string& name) {
    passOver(lines_[at_].places[0], "Python's '" + name + "' here");
    const uint32_t indent = lines_[at_].indent;
    while (at_ + 1 < lines_.size() && lines_[at_ + 1].indent > indent) ++at_;
  }

  /// def name(a, b): a function of numbers; others, as Start and EndEach, are passed over.
  void function() {
    const PyLine& line = lines_[at_];
    cursor_ = 4;
    const std::string name = word(line);
    std::string parameters;
    bool isSimple = take(line, '(');
    std::set<std::string> names;
    while (isSimple && !take(line, ')')) {
      const std::string parameter = word(line);
      isSimple = !parameter.empty() && (take(line, ',') || peek(line) == ')');
      if (isSimple) parameters += (names.empty() ? "float " : ", float ") + parameter;
      names.insert(parameter);
    }
    isSimple = isSimple && take(line, ':');
    const uint32_t indent = line.indent;
    size_t end = at_ + 1;
    bool returns = line.text.find("return ") != std::string::npos;
    for (; end < lines_.size() && lines_[end].indent > indent; ++end)
      returns = returns || lines_[end].text.find("return ") != std::string::npos;
    constexpr std::string_view kOfSystem[] = {
        "Start", "End", "StartEach", "EndEach", "StartInterpretation", "EndInterpretation"};
    if (!isSimple || !returns || std::find(std::begin(kOfSystem), std::end(kOfSystem), name) != std::end(kOfSystem)) {
      passOverBlock("def " + name);
      ++at_;
      return;
    }
    emit("float " + name + "(" + parameters + ") ", line.places[0]);
    body(line, names);
  }

  // ------------------------------------------------------------ productions

  /// Modules and contexts, then an arrow, or ':' and a body.
  bool isProduction(const PyLine& line) const {
    const std::string& text = line.text;
    if (text.find("-->") != std::string::npos) return true;
    int open = 0;
    for (size_t i = 0; i < text.size(); ++i) {
      open += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
      if (open == 0 && text[i] == '=') return false;
      if (open == 0 && text[i] == ':') return i > 0;
    }
    return false;
  }

  void production() {
    const PyLine& line = lines_[at_];
    cursor_ = 0;
    std::set<std::string> parameters;
    for (;;) { // contexts and the module, whose values have names
      const char c = peek(line);
      if (c == '<' || c == '>') {
        emit(std::string(" ") + c + " ", placeOf(line));
        ++cursor_;
        continue;
      }
      if (c == ':' || line.text.compare(cursor_, 3, "-->") == 0 || c == 0) break;
      if (!module(line, &parameters)) {
        skip();
        return;
      }
    }
    emit(" : ", placeOf(line));
    if (take(line, ':')) return body(line, parameters);
    cursor_ += 3;
    emit("{ produce ", placeOf(line));
    string(line);
    emit("; }\n", line.places.back());
    ++at_;
  }
  void skip() {
    const uint32_t indent = lines_[at_].indent;
    for (++at_; at_ < lines_.size() && lines_[at_].indent > indent;) ++at_;
  }

  /// What is behind the ':' of the line at_, or indented below it, as a block; at_ is then behind it.
  void body(const PyLine& line, const std::set<std::string>& parameters) {
    emit("{ ", placeOf(line));
    // Names of Python begin where they are set first, and hold to the end.
    std::set<std::string> set;
    const uint32_t indent = line.indent;
    for (size_t i = at_ + 1; i < lines_.size() && lines_[i].indent > indent; ++i) {
      const std::string& text = lines_[i].text;
      size_t k = 0;
      while (k < text.size() && (isPyLetter(text[k]) || (k && isPyDigit(text[k])))) ++k;
      std::string name = text.substr(0, k);
      size_t e = k;
      while (e < text.size() && isPyBlank(text[e])) ++e;
      const bool isSet = e < text.size() && text[e] == '=' && (e + 1 >= text.size() || text[e + 1] != '=');
      if (isSet && !parameters.count(name)) set.insert(name);
    }
    for (const std::string& name : set) emit("float " + name + " = 0; ", line.places[0]);
    suite(line);
    emit("}\n", line.places.back());
  }

  /// Statements behind a ':', on the same line or below it. at_ is then behind them.
  void suite(const PyLine& line) {
    const uint32_t indent = line.indent;
    if (peek(line) != 0) {
      statements(line);
      ++at_;
      return;
    }
    ++at_;
    while (at_ < lines_.size() && lines_[at_].indent > indent) statementLine();
  }

  /// Several on a line, with ';' between them.
  void statements(const PyLine& line) {
    do simple(line);
    while (take(line, ';') && peek(line) != 0);
    if (peek(line) != 0) refuse(placeOf(line), "'" + line.text.substr(cursor_, 12) + "' behind a statement");
  }

  void statementLine() {
    const PyLine& line = lines_[at_];
    cursor_ = 0;
    const std::string name = word(line);
    const Place place = line.places[0];
    if (name == "if" || name == "elif" || name == "while") {
      emit(name == "if" ? "if (" : name == "elif" ? "else if (" : "while (", place);
      expression(line);
      emit(") { ", placeOf(line));
      colon(line);
    } else if (name == "else") {
      emit("else { ", place);
      colon(line);
    } else if (name == "for") {
      const std::string variable = word(line);
      const bool isRange = word(line) == "in" && word(line) == "range" && take(line, '(');
      if (variable.empty() || !isRange) {
        refuse(place, "a loop over anything but range()");
        return skip();
      }
      std::vector<Line> bounds;
      do bounds.push_back(expressionOf(line));
      while (take(line, ','));
      take(line, ')');
      emit("for (float " + variable + " = ", place);
      if (bounds.size() == 1)
        emit("0.0", place);
      else
        append(bounds[0]);
      emit("; " + variable + " < ", place);
      append(bounds[bounds.size() == 1 ? 0 : 1]);
      emit("; " + variable + " = " + variable + " + ", place);
      if (bounds.size() > 2)
        append(bounds[2]);
      else
        emit("1.0", place);
      emit(") { ", place);
      colon(line);
    } else {
      cursor_ = 0;
      statements(line);
      ++at_;
      return;
    }
    suite(line);
    emit("} ", line.places.back());
  }
  void colon(const PyLine& line) {
    if (!take(line, ':')) diagnostics_.error(placeOf(line), "expected ':' here");
  }

  void simple(const PyLine& line) {
    const size_t first = cursor_;
    const Place place = placeOf(line);
    const std::string name = word(line);
    if (name == "produce" || name == "nproduce") {
      emit(name + " ", place);
      string(line);
      emit("; ", placeOf(line));
    } else if (name == "return") {
      emit("return ", place);
      if (peek(line) != 0) expression(line);
      emit("; ", placeOf(line));
    } else if (name == "break" || name == "continue") {
      emit(name + "; ", place);
    } else if (name == "pass" || name == "print" || name == "global") {
      cursor_ = line.text.size();
    } else if (name == "if" || name == "for" || name == "while") {
      refuse(place, "'" + name + "' behind the ':' of another line");
      cursor_ = line.text.size();
    } else if (name.empty() || !assignment(line, name, false)) {
      if (line.text != "\"") refuse(place, "Python's '" + line.text.substr(first, 20) + "'");
      cursor_ = line.text.size();
    }
  }

  /// name = value, name += value. False: it is none.
  bool assignment(const PyLine& line, const std::string& name, bool declares) {
    const char c = peek(line);
    const bool isChange = std::string_view("+-*/").find(c) != std::string_view::npos && c != 0 &&
                          cursor_ + 1 < line.text.size() && line.text[cursor_ + 1] == '=';
    if (!isChange && (c != '=' || (cursor_ + 1 < line.text.size() && line.text[cursor_ + 1] == '='))) return false;
    const Place place = line.places[0];
    cursor_ += isChange ? 2 : 1;
    if (declares && !isNumber(line)) return false;
    const Line value = expressionOf(line);
    emit((declares ? "float " : "") + name + " = ", place);
    if (isChange) emit(name + " " + c + " (", place);
    append(value);
    emit(isChange ? "); " : "; ", place);
    if (declares) emit("\n", place);
    return true;
  }
  /// Whether a value at the head of a file can be a number: it names no object, list or text.
  bool isNumber(const PyLine& line) const {
    int open = 0;
    for (size_t i = cursor_; i < line.text.size(); ++i) {
      const char c = line.text[i];
      open += c == '(' ? 1 : c == ')' ? -1 : 0;
      if (c == '"' || c == '[' || c == '{' || (c == ',' && open == 0)) return false;
      const bool isAttribute =
          c == '.' && i > 0 && isPyLetter(line.text[i - 1]) && i + 1 < line.text.size() && isPyLetter(line.text[i + 1]);
      if (isAttribute && !(i >= 4 && line.text.compare(i - 4, 4, "math") == 0)) return false;
    }
    return true;
  }

  // ------------------------------------------------------------ strings

  /// Modules up to the end of the line.
  void string(const PyLine& line) {
    while (peek(line) != 0)
      if (!module(line, nullptr)) {
        cursor_ = line.text.size();
        return;
      }
  }

  /// One module. parameters: its values have names, which are added there.
  bool module(const PyLine& line, std::set<std::string>* parameters) {
    peek(line);
    const Place place = placeOf(line);
    const std::string& text = line.text;
    std::string name;
    for (auto it = names_.rbegin(); it != names_.rend(); ++it)
      if (it->size() > name.size() && text.compare(cursor_, it->size(), *it) == 0) name = *it;
    if (name.empty() && text[cursor_] == '@') {
      const size_t length =
          (cursor_ + 1 < text.size() && std::string_view("GD2").find(text[cursor_ + 1]) != std::string_view::npos) ? 3
                                                                                                                   : 2;
      name = text.substr(cursor_, length);
    }
    if (name.empty()) name = text.substr(cursor_, 1);
    cursor_ += name.size();
    std::vector<Line> values;
    if (cursor_ < text.size() && text[cursor_] == '(') {
      ++cursor_;
      while (peek(line) != ')' && peek(line) != 0) {
        if (parameters) {
          const std::string parameter = word(line);
          if (parameter.empty() || (peek(line) != ',' && peek(line) != ')')) {
            refuse(placeOf(line), "a value that is not a name, in front of an arrow or ':',");
            return false;
          }
          parameters->insert(parameter);
          values.push_back({parameter, std::vector<Place>(parameter.size() + 1, place)});
        } else {
          values.push_back(expressionOf(line));
        }
        if (!take(line, ',') && peek(line) != ')') {
          refuse(placeOf(line), "'" + text.substr(cursor_, 12) + "' in the values of '" + name + "'");
          return false;
        }
      }
      if (!take(line, ')')) {
        diagnostics_.error(placeOf(line), "expected ')' in the values of '" + name + "'");
        return false;
      }
    }
    call(name, values, place);
    return true;
  }

  void call(const std::string& name, std::vector<Line>& values, Place place) {
    std::string ours;
    if (!declared_.count(name)) {
      for (const Command& c : kCommands)
        if (c.theirs == name) ours = c.ours;
      for (const Command& c : kNames)
        if (c.theirs == name) ours = c.ours;
      const bool isInert = std::find(std::begin(kInert), std::end(kInert), name) != std::end(kInert);
      const bool needsValue = ours == "SetWidth" || ours == "SetColor";
      if (isInert || (ours.empty() && !isPyLetter(name[0]) && !isPyDigit(name[0])) || (needsValue && values.empty())) {
        if (told_.insert(name).second)
          diagnostics_.warning(place, "the command '" + name + "'" + (needsValue ? " without a value" : "") +
                                          " is not supported, and has no effect");
        return;
      }
    }
    const bool isSegment = ours.empty() && name == "F" && values.size() == 2;
    if (ours.empty()) ours = symbol(name);
    if ((ours == "SetColor" || ours == "Sphere" || ours == "SetWidth") && values.size() > 1) values.resize(1);
    emit(ours + "(", place);
    for (size_t i = 0; i < values.size() && !(isSegment && i); ++i) {
      if (i) emit(", ", place);
      append(values[i]);
    }
    emit(") ", place);
    if (!isSegment) return; // F(length, width at its end)
    emit("SetWidth(", place);
    append(values[1]);
    emit(") ", place);
  }

  /// Letters that are commands here and none there, and names that L+C could not read, get others.
  std::string symbol(const std::string& name) const {
    if (name == "F" || name == "f") return name;
    if (isPyDigit(name[0])) return "_" + name;
    const bool isOurs = turtleOf(name) != shader::kTurtleNone || isTypeName(name);
    return isOurs ? name + "_" : name;
  }

  void append(const Line& value) {
    result_.code.text += value.text;
    result_.code.places.insert(result_.code.places.end(), value.places.begin(),
                               value.places.begin() + static_cast<ptrdiff_t>(value.text.size()));
  }
  void expression(const PyLine& line) { append(expressionOf(line)); }

  std::vector<PyLine> lines_;
  size_t at_ = 0;
  bool inRules_ = false, ended_ = false;
  std::set<std::string> names_, declared_, told_;
  LpyText result_;
};

} // namespace

bool isOfLpy(std::string_view text) {
  bool hasAxiom = false, hasRules = false;
  for (size_t at = 0; at < text.size();) {
    const size_t newline = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, newline - at);
    at = newline + 1;
    while (!line.empty() && isPyBlank(line.back())) line.remove_suffix(1);
    hasAxiom = hasAxiom || line.starts_with("Axiom:") || line.starts_with("Axiom :");
    hasRules = hasRules || line == "production:" || line.starts_with("__") || line.starts_with("def ") ||
               line.starts_with("from ") || line.starts_with("import ");                                    // of Python
    if (line.ends_with(";") && (line.starts_with("Axiom") || line.starts_with("derivation"))) return false; // L+C
  }
  return hasAxiom && hasRules;
}

LpyText translateLpy(std::string_view text, Diagnostics& diagnostics) { return Translator(text, diagnostics).run(); }

} // namespace gpgp::spawn::lsystem
