#include "shading.h"

#include "atlas_on_cpu.h"
#include "shaders/streaming_shade_comp.spv.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>

namespace streaming {
namespace {

constexpr uint32_t kCountWords = 4, kMaxCameras = 3;
constexpr GpgpAccess kAfter = {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT,
                               VK_IMAGE_LAYOUT_UNDEFINED};
constexpr float kTurnMargin = 1.25f, kLeastTurn = 0.1f, kAcceleration = 2; ///< radians per second; metres per second²

} // namespace

ShadingRenderer::ShadingRenderer(Stage& stage, const World& world, const ShadingOptions& options)
    : stage_(stage), world_(world), options_(options), scene_(stage.device, world), shadow_(stage, world, scene_),
      visible_(makeDeviceBuffer(stage.device, (world.model.triangleCount + 31) / 32 * 4)),
      sizes_(makeDeviceBuffer(stage.device, VkDeviceSize{world.model.triangleCount} * sizeof(GpgpTriangleSize))),
      blocks_(makeDeviceBuffer(stage.device, VkDeviceSize{world.model.triangleCount} * 4)),
      tiles_(makeDeviceBuffer(stage.device, VkDeviceSize{options.atlasWidth} * options.atlasHeight / 2)),
      dispatches_(makeDeviceBuffer(stage.device, 20)),
      texels_(makeDeviceBuffer(stage.device, VkDeviceSize{options.atlasWidth} * options.atlasHeight * 4)),
      new_(makeDeviceBuffer(stage.device, VkDeviceSize{world.model.triangleCount} * 4)),
      changed_(makeDeviceBuffer(stage.device, VkDeviceSize{world.model.triangleCount} * 4)),
      gone_(makeDeviceBuffer(stage.device, VkDeviceSize{world.model.triangleCount} * 4)),
      counts_(makeDeviceBuffer(stage.device, kCountWords * 4)),
      shadeBits_(makeHostBuffer(stage.device, visible_.size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT)),
      read_(makeHostBuffer(stage.device, tiles_.size + texels_.size + blocks_.size * 4 + visible_.size,
                           VK_BUFFER_USAGE_TRANSFER_DST_BIT)),
      set_(stage.device,
           {&scene_.positions, &scene_.normals, &scene_.indices, &scene_.draws, &scene_.meshes, &scene_.materials,
            &shadow_.pixels, &blocks_, &tiles_, &dispatches_, &texels_},
           VK_SHADER_STAGE_COMPUTE_BIT),
      pipeline_(stage.device, {std::begin(streaming_shade_comp), std::end(streaming_shade_comp)}, set_.layout, 92),
      blockWords_(world.model.triangleCount), bits_((world.model.triangleCount + 31) / 32),
      maxWidth_(std::min(2 * options.width, 8192u)), maxHeight_(std::min(options.height * 3 / 2, 8192u)) {
  atlasTexels_.resize(options.atlasWidth, options.atlasHeight);
  mini::Gpgp& gpgp = stage.gpgp;
  geometry_ = gpgp.geometrySet("world", world.model.meshes);
  auto visibility = gpgp::init<GpgpVisibilityRecorderCreateInfo>();
  visibility.base = gpgp.recorder("visibility");
  visibility.maxWidth = maxWidth_;
  visibility.maxHeight = maxHeight_;
  visibility.maxDraws = static_cast<uint32_t>(world.model.draws.size());
  visibility.maxTriangles = world.model.triangleCount;
  visibility.maxCandidates = std::max(world.model.triangleCount, 65536u);
  visibility.methods = GPGP_SAMPLING_STANDARD_BIT | 1u << options.method;
  visibilityRecorder_ =
      gpgp.take(gpgp::VisibilityRecorder::create(gpgp.context, visibility), "gpgpCreateVisibilityRecorder");
  auto atlas = gpgp::init<GpgpAtlasCreateInfo>();
  atlas.label = "streamed atlas";
  atlas.width = options.atlasWidth;
  atlas.height = options.atlasHeight;
  atlas.maxTriangles = world.model.triangleCount;
  atlas_ = gpgp.take(gpgp::Atlas::create(gpgp.context, atlas), "gpgpCreateAtlas");
  auto recorder = gpgp::init<GpgpAtlasRecorderCreateInfo>();
  recorder.base = gpgp.recorder("atlas");
  recorder.maxTriangles = world.model.triangleCount;
  atlasRecorder_ = gpgp.take(gpgp::AtlasRecorder::create(gpgp.context, recorder), "gpgpCreateAtlasRecorder");
  gpgp.shareScratch(visibilityRecorder_);
  gpgp.shareScratch(atlasRecorder_);
  gpgp.check(visibilityRecorder_.prewarm(), "gpgpPrewarm");
  gpgp.check(atlasRecorder_.prewarm(), "gpgpPrewarm");
}

/// What the viewer may see while the result is displayed: recordings from a few places, united.
void ShadingRenderer::recordVisibility(VkCommandBuffer commands, const GpgpFrame& frame, const PoseMessage& pose,
                                       Shaded& result) {
  auto motion = gpgp::init<GpgpViewMotionInfo>();
  const mini::Camera camera = cameraOf(pose.view, options_.fieldOfView, options_.width, options_.height);
  std::copy_n(glm::value_ptr(camera.viewProjection), 16, motion.camera.viewProjection);
  motion.width = options_.width;
  motion.height = options_.height;
  std::copy_n(glm::value_ptr(pose.view.velocity), 3, motion.velocity);
  motion.acceleration = kAcceleration;
  motion.earliest = pose.earliest;
  motion.latest = pose.latest;
  const float mostTurn = 1.4f / std::max(pose.latest, 1e-3f); // gpgp takes less than a quarter of a turn in all
  motion.turnRate = std::min(pose.view.turnRate * kTurnMargin + kLeastTurn, mostTurn);
  motion.tiltRate = std::min(pose.view.tiltRate * kTurnMargin + kLeastTurn, mostTurn);
  GpgpCamera cameras[kMaxCameras];
  uint32_t count = kMaxCameras;
  GpgpViewMotionCoverage coverage{};
  stage_.gpgp.check(gpgpGetViewMotionCameras(&motion, &count, cameras, &coverage), "gpgpGetViewMotionCameras");
  result.cameras = count;
  for (uint32_t i = 0; i < count; ++i) {
    auto info = gpgp::init<GpgpVisibilityInfo>();
    info.base.tag = i;
    info.base.scratch = stage_.gpgp.scratch();
    info.geometrySet = geometry_;
    info.method = options_.method;
    info.camera = cameras[i];
    // Other methods than exact find nothing smaller than a pixel: they get the full size in the corners, too.
    const bool small = i > 0 && options_.method == GPGP_SAMPLING_EXACT;
    info.width = std::min(small ? coverage.cornerWidth : coverage.width, maxWidth_);
    info.height = std::min(small ? coverage.cornerHeight : coverage.height, maxHeight_);
    info.accumulate = i > 0;
    if (options_.method == GPGP_SAMPLING_CONSERVATIVE) {
      info.heuristics = GPGP_HEURISTICS_DEFAULT;
      info.epsilonStatic = info.epsilonDynamic = 0.05f;
    }
    info.positions = scene_.positions.forGpgp(mini::kNoAccess, mini::kNoAccess);
    info.indices = scene_.indices.forGpgp(mini::kNoAccess, mini::kNoAccess);
    info.indexType = VK_INDEX_TYPE_UINT32;
    info.draws = scene_.draws.forGpgp(mini::kNoAccess, mini::kNoAccess);
    info.drawCount = static_cast<uint32_t>(world_.model.draws.size());
    info.triangleCount = world_.model.triangleCount;
    info.visibleBits = visible_.forGpgp(i ? kAfter : mini::kNoAccess, kAfter);
    info.triangleSizes = sizes_.forGpgp(i ? kAfter : mini::kNoAccess, kAfter);
    stage_.gpgp.check(visibilityRecorder_.recordPrepare(commands, frame, info), "gpgpRecordPrepareVisibility");
  }
}

void ShadingRenderer::recordAtlas(VkCommandBuffer commands, const GpgpFrame& frame) {
  auto info = gpgp::init<GpgpAtlasInfo>();
  info.base.scratch = stage_.gpgp.scratch();
  info.atlas = atlas_;
  info.triangleCount = world_.model.triangleCount;
  info.visibleBits = visible_.forGpgp(mini::kNoAccess, mini::kNoAccess);
  info.triangleSizes = sizes_.forGpgp(mini::kNoAccess, mini::kNoAccess);
  info.texelsPerPixel = options_.texelsPerPixel;
  if (frame_ == 0) {
    info.geometrySet = geometry_;
    info.draws = scene_.draws.forGpgp(mini::kNoAccess, mini::kNoAccess);
    info.drawCount = static_cast<uint32_t>(world_.model.draws.size());
    info.indices = scene_.indices.forGpgp(mini::kNoAccess, mini::kNoAccess);
    info.indexType = VK_INDEX_TYPE_UINT32;
  }
  if (options_.reshade > 1) {
    auto* bits = static_cast<uint32_t*>(shadeBits_.mapped);
    for (uint32_t word = 0; word < bits_.size(); ++word) bits[word] = (word + frame_) % options_.reshade ? 0 : ~0u;
    info.shadeBits = shadeBits_.forGpgp(mini::kNoAccess, mini::kNoAccess);
  }
  info.blocks = blocks_.forGpgp(mini::kNoAccess, kAfter);
  info.tiles = tiles_.forGpgp(mini::kNoAccess, kAfter);
  info.dispatches = dispatches_.forGpgp(mini::kNoAccess, kAfter);
  info.newBlocks = new_.forGpgp(mini::kNoAccess, kAfter);
  info.changedBlocks = changed_.forGpgp(mini::kNoAccess, kAfter);
  info.goneBlocks = gone_.forGpgp(mini::kNoAccess, kAfter);
  info.counts = counts_.forGpgp(mini::kNoAccess, kAfter);
  stage_.gpgp.check(atlasRecorder_.recordPrepare(commands, frame, info), "gpgpRecordPrepareAtlas");
}

void ShadingRenderer::recordShading(VkCommandBuffer commands, double seconds) {
  struct {
    glm::mat4 sun;
    glm::vec4 lantern;
    uint32_t triangleCount, drawCount, gutter;
  } const push{shadow_.matrix, lanternAt(seconds, world_), world_.model.triangleCount,
               static_cast<uint32_t>(world_.model.draws.size()), options_.gutter};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.handle);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.layout, 0, 1, &set_.handle, 0, nullptr);
  vkCmdPushConstants(commands, pipeline_.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, 92, &push);
  vkCmdDispatchIndirect(commands, dispatches_.handle, 0);
  barrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
          VK_ACCESS_TRANSFER_READ_BIT);
  const VkBufferCopy copy{0, 0, kCountWords * 4};
  vkCmdCopyBuffer(commands, counts_.handle, read_.handle, 1, &copy);
}

/// Only what the recording listed: texels of its tiles, words of its blocks.
void ShadingRenderer::readBack(Shaded& result) {
  uint32_t counts[kCountWords];
  std::copy_n(static_cast<const uint32_t*>(read_.mapped), kCountWords, counts);
  result.tiles = counts[3];
  struct Piece {
    const mini::Buffer* from;
    VkDeviceSize bytes, at;
  } pieces[] = {{&new_, counts[0] * 4ull, 0},   {&changed_, counts[1] * 4ull, 0}, {&gone_, counts[2] * 4ull, 0},
                {&tiles_, counts[3] * 8ull, 0}, {&texels_, counts[3] * 64ull, 0}, {&blocks_, blocks_.size, 0},
                {&visible_, visible_.size, 0}};
  VkDeviceSize end = 0;
  for (Piece& piece : pieces) {
    piece.at = end;
    end += piece.bytes;
  }
  stage_.run([&](VkCommandBuffer commands, const GpgpFrame&) {
    for (const Piece& piece : pieces) {
      const VkBufferCopy copy{0, piece.at, piece.bytes};
      if (piece.bytes) vkCmdCopyBuffer(commands, piece.from->handle, read_.handle, 1, &copy);
    }
  });
  const auto words = [&](size_t piece) {
    return reinterpret_cast<const uint32_t*>(static_cast<const char*>(read_.mapped) + pieces[piece].at);
  };
  const uint32_t* now = words(5);
  std::copy_n(words(6), bits_.size(), bits_.begin());
  const auto update = [&](uint32_t triangle) {
    if (triangle < world_.model.triangleCount && blockWords_[triangle] != now[triangle]) {
      blockWords_[triangle] = now[triangle];
      result.updated.push_back(triangle);
    }
  };
  for (size_t list = 0; list < 3; ++list)
    for (uint32_t i = 0; i < counts[list]; ++i) {
      update(words(list)[i]);
      if (words(list)[i] % 2 == 0) update(words(list)[i] + 1); // where it is its pair's second
    }
  std::sort(result.updated.begin(), result.updated.end());

  const uint32_t *tiles = words(3), *texels = words(4);
  for (uint32_t i = 0; i < result.tiles; ++i) {
    const GpgpAtlasBlock block = gpgpAtlasBlock(blockWords_[tiles[i * 2]]);
    const uint32_t columns = std::max(block.width / 4, 1u);
    const uint32_t x = block.x + tiles[i * 2 + 1] % columns * 4, y = block.y + tiles[i * 2 + 1] / columns * 4;
    bool differs = false;
    for (uint32_t k = 0; k < 16; ++k) {
      const uint32_t texel = texels[size_t{i} * 16 + k];
      if (!texel) continue; // no filter reads it
      uint32_t& kept = atlasTexels_.texels[size_t{y + k / 4} * atlasTexels_.width + x + k % 4];
      differs = differs || kept != texel;
      kept = texel;
    }
    if (differs) result.changedTiles.push_back(y / 4 * atlasTexels_.tileColumns() + x / 4);
  }
  std::sort(result.changedTiles.begin(), result.changedTiles.end());
}

/// Each stage is submitted and waited for by itself: software devices have no useful clock of their own.
Shaded ShadingRenderer::shade(const PoseMessage& pose) {
  Shaded result;
  const auto timed = [](float& milliseconds, const auto& stage) {
    const auto begin = std::chrono::steady_clock::now();
    stage();
    milliseconds = std::chrono::duration<float, std::milli>(std::chrono::steady_clock::now() - begin).count();
  };
  timed(result.times.visibility, [&] {
    stage_.run(
        [&](VkCommandBuffer commands, const GpgpFrame& frame) { recordVisibility(commands, frame, pose, result); });
  });
  timed(result.times.allocation,
        [&] { stage_.run([&](VkCommandBuffer commands, const GpgpFrame& frame) { recordAtlas(commands, frame); }); });
  timed(result.times.shading, [&] {
    stage_.run([&](VkCommandBuffer commands, const GpgpFrame&) { recordShading(commands, pose.seconds); });
  });
  for (auto report = visibilityRecorder_.report(); report; report = visibilityRecorder_.report())
    result.visibility = *report;
  for (auto report = atlasRecorder_.report(); report; report = atlasRecorder_.report()) result.atlas = *report;
  if (result.visibility.base.status == GPGP_ERROR_UNSUPPORTED || result.atlas.base.status == GPGP_ERROR_UNSUPPORTED)
    throw std::runtime_error("the device ended loops of gpgp's shaders early");
  timed(result.times.reading, [&] { readBack(result); });
  ++frame_;
  return result;
}

} // namespace streaming
