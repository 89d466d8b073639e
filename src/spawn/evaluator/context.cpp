#include "spawn/evaluator/context.h"

#include <algorithm>
#include <bit>

namespace gpgp::spawn {
using namespace shader;

void LinkedColliders::link() {
  set = {nullptr, nullptr, 0, 0, static_cast<uint32_t>(colliders.size()), nullptr};
  set.cellMask = std::bit_ceil(2 * set.linked + 1) - 1;
  cells.assign(size_t(set.cellMask) + 1, kNoCollider);
  for (uint32_t i = 0; i < set.linked; ++i) {
    Collider& collider = colliders[i];
    const uint32_t level = levelOf(worldExtents(collider.box));
    uint32_t& first = cells[cellHash(cellAt(worldCentre(collider.box), level), level) & set.cellMask];
    collider.next = first;
    first = i;
    set.levels |= 1u << level;
  }
  set.colliders = colliders.data();
  set.cells = cells.data();
}

ColliderBox Context::boxOf(const Shape& shape) const {
  const float* t = axioms_[axiomNumber(shape.axiom)].transform;
  return shader::boxOf(shape, vec4(t[0], t[1], t[2], t[3]), vec4(t[4], t[5], t[6], t[7]),
                       vec4(t[8], t[9], t[10], t[11]));
}

void Context::add(Shape& shape, uint32_t tag) {
  const uint32_t axiom = axiomNumber(shape.axiom);
  colliders_.push_back({boxOf(shape), tag, shape.axiom, kNoCollider});
  axiomOf_.push_back(axiom);
  shape.axiom = kColliderLink | (linked_.set.linked + static_cast<uint32_t>(colliders_.size() - 1));
}

bool Context::collides(const Shape& shape, uint32_t tag) const {
  uint32_t spent = 0;
  ColliderSet set = linked_.set;
  set.own = colliders_.data(); // which may have moved
  return collidesWithAny(set, boxOf(shape), tag, shape.axiom, spent);
}

void Context::publish(LinkedColliders& linked) {
  const uint32_t shift = static_cast<uint32_t>(linked.colliders.size()) - linked.set.linked;
  const auto renumber = [&](uint32_t& link) {
    if ((link & kColliderLink) && (link & ~kColliderLink) >= linked.set.linked) link += shift;
  };
  for (Collider& collider : colliders_) renumber(collider.before);
  for (Waiting& waiting : waiting_) renumber(waiting.shape.axiom);
  linked.colliders.insert(linked.colliders.end(), colliders_.begin(), colliders_.end());
  linked.axiomOf.insert(linked.axiomOf.end(), axiomOf_.begin(), axiomOf_.end());
  colliders_.clear();
  axiomOf_.clear();
}

std::pmr::vector<Shape> Context::begin(uint32_t phase) {
  phase_ = phase;
  std::pmr::memory_resource* memory = waiting_.get_allocator().resource();
  std::pmr::vector<std::pair<uint32_t, uint32_t>> order(memory); // by axiom, then as they came
  std::pmr::vector<Waiting> later(memory);
  for (uint32_t i = 0; i < waiting_.size(); ++i) {
    if (waiting_[i].phase == phase)
      order.emplace_back(axiomNumber(waiting_[i].shape.axiom), i);
    else
      later.push_back(waiting_[i]);
  }
  std::sort(order.begin(), order.end());
  std::pmr::vector<Shape> due(memory);
  due.reserve(order.size());
  for (const auto& entry : order) due.push_back(waiting_[entry.second].shape);
  waiting_ = std::move(later);
  return due;
}

} // namespace gpgp::spawn
