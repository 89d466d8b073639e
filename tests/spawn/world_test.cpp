// What a world needs of a derivation: rules that ask the camera, on the device and on the CPU, and axioms that are
// derived anew in the place of others.
#include "grammars.h"
#include "host/kernel.h"
#include "host/memory.h"
#include "random_grammar.h"
#include "shaders/axioms_between.spv.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/schedule/camera.h"
#include "spawner_test.h"

#include "gpgp/shaders/axioms.h"

#include <gpgp/evaluator.hpp>
#include <gpgp/tiles.hpp>

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <random>
#include <set>

namespace {
using namespace gpgp;
using namespace gpgp::test;

constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

// ---------------------------------------------------------------- cameras

GpgpSpawnCamera cameraAt(const glm::vec3& eye, const glm::vec3& target, float fov = 60, uint32_t height = 720,
                         float aspect = 1.6f) {
  // GLM's projections are OpenGL's: the near plane is a little farther away than this one says, which does not matter.
  const glm::mat4 view = glm::lookAt(eye, target, glm::vec3(0, 1, 0));
  const glm::mat4 matrix = glm::perspective(glm::radians(fov), aspect, 0.05f, 5000.0f) * view;
  GpgpSpawnCamera camera{};
  for (int i = 0; i < 16; ++i) camera.viewProjection[i] = matrix[i / 4][i % 4];
  for (int i = 0; i < 3; ++i) camera.position[i] = eye[i];
  camera.height = height;
  return camera;
}

/// Somewhere in the world, turned and scaled.
GpgpAxiom somewhere(std::mt19937& random, uint32_t id, float reach, float scale = 1) {
  std::uniform_real_distribution<float> place(-reach, reach), angle(0, 6.28f), size(1, 12);
  GpgpAxiom axiom = spawn::makeAxiom(size(random), size(random), size(random), 1 + uint32_t(random() % 100000), id);
  const float a = angle(random), c = std::cos(a) * scale, s = std::sin(a) * scale;
  const float rows[12] = {c, 0, s, place(random), 0, scale, 0, place(random) / 8, -s, 0, c, place(random)};
  std::copy_n(rows, 12, axiom.transform);
  return axiom;
}

std::string asking(const char* value) {
  return std::string("axiom Box A;\nterminal T (1, 0);\nA = SetAttribute(") + value + ") T;\n";
}

spawn::Derivation seenFrom(const std::vector<uint32_t>& words, const std::vector<GpgpAxiom>& axioms,
                           const GpgpSpawnCamera* camera) {
  const auto view = spawn::viewOf(camera);
  EXPECT_TRUE(view);
  spawn::DeriveOptions options;
  options.view = &*view;
  return spawn::derive(words, axioms, options);
}

TEST(CameraTest, ValuesAreWhatGeometrySays) {
  std::mt19937 random(3);
  const auto distances = bake(asking("CameraDistance()")), sizes = bake(asking("ScreenSize()")),
             outsides = bake(asking("OutOfView()"));
  uint32_t inside = 0, outside = 0;
  for (int c = 0; c < 20; ++c) {
    const float scale = c % 3 == 0 ? 2.5f : 1.0f, fov = 30.0f + 4.0f * float(c), aspect = 1.6f;
    std::uniform_real_distribution<float> place(-60, 60);
    const glm::vec3 eye(place(random), 8, place(random)), target(place(random), 2, place(random));
    const GpgpSpawnCamera camera = cameraAt(eye, target, fov, 720, aspect);
    std::vector<GpgpAxiom> axioms;
    for (uint32_t i = 0; i < 50; ++i) axioms.push_back(somewhere(random, i, 100, scale));
    const auto d = seenFrom(distances, axioms, &camera), s = seenFrom(sizes, axioms, &camera),
               o = seenFrom(outsides, axioms, &camera);
    const glm::dvec3 forward = glm::normalize(glm::dvec3(target) - glm::dvec3(eye));
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0))), up = glm::cross(right, forward);
    for (uint32_t i = 0; i < 50; ++i) {
      const GpgpAxiom& a = axioms[i];
      const glm::dvec3 to = glm::dvec3(a.transform[3], a.transform[7], a.transform[11]) - glm::dvec3(eye);
      const double radius = 0.5 * scale * glm::length(glm::dvec3(a.size[0], a.size[1], a.size[2]));
      const double distance = glm::length(to), half = glm::radians(double(fov)) / 2;
      EXPECT_NEAR(d.instances[i].attribute, distance, 1e-5 * distance);
      const double pixels = 2 * radius * 360 / std::tan(half) / std::max(distance, radius);
      EXPECT_NEAR(s.instances[i].attribute, pixels, 1e-4 * pixels);
      // Side planes as angles: the distance to a plane through the eye.
      const double halfX = std::atan(std::tan(half) * aspect), z = glm::dot(to, forward);
      double beyond = -z;
      for (const auto& [side, angle] : {std::pair{glm::dot(to, right), halfX}, std::pair{glm::dot(to, up), half}})
        beyond = std::max(beyond, std::abs(side) * std::cos(angle) - z * std::sin(angle));
      const double expected = std::max(0.0, beyond - radius);
      EXPECT_NEAR(o.instances[i].attribute, expected, 0.2 + 1e-3 * distance) << i;
      if (expected > 1) {
        EXPECT_GT(o.instances[i].attribute, 0);
      }
      (o.instances[i].attribute > 0 ? outside : inside) += 1;
    }
  }
  EXPECT_GT(inside, 200u);
  EXPECT_GT(outside, 200u);
}

TEST(CameraTest, WithoutOneEverythingIsNearAndLarge) {
  std::mt19937 random(5);
  const std::vector<GpgpAxiom> axioms{somewhere(random, 0, 1000)};
  EXPECT_EQ(seenFrom(bake(asking("CameraDistance()")), axioms, nullptr).instances[0].attribute, 0);
  EXPECT_EQ(seenFrom(bake(asking("ScreenSize()")), axioms, nullptr).instances[0].attribute, shader::kLargest);
  EXPECT_EQ(seenFrom(bake(asking("OutOfView()")), axioms, nullptr).instances[0].attribute, 0);
}

TEST(CameraTest, ParallelProjectionsKeepSizes) {
  GpgpSpawnCamera camera{};
  const glm::mat4 matrix = glm::ortho(-50.0f, 50.0f, -25.0f, 25.0f, -500.0f, 500.0f); // 50 m over 400 pixels
  for (int i = 0; i < 16; ++i) camera.viewProjection[i] = matrix[i / 4][i % 4];
  camera.height = 400;
  GpgpAxiom near = spawn::makeAxiom(3, 4, 12), far = near, beside = near; // a diagonal of 13 m
  far.transform[11] = -300;
  beside.transform[3] = 50 + 6.5f + 2;
  const auto sizes = seenFrom(bake(asking("ScreenSize()")), {near, far}, &camera);
  EXPECT_NEAR(sizes.instances[0].attribute, 13 * 8, 1e-3);
  EXPECT_EQ(sizes.instances[0].attribute, sizes.instances[1].attribute);
  const auto outside = seenFrom(bake(asking("OutOfView()")), {near, beside}, &camera);
  EXPECT_EQ(outside.instances[0].attribute, 0);
  EXPECT_NEAR(outside.instances[1].attribute, 2, 1e-4);
}

TEST(CameraTest, WhatIsNoCameraIsRefused) {
  const GpgpSpawnCamera good = cameraAt({0, 0, 10}, {0, 0, 0});
  EXPECT_TRUE(spawn::viewOf(&good));
  GpgpSpawnCamera bad = good;
  bad.height = 0;
  EXPECT_EQ(spawn::viewOf(&bad).error().code, GPGP_ERROR_INVALID_ARGUMENT);
  bad = good;
  bad.position[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(spawn::viewOf(&bad).error().code, GPGP_ERROR_INVALID_ARGUMENT);
  bad = good;
  std::fill_n(bad.viewProjection, 16, 0.0f);
  EXPECT_EQ(spawn::viewOf(&bad).error().code, GPGP_ERROR_INVALID_ARGUMENT);
}

// Blocks of a town in a tree of areas, each within the one before it.
const char* const kBlocks = R"(var pixels = 0;
axiom Box Area;
terminal Block (1, 0);
terminal Coarse (1, 1);
Area = If(OutOfView() > 0) { Discard() | Seen };
Seen = If(ScreenSize() < pixels) { Coarse | Half };
Half = IfSizeLess(X, 6) { Block | SubDiv(X) { -1: Turned | -1.5: Turned } };
Turned = Rotate(0, 90, 0) SwapSize(Z, Y, X) Area;
)";

TEST(CameraTest, NothingInSightIsLost) {
  const auto words = bake(kBlocks);
  std::vector<GpgpAxiom> axioms{spawn::makeAxiom(400, 10, 400, 7, 1)};
  const auto finest = seenFrom(words, axioms, nullptr);
  std::mt19937 random(11);
  std::uniform_real_distribution<float> place(-220, 220);
  uint64_t derived = 0;
  for (int c = 0; c < 30; ++c) {
    const GpgpSpawnCamera camera = cameraAt({place(random), 12, place(random)}, {place(random), 0, place(random)});
    const auto view = spawn::viewOf(&camera);
    const auto seen = seenFrom(words, axioms, &camera);
    std::set<std::pair<uint32_t, uint32_t>> keys;
    for (const GpgpInstance& i : seen.instances) keys.emplace(i.key[0], i.key[1]);
    derived += seen.terminals;
    for (const GpgpInstance& i : finest.instances) {
      shader::Shape shape{}; // its centre, which lies in all areas around it
      shape.position = shader::vec3(i.transform[3], i.transform[7], i.transform[11]);
      const shader::Seen s =
          shader::seenBy(*view, shape, shader::vec4(1, 0, 0, 0), shader::vec4(0, 1, 0, 0), shader::vec4(0, 0, 1, 0));
      if (s.outside == 0) {
        EXPECT_TRUE(keys.contains({i.key[0], i.key[1]}));
      }
    }
    for (const GpgpInstance& i : seen.instances) EXPECT_EQ(i.terminal, 0u);
  }
  EXPECT_LT(derived, 30 * finest.terminals / 2);
}

TEST(CameraTest, WhatTheEngineCallsHiddenIsOutOfView) {
  const auto words = bake(textOf(GPGP_SAMPLE_GRAMMARS "/../world/wood.pga"));
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < 6; ++i) axioms.push_back(spawn::makeAxiom(7, 10, 7, 3 + i, i));
  const GpgpSpawnCamera camera = cameraAt({0, 2, 30}, {0, 0, 0});
  for (const GpgpSpawnCamera* from : {static_cast<const GpgpSpawnCamera*>(nullptr), &camera}) {
    for (GpgpAxiom& axiom : axioms) axiom.hidden = 0;
    const auto all = seenFrom(words, axioms, from);
    axioms[1].hidden = axioms[4].hidden = 1;
    const auto some = seenFrom(words, axioms, from);
    std::vector<GpgpInstance> expected;
    for (const GpgpInstance& i : all.instances)
      if (i.axiomId != 1 && i.axiomId != 4) expected.push_back(i);
    ASSERT_LT(expected.size(), all.instances.size());
    ASSERT_EQ(some.instances.size(), expected.size());
    EXPECT_EQ(std::memcmp(some.instances.data(), expected.data(), expected.size() * sizeof expected[0]), 0);
  }
}

TEST(CameraTest, LessIsDerivedOfWhatIsSmallAndSharesOfLevelsAddUp) {
  const auto words = bake(textOf(GPGP_SAMPLE_GRAMMARS "/../world/wood.pga"));
  std::vector<GpgpAxiom> axioms{spawn::makeAxiom(7, 10, 7, 3, 1)};
  const auto finest = seenFrom(words, axioms, nullptr);
  EXPECT_EQ(finest.terminals, 283u); // as tree_4_3.pga
  uint64_t fewest = finest.terminals;
  bool faded = false;
  for (float distance = 12; distance < 4000; distance *= 1.05f) {
    const GpgpSpawnCamera camera = cameraAt({0, 2, distance}, {0, 0, 0});
    const auto seen = seenFrom(words, axioms, &camera);
    ASSERT_GT(seen.terminals, 0u) << distance;
    float shares = 0; // of the trunk, and of the crown that stands for the tree
    for (const GpgpInstance& i : seen.instances) {
      EXPECT_GT(i.attribute, 0);
      EXPECT_LE(i.attribute, 1);
      const bool isTrunk = i.terminal == 0 && i.size[0] == 1.0f;
      const bool isTree = i.terminal == 2 && std::abs(i.size[0] - 4.9f) < 1e-4f;
      if (isTrunk || isTree) shares += i.attribute;
      faded = faded || i.attribute < 1;
    }
    EXPECT_NEAR(shares, 1, 1e-3) << distance;
    fewest = std::min(fewest, seen.terminals);
  }
  EXPECT_TRUE(faded);
  EXPECT_EQ(fewest, 1u);
}

// ---------------------------------------------------------------- context

TEST(ContextTest, PartsWithTheirNeighboursAreTheWholeOnTheCpu) {
  const std::string text = R"(axiom Box Lot;
terminal House (1, 0);
terminal Tree (1, 1);
Lot = Replicate() {
  Translate(Rand(-8, 8), 0, 0) Scale(Rand(4, 12), -1, Rand(4, 12)) Collider(1) House |
  Repeat(X, 3, ADJUST_TO_FILL) Scale(1.5, -1, 1.5) IfCollides(1) { Discard() | Tree }
};
)";
  constexpr uint32_t kLots = 40;
  std::vector<GpgpAxiom> all;
  for (uint32_t i = 0; i < kLots; ++i) {
    all.push_back(spawn::makeAxiom(16, 6, 16, 77 + i, i));
    all.back().transform[3] = 16.0f * float(i);
  }
  auto source = init<GpgpGrammarSource>();
  source.name = "row.pga";
  source.text = text.data();
  source.size = text.size();
  auto info = init<GpgpEvaluatorCreateInfo>();
  info.sources = &source;
  info.sourceCount = 1;
  const auto evaluator = Evaluator::create(info);
  ASSERT_TRUE(evaluator);
  auto evaluation = evaluator->evaluation();
  const auto derive = [&](const std::vector<GpgpAxiom>& axioms, uint32_t context) {
    auto what = init<GpgpEvaluationInfo>();
    what.axioms = axioms.data();
    what.axiomCount = uint32_t(axioms.size());
    what.contextCount = context;
    EXPECT_EQ(evaluation->derive(what), GPGP_SUCCESS);
    return *evaluation->result();
  };
  const GpgpEvaluationResult whole = derive(all, 0);
  const uint64_t terminals = whole.terminals;
  const uint32_t hash[2] = {whole.keyHash[0], whole.keyHash[1]};
  uint64_t together = 0, apart = 0;
  uint32_t sum[2] = {};
  for (uint32_t i = 0; i < kLots; ++i) {
    std::vector<GpgpAxiom> axioms{all[i]};
    apart += derive(axioms, 0).terminals;
    if (i) axioms.push_back(all[i - 1]);
    if (i + 1 < kLots) axioms.push_back(all[i + 1]);
    const GpgpEvaluationResult part = derive(axioms, uint32_t(axioms.size() - 1));
    together += part.terminals;
    for (int k = 0; k < 2; ++k) sum[k] += part.keyHash[k];
    EXPECT_EQ(part.colliders, axioms.size());
    ASSERT_EQ(part.axiomCount, axioms.size());
    for (uint32_t a = 1; a < part.axiomCount; ++a) {
      EXPECT_EQ(part.axioms[a].instanceCount, 0u);
      EXPECT_EQ(part.axioms[a].terminals, 0u);
      EXPECT_EQ(part.axioms[a].status, GPGP_SUCCESS);
    }
  }
  EXPECT_EQ(together, terminals);
  EXPECT_EQ(sum[0], hash[0]);
  EXPECT_EQ(sum[1], hash[1]);
  EXPECT_GT(apart, terminals + 10);
  auto what = init<GpgpEvaluationInfo>();
  what.axioms = all.data();
  what.axiomCount = 2;
  what.contextCount = 3;
  EXPECT_EQ(evaluation->derive(what), GPGP_ERROR_INVALID_ARGUMENT);
}

// ---------------------------------------------------------------- on the device

struct WorldTest : SpawnerTest {
  GpgpRecorder makeSpawner(GpgpSpawnerFlags flags = 0, uint32_t colliders = 0) {
    GpgpSpawnerCreateInfo info = GPGP_SPAWNER_CREATE_INFO_INIT;
    info.base.queueFamily = device.graphics().family;
    info.maxShapes = info.maxTerminals = 16384;
    info.flags = flags;
    info.maxColliders = colliders;
    return spawnerOf(info);
  }
  using SpawnerTest::load;
  GpgpAsset load(GpgpRecorder spawner, const std::vector<uint32_t>& words) {
    return load(spawner, words.data(), words.size() * 4);
  }
  GpgpSpawnReport derive(GpgpRecorder spawner, const GpgpSpawnInfo& info) {
    const GpgpFrame f = advance();
    device.submitAndWait([&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordPrepareSpawn(spawner, cmd, &f, &info), GPGP_SUCCESS) << lastMessage();
    });
    advance();
    GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
    EXPECT_EQ(gpgpGetSpawnReport(spawner, &report), GPGP_SUCCESS);
    return report;
  }
  std::vector<GpgpInstance> derived(GpgpRecorder spawner, GpgpAsset grammar, const std::vector<GpgpAxiom>& axioms,
                                    uint32_t capacity, const GpgpSpawnCamera* camera = nullptr) {
    const auto from = host::makeBuffer(device, axioms, kStorage);
    const host::Buffer instances(device, VkDeviceSize(96) * std::max(capacity, 1u), kStorage);
    GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
    info.grammar = grammar;
    info.axioms = from.range();
    info.axiomCount = static_cast<uint32_t>(axioms.size());
    info.instances = instances.range();
    info.camera = camera;
    const GpgpSpawnReport report = derive(spawner, info);
    EXPECT_EQ(report.base.status, GPGP_SUCCESS);
    return host::download<GpgpInstance>(device, instances, report.instancesWritten);
  }
};

/// All of an instance that is equal bit for bit on every device.
std::vector<uint32_t> bitsOf(const GpgpInstance& i) {
  std::vector<uint32_t> words(12);
  std::memcpy(words.data(), reinterpret_cast<const char*>(&i) + 48, 48);
  return words;
}
std::vector<std::vector<uint32_t>> bitsOf(const std::vector<GpgpInstance>& all) {
  std::vector<std::vector<uint32_t>> bits;
  for (const GpgpInstance& i : all) bits.push_back(bitsOf(i));
  std::sort(bits.begin(), bits.end());
  return bits;
}

const char* const kColliding = R"(axiom Box A;
terminal T (1, 0); terminal Small (1, 1);
A = SubDiv(Y) { -1: Collider(1) If(ScreenSize() < 40) { Small | Repeat(X, 1.5, ADJUST_TO_FILL) T } |
                -1: IfCollides(1) { SetAttribute(CameraDistance()) Small |
                                    If(OutOfView() > 0) { Discard() | Repeat(Z, ScreenSize() / 50 + 1, ADJUST_TO_FILL) T } } };
)";

TEST_F(WorldTest, DeviceAndCpuSeeTheSame) {
  std::mt19937 random(17);
  const std::string wood = textOf(GPGP_SAMPLE_GRAMMARS "/../world/wood.pga");
  const std::string values =
      "axiom Box A;\nterminal T (1, 0);\nterminal U (1, 1);\n"
      "A = RandomRule(ShapeSeed()) { ScreenSize(): T | 200: Repeat(X, Max(0.5, CameraDistance() / "
      "40), ADJUST_TO_FILL) B | OutOfView(): U };\n"
      "B = SubDiv(Y) { ScreenSize() / 100: T | -1: Translate(0, OutOfView(), Rand(0, ScreenSize() * "
      "0.01)) If(Exp(CameraDistance() * 2 - (ScreenSize() + OutOfView())) > 0) { U | T } };\n";
  struct Case {
    const char* name;
    std::string text;
    bool kernel, colliders;
  };
  const Case cases[] = {{"blocks by their kernel", replaced(kBlocks, "pixels = 0", "pixels = 30"), true, false},
                        {"wood interpreted", wood, false, false},
                        {"values everywhere", values, false, false},
                        {"colliders interpreted", kColliding, false, true}};
  uint64_t fewest = UINT64_MAX, most = 0;
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const auto words = bake(c.text);
    const GpgpRecorder spawner = makeSpawner(0, c.colliders ? 4096 : 0);
    const std::string baked = c.kernel ? bakedFile({"grammar.pga", c.text}, GPGP_COMPILE_KERNEL).text : std::string();
    const GpgpAsset grammar = c.kernel ? load(spawner, baked.data(), baked.size()) : load(spawner, words);
    std::vector<GpgpAxiom> axioms;
    for (uint32_t i = 0; i < 24; ++i) axioms.push_back(somewhere(random, i, c.colliders ? 20.0f : 90.0f));
    for (uint32_t i = 0; i < 24; i += 5) axioms[i].hidden = 1;
    std::uniform_real_distribution<float> place(-100, 100);
    for (int k = 0; k < 4; ++k) {
      const GpgpSpawnCamera camera = cameraAt({place(random), 5, place(random)}, {place(random), 0, place(random)});
      const auto cpu = seenFrom(words, axioms, k ? &camera : nullptr);
      ASSERT_TRUE(cpu.complete);
      const auto gpu = derived(spawner, grammar, axioms, static_cast<uint32_t>(cpu.terminals), k ? &camera : nullptr);
      EXPECT_EQ(bitsOf(gpu), bitsOf(cpu.instances));
      if (k) fewest = std::min(fewest, cpu.terminals);
      most = std::max(most, cpu.terminals);
    }
    gpgpDestroyAsset(grammar);
  }
  EXPECT_LT(fewest * 10, most);
}

TEST_F(WorldTest, TerminalsBecomeAxiomsOnTheDevice) {
  // Districts of lots, and lots of rooms: the engine's shader is between the two derivations.
  const auto districts = bake(R"(axiom Box District;
terminal Park (1, 0); terminal Lot (1, 1);
District = Repeat(X, 12, ADJUST_TO_FILL) Repeat(Z, 15, ADJUST_TO_FILL) RandomRule(Rand(0, 1)) {
  0.2: Park | 0.8: Scale(-0.9, Rand(6, 20), -0.9) Rotate(0, Rand(-10, 10), 0) SetAttribute(Rand(0, 1)) Lot
};
)"),
             rooms = bake(R"(axiom Box House;
terminal Room (1, 0);
House = Repeat(Y, 3, ADJUST_TO_FILL) Repeat(X, Rand(3, 5) + ShapeCustomAttribute(), ADJUST_TO_FILL) Room;
)");
  constexpr uint32_t kLotTerminal = 1, kMost = 4096, kInstances = 16384;
  std::mt19937 random(23);
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < 9; ++i) {
    axioms.push_back(somewhere(random, i, 300));
    axioms.back().size[0] = axioms.back().size[2] = 90;
  }
  // The CPU by the same text.
  const spawn::Derivation coarse = spawn::derive(districts, axioms);
  std::vector<GpgpAxiom> lots;
  for (const GpgpInstance& instance : coarse.instances) {
    if (instance.terminal != kLotTerminal) continue;
    shader::uvec4 words[6], made[6];
    std::memcpy(words, &instance, sizeof words);
    for (int w = 0; w < 6; ++w) made[w] = shader::gpgpAxiomWord(words, w, GPGP_AXIOM_DEFAULT_START);
    std::memcpy(&lots.emplace_back(), made, sizeof made);
    EXPECT_EQ(lots.back().id, instance.axiomId);
    EXPECT_EQ(lots.back().seed, instance.seed);
    double length = 0; // of its x axis: without the extents
    for (int row = 0; row < 3; ++row) length += std::pow(double(lots.back().transform[4 * row]), 2);
    EXPECT_NEAR(std::sqrt(length), 1, 1e-5);
  }
  ASSERT_GT(lots.size(), 200u);
  ASSERT_LT(lots.size(), coarse.instances.size());
  const spawn::Derivation fine = spawn::derive(rooms, lots);

  const GpgpRecorder spawner = makeSpawner();
  const GpgpAsset outer = load(spawner, districts), inner = load(spawner, rooms);
  const auto from = host::makeBuffer(device, axioms, kStorage);
  const host::Buffer blocks(device, VkDeviceSize(96) * kInstances, kStorage),
      made(device, VkDeviceSize(96) * kMost, kStorage), counter(device, 4, kStorage), count(device, 4, kStorage),
      results(device, VkDeviceSize(96) * kInstances, kStorage);
  host::fill(device, counter, 0);
  GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
  info.grammar = outer;
  info.axioms = from.range();
  info.axiomCount = static_cast<uint32_t>(axioms.size());
  info.instances = blocks.range();
  info.count = count.range();
  EXPECT_EQ(derive(spawner, info).terminals, coarse.terminals);
  host::ComputeKernel kernel(device, axioms_between, 4, 12);
  const uint32_t push[3] = {kLotTerminal, GPGP_AXIOM_DEFAULT_START, kMost};
  kernel.run({&blocks, &made, &counter, &count}, push, kInstances / 64);
  GpgpSpawnInfo next = GPGP_SPAWN_INFO_INIT;
  next.grammar = inner;
  next.axioms = made.range();
  next.axiomCounter = counter.range();
  next.axiomCount = kMost;
  next.instances = results.range();
  const GpgpSpawnReport report = derive(spawner, next);
  EXPECT_EQ(report.base.status, GPGP_SUCCESS);
  EXPECT_EQ(report.terminals, fine.terminals);
  EXPECT_EQ(report.keyHash[0], fine.keyHash[0]);
  EXPECT_EQ(report.keyHash[1], fine.keyHash[1]);
  const auto gpu = host::download<GpgpInstance>(device, results, report.terminals);
  EXPECT_EQ(bitsOf(gpu), bitsOf(fine.instances));
  gpgpDestroyAsset(outer);
  gpgpDestroyAsset(inner);
}

TEST_F(WorldTest, RandomGrammarsThatAskTheCamera) {
  std::mt19937 random(41);
  const GpgpRecorder spawner = makeSpawner(0, 4096);
  uint32_t asked = 0, differ = 0;
  for (uint32_t seed = 0; seed < 60; ++seed) {
    std::string text = randomGrammar(seed);
    const auto replaceAll = [&](const std::string& from, const std::string& to) {
      for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
        ++asked;
      }
    };
    replaceAll("ShapeSeed()", seed % 2 ? "Exp(OutOfView() / 20)" : "Exp(1 / CameraDistance())");
    replaceAll("ShapeCustomAttribute()", seed % 3 ? "Exp(ScreenSize() / 400)" : "Exp(CameraDistance() / 50)");
    SCOPED_TRACE(text);
    const auto words = bake(text);
    std::vector<GpgpAxiom> axioms;
    for (uint32_t i = 0; i < 6; ++i) axioms.push_back(somewhere(random, i, 60));
    std::uniform_real_distribution<float> place(-70, 70);
    const GpgpSpawnCamera camera = cameraAt({place(random), 5, place(random)}, {place(random), 0, place(random)});
    const auto cpu = seenFrom(words, axioms, &camera), without = seenFrom(words, axioms, nullptr);
    if (!cpu.complete || cpu.terminals > 8000 || cpu.droppedShapes || cpu.unfinishedShapes) continue;
    differ += std::memcmp(cpu.keyHash, without.keyHash, 8) != 0;
    const GpgpAsset grammar = load(spawner, words);
    const auto gpu = derived(spawner, grammar, axioms, static_cast<uint32_t>(cpu.terminals), &camera);
    EXPECT_EQ(bitsOf(gpu), bitsOf(cpu.instances));
    gpgpDestroyAsset(grammar);
  }
  EXPECT_GT(asked, 100u);
  EXPECT_GT(differ, 10u);
}

TEST_F(WorldTest, EvaluatorAndTilesTakeACamera) {
  const std::string wood = textOf(GPGP_SAMPLE_GRAMMARS "/../world/wood.pga");
  const auto words = bake(wood);
  std::mt19937 random(23);
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < 9; ++i) axioms.push_back(somewhere(random, i, 60));
  GpgpSpawnCamera camera = cameraAt({0, 5, 70}, {0, 0, 0});
  const auto expected = seenFrom(words, axioms, &camera);
  auto source = init<GpgpGrammarSource>();
  source.name = "wood.pga";
  source.text = wood.data();
  source.size = wood.size();
  auto info = init<GpgpEvaluatorCreateInfo>();
  info.sources = &source;
  info.sourceCount = 1;
  auto evaluator = Evaluator::create(info);
  ASSERT_TRUE(evaluator);
  auto evaluation = evaluator->evaluation();
  ASSERT_TRUE(evaluation);
  auto what = init<GpgpEvaluationInfo>();
  what.axioms = axioms.data();
  what.axiomCount = 9;
  what.camera = &camera;
  what.rangeCount = 4;
  ASSERT_EQ(evaluation->derive(what), GPGP_SUCCESS);
  EXPECT_EQ(evaluation->result()->terminals, expected.terminals);
  EXPECT_EQ(std::memcmp(evaluation->result()->keyHash, expected.keyHash, 8), 0);
  camera.height = 0;
  EXPECT_EQ(evaluation->derive(what), GPGP_ERROR_INVALID_ARGUMENT);
  camera.height = 720;

  const GpgpRecorder spawner = makeSpawner();
  const GpgpAsset grammar = load(spawner, words);
  const host::Buffer instances(device, 96 * 8192, kStorage), draws(device, 4096, kStorage);
  host::fill(device, draws, 0);
  auto create = init<GpgpTileSetCreateInfo>();
  create.spawner = spawner;
  create.grammar = grammar;
  create.maxTiles = 1;
  create.instances = instances.range();
  create.draws = draws.range();
  auto set = TileSet::create(context, create);
  ASSERT_TRUE(set) << lastMessage();
  const auto from = host::makeBuffer(device, axioms, kStorage);
  auto tileInfo = init<GpgpTileInfo>();
  tileInfo.axioms = from.range();
  tileInfo.axiomCount = 9;
  tileInfo.capacity = 4096;
  tileInfo.camera = &camera;
  GpgpTile tile = 0;
  const GpgpFrame f = advance();
  device.submitAndWait(
      [&](VkCommandBuffer cmd) { EXPECT_EQ(set->record(cmd, f, tileInfo, tile), GPGP_SUCCESS) << lastMessage(); });
  advance();
  GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
  ASSERT_EQ(gpgpGetSpawnReport(spawner, &report), GPGP_SUCCESS);
  EXPECT_EQ(report.terminals, expected.terminals);
  EXPECT_EQ(std::memcmp(report.keyHash, expected.keyHash, 8), 0);
  camera.height = 0;
  const GpgpFrame g = advance();
  device.submitAndWait(
      [&](VkCommandBuffer cmd) { EXPECT_EQ(set->record(cmd, g, tileInfo, tile), GPGP_ERROR_INVALID_ARGUMENT); });
  set->reset();
  gpgpDestroyAsset(grammar);
}

// ---------------------------------------------------------------- ranges

constexpr uint32_t kPoison = 0xbaadf00d;

std::vector<GpgpInstance> sorted(std::vector<GpgpInstance> all) {
  std::sort(all.begin(), all.end(),
            [](const GpgpInstance& a, const GpgpInstance& b) { return std::memcmp(&a, &b, sizeof a) < 0; });
  return all;
}
bool same(const std::vector<GpgpInstance>& a, const std::vector<GpgpInstance>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}

struct RangesTest : WorldTest {
  static constexpr uint32_t kAxioms = 200, kRoom = 64;

  /// Writes the axioms into their ranges. Returns the ranges as the device left them.
  std::vector<GpgpAxiomRange> write(GpgpRecorder spawner, GpgpAsset grammar, const std::vector<GpgpAxiom>& axioms,
                                    const std::vector<GpgpAxiomRange>& ranges, const host::Buffer& instances,
                                    GpgpSpawnReport& report) {
    const auto from = host::makeBuffer(device, axioms, kStorage), to = host::makeBuffer(device, ranges, kStorage);
    GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
    info.grammar = grammar;
    info.axioms = from.range();
    info.axiomCount = static_cast<uint32_t>(axioms.size());
    info.instances = instances.range();
    info.ranges = to.range();
    report = derive(spawner, info);
    return host::download<GpgpAxiomRange>(device, to, ranges.size());
  }
};

TEST_F(RangesTest, AfterAnyEditsTheyAreTheWorldDerivedWhole) {
  std::mt19937 random(31);
  for (const bool kernel : {false, true}) {
    SCOPED_TRACE(kernel);
    const GpgpRecorder spawner = makeSpawner();
    const std::string baked = kernel ? bakedFile({"town.pga", kTown}, GPGP_COMPILE_KERNEL).text : std::string();
    const GpgpAsset grammar = kernel ? load(spawner, baked.data(), baked.size()) : load(spawner, bake(kTown));
    std::vector<GpgpAxiom> axioms;
    std::vector<GpgpAxiomRange> ranges;
    for (uint32_t i = 0; i < kAxioms; ++i) {
      axioms.push_back(somewhere(random, i, 100));
      for (float& extent : axioms[i].size) extent = std::min(extent, 5.0f);
      ranges.push_back({(kAxioms - 1 - i) * kRoom, kRoom, 0, 0}); // in another order than the axioms
    }
    const host::Buffer instances(device, VkDeviceSize(96) * kAxioms * kRoom, kStorage);
    host::fill(device, instances, kPoison);
    GpgpSpawnReport report{};
    std::vector<uint32_t> counts(kAxioms);
    const auto all = write(spawner, grammar, axioms, ranges, instances, report);
    for (uint32_t i = 0; i < kAxioms; ++i) counts[i] = all[i].count;
    EXPECT_EQ(report.base.status, GPGP_SUCCESS);
    auto before = host::download<GpgpInstance>(device, instances, kAxioms * kRoom);
    for (int edit = 0; edit < 12; ++edit) {
      // Edits: seed, attribute, size, place, of up to eight axioms.
      std::set<uint32_t> edited;
      for (uint32_t n = 1 + uint32_t(random() % 8); n > 0; --n) edited.insert(uint32_t(random() % kAxioms));
      std::vector<GpgpAxiom> some;
      std::vector<GpgpAxiomRange> theirs;
      for (const uint32_t i : edited) {
        switch (random() % 4) {
        case 0: axioms[i].seed = uint32_t(random()); break;
        case 1: axioms[i].attribute = float(random() % 100) / 100; break;
        case 2: axioms[i].size[random() % 3] = 1 + float(random() % 4); break;
        default: axioms[i].transform[3] += 1.25f;
        }
        some.push_back(axioms[i]);
        theirs.push_back(ranges[i]);
      }
      const auto left = write(spawner, grammar, some, theirs, instances, report);
      EXPECT_EQ(report.base.status, GPGP_SUCCESS);
      EXPECT_EQ(report.instancesWritten, report.terminals);
      const auto after = host::download<GpgpInstance>(device, instances, kAxioms * kRoom);
      uint32_t next = 0;
      for (const uint32_t i : edited) {
        EXPECT_EQ(left[next].first, ranges[i].first);
        EXPECT_EQ(left[next].capacity, kRoom);
        counts[i] = left[next++].count;
        ASSERT_LE(counts[i], kRoom);
      }
      for (uint32_t i = 0; i < kAxioms; ++i)
        if (!edited.contains(i)) {
          ASSERT_EQ(std::memcmp(&before[ranges[i].first], &after[ranges[i].first], kRoom * 96), 0) << i;
        }
      before = after;
      if (edit % 4) continue;
      // The whole, derived at once.
      std::map<uint32_t, std::vector<GpgpInstance>> whole;
      for (const GpgpInstance& instance : derived(spawner, grammar, axioms, kAxioms * kRoom))
        whole[instance.axiomId].push_back(instance);
      for (uint32_t i = 0; i < kAxioms; ++i) {
        const auto first = after.begin() + ranges[i].first;
        ASSERT_TRUE(same(sorted({first, first + counts[i]}), sorted(whole[i]))) << i;
      }
    }
    gpgpDestroyAsset(grammar);
  }
}

TEST_F(RangesTest, WhatDoesNotFitIsCountedAndTouchesNothing) {
  std::mt19937 random(37);
  const GpgpRecorder spawner = makeSpawner();
  const GpgpAsset grammar = load(spawner, bake(kTown));
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < 40; ++i) {
    axioms.push_back(somewhere(random, i, 100));
    for (float& extent : axioms[i].size) extent = std::min(extent, 5.0f);
  }
  const host::Buffer instances(device, 96 * 40 * kRoom, kStorage);
  GpgpSpawnReport report{};
  // Counted with no room at all.
  std::vector<GpgpAxiomRange> none(40);
  const auto counted = write(spawner, grammar, axioms, none, instances, report);
  EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(report.instancesWritten, 0u);
  const auto words = bake(kTown);
  for (uint32_t i = 0; i < 40; ++i)
    EXPECT_EQ(counted[i].count, spawn::derive(words, std::vector{axioms[i]}).terminals) << i;
  // Exactly enough, except for one that has half, one at the end of the buffer, and one behind it.
  host::fill(device, instances, kPoison);
  std::vector<GpgpAxiomRange> ranges(40);
  uint32_t at = 0, fits = 0;
  for (uint32_t i = 0; i < 40; ++i) {
    ranges[i] = {at, i == 7 ? counted[i].count / 2 : counted[i].count, 0, 0};
    if (i == 8) ranges[i].first = 40 * kRoom - 1;
    if (i == 9) ranges[i].first = UINT32_MAX - 3;
    at += counted[i].count;
    fits += i == 8 ? 1 : i == 9 ? 0 : ranges[i].capacity;
  }
  const auto left = write(spawner, grammar, axioms, ranges, instances, report);
  EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(report.instancesWritten, fits);
  const auto after = host::download<GpgpInstance>(device, instances, 40 * kRoom);
  std::vector<bool> written(after.size());
  for (uint32_t i = 0; i < 40; ++i) {
    EXPECT_EQ(left[i].count, counted[i].count);
    for (uint32_t k = 0; k < ranges[i].capacity && ranges[i].first < after.size() - k; ++k) {
      EXPECT_EQ(after[ranges[i].first + k].axiomId, i);
      written[ranges[i].first + k] = true;
    }
  }
  for (size_t k = 0; k < after.size(); ++k)
    if (!written[k]) {
      EXPECT_EQ(after[k].axiomId, kPoison) << k;
    }
  gpgpDestroyAsset(grammar);
}

TEST_F(RangesTest, WhatHasNoRangesIsRefused) {
  const GpgpRecorder spawner = makeSpawner(), ordered = makeSpawner(GPGP_SPAWNER_ORDERED),
                     compact = makeSpawner(GPGP_SPAWNER_COMPACT);
  const GpgpAsset grammar = load(spawner, bake(kTown));
  const std::vector<GpgpAxiom> axioms{spawn::makeAxiom(4, 4, 4), spawn::makeAxiom(4, 4, 4)};
  const auto from = host::makeBuffer(device, axioms, kStorage);
  const host::Buffer instances(device, 96 * 64, kStorage), ranges(device, 32, kStorage), draws(device, 400, kStorage);
  GpgpSpawnInfo good = GPGP_SPAWN_INFO_INIT;
  good.grammar = grammar;
  good.axioms = from.range();
  good.axiomCount = 2;
  good.instances = instances.range();
  good.ranges = ranges.range();
  const auto refuses = [&](GpgpRecorder recorder, const GpgpSpawnInfo& info, const char* text) {
    const GpgpFrame f = advance();
    device.submitAndWait([&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordPrepareSpawn(recorder, cmd, &f, &info), GPGP_ERROR_INVALID_ARGUMENT);
    });
    EXPECT_NE(lastMessage().find(text), std::string::npos) << lastMessage();
  };
  refuses(ordered, good, "ordered, compact");
  refuses(compact, good, "ordered, compact");
  GpgpSpawnInfo bad = good;
  bad.draws = draws.range();
  refuses(spawner, bad, "draws.buffer");
  bad = good;
  bad.ranges.size = 31;
  refuses(spawner, bad, "ranges.size is 31");
  GpgpSpawnCamera camera{};
  bad = good;
  bad.camera = &camera;
  refuses(spawner, bad, "the camera's height is 0");
  gpgpDestroyAsset(grammar);
}

} // namespace
