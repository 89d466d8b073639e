// How the operators of PGA-shape are written.
#pragma once
#include "spawn/shared/graph_format.h"

#include <algorithm>
#include <array>
#include <string>

namespace gpgp::spawn {

/// Parameters: axes and modes come first, then values.
struct Spelling {
  const char* name;
  uint32_t op;
  const char* arguments; ///< one letter each: a axis, m mode, t tag, v value
  uint32_t branches;     ///< 1: one successor, 2 or 3: exactly, kMany: any number
  bool labels;           ///< value: successor
};
constexpr uint32_t kMany = UINT32_MAX;
constexpr Spelling kSpellings[] = {
    {"Translate", shader::kOpTranslate, "vvv", 1, false},
    {"Rotate", shader::kOpRotate, "vvv", 1, false},
    {"Scale", shader::kOpScale, "vvv", 1, false},
    {"Extrude", shader::kOpExtrude, "v", 1, false},
    {"SwapSize", shader::kOpSwapSize, "aaa", 1, false},
    {"Collider", shader::kOpCollider, "t", 1, false},
    {"IfCollides", shader::kOpIfCollides, "t", 2, false},
    {"CompSplit", shader::kOpCompSplit, "", 3, false},
    {"SubDiv", shader::kOpSubDiv, "a", kMany, true},
    {"Repeat", shader::kOpRepeat, "avm", 1, false},
    {"If", shader::kOpIf, "v", 2, false},
    {"IfSizeLess", shader::kOpIfSizeLess, "av", 2, false},
    {"RandomRule", shader::kOpRandomRule, "v", kMany, true},
    {"Replicate", shader::kOpReplicate, "", kMany, false},
};
constexpr std::array<const char*, 6> kOtherOperators{"Discard",
                                                     "Generate",
                                                     "SetAsDynamicConvexPolygon",
                                                     "SetAsDynamicConcavePolygon",
                                                     "SetAsDynamicConvexRightPrism",
                                                     "SetAsDynamicConcaveRightPrism"};
constexpr std::array<const char*, 8> kFunctions{"Exp",           "Rand",        "ShapePos",  "ShapeSize",
                                                "ShapeRotation", "ShapeNormal", "ShapeSeed", "ShapeCustomAttribute"};
/// Calls for each operator's name.
template <class Call> void forOperatorNames(const Call& call) {
  for (const Spelling& spelling : kSpellings) call(spelling.name);
  for (const char* name : kOtherOperators) call(name);
}
inline bool isOperatorName(const std::string& name) {
  return std::any_of(std::begin(kSpellings), std::end(kSpellings), [&](const Spelling& s) { return name == s.name; }) ||
         std::any_of(kOtherOperators.begin(), kOtherOperators.end(), [&](const char* s) { return name == s; });
}

} // namespace gpgp::spawn
