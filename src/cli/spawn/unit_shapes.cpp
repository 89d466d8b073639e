// By shaders/spawn/outputs/mesh.h, in a graph of regular polygons alone.
#include "cli/spawn/unit_shapes.h"

#include "spawn/graph/blob.h"
#include "spawn/graph/export_labels.h"
#include "spawn/outputs/mesh.h"

namespace gpgp::cli {
namespace {
glm::mat3 matrixOf(const GpgpInstance& instance) {
  const float* m = instance.transform;
  return {m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]}; // by columns
}
/// Zero stays zero.
glm::vec3 unitLength(const glm::vec3& v) {
  const float length = glm::length(v);
  return length > 0 ? v / length : v;
}
} // namespace

bool isMirrored(const GpgpInstance& instance) { return glm::determinant(matrixOf(instance)) < 0; }

glm::vec3 placed(const GpgpInstance& instance, const glm::vec3& p) {
  const float* m = instance.transform;
  return matrixOf(instance) * p + glm::vec3(m[3], m[7], m[11]);
}

UnitVertex placed(const GpgpInstance& instance, const UnitVertex& vertex) {
  // The cofactors, which are the inverse transposed but for a factor, exist for flat shapes as well.
  const glm::mat3 m = matrixOf(instance);
  const glm::mat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  const glm::vec3 normal = unitLength(cofactors * vertex.normal);
  return {placed(instance, vertex.position), isMirrored(instance) ? -normal : normal, vertex.uv};
}

UnitShape unitShape(GpgpShape shape) {
  using namespace shader;
  if (shape == kShapeDynamicConvexPolygon || shape == kShapeDynamicPolygon) shape = kShapeQuad;
  if (shape == kShapeDynamicConvexRightPrism || shape == kShapeDynamicRightPrism) shape = kShapeBox;
  std::pmr::vector<uint32_t> words(std::pmr::new_delete_resource());
  uint32_t geometry = shape; // of roofs and trapezoids all that there is
  if (shape <= kShapeSphere) {
    spawn::Graph graph(std::pmr::new_delete_resource());
    spawn::addRegularPolygons(graph);
    words = spawn::serialize(graph, std::pmr::new_delete_resource());
    geometry |= spawn::usualPolygon(shape) << 8;
  }
  UnitShape result;
  for (uint32_t quad = 0; quad < meshQuads(words.data(), geometry); ++quad) {
    const uint32_t first = 4 * quad;
    for (uint32_t corner = 0; corner < 4; ++corner) {
      const MeshVertex v = meshVertex(words.data(), geometry, quad, corner);
      result.vertices.push_back({v.position, unitLength(glm::cross(v.along, v.up)), v.uv});
    }
    for (const uint32_t half : {0u, 3u}) {
      const std::array<uint32_t, 3> triangle = {first + quadIndex(half), first + quadIndex(half + 1),
                                                first + quadIndex(half + 2)};
      const auto at = [&](int i) { return result.vertices[triangle[size_t(i)]].position; };
      const glm::vec3 area = glm::cross(at(1) - at(0), at(2) - at(0));
      if (glm::dot(area, area) > 1e-12f) result.triangles.push_back(triangle);
    }
  }
  return result;
}

} // namespace gpgp::cli
