// `gpgp visibility --walk`: frames of a viewer who walks and turns, sampled with decisions of the previous frame taken
// over, beside samplings of the same frames that decide all.
#pragma once
#include "cli/visibility/sampled_model.h"

namespace gpgp::cli {

/// What one frame found and cost.
struct WalkFrame {
  double standard = 0, exact = 0, reusing = 0; ///< GPU milliseconds
  uint32_t visible = 0;                        ///< of exact sampling that decides all
  uint32_t late = 0, kept = 0;                 ///< with reuse: missing; too many
  uint32_t decided = 0, decidedPixels = 0;     ///< with reuse
  uint32_t allDecided = 0, allPixels = 0;      ///< without
};

struct WalkFigures {
  std::vector<WalkFrame> frames;

  std::string text() const;
  Json json() const;
};

/// Frame k of a walk from a view: along the viewing direction, turned to the right. A perspective view.
View walkedView(const View& start, const Walk& walk, uint32_t k);

WalkFigures measureWalk(Session& session, SampledModel& scene, VisibilityRecorder& exact, const Walk& walk,
                        const View& view, uint32_t triangles);

} // namespace gpgp::cli
