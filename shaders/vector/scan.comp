#version 460
// One workgroup adds up. Push constant 0: entries of tiles to places in the list, and whether they fit; 1: entries of
// paths to the first path that does not fit; 2: places again, after paths were left out.
#extension GL_GOOGLE_include_directive : require
#include "canvas.glsl"
layout(local_size_x = 256) in;
layout(push_constant) uniform Pass { uint mode; };
shared uint sums[256];
shared uint cut;

uint add(uint a, uint b) { // stays at the largest number instead of wrapping
  uint carry;
  const uint sum = uaddCarry(a, b, carry);
  return carry != 0 ? ~0u : sum;
}

void scan(uint lane) { // inclusive
  barrier();
  for (uint step = 1; step < 256; step *= 2) {
    const uint other = lane >= step ? sums[lane - step] : 0;
    barrier();
    sums[lane] = add(sums[lane], other);
    barrier();
  }
}

void main() {
  const uint lane = gl_LocalInvocationID.x;
  uint total = 0;
  if (mode == 1) {
    if (lane == 0) cut = header.pathCount;
    for (uint first = 0; first < header.pathCount; first += 256) {
      const uint i = first + lane;
      sums[lane] = i < header.pathCount ? pathCounts[i] : 0;
      scan(lane);
      if (i < header.pathCount && add(total, sums[lane]) > header.entryLimit) atomicMin(cut, i);
      total = min(add(total, sums[255]), header.entryLimit + 1);
      barrier();
      if (cut != header.pathCount) break;
    }
    if (lane == 0) {
      counters.cutPath = cut;
      counters.pathsDropped = header.pathsDropped + header.pathCount - cut;
    }
    return;
  }
  const uint tileCount = header.tilesX * header.tilesY;
  for (uint first = 0; first < tileCount; first += 256) {
    const uint i = first + lane;
    const uint count = i < tileCount ? tiles[i].y : 0;
    sums[lane] = count;
    scan(lane);
    if (i < tileCount) tiles[i].x = total + sums[lane] - count;
    total = add(total, sums[255]);
    barrier();
  }
  if (lane == 0 && mode == 0) {
    const bool fits = total <= header.entryLimit;
    counters.needed = total;
    counters.given = header.entryLimit;
    counters.patches = header.patchCount;
    counters.cutPath = header.pathCount;
    counters.pathsDropped = header.pathsDropped;
    counters.recountX = fits ? 0 : header.tilesX;
    counters.recountY = fits ? 0 : header.tilesY;
    counters.recountZ = 1;
  }
}
