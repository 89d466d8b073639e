// The walk through compositions and layers of a frame.
#pragma once
#include "vector/geometry/stroke.h"
#include "vector/import/lottie/evaluate.h"
#include "vector/import/lottie/shapes.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector::lottie {

/// Where something is drawn: the group around it, and how many of a kind are around that.
struct Scope {
  uint32_t group = 0; ///< 1 + index
  uint32_t clips = 0, effects = 0, depth = 0;
};

struct Paint {
  float color[4] = {};
  std::shared_ptr<const svg::Gradient> gradient;
  std::shared_ptr<const GpgpImagePaint> image;
  GpgpFillRule rule = GPGP_FILL_NON_ZERO;
};

class Evaluator {
public:
  Evaluator(const Animation& animation, const EvaluateInfo& info, Reporter& reporter)
      : animation_(animation), info_(info), reporter_(reporter), limits_(info.limits) {}
  svg::Imported run(double frame);

private:
  using Kept = std::shared_ptr<svg::ImportedLayer>;

  // evaluate.cpp
  void composition(size_t index, double frame, const Affine& outer, const Scope& scope);
  void layer(const Composition& composition, size_t index, double frame, const Affine& outer, const Scope& scope);
  void content(const Layer& layer, double frame, const Affine& map, const Scope& scope);
  void precomp(const Layer& layer, double frame, const Affine& map, Scope scope);
  void emit(const Shape& shape, const Affine& map, const Paint& paint, double opacity, const Scope& scope);
  bool spend(size_t points);
  void limited(const char* what);
  /// A new group inside of the scope's.
  uint32_t open(Scope& scope);
  /// What is drawn by `show` belongs to a group of its own without a parent. 0 where it is nothing.
  template <class Show> uint32_t aside(const Scope& scope, Show&& show);
  struct Mark {
    size_t paths, groups, aside;
  };
  Mark mark() const { return {result_.paths.size(), result_.groups.size(), aside_.size()}; }
  void undo(const Mark& mark);

  // paints.cpp
  void shapes(const std::vector<ShapeItem>& items, double frame, const Affine& map, const Scope& scope);
  void nodes(const PaintTree& tree, const std::vector<PaintNode>& nodes, double frame, const Affine& map,
             const Scope& scope);
  void paint(const PaintTree& tree, const PaintNode& node, double frame, const Affine& map, const Scope& scope);
  std::shared_ptr<const svg::Gradient> gradient(const Gradient& gradient, double frame, const Affine& map);
  void text(const Layer& layer, double frame, const Affine& map, const Scope& scope);
  void stroke(const Shape& shape, const StrokeStyle& style, const Affine& map, const Paint& paint, double opacity,
              const Scope& scope);

  // effects.cpp
  Kept keptLayer() const;
  GpgpFilterStep step(GpgpFilterKind kind, std::initializer_list<double> values, const Affine& map) const;
  void setFilter(svg::ImportedLayer& layer, const Affine& map, std::vector<GpgpFilterStep> steps) const;
  /// The effects of a layer; null where there are none.
  Kept effects(const Layer& layer, double frame, const Affine& map);
  /// The region of the page in the space that a map leads from, somewhat larger.
  void region(const Affine& map, float (&box)[4]) const;
  struct MaskNow {
    char mode;
    bool inverted;
    double opacity, sigmaX, sigmaY;
    Shape shape;
    bool simple() const { return !inverted && opacity >= 1 && sigmaX == 0 && sigmaY == 0; }
  };
  std::vector<MaskNow> masksOf(const Layer& layer, double frame, const Affine& map);
  struct Wrap { ///< a group around a layer's content
    uint32_t group;
    size_t count;                    ///< of masks that it takes from the front
    bool isClip, isInverse, isWhole; ///< isWhole: the masks together, otherwise the last of them alone
  };
  void openMasks(const std::vector<MaskNow>& masks, Scope& scope, std::vector<Wrap>& wraps);
  /// False where nothing remains to be shown.
  bool closeMasks(const std::vector<MaskNow>& masks, const Affine& map, const Scope& scope,
                  const std::vector<Wrap>& wraps);
  void paintMasks(const std::vector<MaskNow>& masks, size_t count, const Affine& map, const Scope& scope);
  void paintMask(const MaskNow& mask, bool inverse, const Affine& map, const Scope& scope);
  /// More than the page: in linear grey.
  void paintPage(float grey, double opacity, const Scope& scope);
  svg::ImportedPath pathOf(const Shape& shape) const;
  uint32_t matte(const Composition& composition, const Layer& layer, double frame, const Affine& outer,
                 const Scope& scope, bool& all);

  const Animation& animation_;
  const EvaluateInfo& info_;
  Reporter& reporter_;
  const EvaluateLimits& limits_;
  svg::Imported result_;
  std::vector<svg::ImportedPath> aside_;
  size_t visited_ = 0, points_ = 0;
  bool stopped_ = false;
};

inline Affine inverseOf(const Affine& m) {
  const double d = m.a * m.d - m.b * m.c;
  return {m.d / d, -m.b / d, -m.c / d, m.a / d, (m.c * m.f - m.d * m.e) / d, (m.b * m.e - m.a * m.f) / d};
}
/// Whether a filter or mask can work in its space: its numbers and its inverse's are within what layers hold.
inline bool isUsable(const Affine& m) {
  const double d = m.a * m.d - m.b * m.c;
  if (!(std::fabs(d) > 1e-12)) return false;
  const Affine back = inverseOf(m);
  for (const Affine& map : {m, back})
    for (const double v : {map.a, map.b, map.c, map.d, map.e, map.f})
      if (!(std::fabs(v) <= 1e6)) return false;
  return true;
}
inline float linearOf(double srgb) {
  const double c = std::clamp(srgb, 0.0, 1.0);
  return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

template <class Show> uint32_t Evaluator::aside(const Scope& scope, Show&& show) {
  const Mark before = mark();
  result_.groups.push_back({});
  Scope inner = scope;
  inner.group = static_cast<uint32_t>(result_.groups.size());
  inner.clips = 0;
  ++inner.effects;
  std::vector<svg::ImportedPath> paths;
  std::swap(paths, result_.paths);
  show(inner);
  std::swap(paths, result_.paths);
  if (paths.empty()) {
    undo(before);
    return 0;
  }
  aside_.insert(aside_.end(), std::make_move_iterator(paths.begin()), std::make_move_iterator(paths.end()));
  return inner.group;
}

} // namespace gpgp::vector::lottie
