// What RmlUi draws in a frame, as values: its calls are immediate and name layers, lists nest. Needs no RmlUi.
//
// A layer's contents are a sequence of operations that only grows; CompositeLayers appends an operation that refers to
// the contents of the source as they are at that time. So a layer that is composited twice, or onto several others, is
// nothing special. writer.h makes a list of it.
#pragma once
#include "shapes.h"

#include <gpgp/gpgp.hpp>

#include <memory>
#include <string>

namespace gpgp::integration {
struct Texture;
}

namespace gpgp::rmlui {

/// A map of the plane, as gpgpPushTransform takes it. Null pointers are the identity.
struct Transform {
  std::array<float, 6> map{1, 0, 0, 1, 0, 0};
  std::array<float, 3> perspective{0, 0, 1};
  bool projective() const { return perspective[0] != 0 || perspective[1] != 0 || perspective[2] != 1; }
  bool operator==(const Transform&) const = default;
};
using TransformPointer = std::shared_ptr<const Transform>;
bool same(const TransformPointer& a, const TransformPointer& b);

enum class ClipOperation { set, setInverse, intersect };

struct ClipStep {
  ClipOperation operation = ClipOperation::set;
  GeometryPointer geometry;
  float x = 0, y = 0; ///< translation, before the transform
  TransformPointer transform;
};
/// Steps one after the other. Null: nothing is clipped.
using ClipMask = std::shared_ptr<const std::vector<ClipStep>>;

/// What cuts and moves an operation.
struct State {
  std::optional<Box> scissor;
  ClipMask clip;
  TransformPointer transform; ///< of geometry alone
};

/// An image that geometry is painted with; whoever draws the list knows what it is.
using integration::Texture;
using TexturePointer = std::shared_ptr<Texture>;

/// Colours and positions as RmlUi gives them; premultiplied, sRGB.
struct Gradient {
  enum class Kind { linear, radial, conic };
  struct Stop {
    float position = 0;
    std::array<float, 4> color{};
  };
  Kind kind = Kind::linear;
  bool repeating = false;
  std::array<float, 2> start{};  ///< linear: where it begins; otherwise the centre
  std::array<float, 2> extent{}; ///< linear: from there to its end; radial: radii
  float angle = 0;               ///< conic: radians, clockwise from the top
  std::vector<Stop> stops;
};

/// Text whose glyphs are the geometry (text_mesh.h), and what is made of them. Lengths are pixels.
struct TextStyle {
  float stroke = 0; ///< widens glyphs by so much on all sides
  float blur = 0;   ///< standard deviation
};

/// Null pointers: the colours of the vertices alone.
struct Paint {
  enum class Kind { image, gradient, text, drawing };
  Kind kind = Kind::image;
  TexturePointer texture;
  Gradient gradient;
  TextStyle text;
  Drawing drawing; ///< in place of an image: its page is the image
};
using PaintPointer = std::shared_ptr<const Paint>;

struct Operation;
/// The first `count` operations of a layer. Layers only grow: this does not change.
struct Contents {
  std::shared_ptr<const std::vector<Operation>> operations;
  size_t count = 0;
};

/// One filter of RmlUi's.
struct Filter {
  enum class Kind { steps, opacity, mask };
  Kind kind = Kind::steps;
  GpgpFilterStep step{}; ///< its kind and values; inputs and region come where it is applied
  float opacity = 1;
  Contents mask;
};
using FilterPointer = std::shared_ptr<const Filter>;

/// Geometry, or (without geometry) a layer composited onto this one.
struct Operation {
  State state;
  GeometryPointer geometry;
  float x = 0, y = 0; ///< translation, before the transform
  PaintPointer paint;
  Contents source;
  std::vector<FilterPointer> filters;
};

/// Takes RmlUi's calls. Layer 0 is the base.
class CallRecorder {
public:
  /// Empties all layers but the base, which becomes empty; resets the state.
  void begin();

  void setScissor(std::optional<Box> scissor) { state_.scissor = scissor; }
  void setTransform(const Transform* transform); ///< null: the identity
  void enableClip(bool enable);
  void clip(ClipOperation operation, GeometryPointer geometry, float x, float y);
  const State& state() const { return state_; }

  void draw(GeometryPointer geometry, float x, float y, PaintPointer paint);
  size_t pushLayer();
  /// False: there is no such layer, or it replaces what lies under a clip mask, which is done without the mask.
  bool composite(size_t source, size_t destination, bool replace, std::vector<FilterPointer> filters);
  bool popLayer(); ///< false: only the base is left

  /// The top layer, cut to the scissor.
  Contents top() const;
  Contents base() const { return contents(0); }

private:
  Contents contents(size_t layer) const { return {layers_[layer], layers_[layer]->size()}; }
  std::vector<std::shared_ptr<std::vector<Operation>>> layers_;
  State state_;
  ClipMask clip_; ///< also while it is not enabled
};

} // namespace gpgp::rmlui
