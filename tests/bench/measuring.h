// What every benchmark needs: medians, milliseconds, and an end where a call fails.
#pragma once
#include <gpgp/core.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace gpgp::bench {
using Clock = std::chrono::steady_clock;

inline double milliseconds(Clock::duration d) { return std::chrono::duration<double, std::milli>(d).count(); }

/// 0 of nothing.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

inline void expect(GpgpResult result, const char* what) {
  if (result == GPGP_SUCCESS) return;
  std::fprintf(stderr, "%s: %s\n", what, gpgpResultString(result));
  std::exit(1);
}

} // namespace gpgp::bench
