// Positions that another step of the engine writes anew between two records, as skinning does: the same geometry set
// and the same buffer, and each record sees what is in it then.
#include "gpu.h"

#include <cmath>

namespace gpgp::test {
namespace {
using namespace visibility;

/// Vertices of 20 bytes, their positions from the eighth on.
Scene restPose() {
  Scene scene = sheet(3, 12, 0.3f);
  std::vector<float> skinned;
  for (size_t i = 0; i < scene.positions.size(); i += 3)
    skinned.insert(skinned.end(), {7.0f, -7.0f, scene.positions[i], scene.positions[i + 1], scene.positions[i + 2]});
  scene.positions = skinned;
  scene.params.positionStride = 20;
  scene.params.positionOffset = 8;
  scene.addDraw(0);
  scene.setCamera(perspective(1.0f, 1.0f, 0.1f, 10.0f) * lookAt({0.2f, 0.1f, 2.5f}, {0, 0, 0}), 96, 96);
  return scene;
}

/// Rolled up: half of it shows its back, and a part hides another.
Scene posed(Scene scene) {
  for (size_t i = 2; i < scene.positions.size(); i += 5) {
    const float turn = scene.positions[i] * 3;
    scene.positions[i] = std::sin(turn) * 0.5f;
    scene.positions[i + 2] += std::cos(turn) * 0.5f;
  }
  return scene;
}

struct SkinnedTest : VisibilityGpuTest {
  GpgpVisibilityInfo info(const Scene& scene, const SceneBuffers& buffers, GpgpAsset set, GpgpSamplingMethod method,
                          const host::Buffer& bits) {
    GpgpVisibilityInfo result = sampleInfo(scene, buffers, set);
    result.method = method;
    result.visibleBits = bits.range(
        {}, {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED});
    return result;
  }
};

TEST_F(SkinnedTest, PositionsThatTheGpuWritesBetweenTwoRecordsMove) {
  const GpgpRecorder recorder =
      createRecorder(96, 96, 4096, false, GPGP_SAMPLING_STANDARD_BIT | GPGP_SAMPLING_EXACT_BIT);
  for (const GpgpSamplingMethod method : {GPGP_SAMPLING_STANDARD, GPGP_SAMPLING_EXACT}) {
    Scene before = restPose(), after = posed(before);
    const auto cpu = [method](Scene& scene) {
      return (method == GPGP_SAMPLING_EXACT ? sampleExactOnCpu(scene.input()) : sampleOnCpu(scene.input())).bits;
    };
    ASSERT_NE(cpu(before), cpu(after));
    const SceneBuffers buffers(device, before), source(device, after);
    const GpgpAsset set = createGeometrySet(before);
    upload();
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const VkDeviceSize words = cpu(before).size();
    const host::Buffer first(device, words * 4, kStorage), second(device, words * 4, kStorage);
    const GpgpAccess written{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                             VK_IMAGE_LAYOUT_UNDEFINED};
    const GpgpFrame frame = advance();
    device.submitAndWait(queue(), [&](VkCommandBuffer commands) {
      GpgpVisibilityInfo record = info(before, buffers, set, method, first);
      record.positions = buffers.positions.range({}, written);
      EXPECT_EQ(gpgpRecordPrepareVisibility(recorder, commands, &frame, &record), GPGP_SUCCESS);
      const VkBufferCopy all{0, 0, buffers.positions.size()};
      device.vk().vkCmdCopyBuffer(commands, source.positions.handle(), buffers.positions.handle(), 1, &all);
      record = info(before, buffers, set, method, second);
      record.positions = buffers.positions.range(written, {});
      EXPECT_EQ(gpgpRecordPrepareVisibility(recorder, commands, &frame, &record), GPGP_SUCCESS);
    });
    EXPECT_EQ(host::download<uint32_t>(device, first, words), cpu(before)) << "method " << method;
    EXPECT_EQ(host::download<uint32_t>(device, second, words), cpu(after)) << "method " << method;
    gpgpDestroyAsset(set);
  }
}

// Bounds of clusters are those of the positions in the buffer: computed again with each recording that does not keep
// them, and right as long as what is kept is of the same positions.
TEST_F(SkinnedTest, ClustersFollowThePositionsUnlessTheyAreKept) {
  const GpgpRecorder recorder = createRecorder(96, 96, 4096);
  Scene before = restPose(), after = posed(before);
  const SceneBuffers buffers(device, before), source(device, after);
  const GpgpAsset set = createGeometrySet(before);
  upload();
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  const host::Buffer clusters(device, VkDeviceSize{48} * (before.indices.size() / 192 + 1), kStorage);
  const auto sampled = [&](const host::Buffer& positions, bool keeps) {
    const std::vector<uint32_t> size = sampleOnCpu(before.input()).bits;
    const host::Buffer bits(device, size.size() * 4, kStorage);
    GpgpVisibilityInfo record = info(before, buffers, set, GPGP_SAMPLING_STANDARD, bits);
    record.positions = positions.range();
    record.clusters = clusters.range();
    record.keepClusters = keeps;
    const GpgpFrame frame = advance();
    device.submitAndWait(queue(), [&](VkCommandBuffer commands) {
      EXPECT_EQ(gpgpRecordPrepareVisibility(recorder, commands, &frame, &record), GPGP_SUCCESS);
    });
    return host::download<uint32_t>(device, bits, size.size());
  };
  for (Scene* pose : {&before, &after, &before, &after}) {
    const std::vector<uint32_t> expected = sampleOnCpu(pose->input()).bits;
    const host::Buffer& positions = pose == &before ? buffers.positions : source.positions;
    EXPECT_EQ(sampled(positions, false), expected);
    EXPECT_EQ(sampled(positions, true), expected);
  }
  gpgpDestroyAsset(set);
}

TEST_F(SkinnedTest, PositionsThatTheCpuWritesBetweenTwoRecordsMove) {
  const GpgpRecorder recorder = createRecorder(96, 96, 4096);
  Scene before = restPose(), after = posed(before);
  const SceneBuffers buffers(device, before);
  const GpgpAsset set = createGeometrySet(before);
  upload();
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  const host::Buffer positions(device, buffers.positions.size(), kStorage, host::Memory::host);
  for (Scene* pose : {&before, &after, &before}) {
    const CpuInput input = pose->input();
    std::memcpy(positions.mapped(), input.positions.data(), input.positions.size_bytes());
    const std::vector<uint32_t> expected = sampleOnCpu(input).bits;
    const host::Buffer bits(device, expected.size() * 4, kStorage);
    GpgpVisibilityInfo record = info(before, buffers, set, GPGP_SAMPLING_STANDARD, bits);
    record.positions =
        positions.range({VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_WRITE_BIT, VK_IMAGE_LAYOUT_UNDEFINED});
    const GpgpFrame frame = advance();
    device.submitAndWait(queue(), [&](VkCommandBuffer commands) {
      EXPECT_EQ(gpgpRecordPrepareVisibility(recorder, commands, &frame, &record), GPGP_SUCCESS);
    });
    EXPECT_EQ(host::download<uint32_t>(device, bits, expected.size()), expected);
  }
  gpgpDestroyAsset(set);
}

} // namespace
} // namespace gpgp::test
