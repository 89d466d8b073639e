// Work that keeps a GPU from lowering its clocks: an idle one does within milliseconds, and times then differ by a
// factor of four. For measuring programs.
#pragma once
#include "host/memory.h"

#include <chrono>

namespace gpgp::host {

class BusyWork {
public:
  /// Software devices get none.
  explicit BusyWork(HeadlessDevice& device);
  /// A second of work, waited for, as clocks rise in steps; nothing where there was work a moment ago.
  void warmUp();
  /// Ten milliseconds of it, waited for, while there is nothing else to do.
  void pass();
  /// About a millisecond of work, for the front of a command buffer whose end is timed.
  void record(VkCommandBuffer commands);

private:
  HeadlessDevice& device_;
  Buffer target_;
  std::chrono::steady_clock::time_point last_{}; // recorded
};

} // namespace gpgp::host
