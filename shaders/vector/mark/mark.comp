#version 460
// Which tiles a path's boundary passes through, and for the others whether they lie inside.
//
// A flattened segment marks the tiles it meets, those into which it brings a change of sides across their left edge
// included, and turns over "inside" for all tiles right of where it meets the first sample row of a row of tiles. As
// outlines are closed and all comparisons are made on rows and columns that neighbours agree on, that is exact.
//
// Flattened segments that are to be filled are listed, and so are their rows of pixels. Marking waits more than it
// writes, so the first workgroups clear entries beside it; allocate clears what more there are. Software devices:
// mark_pieces.comp.
#extension GL_GOOGLE_include_directive : require
#include "vector/shared/canvas.glsl"
#define SEGMENT_GROUP (groupIndex() - kClearGroups)
#include "vector/shared/segments.glsl"
layout(set = 0, binding = kBindEntries, std430) writeonly buffer Entries { uvec4 entries[]; };
#include "vector/shared/flat_segments.glsl"
#include "vector/shared/rows.glsl"
shared uint taken, firstRow; // rows of the flattened segments at hand: how many, where they lie in the list

uint bitsFrom(int bit) { return bit <= 0 ? ~0u : (bit >= 32 ? 0u : ~0u << uint(bit)); }

void takeFlatSegment(Grid g, PlacedPath p, FlatSegment c) {
  const int tileRows = int(kTileSize * g.samples);
  const int inRow = int(wordsInRow(p)), left = int(p.left);
  const int tileRowEnd = min(c.last / tileRows + 1, int(p.bottom));
  for (int row = max(c.first / tileRows, int(p.top)); row < tileRowEnd; ++row) {
    const TileSpan span = tilesMet(g, c, row);
    const int firstWord = int(p.firstWord) + (row - int(p.top)) * inRow;
    if (span.turned != kNoTile)
      for (int word = max(span.turned - left, 0) / 32; word < inRow; ++word)
        atomicXor(words[firstWord + word].inside, bitsFrom(span.turned - left - word * 32));
    const int low = clamp(span.low - left, 0, int(p.right) - left), high = min(span.high, int(p.right) - 1) - left;
    for (int word = low / 32; word <= high / 32 && low <= high; ++word)
      atomicOr(words[firstWord + word].edges, bitsFrom(low - word * 32) & ~bitsFrom(high + 1 - word * 32));
  }
}

void main() {
  if (groupIndex() < kClearGroups) {
    const uint end = counters.cleared * (kEntryWords / 4);
    for (uint i = groupIndex() * LANES + gl_LocalInvocationID.x; i < end; i += kClearGroups * LANES)
      entries[i] = uvec4(0);
    return;
  }
  loadSegments();
  const Grid g = canvasGrid();
  const uint lane = gl_LocalInvocationID.x, total = flatSegmentTotal();
  for (uint batch = 0; batch < total; batch += LANES) {
    if (lane == 0) taken = 0;
    barrier();
    FlatSegment c;
    uint path, rowCount = 0, own = 0;
    bool found = false, cut = false;
    if (batch + lane < total) {
      const uint s = segmentOf(batch + lane);
      path = segmentPath[s];
      found = fetchFlatSegment(g, s, batch + lane, c);
#if SCISSORS
      cut = hasScissor(items[segmentItem[s]]);
#endif
      if (found) rowCount = rowsOf(g, c);
      if (rowCount != 0) own = atomicAdd(taken, rowCount);
    }
    barrier();
    if (lane == 0 && taken != 0) firstRow = atomicAdd(counters.rows, taken);
    if (found) takeFlatSegment(g, paths[path], c);
    barrier();
    const uint first = firstRow + own;
    if (rowCount == 0 || first + rowCount > header.rowLimit) continue;
    flatSegmentList[first] = FlatSegmentRecord(
        c.top, c.bottom, c.slope, path | (c.side > 0 ? kRightSide : 0) | (cut ? kCut : 0));
    for (uint k = 0; k < rowCount; ++k) rows[first + k] = k;
  }
}
