#include "spawn/graph/export_labels.h"

#include <array>
#include <bit>
#include <charconv>

namespace gpgp::spawn {
namespace {
using namespace shader;

std::string attributeText(uint32_t code) {
  if (code == kCodeSeed) return "ShapeSeed()";
  if (code == kCodeCustom) return "ShapeCustomAttribute()";
  if (code >= kCodeRotation)
    return std::string("ShapeRotation(") + axisText((code - kCodeRotation) / 3) + "," +
           axisText((code - kCodeRotation) % 3) + ")";
  const char* name = code >= kCodeNormal ? "ShapeNormal(" : code >= kCodeShapeSize ? "ShapeSize(" : "ShapePos(";
  const uint32_t first = code >= kCodeNormal ? kCodeNormal : code >= kCodeShapeSize ? kCodeShapeSize : kCodePosition;
  return std::string(name) + axisText(code - first) + ")";
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
  bool isLeaf = true;
  for (uint32_t code = graph.code[at]; code != kCodeEnd; code = graph.code[at]) {
    ++at;
    if (code == kCodeNumber) {
      stack.push_back(numberText(std::bit_cast<float>(graph.code[at++])));
    } else if (code >= kCodeAttributes) {
      stack.push_back(attributeText(code));
    } else {
      isLeaf = false;
      const std::string right = stack.back();
      stack.pop_back();
      std::string& left = stack.back();
      std::string joined(code == kCodeRandom ? "Rand(" : "(");
      joined.append(left).append(code == kCodeRandom ? "," : binaryText(code)).append(right).append(")");
      left = std::move(joined);
    }
  }
  return isLeaf ? std::string("Exp(").append(stack.back()).append(")") : stack.back();
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

const char* binaryText(uint32_t code) {
  static constexpr std::array kOperators{
      "", "", " + ", " - ", " * ", " / ", " == ", " != ", " < ", " > ", " <= ", " >= ", " && ", " || "};
  return kOperators.at(code);
}

std::string parameterText(const Graph& graph, const Parameter& p) {
  if (p.kind == kParameterConstant) return numberText(std::bit_cast<float>(p.value));
  return p.kind == kParameterAttribute ? attributeText(p.value) : programText(graph, p.value);
}

std::string nodeText(const Graph& graph, const Node& node) {
  if (node.op == kOpTerminal) return graph.nameAt(graph.terminals[node.argument].name);
  std::string arguments;
  const auto add = [&](const std::string& text) { arguments += std::string(arguments.empty() ? "" : ",") + text; };
  if (node.op == kOpSubDiv || node.op == kOpRepeat || node.op == kOpIfSizeLess) add(axisText(node.argument));
  if (node.op == kOpSwapSize)
    for (uint32_t i = 0; i < 3; ++i) add(axisText(node.argument >> (2 * i) & 3));
  if (node.op == kOpSetGeometry) {
    add(shapeName(node.argument));
    add(std::to_string(node.argument2));
  }
  if (isContext(node.op)) add(tagText(graph, node.argument));
  const uint32_t own = node.op == kOpSubDiv ? 0 : node.op == kOpRandomRule ? 1 : node.parameterCount;
  for (uint32_t i = 0; i < own; ++i) add(parameterText(graph, graph.parameters[node.firstParameter + i]));
  if (node.op == kOpRepeat) add(repeatModeText(node.argument2));
  return std::string(operatorName(node.op)).append("(").append(arguments).append(")");
}

std::string tagText(const Graph& graph, uint32_t tag) {
  return tag & kTagName ? std::string(graph.nameAt(tag & ~kTagName)) : std::to_string(tag);
}

std::string edgeValueText(const Graph& graph, const Node& node, uint32_t slot) {
  if (node.op == kOpSubDiv) return parameterText(graph, graph.parameters[node.firstParameter + slot]);
  if (node.op == kOpRandomRule) return parameterText(graph, graph.parameters[node.firstParameter + 1 + slot]);
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
