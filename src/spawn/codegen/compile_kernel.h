// Generated GLSL to SPIR-V, by glslang inside this process.
#pragma once
#include "core/result.h"
#include "spawn/codegen/generate.h"

#include <string>
#include <vector>

namespace gpgp::spawn {

/// The derivation kernel of a source, for Vulkan 1.2, as Kernel::code. subgroups:
/// for devices with subgroup arithmetic in compute shaders. Threads may compile at the same time. A failure is a defect
/// of ours: its text holds the compiler's first messages.
core::Result<std::vector<uint32_t>> compileKernel(const KernelSource& source, bool subgroups);

/// The whole kernel's text, before its includes are followed: for people.
std::string kernelText(const std::string& functions, bool subgroups);

} // namespace gpgp::spawn
