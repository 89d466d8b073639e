// How often pieces of one path cross at least, counted without looking for where.
//
// Between two heights, of the pieces that reach across, as many pairs have changed sides as there are inversions
// between their orders above and below, and merging counts those in n log n steps. What is missed are pairs that change
// sides twice between the heights, and pieces that begin or end there.
#pragma once
#include "vector/geometry/curve.h"

#include <algorithm>
#include <numeric>
#include <span>

namespace gpgp::vector {

/// Pairs (i, k) with i < k and values[i] > values[k]; leaves the values sorted. `room` becomes as large as they are.
inline size_t countInversions(std::pmr::vector<double>& values, std::pmr::vector<double>& room) {
  const size_t count = values.size();
  size_t inversions = 0;
  room.resize(count);
  for (size_t width = 1; width < count; width *= 2) {
    for (size_t first = 0; first < count; first += 2 * width) {
      const size_t middle = std::min(first + width, count), end = std::min(middle + width, count);
      size_t left = first, right = middle;
      for (size_t to = first; to < end; ++to) {
        const bool takeRight = left == middle || (right < end && values[right] < values[left]);
        if (takeRight) inversions += middle - left;
        room[to] = values[takeRight ? right++ : left++];
      }
    }
    values.swap(room);
  }
  return inversions;
}

/// No more than how often the pieces change sides between `top` and `bottom`, cut into `strips` rows of the same
/// height. Ends early beyond `limit`.
inline size_t leastCrossings(std::span<const Monotone> pieces, double top, double bottom, uint32_t strips, size_t limit,
                             std::pmr::memory_resource* memory) {
  struct Active {
    uint32_t piece;
    double above, below; ///< x at the rows' ends
  };
  std::pmr::vector<uint32_t> order(pieces.size(), 0, memory);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return pieces[a].top() < pieces[b].top(); });
  std::pmr::vector<Active> active(memory);
  std::pmr::vector<double> below(memory), room(memory);
  size_t next = 0, crossings = 0;
  for (uint32_t i = 0; i < strips && crossings <= limit; ++i) {
    const double y0 = top + (bottom - top) * i / strips, y1 = top + (bottom - top) * (i + 1) / strips;
    std::erase_if(active, [&](const Active& a) { return pieces[a.piece].bottom() < y1; });
    for (; next < order.size() && pieces[order[next]].top() <= y0; ++next)
      if (pieces[order[next]].bottom() >= y1) active.push_back({order[next], 0, pieces[order[next]].xAt(y0)});
    for (Active& a : active) {
      a.above = a.below;
      a.below = pieces[a.piece].xAt(y1);
    }
    std::sort(active.begin(), active.end(), [](const Active& l, const Active& r) {
      return l.above != r.above ? l.above < r.above : l.below < r.below;
    });
    below.clear();
    for (const Active& a : active) below.push_back(a.below);
    crossings += countInversions(below, room);
  }
  return crossings;
}

} // namespace gpgp::vector
