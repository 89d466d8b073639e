// libgpgp_evaluator through its C functions: against the GPU, for every number of ranges, and what it refuses.
#include "grammars.h"
#include "host/files.h"
#include "random_grammar.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/graph/blob.h"
#include "spawn_device.h"

#include <gpgp/evaluator.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <sstream>
#include <thread>

namespace {
using namespace gpgp;
using namespace gpgp::test;

// ---------------------------------------------------------------- what engines bring

/// Jobs on threads that take them in an order that differs from run to run.
void GPGP_CALL runOnThreads(void*, uint32_t count, GpgpJobFn job, void* argument) {
  std::atomic<uint32_t> next{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 3; ++t)
    threads.emplace_back([&] {
      for (uint32_t i; (i = next++) < count;) job(argument, count - 1 - i);
    });
  for (std::thread& thread : threads) thread.join();
}
constexpr GpgpJobSystem kJobs{nullptr, runOnThreads};

/// Counts what is allocated, and fails from an allocation on.
struct Heap {
  std::atomic<int64_t> bytes{0};
  std::atomic<uint32_t> allocations{0};
  uint32_t failsAt = UINT32_MAX;
  GpgpHostAllocator callbacks{this, allocate, free};

  static void* GPGP_CALL allocate(void* user, size_t size, size_t alignment) {
    Heap& heap = *static_cast<Heap*>(user);
    if (heap.allocations++ >= heap.failsAt) return nullptr;
    heap.bytes += static_cast<int64_t>(size);
    return ::operator new(size, std::align_val_t(alignment));
  }
  static void GPGP_CALL free(void* user, void* memory, size_t size, size_t alignment) {
    static_cast<Heap*>(user)->bytes -= static_cast<int64_t>(size);
    ::operator delete(memory, std::align_val_t(alignment));
  }
};

struct Messages {
  std::vector<std::string> texts;
  static void GPGP_CALL receive(void* user, const GpgpMessage* message) {
    static_cast<Messages*>(user)->texts.push_back(std::string(message->function) + ": " + message->text);
  }
  static void GPGP_CALL compiled(void* user, const GpgpCompileMessage* message) {
    static_cast<Messages*>(user)->texts.push_back(std::to_string(message->line) + ":" +
                                                  std::to_string(message->column) + ": " + message->text);
  }
};

/// The text must outlive the source.
GpgpGrammarSource textSource(const std::string& text) {
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  source.name = "test.pga";
  source.text = text.data();
  source.size = text.size();
  return source;
}
GpgpGrammarSource bakedSource(const std::vector<uint32_t>& words) {
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  source.name = "test.gpgp";
  source.baked = words.data();
  source.size = words.size() * 4;
  return source;
}
gpgp::Evaluator makeEvaluator(const GpgpGrammarSource& source, bool jobs = true,
                              const GpgpHostAllocator* allocator = nullptr) {
  auto info = init<GpgpEvaluatorCreateInfo>();
  info.sources = &source;
  info.sourceCount = 1;
  info.jobSystem = jobs ? &kJobs : nullptr;
  info.hostAllocator = allocator;
  auto evaluator = gpgp::Evaluator::create(info);
  EXPECT_TRUE(evaluator) << evaluator.name();
  return std::move(*evaluator);
}

std::vector<GpgpAxiom> axiomsOf(uint32_t count, float x, float y, float z) {
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < count; ++i) {
    GpgpAxiom axiom = spawn::makeAxiom(x, y + float(i % 3), z, i + 1, 100 + i);
    const float angle = 0.37f * float(i);
    axiom.transform[0] = axiom.transform[10] = std::cos(angle);
    axiom.transform[2] = std::sin(angle);
    axiom.transform[8] = -std::sin(angle);
    axiom.transform[3] = 1.1f * (x + 2) * float(i % 4);
    axiom.transform[11] = 1.1f * (z + 2) * float(i / 4);
    axioms.push_back(axiom);
  }
  return axioms;
}

/// All kept instances, by axiom.
std::vector<GpgpInstance> allOf(const GpgpEvaluationResult& result) {
  std::vector<GpgpInstance> all;
  for (uint32_t a = 0; a < result.axiomCount; ++a)
    all.insert(all.end(), result.axioms[a].instances, result.axioms[a].instances + result.axioms[a].instanceCount);
  return all;
}

/// The same set but for the last bits of transforms: the worst element of any of them in units of its scale.
float expectSameSet(std::vector<GpgpInstance> a, std::vector<GpgpInstance> b, const std::string& what) {
  EXPECT_EQ(a.size(), b.size()) << what;
  if (a.size() != b.size()) return 1;
  // Equal keys with equal words have equal transforms but for rounding, which their rounded places do not order by.
  const auto less = [](const GpgpInstance& l, const GpgpInstance& r) {
    if (const int order = std::memcmp(&l.bucket, &r.bucket, sizeof l - sizeof l.transform)) return order < 0;
    for (int i = 0; i < 12; ++i)
      if (std::abs(l.transform[i] - r.transform[i]) > 1e-3f) return l.transform[i] < r.transform[i];
    return false;
  };
  std::sort(a.begin(), a.end(), less);
  std::sort(b.begin(), b.end(), less);
  float worst = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(std::memcmp(&a[i].bucket, &b[i].bucket, sizeof a[i] - sizeof a[i].transform), 0) << what << ", " << i;
    float scale = 1;
    for (const float v : a[i].transform) scale = std::max(scale, std::abs(v));
    for (int e = 0; e < 12; ++e) worst = std::max(worst, std::abs(a[i].transform[e] - b[i].transform[e]) / scale);
    if (testing::Test::HasFailure()) break;
  }
  EXPECT_LE(worst, 1e-4f) << what;
  return worst;
}

GpgpEvaluationResult derive(gpgp::Evaluation& evaluation, const std::vector<GpgpAxiom>& axioms, uint32_t ranges = 0,
                            GpgpEvaluationInfo info = init<GpgpEvaluationInfo>()) {
  info.axioms = axioms.data();
  info.axiomCount = static_cast<uint32_t>(axioms.size());
  info.rangeCount = ranges;
  EXPECT_EQ(evaluation.derive(info), GPGP_SUCCESS);
  return *evaluation.result();
}

/// Every bit of two results.
void expectEqual(const GpgpEvaluationResult& a, const GpgpEvaluationResult& b, size_t stride, const std::string& what) {
  ASSERT_EQ(a.axiomCount, b.axiomCount) << what;
  EXPECT_EQ(a.status, b.status) << what;
  EXPECT_EQ(a.terminals, b.terminals) << what;
  EXPECT_EQ(a.shapes, b.shapes) << what;
  EXPECT_EQ(a.colliders, b.colliders) << what;
  EXPECT_EQ(a.indexCount, b.indexCount) << what;
  EXPECT_EQ(std::memcmp(a.keyHash, b.keyHash, 8), 0) << what;
  for (uint32_t i = 0; i < a.axiomCount; ++i) {
    const GpgpEvaluatedAxiom &l = a.axioms[i], &r = b.axioms[i];
    ASSERT_EQ(l.instanceCount, r.instanceCount) << what << ", axiom " << i;
    if (l.instanceCount) {
      ASSERT_EQ(std::memcmp(l.instances, r.instances, l.instanceCount * sizeof(GpgpInstance)), 0)
          << what << ", axiom " << i;
    }
    ASSERT_EQ(l.vertexCount, r.vertexCount) << what << ", axiom " << i;
    if (l.vertexCount) {
      ASSERT_EQ(std::memcmp(l.vertices, r.vertices, l.vertexCount * stride), 0) << what << ", axiom " << i;
    }
    ASSERT_EQ(std::memcmp(&l.bounds, &r.bounds, sizeof l.bounds), 0) << what << ", axiom " << i;
    ASSERT_EQ(l.status, r.status) << what << ", axiom " << i;
    ASSERT_EQ(l.shapes, r.shapes) << what << ", axiom " << i;
    ASSERT_EQ(l.keyHash[0], r.keyHash[0]) << what << ", axiom " << i;
  }
}

struct Sample {
  std::string name, text;
  float x, y, z;
};
/// samples/grammars/cases.txt
std::vector<Sample> samples() {
  std::vector<Sample> all;
  std::istringstream lines(host::readText(GPGP_SAMPLE_GRAMMARS "/cases.txt"));
  for (std::string line; std::getline(lines, line);) {
    Sample sample;
    uint32_t axioms = 0;
    std::istringstream fields(line);
    if (line.empty() || line[0] == '#' || !(fields >> sample.name >> axioms >> sample.x >> sample.y >> sample.z))
      continue;
    sample.text = host::readText(GPGP_SAMPLE_GRAMMARS "/" + sample.name + ".pga");
    all.push_back(sample);
  }
  return all;
}

constexpr GpgpVertexLayout kLayout{32,
                                   5,
                                   {{GPGP_VERTEX_POSITION, VK_FORMAT_R32G32B32_SFLOAT, 0},
                                    {GPGP_VERTEX_NORMAL, VK_FORMAT_R8G8B8A8_SNORM, 12},
                                    {GPGP_VERTEX_UV, VK_FORMAT_R32G32_SFLOAT, 16},
                                    {GPGP_VERTEX_TERMINAL, VK_FORMAT_R32_UINT, 24},
                                    {GPGP_VERTEX_AXIOM_ID, VK_FORMAT_R32_UINT, 28}}};

/// A wood of trees that do not grow into houses, in three phases.
const char* const kWood = R"(axiom Box Lot;
terminal Wall Trunk Lamp Leaf (1, 0);
Lot = Replicate() { House | Tree | Light };
House = Scale(2.4, 2.5, 2.4) Collider(1) Wall;
Tree = Translate(Rand(-9, 9), 0, Rand(-9, 9)) Scale(0.8, 5, 0.8) IfCollides(1) { Discard() | Collider(2) Trunk };
Light = Translate(Rand(-9, 9), 0, Rand(-9, 9)) Scale(0.4, 2.5, 0.4) IfCollides(2) { Discard() | Lamp };
)";

// ---------------------------------------------------------------- tests

TEST(EvaluationTest, SamplesEqualTheGpu) {
  SpawnDevice device({.maxColliders = 8192});
  size_t instances = 0;
  float worst = 0;
  for (const Sample& sample : samples()) {
    const auto evaluator = makeEvaluator(textSource(sample.text)); // from the text itself
    auto evaluation = std::move(*evaluator.evaluation());
    const auto axioms =
        axiomsOf(sample.name == "tree_8_3" || sample.name == "tree_12_2" ? 1 : 5, sample.x, sample.y, sample.z);
    const auto result = derive(evaluation, axioms, 3);
    std::vector<GpgpInstance> gpu;
    const auto report = device.derive(bake(sample.text), axioms, static_cast<uint32_t>(result.terminals), &gpu);
    EXPECT_EQ(report.terminals, result.terminals) << sample.name;
    EXPECT_EQ(std::memcmp(report.keyHash, result.keyHash, 8), 0) << sample.name;
    EXPECT_EQ(report.droppedShapes, result.droppedShapes) << sample.name;
    EXPECT_EQ(report.depth, result.depth) << sample.name;
    worst = std::max(worst, expectSameSet(allOf(result), gpu, sample.name));
    instances += gpu.size();
    ASSERT_FALSE(HasFailure());
  }
  EXPECT_GT(instances, 30000u);
  std::printf("%zu instances; the worst element of a transform differs by %.2g\n", instances, double(worst));
}

TEST(EvaluationTest, RandomGrammarsEqualTheGpuInAnyNumberOfRanges) {
  SpawnDevice device({.maxColliders = 8192});
  uint32_t checked = 0, colliding = 0;
  for (uint32_t seed = 1000; checked < 60; ++seed) {
    const std::string text = randomGrammar(seed), what = "seed " + std::to_string(seed) + "\n" + text;
    const auto words = bake(text);
    const auto axioms = axiomsOf(2 + seed % 9, 6, 9, 7);
    const auto known = spawn::derive(words, axioms, {.maxShapes = 20000});
    if (!known.complete || known.terminals < 5 || known.colliders > 8192) continue;
    ++checked;
    colliding += known.colliders > 0;
    const auto evaluator = makeEvaluator(bakedSource(words));
    auto evaluation = std::move(*evaluator.evaluation());
    std::vector<GpgpInstance> gpu;
    const auto report = device.derive(words, axioms, static_cast<uint32_t>(known.terminals), &gpu);
    auto info = init<GpgpEvaluationInfo>();
    info.vertices = &kLayout;
    info.flags = GPGP_EVALUATION_BOUNDS;
    const auto one = derive(evaluation, axioms, 1, info);
    EXPECT_EQ(one.terminals, report.terminals) << what;
    EXPECT_EQ(one.colliders, report.colliders) << what;
    EXPECT_EQ(one.unfinishedShapes, report.unfinishedShapes) << what;
    EXPECT_EQ(std::memcmp(report.keyHash, one.keyHash, 8), 0) << what;
    expectSameSet(allOf(one), gpu, what);
    for (const uint32_t ranges : {2u, 7u, 0u}) {
      auto other = std::move(*evaluator.evaluation());
      expectEqual(one, derive(other, axioms, ranges, info), kLayout.stride, what);
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(colliding, 5u);
}

TEST(EvaluationTest, SamplesAreTheSameInAnyNumberOfRanges) {
  for (const Sample& sample : samples()) {
    const auto evaluator = makeEvaluator(textSource(sample.text));
    const auto axioms = axiomsOf(sample.name.rfind("tree", 0) == 0 ? 3 : 13, sample.x, sample.y, sample.z);
    auto first = std::move(*evaluator.evaluation()), again = std::move(*evaluator.evaluation());
    const auto one = derive(first, axioms, 1);
    for (const uint32_t ranges : {2u, 7u, 1000u}) {
      const auto other = derive(again, axioms, ranges); // in memory of the one before
      EXPECT_EQ(other.rangeCount, std::min<size_t>(ranges, axioms.size()));
      expectEqual(one, other, 0, sample.name + " in " + std::to_string(ranges));
      if (HasFailure()) return;
    }
  }
}

TEST(EvaluationTest, PhasesOfCollidersGoThroughAllRanges) {
  const auto words = bake(kWood);
  const auto axioms = axiomsOf(60, 4, 5, 4);
  SpawnDevice device({.maxColliders = 1000});
  std::vector<GpgpInstance> gpu;
  const auto report = device.derive(words, axioms, 1000, &gpu);
  const auto evaluator = makeEvaluator(bakedSource(words));
  auto first = std::move(*evaluator.evaluation());
  const auto one = derive(first, axioms, 1);
  EXPECT_EQ(std::memcmp(report.keyHash, one.keyHash, 8), 0);
  EXPECT_EQ(one.colliders, report.colliders);
  EXPECT_LT(one.terminals, 175u); // trees and lamps are missing
  EXPECT_GT(one.terminals, 70u);
  expectSameSet(allOf(one), gpu, "wood");
  for (const uint32_t ranges : {2u, 7u, 60u}) {
    auto other = std::move(*evaluator.evaluation());
    expectEqual(one, derive(other, axioms, ranges), 0, std::to_string(ranges));
  }
  // An axiom alone does not meet the neighbours' houses: the same call must hold them.
  auto alone = std::move(*evaluator.evaluation());
  uint64_t sum = 0;
  for (const GpgpAxiom& axiom : axioms) sum += derive(alone, {axiom}).terminals;
  EXPECT_GT(sum, one.terminals);
}

void sortQuads(std::vector<uint32_t>& words) {
  using Quad = std::array<uint32_t, 4 * kLayout.stride / 4>;
  std::vector<Quad> quads(words.size() / Quad().size());
  std::memcpy(quads.data(), words.data(), words.size() * 4);
  std::sort(quads.begin(), quads.end());
  std::memcpy(words.data(), quads.data(), words.size() * 4);
}

TEST(EvaluationTest, VerticesAreThoseOfTheReference) {
  for (const Sample& sample : samples()) {
    if (sample.name == "tree_8_3" || sample.name == "tree_12_2" || sample.name == "menger_sponge_3") continue;
    const auto words = bake(sample.text);
    const auto layout = spawn::layoutOf(kLayout);
    const auto axioms = axiomsOf(4, sample.x, sample.y, sample.z);
    const auto expected = spawn::derive(words, axioms, {.vertices = &*layout});
    const auto evaluator = makeEvaluator(bakedSource(words));
    auto evaluation = std::move(*evaluator.evaluation());
    auto info = init<GpgpEvaluationInfo>();
    info.vertices = &kLayout;
    const auto result = derive(evaluation, axioms, 2, info);
    std::vector<uint32_t> found;
    for (uint32_t a = 0; a < result.axiomCount; ++a) {
      const auto* from = static_cast<const uint32_t*>(result.axioms[a].vertices);
      found.insert(found.end(), from, from + size_t(result.axioms[a].vertexCount) * kLayout.stride / 4);
      ASSERT_EQ(result.axioms[a].indexCount, result.axioms[a].vertexCount / 4 * 6);
      ASSERT_LE(result.axioms[a].indexCount, result.indexCount);
    }
    auto wanted = expected.vertexWords; // by phase, then by axiom
    if (words[shader::kHeaderPhases] > 1) {
      sortQuads(found);
      sortQuads(wanted);
    }
    EXPECT_EQ(found, wanted) << sample.name;
    static constexpr uint32_t kPattern[] = {0, 1, 2, 0, 2, 3};
    for (uint32_t i = 0; i < result.indexCount; ++i) ASSERT_EQ(result.indices[i], i / 6 * 4 + kPattern[i % 6]);
  }
}

TEST(EvaluationTest, KeysAndRegionsChooseAmongTheWhole) {
  for (const char* name : {"simple_house", "city", "suburban_house"}) {
    const auto evaluator =
        makeEvaluator(textSource(host::readText(std::string(GPGP_SAMPLE_GRAMMARS "/") + name + ".pga")));
    const auto axioms = axiomsOf(12, 12, 20, 24);
    auto whole = std::move(*evaluator.evaluation()), part = std::move(*evaluator.evaluation());
    auto info = init<GpgpEvaluationInfo>();
    info.flags = GPGP_EVALUATION_BOUNDS;
    const auto all = allOf(derive(whole, axioms, 0, info));
    ASSERT_GT(all.size(), 50u);
    // Keys: every fifth, and one that does not exist.
    std::vector<std::array<uint32_t, 2>> keys{{{1, 2}}};
    for (size_t i = 0; i < all.size(); i += 5) keys.push_back({{all[i].key[0], all[i].key[1]}});
    std::vector<GpgpInstance> expected;
    for (const GpgpInstance& i : all)
      for (const auto& key : keys)
        if (i.key[0] == key[0] && i.key[1] == key[1]) {
          expected.push_back(i);
          break;
        }
    info.keys = reinterpret_cast<const uint32_t(*)[2]>(keys.data());
    info.keyCount = static_cast<uint32_t>(keys.size());
    auto result = derive(part, axioms, 5, info);
    auto found = allOf(result);
    ASSERT_EQ(found.size(), expected.size()) << name;
    EXPECT_EQ(std::memcmp(found.data(), expected.data(), found.size() * sizeof found[0]), 0) << name;
    EXPECT_EQ(result.terminals, all.size()); // counted all the same
    EXPECT_EQ(result.instances, found.size());
    info.keyCount = 0; // none of them
    result = derive(part, axioms, 5, info);
    EXPECT_EQ(result.instances, 0u);
    EXPECT_EQ(result.terminals, all.size());
    // A region: boxes of corners, worked out in doubles. Terminals within rounding of its faces may go either way.
    const GpgpSpawnBounds region{{3, 1, -4}, {20, 9, 30}};
    info.keys = nullptr;
    info.region = &region;
    found = allOf(derive(part, axioms, 3, info));
    size_t inside = 0, at = 0;
    for (const GpgpInstance& i : all) {
      double low[3], high[3], margin = 1e9;
      bool touches = true;
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = 1e9;
        high[axis] = -1e9;
        for (int corner = 0; corner < 8; ++corner) {
          double place = i.transform[4 * axis + 3];
          for (int e = 0; e < (i.size[2] == 0 ? 2 : 3); ++e)
            place += i.transform[4 * axis + e] * (corner >> e & 1 ? 0.5 : -0.5);
          low[axis] = std::min(low[axis], place);
          high[axis] = std::max(high[axis], place);
        }
        touches = touches && low[axis] <= region.max[axis] && high[axis] >= region.min[axis];
        margin = std::min({margin, std::abs(low[axis] - region.max[axis]), std::abs(high[axis] - region.min[axis])});
      }
      const bool kept = at < found.size() && std::memcmp(&found[at], &i, sizeof i) == 0;
      if (margin > 1e-4) {
        ASSERT_EQ(kept, touches) << name << ", instance " << &i - all.data();
      }
      at += kept;
      inside += kept;
    }
    EXPECT_EQ(at, found.size());
    EXPECT_GT(inside, 0u) << name;
    EXPECT_LT(inside, all.size()) << name;
  }
}

TEST(EvaluationTest, BoundsHoldAllThatIsKept) {
  for (const bool boxes : {true, false}) { // those of boxes end where corners are
    const auto evaluator = makeEvaluator(
        textSource(boxes ? "axiom Box A;\nterminal T (1, 0);\nA = Repeat(Y, 7, ADJUST_TO_FILL) Rotate(10, 20, 30) T;\n"
                         : host::readText(GPGP_SAMPLE_GRAMMARS "/city.pga")));
    auto evaluation = std::move(*evaluator.evaluation());
    auto info = init<GpgpEvaluationInfo>();
    info.flags = GPGP_EVALUATION_BOUNDS;
    info.vertices = &kLayout;
    const auto result = derive(evaluation, axiomsOf(6, 20, 60, 20), 2, info);
    for (uint32_t a = 0; a < result.axiomCount; ++a) {
      const GpgpEvaluatedAxiom& axiom = result.axioms[a];
      float low[3] = {1e9f, 1e9f, 1e9f}, high[3] = {-1e9f, -1e9f, -1e9f};
      for (uint32_t v = 0; v < axiom.vertexCount; ++v) {
        float place[3];
        std::memcpy(place, static_cast<const char*>(axiom.vertices) + size_t(v) * kLayout.stride, sizeof place);
        for (int i = 0; i < 3; ++i) {
          low[i] = std::min(low[i], place[i]);
          high[i] = std::max(high[i], place[i]);
        }
      }
      for (int i = 0; i < 3; ++i) {
        EXPECT_LE(axiom.bounds.min[i], low[i] + 1e-3f);
        EXPECT_GE(axiom.bounds.max[i], high[i] - 1e-3f);
        if (!boxes) continue;
        EXPECT_NEAR(axiom.bounds.min[i], low[i], 1e-3f);
        EXPECT_NEAR(axiom.bounds.max[i], high[i], 1e-3f);
      }
    }
  }
}

TEST(EvaluationTest, ABudgetEndsAnAxiomAtTheSameShape) {
  const std::string text = "axiom Box A;\nterminal T (1, 0);\nA = Replicate() { T | A };\n"; // never ends
  const std::string small = "axiom Box A;\nterminal T (1, 0);\nA = Repeat(X, 1, ADJUST_TO_FILL) T;\n";
  const auto evaluator = makeEvaluator(textSource(text));
  auto first = std::move(*evaluator.evaluation()), again = std::move(*evaluator.evaluation());
  const auto axioms = axiomsOf(5, 8, 1, 1);
  auto info = init<GpgpEvaluationInfo>();
  info.maxShapesPerAxiom = 1000;
  info.maxDepth = 65535;
  const auto one = derive(first, axioms, 1, info);
  EXPECT_EQ(one.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(one.shapes, 5000u);
  EXPECT_GT(one.instances, 2000u);
  expectEqual(one, derive(again, axioms, 3, info), 0, "budget");
  // One axiom too many leaves the others whole.
  const auto repeats = makeEvaluator(textSource(small));
  auto some = std::move(*repeats.evaluation());
  auto sizes = axiomsOf(3, 8, 1, 1);
  sizes[1].size[0] = 5000;
  const auto mixed = derive(some, sizes, 2, info);
  EXPECT_EQ(mixed.axioms[0].status, GPGP_SUCCESS);
  EXPECT_EQ(mixed.axioms[0].instanceCount, 8u);
  EXPECT_EQ(mixed.axioms[1].status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(mixed.axioms[1].shapes, 1000u);
  EXPECT_EQ(mixed.axioms[2].instanceCount, 8u);
  // maxDepth is the GPU's budget.
  info.maxDepth = 20;
  info.maxShapesPerAxiom = 0;
  const auto shallow = derive(first, axioms, 2, info);
  EXPECT_EQ(shallow.unfinishedShapes, 5u);
  EXPECT_EQ(shallow.depth, 21u);
}

TEST(EvaluationTest, ADerivationThatIsCancelledLeavesNothing) {
  const std::string text = "axiom Box A;\nterminal T (1, 0);\nA = Replicate() { T | A };\n"; // never ends
  const auto evaluator = makeEvaluator(textSource(text));
  auto evaluation = std::move(*evaluator.evaluation());
  std::atomic<int> questions{0};
  auto info = init<GpgpEvaluationInfo>();
  const auto axioms = axiomsOf(6, 8, 1, 1);
  info.axioms = axioms.data();
  info.axiomCount = 6;
  info.maxDepth = 65535;
  info.maxShapesPerAxiom = 100000;
  info.rangeCount = 3;
  info.cancelUserData = &questions;
  info.isCancelled = [](void* user) -> uint32_t { return ++*static_cast<std::atomic<int>*>(user) > 6; };
  EXPECT_EQ(evaluation.derive(info), GPGP_CANCELLED);
  EXPECT_EQ(evaluation.result()->axiomCount, 0u);
  EXPECT_EQ(evaluation.result()->terminals, 0u);
  info.isCancelled = [](void*) -> uint32_t { return 0; };
  EXPECT_EQ(evaluation.derive(info), GPGP_SUCCESS); // and works again
  EXPECT_EQ(evaluation.result()->shapes, 600000u);
}

TEST(EvaluationTest, AllMemoryIsTheEngines) {
  const auto words = bake(kWood);
  const auto axioms = axiomsOf(40, 4, 5, 4);
  std::vector<GpgpInstance> expected;
  for (uint32_t failsAt = 0;; ++failsAt) { // every allocation fails once
    ASSERT_LT(failsAt, 2000u);
    Heap heap;
    heap.failsAt = failsAt;
    const GpgpGrammarSource source = bakedSource(words);
    auto info = init<GpgpEvaluatorCreateInfo>();
    info.sources = &source;
    info.sourceCount = 1;
    info.hostAllocator = &heap.callbacks;
    bool done = false;
    GpgpEvaluator evaluator = nullptr;
    GpgpEvaluation evaluation = nullptr;
    GpgpResult result = gpgpCreateEvaluator(&info, &evaluator);
    if (result == GPGP_SUCCESS) result = gpgpCreateEvaluation(evaluator, &evaluation);
    if (result == GPGP_SUCCESS) {
      auto what = init<GpgpEvaluationInfo>();
      what.axioms = axioms.data();
      what.axiomCount = 40;
      what.rangeCount = 4;
      what.vertices = &kLayout;
      result = gpgpEvaluate(evaluation, &what);
      auto out = init<GpgpEvaluationResult>();
      EXPECT_EQ(gpgpGetEvaluationResult(evaluation, &out), GPGP_SUCCESS);
      if (result == GPGP_SUCCESS) {
        done = true;
        EXPECT_GT(out.instances, 40u);
      } else {
        EXPECT_EQ(out.axiomCount, 0u);
        heap.failsAt = UINT32_MAX; // with memory again, it goes on
        EXPECT_EQ(gpgpEvaluate(evaluation, &what), GPGP_SUCCESS);
      }
    }
    if (!done) {
      EXPECT_EQ(result, GPGP_ERROR_OUT_OF_HOST_MEMORY);
    }
    gpgpDestroyEvaluation(evaluation);
    gpgpDestroyEvaluator(evaluator);
    EXPECT_EQ(heap.bytes, 0) << failsAt;
    if (done) break;
  }
}

TEST(EvaluationTest, MistakesAreNamed) {
  Messages messages;
  auto info = init<GpgpEvaluatorCreateInfo>();
  info.messageFn = Messages::receive;
  info.messageUserData = &messages;
  GpgpEvaluator evaluator = nullptr;
  EXPECT_EQ(gpgpCreateEvaluator(nullptr, &evaluator), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpCreateEvaluator(&info, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpCreateEvaluator(&info, &evaluator), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(messages.texts.back(), "gpgpCreateEvaluator: there are no sources");
  const std::string broken = "axiom Box A;\nterminal T (1, 0);\nA = Repeat(X, 1, ADJUST_TO_FILL) Nothing;\n";
  GpgpGrammarSource source = textSource(broken);
  source.messageFn = Messages::compiled;
  source.messageUserData = &messages;
  info.sources = &source;
  info.sourceCount = 1;
  EXPECT_EQ(gpgpCreateEvaluator(&info, &evaluator), GPGP_ERROR_INVALID_DATA);
  EXPECT_EQ(messages.texts[messages.texts.size() - 2].substr(0, 5), "3:34:")
      << messages.texts[messages.texts.size() - 2];
  auto words = bake(kWood);
  words[words.size() / 2] ^= 4;
  source = bakedSource(words);
  EXPECT_EQ(gpgpCreateEvaluator(&info, &evaluator), GPGP_ERROR_INVALID_DATA);
  source.sType = GPGP_STRUCTURE_SPAWN_INFO;
  EXPECT_EQ(gpgpCreateEvaluator(&info, &evaluator), GPGP_ERROR_INVALID_STRUCT);
  const auto good = bake(kWood);
  source = bakedSource(good);
  source.baked = nullptr;
  source.size = 0;
  source.builder = reinterpret_cast<GpgpGrammarBuilder>(&source);
  EXPECT_EQ(gpgpCreateEvaluator(&info, &evaluator), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(evaluator, nullptr);

  source = bakedSource(good);
  ASSERT_EQ(gpgpCreateEvaluator(&info, &evaluator), GPGP_SUCCESS);
  uint32_t start = 0, count = 0;
  EXPECT_EQ(gpgpFindEvaluatorStart(evaluator, "Tree", &start), GPGP_SUCCESS);
  EXPECT_EQ(gpgpFindEvaluatorStart(evaluator, "Three", &start), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpGetEvaluatorTerminals(evaluator, &count, nullptr), GPGP_SUCCESS);
  ASSERT_EQ(count, 4u);
  std::vector<GpgpGrammarTerminal> terminals(count);
  EXPECT_EQ(gpgpGetEvaluatorTerminals(evaluator, &count, terminals.data()), GPGP_SUCCESS);
  EXPECT_STREQ(terminals[1].name, "Trunk");
  count = 1;
  EXPECT_EQ(gpgpGetEvaluatorTerminals(evaluator, &count, terminals.data()), GPGP_INCOMPLETE);
  EXPECT_EQ(gpgpGetEvaluatorStarts(evaluator, &count, nullptr), GPGP_SUCCESS);
  EXPECT_EQ(count, 5u); // rules, and the axiom line
  GpgpEvaluation evaluation = nullptr;
  EXPECT_EQ(gpgpCreateEvaluation(nullptr, &evaluation), GPGP_ERROR_INVALID_HANDLE);
  ASSERT_EQ(gpgpCreateEvaluation(evaluator, &evaluation), GPGP_SUCCESS);
  auto what = init<GpgpEvaluationInfo>();
  EXPECT_EQ(gpgpEvaluate(evaluation, &what), GPGP_SUCCESS); // of nothing
  what.axiomCount = 1;
  EXPECT_EQ(gpgpEvaluate(evaluation, &what), GPGP_ERROR_INVALID_ARGUMENT);
  what.axiomCount = 0;
  what.keyCount = 1;
  EXPECT_EQ(gpgpEvaluate(evaluation, &what), GPGP_ERROR_INVALID_ARGUMENT);
  what.keyCount = 0;
  const GpgpSpawnBounds backward{{0, 1, 0}, {1, 0, 1}};
  what.region = &backward;
  EXPECT_EQ(gpgpEvaluate(evaluation, &what), GPGP_ERROR_INVALID_ARGUMENT);
  what.region = nullptr;
  what.flags = 64;
  EXPECT_EQ(gpgpEvaluate(evaluation, &what), GPGP_ERROR_INVALID_ARGUMENT);
  what.flags = 0;
  GpgpVertexLayout layout = kLayout;
  layout.stride = 6;
  what.vertices = &layout;
  EXPECT_EQ(gpgpEvaluate(evaluation, &what), GPGP_ERROR_INVALID_ARGUMENT);
  what.vertices = nullptr;
  what.sType = GPGP_STRUCTURE_SPAWN_INFO;
  EXPECT_EQ(gpgpEvaluate(evaluation, &what), GPGP_ERROR_INVALID_STRUCT);
  gpgpDestroyEvaluation(evaluation);
  gpgpDestroyEvaluator(evaluator);
}

} // namespace
