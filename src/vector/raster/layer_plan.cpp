#include "vector/raster/layer_plan.h"

#include "vector/shared/color.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector {
namespace {
using core::makeError;
using core::Result;
using shader::OperationRecord;

constexpr int kFar = 1 << 20; ///< pixels that boxes may lie beyond the canvas
constexpr double kBlurReach = 3.5;

PixelBox join(const PixelBox& a, const PixelBox& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right), std::max(a.bottom, b.bottom)};
}
PixelBox meet(const PixelBox& a, const PixelBox& b) {
  const PixelBox box{std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right),
                     std::min(a.bottom, b.bottom)};
  return box.empty() ? PixelBox{} : box;
}
PixelBox grow(const PixelBox& a, double x, double y) {
  if (a.empty()) return a;
  const int dx = static_cast<int>(std::ceil(std::min(x, double(kFar)))),
            dy = static_cast<int>(std::ceil(std::min(y, double(kFar))));
  return meet({a.left - dx, a.top - dy, a.right + dx, a.bottom + dy}, {-kFar, -kFar, kFar, kFar});
}
PixelBox moved(const PixelBox& a, double x, double y) { // with a pixel to spare
  if (a.empty()) return a;
  const auto clamped = [](double v) { return static_cast<int>(std::clamp(v, double(-kFar), double(kFar))); };
  return {clamped(std::floor(a.left + x)), clamped(std::floor(a.top + y)), clamped(std::ceil(a.right + x)),
          clamped(std::ceil(a.bottom + y))};
}
PixelBox divided(const PixelBox& a, int x, int y) {
  const auto down = [](int v, int by) { return v >= 0 ? v / by : -((-v + by - 1) / by); };
  return {down(a.left, x), down(a.top, y), -down(-a.right, x), -down(-a.bottom, y)};
}
uint32_t roundUp(uint32_t v, uint32_t to) { return (v + to - 1) / to * to; }
Map toMap6(const float* t) { return toMap(t, nullptr); }
float narrow(double v) { return static_cast<float>(v); }
uint32_t widthOf(const PixelBox& box) { return static_cast<uint32_t>(std::max(box.right - box.left, 0)); }
uint32_t heightOf(const PixelBox& box) { return static_cast<uint32_t>(std::max(box.bottom - box.top, 0)); }

/// How many pixels a unit of each axis is.
double lengthX(const Map& m) { return std::hypot(m.a, m.b); }
double lengthY(const Map& m) { return std::hypot(m.c, m.d); }
/// Pixels that a box of filter space, half as wide and high, reaches.
double reachX(const Map& m, double x, double y) { return std::abs(m.a) * x + std::abs(m.c) * y; }
double reachY(const Map& m, double x, double y) { return std::abs(m.b) * x + std::abs(m.d) * y; }

shader::PictureRecord recordOf(const LayerTables::Picture& p) {
  shader::PictureRecord record{};
  record.left = p.box.left, record.top = p.box.top, record.right = p.box.right, record.bottom = p.box.bottom;
  record.first = p.region ? p.x : p.first; // finish() makes places of them
  record.stride = p.region ? 0 : widthOf(p.box);
  record.pad0 = p.region ? p.y : 0;
  record.pad1 = 1;
  return record;
}
void convertA(OperationRecord& o, const LayerTables::Picture& from, bool srgb) {
  o.a = recordOf(from);
  if (from.srgb != srgb) o.flags |= srgb ? shader::kEncodeA : shader::kDecodeA;
}
void convertB(OperationRecord& o, const LayerTables::Picture& from, bool srgb) {
  o.b = recordOf(from);
  if (from.srgb != srgb) o.flags |= srgb ? shader::kEncodeB : shader::kDecodeB;
}
enum Shader : uint32_t { kComposite, kBlur, kColors, kNeighbourhoods, kNoise, kLights };

shader::vec4 floodColor(const float* linear, float alpha, bool srgb) {
  return shader::blended({linear[0], linear[1], linear[2]}, alpha, srgb ? shader::kBlendSrgb : 0);
}
} // namespace

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
  return state_.width <= 16384 && state_.height <= 16384 &&
         uint64_t(state_.width) * state_.height + state_.mostPixels <= budgets_.pixels &&
         state_.width / kBin * uint64_t((state_.height + kBin - 1) / kBin) <= maxBins_ &&
         state_.operations <= tables_.operations.size() && state_.runs <= tables_.runs.size();
}

/// From the first one that does not fit, nothing is drawn; without room for the canvas itself, no layers.
void LayerPlanner::endUnit(bool layered) {
  if (keptUnits_ == UINT32_MAX && (rootFits_ ? fits() : !layered))
    kept_ = state_;
  else
    keptUnits_ = std::min(keptUnits_, unit_);
  ++unit_;
}

uint32_t LayerPlanner::pixelsNeeded() const {
  if (!layered_) return 0;
  return static_cast<uint32_t>(
      std::min<uint64_t>(uint64_t(state_.width) * state_.height + state_.mostPixels, UINT32_MAX));
}

LayerPlanner::Picture LayerPlanner::region(const PixelBox& box) {
  const uint32_t width = roundUp(std::max(widthOf(box), 1u), shader::kTileSize),
                 height = roundUp(std::max(heightOf(box), 1u), shader::kTileSize);
  if (state_.shelfX + uint64_t(width) > state_.width) { // a new row
    state_.shelfX = 0;
    state_.shelfY = state_.height;
  }
  state_.width = std::max(state_.width, roundUp(width, shader::kTileSize << shader::kMaxBinShift));
  state_.height = std::max(state_.height, state_.shelfY + height); // of the last row, which may grow
  const Picture made{box, true, srgb_, state_.shelfX, state_.shelfY, 0};
  state_.shelfX += width;
  return made;
}

LayerPlanner::Picture LayerPlanner::picture(const PixelBox& box, bool srgb) {
  const Picture made{box, false, srgb, 0, 0, static_cast<uint32_t>(std::min<uint64_t>(state_.pixels, UINT32_MAX))};
  state_.pixels += uint64_t(widthOf(box)) * heightOf(box);
  state_.mostPixels = std::max(state_.mostPixels, state_.pixels);
  return made;
}

void LayerPlanner::place(uint32_t run, float opacity, const Picture& where, const Map& map) {
  if (state_.runs < tables_.runs.size())
    tables_.runs[state_.runs] = {
        unit_, run, opacity, {where.box, static_cast<int>(where.x), static_cast<int>(where.y)}, map};
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
  const Around around{drawing, plan, drawing.layerBounds(), map, slot};
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
  if (!box.empty() && !blends && seen == canvas_) {
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
  for (const LayerToken& token : a.plan.tokensOf(s)) {
    if (token.layer) {
      const uint32_t before = state_.operations;
      layer(a, token.index, onto, opacity);
      clean = clean && state_.operations == before;
      continue;
    }
    const PixelBox box = meet(pixels(a.map, a.bounds.runs[token.index]), onto.box);
    if (box.empty()) continue;
    const Picture where = clean ? onto : region(box);
    place(token.index, opacity, where, a.map);
    if (!clean) composite(onto, where, 1, GPGP_BLEND_NORMAL);
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

// ---------------------------------------------------------------- filters

/// In another encoding, where that is needed.
LayerPlanner::Picture LayerPlanner::as(const Picture& from, bool srgb) {
  if (from.srgb == srgb || from.box.empty()) return from;
  const Picture to = picture(from.box, srgb);
  convertA(operation(shader::kOperationCopy, kColors, to), from, srgb);
  return to;
}

/// False: there is nothing to see.
bool LayerPlanner::filter(const Around& a, const LayerNode& node, uint32_t index, const PixelBox& shown,
                          Picture& result) {
  const auto steps = a.plan.stepsOf(node);
  if (steps.empty()) return false;
  const std::span made(tables_.filters.data() + filterSteps_, steps.size());
  filterSteps_ += steps.size();
  const Map space = compose(a.map, toMap6(node.filterTransform));
  const auto extent = [&](size_t i) { return pixels(space, a.bounds.steps[node.firstStep + i]); };
  // What each step must make for those behind it.
  std::fill(made.begin(), made.end(), LayerTables::FilterStep{});
  PixelBox source;
  made.back().need = meet(shown, extent(steps.size() - 1));
  for (size_t i = steps.size(); i-- > 0;) {
    const LayerStep& s = steps[i];
    const PixelBox need = made[i].need;
    if (need.empty()) continue;
    const auto ask = [&](uint32_t input, const PixelBox& part) {
      if (input >= GPGP_FILTER_FIRST_STEP) {
        LayerTables::FilterStep& from = made[input - GPGP_FILTER_FIRST_STEP];
        from.need = join(from.need, meet(part, extent(input - GPGP_FILTER_FIRST_STEP)));
      } else if (input != GPGP_FILTER_TRANSPARENT) {
        source = join(source, part);
      }
    };
    const float* v = s.values;
    const auto value = [v](int k) { return static_cast<double>(v[k]); };
    const auto spread = [&](const PixelBox& box, double x, double y) {
      return grow(box, reachX(space, x, y) + 1, reachY(space, x, y) + 1);
    };
    const auto shifted = [&](double x, double y) {
      return grow(moved(need, -(space.a * x + space.c * y), -(space.b * x + space.d * y)), 1, 1);
    };
    switch (s.kind) {
    case GPGP_FILTER_FLOOD:
    case GPGP_FILTER_TURBULENCE:
    case GPGP_FILTER_GROUP: break;
    case GPGP_FILTER_GAUSSIAN_BLUR: {
      const double reach = kBlurReach;
      ask(s.input, spread(need, reach * value(0), reach * value(1)));
      break;
    }
    case GPGP_FILTER_DROP_SHADOW:
      ask(s.input, join(need, spread(shifted(value(2), value(3)), kBlurReach * value(0), kBlurReach * value(1))));
      break;
    case GPGP_FILTER_OFFSET: ask(s.input, shifted(value(0), value(1))); break;
    case GPGP_FILTER_MORPHOLOGY: ask(s.input, spread(need, value(0) + 1, value(1) + 1)); break;
    case GPGP_FILTER_CONVOLVE_MATRIX:
      if (s.mode == GPGP_EDGE_NONE)
        ask(s.input, spread(need, value(0), value(1)));
      else
        ask(s.input, {-kFar, -kFar, kFar, kFar});
      break;
    case GPGP_FILTER_DISPLACEMENT_MAP:
      ask(s.input, spread(need, std::abs(value(0)) / 2 + 1, std::abs(value(0)) / 2 + 1));
      ask(s.input2, need);
      break;
    case GPGP_FILTER_DIFFUSE_LIGHTING:
    case GPGP_FILTER_SPECULAR_LIGHTING: ask(s.input, spread(need, 2, 2)); break;
    case GPGP_FILTER_TILE: ask(s.input, {-kFar, -kFar, kFar, kFar}); break;
    case GPGP_FILTER_BLEND:
    case GPGP_FILTER_COMPOSITE:
      ask(s.input, need);
      ask(s.input2, need);
      break;
    default: ask(s.input, need); break;
    }
  }
  const Box content = a.bounds.contents[index];
  const float* cut = node.filterRegion;
  const Box filterBox{cut[0], cut[1], cut[2], cut[3]};
  source = meet(source, meet(pixels(a.map, content), pixels(space, filterBox)));
  Picture graphic{{}, false, srgb_, 0, 0, 0}, alpha = graphic;
  if (!source.empty()) {
    graphic = region(source);
    sequence(a, node.content, graphic, true, 1);
    float inverse[6];
    const bool whole = invert(node.filterTransform, inverse) && [&] {
      const Box own = mapped(content, inverse), both = meet(own, filterBox);
      return both.left == own.left && both.top == own.top && both.right == own.right && both.bottom == own.bottom;
    }();
    if (!whole) {
      const Picture all = graphic;
      graphic = picture(source, srgb_);
      OperationRecord& o = operation(shader::kOperationCopy, kColors, graphic);
      convertA(o, all, srgb_);
      setRegion(o, space, node.filterRegion);
    }
    bool wanted = false;
    for (const LayerStep& s : steps)
      wanted = wanted || s.input == GPGP_FILTER_SOURCE_ALPHA || s.input2 == GPGP_FILTER_SOURCE_ALPHA;
    if (wanted) {
      alpha = picture(source, srgb_);
      OperationRecord& o = operation(shader::kOperationCopy, kColors, alpha);
      convertA(o, graphic, srgb_);
      o.flags |= shader::kAlphaOnly;
    }
  }
  const auto input = [&](uint32_t from) {
    if (from >= GPGP_FILTER_FIRST_STEP) return made[from - GPGP_FILTER_FIRST_STEP].made;
    return from == GPGP_FILTER_SOURCE ? graphic : from == GPGP_FILTER_SOURCE_ALPHA ? alpha : Picture{{}, false, srgb_};
  };
  for (size_t i = 0; i < steps.size(); ++i) {
    if (made[i].need.empty()) continue;
    made[i].made =
        step(a, node, static_cast<uint32_t>(i), space, made[i].need, input(steps[i].input), input(steps[i].input2));
  }
  result = made.back().made;
  filterSteps_ -= steps.size();
  return !result.box.empty();
}

LayerPlanner::Picture LayerPlanner::step(const Around& a, const LayerNode& node, uint32_t index, const Map& space,
                                         const PixelBox& need, const Picture& first, const Picture& second) {
  const LayerStep& s = a.plan.stepsOf(node)[index];
  const float* v = s.values;
  const bool srgb = s.encoding == GPGP_IMAGE_SRGB;
  const auto toPixels = [&](float x, float y) {
    const double u = static_cast<double>(x), w = static_cast<double>(y);
    return shader::vec4{narrow(space.a * u + space.c * w), narrow(space.b * u + space.d * w), 0, 0};
  };
  const auto finish = [&](OperationRecord& o) { setRegion(o, space, s.region); };
  switch (s.kind) {
  case GPGP_FILTER_GAUSSIAN_BLUR:
  case GPGP_FILTER_DROP_SHADOW: {
    const bool shadow = s.kind == GPGP_FILTER_DROP_SHADOW;
    const shader::vec4 shift = shadow ? toPixels(v[2], v[3]) : shader::vec4{0, 0, 0, 0};
    const PixelBox part = shadow ? grow(moved(need, -double(shift.x), -double(shift.y)), 1, 1) : need;
    const Picture blurred = blur(first, double(v[0]), double(v[1]), space, part, srgb);
    const Picture result = picture(need, srgb);
    OperationRecord& o = operation(shadow ? shader::kOperationShadow : shader::kOperationCopy, kColors, result);
    if (shadow) {
      convertA(o, first, srgb);
      o.b = recordOf(blurred);
      o.values[0] = shift;
      o.values[1] = floodColor(v + 4, v[7], srgb);
    } else {
      convertA(o, blurred, srgb);
    }
    finish(o);
    return result;
  }
  case GPGP_FILTER_MORPHOLOGY: {
    const double reach[2] = {reachX(space, double(v[0]), double(v[1])), reachY(space, double(v[0]), double(v[1]))};
    Picture current = as(first, srgb);
    for (int axis = 0; axis < 2; ++axis) {
      const double pixels = std::round(reach[axis]);
      if (pixels < 1) continue;
      // The first pass leaves what the second one reads.
      PixelBox box = axis == 0 ? grow(need, 0, std::round(reach[1])) : need;
      box = meet(box, grow(current.box, axis == 0 ? pixels : 0, axis == 1 ? pixels : 0));
      if (box.empty()) return Picture{{}, false, srgb, 0, 0, 0};
      const Picture next = picture(box, srgb);
      OperationRecord& o = operation(shader::kOperationMorphology, kNeighbourhoods, next);
      o.a = recordOf(current);
      o.mode = static_cast<uint32_t>(s.mode);
      o.flags = axis == 1 ? shader::kAxisY : 0;
      o.count = static_cast<uint32_t>(std::min(pixels, 32768.0));
      current = next;
    }
    const Picture result = picture(need, srgb);
    OperationRecord& o = operation(shader::kOperationCopy, kColors, result);
    convertA(o, current, srgb);
    finish(o);
    return result;
  }
  case GPGP_FILTER_GROUP: {
    const Map map = compose(space, toMap6(v));
    const Picture shown = region(need);
    sequence({a.drawing, a.plan, a.bounds, map, a.slot}, a.plan.sequences[s.sequence - 1], shown, true, 1);
    const Picture result = picture(need, srgb);
    OperationRecord& o = operation(shader::kOperationCopy, kColors, result);
    convertA(o, shown, srgb);
    finish(o);
    return result;
  }
  default: break;
  }
  const bool between =
      s.kind == GPGP_FILTER_OFFSET || (s.kind >= GPGP_FILTER_CONVOLVE_MATRIX && s.kind != GPGP_FILTER_TURBULENCE);
  const bool near =
      s.kind == GPGP_FILTER_CONVOLVE_MATRIX || s.kind == GPGP_FILTER_DISPLACEMENT_MAP || s.kind == GPGP_FILTER_TILE;
  const bool lights = s.kind == GPGP_FILTER_DIFFUSE_LIGHTING || s.kind == GPGP_FILTER_SPECULAR_LIGHTING;
  const Picture from = between ? as(first, srgb) : first;
  const Picture result = picture(need, srgb);
  const float* inputRegion = s.input >= GPGP_FILTER_FIRST_STEP
                                 ? a.plan.stepsOf(node)[s.input - GPGP_FILTER_FIRST_STEP].region
                                 : node.filterRegion;
  const shader::vec4 inside{inputRegion[0], inputRegion[1], inputRegion[2], inputRegion[3]};
  const uint32_t pass = near ? kNeighbourhoods : lights ? kLights : s.kind == GPGP_FILTER_TURBULENCE ? kNoise : kColors;
  OperationRecord& o = operation(shader::kOperationCopy, pass, result);
  convertA(o, from, srgb);
  finish(o);
  const auto table = [&](uint32_t at) { // in the drawing's buffer
    return shader::vec4{shader::uintBitsToFloat(a.slot), shader::uintBitsToFloat(at), 0, 0};
  };
  switch (s.kind) {
  case GPGP_FILTER_FLOOD:
    o.kind = shader::kOperationFlood;
    o.values[0] = floodColor(v, v[3], srgb);
    break;
  case GPGP_FILTER_OFFSET: {
    o.kind = shader::kOperationOffset;
    o.values[0] = toPixels(v[0], v[1]);
    for (int k = 0; k < 2; ++k) // whole pixels stay what they are
      if (const float whole = std::round(o.values[0][k]); std::abs(whole - o.values[0][k]) < 1e-3f)
        o.values[0][k] = whole;
    break;
  }
  case GPGP_FILTER_COLOR_MATRIX:
    o.kind = shader::kOperationColorMatrix;
    for (int row = 0; row < 4; ++row) {
      o.values[row] = {v[row * 5], v[row * 5 + 1], v[row * 5 + 2], v[row * 5 + 3]};
      o.values[4][row] = v[row * 5 + 4];
    }
    break;
  case GPGP_FILTER_COMPONENT_TRANSFER:
    o.kind = shader::kOperationTransfer;
    o.values[0] = table(a.drawing.tableOf(s.firstEntry));
    break;
  case GPGP_FILTER_BLEND:
    o.kind = shader::kOperationBlend;
    o.mode = static_cast<uint32_t>(s.mode);
    convertB(o, second, srgb);
    break;
  case GPGP_FILTER_COMPOSITE:
    o.kind = shader::kOperationOperator;
    o.mode = static_cast<uint32_t>(s.mode);
    o.values[0] = {v[0], v[1], v[2], v[3]};
    convertB(o, second, srgb);
    break;
  case GPGP_FILTER_CONVOLVE_MATRIX:
    o.kind = shader::kOperationConvolve;
    o.mode = static_cast<uint32_t>(s.mode);
    o.values[0] = {v[0], v[1], v[2], v[3]};
    o.values[1] = {v[4], v[5], v[6], 0};
    o.values[2] = inside;
    o.values[3] = table(a.drawing.tableOf(s.firstEntry));
    break;
  case GPGP_FILTER_DISPLACEMENT_MAP:
    o.kind = shader::kOperationDisplace;
    o.mode = static_cast<uint32_t>(s.mode);
    o.values[0].x = v[0];
    convertB(o, second, srgb);
    break;
  case GPGP_FILTER_TILE:
    o.kind = shader::kOperationTile;
    o.values[2] = inside;
    break;
  case GPGP_FILTER_TURBULENCE: {
    o.kind = shader::kOperationTurbulence;
    o.mode = static_cast<uint32_t>(s.mode);
    float frequency[2] = {v[0], v[1]};
    for (int k = 0; k < 2; ++k) {
      if (v[4] == 0) continue;
      // The nearest frequency of which a whole number of waves fits; then where the lattice begins anew.
      const float size = s.region[2 + k] - s.region[k];
      if (frequency[k] != 0 && size > 0) {
        const float low = std::floor(size * frequency[k]) / size, high = std::ceil(size * frequency[k]) / size;
        frequency[k] = low > 0 && frequency[k] / low < high / frequency[k] ? low : high;
      }
      o.values[1][k] = std::floor(size * frequency[k] + 0.5f);
      o.values[1][2 + k] = std::floor(s.region[k] * frequency[k]) + 4096 + o.values[1][k];
    }
    o.values[0] = {frequency[0], frequency[1], v[2], v[4]};
    o.values[2] = table(a.drawing.latticeOf(static_cast<uint32_t>(&s - a.plan.steps.data())));
    break;
  }
  case GPGP_FILTER_DIFFUSE_LIGHTING:
  case GPGP_FILTER_SPECULAR_LIGHTING: {
    const bool specular = s.kind == GPGP_FILTER_SPECULAR_LIGHTING;
    const float* light = v + (specular ? 6 : 5);
    o.kind = shader::kOperationLight;
    o.mode = static_cast<uint32_t>(s.mode);
    o.values[0] = {v[0], v[1], specular ? v[5] : 0, specular ? 1.f : 0.f};
    o.values[1] = floodColor(v + 2, 1, srgb);
    o.values[2] = {light[0], light[1], light[2], light[6]};
    if (s.mode == GPGP_LIGHT_DISTANT)
      o.values[2] = {std::cos(light[0]) * std::cos(light[1]), std::sin(light[0]) * std::cos(light[1]),
                     std::sin(light[1]), 0};
    o.values[3] = {light[3], light[4], light[5], light[7]};
    o.values[5] = inside;
    break;
  }
  default: break;
  }
  return result;
}

/// The standard deviations are in filter space. Large ones are blurred in a picture that is smaller by a power of two.
LayerPlanner::Picture LayerPlanner::blur(const Picture& from, double deviationX, double deviationY, const Map& space,
                                         const PixelBox& need, bool srgb) {
  Picture current = as(from, srgb);
  if (current.box.empty()) return current;
  const double lengths[2] = {lengthX(space), lengthY(space)};
  double deviations[2] = {deviationX * lengths[0], deviationY * lengths[1]};
  double ways[2][2] = {{1, 0}, {0, 1}};
  const double tiny = 1e-5 * (lengths[0] + lengths[1]);
  const bool upright = std::abs(space.b) < tiny && std::abs(space.c) < tiny,
             turned = std::abs(space.a) < tiny && std::abs(space.d) < tiny,
             round = std::abs(deviations[0] - deviations[1]) <= 1e-4 * deviations[0] &&
                     std::abs(space.a * space.c + space.b * space.d) <= 1e-4 * lengths[0] * lengths[1];
  if (turned && !round) {
    std::swap(deviations[0], deviations[1]);
  } else if (!upright && !turned && !round) { // along the axes of the filter's space
    const double axes[2][2] = {{space.a, space.b}, {space.c, space.d}};
    for (int k = 0; k < 2; ++k)
      for (int i = 0; i < 2; ++i) ways[k][i] = lengths[k] > 0 ? axes[k][i] / lengths[k] : 0;
  }
  const bool oblique = ways[0][1] != 0 || ways[1][0] != 0;
  int factors[2];
  for (int k = 0; k < 2; ++k)
    factors[k] = deviations[k] >= 8 ? 1 << std::min(static_cast<int>(std::log2(deviations[k] / 4)), 12) : 1;
  if (oblique) factors[0] = factors[1] = std::min(factors[0], factors[1]);
  const bool shrinks = factors[0] > 1 || factors[1] > 1;
  if (shrinks) {
    const Picture small = picture(divided(current.box, factors[0], factors[1]), srgb);
    OperationRecord& o = operation(shader::kOperationShrink, kBlur, small);
    convertA(o, current, srgb);
    o.values[0] = {narrow(factors[0]), narrow(factors[1]), 0, 0};
    current = small;
  }
  const PixelBox inner = shrinks ? grow(divided(need, factors[0], factors[1]), 1, 1) : need;
  double smaller[2];
  for (int k = 0; k < 2; ++k) {
    const double f = factors[k], s = deviations[k];
    // Averages and interpolation between them blur, too.
    smaller[k] = std::sqrt(std::max(f > 1 ? s * s - (f * f - 1) / 12 - f * f / 6 : s * s, 0.0)) / f;
  }
  const auto reach = [&](int k, int axis) {
    return smaller[k] < 0.02 ? 0.0 : std::abs(ways[k][axis]) * (std::ceil(kBlurReach * smaller[k]) + 1);
  };
  for (int k = 0; k < 2; ++k) {
    if (smaller[k] < 0.02) continue;
    // The first pass leaves what the second one reads.
    PixelBox box = k == 0 ? grow(inner, reach(1, 0), reach(1, 1)) : inner;
    box = meet(box, grow(current.box, reach(k, 0), reach(k, 1)));
    if (box.empty()) return Picture{{}, false, srgb, 0, 0, 0};
    const Picture next = picture(box, srgb);
    OperationRecord& o = operation(shader::kOperationBlur, kBlur, next);
    o.a = recordOf(current);
    o.values[0] = {narrow(ways[k][0]), narrow(ways[k][1]), narrow(smaller[k]), 0};
    o.count = static_cast<uint32_t>(std::ceil(kBlurReach * smaller[k]));
    current = next;
  }
  if (shrinks) {
    const Picture large = picture(need, srgb);
    OperationRecord& o = operation(shader::kOperationGrow, kBlur, large);
    o.a = recordOf(current);
    o.values[0] = {narrow(factors[0]), narrow(factors[1]), 0, 0};
    current = large;
  }
  return current;
}

} // namespace gpgp::vector
