#version 460
// What each path's boundary does to the pixels of the tiles it passes through, where there are no lists of its
// flatSegments.
//
// Where a flattened segment meets a sample row, all samples of the row right of it change sides: one bit at the first
// such sample's pixel stands for them. Beside the bits, a pixel's area is kept as its difference from what its samples
// say. Where the flattened segment passes from tile to tile between two rows, the right one's rows from there down
// change sides at its left edge.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
#include "vector/shared/segments.glsl"
#include "vector/fill/fill_row.glsl"
#include "vector/shared/rows.glsl"

#if SOFTWARE
void takeFlatSegment(Grid g, PlacedPath p, FlatSegment c) {
  const uint count = rowsOf(g, c);
  for (uint k = 0; k < count; ++k) fillRow(g, p, c, (c.first >> findMSB(g.samples)) + int(k));
}
void main() { takeSegment(); }
#else
shared FlatSegment flatSegments[64];
shared uint flatSegmentPath[64];
shared uint firstRow[65]; // of each flattened segment, among all rows of the 64

void main() {
  loadSegments();
  const uint lane = gl_LocalInvocationID.x;
  const Grid g = canvasGrid();
  const uint total = flatSegmentTotal();
  for (uint batch = 0; batch < total; batch += 64) {
    barrier(); // the last ones have been read
    uint count = 0;
    if (batch + lane < total) {
      const uint s = segmentOf(batch + lane);
      FlatSegment c;
      if (fetchFlatSegment(g, s, batch + lane, c)) {
        count = rowsOf(g, c);
        flatSegments[lane] = c;
        flatSegmentPath[lane] = segmentPath[s];
      }
    }
    firstRow[lane + 1] = count;
    if (lane == 0) firstRow[0] = 0;
    barrier();
    for (uint step = 1; step < 64; step *= 2) {
      const uint other = lane >= step ? firstRow[lane + 1 - step] : 0;
      barrier();
      firstRow[lane + 1] += other;
      barrier();
    }
    // Slices share the rows, so that a few long flattened segments keep more than one workgroup busy.
    for (uint i = gl_WorkGroupID.z * 64 + lane; i < firstRow[64]; i += gl_NumWorkGroups.z * 64) {
      uint low = 0, high = 64;
      while (low + 1 < high) {
        const uint middle = (low + high) / 2;
        if (firstRow[middle] <= i) low = middle;
        else high = middle;
      }
      const FlatSegment c = flatSegments[low];
      fillRow(g, paths[flatSegmentPath[low]], c, (c.first >> findMSB(g.samples)) + int(i - firstRow[low]));
    }
  }
}
#endif
