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

// Turns over what lies at the left edge of a tile from a sample row on.
void turnFrom(Grid g, uint entry, int row) {
  if (entry == ~0u) return;
  const uint all = (1u << g.samples) - 1, upper = all & (all << (uint(row) & (g.samples - 1)));
  const uint y = uint(row >> findMSB(g.samples)) % kTileSize;
  for (uint k = 0; k < kTileSize; ++k)
    if (k >= y) atomicXor(entries[entry + k * 4], k == y ? upper : all);
}

// Tiles from -> to at a sample row.
void changeTile(Grid g, PlacedPath p, int row, int from, int to) {
  const int tileRow = (row >> findMSB(g.samples)) / int(kTileSize);
  for (int tile = min(from, to) + 1; tile <= max(from, to); ++tile) turnFrom(g, entryOf(p, tile, tileRow), row);
}

#if !SOFTWARE
// A chord in one row of pixels; a level one as a whole.
void fillRow(Grid g, PlacedPath p, Chord c, int pixel) {
  const int shift = findMSB(g.samples), n = int(g.samples), inTileRow = int(kTileSize) * n - 1;
  const int begin = max(c.first, pixel << shift), end = min(c.last, (pixel << shift) + n);
  const int tileRow = pixel / int(kTileSize);
  const bool area = (header.flags & kExactArea) != 0;
  const float height = sampleStep(g.samples);
  int tile = tileOf(columnOf(g, begin == c.first ? topEnd(c) : crossingOf(g, c, begin - 1)));
  uint entry = entryOf(p, tile, tileRow);
  int row = begin;
  float y = middleOf(g, row), x = crossingAt(c, y);
  while (row < end) { // runs of sample rows that meet the same pixel: one, rarely more
    const int column = columnOf(g, x), t = tileOf(column);
    if (t != tile) {
      const uint other = entryOf(p, t, tileRow);
      if ((row & inTileRow) != 0) {
        if (abs(t - tile) == 1) turnFrom(g, t > tile ? other : entry, row);
        else changeTile(g, p, row, tile, t);
      }
      tile = t;
      entry = other;
    }
    const float left = column < 0 ? -3e38 : float(column), right = column < g.columns ? float(column) + 1.0 : 3e38;
    int difference = 0;
    uint here = 0, next = 0; // samples that change sides at the pixel and at the one right of it
    do {
      const float part = x - left;
      const uint bit = uint(row) & uint(n - 1);
      const bool covered = part <= (float(sampleColumn(bit, g.samples)) + 0.5) * height;
      here |= covered ? 1u << bit : 0u;
      next |= covered ? 0u : 1u << bit;
      difference += (covered ? 0 : 256) - int(part * 256.0);
      ++row;
      y += height;
      x = crossingAt(c, y);
    } while (row < end && x >= left && x < right);
    if (column < 0 || column >= g.columns || entry == ~0u) continue;
    const uint inTile = uint(column) % kTileSize, shifted = (inTile & 1) * 16;
    const uint word = entry + uint(pixel) % kTileSize * 4 + inTile / 2;
    atomicXor(entries[word], shifted == 0 ? here | next << 16 : here << 16);
    if (shifted != 0 && next != 0 && inTile + 1 < kTileSize) atomicXor(entries[word + 1], next);
    if (area) atomicAdd(entries[word + kEntryWords / 2], uint(c.side > 0 ? difference : -difference) << shifted);
  }
  if (end != c.last || (end & inTileRow) == 0) return;
  const int t = tileOf(columnOf(g, lastEnd(c)));
  if (abs(t - tile) == 1) turnFrom(g, t > tile ? entryOf(p, t, tileRow) : entry, end);
  else if (t != tile) changeTile(g, p, end, tile, t);
}
#endif
