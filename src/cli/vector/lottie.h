// `gpgp vector` of a Lottie animation: a frame, or a sheet of frames.
#pragma once
#include "cli/vector/options.h"

#include <string_view>

namespace gpgp::cli {

/// JSON, or a zip archive.
bool isLottie(std::string_view bytes);

Outcome lottie(const VectorOptions& options, const CommonOptions& common, const std::string& bytes);

} // namespace gpgp::cli
