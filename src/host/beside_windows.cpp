// Windows: a file's place is taken by ReplaceFile, which keeps its permissions; names go to the system as UTF-16.
#include "host/beside.h"

#include <cerrno>
#include <cstring>
#include <string>

#define WIN32_LEAN_AND_MEAN
#include <windows.h>

namespace gpgp::host {

File openFile(const std::filesystem::path& file, const char* mode) {
  return File(_wfopen(file.c_str(), std::wstring(mode, mode + std::strlen(mode)).c_str()));
}

std::optional<Beside> makeBeside(const std::filesystem::path& file) {
  const DWORD attributes = GetFileAttributesW(file.c_str());
  const bool exists = attributes != INVALID_FILE_ATTRIBUTES;
  // Pipes and devices (\\.\pipe\x, NUL, CON) have no folder in which another file could stand in for them.
  if (exists && (attributes & (FILE_ATTRIBUTE_DEVICE | FILE_ATTRIBUTE_DIRECTORY | FILE_ATTRIBUTE_REPARSE_POINT |
                               FILE_ATTRIBUTE_READONLY)))
    return std::nullopt;
  const std::wstring name = file.native();
  if (name.starts_with(L"\\\\.\\") || name.starts_with(L"//./")) return std::nullopt;
  Beside beside{file, file};
  beside.temporary.concat(L"." + std::to_wstring(GetCurrentProcessId()) + L".tmp");
  if (File made = openFile(beside.temporary, "wbx"); !made || std::fclose(made.release()) != 0) return std::nullopt;
  return beside;
}

bool replace(const std::filesystem::path& temporary, const std::filesystem::path& target) {
  constexpr DWORD kNow = MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH;
  if (ReplaceFileW(target.c_str(), temporary.c_str(), nullptr, REPLACEFILE_IGNORE_MERGE_ERRORS, nullptr, nullptr) ||
      MoveFileExW(temporary.c_str(), target.c_str(), kNow)) // there was none
    return true;
  errno = GetLastError() == ERROR_DISK_FULL ? ENOSPC : EACCES;
  return false;
}

} // namespace gpgp::host
