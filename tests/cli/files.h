// Small input files for the command, written where the test runs and removed after it.
#pragma once
#include "host/files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace gpgp::test {

class TemporaryFile {
public:
  TemporaryFile(const std::string& name, std::string_view contents)
      : path_(std::filesystem::path(testing::TempDir()) / ("gpgp_cli_test_" + name)) {
    host::writeFile(path_, contents);
  }
  /// Only the name, for a file that the command is to write.
  explicit TemporaryFile(const std::string& name)
      : path_(std::filesystem::path(testing::TempDir()) / ("gpgp_cli_test_" + name)) {
    std::filesystem::remove(path_);
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  std::string path() const { return path_.string(); }

private:
  std::filesystem::path path_;
};

/// For data: URIs.
inline std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

} // namespace gpgp::test
