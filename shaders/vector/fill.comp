#version 460
// What each path's boundary does to the pixels of the tiles it passes through.
//
// Where a chord meets a sample row, all samples of the row right of it change sides: one bit at the first such sample's
// pixel stands for them. Beside the bits, a pixel's area is kept as its difference from what its samples say. Where the
// chord passes from tile to tile between two rows, the right one's rows from there down change sides at its left edge.
#extension GL_GOOGLE_include_directive : require
#include "canvas.glsl"
#include "segments.glsl"
#include "fill_row.glsl"
#include "rows.glsl"

#if SOFTWARE
// All of a chord at once, tile by tile: what is dear without branches is done once a tile.
void takeChord(Grid g, PlacedPath p, Chord c) {
  const int tileRows = int(kTileSize * g.samples);
  const Line line = lineOf(g, c);
  const uvec4 columns = sampleColumns(g.samples);
  const int top = int(p.top) * tileRows, bottom = int(p.bottom) * tileRows, last = min(c.last, bottom);
  int tile = tileOf(columnOf(g, topEnd(c))), row = max(c.first, top);
  while (row < last) {
    const int end = min(last, (row / tileRows + 1) * tileRows);
    int x = crossingAt(line, middleOf(g, row)), column = x >> 8;
    const int t = tileOf(column);
    TileRow tiles = tileRowOf(p, row / tileRows, t);
    if (t != tile && row % tileRows != 0) changeTile(g, tiles, row, tile, t);
    tile = t;
    const uint entry = entryOf(tiles, tile);
    do {
      const int at = column, begin = row, rowEnd = min(end, (row | int(g.samples - 1)) + 1), first = x;
      uint covered = 0;
      do {
        const uint bit = uint(row) & (g.samples - 1);
        covered |= (x & 255) <= int(byteOf(columns, bit)) ? 1u << bit : 0u;
        ++row;
        x = crossingAt(line, middleOf(g, row));
        column = x >> 8;
      } while (row < rowEnd && column == at);
      if (at >= 0 && at < g.columns && entry != ~0u) {
        const uint from = uint(begin) & (g.samples - 1), rows = (1u << (from + uint(row - begin))) - (1u << from);
        const int until = crossingAt(line, middleOf(g, row - 1)); // Mesa 22.3 loses it if it is kept from the loop
        takeRun(runOf(rows, covered, first, until), entry, uint(at), uint(begin >> findMSB(g.samples)), c.side);
      }
    } while (row < end && tileOf(column) == tile);
  }
  if (c.last % tileRows != 0 && c.last >= top && c.last < bottom) {
    const int t = tileOf(columnOf(g, lastEnd(c)));
    TileRow tiles = tileRowOf(p, c.last / tileRows, t);
    if (t != tile) changeTile(g, tiles, c.last, tile, t);
  }
}
void main() { takeSegment(); }
#else
shared Chord chords[64];
shared uint chordPath[64];
shared uint firstRow[65]; // of each chord, among all rows of the 64

void main() {
  loadSegments();
  const uint lane = gl_LocalInvocationID.x;
  const Grid g = canvasGrid();
  const uint total = chordTotal();
  for (uint batch = 0; batch < total; batch += 64) {
    barrier(); // the last ones have been read
    uint count = 0;
    if (batch + lane < total) {
      const uint s = segmentOf(batch + lane);
      Chord c;
      if (fetchChord(g, s, batch + lane, c)) {
        count = rowsOf(g, c);
        chords[lane] = c;
        chordPath[lane] = segmentPath[s];
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
    // Slices share the rows, so that a few long chords keep more than one workgroup busy.
    for (uint i = gl_WorkGroupID.z * 64 + lane; i < firstRow[64]; i += gl_NumWorkGroups.z * 64) {
      uint low = 0, high = 64;
      while (low + 1 < high) {
        const uint middle = (low + high) / 2;
        if (firstRow[middle] <= i) low = middle;
        else high = middle;
      }
      const Chord c = chords[low];
      fillRow(g, paths[chordPath[low]], c, (c.first >> findMSB(g.samples)) + int(i - firstRow[low]));
    }
  }
}
#endif
