// The tests' scenes as the reference by rays reads them.
#pragma once
#include "scenes.h"
#include "visibility/reference/ray_reference.h"

#include <cstring>

namespace gpgp::test {

/// Valid as long as the scene and this are. Positions are three floats each.
class RaySceneOf {
public:
  explicit RaySceneOf(const Scene& scene) {
    for (const shader::Mesh& mesh : scene.meshes)
      meshes_.push_back({mesh.firstIndex, mesh.indexCount, mesh.vertexOffset});
    static_assert(sizeof(GpgpVisibilityDraw) == sizeof(shader::Draw));
    draws_.resize(scene.draws.size());
    if (!draws_.empty()) std::memcpy(draws_.data(), scene.draws.data(), draws_.size() * sizeof(GpgpVisibilityDraw));
    scene_ = {scene.positions, scene.indices, meshes_, draws_, scene.params.triangleCount};
  }
  RaySceneOf(const RaySceneOf&) = delete;
  RaySceneOf& operator=(const RaySceneOf&) = delete;
  operator const visibility::RayScene&() const { return scene_; }

private:
  std::vector<GpgpMesh> meshes_;
  std::vector<GpgpVisibilityDraw> draws_;
  visibility::RayScene scene_;
};

inline GpgpCamera cameraOf(const Scene& scene) {
  GpgpCamera camera{};
  std::memcpy(camera.viewProjection, scene.params.viewProjection, sizeof camera.viewProjection);
  camera.reversedDepth = scene.params.reversedDepth;
  return camera;
}

inline void inOrder(size_t count, const std::function<void(size_t)>& work) {
  for (size_t i = 0; i < count; ++i) work(i);
}

/// What the scene's camera sees by rays.
inline visibility::RayReference rayReference(const RaySceneOf& rays, const Scene& scene, uint32_t samples,
                                             const visibility::ForEach& forEach = inOrder) {
  visibility::RayReference reference(rays, forEach);
  reference.add(cameraOf(scene), scene.params.width, scene.params.height, samples);
  return reference;
}

} // namespace gpgp::test
