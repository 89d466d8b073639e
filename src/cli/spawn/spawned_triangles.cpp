#include "cli/spawn/spawned_triangles.h"

#include "cli/spawn/unit_shapes.h"

namespace gpgp::cli {

void addTriangles(Triangles& all, const std::vector<GpgpInstance>& instances) {
  std::vector<UnitShape> shapes;
  for (uint32_t shape = 0; shape <= GPGP_SHAPE_SPHERE; ++shape) shapes.push_back(unitShape(shape));
  for (const GpgpInstance& instance : instances) {
    const bool isOwn = instance.shape > GPGP_SHAPE_SPHERE; // a form of its own
    const UnitShape own = isOwn ? unitShape(instance.shape) : UnitShape();
    const UnitShape& shape = isOwn ? own : shapes[instance.shape];
    if (!all.keep) {
      all.count(instance.terminal, shape.triangles.size());
      continue;
    }
    const bool mirrored = isMirrored(instance);
    const auto at = [&](uint32_t vertex) { return placed(instance, shape.vertices[vertex].position); };
    for (const auto& [a, b, c] : shape.triangles)
      all.add({at(a), at(mirrored ? c : b), at(mirrored ? b : c)}, instance.terminal);
  }
}

void addTriangles(Triangles& all, const std::vector<SpawnedVertex>& vertices, const std::vector<uint32_t>& indices) {
  const auto at = [&](size_t i) {
    const float* p = vertices.at(indices[i]).position;
    return glm::vec3(p[0], p[1], p[2]);
  };
  for (size_t i = 0; i + 2 < indices.size(); i += 3) {
    const std::array corners = {at(i), at(i + 1), at(i + 2)};
    // Quads of polygons with an odd number of corners end in a triangle without area, which nobody sees.
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
      all.add(corners, vertices[indices[i]].terminal);
  }
}

} // namespace gpgp::cli
