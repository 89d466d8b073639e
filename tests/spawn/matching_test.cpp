// Execution group matching: a member is its class's representative with the member's row substituted.
#include "graphs.h"
#include "spawn/graph/heuristics.h"
#include "spawn/graph/matching.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <map>

namespace {
using namespace gpgp;
using namespace gpgp::spawn;
using namespace gpgp::test;

std::vector<uint32_t> program(const Graph& graph, uint32_t at) {
  std::vector<uint32_t> words;
  while (graph.code[at] != shader::kCodeEnd) {
    if (graph.code[at] == shader::kCodeNumber) words.push_back(graph.code[at++]);
    words.push_back(graph.code[at++]);
  }
  return words;
}

/// All that a node says, with edges as positions in the group or as groups.
struct Content {
  uint32_t op, argument, argument2;
  std::vector<uint32_t> constants; // by parameter; else 0
  std::vector<uint32_t> kinds;
  std::vector<std::vector<uint32_t>> programs;
  std::vector<std::pair<char, uint32_t>> edges;
  bool operator==(const Content&) const = default;
};

std::vector<Content> contentOf(const Graph& graph, const Partition& partition, const Group& group) {
  std::vector<Content> result;
  for (const uint32_t n : group.nodes) {
    const Node& node = graph.nodes[n];
    Content c{node.op, node.argument, node.argument2, {}, {}, {}, {}};
    for (uint32_t p = 0; p < node.parameterCount; ++p) {
      const Parameter& parameter = graph.parameters[node.firstParameter + p];
      const bool isProgram = parameter.kind == shader::kParameterProgram;
      c.kinds.push_back(parameter.kind);
      c.constants.push_back(isProgram ? 0 : parameter.value);
      c.programs.push_back(isProgram ? program(graph, parameter.value) : std::vector<uint32_t>{});
    }
    for (uint32_t e = 0; e < node.edgeCount; ++e) {
      const uint32_t target = graph.edges[node.firstEdge + e].target;
      if (target == kNoNode)
        c.edges.emplace_back('-', 0);
      else if (partition.isRoot(target))
        c.edges.emplace_back('d', partition.groupOf[target]);
      else
        c.edges.emplace_back('s', std::find(group.nodes.begin(), group.nodes.end(), target) - group.nodes.begin());
    }
    result.push_back(c);
  }
  return result;
}

void substitute(std::vector<Content>& content, const GroupClass& c, size_t row) {
  for (size_t s = 0; s < c.slots.size(); ++s) {
    const Slot& slot = c.slots[s];
    Content& node = content.at(slot.position);
    const uint32_t value = c.value(row, s);
    switch (slot.kind) {
    case SlotKind::argument: node.argument = value; break;
    case SlotKind::argument2: node.argument2 = value; break;
    case SlotKind::constant: node.constants.at(slot.index) = value; break;
    case SlotKind::number: node.programs.at(slot.index).at(slot.word) = value; break;
    case SlotKind::target: node.edges.at(slot.index).second = value; break;
    }
  }
}

/// Operator homomorphism by walking both groups at once from their roots.
bool matches(const Graph& graph, const Partition& partition, const Group& a, const Group& b) {
  std::map<uint32_t, uint32_t> to, from;
  const std::function<bool(uint32_t, uint32_t)> walk = [&](uint32_t m, uint32_t n) -> bool {
    const auto [forward, isNew] = to.try_emplace(m, n);
    if (forward->second != n || from.try_emplace(n, m).first->second != m) return false;
    if (!isNew) return true;
    const Node &x = graph.nodes[m], &y = graph.nodes[n];
    if (x.op != y.op || x.edgeCount != y.edgeCount || x.parameterCount != y.parameterCount) return false;
    for (uint32_t p = 0; p < x.parameterCount; ++p) {
      const Parameter &u = graph.parameters[x.firstParameter + p], &v = graph.parameters[y.firstParameter + p];
      if (u.kind != v.kind || (u.kind == shader::kParameterAttribute && u.value != v.value)) return false;
      if (u.kind != shader::kParameterProgram) continue;
      auto left = program(graph, u.value), right = program(graph, v.value);
      if (left.size() != right.size()) return false;
      for (size_t w = 0; w < left.size(); ++w) {
        const bool number = w > 0 && left[w - 1] == shader::kCodeNumber && right[w - 1] == shader::kCodeNumber;
        if (number)
          left[w] = right[w] = UINT32_MAX; // not taken for a code itself
        else if (left[w] != right[w])
          return false;
      }
    }
    for (uint32_t e = 0; e < x.edgeCount; ++e) {
      const uint32_t s = graph.edges[x.firstEdge + e].target, t = graph.edges[y.firstEdge + e].target;
      if ((s == kNoNode) != (t == kNoNode)) return false;
      if (s == kNoNode) continue;
      if (partition.isRoot(s) != partition.isRoot(t)) return false;
      if (!partition.isRoot(s) && !walk(s, t)) return false;
    }
    return true;
  };
  return a.nodes.size() == b.nodes.size() && walk(a.root, b.root) && to.size() == a.nodes.size();
}

TEST(Matching, OnlyWhatDiffersIsInTheTable) {
  const Graph graph = ofRules("A = If(ShapeSeed() < 0.5) { Translate(1,Exp(ShapeSize(X)*2),3) Scale(1,1,1) T |"
                              " Translate(4,Exp(ShapeSize(X)*5),3) Scale(1,1,1) U };");
  const Flow flow = makeFlow(graph);
  const Partition partition = makePartition(flow, heuristicPartition(graph, flow));
  ASSERT_EQ(partition.groups.size(), 3u); // If, and one for each sequence
  const Matching matching = matchGroups(graph, partition);
  ASSERT_EQ(matching.classes.size(), 2u);
  const GroupClass& c = matching.classes[1];
  EXPECT_EQ(c.members, (std::vector<uint32_t>{1, 2}));
  const std::vector<Slot> expected{
      {0, SlotKind::constant, 0, 0}, {0, SlotKind::number, 1, 2}, {2, SlotKind::argument}, {2, SlotKind::argument2}};
  EXPECT_EQ(c.slots, expected);
  const auto bits = [](float f) { return std::bit_cast<uint32_t>(f); };
  EXPECT_EQ(c.table, (std::vector<uint32_t>{bits(1), bits(2), 0, 0, bits(4), bits(5), 1, 1}));
  EXPECT_EQ(matchGroups(graph, partition, false).classes.size(), 3u);
}

TEST(Matching, OtherOperatorsAttributesAndEdgesDoNotMatch) {
  const auto classes = [](const std::string& left, const std::string& right) {
    const Graph graph = ofRules("A = If(ShapeSeed() < 0.5) { " + left + " | " + right + " };");
    const Flow flow = makeFlow(graph);
    return matchGroups(graph, makePartition(flow, heuristicPartition(graph, flow, {true, true, 2}))).classes.size();
  };
  EXPECT_EQ(classes("Translate(1,0,0) T", "Translate(0,1,0) U"), 2u);
  EXPECT_EQ(classes("Translate(1,0,0) T", "Rotate(0,1,0) U"), 3u);
  EXPECT_EQ(classes("Extrude(1) T", "Extrude(ShapeSize(X)) U"), 3u);
  EXPECT_EQ(classes("Extrude(ShapeSize(Y)) T", "Extrude(ShapeSize(X)) U"), 3u);
  EXPECT_EQ(classes("SubDiv(X) { 1: T | 2: Discard() }", "SubDiv(Y) { 1: U | 3: Discard() }"), 2u);
  EXPECT_EQ(classes("SubDiv(X) { 1: T | 2: Discard() }", "SubDiv(Y) { 1: Discard() | 3: U }"), 3u);
}

TEST(Matching, SpongeRewritingNeedsFourPrograms) {
  const Graph graph = compiled(kSponge);
  const Flow flow = makeFlow(graph);
  const Partition partition = makePartition(flow, singleGroups(flow));
  // IfSizeLess, the terminal, SubDivs with three children, SubDivs whose middle part is discarded
  EXPECT_EQ(matchGroups(graph, partition).classes.size(), 4u);
}

TEST(Matching, SubstitutionGivesEveryMemberOfRandomGrammars) {
  uint64_t shared = 0, pairs = 0;
  for (uint32_t seed = 0; seed < 10000 && !testing::Test::HasFailure(); ++seed) {
    const Graph graph = compiled(randomGrammar(seed));
    const Flow flow = makeFlow(graph);
    std::mt19937 random(seed);
    for (const Roots& roots : {singleGroups(flow), heuristicPartition(graph, flow), randomPartition(flow, random)}) {
      const Partition partition = makePartition(flow, roots);
      const Matching matching = matchGroups(graph, partition);
      size_t members = 0;
      for (size_t number = 0; number < matching.classes.size(); ++number) {
        const GroupClass& c = matching.classes[number];
        const auto first = contentOf(graph, partition, partition.groups[c.representative()]);
        for (size_t row = 0; row < c.members.size(); ++row) {
          const uint32_t member = c.members[row];
          auto content = first;
          substitute(content, c, row);
          EXPECT_EQ(content, contentOf(graph, partition, partition.groups[member])) << seed;
          EXPECT_EQ(matching.classOf[member], number);
          EXPECT_EQ(matching.rowOf[member], row);
          shared += row > 0;
          ++members;
        }
        for (size_t s = 0; s < c.slots.size(); ++s) { // none that all share
          bool differs = false;
          for (size_t row = 1; row < c.members.size(); ++row) differs |= c.value(row, s) != c.value(0, s);
          EXPECT_TRUE(differs) << seed;
        }
      }
      EXPECT_EQ(members, partition.groups.size());
      for (size_t a = 0; seed % 10 == 0 && a < partition.groups.size(); ++a)
        for (size_t b = 0; b < a; ++b, ++pairs) // all that match are in one class, and no others
          EXPECT_EQ(matching.classOf[a] == matching.classOf[b],
                    matches(graph, partition, partition.groups[a], partition.groups[b]))
              << seed << ": " << a << ", " << b;
    }
  }
  EXPECT_GT(shared, 10000u);
  EXPECT_GT(pairs, 10000u);
}

} // namespace
