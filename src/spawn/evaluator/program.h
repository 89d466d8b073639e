// A grammar's words decoded for the evaluator: what a node needs side by side, and what is constant worked out.
#pragma once
#include "spawn/interpret.h"

#include <vector>

namespace gpgp::spawn {

/// Beside the kOp values: what discards every shape, and cases whose constants save work.
enum : uint32_t { kDiscard = shader::kOpCount, kTranslateAlong, kRotateBy, kChoose };

struct Step {
  uint32_t op = kDiscard;
  bool filter = false; ///< kNodeFilter
  uint32_t argument = 0, argument2 = 0;
  const uint32_t* edges = nullptr; ///< in the words
  uint32_t successors = 0;         ///< bits: edges that do not discard
  uint32_t parameters = 0;         ///< word offset
  uint32_t variable = 0;           ///< bits: of the first three parameters those that are not constant
  shader::vec3 values{0};          ///< of the others
  shader::Rotation rotation{};     ///< kRotateBy
  uint32_t firstChance = 0, chanceCount = 0; ///< kChoose: in Program::chances
  float total = 0;                 ///< of all chances

  uint32_t target(uint32_t edge) const { return edges[edge * shader::kEdgeSize + shader::kEdgeTarget]; }
};

/// An edge of RandomRule, taken from a value on; later ones go before.
struct Chance {
  float from;
  uint32_t target;
};

struct Program {
  std::vector<Step> steps; ///< at their nodes' word offsets / kNodeSize
  std::vector<Chance> chances;
};

Program decode(const uint32_t* words);

} // namespace gpgp::spawn
