// Generated GLSL to SPIR-V, by glslang inside this process.
#pragma once
#include "core/result.h"
#include "spawn/codegen/generate.h"
#include "spawn/graph/kernel.h"

#include <span>
#include <string>
#include <vector>

namespace gpgp::spawn {

/// The derivation kernel of a source, for Vulkan 1.2, as Kernel::code. Threads may compile at the same time. A failure
/// is a defect of ours: its text holds the compiler's first messages.
core::Result<std::vector<uint32_t>> compileKernel(const KernelSource& source, KernelTarget target);

/// What a graph's kernels are worth compiling for, the best of a device first. Colliders are not derived by batches.
std::span<const KernelTarget> targetsOf(const Graph& graph);

/// The whole kernel's text, before its includes are followed: for people.
std::string kernelText(const std::string& functions, KernelTarget target);

} // namespace gpgp::spawn
