// How the viewer of `gpgp visibility --motion` moves.
#pragma once
#include <string>

namespace gpgp::cli {

/// What --motion and --eyes say, without the camera.
struct Motion {
  float speed = 0;   ///< along the view, world units per second
  float turn = 0;    ///< degrees per second
  float latency = 0; ///< milliseconds until the result is no longer displayed
  float eyes = 0;    ///< world units

  /// SPEED,TURN,LATENCY
  static Motion parse(const std::string& text);
};

} // namespace gpgp::cli
