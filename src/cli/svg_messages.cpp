#include "cli/svg_messages.h"

#include <cstdio>

namespace gpgp::cli {
namespace {
/// "line 3: <path> has a ..." as an object: what is named first is what it is about.
Json part(const std::string& text) {
  const size_t colon = text.find(": "), open = text.find('<'), close = text.find('>', open);
  const bool hasLine = text.rfind("line ", 0) == 0 && colon != text.npos;
  return {{"element", close != text.npos ? text.substr(open + 1, close - open - 1) : "style"},
          {"line", hasLine ? Json(std::strtoul(text.c_str() + 5, nullptr, 10)) : Json()},
          {"text", hasLine ? text.substr(colon + 2) : text}};
}
} // namespace

void SvgMessages::attach(GpgpSvgSource& source) {
  source.messageFn = take;
  source.messageUserData = this;
}

void SvgMessages::take(void* userData, const GpgpMessage* message) {
  auto& messages = *static_cast<SvgMessages*>(userData);
  messages.print(); // the last one waits, as it may tell of a failure
  messages.label_ = message->label;
  messages.list_.push_back({message->severity, message->code, message->text});
}

void SvgMessages::print() {
  for (; printed_ < list_.size(); ++printed_)
    if (printed_ < shown_) std::fprintf(stderr, "%s: %s\n", label_.c_str(), list_[printed_].text.c_str());
}

void SvgMessages::finish() {
  print();
  if (list_.size() > shown_)
    std::fprintf(stderr, "%s: %zu more; --all-warnings shows them\n", label_.c_str(), list_.size() - shown_);
}

std::string SvgMessages::failure() const { return list_.empty() ? std::string() : list_.back().text; }

Json SvgMessages::json() const {
  Json all = Json::array();
  for (const Message& message : list_) {
    Json one = {{"severity", message.severity == GPGP_SEVERITY_ERROR ? "error" : "warning"}};
    one.update(part(message.text));
    all.push_back(one);
  }
  return all;
}

Json SvgMessages::unsupported() const {
  Json all = Json::array();
  for (const Message& message : list_)
    if (message.code == GPGP_ERROR_UNSUPPORTED) all.push_back(part(message.text));
  return all;
}

} // namespace gpgp::cli
