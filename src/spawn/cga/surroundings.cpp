// Boxes in boxes over the shapes of all axioms, halved at the median along their longest side, a tree for each label.
#include "spawn/cga/surroundings.h"

#include <numeric>

namespace gpgp::spawn::cga {

void Surroundings::add(uint32_t axiom, std::vector<Occluder>&& shapes) {
  for (Occluder& shape : shapes)
    if (!shape.hull.points.empty()) shapes_.push_back({axiom, std::move(shape)});
}

void Surroundings::build() {
  trees_.clear();
  if (shapes_.empty()) return;
  trees_[{}].order.resize(shapes_.size());
  std::iota(trees_[{}].order.begin(), trees_[{}].order.end(), 0u);
  for (uint32_t i = 0; i < shapes_.size(); ++i)
    if (!shapes_[i].shape.label.empty()) trees_[shapes_[i].shape.label].order.push_back(i);
  for (auto& [label, tree] : trees_) {
    for (const uint32_t i : tree.order) ++tree.ofAxiom[shapes_[i].axiom];
    divide(tree, 0, static_cast<uint32_t>(tree.order.size()));
  }
}

void Surroundings::divide(Tree& tree, uint32_t first, uint32_t count) const {
  constexpr uint32_t kOfLeaf = 4;
  const size_t at = tree.nodes.size();
  Node node;
  node.first = first;
  node.count = count;
  node.bounds = shapes_[tree.order[first]].shape.hull.bounds;
  for (uint32_t i = first + 1; i < first + count; ++i) {
    const Bounds& b = shapes_[tree.order[i]].shape.hull.bounds;
    node.bounds.low = glm::min(node.bounds.low, b.low);
    node.bounds.high = glm::max(node.bounds.high, b.high);
  }
  tree.nodes.push_back(node);
  if (count <= kOfLeaf) return;
  const glm::vec3 extent = node.bounds.high - node.bounds.low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const auto middle = [&](uint32_t i) {
    const Bounds& b = shapes_[i].shape.hull.bounds;
    const float sum = b.low[axis] + b.high[axis];
    return std::isfinite(sum) ? sum : 0.0f;
  };
  const auto begin = tree.order.begin() + first;
  const uint32_t half = count / 2;
  // Equal ones by their number, so that the halves depend on the shapes alone.
  std::nth_element(begin, begin + half, begin + count,
                   [&](uint32_t a, uint32_t b) { return std::pair(middle(a), a) < std::pair(middle(b), b); });
  divide(tree, first, half);
  tree.nodes[at].right = static_cast<uint32_t>(tree.nodes.size());
  divide(tree, first + half, count - half);
}

uint32_t Surroundings::count(const std::string& label, uint32_t axiom) const {
  const auto found = trees_.find(label);
  if (found == trees_.end()) return 0;
  const Tree& tree = found->second;
  const auto own = tree.ofAxiom.find(axiom);
  return static_cast<uint32_t>(tree.order.size()) - (own == tree.ofAxiom.end() ? 0 : own->second);
}

} // namespace gpgp::spawn::cga
