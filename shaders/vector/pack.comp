#version 460
// Bins as lists: which paths they hold, the last one in painting order first.
//
// Squares of 16 pixels read their bin again and again; bits must be counted there, and a bit for each of tens of
// thousands of paths is much to read for the few that are set. A workgroup has a bin. Its list is written from the end
// of the bin's words backwards, over bits that have been read; where it would reach those that have not, the bits stay.
#extension GL_GOOGLE_include_directive : require
#include "canvas.glsl"
layout(local_size_x = 256) in;
shared uint counts[256];
shared uint found; // by the words so far
shared bool fits;

/// Sums over the lanes up to each, in counts.
void sumUp(uint count) {
  const uint lane = gl_LocalInvocationIndex;
  counts[lane] = count;
  barrier();
  for (uint step = 1; step < 256; step *= 2) {
    const uint other = lane >= step ? counts[lane - step] : 0;
    barrier();
    counts[lane] += other;
    barrier();
  }
}

void main() {
  const uint lane = gl_LocalInvocationIndex, all = header.pathWords;
  if (groupIndex() >= header.binCount) return;
  const uint flag = kFirstBin + groupIndex() * header.binWords, bin = flag + 1, room = header.binWords - 1;
  if (lane == 0) {
    found = 0;
    fits = true;
  }
  for (uint pass = 0; pass < 2; ++pass) { // whether it fits, then the list
    for (uint end = all; end > 0; end -= min(end, 256)) {
      const uint bits = lane < end ? bins[bin + end - 1 - lane] : 0;
      sumUp(bitCount(bits)); // all have read theirs
      const uint before = found;
      const uint after = before + counts[255];
      if (pass == 1) {
        uint place = bin + room - 1 - before - (counts[lane] - bitCount(bits));
        for (uint rest = bits; rest != 0; --place) {
          const uint bit = findMSB(rest);
          rest ^= 1u << bit;
          bins[place] = (end - 1 - lane) * 32 + bit;
        }
      }
      barrier();
      if (lane == 0) {
        found = after;
        if (after > room - (end - min(end, 256))) fits = false;
      }
      barrier();
    }
    if (!fits) return;
    if (pass == 0) {
      barrier();
      if (lane == 0) found = 0;
      barrier();
    }
  }
  if (lane == 0) bins[flag] = found + 1;
}
