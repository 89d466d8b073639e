// Code in L-systems: blocks of C-like statements, and what they leave of a module.
//
// Nothing of it runs when strings are rewritten. A block is executed once, when the file is compiled, with names for
// the values of modules: conditions of which the value is known are decided, loops are unrolled, and every way through
// the block ends with values in terms of the module's parameters, under conditions.
#pragma once
#include "spawn/lsystem/syntax.h"

#include <functional>
#include <set>
#include <span>

namespace gpgp::spawn::lsystem {

struct Statement {
  enum class Kind {
    assign,  ///< name (an element of an array where there is an index) = value
    choose,  ///< if (value) first else second
    loop,    ///< while (value) { first; second }
    produce, ///< modules; the end of the way where isLast
    block,   ///< first
    stop,    ///< continue, break or return
    nothing
  } kind = Kind::nothing;
  enum class Stop { none, next, loop, all } stop = Stop::none;
  Place place;
  std::string name;
  std::optional<Expression> index;
  Expression value;
  bool hasValue = false;  ///< of a return
  bool isWhole = false;   ///< of an assignment: to an integer
  bool declares = false;  ///< the name is local from here
  bool testsLast = false; ///< of a loop: do ... while
  bool isLast = false;
  ModuleString modules;
  std::vector<Statement> first, second;
};

/// What a file has declared that expressions may name besides parameters and constants.
struct Declared {
  struct Function {
    std::vector<std::string> parameters;
    Expression value;
  };
  bool isC = false;                                    ///< L+C: integers, and angles of functions in radians
  std::map<std::string, std::vector<uint32_t>> arrays; ///< extents; elements are constants name[i], or name[i][j]
  std::map<std::string, Function> functions;
  std::set<std::string> whole; ///< integers
};

/// The name of an array's element, as a constant.
std::string elementName(const std::string& array, uint32_t index);

/// A way through a block: the values of names, and the modules that it made, where the conditions hold.
struct Way {
  std::vector<Expression> conditions;
  std::map<std::string, Expression> values;
  ModuleString modules;
  Statement::Stop stop = Statement::Stop::none;
  std::optional<Expression> result;
};

class Execution {
public:
  /// constants: of the file so far. What a block refuses is reported with its place.
  Execution(Diagnostics& diagnostics, const std::map<std::string, float>& constants)
      : diagnostics_(diagnostics), constants_(constants) {}

  /// Ways that pass the block's end. Those that end in it, by produce or return, are handed to `ended`; without it,
  /// there is one way, and conditions make values.
  std::vector<Way> run(std::span<const Statement> block, Way from, const std::function<void(Way&&)>& ended = nullptr);

  /// The value of an expression of numbers and constants. drawsNumbers: of random ones as well.
  std::optional<float> valueOf(const Expression& e);

  /// Random numbers become numbers, of the seed; for code that runs once.
  void drawNumbers(uint32_t seed) {
    drawsNumbers_ = true;
    seed_ = seed;
  }
  /// Variables of the file: a change of one in a production is seen by nothing else, and is named.
  void guard(std::set<std::string> variables) { guarded_ = std::move(variables); }

private:
  std::vector<Way> all(std::span<const Statement> block, std::vector<Way> ways);
  std::vector<Way> one(const Statement& s, Way way);
  std::vector<Way> choose(const Statement& s, Way way);
  std::vector<Way> loop(const Statement& s, Way way);
  void assign(const Statement& s, Way& way);
  Expression settled(const Expression& e, const Way& way);
  bool fits(const Expression& e);

  Diagnostics& diagnostics_;
  const std::map<std::string, float>& constants_;
  std::function<void(Way&&)> ended_;
  std::set<std::string> guarded_;
  std::set<std::string> named_; ///< of these, those that a warning named
  bool drawsNumbers_ = false, failed_ = false;
  uint32_t seed_ = 0, draws_ = 0, turns_ = 0, ways_ = 0;
};

/// Takes what a block sets from the values that are known, into those of the start; 0 where it had none.
void takeChanging(std::span<const Statement> block, std::map<std::string, float>& values,
                  std::map<std::string, float>& start);

/// What code that runs before and behind every step makes of values, from the numbers that they have at the start.
/// execution: makes an Execution for one run.
std::vector<Stepped> steppedValues(std::span<const Statement> before, std::span<const Statement> behind,
                                   float iterations, const std::map<std::string, float>& start,
                                   const std::function<Execution()>& execution);

} // namespace gpgp::spawn::lsystem
