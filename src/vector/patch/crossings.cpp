// Stage 2: where pieces of one path change sides.
//
// Two monotone pieces are compared over the rows they share inside one band. Boxes that do not overlap decide at once
// (pieces never turn, so end points bound them); else lines are solved directly, and curves between their inflections,
// where tangents and flattened segments bound them. The work per pair is bounded, so coincident curves cannot stall it:
// what is undecided then differs by less than float distance anyway.
#include "vector/geometry/order.h"
#include "vector/patch/drawing.h"
#include "vector/patch/inversions.h"
#include "vector/patch/strips.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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
/// or concave as a function of y: between its tangents and its flatSegment. Where these bounds keep the pieces apart
/// there is no change; where the slopes do, there is at most one, which bracketed Newton steps find. Everything else is
/// halved, a bounded number of times; what is left then has the change that its ends show.
class PairSearch {
public:
  PairSearch(const Monotone& a, const Monotone& b) : a_(a), b_(b) {}

  struct Row {
    double y;
    Monotone::Place a, b;
    double gap() const { return b.x - a.x; }
    bool left() const { return gap() >= 0; } // meeting counts as being left, so that a meeting is found once
  };
  Row row(double y) {
    ++rows_;
    const auto [a, b] = placesAt(a_, y, b_, y);
    return {y, a, b};
  }
  /// Where places are known they are taken.
  Row row(double y, const Monotone::Place* a, const Monotone::Place* b) {
    if (!a && !b) return row(y);
    rows_ += !a || !b;
    return {y, a ? *a : a_.placeAt(y), b ? *b : b_.placeAt(y)};
  }
  size_t rows() const { return rows_; } ///< evaluated

  /// Whether boxes alone say that there is no change.
  static bool apart(const Row& from, const Row& to) {
    const double aMin = std::min(from.a.x, to.a.x), aMax = std::max(from.a.x, to.a.x),
                 bMin = std::min(from.b.x, to.b.x), bMax = std::max(from.b.x, to.b.x);
    if (aMax < bMin || bMax < aMin) return true;
    return (aMax == bMin || bMax == aMin) && from.left() == to.left();
  }

  /// Calls found(y) for each change of sides between two rows of both. `bends`: whether one may have an inflection in
  /// between.
  template <class Found> void run(Row from, const Row& last, bool bends, Found&& found) {
    const double y0 = from.y, y1 = last.y;
    if (a_.curve.line && b_.curve.line) {
      const double d0 = from.gap(), d1 = last.gap();
      if ((d0 >= 0) != (d1 >= 0)) found(y0 + (y1 - y0) * (d0 / (d0 - d1)));
      return;
    }
    if (apart(from, last)) return;
    double turns[5];
    int count = 0;
    if (bends)
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

  /// Whether bounds by tangents and flattened segments keep the pieces on the sides that they have at the ends.
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

  double cross(const Row& from, const Row& to, double fine) {
    const double share = guess(from, to);
    const auto between = [share](double t0, double t1) { return t0 + (t1 - t0) * share; };
    if (const auto met = crossingNear(a_, b_, {between(from.a.t, to.a.t), between(from.b.t, to.b.t)}, fine);
        met && *met >= from.y && *met <= to.y)
      return *met;
    double low = from.y, high = to.y, y = between(low, high);
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

  /// About where the gap is nothing, as a share of the rows: of a line, and where slopes are near the line's, of the
  /// cubic with the same slopes at the ends.
  static double guess(const Row& from, const Row& to) {
    const double height = to.y - from.y, g0 = from.gap(), all = to.gap() - g0;
    const double m0 = (from.b.slope - from.a.slope) * height / all, m1 = (to.b.slope - to.a.slope) * height / all;
    const double line = -g0 / all;
    if (!(m0 > 0.5 && m0 < 2 && m1 > 0.5 && m1 < 2)) return line;
    const double c2 = 3 - 2 * m0 - m1, c3 = m0 + m1 - 2; // of (gap - g0) / all, which grows from 0 to 1
    double t = line;
    for (int i = 0; i < 2; ++i) t -= (((c3 * t + c2) * t + m0) * t - line) / ((3 * c3 * t + 2 * c2) * t + m0);
    return t;
  }

  static constexpr int kHalvings = 200;
  const Monotone &a_, &b_;
  size_t rows_ = 0;
};

/// By height, then by piece, each once.
void sortCuts(std::pmr::vector<Cut>& cuts) {
  sortKeys(cuts);
  auto last = cuts.begin();
  for (auto first = cuts.begin(), end = first; first != cuts.end(); first = end) {
    const uint64_t height = *first >> 32;
    for (end = first + 1; end != cuts.end() && *end >> 32 == height;) ++end;
    if (!std::is_sorted(first, end)) std::sort(first, end);
    last = std::unique_copy(first, end, last);
  }
  cuts.erase(last, cuts.end());
}

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

  size_t crossings = 0, work = 0;
  const auto isLittle = [&] {
    return crossings <= kMaxCrossings && work <= kMaxWork + kWorkOfPiece * pieces.size() + kWorkOfCrossing * crossings;
  };
  /// False where that has become too much, as below. The same way round in every band: a meeting exactly on a band's
  /// border counts for one of the two.
  const auto search = [&](PairSearch& pair, uint32_t l, uint32_t r, const PairSearch::Row& from,
                          const PairSearch::Row& to, bool bends) {
    pair.run(from, to, bends, [&](double y) {
      const float cut = static_cast<float>(std::round(y / grid) * grid);
      ++crossings;
      for (const uint32_t piece : {l, r})
        if (cut > pieces[piece].top() && cut < pieces[piece].bottom()) cuts.push_back(heightKey(cut, piece));
    });
    work += kWorkOfRow * pair.rows();
    return isLittle();
  };
  const auto compare = [&](uint32_t l, uint32_t r, double from, double to) {
    if (l > r) std::swap(l, r);
    ++work;
    if (sideByHull(pieces[l], pieces[r]) != 0) return isLittle();
    PairSearch pair(pieces[l], pieces[r]);
    const PairSearch::Row above = pair.row(from);
    return search(pair, l, r, above, pair.row(to), true);
  };
  const auto compareParts = [&](const StripPart& a, const StripPart& b) {
    const StripPart &l = a.piece < b.piece ? a : b, &r = a.piece < b.piece ? b : a;
    ++work;
    PairSearch pair(pieces[l.piece], pieces[r.piece]);
    const double from = std::max(l.from, r.from), to = std::min(l.to, r.to);
    const PairSearch::Row above =
                              pair.row(from, l.from == from ? &l.first : nullptr, r.from == from ? &r.first : nullptr),
                          below = pair.row(to, l.to == to ? &l.last : nullptr, r.to == to ? &r.last : nullptr);
    // Pieces that change sides overlap; only where they do not, or just meet, there is something to save.
    if ((above.left() == below.left() || above.gap() == 0 || below.gap() == 0) &&
        (PairSearch::apart(above, below) || sideByHull(pieces[l.piece], pieces[r.piece]) != 0)) {
      work += kWorkOfRow * pair.rows();
      return isLittle();
    }
    return search(pair, l.piece, r.piece, above, below, l.bends || r.bends);
  };
  const auto tooMuch = [&] {
    return crossings > kMaxCrossings
               ? core::makeError(GPGP_ERROR_UNSUPPORTED, "the path crosses itself more than %zu times", kMaxCrossings)
               : core::makeError(GPGP_ERROR_UNSUPPORTED, "too many of the path's curves run close together");
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
      // What has too many is refused before they are looked for: a few strips tell most, more those in doubt.
      crossings = leastCrossings(pieces, top, bottom, 32, kMaxCrossings, memory);
      if (crossings > kMaxCrossings / 2) crossings = leastCrossings(pieces, top, bottom, 256, kMaxCrossings, memory);
      if (crossings > kMaxCrossings) return tooMuch();
      cuts.clear();
      cuts.reserve(crossings * 5 / 2); // two each; strips tell most
      crossings = work = 0;
      if (!Strips(pieces, memory, compareParts).run(top, bottom)) return tooMuch();
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
  sortCuts(cuts);
  return {};
}

} // namespace gpgp::vector
