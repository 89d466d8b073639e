#include "cli/vector/svg_files.h"

#include "cli/shared/common.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace gpgp::cli {
namespace fs = std::filesystem;

SvgFiles::SvgFiles(const std::string& file) : fileSystem_{this, read} {
  if (file == kStandard) return;
  const fs::path folder = fs::path(file).parent_path();
  folder_ = folder.empty() ? "." : folder.string();
}

GpgpResult GPGP_CALL SvgFiles::read(void* userData, const char* path, void* data, size_t capacity, size_t* size) {
  const auto& files = *static_cast<const SvgFiles*>(userData);
  try {
    std::error_code error;
    const fs::path folder = fs::canonical(files.folder_, error);
    if (error) return GPGP_ERROR_IO;
    const fs::path file = fs::canonical(folder / path, error); // links are followed, and may not lead out either
    if (error || !fs::is_regular_file(file, error)) return GPGP_ERROR_IO;
    if (std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first != folder.end())
      return GPGP_ERROR_IO;
    const auto bytes = static_cast<size_t>(fs::file_size(file, error));
    if (error) return GPGP_ERROR_IO;
    *size = bytes;
    if (!data) return GPGP_SUCCESS;
    std::ifstream in(file, std::ios::binary);
    in.read(static_cast<char*>(data), static_cast<std::streamsize>(std::min(bytes, capacity)));
    return in.gcount() == static_cast<std::streamsize>(std::min(bytes, capacity)) ? GPGP_SUCCESS : GPGP_ERROR_IO;
  } catch (...) { // the compiler, which calls this, throws nothing on
    return GPGP_ERROR_IO;
  }
}

} // namespace gpgp::cli
