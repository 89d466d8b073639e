#include "spawned_scenes.h"

#include "cli/spawn/axioms.h"
#include "cli/tune/deriver.h"
#include "mini_engine/level.h"

#include <cmath>

namespace gpgp::bench {
namespace {

/// One mesh and one draw. The grammar is interpreted: deriving is not what is measured.
void addSpawned(test::Scene& scene, const std::string& grammarFile, const std::vector<GpgpAxiom>& axioms) {
  cli::Session session({});
  const cli::BakedGraph grammar = cli::bakeGraph({grammarFile}, {});
  cli::DeriverOptions options;
  options.vertices = true;
  cli::Deriver deriver(session, grammar, axioms, options);
  const GpgpSpawnReport report = deriver.fit(deriver.prepare(std::pmr::vector<uint32_t>()));
  if (report.droppedShapes || report.verticesWritten < report.vertices)
    throw cli::Failure(grammarFile + ": too large for this device");
  const auto firstVertex = static_cast<uint32_t>(scene.positions.size() / 3);
  const auto firstIndex = static_cast<uint32_t>(scene.indices.size());
  for (const cli::SpawnedVertex& vertex : deriver.vertices())
    scene.positions.insert(scene.positions.end(), vertex.position, vertex.position + 3);
  const std::vector<uint32_t> indices = deriver.indices();
  scene.indices.insert(scene.indices.end(), indices.begin(), indices.end());
  scene.addDraw(scene.addMesh(firstIndex, firstVertex));
}
} // namespace

test::Scene spawnedCity(uint32_t lots) {
  test::Scene scene;
  scene.params.positionStride = 12;
  addSpawned(scene, GPGP_SAMPLE_GRAMMARS "/city.pga", cli::axiomGrid(lots, 0, {.size = {20, 60, 20}, .seed = 1}));
  return scene;
}

test::Scene miniEngineLevel(uint32_t width, uint32_t height) {
  test::Scene scene;
  scene.params.positionStride = 12;
  addSpawned(scene, GPGP_TEST_DATA "/grammars/building.pga", mini::levelAxioms());
  const mini::Model model = mini::levelModel(GPGP_TEST_DATA);
  const auto firstVertex = static_cast<uint32_t>(scene.positions.size() / 3);
  const auto firstIndex = static_cast<uint32_t>(scene.indices.size());
  const auto firstMesh = static_cast<uint32_t>(scene.meshes.size());
  scene.positions.insert(scene.positions.end(), model.positions.begin(), model.positions.end());
  scene.indices.insert(scene.indices.end(), model.indices.begin(), model.indices.end());
  for (const GpgpMesh& mesh : model.meshes)
    scene.meshes.push_back({mesh.firstIndex + firstIndex, mesh.indexCount, mesh.vertexOffset + firstVertex});
  for (const GpgpVisibilityDraw& draw : model.draws) {
    glm::mat4 transform(1.0f);
    for (int i = 0; i < 12; ++i) transform[i % 4][i / 4] = draw.transform[i];
    scene.addDraw(firstMesh + draw.mesh, transform, draw.flags);
  }
  const float angle = 0.24f, distance = 84; // Engine::orbit
  const glm::vec3 eye(std::sin(angle) * distance, 36, std::cos(angle) * distance);
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  scene.setCamera(test::perspective(0.8f, aspect, 1, 900, true) * test::lookAt(eye, {0, 12, 0}), width, height, true);
  return scene;
}

} // namespace gpgp::bench
