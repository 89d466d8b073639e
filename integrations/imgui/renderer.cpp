// The canvas of a frame's text and widgets, and the callbacks that draw it.
#include "fonts.h"
#include "gpgp_glyph_cache.hpp"
#include "gpgp_imgui.hpp"
#include "pieces.h"

#include "shaders/gpgp_imgui_piece_frag.spv.h"
#include "shaders/gpgp_imgui_piece_vert.spv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

namespace gpgp::imgui {
namespace {

void check(VkResult result, const char* what) {
  if (result < 0) throw std::runtime_error(std::string(what) + " failed with VkResult " + std::to_string(result));
}

void check(GpgpResult result, const char* what, int) {
  if (result < 0) throw std::runtime_error(std::string(what) + ": " + gpgpResultString(result));
}

struct PushConstants {
  int32_t rect[4];
  float scale[2];
  int32_t down;
};

constexpr GpgpAccess kSampled{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT,
                              VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
constexpr GpgpAccess kSampledBefore{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED};

} // namespace

struct Renderer::Impl {
  explicit Impl(const RendererInfo& wanted);
  ~Impl();
  void makeImage();
  void makePipeline();
  void destroy() noexcept;
  Piece& widget(ImDrawList& list, const ImVec2& position, const ImVec2& size);
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
  std::vector<integration::FontGlyph> wantedGlyphs;
  std::vector<uint32_t> indices;
  std::vector<GpgpGlyphInstance> instances;
  std::vector<GpgpCanvasItem> items;

  VkImage image = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkSampler sampler = VK_NULL_HANDLE;
  VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipeline pipeline = VK_NULL_HANDLE;

  VkFormat format() const { return info.srgbTarget ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R8G8B8A8_UNORM; }
  uint32_t height() const { return info.maxHeight * info.maxLayers; }
};

Renderer::Impl::Impl(const RendererInfo& wanted) : info(wanted) {
  if (!info.context || !info.device || !info.renderPass || !info.maxWidth || !info.maxHeight || !info.maxLayers)
    throw std::runtime_error("gpgp::imgui needs a context, a device, a render pass and a size");
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(info.physicalDevice, &properties);
  const uint32_t limit = properties.limits.maxImageDimension2D;
  if (info.maxWidth > limit || info.maxHeight > limit || info.maxLayers > limit / info.maxHeight)
    throw std::runtime_error("maxHeight times maxLayers is beyond the device's images of " + std::to_string(limit) +
                             " pixels");
  check(cache.create(info.context, "imgui", info.glyphSetGlyphs, info.glyphSetBytes), "gpgpCreateGlyphSet", 0);
  auto canvasInfo = init<GpgpCanvasCreateInfo>();
  canvasInfo.base.label = "imgui";
  canvasInfo.base.queueFamily = info.queueFamily;
  canvasInfo.maxWidth = info.maxWidth;
  canvasInfo.maxHeight = height();
  canvasInfo.maxGlyphs = info.maxGlyphs;
  canvasInfo.maxDrawings = info.maxDrawings + 1; // and one item for all text
  Result<Canvas> made = Canvas::create(info.context, canvasInfo);
  check(made.code(), "gpgpCreateCanvas", 0);
  canvas = *std::move(made);
  check(canvas.prewarm(), "gpgpPrewarm", 0);
  try {
    makeImage();
    makePipeline();
  } catch (...) {
    destroy();
    throw;
  }
  builder.onClose = [this](GpgpFont font) { cache.forget(font); };
}

Renderer::Impl::~Impl() { destroy(); } // ImGui's context, and the atlas with it, may be gone

void Renderer::Impl::destroy() noexcept {
  vkDestroyPipeline(info.device, pipeline, nullptr);
  vkDestroyPipelineLayout(info.device, layout, nullptr);
  vkDestroyDescriptorPool(info.device, pool, nullptr);
  vkDestroyDescriptorSetLayout(info.device, setLayout, nullptr);
  vkDestroySampler(info.device, sampler, nullptr);
  vkDestroyImageView(info.device, view, nullptr);
  vkDestroyImage(info.device, image, nullptr);
  vkFreeMemory(info.device, memory, nullptr);
}

void Renderer::Impl::makeImage() {
  VkImageCreateInfo imageInfo{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  imageInfo.imageType = VK_IMAGE_TYPE_2D;
  imageInfo.format = format();
  imageInfo.extent = {info.maxWidth, height(), 1};
  imageInfo.mipLevels = imageInfo.arrayLayers = 1;
  imageInfo.samples = VK_SAMPLE_COUNT_1_BIT;
  imageInfo.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  check(vkCreateImage(info.device, &imageInfo, nullptr, &image), "vkCreateImage");
  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(info.device, image, &needs);
  VkPhysicalDeviceMemoryProperties types{};
  vkGetPhysicalDeviceMemoryProperties(info.physicalDevice, &types);
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needs.size;
  for (const VkMemoryPropertyFlags flags : {VkMemoryPropertyFlags{VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT}, 0u}) {
    uint32_t type = 0;
    while (type < types.memoryTypeCount &&
           (!(needs.memoryTypeBits >> type & 1u) || (types.memoryTypes[type].propertyFlags & flags) != flags))
      ++type;
    if (type == types.memoryTypeCount) continue;
    allocate.memoryTypeIndex = type;
    check(vkAllocateMemory(info.device, &allocate, nullptr, &memory), "vkAllocateMemory");
    break;
  }
  if (!memory) throw std::runtime_error("no memory type for the canvas's image");
  check(vkBindImageMemory(info.device, image, memory, 0), "vkBindImageMemory");
  VkImageViewCreateInfo viewInfo{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  viewInfo.image = image;
  viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
  viewInfo.format = format();
  viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  check(vkCreateImageView(info.device, &viewInfo, nullptr, &view), "vkCreateImageView");
  const VkSamplerCreateInfo samplerInfo{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO}; // texels are fetched
  check(vkCreateSampler(info.device, &samplerInfo, nullptr, &sampler), "vkCreateSampler");
}

void Renderer::Impl::makePipeline() {
  VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT,
                                       &sampler};
  VkDescriptorSetLayoutCreateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  setInfo.bindingCount = 1;
  setInfo.pBindings = &binding;
  check(vkCreateDescriptorSetLayout(info.device, &setInfo, nullptr, &setLayout), "vkCreateDescriptorSetLayout");
  const VkDescriptorPoolSize poolSize{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
  VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  poolInfo.maxSets = poolInfo.poolSizeCount = 1;
  poolInfo.pPoolSizes = &poolSize;
  check(vkCreateDescriptorPool(info.device, &poolInfo, nullptr, &pool), "vkCreateDescriptorPool");
  VkDescriptorSetAllocateInfo setAllocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  setAllocate.descriptorPool = pool;
  setAllocate.descriptorSetCount = 1;
  setAllocate.pSetLayouts = &setLayout;
  check(vkAllocateDescriptorSets(info.device, &setAllocate, &set), "vkAllocateDescriptorSets");
  const VkDescriptorImageInfo texture{VK_NULL_HANDLE, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
  write.dstSet = set;
  write.descriptorCount = 1;
  write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  write.pImageInfo = &texture;
  vkUpdateDescriptorSets(info.device, 1, &write, 0, nullptr);
  const VkPushConstantRange range{VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(PushConstants)};
  VkPipelineLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layoutInfo.setLayoutCount = layoutInfo.pushConstantRangeCount = 1;
  layoutInfo.pSetLayouts = &setLayout;
  layoutInfo.pPushConstantRanges = &range;
  check(vkCreatePipelineLayout(info.device, &layoutInfo, nullptr, &layout), "vkCreatePipelineLayout");

  VkShaderModule modules[2] = {};
  VkPipelineShaderStageCreateInfo stages[2] = {};
  const auto stage = [&](int i, VkShaderStageFlagBits flag, const uint32_t* code, size_t bytes) {
    VkShaderModuleCreateInfo moduleInfo{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    moduleInfo.codeSize = bytes;
    moduleInfo.pCode = code;
    const VkResult result = vkCreateShaderModule(info.device, &moduleInfo, nullptr, &modules[i]);
    stages[i] = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    stages[i].stage = flag;
    stages[i].module = modules[i];
    stages[i].pName = "main";
    return result;
  };
  VkResult result = stage(0, VK_SHADER_STAGE_VERTEX_BIT, gpgp_imgui_piece_vert, sizeof gpgp_imgui_piece_vert);
  if (result == VK_SUCCESS)
    result = stage(1, VK_SHADER_STAGE_FRAGMENT_BIT, gpgp_imgui_piece_frag, sizeof gpgp_imgui_piece_frag);
  VkPipelineVertexInputStateCreateInfo vertexInput{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.lineWidth = 1;
  VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  multisample.rasterizationSamples = info.samples;
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  VkPipelineColorBlendAttachmentState blend{}; // premultiplied over
  blend.blendEnable = VK_TRUE;
  blend.srcColorBlendFactor = blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  blend.dstColorBlendFactor = blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  blend.colorWriteMask = 0xf;
  VkPipelineColorBlendStateCreateInfo blending{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  blending.attachmentCount = 1;
  blending.pAttachments = &blend;
  const VkDynamicState dynamicStates[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamic.dynamicStateCount = 2;
  dynamic.pDynamicStates = dynamicStates;
  VkGraphicsPipelineCreateInfo pipelineInfo{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
  pipelineInfo.stageCount = 2;
  pipelineInfo.pStages = stages;
  pipelineInfo.pVertexInputState = &vertexInput;
  pipelineInfo.pInputAssemblyState = &assembly;
  pipelineInfo.pViewportState = &viewport;
  pipelineInfo.pRasterizationState = &raster;
  pipelineInfo.pMultisampleState = &multisample;
  pipelineInfo.pDepthStencilState = &depth;
  pipelineInfo.pColorBlendState = &blending;
  pipelineInfo.pDynamicState = &dynamic;
  pipelineInfo.layout = layout;
  pipelineInfo.renderPass = info.renderPass;
  pipelineInfo.subpass = info.subpass;
  if (result == VK_SUCCESS)
    result = vkCreateGraphicsPipelines(info.device, VK_NULL_HANDLE, 1, &pipelineInfo, nullptr, &pipeline);
  for (VkShaderModule module : modules) vkDestroyShaderModule(info.device, module, nullptr);
  check(result, "vkCreateGraphicsPipelines");
}

// ---------------------------------------------------------------- widgets

void Renderer::Impl::beginFrame() {
  if (frameCount == ImGui::GetFrameCount()) return;
  pieces.clear();
  frameCount = ImGui::GetFrameCount();
  collected = ready = false;
}

Piece& Renderer::Impl::widget(ImDrawList& list, const ImVec2& position, const ImVec2& size) {
  Piece& piece = pieces.all.emplace_back();
  piece.owner = this;
  piece.position = position;
  piece.size = size;
  list.AddCallback(onDraw, &piece);
  return piece;
}

/// Of a glyph's paths, in em.
const float* Renderer::Impl::boxOf(GpgpFont font, uint32_t glyph) {
  const auto [at, isNew] = boxes.try_emplace({font, glyph});
  if (isNew) {
    GpgpGlyphOutlineInfo wanted = GPGP_GLYPH_OUTLINE_INFO_INIT;
    wanted.glyph = glyph;
    gpgpGetGlyphOutline(
        font, &wanted,
        [](void* user, const GpgpGlyphOutline* outline) {
          std::copy_n(outline->box, 4, static_cast<std::array<float, 4>*>(user)->begin());
        },
        &at->second);
  }
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
  ImGui::Dummy({info.width, info.height});
  if (ImGui::IsItemVisible()) addText(*ImGui::GetWindowDrawList(), layout, at);
}

void Renderer::addDrawing(ImDrawList& list, GpgpAsset asset, const ImVec2& min, const ImVec2& max) {
  if (!asset || max.x <= min.x || max.y <= min.y) return;
  impl_->beginFrame();
  impl_->widget(list, min, {max.x - min.x, max.y - min.y}).drawing = asset;
}

void Renderer::addText(ImDrawList& list, GpgpLayout layout, const ImVec2& position) {
  GpgpLayoutInfo info = GPGP_LAYOUT_INFO_INIT;
  if (gpgpGetLayoutInfo(layout, &info) < 0) return;
  impl_->beginFrame();
  for (uint32_t i = 0; i < info.decorationCount; ++i) {
    const GpgpTextDecoration& line = info.decorations[i];
    const auto encoded = [&](int c) {
      const float v = line.color[c];
      return c == 3 || impl_->info.srgbTarget ? v
             : v <= 0.0031308f                ? 12.92f * v
                                              : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
    };
    list.AddRectFilled({position.x + line.rect.x, position.y + line.rect.y},
                       {position.x + line.rect.x + line.rect.width, position.y + line.rect.y + line.rect.height},
                       ImGui::ColorConvertFloat4ToU32({encoded(0), encoded(1), encoded(2), encoded(3)}));
  }
  std::vector<PlacedGlyph>& glyphs = impl_->pieces.glyphs;
  const size_t first = glyphs.size();
  float ink[4] = {1e9f, 1e9f, -1e9f, -1e9f};
  for (uint32_t i = 0; i < info.glyphCount; ++i) {
    const GpgpTextGlyph& from = info.glyphs[i];
    const float* box = impl_->boxOf(from.font, from.glyph);
    if (box[0] >= box[2]) continue; // a blank
    if (glyphs.size() == impl_->info.maxGlyphs) {
      ++impl_->pieces.dropped;
      continue;
    }
    PlacedGlyph to{from.font, from.glyph, from.x, from.y, from.size};
    std::copy_n(from.color, 4, to.color);
    glyphs.push_back(to);
    ink[0] = std::min(ink[0], from.x + box[0] * from.size);
    ink[1] = std::min(ink[1], from.y + box[1] * from.size);
    ink[2] = std::max(ink[2], from.x + box[2] * from.size);
    ink[3] = std::max(ink[3], from.y + box[3] * from.size);
  }
  if (glyphs.size() == first) return;
  Piece& piece = impl_->widget(list, position, {info.width, info.height});
  piece.firstGlyph = first;
  piece.glyphCount = glyphs.size() - first;
  std::copy_n(ink, 4, piece.ink);
}

// ---------------------------------------------------------------- a frame

GpgpResult Renderer::Impl::prepare(ImDrawData& data, VkCommandBuffer commands, const GpgpFrame& frame) {
  beginFrame();
  ready = false;
  report = {};
  screen = {static_cast<uint32_t>(std::max(data.DisplaySize.x * data.FramebufferScale.x, 0.0f)),
            static_cast<uint32_t>(std::max(data.DisplaySize.y * data.FramebufferScale.y, 0.0f))};
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
  if (screen.width > info.maxWidth || screen.height > info.maxHeight) return GPGP_ERROR_INVALID_ARGUMENT;

  wantedGlyphs.clear();
  for (const PlacedGlyph& glyph : pieces.glyphs) wantedGlyphs.push_back({glyph.font, glyph.glyph});
  indices.assign(wantedGlyphs.size(), GPGP_GLYPH_NONE);
  if (const GpgpResult found = cache.find(wantedGlyphs, indices.data()); found < 0) return found;
  items.clear();
  instances.clear();
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
    for (size_t i = piece.firstGlyph; i < piece.firstGlyph + piece.glyphCount; ++i) {
      if (indices[i] == GPGP_GLYPH_NONE) {
        ++report.dropped;
        continue;
      }
      const PlacedGlyph& from = pieces.glyphs[i];
      GpgpGlyphInstance to{indices[i], from.x, from.y + down, from.size, {}};
      std::copy_n(from.color, 4, to.color);
      instances.push_back(to);
    }
  }
  report.glyphs = static_cast<uint32_t>(instances.size());
  if (!instances.empty()) items.push_back(cache.item(instances));
  if (const GpgpResult uploaded = gpgpRecordUpload(info.context, commands, &frame, 0, nullptr); uploaded < 0)
    return uploaded;
  if (items.empty()) return GPGP_SUCCESS;

  auto canvasInfo = init<GpgpCanvasInfo>();
  canvasInfo.width = screen.width;
  canvasInfo.height = screen.height * pieces.layers;
  canvasInfo.items = items.data();
  canvasInfo.itemCount = static_cast<uint32_t>(items.size());
  // ImGui mixes colours as they are encoded.
  canvasInfo.encodeSrgb = canvasInfo.blendSrgb = info.srgbTarget ? VK_FALSE : VK_TRUE;
  canvasInfo.exactArea = VK_TRUE; // small letters want it
  canvasInfo.target = {image, view, format(), 0, 0, info.maxWidth, height(), kSampledBefore, kSampled};
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
  vkCmdBindPipeline(target, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
  vkCmdBindDescriptorSets(target, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set, 0, nullptr);
  const VkRect2D all{{0, 0}, screen};
  vkCmdSetScissor(target, 0, 1, &all); // parts are clipped as rectangles
  for (const Piece::Part& part : piece.parts) {
    const Rect shown = intersect(part.shown, piece.clip);
    if (shown.empty()) continue;
    const PushConstants constants{{shown.left, shown.top, shown.right, shown.bottom},
                                  {2.0f / static_cast<float>(screen.width), 2.0f / static_cast<float>(screen.height)},
                                  piece.layer * static_cast<int32_t>(screen.height)};
    vkCmdPushConstants(target, layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof constants,
                       &constants);
    vkCmdDraw(target, 4, 1, 0, 0);
  }
}

GpgpResult Renderer::prepare(ImDrawData& data, VkCommandBuffer commands, const GpgpFrame& frame) {
  return impl_->prepare(data, commands, frame);
}

void Renderer::use(VkCommandBuffer commands) { impl_->target = commands; }
const FrameReport& Renderer::report() const { return impl_->report; }
GpgpWorker Renderer::canvas() const { return impl_->canvas; }

void Renderer::forget(GpgpFont font) {
  impl_->cache.forget(font);
  std::erase_if(impl_->boxes, [&](const auto& entry) { return entry.first.first == font; });
}

} // namespace gpgp::imgui
