// Stage 3: a sweep from top to bottom that turns pieces into slabs.
//
// The status is the list of pieces that the sweep line meets, ordered by x (status.h). A piece is there with one of its
// edges, its part between two cuts. Between cuts no two edges change sides, so two edges are ordered by comparing them
// in the middle of the rows they share, which is safe where they touch at an end; nothing is ever compared on the sweep
// line itself. At each height all edges that end leave, all that begin enter, and only around those places windings and
// slabs are worked out again. Slots where the inside begins or ends are marked, so that what bounds a slab is found
// however many edges lie inside of it. A slab stays open while the pair of pieces that bounds it stays the same,
// whatever happens outside or inside of it. All that is kept is by piece: it is as much as there are pieces, not as
// there are cuts.
#include "vector/geometry/order.h"
#include "vector/patch/drawing.h"
#include "vector/patch/status.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gpgp::vector {
namespace {

constexpr uint32_t kNone = UINT32_MAX;

class Sweep {
public:
  Sweep(std::span<const Monotone> pieces, GpgpFillRule rule, std::pmr::vector<Slab>& slabs)
      : pieces_(pieces), rule_(rule), slabs_(slabs), memory_(slabs.get_allocator().resource()),
        status_(static_cast<uint32_t>(pieces.size()), memory_), pieceAt_(pieces.size(), 0, memory_),
        states_(pieces.size(), State{}, memory_), open_(pieces.size(), Open{}, memory_), ends_(memory_),
        begins_(memory_), block_(memory_), touched_(memory_), runs_(memory_), starts_(memory_),
        slabsBefore_(slabs.size()) {}

  core::Result<void> run(std::span<const Cut> cuts) {
    const uint32_t count = static_cast<uint32_t>(pieces_.size());
    for (uint32_t i = 0; i < count; ++i) {
      states_[i].edge = newEdge_++;
      states_[i].top = static_cast<float>(pieces_[i].top());
      states_[i].bottom = static_cast<float>(pieces_[i].bottom());
    }
    // Where each crossing is a corner of the region there are about three slabs for two of them.
    if (rule_ == GPGP_FILL_EVEN_ODD) slabs_.reserve(slabs_.size() + cuts.size() * 4 / 5 + count);
    // Beside each cut where the edge that it begins ends, so that cuts are read in a row: each piece's own lie far
    // apart where there are millions.
    std::pmr::vector<float> bottomsOfCuts(cuts.size(), 0, memory_);
    for (size_t i = cuts.size(); i-- > 0;)
      bottomsOfCuts[i] = std::exchange(states_[numberOfKey(cuts[i])].bottom, heightOfKey(cuts[i]));
    const auto tops = orderBy(count, memory_, [this](uint32_t i) { return static_cast<float>(pieces_[i].top()); });
    const auto bottoms =
        orderBy(count, memory_, [this](uint32_t i) { return static_cast<float>(pieces_[i].bottom()); });
    uint32_t top = 0, bottom = 0;
    size_t cut = 0;
    while (bottom < count) {
      y_ = static_cast<float>(pieces_[bottoms[bottom]].bottom());
      if (top < count) y_ = std::min(y_, static_cast<float>(pieces_[tops[top]].top()));
      if (cut < cuts.size()) y_ = std::min(y_, heightOfKey(cuts[cut]));
      ++batch_;
      starts_.clear();
      touched_.clear();
      ends_.clear();
      begins_.clear();
      for (; cut < cuts.size() && heightOfKey(cuts[cut]) == y_; ++cut) goOn(numberOfKey(cuts[cut]), bottomsOfCuts[cut]);
      for (; bottom < count && static_cast<float>(pieces_[bottoms[bottom]].bottom()) == y_; ++bottom)
        ends_.push_back(bottoms[bottom]);
      for (; top < count && static_cast<float>(pieces_[tops[top]].top()) == y_; ++top) begins_.push_back(tops[top]);
      advance();
      repair();
      update();
      tidySlabs();
      if (levelCrossings_ > kMaxLevelCrossings)
        return core::makeError(GPGP_ERROR_UNSUPPORTED, "level lines of the path cross its others more than %zu times",
                               kMaxLevelCrossings);
    }
    if (openSlabs_) std::erase_if(slabs_, [](const Slab& slab) { return slab.bottom == slab.top; });
    return {};
  }

private:
  /// A piece in the sweep, with one of its edges.
  struct State {
    uint32_t edge = 0; ///< a number that no other has
    float top = 0, bottom = 0;
    uint32_t slot = kNone;
    int winding = 0;                 ///< right of it
    uint32_t dirty = 0, visited = 0; ///< batch numbers
    uint32_t known = kNone;          ///< an edge that is right of it
  };
  struct Open { // the slab whose left side is a piece
    uint32_t right = 0, batch = 0;
    size_t slab = kNoSlab;
    bool active() const { return slab != kNoSlab; }
  };
  static constexpr size_t kNoSlab = SIZE_MAX;

  struct Run { // slots
    uint32_t first, last;
    bool bounds = false;
  };

  /// A piece's next edge takes the place of the one that ends at a cut. repair() sees to it that the place is right.
  void goOn(uint32_t piece, float bottom) {
    State& state = states_[piece];
    state.edge = newEdge_++;
    state.top = y_;
    state.bottom = bottom;
    state.known = kNone;
    markDirty(piece);
  }

  /// Pieces that end leave, those that begin enter. Most often one begins where another ends; it then takes that one's
  /// place.
  void advance() {
    constexpr size_t kFew = 8; // more are sorted in, which is cheaper than trying all pairs and swapping many
    went_ = starts_.size();
    if (ends_.size() <= kFew && begins_.size() <= kFew) {
      for (uint32_t& end : ends_)
        for (uint32_t& begin : begins_) {
          if (begin == kNone || !(pieces_[end].curve.p[3] == pieces_[begin].curve.p[0])) continue;
          touched_.push_back(end);
          enter(begin, std::exchange(states_[end].slot, kNone));
          end = begin = kNone;
          break;
        }
    }
    for (const uint32_t end : ends_)
      if (end != kNone) remove(end);
    if (went_ > kFew) sortTogether();
    for (const uint32_t begin : begins_)
      if (begin != kNone) insert(begin);
  }

  /// Where many edges went on at once, those beside each other are put in order, so that repair() finds little to do
  /// where they all meet in one point.
  void sortTogether() {
    constexpr uint32_t kFew = 4; // are left to repair()
    for (size_t i = 0; i < starts_.size(); ++i) {
      uint32_t slot = states_[starts_[i]].slot;
      if (slot == kNone) continue;
      const uint32_t before = status_.before(slot);
      if (before != status_.end() && states_[pieceAt_[before]].dirty == batch_) continue;
      uint32_t length = 0;
      block_.clear();
      for (uint32_t at = slot; at != status_.end() && states_[pieceAt_[at]].dirty == batch_; at = status_.after(at))
        ++length;
      if (length <= kFew) continue;
      for (uint32_t at = slot, k = 0; k < length; ++k, at = status_.after(at)) {
        const uint32_t piece = pieceAt_[at];
        block_.insert(std::upper_bound(block_.begin(), block_.end(), piece,
                                       [this](uint32_t a, uint32_t b) { return leftOf(a, b); }),
                      piece);
      }
      for (const uint32_t piece : block_) {
        place(piece, slot);
        slot = status_.after(slot);
      }
    }
  }

  bool leftOf(uint32_t a, uint32_t b) const {
    if (a == b) return false;
    if (const int side = sideByHull(pieces_[a], pieces_[b])) return side < 0; // most pairs are far apart
    return leftBetween(a, b);
  }
  /// The same of two that are near each other.
  bool leftBetween(uint32_t a, uint32_t b) const {
    const Monotone &lp = pieces_[a], &rp = pieces_[b];
    const State &l = states_[a], &r = states_[b];
    const double top = std::max(l.top, r.top), bottom = std::min(l.bottom, r.bottom);
    double widest = 0;
    for (const double at : {0.5, 0.25, 0.75}) {
      const double y = top + (bottom - top) * at;
      const auto [lx, rx] = xsAt(lp, y, rp, y);
      const double d = rx - lx;
      if (std::abs(d) > std::abs(widest)) widest = d;
      if (std::abs(widest) > (std::abs(lx) + std::abs(rx)) * 1e-7) break;
    }
    return widest != 0 ? widest > 0 : a < b;
  }

  bool inside(int winding) const { return rule_ == GPGP_FILL_EVEN_ODD ? (winding & 1) != 0 : winding != 0; }
  int windingBefore(uint32_t slot) const {
    const uint32_t before = status_.before(slot);
    return before == status_.end() ? 0 : states_[pieceAt_[before]].winding;
  }

  void place(uint32_t piece, uint32_t slot) {
    states_[piece].slot = slot;
    pieceAt_[slot] = piece;
  }

  void markDirty(uint32_t piece) {
    if (states_[piece].dirty == batch_) return;
    states_[piece].dirty = batch_;
    starts_.push_back(piece);
  }

  void enter(uint32_t piece, uint32_t slot) {
    place(piece, slot);
    markDirty(piece);
  }

  void remove(uint32_t piece) {
    const uint32_t slot = states_[piece].slot;
    for (const uint32_t beside : {status_.before(slot), status_.after(slot)})
      if (beside != status_.end()) markDirty(pieceAt_[beside]);
    touched_.push_back(piece);
    removedMark_ = removedMark_ || status_.marked(slot);
    status_.erase(slot);
    states_[piece].slot = kNone;
  }

  void insert(uint32_t piece) {
    const uint32_t slot = status_.insert([&](uint32_t at) { return leftOf(piece, pieceAt_[at]); });
    enter(piece, slot);
    // Its neighbours were asked on the way down.
    const uint32_t left = status_.before(slot), right = status_.after(slot);
    if (left != status_.end()) states_[pieceAt_[left]].known = states_[piece].edge;
    if (right != status_.end()) states_[piece].known = states_[pieceAt_[right]].edge;
  }

  /// Edges that are compared over rows no taller than noise may have been put in the wrong place, and others beside
  /// them. Whenever two edges become neighbours they are asked again and change places where needed: the one that moves
  /// at once, the one that made room when its turn comes again.
  void repair() {
    size_t swaps = 64 + 8 * starts_.size();
    // Two that cross here lie beside each other. They are put right first.
    for (size_t i = 0, count = went_ > 1 ? starts_.size() : 0; i < count; ++i) {
      const uint32_t at = states_[starts_[i]].slot;
      if (at == kNone) continue;
      const uint32_t right = status_.after(at);
      if (right != status_.end() && states_[pieceAt_[right]].dirty == batch_ &&
          wrong<&Sweep::leftBetween>(pieceAt_[at], pieceAt_[right])) {
        swap(at, right);
        // What lies beside both, and has no cut here, was beside one of them and so on the same side of the other.
        const uint32_t before = status_.before(at), after = status_.after(right);
        if (before != status_.end() && states_[pieceAt_[before]].dirty != batch_)
          states_[pieceAt_[before]].known = states_[pieceAt_[at]].edge;
        if (after != status_.end() && states_[pieceAt_[after]].dirty != batch_)
          states_[pieceAt_[right]].known = states_[pieceAt_[after]].edge;
      }
    }
    for (size_t i = 0; i < starts_.size() && swaps; ++i) {
      uint32_t at = states_[starts_[i]].slot;
      if (at == kNone) continue;
      for (uint32_t left; swaps && (left = status_.before(at)) != status_.end() && wrong(pieceAt_[left], pieceAt_[at]);
           at = left, --swaps)
        swap(at, left);
      for (uint32_t right;
           swaps && (right = status_.after(at)) != status_.end() && wrong(pieceAt_[at], pieceAt_[right]);
           at = right, --swaps)
        swap(at, right);
    }
  }

  /// Whether two neighbours must change places; the same two are asked once.
  template <bool (Sweep::*Left)(uint32_t, uint32_t) const = &Sweep::leftOf> bool wrong(uint32_t left, uint32_t right) {
    if (states_[left].known == states_[right].edge) return false;
    if ((this->*Left)(right, left)) {
      states_[right].known = states_[left].edge; // as they will lie
      return true;
    }
    states_[left].known = states_[right].edge;
    return false;
  }

  void swap(uint32_t moving, uint32_t other) {
    const uint32_t moved = pieceAt_[moving], madeRoom = pieceAt_[other];
    place(madeRoom, moving);
    place(moved, other);
    markDirty(moved);
    states_[madeRoom].dirty = batch_;
    starts_.push_back(madeRoom);
  }

  /// Windings from each changed place on until they agree with what was there, then the slabs around those places.
  void update() {
    runs_.clear();
    for (const uint32_t piece : starts_) {
      State& state = states_[piece];
      const uint32_t first = state.slot;
      if (first == kNone || state.visited == batch_) continue; // left in this batch, or done
      const uint32_t before = status_.before(first);
      if (before != status_.end() && states_[pieceAt_[before]].dirty == batch_) continue; // reached from there
      int winding = windingBefore(first);
      uint32_t last = first;
      for (uint32_t slot = first; slot != status_.end(); slot = status_.after(slot)) {
        State& s = states_[pieceAt_[slot]];
        const int right = winding + pieces_[pieceAt_[slot]].winding;
        if (s.dirty != batch_ && s.winding == right) break;
        levelCrossings_ += s.dirty != batch_; // nothing of its own happens here
        s.winding = right;
        s.visited = batch_;
        last = slot;
        winding = right;
      }
      runs_.push_back({first, last, false});
    }
    for (Run& run : runs_) run.bounds = markAnew(run);
    for (const Run& run : runs_)
      if (run.bounds || removedMark_) cover(run);
    removedMark_ = false;
    for (const uint32_t piece : touched_) {
      Open& open = open_[piece];
      if (open.active() && open.batch != batch_) close(open);
    }
  }

  /// Marks the slots of a run anew. Returns whether something that bounds slabs is there, or was.
  bool markAnew(const Run& run) {
    bool bounds = false;
    int outer = windingBefore(run.first);
    for (uint32_t slot = run.first;; slot = status_.after(slot)) {
      const uint32_t piece = pieceAt_[slot];
      const int inner = states_[piece].winding;
      const bool mark = inside(outer) != inside(inner);
      bounds = bounds || mark || status_.marked(slot);
      status_.mark(slot, mark);
      if (open_[piece].active()) touched_.push_back(piece);
      if (slot == run.last) return bounds;
      outer = inner;
    }
  }

  /// Opens and closes slabs between the marks of a run and the nearest ones beside it.
  void cover(const Run& run) {
    uint32_t left = status_.end(); // of the slab at hand
    if (inside(windingBefore(run.first))) left = status_.markedBefore(run.first);
    for (uint32_t slot = run.first;; slot = status_.after(slot)) {
      if (status_.marked(slot)) {
        if (left != status_.end()) bound(pieceAt_[left], pieceAt_[slot]);
        left = left == status_.end() ? slot : status_.end();
      }
      if (slot == run.last) break;
    }
    if (left == status_.end()) return;
    const uint32_t right = status_.markedAfter(run.last);
    if (right != status_.end()) bound(pieceAt_[left], pieceAt_[right]);
  }

  void bound(uint32_t left, uint32_t right) {
    Open& open = open_[left];
    if (open.active() && open.right != right) close(open);
    if (!open.active()) {
      open = {right, 0, slabs_.size()};
      slabs_.push_back({left, right, y_, y_});
      ++openSlabs_;
    }
    open.batch = batch_;
  }

  /// What opened at the same height is left as high as it is, for tidySlabs().
  void close(Open& open) {
    slabs_[open.slab].bottom = y_;
    removedSlab_ = removedSlab_ || slabs_[open.slab].top == y_;
    open.slab = kNoSlab;
    --openSlabs_;
  }

  /// Drops those of this height's slabs that closed again, and orders the others.
  void tidySlabs() {
    const auto first = slabs_.begin() + static_cast<ptrdiff_t>(slabsBefore_);
    if (std::exchange(removedSlab_, false))
      slabs_.erase(std::remove_if(first, slabs_.end(),
                                  [this](const Slab& slab) {
                                    return open_[slab.left].slab != static_cast<size_t>(&slab - slabs_.data());
                                  }),
                   slabs_.end());
    const auto before = [](const Slab& a, const Slab& b) { return a.left < b.left; }; // one a left piece
    if (!std::is_sorted(first, slabs_.end(), before)) std::sort(first, slabs_.end(), before);
    for (; slabsBefore_ < slabs_.size(); ++slabsBefore_) open_[slabs_[slabsBefore_].left].slab = slabsBefore_;
  }

  std::span<const Monotone> pieces_;
  const GpgpFillRule rule_;
  std::pmr::vector<Slab>& slabs_;
  std::pmr::memory_resource* memory_;
  Status status_;
  std::pmr::vector<uint32_t> pieceAt_; // by slot
  std::pmr::vector<State> states_;     // by piece
  std::pmr::vector<Open> open_;        // by left piece
  std::pmr::vector<uint32_t> ends_, begins_, block_;
  std::pmr::vector<uint32_t> touched_;
  std::pmr::vector<Run> runs_;
  std::pmr::vector<uint32_t> starts_;
  float y_ = 0;
  uint32_t batch_ = 0, newEdge_ = 0;
  size_t went_ = 0; // edges that went on at this height
  size_t levelCrossings_ = 0;
  size_t openSlabs_ = 0, slabsBefore_; // this height's
  bool removedMark_ = false, removedSlab_ = false;
};

} // namespace

core::Result<void> sweep(std::span<const Monotone> pieces, std::span<const Cut> cuts, GpgpFillRule rule,
                         std::pmr::vector<Slab>& slabs) {
  if (pieces.empty()) return {};
  return Sweep(pieces, rule, slabs).run(cuts);
}

} // namespace gpgp::vector
