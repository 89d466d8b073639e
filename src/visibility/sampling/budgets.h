// What a recorder was made for, and the room that follows from it.
#pragma once
#include <gpgp/visibility.h>

namespace gpgp::visibility {

constexpr uint32_t kRecordBytes = 80; // TriangleRecord of records.glsl

struct Budgets {
  uint32_t maxWidth, maxHeight, maxCameras, maxDraws, maxTriangles, maxSamples;
  uint32_t methods; // GPGP_SAMPLING_..._BIT
  uint32_t maxCandidates, maxPairs;
  uint32_t maxNonOpaque; // triangles of alpha-tested and see-through draws
  uint32_t recordShares; // of records: one for four cameras, as many as the device binds

  /// Zeros mean the defaults of gpgp/visibility.h.
  Budgets(const GpgpVisibilityRecorderCreateInfo& info, const VkPhysicalDeviceLimits& limits);

  uint64_t pixels() const { return uint64_t(maxWidth) * maxHeight * maxCameras; }
  uint64_t nonOpaqueAt() const;   ///< words of the queue before those
  uint64_t chunks() const;        ///< of shader::kChunk triangles
  uint64_t slots() const;         ///< pixels in whole tiles of 8 x 8
  uint32_t mediumRecords() const; ///< triangles that are made once for both phases; more are made again by each
  uint32_t largeRecords() const;  ///< workgroup that draws them
};

/// Pixels in whole tiles of 8 x 8.
uint64_t slotsOf(uint32_t width, uint32_t height);

} // namespace gpgp::visibility
