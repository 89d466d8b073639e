// Messages of one import: each once, with its place, and not without end.
#pragma once
#include <gpgp/core.h>

#include <set>
#include <string>
#include <string_view>

namespace gpgp::vector::svg {

/// A character of a text: its line and its byte in that line, both from 1.
struct Place {
  size_t line = 1, column = 1;
  std::string_view file; ///< empty: the drawing itself; else a file that it refers to
};

/// The place of `text[offset]`, where `start` is that of `text[0]`.
inline Place placeIn(std::string_view text, size_t offset, Place start) {
  for (const char c : text.substr(0, offset)) {
    ++start.column;
    if (c == '\n') ++start.line, start.column = 1;
  }
  return start;
}

class Reporter {
public:
  Reporter(GpgpMessageFn function, void* userData, const char* name)
      : function_(function), userData_(userData), name_(name ? name : "") {}

  /// The label is the place, "file:line:column". The same text for the same place is given once.
  /// For what the importer cannot do.
  void warn(const Place& place, const std::string& text) {
    say(GPGP_SEVERITY_WARNING, GPGP_ERROR_UNSUPPORTED, place, text);
  }
  /// For what says nothing, or nothing valid, and is ignored as the standards ask.
  void ignored(const Place& place, const std::string& text) {
    say(GPGP_SEVERITY_WARNING, GPGP_ERROR_INVALID_DATA, place, text);
  }
  void error(const Place& place, const std::string& text, GpgpResult code = GPGP_ERROR_INVALID_DATA) {
    say(GPGP_SEVERITY_ERROR, code, place, text);
  }
  const std::string& name() const { return name_; } ///< the drawing's file

  /// About the whole, or with its "line:column: " at the front.
  void error(const std::string& text, GpgpResult code) {
    const size_t digits = text.find_first_not_of("0123456789:");
    const bool placed = digits != text.npos && digits > 1 && text.substr(digits - 1, 2) == ": ";
    const std::string place = placed ? labelOf(name_, text.substr(0, digits - 1)) : name_;
    call(GPGP_SEVERITY_ERROR, code, place, text.substr(placed ? digits + 1 : 0));
  }

private:
  static constexpr size_t kMaxMessages = 1000;

  static std::string labelOf(std::string_view file, const std::string& place) {
    return file.empty() ? place : std::string(file) + ":" + place;
  }
  void say(GpgpSeverity severity, GpgpResult code, const Place& place, const std::string& text) {
    if (said_.size() > kMaxMessages) return;
    const std::string label = labelOf(place.file.empty() ? std::string_view(name_) : place.file,
                                      std::to_string(place.line) + ":" + std::to_string(place.column));
    if (!said_.insert(label + ": " + text).second) return;
    if (said_.size() > kMaxMessages)
      return call(severity, code, name_, "more than 1000 messages; the rest are left out");
    call(severity, code, label, text);
  }
  void call(GpgpSeverity severity, GpgpResult code, const std::string& label, const std::string& text) {
    const GpgpMessage message{severity, code, "gpgpCompileSvg", label.c_str(), text.c_str()};
    if (function_) function_(userData_, &message);
  }

  GpgpMessageFn function_;
  void* userData_;
  std::string name_;
  std::set<std::string> said_;
};

} // namespace gpgp::vector::svg
