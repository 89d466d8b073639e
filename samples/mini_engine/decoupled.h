// Object-space shading (section 6.2 of the thesis): the triangles that gpgp finds visible from one pose are lit in
// compute, into a record each; the records are displayed from other poses, more often than they are made. What a
// display shows without a record is a disocclusion. Shading can be frozen, to walk around what was shaded.
#pragma once
#include "buffer_set.h"
#include "forward.h"
#include "gpgp_glue.h"
#include "scene.h"

#include <optional>
#include <utility>

namespace mini {

struct DecoupledOptions {
  bool on = false;
  GpgpSamplingMethod method = GPGP_SAMPLING_EXACT;
  float resolution = 1, epsilon = 0.05f; ///< of the conservative method: factor, static and dynamic alike
  uint32_t rate = 4;                     ///< displayed frames for one of shading
  uint32_t freezeAfter = UINT32_MAX;     ///< frames after which shading stops
  uint32_t reference = 16;               ///< overlay: N x N samples a pixel
  float farther = 1;                     ///< how many times farther away than the display's camera the shading's is
  /// An overlay's shading waits for the reference of the one before it.
  enum Show { shaded, overlay, density } show = shaded;
};

class Decoupled {
public:
  Decoupled(Device& device, Gpgp& gpgp, const Forward& forward, Model model, const DecoupledOptions& options);
  ~Decoupled();
  Decoupled(const Decoupled&) = delete;
  Decoupled& operator=(const Decoupled&) = delete;

  /// Finds and shades from one camera, where it is time to; measures what the other will miss.
  void prepare(VkCommandBuffer commands, const GpgpFrame& frame, const Camera& shading, const Camera& display,
               VkExtent2D extent);
  void draw(VkCommandBuffer commands, const Camera& display);
  void collect();
  /// F: freeze; M: method; 1, 2, 3: what is shown.
  void key(char key);
  /// The path begins again.
  void restart(GpgpSamplingMethod method, float resolution, float epsilon);

  struct Misses { ///< of the displays since the last restart
    uint32_t displays = 0, triangles = 0;
    double pixels = 0, worst = 0; ///< shares of the model's pixels: mean (once divided by displays) and largest
  };
  const Misses& misses() const { return misses_; }
  struct Times { ///< GPU milliseconds since the last restart, sums; the device must be idle
    uint32_t shadings = 0, displays = 0;
    double visibility = 0, shading = 0, display = 0;
  };
  const Times& times();
  const GpgpVisibilityReport& shadingReport() const { return shading_; }
  uint32_t shadings() const { return shadings_; }
  /// Against the last reference of which all slices are there; false positives are not sampled again.
  const std::optional<GpgpVisibilityReport>& referenceReport() const { return reference_; }
  /// An overlay's slices that are there, and how many there will be; 0 of 0: none is shown.
  std::pair<uint32_t, uint32_t> referenceSlices() const;
  bool allWell() const { return well_ && misses_.displays > 0; }

private:
  enum Tag : uint64_t { tagShading, tagDisplay, tagMisses, tagReference, tagOther };
  void sample(VkCommandBuffer commands, const GpgpFrame& frame, GpgpSamplingMethod method, const Camera& camera,
              VkExtent2D extent, const Buffer& bits, Tag tag, uint32_t slice = 0);
  void compare(VkCommandBuffer commands, const GpgpFrame& frame, const Buffer& reference, Tag tag);
  void shade(VkCommandBuffer commands);
  void writeTimestamp(VkCommandBuffer commands, uint32_t query);
  void readTimestamps(uint32_t slot);
  bool showsOverlay() const { return options_.show == DecoupledOptions::overlay; }
  bool isReferenceKnown() const;
  void sampleReference(VkCommandBuffer commands, const GpgpFrame& frame);

  Device& device_;
  Gpgp& gpgp_;
  Model model_;
  DecoupledOptions options_;
  Buffer positions_, normals_, indices_, draws_, meshes_;
  Buffer records_, found_, list_, count_, sizes_;
  Buffer standard_, display_, displayCounts_, referenceBits_, positives_, negatives_;
  gpgp::GeometrySet geometry_;
  gpgp::VisibilityRecorder recorder_;
  BufferSet shadeSet_, displaySet_;
  ComputePipeline shadePipeline_;
  Pipeline displayPipeline_;
  Camera shadingCamera_;
  VkExtent2D shadingExtent_{};
  uint32_t step_ = 0, shadings_ = 0;
  uint32_t overlaid_ = 0, referenceSlice_ = 0; ///< the shading that the overlay is of, and its next slice
  bool frozen_ = false, well_ = true;
  static constexpr uint32_t kSlots = 2, kTimestamps = 5; ///< frames in flight; timestamps of a frame
  VkQueryPool queries_ = VK_NULL_HANDLE;
  bool timed_[kSlots] = {}, shades_[kSlots] = {};
  uint32_t slot_ = 0;
  Misses misses_;
  Times times_;
  GpgpVisibilityReport shading_{};
  std::optional<GpgpVisibilityReport> reference_;
};

} // namespace mini
