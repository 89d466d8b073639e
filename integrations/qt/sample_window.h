// The scene of gpgp::qt's samples in a QVulkanWindow: prepared before the window's render pass, drawn inside it.
#pragma once
#include "gpgp_qt.hpp"
#include "scene.h"

#include <QtGui/QVulkanWindow>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace gpgp::sample {

constexpr float kSampleSky[4] = {0.02f, 0.03f, 0.05f, 1}; // linear

class SampleWindowRenderer final : public QVulkanWindowRenderer {
public:
  SampleWindowRenderer(QVulkanWindow& window, const Options& options, std::function<void(const std::string&)> onError)
      : window_(window), options_(options), onError_(std::move(onError)) {}

  /// Of the animation; below 0: as many turns as time has passed.
  float fixedTime = -1;
  uint32_t frames = 0; ///< so far

  void initResources() override {
    attempt([&] {
      if (window_.colorFormat() != VK_FORMAT_B8G8R8A8_SRGB && window_.colorFormat() != VK_FORMAT_R8G8B8A8_SRGB)
        throw std::runtime_error("the window has no sRGB format");
      GpgpContextCreateInfo info =
          qt::contextInfo(*window_.vulkanInstance(), window_.physicalDevice(), window_.device());
      info.label = "QVulkanWindow";
      info.maxFramesInFlight = static_cast<uint32_t>(window_.concurrentFrameCount());
      info.messageFn = onMessage;
      context_ = take(Context::create(info), "gpgpCreateContext");
      scene_.emplace(context_, options_);
      auto canvasInfo = init<GpgpCanvasCreateInfo>();
      canvasInfo.base.label = "QVulkanWindow";
      canvasInfo.base.queueFamily = window_.graphicsQueueFamilyIndex();
      canvasInfo.maxWidth = canvasInfo.maxHeight = 4096;
      canvasInfo.targets = GPGP_CANVAS_TARGET_HISTORY;
      canvas_ = take(Canvas::create(context_, canvasInfo), "gpgpCreateCanvas");
      target_ = init<GpgpTargetInfo>();
      target_.renderPass = window_.defaultRenderPass();
      target_.samples = window_.sampleCountFlagBits();
      auto prewarm = init<GpgpPrewarmInfo>();
      prewarm.targets = &target_;
      prewarm.targetCount = 1;
      need(canvas_.prewarm(prewarm), "gpgpPrewarm");
    });
  }
  void initSwapChainResources() override { // again with each size
    attempt([&] {
      const QSize size = window_.swapChainImageSize();
      auto info = init<GpgpCanvasHistoryCreateInfo>();
      info.label = "QVulkanWindow";
      info.width = static_cast<uint32_t>(size.width());
      info.height = static_cast<uint32_t>(size.height());
      view_ = take(CanvasHistory::create(context_, info), "gpgpCreateCanvasHistory");
    });
  }
  void releaseSwapChainResources() override { view_.reset(); } // freed when its frames are safe
  void releaseResources() override {                           // the device is idle
    view_.reset();
    canvas_.reset();
    scene_.reset();
    context_.reset();
    frame_ = {};
  }
  void logicalDeviceLost() override { context_.notifyDeviceLost(); }

  void startNextFrame() override {
    // The window has waited for the frame that used this frame's slot.
    const auto inFlight = static_cast<uint64_t>(window_.concurrentFrameCount());
    ++frame_.current;
    if (frame_.current > inFlight) frame_.safe = frame_.current - inFlight;
    const VkCommandBuffer commands = window_.currentCommandBuffer();
    const QSize size = window_.swapChainImageSize();
    attempt([&] {
      need(context_.advance(frame_), "gpgpAdvance");
      std::vector<GpgpCanvasItem> items;
      const float time = fixedTime >= 0 ? fixedTime : std::fmod(static_cast<float>(frames) / 240, 1.0f);
      scene_->fill(time, static_cast<float>(size.width()), static_cast<float>(size.height()), items);
      need(context_.recordUpload(commands, frame_).code(), "gpgpRecordUpload");
      auto info = init<GpgpCanvasInfo>();
      info.width = static_cast<uint32_t>(size.width());
      info.height = static_cast<uint32_t>(size.height());
      info.items = items.data();
      info.itemCount = static_cast<uint32_t>(items.size());
      info.history = view_;
      info.exactArea = VK_TRUE;
      need(canvas_.recordPrepare(commands, frame_, info), "gpgpRecordPrepareCanvas");
    });

    VkClearValue clear[3]{}; // colour, depth, and the colour that is resolved
    std::copy_n(kSampleSky, 4, clear[0].color.float32);
    std::copy_n(kSampleSky, 4, clear[2].color.float32);
    clear[1].depthStencil = {1, 0};
    VkRenderPassBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    begin.renderPass = window_.defaultRenderPass();
    begin.framebuffer = window_.currentFramebuffer();
    begin.renderArea.extent = {static_cast<uint32_t>(size.width()), static_cast<uint32_t>(size.height())};
    begin.clearValueCount = window_.sampleCountFlagBits() > VK_SAMPLE_COUNT_1_BIT ? 3 : 2;
    begin.pClearValues = clear;
    QVulkanDeviceFunctions& vk = *window_.vulkanInstance()->deviceFunctions(window_.device());
    vk.vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    const VkViewport viewport{0, 0, static_cast<float>(size.width()), static_cast<float>(size.height()), 0, 1};
    vk.vkCmdSetViewport(commands, 0, 1, &viewport);
    vk.vkCmdSetScissor(commands, 0, 1, &begin.renderArea);
    attempt([&] {
      auto draw = init<GpgpCanvasDrawInfo>();
      draw.history = view_;
      draw.target = &target_;
      draw.width = begin.renderArea.extent.width;
      draw.height = begin.renderArea.extent.height;
      draw.clip[0] = 2 / viewport.width; // pixels to clip space
      draw.clip[5] = 2 / viewport.height;
      draw.clip[10] = draw.clip[15] = 1;
      draw.clip[12] = draw.clip[13] = -1;
      need(canvas_.recordDraw(commands, frame_, draw), "gpgpRecordDrawCanvas");
    });
    vk.vkCmdEndRenderPass(commands);
    ++frames;
    window_.frameReady();
    if (!failed_) window_.requestUpdate();
  }

private:
  /// Qt's code is not to see exceptions.
  template <class Work> void attempt(const Work& work) {
    if (failed_) return;
    try {
      work();
    } catch (const std::exception& error) {
      failed_ = true;
      onError_(error.what());
    }
  }

  QVulkanWindow& window_;
  const Options& options_;
  std::function<void(const std::string&)> onError_;
  bool failed_ = false;
  Context context_;
  std::optional<Scene> scene_;
  Canvas canvas_;
  CanvasHistory view_;
  GpgpTargetInfo target_ = GPGP_TARGET_INFO_INIT;
  GpgpFrame frame_{};
};

class SampleWindow : public QVulkanWindow {
public:
  SampleWindow(const Options& options, std::function<void(const std::string&)> onError)
      : options_(options), onError_(std::move(onError)) {
    // A canvas is linear: an sRGB format encodes what is drawn. QVulkanWindow's own choice would show it too dark.
    setPreferredColorFormats({VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R8G8B8A8_SRGB});
  }
  SampleWindowRenderer* renderer = nullptr; // owned by QVulkanWindow

  QVulkanWindowRenderer* createRenderer() override {
    return renderer = new SampleWindowRenderer(*this, options_, onError_);
  }
  /// Draws a frame and returns it.
  QImage picture() {
    QImage picture = grab();
    if (colorFormat() == VK_FORMAT_B8G8R8A8_SRGB) picture = picture.rgbSwapped(); // Qt does so for UNORM alone
    return picture.convertToFormat(QImage::Format_RGB32);
  }

private:
  const Options& options_;
  std::function<void(const std::string&)> onError_;
};

} // namespace gpgp::sample
