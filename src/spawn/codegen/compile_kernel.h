// Generated GLSL to SPIR-V, by glslang inside this process.
#pragma once
#include "core/result.h"

#include <string>
#include <vector>

namespace gpgp::spawn {

/// The derivation kernel whose functions are given (generate.h), for Vulkan 1.2. subgroups: for devices with subgroup
/// arithmetic in compute shaders. Threads may compile at the same time.
/// A failure is a defect of ours: its text holds the compiler's first messages.
core::Result<std::vector<uint32_t>> compileKernel(const std::string& functions, bool subgroups);

/// The whole kernel's text, before its includes are followed: for people.
std::string kernelText(const std::string& functions, bool subgroups);

} // namespace gpgp::spawn
