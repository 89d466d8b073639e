// What a recording or an evaluation measures of each axiom, checked, as the shaders take it.
#pragma once
#include "core/result.h"
#include "spawn/outputs/measure.h"

#include <gpgp/spawn.h>

namespace gpgp::spawn {

/// Words of an axiom's grid; 0 without one.
uint32_t gridWords(const GpgpMeasureInfo& info);
/// INVALID_ARGUMENT says what is wrong. terminals: how many the grammar has. The room for axioms is the caller's to
/// say.
core::Result<shader::Measuring> measuringOf(const GpgpMeasureInfo& info, uint32_t terminals);

/// Adds a terminal to an axiom's words (shader::kMeasuredWords) and grid, which begin as 0.
void measure(const shader::Measuring& measuring, const GpgpInstance& instance, uint32_t* words, uint32_t* grid);
/// When all have been added.
GpgpAxiomMeasures finishMeasures(const shader::Measuring& measuring, const uint32_t* target, const uint32_t* words,
                                 const uint32_t* grid);

} // namespace gpgp::spawn
