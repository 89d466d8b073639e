#version 460
// Bins as lists of the paths that they hold.
//
// Tiles read their bin again and again; bits must be counted there, and a bit for each of tens of thousands of paths is
// much to read for the few that are set. A workgroup has a bin, and each of its invocations as many words of it. Where
// there is no room for a list, the bits stay.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
#include "vector/shared/lists.glsl"
#define SCAN_LANES 256
layout(local_size_x = SCAN_LANES) in;
#include "vector/shared/lanes.glsl"
#include "vector/shared/scan.glsl"
shared uint start;

void main() {
  if (groupIndex() >= header.binCount) return;
  const uint lane = gl_LocalInvocationIndex, bits = bitsOf(groupIndex()), head = bits - kBinHead;
  const uint each = (header.pathWords + SCAN_LANES - 1) / SCAN_LANES;
  const uint end = header.pathWords - min(lane * each, header.pathWords), begin = end - min(each, end);
  uint count = 0;
  for (uint word = begin; word < end; ++word) count += bitCount(bins[bits + word]);
  uint total;
  const uint upTo = sumUpTo(lane, count, total);
  if (lane == 0) start = atomicAdd(counters.listed, total);
  barrier();
  if (start > header.binListLimit || total > header.binListLimit - start) return;
  uint place = binLists() + start + upTo - count;
  for (uint word = end; word > begin; --word)
    for (uint rest = bins[bits + word - 1]; rest != 0; ++place) {
      const uint bit = findMSB(rest);
      rest ^= 1u << bit;
      bins[place] = (word - 1) * 32 + bit;
    }
  if (lane == 0) {
    bins[head] = total + 1;
    bins[head + 1] = binLists() + start;
  }
}
