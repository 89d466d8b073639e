// A file that holds an input, for readers that take a path.
#pragma once
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <unistd.h>

namespace gpgp::test {

/// One file a process in the folder for temporary files, written anew for each input.
class InputFile {
public:
  explicit InputFile(const std::string& ending)
      : path_(std::filesystem::temp_directory_path() / ("gpgp_fuzz_" + std::to_string(getpid()) + ending)) {}
  ~InputFile() { std::filesystem::remove(path_); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::filesystem::path& write(const uint8_t* data, size_t size) const {
    std::FILE* const file = std::fopen(path_.c_str(), "wb");
    if (!file || std::fwrite(data, 1, size, file) != size || std::fclose(file) != 0) std::abort();
    return path_;
  }

private:
  std::filesystem::path path_;
};

} // namespace gpgp::test
