// gpgp::rmlui: RmlUi by gpgp. Its render interface on a canvas, its font engine on libgpgp_text.
//
//   rmlui::FontEngine fonts;                    before Rml::Initialise, until after Rml::Shutdown
//   rmlui::Renderer renderer(info);             likewise; info.fonts = &fonts
//   Rml::SetFontEngineInterface(&fonts);
//   Rml::SetRenderInterface(&renderer);
//   Rml::Initialise(); ...
//
//   each frame:
//   renderer.beginFrame(width, height);
//   context->Update(); context->Render();
//   renderer.prepare(commands, frame);          outside render passes
//   renderer.draw(commands, frame);             inside one of info.target
//
// How it works: RmlUi's calls are kept until prepare, which makes one list of them (ui.h). Glyphs, corners and
// gradients reach it as curves, so that they are sharp under every transform. Layers, masks and filters are those of
// lists.
//
// Made for RmlUi 6. One thread: RmlUi's.
#pragma once
#include <RmlUi/Core/FontEngineInterface.h>
#include <RmlUi/Core/RenderInterface.h>
#include <gpgp/gpgp.hpp>
#include <vulkan/vulkan.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace gpgp::rmlui {

/// Fonts, text widths and glyphs for RmlUi: shaped (ligatures, kerning, Arabic, Indic), with fallback fonts, both
/// directions, and the font effects shadow, outline, glow and blur.
class FontEngine final : public Rml::FontEngineInterface {
public:
  FontEngine();
  ~FontEngine() override;

  void Initialize() override;
  void Shutdown() override;
  bool LoadFontFace(const Rml::String& file, int face, bool fallback, Rml::Style::FontWeight weight) override;
  bool LoadFontFace(const Rml::String& file, int face, const Rml::String& family, Rml::Style::FontStyle style,
                    Rml::Style::FontWeight weight, bool fallback) override;
  bool LoadFontFace(Rml::Span<const Rml::byte> data, int face, const Rml::String& family, Rml::Style::FontStyle style,
                    Rml::Style::FontWeight weight, bool fallback) override;
  Rml::FontFaceHandle GetFontFaceHandle(const Rml::String& family, Rml::Style::FontStyle style,
                                        Rml::Style::FontWeight weight, int size) override;
  Rml::FontEffectsHandle PrepareFontEffects(Rml::FontFaceHandle handle, const Rml::FontEffectList& effects) override;
  const Rml::FontMetrics& GetFontMetrics(Rml::FontFaceHandle handle) override;
  int GetStringWidth(Rml::FontFaceHandle handle, Rml::StringView string, const Rml::TextShapingContext& shaping,
                     Rml::Character prior) override;
  int GenerateString(Rml::RenderManager& manager, Rml::FontFaceHandle handle, Rml::FontEffectsHandle effects,
                     Rml::StringView string, Rml::Vector2f position, Rml::ColourbPremultiplied colour, float opacity,
                     const Rml::TextShapingContext& shaping, Rml::TexturedMeshList& meshes) override;
  int GetVersion(Rml::FontFaceHandle handle) override;
  void ReleaseFontResources() override;

  /// Font number i of its meshes. Fonts stay open until the engine goes.
  GpgpFont font(uint32_t number) const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A picture file, decoded: 4 bytes a pixel, rows from the top, sRGB, colours multiplied by alpha.
struct DecodedImage {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> pixels;
};

struct RendererInfo {
  GpgpContext context = nullptr;
  VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;       ///< the context's
  uint32_t queueFamily = 0;               ///< with graphics and compute
  const FontEngine* fonts = nullptr;      ///< null: another font engine, whose glyphs come as textures
  const GpgpTargetInfo* target = nullptr; ///< what draw() draws into; null: prepare() writes images alone
  uint32_t maxWidth = 1920, maxHeight = 1080;
  /// Decodes the pictures that documents name. False: there is none, or it is no picture.
  std::function<bool(const std::string& source, DecodedImage& image)> loadImage;
  /// Optional, asked before loadImage: a drawing (a baked or compiled SVG) in place of a picture, for `img` and
  /// decorators. It is shown as curves at every size. An empty one: it is none.
  std::function<Drawing(const std::string& source)> loadDrawing;
  /// Budgets of a frame; 0: what a page of several screens takes.
  uint32_t maxShapes = 0; ///< triangles, gradients, clips
  uint32_t maxGlyphs = 0;
  uint32_t maxItems = 0;       ///< changes of transforms, clips and layers
  uint32_t maxImages = 0;      ///< textures
  uint32_t maxLayerPixels = 0; ///< of layers, filters and masks
  uint32_t glyphSetGlyphs = 0; ///< kept, of all fonts (GpgpGlyphSetCreateInfo::maxGlyphs)
  VkDeviceSize glyphSetBytes = 0;
};

/// What the last prepare did.
struct FrameReport {
  uint32_t images = 0;   ///< textures that were painted with
  uint32_t saved = 0;    ///< textures that layers were saved as
  uint32_t uploaded = 0; ///< textures
  uint32_t dropped = 0;  ///< glyphs, textures: there was no room
};

class Renderer final : public Rml::RenderInterface {
public:
  /// Makes canvas, pipelines and glyph set. Throws std::runtime_error with what failed.
  explicit Renderer(const RendererInfo& info);
  /// After Rml::Shutdown; the device must be idle as far as frames that were prepared are concerned.
  ~Renderer() override;

  /// Before Rml::Context::Render, at the size of the context. What was recorded and not prepared is forgotten.
  void beginFrame(uint32_t width, uint32_t height);
  /// After it. Records uploads of all that the gpgp context has pending, textures, and the canvas: into the history
  /// that draw() shows where there is a RendererInfo::target, and into `image` (R8G8B8A8_UNORM, sRGB-encoded colours
  /// that are multiplied by alpha) where it is not null. NOT_READY: nothing is shown in this frame. INVALID_ARGUMENT
  /// and no message: larger than maxWidth x maxHeight.
  /// @pass outside
  /// @state as gpgpRecordPrepareCanvas
  GpgpResult prepare(VkCommandBuffer commands, const GpgpFrame& frame, const GpgpImage* image = nullptr);
  /// Draws what was prepared over the viewport, which the engine has set.
  /// @pass inside
  /// @state as gpgpRecordDrawCanvas
  GpgpResult draw(VkCommandBuffer commands, const GpgpFrame& frame);

  const FrameReport& report() const;
  /// What was left out or drawn otherwise so far, once each; RmlUi's log has it, too.
  const std::vector<std::string>& unsupported() const;
  /// For gpgpGetCanvasReport, to see exceeded budgets.
  GpgpRecorder canvas() const;

  Rml::CompiledGeometryHandle CompileGeometry(Rml::Span<const Rml::Vertex> vertices,
                                              Rml::Span<const int> indices) override;
  void RenderGeometry(Rml::CompiledGeometryHandle geometry, Rml::Vector2f translation,
                      Rml::TextureHandle texture) override;
  void ReleaseGeometry(Rml::CompiledGeometryHandle geometry) override;
  Rml::TextureHandle LoadTexture(Rml::Vector2i& size, const Rml::String& source) override;
  Rml::TextureHandle GenerateTexture(Rml::Span<const Rml::byte> source, Rml::Vector2i size) override;
  void ReleaseTexture(Rml::TextureHandle texture) override;
  void EnableScissorRegion(bool enable) override;
  void SetScissorRegion(Rml::Rectanglei region) override;
  void EnableClipMask(bool enable) override;
  void RenderToClipMask(Rml::ClipMaskOperation operation, Rml::CompiledGeometryHandle geometry,
                        Rml::Vector2f translation) override;
  void SetTransform(const Rml::Matrix4f* transform) override;
  Rml::LayerHandle PushLayer() override;
  void CompositeLayers(Rml::LayerHandle source, Rml::LayerHandle destination, Rml::BlendMode blend,
                       Rml::Span<const Rml::CompiledFilterHandle> filters) override;
  void PopLayer() override;
  Rml::TextureHandle SaveLayerAsTexture() override;
  Rml::CompiledFilterHandle SaveLayerAsMaskImage() override;
  Rml::CompiledFilterHandle CompileFilter(const Rml::String& name, const Rml::Dictionary& parameters) override;
  void ReleaseFilter(Rml::CompiledFilterHandle filter) override;
  Rml::CompiledShaderHandle CompileShader(const Rml::String& name, const Rml::Dictionary& parameters) override;
  void RenderShader(Rml::CompiledShaderHandle shader, Rml::CompiledGeometryHandle geometry, Rml::Vector2f translation,
                    Rml::TextureHandle texture) override;
  void ReleaseShader(Rml::CompiledShaderHandle shader) override;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace gpgp::rmlui
