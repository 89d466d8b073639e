#include "cli/spawn/asset_names.h"

#include "cli/shared/command.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>

namespace gpgp::cli {

namespace {

void addOnce(std::vector<std::string>& names, std::string name) {
  if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
}

AssetNames namesOfObj(std::istream& file) {
  AssetNames names;
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string key, name;
    words >> key;
    if (key != "g" && key != "o" && key != "usemtl") continue;
    std::getline(words >> std::ws, name);
    while (!name.empty() && (name.back() == '\r' || name.back() == ' ')) name.pop_back();
    addOnce(key == "usemtl" ? names.materials : names.groups, name);
  }
  return names;
}

AssetNames namesOfGltf(const std::string& text) {
  const Json file = Json::parse(text, nullptr, false);
  AssetNames names;
  if (!file.is_object()) return names;
  const auto each = [&](const char* list, auto&& add) {
    const auto found = file.find(list);
    if (found == file.end() || !found->is_array()) return;
    for (const Json& one : *found)
      if (one.is_object())
        add(one, one.contains("name") && one["name"].is_string() ? one["name"].get<std::string>() : "");
  };
  each("nodes", [&](const Json& node, const std::string& name) {
    if (node.contains("mesh")) addOnce(names.groups, name);
  });
  each("materials", [&](const Json&, const std::string& name) { addOnce(names.materials, name); });
  return names;
}

} // namespace

AssetNames assetNames(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  const auto ends = [&](const char* end) { return path.size() > std::strlen(end) && path.ends_with(end); };
  if (ends(".obj") || ends(".OBJ")) return namesOfObj(file);
  if (!ends(".gltf") && !ends(".glb")) return {};
  std::ostringstream all;
  all << file.rdbuf();
  std::string text = all.str();
  if (ends(".glb")) { // a header of 12 bytes, then the length of its JSON, its type, and the JSON
    if (text.size() < 20) return {};
    uint32_t length = 0;
    for (int i = 3; i >= 0; --i) length = length << 8 | static_cast<unsigned char>(text[12 + static_cast<size_t>(i)]);
    text = text.substr(20, length);
  }
  return namesOfGltf(text);
}

} // namespace gpgp::cli
