// Three records of gpgp's recorder a displayed frame, four where it is shaded: the visible set for shading, what the
// display shows (standard sampling), and the one compared with the other.
#include "decoupled.h"

#include "target.h"

#include "shaders/mini_shade_comp.spv.h"
#include "shaders/mini_shaded_frag.spv.h"
#include "shaders/mini_shaded_vert.spv.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <iterator>

namespace mini {
namespace {
constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr VkDeviceSize kRecordBytes = 32;        // Record of shaded.glsl
constexpr uint32_t kReferencePerRecord = 2;      // samples in each direction
constexpr uint32_t kReferenceSlicesPerFrame = 4; // so that no frame hangs
constexpr GpgpAccess kComputeRead = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT,
                                     VK_IMAGE_LAYOUT_UNDEFINED};
constexpr GpgpAccess kArguments = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
                                   VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT,
                                   VK_IMAGE_LAYOUT_UNDEFINED};

Buffer makeWords(Device& device, uint32_t words, VkBufferUsageFlags more = 0) {
  return makeBuffer(device, std::vector<uint32_t>(words), kStorage | more);
}
void barrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkAccessFlags written, VkPipelineStageFlags to,
             VkAccessFlags read) {
  const VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, written, read};
  vkCmdPipelineBarrier(commands, from, to, 0, 1, &memory, 0, nullptr, 0, nullptr);
}
} // namespace

Decoupled::Decoupled(Device& device, Gpgp& gpgp, const Forward& forward, Model model, const DecoupledOptions& options)
    : device_(device), gpgp_(gpgp), model_(std::move(model)), options_(options),
      positions_(makeBuffer(device, model_.positions, kStorage)),
      normals_(makeBuffer(device, model_.normals, kStorage)), indices_(makeBuffer(device, model_.indices, kStorage)),
      draws_(makeBuffer(device, model_.draws, kStorage)), meshes_(makeBuffer(device, model_.meshes, kStorage)),
      records_(makeWords(device, model_.triangleCount * static_cast<uint32_t>(kRecordBytes / 4))),
      found_(makeWords(device, (model_.triangleCount + 31) / 32)), list_(makeWords(device, model_.triangleCount)),
      count_(makeWords(device, 4, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT)),
      sizes_(makeWords(device, model_.triangleCount * 3)),
      standard_(makeWords(device, (model_.triangleCount + 31) / 32)),
      display_(makeWords(device, (model_.triangleCount + 31) / 32)),
      displayCounts_(makeWords(device, model_.triangleCount)),
      referenceBits_(makeWords(device, (model_.triangleCount + 31) / 32)),
      positives_(makeWords(device, (model_.triangleCount + 31) / 32)),
      negatives_(makeWords(device, (model_.triangleCount + 31) / 32)),
      shadeSet_(device, {&positions_, &normals_, &indices_, &draws_, &meshes_, &records_, &list_, &count_},
                VK_SHADER_STAGE_COMPUTE_BIT),
      displaySet_(device,
                  {&positions_, &normals_, &indices_, &draws_, &records_, &found_, &standard_, &positives_, &negatives_,
                   &sizes_},
                  VK_SHADER_STAGE_VERTEX_BIT),
      shadePipeline_(device, {std::begin(mini_shade_comp), std::end(mini_shade_comp)}, shadeSet_.layout, 24) {
  geometry_ = gpgp.geometrySet("shaded model", model_.meshes);
  auto recorderInfo = gpgp::init<GpgpVisibilityRecorderCreateInfo>();
  recorderInfo.base = gpgp.recorder("shading recorder");
  recorderInfo.maxWidth = kMaxExtent.width;
  recorderInfo.maxHeight = kMaxExtent.height;
  recorderInfo.maxDraws = static_cast<uint32_t>(model_.draws.size());
  recorderInfo.maxTriangles = model_.triangleCount;
  recorderInfo.maxCandidates = std::max(model_.triangleCount, 65536u);
  recorderInfo.methods = GPGP_SAMPLING_STANDARD_BIT | GPGP_SAMPLING_EXACT_BIT | GPGP_SAMPLING_CONSERVATIVE_BIT |
                         GPGP_SAMPLING_REFERENCE_BIT;
  recorderInfo.maxSamples = kReferencePerRecord;
  recorder_ = gpgp.take(gpgp::VisibilityRecorder::create(gpgp.context, recorderInfo), "gpgpCreateVisibilityRecorder");
  gpgp.shareScratch(recorder_);
  gpgp.check(recorder_.prewarm(), "gpgpPrewarm");
  PipelineInfo info;
  info.vertex.assign(std::begin(mini_shaded_vert), std::end(mini_shaded_vert));
  info.fragment.assign(std::begin(mini_shaded_frag), std::end(mini_shaded_frag));
  info.setLayout = displaySet_.layout;
  info.pushBytes = 84;
  displayPipeline_ = Pipeline(device, forward.renderPass(), Forward::kSamples, info);
  VkQueryPoolCreateInfo queries{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  queries.queryType = VK_QUERY_TYPE_TIMESTAMP;
  queries.queryCount = kSlots * kTimestamps;
  if (device.properties.limits.timestampComputeAndGraphics)
    check(vkCreateQueryPool(device.device, &queries, nullptr, &queries_), "vkCreateQueryPool");
}

Decoupled::~Decoupled() { vkDestroyQueryPool(device_.device, queries_, nullptr); }

/// Before and after visibility, after shading, before and after the display.
void Decoupled::writeTimestamp(VkCommandBuffer commands, uint32_t query) {
  if (queries_)
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries_, slot_ * kTimestamps + query);
}

/// Of a frame that is finished.
void Decoupled::readTimestamps(uint32_t slot) {
  if (!timed_[slot] || !queries_) return;
  timed_[slot] = false;
  uint64_t timestamps[kTimestamps] = {};
  check(vkGetQueryPoolResults(device_.device, queries_, slot * kTimestamps, kTimestamps, sizeof timestamps, timestamps,
                              8, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
        "vkGetQueryPoolResults");
  const auto between = [&](int from, int to) {
    return static_cast<double>(timestamps[to] - timestamps[from]) * 1e-6 *
           static_cast<double>(device_.properties.limits.timestampPeriod);
  };
  ++times_.displays;
  times_.display += between(3, 4);
  if (!shades_[slot]) return;
  ++times_.shadings;
  times_.visibility += between(0, 1);
  times_.shading += between(1, 2);
}

const Decoupled::Times& Decoupled::times() {
  for (uint32_t slot = 0; slot < kSlots; ++slot) readTimestamps(slot);
  return times_;
}

void Decoupled::sample(VkCommandBuffer commands, const GpgpFrame& frame, GpgpSamplingMethod method,
                       const Camera& camera, VkExtent2D extent, const Buffer& bits, Tag tag, uint32_t slice) {
  auto info = gpgp::init<GpgpVisibilityInfo>();
  info.base.tag = tag;
  info.base.scratch = gpgp_.scratch();
  info.geometrySet = geometry_;
  info.method = method;
  std::copy_n(glm::value_ptr(camera.viewProjection), 16, info.camera.viewProjection);
  info.width = extent.width;
  info.height = extent.height;
  if (method == GPGP_SAMPLING_CONSERVATIVE) {
    info.heuristics = GPGP_HEURISTICS_DEFAULT;
    info.epsilonStatic = info.epsilonDynamic = options_.epsilon;
    info.resolution = options_.resolution;
  }
  if (method == GPGP_SAMPLING_REFERENCE) {
    info.samples = options_.reference;
    info.slice = slice;
    info.accumulate = slice > 0;
  }
  info.positions = positions_.forGpgp(kNoAccess, kNoAccess);
  info.indices = indices_.forGpgp(kNoAccess, kNoAccess);
  info.indexType = VK_INDEX_TYPE_UINT32;
  info.draws = draws_.forGpgp(kNoAccess, kNoAccess);
  info.drawCount = static_cast<uint32_t>(model_.draws.size());
  info.triangleCount = model_.triangleCount;
  info.visibleBits = bits.forGpgp(kVertexShaderRead, kVertexShaderRead);
  if (tag == tagDisplay) info.pixelCounts = displayCounts_.forGpgp(kNoAccess, kNoAccess);
  if (tag == tagShading) {
    info.visibleList = list_.forGpgp(kComputeRead, kComputeRead);
    info.visibleCount = count_.forGpgp(kArguments, kArguments);
    info.triangleSizes = sizes_.forGpgp(kVertexShaderRead, kVertexShaderRead);
  }
  gpgp_.check(recorder_.recordPrepare(commands, frame, info), "gpgpRecordPrepareVisibility");
}

/// What was found against bits of another record.
void Decoupled::compare(VkCommandBuffer commands, const GpgpFrame& frame, const Buffer& reference, Tag tag) {
  auto info = gpgp::init<GpgpVisibilityMetricsInfo>();
  info.base.tag = tag;
  info.base.scratch = gpgp_.scratch();
  info.triangleCount = model_.triangleCount;
  info.visibleBits = found_.forGpgp(kVertexShaderRead, kVertexShaderRead);
  info.referenceBits = reference.forGpgp(kNoAccess, kNoAccess);
  if (tag == tagMisses) info.referenceCounts = displayCounts_.forGpgp(kNoAccess, kNoAccess);
  if (tag == tagReference) {
    info.falsePositives = positives_.forGpgp(kVertexShaderRead, kVertexShaderRead);
    info.falseNegatives = negatives_.forGpgp(kVertexShaderRead, kVertexShaderRead);
  }
  gpgp_.check(recorder_.recordPrepareMetrics(commands, frame, info), "gpgpRecordPrepareVisibilityMetrics");
}

/// Lights what is in the list, by gpgp's own arguments.
void Decoupled::shade(VkCommandBuffer commands) {
  struct {
    glm::vec4 eye;
    uint32_t drawCount, shading;
  } const push{glm::vec4(shadingCamera_.eye, 1), static_cast<uint32_t>(model_.draws.size()), shadings_};
  barrier(commands, VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
          VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, shadePipeline_.handle);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, shadePipeline_.layout, 0, 1, &shadeSet_.handle, 0,
                          nullptr);
  vkCmdPushConstants(commands, shadePipeline_.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, 24, &push);
  vkCmdDispatchIndirect(commands, count_.handle, 4); // visibleCount: the number, then the arguments
  barrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
          VK_PIPELINE_STAGE_VERTEX_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
}

std::pair<uint32_t, uint32_t> Decoupled::referenceSlices() const {
  if (!showsOverlay()) return {0, 0};
  const uint32_t side = std::max(options_.reference / kReferencePerRecord, 1u);
  return {referenceSlice_, side * side + 1};
}

/// Of what was shaded last.
bool Decoupled::isReferenceKnown() const {
  return overlaid_ == shadings_ && referenceSlice_ == referenceSlices().second;
}

/// What standard sampling finds from where it was shaded, and a few slices a frame of what is truly visible from there.
void Decoupled::sampleReference(VkCommandBuffer commands, const GpgpFrame& frame) {
  if (overlaid_ != shadings_) {
    sample(commands, frame, GPGP_SAMPLING_STANDARD, shadingCamera_, shadingExtent_, standard_, tagOther);
    overlaid_ = shadings_;
    referenceSlice_ = 0;
  }
  if (isReferenceKnown()) return;
  for (uint32_t i = 0; i < kReferenceSlicesPerFrame && !isReferenceKnown(); ++i, ++referenceSlice_)
    sample(commands, frame, GPGP_SAMPLING_REFERENCE, shadingCamera_, shadingExtent_, referenceBits_, tagOther,
           referenceSlice_);
  if (isReferenceKnown()) compare(commands, frame, referenceBits_, tagReference);
}

void Decoupled::prepare(VkCommandBuffer commands, const GpgpFrame& frame, const Camera& shading, const Camera& display,
                        VkExtent2D extent) {
  if (step_ >= options_.freezeAfter && step_) frozen_ = true;
  slot_ = static_cast<uint32_t>(frame.current % kSlots);
  readTimestamps(slot_); // the engine has waited for the frame that used it last
  if (queries_) vkCmdResetQueryPool(commands, queries_, slot_ * kTimestamps, kTimestamps);
  const bool waits = showsOverlay() && !isReferenceKnown();
  const bool shades = shadings_ == 0 || (!frozen_ && !waits && step_ % options_.rate == 0);
  shades_[slot_] = shades;
  writeTimestamp(commands, 0);
  if (shades) {
    shadingCamera_ = shading;
    shadingExtent_ = extent;
    ++shadings_;
    sample(commands, frame, options_.method, shading, extent, found_, tagShading);
    writeTimestamp(commands, 1);
    shade(commands);
    writeTimestamp(commands, 2);
  }
  if (!shades) {
    writeTimestamp(commands, 1);
    writeTimestamp(commands, 2);
  }
  sample(commands, frame, GPGP_SAMPLING_STANDARD, display, extent, display_, tagDisplay);
  compare(commands, frame, display_, tagMisses);
  if (showsOverlay()) sampleReference(commands, frame);
  ++step_;
}

void Decoupled::draw(VkCommandBuffer commands, const Camera& display) {
  constexpr uint32_t kOverlayWithoutReference = 3; // of shaded.vert
  struct {
    glm::mat4 viewProjection;
    uint32_t draw, firstIndex, vertexOffset, shading, show;
  } push{display.viewProjection, 0, 0, 0, shadings_, static_cast<uint32_t>(options_.show)};
  if (showsOverlay() && !isReferenceKnown()) push.show = kOverlayWithoutReference;
  writeTimestamp(commands, 3);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, displayPipeline_.handle);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, displayPipeline_.layout, 0, 1, &displaySet_.handle,
                          0, nullptr);
  for (uint32_t i = 0; i < model_.draws.size(); ++i) {
    const GpgpMesh& mesh = model_.meshes[model_.draws[i].mesh];
    push.draw = i;
    push.firstIndex = mesh.firstIndex;
    push.vertexOffset = mesh.vertexOffset;
    vkCmdPushConstants(commands, displayPipeline_.layout, Pipeline::kStages, 0, 84, &push);
    vkCmdDraw(commands, mesh.indexCount, 1, 0, 0);
  }
  writeTimestamp(commands, 4);
  timed_[slot_] = true;
}

/// Whether a recorder that had room for all left some of a pixel's many triangles undecided: they are shown.
static bool isOnlyInDoubt(const GpgpVisibilityReport& report) {
  return report.base.status == GPGP_BUDGET_EXCEEDED && report.unresolved > 0 &&
         report.neededTriangles <= report.maxTriangles && report.neededCandidates <= report.maxCandidates &&
         report.neededPairs <= report.maxPairs;
}

void Decoupled::collect() {
  for (auto next = recorder_.report(); next; next = recorder_.report()) {
    well_ = well_ && (next->base.status == GPGP_SUCCESS || isOnlyInDoubt(*next));
    if (next->base.tag == tagShading) shading_ = *next;
    if (next->base.tag == tagReference) reference_ = *next;
    if (next->base.tag != tagMisses || !next->reference) continue;
    const double missing = 1.0 - static_cast<double>(next->coverageArea);
    ++misses_.displays;
    misses_.pixels += missing;
    misses_.worst = std::max(misses_.worst, missing);
    misses_.triangles += next->falseNegatives;
  }
}

void Decoupled::key(char key) {
  if (key == 'f') {
    frozen_ = !frozen_;
    options_.freezeAfter = UINT32_MAX;
  }
  if (key == 'm')
    options_.method = options_.method == GPGP_SAMPLING_EXACT ? GPGP_SAMPLING_STANDARD : GPGP_SAMPLING_EXACT;
  if (key < '1' || key > '3') return;
  options_.show = static_cast<DecoupledOptions::Show>(key - '1');
}

void Decoupled::restart(GpgpSamplingMethod method, float resolution, float epsilon) {
  options_.resolution = resolution;
  options_.epsilon = epsilon;
  options_.method = method;
  step_ = 0;
  frozen_ = false;
  misses_ = {};
  times();
  times_ = {};
}

} // namespace mini
