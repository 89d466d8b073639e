// `--measure TERMINAL:FACTORS`: what is summed up over the terminals of each axiom, on the device and on the CPU.
#pragma once
#include "cli/shared/session.h"
#include "cli/spawn/axioms.h"
#include "cli/spawn/reference.h"
#include "cli/tune/deriver.h"
#include "spawn/evaluator/evaluator.h"

#include <gpgp/spawn.h>

namespace gpgp::cli {

/// TERMINAL (or all) and FACTORS (letters of x, y, z and a, or count). Throws Usage that names the option's text.
GpgpMeasure measureNamed(const std::string& terminal, const std::string& factors, const spawn::Graph& graph,
                         const std::string& text);

/// What the CPU measures of an axiom, and the cells of the grid that it occupies.
GpgpAxiomMeasures measureOnCpu(std::span<const uint32_t> grammar, const GpgpMeasureInfo& info, uint32_t terminals,
                               const GpgpAxiom& axiom, uint32_t maxDepth, const World& world,
                               std::vector<uint32_t>& cells);

/// `gpgp spawn --measure`, of every axiom: by the device, and each checked against the CPU. how: its depth, camera
/// and fields, which world has for the CPU. Throws Usage for wrong texts, Failure where the two differ.
Json measureAxioms(Session& session, const BakedGraph& grammar, const std::vector<std::string>& texts,
                   const std::vector<GpgpAxiom>& axioms, const DeriverOptions& how, const World& world);

} // namespace gpgp::cli
