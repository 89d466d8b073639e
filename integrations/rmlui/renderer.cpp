// RmlUi's render interface: calls are recorded, prepare makes lists of them and records canvases.
#include "filters.h"
#include "gpgp_glyph_cache.hpp"
#include "gpgp_rmlui.hpp"
#include "gpgp_srgb.hpp"
#include "gpgp_textures.hpp"
#include "text_mesh.h"
#include "writer.h"

#include <RmlUi/Core/Log.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace gpgp::rmlui {
using integration::linearFromSrgb;
using integration::Textures;
namespace {

void check(GpgpResult result, const char* what) {
  if (result < 0) throw std::runtime_error(std::string(what) + ": " + gpgpResultString(result));
}

constexpr float kFar = 1e6f; // pixels
constexpr GpgpAccess kCopied{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                             VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
constexpr GpgpAccess kCopiedBefore{VK_PIPELINE_STAGE_2_COPY_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED};

// Handles of RmlUi's are pointers to these.
struct GeometryHandle {
  GeometryPointer geometry;
};
struct PaintHandle { // textures and shaders
  PaintPointer paint;
};
struct FilterHandle {
  FilterPointer filter;
};
template <class Handle> const Handle& get(uintptr_t handle) { return *reinterpret_cast<const Handle*>(handle); }
template <class Handle> uintptr_t give(Handle handle) {
  return reinterpret_cast<uintptr_t>(new Handle(std::move(handle)));
}
template <class Handle> void release(uintptr_t handle) { delete reinterpret_cast<Handle*>(handle); }

/// Whether contents paint with a texture that has nothing in it yet.
bool needsMore(const Contents& contents) {
  for (size_t i = 0; i < contents.count; ++i) {
    const Operation& operation = (*contents.operations)[i];
    if (operation.paint && operation.paint->texture && !operation.paint->texture->filled &&
        !operation.paint->texture->broken)
      return true;
    if (needsMore(operation.source)) return true;
    for (const FilterPointer& filter : operation.filters)
      if (needsMore(filter->mask)) return true;
  }
  return false;
}

} // namespace

struct Renderer::Impl final : Painter {
  explicit Impl(const RendererInfo& wanted);
  ~Impl() override {
    if (atlas.image) textures.destroy(atlas);
  }

  uint32_t image(const Texture& texture) override;
  GpgpResult text(List& to, const Geometry& geometry, float x, float y, const TextStyle& style) override;
  void unsupported(const char* what) override;

  void beginList();
  GpgpResult recordCanvas(VkCommandBuffer commands, const GpgpFrame& frame, uint32_t w, uint32_t h,
                          const GpgpImage* target, GpgpHistory shown);
  GpgpResult recordSaved(VkCommandBuffer commands, const GpgpFrame& frame);
  GpgpResult prepare(VkCommandBuffer commands, const GpgpFrame& frame, const GpgpImage* target);

  struct Saved {
    TexturePointer texture;
    Contents contents;
    std::array<uint32_t, 2> from{}; ///< left, top of what is saved
  };

  RendererInfo info;
  Textures textures;
  Textures::Target atlas; ///< that saved layers are drawn on
  integration::GlyphCache cache;
  Canvas canvas;
  CanvasHistory history;
  std::optional<GpgpTargetInfo> target;
  List list;
  CallRecorder recorder;
  std::vector<Saved> saved;
  uint32_t width = 0, height = 0;
  bool ready = false;
  FrameReport report;
  std::vector<std::string> named;

  // Of the list that is being written.
  std::vector<GpgpCanvasImage> images;
  std::vector<const Texture*> imageTextures; ///< null: the glyphs that are pictures
  integration::PlacedText placed;
};

Renderer::Impl::Impl(const RendererInfo& wanted) : info(wanted), textures(wanted.physicalDevice, wanted.device) {
  if (!info.context || !info.device || !info.maxWidth || !info.maxHeight)
    throw std::runtime_error("gpgp::rmlui needs a context, a device and a size");
  if (info.maxImages == 0) info.maxImages = 128;
  info.maxImages = std::min<uint32_t>(info.maxImages, GPGP_MAX_IMAGES);
  integration::GlyphCacheInfo cacheInfo;
  cacheInfo.context = info.context;
  cacheInfo.label = "rmlui";
  cacheInfo.maxGlyphs = info.glyphSetGlyphs;
  cacheInfo.maxBytes = info.glyphSetBytes;
  cacheInfo.pictureDevice.device = info.device;
  cacheInfo.pictureDevice.getDeviceProcAddr = vkGetDeviceProcAddr;
  vkGetPhysicalDeviceMemoryProperties(info.physicalDevice, &cacheInfo.pictureDevice.memory);
  cacheInfo.pictureDevice.blendSrgb = true;
  check(cache.create(cacheInfo), "gpgpCreateGlyphSet");
  Result<List> listMade = List::create(info.context);
  check(listMade.code(), "gpgpCreateList");
  list = *std::move(listMade);

  const uint64_t pixels = uint64_t{info.maxWidth} * info.maxHeight;
  auto canvasInfo = init<GpgpCanvasCreateInfo>();
  canvasInfo.base.label = "rmlui";
  canvasInfo.base.queueFamily = info.queueFamily;
  canvasInfo.maxWidth = info.maxWidth;
  canvasInfo.maxHeight = info.maxHeight;
  canvasInfo.maxShapes = info.maxShapes ? info.maxShapes : 32768;
  canvasInfo.maxGlyphs = info.maxGlyphs ? info.maxGlyphs : 16384;
  canvasInfo.maxDrawings = info.maxItems ? info.maxItems : 4096;
  canvasInfo.maxTileEntries = 1u << 18;
  canvasInfo.maxImages = info.maxImages;
  canvasInfo.maxLayerPixels = info.maxLayerPixels
                                  ? info.maxLayerPixels
                                  : static_cast<uint32_t>(std::min<uint64_t>(8 * pixels + (1u << 21), 1u << 24));
  canvasInfo.targets = GPGP_CANVAS_TARGET_RGBA8 | (info.target ? GPGP_CANVAS_TARGET_HISTORY : GpgpCanvasTargets{0});
  Result<Canvas> made = Canvas::create(info.context, canvasInfo);
  check(made.code(), "gpgpCreateCanvas");
  canvas = *std::move(made);
  auto prewarmInfo = init<GpgpPrewarmInfo>();
  if (info.target) {
    target = *info.target;
    prewarmInfo.targets = &*target;
    prewarmInfo.targetCount = 1;
    auto historyInfo = init<GpgpCanvasHistoryCreateInfo>();
    historyInfo.label = "rmlui";
    historyInfo.width = info.maxWidth;
    historyInfo.height = info.maxHeight;
    Result<CanvasHistory> historyMade = CanvasHistory::create(info.context, historyInfo);
    check(historyMade.code(), "gpgpCreateCanvasHistory");
    history = *std::move(historyMade);
  }
  check(gpgpPrewarm(canvas, &prewarmInfo), "gpgpPrewarm");
  recorder.begin();
}

void Renderer::Impl::unsupported(const char* what) {
  if (std::find(named.begin(), named.end(), what) != named.end()) return;
  named.emplace_back(what);
  Rml::Log::Message(Rml::Log::LT_WARNING, "gpgp does not draw: %s", what);
}

// ---------------------------------------------------------------- what the writer asks for

uint32_t Renderer::Impl::image(const Texture& texture) {
  const auto found = std::find(imageTextures.begin(), imageTextures.end(), &texture);
  if (found != imageTextures.end()) return static_cast<uint32_t>(found - imageTextures.begin());
  if (!texture.filled || images.size() == info.maxImages) {
    unsupported(texture.filled ? "more textures in a frame than RendererInfo::maxImages: their colours are left out"
                               : "a texture without device memory: its colours are left out");
    ++report.dropped;
    return GPGP_IMAGE_NONE;
  }
  images.push_back(textures.image(texture));
  imageTextures.push_back(&texture);
  return static_cast<uint32_t>(images.size() - 1);
}

GpgpResult Renderer::Impl::text(List& to, const Geometry& geometry, float x, float y, const TextStyle& style) {
  std::vector<GpgpTextGlyph> glyphs;
  for (size_t i = 0; i + 3 < geometry.vertices.size(); i += 4) {
    const GpgpListVertex* corners = &geometry.vertices[i];
    const MeshGlyph from = decode(corners);
    GpgpTextGlyph glyph{};
    glyph.font = info.fonts ? info.fonts->font(from.font) : nullptr;
    if (!glyph.font) continue;
    glyph.glyph = from.glyph;
    glyph.x = from.x;
    glyph.y = from.y;
    glyph.size = from.size;
    const float alpha = static_cast<float>(corners[0].color[3]) / 255;
    for (size_t c = 0; c < 3 && alpha > 0; ++c)
      glyph.color[c] = linearFromSrgb(std::min(static_cast<float>(corners[0].color[c]) / 255 / alpha, 1.0f));
    glyph.color[3] = alpha;
    glyphs.push_back(glyph);
  }
  if (glyphs.empty()) return GPGP_SUCCESS;
  const float alpha = glyphs[0].color[3];
  const bool grouped = style.stroke > 0 && alpha < 1; // the line lies on its glyph
  if (grouped) {
    if (const GpgpResult pushed = to.pushGroup(alpha); pushed < 0) return pushed;
    for (GpgpTextGlyph& glyph : glyphs) glyph.color[3] = 1;
  }
  placed.clear();
  if (style.stroke > 0) {
    const float line = 2 * style.stroke / std::max(glyphs[0].size, 1.0f);
    if (const GpgpResult stroked = cache.place(glyphs, x, y, 1, placed, line); stroked < 0) return stroked;
  }
  if (const GpgpResult filled = cache.place(glyphs, x, y, 1, placed); filled < 0) return filled;
  report.dropped += placed.dropped;
  uint32_t pictures = 0;
  if (!placed.pictures.empty()) {
    const auto found = std::find(imageTextures.begin(), imageTextures.end(), nullptr);
    pictures = static_cast<uint32_t>(found - imageTextures.begin());
    if (found == imageTextures.end() && images.size() < info.maxImages) {
      images.emplace_back(); // known after their upload
      imageTextures.push_back(nullptr);
    } else if (found == imageTextures.end()) {
      report.dropped += static_cast<uint32_t>(placed.pictures.size());
      placed.pictures.clear();
    }
  }
  const GpgpResult added = cache.addTo(to, placed, pictures, GPGP_ID_NOT_HIT);
  if (grouped && added >= 0) return to.pop();
  return added;
}

// ---------------------------------------------------------------- a frame

void Renderer::Impl::beginList() {
  list.clear();
  images.clear();
  imageTextures.clear();
}

GpgpResult Renderer::Impl::recordCanvas(VkCommandBuffer commands, const GpgpFrame& frame, uint32_t w, uint32_t h,
                                        const GpgpImage* onto, GpgpHistory shown) {
  if (const GpgpResult uploaded = gpgpRecordUpload(info.context, commands, &frame, 0, nullptr); uploaded < 0)
    return uploaded;
  if (const GpgpResult uploaded = cache.recordUpload(commands, frame); uploaded < 0) return uploaded;
  const auto pictures = std::find(imageTextures.begin(), imageTextures.end(), nullptr);
  if (pictures != imageTextures.end()) {
    const std::optional<GpgpCanvasImage> there = cache.image();
    if (!there) return GPGP_NOT_READY;
    images[static_cast<size_t>(pictures - imageTextures.begin())] = *there;
  }
  GpgpCanvasItem item = GPGP_CANVAS_ITEM_INIT;
  item.list = list;
  auto canvasInfo = init<GpgpCanvasInfo>();
  canvasInfo.width = w;
  canvasInfo.height = h;
  canvasInfo.items = &item;
  canvasInfo.itemCount = 1;
  canvasInfo.encodeSrgb = canvasInfo.blendSrgb = VK_TRUE; // RmlUi mixes colours as they are encoded
  canvasInfo.exactArea = VK_TRUE;                         // small letters want it
  canvasInfo.images = images.data();
  canvasInfo.imageCount = static_cast<uint32_t>(images.size());
  canvasInfo.history = shown;
  if (onto) canvasInfo.target = *onto;
  return canvas.recordPrepare(commands, frame, canvasInfo);
}

/// Layers that were saved as textures in this frame: side by side on an image as large as the canvas, again and again
/// until all are copied.
GpgpResult Renderer::Impl::recordSaved(VkCommandBuffer commands, const GpgpFrame& frame) {
  if (saved.empty()) return GPGP_SUCCESS;
  if (!atlas.image && !textures.makeTarget(info.maxWidth, info.maxHeight, atlas)) {
    for (const Saved& each : saved) each.texture->broken = true;
    saved.clear();
    return GPGP_SUCCESS;
  }
  while (!saved.empty()) {
    beginList();
    Writer writer(list, *this);
    uint32_t x = 0, y = 0, row = 0;
    std::vector<std::array<uint32_t, 2>> places;
    for (const Saved& each : saved) {
      const Texture& texture = *each.texture;
      if (!places.empty() && needsMore(each.contents)) break;
      if (x + texture.width > info.maxWidth) {
        x = 0;
        y += row;
        row = 0;
      }
      if (y + texture.height > info.maxHeight) break; // none is larger than the canvas: SaveLayerAsTexture sees to it
      const auto offset = [](uint32_t to, uint32_t from) { return static_cast<float>(to) - static_cast<float>(from); };
      const float move[6] = {1, 0, 0, 1, offset(x, each.from[0]), offset(y, each.from[1])};
      if (const GpgpResult pushed = list.pushTransform(move); pushed < 0) return pushed;
      const auto left = static_cast<float>(each.from[0]), top = static_cast<float>(each.from[1]);
      const GpgpResult written = writer.write(each.contents, {left, top, left + static_cast<float>(texture.width),
                                                              top + static_cast<float>(texture.height)});
      if (written < 0) return written;
      if (const GpgpResult popped = list.pop(); popped < 0) return popped;
      places.push_back({x, y});
      x += texture.width;
      row = std::max(row, texture.height);
    }
    const GpgpImage image{atlas.image,   atlas.view, VK_FORMAT_R8G8B8A8_UNORM, 0, 0, info.maxWidth, info.maxHeight,
                          kCopiedBefore, kCopied};
    const GpgpResult recorded =
        recordCanvas(commands, frame, info.maxWidth, std::min(y + row, info.maxHeight), &image, nullptr);
    if (recorded != GPGP_SUCCESS) return recorded;
    for (size_t i = 0; i < places.size(); ++i)
      if (textures.recordCopy(commands, atlas.image, places[i][0], places[i][1], *saved[i].texture)) ++report.saved;
    saved.erase(saved.begin(), saved.begin() + static_cast<std::ptrdiff_t>(places.size()));
  }
  return GPGP_SUCCESS;
}

GpgpResult Renderer::Impl::prepare(VkCommandBuffer commands, const GpgpFrame& frame, const GpgpImage* onto) {
  ready = false;
  report = {};
  if (width == 0 || height == 0 || width > info.maxWidth || height > info.maxHeight) return GPGP_ERROR_INVALID_ARGUMENT;
  textures.advance(frame);
  if (!textures.recordUpload(commands, report.uploaded)) unsupported("textures for which there is no device memory");
  if (const GpgpResult done = recordSaved(commands, frame); done != GPGP_SUCCESS) return done;
  beginList();
  Writer writer(list, *this);
  const Box all{0, 0, static_cast<float>(width), static_cast<float>(height)};
  if (const GpgpResult written = writer.write(recorder.base(), all); written < 0) return written;
  report.images = static_cast<uint32_t>(images.size());
  const GpgpResult recorded = recordCanvas(commands, frame, width, height, onto, history);
  ready = recorded == GPGP_SUCCESS;
  return recorded;
}

Renderer::Renderer(const RendererInfo& info) : impl_(std::make_unique<Impl>(info)) {}
Renderer::~Renderer() = default;

void Renderer::beginFrame(uint32_t width, uint32_t height) {
  impl_->width = width;
  impl_->height = height;
  impl_->recorder.begin();
}

GpgpResult Renderer::prepare(VkCommandBuffer commands, const GpgpFrame& frame, const GpgpImage* image) {
  return impl_->prepare(commands, frame, image);
}

GpgpResult Renderer::draw(VkCommandBuffer commands, const GpgpFrame& frame) {
  Impl& i = *impl_;
  if (!i.target) return GPGP_ERROR_INVALID_ARGUMENT;
  if (!i.ready) return GPGP_NOT_READY;
  auto info = init<GpgpCanvasDrawInfo>();
  info.history = i.history;
  info.target = &*i.target;
  info.width = i.width;
  info.height = i.height;
  info.clip[0] = 2 / static_cast<float>(i.width);
  info.clip[5] = 2 / static_cast<float>(i.height);
  info.clip[12] = info.clip[13] = -1;
  info.clip[10] = info.clip[15] = 1;
  return i.canvas.recordDraw(commands, frame, info);
}

const FrameReport& Renderer::report() const { return impl_->report; }
const std::vector<std::string>& Renderer::unsupported() const { return impl_->named; }
GpgpRecorder Renderer::canvas() const { return impl_->canvas; }

// ---------------------------------------------------------------- RmlUi's calls

Rml::CompiledGeometryHandle Renderer::CompileGeometry(Rml::Span<const Rml::Vertex> vertices,
                                                      Rml::Span<const int> indices) {
  auto made = std::make_shared<Geometry>();
  made->vertices.reserve(vertices.size());
  for (const Rml::Vertex& v : vertices)
    made->vertices.push_back({v.position.x,
                              v.position.y,
                              {v.colour.red, v.colour.green, v.colour.blue, v.colour.alpha},
                              v.tex_coord.x,
                              v.tex_coord.y});
  // Triangles without a place, as RmlUi makes of boxes that have no size, show nothing on a GPU either.
  std::vector<bool> placed;
  for (GpgpListVertex& v : made->vertices) {
    placed.push_back(std::abs(v.x) < kFar && std::abs(v.y) < kFar && std::abs(v.u) < kFar && std::abs(v.v) < kFar);
    if (!placed.back()) v.x = v.y = v.u = v.v = 0;
  }
  for (size_t i = 0; i + 2 < indices.size(); i += 3)
    if (std::all_of(&indices[i], &indices[i] + 3, [&](int index) { return placed[static_cast<size_t>(index)]; }))
      made->indices.insert(made->indices.end(), &indices[i], &indices[i] + 3);
  made->shape = findShape(made->vertices, made->indices);
  return give(GeometryHandle{std::move(made)});
}

void Renderer::RenderGeometry(Rml::CompiledGeometryHandle geometry, Rml::Vector2f translation,
                              Rml::TextureHandle texture) {
  impl_->recorder.draw(get<GeometryHandle>(geometry).geometry, translation.x, translation.y,
                       texture ? get<PaintHandle>(texture).paint : nullptr);
}

void Renderer::ReleaseGeometry(Rml::CompiledGeometryHandle geometry) { release<GeometryHandle>(geometry); }

Rml::TextureHandle Renderer::LoadTexture(Rml::Vector2i& size, const Rml::String& source) {
  if (const std::optional<TextStyle> style = textStyleOf(source)) {
    size = {1, 1};
    auto paint = std::make_shared<Paint>();
    paint->kind = Paint::Kind::text;
    paint->text = *style;
    return give(PaintHandle{std::move(paint)});
  }
  if (impl_->info.loadDrawing)
    if (Drawing drawing = impl_->info.loadDrawing(source)) {
      GpgpDrawingInfo page = GPGP_DRAWING_INFO_INIT;
      if (gpgpGetDrawingInfo(drawing, &page) < 0 || !(page.viewport[2] > 0 && page.viewport[3] > 0)) return 0;
      size = {std::max(1, static_cast<int>(std::lround(page.viewport[2]))),
              std::max(1, static_cast<int>(std::lround(page.viewport[3])))};
      auto paint = std::make_shared<Paint>();
      paint->kind = Paint::Kind::drawing;
      paint->drawing = std::move(drawing);
      return give(PaintHandle{std::move(paint)});
    }
  DecodedImage image;
  if (!impl_->info.loadImage || !impl_->info.loadImage(source, image)) return 0;
  size = {static_cast<int>(image.width), static_cast<int>(image.height)};
  return GenerateTexture({image.pixels.data(), image.pixels.size()}, size);
}

Rml::TextureHandle Renderer::GenerateTexture(Rml::Span<const Rml::byte> source, Rml::Vector2i size) {
  if (size.x <= 0 || size.y <= 0 || source.size() != size_t(size.x) * size_t(size.y) * 4) return 0;
  auto paint = std::make_shared<Paint>();
  paint->texture = impl_->textures.make(static_cast<uint32_t>(size.x), static_cast<uint32_t>(size.y),
                                        {source.begin(), source.end()});
  return give(PaintHandle{std::move(paint)});
}

void Renderer::ReleaseTexture(Rml::TextureHandle texture) { release<PaintHandle>(texture); }

void Renderer::EnableScissorRegion(bool enable) {
  if (!enable) impl_->recorder.setScissor(std::nullopt); // enabled: the region follows
}

void Renderer::SetScissorRegion(Rml::Rectanglei region) {
  impl_->recorder.setScissor(Box{static_cast<float>(region.Left()), static_cast<float>(region.Top()),
                                 static_cast<float>(region.Right()), static_cast<float>(region.Bottom())});
}

void Renderer::EnableClipMask(bool enable) { impl_->recorder.enableClip(enable); }

void Renderer::RenderToClipMask(Rml::ClipMaskOperation operation, Rml::CompiledGeometryHandle geometry,
                                Rml::Vector2f translation) {
  const ClipOperation kind = operation == Rml::ClipMaskOperation::Set          ? ClipOperation::set
                             : operation == Rml::ClipMaskOperation::SetInverse ? ClipOperation::setInverse
                                                                               : ClipOperation::intersect;
  impl_->recorder.clip(kind, get<GeometryHandle>(geometry).geometry, translation.x, translation.y);
}

void Renderer::SetTransform(const Rml::Matrix4f* matrix) {
  if (!matrix) return impl_->recorder.setTransform(nullptr);
  const Rml::Vector4f x = *matrix * Rml::Vector4f(1, 0, 0, 0), y = *matrix * Rml::Vector4f(0, 1, 0, 0),
                      origin = *matrix * Rml::Vector4f(0, 0, 0, 1);
  Transform transform{{x.x, x.y, y.x, y.y, origin.x, origin.y}, {x.w, y.w, origin.w}};
  const auto finite = [](float v) { return std::isfinite(v); };
  if (!std::all_of(transform.map.begin(), transform.map.end(), finite) ||
      !std::all_of(transform.perspective.begin(), transform.perspective.end(), finite)) {
    impl_->unsupported("transforms that are not finite: nothing shows under them");
    transform = {{0, 0, 0, 0, 0, 0}, {0, 0, 1}};
  }
  impl_->recorder.setTransform(&transform);
}

Rml::LayerHandle Renderer::PushLayer() { return static_cast<Rml::LayerHandle>(impl_->recorder.pushLayer()); }

void Renderer::CompositeLayers(Rml::LayerHandle source, Rml::LayerHandle destination, Rml::BlendMode blend,
                               Rml::Span<const Rml::CompiledFilterHandle> filters) {
  std::vector<FilterPointer> taken;
  for (const Rml::CompiledFilterHandle filter : filters)
    if (filter) taken.push_back(get<FilterHandle>(filter).filter);
  if (!impl_->recorder.composite(source, destination, blend == Rml::BlendMode::Replace, std::move(taken)))
    impl_->unsupported("a layer that replaces what lies below under a clip mask");
}

void Renderer::PopLayer() { impl_->recorder.popLayer(); }

Rml::TextureHandle Renderer::SaveLayerAsTexture() {
  const std::optional<Box>& scissor = impl_->recorder.state().scissor;
  if (!scissor || empty(*scissor)) return 0;
  const auto at = [&](size_t i) { return static_cast<uint32_t>(std::max((*scissor)[i], 0.0f)); };
  if (at(2) - at(0) > impl_->info.maxWidth || at(3) - at(1) > impl_->info.maxHeight) return 0;
  auto paint = std::make_shared<Paint>();
  paint->texture = impl_->textures.make(at(2) - at(0), at(3) - at(1), {});
  impl_->saved.push_back({paint->texture, impl_->recorder.top(), {at(0), at(1)}});
  return give(PaintHandle{std::move(paint)});
}

Rml::CompiledFilterHandle Renderer::SaveLayerAsMaskImage() {
  auto filter = std::make_shared<Filter>();
  filter->kind = Filter::Kind::mask;
  filter->mask = impl_->recorder.top();
  return give(FilterHandle{std::move(filter)});
}

Rml::CompiledFilterHandle Renderer::CompileFilter(const Rml::String& name, const Rml::Dictionary& parameters) {
  FilterPointer made = makeFilter(name, parameters);
  if (made) return give(FilterHandle{std::move(made)});
  impl_->unsupported(("the filter " + name).c_str());
  return 0;
}

void Renderer::ReleaseFilter(Rml::CompiledFilterHandle filter) { release<FilterHandle>(filter); }

Rml::CompiledShaderHandle Renderer::CompileShader(const Rml::String& name, const Rml::Dictionary& parameters) {
  PaintPointer made = makeGradient(name, parameters);
  if (made) return give(PaintHandle{std::move(made)});
  impl_->unsupported(("the shader " + name + "(\"" + Rml::Get(parameters, "value", Rml::String()) + "\")").c_str());
  return 0;
}

void Renderer::RenderShader(Rml::CompiledShaderHandle shader, Rml::CompiledGeometryHandle geometry,
                            Rml::Vector2f translation, Rml::TextureHandle) {
  impl_->recorder.draw(get<GeometryHandle>(geometry).geometry, translation.x, translation.y,
                       get<PaintHandle>(shader).paint);
}

void Renderer::ReleaseShader(Rml::CompiledShaderHandle shader) { release<PaintHandle>(shader); }

} // namespace gpgp::rmlui
