// The status of a sweep: slots from left to right, some of them marked.
//
// A treap over the slots finds the place of one that enters in as many comparisons as a balanced tree has levels, and
// the nearest marked slot to either side of one without a walk over those in between. Neighbours are linked beside it.
// What a slot holds is the caller's; that may change places among slots at will. Priorities come from the slots'
// numbers, so that equal input makes equal trees.
#pragma once
#include <cstdint>
#include <memory_resource>
#include <vector>

namespace gpgp::vector {

class Status {
public:
  /// Room for `count` slots, which are below `count`; end() is none of them.
  Status(uint32_t count, std::pmr::memory_resource* memory)
      : nodes_(count + 1, Node{}, memory), end_(count), root_(count) {
    for (uint32_t i = 0; i <= end_; ++i) nodes_[i] = {end_, end_, end_, end_, end_, priorityOf(i), false, false};
    for (uint32_t i = 0; i < end_; ++i) nodes_[i].after = i + 1; // those that are free, from free_ on
  }

  uint32_t end() const { return end_; }
  uint32_t before(uint32_t slot) const { return nodes_[slot].before; }
  uint32_t after(uint32_t slot) const { return nodes_[slot].after; }
  bool marked(uint32_t slot) const { return nodes_[slot].marked; }

  /// Takes a free slot into the place that `beforeSlot` says: whether the new one lies left of a slot. Each slot is
  /// asked at most once.
  template <class Before> uint32_t insert(Before&& beforeSlot) {
    const uint32_t slot = free_;
    free_ = nodes_[slot].after;
    uint32_t up = end_, left = end_, right = end_;
    for (uint32_t at = root_; at != end_;) {
      up = at;
      const bool goesLeft = beforeSlot(at);
      (goesLeft ? right : left) = at;
      at = goesLeft ? nodes_[at].left : nodes_[at].right;
    }
    nodes_[slot] = {end_, end_, up, left, right, nodes_[slot].priority, false, false};
    if (left != end_) nodes_[left].after = slot;
    if (right != end_) nodes_[right].before = slot;
    if (up == end_)
      root_ = slot;
    else
      (up == right ? nodes_[up].left : nodes_[up].right) = slot;
    while (nodes_[slot].up != end_ && nodes_[nodes_[slot].up].priority < nodes_[slot].priority) rise(slot);
    return slot;
  }

  /// The slot is free again.
  void erase(uint32_t slot) {
    mark(slot, false);
    for (;;) { // down to where it has no more than one child
      const uint32_t left = nodes_[slot].left, right = nodes_[slot].right;
      if (left == end_ || right == end_) break;
      rise(nodes_[left].priority > nodes_[right].priority ? left : right);
    }
    const Node& node = nodes_[slot];
    const uint32_t child = node.left != end_ ? node.left : node.right;
    if (child != end_) nodes_[child].up = node.up;
    if (node.up == end_)
      root_ = child;
    else
      (nodes_[node.up].left == slot ? nodes_[node.up].left : nodes_[node.up].right) = child;
    if (node.before != end_) nodes_[node.before].after = node.after;
    if (node.after != end_) nodes_[node.after].before = node.before;
    nodes_[slot].after = free_;
    free_ = slot;
  }

  void mark(uint32_t slot, bool marked) {
    if (nodes_[slot].marked == marked) return;
    nodes_[slot].marked = marked;
    for (uint32_t at = slot; at != end_; at = nodes_[at].up) {
      const bool any = anyOf(at);
      if (nodes_[at].any == any) break;
      nodes_[at].any = any;
    }
  }

  /// The nearest marked slot left of one, and right of one; end(): none.
  uint32_t markedBefore(uint32_t slot) const { return nearest<&Node::before, &Node::left, &Node::right>(slot); }
  uint32_t markedAfter(uint32_t slot) const { return nearest<&Node::after, &Node::right, &Node::left>(slot); }

private:
  struct Node {
    uint32_t left = 0, right = 0, up = 0;
    uint32_t before = 0, after = 0;
    uint32_t priority = 0;
    bool marked = false, any = false; ///< any: below or at the node
  };
  static uint32_t priorityOf(uint32_t slot) { // bits well mixed
    uint32_t h = slot * 0x9e3779b9u + 0x7f4a7c15u;
    h = (h ^ (h >> 16)) * 0x85ebca6bu;
    h = (h ^ (h >> 13)) * 0xc2b2ae35u;
    return h ^ (h >> 16);
  }
  bool anyOf(uint32_t at) const {
    const Node& n = nodes_[at];
    return n.marked || nodes_[n.left].any || nodes_[n.right].any; // end_ has none
  }

  /// Changes places with the node above, in one order as before.
  void rise(uint32_t slot) {
    const uint32_t parent = nodes_[slot].up, above = nodes_[parent].up;
    const bool isLeft = nodes_[parent].left == slot;
    const uint32_t moved = isLeft ? nodes_[slot].right : nodes_[slot].left;
    (isLeft ? nodes_[parent].left : nodes_[parent].right) = moved;
    if (moved != end_) nodes_[moved].up = parent;
    (isLeft ? nodes_[slot].right : nodes_[slot].left) = parent;
    nodes_[parent].up = slot;
    nodes_[slot].up = above;
    if (above == end_)
      root_ = slot;
    else
      (nodes_[above].left == parent ? nodes_[above].left : nodes_[above].right) = slot;
    nodes_[parent].any = anyOf(parent);
    nodes_[slot].any = anyOf(slot);
  }

  /// Near: towards the side that is searched, Inner: to that side's child, Outer: to the other's.
  template <uint32_t Node::*Near, uint32_t Node::*Inner, uint32_t Node::*Outer> uint32_t nearest(uint32_t slot) const {
    const uint32_t neighbour = nodes_[slot].*Near; // most often
    if (neighbour == end_ || nodes_[neighbour].marked) return neighbour;
    uint32_t at = slot, below = nodes_[slot].*Inner;
    while (!nodes_[below].any) { // up to where something lies on that side
      const uint32_t up = nodes_[at].up;
      if (up == end_) return end_;
      const bool fromOuter = nodes_[up].*Outer == at;
      at = up;
      if (!fromOuter) continue;
      if (nodes_[at].marked) return at;
      below = nodes_[at].*Inner;
    }
    for (;;) { // and down to the nearest of it
      if (nodes_[nodes_[below].*Outer].any)
        below = nodes_[below].*Outer;
      else if (nodes_[below].marked)
        return below;
      else
        below = nodes_[below].*Inner;
    }
  }

  std::pmr::vector<Node> nodes_; ///< and that of end_, which has no marks
  const uint32_t end_;
  uint32_t root_, free_ = 0;
};

} // namespace gpgp::vector
