#version 460
#extension GL_GOOGLE_include_directive : require
// For each module of a step: which production applies, and how much the tile becomes.
#include "spawn/lsystem/bindings.glsl"
layout(local_size_x = 256) in; // kLsysTile
layout(push_constant) uniform Push { uint step; };
#include "spawn/lsystem/rewrite.h"
#include "spawn/lsystem/scan.glsl"

void main() {
  if (state.stoppedAt <= step) return;
  sourceHalf = step & 1u;
  const uint at = gl_GlobalInvocationID.x;
  uvec4 made = uvec4(0u);
  if (at < modulesOf(sourceHalf)) {
    const uint phase = phaseOf(step);
    const uvec4 module = lsysModule(at);
    const bool cuts = (lsysWord(kLsysHeadFlags) & kLsysCuts) != 0u && (phase == kPhaseMain || phase == kPhaseCut);
    if (cuts && lsysIsCut(at)) {
      chosen[at] = kLsysNowhere;
    } else {
      const uint production = lsysChoose(at, module, phase, step);
      chosen[at] = production;
      made.xy = lsysCount(module, production);
    }
  }
  sumUpTo(made, false);
  if (gl_LocalInvocationIndex == 0u) tiles[gl_WorkGroupID.x] = scanned[kLsysTile - 1u];
}
