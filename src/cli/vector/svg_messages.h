// What the compiler says while it reads an SVG or an animation: on standard error for people, and as JSON.
#pragma once
#include "cli/shared/common.h"

#include <gpgp/vector.h>

#include <vector>

namespace gpgp::cli {

class SvgMessages {
public:
  /// Prints no more than `shown`.
  explicit SvgMessages(size_t shown = SIZE_MAX) : shown_(shown) {}
  SvgMessages(const SvgMessages&) = delete; // the source refers to it
  SvgMessages& operator=(const SvgMessages&) = delete;
  template <class Source> void attach(Source& source) {
    source.messageFn = take;
    source.messageUserData = this;
    name_ = source.name;
  }

  /// Prints what is not printed yet. To be called when the source is compiled.
  void finish();
  /// When it failed instead: where and why, as the last message said. That one is left to whoever tells of the failure.
  std::string failure() const;

  size_t count() const { return list_.size(); }
  /// Of what is valid but too much, and was therefore left out.
  size_t refusals() const;
  std::string firstRefusal() const;
  /// Of all messages: severity, element, line, column and text; the file where it is a style sheet. Those of an
  /// animation have their place in the file instead of element, line and column.
  Json json() const;
  /// The same of what is not supported, without severity.
  Json unsupported() const;

private:
  struct Message {
    GpgpSeverity severity;
    GpgpResult code;
    std::string label, text;
  };
  static void GPGP_CALL take(void* userData, const GpgpMessage* message);
  void print();

  size_t shown_, printed_ = 0;
  std::string name_; ///< of the drawing
  std::vector<Message> list_;
};

} // namespace gpgp::cli
