// Whole files in and out.
#include "host/files.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
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

bool write(const std::filesystem::path& file, const char* mode, std::string_view bytes) {
  File handle(std::fopen(file.c_str(), mode));
  return handle && (bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), handle.get()) == bytes.size()) &&
         std::fclose(handle.release()) == 0;
}

struct Beside {
  std::filesystem::path target;    ///< the file itself, where symbolic links lead to it
  std::filesystem::path temporary; ///< empty, with the owner and permissions of the target
};

/// None where another file must not take the place of this one, as of devices, pipes and files with several names, or
/// where nothing can be made beside it.
std::optional<Beside> makeBeside(const std::filesystem::path& file) {
  struct stat there {};
  const bool exists = ::stat(file.c_str(), &there) == 0;
  const bool stays = exists ? !S_ISREG(there.st_mode) || there.st_nlink != 1 || ::access(file.c_str(), W_OK) != 0
                            : std::filesystem::is_symlink(file);
  const std::string name = file.string(); // /dev/stdout is whatever file the shell has opened
  if (stays || name.starts_with("/dev/") || name.starts_with("/proc/")) return std::nullopt;
  std::error_code error;
  Beside beside{exists ? std::filesystem::canonical(file, error) : file, {}};
  beside.temporary = beside.target;
  beside.temporary.concat(".").concat(std::to_string(::getpid())).concat(".tmp");
  if (error) return std::nullopt;
  if (!write(beside.temporary, "wbx", {})) {
    if (errno == ENOSPC || errno == EDQUOT) fail(file);
    return std::nullopt;
  }
  if (!exists || (::chown(beside.temporary.c_str(), there.st_uid, there.st_gid) == 0 &&
                  ::chmod(beside.temporary.c_str(), there.st_mode & 07777) == 0))
    return beside;
  std::filesystem::remove(beside.temporary, error);
  return std::nullopt;
}

} // namespace

std::vector<uint8_t> readFile(const std::filesystem::path& file) { return readAll<std::vector<uint8_t>>(file); }
std::string readText(const std::filesystem::path& file) { return readAll<std::string>(file); }

void writeFile(const std::filesystem::path& file, std::string_view bytes) {
  std::error_code ignored; // opening the file says what is wrong
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  const std::optional<Beside> beside = makeBeside(file);
  if (!beside) {
    if (!write(file, "wb", bytes)) fail(file);
    return;
  }
  const auto& [target, temporary] = *beside;
  if (write(temporary, "wb", bytes) && std::rename(temporary.c_str(), target.c_str()) == 0) return;
  const int error = errno;
  std::filesystem::remove(temporary, ignored);
  errno = error;
  fail(file);
}

} // namespace gpgp::host
