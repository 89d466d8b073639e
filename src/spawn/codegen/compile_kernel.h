// Generated GLSL to SPIR-V, by glslang inside this process.
#pragma once
#include "core/result.h"
#include "spawn/codegen/generate.h"
#include "spawn/graph/kernel.h"

#include <span>
#include <string>
#include <vector>

namespace gpgp::spawn {

/// The derivation kernel of a source, for Vulkan 1.2, as Kernel::code. Threads may compile at the same time. Compilers
/// run on a thread with a large stack. A failure is a defect of ours: its text holds the compiler's first messages.
core::Result<std::vector<uint32_t>> compileKernel(const KernelSource& source, KernelTarget target);

/// SPIR-V as kernels have it: cleaned up, and inlined but for software devices. Empty where the optimiser fails.
std::vector<uint32_t> optimize(std::span<const uint32_t> spirv, KernelTarget target);

/// Whether its kernels would be more than the interpreter: less than half of the operators are run by the graph's
/// words.
inline bool isWorthCompiling(const KernelSource& source) { return 2 * source.byWords <= source.operators; }

/// What a failure is said to mean.
constexpr const char* kInterpreted = "there is no kernel for some devices, which interpret this grammar: ";

/// What is to be said about it to people: that some operators are interpreted, or all. Empty where all are code.
std::string remarkOn(const KernelSource& source);

/// What a graph's kernels are worth compiling for, the best of a device first. Colliders are not derived by batches,
/// and those have no queues.
std::span<const KernelTarget> targetsOf(const Graph& graph, Queues queues = Queues::mixed);

/// The whole kernel's text, before its includes are followed: for people.
std::string kernelText(const std::string& functions, KernelTarget target);

} // namespace gpgp::spawn
