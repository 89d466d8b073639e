// Rows of pixels: what fill's work is dealt out in.

// How many rows of pixels a chord has work in. A level one has where it passes from tile to tile.
uint rowsOf(Grid g, Chord c) {
  if (max(c.top.x, c.bottom.x) < 0.0 || min(c.top.x, c.bottom.x) >= float(g.columns)) return 0;
  const int shift = findMSB(g.samples);
  if (c.first < c.last) return uint(((c.last - 1) >> shift) - (c.first >> shift) + 1);
  return tileOf(columnOf(g, c.top.x)) != tileOf(columnOf(g, c.bottom.x)) ? 1 : 0;
}
