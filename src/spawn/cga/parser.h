// Tokens of a .cga file to its tree.
#pragma once
#include "spawn/cga/lexer.h"
#include "spawn/cga/syntax.h"

namespace gpgp::spawn::cga {

/// All errors of the file are reported; what was understood besides is in the result.
File parse(std::string_view text, std::string path, Diagnostics& errors);

/// Nested deeper, an expression or a body is an error.
inline constexpr uint32_t kMostNested = 256;
/// Operators of one expression in a row.
inline constexpr uint32_t kDeepestExpression = 2000;

} // namespace gpgp::spawn::cga
