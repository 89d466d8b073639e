// Partitions of the operator graph: the conditions of thesis 4.2.2 against brute force, and published counts.
#include "graphs.h"
#include "spawn/graph/partition.h"

#include <gtest/gtest.h>

#include <functional>
#include <numeric>
#include <set>

namespace {
using namespace gpgp;
using namespace gpgp::spawn;
using namespace gpgp::test;

/// Groups numbered by their first node, so that equal partitions are equal vectors.
std::vector<uint32_t> canonical(const std::vector<uint32_t>& groupOf) {
  std::vector<uint32_t> result(groupOf.size(), kNoGroup);
  for (size_t i = 0; i < groupOf.size(); ++i)
    for (size_t j = 0; j <= i && groupOf[i] != kNoGroup; ++j)
      if (groupOf[j] == groupOf[i]) {
        result[i] = static_cast<uint32_t>(j);
        break;
      }
  return result;
}

using Partitions = std::set<std::vector<uint32_t>>;

Partitions enumerated(const Flow& flow) {
  Partitions found;
  PartitionEnumerator all(flow);
  do {
    EXPECT_TRUE(found.insert(canonical(all.roots())).second) << "a partition came twice";
  } while (all.next());
  return found;
}

/// Every way to put the nodes into groups, sieved by the conditions.
Partitions sieved(const Flow& flow) {
  Partitions found;
  std::vector<uint32_t> groupOf(flow.rank.size(), kNoGroup);
  const std::function<void(size_t, uint32_t)> place = [&](size_t index, uint32_t groups) {
    if (index == flow.order.size()) {
      if (!violation(flow, groupOf)) found.insert(canonical(groupOf));
      return;
    }
    for (uint32_t g = 0; g <= groups; ++g) {
      groupOf[flow.order[index]] = g;
      place(index + 1, std::max(groups, g + 1));
    }
  };
  place(0, 0);
  return found;
}

TEST(Partition, TheMengerSpongeHasFortySchedules) {
  std::vector<std::string> texts{kSponge};
  if (const auto published = sharedGrammar("menger_sponge_3.pga")) texts.push_back(*published);
  for (const std::string& text : texts) {
    const Graph graph = compiled(text);
    EXPECT_EQ(graph.edges.size(), 17u); // thesis, table 4.2
    const Flow flow = makeFlow(graph);
    EXPECT_EQ(flow.order.size(), 7u);
    EXPECT_EQ(countPartitions(flow, 1000), 40u); // thesis, figure 4.7
    EXPECT_EQ(sieved(flow).size(), 40u);
    EXPECT_EQ(enumerated(flow), sieved(flow));
    EXPECT_EQ(countPartitions(flow, 12), 12u);
  }
}

// The thesis keeps a bit for each edge. Groups are what static edges connect; an edge within a group is dynamic where
// it leads to the root, and only there.
TEST(Partition, BitsForEdgesGiveTheSameForty) {
  const Graph graph = compiled(kSponge);
  const Flow flow = makeFlow(graph);
  std::vector<Link> links;
  for (const uint32_t n : flow.order) links.insert(links.end(), flow.out[n].begin(), flow.out[n].end());
  ASSERT_EQ(links.size(), 15u); // 17 without the two to Discard
  Partitions found;
  for (uint32_t bits = 0; bits < 1u << links.size(); ++bits) {
    std::vector<uint32_t> groupOf(graph.nodes.size());
    std::iota(groupOf.begin(), groupOf.end(), 0u);
    for (size_t i = 0; i < links.size(); ++i)
      if (bits >> i & 1) {
        const uint32_t from = groupOf[links[i].target], to = groupOf[links[i].source];
        std::replace(groupOf.begin(), groupOf.end(), from, to);
      }
    if (violation(flow, groupOf)) continue;
    const Partition partition = partitionOfGroups(flow, groupOf);
    bool agrees = true;
    for (size_t i = 0; i < links.size(); ++i) agrees &= ((bits >> i & 1) != 0) != partition.isRoot(links[i].target);
    if (agrees) {
      EXPECT_TRUE(found.insert(canonical(groupOf)).second);
    }
  }
  EXPECT_EQ(found.size(), 40u);
}

struct Bad {
  std::vector<uint32_t> groupOf;
  uint32_t condition;
};

TEST(Partition, EachConditionIsNamed) {
  // 0 SubDiv -> 1 Translate -> 2 If -> 3 T, 4 Scale -> 2; 0 -> 5 Rotate -> 6 U
  const Graph graph = ofRules("A = SubDiv(X) { -1: Translate(1,0,0) B | -1: Rotate(0,1,0) U };"
                              "B = If(ShapeSize(X) < 1) { T | Scale(-0.5,1,1) B };");
  const Flow flow = makeFlow(graph);
  ASSERT_EQ(flow.order.size(), 7u);
  const auto node = [&](uint32_t op) {
    for (uint32_t n = 0; n < graph.nodes.size(); ++n)
      if (graph.nodes[n].op == op) return n;
    return kNoNode;
  };
  const uint32_t a = node(shader::kOpSubDiv), b = node(shader::kOpTranslate), c = node(shader::kOpIf),
                 s = node(shader::kOpScale), r = node(shader::kOpRotate);
  const auto grouped = [&](std::vector<std::vector<uint32_t>> groups) {
    std::vector<uint32_t> groupOf(graph.nodes.size());
    std::iota(groupOf.begin(), groupOf.end(), 100u);
    for (uint32_t g = 0; g < groups.size(); ++g)
      for (const uint32_t n : groups[g]) groupOf[n] = g;
    return groupOf;
  };
  const auto conditionOf = [&](const std::vector<uint32_t>& groupOf, std::span<const Dependency> dependencies = {}) {
    const auto found = violation(makeFlow(graph, {}, dependencies), groupOf);
    return found ? static_cast<int>(found->condition) : -1;
  };
  EXPECT_EQ(conditionOf(grouped({})), -1);
  EXPECT_EQ(conditionOf(grouped({{a, b, r}, {c, s}})), -1); // the cycle passes the root
  EXPECT_EQ(conditionOf(grouped({{b, r}})), 1);
  EXPECT_EQ(conditionOf(grouped({{b, c}})), 1);    // c is entered from b and from s
  EXPECT_EQ(conditionOf(grouped({{b, c, s}})), 3); // the cycle of c and s does not pass b
  const std::vector<Dependency> depends{{s, c}};
  EXPECT_EQ(conditionOf(grouped({{c, s}}), depends), 4);
  EXPECT_EQ(conditionOf(grouped({}), depends), -1);
  std::vector<uint32_t> missing = grouped({});
  missing[b] = kNoGroup;
  EXPECT_EQ(conditionOf(missing), 0);
}

TEST(Partition, EnumerationFindsAllOfSmallGraphs) {
  uint32_t compared = 0;
  uint64_t partitions = 0;
  for (uint32_t seed = 0; seed < 1500; ++seed) {
    const Graph graph = compiled(randomGrammar(seed));
    const std::vector<uint32_t> none;
    Flow flow = makeFlow(graph);
    if (flow.order.size() > 8 || flow.order.size() < 2) continue;
    // every second one with dependencies
    std::vector<Dependency> dependencies;
    for (uint32_t i = 0; i < (seed & 1) * 2; ++i) {
      const uint32_t s = flow.order[(seed + i) % flow.order.size()], t = flow.order[(seed / 3 + 1) % flow.order.size()];
      if (s != t) dependencies.push_back({s, t});
    }
    flow = makeFlow(graph, none, dependencies);
    const Partitions all = enumerated(flow);
    EXPECT_EQ(all, sieved(flow)) << "seed " << seed;
    partitions += all.size();
    ++compared;
  }
  EXPECT_GT(compared, 200u);
  EXPECT_GT(partitions, 4000u);
}

} // namespace
