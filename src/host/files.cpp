// Whole files in and out.
#include "host/files.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

namespace gpgp::host {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

[[noreturn]] void fail(const std::filesystem::path& file) {
  throw std::runtime_error(file.string() + ": " + std::strerror(errno));
}

template <class Container> Container readAll(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) throw std::runtime_error(file.string() + ": is a folder");
  const File handle(std::fopen(file.c_str(), "rb"));
  if (!handle) fail(file);
  Container bytes;
  // Read until the end instead of trusting a size: pipes and /proc have none.
  for (size_t used = 0;;) {
    bytes.resize(used + 65536);
    const size_t got = std::fread(bytes.data() + used, 1, 65536, handle.get());
    used += got;
    if (got == 0) {
      if (std::ferror(handle.get())) fail(file);
      bytes.resize(used);
      return bytes;
    }
  }
}

} // namespace

std::vector<uint8_t> readFile(const std::filesystem::path& file) { return readAll<std::vector<uint8_t>>(file); }
std::string readText(const std::filesystem::path& file) { return readAll<std::string>(file); }

void writeFile(const std::filesystem::path& file, std::string_view bytes) {
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
  File handle(std::fopen(file.c_str(), "wb"));
  if (!handle) fail(file);
  if (std::fwrite(bytes.data(), 1, bytes.size(), handle.get()) != bytes.size()) fail(file);
  if (std::fclose(handle.release()) != 0) fail(file);
}

} // namespace gpgp::host
