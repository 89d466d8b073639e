// What a .lsys file says, before names are resolved.
#pragma once
#include "spawn/language/diagnostics.h"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gpgp::spawn::lsystem {

struct Expression {
  enum class Kind { number, name, operation } kind = Kind::number;
  float number = 0;
  std::string name;  ///< of a parameter or constant; of the function that draws
  uint32_t code = 0; ///< kLsys..., of an operation
  std::vector<Expression> operands;
  Place place;
};

/// A module of a string, or of a predecessor or context, where arguments are names.
struct Module {
  std::string name; ///< '?' before that of a sub-system
  std::vector<Expression> arguments;
  Place place;
};
using ModuleString = std::vector<Module>;

struct Production {
  std::optional<ModuleString> left, right;
  Module predecessor;
  std::optional<Expression> condition, probability;
  ModuleString successor;
  uint32_t phase = 0; ///< kPhase...
  Place place;
};

/// The system itself, or a sub-system with a name and parameters.
struct System {
  std::string name;
  std::vector<std::string> parameters;
  std::optional<ModuleString> axiom;
  std::vector<Production> productions;
  Place place;
};

struct Asset {
  std::string symbol, name;
  uint32_t shape = 0; ///< GpgpShape
  Place place;
};

struct Constant {
  std::string name;
  Expression value;
  Place place;
};

struct Settings { ///< numbers of the file's head; each may be an expression of constants
  std::optional<Expression> iterations, decompositions, homomorphisms, seed, angle, step, width, taper;
  std::array<std::optional<Expression>, 4> tropism;
};

struct File {
  Settings settings;
  std::vector<Constant> constants;
  std::vector<System> systems; ///< the first is the main one
  std::vector<std::string> ignored, considered;
  bool considers = false;
  std::vector<Asset> assets;
  std::vector<std::pair<std::string, Place>> drawing, moving; ///< letters that act as F and f
  uint32_t segmentShape = 0;                                  ///< GpgpShape
};

/// Parses a file. What is no line of one is reported and left out.
File parse(std::string_view text, Diagnostics& diagnostics);

/// The turtle command of a symbol by its name, kTurtleNone for others. 'g' and names of several letters have none.
uint32_t turtleOf(std::string_view name);

} // namespace gpgp::spawn::lsystem
