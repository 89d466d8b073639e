// Partitions of the operator graph into execution groups (thesis 4.2.2): which edges are static, which dynamic.
//
// A shape takes a static edge inside the invocation that it is in, and a dynamic edge through a queue. All edges within
// a group are static but those that lead back to its root; all others are dynamic. So the edges into a node are static
// all or none, and a partition is decided by its roots: a node that is no root belongs to the group that all of its
// edges come from.
//
// What counts as V and E: operators and terminals that can be reached from the starts (the axiom's node, unless others
// are given). Discard is no node, as it folds into its parent, and neither is the source of the axioms, which always
// arrive through a queue. Edges are counted one by one, also where several join the same two nodes: the Menger sponge
// has 7 nodes, 17 edges (two lead to Discard) and 40 valid partitions.
#pragma once
#include "spawn/graph/graph.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gpgp::spawn {

constexpr uint32_t kNoGroup = UINT32_MAX;
constexpr uint32_t kNoEdge = UINT32_MAX;

/// All shapes must be through source before target runs (D of the thesis). Never from a node to itself.
struct Dependency {
  uint32_t source = 0, target = 0;
};

/// An edge with its ends. Leads nowhere where target is kNoNode.
struct Link {
  uint32_t edge = kNoEdge; ///< in Graph::edges
  uint32_t source = kNoNode, slot = 0, target = kNoNode;
  uint32_t multiplicity = 0;

  bool operator==(const Link&) const = default;
};

/// What all partitions of a graph have in common. Vectors are by node unless said otherwise.
struct Flow {
  std::vector<uint32_t> starts;          ///< nodes where axioms arrive, each once
  std::vector<uint32_t> order;           ///< the nodes that can be reached; sources come before targets but in cycles
  std::vector<uint32_t> rank;            ///< place in order, kNoNode where not reachable
  std::vector<std::vector<Link>> in;     ///< from reachable nodes
  std::vector<std::vector<Link>> out;    ///< without Discard
  std::vector<uint8_t> mustRoot;         ///< starts and where cycles close: roots in every valid partition
  std::vector<std::vector<uint32_t>> at; ///< the other ends of dependencies
  std::vector<Dependency> dependencies;
};

/// What Collider and IfCollides mean: each IfCollides depends on all Colliders with its tag.
std::vector<Dependency> dependenciesOf(const Graph& graph);

/// starts: as nodes, kNoNode is left out; none: the axiom's node. Give the nodes of further rules where axioms may
/// start with them. dependencies: besides the graph's own.
Flow makeFlow(const Graph& graph, std::span<const uint32_t> starts = {}, std::span<const Dependency> dependencies = {});

/// A group runs from its root, once for each shape in the root's queue.
struct Group {
  uint32_t root = kNoNode;
  std::vector<uint32_t> nodes;    ///< root first, then so that static edges lead forward; decided by structure alone
  std::vector<Link> staticEdges;  ///< within the group, in the order of nodes and slots
  std::vector<Link> dynamicEdges; ///< to roots, its own included, in the order of nodes and slots

  bool operator==(const Group&) const = default;
};

struct Partition {
  std::vector<uint32_t> groupOf; ///< by node; kNoGroup where not reachable
  std::vector<Group> groups;     ///< in the order of Flow

  bool isRoot(uint32_t node) const { return groupOf[node] != kNoGroup && groups[groupOf[node]].root == node; }
  bool operator==(const Partition&) const = default;
};

/// By node: the root of its group, kNoNode where not reachable. The short form of a partition, which searches work on.
using Roots = std::vector<uint32_t>;

/// Every node its own group: the finest partition.
Roots singleGroups(const Flow& flow);
/// May a root, with its whole group, become part of the one group that its edges come from? Keeps valid what is valid.
bool canJoin(const Flow& flow, const Roots& roots, uint32_t root);
/// Does it. Only where canJoin().
void join(const Flow& flow, Roots& roots, uint32_t root);

size_t groupCount(const Flow& flow, const Roots& roots);
/// The partition of valid roots.
Partition makePartition(const Flow& flow, const Roots& roots);

/// The first of the conditions 1 to 4 that does not hold, with the node in whose group that is.
struct Violation {
  uint32_t condition = 0, node = kNoNode;
  std::string text;
};
/// Checks any partition of the reachable nodes, given by group numbers, against the conditions as they are written.
std::optional<Violation> violation(const Flow& flow, std::span<const uint32_t> groupOf);
/// The partition of any valid group numbers; their order is lost.
Partition partitionOfGroups(const Flow& flow, std::span<const uint32_t> groupOf);

/// May a node belong to the group that its edges come from? With all nodes before its place in the order decided.
bool mayBelong(const Flow& flow, const Roots& roots, size_t place);

/// All valid partitions, one after the other, each once: where there are no dependencies the coarsest first; the finest
/// last. The time for each is at most linear in the graph.
class PartitionEnumerator {
public:
  explicit PartitionEnumerator(const Flow& flow);
  const Roots& roots() const { return roots_; }
  /// To the next one; false where there was no other.
  bool next();

private:
  void fill(size_t from);
  const Flow& flow_;
  Roots roots_;
};
/// How many valid partitions there are, counted up to a limit.
uint64_t countPartitions(const Flow& flow, uint64_t limit);

} // namespace gpgp::spawn
