#include "spawn/language/print.h"

#include <cstdio>
#include <cstring>
#include <vector>

namespace gpgp::spawn {
namespace {
using namespace shader;

std::string number(uint32_t bits) {
  float value;
  std::memcpy(&value, &bits, 4);
  char text[32];
  std::snprintf(text, sizeof text, "%.7g", static_cast<double>(value));
  return text;
}

const char* axisName(uint32_t axis) { return axis == 0 ? "X" : axis == 1 ? "Y" : "Z"; }

std::string attribute(uint32_t code) {
  if (code == kCodeSeed) return "ShapeSeed()";
  if (code == kCodeCustom) return "ShapeCustomAttribute()";
  if (code >= kCodeRotation)
    return std::string("ShapeRotation(") + axisName((code - kCodeRotation) / 3) + "," +
           axisName((code - kCodeRotation) % 3) + ")";
  const char* name = code >= kCodeNormal ? "ShapeNormal(" : code >= kCodeShapeSize ? "ShapeSize(" : "ShapePos(";
  const uint32_t first = code >= kCodeNormal ? kCodeNormal : code >= kCodeShapeSize ? kCodeShapeSize : kCodePosition;
  return std::string(name) + axisName(code - first) + ")";
}

std::string program(const Graph& graph, uint32_t at) {
  static constexpr const char* kOperators[] = {
      "", "", " + ", " - ", " * ", " / ", " == ", " != ", " < ", " > ", " <= ", " >= ", " && ", " || "};
  std::vector<std::string> stack;
  for (uint32_t code = graph.code[at]; code != kCodeEnd; code = graph.code[at]) {
    ++at;
    if (code == kCodeNumber) {
      stack.push_back(number(graph.code[at++]));
    } else if (code >= kCodeAttributes) {
      stack.push_back(attribute(code));
    } else {
      const std::string right = stack.back();
      stack.pop_back();
      std::string& left = stack.back();
      std::string joined(code == kCodeRandom ? "Rand(" : "(");
      joined.append(left).append(code == kCodeRandom ? "," : kOperators[code]).append(right).append(")");
      left = std::move(joined);
    }
  }
  return stack.back();
}

std::string parameter(const Graph& graph, const Parameter& p) {
  if (p.kind == kParameterConstant) return number(p.value);
  return p.kind == kParameterAttribute ? attribute(p.value) : program(graph, p.value);
}

/// As in Translate(0,1,0) or SubDiv(X): what stands before the successors.
std::string head(const Graph& graph, const Node& node) {
  if (node.op == kOpTerminal) return graph.nameAt(graph.terminals[node.argument].name);
  std::string arguments;
  const auto add = [&](const std::string& text) { arguments += std::string(arguments.empty() ? "" : ",") + text; };
  if (node.op == kOpSubDiv || node.op == kOpRepeat || node.op == kOpIfSizeLess) add(axisName(node.argument));
  if (node.op == kOpSwapSize)
    for (uint32_t i = 0; i < 3; ++i) add(axisName(node.argument >> (2 * i) & 3));
  if (node.op == kOpSetGeometry) add(shapeName(node.argument) + std::string("#") + std::to_string(node.argument2));
  const uint32_t own = node.op == kOpSubDiv ? 0 : node.op == kOpRandomRule ? 1 : node.parameterCount;
  for (uint32_t i = 0; i < own; ++i) add(parameter(graph, graph.parameters[node.firstParameter + i]));
  if (node.op == kOpRepeat) {
    static constexpr const char* kModes[] = {"ADJUST_TO_FILL", "ANCHOR_TO_START", "ANCHOR_TO_END"};
    add(kModes[node.argument2]);
  }
  return std::string(operatorName(node.op)).append("(").append(arguments).append(")");
}

/// The value that belongs to an edge, as "-1: ".
std::string label(const Graph& graph, const Node& node, uint32_t edge) {
  if (node.op == kOpSubDiv) return parameter(graph, graph.parameters[node.firstParameter + edge]) + ": ";
  if (node.op == kOpRandomRule) return parameter(graph, graph.parameters[node.firstParameter + 1 + edge]) + ": ";
  return "";
}

std::string multiplicity(const Graph& graph, const Node& node, uint32_t edge) {
  switch (graph.edges[node.firstEdge + edge].multiplicity) {
  case kMultiplicityOptional: return "/";
  case kMultiplicityAny: return "*";
  case kMultiplicityFixed: return edge == 2 ? "n" : "1";
  default: return "1";
  }
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}
} // namespace

std::string printText(const Graph& graph) {
  std::string text = std::string("axiom ") + std::string(shapeName(graph.axiomShape)) + " -> " +
                     (graph.axiomNode == kNoNode ? std::string("Discard") : std::to_string(graph.axiomNode)) + "\n";
  for (const Rule& rule : graph.rules)
    text += "rule " + std::string(graph.nameAt(rule.name)) + " = " +
            (rule.node == kNoNode ? std::string("Discard") : std::to_string(rule.node)) + "\n";
  for (uint32_t i = 0; i < graph.nodes.size(); ++i) {
    const Node& node = graph.nodes[i];
    text += std::to_string(i) + " " + head(graph, node);
    for (uint32_t e = 0; e < node.edgeCount; ++e) {
      const uint32_t target = graph.edges[node.firstEdge + e].target;
      text += (e ? " | " : " { ") + label(graph, node, e) + "[" + multiplicity(graph, node, e) + "] " +
              (target == kNoNode ? std::string("Discard") : std::to_string(target));
    }
    text += node.edgeCount ? " }\n" : "\n";
  }
  return text;
}

std::string printDot(const Graph& graph) {
  std::string text = "digraph grammar {\n  node [shape=box, style=rounded, fontname=\"sans-serif\"];\n"
                     "  start [label=\"" +
                     std::string(shapeName(graph.axiomShape)) +
                     "\", color=blue];\n"
                     "  discard [label=\"Discard\", color=gray];\n";
  const auto name = [](uint32_t target) {
    return target == kNoNode ? std::string("discard") : std::string("n") + std::to_string(target);
  };
  text += "  start -> " + name(graph.axiomNode) + " [label=\"*\"];\n";
  for (uint32_t i = 0; i < graph.nodes.size(); ++i) {
    const Node& node = graph.nodes[i];
    text += "  n" + std::to_string(i) + " [label=\"" + escaped(head(graph, node)) + "\"" +
            (node.op == kOpTerminal ? ", color=orange" : "") + "];\n";
    for (uint32_t e = 0; e < node.edgeCount; ++e)
      text += "  n" + std::to_string(i) + " -> " + name(graph.edges[node.firstEdge + e].target) + " [label=\"" +
              escaped(label(graph, node, e)) + multiplicity(graph, node, e) + "\"];\n";
  }
  return text + "}\n";
}

} // namespace gpgp::spawn
