// Counts calls of the global operator new in this test binary: what the library allocates behind the engine's back.
#pragma once
#include <cstdint>

namespace gpgp::test {
uint64_t countingNewCalls();

/// While one lives, this thread's allocations are not counted.
class UncountedNew {
public:
  UncountedNew();
  ~UncountedNew();
  UncountedNew(const UncountedNew&) = delete;
  UncountedNew& operator=(const UncountedNew&) = delete;
};
} // namespace gpgp::test
