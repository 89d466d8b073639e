// The fields that a recording or an evaluation has, as shaders/spawn/shared/field.h reads them.
#pragma once
#include "spawn/graph/graph.h"
#include "spawn/shared/layout.h"

#include <gpgp/spawn.h>

#include <array>

namespace gpgp::spawn {

/// By the numbers that fields have in a graph.
struct BoundFields {
  std::array<shader::FieldGrid, shader::kMaxFields> grids{};
  std::array<const float*, shader::kMaxFields> values{}; ///< of an evaluation; grids begin at 0 there
};

/// Where the values lie: in a recording's buffer of so many bytes, or in host memory.
struct FieldSource {
  const GpgpSpawnField* fields;
  uint32_t count;
  const GpgpBuffer* buffer = nullptr; ///< null: in host memory
};

/// Checks a field, and gives it as shaders read it.
core::Result<shader::FieldGrid> fieldGrid(const GpgpSpawnField& field, const FieldSource& source);

/// Finds each field of the graph by its name and checks it. Others are ignored. INVALID_ARGUMENT names the field, and
/// the first rule that reads it where it is missing. The same bits for the same grid, for GPU and CPU.
core::Result<BoundFields> bindFields(const Graph& graph, const FieldSource& source);

} // namespace gpgp::spawn
