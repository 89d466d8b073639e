// Groups of paths: what of them is shown, and which are composited by themselves.
//
// A group's clip and opacity become records of their own, so that a path finds its nearest clip and its nearest layer
// without walking through groups that have neither. Where groups are layers (layers.h), the paths between them become
// runs: drawings of their own, in one drawing's tables.
#include "vector/patch/drawing.h"

#include <algorithm>

namespace gpgp::vector {
namespace {
using core::makeError;
using core::Result;

struct Nearest { // at or above a group: 1 + index; 0: none
  uint32_t clip = 0, layer = 0;
};

/// Makes a drawing of paths and groups.
class GroupedDrawing {
public:
  GroupedDrawing(std::span<const GpgpPath> paths, std::span<const GpgpPathGroup> groups, Drawing& drawing,
                 std::pmr::memory_resource* memory, const GpgpJobSystem* jobs, std::pmr::vector<LeftEmpty>* leftEmpty,
                 OutlineRoom& room)
      : room_(room), paths_(paths), groups_(groups), drawing_(drawing), memory_(memory), jobs_(jobs),
        leftEmpty_(leftEmpty), layered_(groups.size(), 0, memory), needed_(groups.size(), 0, memory), nearest_(memory),
        sequences_(groups.size(), 0, memory), seen_(groups.size(), 0, memory), pathsOf_(memory) {}

  Result<void> make() {
    if (auto ok = check(); !ok) return ok;
    findLayers();
    if (!any_) { // one run of everything
      std::fill(needed_.begin(), needed_.end(), uint8_t(1));
      std::pmr::vector<uint32_t> all(paths_.size(), 0, memory_);
      for (uint32_t i = 0; i < paths_.size(); ++i) all[i] = i;
      return addPaths(all, 0);
    }
    // Paths of groups that others refer to show there alone.
    pathsOf_.resize(groups_.size() + 1, std::pmr::vector<uint32_t>(memory_));
    for (uint32_t i = 0; i < paths_.size(); ++i) {
      uint32_t top = paths_[i].group;
      while (top && groups_[top - 1].parent) top = groups_[top - 1].parent;
      pathsOf_[top && referred(top) ? top : 0].push_back(i);
    }
    drawing_.plan.sequences.push_back({});
    auto content = addSequence(pathsOf_[0], 0, 0);
    if (!content) return content.error();
    drawing_.plan.sequences[0] = *content;
    if (!checkPlan(drawing_.plan, drawing_.paths.size(), memory_))
      return makeError(GPGP_ERROR_UNSUPPORTED, "groups: more than %u nested layers, or %u in all", GPGP_MAX_LAYER_DEPTH,
                       kMaxLayerNodes);
    return {};
  }

private:
  Result<void> check() const {
    for (size_t i = 0; i < paths_.size(); ++i)
      if (paths_[i].group > groups_.size())
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "paths[%zu].group is %u; there are %zu groups", i,
                         paths_[i].group, groups_.size());
    for (uint32_t i = 0; i < groups_.size(); ++i) {
      const GpgpPathGroup& g = groups_[i];
      if (g.parent > i)
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "groups[%u].parent is %u: no earlier group", i, g.parent);
      if (!(g.opacity >= 0 && g.opacity <= 1))
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "groups[%u].opacity is %g; it must be 0 to 1", i,
                         static_cast<double>(g.opacity));
      if (g.clipCount && !g.clip)
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "groups[%u].clip is NULL, but clipCount is %u", i, g.clipCount);
      if (!g.layer) continue;
      char name[32];
      std::snprintf(name, sizeof name, "groups[%u].layer", i);
      if (auto ok = checkLayer(*g.layer, name, i, static_cast<uint32_t>(groups_.size())); !ok) return ok;
      const auto rootless = [&](uint32_t group) { return group && groups_[group - 1].parent; };
      bool parented = rootless(g.layer->mask);
      for (uint32_t s = 0; s < g.layer->filterCount; ++s) parented = parented || rootless(g.layer->filter[s].group);
      if (parented)
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s: the group of a mask or filter must not have a parent", name);
    }
    return {};
  }

  /// Whether another group's mask or filter shows the group.
  bool referred(uint32_t group) const { return seen_[group - 1] & kReferred; }

  /// Which groups are composited by themselves: those that say so, those with a clip or an opacity around one of them,
  /// and those around more opacities in each other than the raster knows.
  void findLayers() {
    struct Inside {
      bool layer = false, blend = false;
      uint32_t fades = 0; ///< in each other
    };
    std::pmr::vector<Inside> inside(groups_.size(), Inside{}, memory_);
    for (size_t i = groups_.size(); i-- > 0;) {
      const GpgpPathGroup& g = groups_[i];
      const GpgpLayer* layer = g.layer;
      const bool blends = layer && layer->blend != GPGP_BLEND_NORMAL;
      const uint32_t fades = inside[i].fades + (g.opacity < 1);
      const bool own =
          (layer && (blends || layer->mask || layer->filter)) || (layer && layer->isolated && inside[i].blend);
      layered_[i] = own || (inside[i].layer && (g.opacity < 1 || g.clip)) || fades > shader::kMaxLayerDepth;
      any_ = any_ || layered_[i];
      if (layer && layer->mask) seen_[layer->mask - 1] |= kReferred;
      for (uint32_t s = 0; layer && s < layer->filterCount; ++s)
        if (layer->filter[s].group) seen_[layer->filter[s].group - 1] |= kReferred;
      if (!g.parent) continue;
      Inside& parent = inside[g.parent - 1];
      parent.layer = parent.layer || inside[i].layer || layered_[i];
      parent.blend = parent.blend || blends || (inside[i].blend && !layered_[i]);
      parent.fades = std::max(parent.fades, layered_[i] ? 0 : fades);
    }
  }

  /// The outermost layer inside `owner` that holds a path; 0: none.
  uint32_t layerAround(uint32_t path, uint32_t owner) const {
    uint32_t found = 0;
    for (uint32_t g = paths_[path].group; g && g != owner; g = groups_[g - 1].parent)
      if (layered_[g - 1]) found = g;
    return found;
  }

  /// Runs and layers of paths inside a group (0: none).
  Result<LayerSequence> addSequence(std::span<const uint32_t> paths, uint32_t owner, uint32_t depth) {
    if (depth > GPGP_MAX_LAYER_DEPTH)
      return makeError(GPGP_ERROR_UNSUPPORTED, "groups[%u]: more than %u nested layers", owner ? owner - 1 : 0,
                       GPGP_MAX_LAYER_DEPTH);
    std::pmr::vector<LayerToken> tokens(memory_);
    for (size_t i = 0; i < paths.size();) {
      const uint32_t layer = layerAround(paths[i], owner);
      size_t end = i + 1;
      while (end < paths.size() && layerAround(paths[end], owner) == layer) ++end;
      const auto part = paths.subspan(i, end - i);
      i = end;
      if (!layer) {
        const auto run = addRun(part, owner);
        if (!run) return run.error();
        tokens.push_back({0, *run});
        continue;
      }
      if (seen_[layer - 1] & kDone)
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "paths[%u]: others lie between it and the rest of its group",
                         part[0]);
      seen_[layer - 1] |= kDone;
      const auto node = addNode(part, layer, depth);
      if (!node) return node.error();
      tokens.push_back({1, *node});
    }
    auto& all = drawing_.plan.tokens;
    const LayerSequence sequence{static_cast<uint32_t>(all.size()), static_cast<uint32_t>(tokens.size())};
    all.insert(all.end(), tokens.begin(), tokens.end());
    return sequence;
  }

  Result<uint32_t> addNode(std::span<const uint32_t> paths, uint32_t group, uint32_t depth) {
    const GpgpPathGroup& g = groups_[group - 1];
    LayerNode node{};
    node.opacity = g.opacity;
    const auto content = addSequence(paths, group, depth + 1);
    if (!content) return content.error();
    node.content = *content;
    if (g.clip) {
      const uint32_t first = static_cast<uint32_t>(drawing_.paths.size());
      for (uint32_t k = 0; k < g.clipCount; ++k)
        if (auto ok = addClipPath(group - 1, k, 1); !ok) return ok.error();
      drawing_.plan.runs.push_back({first, g.clipCount});
      node.clip = static_cast<uint32_t>(drawing_.plan.runs.size());
    }
    if (const GpgpLayer* layer = g.layer) {
      node.blend = layer->blend;
      node.maskKind = layer->maskKind;
      node.maskEncoding = layer->maskEncoding;
      std::copy_n(layer->maskRegion, 4, node.maskRegion);
      std::copy_n(layer->maskTransform, 6, node.maskTransform);
      node.filtered = layer->filter != nullptr;
      std::copy_n(layer->filterRegion, 4, node.filterRegion);
      std::copy_n(layer->filterTransform, 6, node.filterTransform);
      if (layer->mask) {
        const auto mask = referredSequence(layer->mask, depth + 1);
        if (!mask) return mask.error();
        node.mask = *mask;
      }
      std::pmr::vector<LayerStep> steps(memory_);
      for (uint32_t i = 0; i < layer->filterCount; ++i) {
        const GpgpFilterStep& from = layer->filter[i];
        LayerStep step{from.kind, from.mode, from.input, from.input2, from.encoding, {}, {}, 0, from.tableCount, 0};
        std::copy_n(from.region, 4, step.region);
        std::copy_n(from.values, 20, step.values);
        step.firstEntry = static_cast<uint32_t>(drawing_.plan.tables.size());
        drawing_.plan.tables.insert(drawing_.plan.tables.end(), from.table, from.table + from.tableCount);
        drawing_.plan.tables.resize((drawing_.plan.tables.size() + 3) / 4 * 4, 0.0f); // shaders read four at a time
        if (from.group) {
          const auto shown = referredSequence(from.group, depth + 1);
          if (!shown) return shown.error();
          step.sequence = *shown;
        }
        steps.push_back(step);
      }
      node.firstStep = static_cast<uint32_t>(drawing_.plan.steps.size());
      node.stepCount = static_cast<uint32_t>(steps.size());
      drawing_.plan.steps.insert(drawing_.plan.steps.end(), steps.begin(), steps.end());
    }
    drawing_.plan.nodes.push_back(node);
    return static_cast<uint32_t>(drawing_.plan.nodes.size() - 1);
  }

  /// 1 + the index of the sequence of a group that a mask or filter shows; made once.
  Result<uint32_t> referredSequence(uint32_t group, uint32_t depth) {
    uint32_t& made = sequences_[group - 1];
    if (made) return made;
    const auto content = addSequence(pathsOf_[group], 0, depth);
    if (!content) return content.error();
    drawing_.plan.sequences.push_back(*content);
    return made = static_cast<uint32_t>(drawing_.plan.sequences.size());
  }

  Result<uint32_t> addRun(std::span<const uint32_t> paths, uint32_t owner) {
    std::fill(needed_.begin(), needed_.end(), uint8_t(0));
    for (const uint32_t path : paths)
      for (uint32_t g = paths_[path].group; g && g != owner && !needed_[g - 1]; g = groups_[g - 1].parent)
        needed_[g - 1] = 1;
    const uint32_t first = static_cast<uint32_t>(drawing_.paths.size());
    if (auto ok = addPaths(paths, owner); !ok) return ok.error();
    drawing_.plan.runs.push_back({first, static_cast<uint32_t>(drawing_.paths.size()) - first});
    return static_cast<uint32_t>(drawing_.plan.runs.size() - 1);
  }

  Result<void> addClipPath(uint32_t group, uint32_t k, float color) {
    GpgpPath path = groups_[group].clip[k];
    std::fill(path.color, path.color + 4, color); // 0: it paints nothing
    path.gradient = nullptr;
    path.image = nullptr;
    std::optional<core::Error> tooMany;
    if (auto ok = addPath(path, drawing_, room_, leftEmpty_ ? &tooMany : nullptr); !ok) {
      if (leftEmpty_) leftEmpty_->push_back({1 + group, k, ok.error(), true});
      return makeError(ok.error().code, "groups[%u].clip[%u]: %s", group, k, ok.error().text);
    }
    if (tooMany) leftEmpty_->push_back({1 + group, k, *tooMany});
    return {};
  }

  /// Clips and opacities of the groups that are needed.
  Result<void> addGroups(uint32_t owner) {
    nearest_.assign(groups_.size(), Nearest{});
    for (uint32_t i = 0; i < groups_.size(); ++i) {
      if (!needed_[i]) continue;
      const GpgpPathGroup& g = groups_[i];
      Nearest nearest = g.parent && g.parent != owner ? nearest_[g.parent - 1] : Nearest{};
      if (g.clip) {
        const uint32_t depth = nearest.clip ? drawing_.clips[nearest.clip - 1].depth + 1 : 1;
        if (depth > shader::kMaxClipDepth)
          return makeError(GPGP_ERROR_UNSUPPORTED, "groups[%u]: more than %u nested clips", i, shader::kMaxClipDepth);
        drawing_.clips.push_back({static_cast<uint32_t>(drawing_.paths.size()), g.clipCount, nearest.clip, depth});
        nearest.clip = static_cast<uint32_t>(drawing_.clips.size());
        for (uint32_t k = 0; k < g.clipCount; ++k)
          if (auto ok = addClipPath(i, k, 0); !ok) return ok;
      }
      if (g.opacity < 1) {
        const uint32_t depth = nearest.layer ? drawing_.layers[nearest.layer - 1].depth + 1 : 1;
        drawing_.layers.push_back({g.opacity, nearest.layer, depth, 0});
        nearest.layer = static_cast<uint32_t>(drawing_.layers.size());
      }
      nearest_[i] = nearest;
    }
    return {};
  }

  Result<void> addPaths(std::span<const uint32_t> paths, uint32_t owner) {
    if (auto ok = addGroups(owner); !ok) return ok;
    const size_t firstPainted = drawing_.paths.size();
    for (size_t i = 0; i < paths.size();) { // as many as follow each other
      size_t end = i + 1;
      while (end < paths.size() && paths[end] == paths[end - 1] + 1) ++end;
      auto painted = makeDrawing(paths_.subspan(paths[i], end - i), memory_, jobs_, leftEmpty_, paths[i], &room_);
      if (!painted) return painted.error();
      for (size_t k = i; k < end; ++k)
        if (const uint32_t group = paths_[paths[k]].group; group && group != owner) {
          painted->paths[k - i].clip = nearest_[group - 1].clip;
          painted->paths[k - i].layer = nearest_[group - 1].layer;
        }
      if (auto ok = append(*painted, drawing_); !ok) return ok;
      i = end;
    }
    return checkOrder(paths, firstPainted);
  }

  /// Paths of a group that fades lie in a row.
  Result<void> checkOrder(std::span<const uint32_t> paths, size_t firstPainted) {
    const auto& layers = drawing_.layers;
    std::pmr::vector<uint8_t> left(layers.size(), 0, memory_);
    uint32_t open = 0;
    for (size_t i = 0; i < paths.size() && !layers.empty(); ++i) {
      const uint32_t layer = drawing_.paths[firstPainted + i].layer;
      const auto holds = [&](uint32_t outer) { // at or above the path's
        uint32_t l = layer;
        while (l > outer) l = layers[l - 1].parent;
        return l == outer;
      };
      for (; open && !holds(open); open = layers[open - 1].parent) left[open - 1] = 1;
      for (uint32_t l = layer; l; l = layers[l - 1].parent)
        if (left[l - 1])
          return makeError(GPGP_ERROR_INVALID_ARGUMENT, "paths[%u]: others lie between it and the rest of its group",
                           paths[i]);
      open = layer;
    }
    return {};
  }

  static constexpr uint8_t kReferred = 1, kDone = 2;
  OutlineRoom& room_;
  std::span<const GpgpPath> paths_;
  std::span<const GpgpPathGroup> groups_;
  Drawing& drawing_;
  std::pmr::memory_resource* memory_;
  const GpgpJobSystem* jobs_;
  std::pmr::vector<LeftEmpty>* leftEmpty_;
  bool any_ = false;                     // layers
  std::pmr::vector<uint8_t> layered_;    // by group
  std::pmr::vector<uint8_t> needed_;     // by the run at hand
  std::pmr::vector<Nearest> nearest_;    // likewise
  std::pmr::vector<uint32_t> sequences_; // of groups that are referred to: 1 + index
  std::pmr::vector<uint8_t> seen_;
  std::pmr::vector<std::pmr::vector<uint32_t>> pathsOf_; // the drawing's, and those of groups that are referred to
};

/// The ink of what is painted: neither clips' paths nor those of masks.
void findBounds(Drawing& drawing, std::pmr::memory_resource* memory) {
  std::pmr::vector<Box> boxes(drawing.paths.size(), Box{}, memory);
  for (const PatchRecord& p : drawing.patches) boxes[p.path] = join(boxes[p.path], {p.x0, p.top, p.x1, p.bottom});
  for (const ClipRecord& clip : drawing.clips) std::fill_n(boxes.begin() + clip.firstPath, clip.pathCount, Box{});
  std::pmr::vector<Box> runs(memory);
  for (const LayerRun& run : drawing.plan.runs) {
    Box box;
    for (uint32_t i = 0; i < run.pathCount; ++i) box = join(box, boxes[run.firstPath + i]);
    runs.push_back(box);
  }
  const Box all = boundsOf(drawing.plan, runs, memory).sequences[0];
  const float found[4] = {all.left, all.top, all.right, all.bottom};
  for (int k = 0; k < 4; ++k) drawing.bounds[k] = all.empty() ? 0 : found[k];
}

} // namespace

Result<Drawing> makeDrawing(std::span<const GpgpPath> paths, std::span<const GpgpPathGroup> groups,
                            std::pmr::memory_resource* memory, const GpgpJobSystem* jobs,
                            std::pmr::vector<LeftEmpty>* leftEmpty, uint64_t mostBytes) {
  OutlineRoom room(mostBytes);
  if (groups.empty() && std::all_of(paths.begin(), paths.end(), [](const GpgpPath& p) { return p.group == 0; }))
    return makeDrawing(paths, memory, jobs, leftEmpty, 0, &room);
  Result<Drawing> drawing = Drawing(memory);
  GroupedDrawing grouped(paths, groups, *drawing, memory, jobs, leftEmpty, room);
  if (auto ok = grouped.make(); !ok) return ok.error();
  if (drawing->plan.empty()) {
    std::fill_n(drawing->bounds, 4, 0.0f);
    const uint32_t hidden = clipPaths(*drawing);
    bool first = true;
    for (const PatchRecord& patch : drawing->patches) {
      if (patch.path < hidden) continue; // clips have no ink
      addInk(patch, first, drawing->bounds);
      first = false;
    }
  } else {
    findBounds(*drawing, memory);
  }
  for (int k = 0; k < 2; ++k) {
    drawing->viewport[k] = drawing->bounds[k];
    drawing->viewport[k + 2] = drawing->bounds[k + 2] - drawing->bounds[k];
  }
  return drawing;
}

} // namespace gpgp::vector
