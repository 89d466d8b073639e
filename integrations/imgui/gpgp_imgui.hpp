// gpgp::imgui: Dear ImGui drawn by gpgp, in place of ImGui's own renderer; drawings and laid out texts as widgets.
//
//   Renderer renderer(info);
//   renderer.useFonts(*io.Fonts);                    optional: ImGui's text as outlines, sharp at every scale
//   renderer.createFontTexture(*io.Fonts);
//   ImTextureID picture = renderer.addTexture(image);
//
//   each frame:
//   ImGui::NewFrame(); ... renderer.drawing(asset, size); renderer.text(layout); ... ImGui::Render();
//   renderer.prepare(*ImGui::GetDrawData(), commands, frame);      outside render passes
//   renderer.draw(commands, frame);                                inside
//
// How it works: prepare translates ImGui's draw lists to one list of gpgp's (gpgp/ui.h) and rasterises that into a
// canvas: triangles with their colours and textures, clip rectangles, glyphs and widgets in ImGui's order. draw shows
// the canvas. There is no pipeline beside gpgp's.
//
// Made for Dear ImGui 1.86. One thread: ImGui's.
#pragma once
#include <gpgp/gpgp.hpp>
#include <imgui.h>
#include <vulkan/vulkan.h>

#include <memory>
#include <string>

namespace gpgp::imgui {

struct RendererInfo {
  GpgpContext context = nullptr;
  VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;       ///< the context's
  uint32_t queueFamily = 0;               ///< with graphics and compute
  const GpgpTargetInfo* target = nullptr; ///< what draw() draws into: a render pass, or formats of dynamic rendering
  /// The colour attachment encodes sRGB: ImGui's colours are then taken as linear. Otherwise they are stored as they
  /// are and mixed as they are, as by ImGui's own renderer.
  bool srgbTarget = false;
  uint32_t maxWidth = 1920, maxHeight = 1080; ///< of the framebuffer, pixels: as large as the window may become
  /// Samples a pixel: 1, 4, 8 or 16. 1 gives what ImGui's own renderer gives, pixel by pixel. More make edges smooth
  /// that lie between pixels; text that ImGui draws by useFonts wants 16.
  uint32_t samples = 16;
  // Budgets of a frame.
  uint32_t maxTriangles = 32768;
  uint32_t maxGlyphs = 8192;
  uint32_t maxItems = 4096;  ///< widgets, and changes from triangles to text, of texture and of clip rectangle
  uint32_t maxTextures = 64; ///< used in one frame, the font's among them; above 8: 8 bytes a pixel of the framebuffer
  uint32_t maxTileEntries = 0; ///< GpgpCanvasCreateInfo::maxTileEntries
  // Kept from frame to frame.
  uint32_t glyphSetGlyphs = 0; ///< of all fonts (GpgpGlyphSetCreateInfo::maxGlyphs)
  VkDeviceSize glyphSetBytes = 0;
  uint32_t maxPictures = 64; ///< glyphs that are pictures, as bitmap emoji are; 136 KB each once there is one
};

/// What the last prepare did. What did not fit a budget was not drawn, and is counted here.
struct FrameReport {
  uint32_t triangles = 0; ///< drawn; those outside of their clip rectangles, or without area, are not
  uint32_t glyphs = 0;    ///< drawn
  uint32_t widgets = 0;   ///< drawings and layouts
  uint32_t textures = 0;  ///< used
  uint32_t dropped = 0;   ///< triangles and glyphs beyond maxTriangles, maxGlyphs or what is kept; pictures, underlines
                          ///< and strikes beyond 1024; triangles with a corner that is no number or beyond 10^6
};

class Renderer {
public:
  /// For ImGui's current context, if there is one. Makes the canvas, its pipelines, a glyph set, and a history of 8
  /// bytes for each pixel. Throws std::runtime_error with what failed.
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
  /// Builds the atlas where it was not, and makes its texture, which the next prepare uploads: the atlas's TexID. Again
  /// after the atlas has changed. Throws std::runtime_error.
  void createFontTexture(ImFontAtlas& atlas);

  /// A texture for ImGui::Image, AddImage and others: what ImTextureID means with this renderer, in place of the
  /// descriptor sets of ImGui's Vulkan backend. The image must live, and be readable for compute shaders, in all frames
  /// that show it. Null where the image has no view or no sampler.
  ImTextureID addTexture(const GpgpCanvasImage& image);
  /// It must not be in draw data that is still to be prepared. INVALID_HANDLE: there is no such texture.
  GpgpResult removeTexture(ImTextureID texture);

  /// A widget: the drawing's page, undistorted, in the middle of a box of this size.
  void drawing(GpgpAsset drawing, const ImVec2& size);
  /// A widget: a text as it is laid out, pixels of the layout as units of ImGui. The layout's glyphs are read now.
  void text(GpgpLayout layout);
  /// The same at a place of one's own, in screen coordinates, e.g. for buttons. Clipped as the list clips at this
  /// point.
  void addDrawing(ImDrawList& list, GpgpAsset drawing, const ImVec2& min, const ImVec2& max);
  void addText(ImDrawList& list, GpgpLayout layout, const ImVec2& position);

  /// After ImGui::Render, with its draw data, which stays as it is. Records an upload of all that the context has
  /// pending, textures, and the canvas. NOT_READY: what is needed was not uploaded in one go; draw() shows nothing in
  /// this frame. After an error neither, and error() says why:
  /// INVALID_ARGUMENT: the framebuffer is larger than maxWidth x maxHeight (resize() helps), more textures than
  /// maxTextures, or indices beyond a list's vertices. INVALID_HANDLE: a texture that is none of addTexture's.
  /// UNSUPPORTED: a draw callback that is not a widget's: there is no pipeline whose state it could change.
  /// Other errors are gpgp's; the context's message says more.
  /// @pass outside
  /// @state as gpgpRecordPrepareCanvas
  GpgpResult prepare(ImDrawData& data, VkCommandBuffer commands, const GpgpFrame& frame);
  /// Draws what was prepared, blended over what the pass has. Sets viewport and scissor to the framebuffer.
  /// @pass inside
  /// @state as gpgpRecordDrawCanvas; viewport and scissor
  GpgpResult draw(VkCommandBuffer commands, const GpgpFrame& frame);
  /// A larger maxWidth or maxHeight: makes canvas and history anew. Does nothing where both are large enough; throws as
  /// the constructor does, and all is as it was.
  void resize(uint32_t maxWidth, uint32_t maxHeight);

  const FrameReport& report() const;
  /// What the last prepare was refused for, with its place in the draw data; empty: nothing.
  const std::string& error() const;
  /// Canvas reports, to see exceeded budgets of the GPU: gpgpGetCanvasReport. Another one after resize().
  GpgpRecorder canvas() const;
  /// Before a font is destroyed whose layouts were drawn.
  void forget(GpgpFont font);

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace gpgp::imgui
