#include "vector/ui/list.h"

#include "vector/shared/shape.h"

#include <algorithm>

namespace gpgp::vector {
namespace {
using core::makeError;
using core::Result;
using shader::ShapeRecord;
using shader::vec4;

bool within(const float* values, int count, float low, float high) { // not a number is not
  for (int i = 0; i < count; ++i)
    if (!(values[i] >= low && values[i] <= high)) return false;
  return true;
}

/// Room for one more, so that what follows cannot fail.
template <class T> void makeRoom(std::pmr::vector<T>& values, size_t more = 1) {
  if (values.capacity() - values.size() < more) values.reserve(std::max(values.size() + more, 2 * values.capacity()));
}

/// A box with corners; radii shrink evenly where two do not find room on a side.
ShapeRecord roundBox(const vec4& box, const vec4& radii, float ratio) {
  ShapeRecord s{};
  s.box = box;
  s.frame = {0, 0, 1, 0};
  s.ratio = ratio;
  const float width = box.z - box.x, height = box.w - box.y;
  float fits = 1;
  const auto fit = [&fits](float a, float b, float side) {
    if (a + b > side) fits = std::min(fits, side / (a + b));
  };
  fit(radii.x, radii.y, width);
  fit(radii.w, radii.z, width);
  fit(radii.x * ratio, radii.w * ratio, height);
  fit(radii.y * ratio, radii.z * ratio, height);
  s.radii = {radii.x * fits, radii.y * fits, radii.z * fits, radii.w * fits};
  if (std::max({s.radii.x, s.radii.y, s.radii.z, s.radii.w}) > 0) s.kind = shader::kShapeRound;
  return s;
}

/// A rectangle from the begin of a line along it.
ShapeRecord lineBox(float x0, float y0, float x1, float y1, float width, GpgpCap cap) {
  const double dx = static_cast<double>(x1) - static_cast<double>(x0);
  const double dy = static_cast<double>(y1) - static_cast<double>(y0);
  const double length = std::sqrt(dx * dx + dy * dy);
  const float half = 0.5f * width, beyond = cap == GPGP_CAP_BUTT ? 0 : half, reach = static_cast<float>(length);
  const float radius = cap == GPGP_CAP_ROUND ? half : 0;
  ShapeRecord s = roundBox({-beyond, -half, reach + beyond, half}, {radius, radius, radius, radius}, 1);
  s.frame = {x0, y0, 1, 0};
  if (length > 0) s.frame.z = static_cast<float>(dx / length), s.frame.w = static_cast<float>(dy / length);
  return s;
}
} // namespace

List::List(core::Context& owner, const char* name)
    : Object(owner, core::Kind::list, name), stack_(&owner.host()), bases_(&owner.host()), clips_(&owner.host()),
      groups_(&owner.host()), layers_(&owner.host()), masks_(&owner.host()), plan_(&owner.host()),
      bounds_(&owner.host()), commands_(&owner.host()), shapes_(&owner.host()), glyphs_(&owner.host()),
      paints_(&owner.host()) {}

Result<core::Unique<List>> List::create(core::Context& context, const GpgpListCreateInfo& info) {
  auto list = core::makeUnique<List>(context.host(), context, info.label);
  list->shapes_.reserve(info.shapes);
  list->glyphs_.reserve(info.glyphs);
  list->commands_.reserve(info.commands);
  list->stack_.reserve(GPGP_MAX_LIST_DEPTH);
  list->bases_.emplace_back();
  return list;
}

void List::reset() {
  state_ = {};
  stack_.clear();
  bases_.resize(1);
  clips_.clear();
  groups_.clear();
  layers_.clear();
  masks_.clear();
  plan_.nodes.clear();
  plan_.steps.clear();
  bounds_.steps.clear();
  commands_.clear();
  shapes_.clear();
  glyphs_.clear();
  paints_.paints.clear();
  paints_.stops.clear();
  images_ = entries_ = 0;
  closed_ = 0;
}

Result<void> List::checkDepth() const {
  if (stack_.size() < GPGP_MAX_LIST_DEPTH) return {};
  return makeError(GPGP_ERROR_INVALID_ARGUMENT, "more than %d nested pushes (GPGP_MAX_LIST_DEPTH)",
                   GPGP_MAX_LIST_DEPTH);
}

Result<void> List::pushTransform(const float* transform, const float* perspective) {
  if (auto ok = checkDepth(); !ok) return ok;
  for (int i = 0; i < 6; ++i)
    if (!std::isfinite(transform[i])) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "transform[%d] is not finite", i);
  for (int i = 0; i < 3 && perspective; ++i)
    if (!std::isfinite(perspective[i]))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "perspective[%d] is not finite", i);
  const Map map = toMap(transform, perspective);
  Space inner = state_.space;
  if (map.b == 0 && map.c == 0 && map.a == map.d && map.a > 0 && !map.projective() && map.r == 1) {
    inner.x += inner.scale * map.e;
    inner.y += inner.scale * map.f;
    inner.scale *= map.a;
  } else {
    makeRoom(bases_);
    bases_.push_back(compose(compose(bases_[inner.base], inner.map()), map));
    inner = {static_cast<uint32_t>(bases_.size() - 1), inner.clip, inner.group};
  }
  stack_.push_back(state_);
  state_.space = inner;
  return {};
}

Result<void> List::pushClip(const float* box, const float* radii) {
  if (auto ok = checkDepth(); !ok) return ok;
  if (!within(box, 4, -kMaxCoordinate, kMaxCoordinate) || box[2] < box[0] || box[3] < box[1])
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "box is %g, %g, %g, %g; expected left, top, right, bottom within 1e7",
                     static_cast<double>(box[0]), static_cast<double>(box[1]), static_cast<double>(box[2]),
                     static_cast<double>(box[3]));
  if (radii && !within(radii, 4, 0, kMaxCoordinate))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "a radius is not a number from 0 to 1e7");
  const Space& space = state_.space;
  const uint32_t depth = space.clip ? clips_[space.clip - 1].depth + 1 : 1;
  if (depth > GPGP_MAX_CLIP_DEPTH)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "more than %d nested clips (GPGP_MAX_CLIP_DEPTH)",
                     GPGP_MAX_CLIP_DEPTH);
  makeRoom(clips_);
  const auto x = [&](float v) { return static_cast<float>(space.scale * static_cast<double>(v) + space.x); };
  const auto y = [&](float v) { return static_cast<float>(space.scale * static_cast<double>(v) + space.y); };
  const auto size = [&](float v) { return static_cast<float>(space.scale * static_cast<double>(v)); };
  const vec4 corners = radii ? vec4(size(radii[0]), size(radii[1]), size(radii[2]), size(radii[3])) : vec4(0);
  const vec4 placed{x(box[0]), y(box[1]), x(box[2]), y(box[3])};
  if (!within(&placed.x, 4, -kMaxCoordinate, kMaxCoordinate) || !within(&corners.x, 4, 0, kMaxCoordinate))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "box or radii are beyond 1e7 under the transforms pushed");
  const ShapeRecord shape = roundBox(placed, corners, 1);
  clips_.push_back({shape, space.base, space.clip, depth});
  stack_.push_back(state_);
  state_.space.clip = static_cast<uint32_t>(clips_.size());
  return {};
}

Result<void> List::checkOpacity(float opacity) const {
  if (within(&opacity, 1, 0, 1)) return checkDepth();
  return makeError(GPGP_ERROR_INVALID_ARGUMENT, "opacity is %g; it must be 0 to 1", static_cast<double>(opacity));
}

Result<void> List::pushOpacity(float opacity) {
  if (auto ok = checkOpacity(opacity); !ok) return ok;
  stack_.push_back(state_);
  state_.opacity *= opacity;
  return {};
}

/// The group takes the opacity that what is in it would have, thing by thing.
Result<void> List::pushGroup(float opacity) {
  if (auto ok = checkOpacity(opacity); !ok) return ok;
  const uint32_t parent = state_.space.group, depth = parent ? groups_[parent - 1].depth + 1 : 1;
  if (depth > shader::kMaxLayerDepth)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "more than %u nested groups (GPGP_MAX_OPACITY_DEPTH)",
                     shader::kMaxLayerDepth);
  makeRoom(groups_);
  groups_.push_back({opacity * state_.opacity, parent, depth});
  stack_.push_back(state_);
  state_.space.group = static_cast<uint32_t>(groups_.size());
  state_.opacity = 1;
  return {};
}

/// The clips, groups and opacities around it are the picture's; in it, there are none.
void List::beginPicture(Kind what, uint32_t index) {
  Command& command = addCommand(what);
  command.first = index;
  stack_.push_back(state_);
  state_ = {{state_.space.base, 0, 0, state_.space.scale, state_.space.x, state_.space.y},
            1,
            static_cast<uint32_t>(commands_.size()),
            state_.pictures + 1};
}

Result<void> List::pushLayer(const GpgpListLayer& layer) {
  if (auto ok = checkOpacity(layer.opacity); !ok) return ok;
  if (state_.pictures == GPGP_MAX_LAYER_DEPTH)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "more than %d nested layers and masks (GPGP_MAX_LAYER_DEPTH)",
                     GPGP_MAX_LAYER_DEPTH);
  if (state_.space.group)
    return makeError(GPGP_ERROR_UNSUPPORTED, "a layer inside a group; push a layer in the group's place");
  GpgpLayer checked{};
  checked.blend = layer.blend;
  checked.maskKind = layer.maskKind;
  checked.maskEncoding = layer.maskEncoding;
  checked.filter = layer.filter;
  checked.filterCount = layer.filterCount;
  constexpr float kFar = 4 * kMaxCoordinate;
  const float all[4] = {-kFar, -kFar, kFar, kFar}, same[6] = {1, 0, 0, 1, 0, 0};
  std::copy_n(all, 4, checked.filterRegion);
  std::copy_n(same, 6, checked.filterTransform);
  if (auto ok = checkLayer(checked, "layer", 0, 0); !ok) return ok;
  for (uint32_t i = 0; i < layer.filterCount; ++i)
    if (const int32_t what = layer.filter[i].kind; what == GPGP_FILTER_COMPONENT_TRANSFER ||
                                                   what == GPGP_FILTER_CONVOLVE_MATRIX ||
                                                   what == GPGP_FILTER_TURBULENCE || what == GPGP_FILTER_GROUP)
      return makeError(GPGP_ERROR_UNSUPPORTED, "layer.filter[%u].kind is %d, which layers of lists do not know", i,
                       what);
  if (plan_.steps.size() + layer.filterCount > kMaxNestedSteps)
    return makeError(GPGP_ERROR_UNSUPPORTED, "the filters of a list have more than %u steps", kMaxNestedSteps);
  if (layer.mask > masks_.size() || (layer.mask && !commands_[masks_[layer.mask - 1]].id))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "layer.mask is %u: no mask that was popped", layer.mask);
  if (layer.mask && layer.maskKind != GPGP_MASK_LUMINANCE && layer.maskKind != GPGP_MASK_ALPHA)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "layer.maskKind is %d", layer.maskKind);
  if (layer.mask && layer.maskEncoding != GPGP_IMAGE_LINEAR && layer.maskEncoding != GPGP_IMAGE_SRGB)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "layer.maskEncoding is %d", layer.maskEncoding);
  if (layer.maskInverted && layer.maskKind != GPGP_MASK_ALPHA)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "layer.maskInverted is for GPGP_MASK_ALPHA");
  if (!within(layer.bounds, 4, -kMaxCoordinate, kMaxCoordinate) || layer.bounds[2] < layer.bounds[0] ||
      layer.bounds[3] < layer.bounds[1])
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "layer.bounds is not a box within 1e7");

  makeRoom(layers_);
  makeRoom(commands_);
  makeRoom(stack_);
  makeRoom(plan_.nodes);
  makeRoom(plan_.steps, layer.filterCount);
  makeRoom(bounds_.steps, layer.filterCount);
  LayerNode node{};
  node.blend = layer.blend;
  node.opacity = layer.opacity * state_.opacity;
  node.mask = layer.mask;
  node.maskKind = layer.maskKind;
  node.maskEncoding = layer.maskEncoding;
  node.filtered = layer.filter != nullptr;
  node.firstStep = static_cast<uint32_t>(plan_.steps.size());
  node.stepCount = layer.filterCount;
  std::copy_n(all, 4, node.filterRegion);
  std::copy_n(same, 6, node.filterTransform);
  for (uint32_t i = 0; i < layer.filterCount; ++i) {
    const GpgpFilterStep& s = layer.filter[i];
    LayerStep step{s.kind, s.mode, s.input, s.input2, s.encoding, {}, {}, 0, 0, 0};
    std::copy_n(s.region, 4, step.region);
    std::copy_n(s.values, 20, step.values);
    plan_.steps.push_back(step);
    bounds_.steps.push_back({s.region[0], s.region[1], s.region[2], s.region[3]});
  }
  plan_.nodes.push_back(node);
  Layer made{static_cast<uint32_t>(plan_.nodes.size() - 1),
             layer.mask ? masks_[layer.mask - 1] + 1 : 0,
             layer.maskInverted != VK_FALSE,
             layer.backdrop != VK_FALSE,
             layer.bounds[0] != 0 || layer.bounds[1] != 0 || layer.bounds[2] != 0 || layer.bounds[3] != 0,
             {}};
  std::copy_n(layer.bounds, 4, made.bounds);
  layers_.push_back(made);
  beginPicture(Kind::layer, static_cast<uint32_t>(layers_.size() - 1));
  return {};
}

Result<uint32_t> List::pushMask() {
  if (auto ok = checkDepth(); !ok) return ok.error();
  if (state_.pictures == GPGP_MAX_LAYER_DEPTH)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "more than %d nested layers and masks (GPGP_MAX_LAYER_DEPTH)",
                     GPGP_MAX_LAYER_DEPTH);
  makeRoom(masks_);
  makeRoom(commands_);
  masks_.push_back(static_cast<uint32_t>(commands_.size()));
  beginPicture(Kind::mask, static_cast<uint32_t>(masks_.size() - 1));
  return static_cast<uint32_t>(masks_.size());
}

Result<void> List::pop() {
  if (stack_.empty()) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "all that was pushed has been popped");
  const State outer = stack_.back();
  if (state_.open && state_.open != outer.open) { // a layer or a mask
    Command& command = commands_[state_.open - 1];
    command.count = static_cast<uint32_t>(commands_.size()) - state_.open;
    if (command.kind == Kind::mask) command.id = 1; // it is whole
    closed_ = commands_.size();
  }
  state_ = outer;
  stack_.pop_back();
  return {};
}

List::Command& List::addCommand(Kind what) {
  makeRoom(commands_);
  Command& command = commands_.emplace_back();
  command.kind = what;
  command.firstEntry = entries_;
  command.space = state_.space;
  command.opacity = state_.opacity;
  command.picture = state_.open;
  return command;
}

Result<uint32_t> List::addImagePaint(const GpgpListImage& image, const vec4& box) {
  if (image.image >= GPGP_MAX_IMAGES)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "image.image is %u; it must be below %u", image.image,
                     GPGP_MAX_IMAGES);
  const float* s = image.source;
  if (!within(s, 4, -1e6f, 1e6f))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "image.source holds something that is not a number within 1e6");
  const float* from = image.sourceBorders;
  const float width = box.z - box.x, height = box.w - box.y;
  float to[4];
  for (int k = 0; k < 4; ++k) to[k] = image.borders[k] * static_cast<float>(state_.space.scale);
  if (!within(from, 4, 0, 1e6f) || !within(to, 4, 0, 1e30f))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "image: a border is not a number from 0 on");
  float tile[2];
  for (int k = 0; k < 2; ++k) {
    if (image.tiles[k] < GPGP_TILE_STRETCH || image.tiles[k] > GPGP_TILE_ROUND)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "image.tiles[%d] is %d", k, image.tiles[k]);
    tile[k] = image.tileSize[k] * static_cast<float>(state_.space.scale);
  }
  if (!within(tile, 2, 0, 1e30f))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "image.tileSize holds something that is not a number from 0 on");
  const float extent[2] = {std::abs(s[2] - s[0]), std::abs(s[3] - s[1])};
  for (int k = 0; k < 2; ++k)
    if (from[k] + from[k + 2] > extent[k] * 1.000001f)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "image.sourceBorders are wider than the source");
  const float most = std::max({to[0], to[1], to[2], to[3], from[0], from[1], from[2], from[3]});
  PaintRecord paint{};
  paint.firstStop = image.image;
  const auto over = [](float a, float b) { return b > 0 ? a / b : 0.0f; };
  if (most == 0 && !image.tiles[0] && !image.tiles[1]) {
    paint.kind = shader::kPaintImage;
    const float u = over(s[2] - s[0], width), v = over(s[3] - s[1], height);
    paint.matrix = {u, 0, 0, v};
    paint.origin = {s[0] - u * box.x, s[1] - v * box.y, 0, 0};
  } else { // along each axis: three slopes between four places, and a period where the middle repeats
    paint.kind = shader::kPaintSlices;
    paint.stopCount = 2;
    paint.matrix = {1, 0, 0, 1};
    paint.origin = {-box.x, -box.y, 0, 0};
    paint.slices = static_cast<uint32_t>(paints_.stops.size());
    vec4 parts[4] = {};
    for (int k = 0; k < 2; ++k) {
      const float side = k ? height : width, sign = s[k + 2] < s[k] ? -1.0f : 1.0f;
      const float shrink = to[k] + to[k + 2] > side ? side / (to[k] + to[k + 2]) : 1;
      const float begin = to[k] * shrink, end = side - to[k + 2] * shrink;
      const float first = s[k] + sign * from[k], last = s[k + 2] - sign * from[k + 2];
      parts[0][2 * k] = begin, parts[0][2 * k + 1] = end;
      parts[1][2 * k] = first, parts[1][2 * k + 1] = last;
      const float middle = end - begin;
      float period = 0;
      if (image.tiles[k] && middle > 0) {
        const float scaled = over(to[k] + to[k + 2], from[k] + from[k + 2]) * shrink * std::abs(last - first);
        period = tile[k] > 0 ? tile[k] : scaled;
        if (!(period > 0))
          return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                           "image.tileSize[%d] is 0, and nothing along it says how large a tile is: it has no borders "
                           "or no middle",
                           k);
        if (image.tiles[k] == GPGP_TILE_ROUND) period = middle / std::max(std::round(middle / period), 1.0f);
        period = std::max(period, middle * 1e-6f); // finer than any pixel
      }
      parts[2 + k] = {sign * over(from[k], begin), over(last - first, period > 0 ? period : middle),
                      sign * over(from[k + 2], side - end), period};
    }
    for (int k = 0; k < 2; ++k) {
      StopRecord stop;
      static_assert(sizeof stop == 2 * sizeof(vec4));
      std::memcpy(&stop, &parts[2 * k], sizeof stop);
      paints_.stops.push_back(stop);
    }
  }
  paints_.paints.push_back(paint);
  return static_cast<uint32_t>(paints_.paints.size());
}

/// 1 + the index of the shape's gradient or image.
Result<uint32_t> List::addPaint(const GpgpListShape& shape) {
  const Space& space = state_.space;
  if (shape.gradient && shape.image) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "both gradient and image are given");
  if (shape.gradient) {
    GpgpGradient gradient = *shape.gradient;
    const float scale = static_cast<float>(space.scale);
    for (float& t : gradient.transform) t *= scale;
    gradient.transform[4] += static_cast<float>(space.x);
    gradient.transform[5] += static_cast<float>(space.y);
    const auto index = addGradient(gradient, paints_);
    if (!index) return index.error();
    return *index + 1;
  }
  if (shape.kind == GPGP_LIST_LINE) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "a line cannot show an image");
  const auto added = addImagePaint(*shape.image, shapes_.back().record.box);
  if (added) images_ = std::max(images_, shape.image->image + 1);
  return added;
}

Result<void> List::addShape(const GpgpListShape& from) {
  const Space& space = state_.space;
  if (!within(from.box, 4, -kMaxCoordinate, kMaxCoordinate))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, ".box holds something that is not a number within 1e7");
  if (!within(&from.width, 1, 0, kMaxCoordinate))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, ".width is %g; expected 0 to 1e7", static_cast<double>(from.width));
  if (!inColorRange(from.color)) return makeError(GPGP_ERROR_INVALID_ARGUMENT, ".color is out of range");
  const auto x = [&](float v) { return static_cast<float>(space.scale * static_cast<double>(v) + space.x); };
  const auto y = [&](float v) { return static_cast<float>(space.scale * static_cast<double>(v) + space.y); };
  const float scale = static_cast<float>(space.scale), width = from.width * scale;
  const vec4 box{x(from.box[0]), y(from.box[1]), x(from.box[2]), y(from.box[3])};
  if (!within(&box.x, 4, -kMaxCoordinate, kMaxCoordinate) || !(width <= kMaxCoordinate))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, ".box or width is beyond 1e7 under the transforms pushed");
  Shape& shape = shapes_.emplace_back();
  if (from.kind == GPGP_LIST_LINE) {
    if (from.cap < GPGP_CAP_BUTT || from.cap > GPGP_CAP_SQUARE)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, ".cap is %d", from.cap);
    if (!(from.width > 0)) return makeError(GPGP_ERROR_INVALID_ARGUMENT, ".width of a line must be above 0");
    shape.record = lineBox(box.x, box.y, box.z, box.w, width, from.cap);
  } else {
    if (box.z < box.x || box.w < box.y)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, ".box: right or bottom lies below left or top");
    if (from.kind == GPGP_LIST_RECTANGLE) {
      if (!within(from.radii, 4, 0, kMaxCoordinate))
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, ".radii hold something that is not a number from 0 to 1e7");
      const float* r = from.radii;
      shape.record = roundBox(box, {r[0] * scale, r[1] * scale, r[2] * scale, r[3] * scale}, 1);
    } else if (from.kind == GPGP_LIST_ELLIPSE) {
      const float a = 0.5f * (box.z - box.x), b = 0.5f * (box.w - box.y);
      shape.record = roundBox(box, {a, a, a, a}, a > 0 ? b / a : 0);
    } else
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, ".kind is %d", from.kind);
    const float side = std::min(box.z - box.x, box.w - box.y);
    shape.record.border = 2 * width < side ? width : 0;
  }
  if (from.gradient || from.image) {
    const auto paint = addPaint(from);
    if (!paint) return paint.error();
    shape.record.paint = *paint;
  }
  shape.color = {from.color[0], from.color[1], from.color[2], from.color[3] * state_.opacity};
  shape.id = from.id;
  return {};
}

Result<void> List::addShapes(std::span<const GpgpListShape> shapes) {
  if (shapes.empty()) return {};
  if (shapes.size() > UINT32_MAX - entries_)
    return makeError(GPGP_ERROR_UNSUPPORTED, "a list holds fewer than 2^32 shapes");
  const size_t before = shapes_.size(), paints = paints_.paints.size(), stops = paints_.stops.size();
  const uint32_t images = images_;
  const auto undo = [&] {
    shapes_.resize(before);
    paints_.paints.resize(paints);
    paints_.stops.resize(stops);
    images_ = images;
  };
  try {
    makeRoom(shapes_, shapes.size());
    for (size_t i = 0; i < shapes.size(); ++i)
      if (auto ok = addShape(shapes[i]); !ok) {
        undo();
        return makeError(ok.error().code, "shapes[%zu]%s%s", i, ok.error().text[0] == '.' ? "" : ": ", ok.error().text);
      }
    const bool extends =
        commands_.size() > closed_ && commands_.back().kind == Kind::shapes && commands_.back().space == state_.space;
    Command& command = extends ? commands_.back() : addCommand(Kind::shapes);
    if (!extends) command.first = static_cast<uint32_t>(before);
    command.count += static_cast<uint32_t>(shapes.size());
  } catch (...) { // no memory
    undo();
    throw;
  }
  entries_ += static_cast<uint32_t>(shapes.size());
  return {};
}

Result<void> List::addText(const core::Object& glyphSet, std::span<const GpgpGlyphInstance> glyphs, uint64_t id) {
  const Space& space = state_.space;
  const size_t before = glyphs_.size();
  makeRoom(glyphs_, glyphs.size());
  makeRoom(commands_);
  for (size_t i = 0; i < glyphs.size(); ++i) {
    GpgpGlyphInstance to = glyphs[i];
    to.x = static_cast<float>(space.scale * static_cast<double>(to.x) + space.x);
    to.y = static_cast<float>(space.scale * static_cast<double>(to.y) + space.y);
    to.size = static_cast<float>(space.scale * static_cast<double>(to.size));
    const bool placed = within(&to.x, 2, -kMaxCoordinate, kMaxCoordinate) && within(&to.size, 1, 0, kMaxCoordinate);
    if (!placed || !inColorRange(to.color)) {
      glyphs_.resize(before);
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "glyphs[%zu]%s", i,
                       placed ? ".color is out of range" : ": x, y or size is out of range");
    }
    to.color[3] *= state_.opacity;
    glyphs_.push_back(to);
  }
  Command& command = addCommand(Kind::text);
  command.first = static_cast<uint32_t>(before);
  command.count = static_cast<uint32_t>(glyphs.size());
  command.slot = glyphSet.handle;
  command.generation = glyphSet.handle->generation;
  command.id = id;
  ++entries_;
  return {};
}

void List::addDrawing(const core::Object& drawing, uint32_t firstImage, uint64_t id) {
  Command& command = addCommand(Kind::drawing);
  command.slot = drawing.handle;
  command.generation = drawing.handle->generation;
  command.firstImage = firstImage;
  command.id = id;
  ++entries_;
}

} // namespace gpgp::vector
