#include "cli/svg_messages.h"

#include <algorithm>
#include <cstdio>

namespace gpgp::cli {
namespace {
/// "file:3:7: warning: <path> has a ..." in parts.
struct Parts {
  std::string place, text;     ///< the place with its file
  size_t line = 0, column = 0; ///< 0: of the whole
};

Parts partsOf(const std::string& message) {
  Parts parts;
  const size_t word = std::min(message.find(": warning: "), message.find(": error: "));
  if (word == message.npos) return {{}, message};
  parts.place = message.substr(0, word);
  parts.text = message.substr(message.find(": ", word + 1) + 2);
  const size_t second = parts.place.rfind(':');
  const size_t first =
      second == parts.place.npos || second == 0 ? std::string::npos : parts.place.rfind(':', second - 1);
  const size_t digits = first == std::string::npos ? 0 : first + 1;
  if (parts.place.substr(digits).find_first_not_of("0123456789:") == std::string::npos && second != parts.place.npos) {
    parts.line = std::strtoul(parts.place.c_str() + digits, nullptr, 10);
    parts.column = std::strtoul(parts.place.c_str() + second + 1, nullptr, 10);
  }
  return parts;
}

/// As an object: the element that is named first is what it is about.
Json part(const std::string& message, const std::string& drawing) {
  const auto [place, text, line, column] = partsOf(message);
  const size_t open = text.find('<'), close = text.find('>', open);
  Json json = {{"element", close != text.npos ? text.substr(open + 1, close - open - 1) : "style"},
               {"line", line ? Json(line) : Json()},
               {"column", column ? Json(column) : Json()},
               {"text", text}};
  if (line && place.substr(0, place.rfind(':', place.rfind(':') - 1)) != drawing) // a style sheet
    json["file"] = place.substr(0, place.rfind(':', place.rfind(':') - 1));
  return json;
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
    if (printed_ < shown_) std::fprintf(stderr, "%s\n", list_[printed_].text.c_str());
}

void SvgMessages::finish() {
  print();
  if (list_.size() > shown_)
    std::fprintf(stderr, "%s: %zu more; --all-warnings shows them\n", label_.c_str(), list_.size() - shown_);
}

std::string SvgMessages::failure() const {
  if (list_.empty()) return {};
  const Parts parts = partsOf(list_.back().text);
  return parts.place.empty() ? label_ + ": " + parts.text : parts.place + ": " + parts.text;
}

Json SvgMessages::json() const {
  Json all = Json::array();
  for (const Message& message : list_) {
    Json one = {{"severity", message.severity == GPGP_SEVERITY_ERROR ? "error" : "warning"}};
    one.update(part(message.text, label_));
    all.push_back(one);
  }
  return all;
}

Json SvgMessages::unsupported() const {
  Json all = Json::array();
  for (const Message& message : list_)
    if (message.code == GPGP_ERROR_UNSUPPORTED) all.push_back(part(message.text, label_));
  return all;
}

} // namespace gpgp::cli
