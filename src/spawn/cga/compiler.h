// The compiler's parts share this: code that grows, names, and what waits to be compiled.
#pragma once
#include "spawn/cga/compile.h"
#include "spawn/cga/functions.h"
#include "spawn/cga/names.h"

#include <set>
#include <span>
#include <string_view>
#include <unordered_map>

namespace gpgp::spawn::cga {

/// What is known of a value before it runs.
enum class Type : uint8_t { unknown, number, boolean, string, array };

// What random numbers depend on is the path to a shape. These say where it forks, for the compiler and for what makes
// operator graphs (lower.h): what makes shapes and is followed by anything is one way, what follows the other.

/// Whether shapes come of a statement, or a report does, which is a way as well.
enum class Makes : uint8_t { nothing, report, shapes };
Makes whatMakes(const Statement& s);
/// The most of all of them; of branches: of those in them.
Makes whatMake(std::span<const Statement> statements);
/// The ] that a [ ends with, or the body's size.
size_t bracketEnd(const Body& body, size_t push);
/// Whether anything comes at or behind a place, within brackets before their end. isTail: nothing follows the body.
bool isFollowed(const Body& body, size_t next, bool isTail);
/// Whether what makes this much is a way of its own, beside what is at or behind the next place.
bool forks(Makes makes, const Body& body, size_t next, bool isTail);

/// The place of an operation's argument among the values of the operator that a graph has for it.
size_t placeOf(std::string_view operation, size_t argument, std::span<const ExpressionPtr> all);
/// The module that a path with prefixes leads to, and the name behind them. isMissing: by way of an import that could
/// not be read.
Module* resolvePath(const std::string& path, Module* module, std::string& last, bool& isMissing);

/// Where code is: which names are visible, and whose messages it gives.
struct Context {
  Module* scope = nullptr;
  std::vector<std::string> locals; ///< parameters first
  std::string name;                ///< of the rule, for shapes that end in it
  Entity* entity = nullptr;        ///< that is compiled
  const std::string& file() const { return scope->file->path; }
};

class Compiler {
public:
  Compiler(const CompileOptions& options, Messages& messages) : options_(options), messages_(messages) {}
  std::optional<Program> run(const std::string& text);

private:
  struct PendingPart {
    const std::vector<Part>* parts;
    bool repeats;
    std::vector<uint32_t> selectors; // of its parts, in the order of a walk
    Context context;
    uint32_t label;
    const Expression* perEdge = nullptr; // a value that is worked out for each edge: a chunk behind the parts'
  };

  /// What a record of a table leads to: a body, or a value.
  struct PartChunk {
    const Body* body;
    const Expression* value;
    uint32_t label;
  };

  // compile.cpp
  void assignSlots();
  void definitions();
  void definition(Entity& entity);
  std::vector<uint32_t> order(const std::vector<Entity*>& roots, bool tells);
  void attributes();
  Entity* startRule(Module& main);
  uint32_t string(const std::string& text);
  uint32_t newLabel();
  void place(uint32_t label) { labels_[label] = static_cast<uint32_t>(program_.words.size()); }
  void emit(uint32_t word) { program_.words.push_back(word); }
  void emit(uint32_t code, std::initializer_list<uint32_t> operands);
  void emitLabel(uint32_t label); // an offset that is filled in at the end
  void source(const Context& context, Place place);
  void chunk(uint32_t label, const std::string& name, size_t parameters, size_t locals);
  void refer(const Context& context, Entity& to);

  // compile_expressions.cpp
  Type expression(const Expression& e, const Context& context, bool selectorFirst = false);
  Type name(const Expression& e, const Context& context, bool selectorFirst);
  void arguments(std::string_view name, const std::vector<ExpressionPtr>& arguments, const Context& context,
                 bool isOperation = false);
  Type binary(const Expression& e, const Context& context);
  Type choices(const Expression& e, const Context& context);
  bool literal(const Entity& entity, Type& type);
  Module* resolve(const std::string& path, const Context& context, std::string& last, bool& isMissing);
  void field(const Expression& e, const Context& context);
  void contextQuery(const Expression& e, Function function);
  void unknownName(const Expression& e, const Context& context);
  void nothing() { emit(shader::kCgaPushFloatCode, {0}); }

  // compile_statements.cpp
  void body(const Body& body, const Context& context, bool isLast, bool isTail, uint32_t end);
  void statement(const Statement& s, const Context& context, bool isLast);
  void branches(const Statement& s, const Context& context, bool isLast, bool isTail, uint32_t end);
  void path(Operation operation) { emit(shader::kCgaOperationCode, {static_cast<uint32_t>(operation), 0}); }
  void drawsOf(const Expression& e, size_t place);
  void block(const Statement& s, Operation operation, const Context& context);
  void set(const Statement& s, const Context& context);
  bool invoke(const Statement& s, const Context& context, bool isLast);
  void unknownStatement(const Statement& s, const Context& context);
  void checkCount(const std::string& file, Place place, std::string_view name, size_t count, size_t least, size_t most);
  void parts(const PendingPart& pending);
  /// perEdge: a value that has a record behind those of the parts.
  void table(const std::vector<Part>& parts, const PendingPart& pending, size_t& selector, uint32_t label,
             const Expression* perEdge, std::vector<PartChunk>& chunks);
  void selectors(const std::vector<Part>& parts, const Context& context, bool selectorFirst, uint32_t& count,
                 std::vector<uint32_t>& numbers);

  const CompileOptions& options_;
  Messages& messages_;
  Program program_;
  std::unordered_map<std::string, uint32_t> strings_;
  std::unordered_map<std::string, uint32_t> files_;
  std::map<std::string, uint32_t> materials_; // material.name: its slot
  std::vector<uint32_t> labels_;
  std::vector<std::pair<uint32_t, uint32_t>> fixups_; // word, label
  std::vector<PendingPart> pending_;
  std::unordered_map<Entity*, std::vector<Entity*>> references_;
  std::vector<size_t> lastInvokes_;               // words
  bool asksContext_ = false;                      // for labelled shapes
  uint32_t choices_ = 0;                          // whose values are compiled
  std::set<std::pair<Entity*, Entity*>> certain_; // references that are needed whatever is chosen
  bool mayNeedItself_ = false;
  std::vector<Entity*> slots_; // by slot; none: of a material
  std::unique_ptr<Modules> modules_;
};

} // namespace gpgp::spawn::cga
