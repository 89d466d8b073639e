#include "spawn/passes/builder.h"

#include "spawn/outputs/measure.h"
#include "spawn/shared/shape.h"

#include <gpgp/spawn.h>

#include <algorithm>
#include <bit>

namespace gpgp::spawn {
using enum core::ResourceKind;

namespace {
constexpr VkDeviceSize kShapeBytes = 16 * shader::kShapePlanes;
} // namespace

uint32_t SpawnerSizes::stackShapes() const { return std::max(4 * maxShapes, 65536u); }
uint32_t SpawnerSizes::cells() const { return std::bit_ceil(2 * maxColliders); }

PassBuilder::PassBuilder(const SpawnerSizes& spawner, const core::Device& owner, std::pmr::memory_resource* memory)
    : list(memory), sizes(spawner), device(owner), subgroups(owner.subgroupArithmetic) {
  list.add({"grammar", buffer});
  list.add({"axioms", buffer, sizeof(GpgpAxiom) * VkDeviceSize(sizes.maxHostAxioms), true});
  list.add({"instances", buffer, 0, true});
  list.add({"draws", buffer, 0, true});
  list.add({"count", buffer, 0, true});
  list.add({"queues", scratch, (sizes.maxColliders ? 3 : 2) * kShapeBytes * sizes.maxShapes});
  list.add({"stacks", scratch, kShapeBytes * sizes.stackShapes()});
  list.add({"records", scratch, kShapeBytes * sizes.maxTerminals});
  list.add({"counters", scratch, roundAt(sizes.phases() * sizes.phaseStride() + 1)}); // and emission
  list.add({"buckets", scratch, sizeof(uint32_t) * shader::kBucketWords});
  list.add({"constants", uniforms, sizeof(shader::SpawnConstants)});
  list.add({"vertices", buffer, 0, true});
  list.add({"indices", buffer, 0, true});
  list.add({"needed", buffer, 0, true});
  list.add({"colliders", scratch, VkDeviceSize(64) * std::max(sizes.maxColliders, 1u)});
  list.add({"collider cells", scratch, VkDeviceSize(4) * (sizes.cells() + sizes.maxColliders)});
  list.add({"order", scratch,
            sizeof(uint32_t) *
                (sizes.ordered ? shader::kOrderWords * VkDeviceSize(sizes.maxTerminals) + shader::kOrderParts : 1)});
  list.add({"axiomCounter", buffer, 0, true});
  list.add({"bounds", buffer, 0, true});
  list.add({"bound keys", scratch, sizeof(uint32_t) * shader::kMaxBuckets * shader::kBoundWords});
  list.add({"report", core::ResourceKind::report});
  list.add({"ranges", buffer, 0, true});
  list.add({"fields", buffer, 0, true});
  if (sizes.maxMeasuredAxioms) {
    const VkDeviceSize words = shader::kMeasuredWords + VkDeviceSize(sizes.maxOccupancyWords);
    list.add({"measured", scratch, sizeof(uint32_t) * words * sizes.maxMeasuredAxioms});
    list.add(
        {"measuring", buffer, sizeof(shader::Measuring) + sizeof(uint32_t) * VkDeviceSize(sizes.gridRoom()), true});
    list.readBack = shader::kBindMeasured;
    list.readBackBytes = sizeof(GpgpAxiomMeasures) * sizes.maxMeasuredAxioms;
  }
  list.report = shader::kBindCounters;
  list.reportBytes = sizeof(shader::SpawnState);
}

} // namespace gpgp::spawn
