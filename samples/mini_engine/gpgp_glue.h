// Between the engine and gpgp: one context, the engine's memory behind it, errors as the engine has them.
#pragma once
#include "device.h"

#include <gpgp/gpgp.hpp>

#include <atomic>
#include <memory>

namespace mini {

/// All device memory that gpgp uses: allocated here, counted here. A larger engine would hand out parts of its blocks.
class EngineMemory {
public:
  explicit EngineMemory(Device& device) : device_(device) {}
  GpgpGpuAllocator callbacks();
  VkDeviceSize bytes() const { return bytes_; }
  uint32_t allocations() const { return allocations_; }

private:
  static VkResult GPGP_CALL allocate(void* user, const GpgpGpuAllocationRequest* request,
                                     GpgpGpuAllocation* allocation);
  static void GPGP_CALL free(void* user, const GpgpGpuAllocation* allocation);
  Device& device_;
  VkDeviceSize bytes_ = 0;
  uint32_t allocations_ = 0;
};

/// All host memory that gpgp uses, counted.
class HostMemory {
public:
  GpgpHostAllocator callbacks();
  uint64_t allocations() const { return allocations_; } ///< so far

private:
  static void* GPGP_CALL allocate(void* user, size_t size, size_t alignment);
  static void GPGP_CALL free(void* user, void* memory, size_t size, size_t alignment);
  std::atomic<uint64_t> allocations_{0};
};

/// The context, made last and destroyed first.
class Gpgp {
public:
  Gpgp(Device& device, uint32_t framesInFlight);
  /// Throws with gpgp's own message where result is an error, and returns it otherwise.
  GpgpResult check(GpgpResult result, const char* what);
  /// The same for what creates something.
  template <class T> T take(gpgp::Result<T> result, const char* what) {
    check(result.code(), what);
    return std::move(*result);
  }
  GpgpRecorderCreateInfo recorder(const char* label) const;
  /// Recordings of a frame run one after another, so all recorders share one scratch buffer, as large as the largest
  /// needs. Every recorder is announced before the first recording.
  void shareScratch(const gpgp::Recorder& recorder);
  GpgpBuffer scratch();
  VkDeviceSize scratchBytes() const { return scratchSize_.size; }
  /// Compiles an SVG; where the file is not there, says so and gives nothing.
  gpgp::Drawing loadSvg(const std::string& file, const char* label);
  gpgp::GeometrySet geometrySet(const char* label, const std::vector<GpgpMesh>& meshes);

  EngineMemory memory;
  HostMemory hostMemory;
  gpgp::Context context;

private:
  static void GPGP_CALL onMessage(void* user, const GpgpMessage* message);
  Device& device_;
  std::string lastError_;
  gpgp::ScratchSize scratchSize_{};
  Buffer scratch_;
};

/// The engine's uses of buffers that gpgp fills.
constexpr GpgpAccess kNoAccess = {0, 0, VK_IMAGE_LAYOUT_UNDEFINED};
constexpr GpgpAccess kVertexInput = {VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT, VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT,
                                     VK_IMAGE_LAYOUT_UNDEFINED};
constexpr GpgpAccess kIndirect = {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT,
                                  VK_IMAGE_LAYOUT_UNDEFINED};
constexpr GpgpAccess kVertexShaderRead = {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT,
                                          VK_IMAGE_LAYOUT_UNDEFINED};

std::vector<char> readFile(const std::string& path);
bool fileExists(const std::string& path);
float linearFromSrgb(float v); ///< 0 to 1

} // namespace mini
