#include "spawn/graph/matching.h"

#include <map>

namespace gpgp::spawn {
namespace {
using namespace shader;

/// A group as words: what its code must be made of, and the values that a table could hold as well.
struct Description {
  std::vector<uint32_t> structure;
  std::vector<uint32_t> values;
  std::vector<Slot> slots; // one for each value; follows from structure
};

class Describer {
public:
  Describer(const Graph& graph, const Partition& partition) : graph_(graph), partition_(partition) {}

  Description run(const Group& group) {
    d_ = {};
    std::map<uint32_t, uint32_t> positions;
    for (uint32_t i = 0; i < group.nodes.size(); ++i) positions[group.nodes[i]] = i;
    for (uint32_t i = 0; i < group.nodes.size(); ++i) {
      const Node& node = graph_.nodes[group.nodes[i]];
      d_.structure.insert(d_.structure.end(), {node.op, node.parameterCount, node.edgeCount});
      value({i, SlotKind::argument}, node.argument);
      value({i, SlotKind::argument2}, node.argument2);
      for (uint32_t p = 0; p < node.parameterCount; ++p) parameter(i, p, graph_.parameters[node.firstParameter + p]);
      for (uint32_t e = 0; e < node.edgeCount; ++e) {
        const uint32_t target = graph_.edges[node.firstEdge + e].target;
        if (target == kNoNode) {
          d_.structure.push_back(kDiscarded);
        } else if (partition_.isRoot(target)) {
          d_.structure.push_back(kDynamic);
          value({i, SlotKind::target, e}, partition_.groupOf[target]);
        } else {
          d_.structure.push_back(positions.at(target));
        }
      }
    }
    return std::move(d_);
  }

private:
  static constexpr uint32_t kDiscarded = UINT32_MAX, kDynamic = UINT32_MAX - 1;

  void value(Slot slot, uint32_t word) {
    d_.slots.push_back(slot);
    d_.values.push_back(word);
  }
  void parameter(uint32_t position, uint32_t index, const Parameter& p) {
    d_.structure.push_back(p.kind);
    if (p.kind == kParameterConstant) value({position, SlotKind::constant, index}, p.value);
    if (p.kind == kParameterAttribute) d_.structure.push_back(p.value);
    if (!hasProgram(p.kind)) return;
    for (uint32_t word = 0;; ++word) {
      const uint32_t code = graph_.code[p.value + word];
      d_.structure.push_back(code);
      if (code == kCodeEnd) return;
      if (code == kCodeNumber) {
        ++word;
        value({position, SlotKind::number, index, word}, graph_.code[p.value + word]);
      }
    }
  }

  const Graph& graph_;
  const Partition& partition_;
  Description d_;
};

GroupClass classOf(const Graph& graph, const Partition& partition, const std::vector<uint32_t>& members,
                   const std::vector<Description>& descriptions) {
  GroupClass result;
  result.members = members;
  const Description& first = descriptions[members[0]];
  std::vector<size_t> differing;
  for (size_t v = 0; v < first.values.size(); ++v)
    for (const uint32_t member : members)
      if (descriptions[member].values[v] != first.values[v]) {
        differing.push_back(v);
        result.slots.push_back(first.slots[v]);
        break;
      }
  for (const uint32_t member : members) {
    for (const size_t v : differing) result.table.push_back(descriptions[member].values[v]);
    const auto& nodes = partition.groups[member].nodes;
    result.shapes.resize(nodes.size());
    for (size_t i = 0; i < nodes.size(); ++i) result.shapes[i] |= graph.nodes[nodes[i]].shapes;
  }
  return result;
}
} // namespace

Matching matchGroups(const Graph& graph, const Partition& partition, bool match) {
  const size_t groups = partition.groups.size();
  Matching matching;
  matching.classOf.resize(groups);
  matching.rowOf.resize(groups);
  Describer describer(graph, partition);
  std::vector<Description> descriptions;
  std::vector<std::vector<uint32_t>> members;
  std::map<std::vector<uint32_t>, uint32_t> known; // structure to class
  for (uint32_t g = 0; g < groups; ++g) {
    descriptions.push_back(describer.run(partition.groups[g]));
    uint32_t number = static_cast<uint32_t>(members.size());
    if (match) number = known.try_emplace(descriptions[g].structure, number).first->second;
    if (number == members.size()) members.emplace_back();
    matching.classOf[g] = number;
    matching.rowOf[g] = static_cast<uint32_t>(members[number].size());
    members[number].push_back(g);
  }
  for (const auto& list : members) matching.classes.push_back(classOf(graph, partition, list, descriptions));
  return matching;
}

} // namespace gpgp::spawn
