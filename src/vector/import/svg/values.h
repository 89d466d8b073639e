// What stands for other values in CSS: var() (CSS Variables 1), calc(), min(), max(), clamp() and more (CSS Values 4).
#pragma once
#include "vector/import/svg/scanner.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace gpgp::vector::svg {

/// Names with their two hyphens, and values without variables.
using CustomProperties = std::map<std::string, std::string, std::less<>>;

/// Whether a value has a var() that has to be replaced first.
bool hasVariables(std::string_view value);
/// With each var() replaced by its value or fallback; nothing where one has neither, or the result is beyond 64 KiB.
std::optional<std::string> withoutVariables(std::string_view value, const CustomProperties* properties);
/// What an element's custom properties come to: its own, in the order of the cascade, above its parent's. Those that
/// refer to themselves have no value.
std::shared_ptr<const CustomProperties> cascadeVariables(const std::shared_ptr<const CustomProperties>& parent,
                                                         const CustomProperties& own);

/// Whether a value begins with a function that `evaluate` knows.
bool isMath(std::string_view text);
/// A sum of lengths, or a number, in user units; angles are in degrees. False where it is malformed, mixes lengths with
/// numbers, or is not finite.
bool evaluate(std::string_view text, const LengthContext& context, LengthAxis axis, double& value);

} // namespace gpgp::vector::svg
