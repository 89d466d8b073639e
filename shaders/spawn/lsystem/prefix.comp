#version 460
#extension GL_GOOGLE_include_directive : require
// Frames of modules relative to the beginning of their branch: a segmented scan over branches that lie in rows.
#include "spawn/lsystem/bindings.glsl"
layout(local_size_x = 128) in; // kLsysFrameLanes
layout(push_constant) uniform Push { uint stage; };
#include "spawn/lsystem/frames.glsl"

// What a row of modules does: the frame since the last head, and the place of that + 1, or 0 without one.
struct Part {
  LsysFrame frame;
  uint head;
};
shared vec4 parts[4 * kLsysFrameLanes - 4]; // the last one's is in no sum
shared uint heads[kLsysFrameLanes];

Part nothing() {
  Part part;
  part.frame = lsysIdentity();
  part.head = 0u;
  return part;
}
Part joinedParts(Part a, Part b) {
  if (b.head != 0u) return b;
  Part part;
  part.frame = lsysCompose(a.frame, b.frame);
  part.head = a.head;
  return part;
}
void share(uint lane, Part part) {
  if (lane < kLsysFrameLanes - 1u) {
    parts[4u * lane] = part.frame.h;
    parts[4u * lane + 1u] = part.frame.l;
    parts[4u * lane + 2u] = part.frame.u;
    parts[4u * lane + 3u] = part.frame.p;
  }
  heads[lane] = part.head;
}
Part shared_(uint lane) {
  Part part;
  part.frame.h = parts[4u * lane];
  part.frame.l = parts[4u * lane + 1u];
  part.frame.u = parts[4u * lane + 2u];
  part.frame.p = parts[4u * lane + 3u];
  part.head = heads[lane];
  return part;
}
/// The part up to an invocation's own.
Part joinUpTo(Part part) {
  const uint lane = gl_LocalInvocationIndex;
  for (uint step = 1u; step < kLsysFrameLanes; step *= 2u) {
    barrier();
    share(lane, part);
    barrier();
    if (lane >= step) part = joinedParts(shared_(lane - step), part);
  }
  barrier();
  share(lane, part);
  barrier();
  return part;
}

// Tiles' parts lie in tiles[], five words of four each.
void setTile(uint tile, Part part) {
  tiles[5u * tile] = floatBitsToUint(part.frame.h);
  tiles[5u * tile + 1u] = floatBitsToUint(part.frame.l);
  tiles[5u * tile + 2u] = floatBitsToUint(part.frame.u);
  tiles[5u * tile + 3u] = floatBitsToUint(part.frame.p);
  tiles[5u * tile + 4u] = uvec4(part.head, 0u, 0u, 0u);
}
Part tilePart(uint tile) {
  Part part;
  part.frame.h = uintBitsToFloat(tiles[5u * tile]);
  part.frame.l = uintBitsToFloat(tiles[5u * tile + 1u]);
  part.frame.u = uintBitsToFloat(tiles[5u * tile + 2u]);
  part.frame.p = uintBitsToFloat(tiles[5u * tile + 3u]);
  part.head = tiles[5u * tile + 4u].x;
  return part;
}

/// The module at a place.
Part partOf(uint place, out uint module) {
  Part part = nothing();
  module = 0u;
  if (place >= state.modules) return part;
  module = order[orderAt(place)];
  const uvec4 words = lsysModule(module);
  part.frame = lsysMove(words, lsysTurtleOf(words.x));
  if (isHead(module)) part.head = place + 1u;
  return part;
}

void scanTiles() {
  const uint lane = gl_LocalInvocationIndex;
  const uint count = (state.modules + kLsysFrameTile - 1u) / kLsysFrameTile;
  Part before = nothing();
  for (uint first = 0u; first < count; first += kLsysFrameLanes) {
    const Part own = first + lane < count ? tilePart(first + lane) : nothing();
    joinUpTo(own);
    Part exclusive = before;
    if (lane > 0u) exclusive = joinedParts(before, shared_(lane - 1u));
    if (first + lane < count) setTile(first + lane, exclusive);
    // The last invocation's own part is not shared: it follows from the one before it.
    barrier();
    const Part all = joinedParts(exclusive, own);
    if (lane == kLsysFrameLanes - 1u) {
      share(0u, all);
    }
    barrier();
    before = shared_(0u);
    before.head = heads[0];
    barrier();
  }
}

void main() {
  sourceHalf = state.last;
  if (stage == 1u) {
    scanTiles();
    return;
  }
  const uint lane = gl_LocalInvocationIndex;
  const uint first = gl_WorkGroupID.x * kLsysFrameTile + lane * kLsysFrameEach;
  Part own = nothing();
  uint module;
  for (uint i = 0u; i < kLsysFrameEach; ++i) own = joinedParts(own, partOf(first + i, module));
  const Part upTo = joinUpTo(own);
  if (stage == 0u) {
    if (lane == kLsysFrameLanes - 1u) setTile(gl_WorkGroupID.x, upTo);
    return;
  }
  Part before = tilePart(gl_WorkGroupID.x);
  if (lane > 0u) before = joinedParts(before, shared_(lane - 1u));
  for (uint i = 0u; i < kLsysFrameEach; ++i) {
    const uint place = first + i;
    const Part part = partOf(place, module);
    if (place >= state.modules) break;
    const bool head = part.head != 0u;
    setFrame(place, head ? lsysIdentity() : before.frame);
    const uint headModule = head ? module : order[orderAt(before.head - 1u)];
    parents[branchAt(place)] = headModule == 0u ? 0u : marks[headModule].y;
    before = joinedParts(before, part);
  }
}
