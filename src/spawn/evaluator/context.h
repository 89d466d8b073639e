// Collider and IfCollides on the CPU: the colliders of all axioms, and the shapes that wait for later phases.
#pragma once
#include "spawn/colliders/collide.h"

#include <gpgp/spawn.h>

#include <span>
#include <vector>

namespace gpgp::spawn {

class Context {
public:
  explicit Context(std::span<const GpgpAxiom> axioms) : axioms_(axioms) {}

  uint32_t phase() const { return phase_; }
  /// Registers a shape.
  void add(shader::Shape& shape, uint32_t tag);
  /// Whether it meets a collider of a phase before this one.
  bool collides(const shader::Shape& shape, uint32_t tag);
  /// Keeps a shape until begin() of a phase.
  void wait(const shader::Shape& shape, uint32_t phase) { waiting_.push_back({shape, phase}); }
  /// After all of the phase before: its colliders can be found. Returns the shapes that have waited for this phase.
  std::vector<shader::Shape> begin(uint32_t phase);

  /// The axiom's number for a Shape::axiom.
  uint32_t axiomNumber(uint32_t link) const {
    return link & shader::kColliderLink ? axiomOf_[link & ~shader::kColliderLink] : link;
  }
  uint64_t colliders() const { return colliders_.size(); }

private:
  struct Waiting {
    shader::Shape shape;
    uint32_t phase;
  };
  shader::ColliderBox boxOf(const shader::Shape& shape) const;

  std::span<const GpgpAxiom> axioms_;
  std::vector<shader::Collider> colliders_;
  std::vector<uint32_t> axiomOf_; // by collider
  std::vector<uint32_t> cells_{shader::kNoCollider};
  shader::ColliderSet set_{};
  std::vector<Waiting> waiting_;
  uint32_t phase_ = 0;
};

} // namespace gpgp::spawn
