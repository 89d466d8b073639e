// The resources that the passes share, and the parts in their order.
#include "visibility/sampling/passes.h"

#include "visibility/nearby/nearby.h"

#include <algorithm>
#include <cassert>

namespace gpgp::visibility {
namespace {
using core::Resource;
using core::ResourceKind;

/// In the order of shader::kBind...
void addResources(core::PassList& list, const Budgets& budgets) {
  using enum ResourceKind;
  const bool exact = budgets.methods & GPGP_SAMPLING_EXACT_BIT;
  const bool conservative = budgets.methods & GPGP_SAMPLING_CONSERVATIVE_BIT;
  const VkDeviceSize pairBytes = VkDeviceSize(budgets.maxPairs) * shader::kPairBytes;
  const VkDeviceSize queueBytes = (budgets.nonOpaqueAt() + budgets.maxNonOpaque) * 4;
  VkDeviceSize recordBytes = VkDeviceSize(budgets.mediumRecords() + budgets.largeRecords()) * kRecordBytes;
  if (exact) recordBytes = std::max(recordBytes, VkDeviceSize(budgets.maxCandidates) * sizeof(shader::Candidate));
  if (budgets.methods & GPGP_SAMPLING_NEARBY_BIT)
    recordBytes = std::max(recordBytes, VkDeviceSize(budgets.maxCameras) * shader::kCameraTiles * sizeof(shader::Tile));
  if (conservative) recordBytes = std::max(recordBytes, budgets.pixels() * sizeof(shader::Surface));
  const auto engine = [&](const char* name) { list.add({name, buffer, 0, true}); };
  const auto own = [&](const char* name, VkDeviceSize bytes) { list.add({name, scratch, bytes}); };

  list.add({"camera", uniforms, sizeof(shader::Params)});
  engine("positions");
  engine("indices");
  engine("draws");
  engine("geometrySet");
  own("draw table", VkDeviceSize(budgets.maxDraws) * shader::kTableWords * 4 + budgets.chunks() * 8);
  own("queue", exact ? std::max(queueBytes, VkDeviceSize(budgets.maxPairs) * 4) : queueBytes);
  own("samples", budgets.pixels() * budgets.maxSamples * budgets.maxSamples * shader::kSampleWords * 4);
  own("counters", sizeof(shader::Counters) + VkDeviceSize(shader::kListBlocks) * 12);
  engine("visibleBits");
  engine("visibleList");
  engine("visibleCount");
  engine("history");
  own("records", recordBytes);
  engine("pixelCounts");
  own("limits",
      exact ? (budgets.slots() + kMaxLargeCandidates) * 8 + budgets.slots() / 64 * shader::kTileWords * 4 : 4);
  engine("commands");
  engine("drawCountBuffer");
  engine("drawCommands");
  engine("drawIndices");
  engine("drawTriangles");
  engine("triangleSizes");
  own("pairs",
      std::max(exact ? pairBytes : 4, conservative ? budgets.pixels() * shader::kGapWords * 4 : VkDeviceSize(0)));
  engine("textureCoordinates");
  engine("changedList");
  assert(list.resources.size() == shader::kBindTextures);
  static constexpr const char* kTextures[shader::kMaxAlphaTests] = {
      "alphaTests[0]",  "alphaTests[1]",  "alphaTests[2]",  "alphaTests[3]", "alphaTests[4]",  "alphaTests[5]",
      "alphaTests[6]",  "alphaTests[7]",  "alphaTests[8]",  "alphaTests[9]", "alphaTests[10]", "alphaTests[11]",
      "alphaTests[12]", "alphaTests[13]", "alphaTests[14]", "alphaTests[15]"};
  if (budgets.maxNonOpaque)
    for (const char* name : kTextures) list.add({name, texture, 0, true});
}
} // namespace

uint32_t addShader(core::PassList& list, const char* name, const core::ShaderCode& spirv,
                   std::initializer_list<uint32_t> constants) {
  core::ShaderDesc desc{name, spirv};
  std::copy(constants.begin(), constants.end(), desc.specialization.begin());
  desc.specializationCount = static_cast<uint32_t>(constants.size());
  return list.add(desc);
}

core::Pass& fetchesTriangles(core::Pass& pass) {
  for (const int binding : {shader::kBindParams, shader::kBindPositions, shader::kBindIndices, shader::kBindDraws,
                            shader::kBindNumbers, shader::kBindTable}) {
    const auto resource = static_cast<core::ResourceIndex>(binding);
    const auto end = pass.uses.begin() + pass.useCount;
    if (std::any_of(pass.uses.begin(), end, [&](const core::Use& use) { return use.resource == resource; })) continue;
    assert(pass.useCount < core::kMaxUses);
    pass.uses[pass.useCount++] = {resource, core::UseKind::read};
  }
  return pass;
}

core::PassList describePasses(const Budgets& budgets, const core::Device& device, std::pmr::memory_resource* memory) {
  const bool conservative = budgets.methods & GPGP_SAMPLING_CONSERVATIVE_BIT;
  core::PassList list(memory);
  addResources(list, budgets);
  addStandard(list, budgets, device);
  if (budgets.methods & GPGP_SAMPLING_EXACT_BIT) addExact(list, budgets, device);
  if (conservative) addConservative(list, budgets);
  if (budgets.methods & GPGP_SAMPLING_NEARBY_BIT) addNearby(list);
  addOutputs(list);
  for (core::Pass& pass : list.passes)
    if (pass.condition == UINT32_MAX) pass.condition = kIfSampling;
  addMetrics(list);
  list.report = shader::kBindCounters;
  list.reportBytes = shader::kReportWords * 4;
  return list;
}

} // namespace gpgp::visibility
