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
  const bool area = (header.flags & kExactArea) != 0;
  int tile = tileOf(columnOf(g, topEnd(c))), row = c.first;
  while (row < c.last) {
    const int tileRow = row / tileRows, end = min(c.last, (tileRow + 1) * tileRows);
    float x = crossingOf(g, c, row);
    int column = columnOf(g, x);
    const int t = tileOf(column);
    if (t != tile && row % tileRows != 0) changeTile(g, p, row, tile, t);
    tile = t;
    const uint entry = entryOf(p, tile, tileRow);
    do {
      const int at = column, rowEnd = min(end, (row | int(g.samples - 1)) + 1);
      const uint left = uint(column) % kTileSize;
      const uint words = entry + (uint(row) >> findMSB(g.samples)) % kTileSize * 4 + left / 2;
      uint here = 0, next = 0; // samples that change sides at the pixel and at the one right of it
      int difference = 0;
      do {
        const float part = x - float(column);
        const uint bit = uint(row) & (g.samples - 1);
        const bool covered = part <= (float(sampleColumn(bit, g.samples)) + 0.5) * sampleStep(g.samples);
        here |= covered ? 1u << bit : 0u;
        next |= covered ? 0u : 1u << bit;
        difference += (covered ? 0 : 256) - int(part * 256.0);
        ++row;
        x = crossingOf(g, c, row);
        column = columnOf(g, x);
      } while (row < rowEnd && column == at);
      if (at >= 0 && at < g.columns && entry != ~0u) {
        const uint shifted = left % 2 * 16;
        atomicXor(entries[words], shifted == 0 ? here | next << 16 : here << 16);
        if (shifted != 0 && next != 0 && left + 1 < kTileSize) atomicXor(entries[words + 1], next);
        if (area) atomicAdd(entries[words + kEntryWords / 2], uint(c.side > 0 ? difference : -difference) << shifted);
      }
    } while (row < end && tileOf(column) == tile);
  }
  if (c.last % tileRows != 0) {
    const int t = tileOf(columnOf(g, lastEnd(c)));
    if (t != tile) changeTile(g, p, c.last, tile, t);
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
