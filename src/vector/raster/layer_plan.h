// What a recording does about drawings with layers (patch/layers.h): which parts of them are rasterised where, and
// which operations make a picture of these.
//
// All parts are rasterised at once, into one large picture: the canvas itself at its origin, beside and below it a
// region for each layer, mask and clip, and for what is painted between layers. Operations (operation.h) then work on
// regions and on pictures behind them. Regions are only as large as what can be seen of them, with what filters read
// around it.
#pragma once
#include "core/recorder.h"
#include "vector/layers/operation.h"
#include "vector/raster/drawing_asset.h"
#include "vector/raster/place.h"

#include <functional>

namespace gpgp::vector {

struct LayerBudgets {
  uint32_t pixels, operations;
};

/// Whole pixels of the canvas, or of a picture that is smaller by a factor.
struct PixelBox {
  int left = 0, top = 0, right = 0, bottom = 0;
  bool empty() const { return left >= right || top >= bottom; }
  bool operator==(const PixelBox&) const = default;
};

/// Where a part is rasterised: the box of the canvas, moved to (x, y).
struct LayerRegion {
  PixelBox box;
  int x = 0, y = 0;
  bool operator==(const LayerRegion&) const = default;
};
/// What is rasterised in a region: a run of a drawing, or something of a list with layers.
struct PlacedRun {
  uint32_t unit; ///< which of the things that a recording shows
  uint32_t run;  ///< of a drawing
  float opacity;
  LayerRegion region;
  Map map;                                 ///< drawing space to the canvas
  static constexpr uint32_t kNone = ~0u;   ///< no command of a list
  uint32_t command = kNone, count = kNone; ///< count: of commands; 0: all that the clips around the command show;
                                           ///< kNone: a run of the drawing that the command adds
  bool outermost = true;                   ///< the item's scissor counts
};

/// What has been composited onto a picture: paths that meet none of it may still be rasterised there.
class Composited {
public:
  explicit Composited(bool all) : all_(all) {}
  bool meets(const PixelBox& box) const;
  void add(const PixelBox& box);

private:
  std::array<PixelBox, 32> boxes_;
  uint32_t count_ = 0;
  const bool all_;
};

/// Room for what one recording has, made once.
struct LayerTables {
  LayerTables(const LayerBudgets& budgets, uint32_t maxRuns, std::pmr::memory_resource* memory)
      : operations(budgets.operations, memory), steps(budgets.operations, memory), runs(maxRuns, memory),
        filters(kMaxNestedSteps, memory), ordered(budgets.operations, memory), levels(budgets.operations, memory),
        starts(budgets.operations + size_t(1), memory), cells(cellsFor(budgets), memory) {}
  static size_t cellsFor(const LayerBudgets& budgets);
  /// A picture while operations are listed: in a region of the raster, or behind all of them.
  struct Picture {
    PixelBox box;
    bool region = true, srgb = false;
    uint32_t x = 0, y = 0, first = 0;
    uint32_t maker = 0; ///< the operation whose result it is
  };
  struct FilterStep {
    PixelBox need;
    Picture made;
  };
  std::pmr::vector<shader::OperationRecord> operations; ///< the first says where the canvas lies
  std::pmr::vector<core::Step> steps;                   ///< of the operations behind it
  std::pmr::vector<PlacedRun> runs;                     ///< in painting order
  std::pmr::vector<FilterStep> filters;                 ///< of those at hand, in each other
  // order()'s: steps by levels; of each operation its level; where each level begins; cells of the raster.
  std::pmr::vector<core::Step> ordered;
  std::pmr::vector<uint32_t> levels, starts, cells;
};

/// Lists what a recording's units do, one after another. A unit is a thing that the raster draws: an item, or one
/// drawing of a list.
class ListLayers;
class LayerPlanner {
public:
  /// `passes`: by OPERATIONS (operate.comp).
  LayerPlanner(LayerTables& tables, const LayerBudgets& budgets, const std::array<uint32_t, 6>& passes,
               uint32_t maxBins, const GpgpCanvasInfo& info);

  /// A drawing without layers, a text, shapes.
  void addPlain();
  /// `visible`: left, top, right, bottom in pixels. The error says what is not supported; it has no place.
  core::Result<void> addLayered(const DrawingAsset& drawing, uint32_t slot, const Map& map, float opacity,
                                const shader::vec4& visible);
  /// There is no room for what follows.
  void close() { closed_ = true; }
  /// Call behind the last unit.
  void finish();

  /// Whether there is anything to be composited.
  bool composites() const { return kept_.operations > 1; }
  uint32_t units() const { return keptUnits_; } ///< those from here on find no room
  uint32_t width() const { return kept_.width; }
  uint32_t height() const { return kept_.height; }
  const PixelBox& canvas() const { return canvas_; }
  std::span<const PlacedRun> runs() const { return std::span(tables_.runs).first(kept_.runs); }
  std::span<const shader::OperationRecord> operations() const {
    return std::span(tables_.operations).first(kept_.operations);
  }
  std::span<const core::Step> steps() const { return std::span(tables_.steps).first(kept_.operations - 1); }
  uint32_t runsNeeded() const { return layered_ ? state_.runs : 0; }
  uint32_t pixelsNeeded() const;
  uint32_t operationsNeeded() const { return layered_ ? state_.operations : 0; }

private:
  friend ListLayers;
  using Picture = LayerTables::Picture;
  struct State {
    uint32_t width = 0, height = 0;      ///< of the raster
    uint32_t columnX = 0, columnY = 0;   ///< regions lie in columns; this one's left, and how far down it reaches
    uint32_t shelfX = 0, shelfY = 0;     ///< in a column they lie in rows, one beside the other
    bool tooLarge = false;               ///< a picture is larger than can be dispatched
    uint64_t pixels = 0, mostPixels = 0; ///< of pictures behind the raster: in use, and at most so far
    uint32_t operations = 1, runs = 0;
  };
  struct Around {                ///< what a part of a drawing is planned in
    const DrawingAsset* drawing; ///< null: a layer of a list, whose filters have no tables
    const LayerPlan& plan;
    const LayerBounds& bounds;
    const Map& map;
    uint32_t slot; ///< of the drawing's buffer
  };
  bool fits() const;
  void endUnit(bool layered);
  void order();
  Picture region(const PixelBox& box);
  Picture picture(const PixelBox& box, bool srgb); ///< the next operation's result
  void place(uint32_t run, float opacity, const Picture& where, const Map& map, uint32_t command = PlacedRun::kNone,
             uint32_t count = PlacedRun::kNone);
  shader::OperationRecord& operation(uint32_t kind, uint32_t pass, const Picture& result);
  shader::OperationRecord& composite(const Picture& onto, const Picture& from, float opacity, uint32_t blend);

  PixelBox pixels(const Map& map, const Box& box) const;
  void sequence(const Around& a, const LayerSequence& s, const Picture& onto, bool clean, float opacity);
  void layer(const Around& a, uint32_t node, const Picture& onto, float opacity);
  /// What a filter works on: where it has anything, whether the filter's region holds all of that, and its picture,
  /// which `paint` makes in a box of pixels.
  struct FilterInput {
    PixelBox box;
    bool whole;
    const std::function<Picture(const PixelBox&)>& paint;
  };
  bool filter(const Around& a, const LayerNode& node, uint32_t index, const PixelBox& shown, Picture& result);
  bool filter(const Around& a, const LayerNode& node, const FilterInput& given, const PixelBox& shown, Picture& result);
  Picture step(const Around& a, const LayerNode& node, uint32_t index, const Map& space, const PixelBox& need,
               const Picture& first, const Picture& second);
  Picture blur(const Picture& from, double deviationX, double deviationY, const Map& space, const PixelBox& need,
               bool srgb);
  Picture as(const Picture& from, bool srgb);
  void setRegion(shader::OperationRecord& o, const Map& space, const float* region) const;

  LayerTables& tables_;
  const LayerBudgets budgets_;
  const std::array<uint32_t, 6> passes_;
  const uint32_t maxBins_;
  const bool srgb_;
  const PixelBox canvas_;
  Picture root_, base_; ///< the canvas; where plain things are rasterised
  bool rootFits_ = false;
  bool layered_ = false; ///< there are drawings with layers
  bool closed_ = false;  ///< nothing more has room
  bool clean_ = true;    ///< nothing has been composited onto the canvas
  bool open_ = true;     ///< base_ takes what is added next
  State state_, kept_;
  uint32_t unit_ = 0, keptUnits_ = UINT32_MAX;
  size_t filterSteps_ = 0; ///< of tables_.filters, in use
  shader::OperationRecord unused_{};
  core::Step unusedStep_{};
};

} // namespace gpgp::vector
