// What engines hand over and take back: indirect commands and counts, position formats, faces, several cameras; lists
// by draw, indirect commands over them, projected sizes, their budgets. The GPU against the CPU reference, bit for bit.
#include "gpu.h"
#include "measured_scenes.h"
#include "visibility/shared/position.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>
#include <set>

namespace gpgp::test {
namespace {
using namespace visibility;

constexpr GpgpSamplingMethod kMethods[] = {GPGP_SAMPLING_STANDARD, GPGP_SAMPLING_EXACT};

CpuResult cpuOf(GpgpSamplingMethod method, Scene& scene) {
  return method == GPGP_SAMPLING_EXACT ? sampleExactOnCpu(scene.input()) : sampleOnCpu(scene.input());
}

/// One recorder for all scenes of a test: making pipelines is what takes time.
struct EngineTest : VisibilityGpuTest {
  GpgpRecorder recorder = nullptr;
  GpuResult run(Scene& scene, GpuOptions options = {}) {
    if (!recorder)
      recorder = createRecorder(256, 256, 0, true, GPGP_SAMPLING_STANDARD_BIT | GPGP_SAMPLING_EXACT_BIT, 0, 0, 0, 3);
    scene.input(); // fills in what depends on the scene
    const GpgpAsset set = createGeometrySet(scene);
    GpuResult result = sample(scene, recorder, set, options);
    gpgpDestroyAsset(set);
    return result;
  }
};

/// The draws of a scene as indirect commands of one to three instances each.
void useCommands(Scene& scene) {
  for (size_t i = 0; i < scene.draws.size();) {
    const shader::Mesh& mesh = scene.meshes[scene.draws[i].mesh];
    uint32_t instances = 1;
    while (i + instances < scene.draws.size() && instances < 3 &&
           scene.draws[i + instances].mesh == scene.draws[i].mesh)
      ++instances;
    for (const uint32_t word :
         {mesh.indexCount, instances, mesh.firstIndex, mesh.vertexOffset, static_cast<uint32_t>(i)})
      scene.commands.push_back(word);
    i += instances;
  }
  for (shader::Draw& draw : scene.draws) draw.mesh = 0xdeadu; // is not read
}

TEST_F(EngineTest, IndirectCommandsAreDrawnAsTheirInstances) {
  for (const GpgpSamplingMethod method : kMethods) {
    Scene direct = colonnade(160, 90);
    const CpuResult expected = cpuOf(method, direct);
    Scene scene = direct;
    useCommands(scene);
    ASSERT_GT(scene.commands.size(), 5u * 10);
    const CpuResult cpu = cpuOf(method, scene);
    EXPECT_EQ(cpu.bits, expected.bits);
    EXPECT_EQ(cpu.drawCommands, expected.drawCommands);
    expectEqual(run(scene, {.method = method}), cpu, "commands");
    scene.drawCount = static_cast<uint32_t>(scene.commands.size() / 5) - 4; // fewer than there is room for
    const CpuResult fewer = cpuOf(method, scene);
    EXPECT_LT(fewer.counters.draws, cpu.counters.draws);
    expectEqual(run(scene, {.method = method}), fewer, "count");
    direct.drawCount = 3;
    const CpuResult three = cpuOf(method, direct);
    EXPECT_EQ(three.counters.draws, 3u);
    expectEqual(run(direct, {.method = method}), three, "count of draws");
  }
}

TEST_F(EngineTest, BadCommandsAreSkippedAndCounted) {
  Scene scene = randomSoup(4, 200, 96, 64, true, false);
  const auto command = [&](std::initializer_list<uint32_t> words) {
    scene.commands.insert(scene.commands.end(), words);
  };
  scene.params.triangleCount = 300;
  command({300, 1, 0, 0, 0});                          // good: the first hundred
  command({30, 3, 300, static_cast<uint32_t>(-9), 0}); // negative offset; two of three instances have no transform
  command({31, 1, 0, 0, 0xfffffffeu});                 // nor has this
  command({60, 1, 580, 0, 0});                         // past the end of the indices
  command({600, 1, 0xfffffff0u, 0, 0});                // beyond 32 bits
  command({60, 1, 0, 0x7ffffff0u, 0});                 // vertices beyond the range
  command({3, 0xffffffffu, 0, 0, 1});                  // very many instances, none of them there
  command({2, 1, 0, 0, 0});                            // no triangle
  const CpuResult cpu = sampleOnCpu(scene.input());
  EXPECT_EQ(cpu.counters.draws, 6u);
  EXPECT_EQ(cpu.counters.skippedDraws, 0xffffffffu) << "stays there";
  EXPECT_GT(cpu.counters.skippedTriangles, 200u);
  EXPECT_GT(cpu.counters.visible, 5u);
  const GpuResult gpu = run(scene);
  expectEqual(gpu, cpu, "bad commands");
}

TEST_F(EngineTest, InstancesBeyondTheDrawTableAreCutAndReported) {
  Scene scene = bunny(96, 96);
  scene.meshes = {{0, 3000, 0}};
  scene.draws.clear();
  scene.params.triangleCount = 0;
  for (int i = 0; i < 40; ++i)
    scene.addDraw(0, glm::translate(glm::mat4(1.0f), {0.2f * float(i % 8) - 0.8f, 0.2f * float(i / 8) - 0.5f, 0}));
  useCommands(scene);
  scene.addCamera(perspective(1.0f, 1.0f, 0.1f, 100.0f) * lookAt({-1, 1, 3}, {0, 0, 0}));
  scene.params.maxEntries = 51; // 25 for each camera
  const CpuResult cpu = sampleOnCpu(scene.input());
  EXPECT_EQ(cpu.counters.draws, 40u);
  EXPECT_EQ(cpu.counters.drawsGiven, 25u);
  recorder = createRecorder(96, 96, 0, true, 0, 0, 0, 0, 2, 51);
  const GpuResult gpu = run(scene);
  expectEqual(gpu, cpu, "cut");
  EXPECT_EQ(gpu.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(gpu.report.draws, 25u);
  EXPECT_GT(gpu.report.visible, 100u);
}

/// The positions of a scene in 16 bits, `stride` bytes a vertex, from `offset` on.
void packPositions(Scene& scene, uint32_t format, uint32_t stride, uint32_t offset) {
  const size_t vertices = scene.positions.size() / 3;
  std::vector<uint16_t> words((vertices * stride + offset + 3) / 4 * 2, 0x7c01); // NaN in between
  for (size_t v = 0; v < vertices; ++v)
    for (size_t i = 0; i < 3; ++i)
      words[(v * stride + offset) / 2 + i] = format == shader::kHalves
                                                 ? glm::packHalf1x16(scene.positions[v * 3 + i])
                                                 : glm::packSnorm1x16(scene.positions[v * 3 + i] * 0.25f);
  scene.positionWords.resize(words.size() / 2);
  std::memcpy(scene.positionWords.data(), words.data(), words.size() * 2);
  scene.params.positionFormat = format;
  scene.params.positionStride = stride;
  scene.params.positionOffset = offset;
  scene.params.vertexCount = static_cast<uint32_t>((scene.positionWords.size() * 4 - offset - 6) / stride + 1);
}

TEST_F(EngineTest, PositionsOf16BitsWithAnyStrideAndOffset) {
  for (const uint32_t format : {shader::kHalves, shader::kSnorms})
    for (const auto& [stride, offset] : {std::pair{8u, 0u}, {6u, 0u}, {14u, 6u}}) {
      Scene scene = colonnade(128, 72);
      const uint32_t plain = sampleOnCpu(scene.input()).counters.visible;
      packPositions(scene, format, stride, offset);
      if (format == shader::kSnorms)
        for (shader::Draw& d : scene.draws)
          for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column) d.transform[row * 4 + column] *= 4;
      const CpuResult cpu = sampleOnCpu(scene.input());
      EXPECT_NEAR(cpu.counters.visible, plain, plain * 0.1);
      expectEqual(run(scene), cpu, std::to_string(format) + " " + std::to_string(stride));
    }
  // Floats with an offset, in wider vertices.
  Scene scene = colonnade(128, 72);
  const CpuResult plain = sampleOnCpu(scene.input());
  std::vector<float> wide;
  for (size_t i = 0; i < scene.positions.size(); i += 3)
    wide.insert(wide.end(), {NAN, -1, scene.positions[i], scene.positions[i + 1], scene.positions[i + 2]});
  scene.positions = wide;
  scene.params.positionStride = 20;
  scene.params.positionOffset = 8;
  expectEqual(run(scene), plain, "floats at an offset");
}

TEST(Positions, SixteenBitNumbersAreWhatVulkanSays) {
  for (uint32_t h = 0; h < 65536; ++h) {
    const float half = shader::halfToFloat(h), expected = glm::unpackHalf1x16(static_cast<uint16_t>(h));
    if (std::isnan(expected))
      EXPECT_TRUE(std::isnan(half)) << h;
    else
      ASSERT_EQ(half, expected) << h;
    ASSERT_EQ(shader::snormToFloat(h), std::max(static_cast<float>(static_cast<int16_t>(h)) / 32767.0f, -1.0f)) << h;
  }
}

TEST_F(EngineTest, FacesAreChosenPerDraw) {
  Scene scene = bunny(128, 96);
  const auto all = sampleOnCpu(scene.input()).list;
  std::vector<std::vector<uint32_t>> lists;
  for (const uint32_t flags : {0u, shader::kClockwise, shader::kTwoSided, shader::kTwoSided | shader::kClockwise}) {
    scene.draws[0].flags = flags;
    const CpuResult cpu = sampleOnCpu(scene.input());
    expectEqual(run(scene), cpu, std::to_string(flags));
    lists.push_back(cpu.list);
  }
  EXPECT_EQ(lists[0], all);
  std::vector<uint32_t> both;
  std::set_intersection(lists[0].begin(), lists[0].end(), lists[1].begin(), lists[1].end(), std::back_inserter(both));
  EXPECT_TRUE(both.empty()) << "a triangle faces one way";
  EXPECT_GT(lists[1].size(), 1000u);
  EXPECT_EQ(lists[2], lists[3]);
}

TEST_F(EngineTest, AStereoPairSeesWhatEitherEyeSees) {
  for (const GpgpSamplingMethod method : kMethods) {
    for (const auto& [width, height] : {std::pair{90u, 61u}, {33u, 50u}}) {
      Scene scene = colonnadeWithWires(0.25f);
      const glm::mat4 projection = perspective(1.0f, float(width) / float(height), 0.1f, 100.0f, true);
      std::vector<uint32_t> united;
      for (const float x : {0.0f, 0.4f, -0.6f}) {
        scene.setCamera(projection * lookAt({x, 1.7f, 3}, {x, 1.5f, -10}), width, height, true);
        const std::vector<uint32_t> bits = cpuOf(method, scene).bits;
        united.resize(bits.size());
        for (size_t i = 0; i < bits.size(); ++i) united[i] |= bits[i];
      }
      scene.setCamera(projection * lookAt({0, 1.7f, 3}, {0, 1.5f, -10}), width, height, true);
      scene.addCamera(projection * lookAt({0.4f, 1.7f, 3}, {0.4f, 1.5f, -10}));
      scene.addCamera(projection * lookAt({-0.6f, 1.7f, 3}, {-0.6f, 1.5f, -10}));
      const CpuResult cpu = cpuOf(method, scene);
      EXPECT_EQ(cpu.bits, united) << "cameras do not disturb each other";
      expectEqual(run(scene, {.method = method}), cpu, "stereo");
    }
  }
}

TEST_F(EngineTest, CamerasAndCommandsThroughAllPlanesEqualTheCpuReference) {
  for (uint32_t seed = 20; seed < 23; ++seed) {
    Scene scene = randomSoup(seed, 150, 70, 61, true, seed % 2);
    for (const float x : {0.7f, -0.7f})
      scene.addCamera(perspective(1.2f, 70.0f / 61, 0.25f, 20.0f, seed % 2) * lookAt({x, 0, 3}, {0.3f, 0.1f, 0}));
    useCommands(scene);
    for (const GpgpSamplingMethod method : kMethods)
      expectEqual(run(scene, {.method = method}), cpuOf(method, scene), "seed " + std::to_string(seed));
  }
}

// A view cell's views, as many as a record takes.
TEST_F(EngineTest, TheMostCamerasOfARecordEqualTheCpuReference) {
  Scene scene = randomSoup(7, 90, 20, 17, true, true);
  for (uint32_t i = 1; i < shader::kMaxCameras; ++i)
    scene.addCamera(perspective(1.2f, 20.0f / 17, 0.25f, 20.0f, true) *
                    lookAt({0.01f * static_cast<float>(i), 0.3f, 3}, {0.3f, 0.1f, 0}));
  useCommands(scene);
  recorder = createRecorder(20, 17, 0, true, GPGP_SAMPLING_STANDARD_BIT | GPGP_SAMPLING_EXACT_BIT, 0, 0, 0,
                            shader::kMaxCameras);
  for (const GpgpSamplingMethod method : {GPGP_SAMPLING_STANDARD, GPGP_SAMPLING_EXACT})
    expectEqual(run(scene, {.method = method}), cpuOf(method, scene), "method " + std::to_string(method));
}

// Reversed depth with an infinitely far plane, as engines use it.
TEST_F(EngineTest, AnInfiniteFarPlaneLosesNothing) {
  Scene scene = colonnade(128, 72);
  glm::mat4 projection = perspective(1.0f, 128.0f / 72, 0.1f, 100.0f, true);
  const glm::mat4 view = lookAt({0.4f, 0.3f, 4}, {0, 0.3f, -10});
  scene.setCamera(projection * view, 128, 72, true);
  const auto finite = sampleOnCpu(scene.input()).list;
  projection[2][2] = 0;
  projection[3][2] = 0.1f;
  scene.setCamera(projection * view, 128, 72, true);
  const CpuResult cpu = sampleOnCpu(scene.input());
  EXPECT_EQ(cpu.list, finite);
  expectEqual(run(scene), cpu, "infinite");
}

TEST_F(EngineTest, ListsByDrawAreWhatTheEngineWouldDraw) {
  Scene scene = colonnade(200, 120);
  scene.useShort = true;
  const CpuResult cpu = sampleOnCpu(scene.input());
  const GpuResult gpu = run(scene);
  expectEqual(gpu, cpu, "lists");
  // Independent of how they were made: each command's triangles are its draw's visible ones, and none is missing.
  std::multiset<uint32_t> listed;
  for (size_t c = 0; c < gpu.drawCommands.size(); c += 5) {
    const uint32_t* command = &gpu.drawCommands[c];
    const shader::Draw& draw = scene.draws[command[4]];
    const shader::Mesh& mesh = scene.meshes[draw.mesh];
    EXPECT_EQ(command[1], command[0] ? 1u : 0u);
    EXPECT_EQ(command[3], mesh.vertexOffset);
    for (uint32_t i = 0; i < command[0] / 3; ++i) {
      const uint32_t id = gpu.drawTriangles[command[2] / 3 + i], local = id - draw.firstTriangle;
      listed.insert(id);
      for (uint32_t k = 0; k < 3; ++k)
        EXPECT_EQ(gpu.drawIndices[command[2] + i * 3 + k], scene.indices[mesh.firstIndex + local * 3 + k]);
    }
  }
  EXPECT_EQ(listed, std::multiset<uint32_t>(cpu.list.begin(), cpu.list.end()));
  EXPECT_EQ(gpu.report.drawTriangles, cpu.list.size());
}

TEST_F(EngineTest, ListsByDrawKeepTheirBudgetsByWholeTriangles) {
  Scene scene = bunny(160, 120);
  scene.meshes = {{0, 30000, 0}, {30000, 60000, 0}, {90000, 90000, 0}};
  scene.draws.clear();
  scene.params.triangleCount = 0;
  for (uint32_t i = 0; i < 3; ++i) scene.addDraw(i);
  const CpuResult cpu = sampleOnCpu(scene.input());
  const uint32_t needed = cpu.counters.drawTriangles;
  ASSERT_GT(needed, 2000u);
  for (const uint32_t room : {1u, 1000u, needed - 1, needed}) {
    const GpuResult gpu = run(scene, {.drawTriangles = room});
    EXPECT_EQ(gpu.report.base.status, room < needed ? GPGP_BUDGET_EXCEEDED : GPGP_SUCCESS);
    EXPECT_EQ(gpu.report.neededDrawTriangles, needed);
    EXPECT_EQ(gpu.report.drawTriangles, room);
    uint32_t next = 0;
    std::set<uint32_t> seen;
    for (size_t c = 0; c < gpu.drawCommands.size(); c += 5) {
      EXPECT_EQ(gpu.drawCommands[c] % 3, 0u);
      EXPECT_TRUE(gpu.drawCommands[c] == 0 || gpu.drawCommands[c + 2] == next * 3);
      next += gpu.drawCommands[c] / 3;
    }
    EXPECT_EQ(next, room);
    for (const uint32_t id : gpu.drawTriangles) {
      EXPECT_TRUE(std::binary_search(cpu.list.begin(), cpu.list.end(), id));
      EXPECT_TRUE(seen.insert(id).second);
    }
    EXPECT_EQ(gpu.bits, cpu.bits);
  }
}

TEST_F(EngineTest, ProjectedSizesAreThoseOfTheTriangles) {
  Scene scene; // squares of 2 x 2 at distances 2, 4 and 8, side by side in view; two triangles each
  const uint32_t a = scene.addVertex(0, 0, 0), b = scene.addVertex(2, 0, 0), c = scene.addVertex(2, 2, 0),
                 d = scene.addVertex(0, 2, 0);
  scene.indices = {a, b, c, a, c, d};
  const uint32_t square = scene.addMesh(0);
  scene.addDraw(square, glm::translate(glm::mat4(1.0f), {0.1f, 0.1f, -2}));
  scene.addDraw(square, glm::translate(glm::mat4(1.0f), {-3.1f, 0.2f, -4}));
  scene.addDraw(square, glm::translate(glm::mat4(1.0f), {0.2f, -5, -8}));
  scene.addDraw(square, glm::translate(glm::mat4(1.0f), {1, 1, -9})); // hidden by the first
  const float angle = 2 * std::atan(1.0f);
  scene.setCamera(perspective(angle, 1.0f, 0.1f, 100.0f) * lookAt({0, 0, 0}, {0, 0, -1}), 256, 256);
  const CpuResult cpu = sampleOnCpu(scene.input());
  const GpuResult gpu = run(scene);
  expectEqual(gpu, cpu, "sizes");
  for (uint32_t id = 0; id < 8; ++id) {
    GpgpTriangleSize size;
    std::memcpy(&size, &gpu.extents[id * 3], sizeof size);
    const float side = id < 6 ? 256.0f / float(1 << (id / 2 + 1)) : 0.0f; // 256 pixels are 2 x distance wide
    EXPECT_NEAR(size.width, side, 0.02f) << id;
    EXPECT_NEAR(size.height, side, 0.02f) << id;
    EXPECT_NEAR(size.area, side * side / 2, side * 0.02f + 1e-6f) << id;
  }
}

TEST_F(EngineTest, EngineArgumentsAreChecked) {
  Scene scene = randomSoup(1, 10, 16, 16, true, false);
  scene.input();
  recorder = createRecorder(64, 64, 0, false, 0, 0, 0, 0, 2, 8);
  const GpgpAsset set = createGeometrySet(scene);
  const SceneBuffers buffers(device, scene);
  const host::Buffer any(device, 256, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  upload();
  const GpgpFrame f = advance();
  GpgpCamera more[9]{};
  const auto record = [&](const char* text, auto change) {
    GpgpVisibilityInfo info = sampleInfo(scene, buffers, set);
    info.visibleBits = any.range();
    change(info);
    messages.clear();
    device.submitAndWait(queue(), [&](VkCommandBuffer cmd) {
      const GpgpResult result = gpgpRecordPrepareVisibility(recorder, cmd, &f, &info);
      EXPECT_EQ(result, *text ? GPGP_ERROR_INVALID_ARGUMENT : GPGP_SUCCESS) << text;
    });
    if (!*text) return;
    ASSERT_EQ(messages.size(), 1u) << text;
    EXPECT_NE(messages[0].find(text), std::string::npos) << messages[0];
  };
  record("", [](auto&) {});
  record("moreCameras is NULL", [](auto& i) { i.moreCameraCount = 1; });
  record("moreCameraCount is 2", [&](auto& i) { i.moreCameraCount = 2, i.moreCameras = more; });
  record("moreCameras[0].reversedDepth", [&](auto& i) {
    i.moreCameraCount = 1, i.moreCameras = more;
    i.camera.reversedDepth = VK_TRUE;
  });
  more[0].viewProjection[7] = NAN;
  record("moreCameras[0].viewProjection", [&](auto& i) { i.moreCameraCount = 1, i.moreCameras = more; });
  record("positionFormat", [](auto& i) { i.positionFormat = VK_FORMAT_R8G8B8_SNORM; });
  record("positionStride is 7", [](auto& i) {
    i.positionFormat = VK_FORMAT_R16G16B16_SFLOAT;
    i.positionStride = 7;
  });
  record("positionOffset is 2", [](auto& i) { i.positionOffset = 2; });
  record("positions.size", [](auto& i) {
    i.positionFormat = VK_FORMAT_R16G16B16_SFLOAT;
    i.positionStride = 6;
    i.positions.size = 30;
  });
  const auto commands = [&](auto& i) { i.commands = any.range(), i.commandCount = 2; };
  record("commandStride is 16", [&](auto& i) { commands(i), i.commandStride = 16; });
  record("commands.size", [&](auto& i) { commands(i), i.commands.size = 36; });
  record("commandCount is 9", [&](auto& i) { commands(i), i.commandCount = 9; });
  record("triangleNumbers is given", [&](auto& i) { i.triangleNumbers = any.range(); });
  record("triangleNumbers.size", [&](auto& i) { commands(i), i.triangleNumbers = any.range({}, {}, 0, 2); });
  record("drawCountBuffer.size", [&](auto& i) { i.drawCountBuffer = any.range(), i.drawCountBuffer.size = 2; });
  record("drawCommands.size", [&](auto& i) { i.drawCommands = any.range(), i.drawCommands.size = 16; });
  record("drawIndices.size", [&](auto& i) { i.drawIndices = any.range(), i.drawIndices.size = 8; });
  record("drawTriangles.size", [&](auto& i) { i.drawTriangles = any.range(), i.drawTriangles.size = 2; });
  record("triangleSizes.size", [&](auto& i) { i.triangleSizes = any.range(), i.triangleSizes.size = 116; });
  record("visibleCount.size", [&](auto& i) {
    i.drawCommands = i.visibleCount = any.range();
    i.visibleCount.size = 16;
  });
  GpgpVisibilityRecorderCreateInfo create = GPGP_VISIBILITY_RECORDER_CREATE_INFO_INIT;
  create.base.queueFamily = queue().family;
  create.maxCameras = 129;
  GpgpRecorder none = nullptr;
  EXPECT_EQ(gpgpCreateVisibilityRecorder(context, &create, &none), GPGP_ERROR_INVALID_ARGUMENT);
}

} // namespace
} // namespace gpgp::test
