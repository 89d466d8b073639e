// The middle of measured times.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace gpgp::cli {

/// Of an even number the mean of both in the middle; of none 0.
inline double medianOf(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return (values[(values.size() - 1) / 2] + values[values.size() / 2]) * 0.5;
}

} // namespace gpgp::cli
