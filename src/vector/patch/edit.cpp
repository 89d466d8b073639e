// A drawing with some of its paths replaced: only these are converted, everything else is copied.
//
// Curves are numbered as patches come to use them, paints as paths do, which is how conversion numbers them: so the
// tables equal those of all paths converted together.
#include "vector/patch/drawing.h"

#include <algorithm>

namespace gpgp::vector {
namespace {

bool pageIsInk(const Drawing& d) {
  return d.viewport[0] == d.bounds[0] && d.viewport[1] == d.bounds[1] && d.viewport[2] == d.bounds[2] - d.bounds[0] &&
         d.viewport[3] == d.bounds[3] - d.bounds[1];
}

} // namespace

uint32_t clipPaths(const Drawing& drawing) {
  uint32_t count = 0;
  for (const ClipRecord& clip : drawing.clips) count += clip.pathCount;
  return count;
}

core::Result<Drawing> replacePaths(const Drawing& base, std::span<const GpgpPathEdit> edits,
                                   std::pmr::memory_resource* memory, uint64_t mostBytes) {
  const uint32_t hidden = clipPaths(base), shown = static_cast<uint32_t>(base.paths.size()) - hidden;
  std::pmr::vector<const GpgpPath*> replaced(base.paths.size(), nullptr, memory);
  for (size_t i = 0; i < edits.size(); ++i) {
    if (edits[i].index >= shown)
      return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "edits[%zu].index is %u; the drawing has %u paths", i,
                             edits[i].index, shown);
    replaced[hidden + edits[i].index] = &edits[i].path;
  }
  core::Result<Drawing> result = Drawing(memory);
  Drawing& drawing = *result;
  drawing.curves.reserve(base.curves.size());
  drawing.patches.reserve(base.patches.size());
  drawing.paths.reserve(base.paths.size());
  drawing.clips = base.clips;
  drawing.layers = base.layers;
  constexpr uint32_t kNone = UINT32_MAX;
  std::pmr::vector<uint32_t> places(base.curves.size(), kNone, memory);
  OutlineRoom room(mostBytes);
  size_t patch = 0, firstShown = 0;
  for (uint32_t i = 0; i < base.paths.size(); ++i) {
    if (i == hidden) firstShown = drawing.patches.size();
    const size_t first = patch;
    while (patch < base.patches.size() && base.patches[patch].path == i) ++patch;
    if (replaced[i]) {
      if (auto ok = addPath(*replaced[i], drawing, room); !ok)
        return core::makeError(ok.error().code, "edits, path %u: %s", i - hidden, ok.error().text);
      drawing.paths.back().clip = base.paths[i].clip;
      drawing.paths.back().layer = base.paths[i].layer;
      continue;
    }
    const size_t firstCurve = drawing.curves.size();
    const auto place = [&](uint32_t curve) {
      if (places[curve] == kNone || places[curve] < firstCurve) {
        places[curve] = static_cast<uint32_t>(drawing.curves.size());
        drawing.curves.push_back(base.curves[curve]);
      }
      return places[curve];
    };
    for (size_t k = first; k < patch; ++k) {
      PatchRecord p = base.patches[k];
      p.left = place(p.left);
      p.right = place(p.right);
      drawing.patches.push_back(p);
    }
    PathRecord path = base.paths[i];
    if (path.paint) {
      PaintRecord paint = base.paints[path.paint - 1];
      if (paint.kind != shader::kPaintImage) {
        const auto stops = base.stops.begin() + paint.firstStop;
        paint.firstStop = static_cast<uint32_t>(drawing.stops.size());
        drawing.stops.insert(drawing.stops.end(), stops, stops + paint.stopCount);
      }
      drawing.paints.push_back(paint);
      path.paint = static_cast<uint32_t>(drawing.paints.size());
    }
    drawing.paths.push_back(path);
  }
  if (drawing.patches.size() > shader::kEntryPatch)
    return core::makeError(GPGP_ERROR_UNSUPPORTED, "the drawing needs more than %u patches", shader::kEntryPatch);
  std::fill_n(drawing.bounds, 4, 0.0f);
  if (hidden == base.paths.size()) firstShown = drawing.patches.size();
  for (size_t k = firstShown; k < drawing.patches.size(); ++k)
    addInk(drawing.patches[k], k == firstShown, drawing.bounds);
  if (pageIsInk(base)) {
    std::copy_n(drawing.bounds, 2, drawing.viewport);
    drawing.viewport[2] = drawing.bounds[2] - drawing.bounds[0];
    drawing.viewport[3] = drawing.bounds[3] - drawing.bounds[1];
  } else {
    std::copy_n(base.viewport, 4, drawing.viewport);
  }
  return result;
}

} // namespace gpgp::vector
