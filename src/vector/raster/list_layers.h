// What a recording does about lists with layers (patch/layers.h says what drawings have): a walk over the list's
// commands that tells the planner which stretches of them are rasterised where, and what is composited with what.
//
// A stretch is a row of commands between layers. Whatever lies behind a layer that it may touch is rasterised apart and
// composited in turn, as with drawings. The clips around a layer become a run of their own: a picture of all that they
// show.
#pragma once
#include "vector/raster/layer_plan.h"
#include "vector/ui/list.h"

namespace gpgp::vector {

/// Whether a list has layers, or drawings that have.
bool hasLayers(const List& list);

class ListLayers {
public:
  using Bind = std::function<core::Result<uint32_t>(const DrawingAsset&)>;
  /// `visible`: the item's scissor. `bind`: the slot of a drawing's tables, UINT32_MAX without room.
  ListLayers(LayerPlanner& planner, const List& list, const Map& map, const shader::vec4& visible, const Bind& bind)
      : planner_(planner), list_(list), map_(map), visible_(visible), bind_(bind) {}
  /// The whole list, as one unit. The error has no place.
  core::Result<void> plan(float opacity);

private:
  using Picture = LayerPlanner::Picture;
  /// What the clips around a command leave.
  struct Cut {
    PixelBox box;
    bool whole; ///< all pixels of the box
  };
  Cut cutOf(uint32_t clip) const;
  Map mapOf(const List::Space& space) const { return compose(compose(map_, list_.bases()[space.base]), space.map()); }
  PixelBox boxOf(const List::Command& command) const;
  PixelBox contentBox(uint32_t first, uint32_t end) const;
  core::Result<void> range(uint32_t first, uint32_t end, const Picture& onto, bool clean, float opacity);
  core::Result<void> layer(uint32_t command, const Picture& onto, float opacity, PixelBox& changed);
  core::Result<void> drawing(uint32_t command, const Picture& onto, float opacity, PixelBox& changed);
  /// How a command's picture is composited: cut by the clips around it and by a mask.
  struct Finish {
    uint32_t command;
    Cut cut;
    bool outermost;
    const List::Layer* layer; ///< null: of a drawing
    Picture mask;
  };
  void paint(const Finish& finish, const Picture& onto, const Picture& own, float opacity, uint32_t blend);
  void place(uint32_t command, uint32_t count, bool outermost, const Picture& where, float opacity);
  core::Result<Picture> maskOf(const List::Layer& layer, const PixelBox& shown);

  LayerPlanner& planner_;
  const List& list_;
  const Map map_;
  const shader::vec4 visible_;
  const Bind& bind_;
  uint32_t visited_ = 0, depth_ = 0; ///< depth: layers and masks at hand, in each other
  core::Result<void> failed_;        ///< inside of a filter's content
};

} // namespace gpgp::vector
