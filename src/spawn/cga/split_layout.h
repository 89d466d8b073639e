// Where the parts of a split lie: sizes that are absolute, relative ('), floating (~), nested groups, repeats (*).
//
// What is absolute or relative has its size. Floating sizes share what is left, in proportion. Each repeated group is
// there as often as stretches floating sizes least; without such, as often as it fits whole, and at least once. What
// lies beyond the end is cut off; sizes of 0 and less give no part.
#pragma once
#include "spawn/cga/program_format.h"
#include "spawn/shared/operators.h"

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
  float extent = 0;           ///< of layOutPlain(): to - from, but for rounding
  shader::uvec2 key = {0, 0}; ///< of layOutPlain(): of the path
};

/// The parts of a table (program_format.h); values: of the block. 'x is a part of whole. Records of values are left
/// out.
std::vector<SplitPart> readParts(const uint32_t* words, uint32_t table, const shader::CgaValue* values, float whole);

/// False: there are more than most pieces.
bool layOut(const std::vector<SplitPart>& parts, float length, size_t most, std::vector<Piece>& pieces);

/// The same by the operators of operator graphs, SubDiv and Repeat, so that a graph cuts the same parts to the last bit
/// and draws the same random numbers for them. False where the parts are none that they cut: several groups, groups
/// beside floating sizes, groups in groups; or where there are more than most pieces. key: of the shape.
bool layOutPlain(const std::vector<SplitPart>& parts, float length, shader::uvec2 key, size_t most,
                 std::vector<Piece>& pieces);

/// How often a repeated group is there whose sizes are fixed and floating in all. floating: > 0
float repetitions(float length, float fixed, float floating);

} // namespace gpgp::spawn::cga
