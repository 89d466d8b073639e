#version 460
#extension GL_GOOGLE_include_directive : require
// Frames of branches from the root: first each one's in the branch around it, then, round by round, in that of twice as
// many around it.
#include "spawn/lsystem/bindings.glsl"
layout(local_size_x = 256) in; // kLsysTile
layout(push_constant) uniform Push { uint stage, round; };
#include "spawn/lsystem/frames.glsl"

void main() {
  sourceHalf = state.last;
  const uint at = gl_GlobalInvocationID.x;
  if (stage == 0u) { // a bracket opens each branch but the root
    if (at == 0u) {
      setBranchFrame(0u, 0u, lsysIdentity());
      parents[parentAt(0u, 0u)] = 0u;
    }
    if (at >= state.modules || lsysModule(at).x != kSymbolOpen) return;
    const uint place = order[placeAt(at)];
    const uint branch = marks[at].y + 1u;
    setBranchFrame(0u, branch, frameAt(place));
    parents[parentAt(0u, branch)] = parents[branchAt(place)];
    return;
  }
  if (at >= state.branches) return;
  const uint from = round & 1u;
  const uint parent = parents[parentAt(from, at)];
  LsysFrame f = branchFrame(from, at);
  uint next = 0u;
  if (parent != 0u) {
    f = lsysCompose(branchFrame(from, parent), f);
    next = parents[parentAt(from, parent)];
  }
  setBranchFrame(1u - from, at, f);
  parents[parentAt(1u - from, at)] = next;
}
