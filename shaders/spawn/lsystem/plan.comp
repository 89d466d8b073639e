#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation: what follows from the depth of the brackets.
#include "spawn/lsystem/bindings.glsl"
layout(local_size_x = 1) in;

void setArguments(uint slot, uint x) {
  arguments[4u * slot] = x;
  arguments[4u * slot + 1u] = 1u;
  arguments[4u * slot + 2u] = 1u;
}

void main() {
  if (state.depth > kLsysMostDepth) state.depthExceeded = 1u;
  state.deep = state.depth >= kLsysDigits ? 1u : 0u;
  if (state.deep != 0u) setArguments(kLsysArgsDeep, (state.modules + kLsysTile - 1u) / kLsysTile);
  // After r rounds a branch knows 2^r branches around it.
  state.jumps = state.depth > 1u ? uint(findMSB(min(state.depth, kLsysMostDepth) - 1u)) + 1u : 0u;
  for (uint round = 0u; round < kLsysJumps; ++round)
    setArguments(kLsysArgsJumps + round, round < state.jumps ? (state.branches + kLsysTile - 1u) / kLsysTile : 0u);
  if (state.modules != 0u) {
    // A walker begins at the root.
    arguments[4u * kLsysArgsWalks] = 1u;
    arguments[4u * kLsysArgsWalks + 3u] = 1u;
  }
}
