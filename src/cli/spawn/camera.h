// The camera of `gpgp spawn`, and the detail with which what it sees stays within a budget.
#pragma once
#include "cli/spawn/options.h"
#include "spawn/schedule/fields.h"
#include "spawn/shared/layout.h"

#include <gpgp/spawn.h>

#include <glm/mat4x4.hpp>

#include <optional>
#include <span>

namespace gpgp::cli {

/// World to clip, of --camera.
glm::mat4 cameraMatrix(const SpawnOptions& options);
/// With the detail of --detail.
GpgpSpawnCamera cameraOf(const SpawnOptions& options);
/// As rules see it. Throws Usage where there is no view.
shader::View viewOf(const std::optional<GpgpSpawnCamera>& camera);

/// --budget: the detail, at most 1, with which the axioms become nearly as many terminals as the budget allows, and no
/// more. gpgpAdaptDetail finds it, and the CPU counts. Throws Failure where there is none. grammar: its name.
float detailWithin(uint32_t budget, GpgpSpawnCamera camera, std::span<const uint32_t> words,
                   const std::vector<GpgpAxiom>& axioms, uint32_t maxDepth, const std::string& grammar,
                   const spawn::BoundFields& fields);

} // namespace gpgp::cli
