// What fill does with a chord in a row of pixels, whoever gives it the chord.
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
  const int pixel = row >> findMSB(g.samples), tileRow = pixel / int(kTileSize);
  const uint upper = all & (all << (uint(row) & (g.samples - 1)));
  for (int tile = min(from, to) + 1; tile <= max(from, to); ++tile) {
    const uint entry = entryOf(p, tile, tileRow);
    if (entry == ~0u) continue;
    const uint y = uint(pixel) % kTileSize;
    atomicXor(entries[entry + y * 4], upper);
    for (uint below = y + 1; below < kTileSize; ++below) atomicXor(entries[entry + below * 4], all);
  }
}

#if !SOFTWARE
// A chord in one row of pixels; a level one as a whole.
void fillRow(Grid g, PlacedPath p, Chord c, int pixel) {
  const int shift = findMSB(g.samples), n = int(g.samples), inTileRow = int(kTileSize) * n - 1;
  const int begin = max(c.first, pixel << shift), end = min(c.last, (pixel << shift) + n);
  const int tileRow = pixel / int(kTileSize);
  const bool area = (header.flags & kExactArea) != 0;
  int tile = tileOf(columnOf(g, begin == c.first ? topEnd(c) : crossingOf(g, c, begin - 1)));
  uint entry = entryOf(p, tile, tileRow);
  int row = begin;
  while (row < end) { // runs of sample rows that meet the same pixel: one, rarely more
    float x = crossingOf(g, c, row);
    const int column = columnOf(g, x), t = tileOf(column);
    if (t != tile) {
      if ((row & inTileRow) != 0) changeTile(g, p, row, tile, t);
      tile = t;
      entry = entryOf(p, tile, tileRow);
    }
    int difference = 0;
    uint here = 0, next = 0; // samples that change sides at the pixel and at the one right of it
    do {
      const float part = x - float(column);
      const uint bit = uint(row) & uint(n - 1);
      const int filled = int(part * 256.0);
      const bool covered = part <= (float(sampleColumn(bit, g.samples)) + 0.5) * sampleStep(g.samples);
      here |= covered ? 1u << bit : 0u;
      next |= covered ? 0u : 1u << bit;
      difference += (covered ? 0 : 256) - filled;
      ++row;
      x = crossingOf(g, c, row);
    } while (row < end && columnOf(g, x) == column);
    if (column < 0 || column >= g.columns || entry == ~0u) continue;
    const uint left = uint(column) % kTileSize, shifted = (left & 1) * 16;
    const uint word = entry + uint(pixel) % kTileSize * 4 + left / 2;
    atomicXor(entries[word], shifted == 0 ? here | next << 16 : here << 16);
    if (shifted != 0 && next != 0 && left + 1 < kTileSize) atomicXor(entries[word + 1], next);
    if (area) atomicAdd(entries[word + kEntryWords / 2], uint(c.side > 0 ? difference : -difference) << shifted);
  }
  if (end == c.last && (end & inTileRow) != 0) {
    const int t = tileOf(columnOf(g, lastEnd(c)));
    if (t != tile) changeTile(g, p, end, tile, t);
  }
}
#endif
