// Which pieces of one path come near each other where many run side by side, as in hatching, waves or rings: there
// boxes overlap that pieces never leave for each other's side.
//
// Rows are halved until few pieces are near each other; in each strip a piece lies in a tube, its flattened segment
// with room for how far it bulges. Two tubes that lie in one order at both ends of the strip do not meet in it.
#pragma once
#include "vector/geometry/curve.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <span>

namespace gpgp::vector {

/// How far a piece bulges to one side of its flattened segment between two of its places without an inflection in
/// between: no more than where the tangents there meet.
inline double bulge(const Monotone::Place& p, const Monotone::Place& q, double height, double side) {
  const double flatSegment = (q.x - p.x) / height, u = side * (p.slope - flatSegment),
               v = side * (flatSegment - q.slope);
  if (!(u > 0 && v > 0)) return 0.0; // to the other side, or straight
  if (!(u < 1e30)) return v < 1e30 ? v * height : 1e30;
  if (!(v < 1e30)) return u * height;
  return u * v / (u + v) * height;
}

/// A piece has no more pairs than this in a band, on average, or strips are made.
constexpr size_t kCrowd = 64;

/// A piece's rows in a strip, and where it is at their ends.
struct StripPart {
  uint32_t piece;
  bool bends; ///< may have an inflection there
  double from, to;
  Monotone::Place first, last;
};

/// Calls near(part, part) for all pairs that may meet; each pair comes in as many strips as it is near in. Ends early
/// where that returns false.
template <class Near> class Strips {
public:
  Strips(std::span<const Monotone> pieces, std::pmr::memory_resource* memory, Near near)
      : pieces_(pieces), levels_(memory), tubes_(memory), before_(memory), near_(std::move(near)) {}

  bool run(double top, double bottom) {
    Parts all(levels_.get_allocator().resource());
    all.reserve(pieces_.size());
    for (uint32_t i = 0; i < pieces_.size(); ++i) {
      const Monotone& piece = pieces_[i];
      const double from = std::max(top, piece.top()), to = std::min(bottom, piece.bottom());
      all.push_back({i, false, from, to, piece.placeAt(from), piece.placeAt(to)});
    }
    return run(all, top, bottom, 0, 1);
  }

private:
  using Parts = std::pmr::vector<StripPart>;
  /// Between which x a part lies at the strip's ends, were it to go on so far.
  struct Tube {
    double topMin, topMax, bottomMin, bottomMax;
    const StripPart* part;
  };
  struct Level { // what strips of one height leave to halves of theirs, one strip after another
    explicit Level(std::pmr::memory_resource* memory) : above(memory), below(memory) {}
    Parts above, below;
  };

  /// `copies`: in how many strips of this height pieces lie, on average. Beyond kMaxCopies halving is no use.
  bool run(Parts& parts, double y0, double y1, size_t depth, double copies) {
    const double middle = 0.5 * (y0 + y1);
    tubes_.clear();
    for (StripPart& part : parts) tubes_.push_back(tubeOf(part, y0, y1));
    std::sort(tubes_.begin(), tubes_.end(), [](const Tube& l, const Tube& r) {
      return l.topMin != r.topMin ? l.topMin < r.topMin : l.part->piece < r.part->piece;
    });
    size_t left = kEnough * tubes_.size();
    const bool crowded = !eachNear([&](const Tube&, const Tube&) { return left-- > 0; });
    if (!crowded || !(middle > y0 && middle < y1) || copies > kMaxCopies)
      return eachNear([&](const Tube& a, const Tube& b) {
        return !(std::max(a.part->from, b.part->from) < std::min(a.part->to, b.part->to)) || near_(*a.part, *b.part);
      });
    if (levels_.size() == depth) levels_.emplace_back(levels_.get_allocator().resource());
    Level& level = levels_[depth];
    level.above.clear();
    level.below.clear();
    for (const Tube& t : tubes_) {
      const StripPart& part = *t.part;
      if (part.to <= middle) {
        level.above.push_back(part);
      } else if (part.from >= middle) {
        level.below.push_back(part);
      } else {
        const Monotone::Place between = pieces_[part.piece].placeAt(middle);
        level.above.push_back({part.piece, false, part.from, middle, part.first, between});
        level.below.push_back({part.piece, false, middle, part.to, between, part.last});
      }
    }
    copies *= static_cast<double>(level.above.size() + level.below.size()) / static_cast<double>(parts.size());
    return run(level.above, y0, middle, depth + 1, copies) && run(level.below, middle, y1, depth + 1, copies);
  }

  Tube tubeOf(StripPart& part, double y0, double y1) const {
    const Monotone& piece = pieces_[part.piece];
    const Monotone::Place &p = part.first, &q = part.last;
    Tube tube{0, 0, 0, 0, &part};
    const double height = part.to - part.from, wide = std::abs(q.x - p.x);
    const double noise = 1e-9 * (std::abs(p.x) + std::abs(q.x)); // more than places are off
    if (2 * height < y1 - y0) {                                  // going on so far would only take room
      part.bends = !piece.curve.line;
      tube.topMin = tube.bottomMin = std::min(p.x, q.x) - noise;
      tube.topMax = tube.bottomMax = std::max(p.x, q.x) + noise;
      return tube;
    }
    double inflections[2], low = 0, high = 0;
    part.bends = false;
    if (!piece.curve.line) {
      for (int k = piece.inflections(inflections); k-- > 0;)
        part.bends = part.bends || (inflections[k] > part.from && inflections[k] < part.to);
      low = part.bends ? wide : std::min(bulge(p, q, height, -1), wide);
      high = part.bends ? wide : std::min(bulge(p, q, height, 1), wide);
    }
    const double slope = (q.x - p.x) / height, top = p.x + slope * (y0 - part.from),
                 bottom = q.x + slope * (y1 - part.to);
    const double room = noise + 1e-9 * wide;
    tube.topMin = top - low - room, tube.topMax = top + high + room;
    tube.bottomMin = bottom - low - room, tube.bottomMax = bottom + high + room;
    return tube;
  }

  /// Of tubes in the order of topMin, all pairs but those that lie in one order at both ends. Takes as long as there
  /// are such pairs.
  template <class Pair> bool eachNear(Pair&& pair) {
    before_.clear(); // by where they end at the bottom
    for (const Tube& t : tubes_) {
      size_t place = before_.size();
      for (size_t k = before_.size(); k > 0 && before_[k - 1]->bottomMax >= t.bottomMin; --k) {
        if (before_[k - 1]->bottomMax > t.bottomMax) place = k - 1;
        if (!pair(*before_[k - 1], t)) return false;
      }
      before_.insert(before_.begin() + static_cast<ptrdiff_t>(place), &t);
    }
    for (size_t i = 0; i < tubes_.size(); ++i)
      for (size_t j = i + 1; j < tubes_.size() && tubes_[j].topMin <= tubes_[i].topMax; ++j)
        if (tubes_[i].bottomMax < tubes_[j].bottomMin && !pair(tubes_[i], tubes_[j])) return false;
    return true;
  }

  /// Comparing a pair takes somewhat longer than making a tube. 2, 4 and 8 take about as long.
  static constexpr size_t kEnough = 4;
  static constexpr double kMaxCopies = 64;
  std::span<const Monotone> pieces_;
  std::pmr::deque<Level> levels_;
  std::pmr::vector<Tube> tubes_;
  std::pmr::vector<const Tube*> before_;
  Near near_;
};

} // namespace gpgp::vector
