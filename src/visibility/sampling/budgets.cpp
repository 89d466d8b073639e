#include "visibility/sampling/budgets.h"

#include "visibility/shared/layout.h"

#include <algorithm>

namespace gpgp::visibility {
namespace {
// At most, for four cameras, and no more than a quarter of all triangles unless that is fewer than a quarter of these:
// a few triangles seen through many cameras are many.
constexpr uint32_t kMediumRecords = 65536, kLargeRecords = 32768;
uint32_t recordsOf(uint32_t maxTriangles, uint32_t most, uint32_t shares) {
  return std::clamp(maxTriangles / 4, most / 4, most * shares);
}
} // namespace

Budgets::Budgets(const GpgpVisibilityRecorderCreateInfo& info, const VkPhysicalDeviceLimits& limits)
    : maxWidth(info.maxWidth ? info.maxWidth : 2048), maxHeight(info.maxHeight ? info.maxHeight : 2048),
      maxCameras(std::max(info.maxCameras, 1u)), maxDraws(info.maxDraws ? info.maxDraws : 65536),
      maxTriangles(info.maxTriangles ? info.maxTriangles : 1u << 22), maxSamples(std::max(info.maxSamples, 1u)),
      methods(info.methods ? info.methods : GPGP_SAMPLING_STANDARD_BIT),
      maxCandidates(info.maxCandidates ? info.maxCandidates : std::max(maxTriangles / 4, 65536u)),
      maxPairs(info.maxPairs ? info.maxPairs
                             : static_cast<uint32_t>(
                                   std::min<uint64_t>((uint64_t(maxWidth) * maxHeight * maxCameras + maxCandidates) * 4,
                                                      limits.maxStorageBufferRange / shader::kPairBytes))),
      maxNonOpaque(std::min(info.maxNonOpaque, maxTriangles)),
      recordShares(std::max(
          std::min(maxCameras / 4, limits.maxStorageBufferRange / kRecordBytes / (kMediumRecords + kLargeRecords)),
          1u)) {}

uint64_t Budgets::chunks() const { return uint64_t(maxTriangles) / shader::kChunk + maxDraws + 1; }
uint64_t Budgets::nonOpaqueAt() const { return uint64_t(maxTriangles) * (methods & GPGP_SAMPLING_EXACT_BIT ? 2 : 1); }
uint64_t Budgets::slots() const { return slotsOf(maxWidth, maxHeight) * maxCameras; }
uint32_t Budgets::mediumRecords() const { return recordsOf(maxTriangles, kMediumRecords, recordShares); }
uint32_t Budgets::largeRecords() const { return recordsOf(maxTriangles, kLargeRecords, recordShares); }

uint64_t slotsOf(uint32_t width, uint32_t height) { return uint64_t((width + 7) / 8) * ((height + 7) / 8) * 64; }

} // namespace gpgp::visibility
