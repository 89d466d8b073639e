#include "spawn/evaluator/evaluator.h"

#include <algorithm>
#include <limits>

namespace gpgp::spawn {
namespace {
using namespace shader;

/// Terminals in a Derivation; one range of axioms on one thread.
class Reference final : public Store {
public:
  Reference(std::span<const uint32_t> grammar, std::span<const GpgpAxiom> axioms, const DeriveOptions& options,
            Derivation& out)
      : axioms_(axioms), options_(options), out_(out), linked_(memory_), program_(decode(grammar.data(), memory_)),
        walker_(grammar.data(), program_, axioms, linked_, *this,
                {.maxDepth = options.maxDepth,
                 .keeps = options.keepInstances,
                 .vertices = options.vertices,
                 .view = options.view,
                 .fields = options.fields},
                out.buckets.data(), memory_) {}

  void run(uint32_t phases) {
    for (uint32_t a = 0; a < axioms_.size() && out_.complete; ++a) walker_.deriveAxiom(a);
    for (uint32_t phase = 1; phase < phases && out_.complete; ++phase) {
      walker_.context.publish(linked_);
      linked_.link();
      for (const Shape& shape : walker_.context.begin(phase))
        if (out_.complete) walker_.deriveShape(shape);
    }
    walker_.context.publish(linked_);
    out_.colliders = linked_.colliders.size();
    static_cast<Counts&>(out_) = walker_.counts;
  }

  void makeRoom(GpgpInstance*& next, GpgpInstance*& end) override {
    const size_t used = next ? static_cast<size_t>(next - out_.instances.data()) : 0;
    out_.instances.resize(std::max({out_.instances.size(), 2 * used, size_t{64}}));
    next = out_.instances.data() + used;
    end = out_.instances.data() + out_.instances.size();
  }
  uint32_t* addVertices(uint32_t quads, size_t words) override {
    out_.quads.push_back(quads);
    out_.vertexWords.resize(out_.vertexWords.size() + words);
    return out_.vertexWords.data() + out_.vertexWords.size() - words;
  }
  uint64_t goesOn(uint64_t shapes, uint32_t axiom) override {
    if (shapes < options_.maxShapes) return options_.maxShapes;
    out_.complete = false;
    out_.lastAxiom = axiom;
    return 0;
  }

private:
  std::pmr::memory_resource* const memory_ = std::pmr::new_delete_resource();
  const std::span<const GpgpAxiom> axioms_;
  const DeriveOptions& options_;
  Derivation& out_;
  LinkedColliders linked_;
  const Program program_;
  Walker walker_;
};
} // namespace

Derivation derive(std::span<const uint32_t> grammar, std::span<const GpgpAxiom> axioms, const DeriveOptions& options,
                  Derivation&& memory) {
  Derivation out;
  out.instances = std::move(memory.instances);
  out.buckets.assign(grammar[kHeaderBuckets], 0);
  Reference(grammar, axioms, options, out).run(grammar[kHeaderPhases]);
  out.instances.resize(options.keepInstances ? out.terminals : 0);
  return out;
}

GpgpAxiom makeAxiom(float x, float y, float z, uint32_t seed, uint32_t id) {
  GpgpAxiom axiom{};
  axiom.transform[0] = axiom.transform[5] = axiom.transform[10] = 1;
  axiom.size[0] = x;
  axiom.size[1] = y;
  axiom.size[2] = z;
  axiom.seed = seed;
  axiom.id = id;
  axiom.start = GPGP_AXIOM_DEFAULT_START;
  axiom.attribute = std::numeric_limits<float>::quiet_NaN();
  return axiom;
}

} // namespace gpgp::spawn
