// A town in a picture: grammar text becomes instances on the GPU, which the program draws as any engine draws
// instances.
//
//   first_picture [FILE.png]        default: first_picture.png
//
// Of gpgp it needs the spawn service and its compiler alone, so that samples/run.sh has a picture before the rest is
// built. Device and queue are gpgp::integration::Device's; GPGP_DEVICE names another one than the default.
#include "gpgp_device.hpp"

#include <gpgp/spawn.hpp>

#include "shaders/first_ground_frag.spv.h"
#include "shaders/first_ground_vert.spv.h"
#include "shaders/first_town_frag.spv.h"
#include "shaders/first_town_vert.spv.h"

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <png.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using gpgp::integration::check;
using gpgp::integration::Device;

constexpr VkExtent2D kSize = {1600, 900};  // pixels
constexpr uint32_t kMaxInstances = 131072; // the budget: a report would say what did not fit
constexpr VkFormat kColourFormat = VK_FORMAT_R8G8B8A8_SRGB, kDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr VkSampleCountFlagBits kSamples = VK_SAMPLE_COUNT_4_BIT;

/// gpgp's results; messages have said by then what is wrong.
void need(GpgpResult result, const char* what) {
  if (result != GPGP_SUCCESS) throw std::runtime_error(std::string(what) + ": " + gpgpResultString(result));
}
template <class T> T take(gpgp::Result<T> result, const char* what) {
  need(result.code(), what);
  return *std::move(result);
}

void GPGP_CALL onMessage(void*, const GpgpMessage* message) {
  std::fprintf(stderr, "%s: %s\n", message->function, message->text);
}
void GPGP_CALL onCompileMessage(void*, const GpgpCompileMessage* message) {
  std::fprintf(stderr, "%s:%u:%u: %s\n", message->file, message->line, message->column, message->text);
}

/// A buffer that both sides reach. A real engine keeps in device memory what only the GPU uses.
struct Buffer {
  Buffer(const Device& from, VkDeviceSize bytes, VkBufferUsageFlags usage) : device(from), size(bytes) {
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = size;
    info.usage = usage;
    check(vkCreateBuffer(device.device, &info, nullptr, &handle), "vkCreateBuffer");
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device.device, handle, &needs);
    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocate.allocationSize = needs.size;
    allocate.memoryTypeIndex = device.memoryType(needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                                                           VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    check(vkAllocateMemory(device.device, &allocate, nullptr, &memory), "vkAllocateMemory");
    check(vkBindBufferMemory(device.device, handle, memory, 0), "vkBindBufferMemory");
    check(vkMapMemory(device.device, memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
  }
  template <class T>
  Buffer(const Device& from, const std::vector<T>& values, VkBufferUsageFlags usage)
      : Buffer(from, values.size() * sizeof(T), usage) {
    std::memcpy(mapped, values.data(), size);
  }
  ~Buffer() {
    vkDestroyBuffer(device.device, handle, nullptr);
    vkFreeMemory(device.device, memory, nullptr);
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  /// For gpgp: nothing to wait for before; what reads it afterwards.
  GpgpBuffer forGpgp(VkPipelineStageFlags2 stages = 0, VkAccessFlags2 access = 0) const {
    return {handle, 0, size, {0, 0, VK_IMAGE_LAYOUT_UNDEFINED}, {stages, access, VK_IMAGE_LAYOUT_UNDEFINED}};
  }

  const Device& device;
  VkBuffer handle = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceSize size;
  void* mapped = nullptr;
};

struct Image {
  Image(const Device& from, VkFormat format, VkSampleCountFlagBits samples, VkImageUsageFlags usage,
        VkImageAspectFlags aspect)
      : device(from) {
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {kSize.width, kSize.height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = samples;
    info.usage = usage;
    check(vkCreateImage(device.device, &info, nullptr, &handle), "vkCreateImage");
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(device.device, handle, &needs);
    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocate.allocationSize = needs.size;
    allocate.memoryTypeIndex = device.memoryType(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    check(vkAllocateMemory(device.device, &allocate, nullptr, &memory), "vkAllocateMemory");
    check(vkBindImageMemory(device.device, handle, memory, 0), "vkBindImageMemory");
    VkImageViewCreateInfo viewInfo{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    viewInfo.image = handle;
    viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
    viewInfo.format = format;
    viewInfo.subresourceRange = {aspect, 0, 1, 0, 1};
    check(vkCreateImageView(device.device, &viewInfo, nullptr, &view), "vkCreateImageView");
  }
  ~Image() {
    vkDestroyImageView(device.device, view, nullptr);
    vkDestroyImage(device.device, handle, nullptr);
    vkFreeMemory(device.device, memory, nullptr);
  }
  Image(const Image&) = delete;
  Image& operator=(const Image&) = delete;

  const Device& device;
  VkImage handle = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
};

/// What the shaders of samples/mini_engine take: the town's, and the sky and the streets behind it.
struct Push {
  glm::mat4 matrix; ///< world to clip; for the backdrop clip to world
  glm::vec4 eye;    ///< w: daylight
  glm::vec4 colour; ///< linear; a: how much buildings differ
};

/// Colour and depth with four samples a pixel, resolved into a picture that is copied to a buffer next.
class Pass {
public:
  explicit Pass(const Device& device)
      : device_(device),
        colour_(device, kColourFormat, kSamples, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_IMAGE_ASPECT_COLOR_BIT),
        depth_(device, kDepthFormat, kSamples, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_ASPECT_DEPTH_BIT),
        picture_(device, kColourFormat, VK_SAMPLE_COUNT_1_BIT,
                 VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, VK_IMAGE_ASPECT_COLOR_BIT) {
    const auto attachment = [](VkFormat format, VkSampleCountFlagBits samples, VkImageLayout layout) {
      const bool kept = samples == VK_SAMPLE_COUNT_1_BIT;
      return VkAttachmentDescription{0,
                                     format,
                                     samples,
                                     kept ? VK_ATTACHMENT_LOAD_OP_DONT_CARE : VK_ATTACHMENT_LOAD_OP_CLEAR,
                                     kept ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                     VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                     VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                     VK_IMAGE_LAYOUT_UNDEFINED,
                                     layout};
    };
    const std::array attachments = {
        attachment(kColourFormat, kSamples, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL),
        attachment(kDepthFormat, kSamples, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL),
        attachment(kColourFormat, VK_SAMPLE_COUNT_1_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL)};
    const VkAttachmentReference colour{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference resolved{2, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &colour;
    subpass.pResolveAttachments = &resolved;
    subpass.pDepthStencilAttachment = &depth;
    const VkSubpassDependency toCopy{0,
                                     VK_SUBPASS_EXTERNAL,
                                     VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                     VK_PIPELINE_STAGE_TRANSFER_BIT,
                                     VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                     VK_ACCESS_TRANSFER_READ_BIT,
                                     0};
    VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
    info.attachmentCount = static_cast<uint32_t>(attachments.size());
    info.pAttachments = attachments.data();
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    info.dependencyCount = 1;
    info.pDependencies = &toCopy;
    check(vkCreateRenderPass(device.device, &info, nullptr, &pass_), "vkCreateRenderPass");
    const std::array views = {colour_.view, depth_.view, picture_.view};
    VkFramebufferCreateInfo framebufferInfo{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
    framebufferInfo.renderPass = pass_;
    framebufferInfo.attachmentCount = static_cast<uint32_t>(views.size());
    framebufferInfo.pAttachments = views.data();
    framebufferInfo.width = kSize.width;
    framebufferInfo.height = kSize.height;
    framebufferInfo.layers = 1;
    check(vkCreateFramebuffer(device.device, &framebufferInfo, nullptr, &framebuffer_), "vkCreateFramebuffer");
    const VkPushConstantRange push{kStages, 0, sizeof(Push)};
    VkPipelineLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layoutInfo.pushConstantRangeCount = 1;
    layoutInfo.pPushConstantRanges = &push;
    check(vkCreatePipelineLayout(device.device, &layoutInfo, nullptr, &layout_), "vkCreatePipelineLayout");
  }
  ~Pass() {
    for (VkPipeline pipeline : pipelines_) vkDestroyPipeline(device_.device, pipeline, nullptr);
    vkDestroyPipelineLayout(device_.device, layout_, nullptr);
    vkDestroyFramebuffer(device_.device, framebuffer_, nullptr);
    vkDestroyRenderPass(device_.device, pass_, nullptr);
  }
  Pass(const Pass&) = delete;
  Pass& operator=(const Pass&) = delete;

  /// Without vertices: one triangle over the whole picture, behind everything.
  template <size_t V, size_t F>
  VkPipeline pipeline(const uint32_t (&vertex)[V], const uint32_t (&fragment)[F],
                      const std::vector<VkVertexInputBindingDescription>& bindings = {},
                      const std::vector<VkVertexInputAttributeDescription>& attributes = {}) {
    std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
    stages[0] = stage(VK_SHADER_STAGE_VERTEX_BIT, vertex, sizeof vertex);
    stages[1] = stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment, sizeof fragment);
    VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    input.vertexBindingDescriptionCount = static_cast<uint32_t>(bindings.size());
    input.pVertexBindingDescriptions = bindings.data();
    input.vertexAttributeDescriptionCount = static_cast<uint32_t>(attributes.size());
    input.pVertexAttributeDescriptions = attributes.data();
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    const VkViewport viewport{0, 0, float(kSize.width), float(kSize.height), 0, 1};
    const VkRect2D scissor{{0, 0}, kSize};
    VkPipelineViewportStateCreateInfo view{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    view.viewportCount = view.scissorCount = 1;
    view.pViewports = &viewport;
    view.pScissors = &scissor;
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.lineWidth = 1.0f;
    VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    multisample.rasterizationSamples = kSamples;
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = depth.depthWriteEnable = bindings.empty() ? VK_FALSE : VK_TRUE;
    depth.depthCompareOp = VK_COMPARE_OP_LESS;
    VkPipelineColorBlendAttachmentState opaque{};
    opaque.colorWriteMask = 0xf;
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = 1;
    blend.pAttachments = &opaque;
    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
    info.stageCount = static_cast<uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &view;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &multisample;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.layout = layout_;
    info.renderPass = pass_;
    pipelines_.push_back(VK_NULL_HANDLE);
    const VkResult result =
        vkCreateGraphicsPipelines(device_.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipelines_.back());
    for (const VkPipelineShaderStageCreateInfo& made : stages)
      vkDestroyShaderModule(device_.device, made.module, nullptr);
    check(result, "vkCreateGraphicsPipelines");
    return pipelines_.back();
  }

  void begin(VkCommandBuffer commands) const {
    std::array<VkClearValue, 3> clear{};
    clear[1].depthStencil.depth = 1.0f;
    VkRenderPassBeginInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    info.renderPass = pass_;
    info.framebuffer = framebuffer_;
    info.renderArea.extent = kSize;
    info.clearValueCount = static_cast<uint32_t>(clear.size());
    info.pClearValues = clear.data();
    vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
  }
  void push(VkCommandBuffer commands, const Push& values) const {
    vkCmdPushConstants(commands, layout_, kStages, 0, sizeof values, &values);
  }
  VkImage picture() const { return picture_.handle; }

private:
  static constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
  VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits which, const uint32_t* words, size_t bytes) const {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = bytes;
    info.pCode = words;
    VkPipelineShaderStageCreateInfo made{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    check(vkCreateShaderModule(device_.device, &info, nullptr, &made.module), "vkCreateShaderModule");
    made.stage = which;
    made.pName = "main";
    return made;
  }
  const Device& device_;
  Image colour_, depth_, picture_;
  VkRenderPass pass_ = VK_NULL_HANDLE;
  VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  std::vector<VkPipeline> pipelines_;
};

/// Lots on a grid of streets; the taller the nearer they are to the middle.
std::vector<GpgpAxiom> makeLots() {
  constexpr int kBlocks = 14;
  constexpr float kBlock = 26.0f; // metres; the backdrop draws streets between them
  std::vector<GpgpAxiom> lots;
  for (int z = -kBlocks; z <= kBlocks; ++z)
    for (int x = -kBlocks; x <= kBlocks; ++x) {
      GpgpAxiom lot{};
      lot.id = static_cast<uint32_t>(lots.size());
      lot.seed = 7919u * (lot.id + 1u);
      lot.size[0] = lot.size[2] = 18.0f;
      lot.size[1] = 44.0f + 80.0f * std::exp(-static_cast<float>(x * x + z * z) / 16.0f); // what may be built
      lot.transform[0] = lot.transform[5] = lot.transform[10] = 1.0f;
      lot.transform[3] = static_cast<float>(x) * kBlock;
      lot.transform[7] = lot.size[1] * 0.5f; // shapes have their origin in the middle
      lot.transform[11] = static_cast<float>(z) * kBlock;
      lot.start = GPGP_AXIOM_DEFAULT_START;
      lot.attribute = std::nanf("");
      lots.push_back(lot);
    }
  return lots;
}

/// Colours of the grammar's terminals, a bucket each.
std::vector<glm::vec4> coloursOf(const gpgp::Grammar& grammar) {
  static const std::map<std::string, glm::vec4> kColours = {
      {"Wall", {0.46f, 0.38f, 0.27f, 1.0f}},     {"Brick", {0.30f, 0.12f, 0.075f, 0.6f}},
      {"Concrete", {0.34f, 0.34f, 0.33f, 0.3f}}, {"White", {0.58f, 0.56f, 0.52f, 0.3f}},
      {"Window", {0.06f, 0.11f, 0.16f, 0.0f}},   {"Glass", {0.07f, 0.16f, 0.21f, 0.2f}},
      {"Tile", {0.30f, 0.085f, 0.045f, 0.4f}},   {"Roof", {0.16f, 0.16f, 0.17f, 0.2f}},
      {"Wood", {0.17f, 0.09f, 0.045f, 0.2f}},    {"Grass", {0.10f, 0.19f, 0.05f, 0.2f}},
      {"Leaves", {0.055f, 0.14f, 0.03f, 0.6f}},  {"Steel", {0.40f, 0.43f, 0.46f, 0.0f}}};
  uint32_t count = 0;
  need(grammar.terminals(count, nullptr), "gpgpGetGrammarTerminals");
  std::vector<GpgpGrammarTerminal> terminals(count);
  need(grammar.terminals(count, terminals.data()), "gpgpGetGrammarTerminals");
  std::vector<glm::vec4> colours;
  for (const GpgpGrammarTerminal& terminal : terminals) {
    if (terminal.bucket >= colours.size()) colours.resize(terminal.bucket + 1, glm::vec4(0.4f));
    if (const auto known = kColours.find(terminal.name); known != kColours.end())
      colours[terminal.bucket] = known->second;
  }
  return colours;
}

void writePng(const char* file, const void* pixels) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = kSize.width;
  png.height = kSize.height;
  png.format = PNG_FORMAT_RGBA;
  if (!png_image_write_to_file(&png, file, 0, pixels, 0, nullptr))
    throw std::runtime_error(std::string(file) + ": " + png.message);
}

uint32_t draw(const char* file) {
  gpgp::integration::DeviceInfo deviceInfo;
  deviceInfo.application = "first picture";
  Device device(deviceInfo);

  // gpgp: a context, the grammar (a shipped game loads a baked one), a recorder whose pipelines are made now.
  GpgpContextCreateInfo contextInfo = device.contextCreateInfo();
  contextInfo.label = "first picture";
  contextInfo.messageFn = onMessage;
  gpgp::Context context = take(gpgp::Context::create(contextInfo), "gpgpCreateContext");
  std::ifstream input(FIRST_PICTURE_GRAMMAR, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(input), {}};
  auto source = gpgp::init<GpgpGrammarSource>();
  source.name = FIRST_PICTURE_GRAMMAR;
  source.text = text.data();
  source.size = text.size();
  source.messageFn = onCompileMessage;
  const gpgp::Blob baked = take(gpgp::compileGrammar(source), "gpgpCompileGrammar");
  auto grammarInfo = gpgp::init<GpgpGrammarCreateInfo>();
  grammarInfo.data = baked.data();
  grammarInfo.size = baked.size();
  const gpgp::Grammar grammar = take(gpgp::Grammar::create(context, grammarInfo), "gpgpCreateGrammar");
  auto spawnerInfo = gpgp::init<GpgpSpawnerCreateInfo>();
  spawnerInfo.base.queueFamily = device.family;
  spawnerInfo.flags = GPGP_SPAWNER_ORDERED; // where faces coincide, the picture is the same in every run
  spawnerInfo.maxTerminals = kMaxInstances;
  gpgp::Spawner spawner = take(gpgp::Spawner::create(context, spawnerInfo), "gpgpCreateSpawner");
  need(spawner.prewarm(), "gpgpPrewarm");

  // The engine's buffers: lots in, instances out, and a draw for each bucket, of which gpgp sets how many and from
  // where.
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  const std::vector<GpgpAxiom> lots = makeLots();
  const std::vector<glm::vec4> colours = coloursOf(grammar);
  const Buffer axioms(device, lots, kStorage);
  const Buffer instances(device, VkDeviceSize{kMaxInstances} * sizeof(GpgpInstance),
                         kStorage | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  VkDrawIndexedIndirectCommand box{};
  box.indexCount = 36;
  const Buffer draws(device, std::vector(colours.size(), box), kStorage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
  std::vector<glm::vec3> unitBox;
  for (int i = 0; i < 8; ++i)
    unitBox.emplace_back(float(i & 1) - 0.5f, float(i >> 1 & 1) - 0.5f, float(i >> 2 & 1) - 0.5f);
  const Buffer corners(device, unitBox, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  const Buffer indices(device, std::vector<uint16_t>{0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                                     2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5},
                       VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
  const Buffer pixels(device, VkDeviceSize{4} * kSize.width * kSize.height, VK_BUFFER_USAGE_TRANSFER_DST_BIT);

  Pass pass(device);
  const VkPipeline backdrop = pass.pipeline(first_ground_vert, first_ground_frag);
  const VkPipeline town = pass.pipeline(
      first_town_vert, first_town_frag,
      {{0, sizeof(glm::vec3), VK_VERTEX_INPUT_RATE_VERTEX}, {1, sizeof(GpgpInstance), VK_VERTEX_INPUT_RATE_INSTANCE}},
      {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
       {1, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(GpgpInstance, transform)},
       {2, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(GpgpInstance, transform) + 16},
       {3, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(GpgpInstance, transform) + 32},
       {4, 1, VK_FORMAT_R32G32B32_UINT, offsetof(GpgpInstance, bucket)}});

  // One frame: what gpgp records, then an ordinary render pass.
  gpgp::integration::Frames frames(device, 1);
  const VkCommandBuffer commands = frames.begin();
  need(context.advance(frames.number()), "gpgpAdvance");
  need(context.recordUpload(commands, frames.number()).code(), "gpgpRecordUpload");
  auto spawn = gpgp::init<GpgpSpawnInfo>();
  spawn.grammar = grammar;
  spawn.axioms = axioms.forGpgp();
  spawn.axiomCount = static_cast<uint32_t>(lots.size());
  spawn.instances = instances.forGpgp(VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT, VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT);
  spawn.draws = draws.forGpgp(VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
  need(spawner.recordPrepare(commands, frames.number(), spawn), "gpgpRecordPrepareSpawn");

  const glm::vec3 eye(120, 98, 232);
  glm::mat4 projection = glm::perspectiveRH_ZO(0.66f, float(kSize.width) / float(kSize.height), 1.0f, 3000.0f);
  projection[1][1] = -projection[1][1]; // Vulkan's clip space has +Y down
  const glm::mat4 toClip = projection * glm::lookAtRH(eye, glm::vec3(-6, 31, 0), glm::vec3(0, 1, 0));
  pass.begin(commands);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, backdrop);
  pass.push(commands, {glm::inverse(toClip), glm::vec4(eye, 1), {}});
  vkCmdDraw(commands, 3, 1, 0, 0);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, town);
  const std::array vertices = {corners.handle, instances.handle};
  const std::array<VkDeviceSize, 2> offsets = {0, 0};
  vkCmdBindVertexBuffers(commands, 0, 2, vertices.data(), offsets.data());
  vkCmdBindIndexBuffer(commands, indices.handle, 0, VK_INDEX_TYPE_UINT16);
  for (uint32_t bucket = 0; bucket < colours.size(); ++bucket) {
    pass.push(commands, {toClip, glm::vec4(eye, 1), colours[bucket]});
    vkCmdDrawIndexedIndirect(commands, draws.handle, bucket * sizeof box, 1, sizeof box);
  }
  vkCmdEndRenderPass(commands);
  VkBufferImageCopy copy{};
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageExtent = {kSize.width, kSize.height, 1};
  vkCmdCopyImageToBuffer(commands, pass.picture(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels.handle, 1, &copy);
  VkMemoryBarrier toHost{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  toHost.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
  toHost.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &toHost, 0, nullptr,
                       0, nullptr);
  frames.submit();
  frames.finish();

  // The frame is over: gpgp's report says what became of the lots.
  need(context.advance(frames.number()), "gpgpAdvance");
  const GpgpSpawnReport report = take(spawner.report(), "gpgpGetSpawnReport");
  need(report.base.status, "the derivation");
  std::printf("first picture: %zu lots became %u instances on %s\n", lots.size(), report.terminals,
              device.properties.deviceName);
  writePng(file, pixels.mapped);
  return report.terminals;
}

} // namespace

int main(int argc, char** argv) {
  try {
    return draw(argc > 1 ? argv[1] : "first_picture.png") ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "first_picture: %s\n", error.what());
    return 1;
  }
}
