// Checks of an operator graph, so that the interpreter needs none.
#include "spawn/graph/graph.h"

#include <cstring>

namespace gpgp::spawn {
namespace {
using core::makeError;
using core::Result;
using namespace shader;

constexpr const char* kShapes[kShapeCount] = {"Triangle",
                                              "Quad",
                                              "Pentagon",
                                              "Hexagon",
                                              "Heptagon",
                                              "Octagon",
                                              "Prism3",
                                              "Box",
                                              "Prism5",
                                              "Prism6",
                                              "Prism7",
                                              "Prism8",
                                              "DynamicConvexPolygon",
                                              "DynamicPolygon",
                                              "DynamicConvexRightPrism",
                                              "DynamicRightPrism",
                                              "Sphere",
                                              "Roof",
                                              "Trapezoid"};

/// A settled float: what the interpreter's arithmetic expects. Own test, as NaN must not pass.
bool isSettled(uint32_t bits) {
  const uint32_t exponent = (bits >> 23) & 0xffu;
  return bits == 0 || (exponent >= 27 && exponent <= 226) || (bits & 0x7fffffffu) == 0x71800000u;
}

/// Programs lie back to back in the code; marks where they start, by the kind of a parameter that has it. Linear in the
/// code's size.
Result<void> checkCode(const Graph& graph, std::pmr::vector<uint8_t>& starts) {
  size_t at = 0;
  while (at < graph.code.size()) {
    const size_t start = at;
    starts[start] = kParameterProgram;
    uint32_t depth = 0;
    for (;;) {
      if (at >= graph.code.size()) return makeError(GPGP_ERROR_INVALID_DATA, "program %zu has no end", start);
      const uint32_t code = graph.code[at++];
      if (code == kCodeEnd) break;
      if (code == kCodeNumber) {
        if (at >= graph.code.size() || !isSettled(graph.code[at]))
          return makeError(GPGP_ERROR_INVALID_DATA, "program %zu has a bad number", start);
        ++at;
        ++depth;
      } else if (code >= kCodeAttributes && code < kCodeCount) {
        if (code >= kCodeView) starts[start] = kParameterView;
        ++depth;
      } else if ((code >= kCodeAdd && code <= kCodeRandom) || // kBinaries
                 (isField(code) && code - kCodeField < graph.fields.size())) {
        if (depth < 2) return makeError(GPGP_ERROR_INVALID_DATA, "program %zu takes from an empty stack", start);
        --depth;
      } else {
        return makeError(GPGP_ERROR_INVALID_DATA, "program %zu has unknown code %u", start, code);
      }
      if (depth > kMaxStack)
        return makeError(GPGP_ERROR_INVALID_DATA, "program %zu needs more than %u values at once", start, kMaxStack);
    }
    if (depth != 1) return makeError(GPGP_ERROR_INVALID_DATA, "program %zu leaves %u values", start, depth);
  }
  return {};
}

bool nameEnds(const Graph& graph, uint32_t offset) {
  return offset < graph.names.size() &&
         std::memchr(graph.names.data() + offset, 0, graph.names.size() - offset) != nullptr;
}

/// The corners that a shape type's polygon must have; 0: any.
uint32_t cornersOf(uint32_t shape) {
  if (shape <= kShapeOctagon) return shape + 3;
  if (shape <= kShapePrism8) return shape - 3;
  return 0;
}

Result<void> checkGeometry(const Graph& graph, const char* where, uint32_t shape, uint32_t polygon) {
  if (shape >= kShapeCount) return makeError(GPGP_ERROR_INVALID_DATA, "%s has unknown shape %u", where, shape);
  const size_t own = graph.polygons.size() - graph.pieces;
  if (polygon >= own) return makeError(GPGP_ERROR_INVALID_DATA, "%s names polygon %u of %zu", where, polygon, own);
  const uint32_t corners = cornersOf(shape);
  if (corners && graph.polygons[polygon].vertexCount != corners)
    return makeError(GPGP_ERROR_INVALID_DATA, "%s: a %s needs %u corners", where, kShapes[shape], corners);
  return {};
}

Result<void> checkNode(const Graph& graph, uint32_t index) {
  const Node& node = graph.nodes[index];
  const auto bad = [&](const char* what) {
    return makeError(GPGP_ERROR_INVALID_DATA, "node %u (%s): %s", index, operatorName(node.op), what);
  };
  if (node.op >= kOpCount) return bad("unknown operator");
  if (node.priority > kMaxPriority) return bad("its priority is too high");
  if (node.parameterCount > graph.parameters.size() ||
      node.firstParameter > graph.parameters.size() - node.parameterCount)
    return bad("parameters out of range");
  if (node.edgeCount > graph.edges.size() || node.firstEdge > graph.edges.size() - node.edgeCount)
    return bad("edges out of range");
  const Operator& op = kOperators[node.op];
  const bool isMany = op.successors == kMany;
  if (node.edgeCount < (isMany ? 1 : op.successors) || node.edgeCount > (isMany ? kMaxSuccessors : op.successors))
    return bad("wrong number of successors");
  if (node.parameterCount != op.values() + (op.hasSuccessorValues() ? node.edgeCount : 0))
    return bad("wrong number of parameters");
  if (node.op == kOpTerminal) {
    if (node.argument >= graph.terminals.size()) return bad("unknown terminal");
    if (node.argument2 != graph.terminals[node.argument].bucket) return bad("wrong bucket");
    if (node.rule != kNoRule && node.rule >= graph.rules.size()) return bad("unknown rule");
  }
  if (op.axes() && node.argument >> 2 * op.axes()) return bad("unknown axis");
  uint32_t axes = node.argument;
  for (const char letter : op.inParentheses()) {
    if (letter == 'a' && (axes & 3) == 3) return bad("unknown axis");
    if (letter == 'a') axes >>= 2;
    if (letter == 'm' && node.argument2 > kRepeatAnchorToEnd) return bad("unknown mode");
    if (letter == 't' && (node.argument & kTagName) && !nameEnds(graph, node.argument & ~kTagName))
      return bad("a tag has a bad name");
    if (letter == 's') return checkGeometry(graph, op.name, node.argument, node.argument2);
  }
  return {};
}
} // namespace

const char* operatorName(uint32_t op) { return op < kOpCount ? kOperators[op].name : "?"; }
const char* shapeName(uint32_t shape) { return shape < kShapeCount ? kShapes[shape] : "?"; }

Result<void> validate(const Graph& graph) {
  const size_t nodes = graph.nodes.size();
  const auto isTarget = [&](uint32_t node) { return node < nodes || node == kNoNode; };
  for (const Edge& edge : graph.edges) {
    if (!isTarget(edge.target))
      return makeError(GPGP_ERROR_INVALID_DATA, "an edge leads to node %u of %zu", edge.target, nodes);
    if (edge.multiplicity > kMultiplicityAny)
      return makeError(GPGP_ERROR_INVALID_DATA, "an edge has an unknown multiplicity");
  }
  std::pmr::vector<uint8_t> starts(graph.code.size(), 0, graph.code.get_allocator().resource());
  if (auto ok = checkCode(graph, starts); !ok) return ok;
  for (const Parameter& parameter : graph.parameters) {
    if (parameter.kind == kParameterConstant) {
      if (!isSettled(parameter.value)) return makeError(GPGP_ERROR_INVALID_DATA, "a parameter is not a usable number");
    } else if (parameter.kind == kParameterAttribute) {
      if (parameter.value < kCodeAttributes || parameter.value >= kCodeView)
        return makeError(GPGP_ERROR_INVALID_DATA, "a parameter is an unknown attribute");
    } else if (hasProgram(parameter.kind)) {
      if (parameter.value >= starts.size() || starts[parameter.value] != parameter.kind)
        return makeError(GPGP_ERROR_INVALID_DATA, "a parameter has no program");
    } else {
      return makeError(GPGP_ERROR_INVALID_DATA, "a parameter has an unknown kind");
    }
  }
  if (graph.polygons.size() < kRegularPolygons || graph.polygons.size() % 2 || graph.polygons.size() > 0xffffff)
    return makeError(GPGP_ERROR_INVALID_DATA, "%zu polygons", graph.polygons.size());
  if (graph.pieces % 2 || graph.pieces > graph.polygons.size() - kRegularPolygons)
    return makeError(GPGP_ERROR_INVALID_DATA, "%u polygons of %zu are pieces", graph.pieces, graph.polygons.size());
  const size_t vertices = graph.vertices.size() / 2, quads = graph.quads.size() / kQuadSize;
  for (size_t i = 0; i < graph.polygons.size(); ++i) {
    const Polygon& polygon = graph.polygons[i];
    if (polygon.vertexCount < 3 || polygon.vertexCount > kMaxCorners || polygon.vertexCount > vertices ||
        polygon.firstVertex > vertices - polygon.vertexCount)
      return makeError(GPGP_ERROR_INVALID_DATA, "polygon %zu has vertices out of range", i);
    if (polygon.vertexCount != graph.polygons[i ^ 1].vertexCount ||
        (i < kRegularPolygons && polygon.vertexCount != i / 2 + 3))
      return makeError(GPGP_ERROR_INVALID_DATA, "polygon %zu has %u corners", i, polygon.vertexCount);
    if (polygon.quadCount >= polygon.vertexCount || polygon.firstQuad > quads ||
        polygon.quadCount > quads - polygon.firstQuad)
      return makeError(GPGP_ERROR_INVALID_DATA, "polygon %zu has quads out of range", i);
    for (size_t word = kQuadSize * size_t(polygon.firstQuad);
         word < kQuadSize * (size_t(polygon.firstQuad) + polygon.quadCount); ++word)
      if ((graph.quads[word] & 0xffffu) >= polygon.vertexCount || graph.quads[word] >> 16 >= polygon.vertexCount)
        return makeError(GPGP_ERROR_INVALID_DATA, "polygon %zu has a quad with a corner out of range", i);
  }
  for (size_t i = 0, own = graph.polygons.size() - graph.pieces; graph.pieces && i < own; ++i)
    if (graph.polygons[i].firstVertex + graph.polygons[i].vertexCount > graph.polygons[own].firstVertex ||
        graph.polygons[i].firstQuad + graph.polygons[i].quadCount > graph.polygons[own].firstQuad)
      return makeError(GPGP_ERROR_INVALID_DATA, "polygon %zu lies among pieces", i);
  if (graph.vertices.size() % 2) return makeError(GPGP_ERROR_INVALID_DATA, "half a vertex");
  for (size_t i = 0; i < graph.vertices.size(); i += 2)
    if (!isCorner(graph.vertices[i], graph.vertices[i + 1])) // no NaN is
      return makeError(GPGP_ERROR_INVALID_DATA, "corner %zu is not from -0.5 to 0.5", i / 2);
  if (graph.buckets > kMaxBuckets)
    return makeError(GPGP_ERROR_INVALID_DATA, "%u terminal lines; at most %u", graph.buckets, kMaxBuckets);
  for (const Terminal& terminal : graph.terminals)
    if (!nameEnds(graph, terminal.name) || terminal.bucket >= graph.buckets || terminal.kind > 1)
      return makeError(GPGP_ERROR_INVALID_DATA, "a terminal has a bad name, kind or bucket");
  if (graph.fields.size() > kMaxFields)
    return makeError(GPGP_ERROR_INVALID_DATA, "%zu fields; at most %u", graph.fields.size(), kMaxFields);
  for (size_t i = 0; i < graph.fields.size(); ++i) {
    if (!nameEnds(graph, graph.fields[i])) return makeError(GPGP_ERROR_INVALID_DATA, "field %zu has a bad name", i);
    for (size_t other = 0; other < i; ++other)
      if (std::strcmp(graph.nameAt(graph.fields[i]), graph.nameAt(graph.fields[other])) == 0)
        return makeError(GPGP_ERROR_INVALID_DATA, "fields %zu and %zu have the same name", other, i);
  }
  for (const Rule& rule : graph.rules)
    if (!nameEnds(graph, rule.name) || !isTarget(rule.node) || rule.axiom >= graph.axioms.size())
      return makeError(GPGP_ERROR_INVALID_DATA, "a rule has a bad name, node or axiom");
  for (uint32_t i = 0; i < nodes; ++i)
    if (auto ok = checkNode(graph, i); !ok) return ok;
  if (graph.axioms.empty()) return makeError(GPGP_ERROR_INVALID_DATA, "there is no axiom");
  for (const Axiom& axiom : graph.axioms) {
    if (!nameEnds(graph, axiom.name) || !isTarget(axiom.node))
      return makeError(GPGP_ERROR_INVALID_DATA, "an axiom has a bad name or node");
    if (auto ok = checkGeometry(graph, "an axiom", axiom.shape, axiom.polygon); !ok) return ok;
  }
  return {};
}

} // namespace gpgp::spawn
