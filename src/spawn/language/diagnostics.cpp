#include "spawn/language/diagnostics.h"

#include <algorithm>
#include <tuple>

namespace gpgp::spawn {

std::string Diagnostics::where(Place place) const {
  const auto named = names_.find({place.line, place.column});
  return named != names_.end() ? named->second : "line " + std::to_string(place.line);
}

std::vector<Diagnostic> Diagnostics::sorted() const {
  std::vector<Diagnostic> result = all_;
  std::stable_sort(result.begin(), result.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::tie(a.place.line, a.place.column) < std::tie(b.place.line, b.place.column);
  });
  constexpr const char* kNouns[] = {"note", "warning", "error"};
  for (GpgpSeverity severity = GPGP_SEVERITY_ERROR; severity >= GPGP_SEVERITY_INFO; --severity) {
    const uint32_t omitted = counts_[severity] - std::min(counts_[severity], kLimit);
    if (omitted)
      result.push_back(
          {{},
           severity,
           std::to_string(omitted) + " more " + kNouns[severity] + (omitted == 1 ? " is" : "s are") + " left out",
           omitted});
  }
  return result;
}

std::string format(const Diagnostic& diagnostic, const std::string& file) {
  const auto& [line, column] = diagnostic.place;
  std::string place;
  if (line) place.append(":").append(std::to_string(line)).append(":").append(std::to_string(column));
  return file + place +
         (diagnostic.severity == GPGP_SEVERITY_ERROR     ? ": error: "
          : diagnostic.severity == GPGP_SEVERITY_WARNING ? ": warning: "
                                                         : ": note: ") +
         diagnostic.text;
}

} // namespace gpgp::spawn
