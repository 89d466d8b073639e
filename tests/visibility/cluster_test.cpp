// Clusters that are out of sight are left out, and nothing else changes: records with clusters against records without,
// against the CPU reference, and the test itself against what becomes of each triangle.
#include "gpu.h"

#include "visibility/shared/cluster.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <limits>
#include <random>

namespace gpgp::test {
namespace {
using namespace visibility;

struct Dice {
  std::mt19937 engine;
  float between(float a, float b) { return a + (b - a) * static_cast<float>(engine() >> 8) * 0x1p-24f; }
  glm::vec3 point(float size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
};

/// A mesh of what was added from `firstIndex` on, in the order that clusters are good for.
uint32_t addOrdered(Scene& scene, uint32_t firstIndex) {
  const std::vector<uint32_t> indices(scene.indices.begin() + firstIndex, scene.indices.end());
  std::vector<uint32_t> order(indices.size() / 3);
  EXPECT_EQ(gpgpOrderTriangles(scene.positions.data(), 12, static_cast<uint32_t>(scene.positions.size() / 3),
                               indices.data(), static_cast<uint32_t>(indices.size()), order.data()),
            GPGP_SUCCESS);
  for (size_t i = 0; i < order.size(); ++i)
    std::copy_n(&indices[size_t(order[i]) * 3], 3, &scene.indices[firstIndex + i * 3]);
  return scene.addMesh(firstIndex);
}

/// A ball of radius 1, its front outside. Triangles at its poles have two equal corners.
uint32_t addBall(Scene& scene, uint32_t segments, uint32_t rings, float bumps, Dice& dice) {
  const auto firstIndex = static_cast<uint32_t>(scene.indices.size());
  std::vector<uint32_t> v;
  for (uint32_t y = 0; y <= rings; ++y)
    for (uint32_t x = 0; x < segments; ++x) {
      const float up = 3.14159265f * static_cast<float>(y) / static_cast<float>(rings);
      const float turn = 6.2831853f * static_cast<float>(x) / static_cast<float>(segments);
      const float r = y == 0 || y == rings ? 1 : 1 + dice.between(-bumps, bumps), flat = y == rings ? 0 : std::sin(up);
      v.push_back(scene.addVertex(std::cos(turn) * flat * r, std::cos(up) * r, -std::sin(turn) * flat * r));
    }
  for (uint32_t y = 0; y < rings; ++y)
    for (uint32_t x = 0; x < segments; ++x) {
      const uint32_t a = v[y * segments + x], b = v[y * segments + (x + 1) % segments];
      const uint32_t c = v[(y + 1) * segments + x], d = v[(y + 1) * segments + (x + 1) % segments];
      scene.indices.insert(scene.indices.end(), {a, c, d, a, d, b});
    }
  return addOrdered(scene, firstIndex);
}

/// Slivers that all face up, of heights down to a hundredth of a millionth of their length.
uint32_t addSlivers(Scene& scene, Dice& dice) {
  const auto firstIndex = static_cast<uint32_t>(scene.indices.size());
  for (int i = 0; i < 192; ++i) {
    const float x = dice.between(-1, 1), z = dice.between(-1, 1), high = std::exp2(dice.between(-20, -4));
    scene.indices.push_back(scene.addVertex(x, 0, z));
    scene.indices.push_back(scene.addVertex(x + 1, 0, z));
    scene.indices.push_back(scene.addVertex(x + dice.between(0, 1), 0, z - high));
  }
  return addOrdered(scene, firstIndex);
}

glm::mat4 anywhere(Dice& dice, float size) {
  glm::mat4 m = glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, -4) + dice.point(12));
  m = glm::rotate(m, dice.between(0, 6), glm::normalize(dice.point(1) + glm::vec3(0, 0, 1.5f)));
  const float mirrored = dice.between(0, 1) < 0.3f ? -1.0f : 1.0f;
  return glm::scale(m, glm::vec3(size * dice.between(0.5f, 2), size * mirrored, size * dice.between(0.5f, 2)));
}

glm::mat4 cameraOf(uint32_t seed, glm::vec3 eye, bool reversed) {
  glm::mat4 projection = perspective(1.1f, 1.6f, 0.2f, 30.0f, reversed);
  if (seed % 5 == 4) { // parallel
    projection = glm::mat4(1.0f);
    projection[0][0] = 0.12f, projection[1][1] = -0.2f;
    projection[2][2] = reversed ? 0.03f : -0.03f, projection[3][2] = reversed ? 1.0f : 0.0f;
  }
  return projection * lookAt(eye, {0.3f, 0.1f, -6});
}

/// Balls, large and small ones down to a hundredth of a pixel, slivers, a sheet through the near plane; with both rules
/// for faces, mirrored, two-sided; bad input where asked for.
Scene clusterScene(uint32_t seed, bool bad) {
  Dice dice{std::mt19937(seed)};
  Scene scene;
  const uint32_t ball = addBall(scene, 40, 24, 0.02f, dice), rough = addBall(scene, 32, 12, 0.3f, dice);
  const uint32_t slivers = addSlivers(scene, dice);
  std::vector<uint32_t> meshes{ball, ball, rough, slivers};
  if (bad) {
    const auto nan = addBall(scene, 16, 8, 0, dice);
    scene.positions[scene.positions.size() - 20 * 3] = std::numeric_limits<float>::quiet_NaN();
    const auto outside = addBall(scene, 16, 8, 0, dice);
    scene.indices[scene.indices.size() - 100] = 1000000;
    meshes.insert(meshes.end(), {nan, outside});
  }
  scene.addDraw(ball, glm::scale(glm::mat4(1.0f), glm::vec3(15)), shader::kClockwise); // around the viewer
  for (int i = 0; i < 60; ++i) {
    const uint32_t mesh = meshes[dice.engine() % meshes.size()];
    const uint32_t flags = dice.engine() % 6 == 0 ? shader::kTwoSided : dice.engine() % 3 ? 0 : shader::kClockwise;
    scene.addDraw(mesh, anywhere(dice, std::exp2(dice.between(-7, 1.5f))), flags);
  }
  scene.setCamera(cameraOf(seed, {0, 0, 3}, seed % 2 == 1), 96, 60, seed % 2 == 1);
  if (seed % 3 == 0) scene.addCamera(cameraOf(seed, {0.4f, 0, 3}, seed % 2 == 1));
  if (bad) scene.params.triangleCount -= 500; // the last draw's numbers
  return scene;
}

/// One of a mesh's clusters, as the GPU makes it.
shader::Cluster clusterOf(const Scene& scene, const shader::Mesh& mesh, uint32_t first) {
  shader::Cluster c{};
  std::vector<shader::Facing> facings;
  glm::vec3 low(1e30f), high(-1e30f), sum(0);
  for (uint32_t t = first; t < std::min(first + 64, mesh.indexCount / 3); ++t) {
    glm::vec3 p[3];
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t vertex = scene.indices[mesh.firstIndex + t * 3 + k] + mesh.vertexOffset;
      if (vertex >= scene.positions.size() / 3) return c;
      p[k] = {scene.positions[vertex * 3], scene.positions[vertex * 3 + 1], scene.positions[vertex * 3 + 2]};
      if (std::isnan(p[k].x + p[k].y + p[k].z)) return c;
      low = glm::min(low, p[k]), high = glm::max(high, p[k]);
    }
    facings.push_back(shader::facingOf(p[0], p[1], p[2]));
    sum += facings.back().normal;
  }
  const glm::vec3 axis = glm::length(sum) > 1e-3f ? glm::normalize(sum) : glm::vec3(0);
  c.spread = 1, c.height = shader::kNoHeight, c.whole = 1;
  for (const shader::Facing& f : facings) {
    c.height = std::min(c.height, f.height);
    if (f.height != shader::kNoHeight) c.spread = std::min(c.spread, shader::cosineOf(f, axis));
  }
  for (int k = 0; k < 3; ++k) c.low[k] = low[k], c.high[k] = high[k], c.axis[k] = axis[k];
  return c;
}

TEST(Clusters, NoTriangleOfAClusterOutOfSightIsDrawn) {
  uint64_t clusters = 0, facing = 0, outside = 0, back = 0, wrong = 0, allBack = 0;
  for (uint32_t seed = 0; seed < 60; ++seed) {
    Scene scene = clusterScene(seed, false);
    if (seed % 4 == 3) { // what is seen lies far from the origin
      const glm::vec3 offset(3000, -1000, 8000);
      for (shader::Draw& draw : scene.draws)
        for (int k = 0; k < 3; ++k) draw.transform[k * 4 + 3] += offset[k];
      scene.setCamera(cameraOf(seed, {0, 0, 3}, true) * glm::translate(glm::mat4(1.0f), -offset), 96, 60, true);
    }
    const uint32_t width = seed % 2 ? 96 : 1920;
    scene.params.width = width, scene.params.height = width * 5 / 8;
    const CpuInput input = scene.input();
    for (uint32_t camera = 0; camera < scene.params.cameraCount; ++camera)
      for (uint32_t d = 0; d < scene.draws.size(); ++d) {
        const shader::Draw& draw = scene.draws[d];
        const shader::Mesh& mesh = scene.meshes[draw.mesh];
        glm::mat4 viewProjection;
        for (int i = 0; i < 16; ++i)
          viewProjection[i / 4][i % 4] = scene.params.viewProjection[camera * 16 + static_cast<uint32_t>(i)];
        for (uint32_t first = 0; first < mesh.indexCount / 3; first += 64) {
          const shader::DrawEntry entry{d, camera, mesh.firstIndex, mesh.indexCount, mesh.vertexOffset};
          uint32_t drawn = 0, turned = 0;
          for (uint32_t t = first; t < std::min(first + 64, mesh.indexCount / 3); ++t) {
            const uint32_t fate = placeTriangle(input, entry, t).fate;
            drawn += fate != shader::kOutside && fate != shader::kBackFacing;
            turned += fate == shader::kBackFacing;
          }
          shader::Cluster c = clusterOf(scene, mesh, first);
          const glm::ivec2 pixels(static_cast<int>(width), static_cast<int>(scene.params.height));
          const bool hidden = isOutOfSight(c, draw, viewProjection, pixels);
          c.spread = 0;
          const bool beside = isOutOfSight(c, draw, viewProjection, pixels);
          ++clusters, facing += drawn > 0, wrong += hidden && drawn > 0, outside += beside, back += hidden && !beside;
          allBack += drawn == 0 && turned > 0;
        }
      }
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(outside, clusters / 20);
  EXPECT_GT(back, allBack / 4); // others face several ways, or are too small to be certain
  EXPECT_GT(facing, clusters / 10);
}

struct ClusterTest : VisibilityGpuTest {};

TEST_F(ClusterTest, RecordsWithClustersEqualThoseWithoutAndTheCpuReference) {
  for (uint32_t seed = 0; seed < 5; ++seed) {
    Scene scene = clusterScene(seed, seed % 2 == 0);
    const CpuInput input = scene.input();
    for (const GpgpSamplingMethod method :
         {GPGP_SAMPLING_STANDARD, GPGP_SAMPLING_EXACT, GPGP_SAMPLING_CONSERVATIVE, GPGP_SAMPLING_NEARBY}) {
      if (method == GPGP_SAMPLING_NEARBY && seed % 5 == 4) continue; // perspective alone
      const std::string what = "seed " + std::to_string(seed) + ", method " + std::to_string(method);
      GpuOptions options;
      options.method = method;
      if (method == GPGP_SAMPLING_NEARBY) options.reach = 0.2f;
      options.byDraw = seed % 3 == 0;
      const GpuResult without = sample(scene, options);
      options.clusters = true;
      const GpuResult with = sample(scene, options);
      if (method == GPGP_SAMPLING_STANDARD) expectEqual(with, sampleOnCpu(input), what);
      if (method == GPGP_SAMPLING_EXACT) expectEqual(with, sampleExactOnCpu(input), what);
      EXPECT_EQ(with.bits, without.bits) << what;
      EXPECT_EQ(with.depth, without.depth) << what;
      if (method != GPGP_SAMPLING_EXACT) { // whose lists lie there later
        EXPECT_EQ(with.ids, without.ids) << what;
      }
      EXPECT_EQ(with.list, without.list) << what;
      EXPECT_EQ(with.sizes, without.sizes) << what;
      EXPECT_EQ(with.drawTriangles, without.drawTriangles) << what;
      EXPECT_EQ(with.extents, without.extents) << what;
      EXPECT_EQ(with.report.triangles, without.report.triangles) << what;
      EXPECT_EQ(with.report.skippedTriangles, without.report.skippedTriangles) << what;
      EXPECT_EQ(with.report.neededCandidates, without.report.neededCandidates) << what;
      EXPECT_EQ(with.report.neededPairs, without.report.neededPairs) << what;
      EXPECT_LT(with.keptChunks, with.chunks * 3 / 4) << what; // a quarter is left out at least
      EXPECT_GT(with.keptChunks, 0u) << what;
    }
  }
}

TEST_F(ClusterTest, KeptClustersServeOtherCamerasAndNewOnesNewPositions) {
  Scene scene = clusterScene(1, false);
  const SceneBuffers buffers(device, scene);
  const GpgpAsset set = createGeometrySet(scene);
  const GpgpRecorder recorder = createRecorder(96, 60, 1u << 17);
  upload();
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  const host::Buffer clusters(device, 1000 * shader::kClusterBytes, kStorage);
  const host::Buffer bits(device, (scene.params.triangleCount + 31) / 32 * 4, kStorage);
  const GpgpAccess copied{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, {}};
  const GpgpAccess shaders{
      VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT, {}};
  for (int step = 0; step < 4; ++step) {
    const bool moved = step == 2;
    if (step == 1 || step == 3) scene.setCamera(cameraOf(1, {static_cast<float>(step) - 3, 1, 3}, true), 96, 60, true);
    if (moved)
      for (size_t i = 0; i < scene.positions.size(); ++i) scene.positions[i] = -scene.positions[i] * 0.7f;
    const CpuInput input = scene.input();
    const SceneBuffers now(device, scene);
    GpgpVisibilityInfo info = sampleInfo(scene, now, set);
    info.clusters = clusters.range(step ? shaders : GpgpAccess{}, shaders);
    info.keepClusters = step == 1 || step == 3;
    info.visibleBits = bits.range(step ? copied : GpgpAccess{}, copied);
    const GpgpFrame frame = advance();
    device.submitAndWait(queue(), [&](VkCommandBuffer commands) {
      EXPECT_EQ(gpgpRecordPrepareVisibility(recorder, commands, &frame, &info), GPGP_SUCCESS);
    });
    const std::vector<uint32_t> expected = sampleOnCpu(input).bits;
    EXPECT_EQ(host::download<uint32_t>(device, bits, expected.size()), expected) << step;
  }
  gpgpDestroyAsset(set);
}

TEST_F(ClusterTest, ArgumentsAreChecked) {
  Scene scene = clusterScene(1, false);
  scene.input();
  const SceneBuffers buffers(device, scene);
  const GpgpAsset set = createGeometrySet(scene);
  const GpgpRecorder recorder = createRecorder(96, 60, 1u << 17);
  upload();
  const host::Buffer bits(device, 1u << 20, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  uint32_t clusters = 0;
  for (const shader::Mesh& mesh : scene.meshes) clusters += (mesh.indexCount / 3 + 63) / 64;
  const host::Buffer small(device, clusters * shader::kClusterBytes - 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  GpgpVisibilityInfo info = sampleInfo(scene, buffers, set);
  info.visibleBits = bits.range();
  const GpgpFrame frame = advance();
  const auto recorded = [&] {
    GpgpResult result = GPGP_SUCCESS;
    device.submitAndWait(queue(), [&](VkCommandBuffer commands) {
      result = gpgpRecordPrepareVisibility(recorder, commands, &frame, &info);
    });
    return result;
  };
  info.clusters = small.range();
  EXPECT_EQ(recorded(), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(messages.back().find("clusters"), std::string::npos) << messages.back();
  info.clusters = bits.range();
  info.commands = buffers.draws.range();
  info.commandCount = 1;
  EXPECT_EQ(recorded(), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(messages.back().find("clusters"), std::string::npos) << messages.back();
  messages.clear();
  gpgpDestroyAsset(set);
}

TEST(OrderTriangles, IsAnOrderInWhichNeighboursFaceOneWay) {
  Dice dice{std::mt19937(1)};
  Scene scene;
  addBall(scene, 64, 40, 0.01f, dice);
  const shader::Mesh& mesh = scene.meshes[0];
  uint32_t oneWay = 0, clusters = 0;
  for (uint32_t first = 0; first < mesh.indexCount / 3; first += 64, ++clusters)
    oneWay += clusterOf(scene, mesh, first).spread > 0.3f;
  EXPECT_GT(oneWay, clusters * 3 / 4);

  std::vector<uint32_t> order(mesh.indexCount / 3);
  const auto call = [&](uint32_t vertices, uint32_t indices, uint32_t stride = 12) {
    return gpgpOrderTriangles(scene.positions.data(), stride, vertices, scene.indices.data(), indices, order.data());
  };
  const auto vertices = static_cast<uint32_t>(scene.positions.size() / 3);
  ASSERT_EQ(call(vertices, mesh.indexCount), GPGP_SUCCESS);
  std::sort(order.begin(), order.end());
  for (uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
  scene.positions[7] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(call(vertices, mesh.indexCount), GPGP_SUCCESS);
  EXPECT_EQ(call(vertices, 0), GPGP_SUCCESS);
  EXPECT_EQ(call(vertices - 1, mesh.indexCount), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(call(vertices, 4), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(call(vertices, 3, 8), GPGP_ERROR_INVALID_ARGUMENT);
}

} // namespace
} // namespace gpgp::test
