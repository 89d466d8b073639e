// A progress bar that appears after a quarter of a second and is redrawn ten times a second.
#include "cli/progress.h"

#include <unistd.h>

#include <cstdio>

namespace gpgp::cli {

Progress::Progress(std::string label, uint64_t total)
    : label_(std::move(label)), total_(total ? total : 1), terminal_(isatty(STDERR_FILENO) != 0),
      begin_(std::chrono::steady_clock::now()), last_(begin_) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::advance() {
  ++done_;
  if (!terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - begin_ < std::chrono::milliseconds(250) || now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  shown_ = true;
  constexpr uint64_t kWidth = 30;
  const uint64_t filled = done_ * kWidth / total_;
  std::string bar(kWidth, '.');
  for (uint64_t i = 0; i < filled && i < kWidth; ++i) bar[i] = '#';
  std::fprintf(stderr, "\r%s [%s] %llu/%llu", label_.c_str(), bar.c_str(), static_cast<unsigned long long>(done_),
               static_cast<unsigned long long>(total_));
  std::fflush(stderr);
}

} // namespace gpgp::cli
