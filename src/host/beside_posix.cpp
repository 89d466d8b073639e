// POSIX: a file's place is taken by rename, which keeps neither owner nor permissions, so that they are copied before.
#include "host/beside.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

namespace gpgp::host {

File openFile(const std::filesystem::path& file, const char* mode) { return File(std::fopen(file.c_str(), mode)); }

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
  if (File made = openFile(beside.temporary, "wbx"); !made || std::fclose(made.release()) != 0) {
    if (errno == ENOSPC || errno == EDQUOT) throw std::runtime_error(file.string() + ": " + std::strerror(errno));
    return std::nullopt;
  }
  if (!exists || (::chown(beside.temporary.c_str(), there.st_uid, there.st_gid) == 0 &&
                  ::chmod(beside.temporary.c_str(), there.st_mode & 07777) == 0))
    return beside;
  std::filesystem::remove(beside.temporary, error);
  return std::nullopt;
}

bool replace(const std::filesystem::path& temporary, const std::filesystem::path& target) {
  return std::rename(temporary.c_str(), target.c_str()) == 0;
}

} // namespace gpgp::host
