// Text of files in messages.
#pragma once
#include <string>
#include <string_view>

namespace gpgp::cli {

/// The text with what a terminal would not show as it is, control characters and what is no UTF-8, as \xNN. Line breaks
/// and tabs stay.
std::string printable(std::string_view text);

} // namespace gpgp::cli
