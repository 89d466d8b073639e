// Stage 2: where pieces of one path change sides.
//
// Two monotone pieces are compared over the rows they share inside one band. Boxes that do not overlap decide at once
// (pieces never turn, so end points bound them); else lines are solved directly and curves are bisected until their
// boxes part or the rows are as fine as float. The work per pair is bounded, so coincident curves cannot stall it:
// what is undecided then differs by less than float distance anyway.
#include "vector/patch/drawing.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector {
namespace {

struct BandEntry {
  uint32_t piece;
  double top, bottom, xTop, xBottom;
  double xMin() const { return std::min(xTop, xBottom); }
  double xMax() const { return std::max(xTop, xBottom); }
};

class PairSearch {
public:
  PairSearch(const Monotone& a, const Monotone& b) : a_(a), b_(b) {}
  /// The rows [y0, y1] with both pieces' x at either end. Calls found(y) for each change of sides.
  template <class Found> void run(double y0, double a0, double b0, double y1, double a1, double b1, Found&& found) {
    const double aMax = std::max(a0, a1), aMin = std::min(a0, a1), bMax = std::max(b0, b1), bMin = std::min(b0, b1);
    if (aMax < bMin || bMax < aMin) return;
    const double d0 = b0 - a0, d1 = b1 - a1;
    const bool changes = (d0 >= 0) != (d1 >= 0); // meeting counts as being left, so that a meeting is found once
    if (!changes && (aMax == bMin || bMax == aMin)) return;
    if (a_.curve.line && b_.curve.line) {
      if (changes) found(y0 + (y1 - y0) * (d0 / (d0 - d1)));
      return;
    }
    const double middle = 0.5 * (y0 + y1);
    const double fine = std::max({std::abs(y0), std::abs(y1), 1e-30}) * 6e-8;
    if (budget_ == 0 || y1 - y0 <= fine || middle <= y0 || middle >= y1) {
      if (changes) found(middle);
      return;
    }
    --budget_;
    const double am = a_.xAt(middle), bm = b_.xAt(middle);
    run(y0, a0, b0, middle, am, bm, found);
    run(middle, am, bm, y1, a1, b1, found);
  }

private:
  const Monotone &a_, &b_;
  int budget_ = 400;
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
  const double wanted = std::clamp((bottom - top) / heights * count, 1.0, count);
  const uint32_t bands = static_cast<uint32_t>(wanted);
  const double height = (bottom - top) / bands;
  const auto bandOf = [&](double y) {
    return static_cast<uint32_t>(std::clamp((y - top) / height, 0.0, static_cast<double>(bands - 1)));
  };
  const auto bandTop = [&](uint32_t band) { return band == 0 ? top : top + height * band; };

  // Counting sort of (band, piece).
  std::pmr::vector<uint32_t> first(bands + 1, 0, memory);
  for (const Monotone& piece : pieces)
    for (uint32_t b = bandOf(piece.top()), end = bandOf(piece.bottom()); b <= end; ++b) ++first[b + 1];
  for (uint32_t b = 0; b < bands; ++b) first[b + 1] += first[b];
  std::pmr::vector<uint32_t> place(first.begin(), first.end(), memory);
  std::pmr::vector<uint32_t> dealt(first[bands], 0, memory);
  for (uint32_t i = 0; i < pieces.size(); ++i)
    for (uint32_t b = bandOf(pieces[i].top()), end = bandOf(pieces[i].bottom()); b <= end; ++b) dealt[place[b]++] = i;

  // Cuts lie on a grid as fine as float is at the path's largest coordinate: curves that meet in one point then have
  // one height in common there instead of several that differ by noise.
  int exponent = 0;
  std::frexp(std::max({std::abs(top), std::abs(bottom), 1e-30}), &exponent);
  const double grid = std::ldexp(1.0, exponent - 24);

  std::pmr::vector<BandEntry> entries(memory);
  size_t crossings = 0;
  for (uint32_t b = 0; b < bands; ++b) {
    const double y0 = bandTop(b), y1 = b + 1 == bands ? bottom : bandTop(b + 1);
    entries.clear();
    for (uint32_t i = first[b]; i < first[b + 1]; ++i) {
      const Monotone& piece = pieces[dealt[i]];
      const double pieceTop = std::max(y0, piece.top()), pieceBottom = std::min(y1, piece.bottom());
      if (pieceTop < pieceBottom)
        entries.push_back({dealt[i], pieceTop, pieceBottom, piece.xAt(pieceTop), piece.xAt(pieceBottom)});
    }
    std::sort(entries.begin(), entries.end(), [](const BandEntry& l, const BandEntry& r) {
      return l.xMin() != r.xMin() ? l.xMin() < r.xMin() : l.piece < r.piece;
    });
    for (size_t i = 0; i < entries.size(); ++i) {
      const double reach = entries[i].xMax();
      for (size_t j = i + 1; j < entries.size() && entries[j].xMin() <= reach; ++j) {
        // The same way round in every band: a meeting exactly on a band's border counts for one of the two.
        const bool inOrder = entries[i].piece < entries[j].piece;
        const BandEntry &l = entries[inOrder ? i : j], &r = entries[inOrder ? j : i];
        const double from = std::max(l.top, r.top), to = std::min(l.bottom, r.bottom);
        if (!(from < to)) continue;
        const Monotone &lp = pieces[l.piece], &rp = pieces[r.piece];
        PairSearch(lp, rp).run(from, from == l.top ? l.xTop : lp.xAt(from), from == r.top ? r.xTop : rp.xAt(from), to,
                               to == l.bottom ? l.xBottom : lp.xAt(to), to == r.bottom ? r.xBottom : rp.xAt(to),
                               [&](double y) {
                                 const float cut = static_cast<float>(std::round(y / grid) * grid);
                                 ++crossings;
                                 for (const uint32_t piece : {l.piece, r.piece})
                                   if (cut > pieces[piece].top() && cut < pieces[piece].bottom())
                                     cuts.push_back({piece, cut});
                               });
        if (crossings > kMaxCrossings)
          return core::makeError(GPGP_ERROR_UNSUPPORTED, "the path crosses itself more than %zu times", kMaxCrossings);
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
