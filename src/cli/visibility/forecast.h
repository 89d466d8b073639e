// What is said before work that takes long.
#pragma once
#include <cstdint>
#include <string>

namespace gpgp::cli {

/// A line about a reference of samples x samples a pixel that takes `seconds`; empty where that is less than a minute.
/// again: it samples false positives again.
std::string forecast(double seconds, uint32_t samples, bool again);

} // namespace gpgp::cli
