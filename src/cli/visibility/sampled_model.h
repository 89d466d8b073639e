// A model on the device, and what samples it.
#pragma once
#include "cli/model/model.h"
#include "cli/shared/session.h"
#include "cli/visibility/options.h"
#include "cli/visibility/views.h"

namespace gpgp::cli {

/// Textures of a model's alpha tests on the device.
class AlphaTestTextures {
public:
  AlphaTestTextures(host::HeadlessDevice& device, const std::vector<AlphaTexture>& textures);
  ~AlphaTestTextures();
  AlphaTestTextures(const AlphaTestTextures&) = delete;
  AlphaTestTextures& operator=(const AlphaTestTextures&) = delete;
  const std::vector<GpgpAlphaTest>& tests() const { return tests_; }

private:
  host::HeadlessDevice& device_;
  std::vector<host::Image> images_;
  std::vector<VkSampler> samplers_;
  std::vector<GpgpAlphaTest> tests_;
};

class SampledModel {
public:
  /// The options and the model must outlive it.
  SampledModel(Session& session, const VisibilityOptions& options, const Model& model);

  /// largest: of its viewports; 0: the options' size.
  VisibilityRecorder recorder(GpgpSamplingMethod method, uint32_t maxSamples, Size largest = {});
  /// Of the exact method's recorders.
  uint32_t maxCandidates() const;
  uint32_t maxPairs(Size largest) const;

  struct Step {
    GpgpSamplingMethod method = GPGP_SAMPLING_STANDARD;
    View view;
    Size size; ///< of the viewport; 0: the options'
    uint32_t samples = 0, slice = 0, repeat = 1;
    bool accumulate = false, sizes = false;
    GpgpHistory history = nullptr;
    const char* label = "sampling";
  };
  Measured<GpgpVisibilityReport> sample(VisibilityRecorder& recorder, const Step& step);
  std::vector<uint32_t> bits() { return host::download<uint32_t>(session_.device(), bits_, words_); }
  /// What an atlas recording needs of the last sampling; pairs: with draws and indices.
  void describe(GpgpAtlasInfo& info, bool pairs) const;
  std::vector<uint32_t> sizes() { return host::download<uint32_t>(session_.device(), sizes_, model_.triangleCount); }

  /// How far what was found agrees with a reference; recheck may be empty.
  GpgpVisibilityReport compare(VisibilityRecorder& recorder, const std::vector<uint32_t>& found,
                               const std::vector<uint32_t>& reference, const std::vector<uint32_t>& areas,
                               const std::vector<uint32_t>& recheck);

  /// The reference with samples x samples a pixel and the centre, for the union of views; sizes() has its areas
  /// afterwards. `told` hears how many of how many slices are done.
  std::vector<uint32_t> reference(const std::vector<View>& views, uint32_t samples,
                                  const std::function<void(uint64_t, uint64_t)>& told);

private:
  Session& session_;
  const VisibilityOptions& options_;
  const Model& model_;
  uint32_t words_;
  GeometrySet geometry_;
  host::Buffer positions_, indices_, draws_, bits_, sizes_, list_, count_;
  host::Buffer coordinates_; // of alpha tests
  AlphaTestTextures textures_;
  uint32_t nonOpaque_ = 0;     // triangles of alpha-tested and see-through draws
  host::Buffer triangleSizes_; // with options.atlas
};

} // namespace gpgp::cli
