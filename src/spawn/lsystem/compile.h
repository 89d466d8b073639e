// Text of a .lsys file to a table.
#pragma once
#include "spawn/language/diagnostics.h"
#include "spawn/lsystem/syntax.h"

#include <memory_resource>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace gpgp::spawn::lsystem {

/// The words of the table; nothing where there were errors. A table that comes out is one that Table::load takes.
/// start: of a file of several systems, the one to compile; empty: the first.
std::optional<std::vector<uint32_t>> compile(std::string_view text, std::span<const Override> overrides,
                                             Diagnostics& diagnostics, const ReadFile& read = {},
                                             std::string_view start = {});

} // namespace gpgp::spawn::lsystem
