// A drawing's layers as a plan: which paths are rasterised together, and what is composited with what.
//
// A run is a range of the drawing's paths that the raster draws by itself: its clips' paths, then what it paints. Plain
// groups (clips, opacity) stay inside runs. A sequence lists runs and layers from the bottom up: that of the drawing,
// those of layers, and those of groups that show as masks or in filters. Every reference leads to a sequence that is
// bounded in depth and size, so whoever executes the plan recurses safely.
#pragma once
#include "core/result.h"

#include <gpgp/vector.h>

#include <memory_resource>
#include <span>
#include <vector>

namespace gpgp::vector {

/// Left, top, right, bottom; empty where left >= right.
struct Box {
  float left = 3e38f, top = 3e38f, right = -3e38f, bottom = -3e38f;
  bool empty() const { return !(left < right && top < bottom); }
};
Box join(const Box& a, const Box& b);
Box meet(const Box& a, const Box& b);
Box grow(const Box& a, float x, float y);
/// The box around a box's image: x' = t0 x + t2 y + t4, y' = t1 x + t3 y + t5.
Box mapped(const Box& a, const float* t);
/// False where there is none that float holds.
bool invert(const float* t, float* inverse);

struct LayerRun {
  uint32_t firstPath, pathCount; ///< with its clips' paths
};
struct LayerToken {
  uint32_t layer; ///< 0: a run
  uint32_t index; ///< of a run or a layer
};
struct LayerSequence {
  uint32_t firstToken, tokenCount;
};
struct LayerNode {
  LayerSequence content;
  int32_t blend;
  float opacity;
  uint32_t clip; ///< 1 + index of the run that covers what is shown; 0: none
  uint32_t mask; ///< 1 + index of a sequence; 0: none
  int32_t maskKind, maskEncoding;
  float maskRegion[4], maskTransform[6];
  uint32_t filtered; ///< 1: the result of its steps shows
  uint32_t firstStep, stepCount;
  float filterRegion[4], filterTransform[6];
};
/// As GpgpFilterStep.
struct LayerStep {
  int32_t kind, mode;
  uint32_t input, input2;
  int32_t encoding;
  float region[4], values[20];
  uint32_t firstEntry, entryCount; ///< of the tables
  uint32_t sequence;               ///< 1 + index; 0: none
};
/// A distance of kernels and of lights in filter space, where 0 stands for 1.
inline float distanceOf(float value) { return value == 0 ? 1 : value; }
/// How far a kernel with a step's values reaches along an axis, in filter space.
inline double kernelReach(const float* values, int axis) {
  const float distance = distanceOf(values[7 + axis]);
  return static_cast<double>(values[axis]) * static_cast<double>(distance < 0 ? -distance : distance);
}

struct LayerPlan {
  explicit LayerPlan(std::pmr::memory_resource* memory)
      : runs(memory), tokens(memory), sequences(memory), nodes(memory), steps(memory), tables(memory) {}
  std::pmr::vector<LayerRun> runs; ///< in the order of their paths; none: the drawing has no layers
  std::pmr::vector<LayerToken> tokens;
  std::pmr::vector<LayerSequence> sequences; ///< the first one is the drawing
  std::pmr::vector<LayerNode> nodes;
  std::pmr::vector<LayerStep> steps;
  std::pmr::vector<float> tables; ///< kernels and transfer functions

  bool empty() const { return runs.empty(); }
  std::span<const LayerToken> tokensOf(const LayerSequence& s) const {
    return std::span(tokens).subspan(s.firstToken, s.tokenCount);
  }
  std::span<const LayerStep> stepsOf(const LayerNode& n) const {
    return std::span(steps).subspan(n.firstStep, n.stepCount);
  }
};

constexpr uint32_t kMaxLayerNodes = 65536; ///< of a drawing, counted as often as they are drawn
constexpr uint32_t kMaxNestedSteps = 1024; ///< of filters in each other

/// Checks what GpgpLayer gives; the error begins with `name`.
core::Result<void> checkLayer(const GpgpLayer& layer, const char* name, uint32_t group, uint32_t groupCount);
/// Checks everything that whoever executes the plan trusts: indices, depth, size, finite numbers.
core::Result<void> checkPlan(const LayerPlan& plan, size_t paths, std::pmr::memory_resource* memory);

/// The lattice of the SVG specification's feTurbulence for a seed: for each of its 256 places the gradients of four
/// channels (x, y), the place's number in the permutation, and three zeros. Twelve numbers each.
constexpr size_t kLatticeNumbers = 256 * 12;
void appendLattice(float seed, std::pmr::vector<float>& to);

/// Where things lie, as far as is known without a canvas: in drawing space, of steps in filter space.
struct LayerBounds {
  explicit LayerBounds(std::pmr::memory_resource* memory)
      : runs(memory), sequences(memory), contents(memory), nodes(memory), steps(memory) {}
  std::pmr::vector<Box> runs, sequences, contents, nodes,
      steps; ///< contents: before a layer's filter; nodes: behind it
};
/// `boxes`: of each path; those of clips count only where they are runs of their own.
LayerBounds boundsOf(const LayerPlan& plan, std::span<const Box> runs, std::pmr::memory_resource* memory);

} // namespace gpgp::vector
