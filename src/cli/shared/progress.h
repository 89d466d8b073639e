// How far long work is, on standard error: a bar on a terminal, which goes away again; elsewhere, such as in the log of
// a build, a line now and then.
#pragma once
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>

namespace gpgp::cli {

/// "40 s", "12 minutes", "3 hours".
std::string durationText(double seconds);

class Progress {
public:
  struct Target {
    std::FILE* stream = stderr;
    bool terminal = false;
    std::chrono::milliseconds first{10'000}, period{10'000}; ///< work that is done before `first` says nothing
  };
  /// A bar after a quarter of a second, ten times a second, or a line every ten seconds.
  static Target standardError();

  /// total: of parts; 0: nobody knows how many, and only the time is shown.
  explicit Progress(std::string label, uint64_t total = 0, const Target& target = standardError());
  ~Progress(); ///< takes the bar away
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void advance();

private:
  void run();
  std::string state() const;

  const std::string label_;
  const uint64_t total_;
  const Target target_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::condition_variable ended_;
  uint64_t done_ = 0;
  bool end_ = false;
  std::thread thread_; // so that work which advances seldom is seen to go on
};

} // namespace gpgp::cli
