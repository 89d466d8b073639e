// Layered drawing of directed graphs (Sugiyama, Tagawa, Toda 1981): boxes in layers, edges from top to bottom, edges of
// cycles up along lanes of their own, so that no edge crosses a box.
#pragma once
#include <cstdint>
#include <vector>

namespace gpgp::spawn {

struct LayoutBox {
  double width = 0, height = 0;
  bool isLast = false; ///< in a layer below all that are not
  // made:
  double x = 0, top = 0;  ///< centre and upper side
  double layerBottom = 0; ///< below it, edges may turn
};

/// A straight piece down through a layer, or up in an edge of a cycle.
struct LayoutLane {
  double x = 0, top = 0, bottom = 0;
};

/// Leaves its source at the lower side and enters its target at the upper one.
struct LayoutEdge {
  uint32_t from = 0, to = 0;
  double fromOffset = 0, toOffset = 0; ///< from the boxes' centres
  // made:
  std::vector<LayoutLane> lanes; ///< in the direction of travel
  bool isBack = false;           ///< leads up, or to the same layer; only where to <= from
};

struct Layout {
  std::vector<LayoutBox> boxes; ///< sources first, as far as there are no cycles
  std::vector<LayoutEdge> edges;
  double gap = 0; ///< between layers
  // made:
  double width = 0, height = 0;

  /// Fills in what is made. The picture begins at 0, 0.
  void run();
};

} // namespace gpgp::spawn
