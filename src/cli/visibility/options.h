// The arguments of `gpgp visibility`.
#pragma once
#include "cli/shared/common.h"

#include <gpgp/visibility.h>

#include <optional>

namespace gpgp::cli {

/// How the viewer of --motion moves.
struct Motion {
  float speed = 0;   ///< along the view, world units per second
  float turn = 0;    ///< degrees per second
  float latency = 0; ///< milliseconds until the result is no longer displayed
};

/// How the viewer of --walk moves, 60 frames a second.
struct Walk {
  float speed = 0;      ///< along the view, world units per second
  float turn = 0;       ///< to the right, degrees per second
  uint32_t frames = 60; ///< at least 3
  float maxLate = 0.005f;
};

struct VisibilityOptions {
  std::string model, image, overlay, exportIds, camera, out, display, method = "standard", cell,
                                                                      referenceDevice = "gpu";
  Size size{1280, 720}, grid{1, 1};
  float yaw = 35, pitch = 20, distance = 2;
  uint32_t repeat = 1, orbit = 0, samples = 1, reference = 0, recheck = 256, refinements = 0;
  bool needlessSamples = false; ///< --samples for a method that decides at points of its own
  uint32_t heuristics = GPGP_HEURISTICS_DEFAULT;
  float epsilonStatic = 0.05f, epsilonDynamic = 0.05f, resolution = 1;
  Size atlas;               ///< texels; 0: none
  float texelsPerPixel = 1; ///< of the atlas
  std::optional<Motion> motion;
  std::optional<Walk> walk;
  float eyes = 0;       ///< of a motion
  uint32_t viewers = 8; ///< that see what a motion's cameras are compared with
  bool twoSided = false;
  bool throughWalls = false; ///< view points of a cell behind geometry count as well

  /// How each view is sampled; "cell" is exact over several.
  GpgpSamplingMethod sampling() const;
  uint32_t cameras() const { return orbit ? orbit : 1; }
};

/// Adds all of them; the options must stay where they are.
void addVisibilityOptions(CLI::App& command, VisibilityOptions& options);

} // namespace gpgp::cli
