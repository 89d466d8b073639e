// Random grammars that compile, for tests against the CPU evaluator.
#pragma once
#include <cstdint>
#include <string>

namespace gpgp::test {

/// The same text for the same seed. Uses every operator; rules lead to later rules, some back to earlier ones behind a
/// test that ends the recursion.
std::string randomGrammar(uint32_t seed);

} // namespace gpgp::test
