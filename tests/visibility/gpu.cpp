// An engine's frame in small: upload, record, submit, advance, read back.
#include "gpu.h"

#include "api/check.h"
#include "visibility/shared/cluster.h"

#include <algorithm>
#include <array>

namespace gpgp::test {
namespace {
using namespace visibility;
constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr uint32_t kPoison = 0xdeadbeef;

GpgpBuffer toHost(const host::Buffer& buffer) {
  return buffer.range({}, {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, {}});
}

/// A draw's triangles are in no stated order.
void sortByDraw(GpuResult& result) {
  for (size_t c = 0; c < result.drawCommands.size(); c += 5) {
    const size_t first = result.drawCommands[c + 2] / 3, count = result.drawCommands[c] / 3;
    std::vector<std::array<uint32_t, 4>> triangles(count);
    for (size_t i = 0; i < count; ++i)
      triangles[i] = {result.drawTriangles[first + i], result.drawIndices[(first + i) * 3],
                      result.drawIndices[(first + i) * 3 + 1], result.drawIndices[(first + i) * 3 + 2]};
    std::sort(triangles.begin(), triangles.end());
    for (size_t i = 0; i < count; ++i) {
      result.drawTriangles[first + i] = triangles[i][0];
      std::copy_n(&triangles[i][1], 3, &result.drawIndices[(first + i) * 3]);
    }
  }
}
} // namespace

SceneBuffers::~SceneBuffers() {
  for (const VkSampler sampler : samplers_) device_.vk().vkDestroySampler(device_.device(), sampler, nullptr);
}

SceneBuffers::SceneBuffers(host::HeadlessDevice& device, Scene& scene) : device_(device) {
  const visibility::CpuInput input = scene.input();
  const auto copy = [&](const auto& span, const char* name) {
    return host::makeBuffer(device, std::vector(span.begin(), span.end()), kStorage, name);
  };
  positions = copy(input.positions, "positions");
  indices = copy(input.indices, "indices");
  draws = copy(input.draws, "draws");
  if (!scene.textures.empty()) coordinates = copy(input.coordinates, "texture coordinates");
  for (const AlphaTexture& texture : scene.textures) {
    VkSampler& sampler = samplers_[texture.linear];
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = info.minFilter = texture.linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
    if (!sampler)
      host::check(device.vk().vkCreateSampler(device.device(), &info, nullptr, &sampler), "vkCreateSampler");
    textures.emplace_back(device, host::ImageInfo{.format = VK_FORMAT_R8G8B8A8_UNORM,
                                                  .width = texture.width,
                                                  .height = texture.height,
                                                  .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
    std::vector<uint8_t> pixels;
    for (const uint8_t alpha : texture.alpha) pixels.insert(pixels.end(), {0, 0, 0, alpha});
    host::uploadImage(device, textures.back(), pixels, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    alphaTests.push_back(
        {textures.back().view(), sampler, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, texture.cutoff, 0});
  }
  if (!scene.commands.empty()) commands = copy(input.commands, "commands");
  if (!scene.numbers.empty()) numbers = copy(input.numbers, "numbers");
  if (scene.drawCount != UINT32_MAX) drawCount = copy(std::array{scene.drawCount}, "draw count");
}

GpgpRecorder VisibilityGpuTest::createRecorder(uint32_t width, uint32_t height, uint32_t maxTriangles,
                                               bool engineScratch, uint32_t methods, uint32_t maxSamples,
                                               uint32_t maxCandidates, uint32_t maxPairs, uint32_t maxCameras,
                                               uint32_t maxDraws, uint32_t maxNonOpaque) {
  GpgpVisibilityRecorderCreateInfo info = GPGP_VISIBILITY_RECORDER_CREATE_INFO_INIT;
  info.base.label = "recorder";
  info.base.queueFamily = queue().family;
  info.base.engineScratch = engineScratch;
  info.maxWidth = width;
  info.maxHeight = height;
  info.maxTriangles = maxTriangles;
  info.methods = methods;
  info.maxSamples = maxSamples;
  info.maxCandidates = maxCandidates;
  info.maxPairs = maxPairs;
  info.maxCameras = maxCameras;
  info.maxDraws = maxDraws;
  info.maxNonOpaque = maxNonOpaque;
  return recorder(gpgpCreateVisibilityRecorder, info);
}

GpgpAsset VisibilityGpuTest::createGeometrySet(const Scene& scene) {
  static_assert(sizeof(GpgpMesh) == sizeof(shader::Mesh));
  GpgpGeometrySetCreateInfo info = GPGP_GEOMETRY_SET_CREATE_INFO_INIT;
  info.label = "geometry";
  info.meshes = reinterpret_cast<const GpgpMesh*>(scene.meshes.data());
  info.meshCount = static_cast<uint32_t>(scene.meshes.size());
  GpgpAsset set = nullptr;
  EXPECT_EQ(gpgpCreateGeometrySet(context, &info, &set), GPGP_SUCCESS);
  return set;
}

GpgpHistory VisibilityGpuTest::createView(uint32_t maxTriangles, float maxLate) {
  GpgpCameraHistoryCreateInfo info = GPGP_CAMERA_HISTORY_CREATE_INFO_INIT;
  info.label = "camera";
  info.maxTriangles = maxTriangles;
  info.maxLate = maxLate;
  GpgpHistory view = nullptr;
  EXPECT_EQ(gpgpCreateCameraHistory(context, &info, &view), GPGP_SUCCESS);
  return view;
}

void VisibilityGpuTest::upload() {
  VkDeviceSize pending = 1;
  while (pending) {
    const GpgpFrame f = advance();
    device.submitAndWait(queue(), [&](VkCommandBuffer cmd) {
      ASSERT_EQ(gpgpRecordUpload(context, cmd, &f, 0, &pending), GPGP_SUCCESS);
    });
  }
}

GpgpVisibilityInfo VisibilityGpuTest::sampleInfo(const Scene& scene, const SceneBuffers& buffers,
                                                 GpgpAsset geometrySet) {
  GpgpVisibilityInfo info = GPGP_VISIBILITY_INFO_INIT;
  info.geometrySet = geometrySet;
  std::copy_n(scene.params.viewProjection, 16, info.camera.viewProjection);
  info.camera.reversedDepth = scene.params.reversedDepth;
  info.width = scene.params.width;
  info.height = scene.params.height;
  info.positions = buffers.positions.range();
  info.positionFormat = std::array{VK_FORMAT_R32G32B32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT,
                                   VK_FORMAT_R16G16B16_SNORM}[scene.params.positionFormat];
  info.positionOffset = scene.params.positionOffset;
  info.positionStride = scene.params.positionStride;
  info.indices = buffers.indices.range();
  info.indexType = scene.useShort ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32;
  info.draws = buffers.draws.range();
  info.drawCount = static_cast<uint32_t>(scene.draws.size());
  if (buffers.commands.handle()) {
    info.commands = buffers.commands.range();
    info.commandCount = scene.params.commandCount;
    if (buffers.numbers.handle()) info.triangleNumbers = buffers.numbers.range();
  }
  if (buffers.drawCount.handle()) info.drawCountBuffer = buffers.drawCount.range();
  info.triangleCount = scene.params.triangleCount;
  info.alphaTests = buffers.alphaTests.data();
  info.alphaTestCount = static_cast<uint32_t>(buffers.alphaTests.size());
  if (info.alphaTestCount) info.textureCoordinates = buffers.coordinates.range();
  info.camera.layerMask = scene.params.cameraLayers[0];
  return info;
}

GpuResult VisibilityGpuTest::sample(Scene& scene, const GpuOptions& options, uint32_t maxTriangles) {
  scene.input();                                                               // fills in what depends on the scene
  const auto roundUp = [](uint32_t size) { return (size + 255) / 256 * 256; }; // few recorders for many scenes
  const GpgpRecorder recorder = createRecorder(roundUp(scene.params.width), roundUp(scene.params.height), maxTriangles,
                                               true, 1u << options.method, std::min(options.samples, 4u), 0, 0,
                                               scene.params.cameraCount, 0, scene.params.maxNonOpaque);
  const GpgpAsset set = createGeometrySet(scene);
  const GpuResult result = sample(scene, recorder, set, options);
  gpgpDestroyAsset(set);
  return result;
}

GpuResult VisibilityGpuTest::sample(Scene& scene, GpgpRecorder handle, GpgpAsset set, const GpuOptions& options) {
  const SceneBuffers buffers(device, scene);
  upload();
  GpgpVisibilityInfo info = sampleInfo(scene, buffers, set);
  info.history = options.view;
  info.base.tag = options.tag;
  info.method = options.method;
  info.samples = options.samples;
  info.slice = options.slice;
  info.heuristics = scene.params.heuristics;
  info.epsilonStatic = scene.params.epsilonStatic;
  info.epsilonDynamic = scene.params.epsilonDynamic;
  info.refinements = options.refinements;
  info.resolution = options.resolution;
  info.reach = options.reach;
  if (options.width) info.width = options.width, info.height = options.height;
  const uint32_t words = (info.triangleCount + 31) / 32;
  const uint32_t capacity = std::min(options.listTriangles, std::max(info.triangleCount, 1u));
  host::Buffer bits(device, std::max(words, 1u) * 4, kStorage), list(device, std::max(capacity, 1u) * 4, kStorage);
  host::Buffer sizes(device, std::max(info.triangleCount, 1u) * 4, kStorage);
  host::Buffer count(device, 20, kStorage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
  std::vector<GpgpCamera> cameras(scene.params.cameraCount - 1);
  for (size_t i = 0; i < cameras.size(); ++i) {
    std::copy_n(scene.params.viewProjection + (i + 1) * 16, 16, cameras[i].viewProjection);
    cameras[i].reversedDepth = scene.params.reversedDepth;
    cameras[i].layerMask = scene.params.cameraLayers[i + 1];
  }
  for (size_t i = 0; i < scene.cameraOrigins.size(); ++i)
    for (int k = 0; k < 3; ++k) (i ? cameras[i - 1] : info.camera).origin[k] = scene.cameraOrigins[i][k];
  info.origins = scene.origins.empty() ? nullptr : &scene.origins[0].x;
  info.originCount = static_cast<uint32_t>(scene.origins.size());
  info.moreCameras = cameras.data();
  info.moreCameraCount = static_cast<uint32_t>(cameras.size());
  CpuEntries entries;
  uint32_t drawn = 0; // triangles of all draws
  for (const shader::DrawEntry& e : entriesOf(scene.input(), entries)) drawn += e.indexCount / 3;
  const uint32_t drawRoom = std::min(options.drawTriangles, std::max(drawn, 1u));
  const uint32_t commandRoom = std::min(options.drawCommands, std::max(entries.given, 1u));
  host::Buffer drawCommands(device, commandRoom * 20, kStorage), drawIndices(device, drawRoom * 12, kStorage);
  host::Buffer drawTriangles(device, drawRoom * 4, kStorage);
  host::Buffer extents(device, std::max(info.triangleCount, 1u) * 12, kStorage);
  if (options.byDraw) {
    info.drawCommands = toHost(drawCommands);
    info.drawIndices = toHost(drawIndices);
    info.drawTriangles = toHost(drawTriangles);
    info.triangleSizes = toHost(extents);
  }
  for (const host::Buffer* buffer :
       {&bits, &list, &count, &sizes, &drawCommands, &drawIndices, &drawTriangles, &extents})
    host::fill(device, *buffer, kPoison);
  host::Buffer changed(device, (std::min(options.changedTriangles, info.triangleCount * 2 + 64) + 4) * 4, kStorage);
  host::fill(device, changed, kPoison);
  if (options.view) info.changedList = toHost(changed);
  info.visibleBits = toHost(bits);
  info.pixelCounts = toHost(sizes);
  if (capacity) info.visibleList = toHost(list);
  if (options.count) info.visibleCount = toHost(count);

  VkDeviceSize scratchBytes = 0;
  EXPECT_EQ(gpgpGetScratchSize(handle, &scratchBytes, nullptr, nullptr), GPGP_SUCCESS);
  const core::Context* owner = nullptr;
  const auto* recorder = static_cast<const core::Recorder*>(api::objectOf(handle, &owner));
  host::Buffer scratch;
  if (recorder->engineScratch()) {
    scratch = host::Buffer(device, scratchBytes, core::Recorder::kScratchUsage);
    host::fill(device, scratch, kPoison);
    info.base.scratch = toHost(scratch);
  }
  host::Buffer clusters;
  if (options.clusters) {
    VkDeviceSize needed = 1;
    for (const shader::Mesh& mesh : scene.meshes) needed += (mesh.indexCount / 3 + 63) / 64;
    clusters = host::Buffer(device, needed * shader::kClusterBytes, kStorage);
    host::fill(device, clusters, kPoison);
    info.clusters = clusters.range();
  }
  const GpgpFrame f = advance();
  device.submitAndWait(queue(), [&](VkCommandBuffer cmd) {
    EXPECT_EQ(gpgpRecordPrepareVisibility(handle, cmd, &f, &info), GPGP_SUCCESS)
        << (messages.empty() ? "" : messages.back());
  });
  advance();

  GpuResult result;
  EXPECT_EQ(gpgpGetVisibilityReport(handle, &result.report), GPGP_SUCCESS);
  EXPECT_EQ(result.report.base.tag, options.tag);
  result.bits = host::download<uint32_t>(device, bits, words);
  result.sizes = host::download<uint32_t>(device, sizes, info.triangleCount);
  result.list = host::download<uint32_t>(device, list, capacity);
  if (capacity) {
    result.list.resize(std::min<size_t>(result.list.size(), result.report.listed));
  } else {
    EXPECT_EQ(host::download<uint32_t>(device, list, 1)[0], kPoison);
  }
  if (options.view) result.changed = host::download<uint32_t>(device, changed, changed.size() / 4);
  result.count = host::download<uint32_t>(device, count, 4);
  if (options.byDraw) {
    result.extents = host::download<uint32_t>(device, extents, info.triangleCount * 3);
    if (options.count) {
      EXPECT_EQ(host::download<uint32_t>(device, count, 5)[4], result.report.draws);
    }
    const uint32_t listed = result.report.drawTriangles;
    result.drawCommands =
        host::download<uint32_t>(device, drawCommands, std::min(result.report.draws, commandRoom) * 5);
    result.drawTriangles = host::download<uint32_t>(device, drawTriangles, listed);
    result.drawIndices = host::download<uint32_t>(device, drawIndices, listed * 3);
    sortByDraw(result);
  }
  if (scratch.handle()) {
    const uint32_t samples = std::max(std::min(options.samples, 4u), 1u);
    const size_t pixels =
        size_t(scene.params.width) * scene.params.height * scene.params.cameraCount * samples * samples;
    const auto& offsets = recorder->passes().scratchOffsets;
    if (options.method != GPGP_SAMPLING_EXACT) { // there lists take their place
      const auto texels =
          host::download<uint32_t>(device, scratch, pixels * shader::kSampleWords, offsets[shader::kBindSamples]);
      for (uint32_t i = 0; i < pixels; ++i) {
        result.ids.push_back(texels[shader::idAt(i)]);
        result.depth.push_back(texels[shader::depthAt(i)]);
      }
    }
    const auto counters = host::download<shader::Counters>(device, scratch, 1, offsets[shader::kBindCounters])[0];
    result.chunks = counters.chunks, result.keptChunks = counters.keptCount;
    result.reuseFirst = counters.reuseFirst, result.reuseShare = counters.reuseShare;
  }
  return result;
}

void expectEqual(const GpuResult& gpu, const visibility::CpuResult& cpu, const std::string& what) {
  size_t differentIds = 0, differentDepths = 0;
  for (size_t i = 0; i < gpu.ids.size(); ++i) {
    differentIds += gpu.ids[i] != cpu.ids[i];
    differentDepths += gpu.depth[i] != cpu.depth[i];
  }
  EXPECT_EQ(differentIds, 0u) << what;
  EXPECT_EQ(differentDepths, 0u) << what;
  EXPECT_EQ(gpu.bits, cpu.bits) << what;
  const auto listed = std::min(gpu.list.size(), cpu.list.size());
  EXPECT_TRUE(std::equal(gpu.list.begin(), gpu.list.end(), cpu.list.begin(),
                         cpu.list.begin() + static_cast<std::ptrdiff_t>(listed)))
      << what;
  EXPECT_EQ(gpu.report.triangles, cpu.counters.triangles) << what;
  EXPECT_EQ(gpu.report.visible, cpu.counters.visible) << what;
  EXPECT_EQ(gpu.report.coveredPixels, cpu.counters.coveredPixels) << what;
  EXPECT_EQ(gpu.report.neededTriangles, cpu.counters.items) << what;
  EXPECT_EQ(gpu.report.skippedTriangles, cpu.counters.skippedTriangles) << what;
  EXPECT_EQ(gpu.report.skippedDraws, cpu.counters.skippedDraws) << what;
  EXPECT_EQ(gpu.report.neededCandidates, cpu.counters.candidates) << what;
  EXPECT_EQ(gpu.report.neededNonOpaque, cpu.counters.nonOpaque) << what;
  EXPECT_EQ(gpu.report.neededPairs, cpu.counters.pairs) << what;
  EXPECT_EQ(gpu.report.neededDraws, cpu.counters.draws) << what;
  EXPECT_EQ(gpu.report.unresolved, cpu.counters.unresolved) << what;
  EXPECT_TRUE(cpu.sizes.empty() || gpu.sizes == cpu.sizes) << what;
  if (gpu.extents.empty()) return;
  EXPECT_TRUE(gpu.extents == cpu.extents) << what;
  EXPECT_EQ(gpu.report.neededDrawTriangles, cpu.counters.drawTriangles) << what;
  EXPECT_TRUE(gpu.drawCommands == cpu.drawCommands) << what;
  EXPECT_TRUE(gpu.drawTriangles == cpu.drawTriangles) << what;
  EXPECT_TRUE(gpu.drawIndices == cpu.drawIndices) << what;
}

} // namespace gpgp::test
