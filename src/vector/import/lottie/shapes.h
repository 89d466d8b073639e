// Lists of shapes at a frame: which paths there are, how modifiers change them, and what paints them.
#pragma once
#include "vector/import/lottie/model.h"
#include "vector/import/lottie/path.h"

#include <functional>

namespace gpgp::vector::lottie {

/// Paths that a modifier changes as one: those of one entry of a list.
struct PathEntry {
  std::vector<Contour> contours;
  Affine map;           ///< to the space of the whole list
  bool evenOdd = false; ///< whatever the fill says
};

/// A fill or stroke, or a group that fades as one.
struct PaintNode {
  const ShapeItem* paint = nullptr; ///< null: a group
  double opacity = 1;
  Affine map;                      ///< the paint's space to that of the whole list
  std::vector<uint32_t> entries;   ///< what is painted
  std::vector<PaintNode> children; ///< from the top down
};

struct PaintTree {
  std::vector<PathEntry> entries;
  std::vector<PaintNode> nodes; ///< from the top down
};

/// spend(points): false where there is no room for more of them.
PaintTree paintsOf(const std::vector<ShapeItem>& items, double frame, const std::function<bool(size_t)>& spend);

} // namespace gpgp::vector::lottie
