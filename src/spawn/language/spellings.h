// How the operators of PGA-shape are written: by the names of the table, and in some ways that graphs do not know.
#pragma once
#include "spawn/graph/operator_info.h"

#include <algorithm>
#include <array>
#include <string>

namespace gpgp::spawn {

struct Spelling {
  const char* name;
  GpgpOperatorKind kind;
};
inline constexpr std::array kOtherSpellings{
    Spelling{"Discard", GPGP_OPERATOR_DISCARD},
    Spelling{"Generate", GPGP_OPERATOR_GENERATE},
    Spelling{"SetAsDynamicConvexPolygon", GPGP_OPERATOR_SET_AS_DYNAMIC_CONVEX_POLYGON},
    Spelling{"SetAsDynamicConcavePolygon", GPGP_OPERATOR_SET_AS_DYNAMIC_CONCAVE_POLYGON},
    Spelling{"SetAsDynamicConvexRightPrism", GPGP_OPERATOR_SET_AS_DYNAMIC_CONVEX_RIGHT_PRISM},
    Spelling{"SetAsDynamicConcaveRightPrism", GPGP_OPERATOR_SET_AS_DYNAMIC_CONCAVE_RIGHT_PRISM}};
constexpr size_t kWritten = std::count_if(std::begin(kOperators), std::end(kOperators),
                                          [](const Operator& op) { return op.kind != kNotWritten; });
/// Of all operators.
inline constexpr auto kSpellings = [] {
  std::array<Spelling, kWritten + kOtherSpellings.size()> all{};
  size_t count = 0;
  for (const Operator& op : kOperators)
    if (op.kind != kNotWritten) all[count++] = {op.name, op.kind};
  for (const Spelling& spelling : kOtherSpellings) all[count++] = spelling;
  return all;
}();

/// The operator of the table that is written so, or NULL.
inline const Operator* operatorWritten(const std::string& name) {
  for (const Operator& op : kOperators)
    if (op.kind != kNotWritten && name == op.name) return &op;
  return nullptr;
}
inline bool isOperatorName(const std::string& name) {
  return std::any_of(kSpellings.begin(), kSpellings.end(), [&](const Spelling& s) { return name == s.name; });
}
/// Calls for the name of each function that a value can be.
template <class Call> void forFunctionNames(const Call& call) {
  call("Exp");
  for (const Binary& binary : kBinaries)
    if (!binary.precedence) call(binary.spelling);
  call(GPGP_FIELD_SPELLING);
  for (const Attribute& attribute : kAttributes) call(attribute.name);
}

} // namespace gpgp::spawn
