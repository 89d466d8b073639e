// Render pass, framebuffers, backdrop. The pass's own dependencies order it after whatever used its images before.
#include "forward.h"

#include "shaders/mini_backdrop_frag.spv.h"
#include "shaders/mini_backdrop_vert.spv.h"

#include <array>
#include <iterator>

namespace mini {
namespace {

VkAttachmentDescription attachment(VkFormat format, VkSampleCountFlagBits samples, bool clear, bool store,
                                   VkImageLayout finalLayout) {
  VkAttachmentDescription description{};
  description.format = format;
  description.samples = samples;
  description.loadOp = clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  description.storeOp = store ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_DONT_CARE;
  description.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  description.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  description.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  description.finalLayout = finalLayout;
  return description;
}

} // namespace

Forward::Forward(Device& device, VkFormat format, VkImageLayout finalLayout) : device_(device), format_(format) {
  const VkAttachmentDescription attachments[] = {
      attachment(format, kSamples, true, false, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL),
      attachment(kDepthFormat, kSamples, true, false, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL),
      attachment(format, VK_SAMPLE_COUNT_1_BIT, false, true, finalLayout)};
  const VkAttachmentReference colour{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
  const VkAttachmentReference resolved{2, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &colour;
  subpass.pResolveAttachments = &resolved;
  subpass.pDepthStencilAttachment = &depth;
  constexpr VkPipelineStageFlags kAttachmentStages = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                                     VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                                     VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
  constexpr VkAccessFlags kAttachmentWrites =
      VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  VkSubpassDependency before{VK_SUBPASS_EXTERNAL,
                             0,
                             kAttachmentStages | VK_PIPELINE_STAGE_TRANSFER_BIT,
                             kAttachmentStages,
                             kAttachmentWrites,
                             kAttachmentWrites | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT |
                                 VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
                             0};
  VkSubpassDependency after{0,
                            VK_SUBPASS_EXTERNAL,
                            VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                            VK_PIPELINE_STAGE_TRANSFER_BIT,
                            VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                            VK_ACCESS_TRANSFER_READ_BIT,
                            0};
  const VkSubpassDependency dependencies[] = {before, after};
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  info.attachmentCount = 3;
  info.pAttachments = attachments;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  info.dependencyCount = 2;
  info.pDependencies = dependencies;
  check(vkCreateRenderPass(device.device, &info, nullptr, &renderPass_), "vkCreateRenderPass");

  PipelineInfo backdrop;
  backdrop.vertex.assign(std::begin(mini_backdrop_vert), std::end(mini_backdrop_vert));
  backdrop.fragment.assign(std::begin(mini_backdrop_frag), std::end(mini_backdrop_frag));
  backdrop.pushBytes = 80;
  backdrop.depth = false;
  backdrop_ = Pipeline(device, renderPass_, kSamples, backdrop);
}

Forward::~Forward() { vkDestroyRenderPass(device_.device, renderPass_, nullptr); }

void Forward::resize(VkExtent2D extent) {
  extent_ = extent;
  colour_ =
      Image(device_, format_, extent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSIENT_ATTACHMENT_BIT,
            kSamples, VK_IMAGE_ASPECT_COLOR_BIT);
  depth_ = Image(device_, kDepthFormat, extent,
                 VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSIENT_ATTACHMENT_BIT, kSamples,
                 VK_IMAGE_ASPECT_DEPTH_BIT);
}

VkFramebuffer Forward::makeFramebuffer(VkImageView resolved) {
  const VkImageView views[] = {colour_.view, depth_.view, resolved};
  VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
  info.renderPass = renderPass_;
  info.attachmentCount = 3;
  info.pAttachments = views;
  info.width = extent_.width;
  info.height = extent_.height;
  info.layers = 1;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  check(vkCreateFramebuffer(device_.device, &info, nullptr, &framebuffer), "vkCreateFramebuffer");
  return framebuffer;
}

void Forward::begin(VkCommandBuffer commands, VkFramebuffer framebuffer) {
  VkClearValue clear[2] = {};
  clear[1].depthStencil = {1.0f, 0};
  VkRenderPassBeginInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  info.renderPass = renderPass_;
  info.framebuffer = framebuffer;
  info.renderArea = {{0, 0}, extent_};
  info.clearValueCount = 2;
  info.pClearValues = clear;
  vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
  setArea(commands, info.renderArea);
}

void Forward::setArea(VkCommandBuffer commands, const VkRect2D& area, bool clear) {
  const VkViewport viewport{static_cast<float>(area.offset.x),
                            static_cast<float>(area.offset.y),
                            static_cast<float>(area.extent.width),
                            static_cast<float>(area.extent.height),
                            0,
                            1};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &area);
  if (!clear) return;
  VkClearAttachment depth{VK_IMAGE_ASPECT_DEPTH_BIT, 0, {}};
  depth.clearValue.depthStencil = {1.0f, 0};
  const VkClearRect rectangle{area, 0, 1};
  vkCmdClearAttachments(commands, 1, &depth, 1, &rectangle);
}

void Forward::drawBackdrop(VkCommandBuffer commands, const Camera& camera) {
  struct {
    glm::mat4 fromClip;
    glm::vec4 eye;
  } const push{glm::inverse(camera.viewProjection), camera.eyeAndLight()};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, backdrop_.handle);
  vkCmdPushConstants(commands, backdrop_.layout, Pipeline::kStages, 0, sizeof push, &push);
  vkCmdDraw(commands, 3, 1, 0, 0);
}

} // namespace mini
