#include "spawn/schedule/fields.h"

#include "core/math.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gpgp::spawn {
namespace {
using core::makeError;
using core::Result;

constexpr uint32_t kMostValues = 16384; // along an axis: floats hold parts of steps among so many

/// Steps of the grid in a metre.
float perMetre(float first, float last, uint32_t count) {
  if (count == 1) return 0;
  constexpr double kMost = 1 << 20; // see fieldSteps
  return shader::settle(static_cast<float>(std::min((count - 1) / (static_cast<double>(last) - first), kMost)));
}

Result<void> check(const GpgpSpawnField& field, const FieldSource& source) {
  const GpgpGroundField& grid = field.grid;
  const auto bad = [&](const char* what) {
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "field \"%.64s\": %s", field.name, what);
  };
  if (!grid.width || !grid.height || grid.width > kMostValues || grid.height > kMostValues)
    return bad("width and height are from 1 to 16384");
  for (int axis = 0; axis < 2; ++axis) {
    if (!std::isfinite(grid.min[axis]) || !std::isfinite(grid.max[axis])) return bad("min or max is not finite");
    if ((axis ? grid.height : grid.width) > 1 && !(grid.min[axis] < grid.max[axis]))
      return bad("min is not less than max");
  }
  if (!source.buffer) {
    if (!grid.values) return bad("values is NULL");
    return {};
  }
  if (!source.buffer->buffer) return bad("it is read from fieldValues, whose buffer is NULL");
  if (field.offset % sizeof(float)) return bad("offset is not a multiple of 4");
  const VkDeviceSize bytes = VkDeviceSize(grid.width) * grid.height * sizeof(float), size = source.buffer->size;
  if (bytes > size || field.offset > size - bytes) return bad("it does not lie within fieldValues");
  if (field.offset / sizeof(float) > UINT32_MAX) return bad("offset is more than 2^34 - 4");
  return {};
}
} // namespace

Result<shader::FieldGrid> fieldGrid(const GpgpSpawnField& field, const FieldSource& source) {
  if (auto ok = check(field, source); !ok) return ok.error();
  const GpgpGroundField& grid = field.grid;
  return shader::FieldGrid{shader::settle(grid.min[0]),
                           shader::settle(grid.min[1]),
                           perMetre(grid.min[0], grid.max[0], grid.width),
                           perMetre(grid.min[1], grid.max[1], grid.height),
                           grid.width,
                           grid.height,
                           source.buffer ? static_cast<uint32_t>(field.offset / sizeof(float)) : 0,
                           0};
}

Result<BoundFields> bindFields(const Graph& graph, const FieldSource& source) {
  BoundFields bound;
  if (source.count && !source.fields)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "fields is NULL, fieldCount is %u", source.count);
  for (uint32_t number = 0; number < graph.fields.size(); ++number) {
    const char* name = graph.nameAt(graph.fields[number]);
    const GpgpSpawnField* field = nullptr;
    for (uint32_t i = 0; i < source.count && !field; ++i)
      if (source.fields[i].name && std::strcmp(source.fields[i].name, name) == 0) field = &source.fields[i];
    if (!field) {
      const char* rule = ruleThatReads(graph, number);
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s%.64s reads field \"%.64s\", which is not among fields",
                       rule ? "rule " : "the grammar", rule ? rule : "", name);
    }
    const Result<shader::FieldGrid> grid = fieldGrid(*field, source);
    if (!grid) return grid.error();
    bound.values[number] = source.buffer ? nullptr : field->grid.values;
    bound.grids[number] = *grid;
  }
  return bound;
}

} // namespace gpgp::spawn
