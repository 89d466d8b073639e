// Messages of one import: each once, with its line, and not without end.
#pragma once
#include <gpgp/core.h>

#include <set>
#include <string>

namespace gpgp::vector::svg {

class Reporter {
public:
  Reporter(GpgpMessageFn function, void* userData, const char* name)
      : function_(function), userData_(userData), name_(name ? name : "") {}

  /// "line 3: text". The same text for the same line is given once.
  /// For what the importer cannot do.
  void warn(size_t line, const std::string& text) { say(GPGP_SEVERITY_WARNING, GPGP_ERROR_UNSUPPORTED, line, text); }
  /// For what says nothing, or nothing valid, and is ignored as the standards ask.
  void ignored(size_t line, const std::string& text) {
    say(GPGP_SEVERITY_WARNING, GPGP_ERROR_INVALID_DATA, line, text);
  }
  void error(size_t line, const std::string& text, GpgpResult code = GPGP_ERROR_INVALID_DATA) {
    say(GPGP_SEVERITY_ERROR, code, line, text);
  }
  /// Without a line.
  void error(const std::string& text, GpgpResult code) { call(GPGP_SEVERITY_ERROR, code, text.c_str()); }

private:
  static constexpr size_t kMaxMessages = 1000;

  void say(GpgpSeverity severity, GpgpResult code, size_t line, const std::string& text) {
    if (said_.size() > kMaxMessages) return;
    const std::string whole = std::string("line ") + std::to_string(line) + ": " + text;
    if (!said_.insert(whole).second) return;
    call(severity, code,
         said_.size() > kMaxMessages ? "more than 1000 messages; the rest are left out" : whole.c_str());
  }
  void call(GpgpSeverity severity, GpgpResult code, const char* text) {
    const GpgpMessage message{severity, code, "gpgpCompileSvg", name_, text};
    if (function_) function_(userData_, &message);
  }

  GpgpMessageFn function_;
  void* userData_;
  const char* name_;
  std::set<std::string> said_;
};

} // namespace gpgp::vector::svg
