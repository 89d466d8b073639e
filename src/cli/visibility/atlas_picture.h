// An engine's two sides of a shading atlas, on the CPU through gpgp/shaders/atlas.h: shading and display.
#pragma once
#include "cli/visibility/views.h"
#include "host/picture.h"

#include <array>
#include <span>
#include <vector>

namespace gpgp::cli {

/// Shades the listed tiles with a pattern of waves in world space, lit by the triangles' normals. Texels that no tile
/// has are black.
host::Picture shadeAtlas(Size size, std::span<const uint32_t> blocks, std::span<const std::array<uint32_t, 2>> tiles,
                         std::span<const glm::vec3> corners);

struct Display {
  host::Picture picture;         ///< left: from the atlas, pixels without a block red; right: shaded directly
  uint64_t shown = 0, holes = 0; ///< pixels that show a triangle; of these, without a block
  double psnr = 0;               ///< over the shown pixels that have one; 100 where both are equal
};

/// Shows the triangles whose bits are set.
Display displayAtlas(Size size, const View& view, const std::vector<uint32_t>& bits, const host::Picture& atlas,
                     std::span<const uint32_t> blocks, std::span<const glm::vec3> corners);

} // namespace gpgp::cli
