// Files in L+C, the language of the plant modeller lpfg, as a File.
//
// L+C is C++ with productions. Here it is what describes plants: modules with numbers, productions whose bodies have
// if, loops, local variables and produce, constants, arrays, functions that return a value. A production becomes one
// for each way through its body, under the conditions of that way (statements.h). Other C++ is named, and passed over.
#include "core/suggest.h"
#include "spawn/lsystem/format.h"
#include "spawn/lsystem/scanner.h"
#include "spawn/lsystem/statements.h"

#include <algorithm>

namespace gpgp::spawn::lsystem {
namespace {

using namespace shader;

/// What L+C calls the commands of the turtle.
struct Command {
  std::string_view theirs, ours;
};
constexpr Command kCommands[] = {{"Left", "+"},
                                 {"Right", "-"},
                                 {"Up", "^"},
                                 {"Down", "&"},
                                 {"RollL", "\\"},
                                 {"RollR", "/"},
                                 {"TurnAround", "|"},
                                 {"SB", "["},
                                 {"EB", "]"},
                                 {"SetWidth", "!"},
                                 {"SetColor", ";"},
                                 {"SP", "{"},
                                 {"PP", "."},
                                 {"EP", "}"},
                                 {"Sphere", "@O"},
                                 {"Sphere0", "@O"},
                                 {"Circle", "@o"},
                                 {"Circle0", "@o"},
                                 {"CircleF", "@c"},
                                 {"CircleF0", "@c"},
                                 {"CircleB", "@c"},
                                 {"CircleB0", "@c"},
                                 {"RollToVert", "@v"},
                                 {"Cut", "%"},
                                 {"StartGC", "@Gs"},
                                 {"PointGC", "@Gc"},
                                 {"EndGC", "@Ge"},
                                 {"IncColor", "'"},
                                 {"SetElasticity", "T"},
                                 {"LineWidth", "!"}};
/// Commands of lpfg that draw or turn in a way that there is none of here.
constexpr std::string_view kInert[] = {"SetHead",      "SetHead3f",       "MoveTo",         "MoveTo3f",
                                       "MoveTo3d",     "MoveRel3f",       "MoveRel3d",      "Line3f",
                                       "Line3d",       "LineTo3f",        "LineRel3f",      "LineTo3d",
                                       "LineRel3d",    "Label",           "Mesh",           "GetPos",
                                       "GetHead",      "GetUp",           "GetLeft",        "DecColor",
                                       "DecWidth",     "IncWidth",        "InitSurface",    "DSurface",
                                       "EDSurface",    "Camera",          "Rotate",         "RotateXYZ",
                                       "ScaleContour", "CurrentContour",  "CurrentTexture", "BlendedContour",
                                       "Elasticity",   "SetCurrentColor", "PointStyle",     "E1",
                                       "E2",           "Tropism1",        "SetColorRGB",    "SetColorAlpha",
                                       "Orient",       "ContourSides",    "TextureVCoeff",  "GCPrecision",
                                       "SetGCOrient"};

class Lpfg {
public:
  /// isOfLpy: a way that ends without produce, but with what nproduce said, has produced that.
  Lpfg(Line code, Diagnostics& diagnostics, std::span<const Override> overrides, bool isOfLpy)
      : diagnostics_(diagnostics), overrides_(overrides), line_(std::move(code)), execution_(diagnostics, values_),
        r_(line_, 0, line_.text.size() - (line_.text.empty() ? 0 : 1), diagnostics, names_) {
    declared_.isC = true;
    isOfLpy_ = isOfLpy;
    file_.systems.emplace_back();
    file_.segmentShape = GPGP_SHAPE_PRISM6;
    file_.isOfModeller = true;
    r_.know(declared_, [this](const Expression& e) { return execution_.valueOf(e); });
  }

  File run() {
    while (!r_.atEnd() && !failed_) item();
    if (!file_.systems[0].axiom && !diagnostics_.hasErrors())
      diagnostics_.error({}, "there is no axiom; 'axiom: F(1);' is where derivation begins");
    if (!stepCode_.empty() || !endCode_.empty()) runSteps();
    return std::move(file_);
  }

private:
  /// A heading, a declaration or a production.
  void item() {
    if (r_.take(';')) return;
    const size_t before = r_.at();
    const Place place = r_.place();
    const std::string name = r_.identifier();
    if (name.empty()) return fail("expected a declaration or a production; found " + r_.found());
    if (heading(name, place)) return;
    r_.goTo(before);
    if (isProduction()) return production();
    declaration();
  }
  void fail(std::string text) {
    r_.error(std::move(text));
    failed_ = true;
  }
  void end() {
    if (!r_.failed() && !r_.take(';')) r_.error("expected ';'; found " + r_.found());
    failed_ = failed_ || r_.failed();
  }

  bool heading(const std::string& name, Place place) {
    const std::string key = lowered(name);
    const size_t before = r_.at();
    const auto colon = [&] { return r_.take(':'); };
    if (key == "derivation" && lowered(r_.identifier()) == "length" && colon()) {
      file_.settings.iterations = r_.expression();
      return end(), true;
    }
    if (key == "maximum" && lowered(r_.identifier()) == "depth" && colon()) {
      const Expression depth = r_.expression();
      (phase_ == kPhaseDecomposition ? file_.settings.decompositions : file_.settings.homomorphisms) = depth;
      return end(), true;
    }
    if (key == "ring" && r_.identifier() == "L" && r_.take('-') && lowered(r_.identifier()) == "system" && colon()) {
      const auto value = execution_.valueOf(r_.expression());
      if (value && *value != 0) diagnostics_.warning(place, "rings are not supported; the string has two ends");
      return end(), true;
    }
    r_.goTo(before);
    if (name == "module") return modules(), true;
    if (r_.peek() != ':') return false;
    if (key == "axiom") {
      colon();
      ModuleString string = r_.calls();
      Way way;
      std::vector<Statement> statement(1);
      statement[0].kind = Statement::Kind::produce;
      statement[0].modules = std::move(string);
      if (!r_.failed())
        for (Way& w : once().run(statement, Way{})) file_.systems[0].axiom = commands(std::move(w.modules));
      return end(), true;
    }
    if (key == "production" || key == "decomposition" || key == "interpretation" || key == "homomorphism") {
      colon();
      phase_ = key == "production" ? kPhaseMain : key == "decomposition" ? kPhaseDecomposition : kPhaseHomomorphism;
      return true;
    }
    if (key == "ignore" || key == "consider") {
      colon();
      file_.considers = key == "consider";
      auto& list = file_.considers ? file_.considered : file_.ignored;
      for (const Module& m : r_.calls()) list.push_back(commandOf(m.name));
      return end(), true;
    }
    if (key == "start" || key == "starteach" || key == "endeach" || key == "end") {
      colon();
      const std::vector<Statement> block = r_.block();
      failed_ = failed_ || r_.failed();
      if (failed_) return true;
      if (key == "start") {
        Execution start = once();
        std::vector<Way> ways = start.run(block, Way{});
        if (!ways.empty()) keep(std::move(ways[0]), place);
      } else if (key == "starteach") {
        takeChanging(stepCode_ = block, values_, start_);
      } else if (key == "endeach") {
        takeChanging(endCode_ = block, values_, start_);
      }
      return true;
    }
    return false;
  }

  static std::string lowered(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return text;
  }

  /// module A(int, float), B();
  void modules() {
    do {
      const Place place = r_.place();
      const std::string name = r_.identifier();
      if (name.empty()) return fail("expected the name of a module; found " + r_.found());
      std::vector<bool> whole;
      if (r_.take('(') && !r_.take(')')) {
        do {
          std::string type;
          bool isWhole = false;
          for (std::string word = r_.identifier(); !word.empty(); word = r_.identifier()) {
            if (isTypeName(word) || type.empty()) {
              type = word;
              isWhole = isWhole || isWholeType(word);
            }
          }
          if (!isTypeName(type))
            diagnostics_.warning(place, "the parameter '" + type + "' of module '" + name +
                                            "' is no number; it is read as one");
          if (r_.take('[')) return fail("a module's parameters are numbers, not arrays");
          whole.push_back(isWhole);
        } while (r_.take(','));
        if (!r_.take(')')) return fail("expected ',' or ')' in the parameters of '" + name + "'; found " + r_.found());
      }
      modules_[name] = std::move(whole);
    } while (r_.take(','));
    end();
  }

  /// Whether modules with names in parentheses are followed by ':', as a production's predecessor is.
  bool isProduction() {
    const size_t before = r_.at();
    uint32_t open = 0;
    for (size_t i = before; i < line_.text.size(); ++i) {
      const char c = line_.text[i];
      if (c == '(') ++open;
      if (c == ')' && open) --open;
      if (!open && (c == ';' || c == '{' || c == '=')) break;
      if (!open && c == ':') {
        if (line_.text[i + 1] != ':') return true;
        ++i; // of C++
      }
    }
    return false;
  }

  /// Modules with names for their values, of a predecessor or context.
  ModuleString pattern() {
    ModuleString all;
    while (!r_.failed()) {
      const char c = r_.peek();
      if (c == '<' || c == '>' || c == ':' || c == 0) break;
      Module module;
      module.place = r_.place();
      module.name = r_.identifier();
      if (module.name.empty()) {
        r_.error("expected a module; found " + r_.found());
        break;
      }
      if (r_.take('(') && !r_.take(')')) {
        do {
          Expression parameter;
          parameter.kind = Expression::Kind::name;
          parameter.place = r_.place();
          parameter.name = r_.identifier();
          if (isTypeName(parameter.name)) parameter.name = r_.identifier();
          if (parameter.name.empty()) r_.error("a parameter has a name here; found " + r_.found());
          module.arguments.push_back(std::move(parameter));
        } while (!r_.failed() && r_.take(','));
        if (!r_.take(')')) r_.error("expected ',' or ')' in the parameters; found " + r_.found());
      }
      const auto declared = modules_.find(module.name);
      for (size_t i = 0; i < module.arguments.size(); ++i) {
        const bool isWhole = declared != modules_.end() && i < declared->second.size() && declared->second[i];
        if (isWhole)
          declared_.whole.insert(module.arguments[i].name);
        else
          declared_.whole.erase(module.arguments[i].name);
      }
      module.name = commandOf(module.name);
      all.push_back(std::move(module));
    }
    return all;
  }

  void production() {
    const std::set<std::string> whole = declared_.whole;
    const Place place = r_.place();
    std::vector<ModuleString> parts;
    std::string separators;
    for (;;) {
      parts.push_back(pattern());
      const char c = r_.peek();
      if (r_.failed() || (c != '<' && c != '>')) break;
      r_.take(c);
      if (r_.take(c)) diagnostics_.warning(place, "a context of the new string ('<<', '>>') is read in the old one");
      separators += c;
    }
    if (!r_.failed() && separators != "" && separators != "<" && separators != ">" && separators != "<>")
      r_.errorAt(place, "a production is 'left < predecessor > right : { ... }'");
    r_.take(':');
    const std::vector<Statement> block = r_.block();
    failed_ = failed_ || r_.failed();
    declared_.whole = whole;
    if (failed_) return;
    const size_t middle = separators.starts_with("<") ? 1 : 0;
    if (parts[middle].size() != 1)
      return diagnostics_.error(place,
                                "a production rewrites one module; found " + std::to_string(parts[middle].size()));
    Production production;
    production.phase = phase_;
    production.place = place;
    if (middle) production.left = std::move(parts[0]);
    if (parts.size() > middle + 1) production.right = std::move(parts[middle + 1]);
    production.predecessor = std::move(parts[middle][0]);
    const auto add = [&](Way&& way) {
      if (way.stop == Statement::Stop::all) return; // return: nothing is produced
      Production p = production;
      for (Expression& condition : way.conditions) {
        if (!p.condition) {
          p.condition = std::move(condition);
          continue;
        }
        Expression both;
        both.kind = Expression::Kind::operation;
        both.code = kLsysAnd;
        both.place = place;
        both.operands.push_back(std::move(*p.condition));
        both.operands.push_back(std::move(condition));
        p.condition = std::move(both);
      }
      p.successor = commands(std::move(way.modules));
      file_.systems[0].productions.push_back(std::move(p));
    };
    for (Way& way : execution_.run(block, Way{}, add))
      if (isOfLpy_ && !way.modules.empty()) add(std::move(way));
  }

  std::string commandOf(const std::string& name) const {
    for (const Command& c : kCommands)
      if (c.theirs == name && !modules_.contains(name)) return std::string(c.ours);
    return name;
  }

  /// Commands get their names here, integers drop what is behind the point, surfaces their numbers.
  ModuleString commands(ModuleString string) {
    ModuleString all;
    for (Module& m : string) {
      const auto declared = modules_.find(m.name);
      if (declared == modules_.end() && std::find(std::begin(kInert), std::end(kInert), m.name) != std::end(kInert)) {
        if (inert_.insert(m.name).second)
          diagnostics_.warning(m.place, "the command '" + m.name + "' is not supported, and has no effect");
        continue;
      }
      if (declared == modules_.end() && m.name == "Surface" && !m.arguments.empty()) {
        const auto number = execution_.valueOf(m.arguments[0]);
        m.name = std::string("~") + static_cast<char>('a' + static_cast<int>(number.value_or(0)) % 26);
        m.arguments.erase(m.arguments.begin());
        if (m.arguments.size() > 1) m.arguments.resize(1);
      }
      if (declared != modules_.end() && declared->second.size() == m.arguments.size())
        for (size_t i = 0; i < m.arguments.size(); ++i)
          if (declared->second[i] && !m.arguments[i].isWhole) {
            Expression whole;
            whole.kind = Expression::Kind::operation;
            whole.code = kLsysTruncate;
            whole.place = m.arguments[i].place;
            whole.isWhole = true;
            whole.operands.push_back(std::move(m.arguments[i]));
            m.arguments[i] = std::move(whole);
          }
      const std::string name = commandOf(m.name);
      if (name != m.name && (m.name == "Sphere0" || m.name.starts_with("Circle"))) m.name = name;
      if (name == "!" || name == ";" || name == "'" || name == "@O" || name == "@o" || name == "@c" || name == "T")
        if (m.arguments.size() > 1) m.arguments.resize(1);
      m.name = name;
      all.push_back(std::move(m));
    }
    return all;
  }

  // ------------------------------------------------------------ C++

  /// A constant, a variable, an array or a function of the file. Others are passed over.
  void declaration() {
    const size_t before = r_.at();
    const Place place = r_.place();
    bool isWhole = false, isType = false;
    std::string word = r_.identifier();
    for (; isTypeName(word); word = r_.identifier()) {
      isType = word != "struct" || isType;
      isWhole = isWholeType(word) || isWhole;
      if (word == "float" || word == "double") isWhole = false;
    }
    if (!isType && word == "void") isType = true, word = r_.identifier();
    if (!isType || word.empty() || r_.peek() == '*') {
      r_.goTo(before);
      return passOver(place);
    }
    if (r_.peek() == '(') return function(word, isWhole, place);
    r_.goTo(before);
    while (isTypeName(word = r_.identifier())) {
    }
    r_.goTo(r_.at() - word.size());
    std::vector<Statement> block;
    do r_.declaration(block, isWhole);
    while (!r_.failed() && r_.take(','));
    end();
    if (failed_) return;
    Execution start = once();
    std::vector<Way> ways = start.run(block, Way{});
    if (!ways.empty()) keep(std::move(ways[0]), place);
  }

  /// float f(float x) { ... return value; }: an expression of its parameters.
  void function(const std::string& name, bool isWhole, Place place) {
    Declared::Function made;
    const std::set<std::string> whole = declared_.whole;
    bool isSimple = true;
    r_.take('(');
    while (!r_.failed() && !r_.take(')')) {
      bool isInteger = false;
      std::string word = r_.identifier();
      for (; isTypeName(word); word = r_.identifier()) isInteger = isWholeType(word) || isInteger;
      if (r_.peek() == '*' || r_.peek() == '&' || r_.peek() == '[') isSimple = false;
      while (r_.take('*') || r_.take('&') || r_.take('[') || r_.take(']')) word = r_.identifier();
      if (word != "void") made.parameters.push_back(word);
      if (isInteger) declared_.whole.insert(word);
      if (!r_.take(',') && r_.peek() != ')') {
        isSimple = false;
        if (r_.identifier().empty() && r_.peek() != ')') return r_.goTo(r_.at() + 1);
      }
    }
    if (r_.take(';')) { // its body follows elsewhere
      declared_.whole = whole;
      return;
    }
    if (!isSimple) {
      declared_.whole = whole;
      diagnostics_.warning(place, "the function '" + name + "' is not supported, and is passed over");
      return passOverBlock();
    }
    const size_t before = r_.at();
    const std::vector<Statement> block = r_.block();
    declared_.whole = whole;
    if (r_.failed()) {
      failed_ = true;
      return r_.goTo(before);
    }
    Execution execution(diagnostics_, values_);
    std::vector<Way> ends;
    execution.run(block, Way{}, [&](Way&& way) { ends.push_back(std::move(way)); });
    if (ends.empty() || std::any_of(ends.begin(), ends.end(), [](const Way& w) { return !w.result; })) return;
    made.value = *ends.back().result;
    for (size_t i = ends.size() - 1; i-- > 0;) {
      Expression condition;
      condition.number = 1;
      for (Expression& c : ends[i].conditions) {
        Expression both;
        both.kind = Expression::Kind::operation;
        both.code = kLsysAnd;
        both.place = place;
        both.operands.push_back(std::move(condition));
        both.operands.push_back(std::move(c));
        condition = std::move(both);
      }
      Expression value;
      value.kind = Expression::Kind::operation;
      value.code = kLsysSelect;
      value.place = place;
      value.operands.push_back(std::move(condition));
      value.operands.push_back(std::move(*ends[i].result));
      value.operands.push_back(std::move(made.value));
      made.value = std::move(value);
    }
    if (isWhole && !made.value.isWhole) {
      Expression truncated;
      truncated.kind = Expression::Kind::operation;
      truncated.code = kLsysTruncate;
      truncated.place = place;
      truncated.operands.push_back(std::move(made.value));
      made.value = std::move(truncated);
    }
    made.value.isWhole = isWhole;
    declared_.functions[name] = std::move(made);
  }

  /// Up to the ';' or the block that ends a declaration.
  void passOver(Place place) {
    const size_t first = r_.at();
    const std::string word = r_.identifier();
    bool hasEnd = word == "typedef" || word == "struct" || word == "class" || word == "union" || word == "enum";
    while (!r_.atEnd()) {
      const char c = r_.peek();
      hasEnd = hasEnd || c == '=';
      if (c == '{') {
        passOverBlock();
        if (!hasEnd && r_.peek() != ';') break;
        continue;
      }
      if (c == '(') {
        r_.passOverArguments();
        continue;
      }
      r_.goTo(r_.at() + 1);
      if (c == ';') break;
    }
    const std::string text = line_.text.substr(first, std::min<size_t>(r_.at() - first, 40));
    diagnostics_.warning(place,
                         "this C++ is not supported, and is passed over: '" + text.substr(0, text.find('\n')) + "'");
  }
  void passOverBlock() {
    uint32_t open = 0;
    do {
      const char c = r_.peek();
      if (c == '{') ++open;
      if (c == '}') --open;
      if (!r_.atEnd()) r_.goTo(r_.at() + 1);
    } while (open && !r_.atEnd());
  }

  // ------------------------------------------------------------ values

  /// For code that runs once.
  Execution once() {
    Execution e(diagnostics_, values_);
    e.drawNumbers(drawn_ += 0x10000u);
    return e;
  }
  void keep(Way way, Place place) {
    for (auto& [name, value] : way.values) {
      std::erase_if(file_.constants, [&, n = &name](const Constant& c) { return c.name == *n; });
      auto number = execution_.valueOf(value);
      for (const Override& o : overrides_)
        if (o.name == name) number = o.value;
      if (number) values_[name] = *number;
      file_.constants.push_back({name, std::move(value), place});
      globals_.insert(name);
    }
    execution_.guard(globals_);
  }

  void runSteps() {
    const auto iterations = file_.settings.iterations ? execution_.valueOf(*file_.settings.iterations) : std::nullopt;
    file_.stepped = steppedValues(stepCode_, endCode_, iterations.value_or(0), start_, [this] { return once(); });
  }

  Diagnostics& diagnostics_;
  std::span<const Override> overrides_;
  Line line_;
  std::set<std::string> names_;
  std::map<std::string, float> values_;
  Execution execution_;
  Declared declared_;
  Reader r_;
  File file_;
  std::map<std::string, std::vector<bool>> modules_; ///< which parameters are integers
  std::set<std::string> globals_, inert_;
  std::vector<Statement> stepCode_, endCode_;
  std::map<std::string, float> start_; ///< of values that code of steps changes
  uint32_t phase_ = kPhaseMain, drawn_ = 0;
  bool failed_ = false, isOfLpy_ = false;
};

} // namespace

bool isOfLpfg(std::string_view text) {
  if (text.find("lpfgall.h") != std::string_view::npos) return true;
  const bool produces =
      text.find("produce ") != std::string_view::npos || text.find("produce\n") != std::string_view::npos;
  for (size_t at = 0; produces && at < text.size();) {
    const size_t newline = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, newline - at);
    if (line.starts_with("module ") && line.find('(') != std::string_view::npos &&
        line.find(';') != std::string_view::npos)
      return true;
    at = newline + 1;
  }
  return false;
}

File parseLpfg(std::string_view text, Diagnostics& diagnostics, std::span<const Override> overrides,
               const ReadFile& read) {
  return Lpfg(preprocessedC(text, diagnostics, read), diagnostics, overrides, false).run();
}

File parseLpy(std::string_view text, Diagnostics& diagnostics, std::span<const Override> overrides) {
  LpyText translated = translateLpy(text, diagnostics);
  File file = Lpfg(std::move(translated.code), diagnostics, overrides, true).run();
  const auto set = [](std::optional<Expression>& setting, float value) {
    setting.emplace();
    setting->number = value;
  };
  set(file.settings.angle, translated.angle);
  if (!translated.hasLength) set(file.settings.iterations, 1);
  return file;
}

} // namespace gpgp::spawn::lsystem
