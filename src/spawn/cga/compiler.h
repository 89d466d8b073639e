// The compiler's parts share this: code that grows, names, and what waits to be compiled.
#pragma once
#include "spawn/cga/compile.h"
#include "spawn/cga/functions.h"
#include "spawn/cga/names.h"

#include <set>
#include <string_view>
#include <unordered_map>

namespace gpgp::spawn::cga {

/// What is known of a value before it runs.
enum class Type : uint8_t { unknown, number, boolean, string, array };

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
    const Statement* statement;
    std::vector<uint32_t> selectors; // of its parts, in the order of a walk
    Context context;
    uint32_t label;
    const Expression* perEdge = nullptr; // a value that is worked out for each edge: a chunk behind the parts'
  };

  // compile.cpp
  void assignSlots();
  void definitions();
  void definition(Entity& entity);
  void order(Entity& start);
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
  void arguments(std::string_view name, const std::vector<ExpressionPtr>& arguments, const Context& context);
  Type binary(const Expression& e, const Context& context);
  Type choices(const Expression& e, const Context& context);
  bool literal(const Entity& entity, Type& type);
  Module* resolve(const std::string& path, const Context& context, std::string& last, bool& isMissing);
  void unknownName(const Expression& e, const Context& context);
  void nothing() { emit(shader::kCgaPushFloatCode, {0}); }

  // compile_statements.cpp
  void body(const Body& body, const Context& context, bool isLast, uint32_t end);
  void statement(const Statement& s, const Context& context, bool isLast);
  void branches(const Statement& s, const Context& context, bool isLast, uint32_t end);
  void block(const Statement& s, Operation operation, const Context& context);
  void set(const Statement& s, const Context& context);
  bool invoke(const Statement& s, const Context& context, bool isLast);
  void unknownStatement(const Statement& s, const Context& context);
  void checkCount(const std::string& file, Place place, std::string_view name, size_t count, size_t least, size_t most);
  void parts(const PendingPart& pending);
  void table(const std::vector<Part>& parts, const PendingPart& pending, size_t& selector, uint32_t label,
             const uint32_t* perEdge, std::vector<std::pair<const Body*, uint32_t>>& bodies);
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
  std::vector<Entity*> slots_; // by slot; none: of a material
  std::unique_ptr<Modules> modules_;
};

} // namespace gpgp::spawn::cga
