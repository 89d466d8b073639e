// What `gpgp vector` was asked for.
#pragma once
#include "cli/shared/command.h"

#include <optional>
#include <string>
#include <vector>

namespace gpgp::cli {

struct VectorOptions {
  std::string file, out, background, stages, antialiasing, method = "flattened";
  Size size;                      ///< of the picture; 0: the drawing's
  uint32_t width = 0, height = 0; ///< one of them: the other follows the page
  std::optional<double> frame;    ///< of an animation
  Size sheet;                     ///< columns and rows of frames; 0: none
  double zoom = 1, tilt = 0;
  std::vector<double> center;
  std::vector<std::string> fonts;
  bool allWarnings = false;
  bool reference = false;
  uint32_t repeat = 1, maxTileEntries = 0;
};

constexpr size_t kShownMessages = 10;    ///< unless all are asked for
constexpr uint32_t kLargestSide = 16384; ///< of all pictures

struct Antialiasing {
  uint32_t samples; ///< of a pixel
  bool area;        ///< exact areas beside them
};
Antialiasing antialiasingOf(const VectorOptions& options);

/// The picture's size as the options ask for it, which the page completes where it has an extent; 0: they do not.
/// Throws Failure.
Size sizeAsked(const VectorOptions& options, double pageWidth, double pageHeight);

} // namespace gpgp::cli
