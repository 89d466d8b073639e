// gpgp::imgui: drawings and text by gpgp in Dear ImGui, and all of ImGui's own text by gpgp.
//
//   Renderer renderer(info);
//   renderer.useFonts(*io.Fonts);                    before the atlas is built: every font of it is gpgp's from then on
//
//   each frame:
//   ImGui::NewFrame(); ... renderer.drawing(asset, size); renderer.text(layout); ... ImGui::Render();
//   renderer.prepare(*ImGui::GetDrawData(), commands, frame);      outside render passes
//   renderer.use(commands);                                        inside: before ImGui's own renderer draws
//   ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
//
// How it works: prepare takes the glyphs out of ImGui's draw lists, rasterises them together with the widgets into one
// canvas, at the size and the place that they have on the screen, and leaves a draw callback at the place in the list
// where each belongs. What overlaps on the screen lies in different layers of the canvas. So windows cover each other
// as ImGui has it, clip rectangles count, and text is sharp at every scale: FontGlobalScale, window scales,
// DisplayFramebufferScale, AddText with a size of its own.
//
// Made for Dear ImGui 1.86. One thread: ImGui's.
#pragma once
#include <gpgp/gpgp.hpp>
#include <imgui.h>
#include <vulkan/vulkan.h>

#include <memory>

namespace gpgp::imgui {

struct RendererInfo {
  GpgpContext context = nullptr;
  VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE; ///< the context's
  uint32_t queueFamily = 0;         ///< with graphics and compute
  VkRenderPass renderPass = VK_NULL_HANDLE;
  uint32_t subpass = 0;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  bool srgbTarget = false; ///< the colour attachment encodes sRGB: ImGui's colours are then taken as linear
  uint32_t maxWidth = 1920, maxHeight = 1080; ///< of the framebuffer, pixels: as large as the window may become
  uint32_t maxLayers = 4;                     ///< how often text and widgets may lie over each other
  uint32_t maxGlyphs = 8192;                  ///< of one frame
  uint32_t maxDrawings = 64;                  ///< widgets of one frame
  uint32_t glyphSetGlyphs = 0;                ///< kept, of all fonts (GpgpGlyphSetCreateInfo::maxGlyphs)
  VkDeviceSize glyphSetBytes = 0;
  uint32_t maxPictures = 64; ///< kept: glyphs that are pictures, as bitmap emoji are; 136 KB each once there is one
};

/// What the last prepare did. What did not fit a budget was not drawn, and is counted here.
struct FrameReport {
  uint32_t glyphs = 0;  ///< drawn
  uint32_t pieces = 0;  ///< draw callbacks
  uint32_t layers = 0;  ///< of the canvas
  uint32_t dropped = 0; ///< glyphs and widgets beyond maxGlyphs, maxDrawings, maxLayers or what is kept; pictures,
                        ///< underlines and strikes beyond 1024
};

class Renderer {
public:
  /// Makes the canvas, its pipelines and a glyph set; device memory of 4 bytes (srgbTarget: 8) for each pixel of each
  /// layer beside. Throws std::runtime_error with what failed.
  explicit Renderer(const RendererInfo& info);
  /// The device must be idle as far as frames that were prepared are concerned. Before the context is destroyed, before
  /// or after ImGui's; in the first case its atlas must not be built any more.
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// The atlas's fonts, as they were or will be added to it (sizes, ranges, merging, offsets), become gpgp's when it is
  /// built. Its texture keeps lines and mouse cursors, and has no glyphs; ImFontConfig's oversampling,
  /// RasterizerMultiply and FontBuilderFlags have no meaning.
  void useFonts(ImFontAtlas& atlas);

  /// A widget: the drawing's page, undistorted, in the middle of a box of this size.
  void drawing(GpgpAsset drawing, const ImVec2& size);
  /// A widget: a text as it is laid out, pixels of the layout as units of ImGui. The layout's glyphs are read now.
  void text(GpgpLayout layout);
  /// The same at a place of one's own, in screen coordinates, e.g. for buttons. Clipped as the list clips at this
  /// point.
  void addDrawing(ImDrawList& list, GpgpAsset drawing, const ImVec2& min, const ImVec2& max);
  void addText(ImDrawList& list, GpgpLayout layout, const ImVec2& position);

  /// After ImGui::Render, with its draw data, which is changed. Records an upload of all that the context has
  /// pending, and the canvas. NOT_READY: what is needed was not uploaded in one go: nothing of gpgp's is drawn in this
  /// frame. An error: the same; the context's message says why. INVALID_ARGUMENT and no message: the framebuffer is
  /// larger than maxWidth x maxHeight; the draw data is as it was, for resize() and another prepare, but not to be
  /// drawn.
  /// @pass outside
  /// @state as gpgpRecordPrepareCanvas
  GpgpResult prepare(ImDrawData& data, VkCommandBuffer commands, const GpgpFrame& frame);
  /// A larger maxWidth or maxHeight: makes canvas and image anew. Does nothing where both are large enough; throws as
  /// the constructor does, and all is as it was. The device must be idle as far as frames that were prepared are
  /// concerned.
  void resize(uint32_t maxWidth, uint32_t maxHeight);
  /// The command buffer that ImGui's renderer draws into next. The callbacks leave its state to ImGui's reset.
  void use(VkCommandBuffer commands);

  const FrameReport& report() const;
  /// Canvas reports, to see exceeded budgets of the GPU: gpgpGetCanvasReport. Another one after resize().
  GpgpRecorder canvas() const;
  /// Before a font is destroyed whose layouts were drawn.
  void forget(GpgpFont font);

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace gpgp::imgui
