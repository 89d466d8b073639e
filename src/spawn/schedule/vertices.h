// How a spawner's vertices look, checked and in the words that shaders and the evaluator read.
#pragma once
#include "core/result.h"
#include "spawn/outputs/mesh.h"

#include <gpgp/spawn.h>

#include <array>

namespace gpgp::spawn {

struct VertexLayout {
  uint32_t strideWords = 0;
  uint32_t attributeCount = 0;
  std::array<uint32_t, shader::kMaxVertexAttributes> attributes = {};
};

/// Fails where an attribute is not one that can be written, or lies outside the vertex.
core::Result<VertexLayout> layoutOf(const GpgpVertexLayout& wanted);

} // namespace gpgp::spawn
