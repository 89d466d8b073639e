// A path's slabs to patches: slabs that lie above each other, edge on edge, become one. Before that, arcs that the
// outline's cubics were cut into become as long as they can be without a turn: quarters of an upright ellipse.
//
// A slab is first cut where one of its curves ends and the next begins, then has one curve on each side. Where it ends,
// it may be continued by the slab whose upper edge is its lower one: bounded there by the same curves, or by curves
// that begin at its corners.
#include "vector/patch/patches.h"

#include <algorithm>
#include <bit>
#include <tuple>
#include <unordered_map>

namespace gpgp::vector {
namespace {

/// An edge between slabs: its height, and for each side the curve that passes, or the corner where one ends.
struct Edge {
  float y;
  uint32_t left, right;
  bool leftEnds, rightEnds;
  bool operator==(const Edge&) const = default;
};
struct EdgeHash {
  size_t operator()(const Edge& e) const {
    uint64_t h = std::bit_cast<uint32_t>(e.y) * 0x9e3779b97f4a7c15u;
    for (const uint64_t v : {uint64_t(e.left) * 2 + e.leftEnds, uint64_t(e.right) * 2 + e.rightEnds})
      h = (h ^ (h >> 29) ^ v) * 0xbf58476d1ce4e5b9u;
    return static_cast<size_t>(h ^ (h >> 32));
  }
};

struct Strip { // with one curve on each side
  float top, bottom;
  uint32_t left, right;
};

class Joiner {
public:
  Joiner(const Drawing& drawing, uint32_t maxCurves, JoinedPath& path, std::pmr::memory_resource* memory)
      : drawing_(drawing), maxCurves_(maxCurves), path_(path), places_(memory), strips_(memory), open_(memory),
        one_(memory) {}

  void run(std::span<const PatchRecord> slabs) {
    joinAlong(slabs);
    for (const PatchRecord& slab : slabs) cut(slab);
    std::stable_sort(strips_.begin(), strips_.end(), [](const Strip& a, const Strip& b) { return a.top < b.top; });
    for (const Strip& strip : strips_) add(strip);
  }

private:
  struct Place { // of a curve's forms in the table
    uint32_t first, last;
  };
  /// Gives arcs of one ellipse, each from the end of another on, one place in the table.
  void joinAlong(std::span<const PatchRecord> slabs) {
    constexpr uint32_t kSeveral = UINT32_MAX;
    std::pmr::unordered_map<uint64_t, uint32_t> starts(
        places_.get_allocator().resource()); // of arcs, by where they start
    std::pmr::vector<uint32_t> arcs(places_.get_allocator().resource());
    const auto key = [](float x, float y) {
      return uint64_t(std::bit_cast<uint32_t>(x)) << 32 | std::bit_cast<uint32_t>(y);
    };
    for (const PatchRecord& slab : slabs)
      for (const uint32_t curve : {slab.left, slab.right}) {
        const CurveRecord& c = drawing_.curves[curve];
        if (c.weight > 0) arcs.push_back(curve);
      }
    const auto before = [&](uint32_t a, uint32_t b) {
      const float ya = drawing_.curves[a].ends.y, yb = drawing_.curves[b].ends.y;
      return ya != yb ? ya < yb : a < b;
    };
    std::sort(arcs.begin(), arcs.end(), before);
    arcs.erase(std::unique(arcs.begin(), arcs.end()), arcs.end());
    for (const uint32_t arc : arcs) {
      const CurveRecord& c = drawing_.curves[arc];
      const auto [found, added] = starts.try_emplace(key(c.ends.x, c.ends.y), arc);
      if (!added) found->second = kSeveral;
    }
    for (const uint32_t arc : arcs) {
      if (places_.contains(arc)) continue; // of one above
      const Place own = place(arc);
      for (;;) {
        FormCurve& form = path_.curves[own.first];
        const auto next = starts.find(key(form.x1, form.y1));
        if (next == starts.end() || next->second == kSeveral || places_.contains(next->second)) break;
        one_.clear();
        appendForms(drawing_.curves[next->second], one_);
        const auto joined = joinArcs(form, one_[0]);
        if (!joined) break;
        form = *joined;
        places_.emplace(next->second, own);
      }
    }
  }

  Place place(uint32_t curve) {
    const auto [found, added] = places_.try_emplace(curve);
    if (added) {
      found->second.first = static_cast<uint32_t>(path_.curves.size());
      appendForms(drawing_.curves[curve], path_.curves);
      found->second.last = static_cast<uint32_t>(path_.curves.size());
    }
    return found->second;
  }
  /// The form that bounds the rows below a height.
  uint32_t formBelow(Place place, float y) const {
    uint32_t at = place.first;
    while (at + 1 < place.last && path_.curves[at].y1 <= y) ++at;
    return at;
  }
  void cut(const PatchRecord& slab) {
    const Place left = place(slab.left), right = place(slab.right);
    for (float top = slab.top; top < slab.bottom;) {
      Strip strip{top, slab.bottom, formBelow(left, top), formBelow(right, top)};
      for (const auto& [form, last] : {std::pair{strip.left, left.last}, std::pair{strip.right, right.last}})
        if (form + 1 < last) strip.bottom = std::min(strip.bottom, path_.curves[form].y1);
      strips_.push_back(strip);
      top = strip.bottom;
    }
  }
  Edge edgeOf(const Strip& strip, bool lower) const {
    const float y = lower ? strip.bottom : strip.top;
    const FormCurve &l = path_.curves[strip.left], &r = path_.curves[strip.right];
    Edge edge{y, strip.left, strip.right, y == (lower ? l.y1 : l.y0), y == (lower ? r.y1 : r.y0)};
    if (edge.leftEnds) edge.left = std::bit_cast<uint32_t>(lower ? l.x1 : l.x0);
    if (edge.rightEnds) edge.right = std::bit_cast<uint32_t>(lower ? r.x1 : r.x0);
    return edge;
  }
  void add(const Strip& strip) {
    const auto found = open_.find(edgeOf(strip, false));
    uint32_t index = static_cast<uint32_t>(path_.patches.size());
    if (found != open_.end()) {
      JoinedPatch& patch = path_.patches[found->second];
      const bool newLeft = patch.curves[patch.lefts - 1] != strip.left;
      const bool newRight = patch.curves[patch.curveCount - 1] != strip.right;
      if (patch.curveCount + newLeft + newRight <= maxCurves_) {
        index = found->second;
        if (newLeft) {
          std::copy_backward(patch.curves + patch.lefts, patch.curves + patch.curveCount,
                             patch.curves + patch.curveCount + 1);
          patch.curves[patch.lefts++] = strip.left;
          ++patch.curveCount;
        }
        if (newRight) patch.curves[patch.curveCount++] = strip.right;
        patch.bottom = strip.bottom;
      }
      open_.erase(found);
    }
    if (index == path_.patches.size()) {
      JoinedPatch patch{strip.top, strip.bottom, {strip.left, strip.right}, 2, 1};
      path_.patches.push_back(patch);
    }
    open_[edgeOf(strip, true)] = index;
  }

  const Drawing& drawing_;
  const uint32_t maxCurves_;
  JoinedPath& path_;
  std::pmr::unordered_map<uint32_t, Place> places_;
  std::pmr::vector<Strip> strips_;
  std::pmr::unordered_map<Edge, uint32_t, EdgeHash> open_; // lower edges of patches
  std::pmr::vector<FormCurve> one_;
};

} // namespace

JoinedPath joinSlabs(const Drawing& drawing, std::span<const PatchRecord> slabs, uint32_t maxCurves,
                     std::pmr::memory_resource* memory) {
  JoinedPath path(memory);
  Joiner(drawing, std::clamp(maxCurves, 2u, kMaxPatchCurves), path, memory).run(slabs);
  return path;
}

} // namespace gpgp::vector
