// Random L-systems, as text and as plain data, and a rewriter of the latter that shares nothing with the library: a
// string is a tree of branches, and contexts are matched on that tree.
#pragma once
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace gpgp::test {

struct PlainModule {
  char name = 0;
  std::vector<int> values;
  bool operator==(const PlainModule&) const = default;
};
using PlainString = std::vector<PlainModule>;

/// A parameter of a successor: value of a variable (-1: none) times factor plus term.
struct PlainValue {
  int variable = -1, factor = 0, term = 0;
};
struct PlainMade {
  char name = 0;
  std::vector<PlainValue> values;
};
struct PlainProduction {
  std::string left, right; ///< letters; the right one has brackets too
  char name = 0;
  int least = 0, most = 0; ///< of the first variable, where there is one
  std::vector<PlainMade> made;
};
struct PlainSystem {
  int arity[4] = {}; ///< of A to D
  std::string ignored;
  std::vector<PlainMade> axiom;
  std::vector<PlainProduction> productions;
  int iterations = 0;

  std::string text() const;
  /// The string after some iterations; nothing where it gets longer than most.
  std::optional<PlainString> derive(int count, size_t most) const;
};

PlainSystem randomSystem(std::mt19937& random);
std::string print(const PlainString& string);

} // namespace gpgp::test
