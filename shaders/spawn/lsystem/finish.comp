#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation: which string is the last one, and how many workgroups take it.
#include "spawn/lsystem/bindings.glsl"
layout(local_size_x = 1) in;

void setArguments(uint slot, uint x) {
  arguments[4u * slot] = x;
  arguments[4u * slot + 1u] = 1u;
  arguments[4u * slot + 2u] = 1u;
}

void main() {
  state.steps = min(state.stoppedAt, record.steps);
  state.last = state.steps & 1u;
  state.modules = modulesOf(state.last);
  state.parameters = state.last == 0u ? state.parametersA : state.parametersB;
  setArguments(kLsysArgsLast, (state.modules + kLsysTile - 1u) / kLsysTile);
  setArguments(kLsysArgsFrames, (state.modules + kLsysFrameTile - 1u) / kLsysFrameTile);
  setArguments(kLsysArgsDeep, 0u);
}
