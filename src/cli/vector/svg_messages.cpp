#include "cli/vector/svg_messages.h"
#include "cli/shared/command.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace gpgp::cli {
namespace {
/// A message as an object: the element that is named first is what it is about; its label is "file:line:column".
Json part(const std::string& label, const std::string& text, const std::string& drawing) {
  if (label.starts_with(drawing + ": ")) return {{"place", label.substr(drawing.size() + 2)}, {"text", text}};
  const size_t open = text.find('<'), close = text.find('>', open);
  Json json = {{"element", close != text.npos ? text.substr(open + 1, close - open - 1) : "style"},
               {"line", Json()},
               {"column", Json()},
               {"text", text}};
  const size_t second = label.rfind(':'),
               first = second == label.npos || !second ? label.npos : label.rfind(':', second - 1);
  if (label == drawing || first == label.npos) return json; // of the whole
  json["line"] = std::strtoul(label.c_str() + first + 1, nullptr, 10);
  json["column"] = std::strtoul(label.c_str() + second + 1, nullptr, 10);
  if (label.substr(0, first) != drawing) json["file"] = label.substr(0, first); // a style sheet
  return json;
}
bool isRefusal(GpgpSeverity severity, GpgpResult code) {
  return severity == GPGP_SEVERITY_ERROR && code == GPGP_ERROR_UNSUPPORTED;
}
const char* wordOf(GpgpSeverity severity) { return severity == GPGP_SEVERITY_ERROR ? "error" : "warning"; }
} // namespace

void SvgMessages::take(void* userData, const GpgpMessage* message) {
  auto& messages = *static_cast<SvgMessages*>(userData);
  messages.print(); // the last one waits, as it may tell of a failure
  messages.list_.push_back({message->severity, message->code, message->label, message->text});
}

void SvgMessages::print() {
  for (; printed_ < list_.size(); ++printed_)
    if (const Message& m = list_[printed_]; printed_ < shown_)
      std::fprintf(stderr, "%s: %s: %s\n", m.label.c_str(), wordOf(m.severity), m.text.c_str());
}

void SvgMessages::finish() {
  print();
  if (list_.size() > shown_)
    std::fprintf(stderr, "%s: %zu more; --all-warnings shows them\n", name_.c_str(), list_.size() - shown_);
}

std::string SvgMessages::failure() const {
  return list_.empty() ? std::string() : list_.back().label + ": " + list_.back().text;
}

size_t SvgMessages::refusals() const {
  return static_cast<size_t>(
      std::count_if(list_.begin(), list_.end(), [](const Message& m) { return isRefusal(m.severity, m.code); }));
}

std::string SvgMessages::firstRefusal() const {
  for (const Message& m : list_)
    if (isRefusal(m.severity, m.code)) return m.label + ": " + m.text;
  return {};
}

Json SvgMessages::json() const {
  Json all = Json::array();
  for (const Message& message : list_) {
    Json one = {{"severity", wordOf(message.severity)}};
    one.update(part(message.label, message.text, name_));
    all.push_back(one);
  }
  return all;
}

Json SvgMessages::unsupported() const {
  Json all = Json::array();
  for (const Message& message : list_)
    if (message.code == GPGP_ERROR_UNSUPPORTED) all.push_back(part(message.label, message.text, name_));
  return all;
}

} // namespace gpgp::cli
