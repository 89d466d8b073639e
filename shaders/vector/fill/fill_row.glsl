// What fill does with a flattened segment in a row of pixels, whoever gives it the flatSegment.
#include "vector/shared/run.glsl"
layout(set = 0, binding = kBindEntries, std430) buffer Entries { uint entries[]; };
#if SOFTWARE
const uint kRowWords = 8; // a pixel each: samples that change sides, and the area in the upper half
#else
const uint kRowWords = 4;
#endif

// A row of tiles of a path: its box from left to right, where its words begin, and the one at hand.
struct TileRow {
  uint left, right, firstWord;
  uint index, edges, firstEntry;
};
void fetchWord(inout TileRow row, uint index) {
  row.index = index;
  const TileWord word = words[row.firstWord + index];
  row.edges = word.edges;
  row.firstEntry = word.firstEntry;
}
// At hand is the word of `tile` or the nearest one.
TileRow tileRowOf(PlacedPath p, int tileRow, int tile) {
  TileRow row;
  row.left = p.left;
  row.right = p.right;
  row.firstWord = p.firstWord + (uint(tileRow) - p.top) * wordsInRow(p);
  fetchWord(row, (clamp(uint(max(tile, 0)), p.left, p.right - 1) - p.left) / 32);
  return row;
}
// The first word of a tile's entry; ~0 where there is none.
uint entryOf(inout TileRow row, int tile) {
  if (tile < int(row.left) || tile >= int(row.right)) return ~0u;
  const uint bit = uint(tile) - row.left, mask = 1u << (bit & 31);
  if (bit / 32 != row.index) fetchWord(row, bit / 32);
  return (row.edges & mask) == 0 ? ~0u : (row.firstEntry + bitCount(row.edges & (mask - 1))) * kEntryWords;
}

// Turns over what lies at the left edge of a tile from a sample row on.
void turnFrom(Grid g, uint entry, int row) {
  if (entry == ~0u) return;
  const uint all = (1u << g.samples) - 1, upper = all & (all << (uint(row) & (g.samples - 1)));
  const uint y = uint(row >> findMSB(g.samples)) % kTileSize;
  atomicXor(entries[entry + y * kRowWords], upper);
  for (uint k = y + 1; k < kTileSize; ++k) atomicXor(entries[entry + k * kRowWords], all);
}

// Tiles from -> to at a sample row.
void changeTile(Grid g, inout TileRow tiles, int row, int from, int to) {
  for (int tile = min(from, to) + 1; tile <= max(from, to); ++tile) turnFrom(g, entryOf(tiles, tile), row);
}

#if SOFTWARE
void takeRun(Run run, uint entry, uint column, uint row, float side) {
  const uint inTile = column % kTileSize, word = entry + row % kTileSize * kRowWords + inTile;
  atomicXor(entries[word], run.here);
  if (run.next != 0 && inTile + 1 < kTileSize) atomicXor(entries[word + 1], run.next);
  if ((header.flags & kExactArea) != 0)
    atomicAdd(entries[word], uint(side > 0 ? run.difference : -run.difference) << 16);
}
#else
void takeRun(Run run, uint entry, uint column, uint row, float side) {
  const uint inTile = column % kTileSize, shifted = (inTile & 1) * 16;
  const uint word = entry + row % kTileSize * 4 + inTile / 2;
  atomicXor(entries[word], shifted == 0 ? run.here | run.next << 16 : run.here << 16);
  if (shifted != 0 && run.next != 0 && inTile + 1 < kTileSize) atomicXor(entries[word + 1], run.next);
  if ((header.flags & kExactArea) != 0)
    atomicAdd(entries[word + kEntryWords / 2], uint(side > 0 ? run.difference : -run.difference) << shifted);
}
#endif

// A flattened segment in one row of pixels; a level one as a whole.
//
// What all samples of the row say is found first, without branches; then each run of rows that meet one pixel is taken.
void fillRow(Grid g, PlacedPath p, FlatSegment c, int pixel) {
  const int shift = findMSB(g.samples), top = pixel << shift, inTileRow = (int(kTileSize) << shift) - 1;
  const int begin = max(c.first, top), end = min(c.last, top + int(g.samples));
  const int tileRow = pixel / int(kTileSize);
  if (tileRow < int(p.top) || tileRow >= int(p.bottom)) return;
  const Line line = lineOf(g, c);
  const Crossings crossings = crossingsOf(g, line, top);
  int tile = begin == c.first ? tileOf(columnOf(g, topEnd(c))) : tileOf(crossingAt(line, middleOf(g, begin - 1)) >> 8);
  TileRow tiles = tileRowOf(p, tileRow, tile);
  uint entry = entryOf(tiles, tile);
  const uint rows = begin < end ? (1u << (end - top)) - (1u << (begin - top)) : 0;
  uint first = rows & (crossings.first | 1u << (begin - top));
  while (first != 0) {
    const int from = findLSB(first);
    first &= first - 1;
    const int to = first != 0 ? findLSB(first) : end - top;
    const int x = crossingAt(line, middleOf(g, top + from)), last = crossingAt(line, middleOf(g, top + to - 1));
    const int column = x >> 8, t = tileOf(column);
    if (t != tile) {
      if ((top + from & inTileRow) != 0) changeTile(g, tiles, top + from, tile, t);
      tile = t;
      entry = entryOf(tiles, t);
    }
    if (column < 0 || column >= g.columns || entry == ~0u) continue;
    takeRun(runOf((1u << to) - (1u << from), crossings.covered, x, last), entry, uint(column), uint(pixel), c.side);
  }
  if (end != c.last || (end & inTileRow) == 0) return;
  const int t = tileOf(columnOf(g, lastEnd(c)));
  if (t != tile) changeTile(g, tiles, end, tile, t);
}
