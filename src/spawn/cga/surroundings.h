// What axioms see of each other: the shapes that context queries beyond their own axiom ask for, in boxes in boxes.
//
// A query depends on the set of shapes alone: not on the order of axioms, nor on threads.
#pragma once
#include "spawn/geometry/geometry.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>
#include <vector>

namespace gpgp::spawn::cga {

/// A shape that others may ask for, in world space.
struct Occluder {
  std::string label; ///< that label() said; empty: none, only queries without a label see it
  Hull hull;
  float area = 0; ///< of its faces
};

class Surroundings {
public:
  /// The shapes of an axiom, which has a number of its own.
  void add(uint32_t axiom, std::vector<Occluder>&& shapes);
  /// When all are there, before anything is asked.
  void build();

  /// How many shapes of other axioms have a label.
  uint32_t count(const std::string& label, uint32_t axiom) const;
  /// Calls visit(occluder) for shapes of other axioms with a label, "": for all, whose boxes are no farther from a box
  /// than a reach, metres. visit returns the reach from then on; below 0 it ends. Returns how many boxes it looked at.
  template <class Visit>
  uint64_t visit(const std::string& label, uint32_t axiom, const Bounds& box, float reach, const Visit& visit) const {
    const auto found = trees_.find(label);
    if (found == trees_.end()) return 0;
    const Tree& tree = found->second;
    uint64_t steps = 0;
    std::vector<uint32_t> stack{0};
    while (!stack.empty() && reach >= 0) {
      const Node& node = tree.nodes[stack.back()];
      stack.pop_back();
      ++steps;
      if (distance(node.bounds, box) > reach) continue;
      if (node.right) { // the nearer one first
        const auto left = static_cast<uint32_t>(&node - tree.nodes.data()) + 1;
        const bool isLeftNearer =
            distance(tree.nodes[left].bounds, box) <= distance(tree.nodes[node.right].bounds, box);
        stack.push_back(isLeftNearer ? node.right : left);
        stack.push_back(isLeftNearer ? left : node.right);
        continue;
      }
      for (uint32_t i = node.first; i < node.first + node.count && reach >= 0; ++i) {
        const Placed& placed = shapes_[tree.order[i]];
        if (placed.axiom != axiom && distance(placed.shape.hull.bounds, box) <= reach) reach = visit(placed.shape);
      }
    }
    return steps;
  }

private:
  struct Placed {
    uint32_t axiom;
    Occluder shape;
  };
  /// The left child is the next node; right 0: a leaf.
  struct Node {
    Bounds bounds;
    uint32_t first = 0, count = 0, right = 0;
  };
  struct Tree {
    std::vector<uint32_t> order; ///< of shapes_
    std::vector<Node> nodes;
    std::unordered_map<uint32_t, uint32_t> ofAxiom; ///< how many shapes an axiom has
  };
  static float distance(const Bounds& a, const Bounds& b) {
    float sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float gap = std::max({0.0f, a.low[axis] - b.high[axis], b.low[axis] - a.high[axis]});
      sum += gap * gap;
    }
    return std::sqrt(sum);
  }
  void divide(Tree& tree, uint32_t first, uint32_t count) const;

  std::vector<Placed> shapes_;
  std::unordered_map<std::string, Tree> trees_; ///< by label; "": of all
};

} // namespace gpgp::spawn::cga
