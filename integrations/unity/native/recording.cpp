// What is recorded at an event: Unity's frame as gpgp's, and a canvas into a render texture.
#include "plugin.h"

#include <algorithm>

namespace gpgp::unity {

void Plugin::onRenderEvent(int eventId, int32_t number) {
  const std::scoped_lock lock(mutex_);
  if (state_ != GPGP_UNITY_READY || eventId != eventId_) return;
  complained_ = false;
  const auto found = surfaces_.find(number);
  if (found == surfaces_.end() || !found->second.texture) return;
  Surface& surface = found->second;
  UnityVulkanImage image{};
  if (!vulkan_->AccessTexture(surface.texture, UnityVulkanWholeImage, VK_IMAGE_LAYOUT_UNDEFINED, 0, 0,
                              kUnityVulkanResourceAccess_ObserveOnly, &image))
    return complain(surface, "the canvas's texture is none of Unity's");
  if (image.format != VK_FORMAT_R8G8B8A8_UNORM && image.format != VK_FORMAT_R16G16B16A16_SFLOAT)
    return complain(surface, "a canvas's texture has the format R8G8B8A8_UNorm or R16G16B16A16_SFloat");
  if (!(image.usage & VK_IMAGE_USAGE_STORAGE_BIT))
    return complain(surface, "a canvas's texture needs enableRandomWrite, before it is created");
  if (image.samples != VK_SAMPLE_COUNT_1_BIT) return complain(surface, "a canvas's texture has one sample a pixel");
  // Unity knows from here on what state the texture is in, and brings it into the next one by itself.
  if (!vulkan_->AccessTexture(
          surface.texture, UnityVulkanWholeImage, VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
          VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT, kUnityVulkanResourceAccess_PipelineBarrier, &image))
    return complain(surface, "the canvas's texture cannot be written");
  UnityVulkanRecordingState state{}; // asked for last: accesses may go on in another command buffer
  if (!vulkan_->CommandRecordingState(&state, kUnityVulkanGraphicsQueueAccess_DontCare)) return;
  if (state.subPassIndex >= 0)
    return complain(surface, "the event was issued where Unity cannot leave its render pass");
  if (advance(surface, state)) record(surface, state, image);
}

/// Tells gpgp of Unity's frame, once.
bool Plugin::advance(Surface& surface, const UnityVulkanRecordingState& state) {
  if (state.currentFrameNumber <= frame_) return true;
  const GpgpFrame frame{state.currentFrameNumber, std::min(state.safeFrameNumber, state.currentFrameNumber - 1)};
  if (frame.current - frame.safe > kFramesInFlight) {
    complain(surface, "the GPU is more than " + std::to_string(kFramesInFlight) +
                          " frames behind Unity; canvases keep what they show until it has caught up");
    return false;
  }
  if (context_.advance(frame) < 0) return false;
  frame_ = frame.current;
  freeViews(frame.safe);
  for (auto report = canvas_.report(); report; report = canvas_.report())
    if (report->base.status == GPGP_BUDGET_EXCEEDED && !reportedBudget_) {
      reportedBudget_ = true;
      const auto needed = [](const char* name, uint32_t needs, uint32_t has) {
        return std::string(name) + ' ' + std::to_string(needs) + " (it has " + std::to_string(has) + ')';
      };
      say("a canvas needs " + needed("maxTileEntries", report->tileEntries, report->tileEntriesGiven) + ", " +
          needed("maxPaths", report->paths, report->pathsGiven) + ", " +
          needed("maxTileWords", report->tileWords, report->tileWordsGiven) + ", " +
          needed("maxGlyphs", report->glyphs, report->glyphsGiven) + ", " +
          needed("maxItems", report->items, report->itemsGiven) + ", " +
          needed("maxShapes", report->shapes, report->shapesGiven) + ": gpgpUnitySetBudgets");
    }
  return true;
}

void Plugin::freeViews(uint64_t safe) {
  std::erase_if(views_, [&](const View& view) {
    if (view.frame > safe) return false;
    destroyImageView_(device_.device, view.view, nullptr);
    return true;
  });
}

/// What the canvas shows, as one list.
bool Plugin::fillList(Surface& surface, float height) {
  list_.clear();
  uint32_t dropped = 0;
  for (const GpgpUnityItem& from : surface.items) {
    const auto drawing = drawings_.find(from.object);
    const auto text = texts_.find(from.object);
    if (drawing == drawings_.end() && text == texts_.end()) continue;
    float transform[6];
    std::copy_n(from.transform, 6, transform);
    if (surface.flags & GPGP_UNITY_FLIP) {
      transform[1] = -transform[1];
      transform[3] = -transform[3];
      transform[5] = height - transform[5];
    }
    if (list_.pushTransform(transform) < 0) continue; // errors are messages already
    if (list_.pushOpacity(from.opacity) >= 0) {
      const GpgpResult added = drawing != drawings_.end() ? list_.add(drawing->second) : addText(text->second, dropped);
      list_.pop();
      if (added < 0) return false;
    }
    list_.pop();
  }
  if (dropped > 0)
    complain(surface, std::to_string(dropped) +
                          " glyphs are not drawn: there is no room in the glyph set, or for more than " +
                          std::to_string(kPictures) + " pictures at a time");
  return true;
}

GpgpResult Plugin::addText(const Text& text, uint32_t& dropped) {
  for (const int32_t font : text.fonts)
    if (!fonts_.count(font)) return GPGP_SUCCESS; // as its number says, it is gone
  const Result<GpgpLayoutInfo> layout = text.layout.info();
  if (!layout) return layout.code();
  placed_.clear();
  const GpgpResult result = glyphs_.place(*layout, 0, 0, 1, placed_);
  dropped += placed_.dropped;
  return result < 0 ? result : glyphs_.addTo(list_, placed_);
}

void Plugin::record(Surface& surface, const UnityVulkanRecordingState& state, const UnityVulkanImage& image) {
  const GpgpFrame frame{state.currentFrameNumber, std::min(state.safeFrameNumber, state.currentFrameNumber - 1)};
  if (!fillList(surface, static_cast<float>(image.extent.height))) return;
  VkImageViewCreateInfo viewInfo{};
  viewInfo.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  viewInfo.image = image.image;
  viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
  viewInfo.format = image.format;
  viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  View& view = views_.emplace_back();
  view.frame = frame.current;
  // Made anew for each event: Unity may give another image the handle of one that it has destroyed.
  if (load<PFN_vkCreateImageView>("vkCreateImageView")(device_.device, &viewInfo, nullptr, &view.view) != VK_SUCCESS) {
    views_.pop_back();
    return complain(surface, "no view of the canvas's texture could be made");
  }
  if (!context_.recordUpload(state.commandBuffer, frame)) return;
  if (glyphs_.recordUpload(state.commandBuffer, frame) < 0)
    return complain(surface, "there is no memory for glyphs that are pictures");
  GpgpCanvasItem item{};
  item.list = list_;
  item.transform[0] = item.transform[3] = 1;
  item.opacity = 1;
  const std::optional<GpgpCanvasImage> pictures = glyphs_.image();
  auto info = init<GpgpCanvasInfo>();
  info.base.accessMode = GPGP_ACCESS_EXTERNAL_BARRIERS; // Unity's barriers
  info.width = image.extent.width;
  info.height = image.extent.height;
  info.items = &item;
  info.itemCount = 1;
  info.images = pictures ? &*pictures : nullptr;
  info.imageCount = pictures ? 1 : 0;
  std::copy_n(surface.background, 4, info.background);
  info.exactArea = VK_TRUE; // small letters want it
  info.encodeSrgb = info.blendSrgb = (surface.flags & GPGP_UNITY_ENCODE_SRGB) ? VK_TRUE : VK_FALSE;
  info.target.image = image.image;
  info.target.view = view.view;
  info.target.format = image.format;
  info.target.width = image.extent.width;
  info.target.height = image.extent.height;
  const GpgpResult result = canvas_.recordPrepare(state.commandBuffer, frame, info); // errors are messages already
  if (result == GPGP_SUCCESS && !complained_) surface.complaint.clear();
}

} // namespace gpgp::unity
