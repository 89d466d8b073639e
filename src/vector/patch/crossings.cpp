// Stage 2: where pieces of one path change sides.
//
// Two monotone pieces are compared over the rows they share inside one band. Boxes that do not overlap decide at once
// (pieces never turn, so end points bound them); else lines are solved directly, and curves between their inflections,
// where tangents and chords bound them. The work per pair is bounded, so coincident curves cannot stall it: what is
// undecided then differs by less than float distance anyway.
#include "vector/patch/drawing.h"
#include "vector/patch/strips.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector {
namespace {

/// A piece in a band: all of it where it is short, its part in the band's rows where it is long.
struct BandEntry {
  uint32_t piece, firstBand;
  bool isLong;
  double top, bottom, xMin, xMax;
};
constexpr uint32_t kLong = 4; // bands

/// Whether more boxes overlap in x than comparing them takes little time for. Of entries in the order of xMin.
bool crowded(const std::pmr::vector<BandEntry>& entries) {
  if (entries.size() <= 2 * kCrowd) return false;
  size_t overlaps = 0;
  for (size_t i = 0; i < entries.size(); ++i) {
    const auto end = std::upper_bound(entries.begin() + static_cast<ptrdiff_t>(i), entries.end(), entries[i].xMax,
                                      [](double x, const BandEntry& e) { return x < e.xMin; });
    overlaps += static_cast<size_t>(end - entries.begin()) - i - 1;
  }
  return overlaps > kCrowd * entries.size();
}

/// Looks for changes of sides between two pieces over rows in which neither has an inflection, so that each is convex
/// or concave as a function of y: between its tangents and its chord. Where these bounds keep the pieces apart there is
/// no change; where the slopes do, there is at most one, which bracketed Newton steps find. Everything else is halved,
/// a bounded number of times; what is left then has the change that its ends show.
class PairSearch {
public:
  PairSearch(const Monotone& a, const Monotone& b) : a_(a), b_(b) {}

  /// Calls found(y) for each change of sides between y0 and y1, rows of both.
  template <class Found> void run(double y0, double y1, Found&& found) {
    if (a_.curve.line && b_.curve.line) {
      const double d0 = b_.xAt(y0) - a_.xAt(y0), d1 = b_.xAt(y1) - a_.xAt(y1);
      if ((d0 >= 0) != (d1 >= 0)) found(y0 + (y1 - y0) * (d0 / (d0 - d1)));
      return;
    }
    Row from = row(y0);
    const Row last = row(y1);
    if (apart(from, last)) return;
    double turns[5];
    int count = 0;
    for (const Monotone* piece : {&a_, &b_}) {
      double heights[2];
      for (int i = piece->inflections(heights); i-- > 0;) {
        if (!(heights[i] > y0 && heights[i] < y1)) continue;
        int at = count++;
        for (; at > 0 && turns[at - 1] > heights[i]; --at) turns[at] = turns[at - 1];
        turns[at] = heights[i];
      }
    }
    turns[count++] = y1;
    int left = kHalvings;
    for (int i = 0; i < count; ++i) {
      const Row to = i + 1 == count ? last : row(turns[i]);
      const int share = left / (count - i);
      left += part(from, to, found, share) - share;
      from = to;
    }
  }

private:
  struct Row {
    double y;
    Monotone::Place a, b;
    double gap() const { return b.x - a.x; }
    bool left() const { return gap() >= 0; } // meeting counts as being left, so that a meeting is found once
  };
  Row row(double y) const {
    const auto [a, b] = placesAt(a_, y, b_, y);
    return {y, a, b};
  }
  /// Whether boxes alone say that there is no change.
  static bool apart(const Row& from, const Row& to) {
    const double aMin = std::min(from.a.x, to.a.x), aMax = std::max(from.a.x, to.a.x),
                 bMin = std::min(from.b.x, to.b.x), bMax = std::max(from.b.x, to.b.x);
    if (aMax < bMin || bMax < aMin) return true;
    return (aMax == bMin || bMax == aMin) && from.left() == to.left();
  }

  /// Halves as often as `left` says, and returns what is left of that. Each half gets a half of it, so that rows in
  /// which pieces run close beside each other, such as those from a common end, leave enough for the others.
  template <class Found> int part(const Row& from, const Row& to, Found& found, int left) {
    const bool changes = from.left() != to.left();
    if (apart(from, to)) return left;
    const double height = to.y - from.y, middle = 0.5 * (from.y + to.y);
    const double fine = std::max({std::abs(from.y), std::abs(to.y), 1e-30}) * 6e-8;
    if (height <= fine || middle <= from.y || middle >= to.y) {
      if (changes) found(middle);
      return left;
    }
    if (!changes && apart(from, to, height)) return left;
    const auto range = [](double u, double v) { return std::pair(std::min(u, v), std::max(u, v)); };
    const auto [aLow, aHigh] = range(from.a.slope, to.a.slope);
    const auto [bLow, bHigh] = range(from.b.slope, to.b.slope);
    const bool once = aHigh <= bLow || bHigh <= aLow; // the gap only grows, or only shrinks
    if (once || left == 0) {
      if (changes) found(from.gap() == 0 ? from.y : cross(from, to, fine));
      return left;
    }
    --left;
    const Row between = row(middle);
    const int unused = part(from, between, found, left - left / 2);
    return part(between, to, found, left / 2 + unused);
  }

  /// Whether bounds by tangents and chords keep the pieces on the sides that they have at the ends.
  static bool apart(const Row& from, const Row& to, double height) {
    const bool aLeft = from.gap() + to.gap() > 0;
    const auto& l0 = aLeft ? from.a : from.b;
    const auto& l1 = aLeft ? to.a : to.b;
    const auto& r0 = aLeft ? from.b : from.a;
    const auto& r1 = aLeft ? to.b : to.a;
    if (!(l0.x <= r0.x && l1.x <= r1.x)) return false;
    const double out = bulge(l0, l1, height, 1) + bulge(r0, r1, height, -1);
    return out < std::min(r0.x - l0.x, r1.x - l1.x) || (out == 0 && (r0.x > l0.x || r1.x > l1.x));
  }

  double cross(const Row& from, const Row& to, double fine) const {
    double low = from.y, high = to.y, y = low + (high - low) * (from.gap() / (from.gap() - to.gap()));
    const bool rises = to.gap() > from.gap();
    for (int i = 0; i < 60 && high - low > fine; ++i) {
      if (!(y > low && y < high)) y = 0.5 * (low + high);
      const Row at = row(y);
      ((at.gap() < 0) == rises ? low : high) = y;
      const double next = y - at.gap() / (at.b.slope - at.a.slope);
      if (std::abs(next - y) < 0.25 * fine) return std::clamp(next, low, high);
      y = next;
    }
    return std::clamp(y, low, high);
  }

  static constexpr int kHalvings = 200;
  const Monotone &a_, &b_;
};

} // namespace

core::Result<void> findCrossings(std::span<const Monotone> pieces, std::pmr::vector<Cut>& cuts) {
  if (pieces.size() < 2) return {};
  std::pmr::memory_resource* memory = cuts.get_allocator().resource();
  double top = pieces[0].top(), bottom = pieces[0].bottom(), heights = 0;
  for (const Monotone& piece : pieces) {
    top = std::min(top, piece.top());
    bottom = std::max(bottom, piece.bottom());
    heights += piece.bottom() - piece.top();
  }
  const double count = static_cast<double>(pieces.size());
  // A few are sorted at once sooner than dealt. Most pieces lie in one band: to deal them to more takes longer than to
  // compare them with more.
  const double wanted = count <= 96 ? 1 : std::clamp(0.5 * (bottom - top) / heights * count, 1.0, count);
  const uint32_t bands = static_cast<uint32_t>(wanted);
  const double height = (bottom - top) / bands;
  const auto bandOf = [&](double y) {
    return static_cast<uint32_t>(std::clamp((y - top) / height, 0.0, static_cast<double>(bands - 1)));
  };
  const auto bandTop = [&](uint32_t band) { return band == 0 ? top : top + height * band; };

  // Counting sort of (band, piece).
  struct Bands {
    uint32_t first = 0, last = 0;
  };
  std::pmr::vector<Bands> bandsOf(pieces.size(), Bands{}, memory);
  if (bands > 1)
    for (size_t i = 0; i < pieces.size(); ++i) bandsOf[i] = {bandOf(pieces[i].top()), bandOf(pieces[i].bottom())};
  std::pmr::vector<uint32_t> first(bands + 1, 0, memory);
  for (const Bands& of : bandsOf)
    for (uint32_t b = of.first; b <= of.last; ++b) ++first[b + 1];
  for (uint32_t b = 0; b < bands; ++b) first[b + 1] += first[b];
  std::pmr::vector<uint32_t> place(first.begin(), first.end(), memory);
  std::pmr::vector<uint32_t> dealt(first[bands], 0, memory);
  for (uint32_t i = 0; i < pieces.size(); ++i)
    for (uint32_t b = bandsOf[i].first; b <= bandsOf[i].last; ++b) dealt[place[b]++] = i;

  // Cuts lie on a grid as fine as float is at the path's largest coordinate: curves that meet in one point then have
  // one height in common there instead of several that differ by noise.
  int exponent = 0;
  std::frexp(std::max({std::abs(top), std::abs(bottom), 1e-30}), &exponent);
  const double grid = std::ldexp(1.0, exponent - 24);

  size_t crossings = 0, compared = 0;
  /// False where that has become too much.
  const auto compare = [&](uint32_t l, uint32_t r, double from, double to) {
    // The same way round in every band: a meeting exactly on a band's border counts for one of the two.
    if (l > r) std::swap(l, r);
    const Monotone &lp = pieces[l], &rp = pieces[r];
    if (++compared > kMaxCompared) return false;
    if (sideByHull(lp, rp) != 0) return true;
    PairSearch(lp, rp).run(from, to, [&](double y) {
      const float cut = static_cast<float>(std::round(y / grid) * grid);
      ++crossings;
      for (const uint32_t piece : {l, r})
        if (cut > pieces[piece].top() && cut < pieces[piece].bottom()) cuts.push_back({piece, cut});
    });
    return crossings <= kMaxCrossings;
  };
  const auto tooMuch = [&] {
    return crossings > kMaxCrossings
               ? core::makeError(GPGP_ERROR_UNSUPPORTED, "the path crosses itself more than %zu times", kMaxCrossings)
               : core::makeError(GPGP_ERROR_UNSUPPORTED, "more than %zu pairs of the path's curves run close together",
                                 kMaxCompared);
  };

  std::pmr::vector<BandEntry> entries(memory);
  for (uint32_t b = 0; b < bands; ++b) {
    const double y0 = bandTop(b), y1 = b + 1 == bands ? bottom : bandTop(b + 1);
    entries.clear();
    for (uint32_t i = first[b]; i < first[b + 1]; ++i) {
      const Monotone& piece = pieces[dealt[i]];
      const Bands of = bandsOf[dealt[i]];
      BandEntry entry{dealt[i], of.first, of.last - of.first > kLong, piece.top(), piece.bottom(), 0, 0};
      double p = piece.curve.p[0].x, q = piece.curve.p[3].x;
      if (entry.isLong) {
        entry.top = std::max(y0, entry.top), entry.bottom = std::min(y1, entry.bottom);
        if (!(entry.top < entry.bottom)) continue;
        p = piece.xAt(entry.top), q = piece.xAt(entry.bottom);
      }
      entry.xMin = std::min(p, q), entry.xMax = std::max(p, q);
      entries.push_back(entry);
    }
    std::sort(entries.begin(), entries.end(), [](const BandEntry& l, const BandEntry& r) {
      return l.xMin != r.xMin ? l.xMin < r.xMin : l.piece < r.piece;
    });
    if (crowded(entries)) {
      cuts.clear();
      crossings = compared = 0;
      if (!Strips(pieces, memory, compare).run(top, bottom)) return tooMuch();
      break;
    }
    for (size_t i = 0; i < entries.size(); ++i) {
      const double reach = entries[i].xMax;
      for (size_t j = i + 1; j < entries.size() && entries[j].xMin <= reach; ++j) {
        const BandEntry &l = entries[i], &r = entries[j];
        double from = std::max(l.top, r.top), to = std::min(l.bottom, r.bottom);
        if (!(from < to)) continue;
        if (l.isLong || r.isLong)
          from = std::max(from, y0), to = std::min(to, y1);
        else if (std::max(l.firstBand, r.firstBand) != b)
          continue; // two short ones meet once, in the first band that they share
        if (from < to && !compare(l.piece, r.piece, from, to)) return tooMuch();
      }
    }
  }
  std::sort(cuts.begin(), cuts.end(),
            [](const Cut& l, const Cut& r) { return l.piece != r.piece ? l.piece < r.piece : l.y < r.y; });
  cuts.erase(std::unique(cuts.begin(), cuts.end(),
                         [](const Cut& l, const Cut& r) { return l.piece == r.piece && l.y == r.y; }),
             cuts.end());
  return {};
}

} // namespace gpgp::vector
