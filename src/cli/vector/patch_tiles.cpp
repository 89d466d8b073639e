// A patch's sides never turn in x, so within a row of tiles each passes through the tiles between its ends there, and
// the patch reaches from the first that its left side is in to the last that its right side is in.
#include "cli/vector/patch_tiles.h"

#include "vector/raster/segments.h"

#include <algorithm>
#include <cmath>

namespace gpgp::cli {
namespace {

constexpr double kTile = 8;

/// Where a curve is at a height.
double xAt(const vector::CurveRecord& c, double y) {
  const auto at = [](float v) { return static_cast<double>(v); };
  const double height = at(c.ends.w);
  const double wanted = std::clamp(y - at(c.ends.y), 0.0, height);
  if (!(height > 0)) return at(c.ends.x);
  if (c.bend < 0) return at(c.ends.x) + wanted / height * at(c.ends.z);
  const double t = vector::parameterAt(at(c.controls.y), at(c.controls.w), height, wanted), u = 1 - t;
  return at(c.ends.x) + t * (3 * u * u * at(c.controls.x) + 3 * u * t * at(c.controls.z) + t * t * at(c.ends.z));
}

struct Columns { // of tiles, first to last, in the picture
  double first = 1e30, last = -1e30;
  double count() const { return std::max(last - first + 1, 0.0); }
  void add(const Columns& other) {
    if (other.count() > 0) first = std::min(first, other.first), last = std::max(last, other.last);
  }
};

/// What a patch, or a curve at its side, covers of one row of tiles; patches that are joined follow each other there.
struct InRow {
  double row = -1;
  uint32_t curve = UINT32_MAX;
  Columns columns;
  /// Goes on, or begins the next, and then adds to `counted` what there was.
  void put(double nextRow, uint32_t nextCurve, const Columns& found, double& counted) {
    if (row < nextRow || curve != nextCurve) {
      counted += columns.count();
      *this = {nextRow, nextCurve, {}};
    }
    columns.add(found);
  }
};

} // namespace

PatchTiles countPatchTiles(const vector::Drawing& drawing, const float (&transform)[6], uint32_t width, uint32_t height,
                           std::span<const uint32_t> next) {
  const auto at = [](float v) { return static_cast<double>(v); };
  const double scaleX = at(transform[0]), scaleY = at(transform[3]);
  const double columns = std::ceil(width / kTile), rows = std::ceil(height / kTile);
  const auto between = [&](double a, double b) {
    const auto tile = [&](double x) { return std::floor((x * scaleX + at(transform[4])) / kTile); };
    return Columns{std::max(tile(std::min(a, b)), 0.0), std::min(tile(std::max(a, b)), columns - 1)};
  };
  std::vector<uint8_t> goesOn(drawing.patches.size());
  for (const uint32_t i : next)
    if (i != UINT32_MAX) goesOn[i] = 1;
  double patches = 0, bounding = 0, references = 0, tiled = 0;
  for (uint32_t head = 0; head < drawing.patches.size(); ++head) {
    if (goesOn[head]) continue;
    ++patches;
    InRow all, sides[2];
    for (uint32_t i = head; i != UINT32_MAX; i = next.empty() ? UINT32_MAX : next[i]) {
      const vector::PatchRecord& p = drawing.patches[i];
      const vector::CurveRecord &left = drawing.curves[p.left], &right = drawing.curves[p.right];
      const double top = at(p.top), bottom = at(p.bottom);
      const double ends[2][2] = {{xAt(left, top), xAt(right, top)}, {xAt(left, bottom), xAt(right, bottom)}};
      const double wide = 1e-6 * (1 + std::abs(ends[0][0]) + std::abs(ends[0][1]));
      const bool hasTop = i == head && ends[0][1] - ends[0][0] > wide;
      const bool hasBottom = (next.empty() || next[i] == UINT32_MAX) && ends[1][1] - ends[1][0] > wide;
      bounding += (sides[0].curve != p.left) + (sides[1].curve != p.right) + hasTop + hasBottom;
      const double first = std::floor((top * scaleY + at(transform[5])) / kTile);
      const double last = std::ceil((bottom * scaleY + at(transform[5])) / kTile) - 1;
      const double begin = std::max(first, 0.0);
      const double y0 = std::max((begin * kTile - at(transform[5])) / scaleY, top);
      double l0 = xAt(left, y0), r0 = xAt(right, y0);
      for (double row = begin; row <= std::min(last, rows - 1); ++row) {
        const double y1 = std::min(((row + 1) * kTile - at(transform[5])) / scaleY, bottom);
        const double l1 = xAt(left, y1), r1 = xAt(right, y1);
        all.put(row, 0, between(std::min(l0, l1), std::max(r0, r1)), references);
        sides[0].put(row, p.left, between(l0, l1), tiled);
        sides[1].put(row, p.right, between(r0, r1), tiled);
        if (hasTop && row == first) tiled += between(ends[0][0], ends[0][1]).count();
        if (hasBottom && row == last) tiled += between(ends[1][0], ends[1][1]).count();
        l0 = l1, r0 = r1;
      }
      sides[0].curve = p.left, sides[1].curve = p.right; // also where it lies outside of the picture
    }
    references += all.columns.count();
    for (const InRow& side : sides) tiled += side.columns.count();
  }
  return {static_cast<size_t>(patches), patches > 0 ? bounding / patches : 0, references / (columns * rows),
          references > 0 ? tiled / references : 0};
}

} // namespace gpgp::cli
