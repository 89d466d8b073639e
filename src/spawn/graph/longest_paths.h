// Longest paths in a graph with edges of length 0 and 1: the least phases, where length 1 means one phase later.
//
// Lengths only grow, and no place's above the limit, so the work is at most linear in the edges times the limit, also
// where cycles have a length.
#pragma once
#include <cstdint>
#include <memory_resource>
#include <vector>

namespace gpgp::spawn {

/// length: by place, 0 where paths start; made. follow(place, reach) calls reach(place, 0 or 1) for each edge. False
/// where a path is longer than limit, as all are that go round a cycle with a length.
template <class Follow> bool longestPaths(std::pmr::vector<uint32_t>& length, uint32_t limit, const Follow& follow) {
  std::pmr::vector<uint32_t> changed(length.size(), length.get_allocator());
  for (uint32_t p = 0; p < changed.size(); ++p) changed[p] = static_cast<uint32_t>(changed.size()) - 1 - p;
  std::pmr::vector<uint8_t> listed(length.size(), 1, length.get_allocator());
  bool within = true;
  while (!changed.empty() && within) {
    const uint32_t from = changed.back();
    changed.pop_back();
    listed[from] = 0;
    follow(from, [&](uint32_t to, uint32_t step) {
      const uint32_t reached = length[from] + step;
      if (reached > limit) within = false;
      if (!within || reached <= length[to]) return;
      length[to] = reached;
      if (!listed[to]) changed.push_back(to);
      listed[to] = 1;
    });
  }
  return within;
}

} // namespace gpgp::spawn
