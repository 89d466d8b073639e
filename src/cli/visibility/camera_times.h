// GPU times of one camera, or of several: of a view the median of its repeats, of a cell the sum over its views, of
// several cameras the median over them. So is each number here.
#pragma once
#include "cli/shared/session.h"

namespace gpgp::cli {

struct CameraTimes {
  size_t repeats = 0;                                 ///< of each view
  double median = 0, least = 0;                       ///< milliseconds of whole recordings
  std::vector<std::pair<std::string, double>> passes; ///< in the order of their recordings

  /// A view of the camera's cell, of the same passes.
  void add(const GpuTimes& view);
  Json json() const;
  /// Passes of one name added up.
  Json passesByName() const;
};

CameraTimes medianOf(const std::vector<CameraTimes>& cameras);

} // namespace gpgp::cli
