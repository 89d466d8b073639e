// The tables of operators, codes and attributes (spawn/shared/operator_table.h): every row is known everywhere. The
// language and the builder make the same graph of it, the printed form gives it back, and validate() refuses one
// parameter, successor or argument that it does not have. The evaluator, the interpreter and the generator do with it
// what depends on its arguments.
#include "graphs.h"
#include "spawn/codegen/compile_kernel.h"
#include "spawn/codegen/generate.h"
#include "spawn/derive/interpret.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/language/print.h"
#include "spawn/language/spellings.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using spawn::Operator;

// ---------------------------------------------------------------- grammars with one operator

/// The first type of shape on which it has an effect, of those without corners of their own.
uint32_t shapeFor(const Operator& op) {
  for (const uint32_t shape : {shader::kShapeBox, shader::kShapeQuad})
    if (op.shapes >> shape & 1) return shape;
  return shader::kShapeRoof;
}
std::string valueFor(char letter, const std::string& value) {
  return letter == 'a' ? "Y" : letter == 'm' ? "ANCHOR_TO_START" : letter == 't' ? "tag" : value;
}
std::string argumentsOf(const Operator& op, const std::string& value) {
  if (op.op == shader::kOpSetGeometry) return "(-0.5,-0.5), (0.5,-0.5), (0,0.5)";
  std::string text;
  for (const char letter : op.inParentheses()) text += (text.empty() ? "" : ", ") + valueFor(letter, value);
  return text;
}
uint32_t successorsOf(const Operator& op) { return op.successors == spawn::kMany ? 2 : op.successors; }
std::string successors(const Operator& op, uint32_t count) {
  std::string text;
  for (uint32_t i = 0; i < count; ++i)
    text += std::string(i ? " | " : "") + (op.hasSuccessorValues() ? "0.5: " : "") + (i % 2 ? "U" : "T");
  return " { " + text + " }";
}
std::string callOf(const Operator& op, const std::string& arguments, uint32_t count) {
  const std::string name = op.op == shader::kOpSetGeometry ? "SetAsDynamicConvexRightPrism" : op.name;
  return name + "(" + arguments + ")" + successors(op, count);
}
std::string grammarWith(const Operator& op, const std::string& call) {
  return std::string("axiom ") + spawn::shapeName(shapeFor(op)) +
         " A; terminal T (1, 0); terminal U (1, 1); A = " + call + ";";
}
std::string grammarOf(const Operator& op, const std::string& value = "0.75") {
  return grammarWith(op, callOf(op, argumentsOf(op, value), successorsOf(op)));
}
/// Its value may be any: those that compilers refuse of roofs come as they are derived.
std::string grammarOfAny(const Operator& op, const std::string& value) {
  const bool isChecked = op.op == shader::kOpRaiseRoof || op.op == shader::kOpToRoofFace;
  return grammarOf(op, isChecked ? "Exp(" + value + " + 0 * ShapeSeed())" : value);
}
/// All that a grammar can have beside terminals.
std::vector<Operator> operators() {
  std::vector<Operator> result;
  for (const Operator& op : spawn::kOperators)
    if (op.op != shader::kOpTerminal) result.push_back(op);
  return result;
}
std::vector<std::string> errorsOf(const std::string& text) {
  std::vector<std::string> errors;
  for (const std::string& message : messagesOf(text))
    if (message.find("error: ") != std::string::npos) errors.push_back(message);
  return errors;
}
/// Compiles to the words of a baked grammar.
std::vector<uint32_t> wordsOf(GpgpGrammarBuilder builder) {
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  source.builder = builder;
  GpgpBlob blob{};
  EXPECT_EQ(gpgpCompileGrammar(&source, &blob), GPGP_SUCCESS);
  std::vector<uint32_t> words(blob.size / 4);
  if (blob.data) std::memcpy(words.data(), blob.data, blob.size);
  gpgpFreeBlob(&blob);
  return words;
}

// ---------------------------------------------------------------- the language

TEST(OperatorTable, TheLanguageHasEachWithItsArguments) {
  for (const Operator& op : operators()) {
    SCOPED_TRACE(grammarOf(op));
    ASSERT_EQ(errorsOf(grammarOf(op)), std::vector<std::string>());
    const spawn::Graph graph = compiled(grammarOf(op));
    const uint32_t index = nodeOf(graph, op.op);
    ASSERT_NE(index, spawn::kNoNode);
    const spawn::Node& node = graph.nodes[index];
    EXPECT_EQ(node.edgeCount, successorsOf(op));
    EXPECT_EQ(node.parameterCount, op.values() + (op.hasSuccessorValues() ? node.edgeCount : 0));
    for (uint32_t axis = 0; axis < op.axes(); ++axis) EXPECT_EQ(node.argument >> 2 * axis & 3, 1u);
    if (op.arguments.find('m') != std::string_view::npos) {
      EXPECT_EQ(node.argument2, shader::kRepeatAnchorToStart);
    }
    if (op.arguments.find('t') != std::string_view::npos) {
      EXPECT_STREQ(graph.nameAt(node.argument & ~shader::kTagName), "tag");
    }
    EXPECT_EQ(graph.edges[node.firstEdge].multiplicity, op.multiplicity);
  }
}

TEST(OperatorTable, TheLanguageRefusesOneArgumentOrSuccessorMoreOrLess) {
  for (const Operator& op : operators()) {
    SCOPED_TRACE(op.name);
    const uint32_t count = successorsOf(op);
    const std::string arguments = argumentsOf(op, "0.75");
    const size_t last = arguments.find_last_of(',');
    std::vector<std::string> wrong{callOf(op, arguments, 0), callOf(op, arguments, shader::kMaxSuccessors + 1)};
    if (op.successors != spawn::kMany) wrong.push_back(callOf(op, arguments, count + 1));
    if (op.op != shader::kOpSetGeometry) { // whose arguments are corners
      wrong.push_back(callOf(op, arguments + (arguments.empty() ? "1" : ", 1"), count));
      if (!arguments.empty())
        wrong.push_back(callOf(op, last == std::string::npos ? std::string() : arguments.substr(0, last), count));
    }
    for (const std::string& call : wrong) EXPECT_FALSE(errorsOf(grammarWith(op, call)).empty()) << call;
  }
}

TEST(OperatorTable, NamesAndKindsAreOnes) {
  for (const spawn::Spelling& a : spawn::kSpellings) {
    EXPECT_TRUE(spawn::isOperatorName(a.name));
    EXPECT_EQ(errorsOf(std::string("axiom Box A; terminal T (1, 0); A = T; ") + a.name + " = T;").size(), 1u) << a.name;
    for (const spawn::Spelling& b : spawn::kSpellings) {
      EXPECT_EQ(&a == &b, a.kind == b.kind);
      EXPECT_EQ(&a == &b, std::string_view(a.name) == b.name);
    }
    EXPECT_LT(a.kind, spawn::kSpellings.size()); // no number of GpgpOperatorKind is left out
  }
}

TEST(OperatorTable, BuildersMakeWhatTextMakes) {
  for (const Operator& op : operators()) {
    if (op.kind == spawn::kNotWritten) continue;
    SCOPED_TRACE(op.name);
    GpgpGrammarBuilder builder = nullptr;
    ASSERT_EQ(gpgpCreateGrammarBuilder(&builder), GPGP_SUCCESS);
    gpgpAddAxiom(builder, shapeFor(op), nullptr, 0, "A");
    gpgpAddTerminal(builder, "T", 1, 0);
    gpgpAddTerminal(builder, "U", 1, 1);
    std::vector<GpgpGrammarValue> values;
    for (const char letter : op.inParentheses())
      values.push_back(letter == 'a'   ? GpgpGrammarValue GPGP_GRAMMAR_VALUE(GPGP_VALUE_Y)
                       : letter == 'm' ? GpgpGrammarValue GPGP_GRAMMAR_VALUE(GPGP_VALUE_ANCHOR_TO_START)
                       : letter == 't' ? gpgpAddTag(builder, "tag")
                                       : GpgpGrammarValue GPGP_GRAMMAR_NUMBER(0.75));
    std::vector<GpgpGrammarSuccessor> to(successorsOf(op));
    for (size_t i = 0; i < to.size(); ++i) {
      if (op.hasSuccessorValues()) to[i].value = GPGP_GRAMMAR_NUMBER(0.5);
      to[i].name = i % 2 ? "U" : "T";
    }
    gpgpAddRule(builder, "A", nullptr,
                gpgpAddOperator(builder, op.kind, values.data(), static_cast<uint32_t>(values.size()), to.data(),
                                static_cast<uint32_t>(to.size())));
    EXPECT_EQ(wordsOf(builder), bake(grammarOf(op)));
    gpgpDestroyGrammarBuilder(builder);
  }
}

// ---------------------------------------------------------------- graphs

TEST(OperatorTable, ThePrintedFormGivesThemBack) {
  for (const Operator& op : operators()) {
    const std::string printed = spawn::printGraph(compiled(grammarOf(op)));
    EXPECT_NE(printed.find(std::string(" ") + op.name + "("), std::string::npos) << printed;
    spawn::Diagnostics diagnostics;
    const auto back = spawn::parseGraph(printed, diagnostics, std::pmr::new_delete_resource());
    ASSERT_TRUE(back) << printed << spawn::format(diagnostics.sorted()[0], "");
    EXPECT_EQ(spawn::printGraph(back->graph), printed);
  }
}

TEST(OperatorTable, ValidateRefusesOneMoreOrLess) {
  const auto message = [](const spawn::Graph& graph) {
    const auto ok = spawn::validate(graph);
    return ok ? std::string("valid") : std::string(ok.error().text);
  };
  for (const Operator& op : operators()) {
    const spawn::Graph good = compiled(grammarOf(op));
    const uint32_t index = nodeOf(good, op.op);
    ASSERT_EQ(message(good), "valid");
    const auto changed = [&](const auto& change) {
      spawn::Graph graph = good;
      // Room behind the last ones, so that only their numbers are wrong.
      graph.parameters.resize(graph.parameters.size() + 2);
      graph.edges.resize(graph.edges.size() + shader::kMaxSuccessors + 1);
      change(graph.nodes[index]);
      return message(graph);
    };
    const std::string begin = "node " + std::to_string(index) + " (" + op.name + "): ";
    const auto successors = [&](uint32_t count) { return changed([&](spawn::Node& n) { n.edgeCount = count; }); };
    const bool many = op.successors == spawn::kMany;
    EXPECT_EQ(successors(many ? 0 : op.successors - 1), begin + "wrong number of successors");
    EXPECT_EQ(successors(many ? shader::kMaxSuccessors + 1 : op.successors + 1), begin + "wrong number of successors");
    EXPECT_EQ(changed([](spawn::Node& n) { ++n.parameterCount; }), begin + "wrong number of parameters");
    if (good.nodes[index].parameterCount) {
      EXPECT_EQ(changed([](spawn::Node& n) { --n.parameterCount; }), begin + "wrong number of parameters");
    }
    for (uint32_t axis = 0; axis < op.axes(); ++axis)
      EXPECT_EQ(changed([&](spawn::Node& n) { n.argument |= 3u << 2 * axis; }), begin + "unknown axis");
    if (op.axes()) {
      EXPECT_EQ(changed([&](spawn::Node& n) { n.argument |= 1u << 2 * op.axes(); }), begin + "unknown axis");
    }
    for (const char letter : op.inParentheses()) {
      if (letter == 'm') {
        EXPECT_EQ(changed([](spawn::Node& n) { n.argument2 = 3; }), begin + "unknown mode");
      }
      if (letter == 't') {
        EXPECT_EQ(changed([](spawn::Node& n) { n.argument = shader::kTagName | 9999u; }),
                  begin + "a tag has a bad name");
      }
      if (letter == 's') {
        EXPECT_EQ(changed([](spawn::Node& n) { n.argument = shader::kShapeCount; }),
                  std::string(op.name) + " has unknown shape " + std::to_string(shader::kShapeCount));
      }
      if (letter == 'p') {
        EXPECT_NE(changed([](spawn::Node& n) { n.argument2 = 9999; }).find("names polygon 9999"), std::string::npos);
      }
    }
  }
}

// ---------------------------------------------------------------- what they do

spawn::Derivation derived(const std::vector<uint32_t>& words) {
  const GpgpAxiom axiom = spawn::makeAxiom(1, 2, 3);
  return spawn::derive(words, {&axiom, 1});
}
/// Without the key, which a way to the same shape changes.
std::string shapesOf(const spawn::Derivation& d) {
  std::string text = std::to_string(d.colliders);
  for (const GpgpInstance& i : d.instances) {
    text += " " + std::to_string(i.terminal) + "," + std::to_string(i.shape) + "," + std::to_string(i.attribute);
    for (const float f : i.transform) text += "," + std::to_string(f);
    for (const float f : i.size) text += "," + std::to_string(f);
  }
  return text;
}

TEST(OperatorTable, TheEvaluatorDoesWhatTheyAreFor) {
  for (const Operator& op : operators()) {
    const std::string untouched = shapesOf(derived(bake(grammarWith(op, "T"))));
    const auto first = derived(bake(grammarOf(op, "0"))), second = derived(bake(grammarOfAny(op, "100.5")));
    SCOPED_TRACE(grammarOf(op));
    switch (op.relation) {
    case spawn::Relation::Choosing: // another edge by another value
      ASSERT_EQ(first.terminals, 1u);
      ASSERT_EQ(second.terminals, 1u);
      EXPECT_NE(first.instances[0].terminal, second.instances[0].terminal);
      break;
    case spawn::Relation::Context: // a collider, or the second edge, as nothing is met
      EXPECT_EQ(second.colliders + second.instances.at(0).terminal, 1u);
      break;
    default: EXPECT_NE(shapesOf(derived(bake(grammarOf(op)))), untouched);
    }
  }
}

TEST(OperatorTable, TheInterpreterDoesWhatTheEvaluatorDoes) {
  for (const Operator& op : operators()) {
    if (op.relation != spawn::Relation::Passing && op.relation != spawn::Relation::Choosing) continue;
    for (const char* value : {"0", "0.75", "-0.75", "100.5"}) {
      SCOPED_TRACE(grammarOfAny(op, value));
      const std::vector<uint32_t> words = bake(grammarOfAny(op, value));
      shader::Shape shape = shader::axiomShape(words.data(), shader::vec3(1, 2, 3), 0, shader::kDefaultRule,
                                               std::numeric_limits<float>::quiet_NaN(), 0);
      ASSERT_EQ(shader::runChain(words.data(), shape, false, 64), shader::kEndTerminal);
      const spawn::Derivation expected = derived(words);
      ASSERT_EQ(expected.terminals, 1u);
      const GpgpInstance& instance = expected.instances[0];
      EXPECT_EQ(words[shape.node + shader::kNodeArgument], instance.terminal);
      EXPECT_EQ(shader::instanceShape(shape), instance.shape);
      EXPECT_EQ(shape.seed, instance.seed);
      EXPECT_EQ(shape.size, shader::vec3(instance.size[0], instance.size[1], instance.size[2]));
      EXPECT_EQ(shape.position, shader::vec3(instance.transform[3], instance.transform[7], instance.transform[11]));
    }
  }
}

spawn::KernelSource sourceOf(const std::string& text) {
  const spawn::Graph graph = compiled(text);
  return spawn::generate(graph, std::vector<bool>(graph.nodes.size()));
}

TEST(OperatorTable, TheGeneratorHasCodeForThem) {
  for (const Operator& op : operators()) {
    SCOPED_TRACE(grammarOf(op));
    const spawn::KernelSource source = sourceOf(grammarOf(op)), other = sourceOf(grammarOf(op, "0.25"));
    if (op.relation == spawn::Relation::Multiplying) {
      const size_t at = source.functions.find("#define GPGP_OPERATORS ");
      ASSERT_NE(at, std::string::npos);
      EXPECT_TRUE(std::stoul(source.functions.substr(at + 23)) >> op.op & 1);
    } else if (op.relation != spawn::Relation::Context) {
      EXPECT_NE(source.functions.find(std::string("// ") + op.name + "\n"), std::string::npos);
      if (op.values()) {
        EXPECT_NE(source.functions, other.functions);
      }                                                        // it has what depends on the parameter
      for (const char* word : {"GPGP_VALUE", "GPGP_ARGUMENT"}) // no word of the table is left
        EXPECT_EQ(source.functions.find(word), std::string::npos);
    }
  }
}

// ---------------------------------------------------------------- expressions

/// A grammar whose terminals' sizes are two expressions.
std::string scaledBy(const std::string& x) {
  return "axiom Box A; terminal T (1, 0); A = Scale(Exp(" + x + "), 1, 1) T;";
}
std::string binaryText(const spawn::Binary& binary, const std::string& left, const std::string& right) {
  return binary.precedence ? left + " " + binary.spelling + " " + right
                           : std::string(binary.spelling) + "(" + left + "," + right + ")";
}
std::string attributeText(const spawn::Attribute& attribute, uint32_t place) {
  std::string text = attribute.name + std::string("(");
  if (attribute.axes == 2) text += std::string(1, "XYZ"[place / 3]) + ",";
  if (attribute.axes) text += "XYZ"[place % 3];
  return text + ")";
}
void expectBothWays(const std::string& text, const std::string& word) {
  const spawn::Graph graph = compiled(text);
  const std::string printed = spawn::printGraph(graph);
  EXPECT_NE(printed.find(word), std::string::npos) << printed;
  spawn::Diagnostics diagnostics;
  const auto back = spawn::parseGraph(printed, diagnostics, std::pmr::new_delete_resource());
  ASSERT_TRUE(back) << printed;
  EXPECT_EQ(spawn::printGraph(back->graph), printed);
}
std::vector<uint32_t> scaledBy(GpgpGrammarBuilder builder, GpgpGrammarValue x) {
  gpgpAddAxiom(builder, GPGP_SHAPE_BOX, nullptr, 0, "A");
  gpgpAddTerminal(builder, "T", 1, 0);
  const GpgpGrammarValue values[] = {x, GPGP_GRAMMAR_NUMBER(1), GPGP_GRAMMAR_NUMBER(1)};
  GpgpGrammarSuccessor to{};
  to.name = "T";
  gpgpAddRule(builder, "A", nullptr, gpgpAddOperator(builder, GPGP_OPERATOR_SCALE, values, 3, &to, 1));
  std::vector<uint32_t> words = wordsOf(builder);
  gpgpDestroyGrammarBuilder(builder);
  return words;
}

TEST(OperatorTable, ExpressionsHaveEachCodeOfTwoValues) {
  for (const spawn::Binary& binary : spawn::kBinaries) {
    SCOPED_TRACE(binary.spelling);
    const bool infix = binary.precedence != 0;
    const std::string text = scaledBy(binaryText(binary, "ShapeSize(Y)", "3"));
    expectBothWays(text, binaryText(binary, "ShapeSize(Y)", "3"));
    const std::vector<uint32_t> words = bake(text);
    const float size = derived(words).instances.at(0).size[0];
    if (infix || binary.code != shader::kCodeRandom) {
      EXPECT_EQ(size, shader::scaled(1, shader::combine(binary.code, 2, 3, 0)));
    }
    if (binary.code == shader::kCodeRandom) {
      EXPECT_TRUE(size >= 2 && size <= 3) << size;
    }
    GpgpGrammarBuilder builder = nullptr;
    ASSERT_EQ(gpgpCreateGrammarBuilder(&builder), GPGP_SUCCESS);
    EXPECT_EQ(scaledBy(builder, gpgpAddExpression(builder, binary.kind, GPGP_GRAMMAR_VALUE(GPGP_VALUE_SHAPE_SIZE_Y),
                                                  GPGP_GRAMMAR_NUMBER(3))),
              words);
  }
}

TEST(OperatorTable, ExpressionsBindAsTheirPrecedenceSays) {
  for (const spawn::Binary& a : spawn::kBinaries)
    for (const spawn::Binary& b : spawn::kBinaries) {
      if (!a.precedence || !b.precedence) continue;
      const auto printed = [&](const char* open, const char* middle, const char* other, const char* close) {
        return spawn::printGraph(compiled(scaledBy(std::string(open) + "ShapeSize(X) " + a.spelling + " " + middle +
                                                   "ShapeSize(Y) " + other + b.spelling + " ShapeSize(Z)" + close)));
      };
      const bool left = a.precedence >= b.precedence;
      EXPECT_EQ(printed("", "", "", ""), left ? printed("(", "", ") ", "") : printed("", "(", "", ")"))
          << a.spelling << " " << b.spelling;
    }
}

TEST(OperatorTable, AttributesAreWhatShapesHave) {
  shader::Shape shape{};
  for (const spawn::Attribute& attribute : spawn::kAttributes)
    for (uint32_t place = 0; place < attribute.count() && attribute.code < shader::kCodeView; ++place) {
      const std::string text = attributeText(attribute, place);
      SCOPED_TRACE(text);
      EXPECT_EQ(&spawn::attributeAt(attribute.code + place), &attribute);
      expectBothWays(scaledBy("0 - " + text), text);
      const std::vector<uint32_t> words = bake(scaledBy(text));
      shape = shader::axiomShape(words.data(), shader::vec3(1, 2, 3), 0, shader::kDefaultRule,
                                 std::numeric_limits<float>::quiet_NaN(), 0);
      const float value = shader::attributeOf(shape, attribute.code + place);
      EXPECT_EQ(derived(words).instances.at(0).size[0], shader::scaled(1, value));
      GpgpGrammarBuilder builder = nullptr;
      ASSERT_EQ(gpgpCreateGrammarBuilder(&builder), GPGP_SUCCESS);
      EXPECT_EQ(scaledBy(builder, {attribute.value + place, 0}), words);
    }
}

TEST(OperatorTable, KernelsOfAllCompile) {
  std::string rules, names;
  for (const Operator& op : operators()) {
    names += std::string(names.empty() ? "" : " | ") + "R" + std::to_string(op.op);
    rules += " R" + std::to_string(op.op) + " = " + callOf(op, argumentsOf(op, "ShapeSeed()"), successorsOf(op)) + ";";
  }
  const std::string begin = "axiom Box A; terminal T (1, 0); terminal U (1, 1); A = ";
  EXPECT_TRUE(
      spawn::compileKernel(sourceOf(begin + "Replicate() { " + names + " };" + rules), spawn::KernelTarget::any));
  std::string binaries = "0", attributes = "0";
  for (const spawn::Binary& binary : spawn::kBinaries)
    binaries += " + (" + binaryText(binary, "ShapeSize(Y)", "3") + ")";
  for (const spawn::Attribute& attribute : spawn::kAttributes)
    for (uint32_t place = 0; place < attribute.count(); ++place) attributes += " + " + attributeText(attribute, place);
  EXPECT_TRUE(spawn::compileKernel(sourceOf(begin + "Scale(Exp(" + binaries + "), Exp(" + attributes + "), 1) T;"),
                                   spawn::KernelTarget::any));
}

} // namespace
