// Filters as operations: from the last step back, what each must make for those behind it; then from the first one on.
#include "vector/raster/layer_boxes.h"
#include "vector/shared/color.h"

namespace gpgp::vector {
namespace {
using shader::OperationRecord;

shader::vec4 floodColor(const float* linear, float alpha, bool srgb) {
  return shader::blended({linear[0], linear[1], linear[2]}, alpha, srgb ? shader::kBlendSrgb : 0);
}

constexpr int kMostShrink = 7; // a power of two: one invocation reads as many pixels, squared

/// How a blur is made of blurs with strides 1, 2, 4...: few samples for any deviation.
struct Strides {
  static constexpr int kMost = 24;
  int count = 0;        // 0: nothing is blurred
  double deviation = 0; // of each, in its strides
  int samples = 0;      // to each side

  explicit Strides(double whole) {
    if (whole < 0.02) return;
    const auto of = [](int n) { return (std::pow(4.0, n) - 1) / 3; }; // how variances add up
    count = 1;
    if (whole > 16)
      while (whole > 3 * std::sqrt(of(count)) && count < kMost) ++count;
    deviation = whole / std::sqrt(of(count));
    samples = static_cast<int>(std::ceil(kBlurReach * deviation));
  }
  /// Of those from one on, in pixels.
  double reach(int from) const {
    return count > from ? (samples + 1) * (std::pow(2.0, count) - std::pow(2.0, from)) : 0;
  }
};
/// What of a region is read where places outside of it stand for its nearest ones.
PixelBox nearestIn(const PixelBox& region, const PixelBox& wanted) {
  if (region.empty()) return {};
  const auto low = [](int v, int from, int to) { return std::clamp(v, from, to - 2 < from ? from : to - 2); };
  const PixelBox near{low(wanted.left, region.left, region.right), low(wanted.top, region.top, region.bottom),
                      std::clamp(wanted.right, region.left + 2, std::max(region.right, region.left + 2)),
                      std::clamp(wanted.bottom, region.top + 2, std::max(region.bottom, region.top + 2))};
  return join(near, PixelBox{near.left, near.top, near.left + 2, near.top + 2});
}
} // namespace

/// In another encoding, where that is needed.
LayerPlanner::Picture LayerPlanner::as(const Picture& from, bool srgb) {
  if (from.srgb == srgb || from.box.empty()) return from;
  const Picture to = picture(from.box, srgb);
  convertA(operation(shader::kOperationCopy, kColors, to), from, srgb);
  return to;
}

bool LayerPlanner::filter(const Around& a, const LayerNode& node, uint32_t index, const PixelBox& shown,
                          Picture& result) {
  const Box content = a.bounds.contents[index];
  const Box region{node.filterRegion[0], node.filterRegion[1], node.filterRegion[2], node.filterRegion[3]};
  float inverse[6];
  const bool whole = invert(node.filterTransform, inverse) && [&] {
    const Box own = mapped(content, inverse), both = meet(own, region);
    return both.left == own.left && both.top == own.top && both.right == own.right && both.bottom == own.bottom;
  }();
  const std::function<Picture(const PixelBox&)> paint = [&](const PixelBox& box) {
    const Picture made = this->region(box);
    sequence(a, node.content, made, true, 1);
    return made;
  };
  return filter(a, node, {pixels(a.map, content), whole, paint}, shown, result);
}

/// False: there is nothing to see.
bool LayerPlanner::filter(const Around& a, const LayerNode& node, const FilterInput& given, const PixelBox& shown,
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
    const auto inputBox = [&](uint32_t input) {
      const float* r =
          input >= GPGP_FILTER_FIRST_STEP ? steps[input - GPGP_FILTER_FIRST_STEP].region : node.filterRegion;
      return pixels(space, Box{r[0], r[1], r[2], r[3]});
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
        ask(s.input, spread(need, kernelReach(v, 0), kernelReach(v, 1)));
      else if (s.mode == GPGP_EDGE_DUPLICATE && space.b == 0 && space.c == 0)
        ask(s.input, nearestIn(inputBox(s.input), spread(need, kernelReach(v, 0), kernelReach(v, 1))));
      else
        ask(s.input, {-kFar, -kFar, kFar, kFar});
      break;
    case GPGP_FILTER_DISPLACEMENT_MAP:
      ask(s.input, spread(need, std::abs(value(0)) / 2 + 1, std::abs(value(0)) / 2 + 1));
      ask(s.input2, need);
      break;
    case GPGP_FILTER_DIFFUSE_LIGHTING:
    case GPGP_FILTER_SPECULAR_LIGHTING: ask(s.input, spread(need, 2 * distanceOf(v[14]), 2 * distanceOf(v[15]))); break;
    case GPGP_FILTER_TILE: ask(s.input, {-kFar, -kFar, kFar, kFar}); break;
    case GPGP_FILTER_BLEND:
    case GPGP_FILTER_COMPOSITE:
      ask(s.input, need);
      ask(s.input2, need);
      break;
    default: ask(s.input, need); break;
    }
  }
  const float* cut = node.filterRegion;
  source = meet(source, meet(given.box, pixels(space, Box{cut[0], cut[1], cut[2], cut[3]})));
  Picture graphic{{}, false, srgb_, 0, 0, 0}, alpha = graphic;
  if (!source.empty()) {
    graphic = given.paint(source);
    if (!given.whole) {
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
      const PixelBox all = join(box, current.box); // beyond it there is nothing
      o.count = static_cast<uint32_t>(std::min(pixels, double(axis == 0 ? widthOf(all) : heightOf(all))));
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
    o.values[0] = table(a.drawing->tableOf(s.firstEntry));
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
    o.values[3] = table(a.drawing->tableOf(s.firstEntry));
    o.values[4] = {distanceOf(v[7]), distanceOf(v[8]), 0, 0};
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
    o.values[2] = table(a.drawing->latticeOf(static_cast<uint32_t>(&s - a.plan.steps.data())));
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
    o.values[4] = {distanceOf(v[14]), distanceOf(v[15]), 0, 0};
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
    factors[k] = deviations[k] >= 8 ? 1 << std::min(static_cast<int>(std::log2(deviations[k] / 4)), kMostShrink) : 1;
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
  const Strides strides[2] = {Strides(smaller[0]), Strides(smaller[1])};
  struct Pass {
    int axis, index;
    PixelBox box;
  };
  std::array<Pass, 2 * Strides::kMost> passes;
  size_t count = 0;
  uint64_t largest = 0;
  PixelBox last = current.box;
  for (int k = 0; k < 2; ++k)
    for (int index = 0; index < strides[k].count; ++index) {
      const Strides& own = strides[k];
      // A pass leaves what those behind it read.
      const double later = own.reach(index + 1), across = k == 0 ? strides[1].reach(0) : 0;
      const PixelBox box = grow(inner, std::abs(ways[k][0]) * later + std::abs(ways[1][0]) * across,
                                std::abs(ways[k][1]) * later + std::abs(ways[1][1]) * across);
      const double taps = (own.samples + 1) * std::pow(2.0, index);
      last = meet(box, grow(last, std::abs(ways[k][0]) * taps, std::abs(ways[k][1]) * taps));
      if (last.empty()) return Picture{{}, false, srgb, 0, 0, 0};
      passes[count++] = {k, index, last};
      largest = std::max(largest, uint64_t(widthOf(last)) * heightOf(last));
    }
  // Of more than two passes each takes the place of the one before the last.
  const uint64_t first = state_.pixels;
  for (size_t i = 0; i < count; ++i) {
    const Pass& pass = passes[i];
    if (count > 2) state_.pixels = first + (i % 2) * largest;
    const Picture next = picture(pass.box, srgb);
    OperationRecord& o = operation(shader::kOperationBlur, kBlur, next);
    o.a = recordOf(current);
    o.values[0] = {narrow(ways[pass.axis][0]), narrow(ways[pass.axis][1]), narrow(strides[pass.axis].deviation),
                   narrow(1 << pass.index)};
    o.count = static_cast<uint32_t>(strides[pass.axis].samples);
    current = next;
  }
  if (count > 2) {
    state_.pixels = first + 2 * largest;
    state_.mostPixels = std::max(state_.mostPixels, state_.pixels);
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
