// The operator graph (thesis 4.1): nodes are operators with parameters, edges are the ways that shapes take.
//
// A plain value: the language builds it, blob.h turns it into words and back, print.h shows it. References are indices;
// kNoNode as a target discards the shape.
#pragma once
#include "core/result.h"
#include "spawn/graph/operator_info.h"

#include <memory_resource>
#include <string>
#include <string_view>
#include <vector>

namespace gpgp::spawn {

constexpr uint32_t kNoNode = UINT32_MAX;
constexpr uint32_t kNoPhases = UINT32_MAX;

struct Parameter {
  uint32_t kind = shader::kParameterConstant;
  uint32_t value = 0; ///< float bits, an attribute's code, or an index in Graph::code
};

struct Edge {
  uint32_t target = kNoNode;
  uint32_t multiplicity = shader::kMultiplicityOne;
  uint32_t shapes = 0;    ///< bit set of the shape types that travel along it
  bool recursive = false; ///< closes a cycle
};

struct Node {
  uint32_t op = shader::kOpTerminal;
  uint32_t argument = 0, argument2 = 0;
  uint32_t firstParameter = 0, parameterCount = 0;
  uint32_t firstEdge = 0, edgeCount = 0;
  uint32_t shapes = 0;             ///< bit set of the shape types that can arrive, from axioms or as a start rule
  uint32_t axiomShapes = 0;        ///< those of them that come from axioms
  uint32_t division = UINT32_MAX;  ///< in Graph::divisions
  bool filter = false;             ///< could multiply shapes, but passes on at most one
  bool cuts = false;               ///< SubDiv by constant weights alone: cuts polygons
  bool uncut = false;              ///< one that can arrive it cannot cut; such shapes are dropped and counted
  bool draws = false;              ///< passes on one shape, and a parameter draws a random number
  bool sees = false;               ///< a parameter asks what the camera sees of the shape
  uint32_t priority = 0;           ///< of its rule, at most kMaxPriority: see dependenciesOf()
  uint32_t rule = shader::kNoRule; ///< of a terminal: in whose body it stands
};

struct Polygon {
  uint32_t firstVertex = 0, vertexCount = 0; ///< in Graph::vertices, two floats each
  uint32_t firstQuad = 0, quadCount = 0;     ///< in Graph::quads, two words each; none: convex, a fan of them
};
constexpr uint32_t kNoPolygon = UINT32_MAX;

struct Terminal {
  uint32_t name = 0; ///< byte offset in Graph::names
  uint32_t kind = 0, index = 0, bucket = 0;
};

struct Rule {
  uint32_t name = 0;
  uint32_t node = kNoNode;
  uint32_t axiom = 0; ///< with whose shape a derivation starts at this rule
};

/// Where derivations start.
struct Axiom {
  uint32_t name = 0;
  uint32_t node = kNoNode;
  uint32_t shape = shader::kShapeBox, polygon = 0;
};

struct Graph {
  explicit Graph(std::pmr::memory_resource* memory)
      : nodes(memory), edges(memory), parameters(memory), code(memory), polygons(memory), vertices(memory),
        quads(memory), terminals(memory), rules(memory), axioms(memory), names(memory), fields(memory),
        divisions(memory) {}

  std::pmr::vector<Node> nodes;
  std::pmr::vector<Edge> edges;
  std::pmr::vector<Parameter> parameters;
  std::pmr::vector<uint32_t> code;
  std::pmr::vector<Polygon> polygons;
  uint32_t pieces = 0; ///< of them, the last: those that SubDiv makes; from analyse()
  std::pmr::vector<float> vertices;
  std::pmr::vector<uint32_t> quads; ///< four corners of their polygon each, 16 bits
  std::pmr::vector<Terminal> terminals;
  std::pmr::vector<Rule> rules;
  std::pmr::vector<Axiom> axioms;       ///< the first is the default
  std::pmr::vector<char> names;         ///< each ends in 0
  std::pmr::vector<uint32_t> fields;    ///< of the world, by their numbers: their names; at most kMaxFields
  std::pmr::vector<uint32_t> divisions; ///< of SubDivs with constant parts, as in the baked form; from analyse()
  uint32_t buckets = 0;                 ///< terminal lines
  /// Of derivation; 0 without Collider and IfCollides, kNoPhases where they cannot run in any order. From analyse().
  uint32_t phases = 0;

  const char* nameAt(uint32_t offset) const { return names.data() + offset; }
};

/// Where a derivation can start: at the rules, then at the axioms, as GpgpAxiom::start counts them.
struct Start {
  const char* name;
  const Axiom* axiom; ///< which has the shape
};
inline uint32_t startCount(const Graph& graph) {
  return static_cast<uint32_t>(graph.rules.size() + graph.axioms.size());
}
inline Start startAt(const Graph& graph, uint32_t start) {
  const bool isRule = start < graph.rules.size();
  const Axiom& axiom = graph.axioms[isRule ? graph.rules[start].axiom : start - graph.rules.size()];
  return {graph.nameAt(isRule ? graph.rules[start].name : axiom.name), &axiom};
}

/// The six pairs of regular polygons that every graph begins with. A polygon with n corners spans [-0.5, 0.5] on both
/// axes; its number is 2 (n - 3).
void addRegularPolygons(Graph& graph);
/// Whether shapes have room for this corner: what bounds them relies on it.
inline bool isCorner(float x, float y) { return x >= -0.5f && x <= 0.5f && y >= -0.5f && y <= 0.5f; }
constexpr const char* kExpectedCorner = "x and y of a corner are from -0.5 to 0.5";
/// Adds a polygon and its mirror image; corners counter-clockwise, at most kMaxCorners. Returns the first one's number,
/// or kNoPolygon where it crosses itself.
uint32_t addPolygon(Graph& graph, const float* corners, uint32_t count);

/// The input-output relation of an operator (thesis 4.1): the type, as a bit, of what a shape of a type becomes along
/// an edge; 0 where nothing comes of it there.
uint32_t outputOf(const Node& node, uint32_t edge, uint32_t shape);

/// Fills in what follows from nodes and edges: multiplicities, the shape types on nodes and edges, filters, recursion,
/// phases.
void analyse(Graph& graph);

/// Every index, enum, count and program. What passes can be derived without further checks and without end only where
/// the graph has a cycle.
core::Result<void> validate(const Graph& graph);

/// Whether a code reads a field, and is not one of kBinaries.
constexpr bool isField(uint32_t code) { return code >= shader::kCodeField && code < shader::kCodeAttributes; }
static_assert(shader::kCodeField + shader::kMaxFields == shader::kCodeAttributes);
/// The number of a field, which is added if there is room for it; kNoField where there is none.
uint32_t fieldNamed(Graph& graph, std::string_view name);
constexpr uint32_t kNoField = UINT32_MAX;
constexpr const char* kTooManyFields = "a grammar reads at most 8 fields, those of linked grammars together";
static_assert(shader::kMaxFields == 8);
/// The first rule whose operators read a field; null where only another operator does.
const char* ruleThatReads(const Graph& graph, uint32_t field);

/// How many random numbers a parameter draws.
uint32_t drawsOf(const Graph& graph, const Parameter& parameter);

/// A SubDiv to which shapes can come whose polygon it cuts.
inline bool isCutting(const Node& node) {
  for (uint32_t shape = 0; node.op == shader::kOpSubDiv && shape < shader::kShapeCount; ++shape)
    if ((node.shapes >> shape & 1) && shader::isCut(shape, node.argument)) return true;
  return false;
}

/// Whether an operator makes several shapes of one, not only could.
inline bool multiplies(const Node& node) { return couldMultiply(node.op) && !node.filter; }

/// Whether axioms grow into very different numbers of shapes: chance chooses among successors, and lengths say how many
/// children there are.
inline bool isUneven(const Graph& graph) {
  bool draws = false, repeats = false;
  for (const Node& node : graph.nodes) {
    draws = draws || node.op == shader::kOpRandomRule;
    repeats = repeats || node.op == shader::kOpRepeat;
  }
  return draws && repeats;
}

const char* operatorName(uint32_t op);
const char* shapeName(uint32_t shape);

} // namespace gpgp::spawn
