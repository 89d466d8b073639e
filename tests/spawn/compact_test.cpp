// Compact instances: 32 bytes that put every point of a unit shape where the 96 bytes put it, within the stated bound.
#include "../device_test.h"
#include "grammars.h"
#include "host/files.h"
#include "host/memory.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/outputs/compact.h"

#include "gpgp/shaders/compact_instance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

namespace {
using namespace gpgp;
using namespace gpgp::test;

constexpr double kBound = 6e-4; // of the largest extent, as spawn.h says

shader::GpgpCompact unpacked(const GpgpCompactInstance& instance) {
  shader::uvec4 words[2];
  std::memcpy(words, &instance, sizeof words);
  return shader::gpgpUnpackCompact(words[0], words[1]);
}

/// How far the farthest corner is from where the transform puts it, in largest extents, beyond what positions round to.
double errorOf(const GpgpCompactInstance& found, const GpgpInstance& exact) {
  const shader::GpgpCompact compact = unpacked(found);
  const float* m = exact.transform;
  double largest = 0, worst = 0, away = 0;
  for (int c = 0; c < 3; ++c)
    if (c < 2 || exact.size[2] != 0)
      largest = std::max(largest, std::hypot(double(m[c]), double(m[4 + c]), double(m[8 + c])));
  for (int r = 0; r < 3; ++r) away = std::max(away, std::abs(double(m[4 * r + 3])));
  for (int corner = 0; corner < 8; ++corner) {
    const double p[3] = {corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5,
                         exact.size[2] == 0 ? 0
                         : corner & 4       ? 0.5
                                            : -0.5};
    const shader::vec3 at = shader::gpgpCompactPoint(compact, {float(p[0]), float(p[1]), float(p[2])});
    const float place[3] = {at.x, at.y, at.z};
    double squares = 0;
    for (int r = 0; r < 3; ++r) {
      const double expected = m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3];
      squares += (place[r] - expected) * (place[r] - expected);
    }
    worst = std::max(worst, std::sqrt(squares));
  }
  return largest > 6.2e-5 ? std::max(0.0, worst - 4e-7 * (away + largest)) / largest : 0;
}

struct CompactTest : DeviceTest {
  GpgpRecorder spawnerWith(GpgpSpawnerFlags flags) {
    GpgpSpawnerCreateInfo info = GPGP_SPAWNER_CREATE_INFO_INIT;
    info.base.queueFamily = device.graphics().family;
    info.maxShapes = 16384;
    info.maxTerminals = 65536;
    info.maxHostAxioms = 64;
    info.flags = flags;
    return recorder(gpgpCreateSpawner, info);
  }
  template <class Instance> struct Made {
    std::vector<Instance> instances;
    std::vector<VkDrawIndexedIndirectCommand> draws;
    GpgpSpawnReport report;
  };
  template <class Instance>
  Made<Instance> derive(GpgpRecorder spawner, GpgpAsset grammar, const std::vector<GpgpAxiom>& axioms,
                        uint32_t capacity, uint32_t buckets, uint32_t firstInstance = 0) {
    const host::Buffer instances(device, VkDeviceSize(capacity) * sizeof(Instance), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const auto draws = host::makeBuffer(device, std::vector<VkDrawIndexedIndirectCommand>(buckets),
                                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
    info.grammar = grammar;
    info.hostAxioms = axioms.data();
    info.axiomCount = static_cast<uint32_t>(axioms.size());
    info.instances = instances.range();
    info.firstInstance = firstInstance;
    if (buckets) info.draws = draws.range();
    const GpgpFrame frame = advance();
    device.submitAndWait([&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordUpload(context, cmd, &frame, 0, nullptr), GPGP_SUCCESS);
      EXPECT_EQ(gpgpRecordPrepareSpawn(spawner, cmd, &frame, &info), GPGP_SUCCESS) << lastMessage();
    });
    advance();
    Made<Instance> made{{}, {}, GPGP_SPAWN_REPORT_INIT};
    EXPECT_EQ(gpgpGetSpawnReport(spawner, &made.report), GPGP_SUCCESS);
    made.instances = host::download<Instance>(device, instances, made.report.instancesWritten);
    if (buckets) made.draws = host::download<VkDrawIndexedIndirectCommand>(device, draws, buckets);
    return made;
  }
  GpgpAsset grammarOf(const std::vector<uint32_t>& words) {
    GpgpGrammarCreateInfo info = GPGP_GRAMMAR_CREATE_INFO_INIT;
    info.data = words.data();
    info.size = words.size() * 4;
    GpgpAsset grammar = nullptr;
    EXPECT_EQ(gpgpCreateGrammar(context, &info, &grammar), GPGP_SUCCESS);
    return grammar;
  }
};

/// Turned about any axis, scaled, every second one mirrored, some far away.
std::vector<GpgpAxiom> placedAxioms(uint32_t count, float x, float y, float z) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < count; ++i) {
    GpgpAxiom axiom = spawn::makeAxiom(x, y, z, i + 1, i);
    double q[4], length = 0;
    for (double& v : q) {
      v = normal(random);
      length += v * v;
    }
    for (double& v : q) v /= std::sqrt(length);
    const double a = q[0], b = q[1], c = q[2], w = q[3], scale = std::exp2(int(i % 5) - 2);
    const double rows[3][3] = {{1 - 2 * (b * b + c * c), 2 * (a * b - c * w), 2 * (a * c + b * w)},
                               {2 * (a * b + c * w), 1 - 2 * (a * a + c * c), 2 * (b * c - a * w)},
                               {2 * (a * c - b * w), 2 * (b * c + a * w), 1 - 2 * (a * a + b * b)}};
    for (int r = 0; r < 3; ++r) {
      for (int k = 0; k < 3; ++k) axiom.transform[4 * r + k] = float(rows[r][k] * scale * (i % 2 && k == 1 ? -1 : 1));
      axiom.transform[4 * r + 3] = float(normal(random) * (i % 3 ? 50 : 5000));
    }
    axioms.push_back(axiom);
  }
  return axioms;
}

TEST_F(CompactTest, EveryPointIsWithinTheBound) {
  const GpgpRecorder ordered = spawnerWith(GPGP_SPAWNER_ORDERED),
                     compact = spawnerWith(GPGP_SPAWNER_ORDERED | GPGP_SPAWNER_COMPACT);
  double worst = 0;
  size_t count = 0, mirrored = 0;
  for (const auto& [name, x, y, z] : {std::tuple("suburban_house", 24.f, 8.f, 20.f),
                                      {"commercial", 30.f, 45.f, 30.f},
                                      {"mc_spaceship", 16.f, 4.f, 24.f},
                                      {"tree_4_3", 1.f, 6.f, 1.f}}) {
    const auto words = bake(host::readText(std::string(GPGP_SAMPLE_GRAMMARS "/") + name + ".pga"));
    const auto axioms = placedAxioms(12, x, y, z);
    const GpgpAsset grammar = grammarOf(words);
    const uint32_t buckets = words[shader::kHeaderBuckets];
    const auto wide = derive<GpgpInstance>(ordered, grammar, axioms, 30000, buckets);
    const auto small = derive<GpgpCompactInstance>(compact, grammar, axioms, 30000, buckets, 100);
    ASSERT_EQ(wide.report.base.status, GPGP_SUCCESS);
    ASSERT_EQ(small.report.base.status, GPGP_SUCCESS);
    ASSERT_EQ(wide.instances.size(), small.instances.size()) << name;
    ASSERT_EQ(std::memcmp(wide.report.keyHash, small.report.keyHash, 8), 0);
    for (uint32_t b = 0; b < buckets; ++b) {
      EXPECT_EQ(small.draws[b].instanceCount, wide.draws[b].instanceCount) << name;
      EXPECT_EQ(small.draws[b].firstInstance, wide.draws[b].firstInstance + 100) << name;
    }
    for (size_t i = 0; i < wide.instances.size(); ++i) {
      const GpgpCompactInstance& found = small.instances[i];
      const GpgpInstance& exact = wide.instances[i];
      ASSERT_EQ(found.seed, exact.seed) << name << ' ' << i;
      ASSERT_EQ(found.terminal, exact.terminal) << name << ' ' << i;
      ASSERT_EQ(found.shape, exact.shape) << name << ' ' << i;
      for (int a = 0; a < 3; ++a)
        ASSERT_NEAR(found.position[a], exact.transform[4 * a + 3], 1e-6 * (10 + std::abs(exact.transform[4 * a + 3])));
      worst = std::max(worst, errorOf(found, exact));
      mirrored += unpacked(found).scale.x < 0;
    }
    count += wide.instances.size();
    gpgpDestroyAsset(grammar);
  }
  EXPECT_LE(worst, kBound);
  EXPECT_GT(worst, kBound / 20); // it is something that is measured
  EXPECT_GT(mirrored, count / 4);
  EXPECT_GT(count, 10000u);
  std::printf("%zu instances, worst error %.3g of the largest extent\n", count, worst);
}

TEST_F(CompactTest, SortedOnesAreTheSameSet) { // without order, and without draws
  const GpgpRecorder compact = spawnerWith(GPGP_SPAWNER_COMPACT),
                     ordered = spawnerWith(GPGP_SPAWNER_ORDERED | GPGP_SPAWNER_COMPACT);
  const auto words = bake(host::readText(GPGP_SAMPLE_GRAMMARS "/suburban_house.pga"));
  const auto axioms = placedAxioms(5, 24, 8, 20);
  const GpgpAsset grammar = grammarOf(words);
  const auto bytes = [](std::vector<GpgpCompactInstance> all) {
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return std::memcmp(&a, &b, sizeof a) < 0; });
    std::vector<uint8_t> result(all.size() * sizeof all[0]);
    std::memcpy(result.data(), all.data(), result.size());
    return result;
  };
  const auto expected = bytes(derive<GpgpCompactInstance>(ordered, grammar, axioms, 10000, 0).instances);
  EXPECT_GT(expected.size(), 32u * 1000);
  EXPECT_EQ(bytes(derive<GpgpCompactInstance>(compact, grammar, axioms, 10000, 0).instances), expected);
  const auto sorted = derive<GpgpCompactInstance>(compact, grammar, axioms, 10000, words[shader::kHeaderBuckets]);
  EXPECT_EQ(bytes(sorted.instances), expected);
  // A buffer that is too small: what is written is valid, and the report says so.
  const auto few = derive<GpgpCompactInstance>(compact, grammar, axioms, 100, 0);
  EXPECT_EQ(few.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(few.report.instancesWritten, 100u);
  gpgpDestroyAsset(grammar);
}

TEST_F(CompactTest, WhatCannotBeIsRefused) {
  GpgpSpawnerCreateInfo info = GPGP_SPAWNER_CREATE_INFO_INIT;
  info.base.queueFamily = device.graphics().family;
  const GpgpVertexLayout layout{12, 1, {{GPGP_VERTEX_POSITION, VK_FORMAT_R32G32B32_SFLOAT, 0}}};
  info.vertices = &layout;
  info.flags = GPGP_SPAWNER_COMPACT;
  GpgpRecorder none = nullptr;
  EXPECT_EQ(gpgpCreateSpawner(context, &info, &none), GPGP_ERROR_INVALID_ARGUMENT);
  const GpgpRecorder compact = spawnerWith(GPGP_SPAWNER_COMPACT);
  const auto words = bake("axiom Box A;\nterminal T (1, 0);\nA = T;\n");
  const GpgpAsset grammar = grammarOf(words);
  const host::Buffer buffer(device, 4096, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const GpgpAxiom axiom = spawn::makeAxiom(1, 1, 1);
  GpgpSpawnInfo spawn = GPGP_SPAWN_INFO_INIT;
  spawn.grammar = grammar;
  spawn.hostAxioms = &axiom;
  spawn.axiomCount = 1;
  spawn.instances = spawn.draws = buffer.range();
  const GpgpFrame frame = advance();
  device.submitAndWait([&](VkCommandBuffer cmd) {
    EXPECT_EQ(gpgpRecordUpload(context, cmd, &frame, 0, nullptr), GPGP_SUCCESS);
    spawn.flags = GPGP_SPAWN_REGIONS;
    EXPECT_EQ(gpgpRecordPrepareSpawn(compact, cmd, &frame, &spawn), GPGP_ERROR_INVALID_ARGUMENT);
    spawn.flags = 0;
    spawn.instances.size = 31;
    EXPECT_EQ(gpgpRecordPrepareSpawn(compact, cmd, &frame, &spawn), GPGP_ERROR_INVALID_ARGUMENT);
    spawn.instances.size = 4096;
    spawn.flags = GPGP_SPAWN_REGIONS;
    spawn.firstInstance = 3;
    EXPECT_EQ(gpgpRecordPrepareSpawn(spawnerWith(GPGP_SPAWNER_ORDERED), cmd, &frame, &spawn),
              GPGP_ERROR_INVALID_ARGUMENT);
  });
  messages.clear();
  gpgpDestroyAsset(grammar);
}

TEST(CompactRotationTest, AnyRotationTurnsPointsByTheBound) { // against quaternions in doubles
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  double worst = 0;
  for (int i = 0; i < 300000; ++i) {
    double q[4], length = 0;
    for (double& v : q) {
      v = normal(random);
      length += v * v;
    }
    for (double& v : q) v /= std::sqrt(length);
    if (i < 64) { // where another component becomes the largest
      const double largest = 1 + ((i >> 4) - 1.5) * 1e-7, all = std::sqrt(3 + largest * largest);
      for (int k = 0; k < 4; ++k) q[k] = (i >> k & 1 ? 1 : -1) * (k == 2 ? largest : 1) / all;
    }
    const shader::uvec3 bits = shader::packRotation({float(q[0]), float(q[1]), float(q[2]), float(q[3])});
    const shader::vec4 back = shader::gpgpCompactRotation(bits.x | bits.y << 16, bits.z);
    const double dot = q[0] * back.x + q[1] * back.y + q[2] * back.z + q[3] * back.w;
    const double norm = std::sqrt(double(back.x) * back.x + double(back.y) * back.y + double(back.z) * back.z +
                                  double(back.w) * back.w);
    ASSERT_NEAR(norm, 1, 1e-6);
    double apart = 0; // half the angle, as far as it is small
    const double parts[4] = {back.x, back.y, back.z, back.w};
    for (int k = 0; k < 4; ++k) apart += std::pow(q[k] - (dot < 0 ? -1 : 1) * parts[k] / norm, 2);
    worst = std::max(worst, 2 * std::sqrt(apart));
  }
  EXPECT_LT(worst, 1.55e-4);
  EXPECT_GT(worst, 1e-5);
}

TEST(CompactRotationTest, FlatBoxesHaveNormals) {
  GpgpCompactInstance flat{};
  for (int axis = 0; axis < 3; ++axis) flat.scale[axis] = 0x4400; // 4 m
  flat.scale[1] = 0;
  const shader::uvec3 bits = shader::packRotation({0, 0, 0, 1});
  flat.rotation[0] = uint16_t(bits.x), flat.rotation[1] = uint16_t(bits.y), flat.rotation[2] = uint16_t(bits.z);
  const shader::GpgpCompact box = unpacked(flat);
  for (int axis = 0; axis < 3; ++axis) {
    shader::vec3 normal(0);
    normal[axis] = -1;
    const shader::vec3 n = shader::gpgpCompactNormal(box, normal);
    const float length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    ASSERT_TRUE(std::isfinite(length) && length > 0) << axis;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(n[k] / length, normal[k], 2e-4f) << axis;
  }
}

TEST(CompactRotationTest, HalfFloatsAreTheNearest) {
  for (uint32_t h = 0x400; h < 0x7bff; ++h) { // every one there is, what lies between it and the next, and their middle
    const float value = shader::gpgpHalf(h), next = shader::gpgpHalf(h + 1);
    ASSERT_LT(value, next);
    ASSERT_EQ(shader::halfBits(value), h);
    ASSERT_EQ(shader::halfBits(-value), h | 0x8000);
    ASSERT_EQ(shader::halfBits(value + (next - value) * 0.49f), h);
    ASSERT_EQ(shader::halfBits(value + (next - value) * 0.51f), h + 1);
  }
  EXPECT_EQ(shader::gpgpHalf(0x3c00), 1.0f);
  EXPECT_EQ(shader::gpgpHalf(0xc000), -2.0f);
  EXPECT_EQ(shader::halfBits(1e30f), 0x7bffu);
  EXPECT_EQ(shader::halfBits(1e-6f), 0u);
}

} // namespace
