// Kernels with a queue for each execution group: they derive what the CPU evaluator derives, whatever the partition,
// the workgroups and the room, and their batches are of one group.
#include "grammars.h"
#include "kernels.h"
#include "random_grammar.h"
#include "spawn/codegen/queues.h"
#include "spawn/codegen/schedules.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/graph/heuristics.h"
#include "spawn/shared/layout.h"
#include "spawn_device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <map>
#include <memory>
#include <random>
#include <set>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using spawn::KernelTarget;
using spawn::Queues;

spawn::Graph graphOf(const std::vector<uint32_t>& words) {
  return *spawn::load(std::as_bytes(std::span(words)), std::pmr::new_delete_resource());
}
std::vector<GpgpAxiom> axiomsOf(uint32_t count, float x, float y, float z) {
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < count; ++i) axioms.push_back(spawn::makeAxiom(x, y, z, i * 2654435761u + 1, i));
  return axioms;
}
uint32_t numberFrom(const char* variable, uint32_t otherwise) {
  const char* const value = std::getenv(variable);
  return value ? static_cast<uint32_t>(std::atoi(value)) : otherwise;
}

/// What must be the same: terminal, rule, bucket, shape, seed, axiom, and the size's bits, by key.
using Facts = std::array<uint32_t, 9>;
std::multimap<uint64_t, Facts> factsOf(std::span<const GpgpInstance> instances) {
  std::vector<std::pair<uint64_t, Facts>> all;
  for (const GpgpInstance& i : instances) {
    Facts f{i.terminal, i.rule, i.bucket, i.shape, i.seed, i.axiomId};
    std::memcpy(&f[6], i.size, sizeof i.size);
    all.push_back({uint64_t(i.key[1]) << 32 | i.key[0], f});
  }
  std::sort(all.begin(), all.end());
  return {all.begin(), all.end()};
}

constexpr spawn::Fit kUsual{};
/// Workgroups of lavapipe's subgroup and larger ones, with stacks that flow over.
constexpr spawn::Fit kSmall{8, 16, 48, 64, 0, 1}, kTiny{8, 4, 24, 16}, kLarge{32, 16, 128, 64};

struct QueuesTest : ::testing::Test {
  std::unique_ptr<SpawnDevice> device;
  void make(const GpgpSpawnerCreateInfo& budgets = {}) { device = std::make_unique<SpawnDevice>(budgets); }

  static std::vector<uint32_t> withQueues(const std::vector<uint32_t>& words, const spawn::Schedule& schedule,
                                          KernelTarget target, const spawn::Fit& fit = kUsual, bool matching = false) {
    const auto source = spawn::sourceOf(graphOf(words), spawn::withQueues(schedule), matching);
    return withKernel(words, source, target, fit, Queues::groups);
  }
  /// The same derivation as the evaluator's, by a kernel behind the graph.
  void check(const std::string& what, const std::vector<uint32_t>& words, const std::vector<GpgpAxiom>& axioms) {
    SCOPED_TRACE(what);
    const spawn::Derivation expected = spawn::derive(words, axioms);
    ASSERT_TRUE(expected.complete);
    ASSERT_GT(expected.terminals, 0u);
    std::vector<GpgpInstance> instances;
    const auto report = device->derive(words, axioms, static_cast<uint32_t>(expected.terminals) + 1, &instances);
    ASSERT_EQ(report.terminals, expected.terminals)
        << report.droppedShapes << " dropped, status " << report.base.status << ", rounds " << report.rounds;
    EXPECT_EQ(report.droppedShapes, expected.droppedShapes);
    EXPECT_EQ(report.keyHash[0], expected.keyHash[0]);
    EXPECT_EQ(report.keyHash[1], expected.keyHash[1]);
    EXPECT_TRUE(factsOf(instances) == factsOf(expected.instances));
  }
};

TEST_F(QueuesTest, SamplesEqualTheEvaluator) {
  make({.maxRounds = 128, .maxColliders = 8192});
  struct Sample {
    const char *name, *schedule;
    float x, y, z;
    KernelTarget target;
    spawn::Fit fit;
  };
  std::vector<Sample> samples{{"tree_4_3", "rw", 1, 6, 1, KernelTarget::subgroups, kSmall},
                              {"terraces", "default", 14, 12, 14, KernelTarget::any, kUsual}};
  if (numberFrom("GPGP_TEST_KERNELS", 1) > 1) {
    samples.push_back({"simple_house", "heuristic", 12, 9, 24, KernelTarget::subgroups, kUsual});
    samples.push_back({"overview", "rules", 24, 60, 24, KernelTarget::any, kLarge});
  }
  for (const Sample& s : samples) {
    const auto words = bake(textOf(std::string(GPGP_SAMPLE_GRAMMARS "/") + s.name + ".pga"));
    const auto schedule = *spawn::namedSchedule(graphOf(words), s.schedule);
    check(s.name, withQueues(words, schedule, s.target, s.fit), axiomsOf(5, s.x, s.y, s.z));
  }
}

TEST_F(QueuesTest, RandomGrammarsAndPartitionsEqualTheEvaluator) { // GPGP_TEST_KERNELS=number for more
  make({.maxRounds = 128, .maxColliders = 8192});
  const uint32_t count = numberFrom("GPGP_TEST_KERNELS", 1);
  for (uint32_t seed = numberFrom("GPGP_TEST_FIRST", 3000), checked = 0; checked < count; ++seed) {
    const auto words = bake(randomGrammar(seed));
    const spawn::Graph graph = graphOf(words);
    auto axioms = axiomsOf(4 + static_cast<uint32_t>(graph.rules.size()), 6, 9, 7);
    for (uint32_t rule = 0; rule < graph.rules.size(); ++rule) axioms[4 + rule].start = rule;
    const auto cpu = spawn::derive(words, axioms);
    if (!cpu.complete || cpu.terminals < 50 || cpu.terminals > 20000 || cpu.colliders > 8192) continue;
    const spawn::Flow flow = spawn::makeFlow(graph);
    std::mt19937 random(seed);
    const auto schedule = spawn::scheduleOf(graph, flow, spawn::randomPartition(flow, random), "random");
    const auto target = checked % 2 ? KernelTarget::any : KernelTarget::subgroups;
    const spawn::Fit fit = std::array{kSmall, kUsual, kLarge}[checked % 3];
    std::cout << "queues of seed " << seed << ", target " << int(target) << std::endl; // the last one, if it crashes
    check(randomGrammar(seed), withQueues(words, schedule, target, fit, checked % 2), axioms);
    if (HasFailure()) return;
    ++checked;
  }
}

/// Rules that multiply by numbers of their own behind a choice: neighbours want different ones.
constexpr const char* kMixed = R"(axiom Box A;
terminal T (1, 0);
terminal U (1, 1);
A = Repeat(X, 1, ADJUST_TO_FILL) RandomRule(Rand(0, 1)) { 0.3: B | 0.3: C | 0.2: D | 0.2: E };
B = Repeat(Y, 2, ADJUST_TO_FILL) RandomRule(Rand(0, 1)) { 0.5: T | 0.5: E };
C = Repeat(Z, 1.5, ADJUST_TO_FILL) Rotate(0, Rand(0, 30), 0) T;
D = SubDiv(Y) { -1: Repeat(X, 0.4, ADJUST_TO_FILL) U | 2: E };
E = IfSizeLess(Y, 3) { U | Scale(-0.7, -0.6, -0.9) B };
)";

TEST_F(QueuesTest, StacksThatFlowOverLoseNothing) {
  const auto words = bake(kMixed);
  const auto schedule = *spawn::namedSchedule(graphOf(words), "rules");
  const auto axioms = axiomsOf(20, 12, 16, 10);
  // Over the next round's queue, and in the last round over its room: of one round, of which nothing is left.
  const auto tiny = withQueues(words, schedule, KernelTarget::subgroups, kTiny);
  for (const uint32_t rounds : {256u, 12u}) {
    make({.maxRounds = rounds});
    check("rounds " + std::to_string(rounds), tiny, axioms);
  }
  // What does not fit is counted: shapes are missing, and the report says how many.
  make({.maxShapes = 64, .maxRounds = 2});
  const auto report = device->derive(tiny, axioms, 1 << 20);
  EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_GT(report.droppedShapes, 0u);
}

TEST_F(QueuesTest, BatchesAreOfOneGroup) {
  make({.maxRounds = 128});
  const auto words = bake(kMixed);
  const spawn::Graph graph = graphOf(words);
  const auto schedule = *spawn::namedSchedule(graph, "rules");
  // Counts batches, and those whose shapes wait for different nodes.
  const std::string counts = R"(shared uint lowestNode, highestNode;
void countBatch(bool waits, uint node) {
  barrier();
  if (gl_LocalInvocationIndex == 0u) {
    lowestNode = 0xffffffffu;
    highestNode = 0u;
  }
  barrier();
  if (waits) {
    atomicMin(lowestNode, node);
    atomicMax(highestNode, node);
  }
  barrier();
  if (gl_LocalInvocationIndex == 0u) {
    atomicAdd(state.unfinishedShapes, 1u);
    if (lowestNode != highestNode) atomicAdd(state.colliders, 1u);
  }
}
#define GPGP_BATCH(waits, node) countBatch(waits, node);
)";
  std::array<GpgpSpawnReport, 2> reports;
  for (const Queues queues : {Queues::mixed, Queues::groups}) {
    auto source = spawn::sourceOf(graph, queues == Queues::groups ? spawn::withQueues(schedule) : schedule);
    source.functions = counts + source.functions;
    const auto all = withKernel(words, source, KernelTarget::subgroups, kLarge, queues);
    reports[queues == Queues::groups] = device->derive(all, axiomsOf(20, 12, 16, 10), 1 << 20);
  }
  EXPECT_EQ(reports[0].keyHash[0], reports[1].keyHash[0]);
  EXPECT_GT(reports[0].colliders, 20u); // one stack: so that this test counts something
  EXPECT_EQ(reports[1].colliders, 0u);
  std::cout << reports[0].unfinishedShapes << " batches of one stack, " << reports[0].colliders << " of them mixed; "
            << reports[1].unfinishedShapes << " of queues" << std::endl;
  EXPECT_GT(reports[1].unfinishedShapes, 20u);
}

TEST(QueueNumbers, AreOfEachNodeThatShapesWaitAt) {
  for (uint32_t seed = 0; seed < 300; ++seed) {
    const spawn::Graph graph = graphOf(bake(randomGrammar(seed)));
    const auto nodes = static_cast<uint32_t>(graph.nodes.size());
    const auto schedule = *spawn::namedSchedule(graph, "rw");
    std::vector<uint32_t> own(nodes);
    for (uint32_t n = 0; n < nodes; ++n) own[n] = n;
    const spawn::QueueNumbers queues = spawn::numberQueues(graph, schedule.waits, own);
    ASSERT_EQ(queues.ofNodes.size(), nodes);
    std::set<uint32_t> met;
    uint32_t waiting = 0;
    for (uint32_t n = 0; n < nodes; ++n) {
      ASSERT_LT(queues.ofNodes[n], queues.count);
      if (!schedule.waits[n] && !multiplies(graph.nodes[n])) continue;
      ++waiting;
      met.insert(queues.ofNodes[n]);
    }
    ASSERT_EQ(met.size(), std::min(waiting, shader::kMostQueues)) << randomGrammar(seed);
    ASSERT_EQ(queues.count, std::max<size_t>(met.size(), 1));
    // Those with the code of another are in its queue.
    const spawn::QueueNumbers one = spawn::numberQueues(graph, schedule.waits, std::vector<uint32_t>(nodes, 0));
    ASSERT_EQ(one.count, 1u);
  }
  // Sources before targets, so that the last of several full queues is nearest to the terminals.
  const spawn::Graph graph = graphOf(bake(R"(axiom Box A;
terminal T (1, 0);
C = Repeat(Z, 1, ADJUST_TO_FILL) T;
B = Repeat(Y, 1, ADJUST_TO_FILL) C;
A = Repeat(X, 1, ADJUST_TO_FILL) B;
)"));
  std::vector<uint32_t> own, byAxis(3);
  for (uint32_t n = 0; n < graph.nodes.size(); ++n) own.push_back(n);
  const auto queues = spawn::numberQueues(graph, std::vector<bool>(graph.nodes.size()), own);
  for (uint32_t n = 0; n < graph.nodes.size(); ++n)
    if (graph.nodes[n].op == shader::kOpRepeat) byAxis[graph.nodes[n].argument] = queues.ofNodes[n];
  EXPECT_EQ(byAxis, (std::vector<uint32_t>{0, 1, 2}));
}

TEST(QueueNumbers, OfTooManyNodesAreShared) {
  std::string text = "axiom Box R0;\nterminal T (1, 0);\n";
  for (uint32_t i = 0; i < 300; ++i)
    text += "R" + std::to_string(i) + " = Repeat(X, 1, ADJUST_TO_FILL) " +
            (i == 299 ? "T" : "R" + std::to_string(i + 1)) + ";\n";
  const spawn::Graph graph = graphOf(bake(text));
  std::vector<uint32_t> own;
  for (uint32_t n = 0; n < graph.nodes.size(); ++n) own.push_back(n);
  const auto queues = spawn::numberQueues(graph, std::vector<bool>(graph.nodes.size()), own);
  EXPECT_EQ(queues.count, shader::kMostQueues);
  std::map<uint32_t, uint32_t> nodes; // of a queue
  for (uint32_t n = 0; n < graph.nodes.size(); ++n)
    if (graph.nodes[n].op == shader::kOpRepeat) ++nodes[queues.ofNodes[n]];
  EXPECT_EQ(nodes.size(), shader::kMostQueues);
  for (const auto& [queue, count] : nodes) EXPECT_LE(count, 3u);
}

TEST(QueueNumbers, OfKernelsThatCannotBeAreRefused) {
  const auto words = bake(kMixed);
  const auto loads = [&](spawn::KernelInfo info) {
    const std::vector<uint32_t> code{0, 0x07230203};
    const auto bytes = spawn::serialize(info, code, 7, std::pmr::new_delete_resource());
    return bool(spawn::loadKernels(std::as_bytes(std::span(bytes)), 7, std::pmr::new_delete_resource()));
  };
  EXPECT_TRUE(loads({.fit = kSmall, .target = KernelTarget::any, .queues = Queues::groups}));
  EXPECT_TRUE(loads({.target = KernelTarget::software}));
  EXPECT_FALSE(loads({.target = KernelTarget::software, .queues = Queues::groups}));
  EXPECT_FALSE(loads({.target = KernelTarget::any, .queues = static_cast<Queues>(2)}));
  EXPECT_FALSE(loads({.fit = {32, 16, 8192, 64}, .target = KernelTarget::any, .queues = Queues::groups}));
  EXPECT_TRUE(loads({.fit = {32, 16, 8192, 64}, .target = KernelTarget::any}));
}
} // namespace
