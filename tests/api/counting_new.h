// Counts calls of the global operator new in this test binary, which is what the library allocates behind the engine's
// back, and lets allocations fail.
#pragma once
#include <cstdint>

namespace gpgp::test {
uint64_t countingNewCalls();
/// Allocations of operator new that live; those of UncountedNew included.
int64_t livingNews();

/// Lets the n-th allocation from now on fail, of operator new and of those who ask allocationFails(), and all after it
/// where `onwards`; 0: none. Only of this thread, and not those within UncountedNew.
void failAllocations(uint64_t nth, bool onwards);
/// Counts one, and says whether it fails.
bool allocationFails();
/// Counted since failAllocations.
uint64_t allocationsTried();
/// Whether operator new can fail: a sanitizer has its own.
bool canFailNew();

/// While one lives, this thread's allocations are not counted and do not fail.
class UncountedNew {
public:
  UncountedNew();
  ~UncountedNew();
  UncountedNew(const UncountedNew&) = delete;
  UncountedNew& operator=(const UncountedNew&) = delete;
};
} // namespace gpgp::test
