// What files.cpp needs of the system: opening files by their paths, and another file to take the place of one.
#pragma once
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

namespace gpgp::host {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

/// As std::fopen; NULL with errno where that fails.
File openFile(const std::filesystem::path& file, const char* mode);

struct Beside {
  std::filesystem::path target;    ///< the file itself, where symbolic links lead to it
  std::filesystem::path temporary; ///< empty, with the owner and permissions of the target
};

/// None where another file must not take the place of this one, as of devices, pipes and files with several names, or
/// where nothing can be made beside it. Throws std::runtime_error where the disk is full.
std::optional<Beside> makeBeside(const std::filesystem::path& file);
/// The temporary file becomes the target, whole, where that exists, too. False with errno where that fails.
bool replace(const std::filesystem::path& temporary, const std::filesystem::path& target);

} // namespace gpgp::host
