#include "spawn/cga/strings.h"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace gpgp::spawn::cga {

StringTable::StringTable(const std::vector<std::string>& constants) : constants_(constants) {
  for (size_t i = 0; i < constants.size(); ++i) constantNumbers_.try_emplace(constants[i], static_cast<uint32_t>(i));
}

uint32_t StringTable::number(std::string_view text) {
  if (const auto found = constantNumbers_.find(text); found != constantNumbers_.end()) return found->second;
  const auto [found, isNew] =
      numbers_.try_emplace(std::string(text), static_cast<uint32_t>(constants_.size() + texts_.size()));
  if (isNew) {
    texts_.push_back(&found->first); // nodes stay where they are
    bytes_ += text.size() + 64;
  }
  return found->second;
}

const std::string& StringTable::text(uint32_t number) const {
  static const std::string none;
  if (number < constants_.size()) return constants_[number];
  const size_t at = number - constants_.size();
  return at < texts_.size() ? *texts_[at] : none;
}

void StringTable::clear() {
  numbers_.clear();
  texts_.clear();
  bytes_ = 0;
}

std::string textOf(float number) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", static_cast<double>(number));
  return text;
}

float numberOf(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '+' || text.front() == '\t')) text.remove_prefix(1);
  float value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  (void)end;
  return error == std::errc() && std::isfinite(value) ? value : 0.0f;
}

} // namespace gpgp::spawn::cga
