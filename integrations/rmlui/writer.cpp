#include "writer.h"

#include <algorithm>
#include <cmath>

namespace gpgp::rmlui {
namespace {

/// A step that can be a clip of the list, for what lies in the given space.
bool isClip(const ClipStep& step, const TransformPointer& transform) {
  return step.operation != ClipOperation::setInverse && step.geometry->shape &&
         (!step.transform || same(step.transform, transform));
}

GpgpListLayer plainLayer() {
  GpgpListLayer layer{};
  layer.blend = GPGP_BLEND_NORMAL;
  layer.opacity = 1;
  layer.maskKind = GPGP_MASK_ALPHA;
  layer.maskEncoding = GPGP_IMAGE_SRGB;
  return layer;
}

} // namespace

GpgpResult Writer::write(const Contents& all, const Box& canvas) {
  canvas_ = canvas;
  error_ = GPGP_SUCCESS;
  did(list_.pushClip(canvas.data()));
  contents(all);
  did(list_.pop());
  return error_;
}

void Writer::pop(uint32_t& pushes) {
  for (; pushes > 0; --pushes) did(list_.pop());
}

void Writer::contents(const Contents& of) {
  for (size_t i = 0; i < of.count && error_ >= 0; ++i) {
    const Operation& operation = (*of.operations)[i];
    if (left_-- == 0) {
      left_ = 0;
      painter_.unsupported("layers that are composited so often that they come to too many operations");
      error_ = GPGP_ERROR_UNSUPPORTED;
    } else if (operation.geometry) {
      geometry(operation);
    } else if (!backdrop(of, i)) {
      composite(operation);
    }
  }
  leave();
}

// ---------------------------------------------------------------- scissors and clip masks

void Writer::pushLayer(GpgpListLayer& layer) {
  const Box bounds = visible(entered_.state);
  std::copy_n(bounds.begin(), 4, layer.bounds);
  did(list_.pushLayer(layer));
}

void Writer::pushTransform(const Transform& t) {
  did(list_.pushTransform(t.map.data(), t.projective() ? t.perspective.data() : nullptr));
}

/// The area of the step's geometry, whatever its colours.
uint32_t Writer::maskOf(const ClipStep& step) {
  const Result<uint32_t> mask = list_.pushMask();
  did(mask.code());
  if (!mask) return 0;
  uint32_t pushes = 1;
  if (step.transform) {
    pushTransform(*step.transform);
    ++pushes;
  }
  Geometry white = *step.geometry;
  for (GpgpListVertex& v : white.vertices) std::fill_n(v.color, 4, uint8_t{255});
  triangles(white, step.x, step.y, nullptr);
  pop(pushes);
  return *mask;
}

/// Pushes what cuts operations of this state, if it is not there. False: nothing of them shows.
bool Writer::enter(const State& state) {
  Entered& e = entered_;
  if (e.valid && e.state.scissor == state.scissor && e.state.clip == state.clip &&
      (!e.inTransform || same(e.state.transform, state.transform)))
    return !e.hidden;
  leave();
  e.state = state;
  e.valid = true;
  e.hidden = empty(visible(state));
  if (e.hidden) return false;
  std::vector<std::pair<uint32_t, bool>> masks; // inverted?
  if (state.clip)
    for (const ClipStep& step : *state.clip)
      if (!isClip(step, state.transform)) masks.emplace_back(maskOf(step), step.operation == ClipOperation::setInverse);
  if (state.scissor) {
    did(list_.pushClip(state.scissor->data()));
    ++e.pushes;
  }
  for (const auto& [mask, inverted] : masks) {
    GpgpListLayer layer = plainLayer();
    layer.mask = mask;
    layer.maskInverted = inverted;
    pushLayer(layer);
    ++e.pushes;
  }
  if (!state.clip) return true;
  const auto pushClip = [&](const ClipStep& step) {
    const RoundBox& shape = *step.geometry->shape;
    const Box box{shape.box[0] + step.x, shape.box[1] + step.y, shape.box[2] + step.x, shape.box[3] + step.y};
    did(list_.pushClip(box.data(), shape.radii.data()));
    ++e.pushes;
  };
  for (const ClipStep& step : *state.clip)
    if (isClip(step, state.transform) && !step.transform) pushClip(step);
  for (const ClipStep& step : *state.clip) {
    if (!isClip(step, state.transform) || !step.transform) continue;
    if (!e.inTransform) {
      pushTransform(*state.transform);
      ++e.pushes;
      e.inTransform = true;
    }
    pushClip(step);
  }
  return true;
}

void Writer::leave() {
  pop(entered_.pushes);
  entered_ = {};
}

// ---------------------------------------------------------------- geometry

void Writer::geometry(const Operation& operation) {
  if (!enter(operation.state)) return;
  uint32_t pushes = 0;
  if (operation.state.transform && !entered_.inTransform) {
    pushTransform(*operation.state.transform);
    ++pushes;
  }
  if (!operation.paint)
    triangles(*operation.geometry, operation.x, operation.y, nullptr);
  else if (operation.paint->kind == Paint::Kind::image)
    triangles(*operation.geometry, operation.x, operation.y, operation.paint->texture.get());
  else if (operation.paint->kind == Paint::Kind::gradient)
    gradient(operation);
  else if (operation.paint->kind == Paint::Kind::drawing)
    drawing(operation);
  else
    text(operation);
  pop(pushes);
}

void Writer::triangles(const Geometry& geometry, float x, float y, const Texture* texture) {
  if (geometry.indices.empty()) return;
  GpgpListTriangles triangles{};
  triangles.vertices = geometry.vertices.data();
  triangles.vertexCount = static_cast<uint32_t>(geometry.vertices.size());
  triangles.indices = geometry.indices.data();
  triangles.indexCount = static_cast<uint32_t>(geometry.indices.size());
  triangles.indexType = VK_INDEX_TYPE_UINT32;
  triangles.encoding = GPGP_IMAGE_SRGB;
  triangles.premultiplied = VK_TRUE;
  triangles.image = texture ? painter_.image(*texture) : GPGP_IMAGE_NONE;
  triangles.id = GPGP_ID_NOT_HIT;
  const float move[6] = {1, 0, 0, 1, x, y};
  did(list_.pushTransform(move));
  did(list_.add(triangles));
  did(list_.pop());
}

void Writer::text(const Operation& operation) {
  const TextStyle& style = operation.paint->text;
  const bool projective = operation.state.transform && operation.state.transform->projective();
  if (style.blur > 0 && projective) painter_.unsupported("blurred text in perspective: it is drawn sharp");
  uint32_t pushes = 0;
  std::vector<GpgpFilterStep> steps(1);
  if (style.blur > 0 && !projective) {
    GpgpListLayer layer = plainLayer();
    steps[0].kind = GPGP_FILTER_GAUSSIAN_BLUR;
    steps[0].values[0] = steps[0].values[1] = style.blur;
    steps[0].encoding = GPGP_IMAGE_SRGB;
    std::copy_n(std::array{-1e6f, -1e6f, 1e6f, 1e6f}.data(), 4, steps[0].region);
    layer.filter = steps.data();
    layer.filterCount = 1;
    Box around = boundsOf(*operation.geometry);
    const float reach = 3 * style.blur + style.stroke + 2;
    for (size_t side = 0; side < 4; ++side)
      layer.bounds[side] = around[side] + (side % 2 == 0 ? operation.x : operation.y) + (side < 2 ? -reach : reach);
    did(list_.pushLayer(layer));
    ++pushes;
  }
  did(painter_.text(list_, *operation.geometry, operation.x, operation.y, style));
  pop(pushes);
}

/// Boxes, as RmlUi shows images in: four corners each, from the top left one on.
void Writer::drawing(const Operation& operation) {
  const Geometry& geometry = *operation.geometry;
  GpgpDrawingInfo info = GPGP_DRAWING_INFO_INIT;
  if (gpgpGetDrawingInfo(operation.paint->drawing, &info) < 0) return;
  const float* page = info.viewport;
  if (geometry.vertices.size() % 4 != 0) {
    painter_.unsupported("a drawing as the image of something else than boxes");
    return;
  }
  for (size_t i = 0; i < geometry.vertices.size(); i += 4) {
    const GpgpListVertex &a = geometry.vertices[i], &c = geometry.vertices[i + 2];
    const Box box{a.x, a.y, c.x, c.y}, source{a.u, a.v, c.u, c.v};
    if (empty(box)) continue;
    const bool turned = std::any_of(&a + 1, &a + 4, [&](const GpgpListVertex& v) {
      const size_t x = v.x == a.x ? 0 : 2, y = v.y == a.y ? 1 : 3;
      return v.x != box[x] || v.y != box[y] || v.u != source[x] || v.v != source[y];
    });
    const bool inside = std::all_of(source.begin(), source.end(), [](float v) { return v > -1e-4f && v < 1.0001f; });
    if (turned || !inside || source[0] == source[2] || source[1] == source[3]) {
      painter_.unsupported("a drawing that is repeated, or the image of something else than boxes");
      continue;
    }
    if (a.color[0] != a.color[3] || a.color[1] != a.color[3] || a.color[2] != a.color[3])
      painter_.unsupported("image-color of drawings: they keep their colours");
    const float move[6] = {1, 0, 0, 1, operation.x, operation.y};
    const float width = (box[2] - box[0]) / (source[2] - source[0]) / page[2];
    const float height = (box[3] - box[1]) / (source[3] - source[1]) / page[3];
    const float place[6] = {width,
                            0,
                            0,
                            height,
                            box[0] - source[0] * page[2] * width - page[0] * width,
                            box[1] - source[1] * page[3] * height - page[1] * height};
    uint32_t pushes = 3;
    did(list_.pushTransform(move));
    did(list_.pushClip(box.data()));
    did(list_.pushTransform(place));
    if (a.color[3] < 255) {
      did(list_.pushGroup(static_cast<float>(a.color[3]) / 255));
      ++pushes;
    }
    did(list_.add(operation.paint->drawing, 0, GPGP_ID_NOT_HIT));
    pop(pushes);
  }
}

// ---------------------------------------------------------------- layers and filters

/// Steps that take what the one before has made, within what is visible.
void Writer::finishSteps(std::vector<GpgpFilterStep>& steps) const {
  const Box region = visible(entered_.state);
  for (size_t i = 0; i < steps.size(); ++i) {
    steps[i].input = i == 0 ? uint32_t{GPGP_FILTER_SOURCE} : GPGP_FILTER_FIRST_STEP + static_cast<uint32_t>(i) - 1;
    steps[i].encoding = GPGP_IMAGE_SRGB;
    std::copy_n(region.begin(), 4, steps[i].region);
  }
}

std::vector<Writer::Stage> Writer::stagesOf(const std::vector<FilterPointer>& filters) const {
  std::vector<Stage> stages;
  for (const FilterPointer& filter : filters) {
    const bool late = filter->kind == Filter::Kind::steps  ? !stages.empty() && stages.back().closed
                      : filter->kind == Filter::Kind::mask ? !stages.empty() && stages.back().mask
                                                           : false;
    if (stages.empty() || late) stages.emplace_back();
    Stage& stage = stages.back();
    switch (filter->kind) {
    case Filter::Kind::steps: stage.steps.push_back(filter->step); break;
    case Filter::Kind::mask: stage.mask = &filter->mask; break;
    case Filter::Kind::opacity: stage.opacity *= filter->opacity; break;
    }
    stage.closed = filter->kind != Filter::Kind::steps;
  }
  return stages;
}

/// Whether it can be written without a layer around: then nothing in it asks what lies behind.
bool plain(const Contents& contents) {
  return std::all_of(contents.operations->begin(), contents.operations->begin() + std::ptrdiff_t(contents.count),
                     [](const Operation& operation) { return operation.geometry != nullptr; });
}

void Writer::composite(const Operation& operation) {
  if (operation.source.count == 0) return;
  std::vector<Stage> stages = stagesOf(operation.filters);
  if (stages.empty() && !plain(operation.source)) stages.emplace_back();
  leave();
  std::vector<uint32_t> masks(stages.size(), 0);
  for (size_t i = 0; i < stages.size(); ++i) {
    if (!stages[i].mask) continue;
    const Result<uint32_t> mask = list_.pushMask();
    did(mask.code());
    if (!mask) return;
    masks[i] = *mask;
    contents(*stages[i].mask);
    did(list_.pop());
  }
  if (enter(operation.state)) {
    uint32_t pushes = 0;
    for (size_t i = stages.size(); i-- > 0; ++pushes) { // the last filter's layer is the outermost
      GpgpListLayer layer = plainLayer();
      finishSteps(stages[i].steps);
      if (!stages[i].steps.empty()) layer.filter = stages[i].steps.data();
      layer.filterCount = static_cast<uint32_t>(stages[i].steps.size());
      layer.opacity = std::clamp(stages[i].opacity, 0.0f, 1.0f);
      layer.mask = masks[i];
      pushLayer(layer);
    }
    const Box input = visible(operation.state);
    if (pushes > 0) { // what goes into filters is cut as well
      did(list_.pushClip(input.data()));
      ++pushes;
    }
    const Entered around = entered_;
    entered_ = {};
    contents(operation.source);
    entered_ = around;
    pop(pushes);
  }
  leave();
}

/// What RmlUi makes of backdrop-filter: a layer that holds nothing but what lies below, filtered, composited at once.
/// The list has a layer for it. False: the operation is something else.
bool Writer::backdrop(const Contents& below, size_t index) {
  const Operation& shown = (*below.operations)[index];
  if (!shown.filters.empty() || shown.source.count != 1) return false;
  const Operation& taken = shown.source.operations->front();
  if (taken.geometry || taken.source.operations != below.operations || taken.source.count != index ||
      taken.filters.empty() || taken.state.clip)
    return false;
  std::vector<Stage> stages = stagesOf(taken.filters);
  if (stages.size() != 1 || stages[0].mask || stages[0].opacity != 1) return false;
  leave();
  if (enter(shown.state)) {
    GpgpListLayer layer = plainLayer();
    layer.backdrop = VK_TRUE;
    finishSteps(stages[0].steps);
    const Box region = visible(taken.state);
    for (GpgpFilterStep& step : stages[0].steps) std::copy_n(region.begin(), 4, step.region);
    layer.filter = stages[0].steps.data();
    layer.filterCount = static_cast<uint32_t>(stages[0].steps.size());
    pushLayer(layer);
    did(list_.pop());
  }
  leave();
  return true;
}

} // namespace gpgp::rmlui
