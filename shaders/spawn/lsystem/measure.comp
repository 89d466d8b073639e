#version 460
#extension GL_GOOGLE_include_directive : require
// What brackets, polygons and axioms of each tile add up to: of a step's string, or of the last one.
#include "spawn/lsystem/bindings.glsl"
layout(local_size_x = 256) in; // kLsysTile
layout(push_constant) uniform Push { uint kind, step; };
#include "spawn/lsystem/scan.glsl"
#include "spawn/lsystem/measured.glsl"

void main() {
  if (kind == kLsysSumDepths && !structured(step)) return;
  sourceHalf = kind == kLsysSumDepths ? step & 1u : state.last;
  const uint at = gl_GlobalInvocationID.x;
  sumUpTo(at < modulesOf(sourceHalf) ? measured(lsysModule(at).x) : uvec4(0u), false);
  if (gl_LocalInvocationIndex == 0u) tiles[gl_WorkGroupID.x] = scanned[kLsysTile - 1u];
}
