// Geometry sets and camera histories: the mesh table of an engine's buffers, and the bits that a camera's last
// recording saw.
#pragma once
#include "core/resident.h"

#include <gpgp/visibility.h>

namespace gpgp::visibility {

class GeometrySet final : public core::Resident {
public:
  static core::Result<core::Unique<GeometrySet>> create(core::Context& context, const GpgpGeometrySetCreateInfo& info);
  GeometrySet(core::Context& owner, const char* name) : Resident(owner, core::Kind::geometrySet, name) {}
  uint32_t meshCount() const { return meshCount_; }
  uint32_t clusterCount() const { return clusterCount_; } ///< of 64 triangles, of all meshes

private:
  uint32_t meshCount_ = 0, clusterCount_ = 0;
};

/// One bit per triangle, zero until the camera's first recording; with maxLate three more, and what reuse.h says.
class CameraHistory final : public core::Resident {
public:
  static core::Result<core::Unique<CameraHistory>> create(core::Context& context,
                                                          const GpgpCameraHistoryCreateInfo& info);
  CameraHistory(core::Context& owner, const char* name) : Resident(owner, core::Kind::cameraHistory, name) {}
  uint32_t maxTriangles() const { return maxTriangles_; }
  uint32_t words() const { return (maxTriangles_ + 31) / 32; } ///< of one bit a triangle
  float maxLate() const { return maxLate_; }

private:
  uint32_t maxTriangles_ = 0;
  float maxLate_ = 0;
};

} // namespace gpgp::visibility
