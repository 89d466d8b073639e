// A drawing's patches as a canvas rasterises them tile by tile: for each its box, its curves by number, and its path.
//
// All paths have them, those of clips included, as the canvas composites what comes of it like any path.
#include "vector/patch/patch_reader.h"
#include "vector/patch/patches.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gpgp::vector {
namespace {
using shader::PatchReader;
using shader::TilePatchRecord;
using shader::vec4;

double exact(float v) { return static_cast<double>(v); }

/// The box of a patch: its rows, and where its curves pass in them.
vec4 boxOf(const JoinedPath& path, const JoinedPatch& patch) {
  double low = 1e300, high = -1e300;
  for (uint32_t k = 0; k < patch.curveCount; ++k) {
    const FormCurve& c = path.curves[patch.curves[k]];
    for (const double y : {std::max(exact(patch.top), exact(c.y0)), std::min(exact(patch.bottom), exact(c.y1))}) {
      const double x = c.xAt(y), margin = 1e-6 * std::abs(x);
      low = std::min(low, x - margin);
      high = std::max(high, x + margin);
    }
  }
  constexpr float kFar = std::numeric_limits<float>::infinity();
  return {std::nextafter(static_cast<float>(low), -kFar), patch.top, std::nextafter(static_cast<float>(high), kFar),
          patch.bottom};
}

} // namespace

core::Result<TilePatches> makeTilePatches(const Drawing& drawing, std::pmr::memory_resource* memory) {
  TilePatches made(memory);
  std::pmr::vector<uint32_t> places(memory);
  auto slab = drawing.patches.begin();
  auto run = drawing.plan.runs.begin(); // runs are drawings of their own, whose paths count from their first one
  uint32_t begin = 0;
  for (uint32_t index = 0; index < drawing.paths.size(); ++index) {
    for (; run != drawing.plan.runs.end() && run->firstPath <= index; ++run)
      if (run->pathCount) begin = run->firstPath;
    const auto first = slab;
    while (slab != drawing.patches.end() && slab->path == index) ++slab;
    const JoinedPath path = joinSlabs(drawing, std::span(first, slab), shader::kMaxTileCurves, memory);
    places.clear();
    for (const FormCurve& c : path.curves) {
      places.push_back(static_cast<uint32_t>(made.curves.size()) | c.kind << PatchReader::kPatchCurveKind);
      appendCurve(c, made.curves);
    }
    if (made.curves.size() > PatchReader::kPatchCurvePlace)
      return core::makeError(GPGP_ERROR_UNSUPPORTED, "the drawing has too many curves for patches");
    for (const JoinedPatch& p : path.patches) {
      TilePatchRecord record{boxOf(path, p), {}, p.curveCount, p.lefts, index - begin, 0};
      for (uint32_t k = 0; k < p.curveCount; ++k) record.curves[k / 4][static_cast<int>(k % 4)] = places[p.curves[k]];
      made.patches.push_back(record);
    }
    made.ends.push_back(static_cast<uint32_t>(made.patches.size()));
  }
  return made;
}

} // namespace gpgp::vector
