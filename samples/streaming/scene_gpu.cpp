#include "scene_gpu.h"

#include "shaders/streaming_visible_frag.spv.h"
#include "shaders/streaming_visible_vert.spv.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace streaming {
namespace {

constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr VkFormat kPixelFormat = VK_FORMAT_R32G32B32A32_UINT;
constexpr VkDeviceSize kPixelBytes = 16;

VkRenderPass makeRenderPass(mini::Device& device) {
  VkAttachmentDescription attachments[2] = {};
  attachments[0].format = kPixelFormat;
  attachments[1].format = mini::Forward::kDepthFormat;
  for (VkAttachmentDescription& attachment : attachments) {
    attachment.samples = VK_SAMPLE_COUNT_1_BIT;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    attachment.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    attachment.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    attachment.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    attachment.finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
  }
  attachments[0].storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  attachments[0].finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  const VkAttachmentReference colour{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &colour;
  subpass.pDepthStencilAttachment = &depth;
  const VkPipelineStageFlags drawn = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                     VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                     VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
  const VkAccessFlags written = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  const VkSubpassDependency dependencies[] = {
      {VK_SUBPASS_EXTERNAL, 0, drawn | VK_PIPELINE_STAGE_TRANSFER_BIT, drawn, written,
       written | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT, 0},
      {0, VK_SUBPASS_EXTERNAL, drawn, VK_PIPELINE_STAGE_TRANSFER_BIT, written, VK_ACCESS_TRANSFER_READ_BIT, 0}};
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  info.attachmentCount = 2;
  info.pAttachments = attachments;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  info.dependencyCount = 2;
  info.pDependencies = dependencies;
  VkRenderPass renderPass = VK_NULL_HANDLE;
  mini::check(vkCreateRenderPass(device.device, &info, nullptr, &renderPass), "vkCreateRenderPass");
  return renderPass;
}

} // namespace

mini::Buffer makeHostBuffer(mini::Device& device, VkDeviceSize bytes, VkBufferUsageFlags usage) {
  return mini::Buffer(device, std::max<VkDeviceSize>(bytes, 4), usage, true);
}

mini::Buffer makeDeviceBuffer(mini::Device& device, VkDeviceSize bytes) {
  return mini::Buffer(device, std::max<VkDeviceSize>(bytes, 4),
                      kStorage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                          VK_BUFFER_USAGE_TRANSFER_DST_BIT);
}

void barrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkAccessFlags written, VkPipelineStageFlags to,
             VkAccessFlags read) {
  const VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, written, read};
  vkCmdPipelineBarrier(commands, from, to, 0, 1, &memory, 0, nullptr, 0, nullptr);
}

Stage::Stage(const std::string& name, bool validate)
    : device({name, validate, {}, false}), gpgp(device, 1), frames_(device, 1) {}

void Stage::run(const std::function<void(VkCommandBuffer, const GpgpFrame&)>& record) {
  const VkCommandBuffer commands = frames_.begin();
  gpgp.check(gpgp.context.advance(frames_.number()), "gpgpAdvance");
  gpgp.check(gpgp.context.recordUpload(commands, frames_.number()).code(), "gpgpRecordUpload");
  record(commands, frames_.number());
  barrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
          VK_ACCESS_HOST_READ_BIT);
  frames_.submit();
  frames_.finish();
  gpgp.check(gpgp.context.advance(frames_.number()), "gpgpAdvance"); // its reports are ready
}

void Stage::checkMessages() const {
  if (const uint32_t count = device.validationMessages())
    throw std::runtime_error(std::to_string(count) + " messages of the validation layer");
}

SceneBuffers::SceneBuffers(mini::Device& device, const World& world)
    : positions(makeBuffer(device, world.model.positions, kStorage)),
      normals(makeBuffer(device, world.model.normals, kStorage)),
      indices(makeBuffer(device, world.model.indices, kStorage)),
      draws(makeBuffer(device, world.model.draws, kStorage)), meshes(makeBuffer(device, world.model.meshes, kStorage)),
      materials(makeBuffer(device, world.materials, kStorage)) {
  static_assert(sizeof(Material) == 16 && sizeof(GpgpMesh) == 12 && sizeof(GpgpVisibilityDraw) == 64);
}

TrianglePicture::TrianglePicture(mini::Device& device, const World& world, const SceneBuffers& scene, VkExtent2D extent)
    : pixels(makeDeviceBuffer(device, kPixelBytes * extent.width * extent.height)), device_(device), world_(world),
      extent_(extent),
      colour_(device, kPixelFormat, extent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
              VK_SAMPLE_COUNT_1_BIT, VK_IMAGE_ASPECT_COLOR_BIT),
      depth_(device, mini::Forward::kDepthFormat, extent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
             VK_SAMPLE_COUNT_1_BIT, VK_IMAGE_ASPECT_DEPTH_BIT),
      renderPass_(makeRenderPass(device)), set_(device, scene.all(), VK_SHADER_STAGE_VERTEX_BIT) {
  const VkImageView views[] = {colour_.view, depth_.view};
  VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
  info.renderPass = renderPass_;
  info.attachmentCount = 2;
  info.pAttachments = views;
  info.width = extent.width;
  info.height = extent.height;
  info.layers = 1;
  mini::check(vkCreateFramebuffer(device.device, &info, nullptr, &framebuffer_), "vkCreateFramebuffer");
  mini::PipelineInfo pipeline;
  pipeline.vertex.assign(std::begin(streaming_visible_vert), std::end(streaming_visible_vert));
  pipeline.fragment.assign(std::begin(streaming_visible_frag), std::end(streaming_visible_frag));
  pipeline.setLayout = set_.layout;
  pipeline.pushBytes = 76;
  pipeline_ = mini::Pipeline(device, renderPass_, VK_SAMPLE_COUNT_1_BIT, pipeline);
}

TrianglePicture::~TrianglePicture() {
  vkDestroyFramebuffer(device_.device, framebuffer_, nullptr);
  vkDestroyRenderPass(device_.device, renderPass_, nullptr);
}

void TrianglePicture::record(VkCommandBuffer commands, const glm::mat4& viewProjection) {
  VkClearValue clear[2] = {};
  clear[1].depthStencil.depth = 1;
  VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  begin.renderPass = renderPass_;
  begin.framebuffer = framebuffer_;
  begin.renderArea.extent = extent_;
  begin.clearValueCount = 2;
  begin.pClearValues = clear;
  vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
  const VkViewport viewport{0, 0, static_cast<float>(extent_.width), static_cast<float>(extent_.height), 0, 1};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &begin.renderArea);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.handle);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.layout, 0, 1, &set_.handle, 0, nullptr);
  struct {
    glm::mat4 viewProjection;
    uint32_t draw, firstIndex, vertexOffset;
  } push{viewProjection, 0, 0, 0};
  for (uint32_t i = 0; i < world_.model.draws.size(); ++i) {
    const GpgpMesh& mesh = world_.model.meshes[world_.model.draws[i].mesh];
    push.draw = i;
    push.firstIndex = mesh.firstIndex;
    push.vertexOffset = mesh.vertexOffset;
    vkCmdPushConstants(commands, pipeline_.layout, mini::Pipeline::kStages, 0, 76, &push);
    vkCmdDraw(commands, mesh.indexCount, 1, 0, 0);
  }
  vkCmdEndRenderPass(commands);
  VkBufferImageCopy copy{};
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageExtent = {extent_.width, extent_.height, 1};
  vkCmdCopyImageToBuffer(commands, colour_.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels.handle, 1, &copy);
  barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
          VK_ACCESS_SHADER_READ_BIT);
}

Shadow::Shadow(Stage& stage, const World& world, const SceneBuffers& scene) {
  const glm::vec3 back(0.4805f, 0.7208f, 0.5006f); // kSun of surface.glsl
  const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), back)), up = glm::cross(back, right);
  const glm::vec3 axes[] = {right, up, back};
  const glm::vec3 middle = 0.5f * (world.model.low + world.model.high), half = world.model.high - middle;
  matrix = glm::mat4(0);
  matrix[3][3] = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const float extent = glm::dot(glm::abs(axes[axis]), half) * 1.01f + 0.1f;
    const float scale = axis == 2 ? -0.5f / extent : 1 / extent, at = axis == 2 ? 0.5f : 0.0f;
    for (int i = 0; i < 3; ++i) matrix[i][axis] = scale * axes[axis][i];
    matrix[3][axis] = at - scale * glm::dot(axes[axis], middle);
  }
  TrianglePicture picture(stage.device, world, scene, {kShadowSide, kShadowSide});
  stage.run([&](VkCommandBuffer commands, const GpgpFrame&) { picture.record(commands, matrix); });
  pixels = std::move(picture.pixels);
}

glm::vec4 lanternAt(double seconds, const World& world) {
  const auto t = static_cast<float>(seconds);
  const glm::vec3 size = world.model.high - world.model.low;
  const float along = 0.5f - 0.5f * std::cos(0.25f * t);
  return {1.5f * std::sin(0.8f * t), 1.2f, -(0.3f + 0.5f * along) * std::min(size.z - 20, 30.0f), 6};
}

} // namespace streaming
