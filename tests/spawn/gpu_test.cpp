// The interpreter kernel against the CPU evaluator, through the C API, with validation.
#include "../device_test.h"
#include "api/check.h"
#include "bounds.h"
#include "divisions.h"
#include "grammars.h"
#include "host/device.h"
#include "host/files.h"
#include "host/memory.h"
#include "kernels.h"
#include "random_grammar.h"
#include "spawn/codegen/compile_kernel.h"
#include "spawn/codegen/generate.h"
#include "spawn/codegen/schedules.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/graph/blob.h"
#include "spawn/graph/heuristics.h"
#include "spawn/graph/kernel.h"
#include "spawn/schedule/grammar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>
#include <tuple>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using spawn::makeAxiom;

struct Derived {
  GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
  std::vector<GpgpInstance> instances;
  std::vector<VkDrawIndexedIndirectCommand> draws;
  uint32_t count = 0;
};

struct SpawnTest : DeviceTest {
  static constexpr uint32_t kPoison = 0xbaadf00d;
  GpgpRecorder spawner = nullptr;

  void SetUp() override {
    DeviceTest::SetUp();
    makeSpawner({});
  }
  void TearDown() override {
    DeviceTest::TearDown();
    for (const std::string& message : messages) ADD_FAILURE() << message;
  }

  void makeSpawner(const GpgpSpawnerCreateInfo& budgets) {
    GpgpSpawnerCreateInfo info = GPGP_SPAWNER_CREATE_INFO_INIT;
    info.base.label = "spawner";
    info.base.queueFamily = device.graphics().family;
    info.maxShapes = budgets.maxShapes;
    info.maxTerminals = budgets.maxTerminals;
    info.maxDepth = budgets.maxDepth;
    info.maxRounds = budgets.maxRounds;
    info.flags = budgets.flags;
    info.vertices = budgets.vertices;
    info.maxColliders = budgets.maxColliders;
    info.maxHostAxioms = budgets.maxHostAxioms;
    spawner = recorder(gpgpCreateSpawner, info);
  }

  GpgpAsset makeGrammar(const std::vector<uint32_t>& words) {
    GpgpGrammarCreateInfo info = GPGP_GRAMMAR_CREATE_INFO_INIT;
    info.data = words.data();
    info.size = words.size() * 4;
    GpgpAsset grammar = nullptr;
    EXPECT_EQ(gpgpCreateGrammar(context, &info, &grammar), GPGP_SUCCESS);
    return grammar;
  }

  /// Whether the library takes such kernels here.
  bool takes(spawn::KernelTarget target) const {
    const core::Device& seen = reinterpret_cast<const core::Context*>(context)->device;
    return target == spawn::KernelTarget::any ||
           (seen.subgroupArithmetic && (target == spawn::KernelTarget::subgroups || seen.software));
  }

  /// With pipelines of its kernels; those without a fit of their own are not left out in favour of the interpreter.
  GpgpAsset makeReady(const std::vector<uint32_t>& words) {
    const GpgpAsset handle = makeGrammar(words);
    EXPECT_EQ(gpgpPrewarmGrammar(spawner, handle), GPGP_SUCCESS); // a grammar without kernels has nothing to make
    api::Call call{"test"};
    const auto grammar = api::resolve<spawn::Grammar>(call, handle, core::Kind::grammar, "grammar");
    if (!grammar) return handle; // which has failed
    for (const spawn::Kernel& kernel : (*grammar)->kernels)
      EXPECT_TRUE((*grammar)->readyCount() || kernel.info.fit.groupSize || !takes(kernel.info.target));
    return handle;
  }
  Derived run(const std::vector<uint32_t>& words, const std::vector<GpgpAxiom>& axioms, uint32_t capacity, bool sorted,
              std::optional<uint32_t> axiomCounter = {}, bool fromHost = false) {
    const GpgpAsset grammar = makeReady(words);
    Derived result = derive(grammar, words[shader::kHeaderBuckets], axioms, capacity, sorted, axiomCounter, fromHost);
    gpgpDestroyAsset(grammar);
    return result;
  }

  /// Uploads what is not there yet, derives once and reads everything back.
  Derived derive(GpgpAsset grammar, uint32_t buckets, const std::vector<GpgpAxiom>& axioms, uint32_t capacity,
                 bool sorted, std::optional<uint32_t> axiomCounter = {}, bool fromHost = false) {
    Derived result;
    const auto axiomBuffer = host::makeBuffer(device, axioms, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const host::Buffer instances(device, VkDeviceSize(capacity) * sizeof(GpgpInstance),
                                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    host::fill(device, instances, kPoison);
    const auto draws =
        host::makeBuffer(device, std::vector<VkDrawIndexedIndirectCommand>(buckets, {36, kPoison, 5, 6, kPoison}),
                         VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const auto count = host::makeBuffer(device, std::vector<uint32_t>{kPoison}, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const auto counter =
        host::makeBuffer(device, std::vector<uint32_t>{axiomCounter.value_or(0)}, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
    info.base.tag = 1000 + axioms.size();
    info.grammar = grammar;
    if (fromHost)
      info.hostAxioms = axioms.data();
    else
      info.axioms = axiomBuffer.range();
    info.axiomCount = static_cast<uint32_t>(axioms.size());
    if (axiomCounter) info.axiomCounter = counter.range();
    const host::Buffer bounds(device, buckets * sizeof(GpgpSpawnBounds), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    info.bounds = bounds.range();
    info.instances = instances.range();
    if (sorted) info.draws = draws.range();
    info.count = count.range();
    const GpgpFrame f = advance();
    device.submitAndWait([&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordUpload(context, cmd, &f, 0, nullptr), GPGP_SUCCESS);
      EXPECT_EQ(gpgpRecordPrepareSpawn(spawner, cmd, &f, &info), GPGP_SUCCESS);
    });
    advance();
    EXPECT_EQ(gpgpGetSpawnReport(spawner, &result.report), GPGP_SUCCESS);
    EXPECT_EQ(result.report.base.tag, info.base.tag);
    result.count = host::download<uint32_t>(device, count, 1)[0];
    EXPECT_EQ(result.count, result.report.instancesWritten);
    EXPECT_LE(result.count, capacity);
    const auto all = host::download<GpgpInstance>(device, instances, capacity);
    result.instances.assign(all.begin(), all.begin() + std::min(result.count, capacity));
    for (size_t i = result.count; i < all.size(); ++i) // nothing beyond the count is touched
      if (all[i].bucket != kPoison || all[i].rule != kPoison) {
        ADD_FAILURE() << "instance " << i << " of " << result.count << " was written";
        break;
      }
    result.draws = host::download<VkDrawIndexedIndirectCommand>(device, draws, buckets);
    if (result.report.instancesWritten == result.report.terminals)
      expectBounds(host::download<GpgpSpawnBounds>(device, bounds, buckets), result.instances);
    return result;
  }

  static uint32_t bits(float value) { return std::bit_cast<uint32_t>(value); }
  static uint64_t keyOf(const GpgpInstance& i) { return uint64_t(i.key[0]) << 32 | i.key[1]; }

  /// Equal in everything that must be, bit for bit; transforms within 1e-4 of the size that the axis or place has.
  static void compare(const spawn::Derivation& cpu, const Derived& gpu, const std::string& what) {
    ASSERT_EQ(gpu.report.terminals, cpu.terminals) << what;
    ASSERT_EQ(gpu.report.keyHash[0], cpu.keyHash[0]) << what;
    ASSERT_EQ(gpu.report.keyHash[1], cpu.keyHash[1]) << what;
    EXPECT_EQ(gpu.report.depth, cpu.depth) << what;
    EXPECT_EQ(gpu.report.unfinishedShapes, cpu.unfinishedShapes) << what;
    EXPECT_EQ(gpu.report.droppedShapes, cpu.droppedShapes) << what;
    EXPECT_EQ(gpu.report.colliders, cpu.colliders) << what;
    EXPECT_EQ(gpu.report.collidersKept, cpu.colliders) << what;
    EXPECT_EQ(gpu.report.base.status, cpu.unfinishedShapes || cpu.droppedShapes ? GPGP_BUDGET_EXCEEDED : GPGP_SUCCESS)
        << what;
    ASSERT_EQ(gpu.instances.size(), cpu.terminals) << what;
    const auto order = [](const GpgpInstance* a, const GpgpInstance* b) {
      return std::pair(keyOf(*a), a->axiomId) < std::pair(keyOf(*b), b->axiomId);
    };
    std::vector<const GpgpInstance*> a, b;
    for (const GpgpInstance& i : cpu.instances) a.push_back(&i);
    for (const GpgpInstance& i : gpu.instances) b.push_back(&i);
    std::sort(a.begin(), a.end(), order);
    std::sort(b.begin(), b.end(), order);
    for (size_t i = 0; i < a.size(); ++i) {
      ASSERT_EQ(keyOf(*a[i]), keyOf(*b[i])) << what;
      ASSERT_EQ(a[i]->bucket, b[i]->bucket) << what;
      ASSERT_EQ(a[i]->shape, b[i]->shape) << what;
      ASSERT_EQ(a[i]->axiomId, b[i]->axiomId) << what;
      ASSERT_EQ(a[i]->terminal, b[i]->terminal) << what;
      ASSERT_EQ(a[i]->seed, b[i]->seed) << what;
      ASSERT_EQ(bits(a[i]->attribute), bits(b[i]->attribute)) << what;
      for (int axis = 0; axis < 3; ++axis) ASSERT_EQ(bits(a[i]->size[axis]), bits(b[i]->size[axis])) << what;
      ASSERT_EQ(a[i]->rule, b[i]->rule) << what;
      for (int column = 0; column < 4; ++column) { // the axes, each as long as the shape, and the place
        float largest = column == 3 ? 1 : 0;
        for (int t = column; t < 12; t += 4) largest = std::max(largest, std::fabs(a[i]->transform[t]));
        for (int t = column; t < 12; t += 4)
          ASSERT_NEAR(a[i]->transform[t], b[i]->transform[t], 1e-4f * largest) << "instance " << i << " of " << what;
      }
    }
  }

  /// Buckets are runs in order, and the draws say where.
  static void checkDraws(const spawn::Derivation& cpu, const Derived& gpu) {
    ASSERT_EQ(gpu.instances.size(), cpu.terminals);
    uint32_t first = 0;
    for (size_t bucket = 0; bucket < gpu.draws.size(); ++bucket) {
      const VkDrawIndexedIndirectCommand& draw = gpu.draws[bucket];
      ASSERT_EQ(draw.firstInstance, first);
      ASSERT_EQ(draw.instanceCount, cpu.buckets[bucket]);
      ASSERT_EQ(draw.indexCount, 36u);
      ASSERT_EQ(draw.firstIndex, 5u);
      ASSERT_EQ(draw.vertexOffset, 6);
      for (uint32_t i = 0; i < draw.instanceCount; ++i) ASSERT_EQ(gpu.instances[first + i].bucket, bucket);
      first += draw.instanceCount;
    }
    ASSERT_EQ(first, cpu.terminals);
  }

  void check(const std::string& what, const std::vector<uint32_t>& words, const std::vector<GpgpAxiom>& axioms) {
    const spawn::Derivation cpu = spawn::derive(words, axioms);
    ASSERT_TRUE(cpu.complete) << what;
    const uint32_t capacity = static_cast<uint32_t>(cpu.terminals) + 10;
    const uint32_t buckets = words[shader::kHeaderBuckets];
    const GpgpAsset grammar = makeReady(words);
    const Derived sorted = derive(grammar, buckets, axioms, capacity, true);
    compare(cpu, sorted, what);
    checkDraws(cpu, sorted);
    const Derived plain = derive(grammar, buckets, axioms, capacity, false);
    gpgpDestroyAsset(grammar);
    compare(cpu, plain, what);
    for (const VkDrawIndexedIndirectCommand& draw : plain.draws) ASSERT_EQ(draw.instanceCount, kPoison) << what;
  }
};

/// Axioms turned and moved, with seeds and attributes of their own.
std::vector<GpgpAxiom> axioms(uint32_t count, float x, float y, float z) {
  std::vector<GpgpAxiom> result;
  for (uint32_t i = 0; i < count; ++i) {
    GpgpAxiom axiom = makeAxiom(x, y, z, i * 2654435761u + 1, 100 + i);
    const float angle = float(i) * 0.7f;
    axiom.transform[0] = axiom.transform[10] = std::cos(angle);
    axiom.transform[2] = std::sin(angle);
    axiom.transform[8] = -std::sin(angle);
    axiom.transform[3] = float(i % 16) * 50;
    axiom.transform[11] = 50 * std::floor(float(i) / 16);
    if (i % 3 == 1) axiom.attribute = float(i) / 10;
    result.push_back(axiom);
  }
  return result;
}

TEST_F(SpawnTest, OwnGrammarsEqualTheEvaluator) {
  for (const std::string& name : ownGrammarNames()) check(name, bake(ownGrammar(name)), axioms(7, 12, 16, 10));
}

TEST_F(SpawnTest, GivenGrammarsEqualTheEvaluator) {
  if (!sharedGrammar("balcony.pga")) GTEST_SKIP() << "the published grammars are not in the shared data folder";
  const auto given = [](const char* name) { return bake(*sharedGrammar(name)); };
  check("menger", given("menger_sponge_3.pga"), axioms(20, 1, 1, 1));
  check("menger 8000", bake(replaced(*sharedGrammar("menger_sponge_3.pga"), "0.333", "0.111")), axioms(3, 1, 1, 1));
  check("menger 160000", bake(replaced(*sharedGrammar("menger_sponge_3.pga"), "0.333", "1")), axioms(1, 27, 27, 27));
  check("tree 4", given("3d_tree_4_3.pga"), axioms(5, 16, 16, 16));
  check("tree 8", given("3d_tree_8_3.pga"), axioms(2, 16, 16, 16));
  check("balcony", given("balcony.pga"), axioms(256, 24, 34, 24));
  check("commercial", given("commercial.pga"), axioms(64, 30, 45, 30));
  check("skyscraper", given("mc_skyscraper.pga"), axioms(8, 30, 90, 30));
}

uint32_t numberFrom(const char* variable, uint32_t otherwise) {
  const char* const value = std::getenv(variable);
  return value ? static_cast<uint32_t>(std::atoi(value)) : otherwise;
}

spawn::Graph graphOf(const std::vector<uint32_t>& words) {
  auto graph = spawn::load(std::as_bytes(std::span(words)), std::pmr::new_delete_resource());
  EXPECT_TRUE(graph);
  return std::move(*graph);
}

/// A random grammar, some axioms at its axiom line and one at the beginning of each rule.
struct RandomCase {
  uint32_t seed = 0;
  std::string text, what;
  std::vector<uint32_t> words;
  std::vector<GpgpAxiom> all;
  uint32_t terminals = 0;
};
/// The first one from this seed on that is not too large, and where there is something to see.
RandomCase randomCase(uint32_t seed) {
  spawn::DeriveOptions options;
  options.maxShapes = 30000;
  for (;; ++seed) {
    RandomCase random{seed, randomGrammar(seed), "seed " + std::to_string(seed)};
    random.what += "\n" + random.text;
    random.words = bake(random.text);
    const spawn::Graph graph = graphOf(random.words);
    const uint32_t atLine = 1 + seed % 5, rules = static_cast<uint32_t>(graph.rules.size());
    random.all = axioms(atLine + rules, 6, 9, 7);
    for (uint32_t rule = 0; rule < rules; ++rule) random.all[atLine + rule].start = rule;
    const auto cpu = spawn::derive(random.words, random.all, options);
    random.terminals = static_cast<uint32_t>(cpu.terminals);
    if (cpu.complete && cpu.terminals >= 5 && cpu.colliders <= 8192) return random;
  }
}

TEST_F(SpawnTest, RandomGrammarsEqualTheEvaluator) {
  makeSpawner({.maxColliders = 8192});
  uint32_t instances = 0;
  const uint32_t count = numberFrom("GPGP_TEST_GRAMMARS", 200); // more for a long run, which may begin later
  const uint32_t least = count < 200 ? 0 : 100 * count;         // instances: of few grammars, all can be small
  for (uint32_t seed = numberFrom("GPGP_TEST_FIRST", 0), checked = 0; checked < count || instances < least;
       ++seed, ++checked) {
    ASSERT_LT(checked, 2 * count) << instances << " instances";
    const RandomCase random = randomCase(seed);
    seed = random.seed;
    check(random.what, random.words, random.all);
    if (HasFailure()) return;
    instances += random.terminals;
  }
}

TEST_F(SpawnTest, EveryDivisionEqualsTheEvaluator) { // what is dropped as well, which only reports say
  const Divisions divisions = makeDivisions();
  const uint32_t dropped = spawn::derive(divisions.words, divisions.axioms).droppedShapes;
  EXPECT_GT(dropped, 100u);
  check("divisions", divisions.words, divisions.axioms);
  std::map<std::string, std::vector<GpgpAxiom>> byShape; // alone, so that each counts what is its own
  for (size_t i = 0; i < divisions.all.size(); ++i) byShape[divisions.all[i].shape].push_back(divisions.axioms[i]);
  for (const auto& [shape, axioms] : byShape) check(shape, divisions.words, axioms);
}

/// What `gpgp tune` stores is a baked grammar with kernels behind its graph. Each here is made of a graph with another
/// height than the stored one's, so that instances say who derived them.
TEST_F(SpawnTest, StoredSchedulesServeTheirDeviceAndNumberOfAxioms) {
  const std::string text = "var h = 1; axiom Box A; terminal T (1, 0);"
                           "A = Replicate() { Translate(0, h, 0) T | Translate(0, h, 0) T };";
  const auto words = bake(text);
  const uint32_t vendor = device.properties().vendorID, model = device.properties().deviceID;
  struct Stored {
    float height;
    uint32_t vendor, device, axioms;
  };
  std::map<float, std::vector<uint32_t>> codes; // by height: compiling takes seconds
  const auto stored = [&](const std::vector<Stored>& kernels) {
    std::vector<uint32_t> all = words;
    for (const Stored& s : kernels) {
      const spawn::Graph graph = graphOf(bake(text, {{"h", s.height}}));
      spawn::KernelInfo info;
      for (const spawn::KernelTarget target : spawn::targetsOf(graph))
        if (takes(target)) {
          info.target = target;
          break;
        }
      info.vendor = s.vendor;
      info.device = s.device;
      info.axioms = s.axioms;
      const auto waits = spawn::namedSchedule(graph, "sgl")->waits;
      if (codes[s.height].empty()) codes[s.height] = *spawn::compileKernel(spawn::generate(graph, waits), info.target);
      const auto kernel =
          spawn::serialize(info, codes[s.height], words[shader::kHeaderChecksum], std::pmr::new_delete_resource());
      all.insert(all.end(), kernel.begin(), kernel.end());
    }
    return all;
  };
  const auto heightsOf = [&](GpgpAsset grammar, std::initializer_list<uint32_t> numbers) {
    std::vector<float> heights;
    for (const uint32_t number : numbers) {
      const std::vector<GpgpAxiom> all(number, makeAxiom(1, 1, 1));
      const Derived derived = derive(grammar, 1, all, 2 * number, false);
      EXPECT_EQ(derived.instances.size(), 2 * number);
      for (const GpgpInstance& i : derived.instances) EXPECT_EQ(i.transform[7], derived.instances[0].transform[7]);
      heights.push_back(derived.instances.empty() ? 0 : derived.instances[0].transform[7]);
    }
    return heights;
  };
  const std::vector<Stored> others = {{3, vendor + 1, model, 4}, {3, vendor, model + 1, 4}},
                            own = {{2, vendor, model, 4}, {3, vendor, model, 1000}}, any = {{7, 0, 0, 0}};
  const auto joined = [](std::vector<Stored> a, const std::vector<Stored>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  };
  const GpgpAsset tuned = makeGrammar(stored(joined(any, joined(others, own))));
  EXPECT_EQ(heightsOf(tuned, {4}), std::vector<float>{1}); // the interpreter, until there are pipelines
  EXPECT_EQ(gpgpPrewarmGrammar(spawner, tuned), GPGP_SUCCESS);
  EXPECT_EQ(heightsOf(tuned, {4, 5, 2, 100, 1000}), (std::vector<float>{2, 2, 2, 3, 3}));
  gpgpDestroyAsset(tuned);
  const GpgpAsset forAny = makeReady(stored(joined(others, any)));
  EXPECT_EQ(heightsOf(forAny, {4, 1000}), (std::vector<float>{7, 7}));
  gpgpDestroyAsset(forAny);
  const GpgpAsset forOthers = makeGrammar(stored(others));
  EXPECT_EQ(gpgpPrewarmGrammar(spawner, forOthers), GPGP_SUCCESS);
  EXPECT_EQ(heightsOf(forOthers, {4}), std::vector<float>{1});
  gpgpDestroyAsset(forOthers);
}

/// With a kernel behind the graph.
std::vector<uint32_t> bakeKernel(const std::string& text) {
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  source.text = text.data();
  source.size = text.size();
  source.flags = GPGP_COMPILE_KERNEL;
  GpgpBlob blob{};
  EXPECT_EQ(gpgpCompileGrammar(&source, &blob), GPGP_SUCCESS);
  std::vector<uint32_t> words(blob.size / 4);
  std::memcpy(words.data(), blob.data, blob.size);
  gpgpFreeBlob(&blob);
  EXPECT_GT(words.size(), words[shader::kHeaderWords]);
  return words;
}

TEST_F(SpawnTest, KernelsAloneDeriveTheSame) {
  const auto pipelines = [&] {
    uint32_t count = 0;
    EXPECT_EQ(gpgpGetPipelines(spawner, &count, nullptr), GPGP_SUCCESS);
    std::vector<GpgpPipelineInfo> list(count);
    EXPECT_EQ(gpgpGetPipelines(spawner, &count, list.data()), GPGP_SUCCESS);
    return std::count_if(list.begin(), list.end(), [](const auto& p) { return std::string(p.name) == "derive"; });
  };
  makeSpawner({.maxColliders = 100});
  EXPECT_EQ(pipelines(), 2);
  makeSpawner({.flags = GPGP_SPAWNER_KERNELS_ONLY, .maxColliders = 100});
  EXPECT_EQ(pipelines(), 0);
  const std::vector<GpgpAxiom> lots = axioms(7, 12, 16, 10);
  const auto axiomBuffer = host::makeBuffer(device, lots, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const host::Buffer instances(device, 1024 * sizeof(GpgpInstance), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const auto recorded = [&](GpgpAsset grammar) {
    GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
    info.grammar = grammar;
    info.axioms = axiomBuffer.range();
    info.axiomCount = static_cast<uint32_t>(lots.size());
    info.instances = instances.range();
    const GpgpFrame frame = advance();
    GpgpResult result = GPGP_SUCCESS;
    device.submitAndWait([&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordUpload(context, cmd, &frame, 0, nullptr), GPGP_SUCCESS);
      result = gpgpRecordPrepareSpawn(spawner, cmd, &frame, &info);
    });
    return result;
  };
  const std::vector<uint32_t> baked = bakeKernel(ownGrammar("building.pga"));
  const GpgpAsset bare = makeGrammar(bake(ownGrammar("building.pga"))), later = makeGrammar(baked);
  EXPECT_EQ(recorded(bare), GPGP_ERROR_UNSUPPORTED);
  EXPECT_NE(lastMessage().find("the grammar was baked without kernels, and the spawner has no interpreter"),
            std::string::npos)
      << lastMessage();
  EXPECT_EQ(gpgpPrewarmGrammar(spawner, bare), GPGP_ERROR_UNSUPPORTED);
  EXPECT_NE(lastMessage().find("without kernels"), std::string::npos) << lastMessage();
  EXPECT_EQ(recorded(later), GPGP_NOT_READY);
  EXPECT_NE(lastMessage().find("call gpgpPrewarmGrammar first"), std::string::npos) << lastMessage();
  messages.clear();
  ASSERT_EQ(gpgpPrewarmGrammar(spawner, later), GPGP_SUCCESS);
  EXPECT_EQ(recorded(later), GPGP_SUCCESS);
  advance();
  GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
  EXPECT_EQ(gpgpGetSpawnReport(spawner, &report), GPGP_SUCCESS);
  EXPECT_GT(report.terminals, lots.size());
  gpgpDestroyAsset(bare);
  gpgpDestroyAsset(later);
  check("building", baked, lots);
  check("colliders",
        bakeKernel("axiom Box All;\nterminal Thin (1, 0);\nAll = Collider(1) SubDiv(X) { -1: Thin | -1: Free };\n"
                   "Free = IfCollides(1) { Discard() | Thin };\n"),
        lots);
}

/// A grammar with a kernel of the default schedule.
std::vector<uint32_t> bakeFor(const std::string& text, spawn::KernelTarget target, const spawn::Fit& fit = {}) {
  std::vector<uint32_t> words = bake(text);
  const spawn::Graph graph = graphOf(words);
  const auto source = spawn::generate(graph, spawn::namedSchedule(graph, "default")->waits);
  return withKernel(std::move(words), source, target, fit);
}

/// How many kernels a test makes; software devices take seconds to compile one. GPGP_TEST_KERNELS=number for more.
uint32_t kernelCount() { return numberFrom("GPGP_TEST_KERNELS", 1); }

TEST_F(SpawnTest, GeneratedKernelsEqualTheEvaluator) {
  makeSpawner({.maxColliders = 100});
  for (const std::string& name : ownGrammarNames()) check(name, bakeKernel(ownGrammar(name)), axioms(7, 12, 16, 10));
  // Descendants that are terminals at once, of shapes whose axiom is found by way of their collider.
  check("behind a collider", bakeKernel(R"(axiom Box All;
terminal Thin (1, 0);
terminal Flat (1, 1);
All = Collider(2) Collider(1) SubDiv(X) { -1: SubDiv(Y) { -1: Thin | -2: Flat } | -1: CompSplit() { Thin | Flat | Again } };
Again = IfCollides(1) { Thin | SubDiv(X) { -1: SubDiv(Y) { -1: Flat | -2: Thin } | -3: Thin } };
)"),
        axioms(7, 12, 16, 10));
  // Known angles beside another, and a size by where they turn an axis: NVIDIA's compiler folds their sines otherwise.
  check("known angles", bakeKernel(R"(axiom Box All;
terminal Thin (1, 0);
All = Rotate(-53.28, Exp(ShapeSize(Z) * 0.352), 90)
      SubDiv(Z) { Exp(ShapeNormal(Y) * 1.111 - ShapeRotation(X,Z)): Thin | -1: Thin };
)"),
        axioms(7, 6, 9, 7));
  // SubDivs that keep one part: of polygons and prisms a piece, by constants and by expressions.
  check("filters that cut", bakeKernel(R"(axiom Hexagon Half;
terminal Thin (1, 0);
terminal Flat (1, 1);
Half = SubDiv(X) { -1: Discard() | -2: Turned };
Turned = Rotate(Rand(0, 20), Rand(0, 90), Rand(-9, 9)) Extrude(2) SubDiv(Z) { -1: Part | -1: Discard() };
Part = SubDiv(Y) { Rand(0.5, 1): Flat | -1: Discard() };
)"),
        axioms(7, 12, 16, 10));
  if (!sharedGrammar("balcony.pga")) return; // the published grammars, where somebody has them, are more of the same
  const auto given = [](const char* name) { return bakeKernel(*sharedGrammar(name)); };
  check("menger 8000", bakeKernel(replaced(*sharedGrammar("menger_sponge_3.pga"), "0.333", "0.111")),
        axioms(3, 1, 1, 1));
  check("skyscraper", given("mc_skyscraper.pga"), axioms(8, 30, 90, 30));
  if (kernelCount() < 4) return;
  check("tree 8", given("3d_tree_8_3.pga"), axioms(2, 16, 16, 16));
  check("balcony", given("balcony.pga"), axioms(256, 24, 34, 24));
  check("commercial", given("commercial.pga"), axioms(64, 30, 45, 30));
}

TEST_F(SpawnTest, GeneratedKernelsOfRandomGrammarsEqualTheEvaluator) {
  makeSpawner({.maxColliders = 8192});
  const uint32_t count = numberFrom("GPGP_TEST_KERNELS", 3);
  for (uint32_t seed = numberFrom("GPGP_TEST_FIRST", 1000), checked = 0; checked < count; ++seed, ++checked) {
    const RandomCase random = randomCase(seed);
    seed = random.seed;
    std::vector<spawn::KernelTarget> targets; // take turns
    for (const spawn::KernelTarget target : spawn::targetsOf(graphOf(random.words)))
      if (takes(target)) targets.push_back(target);
    const spawn::KernelTarget target = targets[checked % targets.size()];
    std::cout << "kernel of seed " << seed << ", target " << int(target) << std::endl; // the last one, if it crashes
    check(random.what, bakeFor(random.text, target), random.all);
    if (HasFailure()) return;
  }
}

/// With a kernel in which matching groups of a random partition share code.
std::vector<uint32_t> bakeMatched(const std::string& text, uint32_t seed) {
  std::vector<uint32_t> words = bake(text);
  const spawn::Graph graph = graphOf(words);
  const spawn::Flow flow = spawn::makeFlow(graph);
  std::mt19937 random(seed);
  const auto roots = seed ? spawn::randomPartition(flow, random) : spawn::singleGroups(flow);
  const auto schedule = spawn::scheduleOf(graph, flow, roots, "matched");
  const spawn::KernelSource source = spawn::generate(graph, schedule.waits, schedule.roots);
  for (const spawn::KernelTarget target : spawn::targetsOf(graph)) {
    if (seed % 2 && target == spawn::KernelTarget::software) continue; // so that theirs runs kernels of GPUs as well
    words = withKernel(std::move(words), source, target);
  }
  return words;
}

TEST_F(SpawnTest, PartitionsOfSampleGrammarsEqualTheEvaluator) {
  const uint32_t count = numberFrom("GPGP_TEST_PARTITIONS", 1); // of each grammar
  uint32_t made = 0; // every other one for GPUs, then the same again with matching
  struct Sample {
    const char* name;
    float x, y, z;
  };
  for (const Sample& sample :
       {Sample{"simple_house", 12, 9, 24}, Sample{"overview", 24, 60, 24}, Sample{"tree_4_3", 1, 6, 1}}) {
    const auto words = bake(host::readText(std::string(GPGP_SAMPLE_GRAMMARS "/") + sample.name + ".pga"));
    const spawn::Graph graph = graphOf(words);
    const spawn::Flow flow = spawn::makeFlow(graph);
    const auto all = axioms(7, sample.x, sample.y, sample.z);
    const auto cpu = spawn::derive(words, all);
    ASSERT_TRUE(cpu.complete);
    ASSERT_GT(cpu.terminals, 100u);
    std::mt19937 random(7);
    for (uint32_t i = 0; i < count; ++i, ++made) {
      const auto schedule = spawn::scheduleOf(graph, flow, spawn::randomPartition(flow, random), "random");
      const auto source = made / 2 % 2 ? spawn::generate(graph, schedule.waits, schedule.roots)
                                       : spawn::generate(graph, schedule.waits);
      const auto target = made % 2 ? spawn::KernelTarget::subgroups : spawn::KernelTarget::software;
      const auto gpu = run(withKernel(words, source, target), all, static_cast<uint32_t>(cpu.terminals), false);
      compare(cpu, gpu, std::string(sample.name) + ", kernel " + std::to_string(made));
      if (HasFatalFailure()) return;
    }
  }
}

TEST_F(SpawnTest, MatchedKernelsEqualTheEvaluator) {
  makeSpawner({.maxColliders = 8192}); // random grammars have colliders
  // Chains of one structure: constants, expressions, targets and terminals differ.
  check("alike",
        bakeMatched(R"(axiom Box All;
terminal Thin (1, 0);
terminal Flat (1, 1);
All = SubDiv(X) { -1: One | -1: Two | -1: Three | -2: Four };
One = Rotate(0, 30, 0) Scale(0.5, -1, Exp(ShapeSize(Z) * 0.5)) IfSizeLess(Y, 10) { Thin | Again };
Two = Rotate(0, 45, 10) Scale(0.25, -1, Exp(ShapeSize(Z) * 0.7)) IfSizeLess(Y, 20) { Flat | Again };
Three = Rotate(5, 0, 0) Scale(0.75, -0.5, Exp(ShapeSize(Z) * 0.9)) IfSizeLess(Y, 4) { Flat | Other };
Four = RandomRule(ShapeSeed()) { 0.3: Thin | 0.7: Translate(0, 1, 0) Flat };
Again = Repeat(Y, 3, ADJUST_TO_FILL) Thin;
Other = Repeat(Y, 2, ANCHOR_TO_START) Flat;
)",
                    0),
        axioms(7, 12, 16, 10));
  check("shapes", bakeMatched(ownGrammar("shapes.pga"), 0), axioms(7, 12, 16, 10));
  const uint32_t count = kernelCount();
  for (uint32_t seed = numberFrom("GPGP_TEST_FIRST", 2000), checked = 0; checked < count; ++seed, ++checked) {
    const RandomCase random = randomCase(seed);
    seed = random.seed;
    std::cout << "matched kernel of seed " << seed << std::endl;
    check("matched, " + random.what, bakeMatched(random.text, seed), random.all);
    if (HasFailure()) return;
  }
}

/// A kernel for which shapes wait at all nodes of one operator.
std::vector<uint32_t> bakeWaiting(const std::string& text, uint32_t op, spawn::KernelTarget target) {
  std::vector<uint32_t> words = bake(text);
  const spawn::Graph graph = graphOf(words);
  std::vector<bool> waits;
  for (const spawn::Node& node : graph.nodes) waits.push_back(node.op == op && !spawn::multiplies(node));
  return withKernel(std::move(words), spawn::generate(graph, waits), target);
}

TEST_F(SpawnTest, ShapesWaitForWhatPassesOnOne) {
  // The first SubDiv is a family; the second one keeps one part, and no other is made by the graph's words. Where rules
  // begin, axioms can start, so what counts here is inside of rules.
  const char* const text = R"(axiom Box A;
terminal T (1, 0);
terminal U (1, 1);
A = SubDiv(X) {
  -1: Translate(0, 1, 0) IfSizeLess(Y, 20) { Translate(1, 0, 0) T | U }
  | -1: IfSizeLess(X, 3) { T | U }
  | -2: SubDiv(Y) { 0.25: Discard() | -1: IfSizeLess(Z, 5) { U | Scale(0.5, 1, 1) T } | 0.5: Discard() }
};
)";
  for (const spawn::KernelTarget target : {spawn::KernelTarget::software, spawn::KernelTarget::subgroups})
    for (const uint32_t op : {shader::kOpIfSizeLess, shader::kOpSubDiv})
      check("waits for operator " + std::to_string(op) + ", target " + std::to_string(int(target)),
            bakeWaiting(text, op, target), axioms(7, 12, 16, 10));
}

TEST_F(SpawnTest, FamiliesGoThroughChoices) {
  // Choices whose successors make about as many shapes, one behind another, behind a Repeat and where shapes come back;
  // some make one fewer, and a part may have no length. The graph is uneven, so Repeats have families as well.
  const char* const even = R"(axiom Box A;
terminal T (1, 0);
terminal U (1, 1);
A = IfSizeLess(X, 0.7) { T | B };
B = SubDiv(X) { -1: RandomRule(ShapeSeed()) { 0.5: C | 0.2: D | 0.3: Translate(0, 1, 0) C } | -1: Scale(-1, -0.9, -1) A };
C = Replicate() { T | Rotate(0, Rand(0, 90), 0) IfSizeLess(Y, 3) { E | Scale(-0.5, -0.5, 0.2) D } };
D = SubDiv(Y) { -1: U | 4: Translate(0, 0, 1) T | -2: Discard() };
E = Replicate() { Scale(-1, 0.5, -1) U | If(ShapeSize(Z) - 4 < 0) { T | U } };
)";
  const char* const repeated = R"(axiom Box A;
terminal T (1, 0);
terminal U (1, 1);
A = Repeat(X, 1.7, ADJUST_TO_FILL) RandomRule(ShapeSeed()) { 0.4: SubDiv(Z) { -1: T | 2: U } | 0.3: F | 0.3: Up };
F = SubDiv(Y) { 1: Discard() | -1: Extrude(1) U | 20: Repeat(Z, 3, ANCHOR_TO_END) Translate(0, 0, 1) F2 };
F2 = RandomRule(ShapeSeed()) { 0.5: CompSplit() { T | Discard() | U } | 0.5: CompSplit() { Discard() | T | U } };
Up = Replicate() { T | Scale(-0.6, -0.6, -0.6) A2 };
A2 = IfSizeLess(X, 0.5) { U | A };
)";
  for (const spawn::KernelTarget target : {spawn::KernelTarget::software, spawn::KernelTarget::subgroups}) {
    const std::string what = ", target " + std::to_string(int(target));
    check("even" + what, bakeWaiting(even, shader::kOpSwapSize, target), axioms(7, 12, 16, 10));
    check("repeated" + what, bakeWaiting(repeated, shader::kOpSwapSize, target), axioms(7, 12, 16, 10));
  }
}

TEST_F(SpawnTest, KernelsStartAtRulesThatDiscard) {
  auto all = axioms(7, 12, 16, 10);
  for (size_t i = 0; i < all.size(); ++i) all[i].start = i % 2;
  check("discard",
        bakeWaiting("axiom Box A; terminal T (1, 0); A = SubDiv(X) { -1: T | -1: B }; B = Discard();", shader::kOpIf,
                    spawn::KernelTarget::software),
        all);
}

TEST_F(SpawnTest, WorkgroupsOfASubgroupEqualTheEvaluator) {
  // One of these sizes is a subgroup's on most devices: such workgroups know it, and hand shapes on without memory. The
  // kernel without subgroups must not mind, and a workgroup may be a part of a subgroup.
  std::vector<uint32_t> words = bake(ownGrammar("shapes.pga"));
  const spawn::Graph graph = graphOf(words);
  const auto generated = spawn::generate(graph, spawn::namedSchedule(graph, "default")->waits);
  using enum spawn::KernelTarget;
  for (const spawn::KernelTarget target : {software, subgroups, any}) {
    const auto code = spawn::compileKernel(generated, target);
    ASSERT_TRUE(code) << code.error().text;
    for (const uint32_t size : {8u, 32u}) {
      if (target == software && size != 8) continue;
      spawn::KernelInfo info;
      info.target = target;
      // Stacks that flow over.
      info.fit = {size, 16, target == software ? 128 : 6 * size, 64, 0, target == subgroups ? 1u : 0u};
      auto all = words;
      const auto kernel =
          spawn::serialize(info, *code, words[shader::kHeaderChecksum], std::pmr::new_delete_resource());
      all.insert(all.end(), kernel.begin(), kernel.end());
      check("workgroups of " + std::to_string(size) + ", target " + std::to_string(static_cast<uint32_t>(target)), all,
            axioms(9, 12, 16, 10));
    }
  }
}

TEST_F(SpawnTest, DamagedKernelsAreRefused) {
  const auto words = bakeKernel(ownGrammar("sponge.pga"));
  const uint32_t graph = words[shader::kHeaderWords];
  const auto refused = [&](auto change) {
    auto changed = words;
    change(changed);
    GpgpGrammarCreateInfo info = GPGP_GRAMMAR_CREATE_INFO_INIT;
    info.data = changed.data();
    info.size = changed.size() * 4;
    GpgpAsset grammar = nullptr;
    const GpgpResult result = gpgpCreateGrammar(context, &info, &grammar);
    EXPECT_EQ(grammar, nullptr);
    const std::string text = messages.empty() ? "" : messages.back();
    messages.clear();
    return result == GPGP_ERROR_INVALID_DATA ? text : "accepted";
  };
  const std::string begin = "gpgpCreateGrammar: kernel 0 of the baked grammar: ";
  EXPECT_EQ(refused([&](auto& w) { w[graph] ^= 1; }), begin + "the data that follows is not a kernel");
  const std::string older = refused([&](auto& w) { w[graph + 1] = 1; });
  EXPECT_EQ(older.rfind(begin + "it was made in format 1; this library reads format ", 0), 0u) << older;
  EXPECT_NE(older.find(": bake the grammar again"), std::string::npos) << older;
  EXPECT_EQ(refused([&](auto& w) { w[graph + 40] ^= 1; }), begin + "its checksum is wrong");
  EXPECT_EQ(refused([&](auto& w) { w.resize(graph + 30); }), begin + "it was cut");
  EXPECT_EQ(refused([&](auto& w) {
              const auto other = bake(ownGrammar("tree.pga"));
              w.erase(w.begin(), w.begin() + graph);
              w.insert(w.begin(), other.begin(), other.end());
            }),
            begin + "it was made for another graph");
  const spawn::KernelInfo strange{.fit = {32, 16, 128, 64, 0, 2}};
  EXPECT_EQ(refused([&](auto& w) {
              w.resize(graph);
              const auto kernel = spawn::serialize(strange, std::vector<uint32_t>{0, 0x07230203},
                                                   w[shader::kHeaderChecksum], std::pmr::new_delete_resource());
              w.insert(w.end(), kernel.begin(), kernel.end());
            }),
            begin + "its schedule has numbers that cannot run");
}

TEST_F(SpawnTest, AnyOrderOfAxiomsGivesTheSame) {
  const auto words = bake(ownGrammar("building.pga"));
  auto all = axioms(40, 13, 19, 11);
  const Derived first = run(words, all, 100000, true);
  std::reverse(all.begin(), all.end());
  std::rotate(all.begin(), all.begin() + 11, all.end());
  const Derived second = run(words, all, 100000, true);
  EXPECT_EQ(first.report.keyHash[0], second.report.keyHash[0]);
  EXPECT_EQ(first.report.keyHash[1], second.report.keyHash[1]);
  EXPECT_EQ(first.report.terminals, second.report.terminals);
  EXPECT_GT(first.report.terminals, 0u);
}

TEST_F(SpawnTest, AxiomsAreAsManyAsTheGpuHasCounted) {
  const auto words = bake(ownGrammar("building.pga"));
  const std::vector<GpgpAxiom> all = axioms(20, 13, 19, 11);
  for (const bool sorted : {false, true})
    for (const uint32_t counted : {0u, 1u, 7u, 20u, 23u}) {
      Derived gpu = run(words, all, 50000, sorted, counted);
      const uint32_t beyond = counted > 20 ? counted - 20 : 0;
      EXPECT_EQ(gpu.report.droppedShapes, beyond);
      EXPECT_EQ(gpu.report.base.status, beyond ? GPGP_BUDGET_EXCEEDED : GPGP_SUCCESS);
      gpu.report.droppedShapes = 0;
      gpu.report.base.status = GPGP_SUCCESS;
      const std::vector<GpgpAxiom> there(all.begin(), all.begin() + (counted - beyond));
      compare(spawn::derive(words, there), gpu, std::to_string(counted) + (sorted ? " axioms, sorted" : " axioms"));
      uint32_t drawn = 0;
      for (const auto& draw : gpu.draws) drawn += sorted ? draw.instanceCount : 0;
      EXPECT_EQ(drawn, sorted ? gpu.count : 0);
    }
}

TEST_F(SpawnTest, AxiomsOfTheCpuEqualThoseOfABuffer) {
  GpgpSpawnerCreateInfo budgets{};
  budgets.maxHostAxioms = 20;
  makeSpawner(budgets);
  const auto words = linked({{"building.pga", ownGrammar("building.pga")}, {"tree.pga", ownGrammar("tree.pga")}});
  const spawn::Graph graph = graphOf(words);
  std::vector<GpgpAxiom> all = axioms(20, 13, 19, 11);
  for (uint32_t i = 0; i < all.size(); ++i) all[i].start = i % spawn::startCount(graph);
  for (const bool sorted : {false, true}) {
    compare(spawn::derive(words, all), run(words, all, 50000, sorted, {}, true), "20 axioms of the CPU");
    const std::vector<GpgpAxiom> some(all.begin(), all.begin() + 7);
    compare(spawn::derive(words, some), run(words, some, 50000, sorted, {}, true), "7 axioms of the CPU");
    compare(spawn::derive(words, some), run(words, all, 50000, sorted, 7, true), "20 of the CPU, 7 counted by the GPU");
  }
  compare(spawn::derive(words, all), run(words, all, 50000, true), "a buffer, in a spawner for axioms of the CPU");
}

TEST_F(SpawnTest, SlicesOfAxiomsSumUpToOneRecord) {
  const auto words = bake(ownGrammar("building.pga"));
  const std::vector<GpgpAxiom> all = axioms(61, 13, 19, 11);
  const spawn::Derivation whole = spawn::derive(words, all);
  GpgpSpawnerCreateInfo budgets{};
  budgets.maxHostAxioms = 24;
  makeSpawner(budgets);
  const GpgpAsset grammar = makeGrammar(words);
  const auto axiomBuffer = host::makeBuffer(device, all, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const host::Buffer instances(device, 50000 * sizeof(GpgpInstance), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  constexpr uint32_t kSlice = 24; // 24 axioms are a multiple of every device's alignment of offsets
  for (const bool fromHost : {false, true}) {
    const GpgpFrame f = advance();
    uint32_t records = 0;
    device.submitAndWait([&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordUpload(context, cmd, &f, 0, nullptr), GPGP_SUCCESS);
      for (uint32_t first = 0; first < all.size(); first += kSlice, ++records) {
        GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
        info.grammar = grammar;
        info.axiomCount = std::min(kSlice, static_cast<uint32_t>(all.size()) - first);
        std::vector<GpgpAxiom> copied(all.begin() + first, all.begin() + first + info.axiomCount);
        if (fromHost) {
          info.hostAxioms = copied.data();
        } else {
          info.axioms = axiomBuffer.range();
          info.axioms.offset += first * sizeof(GpgpAxiom);
          info.axioms.size = info.axiomCount * sizeof(GpgpAxiom);
        }
        info.instances = instances.range();
        EXPECT_EQ(gpgpRecordPrepareSpawn(spawner, cmd, &f, &info), GPGP_SUCCESS);
        std::fill(copied.begin(), copied.end(), GpgpAxiom{}); // the record has a copy
      }
    });
    advance();
    EXPECT_EQ(records, 3u);
    uint32_t terminals = 0, keyHash[2] = {};
    for (uint32_t i = 0; i < records; ++i) {
      GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
      ASSERT_EQ(gpgpGetSpawnReport(spawner, &report), GPGP_SUCCESS);
      EXPECT_EQ(report.base.status, GPGP_SUCCESS);
      EXPECT_LT(report.terminals, whole.terminals);
      terminals += report.terminals;
      for (int w = 0; w < 2; ++w) keyHash[w] += report.keyHash[w];
    }
    EXPECT_EQ(terminals, whole.terminals);
    EXPECT_EQ(keyHash[0], whole.keyHash[0]);
    EXPECT_EQ(keyHash[1], whole.keyHash[1]);
  }
  gpgpDestroyAsset(grammar);
}

TEST_F(SpawnTest, AxiomsOfTheCpuStayWithinTheirBudget) {
  GpgpSpawnerCreateInfo budgets{};
  budgets.maxHostAxioms = 20;
  makeSpawner(budgets);
  const GpgpAsset grammar = makeGrammar(bake(ownGrammar("building.pga")));
  const std::vector<GpgpAxiom> all = axioms(21, 13, 19, 11);
  const auto axiomBuffer = host::makeBuffer(device, all, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const host::Buffer instances(device, sizeof(GpgpInstance), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const GpgpFrame f = advance();
  device.submitAndWait([&](VkCommandBuffer cmd) {
    EXPECT_EQ(gpgpRecordUpload(context, cmd, &f, 0, nullptr), GPGP_SUCCESS);
    GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
    info.grammar = grammar;
    info.hostAxioms = all.data();
    info.axiomCount = 21;
    info.instances = instances.range();
    EXPECT_EQ(gpgpRecordPrepareSpawn(spawner, cmd, &f, &info), GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(lastMessage(),
              "gpgpRecordPrepareSpawn: axiomCount is 21, of hostAxioms; the spawner was made with maxHostAxioms 20");
    info.axiomCount = 20;
    info.axioms = axiomBuffer.range();
    EXPECT_EQ(gpgpRecordPrepareSpawn(spawner, cmd, &f, &info), GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(lastMessage(), "gpgpRecordPrepareSpawn: both hostAxioms and axioms.buffer are set");
    info.hostAxioms = nullptr;
    info.axioms = {};
    EXPECT_EQ(gpgpRecordPrepareSpawn(spawner, cmd, &f, &info), GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(lastMessage(), "gpgpRecordPrepareSpawn: axioms.buffer and hostAxioms are NULL, axiomCount is 20");
  });
  GpgpSpawnerCreateInfo tooMany = GPGP_SPAWNER_CREATE_INFO_INIT;
  tooMany.base.queueFamily = device.graphics().family;
  tooMany.maxHostAxioms = (1u << 24) + 1;
  GpgpRecorder none = nullptr;
  EXPECT_EQ(gpgpCreateSpawner(context, &tooMany, &none), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(lastMessage(), "gpgpCreateSpawner: maxHostAxioms is at most 16777216");
  messages.clear();
  gpgpDestroyAsset(grammar);
}

TEST_F(SpawnTest, NoAxiomsGiveNothing) {
  const Derived none = run(bake(ownGrammar("building.pga")), {}, 10, true);
  EXPECT_EQ(none.report.base.status, GPGP_SUCCESS);
  EXPECT_EQ(none.report.terminals, 0u);
  EXPECT_EQ(none.report.rounds, 0u);
  for (const auto& draw : none.draws) EXPECT_EQ(draw.instanceCount, 0u);
}

TEST_F(SpawnTest, HundredsOfThousandsOfShapesEqualTheEvaluator) {
  // Long loops over a queue are where software devices give up silently: every shape must still be counted.
  const std::vector<uint32_t> words = bake("axiom Box A; terminal T (1, 0);\n"
                                           "A = Translate(1, 0, 0) Rotate(0, 10, 0) Scale(-0.9, -1, -1) "
                                           "Translate(0, 1, 0) Rotate(5, 0, 0) SubDiv(X) { -1: T | -1: T };\n");
  const std::vector<GpgpAxiom> many = axioms(120000, 1, 1, 1);
  makeSpawner({});
  const spawn::Derivation cpu = spawn::derive(words, many);
  ASSERT_EQ(cpu.terminals, 240000u);
  compare(cpu, run(words, many, 240000, true), "240 000 terminals");
}

TEST_F(SpawnTest, FewerInstancesThanTerminalsAreReported) {
  const auto words = bake(ownGrammar("building.pga"));
  const auto all = axioms(3, 13, 19, 11);
  const auto cpu = spawn::derive(words, all);
  for (const bool sorted : {true, false}) {
    const Derived gpu = run(words, all, 500, sorted);
    EXPECT_EQ(gpu.report.base.status, GPGP_BUDGET_EXCEEDED);
    EXPECT_EQ(gpu.report.terminals, cpu.terminals);
    EXPECT_EQ(gpu.report.instancesWritten, 500u);
    std::map<uint64_t, const GpgpInstance*> known;
    for (const GpgpInstance& i : cpu.instances) known[keyOf(i)] = &i;
    uint32_t drawn = 0;
    for (const GpgpInstance& i : gpu.instances) { // what is written is valid, once each
      ASSERT_EQ(known.count(keyOf(i)), 1u);
      ASSERT_EQ(known[keyOf(i)]->bucket, i.bucket);
      known.erase(keyOf(i));
    }
    if (sorted)
      for (uint32_t b = 0; b < gpu.draws.size(); ++b) {
        for (uint32_t i = 0; i < gpu.draws[b].instanceCount; ++i)
          ASSERT_EQ(gpu.instances[gpu.draws[b].firstInstance + i].bucket, b);
        drawn += gpu.draws[b].instanceCount;
      }
    EXPECT_EQ(drawn, sorted ? 500u : 0u);
  }
}

/// The evaluator's instances by bucket, key and axiom.
std::vector<GpgpInstance> ordered(std::vector<GpgpInstance> instances) {
  std::stable_sort(instances.begin(), instances.end(), [](const GpgpInstance& a, const GpgpInstance& b) {
    return std::tie(a.bucket, a.key[0], a.key[1]) < std::tie(b.bucket, b.key[0], b.key[1]);
  });
  return instances;
}
/// The same instances in the same places, of as many as there are.
void expectInOrder(const std::vector<GpgpInstance>& cpu, const std::vector<GpgpInstance>& gpu) {
  ASSERT_LE(gpu.size(), cpu.size());
  for (size_t i = 0; i < gpu.size(); ++i) {
    ASSERT_EQ(cpu[i].key[0], gpu[i].key[0]) << i;
    ASSERT_EQ(cpu[i].key[1], gpu[i].key[1]) << i;
    ASSERT_EQ(cpu[i].bucket, gpu[i].bucket) << i;
    ASSERT_EQ(cpu[i].axiomId, gpu[i].axiomId) << i;
    ASSERT_EQ(cpu[i].seed, gpu[i].seed) << i;
    ASSERT_EQ(cpu[i].rule, gpu[i].rule) << i;
    ASSERT_EQ(std::memcmp(cpu[i].size, gpu[i].size, sizeof cpu[i].size), 0) << i;
  }
}

TEST_F(SpawnTest, OrderedInstancesLieInOrder) {
  GpgpSpawnerCreateInfo budgets{};
  budgets.flags = GPGP_SPAWNER_ORDERED;
  makeSpawner(budgets);
  for (const std::string& name : ownGrammarNames()) {
    SCOPED_TRACE(name);
    const auto words = bake(ownGrammar(name));
    auto all = axioms(5, 12, 16, 10);
    const spawn::Derivation cpu = spawn::derive(words, all);
    const auto wanted = ordered(cpu.instances);
    const uint32_t capacity = static_cast<uint32_t>(cpu.terminals) + 10;
    const Derived sorted = run(words, all, capacity, true);
    compare(cpu, sorted, name);
    checkDraws(cpu, sorted);
    expectInOrder(wanted, sorted.instances);
    std::reverse(all.begin(), all.end()); // neither the order of axioms matters, nor draws
    const Derived plain = run(words, all, capacity, false);
    compare(cpu, plain, name);
    expectInOrder(wanted, plain.instances);
    if (HasFatalFailure()) return;
  }
  const Derived none = run(bake(ownGrammar("building.pga")), {}, 10, true);
  EXPECT_EQ(none.report.base.status, GPGP_SUCCESS);
  EXPECT_EQ(none.report.terminals, 0u);
}

TEST_F(SpawnTest, OrderedInstancesSurviveFromTheFront) {
  GpgpSpawnerCreateInfo budgets{};
  budgets.flags = GPGP_SPAWNER_ORDERED;
  makeSpawner(budgets);
  const auto words = bake(ownGrammar("building.pga"));
  const auto all = axioms(3, 13, 19, 11);
  const auto wanted = ordered(spawn::derive(words, all).instances);
  for (const uint32_t capacity : {1u, 63u, 64u, 500u, static_cast<uint32_t>(wanted.size()) - 1}) {
    const Derived gpu = run(words, all, capacity, true);
    EXPECT_EQ(gpu.report.base.status, GPGP_BUDGET_EXCEEDED);
    EXPECT_EQ(gpu.report.terminals, wanted.size());
    EXPECT_EQ(gpu.report.instancesWritten, capacity);
    expectInOrder(wanted, gpu.instances);
  }
}

TEST_F(SpawnTest, ManyOrderedInstancesAndEqualKeys) {
  GpgpSpawnerCreateInfo budgets{};
  budgets.flags = GPGP_SPAWNER_ORDERED;
  makeSpawner(budgets);
  const std::vector<uint32_t> words = bake(
      "axiom Box A; terminal S (1, 0); terminal T (1, 1); A = Repeat(X, 1, ADJUST_TO_FILL) SubDiv(Y) { -1: S | -1: "
      "B }; B = Replicate() { T | S };\n");
  const auto many = axioms(500, 200, 1, 1);
  const spawn::Derivation cpu = spawn::derive(words, many);
  ASSERT_EQ(cpu.terminals, 300000u);
  expectInOrder(ordered(cpu.instances), run(words, many, 300000, true).instances);

  // Axioms with the same seed and id have the same keys, and come in their order.
  std::vector<GpgpAxiom> alike(300, makeAxiom(1, 1, 1, 7, 7));
  for (size_t i = 0; i < alike.size(); ++i) alike[i].attribute = static_cast<float>(i);
  const Derived gpu = run(words, alike, 900, true);
  ASSERT_EQ(gpu.instances.size(), 900u);
  expectInOrder(ordered(spawn::derive(words, alike).instances), gpu.instances);
  for (size_t i = 1; i < gpu.instances.size(); ++i)
    if (keyOf(gpu.instances[i]) == keyOf(gpu.instances[i - 1])) {
      ASSERT_LT(gpu.instances[i - 1].attribute, gpu.instances[i].attribute) << i;
    }

  // More of them than are compared: all there, each once, by bucket.
  const std::vector<GpgpAxiom> crowd(3000, makeAxiom(1, 1, 1, 7, 7));
  const Derived all = run(words, crowd, 9000, true);
  EXPECT_EQ(all.report.base.status, GPGP_SUCCESS);
  checkDraws(spawn::derive(words, crowd), all);
}

TEST_F(SpawnTest, FewerTerminalRecordsAreReported) {
  GpgpSpawnerCreateInfo budgets{};
  budgets.maxTerminals = 300;
  makeSpawner(budgets);
  const auto words = bake(ownGrammar("building.pga"));
  const auto all = axioms(3, 13, 19, 11);
  const auto cpu = spawn::derive(words, all);
  const Derived gpu = run(words, all, 100000, true);
  EXPECT_EQ(gpu.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(gpu.report.terminals, cpu.terminals);
  EXPECT_EQ(gpu.report.keyHash[0], cpu.keyHash[0]);
  EXPECT_EQ(gpu.report.instancesWritten, 300u);
}

/// Of an axiom, two terminals for each unit of its length.
constexpr const char* kPairs =
    "axiom Box A; terminal T (1,0); A = Repeat(X,1,ADJUST_TO_FILL) B; B = Replicate() { T | T };";
std::vector<uint32_t> bakePairs() { return bake(kPairs); }

TEST_F(SpawnTest, ShapesThatDoNotFitAreCounted) {
  // Few axioms of many shapes: workgroups give work away, more than the queue holds. 32 and 128 copies are whole steps
  // of any workgroup, so that all are made before.
  GpgpSpawnerCreateInfo budgets{};
  budgets.maxShapes = 300;
  makeSpawner(budgets);
  const auto words = bakePairs();
  const auto exact = run(words, std::vector(8, makeAxiom(32, 1, 1)), 2000, true);
  EXPECT_EQ(exact.report.base.status, GPGP_SUCCESS);
  EXPECT_EQ(exact.report.terminals, 512u);
  EXPECT_LE(exact.report.peakShapes, 300u);
  if (device.isSoftware()) { // derives depth first, so that work piles up only where there are more levels
    const auto levels =
        bake("axiom Box A; terminal T (1,0); A = Repeat(X,1,ADJUST_TO_FILL) Repeat(Y,1,ADJUST_TO_FILL) B;"
             "B = Replicate() { T | T };");
    const auto some = run(levels, std::vector(8, makeAxiom(128, 128, 1)), 1000, true);
    EXPECT_EQ(some.report.base.status, GPGP_BUDGET_EXCEEDED);
    EXPECT_GT(some.report.peakShapes, 300u);
    EXPECT_GE(some.report.droppedShapes, some.report.peakShapes - 300);
    EXPECT_LT(some.report.terminals, 8u * 128 * 128 * 2);
    return;
  }
  const auto beyond = run(words, std::vector(8, makeAxiom(128, 1, 1)), 4000, true);
  EXPECT_EQ(beyond.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_GT(beyond.report.peakShapes, 300u);
  EXPECT_EQ(beyond.report.droppedShapes, beyond.report.peakShapes - 300);
  EXPECT_EQ(beyond.report.terminals, 2 * (8 * 128 - beyond.report.droppedShapes));
  EXPECT_EQ(beyond.instances.size(), beyond.report.terminals);
}

TEST_F(SpawnTest, DeeperShapesAreReported) {
  GpgpSpawnerCreateInfo budgets{};
  budgets.maxDepth = 5;
  makeSpawner(budgets);
  const auto words = bake("axiom Box A; terminal T (1,0); A = Replicate() { T | A | A };");
  spawn::DeriveOptions options;
  options.maxDepth = 5;
  const std::vector<GpgpAxiom> all = {makeAxiom(1, 1, 1)};
  const auto cpu = spawn::derive(words, all, options);
  EXPECT_EQ(cpu.terminals, 63u);
  EXPECT_EQ(cpu.unfinishedShapes, 64u);
  const Derived gpu = run(words, all, 1000, true);
  EXPECT_EQ(gpu.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(gpu.report.terminals, cpu.terminals);
  EXPECT_EQ(gpu.report.unfinishedShapes, cpu.unfinishedShapes);
  EXPECT_EQ(gpu.report.depth, 6u);
}

// Shapes double at every level and never end: what the budgets hold is derived, the rest counted.
TEST_F(SpawnTest, GrammarsThatNeverEndAreReported) {
  makeSpawner({});
  const auto words = bake("axiom Box A; terminal T (1,0); A = Replicate() { T | A | A };");
  const Derived gpu = run(words, std::vector(64, makeAxiom(1, 1, 1)), 1000, true);
  EXPECT_EQ(gpu.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_GT(gpu.report.terminals, 1000u);
  EXPECT_GT(gpu.report.unfinishedShapes + gpu.report.droppedShapes, 0u);
  EXPECT_EQ(gpu.report.instancesWritten, 1000u);
  // And the next recording is as it would be without it.
  const auto pairs = bakePairs();
  EXPECT_EQ(run(pairs, {makeAxiom(20, 1, 1)}, 1000, true).report.terminals, 40u);
}

TEST_F(SpawnTest, RoundsThatAreMissingAreReported) {
  makeSpawner({.maxRounds = 1});
  const auto words = bakePairs();
  // More than a workgroup derives in one round, whatever the device.
  const Derived gpu = run(words, {makeAxiom(600000, 1, 1)}, 1000, true);
  EXPECT_EQ(gpu.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(gpu.report.rounds, 1u);
  EXPECT_GT(gpu.report.droppedShapes, 0u);
  EXPECT_LT(gpu.report.terminals, 1200000u);
}

TEST_F(SpawnTest, RoundsCountedForSmallAxiomsLoseNothingOfLargeOnes) {
  makeSpawner({});
  for (const spawn::KernelTarget target : spawn::targetsOf(graphOf(bakePairs()))) {
    if (!takes(target)) continue;
    const Derived gpu = run(bakeFor(kPairs, target, {.rounds = 1}), {makeAxiom(20000, 1, 1)}, 1000, true);
    EXPECT_EQ(gpu.report.droppedShapes, 0u) << int(target);
    EXPECT_EQ(gpu.report.terminals, 40000u) << int(target);
  }
}

TEST_F(SpawnTest, TheLastRoundGivesNothingAwayByChoice) {
  makeSpawner({.maxRounds = 1});
  const auto words = bakePairs();
  const Derived gpu = run(words, {makeAxiom(384, 1, 1)}, 1000, true);
  EXPECT_EQ(gpu.report.base.status, GPGP_SUCCESS);
  EXPECT_EQ(gpu.report.droppedShapes, 0u);
  EXPECT_EQ(gpu.report.terminals, 768u);
}

TEST_F(SpawnTest, StacksThatFlowOverInTheLastRoundLoseNothing) {
  for (const uint32_t size : {8u, 32u}) { // a subgroup's on most devices
    // Devices that count turns of loops have so many for a workgroup in a round, and small ones derive less with them.
    const bool few = device.isSoftware() && size == 8;
    const auto axiomsOf = [](float x) {
      return std::vector<GpgpAxiom>{makeAxiom(x, 1, 1, 1, 1), makeAxiom(x / 2, 1, 1, 2, 2),
                                    makeAxiom(x / 2, 1, 1, 3, 3)};
    };
    const std::vector<GpgpAxiom> all = axiomsOf(few ? 10 : 20);
    // One workgroup, whose stack holds a batch.
    const auto words = bakeFor("axiom Box A; terminal T (1,0);"
                               "A = IfSizeLess(X,1) { T | Scale(-0.5,-1,-1) Replicate() { T | A | A | A } };",
                               spawn::KernelTarget::subgroups, {size, 1, 2 * size, 64});
    makeSpawner({.maxRounds = 1});
    check("workgroups of " + std::to_string(size), words, all);
    if (few) { // what there are no turns for is reported
      const Derived more = run(words, axiomsOf(40), 2000, true);
      EXPECT_EQ(more.report.base.status, GPGP_BUDGET_EXCEEDED);
      EXPECT_GT(more.report.droppedShapes, 0u);
    }
    makeSpawner({.maxShapes = size, .maxRounds = 1}); // where there is no room for that either
    const Derived gpu = run(words, all, 2000, true);
    EXPECT_EQ(gpu.report.base.status, GPGP_BUDGET_EXCEEDED);
    EXPECT_GT(gpu.report.droppedShapes, 0u);
  }
}

TEST_F(SpawnTest, StacksOfSoftwareDevicesThatFlowOverLoseNothing) {
  if (!device.isSoftware()) GTEST_SKIP() << "derive_batches.glsl is for software devices";
  // 3, 3, 3, 3, 3, 3, 2 and 2 children, made by twos: each level leaves some of eight shapes on the stack, 74 at most.
  std::string text = "axiom Box A; terminal T (1,0); A =";
  for (const char* copy : {"X,1", "Y,1", "Z,1", "X,0.333", "Y,0.333", "Z,0.333", "X,0.166", "Y,0.166"})
    text += std::string(" Repeat(") + copy + ",ADJUST_TO_FILL)";
  const auto words = bakeFor(text + " T;", spawn::KernelTarget::software, {8, 1, 128, 64});
  const std::vector<GpgpAxiom> all = {makeAxiom(3, 3, 3)};
  makeSpawner({.maxRounds = 1});
  check("one workgroup and round", words, all);
  makeSpawner({.maxShapes = 8, .maxRounds = 1});
  const Derived gpu = run(words, all, 10000, true);
  EXPECT_EQ(gpu.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_GT(gpu.report.droppedShapes, 0u);
}

TEST_F(SpawnTest, WorkgroupsThatGiveUpLoseNothing) {
  // One axiom of very many shapes and one that multiplies for ever, so that steps run out in the middle of a batch.
  const auto words = bake("axiom Box A; terminal T (1,0); A = Repeat(X,1,ADJUST_TO_FILL) Replicate() { T | T | B };"
                          "B = Repeat(Y,0.01,ADJUST_TO_FILL) T;");
  check("many", words, {makeAxiom(300, 1, 1, 1, 1), makeAxiom(5, 90, 1, 2, 2), makeAxiom(1, 1000, 1, 3, 3)});
}

TEST_F(SpawnTest, RepeatsOfTooManyCopiesAreDroppedAndCounted) {
  const std::string text =
      "axiom Box A; terminal T (1,0); A = SubDiv(X) { 1: Repeat(Y,0.0000001,ANCHOR_TO_END) T | -1: "
      "Repeat(Y,0.5,ADJUST_TO_FILL) Repeat(Z,Exp(ShapeSeed()/5000000),ADJUST_TO_FILL) T | 1: T };";
  const std::vector<GpgpAxiom> axioms{makeAxiom(3, 1, 1, 5, 1), makeAxiom(3, 1, 1, 6, 2)};
  for (const bool kernel : {false, true}) {
    const auto words = kernel ? bakeKernel(text) : bake(text);
    const Derived gpu = run(words, axioms, 100, true);
    EXPECT_EQ(gpu.report.terminals, 2u);
    EXPECT_EQ(gpu.report.droppedShapes, 6u);
    EXPECT_EQ(gpu.report.droppedShapes, spawn::derive(words, axioms).droppedShapes);
    EXPECT_EQ(gpu.report.base.status, GPGP_BUDGET_EXCEEDED);
  }
}

TEST_F(SpawnTest, ARepeatMakesAsManyCopiesAsItMay) { // within the rounds that a record has by default
  const std::string text =
      "axiom Box A; terminal T (1,0); A = Repeat(X,-0.00000095367431640625,ADJUST_TO_FILL) T;"; // 2^-20
  for (const bool kernel : {false, true}) {
    const Derived gpu = run(kernel ? bakeKernel(text) : bake(text), {makeAxiom(1, 1, 1)}, 1u << 20, false);
    EXPECT_EQ(gpu.report.terminals, 1u << 20);
    EXPECT_EQ(gpu.report.base.status, GPGP_SUCCESS);
    EXPECT_EQ(gpu.report.droppedShapes, 0u);
    EXPECT_EQ(gpu.report.instancesWritten, gpu.report.terminals);
    std::vector<uint64_t> keys;
    for (const GpgpInstance& i : gpu.instances) keys.push_back(keyOf(i));
    std::sort(keys.begin(), keys.end());
    EXPECT_EQ(std::unique(keys.begin(), keys.end()), keys.end()); // each copy once
  }
}

TEST_F(SpawnTest, ChildrenOfOneShapeAreSharedOut) { // whatever their number, each is made once, and others behind them
  const std::string text = "axiom Box A; terminal T (1,0); terminal U (1,1);"
                           "A = Repeat(X,1,ADJUST_TO_FILL) SubDiv(Z) { -1: T | -1: B | -1: Discard() };"
                           "B = Repeat(Y,0.25,ANCHOR_TO_END) IfSizeLess(Y,0.2) { U | T };";
  for (const bool kernel : {false, true}) {
    const auto words = kernel ? bakeKernel(text) : bake(text);
    for (const uint32_t count : {1u, 3u, 9u})
      for (const float copies : {1.0f, 17.0f, 300.0f}) {
        std::vector<GpgpAxiom> all;
        for (uint32_t i = 0; i < count; ++i) all.push_back(makeAxiom(copies + float(i), 4.1f + float(i), 3, i + 1, i));
        check(std::to_string(count) + " axioms of " + std::to_string(copies), words, all);
      }
  }
}

TEST_F(SpawnTest, StartRulesAndRulesThatDoNotExist) {
  const auto words = bake("axiom Box A; terminal T (1,0); A = Replicate() { T | B }; B = Replicate() { T | T | T };");
  std::vector<GpgpAxiom> all(4, makeAxiom(1, 1, 1));
  all[1].start = 1;
  all[2].start = 2; // the axiom line
  all[3].start = 3;
  const Derived gpu = run(words, all, 100, true);
  EXPECT_EQ(gpu.report.terminals, 4u + 3u + 4u);
  EXPECT_EQ(gpu.report.droppedShapes, 1u);
  EXPECT_EQ(gpu.report.base.status, GPGP_BUDGET_EXCEEDED);
}

TEST_F(SpawnTest, LinkedGrammarsEqualTheEvaluator) { // which derives what each does alone, see link_test.cpp
  std::vector<GrammarFile> files;
  for (const std::string& name : ownGrammarNames()) files.push_back({name, ownGrammar(name)});
  files.push_back({"lines.pga", "axiom Hexagon Faces; axiom Box Faces; axiom DynamicRightPrism{(0,0.5),(-0.5,-0.5),"
                                "(0.5,0)} Part; axiom Quad T; terminal T (1,0); terminal U (1,1);"
                                "Faces = CompSplit() { T | U | Part }; Part = SubDiv(X) { -1: Tall | -2: U };"
                                "Tall = Extrude(3) CompSplit() { T | Discard() | U };"});
  for (const GpgpCompileFlags flags : {GpgpCompileFlags(0), GPGP_COMPILE_KERNEL}) {
    const auto words = linked(files, flags);
    const size_t graphWords = words[shader::kHeaderWords];
    const auto graph = spawn::load(std::as_bytes(std::span(words).first(graphWords)), std::pmr::new_delete_resource());
    ASSERT_TRUE(graph);
    const auto lines = static_cast<uint32_t>(graph->axioms.size());
    ASSERT_EQ(lines, ownGrammarNames().size() + 4);
    auto all = axioms(60, 12, 16, 10);
    for (uint32_t i = 0; i < all.size(); ++i) { // all starts, the axiom lines more often
      const uint32_t rules = static_cast<uint32_t>(graph->rules.size());
      all[i].start = i % 2 ? rules + i / 2 % lines : i / 2 % rules;
    }
    check(flags ? "linked, by a kernel" : "linked", words, all);
  }
}

TEST_F(SpawnTest, StartsCanBeListedAndFound) {
  const auto words = linked({{"house.pga", "axiom Box House; axiom Quad Wall; terminal T (1,0);"
                                           "House = CompSplit() Wall; Wall = T; Rest = House;"},
                             {"tree.pga", "axiom Sphere Leaf; terminal Leaf (1,0);"}});
  const GpgpAsset grammar = makeGrammar(words);
  uint32_t count = 0;
  ASSERT_EQ(gpgpGetGrammarStarts(grammar, &count, nullptr), GPGP_SUCCESS);
  std::vector<GpgpGrammarStart> starts(count);
  ASSERT_EQ(gpgpGetGrammarStarts(grammar, &count, starts.data()), GPGP_SUCCESS);
  const std::vector<std::tuple<std::string, GpgpShape, uint32_t>> wanted{
      {"house.House", GPGP_SHAPE_BOX, 0}, {"house.Wall", GPGP_SHAPE_QUAD, 0}, {"house.Rest", GPGP_SHAPE_BOX, 0},
      {"house", GPGP_SHAPE_BOX, 1},       {"house.Wall", GPGP_SHAPE_QUAD, 1}, {"tree", GPGP_SHAPE_SPHERE, 1}};
  ASSERT_EQ(count, wanted.size());
  for (uint32_t i = 0; i < count; ++i)
    EXPECT_EQ(std::tuple(std::string(starts[i].name), starts[i].shape, starts[i].axiomLine), wanted[i]);
  const auto find = [&](const char* name) {
    uint32_t rule = 99;
    EXPECT_EQ(gpgpFindGrammarStart(grammar, name, &rule), GPGP_SUCCESS);
    return rule;
  };
  EXPECT_EQ(find("house.Wall"), 1u);
  EXPECT_EQ(find("house"), 3u);
  EXPECT_EQ(find("tree"), 5u);
  uint32_t rule = 99;
  EXPECT_EQ(gpgpFindGrammarStart(grammar, "Wall", &rule), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(rule, 99u);
  EXPECT_EQ(gpgpFindGrammarStart(grammar, nullptr, &rule), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpGetGrammarStarts(grammar, nullptr, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  count = 2;
  EXPECT_EQ(gpgpGetGrammarStarts(grammar, &count, starts.data()), GPGP_INCOMPLETE);
  EXPECT_EQ(count, wanted.size());
  ASSERT_FALSE(messages.empty());
  EXPECT_EQ(messages[0], "gpgpFindGrammarStart: the grammar has no start \"Wall\"");
  messages.clear();
  gpgpDestroyAsset(grammar);
}

TEST_F(SpawnTest, GrammarsTakeTurnsInOneFrame) {
  // The same spawner, several grammars and outputs in one command buffer: records share scratch, not results.
  const char* names[] = {"building.pga", "tree.pga", "sponge.pga", "building.pga"};
  const auto all = axioms(5, 12, 16, 10);
  std::vector<GpgpAsset> grammars;
  std::vector<host::Buffer> outputs;
  const auto axiomBuffer = host::makeBuffer(device, all, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const GpgpFrame f = advance();
  device.submitAndWait([&](VkCommandBuffer cmd) {
    for (const char* name : names) {
      const auto words = bake(ownGrammar(name));
      GpgpGrammarCreateInfo info = GPGP_GRAMMAR_CREATE_INFO_INIT;
      info.data = words.data();
      info.size = words.size() * 4;
      ASSERT_EQ(gpgpCreateGrammar(context, &info, &grammars.emplace_back()), GPGP_SUCCESS);
      outputs.emplace_back(device, 50000 * sizeof(GpgpInstance), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    }
    ASSERT_EQ(gpgpRecordUpload(context, cmd, &f, 0, nullptr), GPGP_SUCCESS);
    for (size_t i = 0; i < grammars.size(); ++i) {
      GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
      info.base.tag = i;
      info.grammar = grammars[i];
      info.axioms = axiomBuffer.range();
      info.axiomCount = static_cast<uint32_t>(all.size());
      info.instances = outputs[i].range();
      ASSERT_EQ(gpgpRecordPrepareSpawn(spawner, cmd, &f, &info), GPGP_SUCCESS);
    }
  });
  advance();
  for (size_t i = 0; i < grammars.size(); ++i) {
    const auto cpu = spawn::derive(bake(ownGrammar(names[i])), all);
    Derived gpu;
    ASSERT_EQ(gpgpGetSpawnReport(spawner, &gpu.report), GPGP_SUCCESS);
    EXPECT_EQ(gpu.report.base.tag, i);
    gpu.instances = host::download<GpgpInstance>(device, outputs[i], gpu.report.instancesWritten);
    compare(cpu, gpu, names[i]);
    gpgpDestroyAsset(grammars[i]);
  }
}

TEST_F(SpawnTest, ThePassesAreTheDocumentedOnes) {
  std::ifstream file(GPGP_TEST_DATA "/../../docs/internals/spawn.md");
  std::ostringstream text;
  text << file.rdbuf();
  static const GpgpVertexLayout layout{12, 1, {{GPGP_VERTEX_POSITION, VK_FORMAT_R32G32B32_SFLOAT, 0}}};
  for (const GpgpVertexLayout* vertices : {static_cast<const GpgpVertexLayout*>(nullptr), &layout}) {
    makeSpawner({.flags = GPGP_SPAWNER_ORDERED, .vertices = vertices, .maxColliders = 16});
    uint32_t count = 0;
    ASSERT_EQ(gpgpGetPasses(spawner, &count, nullptr), GPGP_SUCCESS);
    std::vector<const char*> names(count);
    ASSERT_EQ(gpgpGetPasses(spawner, &count, names.data()), GPGP_SUCCESS);
    for (const char* name : names)
      EXPECT_NE(text.str().find(std::string("`") + name + "`"), std::string::npos)
          << name << " is not in docs/internals/spawn.md";
  }
}

TEST_F(SpawnTest, TerminalsCanBeListed) {
  const auto words = bake(ownGrammar("building.pga"));
  const GpgpAsset grammar = makeGrammar(words);
  uint32_t count = 0;
  ASSERT_EQ(gpgpGetGrammarTerminals(grammar, &count, nullptr), GPGP_SUCCESS);
  std::vector<GpgpGrammarTerminal> terminals(count);
  ASSERT_EQ(gpgpGetGrammarTerminals(grammar, &count, terminals.data()), GPGP_SUCCESS);
  ASSERT_EQ(count, 15u);
  EXPECT_STREQ(terminals[0].name, "Wall");
  EXPECT_STREQ(terminals[10].name, "RoofFlat");
  EXPECT_EQ(terminals[10].bucket, 10u);
  EXPECT_STREQ(terminals[13].name, "Chimney");
  EXPECT_STREQ(terminals[14].name, "Tank"); // one line, one bucket
  EXPECT_EQ(terminals[13].bucket, 13u);
  EXPECT_EQ(terminals[14].bucket, 13u);
  count = 3;
  EXPECT_EQ(gpgpGetGrammarTerminals(grammar, &count, terminals.data()), GPGP_INCOMPLETE);
  EXPECT_EQ(count, 15u);
  gpgpDestroyAsset(grammar);
}

TEST_F(SpawnTest, BadGrammarsAreRefusedWithAReason) {
  auto words = bake(ownGrammar("sponge.pga"));
  words[50] ^= 4;
  GpgpGrammarCreateInfo info = GPGP_GRAMMAR_CREATE_INFO_INIT;
  info.data = words.data();
  info.size = words.size() * 4;
  GpgpAsset grammar = nullptr;
  EXPECT_EQ(gpgpCreateGrammar(context, &info, &grammar), GPGP_ERROR_INVALID_DATA);
  EXPECT_EQ(grammar, nullptr);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0], "gpgpCreateGrammar: not a baked grammar: its checksum is wrong");
  messages.clear();
}

} // namespace
