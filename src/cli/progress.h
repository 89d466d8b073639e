// A progress bar on standard error, for a person only: nothing is drawn where standard error is not a terminal.
#pragma once
#include <chrono>
#include <cstdint>
#include <string>

namespace gpgp::cli {

class Progress {
public:
  Progress(std::string label, uint64_t total);
  ~Progress(); ///< takes the bar away
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void advance();

private:
  std::string label_;
  uint64_t total_, done_ = 0;
  bool shown_ = false;
  bool terminal_;
  std::chrono::steady_clock::time_point begin_, last_;
};

} // namespace gpgp::cli
