#include "counting_new.h"

#include "aligned.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {
std::atomic<uint64_t> calls{0};
thread_local int uncounted = 0;
} // namespace

namespace gpgp::test {
uint64_t countingNewCalls() { return calls; }
UncountedNew::UncountedNew() { ++uncounted; }
UncountedNew::~UncountedNew() { --uncounted; }
} // namespace gpgp::test

// A sanitizer has its own operators and checks that they go together: there nothing is counted.
#ifndef __SANITIZE_ADDRESS__
namespace {
void* allocate(std::size_t size, std::size_t alignment) {
  if (!uncounted) ++calls;
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
void operator delete(void* memory) noexcept { gpgp::test::freeAligned(memory); }
void operator delete(void* memory, std::size_t) noexcept { gpgp::test::freeAligned(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { gpgp::test::freeAligned(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { gpgp::test::freeAligned(memory); }
#endif
