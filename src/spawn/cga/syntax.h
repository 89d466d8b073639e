// What a .cga file says, as a tree. Names are not resolved here.
#pragma once
#include "spawn/language/diagnostics.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gpgp::spawn::cga {

struct Expression;
using ExpressionPtr = std::unique_ptr<Expression>;

/// A condition with its value, or a percentage with its value; no condition: else.
struct Choice {
  ExpressionPtr condition, value;
};

struct Part;

struct Expression {
  enum class Kind : uint8_t {
    number,
    string,
    boolean,
    name,       ///< text, and arguments where isCall
    unary,      ///< text is - or !
    binary,     ///< text is the operator
    relative,   ///< 'x
    floating,   ///< ~x
    index,      ///< arguments: the array, then one for each dimension: an index, or a range
    range,      ///< first:last, either may be missing; or first:step:last
    array,      ///< [a, b, c]
    rows,       ///< [a, b; c, d]: arguments are arrays
    components, ///< comp(f) { selector: value }
    cases,
    stochastic
  };
  Kind kind = Kind::number;
  Place place;
  std::string text;
  double number = 0; ///< and 1 for true
  bool isCall = false;
  std::vector<ExpressionPtr> arguments;
  std::vector<Choice> choices;
  std::vector<Part> parts; ///< of components
  uint32_t depth = 1;      ///< of the tree, bounded by the parser

  Expression();
  ~Expression();
};

struct Statement;
using Body = std::vector<Statement>;

/// One of the parts of { a | b | c }.
struct Part {
  Place place;
  ExpressionPtr selector;   ///< none: a group, or a block that has no selectors
  bool isOneShape = false;  ///< selector = operations: all that it selects is one shape
  bool isConnected = false; ///< selector =: operations: what of that hangs together is one
  ExpressionPtr value;      ///< of components, in place of a body
  ExpressionPtr depth;      ///< of splitAndSetbackPerimeter, worked out for each part of the perimeter
  Body body;
  std::vector<Part> group; ///< a nested { ... }
  bool isGroup = false, repeats = false;
};

struct Branch {
  ExpressionPtr condition; ///< none: else
  Body body;
};

struct Statement {
  enum class Kind : uint8_t {
    call, ///< an operation, a rule, or a shape that ends here
    leaf, ///< Name.
    push,
    pop,
    cases,
    stochastic
  };
  Kind kind = Kind::call;
  Place place;
  std::string name;
  bool isCall = false; ///< with parentheses
  std::vector<ExpressionPtr> arguments;
  bool hasBlock = false, repeats = false; ///< { ... }, { ... }*
  std::vector<Part> parts;
  std::vector<Branch> branches;
};

inline Expression::Expression() = default;
inline Expression::~Expression() = default;

struct AnnotationArgument {
  std::string name; ///< empty where it has none
  ExpressionPtr value;
};
struct Annotation {
  std::string name;
  Place place;
  std::vector<AnnotationArgument> arguments;
};

struct Local {
  std::string name;
  Place place;
  ExpressionPtr value;
};

struct Definition {
  enum class Kind : uint8_t { attribute, constant, function, rule };
  Kind kind = Kind::rule;
  std::string name;
  Place place;
  std::vector<std::string> parameters;
  bool isStart = false; ///< by @StartRule or the keyword
  bool hasBody = false; ///< of rules: it began, whether or not it could be read
  std::vector<Annotation> annotations;
  std::shared_ptr<const Annotation> group; ///< the @Group that was said last before it
  std::vector<Local> locals;
  ExpressionPtr value; ///< of all but rules
  Body body;
  std::string style; ///< empty: of every style
};

struct Import {
  std::string prefix, path, style;
  Place place;
  std::vector<Definition> overrides;    ///< values of attributes, and rules
  std::vector<std::string> isProtected; ///< attributes that keep their own values
  bool protectsAll = false;             ///< by (): of all
  std::vector<std::string> hides;       ///< attributes that @Hidden(...) before it names
  bool hidesAll = false;                ///< by @Hidden
};

struct Style {
  std::string name, base;
  Place place;
};

struct File {
  std::string path, version;
  std::vector<Import> imports;
  std::vector<Style> styles;
  std::vector<Definition> definitions;
};

} // namespace gpgp::spawn::cga
