#include "cli/vector/in_pass.h"

#include "host/memory.h"

#include <optional>

namespace gpgp::cli {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;

/// A render pass that clears an attachment, and resolves it where it has several samples.
class Pass {
public:
  Pass(host::HeadlessDevice& device, const InPassInfo& info)
      : device_(device), width_(info.width), height_(info.height),
        single_(device, {.format = kFormat,
                         .width = info.width,
                         .height = info.height,
                         .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT}) {
    const bool several = info.samples > 1;
    if (several)
      samples_.emplace(device, host::ImageInfo{.format = kFormat,
                                               .width = info.width,
                                               .height = info.height,
                                               .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                                               .samples = VkSampleCountFlagBits(info.samples)});
    const auto described = [](uint32_t samples, bool cleared, bool kept) {
      VkAttachmentDescription d{};
      d.format = kFormat;
      d.samples = VkSampleCountFlagBits(samples);
      d.loadOp = cleared ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_DONT_CARE;
      d.storeOp = kept ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_DONT_CARE;
      d.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
      d.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
      d.finalLayout = kept ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
      return d;
    };
    const VkAttachmentDescription attachments[] = {described(info.samples, true, !several), described(1, false, true)};
    const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
        resolve{1, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &color;
    if (several) subpass.pResolveAttachments = &resolve;
    VkRenderPassCreateInfo passInfo{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
    passInfo.attachmentCount = several ? 2 : 1;
    passInfo.pAttachments = attachments;
    passInfo.subpassCount = 1;
    passInfo.pSubpasses = &subpass;
    host::check(device.vk().vkCreateRenderPass(device.device(), &passInfo, nullptr, &pass_), "vkCreateRenderPass");
    const VkImageView views[] = {several ? samples_->view() : single_.view(), single_.view()};
    VkFramebufferCreateInfo framebuffer{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
    framebuffer.renderPass = pass_;
    framebuffer.attachmentCount = passInfo.attachmentCount;
    framebuffer.pAttachments = views;
    framebuffer.width = width_;
    framebuffer.height = height_;
    framebuffer.layers = 1;
    host::check(device.vk().vkCreateFramebuffer(device.device(), &framebuffer, nullptr, &framebuffer_),
                "vkCreateFramebuffer");
  }
  ~Pass() {
    device_.vk().vkDestroyFramebuffer(device_.device(), framebuffer_, nullptr);
    device_.vk().vkDestroyRenderPass(device_.device(), pass_, nullptr);
  }
  Pass(const Pass&) = delete;
  Pass& operator=(const Pass&) = delete;

  VkRenderPass handle() const { return pass_; }
  const host::Image& image() const { return single_; }
  void begin(VkCommandBuffer commands, const std::array<float, 4>& background) const {
    VkClearValue clear{};
    for (size_t i = 0; i < 4; ++i) clear.color.float32[i] = background[i];
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = pass_;
    begin.framebuffer = framebuffer_;
    begin.renderArea.extent = {width_, height_};
    begin.clearValueCount = 1;
    begin.pClearValues = &clear;
    device_.vk().vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    const VkViewport viewport{0, 0, static_cast<float>(width_), static_cast<float>(height_), 0, 1};
    const VkRect2D scissor{{0, 0}, {width_, height_}};
    device_.vk().vkCmdSetViewport(commands, 0, 1, &viewport);
    device_.vk().vkCmdSetScissor(commands, 0, 1, &scissor);
  }

private:
  host::HeadlessDevice& device_;
  uint32_t width_, height_;
  host::Image single_;
  std::optional<host::Image> samples_;
  VkRenderPass pass_ = VK_NULL_HANDLE;
  VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
};

} // namespace

InPassPicture drawInPass(Session& session, const Drawing& drawing, const InPassInfo& info) {
  host::HeadlessDevice& device = session.device();
  if (!(device.properties().limits.framebufferColorSampleCounts & info.samples))
    throw Failure(std::string(device.name()) + " has no attachments of " + std::to_string(info.samples) +
                  " samples; --aa area needs one");
  const Pass pass(device, info);
  GpgpTargetInfo target = GPGP_TARGET_INFO_INIT;
  target.renderPass = pass.handle();
  target.colorFormat = kFormat;
  target.samples = VkSampleCountFlagBits(info.samples);
  GpgpPatchRecorderCreateInfo createInfo = GPGP_PATCH_RECORDER_CREATE_INFO_INIT;
  createInfo.base = session.recorderInfo("patches");
  createInfo.maxItems = 1;
  createInfo.maxGlyphs = 1;
  PatchRecorder recorder =
      session.take(PatchRecorder::create(session.context(), createInfo), "gpgpCreatePatchRecorder");
  GpgpPrewarmInfo prewarm = GPGP_PREWARM_INFO_INIT;
  prewarm.targets = &target;
  prewarm.targetCount = 1;
  session.check(recorder.prewarm(prewarm), "gpgpPrewarm");
  GpgpPatchItem item{};
  item.drawing = drawing;
  item.opacity = 1;
  for (size_t column = 0; column < 3; ++column) { // pixels to clip space: 2 / size, less 1
    float* clip = item.clip + (column == 2 ? 12 : column * 4);
    const double w = info.map[2][column];
    clip[0] = static_cast<float>(2 * info.map[0][column] / info.width - w);
    clip[1] = static_cast<float>(2 * info.map[1][column] / info.height - w);
    clip[3] = static_cast<float>(w);
  }
  GpgpPatchDrawInfo draw = GPGP_PATCH_DRAW_INFO_INIT;
  draw.target = &target;
  draw.items = &item;
  draw.itemCount = 1;
  draw.viewport[2] = static_cast<float>(info.width);
  draw.viewport[3] = static_cast<float>(info.height);
  draw.encodeSrgb = VK_TRUE;
  const auto record = [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordingInfo& base) {
    if (base.timestamps.queryPool) // there are no passes to time
      device.vk().vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, base.timestamps.queryPool,
                                      base.timestamps.firstQuery);
    pass.begin(commands, info.background);
    const GpgpResult result = recorder.recordDraw(commands, frame, draw);
    device.vk().vkCmdEndRenderPass(commands);
    return result;
  };
  session.time(recorder, "drawing", 1, record); // not counted: memory is used the first time
  InPassPicture picture;
  picture.times = session.time(recorder, "drawing", info.repeat, record);
  picture.bytes = host::downloadImage(device, pass.image(), VK_IMAGE_LAYOUT_GENERAL);
  return picture;
}

} // namespace gpgp::cli
