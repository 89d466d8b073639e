// Runs a program and keeps apart what it writes to standard output and to standard error.
#pragma once
#include <string>
#include <vector>

namespace gpgp::test {

struct ProcessResult {
  int exitCode = -1; ///< -1: ended by a signal
  std::string out, err;
};

/// A program by its path, or by its name along PATH. Throws std::runtime_error where it cannot be started.
ProcessResult runProcess(const std::vector<std::string>& arguments);

} // namespace gpgp::test
