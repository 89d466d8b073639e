// Rows of pixels: what fill's work is dealt out in.

// How many rows of pixels a flattened segment has work in. A level one has where it passes from tile to tile.
uint rowsOf(Grid g, FlatSegment c) {
#if SCISSORS
  const float from = clamp(c.top.x, c.left, c.right), to = clamp(c.bottom.x, c.left, c.right);
#else
  const float from = c.top.x, to = c.bottom.x;
#endif
  if (max(max(from, to), max(topEnd(c), lastEnd(c))) < 0.0) return 0;
  if (min(min(from, to), min(topEnd(c), lastEnd(c))) >= float(g.columns)) return 0;
  const int shift = findMSB(g.samples);
  if (c.first < c.last) return uint(((c.last - 1) >> shift) - (c.first >> shift) + 1);
  return tileOf(columnOf(g, topEnd(c))) != tileOf(columnOf(g, lastEnd(c))) ? 1 : 0;
}
