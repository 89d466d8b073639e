#include "counting_new.h"

#include "aligned.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {
std::atomic<uint64_t> calls{0};
std::atomic<int64_t> living{0};
thread_local int uncounted = 0;
thread_local uint64_t tried = 0, failFrom = UINT64_MAX, failTo = 0;
} // namespace

namespace gpgp::test {
uint64_t countingNewCalls() { return calls; }
int64_t livingNews() { return living; }
void failAllocations(uint64_t nth, bool onwards) {
  tried = 0;
  failFrom = nth ? nth : UINT64_MAX;
  failTo = nth && onwards ? UINT64_MAX : nth;
}
bool allocationFails() {
  const uint64_t number = ++tried;
  return !uncounted && number >= failFrom && number <= failTo;
}
uint64_t allocationsTried() { return tried; }
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define GPGP_TEST_OWN_NEW 0
#else
#define GPGP_TEST_OWN_NEW 1
#endif
bool canFailNew() { return GPGP_TEST_OWN_NEW; }
UncountedNew::UncountedNew() { ++uncounted; }
UncountedNew::~UncountedNew() { --uncounted; }
} // namespace gpgp::test

// A sanitizer has its own operators and checks that they go together: there nothing is counted.
#if GPGP_TEST_OWN_NEW
namespace {
void* allocate(std::size_t size, std::size_t alignment) {
  if (!uncounted) {
    ++calls;
    if (gpgp::test::allocationFails()) return nullptr;
  }
  ++living;
  return gpgp::test::allocateAligned(size, alignment);
}
} // namespace

void* operator new(std::size_t size) {
  if (void* memory = allocate(size, alignof(std::max_align_t))) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  if (void* memory = allocate(size, static_cast<std::size_t>(alignment))) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  if (memory) --living;
  gpgp::test::freeAligned(memory);
}
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { operator delete(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { operator delete(memory); }
#endif
