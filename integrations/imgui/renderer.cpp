// ImGui's draw data to a canvas: textures, fonts, widgets, and the list that writer.cpp makes.
#include "fonts.h"
#include "gpgp_glyph_cache.hpp"
#include "gpgp_imgui.hpp"
#include "gpgp_textures.hpp"
#include "writer.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>

namespace gpgp::imgui {
namespace {

constexpr uint32_t kMaxSide = 16384;
constexpr size_t kMaxShapes = 1024; // of a frame: pictures, underlines and strikes

void check(GpgpResult result, const char* what) {
  if (result < 0) throw std::runtime_error(std::string(what) + ": " + gpgpResultString(result));
}

RendererInfo checked(const RendererInfo& info) {
  if (!info.context || !info.device || !info.target || !info.maxWidth || !info.maxHeight)
    throw std::runtime_error("gpgp::imgui needs a context, a device, a target and a size");
  RendererInfo taken = info;
  taken.maxTextures = std::clamp<uint32_t>(info.maxTextures, 1, GPGP_MAX_IMAGES - 1); // and the glyphs' pictures
  return taken;
}

/// Never to be called: the writer knows a widget by it.
void widgetCallback(const ImDrawList*, const ImDrawCmd*) {}

} // namespace

struct Renderer::Impl final : Painter {
  explicit Impl(const RendererInfo& wanted);
  void makeCanvas(const RendererInfo& wanted);
  Widget& widget(ImDrawList& list, const ImVec2& position);
  void beginFrame();
  GpgpResult prepare(ImDrawData& data, VkCommandBuffer commands, const GpgpFrame& frame);

  GpgpResult texture(ImTextureID id, bool used, TextureUse& use) override;
  GpgpResult text(std::span<const GpgpTextGlyph> glyphs, std::span<const GpgpTextDecoration> lines) override;

  /// ImTextureIDs are the number of an entry and how often it was given away.
  struct Entry {
    uint32_t generation = 0;
    bool taken = false;
    GpgpCanvasImage image{};
    integration::TexturePointer font; ///< in place of the image
    const ImFontAtlas* atlas = nullptr;
    std::optional<ImVec2> white;
    uint32_t use = GPGP_IMAGE_NONE; ///< among `images`, in the recording at hand
  };
  Entry& newEntry(ImTextureID& id);
  Entry* find(ImTextureID id);

  RendererInfo info;
  GpgpTargetInfo target{};
  integration::Textures uploads;
  std::vector<Entry> textures;
  FontBuilder builder;
  ImFontAtlas* atlas = nullptr;
  integration::GlyphCache cache;
  Canvas canvas;
  CanvasHistory history;
  std::deque<Widget> widgets; // stay where they are: draw lists point to them
  FrameReport report;
  std::string error;
  int frameCount = -1; // ImGui's frame that widgets belong to
  bool ready = false;  // the history shows what was prepared last
  VkExtent2D screen{};

  // Of the list that is being written.
  List list;
  std::vector<GpgpCanvasImage> images;
  std::vector<const Entry*> fontImages; // null: another's
  uint32_t pictures = GPGP_IMAGE_NONE;  // the image of glyphs that are pictures
  size_t shapes = 0;                    // pictures and lines
  uint32_t lostGlyphs = 0;
  integration::PlacedText placed;
};

Renderer::Impl::Impl(const RendererInfo& wanted)
    : info(checked(wanted)), target(*wanted.target), uploads(wanted.physicalDevice, wanted.device) {
  integration::GlyphCacheInfo cacheInfo;
  cacheInfo.context = info.context;
  cacheInfo.label = "imgui";
  cacheInfo.maxGlyphs = info.glyphSetGlyphs;
  cacheInfo.maxBytes = info.glyphSetBytes;
  cacheInfo.maxPictures = info.maxPictures;
  cacheInfo.pictureDevice.device = info.device;
  cacheInfo.pictureDevice.getDeviceProcAddr = vkGetDeviceProcAddr;
  vkGetPhysicalDeviceMemoryProperties(info.physicalDevice, &cacheInfo.pictureDevice.memory);
  cacheInfo.pictureDevice.blendSrgb = !info.srgbTarget; // as the canvas does
  check(cache.create(cacheInfo), "gpgpCreateGlyphSet");
  Result<List> listMade = List::create(info.context);
  check(listMade.code(), "gpgpCreateList");
  list = *std::move(listMade);
  makeCanvas(info);
  if (ImGui::GetCurrentContext()) {
    ImGui::GetIO().BackendRendererName = "gpgp";
    ImGui::GetIO().BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  }
  builder.onClose = [this](GpgpFont font) { cache.forget(font); };
}

/// With the history that it is rasterised into. Where it throws all is as it was.
void Renderer::Impl::makeCanvas(const RendererInfo& wanted) {
  if (wanted.maxWidth > kMaxSide || wanted.maxHeight > kMaxSide)
    throw std::runtime_error("maxWidth or maxHeight is beyond the " + std::to_string(kMaxSide) + " pixels of canvases");
  auto historyInfo = init<GpgpCanvasHistoryCreateInfo>();
  historyInfo.label = "imgui";
  historyInfo.width = wanted.maxWidth;
  historyInfo.height = wanted.maxHeight;
  Result<CanvasHistory> historyMade = CanvasHistory::create(wanted.context, historyInfo);
  check(historyMade.code(), "gpgpCreateCanvasHistory");
  auto canvasInfo = init<GpgpCanvasCreateInfo>();
  canvasInfo.base.label = "imgui";
  canvasInfo.base.queueFamily = wanted.queueFamily;
  canvasInfo.maxWidth = wanted.maxWidth;
  canvasInfo.maxHeight = wanted.maxHeight;
  canvasInfo.maxGlyphs = wanted.maxGlyphs;
  canvasInfo.maxShapes = wanted.maxTriangles + static_cast<uint32_t>(kMaxShapes);
  canvasInfo.maxTileEntries = wanted.maxTileEntries;
  canvasInfo.maxDrawings = wanted.maxItems;
  canvasInfo.maxImages = wanted.maxTextures + 1;
  canvasInfo.targets = GPGP_CANVAS_TARGET_HISTORY;
  Result<Canvas> made = Canvas::create(wanted.context, canvasInfo);
  check(made.code(), "gpgpCreateCanvas");
  auto prewarmInfo = init<GpgpPrewarmInfo>();
  prewarmInfo.targets = &target;
  prewarmInfo.targetCount = 1;
  check(gpgpPrewarm(*made, &prewarmInfo), "gpgpPrewarm");
  canvas = *std::move(made);
  history = *std::move(historyMade);
  info.maxWidth = wanted.maxWidth;
  info.maxHeight = wanted.maxHeight;
}

// ---------------------------------------------------------------- textures

Renderer::Impl::Entry& Renderer::Impl::newEntry(ImTextureID& id) {
  auto at = std::find_if(textures.begin(), textures.end(), [](const Entry& entry) { return !entry.taken; });
  if (at == textures.end()) at = textures.emplace(textures.end());
  const uint32_t generation = at->generation % 0x7fff + 1;
  *at = {};
  at->generation = generation;
  at->taken = true;
  id = reinterpret_cast<ImTextureID>(uintptr_t{generation} << 16 | static_cast<uintptr_t>(at - textures.begin()));
  return *at;
}

Renderer::Impl::Entry* Renderer::Impl::find(ImTextureID id) {
  const auto value = reinterpret_cast<uintptr_t>(id);
  const size_t number = value & 0xffff;
  if (number >= textures.size() || !textures[number].taken || textures[number].generation != value >> 16)
    return nullptr;
  return &textures[number];
}

GpgpResult Renderer::Impl::texture(ImTextureID id, bool used, TextureUse& use) {
  Entry* entry = find(id);
  if (!entry) return GPGP_ERROR_INVALID_HANDLE;
  if (used && entry->use == GPGP_IMAGE_NONE) {
    if (images.size() - (pictures == GPGP_IMAGE_NONE ? 0 : 1) == info.maxTextures) return GPGP_ERROR_INVALID_ARGUMENT;
    entry->use = static_cast<uint32_t>(images.size());
    images.push_back(entry->image);
    fontImages.push_back(entry->font ? entry : nullptr);
  }
  use = {entry->use, entry->white};
  return GPGP_SUCCESS;
}

GpgpResult Renderer::Impl::text(std::span<const GpgpTextGlyph> glyphs, std::span<const GpgpTextDecoration> lines) {
  placed.clear();
  placed.decorate(lines, 0, 0, 1);
  if (const GpgpResult found = cache.place(glyphs, 0, 0, 1, placed); found < 0) return found;
  lostGlyphs += placed.dropped;
  const auto keep = [&](auto& all) {
    const size_t room = std::min(all.size(), kMaxShapes - shapes), beyond = all.size() - room;
    all.resize(room);
    shapes += room;
    return static_cast<uint32_t>(beyond);
  };
  report.dropped += keep(placed.lines);
  lostGlyphs += keep(placed.pictures);
  if (!placed.pictures.empty() && pictures == GPGP_IMAGE_NONE) {
    pictures = static_cast<uint32_t>(images.size());
    images.emplace_back(); // known after their upload
    fontImages.push_back(nullptr);
  }
  return cache.addTo(list, placed, placed.pictures.empty() ? 0 : pictures, GPGP_ID_NOT_HIT);
}

ImTextureID Renderer::addTexture(const GpgpCanvasImage& image) {
  if (!image.view || !image.sampler || impl_->textures.size() == 0x10000) return nullptr;
  ImTextureID id = nullptr;
  impl_->newEntry(id).image = image;
  return id;
}

GpgpResult Renderer::removeTexture(ImTextureID texture) {
  Impl::Entry* entry = impl_->find(texture);
  if (!entry) return GPGP_ERROR_INVALID_HANDLE;
  *entry = {entry->generation};
  return GPGP_SUCCESS;
}

void Renderer::createFontTexture(ImFontAtlas& atlas) {
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
  if (!pixels || width <= 0 || height <= 0) throw std::runtime_error("ImGui's font atlas could not be built");
  for (Impl::Entry& old : impl_->textures) // ImGui has forgotten its ID where fonts were added
    if (old.taken && old.atlas == &atlas) old = {old.generation};
  std::vector<uint8_t> premultiplied(pixels, pixels + size_t(width) * size_t(height) * 4);
  for (size_t i = 0; i < premultiplied.size(); i += 4)
    for (size_t c = 0; c < 3; ++c)
      premultiplied[i + c] = static_cast<uint8_t>((premultiplied[i + c] * premultiplied[i + 3] + 127) / 255);
  ImTextureID id = nullptr;
  Impl::Entry& entry = impl_->newEntry(id);
  entry.font =
      impl_->uploads.make(static_cast<uint32_t>(width), static_cast<uint32_t>(height), std::move(premultiplied));
  entry.atlas = &atlas;
  entry.white = atlas.TexUvWhitePixel;
  atlas.SetTexID(id);
}

// ---------------------------------------------------------------- widgets

void Renderer::Impl::beginFrame() {
  if (frameCount == ImGui::GetFrameCount()) return;
  widgets.clear();
  frameCount = ImGui::GetFrameCount();
}

Widget& Renderer::Impl::widget(ImDrawList& drawList, const ImVec2& position) {
  beginFrame();
  Widget& made = widgets.emplace_back();
  made.owner = this;
  made.position = position;
  drawList.AddCallback(widgetCallback, &made);
  return made;
}

Renderer::Renderer(const RendererInfo& info) : impl_(std::make_unique<Impl>(info)) {}
Renderer::~Renderer() = default;

void Renderer::useFonts(ImFontAtlas& atlas) {
  atlas.FontBuilderIO = &impl_->builder;
  impl_->atlas = &atlas;
}

void Renderer::drawing(GpgpAsset asset, const ImVec2& size) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::Dummy(size);
  if (ImGui::IsItemVisible()) addDrawing(*ImGui::GetWindowDrawList(), asset, at, {at.x + size.x, at.y + size.y});
}

void Renderer::text(GpgpLayout layout) {
  GpgpLayoutInfo info = GPGP_LAYOUT_INFO_INIT;
  if (gpgpGetLayoutInfo(layout, &info) < 0) return;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::Dummy({std::max(integration::linesBox(info)[2], 0.0f), info.height});
  if (ImGui::IsItemVisible()) addText(*ImGui::GetWindowDrawList(), layout, at);
}

void Renderer::addDrawing(ImDrawList& list, GpgpAsset asset, const ImVec2& min, const ImVec2& max) {
  if (!asset || max.x <= min.x || max.y <= min.y) return;
  Widget& widget = impl_->widget(list, min);
  widget.drawing = asset;
  widget.size = {max.x - min.x, max.y - min.y};
}

void Renderer::addText(ImDrawList& list, GpgpLayout layout, const ImVec2& position) {
  GpgpLayoutInfo info = GPGP_LAYOUT_INFO_INIT;
  if (gpgpGetLayoutInfo(layout, &info) < 0 || info.glyphCount + info.decorationCount == 0) return;
  Widget& widget = impl_->widget(list, position);
  widget.glyphs.assign(info.glyphs, info.glyphs + info.glyphCount);
  widget.lines.assign(info.decorations, info.decorations + info.decorationCount);
}

// ---------------------------------------------------------------- a frame

GpgpResult Renderer::Impl::prepare(ImDrawData& data, VkCommandBuffer commands, const GpgpFrame& frame) {
  beginFrame();
  ready = false;
  report = {};
  error.clear();
  screen = {static_cast<uint32_t>(std::max(data.DisplaySize.x * data.FramebufferScale.x, 0.0f)),
            static_cast<uint32_t>(std::max(data.DisplaySize.y * data.FramebufferScale.y, 0.0f))};
  if (screen.width > info.maxWidth || screen.height > info.maxHeight) {
    error = "the framebuffer of " + std::to_string(screen.width) + " x " + std::to_string(screen.height) +
            " pixels is larger than RendererInfo::maxWidth and maxHeight";
    return GPGP_ERROR_INVALID_ARGUMENT;
  }
  if (screen.width == 0 || screen.height == 0) return GPGP_SUCCESS; // minimised
  if (const GpgpResult cleared = list.clear(); cleared < 0) return cleared;
  images.clear();
  fontImages.clear();
  pictures = GPGP_IMAGE_NONE;
  shapes = 0;
  lostGlyphs = 0;
  for (Entry& entry : textures) entry.use = GPGP_IMAGE_NONE;

  WriterInfo wanted;
  wanted.callback = widgetCallback;
  wanted.owner = this;
  wanted.glyphs = &builder.glyphs;
  wanted.atlasTexture = atlas ? atlas->TexID : nullptr;
  wanted.srgbTarget = info.srgbTarget;
  wanted.maxTriangles = info.maxTriangles;
  wanted.maxGlyphs = info.maxGlyphs;
  Written written;
  const GpgpResult wrote = writeList(data, wanted, *this, list, written);
  error = written.error;
  if (wrote < 0) {
    report = {};
    return wrote;
  }
  report.triangles = written.triangles;
  report.glyphs = written.glyphs - lostGlyphs;
  report.widgets = written.widgets;
  report.textures = static_cast<uint32_t>(images.size()) - (pictures == GPGP_IMAGE_NONE ? 0 : 1);
  report.dropped += written.dropped + lostGlyphs;

  if (const GpgpResult uploaded = gpgpRecordUpload(info.context, commands, &frame, 0, nullptr); uploaded < 0)
    return uploaded;
  if (const GpgpResult uploaded = cache.recordUpload(commands, frame); uploaded < 0) return uploaded;
  uploads.advance(frame);
  uint32_t count = 0;
  if (!uploads.recordUpload(commands, count)) {
    error = "there is no device memory for the font atlas";
    return GPGP_ERROR_OUT_OF_DEVICE_MEMORY;
  }
  for (size_t i = 0; i < images.size(); ++i)
    if (fontImages[i] && fontImages[i]->font->broken) {
      error = "there is no device memory for the font atlas";
      return GPGP_ERROR_OUT_OF_DEVICE_MEMORY;
    } else if (fontImages[i]) {
      images[i] = uploads.image(*fontImages[i]->font, info.srgbTarget ? GPGP_IMAGE_LINEAR : GPGP_IMAGE_SRGB);
    }
  if (pictures != GPGP_IMAGE_NONE) {
    const std::optional<GpgpCanvasImage> there = cache.image();
    if (!there) return GPGP_NOT_READY;
    images[pictures] = *there;
  }

  GpgpCanvasItem item = GPGP_CANVAS_ITEM_INIT;
  item.list = list;
  auto canvasInfo = init<GpgpCanvasInfo>();
  canvasInfo.width = screen.width;
  canvasInfo.height = screen.height;
  canvasInfo.items = &item;
  canvasInfo.itemCount = 1;
  canvasInfo.samples = info.samples;
  canvasInfo.blendSrgb = info.srgbTarget ? VK_FALSE : VK_TRUE;  // ImGui mixes colours as they are stored
  canvasInfo.exactArea = info.samples > 1 ? VK_TRUE : VK_FALSE; // small letters want it
  canvasInfo.images = images.data();
  canvasInfo.imageCount = static_cast<uint32_t>(images.size());
  canvasInfo.history = history;
  const GpgpResult result = canvas.recordPrepare(commands, frame, canvasInfo);
  ready = result == GPGP_SUCCESS;
  return result;
}

GpgpResult Renderer::prepare(ImDrawData& data, VkCommandBuffer commands, const GpgpFrame& frame) {
  return impl_->prepare(data, commands, frame);
}

GpgpResult Renderer::draw(VkCommandBuffer commands, const GpgpFrame& frame) {
  const Impl& i = *impl_;
  if (!i.ready) return GPGP_NOT_READY;
  const auto width = static_cast<float>(i.screen.width), height = static_cast<float>(i.screen.height);
  const VkViewport viewport{0, 0, width, height, 0, 1};
  const VkRect2D scissor{{0, 0}, i.screen};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &scissor);
  auto info = init<GpgpCanvasDrawInfo>();
  info.history = i.history;
  info.target = &i.target;
  info.width = i.screen.width;
  info.height = i.screen.height;
  info.clip[0] = 2 / width;
  info.clip[5] = 2 / height;
  info.clip[10] = info.clip[15] = 1;
  info.clip[12] = info.clip[13] = -1;
  info.encodeSrgb = i.info.srgbTarget ? VK_FALSE : VK_TRUE;
  return impl_->canvas.recordDraw(commands, frame, info);
}

void Renderer::resize(uint32_t width, uint32_t height) {
  RendererInfo wanted = impl_->info;
  if (width <= wanted.maxWidth && height <= wanted.maxHeight) return;
  wanted.maxWidth = std::max(width, wanted.maxWidth);
  wanted.maxHeight = std::max(height, wanted.maxHeight);
  impl_->makeCanvas(wanted);
  impl_->ready = false;
}

const FrameReport& Renderer::report() const { return impl_->report; }
const std::string& Renderer::error() const { return impl_->error; }
GpgpRecorder Renderer::canvas() const { return impl_->canvas; }

void Renderer::forget(GpgpFont font) { impl_->cache.forget(font); }

} // namespace gpgp::imgui
