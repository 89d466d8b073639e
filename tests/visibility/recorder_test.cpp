// The recorder on the GPU against its CPU reference: ids, depth, bits, lists, counts and arguments, bit for bit.
#include "gpu.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <limits>
#include <random>

namespace gpgp::test {
namespace {
using namespace visibility;

TEST_F(VisibilityGpuTest, RandomTrianglesEqualTheCpuReference) {
  const GpgpRecorder recorder = createRecorder(256, 90, 0, true); // also: one recorder for viewports of several sizes
  for (uint32_t seed = 0; seed < 12; ++seed) {
    Scene scene = randomSoup(seed, 20 + 60 * seed, 150 + 7 * seed, 90, seed % 2, seed % 3 == 0);
    const CpuResult cpu = sampleOnCpu(scene.input());
    const GpuResult gpu = sample(scene, recorder, createGeometrySet(scene), {});
    expectEqual(gpu, cpu, "seed " + std::to_string(seed));
    EXPECT_EQ(gpu.list, cpu.list);
    EXPECT_GT(cpu.counters.visible, 0u);
  }
}

TEST_F(VisibilityGpuTest, ColonnadeWithSharedMeshesEqualsTheCpuReference) {
  for (const bool useShort : {false, true}) {
    Scene scene = colonnade(320, 180);
    scene.useShort = useShort;
    const CpuResult cpu = sampleOnCpu(scene.input());
    expectEqual(sample(scene), cpu, "colonnade");
    EXPECT_GT(cpu.counters.coveredPixels, 320u * 90u);
  }
}

TEST_F(VisibilityGpuTest, BunnyEqualsTheCpuReference) {
  Scene scene = bunny(480, 270);
  const CpuResult cpu = sampleOnCpu(scene.input());
  const GpuResult gpu = sample(scene);
  expectEqual(gpu, cpu, "bunny");
  EXPECT_EQ(gpu.list, cpu.list);
  EXPECT_GT(cpu.counters.visible, 5000u);
  EXPECT_EQ(gpu.report.base.status, GPGP_SUCCESS);
}

TEST_F(VisibilityGpuTest, ManyBunniesFarAwayInThousandsOfDrawsEqualTheCpuReference) {
  Scene scene = bunny(256, 256);
  scene.meshes = {{0, 3000, 0}, {3000, 6000, 0}, {9000, 0, 0}};
  scene.draws.clear();
  scene.params.triangleCount = 0;
  for (int i = 0; i < 900; ++i) {
    const glm::vec3 at(float(i % 30 - 15) * 0.8f, float(i / 30 - 15) * 0.8f, -20);
    scene.addDraw(static_cast<uint32_t>(i % 3), glm::translate(glm::mat4(1.0f), at));
  }
  const CpuResult cpu = sampleOnCpu(scene.input());
  expectEqual(sample(scene), cpu, "bunnies");
  EXPECT_GT(cpu.counters.visible, 1000u);
}

TEST_F(VisibilityGpuTest, BadInputIsSkippedAndCountedAsByTheCpuReference) {
  Scene scene = randomSoup(7, 300, 128, 128, true, false);
  std::mt19937 random(1);
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 2e36f, -3e38f,
                       1e-42f};
  for (int i = 0; i < 60; ++i) scene.positions[random() % scene.positions.size()] = bad[i % 5];
  for (int i = 0; i < 30; ++i) scene.indices[random() % scene.indices.size()] = i % 2 ? 900 + i : 0xfffffff0u + i % 16;
  scene.addDraw(0).mesh = 77;
  scene.meshes.push_back({890, 30, 0});         // past the end of the indices
  scene.meshes.push_back({0, 30, 0xffffff00u}); // vertex offset beyond 32 bits
  scene.addDraw(1);
  scene.addDraw(2);
  auto& nan = scene.addDraw(0);
  nan.transform[5] = std::numeric_limits<float>::quiet_NaN();
  scene.params.triangleCount -= 10; // the last draw's last triangles have no bit
  const CpuResult cpu = sampleOnCpu(scene.input());
  const GpuResult gpu = sample(scene);
  expectEqual(gpu, cpu, "bad input");
  EXPECT_EQ(cpu.counters.skippedDraws, 1u);
  EXPECT_GT(cpu.counters.skippedTriangles, 300u);
  EXPECT_GT(cpu.counters.visible, 15u);
}

TEST_F(VisibilityGpuTest, NumbersOfAllSizesEqualTheCpuReference) {
  std::mt19937 random(11);
  const GpgpRecorder recorder = createRecorder(64, 64, 0, true);
  uint32_t visible = 0, skipped = 0;
  for (int n = 0; n < 10; ++n) {
    Scene scene;
    const int reach = n < 5 ? 12 : 115; // powers of two
    const auto number = [&] {
      const float v = std::ldexp(float(random() % 2048) / 1024 - 1, int(random() % (2 * reach)) - reach);
      return random() % 16 ? v : 0.0f;
    };
    for (int i = 0; i < 900; ++i) scene.indices.push_back(scene.addVertex(number(), number(), number()));
    scene.addDraw(scene.addMesh(0), glm::mat4(1.0f), shader::kTwoSided);
    glm::mat4 any(0.0f);
    for (int i = 0; i < 16; ++i) any[i / 4][i % 4] = number();
    scene.addDraw(0, any, shader::kTwoSided);
    if (n % 2)
      scene.setCamera(perspective(1.5f, 1.0f, 0.01f, 1000.0f) * lookAt({0, 0, 2}, {0, 0, 0}), 64, 64);
    else
      scene.setCamera(any, 64, 64, n % 4 == 0);
    const CpuResult cpu = sampleOnCpu(scene.input());
    expectEqual(sample(scene, recorder, createGeometrySet(scene), {}), cpu, "scene " + std::to_string(n));
    visible += cpu.counters.visible;
    skipped += cpu.counters.skippedTriangles;
  }
  EXPECT_GT(visible, 10u);
  EXPECT_GT(skipped, 10u);
}

TEST_F(VisibilityGpuTest, LongViewportsEqualTheCpuReference) {
  for (const glm::uvec2 size : {glm::uvec2(8192, 9), glm::uvec2(7, 8192), glm::uvec2(1, 1)}) {
    Scene scene = colonnade(size.x, size.y);
    scene.setCamera(perspective(1.0f, 1.0f, 0.1f, 100.0f) * lookAt({0.4f, 0.3f, 4}, {0, -0.5f, -4}), size.x, size.y);
    const CpuResult cpu = sampleOnCpu(scene.input());
    expectEqual(sample(scene), cpu, std::to_string(size.x));
    EXPECT_GT(cpu.counters.coveredPixels, 0u);
  }
}

TEST_F(VisibilityGpuTest, AViewportThatTheDeviceCannotBindIsRefusedWithItsSize) {
  GpgpVisibilityRecorderCreateInfo info = GPGP_VISIBILITY_RECORDER_CREATE_INFO_INIT;
  info.base.queueFamily = queue().family;
  info.base.engineScratch = VK_TRUE;
  info.maxWidth = info.maxHeight = 8192;
  GpgpRecorder recorder = nullptr;
  const GpgpResult result = gpgpCreateVisibilityRecorder(context, &info, &recorder);
  if (device.properties().limits.maxStorageBufferRange >= 8192u * 8192u * 8u) {
    EXPECT_EQ(result, GPGP_SUCCESS);
  } else {
    EXPECT_EQ(result, GPGP_ERROR_UNSUPPORTED);
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_NE(messages[0].find("536870912"), std::string::npos) << messages[0];
  }
}

TEST_F(VisibilityGpuTest, AListTooSmallIsFilledAndReported) {
  Scene scene = bunny(200, 200);
  const CpuResult cpu = sampleOnCpu(scene.input());
  ASSERT_GT(cpu.list.size(), 1000u);
  const GpuResult gpu = sample(scene, {.listTriangles = 777, .tag = 42});
  EXPECT_EQ(gpu.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(gpu.report.visible, cpu.list.size());
  EXPECT_EQ(gpu.report.listed, 777u);
  ASSERT_EQ(gpu.list.size(), 777u);
  EXPECT_TRUE(std::includes(cpu.list.begin(), cpu.list.end(), gpu.list.begin(), gpu.list.end()));
  EXPECT_EQ(std::adjacent_find(gpu.list.begin(), gpu.list.end()), gpu.list.end());
  EXPECT_EQ(gpu.count, (std::vector<uint32_t>{uint32_t(cpu.list.size()), 13, 1, 1}));
  EXPECT_EQ(gpu.bits, cpu.bits);
}

TEST_F(VisibilityGpuTest, OutputsThatAreLeftOutAreNotNeeded) {
  Scene scene = randomSoup(3, 100, 64, 64, true, false);
  const CpuResult cpu = sampleOnCpu(scene.input());
  const GpuResult gpu = sample(scene, {.listTriangles = 0, .count = false});
  expectEqual(gpu, cpu, "bits only");
  EXPECT_EQ(gpu.report.base.status, GPGP_SUCCESS);
  EXPECT_EQ(gpu.report.listed, 0u);
  EXPECT_EQ(gpu.count, std::vector<uint32_t>(4, 0xdeadbeef));
}

TEST_F(VisibilityGpuTest, TooManyTrianglesAreCutAndReported) {
  Scene scene = colonnade(160, 90);
  scene.params.maxItems = 100;
  const CpuResult cpu = sampleOnCpu(scene.input());
  const GpuResult gpu = sample(scene, {}, 100);
  expectEqual(gpu, cpu, "cut");
  EXPECT_EQ(gpu.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(gpu.report.neededTriangles, scene.params.triangleCount);
}

// Few records for triangles that workgroups share: the rest is drawn the slow way, and nothing is lost.
TEST_F(VisibilityGpuTest, TrianglesWithoutARecordAreDrawnAllTheSame) {
  Scene scene; // triangles all round the camera, so that most are cut into several pieces
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-40.0f, 40.0f);
  for (uint32_t i = 0; i < 120; ++i) scene.indices.push_back(scene.addVertex(unit(random), unit(random), unit(random)));
  scene.addDraw(scene.addMesh(0), glm::mat4(1.0f), shader::kTwoSided);
  scene.setCamera(perspective(1.5f, 1.5f, 0.05f, 50.0f), 300, 200);
  const CpuInput input = scene.input();
  uint32_t pieces = 0;
  for (uint32_t i = 0; i < 40; ++i)
    for (const auto& piece : placeTriangle(input, input.draws[0], i).pieces)
      pieces += !isEmpty(piece) && !isCompact(piece);
  ASSERT_GT(pieces, 30u);
  const CpuResult cpu = sampleOnCpu(input);
  expectEqual(sample(scene), cpu, "room for all");
  const GpuResult gpu = sample(scene, {}, 40); // ten records each for medium and large ones
  expectEqual(gpu, cpu, "too few records");
  EXPECT_EQ(gpu.report.base.status, GPGP_SUCCESS);
  EXPECT_GT(cpu.counters.visible, 4u);
}

TEST_F(VisibilityGpuTest, MediumTrianglesWithoutARecordAreDrawnAllTheSame) {
  Scene scene = sheet(1, 20, 0.3f); // 800 triangles of about 20 x 20 pixels
  scene.addDraw(0);
  scene.setCamera(perspective(1.0f, 1.0f, 0.05f, 10.0f) * lookAt({0.1f, 0.05f, 1.7f}, {0, 0, 0}), 400, 400);
  const CpuResult cpu = sampleOnCpu(scene.input());
  EXPECT_GT(cpu.counters.visible, 700u);
  expectEqual(sample(scene), cpu, "room for all");
  expectEqual(sample(scene, {}, 800), cpu, "too few records");
}

TEST_F(VisibilityGpuTest, CountAndArgumentsMatchTheList) {
  Scene scene = bunny(300, 300);
  const CpuResult cpu = sampleOnCpu(scene.input());
  const GpuResult gpu = sample(scene);
  const auto visible = static_cast<uint32_t>(cpu.list.size());
  EXPECT_EQ(gpu.count, (std::vector<uint32_t>{visible, (visible + 63) / 64, 1, 1}));
  Scene nothing = bunny(64, 64);
  nothing.setCamera(perspective(1.0f, 1.0f, 0.1f, 10.0f) * lookAt({0, 0, 50}, {0, 0, 60}), 64, 64);
  EXPECT_EQ(sample(nothing).count, (std::vector<uint32_t>{0, 0, 1, 1}));
}

TEST_F(VisibilityGpuTest, NoDrawsNoBuffersNothingVisible) {
  Scene scene;
  scene.setCamera(glm::mat4(1.0f), 33, 17);
  scene.input();
  const GpgpRecorder recorder = createRecorder(64, 64);
  const GpgpAsset set = createGeometrySet(scene);
  upload();
  GpgpVisibilityInfo info = GPGP_VISIBILITY_INFO_INIT;
  info.geometrySet = set;
  info.width = info.height = 40;
  host::Buffer count(device, 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  info.visibleCount = count.range();
  info.indexType = VK_INDEX_TYPE_UINT32;
  info.refinements = UINT32_MAX; // of another method
  GpgpVisibilityReport report = GPGP_VISIBILITY_REPORT_INIT;
  const auto record = [&] {
    const GpgpFrame f = advance();
    device.submitAndWait(queue(), [&](VkCommandBuffer cmd) {
      ASSERT_EQ(gpgpRecordPrepareVisibility(recorder, cmd, &f, &info), GPGP_SUCCESS) << messages.back();
    });
    advance();
    ASSERT_EQ(gpgpGetVisibilityReport(recorder, &report), GPGP_SUCCESS);
  };
  record();
  EXPECT_EQ(report.base.status, GPGP_SUCCESS);
  EXPECT_EQ(report.coveredPixels, 0u);
  EXPECT_EQ(host::download<uint32_t>(device, count, 4), (std::vector<uint32_t>{0, 0, 1, 1}));
  // Commands whose instances are all beyond the draws; bits of no triangle.
  const host::Buffer commands =
      host::makeBuffer(device, std::vector<uint32_t>{3, 3, 0, 0, 0}, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "commands");
  const host::Buffer bits =
      host::makeBuffer(device, std::vector<uint32_t>{~0u}, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "bits");
  info.commands = commands.range();
  info.commandCount = 1;
  info.visibleBits = bits.range();
  info.triangleCount = 10;
  info.accumulate = VK_TRUE;
  record();
  EXPECT_EQ(report.skippedDraws, 3u);
  EXPECT_EQ(report.visible, 10u);
}

TEST_F(VisibilityGpuTest, AViewTellsWhatAppearedAndDisappeared) {
  Scene scene = bunny(160, 160);
  scene.input();
  const GpgpRecorder recorder = createRecorder(160, 160, 0, true);
  const GpgpAsset set = createGeometrySet(scene);
  const GpgpHistory view = createView(80000);
  std::vector<uint32_t> before;
  const uint32_t all = scene.params.triangleCount;
  for (int i = 0; i < 6; ++i) {
    const float angle = 0.4f * float(i == 3 ? 2 : i); // frame 3 repeats frame 2
    scene.setCamera(perspective(1.0f, 1.0f, 0.1f, 100.0f) *
                        lookAt({3 * std::sin(angle), 1, 3 * std::cos(angle)}, {0, 0, 0}),
                    160, 160);
    scene.params.triangleCount = i == 4 ? 20000 : all; // fewer triangle numbers: the others disappear
    scene.params.viewWords = 2500;
    CpuInput input = scene.input();
    input.previousBits = before;
    const CpuResult cpu = sampleOnCpu(input);
    const uint32_t room = i == 1 ? 100 : UINT32_MAX;
    const GpuResult gpu = sample(scene, recorder, set, {.view = view, .tag = uint64_t(i), .changedTriangles = room});
    expectEqual(gpu, cpu, "frame " + std::to_string(i));
    EXPECT_EQ(gpu.report.base.status, i == 1 ? GPGP_BUDGET_EXCEEDED : GPGP_SUCCESS);
    std::vector<uint32_t> changed{cpu.counters.appeared, cpu.counters.disappeared, 0, 0};
    changed.insert(changed.end(), cpu.changed.begin(), cpu.changed.end());
    changed.resize(std::min<size_t>(changed.size(), 4 + size_t{room}));
    EXPECT_EQ(gpu.report.changed + 4, changed.size()) << i;
    EXPECT_TRUE(std::equal(changed.begin(), changed.end(), gpu.changed.begin())) << i;
    for (size_t k = changed.size(); k < gpu.changed.size(); ++k) ASSERT_EQ(gpu.changed[k], 0xdeadbeefu) << i;
    EXPECT_EQ(gpu.report.appeared, cpu.counters.appeared) << i;
    EXPECT_EQ(gpu.report.disappeared, cpu.counters.disappeared) << i;
    if (i == 0) {
      EXPECT_EQ(gpu.report.appeared, gpu.report.visible);
    }
    if (i == 3) {
      EXPECT_EQ(gpu.report.appeared + gpu.report.disappeared, 0u);
    }
    if (i == 4) {
      EXPECT_GT(gpu.report.disappeared, 1000u);
    }
    before = cpu.bits;
  }
}

TEST_F(VisibilityGpuTest, ADroppedRecordLeavesTheHistoryAlone) {
  Scene scene = randomSoup(5, 200, 64, 64, true, false);
  scene.input();
  const GpgpRecorder recorder = createRecorder(64, 64);
  const GpgpAsset set = createGeometrySet(scene);
  const GpgpHistory view = createView(0);
  const GpuResult first = sample(scene, recorder, set, {.view = view});
  EXPECT_GT(first.report.appeared, 0u);
  {
    Scene other = randomSoup(6, 200, 64, 64, true, false);
    const SceneBuffers buffers(device, other);
    GpgpVisibilityInfo info = sampleInfo(other, buffers, set);
    info.history = view;
    host::Buffer bits(device, 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    info.visibleBits = bits.range();
    const GpgpFrame f = advance();
    host::FrameRing ring(device, queue(), 1);
    ASSERT_EQ(gpgpRecordPrepareVisibility(recorder, ring.begin(), &f, &info), GPGP_SUCCESS);
    ring.drop();
    advance();
    GpgpVisibilityReport report = GPGP_VISIBILITY_REPORT_INIT;
    ASSERT_EQ(gpgpGetVisibilityReport(recorder, &report), GPGP_SUCCESS);
    EXPECT_EQ(report.base.status, GPGP_NOT_EXECUTED);
  }
  const GpuResult again = sample(scene, recorder, set, {.view = view});
  EXPECT_EQ(again.report.appeared + again.report.disappeared, 0u);
}

// Three frames in flight with two recorders' worth of records each, no waiting in between: results of each frame are as
// if it had run alone.
struct FramesInFlightTest : VisibilityGpuTest {}; // the ring counts frames itself
TEST_F(FramesInFlightTest, DoNotDisturbEachOther) {
  Scene scene = colonnade(200, 120);
  scene.input();
  const GpgpRecorder recorder = createRecorder(200, 120);
  const GpgpAsset set = createGeometrySet(scene);
  const SceneBuffers buffers(device, scene);
  const uint32_t words = (scene.params.triangleCount + 31) / 32;
  constexpr int kFrames = 9;
  std::vector<host::Buffer> bits;
  std::vector<CpuResult> cpus;
  {
    host::FrameRing ring(device, queue(), 3);
    for (int i = 0; i < kFrames; ++i) {
      scene.setCamera(perspective(1.0f, 1.5f, 0.1f, 100.0f) * lookAt({0.4f, 0.3f, 4.0f - float(i)}, {0, 0.3f, -40}),
                      200, 120);
      cpus.push_back(sampleOnCpu(scene.input()));
      bits.emplace_back(device, words * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
      VkCommandBuffer cmd = ring.begin();
      const GpgpFrame f = ring.frame();
      ASSERT_EQ(gpgpAdvance(context, &f), GPGP_SUCCESS);
      ASSERT_EQ(gpgpRecordUpload(context, cmd, &f, 0, nullptr), GPGP_SUCCESS);
      GpgpVisibilityInfo info = sampleInfo(scene, buffers, set);
      info.visibleBits = bits.back().range();
      info.base.tag = static_cast<uint64_t>(i);
      ASSERT_EQ(gpgpRecordPrepareVisibility(recorder, cmd, &f, &info), GPGP_SUCCESS) << messages.back();
      ring.submit();
    }
    ring.waitAll();
    const GpgpFrame last{ring.frame().current + 1, ring.frame().current};
    ASSERT_EQ(gpgpAdvance(context, &last), GPGP_SUCCESS);
  }
  for (size_t i = 0; i < kFrames; ++i) {
    GpgpVisibilityReport report = GPGP_VISIBILITY_REPORT_INIT;
    ASSERT_EQ(gpgpGetVisibilityReport(recorder, &report), GPGP_SUCCESS);
    EXPECT_EQ(report.base.tag, i);
    EXPECT_EQ(report.visible, cpus[i].counters.visible) << i;
    EXPECT_EQ(report.coveredPixels, cpus[i].counters.coveredPixels) << i;
    EXPECT_EQ(host::download<uint32_t>(device, bits[i], words), cpus[i].bits) << i;
  }
}

} // namespace
} // namespace gpgp::test
