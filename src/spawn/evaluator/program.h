// A grammar's words decoded for the evaluator: what a node needs side by side, and what is constant worked out.
#pragma once
#include "spawn/derive/interpret.h"

#include <memory_resource>
#include <vector>

namespace gpgp::spawn {

/// Beside the kOp values: what discards every shape, and cases whose constants save work.
enum : uint32_t {
  kDiscard = shader::kOpCount,
  kUnfinished,
  kTranslateAlong,
  kRotateBy,
  kRotateAngles,
  kChoose,
  kDivide
};

struct Step;

struct Way { ///< along an edge
  const Step* target;
  uint32_t recursive; ///< 1: counts as depth
  float from;         ///< kChoose: it is taken from this value on, unless a later one is
  shader::Part part;  ///< kDivide
  float length;       ///< SubDiv whose parts are not all constant: this one's, where terms is 0
  uint32_t terms;     ///< else: as Step::terms
};

/// What a term is, beside offsets of a Shape's floats.
enum : uint32_t { kNumber = 0xffffff00u, kSeed, kDrawn, kSeen };

/// Of an expression that goes from left to right: a number or an attribute, and how it joins what stands before it.
struct Term {
  uint32_t code;   ///< kCodeAdd to kCodeRandom; kCodeEnd behind the last term
  uint32_t source; ///< offset in Shape, or: kNumber; kSeed: the seed's fraction; kDrawn: number + range * what it
                   ///< draws; from kSeen on: what the camera sees, as codes from kCodeView on
  float number, range;
  uint32_t draw; ///< of kDrawn or kCodeRandom: the number of what it draws
};
/// Instead of a place in Program::terms: what does not go from left to right, which evaluate() does.
constexpr uint32_t kNoTerms = UINT32_MAX;

struct Step {
  uint32_t op = kDiscard;
  uint32_t node = 0;   ///< word offset
  bool filter = false; ///< kNodeFilter
  bool draws = false;  ///< kNodeDraws
  bool sees = false;   ///< a parameter asks the camera
  bool cuts = false;   ///< SubDiv to which shapes can come that it cuts
  uint32_t argument = 0, argument2 = 0;
  const Way* ways = nullptr;
  uint32_t wayCount = 0;
  uint32_t successors = 0;     ///< bits: ways that do not discard; kDivide: without what needs a remainder
  uint32_t weighted = 0;       ///< kDivide: those that do
  uint32_t count = 0;          ///< of successors
  uint32_t allCount = 0;       ///< and of weighted
  uint32_t parameters = 0;     ///< word offset
  uint32_t variable = 0;       ///< bits: of the first three parameters those that are not constant
  uint32_t terms[3]{};         ///< of those: in Program::terms, or kNoTerms
  shader::vec3 values{0};      ///< of the others
  shader::Rotation rotation{}; ///< kRotateBy
  shader::vec2 angles[3]{};    ///< kRotateAngles: (sine, cosine) of what is constant
  float total = 0;             ///< kChoose: of all chances; kDivide: of fixed lengths
};

/// It may be moved, but not copied: steps point at ways, and ways at steps.
struct Program {
  explicit Program(std::pmr::memory_resource* memory) : steps(memory), ways(memory), terms(memory) {}
  Program(Program&&) = default;
  Program(const Program&) = delete;

  std::pmr::vector<Step> steps; ///< the first one discards, then the nodes
  std::pmr::vector<Way> ways;
  std::pmr::vector<Term> terms;

  const Step* at(uint32_t node) const {
    return node ? &steps[1 + (node - shader::kHeaderSize) / shader::kNodeSize] : steps.data();
  }
};

Program decode(const uint32_t* words, std::pmr::memory_resource* memory);

} // namespace gpgp::spawn
