// Functions of strings, lists in strings, colours and files.
#include "spawn/cga/deriver.h"
#include "spawn/cga/files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace gpgp::spawn::cga {

namespace fs = std::filesystem;

CgaValue Deriver::str_(const Arguments& a) { return stringValue(text(a[0])); }
CgaValue Deriver::float_(const Arguments& a) {
  return a[0].type == kCgaString ? floatValue(numberOf(text(a[0]))) : floatValue(number(a[0]));
}
CgaValue Deriver::bool_(const Arguments& a) {
  if (a[0].type != kCgaString) return cgaBoolValue(number(a[0]) != 0);
  const std::string& t = text(a[0]);
  return cgaBoolValue(t == "true" || t == "True" || (t != "false" && numberOf(t) != 0));
}
CgaValue Deriver::printed_(const Arguments& a) {
  print_(a);
  return a[0];
}

// ---------------------------------------------------------------- strings

namespace {
size_t indexOf(float x) { return x > 0 ? static_cast<size_t>(std::min(x, 1e9f)) : 0; }
} // namespace

CgaValue Deriver::len_(const Arguments& a) { return floatValue(static_cast<float>(text(a[0]).size())); }

/// Negative places count from the end.
CgaValue Deriver::substring_(const Arguments& a) {
  const std::string t = text(a[0]);
  const float size = static_cast<float>(t.size());
  const auto place = [&](float x) { return std::clamp(x < 0 ? x + size : x, 0.0f, size); };
  const float from = place(std::floor(number(a[1])));
  const float to = a.count > 2 ? std::clamp(std::floor(number(a[2])), -size, size) : size;
  const float end = to < 0 ? to + size : to;
  if (end <= from) return stringValue({});
  return stringValue(std::string_view(t).substr(static_cast<size_t>(from), static_cast<size_t>(end - from)));
}

/// The place of occurrence number index; -1: there is none.
CgaValue Deriver::find_(const Arguments& a) {
  const std::string t = text(a[0]), what = text(a[1]);
  float index = a.count > 2 ? std::floor(number(a[2])) : 0;
  if (what.empty()) return floatValue(-1);
  std::vector<size_t> all;
  for (size_t at = t.find(what); at != std::string::npos; at = t.find(what, at + what.size())) all.push_back(at);
  if (index < 0) index += static_cast<float>(all.size());
  if (index < 0 || index >= static_cast<float>(all.size())) return floatValue(-1);
  return floatValue(static_cast<float>(all[static_cast<size_t>(index)]));
}
CgaValue Deriver::findFirst_(const Arguments& a) {
  if (a[0].type == kCgaArray) return findFirstIndex_(a);
  const std::string t = text(a[0]);
  const size_t at = t.find(text(a[1]));
  return floatValue(at == std::string::npos ? -1.0f : static_cast<float>(at));
}
CgaValue Deriver::findLast_(const Arguments& a) {
  const std::string t = text(a[0]);
  const size_t at = t.rfind(text(a[1]));
  return floatValue(at == std::string::npos ? -1.0f : static_cast<float>(at));
}

namespace {
std::string replaced(std::string t, const std::string& from, const std::string& to) {
  if (from.empty()) return t;
  std::string result;
  size_t begin = 0;
  for (size_t at = t.find(from); at != std::string::npos && result.size() < (1u << 20); at = t.find(from, begin)) {
    result.append(t, begin, at - begin).append(to);
    begin = at + from.size();
  }
  return result.append(t, begin, std::string::npos);
}
uint32_t occurrences(const std::string& t, const std::string& what) {
  uint32_t count = 0;
  if (!what.empty())
    for (size_t at = t.find(what); at != std::string::npos; at = t.find(what, at + what.size())) ++count;
  return count;
}
} // namespace

CgaValue Deriver::replace_(const Arguments& a) {
  const std::string t = text(a[0]), from = text(a[1]);
  return stringValue(replaced(t, from, text(a[2])));
}
CgaValue Deriver::count_(const Arguments& a) {
  const std::string t = text(a[0]);
  return floatValue(static_cast<float>(occurrences(t, text(a[1]))));
}
CgaValue Deriver::getPrefix_(const Arguments& a) {
  const std::string t = text(a[0]);
  const size_t at = t.find(text(a[1]));
  return stringValue(at == std::string::npos ? std::string() : t.substr(0, at));
}
CgaValue Deriver::getSuffix_(const Arguments& a) {
  const std::string t = text(a[0]), by = text(a[1]);
  const size_t at = t.rfind(by);
  return stringValue(at == std::string::npos ? std::string() : t.substr(at + by.size()));
}
CgaValue Deriver::getRange_(const Arguments& a) {
  const std::string t = text(a[0]), from = text(a[1]), to = text(a[2]);
  const size_t begin = t.find(from);
  if (begin == std::string::npos) return stringValue({});
  const size_t end = t.find(to, begin + from.size());
  if (end == std::string::npos) return stringValue({});
  return stringValue(std::string_view(t).substr(begin + from.size(), end - begin - from.size()));
}
CgaValue Deriver::splitString_(const Arguments& a) {
  const std::string t = text(a[0]), by = text(a[1]);
  ArrayValue result;
  size_t begin = 0;
  for (size_t at = by.empty() ? std::string::npos : t.find(by); at != std::string::npos; at = t.find(by, begin)) {
    if (at > begin) result.values.push_back(stringValue(std::string_view(t).substr(begin, at - begin)));
    begin = at + by.size();
  }
  if (begin < t.size()) result.values.push_back(stringValue(std::string_view(t).substr(begin)));
  return array(std::move(result));
}
CgaValue Deriver::toUpper_(const Arguments& a) {
  std::string t = text(a[0]);
  for (char& c : t) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
  return stringValue(t);
}
CgaValue Deriver::toLower_(const Arguments& a) {
  std::string t = text(a[0]);
  for (char& c : t) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return stringValue(t);
}

// ---------------------------------------------------------------- lists: "a;b;c;"

std::vector<std::string> Deriver::list(const CgaValue& v) {
  const std::string t = text(v);
  std::vector<std::string> items;
  size_t begin = 0;
  for (size_t at = t.find(';'); at != std::string::npos; at = t.find(';', begin)) {
    if (at > begin) items.push_back(t.substr(begin, at - begin));
    begin = at + 1;
  }
  if (begin < t.size()) items.push_back(t.substr(begin));
  return items;
}
CgaValue Deriver::listValue(const std::vector<std::string>& items) {
  std::string t;
  for (const std::string& item : items) t.append(item).append(";");
  return stringValue(t);
}
CgaValue Deriver::listItem_(const Arguments& a) {
  const std::vector<std::string> items = list(a[0]);
  const float at = std::floor(number(a[1]));
  return stringValue(at >= 0 && at < static_cast<float>(items.size()) ? items[static_cast<size_t>(at)] : std::string());
}
CgaValue Deriver::listSize_(const Arguments& a) { return floatValue(static_cast<float>(list(a[0]).size())); }
CgaValue Deriver::listFirst_(const Arguments& a) {
  const std::vector<std::string> items = list(a[0]);
  return stringValue(items.empty() ? std::string() : items.front());
}
CgaValue Deriver::listLast_(const Arguments& a) {
  const std::vector<std::string> items = list(a[0]);
  return stringValue(items.empty() ? std::string() : items.back());
}
CgaValue Deriver::listRandom_(const Arguments& a) {
  const std::vector<std::string> items = list(a[0]);
  const float r = cgaRandom();
  if (items.empty()) return stringValue({});
  return stringValue(items[std::min(items.size() - 1, static_cast<size_t>(r * static_cast<float>(items.size())))]);
}

namespace {
/// * stands for anything, at either end.
bool fits(const std::string& text, std::string pattern) {
  const bool front = pattern.starts_with('*'), back = pattern.size() > 1 && pattern.ends_with('*');
  if (front) pattern.erase(0, 1);
  if (back) pattern.pop_back();
  if (front && back) return text.find(pattern) != std::string::npos;
  if (front) return text.ends_with(pattern);
  if (back) return text.starts_with(pattern);
  return text == pattern;
}
} // namespace

CgaValue Deriver::listIndex_(const Arguments& a) {
  const std::vector<std::string> items = list(a[0]);
  const std::string pattern = text(a[1]);
  for (size_t i = 0; i < items.size(); ++i)
    if (fits(items[i], pattern)) return floatValue(static_cast<float>(i));
  return floatValue(-1);
}
CgaValue Deriver::listRange_(const Arguments& a) {
  std::vector<std::string> items = list(a[0]);
  const size_t from = std::min(indexOf(number(a[1])), items.size()), to = std::min(indexOf(number(a[2])), items.size());
  if (to <= from) return stringValue({});
  return listValue({items.begin() + static_cast<ptrdiff_t>(from), items.begin() + static_cast<ptrdiff_t>(to)});
}
CgaValue Deriver::listAdd_(const Arguments& a) {
  std::vector<std::string> items = list(a[0]);
  for (std::string& item : list(a[1])) items.push_back(std::move(item));
  return listValue(items);
}
CgaValue Deriver::listRemove_(const Arguments& a) {
  std::vector<std::string> items = list(a[0]);
  const std::string pattern = text(a[1]);
  const auto at = std::find_if(items.begin(), items.end(), [&](const std::string& i) { return fits(i, pattern); });
  if (at != items.end()) items.erase(at);
  return listValue(items);
}
CgaValue Deriver::listRemoveAll_(const Arguments& a) {
  std::vector<std::string> items = list(a[0]);
  const std::string pattern = text(a[1]);
  std::erase_if(items, [&](const std::string& i) { return fits(i, pattern); });
  return listValue(items);
}
CgaValue Deriver::listRetainAll_(const Arguments& a) {
  std::vector<std::string> items = list(a[0]);
  const std::string pattern = text(a[1]);
  std::erase_if(items, [&](const std::string& i) { return !fits(i, pattern); });
  return listValue(items);
}
CgaValue Deriver::listClean_(const Arguments& a) { return listValue(list(a[0])); }
CgaValue Deriver::listCount_(const Arguments& a) {
  const std::vector<std::string> items = list(a[0]);
  return floatValue(static_cast<float>(std::count(items.begin(), items.end(), text(a[1]))));
}
/// With a semicolon at its end.
CgaValue Deriver::listTerminate_(const Arguments& a) {
  const std::string all = text(a[0]);
  return stringValue(all.empty() || all.ends_with(';') ? all : all + ";");
}
CgaValue Deriver::listToArray_(const Arguments& a) {
  ArrayValue result;
  for (const std::string& item : list(a[0])) result.values.push_back(stringValue(item));
  return array(std::move(result));
}
CgaValue Deriver::listFromArray_(const Arguments& a) {
  if (a[0].type != kCgaArray) return listValue({text(a[0])});
  return listValue(filesOf(a[0]));
}
/// A word out of a string, for comp and its like.
CgaValue Deriver::sel_(const Arguments& a) { return cgaMake(kCgaWord, strings_.number(text(a[0]))); }

// ---------------------------------------------------------------- files

/// Beside the program, or in a folder of a workspace around it.
std::string Deriver::findFile(const std::string& path) {
  if (path.empty()) return {};
  const auto [known, isNew] = foundFiles_.try_emplace(path);
  if (isNew) known->second = soughtFile(path);
  return known->second;
}

std::string Deriver::soughtFile(const std::string& path) {
  std::string relative = path[0] == '/' ? path.substr(1) : path;
  std::replace(relative.begin(), relative.end(), '\\', '/');
  fs::path folder(program_.folder.empty() ? std::string("./") : program_.folder);
  for (int up = 0; up < 8; ++up) {
    for (const char* inside : {"", "assets", "images", "models", "maps", "data"}) {
      const std::string found = existingFile((folder / inside / relative).string());
      if (!found.empty()) return fs::path(found).lexically_normal().string();
    }
    folder /= "..";
  }
  return {};
}

namespace {
/// * anything, ? one character.
bool matchesGlob(std::string_view text, std::string_view pattern) {
  size_t t = 0, p = 0, star = std::string_view::npos, mark = 0;
  while (t < text.size()) {
    if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t]) && pattern[p] != '*') {
      ++t;
      ++p;
    } else if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      mark = t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++mark;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}
} // namespace

const std::vector<std::string>& Deriver::searchFiles(const std::string& pattern) {
  const auto [known, isNew] = searches_.try_emplace(pattern);
  if (isNew) known->second = soughtFiles(pattern);
  return known->second;
}

std::vector<std::string> Deriver::soughtFiles(const std::string& pattern) {
  std::vector<std::string> result;
  if (pattern.starts_with('$')) {
    warn("fileSearch $", "searches for files by regular expressions are not supported, and find none");
    return result;
  }
  const std::string relative = pattern.starts_with('/') ? pattern.substr(1) : pattern;
  const size_t slash = relative.rfind('/');
  const std::string inside = slash == std::string::npos ? std::string() : relative.substr(0, slash);
  const std::string name = slash == std::string::npos ? relative : relative.substr(slash + 1);
  const fs::path begin(program_.folder.empty() ? std::string("./") : program_.folder);
  std::error_code error;
  if (relative.starts_with('*') || inside.find('*') != std::string::npos) {
    // Anywhere below the folder of the program, else below one of the folders above it.
    constexpr uint32_t kMostVisited = 100'000;
    uint32_t visited = 0;
    fs::path folder = begin;
    for (int up = 0; up < 4 && result.empty() && visited < kMostVisited; ++up) {
      fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error), end;
      for (; !error && entry != end && visited < kMostVisited; entry.increment(error), ++visited) {
        const std::string file = entry->path().filename().string();
        if (file.starts_with('.')) {
          entry.disable_recursion_pending();
          continue;
        }
        const std::string path = entry->path().lexically_relative(folder).generic_string();
        if (result.size() < 10000 && matchesGlob(path, relative) && entry->is_regular_file(error))
          result.push_back(path);
      }
      folder /= "..";
    }
    if (visited >= kMostVisited)
      warn("fileSearch " + pattern,
           "the search for \"" + pattern + "\" ended after " + std::to_string(kMostVisited) + " files");
  }
  fs::path folder = begin;
  for (int up = 0; up < 8 && result.empty(); ++up) {
    for (const char* root : {"", "assets", "images", "models", "maps", "data"}) {
      const fs::path place = folder / root / inside;
      if (!fs::is_directory(place, error)) continue;
      for (const auto& entry : fs::directory_iterator(place, error)) {
        const std::string file = entry.path().filename().string();
        if (result.size() < 10000 && entry.is_regular_file(error) && matchesGlob(file, name))
          result.push_back((inside.empty() ? std::string() : inside + "/") + file);
      }
      if (!result.empty()) break;
    }
    folder /= "..";
  }
  std::sort(result.begin(), result.end());
  return result;
}

CgaValue Deriver::fileExists_(const Arguments& a) { return cgaBoolValue(!findFile(text(a[0])).empty()); }
CgaValue Deriver::fileSearch_(const Arguments& a) { return listValue(searchFiles(text(a[0]))); }
CgaValue Deriver::filesSearch_(const Arguments& a) {
  ArrayValue result;
  for (const std::string& file : searchFiles(text(a[0]))) result.values.push_back(stringValue(file));
  return array(std::move(result));
}
CgaValue Deriver::fileRandom_(const Arguments& a) {
  const std::string pattern = text(a[0]);
  const std::vector<std::string> files = searchFiles(pattern);
  const float r = cgaRandom();
  if (files.empty()) {
    warn("fileRandom " + pattern, "no file is found for \"" + pattern + "\"");
    return stringValue({});
  }
  return stringValue(files[std::min(files.size() - 1, static_cast<size_t>(r * static_cast<float>(files.size())))]);
}
CgaValue Deriver::fileName_(const Arguments& a) { return stringValue(fs::path(text(a[0])).filename().string()); }
CgaValue Deriver::fileBasename_(const Arguments& a) { return stringValue(fs::path(text(a[0])).stem().string()); }
CgaValue Deriver::fileExtension_(const Arguments& a) { return stringValue(fs::path(text(a[0])).extension().string()); }
CgaValue Deriver::fileDirectory_(const Arguments& a) {
  const std::string folder = fs::path(text(a[0])).parent_path().string();
  return stringValue(folder.empty() ? folder : folder + "/");
}
CgaValue Deriver::readTextFile_(const Arguments& a) {
  const std::string path = text(a[0]), file = findFile(path);
  std::ifstream in(file, std::ios::binary);
  std::ostringstream all;
  if (file.empty() || !(all << in.rdbuf())) warn("file " + path, "there is no file \"" + path + "\"");
  return stringValue(all.str().substr(0, 1u << 20));
}

/// Rows of comma- or semicolon-separated values.
CgaValue Deriver::table(const Arguments& a, bool asStrings) {
  const std::string path = text(a[0]), file = findFile(path);
  std::ifstream in(file);
  ArrayValue result;
  if (file.empty() || !in) {
    warn("file " + path, "there is no file \"" + path + "\"");
    return array(std::move(result));
  }
  std::vector<std::vector<std::string>> rows;
  size_t columns = 1;
  std::string line;
  while (std::getline(in, line) && rows.size() < 100000) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const char by = line.find(';') != std::string::npos ? ';' : line.find('\t') != std::string::npos ? '\t' : ',';
    std::vector<std::string> cells;
    size_t begin = 0;
    for (size_t at = line.find(by); at != std::string::npos; at = line.find(by, begin)) {
      cells.push_back(line.substr(begin, at - begin));
      begin = at + 1;
    }
    cells.push_back(line.substr(begin));
    columns = std::max(columns, cells.size());
    rows.push_back(std::move(cells));
  }
  result.width = static_cast<uint32_t>(columns);
  for (std::vector<std::string>& row : rows) {
    row.resize(columns);
    for (const std::string& cell : row)
      result.values.push_back(asStrings ? stringValue(cell) : floatValue(numberOf(cell)));
  }
  return array(std::move(result));
}
CgaValue Deriver::readStringTable_(const Arguments& a) { return table(a, true); }
CgaValue Deriver::readFloatTable_(const Arguments& a) { return table(a, false); }

// ---------------------------------------------------------------- colours

namespace {
vec3 hsvOf(const vec3& c) {
  const float most = std::max({c.x, c.y, c.z}), least = std::min({c.x, c.y, c.z}), range = most - least;
  float h = 0;
  if (range > 0)
    h = most == c.x ? (c.y - c.z) / range : most == c.y ? 2 + (c.z - c.x) / range : 4 + (c.x - c.y) / range;
  return {h < 0 ? h * 60 + 360 : h * 60, most > 0 ? range / most : 0, most};
}
vec3 rgbOf(float h, float s, float v) {
  const auto part = [&](float n) {
    const float k = std::fmod(n + h / 60.0f, 6.0f);
    return v - v * s * std::max(0.0f, std::min({k, 4 - k, 1.0f}));
  };
  return {part(5), part(3), part(1)};
}
std::string hexOf(const vec3& c, float opacity) {
  const auto byte = [](float x) { return static_cast<int>(std::clamp(x, 0.0f, 1.0f) * 255.0f + 0.5f); };
  char t[16];
  std::snprintf(t, sizeof t, opacity < 0 ? "#%02x%02x%02x" : "#%02x%02x%02x%02x", byte(c.x), byte(c.y), byte(c.z),
                byte(opacity));
  return t;
}
} // namespace

#define GPGP_CGA_COLOR(name, value)                                                                                    \
  CgaValue Deriver::name##_(const Arguments& a) {                                                                      \
    glm::vec4 c(0, 0, 0, 1);                                                                                           \
    bool hasOpacity = false;                                                                                           \
    if (!parseColor(text(a[0]), c, hasOpacity)) warn("color", "\"" + text(a[0]) + "\" is not a colour");               \
    return floatValue(value);                                                                                          \
  }
GPGP_CGA_COLOR(colorHexToR, c.x)
GPGP_CGA_COLOR(colorHexToG, c.y)
GPGP_CGA_COLOR(colorHexToB, c.z)
GPGP_CGA_COLOR(colorHexToO, c.w)
GPGP_CGA_COLOR(colorHexToH, hsvOf(c).x)
GPGP_CGA_COLOR(colorHexToS, hsvOf(c).y)
GPGP_CGA_COLOR(colorHexToV, hsvOf(c).z)
#undef GPGP_CGA_COLOR
CgaValue Deriver::colorHSVToHex_(const Arguments& a) {
  return stringValue(hexOf(rgbOf(cgaModulo(number(a[0]) + 360, 360), number(a[1]), number(a[2])), -1));
}
CgaValue Deriver::colorHSVOToHex_(const Arguments& a) {
  return stringValue(
      hexOf(rgbOf(cgaModulo(number(a[0]) + 360, 360), number(a[1]), number(a[2])), std::max(0.0f, number(a[3]))));
}
CgaValue Deriver::colorRGBToHex_(const Arguments& a) {
  return stringValue(hexOf({number(a[0]), number(a[1]), number(a[2])}, -1));
}
CgaValue Deriver::colorRGBOToHex_(const Arguments& a) {
  return stringValue(hexOf({number(a[0]), number(a[1]), number(a[2])}, std::max(0.0f, number(a[3]))));
}
CgaValue Deriver::colorRamp_(const Arguments& a) {
  const float x = std::clamp(number(a[1]), 0.0f, 1.0f);
  const std::string_view name = word(a[0]);
  if (name == "spectrum") return stringValue(hexOf(rgbOf(x * 300, 1, 1), -1));
  if (name == "redToGreen") return stringValue(hexOf(rgbOf(x * 120, 1, 1), -1));
  if (name == "greenToRed") return stringValue(hexOf(rgbOf(120 - x * 120, 1, 1), -1));
  if (name == "blueToRed" || name == "orangeToBlue") return stringValue(hexOf(rgbOf(240 - 240 * x, 1, 1), -1));
  if (name == "whiteToBlack") return stringValue(hexOf(vec3(1 - x), -1));
  return stringValue(hexOf(vec3(x), -1)); // blackToWhite
}

} // namespace gpgp::spawn::cga
