// The stages in a row, and the tables that the GPU reads.
#include "vector/patch/drawing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gpgp::vector {
namespace {

CurveRecord record(const Monotone& piece) {
  const Point* p = piece.curve.p;
  const auto relative = [&](int i, double Point::*axis) { return static_cast<float>(p[i].*axis - p[0].*axis); };
  CurveRecord r{};
  r.ends = {static_cast<float>(p[0].x), static_cast<float>(p[0].y), relative(3, &Point::x), relative(3, &Point::y)};
  r.controls = {relative(1, &Point::x), relative(1, &Point::y), relative(2, &Point::x), relative(2, &Point::y)};
  r.bend = piece.curve.line ? -1.0f : static_cast<float>(piece.curve.bend());
  return r;
}

float below(double v) { return std::nextafter(static_cast<float>(v), -std::numeric_limits<float>::infinity()); }
float above(double v) { return std::nextafter(static_cast<float>(v), std::numeric_limits<float>::infinity()); }

} // namespace

core::Result<void> addPath(const GpgpPath& path, Drawing& drawing) {
  std::pmr::memory_resource* memory = drawing.curves.get_allocator().resource();
  std::pmr::vector<Monotone> pieces(memory);
  if (auto ok = outline(path, pieces); !ok) return ok;
  mergeCoincident(pieces);
  std::pmr::vector<Cut> cuts(memory);
  if (auto ok = findCrossings(pieces, cuts); !ok) return ok;
  std::pmr::vector<Slab> slabs(memory);
  sweep(pieces, cuts, path.fillRule, slabs);
  if (slabs.size() + drawing.patches.size() > shader::kEntryPatch)
    return core::makeError(GPGP_ERROR_UNSUPPORTED, "the drawing needs more than %u patches", shader::kEntryPatch);
  // Neighbours in the list share boxes at the raster's upper level, so keep the order of the sweep.
  std::sort(slabs.begin(), slabs.end(), [](const Slab& a, const Slab& b) {
    return a.top != b.top ? a.top < b.top : a.left != b.left ? a.left < b.left : a.right < b.right;
  });
  constexpr uint32_t kNone = UINT32_MAX;
  std::pmr::vector<uint32_t> places(pieces.size(), kNone, memory);
  const auto place = [&](uint32_t piece) {
    if (places[piece] == kNone) {
      places[piece] = static_cast<uint32_t>(drawing.curves.size());
      drawing.curves.push_back(record(pieces[piece]));
    }
    return places[piece];
  };
  const uint32_t pathIndex = static_cast<uint32_t>(drawing.paths.size());
  for (const Slab& slab : slabs) {
    const Monotone &l = pieces[slab.left], &r = pieces[slab.right];
    PatchRecord p{};
    p.left = place(slab.left);
    p.right = place(slab.right);
    p.top = slab.top;
    p.bottom = slab.bottom;
    p.x0 = below(std::min(l.xAt(slab.top), l.xAt(slab.bottom)));
    p.x1 = above(std::max(r.xAt(slab.top), r.xAt(slab.bottom)));
    p.path = pathIndex;
    drawing.patches.push_back(p);
    if (drawing.patches.size() == 1) {
      const float first[4] = {p.x0, p.top, p.x1, p.bottom};
      std::copy(first, first + 4, drawing.bounds);
    }
    drawing.bounds[0] = std::min(drawing.bounds[0], p.x0);
    drawing.bounds[1] = std::min(drawing.bounds[1], p.top);
    drawing.bounds[2] = std::max(drawing.bounds[2], p.x1);
    drawing.bounds[3] = std::max(drawing.bounds[3], p.bottom);
  }
  drawing.paths.push_back({{path.color[0], path.color[1], path.color[2], path.color[3]}});
  return {};
}

core::Result<Drawing> makeDrawing(std::span<const GpgpPath> paths, std::pmr::memory_resource* memory) {
  Drawing drawing(memory);
  drawing.paths.reserve(paths.size());
  for (size_t i = 0; i < paths.size(); ++i)
    if (auto ok = addPath(paths[i], drawing); !ok)
      return core::makeError(ok.error().code, "paths[%zu]: %s", i, ok.error().text);
  drawing.viewport[0] = drawing.bounds[0];
  drawing.viewport[1] = drawing.bounds[1];
  drawing.viewport[2] = drawing.bounds[2] - drawing.bounds[0];
  drawing.viewport[3] = drawing.bounds[3] - drawing.bounds[1];
  return drawing;
}

} // namespace gpgp::vector
