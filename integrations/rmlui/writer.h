// Makes a list of what a frame's CallRecorder holds: layers nest, clip masks are clips or masks, filters are steps.
#pragma once
#include "frame.h"

namespace gpgp::rmlui {

/// What the writer asks of whoever keeps images and glyphs.
class Painter {
public:
  virtual ~Painter() = default;
  /// The image's number among those of the recording.
  virtual uint32_t image(const Texture& texture) = 0;
  /// Adds a text in the list's present space.
  virtual GpgpResult text(List& list, const Geometry& geometry, float x, float y, const TextStyle& style) = 0;
  /// Something is left out or drawn otherwise. `what` is a literal.
  virtual void unsupported(const char* what) = 0;
};

class Writer {
public:
  /// What layers write is at most `limit` operations, as a layer that is composited twice is written twice.
  Writer(List& list, Painter& painter, uint32_t limit = 1u << 18) : list_(list), painter_(painter), left_(limit) {}

  /// Appends them, cut to a box, in the list's present space. Errors are the list's, or UNSUPPORTED: beyond the limit.
  GpgpResult write(const Contents& contents, const Box& canvas);

private:
  /// What is pushed for operations of one state.
  struct Entered {
    State state;
    bool inTransform = false; ///< the space is the state's transform, as clips lie in it
    uint32_t pushes = 0;
    bool valid = false;
    bool hidden = false; ///< nothing shows
  };
  /// Filters that one layer does, in the order: steps, mask, opacity.
  struct Stage {
    std::vector<GpgpFilterStep> steps;
    const Contents* mask = nullptr;
    float opacity = 1;
    bool closed = false; ///< later filters need a layer around
  };

  void did(GpgpResult result) {
    if (result < 0 && error_ >= 0) error_ = result;
  }
  void pop(uint32_t& pushes);
  void contents(const Contents& contents);
  bool enter(const State& state);
  void leave();
  uint32_t maskOf(const ClipStep& step);
  void pushLayer(GpgpListLayer& layer);
  void pushTransform(const Transform& transform);
  void geometry(const Operation& operation);
  void triangles(const Geometry& geometry, float x, float y, const Texture* texture);
  void gradient(const Operation& operation);
  void fillGradient(const Gradient& gradient, const Box& box, const std::array<float, 4>& radii, float x, float y,
                    float alpha);
  void fillConic(const Gradient& gradient, const Box& box, float x, float y, float alpha);
  void text(const Operation& operation);
  void drawing(const Operation& operation);
  void composite(const Operation& operation);
  bool backdrop(const Contents& contents, size_t index);
  std::vector<Stage> stagesOf(const std::vector<FilterPointer>& filters) const;
  void finishSteps(std::vector<GpgpFilterStep>& steps) const;
  Box visible(const State& state) const { return state.scissor ? meet(canvas_, *state.scissor) : canvas_; }

  List& list_;
  Painter& painter_;
  uint32_t left_;
  Box canvas_{};
  Entered entered_;
  GpgpResult error_ = GPGP_SUCCESS;
};

/// A gradient's colour at a position: premultiplied, sRGB, between stops as RmlUi's renderers mix it (smoothstep).
std::array<float, 4> colorAt(const Gradient& gradient, float position);

} // namespace gpgp::rmlui
