// `gpgp visibility --motion`: a viewer who walks along the view and turns while the result is on its way.
#pragma once
#include "cli/visibility/reference.h"

#include <optional>

namespace gpgp::cli {

/// The cameras that gpgp chooses for it, and their viewport.
struct MotionCell {
  GpgpViewMotionInfo info = GPGP_VIEW_MOTION_INFO_INIT;
  GpgpViewMotionCoverage coverage{};
  std::vector<View> views;

  MotionCell(const Motion& motion, float eyes, const View& view, Size viewport);
  Size sizeOf(size_t view) const {
    return view ? Size{coverage.cornerWidth, coverage.cornerHeight} : Size{coverage.width, coverage.height};
  }
  /// An eye of the moving viewer, at some time: the first are at the ends of the walk, fully turned.
  View viewer(uint32_t k) const;
};

/// How much of what viewers see in motion was found.
struct MotionFigures {
  uint32_t viewers = 0, cameras = 0;
  Size size;
  double mean = 0, worst = 1;     ///< share of the triangles that a viewer sees, over the viewers
  double meanArea = 0;            ///< by area
  double oneViewMilliseconds = 0; ///< of one exact recording in the viewer's viewport

  std::string text(double cellMilliseconds) const;
  Json json() const;
};

/// Samples what `options.viewers` of them see and compares.
MotionFigures measureMotion(SampledModel& scene, VisibilityRecorder& recorder, const VisibilityOptions& options,
                            const Model& model, const MotionCell& cell, const View& view,
                            const std::vector<uint32_t>& found);

} // namespace gpgp::cli
