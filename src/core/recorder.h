// Recorders: pipelines, rings and scratch for one pass list, and the one function that records it.
//
// A service derives from Recorder, describes its passes in the constructor path (init), and for each recording fills a
// Record: engine buffers by resource, constants, workgroup counts. Recording allocates nothing.
#pragma once
#include "core/context.h"
#include "core/passes.h"

#include <atomic>

namespace gpgp::core {

constexpr uint32_t kMaxResources = 44;
constexpr uint32_t kMaxGroupCounts = 20;
constexpr uint32_t kMaxConditions = 56;
constexpr uint32_t kMaxTargets = 16;
constexpr uint32_t kMaxDrawForms = 2;

/// What one recording gives for the resources of kinds buffer and image.
struct Binding {
  const GpgpBuffer* engineBuffer = nullptr; ///< with before/after states
  std::span<const std::byte> hostData;      ///< copied while recording, at most Resource::bytes
  VkBuffer ownBuffer = VK_NULL_HANDLE;      ///< an asset's or history's
  VkDeviceSize ownOffset = 0, ownSize = VK_WHOLE_SIZE;
  const GpgpImage* image = nullptr;
  VkDescriptorImageInfo texture = {}; ///< imageView NULL: left out
  const char* name = nullptr;         ///< what this recording calls it in messages; null: the resource's name
  uint32_t scratch = UINT32_MAX;      ///< a scratch resource that takes its place
};

/// One dispatch of a pass whose dispatches each recording lists (Pass::stepped).
struct Step {
  uint32_t pass;
  std::array<uint32_t, 3> groups;
  uint32_t constant;      ///< push constant
  uint32_t alongside = 0; ///< 1: it touches nothing that those since the last barrier do, and needs none
};

struct Record {
  VkCommandBuffer commandBuffer = VK_NULL_HANDLE;
  const GpgpRecordingInfo* info = nullptr;
  std::array<Binding, kMaxResources> bindings = {};
  std::array<std::array<uint32_t, 3>, kMaxGroupCounts> groups = {};
  std::array<bool, kMaxConditions> conditions = {};
  uint32_t levels = UINT32_MAX;                              ///< passes of this level and above are left out
  std::array<std::span<const std::byte>, 11> constants = {}; ///< for the first constants resource, in a row
  uint32_t replacedShader = UINT32_MAX; ///< passes with this shader run another pipeline of the same layout
  VkPipeline replacement = VK_NULL_HANDLE;
  std::span<const Step> steps; ///< in order, behind barriers; recorded where the first stepped pass lies
  /// Where textures come in pages: all of them, those of the list again and again; their bindings are then not looked
  /// at. Passes that are not paged have the first page.
  std::span<const VkDescriptorImageInfo> pages;
  std::span<const uint32_t> pageConstants; ///< one a page
  bool reports = false; ///< its passes write the whole report to the resource of that kind: nothing is copied
  /// Nothing is to be done: no pass is recorded, images go from the engine's state before to the one after, and the
  /// report's words are 0.
  bool nothing = false;
  std::array<uint32_t, 4> note = {}; ///< returned with the report
  uint32_t readBackBytes = 0;        ///< of PassList::readBack, a multiple of 8; 0: none
};

struct DrawRecord {
  VkCommandBuffer commandBuffer = VK_NULL_HANDLE;
  std::array<Binding, kMaxResources> bindings = {};
  const GpgpTargetInfo* target = nullptr;
  std::span<const std::byte> pushConstants; ///< at most 128 bytes
  uint32_t vertexCount = 0, instanceCount = 1;
  uint32_t form = 0; ///< which of the DrawShaders that init was given
};

/// A report as it came from the GPU.
struct RawReport {
  GpgpReportHeader header{}; ///< status SUCCESS or NOT_EXECUTED
  std::span<const uint32_t> words;
  std::array<uint32_t, 4> note = {};   ///< Record::note
  std::span<const std::byte> readBack; ///< Record::readBackBytes; none of what was not executed
};

/// Whether a pipeline made for one target can draw into the other.
inline bool sameTarget(const GpgpTargetInfo& a, const GpgpTargetInfo& b) {
  return a.renderPass == b.renderPass && a.subpass == b.subpass && a.viewMask == b.viewMask &&
         a.colorFormat == b.colorFormat && a.depthFormat == b.depthFormat && a.samples == b.samples &&
         a.depthTest == b.depthTest && (!a.depthTest || a.depthCompare == b.depthCompare);
}

/// A barrier between the engine's use of buffers and fills of gpgp: before those (entry), or after them.
void recordFillBarrier(const Device& device, VkCommandBuffer commandBuffer, const GpgpAccess& use, bool entry);

class Recorder : public Object {
public:
  ~Recorder() override;
  void retire() override;

  bool ready() const { return ready_.load(std::memory_order_acquire); }
  Result<void> prewarm(const GpgpPrewarmInfo* info);
  const PassList& passes() const { return passes_; }
  VkDeviceSize scratchBytes() const { return passes_.scratchBytes; }
  VkDeviceSize scratchAlignment() const;
  static constexpr VkBufferUsageFlags kScratchUsage =
      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
      VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
  bool engineScratch() const { return engineScratch_; }

  /// Checks what all services check (frame, scratch, timestamps, sizes, states); changes nothing. Call before record.
  Result<void> check(const Record& record) const;
  /// Records the pass list. TOO_MANY_RECORDS where the rings are used up; nothing is recorded then.
  Result<void> record(const Record& record);
  Result<void> recordDraw(const DrawRecord& record);

  /// Of the compute shaders, then of each target's draws. Throws std::bad_alloc.
  std::pmr::vector<GpgpPipelineInfo> pipelines() const;

  // For tools.
  /// Whether the last recording ran a pass.
  bool ran(uint32_t pass) const { return ran_[pass]; }
  /// Recordings copy the whole scratch to a buffer behind a pass that they run; no buffer: none does.
  struct Inspection {
    uint32_t pass = 0;
    VkBuffer target = VK_NULL_HANDLE; ///< of scratchBytes
  };
  void inspect(const Inspection& inspection) { inspection_ = inspection; }

  /// Whether a thread is using it (RecorderUse).
  std::atomic<bool> busy{false};

  /// The oldest report not yet taken, if any. What it refers to is valid until the next advance.
  bool takeReport(RawReport& report);

  void advance();
  Recorder* nextRecorder() const { return nextRecorder_; }

protected:
  /// A report has come, which takeReport() will return unless too many others follow. (context)
  virtual void harvested(const RawReport&) {}
  /// Where the next recording's constants will lie, for parts of Record::constants to be written in place: those are
  /// not copied. Memory that is slow to read. Null where record() has no room.
  std::byte* constants() const;
  Recorder(Context& context, Kind kind, const GpgpRecorderCreateInfo& info, GpgpService service);
  /// Takes the finished description and makes what recording needs. Call once at the end of creation.
  /// Specialisation constant 0 of each is how many samples the target has.
  struct DrawShaders {
    ShaderDesc vertex, fragment;
    ShaderDesc multiviewVertex, multiviewFragment; ///< for targets with a view mask, of views 0 and 1
  };
  /// draws: the forms that a draw comes in, at most kMaxDrawForms.
  Result<void> init(PassList passes, std::span<const DrawShaders> draws = {});
  /// A pipeline that stands in for the pass list's shader `place` (Record::replacement). Other recorders of the class
  /// take it as well where that shader has ShaderDesc::bindings.
  Result<VkPipeline> createComputePipeline(const ShaderDesc& shader, uint32_t place) const;
  /// Of a shader of the pass list, once prewarmed.
  VkPipeline pipelineOf(uint32_t shader) const { return pipelines_[shader]; }

private:
  struct InFlight { // one recording in flight
    uint64_t frame = 0;
    uint64_t tag = 0;
    uint32_t marker = 0;                 ///< what the GPU will have written; 0: free
    bool report = false, counts = false; ///< counts: the report has words
    uint32_t readBackBytes = 0;
    std::array<uint32_t, 4> note = {};
  };
  /// Descriptors that shaders share. All shaders are in one group, unless the device has fewer storage buffers a stage
  /// than the recorder has: then shaders are together as far as what they bind fits.
  struct BindingGroup {
    uint64_t resources = 0; ///< a bit each
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
  };
  struct Target {
    GpgpTargetInfo info;
    std::array<VkPipeline, kMaxDrawForms> pipelines;
    std::array<float, kMaxDrawForms> times; ///< milliseconds that these took
  };

  Result<uint32_t> acquire() const;
  void take(uint32_t slot, uint64_t tag, bool report, uint32_t readBackBytes = 0);
  void recordNothing(const Record& record, uint32_t slot) const;
  VkShaderStageFlags shaderStages() const {
    return VK_SHADER_STAGE_COMPUTE_BIT |
           (draws_ ? VkShaderStageFlags(VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT) : 0);
  }
  Result<void> groupBindings(uint32_t formCount);
  Result<void> createLayouts();
  Result<void> createSets(uint32_t slotCount);
  /// Of the groups from `first` on.
  void writeDescriptors(uint32_t slot, uint32_t first, uint32_t groupCount,
                        const std::array<Binding, kMaxResources>& bindings, VkBuffer scratch,
                        VkDeviceSize scratchOffset, bool reports) const;
  VkDescriptorSet setOf(uint32_t slot, uint32_t group) const { return sets_[slot * groups_.size() + group]; }
  Result<VkPipeline> createDrawPipeline(uint32_t form, const GpgpTargetInfo& target) const;
  Result<VkShaderModule> createModule(const ShaderDesc& shader) const;
  void beginLabel(VkCommandBuffer commandBuffer, const char* pass) const;
  void endLabel(VkCommandBuffer commandBuffer) const;
  void edgeBarrier(const Record& record, bool entry) const;

  const GpgpService service_;
  const uint32_t queueFamily_;
  VkQueueFlags queueFlags_;
  const bool engineScratch_;
  PassList passes_;
  std::array<DrawShaders, kMaxDrawForms> draw_{};
  uint32_t drawForms_ = 0;
  bool draws_ = false;
  std::pmr::vector<BindingGroup> groups_; // of shaders, then of draws that have groups of their own
  uint32_t computeGroups_ = 0;            // of groups_
  std::pmr::vector<uint8_t> groupOf_;     // by shader
  std::array<uint8_t, kMaxDrawForms> groupOfDraw_ = {};
  VkDescriptorSetLayout textureLayout_ = VK_NULL_HANDLE;
  uint32_t firstTexture_ = 0, textureCount_ = 0; // textures lie in a row
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  std::pmr::vector<VkDescriptorSet> sets_, textureSets_; // sets_: by slot and group; the last are never written
  std::pmr::vector<VkPipeline> pipelines_;               // by shader; filled by prewarm
  std::pmr::vector<float> pipelineTimes_;                // milliseconds that these took
  std::array<Target, kMaxTargets> targets_ = {};
  std::atomic<uint32_t> targetCount_{0};
  std::atomic<bool> ready_{false};
  Buffer scratch_, constants_, reports_;
  VkDeviceSize reportStride_ = 0;
  static constexpr VkDeviceSize kMarkerBytes = 16;
  VkDeviceSize readBackAt() const { return passes_.reportBytes + kMarkerBytes; } // in a slot of reports_
  static constexpr VkDeviceSize kUnusedBytes = 256;
  VkDeviceSize unusedOffset_ = 0; ///< behind the constants: what recordings leave out and passes could write
  std::pmr::vector<InFlight> slots_;
  std::pmr::vector<uint8_t> ran_;        // by pass
  std::pmr::vector<uint32_t> harvested_; // words of harvested reports, as many as queue_ has places
  std::pmr::vector<uint64_t> readBacks_; // what came behind them
  std::pmr::vector<RawReport> queue_;    // ring of harvested reports
  size_t queueHead_ = 0, queueCount_ = 0;
  uint32_t nextMarker_ = 1;
  bool losesReports_ = false; ///< said, until a report is taken
  Inspection inspection_;
  std::atomic<bool> prewarming_{false};
  void unlink();
  uint32_t timestampBits_ = 0; // of the queue family
  Recorder *previousRecorder_ = nullptr, *nextRecorder_ = nullptr;
  bool linked_ = false;
};

/// One thread's use of a recorder; false where another thread is using it. Costs an exchange and a store.
class RecorderUse {
public:
  explicit RecorderUse(Recorder& recorder)
      : recorder_(recorder.busy.exchange(true, std::memory_order_acquire) ? nullptr : &recorder) {}
  ~RecorderUse() {
    if (recorder_) recorder_->busy.store(false, std::memory_order_release);
  }
  RecorderUse(const RecorderUse&) = delete;
  RecorderUse& operator=(const RecorderUse&) = delete;
  explicit operator bool() const { return recorder_ != nullptr; }
  static Error error() {
    return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                     "two threads use the recorder at once; each thread that records needs a recorder of its own");
  }

private:
  Recorder* recorder_;
};

} // namespace gpgp::core
