#version 460
#extension GL_GOOGLE_include_directive : require
// The pyramid of contexts: its leaves, and the eight levels over a tile of them.
#include "spawn/lsystem/bindings.glsl"
layout(local_size_x = 256) in; // kLsysTile
layout(push_constant) uniform Push { uint step; };
#include "spawn/lsystem/scan.glsl"
#include "spawn/lsystem/measured.glsl"
#include "spawn/lsystem/levels.glsl"

void main() {
  if (!structured(step)) return;
  sourceHalf = step & 1u;
  const uint at = gl_GlobalInvocationID.x;
  const uint lane = gl_LocalInvocationIndex;
  const bool isThere = at < modulesOf(sourceHalf);
  const uint symbol = isThere ? lsysModule(at).x : 0u;
  const uvec4 own = isThere ? measured(symbol) : uvec4(0u);
  const uint depth = sumUpTo(own, false).x + tiles[gl_WorkGroupID.x].x - own.x;
  uvec4 node = isThere ? lsysLeaf(symbol, depth) : lsysNoLeaf();
  const uint base = record.leaves + gl_WorkGroupID.x * kLsysTile;
  nodes[base + lane] = node;
  joinLevels(base, kLsysTile, node);
}
