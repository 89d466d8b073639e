#include "visibility/reference/ray_scene.h"

#include <algorithm>
#include <cmath>

namespace gpgp::visibility {

RayTriangles::RayTriangles(const RayScene& scene) : scene_(scene), first_{0} {
  for (const GpgpVisibilityDraw& draw : scene.draws) {
    const size_t triangles = draw.mesh < scene.meshes.size() ? scene.meshes[draw.mesh].indexCount / 3 : 0;
    first_.push_back(first_.back() + triangles);
  }
}

RayTriangles::Triangle RayTriangles::at(size_t place) const {
  const auto next = std::upper_bound(first_.begin(), first_.end(), place);
  const auto drawNumber = static_cast<size_t>(next - first_.begin()) - 1;
  const GpgpVisibilityDraw& draw = scene_.draws[drawNumber];
  const GpgpMesh& mesh = scene_.meshes[draw.mesh];
  const size_t local = place - first_[drawNumber];
  const float* m = draw.transform;
  Triangle triangle;
  triangle.number = draw.firstTriangle + static_cast<uint32_t>(local);
  triangle.flags = draw.flags;
  const auto row = [m](int i) { return glm::dvec3(m[i * 4], m[i * 4 + 1], m[i * 4 + 2]); };
  triangle.turned = glm::dot(row(0), glm::cross(row(1), row(2))) < 0;
  triangle.usable = triangle.number < scene_.triangleCount && !(draw.flags & GPGP_DRAW_DISABLED);
  double largest = 0;
  for (size_t i = 0; i < 3; ++i) {
    const size_t index = mesh.firstIndex + local * 3 + i;
    const size_t vertex = index < scene_.indices.size() ? size_t{scene_.indices[index]} + mesh.vertexOffset : SIZE_MAX;
    if (vertex >= scene_.positions.size() / 3) {
      triangle.usable = false;
      return triangle;
    }
    if (vertex * 2 + 1 < scene_.coordinates.size())
      triangle.coordinates[i] = {scene_.coordinates[vertex * 2], scene_.coordinates[vertex * 2 + 1]};
    const float* p = &scene_.positions[vertex * 3];
    for (int axis = 0; axis < 3; ++axis) {
      const glm::dvec3 r = row(axis);
      const double at = r.x * p[0] + r.y * p[1] + r.z * p[2] + m[axis * 4 + 3];
      triangle.corners[i][axis] = at;
      triangle.usable = triangle.usable && std::abs(at) < 0x1p100;
      largest = std::max({largest, std::abs(r.x * p[0]) + std::abs(r.y * p[1]) + std::abs(r.z * p[2]), std::abs(at)});
    }
  }
  triangle.rounding = largest * 0x1p-22; // two roundings in each of three directions
  return triangle;
}

} // namespace gpgp::visibility
