// Collider and IfCollides on the CPU: the colliders that queries find, and what a range of axioms adds to them.
#pragma once
#include "spawn/colliders/collide.h"

#include <gpgp/spawn.h>

#include <memory_resource>
#include <span>
#include <vector>

namespace gpgp::spawn {

/// The colliders of all phases before the current one.
struct LinkedColliders {
  explicit LinkedColliders(std::pmr::memory_resource* memory)
      : colliders(memory), axiomOf(memory), cells(1, shader::kNoCollider, memory) {}

  /// Between two phases: all that are there can be found from now on.
  void link();

  std::pmr::vector<shader::Collider> colliders;
  std::pmr::vector<uint32_t> axiomOf; ///< by collider
  std::pmr::vector<uint32_t> cells;
  shader::ColliderSet set{};
};

/// What a range of axioms adds in a phase, and its shapes that wait for later phases.
class Context {
public:
  Context(std::span<const GpgpAxiom> axioms, const LinkedColliders& linked, std::pmr::memory_resource* memory)
      : axioms_(axioms), linked_(linked), colliders_(memory), axiomOf_(memory), waiting_(memory) {}

  uint32_t phase() const { return phase_; }
  /// Registers a shape.
  void add(shader::Shape& shape, uint32_t tag);
  /// Whether it meets a collider of a phase before this one.
  bool collides(const shader::Shape& shape, uint32_t tag) const;
  /// Keeps a shape until begin() of a phase.
  void wait(const shader::Shape& shape, uint32_t phase) { waiting_.push_back({shape, phase}); }
  /// At the end of a phase, range after range: its colliders to the linked ones.
  void publish(LinkedColliders& linked);
  /// After link(). Returns the shapes that have waited for this phase, by axiom.
  std::pmr::vector<shader::Shape> begin(uint32_t phase);

  /// The axiom's number for a Shape::axiom.
  uint32_t axiomNumber(uint32_t link) const {
    if (!(link & shader::kColliderLink)) return link;
    const uint32_t collider = link & ~shader::kColliderLink, linked = linked_.set.linked;
    return collider < linked ? linked_.axiomOf[collider] : axiomOf_[collider - linked];
  }

private:
  struct Waiting {
    shader::Shape shape;
    uint32_t phase;
  };
  shader::ColliderBox boxOf(const shader::Shape& shape) const;

  std::span<const GpgpAxiom> axioms_;
  const LinkedColliders& linked_;
  // Of this phase. They are numbered from the linked ones on, until publish() knows how many other ranges have.
  std::pmr::vector<shader::Collider> colliders_;
  std::pmr::vector<uint32_t> axiomOf_;
  std::pmr::vector<Waiting> waiting_;
  uint32_t phase_ = 0;
};

} // namespace gpgp::spawn
