// The CPU reference: the shaders' functions of rewriting and of the turtle, run one module after the other.
#pragma once
#include "spawn/lsystem/table.h"
#include "spawn/lsystem/turtle.h"

#include <gpgp/spawn.h>

#include <span>
#include <string>
#include <vector>

namespace gpgp::spawn::lsystem {

/// A string of modules with their parameters.
struct String {
  std::vector<shader::uvec4> modules;
  std::vector<float> parameters;
};

struct Limits {
  uint32_t modules = 1u << 26, parameters = 1u << 27;
};

struct Derived {
  String string;
  uint32_t steps = 0;         ///< that were taken
  bool complete = true;       ///< false: the next step did not fit the limits; the string is the last that did
  uint64_t modulesNeeded = 0; ///< the most of a step, the one that did not fit included
  uint64_t parametersNeeded = 0;
};

/// The string that derivation begins with: for each axiom, in brackets, its number and the axiom's string.
String startOf(const Table& table, std::span<const GpgpAxiom> axioms);
Derived derive(const Table& table, std::span<const GpgpAxiom> axioms, uint32_t iterations, const Limits& limits = {});

/// One step. The string as it is where the result would not fit; needed says what would have.
bool rewrite(const Table& table, String& string, uint32_t phase, uint32_t step, const Limits& limits,
             uint64_t& modulesNeeded, uint64_t& parametersNeeded);

struct Drawn {
  std::vector<GpgpInstance> instances;       ///< by terminal, in each in the order of the string
  std::vector<std::array<float, 4>> corners; ///< of polygons, then sections of cylinders: place and width
  uint32_t depth = 0;                        ///< brackets around the deepest module
};
/// What the turtle draws of a string.
Drawn draw(const Table& table, const String& string, std::span<const GpgpAxiom> axioms);

/// GpgpLsystemReport::stringHash of a string.
std::array<uint32_t, 2> hashOf(const Table& table, const String& string);

/// The string as text, without the brackets and the number of each axiom; axioms are divided by line breaks.
std::string print(const Table& table, const String& string);

} // namespace gpgp::spawn::lsystem
