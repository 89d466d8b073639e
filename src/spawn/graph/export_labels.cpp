#include "spawn/graph/export_labels.h"

#include <array>
#include <bit>
#include <charconv>

namespace gpgp::spawn {
namespace {
using namespace shader;

std::string attributeText(uint32_t code) {
  const Attribute& attribute = attributeAt(code);
  const uint32_t place = code - attribute.code;
  std::string axes;
  if (attribute.axes == 2) axes = std::string(axisText(place / 3)) + ",";
  if (attribute.axes) axes += axisText(place % 3);
  return std::string(attribute.name).append("(").append(axes).append(")");
}

/// Along an edge of CompSplit, of the types that arrive from axioms, or else from any start.
const char* facesText(const Node& node, uint32_t slot) {
  const uint32_t arriving = node.axiomShapes ? node.axiomShapes : node.shapes;
  bool some = false, all = true;
  for (uint32_t s = 0; s < kShapeCount; ++s) {
    if (!(arriving >> s & 1)) continue;
    const bool has = outputOf(node, slot, s) != 0;
    some = some || has;
    all = all && has;
  }
  if (all) return slot == 2 ? "n" : "1";
  return !some ? "0" : slot == 2 ? "*" : "/";
}

std::string programText(const Graph& graph, uint32_t at) {
  std::vector<std::string> stack;
  const uint32_t first = at;
  bool isLeaf = true;
  for (uint32_t code = graph.code[at]; code != kCodeEnd; code = graph.code[at]) {
    ++at;
    if (code == kCodeNumber) {
      stack.push_back(numberText(std::bit_cast<float>(graph.code[at++])));
    } else if (code >= kCodeAttributes) {
      stack.push_back(attributeText(code));
    } else if (isField(code)) {
      isLeaf = false;
      const std::string z = stack.back();
      stack.pop_back();
      std::string text(GPGP_FIELD_SPELLING "(");
      text.append(graph.nameAt(graph.fields[code - kCodeField])).append(",").append(stack.back()).append(",");
      stack.back() = std::move(text.append(z).append(")"));
    } else {
      isLeaf = false;
      const std::string right = stack.back();
      stack.pop_back();
      std::string& left = stack.back();
      const Binary& binary = binaryOf(code);
      const std::string between = binary.precedence ? std::string(" ").append(binary.spelling).append(" ") : ",";
      std::string joined(binary.precedence ? "" : binary.spelling);
      joined.append("(").append(left).append(between).append(right).append(")");
      left = std::move(joined);
    }
  }
  const bool isOne = isLeaf && graph.code[first] < kCodeView; // as a program, which what the camera sees always is
  return isOne ? std::string("Exp(").append(stack.back()).append(")") : stack.back();
}
} // namespace

std::string numberText(float value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

std::string usualName(const Graph& graph, const Axiom& axiom) {
  for (const Rule& rule : graph.rules)
    if (rule.node == axiom.node) return graph.nameAt(rule.name);
  return {};
}

std::string axiomText(const Graph& graph, const Axiom& axiom) {
  const std::string name = graph.nameAt(axiom.name);
  const bool isGiven = graph.axioms.size() > 1 || name != usualName(graph, axiom);
  return (isGiven && !name.empty() ? name + ": " : std::string()) + shapeName(axiom.shape);
}

uint32_t usualPolygon(uint32_t shape) {
  const uint32_t corners = shape <= kShapeOctagon ? shape + 3 : shape <= kShapePrism8 ? shape - 3 : 3;
  return 2 * (corners - 3);
}

const char* axisText(uint32_t axis) { return axis == 0 ? "X" : axis == 1 ? "Y" : "Z"; }

const char* repeatModeText(uint32_t mode) {
  return mode == kRepeatAdjustToFill    ? "ADJUST_TO_FILL"
         : mode == kRepeatAnchorToStart ? "ANCHOR_TO_START"
                                        : "ANCHOR_TO_END";
}

std::string parameterText(const Graph& graph, const Parameter& p) {
  if (p.kind == kParameterConstant) return numberText(std::bit_cast<float>(p.value));
  return p.kind == kParameterAttribute ? attributeText(p.value) : programText(graph, p.value);
}

std::string nodeText(const Graph& graph, const Node& node) {
  if (node.op == kOpTerminal) return graph.nameAt(graph.terminals[node.argument].name);
  std::string arguments;
  const auto add = [&](const std::string& text) { arguments += std::string(arguments.empty() ? "" : ",") + text; };
  uint32_t axes = 0, values = 0;
  for (const char letter : kOperators[node.op].inParentheses()) switch (letter) {
    case 'a': add(axisText(node.argument >> (2 * axes++) & 3)); break;
    case 'm': add(repeatModeText(node.argument2)); break;
    case 't': add(tagText(graph, node.argument)); break;
    case 's': add(shapeName(node.argument)); break;
    case 'p': add(std::to_string(node.argument2)); break;
    default: add(parameterText(graph, graph.parameters[node.firstParameter + values++]));
    }
  return std::string(operatorName(node.op)).append("(").append(arguments).append(")");
}

std::string tagText(const Graph& graph, uint32_t tag) {
  return tag & kTagName ? std::string(graph.nameAt(tag & ~kTagName)) : std::to_string(tag);
}

std::string edgeValueText(const Graph& graph, const Node& node, uint32_t slot) {
  const Operator& op = kOperators[node.op];
  if (op.hasSuccessorValues()) return parameterText(graph, graph.parameters[node.firstParameter + op.values() + slot]);
  return "";
}

const char* multiplicityText(const Graph& graph, const Node& node, uint32_t slot) {
  switch (graph.edges[node.firstEdge + slot].multiplicity) {
  case kMultiplicityOptional: return "/";
  case kMultiplicityAny: return "*";
  case kMultiplicityFixed: return facesText(node, slot);
  default: return "1";
  }
}

} // namespace gpgp::spawn
