#include "display.h"

#include "shaders/streaming_display_comp.spv.h"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace streaming {
namespace {
constexpr uint32_t kCounters = 6;
}

DisplayRenderer::DisplayRenderer(Stage& stage, const World& world, const Welcome& welcome, uint32_t width,
                                 uint32_t height, float fieldOfView)
    : stage_(stage), world_(world), welcome_(welcome), fieldOfView_(fieldOfView), scene_(stage.device, world),
      shadow_(stage, world, scene_), triangles_(stage.device, world, scene_, {width, height}),
      blocks_(makeDeviceBuffer(stage.device, VkDeviceSize{welcome.triangleCount} * 4)),
      atlas_(makeDeviceBuffer(stage.device, VkDeviceSize{welcome.atlasWidth} * welcome.atlasHeight * 4)),
      lastColours_(makeDeviceBuffer(stage.device, VkDeviceSize{welcome.triangleCount} * 4)),
      drawColours_(makeBuffer(stage.device, welcome.drawColours, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT)),
      bits_(makeDeviceBuffer(stage.device, (VkDeviceSize{welcome.triangleCount} + 31) / 32 * 4)),
      pixels_(makeDeviceBuffer(stage.device, VkDeviceSize{width} * height * 4)),
      localPixels_(makeDeviceBuffer(stage.device, VkDeviceSize{width} * height * 4)),
      counters_(makeDeviceBuffer(stage.device, kCounters * 4)),
      staging_(
          makeHostBuffer(stage.device, atlas_.size + blocks_.size * 2 + bits_.size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT)),
      read_(makeHostBuffer(stage.device, pixels_.size * 2 + counters_.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT)),
      set_(stage.device,
           {&scene_.positions, &scene_.normals, &scene_.indices, &scene_.draws, &scene_.meshes, &scene_.materials,
            &shadow_.pixels, &blocks_, &atlas_, &lastColours_, &drawColours_, &bits_, &triangles_.pixels, &pixels_,
            &localPixels_, &counters_},
           VK_SHADER_STAGE_COMPUTE_BIT),
      pipeline_(stage.device, {std::begin(streaming_display_comp), std::end(streaming_display_comp)}, set_.layout, 120),
      picture_{width, height, std::vector<uint32_t>(size_t{width} * height)}, local_(picture_) {
  stage.run([&](VkCommandBuffer commands, const GpgpFrame&) { // nothing has come yet
    for (const mini::Buffer* buffer : {&blocks_, &atlas_, &lastColours_, &bits_})
      vkCmdFillBuffer(commands, buffer->handle, 0, VK_WHOLE_SIZE, 0);
  });
}

void DisplayRenderer::upload(const StreamState& state) {
  const std::pair<const mini::Buffer*, const std::vector<uint32_t>*> pieces[] = {{&atlas_, &state.atlas().texels},
                                                                                 {&blocks_, &state.blocks()},
                                                                                 {&lastColours_, &state.lastColours()},
                                                                                 {&bits_, &state.visibleBits()}};
  VkDeviceSize at = 0;
  for (const auto& piece : pieces) {
    std::memcpy(static_cast<char*>(staging_.mapped) + at, piece.second->data(), piece.second->size() * 4);
    at += piece.second->size() * 4;
  }
  stage_.run([&](VkCommandBuffer commands, const GpgpFrame&) {
    VkDeviceSize from = 0;
    for (const auto& piece : pieces) {
      const VkBufferCopy copy{from, 0, piece.second->size() * 4};
      vkCmdCopyBuffer(commands, staging_.handle, piece.first->handle, 1, &copy);
      from += copy.size;
    }
  });
}

PixelCounts DisplayRenderer::render(const View& view, double seconds, uint32_t flags) {
  const mini::Camera camera = cameraOf(view, fieldOfView_, picture_.width, picture_.height);
  struct {
    glm::mat4 sun;
    glm::vec4 lantern, eye;
    uint32_t width, height, drawCount, atlasWidth, flags, gutter;
  } const push{shadow_.matrix,
               lanternAt(seconds, world_),
               glm::vec4(view.eye, 2 * std::tan(fieldOfView_ * 0.5f) / static_cast<float>(picture_.height)),
               picture_.width,
               picture_.height,
               static_cast<uint32_t>(world_.model.draws.size()),
               welcome_.atlasWidth,
               flags,
               welcome_.gutter};
  static_assert(sizeof push == 120);
  stage_.run([&](VkCommandBuffer commands, const GpgpFrame&) {
    vkCmdFillBuffer(commands, counters_.handle, 0, kCounters * 4, 0);
    triangles_.record(commands, camera.viewProjection);
    barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.handle);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.layout, 0, 1, &set_.handle, 0, nullptr);
    vkCmdPushConstants(commands, pipeline_.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push, &push);
    vkCmdDispatch(commands, (picture_.width + 7) / 8, (picture_.height + 7) / 8, 1);
    barrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
            VK_ACCESS_TRANSFER_READ_BIT);
    const VkBufferCopy counters{0, 0, counters_.size}, picture{0, counters_.size, pixels_.size},
        local{0, counters_.size + pixels_.size, pixels_.size};
    vkCmdCopyBuffer(commands, counters_.handle, read_.handle, 1, &counters);
    vkCmdCopyBuffer(commands, pixels_.handle, read_.handle, 1, &picture);
    if (flags & compare) vkCmdCopyBuffer(commands, localPixels_.handle, read_.handle, 1, &local);
  });
  const auto* words = static_cast<const uint32_t*>(read_.mapped);
  const size_t pixels = picture_.pixels.size();
  std::copy_n(words + kCounters, pixels, picture_.pixels.begin());
  if (flags & compare) std::copy_n(words + kCounters + pixels, pixels, local_.pixels.begin());
  return {words[0], words[1], words[2], words[3], words[4], words[5]};
}

} // namespace streaming
