// Operators between two values, and how tightly they bind.
#pragma once
#include <string_view>

namespace gpgp::spawn::cga {

struct OperatorLevel {
  std::string_view text;
  int level;
};
constexpr OperatorLevel kOperators[] = {{"||", 1},  {".||", 1}, {"&&", 2}, {".&&", 2}, {"==", 3}, {"!=", 3}, {".==", 3},
                                        {".!=", 3}, {"<", 4},   {"<=", 4}, {">", 4},   {">=", 4}, {".<", 4}, {".<=", 4},
                                        {".>", 4},  {".>=", 4}, {"+", 5},  {"-", 5},   {".+", 5}, {".-", 5}, {"*", 6},
                                        {"/", 6},   {"%", 6},   {".*", 6}, {"./", 6},  {".%", 6}};

} // namespace gpgp::spawn::cga
