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

} // namespace gpgp::test
