#include "spawn/evaluator/context.h"

#include <bit>

namespace gpgp::spawn {
using namespace shader;

ColliderBox Context::boxOf(const Shape& shape) const {
  const float* t = axioms_[axiomNumber(shape.axiom)].transform;
  return shader::boxOf(shape, vec4(t[0], t[1], t[2], t[3]), vec4(t[4], t[5], t[6], t[7]),
                       vec4(t[8], t[9], t[10], t[11]));
}

void Context::add(Shape& shape, uint32_t tag) {
  colliders_.push_back({boxOf(shape), tag, shape.axiom, kNoCollider});
  axiomOf_.push_back(axiomNumber(shape.axiom));
  shape.axiom = kColliderLink | static_cast<uint32_t>(colliders_.size() - 1);
}

bool Context::collides(const Shape& shape, uint32_t tag) {
  uint32_t spent = 0;
  set_.colliders = colliders_.data(); // which may have moved
  set_.cells = cells_.data();
  return collidesWithAny(set_, boxOf(shape), tag, shape.axiom, spent);
}

std::vector<Shape> Context::begin(uint32_t phase) {
  phase_ = phase;
  set_ = {nullptr, nullptr, 0, 0, static_cast<uint32_t>(colliders_.size())};
  set_.cellMask = std::bit_ceil(2 * set_.linked + 1) - 1;
  cells_.assign(size_t(set_.cellMask) + 1, kNoCollider);
  for (uint32_t i = 0; i < set_.linked; ++i) {
    Collider& collider = colliders_[i];
    const uint32_t level = levelOf(worldExtents(collider.box));
    uint32_t& first = cells_[cellHash(cellAt(worldCentre(collider.box), level), level) & set_.cellMask];
    collider.next = first;
    first = i;
    set_.levels |= 1u << level;
  }
  std::vector<Shape> due;
  std::vector<Waiting> later;
  for (const Waiting& waiting : waiting_) {
    if (waiting.phase == phase)
      due.push_back(waiting.shape);
    else
      later.push_back(waiting);
  }
  waiting_ = std::move(later);
  return due;
}

} // namespace gpgp::spawn
