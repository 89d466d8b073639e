// The triangles that the service itself makes of a shape (shaders/spawn/mesh.h), in a graph of regular polygons alone.
#include "cli/unit_shapes.h"

#include "spawn/graph/blob.h"
#include "spawn/graph/export_labels.h"
#include "spawn/mesh.h"

namespace gpgp::cli {

glm::vec3 placed(const GpgpInstance& instance, const glm::vec3& p) {
  const float* m = instance.transform;
  return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
          m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
}

std::vector<glm::vec3> unitShape(GpgpShape shape) {
  using namespace shader;
  if (shape == kShapeDynamicConvexPolygon || shape == kShapeDynamicPolygon) shape = kShapeQuad;
  if (shape == kShapeDynamicConvexRightPrism || shape == kShapeDynamicRightPrism) shape = kShapeBox;
  spawn::Graph graph(std::pmr::new_delete_resource());
  spawn::addRegularPolygons(graph);
  const auto words = spawn::serialize(graph, std::pmr::new_delete_resource());
  const uint32_t geometry = shape | spawn::usualPolygon(shape) << 8;
  std::vector<glm::vec3> triangles;
  for (uint32_t quad = 0; quad < meshQuads(words.data(), geometry); ++quad)
    for (const uint32_t half : {0u, 3u}) {
      glm::vec3 corners[3];
      for (uint32_t i = 0; i < 3; ++i)
        corners[i] = meshVertex(words.data(), geometry, quad, quadIndex(half + i)).position;
      const glm::vec3 area = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
      if (glm::dot(area, area) > 1e-12f) triangles.insert(triangles.end(), corners, corners + 3);
    }
  return triangles;
}

} // namespace gpgp::cli
