// Entities of the internal document type definition, as old drawing programs write them.
#pragma once
#include "core/result.h"

#include <string>

namespace gpgp::vector::svg {

/// Puts in place of each &name; what the definition says, quotes escaped inside tags and newlines as spaces, so that
/// lines stay where they are. What is not defined, or in another file, stays as it is. Errors: INVALID_DATA where an
/// entity contains itself, which names the place, or where the text comes to more than `maxBytes`.
core::Result<void> expandEntities(std::string& text, size_t maxBytes);

} // namespace gpgp::vector::svg
