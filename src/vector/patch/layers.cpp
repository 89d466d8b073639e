// Layers: the checks of what the engine or a file gives, and where their pictures can have anything.
#include "vector/patch/layers.h"

#include "vector/patch/drawing.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gpgp::vector {
namespace {
using core::makeError;
using core::Result;

bool sane(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::abs(v) <= 4 * kMaxCoordinate; });
}
bool inRange(float v, float low, float high) { return v >= low && v <= high; }
bool isColor(const float* c) {
  return inRange(c[0], 0, kMaxColor) && inRange(c[1], 0, kMaxColor) && inRange(c[2], 0, kMaxColor);
}
bool isWhole(float v, float low, float high) { return inRange(v, low, high) && v == std::floor(v); }

/// What is wrong with a step's mode, values and table; null: nothing.
const char* wrongStep(const LayerStep& s) {
  const float* v = s.values;
  const auto mode = [&](int32_t last) { return s.mode >= 0 && s.mode <= last; };
  const uint32_t kernel = s.kind == GPGP_FILTER_CONVOLVE_MATRIX && inRange(v[0], 1, 32) && inRange(v[1], 1, 32)
                              ? static_cast<uint32_t>(v[0]) * static_cast<uint32_t>(v[1])
                              : 0;
  const uint32_t entries = s.kind == GPGP_FILTER_COMPONENT_TRANSFER ? 1024 : kernel;
  if (s.kind < GPGP_FILTER_FLOOD || s.kind > GPGP_FILTER_GROUP) return "kind is unknown";
  if (s.encoding != GPGP_IMAGE_LINEAR && s.encoding != GPGP_IMAGE_SRGB) return "encoding is unknown";
  if (!sane(s.values)) return "values hold a number that is not finite";
  if (!sane(s.region) || !(s.region[0] <= s.region[2] && s.region[1] <= s.region[3])) return "region is not a box";
  switch (s.kind) {
  case GPGP_FILTER_FLOOD:
    if (!inColorRange(v)) return "values are not a colour";
    break;
  case GPGP_FILTER_DROP_SHADOW:
    if (!inColorRange(v + 4)) return "values are not a colour";
    [[fallthrough]];
  case GPGP_FILTER_GAUSSIAN_BLUR:
    if (!inRange(v[0], 0, 65536) || !inRange(v[1], 0, 65536)) return "the standard deviation must be 0 to 65536";
    break;
  case GPGP_FILTER_BLEND:
    if (!mode(GPGP_BLEND_PLUS_LIGHTER)) return "mode is not a GpgpBlendMode";
    return nullptr;
  case GPGP_FILTER_COMPOSITE:
    if (!mode(GPGP_OPERATOR_ARITHMETIC)) return "mode is not a GpgpFilterOperator";
    return nullptr;
  case GPGP_FILTER_MORPHOLOGY:
    if (!inRange(v[0], 0, 16384) || !inRange(v[1], 0, 16384)) return "the radius must be 0 to 16384";
    if (!mode(1)) return "mode must be 0 or 1";
    return nullptr;
  case GPGP_FILTER_CONVOLVE_MATRIX:
    if (!isWhole(v[0], 1, 32) || !isWhole(v[1], 1, 32)) return "the order must be 1 to 32";
    if (!isWhole(v[2], 0, v[0] - 1) || !isWhole(v[3], 0, v[1] - 1)) return "the target lies outside of the kernel";
    if (v[4] == 0) return "the divisor is 0";
    if (!inRange(v[7], -1e6f, 1e6f) || !inRange(v[8], -1e6f, 1e6f)) return "a distance must be -1e6 to 1e6";
    if (!mode(GPGP_EDGE_WRAP)) return "mode is not a GpgpFilterEdge";
    if (s.entryCount != kernel) return "table does not hold as many numbers as the kernel has";
    return nullptr;
  case GPGP_FILTER_COMPONENT_TRANSFER:
    if (s.entryCount != 1024) return "table must hold 1024 numbers";
    break;
  case GPGP_FILTER_DISPLACEMENT_MAP:
    if (!mode(15)) return "mode must be 0 to 15";
    return nullptr;
  case GPGP_FILTER_TURBULENCE:
    if (!inRange(v[0], 0, 1e6f) || !inRange(v[1], 0, 1e6f)) return "a frequency must be 0 to 1e6";
    if (!isWhole(v[2], 0, 16)) return "the number of octaves must be 0 to 16";
    if (!mode(1)) return "mode must be 0 or 1";
    return nullptr;
  case GPGP_FILTER_DIFFUSE_LIGHTING:
  case GPGP_FILTER_SPECULAR_LIGHTING:
    if (!isColor(v + 2)) return "values are not a colour";
    if (s.kind == GPGP_FILTER_SPECULAR_LIGHTING && !inRange(v[5], 0, 1024)) return "the exponent must be 0 to 1024";
    if (!inRange(v[14], 0, 1e6f) || !inRange(v[15], 0, 1e6f)) return "a distance must be 0 to 1e6";
    if (!mode(GPGP_LIGHT_SPOT)) return "mode is not a GpgpFilterLight";
    return nullptr;
  case GPGP_FILTER_GROUP:
    if (!s.sequence) return "group is 0";
    break;
  default: break;
  }
  if (s.mode != 0) return "mode must be 0";
  if (s.entryCount != entries) return "table must not be given";
  return nullptr;
}

/// What is wrong with a layer's numbers; null: nothing.
const char* wrongNode(const LayerNode& n) {
  if (n.blend < GPGP_BLEND_NORMAL || n.blend > GPGP_BLEND_PLUS_LIGHTER) return "blend is unknown";
  if (!inRange(n.opacity, 0, 1)) return "opacity must be 0 to 1";
  float inverse[6];
  if (n.mask) {
    if (n.maskKind != GPGP_MASK_LUMINANCE && n.maskKind != GPGP_MASK_ALPHA) return "maskKind is unknown";
    if (n.maskEncoding != GPGP_IMAGE_LINEAR && n.maskEncoding != GPGP_IMAGE_SRGB) return "maskEncoding is unknown";
    if (!sane(n.maskRegion) || !(n.maskRegion[0] <= n.maskRegion[2] && n.maskRegion[1] <= n.maskRegion[3]))
      return "maskRegion is not a box";
    if (!sane(n.maskTransform) || !invert(n.maskTransform, inverse)) return "maskTransform has no inverse";
  }
  if (n.filtered) {
    if (n.stepCount > GPGP_MAX_FILTER_STEPS) return "the filter has more than 256 steps";
    if (!sane(n.filterRegion) || !(n.filterRegion[0] <= n.filterRegion[2] && n.filterRegion[1] <= n.filterRegion[3]))
      return "filterRegion is not a box";
    if (!sane(n.filterTransform) || !invert(n.filterTransform, inverse)) return "filterTransform has no inverse";
  }
  return nullptr;
}

/// Depth and size of sequences, each worked out once.
class Measure {
public:
  Measure(const LayerPlan& plan, std::pmr::memory_resource* memory)
      : plan_(plan), sequences_(plan.sequences.size(), Size{}, memory), nodes_(plan.nodes.size(), Size{}, memory) {}
  /// Whether the drawing's sequence is within the limits and holds all nodes and all other sequences. Each is then
  /// counted in it at least once, so that kMaxLayerNodes bounds every walk through the plan.
  bool good() {
    Size size;
    const auto done = [](const Size& s) { return s.done; };
    return goodReference(1, 0, size) && std::all_of(sequences_.begin(), sequences_.end(), done) &&
           std::all_of(nodes_.begin(), nodes_.end(), done);
  }

private:
  struct Size {
    uint64_t count = 0;
    uint32_t height = 0;
    uint32_t steps = 0; ///< in each other
    bool open = false, done = false;
  };
  bool good(const LayerSequence& s, uint32_t depth, Size& all) {
    if (depth > GPGP_MAX_LAYER_DEPTH) return false;
    for (const LayerToken& token : plan_.tokensOf(s)) {
      if (++all.count > kMaxLayerNodes) return false;
      if (!token.layer) continue;
      Size& size = nodes_[token.index];
      if (!size.done) {
        if (size.open) return false; // it holds itself
        size.open = true;
        if (!goodNode(plan_.nodes[token.index], depth + 1, size)) return false;
        size.done = true;
      }
      all.count += size.count;
      all.height = std::max(all.height, size.height + 1);
      all.steps = std::max(all.steps, size.steps);
      if (all.count > kMaxLayerNodes || depth + all.height > GPGP_MAX_LAYER_DEPTH) return false;
    }
    return true;
  }
  bool goodNode(const LayerNode& node, uint32_t depth, Size& size) {
    if (!good(node.content, depth, size)) return false;
    if (node.mask && !goodReference(node.mask, depth, size)) return false;
    for (const LayerStep& step : plan_.stepsOf(node)) {
      ++size.count;
      if (step.sequence && !goodReference(step.sequence, depth, size)) return false;
    }
    size.steps += node.stepCount;
    return size.steps <= kMaxNestedSteps;
  }
  bool goodReference(uint32_t sequence, uint32_t depth, Size& size) {
    Size& s = sequences_[sequence - 1];
    if (!s.done) {
      if (s.open) return false;
      s.open = true;
      if (!good(plan_.sequences[sequence - 1], depth, s)) return false;
      s.done = true;
    }
    size.count += s.count;
    size.height = std::max(size.height, s.height);
    size.steps = std::max(size.steps, s.steps);
    return size.count <= kMaxLayerNodes && depth + size.height <= GPGP_MAX_LAYER_DEPTH;
  }
  const LayerPlan& plan_;
  std::pmr::vector<Size> sequences_, nodes_;
};

} // namespace

Box join(const Box& a, const Box& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right), std::max(a.bottom, b.bottom)};
}
Box meet(const Box& a, const Box& b) {
  return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
}
Box grow(const Box& a, float x, float y) {
  if (a.empty()) return a;
  return {a.left - x, a.top - y, a.right + x, a.bottom + y};
}
Box mapped(const Box& a, const float* t) {
  if (a.empty()) return a;
  Box box;
  for (int corner = 0; corner < 4; ++corner) {
    const float x = corner & 1 ? a.right : a.left, y = corner & 2 ? a.bottom : a.top;
    const float u = t[0] * x + t[2] * y + t[4], v = t[1] * x + t[3] * y + t[5];
    box = {std::min(box.left, u), std::min(box.top, v), std::max(box.right, u), std::max(box.bottom, v)};
  }
  return box;
}
bool invert(const float* t, float* inverse) {
  const auto at = [t](int i) { return static_cast<double>(t[i]); };
  const double determinant = at(0) * at(3) - at(1) * at(2);
  if (!(std::abs(determinant) > 1e-30)) return false;
  const auto set = [&](int i, double v) { inverse[i] = static_cast<float>(v / determinant); };
  set(0, at(3)), set(1, -at(1)), set(2, -at(2)), set(3, at(0));
  set(4, at(2) * at(5) - at(3) * at(4)), set(5, at(1) * at(4) - at(0) * at(5));
  return std::all_of(inverse, inverse + 6, [](float v) { return std::isfinite(v); });
}

Result<void> checkLayer(const GpgpLayer& layer, const char* name, uint32_t group, uint32_t groupCount) {
  const auto later = [&](uint32_t reference) { return reference > group + 1 && reference <= groupCount; };
  LayerNode node{};
  node.blend = layer.blend;
  node.opacity = 1;
  node.mask = layer.mask;
  node.maskKind = layer.maskKind;
  node.maskEncoding = layer.maskEncoding;
  std::copy_n(layer.maskRegion, 4, node.maskRegion);
  std::copy_n(layer.maskTransform, 6, node.maskTransform);
  node.filtered = layer.filter != nullptr;
  node.stepCount = layer.filterCount;
  std::copy_n(layer.filterRegion, 4, node.filterRegion);
  std::copy_n(layer.filterTransform, 6, node.filterTransform);
  if (layer.mask && !later(layer.mask))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.mask is %u: no later group", name, layer.mask);
  if (layer.filterCount && !layer.filter)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.filter is NULL, but filterCount is %u", name, layer.filterCount);
  if (const char* wrong = wrongNode(node)) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s: %s", name, wrong);
  for (uint32_t i = 0; i < layer.filterCount; ++i) {
    const GpgpFilterStep& s = layer.filter[i];
    if (s.tableCount && !s.table)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.filter[%u].table is NULL, but tableCount is %u", name, i,
                       s.tableCount);
    if (s.input >= GPGP_FILTER_FIRST_STEP + i || s.input2 >= GPGP_FILTER_FIRST_STEP + i)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.filter[%u]: an input is not an earlier step", name, i);
    if (s.group && !later(s.group))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.filter[%u].group is %u: no later group", name, i, s.group);
    LayerStep step{s.kind, s.mode, s.input, s.input2, s.encoding, {}, {}, 0, s.tableCount, s.group};
    std::copy_n(s.region, 4, step.region);
    std::copy_n(s.values, 20, step.values);
    const char* wrong = wrongStep(step);
    if (!wrong && s.table && !sane({s.table, s.tableCount})) wrong = "table holds a number that is not finite";
    if (wrong) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.filter[%u]: %s", name, i, wrong);
  }
  return {};
}

Result<void> checkPlan(const LayerPlan& plan, size_t paths, std::pmr::memory_resource* memory) {
  const auto bad = [](const char* what) { return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: %s", what); };
  if (plan.empty()) {
    if (!plan.tokens.empty() || !plan.sequences.empty() || !plan.nodes.empty() || !plan.steps.empty() ||
        !plan.tables.empty())
      return bad("there are layers, but no runs");
    return {};
  }
  const auto range = [](uint64_t first, uint64_t count, size_t size) { return first + count <= size; };
  uint64_t next = 0;
  for (const LayerRun& run : plan.runs) { // one after another, so that all paths are in one
    if (run.firstPath != next || !range(run.firstPath, run.pathCount, paths)) return bad("a run is not a run");
    next += run.pathCount;
  }
  if (next != paths || plan.sequences.empty()) return bad("a path is in no run");
  for (const LayerToken& token : plan.tokens)
    if (token.layer > 1 || token.index >= (token.layer ? plan.nodes.size() : plan.runs.size()))
      return bad("a sequence refers to something that does not exist");
  for (const LayerSequence& s : plan.sequences)
    if (!range(s.firstToken, s.tokenCount, plan.tokens.size())) return bad("a sequence is not there");
  uint64_t nextStep = 0;
  for (const LayerNode& n : plan.nodes) { // their steps one after another, so that each is one filter's
    if (!range(n.content.firstToken, n.content.tokenCount, plan.tokens.size()) || n.clip > plan.runs.size() ||
        n.mask > plan.sequences.size() || n.filtered > 1 || !range(n.firstStep, n.stepCount, plan.steps.size()) ||
        (n.stepCount && (!n.filtered || n.firstStep != nextStep)))
      return bad("a layer refers to something that does not exist");
    nextStep += n.stepCount;
    if (wrongNode(n)) return bad("a layer is out of range");
    const auto steps = plan.stepsOf(n);
    for (size_t i = 0; i < steps.size(); ++i) {
      const LayerStep& s = steps[i];
      if (s.input >= GPGP_FILTER_FIRST_STEP + i || s.input2 >= GPGP_FILTER_FIRST_STEP + i ||
          s.sequence > plan.sequences.size() || !range(s.firstEntry, s.entryCount, plan.tables.size()) ||
          s.firstEntry % 4 != 0)
        return bad("a filter refers to something that does not exist");
      if (wrongStep(s)) return bad("a filter's step is out of range");
    }
  }
  if (nextStep != plan.steps.size()) return bad("a step is in no filter");
  if (plan.tables.size() % 4 != 0) return bad("a filter's table has an end that shaders do not read");
  if (!sane(plan.tables)) return bad("a filter's table is not finite");
  if (!Measure(plan, memory).good()) return bad("its layers are nested too deep, too many, or not in it");
  return {};
}

void appendLattice(float seed, std::pmr::vector<float>& to) {
  constexpr int64_t kModulus = 2147483647, kFactor = 16807; // Park and Miller's generator
  int64_t state = static_cast<int64_t>(std::clamp(std::trunc(seed), -2147483647.0f, 2147483520.0f));
  if (state <= 0) state = -(state % (kModulus - 1)) + 1;
  if (state > kModulus - 1) state = kModulus - 1;
  const auto next = [&state] { return state = state * kFactor % kModulus; };
  const size_t first = to.size();
  to.resize(first + kLatticeNumbers, 0.0f);
  for (size_t channel = 0; channel < 4; ++channel)
    for (size_t i = 0; i < 256; ++i) {
      double g[2];
      for (double& v : g) v = static_cast<double>(next() % 512 - 256) / 256;
      const double length = std::hypot(g[0], g[1]);
      for (size_t k = 0; k < 2; ++k)
        to[first + i * 12 + channel * 2 + k] = static_cast<float>(length > 0 ? g[k] / length : 0);
    }
  std::array<int, 256> order;
  for (int i = 0; i < 256; ++i) order[static_cast<size_t>(i)] = i;
  for (size_t i = 255; i > 0; --i) std::swap(order[i], order[static_cast<size_t>(next() % 256)]);
  for (size_t i = 0; i < 256; ++i) to[first + i * 12 + 8] = static_cast<float>(order[i]);
}

// ---------------------------------------------------------------- bounds

namespace {

/// How far beyond a pixel a blur reaches, in standard deviations.
constexpr float kBlurReach = 3.5f;

class BoundsBuilder {
public:
  BoundsBuilder(const LayerPlan& plan, LayerBounds& bounds, std::pmr::memory_resource* memory)
      : plan_(plan), bounds_(bounds), known_(plan.nodes.size(), 0, memory) {}
  Box sequence(const LayerSequence& s) {
    Box box;
    for (const LayerToken& token : plan_.tokensOf(s))
      box = join(box, token.layer ? node(token.index) : bounds_.runs[token.index]);
    return box;
  }

private:
  Box node(uint32_t index) {
    if (known_[index]) return bounds_.nodes[index];
    known_[index] = 1;
    const LayerNode& n = plan_.nodes[index];
    Box box = bounds_.contents[index] = sequence(n.content);
    if (n.filtered) box = filter(n, box);
    if (n.clip) box = meet(box, bounds_.runs[n.clip - 1]);
    if (n.mask) {
      const float* r = n.maskRegion;
      box = meet(box, mapped({r[0], r[1], r[2], r[3]}, n.maskTransform));
      box = meet(box, sequence(plan_.sequences[n.mask - 1]));
    }
    return bounds_.nodes[index] = box;
  }
  Box filter(const LayerNode& n, const Box& content) {
    float inverse[6];
    if (!invert(n.filterTransform, inverse)) return {};
    const float* r = n.filterRegion;
    const Box source = meet(mapped(content, inverse), {r[0], r[1], r[2], r[3]});
    Box last;
    const auto steps = plan_.stepsOf(n);
    for (size_t i = 0; i < steps.size(); ++i) {
      const auto input = [&](uint32_t from) {
        if (from >= GPGP_FILTER_FIRST_STEP) return bounds_.steps[n.firstStep + from - GPGP_FILTER_FIRST_STEP];
        return from == GPGP_FILTER_TRANSPARENT ? Box{} : source;
      };
      const LayerStep& s = steps[i];
      last = meet(step(s, input(s.input), input(s.input2)), {s.region[0], s.region[1], s.region[2], s.region[3]});
      bounds_.steps[n.firstStep + i] = last;
    }
    return mapped(last, n.filterTransform);
  }
  /// Before it is cut to the step's region.
  Box step(const LayerStep& s, const Box& a, const Box& b) {
    static constexpr Box kAll = {-1e9f, -1e9f, 1e9f, 1e9f};
    const float* v = s.values;
    switch (s.kind) {
    case GPGP_FILTER_GAUSSIAN_BLUR: return grow(a, kBlurReach * v[0], kBlurReach * v[1]);
    case GPGP_FILTER_DROP_SHADOW: {
      const float shift[6] = {1, 0, 0, 1, v[2], v[3]};
      return join(a, mapped(grow(a, kBlurReach * v[0], kBlurReach * v[1]), shift));
    }
    case GPGP_FILTER_OFFSET: {
      const float shift[6] = {1, 0, 0, 1, v[0], v[1]};
      return mapped(a, shift);
    }
    case GPGP_FILTER_COLOR_MATRIX: return v[19] > 0 ? kAll : a; // transparent becomes something
    case GPGP_FILTER_COMPONENT_TRANSFER: return plan_.tables[s.firstEntry + 768] > 0 ? kAll : a;
    case GPGP_FILTER_BLEND: return join(a, b);
    case GPGP_FILTER_COMPOSITE:
      switch (s.mode) {
      case GPGP_OPERATOR_IN: return meet(a, b);
      case GPGP_OPERATOR_OUT: return a;
      case GPGP_OPERATOR_ATOP: return b;
      case GPGP_OPERATOR_ARITHMETIC: return v[3] > 0 ? kAll : join(a, b);
      default: return join(a, b);
      }
    case GPGP_FILTER_MORPHOLOGY: return s.mode ? grow(a, v[0] + 1, v[1] + 1) : a;
    case GPGP_FILTER_CONVOLVE_MATRIX:
      return v[5] > 0 ? kAll
                      : grow(a, static_cast<float>(kernelReach(v, 0)) + 1, static_cast<float>(kernelReach(v, 1)) + 1);
    case GPGP_FILTER_DISPLACEMENT_MAP: return grow(a, std::abs(v[0]) / 2 + 1, std::abs(v[0]) / 2 + 1);
    case GPGP_FILTER_TILE: return a.empty() ? a : kAll;
    case GPGP_FILTER_GROUP: return mapped(sequence(plan_.sequences[s.sequence - 1]), v);
    default: return kAll; // floods, noise, light
    }
  }
  const LayerPlan& plan_;
  LayerBounds& bounds_;
  std::pmr::vector<uint8_t> known_;
};

} // namespace

LayerBounds boundsOf(const LayerPlan& plan, std::span<const Box> runs, std::pmr::memory_resource* memory) {
  LayerBounds bounds(memory);
  bounds.runs.assign(runs.begin(), runs.end());
  bounds.contents.resize(plan.nodes.size());
  bounds.nodes.resize(plan.nodes.size());
  bounds.steps.resize(plan.steps.size());
  BoundsBuilder builder(plan, bounds, memory);
  for (const LayerSequence& s : plan.sequences) bounds.sequences.push_back(builder.sequence(s));
  return bounds;
}

} // namespace gpgp::vector
