// The canvas of a frame's text and widgets, and the callbacks that draw it.
#include "fonts.h"
#include "gpgp_glyph_cache.hpp"
#include "gpgp_imgui.hpp"
#include "layers.h"
#include "pieces.h"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <string>

namespace gpgp::imgui {
namespace {

constexpr size_t kMaxShapes = 1024; // of a frame: pictures, underlines and strikes

void check(GpgpResult result, const char* what) {
  if (result < 0) throw std::runtime_error(std::string(what) + ": " + gpgpResultString(result));
}

RendererInfo checked(const RendererInfo& info) {
  if (!info.context || !info.device || !info.renderPass || !info.maxWidth || !info.maxHeight || !info.maxLayers)
    throw std::runtime_error("gpgp::imgui needs a context, a device, a render pass and a size");
  return info;
}

} // namespace

struct Renderer::Impl {
  explicit Impl(const RendererInfo& wanted);
  void makeCanvas(const RendererInfo& wanted);
  Piece& widget(ImDrawList& list, const ImVec2& position);
  void beginFrame();
  const float* boxOf(GpgpFont font, uint32_t glyph);
  GpgpResult prepare(ImDrawData& data, VkCommandBuffer commands, const GpgpFrame& frame);
  static void onDraw(const ImDrawList* list, const ImDrawCmd* command);
  void draw(const Piece& piece) const;

  RendererInfo info;
  FontBuilder builder;
  ImFontAtlas* atlas = nullptr;
  integration::GlyphCache cache;
  Canvas canvas;
  Pieces pieces;
  FrameReport report;
  std::map<std::pair<GpgpFont, uint32_t>, std::array<float, 4>> boxes; // of glyphs in layouts
  int frameCount = -1;                                                 // ImGui's frame that pieces belong to
  bool collected = false;                                              // they have been taken out of its draw data
  bool ready = false;                                                  // the canvas shows them
  VkCommandBuffer target = VK_NULL_HANDLE;
  VkExtent2D screen{};
  integration::PlacedText text; // in the canvas
  List textList;                // that shows it
  std::vector<GpgpCanvasItem> items;
  std::unique_ptr<Layers> layers;
};

Renderer::Impl::Impl(const RendererInfo& wanted) : info(checked(wanted)) {
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
  textList = *std::move(listMade);
  makeCanvas(wanted);
  builder.onClose = [this](GpgpFont font) { cache.forget(font); };
}

/// With the image that it is rasterised into. Where it throws all is as it was.
void Renderer::Impl::makeCanvas(const RendererInfo& wanted) {
  auto newLayers = std::make_unique<Layers>(wanted);
  auto canvasInfo = init<GpgpCanvasCreateInfo>();
  canvasInfo.base.label = "imgui";
  canvasInfo.base.queueFamily = wanted.queueFamily;
  canvasInfo.maxWidth = wanted.maxWidth;
  canvasInfo.maxHeight = newLayers->height();
  canvasInfo.maxGlyphs = wanted.maxGlyphs;
  canvasInfo.maxShapes = kMaxShapes;
  canvasInfo.targets = wanted.srgbTarget ? GPGP_CANVAS_TARGET_RGBA16F : GPGP_CANVAS_TARGET_RGBA8; // as Layers::format
  canvasInfo.maxDrawings = wanted.maxDrawings + 2; // and one item for all glyphs, one for all pictures among them
  Result<Canvas> made = Canvas::create(wanted.context, canvasInfo);
  check(made.code(), "gpgpCreateCanvas");
  check(made->prewarm(), "gpgpPrewarm");
  canvas = *std::move(made);
  layers = std::move(newLayers);
  info = wanted;
}

// ---------------------------------------------------------------- widgets

void Renderer::Impl::beginFrame() {
  if (frameCount == ImGui::GetFrameCount()) return;
  pieces.clear();
  frameCount = ImGui::GetFrameCount();
  collected = ready = false;
}

Piece& Renderer::Impl::widget(ImDrawList& list, const ImVec2& position) {
  Piece& piece = pieces.all.emplace_back();
  piece.owner = this;
  piece.position = position;
  list.AddCallback(onDraw, &piece);
  return piece;
}

/// Of a glyph's ink, in em.
const float* Renderer::Impl::boxOf(GpgpFont font, uint32_t glyph) {
  const auto [at, isNew] = boxes.try_emplace({font, glyph});
  if (isNew) at->second = integration::inkBox(font, glyph);
  return at->second.data();
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
  impl_->beginFrame();
  Piece& piece = impl_->widget(list, min);
  piece.drawing = asset;
  piece.size = {max.x - min.x, max.y - min.y};
}

void Renderer::addText(ImDrawList& list, GpgpLayout layout, const ImVec2& position) {
  GpgpLayoutInfo info = GPGP_LAYOUT_INFO_INIT;
  if (gpgpGetLayoutInfo(layout, &info) < 0) return;
  impl_->beginFrame();
  std::vector<GpgpTextGlyph>& glyphs = impl_->pieces.glyphs;
  std::vector<GpgpTextDecoration>& lines = impl_->pieces.lines;
  const size_t first = glyphs.size(), firstLine = lines.size();
  float ink[4] = {1e9f, 1e9f, -1e9f, -1e9f};
  const auto take = [&ink](float left, float top, float right, float bottom) {
    ink[0] = std::min(ink[0], left);
    ink[1] = std::min(ink[1], top);
    ink[2] = std::max(ink[2], right);
    ink[3] = std::max(ink[3], bottom);
  };
  lines.insert(lines.end(), info.decorations, info.decorations + info.decorationCount);
  for (size_t i = firstLine; i < lines.size(); ++i) {
    const GpgpTextRect& line = lines[i].rect;
    take(line.x, line.y, line.x + line.width, line.y + line.height);
  }
  for (uint32_t i = 0; i < info.glyphCount; ++i) {
    const GpgpTextGlyph& from = info.glyphs[i];
    const float* box = impl_->boxOf(from.font, from.glyph);
    if (box[0] >= box[2]) continue; // a blank
    if (glyphs.size() == impl_->info.maxGlyphs) {
      ++impl_->pieces.dropped;
      continue;
    }
    glyphs.push_back(from);
    take(from.x + box[0] * from.size, from.y + box[1] * from.size, from.x + box[2] * from.size,
         from.y + box[3] * from.size);
  }
  if (glyphs.size() == first && lines.size() == firstLine) return;
  Piece& piece = impl_->widget(list, position);
  piece.firstGlyph = first;
  piece.glyphCount = glyphs.size() - first;
  piece.firstLine = firstLine;
  piece.lineCount = lines.size() - firstLine;
  std::copy_n(ink, 4, piece.ink);
}

// ---------------------------------------------------------------- a frame

GpgpResult Renderer::Impl::prepare(ImDrawData& data, VkCommandBuffer commands, const GpgpFrame& frame) {
  beginFrame();
  ready = false;
  report = {};
  screen = {static_cast<uint32_t>(std::max(data.DisplaySize.x * data.FramebufferScale.x, 0.0f)),
            static_cast<uint32_t>(std::max(data.DisplaySize.y * data.FramebufferScale.y, 0.0f))};
  if (screen.width > info.maxWidth || screen.height > info.maxHeight) return GPGP_ERROR_INVALID_ARGUMENT;
  PiecesInfo wanted;
  wanted.callback = onDraw;
  wanted.owner = this;
  wanted.atlas = &builder.glyphs;
  wanted.atlasTexture = atlas ? atlas->TexID : nullptr;
  wanted.srgbTarget = info.srgbTarget;
  wanted.maxLayers = info.maxLayers;
  wanted.maxGlyphs = info.maxGlyphs;
  wanted.maxDrawings = info.maxDrawings;
  if (!collected) collect(data, wanted, pieces);
  collected = true;
  report.layers = pieces.layers;
  report.dropped = pieces.dropped;

  items.clear();
  text.clear();
  for (const Piece& piece : pieces.all) {
    if (piece.layer < 0) continue;
    ++report.pieces;
    const float down = static_cast<float>(piece.layer) * static_cast<float>(screen.height);
    if (piece.drawing) {
      GpgpCanvasItem& item = items.emplace_back();
      item.drawing = piece.drawing;
      std::copy_n(piece.transform, 6, item.transform);
      item.transform[5] += down;
      item.opacity = 1;
    }
    text.decorate({pieces.lines.data() + piece.firstLine, piece.lineCount}, 0, down, 1);
    const std::span glyphs(pieces.glyphs.data() + piece.firstGlyph, piece.glyphCount);
    if (const GpgpResult placed = cache.place(glyphs, 0, down, 1, text); placed < 0) return placed;
  }
  const size_t shapes = text.lines.size() + text.pictures.size();
  text.lines.resize(std::min(text.lines.size(), kMaxShapes));
  text.pictures.resize(std::min(text.pictures.size(), kMaxShapes - text.lines.size()));
  report.dropped += static_cast<uint32_t>(shapes - text.lines.size() - text.pictures.size());
  report.glyphs = static_cast<uint32_t>(text.glyphs.size() + text.pictures.size());
  report.dropped += text.dropped;
  if (report.glyphs > 0 || !text.lines.empty()) {
    textList.clear();
    if (const GpgpResult added = cache.addTo(textList, text); added < 0) return added;
    GpgpCanvasItem& item = items.emplace_back();
    item.list = textList;
    item.transform[0] = item.transform[3] = 1;
    item.opacity = 1;
  }
  if (const GpgpResult uploaded = gpgpRecordUpload(info.context, commands, &frame, 0, nullptr); uploaded < 0)
    return uploaded;
  if (const GpgpResult uploaded = cache.recordUpload(commands, frame); uploaded < 0) return uploaded;
  if (items.empty()) return GPGP_SUCCESS;

  auto canvasInfo = init<GpgpCanvasInfo>();
  canvasInfo.width = screen.width;
  canvasInfo.height = screen.height * pieces.layers;
  canvasInfo.items = items.data();
  canvasInfo.itemCount = static_cast<uint32_t>(items.size());
  // ImGui mixes colours as they are encoded.
  canvasInfo.encodeSrgb = canvasInfo.blendSrgb = info.srgbTarget ? VK_FALSE : VK_TRUE;
  canvasInfo.exactArea = VK_TRUE; // small letters want it
  const std::optional<GpgpCanvasImage> pictures = cache.image();
  canvasInfo.images = pictures ? &*pictures : nullptr;
  canvasInfo.imageCount = pictures ? 1 : 0;
  canvasInfo.target = layers->target();
  const GpgpResult result = canvas.recordPrepare(commands, frame, canvasInfo);
  ready = result == GPGP_SUCCESS;
  return result;
}

void Renderer::Impl::onDraw(const ImDrawList*, const ImDrawCmd* command) {
  const auto* piece = static_cast<const Piece*>(command->UserCallbackData);
  static_cast<const Impl*>(piece->owner)->draw(*piece);
}

void Renderer::Impl::draw(const Piece& piece) const {
  if (!ready || !target || piece.layer < 0) return;
  layers->bind(target, screen);
  for (const Piece::Part& part : piece.parts) {
    const Rect shown = intersect(part.shown, piece.clip);
    if (!shown.empty()) layers->draw(target, screen, shown, piece.layer);
  }
}

GpgpResult Renderer::prepare(ImDrawData& data, VkCommandBuffer commands, const GpgpFrame& frame) {
  return impl_->prepare(data, commands, frame);
}

void Renderer::resize(uint32_t width, uint32_t height) {
  RendererInfo wanted = impl_->info;
  if (width <= wanted.maxWidth && height <= wanted.maxHeight) return;
  wanted.maxWidth = std::max(width, wanted.maxWidth);
  wanted.maxHeight = std::max(height, wanted.maxHeight);
  impl_->makeCanvas(wanted);
  impl_->ready = false;
}

void Renderer::use(VkCommandBuffer commands) { impl_->target = commands; }
const FrameReport& Renderer::report() const { return impl_->report; }
GpgpRecorder Renderer::canvas() const { return impl_->canvas; }

void Renderer::forget(GpgpFont font) {
  impl_->cache.forget(font);
  std::erase_if(impl_->boxes, [&](const auto& entry) { return entry.first.first == font; });
}

} // namespace gpgp::imgui
