// What `gpgp vector` was asked for.
#pragma once
#include "cli/shared/command.h"

#include <optional>
#include <string>
#include <vector>

namespace gpgp::cli {

struct VectorOptions {
  std::string file, out, background, stages, antialiasing, method = "flattened";
  Size size;
  std::optional<double> frame; ///< of an animation
  Size sheet;                  ///< columns and rows of frames; 0: none
  double zoom = 1, tilt = 0;
  std::vector<double> center;
  std::vector<std::string> fonts;
  bool allWarnings = false;
  bool reference = false;
  uint32_t repeat = 1, maxTileEntries = 0;
};

constexpr size_t kShownMessages = 10; ///< unless all are asked for

} // namespace gpgp::cli
