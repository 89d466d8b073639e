#include "cli/visibility/sampled_model.h"

#include "cli/shared/progress.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>

namespace gpgp::cli {

AlphaTestTextures::AlphaTestTextures(host::HeadlessDevice& device, const std::vector<AlphaTexture>& textures)
    : device_(device) {
  for (const AlphaTexture& texture : textures) {
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = info.minFilter = texture.linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
    const auto modeOf = [](AlphaTexture::Wrap wrap) {
      return wrap == AlphaTexture::Wrap::clamp    ? VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE
             : wrap == AlphaTexture::Wrap::mirror ? VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT
                                                  : VK_SAMPLER_ADDRESS_MODE_REPEAT;
    };
    info.addressModeU = modeOf(texture.wrapU), info.addressModeV = modeOf(texture.wrapV);
    host::check(device.vk().vkCreateSampler(device.device(), &info, nullptr, &samplers_.emplace_back()),
                "vkCreateSampler");
    const host::Image& image = images_.emplace_back(device, host::ImageInfo{.format = VK_FORMAT_R8G8B8A8_UNORM,
                                                                            .width = texture.width,
                                                                            .height = texture.height,
                                                                            .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
    std::vector<uint8_t> pixels(texture.alpha.size() * 4);
    for (size_t i = 0; i < texture.alpha.size(); ++i) pixels[i * 4 + 3] = texture.alpha[i];
    host::uploadImage(device, image, pixels, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    tests_.push_back({image.view(), samplers_.back(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, texture.cutoff, 0});
  }
}

AlphaTestTextures::~AlphaTestTextures() {
  for (const VkSampler sampler : samplers_) device_.vk().vkDestroySampler(device_.device(), sampler, nullptr);
}

SampledModel::SampledModel(Session& session, const VisibilityOptions& options, const Model& model)
    : session_(session), options_(options), model_(model), words_((model.triangleCount + 31) / 32),
      textures_(session.device(), model.alphaTests) {
  GpgpGeometrySetCreateInfo info = GPGP_GEOMETRY_SET_CREATE_INFO_INIT;
  info.label = options.model.c_str();
  info.meshes = model.meshes.data();
  info.meshCount = static_cast<uint32_t>(model.meshes.size());
  geometry_ = session.take(GeometrySet::create(session.context(), info), "gpgpCreateGeometrySet");
  session.upload();
  host::HeadlessDevice& device = session.device();
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  positions_ = host::makeBuffer(device, model.positions, kStorage, "positions");
  if (!model.alphaTests.empty())
    coordinates_ = host::makeBuffer(device, model.coordinates, kStorage, "texture coordinates");
  for (const GpgpVisibilityDraw& draw : model.draws)
    if (draw.flags & ~(GPGP_DRAW_TWO_SIDED | GPGP_DRAW_CLOCKWISE)) nonOpaque_ += model.meshes[draw.mesh].indexCount / 3;
  indices_ = host::makeBuffer(device, model.indices, kStorage, "indices");
  draws_ = host::makeBuffer(device, model.draws, kStorage, "draws");
  bits_ = host::Buffer(device, VkDeviceSize{words_} * 4, kStorage, host::Memory::device, "visible bits");
  sizes_ = host::Buffer(device, VkDeviceSize{model.triangleCount} * 4, kStorage, host::Memory::device, "pixel counts");
  list_ = host::Buffer(device, VkDeviceSize{model.triangleCount} * 4, kStorage, host::Memory::device, "visible list");
  if (options.atlas.width)
    triangleSizes_ = host::Buffer(device, VkDeviceSize{model.triangleCount} * sizeof(GpgpTriangleSize), kStorage,
                                  host::Memory::device, "triangle sizes");
  count_ = host::Buffer(device, 16, kStorage, host::Memory::device, "visible count");
}

void SampledModel::describe(GpgpAtlasInfo& info, bool pairs) const {
  info.triangleCount = model_.triangleCount;
  info.visibleBits = bits_.range();
  info.triangleSizes = triangleSizes_.range();
  info.indexType = VK_INDEX_TYPE_UINT32;
  if (!pairs) return;
  info.geometrySet = geometry_;
  info.draws = draws_.range();
  info.drawCount = static_cast<uint32_t>(model_.draws.size());
  info.indices = indices_.range();
}

VisibilityRecorder SampledModel::recorder(GpgpSamplingMethod method, uint32_t maxSamples, Size largest) {
  if (!largest.width) largest = options_.size;
  GpgpVisibilityRecorderCreateInfo info = GPGP_VISIBILITY_RECORDER_CREATE_INFO_INIT;
  info.base = session_.recorderInfo("recorder");
  info.maxWidth = largest.width;
  info.maxHeight = largest.height;
  info.maxDraws = static_cast<uint32_t>(model_.draws.size());
  info.maxTriangles = model_.triangleCount;
  info.methods = 1u << method;
  info.maxSamples = maxSamples;
  info.maxNonOpaque = nonOpaque_;
  info.maxCandidates = maxCandidates();
  info.maxPairs = maxPairs(largest);
  const Progress progress("making pipelines");
  VisibilityRecorder made =
      session_.take(VisibilityRecorder::create(session_.context(), info), "gpgpCreateVisibilityRecorder");
  session_.check(made.prewarm(), "gpgpPrewarm");
  return made;
}

uint32_t SampledModel::maxCandidates() const {
  const uint64_t range = session_.device().properties().limits.maxStorageBufferRange;
  return static_cast<uint32_t>(std::min<uint64_t>({std::max(model_.triangleCount, 65536u), 1u << 24, range / 80}));
}

uint32_t SampledModel::maxPairs(Size largest) const {
  const uint64_t range = session_.device().properties().limits.maxStorageBufferRange;
  const uint64_t pixels = uint64_t{largest.width} * largest.height;
  return static_cast<uint32_t>(std::min<uint64_t>(pixels * 24 + (1u << 20), range / 20));
}

Measured<GpgpVisibilityReport> SampledModel::sample(VisibilityRecorder& recorder, const Step& step) {
  const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED};
  return session_.measure(recorder, step.label, step.repeat,
                          [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordingInfo& base) {
                            GpgpVisibilityInfo info = GPGP_VISIBILITY_INFO_INIT;
                            info.base = base;
                            info.geometrySet = geometry_;
                            info.history = step.history;
                            info.method = step.method;
                            std::copy_n(glm::value_ptr(step.view.camera), 16, info.camera.viewProjection);
                            info.camera.reversedDepth = step.view.reversed;
                            const Size size = step.size.width ? step.size : options_.size;
                            info.width = size.width;
                            info.height = size.height;
                            info.samples = step.samples;
                            info.slice = step.slice;
                            info.accumulate = step.accumulate;
                            if (step.method == GPGP_SAMPLING_CONSERVATIVE) {
                              info.resolution = options_.resolution;
                              info.heuristics = options_.heuristics;
                              info.epsilonStatic = options_.epsilonStatic;
                              info.epsilonDynamic = options_.epsilonDynamic;
                              info.refinements = options_.refinements;
                            }
                            info.positions = positions_.range();
                            info.positionStride = 12;
                            info.alphaTests = textures_.tests().data();
                            info.alphaTestCount = static_cast<uint32_t>(textures_.tests().size());
                            if (info.alphaTestCount) info.textureCoordinates = coordinates_.range();
                            info.indices = indices_.range();
                            info.indexType = VK_INDEX_TYPE_UINT32;
                            info.draws = draws_.range();
                            info.drawCount = static_cast<uint32_t>(model_.draws.size());
                            info.triangleCount = model_.triangleCount;
                            info.visibleBits = bits_.range({}, after);
                            if (step.sizes) info.pixelCounts = sizes_.range({}, after);
                            if (triangleSizes_.handle()) info.triangleSizes = triangleSizes_.range({}, after);
                            info.visibleList = list_.range({}, after);
                            info.visibleCount = count_.range({}, after);
                            return recorder.recordPrepare(commands, frame, info);
                          });
}

GpgpVisibilityReport SampledModel::compare(VisibilityRecorder& recorder, const std::vector<uint32_t>& found,
                                           const std::vector<uint32_t>& reference, const std::vector<uint32_t>& areas,
                                           const std::vector<uint32_t>& recheck) {
  host::HeadlessDevice& device = session_.device();
  const auto copy = [&](const std::vector<uint32_t>& words, const char* name) {
    return words.empty() ? host::Buffer() : host::makeBuffer(device, words, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, name);
  };
  const host::Buffer foundBits = copy(found, "found"), referenceBits = copy(reference, "reference");
  const host::Buffer referenceCounts = copy(areas, "reference's counts"), recheckBits = copy(recheck, "recheck");
  return session_
      .measure(recorder, "metrics", 1,
               [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordingInfo& base) {
                 GpgpVisibilityMetricsInfo info = GPGP_VISIBILITY_METRICS_INFO_INIT;
                 info.base = base;
                 info.triangleCount = model_.triangleCount;
                 info.visibleBits = foundBits.range();
                 info.referenceBits = referenceBits.range();
                 info.referenceCounts = referenceCounts.range();
                 if (!recheck.empty()) info.recheckBits = recheckBits.range();
                 return recorder.recordPrepareMetrics(commands, frame, info);
               })
      .report;
}

std::vector<uint32_t> SampledModel::reference(const std::vector<View>& views, uint32_t samples,
                                              const std::function<void(uint64_t, uint64_t)>& told) {
  uint32_t perRecord = std::min(samples, 8u); // as many as the device binds
  const uint64_t range = session_.device().properties().limits.maxStorageBufferRange;
  while (perRecord > 1 && uint64_t{options_.size.width} * options_.size.height * perRecord * perRecord * 8 > range)
    perRecord /= 2;
  VisibilityRecorder reference = recorder(GPGP_SAMPLING_REFERENCE, perRecord);
  const uint32_t slices = samples / perRecord * (samples / perRecord) + 1;
  uint64_t done = 0;
  for (const View& view : views)
    for (uint32_t slice = 0; slice < slices; ++slice) {
      Step step;
      step.method = GPGP_SAMPLING_REFERENCE;
      step.view = view;
      step.samples = samples;
      step.slice = slice;
      step.accumulate = done > 0;
      step.sizes = true;
      step.label = "slice";
      sample(reference, step);
      told(++done, slices * views.size());
    }
  return bits();
}

} // namespace gpgp::cli
