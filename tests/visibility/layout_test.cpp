// One layout in C++ and GLSL: offsets and sizes of shared structs as the compiled shaders have them, and as C++ has
// them.
#include "visibility/shared/layout.h"

#include "visibility/sampling/budgets.h"
#include "visibility/shared/cluster.h"

#include "shaders/named_chunks.spv.h"
#include "shaders/named_finish.spv.h"
#include "shaders/named_large.spv.h"
#include "shaders/named_plan.spv.h"
#include "shaders/named_small.spv.h"

#include <cstddef>
#include <cstring>
#include <gpgp/visibility.h>
#include <gtest/gtest.h>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace gpgp::test {
namespace {

/// Offsets of a struct's members by name, from a module's debug names and decorations.
std::map<std::string, size_t> offsetsOf(std::span<const uint32_t> module, const std::string& name) {
  constexpr uint32_t kName = 5, kMemberName = 6, kMemberDecorate = 72, kOffset = 35;
  std::map<uint32_t, std::string> structs;
  std::map<std::pair<uint32_t, uint32_t>, std::string> members;
  std::map<std::string, size_t> offsets;
  for (size_t i = 5; i < module.size(); i += module[i] >> 16) {
    const uint32_t code = module[i] & 0xffffu;
    if (code == kName) structs[module[i + 1]] = reinterpret_cast<const char*>(&module[i + 2]);
    if (code == kMemberName) members[{module[i + 1], module[i + 2]}] = reinterpret_cast<const char*>(&module[i + 3]);
    if (code == kMemberDecorate && module[i + 3] == kOffset && structs[module[i + 1]] == name)
      offsets[members[{module[i + 1], module[i + 2]}]] = module[i + 4];
  }
  return offsets;
}

#define EXPECT_OFFSET(offsets, Struct, member)                                                                         \
  ASSERT_TRUE(offsets.count(#member));                                                                                 \
  EXPECT_EQ(offsets.at(#member), offsetof(shader::Struct, member)) << #member

TEST(Layout, ParamsAgree) {
  for (const auto& offsets : {offsetsOf(named_small, "Params"), offsetsOf(named_finish, "Params")}) {
    EXPECT_EQ(offsets.size(), 70u);
    EXPECT_OFFSET(offsets, Params, cameraLayers);
    EXPECT_OFFSET(offsets, Params, alphaTests);
    EXPECT_OFFSET(offsets, Params, nonOpaqueAt);
    EXPECT_OFFSET(offsets, Params, viewProjection);
    EXPECT_OFFSET(offsets, Params, width);
    EXPECT_OFFSET(offsets, Params, reversedDepth);
    EXPECT_OFFSET(offsets, Params, drawCount);
    EXPECT_OFFSET(offsets, Params, triangleCount);
    EXPECT_OFFSET(offsets, Params, maxItems);
    EXPECT_OFFSET(offsets, Params, vertexCount);
    EXPECT_OFFSET(offsets, Params, listCapacity);
    EXPECT_OFFSET(offsets, Params, hasList);
    EXPECT_OFFSET(offsets, Params, writeCount);
    EXPECT_OFFSET(offsets, Params, viewWords);
    EXPECT_OFFSET(offsets, Params, largeRecords);
    EXPECT_OFFSET(offsets, Params, cameraCount);
    EXPECT_OFFSET(offsets, Params, epsilonDynamic);
    EXPECT_OFFSET(offsets, Params, depthScales);
    EXPECT_OFFSET(offsets, Params, cameraOrigins);
    EXPECT_OFFSET(offsets, Params, origins);
    EXPECT_OFFSET(offsets, Params, hasOrigins);
    EXPECT_OFFSET(offsets, Params, hasNumbers);
    EXPECT_OFFSET(offsets, Params, clusterCount);
    EXPECT_OFFSET(offsets, Params, maxLate);
  }
}

TEST(Layout, CountersAgree) {
  for (const auto& offsets : {offsetsOf(named_large, "Counters"), offsetsOf(named_finish, "Counters")}) {
    EXPECT_EQ(offsets.size(), 68u);
    EXPECT_OFFSET(offsets, Counters, nonOpaque);
    EXPECT_OFFSET(offsets, Counters, nonOpaqueArgs);
    EXPECT_OFFSET(offsets, Counters, triangles);
    EXPECT_OFFSET(offsets, Counters, skippedDraws);
    EXPECT_OFFSET(offsets, Counters, listed);
    EXPECT_OFFSET(offsets, Counters, hasList);
    EXPECT_OFFSET(offsets, Counters, mediumCount);
    EXPECT_OFFSET(offsets, Counters, smallArgs);
    EXPECT_OFFSET(offsets, Counters, unfoldArgs);
    EXPECT_OFFSET(offsets, Counters, mediumArgs);
    EXPECT_OFFSET(offsets, Counters, largeArgs);
    EXPECT_OFFSET(offsets, Counters, splitArgs);
    EXPECT_OFFSET(offsets, Counters, leftArgs);
    EXPECT_OFFSET(offsets, Counters, overlapArgs);
    EXPECT_OFFSET(offsets, Counters, winnerArgs);
    EXPECT_OFFSET(offsets, Counters, onScreenArgs);
    EXPECT_OFFSET(offsets, Counters, longArgs);
    EXPECT_OFFSET(offsets, Counters, keptArgs);
    EXPECT_OFFSET(offsets, Counters, decidedPixels);
    EXPECT_OFFSET(offsets, Counters, dueStale);
  }
  EXPECT_EQ(offsetof(shader::Counters, ended) + 4, shader::kReportWords * 4);
}

TEST(Layout, TheEnginesStructsAreTheShaders) {
  const auto draw = offsetsOf(named_small, "Draw");
  EXPECT_EQ(draw.at("transform"), offsetof(GpgpVisibilityDraw, transform));
  EXPECT_EQ(draw.at("mesh"), offsetof(GpgpVisibilityDraw, mesh));
  EXPECT_EQ(draw.at("firstTriangle"), offsetof(GpgpVisibilityDraw, firstTriangle));
  EXPECT_EQ(draw.at("flags"), offsetof(GpgpVisibilityDraw, flags));
  EXPECT_EQ(draw.at("origin"), offsetof(GpgpVisibilityDraw, origin));
  const auto mesh = offsetsOf(named_plan, "Mesh");
  EXPECT_EQ(mesh.at("firstIndex"), offsetof(GpgpMesh, firstIndex));
  EXPECT_EQ(mesh.at("indexCount"), offsetof(GpgpMesh, indexCount));
  const auto cluster = offsetsOf(named_chunks, "Cluster");
  EXPECT_EQ(cluster.at("axis"), offsetof(shader::Cluster, axis));
  EXPECT_EQ(cluster.at("whole"), offsetof(shader::Cluster, whole));
  EXPECT_EQ(mesh.at("vertexOffset"), offsetof(GpgpMesh, vertexOffset));
  EXPECT_EQ(sizeof(GpgpTriangleSize), 12u);
}

TEST(Layout, ListDispatchesCoverTheListInRows) {
  for (const uint32_t listed : {0u, 1u, 64u, 65u, 4194240u, 4194241u, 100000000u, 0xffffffffu}) {
    const glm::uvec3 groups = shader::listGroups(listed);
    EXPECT_LE(groups.x, 65535u);
    EXPECT_LE(groups.y, 65535u);
    EXPECT_EQ(groups.z, 1u);
    const uint64_t covered = uint64_t(groups.x) * groups.y * 64;
    EXPECT_GE(covered, listed);
    EXPECT_LT(covered, uint64_t(listed) + 64 * 65536);
  }
  EXPECT_EQ(shader::listGroups(0), glm::uvec3(0, 1, 1));
  EXPECT_EQ(shader::listGroups(4194240), glm::uvec3(65535, 1, 1));
  EXPECT_EQ(shader::listGroups(4194241), glm::uvec3(65535, 2, 1));
}

// Else the views of a cell would draw most of what is large the slow way.
TEST(Budgets, RecordsGrowWithTheCamerasAsFarAsTheDeviceBindsThem) {
  VkPhysicalDeviceLimits limits{};
  limits.maxStorageBufferRange = 1u << 27;
  GpgpVisibilityRecorderCreateInfo info = GPGP_VISIBILITY_RECORDER_CREATE_INFO_INIT;
  info.maxTriangles = 1u << 24;
  const auto recordsFor = [&](uint32_t cameras) {
    info.maxCameras = cameras;
    const visibility::Budgets budgets(info, limits);
    return std::pair(budgets.mediumRecords(), budgets.largeRecords());
  };
  EXPECT_EQ(recordsFor(0), std::pair(65536u, 32768u));
  EXPECT_EQ(recordsFor(4), recordsFor(0));
  EXPECT_EQ(recordsFor(32), std::pair(8 * 65536u, 8 * 32768u));
  const auto [medium, large] = recordsFor(128);
  EXPECT_GT(medium, 8 * 65536u);
  EXPECT_LE((uint64_t(medium) + large) * visibility::kRecordBytes, limits.maxStorageBufferRange);
  info.maxTriangles = 40;
  EXPECT_EQ(recordsFor(128), std::pair(16384u, 8192u)); // few triangles are many through so many cameras
}

} // namespace
} // namespace gpgp::test
