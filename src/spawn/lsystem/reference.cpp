#include "spawn/lsystem/reference.h"

#include "spawn/lsystem/rewrite.h"

#include <algorithm>
#include <bit>
#include <charconv>

namespace gpgp::spawn::lsystem {
namespace {

using namespace shader;

/// The pyramid over a string (string.h).
struct Nodes {
  std::vector<uvec4> nodes;
  uint32_t leaves = 0;

  Nodes(const Table& table, const String& string) {
    const uint32_t count = static_cast<uint32_t>(string.modules.size());
    leaves = std::bit_ceil(std::max(count, 1u));
    nodes.assign(size_t{2} * leaves, lsysNoLeaf());
    const LsysString reading{table.words().data(), string.modules.data(), string.parameters.data(), nodes.data(),
                             leaves};
    int depth = 0;
    for (uint32_t i = 0; i < count; ++i) {
      nodes[leaves + i] = lsysLeaf(reading, string.modules[i].x, static_cast<uint32_t>(depth));
      depth += lsysDepthStep(string.modules[i].x);
    }
    for (uint32_t i = leaves - 1; i > 0; --i) nodes[i] = lsysJoin(nodes[2 * i], nodes[2 * i + 1]);
  }
};

/// What a production makes of a module.
void append(const LsysString& reading, uint32_t at, uvec4 module, uint32_t production, uint32_t step, String& to) {
  if (!production) {
    const uint32_t arity = lsysCount(reading, module, 0).y;
    const uint32_t first = static_cast<uint32_t>(to.parameters.size());
    to.parameters.insert(to.parameters.end(), reading.parameters + module.y, reading.parameters + module.y + arity);
    to.modules.push_back({module.x, first, module.z, module.w});
    return;
  }
  LsysVariables variables;
  if (module.x != kSymbolAxiom) lsysTake(reading, variables, 0, module);
  lsysHasContexts(reading, production, at, variables);
  const LsysDraws draws{{module.z, module.w}, step};
  const uint32_t count = reading.table[production + kProductionSuccessor + 1];
  uint32_t entry = reading.table[production + kProductionSuccessor];
  for (uint32_t m = 0; m < count; ++m, entry += kModuleSize) {
    const uint32_t symbol = reading.table[entry + kModuleSymbol];
    const uvec2 key = lsysChildKey(module, m);
    to.modules.push_back({symbol, static_cast<uint32_t>(to.parameters.size()), key.x, key.y});
    uint32_t program = reading.table[entry + kModuleCode];
    const uint32_t arity = lsysWord(reading, lsysSymbolAt(reading, symbol) + kSymbolArity);
    for (uint32_t i = 0; i < arity; ++i) to.parameters.push_back(lsysEvaluate(reading, program, variables, draws));
  }
}

} // namespace

String startOf(const Table& table, std::span<const GpgpAxiom> axioms) {
  String string;
  const LsysString reading{table.words().data(), nullptr, nullptr, nullptr, 0};
  for (uint32_t a = 0; a < axioms.size(); ++a) {
    const uvec2 key = lsysAxiomKey(reading, axioms[a].seed);
    string.modules.push_back({kSymbolOpen, static_cast<uint32_t>(string.parameters.size()), key.x, key.y});
    string.modules.push_back({kSymbolAxiom, static_cast<uint32_t>(string.parameters.size()), key.x, key.y});
    string.parameters.push_back(std::bit_cast<float>(a));
    append(reading, 0, {kSymbolAxiom, 0, key.x, key.y}, table.axiom(), UINT32_MAX, string);
    string.modules.push_back({kSymbolClose, static_cast<uint32_t>(string.parameters.size()), key.x, key.y});
  }
  return string;
}

bool rewrite(const Table& table, String& string, uint32_t phase, uint32_t step, const Limits& limits,
             uint64_t& modulesNeeded, uint64_t& parametersNeeded) {
  const bool structured =
      (phase == kPhaseMain && (table.has(kLsysContexts) || table.has(kLsysCuts))) || phase == kPhaseCut;
  std::optional<Nodes> nodes;
  if (structured) nodes.emplace(table, string);
  const LsysString reading{table.words().data(), string.modules.data(), string.parameters.data(),
                           nodes ? nodes->nodes.data() : nullptr, nodes ? nodes->leaves : 0};
  const uint32_t count = static_cast<uint32_t>(string.modules.size());
  std::vector<uint32_t> chosen(count);
  uint64_t modules = 0, parameters = 0;
  for (uint32_t i = 0; i < count; ++i) {
    if (structured && table.has(kLsysCuts) && lsysIsCut(reading, i)) {
      chosen[i] = kLsysNowhere;
      continue;
    }
    chosen[i] = lsysChoose(reading, i, string.modules[i], phase, step);
    const uvec2 made = lsysCount(reading, string.modules[i], chosen[i]);
    modules += made.x;
    parameters += made.y;
  }
  modulesNeeded = std::max(modulesNeeded, modules);
  parametersNeeded = std::max(parametersNeeded, parameters);
  if (modules > limits.modules || parameters > limits.parameters) return false;
  String result;
  result.modules.reserve(modules);
  result.parameters.reserve(parameters);
  for (uint32_t i = 0; i < count; ++i)
    if (chosen[i] != kLsysNowhere) append(reading, i, string.modules[i], chosen[i], step, result);
  string = std::move(result);
  return true;
}

Derived derive(const Table& table, std::span<const GpgpAxiom> axioms, uint32_t iterations, const Limits& limits) {
  Derived derived;
  derived.string = startOf(table, axioms);
  derived.modulesNeeded = derived.string.modules.size();
  derived.parametersNeeded = derived.string.parameters.size();
  const uint32_t steps = table.stepCount(iterations);
  for (; derived.steps < steps && derived.complete; derived.steps += derived.complete)
    derived.complete = rewrite(table, derived.string, table.phaseOf(derived.steps, iterations), derived.steps, limits,
                               derived.modulesNeeded, derived.parametersNeeded);
  return derived;
}

Drawn draw(const Table& table, const String& string, std::span<const GpgpAxiom> axioms) {
  const LsysString reading{table.words().data(), string.modules.data(), string.parameters.data(), nullptr, 0};
  struct Turtle {
    LsysFrame frame;
    float elasticity;
    size_t cylinder; // of this branch
  };
  struct Path { // a polygon's or a cylinder's
    size_t instance = 0;
    const GpgpAxiom* axiom = nullptr;
    size_t first = SIZE_MAX, end = 0;
  };
  struct Section {
    size_t depth, cylinder;
    std::array<float, 4> corner;
  };
  constexpr size_t kNone = SIZE_MAX;
  Drawn drawn;
  std::vector<Turtle> stack;
  std::vector<Path> polygons, cylinders;
  std::vector<Section> sections;
  Turtle turtle{lsysStart(reading), table.value(kLsysHeadTropism + 3), kNone};
  const Turtle start = turtle;
  const GpgpAxiom* axiom = axioms.data();
  int inPolygon = 0;
  const auto place = [&](const LsysFrame& f, const vec3& p) {
    const float* m = axiom->transform;
    std::array<float, 4> corner;
    for (size_t row = 0; row < 3; ++row)
      corner[row] = m[4 * row] * p.x + m[4 * row + 1] * p.y + m[4 * row + 2] * p.z + m[4 * row + 3];
    corner[3] = f.l.w;
    return corner;
  };
  for (const uvec4& module : string.modules) {
    const uint32_t* symbol = table.symbol(module.x);
    const uint32_t command = symbol[kSymbolTurtle];
    const LsysFrame& f = turtle.frame;
    // A bracket lies outside what it encloses.
    drawn.depth = std::max(drawn.depth, static_cast<uint32_t>(stack.size() - (command == kTurtleClose)));
    if (command == kTurtleAxiom) {
      axiom = &axioms[std::bit_cast<uint32_t>(string.parameters[module.y])];
      turtle = start;
      continue;
    }
    if (lsysIsCorner(command) && inPolygon > 0) {
      drawn.corners.push_back(place(f, lsysCornerOf(reading, f, module, command)));
      if (!polygons.empty() && polygons.back().axiom == axiom) polygons.back().end = drawn.corners.size();
    }
    if (lsysDraws(command, inPolygon > 0)) {
      const vec3 extents = lsysExtents(reading, f, module, command);
      GpgpInstance instance{};
      const vec4 rows[3] = {lsysUnitRow(f, 0, extents), lsysUnitRow(f, 1, extents), lsysUnitRow(f, 2, extents)};
      for (size_t row = 0; row < 3; ++row) {
        const float* m = axiom->transform + 4 * row;
        const vec4 world = lsysWorldRow(vec4(m[0], m[1], m[2], m[3]), rows[0], rows[1], rows[2]);
        for (int c = 0; c < 4; ++c) instance.transform[4 * row + c] = world[c];
      }
      instance.bucket = instance.terminal = symbol[kSymbolTerminal];
      instance.shape = table.terminal(instance.terminal)[kTerminalShape];
      instance.axiomId = axiom->id;
      instance.seed = lsysSeed(module);
      instance.attribute = f.p.w;
      instance.key[0] = module.z;
      instance.key[1] = module.w;
      instance.size[0] = instance.size[2] = extents.x;
      instance.size[1] = extents.y;
      instance.rule = GPGP_NO_RULE;
      if (command == kTurtlePolygon)
        polygons.push_back({drawn.instances.size(), axiom, drawn.corners.size(), drawn.corners.size()});
      if (command == kTurtleCylinder) {
        turtle.cylinder = cylinders.size();
        cylinders.push_back({drawn.instances.size(), axiom});
      }
      drawn.instances.push_back(instance);
    }
    if (lsysIsSection(command))
      sections.push_back({stack.size(), turtle.cylinder, place(f, vec3(f.p.x, f.p.y, f.p.z))});
    if (command == kTurtlePolygon) ++inPolygon;
    if (command == kTurtlePolygonEnd) --inPolygon;
    if (command == kTurtleOpen) {
      stack.push_back(turtle);
      turtle.cylinder = kNone;
    } else if (command == kTurtleClose) {
      turtle = stack.back();
      stack.pop_back();
    } else {
      turtle.frame = lsysWalk(reading, turtle.frame, module, command, turtle.elasticity);
    }
  }
  // As the device has them: branches lie by depth.
  std::stable_sort(sections.begin(), sections.end(),
                   [](const Section& a, const Section& b) { return a.depth < b.depth; });
  for (const Section& section : sections) {
    if (section.cylinder != kNone) {
      Path& path = cylinders[section.cylinder];
      path.first = std::min(path.first, drawn.corners.size());
      path.end = drawn.corners.size() + 1;
    }
    drawn.corners.push_back(section.corner);
  }
  for (const auto* paths : {&polygons, &cylinders}) {
    for (const Path& path : *paths) {
      drawn.instances[path.instance].rule = static_cast<uint32_t>(path.first);
      drawn.instances[path.instance].size[0] = static_cast<float>(path.end - path.first);
    }
  }
  std::stable_sort(drawn.instances.begin(), drawn.instances.end(),
                   [](const GpgpInstance& a, const GpgpInstance& b) { return a.terminal < b.terminal; });
  return drawn;
}

std::array<uint32_t, 2> hashOf(const Table& table, const String& string) {
  std::array<uint32_t, 2> hash{};
  for (uint32_t i = 0; i < string.modules.size(); ++i) {
    const uvec4& module = string.modules[i];
    uint32_t own = mixBits(module.x + 0x9e3779b9u * i);
    own = mixBits(own ^ module.z);
    own = mixBits(own ^ module.w);
    for (uint32_t p = 0; p < table.symbol(module.x)[kSymbolArity]; ++p)
      own = mixBits(own ^ std::bit_cast<uint32_t>(string.parameters[module.y + p]));
    hash[0] += own;
    hash[1] += mixBits(own + 1u);
  }
  return hash;
}

std::string print(const Table& table, const String& string) {
  std::string text;
  int depth = 0;
  for (const uvec4& module : string.modules) {
    if (module.x == kSymbolAxiom) continue;
    if (module.x == kSymbolClose && --depth == 0) {
      text += '\n';
      continue;
    }
    if (module.x == kSymbolOpen && depth++ == 0) continue;
    const uint32_t* symbol = table.symbol(module.x);
    text += table.name(symbol[kSymbolName]);
    for (uint32_t i = 0; i < symbol[kSymbolArity]; ++i) {
      char digits[32];
      const auto end = std::to_chars(digits, digits + sizeof digits, string.parameters[module.y + i]).ptr;
      text += i ? ',' : '(';
      text.append(digits, end);
    }
    if (symbol[kSymbolArity]) text += ')';
  }
  if (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

} // namespace gpgp::spawn::lsystem
