// Which operations run side by side: those that touch nothing of each other's. Without it each waits for the one
// before, which is most of what many small layers cost.
#include "vector/raster/layer_boxes.h"

namespace gpgp::vector {
namespace {
using shader::OperationRecord;
using shader::PictureRecord;

bool inRaster(const PictureRecord& p) { return p.stride == 0; }
bool hasPixels(const PictureRecord& p) { return p.pad1 != 0 && p.left < p.right && p.top < p.bottom; }
uint64_t pixelsOf(const PictureRecord& p) { return uint64_t(p.right - p.left) * uint64_t(p.bottom - p.top); }

/// The raster by cells: after which level an operation may read or write there. What an operation has read, none writes
/// later, but for composites, which write where they read.
class Cells {
public:
  static constexpr uint32_t kSide = 32;
  Cells(std::span<uint32_t> room, uint32_t width, uint32_t height)
      : across_((width + kSide - 1) / kSide), count_(across_ * ((height + kSide - 1) / kSide)), cells_(room) {
    std::fill_n(cells_.begin(), count_, 0u);
  }
  uint32_t written(const PictureRecord& p) const {
    uint32_t level = 0;
    each(p, [&](uint32_t cell) { level = std::max(level, cell); });
    return level;
  }
  void write(const PictureRecord& p, uint32_t level) {
    each(p, [&](uint32_t& cell) { cell = std::max(cell, level); });
  }

private:
  template <class F> void each(const PictureRecord& p, const F& visit) const {
    const uint32_t right = p.first + uint32_t(p.right - p.left) - 1, bottom = p.pad0 + uint32_t(p.bottom - p.top) - 1;
    for (uint32_t y = p.pad0 / kSide; y <= bottom / kSide; ++y)
      for (uint32_t x = p.first / kSide; x <= right / kSide; ++x) visit(cells_[size_t(y) * across_ + x]);
  }
  uint32_t across_, count_;
  std::span<uint32_t> cells_;
};
} // namespace

size_t LayerTables::cellsFor(const LayerBudgets& budgets) {
  if (budgets.operations == 0) return 0;
  return size_t(budgets.pixels) / (Cells::kSide * Cells::kSide) + 2 * (16384 / Cells::kSide + 1);
}

/// Gives each picture behind the raster a place of its own, if there is room for all of them, and sorts the operations'
/// steps by levels: those of a level depend on earlier levels alone.
void LayerPlanner::order() {
  if (kept_.operations < 3) return;
  const uint32_t count = kept_.operations - 1;
  const std::span operations = std::span(tables_.operations).subspan(1, count);
  const uint64_t room = budgets_.pixels - uint64_t(kept_.width) * kept_.height;
  uint64_t pixels = 0;
  for (const OperationRecord& o : operations)
    if (!inRaster(o.result)) pixels += pixelsOf(o.result);
  if (pixels > room) return;

  Cells cells(tables_.cells, kept_.width, kept_.height);
  std::fill_n(tables_.starts.begin(), count + 1, 0u);
  uint32_t next = 0;
  for (uint32_t i = 0; i < count; ++i) {
    OperationRecord& o = operations[i];
    uint32_t level = 0;
    for (PictureRecord* from : {&o.a, &o.b, &o.c}) {
      if (!hasPixels(*from)) continue;
      if (inRaster(*from)) {
        level = std::max(level, cells.written(*from));
        continue;
      }
      const uint32_t maker = from->pad0 - 1;
      from->first = operations[maker].result.first;
      level = std::max(level, tables_.levels[maker] + 1);
    }
    if (inRaster(o.result)) {
      if (hasPixels(o.result)) level = std::max(level, cells.written(o.result));
    } else {
      o.result.first = next;
      next += static_cast<uint32_t>(pixelsOf(o.result));
    }
    if (inRaster(o.result) && hasPixels(o.result)) cells.write(o.result, level + 1);
    tables_.levels[i] = level;
    ++tables_.starts[level + 1];
  }
  // From how many there are of each level to where each begins.
  for (uint32_t level = 1; level <= count; ++level) tables_.starts[level] += tables_.starts[level - 1];
  for (uint32_t i = 0; i < count; ++i) tables_.ordered[tables_.starts[tables_.levels[i]]++] = tables_.steps[i];
  tables_.steps.swap(tables_.ordered);
  uint32_t before = UINT32_MAX;
  for (core::Step& step : std::span(tables_.steps).first(count)) {
    const uint32_t level = tables_.levels[step.constant - 1];
    step.alongside = level == before;
    before = level;
  }
}

} // namespace gpgp::vector
