#version 460
// What each path's boundary does to the pixels of the tiles it passes through.
//
// Where a chord meets a sample row, all samples of the row right of it change sides: one bit at the first such sample's
// pixel stands for them. Beside the bits, a pixel's area is kept as its difference from what its samples say. Where the
// chord passes from tile to tile between two rows, the right one's rows from there down change sides at its left edge.
#extension GL_GOOGLE_include_directive : require
#include "canvas.glsl"
#include "segments.glsl"
layout(set = 0, binding = 15, std430) buffer Entries { uint entries[]; };

// The first word of a tile's entry; ~0 where there is none.
uint entryOf(PlacedPath p, int tile, int tileRow) {
  if (tile < int(p.left) || tile >= int(p.right) || tileRow < int(p.top) || tileRow >= int(p.bottom)) return ~0u;
  const uint bit = uint(tile) - p.left;
  const TileWord w = words[p.firstWord + (uint(tileRow) - p.top) * wordsInRow(p) + bit / 32];
  const uint mask = 1u << (bit & 31);
  return (w.edges & mask) == 0 ? ~0u : (w.firstEntry + bitCount(w.edges & (mask - 1))) * kEntryWords;
}

// Tiles from -> to at a sample row.
void changeTile(Grid g, PlacedPath p, int row, int from, int to) {
  const uint all = (1u << g.samples) - 1;
  const int pixel = row / int(g.samples), tileRow = pixel / int(kTileSize);
  const uint upper = all & (all << (uint(row) % g.samples));
  for (int tile = min(from, to) + 1; tile <= max(from, to); ++tile) {
    const uint entry = entryOf(p, tile, tileRow);
    if (entry == ~0u) continue;
    const uint y = uint(pixel) % kTileSize;
    atomicXor(entries[entry + y * 4], upper);
    for (uint below = y + 1; below < kTileSize; ++below) atomicXor(entries[entry + below * 4], all);
  }
}

#if SOFTWARE
// All of a chord at once, tile by tile: what is dear without branches is done once a tile.
void takeChord(Grid g, PlacedPath p, Chord c) {
  const int tileRows = int(kTileSize * g.samples);
  const bool area = (header.flags & kExactArea) != 0;
  int tile = tileOf(columnOf(g, c.top.x)), row = c.first;
  while (row < c.last) {
    const int tileRow = row / tileRows, end = min(c.last, (tileRow + 1) * tileRows);
    float x = crossingOf(g, c, row);
    int column = columnOf(g, x);
    const int t = tileOf(column);
    if (t != tile && row % tileRows != 0) changeTile(g, p, row, tile, t);
    tile = t;
    const uint entry = entryOf(p, tile, tileRow);
    do {
      const float part = x - float(column);
      const uint bit = uint(row) % g.samples, left = uint(column) % kTileSize;
      const uint words = entry + uint(row) / g.samples % kTileSize * 4;
      const int filled = int(part * 256.0);
      const bool covered = part <= (float(sampleColumn(bit, g.samples)) + 0.5) * sampleStep(g.samples);
      if (column >= 0 && column < g.columns && entry != ~0u) {
        const uint pixel = covered ? left : left + 1; // the first of the tile's that changes sides
        if (pixel < kTileSize) atomicXor(entries[words + pixel / 2], 1u << (bit + pixel % 2 * 16));
        const int difference = (covered ? 0 : 256) - filled;
        if (area)
          atomicAdd(entries[words + left / 2 + kEntryWords / 2],
                    uint(c.side > 0 ? difference : -difference) << left % 2 * 16);
      }
      ++row;
      x = crossingOf(g, c, row);
      column = columnOf(g, x);
    } while (row < end && tileOf(column) == tile);
  }
  if (c.last % tileRows != 0) {
    const int t = tileOf(columnOf(g, c.bottom.x));
    if (t != tile) changeTile(g, p, c.last, tile, t);
  }
}
void main() { takeSegment(); }
#else
// A chord in one row of pixels; a level one as a whole.
void fillRow(Grid g, PlacedPath p, Chord c, int pixel) {
  const int n = int(g.samples), tileRows = int(kTileSize) * n;
  const int begin = max(c.first, pixel * n), end = min(c.last, pixel * n + n);
  const int tileRow = pixel / int(kTileSize);
  const bool area = (header.flags & kExactArea) != 0;
  int tile = tileOf(columnOf(g, begin == c.first ? c.top.x : crossingOf(g, c, begin - 1)));
  uint entry = entryOf(p, tile, tileRow);
  int row = begin;
  while (row < end) { // runs of sample rows that meet the same pixel: one, rarely more
    float x = crossingOf(g, c, row);
    const int column = columnOf(g, x), t = tileOf(column);
    if (t != tile) {
      if (row % tileRows != 0) changeTile(g, p, row, tile, t);
      tile = t;
      entry = entryOf(p, tile, tileRow);
    }
    int difference = 0;
    uint here = 0, next = 0; // samples that change sides at the pixel and at the one right of it
    do {
      const float part = x - float(column);
      const uint bit = uint(row) % g.samples;
      const int filled = int(part * 256.0);
      const bool covered = part <= (float(sampleColumn(bit, g.samples)) + 0.5) * sampleStep(g.samples);
      here |= covered ? 1u << bit : 0u;
      next |= covered ? 0u : 1u << bit;
      difference += (covered ? 0 : 256) - filled;
      ++row;
      x = crossingOf(g, c, row);
    } while (row < end && columnOf(g, x) == column);
    if (column < 0 || column >= g.columns || entry == ~0u) continue;
    const uint left = uint(column) % kTileSize, shift = (left & 1) * 16;
    const uint word = entry + uint(pixel) % kTileSize * 4 + left / 2;
    atomicXor(entries[word], shift == 0 ? here | next << 16 : here << 16);
    if (shift != 0 && next != 0 && left + 1 < kTileSize) atomicXor(entries[word + 1], next);
    if (area) atomicAdd(entries[word + kEntryWords / 2], uint(c.side > 0 ? difference : -difference) << shift);
  }
  if (end == c.last && end % tileRows != 0) {
    const int t = tileOf(columnOf(g, c.bottom.x));
    if (t != tile) changeTile(g, p, end, tile, t);
  }
}

// How many rows of pixels a chord has work in.
uint rowsOf(Grid g, Chord c) {
  const int n = int(g.samples);
  return c.first < c.last ? uint((c.last - 1) / n - c.first / n + 1) : (c.top.x != c.bottom.x ? 1 : 0);
}

shared Chord chords[64];
shared uint chordPath[64];
shared uint firstRow[65]; // of each chord, among all rows of the 64

void main() {
  loadSegments();
  const uint lane = gl_LocalInvocationID.x;
  const Grid g = canvasGrid();
  const int n = int(g.samples);
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
      fillRow(g, paths[chordPath[low]], c, c.first / n + int(i - firstRow[low]));
    }
  }
}
#endif
