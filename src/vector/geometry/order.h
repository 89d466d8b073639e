// Orders by a height, which is a float: as integers, by radix where there are many.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory_resource>
#include <utility>
#include <vector>

namespace gpgp::vector {

/// Sorts by the upper 32 bits. What has the same there stays as it is; few keys are put in the order of all bits.
inline void sortKeys(std::pmr::vector<uint64_t>& keys) {
  constexpr size_t kFew = 128;
  if (std::is_sorted(keys.begin(), keys.end())) return;
  if (keys.size() < kFew) return std::sort(keys.begin(), keys.end());
  std::array<std::array<uint32_t, 256>, 4> counts{};
  for (const uint64_t key : keys)
    for (unsigned digit = 0; digit < 4; ++digit) ++counts[digit][(key >> (32 + 8 * digit)) & 255];
  std::pmr::vector<uint64_t> other(keys.size(), 0, keys.get_allocator());
  for (unsigned digit = 0; digit < 4; ++digit) {
    const unsigned shift = 32 + 8 * digit;
    auto& count = counts[digit];
    if (count[(keys[0] >> shift) & 255] == keys.size()) continue; // all the same
    uint32_t place = 0;
    for (uint32_t& c : count) place += std::exchange(c, place);
    for (const uint64_t key : keys) other[count[(key >> shift) & 255]++] = key;
    keys.swap(other);
  }
}

/// Heights as integers in the same order.
inline uint32_t heightBits(float height) {
  const uint32_t bits = std::bit_cast<uint32_t>(height + 0.0f); // no -0
  return bits >> 31 ? ~bits : bits | 0x80000000u;
}
inline float heightOf(uint32_t bits) { return std::bit_cast<float>(bits >> 31 ? bits & 0x7fffffffu : ~bits); }

/// A height and a number as one key, in the order of heights, then numbers.
inline uint64_t heightKey(float height, uint32_t number) { return uint64_t(heightBits(height)) << 32 | number; }
inline float heightOfKey(uint64_t key) { return heightOf(static_cast<uint32_t>(key >> 32)); }
inline uint32_t numberOfKey(uint64_t key) { return static_cast<uint32_t>(key); }

/// The numbers below `count` by height(i), a finite float, then as they are.
template <class Height>
std::pmr::vector<uint32_t> orderBy(uint32_t count, std::pmr::memory_resource* memory, Height&& height) {
  std::pmr::vector<uint32_t> order(count, 0, memory);
  constexpr uint32_t kInserted = 12; // so few are put in one by one
  if (count <= kInserted) {
    for (uint32_t i = 0; i < count; ++i) {
      uint32_t at = i;
      for (const float y = height(i); at > 0 && height(order[at - 1]) > y; --at) order[at] = order[at - 1];
      order[at] = i;
    }
    return order;
  }
  std::pmr::vector<uint64_t> keys(count, 0, memory);
  for (uint32_t i = 0; i < count; ++i) keys[i] = heightKey(height(i), i);
  sortKeys(keys);
  for (uint32_t i = 0; i < count; ++i) order[i] = numberOfKey(keys[i]);
  return order;
}

/// The same, but of those of one height by less(i, k).
template <class Height, class Less>
std::pmr::vector<uint32_t> orderBy(uint32_t count, std::pmr::memory_resource* memory, Height&& height, Less&& less) {
  auto order = orderBy(count, memory, height);
  for (uint32_t first = 0, end; first < count; first = end) {
    const float y = height(order[first]);
    for (end = first + 1; end < count && height(order[end]) == y;) ++end;
    if (end > first + 1) std::sort(order.begin() + first, order.begin() + end, less);
  }
  return order;
}

} // namespace gpgp::vector
