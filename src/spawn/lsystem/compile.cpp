// Resolves the names of a file, and collects what its table holds.
#include "spawn/lsystem/compile.h"

#include "core/suggest.h"
#include "spawn/lsystem/rewrite.h"
#include "spawn/lsystem/syntax.h"
#include "spawn/lsystem/table_writer.h"

#include <gpgp/spawn.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

namespace gpgp::spawn::lsystem {

namespace {
using namespace shader;

constexpr uint32_t kMostSymbols = 1u << 15, kMostProductions = 1u << 15, kMostCode = 1u << 22, kMostExpansion = 16;

/// What names mean in an expression: a variable of the production, or what a sub-system was given for a parameter.
struct Scope {
  struct Meaning {
    uint32_t variable = 0;
    const Expression* given = nullptr;
    const Scope* around = nullptr; ///< in which `given` is read
  };
  std::map<std::string, Meaning> names;
};

class Compiler {
public:
  Compiler(const File& file, std::span<const Override> overrides, Diagnostics& diagnostics)
      : file_(file), overrides_(overrides), diagnostics_(diagnostics) {}

  std::optional<std::vector<uint32_t>> run() {
    takeConstants();
    takeSteps();
    for (const System& system : file_.systems)
      for (const Production& p : system.productions) predecessors_[system.name].insert(p.predecessor.name);
    for (const auto& [system, names] : predecessors_) rewritten_.insert(names.begin(), names.end());
    takeAssets();
    intern("[", 0, {});
    intern("]", 0, {});
    intern("@axiom", 1, {});
    table_.symbols[kSymbolAxiom].turtle = kTurtleAxiom;
    std::array<uint32_t, kProductionSize>& axiom = table_.axiom;
    axiom[kProductionPredecessor] = kSymbolAxiom;
    if (file_.systems[0].axiom) {
      draws_ = 0;
      takeString(file_.systems[0], *file_.systems[0].axiom, Scope{}, axiom);
    }
    for (const System& system : file_.systems) {
      if (!system.axiom && !system.name.empty())
        diagnostics_.error(system.place, "the sub-system '" + system.name + "' has no axiom");
      for (const Production& p : system.productions) takeProduction(system, p);
    }
    takeSettings();
    warn();
    if (diagnostics_.hasErrors()) return std::nullopt;
    return wordsOf(table_);
  }

private:
  // ------------------------------------------------------------ numbers

  /// The value of an expression without variables and random numbers.
  std::optional<float> constantOf(const Expression& e, const Scope& scope) {
    if (e.kind == Expression::Kind::number) return settle(e.number);
    if (e.kind == Expression::Kind::name) {
      if (const auto found = scope.names.find(e.name); found != scope.names.end())
        return found->second.given ? constantOf(*found->second.given, *found->second.around) : std::nullopt;
      if (rows_.contains(e.name)) return std::nullopt;
      const auto constant = constants_.find(e.name);
      return constant != constants_.end() ? std::optional(constant->second) : std::nullopt;
    }
    if (e.code == kLsysRandom || e.code == kLsysNormal) return std::nullopt;
    if (e.code == kLsysSelect) {
      const auto condition = constantOf(e.operands[0], scope);
      return condition ? constantOf(e.operands[*condition != 0.0f ? 1 : 2], scope) : std::nullopt;
    }
    std::vector<float> values;
    for (const Expression& operand : e.operands) {
      const auto value = constantOf(operand, scope);
      if (!value) return std::nullopt;
      values.push_back(*value);
    }
    if (values.size() == 1) return lsysUnary(e.code, values[0]);
    return lsysBinary(e.code, values[0], values[1]);
  }

  /// A number that settings need; reports why there is none.
  float numberOf(const Expression& e) {
    const size_t before = diagnostics_.errorCount();
    if (const auto value = constantOf(e, {})) return *value;
    std::vector<uint32_t> program;
    uint32_t most = 0;
    emit(e, {}, program, 0, most);
    if (diagnostics_.errorCount() == before)
      diagnostics_.error(e.place, "a setting cannot be a random number; use it in a production");
    return 0;
  }

  void takeConstants() {
    std::set<std::string_view> used;
    constexpr std::string_view kSettings[] = {"iterations", "angle", "step", "width", "seed"};
    for (const Constant& c : file_.constants) {
      if (constants_.contains(c.name)) diagnostics_.error(c.place, "there is already a constant '" + c.name + "'");
      constants_[c.name] = numberOf(c.value);
      for (const Override& o : overrides_)
        if (o.name == c.name) constants_[c.name] = settle(o.value);
    }
    for (const Override& o : overrides_) {
      if (constants_.contains(std::string(o.name)) || std::count(std::begin(kSettings), std::end(kSettings), o.name))
        continue;
      core::Suggestion suggestion(o.name);
      for (const auto& [name, value] : constants_) suggestion.offer(name);
      for (const std::string_view name : kSettings) suggestion.offer(name);
      diagnostics_.error({},
                         "there is no constant or setting '" + std::string(o.name) + "' to set" + suggestion.text());
    }
  }

  /// A setting's value: the command's, the file's or the default.
  float setting(std::string_view name, const std::optional<Expression>& given, float fallback) {
    float value = given ? numberOf(*given) : fallback;
    for (const Override& o : overrides_)
      if (o.name == name && !constants_.contains(std::string(name))) value = o.value;
    return value;
  }
  uint32_t wholeSetting(std::string_view name, const std::optional<Expression>& given, float fallback, uint32_t most) {
    float value = setting(name, given, fallback);
    if (most == kMostRepeats && value > static_cast<float>(most) && value == std::floor(value)) {
      diagnostics_.warning(given ? given->place : Place{}, std::string(name) + " is repeated at most " +
                                                               std::to_string(most) + " times, not " +
                                                               std::to_string(static_cast<uint64_t>(value)));
      value = static_cast<float>(most);
    }
    if (value >= 0 && value <= static_cast<float>(most) && value == std::floor(value))
      return static_cast<uint32_t>(value);
    diagnostics_.error(given ? given->place : Place{},
                       std::string(name) + " is a whole number from 0 to " + std::to_string(most));
    return 0;
  }

  /// How many steps there are, and the rows of values that code changes from step to step.
  void takeSteps() {
    const Settings& s = file_.settings;
    bool has[kPhases3] = {};
    for (const System& system : file_.systems)
      for (const Production& p : system.productions) has[p.phase] = true;
    table_.head.resize(kLsysHeadSize);
    if (!s.iterations && has[kPhaseMain] &&
        std::none_of(overrides_.begin(), overrides_.end(), [](const Override& o) { return o.name == "iterations"; }))
      diagnostics_.warning({}, "there is no 'iterations:'; without it, no production is applied");
    table_.head[kLsysHeadIterations] = wholeSetting("iterations", s.iterations, 0, kMostIterations);
    table_.head[kLsysHeadDecompositions] =
        has[kPhaseDecomposition] ? wholeSetting("decomposition", s.decompositions, 1, kMostRepeats) : 0;
    table_.head[kLsysHeadHomomorphisms] =
        has[kPhaseHomomorphism] ? wholeSetting("homomorphism", s.homomorphisms, 1, kMostRepeats) : 0;
    if (file_.stepped.empty()) return;
    const uint32_t iterations = table_.head[kLsysHeadIterations], parts = table_.head[kLsysHeadDecompositions];
    const uint32_t steps = parts + iterations * (1 + parts) + 1; // the last is that of homomorphism
    table_.code.push_back(steps);
    for (const Stepped& row : file_.stepped) {
      rows_[row.name] = static_cast<uint32_t>(rows_.size());
      for (uint32_t step = 0; step < steps; ++step) {
        const size_t at = step < parts ? 0 : 1 + (step - parts) / (1 + parts);
        table_.code.push_back(std::bit_cast<uint32_t>(settle(row.values[std::min(at, row.values.size() - 1)])));
      }
    }
    table_.head[kLsysHeadRows] = static_cast<uint32_t>(rows_.size());
  }

  void takeSettings() {
    const Settings& s = file_.settings;
    table_.head[kLsysHeadSeed] = wholeSetting("seed", s.seed, 0, 1u << 24);
    const auto put = [&](uint32_t word, float value) { table_.head[word] = std::bit_cast<uint32_t>(settle(value)); };
    put(kLsysHeadAngle, setting("angle", s.angle, 90));
    const float step = setting("step", s.step, 1);
    put(kLsysHeadStep, step);
    const float width = setting("width", s.width, 0.1f * std::abs(step));
    if (width < 0) diagnostics_.error(s.width ? s.width->place : Place{}, "the width is negative");
    put(kLsysHeadWidth, width);
    const float taper = s.taper ? numberOf(*s.taper) : 0.7f;
    if (taper < 0) diagnostics_.error(s.taper->place, "the factor of the width is negative");
    put(kLsysHeadTaper, taper);
    float direction[4] = {0, -1, 0, 0};
    for (size_t i = 0; i < 4; ++i)
      if (s.tropism[i]) direction[i] = numberOf(*s.tropism[i]);
    const float length =
        squareRoot(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    if (length == 0) {
      diagnostics_.error(s.tropism[0] ? s.tropism[0]->place : Place{}, "the direction of tropism has no length");
    } else {
      for (uint32_t i = 0; i < 3; ++i) put(kLsysHeadTropism + i, direction[i] / length);
    }
    put(kLsysHeadTropism + 3, direction[3]);
    table_.head[kLsysHeadSegment] = file_.segmentShape;
    uint32_t flags = hasContexts_ ? kLsysContexts : 0;
    if (direction[3] != 0) flags |= kLsysWalks;
    for (const Symbol& symbol : table_.symbols) {
      if (symbol.turtle == kTurtleCut) flags |= kLsysCuts;
      if (symbol.turtle >= kTurtleUpright) flags |= kLsysWalks;
      if (symbol.turtle == kTurtlePolygon) flags |= kLsysPolygons;
      if (symbol.turtle == kTurtleCylinder) flags |= kLsysCylinders;
    }
    table_.head[kLsysHeadFlags] = flags;
  }

  // ------------------------------------------------------------ symbols

  void takeAssets() {
    for (const Asset& asset : file_.assets) {
      if (assets_.contains(asset.symbol)) diagnostics_.error(asset.place, "'" + asset.symbol + "' is already an asset");
      assets_[asset.symbol] = &asset;
    }
  }

  uint32_t terminal(const std::string& name, uint32_t kind, uint32_t shape) {
    for (uint32_t i = 0; i < table_.terminals.size(); ++i)
      if (table_.terminals[i].name == name && table_.terminals[i].kind == kind && table_.terminals[i].shape == shape)
        return i;
    if (table_.terminals.size() == kMostTerminals) {
      diagnostics_.error({}, "the system draws more than " + std::to_string(kMostTerminals) + " different things");
      return 0;
    }
    table_.terminals.push_back({name, kind, shape});
    return static_cast<uint32_t>(table_.terminals.size() - 1);
  }

  /// system: that the name is read in; symbols that a sub-system rewrites are its own.
  uint32_t intern(const std::string& name, size_t arity, const std::string& system, Place place = {}) {
    const bool own = !system.empty() && predecessors_[system].contains(name) && turtleOf(name) == kTurtleNone;
    const std::string full = own ? system + "." + name : name;
    const auto key = std::pair(full, arity);
    if (const auto found = symbolIndex_.find(key); found != symbolIndex_.end()) return found->second;
    if (arity > kMostArity) {
      diagnostics_.error(place, "'" + name + "' has " + std::to_string(arity) + " parameters; a module has at most " +
                                    std::to_string(kMostArity));
      return kSymbolOpen;
    }
    if (arity && table_.symbols.size() > kSymbolClose && (name == "[" || name == "]")) {
      diagnostics_.error(place, "a bracket has no parameters");
      return kSymbolOpen;
    }
    if (table_.symbols.size() == kMostSymbols) {
      diagnostics_.error(place, "there are too many symbols");
      return kSymbolOpen;
    }
    Symbol symbol{full, static_cast<uint32_t>(arity)};
    symbol.turtle = own ? kTurtleNone : turtleOf(name);
    if (name == "#" && arity) symbol.turtle = kTurtleWidth; // #(w), as !(w)
    const bool instead = (name == "T" || name == "J" || name == "K" || name == "M") && rewritten_.contains(name);
    if (instead) symbol.turtle = kTurtleNone; // then they are letters like any other
    const auto listed = [&](const auto& letters) {
      return std::any_of(letters.begin(), letters.end(), [&](const auto& l) { return l.first == name; });
    };
    if (listed(file_.drawing)) symbol.turtle = kTurtleDraw;
    if (listed(file_.moving)) symbol.turtle = kTurtleMove;
    const auto asset = assets_.find(name);
    if (asset != assets_.end() && !own) {
      symbol.turtle = kTurtleAsset;
      symbol.terminal = terminal(asset->second->name, 1, asset->second->shape);
    } else if (name == "@O" || name == "@o" || name == "@c") {
      symbol.terminal = terminal(name == "@O" ? "sphere" : "circle", 1,
                                 name == "@O" ? uint32_t{GPGP_SHAPE_SPHERE} : uint32_t{GPGP_SHAPE_OCTAGON});
    } else if (symbol.turtle == kTurtleAsset) {
      symbol.terminal = terminal(name[0] == '~' ? name.substr(1) : name, 1, GPGP_SHAPE_QUAD);
    } else if (symbol.turtle == kTurtleDraw || symbol.turtle == kTurtleDrawOnly) {
      symbol.terminal = terminal(name, 0, file_.segmentShape);
    } else if (symbol.turtle == kTurtlePolygon) {
      symbol.terminal = terminal("polygon", 0, GPGP_SHAPE_DYNAMIC_POLYGON);
    } else if (symbol.turtle == kTurtleCylinder) {
      symbol.terminal = terminal("cylinder", 0, GPGP_SHAPE_DYNAMIC_RIGHT_PRISM);
    }
    const auto contains = [&](const std::vector<std::string>& list) {
      return std::find(list.begin(), list.end(), name) != list.end();
    };
    symbol.ignored = file_.considers ? !contains(file_.considered) : contains(file_.ignored);
    table_.symbols.push_back(std::move(symbol));
    return symbolIndex_[key] = static_cast<uint32_t>(table_.symbols.size() - 1);
  }

  // ------------------------------------------------------------ programs

  void emit(const Expression& e, const Scope& scope, std::vector<uint32_t>& program, uint32_t depth, uint32_t& most) {
    most = std::max(most, depth + 1);
    if (program.size() > kMostProgram) return; // reported by programOf
    if (const auto value = constantOf(e, scope)) {
      program.insert(program.end(), {kLsysNumber, std::bit_cast<uint32_t>(*value)});
      return;
    }
    if (e.kind == Expression::Kind::name) {
      const auto found = scope.names.find(e.name);
      const auto row = rows_.find(e.name);
      if (found == scope.names.end() && row != rows_.end()) {
        program.insert(program.end(), {kLsysByStep, row->second});
      } else if (found == scope.names.end()) {
        core::Suggestion suggestion(e.name);
        for (const auto& [name, meaning] : scope.names) suggestion.offer(name);
        for (const auto& [name, value] : constants_) suggestion.offer(name);
        diagnostics_.error(e.place, "there is no parameter or constant '" + e.name + "'" + suggestion.text());
      } else if (found->second.given) {
        emit(*found->second.given, *found->second.around, program, depth, most);
      } else {
        program.insert(program.end(), {kLsysVariable, found->second.variable});
      }
      return;
    }
    if (e.code == kLsysRandom || e.code == kLsysNormal) {
      if (e.draw & kSharedDraw) { // by all productions of a block
        program.insert(program.end(), {e.code, 0x10000000u | (e.draw & 0x00ffffffu)});
        return;
      }
      const auto [known, isNew] =
          e.draw ? sharedDraws_.try_emplace(e.draw, draws_) : std::pair(sharedDraws_.end(), true);
      const uint32_t draw = isNew ? draws_++ : known->second;
      program.insert(program.end(), {e.code, drawBase_ + draw});
      return;
    }
    if (e.code == kLsysSelect)
      if (const auto condition = constantOf(e.operands[0], scope))
        return emit(e.operands[*condition != 0.0f ? 1 : 2], scope, program, depth, most);
    for (size_t i = 0; i < e.operands.size(); ++i)
      emit(e.operands[i], scope, program, depth + static_cast<uint32_t>(i), most);
    program.push_back(e.code);
  }

  /// Where a program begins in the code, counted from 1.
  uint32_t programOf(const Expression& e, const Scope& scope) {
    std::vector<uint32_t> program;
    uint32_t most = 0;
    emit(e, scope, program, 0, most);
    program.push_back(kLsysEnd);
    if (program.size() > kMostProgram || most > kMostStackDepth || table_.code.size() + program.size() > kMostCode)
      diagnostics_.error(e.place, "the expression is too long or nests too deep");
    const uint32_t at = static_cast<uint32_t>(table_.code.size());
    if (program.size() <= kMostProgram) table_.code.insert(table_.code.end(), program.begin(), program.end());
    return at + 1;
  }

  // ------------------------------------------------------------ productions

  const System* systemNamed(const std::string& name) const {
    for (const System& system : file_.systems)
      if (!system.name.empty() && system.name == name) return &system;
    return nullptr;
  }

  void append(const System& system, const ModuleString& string, const Scope& scope, uint32_t nesting,
              std::array<uint32_t, kProductionSize>& production) {
    for (const Module& m : string) {
      if (table_.modules.size() > (1u << 22)) return;
      if (m.name[0] == '?') {
        const std::string name = m.name.substr(1);
        const System* called = systemNamed(name);
        if (!called && isQuery(name)) {
          inert(m, "there are no queries of the environment or the turtle; the parameters of '" + m.name +
                       "' stay what strings say");
          place(system, m, scope, production);
        } else if (!called) {
          core::Suggestion suggestion(name);
          for (const System& other : file_.systems) suggestion.offer(other.name);
          diagnostics_.error(m.place, "there is no sub-system '" + name + "'" + suggestion.text());
        } else if (called->parameters.size() != m.arguments.size()) {
          diagnostics_.error(m.place, "the sub-system '" + name + "' has " + std::to_string(called->parameters.size()) +
                                          " parameters; found " + std::to_string(m.arguments.size()));
        } else if (nesting == kMostExpansion) {
          diagnostics_.error(m.place, "the axioms of sub-systems are nested too deep, or without end");
        } else if (called->axiom) {
          Scope inner;
          for (size_t i = 0; i < m.arguments.size(); ++i)
            inner.names[called->parameters[i]] = {0, &m.arguments[i], &scope};
          append(*called, *called->axiom, inner, nesting + 1, production);
        }
        continue;
      }
      if (m.name.size() > 1 && m.name[0] == '@' && turtleOf(m.name) == kTurtleNone && !assets_.contains(m.name))
        inert(m, "the turtle command '" + m.name + "' is not supported, and has no effect");
      if (m.name == "," || (m.name == "#" && m.arguments.empty()))
        inert(m, "the turtle command '" + m.name + "' is not supported, and has no effect");
      place(system, m, scope, production);
    }
  }

  static bool isQuery(std::string_view name) {
    return name.size() == 1 && std::string_view("PHUELRCTD").find(name[0]) != std::string_view::npos;
  }
  void inert(const Module& m, const std::string& text) {
    if (inert_.insert(m.name).second) diagnostics_.warning(m.place, text);
  }
  /// A module of a successor.
  void place(const System& system, const Module& m, const Scope& scope,
             std::array<uint32_t, kProductionSize>& production) {
    const uint32_t symbol = intern(m.name, m.arguments.size(), m.system.empty() ? system.name : m.system, m.place);
    table_.symbols[symbol].made = true;
    uint32_t code = 0;
    for (const Expression& argument : m.arguments) {
      const uint32_t at = programOf(argument, scope);
      if (!code) code = at;
    }
    table_.modules.push_back({symbol, code});
    production[kProductionSuccessor + 1] += 1;
    production[kProductionParameters] += static_cast<uint32_t>(m.arguments.size());
  }

  void takeString(const System& system, const ModuleString& string, const Scope& scope,
                  std::array<uint32_t, kProductionSize>& production) {
    int depth = 0, polygons = 0;
    for (const Module& m : string) {
      if (m.name == "[") ++depth;
      if (m.name == "{") ++polygons;
      if (m.name == "]" && depth-- == 0) diagnostics_.error(m.place, "']' without a '[' before it in this string");
      if (m.name == "}" && polygons-- == 0 && !file_.isOfModeller)
        diagnostics_.error(m.place, "'}' without a '{' before it in this string");
      if (m.name == "{" && polygons > 1 && !file_.isOfModeller)
        diagnostics_.error(m.place, "a polygon within a polygon is not supported");
      depth = std::max(depth, 0);
      polygons = std::max(polygons, 0);
    }
    const Place end = string.empty() ? Place{} : string.back().place;
    if (depth) diagnostics_.error(end, "a '[' of this string has no ']'; strings are put together whole");
    if (polygons && !file_.isOfModeller)
      diagnostics_.error(end, "a '{' of this string has no '}'; strings are put together whole");
    production[kProductionSuccessor] = static_cast<uint32_t>(table_.modules.size());
    append(system, string, scope, 0, production);
    if (production[kProductionSuccessor + 1] > kMostSuccessor)
      diagnostics_.error(string.empty() ? Place{} : string[0].place,
                         "a string has at most " + std::to_string(kMostSuccessor) + " modules; found " +
                             std::to_string(production[kProductionSuccessor + 1]));
  }

  /// Parameters of a module as variables.
  void declare(const Module& m, Scope& scope, uint32_t& variables) {
    for (const Expression& a : m.arguments) {
      if (!scope.names.emplace(a.name, Scope::Meaning{variables, nullptr, nullptr}).second)
        diagnostics_.error(a.place, "the parameter '" + a.name + "' stands twice");
      ++variables;
    }
  }

  void takeContext(const System& system, const ModuleString& context, bool left, Scope& scope, uint32_t& variables,
                   std::array<uint32_t, kProductionSize>& production) {
    if (context.empty()) return;
    const uint32_t side = left ? kProductionLeft : kProductionRight;
    hasContexts_ = true;
    production[side] = static_cast<uint32_t>(table_.contexts.size());
    production[side + 1] = static_cast<uint32_t>(context.size());
    int depth = 0;
    if (context.size() > kMostContext)
      diagnostics_.error(context[0].place, "a context has at most " + std::to_string(kMostContext) + " modules");
    for (size_t i = 0; i < context.size(); ++i) {
      const Module& m = context[left ? context.size() - 1 - i : i]; // the nearest first
      if (m.name == "[" || m.name == "]") {
        if (left) diagnostics_.error(m.place, "a left context is a path from the root and has no brackets");
        depth += m.name == "[" ? 1 : -1;
        if (depth < 0) {
          diagnostics_.error(m.place, "']' without a '[' before it in this context");
          depth = 0;
        }
        table_.contexts.push_back({m.name == "[" ? kContextOpen : kContextClose, 0});
        continue;
      }
      if (m.name[0] == '?' && !isQuery(m.name.substr(1)))
        diagnostics_.error(m.place, "a context cannot hold a sub-system");
      const uint32_t symbol = intern(m.name, m.arguments.size(), system.name, m.place);
      if (table_.symbols[symbol].ignored)
        file_.isOfModeller
            ? diagnostics_.warning(m.place, "contexts do not see '" + m.name + "', so this one never holds")
            : diagnostics_.error(m.place, "contexts do not see '" + m.name + "', so this one never holds");
      table_.contexts.push_back({symbol, variables});
      declare(m, scope, variables);
      contextSymbols_.push_back({symbol, m.place});
    }
  }

  void takeProduction(const System& system, const Production& p) {
    const std::string& name = p.predecessor.name;
    const uint32_t turtle = turtleOf(name);
    if ((name[0] == '?' && !isQuery(name.substr(1))) || turtle == kTurtleOpen || turtle == kTurtleClose ||
        turtle == kTurtlePolygon || turtle == kTurtlePolygonEnd)
      return diagnostics_.error(p.predecessor.place, "'" + name + "' cannot be rewritten");
    const bool contextual = (p.left && !p.left->empty()) || (p.right && !p.right->empty());
    if (contextual && p.phase != kPhaseMain)
      return diagnostics_.error(p.predecessor.place, "decomposition and homomorphism have no contexts");
    const uint32_t symbol = intern(name, p.predecessor.arguments.size(), system.name, p.predecessor.place);
    std::array<uint32_t, kProductionSize> production{};
    production[kProductionPredecessor] = symbol;
    Scope scope;
    uint32_t variables = 0;
    declare(p.predecessor, scope, variables);
    if (p.left) takeContext(system, *p.left, true, scope, variables, production);
    if (p.right) takeContext(system, *p.right, false, scope, variables, production);
    if (variables > kMostVariables)
      diagnostics_.error(p.place, "a production has at most " + std::to_string(kMostVariables) + " parameters; found " +
                                      std::to_string(variables));
    auto& productions = table_.symbols[symbol].productions[p.phase];
    if (productions.size() == kMostAlternatives || ++table_.productionCount > kMostProductions)
      return diagnostics_.error(p.place, "'" + name + "' has too many productions");
    drawBase_ = static_cast<uint32_t>(productions.size()) << 16;
    draws_ = 0;
    sharedDraws_.clear();
    if (p.condition) production[kProductionCondition] = programOf(*p.condition, scope);
    if (p.probability) production[kProductionProbability] = programOf(*p.probability, scope);
    takeString(system, p.successor, scope, production);
    drawBase_ = 0;
    table_.symbols[symbol].productions[p.phase].push_back(production); // takeString may have moved it
    table_.symbols[symbol].sources[p.phase].push_back(&p);
  }

  // ------------------------------------------------------------ remarks

  void warn() {
    const auto parameters = [](uint32_t n) {
      return n == 0 ? "no parameter" : n == 1 ? "1 parameter" : std::to_string(n) + " parameters";
    };
    std::set<std::string> made;
    for (const Symbol& symbol : table_.symbols)
      if (symbol.made) made.insert(symbol.name);
    for (const Symbol& symbol : table_.symbols) {
      for (uint32_t phase = 0; phase < kPhases3; ++phase) {
        const auto& sources = symbol.sources[phase];
        if (sources.empty()) continue;
        if (!symbol.made) {
          std::string text = "the production never applies: no axiom or successor holds '" + symbol.name + "' with " +
                             parameters(symbol.arity);
          for (const Symbol& other : table_.symbols)
            if (other.made && other.name == symbol.name)
              text += "; one has it with " + std::string(parameters(other.arity));
          if (!made.contains(symbol.name)) {
            core::Suggestion suggestion(symbol.name);
            for (const std::string& other : made) suggestion.offer(other);
            text += suggestion.text();
          }
          diagnostics_.warning(sources[0]->place, text);
        }
        float sum = 0;
        bool plain = true;
        for (const Production* p : sources) {
          const auto value = p->probability ? constantOf(*p->probability, {}) : std::nullopt;
          if (!value || p->condition || (p->left && !p->left->empty()) || (p->right && !p->right->empty()))
            plain = false;
          else
            sum += *value;
          if (value && *value < 0) diagnostics_.warning(p->probability->place, "a negative probability counts as 0");
        }
        if (plain && std::abs(sum - 1) > 1e-3f)
          diagnostics_.warning(sources[0]->place,
                               "the probabilities of '" + symbol.name + "' have the sum " + std::to_string(sum) +
                                   (sum < 1 ? "; else the module stays as it is" : "; they are divided by it"));
        for (size_t i = 0; i + 1 < sources.size(); ++i) {
          const Production& p = *sources[i];
          if (p.probability || p.condition || (p.left && !p.left->empty()) || (p.right && !p.right->empty())) continue;
          diagnostics_.warning(sources[i + 1]->place, "the production never applies: the one in line " +
                                                          std::to_string(p.place.line) + " takes every '" +
                                                          symbol.name + "' before it");
          break;
        }
      }
    }
    for (const auto& [symbol, place] : contextSymbols_)
      if (!table_.symbols[symbol].made)
        diagnostics_.warning(place, "the context never holds: no axiom or successor holds '" +
                                        table_.symbols[symbol].name + "' with " +
                                        parameters(table_.symbols[symbol].arity));
    for (const std::string& name : file_.ignored)
      if (!made.contains(name) && turtleOf(name) == kTurtleNone)
        diagnostics_.info({}, "'ignore:' names '" + name + "', which no axiom or successor holds");
  }

  const File& file_;
  std::span<const Override> overrides_;
  Diagnostics& diagnostics_;
  TableContents table_;
  std::map<std::string, float> constants_;
  std::map<std::string, uint32_t> rows_;                      // of values that change from step to step
  std::map<std::string, std::set<std::string>> predecessors_; // by system
  std::set<std::string> rewritten_;                           // of all
  std::map<std::string, const Asset*> assets_;
  std::map<std::pair<std::string, size_t>, uint32_t> symbolIndex_;
  std::vector<std::pair<uint32_t, Place>> contextSymbols_;
  uint32_t drawBase_ = 0, draws_ = 0;
  std::map<uint32_t, uint32_t> sharedDraws_; // of the production: numbers that names stand for
  std::set<std::string> inert_;              // commands that were named as such
  bool hasContexts_ = false;
};

} // namespace

std::optional<std::vector<uint32_t>> compile(std::string_view text, std::span<const Override> overrides,
                                             Diagnostics& diagnostics, const ReadFile& read, std::string_view start) {
  const File file = parse(text, diagnostics, overrides, read, start);
  return Compiler(file, overrides, diagnostics).run();
}

} // namespace gpgp::spawn::lsystem
