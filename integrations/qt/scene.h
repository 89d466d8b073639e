// What the samples of gpgp::qt show and their test compares: an SVG, shapes that move, and a line of text.
#pragma once
#include "text_line.h"

#include <vector>

namespace gpgp::sample {

class Scene {
public:
  Scene(GpgpContext context, const Options& options);

  /// Items for a canvas of this size in pixels, at a time of the animation, 0 to 1.
  void fill(float time, float width, float height, std::vector<GpgpCanvasItem>& items);

private:
  Drawing drawing_;
  GpgpDrawingInfo drawingInfo_ = GPGP_DRAWING_INFO_INIT;
  List shapes_;
  TextLine line_;
};

} // namespace gpgp::sample
