// Execution group matching (thesis 4.2.3): groups that differ in parameters only share one piece of code, and what
// differs goes to a parameter table.
//
// Two groups match where a mapping between their nodes keeps operators and edges (operator homomorphism). Ours also
// keeps the order of each node's edges, since a child's number decides its seed and its path key; so there is one such
// mapping at most: the first node to the first, the second to the second, as Group::nodes lists them.
#pragma once
#include "spawn/graph/partition.h"

namespace gpgp::spawn {

enum class SlotKind : uint8_t {
  argument,  ///< Node::argument: an axis, a terminal, a shape type
  argument2, ///< Node::argument2: a mode, a bucket, a polygon
  constant,  ///< a parameter: float bits
  number,    ///< a number within a parameter's program: float bits
  target     ///< the group that a dynamic edge leads to
};

/// A value in a group's code that a table can hold.
struct Slot {
  uint32_t position = 0; ///< in Group::nodes
  SlotKind kind = SlotKind::argument;
  uint32_t index = 0; ///< constant and number: of the node's parameters; target: of the node's edges
  uint32_t word = 0;  ///< number: in the program, counted from its start

  bool operator==(const Slot&) const = default;
};

/// Groups with the same code. What they have in common are constants of that code.
struct GroupClass {
  std::vector<uint32_t> members; ///< as Partition::groups; the first represents all
  std::vector<Slot> slots;       ///< where members differ
  std::vector<uint32_t> table;   ///< a row for each member, a word for each slot
  std::vector<uint32_t> shapes;  ///< by position: the shape types that can arrive in any member, as Node::shapes

  uint32_t representative() const { return members.front(); }
  uint32_t value(size_t row, size_t slot) const { return table[row * slots.size() + slot]; }
};

struct Matching {
  std::vector<GroupClass> classes; ///< in the order of their representatives
  std::vector<uint32_t> classOf;   ///< by group
  std::vector<uint32_t> rowOf;     ///< by group: among the class's members
};

/// match: whether groups may share a class at all; without it each group is a class of its own.
Matching matchGroups(const Graph& graph, const Partition& partition, bool match = true);

} // namespace gpgp::spawn
