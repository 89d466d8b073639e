// The walk through an operator graph on the CPU: depth first, on one thread, with the operators of the GPU.
#pragma once
#include "spawn/evaluator/context.h"
#include "spawn/evaluator/program.h"
#include "spawn/schedule/fields.h"
#include "spawn/schedule/vertices.h"

#include <gpgp/spawn.h>

#include <cstdint>
#include <limits>
#include <memory_resource>
#include <span>
#include <vector>

namespace gpgp::spawn {

/// What a walk has counted.
struct Counts {
  uint64_t terminals = 0;
  uint64_t shapes = 0;        ///< that were taken up, terminals included
  uint32_t droppedShapes = 0; ///< axioms whose rule does not exist, shapes that a Repeat would cut too often, and
  uint32_t uncutShapes = 0;   ///< those that a SubDiv cannot cut
  uint32_t unfinishedShapes = 0;
  uint32_t depth = 0; ///< the most recursive edges on a path
  uint32_t keyHash[2] = {0, 0};
};

/// Where a walk puts terminals, and who ends it.
class Store {
public:
  /// [next, end) becomes room for at least one instance. What was written before `next` stays.
  virtual void makeRoom(GpgpInstance*& next, GpgpInstance*& end) = 0;
  /// Words for the vertices of the instance that was written last, as 4 vertices a quad.
  virtual uint32_t* addVertices(uint32_t quads, size_t words) = 0;
  /// The number of shapes after which to ask again, or 0: the walk ends, before a shape of this axiom.
  virtual uint64_t goesOn(uint64_t shapes, uint32_t axiom) = 0;

protected:
  ~Store() = default;
};

/// Which terminals are kept. All are counted.
class Filter {
public:
  virtual bool keeps(const GpgpInstance& instance) const = 0;

protected:
  ~Filter() = default;
};

struct WalkOptions {
  uint32_t maxDepth = 64;
  bool keeps = true; ///< false: only count
  const Filter* filter = nullptr;
  const VertexLayout* vertices = nullptr;
  const shader::View* view = nullptr;  ///< of the camera; null: there is none
  const BoundFields* fields = nullptr; ///< in host memory; null: the grammar reads none
};

/// A shape before the operator that step says; where that multiplies it, what it makes of it.
struct Frame {
  shader::Shape shape;
  const Step* step;
  shader::Fan fan;
  uint32_t made; // of its children
  uint32_t left; // successors that still get one
  // SubDiv whose parts are not constant: the sum of its weights; of parts before one, its number and their lengths.
  float weights, fixedBefore, weightBefore;
  uint32_t summed;
};

/// Depth first with a stack of shapes whose children are made one at a time, each when the one before it is done.
class Walker final : shader::FieldReader {
public:
  /// buckets: counts terminals by bucket; may be null. What is named must outlive the walker.
  Walker(const uint32_t* words, const Program& program, std::span<const GpgpAxiom> axioms,
         const LinkedColliders& linked, Store& store, const WalkOptions& options, uint32_t* buckets,
         std::pmr::memory_resource* memory)
      : context(axioms, linked, memory), words_(words), program_(program), axioms_(axioms), store_(store),
        options_(options), buckets_(buckets), frames_(64, memory) {}

  /// In phase 0.
  void deriveAxiom(uint32_t number);
  /// In a later phase, what has waited for it.
  void deriveShape(const shader::Shape& start);

  Context context;
  Counts counts;
  /// Where the next instance goes.
  GpgpInstance *next = nullptr, *end = nullptr;
  uint64_t limit = 0; ///< of counts.shapes, until the store is asked

private:
  float value(const Step& step, const shader::Shape& s, uint32_t i) const;
  float expression(const shader::Shape& s, const Step& step, uint32_t terms, uint32_t index) const;
  float operand(const Term& term, const shader::Shape& s) const;
  shader::Seen seen(const shader::Shape& s) const;
  float read(const shader::Shape& s, uint32_t field, float x, float z) const override;
  const shader::FieldReader* fieldReader() const { return options_.fields ? this : nullptr; }
  float evaluateWords(const shader::Shape& s, uint32_t at, uint32_t index) const;
  shader::vec2 angle(const Step& step, const shader::Shape& s, uint32_t i) const;
  shader::vec3 values(const Step& step, const shader::Shape& s) const;
  const Step* follow(shader::Shape& s, const Way& way);
  uint32_t runChain(Frame& frame);
  uint32_t wait(Frame& frame);
  shader::Fan fanOf(Frame& frame) const;
  float length(const Step& step, const shader::Shape& s, uint32_t part) const;
  shader::Fan divide(Frame& frame) const;
  shader::Part nextPart(Frame& frame, const shader::Shape& s, uint32_t number) const;
  const Step* toChild(Frame& frame, shader::Shape& s);
  void emit(const Frame& frame);
  void emitVertices(const shader::Shape& shape, const GpgpInstance& instance);

  const uint32_t* const words_;
  const Program& program_;
  const std::span<const GpgpAxiom> axioms_;
  Store& store_;
  const WalkOptions options_;
  uint32_t* const buckets_;
  const Step unfinished_{.op = kUnfinished};
  std::pmr::vector<Frame> frames_;
};

} // namespace gpgp::spawn
