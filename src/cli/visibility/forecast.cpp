#include "cli/visibility/forecast.h"

#include "cli/shared/progress.h"

namespace gpgp::cli {

std::string forecast(double seconds, uint32_t samples, bool again) {
  if (seconds < 60) return {};
  const std::string finely = std::to_string(samples) + " x " + std::to_string(samples);
  return "gpgp visibility: note: " +
         (again ? "sampling false positives again at " + finely + " takes about " + durationText(seconds) +
                      "; --recheck 0 leaves it out, a smaller --recheck or --size takes less\n"
                : "the reference of " + finely + " samples takes about " + durationText(seconds) +
                      "; a smaller --reference or --size takes less\n");
}

} // namespace gpgp::cli
