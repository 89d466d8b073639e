// Which pieces of one path come near each other where many run side by side, as in hatching, waves or rings: there
// boxes overlap that pieces never leave for each other's side.
//
// Rows are halved until few pieces are near each other; in each strip a piece lies in a tube, its chord with room for
// how far it bulges. Two tubes that lie in one order at both ends of the strip do not meet in it.
#pragma once
#include "vector/geometry/curve.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace gpgp::vector {

/// How far a piece bulges to one side of its chord between two of its places without an inflection in between: no more
/// than where the tangents there meet.
inline double bulge(const Monotone::Place& p, const Monotone::Place& q, double height, double side) {
  const double chord = (q.x - p.x) / height, u = side * (p.slope - chord), v = side * (chord - q.slope);
  if (!(u > 0 && v > 0)) return 0.0; // to the other side, or straight
  if (!(u < 1e30)) return v < 1e30 ? v * height : 1e30;
  if (!(v < 1e30)) return u * height;
  return u * v / (u + v) * height;
}

/// A piece has no more pairs than this in a band, on average, or strips are made.
constexpr size_t kCrowd = 64;

/// Calls near(piece, piece, from, to) for all pairs that may meet, with rows of both; each pair has its rows in as many
/// strips as it is near in. Ends early where that returns false.
template <class Near> class Strips {
public:
  Strips(std::span<const Monotone> pieces, std::pmr::memory_resource* memory, Near near)
      : pieces_(pieces), memory_(memory), near_(std::move(near)) {}

  bool run(double top, double bottom) {
    Pieces all(pieces_.size(), 0, memory_);
    std::iota(all.begin(), all.end(), 0u);
    return run(all, top, bottom, 1);
  }

private:
  using Pieces = std::pmr::vector<uint32_t>;
  /// A piece's rows in a strip, and between which x it lies at the strip's ends, were it to go on so far.
  struct Tube {
    uint32_t piece;
    double from, to;
    double topMin, topMax, bottomMin, bottomMax;
  };
  /// `copies`: in how many strips of this height pieces lie, on average. Beyond kMaxCopies halving is no use.
  bool run(const Pieces& which, double y0, double y1, double copies) {
    Pieces above(memory_), below(memory_);
    const double middle = 0.5 * (y0 + y1);
    {
      std::pmr::vector<Tube> tubes(memory_);
      tubes.reserve(which.size());
      for (const uint32_t i : which) tubes.push_back(tubeOf(i, y0, y1));
      std::sort(tubes.begin(), tubes.end(), [](const Tube& l, const Tube& r) {
        return l.topMin != r.topMin ? l.topMin < r.topMin : l.piece < r.piece;
      });
      size_t left = kEnough * tubes.size();
      const bool crowded = !eachNear(tubes, [&](const Tube&, const Tube&) { return left-- > 0; });
      if (!crowded || !(middle > y0 && middle < y1) || copies > kMaxCopies)
        return eachNear(tubes, [&](const Tube& a, const Tube& b) {
          const double from = std::max(a.from, b.from), to = std::min(a.to, b.to);
          return !(from < to) || near_(a.piece, b.piece, from, to);
        });
      for (const Tube& t : tubes) {
        if (t.from < middle) above.push_back(t.piece);
        if (t.to > middle) below.push_back(t.piece);
      }
    }
    copies *= static_cast<double>(above.size() + below.size()) / static_cast<double>(which.size());
    return run(above, y0, middle, copies) && run(below, middle, y1, copies);
  }

  Tube tubeOf(uint32_t i, double y0, double y1) const {
    const Monotone& piece = pieces_[i];
    Tube tube{i, std::max(y0, piece.top()), std::min(y1, piece.bottom()), 0, 0, 0, 0};
    const Monotone::Place p = piece.placeAt(tube.from), q = piece.placeAt(tube.to);
    const double height = tube.to - tube.from, wide = std::abs(q.x - p.x);
    const double noise = 1e-9 * (std::abs(p.x) + std::abs(q.x)); // more than places are off
    if (2 * height < y1 - y0) {                                  // going on so far would only take room
      tube.topMin = tube.bottomMin = std::min(p.x, q.x) - noise;
      tube.topMax = tube.bottomMax = std::max(p.x, q.x) + noise;
      return tube;
    }
    double inflections[2], low = 0, high = 0;
    if (!piece.curve.line) {
      bool bends = false;
      for (int k = piece.inflections(inflections); k-- > 0;)
        bends = bends || (inflections[k] > tube.from && inflections[k] < tube.to);
      low = bends ? wide : std::min(bulge(p, q, height, -1), wide);
      high = bends ? wide : std::min(bulge(p, q, height, 1), wide);
    }
    const double slope = (q.x - p.x) / height, top = p.x + slope * (y0 - tube.from),
                 bottom = q.x + slope * (y1 - tube.to);
    const double room = noise + 1e-9 * wide;
    tube.topMin = top - low - room, tube.topMax = top + high + room;
    tube.bottomMin = bottom - low - room, tube.bottomMax = bottom + high + room;
    return tube;
  }

  /// Of tubes in the order of topMin, all pairs but those that lie in one order at both ends. Takes as long as there
  /// are such pairs.
  template <class Pair> bool eachNear(const std::pmr::vector<Tube>& tubes, Pair&& pair) const {
    std::pmr::vector<const Tube*> before(memory_); // by where they end at the bottom
    before.reserve(tubes.size());
    for (const Tube& t : tubes) {
      size_t place = before.size();
      for (size_t k = before.size(); k > 0 && before[k - 1]->bottomMax >= t.bottomMin; --k) {
        if (before[k - 1]->bottomMax > t.bottomMax) place = k - 1;
        if (!pair(*before[k - 1], t)) return false;
      }
      before.insert(before.begin() + static_cast<ptrdiff_t>(place), &t);
    }
    for (size_t i = 0; i < tubes.size(); ++i)
      for (size_t j = i + 1; j < tubes.size() && tubes[j].topMin <= tubes[i].topMax; ++j)
        if (tubes[i].bottomMax < tubes[j].bottomMin && !pair(tubes[i], tubes[j])) return false;
    return true;
  }

  /// Comparing a pair takes somewhat longer than making a tube. 2, 4 and 8 take about as long.
  static constexpr size_t kEnough = 4;
  static constexpr double kMaxCopies = 64;
  std::span<const Monotone> pieces_;
  std::pmr::memory_resource* memory_;
  Near near_;
};

} // namespace gpgp::vector
