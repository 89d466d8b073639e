// A compiled .cga program: words for the machine (shaders/spawn/cga/machine.h), and tables for people and engines.
#pragma once
#include "spawn/cga/program_format.h"
#include "spawn/language/diagnostics.h"

#include <glm/vec4.hpp>
#include <optional>
#include <string>
#include <vector>

namespace gpgp::spawn::cga {

struct AnnotationValue {
  std::string name; ///< empty where it has none
  std::string text;
  std::optional<double> number; ///< where it is one
};
/// @Range(min=0, max=10) of an attribute, so that engines can show sliders.
struct AttributeAnnotation {
  std::string name;
  std::vector<AnnotationValue> values;
};

/// A value that an attribute is set to from outside; what it is taken for follows from its text: a number, true or
/// false, else a string.
struct AttributeValue {
  std::string name; ///< with the prefixes of imports
  std::string text;
};
/// The finite number that a text is; none where it is another.
std::optional<float> numberIn(const std::string& text);

/// What a terminal of a program's operator graph is.
struct GraphTerminal {
  std::string name; ///< of the rule that a shape ends in, or of the report
  glm::vec4 color{1};
  std::string texture, asset;
  bool isReport = false; ///< no shape: GpgpInstance::attribute is a value of the report
};
/// The operator graph that derives what a program derives, as PGA-shape. Axioms are boxes without height, the
/// rectangles that they stand on, with the attribute NaN.
struct GraphText {
  std::string text;                     ///< empty: there is none
  std::vector<GraphTerminal> terminals; ///< by index of the terminal lines, T0, T1, ...
  bool needsUpright = false;            ///< it is right for axioms whose y axis is the world's alone
  std::string why, file;                ///< without: which construct has no operator, and where
  Place place;
};

/// A slot of the attributes of a shape.
struct AttributeInfo {
  std::string name; ///< with the prefixes of imports: "Roof.angle"
  std::string file;
  Place place;
  bool isConstant = false;
  bool isMaterial = false; ///< material.name, which is no attribute of the file
  uint32_t chunk = 0;      ///< the function that computes its first value; 0: none
  std::vector<AttributeAnnotation> annotations;
};

struct RuleInfo {
  std::string name; ///< with the prefixes of imports
  std::string file;
  Place place;
  uint32_t parameters = 0, chunk = 0;
  bool isStart = false, isHidden = false;
};

/// A field of the world that is named by a string, Field("terrain").
struct FieldRead {
  std::string name, file;
  Place place;
};

/// Where the instruction at a word comes from.
struct SourceOf {
  uint32_t at = 0, file = 0;
  Place place;
};

struct Program {
  std::vector<uint32_t> words; ///< word 0 is no chunk
  std::vector<std::string> strings;
  std::vector<AttributeInfo> attributes; ///< by slot
  std::vector<uint32_t> order;           ///< slots that the start needs, each behind those that its value needs
  std::vector<uint32_t> wholeOrder;      ///< all slots, likewise
  std::vector<RuleInfo> rules;
  uint32_t start = 0; ///< of rules
  std::vector<std::string> files;
  std::vector<SourceOf> sources; ///< in the order of words
  std::vector<FieldRead> fields; ///< each once, where it is read first
  std::string folder;            ///< of the main file, with a / at its end: where paths of assets begin
  GraphText graph;               ///< where CompileOptions::graph asks for it
  bool asksOwnTags = false;      ///< for what extrusions and splits say of their faces
  bool asksAround = false;       ///< by context queries that look beyond their axiom
  bool asksUnlabelled = false;   ///< by some of them for shapes that label() did not name

  const SourceOf* sourceOf(uint32_t at) const;
};

/// Empty where the words are a program that the machine can run: instructions whole, jumps to instructions, tables and
/// strings within. Else what is wrong.
std::string validate(const Program& program);

/// One instruction a line, for tests and for people.
std::string disassemble(const Program& program);

} // namespace gpgp::spawn::cga
