#include "visibility/sampling/budgets.h"

#include "visibility/layout.h"

#include <algorithm>

namespace gpgp::visibility {
namespace {
constexpr uint32_t kMediumRecords = 65536, kLargeRecords = 32768; // at most, and at most a quarter of all triangles
}

Budgets::Budgets(const GpgpSamplerCreateInfo& info, const VkPhysicalDeviceLimits& limits)
    : maxWidth(info.maxWidth ? info.maxWidth : 2048), maxHeight(info.maxHeight ? info.maxHeight : 2048),
      maxCameras(std::max(info.maxCameras, 1u)), maxDraws(info.maxDraws ? info.maxDraws : 65536),
      maxTriangles(info.maxTriangles ? info.maxTriangles : 1u << 22), maxSamples(std::max(info.maxSamples, 1u)),
      methods(info.methods ? info.methods : GPGP_SAMPLING_STANDARD_BIT),
      maxCandidates(info.maxCandidates ? info.maxCandidates : std::max(maxTriangles / 4, 65536u)),
      maxPairs(info.maxPairs ? info.maxPairs
                             : static_cast<uint32_t>(
                                   std::min<uint64_t>((uint64_t(maxWidth) * maxHeight * maxCameras + maxCandidates) * 4,
                                                      limits.maxStorageBufferRange / shader::kPairBytes))) {}

uint64_t Budgets::chunks() const { return uint64_t(maxTriangles) / shader::kChunk + maxDraws + 1; }
uint64_t Budgets::slots() const { return slotsOf(maxWidth, maxHeight * maxCameras); }
uint32_t Budgets::mediumRecords() const { return std::clamp(maxTriangles / 4, 1u, kMediumRecords); }
uint32_t Budgets::largeRecords() const { return std::clamp(maxTriangles / 4, 1u, kLargeRecords); }

uint64_t slotsOf(uint32_t width, uint32_t height) { return uint64_t((width + 7) / 8) * ((height + 7) / 8) * 64; }

} // namespace gpgp::visibility
