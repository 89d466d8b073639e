#include "spawn/graph/blob.h"

#include <cstring>

namespace gpgp::spawn {
namespace {
using core::makeError;
using core::Result;
using namespace shader;

/// Words of each section, from counts of entries.
constexpr uint32_t kEntryWords[kSectionCount] = {
    kNodeSize, kEdgeSize, kParameterSize, 1, kPolygonSize, 2, kTerminalSize, kRuleSize, 1, 1, kQuadSize, kAxiomSize, 1};

uint32_t bitsOf(float v) {
  uint32_t bits;
  std::memcpy(&bits, &v, 4);
  return bits;
}
} // namespace

uint32_t checksum(std::span<const uint32_t> words) {
  uint32_t hash = 0x811c9dc5u;
  for (const uint32_t word : words) {
    hash = (hash ^ word) * 0x01000193u;
    hash ^= hash >> 15;
  }
  return hash;
}

size_t sizeOfGraph(std::span<const std::byte> bytes) {
  uint32_t words = 0;
  if (bytes.size() >= kHeaderSize * 4) std::memcpy(&words, bytes.data() + 4 * kHeaderWords, 4);
  return words >= kHeaderSize && uint64_t(words) * 4 < bytes.size() ? size_t(words) * 4 : bytes.size();
}

std::pmr::vector<uint32_t> serialize(const Graph& graph, std::pmr::memory_resource* memory) {
  const uint32_t counts[kSectionCount] = {static_cast<uint32_t>(graph.nodes.size()),
                                          static_cast<uint32_t>(graph.edges.size()),
                                          static_cast<uint32_t>(graph.parameters.size()),
                                          static_cast<uint32_t>(graph.code.size()),
                                          static_cast<uint32_t>(graph.polygons.size()),
                                          static_cast<uint32_t>(graph.vertices.size() / 2),
                                          static_cast<uint32_t>(graph.terminals.size()),
                                          static_cast<uint32_t>(graph.rules.size()),
                                          static_cast<uint32_t>((graph.names.size() + 3) / 4),
                                          static_cast<uint32_t>(graph.divisions.size()),
                                          static_cast<uint32_t>(graph.quads.size() / kQuadSize),
                                          static_cast<uint32_t>(graph.axioms.size()),
                                          static_cast<uint32_t>(graph.fields.size())};
  std::pmr::vector<uint32_t> words(kHeaderSize, 0u, memory);
  uint32_t offsets[kSectionCount];
  uint32_t offset = kHeaderSize;
  for (uint32_t s = 0; s < kSectionCount; ++s) {
    words[kHeaderSections + 2 * s] = counts[s];
    words[kHeaderSections + 2 * s + 1] = offsets[s] = offset;
    offset += counts[s] * kEntryWords[s];
  }
  const auto at = [&](uint32_t section, uint32_t index) { return offsets[section] + index * kEntryWords[section]; };
  const auto nodeAt = [&](uint32_t node) { return node == kNoNode ? 0u : at(kSectionNodes, node); };
  words.reserve(offset);
  words[kHeaderMagic] = kGraphMagic;
  words[kHeaderVersion] = kGraphVersion;
  words[kHeaderWords] = offset;
  words[kHeaderBuckets] = graph.buckets;
  words[kHeaderPhases] = graph.phases;
  words[kHeaderPieces] = graph.pieces;
  for (const Node& n : graph.nodes)
    words.insert(words.end(), {n.op | (n.filter ? kNodeFilter : 0u) | (n.draws ? kNodeDraws : 0u) |
                                   (n.sees ? kNodeSees : 0u) | n.priority << kNodePriority,
                               n.argument, n.division == UINT32_MAX ? n.argument2 : at(kSectionDivisions, n.division),
                               n.op == kOpTerminal ? n.rule : at(kSectionParameters, n.firstParameter),
                               n.parameterCount, at(kSectionEdges, n.firstEdge), n.edgeCount, n.shapes});
  for (const Edge& e : graph.edges)
    words.insert(words.end(), {nodeAt(e.target) | (e.recursive ? kEdgeRecursive : 0u), e.multiplicity, e.shapes});
  for (const Parameter& p : graph.parameters)
    words.insert(words.end(), {p.kind, hasProgram(p.kind) ? at(kSectionCode, p.value) : p.value});
  words.insert(words.end(), graph.code.begin(), graph.code.end());
  for (const Polygon& p : graph.polygons)
    words.insert(words.end(),
                 {at(kSectionVertices, p.firstVertex), p.vertexCount, at(kSectionQuads, p.firstQuad), p.quadCount});
  for (const float v : graph.vertices) words.push_back(bitsOf(v));
  for (const Terminal& t : graph.terminals) words.insert(words.end(), {t.name, t.kind, t.index, t.bucket});
  for (const Rule& r : graph.rules) words.insert(words.end(), {r.name, nodeAt(r.node), at(kSectionAxioms, r.axiom)});
  words.resize(offsets[kSectionDivisions], 0u); // names
  words.insert(words.end(), graph.divisions.begin(), graph.divisions.end());
  words.insert(words.end(), graph.quads.begin(), graph.quads.end());
  for (const Axiom& a : graph.axioms) words.insert(words.end(), {a.name, nodeAt(a.node), a.shape | a.polygon << 8});
  words.insert(words.end(), graph.fields.begin(), graph.fields.end());
  if (!graph.names.empty()) std::memcpy(words.data() + offsets[kSectionNames], graph.names.data(), graph.names.size());
  words[kHeaderChecksum] = checksum(std::span(words).subspan(kHeaderChecked));
  return words;
}

Result<Graph> load(std::span<const std::byte> bytes, std::pmr::memory_resource* memory) {
  const auto bad = [](const char* what) { return makeError(GPGP_ERROR_INVALID_DATA, "not a baked grammar: %s", what); };
  if (bytes.size() < kHeaderSize * 4) return bad("it is too short");
  if (bytes.size() % 4 || bytes.size() / 4 > UINT32_MAX / 2) return bad("its size is not one that grammars have");
  std::pmr::vector<uint32_t> words(bytes.size() / 4, memory);
  std::memcpy(words.data(), bytes.data(), bytes.size());
  if (words[kHeaderMagic] != kGraphMagic) return bad("it does not begin with \"gppg\"");
  if (words[kHeaderVersion] != kGraphVersion)
    return makeError(GPGP_ERROR_INVALID_DATA,
                     "the grammar was baked in format %u; this library reads format %u: bake it again",
                     words[kHeaderVersion], kGraphVersion);
  if (words[kHeaderWords] != words.size()) return bad("it was cut, or something follows it");
  if (words[kHeaderChecksum] != checksum(std::span(words).subspan(kHeaderChecked))) return bad("its checksum is wrong");

  uint64_t expected = kHeaderSize;
  uint32_t counts[kSectionCount], offsets[kSectionCount];
  for (uint32_t s = 0; s < kSectionCount; ++s) {
    counts[s] = words[kHeaderSections + 2 * s];
    offsets[s] = words[kHeaderSections + 2 * s + 1];
    if (offsets[s] != expected) return bad("a section is not where it should be");
    expected += uint64_t(counts[s]) * kEntryWords[s];
    if (expected > words.size()) return bad("a section is longer than the file");
  }
  if (expected != words.size()) return bad("its sections do not fill it");

  // A word offset back to an index; UINT32_MAX - 1 (never valid) where it is none.
  const auto indexOf = [&](uint32_t section, uint32_t offset, uint32_t slack) {
    const uint32_t rest = offset - offsets[section];
    if (offset < offsets[section] || rest % kEntryWords[section] ||
        rest / kEntryWords[section] >= counts[section] + slack)
      return UINT32_MAX - 1;
    return rest / kEntryWords[section];
  };
  const auto nodeIndex = [&](uint32_t offset) { return offset == 0 ? kNoNode : indexOf(kSectionNodes, offset, 0); };
  const auto entry = [&](uint32_t section, uint32_t index) {
    return words.data() + offsets[section] + size_t(index) * kEntryWords[section];
  };

  Graph graph(memory);
  graph.buckets = words[kHeaderBuckets];
  graph.pieces = words[kHeaderPieces];
  graph.nodes.reserve(counts[kSectionNodes]);
  for (uint32_t i = 0; i < counts[kSectionNodes]; ++i) {
    const uint32_t* w = entry(kSectionNodes, i);
    const uint32_t op = w[kNodeOperator] & kOperatorMask;
    graph.nodes.push_back({op, w[kNodeArgument], op == kOpSubDiv ? 0 : w[kNodeArgument2],
                           op == kOpTerminal ? 0 : indexOf(kSectionParameters, w[kNodeParameters], 1),
                           w[kNodeParameterCount], indexOf(kSectionEdges, w[kNodeEdges], 1), w[kNodeEdgeCount],
                           w[kNodeShapes]});
    graph.nodes.back().priority = w[kNodeOperator] >> kNodePriority;
    if (op == kOpTerminal) graph.nodes.back().rule = w[kNodeRule];
  }
  graph.edges.reserve(counts[kSectionEdges]);
  for (uint32_t i = 0; i < counts[kSectionEdges]; ++i) {
    const uint32_t* w = entry(kSectionEdges, i);
    graph.edges.push_back({nodeIndex(w[kEdgeTarget] & ~kEdgeRecursive), w[kEdgeMultiplicity], w[kEdgeShapes]});
  }
  graph.parameters.reserve(counts[kSectionParameters]);
  for (uint32_t i = 0; i < counts[kSectionParameters]; ++i) {
    const uint32_t* w = entry(kSectionParameters, i);
    graph.parameters.push_back({w[0], hasProgram(w[0]) ? indexOf(kSectionCode, w[1], 0) : w[1]});
  }
  graph.code.assign(entry(kSectionCode, 0), entry(kSectionCode, counts[kSectionCode]));
  for (uint32_t i = 0; i < counts[kSectionPolygons]; ++i) {
    const uint32_t* w = entry(kSectionPolygons, i);
    graph.polygons.push_back({indexOf(kSectionVertices, w[0], 0), w[1], indexOf(kSectionQuads, w[2], 1), w[3]});
  }
  graph.vertices.resize(size_t(counts[kSectionVertices]) * 2);
  if (!graph.vertices.empty())
    std::memcpy(graph.vertices.data(), entry(kSectionVertices, 0), graph.vertices.size() * 4);
  graph.quads.assign(entry(kSectionQuads, 0), entry(kSectionQuads, counts[kSectionQuads]));
  for (uint32_t i = 0; i < counts[kSectionTerminals]; ++i) {
    const uint32_t* w = entry(kSectionTerminals, i);
    graph.terminals.push_back({w[0], w[1], w[2], w[3]});
  }
  for (uint32_t i = 0; i < counts[kSectionRules]; ++i) {
    const uint32_t* w = entry(kSectionRules, i);
    graph.rules.push_back({w[0], nodeIndex(w[1]), indexOf(kSectionAxioms, w[2], 0)});
  }
  for (uint32_t i = 0; i < counts[kSectionAxioms]; ++i) {
    const uint32_t* w = entry(kSectionAxioms, i);
    graph.axioms.push_back({w[0], nodeIndex(w[1]), w[2] & 0xffu, w[2] >> 8});
  }
  graph.fields.assign(entry(kSectionFields, 0), entry(kSectionFields, counts[kSectionFields]));
  graph.names.resize(size_t(counts[kSectionNames]) * 4);
  if (!graph.names.empty()) std::memcpy(graph.names.data(), entry(kSectionNames, 0), graph.names.size());
  if (auto ok = validate(graph); !ok) return ok.error();
  // What follows from the rest is worked out again rather than believed: the interpreter reads it from the words.
  analyse(graph);
  if (graph.phases == kNoPhases) return bad("its IfCollides wait for colliders that come after them");
  if (serialize(graph, memory) != words) return bad("it does not follow from its own nodes and edges");
  return graph;
}

} // namespace gpgp::spawn
