#version 460
// Gives each tile with edges an entry, and clears it, unless mark has. Those of small glyphs have theirs
// (small_glyphs.comp).
//
// Entries are taken in any order. Where they do not suffice, the workgroup that finishes last deals them out again in
// painting order, and from the first path that does not fit on all are left out. SOFTWARE: that is all it does, by one
// workgroup (allocate_rows.comp).
#extension GL_GOOGLE_include_directive : require
#define SHARING coherent
#include "vector/shared/canvas.glsl"
layout(local_size_x = 64) in;
#include "vector/shared/lanes.glsl"
#include "vector/shared/scan.glsl"
#if !SOFTWARE
layout(set = 0, binding = kBindEntries, std430) coherent buffer Entries { uvec4 entries[]; };
#include "vector/shared/flat_segments.glsl"
layout(set = 0, binding = kBindShapes, std430) readonly buffer Shapes { vec4 shapes[]; };
shared uint start;
shared bool last;

void clearEntries(uint lane, uint first, uint count) {
  const uvec4 none = uvec4(0);
  for (uint i = lane; i < count * (kEntryWords / 4); i += 64) entries[first * (kEntryWords / 4) + i] = none;
}

#endif

void main() {
  const uint lane = gl_LocalInvocationID.x;
#if !SOFTWARE
  const uint total = min(counters.words, header.wordLimit), cleared = counters.cleared;
  for (uint first = gl_WorkGroupID.x * 64; first < total; first += gl_NumWorkGroups.x * 64) {
    const uint i = first + lane;
    const bool own = i < total && words[i].smallGlyph == 0;
    const uint count = own ? bitCount(words[i].edges) : 0;
    uint sum;
    const uint end = sumUpTo(lane, count, sum);
    if (lane == 63) start = atomicAdd(counters.entries, sum);
    barrier();
    if (own) words[i].firstEntry = start + end - count;
    const uint clear = max(start, cleared);
    if (start <= header.entryLimit && sum <= header.entryLimit - start && start + sum > clear)
      clearEntries(lane, clear, start + sum - clear);
  }
  memoryBarrierBuffer();
  barrier();
  if (lane == 0) last = atomicAdd(counters.allocated, 1) + 1 == gl_NumWorkGroups.x;
  barrier();
  if (!last) return;
  memoryBarrierBuffer();
  if (lane == 0 && listed(counters.rows)) {
    const uint groups = (counters.rows + 63) / 64;
    counters.rowsX = min(groups, 32768);
    counters.rowsY = (groups + 32767) / 32768;
    counters.rowsZ = 1;
  } else if (lane == 0) { // all that mark had (canvas.cpp)
    const uint groups = (header.segmentCount + header.groupSegments - 1) / header.groupSegments;
    counters.fillX = min(groups, 32768);
    counters.fillY = (groups + 32767) / 32768;
    counters.fillZ = clamp(4096 / groups, 1, 16);
  }
  if (lane == 0 && header.patchTable != 0) {
    const bool fits = counters.tilePatches <= floatBitsToUint(shapes[header.patchTable].w);
    const uint groups = fits ? (counters.tilePatches + kFillPatches - 1) / kFillPatches : 0;
    counters.patchesX = min(groups, 32768);
    counters.patchesY = (groups + 32767) / 32768;
    counters.patchesZ = 1;
    if (!fits) { // which of them are listed, chance has decided: all are left out, and what lies over them
      const uint cut = wholeItems(min(counters.cutPath, floatBitsToUint(shapes[header.patchTable + 1].x)));
      counters.cutPath = cut;
      counters.pathsDropped = header.pathsDropped + header.pathCount - cut;
    }
  }
  barrier();
#endif
  if (counters.entries <= header.entryLimit) return;
#if !SOFTWARE
  memoryBarrierBuffer();
#endif
  const uint pathEnd = counters.cutPath;
  uint cut = pathEnd, used = 0;
  for (uint first = 0; first < pathEnd && cut == pathEnd; first += 64) {
    const uint path = first + lane;
    uint count = 0, wordCount = 0, firstWord = 0;
    if (path < pathEnd) {
      const PlacedPath p = paths[path];
      firstWord = p.firstWord;
      wordCount = items[p.item].smallGlyph != 0 ? 0 : wordsInRow(p) * (p.bottom - p.top);
      for (uint w = 0; w < wordCount; ++w) count += bitCount(words[firstWord + w].edges);
    }
    const uint end = add(used, scan(lane, count));
    const uint fits = countLanes(lane, end <= header.entryLimit);
    if (lane < fits) {
      uint next = end - count;
      for (uint w = 0; w < wordCount; ++w) {
        words[firstWord + w].firstEntry = next;
        next += bitCount(words[firstWord + w].edges);
      }
    }
    if (fits < 64) cut = min(cut, first + fits);
    used = add(used, scanTotal());
  }
#if !SOFTWARE
  clearEntries(lane, 0, header.entryLimit);
#endif
  if (lane == 0) {
    cut = wholeItems(cut);
    counters.cutPath = cut;
    counters.pathsDropped = header.pathsDropped + header.pathCount - cut + counters.imagesDropped;
  }
}
