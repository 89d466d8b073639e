// What engines and people see of a program's attributes.
#pragma once
#include "spawn/cga/derive.h"

#include <gpgp/cga.h>

#include <string>
#include <vector>

namespace gpgp::spawn::cga {

/// What the annotations of an attribute say. Numbers that none of them says are NaN, orders infinite.
struct AttributeDisplay {
  GpgpCgaAttributeFlags flags = 0;
  double min, max, step, groupOrder, order;
  std::vector<std::string> choices, groups, extensions;
  std::string description, name;
  std::string choicesFrom; ///< the attribute whose values the choices are
};
AttributeDisplay displayOf(const AttributeInfo& attribute);

/// An attr of a program with the value that it has on a lot of 1 x 1 metres with seed 1.
struct ListedAttribute {
  const AttributeInfo* info;
  FirstValue value;
  AttributeDisplay display;
};
/// All of them, file by file, in the order of their definitions.
std::vector<ListedAttribute> listAttributes(const Program& program);
GpgpCgaType typeOf(const FirstValue& value);

/// What names a field that is read and is not there, with its place; empty: all are there.
std::string missingField(const Program& program, const std::vector<WorldField>& fields);

/// Why a value cannot be set, after the attribute's name: ": it is a const, ..."; empty: it can.
std::string whyNotSet(const AttributeValue& value, const Program& program);

} // namespace gpgp::spawn::cga
