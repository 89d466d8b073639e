// Files by their names in UTF-8, whichever encoding the system has for names.
#pragma once
#include <cstdio>
#include <memory>

#ifdef _WIN32
#include <filesystem>
#endif

namespace gpgp::core {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

/// A file to be read as bytes; NULL where it cannot be opened.
inline File openToRead(const char* path) {
#ifdef _WIN32
  try { // which UTF-8 that is none ends
    return File(_wfopen(std::filesystem::path(reinterpret_cast<const char8_t*>(path)).c_str(), L"rb"));
  } catch (...) {
    return nullptr;
  }
#else
  return File(std::fopen(path, "rb"));
#endif
}

} // namespace gpgp::core
