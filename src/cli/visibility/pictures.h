// The pictures of `gpgp visibility`: what was seen, and how that compares with standard sampling and a reference.
#pragma once
#include "cli/visibility/options.h"
#include "cli/visibility/views.h"

#include <vector>

namespace gpgp::cli {

inline bool isSet(const std::vector<uint32_t>& bits, size_t i) { return bits[i / 32] >> i % 32 & 1u; }

/// options.image: what a camera saw, from there and from the side: seen triangles orange, all others grey.
void paintSeen(const VisibilityOptions& options, const std::vector<glm::vec3>& corners, const View& view,
               const Bounds& bounds, const std::vector<uint32_t>& bits);

/// options.overlay, figure 6.2, three pixels each way for one of the viewport's: green standard, grey only what the
/// method adds, red false positive, blue false negative. reference may be empty. ofCell: what they hold is of more
/// views than this one.
void paintOverlay(const VisibilityOptions& options, const std::vector<glm::vec3>& corners, const View& view,
                  bool ofCell, const std::vector<uint32_t>& found, const std::vector<uint32_t>& standard,
                  const std::vector<uint32_t>& reference);

} // namespace gpgp::cli
