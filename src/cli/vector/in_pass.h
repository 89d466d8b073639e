// `gpgp vector --method in-pass`: the drawing as geometry inside a render pass.
#pragma once
#include "cli/shared/session.h"

#include <gpgp/vector.hpp>

#include <array>

namespace gpgp::cli {

/// Drawing to pixels: (x, y, w) of (x, y, 1), row by row.
using PlaneMap = std::array<std::array<double, 3>, 3>;

struct InPassInfo {
  PlaneMap map;
  uint32_t width = 0, height = 0;
  uint32_t samples = 1; ///< of the attachment; 1: exact coverage
  std::array<float, 4> background{};
  uint32_t repeat = 1;
};
struct InPassPicture {
  GpuTimes times;             ///< of the render pass: clear, draw, resolve
  std::vector<uint8_t> bytes; ///< RGBA, premultiplied as sRGB encodes it
};
InPassPicture drawInPass(Session& session, const Drawing& drawing, const InPassInfo& info);

} // namespace gpgp::cli
