// From a checked .cga program to an operator graph, as PGA-shape text: where everything that the start rule can reach
// has an equal operator there. What a graph derives is what the program derives: the same shapes with the same path
// keys, so that the same random numbers are drawn.
//
// A rule is derived symbolically, once for each set of values and attributes that it is called with; a rule that comes
// back with the same ones is a cycle of the graph. The first thing that does not fit ends all and is named.
#pragma once
#include "spawn/cga/compiler.h"
#include "spawn/cga/graph_values.h"

#include <glm/vec4.hpp>

#include <functional>
#include <map>
#include <optional>

namespace gpgp::spawn::cga {

class Lowering {
public:
  Lowering(const std::vector<AttributeValue>& attributes, const Program& program)
      : given_(attributes), program_(program) {}
  GraphText run(Entity& start);

private:
  /// Ends the lowering.
  struct Misfit {
    std::string what, file;
    Place place;
  };
  enum class Form : uint8_t { flat, upright, box, asset, roof, trapezoid };
  enum class Extent : uint8_t { unknown, zero, positive };

  /// A value beside its name. stale: it read sizes that the shape no longer has, or numbers that it drew elsewhere.
  struct Bound {
    Value value;
    std::string stale; ///< why it cannot be used; empty: it can
  };
  /// A roof on a rectangle.
  struct Roof {
    uint32_t form = 0;                     ///< kRoof...
    FormulaPtr overhang, overhangAtGables; ///< its faces have, not the shape
    bool overhangs = false;
    float flattest = 0, steepest = 90; ///< degrees, of what slopes
    Place place;
  };
  /// What is known of the shape that a rule runs on. Frames are as the graph's: a flat rectangle is a box without
  /// height, an upright one a quad.
  struct State {
    Form form = Form::flat;
    std::array<Extent, 3> extents{Extent::positive, Extent::zero, Extent::positive};
    /// Columns of the frame in object space: axis + 1, negative: the other way; 0: not known.
    std::array<int8_t, 3> axes{1, 2, 3};
    glm::vec4 color{1};
    std::string texture, asset;
    std::map<uint32_t, Bound> attributes; ///< that were set, by slot
    std::map<std::string, Bound> locals;  ///< of the rule, its parameters too
    bool made = false;
    bool isMesh = false;      ///< to the CPU, which counts its faces otherwise than those of boxes
    bool isTilted = false;    ///< a mesh that was extruded from an upright rectangle
    std::optional<Roof> roof; ///< of Form::roof
    std::array<FormulaPtr, 3> moved{number(0), number(0), number(0)}; ///< from the centre where the rule began
  };
  struct Scope { ///< of names
    Module* module = nullptr;
    std::string name;                    ///< of the rule
    bool isFunction = false;             ///< or an attribute
    std::map<std::string, Bound> locals; ///< of functions; rules have State::locals
    const std::string& file() const { return module->file->path; }
  };
  /// Statements that are still to come: of a body, then of what it stands in.
  struct Rest {
    const Body* body;
    size_t next;
    bool isTail;
    const Rest* outer;      ///< of a branch: the body that it stands in
    bool isBracket = false; ///< ends at the ] that is not closed within
  };
  struct Text {
    std::string text;
    uint32_t depth = 0;
    bool isNothing() const { return text == "Discard()"; }
  };
  struct Part { ///< of a split
    const cga::Part* part;
    Value size;
  };

  [[noreturn]] void misfit(const std::string& what, Place place) const;

  // lower.cpp
  Text nothing() const { return {"Discard()", 1}; }
  Text ruleOf(Entity& entity, const std::vector<Bound>& arguments, const State& state, Place place);
  void define(const std::string& name, Text body);
  Text limited(Text text);
  Text wrapped(const std::string& before, Text inner);
  Text joined(const std::string& before, std::vector<Text> ways);
  Text terminal(const std::string& name, const State& state);
  Text report(const std::string& name, const FormulaPtr& value);
  uint32_t terminalNumber(GraphTerminal terminal);
  std::string terminalName(uint32_t number) const;
  Text bodyOf(const Body& body, Scope& scope, State state);
  Text sequence(Rest rest, Scope scope, State state);
  Text statement(const Statement& s, Rest rest, const Scope& scope, State state);
  Text item(const Statement& s, const Scope& scope, State state);
  Text branches(const Statement& s, const Rest& rest, const Scope& scope, const State& state);
  Text chooses(const std::vector<float>& chances, std::vector<Text> ways, Place place);
  Text condition(const FormulaPtr& condition, Text yes, Text no);
  std::string keyOf(const State& state) const;
  std::string keyOf(const Bound& bound) const;

  // lower_operations.cpp
  using Continue = std::function<Text(State)>;
  Text operation(const Statement& s, Operation operation, const Scope& scope, State state, const Continue& goOn,
                 const Statement* next, bool& tookNext);
  Text setAttribute(const Statement& s, const Scope& scope, State state, const Continue& goOn);
  Text split(const Statement& s, const Scope& scope, const State& state);
  Text divide(const std::vector<Part>& parts, uint32_t axis, const Scope& scope, const State& state,
              const std::vector<Part>* group);
  Text repeat(const std::vector<Part>& parts, uint32_t axis, const Scope& scope, const State& state);
  Text components(const Statement& s, const Scope& scope, const State& state);
  void changeSize(State& state, uint32_t axis, const char* why) const;
  State faceOf(const State& state, uint32_t face) const;
  bool selects(const cga::Part& part, const Scope& scope, const State& state, uint32_t face, uint32_t index,
               uint32_t count);
  Text colored(const Value& value, const State& state, const Continue& goOn, Place place);

  // lower_roofs.cpp
  Text roof(const Statement& s, Operation operation, const Scope& scope, State state, const Continue& goOn);
  Text roofFaces(const Statement& s, const Scope& scope, const State& state);
  State roofFaceOf(const State& state, uint32_t side) const;
  bool selectsOfRoof(const cga::Part& part, const Scope& scope, const State& state, uint32_t side, uint32_t index);

  Text setback(const Statement& s, const Scope& scope, const State& state);

  // lower_expressions.cpp
  Value value(const Expression& e, const Scope& scope, const State& state);
  Value named(const Expression& e, const Scope& scope, const State& state);
  Value call(Entity& entity, const Expression& e, const Scope& scope, const State& state);
  Value math(const Expression& e, const Scope& scope, const State& state);
  Value field(const Expression& e, const Scope& scope, const State& state);
  Value choices(const Expression& e, const Scope& scope, const State& state);
  Value binaryOf(const std::string& op, const Value& a, const Value& b, Place place);
  Value select(const FormulaPtr& condition, const Value& yes, const Value& no, Place place);
  FormulaPtr draw(Place place);
  FormulaPtr numberOf(const Value& value, Place place) const;
  FormulaPtr fits(FormulaPtr formula, Place place) const;
  /// A value of an operator: of a number of them that place in order.
  Value argument(const Expression& e, const Scope& scope, const State& state);
  FormulaPtr argumentNumber(const Expression& e, const Scope& scope, const State& state);
  /// 'x as a part of whole.
  FormulaPtr length(const Value& value, const FormulaPtr& whole, Place place) const;
  std::string word(const Expression& e) const;
  const Value& use(const Bound& bound, const std::string& name, Place place) const;
  Bound kept(const Value& value) const;
  Value attribute(Entity& entity, Place place);

  const std::vector<AttributeValue>& given_;
  const Program& program_;
  GraphText result_;
  std::map<std::string, uint32_t> terminals_;  // by what they are
  std::map<std::string, std::string> rules_;   // by entity, values and state
  std::map<std::string, std::string> aliases_; // what rules are
  std::vector<std::function<void()>> pending_;
  std::map<uint32_t, Bound> attributes_; // by slot
  std::vector<uint32_t> open_;           // slots that are worked out
  std::string text_;
  uint32_t names_ = 0, draws_ = 0, calls_ = 0, nested_ = 0;
  bool isOpenBracket_ = false;          // a [ ] ended of which nothing came
  uint32_t attributeSlot_ = UINT32_MAX; // whose value is worked out
  const Scope* at_ = nullptr;           // whose file messages name
};

} // namespace gpgp::spawn::cga
