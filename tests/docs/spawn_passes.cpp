#include "pass_lists.h"
#include "spawn/passes/builder.h"

namespace gpgp::test {
namespace {
spawn::SpawnerSizes sizesOf(bool vertices, bool colliders) {
  spawn::SpawnerSizes sizes;
  sizes.maxShapes = sizes.maxTerminals = sizes.maxHostAxioms = 1 << 16;
  sizes.maxColliders = colliders ? 4096 : 0;
  sizes.rounds = 4;
  sizes.ordered = true;
  sizes.maxMeasuredAxioms = vertices ? 0 : 64;
  if (vertices) sizes.layout.strideWords = 8;
  return sizes;
}
} // namespace

core::PassList spawnPasses(bool vertices) {
  return spawn::describePasses(sizesOf(vertices, true), deviceOf(false), std::pmr::get_default_resource()).list;
}
core::ShaderDesc interpreterOf(bool software, bool subgroups, bool colliders) {
  core::Device device = deviceOf(software);
  device.subgroupArithmetic = subgroups;
  if (!subgroups) device.subgroupSize = 0;
  const auto passes = spawn::describePasses(sizesOf(false, colliders), device, std::pmr::get_default_resource());
  return passes.list.shaders[colliders ? passes.deriveColliding : passes.derive];
}

} // namespace gpgp::test
