// What creation copies: a mesh table as bytes to upload, or a size to clear.
#include "visibility/geometry_set.h"

#include "visibility/reuse/reuse.h"
#include "visibility/shared/layout.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace gpgp::visibility {

core::Result<core::Unique<GeometrySet>> GeometrySet::create(core::Context& context,
                                                            const GpgpGeometrySetCreateInfo& info) {
  for (uint32_t i = 0; i < info.meshCount; ++i) {
    const GpgpMesh& mesh = info.meshes[i];
    if (mesh.indexCount % 3)
      return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "meshes[%u].indexCount is %u; expected a multiple of 3", i,
                             mesh.indexCount);
    if (mesh.firstIndex > UINT32_MAX - mesh.indexCount)
      return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "meshes[%u]: firstIndex + indexCount exceeds 32 bits", i);
  }
  auto set = core::makeUnique<GeometrySet>(context.host(), context, info.label);
  set->meshCount_ = info.meshCount;
  // The table as the engine wrote it: GpgpMesh is what the shaders read. Behind it each mesh's first cluster. An empty
  // one still needs a buffer to bind.
  const size_t table = size_t(info.meshCount) * sizeof(GpgpMesh);
  std::pmr::vector<std::byte> bytes(table + size_t(info.meshCount) * 4, &context.host());
  if (info.meshCount) std::memcpy(bytes.data(), info.meshes, table);
  uint64_t clusters = 0;
  for (uint32_t i = 0; i < info.meshCount; ++i) {
    const auto first = static_cast<uint32_t>(clusters);
    std::memcpy(bytes.data() + table + size_t(i) * 4, &first, 4);
    const uint32_t triangles = info.meshes[i].indexCount / 3;
    clusters += triangles / shader::kChunk + (triangles % shader::kChunk != 0);
  }
  // No buffer holds so many clusters: a recording that names one for them is refused.
  set->clusterCount_ = static_cast<uint32_t>(std::min<uint64_t>(clusters, UINT32_MAX));
  if (auto ok = set->makeResident(GPGP_SERVICE_VISIBILITY, std::move(bytes), sizeof(GpgpMesh)); !ok) return ok.error();
  return set;
}

core::Result<core::Unique<CameraHistory>> CameraHistory::create(core::Context& context,
                                                                const GpgpCameraHistoryCreateInfo& info) {
  if (info.maxTriangles > 1u << 31)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxTriangles is %u; at most 2147483648", info.maxTriangles);
  if (info.maxLate != 0 && !(info.maxLate >= 0.0001f && info.maxLate <= 0.05f))
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxLate is %g; expected 0, or 0.0001 to 0.05",
                           static_cast<double>(info.maxLate));
  auto view = core::makeUnique<CameraHistory>(context.host(), context, info.label);
  view->maxTriangles_ = info.maxTriangles ? info.maxTriangles : 1u << 22;
  view->maxLate_ = info.maxLate;
  VkDeviceSize words = view->words();
  if (info.maxLate != 0) words = words * shader::kReuseArrays + shader::kStateWords;
  std::pmr::vector<std::byte> none(&context.host());
  if (auto ok = view->makeResident(GPGP_SERVICE_VISIBILITY, std::move(none), words * 4); !ok) return ok.error();
  return view;
}

} // namespace gpgp::visibility
