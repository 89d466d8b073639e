// How much of the GPU's memory a drawing's outlines take and how often its paths cross themselves, known while the
// drawing is made: what a device cannot bind, or what takes too long, is refused then, not when all of it is converted.
#pragma once
#include "core/result.h"
#include "vector/geometry/curve.h"
#include "vector/shared/layout.h"

#include <gpgp/vector.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <span>

namespace gpgp::vector {

/// In how many buffers the outlines of a drawing may lie.
constexpr uint32_t kMaxOutlineBuffers = 4;
/// How many bytes they may have, by what the device binds at once; 0: what any device does.
constexpr uint64_t outlineBytes(uint32_t maxStorageBufferRange) {
  return uint64_t(maxStorageBufferRange ? maxStorageBufferRange : UINT32_MAX) * kMaxOutlineBuffers;
}

/// How often all paths of a drawing together may cross themselves. A second on one processor finds about a million.
constexpr uint64_t kMaxDrawingCrossings = uint64_t(1) << 23;

/// What outlines may take. Paths that are converted side by side take from the same room.
class OutlineRoom {
public:
  explicit OutlineRoom(uint64_t bytes = outlineBytes(0), uint64_t crossings = kMaxDrawingCrossings)
      : bytes_(bytes), mostCrossings_(crossings) {}

  /// Whether there is room for so many segments besides those that were taken.
  bool has(uint64_t segments) const { return taken_.load(std::memory_order_relaxed) + segments <= most(); }
  bool take(uint64_t segments) { return taken_.fetch_add(segments, std::memory_order_relaxed) + segments <= most(); }
  uint64_t left() const {
    const uint64_t taken = taken_.load(std::memory_order_relaxed);
    return taken < most() ? most() - taken : 0;
  }
  /// Whether paths may cross themselves so often besides those that were counted.
  bool allowsCrossings(uint64_t crossings) const {
    return crossings_.load(std::memory_order_relaxed) + crossings <= mostCrossings_;
  }
  void countCrossings(uint64_t crossings) { crossings_.fetch_add(crossings, std::memory_order_relaxed); }
  core::Error crossingsError() const {
    return core::makeError(GPGP_ERROR_UNSUPPORTED, "the drawing's paths cross themselves more than %llu times in all",
                           static_cast<unsigned long long>(mostCrossings_));
  }
  core::Error error() const {
    return core::makeError(GPGP_ERROR_UNSUPPORTED,
                           "the drawing's outlines need more than %llu bytes, which is what a recording can bind",
                           static_cast<unsigned long long>(bytes_));
  }

private:
  uint64_t most() const { return bytes_ / sizeof(shader::SegmentRecord); }
  uint64_t bytes_, mostCrossings_;
  std::atomic<uint64_t> taken_{0}, crossings_{0};
};

/// Sorts what is most often nearly in order, as pieces are from one row to the next.
template <class Values, class Less> void sortNearly(Values& values, Less&& less) {
  size_t moves = 16 * values.size(); // beyond that it is not
  for (size_t i = 1; i < values.size(); ++i) {
    const auto value = values[i];
    size_t at = i;
    for (; at > 0 && less(value, values[at - 1]); --at) values[at] = values[at - 1];
    values[at] = value;
    if (i - at > moves) return std::sort(values.begin(), values.end(), less);
    moves -= i - at;
  }
}

/// No more than how many segments the outline of the pieces' region has, without looking for crossings: a piece has one
/// for each time that it begins to bound the region, or to bound it on its other side, from one row of many to the
/// next. Rows are as many as look at `places` of pieces; the default takes a tenth of a second or two. Ends early
/// beyond `limit`.
constexpr uint64_t kMostPlaces = 1 << 23;
inline uint64_t leastSegments(std::span<const Monotone> pieces, GpgpFillRule rule, uint64_t limit,
                              std::pmr::memory_resource* memory, uint64_t places = kMostPlaces) {
  struct Active {
    const Monotone* piece;
    double x, step, bottom; ///< step: to the next row; of a line in x, else of the curve's parameter t
    double t;
    int winding;
    bool line;
    int8_t side; ///< of the piece that lies inside, in the row above; 0: both or none
  };
  constexpr double kMostRows = 1 << 14;
  double top = INFINITY, bottom = -INFINITY, heights = 0;
  for (const Monotone& piece : pieces) {
    top = std::min(top, piece.top());
    bottom = std::max(bottom, piece.bottom());
    heights += piece.bottom() - piece.top();
  }
  if (!(bottom > top)) return 0;
  const double beside = std::max(heights / (bottom - top), 1.0); // pieces in a row
  const uint32_t rows = static_cast<uint32_t>(std::clamp(static_cast<double>(places) / beside, 1.0, kMostRows));
  std::pmr::vector<uint32_t> order(pieces.size(), 0, memory);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return pieces[a].top() < pieces[b].top(); });
  std::pmr::vector<Active> active(memory);
  size_t next = 0;
  uint64_t segments = 0;
  for (uint32_t i = 0; i < rows && segments <= limit; ++i) {
    const double y = top + (bottom - top) * (i + 0.5) / rows;
    std::erase_if(active, [&](const Active& a) { return a.bottom <= y; });
    for (Active& a : active) {
      if (a.line) {
        a.x += a.step;
        continue;
      }
      const double before = a.t;
      a.x = a.piece->xNear(y, a.t += a.step);
      a.step = a.t - before;
    }
    for (; next < order.size() && pieces[order[next]].top() <= y; ++next) {
      const Monotone& piece = pieces[order[next]];
      const Point* p = piece.curve.p;
      if (!(piece.bottom() > y)) continue;
      const double step = (p[3].x - p[0].x) / (p[3].y - p[0].y) * ((bottom - top) / rows);
      const Monotone::Place at = piece.placeAt(y);
      active.push_back(
          {&piece, at.x, piece.curve.line ? step : 0, piece.bottom(), at.t, piece.winding, piece.curve.line, 0});
    }
    sortNearly(active, [](const Active& l, const Active& r) { return l.x < r.x; });
    // Which of two that are as good as one comes first is not known: neither counts.
    const auto same = [](double a, double b) { return b - a <= 1e-6 * (std::abs(a) + std::abs(b)); };
    const auto inside = [rule](int winding) { return rule == GPGP_FILL_EVEN_ODD ? winding % 2 != 0 : winding != 0; };
    int winding = 0;
    for (size_t k = 0; k < active.size(); ++k) {
      const bool before = inside(winding);
      winding += active[k].winding;
      const auto side = static_cast<int8_t>(inside(winding) - before);
      if ((k > 0 && same(active[k - 1].x, active[k].x)) ||
          (k + 1 < active.size() && same(active[k].x, active[k + 1].x)))
        continue;
      segments += side != 0 && side != active[k].side;
      active[k].side = side;
    }
  }
  return segments;
}

} // namespace gpgp::vector
