#include "statistics.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace streaming {

void Table::add(const std::string& name, double value) {
  auto row = std::find_if(rows_.begin(), rows_.end(), [&](const auto& r) { return r.first == name; });
  if (row == rows_.end()) row = rows_.insert(rows_.end(), {name, {}});
  row->second.add(value);
}

const Series& Table::operator[](const std::string& name) const {
  static const Series kNone;
  const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const auto& r) { return r.first == name; });
  return row == rows_.end() ? kNone : row->second;
}

nlohmann::json Table::json() const {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& row : rows_) json[row.first] = row.second.json();
  return json;
}

void Table::print(const char* title) const {
  std::printf("%-34s %10s %10s\n", title, "mean", "worst");
  for (const auto& row : rows_)
    std::printf("  %-32s %10.2f %10.2f\n", row.first.c_str(), row.second.mean(), row.second.worst());
}

void writeJson(const std::string& file, const nlohmann::json& json) {
  const std::filesystem::path path(file);
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path());
  std::ofstream stream(path);
  stream << json.dump(2) << '\n';
  if (!stream.flush()) throw std::runtime_error("cannot write " + file);
}

} // namespace streaming
