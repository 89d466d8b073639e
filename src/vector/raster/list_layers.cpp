#include "vector/raster/list_layers.h"

#include "vector/raster/glyph_set.h"
#include "vector/raster/layer_boxes.h"
#include "vector/shared/tiles.h"
#include "vector/shared/triangle.h"

namespace gpgp::vector {
namespace {
using core::makeError;
using core::Result;
using shader::OperationRecord;

const DrawingAsset* layeredDrawing(const List::Command& command) {
  const core::Object* asset = command.kind == List::Kind::drawing ? command.asset() : nullptr;
  const auto* drawing = static_cast<const DrawingAsset*>(asset);
  return drawing && !drawing->plan().empty() ? drawing : nullptr;
}

Box boxOf(const shader::ShapeRecord& s) {
  Box box;
  if (shader::isTriangle(s)) {
    const shader::vec4 b = shader::triangleBox(s);
    return {b.x, b.y, b.z, b.w};
  }
  for (uint32_t corner = 0; corner < 4; ++corner) {
    const shader::vec2 p = shader::cornerOf(s.box, s.frame, corner);
    box = {std::min(box.left, p.x), std::min(box.top, p.y), std::max(box.right, p.x), std::max(box.bottom, p.y)};
  }
  return box;
}
} // namespace

bool hasLayers(const List& list) {
  return !list.layers().empty() || std::any_of(list.commands().begin(), list.commands().end(), layeredDrawing);
}

/// Around what a command paints. What is not known exactly is everything.
PixelBox ListLayers::boxOf(const List::Command& command) const {
  const PixelBox& all = planner_.canvas();
  const Map base = compose(map_, list_.bases()[command.space.base]);
  const PixelBox cut = cutOf(command.space.clip).box;
  Box box;
  switch (command.kind) {
  case List::Kind::shapes:
  case List::Kind::triangles:
    for (const List::Shape& shape : list_.shapes().subspan(command.first, command.count))
      box = join(box, vector::boxOf(shape.record));
    return meet(cut, planner_.pixels(base, box));
  case List::Kind::drawing: {
    const auto* drawing = static_cast<const DrawingAsset*>(command.asset());
    if (!drawing) return all; // refused where it is added
    const float* b = drawing->bounds();
    return meet(cut, planner_.pixels(mapOf(command.space), {b[0], b[1], b[2], b[3]}));
  }
  case List::Kind::text: {
    const auto* set = static_cast<const GlyphSet*>(command.asset());
    for (const GpgpGlyphInstance& g : list_.glyphs().subspan(command.first, command.count)) {
      const GlyphSet::Glyph* glyph = set && g.glyph != GPGP_GLYPH_NONE ? set->glyph(g.glyph) : nullptr;
      if (!glyph) continue;
      if (!std::isfinite(glyph->reach.x) || !std::isfinite(glyph->reach.y)) return cut; // of several paths
      const float x = g.x + glyph->middle.x * g.size, y = g.y + glyph->middle.y * g.size, w = glyph->reach.x * g.size,
                  h = glyph->reach.y * g.size;
      box = join(box, {x - w, y - h, x + w, y + h});
    }
    return meet(cut, planner_.pixels(base, box));
  }
  default: return {};
  }
}

/// Around what the commands of a layer paint; filters inside may reach further than is known here.
PixelBox ListLayers::contentBox(uint32_t first, uint32_t end) const {
  PixelBox box;
  for (uint32_t i = first; i < end; ++i) {
    const List::Command& command = list_.commands()[i];
    if (command.kind == List::Kind::mask) {
      i += command.count;
    } else if (command.kind == List::Kind::layer) {
      if (list_.plan().nodes[list_.layers()[command.first].node].filtered) return {-kFar, -kFar, kFar, kFar};
    } else {
      box = join(box, boxOf(command));
    }
  }
  return box;
}

ListLayers::Cut ListLayers::cutOf(uint32_t clip) const {
  const auto whole = [](float v, bool up) {
    const double at = std::clamp(static_cast<double>(v), double(-kFar), double(kFar));
    return static_cast<int>(up ? std::ceil(at) : std::floor(at));
  };
  const auto even = [](float v) { return std::abs(v) >= float(kFar) || v == std::floor(v); };
  Cut cut{{-kFar, -kFar, kFar, kFar}, true};
  if (depth_ == 0) // the item's scissor cuts what layers make, not what is in them
    cut = {{whole(visible_.x, false), whole(visible_.y, false), whole(visible_.z, true), whole(visible_.w, true)},
           even(visible_.x) && even(visible_.y) && even(visible_.z) && even(visible_.w)};
  for (; clip; clip = list_.clips()[clip - 1].parent) {
    const List::Clip& c = list_.clips()[clip - 1];
    cut.whole = false;
    cut.box = meet(cut.box, planner_.pixels(compose(map_, list_.bases()[c.base]), vector::boxOf(c.shape)));
  }
  return cut;
}

Result<void> ListLayers::plan(float opacity) {
  LayerPlanner& p = planner_;
  p.layered_ = true;
  const uint32_t before = p.state_.operations;
  if (auto ok = range(0, static_cast<uint32_t>(list_.commands().size()), p.root_, p.clean_ && p.open_, opacity); !ok)
    return ok;
  p.clean_ = p.clean_ && p.open_ && p.state_.operations == before;
  p.open_ = p.open_ && p.clean_;
  p.endUnit(true);
  return {};
}

/// `clean`: nothing has been composited onto the picture, so it may be rasterised into.
Result<void> ListLayers::range(uint32_t first, uint32_t end, const Picture& onto, bool clean, float opacity) {
  Composited composited(!clean);
  for (uint32_t i = first; i < end;) {
    if (++visited_ > kMaxLayerNodes)
      return makeError(GPGP_ERROR_UNSUPPORTED, ": its layers and masks come to more than %u parts", kMaxLayerNodes);
    const List::Command& command = list_.commands()[i];
    if (command.kind == List::Kind::mask) {
      i += command.count + 1;
      continue;
    }
    if (command.kind == List::Kind::layer || layeredDrawing(command)) {
      const uint32_t before = planner_.state_.operations;
      PixelBox changed;
      const bool own = command.kind == List::Kind::layer;
      if (auto ok = own ? layer(i, onto, opacity, changed) : drawing(i, onto, opacity, changed); !ok) return ok;
      if (planner_.state_.operations != before) composited.add(meet(changed, onto.box));
      i += own ? command.count + 1 : 1;
      continue;
    }
    uint32_t next = i;
    PixelBox box;
    for (; next < end; ++next) {
      const List::Command& c = list_.commands()[next];
      if (c.kind == List::Kind::layer || c.kind == List::Kind::mask || layeredDrawing(c)) break;
      box = join(box, boxOf(c));
    }
    box = meet(box, onto.box);
    if (!box.empty()) {
      const bool apart = composited.meets(box);
      const Picture where = apart ? planner_.region(box) : onto;
      place(i, next - i, depth_ == 0, where, opacity);
      if (apart) {
        planner_.composite(onto, where, 1, GPGP_BLEND_NORMAL);
        composited.add(box);
      }
    }
    i = next;
  }
  return {};
}

void ListLayers::place(uint32_t command, uint32_t count, bool outermost, const Picture& where, float opacity) {
  const uint32_t index = planner_.state_.runs;
  planner_.place(0, opacity, where, map_, command, count);
  if (index < planner_.tables_.runs.size()) planner_.tables_.runs[index].outermost = outermost;
}

void ListLayers::paint(const Finish& finish, const Picture& onto, const Picture& own, float opacity, uint32_t blend) {
  const PixelBox shown = meet(onto.box, own.box);
  if (shown.empty()) return;
  Picture clip;
  if (!finish.cut.whole) {
    clip = planner_.region(shown);
    place(finish.command, 0, finish.outermost, clip, 1);
  }
  OperationRecord& o = planner_.composite(onto, own, opacity, blend);
  if (!finish.cut.whole) {
    o.flags |= shader::kHasB;
    o.b = recordOf(clip);
  }
  if (!finish.layer || !finish.layer->mask) return;
  const LayerNode& node = list_.plan().nodes[finish.layer->node];
  o.flags |= shader::kHasC;
  o.c = recordOf(finish.mask);
  const bool srgb = node.maskEncoding == GPGP_IMAGE_SRGB;
  if (node.maskKind == GPGP_MASK_ALPHA)
    o.flags |= shader::kAlphaMask;
  else if (srgb != planner_.srgb_)
    o.flags |= srgb ? shader::kEncodeC : shader::kDecodeC;
}

Result<ListLayers::Picture> ListLayers::maskOf(const List::Layer& layer, const PixelBox& shown) {
  const uint32_t index = layer.mask - 1;
  const Picture mask = planner_.region(shown);
  if (auto ok = range(index + 1, index + 1 + list_.commands()[index].count, mask, true, 1); !ok) return ok.error();
  if (!layer.inverted) return mask;
  const Picture rest = planner_.picture(shown, planner_.srgb_);
  OperationRecord& o = planner_.operation(shader::kOperationColorMatrix, kColors, rest);
  convertA(o, mask, planner_.srgb_);
  o.values[3] = {0, 0, 0, -1};
  o.values[4].w = 1;
  return rest;
}

Result<void> ListLayers::layer(uint32_t index, const Picture& onto, float opacity, PixelBox& changed) {
  const List::Command& command = list_.commands()[index];
  const List::Layer& made = list_.layers()[command.first];
  const LayerNode& node = list_.plan().nodes[made.node];
  const uint32_t first = index + 1, end = first + command.count;
  const Map map = mapOf(command.space);
  if (map.projective() && (node.filtered || node.mask))
    return makeError(GPGP_ERROR_UNSUPPORTED, ": a layer with a filter or a mask is not drawn in perspective");
  Finish finish{index, cutOf(command.space.clip), depth_ == 0, &made, {}};
  PixelBox shown = meet(onto.box, finish.cut.box);
  if (made.bounded) {
    const float* b = made.bounds;
    shown = meet(shown, planner_.pixels(map, Box{b[0], b[1], b[2], b[3]}));
  }
  const struct Deeper { // until this returns
    uint32_t& depth;
    explicit Deeper(uint32_t& d) : depth(d) { ++depth; }
    ~Deeper() { --depth; }
  } deeper(depth_);
  const PixelBox content = contentBox(first, end);
  const bool filters = node.filtered && !made.backdrop;
  if (!node.filtered) shown = meet(shown, content);
  const float whole = node.opacity * opacity;
  if (shown.empty() || whole == 0) return {};
  changed = shown;
  const uint64_t pixelsBefore = planner_.state_.pixels;
  if (node.mask) {
    const auto mask = maskOf(made, shown);
    if (!mask) return mask.error();
    finish.mask = *mask;
  }
  const LayerPlanner::Around around{nullptr, list_.plan(), list_.bounds(), map, UINT32_MAX};
  if (made.backdrop && node.filtered) {
    const std::function<Picture(const PixelBox&)> behind = [&](const PixelBox& box) {
      Picture part = onto;
      changed = join(changed, box); // what follows must not be there yet
      part.x += static_cast<uint32_t>(box.left - onto.box.left);
      part.y += static_cast<uint32_t>(box.top - onto.box.top);
      part.box = box;
      return part;
    };
    Picture result;
    if (planner_.filter(around, node, {onto.box, true, behind}, shown, result))
      paint(finish, onto, result, whole, GPGP_BLEND_NORMAL);
    shown = meet(shown, content);
  }
  if (!shown.empty()) {
    Picture own;
    bool there = true;
    if (filters) {
      const std::function<Picture(const PixelBox&)> inside = [&](const PixelBox& box) {
        const Picture picture = planner_.region(box);
        if (auto ok = range(first, end, picture, true, 1); !ok && failed_) failed_ = ok;
        return picture;
      };
      there = planner_.filter(around, node, {content, true, inside}, shown, own);
      if (!failed_) return failed_;
    } else {
      own = planner_.region(shown);
      if (auto ok = range(first, end, own, true, 1); !ok) return ok;
    }
    if (there) paint(finish, onto, own, whole, static_cast<uint32_t>(node.blend));
  }
  planner_.state_.pixels = pixelsBefore;
  return {};
}

/// A drawing with layers among a list's commands.
Result<void> ListLayers::drawing(uint32_t index, const Picture& onto, float opacity, PixelBox& changed) {
  const List::Command& command = list_.commands()[index];
  const DrawingAsset& asset = *layeredDrawing(command);
  if (command.space.group)
    return makeError(GPGP_ERROR_UNSUPPORTED,
                     ", entry %u: its drawing has layers, which groups do not show; push a layer in the group's place",
                     command.firstEntry);
  const auto slot = bind_(asset);
  if (!slot) return slot.error();
  if (*slot == UINT32_MAX) planner_.close();
  const Map map = mapOf(command.space);
  const LayerPlan& plan = asset.plan();
  for (const LayerNode& node : plan.nodes)
    if (map.projective() && (node.filtered || node.mask))
      return makeError(GPGP_ERROR_UNSUPPORTED,
                       ", entry %u: a drawing with filters or masks is not drawn in perspective", command.firstEntry);
  const LayerPlanner::Around around{&asset, plan, asset.layerBounds(), map, *slot};
  const Finish finish{index, cutOf(command.space.clip), depth_ == 0, nullptr, {}};
  const PixelBox shown = meet(meet(onto.box, finish.cut.box), planner_.pixels(map, asset.layerBounds().sequences[0]));
  if (shown.empty() || (!map.projective() && !(std::abs(map.a * map.d - map.b * map.c) > 0))) return {};
  changed = shown;
  const Picture own = planner_.region(shown);
  const uint32_t runs = planner_.state_.runs;
  planner_.sequence(around, plan.sequences[0], own, true, 1);
  for (size_t k = runs; k < std::min<size_t>(planner_.state_.runs, planner_.tables_.runs.size()); ++k)
    planner_.tables_.runs[k].command = index;
  paint(finish, onto, own, opacity * command.opacity, GPGP_BLEND_NORMAL);
  return {};
}

} // namespace gpgp::vector
