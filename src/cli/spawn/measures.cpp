#include "cli/spawn/measures.h"

#include "cli/spawn/fit_scorer.h"
#include "core/suggest.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/schedule/measuring.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace gpgp::cli {
namespace {

Json boundsOf(const GpgpSpawnBounds& bounds) {
  if (!(bounds.min[0] <= bounds.max[0])) return {}; // no terminals
  return {{"min", bounds.min}, {"max", bounds.max}};
}

/// Empty where both measured the same: numbers bit for bit, boxes as far as transforms are equal.
std::string differenceOf(const GpgpAxiomMeasures& device, const GpgpAxiomMeasures& cpu) {
  if (device.terminals != cpu.terminals)
    return std::to_string(device.terminals) + " terminals instead of " + std::to_string(cpu.terminals);
  for (size_t m = 0; m < GPGP_MAX_MEASURES; ++m)
    if (device.sums[m] != cpu.sums[m])
      return "measure " + std::to_string(m + 1) + " is " + std::to_string(device.sums[m]) + " / 65536 instead of " +
             std::to_string(cpu.sums[m]) + " / 65536";
  if (device.clamped != cpu.clamped) return "another number of values was clamped";
  for (size_t axis = 0; cpu.terminals && axis < 3; ++axis)
    for (const auto side : {&GpgpSpawnBounds::min, &GpgpSpawnBounds::max}) {
      const float a = (device.bounds.*side)[axis], b = (cpu.bounds.*side)[axis];
      if (!(std::abs(a - b) <= 1e-3f * std::max(1.0f, std::abs(b)))) return "another box";
    }
  return {};
}

} // namespace

GpgpMeasure measureNamed(const std::string& terminal, const std::string& factors, const spawn::Graph& graph,
                         const std::string& text) {
  const auto wrong = [&](const std::string& why) { return Usage("--measure " + text + ": " + why); };
  GpgpMeasure measure{GPGP_ALL_TERMINALS, 0};
  core::Suggestion suggestion(terminal);
  for (uint32_t t = 0; t < graph.terminals.size(); ++t) {
    suggestion.offer(graph.nameAt(graph.terminals[t].name));
    if (terminal == graph.nameAt(graph.terminals[t].name)) measure.terminal = t;
  }
  if (measure.terminal == GPGP_ALL_TERMINALS && terminal != "all")
    throw wrong("the grammar has no terminal \"" + terminal + "\"" + suggestion.text());
  if (factors.empty()) throw wrong("FACTORS are letters of x, y, z and a (the attribute), or count");
  for (const char factor : factors != "count" ? factors : std::string()) {
    const size_t bit = std::string("xyza").find(factor);
    if (bit == std::string::npos) throw wrong("FACTORS are letters of x, y, z and a (the attribute), or count");
    measure.factors |= 1u << bit;
  }
  return measure;
}

GpgpAxiomMeasures measureOnCpu(std::span<const uint32_t> grammar, const GpgpMeasureInfo& info, uint32_t terminals,
                               const GpgpAxiom& axiom, uint32_t maxDepth, const World& world,
                               std::vector<uint32_t>& cells) {
  const auto measuring = spawn::measuringOf(info, terminals);
  if (!measuring) throw Failure(measuring.error().text);
  spawn::DeriveOptions how;
  if (maxDepth) how.maxDepth = maxDepth;
  how.view = world.view;
  how.fields = world.fields;
  const spawn::Derivation all = spawn::derive(grammar, std::span(&axiom, 1), how);
  std::array<uint32_t, shader::kMeasuredWords> words{};
  cells.assign(std::max<size_t>(spawn::gridWords(info), 1), 0);
  for (const GpgpInstance& instance : all.instances) spawn::measure(*measuring, instance, words.data(), cells.data());
  return spawn::finishMeasures(*measuring, info.occupancy ? info.occupancy->target : nullptr, words.data(),
                               cells.data());
}

Json measureAxioms(Session& session, const BakedGraph& grammar, const std::vector<std::string>& texts,
                   const std::vector<GpgpAxiom>& axioms, const DeriverOptions& how, const World& world) {
  if (grammar.graph.phases)
    throw Usage("--measure is not for grammars with colliders, which know those of all axioms of a recording");
  if (texts.size() > GPGP_MAX_MEASURES)
    throw Usage("--measure: there are at most " + std::to_string(GPGP_MAX_MEASURES) + " measures");
  std::vector<GpgpMeasure> measures;
  for (const std::string& text : texts) {
    const size_t colon = text.find(':');
    if (colon == std::string::npos) throw Usage("--measure " + text + ": expected TERMINAL:FACTORS");
    measures.push_back(measureNamed(text.substr(0, colon), text.substr(colon + 1), grammar.graph, text));
  }
  const GpgpMeasureInfo info{measures.data(), static_cast<uint32_t>(measures.size()), nullptr};
  FitScorer scorer(session, grammar, info, how);
  const std::vector<GpgpAxiomMeasures> measured = scorer.measure(axioms);
  Json list = Json::array();
  std::vector<uint32_t> cells;
  for (size_t i = 0; i < axioms.size(); ++i) {
    const GpgpAxiomMeasures cpu =
        measureOnCpu(grammar.words, info, static_cast<uint32_t>(grammar.graph.terminals.size()), axioms[i],
                     how.maxDepth, world, cells);
    if (const std::string what = differenceOf(measured[i], cpu); !what.empty())
      throw Failure("axiom " + std::to_string(i) + ": the device measured something else than the CPU: " + what +
                    "; please report this");
    Json sums = Json::object();
    for (size_t m = 0; m < texts.size(); ++m) sums[texts[m]] = static_cast<double>(measured[i].sums[m]) / 65536;
    list.push_back({{"axiom", i},
                    {"id", axioms[i].id},
                    {"terminals", measured[i].terminals},
                    {"sums", sums},
                    {"clamped", measured[i].clamped},
                    {"bounds", boundsOf(measured[i].bounds)}});
  }
  return list;
}

} // namespace gpgp::cli
