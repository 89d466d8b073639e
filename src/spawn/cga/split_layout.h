// Where the parts of a split lie: sizes that are absolute, relative ('), floating (~), nested groups, repeats (*).
//
// What is absolute or relative has its size. Floating sizes share what is left, in proportion. Each repeated group is
// there as often as stretches floating sizes least; without such, as often as it fits whole, and at least once. What
// lies beyond the end is cut off; sizes of 0 and less give no part.
#pragma once
#include "spawn/cga/program_format.h"

#include <vector>

namespace gpgp::spawn::cga {

struct SplitPart {
  enum class Kind : uint8_t { absolute, floating, group, repeated };
  Kind kind = Kind::absolute;
  float size = 0;               ///< relative ones were multiplied before
  uint32_t body = 0;            ///< the chunk that is run on it
  std::vector<SplitPart> parts; ///< of groups
};

struct Piece {
  float from, to;
  uint32_t body;
};

/// False: there are more than most pieces.
bool layOut(const std::vector<SplitPart>& parts, float length, size_t most, std::vector<Piece>& pieces);

} // namespace gpgp::spawn::cga
