// gpgpCreateGrammarBuilder and what adds to a builder: calls are stored as they come; treeOf makes the tree that the
// parser would make of the same grammar as text, so that all checks and the graph are those of text.
#include "spawn/language/builder.h"

#include "spawn/graph/export_labels.h"
#include "spawn/language/lexer.h"
#include "spawn/language/spellings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <new>
#include <utility>

using namespace gpgp::spawn;

namespace {
constexpr uint32_t kMaxExpressionValues = 1024;
constexpr GpgpGrammarValueId kFirstOwn = 0x10000; // ids of variables and expressions

std::string quoted(const std::string& name) { return "'" + name + "'"; }

const Spelling* spellingOf(GpgpOperatorKind kind) {
  const auto at = std::find_if(kSpellings.begin(), kSpellings.end(), [&](const Spelling& s) { return s.kind == kind; });
  return at == kSpellings.end() ? nullptr : &*at;
}

/// Whether text would say the number, as 5 or 2e5.
bool isNumber(std::string_view name) {
  Diagnostics ignored;
  return tokenize(name, ignored).front().kind == TokenKind::number;
}
} // namespace

struct GpgpGrammarBuilder_T {
  struct Variable {
    uint32_t statement = 0;
    std::string name;
    GpgpGrammarValue value{};
  };
  /// A variable or tag by name, or two values, or a field by its name at two of them.
  struct Value {
    std::string name, field;
    GpgpExpressionKind kind = 0;
    GpgpGrammarValue left{}, right{};
    uint32_t size = 1; // values in it
  };
  struct Successor {
    GpgpGrammarValue value{};
    std::string name;
    GpgpGrammarOperator op = 0;
    std::string problem; // reported where it is used
  };
  struct Operator {
    GpgpOperatorKind kind = 0;
    std::string problem;
    std::vector<GpgpGrammarValue> values;
    std::vector<Successor> successors;
  };
  struct Terminal {
    uint32_t statement = 0;
    std::vector<std::string> names;
    uint32_t kind = 0, index = 0;
  };
  struct Rule {
    uint32_t statement = 0;
    std::string name;
    Successor successor;
  };
  struct Priority {
    uint32_t statement = 0;
    std::string rule;
    uint32_t priority = 0;
  };
  struct Axiom {
    uint32_t statement = 0;
    GpgpShape shape = 0;
    std::vector<GpgpGrammarValue> corners;
    std::string rule;
  };

  std::vector<Variable> variables;
  std::vector<Value> values;
  std::vector<Operator> operators;
  std::vector<Terminal> terminals;
  std::vector<Rule> rules;
  std::vector<Axiom> axioms;
  std::vector<Priority> priorities;
  std::vector<std::string> problems; ///< of calls that added nothing
  uint32_t statements = 0;
  bool outOfMemory = false;

  /// 0: there is no such value, so that expressions are made of earlier ones.
  uint32_t sizeOf(GpgpGrammarValue value) const {
    if (value.id < kFirstOwn) return 1;
    const size_t index = value.id - kFirstOwn;
    return index < values.size() ? values[index].size : 0;
  }
  GpgpGrammarValue own() const { return {static_cast<GpgpGrammarValueId>(kFirstOwn + values.size() - 1), 0}; }

  /// Whether the arguments of a call can be read; a problem where not.
  bool check(bool good, const char* function, const std::string& problem) {
    if (!good) problems.push_back(std::string(function) + ": " + problem);
    return good;
  }
  /// Adds a value of two others.
  GpgpGrammarValue join(const char* function, Value made) {
    for (const GpgpGrammarValue value : {made.left, made.right})
      if (!check(sizeOf(value) != 0, function, "there is no value " + std::to_string(value.id) + " in this builder"))
        return GpgpGrammarValue GPGP_GRAMMAR_NUMBER(0);
    made.size = 1 + sizeOf(made.left) + sizeOf(made.right);
    if (!check(made.size <= kMaxExpressionValues, function,
               "the expression has more than 1024 values; expected a shorter one"))
      return GpgpGrammarValue GPGP_GRAMMAR_NUMBER(0);
    values.push_back(std::move(made));
    return own();
  }
  static std::string problemOfName(const char* name) {
    if (!name) return "the name is NULL";
    const std::string_view text(name);
    if (!text.empty() && std::all_of(text.begin(), text.end(), isNameCharacter)) return {};
    return quoted(name) + " is not a name; expected letters, digits and _";
  }
  bool checkName(const char* name, const char* function) {
    const std::string problem = problemOfName(name);
    return check(problem.empty(), function, problem);
  }
  static Successor successorOf(GpgpGrammarValue value, const char* name, GpgpGrammarOperator op) {
    Successor made{value, name ? name : "", op, {}};
    if (name && op)
      made.problem = "expected a name or an operator, found both";
    else if (name)
      made.problem = problemOfName(name);
    else if (!op)
      made.problem = "expected a name or an operator, found neither";
    return made;
  }
};

namespace {
class TreeMaker {
public:
  TreeMaker(const GpgpGrammarBuilder_T& builder, Diagnostics& diagnostics)
      : builder_(builder), diagnostics_(diagnostics), used_(builder.operators.size()) {}

  SyntaxTree run() {
    SyntaxTree tree;
    if (builder_.outOfMemory) throw std::bad_alloc();
    for (const std::string& problem : builder_.problems) diagnostics_.error({}, problem);
    for (const auto& variable : builder_.variables) {
      begin(variable.statement);
      VariableDefinition& made = tree.variables.emplace_back();
      made.place = place("var " + quoted(variable.name));
      made.name = variable.name;
      made.value = value(variable.value, diagnostics_.where(made.place) + ", its value");
    }
    for (const auto& terminal : builder_.terminals) {
      begin(terminal.statement);
      TerminalDefinition& made = tree.terminals.emplace_back();
      made.place = place("terminal " + (terminal.names.empty() ? std::string("''") : quoted(terminal.names[0])));
      for (const std::string& name : terminal.names) made.names.emplace_back(place("terminal " + quoted(name)), name);
      const std::string where = diagnostics_.where(made.place);
      made.arguments.push_back(number(static_cast<float>(terminal.kind), place(where + ", its kind")));
      // floats hold indices up to the largest that is allowed; beyond it all are as wrong
      const uint32_t index = terminal.index > (1u << 24) ? 1u << 25 : terminal.index;
      made.arguments.push_back(number(static_cast<float>(index), place(where + ", its index")));
    }
    for (const auto& rule : builder_.rules) {
      begin(rule.statement);
      RuleDefinition& made = tree.rules.emplace_back();
      made.name = rule.name;
      const std::string where = "rule " + quoted(rule.name);
      made.place = place(where);
      made.body = successor(rule.successor, where);
      if (std::exchange(tooDeep_, false))
        diagnostics_.error(made.body.place, "this is nested more than " + std::to_string(kMaxNesting) + " deep");
    }
    for (const auto& priority : builder_.priorities) {
      begin(priority.statement);
      const Place at = place("priority of " + quoted(priority.rule));
      const auto rule = std::find_if(tree.rules.begin(), tree.rules.end(),
                                     [&](const RuleDefinition& r) { return r.name == priority.rule; });
      if (rule == tree.rules.end())
        diagnostics_.error(at, "there is no rule " + quoted(priority.rule));
      else if (priority.priority > gpgp::shader::kMaxPriority)
        diagnostics_.error(at, "a priority is at most " + std::to_string(gpgp::shader::kMaxPriority) + ", found " +
                                   std::to_string(priority.priority));
      else
        rule->priority = priority.priority;
    }
    for (const auto& axiom : builder_.axioms) addAxiom(axiom, tree);
    if (builder_.axioms.empty()) {
      tree.brokenAxiom = true;
      diagnostics_.error({}, "there is no axiom; expected gpgpAddAxiom");
    }
    for (size_t i = 0; i < used_.size() && !diagnostics_.hasErrors(); ++i) // else what is wrong may be what uses it
      if (!used_[i])
        diagnostics_.warning({}, "operator " + std::to_string(i + 1) + " (" + nameOf(builder_.operators[i]) +
                                     ") is used nowhere");
    return tree;
  }

private:
  static std::string nameOf(const GpgpGrammarBuilder_T::Operator& op) {
    const Spelling* spelling = spellingOf(op.kind);
    return spelling ? spelling->name : "an operator";
  }

  /// Places sort as the statements were added; before them is the grammar as a whole.
  void begin(uint32_t statement) {
    line_ = statement + 2;
    column_ = 0;
  }
  Place place(const std::string& name) {
    const Place made{line_, ++column_};
    diagnostics_.name(made, name);
    return made;
  }

  static Expression number(float value, Place place) {
    Expression result;
    result.place = place;
    result.number = value;
    return result;
  }
  static Expression named(ExpressionKind kind, const char* name, Place place) {
    Expression result;
    result.kind = kind;
    result.place = place;
    result.name = name;
    return result;
  }
  static Expression axis(uint32_t axis, Place place) { return named(ExpressionKind::name, axisText(axis), place); }

  Expression value(GpgpGrammarValue v, const std::string& where) { return value(v, place(where)); }
  /// All parts of an expression have the place of the whole.
  Expression value(GpgpGrammarValue v, Place at) {
    const uint32_t id = v.id;
    if (id == GPGP_VALUE_NUMBER) {
      if (std::isfinite(v.number)) return number(v.number, at);
      diagnostics_.error(at, "this number is not finite");
      return number(0, at);
    }
    if (id >= GPGP_VALUE_X && id <= GPGP_VALUE_Z) return axis(id - GPGP_VALUE_X, at);
    if (id >= GPGP_VALUE_ADJUST_TO_FILL && id <= GPGP_VALUE_ANCHOR_TO_END)
      return named(ExpressionKind::name, repeatModeText(id - GPGP_VALUE_ADJUST_TO_FILL), at);
    for (const Attribute& attribute : kAttributes) {
      const uint32_t number = id - attribute.value;
      if (id < attribute.value || number >= attribute.count()) continue;
      Expression result = named(ExpressionKind::call, attribute.name, at);
      if (attribute.axes == 2) result.arguments.push_back(axis(number / 3, at));
      if (attribute.axes) result.arguments.push_back(axis(number % 3, at));
      return result;
    }
    const size_t index = size_t(id) - kFirstOwn;
    if (id < kFirstOwn || index >= builder_.values.size()) {
      diagnostics_.error(at, id == GPGP_VALUE_NONE ? std::string("expected a value, found none")
                                                   : "there is no value " + std::to_string(id) + " in this builder");
      return number(0, at);
    }
    const auto& own = builder_.values[index];
    if (!own.name.empty()) return named(ExpressionKind::name, own.name.c_str(), at);
    Expression result;
    result.place = at;
    result.kind = ExpressionKind::pair;
    if (!own.field.empty()) {
      result.kind = ExpressionKind::call;
      result.name = GPGP_FIELD_SPELLING;
      result.arguments.push_back(named(ExpressionKind::name, own.field.c_str(), at));
    }
    for (const Binary& binary : kBinaries) {
      if (binary.kind != own.kind || !own.field.empty()) continue;
      result.kind = binary.precedence ? ExpressionKind::binary : ExpressionKind::call;
      if (binary.precedence)
        result.op = binary.code;
      else
        result.name = binary.spelling;
    }
    result.arguments.push_back(value(own.left, at));
    result.arguments.push_back(value(own.right, at));
    return result;
  }

  Successor successor(const GpgpGrammarBuilder_T::Successor& from, const std::string& where) {
    Successor result;
    const bool known = from.op > 0 && from.op <= builder_.operators.size();
    const auto* op = known ? &builder_.operators[from.op - 1] : nullptr;
    result.place = place(op ? where + ", " + nameOf(*op) : where);
    if (from.problem.empty() && !from.op) {
      result.name = from.name;
      return result;
    }
    result.call = std::make_shared<Call>();
    result.call->place = result.place;
    result.call->name = "Discard"; // also where there is an error: no others follow from it
    std::string problem = from.problem;
    if (problem.empty() && !op)
      problem = "there is no operator " + std::to_string(from.op) + " in this builder";
    else if (problem.empty() && used_[from.op - 1])
      problem = "this operator is already used elsewhere; to share it, make it a rule";
    else if (problem.empty())
      problem = op->problem;
    if (op) used_[from.op - 1] = true;
    if (!problem.empty()) {
      diagnostics_.error(result.place, problem);
    } else if (depth_ == kMaxNesting) {
      tooDeep_ = true; // which is said of the whole
    } else {
      ++depth_;
      call(*op, *result.call);
      --depth_;
    }
    return result;
  }

  void call(const GpgpGrammarBuilder_T::Operator& op, Call& made) {
    const std::string where = diagnostics_.where(made.place);
    made.name = nameOf(op);
    const bool corners = operatorWritten(made.name) == nullptr; // others have no values
    for (size_t i = 0; i < op.values.size(); ++i)
      made.arguments.push_back(
          value(op.values[i], where + (corners ? ", corner " : ", value ") + std::to_string(i + 1)));
    if (op.successors.empty()) return;
    const bool all = op.kind == GPGP_OPERATOR_COMP_SPLIT && op.successors.size() == 1; // faces alike, as without braces
    made.form = all ? SuccessorForm::chain : SuccessorForm::braces;
    for (size_t i = 0; i < op.successors.size(); ++i) {
      const auto& from = op.successors[i];
      Branch& branch = made.branches.emplace_back();
      std::string name = where;
      if (op.successors.size() > 1) name += ", successor " + std::to_string(i + 1);
      if (from.value.id != GPGP_VALUE_NONE) branch.label = value(from.value, name + ", its value");
      branch.successor = successor(from, name);
    }
  }

  void addAxiom(const GpgpGrammarBuilder_T::Axiom& axiom, SyntaxTree& tree) {
    begin(axiom.statement);
    AxiomDefinition made;
    bool broken = false;
    made.place = made.shapePlace = made.namePlace = place("axiom");
    made.name = axiom.rule;
    for (size_t i = 0; i < axiom.corners.size(); ++i) {
      made.corners.push_back(value(axiom.corners[i], "axiom, corner " + std::to_string(i + 1)));
      if (made.corners.back().kind == ExpressionKind::pair) continue;
      diagnostics_.error(made.corners.back().place, "expected a corner as (x, y)");
      broken = true;
    }
    if (axiom.shape >= gpgp::shader::kShapeCount) {
      diagnostics_.error(made.place, "there is no shape " + std::to_string(axiom.shape) + "; expected a GpgpShape");
      broken = true;
    }
    tree.brokenAxiom = tree.brokenAxiom || broken;
    if (broken) return;
    made.shape = shapeName(axiom.shape);
    tree.axioms.push_back(std::move(made));
  }

  const GpgpGrammarBuilder_T& builder_;
  Diagnostics& diagnostics_;
  std::vector<bool> used_;
  uint32_t line_ = 1, column_ = 0;
  int depth_ = 0; // of operators in each other
  bool tooDeep_ = false;
};

/// Runs what adds to a builder. Memory that is not there is found again when the builder is compiled.
template <class Result, class Work> Result guarded(GpgpGrammarBuilder builder, Result otherwise, const Work& work) {
  if (!builder) return otherwise;
  try {
    return work();
  } catch (...) {
    builder->outOfMemory = true;
    return otherwise;
  }
}
} // namespace

namespace gpgp::spawn {
SyntaxTree treeOf(const GpgpGrammarBuilder_T& builder, Diagnostics& diagnostics) {
  return TreeMaker(builder, diagnostics).run();
}
} // namespace gpgp::spawn

GpgpResult GPGP_CALL gpgpCreateGrammarBuilder(GpgpGrammarBuilder* builder) {
  if (!builder) return GPGP_ERROR_INVALID_ARGUMENT;
  GpgpGrammarBuilder made = new (std::nothrow) GpgpGrammarBuilder_T;
  if (!made) return GPGP_ERROR_OUT_OF_HOST_MEMORY;
  *builder = made;
  return GPGP_SUCCESS;
}

void GPGP_CALL gpgpDestroyGrammarBuilder(GpgpGrammarBuilder builder) { delete builder; }

GpgpGrammarValue GPGP_CALL gpgpAddVariable(GpgpGrammarBuilder builder, const char* name, GpgpGrammarValue value) {
  return guarded(builder, GpgpGrammarValue{}, [&]() -> GpgpGrammarValue {
    if (!builder->checkName(name, "gpgpAddVariable")) return GpgpGrammarValue GPGP_GRAMMAR_NUMBER(0);
    bool isFree = true;
    for (uint32_t i = 0; i < 3; ++i)
      isFree = isFree && axisText(i) != std::string(name) && repeatModeText(i) != std::string(name);
    if (!builder->check(isFree, "gpgpAddVariable", quoted(name) + " has a meaning of its own; expected another name"))
      return GpgpGrammarValue GPGP_GRAMMAR_NUMBER(0);
    builder->variables.push_back({builder->statements++, name, value});
    builder->values.emplace_back().name = name;
    return builder->own();
  });
}

GpgpGrammarValue GPGP_CALL gpgpAddTag(GpgpGrammarBuilder builder, const char* name) {
  return guarded(builder, GpgpGrammarValue{}, [&]() -> GpgpGrammarValue {
    if (!builder->checkName(name, "gpgpAddTag") ||
        !builder->check(!isNumber(name), "gpgpAddTag",
                        quoted(name) + " is a number; expected a name, or a number as the tag"))
      return GpgpGrammarValue GPGP_GRAMMAR_NUMBER(0);
    builder->values.emplace_back().name = name;
    return builder->own();
  });
}

GpgpGrammarValue GPGP_CALL gpgpAddField(GpgpGrammarBuilder builder, const char* name, GpgpGrammarValue x,
                                        GpgpGrammarValue z) {
  return guarded(builder, GpgpGrammarValue{}, [&]() -> GpgpGrammarValue {
    if (!builder->checkName(name, "gpgpAddField") ||
        !builder->check(!isNumber(name), "gpgpAddField", quoted(name) + " is a number; expected a name"))
      return GpgpGrammarValue GPGP_GRAMMAR_NUMBER(0);
    return builder->join("gpgpAddField", {.field = name, .left = x, .right = z});
  });
}

GpgpGrammarValue GPGP_CALL gpgpAddExpression(GpgpGrammarBuilder builder, GpgpExpressionKind kind, GpgpGrammarValue left,
                                             GpgpGrammarValue right) {
  return guarded(builder, GpgpGrammarValue{}, [&]() -> GpgpGrammarValue {
    if (!builder->check(kind <= GPGP_EXPRESSION_NOISE, "gpgpAddExpression",
                        "there is no kind of expression " + std::to_string(kind)))
      return GpgpGrammarValue GPGP_GRAMMAR_NUMBER(0);
    return builder->join("gpgpAddExpression", {.kind = kind, .left = left, .right = right});
  });
}

GpgpGrammarOperator GPGP_CALL gpgpAddOperator(GpgpGrammarBuilder builder, GpgpOperatorKind kind,
                                              const GpgpGrammarValue* values, uint32_t valueCount,
                                              const GpgpGrammarSuccessor* successors, uint32_t successorCount) {
  return guarded(builder, GpgpGrammarOperator{}, [&]() -> GpgpGrammarOperator {
    GpgpGrammarBuilder_T::Operator made;
    made.kind = kind;
    if (!spellingOf(kind))
      made.problem = "there is no kind of operator " + std::to_string(kind);
    else if (!values && valueCount)
      made.problem = "values is NULL, valueCount is " + std::to_string(valueCount);
    else if (!successors && successorCount)
      made.problem = "successors is NULL, successorCount is " + std::to_string(successorCount);
    if (values) made.values.assign(values, values + valueCount);
    if (!successors) successorCount = 0;
    for (uint32_t i = 0; i < successorCount; ++i) {
      const GpgpGrammarSuccessor& from = successors[i];
      made.successors.push_back(GpgpGrammarBuilder_T::successorOf(from.value, from.name, from.op));
    }
    builder->operators.push_back(std::move(made));
    return static_cast<GpgpGrammarOperator>(builder->operators.size());
  });
}

void GPGP_CALL gpgpAddTerminal(GpgpGrammarBuilder builder, const char* names, uint32_t kind, uint32_t index) {
  guarded(builder, 0, [&] {
    GpgpGrammarBuilder_T::Terminal made{builder->statements++, {}, kind, index};
    if (builder->check(names != nullptr, "gpgpAddTerminal", "names is NULL")) {
      for (std::string_view rest(names); !rest.empty();) {
        const size_t end = std::min(rest.find(' '), rest.size());
        const std::string name(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (!name.empty() && builder->checkName(name.c_str(), "gpgpAddTerminal")) made.names.push_back(name);
      }
      builder->check(!made.names.empty(), "gpgpAddTerminal", "names has no name");
    }
    builder->terminals.push_back(std::move(made));
    return 0;
  });
}

void GPGP_CALL gpgpAddRule(GpgpGrammarBuilder builder, const char* name, const char* successor,
                           GpgpGrammarOperator op) {
  guarded(builder, 0, [&] {
    if (!builder->checkName(name, "gpgpAddRule")) return 0;
    GpgpGrammarBuilder_T::Rule made{builder->statements++, name, GpgpGrammarBuilder_T::successorOf({}, successor, op)};
    builder->rules.push_back(std::move(made));
    return 0;
  });
}

void GPGP_CALL gpgpSetRulePriority(GpgpGrammarBuilder builder, const char* rule, uint32_t priority) {
  guarded(builder, 0, [&] {
    if (builder->checkName(rule, "gpgpSetRulePriority"))
      builder->priorities.push_back({builder->statements++, rule, priority});
    return 0;
  });
}

void GPGP_CALL gpgpAddAxiom(GpgpGrammarBuilder builder, GpgpShape shape, const GpgpGrammarValue* corners,
                            uint32_t cornerCount, const char* rule) {
  guarded(builder, 0, [&] {
    if (!builder->checkName(rule, "gpgpAddAxiom")) return 0;
    if (!builder->check(corners || !cornerCount, "gpgpAddAxiom", "corners is NULL, cornerCount is not 0"))
      cornerCount = 0;
    GpgpGrammarBuilder_T::Axiom made{builder->statements++, shape, {}, rule};
    if (cornerCount) made.corners.assign(corners, corners + cornerCount);
    builder->axioms.push_back(std::move(made));
    return 0;
  });
}
