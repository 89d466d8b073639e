#version 460
#extension GL_GOOGLE_include_directive : require
// Marks of each module: its depth, whether it is in a polygon, the brackets that open before it, its axiom.
#include "spawn/lsystem/bindings.glsl"
layout(local_size_x = 256) in; // kLsysTile
#include "spawn/lsystem/scan.glsl"
#include "spawn/lsystem/measured.glsl"

shared uint deepest;

void main() {
  sourceHalf = state.last;
  const uint at = gl_GlobalInvocationID.x;
  const bool isThere = at < state.modules;
  const uint symbol = isThere ? lsysModule(at).x : 0u;
  const uvec4 own = isThere ? measured(symbol) : uvec4(0u);
  if (gl_LocalInvocationIndex == 0u) deepest = 0u;
  const uvec4 upTo = sumUpTo(own, false) + tiles[gl_WorkGroupID.x];
  // A bracket lies outside what it encloses.
  const uint depth = symbol == kSymbolClose ? upTo.x : upTo.x - own.x;
  if (isThere) {
    atomicMax(deepest, depth);
    const bool inPolygon = int(upTo.z - own.z) > 0;
    marks[at] = uvec4(min(depth, kLsysMostDepth) | (inPolygon ? 0x10000u : 0u), upTo.y - own.y, upTo.w - 1u, 0u);
  }
  barrier();
  if (gl_LocalInvocationIndex == 0u) atomicMax(state.depth, deepest);
}
