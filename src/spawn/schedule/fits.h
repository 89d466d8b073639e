// How large the workgroups and stacks of kernels are on a kind of device, and which of the interpreters it has.
#pragma once
#include "core/recorder.h"
#include "spawn/graph/kernel.h"

#include <array>

namespace gpgp::spawn {

/// What fits a kind of device.
struct Limits {
  Fit fit;               ///< of kernels that name none
  Fit uneven;            ///< of those whose derivations are uneven (isUneven): more at work on what is left at the end
  uint32_t expandGroups; ///< workgroups at most
};
const Limits& limitsOf(const core::Device& device);

/// Whether shaders/spawn/derive/derive_batches.glsl can run.
bool takesBatches(const core::Device& device);
bool canRun(const core::Device& device, KernelTarget target);
/// A kernel's own, or what fits it.
Fit fitOf(const core::Device& device, const KernelInfo& info, bool uneven);
/// The interpreter, for grammars with colliders or without.
KernelInfo interpreterFor(const core::Device& device, bool colliders);
/// Whether a kernel's workgroups are one subgroup each and know of it (shaders/spawn/derive/derive.glsl). Those write
/// the report.
bool isOneSubgroup(const core::Device& device, KernelTarget target, const Fit& fit);

/// Of shaders/spawn/derive/derive.glsl.
constexpr uint32_t kDeriveConstants = 5;
std::array<uint32_t, core::kMaxSpecialization> specialization(const core::Device& device, const Fit& fit,
                                                              uint32_t table = 0);

} // namespace gpgp::spawn
