// Stage 3: a sweep from top to bottom that turns pieces into slabs.
//
// The status is the list of edges (pieces between two cuts) that the sweep line meets, ordered by x: linked slots for
// walking, and a tree over them that finds the place of an edge that begins. Between cuts no two edges change sides, so
// two edges are ordered by comparing them in the middle of the rows they share, which is safe where they touch at an
// end; nothing is ever compared on the sweep line itself. At each height all edges that end leave, all that begin
// enter, and only around those places windings and slabs are worked out again. A slab stays open while the pair of
// pieces that bounds it stays the same, whatever happens outside or inside of it.
#include "vector/geometry/order.h"
#include "vector/patch/drawing.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace gpgp::vector {
namespace {

struct Edge {
  uint32_t piece;
  float top, bottom;
};

constexpr uint32_t kNone = UINT32_MAX;

class Sweep {
public:
  Sweep(std::span<const Monotone> pieces, GpgpFillRule rule, std::pmr::vector<Slab>& slabs)
      : pieces_(pieces), rule_(rule), slabs_(slabs), memory_(slabs.get_allocator().resource()), edges_(memory_),
        status_(Order{this}, memory_), nodes_(memory_), links_(memory_), places_(memory_), edgeOf_(memory_),
        windings_(memory_), dirty_(memory_), visited_(memory_), known_(memory_), open_(memory_), touched_(memory_),
        runs_(memory_), starts_(memory_) {}

  void run(std::span<const Cut> cuts) {
    makeEdges(cuts);
    const uint32_t count = static_cast<uint32_t>(edges_.size());
    nodes_.assign(count, status_.end());
    links_.assign(count + 1, Link{count, count});
    end_ = count;
    places_.assign(count, kNone);
    edgeOf_.resize(count);
    for (uint32_t i = 0; i < count; ++i) edgeOf_[i] = i;
    windings_.assign(count, 0);
    dirty_.assign(count, 0);
    visited_.assign(count, 0);
    known_.assign(count, kNone);
    open_.assign(pieces_.size(), Open{});
    auto begins = orderBy(count, memory_, [this](uint32_t i) { return edges_[i].top; });
    auto ends = orderBy(count, memory_, [this](uint32_t i) { return edges_[i].bottom; });
    uint32_t begin = 0, end = 0;
    while (end < count) {
      y_ = edges_[ends[end]].bottom;
      if (begin < count) y_ = std::min(y_, edges_[begins[begin]].top);
      ++batch_;
      starts_.clear();
      touched_.clear();
      const uint32_t firstEnd = end, firstBegin = begin;
      while (end < count && edges_[ends[end]].bottom == y_) ++end;
      while (begin < count && edges_[begins[begin]].top == y_) ++begin;
      advance(std::span(ends).subspan(firstEnd, end - firstEnd),
              std::span(begins).subspan(firstBegin, begin - firstBegin));
      repair();
      update();
    }
  }

private:
  struct Order {
    const Sweep* sweep;
    bool operator()(uint32_t a, uint32_t b) const { return sweep->leftOf(sweep->edgeOf_[a], sweep->edgeOf_[b]); }
  };
  using Status = std::pmr::multiset<uint32_t, Order>; // of slots; edgeOf_ says which edge a slot holds
  struct Link {                                       // a slot's neighbours; end_ beyond both ends
    uint32_t before, after;
  };
  struct Open { // the slab whose left side is a piece
    uint32_t right = 0, stamp = 0;
    float top = 0;
    bool active = false;
  };

  /// Edges that end leave, edges that begin enter. Most often one goes on where another ends; it then takes that one's
  /// place, and repair() sees to it that the place is right.
  void advance(std::span<uint32_t> ends, std::span<uint32_t> begins) {
    constexpr size_t kFew = 8; // more are sorted in, which is cheaper than trying all pairs and swapping many
    if (ends.size() <= kFew && begins.size() <= kFew) {
      for (uint32_t& end : ends)
        for (uint32_t& begin : begins)
          if (begin != kNone && goesOn(edges_[end], edges_[begin])) {
            const uint32_t slot = places_[end];
            touched_.push_back(edges_[end].piece);
            places_[end] = kNone;
            places_[begin] = slot;
            edgeOf_[slot] = begin;
            markDirty(begin);
            end = begin = kNone;
            break;
          }
    }
    for (const uint32_t end : ends)
      if (end != kNone) remove(end);
    for (const uint32_t begin : begins)
      if (begin != kNone) insert(begin);
  }
  bool goesOn(const Edge& upper, const Edge& lower) const {
    if (upper.piece == lower.piece) return true;
    const Point &p = pieces_[upper.piece].curve.p[3], &q = pieces_[lower.piece].curve.p[0];
    return p.x == q.x && p.y == q.y && lower.top == static_cast<float>(q.y);
  }

  void makeEdges(std::span<const Cut> cuts) {
    size_t next = 0;
    for (uint32_t i = 0; i < pieces_.size(); ++i) {
      float top = static_cast<float>(pieces_[i].top());
      for (; next < cuts.size() && cuts[next].piece == i; ++next) {
        edges_.push_back({i, top, cuts[next].y});
        top = cuts[next].y;
      }
      edges_.push_back({i, top, static_cast<float>(pieces_[i].bottom())});
    }
  }

  bool leftOf(uint32_t a, uint32_t b) const {
    if (a == b) return false;
    const Edge &l = edges_[a], &r = edges_[b];
    const Monotone &lp = pieces_[l.piece], &rp = pieces_[r.piece];
    if (const int side = sideByHull(lp, rp)) return side < 0; // most pairs are far apart
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
  uint32_t before(uint32_t slot) const { return links_[slot].before; }
  uint32_t after(uint32_t slot) const { return links_[slot].after; }
  int windingBefore(uint32_t slot) const { return before(slot) == end_ ? 0 : windings_[edgeOf_[before(slot)]]; }

  void markDirty(uint32_t edge) {
    if (dirty_[edge] == batch_) return;
    dirty_[edge] = batch_;
    starts_.push_back(edge);
  }

  void markNeighbours(uint32_t slot) {
    if (before(slot) != end_) markDirty(edgeOf_[before(slot)]);
    if (after(slot) != end_) markDirty(edgeOf_[after(slot)]);
  }

  void remove(uint32_t edge) {
    const uint32_t slot = places_[edge];
    markNeighbours(slot);
    touched_.push_back(edges_[edge].piece);
    status_.erase(nodes_[slot]);
    links_[before(slot)].after = after(slot);
    links_[after(slot)].before = before(slot);
    places_[edge] = kNone;
  }

  void insert(uint32_t edge) {
    const uint32_t slot = places_[edge] = edge; // no other edge has had this one's
    const auto node = nodes_[slot] = status_.insert(slot);
    const auto next = std::next(node);
    const uint32_t right = next == status_.end() ? end_ : *next, left = before(right);
    links_[slot] = {left, right};
    links_[left].after = links_[right].before = slot;
    markDirty(edge);
    // Its neighbours were asked on the way down.
    if (left != end_) known_[edgeOf_[left]] = edge;
    if (right != end_) known_[edge] = edgeOf_[right];
  }

  /// Edges that are compared over rows no taller than noise may have been put in the wrong place, and others beside
  /// them. Whenever two edges become neighbours they are asked again and change places where needed: the one that moves
  /// at once, the one that made room when its turn comes again.
  void repair() {
    size_t swaps = 64 + 8 * starts_.size();
    for (size_t i = 0; i < starts_.size() && swaps; ++i) {
      uint32_t at = places_[starts_[i]];
      if (at == kNone) continue;
      for (; before(at) != end_ && swaps && wrong(edgeOf_[before(at)], edgeOf_[at]); at = before(at), --swaps)
        swap(at, before(at));
      for (; after(at) != end_ && swaps && wrong(edgeOf_[at], edgeOf_[after(at)]); at = after(at), --swaps)
        swap(at, after(at));
    }
  }

  /// Whether two neighbours must change places; the same two are asked once.
  bool wrong(uint32_t left, uint32_t right) {
    if (known_[left] == right) return false;
    if (leftOf(right, left)) return true;
    known_[left] = right;
    return false;
  }

  void swap(uint32_t moving, uint32_t other) {
    uint32_t &madeRoom = edgeOf_[moving], &moved = edgeOf_[other];
    std::swap(madeRoom, moved);
    places_[madeRoom] = moving;
    places_[moved] = other;
    markDirty(moved);
    dirty_[madeRoom] = batch_;
    starts_.push_back(madeRoom);
    markNeighbours(moving);
    markNeighbours(other);
  }

  /// Windings from each changed place on until they agree with what was there, then the slabs around those places.
  void update() {
    runs_.clear();
    for (const uint32_t edge : starts_) {
      const uint32_t first = places_[edge];
      if (first == kNone || visited_[edge] == batch_) continue;                        // left in this batch, or done
      if (before(first) != end_ && dirty_[edgeOf_[before(first)]] == batch_) continue; // reached from there
      int winding = windingBefore(first);
      uint32_t last = edge;
      for (uint32_t slot = first; slot != end_; slot = after(slot)) {
        const uint32_t e = edgeOf_[slot];
        const int right = winding + pieces_[edges_[e].piece].winding;
        if (dirty_[e] != batch_ && windings_[e] == right) break;
        windings_[e] = right;
        visited_[e] = batch_;
        last = e;
        winding = right;
      }
      runs_.push_back({edge, last});
    }
    for (const Run& run : runs_) cover(places_[run.first], places_[run.last]);
    for (const uint32_t piece : touched_) {
      Open& open = open_[piece];
      if (open.active && open.stamp != batch_) close(piece, open);
    }
  }

  /// Opens and closes slabs from the outside left of `first` to the outside right of `last`.
  void cover(uint32_t first, uint32_t last) {
    while (inside(windingBefore(first))) first = before(first);
    while (after(last) != end_ && inside(windings_[edgeOf_[last]])) last = after(last);
    int outer = windingBefore(first);
    uint32_t left = 0;
    for (uint32_t slot = first, end = after(last); slot != end; slot = after(slot)) {
      const uint32_t edge = edgeOf_[slot], piece = edges_[edge].piece;
      const int inner = windings_[edge];
      touched_.push_back(piece);
      if (!inside(outer) && inside(inner))
        left = piece;
      else if (inside(outer) && !inside(inner))
        bound(left, piece);
      outer = inner;
    }
  }

  void bound(uint32_t left, uint32_t right) {
    Open& open = open_[left];
    if (open.active && open.right != right) close(left, open);
    if (!open.active) open = {right, 0, y_, true};
    open.stamp = batch_;
  }

  void close(uint32_t left, Open& open) {
    if (open.top < y_) slabs_.push_back({left, open.right, open.top, y_});
    open.active = false;
  }

  struct Run {
    uint32_t first, last;
  };
  std::span<const Monotone> pieces_;
  const GpgpFillRule rule_;
  std::pmr::vector<Slab>& slabs_;
  std::pmr::memory_resource* memory_;
  std::pmr::vector<Edge> edges_;
  Status status_;
  std::pmr::vector<Status::iterator> nodes_;   // by slot
  std::pmr::vector<Link> links_;               // by slot, and of end_
  uint32_t end_ = 0;                           // the slot that is none
  std::pmr::vector<uint32_t> places_;          // slot by edge
  std::pmr::vector<uint32_t> edgeOf_;          // by slot
  std::pmr::vector<int> windings_;             // right of each edge
  std::pmr::vector<uint32_t> dirty_, visited_; // batch numbers
  std::pmr::vector<uint32_t> known_;           // by edge, an edge that is right of it
  std::pmr::vector<Open> open_;                // by left piece
  std::pmr::vector<uint32_t> touched_;
  std::pmr::vector<Run> runs_;
  std::pmr::vector<uint32_t> starts_;
  float y_ = 0;
  uint32_t batch_ = 0;
};

} // namespace

void sweep(std::span<const Monotone> pieces, std::span<const Cut> cuts, GpgpFillRule rule,
           std::pmr::vector<Slab>& slabs) {
  if (pieces.empty()) return;
  Sweep(pieces, rule, slabs).run(cuts);
}

} // namespace gpgp::vector
