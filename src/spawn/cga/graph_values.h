// Values of a CGA program as operator graphs can have them: worked out where they are known, else formulas of the
// shape's sizes, of numbers that the shape draws, and of numbers that its axiom has.
#pragma once
#include "spawn/cga/strings.h"
#include "spawn/shared/expression.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace gpgp::spawn::cga {

struct Formula;
using FormulaPtr = std::shared_ptr<const Formula>;

/// A number. What it reads of a shape is that of the shape where it is used: who keeps one sees to that.
struct Formula {
  enum class Kind : uint8_t { number, size, axiom, draw, field, binary };
  Kind kind = Kind::number;
  float value = 0;         ///< number
  uint32_t index = 0;      ///< size: the axis; draw: which one of its operation; binary: kCode
  FormulaPtr a, b;         ///< binary; field: x and z from the shape's centre, or none
  std::string name;        ///< field
  bool isOfPlace = false;  ///< a field is read where the shape is
  uint32_t sizes = 0;      ///< bits: axes of which a size is read
  bool draws = false;      ///< numbers
  bool isBoolean = false;  ///< 0 or 1
  uint32_t stack = 1;      ///< values at once
  uint32_t length = 1;     ///< codes
  float low = 0, high = 0; ///< bounds

  bool isNumber() const { return kind == Kind::number; }
};

FormulaPtr number(float value, bool isBoolean = false);
FormulaPtr sizeOf(uint32_t axis);
/// Number index of those that every axiom has, from its seed, in [0, 1).
FormulaPtr axiomNumber(uint32_t index);
FormulaPtr drawn(uint32_t index);
/// A field of the world at the shape's centre, or x and z from there. None: it would be too long.
FormulaPtr fieldOf(const std::string& name, const FormulaPtr& x, const FormulaPtr& z);
/// In the machine's arithmetic, known values worked out. None: it would be too long for a graph.
FormulaPtr combined(uint32_t code, const FormulaPtr& a, const FormulaPtr& b);
/// condition ? yes : no, of which none draws.
FormulaPtr selected(const FormulaPtr& condition, const FormulaPtr& yes, const FormulaPtr& no);
FormulaPtr notOf(const FormulaPtr& condition);
/// 1 where a value is not 0.
FormulaPtr asBoolean(const FormulaPtr& a);
/// At least 0.
FormulaPtr clamped(const FormulaPtr& a);
/// With other axes: the new one of each old one, 3: none, and then the result is none.
FormulaPtr renamed(const FormulaPtr& a, const std::array<uint32_t, 3>& axes);
/// As PGA-shape writes it.
std::string text(const FormulaPtr& a);
std::string text(float value);
/// Whether numbers are drawn in the order 0, 1, ... in the text, each once, so many in all.
bool drawsInOrder(const FormulaPtr& a, uint32_t count);

/// Whatever a program computes with.
struct Value {
  enum class Kind : uint8_t { number, string, choice, drawn, relative, floating };
  Kind kind = Kind::number;
  FormulaPtr formula;         ///< number, relative, floating; choice: its condition
  std::string string;         ///< string
  std::vector<Value> values;  ///< choice: two; drawn: one for each chance
  std::vector<float> chances; ///< drawn: percent
};

} // namespace gpgp::spawn::cga
