// What the stack of the stack language holds.
//
// Shapes are abstract: they stand for each shape that will take this way through the operator graph. Numbers are known,
// or a formula of what the shape will be, which the graph computes for each shape.
#pragma once
#include "spawn/language/syntax.h"

#include <array>
#include <memory>
#include <variant>
#include <vector>

namespace gpgp::spawn::gml {

/// What of a shape a formula can read, and operators change separately.
enum Quality : uint8_t { kPosition, kSize, kRotation, kSeed, kQualityCount, kNeverChanges = kQualityCount };

/// A formula reads a quality as it was when it had this version.
struct Read {
  Quality quality = kPosition;
  uint32_t version = 0;
  Place place;
};
struct Draw {
  uint32_t number = 0; ///< of all random numbers of the program
  Place place;
};
struct Formula {
  Expression expression;
  uint32_t size = 1; ///< numbers in it
  std::vector<Read> reads;
  std::vector<Draw> draws;
};
struct Number {
  float known = 0;
  std::shared_ptr<const Formula> formula; ///< instead
};

struct Vector {
  std::array<Number, 3> components;
  uint32_t size = 3; ///< 2 or 3
};

/// An edge of the graph that leads nowhere yet, or the entry of a rule.
struct End {
  uint32_t node = 0, edge = 0;
  bool isRule = false;
};
struct ShapeState {
  std::vector<End> ends; ///< none: no shape comes here
  std::array<uint32_t, kQualityCount> versions{};
  uint32_t branch = 0; ///< the branch on a shape's size in which it may be taken
  uint32_t rule = 0;   ///< of the graph, in whose body it is
};
using Shape = std::shared_ptr<const ShapeState>;

struct Array;
struct Broken {}; ///< the result of an error, which was reported
struct Mark {};
struct Forgotten {}; ///< what a name stood for before a branch that depends on a shape stored something else there
struct Text {
  std::shared_ptr<const std::string> text;
};
struct Name {
  uint32_t name = 0;
};
struct Procedure {
  uint32_t procedure = 0;
};
struct Dictionary {
  uint32_t dictionary = 0;
};
struct RuleName {
  uint32_t rule = 0;
};
struct TerminalName {
  uint32_t terminal = 0;
};
using Items = std::shared_ptr<const Array>;
using Value = std::variant<Broken, Number, std::shared_ptr<const Vector>, Text, Name, Items, Procedure, Dictionary,
                           Shape, Mark, RuleName, TerminalName, Forgotten>;

/// Arrays do not change: what alters one makes another.
struct Array {
  std::vector<Value> items;
  uint32_t total = 0;     ///< items, and theirs
  uint32_t depth = 1;     ///< of arrays in arrays
  bool hasShapes = false; ///< somewhere inside
};

/// As in "found a number".
const char* kindOf(const Value& value);

} // namespace gpgp::spawn::gml
