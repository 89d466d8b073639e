// The condition of @supports (CSS Conditional Rules 3 and 4).
#pragma once
#include <optional>
#include <string_view>

namespace gpgp::vector::svg {

/// Whether a condition holds: a declaration holds where this importer draws it, `selector()` where it is understood,
/// and other functions do not. Nothing where the condition is malformed.
std::optional<bool> evaluateSupports(std::string_view condition);

/// The same of what stands inside of the brackets of `supports()`, which may be a declaration.
std::optional<bool> evaluateSupportsOfImport(std::string_view inside);

} // namespace gpgp::vector::svg
