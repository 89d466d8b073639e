#version 460
#extension GL_GOOGLE_include_directive : require
// Eight levels more of the pyramid, over nodes that are as many below it.
#include "spawn/lsystem/bindings.glsl"
layout(local_size_x = 256) in; // kLsysTile
layout(push_constant) uniform Push { uint step, level; };
#include "spawn/lsystem/scan.glsl"
#include "spawn/lsystem/measured.glsl"
#include "spawn/lsystem/levels.glsl"

void main() {
  if (!structured(step)) return;
  const uint lane = gl_LocalInvocationIndex;
  const uint width0 = record.leaves >> level; // nodes of the level below
  // Nodes that hold modules; those behind them were not written.
  const uint there = ((modulesOf(step & 1u) - 1u) >> level) + 1u;
  const uint first = gl_WorkGroupID.x * kLsysTile;
  if (width0 == 0u || first >= there) return;
  const uint base = width0 + first;
  const uint valid = min(kLsysTile, width0);
  const uvec4 node = first + lane < there ? nodes[base + lane] : lsysNoLeaf();
  if (first + lane >= there && lane < valid) nodes[base + lane] = node;
  joinLevels(base, valid, node);
}
