#include "live_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>

namespace mini {

std::optional<std::string> readText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
}

std::string lineOf(const std::string& text, uint32_t line) {
  std::istringstream lines(text);
  std::string found;
  for (uint32_t i = 0; i < line; ++i)
    if (!std::getline(lines, found)) return {};
  return found;
}

std::string LiveAttribute::text() const {
  char text[32] = {};
  switch (kind) {
  case boolean: return value != 0 ? "true" : "false";
  case choice: return choices[static_cast<size_t>(value)];
  case colour: {
    const auto byte = [](float v) { return static_cast<unsigned>(std::clamp(v, 0.0f, 1.0f) * 255 + 0.5f); };
    std::snprintf(text, sizeof text, "#%02x%02x%02x", byte(rgb[0]), byte(rgb[1]), byte(rgb[2]));
    return text;
  }
  case number: break;
  }
  std::snprintf(text, sizeof text, "%.9g", static_cast<double>(value));
  return text;
}

bool LiveAttribute::parse(const std::string& text) {
  switch (kind) {
  case boolean:
    if (text != "true" && text != "false") return false;
    value = text == "true" ? 1.0f : 0.0f;
    return true;
  case choice: {
    const auto found = std::find(choices.begin(), choices.end(), text);
    if (found == choices.end()) return false;
    value = static_cast<float>(found - choices.begin());
    return true;
  }
  case colour: {
    unsigned r = 0, g = 0, b = 0;
    int end = 0;
    if (std::sscanf(text.c_str(), "#%2x%2x%2x%n", &r, &g, &b, &end) != 3 || static_cast<size_t>(end) != text.size())
      return false;
    rgb = {static_cast<float>(r) / 255, static_cast<float>(g) / 255, static_cast<float>(b) / 255};
    return true;
  }
  case number: break;
  }
  float parsed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), parsed);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(parsed)) return false;
  if (step > 0) parsed = min + step * std::round((parsed - min) / step);
  value = std::clamp(parsed, min, max);
  return true;
}

std::string LiveError::place() const {
  return line ? file + ':' + std::to_string(line) + ':' + std::to_string(column) : file;
}

bool LiveFile::set(const std::string& name, const std::string& text) {
  for (LiveAttribute& attribute : attributes_) {
    if (attribute.name != name) continue;
    const std::string before = attribute.text();
    if (!attribute.parse(text)) return false;
    changed_ = changed_ || !attribute.given || attribute.text() != before;
    attribute.given = true;
    return true;
  }
  return false;
}

void LiveFile::keepValues(std::vector<LiveAttribute>& attributes) const {
  for (LiveAttribute& to : attributes)
    for (const LiveAttribute& from : attributes_)
      if (from.given && from.name == to.name && from.kind == to.kind && from.written == to.written)
        to.given = to.parse(from.text());
}

} // namespace mini
