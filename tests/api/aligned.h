// std::aligned_alloc with its free, which are two other functions on Windows.
#pragma once
#include <cstddef>
#include <cstdlib>

namespace gpgp::test {

#ifdef _WIN32
inline void* allocateAligned(std::size_t size, std::size_t alignment) { return _aligned_malloc(size, alignment); }
inline void freeAligned(void* memory) { _aligned_free(memory); }
#else
inline void* allocateAligned(std::size_t size, std::size_t alignment) {
  return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}
inline void freeAligned(void* memory) { std::free(memory); }
#endif

} // namespace gpgp::test
