#include "town.h"

#include "gpgp_glue.h"
#include "level.h"

#include "shaders/mini_mesh_vert.spv.h"
#include "shaders/mini_town_frag.spv.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace mini {

std::vector<GpgpCgaLot> townLots() {
  constexpr float kSide = 20; // metres, within a block and its streets
  std::vector<GpgpCgaLot> lots;
  for (GpgpAxiom axiom : levelAxioms()) {
    axiom.size[0] = axiom.size[2] = kSide;
    axiom.size[1] = 0;
    axiom.transform[7] = 0;
    lots.push_back({});
    lots.back().axiom = axiom;
  }
  return lots;
}

Town::Town(Device& device, const Forward& forward) : device_(device) {
  using Vertex = TownMesh::Vertex;
  PipelineInfo info;
  info.vertex.assign(std::begin(mini_mesh_vert), std::end(mini_mesh_vert));
  info.fragment.assign(std::begin(mini_town_frag), std::end(mini_town_frag));
  info.bindings = {{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX}};
  info.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
                     {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)},
                     {2, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, colour)}};
  info.pushBytes = 80;
  pipeline_ = Pipeline(device, forward.renderPass(), Forward::kSamples, info);
}

void Town::use(TownMesh mesh, const GpgpFrame& frame) {
  float last[3] = {-1, -1, -1}, linear[3] = {}; // vertices of a leaf follow one another
  for (TownMesh::Vertex& vertex : mesh.vertices) {
    if (!std::equal(last, last + 3, vertex.colour)) {
      std::copy_n(vertex.colour, 3, last);
      for (int i = 0; i < 3; ++i) linear[i] = linearFromSrgb(last[i]);
    }
    std::copy_n(linear, 3, vertex.colour); // as mesh.vert reads them
  }
  Mesh next;
  if (!mesh.indices.empty()) {
    next.vertices = makeBuffer(device_, mesh.vertices, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    next.triangles = makeBuffer(device_, mesh.indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    next.indices = static_cast<uint32_t>(mesh.indices.size());
  }
  shown_.last = frame.current - 1;
  if (shown_.indices) old_.push_back(std::move(shown_));
  shown_ = std::move(next);
  hash_ = mesh.hash;
}

void Town::collect(const GpgpFrame& frame) {
  old_.erase(std::remove_if(old_.begin(), old_.end(), [&](const Mesh& mesh) { return mesh.last <= frame.safe; }),
             old_.end());
}

void Town::draw(VkCommandBuffer commands, const Camera& camera) {
  if (!shown_.indices) return;
  struct {
    glm::mat4 viewProjection;
    glm::vec4 eye;
  } push{camera.viewProjection, camera.eyeAndLight()};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.handle);
  const VkDeviceSize offset = 0;
  vkCmdBindVertexBuffers(commands, 0, 1, &shown_.vertices.handle, &offset);
  vkCmdBindIndexBuffer(commands, shown_.triangles.handle, 0, VK_INDEX_TYPE_UINT32);
  vkCmdPushConstants(commands, pipeline_.layout, Pipeline::kStages, 0, sizeof push, &push);
  vkCmdDrawIndexed(commands, shown_.indices, 1, 0, 0, 0);
}

} // namespace mini
