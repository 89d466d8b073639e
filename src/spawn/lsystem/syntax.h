// What a .lsys file says, before names are resolved.
#pragma once
#include "spawn/language/diagnostics.h"

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gpgp::spawn::lsystem {

constexpr uint32_t kSharedDraw = 0x80000000u; ///< of a draw: all productions of a block share it

struct Expression {
  enum class Kind { number, name, operation } kind = Kind::number;
  float number = 0;
  std::string name;     ///< of a parameter or constant; of the function that draws
  uint32_t code = 0;    ///< kLsys..., of an operation
  uint32_t draw = 0;    ///< above 0: of a random number that several places of a production share
  bool isWhole = false; ///< an integer of C: its division drops the rest
  std::vector<Expression> operands;
  Place place;
};
inline Expression operation(uint32_t code, Place place, std::vector<Expression> operands) {
  Expression e;
  e.kind = Expression::Kind::operation;
  e.code = code;
  e.operands = std::move(operands);
  e.place = place;
  return e;
}

/// A module of a string, or of a predecessor or context, where arguments are names.
struct Module {
  std::string name;   ///< '?' before that of a sub-system
  std::string system; ///< whose productions rewrite it, where that is another one than the string's
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

/// A value that code changes from step to step: after the start, then in each iteration, then at the end.
struct Stepped {
  std::string name;
  std::vector<float> values;
};

struct Settings { ///< numbers of the file's head; each may be an expression of constants
  std::optional<Expression> iterations, decompositions, homomorphisms, seed, angle, step, width, taper;
  std::array<std::optional<Expression>, 4> tropism;
};

struct File {
  Settings settings;
  std::vector<Constant> constants;
  std::vector<Stepped> stepped;
  std::vector<System> systems; ///< the first is the main one
  std::vector<std::string> ignored, considered;
  bool considers = false;
  bool isOfModeller = false; ///< for cpfg or lpfg: a polygon may begin and end in different strings
  std::vector<Asset> assets;
  std::vector<std::pair<std::string, Place>> drawing, moving; ///< letters that act as F and f
  uint32_t segmentShape = 0;                                  ///< GpgpShape
};

/// Replaces names by values, in all of an expression.
void substitute(Expression& e, const std::map<std::string, Expression>& values);

/// New value for a constant, or for one of iterations, angle, step, width and seed.
struct Override {
  std::string_view name;
  float value;
};
/// The text of a file that an #include names; false where there is none.
using ReadFile = std::function<bool(const std::string& path, std::string& text)>;

/// Parses a file. What is no line of one is reported and left out. start: of a file that has several systems with
/// names, the one to read; empty: the first.
File parse(std::string_view text, Diagnostics& diagnostics, std::span<const Override> overrides = {},
           const ReadFile& read = {}, std::string_view start = {});

/// Whether a file is one of Fractint's, which has entries with an axiom: Koch { Angle 6 Axiom F--F--F F=F+F--F+F }.
bool isOfFractint(std::string_view text);
File parseFractint(std::string_view text, Diagnostics& diagnostics, std::string_view start);

/// Whether a file is in L+C, the language of lpfg: it includes lpfgall.h, or has modules that are declared and
/// produced.
bool isOfLpfg(std::string_view text);
File parseLpfg(std::string_view text, Diagnostics& diagnostics, std::span<const Override> overrides,
               const ReadFile& read);

/// Whether a file is one of L-Py: it has a line that begins with "Axiom:", and a line "production:" or one of Python.
bool isOfLpy(std::string_view text);
File parseLpy(std::string_view text, Diagnostics& diagnostics, std::span<const Override> overrides);

/// What the sub-system of a number is called.
std::string numberedSystem(uint32_t number);

/// The turtle command of a symbol by its name, kTurtleNone for others. 'g' and names of several letters have none.
uint32_t turtleOf(std::string_view name);

} // namespace gpgp::spawn::lsystem
