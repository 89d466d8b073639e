#include "vector/raster/layer_boxes.h"

namespace gpgp::vector {
namespace {
using core::makeError;
using core::Result;
using shader::OperationRecord;

constexpr uint32_t kMostSide = 16384;           // of the raster
constexpr uint32_t kMostDispatched = 65535 * 8; // pixels in a row, in workgroups of 8

} // namespace

bool Composited::meets(const PixelBox& box) const {
  return all_ || std::any_of(boxes_.begin(), boxes_.begin() + count_,
                             [&](const PixelBox& other) { return !meet(box, other).empty(); });
}
void Composited::add(const PixelBox& box) {
  PixelBox& place = boxes_[std::min(count_, uint32_t(boxes_.size() - 1))];
  place = count_ < boxes_.size() ? box : join(place, box);
  count_ = std::min(count_ + 1, uint32_t(boxes_.size()));
}

LayerPlanner::LayerPlanner(LayerTables& tables, const LayerBudgets& budgets, const std::array<uint32_t, 6>& passes,
                           uint32_t maxBins, const GpgpCanvasInfo& info)
    : tables_(tables), budgets_(budgets), passes_(passes), maxBins_(maxBins),
      srgb_(info.blendSrgb != VK_FALSE), canvas_{0, 0, static_cast<int>(info.width), static_cast<int>(info.height)} {
  // Rows of bins as wide as the canvas, so that these are few.
  state_.width = roundUp(info.width, shader::kTileSize << shader::kMaxBinShift);
  root_ = base_ = region(canvas_);
  kept_ = state_;
  rootFits_ = fits();
  OperationRecord& present = tables_.operations.empty() ? unused_ : tables_.operations[0];
  present = {};
  present.result = recordOf(root_);
}

bool LayerPlanner::fits() const {
  constexpr uint32_t kBin = shader::kTileSize << shader::kMaxBinShift;
  return state_.width <= kMostSide && state_.height <= kMostSide && !state_.tooLarge &&
         uint64_t(state_.width) * state_.height + state_.mostPixels <= budgets_.pixels &&
         state_.width / kBin * uint64_t((state_.height + kBin - 1) / kBin) <= maxBins_ &&
         state_.operations <= tables_.operations.size() && state_.runs <= tables_.runs.size();
}

/// From the first one that does not fit, nothing is drawn; without room for the canvas itself, no layers.
void LayerPlanner::endUnit(bool layered) {
  if (keptUnits_ == UINT32_MAX && !closed_ && (rootFits_ ? fits() : !layered))
    kept_ = state_;
  else
    keptUnits_ = std::min(keptUnits_, unit_);
  ++unit_;
}

uint32_t LayerPlanner::pixelsNeeded() const {
  if (!layered_) return 0;
  if (state_.width > kMostSide || state_.height > kMostSide || state_.tooLarge) return UINT32_MAX;
  return static_cast<uint32_t>(
      std::min<uint64_t>(uint64_t(state_.width) * state_.height + state_.mostPixels, UINT32_MAX));
}

LayerPlanner::Picture LayerPlanner::region(const PixelBox& box) {
  constexpr uint32_t kBin = shader::kTileSize << shader::kMaxBinShift;
  const uint32_t width = roundUp(std::max(widthOf(box), 1u), shader::kTileSize),
                 height = roundUp(std::max(heightOf(box), 1u), shader::kTileSize);
  State& s = state_;
  if (s.shelfX + uint64_t(width) > s.width) { // a new row
    s.shelfX = s.columnX;
    s.shelfY = s.columnY;
  }
  if (s.shelfY > 0 && s.shelfY + uint64_t(height) > kMostSide) { // a new column
    s.columnX = s.shelfX = s.width;
    s.columnY = s.shelfY = 0;
    s.width += roundUp(widthOf(canvas_), kBin);
  }
  s.width = std::max(s.width, roundUp(s.shelfX + width, kBin));
  s.columnY = std::max(s.columnY, s.shelfY + height); // of the last row, which may grow
  s.height = std::max(s.height, s.columnY);
  const Picture made{box, true, srgb_, s.shelfX, s.shelfY, 0, 0};
  s.shelfX += width;
  return made;
}

LayerPlanner::Picture LayerPlanner::picture(const PixelBox& box, bool srgb) {
  const auto first = static_cast<uint32_t>(std::min<uint64_t>(state_.pixels, UINT32_MAX));
  const Picture made{box, false, srgb, 0, 0, first, state_.operations};
  state_.tooLarge = state_.tooLarge || widthOf(box) > kMostDispatched || heightOf(box) > kMostDispatched;
  state_.pixels += uint64_t(widthOf(box)) * heightOf(box);
  state_.mostPixels = std::max(state_.mostPixels, state_.pixels);
  return made;
}

void LayerPlanner::place(uint32_t run, float opacity, const Picture& where, const Map& map, uint32_t command,
                         uint32_t count) {
  if (state_.runs < tables_.runs.size())
    tables_.runs[state_.runs] = {
        unit_, run, opacity, {where.box, static_cast<int>(where.x), static_cast<int>(where.y)}, map, command, count};
  ++state_.runs;
}

OperationRecord& LayerPlanner::operation(uint32_t kind, uint32_t pass, const Picture& result) {
  const uint32_t index = state_.operations++;
  const bool room = index < tables_.operations.size();
  OperationRecord& o = room ? tables_.operations[index] : unused_;
  o = {};
  o.kind = kind;
  o.result = recordOf(result);
  (room ? tables_.steps[index - 1]
        : unusedStep_) = {passes_[pass], {(widthOf(result.box) + 7) / 8, (heightOf(result.box) + 7) / 8, 1}, index};
  return o;
}

/// Where both lie, which must be somewhere.
OperationRecord& LayerPlanner::composite(const Picture& onto, const Picture& from, float opacity, uint32_t blend) {
  Picture part = onto;
  part.box = meet(onto.box, from.box);
  part.x += static_cast<uint32_t>(part.box.left - onto.box.left);
  part.y += static_cast<uint32_t>(part.box.top - onto.box.top);
  OperationRecord& o = operation(shader::kOperationComposite, kComposite, part);
  convertA(o, from, srgb_);
  o.mode = blend;
  o.values[0].x = opacity;
  return o;
}

// ---------------------------------------------------------------- units

void LayerPlanner::addPlain() {
  if (!open_) {
    base_ = region(canvas_);
    open_ = true;
    place(UINT32_MAX, 1, base_, {}); // says where it lies
    composite(root_, base_, 1, GPGP_BLEND_NORMAL);
  }
  endUnit(false);
}

Result<void> LayerPlanner::addLayered(const DrawingAsset& drawing, uint32_t slot, const Map& map, float opacity,
                                      const shader::vec4& visible) {
  const LayerPlan& plan = drawing.plan();
  for (const LayerNode& node : plan.nodes)
    if (map.projective() && (node.filtered || node.mask))
      return makeError(GPGP_ERROR_UNSUPPORTED, "a drawing with filters or masks is not drawn in perspective");
  layered_ = true;
  const Around around{&drawing, plan, drawing.layerBounds(), map, slot};
  const auto side = [](float v, bool up) {
    const double at = std::clamp(static_cast<double>(v), double(-kFar), double(kFar));
    return static_cast<int>(up ? std::ceil(at) : std::floor(at));
  };
  const PixelBox seen =
      meet(canvas_, {side(visible.x, false), side(visible.y, false), side(visible.z, true), side(visible.w, true)});
  const LayerSequence& content = plan.sequences[0];
  bool blends = false;
  for (const LayerToken& token : plan.tokensOf(content))
    blends = blends || (token.layer && plan.nodes[token.index].blend != GPGP_BLEND_NORMAL);
  const PixelBox box = meet(seen, pixels(map, around.bounds.sequences[0]));
  const double determinant = map.a * map.d - map.b * map.c;
  if (!map.projective() && !(std::abs(determinant) > 0)) { // an item without extent
  } else if (!box.empty() && !blends && seen == canvas_) {
    const uint32_t before = state_.operations;
    sequence(around, content, root_, clean_ && open_, opacity);
    clean_ = clean_ && open_ && state_.operations == before;
  } else if (!box.empty()) {
    const Picture own = region(box);
    sequence(around, content, own, true, blends ? 1 : opacity);
    OperationRecord& o = composite(root_, own, blends ? opacity : 1, GPGP_BLEND_NORMAL);
    const float scissor[4] = {visible.x, visible.y, visible.z, visible.w};
    setRegion(o, Map{}, scissor);
    clean_ = false;
  }
  open_ = open_ && clean_;
  endUnit(true);
  return {};
}

void LayerPlanner::finish() {
  order();
  const auto resolve = [&](shader::PictureRecord& p) {
    if (p.pad1 == 0) return; // there is none
    if (p.stride == 0) {
      p.first += p.pad0 * kept_.width;
      p.stride = kept_.width;
    } else {
      p.first += kept_.width * kept_.height;
    }
    p.pad0 = p.pad1 = 0;
  };
  for (uint32_t i = 0; i < kept_.operations && i < tables_.operations.size(); ++i) {
    OperationRecord& o = tables_.operations[i];
    resolve(o.result), resolve(o.a), resolve(o.b), resolve(o.c);
  }
}

// ---------------------------------------------------------------- drawings

/// Around what a box becomes, with a pixel to spare.
PixelBox LayerPlanner::pixels(const Map& map, const Box& box) const {
  if (box.empty()) return {};
  if (map.projective()) return canvas_;
  double left = 1e30, top = 1e30, right = -1e30, bottom = -1e30;
  for (int corner = 0; corner < 4; ++corner) {
    const double x = static_cast<double>(corner & 1 ? box.right : box.left),
                 y = static_cast<double>(corner & 2 ? box.bottom : box.top);
    const double u = (map.a * x + map.c * y + map.e) / map.r, v = (map.b * x + map.d * y + map.f) / map.r;
    left = std::min(left, u), top = std::min(top, v), right = std::max(right, u), bottom = std::max(bottom, v);
  }
  const auto clamped = [](double v) { return static_cast<int>(std::clamp(v, double(-kFar), double(kFar))); };
  return {clamped(std::floor(left) - 1), clamped(std::floor(top) - 1), clamped(std::ceil(right) + 1),
          clamped(std::ceil(bottom) + 1)};
}

/// `clean`: nothing has been composited onto the picture yet, so paths may be rasterised there.
void LayerPlanner::sequence(const Around& a, const LayerSequence& s, const Picture& onto, bool clean, float opacity) {
  Composited composited(!clean);
  for (const LayerToken& token : a.plan.tokensOf(s)) {
    if (token.layer) {
      const uint32_t before = state_.operations;
      layer(a, token.index, onto, opacity);
      if (state_.operations != before) composited.add(meet(pixels(a.map, a.bounds.nodes[token.index]), onto.box));
      continue;
    }
    const PixelBox box = meet(pixels(a.map, a.bounds.runs[token.index]), onto.box);
    if (box.empty()) continue;
    const bool apart = composited.meets(box);
    const Picture where = apart ? region(box) : onto;
    place(token.index, opacity, where, a.map);
    if (!apart) continue;
    composite(onto, where, 1, GPGP_BLEND_NORMAL);
    composited.add(box);
  }
}

void LayerPlanner::layer(const Around& a, uint32_t index, const Picture& onto, float opacity) {
  const LayerNode& node = a.plan.nodes[index];
  const PixelBox shown = meet(pixels(a.map, a.bounds.nodes[index]), onto.box);
  if (shown.empty() || node.opacity == 0) return;
  const uint64_t pixelsBefore = state_.pixels;
  Picture own;
  if (!node.filtered) {
    own = region(shown);
    sequence(a, node.content, own, true, 1);
  } else if (!filter(a, node, index, shown, own)) {
    state_.pixels = pixelsBefore;
    return;
  }
  Picture clip, mask;
  if (node.clip) {
    clip = region(meet(shown, pixels(a.map, a.bounds.runs[node.clip - 1])));
    place(node.clip - 1, 1, clip, a.map);
  }
  if (node.mask) {
    mask = region(meet(shown, pixels(a.map, a.bounds.sequences[node.mask - 1])));
    sequence(a, a.plan.sequences[node.mask - 1], mask, true, 1);
  }
  if (!meet(onto.box, own.box).empty()) {
    OperationRecord& o = composite(onto, own, node.opacity * opacity, static_cast<uint32_t>(node.blend));
    if (node.clip) {
      o.flags |= shader::kHasB;
      o.b = recordOf(clip);
    }
    if (node.mask) {
      o.flags |= shader::kHasC;
      o.c = recordOf(mask);
      const bool srgb = node.maskEncoding == GPGP_IMAGE_SRGB;
      if (node.maskKind == GPGP_MASK_ALPHA)
        o.flags |= shader::kAlphaMask;
      else if (srgb != srgb_)
        o.flags |= srgb ? shader::kEncodeC : shader::kDecodeC;
      setRegion(o, compose(a.map, toMap6(node.maskTransform)), node.maskRegion);
    }
  }
  state_.pixels = pixelsBefore;
}

void LayerPlanner::setRegion(OperationRecord& o, const Map& space, const float* region) const {
  const double e = space.e / space.r, f = space.f / space.r, a = space.a / space.r, b = space.b / space.r,
               c = space.c / space.r, d = space.d / space.r, determinant = a * d - b * c;
  o.toPixel = {narrow(a), narrow(b), narrow(c), narrow(d)};
  o.toSpace = {narrow(d / determinant), narrow(-b / determinant), narrow(-c / determinant), narrow(a / determinant)};
  o.offsets = {narrow(e), narrow(f), narrow((c * f - d * e) / determinant), narrow((b * e - a * f) / determinant)};
  if (!region) return;
  o.region = {region[0], region[1], region[2], region[3]};
  o.flags |= shader::kHasRegion;
}

} // namespace gpgp::vector
