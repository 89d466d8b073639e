#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup: where each terminal's instances lie, and what was written.
#include "spawn/lsystem/bindings.glsl"
layout(local_size_x = 256) in; // kLsysDigits
#include "spawn/lsystem/scan.glsl"
#include "spawn/lsystem/string.h"

void main() {
  const uint lane = gl_LocalInvocationIndex;
  const uint own = state.modules == 0u || lane == 255u
                       ? 0u
                       : histogram[kLsysDigits * ((state.modules + kLsysTile - 1u) / kLsysTile) + lane];
  const uint first = sumUpTo(uvec4(own, 0u, 0u, 0u), false).x - own;
  const uint written = min(state.instances, record.instanceCapacity);
  if (lane < min(record.drawCapacity, lsysWord(kLsysHeadSections + 2u * kLsysSectionTerminals))) {
    draws[5u * lane + 1u] = max(min(first + own, written), first) - first;
    draws[5u * lane + 4u] = first;
  }
  if (lane != 0u) return;
  state.instancesWritten = written;
  state.cornersWritten = min(state.polygonCorners + state.sections, record.cornerCapacity);
  if (record.writesCount != 0u) instanceCount = written;
}
