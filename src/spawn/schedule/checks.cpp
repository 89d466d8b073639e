#include "spawn/schedule/checks.h"

#include "spawn/outputs/measure.h"

namespace gpgp::spawn {
using core::makeError;
using core::Result;

Result<void> checkCreateInfo(const GpgpSpawnerCreateInfo& info) {
  if (info.flags & ~(GPGP_SPAWNER_ORDERED | GPGP_SPAWNER_COMPACT | GPGP_SPAWNER_KERNELS_ONLY))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "flags has unknown bits");
  if ((info.flags & GPGP_SPAWNER_COMPACT) && info.vertices)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "flags has GPGP_SPAWNER_COMPACT, but vertices is set");
  if (info.maxShapes > (1u << 24) || info.maxTerminals > (1u << 24))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxShapes and maxTerminals are at most 16777216");
  if (info.maxDepth > 65535) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxDepth is at most 65535");
  if (info.maxHostAxioms > (1u << 24))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxHostAxioms is at most 16777216");
  if (info.maxRounds > 256) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxRounds is at most 256");
  if (info.maxMeasuredAxioms > (1u << 20))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxMeasuredAxioms is at most 1048576");
  if (info.maxOccupancyWords > shader::kMostGridWords)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxOccupancyWords is at most %u", shader::kMostGridWords);
  return {};
}

namespace {
/// Where terminals go, and what is read and written for that.
Result<void> checkOutput(const Spawner& spawner, const GpgpSpawnInfo& info, uint32_t buckets) {
  const bool regions = info.flags & GPGP_SPAWN_REGIONS;
  bool counts = !info.instances.buffer;
  if (info.flags & ~GPGP_SPAWN_REGIONS) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "flags has unknown bits");
  if (spawner.vertices()) {
    if (!info.vertices)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "vertices is NULL; the spawner was made for vertices");
    if (info.instances.buffer)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "instances.buffer is set; the spawner was made for vertices");
    const GpgpVertexOutput& output = *info.vertices;
    counts = !output.vertices.buffer;
    if (!counts) {
      if (output.indexType != VK_INDEX_TYPE_UINT16 && output.indexType != VK_INDEX_TYPE_UINT32)
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "vertices->indexType is neither UINT16 nor UINT32");
    } else if (output.indices.buffer) {
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "vertices->vertices.buffer is NULL, indices.buffer is not");
    }
  } else if (info.vertices) {
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "vertices is set; the spawner was made for instances");
  }
  if (info.instances.buffer && info.instances.size < spawner.instanceBytes())
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "instances.size is below one instance (%u bytes)",
                     spawner.instanceBytes());
  if (regions && spawner.compact() && !spawner.ordered())
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "GPGP_SPAWN_REGIONS is set; a spawner for compact instances has "
                                                  "regions only with GPGP_SPAWNER_ORDERED");
  if (info.ranges.buffer) {
    if (spawner.vertices() || spawner.ordered() || spawner.compact())
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "ranges.buffer is set; spawners that are ordered, compact or for "
                                                    "vertices have no ranges");
    if (counts || regions || info.draws.buffer || info.bounds.buffer)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "ranges.buffer is set, and %s",
                       counts ? "instances.buffer is NULL" : "so are draws.buffer, bounds.buffer or regions");
    if (info.ranges.size / sizeof(GpgpAxiomRange) < info.axiomCount)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "ranges.size is %llu bytes, axiomCount %u needs %llu",
                       static_cast<unsigned long long>(info.ranges.size), info.axiomCount,
                       static_cast<unsigned long long>(info.axiomCount) * sizeof(GpgpAxiomRange));
  }
  if (info.firstInstance && (regions || spawner.vertices()))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "firstInstance is %u; with %s it must be 0", info.firstInstance,
                     regions ? "GPGP_SPAWN_REGIONS" : "vertices");
  if (info.measures && (info.ranges.buffer || (regions && !spawner.ordered()) || (spawner.vertices() && counts)))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "measures is set, and %s",
                     info.ranges.buffer ? "so is ranges.buffer"
                     : regions          ? "GPGP_SPAWN_REGIONS, of a spawner that is not ordered"
                                        : "vertices->vertices.buffer is NULL");
  if (counts && !info.draws.buffer && !info.measures)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s.buffer is NULL, and draws.buffer, where a recording could count",
                     spawner.vertices() ? "vertices->vertices" : "instances");
  if (regions && counts)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "GPGP_SPAWN_REGIONS is set, but nothing is written to them");
  if (regions && !info.draws.buffer)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "GPGP_SPAWN_REGIONS is set, draws.buffer is NULL");
  const uint64_t draws = spawner.vertices() && !regions && !counts ? 1 : buckets;
  const uint64_t drawBytes = draws * sizeof(VkDrawIndexedIndirectCommand);
  if (info.draws.buffer && info.draws.size < drawBytes)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "draws.size is %llu bytes, the grammar's %u buckets need %llu",
                     static_cast<unsigned long long>(info.draws.size), buckets,
                     static_cast<unsigned long long>(drawBytes));
  if (info.needed.buffer && !regions && !counts)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "needed.buffer is set, but there are no regions to fill");
  if (info.needed.buffer && info.needed.size < 4ull * buckets)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "needed.size is %llu bytes, the grammar's %u buckets need %llu",
                     static_cast<unsigned long long>(info.needed.size), buckets, 4ull * buckets);
  if (info.bounds.buffer && counts)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "bounds.buffer is set, but the recording only counts");
  if (info.bounds.buffer && info.bounds.size < sizeof(GpgpSpawnBounds) * buckets)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "bounds.size is %llu bytes, the grammar's %u buckets need %zu",
                     static_cast<unsigned long long>(info.bounds.size), buckets, sizeof(GpgpSpawnBounds) * buckets);
  if (info.count.buffer && info.count.size < 4)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "count.size is below 4 bytes");
  return {};
}
} // namespace

Result<void> checkSpawnInfo(const GpgpSpawnInfo& info, const Spawner& spawner, uint32_t buckets) {
  if (info.axioms.buffer && info.axioms.size / sizeof(GpgpAxiom) < info.axiomCount)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "axioms.size is %llu bytes, axiomCount %u needs %llu",
                     static_cast<unsigned long long>(info.axioms.size), info.axiomCount,
                     static_cast<unsigned long long>(info.axiomCount) * sizeof(GpgpAxiom));
  if (info.contextCount > info.axiomCount)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "contextCount is %u, axiomCount is %u", info.contextCount,
                     info.axiomCount);
  if (info.contextCount && info.axiomCounter.buffer)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "contextCount is %u, with axiomCounter", info.contextCount);
  if (info.axiomCounter.buffer && info.axiomCounter.size < 4)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "axiomCounter.size is below 4 bytes");
  if (info.axiomCounter.buffer && !info.axiomCount)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "axiomCounter.buffer is set, and axiomCount, the most, is 0");
  return checkOutput(spawner, info, buckets);
}

} // namespace gpgp::spawn
