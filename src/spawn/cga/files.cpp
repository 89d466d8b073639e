#include "spawn/cga/files.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <vector>

namespace gpgp::spawn::cga {

namespace fs = std::filesystem;

namespace {
bool isSameName(const std::string& a, const std::string& b) {
  const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return small(x) == small(y); });
}
} // namespace

std::string existingFile(const std::string& path) {
  std::error_code error;
  const fs::path wanted(path);
  if (fs::is_regular_file(wanted, error)) return path;
  fs::path found;
  for (const fs::path& part : wanted) {
    const fs::path next = found / part;
    if (fs::exists(next, error)) {
      found = next;
      continue;
    }
    const fs::path folder = found.empty() ? fs::path(".") : found;
    std::vector<std::string> names;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
      std::string name = entry->path().filename().string();
      if (isSameName(name, part.string())) names.push_back(std::move(name));
    }
    if (names.empty()) return {};
    found /= *std::min_element(names.begin(), names.end()); // folders are in no order
  }
  return fs::is_regular_file(found, error) ? found.string() : std::string();
}

PictureSize pictureSize(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::array<unsigned char, 32> head{};
  in.read(reinterpret_cast<char*>(head.data()), head.size());
  const size_t size = static_cast<size_t>(in.gcount());
  const auto big = [&](size_t at, size_t bytes) {
    uint32_t value = 0;
    for (size_t i = 0; i < bytes; ++i) value = value << 8 | head[at + i];
    return value;
  };
  const auto little = [&](size_t at, size_t bytes) {
    uint32_t value = 0;
    for (size_t i = bytes; i-- > 0;) value = value << 8 | head[at + i];
    return value;
  };
  if (size >= 24 && head[0] == 0x89 && head[1] == 'P' && head[2] == 'N' && head[3] == 'G')
    return {big(16, 4), big(20, 4)};
  if (size >= 10 && head[0] == 'G' && head[1] == 'I' && head[2] == 'F') return {little(6, 2), little(8, 2)};
  if (size >= 26 && head[0] == 'B' && head[1] == 'M') {
    const uint32_t height = little(22, 4); // of rows from the top it is negative
    return {little(18, 4), height > 0x80000000u ? 0u - height : height};
  }
  if (size < 4 || head[0] != 0xff || head[1] != 0xd8) return {};
  // JPEG: segments up to the one that begins a frame.
  in.clear();
  for (uint64_t at = 2; in.seekg(static_cast<std::streamoff>(at));) {
    in.read(reinterpret_cast<char*>(head.data()), 9);
    if (in.gcount() < 9 || head[0] != 0xff) return {};
    const unsigned char kind = head[1];
    const bool isFrame = kind >= 0xc0 && kind <= 0xcf && kind != 0xc4 && kind != 0xc8 && kind != 0xcc;
    if (isFrame) return {big(7, 2), big(5, 2)};
    at += kind == 0xff ? 1 : 2 + std::max(2u, big(2, 2));
  }
  return {};
}

} // namespace gpgp::spawn::cga
