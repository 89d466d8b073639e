// Metrics: compares two sets of triangles. Records that measure have these passes only.
#include "visibility/sampling/recorder.h"

#include "shaders/visibility_measure.spv.h"
#include "visibility/sampling/checks.h"

namespace gpgp::visibility {
using core::makeError;
using core::Result;

void addMetrics(core::PassList& list) {
  using namespace shader;
  using enum core::UseKind;
  list.fill("clear metrics", kBindCounters, 0).condition = kIfMeasuring;
  list.dispatch("measure", addShader(list, "measure", visibility_measure),
                {{kBindParams, read},
                 {kBindBits, read},
                 {kBindReference, read},
                 {kBindReferenceCounts, read},
                 {kBindRecheck, read},
                 {kBindFalsePositives, write},
                 {kBindFalseNegatives, write},
                 {kBindCounters, readWrite}},
                kWordGroups)
      .condition = kIfMeasuring;
}

Result<void> VisibilityRecorder::measure(VkCommandBuffer commandBuffer, const GpgpVisibilityMetricsInfo& info) {
  if (info.triangleCount > 1u << 31)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "triangleCount is %u; at most 2147483648", info.triangleCount);
  const uint64_t words = (uint64_t(info.triangleCount) + 31) / 32;
  shader::Params params{};
  params.triangleCount = info.triangleCount;
  core::Record record;
  const auto bind = [&](int binding, const char* name, const GpgpBuffer& buffer, uint32_t flag,
                        uint64_t bytes) -> Result<void> {
    if (!info.triangleCount || (flag && !buffer.buffer)) return {};
    if (auto ok = checkSize(name, buffer, bytes, "triangleCount"); !ok) return ok;
    record.bindings[static_cast<size_t>(binding)].engineBuffer = &buffer;
    record.bindings[static_cast<size_t>(binding)].name = name;
    params.metricBuffers |= flag;
    return {};
  };
  if (auto ok = bind(shader::kBindBits, "visibleBits", info.visibleBits, 0, words * 4); !ok) return ok;
  if (auto ok = bind(shader::kBindReference, "referenceBits", info.referenceBits, 0, words * 4); !ok) return ok;
  if (auto ok = bind(shader::kBindReferenceCounts, "referenceCounts", info.referenceCounts, shader::kHasReferenceCounts,
                     uint64_t(info.triangleCount) * 4);
      !ok)
    return ok;
  if (auto ok = bind(shader::kBindRecheck, "recheckBits", info.recheckBits, shader::kHasRecheck, words * 4); !ok)
    return ok;
  if (auto ok = bind(shader::kBindFalsePositives, "falsePositives", info.falsePositives, shader::kHasFalsePositives,
                     words * 4);
      !ok)
    return ok;
  if (auto ok = bind(shader::kBindFalseNegatives, "falseNegatives", info.falseNegatives, shader::kHasFalseNegatives,
                     words * 4);
      !ok)
    return ok;
  record.commandBuffer = commandBuffer;
  record.info = &info.base;
  record.groups[kWordGroups] = {std::max(groupsOf256(words), 1u), 1, 1};
  record.conditions[kIfMeasuring] = true;
  record.constants[0] = std::as_bytes(std::span(&params, 1));
  if (auto ok = check(record); !ok) return ok;
  return Recorder::record(record);
}

} // namespace gpgp::visibility
