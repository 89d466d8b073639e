// `gpgp spawn` of files that derive without an operator graph, and which of its options are for which language.
#pragma once
#include "cli/spawn/options.h"

namespace gpgp::cli {

/// A .cga file alone. Throws Usage where an option was given that means nothing to one.
Outcome spawnCgaFile(const SpawnOptions& options, const CommonOptions& common);
/// An L-system alone, likewise.
Outcome spawnLsystemFile(const SpawnOptions& options, const CommonOptions& common);
/// Throws Usage where an option was given that is for these languages alone.
void expectOfGrammars(const SpawnOptions& options);

} // namespace gpgp::cli
