#include "visibility/sampling/checks.h"

#include "visibility/sampling/parameters.h"
#include "visibility/sampling/passes.h"
#include "visibility/view_cell.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace gpgp::visibility {
using core::makeError;
using core::Result;

Result<void> checkCreateInfo(const GpgpVisibilityRecorderCreateInfo& info) {
  if (info.maxWidth > 8192 || info.maxHeight > 8192)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxWidth x maxHeight is %u x %u; at most 8192 x 8192", info.maxWidth,
                     info.maxHeight);
  if (info.maxCameras > shader::kMaxCameras)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxCameras is %u; at most %u", info.maxCameras, shader::kMaxCameras);
  if (info.maxTriangles > 1u << 30)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxTriangles is %u; at most 1073741824", info.maxTriangles);
  if (info.maxSamples > 64 || (info.maxSamples & (info.maxSamples - 1)))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxSamples is %u; expected a power of two up to 64",
                     info.maxSamples);
  if (info.methods & ~(GPGP_SAMPLING_STANDARD_BIT | GPGP_SAMPLING_EXACT_BIT | GPGP_SAMPLING_REFERENCE_BIT |
                       GPGP_SAMPLING_CONSERVATIVE_BIT | GPGP_SAMPLING_NEARBY_BIT))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "methods is 0x%x; it has unknown bits", info.methods);
  return {};
}

namespace {

bool isFinite(const GpgpCamera& camera) {
  return std::all_of(std::begin(camera.viewProjection), std::end(camera.viewProjection),
                     [](float v) { return std::isfinite(v); });
}
Result<void> checkCameras(const GpgpVisibilityInfo& info) {
  if (!isFinite(info.camera))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "camera.viewProjection holds a number that is not finite");
  for (uint32_t i = 0; i < info.moreCameraCount; ++i)
    if (!isFinite(info.moreCameras[i]))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "moreCameras[%u].viewProjection holds a number that is not finite",
                       i);
  return {};
}

bool isOrigin(const double* origin) {
  return std::all_of(origin, origin + 3, [](double v) { return v > -1e30 && v < 1e30; });
}

Result<void> checkOrigins(const GpgpVisibilityInfo& info) {
  if (info.originCount > shader::kMaxOrigins)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "originCount is %u; at most %u", info.originCount,
                     shader::kMaxOrigins);
  if (info.originCount && !info.origins)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "origins is NULL, but originCount is %u", info.originCount);
  for (uint32_t i = 0; i < info.originCount; ++i)
    if (!isOrigin(info.origins + size_t(i) * 3))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "origins[%u] is not finite, or reaches 1e30", i);
  for (uint32_t i = 0; i <= info.moreCameraCount; ++i)
    if (!isOrigin(i ? info.moreCameras[i - 1].origin : info.camera.origin))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "the origin of camera %u is not finite, or reaches 1e30", i);
  return {};
}

/// Of all cameras' viewports, which lie below each other: coordinates to 1/8192 pixel, of triangles that reach three
/// viewports beyond, then stay below 2^31.
constexpr uint32_t kMostFineRows = (1u << 18) - 4 * 8192;

/// The viewport, the method and its settings, cameras, counts.
Result<void> checkSampling(const GpgpVisibilityInfo& info, const Budgets& budgets, const CameraHistory* history) {
  if (info.width == 0 || info.height == 0 || info.width > budgets.maxWidth || info.height > budgets.maxHeight)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "the viewport is %u x %u; the recorder was made for 1 x 1 to %u x %u",
                     info.width, info.height, budgets.maxWidth, budgets.maxHeight);
  const uint32_t method = info.method < 0 || info.method > 31 ? 0 : 1u << info.method;
  if (!(budgets.methods & method))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "method is %d; the recorder was made for methods 0x%x", info.method,
                     budgets.methods);
  const uint32_t samples = samplesOf(info), perSide = samples / std::min(samples, budgets.maxSamples);
  if (!std::has_single_bit(samples) || samples > 256)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "samples is %u; expected a power of two up to 256", samples);
  if (info.method == GPGP_SAMPLING_STANDARD && samples > budgets.maxSamples)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "samples is %u; the recorder was made for %u", samples,
                     budgets.maxSamples);
  if (info.method == GPGP_SAMPLING_REFERENCE && info.slice > perSide * perSide)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "slice is %u; %u samples are taken in slices 0 to %u", info.slice,
                     samples, perSide * perSide);
  const uint32_t cameras = info.moreCameraCount < budgets.maxCameras ? info.moreCameraCount + 1 : 0;
  if (!cameras)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "moreCameraCount is %u; the recorder was made for %u cameras in all",
                     info.moreCameraCount, budgets.maxCameras);
  if (info.method == GPGP_SAMPLING_EXACT && uint64_t(info.height) * cameras > kMostFineRows)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "height is %u for %u cameras; exact sampling has %u rows in all",
                     info.height, cameras, kMostFineRows);
  if (auto ok = checkCameras(info); !ok) return ok;
  for (uint32_t i = 0; i < info.moreCameraCount; ++i)
    if (!info.moreCameras[i].reversedDepth != !info.camera.reversedDepth)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "moreCameras[%u].reversedDepth is not the first camera's", i);
  const bool commands = info.commands.buffer && info.commandCount;
  if (!commands && uint64_t(info.drawCount) * cameras > budgets.maxDraws)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "drawCount is %u for %u cameras; the recorder was made for %u",
                     info.drawCount, cameras, budgets.maxDraws);
  if (commands && info.commandCount > budgets.maxDraws)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "commandCount is %u; the recorder was made for %u", info.commandCount,
                     budgets.maxDraws);
  if (commands && cameras > budgets.maxDraws)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "there are %u cameras; the recorder was made for %u draws of all",
                     cameras, budgets.maxDraws);
  if (info.method == GPGP_SAMPLING_CONSERVATIVE) {
    if (info.resolution != 0 && !(info.resolution >= 0.25f && info.resolution <= 1))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "resolution is %g; expected 0.25 to 1",
                       static_cast<double>(info.resolution));
    if (info.heuristics & ~(GPGP_HEURISTICS_DEFAULT | GPGP_HEURISTIC_KEEP_FRONT))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "heuristics is 0x%x; it has unknown bits", info.heuristics);
    if (!(info.epsilonStatic >= 0 && info.epsilonStatic < 1e30f && info.epsilonDynamic >= 0 &&
          info.epsilonDynamic < 1e30f))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "epsilonStatic, epsilonDynamic are %g, %g; expected 0 to 1e30",
                       static_cast<double>(info.epsilonStatic), static_cast<double>(info.epsilonDynamic));
    if (info.refinements > kMaxRefinements)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "refinements is %u; at most %u", info.refinements, kMaxRefinements);
  }
  if (info.method == GPGP_SAMPLING_NEARBY || info.method == GPGP_SAMPLING_EXACT) {
    if (!(info.reach >= 0 && info.reach < 1e30f))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "reach is %g; expected 0 to 1e30", static_cast<double>(info.reach));
    const bool needed = info.method == GPGP_SAMPLING_NEARBY || info.reach > 0;
    for (uint32_t i = 0; i < cameras; ++i)
      if (needed && depthScale(i ? info.moreCameras[i - 1] : info.camera, info.width, info.height, info.reach).y == 0)
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "camera %u has no perspective, which a reach needs", i);
  }
  if (info.triangleCount > 1u << 31)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "triangleCount is %u; at most 2147483648", info.triangleCount);
  if (history && info.triangleCount > history->maxTriangles())
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "triangleCount is %u; the history was made for %u",
                     info.triangleCount, history->maxTriangles());
  return {};
}

/// Geometry and draws.
Result<void> checkInput(const GpgpVisibilityInfo& info) {
  if (info.indexType != VK_INDEX_TYPE_UINT16 && info.indexType != VK_INDEX_TYPE_UINT32)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "indexType is %d; expected UINT16 or UINT32", info.indexType);
  const uint32_t number = positionFormatOf(info.positionFormat).bytes;
  if (!number)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "positionFormat is %d; expected three floats, halves or snorm16",
                     info.positionFormat);
  if (info.positionStride % number || (info.positionStride && info.positionStride < number * 3))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "positionStride is %u; expected a multiple of %u from %u on",
                     info.positionStride, number, number * 3);
  if (info.positionOffset % number)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "positionOffset is %u; expected a multiple of %u",
                     info.positionOffset, number);
  if (info.drawCount) {
    if (auto ok = checkSize("draws", info.draws, uint64_t(info.drawCount) * sizeof(GpgpVisibilityDraw), "drawCount");
        !ok)
      return ok;
    if (auto ok = checkSize("positions", info.positions, 4, "a vertex"); !ok) return ok;
    if (auto ok = checkSize("indices", info.indices, 4, "an index"); !ok) return ok;
    if (number == 2 && info.positions.size % 4)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "positions.size is %llu; expected a multiple of 4",
                       static_cast<unsigned long long>(info.positions.size));
    if (info.indices.size % 4)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "indices.size is %llu; expected a multiple of 4",
                       static_cast<unsigned long long>(info.indices.size));
  }
  if (info.commands.buffer) {
    const uint32_t stride = info.commandStride ? info.commandStride : kCommandBytes;
    if (stride % 4 || stride < kCommandBytes)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "commandStride is %u; expected a multiple of 4 from 20 on",
                       info.commandStride);
    if (info.commandCount)
      if (auto ok = checkSize("commands", info.commands, uint64_t(info.commandCount - 1) * stride + kCommandBytes,
                              "commandCount");
          !ok)
        return ok;
  }
  if (info.clusters.buffer && info.commands.buffer)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "clusters and commands are given; clusters are of meshes");
  if (info.triangleNumbers.buffer && !info.commands.buffer)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "triangleNumbers is given, but commands is not");
  if (info.triangleNumbers.buffer)
    if (auto ok = checkSize("triangleNumbers", info.triangleNumbers, 4, "a number"); !ok) return ok;
  if (info.drawCountBuffer.buffer)
    if (auto ok = checkSize("drawCountBuffer", info.drawCountBuffer, 4, "the number of draws"); !ok) return ok;
  return {};
}

/// Textures, and where triangles lie on them.
Result<void> checkAlphaTests(const GpgpVisibilityInfo& info, const Budgets& budgets) {
  if (!info.alphaTestCount) return {};
  if (info.alphaTestCount > shader::kMaxAlphaTests)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "alphaTestCount is %u; at most %u", info.alphaTestCount,
                     shader::kMaxAlphaTests);
  if (!info.alphaTests)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "alphaTests is NULL, but alphaTestCount is %u", info.alphaTestCount);
  if (!budgets.maxNonOpaque)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "alphaTestCount is %u, but the recorder was made with maxNonOpaque 0",
                     info.alphaTestCount);
  for (uint32_t i = 0; i < info.alphaTestCount; ++i) {
    const GpgpAlphaTest& test = info.alphaTests[i];
    if (!test.view) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "alphaTests[%u].view is NULL", i);
    if (!test.sampler) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "alphaTests[%u].sampler is NULL", i);
    if (test.layout == VK_IMAGE_LAYOUT_UNDEFINED)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "alphaTests[%u].layout is UNDEFINED: nothing could be found there",
                       i);
    if (!(test.cutoff > -1e30f && test.cutoff < 1e30f && test.level >= 0 && test.level <= 32))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                       "alphaTests[%u].cutoff, level are %g, %g; expected finite, and 0 to 32", i,
                       static_cast<double>(test.cutoff), static_cast<double>(test.level));
  }
  const uint32_t number = textureFormatOf(info.textureCoordinateFormat).bytes;
  if (!number)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                     "textureCoordinateFormat is %d; expected two floats, halves or unorm16",
                     info.textureCoordinateFormat);
  if (info.textureCoordinateStride % number ||
      (info.textureCoordinateStride && info.textureCoordinateStride < number * 2))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "textureCoordinateStride is %u; expected a multiple of %u from %u on",
                     info.textureCoordinateStride, number, number * 2);
  if (info.textureCoordinateOffset % number)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "textureCoordinateOffset is %u; expected a multiple of %u",
                     info.textureCoordinateOffset, number);
  if (auto ok = checkSize("textureCoordinates", info.textureCoordinates, 4, "a vertex"); !ok) return ok;
  if (info.textureCoordinates.size % 4)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "textureCoordinates.size is %llu; expected a multiple of 4",
                     static_cast<unsigned long long>(info.textureCoordinates.size));
  return {};
}

/// Bits, lists and commands.
Result<void> checkOutput(const GpgpVisibilityInfo& info, const CameraHistory* history) {
  if (info.drawCommands.buffer) {
    const bool counted = info.commands.buffer || info.drawCountBuffer.buffer;
    const uint64_t needed = counted ? 1 : std::max(info.drawCount, 1u);
    if (auto ok = checkSize("drawCommands", info.drawCommands, needed * kCommandBytes, "drawCount"); !ok) return ok;
  }
  if (info.drawIndices.buffer)
    if (auto ok = checkSize("drawIndices", info.drawIndices, 12, "one triangle"); !ok) return ok;
  if (info.drawTriangles.buffer)
    if (auto ok = checkSize("drawTriangles", info.drawTriangles, 4, "one triangle"); !ok) return ok;
  if (info.triangleSizes.buffer)
    if (auto ok = checkSize("triangleSizes", info.triangleSizes,
                            std::max(info.triangleCount, 1u) * uint64_t(sizeof(GpgpTriangleSize)), "triangleCount");
        !ok)
      return ok;
  if (info.triangleCount)
    if (auto ok =
            checkSize("visibleBits", info.visibleBits, (uint64_t(info.triangleCount) + 31) / 32 * 4, "triangleCount");
        !ok)
      return ok;
  if (info.pixelCounts.buffer)
    if (auto ok = checkSize("pixelCounts", info.pixelCounts, std::max<uint64_t>(uint64_t(info.triangleCount) * 4, 4),
                            "triangleCount");
        !ok)
      return ok;
  if (info.visibleList.buffer)
    if (auto ok = checkSize("visibleList", info.visibleList, 4, "one triangle"); !ok) return ok;
  if (info.changedList.buffer && !history)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "changedList is given, but history is not");
  if (info.changedList.buffer)
    if (auto ok = checkSize("changedList", info.changedList, 16, "the counts"); !ok) return ok;
  if (info.visibleCount.buffer)
    if (auto ok = checkSize("visibleCount", info.visibleCount, info.drawCommands.buffer ? 20 : 16,
                            "the count and the arguments");
        !ok)
      return ok;
  return {};
}
} // namespace

Result<void> checkSize(const char* name, const GpgpBuffer& buffer, uint64_t needed, const char* why) {
  if (!buffer.buffer) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.buffer is NULL", name);
  if (buffer.size < needed)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.size is %llu; %s needs %llu", name,
                     static_cast<unsigned long long>(buffer.size), why, static_cast<unsigned long long>(needed));
  return {};
}

Result<void> checkSampleInfo(const GpgpVisibilityInfo& info, const Budgets& budgets, const CameraHistory* history) {
  if (auto ok = checkSampling(info, budgets, history); !ok) return ok;
  if (auto ok = checkInput(info); !ok) return ok;
  if (auto ok = checkOrigins(info); !ok) return ok;
  if (auto ok = checkAlphaTests(info, budgets); !ok) return ok;
  return checkOutput(info, history);
}

} // namespace gpgp::visibility
