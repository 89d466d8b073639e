// Lines of a .lsys file to a File.
#include "core/suggest.h"
#include "spawn/lsystem/format.h"
#include "spawn/lsystem/scanner.h"
#include "spawn/lsystem/statements.h"

#include <algorithm>
#include <functional>

namespace gpgp::spawn::lsystem {
namespace {

struct ShapeName {
  std::string_view name;
  GpgpShape shape;
};
constexpr ShapeName kShapes[] = {
    {"triangle", GPGP_SHAPE_TRIANGLE}, {"quad", GPGP_SHAPE_QUAD},         {"pentagon", GPGP_SHAPE_PENTAGON},
    {"hexagon", GPGP_SHAPE_HEXAGON},   {"heptagon", GPGP_SHAPE_HEPTAGON}, {"octagon", GPGP_SHAPE_OCTAGON},
    {"prism3", GPGP_SHAPE_PRISM3},     {"box", GPGP_SHAPE_BOX},           {"prism5", GPGP_SHAPE_PRISM5},
    {"prism6", GPGP_SHAPE_PRISM6},     {"prism7", GPGP_SHAPE_PRISM7},     {"prism8", GPGP_SHAPE_PRISM8},
    {"sphere", GPGP_SHAPE_SPHERE},
};

class Parser {
public:
  Parser(std::string_view text, Diagnostics& diagnostics, std::span<const Override> overrides, const ReadFile& read)
      : diagnostics_(diagnostics), overrides_(overrides), isForeign_(isOfPlantModeller(text)),
        lines_(isForeign_ ? plantModellerLines(text, diagnostics, read) : linesOf(text)),
        execution_(diagnostics, values_) {
    file_.systems.emplace_back();
    file_.segmentShape = GPGP_SHAPE_PRISM6;
    file_.isOfModeller = isForeign_;
  }

  File run() {
    // Names of several letters decide how strings are read, wherever they are declared.
    for (const Line& line : lines_) {
      const auto [name, behind] = head(line);
      if (name == "modules" && arrowIn(line.text).first == std::string::npos) readNames(line, behind);
    }
    for (const Line& line : lines_) readLine(line);
    if (!stepCode_.empty() || !endCode_.empty()) runSteps();
    if (!file_.systems[0].axiom && !brokenAxiom_)
      diagnostics_.error({}, "there is no axiom; a line 'axiom: F' is where derivation begins");
    return std::move(file_);
  }

private:
  /// The name before ':', in small letters, and where the rest begins; no name where the line has none.
  static std::pair<std::string, size_t> head(const Line& line) {
    const std::string& text = line.text;
    size_t i = text.find_first_not_of(" \t\n");
    const bool directive = text[i] == '#';
    if (directive) ++i;
    std::string name;
    const auto isName = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    };
    while (i < text.size() && isName(text[i])) name += text[i++];
    while (i < text.size() && (text[i] == ' ' || text[i] == '\t')) ++i;
    if (i < text.size() && text[i] == ':') return {name, i + 1};
    if (!name.empty() && (directive || name == "define")) return {name, i};
    return {{}, 0};
  }

  Reader reader(const Line& line, size_t begin, size_t end) {
    Reader r(line, begin, end, diagnostics_, names_);
    if (isForeign_) r.know(declared_, [this](const Expression& e) { return execution_.valueOf(e); });
    return r;
  }

  void readNames(const Line& line, size_t at) {
    Reader r = reader(line, at, line.text.size());
    while (!r.atEnd()) {
      const Place place = r.place();
      const std::string name = r.identifier();
      if (name.empty()) return r.error("a module's name has letters and digits; found " + r.found());
      if (name.size() == 1) {
        diagnostics_.info(place, "a letter such as '" + name + "' need not be declared");
      } else {
        names_.insert(name);
      }
      r.take(',');
    }
  }

  void readLine(const Line& line) {
    const auto [arrow, length] = arrowIn(line.text);
    auto [name, behind] = head(line);
    if (arrow != std::string::npos) {
      // p1: A --> B, as books number productions
      const bool label = name.size() > 1 && (name[0] == 'p' || (isForeign_ && name[0] == 'P')) &&
                         std::all_of(name.begin() + 1, name.end(), [](char c) { return c >= '0' && c <= '9'; });
      return readProduction(line, label ? behind : 0, arrow, length);
    }
    Reader r = reader(line, behind, line.text.size());
    const Place place = line.places[std::min(line.text.find_first_not_of(" \t\n"), line.text.size())];
    if (name.empty())
      return diagnostics_.error(place, "expected a line such as 'angle: 25' or a production such as 'F --> F[+F]F'");
    const auto& settings = table();
    std::string key = name;
    std::transform(key.begin(), key.end(), key.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
    const auto setting = settings.find(key);
    if (setting != settings.end()) {
      (this->*setting->second)(r, place);
      if (!r.failed() && !r.atEnd()) r.error("expected the end of the line; found " + r.found());
      return;
    }
    core::Suggestion suggestion(name);
    for (const auto& [known, how] : settings) suggestion.offer(known);
    diagnostics_.error(place, "there is no setting '" + name + "'" + suggestion.text());
  }

  using Reads = void (Parser::*)(Reader&, Place);
  static const std::map<std::string, Reads>& table() {
    static const std::map<std::string, Reads> all = {
        {"axiom", &Parser::readAxiom},
        {"iterations", &Parser::readNumber<&Settings::iterations>},
        {"angle", &Parser::readNumber<&Settings::angle>},
        {"step", &Parser::readNumber<&Settings::step>},
        {"seed", &Parser::readNumber<&Settings::seed>},
        {"width", &Parser::readWidth},
        {"tropism", &Parser::readTropism},
        {"define", &Parser::readConstant},
        {"ignore", &Parser::readIgnored},
        {"consider", &Parser::readConsidered},
        {"modules", &Parser::skipNames},
        {"asset", &Parser::readAsset},
        {"surface", &Parser::readAsset},
        {"segment", &Parser::readSegment},
        {"draw", &Parser::readLetters<&File::drawing>},
        {"move", &Parser::readLetters<&File::moving>},
        {"productions", &Parser::beginMain},
        {"decomposition", &Parser::beginDecomposition},
        {"homomorphism", &Parser::beginHomomorphism},
        {"system", &Parser::beginSystem},
        {"end", &Parser::endSystem},
        // of plant modellers
        {"depth", &Parser::readDepth},
        {"start", &Parser::readStart},
        {"starteach", &Parser::readStepCode},
        {"endeach", &Parser::readEndCode},
        {"endcode", &Parser::passOverCode},
        {"arrays", &Parser::readArrays},
    };
    return all;
  }

  template <std::optional<Expression> Settings::*member> void readNumber(Reader& r, Place place) {
    if (file_.settings.*member && !isForeign_) return r.errorAt(place, "the setting is given a second time");
    if (file_.settings.*member) diagnostics_.warning(place, "the setting is given a second time, which holds");
    Expression value = r.expression();
    if (!r.failed()) file_.settings.*member = std::move(value);
  }

  /// "maximum depth: 3", of the section that it stands in.
  void readDepth(Reader& r, Place place) {
    if (phase_ == shader::kPhaseDecomposition) return readNumber<&Settings::decompositions>(r, place);
    if (phase_ == shader::kPhaseHomomorphism) return readNumber<&Settings::homomorphisms>(r, place);
    r.errorAt(place, "'maximum depth' stands in a section of decomposition or homomorphism");
  }

  /// start: { name = value; ... }: constants, of which code may change some in each step.
  void readStart(Reader& r, Place place) {
    const std::vector<Statement> block = r.block();
    if (!r.failed()) keep(execute(block, {}), place);
  }
  /// Code that runs once: its random numbers are those of the seed.
  Way execute(const std::vector<Statement>& block, Way from) {
    std::vector<Way> ways = once().run(block, std::move(from));
    return ways.empty() ? Way{} : std::move(ways[0]);
  }
  Execution once() {
    const auto seed = file_.settings.seed ? execution_.valueOf(*file_.settings.seed) : std::nullopt;
    Execution e(diagnostics_, values_);
    e.drawNumbers(static_cast<uint32_t>(std::max(seed.value_or(0), 0.0f)) + (drawn_ += 0x10000u));
    return e;
  }
  void keep(Way way, Place place) {
    for (auto& [name, value] : way.values) {
      std::erase_if(file_.constants, [&, n = &name](const Constant& c) { return c.name == *n; });
      addConstant({name, std::move(value), place});
      globals_.insert(name);
    }
    execution_.guard(globals_);
  }
  void addConstant(Constant constant) {
    auto value = execution_.valueOf(constant.value);
    for (const Override& o : overrides_)
      if (o.name == constant.name) value = o.value;
    if (value)
      values_[constant.name] = *value;
    else
      values_.erase(constant.name);
    file_.constants.push_back(std::move(constant));
  }
  void readStepCode(Reader& r, Place) { takeChanging(stepCode_ = r.block(), values_, start_); }
  void readEndCode(Reader& r, Place) { takeChanging(endCode_ = r.block(), values_, start_); }

  /// Runs the code of all steps; what it changes is a row of values.
  void runSteps() {
    const auto iterations = file_.settings.iterations ? execution_.valueOf(*file_.settings.iterations) : std::nullopt;
    float count = iterations.value_or(0);
    for (const Override& o : overrides_)
      if (o.name == "iterations" && !values_.contains("iterations")) count = o.value;
    file_.stepped = steppedValues(stepCode_, endCode_, count, start_, [this] { return once(); });
  }

  void passOverCode(Reader& r, Place place) {
    const bool isEmpty = r.take('{') && r.take('}');
    if (!isEmpty) diagnostics_.warning(place, "code that is run at the end has no effect");
    while (!r.atEnd()) r.word();
  }
  /// { array a[2] = {1, 2}; array b[3]; }: constants.
  void readArrays(Reader& r, Place place) {
    if (!r.take('{')) return r.error("expected '{'; found " + r.found());
    std::vector<Statement> block;
    while (!r.failed() && !r.take('}')) {
      if (r.atEnd()) return r.error("this code has no '}'");
      if (r.take(';') || r.take(',')) continue;
      const size_t before = r.at();
      if (const std::string word = r.identifier(); word != "array" && !isTypeName(word)) r.goTo(before);
      r.declaration(block, false);
    }
    if (!r.failed()) keep(execute(block, {}), place);
  }

  void readWidth(Reader& r, Place place) {
    if (file_.settings.width && !isForeign_) return r.errorAt(place, "the setting is given a second time");
    file_.settings.width = r.value();
    r.take(',');
    if (!r.failed() && !r.atEnd()) file_.settings.taper = r.value();
  }

  void readTropism(Reader& r, Place place) {
    if (file_.settings.tropism[0]) return r.errorAt(place, "the setting is given a second time");
    for (auto& value : file_.settings.tropism) {
      if (r.atEnd()) return r.error("tropism has four numbers: a direction's x, y and z, and the elasticity");
      value = r.value();
      r.take(',');
    }
  }

  void readConstant(Reader& r, Place) {
    Constant constant;
    constant.place = r.place();
    constant.name = r.identifier();
    if (constant.name.empty()) return r.error("a constant has a name, as in 'define: n 5'; found " + r.found());
    r.take('=');
    constant.value = r.expression();
    if (r.failed()) return;
    if (isForeign_) // the last value holds
      std::erase_if(file_.constants, [&](const Constant& c) { return c.name == constant.name; });
    addConstant(std::move(constant));
  }

  void readSymbols(Reader& r, std::vector<std::string>& symbols) {
    r.take(':'); // #ignore: as well
    while (!r.atEnd() && !r.failed()) {
      if (r.take(',')) continue;
      const Place place = r.place();
      if (const auto module = r.module(true)) {
        if (module->name == "[" || module->name == "]")
          r.errorAt(place, "contexts always see brackets");
        else
          symbols.push_back(module->name);
      }
    }
  }
  void readIgnored(Reader& r, Place place) {
    if (file_.considers) return r.errorAt(place, "a system has either 'ignore:' or 'consider:'");
    readSymbols(r, file_.ignored);
  }
  void readConsidered(Reader& r, Place place) {
    if (!file_.ignored.empty()) return r.errorAt(place, "a system has either 'ignore:' or 'consider:'");
    file_.considers = true;
    readSymbols(r, file_.considered);
  }
  void skipNames(Reader& r, Place) {
    while (!r.atEnd()) r.word();
  }

  uint32_t readShape(Reader& r) {
    const Place place = r.place();
    const std::string name = r.word();
    core::Suggestion suggestion(name);
    for (const ShapeName& s : kShapes) {
      if (s.name == name) return s.shape;
      suggestion.offer(s.name);
    }
    r.errorAt(place, "there is no shape '" + name + "'" + suggestion.text());
    return 0;
  }

  void readAsset(Reader& r, Place place) {
    Asset asset;
    asset.place = place;
    const auto module = r.module(true);
    if (!module) return;
    asset.symbol = module->name;
    asset.name = r.word();
    if (asset.name.empty()) return r.error("an asset has a symbol and a name, as in 'asset: ~l leaf quad'");
    asset.shape = r.atEnd() ? uint32_t{GPGP_SHAPE_QUAD} : readShape(r);
    if (!r.failed()) file_.assets.push_back(std::move(asset));
  }

  void readSegment(Reader& r, Place) { file_.segmentShape = readShape(r); }

  template <std::vector<std::pair<std::string, Place>> File::*member> void readLetters(Reader& r, Place) {
    while (!r.atEnd() && !r.failed()) {
      if (r.take(',')) continue;
      if (const auto module = r.module(true)) (file_.*member).emplace_back(module->name, module->place);
    }
  }

  void beginMain(Reader&, Place) { phase_ = shader::kPhaseMain; }
  void beginDecomposition(Reader& r, Place place) {
    phase_ = shader::kPhaseDecomposition;
    if (!r.atEnd()) readNumber<&Settings::decompositions>(r, place);
  }
  void beginHomomorphism(Reader& r, Place place) {
    phase_ = shader::kPhaseHomomorphism;
    if (!r.atEnd()) readNumber<&Settings::homomorphisms>(r, place);
  }

  void beginSystem(Reader& r, Place place) {
    System system;
    system.place = place;
    system.name = r.identifier();
    phase_ = shader::kPhaseMain;
    if (system.name.empty()) return r.error("a sub-system has a name, as in 'system: leaf(size)'; found " + r.found());
    for (const System& other : file_.systems)
      if (other.name == system.name) r.errorAt(place, "there is already a sub-system '" + system.name + "'");
    if (r.take('(')) {
      do {
        system.parameters.push_back(r.identifier());
        if (system.parameters.back().empty()) r.error("a parameter has a name; found " + r.found());
      } while (!r.failed() && r.take(','));
      if (!r.take(')')) r.error("expected ',' or ')' in the parameters; found " + r.found());
    }
    file_.systems.push_back(std::move(system));
    current_ = file_.systems.size() - 1;
  }
  void endSystem(Reader& r, Place place) {
    if (current_ == 0) r.errorAt(place, "no sub-system ends here");
    current_ = 0;
    phase_ = shader::kPhaseMain;
  }

  void readAxiom(Reader& r, Place place) {
    System& system = file_.systems[current_];
    if (system.axiom) return r.errorAt(place, "there is already an axiom");
    ModuleString modules = r.modules("", false);
    if (isForeign_) enterSystems(modules);
    if (r.failed())
      brokenAxiom_ = true;
    else
      system.axiom = std::move(modules);
  }

  static bool areDistinct(const ModuleString& modules) {
    std::set<std::string> names;
    for (const Module& m : modules)
      if (m.name == "[" || m.name == "]" || !names.insert(m.name).second) return false;
    return modules.size() > 1;
  }

  void readProduction(const Line& line, size_t begin, size_t arrow, size_t arrowLength) {
    Production production;
    production.phase = phase_;
    Reader left = reader(line, begin, arrow);
    production.place = line.places[std::min(line.text.find_first_not_of(" \t\n", begin), line.text.size())];
    std::vector<ModuleString> parts;
    std::string separators;
    for (;;) {
      if (isForeign_ && left.take('*')) // no context
        parts.emplace_back();
      else
        parts.push_back(left.modules("<>:", true));
      if (left.failed()) return;
      const char c = left.peek();
      if (c != '<' && c != '>') break;
      separators += c;
      left.take(c);
    }
    if (separators != "" && separators != "<" && separators != ">" && separators != "<>")
      return left.errorAt(production.place, "a production is 'left < predecessor > right : condition --> successor'");
    const size_t middle = separators.starts_with("<") ? 1 : 0;
    if (middle) production.left = std::move(parts[0]);
    if (parts.size() > middle + 1) production.right = std::move(parts[middle + 1]);
    ModuleString others; // that are rewritten with the first
    if (isForeign_ && areDistinct(parts[middle])) {
      others.assign(parts[middle].begin() + 1, parts[middle].end());
      parts[middle].resize(1);
    }
    if (parts[middle].size() != 1)
      return left.errorAt(parts[middle].empty() ? production.place : parts[middle][1].place,
                          "a production rewrites one module; found " + std::to_string(parts[middle].size()));
    production.predecessor = std::move(parts[middle][0]);
    // Code may stand before and behind the condition; what it says of names holds in what follows.
    Way way;
    if (left.take(':')) {
      if (left.peek() == '{') way = execute(left, std::move(way)), left.take(':');
      if (!left.take('*') && left.peek() != '{' && !left.atEnd()) production.condition = left.expression();
      if (production.condition) substitute(*production.condition, way.values);
      if (!left.failed() && left.peek() == '{') way = execute(left, std::move(way));
    }
    if (!left.failed() && !left.atEnd()) left.error("expected '-->'; found " + left.found());
    Reader right = reader(line, arrow + arrowLength, line.text.size());
    if (isForeign_ && !left.failed() && right.peek() == '{' && isBlock(right)) // a{code}b --> {code} successor
      way = execute(right, std::move(way));
    if (!right.take('*')) production.successor = right.modules(":", false);
    if (!right.failed() && right.take(':')) production.probability = right.expression();
    for (Module& m : production.successor)
      for (Expression& argument : m.arguments) substitute(argument, way.values);
    if (production.probability) substitute(*production.probability, way.values);
    if (!right.failed() && !right.atEnd()) right.error("expected the end of the line; found " + right.found());
    if (left.failed() || right.failed()) return;
    if (isForeign_) enterSystems(production.successor);
    if (others.empty()) return void(file_.systems[current_].productions.push_back(std::move(production)));
    rewriteTogether(std::move(production), others);
  }

  Way execute(Reader& r, Way from) {
    const std::vector<Statement> block = r.block();
    if (r.failed()) return from;
    std::vector<Way> ways = execution_.run(block, std::move(from));
    return ways.empty() ? Way{} : std::move(ways[0]);
  }
  /// Whether braces at the beginning of a successor hold code, not a polygon: they hold an assignment.
  static bool isBlock(Reader& r) {
    const size_t before = r.at();
    r.take('{');
    const bool isAssignment = !r.identifier().empty() && r.peek() == '=';
    r.goTo(before);
    return isAssignment;
  }

  /// Several modules that a production rewrites: the first becomes the successor, the others go, where all are.
  void rewriteTogether(Production production, const ModuleString& others) {
    auto& productions = file_.systems[current_].productions;
    for (size_t i = 0; i <= others.size(); ++i) {
      Production p = production;
      p.left = production.left.value_or(ModuleString());
      ModuleString behind(others.begin() + static_cast<ptrdiff_t>(i), others.end());
      if (i > 0) {
        p.left->push_back(production.predecessor);
        p.left->insert(p.left->end(), others.begin(), others.begin() + static_cast<ptrdiff_t>(i) - 1);
        p.predecessor = others[i - 1];
        p.successor.clear();
      }
      if (production.right) behind.insert(behind.end(), production.right->begin(), production.right->end());
      p.right = std::move(behind);
      productions.push_back(std::move(p));
    }
  }

  /// ?(2, s) A $: modules that the productions of sub-system 2 rewrite.
  void enterSystems(ModuleString& string) {
    ModuleString result;
    std::vector<std::string> inside;
    for (Module& m : string) {
      if (m.name == "?") {
        const auto number = m.arguments.empty() ? std::nullopt : execution_.valueOf(m.arguments[0]);
        if (!number) {
          diagnostics_.error(m.place, "'?(n, scale)' has the known number of a sub-system");
          return;
        }
        if (m.arguments.size() > 1 && execution_.valueOf(m.arguments[1]) != 1.0f)
          diagnostics_.warning(m.place, "the scale of a sub-system has no effect");
        inside.push_back(numberedSystem(static_cast<uint32_t>(std::max(*number, 0.0f))));
      } else if (m.name == "$" && m.arguments.empty() && !inside.empty()) {
        inside.pop_back();
      } else {
        if (!inside.empty()) m.system = inside.back();
        result.push_back(std::move(m));
      }
    }
    string = std::move(result);
  }

  Diagnostics& diagnostics_;
  std::span<const Override> overrides_;
  bool isForeign_;
  std::vector<Line> lines_;
  Declared declared_;
  std::map<std::string, float> values_; ///< of constants
  std::set<std::string> globals_;       ///< that code sets
  Execution execution_;
  std::vector<Statement> stepCode_, endCode_;
  std::map<std::string, float> start_; ///< of values that code of steps changes
  uint32_t drawn_ = 0;
  std::set<std::string> names_;
  File file_;
  size_t current_ = 0;
  uint32_t phase_ = shader::kPhaseMain;
  bool brokenAxiom_ = false;
};

} // namespace

std::string numberedSystem(uint32_t number) { return "lsystem" + std::to_string(number); }

File parse(std::string_view text, Diagnostics& diagnostics, std::span<const Override> overrides, const ReadFile& read,
           std::string_view start) {
  if (isOfFractint(text)) return parseFractint(text, diagnostics, start);
  if (!start.empty())
    diagnostics.error({}, "this file has one system, which has no name; '" + std::string(start) + "' is none of it");
  if (isOfLpy(text)) return parseLpy(text, diagnostics, overrides);
  if (isOfLpfg(text)) return parseLpfg(text, diagnostics, overrides, read);
  return Parser(text, diagnostics, overrides, read).run();
}

} // namespace gpgp::spawn::lsystem
