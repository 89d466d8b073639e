// Collider and IfCollides on the CPU: the colliders of all axioms, and the shapes that wait for later phases.
#pragma once
#include "spawn/collide.h"
#include "spawn/interpret.h"

#include <gpgp/spawn.h>

#include <span>
#include <vector>

namespace gpgp::spawn {

class Context {
public:
  Context(const uint32_t* words, std::span<const GpgpAxiom> axioms) : words_(words), axioms_(axioms) {}

  /// Goes on where a chain of operators ended with kEndContext. Returns how it ended at last, kEndLater included: the
  /// shape is kept for begin().
  uint32_t resume(shader::Shape& shape, uint32_t maxDepth);
  /// After all of the phase before: its colliders can be found. Returns the shapes that have waited for this phase.
  std::vector<shader::Shape> begin(uint32_t phase);

  /// The axiom's number for a Shape::axiom.
  uint32_t axiomNumber(uint32_t link) const {
    return link & shader::kColliderLink ? axiomOf_[link & ~shader::kColliderLink] : link;
  }
  uint64_t colliders() const { return colliders_.size(); }

private:
  shader::ColliderBox boxOf(const shader::Shape& shape) const;

  const uint32_t* words_;
  std::span<const GpgpAxiom> axioms_;
  std::vector<shader::Collider> colliders_;
  std::vector<uint32_t> axiomOf_; // by collider
  std::vector<uint32_t> cells_{shader::kNoCollider};
  shader::ColliderSet set_{};
  std::vector<shader::Shape> waiting_;
  uint32_t phase_ = 0;
};

} // namespace gpgp::spawn
