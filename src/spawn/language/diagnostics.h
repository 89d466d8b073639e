// Messages of the grammar compiler: all of them, each with its place.
#pragma once
#include <gpgp/spawn.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace gpgp::spawn {

struct Place {
  uint32_t line = 0, column = 0; ///< from 1; columns count bytes. 0: the grammar as a whole, no place in its text
};

struct Diagnostic {
  Place place;
  GpgpSeverity severity = GPGP_SEVERITY_ERROR;
  std::string text;
  uint32_t omitted = 0; ///< how many more of its severity there were, where text says that
};

class Diagnostics {
public:
  static constexpr uint32_t kLimit = 1000; ///< of each severity; further messages would only be noise

  void error(Place place, std::string text) { add(place, GPGP_SEVERITY_ERROR, std::move(text)); }
  void warning(Place place, std::string text) { add(place, GPGP_SEVERITY_WARNING, std::move(text)); }
  void info(Place place, std::string text) { add(place, GPGP_SEVERITY_INFO, std::move(text)); }
  bool hasErrors() const { return errorCount() > 0; }
  /// Whether one more error is kept: what only words it better need not be worked out otherwise.
  bool takesErrors() const { return errorCount() < kLimit; }
  size_t errorCount() const { return counts_[GPGP_SEVERITY_ERROR]; }
  /// Names a place of what is no text: messages then call it by that name.
  void name(Place place, std::string text) { names_[{place.line, place.column}] = std::move(text); }
  /// The name of a place, else "line 3".
  std::string where(Place place) const;
  bool isNamed(Place place) const { return names_.count({place.line, place.column}) != 0; }
  /// In the order of places; behind them how many were left out.
  std::vector<Diagnostic> sorted() const;

private:
  void add(Place place, GpgpSeverity severity, std::string text) {
    if (counts_[severity]++ < kLimit) all_.push_back({place, severity, std::move(text)});
  }
  std::vector<Diagnostic> all_;
  std::map<std::pair<uint32_t, uint32_t>, std::string> names_;
  uint32_t counts_[GPGP_SEVERITY_ERROR + 1] = {}; ///< by severity, those that were left out as well
};

/// file:line:column: error: text, or file: error: text
std::string format(const Diagnostic& diagnostic, const std::string& file);

} // namespace gpgp::spawn
