#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup: sums of tiles become sums over all tiles before, and what follows from the sum of all.
#include "spawn/lsystem/bindings.glsl"
layout(local_size_x = 256) in; // kLsysTile
layout(push_constant) uniform Push { uint kind, step; };
#include "spawn/lsystem/scan.glsl"

uint saturated(uint a, uint b) { return a + b < a ? 0xffffffffu : a + b; }

void main() {
  const bool stepping = kind == kLsysSumStep || kind == kLsysSumDepths;
  if (stepping && state.stoppedAt <= step) return;
  const uint side = stepping ? step & 1u : state.last;
  const uint count = (modulesOf(side) + kLsysTile - 1u) / kLsysTile;
  const bool paths = kind == kLsysSumPolygons || kind == kLsysSumCylinders;
  const uint lane = gl_LocalInvocationIndex;
  uvec4 before = uvec4(0u);
  if (kind == kLsysSumCylinders) before.x = state.polygonCorners; // they lie behind them
  for (uint first = 0u; first < count; first += kLsysTile) {
    const uvec4 own = first + lane < count ? tiles[first + lane] : uvec4(0u);
    sumUpTo(own, paths);
    uvec4 exclusive = lane == 0u ? uvec4(0u) : scanned[lane - 1u];
    exclusive = joined(before, exclusive, paths);
    if (kind == kLsysSumStep) exclusive.x = max(exclusive.x, before.x), exclusive.y = max(exclusive.y, before.y);
    if (first + lane < count) tiles[first + lane] = exclusive;
    const uvec4 all = scanned[kLsysTile - 1u];
    if (kind == kLsysSumStep) { // what does not fit at all must not come round again
      before.x = saturated(before.x, all.x);
      before.y = saturated(before.y, all.y);
    } else {
      before = joined(before, all, paths);
    }
  }
  if (lane != 0u) return;
  if (kind == kLsysSumStep) {
    state.modulesNeeded = max(state.modulesNeeded, before.x);
    state.parametersNeeded = max(state.parametersNeeded, before.y);
    const bool fits = before.x <= record.maxModules && before.y <= record.maxParameters;
    const uint slot = kLsysArgsString + 1u - side;
    if (!fits) state.stoppedAt = step;
    arguments[4u * slot] = fits ? (before.x + kLsysTile - 1u) / kLsysTile : 0u;
    arguments[4u * slot + 1u] = 1u;
    arguments[4u * slot + 2u] = 1u;
    if (fits && side == 0u) {
      state.modulesB = before.x;
      state.parametersB = before.y;
    } else if (fits) {
      state.modulesA = before.x;
      state.parametersA = before.y;
    }
  }
  if (kind == kLsysSumMarks) state.branches = before.y + 1u;
  if (kind == kLsysSumPolygons) state.polygonCorners = before.x;
  if (kind == kLsysSumCylinders) state.sections = before.x - state.polygonCorners;
}
