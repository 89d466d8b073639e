// Named schedules and heuristics: the thesis's figures 4.9 to 4.11, and properties that must hold for random grammars.
#include "graphs.h"
#include "spawn/graph/heuristics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

namespace {
using namespace gpgp;
using namespace gpgp::spawn;
using namespace gpgp::test;

bool isStatic(const Roots& roots, const Link& link) { return roots[link.target] != link.target; }

TEST(Heuristics, SpongeSchedules) {
  const Graph graph = compiled(kSponge);
  const Flow flow = makeFlow(graph);
  EXPECT_EQ(groupCount(flow, coarsestPartition(flow)), 1u);
  EXPECT_EQ(groupCount(flow, singleGroups(flow)), 7u);
  // Each rule is one operator, which leaves only the terminal to join.
  EXPECT_EQ(groupCount(flow, rulePartition(graph, flow)), 6u);
  const Partition one = makePartition(flow, coarsestPartition(flow));
  EXPECT_EQ(one.groups[0].dynamicEdges.size(), 5u); // three of SubZ and two of ZDiscard close the recursion
  EXPECT_EQ(one.groups[0].staticEdges.size(), 10u);
}

TEST(Heuristics, SequencesAreFused) { // figure 4.9
  const Graph graph = ofRules("A = If(ShapeSeed() < 0.5) { Translate(1,0,0) Rotate(0,1,0) Scale(1,2,3) T | U };");
  const Flow flow = makeFlow(graph);
  const Roots roots = heuristicPartition(graph, flow, {true, true, 0});
  EXPECT_EQ(groupCount(flow, roots), 3u); // If; Translate, Rotate, Scale, T; U
  EXPECT_EQ(roots[nodeOf(graph, shader::kOpScale)], nodeOf(graph, shader::kOpTranslate));
}

TEST(Heuristics, ASequenceIsCutWhereItDependsOnItself) {
  const Graph graph = ofRules("A = Translate(1,0,0) Rotate(0,1,0) Scale(1,2,3) T;");
  const uint32_t translate = nodeOf(graph, shader::kOpTranslate), scale = nodeOf(graph, shader::kOpScale);
  const std::vector<Dependency> dependencies{{translate, scale}};
  const Flow flow = makeFlow(graph, {}, dependencies);
  const Roots roots = heuristicPartition(graph, flow, {true, true, 0});
  EXPECT_EQ(roots[nodeOf(graph, shader::kOpRotate)], translate);
  EXPECT_EQ(roots[scale], scale); // the last edge of the sequence is the one that is rejected
  EXPECT_FALSE(violation(flow, roots));
}

TEST(Heuristics, BranchesAreDynamic) { // figure 4.10
  const Graph graph = ofRules("A = RandomRule(ShapeSeed()) { 0.5: Translate(1,0,0) T | 0.5: Rotate(0,1,0) U };");
  const Flow flow = makeFlow(graph);
  EXPECT_EQ(divergentEdges(graph, flow).size(), 2u);
  EXPECT_EQ(groupCount(flow, heuristicPartition(graph, flow)), 3u);
  EXPECT_EQ(groupCount(flow, coarsestPartition(flow)), 1u);
}

TEST(Heuristics, SmallGroupsGrow) { // figure 4.11
  const Graph graph = ofRules("A = SubDiv(X) { -1: Extrude(1) B | -1: Translate(1,0,0) B | -1: Scale(1,1,1) B };"
                              "B = Repeat(X, 1, ADJUST_TO_FILL) T;");
  const Flow flow = makeFlow(graph);
  const uint32_t repeat = nodeOf(graph, shader::kOpRepeat);
  // Repeat's edge may be taken any number of times, so it stays dynamic; t is reached without it.
  const Roots five = heuristicPartition(graph, flow, {true, true, 5});
  EXPECT_EQ(groupCount(flow, five), 2u);
  EXPECT_EQ(five[repeat], flow.order[0]);
  const Roots off = heuristicPartition(graph, flow, {true, true, 0});
  EXPECT_EQ(groupCount(flow, off), 6u);
  const Roots two = heuristicPartition(graph, flow, {true, true, 2});
  EXPECT_EQ(groupCount(flow, two), 2u); // each small group joins, Repeat once its three sources are in one group
}

TEST(Heuristics, ExtentsDecideHowUsualAnEdgeIs) {
  const Graph graph =
      ofRules("A = SubDiv(X) { 1: T | 0: U | ShapeSize(Y): B | Rand(1,2): B }; B = CompSplit() { T | T | U };");
  const Flow flow = makeFlow(graph);
  const auto& links = flow.out[nodeOf(graph, shader::kOpSubDiv)];
  std::vector<uint32_t> found;
  for (const Link& link : links) found.push_back(usualMultiplicity(graph, link));
  EXPECT_EQ(found, (std::vector<uint32_t>{shader::kMultiplicityOne, shader::kMultiplicityOptional,
                                          shader::kMultiplicityOptional, shader::kMultiplicityOptional}));
}

/// By node: which rules' nodes lead to it without passing another rule's node.
std::map<uint32_t, std::set<uint32_t>> rulesOf(const Graph& graph, const Flow& flow) {
  std::set<uint32_t> heads(flow.starts.begin(), flow.starts.end());
  for (const Rule& rule : graph.rules)
    if (rule.node != kNoNode && flow.rank[rule.node] != kNoNode) heads.insert(rule.node);
  std::map<uint32_t, std::set<uint32_t>> result;
  for (const uint32_t head : heads) {
    const std::function<void(uint32_t)> walk = [&](uint32_t n) {
      if (!result[n].insert(head).second) return;
      for (const Link& link : flow.out[n])
        if (!heads.count(link.target)) walk(link.target);
    };
    walk(head);
  }
  return result;
}

void expectValid(const Flow& flow, const Roots& roots, const char* schedule, uint32_t seed) {
  const auto found = violation(flow, roots);
  EXPECT_FALSE(found) << schedule << " of grammar " << seed << ": condition " << found->condition << ", "
                      << found->text;
}

void expectDescribes(const Flow& flow, const Roots& roots, uint32_t seed) {
  const Partition partition = makePartition(flow, roots);
  EXPECT_EQ(partition, partitionOfGroups(flow, roots)) << seed;
  size_t nodes = 0, edges = 0, all = 0;
  for (const uint32_t n : flow.order) all += flow.out[n].size();
  for (const Group& group : partition.groups) {
    ASSERT_EQ(group.nodes.at(0), group.root);
    const auto place = [&](uint32_t n) { return std::find(group.nodes.begin(), group.nodes.end(), n); };
    for (const Link& link : group.staticEdges)
      EXPECT_TRUE(place(link.source) < place(link.target) && place(link.target) != group.nodes.end()) << seed;
    for (const Link& link : group.dynamicEdges)
      EXPECT_TRUE(place(link.source) != group.nodes.end() && partition.isRoot(link.target)) << seed;
    nodes += group.nodes.size();
    edges += group.staticEdges.size() + group.dynamicEdges.size();
  }
  EXPECT_EQ(nodes, flow.order.size());
  EXPECT_EQ(edges, all);
}

/// Of all valid partitions, where those are few: false where they are not.
bool expectFewest(const Flow& flow, const Roots& coarsest, uint32_t seed) {
  constexpr uint64_t kMost = 3000;
  if (countPartitions(flow, kMost) == kMost) return false;
  size_t fewest = SIZE_MAX;
  PartitionEnumerator all(flow);
  do {
    fewest = std::min(fewest, groupCount(flow, all.roots()));
  } while (all.next());
  EXPECT_EQ(groupCount(flow, coarsest), fewest) << seed;
  return true;
}

TEST(Heuristics, TheCoarsestPartitionDependsOnWhatIsCut) {
  // To cut at the collider leaves two groups; to cut where shapes wait for it, one for each such place.
  const Graph graph = compiled("axiom Box A; terminal T U K (1,0);\n"
                               "A = Replicate() { Scale(2,2,2) Collider(w) K | IfCollides(w) { T | U } |\n"
                               "  Translate(10,0,0) IfCollides(w) { T | U } |\n"
                               "  Repeat(X, 0.1, ADJUST_TO_FILL) IfCollides(w) { T | U } };");
  const Flow flow = makeFlow(graph);
  EXPECT_EQ(groupCount(flow, PartitionEnumerator(flow).roots()), 6u);
  EXPECT_EQ(groupCount(flow, coarsestPartition(flow)), 2u);
}

TEST(Heuristics, SchedulesOfTenThousandRandomGrammars) {
  uint64_t enumeratedGraphs = 0, colliding = 0, fused = 0;
  for (uint32_t seed = 0; seed < 10000 && !testing::Test::HasFailure(); ++seed) {
    const Graph graph = compiled(randomGrammar(seed));
    const Flow flow = makeFlow(graph);
    std::mt19937 random(seed);
    const Roots coarsest = coarsestPartition(flow), finest = singleGroups(flow), rules = rulePartition(graph, flow),
                heuristic = heuristicPartition(graph, flow);
    expectValid(flow, coarsest, "SGL", seed);
    expectValid(flow, finest, "RW", seed);
    expectValid(flow, rules, "DGN", seed);
    expectValid(flow, heuristic, "H", seed);
    expectDescribes(flow, heuristic, seed);
    expectDescribes(flow, coarsest, seed);
    colliding += expectFewest(flow, coarsest, seed) && !flow.dependencies.empty();
    if (!flow.dependencies.empty()) continue; // then others are not parts of the coarsest one
    // Random ones, and every partition splits the coarsest one's groups further.
    std::vector<Roots> others{finest, rules, heuristic};
    for (int i = 0; i < 4; ++i) others.push_back(randomPartition(flow, random));
    others.push_back(heuristicPartition(graph, flow, {true, true, 1 + seed % 9}, &random));
    for (const Roots& roots : others) {
      expectValid(flow, roots, "a random partition", seed);
      for (const uint32_t n : flow.order) ASSERT_EQ(coarsest[n], coarsest[roots[n]]) << seed;
    }
    enumeratedGraphs += countPartitions(flow, 400) < 400;
    // DGN: what one rule alone leads to is in the rule's group
    for (const auto& [node, owners] : rulesOf(graph, flow)) {
      if (owners.size() == 1) {
        EXPECT_EQ(rules[node], *owners.begin()) << seed;
      } else {
        EXPECT_EQ(rules[node], node) << seed;
      }
    }
    // The heuristics have done all that they can
    std::map<uint32_t, size_t> size;
    for (const uint32_t n : flow.order) ++size[heuristic[n]];
    std::set<uint32_t> divergent, sequence;
    for (const Link& link : sequenceEdges(graph, flow)) {
      EXPECT_TRUE(isStatic(heuristic, link) || !canJoin(flow, heuristic, link.target)) << seed;
      fused += isStatic(heuristic, link);
      sequence.insert(link.target);
    }
    for (const Link& link : divergentEdges(graph, flow)) {
      EXPECT_TRUE(!isStatic(heuristic, link) || sequence.count(link.target)) << seed;
      divergent.insert(link.target);
    }
    for (const Link& link : constantEdges(graph, flow))
      EXPECT_TRUE(isStatic(heuristic, link) || divergent.count(link.target) ||
                  std::min(size[heuristic[link.source]], size[heuristic[link.target]]) >= 5 ||
                  !canJoin(flow, heuristic, link.target))
          << seed;
  }
  EXPECT_GT(enumeratedGraphs, 4000u);
  EXPECT_GT(colliding, 50u);
  EXPECT_GT(fused, 10000u);
}

TEST(Heuristics, DependenciesKeepSchedulesValid) {
  uint32_t cut = 0, compared = 0;
  for (uint32_t seed = 0; seed < 2000; ++seed) {
    const Graph graph = compiled(randomGrammar(seed));
    std::mt19937 random(seed);
    Flow flow = makeFlow(graph);
    const size_t before = groupCount(flow, coarsestPartition(flow));
    std::vector<Dependency> dependencies;
    for (int i = 0; i < 3; ++i) {
      const uint32_t s = flow.order[random() % flow.order.size()], t = flow.order[random() % flow.order.size()];
      if (s != t) dependencies.push_back({s, t});
    }
    flow = makeFlow(graph, {}, dependencies);
    const Roots coarsest = coarsestPartition(flow);
    for (const Roots& roots : {coarsest, rulePartition(graph, flow), heuristicPartition(graph, flow),
                               randomPartition(flow, random), singleGroups(flow)})
      expectValid(flow, roots, "a schedule with dependencies", seed);
    for (const uint32_t n : flow.order) EXPECT_FALSE(coarsest[n] == n && canJoin(flow, coarsest, n)) << seed;
    compared += expectFewest(flow, coarsest, seed);
    cut += groupCount(flow, coarsest) > before;
  }
  EXPECT_GT(cut, 1000u);
  EXPECT_GT(compared, 1000u);
}

TEST(Heuristics, RandomPartitionsReachAllOfTheSponge) {
  const Graph graph = compiled(kSponge);
  const Flow flow = makeFlow(graph);
  std::mt19937 random(1);
  std::set<Roots> seen;
  for (int i = 0; i < 4000; ++i) seen.insert(randomPartition(flow, random));
  EXPECT_EQ(seen.size(), 40u);
}

} // namespace
