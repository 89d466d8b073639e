// Runs a program of the stack language once, when it is loaded, with abstract shapes on its stack.
//
// Work and memory are bounded: each token, each turn of a loop and each item of an array costs a step of a budget.
#pragma once
#include "spawn/gml/flatten.h"
#include "spawn/gml/scanner.h"
#include "spawn/graph/export_labels.h"

#include <gpgp/spawn.h>

#include <functional>
#include <set>
#include <span>
#include <string_view>
#include <unordered_map>

namespace gpgp::spawn::gml {

class Machine;
using Arguments = std::vector<Value>;

/// An operator of the language. Where several have one name, the first one that takes what is on the stack runs.
struct Builtin {
  const char* name;
  /// What it takes, a letter each, the top of the stack last: n number, k known number, i whole number that is known,
  /// v vector, t name, r name or whole number from 0, a array, p procedure, d dictionary, S shape, * anything.
  const char* takes;
  uint32_t leaves; ///< values, broken ones after an error
  void (*run)(Machine&, Arguments&);
  uint32_t code = 0; ///< of the graph: an operator or an attribute
};
std::span<const Builtin> stackOperators();
std::span<const Builtin> numberOperators();
std::span<const Builtin> arrayOperators();
std::span<const Builtin> controlOperators();
std::span<const Builtin> shapeOperators();
/// Calls for the name of each operator, and for those of axes and modes.
void forWords(const std::function<void(std::string_view)>& call);

class Machine {
public:
  Machine(const Program& program, std::span<const GpgpVariable> overrides, Diagnostics& diagnostics,
          std::pmr::memory_resource* memory);
  PlacedGraph run();

  // ---------------------------------------------------------------- for operators

  static constexpr size_t kMaxStack = 16384, kMaxCalls = 200, kMaxItems = 65536, kMaxArrayDepth = 32, kMaxNodes = 65536,
                          kMaxRuleInstances = 4096, kMaxFormula = 256;
  static constexpr uint64_t kMaxSteps = 2'000'000;

  Place place() const { return place_; }
  const char* operatorName() const { return operator_; }
  uint32_t code() const { return code_; } ///< Builtin::code
  Flattener& graph() { return graph_; }
  Diagnostics& diagnostics() { return diagnostics_; }
  NameTable& names() { return names_; }
  const std::string& nameText(uint32_t name) const { return names_.text(name); }
  /// The rest of the program is given up once this is true.
  bool hasStopped() const { return stopped_; }

  void push(Value value);
  void pushNumber(float value) { push(Number{value, nullptr}); }
  void pushArray(std::vector<Value> items);
  Value pop();
  std::vector<Value>& stack() { return stack_; }
  /// Spends steps; false, and everything stops, where none are left.
  bool spend(uint64_t steps);
  /// At the operator that runs. false, for `return fail(...)`.
  bool fail(const std::string& text);
  bool failAt(Place place, const std::string& text);
  /// After errors that leave it open what is on the stack: no more errors of missing values.
  void loseTrack() { lost_ = true; }
  bool hasLostTrack() const { return lost_; }

  /// Shapes in it are copied, in the stored value as well.
  Value copyOf(Value& stored);
  /// Ends all shapes in a value.
  void drop(const Value& value);
  /// Whether a shape may be taken here.
  bool mayTake(const Shape& shape);
  uint32_t branch() const { return branch_; }
  /// A parameter for a node that takes the shape; reports a number that belongs to another shape.
  Parameter parameter(const Number& number, const Shape& shape);

  void execute(const Value& value, Place place);
  void runProcedure(uint32_t procedure);
  void call(uint32_t rule, Place place);
  /// Runs each procedure on a shape that comes from one of the edges of a node; what they leave is joined. Broken: no
  /// procedure.
  void branchOn(size_t shapeAt, uint32_t node, std::span<const Value> procedures, const Number* condition);
  size_t topShape() const; ///< its place in the stack, or its size
  /// Whether a loop goes on after a turn.
  bool goesOn();
  void beginLoop();
  void endLoop();
  void exitLoop();

  Value* find(uint32_t name); ///< what a name stands for, or NULL
  void define(uint32_t name, Value value);
  void defineVariable(uint32_t name, float value);
  void defineRule(uint32_t name, uint32_t parameters, uint32_t procedure);
  void defineTerminals(std::span<const uint32_t> names, uint32_t kind, uint32_t index);
  /// Pushes the shape of an axiom, or starts a rule that a name stands for.
  void startShape(uint32_t shape, uint32_t polygon, std::optional<uint32_t> rule);
  uint32_t newDictionary();
  /// Its definitions; NULL, and an error, where a branch on a shape may not change them.
  std::unordered_map<uint32_t, Value>* changed(uint32_t dictionary);
  std::unordered_map<uint32_t, Value>& dictionary(uint32_t number) { return dictionaries_[number].values; }
  void beginDictionary(uint32_t number);
  void endDictionary();
  /// The polygon of corners, found again where it was made before.
  std::optional<uint32_t> polygonOf(const std::vector<std::array<float, 2>>& corners, bool convex);
  std::optional<uint32_t> cornersOf(const Value& corners, bool convex);
  void emitDefault(const Shape& shape);
  uint32_t newDraw() { return draws_++; }

private:
  struct DictionaryState {
    std::unordered_map<uint32_t, Value> values;
    uint32_t branch = 0; ///< in which it was made
  };
  struct Scope {
    uint32_t dictionary = 0;
    uint32_t branch = 0;
    bool isOpened = false; ///< by 'begin'
  };
  struct Frame {
    std::unordered_map<uint32_t, Value> registers;
    uint32_t branch = 0;
    bool isCall = false; ///< registers of frames before it are not seen
  };
  struct RuleDefinition {
    uint32_t name = 0, parameters = 0, procedure = 0;
    Place place;
    uint32_t instances = 0;
  };
  struct Instance {
    uint32_t rule = 0; ///< of the definitions
    std::vector<Value> arguments;
    uint32_t number = 0; ///< of the graph's rules
    Place place;         ///< of the first call
  };
  void checkNames();
  void runToken(const Token& token);
  void runName(uint32_t name, Place place);
  void runBuiltin(std::span<const Builtin* const> overloads);
  bool takeArguments(const Builtin& builtin, Arguments& arguments);
  void store(uint32_t name);
  void load(uint32_t name);
  Value* findRegister(uint32_t name);
  bool isKnown(const Value& value, uint32_t name);
  void forget();
  bool isReserved(uint32_t name, const char* what);
  void runBody(uint32_t procedure, std::vector<Value> stack, std::vector<Scope> scopes);
  void finishRun();
  struct Joining {
    const Number* condition;
    uint32_t branchA, branchB, branch; ///< of shapes of either side, and of what comes of them
  };
  Value join(const Value& a, const Value& b, const Joining& how);
  std::optional<uint32_t> instanceOf(uint32_t rule, std::vector<Value> arguments);
  std::string uniqueName(const std::string& wanted);
  void report(Place place, const std::string& text);

  const Program& program_;
  std::span<const GpgpVariable> overrides_;
  Diagnostics& diagnostics_;
  NameTable names_;
  Flattener graph_;
  std::unordered_map<uint32_t, std::vector<const Builtin*>> builtins_; // by name
  std::set<uint32_t> words_; // names that stand for themselves: axes and modes
  std::vector<Value> stack_;
  std::vector<DictionaryState> dictionaries_; // the first is the program's own
  std::vector<Scope> scopes_;
  std::vector<Frame> frames_;
  std::vector<RuleDefinition> rules_;
  std::vector<Instance> instances_;
  std::map<std::string, uint32_t> instanceKeys_;
  std::set<std::string> graphNames_;
  std::map<std::pair<bool, std::vector<std::array<float, 2>>>, uint32_t> polygons_;
  std::set<std::pair<uint32_t, uint32_t>> reported_; // places: an error is reported once there
  std::set<uint32_t> drawn_;                         // random numbers that operators have taken
  std::map<uint32_t, bool> variables_;               // names of var, and whether set from outside
  std::optional<uint32_t> generate_;
  Place place_, calledFrom_;
  const char* operator_ = "";
  uint32_t code_ = 0;
  uint64_t steps_ = 0;
  uint32_t branch_ = 0, branches_ = 0, draws_ = 0, calls_ = 0;
  std::vector<uint32_t> loopBranches_;
  bool stopped_ = false, lost_ = false, leaves_ = false, isMain_ = true;
};

/// Text to a graph; usable where there were no errors.
PlacedGraph compile(std::string_view text, std::span<const GpgpVariable> overrides, Diagnostics& diagnostics,
                    std::pmr::memory_resource* memory);

/// a op b, of numbers that are known or not; op is a code of graph_format.h.
std::optional<Number> combined(Machine& machine, uint32_t op, const Number& a, const Number& b);

} // namespace gpgp::spawn::gml
