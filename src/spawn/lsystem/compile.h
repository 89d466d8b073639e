// Text of a .lsys file to a table.
#pragma once
#include "spawn/language/diagnostics.h"

#include <memory_resource>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace gpgp::spawn::lsystem {

/// New value for a constant, or for one of iterations, angle, step, width and seed.
struct Override {
  std::string_view name;
  float value;
};

/// The words of the table; nothing where there were errors. A table that comes out is one that Table::load takes.
std::optional<std::vector<uint32_t>> compile(std::string_view text, std::span<const Override> overrides,
                                             Diagnostics& diagnostics);

} // namespace gpgp::spawn::lsystem
