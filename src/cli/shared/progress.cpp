#include "cli/shared/progress.h"

#include "host/console.h"

#include <algorithm>
#include <cmath>

namespace gpgp::cli {

std::string durationText(double seconds) {
  const auto text = [](double value, const char* one, const char* many) {
    const auto whole = std::llround(value);
    return std::to_string(whole) + (whole == 1 ? one : many);
  };
  if (seconds < 99.5) return text(std::ceil(seconds), " s", " s");
  return seconds < 5400 ? text(seconds / 60, " minute", " minutes") : text(seconds / 3600, " hour", " hours");
}

Progress::Target Progress::standardError() {
  Target target;
  target.terminal = host::isTerminal(stderr);
  if (target.terminal) target.first = std::chrono::milliseconds(250), target.period = std::chrono::milliseconds(100);
  return target;
}

Progress::Progress(std::string label, uint64_t total, const Target& target)
    : label_(std::move(label)), total_(total), target_(target), thread_([this] { run(); }) {}

Progress::~Progress() {
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  ended_.notify_one();
  thread_.join();
}

void Progress::advance() {
  const std::lock_guard lock(mutex_);
  ++done_;
}

void Progress::run() {
  std::unique_lock lock(mutex_);
  bool shown = false;
  for (auto wait = target_.first; !ended_.wait_for(lock, wait, [this] { return end_; }); wait = target_.period) {
    std::fprintf(target_.stream, target_.terminal ? "\r%s\033[K" : "%s\n", state().c_str());
    std::fflush(target_.stream);
    shown = true;
  }
  if (shown && target_.terminal) {
    std::fputs("\r\033[K", target_.stream);
    std::fflush(target_.stream);
  }
}

std::string Progress::state() const {
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  std::string text = label_;
  if (target_.terminal && total_) {
    constexpr uint64_t kWidth = 30;
    std::string bar(kWidth, '.');
    std::fill_n(bar.begin(), std::min(done_ * kWidth / total_, kWidth), '#');
    text += " [" + bar + "]";
  }
  if (!total_) return text + ": " + durationText(seconds) + " so far";
  text += (target_.terminal ? " " : ": ") + std::to_string(done_) + " of " + std::to_string(total_);
  if (done_ && done_ < total_ && seconds > 2)
    text +=
        ", about " + durationText(seconds * static_cast<double>(total_ - done_) / static_cast<double>(done_)) + " left";
  else
    text += ", " + durationText(seconds) + " so far";
  return text;
}

} // namespace gpgp::cli
