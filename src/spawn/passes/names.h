// What the spawner's passes and its recordings name each other by: workgroup counts and conditions.
#pragma once
#include "core/recorder.h"

namespace gpgp::spawn {

enum Groups : uint32_t {
  kOneGroup,
  kAxiomGroups,
  kLinkGroups,
  kPartGroups,
  kExpandGroups,
  kRoundGroups,
  kBoundGroups,
  kMeasureGroups,
  kMeasuredGroups
};
/// kPhases and on: there are more phases than 1, 2 ...
enum Conditions : uint32_t {
  kSorted,
  kBucketed,
  kOrdered,
  kColliding,
  kExpanded,
  kPlaced,
  kBounded,
  kMeasured,
  kPhases
};

} // namespace gpgp::spawn
