// Work that keeps a GPU from lowering its clocks: an idle one does within milliseconds, and times then differ by a
// factor of four. For measuring programs.
#pragma once
#include "host/memory.h"

namespace gpgp::host {

class BusyWork {
public:
  /// Software devices get none.
  explicit BusyWork(HeadlessDevice& device);
  /// A fifth of a second of work, waited for.
  void warmUp() const;
  /// About a millisecond of work, for the front of a command buffer whose end is timed.
  void record(VkCommandBuffer commands) const;

private:
  HeadlessDevice& device_;
  Buffer target_;
};

} // namespace gpgp::host
