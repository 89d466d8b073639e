#version 460
#extension GL_GOOGLE_include_directive : require
// Turtles that walk: for commands that depend on the heading, which no scan joins. A walker passes some modules of a
// branch in a round and leaves a walker to each branch that begins there, and to the rest of its own.
#include "spawn/lsystem/bindings.glsl"
layout(local_size_x = 64) in; // kLsysWalkLanes
layout(push_constant) uniform Push { uint round; };
#include "spawn/lsystem/frames.glsl"

/// A frame from the root has no scale of width: elasticity is kept there.
void leave(uint place, LsysFrame f, float elasticity) {
  f.h.w = elasticity;
  setFrame(place, f);
}
void addWalker(uint place) {
  const uint index = atomicAdd(arguments[4u * (kLsysArgsWalks + round + 1u) + 3u], 1u);
  if ((index & (kLsysWalkLanes - 1u)) == 0u) atomicAdd(arguments[4u * (kLsysArgsWalks + round + 1u)], 1u);
  parents[walkerAt((round + 1u) & 1u, index)] = place;
  if (round + 1u == record.rounds) atomicAdd(state.unwalked, 1u);
}

void main() {
  sourceHalf = state.last;
  const uint walker = gl_GlobalInvocationID.x;
  if (walker >= arguments[4u * (kLsysArgsWalks + round) + 3u]) return;
  const uint first = round == 0u ? 0u : parents[walkerAt(round & 1u, walker)];
  LsysFrame f;
  float elasticity;
  if (round == 0u) {
    f = lsysStart();
    elasticity = uintBitsToFloat(lsysWord(kLsysHeadTropism + 3u));
  } else {
    f = frameAt(first);
    elasticity = f.h.w;
    f.h.w = 0.0;
  }
  const uint branch = round == 0u ? 0u : parents[branchAt(first)];
  uint place = first;
  bool ended = false;
  for (uint i = 0u; i < kLsysWalkLength && !ended; ++i) {
    const uint module = order[orderAt(place)];
    const uvec4 words = lsysModule(module);
    leave(place, f, elasticity);
    parents[branchAt(place)] = branch;
    if (words.x == kSymbolOpen) {
      if (lsysModule(module + 1u).x != kSymbolClose) {
        const uint child = order[placeAt(module + 1u)];
        leave(child, f, elasticity);
        parents[branchAt(child)] = marks[module].y + 1u;
        addWalker(child);
      }
    } else {
      f = lsysWalk(f, words, lsysTurtleOf(words.x), elasticity);
    }
    place += 1u;
    ended = place >= state.modules || isHead(order[orderAt(place)]);
  }
  if (!ended) {
    leave(place, f, elasticity);
    parents[branchAt(place)] = branch;
    addWalker(place);
  }
}
