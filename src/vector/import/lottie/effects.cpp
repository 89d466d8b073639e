// What happens to a layer as a whole: effects, masks, and the layer that is its matte.
#include "vector/import/lottie/evaluator.h"

#include <cmath>

namespace gpgp::vector::lottie {
namespace {
constexpr double kRadians = 3.14159265358979323846 / 180;
constexpr double kBlurSigma = 0.3;    ///< of blurriness and feather, as players have it
constexpr double kShadowSigma = 0.25; ///< of softness
constexpr const char* kFunction = "gpgpEvaluateLottie";

void store(const Affine& m, float (&transform)[6]) {
  const double to[6] = {m.a, m.b, m.c, m.d, m.e, m.f};
  for (size_t i = 0; i < 6; ++i) transform[i] = static_cast<float>(to[i]);
}
} // namespace

void Evaluator::region(const Affine& map, float (&box)[4]) const {
  const double w = animation_.width, h = animation_.height, more = 0.25 * std::max(w, h);
  const Affine back = inverseOf(map);
  double l = 1e30, t = 1e30, r = -1e30, b = -1e30;
  for (const Point corner :
       {Point{-more, -more}, Point{w + more, -more}, Point{-more, h + more}, Point{w + more, h + more}}) {
    const Point p = back(corner);
    l = std::min(l, p.x), t = std::min(t, p.y), r = std::max(r, p.x), b = std::max(b, p.y);
  }
  size_t i = 0;
  for (const double v : {l, t, r, b}) box[i++] = static_cast<float>(std::clamp(v, -1e7, 1e7));
}

Evaluator::Kept Evaluator::keptLayer() const {
  auto kept = std::make_shared<svg::ImportedLayer>();
  GpgpLayer& l = kept->layer;
  l.maskEncoding = GPGP_IMAGE_SRGB;
  store({}, l.maskTransform);
  store({}, l.filterTransform);
  region({}, l.maskRegion);
  region({}, l.filterRegion);
  return kept;
}

GpgpFilterStep Evaluator::step(GpgpFilterKind kind, std::initializer_list<double> values, const Affine& map) const {
  GpgpFilterStep s{};
  s.kind = kind;
  s.input = GPGP_FILTER_SOURCE;
  s.encoding = GPGP_IMAGE_SRGB;
  region(map, s.region);
  size_t i = 0;
  for (const double v : values) s.values[i++] = static_cast<float>(v);
  return s;
}

void Evaluator::setFilter(svg::ImportedLayer& layer, const Affine& map, std::vector<GpgpFilterStep> steps) const {
  for (size_t i = 1; i < steps.size(); ++i) steps[i].input = GPGP_FILTER_FIRST_STEP + static_cast<uint32_t>(i) - 1;
  layer.steps = std::move(steps);
  store(map, layer.layer.filterTransform);
  region(map, layer.layer.filterRegion);
}

Evaluator::Kept Evaluator::effects(const Layer& l, double frame, const Affine& map) {
  if (l.effects.empty() || !isUsable(map) || !spend(16 * l.effects.size())) return nullptr;
  std::vector<GpgpFilterStep> steps;
  for (const Effect& e : l.effects) {
    const auto number = [&](size_t i) { return e.numbers[i].number(frame); };
    const auto color = [&](size_t i) {
      std::vector<double> c = e.colors[i].at(frame);
      c.resize(3);
      for (double& v : c) v = std::clamp(v, 0.0, 1.0);
      return c;
    };
    switch (e.kind) {
    case EffectKind::Fill: {
      const std::vector<double> c = color(0);
      steps.push_back(step(
          GPGP_FILTER_COLOR_MATRIX,
          {0, 0, 0, 0, c[0], 0, 0, 0, 0, c[1], 0, 0, 0, 0, c[2], 0, 0, 0, std::clamp(number(0), 0.0, 1.0), 0}, map));
      break;
    }
    case EffectKind::Tint: { // black and white become two colours, what lies between by its luminance
      const std::vector<double> black = color(0), white = color(1);
      const double amount = std::clamp(number(0) / 100, 0.0, 1.0);
      GpgpFilterStep s = step(GPGP_FILTER_COLOR_MATRIX, {}, map);
      const double luminance[3] = {0.2126, 0.7152, 0.0722};
      for (size_t row = 0; row < 3; ++row) {
        for (size_t k = 0; k < 3; ++k)
          s.values[5 * row + k] =
              static_cast<float>((row == k ? 1 - amount : 0) + amount * (white[row] - black[row]) * luminance[k]);
        s.values[5 * row + 4] = static_cast<float>(amount * black[row]);
      }
      s.values[18] = 1;
      steps.push_back(s);
      break;
    }
    case EffectKind::DropShadow: {
      const std::vector<double> c = color(0);
      const double angle = (number(1) - 90) * kRadians, far = std::clamp(number(2), -1e5, 1e5);
      const double sigma = std::clamp(number(3) * kShadowSigma, 0.0, 1e4);
      steps.push_back(step(GPGP_FILTER_DROP_SHADOW,
                           {sigma, sigma, far * std::cos(angle), far * std::sin(angle),
                            static_cast<double>(linearOf(c[0])), static_cast<double>(linearOf(c[1])),
                            static_cast<double>(linearOf(c[2])), std::clamp(number(0) / 255, 0.0, 1.0)},
                           map));
      break;
    }
    case EffectKind::Blur: {
      const double sigma = std::clamp(number(0) * kBlurSigma, 0.0, 1e4), axes = number(1);
      if (sigma > 0)
        steps.push_back(step(GPGP_FILTER_GAUSSIAN_BLUR, {axes == 3 ? 0 : sigma, axes == 2 ? 0 : sigma}, map));
      break;
    }
    }
  }
  if (steps.empty()) return nullptr;
  Kept kept = keptLayer();
  setFilter(*kept, map, std::move(steps));
  return kept;
}

std::vector<Evaluator::MaskNow> Evaluator::masksOf(const Layer& l, double frame, const Affine& map) {
  std::vector<MaskNow> masks;
  for (const Mask& mask : l.masks) {
    MaskNow now{mask.mode, mask.inverted, std::clamp(mask.opacity.number(frame, 100) / 100, 0.0, 1.0), 0, 0, Shape()};
    if (masks.empty() && now.mode == 'i') now.mode = 'a'; // there is nothing else yet
    const Point feather = mask.feather.point(frame, {mask.feather.number(frame), mask.feather.number(frame)});
    if (isUsable(map)) {
      now.sigmaX = std::clamp(feather.x * kBlurSigma, 0.0, 1e4);
      now.sigmaY = std::clamp(feather.y * kBlurSigma, 0.0, 1e4);
    }
    const Contour contour = contourOf(mask.path.at(frame), mask.path.closed);
    if (!spend(1 + contour.vertices.size())) break;
    append(contour, {}, now.shape);
    if (const double expansion = mask.expansion.number(frame); expansion > 0) {
      StrokeStyle style;
      style.width = std::min(2 * expansion, 1e5);
      style.join = Join::Round;
      Shape closed = now.shape;
      if (!contour.closed && !closed.empty()) closed.close();
      // The outline turns the same way everywhere, and the mask is made to turn so as well: they join.
      double area = 0;
      for (size_t i = 0; i < contour.vertices.size(); ++i) {
        const Point a = contour.vertices[i].at, b = contour.vertices[(i + 1) % contour.vertices.size()].at;
        area += a.x * b.y - b.x * a.y;
      }
      Shape outline;
      if (strokeShape(closed, style, 0.05 / (std::max(map.scale(), 1e-6) * info_.scale), {}, outline)) {
        double outlineArea = 0;
        for (size_t i = 0; i < outline.points.size(); ++i) {
          const Point a = outline.points[i], b = outline.points[(i + 1) % outline.points.size()];
          outlineArea += a.x * b.y - b.x * a.y;
        }
        if (area * outlineArea < 0) {
          Contour turned = contour;
          std::reverse(turned.vertices.begin(), turned.vertices.end());
          for (Contour::Vertex& v : turned.vertices) std::swap(v.in, v.out);
          now.shape = Shape();
          append(turned, {}, now.shape);
        }
        now.shape.verbs.insert(now.shape.verbs.end(), outline.verbs.begin(), outline.verbs.end());
        now.shape.points.insert(now.shape.points.end(), outline.points.begin(), outline.points.end());
      }
    } else if (expansion < 0) {
      reporter_.say(GPGP_SEVERITY_WARNING, GPGP_ERROR_UNSUPPORTED, {},
                    "masks that are shrunk are not supported: they keep their size", kFunction);
    }
    bool reachable = true;
    for (Point& p : now.shape.points) {
      p = map(p);
      reachable = reachable && std::fabs(p.x) <= 1e7 && std::fabs(p.y) <= 1e7;
    }
    if (!reachable) now.shape = Shape();
    masks.push_back(std::move(now));
  }
  return masks;
}

void Evaluator::openMasks(const std::vector<MaskNow>& masks, Scope& scope, std::vector<Wrap>& wraps) {
  const auto wrap = [&](size_t count, bool clip, bool inverse, bool whole) {
    ++(clip ? scope.clips : scope.effects);
    wraps.push_back({open(scope), count, clip, inverse, whole});
  };
  for (size_t k = masks.size(); k > 0; --k) {
    const MaskNow& mask = masks[k - 1];
    const bool room = scope.clips < limits_.clips;
    if (mask.mode != 'a') {
      wrap(k, mask.mode == 'i' && mask.simple() && room, mask.mode == 's', false);
      continue;
    }
    bool simple = room;
    for (size_t i = 0; i < k; ++i) simple = simple && masks[i].mode == 'a' && masks[i].simple();
    return wrap(k, simple, false, true);
  }
}

bool Evaluator::closeMasks(const std::vector<MaskNow>& masks, const Affine& map, const Scope& scope,
                           const std::vector<Wrap>& wraps) {
  for (const Wrap& wrap : wraps) {
    if (wrap.isClip) {
      svg::ImportedGroup& group = result_.groups[wrap.group - 1];
      group.clipped = true;
      for (size_t i = wrap.isWhole ? 0 : wrap.count - 1; i < wrap.count; ++i)
        if (!masks[i].shape.empty()) group.clip.push_back(pathOf(masks[i].shape));
      if (group.clip.empty()) return false;
      continue;
    }
    const uint32_t mask = aside(scope, [&](const Scope& inner) {
      if (wrap.isWhole)
        paintMasks(masks, wrap.count, map, inner);
      else
        paintMask(masks[wrap.count - 1], wrap.isInverse, map, inner);
    });
    if (!mask) return false;
    Kept kept = keptLayer();
    kept->layer.mask = mask;
    kept->layer.maskKind = GPGP_MASK_ALPHA;
    result_.groups[wrap.group - 1].layer = std::move(kept);
  }
  return true;
}

void Evaluator::paintPage(float grey, double opacity, const Scope& scope) {
  float box[4];
  region({}, box);
  const auto at = [&box](size_t i) { return static_cast<double>(box[i]); };
  emit(rectangle(at(0), at(1), at(2) - at(0), at(3) - at(1), 0, 0, 1), {}, {{grey, grey, grey, 1}, nullptr, nullptr},
       opacity, scope);
}

/// The first masks together, as alpha.
void Evaluator::paintMasks(const std::vector<MaskNow>& masks, size_t count, const Affine& map, const Scope& scope) {
  if (count == 0) {
    if (masks[0].mode != 'a') paintPage(1, 1, scope);
    return;
  }
  const MaskNow& mask = masks[count - 1];
  if (mask.mode == 'a') {
    paintMasks(masks, count - 1, map, scope);
    return paintMask(mask, false, map, scope);
  }
  if (scope.effects >= limits_.effects) return;
  const Mark before = mark();
  Scope inner = scope;
  const uint32_t group = open(inner);
  ++inner.effects;
  paintMasks(masks, count - 1, map, inner);
  if (result_.paths.size() == before.paths) return undo(before);
  const uint32_t by = aside(inner, [&](const Scope& apart) { paintMask(mask, mask.mode == 's', map, apart); });
  if (!by) return undo(before);
  Kept kept = keptLayer();
  kept->layer.mask = by;
  kept->layer.maskKind = GPGP_MASK_ALPHA;
  result_.groups[group - 1].layer = std::move(kept);
}

/// One mask, as alpha: what its path covers becomes p alpha + q.
void Evaluator::paintMask(const MaskNow& mask, bool inverse, const Affine& map, const Scope& scope) {
  double p = mask.inverted ? -mask.opacity : mask.opacity, q = mask.inverted ? mask.opacity : 0;
  if (inverse) p = -p, q = 1 - q;
  const Paint white{{1, 1, 1, 1}, nullptr, nullptr};
  if (mask.shape.empty()) return paintPage(1, q, scope);
  const bool blurred = mask.sigmaX > 0 || mask.sigmaY > 0;
  if (!blurred && q == 0) return emit(mask.shape, {}, white, p, scope);
  std::vector<GpgpFilterStep> steps;
  if (blurred) steps.push_back(step(GPGP_FILTER_GAUSSIAN_BLUR, {mask.sigmaX, mask.sigmaY}, map));
  const Affine space = blurred ? map : Affine{};
  steps.push_back(step(GPGP_FILTER_COLOR_MATRIX, {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, p, q}, space));
  Scope inner = scope;
  const uint32_t group = open(inner);
  emit(mask.shape, {}, white, 1, inner);
  Kept kept = keptLayer();
  setFilter(*kept, space, std::move(steps));
  result_.groups[group - 1].layer = std::move(kept);
}

uint32_t Evaluator::matte(const Composition& c, const Layer& l, double frame, const Affine& outer, const Scope& scope,
                          bool& all) {
  const bool inverted = l.matte == 2 || l.matte == 4;
  all = false;
  bool shown = false;
  const uint32_t mask = aside(scope, [&](const Scope& inner) {
    if (l.matte == 4) paintPage(0, 1, inner); // where nothing is, it is black
    const size_t before = result_.paths.size();
    layer(c, static_cast<size_t>(l.mattePlace), frame, outer, inner);
    shown = result_.paths.size() > before;
  });
  if (!shown) {
    all = inverted;
    return 0;
  }
  if (inverted) {
    Kept kept = keptLayer();
    if (l.matte == 2)
      setFilter(*kept, {},
                {step(GPGP_FILTER_COLOR_MATRIX, {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 1}, {})});
    else
      setFilter(*kept, {},
                {step(GPGP_FILTER_COLOR_MATRIX, {-1, 0, 0, 0, 1, 0, -1, 0, 0, 1, 0, 0, -1, 0, 1, 0, 0, 0, 1, 0}, {})});
    result_.groups[mask - 1].layer = std::move(kept);
  }
  return mask;
}

} // namespace gpgp::vector::lottie
