// Compositions and layers: what is there at a frame, and where.
#include "vector/import/lottie/evaluate.h"

#include "vector/import/lottie/evaluator.h"

#include <bit>
#include <cmath>

namespace gpgp::vector::lottie {
namespace {
constexpr double kRadians = 3.14159265358979323846 / 180;
Affine turned(double angle) { return {std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle), 0, 0}; }
Affine moved(Point by) { return {1, 0, 0, 1, by.x, by.y}; }
Point positionOf(const Transform& t, double frame) {
  return t.split ? Point{t.x.number(frame), t.y.number(frame)} : t.position.point(frame);
}
constexpr const char* kFunction = "gpgpEvaluateLottie";
} // namespace

Affine matrixOf(const Transform& t, double frame, double turn) {
  const Point anchor = t.anchor.point(frame), scale = t.scale.point(frame, {100, 100});
  Affine m = moved(positionOf(t, frame)) * turned(t.rotation.number(frame) * kRadians + turn);
  if (const double skew = t.skew.number(frame); skew != 0) {
    const double axis = t.skewAxis.number(frame) * kRadians;
    m = m * turned(-axis) * Affine{1, 0, std::tan(-std::clamp(skew, -89.9, 89.9) * kRadians), 1, 0, 0} * turned(axis);
  }
  return m * Affine{scale.x / 100, 0, 0, scale.y / 100, 0, 0} * moved({-anchor.x, -anchor.y});
}

Affine repeatedMatrix(const Transform& t, double frame, double times) {
  const Point anchor = t.anchor.point(frame), scale = t.scale.point(frame, {100, 100}), by = positionOf(t, frame);
  const auto power = [times](double base) { // a scale that mirrors does so once a step
    const double size = std::pow(std::fabs(base), times);
    return base < 0 && std::fmod(std::floor(times), 2) != 0 ? -size : size;
  };
  return moved({by.x * times + anchor.x, by.y * times + anchor.y}) *
         Affine{power(scale.x / 100), 0, 0, power(scale.y / 100), 0, 0} *
         turned(t.rotation.number(frame) * kRadians * times) * moved({-anchor.x, -anchor.y});
}

void Evaluator::limited(const char* what) {
  reporter_.say(GPGP_SEVERITY_WARNING, GPGP_ERROR_UNSUPPORTED, {},
                std::string(what) + "; the rest of the frame is left out", kFunction);
  stopped_ = true;
}

bool Evaluator::spend(size_t points) {
  if (stopped_) return false;
  points_ += points;
  if (points_ > limits_.points) limited("a frame has more than 4 000 000 points, those of modified paths included");
  return !stopped_;
}

uint32_t Evaluator::open(Scope& scope) {
  svg::ImportedGroup group;
  group.parent = scope.group;
  result_.groups.push_back(std::move(group));
  return scope.group = static_cast<uint32_t>(result_.groups.size());
}

void Evaluator::undo(const Mark& mark) {
  result_.paths.erase(result_.paths.begin() + static_cast<std::ptrdiff_t>(mark.paths), result_.paths.end());
  result_.groups.resize(mark.groups);
  aside_.erase(aside_.begin() + static_cast<std::ptrdiff_t>(mark.aside), aside_.end());
}

svg::ImportedPath Evaluator::pathOf(const Shape& shape) const {
  svg::ImportedPath path;
  path.verbs.assign(shape.verbs.begin(), shape.verbs.end());
  path.points.reserve(shape.points.size() * 2);
  for (const Point& p : shape.points) {
    path.points.push_back(static_cast<float>(p.x));
    path.points.push_back(static_cast<float>(p.y));
  }
  return path;
}

void Evaluator::emit(const Shape& shape, const Affine& map, const Paint& paint, double opacity, const Scope& scope) {
  if (shape.empty() || !(opacity > 0) || !spend(shape.points.size())) return;
  if (result_.paths.size() + aside_.size() >= limits_.paths) return limited("a frame paints more than 100 000 paths");
  Shape placed = shape;
  for (Point& p : placed.points) {
    p = map(p);
    if (std::fabs(p.x) <= 1e7 && std::fabs(p.y) <= 1e7) continue;
    return reporter_.say(GPGP_SEVERITY_WARNING, GPGP_ERROR_INVALID_DATA, {},
                         "a path that leads beyond 1e7 units is left out", kFunction);
  }
  svg::ImportedPath path = pathOf(placed);
  path.rule = paint.rule;
  std::copy(std::begin(paint.color), std::end(paint.color), path.color);
  path.color[3] = static_cast<float>(std::clamp(opacity, 0.0, 1.0));
  path.gradient = paint.gradient;
  path.image = paint.image;
  path.element = "path";
  path.group = scope.group;
  result_.paths.push_back(std::move(path));
}

void Evaluator::content(const Layer& l, double frame, const Affine& map, const Scope& scope) {
  switch (l.kind) {
  case LayerKind::Precomp: return precomp(l, frame, map, scope);
  case LayerKind::Solid: {
    Paint paint;
    for (size_t i = 0; i < 3; ++i) paint.color[i] = linearOf(l.color[i]);
    if (l.width > 0 && l.height > 0) emit(rectangle(0, 0, l.width, l.height, 0, 0, 1), map, paint, 1, scope);
    return;
  }
  case LayerKind::Image: {
    if (l.asset >= animation_.images.size()) return;
    const Image& image = animation_.images[l.asset];
    const Affine place = map * Affine{image.width, 0, 0, image.height, 0, 0};
    if (image.index == UINT32_MAX || !isUsable(place)) return;
    auto own = std::make_shared<GpgpImagePaint>();
    own->image = image.index;
    const double to[6] = {place.a, place.b, place.c, place.d, place.e, place.f};
    for (size_t i = 0; i < 6; ++i) own->transform[i] = static_cast<float>(to[i]);
    Paint paint;
    paint.image = std::move(own);
    return emit(rectangle(0, 0, image.width, image.height, 0, 0, 1), map, paint, 1, scope);
  }
  case LayerKind::Shape: return shapes(l.shapes, frame, map, scope);
  case LayerKind::Text: return text(l, frame, map, scope);
  case LayerKind::Null: return;
  }
}

void Evaluator::precomp(const Layer& l, double frame, const Affine& map, Scope scope) {
  if (l.asset >= animation_.compositions.size()) return;
  if (++scope.depth > limits_.depth)
    return reporter_.say(GPGP_SEVERITY_WARNING, GPGP_ERROR_UNSUPPORTED, {},
                         "compositions are nested more than 64 deep: the innermost are left out", kFunction);
  const double inner = l.timeRemap.value.empty() && !l.timeRemap.animated()
                           ? (frame - l.start) / l.stretch
                           : l.timeRemap.number(frame) * animation_.rate;
  const bool clipped = l.width > 0 && l.height > 0;
  const Mark before = mark();
  const uint32_t group = open(scope);
  ++scope.clips;
  composition(l.asset, inner, map, scope);
  if (!clipped || result_.paths.size() == before.paths) return;
  const Shape box = rectangle(0, 0, l.width, l.height, 0, 0, 1);
  Shape placed = box;
  for (Point& p : placed.points) p = map(p);
  // Not where all of it lies inside already, and nothing spreads.
  bool inside = map.b == 0 && map.c == 0;
  const double left = std::min(placed.points[0].x, placed.points[2].x), right = left + std::fabs(map.a) * l.width,
               top = std::min(placed.points[0].y, placed.points[2].y), bottom = top + std::fabs(map.d) * l.height;
  for (size_t g = before.groups; g < result_.groups.size() && inside; ++g) inside = !result_.groups[g].layer;
  for (size_t i = before.paths; i < result_.paths.size() && inside; ++i)
    for (size_t k = 0; k + 1 < result_.paths[i].points.size() && inside; k += 2) {
      const double x = static_cast<double>(result_.paths[i].points[k]),
                   y = static_cast<double>(result_.paths[i].points[k + 1]);
      inside = x >= left && x <= right && y >= top && y <= bottom;
    }
  if (inside) return;
  if (scope.clips > limits_.clips)
    return reporter_.say(GPGP_SEVERITY_WARNING, GPGP_ERROR_UNSUPPORTED, {},
                         "more than 15 nested clips: the innermost compositions and masks do not clip", kFunction);
  result_.groups[group - 1].clipped = true;
  result_.groups[group - 1].clip.push_back(pathOf(placed));
}

void Evaluator::layer(const Composition& c, size_t index, double frame, const Affine& outer, const Scope& around) {
  if (stopped_) return;
  if (++visited_ > limits_.layers) return limited("a frame shows more than 65 536 layers");
  const Layer& l = c.layers[index];
  if (l.hidden || l.kind == LayerKind::Null || frame < l.in || frame >= l.out) return;
  const double opacity = std::clamp(l.transform.opacity.number(frame, 100) / 100, 0.0, 1.0);
  if (!(opacity > 0)) return;
  const auto ownMatrix = [frame](const Layer& of) {
    return matrixOf(of.transform, frame,
                    of.autoOrient && !of.transform.split ? of.transform.position.direction(frame) : 0);
  };
  Affine map = ownMatrix(l);
  for (int64_t parent = l.parentPlace; parent >= 0; parent = c.layers[static_cast<size_t>(parent)].parentPlace) {
    if (!spend(1)) return;
    map = ownMatrix(c.layers[static_cast<size_t>(parent)]) * map;
  }
  map = outer * map;
  if (!map.finite()) return;

  Scope scope = around;
  const Mark before = mark();
  const uint32_t group = open(scope);
  Kept kept = effects(l, frame, map);
  if (l.blend != GPGP_BLEND_NORMAL) {
    if (!kept) kept = keptLayer();
    kept->layer.blend = l.blend;
  }
  if (kept || l.matte || opacity < 1) ++scope.effects;
  const std::vector<MaskNow> masks = masksOf(l, frame, map);
  std::vector<Wrap> wraps;
  openMasks(masks, scope, wraps);
  if (scope.effects > limits_.effects) {
    reporter_.say(GPGP_SEVERITY_WARNING, GPGP_ERROR_UNSUPPORTED, {},
                  "more than 28 nested effects, masks and opacities: the innermost layers are left out", kFunction);
    return undo(before);
  }
  content(l, frame, map, scope);
  if (result_.paths.size() == before.paths) return undo(before);
  if (!closeMasks(masks, map, scope, wraps)) return undo(before);
  if (l.matte) {
    bool all = false; // shows without a matte
    const uint32_t mask = matte(c, l, frame, outer, scope, all);
    if (!mask && !all) return undo(before);
    if (mask) {
      if (!kept) kept = keptLayer();
      kept->layer.mask = mask;
      kept->layer.maskKind = l.matte >= 3 ? GPGP_MASK_LUMINANCE : GPGP_MASK_ALPHA;
    }
  }
  if (kept) {
    result_.groups[group - 1].layer = std::move(kept);
    result_.groups[group - 1].opacity = static_cast<float>(opacity);
  } else if (result_.paths.size() == before.paths + 1 && result_.paths.back().group == group) {
    result_.paths.back().color[3] *= static_cast<float>(opacity); // nothing of it overlaps
  } else {
    result_.groups[group - 1].opacity = static_cast<float>(opacity);
  }
}

void Evaluator::composition(size_t index, double frame, const Affine& outer, const Scope& scope) {
  const Composition& c = animation_.compositions[index];
  for (size_t i = c.layers.size(); i-- > 0 && !stopped_;)
    if (!c.layers[i].isMatte) layer(c, i, frame, outer, scope);
}

svg::Imported Evaluator::run(double frame) {
  result_.width = animation_.width;
  result_.height = animation_.height;
  Scope scope;
  const uint32_t page = open(scope);
  scope.clips = 1;
  composition(0, std::clamp(frame, animation_.in, std::nextafter(animation_.out, animation_.in)), {}, scope);
  bool inside = true;
  for (const svg::ImportedPath& path : result_.paths)
    for (size_t k = 0; k + 1 < path.points.size() && inside; k += 2) {
      const double x = static_cast<double>(path.points[k]), y = static_cast<double>(path.points[k + 1]);
      inside = x >= 0 && x <= animation_.width && y >= 0 && y <= animation_.height;
    }
  for (const svg::ImportedGroup& group : result_.groups)
    if (group.layer && !group.layer->steps.empty()) inside = false;
  if (!inside) {
    result_.groups[page - 1].clipped = true;
    result_.groups[page - 1].clip.push_back(pathOf(rectangle(0, 0, animation_.width, animation_.height, 0, 0, 1)));
  }
  result_.paths.insert(result_.paths.end(), std::make_move_iterator(aside_.begin()),
                       std::make_move_iterator(aside_.end()));
  return std::move(result_);
}

svg::Imported evaluate(const Animation& animation, double frame, const EvaluateInfo& info, Reporter& reporter) {
  return Evaluator(animation, info, reporter).run(frame);
}

uint64_t contentOf(const svg::Imported& frame) {
  uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&hash](uint64_t v) {
    hash ^= v;
    hash *= 0x9e3779b97f4a7c15u;
    hash ^= hash >> 29;
  };
  const auto addFloats = [&add](const auto& values) {
    for (const float v : values) add(std::bit_cast<uint32_t>(v));
  };
  const auto addPath = [&](const svg::ImportedPath& path) {
    add(path.verbs.size());
    for (const GpgpPathVerb verb : path.verbs) add(verb);
    addFloats(path.points);
    addFloats(path.color);
    add(static_cast<uint64_t>(path.rule) | uint64_t(path.group) << 32);
    if (path.gradient) {
      const GpgpGradient& g = path.gradient->gradient;
      add(static_cast<uint64_t>(g.kind));
      addFloats(g.transform);
      addFloats(g.start), addFloats(g.end);
      addFloats(std::array{g.startRadius, g.endRadius});
      for (const GpgpGradientStop& stop : path.gradient->stops)
        addFloats(std::array{stop.offset}), addFloats(stop.color);
    }
    if (path.image) add(path.image->image + 1), addFloats(path.image->transform);
  };
  for (const svg::ImportedPath& path : frame.paths) addPath(path);
  for (const svg::ImportedGroup& group : frame.groups) {
    add(group.parent);
    addFloats(std::array{group.opacity});
    add(group.clipped);
    for (const svg::ImportedPath& path : group.clip) addPath(path);
    if (!group.layer) continue;
    const GpgpLayer& l = group.layer->layer;
    add(static_cast<uint64_t>(l.blend) | uint64_t(l.mask) << 32);
    add(static_cast<uint64_t>(l.maskKind));
    addFloats(l.filterTransform);
    for (const GpgpFilterStep& step : group.layer->steps) add(static_cast<uint64_t>(step.kind)), addFloats(step.values);
  }
  return hash;
}

} // namespace gpgp::vector::lottie
