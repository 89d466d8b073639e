// Groups of paths: what of them is shown, and which are composited by themselves.
//
// A group's clip and opacity become records of their own, so that a path finds its nearest clip and its nearest layer
// without walking through groups that have neither.
#include "vector/patch/drawing.h"

#include <algorithm>

namespace gpgp::vector {
namespace {
using core::makeError;

struct Nearest { // at or above a group: 1 + index; 0: none
  uint32_t clip = 0, layer = 0;
};

core::Result<void> addGroups(std::span<const GpgpPathGroup> groups, Drawing& drawing, std::pmr::vector<Nearest>& found,
                             std::pmr::vector<LeftEmpty>* leftEmpty) {
  for (uint32_t i = 0; i < groups.size(); ++i) {
    const GpgpPathGroup& g = groups[i];
    if (g.parent > i)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "groups[%u].parent is %u: no earlier group", i, g.parent);
    if (!(g.opacity >= 0 && g.opacity <= 1))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "groups[%u].opacity is %g; it must be 0 to 1", i,
                       static_cast<double>(g.opacity));
    if (g.clipCount && !g.clip)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "groups[%u].clip is NULL, but clipCount is %u", i, g.clipCount);
    Nearest nearest = g.parent ? found[g.parent - 1] : Nearest{};
    if (g.clip) {
      const uint32_t depth = nearest.clip ? drawing.clips[nearest.clip - 1].depth + 1 : 1;
      if (depth > shader::kMaxClipDepth)
        return makeError(GPGP_ERROR_UNSUPPORTED, "groups[%u]: more than %u clips in each other", i,
                         shader::kMaxClipDepth);
      drawing.clips.push_back({static_cast<uint32_t>(drawing.paths.size()), g.clipCount, nearest.clip, depth});
      nearest.clip = static_cast<uint32_t>(drawing.clips.size());
      for (uint32_t k = 0; k < g.clipCount; ++k) {
        GpgpPath path = g.clip[k];
        std::fill(path.color, path.color + 4, 0.0f); // it paints nothing
        path.gradient = nullptr;
        path.image = nullptr;
        std::optional<core::Error> tooMany;
        if (auto ok = addPath(path, drawing, leftEmpty ? &tooMany : nullptr); !ok)
          return makeError(ok.error().code, "groups[%u].clip[%u]: %s", i, k, ok.error().text);
        if (tooMany) leftEmpty->push_back({1 + i, k, *tooMany});
      }
    }
    if (g.opacity < 1) {
      const uint32_t depth = nearest.layer ? drawing.layers[nearest.layer - 1].depth + 1 : 1;
      if (depth > shader::kMaxLayerDepth)
        return makeError(GPGP_ERROR_UNSUPPORTED, "groups[%u]: more than %u groups less than opaque in each other", i,
                         shader::kMaxLayerDepth);
      drawing.layers.push_back({g.opacity, nearest.layer, depth, 0});
      nearest.layer = static_cast<uint32_t>(drawing.layers.size());
    }
    found.push_back(nearest);
  }
  return {};
}

/// Paths of a layer lie in a row.
core::Result<void> checkOrder(std::span<const PathRecord> paths, std::span<const LayerRecord> layers,
                              std::pmr::memory_resource* memory) {
  std::pmr::vector<uint8_t> left(layers.size(), 0, memory);
  uint32_t open = 0;
  for (size_t i = 0; i < paths.size(); ++i) {
    const uint32_t layer = paths[i].layer;
    const auto holds = [&](uint32_t outer) { // at or above the path's
      uint32_t l = layer;
      while (l > outer) l = layers[l - 1].parent;
      return l == outer;
    };
    for (; open && !holds(open); open = layers[open - 1].parent) left[open - 1] = 1;
    for (uint32_t l = layer; l; l = layers[l - 1].parent)
      if (left[l - 1])
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "paths[%zu]: others lie between it and the rest of its group", i);
    open = layer;
  }
  return {};
}
} // namespace

core::Result<Drawing> makeDrawing(std::span<const GpgpPath> paths, std::span<const GpgpPathGroup> groups,
                                  std::pmr::memory_resource* memory, const GpgpJobSystem* jobs,
                                  std::pmr::vector<LeftEmpty>* leftEmpty) {
  for (size_t i = 0; i < paths.size(); ++i)
    if (paths[i].group > groups.size())
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "paths[%zu].group is %u; there are %zu groups", i, paths[i].group,
                       groups.size());
  auto painted = makeDrawing(paths, memory, jobs, leftEmpty);
  if (!painted || groups.empty()) return painted;
  core::Result<Drawing> drawing = Drawing(memory);
  std::pmr::vector<Nearest> nearest(memory);
  if (auto ok = addGroups(groups, *drawing, nearest, leftEmpty); !ok) return ok.error();
  for (size_t i = 0; i < paths.size(); ++i)
    if (paths[i].group) {
      painted->paths[i].clip = nearest[paths[i].group - 1].clip;
      painted->paths[i].layer = nearest[paths[i].group - 1].layer;
    }
  if (auto ok = checkOrder(painted->paths, drawing->layers, memory); !ok) return ok.error();
  if (auto ok = append(*painted, *drawing); !ok) return ok.error();
  std::copy_n(painted->bounds, 4, drawing->bounds); // clips have no ink
  std::copy_n(painted->viewport, 4, drawing->viewport);
  return drawing;
}

} // namespace gpgp::vector
