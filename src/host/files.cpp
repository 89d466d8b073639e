// Whole files in and out.
#include "host/files.h"

#include "host/beside.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <stdexcept>

namespace gpgp::host {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file) {
  throw std::runtime_error(file.string() + ": " + std::strerror(errno));
}

template <class Container> Container readAll(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) throw std::runtime_error(file.string() + ": is a folder");
  const File handle = openFile(file, "rb");
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

bool write(const std::filesystem::path& file, std::string_view bytes) {
  File handle = openFile(file, "wb");
  return handle && (bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), handle.get()) == bytes.size()) &&
         std::fclose(handle.release()) == 0;
}

} // namespace

std::vector<uint8_t> readFile(const std::filesystem::path& file) { return readAll<std::vector<uint8_t>>(file); }
std::string readText(const std::filesystem::path& file) { return readAll<std::string>(file); }

void writeFile(const std::filesystem::path& file, std::string_view bytes) {
  std::error_code ignored; // opening the file says what is wrong
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  const std::optional<Beside> beside = makeBeside(file);
  if (!beside) {
    if (!write(file, bytes)) fail(file);
    return;
  }
  const auto& [target, temporary] = *beside;
  if (write(temporary, bytes) && replace(temporary, target)) return;
  const int error = errno;
  std::filesystem::remove(temporary, ignored);
  errno = error;
  fail(file);
}

} // namespace gpgp::host
