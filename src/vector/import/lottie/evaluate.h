// An animation at a frame, as paths, groups and layers.
//
// Everything is worked out from the frame alone, so frames may come in any order. What a frame may cost is bounded:
// compositions in each other, layers, paths and points; what is more is left out, and a message says so once.
#pragma once
#include "vector/import/lottie/read.h"
#include "vector/import/svg/import.h"

namespace gpgp::vector::lottie {

struct EvaluateLimits {
  uint32_t depth = 64;       ///< compositions in each other
  size_t layers = 65'536;    ///< visited, as often as compositions are shown
  size_t paths = 100'000;    ///< painted
  size_t points = 4'000'000; ///< of paths, also of those that modifiers take and make
  uint32_t clips = 15;       ///< groups with a clip in each other
  uint32_t effects = 28;     ///< layers, masks and fading groups in each other
};

struct EvaluateInfo {
  double scale = 1;     ///< pixels per unit
  svg::TextShaper text; ///< of fonts whose glyphs the file does not hold
  EvaluateLimits limits;
};

/// Reporter: what the limits cut.
svg::Imported evaluate(const Animation& animation, double frame, const EvaluateInfo& info, Reporter& reporter);

/// A number by which equal frames are known.
uint64_t contentOf(const svg::Imported& frame);

/// What a transform is at a frame; the last argument turns it further, radians.
Affine matrixOf(const Transform& transform, double frame, double turn = 0);
/// Of a repeater's copy: as if the transform were applied `times` over.
Affine repeatedMatrix(const Transform& transform, double frame, double times);

} // namespace gpgp::vector::lottie
