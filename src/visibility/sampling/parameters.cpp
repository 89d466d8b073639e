#include "visibility/sampling/parameters.h"

#include "visibility/conservative/conservative.h"
#include "visibility/sampling/passes.h"
#include "visibility/view_cell.h"

#include <algorithm>
#include <bit>
#include <cstddef>

namespace gpgp::visibility {
using shader::Params;

static_assert(sizeof(GpgpMesh) == sizeof(shader::Mesh) && sizeof(GpgpVisibilityDraw) == sizeof(shader::Draw));
static_assert(offsetof(GpgpVisibilityDraw, flags) == offsetof(shader::Draw, flags) &&
              offsetof(GpgpVisibilityDraw, origin) == offsetof(shader::Draw, origin));
static_assert(GPGP_DRAW_TWO_SIDED == shader::kTwoSided && GPGP_DRAW_CLOCKWISE == shader::kClockwise &&
              GPGP_DRAW_SEE_THROUGH == shader::kSeeThrough && GPGP_DRAW_DISABLED == shader::kDisabled);
static_assert(GPGP_DRAW_ALPHA_TEST(shader::kMaxAlphaTests - 1) == shader::kMaxAlphaTests << 8 &&
              GPGP_DRAW_LAYERS(1) == 1u << 16);
static_assert(GPGP_SAMPLING_EXACT == shader::kExact && GPGP_SAMPLING_CONSERVATIVE == shader::kConservative &&
              GPGP_SAMPLING_NEARBY == shader::kNearby);
static_assert(GPGP_HEURISTIC_IN_CIRCLE == shader::kInCircle && GPGP_HEURISTIC_DEPTH == shader::kDepths &&
              GPGP_HEURISTIC_KEEP_FRONT == shader::kKeepFront);

namespace {
constexpr uint32_t kReferenceSamples = 64;

/// Vertices that a range holds, the last one without its padding; size: of what is read of each.
uint32_t verticesIn(VkDeviceSize bytes, uint32_t offset, uint32_t size, uint32_t stride) {
  const uint64_t first = uint64_t(offset) + size;
  return bytes < first ? 0 : static_cast<uint32_t>(std::min<VkDeviceSize>((bytes - first) / stride + 1, UINT32_MAX));
}

/// Writes what floats hold of three numbers, and the rest.
void splitOrigin(const double* origin, float* parts) {
  for (int i = 0; i < 3; ++i) {
    parts[i] = static_cast<float>(origin[i]);
    parts[i + 4] = static_cast<float>(origin[i] - static_cast<double>(parts[i]));
  }
}

void setOrigins(const GpgpVisibilityInfo& info, Params& params) {
  params.originCount = info.originCount;
  params.hasOrigins = info.originCount ? 1 : 0;
  for (uint32_t i = 0; i < info.originCount; ++i)
    splitOrigin(info.origins + size_t(i) * 3, params.origins + size_t(i) * 8);
  for (uint32_t i = 0; i <= info.moreCameraCount; ++i) {
    const double* origin = i ? info.moreCameras[i - 1].origin : info.camera.origin;
    if (origin[0] != 0 || origin[1] != 0 || origin[2] != 0) params.hasOrigins = 1;
    splitOrigin(origin, params.cameraOrigins + size_t(i) * 8);
  }
}

void setAlphaTests(const GpgpVisibilityInfo& info, Params& params) {
  for (uint32_t i = 0; i <= info.moreCameraCount; ++i) {
    const uint32_t layers = (i ? info.moreCameras[i - 1] : info.camera).layerMask & 0xffffu;
    params.cameraLayers[i] = layers;
    params.allLayers = i && (!layers || !params.allLayers) ? 0 : params.allLayers | layers;
  }
  params.alphaTestCount = info.alphaTestCount;
  for (uint32_t i = 0; i < info.alphaTestCount; ++i) {
    params.alphaTests[i * 2] = info.alphaTests[i].cutoff;
    params.alphaTests[i * 2 + 1] = info.alphaTests[i].level;
  }
  if (!info.alphaTestCount) return;
  const PositionFormat format = textureFormatOf(info.textureCoordinateFormat);
  params.textureFormat = format.kind;
  params.textureOffset = info.textureCoordinateOffset;
  params.textureStride = info.textureCoordinateStride ? info.textureCoordinateStride : format.bytes * 2;
  params.textureCount =
      verticesIn(info.textureCoordinates.size, params.textureOffset, format.bytes * 2, params.textureStride);
}

/// A recording of several cameras, or one that adds to others, decides all: the history has one decision a triangle.
void setReuse(const GpgpVisibilityInfo& info, const Budgets& budgets, const CameraHistory* history, Params& params) {
  if (!history || history->maxLate() <= 0) return;
  params.keepsDecisions = 1;
  params.maxLate = history->maxLate();
  params.reuse = info.method == GPGP_SAMPLING_EXACT && !info.moreCameraCount && !info.accumulate && info.reach <= 0;
  uint32_t key = 2166136261u;
  for (const uint32_t part :
       {info.width, info.height, info.camera.reversedDepth ? 1u : 0u, info.triangleCount, info.alphaTestCount,
        budgets.maxTriangles, budgets.maxCandidates, budgets.maxPairs, budgets.maxNonOpaque})
    key = (key ^ part) * 16777619u;
  params.reuseKey = key;
}

/// Where the recording's samples lie in a pixel.
void setGrid(const GpgpVisibilityInfo& info, const Budgets& budgets, Params& params) {
  const uint32_t samples = samplesOf(info), perRecord = std::min(samples, budgets.maxSamples),
                 perSide = samples / perRecord;
  const bool centre = info.method == GPGP_SAMPLING_REFERENCE && info.slice == perSide * perSide;
  const uint32_t spacing = 256 / (centre ? 1 : perRecord), part = centre ? 256 : 256 / samples;
  params.gridShift = static_cast<uint32_t>(std::countr_zero(spacing));
  params.gridX = (centre ? 0 : info.slice % perSide) * part + part / 2;
  params.gridY = (centre ? 0 : info.slice / perSide) * part + part / 2;
  if (info.method != GPGP_SAMPLING_REFERENCE) params.gridX = params.gridY = spacing / 2;
}
} // namespace

PositionFormat positionFormatOf(VkFormat format) {
  switch (format) {
  case VK_FORMAT_UNDEFINED:
  case VK_FORMAT_R32G32B32_SFLOAT:
  case VK_FORMAT_R32G32B32A32_SFLOAT: return {shader::kFloats, 4};
  case VK_FORMAT_R16G16B16_SFLOAT:
  case VK_FORMAT_R16G16B16A16_SFLOAT: return {shader::kHalves, 2};
  case VK_FORMAT_R16G16B16_SNORM:
  case VK_FORMAT_R16G16B16A16_SNORM: return {shader::kSnorms, 2};
  default: return {};
  }
}

PositionFormat textureFormatOf(VkFormat format) {
  switch (format) {
  case VK_FORMAT_UNDEFINED:
  case VK_FORMAT_R32G32_SFLOAT: return {shader::kFloats, 4};
  case VK_FORMAT_R16G16_SFLOAT: return {shader::kHalves, 2};
  case VK_FORMAT_R16G16_UNORM: return {shader::kUnorms, 2};
  default: return {};
  }
}

uint32_t samplesOf(const GpgpVisibilityInfo& info) {
  if (info.method != GPGP_SAMPLING_STANDARD && info.method != GPGP_SAMPLING_REFERENCE) return 1;
  return info.samples ? info.samples : info.method == GPGP_SAMPLING_REFERENCE ? kReferenceSamples : 1;
}

Params parametersOf(const GpgpVisibilityInfo& info, const Budgets& budgets, const GeometrySet& geometry,
                    const CameraHistory* history) {
  Params params{};
  const uint32_t cameras = info.moreCameraCount + 1;
  for (uint32_t i = 0; i < cameras; ++i) {
    const GpgpCamera& camera = i ? info.moreCameras[i - 1] : info.camera;
    std::copy_n(camera.viewProjection, 16, params.viewProjection + size_t(i) * 16);
    const bool reaches = info.method == GPGP_SAMPLING_EXACT && info.reach > 0;
    if (info.method != GPGP_SAMPLING_NEARBY && !reaches) continue;
    const glm::vec4 scale = depthScale(camera, info.width, info.height, info.reach);
    for (int k = 0; k < 4; ++k) params.depthScales[i * 4 + static_cast<uint32_t>(k)] = scale[k];
  }
  setOrigins(info, params);
  setAlphaTests(info, params);
  params.maxNonOpaque = budgets.maxNonOpaque;
  params.nonOpaqueAt = static_cast<uint32_t>(budgets.nonOpaqueAt());
  params.cameraCount = cameras;
  params.width = info.width;
  params.height = info.height;
  if (info.method == GPGP_SAMPLING_CONSERVATIVE) {
    const auto part = [&](uint32_t pixels) {
      const float scaled = static_cast<float>(pixels) * (info.resolution != 0 ? info.resolution : 1.0f);
      return std::max(static_cast<uint32_t>(scaled + 0.5f), 1u);
    };
    params.width = part(info.width);
    params.height = part(info.height);
    params.heuristics = info.heuristics;
    params.epsilonStatic = info.epsilonStatic;
    params.epsilonDynamic = info.epsilonDynamic;
  }
  params.pixelCapacity = budgets.maxWidth * budgets.maxHeight * budgets.maxCameras;
  params.reversedDepth = info.camera.reversedDepth ? 1 : 0;
  params.drawCount = info.drawCount;
  params.meshCount = geometry.meshCount();
  params.triangleCount = info.triangleCount;
  params.maxItems = budgets.maxTriangles;
  params.maxEntries = budgets.maxDraws;
  params.hasCommands = info.commands.buffer ? 1 : 0;
  params.hasDrawCount = info.drawCountBuffer.buffer ? 1 : 0;
  params.entryCount = info.drawCount * cameras;
  if (params.hasCommands) {
    params.commandCount = info.commandCount;
    params.commandWords = (info.commandStride ? info.commandStride : kCommandBytes) / 4;
    params.entryCount = budgets.maxDraws / cameras * cameras;
  }
  if (info.clusters.buffer && info.drawCount) params.clusterCount = geometry.clusterCount();
  if (params.hasCommands && info.triangleNumbers.buffer) {
    params.hasNumbers = 1;
    params.numberCount = static_cast<uint32_t>(std::min<VkDeviceSize>(info.triangleNumbers.size / 4, UINT32_MAX));
  }
  if (info.drawCount) {
    const PositionFormat format = positionFormatOf(info.positionFormat);
    const uint32_t stride = info.positionStride ? info.positionStride : format.bytes * 3;
    params.shortIndices = info.indexType == VK_INDEX_TYPE_UINT16 ? 1 : 0;
    params.indexCount = static_cast<uint32_t>(info.indices.size / (params.shortIndices ? 2 : 4));
    params.vertexCount = verticesIn(info.positions.size, info.positionOffset, format.bytes * 3, stride);
    params.positionFormat = format.kind;
    params.positionOffset = info.positionOffset;
    params.positionStride = stride;
  }
  params.hasList = info.visibleList.buffer ? 1 : 0;
  params.listCapacity =
      params.hasList ? static_cast<uint32_t>(std::min<VkDeviceSize>(info.visibleList.size / 4, UINT32_MAX)) : 0;
  if (info.changedList.buffer) {
    params.hasList |= 2;
    params.changedCapacity =
        static_cast<uint32_t>(std::min<VkDeviceSize>(info.changedList.size / 4 - shader::kChangedHeader, UINT32_MAX));
  }
  params.writeCount = !info.visibleCount.buffer ? 0 : info.drawCommands.buffer ? 2 : 1;
  const auto room = [](const GpgpBuffer& buffer, uint32_t bytes) {
    return buffer.buffer ? static_cast<uint32_t>(std::min<VkDeviceSize>(buffer.size / bytes, UINT32_MAX)) : UINT32_MAX;
  };
  params.drawCommandCapacity = room(info.drawCommands, kCommandBytes);
  params.drawListCapacity = std::min(room(info.drawIndices, 12), room(info.drawTriangles, 4));
  params.hasDrawIndices = info.drawIndices.buffer ? 1 : 0;
  params.hasDrawTriangles = info.drawTriangles.buffer ? 1 : 0;
  params.hasExtents = info.triangleSizes.buffer ? 1 : 0;
  params.slotCapacity = static_cast<uint32_t>(budgets.slots());
  params.viewWords = history ? history->words() : 0;
  setReuse(info, budgets, history, params);
  params.mediumRecords = budgets.mediumRecords();
  params.largeRecords = budgets.largeRecords();
  setGrid(info, budgets, params);
  params.accumulate = info.accumulate ? 1 : 0;
  params.hasSizes = info.pixelCounts.buffer ? 1 : 0;
  params.method = static_cast<uint32_t>(info.method);
  params.maxCandidates = budgets.maxCandidates;
  params.maxLargeCandidates = kMaxLargeCandidates;
  params.maxPairs = budgets.maxPairs;
  return params;
}

} // namespace gpgp::visibility
